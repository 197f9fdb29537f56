#!/usr/bin/env python3
"""What an executable links, directly or through others: fails where one of WORDS is in the name of a library that it
loads, or of a function that was linked into it.

    tools/check_linked.py EXECUTABLE WORD...      e.g.  attempt_test libGL libglfw ImGui:: alc
"""
import subprocess
import sys


def lines_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def main():
    executable, words = sys.argv[1], sys.argv[2:]
    libraries = [line.split()[0] for line in lines_of("ldd", executable) if line.strip()]
    functions = {line.split(" ", 2)[2] for line in lines_of("nm", "--demangle", "--defined-only", executable)
                 if line.count(" ") >= 2}
    if not libraries or not functions or not words:
        sys.exit(f"{executable}: no libraries or no names to look at")
    found = []
    for word in words:
        hit = next((name for name in (*libraries, *sorted(functions)) if name.startswith(word)), None)
        if hit:
            found.append(f"{executable} links {hit}, and nothing of {word} may be in it")
    print("\n".join(found) if found else f"{executable}: none of {', '.join(words)} in {len(libraries)} libraries "
                                         f"and {len(functions)} functions")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
