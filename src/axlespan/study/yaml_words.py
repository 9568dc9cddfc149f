"""What is wrong with a YAML text, in words."""

from __future__ import annotations

import re
from typing import Final

from ruamel.yaml.error import MarkedYAMLError

from axlespan.errors import InputError, Place

_QUOTES: Final = "Put the value in quotes"
_ALIKE: Final = "Indent the keys of a mapping alike"
_ASTRAY: Final = "is indented like none of the lines above"

# pattern in the parser's words: (rule, fix); <0> stands for what the pattern caught
_WORDS: Final[dict[str, tuple[str, str]]] = {
    r"character '\\t'": ("a tab stands here", "Indent with spaces"),
    r"character '(.)' that cannot start": ("a value cannot begin with '<0>'", _QUOTES),
    r"sequence entries are not allowed": ("a list cannot begin here", "Begin it on the next line"),
    r"unexpected end of stream": ("the quotes are not closed", "Close them at the end of the text"),
    r"undefined alias '(.*)'": ("no anchor &<0> stands before this alias", "Name what it repeats with &<0>"),
    r"unknown escape character": ("a backslash stands in double quotes", "Use single quotes"),
    r"expected the node content, but found '([,:\]}])'": (
        "a value is missing before '<0>'",
        "Write it, or delete '<0>'",
    ),
    r"found '([\]}])'": ("'<0>' closes nothing", "Delete it, or open it before"),
    r"found '?<block (?:mapping|sequence) start>": (_ASTRAY, _ALIKE),
    r"expected <block end>, but found '-'": (
        "an entry of a list stands among keys",
        "Indent the list under its key",
    ),
    r"expected <block end>, but found '\?'": (
        "a key stands among the entries of a list",
        "Indent the list under a key of its own",
    ),
    r"expected <block end>": (_ASTRAY, _ALIKE),
    r"found '<stream end>'": ("the text ends here, within brackets or braces", "Close them"),
    r"another document": ("a second document (---) begins here", "Write one case in a file"),
    r"expected '<document start>'": (
        "stands behind the end of the case",
        "Delete it, or the brackets around the case",
    ),
}


def in_words(error: MarkedYAMLError, text: str, file: str) -> InputError:
    """Return an error of the parser with line, column and words for engineers."""
    problem = str(error.problem or error.context or error).replace("\n", " ")
    at, start = (
        (mark.line, mark.column) if mark else (0, 0)
        for mark in (error.problem_mark or error.context_mark, error.context_mark or error.problem_mark)
    )
    line = [*text.splitlines(), ""][at[0]] if at[0] <= text.count("\n") else ""
    if "mapping values are not allowed" in problem:
        if re.search(r":\s", line[: at[1]]):
            rule, fix = "has a second colon", "Put the text behind the first colon in quotes"
        else:
            at, rule, fix = (at[0], _indent(line)), "is indented more than the line above allows", _ALIKE
    elif "could not find expected ':'" in problem:
        at, (rule, fix) = start, _without_colon(text.splitlines()[start[0]])
    elif bracket := re.search(r"expected ',' or '([\]}])'", problem):
        if at[1] == 0 or "stream end" in problem:
            at, rule, fix = start, "this bracket is not closed", f"Add {bracket[1]}"
        else:
            rule, fix = f"a comma or {bracket[1]} is missing before this", "Separate entries by a comma"
    else:
        if "unexpected end of stream" in problem:
            at = start
        rule, fix = _looked_up(problem)
    return InputError(rule, place=Place(file, at[0] + 1, at[1] + 1), fix=fix)


def _without_colon(line: str) -> tuple[str, str]:
    key = re.match(r"\s*(?:- )?(\w+):(\S.*)", line)
    if key:
        return "a space is missing after the colon", f"Write {key[1]}: {key[2]}"
    return "has no colon", "Write key: value"


def _looked_up(problem: str) -> tuple[str, str]:
    for pattern, (rule, fix) in _WORDS.items():
        match = re.search(pattern, problem)
        if match:
            caught = (match.groups() or ("",))[0]
            return rule.replace("<0>", caught), fix.replace("<0>", caught)
    return f"is no YAML: {problem}", "Compare it with a case of axlespan examples"


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())
