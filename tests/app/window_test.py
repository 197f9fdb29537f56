#!/usr/bin/env python3
"""Drives the real window with real mouse and key events: leads the grasper to the tube, grasps, pulls, releases.

    tools/with_xvfb.sh python3 tests/app/window_test.py PATH/TO/trocar [FOLDER]

Closed loop, as a person does it: the eyes are the window's event log (--log), which tells ten times a second where the
instruments and the tube are; the hands are xdotool. Every wait has a limit. Exit: 0 passed, 1 failed, 77 something to
run it with is missing. FOLDER keeps what was written (default: a temporary one).
"""
import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

TARGET = "tube_left.ampulla"
METRES_PER_PIXEL = 1e-4   # devices::HandSettings
METRES_PER_NOTCH = 2e-3
DEEP_IN_JAWS = 0.55       # of the jaws' length from their tips: where the tube shall lie
PATIENCE = 240            # [s] for everything


class Failed(Exception):
    pass


def add(a, b, f=1.0):
    return [x + f * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    n = math.sqrt(dot(a, a))
    return [x / n for x in a]


def in_basis(d, a, b, c):
    """Coordinates of d along a, b, c, which need not be square to each other (Cramer's rule)."""
    det = dot(a, cross(b, c))
    return dot(d, cross(b, c)) / det, dot(a, cross(d, c)) / det, dot(a, cross(b, d)) / det


class Log:
    """The window's JSON lines as they come."""

    def __init__(self, path, process):
        self.path, self.process = path, process
        self.file, self.rest = None, ""
        self.events, self.pose = [], None

    def read(self):
        if self.file is None:
            if not os.path.exists(self.path):
                return
            self.file = open(self.path, encoding="utf-8")
        self.rest += self.file.read()
        *lines, self.rest = self.rest.split("\n")
        for line in lines:
            entry = json.loads(line)
            if entry["event"] == "pose":
                self.pose = entry
            else:
                self.events.append(entry)

    def wait(self, what, condition, limit):
        """Until condition() holds; raises Failed after `limit` seconds or when the program is gone."""
        end = time.monotonic() + limit
        while True:
            gone = self.process.poll() is not None
            self.read()
            value = condition()
            if value:
                return value
            if gone:
                raise Failed(f"the program ended (exit {self.process.returncode}) while waiting for: {what}")
            if time.monotonic() > end:
                raise Failed(f"waited {limit} s for: {what}")
            time.sleep(0.02)

    def happened(self, name, **details):
        return [e for e in self.events if e["event"] == name and all(e.get(k) == v for k, v in details.items())]


def xdo(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True, stdout=subprocess.DEVNULL)


class Hand:
    """One instrument led by mouse and keys."""

    def __init__(self, log):
        self.log = log

    def tool(self):
        return next(t for t in self.log.pose["tools"] if t["name"] == self.log.pose["led"])

    def settled(self, limit=20):
        """Waits until the instrument has followed: poses from well after now that stand still."""
        start = self.log.pose["tick"]
        last = [None]

        def still():
            tip, tick = self.tool()["tip_mm"], self.log.pose["tick"]
            if tick < start + 150 or (last[0] and last[0][0] == tick):
                return False
            before, last[0] = last[0], (tick, tip)
            return before is not None and math.dist(before[1], tip) < 0.1
        self.log.wait("the instrument to come to rest", still, limit)

    def move(self, goal_mm, tolerance_mm, what, limit=60):
        """Sideways with the mouse and along the shaft with the wheel until the tip is there."""
        end = time.monotonic() + limit
        while True:
            tool, picture = self.tool(), self.log.pose["picture"]
            way = [1e-3 * x for x in add(goal_mm, tool["tip_mm"], -1)]
            if 1000 * math.sqrt(dot(way, way)) < tolerance_mm:
                return
            if time.monotonic() > end:
                raise Failed(f"{what}: still {1000 * math.sqrt(dot(way, way)):.1f} mm away after {limit} s")
            right, up, inwards = in_basis(way, picture["right"], picture["up"], tool["shaft"])
            reach = 0.008  # the farthest in one go
            longest = max(abs(right), abs(up), 1e-9)
            f = min(1.0, reach / longest)
            px, py = round(f * right / METRES_PER_PIXEL), round(-f * up / METRES_PER_PIXEL)
            if px or py:
                xdo("mousemove_relative", "--", px, py)
            for _ in range(min(4, int(abs(inwards) / METRES_PER_NOTCH + 0.5))):
                xdo("click", 4 if inwards > 0 else 5)
            self.settled()

    def roll_across(self, along):
        """Turns the jaws with Q and E until they open across the direction `along`."""
        for _ in range(12):
            tool = self.tool()
            shaft, opening = tool["shaft"], tool["opening"]
            flat = unit(add(along, shaft, -dot(along, shaft)))
            off = math.asin(max(-1.0, min(1.0, dot(opening, flat))))
            if abs(off) < 0.2:
                return
            # Clockwise as the hand sees it (E) turns the opening about the shaft.
            turned = cross(shaft, opening)
            key = "e" if dot(turned, flat) * off < 0 else "q"
            xdo("keydown", key)
            time.sleep(min(0.5, abs(off) / 1.6))
            xdo("keyup", key)
            self.settled()
        raise Failed("the jaws do not turn across the tube with Q and E")


def read_png(path):
    """Width, height and mean brightness of every 8th row's pixels of an RGB PNG."""
    data = open(path, "rb").read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise Failed(f"{path} is no PNG")
    at, packed, width, height = 8, b"", 0, 0
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    raw, row, before, rows = zlib.decompress(packed), 1 + 3 * width, bytes(3 * width), []
    for y in range(height):
        kind, line = raw[y * row], bytearray(raw[y * row + 1:(y + 1) * row])
        for i in range(len(line)):
            a = line[i - 3] if i >= 3 else 0
            b, c = before[i], before[i - 3] if i >= 3 else 0
            if kind == 1:
                line[i] = (line[i] + a) & 255
            elif kind == 2:
                line[i] = (line[i] + b) & 255
            elif kind == 3:
                line[i] = (line[i] + (a + b) // 2) & 255
            elif kind == 4:
                p = a + b - c
                pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
                line[i] = (line[i] + (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255
        before = bytes(line)
        rows.append(before)
    return width, height, rows


def check_picture(path):
    width, height, rows = read_png(path)
    if (width, height) != (1000, 640):
        raise Failed(f"the picture is {width}x{height}, not the window's 1000x640")
    # The scene lies in the middle of the left three quarters: neither black nor of one colour, and reddish.
    middle = [rows[y][3 * x:3 * x + 3] for y in range(200, 440, 8) for x in range(250, 500, 8)]
    red, green = (sum(p[k] for p in middle) / len(middle) for k in (0, 1))
    colours = len({bytes(p) for p in middle})
    if not (red > 40 and red > 1.1 * green and colours > 100):
        raise Failed(f"the picture shows no tissue: mean red {red:.0f}, green {green:.0f}, {colours} colours")
    if rows[630][3 * 10:3 * 10 + 3] != b"\0\0\0":
        raise Failed("the endoscope's circle is not masked in the corner")


def landmark(log):
    return log.pose["landmarks"][TARGET]


def operate(log, folder):
    log.wait("the first pose", lambda: log.pose, 60)
    found = subprocess.run(["xdotool", "search", "--name", "^Trocar"], capture_output=True, text=True).stdout.split()
    if not found:
        raise Failed("no window named Trocar")
    xdo("mousemove", 400, 320)
    hand = Hand(log)

    # Tab leads the next instrument, 1 the first again.
    xdo("key", "Tab")
    log.wait("Tab to lead the scissors", lambda: log.pose["led"] == "scissors", 20)
    xdo("key", "1")
    log.wait("1 to lead the grasper", lambda: log.pose["led"] == "left_lateral", 20)
    hand.settled()

    # To a place from which the shaft points at the tube, the jaws turned across it, then in.
    def approach(short_mm):
        tool, at = hand.tool(), landmark(log)["at_mm"]
        port = add(tool["tip_mm"], tool["shaft"], -tool["depth_mm"])
        return add(at, unit(add(at, port, -1)), -short_mm)
    hand.move(approach(20), 3, "going before the tube")
    hand.roll_across(landmark(log)["along"])
    deep = -DEEP_IN_JAWS * hand.tool()["jaw_mm"]
    hand.move(approach(deep), 3, "the tube between the jaws")

    # Grasp: the left button closes, Space keeps the grip.
    xdo("mousedown", 1)
    log.wait("the grasper to grasp", lambda: log.happened("grasped", tool="left_lateral"), 30)
    log.wait("the handle to close", lambda: hand.tool()["handle"] > 0.98, 30)
    xdo("key", "space")
    xdo("mouseup", 1)
    hand.settled()
    if hand.tool()["holds"] == 0:
        raise Failed("the grip was lost although the ratchet holds")
    if "tube_left" not in log.happened("grasped", tool="left_lateral")[-1]["text"]:
        raise Failed("grasped something else: " + log.happened("grasped")[-1]["text"])

    # Pull: out along the shaft and up in the picture, and the tube comes along.
    before, tip = landmark(log)["at_mm"], hand.tool()["tip_mm"]
    hand.move(add(add(tip, hand.tool()["shaft"], -6), log.pose["picture"]["up"], 4), 4, "pulling")
    moved, pull = math.dist(before, landmark(log)["at_mm"]), hand.tool()["pull_N"]
    if moved < 2 or pull < 0.02:
        raise Failed(f"the tube did not come along: it moved {moved:.1f} mm, pull {pull:.2f} N")
    xdo("key", "F12")
    picture = log.wait("the picture", lambda: log.happened("picture"), 20)[-1]["file"]
    check_picture(os.path.join(folder, picture))

    # Release: the ratchet off, the handle opens by itself.
    xdo("key", "space")
    log.wait("the grasper to let go", lambda: log.happened("released", tool="left_lateral"), 30)
    log.wait("the pull to end", lambda: hand.tool()["pull_N"] == 0, 20)
    print(f"grasped, pulled {moved:.1f} mm with {pull:.2f} N, released; {log.pose['tick']} ticks")

    # Help and menu; quit from there.
    for key in ("F1", "F1", "Escape"):
        xdo("key", key)
    tick = log.pose["tick"]
    time.sleep(0.5)
    log.read()
    time.sleep(0.5)
    ticks = log.pose["tick"]
    log.read()
    if log.pose["tick"] != ticks and log.pose["tick"] > tick + 600:
        raise Failed("time goes on in the menu")
    xdo("key", "q")
    log.wait("the end", lambda: log.happened("end"), 20)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if not shutil.which("xdotool"):
        print("xdotool is missing: apt-get install xdotool")
        return 77
    program = os.path.abspath(sys.argv[1])
    keep = len(sys.argv) > 2
    folder = os.path.abspath(sys.argv[2]) if keep else tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "log.jsonl")
    if os.path.exists(path):
        os.remove(path)
    process = subprocess.Popen(
        [program, "train", "gynaecology/sterilisation", "--size", "1000x640", "--record", "attempt.rec", "--log", path,
         "--trainee", "window test", "--json"], cwd=folder, stdout=subprocess.PIPE, text=True)
    try:
        operate(Log(path, process), folder)
        out, _ = process.communicate(timeout=30)
        result = json.loads(out)
        if process.returncode != 1 or not result.get("interrupted") or result["grasps"] < 1:
            raise Failed(f"exit {process.returncode}, result {out}")
        verified = subprocess.run([program, "replay", "attempt.rec", "--verify"], cwd=folder, timeout=PATIENCE)
        if verified.returncode != 0:
            raise Failed("the recording of the attempt does not verify")
    except (Failed, subprocess.TimeoutExpired) as failure:
        print(f"FAILED: {failure}")
        return 1
    finally:
        if process.poll() is None:
            process.kill()
        process.wait()
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
