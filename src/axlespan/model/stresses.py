"""Stresses of solids, resultants of shells and section forces of beams in the middles of elements.

They follow from displacements alone, for fields at chosen times and mode shapes. Of beams this is EI times the
curvature; what the inertia inside an element adds is of second order in its length.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements import beam_sections, plane, shells, solids
from axlespan.model.assembly import element_dofs
from axlespan.model.compile import dof_table
from axlespan.model.continuum_parts import PlanePart, SolidPart
from axlespan.model.model import Model
from axlespan.model.parts import BeamPart, Part
from axlespan.model.shell_parts import ShellPart

FloatArray = npt.NDArray[np.float64]
# displacements (n_element, n_dof) of a part -> name -> (n_element, n_component)
Read = Callable[[FloatArray], dict[str, FloatArray]]

#: Quantities with the number and the meaning of their components.
COMPONENTS_OF: dict[str, tuple[int, str]] = {
    "stress": (6, "xx, yy, zz, xy, yz, zx in global axes [N/m^2]"),
    "von_mises": (1, "of the stress [N/m^2]"),
    "shell_force": (3, "N_x, N_y, N_xy [N/m], x along global x on the surface"),
    "shell_moment": (3, "M_x, M_y, M_xy [N m/m]"),
    "shell_shear": (2, "Q_x, Q_y [N/m]"),
    "beam_force": (4, "moment, shear, normal force, torsion in the beam's axes [N m, N]"),
}

# Elements whose normal is closer to global x than this cosine take global y in its place.
_ALONG_X = 0.99
_TURNED = {"xx": 0, "zz": 2, "xz": 5}  # of plane elements in the x-z plane among the six


@dataclass(frozen=True, eq=False)
class ElementForces:
    """Reads stresses and forces in the middles of a model's elements from displacements."""

    n_element: tuple[int, ...]  # of each part of the model
    reads: tuple[tuple[int, npt.NDArray[np.int64], Read], ...]  # part, its d.o.f. (n_element, n_dof), reader

    @classmethod
    def of(cls, model: Model) -> ElementForces:
        """Prepare for a model."""
        table = dof_table(model)
        reads = []
        for i, part in enumerate(model.parts):
            read = _reader(part, model.points)
            if read is not None:
                reads.append((i, element_dofs(part, table), read))
        return cls(tuple(len(part.nodes) for part in model.parts), tuple(reads))

    def at(self, displacement: FloatArray) -> dict[str, FloatArray]:
        """Quantities (n_element, n_component) of all elements, part by part, from displacements (n_full,).

        Elements that don't have a quantity have nan.
        """
        ends = np.cumsum(self.n_element)
        found: dict[str, FloatArray] = {}
        for i, dofs, read in self.reads:
            for name, values in read(displacement[dofs]).items():
                empty = np.full((int(ends[-1]), COMPONENTS_OF[name][0]), np.nan)
                found.setdefault(name, empty)[ends[i] - self.n_element[i] : ends[i]] = values
        return found


def _reader(part: Part, points: FloatArray) -> Read | None:
    if isinstance(part, BeamPart):
        return _of_beams(part, points)
    if isinstance(part, SolidPart):
        return _of_solids(part, points)
    if isinstance(part, PlanePart):
        return _of_planes(part, points)
    if isinstance(part, ShellPart):
        return _of_shells(part, points)
    return None


def _of_beams(part: BeamPart, points: FloatArray) -> Read:
    ends, middle = part.coordinates(points), np.full(len(part.nodes), 0.5)
    rows, _ = beam_sections.section_rows(ends, part.properties, part.frame(points), middle)
    if part.offset is not None:
        rows = rows @ part.arms()
    rows = rows[:, :, part.kept()]
    return lambda u: {"beam_force": np.einsum("eqd,ed->eq", rows, u)}


def _of_solids(part: SolidPart, points: FloatArray) -> Read:
    center = part.element.nodes.mean(axis=0)[None]
    rows = solids.stress_matrix(
        part.element, part.coordinates(points), part.elasticity, center, part.formulation
    )
    return lambda u: _stresses(np.einsum("ecd,ed->ec", rows[:, 0], u))


def _of_planes(part: PlanePart, points: FloatArray) -> Read:
    center = part.element.nodes.mean(axis=0)[None]
    rows = plane.stress_matrix(
        part.element, part.coordinates(points), part.elasticity, center, part.formulation
    )

    def read(u: FloatArray) -> dict[str, FloatArray]:
        stress = np.zeros((len(u), 6))
        stress[:, list(_TURNED.values())] = np.einsum("ecd,ed->ec", rows[:, 0], u)
        return _stresses(stress)

    return read


def _stresses(stress: FloatArray) -> dict[str, FloatArray]:
    xx, yy, zz, xy, yz, zx = stress.T
    mises = 0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3.0 * (xy**2 + yz**2 + zx**2)
    return {"stress": stress, "von_mises": np.sqrt(mises)[:, None]}


def _of_shells(part: ShellPart, points: FloatArray) -> Read:
    x = part.coordinates(points)
    kind, center = part.shell_kind, np.array([[0.0, 0.0] if part.kind == "quad4" else [1.0 / 3.0] * 2])

    def read(u: FloatArray) -> dict[str, FloatArray]:
        found = shells.resultants(
            kind, x, part.material, part.thickness, u, part.offset, part.turning, natural=center
        )
        across = np.abs(found.axes[:, 2, 0]) > _ALONG_X
        turned = found.along(np.where(across[:, None], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]))
        return {
            "shell_force": turned.normal_forces[:, 0],
            "shell_moment": turned.moments[:, 0],
            "shell_shear": turned.shear_forces[:, 0],
        }

    return read
