"""Assembly of element matrices into sparse matrices of the whole model, on one fixed pattern.

The pattern belongs to the topology: every d.o.f. of a node is coupled to every d.o.f. of the nodes that it
shares an element with, whatever the numbers are. Stiffness, mass and damping have it in common, with
explicit zeros. Pairs of nodes are summed once, in the order of the elements, and mirrored: the matrices are
symmetric to the last bit.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.model.dofs import DofTable, component_indices
from axlespan.model.parts import ElementMatrices, Part

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
IndexArray = npt.NDArray[np.signedinteger]

# Bytes of the element matrices that are there at one time.
_CHUNK_BYTES = 50e6


@runtime_checkable
class Divisible(Protocol):
    """A part that can be assembled a few elements at a time."""

    def taken(self, elements: slice) -> Part:
        """Return some of its elements as a part."""
        ...


def element_dofs(part: Part, table: DofTable) -> IntArray:
    """Numbers (n_element, n_dof) of the d.o.f. of each element, node by node."""
    numbers = table.number[part.nodes][:, :, component_indices(part.components)]
    count, *each = numbers.shape  # there may be none
    return numbers.reshape(count, each[0] * each[1])


def assemble(
    parts: tuple[Part, ...], points: FloatArray, table: DofTable
) -> tuple[sp.csr_array, sp.csr_array, sp.csr_array]:
    """Stiffness, mass and damping matrices (n, n) over all active d.o.f.

    Their rows are sorted; those that have entries share the arrays of the pattern, which are read-only.
    """
    pattern = _Pattern.of(parts, table)
    sums: dict[str, FloatArray] = {}
    for part in parts:
        for piece in _pieces(part):
            matrices: ElementMatrices = piece.matrices(points)
            _check_shapes(piece, matrices)
            given = {name: getattr(matrices, name) for name in ("stiffness", "mass", "damping")}
            given = {name: values for name, values in given.items() if values is not None}
            for name in given:
                sums.setdefault(name, np.zeros(pattern.n_sum))
            pattern.add(piece, [(sums[name], values) for name, values in given.items()])
    indices, indptr, source = pattern.expanded()
    for array in (indices, indptr):
        array.setflags(write=False)
    stiffness, mass, damping = (
        sp.csr_array((sums.pop(name)[source], indices, indptr), shape=(table.size, table.size))
        if name in sums
        else sp.csr_array((table.size, table.size), dtype=float)
        for name in ("stiffness", "mass", "damping")
    )
    return stiffness, mass, damping


def _pieces(part: Part) -> Iterator[Part]:
    n_element, n_node = np.shape(part.nodes)
    size = max(1, int(_CHUNK_BYTES / (16 * (n_node * len(part.components)) ** 2)))
    if n_element <= size or not isinstance(part, Divisible):
        yield part
        return
    for begin in range(0, n_element, size):
        yield part.taken(slice(begin, min(begin + size, n_element)))


def _check_shapes(part: Part, matrices: ElementMatrices) -> None:
    n_element, n_node = np.shape(part.nodes)
    n_dof = n_node * len(part.components)
    for values in (matrices.stiffness, matrices.mass, matrices.damping):
        assert values is None or values.shape == (n_element, n_dof, n_dof), (part.name, n_dof)


@dataclass(frozen=True, eq=False)
class _Pattern:
    """Pairs of nodes i ≤ j that share an element; the entries of each are a block of ``count_i · count_j`` sums.

    Nodes are counted in the order of their d.o.f.
    """

    table: DofTable
    rank: IntArray  # (n_node,) place of each node in that order
    pairs: IntArray  # (n_pair,) i n_node + j, sorted
    first: IntArray  # (n_node,) lowest d.o.f. of each node
    count: IntArray  # (n_node,) number of its d.o.f.
    begin: IntArray  # (n_pair,) position of the block among the sums
    n_sum: int

    @classmethod
    def of(cls, parts: tuple[Part, ...], table: DofTable) -> _Pattern:
        lowest = np.where(table.number >= 0, table.number, table.size).min(axis=1)
        order = np.argsort(lowest, kind="stable")
        n_node = len(order)
        rank = np.empty(n_node, dtype=np.int64)
        rank[order] = np.arange(n_node)
        count = np.count_nonzero(table.number[order] >= 0, axis=1).astype(np.int64)
        first = np.cumsum(count) - count
        keys = [np.empty(0, dtype=np.int64)]
        keys += [_distinct(_pair_keys(rank[np.asarray(part.nodes)], n_node)) for part in parts]
        pairs = _distinct(np.concatenate(keys))
        size = count[pairs // n_node] * count[pairs % n_node]
        begin = np.cumsum(size) - size
        return cls(table, rank, pairs, first, count, begin, int(size.sum()))

    def add(self, part: Part, targets: list[tuple[FloatArray, FloatArray]]) -> None:
        """Add element matrices (n_element, n_dof, n_dof) of a part to arrays of sums."""
        nodes = self.rank[np.asarray(part.nodes)]
        n_element, n_node = nodes.shape
        if not targets or not n_element:
            return
        places = self._places(part)  # (n_element, n_local_pair, c, c)
        low, high = int(places.min()), int(places.max()) + 1
        places -= low
        a, b = np.triu_indices(n_node)
        c = len(part.components)
        twice = (nodes[:, a] == nodes[:, b]) & (a != b)
        for sums, values in targets:
            blocks = values.reshape(n_element, n_node, c, n_node, c)
            upper = 0.5 * (blocks[:, a, :, b, :] + blocks[:, b, :, a, :].transpose(0, 1, 3, 2))
            upper = upper.transpose(1, 0, 2, 3)  # advanced indices come first: (pair, element, c, c)
            if twice.any():  # an element that names a node twice
                upper[twice] += upper[twice].transpose(0, 2, 1)
            sums[low:high] += np.bincount(places.ravel(), upper.ravel(), minlength=high - low)

    def _places(self, part: Part) -> IntArray:
        """Positions (n_element, n_local_pair, c, c) of the entries of an element's pairs of nodes a ≤ b."""
        nodes = self.rank[np.asarray(part.nodes)]
        block = np.searchsorted(self.pairs, _pair_keys(nodes, len(self.count)))
        numbers = self.table.number[np.asarray(part.nodes)][:, :, component_indices(part.components)]
        within = numbers - self.first[nodes][:, :, None]  # among the d.o.f. of the node
        a, b = np.triu_indices(nodes.shape[1])
        turned = (nodes[:, a] > nodes[:, b])[:, :, None]
        stride_a = np.where(turned, 1, self.count[nodes[:, b]][:, :, None])
        stride_b = np.where(turned, self.count[nodes[:, a]][:, :, None], 1)
        row = self.begin[block][:, :, None] + within[:, a] * stride_a
        return np.asarray(row[:, :, :, None] + (within[:, b] * stride_b)[:, :, None, :])

    def expanded(self) -> tuple[IndexArray, IndexArray, IndexArray]:
        """Column indices, row starts and the sum that each entry takes, of the whole symmetric matrix."""
        n_node = len(self.count)
        i, j = np.divmod(self.pairs, n_node)
        off = np.flatnonzero(i != j)
        row, column = np.concatenate([i, j[off]]), np.concatenate([j, i[off]])
        order = np.argsort(row * n_node + column)
        row, column = row[order], column[order]
        pair = np.concatenate([np.arange(len(i)), off])[order]
        width = self.count[column]
        reach = np.cumsum(width)
        ends = np.searchsorted(row, np.arange(n_node + 1))
        reach = np.concatenate([[0], reach])
        length = np.diff(reach[ends])  # entries in each row of a node
        row_size = np.repeat(length, self.count)
        indptr = np.concatenate([[0], np.cumsum(row_size)])
        index = np.dtype(np.int32 if max(int(indptr[-1]), self.table.size) < 2**31 else np.int64)
        indices: IndexArray = np.empty(int(indptr[-1]), index)
        source: IndexArray = np.empty_like(indices)
        offset = reach[:-1] - reach[ends[row]]  # of the block in its rows
        for p in range(int(self.count.max(initial=0))):
            for q in range(int(self.count.max(initial=0))):
                k = np.flatnonzero((self.count[row] > p) & (width > q))
                at = indptr[self.first[row[k]] + p] + offset[k] + q
                indices[at] = self.first[column[k]] + q
                source[at] = self._sum_of(row[k], column[k], pair[k], p, q)
        return indices, np.asarray(indptr, index), source

    def _sum_of(self, row: IntArray, column: IntArray, pair: IntArray, p: int, q: int) -> IntArray:
        """Positions of the sums for entry (p, q) of blocks; the lower triangle takes those of the upper."""
        upper = p * self.count[column] + q
        lower = q * self.count[row] + p
        if p > q:
            return np.asarray(self.begin[pair] + np.where(row >= column, lower, upper))
        return np.asarray(self.begin[pair] + np.where(row <= column, upper, lower))


def _distinct(keys: IntArray) -> IntArray:
    """np.unique, without the detour over a hash table that is slow for so many."""
    ordered = np.sort(keys, axis=None)
    return ordered[np.concatenate([[True], ordered[1:] > ordered[:-1]])] if len(ordered) else ordered


def _pair_keys(nodes: IntArray, n_node: int) -> IntArray:
    """Keys min · n_node + max (n_element, n_local_pair) of all pairs of an element's nodes a ≤ b."""
    a, b = np.triu_indices(nodes.shape[1])
    low, high = np.minimum(nodes[:, a], nodes[:, b]), np.maximum(nodes[:, a], nodes[:, b])
    return np.asarray(low * n_node + high)
