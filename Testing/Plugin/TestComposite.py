# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Every filter on composite data of every kind; progress and abort as in the window."""

import os
import tempfile
import time
import unittest

from paraview import servermanager, simple
from paraview.simple import FVMHeatFilter, GroupDatasets
from plugin_testing import filter_names, read_sphere, values

KINDS = ("vtkMultiBlockDataSet", "vtkPartitionedDataSet", "vtkPartitionedDataSetCollection")


def leaves(data):
    iterator = data.NewIterator()
    while not iterator.IsDoneWithTraversal():
        yield iterator.GetCurrentDataObject()
        iterator.GoToNextItem()


def array_names(surface):
    """The names of the arrays on its points and cells."""
    return {attributes.GetArrayName(i)
            for attributes in (surface.GetPointData(), surface.GetCellData())
            for i in range(attributes.GetNumberOfArrays())}


class TestComposite(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.spheres = [
            read_sphere(os.path.join(folder.name, "%d.vtp" % x), centre=(x, 0.0, 0.0))
            for x in (0.0, 5.0)
        ]

    def test_each_filter_on_each_kind_of_composite_data(self):
        alone = {name: array_names(self.output(name, self.spheres[0])) for name in filter_names()}
        for kind in KINDS:
            group = GroupDatasets(Input=self.spheres, OutputType=kind)
            group.UpdatePipeline()
            for name, names in alone.items():
                with self.subTest(kind=kind, filter=name):
                    output = self.output(name, group)
                    self.assertEqual(output.GetClassName(), kind)
                    self.assertGreater(names, {"noisy"})
                    self.assertEqual([array_names(block) for block in leaves(output)], [names, names])

    def output(self, name, source):
        filter = getattr(simple, name)(source)
        if name == "TuringTextureFilter":
            filter.NumberOfTimeSteps = 5
        filter.UpdatePipeline()
        return filter.GetClientSideObject().GetOutputDataObject(0)

    def test_progress_reaches_the_status_bar_and_abort_the_filter(self):
        heat = FVMHeatFilter(self.spheres[0], NumberOfTimeSteps=20)
        algorithm = heat.GetClientSideObject()
        handler = servermanager.ActiveConnection.Session.GetProgressHandler()
        # The handler passes on one report per interval. A report takes longer than this on any
        # machine.
        interval = handler.GetProgressInterval()
        self.addCleanup(handler.SetProgressInterval, interval)
        handler.SetProgressInterval(0.01)
        slow = algorithm.AddObserver("ProgressEvent", lambda _object, _event: time.sleep(0.02))
        self.addCleanup(algorithm.RemoveObserver, slow)
        seen = []

        def look(_object, _event):
            seen.append(handler.GetLastProgress())

        tag = handler.AddObserver("ProgressEvent", look)
        self.addCleanup(handler.RemoveObserver, tag)
        heat.UpdatePipeline()
        self.assertGreaterEqual(len(set(seen)), 3)
        self.assertEqual(seen, sorted(seen))
        complete = values(heat, "noisyDiffused")

        def abort(_object, _event):
            if algorithm.GetProgress() > 0.2:
                algorithm.SetAbortExecute(1)

        tag = algorithm.AddObserver("ProgressEvent", abort)
        heat.TimeStep = 2
        heat.UpdatePipeline()
        self.assertIsNone(values(heat, "noisyDiffused"))
        algorithm.RemoveObserver(tag)
        algorithm.SetAbortExecute(0)
        heat.TimeStep = 1
        self.assertTrue(values(heat, "noisyDiffused") == complete)


if __name__ == "__main__":
    unittest.main(verbosity=2)
