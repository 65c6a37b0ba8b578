# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Small files to try the package with, which it has with it: fetch() gives their paths, without a network.

=========================== ========================================================================
lh.white.surf.gii.gz        fsaverage5's left white surface, 10,242 vertices, in mm
lh.thickness.shape.gii.gz   the thickness of its cortex in mm
lh.cortex.label.gz          its vertices without the 888 of the medial wall
=========================== ========================================================================

fsaverage5 is the average brain of FreeSurfer (https://surfer.nmr.mgh.harvard.edu, with a licence of its
own), its surface and thickness as nilearn has them.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any, Mapping

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["fetch", "show"]

#: SHA-256 of each file.
CHECKSUMS = {
    "lh.white.surf.gii.gz": "ecd590c1405e5553604fd4b113cee13d62638e5fb4084438201db82a4c711c64",
    "lh.thickness.shape.gii.gz": "89ac80c01387cd0858218eb62440f5a301be06de6553427938401c387bcdcae9",
    "lh.cortex.label.gz": "d8196b53f603399c3f839fb252a62dc32c4e532ff73fd317a92c94ab9c3e1970",
}


def fetch(name: str) -> Path:
    """Return the path of a file of this package, after a check of its contents.

    Parameters
    ----------
    name : str
        One of those above.

    Raises
    ------
    ValueError
        For other names.
    OSError
        If the file is missing or damaged.

    Examples
    --------
    >>> from surfacediffusion.examples import fetch
    >>> fetch("lh.cortex.label.gz").name
    'lh.cortex.label.gz'
    """
    if name not in CHECKSUMS:
        raise ValueError(f"name is {name!r}; allowed: {', '.join(CHECKSUMS)}")
    path = Path(__file__).parent / name
    if hashlib.sha256(path.read_bytes()).hexdigest() != CHECKSUMS[name]:
        raise OSError(f"{path} is damaged; install surfacediffusion again")
    return path


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
