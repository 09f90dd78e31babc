"""No test ends by a limit of time on a busy machine or under sanitizers. Called by ctest: CTEST BUILD_DIR."""
import json, pathlib, re, subprocess, sys, unittest

CTEST, BUILD = sys.argv[1:3]
LEAST = 14400  # [s]
TESTS = pathlib.Path(__file__).resolve().parents[1]
# Of C++: a clock compared, a wait of so long, so many naps, a call that is cut off.
BY_THE_CLOCK = [re.compile(pattern, re.S) for pattern in (
    r"_clock::now\(\)\s*[<>+]", r"[<>]=?\s*std::chrono::\w+_clock::now", r"\btimeout (?:--|-s |\d)",
    r"_clock::now\(\)\s*-[^;{}]*?(?<![<>-])[<>](?![<>])", r"(?:EXPECT|ASSERT)_[LG][TE]\([^;]*_clock::now\(\)",
    r"(?:\.|->)wait_(?:for|until)\(",
    r"\bfor \([^{};]*;[^{};]*<[^{};]*;[^{};]*\) \{(?:(?!\n  ?\}|\n\}).)*?sleep_for\(std::chrono::(?:milli)?seconds")]


def waits(text):
    """What waits by the clock, with what stands before it."""
    return [match[0][-80:] for rule in BY_THE_CLOCK for match in rule.finditer(text)]


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
            self.assertFalse(waits(path.read_text()), path.relative_to(TESTS))

    def test_waits_by_the_clock_are_found(self):
        now = "std::chrono::steady_clock::now()"
        nap = "std::this_thread::sleep_for(std::chrono::milliseconds(50));"
        for text in (f"while ({now} < end) go();", f"while (end > {now}) go();", f"auto end = {now} + limit;",
                     f"while ({now} - start < std::chrono::seconds(5)) go();",
                     f"EXPECT_TRUE(std::chrono::duration<double>({now} - start).count() <= 5);",
                     f"EXPECT_LT({now} - start, limit);", "ready.wait_for(lock, limit);",
                     "done->wait_until(lock, end);", 'run("timeout 60 servodx");',
                     f"for (int k = 0; k < 100; ++k) {{\n    {nap}\n  }}"):
            self.assertTrue(waits(text), text)
        for text in (f"const auto start = {now};", f"std::cout << ({now} - start).count() << \" s\";",
                     f"while (is_alive(pid)) {{\n    {nap}\n  }}", "wait_for(desk, pid, key, holds);",
                     f"const auto t = [&] {{ return ({now} - start).count(); }}; f(a < b);"):
            self.assertFalse(waits(text), text)


unittest.main(argv=sys.argv[:1])
