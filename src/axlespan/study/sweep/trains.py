"""Trains that a study names: of its own, of the library, sets of them, and random mixes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.study.checks import Measured, Whole
from axlespan.study.faults import InputErrors, nearest
from axlespan.study.sweep.chance import Variable, variable_of
from axlespan.study.sweep.node import Node
from axlespan.study.sweep.ranges import amount
from axlespan.units import LENGTH, NUMBER, TIME

FloatArray = npt.NDArray[np.float64]

HEADWAY: Final = "headway"
"""Key of an entry that stands for a gap [m] once the speed is known: time [s] times speed."""

_MIX: Final = "{mix: {ice3: 2, hslm-a1: 1}, trains: 2, gap: {distribution: uniform, from: 200 m, to: 800 m}}"
_SETS: Final[Mapping[str, tuple[str, ...]]] = {
    # EN 1991-2, table 6.3
    "hslm-a": tuple(f"hslm-a{number}" for number in range(1, 11)),
}


@dataclass(frozen=True)
class Trains:
    """What a study may call a train."""

    own: Mapping[str, list[Any]]  # entries by name
    library: tuple[str, ...] = ()  # empty: any name is taken, and refused when it is built

    def named(self, node: Node) -> list[str]:
        """The trains that a word stands for: one, or those of a set."""
        word = str(node.data)
        if word in self.own:
            return [word]
        if word in _SETS:
            missing = [name for name in _SETS[word] if self.library and name not in self.library]
            if missing:
                raise node.fault(f"has trains that the library lacks: {', '.join(missing)}")
            return list(_SETS[word])
        if self.library and word not in self.library:
            near = nearest(word, (*self.own, *_SETS, *self.library))
            fix = (
                f"Did you mean {near}?" if near else "axlespan library lists them; or define it under trains"
            )
            raise node.fault("no such train", fix)
        return [word]

    def entries(self, name: str) -> list[Any]:
        """The entries of a named train."""
        return list(self.own[name]) if name in self.own else [{"vehicle": name}]

    def mix(self, node: Node) -> Mix:
        """Read ``{mix: {name: weight, ...}, trains: n, gap: ...}``."""
        parts = node.keys(("mix", "trains", "gap", HEADWAY), f"train: {_MIX}")
        names, weights = [], []
        for name, weight in parts["mix"].entries("trains and their shares", _MIX):
            found = self.named(Node(name, node.source, (*parts["mix"].path, name)))
            share = weight.checked(Measured(NUMBER, above=0.0))
            names += found
            weights += [share / len(found)] * len(found)
        if not names:
            raise parts["mix"].fault("holds no trains", f"Write train: {_MIX}")
        count = int(parts["trains"].checked(Whole(at_most=100))) if "trains" in parts else 1
        apart = [parts[key] for key in ("gap", HEADWAY) if key in parts]
        if len(apart) > 1:
            raise apart[1].fault("says again what gap says", "Keep one of the two")
        if count > 1 and not apart:
            rule = "is missing: how far the trains are from each other"
            fix = "Add gap: {distribution: uniform, from: 200 m, to: 800 m}"
            raise node.source.blame((*node.path, "gap"), rule, fix)
        space = _space(apart[0]) if apart and count > 1 else None
        shares = np.cumsum(weights) / np.sum(weights)
        return Mix(self, tuple(names), shares, count, apart[0].name if apart else "gap", space)


@dataclass(frozen=True, eq=False)
class Mix:
    """Random traffic: so many trains one behind the other, each drawn by its share."""

    trains: Trains
    names: tuple[str, ...]
    shares: FloatArray  # (n_name,) cumulative
    count: int
    key: str  # gap or headway
    space: Variable | float | None

    @property
    def dimensions(self) -> int:
        """Shares of probability that one draw needs."""
        return self.count + (self.count - 1 if isinstance(self.space, Variable) else 0)

    def draw(self, shares: FloatArray) -> tuple[Sequence[Any], Sequence[str]]:
        """Trains and their labels from shares (n, dimensions)."""
        chosen = np.minimum(
            np.searchsorted(self.shares, shares[:, : self.count], side="right"), len(self.names) - 1
        )
        gaps = self._gaps(shares)
        values, labels = [], []
        for row in range(len(shares)):
            names = [self.names[k] for k in chosen[row]]
            train = self.trains.entries(names[0])
            for later, name in enumerate(names[1:]):
                first, *rest = self.trains.entries(name)
                own = {key: value for key, value in first.items() if key not in ("gap", "offset")}
                train = [*train, {**own, self.key: gaps[row, later]}, *rest]
            values.append(train)
            labels.append(" + ".join(names))
        return values, labels

    def _gaps(self, shares: FloatArray) -> FloatArray:
        if isinstance(self.space, Variable):
            drawn = [
                self.space.values(column) * self.space.like.scale for column in shares[:, self.count :].T
            ]
            return np.array(drawn).T
        return np.full((len(shares), max(self.count - 1, 0)), self.space or 0.0)


def _space(node: Node) -> Variable | float:
    dimension = TIME if node.name == HEADWAY else LENGTH
    if isinstance(node.data, Mapping):
        variable = variable_of(node)
        if not dimension.accepts(variable.like.exponents) or not variable.like.unit:
            raise node.fault(f"must be drawn from {dimension.name}s, with their unit")
        low = float(variable.values(np.zeros(1))[0])
        if low < 0.0:
            raise node.fault("can become negative", "Use a distribution that begins at a positive value")
        return variable
    value = float(node.checked(Measured(dimension, at_least=0.0)))
    amount(node)
    return value


def trains_of(node: Node | None, library: Sequence[str]) -> Trains:
    """Read ``trains``: trains of the study by name."""
    own: dict[str, list[Any]] = {}
    faults: list[InputError] = []
    for name, entries in node.entries("trains", "{freight: [{vehicle: ...}]}") if node else ():
        if isinstance(entries.data, Mapping):
            own[name] = [entries.data]
        elif (
            isinstance(entries.data, list)
            and entries.data
            and all(isinstance(e, Mapping) for e in entries.data)
        ):
            own[name] = entries.data
        else:
            faults.append(entries.fault("must be a list of vehicles", "Write [{vehicle: ice3, count: 8}]"))
    if faults:
        raise InputErrors(faults)
    return Trains(own, tuple(library))
