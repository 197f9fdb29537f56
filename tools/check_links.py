#!/usr/bin/env python3
"""Checks the links of the documentation: pages, pictures, headings (#anchors) and paths of the repository in backquotes.

    tools/check_links.py [ROOT]      ROOT: a checkout (default: this one). Exit 0 clean, 1 with one line a fault.
"""
import functools
import re
import sys
import unicodedata
from pathlib import Path

FENCE = re.compile(r"^ {0,3}(```+|~~~+)")
CODE = re.compile(r"(`+).+?\1")
LINK = re.compile(r"\]\(([^)\s]*)\)")
PATH = re.compile(r"`((?:app|bench|cmake|docs|scenes|src|tests|tools)/[\w./-]+)`")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$")
EXPLICIT = re.compile(r"<a (?:id|name)=\"([^\"]+)\"")


def slug(title, separator="-"):
    """The anchor of a heading, as GitHub and our site make it (Python-Markdown calls this with a separator)."""
    title = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", title)
    title = unicodedata.normalize("NFC", title).strip().lower()
    return re.sub(r"[^\w\- ]", "", title).replace(" ", separator)


def lines_outside_code(text):
    """(number, line) of the lines that are not inside a fenced code block."""
    fence = None
    for number, line in enumerate(text.splitlines(), 1):
        mark = FENCE.match(line)
        if mark and fence is None:
            fence = mark.group(1)
        elif mark and mark.group(1).startswith(fence):
            fence = None
        elif fence is None:
            yield number, line


@functools.lru_cache(maxsize=None)
def anchors(page):
    """All anchors of a page; a heading that stands there twice has -1 at its second anchor."""
    found, times = set(), {}
    for _, line in lines_outside_code(page.read_text(encoding="utf-8")):
        found.update(EXPLICIT.findall(line))
        heading = HEADING.match(line)
        if heading:
            name = slug(heading.group(1))
            found.add(f"{name}-{times[name]}" if name in times else name)
            times[name] = times.get(name, 0) + 1
    return found


def fault_of(page, target):
    """What is wrong with a link of this page, or None."""
    if "://" in target or target.startswith("mailto:"):
        return None
    path, _, anchor = target.partition("#")
    other = page.parent / path if path else page
    if not other.exists():
        return f"there is no file {path}"
    if anchor and other.suffix == ".md" and anchor not in anchors(other.resolve()):
        return f"{path or 'this page'} has no heading #{anchor}"
    return None


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    pages = sorted(root.glob("*.md")) + sorted((root / "docs").rglob("*.md"))
    found = [] if pages else [f"{root}: no pages found"]
    for page in pages:
        for number, line in lines_outside_code(page.read_text(encoding="utf-8")):
            place = f"{page.relative_to(root).as_posix()}:{number}"
            for target in LINK.findall(CODE.sub("", line)):
                fault = fault_of(page, target)
                if fault:
                    found.append(f"{place}: {fault}")
            for target in [] if "docs/log" in place else PATH.findall(line):  # history names files of its time
                if not (root / target).exists() and not list(root.glob(target.rstrip("/") + ".*")):
                    found.append(f"{place}: there is no {target}")
    print("\n".join(found) if found else f"{len(pages)} pages: every link leads to a page or heading that exists")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
