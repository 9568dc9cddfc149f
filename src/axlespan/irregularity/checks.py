"""Rules that the numbers given to a profile or a spectrum have to keep, and how near names are found."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from axlespan.errors import InputError

Array: TypeAlias = NDArray[np.float64]


def require_finite(**fields: float | None) -> None:
    """Raise InputError unless every number is finite; None stands for "not given" and passes."""
    for field, value in fields.items():
        if value is not None and not math.isfinite(value):
            raise InputError("must be a finite number", field=field, value=value)


def require_positive(**fields: float) -> None:
    """Raise InputError unless every number is finite and larger than zero."""
    for field, value in fields.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError("must be positive", field=field, value=value)


def require_order(start: float | None, stop: float | None) -> None:
    """Raise InputError unless start lies before stop (where both are given)."""
    require_finite(start=start, stop=stop)
    if start is not None and stop is not None and start >= stop:
        raise InputError(f"must be larger than start = {start:g} m", field="stop", value=stop)


def require_band(wavelengths: tuple[float, float], field: str = "wavelengths") -> None:
    """Raise InputError unless wavelengths is (shortest, longest), both positive and different."""
    shortest, longest = wavelengths
    if not (0.0 < shortest < longest < math.inf):
        raise InputError(
            "must be (shortest, longest) with 0 < shortest < longest",
            field=field,
            value=wavelengths,
            fix="Write, for example, (3.0, 25.0) for 3 m to 25 m",
        )


def column(values: ArrayLike, field: str, *, at_least: int = 2) -> Array:
    """Return a read-only copy of a list of finite numbers; a gap (NaN) is named by its index."""
    array = np.array(values, dtype=np.float64)
    if array.ndim != 1 or array.size < at_least:
        raise InputError(
            f"must be a list of at least {at_least} numbers", field=field, value=f"shape {array.shape}"
        )
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        i = int(bad[0])
        raise InputError(
            "has a gap: every entry must be a finite number",
            field=f"{field}[{i}]",
            value=float(array[i]),
            fix="Fill it, or cut the record in two there",
        )
    array.setflags(write=False)
    return array


def require_increasing(x: Array, field: str = "x") -> None:
    """Raise InputError that names the first entry of x that isn't larger than the one before it."""
    bad = np.flatnonzero(np.diff(x) <= 0.0)
    if bad.size:
        i = int(bad[0]) + 1
        raise InputError(
            f"must be larger than {field}[{i - 1}] = {x[i - 1]:g} (positions strictly increase)",
            field=f"{field}[{i}]",
            value=float(x[i]),
            fix="Sort the points; for a step, give two points a small distance apart",
        )


def require_choice(value: str, choices: Iterable[str], field: str) -> None:
    """Raise InputError that names the nearest choice unless value is one of the choices."""
    known = list(choices)
    if value not in known:
        raise InputError(
            f"is not known; known are {', '.join(known)}", field=field, value=value, fix=nearest(value, known)
        )


def nearest(value: str, known: Sequence[str]) -> str | None:
    """Return "Did you mean …?" with the nearest known name, or None where nothing is near."""
    found = difflib.get_close_matches(str(value).lower(), known, n=1, cutoff=0.5)
    return f"Did you mean {found[0]!r}?" if found else None


def within(x: Array, start: float | None, stop: float | None) -> NDArray[np.bool_]:
    """Return where start <= x <= stop; a bound that is None doesn't bound."""
    inside = np.ones(x.shape, dtype=np.bool_)
    if start is not None:
        inside &= x >= start
    if stop is not None:
        inside &= x <= stop
    return inside


def clipped(x: Array, start: float | None, stop: float | None) -> Array:
    """Return x moved into [start, stop]; a bound that is None doesn't bound."""
    low = -np.inf if start is None else start
    high = np.inf if stop is None else stop
    return np.clip(x, low, high)
