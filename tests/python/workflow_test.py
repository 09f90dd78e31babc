"""The workflow of a study makes its table, does nothing twice, and goes on where it was cut."""
import csv, os, shutil, subprocess, sys, tempfile, unittest

from common import Desk, PROGRAM, SOURCE, main

if not shutil.which("snakemake"):
    sys.exit(77)

QUICK = dict(servodx=PROGRAM, valves=1, logs=12, duration=0.2, generations=0, rounds=1, for_tune=1, for_baseline=3)


def study(folder, *more):
    words = ["snakemake", "-s", str(SOURCE / "examples/snakemake/Snakefile"), "--directory", folder, "--cores", "2",
             "--config", *(f"{key}={value}" for key, value in QUICK.items()), *more]
    ended = subprocess.run(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                           env={**os.environ, "XDG_CACHE_HOME": folder})
    return ended.returncode, ended.stdout


class Workflow(unittest.TestCase):
    def test_a_study_is_made_once_and_goes_on(self):
        with Desk() as desk:
            code, said = study(desk.name)
            self.assertEqual(code, 0, said[-3000:])
            table = list(csv.DictReader((desk / "study.csv").read_text().splitlines()))
            judged = (desk / "work/valve_01/judge.txt").read_text().splitlines()
            self.assertEqual(sum(int(row["logs"]) for row in table), len(judged))
            self.assertTrue((desk / "pages/valve_01.html").exists())

            code, said = study(desk.name)
            self.assertEqual(code, 0, said[-3000:])
            self.assertIn("Nothing to be done", said)

            # Cut while it judged: one result and what comes later are missing, and the other results are kept as they are.
            results = sorted((desk / "results_valve_01").glob("*.json"))
            kept = {path: path.stat().st_mtime_ns for path in results[1:]}
            before = (desk / "study.csv").read_bytes()
            for name in (results[0], "work/valve_01/judged", "work/valve_01/counts.json", "pages/valve_01.html", "study.csv"):
                (desk / name).unlink()
            code, said = study(desk.name)
            self.assertEqual(code, 0, said[-3000:])
            self.assertTrue(results[0].exists())
            self.assertEqual({path: path.stat().st_mtime_ns for path in kept}, kept)
            self.assertEqual((desk / "study.csv").read_bytes(), before)


main()
