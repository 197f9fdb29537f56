#!/usr/bin/env python3
"""Do two builds of Trocar compute the same? Both do the same operations headless, and all that they recorded is compared.

    tools/same_physics.py BEFORE AFTER [--seeds N] [--jobs N] [--only WORDS] [--work DIR]
                          [--hands FILE[#OPERATOR/TRIAL]]...
        BEFORE, AFTER  two programs `trocar`, as built from two commits
        --seeds        anatomies 0 .. N-1 of every demonstration (default 20)
        --only         operations with these words in their name
        --hands        recorded hands for the scenes without a task (docs/guides/motion_input.md)

Operations: every exercise's demonstration on every seed; every scene without a task under each of the recorded hands, and
under the hands of `trocar bench`, which pull at what is nearest. Compared, for every operation:
    hashes      of the whole State and all inputs so far, every 100 ticks: equal hashes are equal bits
    keyframes   places of all nodes every 100 ticks, in steps of 0.01 mm: told apart from the hashes, so that a State that
                only counts other things can be told from physics that differs
    inputs      of every tick
    result      steps, errors, score, final hash
Exit 0: nothing differs. 1: a line for each operation that does, with the first tick. 2: a program could not do it.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import struct
import subprocess
import sys
from pathlib import Path

SIGNATURE = b"\x93TROCAR\n"
BLOCK = struct.Struct("<IIQQQQ")  # sim/recording/recording.cpp
INPUTS, HASHES, KEYFRAME = 2, 3, 4


def blocks(path):
    """Yields (kind, first tick, payload) of a recording."""
    data = path.read_bytes()
    if data[:8] != SIGNATURE:
        sys.exit(f"{path}: not a recording")
    at = 8
    while at + BLOCK.size <= len(data):
        _, kind, first, _, size, _ = BLOCK.unpack_from(data, at)
        yield kind, first, data[at + BLOCK.size:at + BLOCK.size + size]
        at += BLOCK.size + size


def content(path):
    """Of a recording: {tick: hash}, {tick: digest of the keyframe}, {first tick of a block: digest of the inputs}."""
    hashes, keyframes, inputs = {}, {}, {}
    for kind, first, payload in blocks(path):
        if kind == HASHES:
            hashes.update(struct.iter_unpack("<QQ", payload))
        elif kind == KEYFRAME:
            keyframes[first] = hashlib.sha1(payload).digest()
        elif kind == INPUTS:
            inputs[first] = hashlib.sha1(payload).digest()
    return {"hashes": hashes, "keyframes": keyframes, "inputs": inputs}


def judged(result):
    """What an educator reads of a result."""
    a = result.get("assessment") or {}
    return {key: a.get(key) for key in ("steps", "errors", "score", "passed", "finished")}


def run(program, arguments, work):
    done = subprocess.run([program, *arguments], capture_output=True, text=True,
                          env={**os.environ, "TROCAR_DATA": str(work / "data"), "TROCAR_THREADS": "1"})
    if done.returncode > 1:
        raise RuntimeError(f"{program} {' '.join(arguments)}: exit {done.returncode}\n{done.stderr[-1000:]}")
    return json.loads(done.stdout)


def attempt(program, work, name, arguments):
    work.mkdir(parents=True, exist_ok=True)
    recording = work / (name.replace("/", "-").replace("#", "-") + ".rec")
    result = run(program, ["train", *arguments, "--headless", "--no-store", "--json", "--record", str(recording)], work)
    found = content(recording)
    recording.unlink()
    return {**found, "result": {0: judged(result)}, "final": {0: result["state_hash"]}}


def bench(program, work, scene):
    work.mkdir(parents=True, exist_ok=True)
    result = run(program, ["bench", scene, "--seconds", "10", "--json", "-"], work)
    return {"final": dict(enumerate(hashes_in(result)))}


def hashes_in(value):
    """Every "state_hash" in a JSON value, in its order."""
    if isinstance(value, dict):
        return [h for k, v in value.items() for h in ([v] if k == "state_hash" else hashes_in(v))]
    return [h for v in value for h in hashes_in(v)] if isinstance(value, list) else []


def first_difference(before, after):
    """For each kind of content the first tick at which it differs."""
    out = {}
    for what in before:
        ticks = [t for t in sorted(set(before[what]) | set(after[what])) if before[what].get(t) != after[what].get(t)]
        if ticks:
            out[what] = ticks[0]
    return out


def operations(listing, seeds, hands):
    """Yields (name, function of (program, folder))."""
    for exercise in (e["name"] for e in listing["exercises"]):
        for seed in range(seeds):
            name = f"{exercise}, demonstration, seed {seed}"
            words = [exercise, "--input", "demo", "--seed", str(seed)]
            yield name, lambda p, w, n=name, a=words: attempt(p, w, n.replace(", ", "-").replace(" ", "-"), a)
    for scene in (s["name"] for s in listing["scenes"]):  # those that exercises take place in, too
        for hand in hands:
            name = f"{scene}, hands {Path(hand).name}"
            words = [scene, "--input", f"motion:{hand}"]
            yield name, lambda p, w, n=name, a=words: attempt(p, w, n.replace(", ", "-").replace(" ", "-"), a)
        yield f"{scene}, bench", lambda p, w, s=scene: bench(p, w, s)


def compare(operation, programs, work):
    name, do = operation
    try:
        before, after = (do(p, work / side) for p, side in zip(programs, ("before", "after")))
    except (RuntimeError, OSError, ValueError) as failure:
        return name, None, str(failure)
    return name, first_difference(before, after), before["final"].get(0, "no hash")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", default="")
    parser.add_argument("--hands", action="append", default=[])
    parser.add_argument("--work", type=Path, default=Path("build/same_physics"))
    args = parser.parse_args()
    programs = [str(Path(p).resolve()) for p in (args.before, args.after)]
    args.work.mkdir(parents=True, exist_ok=True)
    listing = run(programs[0], ["list", "--json"], args.work)
    todo = [o for o in operations(listing, args.seeds, args.hands) if args.only in o[0]]
    failed, differ = 0, 0
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for name, difference, told in pool.map(lambda o: compare(o, programs, args.work), todo):
            if difference is None:
                failed += 1
                print(f"FAILED   {name}: {told}")
            elif difference:
                differ += 1
                print(f"DIFFERS  {name}: " + ", ".join(f"{what} from tick {t}" for what, t in difference.items()))
            else:
                print(f"same     {told}  {name}", flush=True)
    print(f"{len(todo) - differ - failed} of {len(todo)} operations the same bits"
          + (f", {differ} differ" if differ else "") + (f", {failed} could not be done" if failed else ""))
    return 2 if failed else 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
