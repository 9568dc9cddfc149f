"""Whether bodies, wheels, suspensions and hinges fit each other."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from axlespan.errors import InputError
from axlespan.model.dofs import nearest
from axlespan.model.materials import require_positive
from axlespan.vehicles.parts import Body, Hinge, Suspension, Wheel

Terms = list[tuple[str, str, float]]


@dataclass(frozen=True)
class Parts:
    """Bodies, named wheels, suspensions and hinges that fit each other."""

    bodies: dict[str, Body]
    wheels: dict[str, Wheel]
    suspensions: tuple[Suspension, ...]
    hinges: tuple[Hinge, ...]

    @property
    def is_spatial(self) -> bool:
        """Whether wheels run on a left and a right line."""
        return any(wheel.gauge is not None for wheel in self.wheels.values())

    def position(self, name: str) -> float:
        """Distance behind the first wheel [m]."""
        return (self.bodies[name] if name in self.bodies else self.wheels[name]).position

    def turns(self, name: str) -> Terms:
        """Rotations of a body or wheelset as (name, component, side of its center)."""
        if name in self.wheels:
            return [(name, "rx", 0.0)] if self.is_spatial else []
        body = self.bodies[name]
        turns = [(name, "ry", body.position)] if body.inertia is not None else []
        return turns + ([(name, "rx", body.side)] if body.roll_inertia is not None else [])

    def arms(self, name: str, at: float, y: float) -> Terms:
        """Vertical displacement of a seat beyond that of the center: (name, component, lever)."""
        levers = [
            (owner, component, (at if component == "ry" else y) - center)
            for owner, component, center in self.turns(name)
        ]
        return [term for term in levers if term[2] != 0.0]


def checked(
    bodies: Sequence[Body],
    wheels: Sequence[Wheel],
    suspensions: Sequence[Suspension],
    hinges: Sequence[Hinge],
) -> Parts:
    """Return the parts once they fit.

    Raises
    ------
    InputError
        Fields are ``bodies.0.mass`` and the like.
    """
    labels = [wheel.name or f"wheel{i + 1}" for i, wheel in enumerate(wheels)]
    sides = [
        f"{label}{end}" for label, wheel in zip(labels, wheels, strict=True) if wheel.gauge for end in "lr"
    ]
    names = [body.name for body in bodies] + labels + sides
    for name, times in Counter(names).items():
        if times > 1:
            raise InputError("is the name of more than one body or wheel", field="bodies", value=name)
    if not wheels:
        raise InputError("must have at least one wheel", field="wheels")
    for i, body in enumerate(bodies):
        _check_body(body, f"bodies.{i}", any(wheel.gauge for wheel in wheels))
    for i, wheel in enumerate(wheels):
        _check_wheel(wheel, f"wheels.{i}", any(wheel.gauge is not None for wheel in wheels))
    parts = Parts(
        {body.name: body for body in bodies},
        dict(zip(labels, wheels, strict=True)),
        tuple(suspensions),
        tuple(hinges),
    )
    for i, suspension in enumerate(suspensions):
        _check_suspension(suspension, f"suspensions.{i}", parts)
    for i, hinge in enumerate(hinges):
        _check_between(hinge.between, f"hinges.{i}", list(parts.bodies), "body")
        _require_finite(hinge.at, f"hinges.{i}.at")
    pairs = [item.between for item in suspensions] + [item.between for item in hinges]
    held = {end for pair in pairs for end in pair}
    for i, body in enumerate(bodies):
        if body.name not in held:
            raise InputError(
                f"has no suspension: nothing carries body '{body.name}'",
                field=f"bodies.{i}",
                fix="Add a suspension between it and a wheel or another body",
            )
    for i, (label, wheel) in enumerate(parts.wheels.items()):
        if label not in held and wheel.mass == 0.0:
            raise InputError(
                f"has no mass and no suspension: '{label}' carries nothing",
                field=f"wheels.{i}",
                fix="Add a suspension between it and a body",
            )
    return parts


def _check_body(body: Body, field: str, spatial: bool) -> None:
    require_positive(body.mass, f"{field}.mass")
    _require_finite(body.position, f"{field}.position")
    _require_finite(body.side, f"{field}.side")
    if body.inertia is not None:
        require_positive(body.inertia, f"{field}.inertia")
    if body.roll_inertia is not None:
        require_positive(body.roll_inertia, f"{field}.roll_inertia")
    if body.height is not None:
        require_positive(body.height, f"{field}.height", zero=True)
    for part, given in (("roll_inertia", body.roll_inertia is not None), ("side", body.side != 0.0)):
        if given and not spatial:
            raise InputError(
                "is for vehicles with left and right wheels",
                field=f"{field}.{part}",
                fix="Give the wheels their gauge, or leave it out",
            )


def _check_wheel(wheel: Wheel, field: str, spatial: bool) -> None:
    require_positive(wheel.position, f"{field}.position", zero=True)
    require_positive(wheel.mass, f"{field}.mass", zero=True)
    if wheel.radius is not None:
        require_positive(wheel.radius, f"{field}.radius")
    if wheel.gauge is None:
        if spatial:
            raise InputError("is missing: other wheels have one", field=f"{field}.gauge")
        for part in ("roll_inertia", "independent"):
            if getattr(wheel, part):
                rule = "is for wheels with a gauge, left and right"
                raise InputError(rule, field=f"{field}.{part}", value=getattr(wheel, part))
        return
    require_positive(wheel.gauge, f"{field}.gauge")
    if wheel.roll_inertia is not None:
        require_positive(wheel.roll_inertia, f"{field}.roll_inertia")
        if wheel.independent or wheel.mass == 0.0:
            what = "independent wheels" if wheel.independent else "a wheelset without mass"
            raise InputError(f"is not for {what}", field=f"{field}.roll_inertia", value=wheel.roll_inertia)


def _check_suspension(suspension: Suspension, field: str, parts: Parts) -> None:
    _check_between(suspension.between, field, [*parts.bodies, *parts.wheels], "body or wheel")
    if set(suspension.between) <= set(parts.wheels):
        raise InputError(
            "connects two wheels", field=f"{field}.between", value=list(suspension.between), fix="Name a body"
        )
    coefficients = ("stiffness", "damping", "roll_stiffness", "roll_damping")
    for part in coefficients:
        require_positive(getattr(suspension, part), f"{field}.{part}", zero=True)
    for law, gap in suspension.laws:
        _require_finite(gap, f"{field}.laws.gap")
        if not callable(getattr(law, "tangent", None)):
            raise InputError(
                "must be a law of axlespan.model.nonlinear", field=f"{field}.laws", value=type(law).__name__
            )
    if not suspension.laws and not any(getattr(suspension, part) for part in coefficients):
        raise InputError("has no stiffness and no damping", field=field, fix="Add its stiffness")
    if suspension.at is not None:
        _require_finite(suspension.at, f"{field}.at")
    if suspension.spread is not None:
        require_positive(suspension.spread, f"{field}.spread")
    if suspension.spread is not None and suspension.side is not None:
        raise InputError(
            "says again where spread puts them", field=f"{field}.side", fix="Keep one of the two"
        )
    rolls = suspension.roll_stiffness or suspension.roll_damping
    for part, given in (("spread", suspension.spread), ("side", suspension.side), ("roll_stiffness", rolls)):
        if given and not parts.is_spatial:
            raise InputError(
                "is for vehicles with left and right wheels",
                field=f"{field}.{part}",
                value=given,
                fix="Give the wheels their gauge, or leave it out",
            )
    for end in suspension.between:
        if rolls and not any(component == "rx" for _, component, _ in parts.turns(end)):
            raise InputError(
                f"turns '{end}', which does not roll", field=f"{field}.roll_stiffness", value=rolls
            )


def _check_between(between: Sequence[str], field: str, known: list[str], what: str) -> None:
    if len(between) != 2 or between[0] == between[1]:
        raise InputError(
            f"must name two different ones, each a {what}", field=f"{field}.between", value=list(between)
        )
    for end in between:
        if end not in known:
            error = nearest(end, known, what)
            raise InputError(error.rule, field=f"{field}.between", value=end, fix=error.fix)


def _require_finite(value: float, field: str) -> None:
    if not math.isfinite(value):
        raise InputError("must be a finite number", field=field, value=value)
