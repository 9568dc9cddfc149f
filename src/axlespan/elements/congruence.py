"""Elements of the same shape and material, so that each is integrated once.

Structured and extruded meshes repeat a few elements thousands of times; their matrices differ by nothing
but the rounding of the coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Coordinates that differ by less than this many units in the last place of the largest one are the same:
# far above what mesh generators and text files round, far below any dimension of a structure.
_ULPS = 2.0**12


@dataclass(frozen=True, eq=False)
class Classes:
    """A partition of elements into classes of congruent ones."""

    first: IntArray  # (n_class,) the element that stands for each class
    label: IntArray  # (n_element,) class of each element

    def __len__(self) -> int:
        return len(self.first)

    def batches(self, size: int) -> Iterator[tuple[IntArray, IntArray, IntArray]]:
        """Yield all elements in batches of ``size``: (elements, distinct ones, position of each in these).

        Elements come sorted by class, so a batch has as few distinct ones as possible.
        """
        order = np.argsort(self.label, kind="stable")
        for start in range(0, len(order), size):
            elements = order[start : start + size]
            labels = self.label[elements]
            yield elements, self.first[labels[0] : labels[-1] + 1], labels - labels[0]


def congruent(coordinates: FloatArray, *properties: FloatArray) -> Classes:
    """Classes of elements that are equal up to a translation.

    Parameters
    ----------
    coordinates : array (n_element, n_node, dimension)
        Node coordinates [m]; compared within 4096 units in the last place of the largest.
    *properties : array (n_element, ...)
        Anything else that elements of a class must share, compared exactly.
    """
    n_element = len(coordinates)
    if n_element == 0:
        return Classes(np.empty(0, np.int64), np.empty(0, np.int64))
    grid = _ULPS * np.finfo(float).eps * max(float(np.abs(coordinates).max()), 1e-300)
    shape = (coordinates[:, 1:] - coordinates[:, :1]).reshape(n_element, -1)
    # float to int64 is safe: |shape| / grid < 2 / (4096 eps) < 2^42; the sum 0.0 + x turns -0.0 into 0.0.
    rows = np.hstack(
        [
            np.rint(shape / grid).astype(np.int64),
            *((0.0 + np.asarray(p, float)).reshape(n_element, -1).view(np.int64) for p in properties),
        ]
    )
    first, label = _distinct(rows)
    return Classes(first, label)


def _distinct(rows: IntArray) -> tuple[IntArray, IntArray]:
    """First occurrence and label of equal rows, through a hash: sorting whole rows costs far more."""
    odd = np.random.default_rng(0).integers(1, 2**63, size=rows.shape[1], dtype=np.uint64) | np.uint64(1)
    mixed = rows.astype(np.uint64) * odd
    mixed ^= mixed >> np.uint64(29)
    keys = (mixed * np.uint64(0x9E3779B97F4A7C15)).sum(axis=1, dtype=np.uint64)
    _, first, label = np.unique(keys, return_index=True, return_inverse=True)
    if not (rows == rows[first[label]]).all():
        # Two different rows with one key: as good as never, but then the rows decide.
        _, first, label = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    # Classes in the order in which they turn up.
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[label.reshape(-1)]
