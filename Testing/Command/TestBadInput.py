# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Wrong arguments and damaged files: one line that names the file or the argument, what was found
and what is allowed; exit code 2; the output is not touched and no other file appears."""

import gzip
import os
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import samples
from samples import FACES, HAS_VTK, N, NOISE, POINTS, SMOOTH, nib, run


def make_files(folder):
    """Good files, and damaged ones made from them, in `folder`."""
    def path(name):
        return folder / name

    def write(name, content):
        path(name).write_bytes(content if isinstance(content, bytes) else content.encode())

    def cut(name, new, part=0.6):
        content = path(name).read_bytes()
        write(new, content[:int(part * len(content))])

    surface, data = path("lh.surf.gii"), path("lh.func.gii")
    samples.write_surface(surface)
    samples.write_surface(path("rh.surf.gii"), structure="CortexRight")
    samples.write_surface(path("lh.white"))
    samples.write_surface(path("other.surf.gii"), *samples.sphere(1))
    samples.write_gifti(data, {"one": SMOOTH, "two": NOISE})
    samples.write_curv(path("lh.curv"))
    samples.write_mgh(path("a.mgh"), SMOOTH)
    samples.write_label(path("a.label"), [1, 2], [1, 2])
    samples.write_cifti(path("a.dscalar.nii"), np.ones((1, 2 * N)))
    write("a.ply", samples.ply_bytes())
    write("a.stl", samples.stl_bytes())
    write("a.off", samples.off_text())
    np.save(path("a.npy"), SMOOTH)

    # unreadable and unknown
    write("empty", b"")
    write("random", np.random.default_rng(4).bytes(500))
    write("text.txt", "a letter\n")
    write("table.txt", "# x y\n1 2\n3 4\n")
    write("word.txt", "1\ntwo\n" * (N // 2))
    write("comments.txt", "# nothing\n")
    write("page.xml", "<?xml version='1.0'?><html></html>")
    path("folder").mkdir()
    os.mkfifo(path("pipe.func.gii"))
    # truncated
    cut("lh.surf.gii", "cut.surf.gii")
    cut("lh.func.gii", "cut.func.gii")
    write("whole.gz", gzip.compress(data.read_bytes()))
    cut("whole.gz", "cut.func.gii.gz")
    cut("lh.white", "cut.white")
    cut("lh.curv", "cut.curv")
    cut("a.mgh", "cut.mgh")
    cut("a.label", "cut.label")
    cut("a.dscalar.nii", "cut.dscalar.nii", 0.99)
    cut("a.ply", "cut.ply")
    cut("a.ply", "header.ply", 0.01)
    cut("a.stl", "cut.stl")
    cut("a.off", "cut.off")
    cut("a.npy", "cut.npy")
    # damaged
    white = path("lh.white").read_bytes()
    write("wide.white", white[:-4] + (N + 5).to_bytes(4, "big"))
    faces = FACES.copy()
    faces[3, 1] = N
    write("index.off", samples.off_text(POINTS, faces))
    points = POINTS.copy()
    points[5, 2] = np.nan
    write("nan.off", samples.off_text(points))
    write("word.off", samples.off_text().replace("\n", "\nx", 3))
    write("edge.off", "OFF\n2 1 0\n0 0 0\n1 1 1\n2 0 1\n")
    write("nofaces.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n")
    write("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n")
    write("twice.label", path("a.label").read_bytes().replace(b"\n2 ", b"\n1 "))
    write("count.curv", path("lh.curv").read_bytes() + b"\0\0\0\0" * 3)
    # of the wrong kind or size
    samples.write_gifti(path("short.func.gii"), {"one": SMOOTH[:-1]})
    samples.write_gifti(path("right.func.gii"), {"one": SMOOTH}, "CortexRight")
    samples.write_gifti(path("a.label.gii"), {"one": np.arange(N)}, intent="NIFTI_INTENT_LABEL")
    samples.write_gifti(path("mixed.func.gii"), {"one": SMOOTH, "two": SMOOTH[:-3]})
    samples.write_gifti(path("zeros.func.gii"), {"one": np.zeros(N)})
    samples.write_gifti(path("nan.func.gii"), {"one": np.full(N, np.nan)})
    infinite = SMOOTH.copy()
    infinite[7] = np.inf
    samples.write_gifti(path("infinite.func.gii"), {"one": infinite})
    samples.write_label(path("far.label"), [1, 2], [1, 2])
    path("far.label").write_text(path("far.label").read_text().replace("\n2 ", f"\n{N} "))
    samples.write_cifti(path("labels.dlabel.nii"), np.zeros((1, 2 * N)), labels=True)
    samples.write_cifti(path("series.dtseries.nii"), np.ones((4, 2 * N)), series=True)
    nib.save(nib.Nifti1Image(np.zeros((3, 3, 3)), np.eye(4)), path("volume.nii"))
    samples.write_mgh(path("volume.mgh"), np.zeros(12))
    nib.save(nib.freesurfer.MGHImage(np.zeros((2, 3, 2), np.float32), np.eye(4)),
             path("volume.mgh"))
    np.save(path("huge.npy"), np.full(N, 1e200))
    np.save(path("zero.npy"), np.zeros(0))
    np.save(path("cube.npy"), np.zeros((3, 3, 3)))
    np.save(path("faces.npy"), np.zeros(320))
    np.save(path("complex.npy"), np.zeros(N, complex))
    np.save(path("objects.npy"), np.array([None] * N), allow_pickle=True)
    if HAS_VTK:
        samples.write_vtk(path("a.vtp"))
        samples.write_vtk(path("a.vtk"))
        cut("a.vtp", "cut.vtp")
        cut("a.vtk", "cut.vtk", 0.8)
        write("grid.vtk", "# vtk DataFile Version 3.0\ngrid\nASCII\nDATASET STRUCTURED_POINTS\n"
                          "DIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n")
        write("image.vti", "<?xml version='1.0'?>\n<VTKFile type='ImageData'></VTKFile>\n")


SMOOTH_IT = "smooth {} lh.func.gii 5 out.func.gii"
DATA = "smooth lh.surf.gii {} 5 out"
CIFTI = "smooth {} 5 out.dscalar.nii --left lh.surf.gii --right rh.surf.gii"

# (command line, what its error must contain)
CASES = [
    # surfaces
    (SMOOTH_IT.format("none.surf.gii"), "none.surf.gii: cannot be read: No such file"),
    (SMOOTH_IT.format("folder"), "folder: cannot be read: Is a directory"),
    (SMOOTH_IT.format("empty"), "empty: the file is empty"),
    (SMOOTH_IT.format("random"), "random: a file of unknown kind .* allowed: GIFTI"),
    (SMOOTH_IT.format("text.txt"), "text.txt: a file of unknown kind"),
    (SMOOTH_IT.format("page.xml"), "page.xml: a file of unknown kind"),
    (SMOOTH_IT.format("lh.func.gii"), "lh.func.gii: a GIFTI file with shape but no surface"),
    (SMOOTH_IT.format("lh.curv"), "lh.curv: a FreeSurfer curv file, which has no surface"),
    (SMOOTH_IT.format("volume.nii"), "volume.nii: a NIfTI file, which has no surface"),
    (SMOOTH_IT.format("cut.surf.gii"), "cut.surf.gii: damaged GIFTI file"),
    (SMOOTH_IT.format("cut.white"), "cut.white: damaged FreeSurfer surface file"),
    (SMOOTH_IT.format("wide.white"), f"wide.white: a face refers to point {N + 5}; allowed: 0 to"),
    (SMOOTH_IT.format("cut.ply"), "cut.ply: damaged PLY file"),
    (SMOOTH_IT.format("header.ply"), "header.ply: damaged PLY file: the header has no end"),
    (SMOOTH_IT.format("cut.stl"), "cut.stl: a file of unknown kind"),
    (SMOOTH_IT.format("cut.off"), f"cut.off: damaged OFF file: {N} vertices and .* announced"),
    (SMOOTH_IT.format("index.off"), f"index.off: a face refers to point {N}; allowed: 0 to {N-1}"),
    (SMOOTH_IT.format("nan.off"), "nan.off: point 5 is .*; allowed: finite coordinates"),
    (SMOOTH_IT.format("word.off"), "word.off: damaged OFF file"),
    (SMOOTH_IT.format("edge.off"), "edge.off: damaged OFF file: line 5 is no face"),
    (SMOOTH_IT.format("nofaces.off"), "nofaces.off: the surface has 3 points and 0 faces"),
    (SMOOTH_IT.format("zero.obj"), "zero.obj: damaged OBJ file: line 4: .* start at 1"),
    (SMOOTH_IT.format("other.surf.gii"),
     f"lh.func.gii: {N} values per column, but other.surf.gii has 42 points"),
    (SMOOTH_IT.format("rh.surf.gii"), "data of CortexLeft, but rh.surf.gii is of CortexRight"),
    # data
    (DATA.format("none.func.gii"), "none.func.gii: cannot be read"),
    (DATA.format("lh.surf.gii"), "lh.surf.gii: a GIFTI surface, which has no data"),
    (DATA.format("a.off"), "a.off: a OFF file, which has no data at vertices"),
    (DATA.format("volume.nii"), "volume.nii: a volume of 3 x 3 x 3 voxels; allowed: n x 1 x 1"),
    (DATA.format("volume.mgh"), "volume.mgh: a volume of 2 x 3 x 2 voxels; allowed: n x 1 x 1"),
    (DATA.format("cut.func.gii"), "cut.func.gii: damaged GIFTI file"),
    (DATA.format("cut.func.gii.gz"), "cut.func.gii.gz: damaged gzip file"),
    (DATA.format("cut.curv"), f"cut.curv: the header announces {N} values, the file holds"),
    (DATA.format("count.curv"), f"count.curv: the header announces {N} values, .* {N + 3}"),
    (DATA.format("cut.mgh"), "cut.mgh: damaged FreeSurfer mgh file"),
    (DATA.format("cut.label"), "cut.label: (2 vertices are announced|damaged)"),
    (DATA.format("twice.label"), "twice.label: a vertex is listed twice"),
    (DATA.format("far.label"), f"far.label: vertices 1 to {N}, but lh.surf.gii has points 0 to"),
    (DATA.format("cut.npy"), "cut.npy: damaged NumPy npy file"),
    (DATA.format("cube.npy"), r"cube.npy: an array of shape \(3, 3, 3\)"),
    (DATA.format("zero.npy"), f"zero.npy: 0 values per column, .* allowed: {N} values"),
    ("smooth lh.surf.gii huge.npy 5 out.shape.gii", r"out.shape.gii: a value is 1e\+200; allowed in GIFTI: less "
     r"than 3\.4e38"),
    (DATA.format("complex.npy"), "complex.npy: values of type complex128; allowed: real"),
    (DATA.format("objects.npy"), "objects.npy: damaged NumPy npy file: Object arrays"),
    (DATA.format("table.txt"), "table.txt: line 2 is '1 2'; allowed: one number per line, and comments after #"),
    (DATA.format("word.txt"), "word.txt: line 2 is 'two'; allowed: one number per line"),
    (DATA.format("comments.txt"), "comments.txt: a file of unknown kind"),
    (DATA.format("short.func.gii"), f"short.func.gii: {N - 1} values .* allowed: {N} values"),
    (DATA.format("right.func.gii"), "right.func.gii: data of CortexRight, but lh.surf.gii"),
    (DATA.format("mixed.func.gii"), f"mixed.func.gii: arrays of {N - 3} and {N} values"),
    (DATA.format("a.label.gii"), "a.label.gii: labels, which have no mean"),
    (DATA.format("infinite.func.gii"), "infinite.func.gii: column 1 is inf at vertex 7; allowed"),
    (DATA.format("nan.func.gii"), "nan.func.gii: column 1 has no known value"),
    (DATA.format("zeros.func.gii") + " --fix-zeros", "zeros.func.gii: column 1 has no known"),
    (DATA.format("faces.npy"), rf"faces.npy: 320 values .* {N} points; allowed: {N} values, or --faces"),
    (DATA.format("lh.func.gii") + " --faces", "has 320 faces; allowed: 320 values"),
    (DATA.format("lh.curv") + " --faces", "a FreeSurfer curv file, which has no data at faces; allowed"),
    (DATA.format("faces.npy") + " --faces --roi lh.func.gii", f"lh.func.gii: {N} values"),
    # CIFTI
    (CIFTI.format("cut.dscalar.nii"), "cut.dscalar.nii: damaged CIFTI file"),
    (CIFTI.format("labels.dlabel.nii"), "labels.dlabel.nii: labels, which have no mean"),
    (CIFTI.format("lh.func.gii"), "--left and --right are for CIFTI files"),
    ("smooth series.dtseries.nii 5 out.nii --left lh.surf.gii --right rh.surf.gii "
     "--column 1 --column 2 --column 4",
     "series.dtseries.nii: the columns 1, 2, 4 of a time series; allowed: columns at equal"),
    ("smooth lh.surf.gii a.dscalar.nii 5 out.nii", "a.dscalar.nii .*; give --left and --right"),
    ("smooth a.dscalar.nii 5 out.dscalar.nii --left lh.surf.gii", "data of CortexRight; add --right FILE"),
    ("smooth a.dscalar.nii 5 out.nii --left rh.surf.gii --right lh.surf.gii",
     "--left: for CortexLeft, but rh.surf.gii is of CortexRight; allowed: the same hemisphere, or any with --any-"),
    ("smooth a.dscalar.nii 5 out.nii --left other.surf.gii --right rh.surf.gii",
     f"a.dscalar.nii: {N} values per column, but other.surf.gii has 42 points"),
    (CIFTI.format("a.dscalar.nii") + " --roi zeros.func.gii", "zeros.func.gii is of one surface; allowed: "),
    # regions and columns
    (DATA.format("lh.func.gii") + " --roi none.gii", "none.gii: cannot be read"),
    (DATA.format("lh.func.gii") + " --roi short.func.gii", f"short.func.gii: {N - 1} values"),
    (DATA.format("lh.func.gii") + " --roi zeros.func.gii", "zeros.func.gii: no vertex of "),
    (DATA.format("lh.func.gii") + " --roi lh.surf.gii", "lh.surf.gii: a GIFTI surface"),
    (DATA.format("lh.func.gii") + " --column 3", r"--column is '3'; .* columns 1 to 2 \(one, two"),
    (DATA.format("lh.func.gii") + " --column 0", "--column is '0'"),
    (DATA.format("lh.func.gii") + " --column three", "--column is 'three'; lh.func.gii has"),
    (DATA.format("lh.func.gii") + " --areas zeros.func.gii", "zeros.func.gii: the area of vertex 0 "
                                                              "is 0; allowed: finite numbers above"),
    # numbers and words
    ("smooth lh.surf.gii lh.func.gii 0 out", "argument FWHM: is '0'; allowed: a number above 0"),
    ("smooth lh.surf.gii lh.func.gii nan out", "argument FWHM: is 'nan'"),
    ("smooth lh.surf.gii lh.func.gii ten out", "argument FWHM: is 'ten'"),
    (DATA.format("lh.func.gii") + " --steps 2.5", "argument --steps: is '2.5'; allowed: a whole"),
    (DATA.format("lh.func.gii") + " --steps 1e30", "argument --steps: is '1e30'"),
    (DATA.format("lh.func.gii") + " --nonsense", "unrecognized arguments: --nonsense"),
    ("smooth lh.surf.gii lh.func.gii 5", "required: OUTPUT"),
    ("", "required: COMMAND"),
    ("smoothe lh.surf.gii lh.func.gii 5 out", "invalid choice: 'smoothe'"),
    ("denoise lh.surf.gii lh.func.gii out --weight -1", "argument --weight: is '-1'"),
    ("denoise lh.surf.gii lh.func.gii out --weight 1 --noise 1", "not allowed with argument"),
    ("inpaint lh.surf.gii lh.func.gii out --model fourier", "argument --model: invalid choice"),
    ("inpaint lh.surf.gii lh.func.gii out --missing short.func.gii", "short.func.gii: "),
    ("texture lh.surf.gii -1 out.func.gii", "argument FEATURE_SIZE: is '-1'"),
    ("texture lh.surf.gii 5 out.xyz", "out.xyz: the name announces no format"),
    ("segment lh.surf.gii lh.func.gii out.func.gii --regions 3 --means 1 2", "--regions is 3, but --means has 2 "
     "numbers; allowed: the same number, or --means alone"),
    ("segment lh.surf.gii lh.func.gii out.func.gii --means 1", "--means has 1 number; allowed: 2 or more"),
    ("interpolate lh.surf.gii none.csv out.func.gii", "none.csv: cannot be read: No such file"),
    ("texture lh.surf.gii 1e-4mm out.stl --relief 1e-5mm", "needs more than 1000000 triangles; allowed: "
     "[0-9.]+ mm or more, or --maximum-triangles"),
    ("texture lh.surf.gii 0.1mm out.stl --relief 0.01mm", "needs more than 1000000 triangles"),
    ("texture lh.surf.gii 3mm out.stl --relief 0.1mm --maximum-triangles 2000", "needs more than 2000 triangles"),
    ("texture lh.surf.gii 5 out.func.gii --maximum-triangles 9", "--maximum-triangles for values at the vertices"),
    ("refine lh.surf.gii 1e-4 out.ply", r"LENGTH is 0.0001, for which .* 4000000 triangles; allowed: "
     r"0.02\d* or more, or --maximum-triangles"),
    ("directions lh.surf.gii out.func.gii", "out.func.gii: the name announces no format"),
    ("curvature lh.surf.gii out.func.gii --fwhm -1", "argument --fwhm: is '-1'"),
    ("distance lh.surf.gii out.npy", "the sources are missing; allowed: one of SOURCES and --from"),
    ("distance lh.surf.gii lh.func.gii out.npy --from 3", "the sources are both SOURCES and --from"),
    ("distance lh.surf.gii out.npy --from 1,2", "argument --from: is '1,2'; allowed: the number"),
    ("distance lh.surf.gii out.npy --from 99999", "--from is 99999; allowed: 0 to "),
    ("distance lh.surf.gii a.dscalar.nii out.npy", "a.dscalar.nii: data of 2 surfaces; allowed: of one"),
    ("distance lh.surf.gii right.func.gii out.npy", "data of CortexRight, but lh.surf.gii is of CortexLeft"),
    ("distance lh.surf.gii out.npy --from 3 --speed nan.func.gii", "--speed is nan at point 0; allowed"),
    ("random-field lh.surf.gii out.npy --range 1e-9", "--range is 1e-09; allowed"),
    ("random-field lh.surf.gii out.npy --range 1 --seed 1e30", "--seed: is '1e30'; allowed: a whole number from"),
    ("directions lh.surf.gii out.npy --method north", "--method is 'north'; allowed: PrincipalCurvature"),
    ("distance lh.surf.gii out.npy --from 3 --signed", "--signed needs a region; allowed: with SOURCES"),
    ("distance lh.surf.gii lh.func.gii out.npy --signed --nearest near.npy", "--nearest with --signed; allowed: without it"),
    ("path lh.surf.gii out.csv --from 3 --to 4", "out.csv: the name announces no format for paths; allowed: .npy"),
    ("path lh.surf.gii out.npy --from 3", "required: --to"),
    ("path lh.surf.gii out.npy --from 3 --to 99999", "a place is 99999; allowed: 0 to "),
    ("distance lh.surf.gii out.off --from 3", "out.off: the name announces no format"),
    ("curvature lh.surf.gii out.off", "out.off: the name announces no format"),
    ("derivatives lh.surf.gii lh.func.gii out.func.gii --quantity slope", "invalid choice: 'slope'"),
    ("derivatives lh.surf.gii lh.func.gii out.func.gii --error lh.func.gii",
     "--error with --quantity gradient; allowed: --quantity velocity"),
    ("interpolate lh.surf.gii lh.func.gii out.func.gii --exact --slope-error out.npy",
     "--slope-error with --exact; allowed: without it"),
    ("derivatives lh.surf.gii short.func.gii out.func.gii", "short.func.gii: .*; allowed: "),
    ("random-field lh.surf.gii out.func.gii", "one of the arguments --fwhm --range is required"),
    ("random-field lh.surf.gii out.func.gii --fwhm 0", "argument --fwhm: is '0'"),
    ("random-field lh.surf.gii out.func.gii --fwhm 5 --nu 3", "--nu with --fwhm; allowed: --nu with --range"),
    ("random-field lh.surf.gii out.off --fwhm 5", "out.off: the name announces no format"),
    ("surrogates lh.surf.gii lh.func.gii out.func.gii", "has 2 columns; allowed: one surface and one column"),
    ("surrogates lh.surf.gii short.func.gii out.func.gii", "short.func.gii: "),
    ("resample lh.surf.gii lh.surf.gii short.func.gii out.func.gii", "short.func.gii: .*; allowed: "),
    ("resample lh.surf.gii lh.surf.gii lh.func.gii out.func.gii --method nearest", "--method is 'nearest'; allowed: "
     "Barycentric, AdaptiveBarycentricArea"),
    ("resample lh.surf.gii lh.surf.gii a.dscalar.nii out.func.gii", "a.dscalar.nii: a CIFTI file, .*; allowed: data "
     "of one surface"),
    ("resample lh.surf.gii lh.surf.gii lh.func.gii out.func.gii --source-areas short.func.gii", "short.func.gii: "),
    ("resample lh.surf.gii lh.func.gii lh.func.gii out.func.gii", "lh.func.gii: a GIFTI file with .* no surface"),
    ("resample lh.surf.gii lh.surf.gii lh.func.gii out.off", "out.off: the name announces no format"),
    ("resample lh.surf.gii lh.surf.gii right.func.gii out.func.gii", "data of CortexRight, but lh.surf.gii is of"),
    ("resample lh.surf.gii lh.surf.gii lh.func.gii lh.func.gii --roi lh.func.gii", "lh.func.gii, which is read"),
    ("-metric-resample lh.func.gii lh.surf.gii lh.surf.gii ADAP_BARY_AREA out.func.gii", "ADAP_BARY_AREA without "
     "areas; allowed: -area-surfs or -area-metrics"),
    ("-metric-resample lh.func.gii lh.surf.gii lh.surf.gii NEAREST out.func.gii", "invalid choice: 'NEAREST'"),
    ("-metric-resample lh.func.gii lh.surf.gii lh.surf.gii BARYCENTRIC out.func.gii -largest", "-largest is not "
     "here; allowed: wb_command"),
    ("scale-filter lh.surf.gii lh.func.gii 0 out.func.gii", "argument WAVELENGTH: is '0'"),
    ("scale-filter lh.surf.gii lh.func.gii 5 out.func.gii --order 3", "argument --order: invalid choice"),
    ("spectrum lh.surf.gii lh.func.gii 9 5", "the WAVELENGTHs are not ascending"),
    ("normals lh.surf.gii out.func.gii --exponent 3", "argument --exponent: is '3'; .* 1 to 2"),
    ("denoise-mesh lh.surf.gii out.surf.gii --noise 0", "argument --noise: is '0'; .* above 0"),
    ("denoise-mesh lh.surf.gii out.surf.gii --type metal", "invalid choice: 'metal'"),
    ("denoise-mesh lh.surf.gii out.off", "out.off: named as OFF, but it is written as GIFTI"),
    ("denoise-mesh lh.func.gii out.surf.gii", "no surface; allowed:"),
    ("normals lh.surf.gii out.off --move", "out.off: named as OFF, but it is written as GIFTI"),
    ("fwhm lh.surf.gii short.func.gii", "short.func.gii: "),
    ("info random", "random: a file of unknown kind"),
    ("info lh.surf.gii none", "none: cannot be read"),
    # options without effect
    (DATA.format("lh.func.gii") + " --residuals lh.func.gii", "--residuals without --to-fwhm; allowed: both"),
    (DATA.format("lh.func.gii") + " --to-fwhm --steps 3", "--steps with --to-fwhm; allowed: one of them"),
    (DATA.format("lh.func.gii") + " --to-fwhm --merge", "--merge with --to-fwhm; allowed: one of them"),
    (DATA.format("lh.func.gii") + " --to-fwhm --faces", "--faces with --to-fwhm; allowed: data at vertices"),
    (DATA.format("lh.func.gii") + " --surface-only", "--surface-only with lh.func.gii, which has no voxels; "
     "allowed: CIFTI files"),
    (DATA.format("lh.func.gii") + " --volume-fwhm 3", "--volume-fwhm with lh.func.gii, which has no voxels"),
    (DATA.format("lh.func.gii") + " --match-columns", "--match-columns without --roi; allowed: both"),
    (CIFTI.format("a.dscalar.nii") + " --residuals lh.func.gii", "--residuals without --to-fwhm"),
    (CIFTI.format("a.dscalar.nii") + " --faces", "--faces with the CIFTI file a.dscalar.nii; allowed: data"),
    (CIFTI.format("a.dscalar.nii") + " --to-fwhm --surface-only", "--surface-only with --to-fwhm"),
    (CIFTI.format("a.dscalar.nii") + " --surface-only --merged-volume", "--merged-volume with --surface-only"),
    ("edges lh.surf.gii lh.func.gii out.func.gii --threshold 1 --noise 1", "--noise with --threshold or --length; "
     "allowed: without them"),
    ("segment lh.surf.gii lh.func.gii out.func.gii --means 1 2 --seed 1", "--seed with --means; allowed: one of"),
    ("interpolate lh.surf.gii lh.func.gii out.func.gii --within 2", "--within with values at vertices, in "
     "lh.func.gii; allowed: a table of points"),
    ("texture lh.surf.gii 5 out.func.gii --base 1", "--base without --relief; allowed: both"),
    ("texture lh.surf.gii 5 out.obj --overhang 30", "--overhang without --relief; allowed: both"),
    # outputs
    ("smooth lh.surf.gii lh.func.gii 5 -", "-: cannot be written: it is not a file; allowed: the name of a file"),
    ("smooth lh.surf.gii lh.func.gii 5 ./lh.surf.gii", "./lh.surf.gii, which is read, would be replaced by "
     "OUTPUT; allowed: another file"),
    ("curvature lh.surf.gii lh.surf.gii", "lh.surf.gii, which is read, would be replaced by OUTPUT"),
    ("smooth lh.surf.gii lh.func.gii 5 zeros.func.gii --roi zeros.func.gii", "zeros.func.gii, which is read"),
    (CIFTI.format("a.dscalar.nii").replace("out.dscalar.nii", "rh.surf.gii"), "rh.surf.gii, which is read, would"),
    ("distance lh.surf.gii out.npy --from 3 --nearest ./out.npy", "./out.npy is OUTPUT and --nearest; allowed: "
     "different files"),
    ("refine a.ply 9 out.ply --data a.npy out.npy --data lh.func.gii out.npy", "out.npy is NEW and NEW; allowed"),
    ("smooth lh.surf.gii lh.func.gii 5 out.csv", "out.csv: .csv names no format of files; allowed: .gii, since "
     "it is written as GIFTI, the format of the input"),
    ("smooth lh.surf.gii a.npy 5 out.xyz", "out.xyz: .xyz names no format of files; allowed: .npy, since "),
    ("smooth lh.surf.gii a.mgh 5 out.xyz.gz", "out.xyz.gz: .xyz names no .*; allowed: .mgh, .mgz, since"),
    ("smooth lh.surf.gii lh.curv 5 out.csv", "out.csv: .csv names no .*; allowed: no extension, since it is "
     "written as FreeSurfer curv"),
    ("smooth lh.surf.gii lh.func.gii 5 out.txt", "out.txt: named as text, but it is written as GIFTI"),
    (CIFTI.format("a.dscalar.nii").replace("out.dscalar.nii", "out.xyz"), "out.xyz: .xyz names no format of files; "
     "allowed: .dscalar.nii, since it is written as CIFTI"),
    ("denoise-mesh a.ply out.xyz", "out.xyz: .xyz names no format of files; allowed: .ply, since"),
    ("random-field lh.surf.gii out.txt --fwhm 5 --count 2", "out.txt: the name announces no format for 2 col"),
    ("smooth lh.surf.gii lh.func.gii 5 out.mgh", "out.mgh: named as FreeSurfer mgh, but it is "
                                                 "written as GIFTI"),
    ("smooth lh.surf.gii lh.func.gii 5 no/out.func.gii", "no/out.func.gii: cannot be written: "
                                                         "there is no folder"),
    ("inpaint lh.surf.gii lh.func.gii folder", "folder: cannot be written: it is a folder"),
    ("smooth lh.surf.gii lh.func.gii 5 pipe.func.gii", "pipe.func.gii: cannot be written: "
                                                       "it is not a regular file"),
]
if HAS_VTK:
    CASES += [
        (SMOOTH_IT.format("cut.vtp"), "cut.vtp: damaged VTK XML file"),
        (SMOOTH_IT.format("cut.vtk"), "cut.vtk: damaged VTK legacy file"),
        (SMOOTH_IT.format("grid.vtk"), "grid.vtk: .*DATASET STRUCTURED_POINTS; allowed: POLYDATA, UNSTRUCT"),
        (SMOOTH_IT.format("image.vti"), "image.vti: a VTK XML file of ImageData; allowed: PolyData, Unstructured"),
    ]


class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.before = os.getcwd()
        cls.addClassCleanup(os.chdir, cls.before)
        os.chdir(folder.name)
        make_files(Path())

    def check(self, code, error, expected):
        self.assertEqual(code, 2, error)
        self.assertRegex(error, expected)
        self.assertEqual(error.count("\n"), 1, error)
        self.assertNotIn("Traceback", error)

    def test_each_case_is_one_line_and_leaves_no_file(self):
        files = sorted(os.listdir())
        for line, expected in CASES:
            with self.subTest(line):
                code, _, error = run(*line.split())
                self.check(code, error, expected)
                self.assertEqual(sorted(os.listdir()), files)

    def test_a_full_disk_leaves_the_old_output(self):
        Path("out.func.gii").write_text("old")
        self.addCleanup(os.unlink, "out.func.gii")
        files = sorted(os.listdir())

        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (200, 200))

        command = [sys.executable, "-m", "surfacediffusion.command", "smooth", "lh.surf.gii",
                   "lh.func.gii", "5", "out.func.gii"]
        done = subprocess.run(command, capture_output=True, text=True, preexec_fn=small_files,
                              env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))
        self.check(done.returncode, done.stderr, "out.func.gii: cannot be written: File too large")
        self.assertEqual(Path("out.func.gii").read_text(), "old")
        self.assertEqual(sorted(os.listdir()), files)

    def test_folders_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        os.chmod("folder", 0o500)
        self.addCleanup(os.chmod, "folder", 0o700)
        code, _, error = run("smooth", "lh.surf.gii", "lh.func.gii", 5, "folder/out.func.gii")
        self.check(code, error, "folder/out.func.gii: cannot be written: no permission")

    def test_files_cut_anywhere_give_one_line(self):
        names = ["lh.surf.gii", "lh.white", "a.ply", "a.off", "a.stl"]
        names += ["lh.func.gii", "lh.curv", "a.mgh", "a.label", "a.npy"]
        self.addCleanup(os.unlink, "part")
        for name in names:
            content = Path(name).read_bytes()
            # The last bytes may be a newline or an optional footer.
            for size in np.linspace(1, 0.9 * len(content), 20).astype(int):
                Path("part").write_bytes(content[:size])
                with self.subTest(name=name, size=int(size)):
                    code, _, error = run("info", "part")
                    self.check(code, error, "part: ")


if __name__ == "__main__":
    unittest.main(verbosity=2)
