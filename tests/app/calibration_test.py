#!/usr/bin/env python3
"""The assistant that calibrates a box, in its window: somebody sits at a box that is wired oddly (48 channels from the top
down, raw blocks, a pedal that is 0 while closed) and does what the window says; the file that comes out is compared with
how the box is wired.

    tools/with_xvfb.sh python3 tests/app/calibration_test.py PATH/TO/trocar [FOLDER]

Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import json
import math
import os
import pty
import subprocess
import sys
import threading
import time
import tty

from trainee import Failed, in_a_room, xdo

ACTORS = ["left", "right", "third", "fourth", "scope"]
AXES = ["yaw", "pitch", "roll", "depth", "handle"]
SPANS = {"yaw": (-1.2, 1.2), "pitch": (-1.2, 1.2), "roll": (3.2, -3.2), "depth": (0.0, 0.3), "handle": (0.0, 1.0)}
LOW, HIGH = 350, 3750
REST = 1 << 20  # bits that are 1 while nothing is pressed


def channel_of(actor, axis):
    return 47 - (5 * ACTORS.index(actor) + AXES.index(axis))


def code_of(actor, axis, value):
    low, high = (-3.2, 3.2) if (actor, axis) == ("scope", "handle") else SPANS[axis]
    return LOW + (value - low) / (high - low) * (HIGH - LOW)


def bit_of(question):
    return 20 + question["pedal"] if question["pedal"] >= 0 else ACTORS.index(question["actor"]) * 3 + question["button"]


class OddBox:
    """Answers what it is asked with a raw block of what it stands at."""

    def __init__(self):
        self.codes, self.bits = [2000] * 48, REST
        self.master, slave = pty.openpty()
        tty.setraw(self.master)
        tty.setraw(slave)
        self.port = os.ttyname(slave)
        self.slave = slave  # kept open: the line does not hang up between two who listen
        threading.Thread(target=self.serve, daemon=True).start()

    def block(self):
        packed = 0
        for i, code in enumerate(self.codes):
            packed |= max(0, min(4095, round(code))) << (12 * i)
        return packed.to_bytes(72, "little") + self.bits.to_bytes(4, "little")

    def serve(self):
        while True:
            try:
                os.read(self.master, 64)
            except OSError:
                return
            time.sleep(76 * 10 / 38400)
            os.write(self.master, self.block())


BOX = OddBox()


def obey(question):
    """Until the answer could be taken; a press answers by itself."""
    if question["kind"] == "press":
        time.sleep(0.2)
        BOX.bits ^= 1 << bit_of(question)
        time.sleep(0.2)
        BOX.bits ^= 1 << bit_of(question)
        return
    channel = channel_of(question["actor"], question["axis"])
    if question["kind"] == "sweep":
        for i in range(16):
            BOX.codes[channel] = 2000 + 1500 * math.sin(0.5 * i)
            time.sleep(0.04)
    else:
        BOX.codes[channel] = code_of(question["actor"], question["axis"], question["value"])
        time.sleep(0.7)
    xdo("key", "space")


def calibrate(room):
    eyes, hands = room.eyes, room.hands
    eyes.on("parts", 60)
    hands.press("Begin")
    eyes.on("question", 30)
    answered = -1
    while eyes.screen["name"] == "question":
        number = eyes.screen["number"]
        if number == answered:
            xdo("key", "space")
            time.sleep(0.5)
        else:
            obey(eyes.screen["question"])
            answered = number
        try:
            eyes.wait("the next question",
                      lambda: eyes.screen["name"] != "question" or eyes.screen["number"] != number, 4)
        except Failed:
            if len(eyes.happened("answer", taken=False)) > 40:
                raise
    hands.press("Save")
    eyes.wait("the file", lambda: eyes.happened("saved", written=True), 30)
    compare(json.loads(subprocess.run([room.program, "box", "file", "--wiring", os.path.join(room.folder, "box.json")],
                                      check=True, capture_output=True, text=True).stdout))


def compare(found):
    if found["protocol"] != "raw":
        raise Failed(f"the box speaks raw blocks, found: {found['protocol']}")
    for hand in found["hands"]:
        for axis in AXES:
            check_axis(hand["hand"], axis, hand[axis])
    for axis in AXES[:4]:
        check_axis("scope", axis, found["scope"][axis])
    check_axis("scope", "handle", found["scope"]["post"])
    if sorted(found["pedals"].values()) != list(range(20, 25)):
        raise Failed(f"pedals: {found['pedals']}")
    if found["closed_is_low"] != [20]:
        raise Failed(f"closed_is_low: {found['closed_is_low']}")
    print("every channel, table and switch was found")


def check_axis(actor, axis, wired):
    unit, scale = next((k, s) for k, s in (("deg", math.pi / 180), ("mm", 1e-3), ("closed", 1.0)) if k in wired)
    if wired["channel"] != channel_of(actor, axis):
        raise Failed(f"{actor} {axis}: channel {wired['channel']}")
    for code, value in wired[unit]:
        if abs(code - code_of(actor, axis, value * scale)) > 1.5:
            raise Failed(f"{actor} {axis}: {code} at {value} {unit}")


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, calibrate, [BOX.port, "--output", "box.json"], command=("box", "calibrate")))
