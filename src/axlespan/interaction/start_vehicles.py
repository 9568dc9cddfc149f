"""The vehicles of a train one by one: equal ones are factored once, and nothing is as large as the train squared."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.integrator import Matrices
from axlespan.interaction.fleet import Fleet
from axlespan.interaction.plan import Plan
from axlespan.linalg.factor import Factor, factorize
from axlespan.linalg.parts import factor_for_loads_on

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Share of the effective stiffness that stands in for the missing mass of massless d.o.f.: their
# accelerations then are those that keep the static balance of forces, to this relative accuracy.
_SUBSTITUTE = 1e-7


@dataclass(frozen=True, eq=False)
class VehicleKind:
    """Vehicles with the same matrices."""

    matrices: Matrices  # over its m d.o.f.
    dofs: IntArray  # (c,) of the contacts

    @cached_property
    def rest(self) -> IntArray:
        """D.o.f. that are no contact's."""
        return np.setdiff1d(np.arange(self.matrices.size), self.dofs)

    @cached_property
    def follow(self) -> FloatArray:
        """Displacements (n_rest, c) of the other d.o.f. at rest, for unit ones of the contacts."""
        if not len(self.rest):
            return np.zeros((0, len(self.dofs)))
        stiffness = sp.csr_array(self.matrices.K)
        link = np.ascontiguousarray(stiffness[self.rest][:, self.dofs].toarray())
        return -factorize(sp.csr_array(stiffness[self.rest][:, self.rest])).solve(link)

    @cached_property
    def stiffness(self) -> FloatArray:
        """Static stiffness (c, c) seen from the contacts [N/m]."""
        stiffness = sp.csr_array(self.matrices.K)
        own = stiffness[self.dofs][:, self.dofs].toarray()
        own = own + stiffness[self.rest][:, self.dofs].toarray().T @ self.follow
        scale = np.abs(stiffness.diagonal()[self.dofs])
        own[np.abs(own) < 1e-12 * np.sqrt(np.outer(scale, scale))] = 0.0  # statically determinate: rounding
        return np.asarray(own)


class KindMass:
    """Accelerations of the vehicles of a kind from forces on them."""

    def __init__(self, kind: VehicleKind, plan: Plan) -> None:
        self._factor = mass_factor(kind.matrices, plan)
        self._moves = where_mass(kind.matrices, np.ones(kind.matrices.size), kind.dofs)
        unit = np.zeros((kind.matrices.size, len(kind.dofs)))
        unit[kind.dofs, np.arange(len(kind.dofs))] = 1.0
        self.responses = self._factor.solve(unit)  # (m, c) to unit forces at the contacts
        self.at_contacts = self.responses[kind.dofs]  # (c, c)

    def free(self, net: FloatArray) -> FloatArray:
        """Accelerations (n_vehicle, m) under forces (n_vehicle, m).

        The wheels' d.o.f. take the contact force; other massless d.o.f. are in balance already.
        """
        return np.asarray(self._factor.solve(np.ascontiguousarray((net * self._moves).T)).T)


@dataclass(frozen=True, eq=False)
class Group:
    """The vehicles of one kind in a fleet."""

    kind: VehicleKind
    dofs: IntArray  # (n_vehicle, m) in the fleet
    contacts: IntArray  # (n_vehicle, c) places among the coupled contacts


class Vehicles:
    """The kinds of vehicles of several crossings, and their masses."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._kinds: dict[bytes, VehicleKind] = {}
        self._groups: dict[int, tuple[Fleet, list[Group]]] = {}
        self._masses: dict[VehicleKind, KindMass] = {}

    def groups(self, fleet: Fleet) -> list[Group]:
        """The vehicles of a fleet by kind."""
        if id(fleet) not in self._groups:  # the fleet is kept, so that its id stays its own
            self._groups[id(fleet)] = fleet, groups_of(fleet, self._kinds)
        return self._groups[id(fleet)][1]

    def mass(self, kind: VehicleKind) -> KindMass:
        """What turns forces on a kind into accelerations."""
        if kind not in self._masses:
            self._masses[kind] = KindMass(kind, self._plan)
        return self._masses[kind]


def groups_of(fleet: Fleet, known: dict[bytes, VehicleKind]) -> list[Group]:
    """The vehicles of a fleet by kind; kinds found are added to those known."""
    if not len(fleet.coupled):
        return []
    m, owner = fleet.matrices, fleet.owner_of_dof
    parts = [matrix for matrix in (m.K, m.M, m.C) if matrix is not None]
    ends = np.concatenate([[0], np.flatnonzero(np.diff(owner)) + 1, [m.size]])
    wheels = np.searchsorted(fleet.vehicle_of, [*owner[ends[:-1]], np.iinfo(np.int64).max])
    members: dict[bytes, list[tuple[int, int]]] = {}
    for i, (low, high) in enumerate(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)):
        own = fleet.dofs[wheels[i] : wheels[i + 1]] - low
        key = b"|".join([own.tobytes(), *(piece for part in parts for piece in _pieces(part, low, high))])
        if key not in known:
            blocks = [
                None if part is None else sp.csr_array(part[low:high, low:high]) for part in (m.K, m.M, m.C)
            ]
            assert blocks[0] is not None and blocks[1] is not None
            known[key] = VehicleKind(Matrices(blocks[0], blocks[1], blocks[2]), own)
        members.setdefault(key, []).append((low, int(wheels[i])))
    groups = []
    for key, places in members.items():
        kind, at = known[key], np.array(places)
        dofs, contacts = (
            at[:, [j]] + np.arange(n) for j, n in enumerate((kind.matrices.size, len(kind.dofs)))
        )
        groups.append(Group(kind, dofs, contacts))
    return groups


def _pieces(matrix: sp.csr_array, low: int, high: int) -> tuple[bytes, bytes, bytes]:
    """The block of one vehicle, as what tells it from others."""
    starts = matrix.indptr[low : high + 1]
    begin, end = starts[0], starts[-1]
    entries = matrix.data[begin:end]
    return (starts - begin).tobytes(), (matrix.indices[begin:end] - low).tobytes(), entries.tobytes()


def condensed_stiffness(fleet: Fleet) -> FloatArray:
    """Static stiffness (n_contact, n_contact) of the vehicles seen from their contact points."""
    result = np.zeros((len(fleet.weight), len(fleet.weight)))
    for group in groups_of(fleet, {}):
        for places in fleet.coupled[group.contacts]:
            result[np.ix_(places, places)] = group.kind.stiffness
    return result


def mass_factor(matrices: Matrices, plan: Plan, loaded: IntArray | None = None) -> Factor:
    """Factor of M, with a trace of stiffness where a d.o.f. has no mass; ``loaded`` are d.o.f. that loads act on mostly."""

    def factor_of(matrix: sp.csr_array) -> Factor:
        return factorize(sp.csr_array(matrix), kind=plan.settings.solver, threads=plan.settings.threads)

    mass = matrices.M
    if np.all(mass.diagonal() > 0.0):
        return factor_of(mass) if loaded is None else factor_for_loads_on(loaded, mass, factor_of)
    dt = plan.settings.time_step
    mass = mass + (_SUBSTITUTE * 0.25 * dt**2) * matrices.K
    if matrices.C is not None:
        mass = mass + (_SUBSTITUTE * 0.5 * dt) * matrices.C
    return factor_of(mass)


def where_mass(matrices: Matrices, force: FloatArray, also: IntArray | None = None) -> FloatArray:
    """The force, without the rounding that stands on massless d.o.f. in balance."""
    mask = matrices.M.diagonal() > 0.0
    if also is not None:
        mask[also] = True
    return np.where(mask, force, 0.0)
