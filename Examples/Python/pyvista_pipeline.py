#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A pipeline of the VTK classes in a PyVista plotter, whose slider is the time.

    pyvista_pipeline.py [mesh array]

PyVista draws the output of a filter, not a copy of it: the slider asks the pipeline for another time, and
the picture follows. Here total variation flow removes noise from stripes. The program writes
pyvista_pipeline.png, with three places of the slider; without off_screen the mouse moves it.

Try next: plotter.add_mesh() of a vtkSurfaceReliefFilter behind this filter. The functions of
surfacediffusion.pyvista do one update without a pipeline: with_pyvista.py.
"""

import os
import sys

if not os.environ.get("DISPLAY"):
    print("there is no display")
    sys.exit(77)
try:
    import pyvista
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkSurfaceDiffusion import vtkIntrinsicTVFilter
except ImportError as problem:
    print(problem)
    sys.exit(77)

import numpy as np


def stripes():
    mesh = pyvista.Icosphere(nsub=6)
    noise = np.random.default_rng(1).normal(scale=0.4, size=mesh.n_points)
    mesh["stripes"] = np.sign(np.sin(6 * mesh.points[:, 2])) + noise
    return mesh


def make_plotter(flow, array):
    """A plotter of the output of the filter, and its slider through the times."""
    plotter = pyvista.Plotter(off_screen=True, window_size=(500, 500))
    actor = plotter.add_mesh(flow, scalars=array, clim=(-1.5, 1.5), cmap="viridis")
    # What the plotter has put behind the filter asks for the time.
    last = actor.mapper.GetInputAlgorithm()
    slider = plotter.add_slider_widget(last.UpdateTimeStep, (0, flow.GetNumberOfTimeSteps()), title="time")
    return plotter, slider


def main():
    mesh, array = stripes(), "stripes"
    if len(sys.argv) > 2:
        mesh, array = pyvista.read(sys.argv[1]), sys.argv[2]
    flow = vtkIntrinsicTVFilter()
    flow.SetInputDataObject(mesh)
    flow.SetInputArrayToProcess(0, 0, 0, 0, array)
    flow.GenerateTimeStepsOn()
    plotter, slider = make_plotter(flow, array + "TV")
    plotter.show(auto_close=False)
    pictures = []
    for time in (0, 1, 10):  # what the mouse does in a window
        slider.GetRepresentation().SetValue(time)
        slider.InvokeEvent("EndInteractionEvent")
        plotter.render()
        pictures.append(plotter.screenshot())
        print(f"time {time}: standard deviation {pyvista.wrap(flow.GetOutput())[array + 'TV'].std():.3f}")
    image = pyvista.ImageData(dimensions=(1500, 500, 1))
    image["rgb"] = np.concatenate(pictures, axis=1)[::-1].reshape(-1, 3)
    writer = vtkPNGWriter()
    writer.SetFileName("pyvista_pipeline.png")
    writer.SetInputData(image)
    writer.Write()


if __name__ == "__main__":
    main()
