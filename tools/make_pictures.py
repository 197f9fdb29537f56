#!/usr/bin/env python3
"""Makes the pictures of the documentation: called by tools/make_pictures.sh.

A picture is a row of tiles. A tile is a moment of a demonstration: "start", "end", or the first moment whose text in the
index of `trocar train --shots` has these words ("clip#2": the second such moment). Other pictures come from `trocar
gallery`, from the operating room, and from windows (tools/window_pictures.py).
"""
import json
import shutil
import subprocess
import sys
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = str(ROOT / "build/release/trocar")
IMAGES = ROOT / "docs/images"
WORK = ROOT / "build/pictures"

# Picture -> (size of a tile, [(exercise, moment), ...])
ROWS = {
    "camera_0": ((620, 600), [("basics/camera-0", "start"), ("basics/camera-0", "5 of 10")]),
    "camera_30": ((620, 600), [("basics/camera-30", "start"), ("basics/camera-30", "2 of 10")]),
    "clip_application": ((620, 600), [("basics/clip-application", "start")]),
    "around_the_corner": ((800, 600), [("basics/around-the-corner", "3 of")]),
    "sterilisation": ((800, 600), [("gynaecology/sterilisation", "cut")]),
    "bowel": ((480, 360), [("bowel/run-the-bowel", m) for m in ("start", "cut", "cut#2")]),
    "cholecystectomy": ((600, 450), [("cholecystectomy/clip-and-cut", m) for m in ("start", "end")]),
    "cholecystectomy_variants": ((440, 440), [(f"cholecystectomy/calot-{v}", "end")
                                              for v in ("double", "hump", "low-artery")]),
    "expose": ((360, 270), [("cholecystectomy/expose", m) for m in ("start", "Peel", "front", "back")]),
    "calot": ((480, 360), [("cholecystectomy/calot", m) for m in ("start", "duct", "end")]),
    "gallbladder_bed": ((480, 360), [("cholecystectomy/bed", "Draw"), ("cholecystectomy/bed", "end"),
                                     ("cholecystectomy/bed-scarred", "end")]),
    "gallbladder_states": ((480, 360), [("cholecystectomy/bed-inflamed", "start"),
                                        ("cholecystectomy/bed-scarred", "start"),
                                        ("cholecystectomy/bed-scarred", "end")]),
    "operation": ((400, 300), [("cholecystectomy/operation", m) for m in ("clip", "bed", "bag", "end")]),
    "haemorrhage": ((420, 420), [("cholecystectomy/haemorrhage", m) for m in ("start", "clip", "end")]),
    "double_throw": ((600, 500), [("suturing/double-throw", m) for m in ("throw", "end")]),
    "surgeons_knot": ((500, 500), [("suturing/intracorporeal-suture", m) for m in ("throw", "end")]),
    "endoloop": ((400, 400), [("suturing/ligating-loop", m) for m in ("start", "loop", "end")]),
}
GALLERY = {  # picture -> (size of a tile, tiles in a row, [(scene, name of the picture)])
    "fluids_in_view": ((480, 360), 3, [("bleeding", n) for n in ("bleeding jet", "bleeding film", "bleeding pool",
                                                                 "fogged lens", "wiping the lens", "wiped lens")]),
    "pictures": ((480, 360), 3, [("sterilisation", n) for n in ("endoscope", "tube_left fold", "tube_left fimbria")] +
                 [("sterilisation", n) for n in ("grasper", "burn", "bleeding jet")] +
                 [("sterilisation", "coagulation"), ("gallbladder", "endoscope"), ("cutting", "liver cut")]),
}
ROOMS = {"operating_room": ["room", "telemanipulated", "pose"]}
FILM = ("cholecystectomy/clip-and-cut", 20, 4_000_000)  # exercise, seconds, most bytes


def run(*words):
    print("  " + " ".join(str(w) for w in words), flush=True)
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):  # 1: the demonstration did not pass; its pictures are there
        raise RuntimeError(f"{words[0]}: exit {done.returncode}: {done.stderr.strip()[-400:]}")


def clean(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def shots_of(exercise):
    """The folder of a demonstration's recording and pictures, made again when the program is newer."""
    folder = WORK / "shots" / exercise
    newer = (folder / "shots/index.json").exists() and (folder / "a.rec").stat().st_mtime > Path(PROGRAM).stat().st_mtime
    if not newer:
        run(PROGRAM, "train", exercise, "--input", "demo", "--headless", "--no-store", "--size", "800x600",
            "--record", clean(folder) / "a.rec", "--shots", folder / "shots")
    return folder


def moment_file(exercise, moment):
    folder = shots_of(exercise) / "shots"
    pictures = json.loads((folder / "index.json").read_text(encoding="utf-8"))["pictures"]
    if moment in ("start", "end"):
        return folder / pictures[0 if moment == "start" else -1]["file"]
    words, _, number = moment.partition("#")
    found = [p for p in pictures if words.lower() in p["shows"].lower()]
    if len(found) < int(number or 1):
        known = "; ".join(p["shows"] for p in pictures)
        raise RuntimeError(f"{exercise} has no moment '{moment}': {known}")
    return folder / found[int(number or 1) - 1]["file"]


def gallery_file(scene, name):
    folder = WORK / "gallery" / scene / name.replace(" ", "-")
    run(PROGRAM, "gallery", clean(folder), "--scene", scene, "--only", name, "--size", "800x600")
    return sorted(folder.rglob("*.png"))[0]


def fitted(file, size):
    """The middle of a picture, in a tile's shape."""
    picture = Image.open(file).convert("RGB")
    scale = max(size[0] / picture.width, size[1] / picture.height)
    picture = picture.resize((round(picture.width * scale), round(picture.height * scale)), Image.LANCZOS)
    left, top = (picture.width - size[0]) // 2, (picture.height - size[1]) // 2
    return picture.crop((left, top, left + size[0], top + size[1]))


def save_row(name, size, files, across=None):
    across = across or len(files)
    whole = Image.new("RGB", (size[0] * across, size[1] * ((len(files) + across - 1) // across)))
    for i, file in enumerate(files):
        whole.paste(fitted(file, size), (size[0] * (i % across), size[1] * (i // across)))
    whole.save(IMAGES / f"{name}.jpg", quality=88)


def make_row(name):
    size, tiles = ROWS[name]
    save_row(name, size, [moment_file(*tile) for tile in tiles])


def make_gallery(name):
    size, across, tiles = GALLERY[name]
    save_row(name, size, [gallery_file(*tile) for tile in tiles], across)


def make_room(name):
    folder = clean(WORK / "rooms" / name)
    run(PROGRAM, *ROOMS[name], "--shots", folder, "--size", "960x600")
    save_row(name, (960, 600), sorted(folder.rglob("*.png"))[:1])


def make_film():
    """The moments of a demonstration one after the other, as an animated picture of limited size."""
    exercise, seconds, most = FILM
    folder = shots_of(exercise) / "shots"
    moments = {p["seconds"]: folder / p["file"]
               for p in json.loads((folder / "index.json").read_text(encoding="utf-8"))["pictures"]}
    frames = [fitted(file, (420, 420)) for _, file in sorted(moments.items())]
    file = IMAGES / "film.webp"
    frames[0].save(file, save_all=True, append_images=frames[1:], duration=1000 * seconds // len(frames), loop=0,
                   quality=70)
    if file.stat().st_size > most:
        raise RuntimeError(f"the film has {file.stat().st_size} bytes: at most {most}")


def make_windows():
    from window_pictures import make_all
    make_all(PROGRAM, IMAGES)


def recipes():
    known = {name: lambda n=name: make_row(n) for name in ROWS}
    known.update({name: lambda n=name: make_gallery(n) for name in GALLERY})
    known.update({name: lambda n=name: make_room(n) for name in ROOMS})
    known.update(film=make_film, windows=make_windows)
    return known


def main():
    known = recipes()
    if sys.argv[1:] == ["--list"]:
        print("\n".join(known))
        return 0
    unknown = [name for name in sys.argv[1:] if name not in known]
    if unknown:
        print(f"make_pictures: unknown: {', '.join(unknown)}; known: {', '.join(known)}", file=sys.stderr)
        return 2
    failed = 0
    for name in sys.argv[1:] or known:
        print(name, flush=True)
        try:
            known[name]()
        except (RuntimeError, OSError, subprocess.CalledProcessError) as error:
            failed += 1
            print(f"make_pictures: {name}: {error}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
