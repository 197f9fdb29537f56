#!/usr/bin/env python3
"""Prepares the pages of the site for MkDocs: a copy of docs/ in which every link leads somewhere inside the site.

    tools/docs_pages.py FOLDER       writes FOLDER/pages and FOLDER/mkdocs.yml (tools/docs.sh calls this)

README, CONTRIBUTING and CHANGELOG become pages of the folder project/; other files of the repository that pages link to
are copied to source/. The order of the pages is the order in which the index page of a folder links to them.
"""
import os
import re
import shutil
import sys
from pathlib import Path

from check_links import FENCE, LINK

ROOT = Path(__file__).resolve().parent.parent
PROJECT = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")
SECTIONS = (("tutorials", "Tutorials"), ("guides", "Guides"), ("reference", "Reference"), ("science", "Science"),
            ("developers", "Developers"), ("log", "Log"), ("project", "Project"))
ITEM = re.compile(r"^\s*([-*+]|\d+\.) ")
CONFIG = """site_name: Trocar
site_description: Open trainer for endoscopic surgery
docs_dir: pages
site_dir: site
use_directory_urls: false
theme:
  name: material
  font: false
  features: [navigation.indexes, navigation.top]
  palette: {primary: teal}
plugins: [search]
markdown_extensions: [tables, fenced_code, sane_lists, attr_list]
hooks: [HOOKS]
nav:
"""


class Site:
    """Where the files of the repository lie in the site."""

    def __init__(self, folder):
        self.pages = folder / "pages"
        self.extra = {}  # file of the repository -> its place below pages/

    def place(self, file):
        if file.parent == ROOT and file.name in PROJECT:
            return self.pages / "project" / file.name.lower()
        if file.is_relative_to(ROOT / "docs"):
            return self.pages / file.relative_to(ROOT / "docs")
        name = file.relative_to(ROOT)
        self.extra[file] = self.pages / "source" / (f"{name}.txt" if file.suffix in (".md", "") else name)
        return self.extra[file]

    def link(self, page, target):
        """The same link in the site."""
        path, _, anchor = target.partition("#")
        if not path or "://" in target or target.startswith("mailto:"):
            return target
        file = (page.parent / path).resolve()
        if file.is_dir():
            index = file / "index.md"
            if not index.exists():
                return None
            file = index
        moved = os.path.relpath(self.place(file), self.place(page).parent)
        return moved + (f"#{anchor}" if anchor else "")

    def text(self, page):
        """The page with its links moved, blank lines before lists, and plain names of languages on code blocks."""
        lines, fence, before = [], None, ""
        for line in page.read_text(encoding="utf-8").splitlines():
            mark = FENCE.match(line)
            if mark and fence is None:
                fence = mark.group(1)
                line = re.match(r"^ *[`~]+\w*", line).group(0)
                if before.strip():
                    lines.append("")
            elif mark and mark.group(1).startswith(fence):
                fence = None
            elif fence is None:
                line = self.moved(page, line)
                if ITEM.match(line) and before.strip() and not ITEM.match(before) and not before.startswith(" "):
                    lines.append("")
                elif line.startswith("|") and before.strip() and not before.startswith("|"):
                    lines.append("")
            lines.append(line)
            before = line
        return "\n".join(lines) + "\n"

    def moved(self, page, line):
        """One line with its links moved; a link to a folder without an index page becomes plain text."""
        def change(match):
            target = self.link(page, match.group(1))
            return "]()" if target is None else f"]({target})"
        return re.sub(r"\[([^\]]*)\]\(\)", r"\1", LINK.sub(change, line))


def title_of(page):
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.startswith("# "):
            return line[2:].strip().replace('"', "'")
    return page.stem


def ordered(folder):
    """The index page of a folder, then the pages it links to in that order, then the others by name."""
    index = folder / "index.md"
    pages = sorted(p for p in folder.glob("*.md") if p != index)
    if not index.exists():
        return pages
    linked = [(folder / t.partition("#")[0]).resolve() for t in LINK.findall(index.read_text(encoding="utf-8"))]
    return [index] + sorted(pages, key=lambda p: linked.index(p.resolve()) if p.resolve() in linked else len(linked))


def navigation(pages):
    yield '  - "Trocar": index.md'
    for folder, title in SECTIONS:
        found = ordered(pages / folder)
        if found:
            yield f'  - "{title}":'
        for page in found:
            name = page.relative_to(pages).as_posix()
            yield f"    - {name}" if page.name == "index.md" else f'    - "{title_of(page)}": {name}'
    for page in ordered(pages)[1:]:
        yield f'  - "{title_of(page)}": {page.name}'


def main():
    folder = Path(sys.argv[1]).resolve()
    shutil.rmtree(folder / "pages", ignore_errors=True)
    shutil.copytree(ROOT / "docs", folder / "pages")
    site = Site(folder)
    for page in [*(ROOT / name for name in PROJECT), *sorted((ROOT / "docs").rglob("*.md"))]:
        place = site.place(page)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(site.text(page), encoding="utf-8")
    for file, place in site.extra.items():
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, place)
    hooks = os.path.relpath(ROOT / "tools/docs_hooks.py", folder)
    (folder / "mkdocs.yml").write_text(CONFIG.replace("HOOKS", hooks) + "\n".join(navigation(site.pages)) + "\n",
                                       encoding="utf-8")
    print(f"{len(list(site.pages.rglob('*.md')))} pages")


if __name__ == "__main__":
    main()
