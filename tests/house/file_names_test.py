"""No two files of src have one name, but where a name says what the folder has of its own. Called by ctest."""
import collections, pathlib, unittest

import source

# One a folder, of the same kind: name, what it holds.
ONE_A_FOLDER = {
    "constants.h": "the numbers that decide there",
    "kept.h": "what a checkpoint keeps of its stages",
    "registry.h": "the visible list of what it is made of",
    "registry.cpp": "the visible list of what it is made of",
}


def colliding(paths):
    """Name -> paths, of the names that more than one folder has. A page of the report is called as what it shows."""
    found = collections.defaultdict(list)
    for path in paths:
        name = path.rsplit("/", 1)[-1]
        if name not in ONE_A_FOLDER and not path.startswith("src/report/"):
            found[name].append(path)
    return {name: held for name, held in found.items() if len(held) > 1}


class FileNames(unittest.TestCase):
    def test_names_tell_files_apart(self):
        paths = source.files("src")
        self.assertGreater(len(paths), 300)
        self.assertFalse(colliding(paths))

    def test_what_is_excepted_is_there_more_than_once(self):
        names = collections.Counter(pathlib.PurePosixPath(path).name for path in source.files("src"))
        self.assertFalse([name for name in ONE_A_FOLDER if names[name] < 2], "take it off the list")

    def test_a_collision_is_found(self):
        self.assertEqual(colliding(["src/a/x.h", "src/b/x.h", "src/b/y.h", "src/a/constants.h", "src/b/constants.h",
                                    "src/report/b/y.h"]), {"x.h": ["src/a/x.h", "src/b/x.h"]})


if __name__ == "__main__":
    unittest.main(verbosity=2)
