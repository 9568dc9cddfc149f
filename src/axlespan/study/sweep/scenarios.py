"""The scenarios of a study: numbered from 0, made when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.study.sweep.axes import Axis, Values
from axlespan.study.sweep.spec import Spec

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Scenarios:
    """All products of the axes; the last axis runs fastest."""

    axes: tuple[Axis, ...]

    @classmethod
    def of(cls, spec: Spec) -> Scenarios:
        """The scenarios of a study."""
        return cls(spec.axes)

    def __len__(self) -> int:
        return prod(len(axis) for axis in self.axes)

    @cached_property
    def parts(self) -> tuple[Values, ...]:
        """What varies, path by path."""
        return tuple(part for axis in self.axes for part in axis.parts)

    @property
    def paths(self) -> tuple[str, ...]:
        """The paths that vary."""
        return tuple(part.path for part in self.parts)

    @cached_property
    def _axis_of(self) -> IntArray:
        """Axis of each path (n_path,)."""
        return np.repeat(np.arange(len(self.axes)), [len(axis.parts) for axis in self.axes])

    def numbers(self, ids: npt.ArrayLike) -> IntArray:
        """Which value of each axis (n, n_axis) scenarios (n,) have."""
        rest = np.asarray(ids, dtype=np.int64).copy()
        result = np.zeros((len(rest), len(self.axes)), dtype=np.int64)
        for k in range(len(self.axes) - 1, -1, -1):
            rest, result[:, k] = np.divmod(rest, len(self.axes[k]))
        return result

    def values(self, ids: Sequence[int]) -> list[tuple[Any, ...]]:
        """Values of all paths, scenario by scenario."""
        chosen = self.numbers(ids)[:, self._axis_of].tolist()
        return [tuple(part.values[k] for part, k in zip(self.parts, row, strict=True)) for row in chosen]

    def labels(self, ids: Sequence[int]) -> list[tuple[str | None, ...]]:
        """Labels of all paths, where values have labels."""
        chosen = self.numbers(ids)[:, self._axis_of].tolist()
        return [
            tuple(part.labels[k] if part.labels else None for part, k in zip(self.parts, row, strict=True))
            for row in chosen
        ]

    def groups(self, ids: IntArray, prefixes: Sequence[str]) -> IntArray:
        """Numbers (n,) that are equal where scenarios agree in all paths that begin with one of the prefixes."""
        of_axes = [
            k
            for k, axis in enumerate(self.axes)
            if any(path == p or path.startswith(f"{p}.") for path in axis.paths for p in prefixes)
        ]
        chosen = self.numbers(ids)
        result = np.zeros(len(ids), dtype=np.int64)
        for k in of_axes:
            result = result * len(self.axes[k]) + chosen[:, k]
        return result

    def amounts(self, ids: IntArray, path: str) -> FloatArray:
        """Numbers (n,) that a path has, in the unit that its values are written in; zeros where it has none."""
        for k, axis in enumerate(self.axes):
            for part in axis.parts:
                if part.path == path and (numbers := _amounts(part)) is not None:
                    return numbers[self.numbers(ids)[:, k]]
        return np.zeros(len(ids))

    def one_by_one(self, most: int) -> Iterator[tuple[int, int, int]]:
        """Scenarios that differ from the first in one axis: id, axis and number of its value.

        Of an axis with more values than ``most`` the smallest, the largest and others in between are taken.
        """
        strides = [prod(len(axis) for axis in self.axes[k + 1 :]) for k in range(len(self.axes))]
        yield 0, 0, 0
        for k, axis in enumerate(self.axes):
            for number in _spread(axis, most):
                if number:
                    yield number * strides[k], k, number


def _spread(axis: Axis, most: int) -> list[int]:
    if len(axis) <= most:
        return list(range(len(axis)))
    chosen = set(np.linspace(0, len(axis) - 1, most).astype(int).tolist())
    for part in axis.parts:
        numbers = _amounts(part)
        if numbers is not None:
            chosen |= {int(numbers.argmin()), int(numbers.argmax())}
    return sorted(chosen)


def _amounts(part: Values) -> FloatArray | None:
    """The numbers of values that are numbers, or numbers with a unit."""
    try:
        return np.array([float(str(value).split()[0]) for value in part.values])
    except (ValueError, IndexError):
        return None
