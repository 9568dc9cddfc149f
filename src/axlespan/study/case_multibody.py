"""Vehicles of bodies, wheels and suspensions, written out in the case file.

All positions are distances behind the first wheel. A car on two axles, free to pitch::

    - vehicle: multibody
      bodies: [{name: body, mass: 10.5 t, inertia: 50 t m^2, position: 2.5 m}]
      wheels: [{position: 0 m, mass: 900 kg}, {position: 5 m, mass: 900 kg}]
      suspensions:
        - {between: [body, wheel1], stiffness: 600 kN/m, damping: 10 kNs/m}
        - {between: [body, wheel2], stiffness: 600 kN/m, damping: 10 kNs/m}

Wheels with a gauge run on the lines ``left`` and ``right``; bodies then roll where they have a roll_inertia.
"""

from __future__ import annotations

from collections import Counter
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_elements import OwnElements
from axlespan.study.case_laws import BumpStop, Law, UnilateralLaw
from axlespan.study.case_placing import Placed
from axlespan.study.checks import Part
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.quantities import (
    BodyForce,
    BodyMoment,
    Dashpot,
    Distance,
    Flag,
    Inertia,
    Length,
    Name,
    PartMass,
    RollDashpot,
    RollStiffness,
    Spacing,
    SpringStiffness,
)


class Body(Part):
    """A rigid body: it moves up and down and, where it has the inertias for it, pitches and rolls."""

    name: Annotated[Name, Field(examples=["body"])]
    """Name, as in the d.o.f. ``1.body.z`` and ``1.body.pitch``."""
    mass: Annotated[PartMass, Field(examples=["47.8 t"])]
    """Mass."""
    inertia: Inertia | None = None
    """Moment of inertia about its transverse axis; without it the body does not pitch."""
    position: Annotated[Length, Field(examples=["2.5 m"])]
    """Distance of its center of gravity behind the first wheel."""
    roll_inertia: Inertia | None = None
    """Moment of inertia about its longitudinal axis; without it the body does not roll."""
    height: Distance | None = None
    """Height of its center of gravity above the rails, where lateral loads act."""
    side: Length = 0.0
    """Distance of its center of gravity to the left of the middle."""


class Wheel(Part):
    """A wheelset: it follows the track."""

    name: Name | None = None
    """Name; ``wheel1``, ``wheel2``, ... when left out."""
    position: Annotated[Distance, Field(examples=["2.5 m"])]
    """Distance behind the first wheel."""
    mass: PartMass = 0.0
    """Mass of the wheelset, or of each of two independent wheels."""
    gauge: Annotated[Spacing | None, Field(examples=["1.5 m"])] = None
    """Distance between its left and its right wheel, which run on the lines left and right."""
    roll_inertia: Inertia | None = None
    """Moment of inertia of a wheelset in roll; when left out, half of the mass is at each wheel."""
    independent: Flag = False
    """Whether no axle joins its two wheels."""
    radius: Annotated[Spacing | None, Field(examples=["0.46 m"])] = None
    """Rolling radius."""


class Suspension(Part):
    """A spring and a dashpot side by side between two bodies, or a body and a wheel; or two such pairs, left and right."""

    between: Annotated[tuple[Name, ...], Field(examples=["[body, wheel1]"])]
    """Names of the two that it connects."""
    stiffness: SpringStiffness = 0.0
    """Stiffness of the spring."""
    damping: Dashpot = 0.0
    """Damping of the dashpot."""
    at: Length | None = None
    """Distance behind the first wheel; when left out, at the wheel or at the center of the second body."""
    spread: Annotated[Spacing | None, Field(examples=["2.0 m"])] = None
    """Distance between two of them, left and right, each with this stiffness and damping."""
    side: Length | None = None
    """Distance of a single one to the left of the middle."""
    roll_stiffness: RollStiffness = 0.0
    """Stiffness of an anti-roll bar between the two."""
    roll_damping: RollDashpot = 0.0
    """Damping of roll between the two."""
    bump_stop: Annotated[BumpStop | None, Field(examples=["{gap: 30 mm, stiffness: 20 MN/m}"])] = None
    """Stop between the two; the first of them is the upper one, unless it is a wheel."""
    law: Law | None = None
    """A nonlinear spring or dashpot beside those; it counts from the position of rest, and is positive when longer."""

    @model_validator(mode="after")
    def _whole_law(self) -> Self:
        if isinstance(self.law, UnilateralLaw) and self.law.stiffness is None:
            raise InputError("is missing", field="law.stiffness", fix="Add stiffness: 20 MN/m")
        return self


class Hinge(Part):
    """A point where two bodies move up and down together and turn freely, such as a fifth wheel."""

    between: Annotated[tuple[Name, ...], Field(examples=["[tractor, trailer]"])]
    """Names of the two bodies."""
    at: Length
    """Distance behind the first wheel."""


class BodyLoad(Part):
    """Constant forces and moments on a body, such as cross-wind; displacements count from the position under them."""

    body: Name
    """Name of the body."""
    z: BodyForce = 0.0
    """Force at the center of gravity, upward."""
    y: Annotated[BodyForce, Field(examples=["-60 kN"])] = 0.0
    """Force to the left; negative: wind from the left."""
    height: Distance | None = None
    """Height of the lateral force above the rails; that of the body when left out."""
    roll: BodyMoment = 0.0
    """Moment about x; positive lifts the left side."""
    pitch: BodyMoment = 0.0
    """Moment about y; positive lowers the front."""


class Multibody(Placed):
    """A vehicle of rigid bodies, wheels and suspensions, in the vertical plane along the track or on two rails.

    Once validated, wheels have names and suspensions their positions.
    """

    vehicle: Literal["multibody"]
    bodies: Annotated[
        tuple[Body, ...], Field(examples=["[{name: body, mass: 10.5 t, inertia: 50 t m^2, position: 2.5 m}]"])
    ]
    """Bodies."""
    wheels: Annotated[tuple[Wheel, ...], Field(examples=["[{position: 0 m}, {position: 5 m}]"])]
    """Wheels, the first at position 0."""
    suspensions: Annotated[
        tuple[Suspension, ...], Field(examples=["[{between: [body, wheel1], stiffness: 600 kN/m}]"])
    ]
    """Suspensions."""
    hinges: tuple[Hinge, ...] = ()
    """Hinges between bodies."""
    loads: tuple[BodyLoad, ...] = ()
    """Constant loads on bodies."""
    own_elements: OwnElements = ()
    """Nonlinear elements of one's own, written in Python, on d.o.f. such as body.z and wheel1.z."""

    @property
    def wheel_positions(self) -> tuple[float, ...]:
        """Distances of the wheels behind the first [m]."""
        return tuple(wheel.position for wheel in self.wheels)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        self._check_wheels()
        wheels = tuple(
            wheel if wheel.name else wheel.model_copy(update={"name": f"wheel{number}"})
            for number, wheel in enumerate(self.wheels, 1)
        )
        named = self.model_copy(update={"wheels": wheels})
        named._check_names()
        where: dict[str | None, float] = {body.name: body.position for body in self.bodies}
        where |= {wheel.name: wheel.position for wheel in wheels}
        hold = {wheel.name for wheel in wheels}
        suspensions = tuple(
            suspension
            if suspension.at is not None
            else suspension.model_copy(
                update={"at": where[suspension.between[0 if suspension.between[0] in hold else 1]]}
            )
            for suspension in named.suspensions
        )
        complete = named.model_copy(update={"suspensions": suspensions})
        if not self.hinges and all(wheel.gauge is None for wheel in wheels):
            complete._check_held()
        complete.require_room(wheels[-1].position)
        return complete

    def _check_wheels(self) -> None:
        if not self.wheels:
            raise InputError(
                "must have at least one wheel", field="wheels", fix="Write wheels: [{position: 0 m}]"
            )
        if self.wheels[0].position != 0.0:
            raise InputError(
                "must be 0: positions count from the first wheel",
                field="wheels.0.position",
                fix="Count the positions of bodies and wheels from there",
            )
        for number in range(1, len(self.wheels)):
            if self.wheels[number].position <= self.wheels[number - 1].position:
                raise InputError("must be behind the wheel before", field=f"wheels.{number}.position")

    def _check_names(self) -> None:
        names = [*(body.name for body in self.bodies), *(wheel.name or "" for wheel in self.wheels)]
        fields = [
            *(f"bodies.{n}" for n in range(len(self.bodies))),
            *(f"wheels.{n}" for n in range(len(self.wheels))),
        ]
        twice = {name for name, times in Counter(names).items() if times > 1}
        faults = [
            InputError("is the name of another body or wheel as well", field=f"{field}.name")
            for number, (field, name) in enumerate(zip(fields, names, strict=True))
            if name in twice and name in names[:number]
        ]
        wheels = {wheel.name for wheel in self.wheels}
        for number, suspension in enumerate(self.suspensions):
            field = f"suspensions.{number}"
            if len(suspension.between) != 2 or len(set(suspension.between)) != 2:
                rule = "must name two different bodies, or a body and a wheel"
                faults.append(InputError(rule, field=f"{field}.between", fix="Write [body, wheel1]"))
            elif set(suspension.between) <= wheels:
                faults.append(InputError("connects two wheels", field=f"{field}.between", fix="Name a body"))
            for end, name in enumerate(suspension.between):
                if name not in names:
                    near = nearest(name, [n for n in names if n])
                    fix = f"Did you mean {near}?" if near else f"Known are {listed(n for n in names if n)}"
                    faults.append(
                        InputError("no such body or wheel", field=f"{field}.between.{end}", fix=fix)
                    )
            if not any(
                (
                    suspension.stiffness,
                    suspension.damping,
                    suspension.roll_stiffness,
                    suspension.roll_damping,
                    suspension.bump_stop,
                    suspension.law,
                )
            ):
                faults.append(
                    InputError("has no stiffness and no damping", field=field, fix="Add stiffness: 600 kN/m")
                )
        if faults:
            raise InputErrors(faults)

    def _check_held(self) -> None:
        """Require that springs hold every body when the wheels stand still: no motion is free of force."""
        dofs = [(n, False) for n in range(len(self.bodies))]
        dofs += [(n, True) for n, body in enumerate(self.bodies) if body.inertia is not None]
        if not dofs:
            return
        number = {body.name: n for n, body in enumerate(self.bodies)}
        reach = max(1.0, *(abs(body.position) for body in self.bodies), self.wheels[-1].position)
        springs = [suspension for suspension in self.suspensions if suspension.stiffness > 0.0]
        elongation = np.zeros((max(len(springs), 1), len(dofs)))  # pitch times reach, so that all are lengths
        for row, spring in enumerate(springs):
            for name, sign in zip(spring.between, (1.0, -1.0), strict=True):
                for column, (body, pitches) in enumerate(dofs):
                    if number.get(name) == body:
                        arm = ((spring.at or 0.0) - self.bodies[body].position) / reach if pitches else 1.0
                        elongation[row, column] += sign * arm
        _, sizes, motions = np.linalg.svd(elongation)
        if len(springs) >= len(dofs) and sizes[-1] > 1e-9 * sizes[0]:
            return
        body, pitches = dofs[int(np.argmax(np.abs(motions[-1])))]
        raise InputError(
            f"can {'pitch' if pitches else 'move up and down'} freely: no spring resists it",
            field=f"bodies.{body}",
            fix="Add a suspension" + (", or leave its inertia out" if pitches else ""),
        )
