"""What is wrong with a mesh as a structure: nodes without elements, nodes twice, parts that nothing holds."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from axlespan.errors import InputError
from axlespan.study.build_model import MeshModel, active_components
from axlespan.study.mesh_source import is_merged_away

IntArray = npt.NDArray[np.int64]

# Nodes this close, as a share of the size of the mesh, are at the same place.
_SAME = 1e-7
# Sizes of bridges and vehicles [m]; others hint at a wrong unit of the file.
_SMALLEST, _LARGEST = 0.05, 2e4


def require_held(built: MeshModel, holding: IntArray, what: str, place: str) -> None:
    """Require that every part of a model is connected to nodes that hold it.

    Parameters
    ----------
    built : MeshModel
        The model.
    holding : array (n,)
        Nodes with supports, or wheels.
    what : str
        What they are, for errors: ``"support"``.
    place : str
        Path in the case, for errors.

    Raises
    ------
    InputError
        For a part that isn't, by its nodes and sets; it tells when merging nodes would join it.
    """
    group, used = _groups(built)
    loose = np.flatnonzero(used & ~np.isin(group, group[holding]))
    if not len(loose):
        return
    part = loose[group[loose] == group[loose[0]]]
    names = [name for name in built.case.sections if np.isin(part, built.book.sets[name]).any()]
    where = f" of '{names[0]}'" if names else ""
    rule = (
        f"a part{where} is connected to no {what}: {len(part)} nodes ({built.book.shown(part)}) are apart "
        "from the rest"
    )
    fix = f"Give it a {what}, or join it by springs, rigid_links or ties"
    pairs = same_places(built)
    apart = pairs[group[pairs[:, 0]] != group[pairs[:, 1]]]
    if len(apart):
        fix = f"Nodes {built.book.shown(apart[0])} are at the same place: merge: 1 mm joins such nodes"
    raise InputError(rule, field=place, fix=fix)


def same_places(built: MeshModel) -> IntArray:
    """Pairs (n_pair, 2) of nodes of elements at the same place that neither springs nor ties join."""
    pairs = built.mesh.duplicate_nodes(_SAME * built.book.size)
    used = _with_elements(built)
    pairs = pairs[used[pairs].all(axis=1)]
    n = len(built.model.points)
    joined = [part.nodes for part in built.model.parts if np.shape(part.nodes)[1] == 2]
    ties = [(tie.slave[0], node) for tie in built.model.ties for node, _, _ in tie.masters]
    edges = np.concatenate([*joined, np.array(ties, dtype=np.int64).reshape(-1, 2)])
    keys = np.sort(edges, axis=1) @ np.array([n, 1])
    return np.asarray(pairs[~np.isin(pairs @ np.array([n, 1]), keys)])


def warnings_of(built: MeshModel) -> tuple[str, ...]:
    """What may be right and is worth a word."""
    found = []
    size = np.ptp(built.mesh.points, axis=0).max()
    if not _SMALLEST <= size <= _LARGEST:
        found.append(f"the mesh is {size:.4g} m long; is unit: {built.case.unit} right?")
    idle = built.mesh.unused_nodes()
    idle = idle[~is_merged_away(built.mesh, idle, built.case.merge)]
    idle = idle[~_with_elements(built)[idle]]
    if len(idle):
        found.append(f"{_counted(len(idle), 'node')} without elements: {built.book.shown(idle)}")
    pairs = same_places(built)
    if len(pairs):
        shown = ", ".join(f"{built.book.shown(pair)}" for pair in pairs[:3])
        found.append(
            f"{_counted(len(pairs), 'pair')} of nodes at the same place that nothing joins ({shown}); "
            "merge: 1 mm joins them"
        )
    return tuple(found)


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"


def _with_elements(built: MeshModel) -> npt.NDArray[np.bool_]:
    return np.asarray(active_components(built.model).any(axis=1))


def _groups(built: MeshModel) -> tuple[IntArray, npt.NDArray[np.bool_]]:
    """Number of the connected part of each node, and which nodes have elements."""
    model = built.model
    heads, tails = [], []
    for part in model.parts:
        nodes = np.asarray(part.nodes)
        heads.append(np.repeat(nodes[:, 0], nodes.shape[1]))
        tails.append(nodes.ravel())
    for tie in model.ties:
        heads.append(np.full(len(tie.masters), tie.slave[0]))
        tails.append(np.array([node for node, _, _ in tie.masters], dtype=np.int64))
    row, column = np.concatenate(heads), np.concatenate(tails)
    n = len(model.points)
    graph = coo_array((np.ones(len(row), dtype=np.int8), (row, column)), shape=(n, n))
    used = np.zeros(n, dtype=bool)
    used[column] = True
    return connected_components(graph.tocsr(), directed=False)[1].astype(np.int64), used
