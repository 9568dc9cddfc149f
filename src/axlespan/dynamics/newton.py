r"""One body with nonlinear elements in time: N12 (1) in incremental form, solved by Newton's method.

With inner forces N(u, u̇) beside C u̇ + K u, the residual of a step of the alpha method is

.. math:: R = (1+α) f^c - α f^p - M \ddot u^c, \qquad f = F - C \dot u - K u - N(u, \dot u)

in the unknown ü^c (N12 (16), (17)), with the tangent A + (1+α) (γ Δt C_t + β Δt² K_t) of the elements' tangents C_t and
K_t. A step that does not converge is made in two halves, and those again; factors of A are kept for every length of
step. For contact and for single springs the interface solver of the direct method is far cheaper; this is for elements
of any kind, on any d.o.f., under given forces.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.integrator import Integrator, Matrices, State
from axlespan.errors import AnalysisError
from axlespan.linalg.factor import Factor, NotPositiveDefinite

FloatArray = npt.NDArray[np.float64]

_HALVINGS = 8  # of a Newton step, in the line search
_FEW, _SLOW = 4, 0.25  # a kept factor serves while each iteration leaves at most this share of the residual


class Element(Protocol):
    """A nonlinear element: inner forces of the whole body from its motion; ``state`` is what it remembers."""

    def force(self, u: FloatArray, v: FloatArray, state: Any) -> FloatArray:
        """Inner forces (n,) [N]."""
        ...

    def tangent(self, u: FloatArray, v: FloatArray, state: Any) -> tuple[sp.csr_array, sp.csr_array]:
        """Symmetric derivatives (n, n) of the forces to u [N/m] and to u̇ [N s/m]."""
        ...

    def advanced(self, u: FloatArray, v: FloatArray, state: Any) -> Any:
        """What it remembers once a step is done."""
        ...


@dataclass(frozen=True)
class StepFigures:
    """How a step converged."""

    iterations: int  # of all its parts
    parts: int  # 1: in one piece
    factorizations: int
    residuals: tuple[float, ...]  # of the last part, relative, before each iteration


@dataclass(frozen=True, eq=False)
class March:
    """States over time, and how each step converged."""

    time: FloatArray  # (n_step + 1,) [s]
    displacement: FloatArray  # (n_step + 1, n) [m]
    velocity: FloatArray  # (n_step + 1, n) [m/s]
    acceleration: FloatArray  # (n_step + 1, n) [m/s^2]
    figures: tuple[StepFigures, ...]  # (n_step,)
    memory: tuple[Any, ...]  # of each element, at the end


class _Diverged(Exception):
    """A part of a step has not converged."""

    def __init__(self, worst: int, residual: float, iterations: int) -> None:
        self.worst, self.residual, self.iterations = worst, residual, iterations


class NewtonIntegrator:
    """The alpha method for a body with nonlinear elements.

    Parameters
    ----------
    matrices : Matrices
        The linear part over n free d.o.f.
    elements : sequence of Element
        Their forces add to those of the linear part.
    method : Alpha
        Parameters.
    time_step : float
        Δt [s].
    tolerance : float
        Residual over the largest force at which a step has converged [-].
    limit : int
        Iterations of a part of a step.
    cuts : int
        How often a step may be halved.
    dof_names : sequence of str, optional
        For messages.
    """

    def __init__(
        self,
        matrices: Matrices,
        elements: Sequence[Element],
        method: Alpha,
        time_step: float,
        *,
        tolerance: float = 1e-10,
        limit: int = 25,
        cuts: int = 6,
        dof_names: Sequence[str] | None = None,
    ) -> None:
        self.matrices, self.elements, self.method, self.time_step = (
            matrices,
            tuple(elements),
            method,
            time_step,
        )
        self.tolerance, self.limit, self.cuts = tolerance, limit, cuts
        self._names = dof_names
        self._linear: dict[int, Integrator] = {}  # by how often the step is halved
        self._kept: dict[int, Factor] = {}

    def march(
        self,
        state: State,
        force: Callable[[float], FloatArray],
        steps: int,
        memory: Sequence[Any] | None = None,
    ) -> March:
        """Advance from a state under forces (n,) [N] that are a function of time [s].

        Raises
        ------
        AnalysisError
            If a step does not converge, halved as often as allowed: with the step, the worst d.o.f. and a remedy;
            ``error.result`` is the March until then.
        """
        own = list(memory) if memory is not None else [None] * len(self.elements)
        states = [state.copy()]
        figures: list[StepFigures] = []
        for step in range(steps):
            begin = step * self.time_step
            try:
                new, own, counts = self._made(states[-1], force, begin, own, 0)
            except _Diverged as error:
                raise AnalysisError(
                    self._message(step + 1, error), self._result(states, figures, own)
                ) from error
            states.append(new)
            figures.append(counts)
        return self._result(states, figures, own)

    def _made(
        self, state: State, force: Callable[[float], FloatArray], begin: float, memory: list[Any], depth: int
    ) -> tuple[State, list[Any], StepFigures]:
        """One step of length Δt / 2^depth, in halves where it does not converge in one piece."""
        length = self.time_step / 2**depth
        try:
            return self._part(state, force(begin), force(begin + length), memory, depth)
        except _Diverged as error:
            if depth >= self.cuts:
                raise
            lost = error.iterations
        first, memory, one = self._made(state, force, begin, memory, depth + 1)
        second, memory, two = self._made(first, force, begin + 0.5 * length, memory, depth + 1)
        figures = StepFigures(
            lost + one.iterations + two.iterations,
            one.parts + two.parts,
            one.factorizations + two.factorizations,
            two.residuals,
        )
        return second, memory, figures

    def _part(
        self, state: State, force_p: FloatArray, force_c: FloatArray, memory: list[Any], depth: int
    ) -> tuple[State, list[Any], StepFigures]:
        """One part of a step by Newton's method with line search; the factor is renewed when it gets slow."""
        linear = self._integrator(depth)
        rows = linear.prediction @ state.values
        rest = force_p - self._inner(state.u, state.v, memory)
        known = linear.weight_c * force_c + linear.weight_p * rest

        def at(a: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
            u, v = rows[0] + linear.u_from_a * a, rows[1] + linear.v_from_a * a
            return known - linear.weight_c * self._inner(u, v, memory) - self.matrices.M @ a, u, v

        a = state.a.copy()
        residual, u, v = at(a)
        scale = max(float(np.abs(known).max()), float(np.abs(self.matrices.M @ a).max()), 1e-30)
        residuals, renewed = [], 0
        for iteration in range(self.limit):
            size = float(np.abs(residual).max()) / scale
            residuals.append(size)
            if not np.isfinite(size):
                break
            if size <= self.tolerance:
                memory = [e.advanced(u, v, own) for e, own in zip(self.elements, memory, strict=True)]
                return State.of(u, v, a), memory, StepFigures(iteration, 1, renewed, tuple(residuals))
            slow = iteration >= 1 and size > _SLOW * residuals[-2]
            if depth not in self._kept or slow or iteration >= _FEW:
                try:
                    self._kept[depth] = self._factor(linear, u, v, memory)
                except NotPositiveDefinite:
                    break
                renewed += 1
            change = self._kept[depth].solve(residual.copy())
            a, residual, u, v = self._searched(a, change, residual, at)
            scale = max(scale, float(np.abs(self.matrices.M @ a).max()))
        worst = int(np.argmax(np.nan_to_num(np.abs(residual), nan=np.inf)))
        self._kept.pop(depth, None)
        raise _Diverged(worst, residuals[-1], len(residuals))

    @staticmethod
    def _searched(
        a: FloatArray,
        change: FloatArray,
        residual: FloatArray,
        at: Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]],
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """So much of a Newton step that the residual falls; all of it where no share does."""
        size, share = float(np.linalg.norm(residual)), 1.0
        whole = (a + change, *at(a + change))
        found = whole
        for _ in range(_HALVINGS):
            if float(np.linalg.norm(found[1])) <= (1.0 - 1e-4 * share) * size:
                return found
            share *= 0.5
            found = (a + share * change, *at(a + share * change))
        return whole

    def _inner(self, u: FloatArray, v: FloatArray, memory: Sequence[Any]) -> FloatArray:
        """C u̇ + K u + N."""
        result = np.asarray(self.matrices.K @ u) + self.matrices.damping_force(v)
        for element, own in zip(self.elements, memory, strict=True):
            result += element.force(u, v, own)
        return result

    def _integrator(self, depth: int) -> Integrator:
        if depth not in self._linear:
            self._linear[depth] = Integrator(self.matrices, self.method, self.time_step / 2**depth)
        return self._linear[depth]

    def _factor(self, linear: Integrator, u: FloatArray, v: FloatArray, memory: Sequence[Any]) -> Factor:
        tangent = linear.effective
        for element, own in zip(self.elements, memory, strict=True):
            k, c = element.tangent(u, v, own)
            tangent = tangent + linear.weight_c * (linear.u_from_a * k + linear.v_from_a * c)
        return linear.factor_of(sp.csr_array(tangent))

    def _result(self, states: list[State], figures: list[StepFigures], memory: list[Any]) -> March:
        values = np.array([state.values for state in states])
        time = np.asarray(np.arange(len(states)) * self.time_step, dtype=np.float64)
        return March(time, values[:, 0], values[:, 1], values[:, 2], tuple(figures), tuple(memory))

    def _message(self, step: int, error: _Diverged) -> str:
        name = self._names[error.worst] if self._names else f"number {error.worst}"
        return (
            f"step {step}, t = {step * self.time_step:.6g} s: Newton's method did not converge in {self.limit} iterations, "
            f"with the step halved {self.cuts} times (relative residual {error.residual:.3g}, worst at d.o.f. {name}). Use a "
            "smaller time step, more cuts, or check the element's tangent"
        )
