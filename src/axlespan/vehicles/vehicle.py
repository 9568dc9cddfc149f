"""A vehicle: a System with contact points, or just axle forces; positions count from its first wheel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.card import Card, Shown, some
from axlespan.errors import InputError
from axlespan.irregularity.profile import Profile
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import NotPositiveDefinite, factorize
from axlespan.model.compile import compile_model
from axlespan.model.materials import require_positive
from axlespan.model.model import Model
from axlespan.model.system import Load, System
from axlespan.running.structure import MAIN_LINE
from axlespan.vehicles.loads import BodyLoad, load_vector

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

GRAVITY = 9.81  # [m/s^2]

# Vehicles with more d.o.f. than this tell their 40 lowest frequencies only.
_ALL_MODES_UP_TO = 400
# Up to so many d.o.f. dense matrices are quicker, and from this smallest eigenvalue of the scaled stiffness on a
# vehicle stands beyond doubt.
_DENSE_UP_TO, _SURE = 60, 1e-6

#: Names of the running lines of the left and the right wheels of vehicles in space.
LEFT, RIGHT = "left", "right"


class WheelLaw(Protocol):
    """A law of contact; those there are live in :mod:`axlespan.contact.laws`."""

    @property
    def kind(self) -> str:
        """Word of the law."""
        ...


@dataclass(frozen=True)
class ContactPoint:
    """Where a vehicle touches the running line."""

    name: str
    behind: float  # distance behind the vehicle's first wheel [m]
    dof: str | None = None  # d.o.f. of the vehicle; None: a force that moves along
    line: str = MAIN_LINE  # name of the running line
    force: float = 0.0  # [N] downward, of a moving force
    law: WheelLaw | None = None  # of contact; None: that of the analysis
    radius: float | None = None  # rolling radius [m], where the contact has a compliance of its own
    profile: Profile | None = None  # of the wheel, over its position along the line: adds to the line's own
    patch: float | None = None  # length over which it feels the mean of the line's profile [m]; None: a point


@dataclass(frozen=True, eq=False, repr=False)
class Vehicle(Shown):
    """A vehicle, as a system with contact points.

    Its displacements are counted from its static position on level ground. A vehicle without a
    system is a group of moving forces.
    """

    contacts: tuple[ContactPoint, ...]
    system: System | None = None
    name: str = "vehicle"
    length: float | None = None  # over buffers [m], for drawings and overlaps
    facts: Mapping[str, float] = field(default_factory=dict)
    is_multibody: bool = True  # of rigid bodies: all its periods matter; a mesh has far shorter ones
    bodies: Mapping[str, float] = field(
        default_factory=dict
    )  # centers behind the first wheel [m], for drawings
    overhang: float | None = (
        None  # from the front buffer to the first wheel [m]; half of what is left if None
    )

    def __post_init__(self) -> None:
        if not self.contacts:
            raise InputError("must have at least one wheel", field="vehicle", value=self.name)
        if min(point.behind for point in self.contacts) != 0.0:
            raise InputError("must have its first wheel at 0", field="vehicle", value=self.name)
        names = [point.name for point in self.contacts]
        if len(set(names)) < len(names):
            raise InputError("must have different names for its wheels", field="vehicle", value=self.name)

    @property
    def is_force(self) -> bool:
        """Whether it is just moving forces."""
        return self.system is None

    @cached_property
    def contact_dofs(self) -> IntArray:
        """Free d.o.f. (n_contact,) of the system at its contact points (set X of N12)."""
        if self.system is None:
            return np.empty(0, dtype=np.int64)
        position = {int(full): i for i, full in enumerate(self.system.independent[self.system.free])}
        result = []
        for point in self.contacts:
            full = self.system.dof(point.dof or "")
            if full not in position:
                raise InputError(
                    "must be free and not tied to another", field="contact d.o.f.", value=point.dof
                )
            result.append(position[full])
        if len(set(result)) < len(result):
            raise InputError("must touch the line with different d.o.f.", field="vehicle", value=self.name)
        return np.array(result, dtype=np.int64)

    def static_forces(self, gravity: float = GRAVITY) -> FloatArray:
        """Contact forces (n_contact,) [N] on level ground, positive in compression.

        Constant loads on bodies count; by linearity these are all that they change.

        Raises
        ------
        InputError
            If the vehicle is a mechanism on its wheels, or a wheel would have to pull.
        """
        if self.system is None:
            return np.array([point.force for point in self.contacts])
        if gravity not in self._static:
            self._static[gravity] = self._pressed(self.system, gravity)
        return self._static[gravity].copy()

    @cached_property
    def _static(self) -> dict[float, FloatArray]:
        """Static contact forces [N] by gravity [m/s^2]: crossings of one train share them."""
        return {}

    def _pressed(self, system: System, gravity: float) -> FloatArray:
        blocks = system.partition
        constant = [load.vector for load in system.loads if load.history is None]
        weight = (system.weight(gravity) + sum(constant, np.zeros(system.size)))[system.free]
        x = self.contact_dofs
        rest = np.setdiff1d(np.arange(len(weight)), x)
        forces = -weight[x]
        if len(rest) and len(weight) <= _DENSE_UP_TO:
            stiffness = blocks.K_FF.toarray()
            inner, across = stiffness[np.ix_(rest, rest)], stiffness[np.ix_(x, rest)]
            stands = _stands_surely(inner)
            u = np.linalg.solve(inner, weight[rest]) if stands else self._sunk(inner, weight, rest)
            forces = forces + across @ u
        elif len(rest):
            sparse = sp.csr_array(blocks.K_FF)
            forces = forces + sparse[x][:, rest] @ self._sunk(sparse[rest][:, rest], weight, rest)
        if gravity > 0.0 and np.any(forces <= 0.0):
            low = float(forces.min())
            worst = int(np.argmax(forces <= low + 1e-9 * abs(low)))  # the first of those that are alike
            raise InputError(
                "must press on the line when it stands still on level ground",
                field=f"wheel '{self.contacts[worst].name}' of vehicle '{self.name}'",
                value=f"{forces[worst]:.6g} N",
                fix="Check the loads on its bodies: under them it would tip over"
                if constant
                else "Check the masses and the positions of the bodies over the wheels",
            )
        return np.asarray(forces)

    def _sunk(self, inner: sp.csr_array | FloatArray, weight: FloatArray, rest: IntArray) -> FloatArray:
        """Displacements (n_rest,) under the weight, on wheels that stand still."""
        try:
            return np.asarray(factorize(inner).solve(weight[rest].copy()))
        except NotPositiveDefinite as error:
            raise self._mechanism(rest[np.asarray(error.suspects)]) from error

    def _mechanism(self, dofs: IntArray) -> InputError:
        assert self.system is not None
        names = ", ".join(self.system.free_name(int(i)) for i in dofs[:6])
        return InputError(
            f"must stand on its wheels, but can move freely at {names}",
            field="vehicle",
            value=self.name,
            fix="Add the springs that carry it, or remove the degree of freedom",
        )

    @cached_property
    def has_massive_contacts(self) -> bool:
        """Whether a contact point has mass of its own."""
        if self.system is None:
            return False
        return bool(np.any(self.system.partition.M_FF.diagonal()[self.contact_dofs] > 0.0))

    @cached_property
    def has_dashpot_contacts(self) -> bool:
        """Whether a dashpot ends at a contact point."""
        if self.system is None:
            return False
        return bool(np.any(self.system.partition.C_FF.diagonal()[self.contact_dofs] != 0.0))

    def frequencies(self) -> FloatArray:
        """Natural frequencies [Hz] with the contact points held, ascending; empty for moving forces and masses."""
        return self._frequencies.copy()

    @cached_property
    def _frequencies(self) -> FloatArray:
        if self.system is None:
            return np.empty(0)
        blocks = self.system.partition
        rest = np.setdiff1d(np.arange(blocks.K_FF.shape[0]), self.contact_dofs)
        if not len(rest):
            return np.empty(0)
        stiffness, mass = (sp.csr_array(matrix[rest][:, rest]) for matrix in (blocks.K_FF, blocks.M_FF))
        count = int(np.count_nonzero(mass.diagonal()))
        if count == 0:
            return np.empty(0)
        if not self.is_multibody or len(rest) > _ALL_MODES_UP_TO:
            count = min(count, 40)
        return lowest_modes(stiffness, mass, count).frequencies

    @property
    def total_mass(self) -> float:
        """Mass of bodies and wheels [kg]; zero for moving forces."""
        return 0.0 if self.system is None else self.system.total_mass()

    def loaded(self, loads: Sequence[BodyLoad]) -> Vehicle:
        """The same vehicle under constant forces and moments on its bodies, such as cross-wind.

        Its displacements count from the static position under them. Heights of bodies come from ``facts``.

        Raises
        ------
        InputError
            If a body is unknown, or cannot turn about the axis of a moment.
        """
        if self.system is None:
            raise InputError("has no bodies that could be loaded", field="loads", value=self.name)
        heights = {
            name.removesuffix(".height"): value
            for name, value in self.facts.items()
            if name.endswith(".height")
        }
        return replace(self, system=self.system.with_loads(Load(load_vector(self.system, loads, heights))))

    def on_lines(self, lines: Mapping[str, str]) -> Vehicle:
        """The same vehicle with its wheels on other running lines: ``{"left": "track2-left", ...}``."""
        contacts = tuple(replace(point, line=lines.get(point.line, point.line)) for point in self.contacts)
        return replace(self, contacts=contacts)

    def as_axle_loads(self, gravity: float = GRAVITY) -> Vehicle:
        """The same wheels as moving forces of their static loads.

        Parameters
        ----------
        gravity : float
            [m/s^2].
        """
        forces = self.static_forces(gravity)
        points = tuple(
            replace(point, dof=None, force=float(force), law=None)
            for point, force in zip(self.contacts, forces, strict=True)
        )
        return replace(self, contacts=points, system=None, bodies={}, name=f"{self.name} as axle loads")

    def as_moving_masses(self, gravity: float = GRAVITY) -> Vehicle:
        """The same wheels as masses that follow the line, each with the mass of its static load.

        Parameters
        ----------
        gravity : float
            [m/s^2].

        Raises
        ------
        InputError
            Without gravity there are no static loads.
        """
        require_positive(gravity, "gravity")
        forces = self.static_forces(gravity)
        model = Model(plane=True)
        points = []
        for i, (point, force) in enumerate(zip(self.contacts, forces, strict=True)):
            wheel = f"wheel{i + 1}"
            model = model.with_nodes([[-point.behind, 0.0]], [wheel])
            model = model.with_mass(wheel, float(force) / gravity, directions=("z",))
            points.append(replace(point, dof=f"{wheel}.z", force=0.0))
        name = f"{self.name} as moving masses"
        system = compile_model(model).system
        return replace(self, contacts=tuple(points), system=system, bodies={}, name=name, is_multibody=True)

    def reversed(self) -> Vehicle:
        """The same vehicle the other way round: its last wheel leads.

        Contacts are numbered anew from the wheel that leads; d.o.f. keep their names and axes. Wheels of the lines
        ``left`` and ``right`` change sides.
        """
        last = self.wheelbase
        sides = {LEFT: RIGHT, RIGHT: LEFT}
        if {point.line for point in self.contacts} != set(sides):
            sides = {}
        turned = sorted(
            (
                replace(point, behind=last - point.behind, line=sides.get(point.line, point.line))
                for point in self.contacts
            ),
            key=lambda point: (point.behind, -_rank(self.contacts, point.name)),
        )
        names = [point.name for point in self.contacts]
        contacts = tuple(replace(point, name=name) for point, name in zip(turned, names, strict=True))
        overhang = None if self.length is None else self.rear_overhang
        bodies = {name: last - behind for name, behind in self.bodies.items()}
        name = f"{self.name} reversed"
        return replace(self, contacts=contacts, overhang=overhang, bodies=bodies, name=name)

    @property
    def wheelbase(self) -> float:
        """Distance from the first wheel to the last [m]."""
        return max(point.behind for point in self.contacts)

    @property
    def front_overhang(self) -> float:
        """From the front buffer to the first wheel [m]; zero if the length is not known."""
        if self.length is None:
            return 0.0
        return 0.5 * (self.length - self.wheelbase) if self.overhang is None else self.overhang

    @property
    def rear_overhang(self) -> float:
        """From the last wheel to the rear buffer [m]; zero if the length is not known."""
        return 0.0 if self.length is None else self.length - self.wheelbase - self.front_overhang

    def card(self) -> Card:
        """Return what is shown of it."""
        forces = [f"{force / 1e3:.5g}" for force in self.static_forces()]
        frequencies = [f"{frequency:.3g}" for frequency in self.frequencies()]
        facts = [
            ("wheels", some([f"{point.name} at {point.behind:g} m" for point in self.contacts])),
            ("static forces", f"{some(forces)} kN"),
            ("frequencies", f"{some(frequencies)} Hz" if frequencies else "none: it moves with the line"),
        ]
        if self.system is not None:
            facts.append(("d.o.f.", some([self.system.free_name(i) for i in range(len(self.system.free))])))
        return Card(f"Vehicle: {self.name}", facts, "asp.Train.of(vehicle, count=8, spacing=24.775)")


def _stands_surely(stiffness: FloatArray) -> bool:
    """Whether a small matrix is symmetric and far from singular, so that nothing needs to be looked at more closely."""
    size = np.sqrt(np.abs(stiffness.diagonal()))
    if not size.all() or not np.array_equal(stiffness, stiffness.T):
        return False
    return bool(np.linalg.eigvalsh(stiffness / size / size[:, None])[0] > _SURE)


def _rank(contacts: tuple[ContactPoint, ...], name: str) -> int:
    return [point.name for point in contacts].index(name)
