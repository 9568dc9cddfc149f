"""YAML text to plain data, with the place of every value; nothing but mappings, lists and scalars is read."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Final

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, ReusedAnchorWarning, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from axlespan.errors import InputError, Place
from axlespan.study.faults import InputErrors
from axlespan.study.yaml_words import in_words

DEEPEST: Final = 40
MOST_COPIES: Final = 100_000
_TAG: Final = "tag:yaml.org,2002:"
_UNREADABLE: Final = re.compile(
    "[^\t\n\r\x20-\x7e\xa0-\u2027\u202a-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]"
)
_CONSTANTS: Final[dict[str, Any]] = {
    "true": True,
    "false": False,
    "yes": True,
    "no": False,
    "on": True,
    "off": False,
}


class Written(str):
    """A value as it stands in the file; messages show it without quotes of their own."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


@dataclass(frozen=True, slots=True)
class Spot:
    """Where a value stands in the file, and where its key does; lines and columns count from 1."""

    line: int
    column: int
    key_line: int
    key_column: int
    written: Written | None
    children: dict[str, Spot] | list[Spot] | None = None


@dataclass
class Document:
    """Plain data of a YAML file, the places of its values, and what is wrong with its form."""

    data: Any
    root: Spot
    faults: list[InputError] = field(default_factory=list)


def read_yaml(text: str, file: str) -> Document:
    """Return the data of a YAML text.

    Keys that are given twice and slips of form that can be mended are reported in ``faults``.

    Raises
    ------
    InputError
        If it is no YAML, with line and column.
    """
    strange = _UNREADABLE.search(text)
    if strange:
        line, column = _line_and_column(text, strange.start())
        rule = f"a control character, U+{ord(strange[0]):04X}, stands here"
        raise InputError(
            rule, place=Place(file, line, column), fix="Is this a text file? Delete the character"
        )
    parser = YAML(typ="safe", pure=True)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ReusedAnchorWarning)
            node = parser.compose(text)
    except MarkedYAMLError as error:
        raise in_words(error, text, file) from None
    except RecursionError:
        raise InputError("is nested too deeply", place=Place(file, 1, 1)) from None
    except (YAMLError, ValueError, LookupError, TypeError, AttributeError, AssertionError) as error:
        # the parser lets some of its own slips through on odd input; to the user it is the same: no YAML
        raise InputError(f"is no YAML that can be read: {error}", place=Place(file)) from None
    if node is None:
        raise InputError("is empty", place=Place(file), fix="axlespan examples writes cases to begin with")
    return _Reader(text, file).document(node)


class _Reader:
    """Turns composed nodes into data and spots; counts what aliases copy."""

    def __init__(self, text: str, file: str) -> None:
        self.text = text
        self.file = file
        self.faults: list[InputError] = []
        self.seen: set[int] = set()
        self.copies = 0
        self.open: set[int] = set()

    def document(self, node: Node) -> Document:
        data, root = self.value(node, node, 0)
        return Document(data, root, self.faults)

    def value(self, node: Node, key: Node, depth: int) -> tuple[Any, Spot]:
        self._guard(node, depth)
        line, column = _start(node)
        spot = (line, column, *_start(key))
        if isinstance(node, MappingNode):
            data, children = {}, {}
            self.open.add(id(node))
            for name, inner_key, inner in self._pairs(node):
                data[name], children[name] = self.value(inner, inner_key, depth + 1)
            self.open.discard(id(node))
            return data, Spot(*spot, self._source(node), children)
        if isinstance(node, SequenceNode):
            self.open.add(id(node))
            both = [self.value(inner, inner, depth + 1) for inner in node.value]
            self.open.discard(id(node))
            return [item for item, _ in both], Spot(*spot, self._source(node), [child for _, child in both])
        return self._scalar(node), Spot(*spot, self._source(node))

    def _guard(self, node: Node, depth: int) -> None:
        """Refuse what grows without end: deep nesting, aliases to themselves, aliases of aliases."""
        if depth > DEEPEST:
            self._stop("is nested too deeply", node)
        if id(node) in self.open:
            self._stop("an alias (*name) stands within its own anchor (&name)", node)
        if id(node) in self.seen:
            self.copies += 1
            if self.copies > MOST_COPIES:
                self._stop(f"its aliases (*name) unfold to more than {MOST_COPIES} values", node)
        self.seen.add(id(node))

    def _stop(self, rule: str, node: Node) -> None:
        raise InputErrors([*self.faults, InputError(rule, place=self._place(node))])

    def _pairs(self, node: MappingNode) -> Iterator[tuple[str, Node, Node]]:
        """Yield name, key and value of a mapping: merged ones first, then its own, mended and once each."""
        own: dict[str, tuple[Node, Node]] = {}
        merged: dict[str, tuple[Node, Node]] = {}
        before: tuple[Node, Node] | None = None
        for key, value in node.value:
            if not isinstance(key, ScalarNode):
                self._fault("a key must be a word", key)
                continue
            if key.tag == f"{_TAG}merge":
                merged = {**dict(self._merged(value)), **merged}
                continue
            name = str(key.value).strip()
            if node.flow_style and self._mended(name, key, value, own, before):
                continue
            if name in own:
                self._fault(f"is given twice; the first is in line {_start(own[name][0])[0]}", key, name)
                continue
            own[name] = before = (key, value)
        for name, (key, value) in {**merged, **own}.items():
            yield name, key, value

    def _merged(self, node: Node) -> Iterator[tuple[str, tuple[Node, Node]]]:
        if isinstance(node, SequenceNode):
            for one in reversed(node.value):
                yield from self._merged(one)
        elif isinstance(node, MappingNode):
            self._guard(node, 0)
            self.open.add(id(node))
            for name, key, value in self._pairs(node):
                yield name, (key, value)
            self.open.discard(id(node))
        else:
            self._fault("<< must be followed by an alias of a mapping, such as *coach", node)

    def _mended(
        self,
        name: str,
        key: ScalarNode,
        value: Node,
        own: dict[str, tuple[Node, Node]],
        before: tuple[Node, Node] | None,
    ) -> bool:
        """Report and mend two slips within braces: ``{length:25 m}`` and ``{length: 12,5 m}``."""
        if not _is_blank(value):
            return False
        left, colon, right = name.partition(":")
        if colon and right and re.fullmatch(r"[A-Za-z_]\w*", left) and left not in own:
            self._fault("a space is missing after the colon", key, left, f"Write {left}: {right}")
            mended = ScalarNode(f"{_TAG}str", right, key.start_mark, key.end_mark)
            own[left] = (key, mended)
            return True
        if before and re.match(r"\d", name) and isinstance(before[1], ScalarNode):
            whole = str(before[1].value)
            if re.fullmatch(r"[+-]?\d+", whole):
                self._fault(
                    "has a decimal comma",
                    before[1],
                    str(before[0].value),
                    f"Write {whole}.{name}",
                    Written(f"{whole},{name}"),
                )
                return True
        return False

    def _scalar(self, node: Node) -> Any:
        kind = str(node.tag).removeprefix(_TAG)
        text = str(node.value)
        if kind in ("str", "timestamp", "merge", "value"):
            return text
        if kind == "null":
            return None
        if kind == "bool":
            return _CONSTANTS.get(text.lower(), text)
        try:
            if kind == "int":
                return _integer(text)
            if kind == "float":
                return float(text.replace("_", "").lower().replace(".inf", "inf").replace(".nan", "nan"))
        except ValueError:
            return text
        self._fault(f"tags such as {node.tag} are not read", node, fix="Delete it")
        return None

    def _source(self, node: Node) -> Written | None:
        """Return a value as it stands in the file, if it stands in one line."""
        start, end = node.start_mark.index, node.end_mark.index
        text = self.text[start : min(end, start + 200)].strip()
        if isinstance(node, ScalarNode):
            return Written(text.partition("\n")[0] if node.style else str(node.value))
        return Written(text) if node.flow_style and "\n" not in text else None

    def _fault(
        self, rule: str, node: Node, name: str | None = None, fix: str | None = None, value: Any = None
    ) -> None:
        more = {} if value is None else {"value": value}
        self.faults.append(InputError(rule, field=name, fix=fix, place=self._place(node), **more))

    def _place(self, node: Node) -> Place:
        return Place(self.file, *_start(node))


def _start(node: Node) -> tuple[int, int]:
    return node.start_mark.line + 1, node.start_mark.column + 1


def _is_blank(node: Node) -> bool:
    return isinstance(node, ScalarNode) and node.tag == f"{_TAG}null" and not node.value


def _integer(text: str) -> int | float:
    digits = text.replace("_", "")
    body = digits.lstrip("+-").lower()
    base = {"0x": 16, "0o": 8, "0b": 2}.get(body[:2], 10)
    if base == 10 and len(body) > 300:
        return float(digits)  # int() refuses thousands of digits; no quantity has them
    return int(digits, base)


def _line_and_column(text: str, index: int) -> tuple[int, int]:
    before = text[:index]
    return before.count("\n") + 1, index - (before.rfind("\n") + 1) + 1
