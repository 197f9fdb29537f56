#!/usr/bin/env python3
"""Checks the command blocks of README and the user pages: code blocks that begin with ```sh.

    tools/check_commands.py PROGRAM [--run] [PAGE...]

PROGRAM: the built `trocar`. PAGE: only these (default: README.md, docs/index.md, docs/tutorials, docs/guides,
docs/reference). Without --run every command is looked up: `trocar COMMAND --help` has to know each command and option,
and each tools/ script has to exist. With --run the blocks of a page are run one after the other, as a reader would,
in an empty folder where docs, scenes and tools of the checkout are at hand; every line has to succeed.

A word after `sh` says that a block is only looked up, not run:
    ```sh window      opens a window, or waits for a person or a device
    ```sh slow        takes minutes
    ```sh example     file names in it are the reader's own
    ```sh install     changes the system
Exit 0 clean, 1 with one line a fault.
"""
import argparse
import functools
import os
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = ("README.md", "CONTRIBUTING.md", "docs/index.md", "docs/tutorials", "docs/guides", "docs/reference")
BLOCK = re.compile(r"^ *```sh *(\w*) *\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
OPTION = re.compile(r"(?<![\w-])(--?[A-Za-z][\w-]*)")
NAMES = ("trocar", "build/release/trocar", "./trocar")
SECONDS = 900  # most that one block may take


def shown(page):
    return page.relative_to(ROOT).as_posix() if page.is_relative_to(ROOT) else page.name


def blocks(page):
    """(line number, kind, text) of each block of commands."""
    text = page.read_text(encoding="utf-8")
    for match in BLOCK.finditer(text):
        yield text.count("\n", 0, match.start()) + 1, match.group(1), match.group(2)


def commands(text):
    """The words of each command of a block, without comments and here-documents; pipes and && part commands."""
    text = re.sub(r"<<-?\s*'?(\w+)'?(.*?\n).*?^\1$", r"\2", text, flags=re.MULTILINE | re.DOTALL)
    for line in text.replace("\\\n", " ").splitlines():
        lexer = shlex.shlex(line, posix=True, punctuation_chars="|&;")
        lexer.whitespace_split = True
        words = []
        for word in lexer:
            if set(word) <= set("|&;"):
                yield words
                words = []
            else:
                words.append(word)
        yield words


@functools.lru_cache(maxsize=None)
def help_of(program, command):
    """What `trocar COMMAND... --help` prints, or None when there is no such command."""
    result = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=False)
    return result.stdout if result.returncode == 0 else None


def subcommands(text):
    """The names under "Subcommands:" of a help text, in their order."""
    listed = text.partition("Subcommands:")[2].strip("\n").partition("\n\n")[0]
    return re.findall(r"^ {2}([a-z][\w-]*)", listed, re.MULTILINE)


def fault_of(program, words):
    """What is wrong with one command, or None."""
    if not words:
        return None
    if words[0].startswith(("tools/", "./")) and words[0] not in NAMES:
        return None if (ROOT / words[0]).exists() else f"there is no {words[0]}"
    if words[0] not in NAMES:
        return None
    command, rest = (), words[1:]
    if rest and not rest[0].startswith("-") and rest[0] != "help":
        command, rest = (rest[0],), rest[1:]
        if help_of(program, command) is None or command[0] not in subcommands(help_of(program, ())):
            return f"there is no command {command[0]}"
        for word in [w for w in rest if not w.startswith("-")][:2]:  # mechanism FILE pose, box simulate
            if word in subcommands(help_of(program, command)):
                command += (word,)
    known = set()
    for level in range(len(command) + 1):
        known.update(OPTION.findall(help_of(program, command[:level]) or ""))
    for word in rest:
        name = word.split("=")[0]
        if OPTION.fullmatch(name) and name not in known:
            return f"{' '.join(command)} has no option {name}"
    return None


def run(page, program):
    """Faults of running all blocks of a page, in one folder that is the home folder, too."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        for entry in ("docs", "scenes", "tools", "src", "README.md"):
            (here / entry).symlink_to(ROOT / entry)
        (here / "bin").mkdir()
        (here / "bin" / "trocar").symlink_to(Path(program).resolve())
        environment = dict(os.environ, PATH=f"{here}/bin:{os.environ['PATH']}", HOME=folder)
        for name in [n for n in environment if n.startswith(("TROCAR_", "XDG_"))]:
            del environment[name]  # a reader's defaults: the data folder is below HOME
        for number, kind, text in blocks(page):
            if kind or re.match(r"\s*(\./run\.sh|\./test\.sh|git |cmake )", text):
                continue
            script = text.replace("build/release/trocar", "trocar")
            try:
                done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=environment,
                                      capture_output=True, text=True, timeout=SECONDS, check=False)
            except subprocess.TimeoutExpired:
                yield f"{shown(page)}:{number}: still running after {SECONDS} s"
                continue
            print(f"{shown(page)}:{number}: exit {done.returncode}", flush=True)
            if done.returncode != 0:
                last = (done.stderr.strip() or done.stdout.strip())[-600:]
                yield f"{shown(page)}:{number}: exit {done.returncode}: {last}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--run", action="store_true")
    parser.add_argument("pages", nargs="*", type=Path)
    wanted = parser.parse_intermixed_args()
    roots = wanted.pages or [ROOT / p for p in PAGES]
    pages = [p for r in roots for p in (sorted(r.rglob("*.md")) if r.is_dir() else [r]) if p.exists()]
    found, count = [], 0
    for page in (p.resolve() for p in pages):
        for number, _, text in blocks(page):
            for words in commands(text):
                count += 1
                fault = fault_of(wanted.program, words)
                if fault:
                    found.append(f"{shown(page)}:{number}: {fault} ({' '.join(words)})")
        if wanted.run:
            found.extend(run(page, wanted.program))
    print("\n".join(found) if found else f"{count} commands on {len(pages)} pages exist with their options")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
