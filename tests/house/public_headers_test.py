"""Each header of the library's front door compiles alone, and needs nothing but the standard library and its like.
Called by ctest: public_headers_test.py COMPILER [TEST...]"""
import subprocess, sys, unittest

import source

COMPILER = sys.argv[1]


class PublicHeaders(unittest.TestCase):
    def test_each_compiles_alone(self):
        headers = source.files("include/servodx", kinds=("h",))
        self.assertGreater(len(headers), 3)
        for header in headers:
            made = subprocess.run([COMPILER, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++",
                                   "-I", str(source.ROOT / "include"), "-include", str(source.ROOT / header), "/dev/null"],
                                  text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            self.assertEqual(made.returncode, 0, f"{header}:\n{made.stdout[:3000]}")

    def test_they_include_the_standard_library_and_each_other_alone(self):
        for header in source.files("include", kinds=("h", "hpp", "inc")):
            for kind, name, line in source.tokens(header):
                if kind != "include":
                    continue
                ours = name[0] == '"' and name[1:-1].startswith("servodx/")
                standard = name[0] == "<" and "/" not in name and "." not in name
                self.assertTrue(ours or standard, f"{header}:{line}: {name} is not for the library's users")


unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
