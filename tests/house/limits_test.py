"""No test ends by a limit of time on a busy machine or under sanitizers. Called by ctest: CTEST BUILD_DIR."""
import json, subprocess, sys, unittest

CTEST, BUILD = sys.argv[1:3]
LEAST = 14400  # [s]


class Limits(unittest.TestCase):
    def test_every_test_has_four_hours(self):
        listed = json.loads(subprocess.run([CTEST, "--test-dir", BUILD, "--show-only=json-v1"], capture_output=True,
                                           text=True, check=True).stdout)["tests"]
        self.assertGreater(len(listed), 20)
        for test in listed:
            if test["name"].endswith("_NOT_BUILT"):
                continue  # a test program that this build left out
            limit = {p["name"]: p["value"] for p in test.get("properties", [])}.get("TIMEOUT")
            self.assertIsNotNone(limit, f"{test['name']}: ctest's own limit of 1500 s holds")
            self.assertGreaterEqual(limit, LEAST, test["name"])


unittest.main(argv=sys.argv[:1])
