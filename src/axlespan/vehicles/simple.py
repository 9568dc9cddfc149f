"""Simple vehicles: sprung masses, rigid masses, axle loads, and a rigid body on several axles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.materials import require_positive
from axlespan.model.model import Model
from axlespan.vehicles.vehicle import ContactPoint, Vehicle


def sprung_mass(
    *,
    mass: float,
    stiffness: float,
    damping: float = 0.0,
    unsprung_mass: float = 0.0,
    name: str = "sprung mass",
) -> Vehicle:
    """A mass on a spring and dashpot over a wheel, which is massless unless it gets a mass.

    Parameters
    ----------
    mass : float
        Suspended mass [kg].
    stiffness, damping : float
        Of the suspension [N/m], [N s/m].
    unsprung_mass : float
        Mass of the wheel [kg].
    name : str

    Raises
    ------
    InputError
        If mass or stiffness is not positive, or another value negative.

    Notes
    -----
    D.o.f.: ``body.z``, ``wheel1.z``. This is N12's vehicle (39), with the contact point as a node.
    """
    require_positive(mass, "mass")
    require_positive(stiffness, "stiffness")
    require_positive(damping, "damping", zero=True)
    require_positive(unsprung_mass, "unsprung_mass", zero=True)
    model = Model(plane=True).with_nodes([[0.0, 1.0], [0.0, 0.0]], ["body", "wheel1"])
    model = model.with_mass("body", mass, directions=("z",)).with_springs(
        [[1, 0]], {"z": stiffness}, {"z": damping}, name="suspension"
    )
    if unsprung_mass > 0.0:
        model = model.with_mass("wheel1", unsprung_mass, directions=("z",))
    point = ContactPoint("1", 0.0, "wheel1.z")
    return Vehicle((point,), compile_model(model).system, name, bodies={"body": 0.0})


def rigid_mass(*, mass: float, name: str = "rigid mass") -> Vehicle:
    """A mass that follows the line exactly: a moving mass [kg]. D.o.f.: ``wheel1.z``.

    Parameters
    ----------
    mass : float
        [kg].
    name : str

    Raises
    ------
    InputError
        If the mass is not positive.
    """
    require_positive(mass, "mass")
    model = (
        Model(plane=True).with_nodes([[0.0, 0.0]], ["wheel1"]).with_mass("wheel1", mass, directions=("z",))
    )
    return Vehicle((ContactPoint("1", 0.0, "wheel1.z"),), compile_model(model).system, name)


def axle_loads(
    *, loads: float | Sequence[float], positions: Sequence[float] = (0.0,), name: str = "axle loads"
) -> Vehicle:
    """Moving forces.

    Parameters
    ----------
    loads : float or sequence of float
        Downward [N]; one for all axles or one each.
    positions : sequence of float
        Distances behind the first axle [m], the first being 0.
    name : str

    Raises
    ------
    InputError
        If a load is not positive, or loads and positions do not fit.
    """
    values = list(loads) if isinstance(loads, Sequence | np.ndarray) else [loads] * len(positions)
    if len(values) != len(positions):
        raise InputError("must be one load, or one for each axle", field="loads", value=values)
    for i, load in enumerate(values):
        require_positive(load, f"loads.{i}")
    points = tuple(
        ContactPoint(str(i + 1), float(x), None, force=float(load))
        for i, (x, load) in enumerate(zip(positions, values, strict=True))
    )
    return Vehicle(points, None, name)


def rigid_body(
    *,
    mass: float,
    pitch_inertia: float,
    axles: Sequence[float],
    stiffness: float | Sequence[float],
    damping: float | Sequence[float] = 0.0,
    unsprung_mass: float | Sequence[float] = 0.0,
    center: float | None = None,
    name: str = "rigid body",
) -> Vehicle:
    """A rigid body with bounce and pitch on two or more sprung axles.

    Parameters
    ----------
    mass, pitch_inertia : float
        Of the body [kg], [kg m^2] about its center of gravity.
    axles : sequence of float
        Distances of the axles behind the first one [m], starting with 0.
    stiffness, damping, unsprung_mass : float or sequence of float
        Of each axle: suspension [N/m], [N s/m] and wheel [kg].
    center : float, optional
        Distance of the center of gravity behind the first axle [m]; the middle by default.
    name : str

    Raises
    ------
    InputError
        If a value is out of range, or there are fewer than two axles.

    Notes
    -----
    D.o.f.: ``body.z``, ``body.pitch`` (right-handed about y: positive lowers the front), ``wheel1.z``, …
    """
    require_positive(mass, "mass")
    require_positive(pitch_inertia, "pitch_inertia")
    n = len(axles)
    if n < 2 or axles[0] != 0.0 or np.any(np.diff(axles) <= 0.0):
        raise InputError(
            "must be two or more increasing distances that start with 0", field="axles", value=list(axles)
        )
    k, c, m = (
        _each(values, n, field)
        for values, field in (
            (stiffness, "stiffness"),
            (damping, "damping"),
            (unsprung_mass, "unsprung_mass"),
        )
    )
    middle = 0.5 * axles[-1] if center is None else float(center)
    model = (
        Model(plane=True)
        .with_nodes([[-middle, 1.0]], ["body"])
        .with_mass("body", mass, {"ry": pitch_inertia}, directions=("z",))
    )
    for i, behind in enumerate(axles):
        model = model.with_nodes([[-behind, 1.0], [-behind, 0.0]], [f"seat{i + 1}", f"wheel{i + 1}"])
        model = model.with_rigid_link("body", [f"seat{i + 1}"], ("z",))
        seat, wheel = model.node(f"seat{i + 1}"), model.node(f"wheel{i + 1}")
        require_positive(k[i], f"stiffness.{i}")
        model = model.with_springs([[wheel, seat]], {"z": k[i]}, {"z": c[i]}, name=f"suspension{i + 1}")
        if m[i] > 0.0:
            model = model.with_mass(wheel, m[i], directions=("z",))
    points = tuple(
        ContactPoint(str(i + 1), float(behind), f"wheel{i + 1}.z") for i, behind in enumerate(axles)
    )
    system = compile_model(model).system.renamed({"body.ry": "body.pitch"})
    return Vehicle(points, system, name, bodies={"body": middle})


def _each(values: float | Sequence[float], n: int, field: str) -> list[float]:
    result = list(values) if isinstance(values, Sequence | np.ndarray) else [float(values)] * n
    if len(result) != n:
        raise InputError(f"must be one value, or one for each of the {n} axles", field=field, value=result)
    for i, value in enumerate(result):
        require_positive(value, f"{field}.{i}", zero=True)
    return result
