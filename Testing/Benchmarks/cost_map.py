#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What one call of each function of the numpy package costs, as a table in Markdown.

    cost_map.py [--sizes 5 6 7] [--only NAME ...] [--repeat 3]

The surfaces are spheres with bumps of 10 4^s + 2 vertices. Processor time, the minimum of the repeats, is in
heats: that of ``heat(fwhm=6 h)`` on the same surface in the same process, which is repeated beside each
function, as machines are not equally fast all the time. kB are resident memory a vertex beyond the input.
Growth is the time a vertex at the last size over that at the first. Each function and size has a process of
its own.
"""

import argparse
import json
import resource
import subprocess
import sys
import time
import warnings

import numpy as np

import surfacediffusion as sd


class Inputs:
    """A sphere with bumps, and data of each kind."""

    def __init__(self, subdivisions):
        sphere = sd.sphere(subdivisions)
        x, y, z = sphere.points.T
        bumps = 1.0 + 0.1 * np.sin(5.0 * x) * np.cos(4.0 * y) + 0.05 * np.sin(9.0 * z)
        self.surface = sd.Surface(sphere.points * bumps[:, None], sphere.faces)
        self.points = self.surface.points
        self.n = len(x)
        self.h = float(np.sqrt(4.0 * np.pi / self.n) * 1.1)
        random = np.random.default_rng(1)
        self.noise = random.normal(size=self.n)
        self.smooth = np.sin(3.0 * x) + y * z
        self.steps = (x > 0.1) * 1.0 + (z > 0.3)
        self.noisy = self.smooth + 0.2 * self.noise
        self.noisy_steps = self.steps + 0.2 * self.noise
        self.blurred = sd.heat(self.surface, self.steps, fwhm=4 * self.h) + 0.02 * self.noise
        self.colours = np.clip(self.steps[:, None] * [0.3, 0.5, 0.2] + 0.1 * random.normal(size=(self.n, 3)), 0, 1)
        self.hole = np.where(np.hypot(x, y) + (z < 0.0) < 0.5, np.nan, self.steps)
        self.few = np.full(self.n, np.nan)
        self.few[random.choice(self.n, 500, replace=False)] = 1.0
        self.few *= self.smooth
        self.vectors = np.column_stack([y, -x, 0.3 * z]) + 0.2 * random.normal(size=(self.n, 3))
        self.noisy_points = self.points + 0.2 * self.h * random.normal(size=(self.n, 3))
        self.labels = random.permutation(self.n)


FUNCTIONS = {
    "heat": lambda i: sd.heat(i.surface, i.smooth, fwhm=6 * i.h),
    "surrogates of one map, 10": lambda i: sd.surrogates(i.surface, i.noisy, 10),
    "deblurring, heat": lambda i: sd.heat(i.surface, i.blurred, blur_fwhm=4 * i.h, mode="SteadyState",
                                          automatic_fidelity=True),
    "deblurring, TV": lambda i: sd.intrinsic_tv(i.surface, i.blurred, blur_fwhm=4 * i.h, mode="SteadyState"),
    "TV, inpainting a disk": lambda i: sd.intrinsic_tv(i.surface, i.hole, mode="SteadyState"),
    "8 regions": lambda i: sd.segment(i.surface, i.noisy, number_of_regions=8),
    "2 regions": lambda i: sd.segment(i.surface, i.noisy_steps),
    "100 random fields": lambda i: sd.random_field(i.surface, 100, fwhm=10 * i.h),
    "one random field": lambda i: sd.random_field(i.surface, 1, fwhm=10 * i.h),
    "spline through all values": lambda i: sd.interpolate(i.surface, i.noisy),
    "direction field, Smooth": lambda i: sd.direction_field(i.surface, method="Smooth"),
    "coherence-enhancing diffusion": lambda i: sd.tensor_diffusion(i.surface, i.noisy, model="CoherenceEnhancing"),
    "mesh denoising": lambda i: sd.denoise_mesh((i.noisy_points, i.surface.faces)),
    "spectrum, 5 wavelengths": lambda i: sd.spectrum(i.surface, i.noisy, i.h * np.array([4, 8, 16, 32, 64])),
    "TV, steady, automatic weight": lambda i: sd.intrinsic_tv(i.surface, i.noisy_steps, mode="SteadyState",
                                                              automatic_fidelity=True),
    "TV, steady, L1": lambda i: sd.intrinsic_tv(i.surface, i.noisy_steps, mode="SteadyState", fidelity_norm="L1"),
    "TV, steady, colours": lambda i: sd.intrinsic_tv(i.surface, i.colours, mode="SteadyState"),
    "TV, ten steps": lambda i: sd.intrinsic_tv(i.surface, i.noisy_steps),
    "50 eigenmodes": lambda i: sd.eigenmodes(i.surface, 50),
    "relief": lambda i: sd.relief(i.surface, i.smooth, 3 * i.h),
    "few values, 500": lambda i: sd.interpolate(i.surface, i.few),
    "smooth to a width, 10 columns": lambda i: sd.smooth_to_fwhm(
        i.surface, np.random.default_rng(2).normal(size=(i.n, 10)), 6 * i.h),
    "refine to .6 h": lambda i: sd.refine(i.surface, 0.6 * i.h),
    "heat, automatic weight": lambda i: sd.heat(i.surface, i.noisy, automatic_fidelity=True, mode="SteadyState"),
    "heat of 60 h": lambda i: sd.heat(i.surface, i.smooth, fwhm=60 * i.h),
    "curvature at a scale": lambda i: sd.curvature(i.surface, fwhm=6 * i.h),
    "curvature": lambda i: sd.curvature(i.surface),
    "scale filter of order 2": lambda i: sd.scale_filter(i.surface, i.noisy, 12 * i.h, order=2),
    "distance of all points": lambda i: sd.distance(i.surface, i.labels),
    "distance": lambda i: sd.distance(i.surface, [0]),
    "edges": lambda i: sd.mumford_shah(i.surface, i.noisy_steps),
    "harmonic map": lambda i: sd.harmonic_map(i.surface, i.vectors),
    "texture": lambda i: sd.turing_texture(i.surface, number_of_time_steps=40),
    "gradient": lambda i: sd.gradient(i.surface, i.smooth),
    "Helmholtz parts": lambda i: sd.helmholtz(i.surface, i.vectors),
    "estimate of the width": lambda i: sd.estimate_fwhm(i.surface, np.random.default_rng(2).normal(size=(i.n, 10))),
}


def processor_time(call):
    start = time.process_time()
    call()
    return time.process_time() - start


def fresh(inputs):
    """The surface without what earlier calls have kept of it."""
    inputs.surface = sd.Surface(inputs.surface.points, inputs.surface.faces)
    return inputs


def measure(name, subdivisions, repeat):
    """Microseconds a vertex, heats and kB a vertex of one function in this process."""
    inputs = Inputs(subdivisions)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    found, heats = [], []
    for _ in range(repeat):
        found.append(processor_time(lambda: FUNCTIONS[name](fresh(inputs))))
        after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        heats.append(min(processor_time(lambda: FUNCTIONS["heat"](fresh(inputs))) for _ in range(3)))
    return {"us": 1e6 * min(found) / inputs.n, "heats": min(found) / min(heats), "kB": (after - before) / inputs.n}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[5, 6, 7], help="numbers of subdivisions")
    parser.add_argument("--only", nargs="+", default=list(FUNCTIONS), help="beginnings of names")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    if options.one:
        print(json.dumps(measure(options.only[0], options.sizes[0], options.repeat)))
        return
    print("| function | " + " | ".join(f"{10 * 4**s + 2:,}: heats, kB" for s in options.sizes) + " | growth |")
    print("| --- " * (len(options.sizes) + 2) + "|")
    for name in (n for n in FUNCTIONS if n.startswith(tuple(options.only))):
        rows = []
        for size in options.sizes:
            command = [sys.executable, __file__, "--one", "--only", name, "--sizes", str(size),
                       "--repeat", str(options.repeat)]
            rows.append(json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout))
        cells = " | ".join(f"{row['heats']:.1f}, {row['kB']:.1f}" for row in rows)
        print(f"| {name} | {cells} | {rows[-1]['us'] / rows[0]['us']:.1f} |", flush=True)


if __name__ == "__main__":
    main()
