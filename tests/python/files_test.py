"""What Python saves is the program's own file, byte for byte; what Python reads is what the program wrote."""
import json, unittest

from common import *


class Files(unittest.TestCase):
    def test_tables_baselines_and_simulations_are_the_programs(self):
        with Desk() as desk:
            (desk / "t.csv").write_text(excerpt_text(TUNED_ON, 400))
            for k, name in enumerate(HEALTHY):
                (desk / f"b{k}.csv").write_text(excerpt_text(name, 200))
            read = lambda name: sx.read_log(desk / name, rig())
            rig_file = ("--rig", SOURCE / "data/rig.toml")
            desk.ran("tune", "t.csv", *rig_file, "--params", SOURCE / "params/borello2009.csv", "--generations", 0,
                     "--rounds", 1, "--effects", "none", "-o", "tuned.csv")
            made = sx.tune([read("t.csv")], **quick())
            made.save(desk / "ours.csv")
            self.assertEqual((desk / "ours.csv").read_bytes(), (desk / "tuned.csv").read_bytes())
            sx.Table.load(desk / "tuned.csv").save(desk / "again.csv")
            self.assertEqual((desk / "again.csv").read_bytes(), (desk / "tuned.csv").read_bytes())

            desk.ran("baseline", "b0.csv", "b1.csv", "b2.csv", *rig_file, "--params", "tuned.csv", "--false-alarm", 0.3,
                     "-o", "base.json")
            program = sx.Baseline.load(desk / "base.json")
            program.save(desk / "again.json")
            self.assertEqual((desk / "again.json").read_bytes(), (desk / "base.json").read_bytes())
            ours = made.baseline([read(f"b{k}.csv") for k in range(3)], false_alarm=0.3)
            self.assertEqual(ours.threshold, program.threshold)

            desk.ran("simulate", "t.csv", *rig_file, "--params", "tuned.csv", "-o", "sim.csv")
            made.simulate(read("t.csv")).save(desk / "ours_sim.csv")
            self.assertEqual((desk / "ours_sim.csv").read_bytes(), (desk / "sim.csv").read_bytes())

    def test_a_log_reads_back_to_the_same_bits(self):
        import numpy
        log = sx.read_log(SOURCE / "data/tutorial/good_1.csv", sx.Rig(SOURCE / "data/tutorial/bench.toml"))
        with Desk() as desk:
            log.save(desk / "log.csv")
            again = sx.Log.load(desk / "log.csv", sx.Rig({"valve": {"rated_current": "10 mA"}}))
            for name, values in log.signals.items():
                numpy.testing.assert_allclose(again.signals[name], values, rtol=1e-15, atol=0, err_msg=name)
            again.save(desk / "again.csv")
            self.assertEqual((desk / "again.csv").read_bytes(), (desk / "log.csv").read_bytes())

    def test_files_appear_whole_or_not_at_all(self):
        from servodx.files import write_whole
        with Desk() as desk:
            write_whole(desk / "a.txt", "one")
            with self.assertRaises(TypeError):
                write_whole(desk / "a.txt", None)
            self.assertEqual((desk / "a.txt").read_text(), "one")
            self.assertEqual([path.name for path in (desk / ".").iterdir()], ["a.txt"])


class Lives(unittest.TestCase):
    LOG = "healthy/h09_preflight_hot"

    def test_checks_histories_and_trends_are_the_programs(self):
        with Desk() as desk:
            (desk / "hot.csv").write_text((SOURCE / f"data/{self.LOG}.csv").read_text())
            tuned().save(desk / "tuned.csv")
            read = sx.Tuned.load(desk / "tuned.csv", rig())
            desk.ran("check", "hot.csv", "--rig", SOURCE / "data/rig.toml", "--params", "tuned.csv", "--history", "a.db",
                     "--valve", "V7", "--at", 12.5, "--json", "c.json")
            program = json.loads((desk / "c.json").read_text())["checks"]
            log = sx.read_log(desk / "hot.csv", rig())
            checked = read.check(log)
            self.assertEqual([(c["name"], c["value"], c["std_error"]) for c in program],
                             [(name, row.value, row.std_error) for name, row in checked.figures.iterrows()])
            history = sx.History(desk / "b.db")
            history.record("V7", 12.5, checked, read)
            with self.assertRaises(sx.InputError):
                history.record("V7", 12.5, checked, read)
            history.add_event("V7", 20, "filter_changed", "new one")
            frame = history.frame("V7")
            self.assertEqual(list(frame["value"]), [c["value"] for c in sorted(program, key=lambda c: c["name"])])
            self.assertEqual(frame.attrs["units"]["at"], "h")
            self.assertEqual(list(history.events("V7")["kind"]), ["filter_changed"])
            desk.ran("history", "export", "--history", "b.db", "-o", "program.csv")
            history.save(desk / "ours.csv")
            self.assertEqual((desk / "ours.csv").read_bytes(), (desk / "program.csv").read_bytes())
            added = sx.History.import_csv(desk / "c.db", desk / "ours.csv")
            self.assertEqual((added["checks"], added["events"], added["present"]), (1, 1, 0))
            self.assertEqual(sx.History.import_csv(desk / "c.db", desk / "ours.csv")["checks"], 0)

    def test_a_trend_is_the_programs(self):
        rows = "".join(f"V7,{10 * k},parameter:22,{3e-6 + 4e-8 * max(0, k - 15) ** 1.5},1e-7\n" for k in range(40))
        with Desk() as desk:
            (desk / "life.csv").write_text("valve,at [h],name,value,std_error\n" + rows)
            sx.History.import_csv(desk / "h.db", desk / "life.csv")
            found = sx.trend(sx.History(desk / "h.db"), "V7")
            desk.ran("trend", "--history", "h.db", "--valve", "V7", "--json", "t.json")
            program = json.loads((desk / "t.json").read_text())
            self.assertEqual(found.state.name, program["state"])
            of, = [t for t in found.trends if t.name == "parameter:22"]
            theirs, = [c for c in program["checks"] if c["name"] == "parameter:22"]
            self.assertEqual(of.slope, theirs["slope"])
            self.assertGreater(of.slope, 0)
            self.assertEqual(len(found.points), 40)
            self.assertEqual(found.points.attrs["units"]["at"], "h")
            with self.assertRaises(sx.InputError):
                sx.trend(sx.History(desk / "h.db"), "V8")

    def test_a_comment_in_the_table_keeps_its_baseline(self):
        with Desk() as desk:
            tuned().save(desk / "tuned.csv")
            baseline().save(desk / "base.json")
            (desk / "said.csv").write_text("# looked over\n" + (desk / "tuned.csv").read_text())
            said, base = sx.Tuned.load(desk / "said.csv", rig()), sx.Baseline.load(desk / "base.json")
            self.assertEqual(said.diagnose(suspect(), base).json, verdict().json)
            (desk / "other.csv").write_text((desk / "tuned.csv").read_text().replace("per_activity = ", "per_activity = 1"))
            with self.assertRaisesRegex(sx.InputError, "made with another table"):
                sx.Tuned.load(desk / "other.csv", rig()).diagnose(suspect(), base)

    def test_a_plan_is_the_programs(self):
        with Desk() as desk:
            tuned().save(desk / "tuned.csv")
            made = sx.Tuned.load(desk / "tuned.csv", rig()).plan(faults=["clogged_filter"], seconds=0.3, rounds=0)
            made.save(desk / "ours.csv")
            desk.ran("plan", "--params", "tuned.csv", "--rig", SOURCE / "data/rig.toml", "--faults", "clogged_filter",
                     "--seconds", 0.3, "--rounds", 0, "-o", "program.csv")
            self.assertEqual((desk / "ours.csv").read_bytes(), (desk / "program.csv").read_bytes())
            self.assertEqual(len(made.command), len(made.time))
            self.assertIn("clogged_filter", made.faults.index)
            self.assertEqual(made.frame().attrs["units"]["command"], "A")

    def test_a_folder_of_results_is_what_gather_makes_of_it(self):
        with Desk() as desk:
            tuned().save(desk / "tuned.csv")
            baseline().save(desk / "base.json")
            (desk / "s.csv").write_text(excerpt_text(SUSPECT, 300))
            (desk / "bad.csv").write_text("no log\n")
            (desk / "list.txt").write_text("s.csv\nbad.csv\n")
            import subprocess
            ended = subprocess.run([PROGRAM, "diagnose", "--list", "list.txt", "--out", "res", "--rig",
                                    SOURCE / "data/rig.toml", "--params", "tuned.csv", "--baseline", "base.json", "--quiet"],
                                   cwd=desk.name, capture_output=True)
            self.assertEqual(ended.returncode, 3)
            fleet = sx.Fleet(desk / "res")
            desk.ran("gather", "res", "-o", "program.csv")
            fleet.save(desk / "ours.csv")
            self.assertEqual((desk / "ours.csv").read_bytes(), (desk / "program.csv").read_bytes())
            frame = fleet.frame()
            self.assertEqual(list(frame["log"]), ["s.csv"])
            self.assertEqual(frame["error"][0], verdict().error)
            self.assertEqual(list(fleet.refused["file"]), ["bad.csv"])
            (desk / "truth.csv").write_text("log,class\ns.csv,clogged_filter\n")
            counts, rates = sx.Fleet.count(desk / "res", desk / "truth.csv")
            self.assertEqual(counts.loc["clogged_filter"].sum(), 1)
            self.assertEqual(rates.loc["clogged_filter", "detected_of"], 1)


class Stand(unittest.TestCase):
    RIG = "ports = \"free\"\n[valve]\nrated_current = \"20 mA\"\n[limits]\nrated_flow = \"13 l/min\"\n"

    def test_curves_are_the_programs(self):
        import numpy
        time = 0.01 * numpy.arange(5001)
        turn = time / 40 + 0.25
        current = 20.4 * (1 - 4 * abs(turn - numpy.floor(turn) - 0.5))
        frame = pandas.DataFrame({"time [s]": time, "command [mA]": current,
                                  "control_flow [l/min]": 0.7 * (current - 0.2)})
        with Desk() as desk:
            frame.to_csv(desk / "flow.csv", index=False)
            (desk / "rig.toml").write_text(self.RIG)
            desk.ran("curves", "flow.csv", "--rig", "rig.toml", "--json", "c.json")
            program = json.loads((desk / "c.json").read_text())
            stand = sx.Rig(desk / "rig.toml")
            sheet = sx.curves(sx.read_log(desk / "flow.csv", stand), stand)
        self.assertEqual({name: row.value for name, row in sheet.figures.iterrows()},
                         {f["name"]: f["value"] for f in program["figures"]})
        self.assertEqual(sheet.kind, sx.Curves.Kind.passed)
        self.assertEqual(program["verdict"], "pass")
        self.assertTrue(sheet.figures.loc["rated_flow", "pass"])
        self.assertEqual(len(sheet.curves["control_flow"]["mean"]), len(sheet.curves["control_flow"]["current"]))


main()
