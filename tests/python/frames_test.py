"""Logs go in and out as DataFrames to the last bit, and every table says its units."""
import unittest

import numpy
from common import *


class Frames(unittest.TestCase):
    def test_a_log_goes_out_and_in_again_to_the_same_bits(self):
        log = excerpt(TUNED_ON, 50)
        self.assertEqual(len(log), 50)
        frame = log.frame()
        self.assertEqual(list(frame.index), list(log.time))
        self.assertEqual(frame.attrs["units"]["pressure_a"], "Pa")
        self.assertEqual(frame.attrs["units"]["time"], "s")
        again = sx.Log(frame, rig=rig())
        self.assertEqual(set(again.signals), set(log.signals))
        for name, values in log.signals.items():
            numpy.testing.assert_array_equal(again.signals[name], values, err_msg=name)
        numpy.testing.assert_array_equal(again.time, log.time)

    def test_units_are_told_beside_the_columns_or_in_them(self):
        log = excerpt(TUNED_ON, 50)
        of = {"time [s]": log.time, "pressure_a": log.signals["pressure_a"] / 1e5,
              "pressure_b": log.signals["pressure_b"] / 1e5, "command [A]": log.signals["command"]}
        for bar in (sx.Log(of, units={"pressure_a": "bar", "pressure_b": "bar"}, rig=rig()),
                    sx.log_of(of, units={"pressure_a": "bar", "pressure_b": "bar"}, rig=rig())):
            numpy.testing.assert_allclose(bar.signals["pressure_a"], log.signals["pressure_a"], rtol=1e-12)
        with self.assertRaises(sx.InputError) as caught:
            sx.Log(of, rig=rig())
        self.assertIn("unit", str(caught.exception))

    def test_units_of_the_signals_are_those_of_the_library(self):
        """Each signal in its SI unit keeps its numbers."""
        from servodx.frames import UNITS
        time = numpy.arange(30) / 1000
        data = {"command [A]": 0.001 * time, "spool_position [m]": 0.001 * time}
        for name, unit in UNITS.items():
            if name in ("time", "command", "spool_position"):
                continue
            values = 300 + numpy.sin(50 * time)
            log = sx.make_log(name, {"time [s]": time, **data, f"{name} [{unit}]": values})
            numpy.testing.assert_array_equal(log.signals[name], values, err_msg=name)

    def test_a_rig_from_a_dictionary_is_that_of_its_file(self):
        import tomllib
        path = SOURCE / "data/tutorial/bench.toml"
        made = sx.Rig(tomllib.loads(path.read_text()))
        self.assertEqual(made.facts, sx.Rig(path).facts)
        self.assertTrue(made.facts)
        text = (SOURCE / "data/tutorial/good_1.csv")
        numpy.testing.assert_array_equal(sx.read_log(text, made).signals["pressure_a"],
                                         sx.read_log(text, sx.Rig(path)).signals["pressure_a"])
        with self.assertRaises(sx.InputError) as caught:
            sx.Rig({"valve": {"rated_curent": "20 mA"}})
        self.assertIn("rated_curent", str(caught.exception))

    def test_texts_of_a_rig_may_hold_any_mark(self):
        name = 'a "b" \\ c\td'
        self.assertEqual(sx.Rig({"name": name}).name, name)

    def test_every_table_tells_its_units(self):
        for frame, column in ((params().frame(), "nominal"), (tuned().parameters, "estimate"),
                              (tuned().channels, "rms"), (verdict().parameters, "estimate"),
                              (verdict().channels, "noise_rms")):
            self.assertEqual(frame.attrs["units"][column], "{unit}")
            self.assertIn("unit", frame.columns)
            self.assertTrue(len(frame))
        self.assertEqual(tuned().channels.loc["pressure_a", "unit"], "Pa")
        self.assertEqual(len(params().frame()), 41)
        self.assertEqual(params()["port_width"].unit, params().frame().loc["port_width", "unit"])
        self.assertEqual(baseline().scores.attrs["units"], {"score": "deviates"})

    def test_a_replay_has_residuals_beside_what_they_should_be(self):
        log = excerpt(TUNED_ON, 300)
        run = tuned().replay(log)
        frame = run.frame()
        self.assertEqual(len(frame), 300)
        of = run.signals["pressure_a"]
        numpy.testing.assert_array_equal(of["measured"], log.signals["pressure_a"])
        numpy.testing.assert_allclose(of["residual"], of["measured"] - of["simulated"], rtol=0, atol=1e-6)
        self.assertGreater(of["sigma"].min(), 0)
        self.assertEqual(frame.attrs["units"]["pressure_a"], "Pa")


main()
