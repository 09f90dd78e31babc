"""What the library's front door gives, Python gives: each field of a result is a property, each option a keyword, or
stands below with the reason why not. Read are the headers and the type stubs, which tests/python holds to the module.
Called by ctest."""
import ast, re, unittest

import source

STUBS = "python/servodx/__init__.pyi"

# Struct of the door -> its class in Python, where it is called otherwise.
RESULTS = {
    "RigFile": "Rig", "Note": "Note", "Log": "Log", "Row": "Row", "Table": "Table", "Tuned": "Tuned",
    "Baseline": "Baseline", "Verdict": "Verdict", "Verdict::Severity": "Severity",
    "Verdict::Suspicion": "Verdict.Suspicion", "Verdict::Named": "Verdict.Named",
    "Verdict::Detectable": "Verdict.Detectable", "Verdict::Beyond": "Verdict.Beyond",
    "Verdict::Friction": "Verdict.Friction", "Explanation": "Explanation", "Explanation::Gain": "Explanation.Gain",
    "Explanation::Parameter": "Explanation.Parameter", "Explanation::Cause": "Explanation.Cause",
    "Simulation": "Simulation", "LogChart": "Replay", "Checked": "Checked", "Trend": "Trend",
    "Trend::Remaining": "Trend.Remaining", "Trend::OfCheck": "Trend.OfCheck", "PlannedTest": "Plan",
    "AcceptanceSheet": "Curves", "Fleet": "Fleet",
}
# Struct of options -> the call that takes them.
OPTIONS = {
    "TuneOptions": "tune", "BaselineOptions": "Tuned.baseline", "DiagnoseOptions": "Tuned.diagnose",
    "ExplainOptions": "Tuned.explain", "CheckOptions": "Tuned.check", "PlanOptions": "Tuned.plan",
    "SheetOptions": "curves", "TrendOptions": "trend", "SimulationOptions": "simulate",
}
# Of every struct.
INNER = {"whole": "for the program's pages", "parts": "the library's own", "watch": "`progress` stands for it"}
# (struct, field): why Python has none of that name.
LEFT_OUT = {
    ("RigFile", "ports"): "what the user's own file says", ("RigFile", "command_hold"): "the same",
    ("RigFile", "taps"): "the same", ("RigFile", "fluid"): "the same", ("RigFile", "response"): "the same",
    ("RigFile", "limits"): "the same", ("RigFile", "columns"): "the same", ("RigFile", "lines"): "of errors",
    ("RigFile", "open_questions"): "of init",
    ("Log", "channels"): "signals", ("Simulation", "columns"): "signals",
    ("PlannedTest", "planned"): "faults, pairs, rows, extremes", ("PlannedTest", "random"): "random_information",
    ("Fleet", "rows"): "frame()", ("Fleet", "unread"): "refused", ("Fleet", "csv"): "save()",
    ("TuneOptions", "local"): "an Objective minimises by each",
    ("DiagnoseOptions", "search"): "slower, for comparisons", ("DiagnoseOptions", "population"): "of that search",
    ("PlanOptions", "limits"): "max_current, max_stroke, max_speed, max_pressure",
    ("TrendOptions", "limits"): "failures stand for them", ("TrendOptions", "seeded"): "the program's",
}


def names_of(statement):
    """What a member's declaration declares; nothing of a function."""
    while (shorter := re.sub(r"<[^<>]*>", "", statement)) != statement:
        statement = shorter
    if re.match(r"(using|static|friend|enum|explicit|public|private|template)\b", statement):
        return []
    if "operator" in statement or "(" in statement.split("=")[0]:
        return []
    ends = [re.search(r"(\w+)$", part.split("=")[0].strip()) for part in statement.split(",")]
    return [end[1] for end in ends if end]


def closing(text, opening):
    depth = 0
    for at in range(opening, len(text)):
        depth += (text[at] == "{") - (text[at] == "}")
        if depth == 0:
            return at
    raise ValueError("a brace is not closed")


def structs_of(text, inside=()):
    """(name, fields) of each struct, those inside another too."""
    kept, at = "", 0
    while at < len(text):
        begins = re.compile(r"\b(?<!enum )struct (\w+)(?: :[^{;]*)? \{").match(text, at)
        if begins:
            end = closing(text, begins.end() - 1)
            yield from structs_of(text[begins.end():end], (*inside, begins[1]))
            at = end + 1
        elif text[at] == "{":
            at = closing(text, at) + 1
        else:
            kept, at = kept + text[at], at + 1
    if inside:
        yield "::".join(inside), [name for part in kept.split(";") for name in names_of(" ".join(part.split()))]


def structs():
    found = {}
    for path in source.files("include/servodx", kinds=("h",)):
        text = re.sub(r"//[^\n]*", "", source.text(path))
        begins = re.search(r"namespace servodx \{", text)
        found.update(structs_of(text[begins.end():text.rindex("}")]) if begins else ())
    return found


def stubs():
    """Names that a class shows, and keywords that a call takes."""
    shown, taken = {}, {}

    def read(node, name):
        for part in node.body:
            called = name + part.name if hasattr(part, "name") else ""
            if isinstance(part, ast.ClassDef):
                shown[called] = {f.name for f in part.body if isinstance(f, ast.FunctionDef)}
                read(part, called + ".")
            elif isinstance(part, ast.FunctionDef):
                taken[called] = {a.arg for a in part.args.args + part.args.kwonlyargs}

    read(ast.parse(source.text(STUBS)), "")
    return shown, taken


def lacking(table, fields, there):
    return {(struct, field) for struct, called in table.items() for field in fields[struct]
            if field not in there[called] and field not in INNER}


class PythonNames(unittest.TestCase):
    def test_what_the_door_has_python_has(self):
        fields, (shown, taken) = structs(), stubs()
        without = lacking(RESULTS, fields, shown) | lacking(OPTIONS, fields, taken)
        self.assertFalse(sorted(without - LEFT_OUT.keys()), "give it to Python, or say why not")
        self.assertFalse(sorted(LEFT_OUT.keys() - without), "is there: take it off the list")

    def test_the_classes_that_have_the_name_of_a_struct_are_looked_at(self):
        replay = {"Replay"}  # the door's is of pages; Python's is its LogChart
        self.assertFalse({name for name in structs() if name.replace("::", ".") in stubs()[0]} - RESULTS.keys() - replay)

    def test_a_sample(self):
        sample = """struct A { enum class Kind { a, b }; struct B { double x = 0, y = {}; bool z() const { return true; } };
                    Kind kind = Kind::a; std::map<std::string, std::vector<B>> parts = {}; void validate() const; };"""
        self.assertEqual(dict(structs_of(sample)), {"A::B": ["x", "y"], "A": ["kind", "parts"]})


if __name__ == "__main__":
    unittest.main(verbosity=2)
