"""A YAML file of the library as a tree that knows where each value stands; every wrong value names its place."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from axlespan.errors import InputError, Place
from axlespan.model.dofs import nearest
from axlespan.units import Dimension, parse

_DEEPEST, _MOST = 20, 100_000


@dataclass(frozen=True)
class Item:
    """A value of a file: a word, a list or a mapping, and where it stands."""

    content: str | tuple[Item, ...] | Mapping[str, Item]
    place: Place
    path: str = ""
    keys: Mapping[str, Place] = field(default_factory=dict)  # places of the keys of a mapping

    def wrong(self, rule: str, fix: str | None = None) -> InputError:
        """Return an error that points here."""
        more: dict[str, Any] = {"value": self.content} if isinstance(self.content, str) else {}
        return InputError(rule, field=self.path or None, fix=fix, place=self.place, **more)

    # --- mappings ------------------------------------------------------------------------------

    def mapping(self, known: Iterable[str] | None = None, needed: Iterable[str] = ()) -> Mapping[str, Item]:
        """Return the items by key; keys must be known ones, and some must be there."""
        if not isinstance(self.content, Mapping):
            raise self.wrong("must be keys and values", "Write {key: value, ...}")
        names = None if known is None else list(known)
        for key in self.content:
            if names is not None and key not in names:
                fix = nearest(key, names, "key").fix
                if " " in key or self.content[key].content == "":  # {note: one, two}
                    fix = "Put a text that has a comma in quotes"
                raise InputError("is not a known key", field=self.below(key), fix=fix, place=self.keys[key])
        for key in needed:
            if key not in self.content:
                raise InputError("is missing", field=self.below(key), place=self.place)
        return self.content

    def below(self, key: str | int) -> str:
        """Dotted path of a key or an item of a list."""
        return f"{self.path}.{key}" if self.path else str(key)

    @property
    def is_mapping(self) -> bool:
        """Whether it has keys and values."""
        return isinstance(self.content, Mapping)

    @property
    def is_list(self) -> bool:
        """Whether it is a list."""
        return isinstance(self.content, tuple)

    # --- lists and words ------------------------------------------------------------------------

    def items(self) -> tuple[Item, ...]:
        """Return the items of a list."""
        if not isinstance(self.content, tuple):
            raise self.wrong("must be a list", "Write [a, b], or lines that begin with a hyphen")
        return self.content

    def text(self) -> str:
        """Return a word or a sentence."""
        if not isinstance(self.content, str) or not self.content.strip():
            raise self.wrong("must be a text")
        return " ".join(self.content.split())

    def quantity(self, dimension: Dimension) -> float:
        """Return a number in SI units."""
        try:
            return parse(self.text(), dimension)
        except InputError as error:
            raise self.wrong(error.rule, error.fix) from None

    def truth(self) -> bool:
        """Return true or false."""
        word = self.text().lower()
        if word not in ("true", "false"):
            raise self.wrong("must be true or false")
        return word == "true"

    def whole(self, at_least: int = 1) -> int:
        """Return a whole number."""
        word = self.text()
        if not word.isdigit() or int(word) < at_least:
            raise self.wrong(f"must be a whole number of at least {at_least}")
        return int(word)


def read_document(text: str, file: str) -> Item:
    """Return the tree of a YAML text.

    Raises
    ------
    InputError
        If it is no YAML, or a key is given twice; with line and column.
    """
    from ruamel.yaml import YAML  # late: nothing but library files needs it here
    from ruamel.yaml.error import MarkedYAMLError, ReusedAnchorWarning, YAMLError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ReusedAnchorWarning)
            node = YAML(typ="safe", pure=True).compose(text)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = Place(file, mark.line + 1, mark.column + 1) if mark else Place(file)
        raise InputError(f"is no YAML that can be read: {error.problem}", place=place) from None
    except YAMLError as error:
        raise InputError(f"is no YAML that can be read: {error}", place=Place(file)) from None
    if node is None:
        raise InputError("is empty", place=Place(file))
    return _Reader(file).item(node, "", frozenset())


class _Reader:
    """Turns composed nodes into items, and counts them: aliases of aliases grow without end."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.count = 0

    def item(self, node: Any, path: str, open_nodes: frozenset[int]) -> Item:
        """Return the item of a node that stands within others."""
        place = self.place(node)
        self.count += 1
        if id(node) in open_nodes or len(open_nodes) > _DEEPEST or self.count > _MOST:
            raise InputError("is nested too deeply, or has too many values", field=path or None, place=place)
        kind = type(node).__name__
        if kind == "ScalarNode":
            return Item("" if str(node.tag).endswith(":null") else str(node.value), place, path)
        inside = open_nodes | {id(node)}
        if kind == "SequenceNode":
            listed = (
                self.item(inner, _below(path, str(number)), inside) for number, inner in enumerate(node.value)
            )
            return Item(tuple(listed), place, path)
        content: dict[str, Item] = {}
        keys: dict[str, Place] = {}
        for key, inner in self.pairs(node, inside):
            name = str(key.value)
            if name in keys:
                rule = f"is given twice; the first is in line {keys[name].line}"
                raise InputError(rule, field=_below(path, name), place=self.place(key))
            keys[name] = self.place(key)
            content[name] = self.item(inner, _below(path, name), inside)
        return Item(content, place, path, keys)

    def pairs(self, node: Any, open_nodes: frozenset[int]) -> Iterator[tuple[Any, Any]]:
        """Keys and values of a mapping; ``<<: *anchor`` brings in those that it does not have itself."""
        own = {str(key.value) for key, _ in node.value}
        for key, value in node.value:
            if not str(key.tag).endswith(":merge"):
                yield key, value
            elif type(value).__name__ != "MappingNode" or id(value) in open_nodes:
                raise InputError(
                    "must be followed by one alias of a mapping", field="<<", place=self.place(key)
                )
            else:
                merged = self.pairs(value, open_nodes | {id(value)})
                yield from (pair for pair in merged if str(pair[0].value) not in own)

    def place(self, node: Any) -> Place:
        """Return where a node starts."""
        return Place(self.file, node.start_mark.line + 1, node.start_mark.column + 1)


def _below(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name
