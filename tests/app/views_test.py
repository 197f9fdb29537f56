#!/usr/bin/env python3
"""Drives layouts, pane cameras and the second window in the real window: while practising they obey keys, buttons and
dragging, and closing the second window ends nothing; while an attempt counts there is only the endoscope.

    tools/with_xvfb.sh python3 tests/app/views_test.py PATH/TO/trocar

Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import ctypes
import os
import shutil
import subprocess
import sys
import tempfile
import time

from trainee import Eyes, Failed, MouseAndKeys, xdo


def windows():
    found = subprocess.run(["xdotool", "search", "--name", "^Trocar$"], capture_output=True, text=True)
    return [int(w) for w in found.stdout.split()]


class ClientMessage(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong),
                ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("room", ctypes.c_long * 24)]


def ask_to_close(window):
    """What a window manager sends when its cross is pressed."""
    x = ctypes.CDLL("libX11.so.6")
    x.XOpenDisplay.restype = ctypes.c_void_p
    x.XInternAtom.restype = ctypes.c_ulong
    x.XInternAtom.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
    x.XSendEvent.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
    x.XSync.argtypes = [ctypes.c_void_p, ctypes.c_int]
    display = x.XOpenDisplay(None)
    event = ClientMessage(type=33, window=window, format=32)
    event.message_type = x.XInternAtom(display, b"WM_PROTOCOLS", 0)
    event.data[0] = x.XInternAtom(display, b"WM_DELETE_WINDOW", 0)
    x.XSendEvent(display, window, 0, 0, ctypes.byref(event))
    x.XSync(display, 0)


def views(eyes, what, condition):
    return eyes.wait(what, lambda: eyes.happened("views") and condition(eyes.happened("views")[-1])
                     and eyes.happened("views")[-1], 60)


def shown(entry):
    return [p["shows"] for p in entry["panes"]]


def drag_in(pane, hands):
    x, y, width, height = pane["area"]
    xdo("mousemove", int(x + width - 40), int(y + 30), "mousedown", 1)
    for _ in range(6):
        time.sleep(0.15)
        xdo("mousemove_relative", "--", -12, 5)
    time.sleep(0.2)
    xdo("mouseup", 1)


def practise(eyes, hands):
    hands.press("Begin")
    eyes.on("exercise")
    views(eyes, "one pane at first", lambda v: v["layout"] == "one" and shown(v) == ["endoscope"])
    hands.key("F2")
    views(eyes, "F2 to show two", lambda v: v["layout"] == "side-by-side" and shown(v) == ["endoscope", "outside"])
    hands.pause()
    eyes.on("pause")
    hands.press("Views")
    eyes.on("views")
    hands.press("four##layout")
    four = views(eyes, "four panes", lambda v: len(v["panes"]) == 4)
    hands.press("pressure")
    views(eyes, "pressure among the figures", lambda v: v["pressure"])
    drag_in(four["panes"][1], hands)
    views(eyes, "dragging to turn the outside camera", lambda v: abs(v["outside_yaw"] - four["outside_yaw"]) > 0.1)
    hands.press("left##second scope")
    views(eyes, "the second endoscope to be aimed", lambda v: v["second_yaw"] != four["second_yaw"])
    hands.press("analysis##first")
    views(eyes, "panes exchanged", lambda v: shown(v)[0] == "analysis" and shown(v)[3] == "endoscope")
    hands.press("Close")
    eyes.on("pause")
    hands.press("Display")
    eyes.on("display")
    hands.press("Close")
    eyes.on("pause")

    hands.key("F3")
    eyes.wait("the second window", lambda: eyes.happened("second-window", open=True), 60)
    second = eyes.wait("it on the display", windows, 20)
    ask_to_close(second[-1])
    eyes.wait("it to be closed", lambda: eyes.happened("second-window", open=False), 60)
    hands.press("Resume")
    eyes.on("exercise")
    tick = eyes.pose["tick"]
    eyes.wait("the exercise to go on without it", lambda: eyes.pose["tick"] > tick + 100, 60)


def attempt(eyes, hands):
    """With the settings that the practice has left: four panes, no second window."""
    eyes.on("exercise", 60)  # the three things to know are known
    views(eyes, "nothing but the endoscope", lambda v: v["layout"] == "one" and shown(v) == ["endoscope"])
    hands.key("F2")
    hands.key("F3")
    eyes.wait("the second window", lambda: eyes.happened("second-window", open=True), 60)
    time.sleep(1)
    if any(v["layout"] != "one" for v in eyes.happened("views")):
        raise Failed("an attempt that counts was looked at from elsewhere")
    hands.pause()
    eyes.on("pause")
    if "Views" in eyes.screen["widgets"]:
        raise Failed("views are offered while it counts")


def run(program, folder, words, what):
    path = os.path.join(folder, "log.jsonl")
    if os.path.exists(path):
        os.remove(path)
    environment = dict(os.environ, TROCAR_DATA=os.path.join(folder, "data"), BROWSER="true")
    process = subprocess.Popen([program, "train", "gynaecology/sterilisation", "--size", "1000x640", "--log", path,
                                "--trainee", "views test", *words], cwd=folder, env=environment)
    try:
        eyes = Eyes(path, process)
        what(eyes, MouseAndKeys(eyes))
        process.terminate()
        process.wait(60)
    finally:
        if process.poll() is None:
            process.kill()
        process.wait()


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if not shutil.which("xdotool"):
        print("xdotool is missing: apt-get install xdotool")
        return 77
    program, folder = os.path.abspath(sys.argv[1]), tempfile.mkdtemp()
    try:
        run(program, folder, ["--familiarisation"], practise)
        run(program, folder, [], attempt)
    except (Failed, subprocess.TimeoutExpired) as failure:
        print(f"FAILED: {failure}")
        return 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
