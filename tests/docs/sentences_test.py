"""Prose of the docs is readable: sentences of at most 25 words on average and 60 at the longest, page by page; no
relative link is dead. Called by ctest.

Not prose: code fences, indented formulas, tables, headings, the targets of links. Lines of a paragraph go together, a
list item stands by itself. A sentence ends at a full stop, question or exclamation mark before white space; a colon or
a semicolon ends none. Code in backticks is one word. Pages of docs/lab are a diary: their links are followed, their
prose is free."""
import pathlib, re, unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
AVERAGE, LONGEST = 25, 60  # words of a sentence
FENCE = re.compile(r"^(```|~~~).*?^\1[^\n]*$", re.S | re.M)
ITEM = re.compile(r"^\s*(?:[-*+]|\d+[.)])\s+")
LINK = re.compile(r"!?\[([^\]]*)\]\(([^)\s]+)\)")
# Full stops that end no sentence.
SHORT = re.compile(r"\b(e\.g|i\.e|cf|vs|Fig|Figs|Eq|Eqs|No|Nos|Sec|p|pp|approx|et al|Dr)\.")


def prose_pages():
    return [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "docs/derivations").glob("*.md"))]


def all_pages():
    return [*prose_pages(), ROOT / "CHANGELOG.md", ROOT / "CONTRIBUTING.md", ROOT / "data" / "README.md",
            *sorted((ROOT / "docs" / "lab").rglob("*.md"))]


def paragraphs(text):
    """Paragraphs and list items, each as one line of prose."""
    found, lines = [], []
    for line in [*FENCE.sub("\n\n", text).splitlines(), ""]:
        if line.startswith("    ") and not lines:  # a formula
            continue
        item, bare = ITEM.match(line), line.strip()
        if item or not bare or bare.startswith(("#", "|", "<!--")) or re.fullmatch(r"[-=*_]{3,}", bare):
            if lines:
                found.append(" ".join(lines))
            lines = [line[item.end():].strip()] if item else []
        else:
            lines.append(bare.lstrip("> "))
    return found


def sentences(text):
    """Words of each sentence of a page."""
    for paragraph in paragraphs(text):
        plain = LINK.sub(r"\1", re.sub(r"`[^`]*`", "code", paragraph))
        plain = SHORT.sub(r"\1", plain)
        for sentence in re.split(r"(?<=[.!?])[\"')\]*_]*\s+", plain):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if words:
                yield words


def anchors(page):
    """Names under which the headings of a page can be linked to: as GitHub makes them, repeats numbered."""
    found, seen = set(), {}
    for head in re.findall(r"^#+ +(.*)$", FENCE.sub("", page.read_text()), re.M):
        name = re.sub(r"[^\w\- ]", "", LINK.sub(r"\1", head).lower()).strip().replace(" ", "-")
        seen[name] = seen.get(name, -1) + 1
        found.add(f"{name}-{seen[name]}" if seen[name] else name)
    return found


def dead_links(page, text):
    """Relative links of a page that lead nowhere."""
    for _, target in LINK.findall(re.sub(r"`[^`\n]*`", "", FENCE.sub("", text))):
        if re.match(r"[a-z][a-z+.-]*:", target):
            continue
        path, _, anchor = target.partition("#")
        to = (page.parent / path).resolve() if path else page
        if not to.exists():
            yield f"{page.relative_to(ROOT)}: {target} is no file"
        elif anchor and (to.suffix != ".md" or anchor not in anchors(to)):
            yield f"{page.relative_to(ROOT)}: {target} is no heading"


class Sentences(unittest.TestCase):
    def test_sentences_are_short(self):
        said, seen = [], 0
        for page in prose_pages():
            counted = list(sentences(page.read_text()))
            self.assertTrue(counted, f"{page.name} has no prose")
            seen += len(counted)
            average, longest = sum(map(len, counted)) / len(counted), max(counted, key=len)
            if average > AVERAGE:
                said.append(f"{page.name}: {average:.1f} words a sentence on average")
            said += [f"{page.name}: {len(words)} words: {' '.join(words)[:90]} ..." for words in counted
                     if len(words) > LONGEST]
        self.assertGreater(seen, 500)
        self.assertFalse(said, "\n" + "\n".join(said))

    def test_links_lead_somewhere(self):
        said = [why for page in all_pages() for why in dead_links(page, page.read_text())]
        self.assertFalse(said, "\n" + "\n".join(said))

    def test_each_page_leads_to_the_glossary(self):
        without = [page.relative_to(ROOT).as_posix() for page in prose_pages()
                   if page.name != "glossary.md" and not re.search(r"\]\([^)]*glossary\.md[)#]", page.read_text())]
        self.assertFalse(without)

    def test_what_is_wrong_is_told(self):
        long = "word " * 61
        counts = lambda text: [len(words) for words in sentences(text)]
        self.assertEqual(counts(long + "."), [61])
        self.assertEqual(counts(f"# {long}\n\n| {long} |\n\n```\n{long}\n```\n"), [])
        self.assertEqual(counts("One two,\nthree. Four: five; six e.g. seven.\n- eight\n- nine ten\n"), [3, 5, 1, 2])
        self.assertEqual(counts("See [the page](a.md#b-c) of `servodx tune a.csv`. **Bold.** More here."), [5, 1, 2])
        readme = ROOT / "README.md"
        self.assertEqual(len(list(dead_links(readme, "[a](no_such.md) [b](#no-such) [c](docs/model.md#no-such)"))), 3)
        self.assertEqual(list(dead_links(readme, "[a](docs/model.md) [b](https://x.org/y) `[c](d)`")), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
