"""Vehicles of bodies, wheels and suspensions, written out in the case file.

All positions are distances behind the first wheel. A car on two axles, free to pitch::

    - vehicle: multibody
      bodies: [{name: body, mass: 10.5 t, inertia: 50 t m^2, position: 2.5 m}]
      wheels: [{position: 0 m, mass: 900 kg}, {position: 5 m, mass: 900 kg}]
      suspensions:
        - {between: [body, wheel1], stiffness: 600 kN/m, damping: 10 kNs/m}
        - {between: [body, wheel2], stiffness: 600 kN/m, damping: 10 kNs/m}
"""

from __future__ import annotations

from collections import Counter
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_placing import Placed
from axlespan.study.checks import Part
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.quantities import Dashpot, Distance, Inertia, Length, Name, PartMass, SpringStiffness


class Body(Part):
    """A rigid body: it moves up and down and, where it has an inertia, pitches."""

    name: Annotated[Name, Field(examples=["body"])]
    """Name, as in the d.o.f. ``1.body.z`` and ``1.body.pitch``."""
    mass: Annotated[PartMass, Field(examples=["47.8 t"])]
    """Mass."""
    inertia: Inertia | None = None
    """Moment of inertia about its transverse axis; without it the body does not pitch."""
    position: Annotated[Length, Field(examples=["2.5 m"])]
    """Distance of its center of gravity behind the first wheel."""


class Wheel(Part):
    """A wheelset: it follows the track."""

    name: Name | None = None
    """Name; ``wheel1``, ``wheel2``, ... when left out."""
    position: Annotated[Distance, Field(examples=["2.5 m"])]
    """Distance behind the first wheel."""
    mass: PartMass = 0.0
    """Mass."""


class Suspension(Part):
    """A spring and a dashpot side by side between two bodies, or a body and a wheel."""

    between: Annotated[tuple[Name, ...], Field(examples=["[body, wheel1]"])]
    """Names of the two that it connects."""
    stiffness: SpringStiffness = 0.0
    """Stiffness of the spring."""
    damping: Dashpot = 0.0
    """Damping of the dashpot."""
    at: Length | None = None
    """Distance behind the first wheel; when left out, at the wheel or at the center of the second body."""


class Multibody(Placed):
    """A vehicle of rigid bodies, wheels and suspensions in the vertical plane along the track.

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
            if suspension.stiffness == suspension.damping == 0.0:
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
