"""The misfit as a function: a batch is its points one by one, SciPy and ours lower the same cost, weights are a tune's."""
import unittest

import numpy
import scipy.optimize
from common import *


class Function(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.of_tuned = tuned().objective([suspect()])
        cls.of_table = sx.Objective([excerpt(TUNED_ON, 300)], params(), rig(), effects=[])

    def some_points(self, objective, count):
        rng = numpy.random.default_rng(3)
        return numpy.clip(objective.start + 0.02 * rng.standard_normal((count, objective.n)), 0, 1)

    def test_a_batch_is_its_points_one_by_one_bit_for_bit(self):
        many = self.some_points(self.of_table, 5)
        batch = self.of_table.residuals(many)
        self.assertEqual(batch.shape, (5, self.of_table.size))
        for point, row in zip(many, batch):
            numpy.testing.assert_array_equal(self.of_table.residuals(point), row)
        numpy.testing.assert_allclose(self.of_table.cost(many), 0.5 * (batch ** 2).sum(axis=1), rtol=1e-12)

    def test_shapes_that_are_no_points_are_refused(self):
        for x in (numpy.zeros(self.of_table.n + 1), [2.0] * self.of_table.n, [float("nan")] * self.of_table.n, []):
            with self.assertRaises(sx.InputError):
                self.of_table.residuals(x)
        with self.assertRaises(sx.InputError):
            sx.Objective([suspect()], params(), rig(), effects=["no_such_effect"])
        with self.assertRaises(ValueError):
            self.of_table.minimise("no_such_method")

    def test_the_jacobian_is_the_slope_of_the_residuals(self):
        x = self.of_table.start.clip(0.01, 0.99)
        jacobian = self.of_table.jac(x)
        self.assertEqual(jacobian.shape, (self.of_table.size, self.of_table.n))
        step = 1e-4
        for name in ("spool_friction", "torque_motor_frequency", "bulk_modulus"):
            found = self.of_table.numbers.index[self.of_table.numbers["name"] == name]
            for j in found:
                moved = x.copy()
                moved[j] += step
                slope = (self.of_table.residuals(moved) - self.of_table.residuals(x)) / step
                self.assertLess(numpy.linalg.norm(slope - jacobian[:, j]), 0.1 * numpy.linalg.norm(slope) + 1e-9, name)

    def test_parts_and_numbers_say_what_is_what(self):
        f = self.of_table
        parts, numbers = f.parts, f.numbers
        self.assertEqual(list(parts["signal"]), ["spool_position", "piston_position", "pressure_a", "pressure_b"])
        self.assertEqual(parts["count"].sum() + numpy.isfinite(numbers["prior_sd"]).sum(), f.size)
        self.assertEqual(len(numbers), f.n)
        self.assertEqual(numbers.attrs["units"]["start"], "{unit}")
        numpy.testing.assert_allclose(f.point(f.values(f.start)), f.start, atol=1e-9)
        numpy.testing.assert_allclose(f.values(f.start), numbers["start"], rtol=1e-9)
        numpy.testing.assert_array_equal(f.point(params()), f.start)
        priors = f.residuals(f.start)[parts["count"].sum():]
        numpy.testing.assert_allclose(priors, 0, atol=1e-9)

    def test_weights_of_a_tuned_table_are_its_error_model(self):
        """A log like those that tuned it deviates by about one sigma; a log of a fault by more."""
        healthy = tuned().objective([excerpt(TUNED_ON, 300)])
        share = healthy.cost(healthy.start) / healthy.size
        self.assertLess(share, self.of_tuned.cost(self.of_tuned.start) / self.of_tuned.size)
        self.assertEqual(healthy.numbers.loc[healthy.numbers["name"] == "port_width", "start"].iloc[0],
                         tuned().table["port_width"].nominal)

    def test_scipy_and_ours_lower_the_same_cost(self):
        f = self.of_table
        first = f.cost(f.start)
        before = f.simulations
        scipy_end = scipy.optimize.least_squares(f.residuals, f.start.clip(1e-6, 1 - 1e-6), jac=f.jac, bounds=f.bounds,
                                                 max_nfev=3)
        self.assertGreater(f.simulations, before)
        self.assertLess(scipy_end.cost, 0.9 * first)
        self.assertAlmostEqual(f.cost(scipy_end.x), scipy_end.cost, delta=1e-9 * scipy_end.cost)
        for method in ("least_squares", "ceres"):
            end = f.minimise(method, iterations=3)
            self.assertLess(end.cost, 0.9 * first, method)
            self.assertAlmostEqual(f.cost(end.x), end.cost, delta=1e-6 * end.cost)
            self.assertGreater(end.simulations, 0)
            self.assertTrue(end.message)
            self.assertEqual(f.minimise(method, iterations=3).cost, end.cost)  # deterministic

    def test_the_whole_search_ends_no_higher_than_its_local_stage(self):
        f = self.of_table
        local = f.minimise("least_squares", iterations=1)
        whole = f.minimise("whole", iterations=1, population=24, generations=1)
        self.assertLessEqual(whole.cost, local.cost)
        self.assertGreater(whole.simulations, local.simulations)

    def test_a_slice_goes_through_the_start(self):
        f = self.of_table
        frame = f.slice("spool_friction", points=5)
        self.assertEqual(len(frame), 5)
        self.assertEqual(frame.attrs["units"]["value"], params()["spool_friction"].unit)
        self.assertTrue((frame["cost"] > 0).all())
        self.assertRaises(KeyError, f.slice, "no_such_row")


main()
