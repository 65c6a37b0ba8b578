# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Data of one sphere at the vertices of another: resample, and metric-resample with Workbench's arguments."""
from __future__ import annotations

import numpy as np

from .. import Resampler
from ..files import FileError, read_data
from ..files.content import check_output_folder
from ..files.data import data_for, new_data
from . import common, inputs
from .areas import read_areas_or_surface
from .report import counted
from .surfaces import open_surface

#: The methods by their names in Workbench
WORKBENCH_METHODS = {"ADAP_BARY_AREA": "AdaptiveBarycentricArea", "BARYCENTRIC": "Barycentric"}

FILES = f"""
Spheres: {common.SURFACES.split(": ", 1)[1]}
DATA: GIFTI (.func.gii, .shape.gii, .label.gii), FreeSurfer (curv, .mgh, .annot, .label), NumPy (.npy), text, PLY or
VTK. OUTPUT has the format and the metadata of DATA, or one that its name gives:
{common.NEW_FORMATS.split(", or .ply")[0]}.
NaN means missing: the value is not used.
"""


def add_resample(commands):
    parser = commands.add(
        "resample", resample,
        "Take data from the vertices of a sphere to those of another one that is in register, as between "
        "fsaverage and fsLR. Labels (.label.gii, .annot) go to the label with the largest sum of weights. A "
        "vertex without known value near it is NaN.",
        ["fs_LR-deformed_to-fsaverage.L.sphere.32k_fs_LR.surf.gii fsaverage5.L.sphere.surf.gii "
         "L.myelin.func.gii lh.myelin.func.gii --source-areas L.midthickness.32k_fs_LR.surf.gii "
         "--target-areas lh.midthickness.surf.gii"], FILES)
    parser.add_argument("source", metavar="SOURCE-SPHERE", help="the sphere with the vertices of DATA")
    parser.add_argument("target", metavar="TARGET-SPHERE", help="the sphere with the vertices of OUTPUT")
    parser.add_argument("data", metavar="DATA", help="the values at the vertices of SOURCE-SPHERE")
    common.output(parser)
    for side in ("source", "target"):
        parser.add_argument(f"--{side}-areas", metavar="FILE",
                            help=f"the areas of the vertices of {side.upper()}-SPHERE on the brain: the "
                                 "midthickness surface, or areas in the first column, such as means of "
                                 "subjects (default: those on the sphere)")
    parser.add_argument("--method", metavar="NAME", default="AdaptiveBarycentricArea",
                        help="AdaptiveBarycentricArea (default): all values are used with their areas, as "
                             "Workbench's ADAP_BARY_AREA; Barycentric: linear interpolation")
    parser.add_argument("--labels", action="store_true",
                        help="the values are numbers of labels, as they are in .label.gii and .annot")
    parser.add_argument("--roi", metavar="FILE",
                        help="use values inside this region of SOURCE-SPHERE alone, where its first column is "
                             "above 0, or FILE:LABEL; where none has a weight, OUTPUT is 0")
    common.any_hemisphere(parser)
    common.zeros_and_columns(parser)
    parser.set_defaults(valid=None)


def add_metric_resample(commands):
    parser = commands.add(
        "metric-resample", metric_resample,
        "Resample data with the arguments of wb_command -metric-resample, and with their meaning. The result "
        "is that of `resample`, 0 where no value has a weight.",
        ["L.thickness.func.gii L.sphere.surf.gii fsLR.L.sphere.surf.gii ADAP_BARY_AREA out.func.gii "
         "-area-surfs L.midthickness.surf.gii fsLR.L.midthickness.surf.gii"], FILES)
    parser.add_argument("data", metavar="METRIC-IN", help="the values at the vertices of CURRENT-SPHERE")
    parser.add_argument("source", metavar="CURRENT-SPHERE", help="the sphere with the vertices of METRIC-IN")
    parser.add_argument("target", metavar="NEW-SPHERE", help="the sphere with the vertices of METRIC-OUT")
    parser.add_argument("method", metavar="METHOD", choices=WORKBENCH_METHODS,
                        help="ADAP_BARY_AREA or BARYCENTRIC")
    parser.add_argument("output", metavar="METRIC-OUT", help="the result")
    areas = parser.add_mutually_exclusive_group()
    for option, what in (("-area-surfs", "surfaces whose vertices have the areas"), ("-area-metrics", "the areas")):
        areas.add_argument(option, dest="area_files", nargs=2, metavar=("CURRENT-AREA", "NEW-AREA"),
                           help=f"{what} of the vertices of both spheres")
    parser.add_argument("-current-roi", dest="roi", metavar="FILE",
                        help="use values where its first column is above 0 alone")
    parser.add_argument("-valid-roi-out", dest="valid", metavar="FILE",
                        help="write 1 where a value has a weight, and 0 elsewhere")
    parser.add_argument("-largest", action="store_true",
                        help="not here: wb_command has it, and resample --labels what labels need")
    common.any_hemisphere(parser)
    parser.set_defaults(labels=False, fix_zeros=False, column=[])


def metric_resample(arguments, report):
    if arguments.largest:
        raise inputs.ArgumentProblem("-largest is not here; allowed: wb_command -metric-resample -largest, or "
                                     "resample --labels for labels")
    arguments.method = WORKBENCH_METHODS[arguments.method]
    if arguments.area_files is None and arguments.method != "Barycentric":
        raise inputs.ArgumentProblem("ADAP_BARY_AREA without areas; allowed: -area-surfs or -area-metrics")
    arguments.source_areas, arguments.target_areas = arguments.area_files or (None, None)
    resample(arguments, report, empty=0.0)


def resample(arguments, report, empty=np.nan):
    """empty: the value where no value has a weight."""
    for path in filter(None, (arguments.output, arguments.valid)):
        check_output_folder(path)
    with report.timed("read"):
        source, target = (open_surface(arguments, path, lengths=False)
                          for path in (arguments.source, arguments.target))
        _check_structures(source, target)
        areas = [read_areas_or_surface(path, sphere) for path, sphere in (
            (arguments.source_areas, source), (arguments.target_areas, target))]
        data = read_data(arguments.data)
        if data.kind == "cifti":
            raise FileError(f"{data.path}: a CIFTI file, of several structures; allowed: data of one surface, "
                            "such as .func.gii (wb_command -cifti-resample takes CIFTI files)")
        columns = inputs.choose_columns(data, arguments.column)
        are_labels = arguments.labels or data.labels
        (patch,) = inputs.make_patches({"": source}, data, columns, arguments, labels=are_labels)
        result = data_for(target, arguments.output, data, columns)
    with report.working("Resampling") as progress:
        resampler = _make_resampler(arguments, source, target, areas, patch, progress)
        found = resampler(patch.values, labels=are_labels)
        has_value = ~np.isnan(resampler(np.ones(len(source.points))))
    if arguments.roi is not None:
        empty = 0.0
    if are_labels:  # integers have no NaN
        found = np.nan_to_num(found).astype(data.parts[0].values.dtype)
    else:
        found[~has_value] = empty
    with report.timed("write"):
        result.save(arguments.output, [found])
        if arguments.valid is not None:
            new_data(target, arguments.valid, ["valid"]).save(arguments.valid, [has_value[:, None]])
    report.facts.update(
        data=data.path, output=arguments.output, method=resampler.method, labels=are_labels,
        source_points=len(source.points), target_points=len(target.points),
        without_value=int((~has_value).sum()))
    report.say_written(arguments.output, f"{counted(len(columns), 'column')}, {len(source.points)} to "
                       f"{len(target.points)} vertices")


def _check_structures(source, target):
    if source.structure and target.structure and source.structure != target.structure:
        raise FileError(f"{source.path} is of {source.structure}, but {target.path} of {target.structure}; "
                        "allowed: spheres of one structure")


def _make_resampler(arguments, source, target, areas, patch, progress):
    mask = patch.excluded if patch.excluded.any() else None
    try:
        return Resampler(source.solver, target.solver, arguments.method, *areas, mask, progress=progress)
    except ValueError as error:
        text = str(error)
        for word, sphere in (("source has", source), ("target has", target)):
            if text.startswith(word):
                raise FileError(f"{sphere.path} has{text.removeprefix(word)}") from error
        raise
