# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The functions on arrays: values, units, keywords, results, interruption, threads."""

import copy
import multiprocessing
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings

import numpy as np

import surfacediffusion as sd


class Heat(unittest.TestCase):
    def test_many_columns_have_the_bits_of_a_run_of_all_of_them(self):
        # Many columns are solved in panels, which share their missing points; states have all of them.
        surface = sd.sphere(3)
        random = np.random.default_rng(1)
        noise = random.normal(size=(surface.n_points, 150)).astype(np.float32)
        noise[random.random(surface.n_points) < 0.1, 149] = np.nan
        mask = random.random(surface.n_points) < 0.1
        for options in ({"fwhm": 0.3}, {"fwhm": 0.3, "mask_mode": "Exclude", "mask": mask},
                        {"fidelity_weight": 1.0, "initial_fill": "Input", "mask": mask, "time_step": 1},
                        {"mode": "SteadyState", "hold_known_values": True},
                        {"initial_fill": "Noise", "time_step": 1},
                        {"automatic_fidelity": True, "mode": "SteadyState"},
                        {"automatic_fidelity": True, "time_step": 1, "number_of_time_steps": 2},
                        {"dtype": np.float64, "fixed": ~mask & False, "time_step": 1}):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                panels = sd.heat(surface, noise, **options)
                whole = sd.heat_steps(surface, noise, **options).last().values
            self.assertEqual(panels.dtype, whole.dtype)
            np.testing.assert_array_equal(panels, whole, str(options))

    def test_many_columns_give_each_warning_and_error_once(self):
        surface = sd.sphere(3)
        noise = np.random.default_rng(1).normal(size=(surface.n_points, 150))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            sd.heat(surface, noise, mask=np.zeros(surface.n_points), time_step=1)
        self.assertEqual(["the mask changes nothing with these settings"],
                         [str(warning.message) for warning in caught])
        noise[7, 140] = np.inf
        with self.assertRaisesRegex(ValueError, "values is infinite at point 7"):
            sd.heat(surface, noise, time_step=1)

    def test_progress_of_many_columns_grows_to_one(self):
        surface = sd.sphere(3)
        fractions = []
        sd.heat(surface, np.ones((surface.n_points, 150)), progress=fractions.append, time_step=1)
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1.0)


class Types(unittest.TestCase):
    def setUp(self):
        self.surface = sd.sphere(3)
        self.values = np.random.default_rng(1).normal(size=self.surface.n_points)

    def test_single_precision_stays_single(self):
        single = self.values.astype(np.float32)
        smooth = sd.heat(self.surface, single, fwhm=0.4)
        self.assertEqual(smooth.dtype, np.float32)
        exact = sd.heat(self.surface, single.astype(np.float64), fwhm=0.4)
        np.testing.assert_array_equal(smooth, exact.astype(np.float32))
        np.testing.assert_array_equal(sd.heat(self.surface, single, fwhm=0.4, dtype=float), exact)

    def test_colours_are_rounded_at_the_end_and_keep_their_alpha(self):
        colours = np.random.default_rng(1).integers(0, 256, (self.surface.n_points, 4), np.uint8)
        smooth = sd.heat(self.surface, colours, fwhm=0.4)
        self.assertEqual(smooth.dtype, np.uint8)
        np.testing.assert_array_equal(smooth[:, 3], colours[:, 3])
        exact = sd.heat(self.surface, colours[:, :3].astype(float), fwhm=0.4)
        np.testing.assert_array_equal(smooth[:, :3], np.floor(exact + 0.5))

    def test_other_types_become_double(self):
        for dtype in (np.int16, np.int64, np.uint32, np.bool_, np.float16, np.longdouble):
            smooth = sd.heat(self.surface, (self.values > 0).astype(dtype), fwhm=0.4)
            self.assertEqual(smooth.dtype, np.float64)
            np.testing.assert_array_equal(
                smooth, sd.heat(self.surface, (self.values > 0).astype(float), fwhm=0.4))

    def test_layout_and_byte_order_do_not_matter(self):
        columns = np.random.default_rng(1).normal(size=(self.surface.n_points, 6))
        expected = sd.heat(self.surface, columns, fwhm=0.4)
        for same in (np.asfortranarray(columns), columns.astype(">f8"),
                     np.repeat(columns, 2, axis=1)[:, ::2], columns.tolist()):
            np.testing.assert_array_equal(sd.heat(self.surface, same, fwhm=0.4), expected)
        self.assertEqual(sd.heat(self.surface, columns.astype(">f4"), fwhm=0.4).dtype, np.float32)

    def test_masked_arrays_are_missing_where_masked(self):
        hole = self.surface.points[:, 0] > 0.8
        masked = np.ma.array(self.values, mask=hole)
        expected = sd.heat(self.surface, np.where(hole, np.nan, self.values), fwhm=0.4)
        np.testing.assert_array_equal(sd.heat(self.surface, masked, fwhm=0.4), expected)

    def test_inputs_are_not_changed(self):
        before = self.values.copy()
        sd.heat(self.surface, self.values, fwhm=0.4)
        sd.intrinsic_tv(self.surface, self.values)
        np.testing.assert_array_equal(self.values, before)


class Surfaces(unittest.TestCase):
    def test_tuple_is_a_surface(self):
        surface = sd.sphere(3)
        z = surface.points[:, 2]
        np.testing.assert_array_equal(
            sd.heat((surface.points, surface.triangles), z, fwhm=0.5), sd.heat(surface, z, fwhm=0.5))

    def test_polygons_are_cut(self):
        points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0], [3, 0, 0], [3, 1, 0]]
        surface = sd.Surface(points, [[0, 1, 2, 3], [1, 4, 2], [4, 5, 6, 2, 1]])
        self.assertEqual((surface.n_faces, len(surface.triangles)), (3, 2 + 1 + 3))
        field = sd.direction_field(surface, method="Smooth")
        self.assertEqual(field.shape, (3, 3))
        self.assertEqual([len(face) for face in surface.faces], [4, 3, 5])
        self.assertAlmostEqual(surface.vertex_areas.sum(), 3.0, places=14)

    def test_faces_of_triangles_are_an_array(self):
        given = sd.sphere(3)
        surface = sd.Surface(given.points, list(given.triangles))
        self.assertEqual(surface.faces.shape, (surface.n_faces, 3))
        np.testing.assert_array_equal(surface.faces, given.triangles)
        with self.assertRaises(ValueError):
            surface.faces[0, 0] = 1
        self.assertEqual(copy.deepcopy(surface).faces.shape, surface.faces.shape)

    def test_vertex_areas_are_those_that_diffusion_keeps_the_integral_with(self):
        surface = sd.sphere(3, radius=7.0)
        spot = np.zeros(surface.n_points)
        spot[5] = 1.0
        smooth = sd.heat(surface, spot, fwhm=4.0)
        areas = surface.vertex_areas
        self.assertAlmostEqual(areas @ smooth, areas[5], places=12)
        given = sd.Surface(surface.points, surface.faces, areas=2 * areas)
        np.testing.assert_array_equal(given.vertex_areas, 2 * areas)

    def test_angles_of_directions_have_the_sense_of_the_whole_surface(self):
        x, y = np.meshgrid(np.arange(9.0), np.arange(7.0))
        points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
        corner = (np.arange(6)[:, None] * 9 + np.arange(8)).ravel()
        faces = np.concatenate([np.column_stack([corner, corner + 1, corner + 10]),
                                np.column_stack([corner, corner + 10, corner + 9])])
        faces[::3] = faces[::3, ::-1]
        hints = np.tile([1.0, 0.0, 0.0], (len(points), 1))
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "32 triangles .* count as turned"):
            found = sd.direction_field((points, faces), hints, method="Hints", angle=30.0)
        expected = np.array([np.cos(np.pi / 6), np.sin(np.pi / 6), 0.0])
        np.testing.assert_allclose(np.abs(np.asarray(found) @ expected), 1.0, atol=1e-9)
        for angle in (0.0, 90.0, -180.0):  # of lines: the sense does not matter
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                sd.direction_field((points, faces), hints, method="Hints", angle=angle)

    def test_later_calls_keep_the_mesh(self):
        # Measured in work, not in time: the second call of a run with the same input does no step.
        surface = sd.sphere(4)
        values = surface.points[:, 2]
        first = sd.heat_steps(surface, values, fwhm=0.5).last()
        again = sd.heat_steps(surface, values, fwhm=0.5).last()
        np.testing.assert_array_equal(first.values, again.values)
        np.testing.assert_array_equal(first.history["Seconds"], again.history["Seconds"])

    def test_array_edited_in_place_is_read_again(self):
        surface = sd.sphere(3)
        values = surface.points[:, 2].copy()
        sd.heat(surface, values, fwhm=0.5)
        values[:10] += 1.0
        np.testing.assert_array_equal(
            sd.heat(surface, values, fwhm=0.5), sd.heat(sd.sphere(3), values, fwhm=0.5))

    def test_copies_and_pickles_are_equal(self):
        surface = sd.sphere(2)
        z = surface.points[:, 2]
        for twin in (copy.deepcopy(surface), pickle.loads(pickle.dumps(surface))):
            np.testing.assert_array_equal(sd.heat(twin, z, fwhm=1), sd.heat(surface, z, fwhm=1))

    def test_points_can_be_changed_after_construction(self):
        points = sd.sphere(2).points.copy()
        surface = sd.Surface(points, sd.sphere(2).triangles)
        points[:] = 0.0
        self.assertEqual(surface.points.max(), sd.sphere(2).points.max())
        with self.assertRaises(ValueError):
            surface.points[0] = 0.0


    def test_surfaces_with_as_many_points_as_faces_have_directions_at_known_places(self):
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
        solid = sd.Surface(points, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
        field = sd.direction_field(solid, method="Smooth")
        hints = np.asarray(field)
        with self.assertRaisesRegex(ValueError, r"allowed: on_points\(hints\) or on_faces\(hints\)"):
            sd.direction_field(solid, hints, method="Hints")
        again = sd.direction_field(solid, field, method="Hints", hint_weight=1e6)
        np.testing.assert_allclose(np.abs(np.sum(again * field, axis=1)), 1, atol=1e-3)
        np.testing.assert_array_equal(
            again, sd.direction_field(solid, sd.on_faces(hints), method="Hints", hint_weight=1e6))
        at_points = sd.direction_field(solid, sd.on_points(hints), method="Hints", hint_weight=1e6)
        self.assertGreater(np.abs(at_points - again).max(), 0.1)
        values = [0.0, 1.0, 5.0, 2.0]
        np.testing.assert_array_equal(
            sd.tensor_diffusion(solid, values, directions=field, time_step=0.1),
            sd.tensor_diffusion(solid, values, directions=sd.on_faces(hints), time_step=0.1))
        np.testing.assert_array_equal(  # data, too
            sd.heat(solid, sd.on_faces(values), time_step=0.1),
            sd.heat(solid, values, on_faces=True, time_step=0.1))
        fine = sd.tensor_diffusion(solid, values, directions=field, refine_to=0.4, time_step=0.1)
        self.assertTrue(np.isfinite(fine).all())

    def test_fields_that_are_zero_on_a_part_say_what_to_do(self):
        square = sd.Surface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
        for method in ("PrincipalCurvature", "CurvatureAligned"):
            with self.assertWarnsRegex(
                    sd.SurfaceDiffusionWarning, "the surface has no direction of curvature: flat, "
                    "equally curved in all directions, or of the size of smoothing_length "
                    ".*set method to Smooth"):
                self.assertFalse(sd.direction_field(square, method=method).any())
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertTrue(sd.direction_field(square, method="Smooth").any())


class Edges(unittest.TestCase):
    def test_curves_and_edges_have_their_shapes_and_types(self):
        surface = sd.sphere(4)
        clean = np.where(surface.points[:, 2] > 0.5, 7.0, 3.0)
        result = sd.mumford_shah(surface, clean[:, None].astype(np.float32))
        self.assertEqual((result.values.shape, result.edges.shape), ((surface.n_points, 1), (surface.n_points,)))
        (curve,) = result.curves
        np.testing.assert_array_equal(curve[0], curve[-1])
        self.assertEqual(curve.dtype, np.float64)  # as coordinates, for any data
        self.assertAlmostEqual(np.linalg.norm(np.diff(curve, axis=0), axis=1).sum() / result.edge_length, 1, places=9)

    def test_a_given_threshold_or_length_switches_the_automatic_ones_off(self):
        surface = sd.sphere(4)
        step = np.sign(surface.points[:, 2])
        found = sd.mumford_shah(surface, step)
        self.assertAlmostEqual(found.effective_edge_threshold, 0.12, delta=0.01)
        self.assertLess(found.estimated_noise_level, 0.01)
        given = sd.mumford_shah(surface, step, edge_threshold=0.4)
        self.assertEqual((given.effective_edge_threshold, given.effective_smoothing_length), (0.4, 8.0))
        given = sd.mumford_shah(surface, step, smoothing_length=5.0)
        self.assertEqual((given.effective_edge_threshold, given.effective_smoothing_length), (0.2, 5.0))
        with self.assertWarnsRegex(UserWarning, "edge_threshold is 0.4 but automatic_threshold"):
            sd.mumford_shah(surface, step, edge_threshold=0.4, automatic_threshold=True)

    def test_curves_are_optional(self):
        surface = sd.sphere(4)
        result = sd.mumford_shah(surface, np.sign(surface.points[:, 2]), edge_curves=False)
        self.assertEqual(result.curves, [])
        self.assertEqual(result.edge_length, 0.0)


class Keywords(unittest.TestCase):
    def test_defaults_are_those_of_the_library(self):
        from surfacediffusion import _core
        import inspect

        for function in (sd.heat, sd.intrinsic_tv, sd.harmonic_map, sd.mumford_shah,
                         sd.turing_texture, sd.direction_field, sd.denoise_mesh):
            parameters = inspect.signature(function).parameters
            known = {entry["name"]: entry for entry in _core.list_settings(function.__name__)}
            self.assertGreater(len(known), 3)
            for name in set(known) - {"GenerateTimeSteps", "CheckpointMemoryLimit"}:
                keyword = sd._settings.snake_case(name)
                self.assertEqual(parameters[keyword].default, known[name]["default"], keyword)
                self.assertIn(f"\n{keyword} : ", function.__doc__)
                text = sd._settings.spell_documentation(
                    function.__name__, known[name]["documentation"], sd._models.ARRAYS)
                self.assertIn(" ".join(text.split()), " ".join(function.__doc__.split()))
                self.assertNotIn("MergeTolerance", function.__doc__)
                self.assertNotIn("MaskArray", function.__doc__)

    def test_every_keyword_takes_its_default(self):
        surface = sd.sphere(2)
        z = surface.points[:, 2]
        for name in ("heat", "intrinsic_tv", "mumford_shah", "turing_texture", "harmonic_map",
                     "direction_field", "denoise_mesh", "curvature", "derivatives"):
            table = sd._settings.settings_of(name)
            defaults = {keyword: setting.default for keyword, setting in table.items()}
            function = getattr(sd, name)
            values = [z] if name in ("heat", "intrinsic_tv", "mumford_shah", "derivatives") else []
            if name == "turing_texture":
                defaults["number_of_time_steps"] = 3
                expected = np.asarray(function(surface, *values, number_of_time_steps=3))
            else:
                needed = {"time_step": 1.0} if name == "heat" else {}
                expected = np.asarray(function(surface, *values, **needed))
            np.testing.assert_array_equal(np.asarray(function(surface, *values, **defaults)),
                                          expected)

    def test_words_may_be_in_snake_case(self):
        surface = sd.sphere(2)
        z = surface.points[:, 2]
        for function in ("heat", "intrinsic_tv", "tensor_diffusion", "mumford_shah", "turing_texture",
                         "harmonic_map", "direction_field", "denoise_mesh", "segment", "derivatives"):
            for setting in sd._settings.settings_of(function).values():
                for word in setting.usable:
                    spelling = sd._settings.snake_case(word)
                    self.assertRegex(spelling, "^[a-z0-9_]+$")
                    self.assertEqual(setting.convert(spelling), setting.convert(word))
        np.testing.assert_array_equal(
            sd.heat(surface, z, mode="steady_state", fidelity_weight=2.0, mask_mode="exclude"),
            sd.heat(surface, z, mode="SteadyState", fidelity_weight=2.0, mask_mode="Exclude"))
        for word in ("steadystate", "STEADY_STATE", "steady state"):
            with self.assertRaisesRegex(ValueError, "TimeSteps, SteadyState, or in snake_case"):
                sd.heat(surface, z, mode=word)

    def test_a_region_of_interest_is_the_opposite_of_a_mask(self):
        surface = sd.sphere(3)
        z = surface.points[:, 2]
        noise = np.random.default_rng(3).normal(size=z.size)
        inside = np.where(z > 0.2, 3.0, 0.0)
        inside[z < -0.9] = np.nan
        outside = ~(inside > 0)
        functions = {
            "heat": {"fwhm": 0.5}, "intrinsic_tv": {"number_of_time_steps": 2},
            "tensor_diffusion": {"number_of_time_steps": 2}, "mumford_shah": {},
            "segment": {"fidelity_weight": 2.0}}
        for name, options in functions.items():
            function = getattr(sd, name)
            found = np.asarray(function(surface, noise, roi=inside, **options))
            np.testing.assert_array_equal(found, np.asarray(function(
                surface, noise, mask=outside, mask_mode="Exclude", **options)), name)
            if name != "segment":
                np.testing.assert_array_equal(found[outside], noise[outside], name)
                self.assertTrue((found[~outside] != noise[~outside]).mean() > 0.9, name)
        for name in ("turing_texture", "harmonic_map"):
            options = {"number_of_time_steps": 2}
            np.testing.assert_array_equal(
                np.asarray(getattr(sd, name)(surface, roi=inside, **options)),
                np.asarray(getattr(sd, name)(surface, mask=outside, mask_mode="Exclude", **options)))
        centres = surface.points[surface.triangles].mean(axis=1)[:, 2]
        np.testing.assert_array_equal(
            sd.heat(surface, centres, fwhm=0.5, roi=centres > 0),
            sd.heat(surface, centres, fwhm=0.5, mask=centres <= 0, mask_mode="Exclude"))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            np.testing.assert_array_equal(sd.heat(surface, noise, fwhm=0.5, roi=np.ones(z.size)),
                                          sd.heat(surface, noise, fwhm=0.5))
        self.assertEqual(sd.estimate_fwhm(surface, noise, roi=inside).pooled,
                         sd.estimate_fwhm(surface, noise, mask=outside).pooled)
        np.testing.assert_array_equal(sd.smooth_to_fwhm(surface, noise, 0.8, roi=z > -0.5),
                                      sd.smooth_to_fwhm(surface, noise, 0.8, mask=z <= -0.5))

    def test_unknown_keyword_is_a_type_error_with_the_nearest(self):
        with self.assertRaisesRegex(TypeError, "'fhwm'; did you mean 'fwhm'"):
            sd.heat(sd.sphere(1), np.zeros(42), fhwm=1)
        for function, keyword in ((sd.heat, "rates"), (sd.turing_texture, "fidelity"),
                                  (sd.turing_texture, "values"), (sd.heat, "name")):
            with self.subTest(keyword), self.assertRaisesRegex(TypeError, f"'{keyword}'"):
                function(sd.sphere(1), np.zeros((42, 2)), **{keyword: np.zeros(42)})

    def test_numbers_of_numpy_are_numbers(self):
        surface = sd.sphere(2)
        z = surface.points[:, 2]
        expected = sd.heat(surface, z, fwhm=1.0, number_of_time_steps=4)
        for fwhm, steps in ((np.float32(1), np.int8(4)), (np.array(1.0), 4.0), (1, np.uint64(4))):
            np.testing.assert_array_equal(
                sd.heat(surface, z, fwhm=fwhm, number_of_time_steps=steps), expected)


class Results(unittest.TestCase):
    def setUp(self):
        self.surface = sd.sphere(3)
        self.values = np.random.default_rng(1).normal(size=self.surface.n_points)

    def test_steps_are_the_states_of_runs_of_that_length(self):
        states = list(sd.heat_steps(self.surface, self.values, time_step=1, number_of_time_steps=5))
        self.assertEqual([state.step for state in states], list(range(6)))
        np.testing.assert_array_equal(states[0].values, self.values)
        for state in states:
            self.assertAlmostEqual(state.time, state.step * 1.0)
        last = sd.heat_steps(self.surface, self.values, number_of_time_steps=5, time_step=1).last()
        np.testing.assert_array_equal(states[-1].values, last.values)
        np.testing.assert_array_equal(states[-1].history["Energy"], last.history["Energy"])

    def test_iterators_do_not_disturb_other_calls(self):
        one = sd.heat_steps(self.surface, self.values, time_step=1)
        two = sd.heat_steps(self.surface, 2 * self.values, time_step=1)
        expected = list(sd.heat_steps(self.surface, self.values, time_step=1))
        for a, b, wanted in zip(one, two, expected):
            sd.heat(self.surface, self.values, fwhm=0.5)
            np.testing.assert_array_equal(a.values, wanted.values)
            np.testing.assert_allclose(b.values, 2 * wanted.values, rtol=0, atol=1e-12)

    def test_the_last_state_is_that_of_the_function_and_ends_the_iteration(self):
        for name, arguments in (
                ("heat", {"fwhm": 0.5}), ("intrinsic_tv", {"mode": "SteadyState"}),
                ("tensor_diffusion", {"number_of_time_steps": 3}), ("mumford_shah", {}),
                ("harmonic_map", {}), ("turing_texture", {"number_of_time_steps": 20})):
            values = {"harmonic_map": None, "turing_texture": None}.get(name, self.values)
            expected = getattr(sd, name)(self.surface, values, **arguments)
            states = getattr(sd, f"{name}_steps")(self.surface, values, **arguments)
            self.assertEqual(next(states).step, 0)
            last = states.last()
            np.testing.assert_array_equal(last, expected, name)
            self.assertGreater(last.step, 0)
            self.assertIs(states.last(), last)
            self.assertEqual(list(states), [])

    def test_each_warning_of_a_run_is_given_once(self):
        tetrahedron = sd.Surface(np.vstack([np.zeros(3), np.eye(3)]),
                                 [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
        noisy = sd.Surface(self.surface.points + 0.05 * self.values[:, None], self.surface.triangles)
        for make in (lambda: sd.turing_texture_steps(tetrahedron),
                     lambda: sd.harmonic_map_steps(noisy, move_vertices=True, time_step=10.0, number_of_time_steps=6)):
            for _ in range(2):  # as often as the function is called
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    states = make()
                    self.assertGreater(len(list(states)), 5)
                    states.last()
                kinds = [re.sub(r"[-+.e0-9]+", "", str(one.message)) for one in caught]
                self.assertGreater(len(kinds), 0)
                self.assertEqual(len(kinds), len(set(kinds)), kinds)

    def test_results_stand_for_their_arrays(self):
        north = self.surface.points[:, 2] > 0
        for result in (sd.heat_steps(self.surface, self.values, fwhm=0.5).last(),
                       sd.curvature(self.surface), sd.denoise_mesh(self.surface)):
            array = np.asarray(result)
            self.assertEqual((result.shape, result.dtype, len(result)),
                             (array.shape, array.dtype, len(array)))
            np.testing.assert_array_equal(result[north], array[north])
            np.testing.assert_array_equal(np.sqrt(np.abs(result)), np.sqrt(np.abs(array)))
            np.testing.assert_array_equal(result - array, 0)
            self.assertEqual(np.mean(result), array.mean())
            np.testing.assert_array_equal(np.concatenate([result, array]), np.concatenate([array, array]))
            np.testing.assert_array_equal(np.stack(arrays=(result, array)), np.stack([array, array]))

    def test_old_switches_warn_and_work(self):
        def old(function, *arguments, **keywords):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                found = function(*arguments, **keywords)
            (warning,) = [w for w in caught if w.category is DeprecationWarning]
            self.assertEqual(warning.filename, __file__)
            return found, str(warning.message)

        last = sd.heat_steps(self.surface, self.values, fwhm=0.5).last()
        found, words = old(sd.heat, self.surface, self.values, fwhm=0.5, full_output=True)
        self.assertEqual(words, "full_output of heat() is deprecated: call heat_steps().last()")
        np.testing.assert_array_equal(found.history["Energy"], last.history["Energy"])
        found, _ = old(sd.heat, self.surface, self.values, fwhm=0.5, full_output=False)
        self.assertIs(type(found), np.ndarray)
        states, words = old(sd.harmonic_map, self.surface, steps=True)
        self.assertEqual(words, "steps of harmonic_map() is deprecated: call harmonic_map_steps()")
        self.assertEqual([state.step for state in states], list(range(4)))
        found, words = old(sd.denoise_mesh, self.surface, full_output=True)
        np.testing.assert_array_equal(found.points, sd.denoise_mesh(self.surface).points)
        found, words = old(sd.derivatives, self.surface, self.values, quantity="ConductionVelocity",
                           full_output=True)
        np.testing.assert_array_equal(found.speed, sd.conduction_velocity(self.surface, self.values).speed)
        with self.assertRaisesRegex(TypeError, "has no keyword 'full_output'"):
            sd.mumford_shah(self.surface, self.values, full_output=True)

    def test_errors_of_iterators_come_at_once(self):
        with self.assertRaisesRegex(ValueError, "time_step is 0"):
            sd.heat_steps(self.surface, self.values, time_step=0)

    def test_result_is_an_array_for_numpy(self):
        result = sd.turing_texture(self.surface, number_of_time_steps=2)
        np.testing.assert_array_equal(np.asarray(result), result.values)
        self.assertEqual(np.asarray(result, dtype=np.float32).dtype, np.float32)

    def test_texture_has_the_colours_asked_for(self):
        result = sd.turing_texture(self.surface, number_of_time_steps=20, color_output=True,
                                   low_color=(1, 0, 0), high_color=(0, 0, 1))
        np.testing.assert_array_equal(result.colors[result.texture == 0][0], [255, 0, 0])
        np.testing.assert_array_equal(result.colors[result.texture == 1][0], [0, 0, 255])

    def test_texture_that_stands_ends_the_iterator(self):
        states = list(sd.turing_texture_steps(self.surface, feature_size=1.0, stop_tolerance=0.1,
                                              number_of_time_steps=5000, output_interval=50))
        self.assertLess(len(states), 20)
        self.assertLess(states[-1].step, 1000)


class Warnings(unittest.TestCase):
    def test_warning_names_the_line_of_the_caller(self):
        sphere = sd.sphere(2)
        surface = sd.Surface(sphere.points, np.vstack([sphere.triangles, [[0, 0, 6]]]))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = sd.heat_steps(surface, np.zeros(162), fwhm=1).last()
        self.assertEqual(len(caught), 1)
        self.assertIs(caught[0].category, sd.SurfaceDiffusionWarning)
        self.assertEqual(caught[0].filename, __file__)
        self.assertEqual(str(caught[0].message), "1 triangles of zero area were left out")
        self.assertEqual(result.warnings, [str(caught[0].message)])

    def test_points_that_no_triangle_uses_are_counted_without_a_warning(self):
        surface = sd.Surface(np.vstack([sd.sphere(2).points, [[5, 5, 5]]]), sd.sphere(2).triangles)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = sd.heat_steps(surface, np.arange(163.0), fwhm=1).last()
        self.assertEqual(result.number_of_unused_points, 1)
        self.assertEqual(result.values[-1], 162.0)

    def test_the_coarser_mesh_of_a_texture_is_reported_without_a_warning(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for size, coarse in ((0, False), (100, True)):
                result = sd.turing_texture(sd.sphere(4), feature_size=0.8, coarse_start_size=size,
                                           number_of_time_steps=4)
                self.assertEqual(0 < result.coarse_start_vertices < 1300, coarse)

    def test_warning_uses_the_words_of_python(self):
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0]])
        surface = sd.Surface(points, [[0, 1, 2], [3, 5, 4]])
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "set merge_coincident_points"):
            sd.heat(surface, np.zeros(6), time_step=1)


class Interruption(unittest.TestCase):
    def long_run(self, **keywords):
        surface = sd.sphere(6)
        noise = np.random.default_rng(1).normal(size=surface.n_points)
        return sd.intrinsic_tv(surface, noise, number_of_time_steps=1000000, **keywords)

    def test_ctrl_c_ends_a_run(self):
        # A shell starts programs in the background with this signal ignored.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            self.long_run()  # all steps would take days
        timer.join()

    def test_surface_can_be_used_after_an_interruption(self):
        surface = sd.sphere(4)
        z = surface.points[:, 2]
        expected = sd.heat(surface, z, fwhm=0.5)

        def stop(_fraction):
            raise RuntimeError("of the callable")

        with self.assertRaisesRegex(RuntimeError, "of the callable"):
            sd.intrinsic_tv(surface, z, number_of_time_steps=1000000, progress=stop)
        np.testing.assert_array_equal(sd.heat(surface, z, fwhm=0.5), expected)
        tv = sd.intrinsic_tv(surface, z)
        np.testing.assert_array_equal(sd.intrinsic_tv(sd.sphere(4), z), tv)

    def test_a_callable_that_uses_the_surface_leaves_the_result_as_it_is(self):
        surface = sd.sphere(4)
        x, z = surface.points[:, 0], surface.points[:, 2]
        many = np.outer(z, np.arange(1.0, 71.0))
        for function, values, keywords, others in (
                (sd.heat, z, {"fwhm": 0.2}, {"fwhm": 1.0}),
                (sd.heat, many, {"fwhm": 0.2}, {"fwhm": 1.0}),
                (sd.intrinsic_tv, z, {"number_of_time_steps": 2}, {"number_of_time_steps": 1}),
                (sd.tensor_diffusion, z, {"number_of_time_steps": 2}, {"number_of_time_steps": 1}),
                (sd.mumford_shah, z, {"number_of_time_steps": 2}, {"number_of_time_steps": 1}),
                (sd.segment, z, {}, {"number_of_regions": 3}),
                (sd.interpolate, z, {"smoothing": 0.1}, {"smoothing": 1.0}),
                (sd.derivatives, z, {}, {"quantity": "Laplacian"})):
            finished = []

            def use(_):
                try:
                    finished.append(function(surface, x, **others))
                except RuntimeError as error:
                    self.assertIn("progress uses the surface", str(error))

            with self.subTest(function=function.__name__, shape=values.shape):
                expected = np.asarray(function(sd.sphere(4), values, **keywords))
                np.testing.assert_array_equal(function(surface, values, progress=use, **keywords), expected)
                self.assertGreater(len(finished), 0)
        finished = []
        fine = sd.refine(surface, 0.05, progress=lambda _: finished.append(sd.refine(surface, 0.04)))
        self.assertLess(fine.surface.n_points, finished[-1].surface.n_points)

    def test_progress_grows_to_one(self):
        seen = []
        surface = sd.sphere(5)
        sd.intrinsic_tv(surface, surface.points[:, 2], progress=seen.append)
        self.assertEqual(seen, sorted(seen))
        self.assertEqual(seen[-1], 1.0)
        seen.clear()
        for _ in sd.heat_steps(surface, surface.points[:, 2], progress=seen.append, time_step=1):
            pass
        self.assertEqual(seen, sorted(seen))
        self.assertEqual((len(seen) >= 11, seen[-1]), (True, 1.0))

    def test_other_threads_of_python_run_meanwhile(self):
        counts = []

        def count_and_stop(_fraction):
            counts.append(counter[0])
            if len(counts) > 3:
                raise StopIteration

        counter, ended = [0], threading.Event()

        def count():
            while not ended.is_set():
                counter[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        try:
            with self.assertRaises(StopIteration):
                self.long_run(progress=count_and_stop)
        finally:
            ended.set()
            thread.join()
        self.assertGreater(counts[-1], counts[0] + 3)


def smooth_in_child(surface, values, queue):
    queue.put(sd.heat(surface, values, fwhm=0.5))


class Threads(unittest.TestCase):
    def test_bits_do_not_depend_on_the_number_of_threads(self):
        surface = sd.sphere(6)  # 40962 points: more blocks than one thread takes
        values = np.random.default_rng(1).normal(size=(surface.n_points, 2))
        points, faces = surface.points, surface.triangles
        before = sd.get_number_of_threads()
        results = []
        try:
            for number in (1, 2, 5):
                sd.set_number_of_threads(number)
                self.assertEqual(sd.get_number_of_threads(), number)
                fresh = sd.Surface(points, faces)
                results.append(sd.heat(fresh, values, fwhm=0.05, solver="ConjugateGradient"))
        finally:
            sd.set_number_of_threads(before)
        for other in results[1:]:
            np.testing.assert_array_equal(other, results[0])

    def test_the_environment_gives_the_number_at_first(self):
        program = ("import surfacediffusion as s; n = s.get_number_of_threads(); "
                   "s.set_number_of_threads(0); print(n, s.get_number_of_threads())")
        processors = len(os.sched_getaffinity(0))
        for own, openmp, expected, warning in (
                ("3", "5", 3, ""), ("", "5", 5, ""), (None, "4,2", 4, ""), (None, None, processors, ""),
                ("0", "5", 5, "SURFACEDIFFUSION_NUM_THREADS is '0'; allowed: 1 to 1024 threads"),
                ("many", None, processors, "SURFACEDIFFUSION_NUM_THREADS is 'many'; allowed: "),
                (None, "-1", processors, "OMP_NUM_THREADS is '-1'; allowed: 1 to 1024 threads"),
                ("99999999999999999999", None, processors, "allowed: 1 to 1024 threads")):
            given = {"SURFACEDIFFUSION_NUM_THREADS": own, "OMP_NUM_THREADS": openmp}
            environment = {k: v for k, v in {**os.environ, **given}.items() if v is not None}
            for name in given:
                if given[name] is None:
                    environment.pop(name, None)
            done = subprocess.run([sys.executable, "-c", program], env=environment, check=True,
                                  capture_output=True, text=True)
            self.assertEqual(done.stdout.split(), [str(expected), str(processors)], given)
            self.assertEqual(done.stderr.count("SurfaceDiffusionWarning"), bool(warning), done.stderr)
            self.assertIn(warning, done.stderr)

    def test_one_surface_serves_several_threads(self):
        surface = sd.sphere(4)
        inputs = [np.random.default_rng(seed).normal(size=surface.n_points) for seed in range(4)]
        expected = [sd.heat(surface, values, fwhm=0.5) for values in inputs]
        results = [None] * 4

        def work(i):
            for _ in range(5):
                results[i] = sd.heat(surface, inputs[i], fwhm=0.5)

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result, wanted in zip(results, expected):
            np.testing.assert_array_equal(result, wanted)

    @unittest.skipUnless(hasattr(os, "fork"), "needs fork")
    @unittest.skipIf("libtsan" in os.environ.get("LD_PRELOAD", ""),
                     "the thread sanitizer does not follow threads of a forked process")
    def test_forked_process_has_threads_of_its_own(self):
        surface = sd.sphere(6)
        values = np.random.default_rng(1).normal(size=surface.n_points)
        sd.set_number_of_threads(max(2, sd.get_number_of_threads()))
        expected = sd.heat(surface, values, fwhm=0.5)
        context = multiprocessing.get_context("fork")
        queue = context.Queue()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of fork with threads
            child = context.Process(target=smooth_in_child, args=(surface, 2 * values, queue))
            child.start()
        result = queue.get(timeout=300)
        child.join()
        np.testing.assert_allclose(result, 2 * expected, rtol=0, atol=1e-12)

    @unittest.skipUnless(hasattr(os, "fork"), "needs fork")
    @unittest.skipIf("libtsan" in os.environ.get("LD_PRELOAD", ""),
                     "the thread sanitizer does not follow threads of a forked process")
    def test_process_forked_during_a_call_is_not_locked(self):
        surface = sd.sphere(4)
        values = np.random.default_rng(1).normal(size=surface.n_points)
        expected = sd.heat(surface, values, fwhm=0.5)
        inside, done = threading.Event(), threading.Event()

        def wait(_):
            inside.set()
            done.wait(300)

        thread = threading.Thread(
            target=sd.heat, args=(surface, 2 * values), kwargs=dict(fwhm=0.4, progress=wait))
        thread.start()
        inside.wait(300)
        context = multiprocessing.get_context("fork")
        queue = context.Queue()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of fork with threads
            child = context.Process(target=smooth_in_child, args=(surface, values, queue))
            child.start()
        try:
            np.testing.assert_array_equal(queue.get(timeout=60), expected)
        finally:
            done.set()
            child.kill()
            child.join()
            thread.join()


class Segment(unittest.TestCase):
    def test_boundaries_are_closed_curves_of_their_length(self):
        surface = sd.sphere(4)
        noise = np.random.default_rng(0).normal(scale=0.1, size=surface.n_points)
        for options in (dict(means=[0, 1]), dict(seed=3)):
            result = sd.segment(surface, (surface.points[:, 2] > 0.5) + noise, units="Absolute", fidelity_weight=2.6,
                                **options)
            curve, = result.boundaries
            self.assertEqual(curve.regions, (1, 2))
            np.testing.assert_array_equal(curve.points[0], curve.points[-1])
            steps = np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
            self.assertAlmostEqual(steps.sum(), curve.length, places=12)
            self.assertAlmostEqual(result.boundary_lengths[1], curve.length, places=9)
            np.testing.assert_array_equal(result.values, 1 + result.probabilities.argmax(axis=1))

    def test_terms_and_seeds(self):
        surface = sd.sphere(4)
        x = surface.points[:, 0]
        result = sd.segment(surface, terms=np.stack([x, -x], axis=1))
        self.assertAlmostEqual(result.areas[0], 2 * np.pi, delta=0.1)
        self.assertEqual(result.means.shape, (2, 0))
        seeded = sd.segment(surface, terms=np.stack([x, -x], axis=1), seeds=np.where(x > 0.9, 1, 0))
        self.assertTrue((seeded.values[x > 0.9] == 1).all())


class Restoration(unittest.TestCase):
    def test_weight_is_found_unless_it_is_given(self):
        surface = sd.sphere(4)
        cap = (surface.points[:, 2] > 0.5).astype(float)
        noise = 0.02 * np.random.default_rng(1).normal(size=surface.n_points)
        blurred = sd.heat(surface, cap, fwhm=0.3) + noise

        def weight(**properties):
            return sd.intrinsic_tv_steps(surface, blurred, mode="SteadyState", blur_fwhm=0.3,
                                         **properties).last().effective_fidelity_weight

        found = weight()
        self.assertGreater(found, 10.0)
        self.assertEqual(weight(automatic_fidelity=True), found)
        for given in (3.0, 20.0):
            self.assertEqual(weight(fidelity_weight=given), given)
        self.assertEqual(weight(automatic_fidelity=False), 3.0)
        self.assertEqual(weight(automatic_blur_fidelity=False), 3.0)
        self.assertEqual(weight(fidelity_weight=3, automatic_fidelity=True), found)


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
