"""Outcomes are types and meaning stands where the thing is: no result is compared to a string, no registry name is
written outside its file. Called by ctest."""
import collections, re, unittest

import source

# Calls that ask whether a text is, has or holds another.
ASK = {"starts_with", "ends_with", "find", "rfind", "contains", "compare", "count", "strcmp", "strncmp", "find_if",
       "equal", "search"}
# What may hold texts, where a name is declared.
TEXT_TYPES = {"string", "string_view", "char", "auto", "array", "vector", "set"}

# Files that turn text from outside into types. Their comparisons are with what a user wrote.
READERS = {
    "apps/servodx/invocation.cpp": "`-` for standard output, names of options",
    "apps/servodx/main.cpp": "words of the command line",
    "apps/servodx/manifest.cpp": "reads a manifest",
    "apps/servodx/manual_commands.cpp": "options by their CLI11 names, the names of shells",
    "apps/servodx/map_command.cpp": "--model",
    "apps/servodx/plan_command.cpp": "--max-speed",
    "apps/servodx/read_manifest.cpp": "reads a manifest",
    "apps/servodx/rerun_command.cpp": "reads a manifest",
    "apps/servodx/tune_command.cpp": "--local, --effects",
    "src/base/checkpoint.cpp": "reads a checkpoint",
    "src/base/csv.cpp": "marks of the encoding",
    "src/base/file_kind.cpp": "marks of files that are no text",
    "src/base/json_text.h": "reads the schema of JSON",
    "src/base/machine_load.cpp": "reads the counters of the kernel",
    "src/base/result_schema.h": "reads the schema of a result",
    "src/fit/tuning_comments.cpp": "reads what a tune wrote into a table",
    "src/fleet/check_list.cpp": "reads the header of a list of checks",
    "src/fleet/confusion.cpp": "reads a truth file",
    "src/fleet/gather.cpp": "reads results",
    "src/fleet/log_list.cpp": "`-` for standard input",
    "src/fleet/result_file.cpp": "reads a result",
    "src/fleet/settling.cpp": "endings of files' names",
    "src/optimise/genetic_state.cpp": "reads a checkpoint",
    "src/parameters/table.cpp": "reads a table",
    "src/prognose/check_name.cpp": "reads the names of checks",
    "src/rig/rig_faults.cpp": "reads a fault's size and span",
    "src/rig/rig_model.cpp": "reads a model's TOML",
    "src/signals/guess.cpp": "reads headers of unknown logs",
    "src/signals/header.cpp": "reads what loggers write above a table",
    "src/signals/log.cpp": "ending of a file's name",
    "src/signals/log_columns.cpp": "reads units of columns",
    "src/signals/rig_columns.cpp": "reads the columns of a rig file",
    "src/signals/rig_file.cpp": "reads a rig file",
    "src/store/baseline_file.cpp": "reads a baseline",
    "src/store/certificate_file.cpp": "reads a certificate sheet",
    "src/store/healthy_file.cpp": "reads a baseline",
    "src/store/history_csv.cpp": "reads a history",
    "src/store/logo_file.cpp": "reads a rig file's picture",
    "src/store/result_json.cpp": "reads a result",
    "src/store/seeded_csv.cpp": "reads a seeded-fault test",
    "src/store/verdict_file.cpp": "reads a verdict",
}

# What is compared elsewhere, each text by itself: file, texts, why.
COMPARED = {
    "apps/servodx/history_command.cpp": ({"ok", ".csv"}, "SQLite's answer to a check of integrity; the ending of a file"),
    "src/fit/log_data.cpp": ({"measurement.low_pass_order"}, "a word of the rig file"),
    "src/fit/nominal.cpp": ({"-", "valve.first_stage", "jet_pipe", "lines.fittings"},
                            "the unit of a pure number; words of the rig file"),
    "src/tune/named_rows.cpp": ({"all"}, "a user's word: --profile all"),
    "src/prognose/monitor.cpp": ({"linear", "A"}, "names of the monitor's models, as its user gives them"),
    "src/rig/facts.cpp": ({",", "rig", "fact", "unit", "low", "high", "source"},
                          "layout of a line of text; the header of a file of limits"),
    "src/rig/labelled_fleet.cpp": ({"flight", "track"}, "excitations go by name, as its user gives them"),
    "src/rig/rig_run.cpp": ({"piston_position"}, "signals of the rig go by name: it makes columns, not results"),
    "src/signals/growing_log.cpp": ({"stamps in column "}, "a mark in a comment of the log"),
    "src/signals/rig_content.cpp": ({"page."}, "keys of the rig file"),
    "src/tune/tune.cpp": ({"none"}, "a user's word: --effects"),
}


def call_of(tokens, at):
    """The name of the call whose parentheses hold this token, and whether the token stands there at top level."""
    depth = 0
    for i in range(at - 1, max(-1, at - 120), -1):
        kind, value, _ = tokens[i]
        if kind == "op" and value in ")]}":
            depth += 1
        elif kind == "op" and value in "([{":
            if depth == 0:
                return tokens[i - 1][1] if value == "(" and i else ""
            depth -= 1
        elif kind == "op" and value == ";" and depth == 0:
            return ""
    return ""


def declares_text(tokens, at):
    """Whether the name at `at` is declared there, as what holds texts."""
    words, depth, own = [], 0, True
    for i in range(at - 1, max(-1, at - 60), -1):
        kind, value, _ = tokens[i]
        if kind == "op" and value in ")}" and (depth or tokens[i + 1][1] == ","):  # of the name declared before
            depth += 1
        elif kind == "op" and value in "({" and depth:
            depth -= 1
        elif kind == "op" and value in ";{}()":
            break
        elif depth == 0 and own and value in ("=", "?", ".", "->"):
            return False
        elif depth == 0:
            words.append(value)
            own = own and value != ","
    return bool(TEXT_TYPES & set(words))


def texts_given(tokens, at):
    """The literals that a declared name gets by what follows it; none where anything else goes into it."""
    texts, depth = [], 0
    for kind, value, _ in tokens[at:]:
        if kind == "string":
            texts.append(value)
        elif value in ("(", "{", "["):
            depth += 1
        elif value in (")", "}", "]"):
            depth -= 1
        elif value in (",", ";") and depth == 0:
            break
        elif kind != "number" and value not in ("=", ":", ",", "::", "std", "string", "string_view", "s", "sv"):
            return []
        if depth < 0:
            break
    return texts


def ends_of_blocks(tokens):
    """For every token the end of the block that it stands in. Namespaces are none."""
    ends, opened = [len(tokens)] * len(tokens), []
    for i, (kind, value, _) in enumerate(tokens):
        if kind == "op" and value == "{":
            before = i - 1
            while tokens[before][1] != "namespace" and (tokens[before][0] == "name" or tokens[before][1] == "::"):
                before -= 1
            opened.append((i, tokens[before][1] == "namespace"))
        elif kind == "op" and value == "}" and opened:
            first, is_namespace = opened.pop()
            if not is_namespace:
                ends[first:i] = [min(end, i) for end in ends[first:i]]
    return ends


def named_texts(tokens):
    """Names that stand for a text, or for one of several, of the file or of a block: {name: [(from, to, texts)]}.
    `constexpr std::string_view taken = "taken"`, `const std::string taken{"taken"}`, `const char* words[] = {"a", "b"}`,
    `for (const char* word : {"a", "b"})`."""
    named, ends = collections.defaultdict(list), ends_of_blocks(tokens)
    for i, (kind, value, _) in enumerate(tokens[:-1]):
        if kind == "name" and tokens[i + 1][1] in ("=", "{", "(", "[", ":") and declares_text(tokens, i):
            texts = texts_given(tokens, i + 1)
            if texts:
                named[value].append((i + 1, ends[i], texts))
    return named


def texts_compared(named, tokens, at):
    """The texts that a name stands for which is compared here, by itself or as one of a list."""
    for first, last, texts in named.get(tokens[at][1], ()) if tokens[at][0] == "name" else ():
        if not first <= at < last:
            continue
        after = at + 1
        if tokens[after][1] == "[":
            after = next(i for i in range(after, len(tokens)) if tokens[i][1] == "]") + 1
        asks = tokens[after][1] == "." and tokens[after + 1][1] in ASK
        if asks or {"==", "!="} & {tokens[at - 1][1], tokens[after][1]} or call_of(tokens, at) in ASK:
            return texts
    return ()


def compared(tokens):
    """(text, line) of every literal, or name that stands for one, that something is compared with."""
    named = named_texts(tokens)
    for i, (kind, value, line) in enumerate(tokens):
        for text in texts_compared(named, tokens, i):
            yield text, line
        names_entry = kind == "name" and value == "name" and tokens[i - 1][1] == "::"  # `e.name == Stiction::name`
        if names_entry and "==" in (tokens[i - 3][1], tokens[i + 1][1]):
            yield f"{tokens[i - 2][1]}::name", line
        if kind != "string" or value.startswith("SELECT "):  # a question to a data base, which calls that `find` too
            continue
        first, last = i - 1, i + 1
        if last < len(tokens) and tokens[last][1] in ("s", "sv"):
            last += 1
        if tokens[first][1] in "({" and tokens[first - 1][1] in ("string", "string_view") and tokens[last][1] in ")}":
            first, last = first - 2, last + 1
            while tokens[first][1] in ("::", "std"):
                first -= 1
        around = (tokens[first][1] if first >= 0 else "", tokens[last][1] if last < len(tokens) else "")
        if {"==", "!="} & set(around) or call_of(tokens, i) in ASK:
            yield value, line


def registry_names():
    """Every name of a fault, an effect, a row effect or a row, and the file that may write it."""
    names = {}
    for path in source.files("src/faults", "src/effects"):
        pattern = r'\.name = "(\w+)"' if "/faults/" in path else r'\bname = "(\w+)"'
        names.update((name, path) for name in re.findall(pattern, source.text(path)))
    rows = "src/effects/row_effects.cpp"
    for name in re.findall(r'^ +\{(?:\.name = )?"(\w+)",', source.text(rows), re.M):
        names.setdefault(name, rows)
    for name in source.registry_rows():
        names[name] = "src/parameters/list.h"
    return names


# Where a registry's name is written outside its file: file, names, why.
WRITTEN = {
    "src/effects/row_effects.cpp": ({"stiction", "hose_compliance", "cross_piston_leakage"},
                                    "their own file: two are called as their row, one joins an effect's test"),
    "src/report/explain/explain_report.cpp": ({"air_fraction"}, "a key of a baseline's file, whatever the row is called"),
    "src/report/explain/explain_words.cpp": ({"unexplained"}, "a verdict's word, not the effect's"),
    "src/store/baseline_keys.cpp": ({"supply_pressure", "return_pressure"},
                                    "conditions of a log, called as the signals"),
    "src/store/healthy_file.cpp": ({"air_fraction"}, "a key of a baseline's file, whatever the row is called"),
}
# The virtual rig shares no list with the model, on purpose; its parameters and faults go by the field's words.
OWN_WORDS = "src/rig/"


def borrowed(path, names):
    """(text, name, line) of every literal that is a registry's name, or ends in one after a colon, of another file."""
    for kind, text, line in source.tokens(path):
        word = text.split(":")[-1]
        if kind == "string" and names.get(word, path) != path:
            yield text, word, line


# Names of what is an outcome, or tells one.
OUTCOMES = {"stopped", "stop", "stops", "reason", "reasons", "why", "how", "words", "verdict", "outcome", "status", "fate",
            "judgement", "summary", "remark", "note", "sentence"}
# Folders that read text from outside, or that make words.
READ_OR_TELL = ("src/base/", "src/signals/", "src/store/", "src/fleet/", "src/report/")
# Fields of the front door that hold words: src/door has them of src/report; those of a rig file are its user's.
TOLD = {"include/servodx/objective.h": {"stopped"}, "include/servodx/explain.h": {"reason"},
        "include/servodx/curves.h": {"note"}, "include/servodx/rig.h": {"words"}}


def text_fields(tokens):
    """(name, line) of every field that is declared to hold a text, or several."""
    depth = 0
    for i, (kind, value, _) in enumerate(tokens):
        depth += (value == "(") - (value == ")") if kind == "op" else 0
        if depth or kind != "name" or value not in ("string", "string_view"):
            continue
        at, listed = i + 1, 0
        while tokens[at][1] == ">":
            at += 1
        while tokens[at][0] == "name" and tokens[at + 1][1] in (";", ",", "=", "{"):
            yield tokens[at][1], tokens[at][2]
            at += 1
            while listed or tokens[at][1] not in (";", ","):
                listed += (tokens[at][1] in "({") - (tokens[at][1] in ")}")
                at += 1
            if tokens[at][1] == ";":
                break
            at += 1


# Words of the house that no reader knows: pattern, what the field says.
HOUSE_WORDS = {
    r"\b(no|is|are|was|were|be) news\b": "no larger than on healthy logs",
    r"\btold (by|from|apart)\b": "found by, distinguished from",
    r"\b(not|be|was|were) told\b": "not determined, found",
    r"\btells? (it|another)\b": "shows it, finds another",
    r"\b(not|cannot|logs?|would) tells?\b": "does not show, does not decide",
    r"\blet wander\b": "moved in every hypothesis",
    r"\b(replay of the blocks|worth its numbers|missed once|missed in turn|mends it)\b": "block replay, ...",
}
# The diary is free.
FREE_PAGES = ("docs/lab/",)


def house_words(text):
    return [f"'{match[0]}'; say: {field}" for pattern, field in HOUSE_WORDS.items()
            for match in re.finditer(pattern, text, re.I)]


def texts_for_readers():
    """(place, text): sentences of the sources, adjoining literals as one; lines of the list of fields and of the pages."""
    for path in source.files("src", "apps", "python"):
        whole, last = "", 0
        for kind, text, line in (*source.tokens(path), ("op", "", 0)):
            if kind == "string":
                whole, last = whole + text, line
            elif whole:
                if " " in whole:
                    yield f"{path}:{last}", whole
                whole = ""
    for path in ["src/report/list/fields.txt", "README.md", *source.files("docs", kinds=("md",))]:
        if not path.startswith(FREE_PAGES):
            for number, line in enumerate(source.text(path).splitlines(), 1):
                yield f"{path}:{number}", re.sub(r"`[^`]*`", "", line)


class Words(unittest.TestCase):
    def test_no_house_word_reaches_a_reader(self):
        said = [f"{place}: {why}" for place, text in texts_for_readers() for why in house_words(text)]
        self.assertFalse(said, "\n" + "\n".join(said))

    def test_house_words_are_found(self):
        for text in ("no news by itself", "it was told by the blocks", "not told by these logs", "the replay of the blocks tells it",
                     "cannot be told from b", "would not tell", "let wander, as in health"):
            self.assertTrue(house_words(text), text)
        self.assertFalse(house_words("the block replay finds it, and the news of the day are untold"))

    def test_no_outcome_is_carried_as_a_text(self):
        found, where = collections.defaultdict(set), []
        for path in source.files("src", "include", kinds=("h",)):
            for name, line in () if path.startswith(READ_OR_TELL) else text_fields(source.tokens(path)):
                if name in OUTCOMES:
                    found[path].add(name)
                    if name not in TOLD.get(path, ()):
                        where.append(f"{path}:{line}: {name} is a text; give it a type, and its words to src/report")
        self.assertFalse(where)
        self.assertEqual(found, TOLD, "not there: take it off the list")

    def test_fields_of_text_are_found(self):
        made = source.tokens("tests/house/fields.inc")
        self.assertEqual([name for name, _ in text_fields(made)], [*"abcdefg"])

    def test_no_result_is_compared_to_a_string(self):
        found, where = collections.defaultdict(set), []
        for path in source.files("src", "apps"):
            if path.startswith("src/report/"):
                continue
            for text, line in compared(source.tokens(path)):
                found[path].add(text)
                if path not in READERS and text not in COMPARED.get(path, ((), ""))[0]:
                    where.append(f'{path}:{line}: compared with "{text}"; give the outcome a type')
        self.assertFalse(where)
        stale = [path for path in READERS if path not in found]
        stale += [f'{path}: "{text}"' for path, (texts, _) in COMPARED.items() for text in texts - found[path]]
        self.assertFalse(stale, "nothing like it there: take it off the list")
        self.assertFalse(READERS.keys() & COMPARED.keys())

    def test_comparisons_are_found_however_written(self):
        made = source.tokens("tests/house/compared.inc")
        self.assertEqual([text for text, _ in compared(made)], [*"abcdefghijkl", "Other::name", *"tumnopqrsv"])

    def test_registry_names_are_written_in_their_own_files_alone(self):
        names = registry_names()
        self.assertGreater(len(names), 70)
        found, where = collections.defaultdict(set), []
        for path in source.files("src", "apps", "include"):
            if path.startswith(OWN_WORDS):
                continue
            for text, word, line in borrowed(path, names):
                found[path].add(word)
                if word not in WRITTEN.get(path, ((), ""))[0]:
                    where.append(f'{path}:{line}: "{text}" belongs to {names[word]} alone; say there what it means')
        self.assertFalse(where)
        stale = [f'{path}: "{name}"' for path, (names, _) in WRITTEN.items() for name in sorted(names - found[path])]
        self.assertFalse(stale, "not written there: take it off the list")

    def test_registry_names_are_found_wherever_they_are_written(self):
        names = registry_names()
        made = "tests/house/borrowed.inc"
        self.assertEqual([(text, line) for text, _, line in borrowed(made, names)],
                         [("sticky_spool", 3), ("effect:seal_film", 4), ("parameter:port_width", 5), ("stiction", 6)])
        self.assertFalse(list(borrowed(made, names | dict.fromkeys(names, made))), "in their own file they may stand")
        for file, written in (("src/faults/sticky_spool.h", "sticky_spool"), ("src/effects/seal_film.h", "seal_film"),
                              ("src/parameters/list.h", "port_width")):
            self.assertEqual(names[written], file)


if __name__ == "__main__":
    unittest.main(verbosity=2)
