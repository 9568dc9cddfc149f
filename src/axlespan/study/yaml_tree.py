"""YAML text to plain data, with the place of every value; nothing but mappings, lists and scalars is read."""

from __future__ import annotations

import re
import warnings
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


Pairs = dict[str, tuple[Node, Node]]
"""Key and value by the name that the key is."""


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
        raise InputError(rule, place=Place(file, line, column), fix="Delete it, if this is text")
    parser = YAML(typ="safe", pure=True)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ReusedAnchorWarning)
            node = parser.compose(text)
    except MarkedYAMLError as error:
        raise in_words(error, text, file) from None
    except RecursionError:
        raise InputError("is nested too deeply", place=Place(file, 1, 1)) from None
    except (
        YAMLError,
        ValueError,
        LookupError,
        TypeError,
        AttributeError,
        ArithmeticError,
        AssertionError,
    ) as error:
        # the parser lets some of its own slips through on odd input; to the user it is the same: no YAML
        raise InputError(f"is no YAML that can be read: {error}", place=Place(file)) from None
    if node is None or (_is_blank(node) and not text.strip(" -\t\r\n")):
        raise InputError("is empty", place=Place(file), fix="axlespan examples writes cases to begin with")
    return _Reader(text, file).document(node)


class _Reader:
    """Turns composed nodes into data and spots; keeps the path, and counts what aliases copy."""

    def __init__(self, text: str, file: str) -> None:
        self.text = text
        self.file = file
        self.faults: list[InputError] = []
        self.path: list[str] = []
        self.seen: set[int] = set()
        self.open: set[int] = set()
        self.copies = 0

    def document(self, node: Node) -> Document:
        data, root = self.value(node, node)
        return Document(data, root, self.faults)

    def value(self, node: Node, key: Node) -> tuple[Any, Spot]:
        self._guard(node)
        where = (*_start(key if _is_blank(node) else node), *_start(key), self._source(node))
        if isinstance(node, ScalarNode):
            return self._scalar(node), Spot(*where)
        self.open.add(id(node))
        if isinstance(node, MappingNode):
            both = {name: self._inner(name, value, at) for name, (at, value) in self._pairs(node).items()}
            self.open.discard(id(node))
            children = {name: spot for name, (_, spot) in both.items()}
            return {name: inner for name, (inner, _) in both.items()}, Spot(*where, children)
        listed = [self._inner(str(number), value, value) for number, value in enumerate(node.value)]
        self.open.discard(id(node))
        return [inner for inner, _ in listed], Spot(*where, [spot for _, spot in listed])

    def _inner(self, name: str, node: Node, key: Node) -> tuple[Any, Spot]:
        self.path.append(name)
        both = self.value(node, key)
        self.path.pop()
        return both

    def _guard(self, node: Node) -> None:
        """Refuse what grows without end: deep nesting, aliases to themselves, aliases of aliases."""
        if len(self.path) > DEEPEST:
            self._stop("is nested too deeply", node)
        if id(node) in self.open:
            self._stop("an alias (*name) stands within its own anchor (&name)", node)
        if id(node) in self.seen:
            self.copies += 1
            if self.copies > MOST_COPIES:
                self._stop(f"its aliases (*name) unfold to more than {MOST_COPIES} values", node)
        self.seen.add(id(node))

    def _stop(self, rule: str, node: Node) -> None:
        raise InputErrors([*self.faults, InputError(rule, place=Place(self.file, *_start(node)))])

    def _pairs(self, node: MappingNode) -> Pairs:
        """Return key and value by name: merged ones first, then the mapping's own, mended and once each."""
        own: Pairs = {}
        merged: Pairs = {}
        for key, value in node.value:
            name = str(key.value).strip() if isinstance(key, ScalarNode) else ""
            if isinstance(key, ScalarNode) and key.tag == f"{_TAG}merge":
                merged = {**self._merged(value), **merged}
            elif not name:
                self._fault("a key must be a word", key)
            elif node.flow_style and _is_blank(value) and self._mended(name, key, own):
                continue
            elif name in own:
                self._fault(f"is given twice; the first is in line {_start(own[name][0])[0]}", key, name)
            else:
                own[name] = key, value
        return {**merged, **own}

    def _merged(self, node: Node) -> Pairs:
        """Return what ``<<: *coach`` or ``<<: [*coach, *bogie]`` stands for."""
        if isinstance(node, MappingNode):
            self._guard(node)
            self.open.add(id(node))
            pairs = self._pairs(node)
            self.open.discard(id(node))
            return pairs
        if isinstance(node, SequenceNode):
            self._guard(node)
            return {name: pair for one in reversed(node.value) for name, pair in self._merged(one).items()}
        self._fault("<< must be followed by an alias of a mapping, such as *coach", node)
        return {}

    def _mended(self, name: str, key: Node, own: Pairs) -> bool:
        """Report and mend two slips within braces: ``{length:25 m}`` and ``{length: 12,5 m}``."""
        left, colon, right = name.partition(":")
        if colon and right and re.fullmatch(r"[A-Za-z_]\w*", left) and left not in own:
            self._fault("a space is missing after the colon", key, left, f"Write {left}: {right}")
            own[left] = key, _text(right, key)
            return True
        before, (at, value) = next(reversed(own.items()), ("", (key, key)))
        whole = str(value.value)
        if not before or not re.match(r"\d", name) or not re.fullmatch(r"[+-]?\d+", whole):
            return False
        self._fault("has a decimal comma", value, before, f"Write {whole}.{name}", Written(f"{whole},{name}"))
        own[before] = at, _text(f"{whole}.{name}", value)
        return True

    def _scalar(self, node: ScalarNode) -> Any:
        kind = str(node.tag).removeprefix(_TAG)
        text = str(node.value)
        try:
            if kind == "null":
                return None
            if kind == "bool":
                return _CONSTANTS.get(text.lower(), text)
            if kind == "int":
                return _integer(text)
            if kind == "float":
                return float(text.replace("_", "").lower().replace(".inf", "inf").replace(".nan", "nan"))
        except ValueError:
            return text
        if kind not in ("str", "timestamp", "merge", "value"):
            tag = str(node.tag).replace(_TAG, "!!")
            self._fault(f"tags such as {tag} are not read", node, fix="Delete the tag")
        return text

    def _source(self, node: Node) -> Written | None:
        """Return a value as it stands in the file, if it stands in one line."""
        text = self.text[
            node.start_mark.index : min(node.end_mark.index, node.start_mark.index + 200)
        ].strip()
        if isinstance(node, ScalarNode):
            return Written(text.partition("\n")[0] if node.style else str(node.value))
        flows = isinstance(node, (MappingNode, SequenceNode)) and node.flow_style
        return Written(text) if flows and "\n" not in text else None

    def _fault(
        self, rule: str, node: Node, name: str | None = None, fix: str | None = None, value: Any = None
    ) -> None:
        more = {} if value is None else {"value": value}
        path = ".".join([*self.path, *([name] if name else [])])
        place = Place(self.file, *_start(node))
        self.faults.append(InputError(rule, field=path or None, fix=fix, place=place, **more))


def _text(value: str, like: Node) -> ScalarNode:
    return ScalarNode(f"{_TAG}str", value, like.start_mark, like.end_mark)


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
