"""Solid and plane parts: continuum elements of one family that share a material."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from axlespan.elements import elasticity as laws
from axlespan.elements import plane, solids
from axlespan.elements.congruence import congruent
from axlespan.elements.continuum import ContinuumElement, Formulation, bad_elements, checked_formulation
from axlespan.errors import InputError
from axlespan.model.dofs import nearest
from axlespan.model.materials import Material, require_positive
from axlespan.model.parts import ElementMatrices

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
PlaneState = Literal["stress", "strain"]

# Positions of x and z: a plane model lies in the x-z plane, so the y of a plane element is z here.
_X_Z = (0, 2)
# The axes x, y, z of a material in those of a plane element: x, z and the normal -y.
_TURNED = ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))


@dataclass(frozen=True, eq=False)
class SolidPart:
    """Solid elements of one family.

    `SolidPart.of` builds one from a material.
    """

    name: str
    kind: str  # of axlespan.elements.solids.SOLIDS
    nodes: IntArray  # (n_element, n_node)
    elasticity: FloatArray  # (6, 6) or (n_element, 6, 6) [N/m^2]
    density: float  # [kg/m^3]
    formulation: Formulation = "incompatible"
    lumped_mass: bool = False
    labels: IntArray | None = None  # (n_element,) what errors call the elements; 1, 2, … when left out
    components: tuple[str, ...] = ("x", "y", "z")

    def __post_init__(self) -> None:
        _check(self, self.element)

    @classmethod
    def of(
        cls,
        name: str,
        kind: str,
        nodes: npt.ArrayLike,
        material: Material,
        *,
        elasticity: npt.ArrayLike | None = None,
        formulation: Formulation = "incompatible",
        lumped_mass: bool = False,
        labels: IntArray | None = None,
    ) -> SolidPart:
        """Return solids of a material.

        Parameters
        ----------
        name : str
            Name of the part.
        kind : {"hex8", "hex20", "tet4", "tet10", "wedge6"}
        nodes : array (n_element, n_node)
            Nodes of the elements, in the order of `axlespan.elements.shape_functions`.
        material : Material
            Its density counts in any case, its stiffness unless ``elasticity`` is given.
        elasticity : array (6, 6) or (n_element, 6, 6), optional
            Of an anisotropic material, in global axes [N/m^2]; see `axlespan.elements.elasticity`.
        formulation : {"incompatible", "full"}
            Of hex8: with incompatible modes, or plain displacements (stiff in bending).
        lumped_mass : bool
            Diagonal mass matrices.
        labels : array (n_element,), optional
            Numbers of the elements for error messages.

        Raises
        ------
        InputError
            If the kind or the formulation is unknown, or the nodes don't fit the kind.
        """
        law = laws.isotropic(material.youngs_modulus, material.poisson_ratio)
        law = law if elasticity is None else np.asarray(elasticity, float)
        elements = np.asarray(nodes, dtype=np.int64)
        return cls(name, kind, elements, law, material.density, formulation, lumped_mass, labels)

    @property
    def element(self) -> solids.SolidElement:
        """Family of the elements."""
        if self.kind not in solids.SOLIDS:
            raise nearest(self.kind, list(solids.SOLIDS), "kind of solid element")
        return solids.SOLIDS[self.kind]

    def coordinates(self, points: FloatArray) -> FloatArray:
        """Node coordinates (n_element, n_node, 3) [m]."""
        return points[self.nodes]

    def taken(self, elements: slice) -> SolidPart:
        """Return some of the elements as a part."""
        law, labels = _taken(self.elasticity, elements, 3), _labels(self)[elements]
        return replace(self, nodes=self.nodes[elements], elasticity=law, labels=labels)

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Stiffness and mass.

        Raises
        ------
        InputError
            If an element is inverted or degenerate; it names the elements and the part.
        """
        x = self.coordinates(points)
        check_shapes(self.element, x, _labels(self), self.name)
        return ElementMatrices(
            solids.stiffness(self.element, x, self.elasticity, self.formulation),
            solids.mass(self.element, x, self.density, self.lumped_mass),
        )


@dataclass(frozen=True, eq=False)
class PlanePart:
    """Plane elements of one family in a plane model, whose plane is x-z.

    `PlanePart.of` builds one from a material.
    """

    name: str
    kind: str  # of axlespan.elements.plane.PLANES
    nodes: IntArray  # (n_element, n_node), counterclockwise where x points to the right and z upward
    elasticity: FloatArray  # (3, 3) or (n_element, 3, 3), components xx, zz, xz [N/m^2]
    density: float  # [kg/m^3]
    thickness: FloatArray  # () or (n_element,) [m]
    formulation: Formulation = "incompatible"
    lumped_mass: bool = False
    labels: IntArray | None = None  # (n_element,) what errors call the elements; 1, 2, … when left out
    components: tuple[str, ...] = ("x", "z")

    def __post_init__(self) -> None:
        _check(self, self.element)

    @classmethod
    def of(
        cls,
        name: str,
        kind: str,
        nodes: npt.ArrayLike,
        material: Material,
        *,
        thickness: npt.ArrayLike = 1.0,
        state: PlaneState = "stress",
        elasticity: npt.ArrayLike | None = None,
        formulation: Formulation = "incompatible",
        lumped_mass: bool = False,
        labels: IntArray | None = None,
    ) -> PlanePart:
        """Return plane elements of a material.

        Parameters
        ----------
        name, nodes, material, formulation, lumped_mass, labels
            As for `SolidPart.of`.
        kind : {"quad4", "quad8", "tri3", "tri6"}
        thickness : float or array (n_element,)
            Width along y [m].
        state : {"stress", "strain"}
            Plane stress (free to expand along y: walls, webs) or plane strain (a slice of something long).
        elasticity : array (6, 6), optional
            Of an anisotropic material, in global axes [N/m^2].
        """
        if state not in ("stress", "strain"):
            raise InputError("must be 'stress' or 'strain'", field="state", value=state)
        law = laws.isotropic(material.youngs_modulus, material.poisson_ratio)
        if elasticity is not None:
            law = laws.rotated(laws.check_elasticity(elasticity, 6), _TURNED)
        reduced = laws.plane_stress(law) if state == "stress" else laws.plane_strain(law)
        width = np.asarray(thickness, float)
        for value in np.unique(width).tolist():
            require_positive(value, "thickness")
        elements = np.asarray(nodes, dtype=np.int64)
        return cls(name, kind, elements, reduced, material.density, width, formulation, lumped_mass, labels)

    @property
    def element(self) -> plane.PlaneElement:
        """Family of the elements."""
        if self.kind not in plane.PLANES:
            raise nearest(self.kind, list(plane.PLANES), "kind of plane element")
        return plane.PLANES[self.kind]

    def coordinates(self, points: FloatArray) -> FloatArray:
        """Node coordinates x and z (n_element, n_node, 2) [m]."""
        return points[self.nodes][:, :, _X_Z]

    def taken(self, elements: slice) -> PlanePart:
        """Return some of the elements as a part."""
        law, labels = _taken(self.elasticity, elements, 3), _labels(self)[elements]
        width = _taken(self.thickness, elements, 1)
        return replace(self, nodes=self.nodes[elements], elasticity=law, thickness=width, labels=labels)

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Stiffness and mass.

        Raises
        ------
        InputError
            If an element is inverted or degenerate; it names the elements and the part.
        """
        x = self.coordinates(points)
        check_shapes(self.element, x, _labels(self), self.name)
        k = plane.stiffness(self.element, x, self.elasticity, self.thickness, self.formulation)
        m = plane.mass(self.element, x, self.density, self.thickness, self.lumped_mass)
        return ElementMatrices(k, m)


def check_shapes(element: ContinuumElement, coordinates: FloatArray, labels: IntArray, name: str) -> None:
    """Raise InputError for inverted and degenerate elements, by their labels; congruent ones are looked at once."""
    classes = congruent(coordinates)
    bad = bad_elements(element, coordinates[classes.first])
    if len(bad):
        named_error(np.flatnonzero(np.isin(classes.label, bad)), labels, name)


def named_error(bad: IntArray, labels: IntArray, name: str) -> None:
    """Raise InputError for inverted or degenerate elements of a part."""
    shown = ", ".join(str(label) for label in labels[bad[:8]].tolist())
    raise InputError(
        "must not be inverted or degenerate",
        field=f"elements of '{name}'",
        value=f"{shown}{', …' if len(bad) > 8 else ''}",
        fix="Repair the mesh, or the order of the nodes of these elements",
    )


def _labels(part: SolidPart | PlanePart) -> IntArray:
    return np.arange(1, len(part.nodes) + 1) if part.labels is None else part.labels


def _taken(values: FloatArray, elements: slice, ndim: int) -> FloatArray:
    return values[elements] if values.ndim == ndim else values


def _check(part: SolidPart | PlanePart, element: ContinuumElement) -> None:
    checked_formulation(part.formulation)
    require_positive(part.density, "density", zero=True)
    n_element = len(part.nodes)
    for what, shape, allowed in (
        ("nodes", np.shape(part.nodes), ((n_element, element.node_count),)),
        ("labels", np.shape(_labels(part)), ((n_element,),)),
        ("thickness", np.shape(getattr(part, "thickness", 0.0)), ((), (n_element,))),
    ):
        if shape not in allowed:
            raise InputError(
                f"must have the shape {' or '.join(str(s) for s in allowed)} for {element.name}",
                field=f"{what} of '{part.name}'",
                value=shape,
            )
