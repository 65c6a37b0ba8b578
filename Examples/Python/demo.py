#!/usr/bin/env python3
"""Applications of linear diffusion (vtkFVMHeatFilter) on real surfaces, in four pictures:

1. cortical thickness smoothed with a 10 mm FWHM, the medial wall excluded;
2. a picture with noise on a scanned mesh denoised, equation (16);
3. the same picture with a tenth of it missing inpainted, (18);
4. random noise smeared along a direction field, (4).

Examples/demo.sh fetches the data, builds the library and runs this program.
"""
import argparse
import sys
import time
from pathlib import Path

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

import surface_data as data
from pictures import Panel, colour_table, display_missing, save_picture
from vtkSurfaceDiffusion import vtkFVMHeatFilter

POINTS = vtkDataObject.FIELD_ASSOCIATION_POINTS
CELLS = vtkDataObject.FIELD_ASSOCIATION_CELLS
DATA, MASK, DIRECTION = 0, 1, 2  # the filter's input arrays

LATERAL = dict(view=(-1, 0, 0.1), up=(0, 0, 1))  # a left hemisphere from outside
MEDIAL = dict(view=(1, 0, 0.1), up=(0, 0, 1))    # and from the inside
VIRIDIS = [(0.27, 0.00, 0.33), (0.23, 0.32, 0.55), (0.13, 0.57, 0.55), (0.37, 0.79, 0.38),
           (0.99, 0.91, 0.14)]
WHITE_TO_RED = [(0.95, 0.95, 0.95), (0.96, 0.65, 0.51), (0.70, 0.02, 0.15)]
BLACK_TO_WHITE = [(0, 0, 0), (1, 1, 1)]
GREY = (0.70, 0.70, 0.70)


class DemoError(Exception):
    """An error that the user can correct; shown without a traceback."""


# ---- running a filter --------------------------------------------------------------------------

def heat_filter(surface, array, mask=None, direction=None):
    heat = vtkFVMHeatFilter()
    heat.SetInputData(surface)
    heat.SetInputArrayToProcess(DATA, 0, 0, POINTS, array)
    if mask:
        heat.SetInputArrayToProcess(MASK, 0, 0, POINTS, mask)
    if direction:
        heat.SetInputArrayToProcess(DIRECTION, 0, 0, CELLS, direction)
    return heat


def run(heat):
    """Updates the filter, shows a progress bar, and returns the output: the input with the result
    as a further array."""
    errors, warnings, width, shown = [], [], 40, 0

    def advance(caller, event):
        nonlocal shown
        reached = round(width * caller.GetProgress())
        print("#" * (reached - shown), end="", flush=True)
        shown = max(shown, reached)

    @calldata_type(VTK_STRING)
    def listen(caller, event, message):
        words = message.partition("): ")[2].strip()  # without source file and address
        (errors if event == "ErrorEvent" else warnings).append(words)

    observer = heat.AddObserver(vtkCommand.ProgressEvent, advance)
    heat.AddObserver(vtkCommand.ErrorEvent, listen)
    heat.AddObserver(vtkCommand.WarningEvent, listen)
    print("   [", end="", flush=True)
    start = time.perf_counter()
    heat.Update()
    seconds = time.perf_counter() - start
    print("#" * (width - shown) + f"] {seconds:.2f} s")
    heat.RemoveObserver(observer)
    for warning in warnings:
        print(f"   warning: {warning}")
    if errors:
        raise DemoError(errors[0])
    return heat.GetOutput()


def report(heat, conserves=True):
    """Prints a summary of the history table, the second output."""
    history = WrapDataObject(heat.GetOutputDataObject(1)).RowData
    steps = len(history["Step"]) - 1  # the first row is the initial state
    print(f"   {heat.GetOutput().GetNumberOfPoints():,} vertices, "
          f"{steps} {'step' if steps == 1 else 'steps'}", end="")
    if conserves:
        totals = [np.asarray(history[name]) for name in history.keys() if name.startswith("Total_")]
        drift = max(abs(total - total[0]).max() / abs(total[0]) for total in totals)
        print(f"; the sum of area x value is conserved to {drift:.0e} of itself", end="")
    print()


def write_series(heat, folder, name):
    """Writes one file per published time, and a .pvd file that ParaView plays."""
    times = heat.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    (folder / name).mkdir(exist_ok=True)
    entries = []
    for number, moment in enumerate(times):
        heat.UpdateTimeStep(moment)
        file = f"{name}/{name}_{number:03}.vtp"
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(heat.GetOutput())
        writer.SetFileName(str(folder / file))
        writer.SetDataModeToBinary()  # Debian 12's VTK cannot read appended data, the default
        if not writer.Write():
            raise DemoError(f"{folder / file} cannot be written")
        entries.append(f'<DataSet timestep="{moment!r}" file="{file}"/>')
    index = folder / f"{name}.pvd"
    index.write_text('<VTKFile type="Collection"><Collection>\n' + "\n".join(entries)
                     + "\n</Collection></VTKFile>\n")
    print(f"   {len(times)} time steps written")


# ---- the four pictures: each returns its panels, the first before, the second after -------------

def smooth_cortex(white, inflated, wall_up_to, output):
    print("1. Cortical thickness smoothed, FWHM 10 mm, the medial wall excluded")
    thickness = data.array_of(white, "thickness")
    wall = np.abs(thickness) <= wall_up_to
    white = data.with_arrays(white, wall=wall.astype(np.uint8))

    heat = heat_filter(white, "thickness", mask="wall")
    heat.SetMaskModeToExclude()
    heat.SetFWHM(10)
    heat.SetNumberOfTimeSteps(16)
    heat.GenerateTimeStepsOn()
    smooth = data.array_of(run(heat), "thicknessDiffused")
    report(heat)
    write_series(heat, output, "cortex")

    print("   and again with the wall taken for cortex, to show the leak that this avoids")
    leaking = heat_filter(white, "thickness")
    leaking.SetFWHM(10)
    leaking.SetNumberOfTimeSteps(16)
    leak = smooth - data.array_of(run(leaking), "thicknessDiffused")

    # The inflated surface shows the folds. Values far below the tables' range colour the wall grey.
    shown = data.make_surface(inflated, data.triangles_of(white))
    shown = data.with_arrays(shown, **{
        name: np.where(wall, -100, np.maximum(values, 0))
        for name, values in (("before", thickness), ("after", smooth), ("leak", np.abs(leak)))})
    millimetres = dict(table=colour_table(0, 4, VIRIDIS, below=GREY), bar=True)
    lost = dict(table=colour_table(0, 0.6, WHITE_TO_RED, below=GREY), bar=True)
    rim = "" if wall_up_to else ", its averaged rim violet"  # thin, but not zero
    return [Panel(shown, name, title, note, **colours, **side)
            for side in (MEDIAL, LATERAL)
            for name, title, note, colours in (
                ("before", "Cortical thickness in mm", "medial wall grey" + rim, millimetres),
                ("after", "Smoothed, FWHM 10 mm", "medial wall excluded", millimetres),
                ("leak", "Leak avoided, in mm", "were the wall taken for cortex", lost))]


def denoise(surface, side):
    print("2. A picture with 25 % Gaussian noise (sigma 64, clipped to 8 bits) denoised, (16)")
    clean = data.stained_glass(surface)
    surface = data.with_arrays(surface, clean=clean, noisy=data.with_noise(clean, 0.25))
    heat = heat_filter(surface, "noisy")
    heat.SetFidelityWeight(0.05)
    heat.SetTimeStep(0.4)
    heat.SetNumberOfTimeSteps(10)
    result = run(heat)
    report(heat)
    before, after = error_of(result, "noisy"), error_of(result, "noisyDiffused")
    print(f"   root mean square error {before:.1f} -> {after:.1f} of 255")
    return [Panel(result, "noisy", "25 % noise", f"RMS error {before:.0f} of 255", **side),
            Panel(result, "noisyDiffused", "Denoised, (16)", f"RMS error {after:.0f}", **side),
            Panel(result, "clean", "The clean picture", **side)]


def inpaint(surface, side):
    print("3. The same picture with a tenth missing inpainted, (18)")
    clean = data.stained_glass(surface)
    missing = data.damage(surface, 0.1)
    torn = np.where(missing[:, None], np.uint8(255), clean)
    surface = data.with_arrays(surface, clean=clean, missing=missing, torn=torn)
    heat = heat_filter(surface, "torn", mask="missing")
    heat.HoldKnownValuesOn()  # the known colours are exact: infinite fidelity
    heat.SetModeToSteadyState()  # the limit for infinite time, in one solve
    result = run(heat)
    report(heat, conserves=False)  # the holes are filled, so the sum changes
    before, after = error_of(result, "torn"), error_of(result, "tornDiffused")
    print(f"   {missing.mean():.1%} missing, root mean square error {before:.1f} -> {after:.1f}"
          " of 255")
    return [Panel(result, "torn", "A tenth missing", "in white", **side),
            Panel(result, "tornDiffused", "Inpainted, (18)", f"RMS error {after:.0f} of 255",
                  **side),
            Panel(result, "clean", "The whole picture", **side)]


def smear(surface, side):
    print("4. Noise smeared along a direction field, (4)")
    level = data.waves(data.points_of(surface))
    noise = np.random.default_rng(3).uniform(size=len(level))
    surface = data.with_arrays(surface, noise=noise, level=level)
    surface = data.with_arrays(surface, cells=True,
                               direction=data.along_level_lines(surface, level))
    heat = heat_filter(surface, "noise", direction="direction")
    heat.SetAlongDiffusivity(1)
    heat.SetAcrossDiffusivity(0.001)
    heat.SetTimeStep(10)
    heat.SetNumberOfTimeSteps(5)
    result = run(heat)
    report(heat)

    low, high = np.percentile(data.array_of(result, "noiseDiffused"), (2, 98))
    table = colour_table(low, high, BLACK_TO_WHITE)
    bands = colour_table(level.min(), level.max(), VIRIDIS, steps=24)
    return [Panel(result, "noise", "Noise", table=colour_table(0, 1, BLACK_TO_WHITE), **side),
            Panel(result, "noiseDiffused", "Smeared along a field, (4)", table=table, **side),
            Panel(result, "level", "The field", "runs along the level lines of this function",
                  table=bands, **side)]


def error_of(surface, name):
    """The root mean square difference from the clean picture."""
    difference = data.array_of(surface, name).astype(float) - data.array_of(surface, "clean")
    return np.sqrt(np.mean(difference ** 2))


# ---- the program -------------------------------------------------------------------------------

def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("--output", type=Path, default=Path("demo-output"), metavar="DIR",
                        help="folder of the results (default: %(default)s)")
    parser.add_argument("--cortex", metavar="DIR",
                        help="fsaverage5: white_left.gii.gz, infl_left.gii.gz, thick_left.gii.gz")
    parser.add_argument("--wall", type=float, default=0, metavar="MM",
                        help="thickness up to which a point is medial wall (default: exact zeros)")
    parser.add_argument("--mesh", metavar="FILE", help="the mesh to paint on: .off or .vtp")
    parser.add_argument("--view", type=float, nargs=3, default=(0.35, 0.12, 1),
                        metavar=tuple("XYZ"),
                        help="direction from the mesh to the camera (default: %(default)s)")
    parser.add_argument("--up", type=float, nargs=3, default=(0, 1, 0), metavar=tuple("XYZ"),
                        help="upward direction in its pictures (default: %(default)s)")
    parser.add_argument("--vertices", type=int, default=500_000, metavar="N",
                        help="refine the mesh to more vertices than this (default: %(default)s)")
    parser.add_argument("--quick", action="store_true",
                        help="small meshes, and generated surfaces if no files are given")
    parser.add_argument("--no-pictures", action="store_true",
                        help="compute only; no display is needed")
    parser.add_argument("--gallery", type=Path, metavar="FILE",
                        help="also draw all four in one small PNG file")
    args = parser.parse_args()
    if not args.quick and not (args.cortex and args.mesh):
        parser.error("--cortex and --mesh are needed (Examples/demo.sh fetches both), or --quick")
    if args.quick:
        args.vertices = min(args.vertices, 5_000)
    if args.vertices < 1:
        parser.error("--vertices must be positive")
    if not args.no_pictures and display_missing():
        parser.error("no display to draw on: run under xvfb-run, or with --no-pictures")
    return args


def main():
    args = arguments()
    white, inflated = data.read_cortex(args.cortex) if args.cortex else data.pebble_cortex()
    mesh = data.refined(data.read_mesh(args.mesh) if args.mesh else data.pebble(), args.vertices)
    side = dict(view=args.view, up=args.up)
    args.output.mkdir(parents=True, exist_ok=True)
    panels = {"cortex": smooth_cortex(white, inflated, args.wall, args.output),
              "denoise": denoise(mesh, side),
              "inpaint": inpaint(mesh, side),
              "smear": smear(mesh, side)}
    print(f"Time series for ParaView (open it, Apply, Play): {args.output / 'cortex.pvd'}")
    if args.no_pictures:
        return
    for name, row in panels.items():
        save_picture(args.output / f"{name}.png", row, 3, (200, 200) if args.quick else (600, 520))
        print(f"Picture: {args.output / name}.png")
    if args.gallery:
        rows = panels.values()
        before_above_after = [row[0] for row in rows] + [row[1] for row in rows]
        save_picture(args.gallery, before_above_after, 4, (190, 186))
        print(f"Picture: {args.gallery}")


if __name__ == "__main__":
    try:
        main()
    except (data.DataError, DemoError, OSError) as problem:
        sys.exit(f"demo.py: {problem}")
