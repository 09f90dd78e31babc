"""Pictures of results with matplotlib. Each returns the figure; `ax` draws into axes that are there."""
from . import _servodx as core
from .frames import UNITS
from .objective import Objective

BAND = 2.0  # sigma: 95 of 100 samples of a healthy log lie within it
FAN = (0.9, 0.5)  # parts of the lives that a band of the fan holds
COLOURS = {"healthy": "tab:green", "fault": "tab:red", "unknown": "tab:orange"}
SCALES = {"Pa": (1e-5, "bar"), "m": (1e3, "mm"), "A": (1e3, "mA"), "m3/s": (6e4, "l/min"), "K": (1.0, "K")}


def _pyplot():
    import matplotlib.pyplot
    return matplotlib.pyplot


def _shown(name, values):
    """Values and unit as a person reads them."""
    unit = UNITS.get(name, "")
    factor, shown = SCALES.get(unit, (1.0, unit))
    return values * factor, f"{name} [{shown}]" if shown else name


def _panels(count, ax=None, width=8.0, height=1.7, columns=1, **options):
    """A figure and `count` rows of axes; with `ax` that one alone."""
    if ax is not None:
        return ax.figure, [[ax]]
    figure, axes = _pyplot().subplots(max(count, 1), columns, figsize=(width, 0.6 + height * max(count, 1)),
                                      squeeze=False, layout="constrained", **options)
    return figure, axes


def plot_signals(self, names=None, ax=None):
    """Traces over time, one panel a signal; of a log or of a simulation."""
    signals = self.signals
    names = list(signals) if names is None else [n for n in names if n in signals]
    figure, axes = _panels(len(names), ax, sharex=ax is None)
    for name, (panel,) in zip(names, axes):
        values, label = _shown(name, signals[name])
        panel.plot(self.time, values, linewidth=0.8)
        panel.set_ylabel(label, fontsize="small")
    axes[-1][0].set_xlabel("time [s]")
    return figure


def plot_replay(self):
    """Left the traces, measured and simulated; right the residuals with their band of two sigma."""
    figure, axes = _panels(len(self.signals), width=11.0, columns=2, sharex=True)
    for (name, of), (left, right) in zip(self.signals.items(), axes):
        values, label = _shown(name, of["measured"])
        left.plot(self.time, values, linewidth=0.8, label="measured")
        left.set_ylabel(label, fontsize="small")
        if not len(of["simulated"]):
            continue
        left.plot(self.time, _shown(name, of["simulated"])[0], linewidth=0.8, label="simulated")
        sigma, _ = _shown(name, of["sigma"])
        right.fill_between(self.time, -BAND * sigma, BAND * sigma, alpha=0.3, linewidth=0, label="expected")
        right.plot(self.time, _shown(name, of["residual"])[0], linewidth=0.6, color="black", label="residual")
    for panel, title in zip(axes[0], ("traces", "residuals")):
        panel.set_title(title)
        panel.legend(loc="upper right", fontsize="small")
    for panel in axes[-1]:
        panel.set_xlabel("time [s]")
    return figure


def plot_tuned(self):
    """How the misfit fell by stages, and the waterfall: at what costs the local searches ended."""
    figure, axes = _panels(1, height=3.0, columns=2)
    left, right = axes[0]
    steps = self.convergence
    for stage in dict.fromkeys(steps["stage"]):
        of = steps[steps["stage"] == stage]
        left.plot(of["simulations"], of["cost"], marker=".", linewidth=0.8, label=stage)
    left.set(xlabel="simulations", ylabel="cost", yscale="log", title="search")
    if len(steps):
        left.legend(fontsize="x-small")
    right.plot(range(1, len(self.starts) + 1), sorted(self.starts), marker="o")
    right.set(xlabel="start, best first", ylabel="cost at its end", title="waterfall")
    return figure


def plot_hypotheses(self, ax=None):
    """How likely each hypothesis is; the verdict's own is coloured."""
    likely = sorted(((p, name) for name, p in self.probabilities.items() if p > 1e-4))[-12:]
    figure, axes = _panels(1, ax, height=0.6 + 0.3 * max(len(likely), 1))
    panel = axes[0][0]
    own = self.fault or self.kind.name
    colours = [COLOURS.get(self.kind.name) if name == own else "lightgrey" for _, name in likely]
    panel.barh([name for _, name in likely], [p for p, _ in likely], color=colours)
    panel.set(xlim=(0, 1), xlabel="probability")
    panel.set_title(f"{self.log}: {own}, error {self.error:.3g}, threshold {self.threshold:.3g}", fontsize="medium")
    return figure


def plot_explanation(self):
    """What each channel misses before and after mending; and how likely each cause is, where a baseline tells."""
    figure, axes = _panels(1, height=3.0, columns=2)
    left, right = axes[0]
    channels = self.channels
    if len(channels):
        over_noise = channels[["rms_before", "rms_after"]].div(channels["noise_rms"], axis=0)
        over_noise.columns = ["before", "after"]
        over_noise.plot.barh(ax=left, color=["lightgrey", "tab:blue"])
    left.set(xlabel="rms error over the sensor's noise", ylabel="")
    likely = sorted((p, name) for name, p in self.probabilities.items() if p > 1e-4)[-10:]
    if not likely:
        likely = sorted((c.heldout_gain.value, c.effect) for c in self.causes)
        right.set_xlabel("share of the held-out misfit that is removed")
    else:
        right.set_xlabel("probability")
    right.barh([name for _, name in likely], [p for p, _ in likely])
    figure.suptitle(", ".join([self.kind.name] + [c.effect for c in self.causes]))
    return figure


def plot_trend(self):
    """Each check over the hours of use, its levels, and the fan of lives that are left."""
    checks = self._checks
    figure, axes = _panels(len(checks), sharex=True)
    for check, (panel,) in zip(checks, axes):
        panel.plot(check["at"], check["value"], ".", color="black", markersize=4)
        for level, colour in (("threshold", "tab:green"), ("warning", "tab:orange"), ("failure", "tab:red")):
            for value in check[level]:
                if value is not None:
                    panel.axhline(value, color=colour, linewidth=0.8, linestyle="--", label=level)
        _fan(panel, self.at, check)
        panel.set_ylabel(f"{check['name']} [{check['unit']}]" if check["unit"] else check["name"], fontsize="small")
        if panel.get_legend_handles_labels()[1]:
            panel.legend(fontsize="x-small", loc="upper left")
    axes[-1][0].set_xlabel("use [h]")
    figure.suptitle(f"{self.valve}: {self.state.name}{', ' + self.cause if self.cause else ''}")
    return figure


def _fan(panel, at, check):
    """From the last check to where each life meets the failure level."""
    import numpy
    life, failure = check["life"], [level for level in check["failure"] if level is not None]
    now = check["now"]
    if not check["grows"] or not len(life) or not failure or not numpy.isfinite(now):
        return
    goal = min(failure, key=lambda level: abs(level - now))
    for part in FAN:
        early, late = (at + numpy.quantile(life, (1 + sign * part) / 2, method="nearest") for sign in (-1, 1))
        if not numpy.isfinite(early):
            continue
        late = late if numpy.isfinite(late) else at + 20 * max(early - at, 1.0)
        panel.fill([at, early, late], [now, goal, goal], color="tab:red", alpha=0.15, linewidth=0)
    median = at + numpy.quantile(life, 0.5, method="nearest")
    if numpy.isfinite(median):
        panel.plot([at, median], [now, goal], color="tab:red", linewidth=0.9, label="median life")


def plot_plan(self, ax=None):
    """The planned command."""
    figure, axes = _panels(1, ax, height=2.4)
    panel = axes[0][0]
    panel.step(self.time, 1e3 * self.command, where="post", linewidth=0.9)
    panel.set(xlabel="time [s]", ylabel="command [mA]")
    return figure


def plot_curves(self):
    """Each curve of the sheet, both branches and their mean; and the frequency response."""
    curves, response = self.curves, self.response
    figure, axes = _panels(len(curves) + (1 if len(response) else 0), height=2.6)
    for (name, curve), (panel,) in zip(curves.items(), axes):
        for branch, style in (("up", "-"), ("down", "-"), ("mean", "--")):
            panel.plot(1e3 * curve["current"], _shown(name, curve[branch])[0], style, linewidth=0.8, label=branch)
        panel.set(xlabel="current [mA]", ylabel=_shown(name, curve["mean"])[1])
        panel.legend(fontsize="x-small")
    if len(response):
        panel = axes[-1][0]
        panel.semilogx(response["frequency"], response["gain"])
        panel.set(xlabel="frequency [Hz]", ylabel=f"gain to {self.response_signal}")
    return figure


def plot_fleet(self, ax=None, least=0.01):
    """Error over threshold of every log, worst first, by verdict."""
    frame = self.frame()
    figure, axes = _panels(1, ax, height=3.0)
    panel = axes[0][0]
    for verdict, colour in COLOURS.items():
        of = frame[frame["verdict"] == verdict]
        panel.plot(of.index + 1, of["excess"].clip(lower=least), ".", color=colour, label=f"{verdict} ({len(of)})")
    panel.axhline(1.0, color="black", linewidth=0.8)
    panel.set(xlabel="log, worst first", ylabel="error over threshold", yscale="log")
    panel.legend(fontsize="small")
    return figure


def plot_slice(self, name, ax=None, **options):
    """The cost along one number, the others held; see slice()."""
    frame = self.slice(name, **options)
    figure, axes = _panels(1, ax, height=2.6)
    panel = axes[0][0]
    panel.plot(frame["value"], frame["cost"])
    unit = frame.attrs["units"]["value"]
    panel.set(xlabel=f"{name} [{unit}]" if unit else name, ylabel="cost", yscale="log")
    return figure


def attach():
    """Puts them on the types."""
    core.Log.plot = core.Simulation.plot = plot_signals
    core.Replay.plot, core.Tuned.plot = plot_replay, plot_tuned
    core.Verdict.plot, core.Explanation.plot = plot_hypotheses, plot_explanation
    core.Trend.plot, core.Plan.plot = plot_trend, plot_plan
    core.Curves.plot, core.Fleet.plot = plot_curves, plot_fleet
    Objective.plot = plot_slice
