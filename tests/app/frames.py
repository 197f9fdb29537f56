"""Reads what `trocar ... --data FOLDER` leaves (docs/guides/data_frames.md), for the tests beside this."""
import json
import os
import subprocess
import sys

try:
    import numpy
except ImportError:
    print("skipped: needs NumPy")
    sys.exit(77)


def run(program, *words):
    return subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=300)


def expect(condition, what):
    if not condition:
        print(f"FAILED: {what}")
        sys.exit(1)


class Frames:
    """One eye's frames."""

    def __init__(self, folder, eye=""):
        self.folder = os.path.join(folder, eye)
        self.eye = 1 if eye == "right" else 0
        with open(os.path.join(folder, "about.json")) as f:
            self.about = json.load(f)
        with open(os.path.join(folder, "frames.jsonl")) as f:
            self.lines = [json.loads(line) for line in f]

    def layer(self, kind, i):
        return numpy.load(os.path.join(self.folder, kind, self.lines[i]["frame"] + ".npy"))

    def picture(self, i):
        return os.path.join(self.folder, "picture", self.lines[i]["frame"] + ".png")

    def camera(self, i):
        return self.lines[i]["cameras"][self.eye]

    def part(self, name):
        return next(p["number"] for p in self.about["parts"] if p["name"] == name)
