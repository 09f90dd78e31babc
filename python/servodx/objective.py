"""The misfit of the model to logs as a function, for optimisers of others and for ours."""
from ._servodx import Rig, Table, Tuned, _Objective
from .frames import of_records


class Objective:
    """Least squares over the unit cube: residuals(x) (m,) or (k, m), jac(x) (m, n), cost(x).

    x is (n,), or (k, n) for many points at once, which costs little more than one: every number lies between 0 and 1;
    `numbers` says what they are, `values(x)` gives them in their units. The residual is (measured - simulated) / sigma,
    log by log and channel by channel (`parts`), then the priors. NaN stands where a simulation leaves the finite
    numbers: scipy.optimize.least_squares then takes a shorter step.

        end = scipy.optimize.least_squares(f.residuals, f.start, jac=f.jac, bounds=f.bounds)

    `table` is a Table or a Tuned. A tuned table brings its own weights and priors about its own values; of another the
    weights are as a tune begins, by what its values leave of each channel. One thread at a time.
    """

    Method = _Objective.Method

    def __init__(self, logs, table, rig=None, effects=None, threads=0):
        if isinstance(table, Tuned):
            rig, table = rig or table.rig, table.table
        self._made_of = (list(logs), table, Rig() if rig is None else rig, effects, threads)
        self._inside = _Objective(*self._made_of)

    def __reduce__(self):
        return Objective, self._made_of

    def __repr__(self):
        return f"<Objective of {self.n} numbers, {self.size} residuals>"

    @property
    def n(self):
        """How many numbers are free."""
        return len(self.start)

    @property
    def size(self):
        """How many entries a residual has."""
        return self._inside.size

    @property
    def start(self):
        """(n,) the table's values."""
        return self._inside.start

    @property
    def bounds(self):
        """(0, 1): of every number, as SciPy takes them."""
        return 0.0, 1.0

    @property
    def numbers(self):
        """What is free: name, unit, lower, upper, log_scale, start, prior_sd [of the unit interval], log (-1: shared)."""
        by_row = dict.fromkeys(("lower", "upper", "start"), "{unit}")
        return of_records(self._inside.numbers, ["name"], {**by_row, "prior_sd": "1 of the unit interval"})

    @property
    def parts(self):
        """What the entries of a residual are: log, signal, first, count. The rest are the priors."""
        return of_records(self._inside.parts, ["log", "signal", "first", "count"])

    @property
    def simulations(self):
        """Runs of the model so far; a column of a Jacobian is one a log."""
        return self._inside.simulations

    @property
    def failed_simulations(self):
        """Runs that left the finite numbers."""
        return self._inside.failed_simulations

    def residuals(self, x):
        """(m,) of one point, (k, m) of many."""
        return self._inside.residuals(x)

    def cost(self, x):
        """0.5 |residual|^2: a number of one point, (k,) of many."""
        return self._inside.costs(x)

    def jac(self, x):
        """(m, n), all columns in one batch: forward differences; from 25 columns of a log on, followers of its run."""
        return self._inside.jacobian(x)[0]

    def values(self, x):
        """(n,) the numbers in their units."""
        return self._inside.values_at(x)

    def point(self, values):
        """(n,) point of numbers in their units, or of a Table's or Tuned's values with each log's own at the start."""
        if isinstance(values, Tuned):
            values = values.table
        return self._inside.point_of(values) if isinstance(values, Table) else self._inside.point_at(values)

    def minimise(self, method="least_squares", start=None, iterations=12, population=50, generations=30, seed=1,
                 progress=True):
        """Ours on the same numbers: "least_squares" (our bounded search, then Ceres), "ceres" alone, "nlopt" (BOBYQA),
        "whole" (a genetic search, then the first of these from its best points). Returns x, cost, simulations."""
        how = getattr(self.Method, method, None)
        if how is None or method not in self.Method.__members__:
            raise ValueError(f"method '{method}' is none of {', '.join(self.Method.__members__)}")
        return self._inside.minimise(how, self.start if start is None else start, iterations, population, generations,
                                     seed, progress)

    def slice(self, name, at=None, points=41, log=-1):
        """The cost along one number, the others held: columns value [its unit] and cost. (points,) rows, one batch."""
        import numpy
        numbers = self.numbers
        found = numbers.index[(numbers["name"] == name) & (numbers["log"] == log)]
        if len(found) != 1:
            raise KeyError(name)
        column = found[0]
        many = numpy.tile(numpy.asarray(self.start if at is None else at, dtype=float), (points, 1))
        many[:, column] = numpy.linspace(0.0, 1.0, points)
        rows = [{"value": self.values(x)[column], "cost": cost} for x, cost in zip(many, self.cost(many))]
        frame = of_records(rows, ["value", "cost"], {"value": numbers["unit"][column]})
        frame.attrs["name"] = name
        return frame
