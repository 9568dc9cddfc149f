"""What a run is asked to keep beside the histories: fields, section forces, stresses, envelopes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from axlespan.errors import InputError
from axlespan.model.dofs import nearest

#: Quantities of which envelopes along the line are kept.
ENVELOPES = ("moment", "shear", "normal", "torsion", "deflection", "acceleration")


def field_steps(fields: Sequence[float] | int | None, time_step: float, steps: int) -> Sequence[int]:
    """Time indices of the fields that are asked for.

    Parameters
    ----------
    fields : sequence of float, or int, or None
        Times [s], of which the nearest steps are taken; or at every so many steps, the start included.

    Raises
    ------
    InputError
        If a time lies outside the run, or the number of steps is not a whole one from 1 on.
    """
    if fields is None:
        return ()
    if isinstance(fields, (int, float)):
        if isinstance(fields, bool) or int(fields) != fields or fields < 1:
            raise InputError("must be a whole number of at least 1, or times", field="fields", value=fields)
        return range(0, steps + 1, int(fields))
    end = time_step * steps
    chosen = set()
    for number, time in enumerate(fields):
        if not 0.0 <= time <= end * (1.0 + 1e-9):  # false for nan too
            rule = f"must be within the time that is simulated, {end:g} s"
            raise InputError(rule, field=f"fields.{number}", value=time)
        chosen.add(min(round(time / time_step), steps))
    return tuple(sorted(chosen))


def sensor_names(names: Sequence[str] | None, sensors: Mapping[str, object], field: str) -> tuple[str, ...]:
    """Check the names of the sensors at which something more is kept.

    Raises
    ------
    InputError
        If a name is no sensor or comes twice.
    """
    chosen = tuple(names or ())
    for number, name in enumerate(chosen):
        if name not in sensors:
            raise _named(nearest(name, list(sensors), "sensor"), f"{field}.{number}", name)
        if name in chosen[:number]:
            raise InputError("is named twice", field=f"{field}.{number}", value=name)
    return chosen


def envelope_names(names: Sequence[str] | None) -> tuple[str, ...]:
    """Check the quantities of which envelopes are kept.

    Raises
    ------
    InputError
        If there is no such quantity or it comes twice.
    """
    chosen = tuple(names or ())
    for number, name in enumerate(chosen):
        if name not in ENVELOPES:
            raise _named(nearest(name, list(ENVELOPES), "quantity"), f"envelopes.{number}", name)
        if name in chosen[:number]:
            raise InputError("is named twice", field=f"envelopes.{number}", value=name)
    return chosen


def _named(error: InputError, field: str, value: str) -> InputError:
    return InputError(error.rule, field=field, value=value, fix=error.fix)
