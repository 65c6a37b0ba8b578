# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin gives the same results on a pvserver of two processes as in this process."""

import os
import re
import subprocess
import tempfile
import unittest

from paraview import servermanager, simple
from paraview.simple import (
    D3, Connect, Disconnect, ExtractSurface, FVMHeatFilter, LoadPlugin, TuringTextureFilter,
    XMLPolyDataReader,
)
from plugin_testing import add_array, filter_names, values, write_sphere
from vtkmodules.vtkFiltersCore import vtkCleanPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

MPIEXEC = os.environ["SURFACEDIFFUSION_MPIEXEC"]
PVSERVER = os.environ["SURFACEDIFFUSION_PVSERVER"]
PLUGIN = os.path.join(os.environ["PV_PLUGIN_PATH"], "SurfaceDiffusion.so")
OMPI_SETTINGS = ("OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM",
                 "OMPI_MCA_rmaps_base_oversubscribe", "OMPI_MCA_mpi_yield_when_idle")


# Arrays and steps of some filters
SETTINGS = {
    "HarmonicMapFilter": dict(InputArray=["POINTS", "east"]),
    "SurfaceSegmentationFilter": dict(InputArray=["POINTS", "poles"]),
    "TuringTextureFilter": dict(InputArray=["POINTS", "pair"], NumberOfTimeSteps=40),
}


def results(path, distribute):
    """What each filter adds to the file, by the number of the point or cell."""
    file = data = XMLPolyDataReader(FileName=[path])
    if distribute:
        data = ExtractSurface(D3(file))
    given = servermanager.Fetch(data)
    heat = FVMHeatFilter(data, InputArray=["POINTS", "noisy"], GenerateTimeSteps=1)
    heat.UpdatePipeline(4.0)
    filters = {"heat at 4": heat}
    for name in filter_names():
        settings = dict(SETTINGS.get(name, {}))
        # Random fields follow global ids, which D3 makes; TestPieces compares those of pieces.
        filters[name] = getattr(simple, name)(file if name == "SurfaceRandomFieldFilter" else data)
        if "InputArray" in filters[name].ListProperties():
            settings.setdefault("InputArray", ["POINTS", "noisy"])
        if "Tolerance" in filters[name].ListProperties():  # pieces have points in another order
            settings["Tolerance"] = 1e-10
        for key, value in settings.items():
            filters[name].SetPropertyWithName(key, value)
    found = {}
    for name, source in filters.items():
        output = servermanager.Fetch(source)
        for kind, number in (("Point", "number"), ("Cell", "cell")):
            attributes, before = (getattr(each, "Get%sData" % kind)() for each in (output, given))
            numbers = attributes.GetArray(number)
            for array in map(attributes.GetArrayName, range(attributes.GetNumberOfArrays())):
                result = attributes.GetArray(array)
                if result is not None and not before.HasArray(array):
                    found[name, array] = {
                        int(numbers.GetTuple1(i)): result.GetTuple(i)
                        for i in range(result.GetNumberOfTuples())}
        assert any(each == name for each, _ in found), "no result of " + name
    history = values(filters["TuringTextureFilter"], "Energy", port=1)
    found["heat", "times"] = dict(enumerate((time,) for time in heat.TimestepValues))
    found["history", "Energy"] = dict(enumerate((value,) for value in history))
    return found


class TestServer(unittest.TestCase):
    def setUp(self):
        # pvpython is an MPI process itself, and mpiexec would treat it as its parent.
        environment = {
            name: value for name, value in os.environ.items()
            if not name.startswith(("PMIX_", "OMPI_")) or name in OMPI_SETTINGS}
        environment.pop("PV_PLUGIN_PATH")
        self.server = subprocess.Popen(
            [MPIEXEC, "-n", "2", PVSERVER, "--server-port=0"], stdout=subprocess.PIPE, text=True,
            env=environment)
        self.addCleanup(self.stop)

    def stop(self):
        """Waits for the server, which ends when its client has disconnected."""
        try:
            self.server.communicate(timeout=2)
        except subprocess.TimeoutExpired:
            self.server.terminate()
            self.server.communicate()

    def test_two_processes_give_the_result_of_one(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = os.path.join(folder.name, "sphere.vtp")
        write_sphere(path, roughness=0.02)
        reader, clean = vtkXMLPolyDataReader(), vtkCleanPolyData()
        reader.SetFileName(path)
        clean.SetInputConnection(reader.GetOutputPort())
        clean.Update()
        sphere = clean.GetOutput()
        sphere.GetPointData().RemoveArray("names")
        add_array(sphere.GetPointData(), "number", range(sphere.GetNumberOfPoints()))
        add_array(sphere.GetCellData(), "cell", range(sphere.GetNumberOfCells()))
        writer = vtkXMLPolyDataWriter()
        writer.SetFileName(path)
        writer.SetInputData(sphere)
        writer.SetDataModeToBinary()
        writer.Write()

        here = results(path, False)
        port = next(
            int(match.group(1))
            for match in (re.search(r"connection\(s\): .*:(\d+)", line) for line in self.server.stdout)
            if match)
        self.assertIsNotNone(Connect("localhost", port))
        self.addCleanup(Disconnect)
        LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
        there = results(path, True)
        self.assertEqual(sorted(there), sorted(here))
        for name, expected in here.items():
            self.assertEqual(sorted(there[name]), sorted(expected), name)
            signs = (1, -1) if name == ("SurfaceDirectionFieldFilter", "Direction") else (1,)
            worst = max(
                min(max(abs(a - sign * b) for a, b in zip(there[name][key], row)) for sign in signs)
                for key, row in expected.items())
            print("%s %s: %.1e" % (*name, worst))
            self.assertLess(worst, 1e-6, name)


if __name__ == "__main__":
    unittest.main()
