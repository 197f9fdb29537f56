#!/usr/bin/env python3
"""Proof that the checks in tools/ can fail: each is fed what it forbids, in a folder made for the purpose.

    tools_test.py [CASE...]      without a name: all. Exit 77: something the case needs is missing (said what).
"""
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / "tools"


def tool(name, *arguments):
    done = subprocess.run([sys.executable, TOOLS / name, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def put(root, path, text):
    (root / path).parent.mkdir(parents=True, exist_ok=True)
    (root / path).write_text(text)


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def LayerCheckFindsEachFault():
    faults = {  # path: (line that must be found, part of the message)
        "tissue/a.cpp": ("#include <trocar/vessels/x.hpp>", "tissue may not include vessels"),
        "core/a.hpp": ("#include <trocar/numerics/vec3.hpp>", "core may not include numerics"),
        "view/a.cpp": ("#include <trocar/training/x.hpp>", "view may not include training"),
        "training/a.cpp": ("  #  include <trocar/devices/x.hpp>", "training may not include devices"),
        "attempt/a.cpp": ("#include <trocar/view/x.hpp>", "attempt may not include view"),
        "attempt/b.cpp": ("#include <trocar/render/x.hpp>", "attempt may not include render"),
        "pictures/a.cpp": ("#include <trocar/reports/x.hpp>", "pictures may not include reports"),
        "view/b.cpp": ("#include <epoxy/gl.h>", "render, app only"),
        "attempt/c.cpp": ("#include <GLFW/glfw3.h>", "render, app only"),
        "attempt/d.cpp": ("#include <imgui.h>", "render, pictures, modeller, app only"),
        "sim/a.cpp": ("#include <nlohmann/json.hpp>", "core, scene, training, app only"),
        "sim/b.cpp": ("double a = std::sin(1.0);", "trocar::portable"),
        "tissue/b.cpp": ("float a = powf(x, 2);", "libm"),
        "collision/a.cpp": ("double a = ::exp(x);", "libm"),
        "scene/a.cpp": ("auto a = std::pow(x, 2);", "trocar::portable"),
        "sim/c.hpp": ("#include <chrono>", "clocks"),
        "sim/d.hpp": ("#include <random>", "libraries"),
        "tissue/c.cpp": ("std::unordered_map<int, int> m;", "iteration order"),
        "numerics/a.hpp": ("#include <iostream>", "prints"),
        "sim/e.cpp": ("auto s = std::reduce(a.begin(), a.end());", "summation"),
        "vessels/a.cpp": ("std::atomic<double> sum;", "additions"),
        "geometry/a.hpp": ('#include "mesh.hpp"', "must be visible"),
        "training/b.cpp": ("#include <ranges>", "libc++"),
        "nowhere/a.cpp": ("int x;", "not in the table"),
    }
    harmless = ("// std::sin(x), #include <chrono>\n/* std::pow(1, 2)\n*/\n#include <cmath>\n"
                "const char* s = \"std::sin(1)\";\nint big = 1'000'000;\n"
                "double r = std::sqrt(big) + portable::sin(2.0);\n")
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        put(root, "src/trocar/tissue/harmless.cpp", harmless)
        put(root, "src/trocar/sim/good.cpp", "#include <trocar/tissue/harmless.hpp>\n")
        put(root, "app/main.cpp", "#include <chrono>\n#include <imgui.h>\n#include <trocar/view/x.hpp>\n")
        code, text = tool("check_layers.py", root)
        expect(code == 0, f"clean files were refused: {text}")
        for path, (line, _) in faults.items():
            put(root, f"src/trocar/{path}", f"// one\n// two\n{line}\n")
        code, text = tool("check_layers.py", root)
        expect(code == 1, "faults were accepted")
        for path, (line, message) in faults.items():
            number = 1 if path.startswith("nowhere") else 3
            hits = [t for t in text.splitlines() if t.startswith(f"src/trocar/{path}:{number}: ")]
            expect(any(message in t for t in hits), f"{path}: '{line}' was not found, output:\n{text}")
        expect("harmless" not in text, f"a harmless line was refused:\n{text}")
    with tempfile.TemporaryDirectory() as folder:
        expect(tool("check_layers.py", folder)[0] == 1, "a folder without sources passed")
    circles_are_found()
    full_rooms_are_found()


def circles_are_found():
    """Rooms of one folder, and folders of the program, that include each other: two, three, and none by comments."""
    def check(**files):
        with tempfile.TemporaryDirectory() as folder:
            for name, other in files.items():
                room = name.replace("_", "/")
                line = f'#include "{other[4:]}/x.hpp"' if other.startswith("app/") else f"#include <trocar/{other}/x.hpp>"
                put(Path(folder), f"{room}/a.cpp" if room.startswith("app/") else f"src/trocar/{room}/a.cpp", f"\n{line}\n")
            put(Path(folder), "src/trocar/tissue/network/b.cpp", "// #include <trocar/tissue/heat/x.hpp>\n")
            return tool("check_layers.py", folder)

    code, text = check(tissue_heat="tissue/network", tissue_strand="tissue/network", sim_stages="tissue/heat")
    expect(code == 0, f"rooms without a circle were refused: {text}")
    code, text = check(tissue_heat="tissue/network", tissue_network="tissue/heat")
    expect(code == 1 and "rooms include each other in a circle" in text and
           "trocar/tissue/heat -> trocar/tissue/network (src/trocar/tissue/heat/a.cpp:2)" in text and
           "trocar/tissue/network -> trocar/tissue/heat (src/trocar/tissue/network/a.cpp:2)" in text,
           f"a circle of two rooms passed: {text}")
    code, text = check(tissue_heat="tissue/network", tissue_network="tissue/strand", tissue_strand="tissue/heat")
    expect(code == 1 and text.count(" -> ") == 3, f"a circle of three rooms passed: {text}")
    code, text = check(app_shell="app/player", app_player="app/shell")
    expect(code == 1 and "shell -> player (app/shell/a.cpp:2)" in text, f"a circle in the program passed: {text}")
    code, text = check(app_shell="app/shell")
    expect(code == 0, f"a room that includes itself was refused: {text}")


def full_rooms_are_found():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for i in range(40):
            put(root, f"src/trocar/view/anatomy/part_{i}.hpp", "int x;\n")
        put(root, "src/trocar/view/base/part.hpp", "int x;\n")
        code, text = tool("check_layers.py", root)
        expect(code == 0, f"a room of 40 files was refused: {text}")
        put(root, "src/trocar/view/anatomy/one_more.cpp", "int y;\n")
        code, text = tool("check_layers.py", root)
        expect(code == 1 and "trocar/view/anatomy: 41 files in one room, at most 40" in text,
               f"a room of 41 files passed: {text}")


def EquationCheckFindsEachFault():
    def check(doc, src, test):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            put(root, "docs/science/equations.md", doc)
            put(root, "src/trocar/tissue/a.cpp", src)
            put(root, "tests/tissue/a_test.cpp", test)
            return tool("check_equations.py", root)

    a, b = "[KCM99 eq.1]", "[KCM99 eq.2]"
    expect(check(a, f"// {a}", f"// {a}")[0] == 0, "a complete set was refused")
    expect("src/" in check(a, "", a)[1] and check(a, "", a)[0] == 1, "an equation without code passed")
    expect("tests/" in check(a, a, "")[1] and check(a, a, "")[0] == 1, "an equation without test passed")
    expect(check(a, f"{a} {b}", f"{a} {b}")[0] == 1, "an unlisted equation passed")
    expect(check(a, f"{a} [KCM99 eqs. 2-4]", a)[0] == 1, "a badly written tag passed")
    c = "[PT97 A2.1] [PT97 eq.4.8]"
    expect(check(c, c, c)[0] == 0, "a book's algorithm and a chapter's equation were refused")
    expect("[PT97 A2.1] does not occur in tests/" in check(c, c, "[PT97 eq.4.8]")[1], "an algorithm without test passed")
    expect("[PT97 eq.4.8] does not occur in src/" in check(c, "[PT97 A2.1]", c)[1], "a chapter's equation without code passed")
    expect(check("", "", "")[0] == 1, "an empty list passed")
    with tempfile.TemporaryDirectory() as folder:
        expect(tool("check_equations.py", folder)[0] == 1, "a missing page passed")


def NamedCheckFindsEachFault():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        expect(tool("check_named.py", root)[0] == 1, "a checkout without pages passed")
        put(root, "tests/tissue/a_test.cpp", "TEST(Strand, Sags) {}\nTEST_P(Strand, Swings) {}")
        put(root, "src/trocar/tissue/strand/strand.hpp", "")
        put(root, "docs/science/a.md", "`Strand.Sags` `Bodies/Strand.*` `Strand.S*gs` `strand/strand.hpp` `verbs/NAME.hpp`")
        expect(tool("check_named.py", root)[0] == 0, "names of tests and files that exist were refused")
        for bad in ("`Strand.Sinks`", "`Cord.*`", "`strand/cord.hpp`"):
            put(root, "docs/science/b.md", f"one\n\n{bad}")
            code, text = tool("check_named.py", root)
            expect(code == 1 and "docs/science/b.md:3: there is no" in text, f"{bad} passed: {text}")


def ObjectCodeCheckFindsEachFault():
    if platform.machine() not in ("x86_64", "AMD64"):
        print("not an x86-64 machine")
        sys.exit(77)
    compiler = os.environ.get("CXX") or shutil.which("c++")
    cases = {
        "float f(float a, float b, float c) { return __builtin_fmaf(a, b, c); }": "vfmadd",
        "#include <immintrin.h>\n__m128 f(__m128 a) { return _mm_rsqrt_ps(a); }": "rsqrtps",
        "#include <immintrin.h>\n__m128 f(__m128 a) { return _mm_rcp_ss(a); }": "rcpss",
        "#include <cmath>\ndouble f(double a) { return std::sin(a); }": "calls sin",
        "#include <cmath>\nfloat f(float a) { return std::pow(a, 1.1f); }": "calls powf",
    }
    fine = "#include <cmath>\ndouble f(double a, double b) { return std::sqrt(a * b + 1) / (a + std::floor(b)); }"
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "a.cpp"), Path(folder, "a.o")

        def compiled(text):
            source.write_text(text)
            subprocess.run([compiler, "-O2", "-std=c++20", "-ffp-contract=off", "-fno-math-errno", "-march=x86-64-v3",
                            "-c", source, "-o", target], check=True)
            return tool("check_step_object_code.py", target)

        code, text = compiled(fine)
        expect(code == 0, f"harmless code was refused: {text}")
        for body, message in cases.items():
            code, text = compiled(body)
            expect(code == 1 and message in text, f"'{message}' was not found in:\n{body}\noutput: {text}")
        expect(compiled("int x;")[0] == 1, "a file without code passed")

        shared = ("inline __attribute__((noinline)) int g(int a) { return a * a; }\n"
                  "int f(int a) { return g(a) + g(a + 1); }")
        expect(compiled(shared)[0] == 0, "an inline function in an ordinary file was refused")
        target = Path(folder, "kernel_avx2.cpp.o")
        code, text = compiled(shared)
        expect(code == 1 and "g(int) is shared" in text, f"a shared inline function of a wide kernel passed: {text}")


def EmptyTestExecutableIsFound():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)

        def executable(name, listing):
            put(root, name, f"#!/bin/sh\nprintf '{listing}'\n")
            (root / name).chmod(0o755)
            return root / name

        full = executable("tissue_test", "Network.\\n  Holds\\n")
        empty = executable("vessels_test", "")
        off = executable("sim_test", "Step.\\n  DISABLED_Holds\\n")
        expect(tool("check_tests.py", "--modules", "tissue", "--executables", full)[0] == 0, "a good one was refused")
        for bad in (empty, off):
            expect(tool("check_tests.py", "--executables", full, bad)[0] == 1, f"{bad.name} passed")
        expect(tool("check_tests.py", "--modules", "tissue", "core", "--executables", full)[0] == 1,
               "a module without tests passed")


def LinkCheckFindsEachFault():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        expect(tool("check_links.py", root)[0] == 1, "a folder without pages passed")
        put(root, "docs/a.md", "[up](../README.md#top) [out](https://example.org/x) `tests/<folder>/x`")
        put(root, "README.md", "# Top\n[a](docs/a.md) `docs/a.md` and `docs/a` and `docs/`\n```\n[b](docs/b.md)\n```\n")
        code, text = tool("check_links.py", root)
        expect(code == 0, f"good links were refused: {text}")
        for bad in ("[b](docs/b.md)", "![b](docs/images/b.png)", "`tools/b.py`", "[a](docs/a.md#nowhere)", "[top](#top)"):
            put(root, "README.md", f"one\n{bad}\n")
            code, text = tool("check_links.py", root)
            expect(code == 1 and text.startswith("README.md:2: "), f"{bad} passed: {text}")


FAKE_PROGRAM = """#!/bin/sh
[ "$1" = --help ] && printf 'Subcommands:\\n  train   Trains\\n' && exit 0
[ "$1" = train ] && printf '  --seed N   anatomy\\n  --help\\n' && exit 0
exit 2
"""


def CommandBlockCheckFindsEachFault():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        program = root / "trocar"
        put(root, "trocar", FAKE_PROGRAM)
        program.chmod(0o755)
        page = root / "page.md"

        def check(*lines):
            page.write_text("\n".join(["# Page", *lines, ""]), encoding="utf-8")
            return tool("check_commands.py", program, page)

        for good in ("trocar train x --seed 3", "trocar train \\\n  --seed=3  # words --that are no options",
                     "tools/docs.sh", "cat > f <<'END'\ntrocar repot\nEND", "ls | trocar train"):
            code, text = check("```sh window", good, "```")
            expect(code == 0, f"{good} was refused: {text}")
        expect(check("```text", "trocar repot", "```")[0] == 0, "a block that is no command was looked at")
        for bad in ("trocar repot", "trocar train --sed 3", "trocar train x && trocar repot", "tools/dogs.sh"):
            code, text = check("```sh window", bad, "```")
            expect(code == 1 and text.startswith("page.md:2: "), f"{bad} passed: {text}")


def LanguageCheckFindsEachFault():
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        def faults():
            code, text = tool("check_language.py", "--root", root)
            return text if code else ""
        expect("nothing to read" in faults(), "a folder without texts passed")
        put(root, "docs/glossary.md", "| term | meaning |\n|---|---|\n| CT | computed tomography |\n")
        put(root, "README.md", "A CT is a scan. See [here](" + 130 * "x" + ") and `what is be it`.\n\n"
            "```\nTime stands still in code, and a line of code may be long: " + 130 * "y" + "\n```\n")
        put(root, "scenes/a.json", '{"key with doubts": 1, // a comment comes off\n "title": "Hold it still"}')
        put(root, "src/a.cpp", '// nobody is told\nauto x = f("Paused now", "ours");\n')
        put(root, "docs/log/old.md", "Whoever comes off is told.\n")
        expect(not faults(), f"good texts were refused: {faults()}")
        bad = [("README.md", "word " * 41 + "\n", "README.md:1: a sentence of 41 words"),
               ("README.md", "One.\n" + 121 * "z" + "\n", "README.md:2: a line of 121 characters"),
               ("README.md", "| a | " + 201 * "z" + " |\n", "README.md:1: a table cell of 201"),
               ("README.md", "An MRI, too.\n", "README.md:1: MRI: explain it"),
               ("README.md", "One line\nand it hangs\nstill there.\n", "README.md:2: \"hangs still\""),
               ("README.md", "What is held is seen.\n", "README.md:1: \"What is ...\""),
               ("scenes/a.json", '{\n"hint": "time stands still"}', "scenes/a.json:2: \"time stands still\""),
               ("src/a.cpp", '\nf("this peel "\n  "comes off");', "src/a.cpp:2: \"comes off\""),
               ("src/a.html", "<p>Ways of the tips</p>", "src/a.html:1: \"Ways of the tips\""),
               ("run.sh", 'echo "go on"', "run.sh:1: \"go on\"")]
        for path, text, fault in bad:
            before = (root / path).read_text() if (root / path).exists() else ""
            put(root, path, text)
            expect(fault in faults(), f"{text!r} passed: {faults()}")
            put(root, path, before)
        put(root, "README.md", "Who reads is told.\n")
        put(root, "tools/language_exceptions.txt", "README.md: Who reads is told.\n")
        expect(not faults(), f"an exception was refused: {faults()}")
        put(root, "README.md", "All is well.\n")
        expect("not needed" in faults(), "an exception that is not needed passed")
        put(root, "tools/language_exceptions.txt", "".join(f"README.md: {i}\n" for i in range(21)))
        expect("21 exceptions: at most 20" in faults(), "too many exceptions passed")


def SoakCheckFindsEachFault():
    sys.path.insert(0, str(TOOLS))
    from soak import faults, selected, written_cases  # noqa: PLC0415
    good = [{"name": "a", "minutes": 45, "cases": {"sim_soak": ["Abuse.*:Seeds/Suture.*/1?", "-Abuse.Long"]}},
            {"name": "b", "minutes": 1, "tests": ["app.kills"], "fuzz": ["scene"], "cases": {"sim_soak": ["Abuse.Long"]}}]
    long_tests = [("sim_soak", "Abuse.Short"), ("sim_soak", "Abuse.Long"), ("sim_soak", "Seeds/Suture.Is/12"),
                  ("sim_soak", "Seeds/Suture.Is/"), ("tests", "app.kills"), ("fuzz", "scene")]
    expect(not list(faults(good, long_tests)), "good parts were refused")
    for bad in (("sim_soak", "Other.Case"), ("sim_soak", "Seeds/Other.Is/"), ("sim_soak", "Seeds/Suture.Is/2"), ("tests", "app.more"), ("fuzz", "urdf")):
        expect(list(faults(good, long_tests + [bad])), f"{bad} belongs to no part and passed")
    expect(list(faults(good + good[1:], long_tests)), "a test of two parts passed")
    expect(list(faults(good, long_tests[:4])), "a test that is not there passed")
    expect(list(faults([dict(good[0], minutes=46), good[1]], long_tests)), "a part that takes too long passed")
    expect(list(faults(good + [{"name": "c", "minutes": 1}], long_tests)), "a part without anything passed")
    expect(list(written_cases("TEST(A, Is) {}\n  TEST(No, Is)\nTEST_P(B, Does) {}\nINSTANTIATE_TEST_SUITE_P(Seeds, B, 1);\n"))
           == ["A.Is", "Seeds/B.Does/"], "cases of a source were not found")
    expect(selected("A.b", ["*", "-A.*"]) is False and selected("B.b", ["*", "-A.*"]), "a filter's minus was not obeyed")


CASES = [LayerCheckFindsEachFault, EquationCheckFindsEachFault, ObjectCodeCheckFindsEachFault,
         EmptyTestExecutableIsFound, LinkCheckFindsEachFault, CommandBlockCheckFindsEachFault, LanguageCheckFindsEachFault,
         NamedCheckFindsEachFault, SoakCheckFindsEachFault]

if __name__ == "__main__":
    wanted = sys.argv[1:] or [c.__name__ for c in CASES]
    for case in CASES:
        if case.__name__ in wanted:
            case()
            print(f"{case.__name__}: passed")
            wanted.remove(case.__name__)
    expect(not wanted, f"no such case: {wanted}")
