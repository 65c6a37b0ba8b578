# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""700 damaged files of all formats are read, or refused in one line: no crash, no hang, no traceback, and
no memory beyond that of a small file. The damage is the same in every run."""

import faulthandler
import gzip
import os
import re
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import nibabel as nib
import numpy as np
import samples
import TestFormats
from nibabel.gifti.util import gifti_encoding_codes
from samples import HAS_VTK, N, NOISE, SMOOTH, run

from surfacediffusion.files.export import export

MUTANTS = 700
SECONDS_EACH = 15
MEMORY = 4 << 30

RNG = np.random.default_rng(20)


def write_good_files(folder):
    """A file of each format, by its kind."""
    def path(name):
        return folder / name

    samples.write_surface(path("a.surf.gii"))
    samples.write_surface(path("lh.white"))
    samples.write_gifti(path("a.func.gii"), {"one": SMOOTH, "two": NOISE})
    samples.write_gifti(path("a.label.gii"), {"one": np.arange(N)}, intent="NIFTI_INTENT_LABEL")
    for encoding in ("ASCII", "B64BIN"):
        image = nib.load(path("a.func.gii"))
        for array in image.darrays:
            array.encoding = gifti_encoding_codes.code[encoding]
        nib.save(image, path(f"{encoding}.func.gii"))
    samples.write_cifti(path("a.dscalar.nii"), [np.tile(SMOOTH, 2)] * 2)
    samples.write_cifti(path("a.dtseries.nii"), [np.append(np.tile(NOISE, 2), np.ones(7))] * 3, True, 7)
    samples.write_curv(path("lh.curv"))
    samples.write_mgh(path("a.mgh"), SMOOTH)
    samples.write_mgh(path("a.mgz"), SMOOTH)
    samples.write_label(path("a.label"), np.arange(20), np.arange(20))
    samples.write_annot(path("lh.aparc.annot"), np.arange(N) % 3, ["a", "b", "c"])
    np.save(path("a.npy"), SMOOTH)
    path("a.txt").write_text("\n".join(map(str, SMOOTH)))
    path("a.off").write_text(samples.off_text())
    path("a.obj").write_text(samples.obj_text())
    path("binary.ply").write_bytes(samples.ply_bytes())
    path("text.ply").write_bytes(samples.ply_bytes(binary=False))
    path("a.stl").write_bytes(samples.stl_bytes())
    path("text.stl").write_text(TestFormats.stl_text(faces=samples.FACES[:9]))
    for name, order in (("face colours", ""), ("texture coordinates of corners", ">")):
        ply = TestFormats.PLY()
        path(f"{name.split()[0]}.ply").write_bytes(ply.build(dict(ply.cases())[name], order))
    export(path("a.3mf"), samples.POINTS, samples.FACES, np.arange(3 * N, dtype=np.uint8).reshape(N, 3))
    path("gz.func.gii.gz").write_bytes(gzip.compress(path("a.func.gii").read_bytes()))
    if HAS_VTK:
        samples.write_vtk(path("a.vtk"))
        samples.write_vtk(path("a.vtp"))
        write_other_vtk(path)
    return sorted(folder.iterdir())


def write_other_vtk(path):
    """Text, grids, and the ways to store arrays in XML."""
    from vtkmodules import vtkIOLegacy, vtkIOXML
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

    from surfacediffusion.files import read_surface

    mesh, grid = read_surface(path("a.vtp")).image, vtkUnstructuredGrid()
    grid.SetPoints(mesh.GetPoints())
    grid.SetCells(5, mesh.GetPolys())
    grid.GetPointData().ShallowCopy(mesh.GetPointData())
    for name, data, version in (("text.vtk", mesh, 42), ("text5.vtk", mesh, 51), ("grid.vtk", grid, 42),
                                ("grid5.vtk", grid, 51)):
        writer = (vtkIOLegacy.vtkPolyDataWriter if data is mesh else vtkIOLegacy.vtkUnstructuredGridWriter)()
        writer.SetFileVersion(version)
        if name.startswith("grid"):
            writer.SetFileTypeToBinary()
        writer.SetInputData(data)
        writer.SetFileName(str(path(name)))
        writer.Write()
    for name, data, mode, compressed in (("text.vtp", mesh, "Ascii", False), ("raw.vtp", mesh, "Appended", False),
                                         ("plain.vtp", mesh, "Binary", False), ("text.vtu", grid, "Ascii", False),
                                         ("raw.vtu", grid, "Appended", True)):
        writer = (vtkIOXML.vtkXMLPolyDataWriter if data is mesh else vtkIOXML.vtkXMLUnstructuredGridWriter)()
        writer.SetInputData(data)
        writer.SetFileName(str(path(name)))
        getattr(writer, f"SetDataModeTo{mode}")()
        writer.EncodeAppendedDataOff()
        if not compressed:
            writer.SetCompressorTypeToNone()
        writer.Write()


def span(data, longest):
    start = int(RNG.integers(len(data)))
    return start, min(len(data), start + int(RNG.integers(1, longest)))


def cut(data):
    return data[:int(RNG.integers(1, len(data)))]


def flip(data):
    """Bits of a few bytes, most of them in the header."""
    changed = bytearray(data)
    for _ in range(int(RNG.integers(1, 8))):
        limit = len(data) if RNG.random() < 0.3 else min(len(data), 600)
        changed[int(RNG.integers(limit))] ^= 1 << int(RNG.integers(8))
    return bytes(changed)


def remove(data):
    start, stop = span(data, 200)
    return data[:start] + data[stop:]


def repeat(data):
    start, stop = span(data, 200)
    return data[:stop] + data[start:]


def extreme(data):
    """Numbers that no file has, in place of four or eight bytes."""
    numbers = [b"\xff" * 4, b"\0" * 4, b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f", b"\x80\0\0\0", b"\xff" * 8,
               b"\0" * 8, b"\0\0\xc0\x7f", b"\x7f\x80\0\0"]
    number = numbers[int(RNG.integers(len(numbers)))]
    start = int(RNG.integers(min(len(data), 600 if RNG.random() < 0.7 else len(data))))
    return data[:start] + number + data[start + len(number):]


def digits(data):
    """Other numbers in texts."""
    places = [i for i, byte in enumerate(data[:3000]) if 48 <= byte < 58]
    if not places:
        return extreme(data)
    start = places[int(RNG.integers(len(places)))]
    words = [b"-1", b"1e999", b"nan", b"99999999999", b"x", b"", b"0", b"4294967296"]
    return data[:start] + words[int(RNG.integers(len(words)))] + data[start + 1:]


def numbers(data):
    """Other whole numbers in texts, such as counts and dimensions."""
    places = [found.span() for found in re.finditer(rb"(?<![\d.])\d+(?![\d.])", data[:3000])]
    if not places:
        return extreme(data)
    start, stop = places[int(RNG.integers(len(places)))]
    words = [b"-1", b"0", b"2", b"1000", b"1000000000", b"1073741824", b"99999999999", b"1000000000000"]
    return data[:start] + words[int(RNG.integers(len(words)))] + data[stop:]


def write_mutants(folder):
    good = write_good_files(folder)
    kinds = [cut, flip, remove, repeat, extreme, digits, numbers, numbers]
    for i in range(MUTANTS):
        path = good[i % len(good)]
        data = path.read_bytes()
        packed = path.suffix in (".gz", ".mgz") and RNG.random() < 0.7
        data = kinds[i // len(good) % len(kinds)](gzip.decompress(data) if packed else data)
        (folder / f"{i:03d}.{path.name}").write_bytes(gzip.compress(data) if packed else data)
    return good


def read_all(folder):
    """In a process of its own: `info` of each file, with a line before and after."""
    if "libasan" not in os.environ.get("LD_PRELOAD", ""):  # which reserves terabytes of addresses
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    for path in sorted(folder.iterdir()):
        print("reading", path.name, flush=True)
        faulthandler.dump_traceback_later(SECONDS_EACH, exit=True)
        code, _, error = run("info", path)
        lines = [line for line in error.splitlines() if ": warning: " not in line]
        fine = (code == 0 and not lines) or (code == 2 and len(lines) == 1 and path.name in lines[0])
        print("read" if fine else f"WRONG {code} {error!r}", code, flush=True)


class Fuzz(unittest.TestCase):
    def test_damaged_files_are_read_or_refused_in_one_line(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            good = write_mutants(folder)
            environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}  # whose threads reserve memory
            done = subprocess.run([sys.executable, __file__, "--read", name], capture_output=True, text=True,
                                  env=environment)
        lines = done.stdout.splitlines()
        self.assertEqual(done.returncode, 0, "\n".join(lines[-2:]) + done.stderr[-2000:])
        wrong = [f"{before}: {after}" for before, after in zip(lines[::2], lines[1::2])
                 if after.startswith("WRONG")]
        self.assertEqual(wrong, [])
        self.assertEqual(len(lines), 2 * (MUTANTS + len(good)))
        # The files that the damage was done to are read, and most of the damage is noticed.
        names = {path.name for path in good}
        self.assertEqual(len([1 for before, after in zip(lines[::2], lines[1::2])
                              if before.split()[1] in names and after == "read 0"]), len(good))
        self.assertGreater(lines.count("read 2"), MUTANTS // 3)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--read"]:
        read_all(Path(sys.argv[2]))
    else:
        unittest.main(verbosity=2)
