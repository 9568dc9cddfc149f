r"""How a vehicle of rigid bodies becomes a system.

A seat of a body at the distance :math:`a` behind the first wheel and :math:`y` to the left moves by

.. math:: z + (a - a_G) \, \theta + (y - y_G) \, \varphi

with the body's pitch :math:`\theta` and roll :math:`\varphi`; springs join seats. A wheelset in space has its
left and right wheel as d.o.f.; its center follows by :math:`z = (z_l + z_r) / 2`,
:math:`\varphi = (z_l - z_r) / g`, so that its mass matrix is that of a rigid body.
"""

from __future__ import annotations

from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.model.system import System
from axlespan.vehicles.fitting import Parts
from axlespan.vehicles.parts import Body, Suspension, Wheel
from axlespan.vehicles.vehicle import LEFT, RIGHT, ContactPoint


def assembled(parts: Parts) -> tuple[tuple[ContactPoint, ...], System]:
    """Return the contact points and the system of parts that fit."""
    model = Model(plane=not parts.is_spatial)
    for body in parts.bodies.values():
        model = _with_body(model, body)
    points: list[ContactPoint] = []
    for number, (label, wheel) in enumerate(parts.wheels.items(), 1):
        model = _with_wheel(model, label, wheel)
        points += _contacts(number, label, wheel)
    for i, suspension in enumerate(parts.suspensions):
        model = _with_suspension(model, i, suspension, parts)
    model = _with_hinges(model, parts)
    aliases = {
        f"{name}.{component}": f"{name}.{word}"
        for name in (*parts.bodies, *parts.wheels)
        for component, word in (("ry", "pitch"), ("rx", "roll"))
    }
    return tuple(points), compile_model(model).system.renamed(aliases)


def _with_body(model: Model, body: Body) -> Model:
    moments = {"rx": body.roll_inertia, "ry": body.inertia}
    inertia = {component: value for component, value in moments.items() if value is not None}
    model = model.with_nodes([[-body.position, body.side, 0.0]], [body.name])
    return model.with_mass(body.name, body.mass, inertia, directions=("z",))


def _with_wheel(model: Model, label: str, wheel: Wheel) -> Model:
    if wheel.gauge is None:
        model = model.with_nodes([[-wheel.position, 0.0]], [label])
        return model.with_mass(label, wheel.mass, directions=("z",)) if wheel.mass > 0.0 else model
    g, ends = wheel.gauge, (f"{label}l", f"{label}r")
    places = [[-wheel.position, y, 0.0] for y in (0.0, 0.5 * g, -0.5 * g)]
    model = model.with_nodes(places, [label, *ends])
    for component, factors in (("z", (0.5, 0.5)), ("rx", (1.0 / g, -1.0 / g))):
        masters = [(end, "z", factor) for end, factor in zip(ends, factors, strict=True)]
        model = model.with_tie((label, component), masters)
    if wheel.mass == 0.0:
        return model
    if wheel.independent or wheel.roll_inertia is None:
        share = wheel.mass if wheel.independent else 0.5 * wheel.mass
        for end in ends:
            model = model.with_mass(end, share, directions=("z",))
        return model
    return model.with_mass(label, wheel.mass, {"rx": wheel.roll_inertia}, directions=("z",))


def _contacts(number: int, label: str, wheel: Wheel) -> list[ContactPoint]:
    if wheel.gauge is None:
        return [ContactPoint(str(number), wheel.position, f"{label}.z", radius=wheel.radius)]
    return [
        ContactPoint(f"{number}{end}", wheel.position, f"{label}{end}.z", line, radius=wheel.radius)
        for end, line in (("l", LEFT), ("r", RIGHT))
    ]


def _with_suspension(model: Model, index: int, suspension: Suspension, parts: Parts) -> Model:
    """Add springs and dashpots between seats, and the bar that resists roll."""
    first, second = suspension.between
    at = suspension.at
    if at is None:
        at = parts.position(first if first in parts.wheels else second)
    half = suspension.spread and 0.5 * suspension.spread
    sides = [half, -half] if half else [suspension.side or 0.0]
    if suspension.stiffness or suspension.damping:
        for number, y in enumerate(sides):
            ends: list[int] = []
            for name in (first, second):
                model, node = _seat(model, parts, name, at, y, f"{index + 1}{'lr'[number] if half else ''}")
                ends.append(node)
            model = model.with_springs(
                [ends], {"z": suspension.stiffness}, {"z": suspension.damping}, name=f"suspension{index + 1}"
            )
    if suspension.roll_stiffness or suspension.roll_damping:
        pair = [[model.node(first), model.node(second)]]
        bar = {"rx": suspension.roll_stiffness}, {"rx": suspension.roll_damping}
        model = model.with_springs(pair, *bar, name=f"suspension{index + 1} in roll")
    return model


def _seat(model: Model, parts: Parts, name: str, at: float, y: float, label: str) -> tuple[Model, int]:
    """Return the node where a suspension meets a body: its center, or a seat that the body carries."""
    arms = parts.arms(name, at, y)
    if not arms:
        return model, model.node(name)
    seat = f"{name}:seat{label}"
    model = model.with_nodes([[-at, y if parts.is_spatial else 0.0, 0.0]], [seat])
    return model.with_tie((seat, "z"), [(name, "z", 1.0), *arms]), model.node(seat)


def _with_hinges(model: Model, parts: Parts) -> Model:
    """Let one body of each hinge follow the other: its z, for the inertias must stay."""
    tied: set[str] = set()
    for i, hinge in enumerate(parts.hinges):
        free = [name for name in reversed(hinge.between) if name not in tied]
        if not free:
            raise InputError(
                "joins two bodies whose heights other hinges give already",
                field=f"hinges.{i}",
                value=list(hinge.between),
            )
        slave = free[0]
        master = next(name for name in hinge.between if name != slave)
        masters = [(master, "z", 1.0), *parts.arms(master, hinge.at, 0.0)]
        masters += [(name, component, -lever) for name, component, lever in parts.arms(slave, hinge.at, 0.0)]
        model = model.with_tie((slave, "z"), masters)
        tied.add(slave)
    return model
