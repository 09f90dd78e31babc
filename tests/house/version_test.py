"""The version stands once, in CMakeLists.txt. Called by ctest."""
import re, tomllib, unittest

import source

# What builds and packs, and what users read. Recorded results (fuzz/corpus, tests) keep the version that made them, and
# the CHANGELOG names those of the past.
FOLDERS = ("src", "include", "apps", "python", "cmake", "scripts", "docs", "examples")
FILES = ("CMakeLists.txt", "CMakePresets.json", "Containerfile", "README.md", "CONTRIBUTING.md", "pyproject.toml")


def version():
    return re.search(r"^project\(servodx VERSION ([0-9.]+)", source.text("CMakeLists.txt"), re.M)[1]


def places(which):
    """Lines of the sources that hold a version."""
    alone = re.compile(rf"(?<![\d.]){re.escape(which)}(?![\d.]*\d)")
    for path in [*FILES, *(f for folder in FOLDERS for f in map(str, (source.ROOT / folder).rglob("*")))]:
        file = source.ROOT / path
        if not file.is_file() or file.suffix in (".png", ".pyc", ".csv", ".ipynb"):
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if alone.search(line):
                yield f"{file.relative_to(source.ROOT)}:{number}: {line.strip()[:80]}"


class Version(unittest.TestCase):
    def test_it_stands_once(self):
        found = list(places(version()))
        self.assertEqual(len(found), 1, "\n" + "\n".join(found))
        self.assertTrue(found[0].startswith("CMakeLists.txt:"))

    def test_the_wheel_reads_it_there(self):
        project = tomllib.loads(source.text("pyproject.toml"))
        self.assertNotIn("version", project["project"])
        self.assertIn("version", project["project"]["dynamic"])
        reads = project["tool"]["scikit-build"]["metadata"]["version"]
        self.assertEqual(reads["provider"], "scikit_build_core.metadata.regex")
        self.assertEqual(re.search(reads["regex"], source.text(reads["input"]), re.M)["value"], version())


if __name__ == "__main__":
    unittest.main(verbosity=2)
