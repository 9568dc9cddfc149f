"""Values by d.o.f. as values by node, and rigid motions of a model."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.model.compile import dof_table
from axlespan.model.dofs import COMPONENTS
from axlespan.model.model import Model

FloatArray = npt.NDArray[np.float64]


def nodal_values(model: Model, values: FloatArray) -> FloatArray:
    """Values (..., n_full) of the d.o.f. of a model as (..., n_node, 6); zero where there is no d.o.f."""
    number = dof_table(model).number
    result = np.zeros((*np.shape(values)[:-1], *number.shape))
    active = number >= 0
    result[..., active] = np.asarray(values)[..., number[active]]
    return result


def rigid_motion(model: Model, component: str, center: npt.ArrayLike = (0.0, 0.0, 0.0)) -> FloatArray:
    """Displacements (n_full,) of a rigid translation by 1 or a rotation by 1 about a center.

    Small rotations: the displacement of a node is θ × (x - center), its rotation θ.
    """
    axis = COMPONENTS.index(component)
    motion = np.zeros((len(model.points), 6))
    motion[:, axis] = 1.0
    if axis >= 3:
        motion[:, :3] = np.cross(np.eye(3)[axis - 3], model.points - np.asarray(center, float))
    number = dof_table(model).number
    active = number >= 0
    result = np.zeros(int(number.max(initial=-1)) + 1)
    result[number[active]] = motion[active]
    return result
