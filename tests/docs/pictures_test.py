"""Pictures of the docs: each that scripts/pictures makes is there, small, and shown; without a browser the script says
what to install. Called by ctest."""
import importlib.machinery, importlib.util, pathlib, re, subprocess, sys, unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def script():
    loader = importlib.machinery.SourceFileLoader("pictures", str(ROOT / "scripts/pictures"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("pictures", loader))
    loader.exec_module(module)
    return module


class Pictures(unittest.TestCase):
    def test_each_picture_is_there_small_and_shown(self):
        pictures = script()
        made = {f"{name}.png" for name, *_ in pictures.SHOTS}
        self.assertEqual({path.name for path in (ROOT / "docs/pictures").iterdir()}, made)
        for name in made:
            self.assertLessEqual((ROOT / "docs/pictures" / name).stat().st_size, pictures.MOST_BYTES, name)
        pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
        shown = {name for page in pages for name in re.findall(r"!\[[^\]]*\]\([^)]*pictures/([^)]*)\)", page.read_text())}
        self.assertEqual(shown, made)

    def test_without_a_browser_it_says_what_to_install(self):
        ended = subprocess.run([sys.executable, str(ROOT / "scripts/pictures")], env={"PATH": "/nowhere"}, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(ended.returncode, 2, ended.stderr)
        self.assertIn("chromium is missing; the package chromium brings it", ended.stderr)


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    unittest.main(verbosity=2)
