"""Matrices or modes of a case: read, in SI units, with named d.o.f. and nodes that can be chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan import units
from axlespan.errors import InputError
from axlespan.io.matrices import DofMap, MatrixModel, ModalModel, NodeTable, read_matrices, read_modal
from axlespan.io.matrices.read import format_of
from axlespan.model.dofs import COMPONENTS
from axlespan.study.case_matrices import Matrices, MatricesStructure, MatrixUnits
from axlespan.study.nodes import NodeBook, under

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Other words for rotations, in names of d.o.f. that a case lists.
_ALSO = {"roll": "rx", "pitch": "ry", "yaw": "rz"}


@dataclass(frozen=True, eq=False)
class RowBook:
    """What the rows of matrices, or of mode shapes, are called and where their nodes are."""

    dofs: DofMap
    names: tuple[str, ...]  # (n,) of the rows, node.component
    nodes: NodeBook  # positions of nodes are those of node_numbers
    node_numbers: IntArray  # (n_node,) numbers in the d.o.f. map
    has_places: bool  # whether coordinates are known

    @property
    def is_named(self) -> bool:
        """Whether the rows are d.o.f. of nodes, and not just numbers."""
        return "row" not in self.dofs.components

    def row_of(self, word: str, place: str) -> int:
        """Row of a d.o.f. by its name, or by its number from 1.

        Raises
        ------
        InputError
            If there is none.
        """
        if word in self.names:
            return self.names.index(word)
        if word.isdigit() and 1 <= int(word) <= len(self.names):
            return int(word) - 1
        if word.isdigit():
            raise InputError(f"must be a row from 1 to {len(self.names)}", field=place)
        fix = f"They are {', '.join(self.names[:6])}, …" if self.is_named else "Give dofs: rows.csv"
        raise InputError("is not the name of a d.o.f. of the matrices", field=place, fix=fix)

    def rows(self, positions: IntArray, component: str) -> IntArray:
        """Rows (n,) of a component at nodes by their positions; -1 where there is none."""
        found = [self.dofs.row(number, component) for number in self.node_numbers[positions].tolist()]
        return np.array([-1 if row is None else row for row in found], dtype=np.int64)

    def components_of(self, position: int) -> list[str]:
        """Components that a node has."""
        number = int(self.node_numbers[position])
        return [name for node, name in self.dofs.names if node == number]


def matrices_of(case: Matrices, damping: Path | None) -> tuple[MatrixModel, RowBook]:
    """Read the matrices of a case.

    Raises
    ------
    InputError
        If a file is damaged, or the matrices cannot be those of a structure; it names the file.
    """
    assert case.stiffness is not None and case.mass is not None  # the schema asks for both
    named = case.dofs if isinstance(case.dofs, tuple) else None
    if case.dofs is None and case.coordinates is not None:
        with under("stiffness"):
            form = case.format or format_of(case.stiffness)
        if form in ("matrix-market", "npz"):
            fix = "Add dofs: rows.csv, a file of lines row, node, component"
            raise InputError("is missing; coordinates are no use without it", field="dofs", fix=fix)
    listed = None if named is None else _dofs_of(named)
    with under("dofs" if named else "stiffness"):
        model = read_matrices(
            case.stiffness,
            case.mass,
            damping,
            dofs=listed if listed is not None else _file(case.dofs),
            coordinates=case.coordinates,
            format=case.format,
            unnamed=case.coordinates is None,
        )
    model = _in_si(model, case.units)
    return model, _book(model.dofs, model.coordinates, named)


def modes_of(case: MatricesStructure) -> tuple[ModalModel, RowBook]:
    """Read the modes of a case; errors as for matrices."""
    assert case.modes is not None  # the caller has looked
    with under("modes"):
        model = read_modal(case.modes, case.shapes, coordinates=case.coordinates)
    length, energy = _factors(case.units)
    table = _scaled(model.coordinates, length)
    scale = np.where(_is_translation(model.dofs), length, 1.0)
    model = replace(
        model, masses=model.masses * energy, shapes=model.shapes * scale[:, None], coordinates=table
    )
    return model, _book(model.dofs, table, None)


def _file(dofs: object) -> Path | None:
    return dofs if isinstance(dofs, Path) else None


def _dofs_of(names: Sequence[str]) -> DofMap:
    """The map of d.o.f. whose names a case lists; names of nodes that are no numbers get one."""
    numbers: dict[str, int] = {}
    nodes, components = [], []
    for i, name in enumerate(names):
        node, dot, component = name.rpartition(".")
        component = _ALSO.get(component, component)
        if not dot or component not in COMPONENTS:
            fix = f"Components are {', '.join(COMPONENTS)}, roll, pitch and yaw"
            raise InputError("must be node.component, as in 12.z or body.pitch", field=f"dofs.{i}", fix=fix)
        if not node.isdigit() and node not in numbers:
            taken = [int(other.rpartition(".")[0]) for other in names if other.rpartition(".")[0].isdigit()]
            numbers[node] = max(taken, default=0) + len(numbers) + 1
        nodes.append(int(node) if node.isdigit() else numbers[node])
        components.append(component)
    return DofMap(np.array(nodes, dtype=np.int64), tuple(components))


def _factors(case: MatrixUnits) -> tuple[float, float]:
    """The unit of length [m] and that of energy [J]."""
    length, force = units.factor(case.length, units.LENGTH), units.factor(case.force, units.FORCE)
    return length, length * force


def _is_translation(dofs: DofMap) -> npt.NDArray[np.bool_]:
    return np.isin(np.array(dofs.components), COMPONENTS[:3])


def _in_si(model: MatrixModel, case: MatrixUnits) -> MatrixModel:
    """The same energies in other units of displacement: K_SI = e D⁻¹ K D⁻¹, e the unit of energy."""
    length, energy = _factors(case)
    if length == energy == 1.0:
        return model
    if "row" in model.dofs.components:
        rule = "needs dofs: lengths and angles are scaled differently"
        raise InputError(rule, field="units", fix="Add dofs: rows.csv")
    d = sp.diags_array(np.where(_is_translation(model.dofs), 1.0 / length, 1.0))

    def scaled(matrix: sp.csr_array) -> sp.csr_array:
        return sp.csr_array(energy * (d @ matrix @ d))

    return replace(
        model,
        stiffness=scaled(model.stiffness),
        mass=scaled(model.mass),
        damping=None if model.damping is None else scaled(model.damping),
        coordinates=_scaled(model.coordinates, length),
    )


def _scaled(table: NodeTable | None, length: float) -> NodeTable | None:
    return None if table is None else replace(table, points=table.points * length)


def _book(dofs: DofMap, table: NodeTable | None, named: Sequence[str] | None) -> RowBook:
    if "row" in dofs.components:
        rows = tuple(f"row{i + 1}" for i in range(len(dofs)))
        nothing = NodeBook(np.empty((0, 3)), np.empty(0, dtype=np.int64), {})
        return RowBook(dofs, rows, nothing, np.empty(0, dtype=np.int64), False)
    labels = tuple(dofs.label(row) for row in range(len(dofs)))
    names = labels if named is None else tuple(named)
    if table is not None:
        position = {label: i for i, label in enumerate(table.labels.tolist())}
        sets = {
            name: np.array([position[label] for label in nodes.tolist()])
            for name, nodes in table.sets.items()
        }
        return RowBook(dofs, names, NodeBook(table.points, table.labels, sets), table.labels, True)
    numbers = np.unique(dofs.nodes)
    called = {name.rpartition(".")[0]: node for name, node in zip(names, dofs.nodes.tolist(), strict=True)}
    words = {name: int(np.searchsorted(numbers, node)) for name, node in called.items() if not name.isdigit()}
    return RowBook(dofs, names, NodeBook(np.zeros((len(numbers), 3)), numbers, {}, words), numbers, False)
