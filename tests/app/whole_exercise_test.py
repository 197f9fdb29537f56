#!/usr/bin/env python3
"""The whole sterilisation, both sides, by a robot trainee in the real window: from the start screen to the report.

    tools/with_xvfb.sh python3 tests/app/whole_exercise_test.py PATH/TO/trocar [--gamepad] [FOLDER]

The robot looks (the event log), compares and corrects, with mouse and keys or an emulated gamepad: see trainee.py. It leads
one hand at a time, as every trainee at one mouse does. It surveys, identifies, grasps, presents and has set the first
clip; it does not yet get through reliably from there, so ctest does not run it. Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

from trainee import Eyes, Failed, MouseAndKeys, Pad, Trainee, add, dot, unit

SIDES = [  # tube, who grasps, who cuts, towards which side the tube is lifted
    ("tube_left", "left_lateral", "right_lateral", 1),
    ("tube_right", "right_lateral", "left_lateral", -1)]
APPLIER = "suprapubic"
FIRST_CLIP, APART = 16.0, 9.0  # [mm] from the uterus; between the two
STEPS_A_SIDE = 6


class Surgeon(Trainee):
    """One side after the other, in the words of the step guide."""

    def step(self):
        return self.eyes.pose["step"]

    def await_step(self, number, what, limit=60):
        self.eyes.wait(f"the step '{what}' to be done", lambda: self.step() >= number, limit)

    def take(self, hand, instrument):
        """Another instrument from the rack, brought into view."""
        self.lead(hand)
        if self.eyes.tool()["instrument"] == instrument:
            return
        self.hands.rack()
        self.eyes.on("rack")
        self.hands.press(instrument.replace("_", " "))
        self.eyes.on("exercise")
        self.eyes.wait(f"{instrument} in {hand}", lambda: self.eyes.tool()["instrument"] == instrument, 60)
        self.hands.into_view()
        self.eyes.wait("it to come in", lambda: self.eyes.tool()["depth_mm"] > 30, 60)
        self.settled()

    def park(self, hand, depth_mm=45):
        """Out of the way, under its trocar."""
        self.lead(hand)
        tool = self.eyes.tool()
        if tool["depth_mm"] > depth_mm + 3:
            goal = add(tool["tip_mm"], tool["shaft"], depth_mm - tool["depth_mm"])
            self.move(lambda: goal, 3, f"parking {hand}")

    def identify(self, tube, grasper, number):
        """With the eye where the picture shows it all, else along the tube with the closed grasper."""
        end = time.monotonic() + 15
        while time.monotonic() < end:
            self.eyes.read()
            if self.step() >= number:
                return
            time.sleep(0.1)
        course = self.eyes.pose["strands"][tube]
        self.lead(grasper)
        s = course[-1][0] - 2
        while self.step() < number and s > 8:
            self.move(lambda: add(self.eyes.point(tube, s)[0], [0, 0, 7.5]), 3, "following the tube")
            s -= 5
            self.eyes.read()
        self.await_step(number, "identify", 20)

    def slant(self, tube, s):
        """How far the applier's way to the tube is from square to it: sine."""
        at, along, _ = self.eyes.point(tube, s)
        return dot(unit(add(at, self.eyes.tool(APPLIER)["port_mm"], -1)), along)

    def present(self, tube, grasper, side, s_clip):
        """Raises what the grasper holds until the applier comes square upon the tube and the pull is gentle."""
        self.lead(grasper)
        up = unit([0.35 * side, 0.10, 1.0])
        for _ in range(40):
            slant, pull = self.slant(tube, s_clip), self.eyes.tool(grasper)["pull_N"]
            if (abs(slant) < 0.16 and 0.36 < pull < 1.8) or (pull > 1.6 and abs(slant) < 0.2):
                return
            rise = max(-2.0, min(2.0, 30 * slant)) if pull > 0.38 else 1.5
            if pull > 1.7:
                rise = -1.0
            if abs(rise) < 0.4:
                rise = 0.4 if slant > 0 else -0.4
            goal = add(self.eyes.tool()["tip_mm"], up, rise)
            self.move(lambda: goal, 0.5, "presenting the tube")
        raise Failed(f"not presented: slant {self.slant(tube, s_clip):.2f}, pull {self.eyes.tool(grasper)['pull_N']:.2f} N")

    def grasp(self, tube, grasper, side):
        place = self.eyes.pose["landmarks"][tube + ".ampulla"]
        for attempt in range(4):
            s = place["from_mm"] + (0.30 + 0.06 * attempt) * (place["to_mm"] - place["from_mm"])
            self.reach(grasper, tube, s, lambda: 0.6 * self.eyes.tool(grasper)["jaw_mm"], "grasping")
            self.hands.close()
            self.eyes.wait("the handle to close", lambda: self.eyes.tool()["handle"] > 0.97, 60)
            self.hands.lock()
            self.hands.let_go()
            self.settled()
            if self.eyes.tool()["holds"] > 0:
                return
            self.hands.lock()
            self.back_off(grasper, 15)
        raise Failed("nothing of the tube could be grasped")

    def clip_inside(self, tube, s):
        tool = self.eyes.tool(APPLIER)
        return tool["jaw_mm"] - tool["clip_mm"] + self.eyes.point(tube, s)[2] + 0.5

    def see_both_tips(self):
        """Both legs' tips must be seen when the clip closes: a look from a little aside, if need be."""
        for right, up in ((0, 0), (0.06, 0), (-0.12, 0), (0.06, 0.06), (0, -0.12), (0.08, 0), (-0.16, 0)):
            if right or up:
                self.lead("scope")
                self.hands.look(right, up)
                self.lead(APPLIER)
            tick = self.eyes.pose["tick"]
            self.eyes.wait("a newer look", lambda: self.eyes.pose["tick"] > tick + 300, 30)
            if all(self.eyes.tool(APPLIER)["seen"]):
                return True
        return False

    def clip(self, tube, s, number):
        before = len(self.eyes.pose["clips"])
        self.reach(APPLIER, tube, s, lambda: self.clip_inside(tube, s), "clipping")
        self.see_both_tips()
        self.roll_across(lambda: self.eyes.point(tube, s)[1], 0.04)
        self.move(self.before(APPLIER, tube, s, lambda: self.clip_inside(tube, s), 0), 0.6, "the tube between the legs")
        self.squeeze(lambda: len(self.eyes.pose["clips"]) > before, "the clip", slowly=True, limit=90)
        self.hands.let_go()
        self.eyes.wait("the applier to open", lambda: self.eyes.tool()["handle"] < 0.05, 60)
        self.back_off(APPLIER, 22)
        print(f"clip: {self.eyes.pose['clips'][-1]}, step {self.step()} (wanted {number})", flush=True)

    def cut(self, tube, scissors, number):
        clips = sorted(c["s_mm"] for c in self.eyes.pose["clips"] if c["on"] == tube)
        s = 0.5 * (clips[0] + clips[1])
        cuts = self.eyes.pose["cuts"]
        self.park(APPLIER)
        self.reach(scissors, tube, s, lambda: 0.72 * self.eyes.tool(scissors)["jaw_mm"], "cutting")
        self.squeeze(lambda: self.eyes.pose["cuts"] > cuts, "the cut")
        self.hands.let_go()
        self.eyes.wait("the scissors to open", lambda: self.eyes.tool()["handle"] < 0.05, 60)
        self.back_off(scissors, 22)
        self.park(scissors)
        self.await_step(number, "cut", 20)

    def side(self, tube, grasper, scissors, side, first):
        self.take(grasper, "grasper")
        self.take(scissors, "scissors")
        self.identify(tube, grasper, first + 1)
        self.park(scissors)
        self.grasp(tube, grasper, side)
        self.present(tube, grasper, side, FIRST_CLIP)
        self.await_step(first + 2, "present", 30)
        self.clip(tube, FIRST_CLIP, first + 3)
        self.present(tube, grasper, side, FIRST_CLIP + APART)
        self.clip(tube, FIRST_CLIP + APART, first + 4)
        self.cut(tube, scissors, first + 5)
        self.await_step(first + 6, "check the stumps", 60)
        self.lead(grasper)
        self.hands.lock()
        self.eyes.wait("the grasper to let go", lambda: self.eyes.tool()["holds"] == 0, 60)
        self.park(grasper, 85)


def operate(eyes, hands):
    eyes.on("start", 60)
    hands.press("Start", 120)
    eyes.on("hint")
    hands.enter()
    eyes.on("exercise")
    eyes.wait("a pose", lambda: eyes.pose, 60)
    surgeon = Surgeon(eyes, hands)
    surgeon.await_step(1, "survey", 60)
    for i, (tube, grasper, scissors, side) in enumerate(SIDES):
        surgeon.side(tube, grasper, scissors, side, 1 + STEPS_A_SIDE * i)
        print(f"{tube}: done at {eyes.pose['seconds']:.0f} s, {eyes.pose['tick']} ticks", flush=True)
    eyes.on("result", 60)
    end = eyes.happened("end")[-1]
    hands.press("Open the report")
    page = eyes.wait("the report", lambda: eyes.happened("report"), 180)[-1]["file"]
    if "terilisation" not in open(page, encoding="utf-8").read():
        raise Failed(f"{page} is no report")
    hands.press("Quit")
    return end


def main():
    words = [w for w in sys.argv[1:] if w != "--gamepad"]
    if not words:
        sys.exit(__doc__)
    if not shutil.which("xdotool"):
        print("xdotool is missing: apt-get install xdotool")
        return 77
    program = os.path.abspath(words[0])
    keep = len(words) > 1
    folder = os.path.abspath(words[1]) if keep else tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    path, pipe = os.path.join(folder, "log.jsonl"), os.path.join(folder, "pad")
    environment = dict(os.environ, TROCAR_DATA=os.path.join(folder, "data"), BROWSER="true")
    if os.path.exists(path):
        os.remove(path)
    if "--gamepad" in sys.argv:
        if not os.path.exists(pipe):
            os.mkfifo(pipe)
        environment["TROCAR_GAMEPAD"] = pipe
    process = subprocess.Popen([program, "train", "--size", "1000x640", "--log", path, "--trainee", "robot", "--json"],
                               cwd=folder, env=environment, stdout=subprocess.PIPE, text=True)
    eyes = Eyes(path, process)
    try:
        hands = Pad(eyes, pipe) if "--gamepad" in sys.argv else MouseAndKeys(eyes)
        end = operate(eyes, hands)
        out, _ = process.communicate(timeout=120)
        result = json.loads(out)
        a = result["assessment"]
        print(f"{hands.name}: score {a['score']['total']:.0f}, errors {[e['code'] for e in a['errors']]}")
        undone = [s["name"] for s in a["steps"] if not s["done"]]
        if undone or end["interrupted"]:
            raise Failed(f"not done: {undone}")
    except (Failed, subprocess.TimeoutExpired) as failure:
        for e in eyes.events[-25:]:
            print(e)
        print(f"FAILED ({'gamepad' if '--gamepad' in sys.argv else 'mouse and keys'}): {failure}")
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
