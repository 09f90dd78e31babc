"""Absurd logs of data/ by bench/absurd: none is healthy, none a fault over 90 %. Called by ctest: PROGRAM."""
import json, os, pathlib, subprocess, sys, tempfile, unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.path.abspath(sys.argv[1])
DATA = ROOT / "data"
# Nothing of them is fitted, so that a table and a baseline of short logs do.
CASES = {"white_noise", "nothing_moves", "noise_as_response", "sensors_frozen", "command_zero", "command_hundredfold",
         "rows_shuffled", "time_thousandth", "one_chamber_twice"}


def excerpt(name, rows):
    lines = (DATA / name).read_text().splitlines(keepends=True)
    first = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    return "".join(lines[:first + 1 + rows])


def learn(desk):
    """A table and a baseline, both made in haste."""
    def run(*words):
        subprocess.run([PROGRAM, *words, "--rig", DATA / "rig.toml", "--quiet"], cwd=desk, check=True,
                       stdout=subprocess.DEVNULL)
    logs = {"t.csv": "h01_steps_large", "b1.csv": "h15_no_supply_signals", "b2.csv": "h04_multisine",
            "b3.csv": "h03_sine_2hz"}
    for name, log in logs.items():
        (desk / name).write_text(excerpt(f"healthy/{log}.csv", 700 if name == "t.csv" else 300))
    run("tune", "t.csv", "--params", ROOT / "params/borello2009.csv", "--generations", "0", "--effects", "none", "-o",
        "tuned.csv")
    run("baseline", "b1.csv", "b2.csv", "b3.csv", "--params", "tuned.csv", "--alone", "-o", "base.json")


class Absurd(unittest.TestCase):
    def test_none_is_healthy_and_none_a_fault_without_a_doubt(self):
        with tempfile.TemporaryDirectory() as folder:
            desk = pathlib.Path(folder)
            learn(desk)
            said = subprocess.run(
                [ROOT / "bench/absurd", PROGRAM, desk / "made", "--rig", DATA / "rig.toml", "--params",
                 desk / "tuned.csv", "--baseline", desk / "base.json", "--log", DATA / "healthy/h12_mixed.csv", "--test",
                 DATA / "healthy/h05_prbs.csv", "--valve", DATA / "fault/f02_clogged_filter_severe.csv", "--only",
                 ",".join(sorted(CASES))], capture_output=True, text=True)
            self.assertEqual(said.returncode, 0, said.stderr)
            found = json.loads((desk / "made/absurd.json").read_text())
        self.assertEqual({f["log"] for f in found}, CASES)
        self.assertEqual([f["log"] for f in found if f["verdict"] == "healthy"], [], said.stdout)
        self.assertEqual([f["log"] for f in found if (f["probability"] or 0) > 0.9], [], said.stdout)
        self.assertEqual([f["log"] for f in found if not f["told"]], [], said.stdout)


unittest.main(argv=sys.argv[:1])
