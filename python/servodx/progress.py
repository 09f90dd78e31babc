"""The bar of a long call: at a prompt and in a notebook, and nowhere else."""
import sys
import time

WIDTH = 24  # characters
FIRST = 1.0  # [s] a call that is quicker shows nothing


def default_bar():
    """A bar where a person looks on; None in scripts and pipes."""
    return Bar() if interactive() else None


def interactive():
    """At Python's prompt on a terminal, in IPython, or in a notebook."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if shell is not None:
        return True
    return hasattr(sys, "ps1") and sys.stderr is not None and sys.stderr.isatty()


class Bar:
    """Called as bar(work, part, simulations): one line that is written over."""

    def __init__(self, out=None, clock=time.monotonic):
        self._out = sys.stderr if out is None else out
        self._clock = clock
        self._start = clock()
        self._shown = 0

    def __call__(self, work, part, simulations):
        elapsed = self._clock() - self._start
        if elapsed < FIRST:
            return
        part = min(max(part, 0.0), 1.0)
        done = round(part * WIDTH)
        left = f", {_time(elapsed * (1 - part) / part)} left" if part > 0.02 else ""
        counted = f", {simulations} simulations" if simulations else ""
        self._write(f"{work} |{'#' * done}{' ' * (WIDTH - done)}| {100 * part:3.0f} % {_time(elapsed)}{left}{counted}")

    def close(self):
        """Leaves the line as if nothing had been there."""
        if self._shown:
            self._write("")
            self._out.write("\r")
            self._out.flush()
        self._shown = 0

    def _write(self, line):
        self._out.write("\r" + line.ljust(self._shown))
        self._out.flush()
        self._shown = max(self._shown, len(line))


def _time(seconds):
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"
