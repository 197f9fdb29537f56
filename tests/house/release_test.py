#!/usr/bin/env python3
"""The release script refuses what does not fit together, and the versions that stand in the checkout do."""
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FILES = ["CMakeLists.txt", "CITATION.cff", "codemeta.json", "CHANGELOG.md", "packaging/org.trocar.Trocar.metainfo.xml",
         "tools/release.sh"]


def git(root, *words):
    subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], cwd=root, check=True, capture_output=True)


def check(root, version):
    done = subprocess.run([root / "tools/release.sh", "--check", version], capture_output=True, text=True)
    return done.returncode, done.stderr


version = re.search(r"project\(trocar VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
with tempfile.TemporaryDirectory() as folder:
    root = Path(folder)
    for name in FILES:
        (root / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, root / name)
    git(root, "init", "-q")
    git(root, "add", ".")
    git(root, "commit", "-qm", "all")
    code, text = check(root, version)
    assert code == 0, text
    code, text = check(root, "9.9.9")
    assert code == 1 and text.count("\n") == 5, text
    (root / "CITATION.cff").write_text("version: 0\n")
    code, text = check(root, version)
    assert code == 1 and "commit first" in text and "CITATION.cff has another version" in text, text
    assert check(root, "1.0")[0] == 2
print("passed")
