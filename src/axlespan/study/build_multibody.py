"""Vehicles of bodies, wheels and suspensions, and loads on bodies, from what a case says."""

from __future__ import annotations

from collections.abc import Sequence

from axlespan import vehicles
from axlespan.errors import InputError
from axlespan.model.nonlinear import SpringLaw, UnilateralSpring
from axlespan.running.structure import Structure
from axlespan.study import case_multibody
from axlespan.study.build_elements import with_elements
from axlespan.study.case_laws import gap_of
from axlespan.vehicles import BodyLoad, Placement, Train, Vehicle
from axlespan.vehicles.vehicle import LEFT, RIGHT


def vehicle_of_bodies(case: case_multibody.Multibody) -> Vehicle:
    """Build the vehicle that is written out in a case.

    Raises
    ------
    InputError
        If a body can move freely, or a load has nothing to act on; fields are paths under the entry.
    """
    vehicle = vehicles.multibody(
        bodies=[
            vehicles.Body(b.name, b.mass, b.position, b.inertia, b.roll_inertia, b.height, b.side)
            for b in case.bodies
        ],
        wheels=[
            vehicles.Wheel(w.position, w.mass, w.name, w.gauge, w.roll_inertia, w.independent, w.radius)
            for w in case.wheels
        ],
        suspensions=[
            vehicles.Suspension(
                (s.between[0], s.between[1]),
                s.stiffness,
                s.damping,
                s.at,
                s.spread,
                s.side,
                s.roll_stiffness,
                s.roll_damping,
                _laws(s),
            )
            for s in case.suspensions
        ],
        hinges=[vehicles.Hinge(_pair(h.between, i), h.at) for i, h in enumerate(case.hinges)],
        loads=body_loads(case.loads),
    )
    return with_elements(vehicle, case.own_elements)


def _laws(case: case_multibody.Suspension) -> tuple[tuple[SpringLaw, float], ...]:
    """The nonlinear springs of a suspension, and their gaps."""
    laws: list[tuple[SpringLaw, float]] = []
    if case.bump_stop is not None:
        stop = case.bump_stop
        laws.append((UnilateralSpring(stop.stiffness, stop.damping), stop.gap))
    if case.law is not None:
        laws.append((case.law.law(), gap_of(case.law)))
    return tuple(laws)


def body_loads(loads: Sequence[case_multibody.BodyLoad]) -> list[BodyLoad]:
    """Return the loads on bodies that a case says."""
    return [BodyLoad(p.body, p.z, p.y, p.height, p.roll, p.pitch) for p in loads]


def loaded_train(train: Train, loads: Sequence[case_multibody.BodyLoad]) -> Train:
    """Return a train with the same loads on every vehicle.

    Raises
    ------
    InputError
        If a vehicle has no such body.
    """
    if not loads:
        return train
    wanted = body_loads(loads)
    kinds = {id(item.vehicle): item.vehicle for item in train.placements}
    under_load = {key: vehicle.loaded(wanted) for key, vehicle in kinds.items()}
    placements = tuple(Placement(under_load[id(item.vehicle)], item.behind) for item in train.placements)
    return Train(placements, train.name)


def require_line(structure: Structure, name: str) -> None:
    """Require a running line that wheels name.

    Raises
    ------
    InputError
        With what to write for a vehicle with left and right wheels.
    """
    try:
        structure.line(name)
    except InputError:
        if name not in (LEFT, RIGHT):
            raise
        known = list(structure.lines)
        first, last = known[0], known[-1]
        raise InputError(
            f"has left and right wheels, and the structure has no line '{name}'",
            field="vehicle",
            fix=f"Say in the crossing where they run: lines: {{left: {first}, right: {last}}}",
        ) from None


def _pair(between: Sequence[str], index: int) -> tuple[str, str]:
    if len(between) != 2:
        raise InputError("must name two bodies", field=f"hinges.{index}.between")
    return between[0], between[1]
