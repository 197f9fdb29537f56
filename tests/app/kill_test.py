#!/usr/bin/env python3
"""Kills the program at random moments and looks at what is left: every recording replays up to its last second, the
store opens and says who was interrupted, and nothing that ended is lost. Also: two programs on one store, a full disk,
files that may not grow, output that cannot be written, a fault of the program itself.

    kill_test.py PROGRAM [--kills 3] [--seed 1]
    kill_test.py PROGRAM --full-disk             that alone

Exit 0 if all of it held, 77 if the full disk cannot be tried as mounting is not allowed. Needs no display and no network.
"""
import argparse
import json
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

EXERCISE = "gynaecology/sterilisation"
FILLING = 7  # [s] an attempt that fills the small disk and the small files
LOST_AT_MOST = 1000  # ticks: what a killed program may take with it


class Failed(Exception):
    pass


def check(condition, what):
    if not condition:
        raise Failed(what)


class Trocar:
    def __init__(self, program, folder):
        self.program, self.folder = program, Path(folder)
        self.folder.mkdir(exist_ok=True)
        self.data = self.folder / "data"
        self.environment = dict(os.environ, TROCAR_DATA=str(self.data), TMPDIR=str(self.folder))
        self.environment.setdefault("TROCAR_THREADS", "1")

    def train(self, name, seconds, trainee="ada", before=None):
        """Starts an attempt; its recording and its log are called `name`."""
        return subprocess.Popen(
            [self.program, "train", EXERCISE, "--input", "demo", "--headless", "--seconds", str(seconds), "--json",
             "--trainee", trainee, "--record", self.recording(name), "--log", self.log(name)],
            env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=before)

    def recording(self, name):
        return str(self.data / "recordings" / f"{name}.rec")

    def log(self, name):
        return str(self.folder / f"{name}.log")

    def events(self, name):
        events = []
        if os.path.exists(self.log(name)):
            for line in open(self.log(name)):
                try:
                    events.append(json.loads(line))
                except json.JSONDecodeError:
                    pass  # the line it was killed in
        return events

    def run(self, *words, expect=0):
        done = subprocess.run([self.program, *words], env=self.environment, capture_output=True, text=True)
        check(done.returncode == expect, f"{words}: exit {done.returncode}, not {expect}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def replay(self, path, *words):
        return subprocess.run([self.program, "replay", path, *words, "--json"], env=self.environment,
                              capture_output=True, text=True)

    def attempts(self):
        return json.loads(self.run("report", "--list", "--json"))["attempts"]


def how_long_a_run_takes(trocar):
    """Wall time of a short attempt that nobody disturbs, and until its recording began."""
    started = time.monotonic()
    begun = 0.0
    run = trocar.train("whole", 1)
    while run.poll() is None:
        if not begun and os.path.exists(trocar.recording("whole")):
            begun = time.monotonic() - started
        time.sleep(0.01)
    check(run.returncode in (0, 1), f"an undisturbed attempt ended with {run.returncode}: {run.stderr.read()}")
    return begun, time.monotonic() - started


def kill_one(trocar, name, moment, seconds):
    """Kills after `moment` seconds. What the log proves: ticks reached, and whether the attempt had ended."""
    run = trocar.train(name, seconds)
    time.sleep(moment)
    run.send_signal(signal.SIGKILL)
    run.communicate()
    events = trocar.events(name)
    reached = max([e["tick"] for e in events if e["event"] == "time"], default=0)
    ended = any(e["event"] == "end" for e in events)
    return reached, ended


def verify(trocar, name, reached):
    """The recording replays, to at most a second before the kill."""
    path = trocar.recording(name)
    if not os.path.exists(path):
        check(reached == 0, f"{name}: {reached} ticks were made, and there is no recording")
        return "before the recording"
    replayed = trocar.replay(path, "--verify")
    result = json.loads(replayed.stdout)
    if result["complete"]:
        check(result["verified"] and replayed.returncode == 0, f"{name}: {result.get('difference')}")
    else:  # as far as it goes, and it says that this is not the end
        check(not result["verified"] and replayed.returncode == 1, f"{name}: without an end, and verified")
        check("the recording ends early" in result["difference"] or "the file is damaged" in result["difference"],
              f"{name}: {result['difference']}")
        check("differs_between_ticks" not in result, f"{name}: {result['difference']}")
        check(result["verified_until_tick"] >= result["ticks"] - 100, f"{name}: {result}")
    check(result["ticks"] >= reached - LOST_AT_MOST,
          f"{name}: replays {result['ticks']} ticks of at least {reached}")
    return f"{result['ticks']} of at least {reached} ticks"


def kills(trocar, count, chance):
    begun, whole = how_long_a_run_takes(trocar)
    expected = {}
    for i in range(count):
        name = f"killed-{i}"
        if i % 3 == 2:  # around the moment at which the result is written
            seconds, moment = 1, whole + chance.uniform(-0.3, 0.1)
        else:
            seconds, moment = 60, begun + chance.uniform(-0.2, 4)
        reached, ended = kill_one(trocar, name, max(0.05, moment), seconds)
        expected[trocar.recording(name)] = (reached, ended)
        print(f"{name}: after {moment:.2f} s, {'ended' if ended else 'killed'}; {verify(trocar, name, reached)}",
              flush=True)
    check_store(trocar, expected)


def check_store(trocar, expected):
    attempts = trocar.attempts()
    numbers = [a["number"] for a in attempts]
    check(numbers == sorted(set(numbers)), f"numbers are not in order: {numbers}")
    by_recording = {a["recording"]: a for a in attempts}
    check(by_recording[trocar.recording("whole")]["state"] == "finished", "the undisturbed attempt is not there")
    for recording, (reached, ended) in expected.items():
        if recording not in by_recording:
            check(reached == 0 and not ended, f"{recording}: nothing is known of it")
            continue
        a = by_recording[recording]
        check(a["state"] == "finished" if ended else a["state"] in ("interrupted", "finished"),
              f"{recording}: {a['state']}, ended: {ended}")
        check(a["ticks"] >= reached - LOST_AT_MOST, f"{recording}: {a['ticks']} ticks, at least {reached} were made")
        check(a["trainee"] == "ada", f"{recording}: whose was it? {a['trainee']}")
    check(not list((trocar.data / "locks").iterdir()), "locks are left")
    states = [a["state"] for a in attempts]
    print(f"store: {states.count('interrupted')} interrupted, {states.count('finished')} finished", flush=True)


def broken(trocar):
    """A fault of the program itself, in the middle of an attempt: it says where, and the recording is whole."""
    run = trocar.train("broken", 60)
    while not trocar.events("broken"):
        check(run.poll() is None, "the attempt ended before it could break")
        time.sleep(0.01)
    time.sleep(1)
    run.send_signal(signal.SIGSEGV)
    said = run.communicate()[1]
    check(run.returncode == -signal.SIGSEGV, f"a broken program ended with {run.returncode}")
    check("died of a fault of its own (SIGSEGV)" in said, f"a broken program said: {said}")
    check(said.count("trocar(") > 2 or said.count("[0x") > 2, f"a broken program did not say where: {said}")
    verify(trocar, "broken", max([e["tick"] for e in trocar.events("broken") if e["event"] == "time"], default=0))


def two_at_once(trocar):
    runs = [trocar.train(f"both-{i}", 5, f"trainee {i}") for i in range(2)]  # long enough to be seen on a busy machine
    seen_running = 0
    while any(run.poll() is None for run in runs):
        seen_running = max(seen_running, sum(a["state"] == "running" for a in trocar.attempts()))
    for run in runs:
        check(run.returncode in (0, 1), run.stderr.read())
    both = [a for a in trocar.attempts() if a["trainee"].startswith("trainee ")]
    check(len(both) == 2 and all(a["state"] == "finished" for a in both), f"two at once: {both}")
    check(seen_running == 2, f"{seen_running} of two running attempts were seen by others")
    print("two at once: both finished, each seen running", flush=True)


def full_disk(program, folder):
    """A file system of a few megabytes: the recording fills it, the result is kept all the same."""
    disk = Path(folder) / "small"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=3m", "tmpfs", disk], capture_output=True)
    if mounted.returncode != 0:
        print("skipped: mounting a small disk is not allowed here", flush=True)
        return 77
    try:
        trocar = Trocar(program, disk)
        run = trocar.train("filling", FILLING)
        out, err = run.communicate()
        check(run.returncode in (0, 1), err)
        check("No space left" in err, f"a full disk is not told:\n{err}")
        result = json.loads(out)
        check(any("No space left" in n for n in result["notices"]), "the result does not tell of the full disk")
        a = trocar.attempts()[0]
        check(a["state"] == "finished" and a["ticks"] == 1000 * FILLING, f"full disk: {a}")
        replayed = json.loads(trocar.run("replay", trocar.recording("filling"), "--json"))
        check(1000 < replayed["ticks"] < 1000 * FILLING, "the recording of a full disk replays as far as it reaches")
        print(f"full disk: told, the result is kept, {replayed['ticks']} of {1000 * FILLING} ticks recorded", flush=True)
        return 0
    finally:
        subprocess.run(["umount", "-l", disk], check=False)


def small_files(program, folder):
    """No file may grow beyond some kilobytes (ulimit -f): told, and the result is kept all the same."""
    trocar = Trocar(program, Path(folder) / "limited")
    limit = 100 * 1024
    run = trocar.train("limited", FILLING, before=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
    out, err = run.communicate()
    check(run.returncode in (0, 1, 3), f"with small files only, it ended with {run.returncode}: {err}")
    check("File too large" in err, f"files that may not grow are not told:\n{err}")
    result = json.loads(out)
    check(result["ticks"] == 1000 * FILLING, f"with small files only: {result['ticks']} ticks")
    check(any("File too large" in n for n in result["notices"]), "the result does not tell of the small files")
    a = trocar.attempts()[0]
    check(a["state"] == "finished" and a["ticks"] == 1000 * FILLING, f"small files: {a}")
    print("small files: told, the result is kept", flush=True)


def full_output(trocar):
    for words in (["list", "--json"], ["list"], ["report", "--list"], ["--help"]):
        with open("/dev/full", "w") as full:
            done = subprocess.run([trocar.program, *words], env=trocar.environment, stdout=full, stderr=subprocess.PIPE,
                                  text=True)
        check(done.returncode == 3 and "standard output" in done.stderr, f"{words} into /dev/full: {done}")
    print("full output: told, exit 3", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=3)
    parser.add_argument("--full-disk", action="store_true")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    options = parser.parse_args()
    print(f"seed {options.seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix="trocar-kill-") as folder:
        trocar = Trocar(options.program, folder)
        try:
            if options.full_disk:
                return full_disk(options.program, folder)
            kills(trocar, options.kills, random.Random(options.seed))
            broken(trocar)
            two_at_once(trocar)
            small_files(options.program, folder)
            full_output(trocar)
        except Failed as failed:
            print(f"FAILED: {failed}", file=sys.stderr)
            return 1
    print("all of it held")
    return 0


if __name__ == "__main__":
    sys.exit(main())
