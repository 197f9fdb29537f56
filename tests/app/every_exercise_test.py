#!/usr/bin/env python3
"""Every exercise and every free practice of the start screen, with fresh data: found by its group, started with at most
three clicks, and under control at once: what is controlled moves with the mouse.

    tools/with_xvfb.sh 1280x720 python3 tests/app/every_exercise_test.py PATH/TO/trocar [FOLDER]

The window is as large as the display. Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import json
import math
import re
import subprocess
import sys
import time

from start_screen_test import GROUPS, add_person
from trainee import Failed, display_size, in_a_room, xdo

LOADING = 240  # [s] the largest scene, compiled for the first time
MOST_CLICKS = 3
LEAST_MOTION = 0.5  # [mm]


def catalogue(room):
    """Names of the exercises by group, and of all scenes, as `trocar list` has them."""
    listed = json.loads(subprocess.run([room.program, "list", "--json"], env=room.environment, capture_output=True,
                                       text=True, check=True).stdout)
    groups = {}
    for exercise in listed["exercises"]:
        with open(exercise["path"], encoding="utf-8") as file:
            group = re.search(r'"group": "([^"]*)"', file.read())
        groups.setdefault(group[1] if group else "other", []).append(exercise["name"])
    return groups, {scene["name"] for scene in listed["scenes"]}


def scroll(eyes, notches):
    x, y = next(iter(place for name, place in eyes.screen["widgets"].items() if not name.startswith("group ")))
    xdo("mousemove", x, y)
    for _ in range(abs(notches)):
        xdo("click", 5 if notches > 0 else 4)
    time.sleep(0.6)
    eyes.read()


def free_practice(eyes, hands, scenes):
    """Names of the tiles at the end of the list."""
    hands.press("group free practice")
    eyes.where(GROUPS["free practice"])
    found = set()
    while True:
        time.sleep(0.6)
        eyes.read()
        more = {w for w in eyes.screen["widgets"] if w in scenes} - found
        if not more:
            return sorted(found)
        found |= more
        scroll(eyes, 5)


def controlled(eyes):
    """Where the controlled instrument or endoscope is: [mm], and 100 times its direction."""
    if eyes.pose["led"] == "scope":
        picture = eyes.pose["picture"]
        return picture["eye_mm"] + [100 * x for x in picture["forward"]]
    tool = eyes.tool()
    return tool["tip_mm"] + [100 * x for x in tool["shaft"]]


def start(eyes, hands, group, name):
    """The number of clicks from the tiles to the exercise."""
    attempts, clicks = len(eyes.happened("attempt")), 0
    if name not in eyes.screen["widgets"]:
        hands.press(f"group {group}")
        clicks += 1
        time.sleep(0.6)
        eyes.read()
    for _ in range(20):  # a group that is longer than the window
        if name in eyes.screen["widgets"]:
            break
        scroll(eyes, 2)
    hands.press(name)
    eyes.on("details")
    eyes.wait("the scene to be ready", lambda: "Start" in eyes.screen["widgets"], LOADING)
    hands.press("Start")
    clicks += 2
    eyes.wait("the exercise", lambda: len(eyes.happened("attempt")) > attempts, LOADING)
    eyes.wait("its first picture", lambda: eyes.screen["name"] in ("hint", "exercise"), LOADING)
    if eyes.screen["name"] == "hint":  # what is told once, before the first exercise of a person
        hands.enter()
    eyes.on("exercise", LOADING)
    return clicks


def control(eyes, hands, name):
    """What is controlled follows the mouse from its first movement."""
    eyes.wait("the exercise to begin", lambda: eyes.pose and 0 < eyes.pose["tick"] < 20000, 120)
    eyes.later(0.2)
    if not eyes.pose["led"]:
        raise Failed(f"{name}: nothing is controlled")
    before = controlled(eyes)

    def moved():
        return math.dist(before, controlled(eyes))
    for right, up in ((6e-3, 0), (-6e-3, 6e-3), (0, -6e-3)):
        hands.sideways(right, up)
        if eyes.within(3, lambda: moved() > LEAST_MOTION):  # a slow picture reads the mouse seldom
            return moved()
    raise Failed(f"{name}: {eyes.pose['led']} does not follow the mouse ({moved():.2f} mm)")


def leave(eyes, hands):
    hands.pause()
    eyes.on("pause")
    hands.press("End exercise")
    eyes.on("confirm")
    hands.press("Yes, end exercise")
    eyes.on("result", LOADING)
    hands.press("Back")
    eyes.on("exercises", 60)
    time.sleep(0.3)


def every_exercise(room):
    eyes, hands = room.eyes, room.hands
    add_person(eyes, hands)
    eyes.on("exercises")
    begun = 0
    groups, scenes = catalogue(room)
    groups["free practice"] = free_practice(eyes, hands, scenes)
    if set(groups) != set(GROUPS):
        raise Failed(f"the groups are {sorted(groups)}")
    for group, names in groups.items():
        print(f"{group}: {len(names)}", flush=True)
        for name in names:
            clicks = start(eyes, hands, group, name)
            if clicks > MOST_CLICKS:
                raise Failed(f"{name}: {clicks} clicks")
            moved = control(eyes, hands, name)
            print(f"  {name}: {clicks} clicks, {eyes.pose['led']} moved {moved:.1f} mm", flush=True)
            leave(eyes, hands)
            begun += 1
    print(f"{begun} exercises and scenes under control, each after at most {MOST_CLICKS} clicks")


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, every_exercise, [], command=("train", "--size", display_size())))
