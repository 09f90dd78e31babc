"""The Python module is the library: the program's bytes and verdicts, errors with their place, Ctrl-C.
Called by ctest with the folder of the built package: module_test.py PACKAGES SOURCE PROGRAM"""
import _thread, json, pathlib, subprocess, sys, tempfile, threading, unittest

sys.path.insert(0, sys.argv[1])
SOURCE, PROGRAM = pathlib.Path(sys.argv[2]), sys.argv[3]
import numpy, pandas
import servodx as sx

RIG = sx.Rig(str(SOURCE / "data/rig.toml"))
PARAMS = sx.Table.load(str(SOURCE / "params/borello2009.csv"))
QUICK = dict(params=PARAMS, rig=RIG, generations=0, rounds=1, effects=[])


def excerpt(name, rows):
    """The first samples of a shipped log, by way of a DataFrame."""
    frame = pandas.read_csv(SOURCE / f"data/{name}.csv", comment="#").head(rows)
    return sx.log_of(frame, rig=RIG, name=name)


class Module(unittest.TestCase):
    def test_a_log_goes_in_and_out_as_a_frame(self):
        log = excerpt("healthy/h12_mixed", 50)
        self.assertEqual(len(log), 50)
        frame = sx.frame_of(log)
        self.assertEqual(list(frame.index), list(log.time))
        numpy.testing.assert_array_equal(frame["pressure_a"], log.signals["pressure_a"])
        bar = sx.log_of({"time [s]": log.time, "pressure_a": log.signals["pressure_a"] / 1e5,
                         "pressure_b": log.signals["pressure_b"] / 1e5, "command [A]": log.signals["command"]},
                        units={"pressure_a": "bar", "pressure_b": "bar"}, rig=RIG)
        numpy.testing.assert_allclose(bar.signals["pressure_a"], log.signals["pressure_a"], rtol=1e-12)

    def test_a_bad_input_says_where_what_and_how(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bad.csv"
            path.write_text("time [s],command [mA],spool_position [mm]\n" +
                            "".join(f"{k / 1000},0,{'x' if k == 5 else 0}\n" for k in range(30)))
            with self.assertRaises(sx.InputError) as caught:
                sx.read_log(str(path))
        error = caught.exception
        self.assertIsInstance(error, ValueError)
        self.assertEqual((error.file, error.line), (str(path), 7))
        self.assertIn("spool_position", error.column)
        self.assertTrue(error.rule and error.mend)
        with self.assertRaises(sx.InputError) as caught:
            sx.tune([], **{**QUICK, "rounds": 0})
        self.assertEqual(caught.exception.file, "--rounds")

    def test_the_whole_job_gives_the_programs_verdict(self):
        told = []
        tuned = sx.tune([excerpt("healthy/h12_mixed", 700)], progress=lambda *done: told.append(done), **QUICK)
        self.assertTrue(told)
        self.assertEqual({work for work, _, _ in told}, {"tune"})
        healthy = [excerpt(f"healthy/{n}", 300) for n in ("h15_no_supply_signals", "h04_multisine", "h03_sine_2hz")]
        baseline = tuned.baseline(healthy, false_alarm=0.3)
        verdict = tuned.diagnose(excerpt("fault/f02_clogged_filter_severe", 300), baseline)
        with tempfile.TemporaryDirectory() as folder:
            at = pathlib.Path(folder)
            tuned.save(str(at / "tuned.csv"))
            baseline.save(str(at / "base.json"))
            rows = (SOURCE / "data/fault/f02_clogged_filter_severe.csv").read_text().splitlines(keepends=True)
            begin = next(k for k, line in enumerate(rows) if not line.startswith("#"))
            (at / "s.csv").write_text("".join(rows[:begin + 301]))
            subprocess.run([PROGRAM, "diagnose", "s.csv", "--rig", str(SOURCE / "data/rig.toml"), "--params", "tuned.csv",
                            "--baseline", "base.json", "--quiet", "--json", "v.json"], cwd=at, check=True,
                           stdout=subprocess.DEVNULL)
            program = json.loads((at / "v.json").read_text())["results"][0]
            self.assertEqual(sx.Tuned.load(str(at / "tuned.csv")).table.sha256, tuned.table.sha256)
        self.assertEqual(verdict.kind.name, program["verdict"])
        self.assertEqual(verdict.error, program["error"])
        self.assertEqual(verdict.probabilities, program["probabilities"])
        explained = tuned.explain([excerpt("fault/f02_clogged_filter_severe", 300)], baseline)
        self.assertIn("nothing", explained.probabilities)

    def test_a_simulation_has_the_logs_samples(self):
        log = excerpt("healthy/h12_mixed", 100)
        run = sx.simulate(log, params=PARAMS, rig=RIG)
        self.assertEqual(set(run), {"spool_position", "piston_position", "pressure_a", "pressure_b"})
        self.assertEqual(run["spool_position"].shape, (100,))

    def test_ctrl_c_ends_a_tune(self):
        log = excerpt("healthy/h12_mixed", 700)
        threading.Timer(0.5, _thread.interrupt_main).start()
        with self.assertRaises(KeyboardInterrupt):  # the timer's thread runs: the interpreter is free meanwhile
            sx.tune([log], **{**QUICK, "generations": 1_000_000})

    def test_what_progress_raises_ends_the_call(self):
        def refuse(*_):
            raise ZeroDivisionError
        with self.assertRaises(ZeroDivisionError):
            sx.tune([excerpt("healthy/h12_mixed", 700)], progress=refuse, **{**QUICK, "generations": 1_000_000})


unittest.main(argv=[sys.argv[0]], verbosity=2)
