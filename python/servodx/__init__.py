"""servodx: faults of electrohydraulic servovalves from rig logs.

    import servodx as sx
    rig = sx.Rig("rig.toml")
    tuned = sx.tune([sx.read_log(p, rig) for p in good], params=sx.Table.load("params.csv"), rig=rig)
    baseline = tuned.baseline([sx.read_log(p, rig) for p in others])
    print(tuned.diagnose(sx.read_log("suspect.csv", rig), baseline))

Values are SI. Calls leave the interpreter free, Ctrl-C ends them, and `progress` is called as progress(work, part,
simulations). A bad input raises InputError with file, line, column, rule and mend.
"""
from ._servodx import (Baseline, Explanation, InputError, Log, Rig, Row, Severity, Table, Tuned, Verdict, make_log,
                       read_log, simulate, tune)

__all__ = ["Baseline", "Explanation", "InputError", "Log", "Rig", "Row", "Severity", "Table", "Tuned", "Verdict",
           "frame_of", "log_of", "make_log", "read_log", "simulate", "tune"]


def log_of(data, units=None, rig=None, name="log in memory"):
    """A log from a DataFrame or a mapping of columns, (samples,) each.

    Columns are named as in a file, "pressure_a [bar]"; or `units` gives the unit of a bare name."""
    units = units or {}
    columns = {f"{c} [{units[c]}]" if c in units else c: data[c] for c in data}
    return make_log(name, columns, Rig() if rig is None else rig)


def frame_of(log):
    """The log as a DataFrame, a column a signal, in SI; index: time [s]."""
    import pandas
    return pandas.DataFrame(log.signals, index=pandas.Index(log.time, name="time"))
