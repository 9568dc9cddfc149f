"""From a mesh in a case to a finite element model: sections, points, springs, masses, links, ties, supports."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from axlespan.errors import InputError
from axlespan.model.compile import Compiled, compile_model
from axlespan.model.damping import Damping
from axlespan.model.dofs import COMPONENTS, component_indices
from axlespan.model.mesh import Mesh as MeshValue
from axlespan.model.model import Model, Tie
from axlespan.model.parts import MassPart
from axlespan.study import case_nodes
from axlespan.study.build_supports import motions_of
from axlespan.study.case_imported import Mesh
from axlespan.study.faults import InputErrors
from axlespan.study.mesh_sections import sections_of
from axlespan.study.mesh_source import mesh_of
from axlespan.study.nodes import NodeBook, under

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class MeshModel:
    """A model from a mesh, compiled, and the nodes that the case may name."""

    case: Mesh
    mesh: MeshValue
    model: Model
    book: NodeBook
    compiled: Compiled


def model_of(case: Mesh, supports: Sequence[case_nodes.NodeSupport], damping: Damping | None) -> MeshModel:
    """Build and compile the model of a mesh.

    Parameters
    ----------
    case : Mesh
        What the case says of the mesh.
    supports : sequence of NodeSupport
        Its supports.
    damping : Damping or None
        Its damping.

    Raises
    ------
    InputError
        If something doesn't fit; fields are paths under the structure (the vehicle).
    """
    mesh = mesh_of(case)
    sections = sections_of(case, mesh)
    model = Model(plane=case.plane)
    with _attributed(case):
        model = model.with_mesh(mesh, sections)
    model = _with_names(model, mesh, case.points)
    book = book_of(mesh, case.points)
    model = _with_springs(model, case, book)
    model = _with_masses(model, case, book)
    model = _with_links(model, case, book)
    model = _with_ties(model, case, book)
    model = _with_supports(model, supports, book).with_damping(damping)
    with _attributed(case, supports):
        compiled = compile_model(model)
    return MeshModel(case, mesh, model, book, compiled)


def book_of(mesh: MeshValue, points: Mapping[str, Sequence[float]]) -> NodeBook:
    """The nodes of a mesh and the points of a case, which follow them in the model."""
    sets = {name: mesh.nodes_of_set(name) for name in (*mesh.element_sets, *mesh.node_sets)}
    return NodeBook(
        np.vstack([mesh.points, np.array(list(points.values()), dtype=float).reshape(-1, 3)]),
        np.concatenate([mesh.node_labels, np.full(len(points), -1)]),
        sets,
        {name: mesh.n_node + i for i, name in enumerate(points)},
    )


def _with_names(model: Model, mesh: MeshValue, points: Mapping[str, Sequence[float]]) -> Model:
    """Nodes are called as in the file, n12, and points by their names."""
    if not np.array_equal(mesh.node_labels, np.arange(1, mesh.n_node + 1)):
        names = {f"n{label}": i for i, label in enumerate(mesh.node_labels.tolist())}
        model = replace(model, node_names=names)
    if not points:
        return model
    taken = [name for name in points if re.fullmatch(r"n\d+", name) or name in model.node_sets]
    if taken:
        rule = "is the name of a set of the mesh, or looks like the number of a node"
        raise InputError(rule, field=f"points.{taken[0]}", fix="Choose another name")
    with under("points"):
        return model.with_nodes(np.array(list(points.values())), list(points))


def active_components(model: Model) -> npt.NDArray[np.bool_]:
    """Which components (n_node, 6) nodes have from the elements at them."""
    active = np.zeros((len(model.points), len(COMPONENTS)), dtype=bool)
    for part in model.parts:
        active[np.unique(part.nodes)[:, None], component_indices(part.components)] = True
    return active


def nearest_of(book: NodeBook, nodes: IntArray, others: IntArray) -> tuple[IntArray, FloatArray]:
    """The nearest of some nodes for each of others, and how far it is [m]."""
    distance, which = cKDTree(book.points[others]).query(book.points[nodes])
    return others[np.asarray(which)], np.asarray(distance, float)


def _with_springs(model: Model, case: Mesh, book: NodeBook) -> Model:
    for number, spring in enumerate(case.springs):
        place = f"springs.{number}"
        ends = [book.chosen(end, f"{place}.between.{i}") for i, end in enumerate(spring.between)]
        if len(ends[0]) < len(ends[1]):
            ends = ends[::-1]
        partners, _ = nearest_of(book, ends[0], ends[1])
        with under(place):
            model = model.with_springs(
                np.column_stack([ends[0], partners]),
                spring.stiffness.given() if spring.stiffness else None,
                spring.damping.given() if spring.damping else None,
                name=place,
            )
    return model


def _with_masses(model: Model, case: Mesh, book: NodeBook) -> Model:
    every = ("x", "z") if model.plane else ("x", "y", "z")
    for number, mass in enumerate(case.masses):
        nodes = book.chosen(mass.at, f"masses.{number}.at")
        there = np.asarray(active_components(model)[nodes].any(axis=0))
        moves = tuple(name for name in every if not there.any() or there[COMPONENTS.index(name)])
        moments = mass.inertia.given() if mass.inertia else {}
        values = [mass.mass] * len(moves) + list(moments.values())
        inertia = np.tile(np.array(values, dtype=float), (len(nodes), 1))
        model = model.with_part(MassPart(f"masses.{number}", nodes[:, None], inertia, (*moves, *moments)))
    return model


def _with_links(model: Model, case: Mesh, book: NodeBook) -> Model:
    for number, link in enumerate(case.rigid_links):
        place = f"rigid_links.{number}"
        master = book.one(link.master, f"{place}.master")
        nodes = book.chosen(link.nodes, f"{place}.nodes")
        with under(place):
            model = model.with_rigid_link(master, nodes[nodes != master].tolist(), link.components)
    return model


def _with_ties(model: Model, case: Mesh, book: NodeBook) -> Model:
    for number, tie in enumerate(case.ties):
        place = f"ties.{number}"
        slaves, masters = book.chosen(tie.nodes, f"{place}.nodes"), book.chosen(tie.to, f"{place}.to")
        slaves = np.setdiff1d(slaves, masters)
        if not len(slaves):
            raise InputError("ties nodes to themselves", field=place, fix="Name two different sets")
        partners, distance = nearest_of(book, slaves, masters)
        far = np.flatnonzero(distance > tie.tolerance)
        if len(far):
            rule = (
                f"has {len(far)} of {len(slaves)} nodes farther than {tie.tolerance:g} m from the others; "
                f"{book.shown(slaves[far[:1]])} is {distance[far[0]]:.3g} m from {book.shown(partners[far[:1]])}"
            )
            raise InputError(rule, field=place, fix="Use rigid_links, or raise the tolerance")
        active = active_components(model)
        both = np.logical_and(active[slaves], active[partners])
        wanted = component_indices(tie.components or COMPONENTS)
        ties = [
            Tie((slave, COMPONENTS[c]), ((master, COMPONENTS[c], 1.0),))
            for slave, master, own in zip(slaves.tolist(), partners.tolist(), both, strict=True)
            for c in wanted.tolist()
            if own[c]
        ]
        model = replace(model, ties=(*model.ties, *ties))
    return model


def _with_supports(model: Model, supports: Sequence[case_nodes.NodeSupport], book: NodeBook) -> Model:
    faults: list[InputError] = []
    for number, support in enumerate(supports):
        place = f"supports.{number}"
        try:
            nodes = book.chosen(support.at, f"{place}.at")
            with under(place):
                model = model.with_supports(
                    nodes,
                    support.fixed,
                    stiffness=support.stiffness.given() if support.stiffness else None,
                    damping=support.damping.given() if support.damping else None,
                    motion=motions_of(support.motion),
                    name=support_title(support, number),
                )
        except InputError as error:
            faults.append(error)
    if faults:
        raise InputErrors(faults)
    return model


def support_title(support: case_nodes.NodeSupport, number: int) -> str:
    """What results call a support."""
    if support.name is not None:
        return support.name
    word = support.at if isinstance(support.at, str) else ""
    return word if word and not word.isdigit() else f"support{number + 1}"


@contextmanager
def _attributed(case: Mesh, supports: Sequence[case_nodes.NodeSupport] = ()) -> Iterator[None]:
    """Give errors that name a set or a support the place of that set or support in the case."""
    try:
        yield
    except InputError as error:
        place = _place_of(error, case, supports)
        if error.place is not None or place is None:
            raise
        with under(place):
            raise


def _place_of(error: InputError, case: Mesh, supports: Sequence[case_nodes.NodeSupport]) -> str | None:
    quoted = re.search(r"'([^']+)'", error.field or "")
    if quoted:
        whole = quoted.group(1)
        for name in (whole, whole.rpartition("/")[0]):  # a set of two kinds of elements has two parts
            if name in case.sections:
                return f"sections.{name}"
        if re.fullmatch(r"(springs|masses)\.\d+", whole):
            return whole
    if error.field == "support":
        label = str(error.value)
        for number, support in enumerate(supports):
            if label.startswith(f"{support_title(support, number)}."):
                return f"supports.{number}"
    return "sections" if error.field == "element" else None
