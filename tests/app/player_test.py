#!/usr/bin/env python3
"""Drives the player with real mouse, key and gamepad events: scrubs, steps, plays, looks from outside, films.

    tools/with_xvfb.sh python3 tests/app/player_test.py PATH/TO/trocar [FOLDER]

The eyes are the window's event log (--log), the hands xdotool, the gamepad the seam of app/shell/gamepads.hpp. What is exact is
told by the State's hash: it must be the same whenever the same tick is looked at, and at the end that of the attempt.
Exit: 0 passed, 1 failed, 77 something to run it with is missing. FOLDER keeps what was written.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

SECONDS = 8
PATIENCE = 180  # [s] for one thing; the machine may be slow


class Failed(Exception):
    pass


def xdo(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True, stdout=subprocess.DEVNULL)


class Player:
    """The program and what it has told so far."""

    def __init__(self, program, recording, log, env):
        self.path = log
        if os.path.exists(log):
            os.remove(log)
        self.process = subprocess.Popen([program, "replay", recording, "--size", "1000x660", "--log", log], env=env)
        self.file, self.rest, self.events = None, "", []

    def read(self):
        if self.file is None and os.path.exists(self.path):
            self.file = open(self.path, encoding="utf-8")
        if self.file:
            self.rest += self.file.read()
            *lines, self.rest = self.rest.split("\n")
            self.events += [json.loads(line) for line in lines]

    def wait(self, what, condition, since=0, limit=PATIENCE):
        """The first event from number `since` on that fits."""
        end = time.monotonic() + limit
        while True:
            gone = self.process.poll() is not None
            self.read()
            for event in self.events[since:]:
                if condition(event):
                    return event
            if gone:
                raise Failed(f"the program ended (exit {self.process.returncode}) while waiting for: {what}")
            if time.monotonic() > end:
                raise Failed(f"waited {limit} s for: {what}; last: {self.events[-3:]}")
            time.sleep(0.02)

    def now(self):
        self.read()
        return len(self.events)

    def last(self, name):
        self.read()
        return next(e for e in reversed(self.events) if e["event"] == name)

    def shows(self, what, since, exact=True, **details):
        return self.wait(what, lambda e: e["event"] == "shown" and (e["exact"] or not exact)
                         and all(e.get(k) == v for k, v in details.items()), since)

    def key(self, *keys):
        """Types, and returns the number of the first event after it."""
        since = self.now()
        for key in keys:
            xdo("key", key)
        return since

    def widget(self, name):
        return self.wait(f"the widget {name}", lambda e: e["event"] == "screen" and name in e["widgets"])["widgets"][name]

    def click(self, x, y, button=1):
        since = self.now()
        xdo("mousemove", x, y, "click", button)
        return since


def expect(condition, what):
    if not condition:
        raise Failed(what)


def find_times(player, attempt):
    """Keys and mouse on the timeline; returns how long pictures took."""
    first = player.shows("the start", 0, tick=0)
    last = first["last"]
    expect(last == attempt["ticks"], f"the recording has {attempt['ticks']} ticks, the player shows {last}")
    hashes = {0: first["hash"]}

    def exactly(tick, since, what):
        shown = player.shows(what, since, tick=tick, playing=False)
        expect(hashes.setdefault(tick, shown["hash"]) == shown["hash"], f"tick {tick} is not the same State as before")
        return shown

    exactly(last, player.key("End"), "End to show the end exactly")
    expect(hashes[last] == attempt["state_hash"], "the end is not the State that the attempt had")
    exactly(last - 40, player.key("Left"), "Left to go back by a picture")
    exactly(last - 42, player.key("comma", "comma"), "comma to go back by a tick, twice")
    exactly(last - 41, player.key("period"), "full stop to go on by a tick")
    exactly(last - 1041, player.key("shift+Left"), "Shift Left to go back by a second")
    exactly(last - 1001, player.key("Right"), "Right to go on by a picture")
    exactly(last, player.key("End"), "End again")
    exactly(last - 40, player.key("Left"), "Left again")

    x, y = player.widget("timeline")
    bar = player.last("screen")["bar"]
    since = player.click(x, y - 14)
    middle = player.shows("a click in the middle of the timeline", since)
    expect(abs(middle["tick"] - last / 2) < 0.02 * last, f"the middle of the timeline is tick {middle['tick']} of {last}")

    # Scrub: each place is shown at once, from keyframes if need be, and the place it ends at exactly.
    since = player.now()
    xdo("mousemove", x - 0.3 * bar[2], y - 14, "mousedown", 1)
    for step in range(12):
        xdo("mousemove", x - (0.3 - 0.05 * step) * bar[2], y - 14)
        time.sleep(0.25)
    xdo("mouseup", 1)
    scrubbed = player.shows("the place where scrubbing ended", since)
    time.sleep(0.5)
    player.read()
    ticks = [e["tick"] for e in player.events[since:] if e["event"] == "shown"]
    expect(len(set(ticks)) >= 4 and ticks == sorted(ticks), f"scrubbing to the right showed {ticks}")
    took = [e["ms"] for e in player.events[since:] if e["event"] == "shown" and e["tick"] != scrubbed["tick"]]
    return last, sorted(took)


def play(player):
    player.shows("Home", player.key("Home"), tick=0)
    since = player.key("space")
    player.wait("playing to go on", lambda e: e["event"] == "shown" and e["playing"] and e["tick"] > 400, since)
    since = player.key("space")
    player.wait("to stand still", lambda e: e["event"] == "shown" and not e["playing"] and e["exact"], since)
    tick = player.last("shown")["tick"]
    time.sleep(0.5)
    expect(player.last("shown")["tick"] == tick, "it plays on after a pause")
    since = player.key("Home", "Next")
    mark = player.wait("Page Down to jump to a mark",
                       lambda e: e["event"] == "shown" and e["exact"] and e["tick"] > 0, since)
    last = player.shows("End", player.key("End"))["tick"]
    since = player.key("Prior")
    player.wait("Page Up to jump back to a mark",
                lambda e: e["event"] == "shown" and mark["tick"] <= e["tick"] < last, since)


def look_around(player):
    """Cameras by key, mouse and gamepad."""
    def camera(since, what, condition):
        return player.wait(what, lambda e: e["event"] == "camera" and condition(e), since)

    large = player.last("screen")["large"]
    centre = (int(large[2] / 2), int(large[3] / 2))
    before = camera(player.key("c"), "C to look from outside", lambda e: not e["endoscope"])
    since = player.now()
    xdo("mousemove", *centre, "mousedown", 1)
    time.sleep(0.3)
    xdo("mousemove", centre[0] + 120, centre[1] + 30)
    time.sleep(0.3)
    xdo("mouseup", 1)
    camera(since, "dragging to turn the camera", lambda e: abs(e["yaw"] - before["yaw"]) > 0.3)
    far = player.last("camera")["distance"]
    camera(player.click(*centre, button=4), "the wheel to go nearer", lambda e: e["distance"] < far)
    yaw = player.last("camera")["yaw"]
    camera(player.key("d"), "D to turn the camera", lambda e: e["yaw"] != yaw)
    camera(player.key("4"), "4 to look from above", lambda e: e["pitch"] > 1.4)
    camera(player.key("v"), "V to close the small picture", lambda e: not e["inset"])
    camera(player.key("v", "1"), "1 to look through the endoscope", lambda e: e["endoscope"] and e["inset"])


def pad(path, *samples):
    with open(path, "a", encoding="utf-8") as file:
        for sample in samples:
            file.write(sample + "\n")


def hold(path, sample, seconds=0.6):
    """As a hand would: down for a while, then up."""
    pad(path, sample)
    time.sleep(seconds)
    pad(path, "0 0 0 0 0 0")
    time.sleep(0.2)


def use_gamepad(player, path):
    player.shows("Home", player.key("Home"), tick=0)
    since = player.now()
    hold(path, "0 0 0 0 0 0 right_shoulder")
    player.wait("RB to jump to a mark", lambda e: e["event"] == "shown" and e["tick"] > 0, since)
    since = player.now()
    hold(path, "0 0 0 0 0 0 b")
    player.wait("B to change the camera", lambda e: e["event"] == "camera" and not e["endoscope"], since)
    since = player.now()
    hold(path, "0 0 1 0 0 0")
    player.wait("the right stick to turn it", lambda e: e["event"] == "camera" and abs(e["yaw"]) > 0.1, since)
    since = player.now()
    hold(path, "0 0 0 0 0 0 a")
    player.wait("A to play", lambda e: e["event"] == "shown" and e["playing"], since)
    hold(path, "0 0 0 0 0 0 a")


def save(player, folder):
    file = player.wait("the picture", lambda e: e["event"] == "picture", player.key("F12"))["file"]
    data = open(os.path.join(folder, file), "rb").read()
    expect(data[:8] == b"\x89PNG\r\n\x1a\n" and len(data) > 50_000, f"{file} is no picture of a scene")


def film(player, folder):
    """The visible second or so, through the endoscope."""
    player.key("1", "Home")
    for _ in range(3):
        player.key("plus")
        time.sleep(0.3)
    since = player.key("x")
    begun = player.wait("the film to begin", lambda e: e["event"] in ("film-started", "film-failed"), since)
    expect(begun["event"] == "film-started", f"no film: {begun}")
    file = player.wait("the film", lambda e: e["event"] == "film", since)["file"]
    file = os.path.join(folder, file)
    if not shutil.which("ffprobe"):
        return
    found = json.loads(subprocess.run(
        ["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries",
         "stream=codec_name,pix_fmt,r_frame_rate:format=duration", "-of", "json", file],
        capture_output=True, text=True, check=True).stdout)
    stream, duration = found["streams"][0], float(found["format"]["duration"])
    expect((stream["codec_name"], stream["pix_fmt"], stream["r_frame_rate"]) == ("h264", "yuv420p", "25/1"),
           f"the film is {stream}")
    expect(abs(duration - begun["pictures"] / 25) < 0.05, f"the film lasts {duration} s")
    expect(begun["to"] - begun["from"] < SECONDS * 1000 / 4, f"the film shows {begun}, not the visible time")
    player.key("0")


def leave(player):
    for key, screen in (("F1", "help"), ("Escape", "player"), ("Escape", "menu")):
        since = player.key(key)
        player.wait(f"{key} for: {screen}", lambda e: e["event"] == "screen" and e["name"] == screen, since)
    menu = player.wait("the button to quit", lambda e: e["event"] == "screen" and "Quit" in e["widgets"], since)
    time.sleep(0.5)  # the menu has found its size and place
    player.click(*player.last("screen")["widgets"].get("Quit", menu["widgets"]["Quit"]))
    player.process.wait(timeout=30)
    expect(player.process.returncode == 0, f"the player ended with exit {player.process.returncode}")


def check_without_display(program, recording):
    env = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    out = subprocess.run([program, "replay", recording], env=env, capture_output=True, text=True, timeout=60)
    expect(out.returncode == 3 and "--shots" in out.stderr, f"without a display: exit {out.returncode}, {out.stderr}")


def check_torn(program, folder, recording, whole, env):
    """Half of the file: plays as far as it is sound."""
    torn = os.path.join(folder, "torn.rec")
    data = open(recording, "rb").read()
    open(torn, "wb").write(data[:len(data) // 2])
    player = Player(program, torn, os.path.join(folder, "torn.jsonl"), env)
    try:
        last = player.shows("the start of the torn file", 0, tick=0)["last"]
        expect(1000 <= last < whole, f"of {whole} ticks the torn file shows {last}")
        player.shows("the torn file's end", player.key("End"), tick=last)
        leave(player)
    finally:
        if player.process.poll() is None:
            player.process.kill()
        player.process.wait()


def check_closed_early(program, folder, recording, env):
    """Asked to end while the scene is still being prepared: it ends, and well, and never shows the scene."""
    player = Player(program, recording, os.path.join(folder, "early.jsonl"), env)
    try:
        player.wait("the scene to be prepared", lambda e: e["event"] == "preparing")
        player.process.terminate()
        player.process.wait(timeout=PATIENCE)
        expect(player.process.returncode == 0, f"closed early: exit {player.process.returncode}")
        expect(player.now() == 1, f"closed early the player went on: {player.events[1:3]}")
    finally:
        if player.process.poll() is None:
            player.process.kill()
        player.process.wait()


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for tool in ("xdotool", "ffmpeg"):
        if not shutil.which(tool):
            print(f"{tool} is missing: apt-get install {tool}")
            return 77
    program, keep = os.path.abspath(sys.argv[1]), len(sys.argv) > 2
    folder = os.path.abspath(sys.argv[2]) if keep else tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    gamepad = os.path.join(folder, "gamepad")
    open(gamepad, "w").close()
    env = {**os.environ, "TROCAR_GAMEPAD": gamepad, "TROCAR_DATA": os.path.join(folder, "data")}
    recording = os.path.join(folder, "a.rec")
    player = None
    try:
        made = subprocess.run([program, "train", "gynaecology/sterilisation", "--input", "demo", "--headless", "--seconds",
                               str(SECONDS), "--record", recording, "--json"], env=env, capture_output=True, text=True,
                              timeout=PATIENCE)
        attempt = json.loads(made.stdout)
        check_without_display(program, recording)
        player = Player(program, recording, os.path.join(folder, "log.jsonl"), env)
        player.wait("the player", lambda e: e["event"] == "screen" and e["name"] == "player")
        last, took = find_times(player, attempt)
        play(player)
        look_around(player)
        save(player, folder)
        use_gamepad(player, gamepad)
        film(player, folder)
        leave(player)
        check_torn(program, folder, recording, last, env)
        check_closed_early(program, folder, recording, env)
        print(f"{last} ticks; a scrubbed place is on the screen after {took[len(took) // 2]:.0f} ms (median of "
              f"{len(took)}), {took[-1]:.0f} ms at most")
    except (Failed, subprocess.TimeoutExpired, KeyError, json.JSONDecodeError) as failure:
        print(f"FAILED: {failure!r}")
        return 1
    finally:
        if player and player.process.poll() is None:
            player.process.kill()
            player.process.wait()
        if not keep:
            shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
