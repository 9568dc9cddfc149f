"""Where a running line is in space: from the rigid motions of its structure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.model.compile import dof_table
from axlespan.model.model import Model
from axlespan.model.nodal import rigid_motion
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import MAIN_LINE, Structure

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LineGeometry:
    """Points of a line, straight between its breaks and beyond its ends."""

    position: FloatArray  # (n,) of the breaks along the line [m]
    points: FloatArray  # (n, 3) [m]

    @classmethod
    def of(cls, structure: Structure, line: str = MAIN_LINE) -> LineGeometry:
        """The geometry of a line; along x where a structure is given by matrices.

        A rigid rotation by 1 about y lowers the line by its x, one about x raises it by its y. Its height is
        that of the nodes beside it.
        """
        path = structure.line(line)
        s = path.breaks
        if structure.model is None:
            return cls(s, np.column_stack([s, np.zeros((len(s), 2))]))
        rows = path.rows(s, structure.system.size)
        independent = structure.system.independent
        model = structure.model
        lift, x, y = (rows @ rigid_motion(model, component)[independent] for component in ("z", "ry", "rx"))
        return cls(s, np.column_stack([-x / lift, y / lift, _heights(structure, model, path)]))

    def at(self, position: npt.ArrayLike) -> FloatArray:
        """Points (..., 3) at positions [m], on the straight continuation beyond the ends."""
        s = np.asarray(position, float)
        last = len(self.position) - 2
        segment = np.clip(np.searchsorted(self.position, s, side="right") - 1, 0, last)
        begin, end = self.position[segment], self.position[segment + 1]
        share = ((s - begin) / (end - begin))[..., None]
        return np.asarray((1.0 - share) * self.points[segment] + share * self.points[segment + 1])


def _heights(structure: Structure, model: Model, path: PolynomialPath) -> FloatArray:
    """Heights z (n,) at the breaks: of the nodes whose vertical d.o.f. carry the line there."""
    table = dof_table(model)
    z_of = np.full(table.size, np.nan)
    number = table.number[:, 2]
    z_of[number[number >= 0]] = model.points[number >= 0, 2]
    height = z_of[structure.system.independent]
    dofs, weights = path.weights(path.breaks)
    share = np.where(np.isnan(height[dofs]), 0.0, np.abs(weights))
    total = share.sum(axis=1)
    mean = (share * np.nan_to_num(height[dofs])).sum(axis=1)
    return np.asarray(np.divide(mean, total, out=np.zeros_like(mean), where=total > 0.0))
