"""A note's kind means something: each has its own name as its word, and is made somewhere. Called by ctest."""
import re, unittest

import source

HEADER, WORDS = "include/servodx/note.h", "src/base/note.cpp"


def kinds():
    """The kinds, in their order."""
    listed = re.search(r"enum class Kind \{(.*?)\};", source.text(HEADER), re.S)
    return re.findall(r"^ +(\w+),", listed[1], re.M)


def made(tokens):
    """Kinds that are given to a note; one that a note's kind is only compared with is not."""
    for at in range(4, len(tokens)):
        if [value for _, value, _ in tokens[at - 4:at]] == ["Note", "::", "Kind", "::"]:
            if not {"==", "!="} & {tokens[at - 5][1], tokens[at + 1][1]}:
                yield tokens[at][1]


class Notes(unittest.TestCase):
    def test_each_kind_has_its_name_as_its_word(self):
        words = [value for kind, value, _ in source.tokens(WORDS) if kind == "string"]
        self.assertGreater(len(words), 30)
        self.assertEqual(words, kinds())

    def test_each_kind_is_made_by_the_library(self):
        found = {kind for path in source.files("src") for kind in made(source.tokens(path))}
        self.assertEqual(sorted(found), sorted(kinds()))

    def test_a_comparison_makes_no_note(self):
        tokens = source.tokens("tests/house/notes.inc")
        self.assertEqual(list(made(tokens)), ["gaps", "oil"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
