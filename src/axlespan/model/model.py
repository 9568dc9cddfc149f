"""A finite element model: nodes, parts, ties, supports, damping and loads; it compiles to a System."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from axlespan.card import Card, Shown, some
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.damping import Damping, Rayleigh
from axlespan.model.dofs import COMPONENTS, component_indices, nearest
from axlespan.model.from_mesh import Section, parts_from_mesh
from axlespan.model.materials import require_positive
from axlespan.model.mesh import Mesh
from axlespan.model.motions import Constant, Motion
from axlespan.model.nonlinear import NonlinearPart, SpringLaw
from axlespan.model.parts import BarPart, BeamPart, MassPart, Part, SpringPart, checked_offset

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_PLANE = ("x", "z", "ry")
_NUMBERED = re.compile(r"n\d+")


@dataclass(frozen=True)
class Support:
    """A prescribed d.o.f."""

    name: str
    node: int
    component: str
    motion: Motion


@dataclass(frozen=True)
class Tie:
    """A d.o.f. that follows others: u_slave = Σ coefficient · u_master."""

    slave: tuple[int, str]
    masters: tuple[tuple[int, str, float], ...]


@dataclass(frozen=True)
class NodalLoad:
    """A force [N] or moment [N m] at a node, with an optional history factor of time."""

    node: int
    component: str
    amount: float
    history: Callable[[FloatArray], FloatArray] | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Model(Shown):
    """A model in the x-z plane (``plane=True``: components x, z, ry) or in space (all six).

    Models don't change: every ``with_…`` returns a new one.
    """

    points: FloatArray = field(default_factory=lambda: np.empty((0, 3)))  # (n_node, 3) [m]
    plane: bool = True
    node_names: Mapping[str, int] = field(default_factory=dict)
    parts: tuple[Part, ...] = ()
    supports: tuple[Support, ...] = ()
    ties: tuple[Tie, ...] = ()
    loads: tuple[NodalLoad, ...] = ()
    damping: Damping | None = None
    part_damping: Mapping[str, Rayleigh] = field(default_factory=dict)  # of parts by name, beside damping
    node_sets: Mapping[str, IntArray] = field(default_factory=dict)  # from meshes

    # --- nodes -------------------------------------------------------------------------------

    def with_nodes(self, points: npt.ArrayLike, names: Sequence[str] | None = None) -> Model:
        """Append nodes at points (n, 3), or (n, 2) as x and z; the first ones get the names given.

        Parameters
        ----------
        points : array (n, 3) or (n, 2)
            Coordinates [m].
        names : sequence of str, optional
            Of the first nodes.

        Raises
        ------
        InputError
            If coordinates are not finite, have y in a plane model, or a name is taken.
        """
        new = np.atleast_2d(np.asarray(points, float))
        if new.shape[1] == 2:
            new = np.column_stack([new[:, 0], np.zeros(len(new)), new[:, 1]])
        if not np.all(np.isfinite(new)):
            raise InputError(
                "must be finite",
                field="node coordinates",
                value=new[~np.isfinite(new).all(axis=1)][0].tolist(),
            )
        if self.plane and np.any(new[:, 1] != 0.0):
            raise InputError("must have y = 0 in a plane model", field="node coordinates")
        labels = dict(self.node_names)
        if len(names or ()) > len(new):
            raise InputError(
                f"must be at most one for each of the {len(new)} nodes",
                field="names",
                value=list(names or ()),
            )
        for i, name in enumerate(names or ()):
            if name[:1] == "n" and name[1:].isdigit() and int(name[1:]) != len(self.points) + i + 1:
                raise InputError("is the name of another node by its number", field="node", value=name)
            if name in labels:
                raise InputError("is already the name of a node", field="node", value=name)
            labels[name] = len(self.points) + i
        return replace(self, points=np.vstack([self.points, new]), node_names=labels)

    def node(self, reference: int | str) -> int:
        """Index of a node, from its index or its name.

        Raises
        ------
        InputError
            If there is no such node.
        """
        if isinstance(reference, str):
            if reference in self.node_names:
                return self.node_names[reference]
            if (
                reference[:1] == "n"
                and reference[1:].isdigit()
                and 0 < int(reference[1:]) <= len(self.points)
            ):
                return int(reference[1:]) - 1
            raise nearest(reference, list(self.node_names), "node")
        if not 0 <= int(reference) < len(self.points):
            raise InputError(
                f"must be a node between 0 and {len(self.points) - 1}", field="node", value=reference
            )
        return int(reference)

    def nodes_of(self, reference: str | int | Sequence[int | str] | IntArray) -> IntArray:
        """Indices of the nodes of a set, or of one or several nodes.

        Raises
        ------
        InputError
            If there is no such set or node.
        """
        if isinstance(reference, str):
            if reference in self.node_sets:
                return self.node_sets[reference]
            known = [*self.node_names, *self.node_sets]
            if reference not in known and not _NUMBERED.fullmatch(reference):
                raise nearest(reference, known, "node or set of nodes")
        items = [reference] if isinstance(reference, (str, int, np.integer)) else list(reference)
        return np.array([self.node(item) for item in items], dtype=np.int64)

    def node_label(self, index: int) -> str:
        """Name of a node; ``n1``, ``n2``, … for those without one."""
        for name, i in self.node_names.items():
            if i == index:
                return name
        return f"n{index + 1}"

    def node_labels(self) -> list[str]:
        """Names of all nodes."""
        labels = [f"n{i + 1}" for i in range(len(self.points))]
        for name, i in self.node_names.items():
            labels[i] = name
        return labels

    # --- parts -------------------------------------------------------------------------------

    def with_part(self, part: Part) -> Model:
        """Append a part.

        Parameters
        ----------
        part : Part
            Elements with their nodes and components; see :mod:`axlespan.model.parts`.

        Raises
        ------
        InputError
            If it names nodes that the model does not have.
        """
        nodes = np.asarray(part.nodes)
        if nodes.size and (nodes.min() < 0 or nodes.max() >= len(self.points)):
            raise InputError(
                f"must use nodes between 0 and {len(self.points) - 1}",
                field=f"part '{part.name}'",
                value=int(nodes.max()),
            )
        return replace(self, parts=(*self.parts, part))

    def with_mesh(self, mesh: Mesh, sections: Mapping[str, Section]) -> Model:
        """Append the nodes of a mesh, its node sets, and parts for its element sets.

        Parameters
        ----------
        mesh : Mesh
            Element sets count as sets of their nodes too.
        sections : mapping of str to Section
            What each element set is made of, see :mod:`axlespan.model.from_mesh`.
        """
        first = len(self.points)
        parts = parts_from_mesh(mesh, sections, first_node=first, in_plane=self.plane)
        sets = dict(self.node_sets)
        for name in {**mesh.element_sets, **mesh.node_sets}:
            own = mesh.nodes_of_set(name) + first
            sets[name] = np.concatenate([sets[name], own]) if name in sets else own
        return replace(self.with_nodes(mesh.points), parts=(*self.parts, *parts), node_sets=sets)

    def with_beams(
        self,
        nodes: npt.ArrayLike,
        properties: BeamProperties,
        *,
        name: str = "beams",
        up: npt.ArrayLike | None = None,
        offset: npt.ArrayLike | None = None,
    ) -> Model:
        """Append beams between pairs of nodes (n_element, 2), or beside them by an offset (3,) [m].

        In a plane model, beams without axial stiffness have no d.o.f. along x.

        Parameters
        ----------
        nodes : array (n_element, 2)
            Numbers of the end nodes.
        properties : BeamProperties
            Stiffness and mass, as from :meth:`BeamSection.properties`.
        name : str
            Of the part.
        up : array (3,) or (n_element, 3), optional
            A direction [-] in the plane of vertical bending, the local x-z plane; found when left out.
        offset : array (3,) or (n_element, 3), optional
            From the nodes to the axis of the beams [m].
        """
        components: tuple[str, ...] = COMPONENTS
        if self.plane:
            components = _PLANE if np.any(np.asarray(properties.axial_stiffness) > 0.0) else ("z", "ry")
        direction = None if up is None else np.asarray(up, float)
        pairs = _pairs(nodes)
        arm = checked_offset(offset, len(pairs))
        return self.with_part(BeamPart(name, pairs, properties, components, direction, arm))

    def with_bars(
        self,
        nodes: npt.ArrayLike,
        axial_stiffness: npt.ArrayLike,
        mass_per_length: npt.ArrayLike = 0.0,
        *,
        name: str = "bars",
    ) -> Model:
        """Append bars between pairs of nodes (n_element, 2): EA [N], mass [kg/m].

        Parameters
        ----------
        nodes : array (n_element, 2)
            Numbers of the end nodes.
        axial_stiffness : float or array (n_element,)
            EA [N].
        mass_per_length : float or array (n_element,)
            [kg/m].
        name : str
            Of the part.
        """
        pairs = _pairs(nodes)
        n = (len(pairs),)
        part = BarPart(
            name,
            pairs,
            np.broadcast_to(np.asarray(axial_stiffness, float), n),
            np.broadcast_to(np.asarray(mass_per_length, float), n),
            ("x", "z") if self.plane else ("x", "y", "z"),
        )
        return self.with_part(part)

    def with_springs(
        self,
        nodes: npt.ArrayLike,
        stiffness: Mapping[str, float] | None = None,
        damping: Mapping[str, float] | None = None,
        *,
        name: str = "springs",
    ) -> Model:
        """Append springs and dashpots between pairs of nodes, by component: ``{"z": 1.6e6}``.

        Parameters
        ----------
        nodes : array (n_spring, 2)
            Numbers of the end nodes.
        stiffness, damping : mapping of component to float, optional
            [N/m] and [N s/m]; of rotations [N m/rad] and [N m s/rad].
        name : str
            Of the part.
        """
        k, c = dict(stiffness or {}), dict(damping or {})
        components = tuple(part for part in COMPONENTS if part in k or part in c)
        component_indices(tuple({*k, *c}))
        for table, what in ((k, "stiffness"), (c, "damping")):
            for component, value in table.items():
                require_positive(value, f"{what} {component}", zero=True)
        pairs = _pairs(nodes)
        shape = (len(pairs), len(components))
        springs = np.broadcast_to([k.get(component, 0.0) for component in components], shape)
        dashpots = np.broadcast_to([c.get(component, 0.0) for component in components], shape)
        return self.with_part(SpringPart(name, pairs, springs, dashpots, components))

    def with_nonlinear_springs(
        self,
        nodes: npt.ArrayLike,
        law: SpringLaw,
        component: str = "z",
        *,
        gap: npt.ArrayLike = 0.0,
        name: str = "nonlinear springs",
    ) -> Model:
        """Append springs or dashpots of a law between pairs of nodes, along one component.

        Parameters
        ----------
        nodes : array (n_spring, 2)
            Numbers of the end nodes; the elongation is the second one's displacement less the first one's.
        law : SpringLaw
            See :mod:`axlespan.model.nonlinear`.
        gap : float or array (n_spring,)
            Added to the elongation [m]: a spring that only pushes touches when it is shortened by its gap.
        component : str
            Along which they act.
        name : str
            Of the part.

        Raises
        ------
        InputError
            If the component is unknown, or a gap is not finite.
        """
        component_indices((component,))
        pairs = _pairs(nodes)
        gaps = np.broadcast_to(np.asarray(gap, float), (len(pairs),)).copy()
        if not np.all(np.isfinite(gaps)):
            raise InputError("must be finite", field="gap")
        return self.with_part(NonlinearPart(name, pairs, law, gaps, (component,)))

    def with_mass(
        self,
        node: int | str,
        mass: float,
        inertia: Mapping[str, float] | None = None,
        *,
        directions: Sequence[str] | None = None,
        name: str = "mass",
    ) -> Model:
        """Append a point mass [kg] with rotary inertia by component [kg m^2]: ``{"ry": 2e6}``.

        The mass moves in all directions of the model unless ``directions`` names some of them.

        Parameters
        ----------
        node : int or str
        mass : float
            [kg].
        inertia : mapping of component to float, optional
            Rotary inertia [kg m^2].
        directions : sequence of str, optional
            Directions in which the mass acts.
        name : str
            Of the part.
        """
        moments = dict(inertia or {})
        require_positive(mass, "mass", zero=True)
        for component, value in moments.items():
            require_positive(value, f"inertia {component}", zero=True)
        translations = tuple(directions or self._translations_at(self.node(node)))
        components = (*translations, *(part for part in COMPONENTS[3:] if part in moments))
        values = [[mass] * len(translations) + [moments[part] for part in components[len(translations) :]]]
        return self.with_part(MassPart(name, np.array([[self.node(node)]]), np.array(values), components))

    def _translations_at(self, node: int) -> tuple[str, ...]:
        """Directions in which a node moves: those of the elements that it has, all if it has none yet."""
        there = {part for item in self.parts if np.any(item.nodes == node) for part in item.components}
        every = ("x", "z") if self.plane else ("x", "y", "z")
        return tuple(part for part in every if not there or part in there)

    # --- ties, supports, loads, damping ---------------------------------------------------------

    def with_tie(
        self, slave: tuple[int | str, str], masters: Sequence[tuple[int | str, str, float]]
    ) -> Model:
        """Append a tie: the slave d.o.f. (node, component) = Σ coefficient · (node, component)."""
        return replace(self, ties=(*self.ties, self._tie(slave, masters)))

    def _tie(self, slave: tuple[int | str, str], masters: Sequence[tuple[int | str, str, float]]) -> Tie:
        resolved = tuple((self.node(node), component, float(factor)) for node, component, factor in masters)
        component_indices((slave[1], *(component for _, component, _ in resolved)))
        return Tie((self.node(slave[0]), slave[1]), resolved)

    def with_rigid_link(
        self, master: int | str, slaves: Sequence[int | str], components: Sequence[str] | None = None
    ) -> Model:
        """Bind nodes to a master node as one rigid body (small rotations): u + θ × arm.

        Parameters
        ----------
        master : int or str
            Node that leads.
        slaves : sequence of int or str
            Nodes that follow.
        components : sequence of str, optional
            Those that follow; all that the model has when left out.
        """
        chosen = tuple(components or (_PLANE if self.plane else COMPONENTS))
        ties, head = list(self.ties), self.node(master)
        for reference in slaves:
            tail = self.node(reference)
            x, y, z = self.points[tail] - self.points[head]
            lever = {
                "x": (("ry", z), ("rz", -y)),
                "y": (("rx", -z), ("rz", x)),
                "z": (("rx", y), ("ry", -x)),
            }
            for component in chosen:
                terms = [(head, component, 1.0)]
                terms += [(head, rotation, arm) for rotation, arm in lever.get(component, ()) if arm != 0.0]
                ties.append(self._tie((tail, component), terms))
        return replace(self, ties=tuple(ties))

    def with_support(
        self,
        node: int | str,
        fixed: Sequence[str] = (),
        *,
        stiffness: Mapping[str, float] | None = None,
        damping: Mapping[str, float] | None = None,
        motion: Mapping[str, Motion] | None = None,
        name: str | None = None,
    ) -> Model:
        """Support a node: components that are fixed, on springs and dashpots to the ground, or moved.

        Elastic components stand on a ground node of their own, so that their reactions are reported
        too; a motion of an elastic component moves that ground.

        Parameters
        ----------
        node : int or str
        fixed : sequence of str
            Components that are held.
        stiffness, damping : mapping of component to float, optional
            To the ground [N/m], [N s/m]; of rotations [N m/rad], [N m s/rad].
        motion : mapping of component to Motion, optional
            Displacements over time [m], [rad]; see :mod:`axlespan.model.motions`.
        name : str, optional
            Of the support; ``support1``, ``support2``, ... when left out.
        """
        index = self.node(node)
        return self.with_supports(
            [index],
            fixed,
            stiffness=stiffness,
            damping=damping,
            motion=motion,
            name=name or self.node_label(index),
        )

    def with_supports(
        self,
        nodes: str | Sequence[int | str] | IntArray,
        fixed: Sequence[str] = (),
        *,
        stiffness: Mapping[str, float] | None = None,
        damping: Mapping[str, float] | None = None,
        motion: Mapping[str, Motion] | None = None,
        name: str | None = None,
    ) -> Model:
        """Support each node of a set, or of several, alike; see :meth:`with_support`.

        The supports of several nodes are called ``name.node``; the name is that of the set by default.

        Parameters
        ----------
        nodes : str or sequence of int or str
            Name of a set, or nodes.
        fixed, stiffness, damping, motion, name
            As in :meth:`with_support`.

        Raises
        ------
        InputError
            If there is no node, or a support is named or held twice.
        """
        indices, moved = self.nodes_of(nodes), dict(motion or {})
        elastic = {*(stiffness or {}), *(damping or {})}
        if not len(indices):
            raise InputError("must have at least one node", field="support", value=name or str(nodes))
        title = name or (nodes if isinstance(nodes, str) else "")
        if title and len(indices) == 1:
            labels = [title]
        else:
            every = self.node_labels()
            labels = [f"{title}.{every[i]}" if title else every[i] for i in indices]
        component_indices((*fixed, *moved, *elastic))
        held = [*fixed, *elastic]
        if len(set(held)) < len(held):
            twice = next(part for part in held if held.count(part) > 1)
            raise InputError("is held in two ways at once", field="support", value=f"{labels[0]}.{twice}")
        model, grounds = self, indices
        if elastic:
            model = model.with_nodes(self.points[indices], [f"{label}:ground" for label in labels])
            grounds = np.arange(len(self.points), len(model.points))
            pairs = np.column_stack([grounds, indices])
            model = model.with_springs(pairs, stiffness, damping, name=f"support {title or labels[0]}")
        entries = [
            Support(
                f"{label}.{part}", ground if part in elastic else index, part, moved.get(part, Constant(0.0))
            )
            for label, ground, index in zip(labels, grounds.tolist(), indices.tolist(), strict=True)
            for part in COMPONENTS
            if part in {*fixed, *moved, *elastic}
        ]
        taken = {(support.node, support.component) for support in model.supports}
        named = {support.name for support in model.supports}
        for entry in entries:
            if entry.name in named:
                raise InputError("is already the name of a support", field="support", value=entry.name)
            if (entry.node, entry.component) in taken:
                raise InputError("is supported twice", field="support", value=entry.name)
            taken.add((entry.node, entry.component))
            named.add(entry.name)
        return replace(model, supports=(*model.supports, *entries))

    def with_load(
        self,
        node: int | str,
        component: str,
        amount: float,
        history: Callable[[FloatArray], FloatArray] | None = None,
    ) -> Model:
        """Append a force [N] or moment [N m] at a node.

        Parameters
        ----------
        node : int or str
        component : str
            Where it acts: "z", "ry", ...
        amount : float
            [N] or [N m], positive with the axis.
        history : callable, optional
            Factor [-] of the time [s]; constant when left out.
        """
        component_indices((component,))
        return replace(
            self, loads=(*self.loads, NodalLoad(self.node(node), component, float(amount), history))
        )

    def with_damping(self, damping: Damping | None) -> Model:
        """Return the same model with another damping."""
        return replace(self, damping=damping)

    def with_part_damping(self, damping: Mapping[str, Rayleigh]) -> Model:
        """Return the same model with C = α M + β K of some parts, by their names, beside its damping."""
        return replace(self, part_damping={**self.part_damping, **damping})

    def damping_of(self, part: Part) -> Rayleigh:
        """Rayleigh damping of a part: of the model and its own."""
        own = self.part_damping.get(part.name, Rayleigh())
        if not isinstance(self.damping, Rayleigh):
            return own
        return Rayleigh(self.damping.alpha + own.alpha, self.damping.beta + own.beta)

    def card(self) -> Card:
        """Return what is shown of it."""
        kinds = Counter(type(part).__name__ for part in self.parts)
        names = [name for part in self.parts if (name := getattr(part, "name", ""))]
        facts = [
            ("nodes", f"{len(self.points)}{_box(self.points)}"),
            ("parts", some([f"{count} × {kind}" for kind, count in kinds.items()])),
            ("named", some(list(dict.fromkeys(names)))),
            ("supports", some([support.name for support in self.supports])),
            ("damping", "none" if self.damping is None else repr(self.damping)),
        ]
        space = "in the x-z plane" if self.plane else "in space"
        return Card(f"Model {space}", facts, "compile_model(model)")


def _pairs(nodes: npt.ArrayLike) -> IntArray:
    pairs = np.asarray(nodes, dtype=np.int64).reshape(-1, 2)
    if np.any(pairs[:, 0] == pairs[:, 1]):
        raise InputError(
            "must join two different nodes",
            field="element",
            value=int(pairs[pairs[:, 0] == pairs[:, 1]][0, 0]),
        )
    return pairs


def _box(points: FloatArray) -> str:
    """Where nodes lie, in words."""
    if not len(points):
        return ""
    low, high = points.min(axis=0), points.max(axis=0)
    return "; " + ", ".join(
        f"{axis} {a:g} to {b:g} m" for axis, a, b in zip("xyz", low, high, strict=True) if b > a
    )
