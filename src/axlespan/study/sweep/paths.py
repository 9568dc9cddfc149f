"""Dotted paths into a case: ``train.0.mass`` in its data and in the validated case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from axlespan.errors import InputError


def placed(data: Any, path: str, value: Any) -> Any:
    """The data with another value at a path; what lies beside the path is shared, not copied.

    Mappings on the way that are missing are made.

    Raises
    ------
    InputError
        If the path leads into a list beyond its end, or into a single value.

    Examples
    --------
    >>> placed({"crossing": {"speed": 1}, "train": [{"mass": 1}]}, "train.0.mass", 2)
    {'crossing': {'speed': 1}, 'train': [{'mass': 2}]}
    """
    return _placed(data, path.split("."), value)


def _placed(data: Any, steps: Sequence[str], value: Any) -> Any:
    if not steps:
        return value
    step, rest = steps[0], steps[1:]
    if isinstance(data, list | tuple):
        if not step.isdigit() or int(step) >= len(data):
            raise InputError(
                f"leads into a list that has no entry {step}", fix=f"Entries are 0 to {len(data) - 1}"
            )
        return [_placed(item, rest, value) if n == int(step) else item for n, item in enumerate(data)]
    if isinstance(data, Mapping):
        name = next(
            (".".join(steps[:n]) for n in range(len(steps), 1, -1) if ".".join(steps[:n]) in data), step
        )
        rest = steps[len(name.split(".")) :]
        return {**data, name: _placed(data.get(name), rest, value)}
    if data is None:
        return {step: _placed(None, rest, value)}
    raise InputError(f"leads into a single value, which has no {step}")


def found(data: Any, path: str) -> Any:
    """The value at a path of a case's data; None if there is none."""
    steps = path.split(".")
    while steps:
        if isinstance(data, list | tuple):
            number = int(steps[0]) if steps[0].isdigit() else -1
            data, steps = (data[number] if 0 <= number < len(data) else None), steps[1:]
        elif isinstance(data, Mapping):
            taken = next((n for n in range(len(steps), 0, -1) if ".".join(steps[:n]) in data), 0)
            if not taken:
                return None
            data, steps = data[".".join(steps[:taken])], steps[taken:]
        else:
            return None
    return data


def validated(case: Any, path: str) -> Any:
    """The value at a path of a validated case, in SI units; None if there is none."""
    steps = path.split(".")
    while steps and case is not None:
        if isinstance(case, Mapping):
            taken = next((n for n in range(len(steps), 0, -1) if ".".join(steps[:n]) in case), 0)
            if not taken:
                return None
            case, steps = case[".".join(steps[:taken])], steps[taken:]
            continue
        step, steps = steps[0], steps[1:]
        if isinstance(case, list | tuple):
            case = case[int(step)] if step.isdigit() and int(step) < len(case) else None
        else:
            case = getattr(case, step, getattr(case, f"{step}_", None))
    return case
