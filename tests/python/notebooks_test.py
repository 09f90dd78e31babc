"""The notebooks run from top to bottom, and are stored without outputs."""
import os, pathlib, sys, tempfile, unittest

from common import PROGRAM, SOURCE, main

try:
    import nbclient, nbformat
except ImportError:
    sys.exit(77)

NOTEBOOKS = sorted((SOURCE / "examples/notebooks").glob("*.ipynb"))


class Notebooks(unittest.TestCase):
    def test_they_are_stored_without_outputs(self):
        self.assertGreaterEqual(len(NOTEBOOKS), 4)
        for path in NOTEBOOKS:
            book = nbformat.read(path, as_version=4)
            nbformat.validate(book)
            for cell in book.cells:
                if cell.cell_type == "code":
                    self.assertFalse(cell.outputs or cell.execution_count, path.name)


def runs(path):
    def test(self):
        was = dict(os.environ)
        with tempfile.TemporaryDirectory() as folder:
            os.environ.update(PYTHONPATH=str(pathlib.Path(sys.argv[1]).resolve()), PATH=f"{pathlib.Path(PROGRAM).parent}:{os.environ['PATH']}",
                              IPYTHONDIR=folder, JUPYTER_RUNTIME_DIR=folder, PYTHONDONTWRITEBYTECODE="1")
            try:
                book = nbformat.read(path, as_version=4)
                client = nbclient.NotebookClient(book, timeout=3000, startup_timeout=3000, kernel_name="python3",
                                                 resources={"metadata": {"path": str(path.parent)}})
                client.execute()
            finally:
                os.environ.clear()
                os.environ.update(was)
        shown = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
        self.assertTrue(any("image/png" in output.get("data", {}) for output in shown), "no picture was drawn")
        self.assertTrue(any("text/html" in output.get("data", {}) for output in shown), "no result shows its head")
    return test


for notebook in NOTEBOOKS:
    setattr(Notebooks, f"test_{notebook.stem}_runs", runs(notebook))

main()
