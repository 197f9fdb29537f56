#!/usr/bin/env python3
"""Nothing flickers and nothing swims: the picture before, warped by the optical flow, is the next one, while the camera
turns and a tube is pulled.

    python3 tests/app/temporal_test.py PATH/TO/trocar

Exit: 0 passed, 1 failed, 77 NumPy or Pillow is missing.
"""
import os
import sys
import tempfile

from frames import Frames, expect, numpy, run

try:
    from PIL import Image
except ImportError:
    print("skipped: needs Pillow")
    sys.exit(77)


def warped(picture, flow):
    """At each pixel what the flow leads to; bilinear."""
    rows, columns = flow.shape[:2]
    row, column = numpy.mgrid[0:rows, 0:columns]
    x = numpy.clip(column + flow[..., 0], 0, columns - 1.001)
    y = numpy.clip(row + flow[..., 1], 0, rows - 1.001)
    i, j = x.astype(int), y.astype(int)
    a, b = (x - i)[..., None], (y - j)[..., None]
    return ((1 - a) * (1 - b) * picture[j, i] + a * (1 - b) * picture[j, i + 1] + (1 - a) * b * picture[j + 1, i]
            + a * b * picture[j + 1, i + 1])


def differences(frames):
    """A row a frame: flow [px], difference to the picture before and to it warped (means), its median; and the tube's."""
    rows, of_tube = [], []
    tube = frames.part("tube_left")
    for i in range(1, len(frames.lines)):
        part, flow = frames.layer("part", i), frames.layer("flow", i)
        known = numpy.nan_to_num(flow)
        same = warped(frames.layer("part", i - 1)[..., None].astype(float), known)[..., 0]
        seen = (part > 0) & ~numpy.isnan(flow[..., 0]) & (abs(same - part) < 1e-3)  # in both pictures
        now, was = (numpy.array(Image.open(frames.picture(k))).astype(float) for k in (i, i - 1))
        plain, left = abs(now - was), abs(now - warped(was, known))
        far = numpy.hypot(flow[..., 0], flow[..., 1])
        rows.append((far[seen].mean(), plain[seen].mean(), left[seen].mean(), numpy.median(left[seen])))
        on_tube = seen & (part == tube)
        if on_tube.sum() > 500 and far[on_tube].mean() > 0.5:
            of_tube.append((plain[on_tube].mean(), left[on_tube].mean()))
    return numpy.array(rows), numpy.array(of_tube)


def check(name, frames):
    rows, of_tube = differences(frames)
    moving, still = rows[rows[:, 0] > 0.5], rows[rows[:, 0] < 0.01]
    if len(moving):
        print(f"{name}: {len(moving)} pictures of something that moves, {moving[:, 0].mean():.1f} px a picture: difference to "
              f"the one before {moving[:, 1].mean():.2f} of 255, warped {moving[:, 2].mean():.2f}, median "
              f"{numpy.median(moving[:, 3]):.2f}")
        # What is left are highlights, the lamp that goes with the camera, and what bilinear reading blurs.
        expect(moving[:, 2].mean() < 0.5 * moving[:, 1].mean(), f"{name}: patterns swim")
        expect(numpy.median(moving[:, 3]) < 2.5, f"{name}: half of the picture changes by more than 2.5 of 255")
    if len(of_tube):
        plain, left = of_tube.mean(axis=0)
        print(f"{name}: on the tube {plain:.2f}, warped {left:.2f}")
        expect(left < 0.6 * plain, f"{name}: patterns swim on the tube")
    if len(still):
        print(f"{name}: {len(still)} pictures where all is still: {still[:, 1].max():.2f}")
        expect(still[:, 1].max() < 1, f"{name}: a still picture flickers")
    return len(moving), len(of_tube), len(still)


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        recording = os.path.join(folder, "a.rec")
        done = run(program, "train", "gynaecology/sterilisation", "--input", "demo", "--headless", "--no-store",
                   "--seconds", 17.4, "--record", recording)
        expect(done.returncode in (0, 1), done.stderr)
        counted = numpy.zeros(3, int)
        # At first nobody moves, then the endoscope looks around and goes near; then a grasper takes the tube and pulls it.
        for name, begin, end in [("waiting", 0.6, 1.0), ("camera", 3.4, 5.0), ("pull", 15.2, 17.2)]:
            data = os.path.join(folder, name)
            done = run(program, "replay", recording, "--data", data, "--data-rate", 25, "--from", begin, "--to", end,
                       "--size", "400x300")
            expect(done.returncode == 0, done.stderr)
            counted += check(name, Frames(data))
        expect(all(counted > 5), f"too little was seen to judge by: {counted}")
    print("passed")


main()
