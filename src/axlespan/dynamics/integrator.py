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
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.compiled import Loop
from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.step_kernel import compiled_completion, compiled_reading, compiled_right_side
from axlespan.linalg.factor import Factor, factorize
from axlespan.linalg.low_rank import LowRank, UpdatedFactor
from axlespan.linalg.products import Parts, half_of, whole_of

FloatArray = npt.NDArray[np.float64]

# Below this size a dense product is quicker than a sparse one.
_DENSE_UP_TO = 200

# Memory [byte] of the right-hand sides that are solved for together.
_AT_ONCE = 40e6


@dataclass(eq=False)
class State:
    """Displacements, velocities and accelerations at one time, stacked so that one product advances all three."""

    values: FloatArray  # (3, n) or (3, n, k): [m, m/s, m/s^2]

    @classmethod
    def at_rest(cls, shape: tuple[int, ...]) -> State:
        """All zero, for d.o.f. of shape (n,) or (n, k)."""
        return cls(np.zeros((3, *shape)))

    @classmethod
    def of(cls, u: FloatArray, v: FloatArray, a: FloatArray) -> State:
        """From displacements, velocities and accelerations of equal shapes."""
        return cls(np.array([u, v, a], dtype=np.float64))

    @property
    def u(self) -> FloatArray:
        """Displacements [m], a view."""
        view: FloatArray = self.values[0]
        return view

    @property
    def v(self) -> FloatArray:
        """Velocities [m/s], a view."""
        view: FloatArray = self.values[1]
        return view

    @property
    def a(self) -> FloatArray:
        """Accelerations [m/s^2], a view."""
        view: FloatArray = self.values[2]
        return view

    def copy(self) -> State:
        """An independent copy."""
        return State(self.values.copy())


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
    """The alpha method for one body and one time step: its coefficients, matrices and the factor of A.

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
    threads : int
        Threads of a solve, where the factor can use them.
    columns : int
        States that will advance side by side, for the choice of a factor.

    Notes
    -----
    The integrator does not change; what evolves is a :class:`State`. A step is :meth:`step`, or a
    :class:`Stepper` makes it in two halves, with contact forces solved for in between.
    """

    def __init__(
        self,
        matrices: Matrices,
        method: Alpha,
        time_step: float,
        *,
        solver: str = "auto",
        threads: int = 1,
        columns: int = 1,
    ) -> None:
        self.threads, self.columns_at_once = threads, columns
        self.matrices, self.method, self.time_step = matrices, method, float(time_step)
        beta, gamma, dt = method._beta, method._gamma, self.time_step
        self.weight_c, self.weight_p = 1.0 + method.alpha, -method.alpha
        self.u_from_a, self.v_from_a = beta * dt**2, gamma * dt
        late_u, late_v = (0.5 - beta) * dt**2, (1.0 - gamma) * dt
        wc, wp = self.weight_c, self.weight_p
        # Rows: ũ, ṽ, (1+α) ũ - α u, (1+α) ṽ - α u̇, from u, u̇, ü of the step before.
        self.prediction = np.array(
            [
                [1.0, dt, late_u],
                [0.0, 1.0, late_v],
                [wc + wp, wc * dt, wc * late_u],
                [0.0, wc + wp, wc * late_v],
            ]
        )
        self.has_damping = matrices.C is not None or matrices.C_low_rank is not None
        self.effective = self._effective_matrix()
        self.factor = self.factor_of(self.effective, solver)
        self.K = _operand(matrices.K)
        self.C = None if matrices.C is None else _operand(matrices.C)
        self.dense = self._dense() if 0 < matrices.size <= _DENSE_UP_TO else None

    @property
    def size(self) -> int:
        """Number of d.o.f."""
        return self.matrices.size

    @cached_property
    def halves(self) -> list[Parts]:
        """K and C as the loop for one body wants them: the diagonal, and row starts, columns, entries above it."""
        return [half_of(self.matrices.K, self.size), half_of(self.matrices.C, self.size)]

    @cached_property
    def wholes(self) -> list[Parts]:
        """K and C as the loop for many bodies wants them: row starts, columns, entries."""
        return [whole_of(self.matrices.K, self.size), whole_of(self.matrices.C, self.size)]

    def _effective_matrix(self) -> sp.csr_array:
        m = self.matrices
        effective = m.M + (self.weight_c * self.u_from_a) * m.K
        if m.C is not None:
            effective = effective + (self.weight_c * self.v_from_a) * m.C
        return sp.csr_array(effective)

    def _dense(self) -> FloatArray:
        """[-A⁻¹ K, -A⁻¹ C, A⁻¹] (n, 2n or 3n) of a small body; the second block only where there is damping."""
        blocks = [-self.factor.solve(np.ascontiguousarray(self.matrices.K.toarray()))]
        if self.has_damping:
            blocks.append(
                -self.factor.solve(np.ascontiguousarray(self.matrices.damping_force(np.eye(self.size))))
            )
        blocks.append(self.factor.solve(np.eye(self.size)))
        return np.ascontiguousarray(np.hstack(blocks))

    def factor_of(self, effective: sp.csr_array, solver: str = "auto") -> Factor:
        """Factor of an effective matrix (n, n), the low-rank damping included."""
        factor = factorize(effective, kind=solver, threads=self.threads, columns=self.columns_at_once)
        low_rank = self.matrices.C_low_rank
        if low_rank is None:
            return factor
        scaled = LowRank(low_rank.vectors, self.weight_c * self.v_from_a * low_rank.coefficients)
        return UpdatedFactor(factor, scaled)

    def step(self, state: State, force_previous: FloatArray, force_current: FloatArray) -> State:
        """The state one time step later, under forces (n,) at both ends of the step [N].

        Examples
        --------
        >>> import scipy.sparse as sp
        >>> one = sp.csr_array([[1.0]])
        >>> body = Integrator(Matrices(K=4.0 * one, M=one), Alpha(0.0), time_step=0.01)
        >>> later = body.step(State.at_rest((1,)), np.zeros(1), np.ones(1))
        >>> round(float(later.a[0]), 12)  # 1 / (1 + 4 β Δt²)
        0.999900009999
        """
        stepper = Stepper(self, state.copy())
        stepper.force[...] = self.weight_c * force_current + self.weight_p * force_previous
        stepper.predict()
        stepper.finish()
        return stepper.state

    def columns(
        self,
        dofs: npt.NDArray[np.int64],
        out: FloatArray | None = None,
        rows: npt.NDArray[np.int64] | None = None,
    ) -> FloatArray:
        """Columns of A⁻¹ (m, n) at d.o.f. (m,), each in one piece; as many are solved for at a time as memory allows.

        With ``out``, they are written to these ``rows`` of it.
        """
        result = np.empty((len(dofs), self.size)) if out is None else out
        places = np.arange(len(dofs)) if rows is None else rows
        at_once = int(np.clip(_AT_ONCE / (8 * max(self.size, 1)), 16, 128))
        for begin in range(0, len(dofs), at_once):
            some = slice(begin, begin + at_once)
            loads = np.zeros((self.size, len(dofs[some])))
            loads[dofs[some], np.arange(loads.shape[1])] = 1.0
            result[places[some]] = self.factor.solve(loads, out=loads).T
        return result


class Stepper:
    """A body on its way: a state, and the arrays that a step needs, made once.

    A step is ``predict``, as if the forces in ``force`` were all; ``add`` for accelerations that contact forces
    bring; ``finish``. Small bodies hold A⁻¹, A⁻¹ K and A⁻¹ C as dense matrices, side by side, so that a
    prediction is one product; large ones multiply with K and C and solve with the factor.
    """

    def __init__(self, integrator: Integrator, state: State) -> None:
        self.integrator, self.state = integrator, state
        shape = state.values.shape[1:]
        # Rows: (1+α) ũ - α u, (1+α) ṽ - α u̇ where there is damping, force.
        n_row = 2 if integrator.has_damping else 1
        self._work = np.zeros((n_row + 1, *shape))
        self._rows = self._work[:n_row].reshape(n_row, -1)
        self._means = np.ascontiguousarray(integrator.prediction[2 : 2 + n_row])
        self._advance = np.array(
            [
                [*integrator.prediction[0], integrator.u_from_a],
                [*integrator.prediction[1], integrator.v_from_a],
            ]
        )
        self._ahead_weights = self._advance[0].tolist()
        self._read = compiled_reading()
        self._ahead = np.empty((2, state.values[0].size))
        self.force = self._work[n_row]  # (1+α) F^c - α F^p of the next prediction [N]; used up by it
        self.acceleration = np.zeros(shape)  # of the new time, as far as it is known
        self._done = True  # whether the state is that of the acceleration
        self._product = np.empty(shape)
        self._dense = integrator.dense
        self._right_side: Loop | None = None
        self._complete: Loop | None = None
        if self._dense is not None:
            width = (n_row + 1) * integrator.size
            self._stacked = self._work.reshape(width, *shape[1:])
            self._forceless = np.ascontiguousarray(self._dense[:, : width - integrator.size])
        else:
            single = len(shape) == 1 or shape[1] == 1
            self._right_side = compiled_right_side(single)
            self._use_compiled_completion()
            self._sparse = integrator.halves if single else integrator.wholes
            self._view = (-1,) if single else (integrator.size, -1)  # of a row, as the loop wants it

    def _use_compiled_completion(self) -> None:
        self._complete = compiled_completion()

    def predict(self, *, forceless: bool = False) -> None:
        """Advance under ``force``; ``forceless`` says that there is none, whatever stands there."""
        self._done = False
        integrator, values = self.integrator, self.state.values
        if self._right_side is not None:
            damped = integrator.has_damping
            work, state = self._work.reshape(len(self._work), *self._view), values.reshape(3, *self._view)
            self._right_side(integrator.prediction, state, *self._sparse, damped, not forceless, work)
        else:
            np.matmul(self._means, values.reshape(3, -1), out=self._rows)
            if self._dense is not None:
                if forceless:
                    np.dot(self._forceless, self._stacked[: self._forceless.shape[1]], out=self.acceleration)
                else:
                    np.dot(self._dense, self._stacked, out=self.acceleration)
                return
            self._numpy_right_side(forceless)
        if integrator.matrices.C_low_rank is not None:
            self.force -= integrator.matrices.C_low_rank.apply(self._work[1])
        integrator.factor.solve(self.force, out=self.acceleration)

    def _numpy_right_side(self, forceless: bool) -> None:
        force, integrator = self.force, self.integrator
        if forceless:
            force[...] = 0.0
        force -= _product(integrator.K, self._work[0], self._product)
        if integrator.C is not None:
            force -= _product(integrator.C, self._work[1], self._product)

    def displacement(self, where: npt.NDArray[np.int64]) -> FloatArray:
        """Displacements at flat positions (any shape) at the new time, as far as it is known."""
        values = self.state.values.reshape(3, -1)
        if self._done:
            return np.asarray(values[0].take(where))
        _, dt, late, new = self._ahead_weights
        if self._read is not None:
            result = np.empty(where.shape)
            flat = self.acceleration.reshape(-1)
            self._read(where.reshape(-1), dt, late, new, values, flat, result.reshape(-1))
            return result
        result = values[1].take(where)
        result *= dt
        result += late * values[2].take(where)
        result += values[0].take(where)
        result += new * self.acceleration.take(where)
        return np.asarray(result)

    def velocity(self, where: npt.NDArray[np.int64]) -> FloatArray:
        """Velocities at flat positions (any shape) at the new time, as far as they are known."""
        values = self.state.values.reshape(3, -1)
        if self._done:
            return np.asarray(values[1].take(where))
        late, new = self._advance[1, 2:].tolist()
        return np.asarray(
            values[1].take(where) + late * values[2].take(where) + new * self.acceleration.take(where)
        )

    def add(self, acceleration: FloatArray) -> None:
        """Add the acceleration that contact forces bring."""
        self.acceleration += acceleration

    def hold(self) -> None:
        """Take the state as it is for the new time: displacements read it as if just computed."""
        self.acceleration[...] = self.state.a
        self._done = True

    def finish(self, added: FloatArray | None = None) -> None:
        """Complete the state at the new time; ``added`` is acceleration that contact forces bring."""
        self._done = True
        values, integrator = self.state.values.reshape(3, -1), self.integrator
        acceleration = self.acceleration.reshape(-1)
        if self._complete is not None:
            more = acceleration if added is None else added.reshape(-1)
            self._complete(
                integrator.prediction,
                integrator.u_from_a,
                integrator.v_from_a,
                acceleration,
                more,
                added is not None,
                values,
            )
            return
        if added is not None:
            acceleration += added.reshape(-1)
        np.matmul(self._advance[:, :3], values, out=self._ahead)
        np.multiply(self._advance[:, 3:], acceleration, out=values[:2])
        values[:2] += self._ahead
        values[2] = acceleration


def _product(matrix: FloatArray | sp.csr_array, x: FloatArray, out: FloatArray) -> FloatArray:
    if isinstance(matrix, np.ndarray):
        return np.dot(matrix, x, out=out)
    return np.asarray(matrix @ x)


def _operand(matrix: sp.csr_array) -> FloatArray | sp.csr_array:
    return np.ascontiguousarray(matrix.toarray()) if matrix.shape[0] <= _DENSE_UP_TO else matrix
