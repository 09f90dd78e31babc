"""Recipes read as recipes: each is a page of named calls, and what it calls is a file a concept. Called by ctest."""
import collections, unittest

import source

# What a user asks for, from its inputs to its answer: path, the function that is the recipe.
RECIPES = {
    "src/diagnose/diagnose.cpp": "assess_pool",
    "src/diagnose/hypotheses.cpp": "fit_hypotheses",
    "src/explain/explain.cpp": "explain_logs",
    "src/prognose/trend.cpp": "trend",
    "src/tune/tune.cpp": "tune_table",
}
PAGE = 220  # lines of a file that is a recipe, with the small steps that only it takes
SCREEN = 70  # lines of the recipe itself

LONGEST = 500  # lines of any file
LONGER = {  # path: why it may be longer
    "src/optimise/box_least_squares.cpp": "one search: a class whose steps share its state",
    "src/signals/signal_words.cpp": "a list of words, one a line",
}

# Folders in which a name stands for one thing: a function that a file keeps to itself has no namesake in another.
TOLD_APART = ("src/diagnose", "src/evidence", "src/explain", "src/tune")
# Names that every file may give to its own: what a checkpoint keeps of a type.
EVERYWHERE = {"fields"}


def lines(path):
    return source.text(path).count("\n")


def free_functions(path):
    """(name, whether the file keeps it to itself) of every function that belongs to no type."""
    found = set()
    for event, scopes, _, _ in source.walk(path):
        if event != "close" or scopes[-1].kind != "function" or "::" in scopes[-1].name:
            continue
        if all(scope.kind == "namespace" for scope in scopes[:-1]):
            found.add((scopes[-1].name, any(not scope.name for scope in scopes[:-1])))
    return found


def namesakes(functions):
    """Name -> paths, of {path: free functions}: one at least keeps it to itself."""
    paths, kept = collections.defaultdict(list), set()
    for path, held in functions.items():
        for name, own in sorted(held):
            if name not in EVERYWHERE and path not in paths[name]:
                paths[name].append(path)
            kept |= {name} if own else set()
    return {name: held for name, held in paths.items() if len(held) > 1 and name in kept}


class Recipes(unittest.TestCase):
    def test_a_recipe_is_a_page(self):
        for path, recipe in RECIPES.items():
            with self.subTest(path):
                self.assertLessEqual(lines(path), PAGE, "what it calls wants files of their own")
                spans = [ends - begins + 1 for name, begins, ends in source.functions(path) if name == recipe]
                self.assertTrue(spans, f"has no function {recipe}")
                self.assertLessEqual(max(spans), SCREEN, "more than a screen of calls")

    def test_a_file_is_a_concept(self):
        long_ones = {path: lines(path) for path in source.files("src", kinds=("h", "cpp")) if lines(path) > LONGEST}
        self.assertFalse({path: n for path, n in long_ones.items() if path not in LONGER})
        self.assertFalse(sorted(LONGER.keys() - long_ones.keys()), "not long, or not there: take them off the list")

    def test_functions_of_a_folder_are_told_apart(self):
        for folder in TOLD_APART:
            with self.subTest(folder):
                functions = {path: free_functions(path) for path in source.files(folder, kinds=("cpp",))}
                self.assertGreater(sum(map(len, functions.values())), 15)
                self.assertFalse(namesakes(functions))

    def test_a_namesake_is_found(self):
        own, shared = ("visible_of", True), ("visible_of", False)
        self.assertEqual(namesakes({"a.cpp": {own}, "b.cpp": {own}}), {"visible_of": ["a.cpp", "b.cpp"]})
        self.assertEqual(namesakes({"a.cpp": {own}, "b.cpp": {shared}}), {"visible_of": ["a.cpp", "b.cpp"]})
        self.assertFalse(namesakes({"a.cpp": {shared}, "b.cpp": {shared}}), "overloads, which headers declare")
        self.assertFalse(namesakes({"a.cpp": {("fields", True)}, "b.cpp": {("fields", True)}}))


if __name__ == "__main__":
    unittest.main(verbosity=2)
