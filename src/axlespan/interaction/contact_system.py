r"""The small contact system: S X = gap, for all wheels whose vehicles touch the structure.

.. math:: S = (1+α) β Δt² \Big( I_X A_v^{-1} I_X^T + E A_s^{-1} E^T \Big)

It is symmetric positive definite and changes from step to step only through E. The rows of a stretch of
steps are computed together, before the time loop reaches them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dposv

from axlespan.contact.rows import RowBlock
from axlespan.errors import AxlespanError
from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.plan import Plan

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Steps of a stretch, and the entries of S that one may hold.
_STRETCH, _ENTRIES = 256, 4_000_000


class ContactSystemError(AxlespanError, ArithmeticError):
    """The contact system is not positive definite."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """Everything about contact that is known ahead, for consecutive steps."""

    first: int  # number of the first step (time index)
    positions: FloatArray  # (n_step, n_contact) [m]
    on: npt.NDArray[np.bool_]  # (n_step, n_contact)
    live: IntArray  # (n_live,) contacts on the structure at some step
    dofs: IntArray  # (n_step, n_live, n_local) free d.o.f. of the structure
    local: IntArray  # the same, as positions on the path
    weights: FloatArray  # (n_step, n_live, n_local)
    gap: FloatArray  # (n_step, n_coupled) r + E_XP u_P [m]
    live_coupled: IntArray  # (n_live_coupled,) which live contacts are coupled
    live_forced: IntArray  # which are moving forces
    into_coupled: IntArray  # (n_live_coupled,) their positions among the coupled contacts
    active: IntArray  # (n_active,) coupled contacts of vehicles that touch the structure
    systems: FloatArray  # (n_step, n_active, n_active) S

    @property
    def n_step(self) -> int:
        """Number of steps."""
        return len(self.positions)


def stretches(
    plan: Plan, structure: StructureBody, fleet: FleetBody | None, *, systems: bool = True
) -> Iterator[Stretch]:
    """The contact rows of a whole run, a stretch of steps at a time; with the contact systems, or without."""
    first, n_contact = 1, plan.rows.n_contact
    length = int(max(16, min(_STRETCH, _ENTRIES // max(n_contact**2, 1))))
    while first <= plan.settings.steps:
        last = min(first + length, plan.settings.steps + 1)
        yield _stretch(plan, np.arange(first, last), structure, fleet if systems else None)
        first = last


def _stretch(plan: Plan, steps: IntArray, structure: StructureBody, fleet: FleetBody | None) -> Stretch:
    """Rows and systems for consecutive time indices."""
    times = plan.times_of(steps)
    positions = plan.rows.positions(times)
    on = plan.rows.on_structure(positions)
    live = np.flatnonzero(on.any(axis=0))
    block = plan.rows.rows(positions[:, live], live)
    number = np.full(plan.rows.n_contact, -1, dtype=np.int64)
    number[plan.fleet.coupled] = np.arange(len(plan.fleet.coupled))
    into = number[live]
    live_coupled = np.flatnonzero(into >= 0)
    owner = plan.fleet.vehicle_of
    active = np.flatnonzero(np.isin(owner, np.unique(owner[into[live_coupled]])))
    local = structure.local[block.dofs]
    return Stretch(
        first=int(steps[0]),
        positions=positions,
        on=on,
        live=live,
        dofs=block.dofs,
        local=local,
        weights=block.weights,
        gap=_gap(plan, times, positions, block, live_coupled, into[live_coupled]),
        live_coupled=live_coupled,
        live_forced=np.flatnonzero(into < 0),
        into_coupled=into[live_coupled],
        active=active,
        systems=_systems(structure, fleet, local, block.weights, live_coupled, into, active),
    )


def _gap(
    plan: Plan,
    times: FloatArray,
    positions: FloatArray,
    block: RowBlock,
    live_coupled: IntArray,
    into: IntArray,
) -> FloatArray:
    """R + E_XP u_P (n_step, n_coupled) [m]."""
    gap = plan.rows.irregularity(positions)[:, plan.fleet.coupled]
    if len(plan.moving):
        motions = plan.crossing.structure.system.motions
        u_p = np.column_stack([motions[j].value(times) for j in plan.moving])
        moved = u_p[np.arange(len(times))[:, None, None], block.prescribed_dofs] * block.prescribed_weights
        gap[:, into] += moved.sum(axis=2)[:, live_coupled]
    return gap


def _systems(
    structure: StructureBody,
    fleet: FleetBody | None,
    local: IntArray,
    weights: FloatArray,
    live_coupled: IntArray,
    into: IntArray,
    active: IntArray,
) -> FloatArray:
    if fleet is None or not len(active):
        return np.zeros((len(local), 0, 0))
    own = fleet.compliance[np.ix_(active, active)]
    result = np.broadcast_to(own, (len(local), *own.shape)).copy()
    at = np.searchsorted(active, into[live_coupled])
    result[:, at[:, None], at] += path_compliance(
        structure.compliance, local[:, live_coupled], weights[:, live_coupled]
    )
    return result


def path_compliance(compliance: FloatArray, local: IntArray, weights: FloatArray) -> FloatArray:
    """E Z Eᵀ (n_step, n_wheel, n_wheel) for rows on the path and its compliance Z (n_path, n_path)."""
    n_step, n_wheel, n_local = local.shape
    flat, w = local.reshape(n_step, -1), weights.reshape(n_step, -1)
    result = np.empty((n_step, n_wheel, n_wheel))
    for k in range(n_step):
        block = compliance[flat[k][:, None], flat[k]]
        half = (block * w[k]).reshape(n_wheel * n_local, n_wheel, n_local).sum(axis=2)
        result[k] = (half * w[k][:, None]).reshape(n_wheel, n_local, n_wheel).sum(axis=1)
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
