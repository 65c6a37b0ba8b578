# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Small files of every format for the tests of the command."""

import contextlib
import importlib.util
import io
import struct
import sys
from pathlib import Path

import numpy as np

try:
    import nibabel as nib
    from nibabel import cifti2, freesurfer, gifti
except ImportError as missing:
    print(missing)
    sys.exit(77)  # skipped

HAS_VTK = importlib.util.find_spec("vtkmodules") is not None


def sphere(refinements=2, radius=10.0):
    """An icosahedron whose faces are cut into four, on a sphere: points (n, 3), faces (m, 3)."""
    t = (1 + 5**0.5) / 2
    points = [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t),
              (0, 1, -t), (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
             (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
             (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(refinements):
        middle, new = {}, []

        def between(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(points)
                points.append(tuple(np.add(points[a], points[b]) / 2))
            return middle[key]

        for a, b, c in faces:
            ab, bc, ca = between(a, b), between(b, c), between(c, a)
            new += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = new
    points = np.array(points, dtype=float)
    points *= radius / np.linalg.norm(points, axis=1)[:, None]
    return points, np.array(faces)


POINTS, FACES = sphere()
N = len(POINTS)
# Smooth data and noise, both with a mean.
SMOOTH = (2 + 0.1 * POINTS[:, 2]).astype(np.float32)
NOISE = np.random.default_rng(1).normal(3, 1, N).astype(np.float32)


def write_surface(path, points=POINTS, faces=FACES, structure="CortexLeft"):
    """A GIFTI or FreeSurfer surface, by the name."""
    if not str(path).endswith((".gii", ".gii.gz")):
        freesurfer.write_geometry(str(path), points, faces)
        return path
    image = gifti.GiftiImage(darrays=[
        gifti.GiftiDataArray(points.astype(np.float32), "NIFTI_INTENT_POINTSET",
                             "NIFTI_TYPE_FLOAT32",
                             meta={"AnatomicalStructurePrimary": structure}),
        gifti.GiftiDataArray(faces.astype(np.int32), "NIFTI_INTENT_TRIANGLE",
                             "NIFTI_TYPE_INT32")])
    nib.save(image, str(path))
    return path


def write_gifti(path, columns, structure="CortexLeft", intent="NIFTI_INTENT_SHAPE"):
    """GIFTI data; `columns` is {name: values}."""
    kind = "NIFTI_TYPE_INT32" if intent.endswith("LABEL") else "NIFTI_TYPE_FLOAT32"
    dtype = np.int32 if intent.endswith("LABEL") else np.float32
    image = gifti.GiftiImage(
        meta=gifti.GiftiMetaData({"AnatomicalStructurePrimary": structure, "Study": "test"}),
        darrays=[gifti.GiftiDataArray(np.asarray(values, dtype), intent, kind,
                                      meta={"Name": name, "Palette": f"palette of {name}"})
                 for name, values in columns.items()])
    nib.save(image, str(path))
    return path


def write_cifti(path, rows, series=False, voxels=0, left=None, right=None, labels=False):
    """CIFTI data: rows (k, number of all vertices and voxels), on the vertices `left` and `right`
    (default: all) of two surfaces of N points."""
    left = np.arange(N) if left is None else left
    right = np.arange(N) if right is None else right
    models = cifti2.BrainModelAxis.from_surface(left, N, "CORTEX_LEFT")
    models = models + cifti2.BrainModelAxis.from_surface(right, N, "CORTEX_RIGHT")
    if voxels:
        mask = np.zeros((5, 5, 5), bool)
        mask.flat[:voxels] = True
        models = models + cifti2.BrainModelAxis.from_mask(mask, "THALAMUS_LEFT", affine=np.eye(4))
    rows = np.asarray(rows, np.float32)
    if series:
        first = cifti2.SeriesAxis(0, 0.72, len(rows), "SECOND")
    elif labels:
        first = cifti2.LabelAxis(["map"], [{0: ("none", (0, 0, 0, 0))}])
    else:
        first = cifti2.ScalarAxis([f"map {i}" for i in range(len(rows))],
                                  meta=[{"Palette": f"palette {i}"} for i in range(len(rows))])
    image = cifti2.Cifti2Image(rows, cifti2.Cifti2Header.from_axes((first, models)))
    image.header.matrix.metadata = cifti2.Cifti2MetaData({"Study": "test"})
    nib.save(image, str(path))
    return path


def write_curv(path, values=SMOOTH):
    freesurfer.write_morph_data(str(path), values, fnum=len(FACES))
    return path


def write_mgh(path, values):
    values = np.asarray(values, np.float32)
    shape = (len(values), 1, 1) + values.shape[1:]
    image = freesurfer.MGHImage(values.reshape(shape), np.diag([2, 3, 4, 1]))
    nib.save(image, str(path))
    return path


def write_label(path, vertices, values):
    lines = [f"#!ascii label, from subject test\n{len(vertices)}\n"]
    lines += [f"{v}  {x:.3f}  {y:.3f}  {z:.3f} {value:.6f}\n"
              for v, (x, y, z), value in zip(vertices, POINTS[vertices], values)]
    Path(path).write_text("".join(lines))
    return path


def write_annot(path, labels, names):
    """A FreeSurfer atlas; labels (n,) are numbers of names."""
    colours = np.array([[10 * i, 20, 30, 0, 0] for i in range(len(names))])
    freesurfer.write_annot(str(path), np.asarray(labels), colours, names, fill_ctab=True)
    return path


def off_text(points=POINTS, faces=FACES):
    lines = ["OFF # a comment", f"{len(points)} {len(faces)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += [f"{len(face)} " + " ".join(map(str, face)) + " 255 0 0" for face in faces]
    return "\n".join(lines) + "\n"


def obj_text(points=POINTS, faces=FACES):
    lines = ["# a comment"] + [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += ["vt 0 0", "vn 0 0 1"]
    lines += ["f " + " ".join(f"{c + 1}/1/1" for c in face) for face in faces]
    return "\n".join(lines) + "\n"


def ply_bytes(binary=True, name="vertex_indices", points=POINTS, faces=FACES, colours=True):
    """A PLY mesh with the colours of COLOURS and a quality."""
    form = "binary_little_endian" if binary else "ascii"
    header = [f"ply\nformat {form} 1.0\ncomment made by a scanner\nelement vertex {len(points)}",
              "property float x\nproperty float y\nproperty float z"]
    if colours:
        header.append("property uchar red\nproperty uchar green\nproperty uchar blue\n"
                      "property float quality")
    header.append(f"element face {len(faces)}\nproperty list uchar int {name}\nend_header\n")
    file = io.BytesIO("\n".join(header).encode())
    file.seek(0, io.SEEK_END)
    for point, colour, quality in zip(points.tolist(), np.resize(COLOURS, (len(points), 3)).tolist(),
                                      np.resize(SMOOTH, len(points)).tolist()):
        row = [*point, *colour, quality] if colours else point
        file.write(struct.pack("<fffBBBf" if colours else "<fff", *row) if binary
                   else (" ".join(map(str, row)) + "\n").encode())
    for face in np.asarray(faces).tolist():
        file.write(struct.pack("<Biii", 3, *face) if binary
                   else f"3 {face[0]} {face[1]} {face[2]}\n".encode())
    return file.getvalue()


COLOURS = np.clip(128 + 100 * POINTS / 10 + np.random.default_rng(2).normal(0, 20, (N, 3)),
                  0, 255).astype(np.uint8)


def stl_bytes(points=POINTS, faces=FACES):
    file = io.BytesIO()
    file.write(b"a scan".ljust(80, b"\0") + struct.pack("<I", len(faces)))
    for face in faces:
        file.write(struct.pack("<12fH", 0, 0, 0, *points[face].ravel().tolist(), 0))
    return file.getvalue()


def write_vtk(path, points=POINTS, faces=FACES, arrays=None):
    """Polydata, legacy or XML by the name; `arrays` is {name: values at the points}."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    mesh = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetData(numpy_to_vtk(points.copy(), deep=True))
    mesh.SetPoints(vertices)
    cells = vtkCellArray()
    for face in np.asarray(faces).tolist():
        cells.InsertNextCell(len(face), face)
    mesh.SetPolys(cells)
    for name, values in ({"f": NOISE} if arrays is None else arrays).items():
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        mesh.GetPointData().AddArray(array)
    if str(path).endswith(".vtp"):
        writer = vtkXMLPolyDataWriter()
    else:
        writer = vtkPolyDataWriter()
        writer.SetFileTypeToBinary()  # text has six digits
    writer.SetInputData(mesh)
    writer.SetFileName(str(path))
    writer.Write()
    return path


def run(*arguments):
    """Runs the command line in this process: (exit code, standard output, standard error)."""
    from surfacediffusion.command import main

    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main([str(argument) for argument in arguments])
    return code, out.getvalue(), err.getvalue()
