r"""The interface of a step: forces p of wheels and nonlinear springs from the free coordinates d*.

.. math:: d = d^* - S p, \qquad p_i = F_i(d_i) \text{ or } d_i = 0 \text{ or } 0 \le p_i \perp d_i \le 0

S is symmetric and positive semidefinite. Newton's method with the exact tangent in the unknown p: rows of laws
read p - F(d) = 0, with the derivative 1 + F' S; rows of constraints d / S_ii = 0. For one-sided ones the sign
of p + d / S_ii says which holds, p = 0 or d = 0 (a semismooth Newton method, also known as the primal-dual
active set method).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import nnls

from axlespan.errors import AxlespanError

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

#: Forces (n,) from coordinates (n,), and their derivatives (n,), or (n, n) where rows depend on each other; rows of
#: constraints are not read.
Evaluate = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

# A Newton step below this share of the scale ends the iteration: the error is then about its square.
TOLERANCE = 1e-11
ROUNDING = 1e-14  # a residual below this share of it is zero
LIMIT, HALVINGS = 60, 8
# Of a search for where a potential is flat along a step: bisections, and the share of its first slope that is flat.
_BISECTIONS, _FLAT = 60, 0.02
_WELL = 0.25  # a step that leaves this share of the squared residual goes well, whatever a potential does


#: Forces, residual [N], Jacobian, and which rows touch.
Trial = tuple[FloatArray, FloatArray, FloatArray, Mask | None]


class NotConverged(AxlespanError, ArithmeticError):
    """Newton's method on the interface has not converged.

    Parameters
    ----------
    residuals : sequence of float
        Largest residual [N] before each iteration.
    row : int
        The row of the largest residual at last.
    """

    def __init__(self, residuals: list[float], row: int) -> None:
        self.residuals, self.row = residuals, row
        super().__init__(f"no convergence in {len(residuals)} iterations")


@dataclass(frozen=True, eq=False)
class Interface:
    """What the rows of an interface are."""

    rigid: Mask  # (n,) d = 0
    unilateral: Mask  # (n,) 0 <= p, d <= 0, p d = 0
    evaluate: Evaluate | None  # of the other rows; None: there are none
    scale: float  # a force to relate residuals to [N]


@dataclass(frozen=True, eq=False)
class Solution:
    """Forces and coordinates that satisfy all rows."""

    forces: FloatArray  # (n,) [N]
    coordinates: FloatArray  # (n,) [m]
    residuals: list[float]  # largest residual over the scale, before each iteration


def solve_interface(
    system: FloatArray, free: FloatArray, interface: Interface, guess: FloatArray
) -> Solution:
    """Forces (..., n) of all rows from S (..., n, n) and the free coordinates (..., n) [m].

    Leading indices count interfaces that do not feel each other; all are iterated until the last one is done.

    Raises
    ------
    NotConverged
        After 60 iterations, or three for each row: laws that jump change sides one by one.
    """
    newton = _Newton(system, free, interface)
    forces, residuals = guess.copy(), []
    residual, jacobian, held = newton.at(forces)
    before = residual
    for _ in range(max(LIMIT, 3 * free.shape[-1])):
        size = float(np.abs(residual).max(initial=0.0))
        residuals.append(size / interface.scale)
        if not np.isfinite(size):
            break
        if size <= ROUNDING * interface.scale:
            return Solution(forces, newton.coordinates(forces), residuals)
        try:
            step = np.asarray(np.linalg.solve(jacobian, residual[..., None])[..., 0], dtype=np.float64)
        except np.linalg.LinAlgError:  # laws that fall as fast as the bodies give way
            break
        before = residual
        forces, residual, jacobian, now = newton.advance(forces, step, residual)
        same = held is None or now is None or np.array_equal(held, now)
        held = now
        if same and float(np.abs(step).max(initial=0.0)) <= TOLERANCE * interface.scale:
            return Solution(forces, newton.coordinates(forces), residuals)
    if interface.evaluate is None and np.all(np.isfinite(free)):
        forces = _one_by_one(system, free, interface.unilateral)
        return Solution(forces, newton.coordinates(forces), residuals)
    told = residual if np.isfinite(residual).any() else before
    row = int(np.argmax(np.nan_to_num(np.abs(told), nan=np.inf)))
    raise NotConverged([value * interface.scale for value in residuals], row)


class _Newton:
    def __init__(self, system: FloatArray, free: FloatArray, interface: Interface) -> None:
        self.S, self.free, self.interface = system, free, interface
        self._at = np.arange(free.shape[-1])
        self.diagonal = np.maximum(system[..., self._at, self._at], 1e-300)
        self.constrained = interface.rigid | interface.unilateral
        self._any, self._all = bool(self.constrained.any()), bool(self.constrained.all())

    def coordinates(self, forces: FloatArray) -> FloatArray:
        """D = d* - S p."""
        return self.free - (self.S @ forces[..., None])[..., 0]

    def at(self, forces: FloatArray) -> tuple[FloatArray, FloatArray, Mask | None]:
        """Residual [N], Jacobian, and which rows touch."""
        face, d = self.interface, self.coordinates(forces)
        if face.evaluate is None:
            residual, jacobian = forces.copy(), np.zeros_like(self.S)
        else:
            given, slope = face.evaluate(d)
            residual = forces - given
            jacobian = slope @ self.S if slope.ndim > forces.ndim else slope[..., None] * self.S
        jacobian[..., self._at, self._at] += 1.0
        if not self._any:
            return residual, jacobian, None
        held = face.rigid | (face.unilateral & (forces + d / self.diagonal > 0.0))
        residual[held] = -(d / self.diagonal)[held]
        jacobian[held] = (self.S / self.diagonal[..., None])[held]
        loose = face.unilateral & ~held
        residual[loose] = forces[loose]
        jacobian[loose] = 0.0
        where = np.nonzero(loose)
        jacobian[(*where, where[-1])] = 1.0
        return residual, jacobian, held

    def advance(self, forces: FloatArray, step: FloatArray, residual: FloatArray) -> Trial:
        """Go a Newton step, or so much of it that a potential or the residual falls; all of it where no share does.

        Constraints alone ask for whole steps: that is the active set method.
        """
        whole = (forces - step, *self.at(forces - step))
        if self._all:
            return whole
        size, new = float(np.vdot(residual, residual)), float(np.vdot(whole[1], whole[1]))
        if new <= _WELL * size:
            return whole
        found = self._bracketed(forces, step, residual, whole) if forces.ndim == 1 else None
        if found is not None:
            return found
        if new <= (1.0 - 1e-4) * size:
            return whole
        share = 1.0
        for _ in range(HALVINGS):
            share *= 0.5
            tried = forces - share * step
            found = (tried, *self.at(tried))
            if float(np.vdot(found[1], found[1])) <= (1.0 - 1e-4 * share) * size:
                return found
        return whole

    def _bracketed(
        self, forces: FloatArray, step: FloatArray, residual: FloatArray, whole: Trial
    ) -> Trial | None:
        """So much of a Newton step that goes too far that a potential is flat along it; None if it does not.

        Laws that rise have one: its slope along the step is that of the residual with S times the step, over their
        rows. Constraints hold already, since they are linear.
        """
        push = np.where(self.constrained, 0.0, self.S @ step)
        begin, end = float(residual @ push), float(whole[1] @ push)
        if not (begin > 0.0 and end < -_FLAT * begin):
            return None
        low, high, found = 0.0, 1.0, whole
        for _ in range(_BISECTIONS):
            share = 0.5 * (low + high)
            tried = forces - share * step
            found = (tried, *self.at(tried))
            slope = float(found[1] @ push)
            if abs(slope) <= _FLAT * begin:
                break
            low, high = (share, high) if slope > 0.0 else (low, share)
        return found


def _one_by_one(system: FloatArray, free: FloatArray, unilateral: Mask) -> FloatArray:
    n = free.shape[-1]
    parts = zip(system.reshape(-1, n, n), free.reshape(-1, n), unilateral.reshape(-1, n), strict=True)
    return np.array([complementary(*part) for part in parts]).reshape(free.shape)


def complementary(
    system: FloatArray, free: FloatArray, unilateral: Mask, guess: FloatArray | None = None
) -> FloatArray:
    """Forces (n,) of constraints alone: d = d* - S p, with d = 0, or 0 <= p, d <= 0, p d = 0 where one-sided.

    The set of rows that touch is found by the active set iteration; should that go in circles, by
    non-negative least squares, which always ends: p minimizes ½ pᵀ S p - pᵀ d* over p >= 0.
    """
    n = len(free)
    if not n:
        return np.zeros(0)
    if not unilateral.any():
        return np.asarray(np.linalg.solve(system, free))
    touching = np.ones(n, dtype=bool)
    if guess is not None and guess.any():
        touching = ~unilateral | (guess > 0.0)
    diagonal = np.maximum(system.diagonal(), 1e-300)
    for _ in range(max(12, n)):
        forces = np.zeros(n)
        rows = np.flatnonzero(touching)
        if len(rows):
            forces[rows] = np.linalg.solve(system[np.ix_(rows, rows)], free[rows])
        gap = free - system @ forces
        gap[rows] = 0.0
        now = ~unilateral | (forces + gap / diagonal > 0.0)
        if np.array_equal(now, touching):
            return forces
        touching = now
    return _by_least_squares(system, free, unilateral)


def _by_least_squares(system: FloatArray, free: FloatArray, unilateral: Mask) -> FloatArray:
    """The same by non-negative least squares; rows that are held both ways are eliminated first."""
    one, both = np.flatnonzero(unilateral), np.flatnonzero(~unilateral)
    inner = system[np.ix_(both, both)]
    coupling = np.linalg.solve(inner, system[np.ix_(both, one)]) if len(both) else np.zeros((0, len(one)))
    reduced = system[np.ix_(one, one)] - system[np.ix_(one, both)] @ coupling
    right = free[one] - coupling.T @ free[both]
    factor = cholesky(0.5 * (reduced + reduced.T), lower=True)
    found, _ = nnls(factor.T, solve_triangular(factor, right, lower=True))
    forces = np.zeros(len(free))
    forces[one] = found
    if len(both):
        forces[both] = np.linalg.solve(inner, free[both] - system[np.ix_(both, one)] @ found)
    return forces
