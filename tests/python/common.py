"""What the tests of the Python package share: NAME_test.py PACKAGES SOURCE PROGRAM, called by ctest."""
import functools, pathlib, subprocess, sys, tempfile, unittest

sys.path.insert(0, sys.argv[1])
SOURCE, PROGRAM = pathlib.Path(sys.argv[2]).resolve(), str(pathlib.Path(sys.argv[3]).resolve())
import pandas
import servodx as sx

TUNED_ON = "healthy/h12_mixed"
HEALTHY = ("healthy/h15_no_supply_signals", "healthy/h04_multisine", "healthy/h03_sine_2hz")
SUSPECT = "fault/f02_clogged_filter_severe"


@functools.lru_cache(maxsize=None)
def rig():
    return sx.Rig(SOURCE / "data/rig.toml")


@functools.lru_cache(maxsize=None)
def params():
    return sx.Table.load(SOURCE / "params/borello2009.csv")


def quick():
    return dict(params=params(), rig=rig(), generations=0, rounds=1, effects=[])


def excerpt_text(name, rows):
    """The first samples of a shipped log, as the file has them."""
    lines = (SOURCE / f"data/{name}.csv").read_text().splitlines(keepends=True)
    begin = next(k for k, line in enumerate(lines) if not line.startswith("#"))
    return "".join(lines[:begin + 1 + rows])


def excerpt(name, rows):
    """The same by way of a DataFrame."""
    frame = pandas.read_csv(SOURCE / f"data/{name}.csv", comment="#").head(rows)
    return sx.log_of(frame, rig=rig(), name=name)


@functools.lru_cache(maxsize=None)
def tuned():
    return sx.tune([excerpt(TUNED_ON, 700)], **quick())


@functools.lru_cache(maxsize=None)
def baseline():
    return tuned().baseline([excerpt(name, 300) for name in HEALTHY], false_alarm=0.3)


@functools.lru_cache(maxsize=None)
def suspect():
    return excerpt(SUSPECT, 300)


@functools.lru_cache(maxsize=None)
def verdict():
    return tuned().diagnose(suspect(), baseline())


class Desk(tempfile.TemporaryDirectory):
    """A folder in which the program runs."""

    def __enter__(self):
        super().__enter__()
        return self

    def __truediv__(self, name):
        return pathlib.Path(self.name) / name

    def ran(self, *words):
        ended = subprocess.run([PROGRAM, *map(str, words), "--quiet"], cwd=self.name, text=True, capture_output=True)
        if ended.returncode != 0:
            raise AssertionError(f"{' '.join(map(str, words))}: {ended.returncode}\n{ended.stderr}")
        return ended.stdout


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
