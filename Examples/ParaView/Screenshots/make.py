#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the pictures of GUIDE.md: ParaView's window, still and moving, and each macro's example before
and after.

    make.py <folder of the plugins> <folder for the pictures> [window] [buttons] [examples]

It needs Xvfb, libqt5svg5 for ParaView's icons, and python3-pil for moving pictures.
"""

import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time

import numpy as np
from PIL import Image
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter

HERE = pathlib.Path(__file__).resolve().parent
MACROS = HERE.parent / "Macros"
EXAMPLES = ("denoise", "inpaint", "denoise_mesh", "texture")
SIZE = (1280, 900)
DISPLAY = ":%d" % (100 + os.getpid() % 800)
DRAW = """
exec(open({macro!r}).read())
LoadPalette("WhiteBackground")
view.OrientationAxesVisibility = 0
view.CameraPosition = (1.2, 0.9, 1.6)
display.SetScalarBarVisibility(view, False) if display.LookupTable else None
for name, source in (("before", surface), ("after", result)):
    HideAll(view)
    shown = Show(source, view)
    if {mesh}:
        shown.ColorArrayName = ["POINTS", ""]
    ResetCamera(view)
    SaveScreenshot({folder!r} + "/{name}_" + name + ".png", view, ImageResolution=[320, 320])
"""


def read_png(path):
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)


def write_png(path, pixels):
    """Writes an array of rows, from the bottom up as in VTK."""
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.Write()
    print(path)


def read_screen(path):
    """The picture in Xvfb's frame buffer file, an X window dump."""
    data = path.read_bytes()
    header = struct.unpack(">25I", data[:100])
    width, height, stride = header[4], header[5], header[12]
    start = header[0] + 12 * header[19]  # after the colour map
    rows = np.frombuffer(data, np.uint8, stride * height, start).reshape(height, stride)
    pixels = rows.reshape(height, -1, 4)[:, :width, [2, 1, 0]]
    used = pixels.any(2)  # the window is in the upper left corner of a black screen
    if not used.any():
        return pixels
    pixels = pixels[: used.any(1).nonzero()[0][-1] + 1, : used.any(0).nonzero()[0][-1] + 1]
    return pixels[::-1].copy()


def draw_examples(folder, environment):
    for name in EXAMPLES:
        script = folder / "draw.py"
        script.write_text(DRAW.format(
            macro=str(MACROS / (name + ".py")), name=name, folder=str(folder),
            mesh=name == "denoise_mesh"))
        subprocess.run(["pvpython", str(script)], check=True, env=environment)
    rows = [
        np.hstack([read_png(folder / ("%s_%s.png" % (name, when))) for name in EXAMPLES])
        for when in ("after", "before")
    ]
    return np.vstack(rows)


def record_window(folder, environment, events):
    """Plays the events of a file in ParaView's window. The pictures that stood still for a moment, the
    last of which is that of the end."""
    macros = folder / ".config" / "ParaView" / "Macros"
    macros.mkdir(parents=True, exist_ok=True)
    for name in (MACROS / "history.py", HERE / "select_nothing.py"):
        shutil.copy(name, macros)
    command = [
        "paraview", "--dr", "--script=%s" % (HERE / "window.py"), "--test-directory=%s" % folder,
        "--test-script=%s" % (HERE / events),
    ]
    with open(folder / "log", "w+") as log:
        window = subprocess.Popen(command, env=environment, stdout=log, stderr=subprocess.STDOUT)
        pictures, last, end = [], None, None
        while end is None or time.monotonic() < end:
            time.sleep(0.3)  # between two looks at the screen
            text = (folder / "log").read_text()
            if end is None and "is finished" in text:
                end = time.monotonic() + 5  # until everything is drawn
            if "Playing" not in text:
                continue
            screen = read_screen(folder / "Xvfb_screen0")
            still = last is not None and np.array_equal(screen, last)
            if still and (not pictures or differ(screen, pictures[-1])):
                pictures.append(screen)
            last = screen
        window.kill()
        window.wait()
    return pictures


def differ(first, second):
    """Whether two pictures differ in more than two percent of their points."""
    return first.shape != second.shape or (first != second).any(2).mean() > 0.02


def write_gif(path, pictures, scale=0.44, seconds=1.5):
    """A moving picture with 96 colours, which stays for a while at its end."""
    frames = []
    for picture in pictures:
        if picture.shape == pictures[-1].shape:  # before, there is no window yet
            image = Image.fromarray(picture[::-1])
            frames.append(image.resize([int(scale * size) for size in image.size], Image.LANCZOS))
    palette = Image.fromarray(np.vstack([np.asarray(frame) for frame in frames])).quantize(96)
    frames = [frame.quantize(palette=palette, dither=Image.NONE) for frame in frames]
    lengths = [int(1000 * seconds)] * (len(frames) - 1) + [int(3000 * seconds)]
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=lengths, loop=0, optimize=True)
    print(path)


def main():
    plugin, output = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    wanted = sys.argv[3:] or ["window", "buttons", "examples"]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        environment = dict(
            os.environ, DISPLAY=DISPLAY, PV_PLUGIN_PATH=str(plugin), HOME=name,
            XDG_CONFIG_HOME=name + "/.config")
        screen = "%dx%dx24" % SIZE
        server = subprocess.Popen(
            ["Xvfb", DISPLAY, "-screen", "0", screen, "-noreset", "-fbdir", name])
        try:
            time.sleep(2)
            if "window" in wanted:
                pictures = record_window(folder, environment, "window.xml")
                write_png(output / "paraview_window.png", pictures[-1])
                write_gif(output / "paraview_window.gif", pictures)
            if "buttons" in wanted:
                write_gif(output / "paraview_macros.gif", record_window(folder, environment, "macros.xml"))
            if "examples" in wanted:
                write_png(output / "paraview_macros.png", draw_examples(folder, environment))
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
