# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Data in GIFTI files. A column is (number of the array, number of its column or None)."""
from __future__ import annotations

import copy

import numpy as np

from .content import import_reader

_SURFACE_INTENTS = (1008, 1009)  # NIFTI_INTENT_POINTSET, NIFTI_INTENT_TRIANGLE
_LABEL_INTENT = 1002


def read(content):
    """The image, its columns, and the structure of the brain that it belongs to."""
    gifti = import_reader("nibabel.gifti", content)
    image = gifti.GiftiImage.from_bytes(content.bytes)
    columns = []
    for i, array in enumerate(image.darrays):
        if array.intent in _SURFACE_INTENTS:
            continue
        if array.data is None or array.data.ndim > 2:
            raise ValueError(f"array {i + 1} is not of one or two dimensions")
        if array.data.ndim == 1:
            columns.append((i, None))
        else:
            columns.extend((i, j) for j in range(array.data.shape[1]))
    if not columns and image.darrays:
        raise content.error("a GIFTI surface, which has no data at vertices; allowed: "
                            ".func.gii, .shape.gii, .label.gii")
    return image, columns, image.meta.get("AnatomicalStructurePrimary") or ""


def column(image, place):
    i, j = place
    data = image.darrays[i].data
    return data if j is None else data[:, j]


def name(image, place):
    i, j = place
    text = image.darrays[i].meta.get("Name") or ""
    return text if j is None else f"{text}[{j}]"


def has_labels(image):
    return any(array.intent == _LABEL_INTENT for array in image.darrays)


def write(image, places, values):
    """The image with these columns alone, and new values in them."""
    changed = copy.copy(image)
    changed.darrays = []
    for i in dict.fromkeys(i for i, _ in places):
        array = copy.copy(image.darrays[i])
        chosen = [c for c, (k, _) in enumerate(places) if k == i]
        data = np.asarray(values)[:, chosen].astype(np.float32)
        array.data = data[:, 0] if image.darrays[i].data.ndim == 1 else data
        array.dims = list(array.data.shape)
        array.datatype = 16  # NIFTI_TYPE_FLOAT32
        # Data in a file beside this one are written into it.
        if array.encoding == 4:
            array.encoding, array.ext_fname, array.ext_offset = 3, "", 0
        changed.darrays.append(array)
    return changed.to_bytes()


def new(surface, names):
    """An image for new columns on a surface, and its columns."""
    from nibabel import gifti

    meta = {"AnatomicalStructurePrimary": surface.structure} if surface.structure else {}
    arrays = [
        gifti.GiftiDataArray(np.zeros(1, dtype=np.float32), intent="NIFTI_INTENT_NONE",
                             datatype="NIFTI_TYPE_FLOAT32", meta={"Name": text})
        for text in names]
    image = gifti.GiftiImage(darrays=arrays, meta=gifti.GiftiMetaData(meta))
    return image, [(i, None) for i in range(len(names))]
