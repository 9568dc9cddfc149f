"""Fields of dataclasses, told by the comments beside them: their names, types and what the comments say.

The code says shape and unit of a field once, in a comment behind it; the API pages show them as parameters.
"""

from __future__ import annotations

import ast
import inspect
import io
import textwrap
import tokenize
from dataclasses import dataclass, is_dataclass
from typing import Any


@dataclass(frozen=True)
class FieldTold:
    """A field: its name, type as written, default as written or empty, and its comment."""

    name: str
    type: str
    default: str
    comment: str


def fields_of(cls: type) -> list[FieldTold]:
    """Return the fields of a dataclass that its own class body gives, in order; none for other classes."""
    if not is_dataclass(cls):
        return []
    source = textwrap.dedent(inspect.getsource(cls))
    comments = _comments(source)
    (body,) = [node for node in ast.parse(source).body if isinstance(node, ast.ClassDef)]
    found = []
    for node in body.body:
        if not isinstance(node, ast.AnnAssign) or not isinstance(node.target, ast.Name):
            continue
        kind = ast.unparse(node.annotation)
        if node.target.id.startswith("_") or "ClassVar" in kind:
            continue
        default = "" if node.value is None else ast.unparse(node.value)
        said = " ".join(
            comments[row] for row in range(node.lineno, (node.end_lineno or 0) + 1) if row in comments
        )
        found.append(FieldTold(node.target.id, kind, default, said))
    return found


def _comments(source: str) -> dict[int, str]:
    """Return comments by their lines; tool markers are none."""
    found = {}
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        text = token.string.lstrip("#: ")
        if token.type == tokenize.COMMENT and not text.startswith(("fmt:", "type:", "noqa")):
            found[token.start[0]] = text
    return found


def section(fields: list[FieldTold]) -> list[str]:
    """Return the lines of a Parameters section."""
    lines = ["", "Parameters", "----------"]
    for field in fields:
        default = _plain(field.default)
        lines.append(f"{field.name} : {field.type}" + (f", default {default}" if default else ""))
        lines.append(f"    {_sentence(field.comment)}" if field.comment else "    …")
    return lines


def _plain(default: str) -> str:
    return "" if not default or default.startswith("field(") or default == "None" else default


def _sentence(comment: str) -> str:
    return comment if comment.endswith((".", "]", "…")) else comment + "."


def tell(_app: Any, what: str, _name: str, thing: Any, _options: Any, lines: list[str]) -> None:
    """Give classes whose docstring names no parameters those of their fields."""
    if what != "class" or any(line.strip() == "Parameters" for line in lines):
        return
    fields = [field for field in fields_of(thing) if field.comment or field.type]
    if not fields:
        return
    lines[:] = insert(lines, section(fields))


#: Docstrings of properties as they are written, by their names.
_properties: dict[str, list[str]] = {}


def keep(_app: Any, what: str, name: str, _thing: Any, _options: Any, lines: list[str]) -> None:
    """Remember a property's docstring: napoleon would take what stands before a colon for its type."""
    if what == "property" and "------" not in "".join(lines):
        _properties[name] = list(lines)


def restore(_app: Any, what: str, name: str, _thing: Any, _options: Any, lines: list[str]) -> None:
    """Put it back."""
    if what == "property" and name in _properties:
        lines[:] = _properties.pop(name)


def insert(lines: list[str], new: list[str]) -> list[str]:
    """Return a docstring with a section before its first one."""
    heads = [i for i in range(1, len(lines)) if lines[i].strip() and set(lines[i].strip()) == {"-"}]
    at = heads[0] - 1 if heads else len(lines)
    return [*lines[:at], *new, "", *lines[at:]]
