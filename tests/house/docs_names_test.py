"""Every file and symbol that the docs name in backticks exists. Called by ctest.

A text with a slash, or with the ending of a file, is a path: from the root, from the page, or the end of one path
alone; what is in capitals stands for any name. `--option` is one that a program or script takes; `servodx NAME` a
command. Of all else every name in it is a word of the code: a name or a word of a text in src, include, apps, bench,
tests, python and scripts, or a word of the tables. Comments do not count."""
import fnmatch, functools, re, subprocess, unittest

import source

FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.S | re.M)
ENDINGS = ("h", "cpp", "inc", "csv", "toml", "json", "md", "html", "svg", "py", "js", "css", "txt", "cmake", "tsv")
COMMANDS = ("apt ", "cmake ", "cpack ", "clang-format ", "clang-tidy ", "export ", "ctest ")  # not ours

# What is named without being ours: word, what it is.
FOREIGN = {
    "h09_flight": "a log of the foreign rig", "h12_triangle_full.csv": "a log of the foreign rig",
    "valve_NN/{healthy,fault,sudden}/*.csv": "what servodx rig --fleet writes",
    "h17": "a log of the foreign rig", "fHz": "any frequency", "linux": "part of a compiler's name",
    "GOMP_SPINCOUNT": "libgomp's", "OMP_WAIT_POLICY": "OpenMP's", "passive": "OpenMP's",
    "fschedule": "g++'s", "insns": "g++'s", "fsched": "g++'s", "march": "g++'s", "native": "g++'s",
    "aarch64": "a compiler's name", "perf": "Linux's", "ValueError": "Python's", "KeyboardInterrupt": "Python's", "gnu": "a compiler's name",
}


def pages():
    return [path for path in ("README.md", "CONTRIBUTING.md", "data/README.md") if (source.ROOT / path).exists()] + \
        source.files("docs", kinds=("md",))


@functools.lru_cache(maxsize=None)
def tree():
    """Paths of the files, and of their folders with a slash at the end."""
    top = ("src", "include", "apps", "bench", "tests", "scripts", "docs", "data", "params", "examples", "cmake",
           "python", "third_party", "fuzz")
    found = {path.relative_to(source.ROOT).as_posix() for folder in top for path in (source.ROOT / folder).rglob("*")
             if path.is_file() and "__pycache__" not in path.parts}
    found |= {path.name for path in source.ROOT.iterdir() if path.is_file()}
    return frozenset(found | {path.rsplit("/", n)[0] + "/" for path in found for n in range(1, path.count("/") + 1)})


def ours(path):
    return path.startswith("tests/house/")  # made-up names


@functools.lru_cache(maxsize=None)
def words():
    """Names of the code and words of its texts."""
    found = set()
    for path in source.files("src", "include", "apps", "bench", "tests", "examples"):
        if ours(path):
            continue
        for kind, text, _ in source.tokens(path):
            if kind in ("name", "string", "include"):
                found.update(re.findall(r"\w+", text))
        found.update(re.findall(r"\w+", " ".join(re.findall(r"^[ \t]*#.*(?:\\\n.*)*", source.text(path), re.M))))
    for path in tree():
        found.update(part for name in path.split("/") for part in (name.split(".")[0], name.split("_")[0]))
        plain = path.startswith(("scripts/", "cmake/", "params/", "python/"))
        plain = plain or path.endswith((".txt", ".json", ".toml", ".js"))
        if plain and not path.endswith("/"):
            found.update(re.findall(r"\w+", source.text(path)))
        elif path.endswith(".csv"):
            with open(source.ROOT / path) as lines:
                found.update(word for line, _ in zip(lines, range(60)) for word in re.findall(r"\w+", line))
    found.update("test_" + path.split("/")[1] for path in tree() if re.fullmatch("tests/[a-z_]+/", path))  # programs
    return frozenset(found)


@functools.lru_cache(maxsize=None)
def options():
    """Every --option of the programs and scripts."""
    found = set()
    for path in tree():
        if path.startswith(("apps/", "bench/", "scripts/", "tests/")) and not path.endswith(("/", "docs_names_test.py")):
            found.update(re.findall(r"(?<![\w-])--[a-z][\w-]*", source.text(path)))
    return frozenset(found)


@functools.lru_cache(maxsize=None)
def shown():
    """What the code fences of all pages hold: there files of the reader's own are made."""
    return "\n".join(body for page in pages() for _, body in FENCE.findall(source.text(page)))


@functools.lru_cache(maxsize=None)
def written():
    """Texts of the programs: names of the files that they make."""
    return frozenset(text for path in source.files("src", "apps", "bench") for kind, text, _ in source.tokens(path)
                     if kind == "string")


def is_path(text):
    ends = "." in text and text.rsplit(".", 1)[-1] in ENDINGS
    return bool(re.fullmatch(r"[\w.*/{},+-]+", text)) and ("/" in text or ends)


def wrong_path(text, page):
    """Why this is no path of the project; empty if it is."""
    any_name = re.sub(r"\{[^}]*\}", "*", re.sub(r"\b[A-Z]{2,}(?:_N+)?\b|_NN\b|\bXXXXXX\b", "*", text))
    folder = page.rsplit("/", 1)[0] + "/" if "/" in page else ""
    for shape in (any_name, folder + any_name, any_name.rstrip("/") + "/", folder + any_name.rstrip("/") + "/"):
        if fnmatch.filter(tree(), shape):
            return ""
    ends = fnmatch.filter(tree(), "*/" + any_name) + fnmatch.filter(tree(), "*/" + any_name + "[._]*")
    if len(ends) == 1 or ends and ("*" in any_name or "." not in any_name):
        return ""
    if "/" not in text and (re.search(r"(?<![\w/])" + re.escape(text), shown())):
        return ""  # a file that the program, or the reader, makes
    if any_name.startswith("*") or "/" + any_name.split("/")[-1] in written() or any_name in written():
        return ""
    return "is the end of several paths: " + ", ".join(sorted(ends)[:3]) if ends else "is no file"


def wrong(text, page):
    """Why this names nothing; empty if it names something."""
    for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", text):
        if option not in options() and not text.startswith(COMMANDS):
            return f"has the option {option}, which no program takes"
    if text.startswith(COMMANDS) or text in tree() or text in FOREIGN:
        return ""
    command = re.match(r"servodx ([a-z][\w-]*)", text)
    if command and not re.search(rf'add_subcommand\("{command[1]}"|"{command[1]}"', apps()):
        return f"is no command: {command[1]}"
    made = re.match(r"servodx_\w+", text)
    if made and made[0] not in source.text("CMakeLists.txt") and made[0] not in words():
        return "is no target and no metric"
    if re.match(r"scripts/\w+", text):
        return "" if text.split()[0] in tree() else "is no script"
    if text.startswith("servodx"):
        return ""
    if is_path(text):
        return wrong_path(text, page)
    test = re.fullmatch(r"([A-Z]\w+)\.([A-Z]\w+)", text)
    if test:
        return "" if re.search(rf"TEST(?:_[FP])?\({test[1]}, {test[2]}\)", all_tests()) else "is no test"
    for name, star in re.findall(r"(?<![\w-])([A-Za-z_]\w+)(\*?)", text):
        known = any(word.startswith(name) for word in words()) if star else name in words()
        any_name = re.fullmatch(r"[A-Z0-9_]+", name) and not name.startswith("SERVODX_")
        if not (known or any_name or name in FOREIGN or name.startswith("_")):
            return f"names {name}, which is nowhere in the code"
    return ""


@functools.lru_cache(maxsize=None)
def apps():
    return "\n".join(source.text(path) for path in source.files("apps"))


@functools.lru_cache(maxsize=None)
def all_tests():
    return "\n".join(source.text(path) for path in source.files("tests", kinds=("cpp",)))


class Docs(unittest.TestCase):
    def test_names_in_backticks_exist(self):
        said, seen = [], 0
        for page in pages():
            prose = FENCE.sub(lambda fence: "\n" * fence.group().count("\n"), source.text(page))
            for number, line in enumerate(prose.splitlines(), 1):
                for text in re.findall(r"`([^`]+)`", line):
                    seen += 1
                    why = wrong(text, page)
                    said += [f"{page}:{number}: `{text}` {why}"] if why else []
        self.assertGreater(seen, 1000)
        self.assertFalse(said, "\n" + "\n".join(said))

    def test_ways_through_the_code_are_there_and_never_turn_back(self):
        """docs/reading_the_code.md: each step's function stands in its file, and no folder is come to twice."""
        page = "docs/reading_the_code.md"
        ways = re.split(r"^## ", source.text(page), flags=re.M)[1:]
        self.assertEqual(len(ways), 4)
        for way in ways:
            steps = re.findall(r"^\d+\. `([\w:]+)` \(`([\w/.]+)`\)", way, re.M)
            self.assertTrue(5 <= len(steps) <= 10, way[:60])
            left, folder = set(), ""
            for name, path in steps:
                made = {function.split("::")[-1] for function, _, _ in source.functions(path)}
                self.assertIn(name.split("::")[-1], made, f"{path} has no function {name}")
                at = path.rsplit("/", 1)[0]
                if at != folder:
                    self.assertNotIn(at, left, f"{way.splitlines()[0]}: {name} goes back to {at}")
                    left.add(folder)
                folder = at

    def test_prose_is_plain(self):
        """Sentences of the ways: at most 25 words on average, none over 60."""
        prose = re.sub(r"`[^`]*`", "it", source.text("docs/reading_the_code.md"))
        lengths = [len(sentence.split()) for line in prose.splitlines() if not line.startswith("#")
                   for sentence in re.split(r"(?<=[.:])\s", line) if len(sentence.split()) > 1]
        self.assertLessEqual(sum(lengths) / len(lengths), 25)
        self.assertLessEqual(max(lengths), 60)

    def test_names_that_are_nowhere_are_told(self):
        for text in ("src/fit/no_such.cpp", "no_such.h", "no_such.csv", "NoSuchType", "no_such_function()",
                     "ErrorModel::no_such", "Rig.NoSuch", "servodx frobnicate", "servodx tune --no-such", "--no-such",
                     "servodx_no_such", "scripts/no_such"):
            self.assertTrue(wrong(text, "README.md"), text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
