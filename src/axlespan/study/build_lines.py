"""Running lines of a case on a mesh: along beams, or over the surfaces of solids, shells and planes."""

from __future__ import annotations

import itertools

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.continuum_parts import PlanePart, SolidPart
from axlespan.model.parts import BeamPart
from axlespan.model.shell_parts import ShellPart
from axlespan.running.facets import TOP
from axlespan.running.line import path_on_beams
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import MAIN_LINE
from axlespan.running.surface import line_over
from axlespan.study.build_model import MeshModel
from axlespan.study.case_imported import MeshLine, MeshStructure
from axlespan.study.nodes import under

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


def lines_of(case: MeshStructure, built: MeshModel) -> dict[str, PolynomialPath]:
    """Running lines by name, in the independent d.o.f. of the system; the first is the main one.

    Raises
    ------
    InputError
        If a line is not on the structure.
    """
    if case.running_line is not None:
        wanted = {"running_line": (MAIN_LINE, case.running_line)}
    else:
        wanted = {f"running_lines.{name}": (name, line) for name, line in (case.running_lines or {}).items()}
    elimination = built.compiled.system.elimination
    return {
        name: _line(line, built, place).transformed(elimination) for place, (name, line) in wanted.items()
    }


def _line(line: MeshLine, built: MeshModel, place: str) -> PolynomialPath:
    model, table = built.model, built.compiled.table
    if line.nodes is not None:
        nodes = built.book.chosen(line.nodes, f"{place}.nodes")
        nodes = built.book.along(nodes, f"{place}.nodes", twins=True)
        if line.surface is None and _on_beams(built, nodes):
            with under(place):
                return path_on_beams(model, table, nodes.tolist(), start=line.start)
        points = model.points[nodes]
    else:
        assert line.from_ is None or line.to is not None  # the schema asks for both
        given = line.points if line.points is not None else (line.from_, line.to)
        points = np.array(given, dtype=float)
        if not any(isinstance(part, (SolidPart, ShellPart, PlanePart)) for part in model.parts):
            chain = _nodes_along(built, points, line.tolerance, place)
            with under(place):
                return path_on_beams(model, table, chain.tolist(), start=line.start)
    with under(place):
        return line_over(
            model, table, points, start=line.start, faces=line.surface or TOP, tolerance=line.tolerance
        )


def _on_beams(built: MeshModel, chain: IntArray) -> bool:
    """Whether beams join all neighbors of a chain, and no surface could carry it."""
    surfaces = [
        part.nodes for part in built.model.parts if isinstance(part, (SolidPart, ShellPart, PlanePart))
    ]
    if surfaces and np.isin(chain, np.concatenate([nodes.ravel() for nodes in surfaces])).all():
        return False
    beams = [part.nodes for part in built.model.parts if isinstance(part, BeamPart)]
    joined = {frozenset(pair) for nodes in beams for pair in nodes.tolist()}
    return bool(
        surfaces == [] or all(frozenset(pair) in joined for pair in itertools.pairwise(chain.tolist()))
    )


def _nodes_along(built: MeshModel, points: FloatArray, tolerance: float | None, place: str) -> IntArray:
    """Nodes of beams on a polyline, in its order; its ends must be among them."""
    model, reach = built.model, tolerance or 10.0 * built.book.tolerance
    beams = [part.nodes.ravel() for part in model.parts if isinstance(part, BeamPart)]
    if not beams:
        raise InputError("needs beams, shells, planes or solids to run on", field=place)
    nodes = np.unique(np.concatenate(beams))
    pieces = np.diff(points, axis=0)
    lengths = np.linalg.norm(pieces, axis=1)
    if np.any(lengths == 0.0):
        raise InputError("has two equal points, one after the other", field=place)
    arm = model.points[nodes][:, None] - points[:-1]
    share = np.clip((arm * pieces).sum(axis=2) / lengths**2, 0.0, 1.0)
    away = np.linalg.norm(arm - share[..., None] * pieces, axis=2)
    piece = np.argmin(away, axis=1)
    rows = np.arange(len(nodes))
    position = np.concatenate([[0.0], np.cumsum(lengths)])[piece] + share[rows, piece] * lengths[piece]
    on = np.flatnonzero(away[rows, piece] <= reach)
    on = on[np.argsort(position[on], kind="stable")]
    for end, where in ((0, 0.0), (-1, float(lengths.sum()))):
        if not len(on) or abs(position[on[end]] - where) > reach:
            point = points[end]
            gap = np.linalg.norm(model.points[nodes] - point, axis=1)
            close = int(nodes[np.argmin(gap)])
            at = ", ".join(f"{x:.6g}" for x in point)
            raise InputError(
                f"must {'end' if end else 'begin'} at a node of the beams: ({at}) m is {gap.min():.4g} m from "
                f"the nearest, {built.book.shown(np.array([close]))}",
                field=place,
            )
    return nodes[on]
