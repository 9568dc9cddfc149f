"""Motions of sensors and vehicles over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.interaction.result import Result
from axlespan.io.dof_units import is_rotation
from axlespan.plot.curves import draw
from axlespan.plot.style import axes_or_new, finish

FloatArray = npt.NDArray[np.float64]

# quantity -> scale and unit of translations, of rotations
_SHOWN = {
    "displacement": ((1e3, "mm"), (1e3, "mrad")),
    "velocity": ((1e3, "mm/s"), (1e3, "mrad/s")),
    "acceleration": ((1.0, "m/s²"), (1.0, "rad/s²")),
}


def displacement(
    result: Result,
    names: str | Sequence[str] | None = None,
    *,
    window: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw displacements [mm] or rotations [mrad] over time.

    Parameters
    ----------
    result : Result
    names : str or sequence of str, optional
        Sensors or vehicle d.o.f.; all sensors when left out. More than six become a band.
    window : (float, float), optional
        Times shown [s].
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If a name is unknown, or displacements and rotations are mixed.
    """
    return _motion(result, "displacement", names, window, ax)


def velocity(
    result: Result,
    names: str | Sequence[str] | None = None,
    *,
    window: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw velocities [mm/s] or [mrad/s] over time.

    Parameters
    ----------
    result : Result
    names : str or sequence of str, optional
        Sensors or vehicle d.o.f.; all sensors when left out. More than six become a band.
    window : (float, float), optional
        Times shown [s].
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If a name is unknown, or displacements and rotations are mixed.
    """
    return _motion(result, "velocity", names, window, ax)


def acceleration(
    result: Result,
    names: str | Sequence[str] | None = None,
    *,
    window: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw accelerations [m/s²] or [rad/s²] over time.

    Parameters
    ----------
    result : Result
    names : str or sequence of str, optional
        Sensors or vehicle d.o.f.; all sensors when left out. More than six become a band.
    window : (float, float), optional
        Times shown [s].
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If a name is unknown, or displacements and rotations are mixed.
    """
    return _motion(result, "acceleration", names, window, ax)


def _motion(
    result: Result,
    quantity: str,
    names: str | Sequence[str] | None,
    window: tuple[float, float] | None,
    ax: Axes | None,
) -> Axes:
    chosen, table, unit = history_table(result, quantity, names)
    rows = inside(result.time, window)
    axes = axes_or_new(ax)
    sensors = sum(name in result.sensor for name in chosen)
    what = {len(chosen): "sensors", 0: "vehicle d.o.f."}.get(sensors, "curves")
    draw(axes, result.time[rows], table[rows], chosen, what, ends=sensors == 0)
    return finish(axes, "Time [s]", f"{quantity.capitalize()} [{unit}]", window)


def inside(time: FloatArray, window: tuple[float, float] | None) -> slice:
    """Rows within a window of time, one more at each end; all if there is no window.

    Raises
    ------
    InputError
        If no time lies in the window.
    """
    if window is None:
        return slice(None)
    first, last = np.searchsorted(time, window[0]), np.searchsorted(time, window[1], side="right")
    if last <= first:
        raise InputError("must hold a time of the result", field="window", value=window)
    return slice(max(int(first) - 1, 0), int(last) + 1)


def history_table(
    result: Result, quantity: str, names: str | Sequence[str] | None
) -> tuple[list[str], FloatArray, str]:
    """Names, histories (n_time, n_name) in the unit of figures, and that unit.

    Parameters
    ----------
    quantity : {"displacement", "velocity", "acceleration", "contact_force"}

    Raises
    ------
    InputError
        If the quantity or a name is unknown, or displacements and rotations are mixed.
    """
    if quantity == "contact_force":
        contacts = [names] if isinstance(names, str) else list(result.contact if names is None else names)
        if not contacts:
            raise InputError("has no contact", field="result")
        table = [result.at("contact_force", name) for name in contacts]
        return contacts, 1e-3 * np.column_stack(table), "kN"
    if quantity not in _SHOWN:
        known = ", ".join((*_SHOWN, "contact_force"))
        raise InputError(f"must be one of {known}", field="quantity", value=quantity)
    chosen = _chosen(result, names)
    turning = {is_rotation(name) for name in chosen if name not in result.sensor}
    turning |= {False} if any(name in result.sensor for name in chosen) else set()
    if len(turning) > 1:
        fix = "Draw them into axes of their own"
        raise InputError("must not mix displacements and rotations", field="names", value=chosen, fix=fix)
    scale, unit = _SHOWN[quantity][turning.pop()]
    return chosen, scale * np.column_stack([_history(result, quantity, name) for name in chosen]), unit


def _chosen(result: Result, names: str | Sequence[str] | None) -> list[str]:
    chosen = [names] if isinstance(names, str) else list(result.sensor if names is None else names)
    if not chosen:
        fix = "Name a vehicle d.o.f., or give sensors to the simulation"
        raise InputError("must have at least one name", field="names", value=names, fix=fix)
    return chosen


def _history(result: Result, quantity: str, name: str) -> FloatArray:
    """History (n_time,) of a sensor or vehicle d.o.f."""
    if name in result.sensor:
        return result.at(f"sensor_{quantity}", name)
    if name in result.vehicle_dof:
        return result.at(f"vehicle_{quantity}", name)
    known = ", ".join((*result.sensor, *result.vehicle_dof)[:12]) or "none"
    raise InputError("is no sensor and no vehicle d.o.f.", field="name", value=name, fix=f"Known: {known}")
