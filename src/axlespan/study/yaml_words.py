"""What is wrong with a YAML text, in words."""

from __future__ import annotations

import re
from typing import Final

from ruamel.yaml.error import MarkedYAMLError

from axlespan.errors import InputError, Place

_COLON: Final = "a second colon stands in this line"
# part of the parser's words: (rule, fix)
_WORDS: Final = (
    (r"character '\\t'", "a tab stands here", "Indent with spaces"),
    (r"cannot start any token", "a value cannot begin with this character", "Put the value in quotes"),
    (
        r"mapping values are not allowed",
        _COLON,
        "Put the text in quotes",
    ),
    (r"sequence entries are not allowed", "a list cannot begin here", "Begin the list on a line of its own, - first"),
    (r"could not find expected ':'", "a colon and a space are missing after a key", "Write key: value"),
    (r"expected ',' or '\}'", "a mapping in braces is not closed, or a comma is missing in it", "Write {a: 1, b: 2}"),
    (r"expected ',' or '\]'", "a list in brackets is not closed, or a comma is missing in it", "Write [1, 2]"),
    (r"unexpected end of stream", "a quoted text does not end", "Close the quotes"),
    (r"undefined alias '(.*)'", "no anchor &<0> stands before the alias *<0>", "Name what is repeated with &<0>"),
    (r"unknown escape character", "a backslash in double quotes begins no known character", "Use single quotes"),
    (r"found '(\]|\})'", "<0> closes nothing", "Delete it, or open it before"),
    (
        r"found '?<block (mapping|sequence) start>|found '?<block end>",
        "the indentation fits none of the lines above",
        "Indent the keys of a mapping alike",
    ),
    (r"expected <block end>, but found '(-|\?)'", "a list and a mapping are mixed here", "Indent what belongs together"),
    (r"expected <block end>", "the indentation fits none of the lines above", "Indent the keys of a mapping alike"),
    (r"found another document", "a second document (---) begins here", "Write one case in a file"),
    (r"expected '<document start>'", "text goes on after the end of the mapping", "Indent it, or delete the braces"),
    (r"", "is no YAML: <problem>", "Compare with a case of axlespan examples"),
)  # fmt: skip


def in_words(error: MarkedYAMLError, text: str, file: str) -> InputError:
    """Return an error of the parser with line, column and words for engineers."""
    problem = str(error.problem or error.context or error).replace("\n", " ")
    for pattern, rule, fix in _WORDS:
        match = re.search(pattern, problem)
        if match:
            words = match.groups()
            mark = error.problem_mark or error.context_mark
            if "not closed" in rule and error.context_mark and "stream end" in problem:
                mark = error.context_mark  # point to the bracket, not to the end of the file
            if "does not end" in rule and error.context_mark:
                mark = error.context_mark
            place = Place(file, mark.line + 1, mark.column + 1) if mark else Place(file)
            rule, fix = _more_exact(rule, fix, text, place)
            return InputError(_filled(rule, words, problem), place=place, fix=_filled(fix, words, problem))
    raise AssertionError("the last pattern fits all")


def _more_exact(rule: str, fix: str, text: str, place: Place) -> tuple[str, str]:
    """Tell a colon within a text from a line that is indented by mistake: the parser finds both at a colon."""
    if rule != _COLON or place.line is None or place.column is None:
        return rule, fix
    before = text.splitlines()[place.line - 1][: place.column - 1]
    if re.search(r":\s", before):
        return rule, fix
    return (
        "is indented more than the line above, which has a value already",
        "Indent the keys of a mapping alike",
    )


def _filled(words: str, parts: tuple[str, ...], problem: str) -> str:
    for number, part in enumerate(parts):
        words = words.replace(f"<{number}>", part)
    return words.replace("<problem>", problem)
