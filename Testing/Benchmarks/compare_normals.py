# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares harmonic maps with averaging of normals at equal run time.

    compare_normals.py surface.off [...]       (with Examples/Python on PYTHONPATH)

There are two comparisons. In the first, the normals of a clean mesh are noisy, and
vtkAttributeSmoothingFilter averages them. In the second, the points are noisy, and
vtkPolyDataNormals computes the normals of the mesh that vtkSmoothPolyDataFilter has smoothed. Each
alternative makes as many iterations as fit into the run time of vtkHarmonicMapFilter, and is also
shown with its best number of iterations. The program prints the angles to the clean normals in
degrees and the energy of the maps per step.
"""
import sys
from pathlib import Path
from time import process_time

import numpy as np
from surface_data import array_of, make_surface, points_of, read_mesh, triangles_of, with_arrays
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals, vtkSmoothPolyDataFilter
from vtkmodules.vtkFiltersGeometry import vtkAttributeSmoothingFilter

from vtkSurfaceDiffusion import vtkHarmonicMapFilter


def seconds_of(work):
    """The result of work() and the shortest of three CPU times."""
    times = []
    for _ in range(3):
        start = process_time()
        result = work()
        times.append(process_time() - start)
    return result, min(times)


def normals_of(surface):
    maker = vtkPolyDataNormals()
    maker.SetInputData(surface)
    maker.SplittingOff()
    maker.Update()
    return vtk_to_numpy(maker.GetOutput().GetPointData().GetNormals()).astype(float)


def harmonic(surface, exponent, steps, time_step):
    regulariser = vtkHarmonicMapFilter()
    regulariser.SetInputData(surface)
    regulariser.SetExponent(exponent)
    regulariser.SetNumberOfTimeSteps(steps)
    regulariser.SetTimeStep(time_step)
    regulariser.Update()
    energy = vtk_to_numpy(regulariser.GetOutputDataObject(1).GetColumnByName("Energy"))
    return array_of(regulariser.GetOutput(), "NormalsHarmonic"), energy


def averaged(surface, iterations):
    smoother = vtkAttributeSmoothingFilter()
    smoother.SetInputData(surface)
    smoother.SetNumberOfIterations(iterations)
    smoother.SetRelaxationFactor(0.1)
    smoother.SetSmoothingStrategyToAllPoints()
    smoother.Update()
    vectors = array_of(smoother.GetOutput(), "Normals").astype(float)
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def of_smoothed_mesh(surface, iterations):
    smoother = vtkSmoothPolyDataFilter()
    smoother.SetInputData(surface)
    smoother.SetNumberOfIterations(iterations)
    smoother.SetRelaxationFactor(0.1)
    smoother.Update()
    return normals_of(smoother.GetOutput())


def report(title, normals, clean, seconds):
    angles = np.degrees(np.arccos(np.clip((normals * clean).sum(axis=1), -1, 1)))
    print(f"  {title:44} mean {angles.mean():5.2f}  median {np.median(angles):5.2f}  largest "
          f"{angles.max():5.1f}  {seconds:5.2f} s")
    return angles.mean()


def compare(surface, clean, rival, name):
    """Reports the maps at the best time for each exponent, then the alternative."""
    report("noisy", array_of(surface, "Normals"), clean, 0)
    budget = 0
    for exponent in (2, 1):
        best = min((0.02, 0.05, 0.1, 0.2, 0.4), key=lambda time: np.mean(np.arccos(np.clip((
            harmonic(surface, exponent, 4, time / 4)[0] * clean).sum(axis=1), -1, 1))))
        (normals, energy), seconds = seconds_of(lambda: harmonic(surface, exponent, 4, best / 4))
        report(f"p = {exponent}, time {best} h^p in 4 steps", normals, clean, seconds)
        print("      energy", *(f"{value:.5g}" for value in energy))
        budget = max(budget, seconds)
    fixed, slope = (seconds_of(lambda: rival(surface, count))[1] for count in (1, 21))
    count = max(1, round(20 * (budget - fixed) / max(slope - fixed, 1e-6)))
    normals, seconds = seconds_of(lambda: rival(surface, count))
    report(f"{name}, {count} iterations", normals, clean, seconds)
    best = min((2, 5, 10, 20, 50, 100), key=lambda count: np.mean(
        np.arccos(np.clip((rival(surface, count) * clean).sum(axis=1), -1, 1))))
    normals, seconds = seconds_of(lambda: rival(surface, best))
    report(f"{name}, {best} iterations (its best)", normals, clean, seconds)


def main():
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_WARNING)  # no information messages
    for file in sys.argv[1:]:
        surface = read_mesh(Path(file))
        clean = normals_of(surface)
        random = np.random.default_rng(1)
        print(f"{Path(file).stem}: {surface.GetNumberOfPoints()} vertices, noise in the normals")
        noisy = clean + random.normal(0, 0.2, clean.shape)
        noisy /= np.linalg.norm(noisy, axis=1, keepdims=True)
        noisy_surface = with_arrays(surface, Normals=noisy)
        noisy_surface.GetPointData().SetActiveNormals("Normals")
        compare(noisy_surface, clean, averaged, "vtkAttributeSmoothingFilter")

        print(f"{Path(file).stem}: noise in the points")
        corners = points_of(surface)[triangles_of(surface)]
        edge = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean()
        moved = make_surface(points_of(surface) + random.normal(0, 0.1 * edge, clean.shape),
                             triangles_of(surface))
        noisy_surface = with_arrays(moved, Normals=normals_of(moved))
        noisy_surface.GetPointData().SetActiveNormals("Normals")
        compare(noisy_surface, clean, of_smoothed_mesh, "vtkPolyDataNormals of a smoothed mesh")


if __name__ == "__main__":
    main()
