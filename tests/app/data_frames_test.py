#!/usr/bin/env python3
"""Frames for research, read as docs/guides/data_frames.md says and checked against geometry.

    python3 tests/app/data_frames_test.py PATH/TO/trocar

Exit: 0 passed, 1 failed, 77 NumPy is missing.
"""
import os
import sys
import tempfile

from frames import Frames, expect, numpy, run

WIDTH, HEIGHT = 320, 240


def pixels():
    return numpy.meshgrid(numpy.arange(WIDTH), numpy.arange(HEIGHT))


def to_world(camera, depth):
    """The points that the pixels show."""
    column, row = pixels()
    x, y = column - camera["centre"][0], row - camera["centre"][1]
    scale = (1 + camera["barrel"] * (x * x + y * y) / camera["radius"] ** 2) / (1 + camera["barrel"])
    f = camera["focal"]
    points = numpy.stack([(x * scale / f + camera["shift"]) * depth, y * scale / f * depth, depth,
                          numpy.ones_like(depth)], -1)
    return points @ numpy.array(camera["to_world"]).T


def to_pixels(camera, world):
    points = world @ numpy.linalg.inv(numpy.array(camera["to_world"])).T
    u = camera["focal"] * (points[..., 0] / points[..., 2] - camera["shift"])
    v = camera["focal"] * points[..., 1] / points[..., 2]
    s = numpy.hypot(u, v) / camera["radius"]
    r, k = s.copy(), camera["barrel"]
    for _ in range(8):
        r -= (r * (1 + k * r * r) - (1 + k) * s) / (1 + 3 * k * r * r)
    by = numpy.where(s > 0, r / numpy.maximum(s, 1e-9), 1)
    return u * by + camera["centre"][0], v * by + camera["centre"][1]


def check_shapes(frames, count):
    expect(len(frames.lines) == count, f"{len(frames.lines)} frames, not {count}")
    for kind, shape, kind_of in [("depth", (HEIGHT, WIDTH), "float32"), ("normal", (HEIGHT, WIDTH, 3), "float32"),
                                 ("part", (HEIGHT, WIDTH), "uint16"), ("flow", (HEIGHT, WIDTH, 2), "float32")]:
        layer = frames.layer(kind, 0)
        expect(layer.shape == shape and layer.dtype == kind_of, f"{kind} is {layer.shape} of {layer.dtype}")
    seen = frames.layer("part", 0) > 0
    expect(0.5 < seen.mean() < 0.7, f"a circle in a picture 4 to 3 covers 0.59 of it, got {seen.mean()}")
    expect((numpy.isnan(frames.layer("depth", 0)) == ~seen).all(), "depth and parts do not agree on what is seen")
    expect(not seen[0, 0] and seen[HEIGHT // 2, WIDTH // 2], "the circle is not where it should be")
    length = numpy.linalg.norm(frames.layer("normal", 0)[seen], axis=-1)
    expect(abs(length - 1).max() < 1e-3, "normals are not of unit length")


def check_flow_of_walls(frames):
    """What does not move must flow as depth and the two cameras say."""
    last = len(frames.lines) - 1
    moved = 0
    for i in range(1, last + 1):
        still = (frames.layer("part", i) == frames.part("cavity"))
        flow = frames.layer("flow", i)[still]
        column, row = pixels()
        there = to_pixels(frames.camera(i - 1), to_world(frames.camera(i), frames.layer("depth", i)))
        want = numpy.stack([there[0] - column, there[1] - row], -1)[still]
        off = abs(want - flow).max(axis=-1)
        # Depth is that of a texel whose middle is up to 0.7 px from the pixel's; what passes close to the lens goes far.
        expect(numpy.percentile(off, 99) < max(0.8, 0.005 * abs(flow).max()), f"frame {i}: flow is off by {numpy.percentile(off, 99)} px")
        moved = max(moved, abs(flow).max())
    expect(moved > 3, "the camera did not move: nothing was tested")


def check_two_eyes(left, right):
    """What the left eye sees must be in the right eye's picture, as deep, where the cameras say."""
    depth = left.layer("depth", 0)
    world = to_world(left.camera(0), depth)
    column, row = to_pixels(right.camera(0), world)
    inside = (left.layer("part", 0) > 0) & (column > 0) & (column < WIDTH - 1) & (row > 0) & (row < HEIGHT - 1)
    other = right.layer("depth", 0)[row[inside].round().astype(int), column[inside].round().astype(int)]
    agree = numpy.nanmean(abs(other - depth[inside]) < 1e-3)
    expect(agree > 0.85, f"only {agree} of the left eye's points are where the right eye sees them")
    base = numpy.array(right.camera(0)["to_world"])[:3, 3] - numpy.array(left.camera(0)["to_world"])[:3, 3]
    expect(abs(numpy.linalg.norm(base) - 0.004) < 1e-6, "the eyes are not 4 mm apart")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        data, recording = os.path.join(folder, "data"), os.path.join(folder, "a.rec")
        demo = ["train", "gynaecology/sterilisation", "--input", "demo", "--headless", "--no-store", "--seconds", 3,
                "--size", f"{WIDTH}x{HEIGHT}"]
        done = run(program, *demo, "--record", recording, "--data", data, "--data-rate", 4)
        expect(done.returncode in (0, 1), done.stderr)
        frames = Frames(data)
        check_shapes(frames, 13)
        check_flow_of_walls(frames)

        again = os.path.join(folder, "again")
        done = run(program, "replay", recording, "--data", again, "--data-rate", 4, "--size", f"{WIDTH}x{HEIGHT}")
        expect(done.returncode == 0, done.stderr)
        same = Frames(again)
        expect(len(same.lines) == 13, "the replay gives other frames")
        for kind in ("depth", "part"):
            expect(numpy.array_equal(frames.layer(kind, 12), same.layer(kind, 12), equal_nan=kind == "depth"),
                   f"{kind} of the replay differs")

        both = os.path.join(folder, "both")
        done = run(program, "replay", recording, "--data", both, "--from", 2, "--to", 2.4, "--stereo", "side-by-side",
                   "--size", f"{WIDTH}x{HEIGHT}")
        expect(done.returncode == 0, done.stderr)
        check_two_eyes(Frames(both, "left"), Frames(both, "right"))

        done = run(program, "replay", recording, "--data", again)
        expect(done.returncode == 2 and "frames.jsonl" in done.stderr, "frames were written over")
        done = run(program, "replay", recording, "--data", os.path.join(folder, "c"), "--data-rate", "0")
        expect(done.returncode == 2 and "--data-rate" in done.stderr, "a rate of 0 was taken")
    print("passed")


main()
