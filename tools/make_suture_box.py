#!/usr/bin/env python3
"""Writes the box trainer's suturing pad: scenes/box_suture/pad.obj, scenes/box_suture/scene.json and, with more thread,
scenes/box_knot/scene.json.

    tools/make_suture_box.py [--check]     --check: says what is stale and writes nothing

A slab of soft silicone lies on a plate, with a slit through it along x, and two marks for each bite. The trocars of both
needle holders lie to the left and to the right, so that shafts come in along the slit and a needle that stands across
its shaft is driven across it. Lengths in millimetres, x to the right, y away from who operates, z up.
"""
import json

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from make_basics import flat, text  # noqa: E402

ROOT = Path(__file__).parent.parent / "scenes"
CENTRE = (0.0, 70.0)
TOP, THICK = -70.0, 7.5
HALF_X, HALF_Y = 30.0, 21.25
SLIT_X, SLIT_Y = 12.5, 1.25  # half of its length and width
EDGE = 2.5
BITE = 7.0  # of each mark from the slit's middle
HEAD = "// Written by tools/make_suture_box.py, which holds the figures.\n"


def pad():
    """The slab's surface: squares of EDGE without those of the slit, top, bottom and all walls."""
    nx, ny, nz = round(2 * HALF_X / EDGE), round(2 * HALF_Y / EDGE), round(THICK / EDGE)
    solid = lambda i, j: (0 <= i < nx and 0 <= j < ny and not (
        abs((i + 0.5) * EDGE - HALF_X) < SLIT_X and abs((j + 0.5) * EDGE - HALF_Y) < SLIT_Y))
    index, points, faces = {}, [], []

    def at(i, j, k):
        if (i, j, k) not in index:
            points.append((CENTRE[0] - HALF_X + i * EDGE, CENTRE[1] - HALF_Y + j * EDGE, TOP - THICK + k * EDGE))
            index[i, j, k] = len(points)
        return index[i, j, k]

    def quad(a, b, c, d):
        faces.extend([(a, b, c), (a, c, d)])

    for i in range(nx):
        for j in range(ny):
            if not solid(i, j):
                continue
            quad(at(i, j, nz), at(i + 1, j, nz), at(i + 1, j + 1, nz), at(i, j + 1, nz))
            quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0))
            for k in range(nz):
                if not solid(i - 1, j):
                    quad(at(i, j, k), at(i, j, k + 1), at(i, j + 1, k + 1), at(i, j + 1, k))
                if not solid(i + 1, j):
                    quad(at(i + 1, j, k), at(i + 1, j + 1, k), at(i + 1, j + 1, k + 1), at(i + 1, j, k + 1))
                if not solid(i, j - 1):
                    quad(at(i, j, k), at(i + 1, j, k), at(i + 1, j, k + 1), at(i, j, k + 1))
                if not solid(i, j + 1):
                    quad(at(i, j + 1, k), at(i, j + 1, k + 1), at(i + 1, j + 1, k + 1), at(i + 1, j + 1, k))
    lines = ["# Written by tools/make_suture_box.py", "o pad"]
    lines += ["v %g %g %g" % p for p in points] + ["f %d %d %d" % f for f in faces]
    return "\n".join(lines) + "\n"


def scene(called, title, surface, thread_mm, thread_line):
    x, y = CENTRE
    anchors = [{"centre_mm": [sx * HALF_X, y + dy, TOP - THICK / 2], "radius_mm": 7}
               for sx in (-1, 1) for dy in (-20, -10, 0, 10, 20)]
    anchors += [{"centre_mm": [dx, y + sy * HALF_Y, TOP - THICK], "radius_mm": 6}
                for dx in (-20, -10, 0, 10, 20) for sy in (-1, 1)]
    walls = [flat("plate", "board", (160.0, -90.0, TOP - THICK - 0.5), (-320.0, 0, 0), (0, 290.0, 0), 10)]
    marks = []
    for i, dx in enumerate((0.0, -7.5, 7.5), 1):
        for name, dy in (("in", BITE), ("out", -BITE)):
            marks.append({"name": f"{name}_{i}", "on": "pad", "diameter_mm": 1, "colour": "black",
                          "place_mm": [x + dx, y + dy, TOP], "normal": [0, 0, 1]})
    return {
        "$schema": "../schema/scene.schema.json", "format": 1, "name": called,
        "title": title, "gravity_m_s2": [0, 0, -9.81],
        "tissues": [{"name": "suture_pad", "density_kg_m3": 1080, "young_Pa": 200000, "strain_cap": 0.3,
                     "damping_ms": 4, "puncture_N": 0.6, "stitch_damage_N": 6, "source": "our estimate: soft silicone",
                     "sources": {"puncture_N": "our estimate: a little less than the 0.7 N of skin"}}],
        "organs": [{"name": "suture_box", "solids": [{
            "name": "pad", "tissue": "suture_pad", "look": "silicone_pad",
            "surface": {"file": surface}, "cell_mm": EDGE, "skin_edge_mm": 2.0, "fine_edge_mm": 1.0,
            "anchors": anchors}], "walls": walls}],
        "marks": marks,
        "variation": {"regions": [{"around": "pad", "near_mm": 60, "far_mm": 110, "shift_mm": 1.5}],
                      "stiffness": 0.2},
        "instruments": ["../instruments/needle_holder.json", "../instruments/grasper.json",
                        "../instruments/scissors.json", "../instruments/clip_applier.json"],
        "ports": [{"name": "middle", "position_mm": [0, 0, 0], "diameter_mm": 10},
                  {"name": "right", "position_mm": [85, 70, 0], "diameter_mm": 10},
                  {"name": "left", "position_mm": [-85, 70, 0], "diameter_mm": 10}],
        "tools": [{"instrument": "needle_holder", "port": "left", "tip_mm": [-30, 70, -45]},
                  {"instrument": "needle_holder", "port": "right", "tip_mm": [25, 78, -48]}],
        "sutures": [{"name": "suture", "size": "3-0", "make": "PDS", "length_mm": thread_mm, "needle": "half_26",
                     "held_by": "right", "grasped": 0.86,
                     "line_mm": [[33, 62, -50], [45, 75, -62], [50, 120, -68], thread_line]}],
        "scope": {"port": "middle", "tip_mm": [0, 26, -24], "angle_deg": 0, "field_of_view_deg": 70,
                  "shaft_diameter_mm": 10, "shaft_length_mm": 310},
    }


def files():
    """Names below scenes/ with what they shall hold. What is tied takes more thread than a stitch alone."""
    stitch = scene("box_suture", "Box trainer: suture pad", "pad.obj", 120, [65, 180, -72])
    knot = scene("box_knot", "Box trainer: suture pad with thread for a knot", "../box_suture/pad.obj", 156,
                 [75, 205, -72])
    return [("box_suture/pad.obj", pad()), ("box_suture/scene.json", HEAD + text(stitch) + "\n"),
            ("box_knot/scene.json", HEAD + text(knot) + "\n")]


def main():
    stale = []
    for name, wanted in files():
        path = ROOT / name
        if path.exists() and path.read_text() == wanted:
            continue
        stale.append(name)
        if "--check" not in sys.argv:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(wanted)
    print("\n".join(stale) if stale else "all as written")
    return 1 if stale and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
