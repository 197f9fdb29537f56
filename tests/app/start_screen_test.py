#!/usr/bin/env python3
"""The start screen with fresh data, by mouse and keys or by an emulated gamepad alone: a person is added, every group is
found, every page is opened, and an exercise runs after three clicks.

    tools/with_xvfb.sh 1280x720 python3 tests/app/start_screen_test.py PATH/TO/trocar [--gamepad] [FOLDER]

Exit: 0 passed, 1 failed, 77 something to run it with is missing.
"""
import json
import os
import sys
import time

from trainee import Failed, Pad, in_a_room, open_exercise, xdo

GROUPS = {"basics": "basics/camera-0", "suturing": "suturing/ligating-loop",
          "gynaecology": "gynaecology/sterilisation", "gallbladder": "cholecystectomy/expose",
          "bowel": "bowel/run-the-bowel", "free practice": "cutting"}
PAGES = {"Recordings": "recordings", "Operating room": "rooms", "Instruments": "instruments", "Instrument box": "box",
         "Team": "team", "More": "more"}


def add_person(eyes, hands):
    """By keys, or with the letters on the screen."""
    eyes.on("person", 60)
    for widget in ("Name", "Add", "Practise without a name"):
        eyes.where(widget)  # in sight without scrolling
    if isinstance(hands, Pad):
        hands.press("abc")
        for letter in "AL":
            hands.press(f"letter {letter}")
        hands.press("Add")
        return "Al"
    hands.press("Name")
    xdo("type", "Ada")
    time.sleep(0.5)
    hands.enter()
    return "Ada"


def see_groups(eyes, hands):
    for group, tile in GROUPS.items():
        hands.press(f"group {group}")
        eyes.where(tile)


def see_pages(eyes, hands):
    for button, page in PAGES.items():
        hands.press(button)
        eyes.on(page)
    hands.leave_menu()
    eyes.on("exercises")


def search(eyes, hands):
    hands.press("Search")
    xdo("type", "hump")
    eyes.wait("only what was searched for", lambda: "cholecystectomy/calot-hump" in eyes.screen["widgets"] and
              "basics/camera-0" not in eyes.screen["widgets"], 30)
    hands.press("x##search")
    eyes.where("basics/camera-0")


def remembered_person(room):
    with open(os.path.join(room.environment["TROCAR_DATA"], "settings.json"), encoding="utf-8") as file:
        return json.load(file)["trainee"]


def start_screen(room):
    eyes, hands = room.eyes, room.hands
    name = add_person(eyes, hands)
    eyes.on("exercises")
    if remembered_person(room) != name:
        raise Failed(f"{name} is not remembered: {remembered_person(room)}")
    see_groups(eyes, hands)
    if not isinstance(hands, Pad):
        search(eyes, hands)
    see_pages(eyes, hands)
    open_exercise(eyes, hands, "basics/camera-0", "basics")
    hands.press("Start", 120)
    eyes.on("hint")
    hands.enter()
    eyes.on("exercise")
    eyes.wait("the exercise to run", lambda: eyes.pose and eyes.pose["tick"] > 0, 60)
    attempt = eyes.happened("attempt")[-1]
    if attempt["trainee"] != name or attempt["mode"] != "assessed":
        raise Failed(f"not an attempt of {name} that counts: {attempt}")


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, start_screen, [], command=("train", "--size", "1280x720")))
