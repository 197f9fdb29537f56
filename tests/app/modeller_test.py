#!/usr/bin/env python3
"""Drives the modeller's real window by mouse and keys: a new organ is operated on at once; in a scene a ball is added,
moved, a point dragged, undone, saved, tried and operated on; then it is killed, and its unsaved changes are offered again.

    tools/with_xvfb.sh 1400x900 python3 tests/app/modeller_test.py PATH/TO/trocar [--kills N]

--kills N instead: killed at N random moments while somebody works; nothing older than two seconds may be lost.
Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import argparse
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from trainee import Eyes, Failed, MouseAndKeys, xdo

MOST_LOST = 2.0  # [s] of work: the file of what is unsaved is written at most a second after a change


def check(condition, what):
    if not condition:
        raise Failed(what)


class Modeller:
    def __init__(self, program, folder, file=None, name="log"):
        self.folder = Path(folder)
        self.log = self.folder / f"{name}.jsonl"
        environment = dict(os.environ, TROCAR_DATA=str(self.folder / "data"))
        words = [program, "model", *([str(file)] if file else []), "--log", str(self.log)]
        self.process = subprocess.Popen(words, cwd=folder, env=environment)
        self.eyes = Eyes(str(self.log), self.process)
        self.hands = MouseAndKeys(self.eyes)

    def happened(self, what, count, limit=60, **details):
        return self.eyes.wait(f"{what} {details} no. {count}",
                              lambda: len(self.eyes.happened(what, **details)) >= count, limit)

    def menu(self, menu, item):
        self.hands.press(f"menu {menu}")
        self.hands.press(item)

    def fill(self, field, text):
        self.eyes.where(field)
        time.sleep(0.6)  # a panel that has just appeared finds its size
        self.eyes.read()
        x, y = self.eyes.where(field)
        xdo("mousemove", x, y)
        time.sleep(0.3)
        xdo("click", 1)
        time.sleep(0.4)
        xdo("key", "End")
        xdo("key", "--repeat", 100, "--delay", 12, "BackSpace")  # whatever stands there
        time.sleep(0.2)
        xdo("type", "--delay", 30, text)
        time.sleep(0.3)

    def keys(self, *keys):
        for key in keys:
            xdo("key", key)
            time.sleep(0.25)

    def over_view(self, across=0.5, down=0.5):
        x, y, width, height = self.eyes.screen["view"]
        xdo("mousemove", int(x + across * width), int(y + down * height))
        time.sleep(0.3)

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()


def centre_of(file):
    """The first section's centre, as the file says it."""
    text = file.read_text(encoding="utf-8")
    return [float(v) for v in re.search(r'"centre_mm": \[([^\]]*)\]', text).group(1).split(",")]


def save_as(m, path, count=1):
    m.keys("ctrl+s")
    m.fill("file name", str(path))
    m.hands.press("Save")
    m.happened("saved", count)


def begin_with_a_ball(m, begun=1):
    m.hands.press("New scene")
    m.happened("begun", begun)
    m.menu("Add", "Ball or ellipsoid ...")
    m.hands.press("Add")
    m.happened("step", 1, do="ellipsoid")
    m.menu("Add", "Attach the chosen body ...")
    m.fill("ask radius_mm", "9")
    m.hands.press("Add")
    m.happened("step", 1, do="hold")
    m.eyes.wait("a good build", lambda: any(e["good"] for e in m.eyes.happened("built")), 60)


def drag(m, *places):
    m.over_view(*places[0])
    xdo("mousedown", 1)
    for place in places[1:]:
        m.over_view(*place)
    xdo("mouseup", 1)
    time.sleep(0.4)


def shown(name):
    """A picture of the window, where somebody asked for them: MODELLER_PICTURES=folder."""
    if folder := os.environ.get("MODELLER_PICTURES"):
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-f", "x11grab", "-i", os.environ["DISPLAY"], "-frames:v", "1",
                        str(Path(folder) / f"{name}.png")], check=False)


def paint(m, file):
    """Strokes of the brush on the chosen body, which fills the middle of the view; a mark and a port beside it."""
    m.keys("f", "b")
    m.hands.press("paint stiffness")
    drag(m, (0.44, 0.5), (0.48, 0.5), (0.52, 0.5))
    m.happened("step", 1, do="paint")
    shown("stiffness")
    m.keys("ctrl+s")
    m.happened("saved", 9)
    check('"regions"' in file.read_text(encoding="utf-8"), "painted stiffness is in the file")
    m.hands.press("paint hold")
    drag(m, (0.5, 0.44), (0.5, 0.48))
    m.happened("step", 2, do="paint")
    shown("hold")
    xdo("keydown", "shift")
    drag(m, (0.5, 0.44), (0.5, 0.48))
    xdo("keyup", "shift")
    m.happened("step", 3, do="paint")
    m.keys("b")
    m.menu("Scene", "Add a mark ...")
    m.over_view(0.5, 0.5)
    xdo("click", 1)
    m.hands.press("Add")
    m.happened("step", 1, do="mark")
    m.menu("Scene", "Position of the patient ...")
    m.fill("ask head_down_deg", "20")
    m.hands.press("Add")
    m.happened("step", 1, do="tilt")
    m.keys("ctrl+s")
    m.happened("saved", 10)
    text = file.read_text(encoding="utf-8")
    check('"on": "organ"' in text and '"gravity_m_s2"' in text, "mark and tilt are in the file")
    m.eyes.wait("a good build of it", lambda: m.eyes.happened("built")[-1]["good"], 60)
    shown("mark")
    m.hands.press("solid:organ")


def by_gizmo(m, file):
    """An arrow pressed and a number typed, a cube and a ring dragged; each is undone."""
    m.keys("f")
    before = centre_of(file)
    for i, part in enumerate(("move x", "scale z", "rotate x")):
        m.eyes.wait(f"the gizmo's {part}", lambda: part in m.eyes.screen.get("gizmo", {}), 20)
        time.sleep(0.6)
        m.eyes.read()
        x, y = m.eyes.screen["gizmo"][part]
        xdo("mousemove", int(x), int(y))
        time.sleep(0.2)
        shown("gizmo")
        xdo("mousedown", 1)
        time.sleep(0.3)
        for step in range(1, 6):
            xdo("mousemove", int(x) + 5 * step, int(y) - 4 * step)
            time.sleep(0.12)
        if part == "move x":
            m.keys("4")
        xdo("mouseup", 1)
        m.happened("gesture", 2 + i, kept=True)
        did = m.eyes.happened("step")[-1]["do"]
        check(did == {"move x": "move", "scale z": "stretch", "rotate x": "rotate"}[part], f"{part} did {did}")
        if part == "move x":
            m.keys("ctrl+s")
            m.happened("saved", 3)
            check(abs(centre_of(file)[0] - before[0] - 4) < 1e-6, f"4 mm along x: {centre_of(file)} after {before}")
        m.keys("ctrl+z")
    m.keys("ctrl+s")
    m.happened("saved", 4)
    check(centre_of(file) == before, "all of it undone")


def trainer_opens_and_ends(m, count):
    """Operate has been pressed: the trainer comes up; it is ended as by its own Quit."""
    m.happened("operate", count, started=True)
    m.happened("trainer", count, up=True)
    children = subprocess.run(["pgrep", "-P", str(m.process.pid)], capture_output=True, text=True).stdout.split()
    check(len(children) == 1, f"one trainer: {children}")
    os.kill(int(children[0]), signal.SIGTERM)
    m.eyes.wait("the end of the trainer", lambda: len([e for e in m.eyes.happened("trainer") if "status" in e]) >= count, 60)
    if m.eyes.happened("trainer")[-1]["status"] != 0:
        m.keys("Escape")
    check(not Path(f"/proc/{children[0]}").exists(), "no zombie is left")


def new_organ(m):
    """New organ, Operate: nothing more to press. Esc closes dialogues; F1 stays below a question."""
    m.eyes.on("start")
    m.hands.press("New organ")
    m.happened("begun", 1)
    m.eyes.wait("a good build", lambda: any(e["good"] for e in m.eyes.happened("built")), 60)
    shown("new_organ")
    m.hands.press("Operate")
    trainer_opens_and_ends(m, 1)
    m.keys("F1")
    m.eyes.where("Close")
    m.keys("Escape")
    m.eyes.wait("help closed", lambda: "Close" not in m.eyes.screen["widgets"], 20)
    m.menu("File", "Start screen")
    m.eyes.on("start")


def unready(m):
    """An organ that is not attached and out of view is operated on after two remedies."""
    m.hands.press("New scene")
    m.happened("begun", 2)
    m.menu("Add", "Ball or ellipsoid ...")
    m.fill("ask centre_mm", "200, 300, 0")
    m.hands.press("Add")
    m.happened("step", 1, do="ellipsoid")
    m.hands.press("Operate")
    m.happened("checks", 1)
    shown("checks")
    m.hands.press("Attach here")
    m.eyes.wait("the next finding", lambda: "Attach here" not in m.eyes.screen["widgets"], 60)
    time.sleep(1)  # the panel finds its new size
    m.hands.press("Bring into view")
    trainer_opens_and_ends(m, 2)
    m.menu("File", "Start screen")
    m.hands.press("Do not save")
    m.eyes.on("start")


def session(program, folder):
    m = Modeller(program, folder)
    new_organ(m)
    unready(m)
    m.eyes.events.clear()
    begin_with_a_ball(m)
    save_as(m, Path(folder) / "mine.json")
    m.hands.press("solid:organ")
    m.eyes.wait("points of the ball", lambda: m.eyes.screen["selected"] == "solid:organ" and m.eyes.screen["points"], 30)

    # exactly 12 mm to the front, by keys
    m.over_view()
    m.keys("g", "z", "1", "2", "Return")
    m.happened("gesture", 1, kept=True)
    m.keys("ctrl+s")
    m.happened("saved", 2)
    file = Path(folder) / "mine.json"
    before = centre_of(file)
    check(abs(before[2] - (-110 + 12)) < 1e-6, f"moved by 12 mm exactly: {before}")

    by_gizmo(m, file)

    # a point dragged with the mouse, undone, done again
    time.sleep(1.0)
    m.eyes.read()
    x, y = m.eyes.screen["points"][0]
    xdo("mousemove", x, y, "mousedown", 1)
    time.sleep(0.4)
    for i in range(1, 6):
        xdo("mousemove", x + 6 * i, y - 4 * i)
        time.sleep(0.15)
    xdo("mouseup", 1)
    m.happened("gesture", 5)
    m.keys("ctrl+s")
    m.happened("saved", 5)
    dragged = centre_of(file)
    check(sum(abs(a - b) for a, b in zip(dragged, before)) > 1, f"a dragged point has moved: {before} {dragged}")
    m.keys("ctrl+z", "ctrl+s")
    m.happened("saved", 6)
    check(centre_of(file) == before, "undone, the file says what it said")
    m.keys("ctrl+shift+z", "ctrl+s")
    m.happened("saved", 7)
    check(centre_of(file) == dragged, "done again, it says the other")

    # a cord drawn from place to place
    m.menu("Add", "Draw a tube or cord")
    for across, down in ((0.25, 0.75), (0.45, 0.8), (0.65, 0.75)):
        m.over_view(across, down)
        xdo("click", 1)
        time.sleep(0.4)
    m.keys("Return")
    m.hands.press("Add")
    m.happened("step", 1, do="cord")
    m.keys("ctrl+s")
    m.happened("saved", 8)
    check("centreline_mm" in file.read_text(encoding="utf-8"), "the cord is in the file")
    m.hands.press("solid:organ")
    paint(m, file)

    # a body from another program's file
    cube = Path(folder) / "cube.obj"
    corners = [f"v {100 + 20 * (i & 1)} {-150 + 20 * (i >> 1 & 1)} {-110 + 20 * (i >> 2)}" for i in range(8)]
    sides = ["f 1 3 4 2", "f 5 6 8 7", "f 1 2 6 5", "f 3 7 8 4", "f 1 5 7 3", "f 2 4 8 6"]
    cube.write_text("\n".join(corners + sides) + "\n", encoding="utf-8")
    m.menu("File", "Import an organ ...")
    m.fill("file name", str(cube))
    m.hands.press("Open")
    m.eyes.where("unit mm")
    shown("import")
    m.hands.press("Import")
    m.happened("imported", 1)
    shown("from_file")
    m.keys("ctrl+z", "ctrl+z")  # its attachment, and itself
    m.hands.press("solid:organ")

    # the test drive takes hold of the ball
    m.keys("f")
    m.keys("t")
    m.over_view()
    xdo("mousedown", 1)
    m.eyes.wait("the grasper to take hold", lambda: m.eyes.happened("drive", holds=True), 60)
    m.over_view(0.5, 0.35)
    time.sleep(0.5)
    xdo("mouseup", 1)
    m.eyes.wait("the grasper to let go", lambda: m.eyes.happened("drive", holds=False), 60)
    m.keys("t")

    # the trainer opens on it
    m.keys("F5")
    trainer_opens_and_ends(m, 1)

    # killed with something unsaved: it is offered again
    m.over_view()
    m.keys("g", "x", "7", "Return")
    m.happened("gesture", 6)
    time.sleep(MOST_LOST)
    m.kill()
    check(centre_of(file) == dragged, "nothing half saved")
    again = Modeller(program, folder, name="again")
    again.eyes.where("Recover")
    again.keys("F1")
    check("Close" not in again.eyes.screen.get("widgets", {}), "help stays closed below the question")
    again.hands.press("Recover")
    again.happened("recovered", 1)
    again.keys("ctrl+s")
    again.happened("saved", 1)
    check(abs(centre_of(file)[0] - dragged[0] - 7) < 1e-6, "what was not saved is there again")

    # closing with nothing unsaved just ends
    again.keys("ctrl+q")
    again.process.wait(timeout=20)
    check(again.process.returncode == 0, f"it ends well: {again.process.returncode}")


def kills(program, folder, count, seed):
    """Moves by a millimetre each, without saving; what comes back is what was done but for the last two seconds."""
    random_moment = random.Random(seed)
    m = Modeller(program, folder)
    m.eyes.on("start")
    begin_with_a_ball(m)
    save_as(m, Path(folder) / "mine.json")
    m.keys("ctrl+q")
    m.process.wait(timeout=20)
    file = Path(folder) / "mine.json"
    start, moves = centre_of(file)[0], 0
    for i in range(count):
        m = Modeller(program, folder, file, name=f"kill{i}")
        m.hands.press("solid:organ")  # a slow picture chooses it late: x alone would delete it
        m.eyes.wait("the ball chosen", lambda: m.eyes.screen["selected"] == "solid:organ", 30)
        m.over_view()
        done = []
        until = time.monotonic() + random_moment.uniform(0.5, 6)
        while time.monotonic() < until:
            m.keys("g", "x", "1", "Return")
            m.eyes.read()
            kept = len(m.eyes.happened("gesture", kept=True))
            while len(done) < kept:
                done.append(time.monotonic())
        killed = time.monotonic()
        m.kill()
        sure = sum(1 for t in done if t < killed - MOST_LOST)
        check(centre_of(file)[0] == start, "the file itself is as it was saved")
        lost = list((Path(folder) / "data" / "modeller" / "unsaved").glob("*.json"))
        found = 0
        if lost:
            texts = json.loads(lost[0].read_text(encoding="utf-8"))["texts"]
            found = float(re.search(r'"centre_mm": \[([^,]*),', texts[0]["text"]).group(1)) - start
            lost[0].unlink()
        check(found >= sure, f"kill {i}: {sure} moves were older than {MOST_LOST} s, {found} came back")
        print(f"kill {i}: {len(done)} moves, {found:.0f} kept")
        moves += len(done)
    check(moves > count, f"somebody worked: {moves} moves before {count} kills")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    o = parser.parse_args()
    if not os.environ.get("DISPLAY") or not shutil.which("xdotool"):
        print("no display or no xdotool: skipped")
        return 77
    folder = tempfile.mkdtemp(prefix="trocar-modeller-")
    try:
        if o.kills:
            kills(os.path.abspath(o.program), folder, o.kills, o.seed)
        else:
            session(os.path.abspath(o.program), folder)
    except Failed as failed:
        print(f"FAILED: {failed}")
        return 1
    finally:
        subprocess.run(["pkill", "-f", folder], check=False)
        shutil.rmtree(folder, ignore_errors=True)
    print("passed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
