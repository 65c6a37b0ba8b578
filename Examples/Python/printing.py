# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Textures on parts to print: a bracket, a vase and two cubes with four patterns, as STL files.

    printing.py [--quick]

The parts are made here as CAD programs write them: few large triangles, each with points of its own.
For each part the program joins these points, grows a pattern of a wavelength in millimetres
(vtkTuringTextureFilter, which bisects edges that are too long for it), raises it as relief
(vtkSurfaceReliefFilter), and leaves a fifth of the triangles, most of them where the surface is curved
(vtkQuadricDecimation). It prints the triangles and seconds of each step, the largest distance by which
decimation moved the surface, and the checks of the relief, and writes printing_<part>.stl and
printing.png. --quick takes wavelengths of three times the length.

Try next: SetLevelsToTwo() and SetFlank(0.3) for flat tops; SetOverhang(45); a mask that leaves the hole
of the bracket as it is.
"""
import sys
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from pictures import Panel, display_missing, save_picture
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import (
    vtkCleanPolyData, vtkFeatureEdges, vtkImplicitPolyDataDistance, vtkPolyDataNormals,
    vtkQuadricDecimation, vtkTriangleFilter)
from vtkmodules.vtkFiltersGeneral import vtkContourTriangulator
from vtkmodules.vtkFiltersModeling import vtkLinearExtrusionFilter, vtkRotationalExtrusionFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource
from vtkmodules.vtkIOGeometry import vtkSTLWriter

from vtkSurfaceDiffusion import vtkSurfaceReliefFilter, vtkTuringTextureFilter

REMOVED = 0.8  # of the triangles, by decimation
PLASTIC = (217, 169, 98)  # of the pictures: red, green, blue
SAMPLES = 500  # points whose distance to the decimated surface is measured


def polylines(*loops):
    """Closed polygons as lines."""
    points, lines = vtkPoints(), vtkCellArray()
    for loop in loops:
        first = points.GetNumberOfPoints()
        for point in loop:
            points.InsertNextPoint(point)
        lines.InsertNextCell(len(loop) + 1)
        for i in [*range(len(loop)), 0]:
            lines.InsertCellPoint(first + i)
    outline = vtkPolyData()
    outline.SetPoints(points)
    outline.SetLines(lines)
    return outline


def bracket():
    """An angle of 44 mm with legs of 10 mm, and a hole of 12 mm through its corner block."""
    outer = [(0, 0, 0), (44, 0, 0), (44, 10, 0), (22, 10, 0), (22, 22, 0), (10, 22, 0), (10, 44, 0),
             (0, 44, 0)]
    angles = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    hole = [(11 + 6 * np.cos(a), 11 + 6 * np.sin(a), 0) for a in -angles]
    profile = vtkContourTriangulator()
    profile.SetInputData(polylines(outer, hole))
    solid = vtkLinearExtrusionFilter()
    solid.SetInputConnection(profile.GetOutputPort())
    solid.SetExtrusionTypeToVectorExtrusion()
    solid.SetVector(0, 0, 30)
    return solid


def vase():
    """A vase of 60 mm with a wall of 3 mm: its profile, turned."""
    height = np.linspace(0, 60, 31)
    radius = 16 + 7 * np.sin(height / 60 * np.pi * 1.6 + 0.2)
    inner = [(r - 3, 0, z) for r, z in zip(radius, height) if z >= 4][::-1]
    profile = vtkPolyData()
    points, line = vtkPoints(), vtkCellArray()
    for point in [(0, 0, 0), *((r, 0, z) for r, z in zip(radius, height)), *inner, (0, 0, 4)]:
        points.InsertNextPoint(point)
    line.InsertNextCell(points.GetNumberOfPoints())
    for i in range(points.GetNumberOfPoints()):
        line.InsertCellPoint(i)
    profile.SetPoints(points)
    profile.SetLines(line)
    turned = vtkRotationalExtrusionFilter()
    turned.SetInputData(profile)
    turned.SetResolution(72)
    turned.CappingOff()
    return turned


def cube():
    source = vtkCubeSource()
    source.SetXLength(30)
    source.SetYLength(30)
    source.SetZLength(30)
    return source


@dataclass
class Part:
    name: str
    title: str
    make: Any
    ratio: float            # D1/D2: the kind of pattern
    size: float             # its wavelength in mm
    height: float           # of the relief in mm
    view: tuple
    stripes: float = 1.0    # D2 along a helix over that across it


PARTS = (
    Part("bracket", "labyrinth on a bracket", bracket, 18, 5.0, 0.7, (1, 0.7, 0.55)),
    Part("vase", "stripes on a vase", vase, 8, 6.0, 0.9, (1, 0, 0.35), 2.0),
    Part("cube_spots", "spots on a cube", cube, 5, 5.0, 0.8, (1, 0.7, 0.6)),
    Part("cube_net", "a carved net on a cube", cube, 30, 6.0, -0.6, (1, 0.7, 0.6)),
)


def joined(source):
    """The triangles of a part, with one point at each place, and a helix around z as "helix"."""
    triangles, clean = vtkTriangleFilter(), vtkCleanPolyData()
    triangles.SetInputConnection(source.GetOutputPort())
    clean.SetInputConnection(triangles.GetOutputPort())
    clean.SetAbsoluteTolerance(1e-5)
    clean.ToleranceIsAbsoluteOn()
    clean.Update()
    part = vtkPolyData()
    part.SetPoints(clean.GetOutput().GetPoints())
    part.SetPolys(clean.GetOutput().GetPolys())
    x, y, _ = vtk_to_numpy(part.GetPoints().GetData()).T
    helix = numpy_to_vtk(np.stack([-y, x, 0.7 * np.hypot(x, y)], axis=1), deep=True)
    helix.SetName("helix")
    part.GetPointData().AddArray(helix)
    return part


def textured(part, surface, size):
    texture = vtkTuringTextureFilter()
    texture.AddObserver("WarningEvent", lambda *_: None)  # that edges were bisected
    texture.SetInputData(surface)
    texture.SetFeatureSize(size)
    texture.SetDiffusionRate1(part.ratio * 2.6)
    texture.SetTimeStep(1 / 8)
    texture.SetNumberOfTimeSteps(800)
    texture.SetStopTolerance(0.03)
    texture.SetCoarseStartSize(250_000)  # patterns from a coarser mesh are flatter
    if part.stripes != 1:
        texture.SetInputArrayToProcess(2, 0, 0, 0, "helix")
        texture.SetDiffusionRateAcross1(part.ratio * 2.6)
        texture.SetDiffusionRate2(2.6 * part.stripes)
        texture.SetDiffusionRateAcross2(2.6)
    texture.Update()
    return texture


def decimated(surface):
    """Without most of the triangles that flat parts do not need, by quadric error metrics. It is closed
    where the surface is. vtkDecimatePro would keep to a tolerance, but leaves edges of four triangles."""
    fewer = vtkQuadricDecimation()
    fewer.SetInputData(surface)
    fewer.SetTargetReduction(REMOVED)
    fewer.Update()
    return without_fins(fewer.GetOutput())


def without_fins(surface):
    """Without triangles of which only one edge belongs to others, too. Quadric decimation leaves some: two
    open edges each, on an edge of three triangles."""
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    _, edges, counts = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    kept = triangles[(counts[edges.reshape(-1, 3)] == 1).sum(axis=1) < 2]
    polygons = vtkCellArray()
    polygons.SetData(3, numpy_to_vtk(kept.ravel(), deep=True))
    closed = vtkPolyData()
    closed.SetPoints(surface.GetPoints())
    closed.SetPolys(polygons)
    return closed


def distance_between(surface, fewer):
    """The largest distance of some points of a surface to the decimated one."""
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(fewer)
    points = vtk_to_numpy(surface.GetPoints().GetData())
    chosen = np.random.default_rng(0).choice(len(points), min(SAMPLES, len(points)), replace=False)
    return max(abs(distance.EvaluateFunction(*point)) for point in points[chosen].tolist())


def unpaired_edges(surface):
    """The number of edges that do not have two triangles."""
    edges = vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.FeatureEdgesOff()
    edges.Update()
    return edges.GetOutput().GetNumberOfLines()


def shaded(surface):
    """With normals that end at sharp edges."""
    normals = vtkPolyDataNormals()
    normals.SetInputData(surface)
    normals.SetFeatureAngle(50)
    normals.Update()
    output = normals.GetOutput()
    colours = numpy_to_vtk(np.tile(np.uint8(PLASTIC), (output.GetNumberOfPoints(), 1)), deep=True)
    colours.SetName("Colour")
    output.GetPointData().AddArray(colours)
    return output


def main():
    scale = 3 if "--quick" in sys.argv[1:] else 1
    panels = []
    for part in PARTS:
        seconds = [time.perf_counter()]
        surface = joined(part.make())
        texture = textured(part, surface, scale * part.size)
        seconds.append(time.perf_counter())
        relief = vtkSurfaceReliefFilter()
        relief.SetInputConnection(texture.GetOutputPort())
        relief.SetHeight(part.height)
        relief.Update()
        seconds.append(time.perf_counter())
        fewer = decimated(relief.GetOutput())
        seconds.append(time.perf_counter())
        writer = vtkSTLWriter()
        writer.SetInputData(fewer)
        writer.SetFileTypeToBinary()
        writer.SetFileName(f"printing_{part.name}.stl")
        writer.Write()
        steps = np.diff(seconds)
        counts = [data.GetNumberOfCells() for data in (surface, relief.GetOutput(), fewer)]
        print(f"{part.title}: {counts[0]} triangles, with the pattern {counts[1]} ({steps[0]:.1f} s), "
              f"relief of {part.height} mm ({steps[1]:.1f} s), decimated {counts[2]} ({steps[2]:.1f} s, "
              f"moved by {distance_between(relief.GetOutput(), fewer):.3f} mm); "
              f"{relief.GetOpenEdges()} open edges, {unpaired_edges(fewer)} unpaired after decimation, "
              f"{relief.GetCrossingTriangles()} crossing triangles, smallest wall "
              f"{relief.GetSmallestWall():.2f} mm, volume {relief.GetVolumeChange():+.0f} mm^3")
        panels.append(Panel(shaded(relief.GetOutput()), "Colour", part.title,
                            f"{part.size:g} mm wide, {abs(part.height):g} mm "
                            + ("high" if part.height > 0 else "deep"),
                            part.view, (0, 0, 1)))
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("printing.png", panels, 4, (400, 400))


if __name__ == "__main__":
    main()
