#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the pictures of GUIDE.md: ParaView's window, and each macro's example before and after.

    make.py <folder of SurfaceDiffusion.so> <folder for the pictures>

It needs Xvfb, and libqt5svg5 for ParaView's icons.
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


def draw_window(folder, environment):
    macros = folder / ".config" / "ParaView" / "Macros"
    macros.mkdir(parents=True)
    shutil.copy(MACROS / "history.py", macros)
    command = [
        "paraview", "--dr", "--script=%s" % (HERE / "window.py"), "--test-directory=%s" % folder,
        "--test-script=%s" % (HERE / "window.xml"),
    ]
    window = subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    for line in window.stdout:
        if "is finished" in line:
            break
    time.sleep(3)  # until everything is drawn
    screen = read_screen(folder / "Xvfb_screen0")
    window.kill()
    return screen


def main():
    plugin, output = (pathlib.Path(path).resolve() for path in sys.argv[1:])
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
            write_png(output / "paraview_macros.png", draw_examples(folder, environment))
            write_png(output / "paraview_window.png", draw_window(folder, environment))
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
