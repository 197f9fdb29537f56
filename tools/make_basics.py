#!/usr/bin/env python3
"""Writes the scenes of the basic skills: what stands in a box trainer, from a few figures.

    tools/make_basics.py            # scenes/organs/box_*.json and scenes/box_*/scene.json
    tools/make_basics.py --check    # exit 1 where a file differs from what this writes

A box trainer of 200 x 200 x 150 mm (our estimate). Its frame is the scene's: x to the right of who stands in front of it, y
away from them, z up; the endoscope comes through the lid at the origin. Pegs, niches and vessels stand on a board or
a pad. Everything is in mm here as in the files.
"""
import json
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent / "scenes"
PORT = (0.0, 0.0, 0.0)
ANGLE = math.radians(30)  # of the oblique scope
STAND = 50.0              # from the lens to a target: the middle of 40 to 60 mm


def add(a, b, k=1.0): return tuple(x + k * y for x, y in zip(a, b))
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def unit(a): n = math.sqrt(dot(a, a)); return tuple(x / n for x in a)
def scaled(k, a): return tuple(k * x for x in a)
def rounded(a, digits=2): return [round(x, digits) + 0.0 for x in a]


def beside(n):
    """Two unit vectors across n."""
    u = unit(cross((0, 0, 1) if abs(n[2]) < 0.9 else (0, 1, 0), n))
    return u, cross(n, u)


def turned(v, axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return add(add(scaled(c, v), cross(axis, v), s), axis, dot(axis, v) * (1 - c))


def revolved(name, look, foot, n, profile, edge, columns=12):
    """A wall around the line from `foot` along `n`: rows of (radius, height), outside first, then over the rim and in."""
    u, v = beside(n)
    rows = []
    for r, h in profile:
        ring = []
        # A clamped spline of the third degree runs through its ends only: the seam is the middle of two corners.
        corner = r / math.cos(math.pi / columns) * 1.06
        angles = [-2 * math.pi * (k + 0.5) / columns for k in range(columns)]
        points = [(corner * math.cos(a), corner * math.sin(a)) for a in angles]
        seam = tuple(0.5 * (points[0][i] + points[-1][i]) for i in (0, 1))
        for x, y in [seam] + points + [seam]:
            ring.append(rounded(add(add(add(foot, n, h), u, x), v, y)))
        rows.append(ring)
    return {"name": name, "look": look, "net_mm": rows, "edge_mm": edge}


def flat(name, look, corner, along, up, edge):
    """A plane from a corner; its free side is up x along."""
    rows = [[rounded(add(add(corner, up, j), along, i)) for i in (0, 1)] for j in (0, 1)]
    return {"name": name, "look": look, "net_mm": rows, "edge_mm": edge}


# ---- the box

FRONT, BACK, SIDE, FLOOR, LID = -30.0, 178.0, 105.0, -140.0, 12.0
SLOPE = [(FRONT, FLOOR), (10, FLOOR), (32, FLOOR), (150, -58), (168, -46), (BACK, -30), (BACK, LID)]


def swept(name, look, line, edge):
    """The board: a line of (y, z) drawn across the box."""
    rows, steps = [], []
    for (y0, z0), (y1, z1) in zip(line, line[1:]):  # many points on a straight stretch, or the spline would cut corners
        n = max(1, round(math.dist((y0, z0), (y1, z1)) / 14))
        steps += [(y0 + (y1 - y0) * k / n, z0 + (z1 - z0) * k / n) for k in range(n)]
    for y, z in steps + [line[-1]]:
        rows.append([rounded((x, y, z)) for x in (SIDE, SIDE / 3, -SIDE / 3, -SIDE)])
    return {"name": name, "look": look, "net_mm": rows, "edge_mm": edge}


def height(line, y):
    for (y0, z0), (y1, z1) in zip(line, line[1:]):
        if y0 <= y <= y1 and y1 > y0:
            return z0 + (z1 - z0) * (y - y0) / (y1 - y0)
    raise ValueError(y)


def sides():
    high = LID - FLOOR
    return [
        flat("box_left", "board", (-SIDE, BACK, FLOOR), (0, FRONT - BACK, 0), (0, 0, high), 12),
        flat("box_right", "board", (SIDE, FRONT, FLOOR), (0, BACK - FRONT, 0), (0, 0, high), 12),
        flat("box_front", "board", (-SIDE, FRONT, FLOOR), (2 * SIDE, 0, 0), (0, 0, high), 12),
    ]


def board(line): return [swept("board", "board", line, 6)] + sides()


# ---- camera, 0 degrees: pegs with a disc on top, turned by up to 30 degrees off the line to the trocar

PEGS = [  # x, y, lean off the line of sight, towards which side of it [degrees]
    (-62, 58, 28, 200), (-18, 50, 12, 90), (26, 62, 30, 330), (68, 54, 22, 30), (-44, 92, 18, 280),
    (2, 98, 26, 120), (48, 96, 10, 0), (-66, 128, 24, 60), (-12, 134, 30, 180), (42, 132, 20, 250),
]


def pegs():
    walls, marks = [], []
    for i, (x, y, lean, towards) in enumerate(PEGS, 1):
        ground = (x, y, height(SLOPE, y))
        sight = unit(scaled(-1, ground))
        for _ in range(20):  # sight: from the disc, which lies where the peg's axis says
            u, v = beside(sight)
            axis = add(scaled(math.cos(math.radians(towards)), u), v, math.sin(math.radians(towards)))
            n = turned(sight, axis, math.radians(lean))
            sight = unit(scaled(-1, add(ground, n, 16.8)))
        profile = [(5.6, -8), (5.2, 4), (4.7, 12), (4.6, 16.2), (4.1, 16.8), (3.2, 16.8), (1.6, 16.8), (0.02, 16.8)]
        walls.append(revolved(f"peg_{i}", "plastic", ground, n, profile, 2.0))
        marks.append({"name": f"target_{i}", "on": f"peg_{i}", "place_mm": rounded(add(ground, n, 16.8)),
                      "normal": rounded(n, 4), "diameter_mm": 5, "label": str(i), "colour": "yellow"})
    return walls, marks


# ---- camera, 30 degrees: tubes with a disc at the bottom that the lens can look into with one turn of the light post

NICHES = [  # x, y of the disc, turn of the light post with which one looks straight in [degrees]
    (-64, 62, 40), (-20, 54, -150), (24, 60, 100), (66, 56, -60), (-46, 94, 160),
    (0, 98, -20), (46, 92, -110), (-66, 126, 70), (-14, 130, 130), (40, 128, -35),
]


def shaft_frame(a):
    """Opening direction and jaw normal of a shaft along a, at roll 0 (kinematics/fulcrum.hpp)."""
    pitch = math.asin(max(-1, min(1, a[1])))
    yaw = math.atan2(-a[0], -a[2])
    cy, sy, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    return (cy, 0, -sy), (sy * sp, cp, cy * sp)


def straight_into(disc, post):
    """Where the lens stands and which way it looks so that it is STAND from the disc and sees it in the middle."""
    forward = unit(disc)
    for _ in range(200):
        eye = add(disc, forward, -STAND)
        a = unit(eye)
        opening, normal = shaft_frame(a)
        side = add(scaled(math.cos(post), normal), opening, math.sin(post))
        forward = unit(add(scaled(math.cos(ANGLE), a), side, math.sin(ANGLE)))
    return eye, forward


def niches():
    walls, marks = [], []
    for i, (x, y, post) in enumerate(NICHES, 1):
        disc = (x, y, height(SLOPE, y) + 9)
        _, forward = straight_into(disc, math.radians(post))
        n = scaled(-1, forward)
        deep = 14.0
        profile = [(6.8, -16), (6.7, 2), (6.6, deep - 1), (6.5, deep + 0.5), (5.8, deep + 1.0), (5.1, deep + 0.5),
                   (5.0, deep - 1), (5.0, 5), (5.0, 1.2), (4.6, 0), (3.2, 0), (1.6, 0), (0.02, 0)]
        walls.append(revolved(f"niche_wall_{i}", "plastic", disc, n, profile, 1.8))
        marks.append({"name": f"niche_{i}", "on": f"niche_wall_{i}", "place_mm": rounded(disc),
                      "normal": rounded(n, 4), "diameter_mm": 5, "label": str(i), "colour": "yellow"})
        beside_it = (x + 12 * (1 if n[0] < 0 else -1), y)
        marks.append({"name": f"tag_{i}", "on": "board", "diameter_mm": 7, "label": str(i),
                      "place_mm": rounded((*beside_it, height(SLOPE, beside_it[1])))})
    return walls, marks


# ---- clip application: vessels that come out of a pad and go into it again, with a mark in the middle

PAD = [(FRONT, FLOOR), (0, FLOOR), (18, FLOOR), (40, -122), (60, -112), (150, -104), (168, -100), (BACK, -60),
       (BACK, LID)]
APPLIER, GRASPER = (48.0, 0.0, 0.0), (-48.0, 0.0, 0.0)
VESSELS = [  # x, y of the mark, outer diameter, turned off square to the applier [degrees], rise over the pad
    (-30, 70, 3.0, 4, 10.5), (10, 60, 4.0, -5, 11), (50, 72, 2.5, 5, 10), (-30, 94, 5.0, -4, 12), (10, 82, 2.0, 3, 10),
    (50, 96, 4.5, -3, 11.5), (-30, 118, 2.0, -5, 10), (10, 104, 3.5, 4, 11), (50, 120, 3.0, 2, 10.5),
    (10, 126, 5.0, -2, 12),
]


def vessels():
    strands, marks = [], []
    for i, (x, y, wide, off, rise) in enumerate(VESSELS, 1):
        ground = (x, y, height(PAD, y))
        top = add(ground, (0, 0, rise))
        shaft = unit(add(top, APPLIER, -1))
        square = math.atan2(-shaft[0], shaft[1])  # shaft . (cos, sin, 0) = 0
        t = (math.cos(square + math.radians(off)), math.sin(square + math.radians(off)), 0)
        line = [(-21, -7), (-17.5, 0), (-12.5, rise - 2.2), (-6, rise - 0.15), (0, rise), (6, rise - 0.15),
                (12.5, rise - 2.2), (17.5, 0), (21, -7)]
        points = [rounded((x + s * t[0], y + s * t[1], height(PAD, y + s * t[1]) * 0.5 + ground[2] * 0.5 + z))
                  for s, z in line]
        half = 0
        for a, b in zip(points[:4], points[1:5]):
            half += math.dist(a, b)
        strands.append({
            "name": f"vessel_{i}", "tissue": "silicone_vessel", "look": "silicone_vessel", "centreline_mm": points,
            "stations": [{"s_mm": 0, "radius_mm": wide / 2, "lumen_mm": round(wide / 4, 3)}],
            "start": {"fixed": True}, "end": {"fixed": True}, "spacing_mm": 3.0,  # nearer than it is thick, a single element would turn between the jaws
            "foundation_N_m2": 400, "foundation_limit_mm": 20})
        marks.append({"name": f"mark_{i}", "on": f"vessel_{i}", "at_mm": round(half, 1), "width_mm": 1,
                      "colour": "black"})
        beside_it = (x - 20 * t[0] - 6 * t[1], y - 20 * t[1] + 6 * t[0])
        marks.append({"name": f"tag_{i}", "on": "pad", "diameter_mm": 6, "label": str(i),
                      "place_mm": rounded((*beside_it, height(PAD, beside_it[1])))})
    return strands, marks


# ---- files

HEAD = "// Written by tools/make_basics.py, which holds the figures.\n"


def organ(name, **parts): return {"$schema": "../schema/organ.schema.json", "format": 1, "name": name, **parts}


def scene(name, title, organs, marks, scope, ports, tools=(), instruments=(), tissues=()):
    return {"$schema": "../schema/scene.schema.json", "format": 1, "name": name, "title": title,
            "gravity_m_s2": [0, 0, -9.81], "tissues": list(tissues), "organs": [f"../organs/{o}.json" for o in organs],
            "marks": marks, "instruments": [f"../instruments/{i}.json" for i in instruments],
            "ports": [{"name": "middle", "position_mm": list(PORT), "diameter_mm": 10}] + list(ports),
            "tools": list(tools), "scope": scope}


def scope(tip, angle):
    return {"port": "middle", "tip_mm": tip, "angle_deg": angle, "field_of_view_deg": 70, "shaft_diameter_mm": 10,
            "shaft_length_mm": 310}


def files():
    peg_walls, peg_marks = pegs()
    niche_walls, niche_marks = niches()
    strands, clip_marks = vessels()
    silicone = {"name": "silicone_vessel", "density_kg_m3": 1080, "young_Pa": 250000, "strain_cap": 0.3,
                "damping_ms": 4, "source": "our estimate: soft silicone"}
    yield "organs/box_pegs.json", organ("box_pegs", walls=board(SLOPE) + peg_walls)
    yield "organs/box_niches.json", organ("box_niches", walls=board(SLOPE) + niche_walls)
    yield "organs/box_vessels.json", organ("box_vessels", strands=strands, walls=[
        swept("pad", "silicone_pad", PAD, 6)] + sides())
    yield "box_pegs/scene.json", scene(
        "box_pegs", "Box trainer: pegs", ["box_pegs"], peg_marks, scope([0, 13, -14], 0), [])
    yield "box_niches/scene.json", scene(
        "box_niches", "Box trainer: niches", ["box_niches"], niche_marks, scope([0, 13, -14], 30), [])
    yield "box_vessels/scene.json", scene(
        "box_vessels", "Box trainer: vessels for clips", ["box_vessels"], clip_marks, scope([4, 26, -27], 0),
        [{"name": "right", "position_mm": list(APPLIER), "diameter_mm": 10},
         {"name": "left", "position_mm": list(GRASPER), "diameter_mm": 5}],
        [{"instrument": "grasper", "port": "left", "tip_mm": [-22, 70, -72]},
         {"instrument": "clip_applier", "port": "right", "tip_mm": [36, 64, -66]}],
        ["grasper", "clip_applier"], [silicone])


def text(value, depth=0):
    """JSON with short lists on one line."""
    one = json.dumps(value)
    if len(one) + 2 * depth <= 116:
        return one.replace('{"', '{"')
    pad, inner = "  " * depth, "  " * (depth + 1)
    if isinstance(value, dict):
        return "{\n" + ",\n".join(f"{inner}{json.dumps(k)}: {text(v, depth + 1)}" for k, v in value.items()) + f"\n{pad}}}"
    if isinstance(value, list) and all(not isinstance(v, dict) for v in value) and len(json.dumps(value[0])) < 60:
        lines, line = [], ""
        for v in value:
            item = json.dumps(v)
            if line and len(inner) + len(line) + len(item) > 116:
                lines.append(line)
                line = ""
            line += (", " if line else "") + item
        return "[\n" + ",\n".join(inner + l for l in lines + [line]) + f"\n{pad}]"
    return "[\n" + ",\n".join(inner + text(v, depth + 1) for v in value) + f"\n{pad}]"


def main():
    stale = []
    for name, value in files():
        path, wanted = ROOT / name, HEAD + text(value) + "\n"
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
