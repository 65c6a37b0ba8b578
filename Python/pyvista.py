# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters as functions of PyVista meshes: each takes a mesh and returns a new one.

    from surfacediffusion.pyvista import heat

    smooth = heat(mesh, "thickness", FWHM=10)  # adds the point array "thicknessDiffused"
    states = heat(mesh, "thickness", times=[0, 1, 2, 4])  # a list of four meshes
    smooth, report = heat(mesh, "thickness", full_output=True)
    report.history["Energy"], report.EffectiveFidelityWeight

A mesh is a pyvista.PolyData with n points and m cells, or a pyvista.MultiBlock of such meshes,
whose blocks may be None or empty. The input is not modified. Arrays are passed by name. Keywords
that start with a capital are properties of the filter's class, for example TimeStep=2 or
Mode="SteadyState" (an enumeration takes one of its words); help(vtkFVMHeatFilter) and its siblings
list all of them with formula, unit, range and default. By default lengths are in mean edge lengths
and values in the range of the data (Units="Natural"); Units="Absolute" takes them in the units of
the coordinates and the data.

times (all functions but direction_field): times in the unit of TimeStep, in any order. The function
then returns a list with the mesh at each of them. Time 0 is the initial state; between two time
steps, the mesh is that of the earlier one.

full_output: if True, the function returns a pair: the mesh or the list, and a Report of the run.

Errors: TypeError if the mesh is not a surface (with the remedy) or if the filter has no such
property; ValueError if the filter rejects a property or an array, with its message, which names the
property, its value and what is allowed. Warnings of the filter, about defects of the mesh for
instance, are Python warnings of the category UserWarning.
"""

import re
import types
import warnings

import pyvista
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import (
    vtkFVMHeatFilter, vtkHarmonicMapFilter, vtkIntrinsicTVFilter, vtkMumfordShahFilter,
    vtkSurfaceDenoisingFilter, vtkSurfaceDirectionFieldFilter, vtkSurfaceSegmentationFilter,
    vtkTensorDiffusionFilter, vtkTuringTextureFilter,
)
from ._meshes import find_polydata

_POINTS = vtkDataObject.FIELD_ASSOCIATION_POINTS
_CELLS = vtkDataObject.FIELD_ASSOCIATION_CELLS

# The read-only values of the classes. A report has those that the filter has.
_REPORTED = (
    "TimeUnit", "MeanEdgeLength", "ValueRange", "NumberOfIterations", "Residual",
    "NumberOfUnusedPoints", "CoarseStartVertices",
    "EffectiveTimeStep", "EffectiveFidelityWeight", "EffectiveNoiseLevel",
    "EffectiveEdgeThreshold", "EffectiveSmoothingLength", "EstimatedNoiseLevel", "Wavelength",
    "WavelengthGrowthRate",
    "DiffusionRateFactor", "MeanDisplacement", "MaximumDisplacement", "VolumeBefore",
    "VolumeAfter", "EdgeLength", "Gap", "LabelGap", "NumberOfAlternations",
)


class Report(types.SimpleNamespace):
    """The read-only values of the filter after a run, for example MeanEdgeLength or
    EffectiveFidelityWeight, as attributes of the same names; and, except for direction fields,
    `history`, a dictionary of NumPy arrays with one entry per step up to the last time, beginning
    with the initial state: Step, Time, Total_0 ... (the integral of each component), Energy,
    Iterations, Residual, Seconds. That of mumford_shah() has `curves`, a pyvista.PolyData of lines.
    """


def heat(
    mesh, array=None, *, mask=None, direction=None, fixed=None, fidelity=None, times=None,
    full_output=False, **properties
):
    """Smooth, denoise or inpaint an array by linear diffusion (vtkFVMHeatFilter).

    Solves u_t = div(D grad u) + lambda chi (f - u), u(0) = f, with no flux across the boundary.
    D has the eigenvalues AlongDiffusivity and AcrossDiffusivity (default 1), lambda is
    FidelityWeight (default 0), and chi is 1 where f is known and 0 where it is missing.

    array      the data f: point array (n,) or (n, k) of any numeric type, NaN is missing, or cell
               array with m rows, whose result is a cell array unless ResultOnCells=False; default:
               the active scalars
    mask       point or cell array, nonzero is missing (or excluded with MaskMode="Exclude")
    direction  point or cell array (n, 3) or (m, 3): the direction that AlongDiffusivity acts along
    fixed      point or cell array, nonzero holds the value fixed (Dirichlet condition)
    fidelity   point or cell array: factors of FidelityWeight, 0 or more
    times, full_output   see help(surfacediffusion.pyvista)

    Useful properties: FWHM (width of the blur in the unit of the coordinates, in place of TimeStep;
    default 0: off), TimeStep (above 0, default 1, in squared mean edge lengths), NumberOfTimeSteps
    (default 10), AutomaticFidelity (default off), Mode ("TimeSteps" or "SteadyState").

    The result is the array <array>Diffused, with the shape of the data.
    """
    return _run(
        vtkFVMHeatFilter(), mesh, properties, (array, mask, direction, fixed, None, fidelity),
        times, full_output)


def intrinsic_tv(
    mesh, array=None, *, mask=None, direction=None, fixed=None, fidelity=None, times=None,
    full_output=False, **properties
):
    """Denoise or inpaint an array and preserve its edges (vtkIntrinsicTVFilter).

    Solves u_t = div(g(|grad u|) grad u) + lambda chi (f - u), u(0) = f, by default with the g of
    total variation, 1/sqrt(|grad u|^2 + beta).

    The arguments are those of heat(). Useful properties: FidelityWeight (lambda, default 3; smaller
    removes more), AutomaticFidelity (default off), EdgeFunction (default "TotalVariation"),
    FidelityNorm ("L2", or "L1" for salt-and-pepper noise), Mode ("TimeSteps" or "SteadyState"),
    ColorModel ("RGB", or "Opponent" or "ChromaticityBrightness" for colours).

    The result is the array <array>TV, with the shape of the data.
    """
    return _run(
        vtkIntrinsicTVFilter(), mesh, properties, (array, mask, direction, fixed, None, fidelity),
        times, full_output)


def tensor_diffusion(
    mesh, array=None, *, mask=None, direction=None, fixed=None, fidelity=None, times=None,
    full_output=False, **properties
):
    """Smooth a point array along its own edges or lines (vtkTensorDiffusionFilter).

    Solves m u_t = div(D grad u) + lambda chi (f - u), u(0) = f, with a D that follows from u.

    The arguments are those of heat(). Useful properties: Model ("Beltrami", the default,
    "CoherenceEnhancing" or "EdgeEnhancing"), ColorScale (b of Beltrami, default 10), Contrast (the
    gradient of lines and edges, default 0.05), IntegrationScale (over which the direction of lines
    is averaged, default 4), DiffusionAxes (default off), TimeStep (default 1),
    NumberOfTimeSteps (default 10).

    The result is the point array <array>Beltrami, <array>Coherent or <array>EdgeEnhanced, with the
    shape of the data, and with DiffusionAxes the cell array DiffusionAxes (m, 3).
    """
    return _run(
        vtkTensorDiffusionFilter(), mesh, properties, (array, mask, direction, fixed, None, fidelity),
        times, full_output)


def harmonic_map(
    mesh, array=None, *, mask=None, direction=None, fixed=None, fidelity=None, times=None,
    full_output=False, **properties
):
    """Regularise normals or other unit vectors, or denoise the mesh (vtkHarmonicMapFilter).

    Solves u_t = div(g grad u) + u g |grad u|^2 + lambda chi (f - u), u(0) = f/|f|, with
    g = (|grad u|^2 + beta)^((p - 2)/2); |u| = 1 at every point.

    array: the vectors f, a point array (n, k) with k >= 2, which are normalised first; default: the
    active normals, which are computed if there are none. The other arguments are those of heat().
    Useful properties: Exponent (p in [1, 2], default 1: creases are preserved), LineField (u and -u
    are equal, default off), MoveVertices (move the points to fit the normals, default off).

    The result is the array <array>Harmonic (n, k); NormalsHarmonic for computed normals.
    """
    return _run(
        vtkHarmonicMapFilter(), mesh, properties, (array, mask, direction, fixed, None, fidelity),
        times, full_output)


def mumford_shah(
    mesh, array=None, *, mask=None, direction=None, fixed=None, fidelity=None, times=None,
    full_output=False, **properties
):
    """Find the edges of an array, and smooth or inpaint the data between them
    (vtkMumfordShahFilter).

    Minimises the functional of Mumford and Shah in the approximation of Ambrosio and Tortorelli.

    The arguments are those of heat(). Useful properties: EdgeThreshold (the jump from which on an
    edge costs less than smoothing, in the range of the data) and SmoothingLength (in mean edge
    lengths), each of which turns AutomaticThreshold off; NoiseLevel for AutomaticThreshold, in the unit
    of the data (default 0: estimated); EdgeWidth (default 2 mean edge lengths).

    The results are the arrays <array>MumfordShah, with the shape of the data, and Edges (n,),
    which is 1 on edges. With full_output=True the report has the edges as `curves`.
    """
    algorithm = vtkMumfordShahFilter()
    if {"EdgeThreshold", "SmoothingLength"} & set(properties):
        algorithm.AutomaticThresholdOff()
    return _run(
        algorithm, mesh, properties, (array, mask, direction, fixed, None, fidelity),
        times, full_output)


def turing_texture(
    mesh, initial=None, *, mask=None, direction=None, fixed=None, rates=None, times=None,
    full_output=False, **properties
):
    """Grow a texture on the mesh by reaction and diffusion (vtkTuringTextureFilter).

    Solves du1/dt = D1 Lap u1 + F(u1, u2), du2/dt = D2 Lap u2 + G(u1, u2), where Lap is the
    Laplace-Beltrami operator and Kinetics selects F and G.

    initial: point array (n, 2), the initial state; default: the uniform steady state with noise.
    rates: cell array (m, 4) that replaces DiffusionRate1, DiffusionRateAcross1, DiffusionRate2 and
    DiffusionRateAcross2. The other arguments are those of heat(). Useful properties: FeatureSize
    (the wavelength in the unit of the coordinates, default 0: off), DiffusionRate1 and
    DiffusionRate2 (default 21 and 2.6), NumberOfTimeSteps (default 640), StopTolerance,
    CoarseStartSize (default 50000; 0: all steps run on the mesh itself, however large it is).

    The results are the point arrays u1, u2 and Texture, (n,) each.
    """
    return _run(
        vtkTuringTextureFilter(), mesh, properties, (initial, mask, direction, fixed, rates), times,
        full_output)


def segment(
    mesh, array=None, *, terms=None, seeds=None, mask=None, fidelity=None, means=None,
    full_output=False, **properties
):
    """Divide the mesh into regions with short boundaries (vtkSurfaceSegmentationFilter).

    Minimises 1/2 sum_k int |grad u_k| + lambda sum_k int u_k |f - c_k|^2 over the probabilities u_k
    of the regions.

    array   the data f: point array (n,) or (n, k) or cell array with m rows, NaN is missing;
            default: the active scalars
    terms   point or cell array of K components, data terms in place of |f - c_k|^2
    seeds   point or cell array of labels 1 ... K that points or cells keep, 0: free
    mask    point or cell array, nonzero is missing (or excluded with MaskMode="Exclude")
    fidelity   point or cell array of factors w >= 0 of the data terms; 0 is missing
    means   the means c, one row per region, with AutomaticMeans off; default: they are found
    full_output   see help(surfacediffusion.pyvista); `history` then has one entry per region: Area,
                  BoundaryLength, Components, Mean_0 ..., and `boundaries` is a mesh of polylines

    Useful properties: NumberOfRegions (default 2), FidelityWeight (lambda, which turns AutomaticFidelity
    off).

    The results are the arrays RegionId, RegionProbability and <array>Segmented.
    """
    algorithm = vtkSurfaceSegmentationFilter()
    if "FidelityWeight" in properties:
        algorithm.AutomaticFidelityOff()
    if means is not None:
        algorithm.AutomaticMeansOff()
        rows = [list(row) if hasattr(row, "__len__") else [row] for row in means]
        algorithm.SetNumberOfRegions(len(rows))
        for region, row in enumerate(rows, start=1):
            for component, value in enumerate(row):
                algorithm.SetMean(region, component, float(value))
    arrays = (array, mask, None, None, None, fidelity, seeds, terms)
    result = _run(algorithm, mesh, properties, arrays, None, full_output)
    if full_output:
        result[1].boundaries = _output(algorithm, 2)
    return result


def denoise_mesh(mesh, *, fixed=None, full_output=False, **properties):
    """Remove the noise of the points of the mesh (vtkSurfaceDenoisingFilter).

    fixed: point array; points with a nonzero value stay.
    properties: SurfaceType="Automatic" (default), "CAD" or "Organic"; NoiseLevel, the standard
    deviation of the noise in coordinate units (default: 0, measured).
    full_output: see help(surfacediffusion.pyvista).

    The result has moved points and the point array Displacement (n, 3).
    """
    return _run(vtkSurfaceDenoisingFilter(), mesh, properties, (None, None, None, fixed), None,
        full_output)


def direction_field(mesh, hints=None, *, full_output=False, **properties):
    """Compute a line field on the mesh (vtkSurfaceDirectionFieldFilter).

    hints: point or cell array (n, 3) or (m, 3) of directions, for Method="Hints"; zero or NaN is no
    hint. Other values of Method: "PrincipalCurvature" (default), "CurvatureAligned", "Smooth".
    full_output: see help(surfacediffusion.pyvista).

    The result is the cell array Direction (m, 3): unit vectors whose sign has no meaning, zero in
    cells that have no direction.
    """
    return _run(
        vtkSurfaceDirectionFieldFilter(), mesh, properties, (None, None, hints), None, full_output)


def _run(algorithm, mesh, properties, arrays, times, full_output):
    """Runs the filter; `arrays` are the names of input arrays 0, 1, ... (None: not set)."""
    surfaces = [surface for surface in find_polydata(mesh) if surface.n_points > 0]
    for index, name in enumerate(arrays):
        if name is not None:
            algorithm.SetInputArrayToProcess(index, 0, 0, _association(surfaces, index, name), name)
    for name, value in properties.items():
        _set(algorithm, name, value)
    algorithm.SetInputDataObject(mesh)
    messages = _Messages(algorithm, algorithm.GetExecutive())
    if times is None:
        algorithm.Update()
        messages.deliver()
        result = _output(algorithm)
    else:
        times = list(times)
        algorithm.GenerateTimeStepsOn()
        result = []
        for time in times:
            algorithm.UpdateTimeStep(float(time))
            messages.deliver()
            result.append(_output(algorithm))
        if full_output and times:
            algorithm.UpdateTimeStep(float(max(times)))  # the whole history
    return (result, _report(algorithm)) if full_output else result


class _Messages:
    """Collects the errors and warnings of objects, which are then not printed."""

    def __init__(self, *objects):
        self.errors, self.warnings = [], []
        for vtk_object in objects:
            for event, texts in (("ErrorEvent", self.errors), ("WarningEvent", self.warnings)):
                def remember(_object, _event, text, texts=texts):
                    # "ERROR: In File.cxx, line 12\nvtkClass (0x1234): the message"
                    texts.append(re.sub(r"^\w+: In [^\n]*\n\S+ \([^)]*\): ", "", text).strip())

                remember.CallDataType = "string0"
                vtk_object.AddObserver(event, remember)

    def deliver(self):
        """Raises the first error, and passes warnings on to the caller of the function."""
        for text in self.warnings:
            warnings.warn(text, stacklevel=4)
        self.warnings.clear()
        if self.errors:
            raise ValueError(self.errors[0])


def _output(algorithm, port=0):
    """A mesh that the next update of the filter does not change."""
    data = algorithm.GetOutputDataObject(port)
    copy = data.NewInstance()
    copy.ShallowCopy(data)
    return pyvista.wrap(copy)


def _report(algorithm):
    report = Report()
    for name in _REPORTED:
        if hasattr(algorithm, f"Get{name}"):
            setattr(report, name, getattr(algorithm, f"Get{name}")())
    if algorithm.GetNumberOfOutputPorts() > 1:
        columns = algorithm.GetOutputDataObject(1).GetRowData()
        report.history = {
            columns.GetArrayName(i): vtk_to_numpy(columns.GetArray(i))
            for i in range(columns.GetNumberOfArrays())
        }
    if algorithm.GetNumberOfOutputPorts() > 2:
        report.curves = _output(algorithm, 2)
    return report


def _association(surfaces, index, name):
    """Rates are on cells, all other arrays on points, or on cells if no point array has the name."""
    on_cells = index == 4 or (
        not any(name in surface.point_data for surface in surfaces)
        and any(name in surface.cell_data for surface in surfaces))
    return _CELLS if on_cells else _POINTS


def _set(algorithm, name, value):
    setter = f"Set{name}To{value}" if isinstance(value, str) else f"Set{name}"
    if hasattr(algorithm, setter):
        getattr(algorithm, setter)(*([] if isinstance(value, str) else [value]))
    elif isinstance(value, str) and hasattr(algorithm, f"Set{name}") and name.endswith("Name"):
        getattr(algorithm, f"Set{name}")(value)
    else:
        raise TypeError(f"{algorithm.GetClassName()} has no property {name} that can be {value!r}")
