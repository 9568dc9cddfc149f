"""Structured meshes as arrays: points, elements and named boundaries of lines, rectangles and boxes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
#: Points (n_node, 3) [m], nodes of the elements (n_element, n_node), node sets by name.
Grid = tuple[FloatArray, IntArray, dict[str, IntArray]]

# Local nodes of the elements that a cell is cut into; neighbours agree on the diagonals.
_CUTS: Mapping[str, tuple[tuple[int, ...], ...]] = {
    "quad4": ((0, 1, 2, 3),),
    "tri3": ((0, 1, 2), (0, 2, 3)),
    "hex8": ((0, 1, 2, 3, 4, 5, 6, 7),),
    "wedge6": ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)),
    "tet4": ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)),
}

# Steps (along x, y, z) to the corners of a cell, in the order of quad4 and hex8.
_SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))
_CORNERS: Mapping[int, tuple[tuple[int, ...], ...]] = {
    2: _SQUARE,
    3: tuple((*steps, height) for height in (0, 1) for steps in _SQUARE),
}


def line_grid(start: Sequence[float], end: Sequence[float], elements: int) -> Grid:
    """Lines of equal length from a point to another; sets ``start`` and ``end``."""
    (count,) = _divisions((elements,))
    tail, head = _vector(start, "start", 3), _vector(end, "end", 3)
    if np.array_equal(tail, head):
        raise InputError("must differ from the start", field="end", value=head.tolist())
    share = np.linspace(0.0, 1.0, count + 1)[:, None]
    nodes = np.column_stack([np.arange(count), np.arange(1, count + 1)])
    return (1.0 - share) * tail + share * head, nodes, {"start": np.array([0]), "end": np.array([count])}


def cell_grid(
    lengths: Sequence[float],
    divisions: Sequence[int],
    origin: Sequence[float],
    axes: tuple[int, ...],
    kind: str,
) -> Grid:
    """Equal cells along two or three axes, cut into elements of a kind; x runs fastest.

    Sets: ``x_min``, ``x_max``, ``y_min``, … and their intersections ``x_min/y_min``, …
    """
    kinds = [name for name in _CUTS if name.startswith(("quad", "tri")) == (len(axes) == 2)]
    if kind not in kinds:
        raise InputError(f"must be one of {', '.join(kinds)}", field="kind", value=kind)
    counts = _divisions(divisions)
    sides = _vector(lengths, "lengths", len(axes))
    if len(counts) != len(axes):
        raise InputError(f"must be {len(axes)} numbers", field="divisions", value=list(divisions))
    if np.any(sides <= 0.0):
        raise InputError("must be positive", field="lengths", value=sides.tolist())
    shape = tuple(count + 1 for count in counts[::-1])
    positions = np.arange(np.prod(shape)).reshape(shape)  # [.., j, i]
    shares = np.meshgrid(*(np.linspace(0.0, 1.0, n) for n in shape), indexing="ij")
    points = np.tile(_vector(origin, "origin", 3), (positions.size, 1))
    for axis, side, share in zip(axes, sides, shares[::-1], strict=True):
        points[:, axis] += side * share.ravel()
    corners = [
        positions[tuple(slice(step, size - 1 + step) for step, size in zip(steps[::-1], shape, strict=True))]
        for steps in _CORNERS[len(axes)]
    ]
    cuts = np.array(_CUTS[kind])
    nodes = np.column_stack([corner.ravel() for corner in corners])[:, cuts].reshape(-1, cuts.shape[1])
    return points, nodes, _boundary(positions, axes)


def _boundary(positions: IntArray, axes: tuple[int, ...]) -> dict[str, IntArray]:
    """Named faces, edges and corners of a grid of node positions, its axes last to first."""
    sets = {}
    for sides in product((None, 0, -1), repeat=len(axes)):
        named = [(axis, side) for axis, side in zip(axes, sides, strict=True) if side is not None]
        if named:
            chosen = tuple(slice(None) if side is None else side for side in sides[::-1])
            name = "/".join(f"{'xyz'[axis]}_{'min' if side == 0 else 'max'}" for axis, side in named)
            sets[name] = np.atleast_1d(positions[chosen]).ravel()
    return sets


def _divisions(divisions: Sequence[int]) -> tuple[int, ...]:
    for count in divisions:
        if not isinstance(count, (int, np.integer)) or count < 1:
            raise InputError("must be whole numbers of at least 1", field="divisions", value=count)
    return tuple(int(count) for count in divisions)


def _vector(values: Sequence[float], what: str, size: int) -> FloatArray:
    vector = np.asarray(values, dtype=np.float64)
    if vector.shape != (size,) or not np.all(np.isfinite(vector)):
        raise InputError(f"must be {size} finite numbers", field=what, value=vector.tolist())
    return vector
