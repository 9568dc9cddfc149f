"""The beams under a running line: which element carries which of its segments."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from axlespan.elements.beam import BeamProperties
from axlespan.model.assembly import element_dofs
from axlespan.model.compile import dof_table
from axlespan.model.dofs import DofTable
from axlespan.model.model import Model
from axlespan.model.parts import BeamPart
from axlespan.running.line import VERTICAL
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Two interpolations are the same if they agree to this share on a random displacement.
_SAME = 1e-8
# A polynomial of 1 - ξ in powers of ξ.
REVERSED = np.array([[1, 0, 0, 0], [1, -1, 0, 0], [1, -2, 1, 0], [1, -3, 3, -1]], float)


@dataclass(frozen=True, eq=False)
class Carriers:
    """Pairs of a segment and a beam that carries it; a segment over parallel beams has several."""

    segment: IntArray  # (n_pair,) of the line, ascending
    beam: IntArray  # (n_pair,) counted through all beam parts of the model
    backward: npt.NDArray[np.bool_]  # (n_pair,) whether the beam runs against the line


@dataclass(frozen=True, eq=False)
class BeamTable:
    """All beams of a model, counted through its parts."""

    model: Model
    table: DofTable
    parts: tuple[BeamPart, ...]
    begin: IntArray  # (n_part + 1,) number of the first beam of each part

    @classmethod
    def of(cls, model: Model) -> BeamTable:
        """The beams of a model."""
        parts = tuple(part for part in model.parts if isinstance(part, BeamPart))
        begin = np.concatenate([[0], np.cumsum([len(part.nodes) for part in parts], dtype=np.int64)])
        return cls(model, dof_table(model), parts, begin)

    def by_part(self, beams: IntArray) -> list[tuple[BeamPart, IntArray, IntArray]]:
        """For each part that beams (n,) belong to: the part, their positions among the n, and its elements."""
        owner = np.searchsorted(self.begin, beams, side="right") - 1
        places = ((part, np.flatnonzero(owner == i), i) for i, part in enumerate(self.parts))
        return [(part, at, beams[at] - self.begin[i]) for part, at, i in places if len(at)]


def taken(part: BeamPart, elements: IntArray) -> BeamPart:
    """Some beams of a part, repeated as often as they are named."""
    properties = part.properties.broadcast(len(part.nodes))
    chosen = {f.name: np.asarray(getattr(properties, f.name))[elements] for f in fields(BeamProperties)}
    up, offset = (
        value[elements] if value is not None and value.ndim > 1 else value for value in (part.up, part.offset)
    )
    properties = replace(properties, **chosen)
    return replace(part, nodes=part.nodes[elements], properties=properties, up=up, offset=offset)


def carriers(structure: Structure, line: PolynomialPath, beams: BeamTable) -> Carriers:
    """The beams that carry the segments of a line.

    A beam carries a segment if the line moves there as the beam's axis does: if their interpolations are the
    same. Segments over solids, shells or the ground have no beam.
    """
    elimination = structure.system.elimination
    random = np.random.default_rng(5).standard_normal(elimination.shape[1])
    moved = np.asarray(elimination @ random)
    shapes = [
        np.einsum(
            "edp,ed->ep",
            part.polynomials(beams.model.points, VERTICAL),
            moved[element_dofs(part, beams.table)],
        )
        for part in beams.parts
    ]
    n_segment = len(line.breaks) - 1
    none = np.empty(0, dtype=np.int64)
    if not shapes or line.coefficients.shape[2] < 4:
        return Carriers(none, none, np.empty(0, dtype=bool))
    forward = np.concatenate(shapes)
    wanted = np.einsum("sjp,sj->sp", line.coefficients, random[line.dofs])
    curved = np.abs(wanted[:, 4:]).max(axis=1, initial=0.0) > 0.0
    size = np.linalg.norm(wanted[:, :4], axis=1)
    tree = KDTree(np.concatenate([forward, forward @ REVERSED]))
    near = tree.query_ball_point(wanted[:, :4], _SAME * size)
    pairs = [(i, j) for i in range(n_segment) if not curved[i] for j in sorted(near[i])]
    segment, beam = np.array(pairs, dtype=np.int64).reshape(-1, 2).T
    return Carriers(segment, beam % len(forward), beam >= len(forward))
