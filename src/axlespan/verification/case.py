"""What the verification book is made of: cases, and rows that compare a quantity with what it should be."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Row:
    """One quantity: what it should be, what came out, and how far apart the two may be."""

    quantity: str
    unit: str
    expected: float  # [unit]
    obtained: float  # [unit]
    scale: float  # [unit], the error is in parts of it
    of: str  # what the scale is: value, peak, static load, ...
    tolerance: float  # [-]
    origin: str  # where the expected value comes from

    @property
    def error(self) -> float:
        """``|obtained - expected| / scale`` [-]."""
        return abs(self.obtained - self.expected) / self.scale

    @property
    def ok(self) -> bool:
        """Whether the error is within the tolerance; a value that is not a number never is."""
        return self.error <= self.tolerance

    @property
    def verdict(self) -> str:
        """``ok`` or ``FAIL``."""
        return "ok" if self.ok else "FAIL"


def value(
    quantity: str,
    unit: str,
    expected: float,
    obtained: float,
    tolerance: float,
    origin: str,
    *,
    scale: float | None = None,
    of: str = "value",
) -> Row:
    """Return the row of a single number; the error is relative to the expected value unless scaled."""
    reach = abs(float(expected)) if scale is None else float(scale)
    return Row(quantity, unit, float(expected), float(obtained), reach, of, tolerance, origin)


def history(
    quantity: str,
    unit: str,
    time: npt.ArrayLike,
    expected: npt.ArrayLike,
    obtained: npt.ArrayLike,
    tolerance: float,
    origin: str,
    *,
    scale: float | None = None,
    of: str = "peak",
) -> Row:
    """Return the row of a history: its values where the two are farthest apart.

    Parameters
    ----------
    time, expected, obtained : array_like (n_time,)
        [s], [unit], [unit]; any other abscissa serves as well as time.
    scale : float, optional
        The largest absolute value of the expected history when left out [unit].
    """
    t, a, b = (np.asarray(values, dtype=np.float64) for values in (time, expected, obtained))
    if not t.shape == a.shape == b.shape:
        raise ValueError(
            f"{quantity}: histories of shapes {t.shape}, {a.shape}, {b.shape} cannot be compared"
        )
    worst = int(np.argmax(np.abs(b - a)))  # the first one that is not a number, if any
    reach = float(np.abs(a).max()) if scale is None else float(scale)
    return Row(quantity, unit, float(a[worst]), float(b[worst]), reach, of, tolerance, origin)


@dataclass(frozen=True)
class Case:
    """A problem with known answers."""

    name: str  # short, in the manner of file names: moving-force
    title: str
    source: str  # the literature, or the section of the theory pages
    description: str
    compute: Callable[[], Sequence[Row]]
    long: bool = False  # several seconds or more: run on request only


def case(
    name: str, title: str, source: str, *, long: bool = False
) -> Callable[[Callable[[], Sequence[Row]]], Case]:
    """Make a case of a function that returns rows; its docstring is the description."""

    def make(compute: Callable[[], Sequence[Row]]) -> Case:
        return Case(name, title, source, inspect.getdoc(compute) or "", compute, long)

    return make
