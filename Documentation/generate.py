# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the pages that are made from the sources: generate.py SOURCE SITE.

SITE becomes a folder for Sphinx: the pages of Documentation, a page for each filter (from the comment
of its header, the declarations of its settings and the names of its tests), scenes that show what
settings do, and the pages of the repository with their links changed. A new filter needs one entry in
FILTERS.
"""
import inspect
import os
import re
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import surfacediffusion as sd

SOURCE, SITE = (Path(argument).resolve() for argument in sys.argv[1:3])
sys.path.insert(0, str(SOURCE / "Examples/Python"))
sys.path.insert(0, str(SOURCE / "Examples/Web"))
from meshes import as_polydata  # noqa: E402
from scenes import find_viewer, save_scene  # noqa: E402


@dataclass(frozen=True)
class Filter:
    """name: of the function; tests: the files of tests in Testing/Core; scenes: what to show."""

    name: str
    vtk: str
    title: str
    picture: str
    tests: tuple
    scenes: tuple


# A scene: a keyword, three values of it, other keywords, and what can be seen.
FILTERS = [
    Filter("heat", "vtkFVMHeatFilter", "Linear diffusion", "heat.png",
           ("LinearDiffusion", "AnisotropicDiffusion", "SteadyState", "Deblurring"), (
        ("fwhm", (0.1, 0.3, 0.8), {}, "A larger width removes noise and blurs the edges of the data."),
        ("fidelity_weight", (0.5, 0.1, 0.02), {"mode": "SteadyState"},
         "A smaller weight λ keeps less of the data."))),
    Filter("intrinsic_tv", "vtkIntrinsicTVFilter", "Total variation", "figure4.png",
           ("TotalVariationFlow", "TotalVariationMinimizer", "NonlinearDiffusion", "EdgeFunctions",
            "CrouzeixRaviart"), (
        ("fidelity_weight", (20.0, 5.0, 1.0), {"mode": "SteadyState"},
         "A smaller weight λ removes more noise. Edges stay sharp, small details vanish."),
        ("edge_function", ("TotalVariation", "PeronaMalikRational", "Constant"), {},
         "Total variation preserves edges. A constant edge function is linear diffusion."))),
    Filter("harmonic_map", "vtkHarmonicMapFilter", "Harmonic maps", "harmonic_map.png",
           ("HarmonicMap", "HarmonicMapBehaviour", "HarmonicMapEnergy", "VertexUpdating"), (
        ("number_of_time_steps", (0, 5, 40), {"move_vertices": True, "time_step": 0.5},
         "More time makes a noisy mesh smoother."),)),
    Filter("denoise_mesh", "vtkSurfaceDenoisingFilter", "Mesh denoising", "mesh_denoising.png",
           ("SurfaceDenoising", "NoiseLevel"), (
        ("noise_level", (0.003, 0.01, 0.03), {},
         "A larger level removes more. Without it, the level of the noise is measured."),)),
    Filter("mumford_shah", "vtkMumfordShahFilter", "Edges", "mumford_shah.png", ("MumfordShah",), (
        ("edge_threshold", (0.2, 0.35, 0.6), {},
         "Jumps below the threshold are smoothed, jumps above it become edges."),)),
    Filter("segment", "vtkSurfaceSegmentationFilter", "Regions", "segmentation.png",
           ("Segmentation", "RegionBoundaries"), (
        ("number_of_regions", (2, 3), {}, "The regions have short boundaries in spite of noise."),)),
    Filter("turing_texture", "vtkTuringTextureFilter", "Textures", "turing_texture.png",
           ("ReactionDiffusion", "Kinetics", "CoarseStart"), (
        ("feature_size", (0.5, 0.75, 1.1), {}, "The feature size is the distance between spots."),)),
    Filter("direction_field", "vtkSurfaceDirectionFieldFilter", "Direction fields", "",
           ("SmoothLineField", "PrincipalDirections"), (
        ("angle", (0.0, 45.0, 90.0), {"method": "CurvatureAligned"},
         "Noise smeared along the field shows it. The angle turns all directions."),)),
]

PAGES = {  # of the repository, by their name on the site
    "Testing/Comparisons/README.md": "comparison", "Testing/Benchmarks/RESULTS.md": "speed",
    "Filters/DISTRIBUTED.md": "processes", "Filters/ADDING_A_MODEL.md": "adding_a_model",
    "Filters/README.md": "layers", "Examples/ParaView/GUIDE.md": "paraview",
    "CHANGELOG.md": "changelog",
}
VIRIDIS = np.array([(68, 1, 84), (58, 82, 139), (32, 144, 140), (94, 201, 97), (253, 231, 36)])


# ---- pages of filters ---------------------------------------------------------------------------

def header_comment(name):
    """The comment of a class as Markdown: paragraphs, indented formulas, tables."""
    text = (SOURCE / "Filters" / f"{name}.h").read_text()
    comment = text.split("/**", 1)[1].split("*/", 1)[0]
    lines = [re.sub(r"^ \* ?", "", line) for line in comment.splitlines()[1:]]
    brief = " ".join(lines[1:]).split("@brief", 1)[1] if False else next(
        line.split("@brief", 1)[1].strip() for line in lines if "@brief" in line)
    start = next(i for i, line in enumerate(lines) if "@brief" in line) + 1
    body = [line for line in lines[start:] if not line.startswith("@sa")]
    return brief[0].upper() + brief[1:], "\n".join(body).strip()


def sentences_of_tests(entry):
    """The tests' names as sentences, by file."""
    for file in entry.tests:
        path = SOURCE / "Testing/Core" / f"Test{file}.cxx"
        if path.is_file():
            names = re.findall(r"^TEST(?:_[FP])?\(\w+,\s*(\w+)\)", path.read_text(), re.M)
            yield path.name, [sentence(name) for name in names]


def sentence(name):
    words = re.findall(r"[A-Z]{2,}(?![a-z])|[A-Z][a-z]*|\d+|[a-z]+", name)
    return " ".join([words[0], *(w if w.isupper() and len(w) > 1 else w.lower() for w in words[1:])])


def settings_table(function):
    """The keywords of a function with their allowed values and what they do, from its docstring."""
    doc = inspect.getdoc(function)
    part = doc.split("Other Parameters\n----------------\n", 1)[1].split("\n\nReturns", 1)[0]
    rows = ["| property | allowed, default | effect |", "| --- | --- | --- |"]
    for entry in re.split(r"\n(?=\w+ : )", part):
        head, _, body = entry.partition("\n")
        keyword, _, kind = head.partition(" : ")
        effect = " ".join(body.split()).replace("|", "\\|").replace("<", "\\<")
        rows.append(f"| `{keyword}` | {kind.replace('|', chr(92) + '|').replace('{', '').replace('}', '')} | {effect} |")
    return "\n".join(rows)


def filter_page(entry, scenes):
    brief, body = header_comment(entry.vtk)
    function = getattr(sd, entry.name)
    picture = f"![{entry.title}](../pictures/{entry.picture})\n\n" if entry.picture else ""
    tests = "\n".join(f"**{file}**\n\n" + "\n".join(f"- {text}." for text in texts) + "\n"
                      for file, texts in sentences_of_tests(entry))
    shown = "\n".join(
        f"**{keyword}** is {', '.join(map(str, values))}, from left to right. {text}\n\n"
        "```{raw} html\n"
        f'<iframe src="../scenes/{file}" loading="lazy" title="{keyword}" width="100%" '
        'height="280" style="border: 0"></iframe>\n```\n'
        for file, keyword, values, text in scenes)
    seen = f"## Effect of properties\n\nThe mouse turns the surfaces.\n\n{shown}\n" if shown else ""
    return (f"# {entry.title}\n\n{brief}: class `{entry.vtk}` of VTK, ParaView's filter of that name, "
            f"and the function {{py:func}}`surfacediffusion.{entry.name}`.\n\n{picture}{seen}"
            f"## Method, inputs, outputs and limits\n\n{body}\n\n"
            f"The C++ reference is the page of `{entry.vtk}` in the [reference of the headers]"
            f"(../cpp.md).\n\n## Properties\n\nThe names are those of Python; those of C++, VTK and "
            "ParaView are the same words in capitals without underscores, as `TimeStep` for "
            f"`time_step`.\n\n{settings_table(function)}\n\n## Tests\n\nThese tests of the numerics "
            f"hold in every build:\n\n{tests}")


# ---- scenes -------------------------------------------------------------------------------------

class Panel:
    """A surface with colours for save_scene()."""

    view, up, table = (0, 0, 1), (0, 1, 0), None

    def __init__(self, points, triangles, values, title):
        values = np.asarray(values, float)
        if values.ndim == 2:  # vectors
            colours = 127.5 + 127.5 * values[:, :3]
        else:
            low, high = np.percentile(values, (1, 99))
            place = np.clip((values - low) / (high - low or 1), 0, 1) * (len(VIRIDIS) - 1)
            colours = np.stack([np.interp(place, range(len(VIRIDIS)), VIRIDIS[:, axis])
                                for axis in range(3)], axis=1)
        self.surface = as_polydata(points, triangles, {"colours": colours.astype(np.uint8)})
        self.array, self.title = "colours", title


def rough_pebble():
    ball = sd.sphere(4)
    x, y, z = ball.points.T
    random = np.random.default_rng(0)
    radius = 1 + 0.1 * np.sin(3 * x) * np.cos(2 * y) + 0.15 * y * z + random.normal(
        scale=0.01, size=x.size)
    stripes = np.digitize(np.sin(4 * x + 2 * y * z) + 0.6 * z, (-0.4, 0.5)).astype(float)
    return sd.Surface(radius[:, None] * ball.points, ball.triangles), stripes + random.normal(
        scale=0.2, size=x.size)


def scenes_of(entry):
    """Write the scenes of a filter; file, keyword, values and words of each."""
    if find_viewer() is None:
        return
    surface, values = rough_pebble()
    function = getattr(sd, entry.name)
    for keyword, numbers, others, text in entry.scenes:
        panels = []
        for number in numbers:
            keywords = {**others, keyword: number}
            points = surface.points
            if entry.name == "direction_field":
                noise = np.random.default_rng(1).uniform(size=surface.n_points)
                result = sd.heat(surface, noise, directions=function(surface, **keywords),
                                 across_diffusivity=0.001, time_step=5.0, number_of_time_steps=5)
            elif entry.name in ("harmonic_map", "turing_texture"):
                found = function(surface, **keywords)
                result = getattr(found, "texture", found.values)
                points = getattr(found, "points", points)
            elif entry.name == "denoise_mesh":
                points = function(surface, **keywords)
                result = np.linalg.norm(points - surface.points, axis=1)
            else:
                result = np.asarray(function(surface, values, **keywords))
            panels.append(Panel(points, surface.triangles, result, f"{keyword} {number}"))
        file = f"{entry.name}_{keyword}.html"
        save_scene(SITE / "extra/scenes" / file, panels, len(panels), f"{entry.title}: {keyword}")
        yield file, keyword, numbers, text


# ---- pages of the repository --------------------------------------------------------------------

def copied_page(path):
    """A page of the repository whose links lead to pages of the site; others become plain words."""
    text = (SOURCE / path).read_text()

    def change(match):
        mark, words, target = match.groups()
        if re.match(r"https?:|#", target):
            return match.group()
        full = os.path.normpath(os.path.join(os.path.dirname(path), target.split("#")[0]))
        if mark:
            return f"![{words}](pictures/{os.path.basename(full)})"
        if full in PAGES:
            return f"[{words}]({PAGES[full]}.md)"
        if not (SOURCE / full).exists():
            raise SystemExit(f"{path}: no such file: {target}")
        return f"{words} (`{full}`)"

    return re.sub(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)", change, text)


def main():
    shutil.rmtree(SITE, ignore_errors=True)
    shutil.copytree(SOURCE / "Documentation", SITE, ignore=shutil.ignore_patterns(
        "generate.py", "build.sh", "Doxyfile", "__pycache__"))
    shutil.copytree(SOURCE / "Examples/Gallery", SITE / "pictures")
    shutil.copytree(SOURCE / "Examples/Gallery", SITE / "extra/pictures")
    (SITE / "extra/scenes").mkdir(parents=True)
    (SITE / "filters").mkdir()
    for entry in FILTERS:
        page = filter_page(entry, list(scenes_of(entry)))
        (SITE / "filters" / f"{entry.name}.md").write_text(page)
    (SITE / "filters/index.md").write_text(
        "# Filters\n\n```{toctree}\n:maxdepth: 1\n\n" + "\n".join(f.name for f in FILTERS) + "\n```\n")
    for path, name in PAGES.items():
        (SITE / f"{name}.md").write_text(copied_page(path))


if __name__ == "__main__":
    main()
