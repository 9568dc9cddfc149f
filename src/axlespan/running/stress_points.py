"""Stresses of solids and resultants of shells under a running line, as sparse rows over the d.o.f."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.elements import plane, shells, solids
from axlespan.errors import InputError
from axlespan.model.assembly import element_dofs
from axlespan.model.compile import dof_table
from axlespan.model.continuum_parts import PlanePart, SolidPart
from axlespan.model.model import Model
from axlespan.model.shell_parts import ShellPart
from axlespan.running.facets import TOP, Facets, facets_of
from axlespan.running.geometry import LineGeometry
from axlespan.running.line import VERTICAL
from axlespan.running.projection import Figures, View
from axlespan.running.structure import MAIN_LINE, Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Components and units: of solids, of plane elements in the x-z plane, of shells with x along global x.
STRESSES = ("xx", "yy", "zz", "xy", "yz", "zx")
PLANE_STRESSES = ("xx", "zz", "zx")
RESULTANTS = ("n_x", "n_y", "n_xy", "m_x", "m_y", "m_xy", "q_x", "q_y")

# How far outside its facet and above it a point may lie, as a share of the size of the facet.
_OUTSIDE, _ABOVE = 1e-6, 0.05
_ALONG_X = 0.99  # shells whose normal is closer to global x take global y in its place


@dataclass(frozen=True, eq=False)
class StressPoints:
    """Stresses at points of a line, the mean of the elements that meet there."""

    names: tuple[str, ...]  # (n_row,) point.component
    rows: sp.csr_array  # (n_row, n) over the independent d.o.f.

    @classmethod
    def at(
        cls,
        structure: Structure,
        names: Sequence[str],
        positions: FloatArray,
        line: str = MAIN_LINE,
        *,
        wanted: str = "stresses",
    ) -> StressPoints:
        """Stresses at named positions (n,) of a line.

        ``wanted`` is the input that asks for them, for errors.

        Raises
        ------
        InputError
            If there are no solids, shells or plane elements at a position.
        """
        if structure.model is None:
            rule = f"must be left out: {structure.name} is given by matrices and has no elements"
            raise InputError(rule, field=wanted)
        places = LineGeometry.of(structure, line).at(positions)
        found = _Facets.of(structure.model, wanted)
        labels: list[str] = []
        blocks = []
        for i, (name, place) in enumerate(zip(names, places, strict=True)):
            components, rows = found.rows(place)
            if not components:
                raise InputError(
                    "must lie on solids, shells or plane elements",
                    field=f"{wanted}.{i}",
                    value=name,
                    fix="Ask for section_forces where the line runs on beams",
                )
            labels += [f"{name}.{component}" for component in components]
            blocks.append(rows)
        stacked = sp.vstack([sp.csr_array((0, structure.system.elimination.shape[0])), *blocks])
        return cls(tuple(labels), sp.csr_array(stacked @ structure.system.elimination))


@dataclass(frozen=True, eq=False)
class _Facets:
    """All facets of a model, seen from above."""

    model: Model
    figures: tuple[Figures, ...]
    view: View

    @classmethod
    def of(cls, model: Model, wanted: str) -> _Facets:
        view = View.of(VERTICAL, model.plane)
        try:
            facets = facets_of(model, TOP, VERTICAL)
        except InputError as error:
            fix = "Ask for section_forces where the line runs on beams"
            raise InputError(error.rule, field=wanted, fix=fix) from error
        return cls(model, tuple(Figures.of(some, view) for some in facets), view)

    def rows(self, place: FloatArray) -> tuple[tuple[str, ...], sp.csr_array]:
        """Components and rows (n_component, n_full) at a point (3,), of the kind of elements that is nearest."""
        target, height = place @ self.view.across, float(place @ self.view.along)
        best: tuple[float, list[tuple[Facets, IntArray, FloatArray]]] = (np.inf, [])
        for figures in self.figures:
            which, xi, miss = _under(figures, target, height)
            if not len(which):
                continue
            nearest = float(miss.min())
            close = miss <= nearest + _ABOVE * float(figures.radii()[which].max())
            item = (figures.facets, which[close], xi[close])
            if nearest < best[0] - 1e-9:
                best = (nearest, [item])
            elif nearest <= best[0] + 1e-9:
                best[1].append(item)
        return _mean(self.model, best[1])


def _under(figures: Figures, target: FloatArray, height: float) -> tuple[IntArray, FloatArray, FloatArray]:
    """Facets that a point lies on as seen from above, ξ there, and the distances in height."""
    apart = np.linalg.norm(figures.centers() - target, axis=1)
    near = np.flatnonzero(apart <= (1.0 + _OUTSIDE) * figures.radii())
    xi = figures.natural(near, np.broadcast_to(target, (len(near), len(target))))
    inside = np.abs(figures.clamped(xi) - xi).max(axis=1, initial=0.0) <= _OUTSIDE  # false for nan
    near, xi = near[inside], figures.clamped(xi[inside])
    if not len(near):
        return near, xi, np.empty(0)
    return near, xi, np.abs(figures.positions(near, xi)[1] - height)


def _mean(
    model: Model, found: list[tuple[Facets, IntArray, FloatArray]]
) -> tuple[tuple[str, ...], sp.csr_array]:
    """Mean of the rows of several elements; the first kind decides on the components."""
    table = dof_table(model)
    total, count = sp.csr_array((0, table.size)), 0
    components: tuple[str, ...] = ()
    for facets, which, xi in found:
        own, rows = _element_rows(model, facets, which, xi)
        if components not in ((), own):
            continue
        dofs = element_dofs(facets.part, table)[facets.elements[which]]
        row = np.broadcast_to(np.arange(len(own))[None, :, None], rows.shape)
        column = np.broadcast_to(dofs[:, None, :], rows.shape)
        entries = sp.coo_array((rows.ravel(), (row.ravel(), column.ravel())), shape=(len(own), table.size))
        total = sp.csr_array(entries) if components == () else total + sp.csr_array(entries)
        components, count = own, count + len(which)
    return components, sp.csr_array(total / max(count, 1))


def _element_rows(
    model: Model, facets: Facets, which: IntArray, xi: FloatArray
) -> tuple[tuple[str, ...], FloatArray]:
    """Components and rows (n, n_component, n_dof) of elements at points of their facets."""
    part, elements = facets.part, facets.elements[which]
    if isinstance(part, ShellPart):
        return RESULTANTS, np.stack(
            [_shell_rows(part, model, int(e), at) for e, at in zip(elements, xi, strict=True)]
        )
    x = part.coordinates(model.points)
    law = part.elasticity
    on_facet = facets.shape.values(xi)
    rows = []
    for facet, element, values in zip(which, elements, on_facet, strict=True):
        local = [int(np.flatnonzero(part.nodes[element] == node)[0]) for node in facets.nodes[facet]]
        at = (values @ part.element.nodes[local])[None]
        own = law[element] if law.ndim == 3 else law
        if isinstance(part, SolidPart):
            one = solids.stress_matrix(part.element, x[[element]], own, at, part.formulation)
        else:
            assert isinstance(part, PlanePart)
            one = plane.stress_matrix(part.element, x[[element]], own, at, part.formulation)
        rows.append(one[0, 0])
    return (STRESSES if isinstance(part, SolidPart) else PLANE_STRESSES), np.stack(rows)


def _shell_rows(part: ShellPart, model: Model, element: int, at: FloatArray) -> FloatArray:
    """Resultants (8, n_dof) at natural coordinates of one shell, from unit displacements."""
    n_dof = 6 * part.nodes.shape[1]
    own = part.taken(np.full(n_dof, element))  # type: ignore[arg-type]
    found = shells.resultants(
        own.shell_kind,
        own.coordinates(model.points),
        own.material,
        own.thickness,
        np.eye(n_dof),
        own.offset,
        own.turning,
        natural=at[None],
    )
    along_y = abs(found.axes[0, 2, 0]) > _ALONG_X
    turned = found.along([0.0, 1.0, 0.0] if along_y else [1.0, 0.0, 0.0])
    every = (turned.normal_forces, turned.moments, turned.shear_forces)
    return np.asarray(np.concatenate([values[:, 0] for values in every], axis=1).T)
