#!/usr/bin/env python3
"""Organs from elsewhere in the modeller's real window: each of five surfaces, and a segment of a CT, is imported, operated
on after the remedies that are offered, and grasped in the trainer. A new organ comes first.

    tools/with_xvfb.sh 1280x720 python3 tests/app/modeller_import_test.py PATH/TO/trocar [--only NAME...]

The files lie in shared/data beside the checkout; those that are missing are skipped, all of them: 77.
MODELLER_PICTURES=FOLDER keeps a picture of each step. Exit: 0 passed, 1 failed, 77 something is missing.
"""
import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from modeller_test import Modeller, check, shown
from trainee import Eyes, Failed, MouseAndKeys, Trainee, add, unit, xdo

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT.parent / "shared" / "data"
SURFACES = {
    "liver": DATA / "anatomy/sofa/liver-smooth.obj",
    "uterus": DATA / "anatomy/hubmap_ccf/VH_F_Uterus.glb",
    "gallbladder": DATA / "anatomy/hubmap_ccf/VH_F_Gallbladder.glb",
    "ovary": DATA / "anatomy/hubmap_ccf/VH_F_Ovary_L.glb",
    "tetrahedra": DATA / "anatomy/sofa/liver.msh",
}
REMEDIES = ("Attach here", "Rest it on its underside", "Bring into view", "Scale to")
CT = DATA / "volumes/totalsegmentator/example_ct_dicom_raw"


class Child:
    """The trainer, which is the modeller's child."""

    def __init__(self, pid):
        self.pid, self.returncode = pid, None

    def poll(self):
        return None if Path(f"/proc/{self.pid}").exists() else 0


def trainer_of(m, count):
    m.eyes.wait("the trainer's window", lambda: len(m.eyes.happened("trainer", up=True)) >= count, 180)
    pid = int(subprocess.run(["pgrep", "-P", str(m.process.pid)], capture_output=True, text=True).stdout.split()[0])
    return pid


def grasped_at(place, eyes, hands, trainee, hand, what):
    """Towards a place and through it, closing the jaws again and again. Whether they hold something."""
    for depth in (12, 6, 0, -6, -12, -20):  # [mm] before the place
        def goal():
            tool = eyes.tool(hand)
            return add(place, unit(add(tool["port_mm"], place, -1)), depth)
        try:
            trainee.move(goal, 4.0, f"{what}: to the organ", limit=60)
        except Failed:
            pass  # the organ's surface is in between
        hands.close()
        eyes.later(0.7)
        if eyes.tool(hand)["holds"]:
            return True
        hands.let_go()
        time.sleep(1)
    return False


def grasp(m, pid, what, middle):
    """Moves an instrument from its start towards the organ's middle until its jaws are at the surface, and closes."""
    eyes = Eyes(str(m.folder / "data/modeller/trainer_log.jsonl"), Child(pid))
    hands = MouseAndKeys(eyes)
    trainee = Trainee(eyes, hands)
    eyes.wait("the first pose", lambda: eyes.pose and eyes.screen, 120)
    shown(f"{what}_trainer")
    eyes.wait("the hint for newcomers, or time to pass",
              lambda: "Begin" in eyes.screen["widgets"] or eyes.pose["tick"] > 200, 180)
    if "Begin" in eyes.screen["widgets"]:
        hands.press("Begin")
    hand = next(t["name"] for t in eyes.pose["tools"] if t["instrument"] == "grasper")
    trainee.lead(hand)

    def holds():
        return eyes.tool(hand)["holds"]
    right, up = (eyes.pose["picture"][way] for way in ("right", "up"))
    # A hollow organ's middle may lie beside its tissue: then above, below and to the sides of it.
    for aside, above in ((0, 0), (0, 14), (0, -14), (16, 8), (-16, 8)):
        if grasped_at(add(add(middle, right, aside), up, above), eyes, hands, trainee, hand, what):
            break
    if not holds():
        shown(f"{what}_missed")
    check(holds(), f"{what} was grasped")
    shown(f"{what}_grasped")
    hands.let_go()


def operate(m, what, middle, count):
    m.hands.press("Operate")
    remedies = []

    def offered():
        return [w for w in m.eyes.screen["widgets"] if w.startswith(REMEDIES)]
    for _ in range(6):
        m.eyes.wait("checks or the trainer", lambda: m.eyes.screen and
                    (len(m.eyes.happened("operate", started=True)) >= count or offered()), 120)
        if len(m.eyes.happened("operate", started=True)) >= count:
            break
        shown(f"{what}_checks")
        widget = offered()[0]
        remedies.append(widget)
        m.hands.press(widget)
        time.sleep(3)
    pid = trainer_of(m, count)
    time.sleep(2)
    try:
        grasp(m, pid, what, middle)
    finally:
        os.kill(pid, signal.SIGTERM)
        m.eyes.wait("the end of the trainer", lambda: not Path(f"/proc/{pid}").exists(), 60)
        time.sleep(1)
        m.keys("Escape")
    print(f"{what}: grasped, remedies: {remedies or 'none'}")


def press_below(m, widget):
    """Scrolls the panel on the right down to a button and presses it."""
    for _ in range(20):
        time.sleep(1)  # what the last button did may move the others
        m.eyes.read()
        if widget in m.eyes.screen["widgets"]:
            break
        x, y = m.eyes.screen["widgets"]["Make an organ of it"]
        xdo("mousemove", x, y - 250)
        xdo("click", 5)
    m.hands.press(widget)


def leave(m):
    m.menu("File", "Start screen")
    time.sleep(1)
    m.eyes.read()
    if "Do not save" in m.eyes.screen["widgets"]:
        m.hands.press("Do not save")
    m.eyes.on("start")


def session(m, only):
    m.eyes.on("start", 180)
    m.keys("F11")  # as large as the display
    time.sleep(2)
    shown("start")
    count = 0

    if not only or "new" in only:
        count += 1
        m.hands.press("New organ")
        m.eyes.wait("a good build", lambda: any(e["good"] for e in m.eyes.happened("built")), 120)
        shown("new_organ")
        operate(m, "new_organ", [0, -150, -110], count)
        leave(m)
    for what, file in SURFACES.items():
        if (only and what not in only) or not file.exists():
            continue
        count += 1
        m.hands.press("New scene")
        m.menu("File", "Import an organ ...")
        m.fill("file name", str(file))
        m.hands.press("Open")
        m.eyes.where("unit mm", 120)
        shown(f"{what}_import")
        imported = len(m.eyes.happened("imported"))
        m.hands.press("Import")
        m.happened("imported", imported + 1, 180)
        time.sleep(5)
        shown(f"{what}_imported")
        lens = unit([0, -55, -35])
        operate(m, what, add([0, -55, -35], lens, 120), count)
        leave(m)
    if (not only or "ct" in only) and CT.exists():
        count += 1
        m.hands.press("Open a scan")
        m.fill("file name", str(sorted(CT.iterdir())[0]))
        m.hands.press("Open")
        m.hands.press("4 Threshold", 120)
        m.hands.press("preset")
        m.hands.press("preset Liver")
        time.sleep(1)  # the list closes
        shown("ct_threshold")
        for button, said in (("Apply", "Threshold"), ("Largest part",) * 2, ("Fill holes",) * 2, ("Smooth",) * 2):
            press_below(m, button)
            m.eyes.wait(f"an answer to {button}",
                        lambda: any(e["said"].startswith(said) for e in m.eyes.happened("scan")), 120)
        shown("ct_segment")
        m.hands.press("Make an organ of it")
        m.eyes.wait("an organ", lambda: m.eyes.happened("organ") or m.eyes.happened("refused"), 180)
        check(m.eyes.happened("organ"), f"an organ of the segment: {m.eyes.happened('refused')}")
        time.sleep(5)
        shown("ct_organ")
        lens = unit([0, -55, -35])
        operate(m, "ct", add([0, -55, -35], lens, 150), count)
        leave(m)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--only", nargs="*", default=[])
    o = parser.parse_args()
    if not os.environ.get("DISPLAY") or not shutil.which("xdotool") or not any(f.exists() for f in SURFACES.values()):
        print("no display, no xdotool or no shared data: skipped")
        return 77
    folder = tempfile.mkdtemp(prefix="trocar-modeller-")
    try:
        m = Modeller(os.path.abspath(o.program), folder)
        try:
            session(m, o.only)
        except Failed:
            shown("failed")
            raise
        finally:
            m.kill()
    except Failed as failed:
        print(f"FAILED: {failed}")
        return 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print("passed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
