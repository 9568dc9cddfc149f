r"""One body in time: M ü + C u̇ + K u = f by the alpha method, with accelerations as unknowns.

With the predictors ũ = u + Δt u̇ + (½ - β) Δt² ü and ṽ = u̇ + (1 - γ) Δt ü of the step before,
u^c = ũ + β Δt² ü^c and u̇^c = ṽ + γ Δt ü^c (N12 (16), (17)) turn N12 (1) into

.. math:: A ü^c = (1+α) F^c - α F^p - C [(1+α) ṽ - α u̇^p] - K [(1+α) ũ - α u^p], \qquad
          A = M + (1+α) γ Δt C + (1+α) β Δt² K

A is N12's K̄ (22) times β Δt²: the same method in another unknown. It needs no product with M, keeps the
accelerations free of the cancellation in N12 (18), and costs one product with K (and one with C, if
there is any) for every α.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.alpha import Alpha
from axlespan.linalg.factor import Factor, factorize
from axlespan.linalg.low_rank import LowRank, UpdatedFactor

FloatArray = npt.NDArray[np.float64]

# Below this size a dense product is quicker than a sparse one.
_DENSE_UP_TO = 200


@dataclass
class State:
    """Displacements, velocities and accelerations (n,) or (n, k) at one time."""

    u: FloatArray  # [m]
    v: FloatArray  # [m/s]
    a: FloatArray  # [m/s^2]

    @classmethod
    def at_rest(cls, shape: tuple[int, ...]) -> State:
        """All zero."""
        return cls(np.zeros(shape), np.zeros(shape), np.zeros(shape))

    def copy(self) -> State:
        """An independent copy."""
        return State(self.u.copy(), self.v.copy(), self.a.copy())


@dataclass(frozen=True, eq=False)
class Matrices:
    """Stiffness, mass and damping over the free d.o.f.; damping may have a low-rank part."""

    K: sp.csr_array  # (n, n)
    M: sp.csr_array  # (n, n)
    C: sp.csr_array | None = None  # None: no damping
    C_low_rank: LowRank | None = None

    @property
    def size(self) -> int:
        """Number of d.o.f."""
        return int(self.K.shape[0])

    def damping_force(self, velocity: FloatArray) -> FloatArray:
        """C u̇ [N] for velocities (n,) or (n, k)."""
        force = np.zeros_like(velocity) if self.C is None else np.asarray(self.C @ velocity)
        if self.C_low_rank is not None:
            force = force + self.C_low_rank.apply(velocity)
        return force


class Integrator:
    """The alpha method for one body and one time step; the factor of A is held here.

    Parameters
    ----------
    matrices : Matrices
        Over the n free d.o.f.
    method : Alpha
        Parameters.
    time_step : float
        Δt [s].
    solver : str
        Kind of factor, see :func:`axlespan.linalg.factor.factorize`.

    Notes
    -----
    A step is :meth:`step`, or in two halves :meth:`predict` and :meth:`correct` with contact forces
    solved for in between.
    """

    def __init__(self, matrices: Matrices, method: Alpha, time_step: float, *, solver: str = "auto") -> None:
        self.matrices, self.method, self.time_step = matrices, method, float(time_step)
        beta, gamma, dt = method._beta, method._gamma, self.time_step
        self.weight_c, self.weight_p = 1.0 + method.alpha, -method.alpha
        self.u_from_a, self.v_from_a = beta * dt**2, gamma * dt
        self._u_old, self._v_old = (0.5 - beta) * dt**2, (1.0 - gamma) * dt
        self.effective = self._effective_matrix()
        self.factor = self.factor_of(self.effective, solver)
        self._K = _operand(matrices.K)
        self._C = None if matrices.C is None else _operand(matrices.C)

    @property
    def size(self) -> int:
        """Number of d.o.f."""
        return self.matrices.size

    def _effective_matrix(self) -> sp.csr_array:
        m = self.matrices
        effective = m.M + (self.weight_c * self.u_from_a) * m.K
        if m.C is not None:
            effective = effective + (self.weight_c * self.v_from_a) * m.C
        return sp.csr_array(effective)

    def factor_of(self, effective: sp.csr_array, solver: str = "auto") -> Factor:
        """Factor of an effective matrix (n, n), the low-rank damping included."""
        factor = factorize(effective, kind=solver)
        low_rank = self.matrices.C_low_rank
        if low_rank is None:
            return factor
        scaled = LowRank(low_rank.vectors, self.weight_c * self.v_from_a * low_rank.coefficients)
        return UpdatedFactor(factor, scaled)

    def predict(self, state: State, force: FloatArray) -> None:
        """Advance the state in place as if the force were all.

        Parameters
        ----------
        state : State
            At the step before; on return, at the new time.
        force : array
            (1+α) F^c - α F^p, of the shape of the state. It is overwritten.
        """
        dt, wc, wp = self.time_step, self.weight_c, self.weight_p
        u, v, a = state.u, state.v, state.a
        if self._C is not None or self.matrices.C_low_rank is not None:
            velocity = wp * v
            v += self._v_old * a
            velocity += wc * v
            if self._C is not None:
                force -= self._C @ velocity
            if self.matrices.C_low_rank is not None:
                force -= self.matrices.C_low_rank.apply(velocity)
            drift = dt * (v - self._v_old * a)
        else:
            drift = dt * v
            v += self._v_old * a
        drift += self._u_old * a
        if wp:
            displacement = wc * drift
            displacement += u  # (1+α) ũ - α u = u + (1+α) drift
            force -= self._K @ displacement
            u += drift
        else:
            u += drift
            force -= self._K @ u
        self.factor.solve(force, out=a)
        u += self.u_from_a * a
        v += self.v_from_a * a

    def correct(self, state: State, acceleration: FloatArray) -> None:
        """Add an acceleration (that of the contact forces) to the state at the new time, in place."""
        state.a += acceleration
        state.u += self.u_from_a * acceleration
        state.v += self.v_from_a * acceleration

    def step(self, state: State, force_previous: FloatArray, force_current: FloatArray) -> State:
        """The state one time step later, under forces (n,) at both ends of the step [N].

        Examples
        --------
        >>> import scipy.sparse as sp
        >>> one = sp.csr_array([[1.0]])
        >>> body = Integrator(Matrices(K=4.0 * one, M=one), Alpha(0.0), time_step=0.01)
        >>> later = body.step(State.at_rest((1,)), np.zeros(1), np.ones(1))
        >>> float(later.a[0])  # 1 / (1 + 4 β Δt²)
        0.9999000099990001
        """
        new = state.copy()
        self.predict(new, self.weight_c * force_current + self.weight_p * force_previous)
        return new

    def columns(self, loads: FloatArray) -> FloatArray:
        """A⁻¹ loads for loads (n, m), a few columns at a time."""
        result = np.empty(loads.shape)
        for begin in range(0, loads.shape[1], 64):
            block = np.ascontiguousarray(loads[:, begin : begin + 64])
            result[:, begin : begin + 64] = self.factor.solve(block)
        return result


def _operand(matrix: sp.csr_array) -> FloatArray | sp.csr_array:
    return np.ascontiguousarray(matrix.toarray()) if matrix.shape[0] <= _DENSE_UP_TO else matrix
