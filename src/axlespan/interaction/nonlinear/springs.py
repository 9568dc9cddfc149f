r"""The nonlinear springs of a structure as unknowns of a step: their deviations from the reference stiffness.

A spring of the law f(e, ė) has the reference stiffness k and damping c in the matrices of the structure. Displacements count from
the state under the structure's own weight, where its elongation is e_0, so that

.. math:: q(e, \dot e) = f(e_0 + e, \dot e) - f(e_0, 0) - k e - c \dot e

is what the matrices leave out. A ballast spring that stays in compression has q = 0, and only those with q ≠ 0 are
unknowns of a step.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.compiled import Loop, numba_is_there
from axlespan.errors import InputError
from axlespan.interaction.nonlinear.law_codes import CodedSprings
from axlespan.interaction.nonlinear.static_columns import StaticColumns
from axlespan.interaction.plan import Plan
from axlespan.linalg.factor import Factor
from axlespan.model.motions import Constant
from axlespan.model.nonlinear_elements import ElementLaw
from axlespan.model.system import SpringRows, System

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_LIMIT, _TOLERANCE, _HALVINGS = 200, 1e-12, 12


@dataclass(eq=False)
class Springs:
    """All nonlinear springs of a system, with what they remember.

    ``base`` and ``state`` are those under the structure's own weight until a run goes on from there.
    """

    groups: tuple[SpringRows, ...]
    rows: sp.csr_array  # (n_spring, n_free)
    ground: sp.csr_array  # (n_spring, n_prescribed)
    base: FloatArray  # e_0 (n_spring,) [m], gaps included
    state: list[Any]  # of each group (n, n_state); of an element, what it remembers

    @classmethod
    def of(cls, system: System) -> Springs:
        """Those of a system, unloaded.

        Raises
        ------
        InputError
            If one stands on a support that moves.
        """
        groups = system.nonlinear
        stacked = sp.csr_array(sp.vstack([sp.csr_array((0, system.size)), *(group.rows for group in groups)]))
        rows, ground = stacked[:, system.free], stacked[:, system.prescribed]
        moves = [not (isinstance(m, Constant) and m.amount == 0.0) for m in system.motions]
        if groups and np.any(abs(ground).sum(axis=0)[np.array(moves, dtype=bool)] > 0.0):
            raise InputError("must not stand on supports that move", field="nonlinear springs")
        base = np.concatenate([group.gap for group in groups]) if groups else np.zeros(0)
        state = [_unused(group) for group in groups]
        return cls(groups, sp.csr_array(rows), sp.csr_array(ground), base, state)

    @classmethod
    def of_fleet(cls, plan: Plan) -> Springs:
        """Those of all vehicles; elongations count from the static position on level ground."""
        groups: list[SpringRows] = []
        size, begin, number = plan.fleet.matrices.size, 0, 0
        for item in plan.crossing.placements:
            number += 1
            system = item.vehicle.system
            if system is None:
                continue
            n_own = len(system.free)
            for group in system.nonlinear:
                own = sp.csr_array(group.rows[:, system.free])
                n = own.shape[0]
                wide = sp.csr_array(
                    sp.hstack([sp.csr_array((n, begin)), own, sp.csr_array((n, size - begin - n_own))])
                )
                groups.append(replace(group, rows=wide, name=f"{number}.{group.name}"))
            begin += n_own
        rows = sp.csr_array(sp.vstack([sp.csr_array((0, size)), *(group.rows for group in groups)]))
        base = np.concatenate([np.zeros(0), *(group.gap for group in groups)])
        state = [_unused(group) for group in groups]
        return cls(tuple(groups), rows, sp.csr_array((rows.shape[0], 0)), base, state)

    def with_fleet(self, others: Springs) -> Springs:
        """These springs and those of vehicles as one list, for what their laws say."""
        groups = (*self.groups, *others.groups)
        joined = Springs(
            groups,
            sp.csr_array(sp.block_diag([self.rows, others.rows], format="csr")),
            self.ground,
            np.concatenate([self.base, others.base]),
            [*self.state, *others.state],
        )
        joined.held = np.concatenate([self.held, others.held])  # what they were before the start
        return joined

    @property
    def n(self) -> int:
        """Number of springs."""
        return len(self.base)

    @cached_property
    def stiffness(self) -> FloatArray:
        """Reference stiffness (n,) [N/m]."""
        return np.concatenate(
            [np.broadcast_to(g.stiffness, g.gap.shape) for g in self.groups] or [np.zeros(0)]
        )

    @cached_property
    def damping(self) -> FloatArray:
        """Reference damping (n,) [N s/m]."""
        parts = [np.broadcast_to(g.damping, g.gap.shape) for g in self.groups]
        return np.concatenate(parts or [np.zeros(0)])

    @cached_property
    def names(self) -> tuple[str, ...]:
        """``name.number`` of each spring."""
        return tuple(f"{g.name}.{i + 1}" for g in self.groups for i in range(len(g.gap)))

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """Where each group stands among all springs."""
        ends = np.cumsum([len(group.gap) for group in self.groups]).tolist()
        return tuple(slice(end - len(g.gap), end) for end, g in zip(ends, self.groups, strict=True))

    @cached_property
    def held(self) -> FloatArray:
        """f(e_0, 0) (n,) [N]: the forces under the structure's own weight."""
        return self._forces(np.zeros(self.n), np.zeros(self.n))

    def _forces(self, e: FloatArray, rate: FloatArray) -> FloatArray:
        result, total = np.empty(self.n), self.base + e
        for group, state, at in zip(self.groups, self.state, self.slices, strict=True):
            result[at] = group.law.force(total[at], rate[at], state)
        return result

    def forces(self, e: FloatArray, rate: FloatArray) -> FloatArray:
        """Total forces (n,) [N], own weight included."""
        return self._forces(e, rate)

    @cached_property
    def _coded(self) -> CodedSprings | None:
        """The laws as numbers, where all can be and loops are compiled."""
        return CodedSprings.of(self) if numba_is_there() else None

    def deviation(self, e: FloatArray, rate: FloatArray) -> FloatArray:
        """Q (n,) [N]; exactly zero, without the rounding, where the law follows its reference."""
        if self._coded is not None:
            q: FloatArray = _evaluated(self._coded, np.arange(self.n), e, rate)[0]
            return q
        result = self._forces(e, rate) - self.held
        linear, damped = self.stiffness * e, self.damping * rate
        result -= linear + damped
        size = np.abs(linear) + np.abs(damped) + np.abs(self.held)
        result[np.abs(result) <= 1e-14 * size] = 0.0
        return result

    def tangent(self, e: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives (n,) of the deviation to elongation and rate."""
        k, c, total = np.empty(self.n), np.empty(self.n), self.base + e
        for group, state, at in zip(self.groups, self.state, self.slices, strict=True):
            k[at], c[at] = group.law.tangent(total[at], rate[at], state)
        return k - self.stiffness, c - self.damping

    def linearized(
        self, chosen: IntArray, e: FloatArray, rate: FloatArray, per_rate: float
    ) -> tuple[FloatArray, FloatArray]:
        """Q (m,) of some springs and its derivative, (m,), or (m, m) where there are elements; all of these are chosen.

        ``per_rate`` is the derivative of rates to elongations.
        """
        if self._coded is not None:
            q, k, c = _evaluated(self._coded, chosen, e, rate)
            return q, k + per_rate * c
        all_e, all_rates = np.zeros(self.n), np.zeros(self.n)
        all_e[chosen], all_rates[chosen] = e, rate
        k, c = self.tangent(all_e, all_rates)
        slope = self.with_blocks(k + per_rate * c, all_e, all_rates, per_rate)
        slope = slope[chosen] if slope.ndim == 1 else slope[np.ix_(chosen, chosen)]
        return self.deviation(all_e, all_rates)[chosen], slope

    def static_deviation(self, e: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Q and its derivative at rest, (n,) or (n, n) where there are elements."""
        still = np.zeros(self.n)
        k, _ = self.tangent(e, still)
        return self.deviation(e, still), self.with_blocks(k, e, still, 0.0)

    @cached_property
    def coupled(self) -> IntArray:
        """Springs that are d.o.f. of elements: what one of them does depends on the others."""
        pairs = zip(self.groups, self.slices, strict=True)
        parts = [np.arange(at.start, at.stop) for group, at in pairs if isinstance(group.law, ElementLaw)]
        return np.concatenate([np.zeros(0, dtype=np.int64), *parts]).astype(np.int64)

    def with_blocks(
        self, diagonal: FloatArray, e: FloatArray, rate: FloatArray, per_rate: float
    ) -> FloatArray:
        """Slopes (n,) as they are, or as a matrix (n, n) with the tangents of elements, where there are any."""
        if not len(self.coupled):
            return diagonal
        result, total = np.diag(diagonal), self.base + e
        for group, state, at in zip(self.groups, self.state, self.slices, strict=True):
            if isinstance(group.law, ElementLaw):
                k, c = group.law.blocks(total[at], rate[at], state)
                result[at, at] = k + per_rate * c
        return result

    def energy(self, e: FloatArray) -> FloatArray:
        """Energy (n,) [J] of the springs."""
        result, total = np.empty(self.n), self.base + e
        for group, state, at in zip(self.groups, self.state, self.slices, strict=True):
            result[at] = group.law.energy(total[at], state)
        return result

    def advance(self, e: FloatArray, rate: FloatArray) -> None:
        """Remember a completed step."""
        total = self.base + e
        self.state = [
            group.law.advanced(total[at], rate[at], state) if group.law.n_state else state
            for group, state, at in zip(self.groups, self.state, self.slices, strict=True)
        ]

    def begin(self, e: FloatArray) -> None:
        """Remember the static state at the start."""
        self.held  # noqa: B018  # before the memory goes on
        self.advance(e, np.zeros(self.n))

    def preloaded(self, weight: FloatArray, stiffness: Factor) -> Springs:
        """The springs under the structure's own weight: nodal loads (n_free,) [N] and the factor of K.

        Raises
        ------
        InputError
            If no equilibrium is found.
        """
        if not self.n:
            return self
        free = np.asarray(self.rows @ stiffness.solve(np.array(weight)))
        e = self._rest(free, StaticColumns(self.rows, stiffness))
        before = Springs(self.groups, self.rows, self.ground, self.base.copy(), list(self.state))
        before.advance(e, np.zeros(self.n))
        return Springs(self.groups, self.rows, self.ground, self.base + e, before.state)

    def _rest(self, free: FloatArray, columns: StaticColumns) -> FloatArray:
        """Elongations (n,) of rest: e = e* - Z q(e), by Newton's method with line search; unknown are springs with q ≠ 0."""
        still, start = np.zeros(self.n), self.held + 0.0

        def residual(q: FloatArray) -> tuple[FloatArray, FloatArray]:
            e = free - self.rows @ columns.deflection(q)
            rest = q - (self.deviation(e, still) + start)
            return rest, e

        q = np.zeros(self.n)
        rest, e = residual(q)
        scale = max(float(np.abs(self.stiffness * free).max()), float(np.abs(rest).max()), 1.0)
        for _ in range(_LIMIT):
            slope = self.static_deviation(e)[1]
            varies = slope != 0.0 if slope.ndim == 1 else np.any(slope != 0.0, axis=1)
            columns.take_in(np.setdiff1d(np.flatnonzero((rest != 0.0) | varies), columns.chosen))
            if float(np.abs(rest).max()) <= _TOLERANCE * scale:
                return e
            a = columns.chosen
            jacobian = slope_times(
                slope[a] if slope.ndim == 1 else slope[np.ix_(a, a)], columns.compliance(a)
            )
            jacobian[np.diag_indices_from(jacobian)] += 1.0
            step = np.zeros(self.n)
            step[a] = np.linalg.solve(jacobian, rest[a])
            share = 1.0
            for _ in range(_HALVINGS):
                new, at = residual(q - share * step)
                if float(new @ new) < float(rest @ rest):
                    break
                share *= 0.5
            else:
                new, at = residual(q - step)
                share = 1.0
            q, rest, e = q - share * step, new, at
        worst = self.names[int(np.argmax(np.abs(rest)))]
        raise InputError(
            "finds no equilibrium under its own weight",
            field="structure",
            value=f"spring {worst}",
            fix="Check gaps and laws: is the structure held when springs part?",
        )


@cache
def _deviations() -> Loop:
    from axlespan.interaction.nonlinear.interface_kernel import deviations  # numba is an optional part

    return deviations


def _evaluated(coded: CodedSprings, chosen: IntArray, e: FloatArray, rate: FloatArray) -> FloatArray:
    """Deviations of some springs and their derivatives to elongation and rate (3, m)."""
    result = np.empty((3, len(chosen)))
    _deviations()(chosen, 0, len(chosen), e, rate, (coded.kinds, coded.numbers, coded.points), *result)
    return result


def slope_times(slope: FloatArray, matrix: FloatArray) -> FloatArray:
    """The product of slopes, (n,) of a diagonal or (n, n), and a matrix (n, m)."""
    return np.asarray(slope[:, None] * matrix if slope.ndim == 1 else slope @ matrix)


def _unused(group: SpringRows) -> Any:
    """What springs of a group remember before the first step."""
    if isinstance(group.law, ElementLaw):
        return None
    return np.zeros((len(group.gap), group.law.n_state))
