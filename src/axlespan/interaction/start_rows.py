"""The rows of all wheels at one time, with what the line asks of their motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.contact.rows import RowBlock
from axlespan.interaction.plan import Plan

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class MomentRows:
    """Rows of the wheels on the structure at a time, with derivatives along the line, and the level under all wheels."""

    on: IntArray  # (m,) contacts on the structure, ascending
    dofs: IntArray  # (m, n_local) free d.o.f.
    weights: tuple[FloatArray, FloatArray, FloatArray]  # (m, n_local) of E, E', E''
    height: FloatArray  # (n_contact,) r + E_P u_P [m]
    rate: FloatArray  # ṡ (r' + E_P' u_P) + E_P u̇_P [m/s]
    second_rate: FloatArray  # [m/s^2]
    speed: FloatArray  # (n_contact,) ṡ [m/s]
    acceleration: FloatArray  # s̈ [m/s^2]

    @classmethod
    def at(cls, plan: Plan, time: float = 0.0) -> MomentRows:
        """Rows of a crossing at a time."""
        now = np.array([time])
        positions = plan.rows.positions(now)
        speed, acceleration = plan.rows.motion(time)
        on, dofs, weights = _on_paths(plan, positions[0])
        height, rate, second = (np.zeros(len(speed)) for _ in range(3))
        if len(plan.fleet.coupled):  # moving forces don't ask how the line is
            height, r1, r2 = (plan.rows.irregularity(positions, derivative)[0] for derivative in range(3))
            rate, second = speed * r1, speed**2 * r2 + acceleration * r1
        if len(plan.moving) and len(on):
            motions = [plan.crossing.structure.system.motions[j] for j in plan.moving]
            u, v, a = (
                np.array([getattr(m, name)(now)[0] for m in motions])
                for name in ("value", "velocity", "acceleration")
            )
            blocks = [plan.rows.rows(positions[:, on], on, derivative) for derivative in range(3)]
            p0, p1, p2 = (_prescribed_rows(block, len(motions)) for block in blocks)
            s, s2 = speed[on], acceleration[on]
            height[on] += p0 @ u
            rate[on] += s * (p1 @ u) + p0 @ v
            second[on] += s**2 * (p2 @ u) + s2 * (p1 @ u) + 2.0 * s * (p1 @ v) + p0 @ a
        return cls(on, dofs, weights, height, rate, second, speed, acceleration)

    @property
    def carried(self) -> npt.NDArray[np.bool_]:
        """Which of the wheels on the structure (m,) load free d.o.f. of it."""
        return np.asarray(np.any(self.weights[0] != 0.0, axis=1))

    def read(self, values: FloatArray, derivative: int = 0) -> FloatArray:
        """E u (m,) of values (n,) on the structure's d.o.f., or E' u, E'' u."""
        return np.asarray((values[self.dofs] * self.weights[derivative]).sum(axis=1))

    def load(self, forces: FloatArray, n: int) -> FloatArray:
        """Eᵀ X (n,) of forces (m,)."""
        loads = (self.weights[0] * forces[:, None]).ravel()
        return np.asarray(np.bincount(self.dofs.ravel(), loads, minlength=n), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class ContactRows:
    """The same as sparse matrices over all wheels."""

    E: sp.csr_array  # (n_contact, n)
    E1: sp.csr_array
    E2: sp.csr_array
    height: FloatArray  # (n_contact,) r + E_P u_P [m]
    rate: FloatArray  # ṡ (r' + E_P' u_P) + E_P u̇_P [m/s]
    second_rate: FloatArray  # [m/s^2]

    @classmethod
    def of(cls, rows: MomentRows, n: int) -> ContactRows:
        """Rows over n d.o.f."""
        n_contact, width = len(rows.height), rows.dofs.shape[1]
        counts = np.zeros(n_contact + 1, dtype=np.int64)
        counts[rows.on + 1] = width
        ends, matrices = np.cumsum(counts), []
        for weights in rows.weights:
            parts = (weights.flatten(), rows.dofs.flatten(), ends.copy())  # copies, which are put in order
            matrix = sp.csr_array(parts, shape=(n_contact, n))
            matrix.sum_duplicates()
            matrices.append(matrix)
        return cls(matrices[0], matrices[1], matrices[2], rows.height, rows.rate, rows.second_rate)


def rows_at(plan: Plan, time: float = 0.0) -> ContactRows:
    """The rows of all wheels at a time, with derivatives along the line."""
    return ContactRows.of(MomentRows.at(plan, time), plan.structure.size)


def carried_by(E: sp.csr_array) -> npt.NDArray[np.bool_]:
    """Which wheels (n_contact,) the structure carries."""
    return np.asarray(abs(E).sum(axis=1) > 0.0)


def _prescribed_rows(block: RowBlock, n: int) -> FloatArray:
    """E_P (n_contact, n) of the prescribed d.o.f. that move."""
    dofs, weights = block.prescribed_dofs[0], block.prescribed_weights[0]
    result = np.zeros((len(dofs), n))
    np.add.at(result, (np.arange(len(dofs))[:, None], dofs), weights)
    return result


def _on_paths(
    plan: Plan, positions: FloatArray
) -> tuple[IntArray, IntArray, tuple[FloatArray, FloatArray, FloatArray]]:
    """Wheels (m,) on the structure at positions (n_contact,), their d.o.f. and weights with derivatives (m, n_local)."""
    touching = [(path, path.wheels[path.free.carries(positions[path.wheels])]) for path in plan.rows.paths]
    touching = [(path, wheels) for path, wheels in touching if len(wheels)]
    width = max((path.free.dofs.shape[1] for path, _ in touching), default=1)
    count = sum(len(wheels) for _, wheels in touching)
    on, dofs, weights = (
        np.empty(count, dtype=np.int64),
        np.zeros((count, width), dtype=np.int64),
        np.zeros((3, count, width)),
    )
    end = 0
    for path, wheels in touching:
        here, local = slice(end, end + len(wheels)), slice(path.free.dofs.shape[1])
        end += len(wheels)
        on[here] = wheels
        for derivative in range(3):
            dofs[here, local], weights[derivative, here, local] = path.free.weights(
                positions[wheels], derivative
            )
    if len(touching) > 1:
        order = np.argsort(on)
        on, dofs, weights = on[order], dofs[order], weights[:, order]
    return on, dofs, (weights[0], weights[1], weights[2])


def about_to_enter(plan: Plan) -> npt.NDArray[np.bool_]:
    """Which wheels (n_contact,) run onto the structure over a fixed end that they have not passed.

    A footprint reaches over that end before its wheel does. A train that has been running has not deflected
    the structure by that share of a wheel, as one that stands there would.
    """
    positions, (speeds, _) = plan.rows.positions(np.zeros(1))[0], plan.rows.motion(0.0)
    return _enters(plan, np.arange(len(positions)), positions, speeds)


def entering_wheels(plan: Plan, rows: MomentRows) -> npt.NDArray[np.bool_]:
    """The same for the wheels on the structure (m,) at time zero."""
    result = np.zeros(len(rows.on), dtype=bool)
    loading = np.flatnonzero(rows.carried)
    if len(loading):
        on = rows.on[loading]
        positions = plan.rows.positions(np.zeros(1))[0]
        result[loading] = _enters(plan, on, positions[on], rows.speed[on])
    return result


def _enters(
    plan: Plan, contacts: IntArray, positions: FloatArray, speeds: FloatArray
) -> npt.NDArray[np.bool_]:
    """Whether some contacts at their positions [m] and speeds [m/s] are about to enter over a fixed end."""
    structure, result = plan.crossing.structure, np.zeros(len(contacts), dtype=bool)
    names = plan.crossing.contact_lines
    names = names if len(contacts) == len(names) else tuple(names[i] for i in contacts.tolist())
    for name in dict.fromkeys(names):
        path = structure.line(name)
        here = np.array([own == name for own in names])
        here &= ((positions <= path.start) & (speeds > 0.0)) | ((positions >= path.stop) & (speeds < 0.0))
        if not here.any():
            continue
        free = np.zeros(structure.system.size, dtype=bool)
        free[structure.system.free] = True
        dofs, weights = path.weights(np.clip(positions[here], path.start, path.stop))
        result[here] = ~np.any((np.abs(weights) > 1e-9) & free[dofs], axis=1)
    return result
