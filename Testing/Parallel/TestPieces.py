# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Every filter gives the same result on a surface in pieces as in one process. To be run with
mpirun pvbatch --sym. Prints the largest difference of each filter and decomposition."""

import os
import sys
import unittest

import numpy as np
import pieces
import vtkSurfaceDiffusion  # noqa: F401: the classes behind the proxies
from paraview.simple import (
    D3, Calculator, FVMHeatFilter, GenerateGlobalIds, GhostCellsGenerator, HarmonicMapFilter,
    IntrinsicTVFilter, ExtractSurface, MumfordShahFilter, Sphere, SurfaceCurvatureFilter,
    SurfaceDenoisingFilter, SurfaceDerivativesFilter, SurfaceDirectionFieldFilter,
    SurfaceDistanceFilter, SurfaceInterpolationFilter, SurfaceRandomFieldFilter,
    SurfaceReliefFilter, SurfaceSegmentationFilter, TensorDiffusionFilter, TrivialProducer, TuringTextureFilter,
)
from partitions import give_ids
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPartitionedDataSet
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkParallelCore import vtkCommunicator, vtkMultiProcessController

CONTROLLER = vtkMultiProcessController.GetGlobalController()
RANK, COUNT = CONTROLLER.GetLocalProcessId(), CONTROLLER.GetNumberOfProcesses()
LABYRINTH = dict(NumberOfTimeSteps=30)

# Name, filter, properties, result
CASES = (
    ("heat", FVMHeatFilter, {}, "fDiffused"),
    ("heat, inpainting", FVMHeatFilter,
     dict(MaskArray=["POINTS", "hole"], Mode="SteadyState", HoldKnownValues=1), "fDiffused"),
    ("heat, NaN, noise", FVMHeatFilter,
     dict(InputArray=["POINTS", "damaged"], InitialFill="Noise"), "damagedDiffused"),
    ("heat, region", FVMHeatFilter,
     dict(MaskArray=["POINTS", "hole"], MaskMode="Exclude", FidelityWeight=0.1), "fDiffused"),
    ("heat, fixed, along", FVMHeatFilter,
     dict(FixedArray=["POINTS", "ends"], DirectionArray=["CELLS", "around"], AcrossDiffusivity=0.1),
     "fDiffused"),
    ("heat, FWHM", FVMHeatFilter, dict(FWHM=0.6, IntrinsicDelaunay=1), "fDiffused"),
    ("tv", IntrinsicTVFilter, dict(AutomaticFidelity=0, Tolerance=1e-10), "fTV"),
    ("tv, colours", IntrinsicTVFilter,
     dict(AutomaticFidelity=0, InputArray=["POINTS", "colors"], OutputPrecision="Double", Tolerance=1e-10), "colorsTV"),
    ("tv, opponent colours", IntrinsicTVFilter,
     dict(AutomaticFidelity=0, InputArray=["POINTS", "colors"], OutputPrecision="Double", Tolerance=1e-10,
          ColorModel="Opponent"), "colorsTV"),
    ("tv, chromaticity", IntrinsicTVFilter,
     dict(AutomaticFidelity=0, InputArray=["POINTS", "colors"], OutputPrecision="Double", Tolerance=1e-10,
          ColorModel="ChromaticityBrightness"), "colorsTV"),
    ("tv, minimum", IntrinsicTVFilter,
     dict(Mode="SteadyState", FidelityWeight=0.3, StopTolerance=1e-6), "fTV"),
    ("harmonic, normals", HarmonicMapFilter, dict(Tolerance=1e-10), "NormalsHarmonic"),
    ("harmonic, p = 2", HarmonicMapFilter,
     dict(InputArray=["POINTS", "vectors"], Exponent=2.0, Tolerance=1e-10), "vectorsHarmonic"),
    ("tv, minimum, L1", IntrinsicTVFilter,
     dict(Mode="SteadyState", FidelityNorm="L1", FidelityWeight=2.0, MaskArray=["POINTS", "hole"]),
     "fTV"),
    ("harmonic, inpainting", HarmonicMapFilter,
     dict(InputArray=["POINTS", "vectors"], MaskArray=["POINTS", "hole"], FidelityWeight=0.2,
          Tolerance=1e-10), "vectorsHarmonic"),
    ("harmonic, paper", HarmonicMapFilter,
     dict(InputArray=["POINTS", "vectors"], Scheme="ExplicitReaction", Tolerance=1e-10),
     "vectorsHarmonic"),
    ("edges", MumfordShahFilter, dict(Tolerance=1e-10), "fMumfordShah"),
    ("beltrami", TensorDiffusionFilter, dict(Tolerance=1e-10), "fBeltrami"),
    ("coherence, gathered", TensorDiffusionFilter, dict(Model="CoherenceEnhancing", Tolerance=1e-10),
     "fCoherent"),
    ("axes, gathered", TensorDiffusionFilter,
     dict(Model="EdgeEnhancing", DiffusionAxes=1, Tolerance=1e-10), "DiffusionAxes"),
    ("interpolation, inpainting", SurfaceInterpolationFilter, dict(MaskArray=["POINTS", "hole"]),
     "fInterpolated"),
    ("segmentation", SurfaceSegmentationFilter, dict(AutomaticFidelity=0, FidelityWeight=2.0),
     "RegionId"),
    ("turing", TuringTextureFilter, LABYRINTH, "u1"),
    ("turing, rates", TuringTextureFilter,
     dict(DiffusionRateArray=["CELLS", "rates"], **LABYRINTH), "u2"),
    ("turing, along, colours", TuringTextureFilter,
     dict(DirectionArray=["CELLS", "around"], DiffusionRateAcross1=5.0, ColorOutput=1, **LABYRINTH),
     "TextureColor"),
    ("denoising", SurfaceDenoisingFilter, {}, "Displacement"),
    ("relief", SurfaceReliefFilter, dict(InputArray=["POINTS", "f"], Height=0.02), "ReliefHeight"),
    ("curvature", SurfaceCurvatureFilter, dict(FWHM=0.3), "MeanCurvature"),
    ("random field", SurfaceRandomFieldFilter, dict(FWHM=0.3), "RandomField"),
    ("derivatives", SurfaceDerivativesFilter, {}, "fGradient"),
    ("distance", SurfaceDistanceFilter, dict(SourceArray=["POINTS", "hole"]), "Distance"),
    ("distance, fibres", SurfaceDistanceFilter,
     dict(SourceArray=["POINTS", "hole"], DirectionArray=["CELLS", "around"], AlongSpeed=3.0,
          AlongSpeedArray=["CELLS", "speed"], AcrossSpeedArray=["CELLS", "speed"]), "ArrivalTime"),
    ("direction", SurfaceDirectionFieldFilter, {}, "Direction"),
    ("direction, hints", SurfaceDirectionFieldFilter,
     dict(Method="Hints", DirectionArray=["CELLS", "around"]), "Direction"),
)
# The same for processes that solve by domain decomposition. The two multigrid methods agree within
# their tolerance.
TOGETHER = {
    "ConjugateGradient": ("heat", "heat, inpainting", "heat, NaN, noise", "heat, region",
                          "heat, fixed, along", "tv", "tv, minimum", "tv, minimum, L1",
                          "harmonic, p = 2", "harmonic, inpainting", "harmonic, paper", "turing",
                          "beltrami",
                          "turing, rates", "turing, along, colours"),
    "Multigrid": ("heat", "heat, inpainting", "harmonic, p = 2", "turing")}
DISTRIBUTED = tuple(
    ("distributed %s, %s" % (name, solver), make,
     dict(properties, NumberOfTimeSteps=3, Solver=solver, Tolerance=1e-12), result)
    for solver, names in TOGETHER.items()
    for name, make, properties, result in CASES if name in names)
CASES += DISTRIBUTED
SEEDED = tuple(name for name, *_ in CASES
               if "noise" in name or "turing" in name or name == "random field")
# Linear solvers stop at 1e-10, minimisers at larger duality gaps.
TOLERANCE = {name: 1e-6 for name, *_ in CASES if "tv, minimum" in name or name == "random field"}
# For decompositions that differ from others only in the matching of points
FEW = ("heat", "heat, region", "tv", "harmonic, normals", "direction, hints",
       "distributed heat, region, ConjugateGradient", "distributed heat, Multigrid")
LARGEST = {}


def largest_of_all(value):
    """The largest value over the processes, so that all of them pass or fail."""
    mine, all = vtkDoubleArray(), vtkDoubleArray()
    mine.InsertNextValue(value)
    CONTROLLER.AllReduce(mine, all, vtkCommunicator.MAX_OP)
    return all.GetValue(0)


def producer(data):
    source = TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    return source


def run(make, properties, source):
    filter = make(source)
    for name, value in properties.items():
        setattr(filter, name, value)
    return filter


def keys(data, of_cells):
    """Identifies each point or cell in any decomposition."""
    numbers = vtk_to_numpy(data.GetPointData().GetArray("number"))
    if not of_cells:
        return [(int(number),) for number in numbers]
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return [tuple(sorted(triangle)) for triangle in numbers[corners].tolist()]


def values(data, name):
    """The values of a point or cell array, by key; lines have no sign."""
    of_cells = name in ("Direction", "DiffusionAxes")
    array = (data.GetCellData() if of_cells else data.GetPointData()).GetArray(name)
    assert array is not None, name
    rows = vtk_to_numpy(array).astype(float).reshape(array.GetNumberOfTuples(), -1)
    if of_cells:
        rows = np.einsum("ij,ik->ijk", rows, rows).reshape(len(rows), 9)
    return dict(zip(keys(data, of_cells), rows))


def leaves(data):
    if data.IsA("vtkPolyData"):
        return [data]
    return [data.GetPartition(p) for p in range(data.GetNumberOfPartitions())]


class TestPieces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.plain = pieces.make_surface()
        cls.numbered = give_ids(cls.plain)
        cls.with_ids = {name: cls.alone(cls.numbered, *case) for name, *case in CASES}
        # Random numbers come from the global ids, or from the coordinates if there are none.
        cls.without_ids = {**cls.with_ids, **{
            name: cls.alone(cls.plain, *case) for name, *case in CASES if name in SEEDED}}

    @staticmethod
    def alone(surface, make, properties, result):
        """The values that one process finds."""
        filter = run(make, properties, producer(surface))
        filter.GetClientSideObject().SetController(None)
        filter.UpdatePipeline()
        return values(filter.GetClientSideObject().GetOutputDataObject(0), result)

    def check(self, partition, source, has_ids, names=None):
        """Runs all filters on the source, in all processes together."""
        expected = self.with_ids if has_ids else self.without_ids
        for name, make, properties, result in CASES:
            if names and name not in names:
                continue
            filter = run(make, properties, source)
            algorithm = filter.GetClientSideObject()
            reports = []
            algorithm.AddObserver("ProgressEvent", lambda *_: reports.append(algorithm.GetProgress()))
            filter.UpdatePipeline()
            if name.startswith("distributed"):
                self.assertTrue(any(0.0 < report < 1.0 for report in reports), name)
            found = {}
            for piece in leaves(algorithm.GetOutputDataObject(0)):
                if piece and piece.GetNumberOfPoints() > 0:
                    found.update(values(piece, result))
            worst = max(
                (np.abs(row - expected[name][key]).max() for key, row in found.items()),
                default=0.0)
            worst = largest_of_all(worst)
            LARGEST[partition, name] = worst
            self.assertLessEqual(worst, TOLERANCE.get(name, 1e-9), "%s, %s" % (partition, name))
            if make not in (SurfaceCurvatureFilter, SurfaceDenoisingFilter, SurfaceDerivativesFilter,
                            SurfaceDirectionFieldFilter, SurfaceDistanceFilter,
                            SurfaceRandomFieldFilter, SurfaceReliefFilter):
                rows = algorithm.GetOutputDataObject(1).GetNumberOfRows()
                self.assertEqual(rows > 0, RANK == 0, "history of " + name)

    def test_slabs_with_ids(self):
        self.check("slabs, ids", producer(pieces.split(self.numbered, COUNT, "slabs")[RANK]), True)

    def test_slabs_matched_by_coordinates(self):
        self.check("slabs", producer(pieces.split(self.plain, COUNT, "slabs")[RANK]), False, FEW + SEEDED)

    def test_random_numbers_need_no_ids(self):
        """They are those of the points' coordinates, so the seeded cases above mean something."""
        name = "turing"
        difference = max(np.abs(row - self.without_ids[name][key]).max()
                         for key, row in self.with_ids[name].items())
        self.assertGreater(difference, 1e-3)

    def test_cells_at_random(self):
        mine = pieces.split(self.plain, COUNT, "random")[RANK]
        self.check("random", producer(mine), False, ("heat", "heat, fixed, along", "harmonic, normals"))

    def test_an_empty_piece(self):
        mine = pieces.split(self.numbered, COUNT, "empty")[RANK]
        names = ("turing", "harmonic, p = 2", "harmonic, inpainting", "tv, minimum")
        self.check("empty piece", producer(mine), True, ("heat", "tv", "turing", "direction") + tuple(
            "distributed %s, ConjugateGradient" % name for name in names))

    def test_all_in_the_last_process(self):
        mine = pieces.split(self.numbered, COUNT, "last")[RANK]
        self.check("in the last", producer(mine), True, ("heat", "harmonic, normals", "direction"))

    def test_redistributed(self):
        """By D3, since the expat of Debian 12 cannot read the messages of RedistributeDataSet."""
        everything = producer(self.plain if RANK == 0 else self.plain.NewInstance())
        self.check("redistributed", ExtractSurface(D3(everything)), False, FEW)

    def test_with_ghosts(self):
        mine = pieces.split(self.numbered, COUNT, "slabs")[RANK]
        ghosts = GhostCellsGenerator(producer(mine), BuildIfRequired=0, MinimumNumberOfGhosts=2)
        self.check("ghosts", ghosts, True, tuple(name for name, *_ in CASES if "Multigrid" not in name))

    def test_ids_of_vtk_with_duplicates_flagged(self):
        mine = pieces.split(self.plain, COUNT, "slabs")[RANK]
        self.check("vtkGenerateGlobalIds", GenerateGlobalIds(producer(mine)), False, ("heat", "direction"))

    def test_partitions(self):
        """Three partitions in each process, one of them empty."""
        data = vtkPartitionedDataSet()
        mine = pieces.split(self.numbered, 2 * COUNT, "slabs")
        for p, piece in enumerate((mine[2 * RANK], self.plain.NewInstance(), mine[2 * RANK + 1])):
            data.SetPartition(p, piece)
        self.check("partitions", producer(data), True, ("heat", "tv", "turing", "direction"))

    def test_pieces_of_a_parallel_source_match_within_rounding(self):
        """Interfaces of vtkSphereSource differ in the last bits; the whole is a closed sphere."""
        sphere = Sphere(ThetaResolution=24, PhiResolution=24)
        heat = FVMHeatFilter(Calculator(sphere, Function="coordsX", ResultArrayName="f"))
        heat.UpdatePipeline()
        data = heat.GetClientSideObject().GetOutput()
        x = vtk_to_numpy(data.GetPoints().GetData())[:, 0]
        u = vtk_to_numpy(data.GetPointData().GetArray("fDiffused"))
        quotient = u[np.abs(x) > 0.1] / x[np.abs(x) > 0.1]
        spread = largest_of_all(quotient.max()) + largest_of_all(-quotient.min())
        # x is an eigenfunction. Boundaries at the interfaces would change its shape.
        self.assertLess(spread, 0.02)



if __name__ == "__main__":
    result = unittest.main(exit=False, argv=sys.argv[:1], verbosity=2 if RANK == 0 else 0).result
    for (partition, name), worst in sorted(LARGEST.items()) if RANK == 0 else ():
        print("%d processes: %s: %s: %.1e" % (COUNT, partition, name, worst))
    sys.stdout.flush()
    if not result.wasSuccessful():
        os._exit(1)  # pvbatch's normal exit would wait for the other processes
