#!/usr/bin/env python3
"""Tests and source files that the documentation names exist.

    tools/check_named.py [ROOT]      ROOT: a checkout (default: this one). Exit 0 clean, 1 with one line a fault.

In docs/guides, docs/science and docs/developers, outside code blocks:
    `Suite.Name`, `Suite.*`     a test of tests/, or several
    `folder/file.hpp`           a source file whose path ends so; a name in capitals (NAME_shape.cpp) stands for any
"""
import re
import sys
from pathlib import Path

PAGES = ("docs/guides", "docs/science", "docs/developers")
TEST = re.compile(r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\s*\)")
BLOCK = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
NAMED_TEST = re.compile(r"`(?:\w+/)?([A-Z]\w+)\.((?:[A-Z][\w*]*)|\*)`")
NAMED_FILE = re.compile(r"`((?:[\w-]+/)*[\w-]+\.(?:hpp|cpp|inl|glsl|frag|vert|py|sh))`")


def tests_of(root):
    """{suite: names} of all tests."""
    suites = {}
    for path in (root / "tests").rglob("*.cpp"):
        for suite, name in TEST.findall(path.read_text(encoding="utf-8", errors="replace")):
            suites.setdefault(suite, set()).add(name)
    return suites


def files_of(root):
    """Paths of all source files, each with a slash before it."""
    return ["/" + p.relative_to(root).as_posix() for folder in ("src", "app", "tests", "bench", "tools")
            for p in (root / folder).rglob("*") if p.is_file()]


def has_test(suites, suite, name):
    pattern = re.compile(re.escape(name).replace(r"\*", ".*"))
    return any(pattern.fullmatch(n) for n in suites.get(suite, ()))


def faults_of(page, suites, files):
    """(line, message) of a page."""
    text = BLOCK.sub(lambda m: "\n" * m.group().count("\n"), page.read_text(encoding="utf-8"))
    for number, line in enumerate(text.splitlines(), 1):
        for suite, name in NAMED_TEST.findall(line):
            if not has_test(suites, suite, name):
                yield number, f"there is no test {suite}.{name}"
        for name in NAMED_FILE.findall(line):
            if not re.search(r"[A-Z]{4}", name) and not any(f.endswith("/" + name) for f in files):
                yield number, f"there is no file {name}"


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    suites, files = tests_of(root), files_of(root)
    pages = sorted(p for folder in PAGES for p in (root / folder).rglob("*.md"))
    found = [f"{page.relative_to(root).as_posix()}:{number}: {message}" for page in pages
             for number, message in faults_of(page, suites, files)]
    if not pages:
        found.append(f"{root}: no pages found")
    print("\n".join(found) if found else f"{len(pages)} pages name tests and files that exist")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
