#!/usr/bin/env python3
"""A test executable without a case, or a module without a test executable, would pass silently: this fails for it.

    tools/check_tests.py --modules NAME... --executables PATH...      paths end in /NAME_test or /NAME_soak
"""
import argparse
import subprocess
import sys
from pathlib import Path


def cases(executable):
    """How many cases a GoogleTest executable lists: indented lines, the disabled ones not counted."""
    listing = subprocess.run([executable, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    count, suite_off = 0, False
    for line in listing.splitlines():
        if not line.startswith(" "):
            suite_off = line.startswith("DISABLED_")
        elif line.strip() and not suite_off and not line.strip().startswith("DISABLED_"):
            count += 1
    return count


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--modules", nargs="*", default=[])
    parser.add_argument("--executables", nargs="*", default=[])
    args = parser.parse_args()
    found, total = [], 0
    for executable in args.executables:
        count = cases(executable)
        total += count
        if count == 0:
            found.append(f"{executable} contains no test")
    names = {Path(e).name.rsplit("_", 1)[0] for e in args.executables}  # "sim", or of a room: "suture_thread"
    tested = names | {name.split("_", 1)[0] for name in names}
    found += [f"module {m} has sources but no tests/{m}/*_test.cpp" for m in args.modules if m not in tested]
    print("\n".join(found) if found else f"{total} cases in {len(args.executables)} executables")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
