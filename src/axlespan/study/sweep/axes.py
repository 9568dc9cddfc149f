"""What varies: axes of values along dotted paths of the case."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from axlespan.study.checks import Whole
from axlespan.study.sweep.chance import SEED, Sampling, Variable, variable_of
from axlespan.study.sweep.node import Node
from axlespan.study.sweep.ranges import MOST, PLAIN, alike, amount, is_range, values_of_range
from axlespan.study.sweep.trains import Trains

FloatArray = npt.NDArray[np.float64]

_EXAMPLE: Final = "[80 km/h, 100 km/h], {from: 140 km/h, to: 420 km/h, step: 5 km/h}"
_FORMS: Final = ("from", "seeds", "factor", "distribution", "mix")

#: Values of a case by dotted path, as they are written in the base; None where it has none.
Given = Callable[[str], Any]


@dataclass(frozen=True, eq=False)
class Values:
    """The values that one path takes, one after the other."""

    path: str
    values: Sequence[Any]
    node: Node
    labels: Sequence[str] | None = None  # where the values themselves are no words or numbers
    listed: bool = False  # each stands in the file

    def __len__(self) -> int:
        return len(self.values)

    @property
    def written(self) -> bool:
        """Whether the values stand in the file as they are, and are not computed from what does."""
        return self.listed and self.node.name != "factor"

    def place(self, number: int) -> tuple[str | int, ...]:
        """Where a value stands in the study file."""
        return (*self.node.path, number) if self.listed else self.node.path


@dataclass(frozen=True, eq=False)
class Chance:
    """A path whose values are drawn: as many shares of probability as it needs, and how values follow."""

    path: str
    node: Node
    dimensions: int
    draw: Callable[[FloatArray], tuple[Sequence[Any], Sequence[str] | None]]


@dataclass(frozen=True, eq=False)
class Axis:
    """Paths whose values change together."""

    parts: tuple[Values, ...]

    def __len__(self) -> int:
        return len(self.parts[0])

    @property
    def paths(self) -> tuple[str, ...]:
        """The paths."""
        return tuple(part.path for part in self.parts)


def varied(path: str, node: Node, trains: Trains, given: Given) -> Values | Chance:
    """Read what stands under one path of ``vary``."""
    data = node.data
    if isinstance(data, list | tuple):
        return _listed(path, node, trains)
    if not isinstance(data, Mapping):
        if path == "train" and isinstance(data, str):
            names = trains.named(node)
            return Values(path, [trains.entries(name) for name in names], node, names)
        raise node.fault(
            "is one value, which does not vary", f"Write a list, [{data}], or put it into the base"
        )
    if "distribution" in data:
        variable = variable_of(node)
        return _drawn(path, node, variable, variable.texts)
    if "mix" in data:
        mix = trains.mix(node)
        return Chance(path, node, mix.dimensions, mix.draw)
    if "factor" in data:
        return _factors(path, node, given)
    if "seeds" in data:
        if path.rpartition(".")[2] != "seed":
            raise node.fault("are seeds, for paths such as crossing.irregularity.seed", f"Write {_EXAMPLE}")
        parts = node.keys(("seeds", "first"), "{seeds: 10, first: 1}")
        first = int(parts["first"].checked(SEED)) if "first" in parts else 1
        count = int(parts["seeds"].checked(Whole(at_most=MOST)))
        return Values(path, range(first, first + count), node)
    if is_range(data):
        return Values(path, values_of_range(node), node)
    raise node.fault(
        "does not say how the value varies", f"Write {_EXAMPLE}, or a mapping with {', '.join(_FORMS[1:])}"
    )


def _listed(path: str, node: Node, trains: Trains) -> Values:
    items = node.items("values", _EXAMPLE)
    for number, item in enumerate(items):
        if item.data is None:
            raise item.fault("is empty", "Write a value, or delete it")
        if item.data in [other.data for other in items[:number]] if len(items) < 1000 else False:
            raise item.fault("is named twice", "Delete one of the two")
    if path != "train":
        return Values(path, [item.data for item in items], node, None, True)
    names: list[str] = []
    values: list[Any] = []
    alone = True
    for number, item in enumerate(items, 1):
        if isinstance(item.data, str):
            found = trains.named(item)
            alone &= len(found) == 1
            names += found
            values += [trains.entries(name) for name in found]
        else:
            names.append(f"train {number}")
            values.append(list(item.data) if isinstance(item.data, list | tuple) else [item.data])
    return Values(path, values, node, names, alone)


def _factors(path: str, node: Node, given: Given) -> Values | Chance:
    parts = node.keys(("factor",), "{factor: [0.9, 1.1]}")
    inner, base = parts["factor"], given(path)
    if base is None:
        raise node.fault(
            "the base gives no value that a factor could multiply", "Write values in place of factors"
        )
    here = Node(base, node.source, node.path)
    try:
        like = amount(here)
    except Exception:
        raise node.fault("is no number in the base, which a factor could multiply") from None

    def scaled(numbers: Sequence[float]) -> list[Any]:
        return [like.text(number * like.number) for number in numbers]

    def exactly(numbers: Sequence[float]) -> list[Any]:  # 1.1 times 100 km/h as one writes it
        return [like.text(Decimal(repr(number)) * like.decimal) for number in numbers]

    if isinstance(inner.data, Mapping) and "distribution" in inner.data:
        variable = variable_of(inner)
        alike_number(inner, variable)
        return _drawn(path, node, variable, lambda shares: scaled(variable.values(shares).tolist()))
    if is_range(inner.data):
        return Values(path, exactly([float(one) for one in values_of_range(inner)]), node)
    items = inner.items("factors", "{factor: [0.9, 1.1]}")
    return Values(path, exactly([alike(item, PLAIN).number for item in items]), inner, None, True)


def alike_number(node: Node, variable: Variable) -> None:
    """Require a random factor to be a plain number."""
    if variable.like.unit:
        raise node.fault("must be a plain number: it multiplies the value of the base")


def _drawn(path: str, node: Node, variable: Variable, texts: Callable[[FloatArray], Sequence[Any]]) -> Chance:
    return Chance(path, node, 1, lambda shares: (texts(shares[:, 0]), None))


def sampled(chances: Sequence[Chance], sampling: Sampling) -> Axis:
    """All random variables as one axis."""
    shares = sampling.shares(sum(chance.dimensions for chance in chances))
    parts, begin = [], 0
    for chance in chances:
        values, labels = chance.draw(shares[:, begin : begin + chance.dimensions])
        parts.append(Values(chance.path, values, chance.node, labels))
        begin += chance.dimensions
    return Axis(tuple(parts))
