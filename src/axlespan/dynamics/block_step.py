"""Many small bodies in one, as the vehicles of trains: a step of each with its own dense A⁻¹, compiled by numba.

What a body does then depends on nothing but itself, to the last bit: crossings side by side give the numbers of each
alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.compiled import Loop, compiled, numba_is_there
from axlespan.dynamics.integrator import Integrator, State, Stepper

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# A body of more d.o.f. is left to sparse matrices.
_LARGEST = 200


@cache
def _compiled_prediction() -> Loop | None:
    return compiled(_predict)


@dataclass(frozen=True, eq=False)
class Blocks:
    """The diagonal blocks of a body, equal ones stored once."""

    first: IntArray  # (n_block + 1,) where the d.o.f. of each begin
    kind: IntArray  # (n_block,)
    begin: IntArray  # (n_kind,) where the rows of each kind begin in entries
    entries: (
        FloatArray  # rows of [-A⁻¹ K, -A⁻¹ C, A⁻¹] of all kinds; the second block only where there is damping
    )
    inverses: tuple[FloatArray, ...]  # A⁻¹ (m, m) by kind

    @classmethod
    def of(cls, integrator: Integrator, owner: IntArray) -> Blocks | None:
        """The blocks of the d.o.f. (n,) of each owner, numbered on; None where loops cannot be compiled or pay.

        Parameters
        ----------
        integrator : Integrator
            Of the whole body, without low-rank damping.
        owner : array (n,)
            Body of each d.o.f., ascending.
        """
        first = np.concatenate([[0], np.flatnonzero(np.diff(owner)) + 1, [len(owner)]]).astype(np.int64)
        if not numba_is_there() or not len(owner) or np.diff(first).max() > _LARGEST:
            return None
        m = integrator.matrices
        parts = [sp.csr_array(a) for a in (m.K, m.C, integrator.effective) if a is not None]
        known: dict[tuple[bytes, ...], int] = {}
        kind, rows, inverses = [], [], []
        for low, high in zip(first[:-1].tolist(), first[1:].tolist(), strict=True):
            key = tuple(piece for part in parts for piece in _bytes(part, low, high))
            if key not in known:
                known[key] = len(known)
                *others, A = (part[low:high, low:high].toarray() for part in parts)
                inverse = np.linalg.inv(A)
                inverses.append(inverse)
                rows.append(np.hstack([*(-inverse @ other for other in others), inverse]).ravel())
            kind.append(known[key])
        begin = np.concatenate([[0], np.cumsum([len(row) for row in rows])])[:-1].astype(np.int64)
        return cls(first, np.array(kind), begin, np.concatenate(rows), tuple(inverses))

    def unit_responses(self, dofs: IntArray) -> sp.csr_array:
        """Columns A⁻¹ e (n, n_dof) for unit forces at some d.o.f."""
        block = np.searchsorted(self.first, dofs, side="right") - 1
        rows = [np.arange(self.first[b], self.first[b + 1]) for b in block.tolist()]
        values = [
            self.inverses[self.kind[b]][:, dof - self.first[b]]
            for b, dof in zip(block.tolist(), dofs.tolist(), strict=True)
        ]
        columns = np.repeat(np.arange(len(dofs)), [len(row) for row in rows])
        shape = (int(self.first[-1]), len(dofs))
        return sp.csr_array(
            sp.coo_array((np.concatenate(values), (np.concatenate(rows), columns)), shape=shape)
        )


def _bytes(matrix: sp.csr_array, low: int, high: int) -> tuple[bytes, bytes, bytes]:
    """Rows of a block-diagonal matrix, as something to compare."""
    starts = matrix.indptr[low : high + 1]
    inside = slice(starts[0], starts[-1])
    relative = (matrix.indices[inside] - low).tobytes(), (starts - starts[0]).tobytes()
    return matrix.data[inside].tobytes(), *relative


class BlockStepper(Stepper):
    """A :class:`Stepper` of a body that falls into blocks."""

    def __init__(self, integrator: Integrator, state: State, blocks: Blocks) -> None:
        super().__init__(integrator, state)
        self.blocks, self._loop = blocks, _compiled_prediction()
        self._use_compiled_completion()

    def predict(self, *, forceless: bool = False) -> None:
        """Advance under ``force``; ``forceless`` says that there is none, whatever stands there."""
        assert self._loop is not None
        self._done = False
        if forceless:
            self.force[...] = 0.0
        b = self.blocks
        self._loop(
            self.integrator.prediction, self.state.values, b.first, b.kind, b.begin, b.entries,
            self._work, self.acceleration,
        )  # fmt: skip


def _predict(
    prediction: Any, values: Any, first: Any, kind: Any, begin: Any, entries: Any, work: Any, result: Any
) -> None:
    """Accelerations (n,) from the state (3, n) and the force in the last row of ``work`` (2 or 3, n)."""
    p, parts = prediction, work.shape[0]
    u, v, a = values[0], values[1], values[2]
    for b in range(kind.shape[0]):
        low, high = first[b], first[b + 1]
        for i in range(low, high):
            work[0, i] = p[2, 0] * u[i] + (p[2, 1] * v[i] + p[2, 2] * a[i])
            if parts == 3:
                work[1, i] = p[3, 1] * v[i] + p[3, 2] * a[i]
        at = begin[kind[b]]
        for i in range(low, high):
            total = 0.0
            for part in range(parts):
                for j in range(low, high):
                    total += entries[at] * work[part, j]
                    at += 1
            result[i] = total
