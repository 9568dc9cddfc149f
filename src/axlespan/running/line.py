"""Running lines on beams: a chain of nodes along which wheels run."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.assembly import element_dofs
from axlespan.model.dofs import DofTable
from axlespan.model.model import Model
from axlespan.model.parts import BeamPart
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

VERTICAL = np.array([0.0, 0.0, 1.0])


def path_on_beams(
    model: Model,
    table: DofTable,
    nodes: Sequence[int | str],
    *,
    start: float = 0.0,
    direction: FloatArray = VERTICAL,
) -> PolynomialPath:
    """The path along a chain of nodes that beams join, in the model's d.o.f.

    Parameters
    ----------
    model, table
        The model and the numbers of its d.o.f.
    nodes : sequence of node
        In the running direction; every two neighbors must be the ends of one beam, in either order.
    start : float
        Position of the first node [m]; positions are arc lengths from there.
    direction : array (3,)
        Direction of the contact force, vertical by default.

    Raises
    ------
    InputError
        If no beam joins two neighbors.
    """
    chain = [model.node(node) for node in nodes]
    if len(chain) < 2:
        raise InputError(
            "must have at least two nodes", field="running line", value=[str(node) for node in nodes]
        )
    owners = _beams_by_ends(model)
    segments = [_segment(model, owners, a, b) for a, b in itertools.pairwise(chain)]
    sizes = np.linalg.norm(np.diff(model.points[chain], axis=0), axis=1)
    breaks = start + np.concatenate([[0.0], np.cumsum(sizes)])
    parts = {id(part): part for part, _, _ in segments}
    tables = {
        key: (element_dofs(part, table), part.polynomials(model.points, direction))
        for key, part in parts.items()
    }
    n_local = max(dofs.shape[1] for dofs, _ in tables.values())
    dofs = np.zeros((len(segments), n_local), dtype=np.int64)
    coefficients = np.zeros((len(segments), n_local, 4))
    for i, (part, element, backward) in enumerate(segments):
        numbers, polynomials = tables[id(part)]
        own = numbers[element]
        dofs[i], dofs[i, : len(own)] = own[0], own
        coefficients[i, : len(own)] = _reversed(polynomials[element]) if backward else polynomials[element]
    return PolynomialPath(breaks, dofs, coefficients)


def _beams_by_ends(model: Model) -> dict[tuple[int, int], tuple[BeamPart, int]]:
    owners: dict[tuple[int, int], tuple[BeamPart, int]] = {}
    for part in model.parts:
        if isinstance(part, BeamPart):
            for element, (a, b) in enumerate(part.nodes.tolist()):
                owners[a, b] = (part, element)
    return owners


def _segment(
    model: Model, owners: dict[tuple[int, int], tuple[BeamPart, int]], a: int, b: int
) -> tuple[BeamPart, int, bool]:
    for ends, backward in (((a, b), False), ((b, a), True)):
        if ends in owners:
            return (*owners[ends], backward)
    raise InputError(
        "must follow beams: no beam joins these two nodes",
        field="running line",
        value=f"{model.node_label(a)} to {model.node_label(b)}",
    )


def _reversed(coefficients: FloatArray) -> FloatArray:
    """Polynomials of 1 - ξ in powers of ξ, for a cubic (…, 4)."""
    turn = np.array([[1, 0, 0, 0], [1, -1, 0, 0], [1, -2, 1, 0], [1, -3, 3, -1]], float)
    return np.asarray(coefficients @ turn)
