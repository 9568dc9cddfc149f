"""Nonlinear springs and dashpots in vehicles: bump stops, friction, progressive springs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.model.nonlinear import SpringLaw
from axlespan.model.system import SpringRows
from axlespan.vehicles.fitting import Parts
from axlespan.vehicles.parts import Suspension
from axlespan.vehicles.vehicle import Vehicle


def with_nonlinear_spring(
    vehicle: Vehicle,
    law: SpringLaw,
    elongation: Mapping[str, float],
    *,
    gap: float = 0.0,
    name: str = "nonlinear spring",
) -> Vehicle:
    """The same vehicle with a further spring or dashpot of a nonlinear law.

    Parameters
    ----------
    vehicle : Vehicle
    law : SpringLaw
        See :mod:`axlespan.model.nonlinear`.
    elongation : mapping of str to float
        The elongation as a sum over d.o.f.: ``{"body.z": 1.0, "bogie1.z": -1.0}``. It counts from the static position
        on level ground, in which the law's force has its share already.
    gap : float
        Added to the elongation [m]: a bump stop that only pushes touches when it is shortened by its gap.
    name : str
        For messages.

    Raises
    ------
    InputError
        If the vehicle is a group of moving forces, or has no such d.o.f.

    Examples
    --------
    >>> from axlespan.model.nonlinear import UnilateralSpring
    >>> from axlespan.vehicles import sprung_mass
    >>> car = sprung_mass(mass=5e3, stiffness=1e6, unsprung_mass=500.0)
    >>> stop = UnilateralSpring(stiffness=2e7)
    >>> stopped = with_nonlinear_spring(car, stop, {"body.z": 1.0, "wheel1.z": -1.0}, gap=0.03, name="bump stop")
    >>> stopped.system.nonlinear[0].name
    'bump stop'
    """
    system = vehicle.system
    if system is None:
        raise InputError(
            "is a group of moving forces, which have no springs", field="vehicle", value=vehicle.name
        )
    if not elongation or not np.all(np.isfinite([*elongation.values(), gap])):
        raise InputError("must name d.o.f. with finite factors, and a finite gap", field="elongation")
    at = [system.dof(dof) for dof in elongation]
    full = sp.coo_array(
        (np.array([*elongation.values()], float), (np.zeros(len(at), dtype=np.int64), np.array(at))),
        shape=(1, len(system.dof_names)),
    )
    rows = sp.csr_array(sp.csr_array(full) @ system.elimination)
    spring = SpringRows(name, law, rows, np.array([float(gap)]))
    return replace(vehicle, system=replace(system, nonlinear=(*system.nonlinear, spring)))


def with_suspension_laws(vehicle: Vehicle, parts: Parts) -> Vehicle:
    """The vehicle with the nonlinear springs and dashpots of its suspensions."""
    for number, suspension in enumerate(parts.suspensions, 1):
        for law, gap in suspension.laws:
            for elongation in _elongations(suspension, parts):
                vehicle = with_nonlinear_spring(vehicle, law, elongation, gap=gap, name=f"suspension{number}")
    return vehicle


def _elongations(suspension: Suspension, parts: Parts) -> list[dict[str, float]]:
    """The elongation over d.o.f. of each of its sides: the upper end's displacement less the lower one's."""
    upper, lower = suspension.between
    if upper in parts.wheels:
        upper, lower = lower, upper
    at = suspension.at
    if at is None:
        at = parts.position(lower if lower in parts.wheels else suspension.between[1])
    half = suspension.spread and 0.5 * suspension.spread
    result = []
    for y in [half, -half] if half else [suspension.side or 0.0]:
        terms: dict[str, float] = {}
        for name, sign in ((upper, 1.0), (lower, -1.0)):
            terms[f"{name}.z"] = sign
            for owner, component, lever in parts.arms(name, at, y):
                terms[f"{owner}.{'pitch' if component == 'ry' else 'roll'}"] = sign * lever
        result.append(terms)
    return result
