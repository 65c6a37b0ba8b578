# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Every property of every class has a setting of its name and type, and every setting that a filter
prints is a property. Enumerators have the numbers of the settings' words. The defaults are the
documented ones."""

import re
import unittest

import vtkSurfaceDiffusion
from vtkmodules.vtkCommonCore import vtkCommand

FILTERS = [cls for name, cls in sorted(vars(vtkSurfaceDiffusion).items())
           if name.startswith("vtk") and name.endswith("Filter") and name != "vtkSurfaceFilter"]

#: Properties without a setting that are not one value each.
OTHERS = {"InputConnection", "InputData", "InputDataObject", "InputArrayToProcess", "Executive",
          "Controller", "Information", "ProgressText", "ProgressObserver", "ProgressShiftScale", "Mean"}


def make(cls):
    """A filter, and the list of its errors."""
    made, errors = cls(), []

    def keep(_, event, text):
        errors.append(text)
    keep.CallDataType = "string0"
    made.AddObserver(vtkCommand.ErrorEvent, keep)
    return made, errors


def properties(cls):
    """The names X of the class and its superclasses here that have SetX() and GetX()."""
    own = set()
    for base in cls.__mro__:
        if base.__module__.startswith(vtkSurfaceDiffusion.__name__):
            own |= set(vars(base))
    return sorted(name[3:] for name in own
                  if name.startswith("Set") and "Get" + name[3:] in own and name[3:] not in OTHERS)


def of_each_property(test):
    """test(self, filter, name) for each property of each class, after which there are no errors."""
    def tests(self):
        self.assertGreater(len(FILTERS), 1)
        for cls in FILTERS:
            for name in properties(cls):
                with self.subTest(cls=cls.__name__, property=name):
                    made, errors = make(cls)
                    test(self, made, name)
                    self.assertEqual(errors, [])
    return tests


#: The documented defaults, of all filters, of those with a model, of those with time steps, and of
#: those that diffuse data
SURFACE = dict(MergeCoincidentPoints=False, MergeTolerance=0.0, SeamTolerance=-1.0,
               RefineTo=0.0, MaximumNumberOfTriangles=4000000,
               NumberOfThreads=0, ResultArrayName="")
MODEL = dict(Units="Natural", MaskMode="Inpaint", RandomSeed=0, IntrinsicDelaunay=False,
             OutputPrecision="Input", **SURFACE)
STEPS = dict(
    TimeStep=1.0, NumberOfTimeSteps=10, GenerateTimeSteps=False, OutputInterval=1,
    CheckpointMemoryLimit=512, Solver="Automatic", Tolerance=1e-6,
    MaximumNumberOfIterations=1000, **MODEL)
DATA = dict(
    FidelityWeight=0.0, InitialFill="Harmonic", HoldKnownValues=False, ResultOnCells=True,
    KeepCellDetail=True, AlongDiffusivity=1.0, AcrossDiffusivity=1.0, **STEPS)
DEFAULTS = {
    "vtkFVMHeatFilter": {
        **DATA, "TimeIntegrator": "Automatic", "MassMatrix": "Automatic", "Mode": "TimeSteps", "FWHM": 0.0,
        "Period": 0.0, "VectorType": "Automatic", "VectorLaplacian": "Connection", "NormalPart": "Drop",
        "AutomaticFidelity": False, "NoiseLevel": 0.0, "BlurFWHM": 0.0, "BlurSteps": 4},
    "vtkIntrinsicTVFilter": {
        **DATA, "TimeIntegrator": "FirstOrder", "FidelityWeight": 3.0, "InitialFill": "Mean", "Tolerance": 1e-3, "Mode": "TimeSteps",
        "Regularizer": "TV", "TGVLength": 2.0, "EdgeFunction": "TotalVariation", "AcrossEdgeFunction": "Same", "Beta": 1e-6,
        "EdgeThreshold": 0.1, "ChannelCoupling": "Joint", "FidelityNorm": "L2",
        "AutomaticFidelity": True, "NoiseLevel": 0.0, "BlurFWHM": 0.0, "BlurSteps": 4,
        "AutomaticBlurFidelity": True, "Discretization": "Linear", "StopTolerance": 1e-4,
        "ColorModel": "RGB", "ChromaWeight": 0.2, "ChromaticityExponent": 1.0,
        "ChromaticityWeight": 1.0, "LinearLight": False},
    "vtkHarmonicMapFilter": {
        **DATA, "TimeIntegrator": "FirstOrder", "TimeStep": 0.1, "NumberOfTimeSteps": 3,
        "InitialFill": "Mean", "Exponent": 1.0, "Beta": 1e-6, "Scheme": "TangentPlane",
        "ConsistentReaction": False, "ProjectToSphere": True, "LineField": False, "TangentTo": "None",
        "UseAsNormals": True, "MoveVertices": False},
    "vtkMumfordShahFilter": {
        **DATA, "FidelityWeight": 1.0, "NumberOfTimeSteps": 1000, "Tolerance": 0.1,
        "AutomaticThreshold": True, "NoiseLevel": 0.0, "SmoothingLength": 8.0,
        "EdgeThreshold": 0.2, "EdgeWidth": 2.0, "StopTolerance": 1e-5, "EdgeCurves": True},
    "vtkTensorDiffusionFilter": {
        **DATA, "Model": "Beltrami", "ColorScale": 10.0, "Metric": "Induced",
        "NoiseScale": 1.0, "IntegrationScale": 4.0, "Contrast": 0.05, "Alpha": 1e-3,
        "DiffusionAxes": False},
    "vtkTuringTextureFilter": {
        **STEPS, "Tolerance": 1e-10, "TimeStep": 1 / 16, "NumberOfTimeSteps": 640,
        "TimeIntegrator": "SecondOrder",
        "Kinetics": "Turing", "ReactionRate": 1.0, "DiffusionRate1": 21.0, "DiffusionRate2": 2.6,
        "DiffusionRateAcross1": -1.0, "DiffusionRateAcross2": -1.0, "FeatureSize": 0.0, "RefineTo": -1.0,
        "InitialNoise": 0.1, "ClampToNonNegative": True, "AutomaticTimeStep": False,
        "StopTolerance": 0.02, "CoarseStartSize": 50000, "GrowthRate": 16.0, "DecayRate": 12.0,
        "ActivatorSupply": 0.01, "SubstrateSupply": 1.0, "FeedRate": 0.05, "KillRate": 0.06,
        "ReactantA": 2.0, "ReactantB": 4.0, "InhibitorDecayRate": 1.05, "Saturation": 0.0,
        "RecoveryRate": 1.2, "RecoveryDamping": 0.9, "Stimulus": 0.0, "TextureChemical": "U1",
        "ColorOutput": False, "LowColor": (0.16, 0.09, 0.05),
        "HighColor": (0.93, 0.8, 0.58)},
    "vtkSurfaceSegmentationFilter": {
        **MODEL, "NumberOfRegions": 2, "AutomaticFidelity": True, "FidelityWeight": 0.3,
        "AutomaticMeans": True, "ResultOnCells": True, "StopTolerance": 1e-3},
    "vtkSurfaceInterpolationFilter": {
        **MODEL, "CorrelationLength": 0.0, "Exact": False, "AutomaticSmoothing": True,
        "NoiseLevel": 0.0, "Smoothing": 1.0, "KeepRange": False, "ComputeError": False,
        "Robust": False, "LeaveOneOut": False,
        "PointValueArray": "", "PointWeightArray": "", "Boundary": "Automatic",
        "MaximumDistance": 0.0, "AlongDiffusivity": 1.0,
        "AcrossDiffusivity": 1.0, "ResultOnCells": True},
    "vtkSurfaceDenoisingFilter": {
        **SURFACE, "ResultArrayName": "Displacement", "NoiseLevel": 0.0,
        "NoiseLength": 0.0, "SurfaceType": "Automatic", "CreaseAngle": 0.0, "DisplacementLimit": 0.0},
    "vtkSurfaceReliefFilter": {
        **SURFACE, "ResultArrayName": "ReliefHeight", "Height": 1.0, "Base": 0.0, "Levels": "Smooth",
        "Threshold": 0.5, "Flank": 0.0, "Overhang": -1.0, "UpDirection": (0.0, 0.0, 1.0)},
    "vtkSurfaceCurvatureFilter": {**SURFACE, "FWHM": 0.0},
    "vtkSurfaceRandomFieldFilter": {
        **SURFACE, "Covariance": "Gaussian", "FWHM": 0.0, "Range": 0.0, "Smoothness": 1.0,
        "NumberOfFields": 1, "RandomSeed": 0, "Normalize": True},
    "vtkSurfaceDerivativesFilter": {
        **SURFACE, "Quantity": "Gradient", "SmoothingFWHM": 0.0, "ResultOnCells": False},
    "vtkSurfaceDistanceFilter": {
        **SURFACE, "Method": "Automatic", "MaximumDistance": 0.0, "AlongSpeed": 1.0, "AcrossSpeed": 1.0,
        "ComputeGradient": False, "Signed": False},
    "vtkSurfaceDirectionFieldFilter": {
        **SURFACE, "ResultArrayName": "Direction", "Method": "PrincipalCurvature",
        "PrincipalDirection": "Minimum", "SmoothingLength": -1.0, "HintWeight": 0.1, "Angle": 0.0},
}

#: The words of choices in the order of their numbers 0, 1, ..., which scripts may use
EDGE_FUNCTIONS = ("TotalVariation", "PeronaMalikExponential", "PeronaMalikRational", "Charbonnier",
                  "Weickert", "Constant")
WORDS = {
    "Covariance": ("Gaussian", "MaternNu1", "MaternNu3", "Matern"),
    "Quantity": ("Gradient", "Divergence", "Curl", "Laplacian", "ConductionVelocity",
                 "Helmholtz"),
    "Units": ("Natural", "Absolute"), "MaskMode": ("Inpaint", "Exclude"),
    "InitialFill": ("Input", "Mean", "Noise", "Harmonic"), "Mode": ("TimeSteps", "SteadyState"),
    "TimeIntegrator": ("FirstOrder", "SecondOrder", "Implicit", "Exponential", "Automatic"),
    "MassMatrix": ("Automatic", "Lumped", "Mixed"),
    "VectorType": ("Automatic", "Components", "Tangent"),
    "VectorLaplacian": ("Connection", "Hodge", "Viscous"), "NormalPart": ("Drop", "Keep", "Diffuse"),
    "TangentTo": ("None", "Surface"),
    "Solver": ("Automatic", "Direct", "ConjugateGradient", "Multigrid"),
    "OutputPrecision": ("Single", "Double", "Input"), "EdgeFunction": EDGE_FUNCTIONS,
    "AcrossEdgeFunction": ("Same", *EDGE_FUNCTIONS), "ChannelCoupling": ("PerChannel", "Joint"),
    "FidelityNorm": ("L2", "L1"), "Regularizer": ("TV", "TGV"), "Discretization": ("Linear", "CrouzeixRaviart"),
    "ColorModel": ("RGB", "Opponent", "ChromaticityBrightness"),
    "Scheme": ("ExplicitReaction", "TangentPlane", "MinimizingMovement"),
    "Model": ("Beltrami", "CoherenceEnhancing", "EdgeEnhancing"), "Metric": ("Induced", "Fixed"),
    "Kinetics": ("Turing", "Schnakenberg", "GrayScott", "Brusselator", "GiererMeinhardt",
                 "FitzHughNagumo"),
    "TextureChemical": ("U1", "U2"), "SurfaceType": ("Automatic", "CAD", "Organic"),
    "Levels": ("Smooth", "Two"),
    "Method": ("PrincipalCurvature", "CurvatureAligned", "Smooth", "Hints"),
    "vtkSurfaceDistanceFilter Method": ("Heat", "Eikonal", "Exact", "Automatic"),
    "PrincipalDirection": ("Minimum", "Maximum"), "Boundary": ("Natural", "Free", "Automatic"),
}


def value_of(made, name):
    """The value of a property: the word of a choice."""
    return getattr(made, f"Get{name}AsString" if hasattr(made, f"Get{name}AsString") else "Get" + name)()


class Properties(unittest.TestCase):
    def test_have_the_documented_defaults(self):
        self.assertEqual({cls.__name__ for cls in FILTERS}, set(DEFAULTS))
        for cls in FILTERS:
            with self.subTest(cls=cls.__name__):
                found = {name: value_of(cls(), name) for name in properties(cls)}
                self.assertEqual(found, DEFAULTS[cls.__name__])

    @of_each_property
    def test_have_a_setting_of_their_name_and_type(self, made, name):
        value = getattr(made, "Get" + name)()
        before = made.GetMTime()
        getattr(made, "Set" + name)(*(value if isinstance(value, tuple) else (value,)))
        self.assertEqual(made.GetMTime(), before, "the same value is no change")
        self.assertIn(f"\n  {name}: ", str(made))
        if isinstance(value, (bool, int, float)):
            other = not value if isinstance(value, bool) else value + 1
            getattr(made, "Set" + name)(other)
            self.assertEqual(getattr(made, "Get" + name)(), other)
            self.assertGreater(made.GetMTime(), before)

    @of_each_property
    def test_that_are_switches_can_be_turned_on_and_off(self, made, name):
        if isinstance(getattr(made, "Get" + name)(), bool):
            for value, suffix in ((True, "On"), (False, "Off")):
                getattr(made, name + suffix)()
                self.assertIs(getattr(made, "Get" + name)(), value)

    @of_each_property
    def test_have_enumerators_with_the_numbers_of_their_words(self, made, name):
        setters = [word for word in dir(made) if re.fullmatch(f"Set{name}To[A-Z].*", word)]
        self.assertEqual(len(setters) > 1, hasattr(made, f"Get{name}AsString"))
        for setter in setters:
            word = setter[len(f"Set{name}To"):]
            getattr(made, setter)()
            self.assertEqual(getattr(made, f"Get{name}AsString")(), word)
            numbers = [getattr(made, e) for e in dir(made)
                       if e.isupper() and e.replace("_", "") == (name + word).upper()]
            self.assertEqual(numbers, [getattr(made, "Get" + name)()])

    @of_each_property
    def test_number_their_words_in_order_and_have_none_for_other_numbers(self, made, name):
        self.assertEqual(hasattr(made, f"Get{name}AsString"), name in WORDS)
        words = WORDS.get(f"{type(made).__name__} {name}", WORDS.get(name, ()))
        for number in range(-1, len(words) + 1) if words else ():
            getattr(made, "Set" + name)(number)
            self.assertEqual(getattr(made, f"Get{name}AsString")(),
                             words[number] if 0 <= number < len(words) else "Unknown")

    def test_are_all_the_settings_that_a_filter_prints(self):
        for cls in FILTERS:
            printed = re.findall(r"^  (\w+):", str(cls()), re.MULTILINE)
            self.assertGreater(len(printed), 10)
            for name in printed[printed.index("Debug"):]:
                with self.subTest(cls=cls.__name__, setting=name):
                    self.assertTrue(hasattr(cls, "Get" + name) or name in {
                        "Debug", "Observers", "Executive", "Information", "Means",
                        "MissingValue"})


if __name__ == "__main__":
    unittest.main()
