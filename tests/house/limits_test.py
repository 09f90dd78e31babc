"""No test ends by a limit of time on a busy machine or under sanitizers. Called by ctest: CTEST BUILD_DIR."""
import json, pathlib, re, subprocess, sys, unittest

CTEST, BUILD = sys.argv[1:3]
LEAST = 14400  # [s]
TESTS = pathlib.Path(__file__).resolve().parents[1]
# Of C++: a clock compared, a wait of so long, so many naps, a call that is cut off.
BY_THE_CLOCK = [re.compile(pattern, re.S) for pattern in (
    r"_clock::now\(\)\s*[<>+]", r"[<>]=?\s*std::chrono::\w+_clock::now", r"\btimeout (?:--|-s |\d)",
    r"\bfor \([^{};]*;[^{};]*<[^{};]*;[^{};]*\) \{(?:(?!\n  ?\}|\n\}).)*?sleep_for\(std::chrono::(?:milli)?seconds")]


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

    def test_no_test_waits_by_the_clock(self):
        """It waits while what it waits for may come: while the child lives, until the other thread has begun."""
        for path in sorted(TESTS.rglob("*.cpp")) + sorted(TESTS.rglob("*.h")):
            text = path.read_text()
            for rule in BY_THE_CLOCK:
                found = rule.search(text)
                self.assertIsNone(found, f"{path.relative_to(TESTS)}: {found and found[0][-80:]}")


unittest.main(argv=sys.argv[:1])
