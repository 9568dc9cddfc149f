"""The mesh: points, elements by kind and named sets of both; a value that changes by copies.

Nodes and elements are counted from 0 here; the numbers that they have in a file are their labels. Nodes of
an element are in VTK's order: corners first, then the middles of the edges; linear kinds agree with Gmsh and
Abaqus. The first triangle of a wedge runs counterclockwise seen from the second.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from axlespan.elements.shape_functions import EDGES
from axlespan.errors import InputError
from axlespan.model.dofs import nearest
from axlespan.model.grids import Grid, cell_grid, line_grid

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
#: Pairs of a block's position in ``Mesh.blocks`` and positions of elements in that block.
ElementSet = tuple[tuple[int, IntArray], ...]


@dataclass(frozen=True)
class CellKind:
    """What a kind of element is, apart from its nodes' places."""

    node_count: int
    dimension: int


CELL_KINDS: Mapping[str, CellKind] = MappingProxyType(
    {
        "point1": CellKind(1, 0),
        **{"line2": CellKind(2, 1), "line3": CellKind(3, 1)},
        **{"tri3": CellKind(3, 2), "tri6": CellKind(6, 2), "quad4": CellKind(4, 2), "quad8": CellKind(8, 2)},
        **{"tet4": CellKind(4, 3), "tet10": CellKind(10, 3), "wedge6": CellKind(6, 3)},
        **{"hex8": CellKind(8, 3), "hex20": CellKind(20, 3)},
    }
)
_QUADRATIC = {"line2": "line3", "tri3": "tri6", "quad4": "quad8", "tet4": "tet10", "hex8": "hex20"}


@dataclass(frozen=True, eq=False)
class CellBlock:
    """Elements of one kind.

    Raises
    ------
    InputError
        If the kind is unknown or the arrays don't fit it.
    """

    kind: str
    nodes: IntArray  # (n_element, n_node) positions in Mesh.points
    labels: IntArray  # (n_element,) numbers in the file

    def __post_init__(self) -> None:
        if self.kind not in CELL_KINDS:
            raise nearest(self.kind, list(CELL_KINDS), "element kind")
        count = CELL_KINDS[self.kind].node_count
        nodes, labels = _indices(self.nodes, "element nodes"), _indices(self.labels, "element labels")
        if nodes.ndim != 2 or nodes.shape[1] != count:
            rule = f"must have {count} nodes for each element of kind {self.kind}"
            raise InputError(rule, field="element nodes", value=nodes.shape)
        if labels.shape != (len(nodes),):
            raise InputError("must be one for each element", field="element labels", value=labels.shape)
        object.__setattr__(self, "nodes", nodes)
        object.__setattr__(self, "labels", labels)

    def __len__(self) -> int:
        return len(self.nodes)


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """Points, elements by kind, and named sets.

    Parameters
    ----------
    points : array (n_node, 3)
        Coordinates of the nodes [m].
    blocks : sequence of CellBlock
        Elements by kind.
    node_sets : mapping of str to array (n,), optional
        Positions of nodes by name.
    element_sets : mapping of str to ElementSet, optional
        Pairs (block, positions in the block) by name.
    node_labels : array (n_node,), optional
        Numbers of the nodes in the file; 1, 2, … when left out.

    Raises
    ------
    InputError
        If a coordinate is not finite, or an element or a set names a node or an element that isn't there.

    Examples
    --------
    >>> Mesh.box((2.0, 1.0, 1.0), (2, 1, 1)).with_node_set("corner", [0])
    Mesh of 12 nodes, 2 hex8; sets corner, volume, x_max, …
    """

    points: FloatArray
    blocks: tuple[CellBlock, ...] = ()
    node_sets: Mapping[str, IntArray] = field(default_factory=dict)
    element_sets: Mapping[str, ElementSet] = field(default_factory=dict)
    node_labels: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.int64))

    def __post_init__(self) -> None:
        points = np.array(self.points, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise InputError("must be an array (n_node, 3)", field="points", value=points.shape)
        if not np.all(np.isfinite(points)):
            bad = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
            raise InputError("must be finite", field=f"points[{bad}]", value=points[bad].tolist())
        labels = _indices(self.node_labels, "node labels")
        if labels.size == 0:
            labels = np.arange(1, len(points) + 1)
        if labels.shape != (len(points),):
            raise InputError("must be one for each node", field="node labels", value=labels.shape)
        for name, value in (("points", points), ("blocks", tuple(self.blocks)), ("node_labels", labels)):
            object.__setattr__(self, name, value)
        for block in self.blocks:
            self._require(block.nodes, len(points), f"nodes of {block.kind}")
        node_sets = {str(name): np.unique(_indices(nodes, name)) for name, nodes in self.node_sets.items()}
        for name, nodes in node_sets.items():
            self._require(nodes, len(points), f"node set '{name}'")
        element_sets = {
            str(name): self._element_set(name, parts) for name, parts in self.element_sets.items()
        }
        object.__setattr__(self, "node_sets", node_sets)
        object.__setattr__(self, "element_sets", element_sets)

    @staticmethod
    def _require(indices: IntArray, count: int, what: str) -> None:
        if indices.size and (indices.min() < 0 or indices.max() >= count):
            bad = int(indices.min() if indices.min() < 0 else indices.max())
            raise InputError(f"must lie between 0 and {count - 1}", field=what, value=bad)

    def _element_set(self, name: str, parts: ElementSet) -> ElementSet:
        result = []
        for block, elements in sorted(parts, key=lambda part: part[0]):
            self._require(np.array([block]), len(self.blocks), f"block of element set '{name}'")
            chosen = np.unique(_indices(elements, name))
            self._require(chosen, len(self.blocks[block]), f"element set '{name}'")
            result.append((int(block), chosen))
        return tuple(result)

    # --- what it holds ------------------------------------------------------------------------

    @property
    def n_node(self) -> int:
        """Number of nodes."""
        return len(self.points)

    @property
    def n_element(self) -> int:
        """Number of elements of all kinds."""
        return sum(len(block) for block in self.blocks)

    def nodes_of_set(self, name: str) -> IntArray:
        """Positions of the nodes of a node set, or of the elements of an element set.

        Raises
        ------
        InputError
            If there is no such set; it suggests the nearest name.
        """
        if name in self.node_sets:
            return self.node_sets[name]
        if name in self.element_sets:
            used = [self.blocks[block].nodes[elements].ravel() for block, elements in self.element_sets[name]]
            return np.unique(np.concatenate([np.empty(0, dtype=np.int64), *used]))
        raise nearest(name, sorted({*self.node_sets, *self.element_sets}), "node set")

    def elements_of_set(self, name: str) -> ElementSet:
        """Pairs (block, positions of elements in it) of an element set.

        Raises
        ------
        InputError
            If there is no such set; it suggests the nearest name.
        """
        if name in self.element_sets:
            return self.element_sets[name]
        raise nearest(name, sorted(self.element_sets), "element set")

    def unused_nodes(self) -> IntArray:
        """Positions of the nodes that no element uses."""
        used = np.zeros(self.n_node, dtype=bool)
        for block in self.blocks:
            used[block.nodes] = True
        return np.flatnonzero(~used)

    def duplicate_nodes(self, tolerance: float) -> IntArray:
        """Pairs (n_pair, 2) of nodes no farther apart than a tolerance [m], the lower position first."""
        if not (np.isfinite(tolerance) and tolerance >= 0.0):
            raise InputError("must be zero or positive", field="tolerance", value=tolerance)
        pairs = np.asarray(KDTree(self.points).query_pairs(tolerance, output_type="ndarray"), dtype=np.int64)
        pairs = np.sort(pairs.reshape(-1, 2), axis=1)
        return np.asarray(pairs[np.lexsort(pairs.T[::-1])])

    def components(self) -> tuple[IntArray, ...]:
        """Nodes of each connected part, the largest first; nodes without elements are left out."""
        heads = [np.repeat(block.nodes[:, :1], block.nodes.shape[1], axis=1).ravel() for block in self.blocks]
        tails = [block.nodes.ravel() for block in self.blocks]
        if not tails:
            return ()
        row, column = np.concatenate(heads), np.concatenate(tails)
        graph = coo_array((np.ones(len(row), dtype=np.int8), (row, column)), shape=(self.n_node, self.n_node))
        part = connected_components(graph.tocsr(), directed=False)[1]
        used = np.unique(column)
        used = used[np.argsort(part[used], kind="stable")]
        groups = np.split(used, np.flatnonzero(np.diff(part[used])) + 1)
        return tuple(sorted(groups, key=lambda group: (-len(group), int(group[0]))))

    def bounding_box(self) -> FloatArray:
        """Lowest and highest coordinates (2, 3) [m].

        Raises
        ------
        InputError
            If the mesh has no nodes.
        """
        if not self.n_node:
            raise InputError("must have nodes", field="mesh", value=0)
        return np.array([self.points.min(axis=0), self.points.max(axis=0)])

    def __repr__(self) -> str:
        blocks = " + ".join(f"{len(block)} {block.kind}" for block in self.blocks) or "no elements"
        names = sorted({*self.node_sets, *self.element_sets})
        sets = f"; sets {', '.join([*names[:3], '…'] if len(names) > 3 else names)}" if names else ""
        return f"Mesh of {self.n_node} nodes, {blocks}{sets}"

    # --- copies -------------------------------------------------------------------------------

    def with_points(self, points: npt.ArrayLike) -> Mesh:
        """Return the mesh with its nodes at other places (n_node, 3) [m]."""
        moved = np.asarray(points, dtype=np.float64)
        if moved.shape != self.points.shape:
            raise InputError(f"must have the shape {self.points.shape}", field="points", value=moved.shape)
        return replace(self, points=moved)

    def with_node_set(self, name: str, nodes: npt.ArrayLike) -> Mesh:
        """Return the mesh with a named set of nodes (n,); it replaces one of the same name."""
        return replace(self, node_sets={**self.node_sets, name: np.asarray(nodes, dtype=np.int64).ravel()})

    def with_element_set(self, name: str, elements: ElementSet) -> Mesh:
        """Return the mesh with a named set of elements; it replaces one of the same name."""
        return replace(self, element_sets={**self.element_sets, name: elements})

    def merged(self, other: Mesh) -> Mesh:
        """Return this mesh and another side by side; sets of the same name are united.

        Nodes at the same place stay apart. Labels of the other mesh are raised where they would clash.
        """
        shift = _label_shift(self.node_labels, other.node_labels)
        mine = np.concatenate([np.empty(0, dtype=np.int64), *(block.labels for block in self.blocks)])
        theirs = np.concatenate([np.empty(0, dtype=np.int64), *(block.labels for block in other.blocks)])
        element_shift = _label_shift(mine, theirs)
        raised = (CellBlock(b.kind, b.nodes + self.n_node, b.labels + element_shift) for b in other.blocks)
        node_sets = dict(self.node_sets)
        for name, nodes in other.node_sets.items():
            node_sets[name] = np.concatenate([node_sets.get(name, nodes[:0]), nodes + self.n_node])
        element_sets = dict(self.element_sets)
        for name, parts in other.element_sets.items():
            moved = tuple((block + len(self.blocks), elements) for block, elements in parts)
            element_sets[name] = (*element_sets.get(name, ()), *moved)
        return Mesh(
            points=np.concatenate([self.points, other.points]),
            blocks=(*self.blocks, *raised),
            node_sets=node_sets,
            element_sets=element_sets,
            node_labels=np.concatenate([self.node_labels, other.node_labels + shift]),
        )

    def quadratic(self) -> Mesh:
        """Return the mesh with nodes at the middles of the edges: line3, tri6, quad8, tet10, hex20.

        A new node joins the node sets that hold both ends of its edge.

        Raises
        ------
        InputError
            If a kind has no quadratic form here.
        """
        pairs, blocks, shapes = [], [], []
        for block in self.blocks:
            if block.kind not in _QUADRATIC:
                raise InputError("has no quadratic form", field="element kind", value=block.kind)
            edges = np.array(EDGES[block.kind.rstrip("0123456789")])
            shapes.append((len(block), len(edges)))
            pairs.append(np.sort(block.nodes[:, edges].reshape(-1, 2), axis=1))
        every = np.concatenate([np.empty((0, 2), dtype=np.int64), *pairs])
        key, inverse = np.unique(every[:, 0] * self.n_node + every[:, 1], return_inverse=True)
        ends = np.column_stack([key // self.n_node, key % self.n_node])
        middle, start = self.n_node + inverse, 0
        for block, (count, width) in zip(self.blocks, shapes, strict=True):
            new = middle[start : start + count * width].reshape(count, width)
            start += count * width
            blocks.append(CellBlock(_QUADRATIC[block.kind], np.hstack([block.nodes, new]), block.labels))
        node_sets = {}
        for name, nodes in self.node_sets.items():
            inside = np.isin(ends, nodes).all(axis=1)
            node_sets[name] = np.concatenate([nodes, self.n_node + np.flatnonzero(inside)])
        labels = self.node_labels.max(initial=0) + np.arange(1, len(ends) + 1)
        return replace(
            self,
            points=np.concatenate([self.points, self.points[ends].mean(axis=1)]),
            blocks=tuple(blocks),
            node_sets=node_sets,
            node_labels=np.concatenate([self.node_labels, labels]),
        )

    # --- structured meshes --------------------------------------------------------------------

    @classmethod
    def line(cls, start: Sequence[float], end: Sequence[float], elements: int) -> Mesh:
        """Line elements from a point to another; sets ``start``, ``end`` and ``line``.

        Parameters
        ----------
        start, end : sequence of 3 floats
            Points [m].
        elements : int
            Number of line2 elements.
        """
        return cls._of_grid(line_grid(start, end, elements), "line2", "line")

    @classmethod
    def rectangle(
        cls,
        lengths: Sequence[float],
        divisions: Sequence[int],
        *,
        origin: Sequence[float] = (0.0, 0.0, 0.0),
        plane: str = "xy",
        kind: str = "quad4",
    ) -> Mesh:
        """A rectangle of quadrilaterals or triangles in the x-y or the x-z plane.

        Sets: ``surface``; the edges ``x_min``, ``x_max``, ``y_min``, … ; the corners ``x_min/y_min``, …

        Parameters
        ----------
        lengths : two floats
            Side lengths [m].
        divisions : two ints
            Numbers of cells along them.
        origin : sequence of 3 floats
            The corner with the lowest coordinates [m].
        plane : {"xy", "xz"}
        kind : {"quad4", "tri3"}
            Triangles halve the cells.
        """
        if plane not in ("xy", "xz"):
            raise InputError("must be 'xy' or 'xz'", field="plane", value=plane)
        axes = (0, 1) if plane == "xy" else (0, 2)
        return cls._of_grid(cell_grid(lengths, divisions, origin, axes, kind), kind, "surface")

    @classmethod
    def box(
        cls,
        lengths: Sequence[float],
        divisions: Sequence[int],
        *,
        origin: Sequence[float] = (0.0, 0.0, 0.0),
        kind: str = "hex8",
    ) -> Mesh:
        """A box of hexahedra, wedges (two to a cell) or tetrahedra (six to a cell).

        Sets: ``volume``; the faces ``x_min``, ``x_max``, … ; the edges ``x_min/y_min``, … ; the corners
        ``x_min/y_min/z_min``, …

        Parameters
        ----------
        lengths : three floats
            Side lengths along x, y, z [m].
        divisions : three ints
            Numbers of cells along them.
        origin : sequence of 3 floats
            The corner with the lowest coordinates [m].
        kind : {"hex8", "wedge6", "tet4"}
        """
        return cls._of_grid(cell_grid(lengths, divisions, origin, (0, 1, 2), kind), kind, "volume")

    @classmethod
    def _of_grid(cls, grid: Grid, kind: str, name: str) -> Mesh:
        points, nodes, node_sets = grid
        every = np.arange(len(nodes))
        return cls(points, (CellBlock(kind, nodes, every + 1),), node_sets, {name: ((0, every),)})


def _label_shift(mine: IntArray, theirs: IntArray) -> int:
    if not len(mine) or not len(theirs) or mine.max() < theirs.min():
        return 0
    return int(mine.max() - min(0, int(theirs.min()) - 1))


def _indices(values: npt.ArrayLike, what: str) -> IntArray:
    array = np.asarray(values)
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise InputError("must be whole numbers", field=str(what), value=str(array.dtype))
    return array.astype(np.int64)
