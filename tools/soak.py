#!/usr/bin/env python3
"""The soak, part by part: tests that take too long for `./test.sh`. The parts are in tests/soak.toml.

    tools/soak.py list [PART...]       the parts, how long each takes, and when each ran last (docs/log/soak.md);
                                       --names: their names alone
    tools/soak.py run [--note] PART... runs parts of a build that has its tests; --note writes their rows to that page
    tools/soak.py check [BUILD]        every long test belongs to a part; as the sources say

Exit: 0 all passed, 1 one failed, 2 no such part, 77 nothing failed and one was skipped.
"""
import argparse
import fnmatch
import json
import os
import re
import subprocess
import sys
import time
import tomllib
from datetime import date
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from test_summary import cases_of  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/log/soak.md"
LONGEST_MIN = 45  # a part that takes longer must be divided
SKIPPED = 77


def all_parts(path=ROOT / "tests/soak.toml"):
    """Each part: name, what, minutes, and at least one of WAYS."""
    return tomllib.loads(path.read_text(encoding="utf-8"))["part"]


def rows():
    """The page's rows by part: [commit, date, minutes, result]."""
    found = {}
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 5:
            found[cells[0].strip("`")] = cells[1:]
    return found


def show(parts, names_only):
    if names_only:
        return print("\n".join(part["name"] for part in parts))
    ran = rows()
    for part in parts:
        last = ran.get(part["name"])
        when = f"{last[1]}, {last[0].strip('`')}, {last[2]} min: {last[3]}" if last else "not recorded"
        print(f"{part['name']:18} {part['minutes']:3} min  {part['what']}\n{'':27}last: {when}")


def tests(build, part, folder):
    """Tests of ctest by their names; like all ways, it returns (what failed, why something was skipped)."""
    names = "|".join(re.escape(name) for name in part["tests"])
    said = subprocess.run(["ctest", "--test-dir", build, "-R", f"^({names})$", "--output-on-failure",
                           "--no-tests=error"], stdout=subprocess.PIPE, text=True)
    (folder / "ctest.log").write_text(said.stdout, encoding="utf-8")
    ended = re.findall(r"Test +#\d+: (\S+) \.+(.*)", said.stdout)
    failed = [name for name, how in ended if "Passed" not in how and "Skipped" not in how]
    if said.returncode and not failed:
        failed = [f"ctest ended with {said.returncode}"]
    return failed, [f"{name} was skipped" for name, how in ended if "Skipped" in how]


def cases(build, part, folder):
    """Cases of GoogleTest programs, {program: filter}; on each core (or of `shares`) a share of them."""
    failed, skipped = [], []
    for name, patterns in part["cases"].items():
        path = executable(build, name)
        if path is None:
            failed.append(f"{name} is not built")
            continue
        running = [share_of(path, patterns, folder / f"{name}.{i}", i, part.get("shares", os.cpu_count() or 1))
                   for i in range(part.get("shares", os.cpu_count() or 1))]
        ran = [one for share in running for one in results_of(*share)]
        failed += [case for case, what, _ in ran if what == "failed"]
        skipped += [f"{case}: {why}" for case, what, why in ran if what == "skipped"]
        if not ran:
            failed.append(f"{name} has no such case")
    return failed, skipped


def share_of(path, patterns, stem, index, shares):
    log = open(f"{stem}.log", "w", encoding="utf-8")
    environment = dict(os.environ, GTEST_TOTAL_SHARDS=str(shares), GTEST_SHARD_INDEX=str(index), GTEST_BRIEF="1",
                       GTEST_OUTPUT=f"json:{stem}.json", TROCAR_TEST_SECONDS="5400")
    return subprocess.Popen([path, "--gtest_filter=" + ":".join(patterns)], env=environment, stdout=log,
                            stderr=subprocess.STDOUT), log, Path(f"{stem}.json")


def results_of(process, log, result):
    status = process.wait()
    log.close()
    ran = list(cases_of(result)) if result.is_file() else []
    if status and not any(what == "failed" for _, what, _ in ran):
        ran.append((f"a share ended with {status}, see {log.name}", "failed", ""))
    return ran


def fuzz(_, part, folder):
    seconds = os.environ.get("TROCAR_FUZZ_SECONDS", "600")
    return command(_, {"command": " ".join(["tools/fuzz.sh", seconds, *part["fuzz"]])}, folder)


def command(_, part, folder):
    with open(folder / "log", "a", encoding="utf-8") as log:
        status = subprocess.run(["bash", "-c", part["command"]], cwd=ROOT, stdout=log, stderr=subprocess.STDOUT)
    last = (folder / "log").read_text(encoding="utf-8", errors="replace").strip().splitlines()[-1:]
    if status.returncode == SKIPPED:
        return [], last or ["something is missing"]
    return ([f"exit {status.returncode}, see {folder / 'log'}"] if status.returncode else []), []


WAYS = {"tests": tests, "cases": cases, "fuzz": fuzz, "command": command}


def run_part(build, part):
    """Runs one part; returns (exit code, minutes, result in words)."""
    folder = ROOT / build / "test-results/soak" / part["name"]
    subprocess.run(["rm", "-rf", folder], check=True)
    folder.mkdir(parents=True)
    print(f"soak: {part['name']} begins (about {part['minutes']} min)", file=sys.stderr)
    begun = time.monotonic()
    failed, skipped = [], []
    for key, way in WAYS.items():
        if key in part:
            broken, left_out = way(build, part, folder)
            failed, skipped = failed + broken, skipped + left_out
    minutes = (time.monotonic() - begun) / 60
    if minutes > LONGEST_MIN:
        print(f"soak: {part['name']} took {minutes:.0f} min: divide it ({LONGEST_MIN} min at most)", file=sys.stderr)
    for line in failed:
        print(f"failed: {line}")
    for line in skipped:
        print(f"skipped: {line}")
    if failed:
        return 1, minutes, f"FAILED: {failed[0]}" + (f" and {len(failed) - 1} more" if len(failed) > 1 else "")
    if skipped:
        return SKIPPED, minutes, f"skipped: {skipped[0]}" + (f" and {len(skipped) - 1} more" if skipped[1:] else "")
    return 0, minutes, "passed"


def commit():
    said = subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=8", "--exclude=*"], cwd=ROOT,
                          capture_output=True, text=True)
    return said.stdout.strip() or "unknown"


def note(name, row):
    """Writes one row to the page: rows stand in the order of the parts."""
    kept = rows()
    kept[name] = row
    head = PAGE.read_text(encoding="utf-8").split("| part |")[0]
    lines = ["| part | commit | date | minutes | result |", "|---|---|---|---|---|"]
    for part in all_parts():
        commit_, day, minutes, result = kept.get(part["name"], ["", "", "", "not recorded"])
        lines.append(f"| `{part['name']}` | {commit_} | {day} | {minutes} | {result} |")
    PAGE.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")


def run(build, parts, noted):
    found = list(faults(all_parts(), [*long_tests(build), *built_cases(build)]))
    if found:
        print("\n".join(found), file=sys.stderr)
        return 1
    codes, said = [], []
    for part in parts:
        code, minutes, result = run_part(build, part)
        codes.append(code)
        said.append(f"{part['name']:18} {minutes:5.1f} min  {result}")
        if noted:
            note(part["name"], [f"`{commit()}`", date.today().isoformat(), f"{minutes:.0f}", result.replace("|", "/")])
    print("\n".join(said))
    return 1 if 1 in codes else SKIPPED if SKIPPED in codes else 0


def chosen(names):
    """The parts of these names, all where there are none."""
    parts = {part["name"]: part for part in all_parts()}
    for name in names:
        if name not in parts:
            print(f"soak: there is no part {name}; parts: {', '.join(parts)}", file=sys.stderr)
            sys.exit(2)
    return [parts[name] for name in names or parts]


def executable(build, name):
    found = sorted(p for p in (ROOT / build / "tests").rglob(name) if p.is_file())
    return found[0] if found else None


def cases_in(path):
    """All cases of a GoogleTest program by their full names."""
    said = subprocess.run([path, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    suite, found = "", []
    for line in said.splitlines():
        name = line.split("#")[0].rstrip()
        if not name.startswith(" "):
            suite = name
        elif name.strip():
            found.append(suite + name.strip())
    return found


def selected(case, patterns):
    """GoogleTest's filter: patterns, then, after a minus, patterns that are left out."""
    wanted, _, unwanted = ":".join(patterns).partition("-")
    wanted, unwanted = ([p for p in text.split(":") if p] for text in (wanted, unwanted))
    return any(fnmatch.fnmatchcase(case, p) for p in wanted) and not any(fnmatch.fnmatchcase(case, p) for p in unwanted)


def written_cases(text):
    """Cases of a source file by their full names; those with parameters end in `/`, before the parameter's name."""
    places = re.findall(r"INSTANTIATE_TEST_SUITE_P\((\w+), (\w+)", text)
    for macro, suite, name in re.findall(r"^TEST(|_F|_P)\((\w+), (\w+)\)", text, re.MULTILINE):
        yield from ([f"{suite}.{name}"] if macro != "_P" else
                    (f"{place}/{suite}.{name}/" for place, of in places if of == suite))


def long_tests(build):
    """Everything that a part must name: (kind, name), the kind being as in holds()."""
    for path in sorted((ROOT / "tests").glob("*/*_soak.cpp")):
        for case in written_cases(path.read_text(encoding="utf-8")):
            yield f"{path.parent.name}_soak", case
    listing = subprocess.run(["ctest", "--test-dir", build, "-L", "^soak$", "--show-only=json-v1"], check=True,
                             capture_output=True, text=True).stdout
    yield from (("tests", test["name"]) for test in json.loads(listing)["tests"])
    listing = (ROOT / "tests/fuzz/CMakeLists.txt").read_text(encoding="utf-8")
    yield from (("fuzz", target) for target in re.search(r"set\(targets ([^)]*)\)", listing).group(1).split())


def built_cases(build):
    """The cases of the programs that are built, each parameter by itself."""
    for path in sorted((ROOT / build / "tests").rglob("*_soak")):
        if path.is_file():
            yield from ((path.name, case) for case in cases_in(path))


def holds(part, kind, name):
    """Whether a part runs a test; kind: "tests", "fuzz", or a program of GoogleTest. Of a case with parameters that is
    known from the sources alone: whether it runs it with one of them."""
    if kind in ("tests", "fuzz"):
        return name in part.get(kind, [])
    patterns = part.get("cases", {}).get(kind, [])
    if name.endswith("/"):
        wanted = ":".join(patterns).partition("-")[0].split(":")
        return any(fnmatch.fnmatchcase(name, p[:p.rfind("/") + 1] if p.count("/") > 1 else p) for p in wanted)
    return selected(name, patterns)


def faults(parts, all_tests):
    """One line for each test that belongs to no part or to several, and for each part that is not as it must be."""
    for part in parts:
        if not any(key in part for key in WAYS):
            yield f"{part['name']}: expected at least one of {', '.join(WAYS)}"
        if part["minutes"] > LONGEST_MIN:
            yield f"{part['name']}: {part['minutes']} min, {LONGEST_MIN} at most"
        for kind in ("tests", "fuzz"):
            yield from (f"{part['name']}: there is no test {name}" for name in part.get(kind, [])
                        if (kind, name) not in all_tests)
    for kind, name in all_tests:
        holders = [part["name"] for part in parts if holds(part, kind, name)]
        if not holders or len(holders) > 1 and not name.endswith("/"):  # parts may share a case's parameters
            yield f"{name} ({kind}): expected in one part of tests/soak.toml, got {', '.join(holders) or 'none'}"


def check(build):
    all_tests = list(long_tests(build))
    found = list(faults(all_parts(), all_tests))
    print("\n".join(found) if found else f"{len(all_tests)} long tests in {len(all_parts())} parts")
    return 1 if found else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verb", choices=["list", "run", "check"])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--names", action="store_true", dest="names_only")
    parser.add_argument("--note", action="store_true")
    parser.add_argument("--build", default="build/release")
    args = parser.parse_args()
    if args.verb == "check":
        return check(args.names[0] if args.names else args.build)
    parts = chosen(args.names)
    return show(parts, args.names_only) if args.verb == "list" else run(args.build, parts, args.note)


if __name__ == "__main__":
    sys.exit(main())
