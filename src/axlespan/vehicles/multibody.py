"""Vehicles of rigid bodies, wheels and suspensions in the vertical plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.dofs import nearest
from axlespan.model.materials import require_positive
from axlespan.model.model import Model
from axlespan.vehicles.vehicle import ContactPoint, Vehicle


@dataclass(frozen=True)
class Body:
    """A rigid body; it pitches if it has an inertia."""

    name: str
    mass: float  # [kg]
    position: float  # of its center of gravity, behind the first wheel [m]
    inertia: float | None = None  # about its transverse axis [kg m^2]


@dataclass(frozen=True)
class Wheel:
    """A wheelset, which follows the line."""

    position: float  # behind the first wheel [m]
    mass: float = 0.0  # [kg]
    name: str | None = None  # wheel1, wheel2, … when left out


@dataclass(frozen=True)
class Suspension:
    """A spring and a dashpot side by side, between two bodies or a body and a wheel."""

    between: tuple[str, str]
    stiffness: float = 0.0  # [N/m]
    damping: float = 0.0  # [N s/m]
    at: float | None = (
        None  # behind the first wheel [m]; at the wheel, or at the second one's center, when left out
    )


def multibody(
    *,
    bodies: Sequence[Body],
    wheels: Sequence[Wheel],
    suspensions: Sequence[Suspension],
    name: str = "multibody vehicle",
) -> Vehicle:
    """Assemble a vehicle from bodies, wheels and suspensions.

    D.o.f. are ``body.z`` and ``body.pitch`` (right-handed about y: positive lowers the front) by the names of
    the bodies, and ``wheel1.z``, … All positions are distances behind the first wheel.

    Raises
    ------
    InputError
        If names repeat or are unknown, values are out of range, or a body can move without force.
    """
    named = [(wheel.name or f"wheel{i + 1}", wheel) for i, wheel in enumerate(wheels)]
    names = [body.name for body in bodies] + [label for label, _ in named]
    if len(set(names)) < len(names):
        twice = next(label for label in names if names.count(label) > 1)
        raise InputError("is the name of more than one body or wheel", field="bodies", value=twice)
    model = Model(plane=True)
    for i, body in enumerate(bodies):
        require_positive(body.mass, f"bodies.{i}.mass")
        if body.inertia is not None:
            require_positive(body.inertia, f"bodies.{i}.inertia")
        moment = None if body.inertia is None else {"ry": body.inertia}
        model = model.with_nodes([[-body.position, 0.0]], [body.name])
        model = model.with_mass(body.name, body.mass, moment, directions=("z",))
    for i, (label, wheel) in enumerate(named):
        model = model.with_nodes([[-wheel.position, 0.0]], [label])
        if require_positive(wheel.mass, f"wheels.{i}.mass", zero=True) > 0.0:
            model = model.with_mass(label, wheel.mass, directions=("z",))
    pitching = {body.name for body in bodies if body.inertia is not None}
    where = {
        **{body.name: body.position for body in bodies},
        **{label: wheel.position for label, wheel in named},
    }
    rigid = {label for label, _ in named}
    for i, suspension in enumerate(suspensions):
        model = _suspended(model, i, suspension, where, rigid, pitching)
    aliases = {f"{body}.ry": f"{body}.pitch" for body in pitching}
    points = tuple(
        ContactPoint(str(i + 1), wheel.position, f"{label}.z") for i, (label, wheel) in enumerate(named)
    )
    return Vehicle(points, compile_model(model).system.renamed(aliases), name)


def _suspended(
    model: Model,
    index: int,
    suspension: Suspension,
    where: dict[str, float],
    rigid: set[str],
    pitching: set[str],
) -> Model:
    """Add one suspension, with seats where it meets pitching bodies away from their centers."""
    field = f"suspensions.{index}"
    for end in suspension.between:
        if end not in where:
            raise nearest(end, list(where), "body or wheel")
    require_positive(suspension.stiffness, f"{field}.stiffness", zero=True)
    require_positive(suspension.damping, f"{field}.damping", zero=True)
    first, second = suspension.between
    at = suspension.at if suspension.at is not None else where[first if first in rigid else second]
    ends = []
    for end in suspension.between:
        node = model.node(end)
        if end in pitching and at != where[end]:
            seat = f"{end}:seat{index + 1}"
            model = model.with_nodes([[-at, 0.0]], [seat]).with_rigid_link(end, [seat], ("z",))
            node = model.node(seat)
        ends.append(node)
    return model.with_springs(
        [ends], {"z": suspension.stiffness}, {"z": suspension.damping}, name=f"suspension{index + 1}"
    )
