#!/usr/bin/env python3
"""Looks into the machine code of what the step is made of: no fused multiply-add, no reciprocal estimate, no libm,
and no inline function of a wide kernel (network_avx2.cpp) that the linker could give to files for any processor.

    tools/check_step_object_code.py LIBRARY.a...                     what a build has made
    tools/check_step_object_code.py --recompile BUILD --march M      the same sources, compiled again for a processor
          [--root ROOT]                                              that has such instructions (the baseline has none)

Exit 0 clean, 1 with one line a fault, 3 when objdump or nm (Debian: binutils) is missing.
"""
import argparse
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

# The folders whose results must be the same bits everywhere: the step's, and the scene compiler's.
STEP = ["numerics", "geometry", "tissue", "kinematics", "vessels", "fluids", "suture", "collision", "interactions",
        "sim", "scene"]

# x86: vfmadd213ss and kin, AMD's vfmaddss; rcpps, rsqrtss, vrcp14ps, vrsqrt28sd, vrcpph. Arm: fmadd, fmla, frecpe, ...
INSTRUCTION = re.compile(
    r"^(vfn?m(add|sub)\w*|v?rcp(14|28)?[psh][sdh]|v?rsqrt(14|28)?[psh][sdh]"
    r"|fn?m(add|sub)|fml[as]l?2?|frecp[esx]|frsqrt[es])$")
LIBM = set("sin cos tan sincos asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 exp10 expm1 "
           "log log2 log10 log1p pow cbrt hypot erf erfc tgamma lgamma fma".split())
# A file compiled for a wider instruction set than the rest says so in its name: network_avx2.cpp.
WIDE = re.compile(r"(^|[_.-])(avx\d*\w*|sse\d\w*|neon|sve)([_.-]|$)")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def is_libm(symbol):
    """Compilers call sin also sinf, sinl, sin@GLIBC_2.2, __sin_finite."""
    name = symbol.split("@")[0].removeprefix("__").removesuffix("_finite")
    return name in LIBM or (name[-1:] in ("f", "l") and name[:-1] in LIBM)


def look(path):
    """Faults in one object file or archive, and the number of instructions seen."""
    found, seen, where, member = set(), 0, "?", path.name
    for line in run("objdump", "-d", "--no-show-raw-insn", "-C", str(path)).splitlines():
        if line.endswith(">:"):
            where = line[line.index("<") + 1:-2]
        elif "file format" in line:
            member = line.split(":")[0]
        elif line.startswith(" "):
            words = line.split(":", 1)[-1].split()
            if words:
                seen += 1
                if INSTRUCTION.match(words[0]):
                    found.add(f"{member}: {words[0]} in {where}")
    for line in run("nm", "-A", "-C", "--defined-only", str(path)).splitlines():
        place, kind, name = re.match(r"(.*?):[0-9a-f ]*([A-Za-z]) (.*)", line).groups()
        if kind == "W" and WIDE.search(place.split(":")[-1]):
            found.add(f"{place.split(':')[-1]}: {name} is shared with other files: the linker may keep the wide one")
    for line in run("nm", "-u", "-A", str(path)).splitlines():
        if is_libm(line.split()[-1]):
            found.add(f"{':'.join(line.split()[0].split(':')[1:]) or member} calls {line.split()[-1]} of the C library")
    return sorted(found), seen


def recompiled(build, root, march, folder):
    """Object files of the step's sources for processor `march`, made by the build's own commands."""
    jobs = []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = Path(entry["directory"], entry["file"]).resolve()
        if not any(source.is_relative_to(root / "src" / "trocar" / name) for name in STEP):
            continue
        command = [w for w in shlex.split(entry["command"]) if not w.startswith(("-march=", "-fsanitize"))]
        target = folder / f"{len(jobs)}-{source.stem}.o"
        command[command.index("-o") + 1] = str(target)
        jobs.append((command + [f"-march={march}"], entry["directory"], target))

    def make(job):
        subprocess.run(job[0], cwd=job[1], check=True)
        return job[2]

    with ThreadPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        return list(pool.map(make, jobs))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--recompile", type=Path)
    parser.add_argument("--march", default="x86-64-v3")
    parser.add_argument("--root", type=Path, default=Path(__file__).parent.parent)
    args = parser.parse_args()
    for tool in ("objdump", "nm"):
        if not shutil.which(tool):
            print(f"{tool} is missing: apt-get install binutils")
            return 3
    found, seen = [], 0
    with tempfile.TemporaryDirectory() as folder:
        files = list(args.files)
        if args.recompile:
            files += recompiled(args.recompile.resolve(), args.root.resolve(), args.march, Path(folder))
        for path in files:
            faults, instructions = look(path)
            found += faults
            seen += instructions
    if seen == 0:
        found.append("no machine code to look at")
    fine = f"{len(files)} files, {seen} instructions: none fused, none estimated, no libm"
    print("\n".join(found) if found else fine)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
