"""From a Model to a System: numbering, assembly, elimination of ties, damping, supports and loads."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.low_rank import LowRank
from axlespan.model.assembly import assemble, element_dofs
from axlespan.model.damping import Damping, Modal, Rayleigh
from axlespan.model.dofs import COMPONENTS, DofTable, component_indices
from axlespan.model.model import Model, Tie
from axlespan.model.nonlinear import NonlinearPart
from axlespan.model.parts import Part
from axlespan.model.system import Load, SpringRows, System

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Models with more nodes are numbered along their longest direction.
_ORDERED_ABOVE = 200

# Modal damping: all modes up to this many d.o.f., else so many.
_ALL_MODES_UP_TO, _MODES_OF_A_LARGE_MODEL = 300, 40


@dataclass(frozen=True, eq=False)
class Compiled:
    """A system and the numbers of its d.o.f. by node and component."""

    system: System
    table: DofTable


def compile_model(model: Model) -> Compiled:
    """Number, assemble and eliminate.

    Raises
    ------
    InputError
        If supports, ties or loads name d.o.f. that don't exist or contradict each other.
    """
    table = dof_table(model)
    if table.size == 0:
        raise InputError("must have at least one element", field="model")
    names = table.names(model.node_labels())
    stiffness, mass, damping = assemble(model.parts, model.points, table)
    damping = _with_part_damping(model, table, damping)
    elimination, independent = _elimination(model, table, names)
    stiffness, mass, damping = (_projected(matrix, elimination) for matrix in (stiffness, mass, damping))
    nonlinear = _nonlinear(model, table, elimination)
    if isinstance(model.damping, Rayleigh):  # the reference stiffness of a nonlinear spring damps nothing
        linear = stiffness
        for springs in nonlinear:
            k = np.broadcast_to(springs.stiffness, springs.gap.shape)
            linear = linear - springs.rows.T @ sp.diags_array(k) @ springs.rows
        damping = sp.csr_array(damping + model.damping.alpha * mass + model.damping.beta * linear)
    position = np.full(table.size, -1, dtype=np.int64)
    position[independent] = np.arange(len(independent))
    system = System(
        stiffness=stiffness,
        mass=mass,
        damping=damping,
        dof_names=names,
        elimination=elimination,
        prescribed=_prescribed(model, table, position),
        support_names=tuple(support.name for support in model.supports),
        motions=tuple(support.motion for support in model.supports),
        loads=_loads(model, table, elimination),
        independent=independent,
        nonlinear=nonlinear,
    )
    return Compiled(with_modal_damping(system, model.damping), table)


def _with_part_damping(model: Model, table: DofTable, damping: sp.csr_array) -> sp.csr_array:
    """C with α M + β K of the parts that have damping of their own."""
    kinds: dict[Rayleigh, list[Part]] = {}
    for part in model.parts:
        if part.name in model.part_damping:
            kinds.setdefault(model.part_damping[part.name], []).append(part)
    for own, parts in kinds.items():
        stiffness, mass, _ = assemble(tuple(parts), model.points, table)
        damping = sp.csr_array(damping + own.alpha * mass + own.beta * stiffness)
    return damping


def _nonlinear(model: Model, table: DofTable, elimination: sp.csr_array) -> tuple[SpringRows, ...]:
    """Elongations of the nonlinear springs over the independent d.o.f."""
    found = []
    for part in model.parts:
        if not isinstance(part, NonlinearPart):
            continue
        dofs = element_dofs(part, table)  # (n_spring, 2)
        n_spring = len(dofs)
        row = np.repeat(np.arange(n_spring), 2)
        unit = sp.coo_array((np.tile([-1.0, 1.0], n_spring), (row, dofs.ravel())), (n_spring, table.size))
        rows = sp.csr_array(sp.csr_array(unit) @ elimination)
        law = part.law
        found.append(SpringRows(part.name, law, rows, part.gap, law.stiffness, law.reference_damping))
    return tuple(found)


def dof_table(model: Model) -> DofTable:
    """Numbers of a model's d.o.f. by node and component, without assembling anything."""
    return DofTable.of_active(_active(model), _order(model.points))


def _order(points: FloatArray) -> IntArray | None:
    """Nodes from one end of a large model to the other: bridges are long, and a narrow band is quick to solve."""
    if len(points) <= _ORDERED_ABOVE:
        return None
    extent = np.ptp(points, axis=0)
    long = int(np.argmax(extent))
    return np.argsort(np.round(points[:, long] / (1e-9 * max(extent[long], 1e-30))), kind="stable")


def _active(model: Model) -> npt.NDArray[np.bool_]:
    active = np.zeros((len(model.points), len(COMPONENTS)), dtype=bool)
    for part in model.parts:
        active[np.unique(part.nodes)[:, None], component_indices(part.components)] = True
    waiting = list(model.ties)
    while True:  # masters of active slaves are active; a master may be a slave itself
        is_ready = [bool(active[tie.slave[0], COMPONENTS.index(tie.slave[1])]) for tie in waiting]
        ready = [tie for tie, now in zip(waiting, is_ready, strict=True) if now]
        if not ready:
            return active
        waiting = [tie for tie, now in zip(waiting, is_ready, strict=True) if not now]
        for tie in ready:
            for node, component, _ in tie.masters:
                active[node, COMPONENTS.index(component)] = True


def _number(table: DofTable, node: int, component: str) -> int:
    return int(table.number[node, COMPONENTS.index(component)])


def _elimination(model: Model, table: DofTable, names: tuple[str, ...]) -> tuple[sp.csr_array, IntArray]:
    """u_full = T u: T of the ties, chains of ties resolved, and the positions of the independent d.o.f."""
    n = table.size
    ties = [tie for tie in model.ties if _number(table, *tie.slave) >= 0]
    if not ties:
        return sp.csr_array(sp.eye_array(n)), np.arange(n, dtype=np.int64)
    slaves = _slaves(ties, table, names)
    keep = np.ones(n, dtype=bool)
    keep[slaves] = False
    rows, columns, values = [], [], []
    for slave, tie in zip(slaves, ties, strict=True):
        for node, component, factor in tie.masters:
            rows.append(slave)
            columns.append(_number(table, node, component))
            values.append(factor)
    links = sp.csr_array(sp.coo_array((values, (rows, columns)), shape=(n, n)))
    direct = sp.csr_array(sp.diags_array(keep.astype(float)))
    resolved = links
    for _ in range(len(ties) + 1):  # follow chains: a slave whose master is itself a slave
        if not np.any(resolved[:, ~keep].data):
            independent = np.flatnonzero(keep)
            return sp.csr_array((direct + resolved)[:, independent]), independent
        resolved = sp.csr_array(resolved @ (direct + links))
    raise InputError("must not form a circle", field="ties", value=names[int(slaves[0])])


def _slaves(ties: list[Tie], table: DofTable, names: tuple[str, ...]) -> IntArray:
    slaves = np.array([_number(table, *tie.slave) for tie in ties], dtype=np.int64)
    values, counts = np.unique(slaves, return_counts=True)
    if np.any(counts > 1):
        raise InputError("is tied twice", field="tie", value=names[int(values[np.argmax(counts)])])
    return slaves


def _projected(matrix: sp.csr_array, elimination: sp.csr_array) -> sp.csr_array:
    if elimination.shape[0] == elimination.shape[1]:
        return matrix
    product = elimination.T @ matrix @ elimination
    return sp.csr_array(0.5 * (product + product.T))


def _prescribed(model: Model, table: DofTable, position: IntArray) -> IntArray:
    result = []
    for support in model.supports:
        dof = _number(table, support.node, support.component)
        if dof < 0:
            raise InputError(
                f"has no {support.component} at this node, so it cannot be supported there",
                field="support",
                value=support.name,
                fix="No element uses that degree of freedom: leave it out",
            )
        if position[dof] < 0:
            raise InputError("is both supported and tied to other nodes", field="support", value=support.name)
        result.append(position[dof])
    return np.array(result, dtype=np.int64)


def _loads(model: Model, table: DofTable, elimination: sp.csr_array) -> tuple[Load, ...]:
    loads = []
    for load in model.loads:
        dof = _number(table, load.node, load.component)
        if dof < 0:
            raise InputError(
                f"has no {load.component}: no element uses it",
                field="load at node",
                value=model.node_label(load.node),
            )
        nodal = np.zeros(table.size)
        nodal[dof] = load.amount
        loads.append(Load(np.asarray(elimination.T @ nodal), load.history))
    return tuple(loads)


def with_modal_damping(system: System, damping: Damping | None) -> System:
    """C = Σ 2 ζ ω (M φ)(M φ)ᵀ over the free d.o.f., kept as its factors."""
    if not isinstance(damping, Modal) or damping.ratio == 0.0:
        return system
    blocks, n = system.partition, len(system.free)
    count = damping.modes or (None if n <= _ALL_MODES_UP_TO else _MODES_OF_A_LARGE_MODEL)
    modes = lowest_modes(blocks.K_FF, blocks.M_FF, count)
    omega = modes.angular_frequencies
    low_rank = LowRank(np.ascontiguousarray(blocks.M_FF @ modes.shapes), 2.0 * damping.ratio * omega)
    return replace(system, modal_damping=low_rank)
