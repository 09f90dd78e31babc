"""C++ sources read well enough to hold the house to its rules: tokens, functions, names declared. No compiler needed.

A token is (kind, text, line): kind `name`, `number`, `string`, `char`, `op` or `include`. Comments, and the lines of
the preprocessor but for its includes, are left out. What macros make is not seen."""
import functools, pathlib, re, typing

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEX = re.compile(r"""
    (?P<comment>//[^\n]*|/\*.*?\*/)
  | (?P<include>^[ \t]*\#[ \t]*include[ \t]*[<"][^>"\n]*[>"])
  | (?P<directive>^[ \t]*\#(?:[^\n\\]|\\.|\\\n)*)
  | (?P<raw>(?:u8|[uUL])?R"(?P<delimiter>[^()\\\s]{0,16})\(.*?\)(?P=delimiter)")
  | (?P<string>(?:u8|[uUL])?"(?:[^"\\\n]|\\.)*")
  | (?P<char>'(?:[^'\\\n]|\\.)+')
  | (?P<number>\.?\d(?:'?[\w.]|(?<=[eEpP])[+-])*)
  | (?P<name>[A-Za-z_]\w*)
  | (?P<op>::|->|<=>|<<=|==|!=|<=|>=|&&|\|\||\+\+|--|[-+*/%&|^]=|\.\.\.|[^\s\w])
""", re.X | re.S | re.M)


def files(*folders, kinds=("h", "cpp", "inc")):
    """Paths below the root, as text with slashes, in order."""
    return sorted(path.relative_to(ROOT).as_posix() for folder in folders for kind in kinds
                  for path in (ROOT / folder).rglob("*." + kind))


@functools.lru_cache(maxsize=None)
def text(path):
    return (ROOT / path).read_text()


@functools.lru_cache(maxsize=None)
def tokens(path):
    found, whole, line, at = [], text(path), 1, 0
    for match in LEX.finditer(whole):
        line += whole.count("\n", at, match.start())
        at = match.start()
        kind = "string" if match.lastgroup == "raw" or match["raw"] else match.lastgroup
        if kind in ("comment", "directive"):
            continue
        value = match.group()
        if kind == "string":
            value = value[value.index("(") + 1:value.rindex(")")] if match["raw"] else value[value.index('"') + 1:-1]
        elif kind == "include":
            value = value[re.search('[<"]', value).start():]
        found.append((kind, value, line))
    return tuple(found)


def includes(path):
    """What the `#include "..."` lines name."""
    return [value[1:-1] for kind, value, _ in tokens(path) if kind == "include" and value[0] == '"']


class Scope(typing.NamedTuple):
    """An open brace: `namespace`, `type`, `enum`, `function`, `lambda`, `block` (inside a function) or `list`."""
    kind: str
    name: str
    begins: int  # line of the declaration's first token
    head: tuple
    parentheses: int  # open before it


def outline(head):
    """The tokens of a declaration outside of (), [], a template's head, attributes and conditions."""
    kept, depth, angle = [], 0, 0
    for i, token in enumerate(head):
        text, before = token[1], head[i - 1][1] if i else ""
        if text == "<" and (angle or before == "template"):
            angle += 1
        elif angle:
            angle -= text == ">"
        elif text in ("(", "[") and token[0] == "op":
            depth += 1
            kept += [token] if depth == 1 else []
        elif text in (")", "]") and token[0] == "op":
            depth -= 1
            kept += [token] if depth == 0 else []
        elif depth == 0:
            kept.append(token)
    for i in range(len(kept) - 3, -1, -1):
        if kept[i][1] in ("__attribute__", "requires", "alignas") and kept[i + 1][1] == "(":
            del kept[i:i + 3]
    return kept


LAMBDA = re.compile(r"\] (?:\( [^{};]*\) )?(?:(?:mutable|noexcept|constexpr) )*(?:-> [\w:<>&* ]+ )?$")


def is_lambda(head):
    return bool(LAMBDA.search(" ".join(text for _, text, _ in head[-200:]) + " "))


def name_before(head, stops):
    """The last name before the first of these tokens."""
    names = []
    for kind, text, _ in head:
        if text in stops:
            break
        names += [text] if kind == "name" else []
    return names[-1] if names else ""


def name_of_function(words, at):
    """The name before the parameters, which begin at `at`."""
    if "operator" in words[:at]:
        return "operator" + "".join(words[words.index("operator") + 1:at])
    if at >= 3 and words[at - 2] == "::":
        return words[at - 3] + "::" + words[at - 1]
    return ("~" if at >= 2 and words[at - 2] == "~" else "") + words[at - 1] if at else "?"


def classify(head, outer):
    """What an opening brace after these tokens opens, and its name."""
    if outer in BODY:
        return "block", ""
    if outer == "list":
        return ("lambda", name_before(head, ("=", "{", "("))) if is_lambda(head) else ("list", "")
    flat = outline(head)
    words = [text for _, text, _ in flat]
    if "namespace" in words or (words[:1] == ["extern"] and len(flat) == 2):
        return "namespace", "::".join(text for kind, text, _ in flat[1:] if kind == "name")
    if "=" in words and "operator" not in words:
        return ("lambda", name_before(flat, "=")) if is_lambda(head) else ("list", "")
    if "(" in words:
        at = words.index("(")
        of_member = flat[-1][0] == "name" and words[-1] not in ("const", "noexcept", "override", "final")
        if ":" in words[at:] and (of_member or words[-1] == ">"):
            return "list", ""  # x{...} among a constructor's initialisers
        return "function", name_of_function(words, at)
    for word in ("enum", "struct", "class", "union"):
        if word in words:
            own = [token for token in flat if token[1] not in ("final", "enum", "struct", "class", "union")]
            return "enum" if word == "enum" else "type", name_before(own, (":", "<"))
    return "list", ""


BODY = ("function", "lambda", "block")


def walk(path):
    """(event, scopes, head, line): `open` and `close` of every brace, `end` at a `;`. The head is the declaration's
    tokens so far; inside of functions the last ones."""
    scopes, head, parentheses = [], [], 0
    for token in tokens(path):
        kind, text, line = token
        if kind == "include":
            continue
        inside = bool(scopes) and scopes[-1].kind in BODY
        if kind != "op":
            pass
        elif text in "([":
            parentheses += 1
        elif text in ")]":
            parentheses = max(0, parentheses - 1)
        elif text == "{":
            outer = scopes[-1].kind if scopes else "namespace"
            made = classify(head, "list" if parentheses and not inside else outer)
            scopes.append(Scope(*made, head[0][2] if head else line, tuple(head), parentheses))
            yield "open", scopes, head, line
            parentheses = parentheses if made[0] == "list" else 0
            head = head + [token] if made[0] == "list" else []
            continue
        elif text == "}" and scopes:
            yield "close", scopes, head, line
            closed = scopes.pop()
            parentheses = closed.parentheses
            if closed.kind in ("list", "lambda") or parentheses:
                head = [*closed.head, token]
            else:
                head = [("name", "struct", line)] if closed.kind in ("type", "enum") else []  # a variable may follow
            continue
        elif text == ";" and not parentheses:
            yield "end", scopes, head, line
            head = []
            continue
        elif text == ":" and len(head) == 1 and head[0][1] in ("public", "private", "protected"):
            head = []
            continue
        head = (head + [token])[-300:] if inside else head + [token]


def functions(path):
    """(name, first line, last line) of every function, and of lambdas that stand outside of one."""
    found = []
    for event, scopes, head, line in walk(path):
        if event == "close" and scopes[-1].kind in ("function", "lambda"):
            types = [s.name for s in scopes[:-1] if s.kind == "type" and s.name]
            found.append(("::".join(types + [scopes[-1].name]), scopes[-1].begins, line))
    return found


def registry_rows():
    """Names of the 41 rows."""
    return re.findall(r"X\(\d+, *(\w+)", text("src/parameters/list.h"))


class Names(typing.NamedTuple):
    """What a file declares: at namespace scope, by kind, and within types (members). Names in a namespace of their own
    inside of the program's go as `space::name`."""
    types: frozenset
    functions: frozenset
    constants: frozenset
    members: frozenset
    forward: frozenset  # types declared, not defined


KEYWORDS = set("void bool char int long short float double auto struct alignas decltype const unsigned".split())


def inner(space):
    """A namespace without the program's own around it."""
    return (space + "::").removeprefix("servodx::").removesuffix("::")


def declared_by(head):
    """(kind, name) of a declaration that ends in `;`, or None."""
    flat = outline(head)
    words = [text for _, text, _ in flat]
    if words[:1] == ["template"]:
        flat, words = flat[1:], words[1:]
    if not words or words[0] in ("static_assert", "friend", "return") or words[:2] == ["using", "namespace"]:
        return None
    if words[0] == "using":
        return "type", words[1] if "=" in words else words[-1]
    if words[0] in ("struct", "class", "union", "enum") and all(kind == "name" for kind, _, _ in flat):
        return "forward", words[-1]
    if "operator" in words:
        return None
    if "(" in words and words.index("(") and "=" not in words[:words.index("(")]:
        return "function", words[words.index("(") - 1]
    name = name_before(flat, ("=", "{", "[", ":"))
    return ("constant", name) if name not in ("", "struct", "default", "delete", "alignas") else None


@functools.lru_cache(maxsize=None)
def names(path):
    kinds = {kind: set() for kind in ("type", "function", "constant", "member", "forward")}

    def put(kind, name, scopes):
        if any(scope.kind in BODY for scope in scopes) or not name or name in KEYWORDS:
            return
        if any(scope.kind in ("type", "enum", "list") for scope in scopes):
            kinds["member"].add(name)
            return
        space = inner("::".join(scope.name for scope in scopes if scope.name))
        kinds[kind].add(f"{space}::{name}" if space else name)

    for event, scopes, head, _ in walk(path):
        if event == "end":
            made = declared_by(head)
            if made:
                put(*made, scopes)
        elif event == "close" and scopes[-1].kind in ("type", "enum", "function"):
            own = scopes[-1]
            put("function" if own.kind == "function" else "type", own.name.split("::")[-1], scopes[:-1])
    kinds["constant"].update(re.findall(r"^[ \t]*#[ \t]*define[ \t]+(\w{3,})", text(path), re.M))
    return Names(*(frozenset(kinds[kind]) for kind in ("type", "function", "constant", "member", "forward")))
