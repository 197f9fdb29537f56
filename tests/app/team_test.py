#!/usr/bin/env python3
"""A team: one window hosts, a second program holds the camera; it dies and comes back, and others are kept out.

    tools/with_xvfb.sh python3 tests/app/team_test.py PATH/TO/trocar [FOLDER]

Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import socket
import subprocess
import sys
import time

from trainee import Failed, in_a_room

TOKEN = "only-for-this-test"


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


PORT = free_port()


def join(room, token=TOKEN, role="camera"):
    return subprocess.Popen([room.program, "join", f"127.0.0.1:{PORT}", "--role", role, "--token", token, "--input", "demo",
                             "--headless"], cwd=room.folder, env=room.environment, stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, text=True)


def waits(eyes):
    told = eyes.happened("waits")
    return told[-1]["for"] if told else ""


def goes_on(eyes, ticks=300):
    tick = eyes.pose["tick"]
    eyes.wait("time to go on", lambda: eyes.pose["tick"] > tick + ticks, 60)


def team(room):
    eyes, hands = room.eyes, room.hands
    eyes.on("hint", 60)
    hands.enter()
    eyes.on("exercise")
    eyes.wait("the window to wait for the camera", lambda: "camera" in waits(eyes), 30)
    eyes.wait("a pose", lambda: eyes.pose, 30)
    if eyes.pose["tick"] > 0:
        raise Failed("time went on without the camera")

    # Without the token, and for a part that nobody expects.
    for stranger in (join(room, token="guessed"), join(room, role="assistant")):
        if stranger.wait(60) != 3:
            raise Failed(f"a stranger was let in: {stranger.args}: {stranger.stderr.read()}")
    if "camera" not in waits(eyes):
        raise Failed("a stranger took the camera's seat")

    camera = join(room)
    try:
        eyes.wait("the camera to be here", lambda: waits(eyes) == "", 60)
        goes_on(eyes)
        camera.kill()
        camera.wait()
        eyes.wait("the window to miss the camera", lambda: "disconnected" in waits(eyes), 30)
        time.sleep(0.5)
        eyes.read()
        tick = eyes.pose["tick"]
        time.sleep(0.5)
        eyes.read()
        if eyes.pose["tick"] != tick:
            raise Failed("time went on without the camera")
        camera = join(room)
        eyes.wait("the camera to be back", lambda: waits(eyes) == "", 60)
        goes_on(eyes)
    finally:
        camera.kill()
    print(f"{eyes.pose['tick']} ticks with a camera that died in between")


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, team, ["gynaecology/sterilisation", "--no-store", "--team", "camera", "--team-at",
                                       f"127.0.0.1:{PORT}", "--token", TOKEN]))
