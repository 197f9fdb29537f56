#!/usr/bin/env python3
"""Computes the motion and force metrics a second time, independently of the program, and compares.

    tools/check_metrics.py vectors                            the formulas below against published figures
    tools/check_metrics.py trials TROCAR MOTIONS.csv          against `trocar trials MOTIONS.csv --json`
    tools/check_metrics.py made TROCAR                        the same, on trials that are made up
    tools/check_metrics.py trace TRACE.csv METRICS.json       against the metrics of one stored trace
    tools/check_metrics.py sample TRAINING_TEST               the same, on a trace that the test program writes

Shares no code with the program: reads the files itself, filters with scipy, transforms with numpy, and writes each
formula out again from docs/guides/metrics.md. Exit 0 they agree, 1 they do not, 77 skipped (numpy, scipy or data missing).
"""
import csv
import io
import json
import math
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import scipy.signal
    import scipy.stats
except ImportError as missing:
    print(f"skipped: {missing}; Debian has it as python3-numpy and python3-scipy")
    sys.exit(77)

RATE, CUTOFF, MOVING, IDLE, IDLE_TIME = 50.0, 10.0, 0.005, 0.002, 1.0
TOLERANCE = 1e-6  # relative; both sides work in double precision


# --- formulas ---

def low_pass(x, rate):
    """Zero-phase Butterworth, order 4 each way, over the first axis."""
    if len(x) < 17:
        raise ValueError("too short for filtfilt's ends")
    sections = scipy.signal.butter(4, CUTOFF, fs=rate, output="sos")
    return scipy.signal.sosfiltfilt(sections, x, axis=0, padtype="odd", padlen=15)


def speed_of(p, rate):
    return np.linalg.norm(np.gradient(p, 1 / rate, axis=0), axis=1)


def dlj(v, rate):
    return -(len(v) / rate) ** 3 / np.max(np.abs(v)) ** 2 * np.sum(np.square(np.diff(v, 2) * rate ** 2)) / rate


def ldlj(v, rate):
    value = abs(dlj(v, rate))
    return -math.log(value) if value > 0 else math.nan


def sparc(v, rate, padlevel=4, fc=10.0, threshold=0.05):
    n = 2 ** (math.ceil(math.log2(len(v))) + padlevel)
    f = np.arange(n) * rate / n
    m = np.abs(np.fft.fft(v, n))
    m = m / m.max()
    f, m = f[(f <= fc)], m[(f <= fc)]
    keep = np.nonzero(m >= threshold)[0]
    f, m = f[keep[0]:keep[-1] + 1], m[keep[0]:keep[-1] + 1]
    return -np.sum(np.hypot(np.diff(f) / (f[-1] - f[0]), np.diff(m)))


def runs(flags):
    """(first, one past last) of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(int), [0]))))
    return list(zip(edges[::2], edges[1::2]))


def movements(v, rate):
    return [v[a:b] for a, b in runs(v >= 0.05 * v.max()) if (b - a) >= 0.25 * rate]


def mean_jerk(p, rate):
    path = np.linalg.norm(np.diff(p, axis=0), axis=1).sum()
    jerk = np.diff(p, 3, axis=0) * rate ** 3
    duration = (len(p) - 1) / rate
    return math.sqrt(0.5 * duration ** 5 / path ** 2 * np.sum(jerk ** 2) / rate)


def idle_fraction(speeds, rate):
    still = np.all(np.array(speeds) < IDLE, axis=0)
    return sum(b - a for a, b in runs(still) if (b - a) >= IDLE_TIME * rate) / len(still)


def rotate(q, v):
    w, u = q[:, :1], q[:, 1:]
    return v + 2 * np.cross(u, np.cross(u, v) + w * v)


def angles_between(q):
    """2 acos |q . q'|, by the chord, which keeps its digits: |q - q'| = 2 sin(angle / 4)."""
    a, b = q[:-1], q[1:] * np.sign(np.sum(q[:-1] * q[1:], axis=1))[:, None]
    return 4 * np.arcsin(np.clip(np.linalg.norm(a - b, axis=1) / 2, 0, 1))


def reversals(s, least):
    """Turning points of the zigzag that ignores swings of up to `least`."""
    turns, extreme, direction = [], 0, 0
    low = high = 0
    for i in range(1, len(s)):
        if direction == 0:
            low = i if s[i] < s[low] else low
            high = i if s[i] > s[high] else high
            if s[high] - s[i] > least:
                direction, extreme = -1, i
            elif s[i] - s[low] > least:
                direction, extreme = 1, i
        elif (s[i] - s[extreme]) * direction > 0:
            extreme = i
        elif (s[extreme] - s[i]) * direction > least:
            turns.append(extreme)
            direction, extreme = -direction, i
    return turns


def forces(f, rate, limit):
    size = np.linalg.norm(f, axis=1)
    nonzero = size[size >= 0.01]
    spread = np.sqrt(np.clip(np.linalg.eigvalsh(np.cov(f.T, bias=True)), 0, None))
    return {"max_N": size.max(), "mean_nonzero_N": nonzero.mean() if len(nonzero) else 0.0,
            "rms_N": math.sqrt(np.mean(size ** 2)), "impulse_Ns": size.sum() / rate,
            "volume_N3": 4 / 3 * math.pi * np.prod(3 * spread), "above_limit_s": np.sum(size > limit) / rate}


# --- a trace and its metrics ---

class Hand:
    """Columns of one hand: p (n x 3) [m], q (n x 4), pinch (n), pull and contact (n x 3) [N]."""

    def __init__(self, name, p, q, pinch=None, pull=None, contact=None, shaft=True):
        self.has_forces = pull is not None
        self.name, self.p, self.q, self.shaft = name, np.asarray(p, float), np.array(q, float), shaft
        n = len(self.p)
        self.pinch = np.zeros(n) if pinch is None else np.asarray(pinch, float)
        self.pull = np.zeros((n, 3)) if pull is None else np.asarray(pull, float)
        self.contact = np.zeros((n, 3)) if contact is None else np.asarray(contact, float)

    def filtered(self, rate):
        q = self.q / np.linalg.norm(self.q, axis=1)[:, None]
        for i in range(1, len(q)):
            if q[i - 1] @ q[i] < 0:
                q[i] = -q[i]
        q = low_pass(q, rate)
        return low_pass(self.p, rate), q / np.linalg.norm(q, axis=1)[:, None]


def metrics_of(hands, rate, start=0.0, marks=(), limits=(4, 15, 4)):
    """As docs/guides/metrics.md; the same names as in the program's JSON."""
    motion = [h.filtered(rate) for h in hands]
    speeds = [speed_of(p, rate) for p, _ in motion]
    n = len(speeds[0])
    first = next(i for i in range(n) if any(v[i] > MOVING for v in speeds))
    window = slice(first, n)
    result = {"from_s": start + first / rate, "to_s": start + (n - 1) / rate, "time_s": (n - 1 - first) / rate,
              "duration_s": (n - 1) / rate, "hands": []}
    every = {"ldlj": [], "sparc": []}
    for number, (hand, (p, q), v) in enumerate(zip(hands, motion, speeds)):
        whole_p, p, q, v = p, p[window], q[window], v[window]
        path = np.linalg.norm(np.diff(p, axis=0), axis=1).sum()
        parts = movements(v, rate)
        own = {"ldlj": [ldlj(m, rate) for m in parts], "sparc": [sparc(m, rate) for m in parts]}
        for key, values in own.items():
            every[key] += values
        places = [whole_p[s] for kind, who, s in marks if who == number and first < s < n - 1]
        out = {"name": hand.name, "path_m": path, "angular_path_rad": angles_between(q).sum(),
               "mean_jerk": mean_jerk(p, rate), "ldlj": np.mean(own["ldlj"]), "sparc": np.mean(own["sparc"]),
               "movements": len(parts), "idle_fraction": idle_fraction([v], rate),
               "mean_speed_m_per_s": path / ((n - 1 - first) / rate), "peak_speed_m_per_s": v.max(),
               "reference_path_m": None, "economy": None, "depth_m": None, "depth_reversals": None,
               "depth_reversals_near_target": None, "forces": {}}
        if places:
            way = np.array([p[0], *places, p[-1]])
            out["reference_path_m"] = np.linalg.norm(np.diff(way, axis=0), axis=1).sum()
            out["economy"] = out["reference_path_m"] / path
        if hand.shaft:
            shaft = rotate(q, np.tile([0.0, 0.0, -1.0], (len(q), 1)))
            mean = shaft[:-1] + shaft[1:]
            mean /= np.linalg.norm(mean, axis=1)[:, None]
            steps = np.sum(np.diff(p, axis=0) * mean, axis=1)
            turns = reversals(np.concatenate(([0], np.cumsum(steps))), 0.003)
            out["depth_m"], out["depth_reversals"] = np.abs(steps).sum(), len(turns)
            if places:
                targets = np.array([p[0], *places, p[-1]])
                out["depth_reversals_near_target"] = sum(
                    np.linalg.norm(targets - p[t], axis=1).min() <= 0.020 for t in turns)
        pinch = np.column_stack((hand.pinch, 0 * hand.pinch, 0 * hand.pinch))
        for kind, f, limit in zip(("pull", "pinch", "contact"), (hand.pull, pinch, hand.contact), limits):
            out["forces"][kind] = forces(f[window], rate, limit) if hand.has_forces else None
            if kind == "pinch" and hand.has_forces:
                out["forces"][kind]["volume_N3"] = None
        result["hands"].append(out)
    paths = [h["path_m"] for h in result["hands"]]
    result["both"] = {"path_m": sum(paths), "ldlj": np.mean(every["ldlj"]), "sparc": np.mean(every["sparc"]),
                      "angular_path_rad": sum(h["angular_path_rad"] for h in result["hands"]),
                      "mean_jerk": np.mean([h["mean_jerk"] for h in result["hands"]]),
                      "movements": len(every["sparc"]), "idle_fraction": idle_fraction([v[window] for v in speeds], rate)}
    if len(hands) == 2:
        a, b = (v[window] for v in speeds)
        result["bimanual"] = {"path_ratio": min(paths) / max(paths),
                              "simultaneous_fraction": np.sum((a > MOVING) & (b > MOVING)) /
                              np.sum((a > MOVING) | (b > MOVING)),
                              "speed_correlation": np.corrcoef(a, b)[0, 1]}
    return result


def camera_of(eye, horizon, rate, start=0.0, first=None):
    """Of the endoscope, from its own first motion unless `first` is a hand's."""
    lens = low_pass(eye, rate)
    if first is None:
        first = next(i for i, v in enumerate(speed_of(lens, rate)) if v > MOVING)
    tilt = np.sort(np.abs(horizon[first:][horizon[first:] != 1000]))
    return {"path_m": np.linalg.norm(np.diff(lens[first:], axis=0), axis=1).sum(),
            "horizon_mean_deg": tilt.mean() if len(tilt) else None,
            "horizon_p95_deg": tilt[math.ceil(0.95 * len(tilt)) - 1] if len(tilt) else None}


# --- motion files ---

def tangents(points, t):
    """Velocities at the rows of a smooth curve, from docs/guides/motion_input.md: direction the bisector of the directions
    before and after, size 2ab/(a+b) cos^4(turn/2); zero at the ends. points: (n x d)."""
    v = np.zeros_like(points)
    slopes = np.diff(points, axis=0) / np.diff(t)[:, None]
    for i in range(1, len(points) - 1):
        a, b = np.linalg.norm(slopes[i - 1]), np.linalg.norm(slopes[i])
        if a == 0 or b == 0:
            continue
        cos_turn = np.clip(slopes[i - 1] @ slopes[i] / (a * b), -1, 1)
        cos_half_squared = (1 + cos_turn) / 2
        bisector = slopes[i - 1] / a + slopes[i] / b
        size = np.linalg.norm(bisector)
        if size > 1e-9:
            v[i] = bisector / size * 2 * a * b / (a + b) * cos_half_squared ** 2
    return v


def curve(points, t, at):
    v = tangents(points, t)
    i = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    h = (t[i + 1] - t[i])[:, None]
    u = (at[:, None] - t[i][:, None]) / h
    return ((1 + 2 * u) * (1 - u) ** 2 * points[i] + u * (1 - u) ** 2 * h * v[i]
            + u ** 2 * (3 - 2 * u) * points[i + 1] - u ** 2 * (1 - u) * h * v[i + 1])


def read_motions(path):
    """{(operator, trial): array of rows}, in the file's order."""
    trials = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            numbers = [float(row[c]) for c in ("t_ms", "xL", "yL", "zL", "rollL", "xR", "yR", "zR", "rollR")]
            trials.setdefault((row["operator"], row["trial"]), []).append(numbers)
    return {name: np.array(rows) for name, rows in trials.items()}


def motion_metrics(rows):
    t = (rows[:, 0] - rows[0, 0]) / 1000
    at = np.minimum(np.arange(int(t[-1] * RATE + 1e-6) + 1) / RATE, t[-1])
    hands = []
    for name, first in (("left", 1), ("right", 5)):
        p = curve(rows[:, first:first + 3] / 1000, t, at)
        half = curve(rows[:, first + 3:first + 4], t, at)[:, 0] / 2
        q = np.column_stack((np.cos(half), 0 * half, 0 * half, np.sin(half)))
        hands.append(Hand(name, p, q, shaft=False))
    return metrics_of(hands, RATE)


# --- comparing ---

class Comparison:
    def __init__(self):
        self.checked, self.worst, self.where, self.bad = 0, 0.0, "", []

    def number(self, place, theirs, ours, tolerance=TOLERANCE, size=0.0):
        self.checked += 1
        if theirs is None or ours is None or math.isnan(ours):
            if not (theirs is None and (ours is None or math.isnan(ours))):
                self.bad.append(f"{place}: program {theirs}, here {ours}")
            return
        difference = abs(theirs - ours) / max(abs(ours), size, 1e-3)
        if difference > self.worst:
            self.worst, self.where = difference, place
        if not difference <= tolerance:
            self.bad.append(f"{place}: program {theirs!r}, here {float(ours)!r}")

    def tree(self, place, theirs, ours):
        """Everything that is in `ours` must be in `theirs`."""
        for key, value in ours.items():
            where = f"{place}.{key}"
            if key == "hands":
                for a, b in zip(theirs[key], value):
                    self.tree(f"{place}.{b['name']}", a, b)
            elif key == "name":
                pass
            elif isinstance(value, dict):
                self.tree(where, theirs[key], value)
            else:
                # The volume is a root of a small difference: its digits are those of the largest force cubed.
                self.number(where, theirs[key], value, size=1.0 if key == "volume_N3" else 0.0)

    def finish(self, what):
        for line in self.bad[:20]:
            print(line)
        if len(self.bad) > 20:
            print(f"... and {len(self.bad) - 20} more")
        print(f"{what}: {self.checked} figures compared, {len(self.bad)} differ; "
              f"largest relative difference {self.worst:.1e} ({self.where})")
        return 1 if self.bad or not self.checked else 0


def vectors():
    c = Comparison()
    t = np.arange(-1, 1, 0.01)
    bell = np.exp(-5 * t ** 2)
    c.number("bell.sparc", -1.41403, sparc(bell, 100), 1e-5)
    c.number("bell.dlj", -335.74684, dlj(bell, 100), 1e-5)
    c.number("bell.ldlj", -5.81636, ldlj(bell, 100), 1e-5)
    u = np.linspace(0, 1, 2_000_001)
    c.number("minimum_jerk.ldlj", -math.log(204.8), ldlj(30 * u ** 2 * (1 - u) ** 2, 2e6), 1e-5)
    return c.finish("vectors")


def spread(values):
    q = np.percentile(values, [0, 25, 50, 75, 100])
    return dict(zip(("min", "q1", "median", "q3", "max"), q), count=len(values))


def trend(rows, without=None):
    """(slope with an offset for each person, rho over all, mean of the persons' rho) of (person, repetition, value)."""
    rows = [r for r in rows if r[0] != without]
    persons = sorted({r[0] for r in rows})
    design = np.array([[r[1]] + [float(r[0] == p) for p in persons] for r in rows])
    slope = np.linalg.lstsq(design, np.array([r[2] for r in rows]), rcond=None)[0][0]
    rho = lambda some: scipy.stats.spearmanr([r[1] for r in some], [r[2] for r in some])[0]
    own = [rho([r for r in rows if r[0] == p]) for p in persons]
    return slope, rho(rows), np.nanmean(own)


def check_trials(program, motions):
    if not os.path.exists(motions):
        print(f"skipped: no motion data at {motions}")
        return 77
    answer = subprocess.run([program, "trials", motions, "--json"], capture_output=True, text=True)
    if answer.returncode != 0:
        print(f"trocar trials failed with {answer.returncode}: {answer.stderr}")
        return 1
    theirs = json.loads(answer.stdout)
    c, counts, table = Comparison(), {}, []
    by_name = {(a["person"], a["trial"]): a for a in theirs["attempts"]}
    for (person, trial), rows in read_motions(motions).items():
        counts[person] = counts.get(person, 0) + 1
        ours = motion_metrics(rows)
        attempt = by_name.pop((person, trial))
        c.number(f"{person}/{trial}.repetition", attempt["repetition"], counts[person])
        c.tree(f"{person}/{trial}", attempt["metrics"], ours)
        table.append((person, counts[person], {"duration_s": (rows[-1, 0] - rows[0, 0]) / 1000, "time_s": ours["time_s"],
                                               **ours["both"], **ours["bimanual"]}))
    c.number("attempts that only the program has", len(by_name), 0)
    for metric in theirs["metrics"]:
        key = metric["key"]
        if key not in table[0][2]:
            continue
        rows = [(p, r, m[key]) for p, r, m in table]
        place = f"study.{key}"
        c.tree(f"{place}.spread", metric["spread"], spread([r[2] for r in rows]))
        for repetition, entry in enumerate(metric["by_repetition"], 1):
            c.tree(f"{place}.{repetition}", entry, spread([r[2] for r in rows if r[1] == repetition]))
        whole, without = trend(rows), np.array([trend(rows, p) for p in counts])
        for i, name in enumerate(("slope_per_repetition", "spearman_pooled", "spearman_within")):
            c.tree(f"{place}.{name}", metric["trend"][name],
                   {"value": whole[i], "low": without[:, i].min(), "high": without[:, i].max()})
    duration = next(m for m in theirs["metrics"] if m["key"] == "duration_s")["trend"]
    print(f"duration: {duration['slope_per_repetition']['value']:.2f} s a repetition, rho "
          f"{duration['spearman_pooled']['value']:.3f} ({duration['spearman_pooled']['low']:.3f} .. "
          f"{duration['spearman_pooled']['high']:.3f} when a person is left out)")
    if not duration["spearman_pooled"]["high"] < 0 or not duration["slope_per_repetition"]["high"] < 0:
        c.bad.append("durations do not fall with repetition")
    return c.finish(f"{len(table)} trials of {len(counts)} people")


def made_motions(path, persons=5, trials=6):
    """Writes trials at about 1 Hz: people who wander from target to target, each trial with fewer detours."""
    random = np.random.default_rng(7)
    with open(path, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow("operator trial t_ms xL yL zL rollL handleL xR yR zR rollR handleR subtask".split())
        for person in range(persons):
            skill = random.uniform(0.5, 1.5)
            for trial in range(trials):
                length = int(60 * skill * (0.4 + 0.6 * 0.7 ** trial)) + int(random.integers(5, 10))
                place = random.uniform(-20, 20, 6)
                t = int(random.integers(0, 5000))
                for _ in range(length):
                    place = place + random.normal(0, 8, 6) * (random.random(6) < 0.7)  # hands rest at times
                    turn, handle = random.normal(0, 0.5, 2), random.uniform(0, 1, 2)
                    rows.writerow([f"P{person}", f"T{trial + 1}", t, *place[:3], turn[0], handle[0], *place[3:], turn[1],
                                   handle[1], 1])
                    t += int(random.choice([1000, 1000, 1000, 760, 1500]))  # durations in whole samples of 20 ms


def check_made(program):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "made.csv")
        made_motions(path)
        return check_trials(program, path)


def check_trace(trace, metrics):
    rate, shafts, marks, body = RATE, {}, [], []
    with open(trace, newline="") as file:
        for line in file:
            words = line[1:].split()
            if not line.startswith("#"):
                body.append(line)
            elif words[0] == "rate_hz":
                rate = float(words[1])
            elif words[0] == "hand":
                shafts[words[1]] = words[2] == "shaft"
            elif words[0] == "mark":
                marks.append((words[1], list(shafts).index(words[2]), int(words[3])))
    rows = list(csv.DictReader(io.StringIO("".join(body))))
    column = lambda hand, *names: np.array([[float(r[f"{hand}.{name}"]) for name in names] for r in rows])
    hands = [Hand(h, column(h, "x_m", "y_m", "z_m"), column(h, "qw", "qx", "qy", "qz"), column(h, "pinch_N")[:, 0],
                  column(h, "pull_x_N", "pull_y_N", "pull_z_N"), column(h, "contact_x_N", "contact_y_N", "contact_z_N"),
                  shaft) for h, shaft in shafts.items()]
    with open(metrics) as file:
        theirs = json.load(file)
    c = Comparison()
    start = float(rows[0]["t_s"])
    ours = metrics_of(hands, rate, start, marks) if hands else {}
    if "scope.horizon_deg" in rows[0]:
        first = round((ours["from_s"] - start) * rate) if hands else None
        ours["camera"] = camera_of(column("scope", "eye_x_m", "eye_y_m", "eye_z_m"), column("scope", "horizon_deg")[:, 0],
                                   rate, start, first)
    c.tree("trace", theirs, ours)
    return c.finish(f"trace of {len(hands)} hands, {len(rows)} samples")


def check_sample(test_program):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([test_program, "--gtest_filter=Metrics.AreTheSameFromAStoredTrace:Metrics.OfTheEndoscopeAreTheSameFromAStoredTrace"], check=True,
                       env={**os.environ, "TROCAR_METRICS_SAMPLE": folder}, stdout=subprocess.DEVNULL)
        return max(check_trace(os.path.join(folder, name + ".csv"), os.path.join(folder, name + ".json"))
                   for name in ("trace", "camera"))


def main(arguments):
    modes = {"vectors": (vectors, 0), "trials": (check_trials, 2), "made": (check_made, 1),
             "trace": (check_trace, 2), "sample": (check_sample, 1)}
    if not arguments or arguments[0] not in modes or len(arguments) != 1 + modes[arguments[0]][1]:
        print(__doc__)
        return 2
    return modes[arguments[0]][0](*arguments[1:])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
