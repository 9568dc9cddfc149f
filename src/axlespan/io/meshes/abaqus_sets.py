"""Sets of an Abaqus input file: labels, ranges, other sets and sets of instances, resolved to positions.

Source: Abaqus Keywords Guide, *NSET and *ELSET; Abaqus Analysis Guide, "Assembly definition".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.io.lines import numbers_of, whole
from axlespan.io.meshes.abaqus_keywords import Keyword
from axlespan.io.meshes.assemble import Lookup
from axlespan.model.dofs import nearest

IntArray = npt.NDArray[np.int64]
_NONE = np.empty(0, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Scope:
    """What labels and names mean in a part, an instance or the assembly."""

    labels: IntArray  # (n,) of nodes or of elements
    lookup: Lookup
    first: int = 0  # position of the first in the whole mesh
    sets: Mapping[str, IntArray] = field(default_factory=dict)  # positions by name in upper case


@dataclass(frozen=True, eq=False)
class SetDefinition:
    """One keyword block that defines a set, or adds to it."""

    name: str
    keyword: Keyword
    instance: str = ""  # upper case
    labels: IntArray = field(default_factory=lambda: _NONE)  # of an element block or a node block

    @property
    def is_list(self) -> bool:
        """Whether the members stand in the data lines."""
        return self.keyword.name in ("NSET", "ELSET")


def resolve(
    definitions: Sequence[SetDefinition],
    own: Scope,
    instances: Mapping[str, Scope],
    of_elements: Mapping[str, IntArray] | None = None,
) -> dict[str, IntArray]:
    """Positions of the members of all sets by name, as first written.

    Parameters
    ----------
    definitions : sequence of SetDefinition
        All definitions of one kind (nodes, elements) in one part or in the assembly.
    own : Scope
        Labels without an instance.
    instances : mapping of str to Scope
        By name in upper case.
    of_elements : mapping of str to array, optional
        Nodes of element sets, by name in upper case.

    Raises
    ------
    InputError
        If a member is unknown, or sets contain each other in a circle.
    """
    return _Resolver(definitions, own, instances, of_elements or {}).all()


class _Resolver:
    def __init__(
        self,
        definitions: Sequence[SetDefinition],
        own: Scope,
        instances: Mapping[str, Scope],
        of_elements: Mapping[str, IntArray],
    ) -> None:
        self.own, self.instances, self.of_elements = own, instances, of_elements
        self.shown: dict[str, str] = {}
        self.definitions: dict[str, list[SetDefinition]] = {}
        for definition in definitions:
            self.shown.setdefault(definition.name.upper(), definition.name)
            self.definitions.setdefault(definition.name.upper(), []).append(definition)
        self.done: dict[str, IntArray] = {}
        self.open: list[str] = []

    def all(self) -> dict[str, IntArray]:
        return {self.shown[key]: self._members(key) for key in self.definitions}

    def _members(self, key: str) -> IntArray:
        if key not in self.done:
            self.open.append(key)
            found = [self._of(definition) for definition in self.definitions[key]]
            self.done[key] = np.unique(np.concatenate(found))
            self.open.pop()
        return self.done[key]

    def _of(self, definition: SetDefinition) -> IntArray:
        keyword = definition.keyword
        scope = self.own
        if definition.instance:
            if definition.instance not in self.instances:
                raise keyword.refused("must stand in the assembly, behind the instance that it names")
            scope = self.instances[definition.instance]
        if not definition.is_list:
            lines = np.full(len(definition.labels), keyword.line)
            return scope.lookup.positions(definition.labels, lines, f"set '{definition.name}'") + scope.first
        if keyword.name == "NSET" and keyword.parameters.get("ELSET"):
            name = keyword.parameters["ELSET"]
            if name.upper() not in self.of_elements:
                raise nearest(name, sorted(self.of_elements), "element set").located(keyword.place)
            return self.of_elements[name.upper()]
        if "GENERATE" in keyword.parameters:
            return self._ranges(keyword, scope)
        found = [_NONE]
        for row, words in enumerate(keyword.words()):
            numbers = numbers_of([words], len(words)) if words else None
            if numbers is not None:
                at_lines = np.repeat(keyword.numbers[row : row + 1], len(words))
                labels = whole(numbers[0], at_lines, keyword.file, "member of a set")
                found.append(
                    scope.lookup.positions(labels, at_lines, f"set '{definition.name}'") + scope.first
                )
            else:
                found += [self._word(word, keyword, row, scope) for word in words if word]
        return np.concatenate(found)

    def _ranges(self, keyword: Keyword, scope: Scope) -> IntArray:
        found = [_NONE]
        for row, words in enumerate(keyword.words()):
            numbers = numbers_of([words], len(words)) if 2 <= len(words) <= 3 else None
            if numbers is None:
                raise keyword.error("must be first, last and step (GENERATE)", row)
            ends = whole(numbers, keyword.numbers[row : row + 1], keyword.file, "range of a set")[0]
            first, last, step = int(ends[0]), int(ends[1]), int(ends[2]) if len(ends) == 3 else 1
            if step < 1:
                raise keyword.error("must have a positive step (GENERATE)", row)
            inside = (scope.labels >= first) & (scope.labels <= last) & ((scope.labels - first) % step == 0)
            if not inside.any():
                raise keyword.error("names nothing that is in the file (GENERATE)", row)
            found.append(np.flatnonzero(inside) + scope.first)
        return np.concatenate(found)

    def _word(self, word: str, keyword: Keyword, row: int, scope: Scope) -> IntArray:
        key = word.strip('"').upper()
        if key in self.open:
            raise keyword.error("makes the set contain itself", row)
        if scope is not self.own and key in scope.sets:
            return scope.sets[key]
        if key in self.definitions:
            return self._members(key)
        owner, _, rest = key.partition(".")
        if owner in self.instances and rest:
            scope, key = self.instances[owner], rest
            if key in scope.sets:
                return scope.sets[key]
        if key.isdecimal() and len(key) < 16:
            lines = keyword.numbers[row : row + 1]
            return scope.lookup.positions(np.array([int(key)]), lines, "member of a set") + scope.first
        error = nearest(key, sorted(self.definitions), "set")
        raise InputError(
            error.rule,
            field=f"*{keyword.name}",
            value=word,
            fix=error.fix,
            place=keyword.place_of(row),
        )
