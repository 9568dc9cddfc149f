"""Shell parts: flat shell elements of one kind that share a material."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.elements import shells
from axlespan.elements.shells import ShellMaterial
from axlespan.errors import InputError
from axlespan.model.continuum_parts import named_error
from axlespan.model.dofs import COMPONENTS, nearest
from axlespan.model.materials import Material, require_positive
from axlespan.model.parts import ElementMatrices

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_KINDS: Mapping[str, shells.ShellKind] = {"tri3": "shell3", "quad4": "shell4"}
_NODE_COUNT = {"tri3": 3, "quad4": 4}


@dataclass(frozen=True, eq=False)
class ShellPart:
    """Shells of one kind, triangles or quadrilaterals.

    `ShellPart.of` builds one from a material.
    """

    name: str
    kind: str  # tri3 or quad4
    nodes: IntArray  # (n_element, n_node), on the reference surface
    material: ShellMaterial
    density: float  # [kg/m^3]
    thickness: FloatArray  # () or (n_element,) [m]
    offset: FloatArray  # from the reference surface to the mid-surface along the normal, as the thickness [m]
    lumped_mass: bool = False
    turning: FloatArray = field(
        default_factory=lambda: np.zeros(())
    )  # of a curved surface, as the thickness [rad]
    mixed: npt.NDArray[np.bool_] | None = (
        None  # (n_element, 3) sides of triangles that a quadrilateral shares
    )
    labels: IntArray | None = None  # (n_element,) what errors call the elements; 1, 2, … when left out
    components: tuple[str, ...] = COMPONENTS

    def __post_init__(self) -> None:
        require_positive(self.density, "density", zero=True)
        if self.kind not in _KINDS:
            raise nearest(self.kind, list(_KINDS), "kind of shell element")
        per_element: tuple[tuple[int, ...], ...] = ((), (len(self.nodes),))
        for what, shape, allowed in (
            ("nodes", np.shape(self.nodes), ((len(self.nodes), _NODE_COUNT[self.kind]),)),
            ("thickness", np.shape(self.thickness), per_element),
            ("offset", np.shape(self.offset), per_element),
            ("turning", np.shape(self.turning), per_element),
        ):
            if shape not in allowed:
                rule = f"must have the shape {' or '.join(str(s) for s in allowed)} for {self.kind}"
                raise InputError(rule, field=f"{what} of '{self.name}'", value=shape)

    @classmethod
    def of(
        cls,
        name: str,
        kind: str,
        nodes: npt.ArrayLike,
        material: Material | ShellMaterial,
        *,
        thickness: npt.ArrayLike,
        density: float | None = None,
        offset: npt.ArrayLike = 0.0,
        lumped_mass: bool = False,
        turning: npt.ArrayLike = 0.0,
        labels: IntArray | None = None,
    ) -> ShellPart:
        """Return shells of a material.

        Parameters
        ----------
        name : str
            Name of the part.
        kind : {"quad4", "tri3"}
        nodes : array (n_element, n_node)
            Nodes of the elements; the normal follows from their order by the right-hand rule.
        material : Material or ShellMaterial
            An isotropic material with its density, or an orthotropic shell material.
        thickness : float or array (n_element,)
            [m].
        density : float, optional
            ρ [kg/m^3]; that of the material when left out.
        offset : float or array (n_element,)
            From the reference surface, where the nodes are, to the mid-surface, along the normal [m].
        lumped_mass : bool
            Lumped mass matrices, diagonal where there is no offset.
        turning : float or array (n_element,)
            Of a curved surface, from `axlespan.elements.shells.surface_turning` [rad].
        labels : array (n_element,), optional
            Numbers of the elements for error messages.

        Raises
        ------
        InputError
            If the kind is unknown, the nodes don't fit it, or a value is not positive.
        """
        if isinstance(material, Material):
            density = material.density if density is None else density
            material = ShellMaterial.isotropic(material.youngs_modulus, material.poisson_ratio)
        if density is None:
            raise InputError("must be given with a shell material", field="density", value=None)
        t = np.asarray(thickness, float)
        for value in np.unique(t).tolist():
            require_positive(value, "thickness")
        elements, reach = np.asarray(nodes, dtype=np.int64), np.asarray(offset, float)
        if not np.all(np.isfinite(reach)):
            raise InputError("must be finite", field="offset", value=offset)
        turned = np.asarray(turning, float)
        return cls(name, kind, elements, material, density, t, reach, lumped_mass, turned, labels=labels)

    @property
    def shell_kind(self) -> shells.ShellKind:
        """Kind of the elements in `axlespan.elements.shells`."""
        return _KINDS[self.kind]

    def coordinates(self, points: FloatArray) -> FloatArray:
        """Node coordinates (n_element, n_node, 3) [m]."""
        return points[self.nodes]

    def taken(self, elements: slice) -> ShellPart:
        """Return some of the elements as a part."""
        return replace(
            self,
            nodes=self.nodes[elements],
            material=_material_of(self.material, elements),
            thickness=_taken(self.thickness, elements),
            offset=_taken(self.offset, elements),
            turning=_taken(self.turning, elements),
            mixed=None if self.mixed is None else self.mixed[elements],
            labels=self._labels()[elements],
        )

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Stiffness and mass.

        Raises
        ------
        InputError
            If an element has no area or is not convex; it names the elements and the part.
        """
        self.check(points)
        x, kind, t, reach = self.coordinates(points), self.shell_kind, self.thickness, self.offset
        return ElementMatrices(
            shells.stiffness(
                kind, x, self.material, t, reach, self.turning, False if self.mixed is None else self.mixed
            ),
            shells.mass(kind, x, self.density, t, reach, self.lumped_mass),
        )

    def check(self, points: FloatArray) -> None:
        """Raise InputError for elements without area or not convex, by their labels."""
        bad = shells.check_geometry(self.shell_kind, self.coordinates(points)).degenerate
        if len(bad):
            named_error(bad, self._labels(), self.name)

    def displacement_rows(self, points: FloatArray, elements: IntArray, natural: FloatArray) -> FloatArray:
        """Displacements of the reference surface at natural points (n_chosen, n_point, 2).

        The result is an array (n_chosen, n_point, 3, n_dof).
        """
        x, reach = points[self.nodes[elements]], _taken(self.offset, elements)
        return shells.interpolation(self.shell_kind, x, natural, reach)

    def _labels(self) -> IntArray:
        return np.arange(1, len(self.nodes) + 1) if self.labels is None else self.labels


def _taken(values: FloatArray, elements: slice | IntArray) -> FloatArray:
    return values[elements] if values.ndim else values


def _material_of(material: ShellMaterial, elements: slice) -> ShellMaterial:
    """The material of some elements: values that are given one per element are taken."""
    own = {f.name: getattr(material, f.name) for f in fields(material)}
    some: dict[str, Any] = {
        k: v[elements] for k, v in own.items() if isinstance(v, np.ndarray) and v.ndim == 1
    }
    return replace(material, **some)
