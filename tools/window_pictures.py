"""Pictures of the real windows for the documentation: mouse and keys by xdotool on the display that is there.

tools/make_pictures.sh calls make_all(); a picture that cannot be made is reported and the others are still made.
TROCAR_PICTURES_CT names a scan (a file of a series, NIfTI, NRRD or MetaImage) for the pictures of a CT; without it
those are left as they are.
"""
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "app"))
from trainee import Eyes, Failed, MouseAndKeys, xdo  # noqa: E402

SIZE = "1280x720"
PERSON = "Anna Muster"
PICTURES_OF_TILES = 200  # [s] they are drawn one after the other


class Window:
    """A program with a window, its log, and hands at mouse and keys."""

    def __init__(self, program, folder, words, images):
        log = Path(folder) / f"log-{time.monotonic_ns()}.jsonl"
        environment = dict(os.environ, TROCAR_DATA=str(Path(folder) / "data"), BROWSER="true", HOME=str(folder))
        self.process = subprocess.Popen([program, *words, "--log", str(log)], cwd=folder, env=environment)
        self.eyes, self.images = Eyes(str(log), self.process), images
        self.hands = MouseAndKeys(self.eyes)

    def shot(self, name, wait=1.0):
        time.sleep(wait)
        subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-f", "x11grab", "-i", os.environ["DISPLAY"], "-frames:v",
                        "1", str(self.images / f"{name}.png")], check=True)
        print(f"  {name}.png", flush=True)

    def runs(self, ticks, limit=600):
        """Waits until so much of the attempt has passed; what is told before the first one is closed."""
        def there():
            if (self.eyes.screen or {}).get("name") == "hint":
                self.hands.press("Begin")
                time.sleep(2)
            return self.eyes.pose and self.eyes.pose["tick"] > ticks
        self.eyes.wait(f"{ticks} ms of the attempt", there, limit)

    def menu(self, menu, item):
        self.hands.press(f"menu {menu}")
        self.hands.press(item)

    def type_into(self, field, text):
        self.hands.press(field)
        xdo("key", "ctrl+a")
        time.sleep(0.4)
        xdo("type", "--delay", "30", text)
        time.sleep(0.4)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()


def operation_pictures(program, folder, images):
    """Person, exercises, an exercise's page, the exercise, its result."""
    with Window(program, folder, ["train", "--size", SIZE], images) as w:
        w.eyes.on("person", 120)
        w.type_into("Name", PERSON)
        w.shot("window_person")
        w.hands.press("Add")
        w.eyes.where("basics/camera-0", 60)
        w.shot("window_start", PICTURES_OF_TILES)
        w.hands.press("basics/camera-0")
        w.eyes.where("Start", 120)
        w.shot("window_details", 4)
        w.hands.press("Start", 120)
        w.runs(300)
        w.hands.look(0.05, 0.05, 0.012)
        w.shot("window_exercise", 2)
    with Window(program, folder, ["train", "basics/camera-0", "--input", "demo", "--trainee", PERSON, "--size", SIZE],
                images) as w:
        w.runs(300)
        w.eyes.on("result", 180)
        w.shot("window_result", 2)
    with Window(program, folder, ["train", "cholecystectomy/clip-and-cut", "--input", "demo", "--size", SIZE],
                images) as w:
        w.runs(18500, 1200)
        w.shot("window_operation")


def modeller_pictures(program, folder, images):
    with Window(program, folder, ["model"], images) as w:
        w.eyes.on("start", 60)
        w.shot("window_modeller_start")
        w.hands.press("New organ")
        w.eyes.wait("a good build", lambda: any(e["good"] for e in w.eyes.happened("built")), 90)
        solid = next(name for name in w.eyes.screen["widgets"] if name.startswith("solid:"))
        w.hands.press(solid)
        xdo("key", "f")
        w.shot("window_modeller", 3)


def operate_picture(program, folder, images, words, name):
    """A scene of one's own in the trainer."""
    with Window(program, folder, ["train", *words, "--size", SIZE], images) as w:
        w.runs(500)
        w.shot(name, 2)


def made_operate_pictures(program, folder, images):
    operate_picture(program, folder, images, ["modelling/uterus"], "window_operate")


def ct_pictures(program, folder, images):
    scan = os.environ.get("TROCAR_PICTURES_CT", "")
    if not scan:
        print("  no CT: TROCAR_PICTURES_CT names none")
        return
    name = "scan" + "".join(Path(scan).suffixes[-2:])
    (Path(folder) / name).symlink_to(scan)
    with Window(program, folder, ["model"], images) as w:
        w.eyes.on("start", 60)
        w.hands.press("Open a scan")
        w.hands.press(name)
        w.hands.press("Open")
        w.eyes.where("5 Grow", 120)
        w.shot("window_ct", 8)


def make_all(program, images):
    failed = []
    for make in (modeller_pictures, ct_pictures, made_operate_pictures, operation_pictures):
        with tempfile.TemporaryDirectory() as folder:
            try:
                make(program, folder, images)
            except (Failed, StopIteration, subprocess.SubprocessError) as failure:
                failed.append(f"{make.__name__}: {failure}")
    if failed:
        raise RuntimeError("; ".join(failed))
