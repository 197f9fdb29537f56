#!/usr/bin/env python3
"""The end of a test run: what failed, what was skipped and why, and one line of figures.

    tools/test_summary.py JUNIT RESULTS     JUNIT: what ctest --output-junit wrote; RESULTS: folder of NAME.json, the
                                            results of GoogleTest that entry NAME of ctest wrote

Cases of GoogleTest are counted one by one, other entries of ctest as one each. An executable that died counts as a
failure on top of what it had told. The last line is `N passed, N failed, N skipped`. Exit 0 if nothing failed and
something passed.
"""
import json
import re
import sys
import xml.etree.ElementTree as ET
from collections import defaultdict
from pathlib import Path


def reason_of(text):
    """What a skip says, without the place it is at: a line."""
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    lines = [line for line in lines if not re.fullmatch(r"(\S+\.cpp:\d+|Skipped|unknown file)", line)]
    return " ".join(lines) or "no reason given"


def cases_of(path):
    """Yields (name, 'passed' | 'failed' | 'skipped', reason) for each case in one of GoogleTest's JSON files."""
    for suite in json.loads(path.read_text(encoding="utf-8")).get("testsuites", []):
        for case in suite.get("testsuite", []):
            name = f"{suite['name']}.{case['name']}"
            if case.get("failures"):
                yield name, "failed", ""
            elif case.get("result") == "SKIPPED":
                yield name, "skipped", reason_of(case.get("why", ""))
            elif case.get("status") == "RUN":
                yield name, "passed", ""


def outcomes_of(entry, results):
    """The same for one entry of ctest, of whichever kind it is."""
    name, status = entry.get("name"), entry.get("status")
    said = entry.findtext("system-out") or ""
    skipped = entry.find("skipped")
    path = results / f"{name}.json"
    cases = list(cases_of(path)) if path.is_file() and path.stat().st_size else []
    if cases:
        yield from ((f"{name}: {case}", what, why) for case, what, why in cases)
        if status == "fail" and not any(what == "failed" for _, what, _ in cases):
            yield name, "failed", "its cases passed, the executable did not"
    elif skipped is not None and status != "fail":
        last = (said.strip().splitlines() or [skipped.get("message", "")])[-1]
        yield name, "skipped", last.strip() or "no reason given"
    elif status == "run":
        yield name, "passed", ""
    else:
        note = re.search(r"\[\s+(?:DIED|TOO LONG)\s+\] .*", said)
        yield name, "failed", note.group(0) if note else ""


def main():
    junit, results = Path(sys.argv[1]), Path(sys.argv[2])
    if not junit.is_file():
        sys.exit(f"{junit}: ctest wrote no results: it was stopped, or found no tests")
    count, why_skipped = defaultdict(int), defaultdict(list)
    failed = []
    for entry in ET.parse(junit).getroot().iter("testcase"):
        for name, what, why in outcomes_of(entry, results):
            count[what] += 1
            if what == "skipped":
                why_skipped[why].append(name)
            elif what == "failed":
                failed.append(f"failed: {name}" + (f" ({why})" if why else ""))
    for line in failed:
        print(line)
    for why, names in sorted(why_skipped.items()):
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        print(f"skipped: {names[0]}{more}: {why}")
    print(f"{count['passed']} passed, {count['failed']} failed, {count['skipped']} skipped")
    return 0 if count["passed"] and not count["failed"] else 1


if __name__ == "__main__":
    sys.exit(main())
