"""Figures of the docs are what scripts/figures draws from the sources and pages as they are: each is there, small, shown
with words in its place, and fails to be drawn where a source no longer holds what it shows. Called by ctest."""
import importlib.machinery, importlib.util, pathlib, re, shutil, sys, tempfile, unittest
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMITTED, MOST_BYTES, WIDEST = ROOT / "docs/figures", 300_000, 900
SVG = "{http://www.w3.org/2000/svg}"


def script():
    loader = importlib.machinery.SourceFileLoader("figures", str(ROOT / "scripts/figures"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("figures", loader))
    loader.exec_module(module)
    return module


FIGURES = script()


def sources(folder):
    """What figures are drawn from, to be changed there."""
    root = pathlib.Path(folder)
    for part in ("src/faults", "src/effects", "src/parameters"):
        shutil.copytree(ROOT / part, root / part)
    (root / "docs").mkdir()
    for page in ("model.md", "accuracy.md"):
        shutil.copy(ROOT / "docs" / page, root / "docs")
    return root


def change(path, old, new):
    text = path.read_text()
    if old not in text:
        raise AssertionError(f"{path.name} has no '{old}'")
    path.write_text(text.replace(old, new))


def add_fault(root, moves):
    """A fault `bent_rod`, whose `apply` moves a row or an effect."""
    text = (ROOT / "src/faults/null_shift.h").read_text()
    (root / "src/faults/bent_rod.h").write_text(text.replace("null_shift", "bent_rod").replace("row::servovalve_null]", moves))
    change(root / "src/faults/registry.cpp", "      &driver_fault,  ", "      &driver_fault,\n      &bent_rod,  ")


class Figures(unittest.TestCase):
    def test_what_is_committed_is_what_the_script_draws(self):
        self.assertEqual({path.name for path in COMMITTED.iterdir()}, {f"{name}.svg" for name in FIGURES.FIGURES})
        with tempfile.TemporaryDirectory() as folder:
            FIGURES.draw_all(pathlib.Path(folder))
            stale = [path.name for path in sorted(pathlib.Path(folder).iterdir())
                     if path.read_bytes() != (COMMITTED / path.name).read_bytes()]
        self.assertFalse(stale, "is stale: run scripts/figures, look at it, and commit it")

    def test_each_is_small_and_says_what_it_shows(self):
        for path in COMMITTED.iterdir():
            self.assertLessEqual(path.stat().st_size, MOST_BYTES, path.name)
            drawn = xml.parse(path).getroot()
            self.assertLessEqual(int(drawn.get("width")), WIDEST, path.name)
            for part in ("title", "desc"):
                self.assertTrue(drawn.find(SVG + part).text, f"{path.name} has no {part}")
            links = [image.get("href") for image in drawn.iter(SVG + "image")]
            self.assertTrue(all(link.startswith("data:") for link in links), path.name)

    def test_each_is_shown_once_with_words_in_its_place(self):
        pages = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
        shown = [found for page in pages for found in re.findall(r"!\[([^\]]*)\]\((?:docs/)?figures/([^)]*)\)", page.read_text())]
        self.assertEqual(sorted(name for _, name in shown), sorted(path.name for path in COMMITTED.iterdir()))
        for words, name in shown:
            self.assertGreater(len(words.split()), 10, name)


class Model(unittest.TestCase):
    def test_a_new_fault_is_drawn_where_its_row_acts(self):
        with tempfile.TemporaryDirectory() as folder:
            root = sources(folder)
            add_fault(root, "row::piston_coulomb_friction]")
            drawn = FIGURES.FIGURES["model"](root).svg()
        self.assertIn("7. Piston: bent_rod", drawn)
        self.assertNotEqual(drawn, (COMMITTED / "model.svg").read_text())

    def test_a_fault_that_no_stage_holds_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            root = sources(folder)
            add_fault(root, "effect_row<NozzleLand>(0)]")
            with self.assertRaisesRegex(FIGURES.shapes.Refused, "bent_rod acts at 'first_stage' by nozzle_land"):
                FIGURES.FIGURES["model"](root)

    def test_each_fault_stands_in_one_stage(self):
        drawn = (COMMITTED / "model.svg").read_text()
        faults = re.findall(r"^ +&(\w+),", (ROOT / "src/faults/registry.cpp").read_text(), re.M)
        self.assertGreater(len(faults), 10)
        self.assertEqual([fault for fault in faults if len(re.findall(rf">{fault}</text>", drawn)) != 1], [])


class Chain(unittest.TestCase):
    def test_a_function_that_has_gone_is_told(self):
        for functions in ({"no_such_function": "src/diagnose/decide.cpp"}, {"decide": "src/diagnose/no_such.cpp"}):
            with self.assertRaisesRegex(FIGURES.shapes.Refused, "which the figure shows"):
                FIGURES.chain.names_of(ROOT, functions)
        self.assertEqual(FIGURES.chain.names_of(ROOT, {"decide": "src/diagnose/decide.cpp"}), "decide")


class Accuracy(unittest.TestCase):
    PAGE = (ROOT / "docs/accuracy.md").read_text()

    def test_intervals_are_those_of_the_page(self):
        cells = " ".join(next(row for row in FIGURES.accuracy.table_of(self.PAGE) if row[0] == "**in per cent**"))
        counts = [count for _, _, rows in FIGURES.accuracy.groups_of(FIGURES.accuracy.counts_of(self.PAGE)) for _, count in rows]
        self.assertEqual(len(counts), 8)
        for count in counts:
            self.assertIn(count.words().replace(" %", ""), cells)

    def test_another_count_is_another_figure(self):
        with tempfile.TemporaryDirectory() as folder:
            root = sources(folder)
            severe = FIGURES.accuracy.counts_of(self.PAGE).severe.hits
            change(root / "docs/accuracy.md", f"**{severe}, ", f"**{severe - 1}, ")
            drawn = FIGURES.FIGURES["accuracy"](root).svg()
        self.assertIn(f"{severe - 1} of ", drawn)
        self.assertNotEqual(drawn, (COMMITTED / "accuracy.svg").read_text())

    def test_a_table_of_another_form_is_told(self):
        with self.assertRaisesRegex(FIGURES.shapes.Refused, "no row"):
            FIGURES.accuracy.counts_of(self.PAGE.replace("**together**", "**pooled**"))

    def test_a_rig_counts_where_it_was_judged_alone(self):
        first = next(row for row in FIGURES.accuracy.table_of(self.PAGE) if re.match(r"\d+:", row[0]))
        line = next(text for text in self.PAGE.splitlines() if text.startswith(f"| {first[0]} "))
        counts, without = (FIGURES.accuracy.counts_of(page) for page in
                           (self.PAGE, self.PAGE.replace(line, line.replace(f"| {first[2]} |", "| - |"))))
        self.assertEqual(without.diagnosed_rigs, counts.diagnosed_rigs - 1)
        self.assertEqual((without.rigs, without.explained_rigs), (counts.rigs, counts.explained_rigs))


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    unittest.main(verbosity=2)
