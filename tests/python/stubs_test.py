"""The type stubs tell of every public name that is there, and of nothing else; strict mypy takes them."""
import os, pathlib, subprocess, sys, tempfile, unittest

from common import SOURCE, main, sx

try:
    import mypy.stubtest
except ImportError:
    sys.exit(77)

CALLER = '''import servodx as sx

def judge(path: str, tuned: sx.Tuned, baseline: sx.Baseline) -> str:
    verdict = tuned.diagnose(sx.read_log(path, tuned.rig), baseline)
    if verdict.kind == sx.Verdict.Kind.healthy or verdict.severity is None:
        return "healthy"
    return f"{verdict.fault} {verdict.severity.value} {verdict.severity.unit}"
'''
WRONG = '''import servodx as sx

def wrong(verdict: sx.Verdict) -> int:
    return verdict.fault
'''


def mypy_of(*words):
    environment = {**os.environ, "MYPYPATH": sys.argv[1], "PYTHONPATH": sys.argv[1]}
    return subprocess.run([sys.executable, "-m", *words], env=environment, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)


class Stubs(unittest.TestCase):
    def test_they_tell_of_what_is_there(self):
        with tempfile.TemporaryDirectory() as folder:
            settings = pathlib.Path(folder) / "mypy.ini"
            settings.write_text("[mypy]\nignore_missing_imports = True\n")
            allowed = pathlib.Path(folder) / "allowed.txt"
            # A module's parts are its own affair; what pybind11 makes has no signatures, and enums of its own.
            allowed.write_text("servodx\\.(frames|methods|objective|pages|plots|progress|files|toml_text|_servodx).*\n"
                               ".*\\.__(init|getstate|setstate|reduce|new|int|index|hash|eq|ne|doc|str|getitem|iter|len)__\n"
                               ".*\\.(name|value|__members__|__entries)\n")
            ended = mypy_of("mypy.stubtest", "servodx", "--allowlist", str(allowed), "--ignore-unused-allowlist",
                            "--mypy-config-file", str(settings), "--concise")
        said = [line for line in ended.stdout.splitlines() if line and "metaclass differs" not in line]  # pybind11's
        self.assertFalse(said)

    def test_mypy_takes_a_right_call_and_refuses_a_wrong_one(self):
        with tempfile.TemporaryDirectory() as folder:
            for text, code in ((CALLER, 0), (WRONG, 1)):
                script = pathlib.Path(folder) / "caller.py"
                script.write_text(text)
                ended = mypy_of("mypy", "--strict", "--ignore-missing-imports", "--cache-dir", folder, str(script))
                self.assertEqual(ended.returncode, code, ended.stdout[:3000])

    def test_the_package_says_that_it_is_typed(self):
        self.assertTrue((pathlib.Path(sx.__file__).parent / "py.typed").exists())
        for name in sx.__all__:
            self.assertIn(name, (SOURCE / "python/servodx/__init__.pyi").read_text())


main()
