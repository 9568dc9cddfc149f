"""Shell parts: flat shell elements of one kind that share a material."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_checks, shell_interpolation, shells
from axlespan.elements.shell_geometry import NODE_COUNT, ShellKind
from axlespan.elements.shell_loads import mass
from axlespan.elements.shell_material import ShellMaterial
from axlespan.errors import InputError
from axlespan.model.continuum_parts import named_error
from axlespan.model.dofs import COMPONENTS, nearest
from axlespan.model.materials import Material, require_positive
from axlespan.model.parts import ElementMatrices

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_KINDS: dict[str, ShellKind] = {"tri3": "shell3", "quad4": "shell4"}


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
    side_normals: FloatArray | None = None  # (n_element, n_node, 3) of a curved surface
    labels: IntArray | None = None  # (n_element,) what errors call the elements; 1, 2, … when left out
    components: tuple[str, ...] = COMPONENTS

    def __post_init__(self) -> None:
        require_positive(self.density, "density", zero=True)
        count = NODE_COUNT[self.shell_kind]
        per_element: tuple[tuple[int, ...], ...] = ((), (len(self.nodes),))
        for what, shape, allowed in (
            ("nodes", np.shape(self.nodes), ((len(self.nodes), count),)),
            ("thickness", np.shape(self.thickness), per_element),
            ("offset", np.shape(self.offset), per_element),
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
        side_normals: FloatArray | None = None,
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
        side_normals : array (n_element, n_node, 3), optional
            Of a curved surface; see `axlespan.elements.shell_normals`.
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
        return cls(name, kind, elements, material, density, t, reach, lumped_mass, side_normals, labels)

    @property
    def shell_kind(self) -> ShellKind:
        """Kind of the elements in `axlespan.elements.shells`."""
        if self.kind not in _KINDS:
            raise nearest(self.kind, list(_KINDS), "kind of shell element")
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
            thickness=self.thickness[elements] if self.thickness.ndim else self.thickness,
            offset=self.offset[elements] if self.offset.ndim else self.offset,
            side_normals=None if self.side_normals is None else self.side_normals[elements],
            labels=self._labels()[elements],
        )

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """Stiffness and mass.

        Raises
        ------
        InputError
            If an element has no area or is not convex; it names the elements and the part.
        """
        x, kind = self.coordinates(points), self.shell_kind
        bad = shell_checks.check_geometry(kind, x).degenerate
        if len(bad):
            named_error(bad, self._labels(), self.name)
        t, reach = self.thickness, self.offset
        return ElementMatrices(
            shells.stiffness(kind, x, self.material, t, reach, self.side_normals),
            mass(kind, x, self.density, t, reach, self.lumped_mass),
        )

    def displacement_rows(self, points: FloatArray, elements: IntArray, natural: FloatArray) -> FloatArray:
        """Displacements of the reference surface (n_chosen, n_point, 3, n_dof) at natural points (n_point, 2)."""
        reach = self.offset[elements] if self.offset.ndim else self.offset
        x = self.coordinates(points)[elements]
        return shell_interpolation.interpolation(self.shell_kind, x, natural, reach)

    def _labels(self) -> IntArray:
        return np.arange(1, len(self.nodes) + 1) if self.labels is None else self.labels


def _material_of(material: ShellMaterial, elements: slice) -> ShellMaterial:
    """The material of some elements: values that are given one per element are taken."""
    own = {f.name: getattr(material, f.name) for f in fields(material)}
    return replace(
        material, **{k: v[elements] for k, v in own.items() if isinstance(v, np.ndarray) and v.ndim == 1}
    )
