# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares each filter of the plugin with its C++ class: names, defaults, entries,
documentation."""

import random
import re
import unittest

import vtkSurfaceDiffusion
from paraview import make_name_valid, servermanager, simple
from panel import click, is_advanced, offered, sphere_with_arrays
from plugin_testing import filter_names
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm
from vtkmodules.vtkFiltersSources import vtkSphereSource

GROUPS = ("Data", "Model", "Constraints", "Solver", "Time")
# All arrays have the C++ setter SetInputArrayToProcess(); the clock has none.
NOT_CXX_PROPERTIES = {
    "Input", "InputArray", "MaskArray", "DirectionArray", "FixedArray", "DiffusionRateArray",
    "FidelityArray", "SeedArray", "CreaseArray", "DataTermArray", "PointsWithValues", "TimestepValues",
    "Sources", "PathPoints", "SourceArray", "SpeedArray", "SourceTimes", "SlopeErrorArray",
    "AlongSpeedArray", "AcrossSpeedArray",
    "Mean",  # a list: SetMean(region, component, value)
    "MissingValue",  # a list: AddMissingValue(value)
}
PORTS = {"SurfaceSegmentationFilter": ["Surface", "Regions", "Boundaries"],
         "SurfaceInterpolationFilter": ["Surface", "Fit"], "SurfaceDistanceFilter": ["Surface", "Paths"]}


# What users type into ParaView's search, which finds words of labels only.
SEARCHES = {
    "smooth": {"FVMHeatFilter", "HarmonicMapFilter", "TensorDiffusionFilter"},
    "blur": {"FVMHeatFilter"},
    "heat": {"FVMHeatFilter"},
    "inpaint": {"FVMHeatFilter", "IntrinsicTVFilter"},
    "denoise": {"IntrinsicTVFilter", "SurfaceDenoisingFilter"},
    "edges": {"IntrinsicTVFilter", "MumfordShahFilter", "TensorDiffusionFilter"},
    "lines": {"TensorDiffusionFilter"},
    "regions": {"SurfaceSegmentationFilter"},
    "segment": {"SurfaceSegmentationFilter"},
    "interpolate": {"SurfaceInterpolationFilter"},
    "points": {"SurfaceInterpolationFilter"},
    "spline": {"SurfaceInterpolationFilter"},
    "mesh": {"SurfaceDenoisingFilter"},
    "normals": {"HarmonicMapFilter", "SurfaceDenoisingFilter"},
    "texture": {"TuringTextureFilter"},
    "pattern": {"TuringTextureFilter"},
    "direction": {"HarmonicMapFilter", "SurfaceDirectionFieldFilter"},
    "curvature": {"SurfaceCurvatureFilter", "SurfaceDirectionFieldFilter"},
    "gradient": {"SurfaceDerivativesFilter"},
    "divergence": {"SurfaceDerivativesFilter"},
    "laplacian": {"SurfaceDerivativesFilter"},
    "distance": {"SurfaceDistanceFilter"},
    "geodesic": {"SurfaceDistanceFilter"},
    "random": {"SurfaceRandomFieldFilter"},
    "relief": {"SurfaceReliefFilter"},
    "3d printing": {"SurfaceReliefFilter"},
}

# Shares, factors and exponents, which have no unit.
WITHOUT_UNIT = {
    "AlongDiffusivity", "AcrossDiffusivity", "AlongSpeed", "AcrossSpeed", "Tolerance", "StopTolerance", "Alpha", "Exponent",
    "ChromaWeight", "ChromaticityExponent", "InitialNoise",
}
# The unit in the first sentence of a property's documentation
UNIT = re.compile(r"\bunits? of|in any unit|without a unit|in the unit|in degrees|in R\b|in R/h"
                  r"|in \(R/h\)|in 1/|in length")


def in_menu(name):
    """The prototype of the filter in the menu."""
    return servermanager.ProxyManager().GetPrototypeProxy("filters", name)


def proxies():
    """Each filter: its name, a new proxy of it with the defaults of the XML, its C++ class."""
    for name in filter_names():
        yield name, getattr(servermanager.filters, name)(), getattr(vtkSurfaceDiffusion, "vtk" + name)


def properties():
    """Each property of each filter: `Filter.Property`, its name, the property, the C++ class."""
    for name, proxy, cxx in proxies():
        for key in proxy.ListProperties():
            yield "%s.%s" % (name, key), key, proxy.SMProxy.GetProperty(key), cxx


class TestProxies(unittest.TestCase):
    def test_there_are_filters(self):
        self.assertIn("FVMHeatFilter", filter_names())

    def test_scripts_make_filters_by_the_names_of_their_classes_and_by_their_labels(self):
        for name, proxy, cxx in proxies():
            label = make_name_valid(in_menu(name).GetXMLLabel())
            made = {each: getattr(simple, each)(sphere_with_arrays()) for each in (name, label)}
            for each in made.values():
                self.assertEqual(each.SMProxy.GetVTKClassName(), cxx.__name__)
                self.assertEqual(each.ListProperties(), proxy.ListProperties())
            self.assertEqual(made[label].SMProxy.GetXMLName(), name)  # as in state files
            self.assertEqual(getattr(simple, name).__doc__, getattr(simple, label).__doc__)

    def test_only_the_proxy_with_the_label_is_in_the_menu(self):
        for name, proxy, _ in proxies():
            text = in_menu(name).GetDocumentation()
            for part in (text.GetShortHelp(), text.GetLongHelp(), text.GetDescription()):
                self.assertGreater(len(part or ""), 20, name)
            hints = in_menu(name).GetHints()
            menu = hints.FindNestedElementByName("ShowInMenu")
            self.assertEqual(menu.GetAttribute("category"), "Surface Diffusion", name)
            self.assertIsNone(hints.FindNestedElementByName("ReaderFactory"), name)
            hints = proxy.SMProxy.GetHints()
            self.assertIsNotNone(hints.FindNestedElementByName("ReaderFactory"), name)

    def test_labels_have_the_words_that_users_search_for(self):
        labels = {name: in_menu(name).GetXMLLabel().lower() for name in filter_names()}
        for word, expected in SEARCHES.items():
            self.assertEqual({name for name in labels if word in labels[name]}, expected, word)
        self.assertEqual(set.union(*SEARCHES.values()), set(labels))
        # All columns of the menu Alphabetical are as wide as its longest label.
        self.assertLessEqual(max(map(len, labels.values())), len("Extract Cells Along Lines Custom Source"))

    def test_the_documentation_of_a_number_begins_with_its_unit(self):
        for name, key, prop, _ in properties():
            if not prop.IsA("vtkSMDoubleVectorProperty") or prop.GetInformationOnly():
                continue
            if prop.GetNumberOfElements() != 1 or key in WITHOUT_UNIT:
                continue
            text = " ".join(prop.GetDocumentation().GetDescription().split())
            self.assertRegex(text.split(". ")[0], UNIT, name)

    def test_ports_have_names(self):
        for name, proxy, cxx in proxies():
            ports = PORTS.get(name, ["Surface", "History"])[: cxx().GetNumberOfOutputPorts()]
            found = [proxy.SMProxy.GetOutputPortName(i) for i in range(len(ports))]
            self.assertEqual(found, ports, name)

    def test_abstract_proxies_are_hidden(self):
        for name in ("SurfaceFilter", "SurfaceModelAlgorithm", "SurfaceDiffusionAlgorithm",
                     "SurfaceDataDiffusionAlgorithm"):
            self.assertFalse(hasattr(simple, name))

    def test_every_property_is_documented(self):
        for name, _, prop, _ in properties():
            text = prop.GetDocumentation().GetDescription() or ""
            self.assertGreater(len(text.strip()), 20, name)

    def test_labels_give_python_the_same_names(self):
        for name, key, prop, _ in properties():
            if not prop.GetInformationOnly():
                self.assertEqual(make_name_valid(prop.GetXMLLabel()), key, name)

    def test_every_property_is_one_of_cxx_with_the_same_default(self):
        for name, key, prop, cxx in properties():
            if key in NOT_CXX_PROPERTIES:
                continue
            default = getattr(cxx(), "Get" + key)()
            if prop.GetInformationOnly():
                self.assertEqual(prop.GetCommand(), "Get" + key, name)
            else:
                self.assertEqual(prop.GetCommand(), "Set" + key, name)
                found = tuple(prop.GetElement(i) for i in range(prop.GetNumberOfElements()))
                self.assertEqual(found if len(found) > 1 else found[0], default, name)

    def test_every_property_of_cxx_is_one_of_paraview(self):
        for name, proxy, cxx in proxies():
            setters = {
                method[len("Set"):]
                for method in set(dir(cxx)) - set(dir(vtkPolyDataAlgorithm))
                if method.startswith("Set")
            }
            words = {m for m in setters if any(m.startswith(s + "To") for s in setters)}
            missing = setters - words - set(proxy.ListProperties()) - {"Controller"}  # not a value
            self.assertEqual(missing, set(), name)

    def test_entries_of_enums_are_the_words_of_cxx(self):
        enums = set()
        for name, key, prop, cxx in properties():
            domain = prop.FindDomain("vtkSMEnumerationDomain")
            if domain is None:
                continue
            enums.add(key)
            for i in range(domain.GetNumberOfEntries()):
                instance = cxx()
                getattr(instance, "Set%sTo%s" % (key, domain.GetEntryText(i)))()
                value = getattr(instance, "Get" + key)()
                self.assertEqual(value, domain.GetEntryValue(i), name)
            if key != "TimeIntegrator":  # classes have different integrators
                words = [method for method in dir(cxx) if method.startswith("Set%sTo" % key)]
                self.assertEqual(len(words), domain.GetNumberOfEntries(), name)
        self.assertLessEqual({"Units", "MaskMode", "Solver", "Mode", "TimeIntegrator"}, enums)

    def test_every_visible_property_is_in_one_group(self):
        for name, proxy, _ in proxies():
            grouped = []
            for i in range(proxy.SMProxy.GetNumberOfPropertyGroups()):
                group = proxy.SMProxy.GetPropertyGroup(i)
                self.assertIn(group.GetXMLLabel(), GROUPS, name)
                for k in range(group.GetNumberOfProperties()):
                    grouped.append(group.GetProperty(k).GetXMLName())
            shown = [
                key for key in proxy.ListProperties()
                if key not in ("Input", "PointsWithValues", "Sources", "PathPoints")
                and not proxy.SMProxy.GetProperty(key).GetInformationOnly()
            ]
            self.assertEqual(sorted(grouped), sorted(shown), name)

    def test_groups_are_in_the_same_order_in_every_panel(self):
        """The panel shows a group where its first property is defined."""
        for name, proxy, _ in proxies():
            groups = {}
            for i in range(proxy.SMProxy.GetNumberOfPropertyGroups()):
                group = proxy.SMProxy.GetPropertyGroup(i)
                for k in range(group.GetNumberOfProperties()):
                    groups[group.GetProperty(k).GetXMLName()] = group.GetXMLLabel()
            found = list(dict.fromkeys(groups[key] for key in offered(proxy)))
            self.assertEqual(found, [group for group in GROUPS if group in found], name)

    def test_the_properties_that_decide_come_first(self):
        """Among the model's properties that the panel shows, those of the class precede those that
        it shares with others and that depend on them."""
        for name, first in (
            ("FVMHeatFilter", ["Mode", "FWHM", "AutomaticFidelity", "FidelityWeight"]),
            ("HarmonicMapFilter", ["Exponent", "LineField", "MoveVertices", "FidelityWeight"]),
            ("IntrinsicTVFilter",
             ["Mode", "EdgeFunction", "FidelityNorm", "AutomaticFidelity", "FidelityWeight"]),
            ("MumfordShahFilter",
             ["AutomaticThreshold", "NoiseLevel", "EdgeWidth"]),
            ("SurfaceDenoisingFilter", ["SurfaceType", "NoiseLevel"]),
            ("SurfaceCurvatureFilter", ["FWHM"]),
            ("SurfaceDerivativesFilter", ["Quantity", "SmoothingFWHM", "ResultOnCells"]),
            ("SurfaceDirectionFieldFilter",
             ["Method", "PrincipalDirection", "SmoothingLength", "Angle"]),
            ("SurfaceDistanceFilter", ["Method", "SpeedArray", "ComputeGradient"]),
            ("SurfaceRandomFieldFilter",
             ["Covariance", "FWHM", "NumberOfFields", "RandomSeed"]),
            ("SurfaceReliefFilter", ["Height", "Base", "Levels", "Overhang"]),
            ("SurfaceSegmentationFilter",
             ["NumberOfRegions", "AutomaticFidelity", "AutomaticMeans"]),
            ("TensorDiffusionFilter", ["Model", "ColorScale", "Metric", "FidelityWeight"]),
            ("TuringTextureFilter",
             ["Kinetics", "FeatureSize", "DiffusionRate1", "DiffusionRate2", "GrowthRate",
              "DecayRate"]),
        ):
            proxy = getattr(servermanager.filters, name)()
            model = set()
            for i in range(proxy.SMProxy.GetNumberOfPropertyGroups()):
                group = proxy.SMProxy.GetPropertyGroup(i)
                if group.GetXMLLabel() == "Model":
                    model |= {group.GetProperty(k).GetXMLName()
                              for k in range(group.GetNumberOfProperties())}
            shown = [key for key in offered(proxy) if key in model and not is_advanced(proxy, key)]
            self.assertEqual(shown, first, name)

    def test_at_most_ten_properties_are_shown_without_the_advanced_ones(self):
        for name, proxy, _ in proxies():
            found = [key for key in offered(proxy) if not is_advanced(proxy, key)]
            self.assertLessEqual(len(found), 10, (name, found))
            self.assertGreaterEqual(len(found), 3, (name, found))

    def test_the_panel_offers_a_choice_only_where_there_is_one(self):
        for name, proxy, _ in proxies():
            for key in offered(proxy):
                entries = proxy.SMProxy.GetProperty(key).FindDomain("vtkSMEnumerationDomain")
                if entries is not None:
                    self.assertGreater(entries.GetNumberOfEntries(), 1, (name, key))

    def test_the_panel_offers_no_property_that_has_no_effect(self):
        for name, values, hidden in (
            ("SurfaceSegmentationFilter", {}, {"Mean"}),
            ("MumfordShahFilter", {}, {"TimeStep", "RandomSeed"}),
            ("TensorDiffusionFilter", {}, {"RandomSeed"}),
            ("HarmonicMapFilter", {}, {"TimeIntegrator"}),  # it has only one
            ("FVMHeatFilter", dict(Mode=1), {"GenerateTimeSteps"}),
            ("TuringTextureFilter", dict(InputArray=["POINTS", "pair"]), {"InitialNoise"}),
            ("TuringTextureFilter", dict(DiffusionRateArray=["CELLS", "rates"]),
             {"DiffusionRate1", "DiffusionRate2"}),
        ):
            proxy = getattr(servermanager.filters, name)(Input=sphere_with_arrays())
            shown = set(offered(proxy))
            if values:
                self.assertLessEqual(hidden, shown, name)
            for key, value in values.items():
                setattr(proxy, key, value)
            self.assertEqual(set(offered(proxy)) & hidden, set(), (name, values))
            self.assertLessEqual(hidden, set(proxy.ListProperties()), name)  # for scripts
        regions = servermanager.filters.SurfaceSegmentationFilter(AutomaticMeans=0)
        self.assertIn("Mean", list(offered(regions)))
        heat = servermanager.filters.FVMHeatFilter(InitialFill="Noise")
        self.assertIn("RandomSeed", list(offered(heat)))

    def test_what_needs_a_convex_energy_is_offered_for_the_edge_functions_that_have_one(self):
        """The class says which: steady states of the others are an error."""
        functions = servermanager.filters.IntrinsicTVFilter().SMProxy.GetProperty(
            "EdgeFunction").FindDomain("vtkSMEnumerationDomain")
        needs = {"Mode", "AutomaticFidelity", "TimeIntegrator"}
        convex = []
        for i in range(functions.GetNumberOfEntries()):
            word = functions.GetEntryText(i)
            source = vtkSphereSource()
            source.Update()
            steady = vtkSurfaceDiffusion.vtkIntrinsicTVFilter()
            steady.AddObserver("ErrorEvent", lambda *_: None)
            steady.SetInputDataObject(source.GetOutput())
            steady.SetInputArrayToProcess(0, 0, 0, 0, "Normals")
            steady.SetModeToSteadyState()
            getattr(steady, "SetEdgeFunctionTo" + word)()
            is_convex = steady.GetExecutive().Update() == 1
            convex += [word] if is_convex else []
            proxy = servermanager.filters.IntrinsicTVFilter(EdgeFunction=word)
            self.assertEqual(needs & set(offered(proxy)), needs if is_convex else set(), word)
        self.assertGreater(len(convex), 1)
        self.assertLess(len(convex), functions.GetNumberOfEntries())
        listed = ", ".join(convex[:-1]) + " or " + convex[-1]
        for key in ("Mode", "TimeIntegrator"):
            prop = servermanager.filters.IntrinsicTVFilter().SMProxy.GetProperty(key)
            text = " ".join(prop.GetDocumentation().GetDescription().split())
            self.assertIn("It requires EdgeFunction " + listed, text)

    def test_filters_without_time_steps_have_no_properties_of_them(self):
        time = {"TimeStep", "NumberOfTimeSteps", "GenerateTimeSteps", "OutputInterval",
                "CheckpointMemoryLimit", "TimestepValues", "TimeUnit"}
        for name, proxy, cxx in proxies():
            expected = time if issubclass(cxx, vtkSurfaceDiffusion.vtkSurfaceDiffusionAlgorithm) else set()
            self.assertEqual(time & set(proxy.ListProperties()), expected, name)
        regions = servermanager.filters.SurfaceSegmentationFilter()
        unused = {"TimeIntegrator", "Solver", "Tolerance", "MaximumNumberOfIterations",
                  "DirectionArray", "FixedArray"}
        self.assertEqual(unused & set(regions.ListProperties()), set())

    def test_no_documentation_says_that_a_property_has_no_effect(self):
        for name, _, prop, _ in properties():
            text = " ".join((prop.GetDocumentation().GetDescription() or "").split())
            self.assertNotRegex(text, "^It has no effect", name)

    def test_lengths_have_a_domain_with_a_reset_button_and_are_off_at_first(self):
        lengths = {"FWHM", "FeatureSize", "SmoothingLength", "MergeTolerance"}
        found = set()
        for name, proxy, _ in proxies():
            for key in lengths & set(proxy.ListProperties()):
                if name == "MumfordShahFilter" and key == "SmoothingLength":
                    continue  # in the unit that Units selects
                found.add(key)
                prop = proxy.SMProxy.GetProperty(key)
                self.assertIsNotNone(prop.FindDomain("vtkSMBoundsDomain"), (name, key))
                self.assertIsNotNone(prop.GetHints().FindNestedElementByName("NoDefault"), key)
        self.assertEqual(found, lengths)

    def test_properties_that_exclude_each_other_are_not_offered_together(self):
        fwhm = dict(FWHM=0.5)
        for name, values, hidden in (
            ("FVMHeatFilter", fwhm, {"FidelityWeight", "AutomaticFidelity", "Mode", "TimeStep"}),
            ("FVMHeatFilter", dict(FidelityWeight=1.0), {"FWHM"}),
            ("FVMHeatFilter", dict(AutomaticFidelity=1), {"FWHM", "FidelityWeight"}),
            ("FVMHeatFilter", dict(Mode=1), {"FWHM", "TimeStep", "NumberOfTimeSteps"}),
            ("FVMHeatFilter", {}, {"HoldKnownValues", "MaskMode", "AlongDiffusivity"}),
            ("IntrinsicTVFilter", dict(EdgeFunction=1), {"Mode", "AutomaticFidelity"}),
            ("IntrinsicTVFilter", dict(FidelityNorm=1), {"AutomaticFidelity"}),
            ("IntrinsicTVFilter", dict(FidelityWeight=1.0), {"AutomaticFidelity"}),
            ("MumfordShahFilter", {}, {"EdgeThreshold", "SmoothingLength"}),
            ("MumfordShahFilter", dict(AutomaticThreshold=0), {"NoiseLevel"}),
            ("SurfaceDistanceFilter", {}, {"AlongSpeed", "AcrossSpeed", "AlongSpeedArray", "AcrossSpeedArray"}),
            ("SurfaceDistanceFilter", dict(Method=0), {"SpeedArray", "SourceTimes", "DirectionArray",
                                                       "AlongSpeed", "AcrossSpeed"}),
            ("SurfaceDistanceFilter", dict(Method=1), {"AlongSpeed", "AcrossSpeed"}),
            ("TuringTextureFilter", {}, {"FixedArray", "DiffusionRateAcross1"}),
            ("TuringTextureFilter", dict(IntrinsicDelaunay=1), {"DiffusionRateArray"}),
        ):
            proxy = getattr(servermanager.filters, name)()
            for key, value in values.items():
                proxy.SMProxy.GetProperty(key).SetElement(0, value)
            self.assertEqual(set(offered(proxy)) & hidden, set(), (name, values))
            # A state that a script has set can be left again.
            self.assertLessEqual(set(values), set(offered(proxy)), (name, values))

    def test_what_is_clicked_is_never_refused(self):
        """Any sequence of clicks on properties that the panel offers gives a run without error."""
        dice = random.Random(7)
        for name in filter_names():
            for _ in range(20):
                filter = getattr(servermanager.filters, name)(Input=sphere_with_arrays())
                clicked = []
                if name in ("FVMHeatFilter", "IntrinsicTVFilter", "SurfaceInterpolationFilter",
                            "SurfaceSegmentationFilter"):
                    filter.InputArray = dice.choice((["POINTS", "f"], ["CELLS", "g"]))
                if name == "SurfaceReliefFilter":
                    filter.InputArray = ["POINTS", "f"]
                if "NumberOfTimeSteps" in filter.ListProperties():
                    filter.NumberOfTimeSteps = 2
                for _ in range(8):
                    click(filter, dice, clicked)
                if name == "SurfaceDirectionFieldFilter" and filter.Method == "Hints":
                    filter.DirectionArray = ["CELLS", "up"]  # the hints, which the panel then shows
                errors = []
                algorithm = filter.SMProxy.GetClientSideObject()
                filter.SMProxy.UpdateVTKObjects()

                def remember(_object, _event, text):
                    errors.append(text)

                remember.CallDataType = "string0"
                algorithm.AddObserver("ErrorEvent", remember)
                filter.UpdatePipeline()
                self.assertEqual(errors, [], (name, clicked))


if __name__ == "__main__":
    unittest.main(verbosity=2)
