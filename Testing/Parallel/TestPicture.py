# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A surface in pieces gives the picture of the whole surface on any number of processes."""

import os
import sys

import pieces
import vtkSurfaceDiffusion  # noqa: F401: the classes behind the proxies
from paraview.simple import (
    ColorBy, CreateRenderView, GetColorTransferFunction, HideScalarBarIfNotNeeded,
    IntrinsicTVFilter, SaveScreenshot, Show, TrivialProducer,
)
from plugin_testing import assert_looks_like, assert_looks_unlike
from vtkmodules.vtkParallelCore import vtkMultiProcessController

controller = vtkMultiProcessController.GetGlobalController()
rank = controller.GetLocalProcessId()
source = TrivialProducer()
source.GetClientSideObject().SetOutput(
    pieces.split(pieces.make_surface(), controller.GetNumberOfProcesses(), "slabs")[rank])
denoised = IntrinsicTVFilter(source, AutomaticFidelity=0, NumberOfTimeSteps=20)
view = CreateRenderView(ViewSize=[300, 300], OrientationAxesVisibility=0, UseLight=0)
view.CameraPosition = [4, -8, 14]
view.CameraViewUp = [0, 0, 1]
display = Show(denoised, view)
ColorBy(display, ("POINTS", "fTV"))
bands = GetColorTransferFunction("fTV")
HideScalarBarIfNotNeeded(bands, view)
bands.RescaleTransferFunction(-2.0, 2.0)
bands.NumberOfTableValues = 6
bands.Discretize = 1
display.SetScalarBarVisibility(view, False)
display.InterpolateScalarsBeforeMapping = 1


def draw_elsewhere():
    """The other processes take part in each picture."""
    SaveScreenshot("other processes draw too.png", view, ImageResolution=[300, 300],
                   OverrideColorPalette="WhiteBackground")


for slip, check in ((1.0, assert_looks_like), (1.2, assert_looks_unlike)):
    denoised.FidelityWeight = 3.0 * slip
    if rank == 0:
        try:
            check(view, "Pieces")
        except Exception as error:  # the other processes wait
            print(error)
            sys.stdout.flush()
            os._exit(1)
    else:
        draw_elsewhere()
