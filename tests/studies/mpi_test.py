"""The tolerance study over MPI: four ranks say the same numbers as one, bit by bit, and as any number of threads.

    mpi_test.py PROGRAM      exit 77 (skipped) where the program was not built or mpirun is missing
"""
import json
import os
import shutil
import subprocess
import sys

PROGRAM = sys.argv[1]
STUDY = ["grasper", "--frame", "tip_upper", "--drive", "handle=0.5", "--plus-minus-um", "10", "--samples", "20001",
         "--within", "50"]


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def over(ranks, *words):
    command = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-np", str(ranks)]
    if os.geteuid() == 0:
        command.insert(1, "--allow-run-as-root")
    return subprocess.run(command + [PROGRAM, *words], capture_output=True, text=True, timeout=120)


def numbers(*words, ranks):
    done = over(ranks, *STUDY, *words)
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    assert said.pop("ranks") == ranks, said
    said.pop("seconds")
    return said


if not os.path.exists(PROGRAM):
    skip("trocar_study_mpi is not built: MPI was not found (libopenmpi-dev)")
if shutil.which("mpirun") is None:
    skip("mpirun is missing (openmpi-bin)")

one, four, threads = numbers(ranks=1), numbers(ranks=4), numbers("--threads", "3", ranks=2)
assert one["samples"] == 20001 and one["open"] == 0, one
assert one == four, (one, four)
assert one == threads, (one, threads)
assert one["bits"] != numbers("--seed", "2", ranks=4)["bits"]

wrong = over(2, "grasper", "--frame", "toe", "--plus-minus-um", "10")
assert wrong.returncode == 2 and wrong.stderr.count("expected a known frame") == 1, wrong
print("one, two and four ranks say the same bits")
