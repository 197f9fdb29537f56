#!/usr/bin/env python3
"""Opens DICOM folders in the modeller's real window that hold more than one volume: the user chooses a series from a list,
then another phase, and what was drawn stays.

    tools/with_xvfb.sh 1400x900 python3 tests/app/scan_choice_test.py PATH/TO/trocar

MODELLER_PICTURES=FOLDER keeps a picture of each step. Exit: 0 passed, 1 failed, 77 something is missing.
"""
import os
import shutil
import struct
import sys
import tempfile
import time
from pathlib import Path

from modeller_test import Modeller, check, shown
from trainee import Failed

LONG = ("OW",)


def element(tag, vr, value):
    if isinstance(value, str):
        value = value.encode() + (b"" if len(value) % 2 == 0 else b"\0" if vr == "UI" else b" ")
    elif isinstance(value, int):
        value = struct.pack("<H", value)
    head = struct.pack("<HH", tag >> 16, tag & 0xffff) + vr.encode()
    return head + (b"\0\0" + struct.pack("<I", len(value)) if vr in LONG else struct.pack("<H", len(value))) + value


def slice_file(number, height, acquisition, value, size=16):
    """A CT slice all of whose pixels have one value [HU]."""
    meta = (element(0x00020002, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(0x00020003, "UI", f"1.2.3.{number}") +
            element(0x00020010, "UI", "1.2.840.10008.1.2.1"))
    rows = [(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2"), (0x00080018, "UI", f"1.2.3.{number}"),
            (0x00080060, "CS", "CT"), (0x0008103e, "LO", "Abdomen"), (0x00180050, "DS", "2"), (0x0020000e, "UI", "1.2.9"),
            (0x00200012, "IS", str(acquisition)), (0x00200013, "IS", str(number)), (0x00200032, "DS", f"0\\0\\{height}"),
            (0x00200037, "DS", "1\\0\\0\\0\\1\\0"), (0x00280002, "US", 1), (0x00280004, "CS", "MONOCHROME2"),
            (0x00280010, "US", size), (0x00280011, "US", size), (0x00280030, "DS", "2\\2"), (0x00280100, "US", 16),
            (0x00280101, "US", 16), (0x00280102, "US", 15), (0x00280103, "US", 0), (0x00281052, "DS", "-1024"),
            (0x00281053, "DS", "1"), (0x7fe00010, "OW", struct.pack("<H", 1024 + value) * size * size)]
    return b"\0" * 128 + b"DICM" + meta + b"".join(element(*row) for row in rows)


def write_series(folder, acquisitions):
    """acquisitions: (slices, value [HU]) of each."""
    folder.mkdir()
    number = 0
    for acquisition, (slices, value) in enumerate(acquisitions, 1):
        for k in range(slices):
            number += 1
            (folder / f"IM{number:03}.dcm").write_bytes(slice_file(number, 2 * k, acquisition, value))


def open_scan(m, path):
    m.menu("Scan", "Open scan ...")
    m.fill("file name", str(path))
    m.hands.press("Open")


def said(m, start, count, limit=60):
    m.eyes.wait(f"a line that begins with {start}",
                lambda: len([e for e in m.eyes.happened("scan") if e["said"].startswith(start)]) >= count, limit)
    return [e for e in m.eyes.happened("scan") if e["said"].startswith(start)][-1]["said"]


def session(m, folder):
    write_series(folder / "unlike", [(12, 40), (8, 160)])
    write_series(folder / "phases", [(10, 40), (10, 160)])
    m.eyes.on("start", 180)
    m.hands.press("New scene")
    # The disc's list stands for its folder, of which neither acquisition is the whole.
    meta = element(0x00020002, "UI", "1.2.840.10008.1.3.10") + element(0x00020010, "UI", "1.2.840.10008.1.2.1")
    (folder / "unlike" / "DICOMDIR").write_bytes(b"\0" * 128 + b"DICM" + meta + element(0x00041130, "CS", "DISC"))
    open_scan(m, folder / "unlike" / "DICOMDIR")
    m.eyes.where("series 2", 60)
    shown("series")
    m.hands.press("series 2")
    check(said(m, "16 x 16 x 8", 1), "the second acquisition")

    open_scan(m, folder / "phases" / "IM001.dcm")
    line = said(m, "16 x 16 x 10", 1)
    check("2 time points or phases" in line and "number 0 is read" in line, line)
    m.hands.press("4 Threshold")
    m.hands.press("Apply")
    said(m, "Threshold", 1)
    shown("phase_0")
    m.hands.press("time point")
    m.hands.press("time point 1")
    line = said(m, "16 x 16 x 10", 2)
    check("number 1 is read" in line, line)
    time.sleep(1)
    shown("phase_1")
    m.hands.press("Largest part")
    line = said(m, "Largest part", 1)
    check("20.48 mL" in line, f"the segment of the other phase stays: {line}")


def main():
    if len(sys.argv) != 2 or not os.environ.get("DISPLAY") or not shutil.which("xdotool"):
        print("no display or no xdotool: skipped")
        return 77
    folder = tempfile.mkdtemp(prefix="trocar-scan-choice-")
    try:
        m = Modeller(os.path.abspath(sys.argv[1]), folder)
        try:
            session(m, Path(folder))
        except Failed:
            shown("failed")
            raise
        finally:
            m.kill()
    except Failed as failed:
        print(f"FAILED: {failed}")
        return 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print("passed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
