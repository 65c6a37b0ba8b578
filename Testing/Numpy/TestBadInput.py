# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Bad input gives one line that names the argument, what was found and what is allowed."""

import re
import sys
import unittest

import numpy as np

import surfacediffusion as sd

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], dtype=float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 4], [1, 4, 3], [2, 3, 4]])
BODY = sd.Surface(POINTS, FACES)
Z = POINTS[:, 2]
NORMALS = np.tile([0.0, 0.0, 1.0], (5, 1))


def points_with(value):
    points = POINTS.copy()
    points[3, 1] = value
    return points


def faces_with(value):
    faces = FACES.tolist()
    faces[3][1] = value
    return faces


def values_with(value):
    values = Z.copy()
    values[2] = value
    return values


#: What is called, and a pattern of the whole message.
CASES = [
    # surfaces
    (lambda: sd.Surface(POINTS[:, :2], FACES), r"points has shape \(5, 2\); allowed: \(n, 3\).*"),
    (lambda: sd.Surface(np.empty((0, 3)), FACES), r"points has shape \(0, 3\); allowed: .*n > 0"),
    (lambda: sd.Surface(POINTS.ravel(), FACES), r"points has shape \(15,\); allowed: \(n, 3\).*"),
    (lambda: sd.Surface("a sphere", FACES), r"points has elements of type <U8; allowed: real.*"),
    (lambda: sd.Surface([[0, 0], [1]], FACES), r"points is \[\[0, 0\], \[1\]\]; allowed: an array.*"),
    (lambda: sd.Surface(points_with(np.nan), FACES),
     r"point 3 of the input has coordinates that are not finite; allowed: .* \(remove these, as .*\)"),
    (lambda: sd.Surface(points_with(np.inf), FACES), r"point 3 of the input has coordinates that .*"),
    (lambda: sd.Surface(np.vstack([POINTS, [3 * [np.nan]]]), FACES),  # a point that no face uses
     r"point 5 of the input .*; allowed: .*, also of points that nothing uses \(remove these, .*\)"),
    (lambda: sd.Surface(POINTS * 1j, FACES), r"points has elements of type complex128; allowed: .*"),
    (lambda: sd.Surface(POINTS, faces_with(5)),
     r"faces has 5 in row 3; allowed: 0 to 4, the rows of points"),
    (lambda: sd.Surface(POINTS, faces_with(-1)), r"faces has -1 in row 3; allowed: 0 to 4, .*"),
    (lambda: sd.Surface(POINTS, np.array(faces_with(2**40))), r"faces has 1099511627776 in row 3; .*"),
    (lambda: sd.Surface(POINTS, FACES + 0.5), r"faces has 0.5 in row 0; allowed: integers, and NaN.*"),
    (lambda: sd.Surface(POINTS, FACES > 0), r"faces has elements of type bool; allowed: int.*"),
    (lambda: sd.Surface(POINTS, FACES, start_index=2), r"start_index is 2; allowed: 0, 1 or None"),
    (lambda: sd.Surface(POINTS, FACES, start_index=1), r"faces has 0 in row 0; allowed: 1 to 5, the rows.*"),
    (lambda: sd.Surface(POINTS, FACES + 1, start_index=0), r"faces has 5 in row \d; allowed: 0 to 4, the rows.*"),
    (lambda: sd.Surface(POINTS, FACES, fill_value=1.5), r"fill_value is 1.5; allowed: an integer.*"),
    (lambda: sd.Surface(POINTS, FACES, fill_value=4), r"faces has padding in row 3 .*; allowed: at the ends.*"),
    (lambda: sd.Surface(POINTS, [[0, 1, 2, -1], [0, 2, 3, 1]]), r"faces has -1 in row 0; allowed: 0 to 4, .*"),
    (lambda: sd.Surface(POINTS, np.array([[0, 1, 2, -1], [0, 2, -2, -2]])), r"faces has -1 in row 0; .*"),
    (lambda: sd.Surface(POINTS, np.array([[0, -1, 2, 3], [0, 2, 3, 1]])), r"faces has -1 in row 0; .*"),
    (lambda: sd.Surface(POINTS, np.array([[0, 1, 2, 3], [0, 2, 3, 7]])), r"faces has 7 in row 1; .*"),
    (lambda: sd.Surface(POINTS, np.array([[0, 1, 2, 3], [0, 2, np.nan, np.nan]])),
     r"faces has padding in row 1 before a point, or for all but 2; allowed: at the ends of rows, .*"),
    (lambda: sd.Surface.from_lonlat([0, 1, 2], [0, 91, 0], [[0, 1, 2]]),
     r"lat has 91.0 at point 1; allowed: -90 to 90, in degrees"),
    (lambda: sd.Surface.from_lonlat([0, 1, 2], [0, 9, 0], [[0, 1, 2]], degrees=False),
     r"lat has 9.0 at point 1; allowed: -1.5708 to 1.5708, in radians"),
    (lambda: sd.Surface.from_lonlat([0, np.inf, 2], [0, 9, 0], [[0, 1, 2]]),
     r"lon has inf at point 1; allowed: finite numbers"),
    (lambda: sd.Surface.from_lonlat([0, 1, 2], [0, 9], [[0, 1, 2]]), r"lat has shape \(2,\); allowed: \(3,\), .*"),
    (lambda: sd.Surface.from_lonlat([0, 1, 2], [0, 9, 0], [[0, 1, 2]], radius=0), r"radius is 0; allowed: .*"),
    (lambda: sd.Surface(POINTS, FACES[:, :2]), r"faces has shape \(6, 2\); allowed: .*"),
    (lambda: sd.Surface(POINTS, FACES.ravel()), r"faces has shape \(18,\); allowed: .*"),
    (lambda: sd.Surface(POINTS, []), r"faces is empty; allowed: .*"),
    (lambda: sd.Surface(POINTS, [[0, 1, 2], [0, 1]]), r"faces has \[0, 1\] in row 1; allowed: three.*"),
    (lambda: sd.Surface(POINTS, 7), r"faces is 7; allowed: .*"),
    (lambda: sd.Surface(POINTS, np.ma.masked_less(FACES, 1)), r"faces has padding in row .*; allowed: at the ends.*"),
    (lambda: sd.interpolate(BODY, Z, exact=True, smoothing=5.0),
     r"smoothing is 5.0, but exact is True, which takes its place; allowed: one of them"),
    (lambda: sd.Surface(POINTS, [["a", "b", "c"]]), r"faces has elements of type <U1; allowed: .*"),
    (lambda: sd.heat(POINTS, Z), r"surface is array\(.*; allowed: a Surface, a tuple.*"),
    (lambda: sd.heat(None, Z), r"surface is None; allowed: a Surface, a tuple.*"),
    (lambda: sd.heat((POINTS, FACES, FACES), Z), r"surface is .*; allowed: a Surface, .*"),
    (lambda: sd.sphere(-1), r"subdivisions is -1; allowed: 0 to 9"),
    (lambda: sd.sphere(1, radius=0), r"radius is 0; allowed: finite numbers above 0"),
    # data
    (lambda: sd.heat(BODY, Z[:4]), r"values has shape \(4,\); allowed: \(5,\) or \(5, k\), .*"),
    (lambda: sd.heat(BODY, np.zeros((3, 5))), r"values has shape \(3, 5\); allowed: .*"),
    (lambda: sd.heat(BODY, np.zeros((5, 2, 2))), r"values has shape \(5, 2, 2\); allowed: .*"),
    (lambda: sd.heat(BODY, np.zeros((5, 0))), r"values has shape \(5, 0\); allowed: .*"),
    (lambda: sd.heat(BODY, 3.0), r"values has shape \(\); allowed: .*"),
    (lambda: sd.heat(BODY, Z * 1j), r"values has elements of type complex128; allowed: real.*"),
    (lambda: sd.heat(BODY, ["a"] * 5), r"values has elements of type <U1; allowed: real numbers"),
    (lambda: sd.heat(BODY, [None] * 5), r"values has elements of type object; allowed: real.*"),
    (lambda: sd.heat(BODY, [[1], [2, 3]]), r"values is \[\[1\], \[2, 3\]\]; allowed: an array.*"),
    (lambda: sd.heat(BODY, values_with(np.inf), time_step=1),
     r"values is infinite at point 2; allowed: finite values and NaN"),
    (lambda: sd.heat(BODY, values_with(1e308) * [1, 1, 1, -1e308, 1], time_step=1), r".*values.*"),
    (lambda: sd.heat(BODY, Z, mask=[1, 0]), r"mask has shape \(2,\); allowed: \(5,\), one flag.*"),
    (lambda: sd.heat(BODY, Z, mask=np.zeros((5, 1))), r"mask has shape \(5, 1\); allowed: .*"),
    (lambda: sd.heat(BODY, Z, fixed="yes"), r"fixed has elements of type <U3; allowed: real.*"),
    (lambda: sd.heat(BODY, values_with(np.nan), fixed=np.ones(5), time_step=1),
     r"values is NaN where fixed holds it at point 2; allowed there: finite values"),
    (lambda: sd.heat(BODY, Z, directions=np.zeros((4, 3))),
     r"directions has shape \(4, 3\); allowed: \(5, 3\), one row per point, or \(6, 3\), .*"),
    (lambda: sd.heat(BODY, Z, directions=np.full((6, 3), np.inf), time_step=1),
     r"directions is infinite at face 0; allowed: finite values and NaN"),
    (lambda: sd.heat((POINTS, FACES[:5]), Z, directions=np.zeros((5, 3))),
     r"directions has one row per point and per face, of which there are 5 each; allowed: .*"),
    (lambda: sd.harmonic_map(BODY, Z), r"vectors has 1 components; allowed: 2 or more, alpha .*"),
    (lambda: sd.harmonic_map(BODY, Z[:, None]), r"vectors has 1 components; allowed: 2 or more, .*"),
    (lambda: sd.harmonic_map(BODY, NORMALS[:, :2], move_vertices=True),
     r"vectors has 2 components; allowed: 3 with move_vertices"),
    (lambda: sd.harmonic_map(BODY, 0 * NORMALS, fixed=np.ones(5)),
     r"vectors has a vector of length zero where fixed holds it; .*"),
    (lambda: sd.turing_texture(BODY, np.ones((5, 3))), r"initial has shape \(5, 3\); allowed: .*"),
    (lambda: sd.turing_texture(BODY, fixed=np.ones(5)), r"fixed is set but initial.*; allowed: .*"),
    (lambda: sd.turing_texture(BODY, rates=np.ones((5, 4))), r"rates has shape \(5, 4\); allowed: .*"),
    (lambda: sd.turing_texture(BODY, rates=-np.ones((6, 4))), r"rates is -1 at face 0; allowed: .*"),
    (lambda: sd.turing_texture(BODY, low_color=(0, 2, 0)), r"low_color is 2; allowed: numbers from 0 to 1"),
    (lambda: sd.turing_texture(BODY, high_color="red"), r"high_color is 'red'; allowed: finite numbers"),
    (lambda: sd.turing_texture(BODY, high_color=(1, 0)), r"the number of entries of high_color is 2; allowed: 3"),
    (lambda: sd.direction_field(BODY, np.ones((6, 3))),
     r'hints is given but method is PrincipalCurvature; allowed: method="Hints", or no hints'),
    (lambda: sd.direction_field(BODY, method="Hints"), r"method is Hints but hints is not set; .*"),
    (lambda: sd.direction_field(BODY, np.ones(3), method="Hints"), r"hints has shape \(3,\); .*"),
    (lambda: sd.denoise_mesh(BODY, fixed=[1, 0]), r"fixed has shape \(2,\); allowed: \(5,\), one.*"),
    (lambda: sd.denoise_mesh(BODY, full_output=1), r"full_output is 1; allowed: True or False"),
    # settings
    (lambda: sd.denoise_mesh(BODY, surface_type="Metal"),
     r"surface_type is 'Metal'; allowed: Automatic, CAD, Organic, or in snake_case"),
    (lambda: sd.heat(BODY, Z, fwhm=-1), r"fwhm is -1; allowed: finite numbers, 0 or more"),
    (lambda: sd.heat(BODY, Z, fwhm="10 mm"), r"fwhm is '10 mm'; allowed: finite numbers, 0 or more"),
    (lambda: sd.heat(BODY, Z, fwhm=None), r"fwhm is None; allowed: finite numbers, 0 or more"),
    (lambda: sd.heat(BODY, Z, fwhm=True), r"fwhm is True; allowed: finite numbers, 0 or more"),
    (lambda: sd.heat(BODY, Z, fwhm=np.ones(2)), r"fwhm is array\(\[1., 1.\]\); allowed: .*"),
    (lambda: sd.heat(BODY, Z, fwhm=float("nan")), r"fwhm is nan; allowed: finite numbers, .*"),
    (lambda: sd.heat(BODY, Z, time_step=0), r"time_step is 0; allowed: finite numbers above 0"),
    (lambda: sd.heat(BODY, Z, number_of_time_steps=2.5, time_step=1),
     r"number_of_time_steps is 2.5; allowed: 0 to 1000000000"),
    (lambda: sd.heat(BODY, Z, number_of_time_steps=10**12, time_step=1),
     r"number_of_time_steps is 1000000000000; allowed: 0 to 1000000000"),
    (lambda: sd.heat(BODY, Z, seed=2**31), r"seed is 2147483648; allowed: integers of 32 bits"),
    (lambda: sd.heat(BODY, Z, mode="Steady"), r"mode is 'Steady'; allowed: TimeSteps, SteadyState, or in snake_case"),
    (lambda: sd.heat(BODY, Z, mode=1), r"mode is 1; allowed: TimeSteps, SteadyState, or in snake_case"),
    (lambda: sd.heat(BODY, Z, time_integrator="Implicit", time_step=1),
     r"time_integrator is 'Implicit'; allowed: FirstOrder, SecondOrder, Exponential, Automatic, or in snake_case"),
    (lambda: sd.heat(BODY, Z, intrinsic_delaunay=1, time_step=1),
     r"intrinsic_delaunay is 1; allowed: True or False"),
    (lambda: sd.heat(BODY, Z, fwhm=1, time_step=2),
     r"time_step is 2, but fwhm is 1, which takes its place; allowed: one of them"),
    (lambda: sd.heat(BODY, Z, mode="steady_state", fidelity_weight=1, time_step=2),
     r"time_step is 2, but mode is 'steady_state', which takes its place; allowed: one of them"),
    (lambda: sd.heat(BODY, Z, mode="steady_state", automatic_fidelity=True, fidelity_weight=2),
     r"fidelity_weight is 2, but automatic_fidelity is True, which takes its place; allowed: one of them"),
    (lambda: sd.turing_texture(BODY, time_step=1, automatic_time_step=True),
     r"time_step is 1, but automatic_time_step is True, which takes its place; allowed: one of them"),
    (lambda: sd.heat(BODY, Z, fwhm=1, mode="SteadyState"),
     r"mode is SteadyState; allowed: TimeSteps together with fwhm: a steady state has no width"),
    (lambda: sd.intrinsic_tv(BODY, Z, mode="SteadyState", edge_function="PeronaMalikRational"),
     r"edge_function is PeronaMalikRational; allowed: TotalVariation, .* together with mode Steady.*"),
    (lambda: sd.tensor_diffusion(BODY, Z, diffusion_axes=True, intrinsic_delaunay=True),
     r"diffusion_axes is True; allowed: False together with intrinsic_delaunay, whose triangles are "
     r"not those of the faces"),
    (lambda: sd.intrinsic_tv(BODY, Z, across_edge_function="Constant"),
     r"across_edge_function is Constant but directions is not set; allowed: Same, or an array of.*"),
    (lambda: sd.segment(BODY, Z, means=[1.0]),
     r"the number of means is 1; allowed: 2, one per region and component of values, or any with "
     r"automatic_means True"),
    (lambda: sd.segment(BODY, Z, means="a"), r"means is 'a'; .*"),
    (lambda: sd.segment(BODY, Z, seeds=np.full(5, 0.5)), r"seeds is 0.5 .*"),
    (lambda: sd.segment(BODY, Z, terms=np.zeros((5, 2))), r"values and terms are both .*"),
    (lambda: sd.segment(BODY, terms=np.zeros((5, 3))), r".*number of components is 3; .*"),
    (lambda: sd.segment(BODY, Z, seeds=[5, 0, 0, 0, 1]),
     r"seeds has the label 5; allowed: 0 to number_of_regions 2"),
    (lambda: sd.turing_texture(BODY, kinetics="Turing", growth_rate=1.0, decay_rate=12.0),
     r"kinetics is Turing, which has no steady state .*; allowed: others \(for Turing growth_rate "
     r"above decay_rate\), or an initial state as initial"),
    (lambda: sd.heat(sd.sphere(2), sd.sphere(2).points[:, 2], fwhm=1, tolerance=1e-14,
                     maximum_number_of_iterations=1, solver="conjugate_gradient"),
     r"the linear solver stopped after 1 iterations at .*; allow a larger tolerance or "
     r"maximum_number_of_iterations, or set solver to Direct"),
    (lambda: sd.turing_texture(BODY, kinetics="Gray"), r"kinetics is 'Gray'; allowed: Turing, .*"),
    (lambda: sd.heat(BODY, Z), r"heat\(\) has no width; allowed: one of fwhm .*, "
                               r"time_step and mode"),
    (lambda: sd.heat(BODY, Z, fwhm=0), r"heat\(\) has no width; allowed: .*"),
    (lambda: sd.heat_steps(BODY, Z, number_of_time_steps=3), r"heat\(\) has no width; .*"),
    (lambda: sd.heat(BODY, Z, fwhm=1, mask=Z, roi=Z), r"mask and roi are both given; allowed: one .*"),
    (lambda: sd.heat(BODY, Z, fwhm=1, roi=Z, mask_mode="Inpaint"),
     r"mask_mode is 'Inpaint' with roi; allowed with roi: Exclude"),
    (lambda: sd.heat(BODY, Z, fwhm=1, roi=[1, 0]),
     r"roi has shape \(2,\); allowed: \(5,\) or \(6,\), one flag per point or face"),
    (lambda: sd.heat(BODY, Z, fwhm=1, roi=np.zeros(5)), r"roi is 0 everywhere; allowed: nonzero .*"),
    (lambda: sd.estimate_fwhm(BODY, Z, mask=Z, roi=Z), r"mask and roi are both given; allowed: one .*"),
    (lambda: sd.heat(BODY, Z, dtype=int), r"dtype is <class 'int'>; allowed: None, float32 or float64"),
    (lambda: sd.heat(BODY, Z, dtype="none"), r"dtype is 'none'; allowed: None, float32 or float64"),
    (lambda: sd.heat(BODY, Z, steps="yes", time_step=1), r"steps is 'yes'; allowed: True or False"),
    (lambda: sd.heat(BODY, Z, full_output=2, time_step=1), r"full_output is 2; allowed: True or False"),
    (lambda: sd.heat(BODY, Z, progress=3, time_step=1),
     r"progress is 3; allowed: True, False or a callable.*"),
    (lambda: sd.heat(BODY, values_with(1e39), dtype=np.float32, number_of_time_steps=0, time_step=1),
     r"the result has values that are larger than a float can hold; set dtype to float64"),
    # smoothness
    (lambda: sd.estimate_fwhm(BODY, Z[:3]), r"residuals has shape \(3,\); allowed: .*"),
    (lambda: sd.estimate_fwhm(BODY, np.full(5, np.nan)),
     r"residuals has no known value in column 0; allowed: .*"),
    (lambda: sd.estimate_fwhm(BODY, Z, demean=2), r"demean is 2; allowed: True or False"),
    (lambda: sd.estimate_fwhm(BODY, Z, mask=[1]), r"mask has shape \(1,\); allowed: .*"),
    (lambda: sd.smooth_to_fwhm(BODY, Z, 0), r"fwhm is 0; allowed: finite numbers above 0"),
    (lambda: sd.smooth_to_fwhm(BODY, Z, "wide"), r"fwhm is 'wide'; allowed: finite numbers above 0"),
    (lambda: sd.smooth_to_fwhm(BODY, Z, 1.0, tolerance=0), r"tolerance is 0; allowed: 0.0001 to 0.1"),
    (lambda: sd.smooth_to_fwhm(sd.sphere(3), sd.sphere(3).points[:, 2], 0.2),
     r"fwhm is 0.2, but the noise has a smoothness of .* already; allowed: larger widths"),
    (lambda: sd.set_number_of_threads(-1), r"number is -1; allowed: 0 to 1024 threads"),
]


class BadInput(unittest.TestCase):
    def test_every_case_gives_one_line_that_names_its_argument(self):
        for number, (call, pattern) in enumerate(CASES):
            with self.subTest(number=number, pattern=pattern):
                with self.assertRaises(ValueError) as caught:
                    call()
                message = str(caught.exception)
                self.assertTrue(re.fullmatch(pattern, message), message)
                self.assertNotIn("\n", message)
                self.assertIsNone(re.search(r"[a-z][A-Z]\w*Array\b", message), message)

    def test_surface_can_be_used_after_errors(self):
        np.testing.assert_array_equal(
            sd.heat(BODY, Z, fwhm=1), sd.heat(sd.Surface(POINTS, FACES), Z, fwhm=1))


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
