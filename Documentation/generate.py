# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the pages that are made from the sources: generate.py SOURCE SITE.

SITE becomes a folder for Sphinx: the pages of Documentation, those of the filters with the parts that
the sources have (the comment of the header, the settings, the names of the tests, scenes of
effects.py), and the pages of the repository with their links changed. A new filter needs an entry
in FILTERS, a page in filters, and an entry in effects.py.
"""
import inspect
import os
import re
import shutil
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path

import surfacediffusion as sd

SOURCE, SITE = (Path(argument).resolve() for argument in sys.argv[1:3])
sys.path.insert(0, str(SOURCE / "Examples/Python"))
import command_reference  # noqa: E402
from effects import write_scenes  # noqa: E402


@dataclass(frozen=True)
class Filter:
    """name: of the function and of the page; tests: the files of tests in Testing/Core."""

    name: str
    vtk: str
    tests: tuple


FILTERS = [
    Filter("heat", "vtkFVMHeatFilter",
           ("LinearDiffusion", "MixedMass", "AnisotropicDiffusion", "SteadyState", "Deblurring",
            "TangentDiffusion", "Period")),
    Filter("intrinsic_tv", "vtkIntrinsicTVFilter",
           ("TotalVariationFlow", "TotalVariationMinimizer", "NonlinearDiffusion", "EdgeFunctions",
            "CrouzeixRaviart", "ColorModels", "GeneralizedVariation")),
    Filter("tensor_diffusion", "vtkTensorDiffusionFilter", ("BeltramiFlow", "StructureDiffusion")),
    Filter("mumford_shah", "vtkMumfordShahFilter", ("MumfordShah",)),
    Filter("segment", "vtkSurfaceSegmentationFilter", ("Segmentation", "RegionBoundaries")),
    Filter("interpolate", "vtkSurfaceInterpolationFilter",
           ("Interpolation", "InterpolationField", "InterpolationOutliers", "InterpolationRun")),
    Filter("harmonic_map", "vtkHarmonicMapFilter",
           ("HarmonicMap", "HarmonicMapBehaviour", "HarmonicMapEnergy", "TangentMaps", "VertexUpdating")),
    Filter("denoise_mesh", "vtkSurfaceDenoisingFilter", ("SurfaceDenoising", "CorrelatedVertexNoise")),
    Filter("turing_texture", "vtkTuringTextureFilter",
           ("ReactionDiffusion", "Kinetics", "CoarseStart")),
    Filter("curvature", "vtkSurfaceCurvatureFilter", ("Curvature",)),
    Filter("derivatives", "vtkSurfaceDerivativesFilter", ("Derivatives",)),
    Filter("distance", "vtkSurfaceDistanceFilter",
           ("EikonalDistance", "GeodesicDistance", "HeatDistance", "DistanceRun")),
    Filter("random_field", "vtkSurfaceRandomFieldFilter", ("Fields",)),
    Filter("relief", "vtkSurfaceReliefFilter", ("Relief",)),
    Filter("direction_field", "vtkSurfaceDirectionFieldFilter",
           ("SmoothLineField", "PrincipalDirections")),
]

PAGES = {  # of the repository, by their name on the site
    "Testing/Comparisons/README.md": "comparison", "Testing/Comparisons/DISTANCES.md": "distances",
    "Testing/Comparisons/FIELDS.md": "surrogates",
    "Testing/Benchmarks/RESULTS.md": "speed", "Documentation/GPU.md": "GPU",
    "Filters/DISTRIBUTED.md": "processes", "Filters/ADDING_A_MODEL.md": "adding_a_model",
    "Filters/README.md": "layers", "Examples/ParaView/GUIDE.md": "paraview",
    "Examples/FIGURES.md": "figures", "Packaging/README.md": "packages",
    "CONTRIBUTING.md": "contributing", "RELEASING.md": "releasing", "CHANGELOG.md": "changelog",
}


# ---- pages of filters ---------------------------------------------------------------------------

def header_comment(name):
    """The comment of a class as Markdown: the brief, and paragraphs, indented formulas, tables."""
    text = (SOURCE / "Filters" / f"{name}.h").read_text()
    comment = text.split("/**", 1)[1].split("*/", 1)[0]
    lines = [re.sub(r"^ \* ?", "", line) for line in comment.splitlines()[1:]]
    start = next(i for i, line in enumerate(lines) if "@brief" in line)
    brief = lines[start].split("@brief", 1)[1].strip()
    body = [line for line in lines[start + 1:] if not line.startswith("@sa")]
    return brief[0].upper() + brief[1:], "\n".join(body).strip()


def tests_of(entry):
    """The names of the tests, by file."""
    for file in entry.tests:
        path = SOURCE / "Testing/Core" / f"Test{file}.cxx"
        yield path.name, re.findall(r"^TEST(?:_[FP])?\(\w+,\s*(\w+)\)", path.read_text(), re.M)


def sentence(name):
    """The words of a test's name."""
    words = re.findall(r"[A-Z0-9]{2,}(?![a-z])|[A-Z][a-z]*|\d+|[a-z]+", name)
    return " ".join([words[0], *(w if w.isupper() and len(w) > 1 else w.lower() for w in words[1:])])


def settings_table(function):
    """The keywords of a function with their allowed values and what they do, from its docstring."""
    doc = inspect.getdoc(function)
    part = re.split(r"\n(?:Other )?Parameters\n-+\n", doc)[-1].split("\n\nReturns", 1)[0]
    rows = ["| property | allowed, default | effect |", "| --- | --- | --- |"]
    for entry in re.split(r"\n(?=\w+ : )", part):
        head, _, body = entry.partition("\n")
        keyword, _, kind = head.partition(" : ")
        kind = re.sub("[{}]", "", kind).replace("|", "\\|")
        effect = " ".join(body.split()).replace("|", "\\|").replace("<", "\\<")
        rows.append(f"| `{keyword}` | {kind} | {effect} |")
    return "\n".join(rows)


def scenes_part(entry):
    """The scenes of a filter, with their words."""
    parts = ["The mouse turns the surfaces.\n"]
    for file, effect in write_scenes(entry.name, SITE / "extra/scenes"):
        parts.append(
            f"**{effect.property}** is {', '.join(map(str, effect.values))}, from left to right. "
            f"{effect.text}\n\n```{{raw}} html\n"
            f'<iframe src="../scenes/{file}" loading="lazy" title="{effect.property}" width="100%" '
            'height="240" style="border: 0"></iframe>\n```\n')
    return "\n".join(parts)


def exact_part(entry, names):
    """The named tests as sentences with their files; each has to exist."""
    for name in names.split():
        file = next((file for file, tests in tests_of(entry) if name in tests), None)
        if file is None:
            raise SystemExit(f"filters/{entry.name}.md: there is no test {name}")
        yield f"- {sentence(name)} (`{file}`)."


def reference_part(entry, body):
    tests = "\n".join(f"**{file}**\n\n" + "\n".join(f"- {sentence(name)}." for name in names) + "\n"
                      for file, names in tests_of(entry))
    return (f"## Method, inputs and outputs\n\n{body}\n\n## Properties\n\nThe names are those of "
            "Python; those of C++, VTK and ParaView are the same words in capitals without underscores, "
            f"as `TimeStep` for `time_step`.\n\n{settings_table(getattr(sd, entry.name))}\n\n"
            f"## All tests of the numerics\n\nThey hold in every build.\n\n{tests}")


def filter_page(entry):
    brief, body = header_comment(entry.vtk)
    text = (SOURCE / f"Documentation/filters/{entry.name}.md").read_text()
    text = text.replace("@@names", (
        f"{brief}: the function {{py:func}}`surfacediffusion.{entry.name}`, the class `{entry.vtk}` of VTK, "
        "and ParaView's filter of that name. The [reference of the headers](../cpp.md) has the class."))
    text = re.sub(r"^@@exact (.+)$", lambda match: "\n".join(exact_part(entry, match[1])), text,
                  flags=re.M)
    text = text.replace("@@scenes", scenes_part(entry))
    return text.replace("@@reference", reference_part(entry, body))


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
            shutil.copy(SOURCE / full, SITE / "pictures")
            return f"![{words}](pictures/{os.path.basename(full)})"
        if full in PAGES:
            return f"[{words}]({PAGES[full]}.md)"
        if not (SOURCE / full).exists():
            raise SystemExit(f"{path}: no such file: {target}")
        return f"{words} (`{full}`)"

    return re.sub(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)", change, text)


def start_page(text):
    """With a scene, and a link to the page without a server where build.sh makes that."""
    parts = ["The mouse turns the surfaces: noisy data, and total variation with less and less weight of the data.\n",
             "```{raw} html",
             '<iframe src="scenes/intrinsic_tv_fidelity_weight.html" title="Total variation" width="100%" '
             'height="240" style="border: 0"></iframe>']
    if shutil.which("em++"):
        parts.append('<p><a href="page/index.html">Open the page</a> to see and filter surfaces of your own.</p>')
    return text.replace("<!-- page -->", "\n".join([*parts, "```"]))


def main():
    warnings.simplefilter("error", sd.SurfaceDiffusionWarning)
    shutil.rmtree(SITE, ignore_errors=True)
    shutil.copytree(SOURCE / "Documentation", SITE, ignore=shutil.ignore_patterns(
        "generate.py", "effects.py", "command_reference.py", "build.sh", "Doxyfile", "__pycache__"))
    shutil.copy(SOURCE / "Examples/Cxx/arrays.cxx", SITE)  # which cpp.md includes
    shutil.copytree(SOURCE / "Examples/Gallery", SITE / "pictures")
    shutil.copytree(SOURCE / "Examples/Gallery", SITE / "extra/pictures")
    (SITE / "extra/scenes").mkdir(parents=True)
    for entry in FILTERS:
        (SITE / "filters" / f"{entry.name}.md").write_text(filter_page(entry))
    (SITE / "filters/index.md").write_text(
        "# Filters\n\n```{toctree}\n:maxdepth: 1\n\n" + "\n".join(f.name for f in FILTERS) + "\n```\n")
    (SITE / "command.md").write_text(command_reference.page())
    (SITE / "index.md").write_text(start_page((SITE / "index.md").read_text()))
    for path, name in PAGES.items():
        (SITE / f"{name}.md").write_text(copied_page(path))


if __name__ == "__main__":
    main()
