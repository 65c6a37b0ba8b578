# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Close interrupted stripes by coherence-enhancing diffusion.

    tensor_diffusion.py [surface.off or .vtp | --quick]

Two patterns are grown on surfaces as textures: stripes that wind around a scan along the directions
of its curvature, and a pattern like a fingerprint on a closed surface. Both are interrupted by round
gaps and covered by noise. The program restores them by three kinds of diffusion of the same time:

- isotropic diffusion, which loses the stripes together with the noise;
- anisotropic diffusion along a given direction: that of the curvature, along which the stripes of the
  scan were grown, and which those of the fingerprint do not follow;
- coherence-enhancing diffusion, which finds the direction in the noisy data.

It prints the correlation with the pattern before the damage, everywhere and in the gaps, and writes
tensor_diffusion.png. Without an argument it takes scans of libcgal-demo from the folder
SURFACEDIFFUSION_MESH_DIR, or a generated surface if that is not set. --quick: a small generated one.

Try next: SetContrast(0.05), at which gaps stay open; SetModelToEdgeEnhancing();
DiffusionAxesOn(), which gives the directions that were found as cell data.
"""
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pictures import Panel, colour_table, display_missing, save_picture
from surface_data import (
    array_of, mean_edge_length, pebble, points_of, read_mesh, refined, with_arrays)
from vtkmodules.vtkCommonDataModel import vtkDataObject

from vtkSurfaceDiffusion import (
    vtkFVMHeatFilter, vtkSurfaceDirectionFieldFilter, vtkTensorDiffusionFilter,
    vtkTuringTextureFilter)

VERTICES = 20_000
STRIPE = 12  # mean edge lengths from stripe to stripe
GAP = 2.5  # the radius of a gap, likewise
TIME = 25  # in squared mean edge lengths
STEPS = 10
POINTS, CELLS = vtkDataObject.FIELD_ASSOCIATION_POINTS, vtkDataObject.FIELD_ASSOCIATION_CELLS


@dataclass
class Pattern:
    title: str
    mesh: str
    view: tuple
    stripes: bool  # along the direction of curvature
    noise: float  # standard deviation


PATTERNS = [
    Pattern("stripes on a scan", "camel", (1, 0.1, 0.3), True, 0.3),
    Pattern("a fingerprint", "bear", (0, 0, 1), False, 0.3),
]


def with_directions(surface, size):
    """The surface with the cell array Direction, along the smaller curvature."""
    field = vtkSurfaceDirectionFieldFilter()
    field.SetInputData(surface)
    field.SetMethodToCurvatureAligned()
    field.SetPrincipalDirectionToMaximum()
    field.SetSmoothingLength(size)
    field.SetHintWeight(0.0005)
    field.Update()
    return field.GetOutput()


def grown(surface, pattern, size):
    """A texture between 0 and 1."""
    turing = vtkTuringTextureFilter()
    turing.SetInputData(surface)
    turing.SetFeatureSize(size)
    turing.SetDiffusionRate1(2.6 * (8 if pattern.stripes else 18))
    if pattern.stripes:
        turing.SetInputArrayToProcess(2, 0, 0, CELLS, "Direction")
        turing.SetDiffusionRate2(2 * 2.6)
        turing.SetDiffusionRateAcross2(2.6)
    turing.SetTimeStep(1 / 8)
    turing.SetNumberOfTimeSteps(800)
    turing.SetStopTolerance(0.03)
    turing.Update()
    u = array_of(turing.GetOutput(), "u1")
    low, high = np.quantile(u, (0.1, 0.9))
    return np.clip((u - low) / (high - low), 0, 1)


def gaps(surface, radius, share=0.12, seed=3):
    """Marks round gaps that cover this share of the points."""
    points = points_of(surface)
    random = np.random.default_rng(seed)
    inside = np.zeros(len(points), bool)
    while inside.mean() < share:
        inside |= np.linalg.norm(points - points[random.integers(len(points))], axis=1) < radius
    return inside


def isotropic():
    return vtkFVMHeatFilter()


def along_given_direction():
    model = vtkFVMHeatFilter()
    model.SetInputArrayToProcess(2, 0, 0, CELLS, "Direction")
    model.SetAcrossDiffusivity(1e-3)
    return model


def coherence_enhancing():
    model = vtkTensorDiffusionFilter()
    model.SetModelToCoherenceEnhancing()
    model.SetContrast(0.01)  # in gaps, and with noise in the range of the data, lines are weak
    model.SetIntegrationScale(3)
    return model


MODELS = {"isotropic": isotropic, "along curvature": along_given_direction,
          "coherence": coherence_enhancing}


def result_of(model, surface):
    model.SetInputData(surface)
    model.SetInputArrayToProcess(0, 0, 0, POINTS, "damaged")
    model.SetTimeStep(TIME / STEPS)
    model.SetNumberOfTimeSteps(STEPS)
    model.Update()
    output = model.GetOutput()
    return array_of(output, output.GetPointData().GetScalars().GetName()).copy()


def correlation(values, clean, where=slice(None)):
    return np.corrcoef(values[where], clean[where])[0, 1]


def restore(surface, pattern):
    """The pattern, the damaged one and the results by title, and the points in gaps."""
    h = mean_edge_length(surface)
    surface = with_directions(surface, STRIPE * h)
    clean = grown(surface, pattern, STRIPE * h)
    broken = gaps(surface, GAP * h)
    noise = np.random.default_rng(1).normal(0, pattern.noise, len(clean))
    damaged = np.where(broken, clean.mean(), clean) + noise
    surface = with_arrays(surface, damaged=damaged)
    shown = {"pattern": clean, "interrupted": damaged}
    shown.update({title: result_of(make(), surface) for title, make in MODELS.items()})
    everywhere = {title: correlation(values, clean) for title, values in shown.items()}
    inside = {title: correlation(values, clean, broken) for title, values in shown.items()}
    print(f"{pattern.title}: {surface.GetNumberOfPoints()} vertices, {broken.mean():.0%} in gaps")
    for title in shown:
        print(f"  {title:15}: correlation {everywhere[title]:.3f}, in gaps {inside[title]:.3f}")
    others = ["interrupted", "isotropic"] + ([] if pattern.stripes else ["along curvature"])
    for other in others:
        assert everywhere["coherence"] > everywhere[other] + 0.1, everywhere
        assert inside["coherence"] > inside[other] + 0.1, inside
    return surface, shown, everywhere, inside


def panels_of(pattern, surface, shown, everywhere, inside):
    table = colour_table(-0.1, 1.1, [(0.10, 0.12, 0.20), (0.80, 0.55, 0.35), (0.99, 0.95, 0.88)])
    titles = {"pattern": pattern.title, "interrupted": "gaps and noise",
              "isotropic": "isotropic diffusion", "along curvature": "along the curvature",
              "coherence": "coherence-enhancing"}
    for title, values in shown.items():
        note = "" if title == "pattern" else (
            f"correlation {everywhere[title]:.2f}, in gaps {inside[title]:.2f}")
        yield Panel(with_arrays(surface, shown=values), "shown", titles[title], note, pattern.view,
                    (0, 1, 0), table=table)


def main():
    quick = sys.argv[1:] == ["--quick"]
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    panels = []
    for pattern in PATTERNS:
        if quick:
            surface = pebble()
        elif len(sys.argv) > 1:
            surface = read_mesh(Path(sys.argv[1]))
        elif folder:
            surface = read_mesh(Path(folder) / f"{pattern.mesh}.off")
        else:
            surface = pebble()
        given = not quick and (folder or len(sys.argv) > 1)
        surface = refined(surface, VERTICES / 2 if given else VERTICES / 8)
        panels.extend(panels_of(pattern, *restore(surface, pattern)))
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("tensor_diffusion.png", panels, 5, (200, 200) if quick else (360, 360))


if __name__ == "__main__":
    main()
