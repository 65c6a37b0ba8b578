# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Filter a time series of data on one surface, in ParaView's Python.

    PV_PLUGIN_PATH=<folder of SurfaceDiffusion.so> pvpython time_series.py [array map_*.vtp]

The files of a series have one surface and an array that differs, such as a run of fMRI or the output
of a simulation. With GenerateTimeSteps off the filter takes the times of its input: ParaView's clock
plays the filtered series, and SaveData writes it. The surface is read and its matrix is factored once,
since it does not change. The program writes smooth.pvd with a file per time. pvbatch runs it, too.

Try next: TemporalStatistics(Input=heat), the mean and the deviation over time; PlotDataOverTime, the
curve of a point.
"""

import math
import sys

from paraview.simple import *

if len(sys.argv) > 2:
    name, files = sys.argv[1], sys.argv[2:]
else:  # a wave that travels over a sphere, with ripples; four files
    name, files = "wave", [f"map_{i}.vtp" for i in range(4)]
    sphere = Sphere(ThetaResolution=64, PhiResolution=64)
    for i, file in enumerate(files):
        phase = 2 * math.pi * i / len(files)
        wave = Calculator(sphere, ResultArrayName=name, Function=(
            f"cos(6*coordsX + {phase}) + 0.3*sin(60*coordsY)*sin(60*coordsZ)"))
        # Debian 12's ParaView cannot read appended data, the default
        SaveData(file, wave, ChooseArraysToWrite=1, PointDataArrays=[name], DataMode="Binary")

series = XMLPolyDataReader(FileName=files)
heat = FVMHeatFilter(series, InputArray=["POINTS", name], FWHM=0.1)
heat.UpdatePipelineInformation()
print("times:", *heat.TimestepValues)
SaveData("smooth.pvd", heat, WriteTimeSteps=1, DataMode="Binary")
for time in heat.TimestepValues:
    heat.UpdatePipeline(time)
    low, high = heat.PointData[name + "Diffused"].GetRange()
    print(f"time {time:g}: smoothed from {low:.3f} to {high:.3f}")
