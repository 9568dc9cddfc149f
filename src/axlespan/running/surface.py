r"""Running lines on surfaces: polylines over the faces of solids and shells or the edges of plane elements.

Inside a face the weights of the d.o.f. are

.. math:: w_j(s) = N_j(ξ(s)), \qquad x(ξ(s)) = P(s),

with the point P(s) of the line at the position s. On affine faces (triangles and parallelograms with
straight sides) ξ is linear in s and the weights are polynomials, so they are exact; on distorted ones they
are interpolated to 1e-8. Interpolation keeps their sum of one, the rigid rotations and, because the ends of
a stretch are among the points, the continuity from face to face. Derivation: docs/theory/running-lines.md.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.dofs import DofTable
from axlespan.model.model import Model
from axlespan.running.chain import ordered_along
from axlespan.running.facets import TOP, facets_of
from axlespan.running.path import PolynomialPath
from axlespan.running.projection import Figures, View
from axlespan.running.tracing import Polyline, Stretches, trace

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Largest difference of the weights from the shape functions, rotations times the size of a face.
FIT_ERROR = 1e-8
# Weights that are rounding: d.o.f. that don't take part.
_ZERO = 1e-13
_EXACT = 1e-12
# Chebyshev's points of degree 12 hold those of the degrees 1, 2, 3, 4 and 6, so one set of samples serves them all.
_SAMPLES = 0.5 - 0.5 * np.cos(np.pi * np.arange(13) / 12.0)
_DEGREES = (1, 2, 3, 4, 6)
_HALVINGS = 20
# Default tolerance, as a share of the median size of a face.
_TOLERANCE = 0.05


def line_over(
    model: Model,
    table: DofTable,
    points: npt.ArrayLike | str,
    *,
    start: float = 0.0,
    faces: str | None = TOP,
    direction: npt.ArrayLike = (0.0, 0.0, 1.0),
    tolerance: float | None = None,
) -> PolynomialPath:
    """The path along a polyline over a surface, in the model's d.o.f.

    Parameters
    ----------
    model, table
        The model and the numbers of its d.o.f.
    points : array (k, 3), or (k, 2) as x and z, or str
        Points of the line in the running direction [m], or the name of a set of nodes, which are ordered
        along the line they form, from its end with the lower x.
    start : float
        Position of the first point [m]; positions are arc lengths from there.
    faces : str or None
        "top": the outer faces that look along the direction (shells on either side). The name of a part or
        of a set of nodes: the outer faces of that part, or between these nodes. None: all outer faces.
    direction : array (3,)
        Of the contact force; vertical by default. The line meets the face that it covers seen this way.
    tolerance : float, optional
        Largest distance between line and faces [m], sideways and along the direction; 5 % of the median
        size of a face by default.

    Returns
    -------
    PolynomialPath
        Weights of the displacement along the direction; on shells that of the reference surface, where the
        nodes are.

    Raises
    ------
    InputError
        If the line is not on the faces, with the position, the point and the distance; if two points are
        equal, or a set of nodes does not form a line.

    See Also
    --------
    axlespan.running.line.path_on_beams : lines along beams.
    """
    unit = np.asarray(direction, float)
    unit = unit / np.linalg.norm(unit)
    if model.plane and unit[1] != 0.0:
        raise InputError("must lie in the plane of the model", field="direction", value=unit.tolist())
    line = Polyline(_corners(model, points), float(start))
    view = View.of(unit, model.plane)
    figures = tuple(Figures.of(facets, view) for facets in facets_of(model, faces, unit))
    if tolerance is None:
        tolerance = _TOLERANCE * float(np.median(np.concatenate([2.0 * own.radii() for own in figures])))
    stretches = trace(figures, line, view, tolerance)
    fits = []
    for group, own in enumerate(figures):
        fits += _fitted(_Sampler(model, own, line, view, tolerance), table, stretches, group)
    return _path(fits)


def _corners(model: Model, points: npt.ArrayLike | str) -> FloatArray:
    if isinstance(points, str):
        nodes = model.nodes_of(points)
        return model.points[nodes][ordered_along(model.points[nodes], f"nodes of '{points}'")]
    corners = np.atleast_2d(np.asarray(points, float))
    if corners.shape[1] == 2:
        corners = np.column_stack([corners[:, 0], np.zeros(len(corners)), corners[:, 1]])
    return corners


@dataclass(frozen=True, eq=False)
class _Fit:
    """Polynomial weights on stretches."""

    begin: FloatArray  # (n,) positions [m]
    end: FloatArray  # (n,)
    dofs: IntArray  # (n, n_dof)
    coefficients: FloatArray  # (n, n_dof, 7), powers of (s - begin) / (end - begin) ascending


@dataclass(frozen=True, eq=False)
class _Sampler:
    """Weights of the d.o.f. of one group of facets along a line."""

    model: Model
    own: Figures
    line: Polyline
    view: View
    tolerance: float

    def weights(self, some: Stretches) -> FloatArray:
        """Weights (n, 13, n_dof) at the samples of stretches (n,)."""
        position = some.begin[:, None] + (some.end - some.begin)[:, None] * _SAMPLES
        n, n_sample = position.shape
        every = np.repeat(some.facet, n_sample)
        points = self.line.at(position.ravel(), np.repeat(some.piece, n_sample))
        target = points @ self.view.across
        xi = self.own.natural(every, target)
        self._check(every, xi, points, position.ravel())
        natural = xi.reshape(n, n_sample, -1)
        return self.own.facets.weights(self.model.points, some.facet, natural, self.view.along)

    def _check(self, facet: IntArray, xi: FloatArray, points: FloatArray, position: FloatArray) -> None:
        """The line must stay near the facet all along, not in the middle of a stretch only."""
        beside, _ = self.own.positions(facet, self.own.clamped(xi))
        _, level = self.own.positions(facet, xi)
        sideways = np.linalg.norm(beside - points @ self.view.across, axis=1)
        upward = np.abs(level - points @ self.view.along)
        off = ~(np.maximum(sideways, upward) <= self.tolerance)
        if np.any(off):
            i = int(np.argmax(off))
            raise InputError(
                f"is {max(sideways[i], upward[i]):.3g} m off {self.own.facets.label(int(facet[i]))} at {position[i]:g} m; "
                f"the tolerance is {self.tolerance:.3g} m",
                field="running line",
                value=tuple(float(f"{x:.6g}") for x in points[i]),
                fix="Give more points on the surface, or raise the tolerance",
            )


def _fitted(sampler: _Sampler, table: DofTable, stretches: Stretches, group: int) -> list[_Fit]:
    """Polynomial weights on the stretches over one group of facets, halved until they fit."""
    rest = stretches.taken(stretches.group == group)
    scale = np.maximum(sampler.own.radii(), 1.0)  # [m], of rotations
    done: list[_Fit] = []
    for _ in range(_HALVINGS):
        if not len(rest):
            break
        coefficients, error = _interpolated(sampler.weights(rest))
        good = error <= FIT_ERROR * scale[rest.facet]
        fits = rest.taken(good)
        dofs = sampler.own.facets.dofs(table, fits.facet)
        done.append(_Fit(fits.begin, fits.end, dofs, coefficients[good]))
        rest = rest.taken(~good).halved()
    if len(rest):
        label = sampler.own.facets.label(int(rest.facet[0]))
        raise InputError(f"can't be followed at {rest.begin[0]:g} m over {label}", field="running line")
    return done


def _interpolated(weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coefficients (n, n_dof, 7) of the polynomial of lowest degree through samples (n, 13, n_dof), and its error."""
    n, _, n_dof = weights.shape
    coefficients, error = np.zeros((n, n_dof, 7)), np.full(n, np.inf)
    for degree in _DEGREES:
        open_ = np.flatnonzero(error > _EXACT)
        if not len(open_):
            break
        step = 12 // degree
        powers = _SAMPLES[:, None] ** np.arange(degree + 1)
        own = np.linalg.inv(powers[::step]) @ weights[open_, ::step]
        coefficients[open_, :, : degree + 1] = own.transpose(0, 2, 1)
        error[open_] = np.abs(powers @ own - weights[open_]).max(axis=(1, 2), initial=0.0)
    return coefficients, error


def _path(fits: list[_Fit]) -> PolynomialPath:
    begin = np.concatenate([fit.begin for fit in fits])
    order = np.argsort(begin)
    n_dof = max(fit.dofs.shape[1] for fit in fits)
    fits = [_widened(fit, n_dof) for fit in fits]
    dofs = np.concatenate([fit.dofs for fit in fits])[order]
    coefficients = np.concatenate([fit.coefficients for fit in fits])[order]
    coefficients[np.abs(coefficients) < _ZERO] = 0.0
    # D.o.f. that take part come first; what is left over repeats the first of them.
    takes_part = np.any(coefficients != 0.0, axis=2)
    place = np.argsort(~takes_part, axis=1, kind="stable")[:, : int(takes_part.sum(axis=1).max())]
    dofs = np.take_along_axis(dofs, place, axis=1)
    idle = ~np.take_along_axis(takes_part, place, axis=1)
    dofs[idle] = np.broadcast_to(dofs[:, :1], dofs.shape)[idle]
    coefficients = np.take_along_axis(coefficients, place[:, :, None], axis=1)
    n_power = int(np.flatnonzero(np.any(coefficients != 0.0, axis=(0, 1))).max()) + 1
    end = max(float(fit.end.max()) for fit in fits)
    return PolynomialPath(
        np.append(begin[order], end), dofs, np.ascontiguousarray(coefficients[:, :, :n_power])
    )


def _widened(fit: _Fit, width: int) -> _Fit:
    """The fit with places appended that repeat the first d.o.f. with zero weights."""
    more = width - fit.dofs.shape[1]
    dofs = np.concatenate([fit.dofs, np.repeat(fit.dofs[:, :1], more, axis=1)], axis=1)
    return replace(fit, dofs=dofs, coefficients=np.pad(fit.coefficients, ((0, 0), (0, more), (0, 0))))
