#!/usr/bin/env python3
"""Who may include whom, and what the step may call: the layer law and the determinism law, as far as text shows them.

    tools/check_layers.py [ROOT]      ROOT: a checkout (default: this one). Exit 0 clean, 1 with one line a fault.

Three tables say it all: ALLOWED (folders), FOREIGN (libraries), FORBIDDEN (constructs in folders whose results must
be the same bits everywhere). Rooms within a folder (tissue/heat) may include each other as long as there is no circle
between them, which is found, not listed; and no room holds more than MOST_FILES. An exception is one line in EXCEPTIONS with its reason; one that is no longer needed is
itself a fault, so the list cannot rot.
"""
import re
import sys
from pathlib import Path

CORE = ["core"]
NUMERICS = CORE + ["numerics"]
GEOMETRY = NUMERICS + ["geometry"]
BODIES = ["tissue", "kinematics", "vessels", "fluids", "suture", "collision"]
SIM_BELOW = GEOMETRY + BODIES + ["interactions"]

# folder -> what its files may include from <trocar/...>, besides itself
ALLOWED = {
    "core": [],
    "numerics": CORE,
    "geometry": NUMERICS,
    "volumes": GEOMETRY,  # scans are not part of the step: no line of the laws of determinism
    **{body: GEOMETRY for body in BODIES},  # never each other: two bodies meet in interactions
    "interactions": GEOMETRY + BODIES,
    "sim": SIM_BELOW,
    "scene": SIM_BELOW + ["sim"],
    "studies": GEOMETRY + ["kinematics", "collision", "scene"],
    "training": SIM_BELOW + ["sim", "scene"],
    "devices": NUMERICS,
    "attempt": SIM_BELOW + ["sim", "scene", "training", "devices"],  # no window: tests/attempt looks at what it links
    "render": GEOMETRY,
    "view": SIM_BELOW + ["sim", "render"],
    "pictures": SIM_BELOW + ["sim", "scene", "training", "devices", "attempt", "render", "view"],
    "reports": SIM_BELOW + ["sim", "scene", "training", "devices", "attempt", "render", "view", "pictures",
                          "studies"],
    "modeller": SIM_BELOW + ["sim", "scene", "render", "view", "volumes"],
}
APP_MAY = sorted(set(ALLOWED))
MOST_FILES = 40  # in one room

# What a header from outside looks like -> the folders ("app" is one of them) that may include it
FOREIGN = [
    (re.compile(r"^(GL|GLES\d*|EGL|KHR|GLFW|epoxy|X11)/"), ["render", "app"]),
    (re.compile(r"^(imgui|backends/imgui|implot)"), ["render", "pictures", "modeller", "app"]),
    (re.compile(r"^(stb/)?stb_"), ["render", "pictures", "app"]),
    (re.compile(r"^nlohmann/"), ["core", "scene", "training", "app"]),
    (re.compile(r"^CLI/"), ["app"]),
    (re.compile(r"^sqlite3\.h"), ["training"]),
    (re.compile(r"^sodium\.h"), ["attempt"]),
    (re.compile(r"^zlib\.h"), ["geometry", "volumes"]),
    (re.compile(r"^gdcm"), ["volumes"]),
    (re.compile(r"^(Eigen|suitesparse)/|^(cholmod|umfpack)\.h"), ["numerics", "studies", "app"]),
    (re.compile(r"^mpi\.h"), ["app"]),
    (re.compile(r"^(xxhash\.h|spdlog/)"), ["core", "app"]),
]

STEP = NUMERICS[1:] + ["geometry"] + BODIES + ["interactions", "sim"]
DETERMINISTIC = STEP + ["scene", "studies", "training"]  # the scene compiler and the demonstration count too

LIBM = ("sin|cos|tan|sincos|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|exp|exp2|expm1|log|log2|log10|log1p"
        "|pow|cbrt|hypot|erf|erfc|tgamma|lgamma|fma|lerp")

# (what is found, in which folders, why it is not allowed)
FORBIDDEN = [
    (rf"\bstd::({LIBM})[fl]?\b(?=\s*[(<])", DETERMINISTIC,
     "differs between C libraries; use trocar::portable"),
    (rf"(?<![\w:.>])(::)?({LIBM})[fl]?\s*\((?=[^)])", DETERMINISTIC,
     "may be libm's; write portable::... or another name"),
    (r"\bstd::(reduce|transform_reduce|inclusive_scan|exclusive_scan|execution::\w+)", DETERMINISTIC,
     "the order of summation is not fixed"),
    (r"\bstd::atomic(_ref)?\s*<\s*(float|double)\b", DETERMINISTIC,
     "the order of additions is not fixed"),
    (r"\bstd::unordered_\w+|#\s*include\s*<unordered_(map|set)>", DETERMINISTIC,
     "iteration order differs between libraries"),
    (r"#\s*include\s*<random>|\bstd::\w+_distribution\b|\bstd::random_device\b|(?<![\w:.])s?rand\s*\(", DETERMINISTIC,
     "differs between libraries; use core::Random"),
    (r"#\s*include\s*<(chrono|ctime|time\.h|sys/time\.h)>", STEP,
     "the step knows ticks, not clocks"),
    (r"#\s*include\s*<(iostream|cstdio|stdio\.h)>", STEP,
     "the step neither prints nor reads"),
    (r"#\s*include\s*<(ranges|format|bit|stop_token|source_location|coroutine)>|\bstd::(jthread|bit_cast|from_chars)\b",
     sorted(ALLOWED), "is missing or incomplete in libc++ 13, which everything below app must compile with"),
]
FORBIDDEN = [(re.compile(pattern), folders, why) for pattern, folders, why in FORBIDDEN]

# (path, text that the faulty line contains) -> why it may stay
EXCEPTIONS = {
    ("src/trocar/sim/recording/recording.hpp", "<cstdio>"): "writes and reads files; the step does not include it",
    ("src/trocar/numerics/portable.hpp", "double "): "declares our own sin, cos, ...: the replacement itself",
    ("src/trocar/numerics/portable.cpp", ""): "defines our own sin, cos, ... and calls them among each other",
}

COMMENT_OR_TEXT = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:<([^>]+)>|"([^"]+)")', re.M)


def blank(match):
    """Spaces in place of a comment or a string, newlines kept, so that line numbers stay."""
    if match.group(0).startswith("'") and len(match.group(0)) > 6:
        return match.group(0)  # digit separators: 1'000'000
    return re.sub(r"[^\n]", " ", match.group(0))


def faults_of(path, folder, text):
    """Yields (line number, message) for one file of `folder`."""
    may = set(APP_MAY if folder == "app" else ALLOWED[folder] + [folder])
    includes = [m for m in INCLUDE.finditer(text)]
    code = COMMENT_OR_TEXT.sub(blank, text)
    for m in includes:
        line = text.count("\n", 0, m.start()) + 1
        if not code[m.start():m.end()].lstrip().startswith("#"):
            continue  # inside a comment
        target, quoted = m.group(1) or m.group(2), m.group(2) is not None
        if target.startswith("trocar/"):
            other = target.split("/")[1]
            if other not in may:
                yield line, f"{folder} may not include {other} (<{target}>)"
            continue
        for pattern, folders in FOREIGN:
            if pattern.search(target):
                if folder not in folders:
                    yield line, f"{target} may be included in {', '.join(folders)} only"
                break
        else:
            local = "/" not in target and target.endswith(".inl")  # a file's second half, in the same folder
            if quoted and folder != "app" and not local:
                yield line, f'write <trocar/...>, not "{target}": the folder must be visible'
    for pattern, folders, why in FORBIDDEN:
        if folder in folders:
            for m in pattern.finditer(code):
                yield code.count("\n", 0, m.start()) + 1, f"{m.group(0).strip()}: {why}"


def room_of(path):
    """The folder of a file below src/ or app/, as its includes write it: trocar/tissue/heat, shell."""
    parts = path.parts[:-1]
    return "/".join(parts[1:] if parts[0] in ("src", "app") else parts) or "."


def circles(graph):
    """Rooms that reach themselves, in sets (Tarjan's strongly connected components of more than one room)."""
    index, low, stack, found = {}, {}, [], []

    def visit(room):
        index[room] = low[room] = len(index)
        stack.append(room)
        for other in sorted(graph.get(room, ())):
            if other not in index:
                visit(other)
                low[room] = min(low[room], low[other])
            elif other in stack:
                low[room] = min(low[room], index[other])
        if low[room] == index[room]:
            at = stack.index(room)
            found.append(stack[at:])
            del stack[at:]

    for room in sorted(graph):
        if room not in index:
            visit(room)
    return [sorted(group) for group in found if len(group) > 1]


def room_faults(root):
    """Yields one line a fault of the rooms: circles, with the includes that close them, and rooms that are too full."""
    graph, witnesses, members = {}, {}, {}
    for path, _ in files_of(root):
        path = path.relative_to(root)
        room = room_of(path)
        members[room] = members.get(room, 0) + 1
        text = (root / path).read_text(encoding="utf-8")
        code = COMMENT_OR_TEXT.sub(blank, text)
        for m in INCLUDE.finditer(text):
            target = m.group(1) or m.group(2)
            if "/" not in target or not code[m.start():m.end()].lstrip().startswith("#"):
                continue
            if not (target.startswith("trocar/") or (m.group(2) and path.parts[0] == "app")):
                continue
            other = target.rsplit("/", 1)[0]
            if other != room:
                graph.setdefault(room, set()).add(other)
                witnesses.setdefault((room, other), f"{path.as_posix()}:{text.count(chr(10), 0, m.start()) + 1}")
    for group in circles(graph):
        edges = [f"{a} -> {b} ({witnesses[a, b]})" for a in group for b in group if (a, b) in witnesses]
        yield f"{group[0]}: rooms include each other in a circle: {'; '.join(edges)}"
    for room, count in sorted(members.items()):
        if count > MOST_FILES:
            yield f"{room}: {count} files in one room, at most {MOST_FILES}"


def files_of(root):
    """Yields (path, folder) for every source file under the law."""
    for path in sorted((root / "src" / "trocar").rglob("*")):
        if path.suffix in (".hpp", ".cpp", ".h", ".inl"):
            yield path, path.relative_to(root / "src" / "trocar").parts[0]
    for path in sorted((root / "app").rglob("*")):
        if path.suffix in (".hpp", ".cpp", ".h"):
            yield path, "app"


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    count, found, used = 0, [], set()
    for path, folder in files_of(root):
        count += 1
        name = path.relative_to(root).as_posix()
        text = path.read_text(encoding="utf-8")
        if folder != "app" and folder not in ALLOWED:
            found.append(f"{name}:1: folder '{folder}' is not in the table of allowed includes")
            continue
        lines = text.splitlines()
        for line, message in sorted(set(faults_of(path, folder, text))):
            key = next((k for k in EXCEPTIONS if k[0] == name and k[1] in lines[line - 1]), None)
            if key:
                used.add(key)
            else:
                found.append(f"{name}:{line}: {message}")
    found += room_faults(root)
    if (root / "tools" / "check_layers.py").resolve() == Path(__file__).resolve():
        found += [f"{k[0]}: the exception for '{k[1]}' is not needed any more" for k in EXCEPTIONS if k not in used]
    if count == 0:
        found.append(f"{root}: no source files found")
    print("\n".join(found) if found else f"{count} files keep the layers")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
