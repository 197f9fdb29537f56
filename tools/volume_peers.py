#!/usr/bin/env python3
"""The volume caster beside VTK's two, in one run: the same block of 256^3, camera, looks, size and distance of samples.

    tools/volume_peers.py [--rounds N] [--threads N] [--looks NAME,...] [--bench PROGRAM] [--out FOLDER]
        --rounds   times that all three take turns (default 5); medians of them are told
        --threads  cores that the run may use and threads that each gets (default 2)
        --looks    of bone, skin, vessels, soft_tissue (default: all)
        --bench    volumes_bench as built (default: build/release/bench/volumes/volumes_bench)
        --out      folder for the pictures and the block (default: build/volume-peers)

Needs VTK 9 for the Python that runs it (Debian: apt-get install python3-vtk9, then /usr/bin/python3 tools/...), Pillow and
Xvfb. Nothing else in the project needs VTK. What is compared:
    trocar   VolumeCaster, as volumes_bench runs it (bench/volumes/caster_bench.cpp), which writes block and looks as well
    vtk cpu  vtkFixedPointVolumeRayCastMapper
    vtk gpu  vtkGPUVolumeRayCastMapper, on whatever OpenGL the display has: in Xvfb that is Mesa's llvmpipe, which is a
             processor, too. The renderer's name is told.
Still: a sample every 0.5 mm (half a voxel), a ray for each of 640 x 480 pixels. Moving: every 2 mm, a ray for each 2 x 2
pixels. All are shaded with the light at the eye; opacities are of a layer of a millimetre; automatic steps are off. VTK's
camera is turned to and fro by 0.01 degrees, so that every picture is a new one; its times hold the whole of Render() with
glFinish, of which an empty window's share is told as well.

Prints a table in Markdown: ms by the clock and, in brackets, of the processor over all threads. Writes LOOK.png: trocar,
vtk cpu, vtk gpu from left to right, still above moving. Exit 0; 2: volumes_bench or Xvfb is missing; 3: VTK is.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LOOKS = ["bone", "skin", "vessels", "soft_tissue"]
WIDTH, HEIGHT = 640, 480
# The bench's view in the patient's millimetres (scene: x left, y head, z front; patient: x left, y back, z head)
EYE, UP, FIELD_DEG = (250, -500, 150), (0, 0, 1), 30
SAMPLES_MM = {"still": 0.5, "moving": 2.0}
PIXELS = {"still": 1, "moving": 2}


def arguments():
    p = argparse.ArgumentParser(usage=__doc__)
    p.add_argument("--rounds", type=int, default=5)
    p.add_argument("--threads", type=int, default=2)
    p.add_argument("--looks", type=lambda text: text.split(","), default=LOOKS)
    p.add_argument("--bench", type=Path, default=ROOT / "build/release/bench/volumes/volumes_bench")
    p.add_argument("--out", type=Path, default=ROOT / "build/volume-peers")
    a = p.parse_args()
    if unknown := [look for look in a.looks if look not in LOOKS]:
        p.error(f"expected looks out of {', '.join(LOOKS)}, got {', '.join(unknown)}")
    return a


def in_a_display_of_its_own():
    """Runs this again within Xvfb, which draws the same everywhere."""
    os.environ["TROCAR_PEERS_DISPLAY"] = "1"
    command = [str(ROOT / "tools/with_xvfb.sh"), sys.executable, *sys.argv]
    code = subprocess.run(command).returncode
    sys.exit(2 if code == 77 else code)


def run_trocar(a, look):
    """{"still": (clock ms, processor ms), "moving": ...}; pictures and block go to a.out."""
    out = a.out / "trocar.json"
    command = [str(a.bench), f"--benchmark_filter=Cast(Still|Moving)/{LOOKS.index(look)}/", "--benchmark_min_time=0.4",
               f"--benchmark_out={out}", "--benchmark_out_format=json"]
    subprocess.run(command, env={**os.environ, "TROCAR_CASTER_FILES": str(a.out)}, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    took = {}
    for b in json.loads(out.read_text())["benchmarks"]:
        took["still" if "Still" in b["name"] else "moving"] = (b["real_time"], b["all_threads_ms"])
    return took


def block_for_vtk(vtk, file):
    """The bench's NRRD (raw, 16 bits) as an image, in the patient's millimetres."""
    from vtk.util import numpy_support
    import numpy
    data = file.read_bytes()
    begin = data.index(b"\n\n") + 2
    if b"encoding: raw" not in data[:begin]:
        sys.exit(f"{file}: expected raw voxels")
    side = 256
    voxels = numpy.frombuffer(data, "<i2", side ** 3, begin)
    image = vtk.vtkImageData()
    image.SetDimensions(side, side, side)
    image.SetOrigin(-127.5, -127.5, -127.5)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(voxels.copy(), deep=True, array_type=vtk.VTK_SHORT))
    return image


def set_look(vtk, volume, points):
    colours, opacities = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    for value, red, green, blue, opacity in points:
        colours.AddRGBPoint(value, red, green, blue)
        opacities.AddPoint(value, opacity)
    look = volume.GetProperty()
    look.SetColor(colours)
    look.SetScalarOpacity(opacities)
    look.SetScalarOpacityUnitDistance(1)
    look.SetInterpolationTypeToLinear()
    look.ShadeOn()
    look.SetAmbient(0.2)
    look.SetDiffuse(0.75)
    look.SetSpecular(0.25)
    look.SetSpecularPower(16)


class Peer:
    """One of VTK's mappers with a window of its own."""

    def __init__(self, vtk, mapper, image):
        self.vtk, self.mapper = vtk, mapper
        mapper.SetInputData(image)
        mapper.SetAutoAdjustSampleDistances(0)
        self.volume = vtk.vtkVolume()
        self.volume.SetMapper(mapper)
        self.renderer = vtk.vtkRenderer()
        self.renderer.SetBackground(0, 0, 0)
        self.renderer.AddVolume(self.volume)
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetSize(WIDTH, HEIGHT)
        self.window.SetMultiSamples(0)
        self.window.AddRenderer(self.renderer)
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(*EYE)
        camera.SetFocalPoint(0, 0, 0)
        camera.SetViewUp(*UP)
        camera.SetViewAngle(FIELD_DEG)
        self.renderer.ResetCameraClippingRange()

    def set_quality(self, quality):
        self.mapper.SetSampleDistance(SAMPLES_MM[quality])
        self.mapper.SetImageSampleDistance(PIXELS[quality])

    def draw(self):
        self.window.Render()
        self.window.WaitForCompletion()

    def times(self, least_s=0.4):
        """(clock ms, processor ms) a picture, of as many as go into that time."""
        camera = self.renderer.GetActiveCamera()
        count, clock, processor = 0, time.perf_counter(), time.process_time()
        while count == 0 or time.perf_counter() - clock < least_s:
            camera.Azimuth(0.01 if count % 2 == 0 else -0.01)
            self.draw()
            count += 1
        if count % 2:
            camera.Azimuth(-0.01)
        return 1e3 * (time.perf_counter() - clock) / count, 1e3 * (time.process_time() - processor) / count

    def warm(self, quality):
        """What a new look makes anew is no part of a picture's time, unless it is nothing beside it."""
        self.set_quality("moving")
        begin = time.perf_counter()
        self.draw()
        self.set_quality(quality)
        if time.perf_counter() - begin < 0.5:
            self.draw()

    def write(self, file):
        """What was drawn last."""
        grab = self.vtk.vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.ShouldRerenderOff()
        writer = self.vtk.vtkPNGWriter()
        writer.SetFileName(str(file))
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()


def make_peers(vtk, image, threads):
    cpu = vtk.vtkFixedPointVolumeRayCastMapper()
    cpu.SetNumberOfThreads(threads)
    gpu = vtk.vtkGPUVolumeRayCastMapper()
    return {"vtk cpu": Peer(vtk, cpu, image), "vtk gpu": Peer(vtk, gpu, image)}


def renderer_name(window):
    lines = window.ReportCapabilities().splitlines()
    return next((line.split(":", 1)[1].strip() for line in lines if "renderer string" in line), "unknown")


def measure(a, vtk):
    """(times[look][quality][who] = [(clock, processor)], peers, an empty window's ms)"""
    run_trocar(a, a.looks[0])  # for the block
    looks = json.loads((a.out / "looks.json").read_text())
    peers = make_peers(vtk, block_for_vtk(vtk, a.out / "block.nrrd"), a.threads)
    times = {look: {quality: {"trocar": [], **{who: [] for who in peers}} for quality in SAMPLES_MM} for look in a.looks}
    for turn in range(a.rounds):
        for look in a.looks:
            for quality, took in run_trocar(a, look).items():
                times[look][quality]["trocar"].append(took)
            for who, peer in peers.items():
                set_look(vtk, peer.volume, looks[look])
                for quality in SAMPLES_MM:
                    peer.warm(quality)
                    times[look][quality][who].append(peer.times())
                    if turn == 0:
                        peer.write(a.out / f"{look}_{quality}_{who.replace(' ', '_')}.png")
    empty = peers["vtk cpu"]
    name = renderer_name(empty.window)
    empty.volume.VisibilityOff()
    empty.draw()
    return times, name, empty.times()[0]


def picture_of(look, a):
    """Three beside each other, still above moving, as LOOK.png; how far VTK's are from ours [grey steps of 255]."""
    from PIL import Image, ImageChops, ImageStat
    whole = Image.new("RGB", (3 * WIDTH, 2 * HEIGHT))
    off = {}
    for row, quality in enumerate(SAMPLES_MM):
        ours = Image.open(a.out / f"{look}_{quality}.ppm").convert("RGB").resize((WIDTH, HEIGHT))
        whole.paste(ours, (0, row * HEIGHT))
        for column, who in enumerate(["vtk cpu", "vtk gpu"], 1):
            theirs = Image.open(a.out / f"{look}_{quality}_{who.replace(' ', '_')}.png").convert("RGB")
            whole.paste(theirs, (column * WIDTH, row * HEIGHT))
            if quality == "still":
                off[who] = ImageStat.Stat(ImageChops.difference(ours, theirs).convert("L")).mean[0]
    whole.save(a.out / f"{look}.png")
    return off


def table(times):
    medians = lambda pairs: [statistics.median(values) for values in zip(*pairs)]
    lines = ["| ms by the clock (of the processor, all threads) | trocar | VTK, processor | VTK, OpenGL | VTK's better one : trocar |",
             "|---|---|---|---|---|"]
    for look, qualities in times.items():
        for quality, who in qualities.items():
            took = {name: medians(pairs) for name, pairs in who.items()}
            cells = [f"{clock:.0f} ({processor:.0f})" for clock, processor in took.values()]
            clock, processor = [min(took["vtk cpu"][i], took["vtk gpu"][i]) / took["trocar"][i] for i in (0, 1)]
            lines.append(f"| {look.replace('_', ' ')}, {quality} | {' | '.join(cells)} | {clock:.1f} ({processor:.1f}) |")
    return "\n".join(lines)


def main():
    a = arguments()
    if not a.bench.exists():
        print(f"{a.bench} is missing: tools/build.sh --tests volumes_bench", file=sys.stderr)
        return 2
    os.environ["LP_NUM_THREADS"] = str(a.threads)
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:a.threads])
    try:
        import vtk
    except ImportError:
        print("VTK is missing for this Python: apt-get install python3-vtk9, then /usr/bin/python3 tools/volume_peers.py",
              file=sys.stderr)
        return 3
    if "TROCAR_PEERS_DISPLAY" not in os.environ:
        in_a_display_of_its_own()
    a.out.mkdir(parents=True, exist_ok=True)
    load = os.getloadavg()[0]
    times, renderer, empty_ms = measure(a, vtk)
    print(f"VTK {vtk.vtkVersion().GetVTKVersion()}, OpenGL: {renderer}; {a.threads} threads each, medians of {a.rounds} rounds, "
          f"load at the beginning {load:.1f}; an empty window of VTK's takes {empty_ms:.1f} ms.\n")
    print(table(times))
    print()
    for look in a.looks:
        off = picture_of(look, a)
        print(f"{look}: " + ", ".join(f"{who} is {grey:.1f} of 255 off on average" for who, grey in off.items()),
              f"({a.out / look}.png)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
