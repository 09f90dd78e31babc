"""The faults of the registry and where each acts, read from the sources as text.

A fault that a record of the log tells sits where that record is taken. Any other sits where the rows that it moves act:
src/parameters/list.h states the place of each row, an effect states its own."""
import re, typing

import shapes

PLACE_OF_RECORD = {"supply": "supply", "driver": "drive", "sensor": "sensor"}


class Fault(typing.NamedTuple):
    name: str
    meaning: str
    place: str
    moves: tuple  # rows and effects


def only(found, what):
    if len(set(found)) != 1:
        raise shapes.Refused(f"{what}: {', '.join(sorted(set(found))) or 'none'}")
    return found[0]


def places_of_rows(root):
    """Row -> place."""
    listed = (root / "src/parameters/list.h").read_text()
    return dict(re.findall(r'^  X\(\d+,\s*(\w+),\s*\w+,\s*"([\w:]+)"', listed, re.M))


def effect_of(root, struct):
    """Name and place of an effect, by its struct."""
    for path in sorted((root / "src/effects").glob("*.h")):
        text = path.read_text()
        if re.search(rf"^struct {struct} \{{", text, re.M):
            return tuple(only(re.findall(rf'const char\* {key} = "(\w+)"', text), f"{path.name}, {key}")
                         for key in ("name", "place"))
    raise shapes.Refused(f"src/effects has no struct {struct}")


def moved_by(root, text):
    """Row or effect -> place, of what the fault's own `apply` moves; its shapes stand behind it."""
    body = re.split(r"\.\w+ = ", text.split(".apply =", 1)[1])[0]
    rows = places_of_rows(root)
    found = {row: rows[row] for row in re.findall(r"row::(\w+)", body)}
    found.update(effect_of(root, struct) for struct in re.findall(r"effect_row<(\w+)>", body))
    return found


def fault_of(root, name):
    path = root / f"src/faults/{name}.h"
    text = path.read_text()
    says = {key: only(re.findall(rf'\.{key} = "([^"]*)"', text.split(".shapes")[0]), f"{path.name}, .{key}")
            for key in ("name", "meaning")}
    record, moves = re.search(r"\.told_by = Record::(\w+)", text), moved_by(root, text)
    place = PLACE_OF_RECORD[record[1]] if record else only(list(moves.values()), f"{path.name}, places")
    return Fault(says["name"], says["meaning"], place.split(":")[0], tuple(moves))


def registry(root):
    listed = re.findall(r"^ +&(\w+),", (root / "src/faults/registry.cpp").read_text(), re.M)
    if not listed:
        raise shapes.Refused("src/faults/registry.cpp lists no fault")
    return [fault_of(root, name) for name in listed]
