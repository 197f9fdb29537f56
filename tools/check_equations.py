#!/usr/bin/env python3
"""Every equation that the code claims to compute is listed, and every listed one is computed and tested.

    tools/check_equations.py [ROOT]      ROOT: a checkout (default: this one). Exit 0 clean, 1 with one line a fault.

A tag is written [KCM99 eq.3] (author letters, two digits of the year, number; a range is written out), that of a book's
numbered algorithm [PT97 A2.1], of an equation of a chapter [PT97 eq.4.8]. The set of tags
in docs/science/equations.md must be the set in src/ and the set in tests/. An equation that is only planned is written there
without brackets.
"""
import re
import sys
from pathlib import Path

TAG = re.compile(r"\[([A-Z][A-Za-z]*\d\d) (eq\.\d+(?:\.\d+)?[a-z]?|A\d+\.\d+)\]")
NEARLY = re.compile(r"\[[A-Z][A-Za-z]*\s?\d\d,?\s+eqs?[.\s][^\]\n]*\]")
SOURCES = (".hpp", ".cpp", ".h", ".inl")


def tags_in(root, paths):
    """{tag: first place}, and the places of tags that are not written as agreed."""
    tags, odd = {}, []
    for path in paths:
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            place = f"{path.relative_to(root).as_posix()}:{number}"
            for m in TAG.finditer(line):
                tags.setdefault(m.group(0), place)
            odd += [f"{place}: {m.group(0)} is not written like [KCM99 eq.3]" for m in NEARLY.finditer(line)
                    if not TAG.fullmatch(m.group(0))]
    return tags, odd


def sources(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in SOURCES) if folder.is_dir() else []


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    page = root / "docs" / "science" / "equations.md"
    if not page.is_file():
        print("docs/science/equations.md is missing")
        return 1
    listed, odd_listed = tags_in(root, [page])
    coded, odd_coded = tags_in(root, sources(root / "src"))
    tested, odd_tested = tags_in(root, sources(root / "tests"))
    found = odd_listed + odd_coded + odd_tested
    for tag in sorted(set(listed) | set(coded) | set(tested)):
        place = listed.get(tag) or coded.get(tag) or tested.get(tag)
        for where, tags in (("docs/science/equations.md", listed), ("src/", coded), ("tests/", tested)):
            if tag not in tags:
                found.append(f"{place}: {tag} does not occur in {where}")
    if not listed:
        found.append("docs/science/equations.md lists no equation")
    print("\n".join(found) if found else f"{len(listed)} equations are listed, coded and tested")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
