# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surface images of nilearn: data on the meshes of both hemispheres. nilearn is not imported."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._functions import heat
from ._fwhm import FWHMEstimate, estimate_fwhm
from ._settings import as_number, shorten
from ._surface import Surface, as_surface


def smooth_img(
    img: Any, fwhm: float | None, *, mask_img: Any = None, number_of_time_steps: int = 1,
    progress: Any = None,
) -> Any:
    """Smooth surface images of nilearn, both hemispheres, by a given width.

    This is :func:`heat` with ``fwhm``, for each mesh of the image, and gives the values of the command
    ``surfacediffusion smooth``. The width is that of a Gaussian along the surface in the unit of the
    meshes (mm), and the integral over the surface is kept. (nilearn's own function of this name averages
    neighbours, and knows the width by a number of repetitions.)

    Parameters
    ----------
    img : nilearn.surface.SurfaceImage, or a list of these
        Data of shape (n,) or (n, k) on each mesh. NaN is missing, and has a value afterwards.
    fwhm : float, 0 or more, or None
        The full width at half maximum of the Gaussian. 0 and None: the values stay, as with
        nilearn, and so does NaN, for which nilearn has 0.
    mask_img : nilearn.surface.SurfaceImage, optional
        The region of interest, as nilearn has it: nonzero is inside. Nothing flows across its
        boundary, and outside the result is 0. For instance the cortex without the medial wall.
    number_of_time_steps : int, default 1
        As for :func:`heat` with the time integrator "Exponential", of which one step has an error of 0.5 %
        in time for white noise. Values may leave the range of the data by 5e-4 of it, and by more at
        widths below 3 edges and at obtuse angles of boundaries.
    progress : bool or callable, optional
        As for :func:`heat`.

    Returns
    -------
    SurfaceImage with the meshes of `img`, or a list of these
        float32 stays float32, all other types become float64.

    Examples
    --------
    With nilearn:

    >>> from surfacediffusion import smooth_img
    >>> smooth = smooth_img(img, fwhm=10)                                  # doctest: +SKIP
    """
    many = isinstance(img, (list, tuple))
    surfaces: dict[int, Surface] = {}  # images of one study have one mesh: one factor
    results = [_smooth(one, fwhm, mask_img, number_of_time_steps, progress, surfaces)
               for one in (img if many else [img])]
    return results if many else results[0]


def estimate_fwhm_img(
    img: Any, *, mask_img: Any = None, demean: bool = True
) -> dict[str, FWHMEstimate]:
    """Estimate the smoothness of noise in a surface image of nilearn, on each mesh.

    Parameters
    ----------
    img : nilearn.surface.SurfaceImage
        Noise maps without signal, such as the residuals of a first-level model. NaN is missing.
    mask_img : nilearn.surface.SurfaceImage, optional
        The region of interest: nonzero is inside.
    demean : bool, default True
        As for :func:`estimate_fwhm`.

    Returns
    -------
    dict of FWHMEstimate
        For the keys of the image, ``"left"`` and ``"right"``.

    Examples
    --------
    >>> from surfacediffusion import estimate_fwhm_img
    >>> estimate_fwhm_img(residuals)["left"].pooled                        # doctest: +SKIP
    6.1
    """
    meshes, data, roi = _parts(img, mask_img)
    return {name: estimate_fwhm(as_surface(mesh), data[name], roi=roi.get(name), demean=demean)
            for name, mesh in meshes.items()}


def _parts(
    img: Any, mask_img: Any
) -> tuple[dict[str, Any], dict[str, NDArray[Any]], dict[str, Any]]:
    """Meshes, data and regions by the names of the hemispheres."""
    found = []
    for argument, image in (("img", img), ("mask_img", mask_img)):
        if argument == "mask_img" and image is None:
            found.append({})
            continue
        try:
            found.append(dict(image.data.parts))
            meshes = dict(image.mesh.parts)
        except AttributeError:
            raise ValueError(
                f"{argument} is {shorten(image)}; allowed: a SurfaceImage of nilearn") from None
        if argument == "img":
            found.insert(0, meshes)
    meshes, data, regions = found
    if regions and set(regions) != set(meshes):
        raise ValueError(f"mask_img has the parts {', '.join(regions)}; allowed: those of img, "
                         + ", ".join(meshes))
    return meshes, {name: np.asarray(values) for name, values in data.items()}, {
        name: np.asarray(values).reshape(len(values), -1)[:, 0] for name, values in regions.items()}


def _smooth(img: Any, fwhm: float | None, mask_img: Any, steps: int, progress: Any,
            surfaces: dict[int, Surface]) -> Any:
    width = 0.0 if fwhm is None else as_number(
        "fwhm", fwhm, "finite numbers, 0 or more, or None", lambda number: 0.0 <= number < np.inf)
    meshes, data, roi = _parts(img, mask_img)
    results = {}
    for name, mesh in meshes.items():
        surface = surfaces.setdefault(id(mesh), as_surface(mesh))
        values = data[name]
        if values.dtype != np.float32:
            values = values.astype(np.float64)
        outside = None if name not in roi else ~(np.nan_to_num(roi[name]) != 0)
        results[name] = _smooth_part(surface, values, width, outside, steps, progress)
    return type(img)(mesh=img.mesh, data=results)


def _smooth_part(surface: Surface, values: NDArray[Any], fwhm: float, outside: Any, steps: int,
                 progress: Any) -> NDArray[Any]:
    """Columns whose missing values are at the same points are solved together."""
    columns = values.reshape(len(values), -1)
    result = np.zeros_like(columns)
    if outside is not None and outside.shape == (len(values),):
        if outside.all():
            return result.reshape(values.shape)
        columns = np.where(outside[:, None], columns.dtype.type(0), columns)
    if fwhm == 0.0:
        return np.array(columns).reshape(values.shape)
    groups: dict[bytes, list[int]] = {}
    for i, missing in enumerate(np.isnan(columns).T):
        groups.setdefault(np.packbits(missing).tobytes(), []).append(i)
    for group in groups.values():
        result[:, group] = heat(
            surface, columns[:, group], fwhm=fwhm, mask=outside, mask_mode="Exclude",
            time_integrator="Exponential", number_of_time_steps=steps, progress=progress)
    return result.reshape(values.shape)
