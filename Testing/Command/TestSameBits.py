# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The words of the command give the bits of the functions on the same file: an open surface of polygons of
three to five corners, with a point of no face."""

import json
import os
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np
from samples import off_text, run, sphere

import surfacediffusion as sd
from surfacediffusion.command.arguments import COMMANDS
from surfacediffusion.files import read_surface

ONE_STEP = {"time_integrator": "Exponential", "number_of_time_steps": 1}


#: The commands without a row, and what holds them.
ELSEWHERE = {"cifti-smoothing": "TestWorkbenchCifti", "doctor": "TestDoctor", "path": "TestCommand",
             **dict.fromkeys(("metric-estimate-fwhm", "surface-curvature", "metric-dilate", "cifti-dilate",
                              "cifti-estimate-fwhm"), "TestWorkbenchWords")}


def polygons():
    """A sphere of radius 10 with a hole, some of whose triangles are joined to polygons."""
    points, faces = sphere(3)
    fours = faces.reshape(-1, 4, 3)  # that a triangle was cut into: around its corners, and in the middle
    joined = []
    for k, four in enumerate(fours[points[fours].mean(axis=(1, 2))[:, 2] < 8].tolist()):
        (a, ab, ca), (_, b, bc), (_, _, c), _ = four
        joined += (four, [[a, ab, bc, ca], four[1], four[2]], [[a, ab, b, bc, ca], four[2]])[k % 3]
    return np.vstack([points, [[0, 0, 0]]]), joined


def result_of(line):
    """What a command wrote: values, points, or numbers of its report."""
    for path in Path().glob("out.*"):
        path.unlink()
    code, out, error = run(*line.split(), "--json")
    assert code == 0, error
    report = json.loads(out)
    if Path("out.npy").exists():
        return np.load("out.npy")
    if Path("out.off").exists():
        return read_surface("out.off").points
    return np.array(report["spectra"][0]["variance"] if "spectra" in report else
                    [column["fwhm"] for column in report["surfaces"][0]["columns"]] if "surfaces" in report
                    else [report["files"][0]["area"]])


def columns(*arrays):
    return np.column_stack([np.asarray(array) for array in arrays])


class SameBits(unittest.TestCase):
    def test_words_of_the_command_give_the_bits_of_the_functions(self):
        warnings.simplefilter("ignore")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        Path("a.off").write_text(off_text(*polygons()))
        corners = np.array([[2, 1], [1, 1], [1, 3], [0, 3], [0, 0], [2, 0]])
        Path("l.off").write_text(off_text(np.column_stack([corners, np.zeros(6)]), [range(6)]))
        given = read_surface("a.off")
        s = sd.Surface(given.points, given.faces)
        self.assertEqual({len(face) for face in s.faces}, {3, 4, 5})
        x, y, z = s.points.T
        random = np.random.default_rng(3)
        values = columns(np.sign(x) + 0.2 * random.normal(size=len(x)), y + random.normal(size=len(x)))
        outside, sparse = z > 4, np.where(np.arange(len(x)) % 4 == 0, z, np.nan)
        speed = 1 + z**2 / 100
        rough = columns(x, y, z) * (1 + random.normal(scale=0.01, size=(len(x), 1)))
        Path("rough.off").write_text(off_text(rough, given.faces))
        r = sd.Surface(read_surface("rough.off").points, given.faces)
        for name, array in (("v", values), ("roi", 1.0 - outside), ("few", sparse), ("speed", speed),
                            ("vectors", columns(-y, x, z)), ("marks", np.where(x > 8, 4, 7 * (y > 8)))):
            np.save(name + ".npy", array)
        of_faces, inner = random.normal(size=s.n_faces), np.arange(s.n_faces) < s.n_faces // 2
        np.save("f.npy", of_faces)
        np.save("inner.npy", inner.astype(float))
        np.save("inner-points.npy", 1.0 * (x > 2))
        np.save("filled.npy", np.where(np.isnan(sparse), np.where(x > 0, -9999, 1e20), sparse))
        np.save("b.off.npy", np.where(sphere(2, 30.0)[0] > 0, 1.0, 0.0))
        masked = {"mask": outside, "mask_mode": "Exclude"}
        inside = np.where(outside[:, None], 0, values)
        one, two = values.T
        curved = sd.curvature(s, fwhm=4.0)
        fit = sd.interpolate(s, sparse, compute_error=True)
        np.save("u.npy", fit.values)
        wave = sd.conduction_velocity(s, fit.values, error=fit.slope_error.astype(np.float32))
        texture = dict(feature_size=8.0, seed=1, number_of_time_steps=5, refine_to=0)
        fine = sd.refine(s, 1.5)
        Path("b.off").write_text(off_text(*sphere(2, 30.0)))
        ball = sd.Surface(*sphere(2, 30.0))

        def each(function, *arguments, **keywords):
            return columns(*(function(*arguments[:1], column, *arguments[1:], **keywords)
                             for column in values.T))

        table = [
            ("smooth a.off v.npy 5 out.npy", sd.heat(s, values, fwhm=5, **ONE_STEP)),
            ("metric-smoothing a.off v.npy 5 out.npy -fwhm", sd.heat(s, values, fwhm=5, **ONE_STEP)),
            ("smooth a.off v.npy 5 out.npy --roi roi.npy --steps 3", np.where(
                outside[:, None], 0, sd.heat(s, inside, fwhm=5, number_of_time_steps=3,
                                             time_integrator="Exponential", **masked))),
            ("denoise a.off v.npy out.npy --weight 3",
             each(sd.intrinsic_tv, s, mode="SteadyState", fidelity_weight=3)),
            ("inpaint a.off few.npy out.npy", sd.heat(s, sparse, mode="SteadyState", hold_known_values=True)),
            ("inpaint a.off few.npy out.npy --intrinsic-delaunay",
             sd.heat(s, sparse, mode="SteadyState", hold_known_values=True, intrinsic_delaunay=True)),
            ("inpaint a.off few.npy out.npy --model tv",
             sd.intrinsic_tv(s, sparse, mode="SteadyState", hold_known_values=True)),
            ("interpolate a.off few.npy out.npy --smoothing 0.01", sd.interpolate(s, sparse, smoothing=0.01)),
            ("interpolate a.off filled.npy out.npy --missing-value -9999 --missing-value 1e20",
             sd.interpolate(s, sparse)),
            ("enhance a.off v.npy out.npy --model lines --time 4 --steps 4",
             each(sd.tensor_diffusion, s, model="CoherenceEnhancing", time_step=1.0, number_of_time_steps=4)),
            ("edges a.off v.npy out.npy --threshold 1 --length 4",
             each(sd.mumford_shah, s, edge_threshold=1, smoothing_length=4)),
            ("segment a.off v.npy out.npy --column 1 --means 1 -1 --weight 10",
             sd.segment(s, one, number_of_regions=2, means=[1, -1], fidelity_weight=10)),
            ("texture a.off 8 out.npy --seed 1 --steps 5", sd.turing_texture(s, **texture).texture),
            ("directions a.off out.npy --method Smooth", sd.direction_field(s, method="Smooth")),
            ("curvature a.off out.npy --fwhm 4", columns(
                curved.mean, curved.gaussian, curved.principal, curved.shape_index, curved.curvedness)),
            ("derivatives a.off v.npy out.npy --fwhm 3", sd.gradient(s, values, smoothing_fwhm=3)),
            ("derivatives a.off vectors.npy out.npy --quantity curl", sd.curl(s, columns(-y, x, z))),
            ("derivatives a.off v.npy out.npy --quantity velocity --fwhm 3",
             columns(*sd.conduction_velocity(s, values, smoothing_fwhm=3))),
            ("interpolate a.off few.npy out.npy --slope-error slopes.npy", sd.interpolate(s, sparse)),
            ("derivatives a.off u.npy out.npy --quantity velocity --error slopes.npy",
             columns(*wave, wave.speed_lower, wave.speed_upper)),
            ("distance a.off out.npy --from 5 --from 9 --speed speed.npy",
             sd.distance(s, [5, 9], speed=speed)),
            *((f"distance a.off marks.npy out.npy --method {method}",
               sd.distance(s, np.flatnonzero(np.load("marks.npy")), method=method))
              for method in ("exact", "eikonal", "heat")),
            ("distance b.off b.off.npy out.npy --signed", columns(
                *[sd.distance(ball, ball.points[:, k] > 0, signed=True) for k in range(3)])),
            ("distance a.off inner-points.npy out.npy --signed --method eikonal",
             sd.distance(s, x > 2, signed=True, method="eikonal")),
            ("normals a.off out.npy --time-step 2", sd.harmonic_map(s, time_step=2, exponent=1.0)),
            ("random-field a.off out.npy --fwhm 6 --count 3 --seed 5", sd.random_field(s, 3, fwhm=6, seed=5)),
            ("random-field a.off out.npy --range 9 --nu 3", sd.random_field(s, range=9, nu=3)),
            ("surrogates a.off v.npy out.npy --column 2 --count 4", sd.surrogates(s, two, 4).values),
            ("scale-filter a.off v.npy 12 out.npy --order 2", sd.scale_filter(s, values, 12, order=2)),
            ("resample a.off b.off v.npy out.npy --roi roi.npy", np.nan_to_num(
                sd.resample(s, ball, values, mask=outside))),
            ("resample b.off a.off b.off.npy out.npy --method Barycentric --labels",
             sd.resample(ball, s, ball.points > 0, method="Barycentric")),
            ("metric-resample v.npy a.off b.off ADAP_BARY_AREA out.npy -area-surfs a.off b.off",
             sd.resample(s, ball, values)),
            ("metric-gradient a.off v.npy out.npy", np.linalg.norm(
                sd.gradient(s, values).reshape(len(x), -1, 3), axis=2)),
            ("surface-geodesic-distance a.off 5 out.npy", np.where(
                np.isfinite(sd.distance(s, [5])), sd.distance(s, [5]), -1.0)),
            ("surface-vertex-areas a.off out.npy", s.vertex_areas),
            ("random-field a.off out.npy --range 9 --nu 1.5", sd.random_field(s, range=9, nu=1.5)),
            ("scale-filter a.off f.npy 12 out.npy --order 2 --faces", sd.scale_filter(s, of_faces, 12, order=2)),
            ("scale-filter a.off f.npy 12 out.npy --faces --roi inner.npy",
             np.nan_to_num(sd.scale_filter(s, of_faces, 12, roi=inner))),
            ("spectrum a.off f.npy 8 16 --faces", sd.spectrum(s, of_faces, [8, 16]).variance),
            ("refine a.off 1.5 fine.off --data v.npy out.npy", fine.at_points(values)),
            ("denoise-mesh rough.off out.off --noise 0.1", sd.denoise_mesh(r, noise_level=0.1).points),
            ("spectrum a.off v.npy 8 16 --column 2", sd.spectrum(s, two, [8, 16]).variance),
            ("fwhm a.off v.npy", sd.estimate_fwhm(s, values).columns),
            ("info a.off", [s.area]),
            ("info l.off", [4.0]),  # of a polygon that is not convex
        ]
        self.assertEqual({line.split()[0] for line, _ in table} | set(ELSEWHERE),
                         {add.__name__[4:].replace("_", "-") for add in COMMANDS})
        for line, expected in table:
            with self.subTest(line):
                found = result_of(line)
                expected = np.asarray(expected).reshape(found.shape)
                expected = np.where(np.isinf(expected), np.nan, expected)
                np.testing.assert_array_equal(found, expected.astype(found.dtype))


if __name__ == "__main__":
    unittest.main()
