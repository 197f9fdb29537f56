#!/usr/bin/env python3
"""The design view of a mechanism in its window: a grasper that is drawn with a fault is optimised, saved, taken back, and
the file that was saved is free of the fault by the study of the command line.

    tools/with_xvfb.sh 1280x800 python3 tests/app/design_test.py PATH/TO/trocar [FOLDER]

Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import json
import os
import subprocess
import sys

from trainee import Failed, in_a_room, xdo


def clearance_of(room, file):
    told = subprocess.run([room.program, "mechanism", file, "clearance", "--json"], capture_output=True, text=True)
    return json.loads(told.stdout)["least_mm"], told.returncode


def design(room):
    eyes, hands = room.eyes, room.hands
    eyes.on("design", 60)
    drawn = eyes.screen["dials"]
    if eyes.screen["least_mm"] >= 0:
        raise Failed("it is drawn with a fault, and none is shown")
    hands.press("Optimise")
    eyes.wait("the optimiser", lambda: eyes.happened("optimised"), 120)
    eyes.wait("a free mechanism", lambda: eyes.screen["least_mm"] > 0, 30)
    found = eyes.screen["dials"]
    hands.press("Save")
    eyes.wait("the file", lambda: eyes.happened("saved", written=True), 30)
    least, status = clearance_of(room, os.path.join(room.folder, "colliding_grasper_changed.json"))
    if least <= 0 or status != 0:
        raise Failed(f"the saved mechanism is not free: {least} mm")
    hands.press("Undo")
    eyes.wait("the mechanism as it was drawn", lambda: eyes.screen["dials"] == drawn, 30)
    xdo("key", "ctrl+y")
    eyes.wait("what was found", lambda: eyes.screen["dials"] == found, 30)
    xdo("key", "space")  # its drive goes to and fro
    xdo("key", "Escape")
    print(f"from {clearance_of(room, 'colliding_grasper')[0]:.3f} to {least:.3f} mm")


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, design, ["colliding_grasper", "design"], command=("mechanism",)))
