# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of VTK as other programs write them, and damaged ones that would end the process."""

import re
import struct
import unittest
import zlib

import numpy as np
import samples
from samples import HAS_VTK, NOISE
from TestForeign import ForeignTest

from surfacediffusion.files import read_data, read_surface

HEAD = "# vtk DataFile Version {}\nmade by hand\n{}\nDATASET {}\n"
TETRAHEDRON = "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n"
CORNERS = [0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2]


def xml(points="4", cells="4", components="3", offsets=(3, 6, 9, 12), corners=CORNERS, kind="PolyData"):
    polys = "Polys" if kind == "PolyData" else "Cells"
    types = "" if kind == "PolyData" else '<DataArray type="UInt8" Name="types" format="ascii">5 5 5 5</DataArray>'
    return (f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" '
            f'header_type="UInt32"><{kind}><Piece NumberOfPoints="{points}" NumberOf{polys}="{cells}"><Points>'
            f'<DataArray type="Float32" Name="Points" NumberOfComponents="{components}" format="ascii">'
            f'0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><{polys}>'
            f'<DataArray type="Int64" Name="connectivity" format="ascii">{" ".join(map(str, corners))}</DataArray>'
            f'<DataArray type="Int64" Name="offsets" format="ascii">{" ".join(map(str, offsets))}</DataArray>'
            f'{types}</{polys}></Piece></{kind}></VTKFile>')


@unittest.skipUnless(HAS_VTK, "needs vtk")
class VTK(ForeignTest):
    def legacy(self, cells, count=4, size=16, binary=False):
        head = HEAD.format("4.2", "BINARY" if binary else "ASCII", "POLYDATA").encode()
        if not binary:
            return head + (TETRAHEDRON + f"POLYGONS {count} {size}\n" + " ".join(map(str, cells)) + "\n").encode()
        return head + b"POINTS 4 float\n" + struct.pack(">12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1) + (
            f"\nPOLYGONS {count} {size}\n".encode() + struct.pack(f">{len(cells)}i", *cells) + b"\n")

    def test_counts_beyond_the_file_are_refused_before_vtk_reads_them(self):
        good = [3, 0, 1, 2, 3, 0, 3, 1, 3, 0, 2, 3, 3, 1, 3, 2]
        field = b"POINT_DATA 4\nFIELD f 1\na %s float\n"
        version5 = HEAD.format("5.1", "ASCII", "POLYDATA") + TETRAHEDRON \
            + "POLYGONS 5 12\nOFFSETS vtktypeint64\n{}\nCONNECTIVITY vtktypeint64\n" \
            + " ".join(map(str, CORNERS)) + "\n"
        key = '<InformationKey name="UNITS_LABEL" location="vtkDataArray">m</InformationKey>'
        right = [self.write("a.vtk", self.legacy(good)), self.write("b.vtk", version5.format("0 3 6 9 12")),
                 self.write("a.vtp", xml()), self.write("a.vtu", xml(kind="UnstructuredGrid")),
                 self.write("b.vtp", xml().replace("</DataArray></Polys>", key + "</DataArray></Polys>"))]
        code, out, error = self.info(*right)
        self.assertEqual((code, out.count("4 points, 4 faces"), error), (0, 5, ""))
        wrong = [(".vtk", self.legacy([number, *good[1:]], binary=binary))
                 for number in (2**30, 1000, 5, 4, 0, -1) for binary in (False, True)]
        wrong += [(".vtk", self.legacy(good, count, size)) for count, size in (
            (3, 16), (5, 16), (4, 15), (10**12, 16), (4, 10**12))]
        wrong += [(".vtk", self.legacy([*good[:3], 99, *good[4:]])),
                  (".vtk", self.legacy(good).replace(b"POINTS 4", b"POINTS 1000000000000")),
                  (".vtk", self.legacy(good).replace(b"POLYGONS", b"polygonsX")),
                  (".vtk", self.legacy(good, binary=True) + field % b"1000000000 4"),
                  (".vtk", self.legacy(good, binary=True) + field % b"1 1000000000000"),
                  (".vtk", self.legacy(good, binary=True) + b"POINT_DATA 4\nSCALARS a float 1000000000\n"
                   b"LOOKUP_TABLE default\n")]
        wrong += [(".vtk", version5.format(offsets)) for offsets in (
            "0 3 1000 9 12", "0 3 6 9 1000", "0 -3 6 9 12", "0 9 6 3 12")]
        for kind, end in (("PolyData", ".vtp"), ("UnstructuredGrid", ".vtu")):
            wrong += [(end, xml(**{key: number}, kind=kind)) for key in ("points", "cells", "components")
                      for number in ("1000000000", "1000000000000", "-1", "9" * 18)]
            wrong += [(end, xml(offsets=offsets, kind=kind)) for offsets in (
                (3, 6, 9, 1000), (-3, 6, 9, 12), (3, 6, 9, 10**15))]
            wrong.append((end, xml(corners=[0, 1, 99, *CORNERS[3:]], kind=kind)))
        self.refused_all(wrong, "(damaged|a face refers)")

    def compressed(self, offset="{}", blocks=1, size=1024, last=48, packed=None):
        """The arrays of xml(), compressed behind the file; the numbers are those of the coordinates."""
        given = [np.array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], "<f4"), np.array(CORNERS, "<i8"),
                 np.array([3, 6, 9, 12], "<i8")]
        head, body = xml(), b""
        head = head.replace('header_type', 'compressor="vtkZLibDataCompressor" header_type')
        for k, (array, kind) in enumerate(zip(given, ("Float32", "Int64", "Int64"))):
            place = offset.format(len(body)) if k == 0 else len(body)
            head = re.sub(rf'(<DataArray type="{kind}"[^>]*) format="ascii">[^<]*<',
                          rf'\1 format="appended" offset="{place}"><', head, count=1)
            zipped = zlib.compress(array.tobytes())
            numbers = (blocks, size, last, packed or len(zipped))
            body += struct.pack("<4I", *(numbers if k == 0 else (1, 1024, array.nbytes, len(zipped)))) + zipped
        head = head.replace("</VTKFile>", '<AppendedData encoding="raw">_').encode()
        return head + body + b"</AppendedData></VTKFile>"

    def test_blocks_beyond_the_file_are_refused_before_vtk_reads_them(self):
        self.assertIn("4 points, 4 faces", self.succeed("info", self.write("a.vtp", self.compressed())))
        self.refused_all([(".vtp", content) for content in (
            self.compressed(blocks=0), self.compressed(blocks=2**30), self.compressed(last=2000),
            self.compressed(size=2**31), self.compressed(packed=10**9), self.compressed("1e9"),
            self.compressed("99999999"), self.compressed("-5"))], "damaged VTK XML file: ")

    def test_grids_of_triangles_are_surfaces_and_stay_grids(self):
        """As meshio writes all surfaces."""
        from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
        from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

        text = HEAD.format("3.0", "ASCII", "UNSTRUCTURED_GRID") \
            + "POINTS 5 double\n0 0 0 1 0 0 0 1 0 1 1 .5 2 0 0\n" \
            "CELLS 4 14\n2 0 1\n3 0 1 2\n4 0 1 3 2\n1 4\nCELL_TYPES 4\n3 5 9 1\nCELL_DATA 4\nSCALARS c int\n" \
            "LOOKUP_TABLE default\n1 2 3 4\nPOINT_DATA 5\nSCALARS f double\nLOOKUP_TABLE default\n0 1 2 3 4\n"
        self.write("a.vtk", text)
        self.assertIn("5 points, 2 faces", self.succeed("info", "a.vtk"))
        surface = read_surface("a.vtk")
        self.assertEqual(surface.faces, [[0, 1, 2], [0, 1, 3, 2]])
        surface.save("b.vtk", 2 * surface.points)
        self.write("a.vtu", xml(kind="UnstructuredGrid"))
        tetrahedron = read_surface("a.vtu")
        np.testing.assert_array_equal(tetrahedron.faces, np.reshape(CORNERS, (4, 3)))
        tetrahedron.save("b.vtu", 2 * tetrahedron.points)
        for reader, name, given in ((vtkUnstructuredGridReader(), "b.vtk", surface),
                                    (vtkXMLUnstructuredGridReader(), "b.vtu", tetrahedron)):
            reader.SetFileName(name)
            reader.Update()
            self.assertIsInstance(reader.GetOutput(), vtkUnstructuredGrid)
            self.assertEqual(reader.GetOutput().GetNumberOfCells(), 4)
            self.assertEqual(reader.GetOutput().GetPoint(3), tuple(2 * given.points[3]))
        np.testing.assert_array_equal(read_data("b.vtk").parts[0].values[:, 0], np.arange(5))
        self.refused("4 cells, of which 2 are polygons", "smooth", "a.vtk", "a.vtk", 1, "c.vtk", "--faces")
        self.succeed("distance", "a.vtu", "c.vtu", "--from", 0)
        self.assertEqual(read_data("c.vtu").names, ["distance"])

    def test_pixels_are_quadrilaterals_and_volumes_are_refused(self):
        grid = HEAD.format("3.0", "ASCII", "UNSTRUCTURED_GRID") + TETRAHEDRON \
            + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n{}\n"
        self.assertEqual(read_surface(self.write("a.vtk", grid.format(8))).faces, [[0, 1, 3, 2]])
        self.refused(r"cells of VTK's type 10; allowed: triangles \(5\).*ParaView's filter Extract Surface", "info",
                     self.write("a.vtk", grid.format(10)))

    def test_strips_are_triangles_of_one_side_with_the_data_of_their_strip(self):
        text = HEAD.format("3.0", "ASCII", "POLYDATA") + "POINTS 6 float\n" \
            + " ".join(f"{i // 2} {i % 2} 0" for i in range(6)) + "\nLINES 1 3\n2 0 1\n" \
            "TRIANGLE_STRIPS 1 5\n4 0 2 1 3\nCELL_DATA 2\nSCALARS c int\nLOOKUP_TABLE default\n7 9\n"
        surface = read_surface(self.write("a.vtk", text))
        self.assertIn("6 points, 2 faces", self.succeed("info", "a.vtk"))
        corners = np.asarray(surface.points, float)[surface.faces]
        areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
        np.testing.assert_array_equal(areas, [1, 1])
        self.succeed("directions", "a.vtk", "b.vtk", "--method", "Smooth")
        from surfacediffusion.files import vtk_files
        again = read_surface("b.vtk")
        np.testing.assert_array_equal(again.faces, surface.faces)
        np.testing.assert_array_equal(vtk_files.arrays_of(again.image.GetCellData())["c"], [7, 9, 9])

    def test_directions_have_a_tuple_for_each_cell(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOLegacy import vtkPolyDataReader

        head = HEAD.format("3.0", "ASCII", "POLYDATA") + "POINTS 4 double\n0 0 0 1 0 0 0 1 0 1 1 .5\n"
        self.write("a.vtk", head + "VERTICES 1 2\n1 0\nLINES 2 6\n2 0 1\n2 1 3\nPOLYGONS 2 8\n3 0 1 2\n3 1 3 2\n")
        self.succeed("directions", "a.vtk", "b.vtk", "--method", "Smooth")
        self.succeed("directions", "a.vtk", "b.npy", "--method", "Smooth")
        reader = vtkPolyDataReader()
        reader.SetFileName("b.vtk")
        reader.ReadAllVectorsOn()
        reader.ReadAllFieldsOn()
        reader.Update()
        found = vtk_to_numpy(reader.GetOutput().GetCellData().GetArray("Direction"))
        np.testing.assert_array_equal(found[:3], 0)
        np.testing.assert_array_equal(found[3:], np.load("b.npy"))
        self.assertEqual(len(found), 5)

    def test_all_attributes_of_a_legacy_file_are_kept(self):
        count = {"SCALARS": 1, "VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TEXTURE_COORDINATES": 2}
        text = HEAD.format("3.0", "ASCII", "POLYDATA") + TETRAHEDRON \
            + "POLYGONS 2 8\n3 0 1 2\n3 0 3 1\nPOINT_DATA 4\n"
        names = [f"{word.lower()}{i}" for word in count for i in (1, 2)]
        for name in names:
            word = name[:-1].upper()
            text += f"{word} {name} {'2 ' * (word[0] + word[2] == 'TX')}float\n"
            text += "LOOKUP_TABLE default\n" * (word == "SCALARS") + "0.5 " * 4 * count[word] + "\n"
        surface = read_surface(self.write("a.vtk", text))
        surface.save("b.vtk", 2 * surface.points)
        found = read_data("b.vtk").names
        self.assertEqual([found.count(name) for name in names], [count[name[:-1].upper()] for name in names])

    def test_names_of_arrays_may_have_any_signs(self):
        names = ["p<0.05", "A&B", 'a "b"', "c>d", "&amp;", "e\tf"]
        samples.write_surface("a.surf.gii")
        for end in ("vtp", "vtk"):
            samples.write_vtk(f"a.{end}", arrays={"f": NOISE})
            from vtkmodules.util.numpy_support import numpy_to_vtk
            from surfacediffusion.files import vtk_files
            mesh = read_surface(f"a.{end}").image
            for k, name in enumerate(names):
                array = numpy_to_vtk(NOISE + k, deep=True)
                array.SetName(name)
                mesh.GetPointData().AddArray(array)
            self.write(f"a.{end}", vtk_files.write(end, mesh))
            self.succeed("smooth", f"a.{end}", f"a.{end}", 5, f"b.{end}", "--column", names[0], "--column", "f")
            found = read_data(f"b.{end}")
            self.assertEqual(found.names[:3], ["f", *names[:2]])
            self.assertEqual(set(found.names), {"f", *names})


if __name__ == "__main__":
    unittest.main(verbosity=2)
