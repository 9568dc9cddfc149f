"""Assembly of element matrices into sparse matrices of the whole model."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.model.dofs import DofTable, component_indices
from axlespan.model.parts import ElementMatrices, Part

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


def element_dofs(part: Part, table: DofTable) -> IntArray:
    """Numbers (n_element, n_dof) of the d.o.f. of each element, node by node."""
    numbers = table.number[part.nodes][:, :, component_indices(part.components)]
    return numbers.reshape(len(part.nodes), -1)


def assemble(
    parts: tuple[Part, ...], points: FloatArray, table: DofTable
) -> tuple[sp.csr_array, sp.csr_array, sp.csr_array]:
    """Stiffness, mass and damping matrices (n, n) over all active d.o.f."""
    triplets: dict[str, list[tuple[FloatArray, IntArray, IntArray]]] = {
        "stiffness": [],
        "mass": [],
        "damping": [],
    }
    for part in parts:
        dofs = element_dofs(part, table)
        matrices: ElementMatrices = part.matrices(points)
        rows = np.broadcast_to(dofs[:, :, None], (*dofs.shape, dofs.shape[1])).reshape(-1)
        columns = np.broadcast_to(dofs[:, None, :], (*dofs.shape, dofs.shape[1])).reshape(-1)
        for name, entries in triplets.items():
            values = getattr(matrices, name)
            if values is not None:
                entries.append((values.reshape(-1), rows, columns))
    return (
        _summed(triplets["stiffness"], table.size),
        _summed(triplets["mass"], table.size),
        _summed(triplets["damping"], table.size),
    )


def _summed(entries: list[tuple[FloatArray, IntArray, IntArray]], n: int) -> sp.csr_array:
    if not entries:
        return sp.csr_array((n, n), dtype=float)
    values, rows, columns = (np.concatenate(column) for column in zip(*entries, strict=True))
    matrix = sp.coo_array((values, (rows, columns)), shape=(n, n)).tocsr()
    matrix.eliminate_zeros()
    return _symmetric(matrix)


def _symmetric(matrix: sp.csr_array) -> sp.csr_array:
    """Remove the rounding of the summation order, so that the matrix is symmetric to the last bit."""
    return sp.csr_array(0.5 * (matrix + matrix.T))
