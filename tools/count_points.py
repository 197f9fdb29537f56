#!/usr/bin/env python3
"""How often one physical idea is written: material points, bundles of all bodies, files that name kinds of bodies.

    tools/count_points.py [ROOT] [--list]     exit 1 where there is more of something than MOST allows

points    structs of src with a member that names a body and one that names a place of it (node, vertex, cell,
          triangle, element, arc length), but for EXCEPTIONS. One is MaterialPoint; the others are listed
bundles   structs of src with spans or vectors of three or more kinds of bodies, beside Model, State and Work
crowds    files of src and app that name the containers of three or more kinds of bodies
MOST only ever falls.
"""
import re
import sys
from pathlib import Path

MOST = {"points": 3, "bundles": 0, "crowds": 28}

# Why it is no material point.
EXCEPTIONS = {
    "BagSkin": "contact cache: the vertex of an organ or a wall where the search for the nearest one begins",
    "Cut": "record of what blades did to a strand, an organ or a fold: nothing rides on it",
    "FlowSite": "a site of the graph of blood flow, which is no body",
    "Scar": "a spring of a network, or all springs of a cell",
}

BODY = re.compile(r"^\s*(BodyId|std::int32_t|int|std::size_t|size_t)\s+[\w, =\-\d]*\b"
                  r"(body|organ|strand|membrane|surface|solid|index|rod|of)\b[^()]*;", re.M)
PLACE = re.compile(r"^\s*(?:std::(?:int32_t|size_t|array<[^;]*>)|int|size_t|double|float|StrandPlace|"
                   r"interactions::StrandPlace)\s+[\w, =\-\d{}\[\]]*\b"
                   r"(node|vertex|cell|triangle|element|lobule|spring|place|arc|face|s)\b[^()]*;", re.M)
KINDS = {
    "lattices": r"\.solids\b", "tetrahedra": r"\.cuttables\b", "rods": r"\.(?:strands|strand_bodies)\b",
    "membranes": r"\.membranes\b", "fat": r"\.fat\b", "rigid": r"part_of<(?:interactions::)?Rigid>",
    "bags": r"part_of<(?:interactions::)?Bag>", "sutures": r"part_of<(?:interactions::)?Suture>",
}
SPANS = {
    "rods": r"(?:StrandBody|StrandState|StrandLoads|StrandAnatomy)\b", "organs": r"(?:Surface|SolidModel|CuttableOrgan|OrganWork)\b",
    "membranes": r"(?:SheetView|MembraneBody|MembraneState|MembraneBodyWork)\b", "fat": r"FatBody\b",
}
STRUCT = re.compile(r"^(?:struct|class)\s+(\w+)[^;{]*\{(.*?)^\};", re.S | re.M)


def structs(root):
    for path in sorted(root.glob("src/trocar/**/*.hpp")):
        for m in STRUCT.finditer(path.read_text()):
            body = re.sub(r"^  template <class S, class V>.*?^  \}\n", "", m.group(2), flags=re.S | re.M)
            yield path.relative_to(root), m.group(1), re.sub(r"//[^\n]*", "", body)


def points(root):
    rooms = ("interactions", "sim", "suture", "tissue", "vessels", "fluids")
    return [f"{path}: {name}" for path, name, body in structs(root)
            if path.parts[2] in rooms and name not in EXCEPTIONS and BODY.search(body) and PLACE.search(body)]


def bundles(root):
    found = []
    for path, name, body in structs(root):
        kinds = [k for k, p in SPANS.items()
                 if re.search(r"(?:span|vector)<(?:const )?(?:std::vector<)?(?:interactions::|tissue::|sim::)?" + p, body)]
        if len(kinds) >= 3 and name not in ("BodyModels", "BodyStates", "BodyWork"):
            found.append(f"{path}: {name} ({', '.join(kinds)})")
    return found


def crowds(root):
    found = []
    for path in sorted([*root.glob("src/**/*.[ch]pp"), *root.glob("app/**/*.[ch]pp")]):
        text = re.sub(r"//[^\n]*", "", path.read_text())
        kinds = [k for k, p in KINDS.items() if re.search(p, text)]
        if len(kinds) >= 3:
            found.append(f"{path.relative_to(root)}: {', '.join(kinds)}")
    return found


def main():
    args = [a for a in sys.argv[1:] if not a.startswith("--")]
    root = Path(args[0]) if args else Path(__file__).resolve().parent.parent
    bad = False
    for what, find in (("points", points), ("bundles", bundles), ("crowds", crowds)):
        all_found = find(root)
        print(f"{what}: {len(all_found)}, at most {MOST[what]}")
        if "--list" in sys.argv:
            print("".join(f"  {line}\n" for line in all_found), end="")
        bad = bad or len(all_found) > MOST[what]
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
