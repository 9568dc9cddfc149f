"""A start of one crossing while it is worked out: who loads the structure, and the vehicles as the line has them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.interaction.plan import Plan
from axlespan.interaction.start_rows import MomentRows, entering_wheels
from axlespan.interaction.start_vehicles import Group, Vehicles

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(eq=False)
class Draft:
    """A start that is being worked out."""

    plan: Plan
    rows: MomentRows
    groups: list[Group]
    entering: npt.NDArray[np.bool_]  # (n_on,) wheels that the structure feels before they are on it
    structure: State
    vehicles: State
    forces: FloatArray  # (n_contact,) [N]

    @classmethod
    def of(cls, plan: Plan, kinds: Vehicles) -> Draft:
        """All at rest under the static contact forces."""
        rows, fleet = MomentRows.at(plan), plan.fleet
        early = entering_wheels(plan, rows)
        still = State.at_rest((plan.structure.size,)), State.at_rest((fleet.matrices.size,))
        return cls(plan, rows, kinds.groups(fleet), early, *still, fleet.weight.copy())

    @cached_property
    def coupled_place(self) -> IntArray:
        """Place of each contact (n_contact,) among the coupled ones; -1 for moving forces."""
        place = np.full(len(self.forces), -1, dtype=np.int64)
        place[self.plan.fleet.coupled] = np.arange(len(self.plan.fleet.coupled))
        return place

    @cached_property
    def loading(self) -> IntArray:
        """Wheels on the structure that load it, among those on it."""
        return np.flatnonzero(self.rows.carried)

    def touching(self) -> list[tuple[Group, IntArray, IntArray]]:
        """Groups with their vehicles that load the structure, and with the others."""
        loads = np.zeros(len(self.plan.fleet.coupled), dtype=bool)
        place = self.coupled_place[self.rows.on[self.loading]]
        loads[place[place >= 0]] = True
        touch = [loads[group.contacts].any(axis=1) for group in self.groups]
        return [(g, np.flatnonzero(t), np.flatnonzero(~t)) for g, t in zip(self.groups, touch, strict=True)]

    def blocks(self, matrices: Mapping[int, FloatArray]) -> tuple[IntArray, FloatArray]:
        """Coupled contacts (m,) of vehicles that load the structure, and a block (c, c) for each on the diagonal."""
        wheels = [group.contacts[some] for group, some, _ in self.touching()]
        chosen = np.concatenate([np.empty(0, dtype=np.int64), *(w.ravel() for w in wheels)])
        result, at = np.zeros((len(chosen), len(chosen))), 0
        for number, own in enumerate(wheels):
            c = own.shape[1]
            for _ in range(len(own)):
                result[at : at + c, at : at + c] = matrices[number]
                at += c
        return chosen, result

    def follow_the_line(self) -> None:
        """Set displacements and velocities of the vehicles to those of the line under their wheels."""
        fleet, rows, u, v = self.plan.fleet, self.rows, self.structure.u, self.structure.v
        x = fleet.coupled
        if not len(x):
            return
        height, rate = rows.height.copy(), rows.rate.copy()
        if len(rows.on):
            height[rows.on] += rows.read(u)
            rate[rows.on] += rows.speed[rows.on] * rows.read(u, 1) + rows.read(v)
        self.vehicles.v[fleet.dofs] = rate[x]
        if np.any(height[x]):
            level, values = height[x], self.vehicles.u
            values[fleet.dofs] = level
            for group in self.groups:
                values[group.dofs[:, group.kind.rest]] = level[group.contacts] @ group.kind.follow.T
