"""scripts/test and .ci/run name what was skipped, and say loudly where nothing was fuzzed. Called by ctest.

The script runs in a folder of its own, with a ctest that prints what is asked and does nothing. The nightly tests are
a run of their own, of one that passes.
"""
import os, pathlib, shutil, subprocess, tempfile, unittest

import source

CTEST = """#!/bin/sh
case "$*" in *--label-regex*)
  echo " 1/1 Test  #9: base.Csv.Long ..................   Passed    9.01 sec"
  echo "100%% tests passed, 0 tests failed out of 1"
  exit 0
esac
cat <<'END'
      Start  1: base.Csv.A
 1/%(all)d Test  #1: base.Csv.A .......................   Passed    0.01 sec
%(lines)s
100%% tests passed, 0 tests failed out of %(all)d
END
"""
SKIPPED = " %d/3 Test #%d: %s ......................***Skipped   0.01 sec"


def said(*skipped, call=("scripts/test",)):
    with tempfile.TemporaryDirectory() as name:
        desk = pathlib.Path(name)
        for folder in ("scripts", "bin", ".ci", "build/release"):
            (desk / folder).mkdir(parents=True)
        for script in ("scripts/test", ".ci/run"):
            shutil.copy(source.ROOT / script, desk / script)
        lines = "\n".join(SKIPPED % (k, k, test) for k, test in enumerate(skipped, 2))
        for path, text in {"scripts/setup": "#!/bin/sh\n", "scripts/build": "#!/bin/sh\n",
                           "bin/ctest": CTEST % {"all": 1 + len(skipped), "lines": lines}}.items():
            (desk / path).write_text(text)
            (desk / path).chmod(0o755)
        ended = subprocess.run([desk / call[0], *call[1:]], cwd=desk, capture_output=True, text=True,
                               env={**os.environ, "PATH": f"{desk / 'bin'}:{os.environ['PATH']}"})
        return ended.returncode, ended.stdout.splitlines()


class Skips(unittest.TestCase):
    def test_a_run_without_fuzzing_says_so_beside_its_count(self):
        for call, passed in ((("scripts/test",), 1), ((".ci/run",), 2)):
            code, lines = said("fuzz", "report.browser", call=call)
            self.assertEqual(code, 0)
            self.assertEqual(lines[-1], f"{passed} passed, 0 failed, 2 skipped")
            self.assertIn("test: skipped: fuzz, report.browser", lines)
            self.assertIn("test: NOTHING WAS FUZZED: no clang++ with OpenMP and fuzzer is here; scripts/setup --fuzz "
                          "installs them", lines)

    def test_what_takes_minutes_runs_while_there_is_time_and_is_missed_aloud(self):
        missed = "test: THE TESTS OF MINUTES DID NOT RUN"
        for minutes, passed in ((60, 2), (0, 1)):
            code, lines = said(call=("scripts/test", "--nightly-before", str(minutes)))
            self.assertEqual((code, lines[-1]), (0, f"{passed} passed, 0 failed"))
            self.assertEqual(any(line.startswith(missed) for line in lines), passed == 1)
        self.assertFalse([line for line in said()[1] if line.startswith(missed)])

    def test_a_whole_run_says_nothing_of_it(self):
        code, lines = said()
        self.assertEqual((code, lines[-1]), (0, "1 passed, 0 failed"))
        self.assertFalse([line for line in lines if "skipped:" in line or "FUZZED" in line])


unittest.main()
