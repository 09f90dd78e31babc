"""What pickles comes back the same, workers get the same bits, and a forked one does not hang."""
import multiprocessing, os, pathlib, pickle, sys, unittest

import numpy
from common import *


def shown(thing):
    """All that a value shows, nested."""
    if isinstance(thing, numpy.ndarray):
        return [repr(v) for v in thing.ravel()]
    if isinstance(thing, (list, tuple)):
        return [shown(v) for v in thing]
    if isinstance(thing, dict):
        return {key: shown(v) for key, v in thing.items()}
    if hasattr(thing, "to_csv"):
        return thing.to_csv() + repr(thing.attrs)
    if not type(thing).__module__.startswith("servodx") or hasattr(type(thing), "__members__"):
        return repr(thing)
    names = [n for n in dir(type(thing)) if isinstance(getattr(type(thing), n), property)]
    return {name: shown(getattr(thing, name)) for name in names}


def judged(made):
    tuned_there, base, log = made
    return tuned_there.diagnose(log, base, threads=1).json


def forked_says(work):
    """What a forked child's work returns or raises."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            said = work()
        except BaseException as error:
            said = f"{type(error).__name__}: {error}"
        os.write(writer, said.encode()[-60000:])
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader) as text:
        said = text.read()
    os.waitpid(child, 0)
    return said


class Pickles(unittest.TestCase):
    def same(self, thing):
        again = pickle.loads(pickle.dumps(thing))
        self.assertIs(type(again), type(thing))
        before = shown(thing)
        self.assertTrue(before)
        self.assertEqual(shown(again), before)
        return again

    def test_inputs_and_results_come_back_as_they_were(self):
        for thing in (rig(), suspect(), params(), params()["port_width"], tuned(), baseline(), verdict(),
                      verdict().kind, tuned().explain([suspect()], baseline()),
                      sx.simulate(suspect(), params=params(), rig=rig()), tuned().replay(suspect())):
            with self.subTest(type(thing).__name__):
                self.same(thing)
        plan = tuned().plan(faults=["clogged_filter"], seconds=0.3, rounds=0)
        self.assertTrue(plan.notes)
        for part in verdict().faults + list(verdict().detectable.values()) + plan.notes:
            self.same(part)

    def test_the_rest_of_a_log_and_a_rig_is_kept_too(self):
        """Fields that nothing shows: what they do is the same."""
        bench = sx.Rig(SOURCE / "data/tutorial/bench.toml")
        path = SOURCE / "data/tutorial/good_1.csv"
        log = sx.read_log(path, bench)
        with Desk() as desk:
            log.save(desk / "a.csv")
            sx.read_log(path, pickle.loads(pickle.dumps(bench))).save(desk / "b.csv")
            pickle.loads(pickle.dumps(log)).save(desk / "c.csv")
            for name in "bc":
                self.assertEqual((desk / f"{name}.csv").read_bytes(), (desk / "a.csv").read_bytes())
            tuned().save(desk / "t.csv")
            pickle.loads(pickle.dumps(tuned())).save(desk / "u.csv")
            self.assertEqual((desk / "u.csv").read_bytes(), (desk / "t.csv").read_bytes())
            baseline().save(desk / "t.json")
            pickle.loads(pickle.dumps(baseline())).save(desk / "u.json")
            self.assertEqual((desk / "u.json").read_bytes(), (desk / "t.json").read_bytes())

    def test_a_sheet_keeps_the_uncertainty_of_its_figures(self):
        time = 0.01 * numpy.arange(5001)
        turn = time / 40 + 0.25
        current = 20.4 * (1 - 4 * abs(turn - numpy.floor(turn) - 0.5))
        flow = 0.7 * current + numpy.random.default_rng(1).normal(0, 0.02, len(time))
        stand = sx.Rig({"ports": "free", "valve": {"rated_current": "20 mA"}})
        log = sx.Log({"time [s]": time, "command [mA]": current, "control_flow [l/min]": flow}, rig=stand)
        sheet = sx.curves(log, stand)
        self.assertTrue((sheet.figures["uncertainty"] > 0).any())
        self.same(sheet)
        coarse = sx.curves(log, stand, instruments={"control_flow": (1e-5, 0)}).figures["uncertainty"].fillna(0)
        self.assertTrue((coarse > sheet.figures["uncertainty"].fillna(0)).any(), "a coarse meter makes figures less sure")

    def test_an_objective_is_made_again_where_it_comes(self):
        objective = tuned().objective([suspect()])
        again = pickle.loads(pickle.dumps(objective))
        numpy.testing.assert_array_equal(again.residuals(again.start), objective.residuals(objective.start))

    def test_what_cannot_pickle_says_so(self):
        with self.assertRaises(TypeError):
            pickle.dumps(tuned().check(excerpt("healthy/h09_preflight_hot", 2400), track=False))


class Workers(unittest.TestCase):
    def test_spawned_workers_get_the_same_bits(self):
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            got = pool.map(judged, [(tuned(), baseline(), suspect())] * 2)
        self.assertEqual(got, [verdict().json] * 2)

    def test_a_forked_child_works_on_one_thread(self):
        verdict()  # the parent has used its threads
        self.assertEqual(forked_says(lambda: judged((tuned(), baseline(), suspect()))), verdict().json[-60000:])
        self.assertEqual(forked_says(lambda: str(len(sx.read_log(SOURCE / f"data/{SUSPECT}.csv", rig())))), "4000")

    def test_a_forked_child_is_refused_more_threads(self):
        verdict()
        said = forked_says(lambda: tuned().diagnose(suspect(), baseline(), threads=2).json)
        self.assertTrue(said.startswith("RuntimeError"), said[:200])
        self.assertIn("spawn", said)


if __name__ == "__main__":  # a worker that was spawned reads this file too
    main()
