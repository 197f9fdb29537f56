#!/usr/bin/env python3
"""Pictures and films of a recording without a window, checked with ffprobe.

    python3 tests/app/replay_video_test.py PATH/TO/trocar

Exit: 0 passed, 1 failed, 77 ffmpeg or ffprobe is missing.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time

SECONDS = 1.4


def run(program, *words, **options):
    return subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=300, **options)


def expect(condition, what):
    if not condition:
        print(f"FAILED: {what}")
        sys.exit(1)


def probe(path):
    out = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries",
                          "stream=codec_name,pix_fmt,r_frame_rate,nb_read_frames,width,height:format=duration",
                          "-of", "json", path], capture_output=True, text=True, check=True).stdout
    found = json.loads(out)
    return found["streams"][0], float(found["format"]["duration"])


def check_film(path, seconds, width, height):
    stream, duration = probe(path)
    expect(stream["codec_name"] == "h264", f"{path} is {stream['codec_name']}, not H.264")
    expect(stream["pix_fmt"] == "yuv420p", f"{path} is {stream['pix_fmt']}, not yuv420p")
    expect(stream["r_frame_rate"] == "25/1", f"{path} has {stream['r_frame_rate']} pictures a second")
    expect((stream["width"], stream["height"]) == (width, height), f"{path} is {stream['width']}x{stream['height']}")
    expect(abs(duration - seconds) < 0.05, f"{path} lasts {duration} s, not {seconds} s")
    expect(abs(int(stream["nb_read_frames"]) - 25 * seconds) <= 1, f"{path} has {stream['nb_read_frames']} pictures")


def check_films(program, folder, recording):
    film = os.path.join(folder, "a.mp4")
    out = run(program, "replay", recording, "--video", film, "--size", "321x241", "--json")
    expect(out.returncode == 0, out.stderr)
    said = json.loads(out.stdout)
    expect(said["video"] == film and abs(said["video_seconds"] - SECONDS) < 0.05, f"it says {said.get('video_seconds')}")
    check_film(film, SECONDS, 320, 240)  # H.264 wants even numbers
    expect(not os.path.exists(film + ".part"), "a part of the film was left behind")

    slow = os.path.join(folder, "b.mkv")
    out = run(program, "replay", recording, "--video", slow, "--size", "320x240", "--from", "0.5", "--to", "0.8",
              "--slow", "0.25", "--camera", "free:120,40,350")
    expect(out.returncode == 0, out.stderr)
    check_film(slow, 1.2, 320, 240)


def check_shots(program, folder, recording):
    sizes = set()
    for camera in ("endoscope", "side", "surgeon", "free:30,60,300"):
        shots = os.path.join(folder, "shots-" + camera.replace(":", "-"))
        out = run(program, "replay", recording, "--shots", shots, "--camera", camera, "--from", "1", "--to", "1.1",
                  "--size", "320x240", "--json")
        expect(out.returncode == 0, out.stderr)
        index = json.load(open(os.path.join(shots, "index.json"), encoding="utf-8"))["pictures"]
        expect(len(index) >= 2, f"{camera}: {len(index)} pictures")
        for picture in index:
            expect(1 <= picture["seconds"] <= 1.1, f"{camera}: a picture of {picture['seconds']} s")
        sizes.add(open(os.path.join(shots, index[0]["file"]), "rb").read())
    expect(len(sizes) == 4, "two cameras give the same picture")


def check_refusals(program, folder, recording):
    """What cannot work is told before the work, not after it."""
    full = [recording, "--size", "320x240"]

    def refused(code, what, *words, **options):
        start = time.monotonic()
        out = run(program, "replay", *full, *words, **options)
        expect(out.returncode == code, f"{words}: exit {out.returncode}, not {code}: {out.stderr}")
        expect(what in out.stderr, f"{words}: '{what}' is not in: {out.stderr}")
        return time.monotonic() - start

    refused(3, "missing/a.mp4", "--video", os.path.join(folder, "missing", "a.mp4"))
    refused(3, "folder", "--video", folder + "/dir.mp4") if os.mkdir(folder + "/dir.mp4") is None else None
    refused(2, ".mp4", "--video", os.path.join(folder, "a.gif"))
    empty = os.path.join(folder, "empty")
    os.mkdir(empty)
    refused(3, "apt-get install ffmpeg", "--video", os.path.join(folder, "c.mp4"), env={**os.environ, "PATH": empty})
    fake = os.path.join(folder, "fake")
    os.mkdir(fake)
    with open(os.path.join(fake, "ffmpeg"), "w", encoding="utf-8") as script:
        script.write("#!/bin/sh\necho ' V..... mpeg4  MPEG-4 part 2'\n")
    os.chmod(os.path.join(fake, "ffmpeg"), 0o755)
    refused(3, "H.264", "--video", os.path.join(folder, "c.mp4"), env={**os.environ, "PATH": fake + ":/bin:/usr/bin"})
    expect(not os.path.exists(os.path.join(folder, "c.mp4")), "a film that could not be made is there")
    refused(2, "--camera", "--headless", "--camera", "back")
    refused(2, "--slow", "--headless", "--slow", "0")
    refused(2, "--slow", "--headless", "--slow", "nan")
    refused(2, "--from", "--headless", "--from", "100")
    refused(2, "--to", "--headless", "--from", "1", "--to", "0.5")


def check_part(program, folder, recording):
    """A torn file: what is sound is shown, and the film is as long as that."""
    torn = os.path.join(folder, "torn.rec")
    whole = open(recording, "rb").read()
    open(torn, "wb").write(whole[:len(whole) * 6 // 10])
    film = os.path.join(folder, "torn.mp4")
    out = run(program, "replay", torn, "--video", film, "--size", "320x240", "--json")
    expect(out.returncode == 0, out.stderr)
    said = json.loads(out.stdout)
    expect(said.get("damage") or said["interrupted"], "nothing is said of the file's missing end")
    expect(0.3 < said["video_seconds"] < SECONDS, f"the film lasts {said['video_seconds']} s")
    check_film(film, said["video_seconds"], 320, 240)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for tool in ("ffmpeg", "ffprobe"):
        if not shutil.which(tool):
            print(f"{tool} is missing: apt-get install ffmpeg")
            return 77
    program, folder = os.path.abspath(sys.argv[1]), tempfile.mkdtemp()
    os.environ["TROCAR_DATA"] = os.path.join(folder, "data")
    try:
        recording = os.path.join(folder, "a.rec")
        made = run(program, "train", "gynaecology/sterilisation", "--input", "demo", "--headless", "--seconds", SECONDS,
                   "--record", recording)
        expect(os.path.exists(recording), made.stderr)
        check_films(program, folder, recording)
        check_shots(program, folder, recording)
        check_refusals(program, folder, recording)
        check_part(program, folder, recording)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
