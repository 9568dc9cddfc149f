r"""The small contact system: S X = gap, for all wheels whose vehicles touch the structure.

.. math:: S = (1+α) β Δt² \Big( I_X A_v^{-1} I_X^T + E A_s^{-1} E^T \Big)

It is symmetric positive definite and changes from step to step only through E. What a stretch of steps needs
is computed together, before the time loop reaches it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
from scipy.linalg.lapack import dposv

from axlespan.contact.rows import RowBlock, TrainRows
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

    train: TrainRows
    positions: FloatArray  # (n_step, n_contact) [m]
    live: IntArray  # (n_live,) contacts that are on the structure at some step
    gap: FloatArray  # (n_step, n_coupled) r + E_XP u_P [m]
    rank: IntArray  # (n_live,) place among the coupled contacts; -1 for moving forces

    @property
    def active(self) -> IntArray:
        """Which live contacts are coupled."""
        return np.flatnonzero(self.rank >= 0)

    def at(self, steps: slice) -> RowBlock:
        """The rows of the live contacts at some of the steps."""
        return self.train.rows(self.positions[steps, self.live], self.live)

    @cached_property
    def block(self) -> RowBlock:
        """The rows of the live contacts at all steps."""
        return self.at(slice(None))

    @property
    def dofs(self) -> IntArray:
        """Free d.o.f. (n_step, n_live, n_local) of the structure."""
        return self.block.dofs

    @property
    def weights(self) -> FloatArray:
        """Weights (n_step, n_live, n_local); zero off the structure."""
        return self.block.weights


def rows_of(plan: Plan, steps: IntArray) -> Rows:
    """The contact rows of a crossing at consecutive time indices.

    Behind its last step a train stands where it ended; one that has stood so from the first step on is not there.
    """
    if steps[0] > plan.settings.steps:
        return _nothing(plan, len(steps))
    steps = np.minimum(steps, plan.settings.steps)
    times = plan.times_of(steps)
    positions = plan.rows.positions(times)
    live = np.flatnonzero(plan.rows.on_structure(positions).any(axis=0))
    rank = np.full(plan.rows.n_contact, -1, dtype=np.int64)
    rank[plan.fleet.coupled] = np.arange(len(plan.fleet.coupled))
    gap = _gap(plan, times, positions, live, rank[live])
    return Rows(plan.rows, positions, live, gap, rank[live])


def _nothing(plan: Plan, n_step: int) -> Rows:
    none, gap = np.empty(0, dtype=np.int64), np.zeros((n_step, len(plan.fleet.coupled)))
    return Rows(plan.rows, np.zeros((n_step, plan.rows.n_contact)), none, gap, none)


def _gap(plan: Plan, times: FloatArray, positions: FloatArray, live: IntArray, rank: IntArray) -> FloatArray:
    """R + E_XP u_P (n_step, n_coupled) [m]."""
    if not len(plan.fleet.coupled):
        return np.zeros((len(times), 0))
    gap = plan.rows.irregularity(positions)[:, plan.fleet.coupled]
    if len(plan.moving):
        block = plan.rows.rows(positions[:, live], live)
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
class WheelRows:
    """Rows of wheels of several crossings side by side, in arrays of one width."""

    names: IntArray  # (n_wheel,) places among the coupled contacts, or the contacts, of the joint fleet
    flat: IntArray  # (n_step, n_wheel, n_local) places in the structure's state
    held: IntArray  # the same, in loads on the held d.o.f.
    weights: FloatArray  # (n_step, n_wheel, n_local)


@dataclass(frozen=True, eq=False)
class Stretch:
    """Consecutive steps of one or several crossings that advance side by side."""

    first: int  # time index of the first step
    n_step: int
    crossings: Sequence[Rows]
    gap: FloatArray  # (n_step, n_coupled) of the joint fleet [m]
    systems: Sequence[System]
    structure: StructureBody
    begins: tuple[IntArray, IntArray]  # of the crossings among the coupled contacts, and among all

    @property
    def steps(self) -> IntArray:
        """Time indices (n_step,)."""
        return self.first + np.arange(self.n_step)

    @cached_property
    def into(self) -> IntArray:
        """Places (n_coupled_live,) of the coupled wheels on the structure among those of the joint fleet."""
        return self._names(True)

    @cached_property
    def forced(self) -> IntArray:
        """Contacts (n_forced_live,) of the joint fleet that are moving forces on the structure."""
        return self._names(False)

    def _names(self, coupled: bool) -> IntArray:
        ranks, contacts = self.begins
        lanes = enumerate(self.crossings)
        if coupled:
            parts = [ranks[lane] + rows.rank[rows.rank >= 0] for lane, rows in lanes]
        else:
            parts = [contacts[lane] + rows.live[rows.rank < 0] for lane, rows in lanes]
        return np.concatenate(parts).astype(np.int64)

    def rows(self, coupled: bool, steps: slice = slice(None)) -> WheelRows:
        """Rows of the coupled wheels, or of the moving forces, at some steps."""
        names = self.into if coupled else self.forced
        blocks = [rows.block if steps == slice(None) else rows.at(steps) for rows in self.crossings]
        shape = (len(range(self.n_step)[steps]), len(names), max(block.dofs.shape[2] for block in blocks))
        flat, held, weights = np.zeros(shape, np.int64), np.zeros(shape, np.int64), np.zeros(shape)
        lanes, position, filled = self.structure.lanes, self.structure.columns.position, 0
        for lane, (rows, block) in enumerate(zip(self.crossings, blocks, strict=True)):
            which = np.flatnonzero((rows.rank >= 0) == coupled)
            if not len(which):
                continue
            all_of_them = len(which) == len(rows.rank)
            dofs = block.dofs if all_of_them else block.dofs[:, which]
            here = (slice(None), slice(filled, filled + len(which)), slice(dofs.shape[2]))
            np.multiply(dofs, lanes, out=flat[here])
            flat[here] += lane
            held[here] = (position if lanes == 1 else position * lanes + lane)[dofs]
            weights[here] = block.weights if all_of_them else block.weights[:, which]
            filled += len(which)
        return WheelRows(names, flat, held, weights)

    @cached_property
    def _coupled(self) -> WheelRows:
        return self.rows(True)

    @cached_property
    def _forced(self) -> WheelRows:
        return self.rows(False)

    @property
    def flat(self) -> IntArray:
        """Places (n_step, n_coupled_live, n_local) in the structure's state."""
        return self._coupled.flat

    @property
    def held(self) -> IntArray:
        """The same, in loads on the held d.o.f."""
        return self._coupled.held

    @property
    def weights(self) -> FloatArray:
        """Weights (n_step, n_coupled_live, n_local) of the coupled wheels."""
        return self._coupled.weights

    @property
    def forced_flat(self) -> IntArray:
        """Places (n_step, n_forced_live, n_local) of the moving forces."""
        return self._forced.flat

    @property
    def forced_held(self) -> IntArray:
        """The same, in loads on the held d.o.f."""
        return self._forced.held

    @property
    def forced_weights(self) -> FloatArray:
        """Weights (n_step, n_forced_live, n_local) of the moving forces."""
        return self._forced.weights


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
    steps = first + np.arange(n_step)
    crossings = [rows_of(plan, steps) for plan in plans]
    if not structure.columns.is_whole:
        mark = np.zeros(len(structure.columns.position), dtype=bool)  # of a reduced structure too
        for rows in crossings:
            for dofs in rows.train.dofs_passed(rows.positions[[0, -1]], rows.live):
                mark[dofs] = True
        structure.columns.hold(np.flatnonzero(mark))
    ranks = _offsets([len(plan.fleet.coupled) for plan in plans])
    parts = []
    if systems and fleet is not None:
        for lane, rows in enumerate(crossings):
            if len(rows.active):
                parts.append(_system(rows, int(ranks[lane]), structure, fleet))
    # In one order in memory, whatever comes in: loops are compiled for that.
    gap = np.ascontiguousarray(np.concatenate([rows.gap for rows in crossings], axis=1))
    contacts = _offsets([plan.rows.n_contact for plan in plans])
    return Stretch(first, n_step, crossings, gap, parts, structure, (ranks, contacts))


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
