"""DataFrames in and out. The units of a frame's columns stand in attrs["units"], by column."""

# What a log's signals are in.
UNITS = {
    "time": "s", "command": "A", "coil_current": "A", "setpoint": "m", "spool_position": "m", "piston_position": "m",
    "pressure_a": "Pa", "pressure_b": "Pa", "supply_pressure": "Pa", "return_pressure": "Pa", "pilot_pressure_1": "Pa",
    "pilot_pressure_2": "Pa", "load_pressure": "Pa", "valve_pressure_drop": "Pa", "load_force": "N", "flow_a": "m3/s",
    "flow_b": "m3/s", "control_flow": "m3/s", "leakage_flow": "m3/s", "oil_temperature": "K",
}


def columns_of(data, units=None):
    """Columns named as in a file, "pressure_a [bar]", of a DataFrame or of a mapping; time may be the index."""
    units = {**getattr(data, "attrs", {}).get("units", {}), **(units or {})}
    columns = {_head(name, units): data[name] for name in data}
    index = getattr(data, "index", None)
    if getattr(index, "name", None) is not None and not any(_bare(name) == "time" for name in data):
        if _bare(index.name) == "time":
            columns = {_head(index.name, {"time": "s", **units}): index, **columns}
    return columns


def _bare(name):
    return str(name).split("[")[0].strip()


def _head(name, units):
    return f"{name} [{units[name]}]" if name in units else str(name)


def log_of(data, units=None, rig=None, name="log in memory"):
    """A log from a DataFrame or a mapping of columns, (samples,) each; the same as Log(data, ...)."""
    from ._servodx import Log, Rig
    return Log(data, units=units, rig=Rig() if rig is None else rig, name=name)


def frame_of(log):
    """A log or a simulation as a DataFrame, a column a signal, in SI; index: time [s]."""
    return of_signals(log.signals, log.time)


def of_signals(signals, time):
    import pandas
    frame = pandas.DataFrame(signals, index=pandas.Index(time, name="time"))
    frame.attrs["units"] = {"time": "s", **{name: UNITS[name] for name in signals if name in UNITS}}
    return frame


def of_records(rows, columns, units=None, index=None):
    """One row a record. A unit written as {column} stands in that column, row by row."""
    import pandas
    frame = pandas.DataFrame(list(rows), columns=None if rows else columns)
    if index and len(frame):
        frame = frame.set_index(index)
    frame.attrs["units"] = dict(units or {})
    return frame
