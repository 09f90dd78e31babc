"""A dictionary as the text of a rig file: what Rig({...}) reads."""


def toml_text(facts):
    """Tables within tables, texts, numbers, true and false; keys are quoted, so any name of a column will do."""
    lines = []
    _table(facts, (), lines)
    return "\n".join(lines) + "\n"


def _table(facts, path, lines):
    inner = {key: value for key, value in facts.items() if isinstance(value, dict)}
    for key, value in facts.items():
        if key not in inner:
            lines.append(f"{_text(key)} = {_value(value)}")
    for key, value in inner.items():
        lines.append("[" + ".".join(_text(part) for part in (*path, key)) + "]")
        _table(value, (*path, key), lines)


def _value(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    return _text(value)


def _text(value):
    text = str(value)
    for mark, name in (("\\", "\\\\"), ('"', '\\"'), ("\n", "\\n"), ("\r", "\\r"), ("\t", "\\t")):
        text = text.replace(mark, name)
    return f'"{text}"'
