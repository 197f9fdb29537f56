#!/usr/bin/env python3
"""Drives the real window: an attempt is watched in the player, a demonstration is recorded while the window stays usable,
played with captions, sought through, and followed by "Now you" with the same patient.

    tools/with_xvfb.sh 1280x720 python3 tests/app/playback_window_test.py PATH/TO/trocar [FOLDER]

Exit: 0 passed, 1 failed, 77 something to run it with is missing. FOLDER keeps what was written.
"""
import glob
import os
import sys
import time

from trainee import Failed, display_size, in_a_room, open_exercise, xdo

PATIENCE = 420  # [s] for a demonstration to be recorded


def shown(eyes, what, condition, limit=60):
    """The newest picture of the player that fits."""
    return eyes.wait(what, lambda: next((e for e in reversed(eyes.happened("shown")) if condition(e)), None), limit)


def press_key(eyes, *keys):
    for key in keys:
        xdo("key", key)
        time.sleep(0.1)
    eyes.read()


def watch_attempt(eyes, hands):
    eyes.on("hint", 120)
    hands.enter()
    eyes.on("exercise", 60)
    eyes.wait("some time to pass", lambda: eyes.pose and eyes.pose["tick"] > 1500, 120)
    hands.pause()
    eyes.on("pause")
    hands.press("End exercise")
    eyes.on("confirm")
    hands.press("Yes, end exercise")
    eyes.on("result")
    hands.press("Watch my attempt")
    eyes.on("player", 60)
    last = shown(eyes, "the player to show the recording", lambda e: "last" in e)["last"]
    if last < 1000:
        raise Failed(f"the recording has only {last} ticks")
    press_key(eyes, "space", "End")
    shown(eyes, "the end", lambda e: e["tick"] == last)
    hands.press("Back to Trocar")
    eyes.on("result")
    hands.press("Back")
    print(f"watched an attempt of {last} ticks")


def watch_demonstration(eyes, hands, data):
    open_exercise(eyes, hands, "basics/camera-0", "basics")
    captions = len(eyes.happened("caption"))
    pictures = len(eyes.happened("shown"))
    hands.press("Demonstration", 120)
    eyes.wait("the recording to begin, or already the player",
              lambda: "Cancel" in eyes.screen["widgets"] or eyes.screen["name"] == "player", 60)
    eyes.on("player", PATIENCE)
    files = glob.glob(os.path.join(data, "demonstrations", "*"))
    if len(files) != 1 or not files[0].endswith(".rec"):
        raise Failed(f"the folder of demonstrations holds {files}")
    eyes.wait("the demonstration to play", lambda: any(e["tick"] > 300 for e in eyes.happened("shown")[pictures:]), 120)
    caption = eyes.wait("captions", lambda: eyes.happened("caption")[captions:], 30)[-1]
    if not (caption["step"] and caption["hint"] and caption["doing"]):
        raise Failed(f"the caption says too little: {caption}")
    press_key(eyes, "space", "Home")
    shown(eyes, "the start", lambda e: not e["playing"] and e["tick"] == 0)
    press_key(eyes, "shift+Next")
    step = shown(eyes, "the first step", lambda e: not e["playing"] and e["tick"] > 0)
    press_key(eyes, "shift+Next")
    shown(eyes, "the step after it", lambda e: not e["playing"] and e["tick"] > step["tick"])
    later = eyes.wait("another caption", lambda: [c for c in eyes.happened("caption")[captions:]
                                                  if c["step"] != caption["step"]], 30)[-1]
    print(f"captions: {caption['step']} ({caption['doing']}), then {later['step']}")
    hands.press("Speed 4x")
    hands.press("Do the same exercise with the same patient")
    eyes.on("exercise", 120)
    attempt = eyes.happened("attempt")[-1]
    if attempt["mode"] != "assessed" or attempt["exercise"] != "basics/camera-0":
        raise Failed(f"Now you began {attempt}")


def again(eyes, hands):
    """The second time it is there at once."""
    hands.pause()
    eyes.on("pause")
    hands.press("Start screen")
    open_exercise(eyes, hands, "basics/camera-0", "basics")
    pictures = len(eyes.happened("shown"))
    hands.press("Demonstration", 120)
    eyes.on("player", 30)
    eyes.wait("the kept demonstration", lambda: eyes.happened("shown")[pictures:], 30)
    hands.press("Back to Trocar")
    eyes.wait("the start screen", lambda: eyes.screen["name"] != "player", 60)


def whole(room):
    watch_attempt(room.eyes, room.hands)
    watch_demonstration(room.eyes, room.hands, room.environment["TROCAR_DATA"])
    again(room.eyes, room.hands)
    room.process.terminate()
    room.process.wait(60)


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, whole, ["--trainee", "Ada", "basics/camera-0"],
                       command=("train", "--size", display_size())))
