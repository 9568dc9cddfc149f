"""Vehicles of rigid bodies, wheels, suspensions and hinges: in the vertical plane, or in space on two rails."""

from __future__ import annotations

from collections.abc import Sequence

from axlespan.errors import InputError
from axlespan.vehicles.fitting import checked
from axlespan.vehicles.loads import BodyLoad
from axlespan.vehicles.nonlinear import with_suspension_laws
from axlespan.vehicles.parts import Body, Hinge, Suspension, Wheel
from axlespan.vehicles.rigid_bodies import assembled
from axlespan.vehicles.vehicle import Vehicle

__all__ = ["Body", "Hinge", "Suspension", "Wheel", "multibody"]


def multibody(
    *,
    bodies: Sequence[Body],
    wheels: Sequence[Wheel],
    suspensions: Sequence[Suspension],
    hinges: Sequence[Hinge] = (),
    loads: Sequence[BodyLoad] = (),
    name: str = "multibody vehicle",
    length: float | None = None,
) -> Vehicle:
    """Assemble a vehicle from bodies, wheels, suspensions and hinges.

    D.o.f. are ``body.z``, ``body.pitch`` (right-handed about y: positive lowers the front) and ``body.roll``
    (about x: positive lifts the left side) by the names of the bodies, and ``wheel1.z``, … All positions are
    distances behind the first wheel, y is to the left.

    Wheels with a gauge make a vehicle in space: each wheelset has a left and a right contact ``1l``, ``1r`` on
    the lines ``left`` and ``right``, with the d.o.f. ``wheel1l.z`` and ``wheel1r.z``.

    A body may hang in any number of suspensions, so that a bogie carries the ends of two coaches.

    Parameters
    ----------
    bodies : sequence of Body
    wheels : sequence of Wheel
        Single ones, or wheelsets with a gauge.
    suspensions : sequence of Suspension
        Between bodies, or a body and a wheel.
    hinges : sequence of Hinge
        Between bodies that share a point.
    loads : sequence of BodyLoad
        Constant forces on bodies; they change the static contact forces.
    length : float, optional
        Over couplers [m].
    name : str

    Raises
    ------
    InputError
        If names repeat or are unknown, values are out of range, or a body can move without force.
    """
    parts = checked(bodies, wheels, suspensions, hinges)
    points, system = assembled(parts)
    centers = {body.name: body.position for body in bodies}
    facts = {f"{body.name}.height": body.height for body in bodies if body.height is not None}
    vehicle = with_suspension_laws(Vehicle(points, system, name, length, facts, bodies=centers), parts)
    try:
        vehicle.static_forces(0.0)  # no gravity: only whether it stands
    except InputError as error:
        raise InputError(error.rule, field="suspensions", fix=error.fix) from error
    return vehicle.loaded(loads) if loads else vehicle
