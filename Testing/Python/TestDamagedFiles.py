#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The readers of the examples reject files that are missing, truncated, altered or of another
format, with an error that names the file."""

import gzip
import importlib.util
import random
import sys
import tempfile
import unittest
from pathlib import Path

from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
from vtkmodules.vtkImagingSources import vtkImageMandelbrotSource
from vtkmodules.vtkImagingCore import vtkImageShiftScale

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "Examples" / "Python"))
import surface_data as data  # noqa: E402

HAS_NIBABEL = importlib.util.find_spec("nibabel") is not None

OFF = "OFF\n4 4 6\n1 1 1\n1 -1 -1\n-1 1 -1\n-1 -1 1\n3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n"


class DamagedFiles(unittest.TestCase):
    def setUp(self):
        vtkObject.GlobalWarningDisplayOff()
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def refuses(self, read, name, content):
        path = self.folder / name
        path.write_bytes(content)
        with self.assertRaisesRegex(data.DataError, name):
            read(path)

    def test_missing_files_and_unknown_formats_are_errors(self):
        readers = [data.read_mesh, data.read_photo]
        if HAS_NIBABEL:
            readers.append(lambda path: data.read_gifti(path, 1))
        for read in readers:
            with self.assertRaisesRegex(data.DataError, "none"):
                read(self.folder / "none.off")
        self.refuses(data.read_mesh, "surface.xyz", b"1 2 3")

    def test_truncated_off_files_are_errors(self):
        for size in range(len(OFF) - 2):
            self.refuses(data.read_mesh, "cut.off", OFF[:size].encode())

    def test_off_files_with_invalid_numbers_are_errors(self):
        for old, new in (("3 1 3 2", "3 1 3 4"), ("3 1 3 2", "3 1 3 -2"), ("3 1 3 2", "4 1 3 2"),
                         ("-1 -1 1", "-1 nan 1"), ("-1 -1 1", "-1 inf 1"), ("4 4 6", "-4 4 6"),
                         ("4 4 6", "4 0 6"), ("1 -1 -1", "1 x -1"), ("OFF", "PLY")):
            self.refuses(data.read_mesh, "bad.off", OFF.replace(old, new, 1).encode())

    def test_off_files_of_random_bytes_are_errors(self):
        numbers = random.Random(1)
        for _ in range(50):
            self.refuses(data.read_mesh, "random.off", b"OFF\n" + numbers.randbytes(200))

    def test_damaged_vtp_files_are_errors(self):
        sphere = vtkSphereSource()
        writer = vtkXMLPolyDataWriter()
        writer.SetInputConnection(sphere.GetOutputPort())
        writer.SetDataModeToBinary()
        writer.SetFileName(str(self.folder / "good.vtp"))
        writer.Write()
        good = (self.folder / "good.vtp").read_bytes()
        self.assertEqual(data.read_mesh(self.folder / "good.vtp").GetNumberOfPoints(), 50)
        for part in (0.0, 0.1, 0.5, 0.9):
            self.refuses(data.read_mesh, "cut.vtp", good[:int(part * len(good))])
        self.refuses(data.read_mesh, "kind.vtp", b"<VTKFile type='ImageData'></VTKFile>")

    def test_damaged_pictures_are_errors(self):
        source = vtkImageMandelbrotSource()
        source.SetWholeExtent(0, 63, 0, 63, 0, 0)
        scale = vtkImageShiftScale()
        scale.SetInputConnection(source.GetOutputPort())
        scale.SetOutputScalarTypeToUnsignedChar()
        writer = vtkPNGWriter()
        writer.SetInputConnection(scale.GetOutputPort())
        writer.SetFileName(str(self.folder / "good.png"))
        writer.Write()
        good = (self.folder / "good.png").read_bytes()
        self.assertEqual(data.read_photo(self.folder / "good.png").shape[:2], (64, 64))
        for size in (0, 4, 20, 40):
            self.refuses(data.read_photo, "cut.png", good[:size])
        self.refuses(data.read_photo, "text.png", b"not a picture")

    @unittest.skipUnless(HAS_NIBABEL, "nibabel is not available (Debian: python3-nibabel)")
    def test_damaged_gifti_files_are_errors(self):
        read = lambda path: data.read_gifti(path, 1)  # noqa: E731
        for content in (b"", b"<GIFTI>", gzip.compress(b"<GIFTI></GIFTI>")[:20]):
            self.refuses(read, "bad.gii.gz", content)
        self.refuses(read, "empty.gii.gz", gzip.compress(b""))


if __name__ == "__main__":
    unittest.main(verbosity=2)
