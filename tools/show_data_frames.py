#!/usr/bin/env python3
"""A sheet of one frame of `trocar ... --data FOLDER`: picture, depth, normals, parts, flow, and the difference to the
picture before as the flow warps it (docs/guides/data_frames.md). Needs Debian's python3-numpy and python3-pil.

    tools/show_data_frames.py FOLDER 000012 OUT.png
"""
import json
import os
import sys

import numpy
from PIL import Image


def colours_of_parts(part):
    palette = numpy.random.RandomState(5).randint(50, 250, (part.max() + 1, 3))
    palette[0] = 0
    return palette[part]


def colours_of_flow(flow):
    """Hue: which way; saturation: how far, against the farthest 2 %."""
    far = numpy.hypot(flow[..., 0], flow[..., 1])
    most = max(numpy.nanpercentile(far, 98), 1e-3)
    hue = (numpy.arctan2(flow[..., 1], flow[..., 0]) / (2 * numpy.pi)) % 1.0
    hsv = numpy.stack([hue, numpy.clip(far / most, 0, 1), numpy.ones_like(hue)], -1)
    hsv[numpy.isnan(far)] = 0
    return numpy.array(Image.fromarray((255 * hsv).astype(numpy.uint8), "HSV").convert("RGB"))


def warped(picture, flow):
    """The picture before, at each pixel what the flow leads to; bilinear."""
    rows, columns = flow.shape[:2]
    row, column = numpy.mgrid[0:rows, 0:columns]
    x = numpy.clip(column + flow[..., 0], 0, columns - 1.001)
    y = numpy.clip(row + flow[..., 1], 0, rows - 1.001)
    i, j = x.astype(int), y.astype(int)
    a, b = (x - i)[..., None], (y - j)[..., None]
    return ((1 - a) * (1 - b) * picture[j, i] + a * (1 - b) * picture[j, i + 1] + (1 - a) * b * picture[j + 1, i]
            + a * b * picture[j + 1, i + 1])


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    folder, name, out = sys.argv[1:]
    with open(os.path.join(folder, "frames.jsonl")) as f:
        names = [json.loads(line)["frame"] for line in f]
    before = names[max(names.index(name) - 1, 0)]

    def layer(kind):
        return numpy.load(os.path.join(folder, kind, name + ".npy"))

    def picture(which):
        return numpy.array(Image.open(os.path.join(folder, "picture", which + ".png"))).astype(float)

    depth, part, flow = layer("depth"), layer("part"), layer("flow")
    now, was = picture(name), picture(before)
    shown = numpy.nan_to_num(1 - depth / numpy.nanpercentile(depth, 99)).clip(0, 1)
    known = (part > 0) & ~numpy.isnan(flow[..., 0])
    off = numpy.where(known[..., None], now - warped(was, numpy.nan_to_num(flow)), 0)
    print(f"difference to the picture before: {abs(now - was)[known].mean():.2f} of 255, warped by the flow: "
          f"{abs(off)[known].mean():.2f} (median {numpy.median(abs(off)[known]):.2f})")
    tiles = [now, numpy.repeat(255 * shown[..., None], 3, 2), numpy.nan_to_num(127.5 * layer("normal") + 127.5),
             colours_of_parts(part), colours_of_flow(flow), 128 + 2 * off]
    sheet = numpy.concatenate([numpy.concatenate(tiles[0:3], 1), numpy.concatenate(tiles[3:6], 1)], 0)
    Image.fromarray(sheet.clip(0, 255).astype(numpy.uint8)).save(out)


main()
