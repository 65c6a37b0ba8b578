# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Find a minimal surface over a fixed boundary by the Beltrami flow.

    minimal_surface.py

The Beltrami flow draws the data u over the surface as a surface in more dimensions and reduces its
area. Over the square [-1.2, 1.2]^2 with u held fixed at the boundary, its steady state is the
minimal surface with this boundary. For the boundary values of Scherk's surface,

    u = log(cos x / cos y),

the solution is known everywhere. The program runs the flow in large time steps on irregular
triangulations of three sizes, and prints the error and the area, which never grows. The root mean
square error falls with the square of the mean edge length. It writes minimal_surface.png: the harmonic
function with the same boundary values, which is the steady state of linear diffusion, the steady
state of the Beltrami flow, and Scherk's surface, coloured by their distance from the latter.

Try next: other boundary values, for which no formula is known; SetColorScale(0.1), which makes the
Beltrami flow nearly linear.
"""
import numpy as np
from pictures import Panel, colour_table, display_missing, save_picture
from surface_data import array_of, make_surface, mean_edge_length, points_of, triangles_of, with_arrays
from vtkmodules.util.numpy_support import vtk_to_numpy

from vtkSurfaceDiffusion import vtkFVMHeatFilter, vtkTensorDiffusionFilter

HALF = 1.2  # of the width of the square; Scherk's surface ends at pi/2


def irregular_square(cells, seed=1):
    """A triangulated square whose inner points are moved at random by up to a tenth of a cell."""
    line = np.linspace(-HALF, HALF, cells + 1)
    x, y = (axis.ravel() for axis in np.meshgrid(line, line))
    inner = (abs(x) < HALF - 1e-9) & (abs(y) < HALF - 1e-9)
    moves = np.random.default_rng(seed).uniform(-0.1, 0.1, (2, len(x))) * inner * 2 * HALF / cells
    corner = np.arange((cells + 1) ** 2).reshape(cells + 1, -1)[:-1, :-1].ravel()
    odd = (corner // (cells + 1) + corner % (cells + 1)) % 2 == 1
    a, b, c, d = corner, corner + 1, corner + cells + 1, corner + cells + 2
    first = np.where(odd[:, None], np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(odd[:, None], np.stack([b, d, c], 1), np.stack([a, d, c], 1))
    points = np.stack([x + moves[0], y + moves[1], np.zeros(len(x))], 1)
    return make_surface(points, np.concatenate([first, second])), ~inner


def steady_state(model, surface):
    model.SetInputData(surface)
    model.SetInputArrayToProcess(0, 0, 0, 0, "start")
    model.SetInputArrayToProcess(3, 0, 0, 0, "boundary")
    model.SetUnitsToAbsolute()
    model.Update()
    output = model.GetOutput()
    return array_of(output, output.GetPointData().GetScalars().GetName()).copy()


def beltrami():
    model = vtkTensorDiffusionFilter()
    model.SetColorScale(1)
    model.SetTimeStep(1e4)
    model.SetNumberOfTimeSteps(120)
    return model


def harmonic():
    model = vtkFVMHeatFilter()
    model.SetModeToSteadyState()
    return model


def solve(cells):
    """The surface, both steady states and the exact solution, the mean edge length, and the energy
    after each step."""
    surface, boundary = irregular_square(cells)
    x, y, _ = points_of(surface).T
    exact = np.log(np.cos(x) / np.cos(y))
    surface = with_arrays(surface, boundary=boundary.astype(np.uint8),
                          start=np.where(boundary, exact, 0.0))
    flow = beltrami()
    minimal = steady_state(flow, surface)
    energy = vtk_to_numpy(flow.GetOutputDataObject(1).GetColumnByName("Energy")).copy()
    linear = steady_state(harmonic(), surface)
    return surface, (linear, minimal, exact), mean_edge_length(surface), energy


def raised(surface, height, exact):
    """The surface at this height, with its distance from the exact solution."""
    points = points_of(surface) + np.outer(height, [0, 0, 1])
    return with_arrays(make_surface(points, triangles_of(surface)), error=np.abs(height - exact))


def main():
    lengths, errors = [], []
    for cells in (30, 60, 120):
        surface, states, length, energy = solve(cells)
        assert (np.diff(energy) <= 1e-12 * energy[0]).all(), "the area has grown"
        of_linear, of_minimal = (np.abs(state - states[2]).max() for state in states[:2])
        lengths.append(length)
        errors.append(np.sqrt(np.mean((states[1] - states[2]) ** 2)))
        print(f"{surface.GetNumberOfPoints()} points: error of the Beltrami flow {errors[-1]:.2e}, "
              f"at most {of_minimal:.2e}, of linear diffusion at most {of_linear:.2e}; area beyond "
              f"the square {energy[0]:.3f} -> {energy[-1]:.4f}")
    order = np.polyfit(np.log(lengths), np.log(errors), 1)[0]
    print(f"order of convergence {order:.2f}")
    assert order > 1.8 and of_minimal < 2e-4 and of_linear > 0.1, (order, of_minimal, of_linear)
    if display_missing():
        print("  no picture: there is no display")
        return
    table = colour_table(0, 0.1, [(0.95, 0.94, 0.90), (0.95, 0.70, 0.35), (0.70, 0.15, 0.15)])
    notes = (f"largest error {of_linear:.2g}", f"largest error {of_minimal:.1g}",
             "log(cos x / cos y)")
    titles = ("linear diffusion", "Beltrami flow", "Scherk's surface")
    panels = [Panel(raised(surface, state, states[2]), "error", title, note, (0.6, -1.0, 0.55),
                    (0, 0, 1), table=table, bar=True)
              for state, title, note in zip(states, titles, notes)]
    save_picture("minimal_surface.png", panels, 3, (420, 360))


if __name__ == "__main__":
    main()
