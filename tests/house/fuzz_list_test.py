"""The list of sources that the fuzz targets are built from names files that exist. Called by ctest; the targets
themselves are built in the nightly run, where clang is."""
import pathlib, re, unittest

import source


def listed(text):
    """Paths of the files that the calls `needs(FOLDER NAME...)` of a CMake file name."""
    return [f"src/{folder}/{name}.cpp" for folder, names in re.findall(r"^needs\(([\w/]+)\s([^)]*)\)", text, re.M)
            for name in names.split()]


class FuzzList(unittest.TestCase):
    def test_each_listed_file_exists(self):
        paths = listed((source.ROOT / "fuzz" / "CMakeLists.txt").read_text())
        self.assertGreater(len(paths), 50)
        self.assertFalse([path for path in paths if not (source.ROOT / path).is_file()])

    def test_a_list_over_two_lines_is_read_whole(self):
        self.assertEqual(listed("needs(fit a\n      b)\nneeds(report/x c)\n"),
                         ["src/fit/a.cpp", "src/fit/b.cpp", "src/report/x/c.cpp"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
