#!/usr/bin/env python3
"""Drives the real window with real mouse and key events, or with an emulated gamepad: from the start screen through a
familiarisation to its end and back, and through a short attempt to its report.

    tools/with_xvfb.sh python3 tests/app/window_test.py PATH/TO/trocar [--gamepad] [FOLDER]

Exit: 0 passed, 1 failed, 77 something to run it with is missing. FOLDER keeps what was written (default: a temporary one).
"""
import json
import math
import os
import struct
import subprocess
import sys
import time
import zlib

from trainee import Failed, Pad, Trainee, add, in_a_room, open_exercise, xdo

EXERCISE = "gynaecology/sterilisation", "gynaecology"
PATIENCE = 300            # [s] for everything at the end


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


def landmark(eyes):
    return eyes.pose["landmarks"]["tube_left.ampulla"]


def begin(eyes, hands, kind):
    """From the start screen into the exercise; the first time three things are told before it begins."""
    open_exercise(eyes, hands, *EXERCISE)
    hands.press(kind, 120)
    eyes.on("hint")
    tick = eyes.pose["tick"] if eyes.pose else 0
    time.sleep(0.5)
    eyes.read()
    if eyes.pose and eyes.pose["tick"] > tick + 50:
        raise Failed("time goes on while the hint is read")
    hands.enter()
    eyes.on("exercise")
    eyes.wait("a pose", lambda: eyes.pose, 60)
    eyes.wait("how fast pictures come", lambda: eyes.happened("rate"), 60)
    rate = eyes.happened("rate")[-1]
    if not (rate["pictures_per_second"] > 0 and 0 <= rate["slowest"] <= 1 and rate["level"] >= 0):
        raise Failed(f"a rate that cannot be: {rate}")


def grasp_and_pull(eyes, trainee, hands):
    grasper = trainee.names()[0]
    trainee.lead(grasper)
    place = landmark(eyes)
    s = 0.7 * place["from_mm"] + 0.3 * place["to_mm"]
    trainee.reach(grasper, "tube_left", s, lambda: 0.6 * eyes.tool(grasper)["jaw_mm"], "grasping")
    trainee.squeeze(lambda: eyes.happened("grasped", tool=grasper), "the grasper to grasp")
    hands.lock()
    hands.let_go()
    trainee.settled()
    if eyes.tool()["holds"] == 0:
        raise Failed("the grip was lost although the jaws are locked")
    before, tip = landmark(eyes)["at_mm"], eyes.tool()["tip_mm"]
    goal = add(tip, [2, 1, 6])
    trainee.move(lambda: goal, 3, "pulling")
    moved, pull = math.dist(before, landmark(eyes)["at_mm"]), eyes.tool()["pull_N"]
    if moved < 1 or pull < 0.02:
        raise Failed(f"the tube did not come along: it moved {moved:.1f} mm, pull {pull:.2f} N")
    print(f"grasped, pulled {moved:.1f} mm with {pull:.2f} N; {eyes.pose['tick']} ticks")


def time_stands_still(eyes):
    time.sleep(0.6)
    eyes.read()
    tick = eyes.pose["tick"]
    time.sleep(0.8)
    eyes.read()
    return eyes.pose["tick"] == tick


def exchange(eyes, trainee, hands):
    """The second hand takes another instrument; it waits in the trocar and then comes into view."""
    hand = trainee.names()[1]
    trainee.lead(hand)
    held, depth = eyes.tool()["instrument"], eyes.tool()["depth_mm"]
    other = next(t for t in eyes.tool()["rack"] if t != held)
    hands.rack()
    eyes.on("rack")
    hands.press(other.replace("_", " "))
    eyes.on("exercise")
    eyes.wait(f"{other} in the hand", lambda: eyes.tool()["instrument"] == other, 60)
    trainee.settled()
    if eyes.tool()["depth_mm"] > 20:
        raise Failed(f"the new instrument is {eyes.tool()['depth_mm']:.0f} mm deep and nobody brought it in")
    hands.into_view()
    eyes.wait("it to come in", lambda: eyes.tool()["depth_mm"] > 30, 60)
    trainee.settled()
    if eyes.tool()["depth_mm"] > depth + 1:
        raise Failed(f"it came in {eyes.tool()['depth_mm']:.0f} mm deep, deeper than it was placed ({depth:.0f} mm)")


def operate(eyes, hands, folder):
    trainee = Trainee(eyes, hands)
    # Familiarisation: grasp and pull, look at help, pause, a picture; without score.
    begin(eyes, hands, "Familiarise")
    grasp_and_pull(eyes, trainee, hands)
    xdo("key", "F12")
    picture = eyes.wait("the picture", lambda: eyes.happened("picture"), 20)[-1]["file"]
    check_picture(os.path.join(folder, picture))
    hands.lock()
    eyes.wait("the grasper to let go", lambda: eyes.happened("released"), 60)
    exchange(eyes, trainee, hands)
    hands.pause()
    eyes.on("pause")
    if not time_stands_still(eyes):
        raise Failed("time goes on in the pause")
    hands.press("Keys and buttons")
    eyes.on("help")
    hands.enter()
    eyes.on("pause")
    hands.press("Settings")
    eyes.on("settings")
    hands.leave_menu()
    eyes.on("pause")
    hands.press("End exercise")
    eyes.on("confirm")
    hands.press("Yes, end exercise")
    eyes.on("result")
    end = eyes.happened("end")[-1]
    if end["passed"] is not None:
        raise Failed(f"a familiarisation was judged: {end}")
    hands.press("Back")

    # An attempt with a score, ended early: result and report.
    open_exercise(eyes, hands, *EXERCISE)
    hands.press("Start")
    eyes.on("exercise")
    tick = eyes.pose["tick"]
    eyes.wait("the new attempt to run", lambda: eyes.pose["tick"] not in (tick,) and eyes.pose["tick"] < 100000, 30)
    hands.pause()
    eyes.on("pause")
    hands.press("End exercise")
    eyes.on("confirm")
    hands.press("Yes, end exercise")
    eyes.on("result")
    if eyes.happened("end")[-1]["passed"] is not False:
        raise Failed("an attempt that was hardly begun is not 'not passed'")
    hands.press("Open report")
    page = eyes.wait("the report", lambda: eyes.happened("report"), 120)[-1]["file"]
    text = open(page, encoding="utf-8").read()
    if "<html" not in text or "terilisation" not in text:
        raise Failed(f"{page} is no report")
    hands.press("Restart")

    # Unplugged in the middle: the exercise holds on and says so. The window is closed in the middle: nothing is lost.
    eyes.on("exercise")
    eyes.wait("time to go on", lambda: eyes.pose["tick"] < 20000 and len(eyes.happened("attempt")) == 3, 30)
    if isinstance(hands, Pad):
        trainee.lead(trainee.names()[0])  # the first step is about the picture: the endoscope is controlled
        hands.hold(0.3, lx=0.5)
        before = eyes.tool()["tip_mm"]
        hands.unplug()
        eyes.on("pause")
        if not time_stands_still(eyes) or math.dist(before, eyes.tool()["tip_mm"]) > 12:
            raise Failed("the instrument moved when the gamepad was unplugged")
        hands.send()
        hands.press("Resume")
        eyes.on("exercise")


def check_store(program, folder, environment):
    listed = subprocess.run([program, "report", "--list", "--json"], cwd=folder, env=environment, capture_output=True,
                            text=True, timeout=PATIENCE)
    attempts = json.loads(listed.stdout)["attempts"]
    found = [(a["mode"], a["state"]) for a in attempts]
    wanted = [("familiarisation", "finished"), ("assessed", "finished"), ("assessed", "aborted")]
    if sorted(found) != sorted(wanted):
        raise Failed(f"the store holds {found}, not {wanted}")
    for a in attempts:
        verified = subprocess.run([program, "replay", a["recording"], "--verify"], cwd=folder, timeout=PATIENCE)
        if verified.returncode != 0:
            raise Failed(f"the recording {a['recording']} does not verify")


def whole_window(room):
    operate(room.eyes, room.hands, room.folder)
    room.process.terminate()  # as closing the window does
    room.process.wait(60)
    check_store(room.program, room.folder, room.environment)


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, whole_window, ["--trainee", "window test"]))
