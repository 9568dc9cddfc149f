r"""The small contact system: S X = gap, for all wheels whose vehicles touch the structure.

.. math:: S = (1+α) β Δt² \Big( I_X A_v^{-1} I_X^T + E A_s^{-1} E^T \Big)

It is symmetric positive definite and changes from step to step only through E. What a stretch of steps needs
is computed together, before the time loop reaches it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
from scipy.linalg.lapack import dposv

from axlespan.contact.rows import RowBlock
from axlespan.errors import AxlespanError
from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.path_columns import PathColumns
from axlespan.interaction.path_kernel import compiled_sandwich
from axlespan.interaction.plan import Plan

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Entries that are worked on at a time.
_GATHER = 2_000_000


class ContactSystemError(AxlespanError, ArithmeticError):
    """The contact system is not positive definite."""


@dataclass(frozen=True, eq=False)
class Rows:
    """The contact rows of one crossing for consecutive steps; all of it is known ahead."""

    positions: FloatArray  # (n_step, n_contact) [m]
    live: IntArray  # (n_live,) contacts that are on the structure at some step
    dofs: IntArray  # (n_step, n_live, n_local) free d.o.f. of the structure
    weights: FloatArray  # (n_step, n_live, n_local); zero off the structure
    gap: FloatArray  # (n_step, n_coupled) r + E_XP u_P [m]
    rank: IntArray  # (n_live,) place among the coupled contacts; -1 for moving forces

    @property
    def active(self) -> IntArray:
        """Which live contacts are coupled."""
        return np.flatnonzero(self.rank >= 0)


def rows_of(plan: Plan, steps: IntArray) -> Rows:
    """The contact rows of a crossing at consecutive time indices."""
    times = plan.times_of(steps)
    positions = plan.rows.positions(times)
    live = np.flatnonzero(plan.rows.on_structure(positions).any(axis=0))
    block = plan.rows.rows(positions[:, live], live)
    rank = np.full(plan.rows.n_contact, -1, dtype=np.int64)
    rank[plan.fleet.coupled] = np.arange(len(plan.fleet.coupled))
    gap = _gap(plan, times, positions, block, rank[live])
    return Rows(positions, live, block.dofs, block.weights, gap, rank[live])


def _gap(plan: Plan, times: FloatArray, positions: FloatArray, block: RowBlock, rank: IntArray) -> FloatArray:
    """R + E_XP u_P (n_step, n_coupled) [m]."""
    gap = plan.rows.irregularity(positions)[:, plan.fleet.coupled]
    if len(plan.moving):
        motions = plan.crossing.structure.system.motions
        u_p = np.column_stack([motions[j].value(times) for j in plan.moving])
        moved = u_p[np.arange(len(times))[:, None, None], block.prescribed_dofs] * block.prescribed_weights
        coupled = np.flatnonzero(rank >= 0)
        gap[:, rank[coupled]] += moved.sum(axis=2)[:, coupled]
    return gap


@dataclass(frozen=True, eq=False)
class System:
    """The contact systems of one crossing for consecutive steps."""

    contacts: IntArray  # (n,) coupled contacts of vehicles that touch the structure, in the joint fleet
    matrices: FloatArray  # (n_step, n, n) S [m/N]


@dataclass(frozen=True, eq=False)
class Stretch:
    """Consecutive steps of one or several crossings that advance side by side."""

    first: int  # time index of the first step
    n_step: int
    crossings: Sequence[Rows]
    flat: IntArray  # (n_step, n_coupled_live, n_local) places in the structure's state
    held: IntArray  # the same, in loads on the held d.o.f.
    weights: FloatArray  # (n_step, n_coupled_live, n_local)
    into: IntArray  # (n_coupled_live,) places among the coupled contacts of the joint fleet
    gap: FloatArray  # (n_step, n_coupled) of the joint fleet [m]
    systems: Sequence[System]
    forced: IntArray  # (n_forced_live,) contacts of the joint fleet that are moving forces
    forced_flat: IntArray  # (n_step, n_forced_live, n_local)
    forced_held: IntArray  # the same, in loads on the held d.o.f.
    forced_weights: FloatArray  # (n_step, n_forced_live, n_local)

    @property
    def steps(self) -> IntArray:
        """Time indices (n_step,)."""
        return self.first + np.arange(self.n_step)


def stretch_of(
    plans: Sequence[Plan],
    first: int,
    n_step: int,
    structure: StructureBody,
    fleet: FleetBody | None,
    *,
    systems: bool = True,
) -> Stretch:
    """Prepare consecutive steps of crossings that share a structure, in the order of its lanes.

    The columns of A⁻¹ under the wheels are made available; ``systems=False`` leaves out the contact systems.
    """
    crossings = [rows_of(plan, first + np.arange(n_step)) for plan in plans]
    columns = structure.columns
    columns.hold(np.concatenate([rows.dofs[rows.weights != 0.0] for rows in crossings]))
    contacts = _offsets([plan.rows.n_contact for plan in plans])
    ranks = _offsets([len(plan.fleet.coupled) for plan in plans])
    n_local = max(rows.dofs.shape[2] for rows in crossings)
    n_coupled = [len(rows.active) for rows in crossings]
    n_forced = sum(len(rows.rank) for rows in crossings) - sum(n_coupled)
    coupled, forced = _Wheels(n_step, sum(n_coupled), n_local), _Wheels(n_step, n_forced, n_local)
    parts = []
    for lane, rows in enumerate(crossings):
        is_coupled = rows.rank >= 0
        coupled.append(rows, is_coupled, ranks[lane] + rows.rank[is_coupled], lane, structure)
        forced.append(rows, ~is_coupled, contacts[lane] + rows.live[~is_coupled], lane, structure)
        if systems and fleet is not None and len(rows.active):
            parts.append(_system(rows, int(ranks[lane]), structure, fleet))
    gap = np.concatenate([rows.gap for rows in crossings], axis=1)
    return Stretch(
        first,
        n_step,
        crossings,
        coupled.flat,
        coupled.held,
        coupled.weights,
        coupled.names,
        gap,
        parts,
        forced.names,
        forced.flat,
        forced.held,
        forced.weights,
    )


class _Wheels:
    """Rows of wheels from several crossings, gathered into arrays of one width."""

    def __init__(self, n_step: int, n_wheel: int, n_local: int) -> None:
        shape = (n_step, n_wheel, n_local)
        self.flat, self.held = np.zeros(shape, dtype=np.int64), np.zeros(shape, dtype=np.int64)
        self.weights, self.names = np.zeros(shape), np.empty(n_wheel, dtype=np.int64)
        self._filled = 0

    def append(
        self, rows: Rows, which: npt.NDArray[np.bool_], names: IntArray, lane: int, structure: StructureBody
    ) -> None:
        """Add some wheels of one crossing."""
        all_of_them = bool(which.all())
        dofs = rows.dofs if all_of_them else rows.dofs[:, which]
        n_wheel, n_local = dofs.shape[1:]
        here = (slice(None), slice(self._filled, self._filled + n_wheel), slice(n_local))
        lanes = structure.lanes
        np.multiply(dofs, lanes, out=self.flat[here])
        self.flat[here] += lane
        places = structure.columns.position if lanes == 1 else structure.columns.position * lanes + lane
        self.held[here] = places[dofs]
        self.weights[here] = rows.weights if all_of_them else rows.weights[:, which]
        self.names[here[1]] = names
        self._filled += n_wheel


def _offsets(sizes: Sequence[int]) -> IntArray:
    return np.concatenate([[0], np.cumsum(sizes)])[:-1].astype(np.int64)


def _system(rows: Rows, offset: int, structure: StructureBody, fleet: FleetBody) -> System:
    """S of one crossing at all steps of the stretch."""
    own = offset + rows.rank[rows.active]
    owner = fleet.fleet.vehicle_of
    contacts = np.flatnonzero(np.isin(owner, owner[own]))
    vehicles = fleet.compliance[contacts][:, contacts].toarray()
    vehicles = 0.5 * (vehicles + vehicles.T)
    at = np.searchsorted(contacts, own)
    local = structure.columns.position[rows.dofs[:, rows.active]]
    line = path_compliance(structure.columns, local, rows.weights[:, rows.active])
    if np.array_equal(own, contacts):
        line += vehicles
        return System(contacts, line)
    matrices = np.repeat(vehicles[None], len(rows.positions), axis=0)
    matrices[:, at[:, None], at] += line
    return System(contacts, matrices)


def path_compliance(columns: PathColumns, local: IntArray, weights: FloatArray) -> FloatArray:
    """E Z Eᵀ (n_step, n_wheel, n_wheel) for rows on the held d.o.f. and their compliance Z."""
    n_step, n_wheel, n_local = local.shape
    compliance = columns.compliance
    n_path = compliance.shape[0]
    if not n_path:  # every wheel stands right over a support
        return np.zeros((n_step, n_wheel, n_wheel))
    result = np.empty((n_step, n_wheel, n_wheel))
    if (sandwich := compiled_sandwich()) is not None:
        sandwich(compliance, columns.offset, columns.low, columns.high, local, weights, result)
        return result
    ones = np.ones(n_local)
    some_steps = max(1, _GATHER // max(n_wheel * max(n_path, n_wheel * n_local), 1))
    for begin in range(0, n_step, some_steps):
        where, w = local[begin : begin + some_steps], weights[begin : begin + some_steps]
        n = len(where)
        ends = np.arange(0, n * n_wheel * n_local + 1, n_local)
        E = sp.csr_array((w.ravel(), where.ravel(), ends), shape=(n * n_wheel, n_path))
        half = (E @ compliance).reshape(n, n_wheel, n_path)  # E Z
        places = np.broadcast_to(where.reshape(n, 1, -1), (n, n_wheel, n_wheel * n_local))
        block = np.take_along_axis(half, places, axis=2)
        block *= w.reshape(n, 1, -1)
        result[begin : begin + n] = block.reshape(n, n_wheel, n_wheel, n_local) @ ones
    return result


def solve_contact(system: FloatArray, gap: FloatArray) -> FloatArray:
    """Contact forces (n,) [N] from S (n, n) and the gap of the free responses (n,) [m].

    Raises
    ------
    ContactSystemError
        If S is not positive definite, which a divergent or overflowing run brings about.
    """
    _, forces, info = dposv(system, gap, lower=1)
    if info != 0:
        raise ContactSystemError("the contact system is not positive definite")
    return np.asarray(forces)
