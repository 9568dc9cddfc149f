"""Parts of a model: elements of one family that share a material and a section.

A part knows its nodes and which components it needs, and gives its element matrices. A new element
family is one more small class with the same four members.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from axlespan.elements import beam, discrete
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.dofs import COMPONENTS, component_indices

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True)
class ElementMatrices:
    """Matrices (n_element, n_dof, n_dof) of a part; None where there are none."""

    stiffness: FloatArray | None = None
    mass: FloatArray | None = None
    damping: FloatArray | None = None


class Part(Protocol):
    """What a model needs from its parts."""

    @property
    def name(self) -> str:
        """Name of the part."""
        ...

    @property
    def nodes(self) -> IntArray:
        """Nodes (n_element, n_node) of each element."""
        ...

    @property
    def components(self) -> tuple[str, ...]:
        """Components that each of its nodes has."""
        ...

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Element matrices in global axes, d.o.f. node by node."""
        ...


@dataclass(frozen=True, eq=False)
class BeamPart:
    """Beams between pairs of nodes, or beside them: rigid arms of the given offsets then hold their ends."""

    name: str
    nodes: IntArray  # (n_element, 2)
    properties: BeamProperties
    components: tuple[str, ...] = COMPONENTS
    up: FloatArray | None = None  # a direction in the local x-z plane, (3,) or (n_element, 3)
    offset: FloatArray | None = None  # from the nodes to the ends, global axes, (3,) or (n_element, 2, 3) [m]

    def coordinates(self, points: FloatArray) -> FloatArray:
        """Ends of the axes (n_element, 2, 3) [m]."""
        return points[self.nodes] if self.offset is None else points[self.nodes] + self.offset

    def frame(self, points: FloatArray) -> FloatArray:
        """Local axes (n_element, 3, 3) as rows."""
        return beam.frames(self.coordinates(points), self.up)

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Element matrices, reduced to the part's components."""
        ends = self.coordinates(points)
        self._check(ends)
        frame = self.frame(points)
        keep = self.kept()
        pick = np.ix_(np.arange(len(ends)), keep, keep)
        k = beam.stiffness(ends, self.properties, frame)
        m = beam.mass(ends, self.properties, frame)
        if self.offset is not None:
            arms = self.arms()
            k, m = (arms.transpose(0, 2, 1) @ matrix @ arms for matrix in (k, m))
        return ElementMatrices(k[pick], m[pick])

    def kept(self) -> IntArray:
        """Positions of the part's d.o.f. among the 12 of a beam in space."""
        own = component_indices(self.components)
        return np.concatenate([own, own + 6])

    def polynomials(self, points: FloatArray, direction: FloatArray) -> FloatArray:
        """Displacement along a direction as polynomials (n_element, n_dof, 4) of the part's d.o.f."""
        full = beam.displacement_polynomials(
            self.coordinates(points), self.properties, self.frame(points), direction
        )
        if self.offset is not None:
            full = self.arms().transpose(0, 2, 1) @ full
        return full[:, self.kept()]

    def arms(self) -> FloatArray:
        """Displacements of the ends per displacements of the nodes (n_element, 12, 12)."""
        offset = np.broadcast_to(np.asarray(self.offset), (len(self.nodes), 2, 3))
        result = np.zeros((len(offset), 12, 12))
        for end, where in enumerate((slice(0, 6), slice(6, 12))):
            result[:, where, where] = discrete.rigid_arm(offset[:, end])
        return result

    def _check(self, ends: FloatArray) -> None:
        length = beam.lengths(ends)
        if np.any(length <= 0.0):
            bad = int(np.argmin(length))
            raise InputError(
                "must have a positive length", field=f"beam {bad + 1} of part '{self.name}'", value=0.0
            )
        if "x" not in self.components and np.any(np.abs(ends[:, 1, 2] - ends[:, 0, 2]) > 1e-9 * length):
            raise InputError(
                "must be horizontal when they carry no axial force",
                field=f"beams of part '{self.name}'",
                fix="Give the section an area",
            )


@dataclass(frozen=True, eq=False)
class BarPart:
    """Bars (trusses) between pairs of nodes: axial force only."""

    name: str
    nodes: IntArray  # (n_element, 2)
    axial_stiffness: FloatArray  # EA (n_element,) [N]
    mass_per_length: FloatArray  # (n_element,) [kg/m]
    components: tuple[str, ...] = ("x", "y", "z")

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Element matrices, reduced to the part's components."""
        own = component_indices(self.components)
        keep = np.concatenate([own, own + 3])
        pick = np.ix_(np.arange(len(self.nodes)), keep, keep)
        k = discrete.bar_stiffness(points[self.nodes], self.axial_stiffness)
        return ElementMatrices(k[pick], discrete.bar_mass(points[self.nodes], self.mass_per_length)[pick])


@dataclass(frozen=True, eq=False)
class SpringPart:
    """Springs and dashpots between equal components of two nodes, whatever the distance between them."""

    name: str
    nodes: IntArray  # (n_element, 2)
    stiffness: FloatArray  # (n_element, n_component) [N/m, N m/rad]
    damping: FloatArray  # (n_element, n_component) [N s/m, N m s/rad]
    components: tuple[str, ...] = ("z",)

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Element matrices; damping only where there is any."""
        damping = discrete.coupling(self.damping) if np.any(self.damping) else None
        stiffness = discrete.coupling(self.stiffness) if np.any(self.stiffness) else None
        return ElementMatrices(stiffness=stiffness, damping=damping)


@dataclass(frozen=True, eq=False)
class MassPart:
    """Point masses with rotary inertia."""

    name: str
    nodes: IntArray  # (n_element, 1)
    inertia: FloatArray  # (n_element, n_component) [kg, kg m^2]
    components: tuple[str, ...] = ("z",)

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Element matrices (mass only)."""
        return ElementMatrices(mass=discrete.point_mass(self.inertia))


def checked_offset(offset: npt.ArrayLike | None, n_element: int) -> FloatArray | None:
    """Return the offset of beams as an array (3,) or (n_element, 2, 3), None where it is zero.

    Raises
    ------
    InputError
        If it has another shape or is not finite.
    """
    if offset is None:
        return None
    array = np.asarray(offset, float)
    if array.shape not in ((3,), (n_element, 2, 3)):
        raise InputError(
            f"must have the shape (3,) or ({n_element}, 2, 3)", field="offset of beams", value=array.shape
        )
    if not np.all(np.isfinite(array)):
        raise InputError("must be finite", field="offset of beams", value=array.ravel()[:6].tolist())
    return array if np.any(array != 0.0) else None
