# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The scenes that show the effect of properties: write_scenes(name, folder) for a function of the
package. A new one needs a line in EFFECTS."""
from dataclasses import dataclass, field

import numpy as np

import surfacediffusion as sd
from scenes import save_scene
from surface_data import make_surface, with_arrays

VIRIDIS = np.array([(68, 1, 84), (58, 82, 139), (32, 144, 140), (94, 201, 97), (253, 231, 36)])


@dataclass(frozen=True)
class Effect:
    """The result for three values of a property beside the data. data: a function of this module."""

    property: str
    values: tuple
    text: str
    others: dict = field(default_factory=dict)
    data: str = "stripes"


EFFECTS = {
    "heat": (
        Effect("fwhm", (0.12, 0.3, 0.8), "A larger width removes noise and blurs the edges of the data."),
        Effect("fidelity_weight", (0.5, 0.1, 0.02), "A smaller weight λ keeps less of the data.",
               {"mode": "SteadyState"}),
        Effect("across_diffusivity", (1.0, 0.1, 0.001),
               "Along a direction field, here that of the curvature, the data flow in one direction if "
               "the diffusivity across it is small.",
               {"directions": "CurvatureAligned", "time_step": 5.0, "number_of_time_steps": 5}, "noise"),
        Effect("hold_known_values", (False, True), "Missing data (grey) are filled in. Known values move "
               "by the fidelity, or are held.", {"mode": "SteadyState", "fidelity_weight": 0.1}, "torn"),
        Effect("blur_fwhm", (0.0, 0.16, 0.3), "The data were blurred by a width of 0.3. A restoration "
               "with this width returns their edges, and one without keeps the blur.",
               {"mode": "SteadyState", "fidelity_weight": 500.0}, "blurred"),
    ),
    "intrinsic_tv": (
        Effect("fidelity_weight", (20.0, 5.0, 1.0), "A smaller weight λ removes more noise. Edges stay "
               "sharp, small details vanish.", {"mode": "SteadyState"}),
        Effect("edge_function", ("TotalVariation", "PeronaMalikRational", "Constant"),
               "Total variation preserves edges. A constant edge function is linear diffusion.",
               {"fidelity_weight": 0.0, "time_step": 0.3, "number_of_time_steps": 10,
                "edge_threshold": 0.2}),
        Effect("fidelity_norm", ("L2", "L1"), "Outliers pull the result with the norm L2. L1 replaces "
               "them and leaves the rest.", {"mode": "SteadyState", "fidelity_weight": 4.0}, "outliers"),
        Effect("regularizer", ("TV", "TGV"), "Total variation makes stairs of ramps and roofs. Total "
               "generalised variation keeps their slopes.",
               {"mode": "SteadyState", "automatic_fidelity": True, "stop_tolerance": 1e-3}, "roof"),
        Effect("number_of_time_steps", (1, 5, 20), "More time steps remove more."),
        Effect("blur_fwhm", (0.0, 0.16, 0.3), "The data were blurred by a width of 0.3. Total variation "
               "restores their edges.", {"mode": "SteadyState", "fidelity_weight": 500.0}, "blurred"),
    ),
    "tensor_diffusion": (
        Effect("model", ("Beltrami", "EdgeEnhancing", "CoherenceEnhancing"),
               "Coherence-enhancing diffusion closes gaps of lines.",
               {"contrast": 0.01, "color_scale": 50.0}, "lines"),
        Effect("color_scale", (1.0, 10.0, 100.0), "A small scale of Beltrami is linear diffusion. A large "
               "one keeps the edges, and some noise.", {"time_step": 0.5, "number_of_time_steps": 4}),
        Effect("contrast", (0.2, 0.05, 0.01), "Lines whose gradient is below the contrast are smoothed "
               "little. A smaller contrast closes more gaps.",
               {"model": "CoherenceEnhancing", "time_step": 4.0}, "lines"),
        Effect("integration_scale", (1.0, 4.0, 8.0), "The direction of lines is averaged over this scale. "
               "A larger one gives straighter lines.",
               {"model": "CoherenceEnhancing", "time_step": 4.0, "contrast": 0.02}, "lines"),
    ),
    "harmonic_map": (
        Effect("exponent", (1.0, 1.5, 2.0), "Exponent 1 keeps creases, 2 rounds them. "
               "Colours show the normals.", {"time_step": 0.2, "number_of_time_steps": 10}, "block"),
        Effect("number_of_time_steps", (2, 10, 40), "More time makes a noisy mesh smoother.",
               {"move_vertices": True, "time_step": 0.05}, "block"),
        Effect("fidelity_weight", (0.0, 10.0, 100.0), "The weight λ holds the normals, which are shown "
               "by colours, close to those of the data.", {"time_step": 0.05, "number_of_time_steps": 10},
               "block"),
    ),
    "mumford_shah": (
        Effect("edge_threshold", (0.45, 0.55, 0.7), "Jumps below the threshold are smoothed, jumps above "
               "it become edges."),
        Effect("smoothing_length", (2.0, 4.0, 8.0), "Between edges the data are smoothed over this "
               "length.", {"edge_threshold": 0.5}),
        Effect("edge_width", (1.0, 2.0, 3.0), "The array of edges, 1 − v. Wide edges are found more surely, "
               "and narrow ones are placed more exactly.", {"edge_threshold": 0.5, "shown": "edges"}),
    ),
    "segment": (
        Effect("number_of_regions", (2, 3), "The regions have short boundaries in spite of noise."),
        Effect("fidelity_weight", (4.0, 8.0, 30.0), "A smaller weight λ gives shorter boundaries, a larger "
               "one follows the noise.", {"automatic_fidelity": False, "number_of_regions": 3}),
    ),
    "interpolate": (
        Effect("exact", (True, False), "Values at 150 points have noise. Exact follows it; smoothing by "
               "cross-validation does not.", {}, "sparse"),
        Effect("correlation_length", (0.0, 0.3, 0.1), "The result returns to the mean of the values beyond "
               "the correlation length; 0 continues smoothly.", {}, "sparse"),
    ),
    "turing_texture": (
        Effect("feature_size", (0.5, 0.75, 1.1), "The feature size is the distance between spots."),
        Effect("kinetics", ("Turing", "GrayScott", "Schnakenberg"), "The reaction decides between spots, "
               "labyrinths and nets.", {"feature_size": 0.6}),
        Effect("diffusion_rate_across2", (2.6, 3.9, 5.2), "A rate that differs across the direction field "
               "turns spots into stripes.", {"directions": "Smooth", "feature_size": 0.5}),
        Effect("seed", (0, 1, 2), "Each seed gives another pattern of the same kind.",
               {"feature_size": 0.75}),
    ),
    "direction_field": (
        Effect("method", ("PrincipalCurvature", "CurvatureAligned", "Smooth"), "Noise smeared along the "
               "field shows it. The curvature decides, or smoothness."),
        Effect("angle", (0.0, 45.0, 90.0), "The angle turns all directions.",
               {"method": "CurvatureAligned"}),
        Effect("smoothing_length", (0.0, 0.2, 0.8), "The normals are smoothed over this length before their "
               "curvature is taken."),
    ),
    "curvature": (
        Effect("fwhm", (0.0, 0.2, 0.5), "At the scale of the mesh, noise hides the curvature. A width "
               "shows that of the bumps, a larger one that of the whole."),
    ),
    "derivatives": (
        Effect("quantity", ("Gradient", "Laplacian", "ConductionVelocity"), "The length of the gradient, the "
               "Laplacian, and the length of the velocity, if the data are arrival times.", {}, "blurred"),
        Effect("smoothing_fwhm", (0.1, 0.3, 0.6), "The length of the gradient: the wider the Gaussian, the "
               "less is left of the noise."),
    ),
    "distance": (
        Effect("method", ("Exact", "Eikonal", "Heat"), "Distances from three points, in bands: fronts that "
               "meet have a kink, exactly and by fast marching, and are round by the heat method. Automatic "
               "is Exact here.", {"sources": [200, 900, 1700]}, "bumps"),
    ),
    "random_field": (
        Effect("fwhm", (0.2, 0.4, 0.8), "Fields of one seed and several widths."),
        Effect("nu", (1, 3), "Matern's fields of one range: nu = 3 is smoother.", {"range": 0.8}),
        Effect("seed", (0, 1, 2), "Each seed gives another field.", {"fwhm": 0.3}),
    ),
    "relief": (
        Effect("height", (0.02, 0.06, -0.06), "A height below 0 is carved.", {}, "waves"),
        Effect("levels", ("Smooth", "Two"), "Two levels have flat tops. Their slopes have the width flank.",
               {"height": 0.06, "flank": 0.08}, "waves"),
        Effect("overhang", (None, 30.0, 0.0), "No relief on faces that face down more steeply than this "
               "angle, here away from the top of the picture.",
               {"height": 0.06, "up": (0.0, 1.0, 0.0)}, "waves"),
    ),
    "denoise_mesh": (
        Effect("noise_level", (0.0, 0.01, 0.05), "0 means that the noise is estimated. A larger level "
               "removes more.", {}, "block"),
        Effect("surface_type", ("Automatic", "CAD", "Organic"), "A CAD surface has smooth faces and sharp "
               "edges. An organic one has details of a few triangles.", {}, "block"),
    ),
}


# ---- surfaces with data -------------------------------------------------------------------------

def pebble():
    ball = sd.sphere(4)
    x, y, z = ball.points.T
    random = np.random.default_rng(0)
    radius = 1 + 0.1 * np.sin(3 * x) * np.cos(2 * y) + 0.15 * y * z + random.normal(
        scale=0.01, size=x.size)
    return sd.Surface(radius[:, None] * ball.points, ball.triangles)


def stripes():
    """Three values in stripes, with noise."""
    return pebble(), _clean() + np.random.default_rng(1).normal(scale=0.2, size=2562)


def noise():
    return pebble(), np.random.default_rng(1).uniform(size=2562)


def torn():
    surface, values = stripes()
    x, y, _ = surface.points.T
    return surface, np.where(np.abs(np.sin(4 * x + 3 * y)) < 0.3, np.nan, values)


def sparse():
    """A smooth field with noise at a few points, and NaN elsewhere."""
    surface = pebble()
    x, y, z = surface.points.T
    random = np.random.default_rng(3)
    known = random.choice(x.size, 150, replace=False)
    values = np.full(x.size, np.nan)
    values[known] = (np.sin(3 * x + y) + z**2)[known] + random.normal(scale=0.2, size=150)
    return surface, values


def blurred():
    surface = pebble()
    return surface, sd.heat(surface, _clean(), fwhm=0.3)


def roof():
    """A ridge between two slopes, with noise."""
    z = pebble().points[:, 2]
    return pebble(), np.abs(z) / np.abs(z).max() + np.random.default_rng(1).normal(scale=0.1, size=2562)


def outliers():
    random = np.random.default_rng(1)
    values = _clean() + random.normal(scale=0.05, size=2562)
    return pebble(), np.where(random.uniform(size=2562) < 0.1, random.uniform(-1, 4, 2562), values)


def lines():
    """Interrupted lines with noise."""
    surface = pebble()
    x, y, z = surface.points.T
    gaps = np.sin(7 * y) * np.sin(7 * z) > 0.75
    pattern = np.where(gaps, 0.5, 0.5 + 0.5 * np.sin(16 * (x + 0.3 * y * z)))
    return surface, pattern + np.random.default_rng(1).normal(scale=0.15, size=2562)


def waves():
    """Values from 0 to 1 on a smooth surface."""
    ball = sd.sphere(5)
    x, y, z = ball.points.T
    return ball, 0.5 + 0.5 * np.sin(12 * x) * np.sin(12 * y) * np.cos(12 * z)


def bumps():
    """A surface without data."""
    return pebble(), None


def block():
    """A rounded cube with sharp edges and a noisy surface, without data."""
    ball = sd.sphere(4)
    points = ball.points / np.abs(ball.points).max(axis=1, keepdims=True)
    return sd.Surface(points + np.random.default_rng(0).normal(scale=0.012, size=points.shape),
                      ball.triangles), None


def _clean():
    """What stripes() has without noise."""
    x, y, z = sd.sphere(4).points.T
    return np.digitize(np.sin(4 * x + 2 * y * z) + 0.6 * z, (-0.4, 0.5)).astype(float)


# ---- runs ---------------------------------------------------------------------------------------

def smeared(surface, directions):
    """Noise that has flowed along directions, which shows them."""
    return sd.heat(surface, noise()[1], directions=directions, across_diffusivity=0.001, time_step=5.0,
                   number_of_time_steps=5)


def run(name, surface, values, keywords):
    """Points and the values to show: an array at the points, or None for a grey surface."""
    keywords, points = dict(keywords), surface.points
    shown = keywords.pop("shown", "values")
    if "directions" in keywords:
        keywords["directions"] = sd.direction_field(surface, method=keywords["directions"])
    function = getattr(sd, name)
    if name == "direction_field":
        return points, smeared(surface, function(surface, **keywords))
    if name == "curvature":
        return points, function(surface, **keywords).mean
    if name == "derivatives":
        found = function(surface, values, **keywords)
        return points, np.linalg.norm(found, axis=1) if found.ndim == 2 else found
    if name == "distance":
        return points, function(surface, keywords.pop("sources"), **keywords) % 0.25
    if name == "random_field":
        return points, function(surface, **keywords)[:, 0]
    if name == "turing_texture":
        return points, function(surface, **keywords).texture
    if name == "relief":
        return function(surface, values, **keywords).surface.points, None
    if name == "denoise_mesh":
        return function(surface, **keywords), None
    if name == "harmonic_map":
        found = function(surface, **keywords)
        return (found.points, None) if keywords.get("move_vertices") else (points, found.values)
    found = function(surface, values, **keywords)
    return points, getattr(found, shown, found)


class Panel:
    """A surface with colours for save_scene()."""

    up, table, array = (0, 1, 0), None, "colours"

    def __init__(self, surface, points, values, title, limits=None, view=(0, 0, 1)):
        self.title, self.view = title, view
        triangles = surface.triangles
        if values is None:  # each triangle has points of its own, so that creases are seen
            points, triangles = points[triangles.ravel()], np.arange(triangles.size).reshape(-1, 3)
        self.surface = with_arrays(make_surface(points, triangles), **{
            self.array: colours_of(values, limits, len(points)).astype(np.uint8)})


def colours_of(values, limits, size):
    if values is None:
        return np.full((size, 3), 210.0)
    values = np.asarray(values, float)
    if values.ndim == 2:  # unit vectors
        return 127.5 + 127.5 * values[:, :3]
    low, high = limits or np.nanpercentile(values, (1, 99))
    place = np.clip((values - low) / (high - low or 1), 0, 1) * (len(VIRIDIS) - 1)
    colours = np.stack([np.interp(place, range(len(VIRIDIS)), VIRIDIS[:, axis]) for axis in range(3)],
                       axis=1)
    colours[np.isnan(values)] = 190
    return colours


def panels_of(name, effect):
    """The data, if there are any to compare with, and the results."""
    surface, values = globals()[effect.data]()
    view = (1, 0.8, 1.2) if effect.data == "block" else (0, 0, 1)
    limits, panels = None, []
    if name not in ("turing_texture", "direction_field", "distance", "random_field"):
        panels.append(Panel(surface, surface.points, values, "data", None, view))
    if name in ("heat", "intrinsic_tv", "tensor_diffusion") and effect.data != "noise":
        limits = tuple(np.nanpercentile(values, (2, 98)))
    if effect.others.get("shown") == "edges":
        limits = (0.0, 1.0)
    for value in effect.values:
        keywords = {**effect.others, effect.property: value}
        points, found = run(name, surface, values, keywords)
        panels.append(Panel(surface, points, found, str(value), limits, view))
    return panels


def write_scenes(name, folder):
    """Write a scene per effect; file and effect of each."""
    for effect in EFFECTS[name]:
        file = f"{name}_{effect.property}.html"
        panels = panels_of(name, effect)
        save_scene(folder / file, panels, len(panels), f"{name}: {effect.property}")
        yield file, effect
