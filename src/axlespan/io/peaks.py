"""Peaks of histories: how large, at which column, when."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.interaction.result import Result

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Peak:
    """An extreme value of a table of histories."""

    value: float
    row: int  # time index
    column: int


def highest(values: FloatArray, columns: Sequence[int] | None = None) -> Peak | None:
    """The largest value of (n_time, n), or of some of its columns; None if there is none."""
    table = values if columns is None else values[:, list(columns)]
    if not table.size:
        return None
    row, column = np.unravel_index(int(table.argmax()), table.shape)
    named = int(column) if columns is None else int(columns[int(column)])
    return Peak(float(table[row, column]), int(row), named)


def lowest(values: FloatArray, columns: Sequence[int] | None = None) -> Peak | None:
    """The smallest value of (n_time, n), or of some of its columns; None if there is none."""
    peak = highest(-values, columns)
    return None if peak is None else Peak(-peak.value, peak.row, peak.column)


def clean(value: float) -> float:
    """A time without the last digits that a product of step and number leaves.

    Examples
    --------
    >>> 3 * 0.1, clean(3 * 0.1)
    (0.30000000000000004, 0.3)
    """
    return float(f"{value:.12g}")


def time_of(result: Result, row: int) -> float:
    """A time of the result [s]."""
    return clean(float(result.time[row]))


def static_forces(result: Result) -> FloatArray:
    """Static contact forces (n_contact,) [N]; zero where the result does not know them."""
    known = result.checks.get("static_contact_force") or {}
    return np.array([float(known.get(name) or 0.0) for name in result.contact])


def force_ratios(result: Result) -> FloatArray:
    """Contact forces over static ones (n_time, n_contact) [-]; 1 where there is no static force."""
    static = static_forces(result)
    bearing = static != 0.0
    ratios = np.ones(result.contact_force.shape)
    ratios[:, bearing] = result.contact_force[:, bearing] / static[bearing]
    return ratios
