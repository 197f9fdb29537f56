#!/usr/bin/env python3
"""Every picture and page that our pages link to is there, and every path in backquotes that looks like one of ours.

    tools/check_links.py [ROOT]      ROOT: a checkout (default: this one). Exit 0 clean, 1 with one line a fault.
"""
import re
import sys
from pathlib import Path

LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
PATH = re.compile(r"`((?:app|bench|cmake|docs|scenes|src|tests|tools)/[\w./-]+)`")


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    pages = sorted(root.glob("*.md")) + sorted((root / "docs").rglob("*.md"))
    found = [] if pages else [f"{root}: no pages found"]
    for page in pages:
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            place = f"{page.relative_to(root).as_posix()}:{number}"
            for target in LINK.findall(line):
                if "://" not in target and not (page.parent / target).exists():
                    found.append(f"{place}: {target} is not there")
            for target in PATH.findall(line):
                if not (root / target).exists() and not list(root.glob(target.rstrip("/") + ".*")):
                    found.append(f"{place}: {target} is not there")
    print("\n".join(found) if found else f"{len(pages)} pages, every link leads somewhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
