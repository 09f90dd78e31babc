"""What a notebook shows of a result: its head, as HTML."""
import html

from . import _servodx as core
from .plots import COLOURS

ROWS = 12  # of a table that is shown as a head


def _page(title, facts, table=None, colour=None, notes=()):
    mark = f' style="border-left: 0.4em solid {colour.removeprefix("tab:")}; padding-left: 0.6em"' if colour else ""
    parts = [f"<div{mark}><b>{html.escape(title)}</b>"]
    if facts:
        parts.append("<table>" + "".join(f"<tr><th style='text-align:left'>{html.escape(str(name))}</th>"
                                         f"<td style='text-align:left'>{html.escape(_text(value))}</td></tr>"
                                         for name, value in facts.items() if value not in (None, "", [], {}))
                     + "</table>")
    if table is not None and len(table):
        parts.append(table.head(ROWS).to_html(notebook=True, border=0))
        if len(table) > ROWS:
            parts.append(f"<small>{len(table) - ROWS} more rows</small>")
    parts += [f"<br><small>{html.escape(str(note))}</small>" for note in list(notes)[:ROWS]]
    return "".join(parts) + "</div>"


def _text(value):
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, (list, tuple)):
        return ", ".join(map(_text, value))
    return str(value)


def _size(severity):
    if severity is None or severity.value != severity.value:
        return None
    return f"{severity.value:.3g} ({severity.lower:.3g} to {severity.upper:.3g}) {severity.unit}".rstrip()


def _verdict(self):
    likely = sorted(((p, name) for name, p in self.probabilities.items()), reverse=True)[:4]
    facts = {"severity": _size(self.severity), "error": f"{self.error:.3g}, threshold {self.threshold:.3g}",
             "p value": self.p_value, "since": None if self.onset is None else f"{self.onset:.3f} s",
             "likely": ", ".join(f"{name} {p:.2f}" for p, name in likely), "near": self.ambiguous_with,
             "test that would separate": self.separating_test, "what to do": self.action,
             "stands first": None if self.suspicion is None else self.suspicion.name}
    named = ", ".join(f.name + (f" of {f.channel}" if f.channel else "") for f in self.faults)
    return _page(f"{self.log}: {named or self.kind.name}", facts, self.parameters, COLOURS[self.kind.name], self.notes)


def _told_size(p):
    interval = f" ({p.lower:.4g} to {p.upper:.4g}, 90 %)" if p.told.name == "interval" else ""
    told = {"interval": "", "at_bound": ", at a bound", "not_told": ", not determined by these logs"}[p.told.name]
    return f"{p.value:.4g}{interval} {p.unit}".rstrip() + told


def _explanation(self):
    facts = {}
    for cause in self.causes:
        sizes = ", ".join(f"{n} = {_told_size(p)}" for n, p in cause.parameters.items())
        facts[cause.effect] = f"at {cause.where}; {sizes}; removes {100 * cause.heldout_gain.value:.0f} % held out"
    facts["depends on"] = self.depends_on
    facts["healthy logs show too"] = [cause.effect for cause in self.standing]
    return _page(f"{self.kind.name}{', at ' + self.where if self.where else ''}", facts, self.channels, None, self.notes)


def _tuned(self):
    facts = {"rig": self.rig.name, "simulations": self.simulations or None, "channels": list(self.channels.index),
             "interrupted": "yes" if self.interrupted else None}
    return _page(f"tuned table {self.table.sha256[:12]}", facts, self.parameters, None, self.notes)


def _baseline(self):
    facts = {"threshold": self.threshold, "false alarms asked for": self.asked, "promised": self.promised,
             "promised at 95 %": self.promised_95, "logs needed": self.logs_needed}
    return _page(f"baseline of {self.logs} fault-free logs", facts, self.scores, None, self.notes)


def _trend(self):
    left = self.remaining
    facts = {"state": self.state.name, "cause": self.cause, "checks": self.checks, "last at": f"{self.at:.6g} h",
             "alert at": None if self.alert_at is None else f"{self.alert_at:.6g} h",
             "life left": None if left is None else f"{left.median:.4g} h ({left.lower:.4g} to {left.upper:.4g})"}
    return _page(f"valve {self.valve}", facts, self.frame(), None, self.notes)


def _log(self):
    seconds = self.time[-1] - self.time[0]
    frame = self.frame()
    return _page(self.path, {"samples": len(self), "length": f"{seconds:.4g} s"}, frame.head(5), None, self.notes)


def _rig(self):
    return _page(self.name or self.path or "rig", {"serial": self.serial, **dict(sorted(self.facts.items())[:ROWS])})


def _table(self):
    return _page(self.path, {"rows": len(self)}, self.frame().drop(columns=["description", "source"]))


def _checked(self):
    return _page(f"checks of {self.log}", {"oil": f"{self.temperature - 273.15:.1f} degC"}, self.figures, None, self.notes)


def _curves(self):
    return _page(f"acceptance sheet: {self.kind.name}", {}, self.figures, None, self.notes)


def _plan(self):
    facts = {"seconds": float(self.time[-1] - self.time[0]) if len(self.time) else 0.0, "threshold": self.threshold}
    return _page("planned test", facts, self.faults if len(self.faults) else self.pieces, None, self.notes)


def _fleet(self):
    frame = self.frame()
    facts = {"logs": len(frame), **frame["verdict"].value_counts().to_dict(), "set aside": len(self.refused) or None}
    return _page("fleet, worst first", facts, frame.drop(columns=["file"]))


def _simulation(self):
    return _page(repr(self).strip("<>"), {"step": f"{self.step:.3g} s"}, self.frame().head(5), None, self.notes)


def attach():
    """Puts them on the types."""
    for kind, head in ((core.Verdict, _verdict), (core.Explanation, _explanation), (core.Tuned, _tuned),
                       (core.Baseline, _baseline), (core.Trend, _trend), (core.Log, _log), (core.Rig, _rig),
                       (core.Table, _table), (core.Checked, _checked), (core.Curves, _curves), (core.Plan, _plan),
                       (core.Fleet, _fleet), (core.Simulation, _simulation)):
        kind._repr_html_ = head
