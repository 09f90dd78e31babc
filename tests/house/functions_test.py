"""A function fits on a screen. Called by ctest."""
import unittest

import source

LIMIT = 80  # lines, from the first of its declaration to its closing brace

# (file, function): why it may be longer. Equations are read beside their source, in its order; cut, they are not.
LONGER = {
    ("src/model/derivative.h", "derivative"): "equations of motion; each stage uses terms of those above it",
    ("src/rig/plant.cpp", "Plant::rates"): "equations of motion of the virtual rig, one block a body",
}


class Functions(unittest.TestCase):
    def test_functions_fit_on_a_screen(self):
        seen, long_ones = 0, {}
        for path in source.files("src", "apps"):
            for name, begins, ends in source.functions(path):
                seen += 1
                if ends - begins + 1 > LIMIT:
                    long_ones[path, name] = f"{path}:{begins}: {name} has {ends - begins + 1} lines of {LIMIT} allowed"
        self.assertGreater(seen, 1000)
        self.assertFalse([said for key, said in long_ones.items() if key not in LONGER])
        self.assertFalse(sorted(LONGER.keys() - long_ones.keys()), "not long, or not there: take them off the list")

    def test_functions_are_found_with_their_lines(self):
        """A sample of the ways in which C++ opens a function."""
        made = source.ROOT / "tests/house/sample.inc"
        wanted = [("plain", 2), ("Held::Held", 8), ("Held::get", 10), ("operator==", 14), ("table", 17),
                  ("of_types", 21)]
        found = source.functions(made.relative_to(source.ROOT).as_posix())
        self.assertEqual([(name, begins) for name, begins, _ in found], wanted)
        self.assertEqual([ends - begins + 1 for _, begins, ends in found], [3, 2, 1, 2, 3, 4])


if __name__ == "__main__":
    unittest.main(verbosity=2)
