#!/usr/bin/env python3
"""Leads two instruments at once in the real window, with mouse and keys or with an emulated gamepad.

    tools/with_xvfb.sh python3 tests/app/both_hands_test.py PATH/TO/trocar [--gamepad] [FOLDER]

Both tips move in the same time, one closes its jaws while the other moves, the endoscope turns while both stay; then the
mode is left by the rack, and one hand moves alone. The settings remember it. Exit: 0 passed, 1 failed, 77 something to run it
with is missing.
"""
import json
import math
import os
import sys
import time

from trainee import Failed, Pad, in_a_room, xdo

STILL_MM, MOVED_MM = 0.15, 1.0   # between two poses a tenth of a second apart; over a whole motion


class Watch:
    """Every pose of a stretch of time, so that what moved at once is told from what moved one after the other."""

    def __init__(self, eyes):
        self.eyes, self.poses = eyes, []

    def look(self, seconds):
        """Of simulated time."""
        end, limit = self.eyes.pose["tick"] + 1000 * seconds, time.monotonic() + 30 + 60 * seconds
        while self.eyes.pose["tick"] < end:
            self.eyes.read()
            if not self.poses or self.eyes.pose["tick"] != self.poses[-1]["tick"]:
                self.poses.append(self.eyes.pose)
            if time.monotonic() > limit:
                raise Failed("time does not pass")
            time.sleep(0.01)

    def path(self, hand):
        return [next(t["tip_mm"] for t in p["tools"] if t["name"] == hand) for p in self.poses]

    def steps(self, hand):
        path = self.path(hand)
        return [math.dist(a, b) for a, b in zip(path, path[1:])]

    def way(self, hand):
        path = self.path(hand)
        return math.dist(path[0], path[-1])

    def at_once(self, one, other):
        """In how many pairs of poses both have moved."""
        return sum(a > STILL_MM and b > STILL_MM for a, b in zip(self.steps(one), self.steps(other)))


class MouseAndKeysAtOnce:
    """The mouse leads the right hand, keys the left one."""

    def __init__(self, eyes):
        self.eyes, self.down = eyes, set()

    def toggle(self):
        xdo("key", "h")

    def hold(self, *keys):
        for key in keys:
            xdo("keydown", key)
        self.down |= set(keys)

    def rest(self):
        for key in self.down:
            xdo("keyup", key)
        self.down = set()
        xdo("mouseup", 1)

    def both(self, watch):
        self.hold("Up")
        for _ in range(8):
            xdo("mousemove_relative", "--", 0, -15)
            watch.look(0.1)
        self.rest()

    def left_closes_right_moves(self, watch):
        self.hold("g")
        for _ in range(10):
            xdo("mousemove_relative", "--", 12, 0)
            watch.look(0.1)
        xdo("key", "space")
        self.rest()

    def look(self, watch):
        xdo("key", "0")
        self.eyes.wait("the endoscope to be led", lambda: self.eyes.pose["both"]["looking"], 20)
        for _ in range(5):
            xdo("mousemove_relative", "--", 20, 0)
            watch.look(0.1)
        xdo("key", "Tab")
        self.eyes.wait("the hands to be led", lambda: not self.eyes.pose["both"]["looking"], 20)

    def one(self, watch):
        """Everything that moved two hands."""
        self.both(watch)


class PadAtOnce:
    """Each stick leads the hand of its side."""

    def __init__(self, eyes, pad):
        self.eyes, self.pipe = eyes, pad.pipe

    def send(self, line):
        print(line, file=self.pipe)

    def rest(self, triggers="0 0"):
        self.send(f"0 0 0 0 {triggers}")
        time.sleep(0.15)

    def toggle(self):
        for buttons in ("left_shoulder", "left_shoulder right_shoulder", "left_shoulder right_shoulder y"):
            self.send(f"0 0 0 0 0 0 {buttons}")
            time.sleep(0.15)
        self.rest()

    def both(self, watch):
        self.send("0 -0.7 0 -0.7 0 0")
        watch.look(0.6)
        self.rest()

    def left_closes_right_moves(self, watch):
        self.send("0 0 0.7 0 1 0")
        watch.look(0.9)
        self.send("0 0 0.4 0 1 0 left")  # and locks
        watch.look(0.2)
        self.rest()

    def look(self, watch):
        self.send("0.7 0 0 0 0 0 left_shoulder right_shoulder")
        self.eyes.wait("the endoscope to be led", lambda: self.eyes.pose["both"]["looking"], 20)
        watch.look(0.5)
        self.rest()
        self.eyes.wait("the hands to be led", lambda: not self.eyes.pose["both"]["looking"], 20)

    def one(self, watch):
        """The left stick moves the tip, the right one is its depth: both at once."""
        self.send("0 -0.6 0 0.6 0 0")
        watch.look(0.6)
        self.rest()


def tool(eyes, name):
    return next(t for t in eyes.pose["tools"] if t["name"] == name)


def settle(eyes):
    eyes.later(0.4)
    eyes.read()


def remembered(room):
    path = os.path.join(room.environment["TROCAR_DATA"], "settings.json")
    with open(path, encoding="utf-8") as file:
        return json.load(file)["both_hands"]


def toggle_in_rack(room, on):
    """The way of those who have the mouse alone, and of gamepads without a free finger."""
    room.hands.rack()
    room.eyes.on("rack")
    room.hands.press(f"both hands: {'off' if on else 'on'} (H)")
    room.eyes.on("exercise")


def switch(room, toggle, on):
    toggle()
    room.eyes.wait("the mode to change", lambda: bool(room.eyes.pose["both"]) == on, 20)
    if remembered(room) != on or not room.eyes.happened("both-hands", on=on):
        raise Failed(f"that both hands are led ({on}) is neither remembered nor told")
    settle(room.eyes)


def begin(room):
    eyes = room.eyes
    eyes.on("hint", 120)
    room.hands.enter()
    eyes.on("exercise")
    eyes.wait("a pose", lambda: eyes.pose, 60)
    if eyes.pose["both"] is not None:
        raise Failed("both hands are led, and nobody asked for it")
    time.sleep(0.3)
    settle(eyes)


def both_move(eyes, hands, left, right):
    moving = Watch(eyes)
    hands.both(moving)
    if moving.at_once(left, right) < 2 or min(moving.way(left), moving.way(right)) < MOVED_MM:
        raise Failed(f"the two did not move at once: {moving.steps(left)}, {moving.steps(right)}")
    if any(moving.way(t["name"]) > STILL_MM for t in eyes.pose["tools"] if t["name"] not in (left, right)):
        raise Failed("a third instrument moved, too")
    print(f"at once: {moving.way(left):.1f} mm and {moving.way(right):.1f} mm, "
          f"in {moving.at_once(left, right)} of {len(moving.poses) - 1} poses")
    settle(eyes)


def one_closes(eyes, hands, left, right):
    open_before = tool(eyes, right)["handle"]
    closing = Watch(eyes)
    hands.left_closes_right_moves(closing)
    settle(eyes)
    if tool(eyes, left)["handle"] < 0.9 or abs(tool(eyes, right)["handle"] - open_before) > 0.01:
        raise Failed(f"not the left jaws alone closed: {tool(eyes, left)['handle']}, {tool(eyes, right)['handle']}")
    if closing.way(right) < MOVED_MM or closing.way(left) > 0.5 * closing.way(right):
        raise Failed(f"not the right hand alone moved: {closing.way(left):.1f} mm, {closing.way(right):.1f} mm")


def endoscope_turns(eyes, hands, *pair):
    before, forward = {name: tool(eyes, name) for name in pair}, eyes.pose["picture"]["forward"]
    hands.look(Watch(eyes))
    settle(eyes)
    if math.dist(forward, eyes.pose["picture"]["forward"]) < 0.02:
        raise Failed("the endoscope did not turn")
    for name, was in before.items():
        now = tool(eyes, name)
        if math.dist(was["tip_mm"], now["tip_mm"]) > 0.5 or abs(was["handle"] - now["handle"]) > 0.01:
            raise Failed(f"{name} moved or opened while the endoscope turned")


def one_again(room, hands):
    eyes = room.eyes
    grips = [t["handle"] for t in eyes.pose["tools"]]
    switch(room, lambda: toggle_in_rack(room, False), False)
    if any(abs(t["handle"] - grip) > 0.01 for t, grip in zip(eyes.pose["tools"], grips)):
        raise Failed("leaving the mode moved a handle")
    led, alone = eyes.pose["led"], Watch(eyes)
    hands.one(alone)
    resting = [t["name"] for t in eyes.pose["tools"] if t["name"] != led]
    if alone.way(led) < MOVED_MM or any(alone.way(name) > STILL_MM for name in resting):
        raise Failed(f"not {led} alone moved: {[(t, alone.way(t)) for t in [led, *resting]]}")
    print(f"one again: {led} moved {alone.way(led):.1f} mm; {eyes.pose['tick']} ticks")
    switch(room, hands.toggle, True)
    switch(room, hands.toggle, False)


def two_hands(room):
    eyes = room.eyes
    begin(room)
    hands = PadAtOnce(eyes, room.hands) if isinstance(room.hands, Pad) else MouseAndKeysAtOnce(eyes)
    switch(room, hands.toggle, True)
    pair = eyes.pose["both"]
    if pair["left"] == pair["right"] or pair["mouse"] != pair["right"]:
        raise Failed(f"no pair: {pair}")
    both_move(eyes, hands, pair["left"], pair["right"])
    one_closes(eyes, hands, pair["left"], pair["right"])
    endoscope_turns(eyes, hands, pair["left"], pair["right"])
    one_again(room, hands)


if __name__ == "__main__":
    sys.exit(in_a_room(__doc__, two_hands, ["gynaecology", "--trainee", "both hands"]))
