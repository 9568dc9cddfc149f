"""What the reference solutions ask of their input."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.floating[Any]]
ComplexArray = npt.NDArray[np.complexfloating[Any, Any]]
IntArray = npt.NDArray[np.signedinteger[Any]]

STANDARD_GRAVITY = 9.81  # [m/s2], the value that N12's peaks go with


def require_positive(field: str, value: float) -> None:
    """Raise `InputError` unless ``value`` is a finite number above zero."""
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(
            "must be a positive number", field=field, value=value, fix="Write a number above zero"
        )


def require_not_negative(field: str, value: float) -> None:
    """Raise `InputError` unless ``value`` is a finite number, zero or above."""
    if not (math.isfinite(value) and value >= 0.0):
        raise InputError(
            "must not be negative", field=field, value=value, fix="Write zero or a positive number"
        )


def require_count(field: str, value: int) -> None:
    """Raise `InputError` unless ``value`` is one or more."""
    if int(value) != value or value < 1:
        raise InputError(
            "must be a whole number of at least one", field=field, value=value, fix="Write 1, 2, ..."
        )


def require_same_length(field: str, received: int, expected: int) -> None:
    """Raise `InputError` unless there is one entry per vehicle."""
    if received != expected:
        raise InputError(
            f"must have one entry per vehicle, {expected} in all",
            field=field,
            value=received,
            fix="Give as many offsets as vehicles",
        )


def increasing_times(time: npt.ArrayLike) -> FloatArray:
    """Return ``time`` as an array (time,) [s]; it must start at zero or later and increase."""
    times = np.atleast_1d(np.asarray(time, dtype=np.float64))
    if times.ndim != 1 or not np.all(np.isfinite(times)) or times[0] < 0.0 or np.any(np.diff(times) <= 0.0):
        raise InputError(
            "must increase and start at zero or later",
            field="time",
            value=time,
            fix="Use numpy.arange(steps + 1) * time_step",
        )
    return times


def damping_ratios(ratio: float | Sequence[float] | FloatArray, modes: int) -> FloatArray:
    """Return one damping ratio per mode, shape (mode,); one number serves all modes."""
    ratios = np.asarray(ratio, dtype=np.float64)
    if ratios.ndim > 1 or (ratios.ndim == 1 and ratios.size != modes):
        raise InputError(
            f"must be one number or one per mode, {modes} in all", field="modal_damping", value=ratio
        )
    if np.any(ratios < 0.0) or np.any(ratios >= 1.0):
        raise InputError(
            "must be at least zero and below one",
            field="modal_damping",
            value=ratio,
            fix="Write 0.01 for 1 %",
        )
    return np.broadcast_to(ratios, (modes,)).astype(np.float64)
