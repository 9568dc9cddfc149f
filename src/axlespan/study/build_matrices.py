"""From ``structure: {kind: matrices, …}`` to a structure: matrices or modes of other programs, on supports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.io.matrices import MatrixModel, ModalModel
from axlespan.model.compile import with_modal_damping
from axlespan.model.damping import Damping, Modal, Rayleigh
from axlespan.model.dofs import COMPONENTS
from axlespan.model.motions import Constant, Motion
from axlespan.model.system import System
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import MAIN_LINE, Structure
from axlespan.study.build_model import support_title
from axlespan.study.build_supports import damping_of, motions_of
from axlespan.study.built import BuiltStructure, line_fact, mass_facts
from axlespan.study.case_matrices import MatricesStructure
from axlespan.study.case_nodes import NodeSupport
from axlespan.study.faults import InputErrors
from axlespan.study.matrix_body import RowBook, matrices_of, modes_of
from axlespan.study.matrix_lines import path_over

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


def structure_of_matrices(case: MatricesStructure) -> BuiltStructure:
    """Build the structure of matrices or modes.

    Raises
    ------
    InputError
        If files, supports or running lines are wrong; fields are paths under the structure.
    """
    if case.modes is not None:
        modal, book = modes_of(case)
        paths, words = _lines(case, book)
        system = _modal_system(modal, book, case)
        shapes = sp.csr_array(modal.shapes)
        lines = {name: path.transformed(shapes) for name, path in paths.items()}
        facts = [
            f"modes       {modal.n_mode}, from {modal.frequencies.min():.4g} to {modal.frequencies.max():.4g} Hz; "
            f"shapes at {len(book.dofs)} d.o.f.",
            "mass        not known from modes",
        ]
        return _built("modes", system, lines, book, [*facts, *words])
    model, book = matrices_of(case, case.damping if isinstance(case.damping, Path) else None)
    law = None if isinstance(case.damping, Path) else damping_of(case.damping)
    system = system_of(model, book, case.supports, law)
    lines, words = _lines(case, book)
    built = _built("matrices", system, lines, book, [])
    facts = [f"matrices    {model.n_dof} d.o.f., {len(system.prescribed)} at supports of the case"]
    if book.is_named:
        facts += mass_facts(built.structure)
    if book.has_places:
        count = model.rigid_body_modes()
        facts += [f"rigid-body  {count} motions without stiffness in the matrices as they come"]
    return replace(built, facts=(*facts, *words))


def _dof_at(book: RowBook, choice: str, place: str) -> str:
    """Vertical d.o.f. of a node, or a d.o.f. by its name."""
    if choice in book.names:
        return choice
    node = book.nodes.one(choice, place)
    row = int(book.rows(np.array([node]), "z")[0])
    if row < 0:
        raise InputError("has no vertical d.o.f. in the matrices", field=place)
    return book.names[row]


def _built(
    name: str, system: System, lines: dict[str, PolynomialPath], book: RowBook, facts: Sequence[str]
) -> BuiltStructure:
    main = next(iter(lines.values()))
    structure = Structure(system, lines, name, None, {"length": main.stop - main.start})
    return BuiltStructure(structure, tuple(facts), dof_at=lambda at, place: _dof_at(book, at, place))


def _lines(case: MatricesStructure, book: RowBook) -> tuple[dict[str, PolynomialPath], list[str]]:
    wanted = {"running_line": (MAIN_LINE, case.running_line)}
    if case.running_lines is not None:
        wanted = {f"running_lines.{name}": (name, line) for name, line in case.running_lines.items()}
    paths, facts = {}, []
    for place, (name, line) in wanted.items():
        assert line is not None  # the schema asks for one of the two
        path, words = path_over(line, book, place)
        paths[name] = path
        facts.append(line_fact(name, path, words))
    return paths, facts


# --- matrices ----------------------------------------------------------------------------------------


@dataclass
class _Held:
    """What supports add to a system, collected one by one."""

    rows: list[int] = field(default_factory=list)  # prescribed
    names: list[str] = field(default_factory=list)
    motions: list[Motion] = field(default_factory=list)
    springs: list[tuple[int, float, float, str]] = field(default_factory=list)  # row, k, c, name
    grounds: list[Motion] = field(default_factory=list)  # of the springs' other ends


def system_of(
    model: MatrixModel, book: RowBook, supports: Sequence[NodeSupport], damping: Damping | None
) -> System:
    """The system of matrices on the supports of a case; springs get a ground d.o.f. of their own.

    Raises
    ------
    InputError
        If a support names nodes or d.o.f. that are not there, or holds one twice.
    """
    held = _supported(model, book, supports)
    n, extra = model.n_dof, len(held.springs)
    rows = np.array([row for row, *_ in held.springs], dtype=np.int64)
    mass = _padded(model.mass, extra)
    stiffness = _padded(model.stiffness, extra) + _to_ground(rows, [k for _, k, _, _ in held.springs], n)
    viscous = _to_ground(rows, [c for _, _, c, _ in held.springs], n)
    if model.damping is not None:
        viscous = viscous + _padded(model.damping, extra)
    if isinstance(damping, Rayleigh):
        viscous = viscous + damping.alpha * mass + damping.beta * stiffness
    names = (*book.names, *(name for *_, name in held.springs))
    aliases = tuple(model.dofs.components)
    system = System(
        stiffness=sp.csr_array(stiffness),
        mass=sp.csr_array(mass),
        damping=sp.csr_array(viscous),
        dof_names=names,
        elimination=sp.csr_array(sp.eye_array(n + extra)),
        prescribed=np.array([*held.rows, *range(n, n + extra)], dtype=np.int64),
        support_names=(*held.names, *(name.replace(":ground", "") for *_, name in held.springs)),
        motions=(*held.motions, *held.grounds),
        independent=np.arange(n + extra),
        components=(*aliases, *(name.rpartition(".")[2] for *_, name in held.springs)),
    )
    return with_modal_damping(system, damping)


def _padded(matrix: sp.csr_array, extra: int) -> sp.csr_array:
    if not extra:
        return matrix
    return sp.csr_array(sp.block_diag([matrix, sp.csr_array((extra, extra))], format="csr"))


def _to_ground(rows: IntArray, values: Sequence[float], n: int) -> sp.csr_array:
    """Springs from rows (k,) to ground d.o.f. of their own, n, n + 1, …, as a matrix (n + k, n + k)."""
    ground, value = n + np.arange(len(rows)), np.array(values, dtype=float)
    at = (np.concatenate([rows, ground, rows, ground]), np.concatenate([rows, ground, ground, rows]))
    entries = np.concatenate([value, value, -value, -value])
    return sp.csr_array(sp.coo_array((entries, at), shape=(n + len(rows), n + len(rows))))


def _supported(model: MatrixModel, book: RowBook, supports: Sequence[NodeSupport]) -> _Held:
    held, faults = _Held(), []
    for number, support in enumerate(supports):
        place = f"supports.{number}"
        try:
            if not book.is_named:
                fix = "Add dofs: rows.csv"
                raise InputError("needs dofs: which d.o.f. the rows are", field=place, fix=fix)
            nodes = book.nodes.chosen(support.at, f"{place}.at")
            title = support_title(support, number)
            for node in nodes.tolist():
                label = title if len(nodes) == 1 else f"{title}.{book.nodes.shown(np.array([node]))}"
                _hold(held, model, book, support, node, label, place)
        except InputError as error:
            faults.append(error)
    if faults:
        raise InputErrors(faults)
    return held


def _hold(
    held: _Held,
    model: MatrixModel,
    book: RowBook,
    support: NodeSupport,
    node: int,
    label: str,
    place: str,
) -> None:
    moved = motions_of(support.motion) or {}
    springs = support.stiffness.given() if support.stiffness else {}
    dashpots = support.damping.given() if support.damping else {}
    taken = {*held.rows, *(row for row, *_ in held.springs)}
    for component in COMPONENTS:
        if component not in {*support.fixed, *moved, *springs, *dashpots}:
            continue
        row = int(book.rows(np.array([node]), component)[0])
        shown = book.nodes.shown(np.array([node]))
        if row < 0:
            number = int(book.node_numbers[node])
            own = ", ".join(book.components_of(node))
            rule = f"node {shown} has no {component} in the matrices; it has {own or 'no d.o.f. at all'}"
            if model.held.row(number, component) is not None or not own:
                rule = f"node {shown} has no {component} in the matrices: it is held there already"
            raise InputError(rule, field=place, fix="Leave it out")
        if row in taken:
            raise InputError(f"{shown}.{component} is supported twice", field=place)
        if component in springs or component in dashpots:
            name = f"{label}:ground.{component}"
            held.springs.append((row, springs.get(component, 0.0), dashpots.get(component, 0.0), name))
            held.grounds.append(moved.get(component, Constant(0.0)))
        else:
            held.rows.append(row)
            held.names.append(f"{label}.{component}")
            held.motions.append(moved.get(component, Constant(0.0)))


# --- modes -------------------------------------------------------------------------------------------


def _modal_system(model: ModalModel, book: RowBook, case: MatricesStructure) -> System:
    """Modal coordinates q are the independent d.o.f.; those of the nodes follow by their shapes."""
    n = model.n_mode
    omega = 2.0 * np.pi * model.frequencies
    damping = model.dampings
    if case.damping is not None:
        assert not isinstance(case.damping, Path)  # the schema refuses it
        if model.damping_ratios is not None:
            raise InputError(
                "says again what the modes say", field="damping", fix="Delete it, or the ratios in modes"
            )
        law = damping_of(case.damping)
        if isinstance(law, Modal):
            damping = 2.0 * law.ratio * omega * model.masses
        elif isinstance(law, Rayleigh):
            damping = (law.alpha + law.beta * omega**2) * model.masses
    if np.any(model.frequencies == 0.0):
        mode = int(np.argmin(model.frequencies)) + 1
        rule = f"mode {mode} has the frequency 0: a body that moves freely"
        raise InputError(rule, field="modes", fix="Export the modes of the structure on its supports")
    return System(
        stiffness=sp.csr_array(sp.diags_array(model.stiffnesses)),
        mass=sp.csr_array(sp.diags_array(model.masses)),
        damping=sp.csr_array(sp.diags_array(damping)),
        dof_names=(*(f"mode{i + 1}.q" for i in range(n)), *book.names),
        elimination=sp.csr_array(sp.vstack([sp.eye_array(n), sp.csr_array(model.shapes)], format="csr")),
        prescribed=np.empty(0, dtype=np.int64),
        independent=np.arange(n),
        components=(*(["q"] * n), *model.dofs.components),
    )
