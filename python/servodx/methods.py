"""What the results have beside their fields: their tables as DataFrames, and calls that take several forms."""
from . import _servodx as core
from .frames import UNITS, frame_of, of_records, of_signals
from .objective import Objective

BY_ROW = "{unit}"  # the column `unit` says it, row by row
PARAMETER = ["id", "name", "nominal", "estimate", "std_error", "unit", "verdict", "confounded_with", "profile_lower",
             "profile_upper"]
PARAMETER_UNITS = dict.fromkeys(("nominal", "estimate", "std_error", "profile_lower", "profile_upper"), BY_ROW)
CHANNEL = ["signal", "rms", "noise_rms", "heldout_rms"]


def _signals_frame(self):
    """A column a signal, in SI; index: time [s]."""
    return frame_of(self)


def _parameters(self):
    """Free rows, effects included: index name; estimate, std_error, verdict, ... in each row's `unit`."""
    return of_records(self._parameters, PARAMETER, PARAMETER_UNITS, "name")


def _channels(self):
    """How well each channel is followed: index signal; rms, noise_rms, heldout_rms in the SI `unit`."""
    rows = [{**row, "unit": UNITS[row["signal"]]} for row in self._channels]
    return of_records(rows, CHANNEL + ["unit"], dict.fromkeys(CHANNEL[1:], BY_ROW), "signal")


def _table_frame(self):
    """The rows: index name; nominal, lower, upper, std_error in each row's `unit`."""
    rows = [{"id": r.id or None, "name": r.name, "group": r.group, "nominal": r.nominal, "lower": r.lower,
             "upper": r.upper, "scale": "log10" if r.log_scale else "lin", "estimate": r.estimate, "unit": r.unit,
             "std_error": r.std_error, "description": r.description, "source": r.source} for r in self.rows]
    return of_records(rows, [], dict.fromkeys(("nominal", "lower", "upper", "std_error"), BY_ROW), "name")


def _scores(self):
    """What each fault-free log scores: index log; score [deviates], adequacy, and the gain of each fault."""
    return of_records(self._scores, ["log", "score", "adequacy"], {"score": "deviates"}, "log")


def _convergence(self):
    """How the misfit fell: stage, simulations, cost. Costs compare within a stage."""
    return of_records(self._convergence, ["stage", "simulations", "cost"])


def _explained_channels(self):
    """Before and after mending: index signal; rms in the SI unit, `unit` is the log's."""
    units = dict.fromkeys(("rms_before", "rms_after", "noise_rms", "heldout_before", "heldout_after"), "SI")
    return of_records(self._channels, ["signal"], units, "signal")


def _candidates(self):
    """All effects that were looked at: effect, where, taken, reason."""
    return of_records(self._candidates, ["effect", "where", "taken", "reason"])


def _figures(self):
    """The checks: index name; value and std_error in each row's `unit`, corrected."""
    return of_records(self._figures, ["name", "value", "std_error", "unit"],
                      {"value": BY_ROW, "std_error": BY_ROW}, "name")


def _history_frame(self, valve):
    """A valve's life, one row a figure: at [h], name, value, std_error, unit, measured, temperature [K], log."""
    columns = ["at", "cycles", "name", "value", "std_error", "unit", "measured", "temperature", "log"]
    return of_records(self._rows(valve), columns, {"at": "h", "value": BY_ROW, "std_error": BY_ROW, "measured": BY_ROW,
                                                   "temperature": "K"})


def _history_events(self, valve):
    """A valve's maintenance: at [h], kind, text."""
    return of_records(self._events(valve), ["at", "kind", "text"], {"at": "h"})


def _trend_frame(self):
    """One row a check: index name; slope [unit / h], alert_at [h], life left [h]."""
    rows = []
    for t in self.trends:
        left = t.remaining
        rows.append({"name": t.name, "state": t.state.name, "slope": t.slope, "unit": t.unit, "alert_at": t.alert_at,
                     "remaining": left.median if left else None, "remaining_lower": left.lower if left else None,
                     "remaining_upper": left.upper if left else None})
    hours = dict.fromkeys(("alert_at", "remaining", "remaining_lower", "remaining_upper"), "h")
    return of_records(rows, ["name"], {"slope": "{unit} / h", **hours}, "name")


def _trend_points(self):
    """The checks as the trend has them, one row each: at [h], name, value (corrected), unit, temperature [K]."""
    rows = [{"at": at, "name": c["name"], "value": value, "unit": c["unit"], "temperature": temperature, "healthy": ok}
            for c in self._checks
            for at, value, temperature, ok in zip(c["at"], c["value"], c["temperature"], c["healthy"])]
    return of_records(rows, ["at", "name", "value", "unit", "temperature", "healthy"],
                      {"at": "h", "value": BY_ROW, "temperature": "K"})


def _replay_frame(self):
    """Columns (signal, measured | simulated | residual | sigma), SI; index: time [s]."""
    import pandas
    parts = {(name, what): values for name, of in self.signals.items() for what, values in of.items() if len(values)}
    frame = pandas.DataFrame(parts, index=pandas.Index(self.time, name="time"))
    frame.attrs["units"] = {"time": "s", **{name: UNITS[name] for name in self.signals}}
    return frame


def _plan_frame(self):
    """The planned command and, in closed loop, the setpoint; index: time [s]."""
    signals = {"command": self.command}
    if len(self.setpoint):
        signals["setpoint"] = self.setpoint
    return of_signals(signals, self.time)


def _plan_faults(self):
    """What the test would show: index name; least and severity in each row's `unit`, chances found and named."""
    return of_records(self._faults, ["name"], {"least": BY_ROW, "severity": BY_ROW, "deviates": "deviates"}, "name")


def _plan_pairs(self):
    """Faults two by two: first, second, chance that the wrong one is ruled out."""
    return of_records(self._pairs, ["first", "second", "told"])


def _plan_rows(self):
    """Rows of the table: index name; standard deviation before and after the test in each row's `unit`."""
    return of_records(self._rows, ["name"], {"before": BY_ROW, "after": BY_ROW}, "name")


def _plan_pieces(self):
    """Pieces of the test: shape, start [s], seconds [s], amplitude [1 of rated current], rate [Hz]."""
    return of_records(self._pieces, ["shape", "start", "seconds", "amplitude", "rate"],
                      {"start": "s", "seconds": "s", "amplitude": "1 of rated current", "rate": "Hz"})


def _sheet_figures(self):
    """The acceptance sheet: index name; value in each row's SI `unit`, limits min and max, pass."""
    return of_records(self._figures, ["name"], dict.fromkeys(("value", "min", "max"), BY_ROW), "name")


def _sheet_response(self):
    """Frequency response: frequency [Hz], gain, phase [rad], coherence."""
    return of_records(self._response, ["frequency", "gain", "phase", "coherence"], {"frequency": "Hz", "phase": "rad"})


def _fleet_frame(self):
    """One row a log, worst first: verdict, fault, severity with its 95 % interval, error over threshold."""
    frame = of_records(self._rows, ["log", "verdict", "fault", "probability", "severity", "severity_lower",
                                    "severity_upper", "severity_unit", "error", "threshold", "file"],
                       {**dict.fromkeys(("severity", "severity_lower", "severity_upper"), "{severity_unit}"),
                        "error": "deviates", "threshold": "deviates"})
    frame["excess"] = frame["error"] / frame["threshold"]
    return frame


def _fleet_refused(self):
    """Logs that were set aside and files that are no results: file, line, column, rule, mend."""
    return of_records(self._refused + self._unread, ["file", "line", "column", "rule", "mend"])


def _diagnose(self, log, baseline, actions=None, explain_unknown=True, seed=1, threads=0, progress=True):
    """The verdict on one log, or on a list of logs of one valve in one state, judged together."""
    logs = [log] if isinstance(log, core.Log) else list(log)
    return self._diagnose(logs, baseline, actions, explain_unknown, seed, threads, progress)


def _simulate(self, log, **options):
    """The model as tuned, driven by the log's inputs; see simulate()."""
    return core.simulate(log, params=self.table, rig=self.rig, **options)


def _replay(self, log):
    """The log beside its simulation: measured, simulated, residual and its sigma, by signal."""
    return core.replay(log, params=self.table, rig=self.rig)


def _objective(self, logs, **options):
    """The misfit to `logs` about this table, weighed by its own error model; see Objective."""
    return Objective(logs, self.table, self.rig, **options)


def _count(folder, truth):
    """Counts of verdicts by class of a truth file (log,class[,severity]): DataFrames `counts` and `rates`."""
    import pandas
    found = core._count_fleet(folder, truth)
    counts = pandas.DataFrame(found["counts"]).T.fillna(0).astype(int)
    rates = pandas.DataFrame({name: {f"{what}{part}": value for what, pair in of.items()
                                     for part, value in zip(("", "_of"), pair)} for name, of in found["rates"].items()}).T
    return counts, rates


def _property(function):
    return property(function, doc=function.__doc__)


def attach():
    """Puts them on the types of the module."""
    core.Log.frame = core.Simulation.frame = _signals_frame
    core.Table.frame = _table_frame
    core.Baseline.scores = _property(_scores)
    core.Tuned.parameters = _property(_parameters)
    core.Tuned.channels = _property(_channels)
    core.Tuned.convergence = _property(_convergence)
    core.Tuned.diagnose, core.Tuned.simulate, core.Tuned.replay = _diagnose, _simulate, _replay
    core.Tuned.objective = _objective
    core.Verdict.parameters, core.Verdict.channels = _property(_parameters), _property(_channels)
    core.Explanation.channels, core.Explanation.candidates = _property(_explained_channels), _property(_candidates)
    core.Checked.figures = _property(_figures)
    core.History.frame, core.History.events = _history_frame, _history_events
    core.Trend.frame, core.Trend.points = _trend_frame, _property(_trend_points)
    core.Replay.frame = _replay_frame
    core.Plan.frame = _plan_frame
    core.Plan.faults, core.Plan.pairs = _property(_plan_faults), _property(_plan_pairs)
    core.Plan.rows, core.Plan.pieces = _property(_plan_rows), _property(_plan_pieces)
    core.Curves.figures, core.Curves.response = _property(_sheet_figures), _property(_sheet_response)
    core.Fleet.frame, core.Fleet.refused = _fleet_frame, _property(_fleet_refused)
    core.Fleet.count = staticmethod(_count)
