"""servodx: faults of electrohydraulic servovalves from rig logs.

    import servodx as sx
    rig = sx.Rig("rig.toml")
    tuned = sx.tune([sx.read_log(p, rig) for p in good], params=sx.Table.load("params.csv"), rig=rig)
    baseline = tuned.baseline([sx.read_log(p, rig) for p in others])
    print(tuned.diagnose(sx.read_log("suspect.csv", rig), baseline))

Values are SI; a table is a DataFrame with the units of its columns in `attrs["units"]`. Calls leave the interpreter free
and Ctrl-C ends them. `progress` is True for a bar where a person looks on, False for none, or called as progress(work,
part, simulations). A bad input raises InputError with file, line, column, rule, mend and code. Start worker processes
by "spawn": one that was forked works on one thread.
"""
import os

# Before the library's threads are there: where others run as well, threads that wait must sleep soon, as the program's do.
if "OMP_WAIT_POLICY" not in os.environ:
    os.environ.setdefault("GOMP_SPINCOUNT", "10000")

from . import frames, methods, pages, plots
from ._servodx import (ActionClass, Baseline, Checked, Curves, Explanation, Fleet, History, InputError, Log, Note,
                       ObjectiveEnd, Plan, Replay, Rig, Row, RowVerdict, Severity, Simulation, Table, Trend, Tuned,
                       Verdict, __version__, curves, make_log, read_log, replay, simulate, trend, tune)
from .frames import UNITS, frame_of, log_of
from .objective import Objective

__all__ = ["ActionClass", "Baseline", "Checked", "Curves", "Explanation", "Fleet", "History", "InputError", "Log",
           "Note", "Objective", "ObjectiveEnd", "Plan", "Replay", "Rig", "Row", "RowVerdict", "Severity", "Simulation",
           "Table", "Trend", "Tuned", "UNITS", "Verdict", "__version__", "curves", "frame_of", "log_of", "make_log",
           "read_log", "replay", "simulate", "trend", "tune"]

methods.attach()
plots.attach()
pages.attach()
