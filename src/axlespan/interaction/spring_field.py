r"""The nonlinear springs of a structure within a step: which are unknowns, and what they do to the structure.

All elongations follow from the free response, the contact forces X of the wheels and the deviations q,

.. math:: e = e^* - (1+α) β Δt^2 \left( B A^{-1} E^T X + B A^{-1} B^T q \right)

with the rates ė = ė* + γ/(βΔt) (e - e*). Springs whose deviation vanishes are left out of Newton's method; after
it has converged, those that were left out wrongly are taken in, and the step is solved again.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.interaction.bodies import StructureBody
from axlespan.interaction.nonlinear_springs import Springs

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class SpringField:
    """The springs of one structure in time; ``springs`` have the memory of the last completed step.

    Parameters
    ----------
    springs : Springs
        Under the structure's own weight.
    deviation : array (n_spring,)
        At time zero [N].
    """

    def __init__(self, springs: Springs, deviation: FloatArray) -> None:
        self.springs = springs
        self.q = deviation.copy()
        self.e = np.zeros(springs.n)
        self.rate = np.zeros(springs.n)
        self.active = np.flatnonzero(deviation)
        self.largest = len(self.active)  # unknowns of a step, so far
        self.history = [self.q]  # of the start and each step, where springs stand on supports
        self._dofs = np.unique(springs.rows.indices) if springs.n else np.empty(0, dtype=np.int64)
        self._local = springs.rows[:, self._dofs]
        self._columns: FloatArray | None = None
        self._on_ground = bool(springs.ground.nnz)

    # --- compliance ------------------------------------------------------------------------------

    def enter(self, structure: StructureBody) -> None:
        """Have the columns of the springs and of the path d.o.f. at hand that a stretch needs."""
        if not self.springs.n:
            return
        integrator = structure.integrator
        scale = integrator.weight_c * integrator.u_from_a
        if self._columns is None:
            n, rows = integrator.size, self.springs.rows
            path = structure.columns.path_dofs
            Z = np.empty((self.springs.n, self.springs.n))
            on_path = np.empty((len(path), self.springs.n))
            for begin in range(0, self.springs.n, 64):
                some = slice(begin, min(begin + 64, self.springs.n))
                block = integrator.factor.solve(np.ascontiguousarray(rows[some].T.toarray()))
                Z[:, some], on_path[:, some] = rows @ block, block[path]
            self._columns = 0.5 * scale * (Z + Z.T)
            place = np.zeros(n, dtype=np.int64)
            place[path] = np.arange(len(path))
            self._place, self._all_path = place, scale * on_path
        self._path = self._all_path[self._place[structure.columns.held]]  # (n_held, n_spring)
        self._rate_from_e = integrator.v_from_a / integrator.u_from_a

    # --- a step ----------------------------------------------------------------------------------

    def predict(self, structure: StructureBody) -> None:
        """Elongations and rates of the free response."""
        if not self.springs.n:
            return
        stepper = structure.stepper
        at = self._dofs
        self.e_free = np.asarray(self._local @ stepper.displacement(at))
        velocity = stepper.velocity(at)
        self.rate_free = np.asarray(self._local @ velocity)

    @property
    def busy(self) -> bool:
        """Whether a spring deviates, or would in the free response."""
        if not self.springs.n:
            return False
        return bool(len(self.active)) or bool(np.any(self.springs.deviation(self.e_free, self.rate_free)))

    def rest(self) -> None:
        """A step in which no spring deviates and no wheel is there."""
        if self.springs.n:
            self.q, self.e, self.rate = np.zeros(self.springs.n), self.e_free, self.rate_free

    def meet(self, held: IntArray, weights: FloatArray, at: IntArray, n_wheel: int) -> None:
        """Note which d.o.f. the wheels on the structure load (n_wheel, n_local), and their places in the interface."""
        if not self.springs.n or not len(self._path):  # no wheel is on the structure yet
            at = at[:0]
        self._held, self._weights, self._at, self._n_wheel = held, weights, at, n_wheel

    def joined(self, S: FloatArray, gap: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Compliance, free coordinates and guessed deviations of the wheels and the active springs together."""
        a, w = self.active, len(gap)
        if not len(a):
            return S, gap, np.zeros(0)
        assert self._columns is not None
        system = np.zeros((w + len(a), w + len(a)))
        system[:w, :w] = S
        if len(self._at):
            cross = np.einsum("ij,ijk->ik", self._weights, self._path[self._held][:, :, a])
            system[self._at, w:], system[w:, self._at] = cross, cross.T
        system[w:, w:] = self._columns[np.ix_(a, a)]
        return system, np.concatenate([gap, self.e_free[a]]), self.q[a]

    def evaluate(self, e: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Deviations of the active springs at their elongations, and their derivatives."""
        a = self.active
        whole = self.e_free.copy()
        whole[a] = e
        rate = self.rate_free + self._rate_from_e * (whole - self.e_free)
        k, c = self.springs.tangent(whole, rate)
        return self.springs.deviation(whole, rate)[a], (k + self._rate_from_e * c)[a]

    def settle(self, forces: FloatArray, deviation: FloatArray) -> bool:
        """Take a solution; false where springs deviate that were left out: they are active from now on."""
        if not self.springs.n:
            return True
        assert self._columns is not None
        q = np.zeros(self.springs.n)
        q[self.active] = deviation
        e = self.e_free.copy()
        if len(self.active):
            e -= self._columns[:, self.active] @ deviation
        if len(self._at):
            loads = (self._weights * forces[self._at][:, None]).ravel()
            on_path = np.bincount(self._held.ravel(), loads, minlength=len(self._path))[: len(self._path)]
            e -= on_path @ self._path
        rate = self.rate_free + self._rate_from_e * (e - self.e_free)
        left_out = self.springs.deviation(e, rate) != 0.0
        left_out[self.active] = False
        self.q, self.e, self.rate = q, e, rate
        if not left_out.any():
            return True
        self.active = np.union1d(self.active, np.flatnonzero(left_out))
        self.largest = max(self.largest, len(self.active))
        return False

    def take(self, structure: StructureBody, load: FloatArray | None, known: FloatArray | None) -> None:
        """Give the structure the loads of the wheels (n_held,) and the springs, and complete the step."""
        springs = self.springs
        if springs.n:
            springs.advance(self.e, self.rate)
            if self._on_ground:
                self.history.append(self.q)
            self.active = np.flatnonzero(self.q)
        if not springs.n or not len(self.active):
            structure.take(load, known)
            return
        integrator = structure.integrator
        inner = np.asarray(springs.rows.T @ self.q)
        total = inner.copy()
        if load is not None:
            total[structure.columns.held] += load
        structure.stepper.add(integrator.factor.solve(-integrator.weight_c * total))
        if known is not None:
            total[structure.columns.held] += known
        structure.stepper.finish()
        structure.carry(total)

    def force(self) -> FloatArray | None:
        """Force (n,) of the deviations on the structure at the last completed step."""
        if not self.springs.n or not len(self.active):
            return None
        return np.asarray(-(self.springs.rows.T @ self.q))

    def on_supports(self, n_step: int) -> FloatArray | None:
        """What the deviations add to the reactions in the last so many steps (n_step, n_prescribed)."""
        if not self._on_ground:
            return None
        recent, self.history = np.array(self.history[:n_step]), self.history[n_step:]
        return np.asarray(recent @ self.springs.ground)

    def facts(self) -> dict[str, object]:
        """For the summary."""
        if not self.springs.n:
            return {}
        return {"nonlinear_springs": self.springs.n, "nonlinear_springs_active": self.largest}
