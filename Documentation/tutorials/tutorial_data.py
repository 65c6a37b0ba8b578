# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Data of the tutorials, from the folders that .ci/fetch-test-data makes."""
import os
import sys
import tempfile
import zipfile
from pathlib import Path

import numpy as np
import pyvista

from surfacediffusion.files import read_data, read_surface


def scan(name):
    """Points and triangles of a mesh of CGAL's demos."""
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    if not folder:
        print("skipped: SURFACEDIFFUSION_MESH_DIR is not set (.ci/fetch-test-data)")
        sys.exit(77)
    surface = read_surface(Path(folder, f"{name}.off"))
    return surface.points, surface.faces


def brain_file(package, member):
    """The bytes of a file of a wheel with brains."""
    wheels = sorted(Path(os.environ.get("SURFACEDIFFUSION_BRAIN_DIR", "")).glob(f"{package}-*.whl"))
    if not wheels:
        print(f"skipped: SURFACEDIFFUSION_BRAIN_DIR has no {package} (.ci/fetch-test-data)")
        sys.exit(77)
    with zipfile.ZipFile(wheels[0]) as wheel:
        return wheel.read(member)


def cortex():
    """Points and triangles of fsaverage5's left white surface, and its thickness in mm."""
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for kind in ("white", "thick"):
            path = Path(folder, f"{kind}_left.gii.gz")
            path.write_bytes(brain_file("nilearn", f"nilearn/datasets/data/fsaverage5/{path.name}"))
            files[kind] = path
        surface, data = read_surface(files["white"]), read_data(files["thick"])
    return surface.points, surface.faces, data.parts[0].values[:, 0].astype(float)


def medial_wall():
    """Where fsaverage5's left surface is no cortex. A time series on it is 0 there at all times."""
    name = "sub-010188_ses-02_task-rest_acq-AP_run-01.fsa5.lh.mgz"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, name)
        path.write_bytes(brain_file("brainspace", f"brainspace/datasets/preprocessing/{name}"))
        return ~read_data(path).parts[0].values.any(axis=1)


def show(points, faces, arrays, view=(0, 0, 1), up=(0, 1, 0), **options):
    """Draw arrays {title: values} side by side on one surface, or surfaces {title: points}."""
    plotter = pyvista.Plotter(shape=(1, len(arrays)), off_screen=True,
                              window_size=(400 * len(arrays), 400), border=False)
    for column, (title, values) in enumerate(arrays.items()):
        plotter.subplot(0, column)
        values = np.asarray(values)
        moved = values if values.shape == np.shape(points) and values.dtype != np.uint8 else points
        mesh = pyvista.PolyData.from_regular_faces(np.asarray(moved, float), np.asarray(faces))
        known = np.isfinite(values) if values.ndim == 1 else np.ones(len(values), bool)
        if known.mean() < 0.1:  # measured at a few points
            plotter.add_mesh(mesh, color="lightgrey")
            plotter.add_mesh(pyvista.PolyData(np.asarray(points)[known] * 1.01), render_points_as_spheres=True,
                             scalars=values[known], point_size=9, show_scalar_bar=False, **options)
        elif moved is values:
            plotter.add_mesh(mesh, color="white", split_sharp_edges=True)
        else:
            plotter.add_mesh(mesh, scalars=values, rgb=values.ndim == 2, show_scalar_bar=False,
                             **options)
        plotter.add_text(title, font_size=10)
        plotter.view_vector(view, up)
    plotter.link_views()
    plotter.show()

