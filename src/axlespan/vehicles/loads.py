"""Constant forces and moments on the bodies of a vehicle: cross-wind, centrifugal force, uneven payload."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.dofs import nearest
from axlespan.model.system import System

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class BodyLoad:
    """A force and a moment on a body, constant in time.

    The lateral force rolls the body by its lever above the rails; the rails take it sideways. It enters the
    static equilibrium: the vehicle's displacements count from the position under it.
    """

    body: str
    z: float = 0.0  # upward, at the center of gravity [N]
    y: float = 0.0  # to the left, at a height above the rails [N]
    height: float | None = None  # of the lateral force [m]; that of the body when left out
    roll: float = 0.0  # moment about x, right-handed: positive lifts the left side [N m]
    pitch: float = 0.0  # moment about y, right-handed: positive lowers the front [N m]


def load_vector(system: System, loads: Sequence[BodyLoad], heights: Mapping[str, float]) -> FloatArray:
    """Nodal forces (n,) of loads on bodies, over the independent d.o.f. [N, N m].

    Raises
    ------
    InputError
        If a body is unknown or cannot turn about the axis of a moment, or a height is missing.
    """
    full = np.zeros(len(system.dof_names))
    known = {name: i for i, name in enumerate(system.dof_names)}
    bodies = sorted({name.rpartition(".")[0] for name in known})
    for i, load in enumerate(loads):
        field = f"loads.{i}"
        if f"{load.body}.z" not in known:
            error = nearest(load.body, [body for body in bodies if ":" not in body], "body")
            raise InputError(error.rule, field=f"{field}.body", value=load.body, fix=error.fix)
        for part in ("z", "y", "roll", "pitch", "height"):
            value = getattr(load, part)
            if value is not None and not np.isfinite(value):
                raise InputError("must be a finite number", field=f"{field}.{part}", value=value)
        roll = load.roll
        if load.y != 0.0:
            height = load.height if load.height is not None else heights.get(load.body)
            if height is None:
                raise InputError(
                    "is missing: a lateral force needs its height above the rails",
                    field=f"{field}.height",
                    fix="Add it to the load, or the height of its center of gravity to the body",
                )
            roll -= height * load.y
        for component, amount in (("z", load.z), ("roll", roll), ("pitch", load.pitch)):
            if amount == 0.0:
                continue
            name = f"{load.body}.{component}"
            if name not in known:
                inertia = "roll_inertia, and its wheels a gauge" if component == "roll" else "inertia"
                raise InputError(
                    f"turns a body that cannot {component}",
                    field=field,
                    value=load.body,
                    fix=f"Give the body a {inertia}"
                    if component == "roll"
                    else f"Give the body its {inertia}",
                )
            full[known[name]] += amount
    return np.asarray(system.elimination.T @ full)
