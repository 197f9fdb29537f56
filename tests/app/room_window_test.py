#!/usr/bin/env python3
"""An operating room in its window: the table is tilted as far as it can and no farther, a port is dragged over the skin and its
arm docked anew, a programme is played.

    tools/with_xvfb.sh 1280x800 python3 tests/app/room_window_test.py PATH/TO/trocar [FOLDER]

Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import sys
import time

from trainee import Failed, in_a_room, xdo


def tilted(eyes):
    events = eyes.happened("tilted")
    return events[-1] if events else None


def tilt(eyes):
    xdo("key", "w")
    eyes.wait("the table tilted", lambda: tilted(eyes), 30)
    first = tilted(eyes)["head_down_deg"]
    for _ in range(3):
        before = len(eyes.happened("tilted"))
        xdo("key", "w")
        eyes.wait("the table further down", lambda: len(eyes.happened("tilted")) > before, 30)
    down = tilted(eyes)["head_down_deg"]
    if abs(down - first - 3) > 1e-6:
        raise Failed(f"three keys are three degrees, got {down - first}")
    xdo("key", "a")
    eyes.wait("the table to the side", lambda: abs(tilted(eyes)["left_down_deg"] - 6) < 1e-6, 30)


def drag_port(eyes):
    name = "midclavicular"
    time.sleep(1)  # a picture after the last key
    x, y = eyes.wait("the port on the screen", lambda: eyes.screen["ports"].get(name), 30)
    xdo("mousemove", x, y)
    time.sleep(0.5)
    xdo("mousedown", 1)
    eyes.wait("the port in the hand", lambda: eyes.happened("held"), 30)  # pictures may take long
    for step in range(1, 9):
        xdo("mousemove", x + 3 * step, y + 2 * step)
        time.sleep(0.3)
    xdo("mouseup", 1)
    eyes.wait("the arm docked anew", lambda: eyes.happened("port"), 60)


def play(eyes):
    before = len(eyes.happened("played"))
    xdo("key", "space")
    eyes.wait("the programme to go on", lambda: len(eyes.happened("played")) > before, 60)
    xdo("key", "space")


def room(room):
    eyes = room.eyes
    eyes.on("room", 60)
    tilt(eyes)
    drag_port(eyes)
    play(eyes)
    for key in ("r", "c", "1", "2", "3", "4"):
        xdo("key", key)
    time.sleep(0.5)
    if room.eyes.process.poll() is not None:
        raise Failed("the window has gone")
    xdo("key", "Escape")
    print(f"tilted to {tilted(eyes)['head_down_deg']:.0f} degrees, a port moved, a programme played")


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, room, ["telemanipulated", "show", "triangle"], command=("room",)))
