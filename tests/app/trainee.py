"""A robot trainee for the real window: eyes are the window's event log (--log), which tells what is on the screen and ten
times a second where tubes and instruments are; hands are a mouse and keys (xdotool) or an emulated gamepad
(TROCAR_GAMEPAD, the mapping layer's seam: see app/shell/gamepads.hpp). Every wait has a limit.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time

METRES_PER_PIXEL = 1e-4   # devices::HandSettings
METRES_PER_NOTCH = 2e-3
ROLL_PER_PIXEL = 8e-3
VIEW_PER_PIXEL = 1e-3
STICK_SPEED, STICK_ROLL, STICK_VIEW = 0.05, 2.0, 0.6
POST_SPEED = 1.0          # [rad/s]


FAR = 4e-3  # [m] nearer than this a hand on a stick slows down


class Failed(Exception):
    pass


class Over(Exception):
    """The exercise has come to its end."""


def add(a, b, f=1.0):
    return [x + f * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    n = math.sqrt(dot(a, a))
    return [x / n for x in a]


def in_basis(d, a, b, c):
    """Coordinates of d along a, b (square to each other) and c, which need not be square to them (Cramer's rule). A c
    that lies almost across a x b, as an instrument square to the view, leads nowhere in depth: then c is left alone."""
    det = dot(a, cross(b, c))
    if abs(det) < 0.15:
        return dot(d, a), dot(d, b), 0.0
    return dot(d, cross(b, c)) / det, dot(a, cross(d, c)) / det, dot(a, cross(b, d)) / det


class Eyes:
    """The window's JSON lines as they come."""

    def __init__(self, path, process):
        self.path, self.process = path, process
        self.file, self.rest = None, ""
        self.events, self.pose, self.screen = [], None, None
        self.operating = False  # then the result's screen raises Over

    def read(self):
        if self.file is None:
            if not os.path.exists(self.path):
                return
            self.file = open(self.path, encoding="utf-8")
        self.rest += self.file.read()
        *lines, self.rest = self.rest.split("\n")
        for line in lines:
            entry = json.loads(line)
            if entry["event"] == "pose":
                self.pose = entry
            elif entry["event"] == "screen":
                self.screen = entry
            else:
                self.events.append(entry)

    def wait(self, what, condition, limit):
        """Until condition() holds; raises Failed after `limit` seconds or when the program is gone."""
        end = time.monotonic() + limit
        while True:
            gone = self.process.poll() is not None
            self.read()
            if self.operating and self.screen and self.screen["name"] == "result":
                raise Over
            value = condition()
            if value:
                return value
            if gone:
                raise Failed(f"the program ended (exit {self.process.returncode}) while waiting for: {what}")
            if time.monotonic() > end:
                raise Failed(f"waited {limit} s for: {what}; the screen: {self.screen}")
            time.sleep(0.02)

    def happened(self, name, **details):
        return [e for e in self.events if e["event"] == name and all(e.get(k) == v for k, v in details.items())]

    def on(self, name, limit=30):
        self.wait(f"the screen {name}", lambda: self.screen and self.screen["name"] == name, limit)

    def where(self, widget, limit=30):
        return self.wait(f"'{widget}' on the screen", lambda: self.screen and self.screen["widgets"].get(widget), limit)

    def later(self, seconds):
        """Waits for simulated time."""
        tick = self.pose["tick"] + 1000 * seconds
        self.wait("time to pass", lambda: self.pose["tick"] >= tick, 30 + 60 * seconds)

    def within(self, seconds, condition):
        """Whether condition() comes to hold within that much simulated time."""
        tick = self.pose["tick"] + 1000 * seconds
        self.wait("time to pass", lambda: condition() or self.pose["tick"] >= tick, 30 + 60 * seconds)
        return bool(condition())

    def some_pictures(self):
        """[s] that three pictures take, as far as is known."""
        rates = self.happened("rate")
        return max(0.4, min(5.0, 3 / max(rates[-1]["pictures_per_second"], 0.1))) if rates else 0.4

    # What is seen of the patient.
    def tool(self, name=None):
        return next(t for t in self.pose["tools"] if t["name"] == (name or self.pose["led"]))

    def point(self, tube, s):
        """Place [mm] and direction of the tube at arc length s [mm], and its radius."""
        course = self.pose["strands"][tube]
        for a, b in zip(course, course[1:]):
            if b[0] >= s or b is course[-1]:
                f = (s - a[0]) / max(b[0] - a[0], 1e-9)
                return add(a[1:4], add(b[1:4], a[1:4], -1), f), unit(add(b[1:4], a[1:4], -1)), a[4]

    def straightness(self, tube, to):
        points = [p for p in self.pose["strands"][tube] if p[0] <= to]
        way = sum(math.dist(a[1:4], b[1:4]) for a, b in zip(points, points[1:]))
        return math.dist(points[0][1:4], points[-1][1:4]) / way


def pace(eyes):
    """Of simulated to real time: in slow motion hands are slow, too."""
    return max(0.15, min(1.0, eyes.pose["speed"])) if eyes.pose else 1.0


def xdo(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True, stdout=subprocess.DEVNULL)


def display_size():
    """"1280x720"; that, too, where nothing can tell."""
    done = subprocess.run(["xdotool", "getdisplaygeometry"], capture_output=True, text=True, check=False) \
        if shutil.which("xdotool") else None
    return "x".join(done.stdout.split()) if done and done.returncode == 0 else "1280x720"


class MouseAndKeys:
    """Screens by mouse and keys, instruments by mouse and keys."""
    name = "mouse and keys"
    stride_mm = 12.0  # the endoscope along its shaft before one looks again: as many notches as a finger turns at once

    def __init__(self, eyes):
        self.eyes, self.locked = eyes, False

    def press(self, widget, limit=30):
        self.eyes.where(widget, limit)
        time.sleep(self.eyes.some_pictures())  # a menu that has just appeared finds its size
        self.eyes.read()
        x, y = self.eyes.where(widget, limit)
        xdo("mousemove", x, y)
        time.sleep(0.2)
        xdo("click", 1)

    def key(self, key):
        xdo("key", key)

    def enter(self):
        xdo("key", "Return")

    def pause(self):
        xdo("key", "p")

    def choose(self, number):
        xdo("key", str(number))

    def rack(self):
        xdo("key", "x")

    def leave_menu(self):
        xdo("key", "Escape")

    def sideways(self, right, up):
        px, py = round(right / METRES_PER_PIXEL), round(-up / METRES_PER_PIXEL)
        if px or py:
            xdo("mousemove_relative", "--", px, py)

    def tip(self, right, up, inwards):
        self.sideways(right, up)
        self.inwards(inwards)

    def inwards(self, metres):
        """A tenth of a millimetre with the mouse's wheel and Shift is a quarter of a notch."""
        notches = round(metres / METRES_PER_NOTCH)
        if notches:
            for _ in range(min(6, abs(notches))):
                xdo("click", 4 if notches > 0 else 5)
            return
        fine = round(4 * metres / METRES_PER_NOTCH)
        if fine:
            xdo("keydown", "shift")
            time.sleep(0.15)
            for _ in range(abs(fine)):
                xdo("click", 4 if fine > 0 else 5)
            time.sleep(0.15)
            xdo("keyup", "shift")

    def look(self, right, up, inwards=0.0):
        xdo("mousemove_relative", "--", round(right / VIEW_PER_PIXEL), round(-up / VIEW_PER_PIXEL))
        self.inwards(inwards)

    def turn_post(self, angle):
        """The light post of the endoscope, which is led."""
        xdo("keydown", "r")
        time.sleep(angle / POST_SPEED / pace(self.eyes))
        xdo("keyup", "r")

    def roll(self, angle):
        """Clockwise as the hand sees it: a drag with the right button, held long enough to be no click."""
        xdo("mousedown", 3)
        time.sleep(0.35)
        xdo("mousemove_relative", "--", round(angle / ROLL_PER_PIXEL), 0)
        time.sleep(0.2)
        xdo("mouseup", 3)
        time.sleep(0.1)

    def close(self):
        xdo("mousedown", 1)

    def close_slowly(self, until):
        """Shift makes closing fine; the lock keeps what is reached. Opens with open_up()."""
        xdo("keydown", "shift")
        time.sleep(0.2)
        xdo("mousedown", 1)
        try:
            self.eyes.wait("the handle to close slowly", lambda: self.eyes.tool()["handle"] > until - 0.03, 120)
        finally:
            if not self.locked:
                xdo("key", "space")
            self.locked = True
            xdo("mouseup", 1)
            xdo("keyup", "shift")

    def take_up(self):
        """The half closed handle of a hand that was left for another; here the lock keeps it."""

    def open_up(self):
        if self.locked:
            xdo("key", "space")
        self.locked = False

    def let_go(self):
        xdo("mouseup", 1)
        xdo("keyup", "shift")

    def lock(self):
        xdo("key", "space")

    def into_view(self):
        xdo("key", "v")


class Pad:
    """The same by a gamepad alone. One line a picture is read, so every press lasts at least one picture."""
    name = "gamepad"
    stride_mm = 30.0

    def __init__(self, eyes, pipe):
        self.eyes, self.pipe = eyes, open(pipe, "w", buffering=1, encoding="utf-8")
        self.trigger = 0.0
        self.send()

    def send(self, lx=0.0, ly=0.0, rx=0.0, ry=0.0, lt=0.0, rt=0.0, buttons=""):
        """The trigger is the handle; at the endoscope, where it turns the light post, the finger is off it."""
        leads_scope = self.eyes.pose is not None and self.eyes.pose["led"] == "scope"
        trigger = rt if leads_scope else self.trigger
        print(f"{lx:.3f} {ly:.3f} {rx:.3f} {ry:.3f} {lt:.3f} {trigger:.3f} {buttons}".strip(), file=self.pipe)

    def tap(self, button):
        self.send(buttons=button)
        time.sleep(0.12)
        try:
            self.send()
        except BrokenPipeError:  # the button was "Quit"
            return
        time.sleep(0.12)

    def hold(self, seconds, **sticks):
        self.send(**sticks)
        time.sleep(seconds / pace(self.eyes))
        self.send()

    def unplug(self):
        print("gone", file=self.pipe)

    def press(self, widget, limit=30):
        """Goes from button to button by the cross until the focus is there, as told by the log."""
        self.eyes.where(widget, limit)
        time.sleep(self.eyes.some_pictures())
        tried = set()
        for _ in range(60):
            self.eyes.read()
            at, goal = self.eyes.screen.get("focus"), self.eyes.screen["widgets"][widget]
            if at == widget:
                # a page that has just become ready takes the focus to its first button
                time.sleep(self.eyes.some_pictures())
                self.eyes.read()
                if self.eyes.screen.get("focus") == widget:
                    return self.tap("a")
                continue
            here = self.eyes.screen["widgets"].get(at)
            dx, dy = (0, 99) if here is None else (goal[0] - here[0], goal[1] - here[1])
            ways = ["down" if dy > 0 else "up", "right" if dx > 0 else "left"]
            if abs(dy) <= 14:
                ways.reverse()
            # two columns: who is led up and down between two rows tries it sideways the next time
            way = next((w for w in ways if (at, w) not in tried), ways[0])
            tried.add((at, way))
            self.tap(way)
            end = time.monotonic() + 3  # a slow picture shows the focus later: never two presses at once
            while self.eyes.screen.get("focus") == at and time.monotonic() < end:
                time.sleep(0.05)
                self.eyes.read()
        raise Failed(f"the cross does not lead to '{widget}': {self.eyes.screen}")

    def enter(self):
        self.tap("a")

    def pause(self):
        self.tap("start")

    def choose(self, number):
        """Hands by the right shoulder, one after the other; 0 is the endoscope."""
        names = [t["name"] for t in self.eyes.pose["tools"]] + ["scope"]
        goal = names[-1] if number == 0 else names[number - 1]
        for _ in range(8):
            if self.eyes.pose["led"] == goal:
                return
            tick = self.eyes.pose["tick"]
            self.tap("right_shoulder")
            self.eyes.wait("a newer pose", lambda: self.eyes.pose["tick"] > tick + 100, 20)
        raise Failed(f"the shoulder does not lead to {goal}")

    def rack(self):
        self.tap("y")

    def leave_menu(self):
        self.tap("b")

    @staticmethod
    def tilt(share):
        """The stick's way that moves at `share` of its full speed: 12 % rest, then a square."""
        return 0.0 if share < 1e-4 else 0.12 + 0.88 * math.sqrt(min(1.0, share))

    def push(self, most, slow, **ways):
        """Sticks by these ways, each of a full speed of `most`."""
        self.push_each({axis: (way, most, slow) for axis, way in ways.items()})

    def push_each(self, ways):
        """Sticks by (way, full speed, short way) each: for short ways gently, for a third of a second at least."""
        if all(abs(way) < 1e-3 * slow for way, _, slow in ways.values()):
            return
        seconds = max(max(0.35, abs(way) / most, 0.7 * min(1.0, abs(way) / slow)) for way, most, slow in ways.values())
        self.hold(seconds, **{axis: math.copysign(self.tilt(abs(way) / (most * seconds)), way)
                              for axis, (way, most, _) in ways.items()})

    def tip(self, right, up, inwards):
        self.push(STICK_SPEED, FAR, lx=right, ly=-up, ry=-inwards)

    def inwards(self, metres):
        self.push(STICK_SPEED, FAR, ry=-metres)

    def look(self, right, up, inwards=0.0):
        """Both sticks at once: a push lasts as long for two ways as for one."""
        self.push_each({"lx": (right, STICK_VIEW, 0.1), "ly": (-up, STICK_VIEW, 0.1), "ry": (-inwards, STICK_SPEED, FAR)})

    def turn_post(self, angle):
        self.hold(angle / POST_SPEED, rt=1.0)

    def roll(self, angle):
        self.push(STICK_ROLL, 0.5, rx=angle)

    def pull_to(self, to):
        self.trigger = to
        self.send()

    def close(self):
        self.pull_to(1.0)

    def close_slowly(self, until):
        """A little further with the trigger, and a little more."""
        while self.trigger < until - 1e-6:
            self.pull_to(min(until, self.trigger + 0.08))
            self.eyes.wait("the handle to follow", lambda: self.eyes.tool()["handle"] > self.trigger - 0.02, 60)
            self.eyes.later(0.15)

    def take_up(self):
        """The trigger must be let go and come back to where the handle was left."""
        to = self.trigger
        self.pull_to(0.0)
        self.eyes.later(0.1)
        self.pull_to(to)

    def open_up(self):
        self.let_go()

    def let_go(self):
        self.pull_to(0.0)

    def lock(self):
        self.send(lt=1.0)
        time.sleep(0.15)
        self.send()
        time.sleep(0.1)

    def into_view(self):
        self.tap("x")


def open_exercise(eyes, hands, name, group):
    """From the tiles of the start screen to the page of an exercise, by its group where its tile is out of sight."""
    eyes.on("exercises", 60)
    eyes.wait("the groups", lambda: f"group {group}" in eyes.screen["widgets"], 30)
    if name not in eyes.screen["widgets"]:
        hands.press(f"group {group}")
    hands.press(name)
    eyes.on("details")


class Trainee:
    """What a trainee does with instruments, whatever moves them: look, compare, correct."""

    def __init__(self, eyes, hands):
        self.eyes, self.hands = eyes, hands

    def names(self):
        return [t["name"] for t in self.eyes.pose["tools"]]

    def lead(self, hand):
        if self.eyes.pose["led"] == hand:
            return
        self.hands.choose(0 if hand == "scope" else self.names().index(hand) + 1)
        self.eyes.wait(f"{hand} to be led", lambda: self.eyes.pose["led"] == hand, 30)

    def settled(self, limit=2.5, still_mm=0.08):
        """Waits until what is led has followed: poses from well after now that stand still, or `limit` simulated s."""
        start, last = self.eyes.pose["tick"], [None]

        def place():
            if self.eyes.pose["led"] == "scope":
                picture = self.eyes.pose["picture"]
                return picture["eye_mm"] + [100 * x for x in picture["forward"]]
            tool = self.eyes.tool()
            return tool["tip_mm"] + [10 * x for x in tool["opening"]]

        def still():
            at, tick = place(), self.eyes.pose["tick"]
            if tick < start + 120 or (last[0] and last[0][0] == tick):
                return False
            before, last[0] = last[0], (tick, at)
            return tick > start + 1000 * limit or (before is not None and math.dist(before[1], at) < still_mm)
        self.eyes.wait("what is led to come to rest", still, 120)

    def show(self, points, distance_mm=60.0, aside=(0.0, 0.0)):
        """Turns the endoscope until all these points [mm] are well inside its picture, then as near as that allows.
        `aside` [tan] to the right and upwards: not straight at them, so that the lens sees them from another side.
        A hand on a slow picture overshoots: each correction is a little more careful than the last."""
        for corrections in range(24):
            care = 1 / (1 + 0.1 * corrections)
            picture = self.eyes.pose["picture"]
            port, eye = picture["port_mm"], picture["eye_mm"]
            ways = [add(p, eye, -1) for p in points]
            wanted = unit([sum(c) for c in zip(*map(unit, ways))])
            wanted = unit(add(add(wanted, picture["right"], aside[0]), picture["up"], aside[1]))
            cone = math.tan(0.36 * picture["field_rad"])
            further = 130.0 - picture["depth_mm"]
            for way in ways:
                ahead = dot(way, wanted)
                beside = math.sqrt(max(0.0, dot(way, way) - ahead * ahead))
                further = min(further, ahead - beside / cone, ahead - distance_mm)
            further = max(14.0 - picture["depth_mm"], further)
            # The endoscope turns about its trocar, the lens with it: less than it seems from the lens is enough.
            lever = sum(math.dist(p, eye) for p in points) / sum(math.dist(p, port) for p in points)
            right, up = (lever * math.asin(max(-1.0, min(1.0, dot(wanted, picture[d])))) for d in ("right", "up"))
            if max(abs(right), abs(up)) < 0.04 and abs(further) < 5:
                return
            self.lead("scope")
            stride = max(-self.hands.stride_mm, min(self.hands.stride_mm, further))
            goes = max(abs(right), abs(up)) < 0.3 and abs(further) > 3
            self.hands.look(care * right, care * up, 1e-3 * stride if goes else 0.0)
            self.settled()
        print(f"the endoscope is still {right:.2f}, {up:.2f} rad and {further:.0f} mm off")

    def move(self, goal, tolerance_mm, what, limit=120):
        """The led tip to goal() [mm], which may itself move: sideways in the picture and along the shaft. Who has tried
        for long makes do with twice the tolerance: the tissue, pushed by the jaws, gives way before the last tenths."""
        begun = time.monotonic()
        end = begun + limit
        while True:
            tool, picture = self.eyes.tool(), self.eyes.pose["picture"]
            way = [1e-3 * x for x in add(goal(), tool["tip_mm"], -1)]
            off = 1000 * math.sqrt(dot(way, way))
            if off < tolerance_mm * (2 if time.monotonic() > begun + limit / 3 else 1):
                return
            if time.monotonic() > end:
                raise Failed(f"{what}: still {off:.1f} mm away after {limit} s")
            right, up, inwards = in_basis(way, picture["right"], picture["up"], tool["shaft"])
            f = min(1.0, 0.012 / max(abs(right), abs(up), 1e-9))  # within what a command may run ahead
            self.hands.tip(f * right, f * up, max(-0.010, min(0.010, inwards)))
            self.settled()

    def roll_across(self, along, tolerance=0.05):
        """Turns the jaws until they open across the direction along()."""
        for _ in range(25):
            tool = self.eyes.tool()
            shaft, opening = tool["shaft"], tool["opening"]
            flat = along()
            flat = unit(add(flat, shaft, -dot(flat, shaft)))
            off = math.asin(max(-1.0, min(1.0, dot(opening, flat))))
            if abs(off) < tolerance:
                return
            clockwise = dot(cross(shaft, opening), flat) * off < 0
            self.hands.roll(abs(off) if clockwise else -abs(off))
            self.settled()
        raise Failed("the jaws do not turn across the tube")

    def before(self, hand, tube, s, inside_mm, back_mm):
        """Where the tip belongs so that the tube at s lies `inside` from the hinge, less `back` along the shaft."""
        def goal():
            tool = self.eyes.tool(hand)
            at = self.eyes.point(tube, s)[0]
            axis = unit(add(at, tool["port_mm"], -1))
            return add(at, axis, tool["jaw_mm"] - inside_mm() - back_mm)
        return goal

    def come_into_view(self, hand, goal):
        """The first part of the way from its trocar, which one picture does not always show together with the goal."""
        tip = self.eyes.tool(hand)["tip_mm"]
        way = add(goal(), tip, -1)
        if dot(way, way) < 60 ** 2:
            return
        stop = add(tip, unit(way), 30)
        self.show([tip, stop])
        self.lead(hand)
        self.move(lambda: stop, 4, f"bringing {hand} into view")

    def reach(self, hand, tube, s, inside_mm, what):
        """Before the tissue, jaws across it, then in; the eye goes first."""
        goal = self.before(hand, tube, s, inside_mm, 22)
        if not all(self.eyes.tool(hand)["seen"]):
            self.come_into_view(hand, goal)
            self.show([self.eyes.tool(hand)["tip_mm"], goal(), self.eyes.point(tube, s)[0]])
        self.lead(hand)
        self.move(goal, 2.0, f"{what}: going before the tube")
        self.roll_across(lambda: self.eyes.point(tube, s)[1])
        self.move(self.before(hand, tube, s, inside_mm, 8), 1.5, f"{what}: nearer")
        self.roll_across(lambda: self.eyes.point(tube, s)[1])
        self.move(self.before(hand, tube, s, inside_mm, 0), 0.7, f"{what}: the tube between the jaws")

    def back_off(self, hand, mm):
        self.lead(hand)
        tool = self.eyes.tool()
        goal = add(tool["tip_mm"], tool["shaft"], -mm)
        self.move(lambda: goal, 3, f"drawing {hand} back")

    def squeeze(self, until, what, limit=60):
        self.hands.close()
        try:
            return self.eyes.wait(what, until, limit)
        finally:
            self.eyes.wait("the handle to close", lambda: self.eyes.tool()["handle"] > 0.97, limit)


class Room:
    """The real window, and a robot before it.

    folder       where it may write; its data folder is in there
    environment  of every program that is to find that data
    """

    def __init__(self, program, folder, gamepad, words, command=("train", "--size", "1000x640")):
        self.program, self.folder = program, folder
        log, pipe = os.path.join(folder, "log.jsonl"), os.path.join(folder, "pad")
        self.environment = dict(os.environ, TROCAR_DATA=os.path.join(folder, "data"), BROWSER="true")
        if os.path.exists(log):
            os.remove(log)
        if gamepad:
            if not os.path.exists(pipe):
                os.mkfifo(pipe)
            self.environment["TROCAR_GAMEPAD"] = pipe
        self.process = subprocess.Popen([program, *command, "--log", log, *words], cwd=folder,
                                        env=self.environment, stdout=subprocess.PIPE if "--json" in words else None,
                                        text=True)
        self.eyes = Eyes(log, self.process)
        self.hands = Pad(self.eyes, pipe) if gamepad else MouseAndKeys(self.eyes)

    def leave(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()


def in_a_room(usage, work, words, **command):
    """Does work(room) with the words of the command line: PROGRAM [--gamepad] [FOLDER]. `words` go to the program,
    `command`, where it is given, in place of `train`.

    Returns the exit status: 0 passed, 1 failed, 77 something to run it with is missing."""
    gamepad = "--gamepad" in sys.argv
    given = [w for w in sys.argv[1:] if w != "--gamepad"]
    if not given:
        sys.exit(usage)
    if not shutil.which("xdotool"):
        print("xdotool is missing: apt-get install xdotool")
        return 77
    keep = len(given) > 1
    folder = os.path.abspath(given[1]) if keep else tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    room = None
    try:
        room = Room(os.path.abspath(given[0]), folder, gamepad, words, **command)
        work(room)
    except (Failed, subprocess.TimeoutExpired) as failure:
        for event in room.eyes.events[-25:] if room else []:
            print(event)
        print(f"FAILED ({'gamepad' if gamepad else 'mouse and keys'}): {failure}")
        return 1
    finally:
        if room:
            room.leave()
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
    return 0
