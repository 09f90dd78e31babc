"""The Python module is the library: the program's bytes and verdicts, errors with their place, Ctrl-C."""
import _thread, html, json, os, pathlib, signal, subprocess, sys, tempfile, threading, time, unittest

from common import *


class Module(unittest.TestCase):
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
        self.assertEqual(error.code, "E04")
        self.assertTrue(str(error).endswith("[E04]"), error)
        with self.assertRaises(sx.InputError) as caught:
            sx.tune([], **{**quick(), "rounds": 0})
        self.assertEqual(caught.exception.file, "--rounds")
        self.assertIsNone(caught.exception.code)

    def test_the_whole_job_gives_the_programs_verdict(self):
        told = []
        again = sx.tune([excerpt(TUNED_ON, 700)], progress=lambda *done: told.append(done), **quick())
        self.assertTrue(told)
        self.assertEqual({work for work, _, _ in told}, {"tune"})
        self.assertEqual(again.table.sha256, tuned().table.sha256)
        with Desk() as desk:
            tuned().save(desk / "tuned.csv")
            baseline().save(desk / "base.json")
            (desk / "s.csv").write_text(excerpt_text(SUSPECT, 300))
            desk.ran("diagnose", "s.csv", "--rig", SOURCE / "data/rig.toml", "--params", "tuned.csv", "--baseline",
                     "base.json", "--json", "v.json")
            program = json.loads((desk / "v.json").read_text())["results"][0]
            self.assertEqual(sx.Tuned.load(desk / "tuned.csv").table.sha256, tuned().table.sha256)
        ours = json.loads(verdict().json)
        self.assertEqual(verdict().kind.name, program["verdict"])
        self.assertEqual(verdict().error, program["error"])
        self.assertEqual({**ours, "log": "", "logs": []}, {**program, "log": "", "logs": []})
        explained = tuned().explain([suspect()], baseline())
        self.assertIn("nothing", explained.probabilities)
        self.assertIsInstance(explained.kind, sx.Explanation.Kind)

    def test_results_say_what_they_cost_and_what_they_rest_on(self):
        for result in (tuned(), baseline(), verdict(), tuned().explain([suspect()], baseline(), keep_worse=True)):
            self.assertGreater(result.simulations, 0, type(result).__name__)
            self.assertGreaterEqual(result.failed_simulations, 0)
        self.assertFalse(baseline().interrupted)
        self.assertIsNone(verdict().friction)  # the rig file does not state the land's length
        self.assertTrue(tuned().table.has_std_error)
        self.assertFalse(params().has_std_error)
        with self.assertRaises(sx.InputError):  # it is one of the own logs
            tuned().baseline([excerpt(name, 300) for name in HEALTHY], false_alarm=0.3, others=[excerpt(HEALTHY[0], 300)])

    def test_a_note_has_a_kind_and_the_programs_words(self):
        time = [k * 1e-3 for k in range(30)] + [0.05]
        log = sx.make_log("bench", {"time [s]": time, "command [mA]": [k % 7 for k in range(31)],
                                    "spool_position [mm]": [0.01 * (k % 11) for k in range(31)]})
        note, = log.notes
        self.assertEqual(note.kind, sx.Note.Kind.gaps)
        self.assertIn("bench: 1 gap in time", note.text)
        self.assertEqual(str(note), note.text)
        self.assertIn(note, log.notes)
        plan = tuned().plan(faults=["clogged_filter"], seconds=0.3, rounds=0)
        self.assertLessEqual({sx.Note.Kind.no_log, sx.Note.Kind.no_baseline}, {note.kind for note in plan.notes})
        self.assertIn(str(plan.notes[0]), html.unescape(plan._repr_html_()))
        self.assertEqual([str(note) for note in verdict().notes], json.loads(verdict().json)["notes"])

    def test_a_simulation_has_the_logs_samples(self):
        log = excerpt(TUNED_ON, 100)
        run = sx.simulate(log, params=params(), rig=rig())
        self.assertEqual(set(run), {"spool_position", "piston_position", "pressure_a", "pressure_b"})
        self.assertEqual(run["spool_position"].shape, (100,))
        self.assertRaises(KeyError, lambda: run["flow_a"])

    def test_several_logs_are_judged_together(self):
        pool = tuned().diagnose([suspect(), excerpt("fault/f01_clogged_filter_medium", 300)], baseline())
        self.assertIsInstance(pool.kind, sx.Verdict.Kind)
        with self.assertRaises(sx.InputError):
            tuned().diagnose([], baseline())

    def test_ctrl_c_ends_a_tune(self):
        log = excerpt(TUNED_ON, 700)
        threading.Timer(0.5, _thread.interrupt_main).start()
        with self.assertRaises(KeyboardInterrupt):  # the timer's thread runs: the interpreter is free meanwhile
            sx.tune([log], **{**quick(), "generations": 1_000_000})

    def test_a_tune_that_is_ended_leaves_its_best(self):
        log = excerpt(TUNED_ON, 700)
        threading.Timer(0.5, _thread.interrupt_main).start()
        with self.assertRaises(KeyboardInterrupt) as caught:
            sx.tune([log], **{**quick(), "generations": 1_000_000})
        self.assertIsInstance(caught.exception.best, sx.Tuned)
        self.assertTrue(caught.exception.best.interrupted)

    def test_a_tune_goes_on_from_its_checkpoint(self):
        log = excerpt(TUNED_ON, 700)
        with Desk() as desk:
            kept = desk / "kept"
            with self.assertRaises(sx.InputError):
                sx.tune([log], checkpoint=kept, resume=True, **quick())
            sx.tune([log], checkpoint=kept, **quick())
            again = sx.tune([log], checkpoint=kept, resume=True, **quick())
        self.assertEqual(again.table.sha256, tuned().table.sha256)

    def test_what_a_call_is_told_reaches_the_library(self):
        for told in ({"moving_average": 2}, {"priors": {"no_such_row": 1.0}}):
            with self.assertRaises(sx.InputError, msg=told):
                sx.tune([excerpt(TUNED_ON, 700)], **quick(), **told)
        with self.assertRaises(sx.InputError):
            sx.curves(suspect(), rig(), guard=-1)

    def test_ctrl_c_ends_a_check(self):
        log = sx.read_log(SOURCE / "data/healthy/h09_preflight_hot.csv", rig())
        tuned()

        def interrupt(*_):
            _thread.interrupt_main()  # once the check is under way
        began = time.process_time()
        with self.assertRaises(KeyboardInterrupt):
            tuned().check(log, progress=interrupt)
        ended = time.process_time() - began
        began = time.process_time()
        tuned().check(log)
        self.assertLess(ended, 0.7 * (time.process_time() - began), "it did as much work as a whole check")

    def test_a_signal_ends_a_script_as_python_ends_it(self):
        script = (f"import sys; sys.argv = {sys.argv[:4]!r}; sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})\n"
                  "from common import *\nprint('ready', flush=True)\n"
                  "sx.tune([excerpt(TUNED_ON, 700)], **{**quick(), 'generations': 1_000_000})\n")
        run = subprocess.Popen([sys.executable, "-B", "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)
        self.assertEqual(run.stdout.readline(), "ready\n")
        time.sleep(0.5)
        run.send_signal(signal.SIGINT)
        err = run.communicate(timeout=600)[1]
        self.assertEqual(run.returncode, -signal.SIGINT, err)
        self.assertTrue(err.rstrip().endswith("KeyboardInterrupt"), err)

    def test_what_progress_raises_ends_the_call(self):
        def refuse(*_):
            raise ZeroDivisionError
        with self.assertRaises(ZeroDivisionError):
            sx.tune([excerpt(TUNED_ON, 700)], progress=refuse, **{**quick(), "generations": 1_000_000})


class Progress(unittest.TestCase):
    def test_scripts_and_pipes_show_no_bar(self):
        from servodx import progress
        self.assertFalse(progress.interactive())
        self.assertIsNone(progress.default_bar())

    def test_a_person_at_a_prompt_sees_one(self):
        from servodx import progress
        sys.ps1, was = ">>> ", sys.stderr
        try:
            class Terminal:
                def isatty(self): return True
            sys.stderr = Terminal()
            self.assertIsInstance(progress.default_bar(), progress.Bar)
        finally:
            del sys.ps1
            sys.stderr = was

    def test_the_bar_writes_over_itself_and_leaves_nothing(self):
        import io
        from servodx import progress
        clock, out = iter([0.0, 0.5, 2.0, 4.0]), io.StringIO()
        bar = progress.Bar(out, lambda: next(clock))
        bar("tune", 0.1, 10)
        self.assertEqual(out.getvalue(), "")  # a quick call shows nothing
        bar("tune", 0.5, 20)
        self.assertIn("tune |############            |  50 % 0:02, 0:02 left, 20 simulations", out.getvalue())
        bar("tune", 1.0, 30)
        bar.close()
        line = ""
        for part in out.getvalue().split("\r"):
            line = part + line[len(part):]
        self.assertEqual(line.strip(), "")


class Together(unittest.TestCase):
    def test_two_interpreters_at_once_get_what_one_gets(self):
        script = (f"import sys; sys.argv = {sys.argv[:4]!r}; sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})\n"
                  "from common import *\nprint(tuned().table.sha256)\n")
        both = [subprocess.Popen([sys.executable, "-B", "-c", script], stdout=subprocess.PIPE, text=True) for _ in "ab"]
        self.assertEqual([run.communicate()[0].strip() for run in both], [tuned().table.sha256] * 2)

    def test_two_threads_at_once_get_what_one_gets(self):
        seen = [None, None]
        def judge(i):
            seen[i] = tuned().diagnose(suspect(), baseline()).json
        baseline()
        threads = [threading.Thread(target=judge, args=(i,)) for i in range(2)]
        for thread in threads: thread.start()
        for thread in threads: thread.join()
        self.assertEqual(seen, [verdict().json] * 2)


main()
