#!/usr/bin/env python3
"""Checks that what people read is plain technical English: pages, scene files, windows, messages, reports.

    tools/check_language.py [--root DIR] [--count] [PATH...]

PATH: only these files or folders (default: the whole checkout). --count: one line a folder instead of one a fault.
What is checked:
  pages (*.md)         sentences of more than 40 words; lines of more than 120 characters outside tables, code and links;
                       table cells of more than 200; forbidden phrases; abbreviations that neither the page nor
                       docs/glossary.md explains. docs/log/ is history and exempt.
  scenes/**/*.json     sentences and forbidden phrases in titles, hints, descriptions (not in comments)
  src/, app/           the same in the texts of C++ sources, report pages and the installed scripts (not in comments);
                       formatted texts pass through tr()
tools/language_exceptions.txt names at most 20 exceptions, a line each: `PATH: TEXT OF THE FAULT'S LINE`.
Exit 0 clean, 1 with one line a fault, 2 unusable arguments.
"""
import argparse
import re
import sys
from collections import Counter
from pathlib import Path

MOST_WORDS, MOST_LINE, MOST_CELL, MOST_EXCEPTIONS = 40, 120, 200, 20

# Phrase -> what to write instead.
FORBIDDEN = [(re.compile(pattern, re.IGNORECASE), remedy) for pattern, remedy in [
    (r"\bhangs? still\b", "is in equilibrium"),
    (r"\b(comes?|came|coming) off\b", "succeeds, passes; detaches"),
    (r"\btime stands still\b", "paused"),
    (r"\bof one mind\b", "consistent"),
    (r"\b(is|are|was|were|be|been|being) told\b|\btells\b", "reports, emits, shows"),
    (r"\bgoes by it\b", "follows it, depends on it"),
    (r"\bas who\b|\bwhoever\b", "name the person"),
    (r"\bwho(ever)? is away\b", "a disconnected participant"),
    (r"\bno more than it bears\b", "within its limit"),
    (r"\bbe it\b", "whether"),
    (r"\banew\b", "again"),
    (r"\bfarther\b", "more, further, beyond"),
    (r"\bleads? (a|the|one|this|that|another) hand\b|\b(is|are|was|were|be) led\b", "control"),
    (r"\bthe books of\b", "the account of"),
    (r"\bdoubts\b", "warnings"),
    (r"\blooked through\b", "loaded, read"),
    (r"\bwhose anatomy is another\b", "random patient"),
    (r"\bas drawn\b", "standard, undeformed"),
    (r"\bnobody demonstrates\b", "has no demonstration"),
    (r"\bwhat has run out\b", "free blood, spilled bile"),
    (r"\b(go|goes|going) on\b", "resume, continue"),
    (r"\b(begin|begins|beginning) again\b", "restart"),
    (r"\bways of the tips\b", "instrument path length"),
    (r"\bpassed from \{?\d*", "pass mark"),
    (r"(?<![-'])\bours\b", "our estimate"),
]]
NOUN_WANTED = re.compile(r"^(What|Whatever) (is|are|was|were|has|have|had|can|does|do|lies|stands|hangs|they|it|one)\b")

WORD = re.compile(r"[\w'’-]*[A-Za-z][\w'’-]*")
SENTENCE_END = re.compile(r"(?<=[.!?])[)\"'”*_]*\s+(?=[\"'“(*_]*[A-Z0-9{`])")
ABBREVIATION = re.compile(r"(?<![\w/.`-])([A-Z]{2,6})s?(?![\w/-])")
CODE_SPAN = re.compile(r"``.*?``|`[^`]*`")
PLACEHOLDER = re.compile(r"\{[^{}]*\}")
LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
# Words written in capitals that abbreviate nothing.
NO_ABBREVIATION = {"README", "CHANGELOG", "NOTICE", "LICENSE", "AND", "NOT", "OR", "II", "III", "IV", "VI", "VII", "VIII",
                   "IX", "OK"}


def sentence_faults(text):
    """Faults of running text: (offset in text, message)."""
    for pattern, remedy in FORBIDDEN:
        for match in pattern.finditer(text):
            yield match.start(), f'"{match.group()}": write {remedy}'
    at = 0
    for sentence in SENTENCE_END.split(text):
        start = text.find(sentence, at)
        at = start + len(sentence)
        words = len(WORD.findall(sentence))
        if words > MOST_WORDS:
            yield start, f"a sentence of {words} words: at most {MOST_WORDS}"
        if NOUN_WANTED.match(sentence.lstrip("*_ ")) and not sentence.rstrip(" *_").endswith("?"):
            yield start, f'"{" ".join(sentence.split()[:2])} ...": name the thing instead'


def plain(markdown):
    """A line without code, {placeholders} and targets of links: what is read."""
    return LINK.sub(lambda m: m.group(1), CODE_SPAN.sub("code", PLACEHOLDER.sub("value", markdown)))


def page_faults(path, lines, explained):
    """(line, message) of a Markdown page."""
    text = "\n".join(lines)
    known = explained | NO_ABBREVIATION | set(re.findall(r"\(([A-Z]{2,6})s?[),;]", text))
    known |= set(re.findall(r"\b([A-Z]{2,6})s? \(", text))
    paragraph, begun, fenced = [], 0, False  # begun: the first line of the paragraph

    def end_paragraph():
        joined = " ".join(paragraph)
        for offset, message in sentence_faults(joined):
            line, length = begun, 0
            for part in paragraph:
                length += len(part) + 1
                if offset < length:
                    break
                line += 1
            yield line, message
        paragraph.clear()

    for number, line in enumerate(lines, 1):
        bare = line.strip()
        if bare.startswith(("```", "~~~")):
            yield from end_paragraph()
            fenced = not fenced
            continue
        if fenced or bare.startswith("    ") or bare.startswith("<"):
            continue
        read = plain(line)
        for match in ABBREVIATION.finditer(re.sub(r"\[[^\]]*\d{2,4}[^\]]*\]", "", read)):
            if match.group(1) not in known:
                known.add(match.group(1))
                yield number, f"{match.group(1)}: explain it here or in docs/glossary.md"
        if bare.startswith("|"):
            yield from end_paragraph()
            for cell in re.split(r"(?<!\\)\|", read):
                if len(cell.strip()) > MOST_CELL:
                    yield number, f"a table cell of {len(cell.strip())} characters: at most {MOST_CELL}"
                for _, message in sentence_faults(cell.strip()):
                    yield number, message
            continue
        if len(read.rstrip()) > MOST_LINE:
            yield number, f"a line of {len(read.rstrip())} characters: at most {MOST_LINE}"
        if not bare or bare.startswith("#") or re.match(r"([-*+]|\d+\.|>)\s", bare):
            yield from end_paragraph()
            read = re.sub(r"^\s*([-*+]|\d+\.|>|#+)\s+", "", read)
        if bare:
            if not paragraph:
                begun = number
            paragraph.append(read.strip())
            if bare.startswith("#"):
                yield from end_paragraph()
    yield from end_paragraph()


def json_texts(text):
    """(line, text) of string values that are texts: those of two words and more."""
    blank = re.compile(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
    for match in blank.finditer(text):
        if match.group().startswith('"') and " " in match.group() and not re.match(r"\s*:", text[match.end():]):
            yield text.count("\n", 0, match.start()) + 1, match.group()[1:-1].replace('\\"', '"')


CPP_TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|#include[^\n]*|R"(\w*)\((.*?)\)\1"|"((?:[^"\\\n]|\\.)*)"|\'(?:[^\'\\\n]|\\.)+\'', re.DOTALL)


def cpp_texts(source):
    """(line, text) of string literals; those that stand side by side are one text."""
    text, line, end = "", 0, 0
    for match in CPP_TOKEN.finditer(source):
        literal = match.group(3) if match.group(3) is not None else match.group(2)
        if literal is None:
            continue
        if text and not source[end:match.start()].strip():
            text += literal
        else:
            if " " in text:
                yield line, text
            text, line = literal, source.count("\n", 0, match.start()) + 1
        end = match.end()
    if " " in text:
        yield line, text


FORMATTED = re.compile(r"\b(?:fmt::format|fmt::print|ImGui::(?:Text\w*|Button|SetTooltip|MenuItem|BeginMenu|Checkbox))"
                       r"\(\s*(?:[\w>.:()? -]+,\s*)?((?:\"(?:[^\"\\\n]|\\.)*\"\s*)+)")
OTHER_LANGUAGE = re.compile(r'^\{\{|^[$#.<]|^(ply|NRRD|CELL_DATA|GET|esac)|=\\"|:=')  # of a file or a protocol


def untranslated(source):
    """(line, message) of formatted texts of three words and more that do not pass through tr()."""
    for match in FORMATTED.finditer(source):
        text = "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', match.group(1)))
        if QUERY.match(text) or OTHER_LANGUAGE.search(text) or " " not in text.strip():
            continue
        words = re.findall(r"[A-Za-z][a-z']+", re.sub(r"\\[nt]", " ", PLACEHOLDER.sub(" ", text)))
        comment = "//" in source[source.rfind("\n", 0, match.start()) + 1:match.start()]
        if len(words) >= 3 and max(map(len, words)) >= 4 and not comment:
            yield source.count("\n", 0, match.start()) + 1, f'"{text[:40]}": write tr("...", ...) around the text'


def html_texts(source):
    source = re.sub(r"<(style|script).*?</\1>|<!--.*?-->", lambda m: "\n" * m.group().count("\n"), source, flags=re.DOTALL)
    for match in re.finditer(r">([^<>]*[A-Za-z][^<>]*)<", source):
        yield source.count("\n", 0, match.start(1)) + 1, " ".join(match.group(1).split())


def script_texts(source):
    for number, line in enumerate(source.splitlines(), 1):
        for text in re.findall(r'(?:echo|printf)\s+"((?:[^"\\]|\\.)*)"', line):
            yield number, text


QUERY = re.compile(r"\s*(CREATE|SELECT|INSERT|UPDATE|DELETE|PRAGMA|WITH|ALTER)\b")


def text_faults(texts):
    for line, text in texts:
        if QUERY.match(text):  # for the database
            continue
        for _, message in sentence_faults(text.replace("\\n", " ")):
            yield line, message


def explained_abbreviations(root):
    """Those that docs/glossary.md has as a term: first cells of its tables, and what it writes in bold."""
    glossary = root / "docs" / "glossary.md"
    if not glossary.exists():
        return set()
    terms = re.findall(r"^\|([^|]*)\||\*\*([^*]+)\*\*", glossary.read_text(encoding="utf-8"), re.MULTILINE)
    return set(re.findall(r"[A-Z]{2,6}", " ".join(a + " " + b for a, b in terms)))


def faults_of(root, path, explained):
    relative = path.relative_to(root).as_posix()
    source = path.read_text(encoding="utf-8", errors="replace")
    if path.suffix == ".md":
        return page_faults(path, source.splitlines(), explained)
    if path.suffix == ".json":
        return text_faults(json_texts(source))
    if path.suffix in (".cpp", ".hpp"):
        return [*text_faults(cpp_texts(source)), *untranslated(source)]
    if path.suffix == ".html":
        return text_faults(html_texts(source))
    return text_faults(script_texts(source)) if relative.endswith(".sh") else []


def files(root):
    yield from sorted(root.glob("*.md"))
    yield from sorted(root.glob("*.sh"))
    for folder, kinds in (("docs", ["*.md"]), ("scenes", ["*.json"]), ("app", ["*.cpp", "*.hpp"]),
                          ("src", ["*.cpp", "*.hpp", "*.html"]), ("tools", ["*.sh"]), ("courses", ["*.json"])):
        for kind in kinds:
            for path in sorted((root / folder).rglob(kind)):
                if not path.relative_to(root).as_posix().startswith("docs/log/"):
                    yield path


def exceptions(root):
    path = root / "tools" / "language_exceptions.txt"
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [line.strip() for line in lines if line.strip() and not line.startswith("#")]


def main():
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("--root", default=Path(__file__).parent.parent)
    parser.add_argument("--count", action="store_true")
    parser.add_argument("paths", nargs="*")
    arguments = parser.parse_args()
    root = Path(arguments.root).resolve()
    wanted = [Path(p).resolve() for p in arguments.paths]
    for path in wanted:
        if not path.exists():
            print(f"{path}: is not there", file=sys.stderr)
            return 2
    explained, excepted = explained_abbreviations(root), exceptions(root)
    found, counts, looked_at, used = [], Counter(), 0, set()
    for path in files(root):
        if wanted and not any(path == w or w in path.parents for w in wanted):
            continue
        looked_at += 1
        relative = path.relative_to(root).as_posix()
        lines = None
        for number, message in faults_of(root, path, explained):
            lines = lines if lines is not None else path.read_text(encoding="utf-8", errors="replace").splitlines()
            entry = f"{relative}: {lines[number - 1].strip()}"
            if entry in excepted:
                used.add(entry)
                continue
            found.append(f"{relative}:{number}: {message}")
            counts["/".join(relative.split("/")[:3 if relative.startswith("src") else 2])] += 1
    if not wanted:
        found += [f"tools/language_exceptions.txt: not needed: {e}" for e in excepted if e not in used]
        if len(excepted) > MOST_EXCEPTIONS:
            found.append(f"tools/language_exceptions.txt: {len(excepted)} exceptions: at most {MOST_EXCEPTIONS}")
    if looked_at == 0:
        found.append(f"{root}: nothing to read here")
    if arguments.count:
        print("\n".join(f"{n:6d} {folder}" for folder, n in counts.most_common()))
        print(f"{len(found):6d} together, {looked_at} files")
    else:
        print("\n".join(found) if found else f"{looked_at} files in plain English")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
