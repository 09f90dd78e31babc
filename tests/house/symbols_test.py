"""The rule of includes holds for symbols: a name that a file uses comes from a header that this file includes itself,
or that the header of the same name includes for it. Who may include whom is layering_test.cpp's. Called by ctest.

Looked at are types, functions that are called (those of one plain word left out: too much else is called so),
constants and macros of the program's own headers. A name that several
headers declare is owed to one of them. A name that the file, or a class that it can see, declares for itself is left
out, and so is what follows `.`, `->` or the name of another namespace.

`symbols_test.py --mend FILE...` writes the missing includes into files, where one header alone is owed."""
import collections, functools, re, sys, unittest

import source

ROOTS = ("include", "src", "tests", "bench", "apps/servodx", "fuzz")
FOLDERS = ("include", "src", "apps", "bench", "tests", "examples", "fuzz")


@functools.lru_cache(maxsize=None)
def headers():
    return {path for path in source.files(*FOLDERS, kinds=("h",))}


@functools.lru_cache(maxsize=None)
def resolved(path):
    """The program's headers that a file includes; a header that declares nothing of its own stands for those that it
    includes."""
    found, folder = set(), path.rsplit("/", 1)[0]
    for name in source.includes(path):
        for root in (folder, *ROOTS):
            if f"{root}/{name}" in headers():
                header = f"{root}/{name}"
                found.add(header)
                if not any(source.names(header)):
                    found |= resolved(header)
                break
    return frozenset(found)


@functools.lru_cache(maxsize=None)
def owners():
    """Name -> headers that declare it."""
    found = collections.defaultdict(set)
    for header in headers():
        made = source.names(header)
        for name in made.types | made.functions | made.constants:
            found[name].add(header)
    for name in source.registry_rows():
        found["row::" + name] = {"src/parameters/list.h"}
    return found


@functools.lru_cache(maxsize=None)
def constants():
    return {name.split("::")[-1] for header in headers() for name in source.names(header).constants}


def reach(path):
    """Headers whose names this file may use."""
    own = path.rsplit(".", 1)[0] + ".h"
    direct = resolved(path)
    return direct | {path} | (resolved(own) | {own} if own in direct else set())


def declared_here(path):
    """Names that the file gives a meaning of its own: types, variables, parameters, members, template parameters."""
    made = source.names(path)
    found = {name.split("::")[-1] for names in made for name in names}
    tokens = source.tokens(path)
    for (kind_0, before, _), (kind, name, _), (_, after, _) in zip(tokens, tokens[1:], tokens[2:]):
        if kind != "name":
            continue
        typed = kind_0 == "name" and before not in NO_TYPES or before in ("&", "*", ">", "&&") and after in ENDS
        if typed or before in ("[", ",") and after in ("]", ","):  # a declaration, or a structured binding
            found.add(name)
    return found


NO_TYPES = set("return else case co_return throw new delete goto constexpr const inline static typename template not "
               "and or using sizeof operator do explicit".split())
ENDS = {",", ")", "=", "{", ";", ":", "["}


def spaces_of(path):
    """Namespaces inside of the program's that the file opens: their names are used bare in it."""
    found = set()
    for event, scopes, head, _ in source.walk(path):
        if event == "open" and scopes[-1].kind == "namespace":
            space = "::".join(scope.name for scope in scopes if scope.name)
            found.add(source.inner(space))
        elif event == "end" and [token[1] for token in head[:2]] == ["using", "namespace"]:
            found.add(source.inner("".join(token[1] for token in head[2:])))
    return found - {""}


def used(path):
    """(name, line) of what the file may owe to a header; `space::name` where it says the space."""
    tokens = source.tokens(path)
    for i, (kind, name, line) in enumerate(tokens):
        if kind != "name":
            continue
        before = tokens[i - 1][1] if i else ""
        after = tokens[i + 1][1] if i + 1 < len(tokens) else ""
        if before in (".", "->", "~") or before == "(" and tokens[i - 2][1] in ("TEST", "TEST_F"):
            continue
        space = tokens[i - 2][1] if before == "::" and i > 1 and tokens[i - 2][0] == "name" else ""
        if before == "::" and space != "servodx":
            yield f"{space}::{name}", line, after
        else:
            yield name, line, after


def owes(path):
    """{name: (line, headers)} of names whose headers the file does not include."""
    may = reach(path)
    visible = declared_here(path)
    for header in may:
        visible |= source.names(header).members if header != path else set()
    found = {}
    spaces, of_tests = spaces_of(path), path.startswith(("tests/", "bench/"))
    for name, line, after in used(path):
        # Of an inner namespace, or of the outer one, which an argument's type may lead to.
        have = set().union(owners().get(name, ()), *(owners().get(f"{space}::{name}", ()) for space in spaces))
        have = {header for header in have if of_tests or not header.startswith(("tests/", "bench/"))}
        if not have or have & may or name in found:
            continue
        if "::" not in name:
            called = name.islower() and not name in constants()
            if name in visible or called and (after not in ("(", "<") or "_" not in name):
                continue
        found[name] = (line, have)
    return found


class Symbols(unittest.TestCase):
    def test_names_come_from_headers_that_the_file_includes(self):
        wrong, seen = [], 0
        for path in source.files(*FOLDERS, kinds=("h", "cpp")):
            seen += 1
            wrong += [f"{path}:{line}: {name} is declared in {' or '.join(sorted(have))}: include it"
                      for name, (line, have) in sorted(owes(path).items())]
        self.assertGreater(seen, 300)
        self.assertFalse(wrong, "\n" + "\n".join(wrong))

    def test_a_name_without_its_header_is_told(self):
        """A type, a function, a constant and a macro that are owed; what is included, or declared here, is not."""
        owed = owes("tests/house/owing.inc")
        self.assertEqual({name: (line, *have) for name, (line, have) in owed.items()},
                         {"ErrorModel": (7, "src/fit/error_model.h"), "wilson_95": (8, "src/base/wilson.h"),
                          "n_parameters": (9, "src/parameters/list.h"),
                          "SERVODX_PARAMETERS": (10, "src/parameters/list.h")})


def include_of(header):
    """How a header is written in an #include."""
    return next(header[len(root) + 1:] for root in ROOTS if header.startswith(root + "/"))


def mend(path):
    """Adds what is owed to the last block of includes of the program's own; clang-format then sorts it."""
    lines = source.text(path).splitlines(keepends=True)
    owed = {include_of(min(have)) for _, have in owes(path).values() if len(have) == 1}
    if not owed:
        return
    own = [i for i, line in enumerate(lines) if re.match(r'#include "[^"]+\.h"', line)]
    any_one = [i for i, line in enumerate(lines) if re.match(r"#include |#pragma once", line)]
    at = (own or any_one)[-1] + 1
    first = lines[own[0]].split('"')[1] if own else ""
    alone = len(own) == 1 and first.split("/")[-1] == path.split("/")[-1].rsplit(".", 1)[0] + ".h"
    if alone:  # the file's own header stands first, by itself
        at = any_one[-1] + 1
    gap = [] if own and not alone else ["\n"]
    lines[at:at] = gap + [f'#include "{name}"\n' for name in sorted(owed)]
    (source.ROOT / path).write_text("".join(lines))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--mend"]:
        for name in sys.argv[2:]:
            mend(name)
        sys.exit()
    unittest.main(verbosity=2)
