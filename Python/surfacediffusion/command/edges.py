# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Edges and regions of data: enhance, edges, segment."""
from __future__ import annotations

import numpy as np

from .. import mumford_shah, tensor_diffusion
from .. import segment as find_regions
from ..files import FileError, new_data, read_surface
from ..files.content import check_output_folder
from . import common, inputs, values
from .report import counted, number, number_text
from .stages import change_data, columns_of_arrays, given, require_array, write_array


def add_enhance(commands):
    parser = commands.add(
        "enhance", enhance,
        "Smooth data along their own lines or edges: stripes, ridges and fingerprints become more "
        "distinct, and interrupted ones are closed. NaN is filled in. The channels of a colour have "
        "their lines in common, all other columns have their own.",
        ["scan.ply scan.ply closed.ply --time 20", "scan.ply scan.ply clean.ply --model beltrami"])
    common.data_to_data(parser)
    parser.add_argument("--model", choices=("lines", "edges", "beltrami"), default="lines",
                        help="lines: coherence-enhancing diffusion along lines (default); edges: "
                             "edge-enhancing diffusion, smooth away from edges; beltrami: the area of "
                             "the data as a surface is reduced, which keeps the edges of colours")
    common.positive(parser, "--time", "T",
                    "the time of diffusion, in squared mean edge lengths (default 10)", 10.0)
    common.steps(parser, "number of time steps (default 10)", 10)
    common.positive(parser, "--contrast", "K",
                    "the gradient of lines and edges, in ranges of the data per mean edge length "
                    "(default 0.05; for beltrami 0.1)")
    parser.add_argument("--scale", metavar="S", type=values.not_negative,
                        help="the distance over which the direction of lines is averaged, in mean edge "
                             "lengths (default 4)")


def enhance(arguments, report):
    options = {"time_step": arguments.time / arguments.steps,
               "number_of_time_steps": arguments.steps,
               "model": {"lines": "CoherenceEnhancing", "edges": "EdgeEnhancing",
                         "beltrami": "Beltrami"}[arguments.model]}
    if arguments.contrast and arguments.model == "beltrami":
        options["color_scale"] = 1 / arguments.contrast
    elif arguments.contrast:
        options["contrast"] = arguments.contrast
    if arguments.scale is not None:
        if arguments.model != "lines":
            raise FileError(f"--scale is {arguments.scale:g}; allowed: with --model lines")
        options["integration_scale"] = arguments.scale
    report.facts.update(model=arguments.model, time=arguments.time, steps=arguments.steps)

    def compute(surface, values, **run):
        return tensor_diffusion(surface, values, **options, **run)

    change_data(arguments, report, "Enhancing", compute, columns_of_arrays)


def add_edges(commands):
    parser = commands.add(
        "edges", edges,
        "Find the edges of data, and smooth the data between them, by the functional of Mumford "
        "and Shah. NaN is filled in, with edges that continue. The channels of a colour have "
        "their edges in common, all other columns have their own.",
        ["scan.ply scan.ply smooth.ply --map edges.npy --curves curves.npy"])
    common.data_to_data(parser, "the data, smooth between edges")
    parser.add_argument("--map", metavar="FILE",
                        help="write 1 - v, which is 1 on edges, at the vertices: " + common.NEW_FORMATS)
    parser.add_argument("--curves", metavar="FILE",
                        help="write the points of curves along the edges, a .npy array with rows of "
                             "the number of the curve and x, y, z")
    common.positive(parser, "--threshold", "J",
                    "the jump from which on an edge is kept, in the range of the data; at least three "
                    "times the noise (default: found from the data, together with --length; with "
                    "--length: 0.2)")
    common.positive(parser, "--length", "L",
                    "the length over which data are smoothed, in mean edge lengths (default: found from "
                    "the data; with --threshold: 8)")
    common.noise(parser, "the noise, if --threshold and --length are found (default: estimated)")
    common.positive(parser, "--width", "E", "the width of an edge, in mean edge lengths (default 2)")


def edges(arguments, report):
    options = given(edge_threshold=arguments.threshold, smoothing_length=arguments.length,
                    edge_width=arguments.width, noise_level=arguments.noise)
    if arguments.threshold or arguments.length:
        inputs.refuse(arguments, ["--noise"], "with --threshold or --length", "without them")
    for name in (arguments.map, arguments.curves):
        if name is not None:
            check_output_folder(name)
    if arguments.curves is not None:
        require_array(arguments.curves, "curves")
    if (arguments.map or arguments.curves) and not arguments.surface:
        raise FileError("--map and --curves need one surface; allowed: without --left and --right")
    maps, curves = [], []

    def compute(surface, values, **run):
        result = mumford_shah(surface, values, **options, **run)
        maps.append(result.edges)
        curves.extend(result.curves)
        report.facts["edge_length"] = number(
            (report.facts.get("edge_length") or 0.0) + result.edge_length)
        return result.values

    change_data(arguments, report, "Edges", compute, columns_of_arrays)
    report.facts["curves"] = len(curves)
    report.say(f"{counted(len(curves), 'edge')} of length {report.facts['edge_length']:.4g}")
    with report.timed("write"):
        if arguments.map is not None:
            target = new_data(read_surface(arguments.surface), arguments.map,
                              [f"Edges{k + 1}" for k in range(len(maps))])
            target.save(arguments.map, [np.column_stack(maps).astype(np.float32)])
        if arguments.curves is not None:  # rows of the number of the curve and the coordinates
            rows = [np.column_stack([np.full(len(curve), k), curve]) for k, curve in enumerate(curves)]
            write_array(arguments.curves, np.concatenate(rows) if rows else np.empty((0, 4)))


def add_segment(commands):
    parser = commands.add(
        "segment", segment,
        "Divide a surface into regions with short boundaries, by the convex models of Chan and "
        "Vese and of Potts. The result is the label of the region of each vertex, 1, 2, ... in "
        "the order of the means, or in that of --means.",
        ["lh.midthickness.surf.gii lh.myelin.func.gii lh.regions.func.gii --regions 3"])
    common.data_to_data(parser, "the labels")
    parser.add_argument("--regions", metavar="K",
                        type=values.whole_numbers("a whole number from 2 to 1000", 2, 1000),
                        help="the number of regions (default 2)")
    common.positive(parser, "--weight", "W",
                    "the weight of the data, in natural units; smaller gives shorter boundaries and "
                    "fewer small regions (default: found from the data)")
    parser.add_argument("--means", metavar="C", type=values.finite, nargs="+",
                        help="the mean of each region, for data of one component, in place of "
                             "--regions. Default: they are found")
    common.seed(parser, "of the search for means")
    parser.set_defaults(seed=None)


def segment(arguments, report):
    options = {"number_of_regions": arguments.regions or 2, **given(fidelity_weight=arguments.weight)}
    if arguments.means:
        if len(arguments.means) < 2:
            raise inputs.ArgumentProblem("--means has 1 number; allowed: 2 or more")
        if arguments.regions not in (None, len(arguments.means)):
            raise inputs.ArgumentProblem(f"--regions is {arguments.regions}, but --means has "
                                         f"{len(arguments.means)} numbers; allowed: the same number, "
                                         "or --means alone")
        inputs.refuse(arguments, ["--seed"], "with --means", "one of them")
        options.update(means=arguments.means, number_of_regions=len(arguments.means))
    found = report.facts.setdefault("segmentations", [])

    def compute(surface, values, **run):
        result = find_regions(surface, values, seed=arguments.seed or 0, **options, **run)
        rows = [{"region": k + 1, "area": number(result.areas[k]),
                 "boundary_length": number(result.boundary_lengths[k]),
                 "components": int(result.components[k]),
                 "mean": [number(mean) for mean in result.means[k]]}
                for k in range(len(result.areas))]
        found.append({"gap": number(result.gap), "regions": rows})
        return np.repeat(result.values[:, None].astype(float), values.shape[1], axis=1)

    change_data(arguments, report, "Segmentation", compute, columns_of_arrays, labels=True)
    for entry in found:
        for row in entry["regions"]:
            report.say(f"region {row['region']}: mean {', '.join(map(number_text, row['mean']))}, area "
                       f"{number_text(row['area'])}, boundary {number_text(row['boundary_length'])}, "
                       f"{row['components']} connected")
