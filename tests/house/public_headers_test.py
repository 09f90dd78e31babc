"""Each header of the library's front door compiles alone, and needs nothing but the standard library and its like.
Called by ctest: public_headers_test.py COMPILER [TEST...]"""
import subprocess, sys, unittest

import source

COMPILER = sys.argv[1]


def complaints(header):
    """What the compiler says of a header that is included alone."""
    made = subprocess.run([COMPILER, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++",
                           "-I", str(source.ROOT / "include"), "-include", str(source.ROOT / header), "/dev/null"],
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return made.stdout if made.returncode else ""


def foreign(header):
    """(include, line) of what the library's users may not have."""
    for kind, name, line in source.tokens(header):
        ours = name[:1] == '"' and name[1:-1].startswith("servodx/")
        standard = name[:1] == "<" and "/" not in name and "." not in name
        if kind == "include" and not ours and not standard:
            yield name, line


class PublicHeaders(unittest.TestCase):
    def test_each_compiles_alone(self):
        headers = source.files("include/servodx", kinds=("h",))
        self.assertGreater(len(headers), 3)
        for header in headers:
            self.assertFalse(complaints(header), header)

    def test_they_include_the_standard_library_and_each_other_alone(self):
        for header in source.files("include", kinds=("h", "hpp", "inc")):
            self.assertFalse([f"{header}:{line}: {name} is not for the library's users" for name, line in foreign(header)])

    def test_a_header_that_needs_another_is_told(self):
        self.assertRegex(complaints("tests/house/not_alone.inc"), "error: .*Log")
        self.assertEqual(list(foreign("tests/house/not_alone.inc")),
                         [('"base/units.h"', 5), ("<Eigen/Dense>", 6), ("<math.h>", 7)])


unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
