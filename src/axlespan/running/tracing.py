"""Which facets a line runs over: a polyline cut into stretches, each inside one facet.

For every straight piece and every facet near it, the crossings with the facet's sides cut the piece; a cut
belongs to the facet if its middle does. Where several facets claim a stretch (a line along a side, layers
of slabs), the one nearest to the line wins, and of equally near ones the first of the model, so the choice
is the same at every run.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from axlespan.errors import InputError
from axlespan.running.projection import Figures, View

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Stretches shorter than this share of a facet are rounding.
_SLIVER = 1e-9
# Distances that differ by less than this share of the tolerance are the same.
_SAME = 1e-4


@dataclass(frozen=True, eq=False)
class Polyline:
    """Corner points of a line in space; positions are arc lengths from the first."""

    points: FloatArray  # (k, 3) [m]
    start: float = 0.0  # position of the first point [m]

    def __post_init__(self) -> None:
        if self.points.ndim != 2 or self.points.shape[1] != 3 or len(self.points) < 2:
            rule = "must be at least two points of three coordinates"
            raise InputError(rule, field="running line", value=self.points.shape)
        if not np.all(np.isfinite(self.points)):
            bad = int(np.argmin(np.isfinite(self.points).all(axis=1)))
            raise InputError(
                "must be finite", field=f"running line, point {bad + 1}", value=self.points[bad].tolist()
            )
        short = self.lengths <= 1e-9 * self.lengths.max()
        if np.any(short):
            i = int(np.argmax(short))
            raise InputError(
                f"has two equal points, {i + 1} and {i + 2}, at position {self.breaks[i]:g} m",
                field="running line",
                value=_shown(self.points[i]),
                fix="Drop one of them",
            )

    @property
    def lengths(self) -> FloatArray:
        """Lengths (k - 1,) of the pieces [m]."""
        return np.asarray(np.linalg.norm(np.diff(self.points, axis=0), axis=1))

    @property
    def breaks(self) -> FloatArray:
        """Positions (k,) of the points [m]."""
        return self.start + np.concatenate([[0.0], np.cumsum(self.lengths)])

    def at(self, position: FloatArray, piece: IntArray) -> FloatArray:
        """Points (n, 3) at positions (n,) of pieces (n,)."""
        share = ((position - self.breaks[piece]) / self.lengths[piece])[:, None]
        return np.asarray((1.0 - share) * self.points[piece] + share * self.points[piece + 1])


@dataclass(frozen=True, eq=False)
class Stretches:
    """Stretches of a polyline inside one facet and one piece each, in order."""

    begin: FloatArray  # (n,) positions [m]
    end: FloatArray  # (n,)
    piece: IntArray  # (n,) pieces of the polyline
    group: IntArray  # (n,) groups of facets
    facet: IntArray  # (n,) facets in the group

    def __len__(self) -> int:
        return len(self.begin)

    def taken(self, which: npt.NDArray[np.bool_]) -> Stretches:
        """Return some of the stretches."""
        return replace(self, **{f.name: getattr(self, f.name)[which] for f in fields(self)})

    def halved(self) -> Stretches:
        """Return the first and the second halves, out of order."""
        middle = 0.5 * (self.begin + self.end)
        twice = {name: np.tile(getattr(self, name), 2) for name in ("piece", "group", "facet")}
        begin, end = np.concatenate([self.begin, middle]), np.concatenate([middle, self.end])
        return Stretches(begin, end, **twice)


@dataclass(frozen=True, eq=False)
class _Claims:
    """Parts of pieces that lie in a facet."""

    begin: FloatArray
    end: FloatArray
    piece: IntArray
    facet: IntArray  # counted over all groups
    distance: FloatArray  # of the middle from the facet [m]

    @classmethod
    def joined(cls, claims: list[_Claims]) -> _Claims:
        return cls(
            *(
                np.concatenate([getattr(claim, name) for claim in claims])
                for name in ("begin", "end", "piece", "facet", "distance")
            )
        )


def trace(figures: tuple[Figures, ...], line: Polyline, view: View, tolerance: float) -> Stretches:
    """Cut a polyline into stretches.

    Parameters
    ----------
    figures : tuple of Figures
        The facets, seen along the direction of the contact force.
    line : Polyline
    view : View
        The same view.
    tolerance : float
        Largest distance of the line from its facets, across and along the direction [m].

    Raises
    ------
    InputError
        If the line leaves the facets, or a piece of it runs along the direction; it says where.
    """
    across, along = line.points @ view.across, line.points @ view.along
    steps = np.diff(across, axis=0)
    steep = np.linalg.norm(steps, axis=1) < 1e-3 * line.lengths
    if np.any(steep):
        i = int(np.argmax(steep))
        raise InputError(
            f"must not run along the contact force, as from point {i + 1} to {i + 2}",
            field=f"running line at position {line.breaks[i]:g} m",
            value=_shown(line.points[i]),
        )
    first = np.cumsum([0, *(len(f.facets) for f in figures)])
    claims = []
    for i, own in enumerate(figures):
        piece, facet = _neighbors(own, across, tolerance)
        claims.append(_claims(own, line, across, along, piece, facet, tolerance, int(first[i])))
    sizes = np.concatenate([own.radii() for own in figures])
    found = _Claims.joined(claims)
    begin, end, facet = _winners(found, line, float(sizes.min()), tolerance)
    group = np.searchsorted(first, facet, side="right") - 1
    piece = np.clip(
        np.searchsorted(line.breaks, 0.5 * (begin + end), side="right") - 1, 0, len(line.lengths) - 1
    )
    lost = np.flatnonzero(facet < 0)
    if len(lost):
        raise _off(figures, line, float(begin[lost[0]]), float(end[lost[0]]), view)
    return Stretches(begin, end, piece, group, facet - first[group])


def _neighbors(own: Figures, across: FloatArray, tolerance: float) -> tuple[IntArray, IntArray]:
    """Pairs of pieces and facets whose distance lets them meet."""
    centers, radii = own.centers(), 1.2 * own.radii() + tolerance
    tree = cKDTree(centers)
    reach = float(radii.max())
    steps = np.diff(across, axis=0)
    counts = np.maximum(np.ceil(np.linalg.norm(steps, axis=1) / reach).astype(np.int64), 1)
    piece = np.repeat(np.arange(len(steps)), counts)
    rank = np.arange(len(piece)) - np.repeat(np.cumsum(counts) - counts, counts)
    share = ((rank + 0.5) / counts[piece])[:, None]
    near = tree.query_ball_point(across[piece] + share * steps[piece], 1.5 * reach)
    sizes = np.array([len(some) for some in near], dtype=np.int64)
    facet = np.concatenate([np.empty(0, np.int64), *(np.asarray(some, np.int64) for some in near)])
    pairs = np.unique(np.repeat(piece, sizes) * len(centers) + facet)
    piece, facet = np.divmod(pairs, len(centers))
    # Distance of the center from the piece.
    away = centers[facet] - across[piece]
    along = (away * steps[piece]).sum(axis=1) / (steps[piece] ** 2).sum(axis=1)
    away -= np.clip(along, 0.0, 1.0)[:, None] * steps[piece]
    close = np.linalg.norm(away, axis=1) <= radii[facet]
    return piece[close], facet[close]


def _claims(
    own: Figures,
    line: Polyline,
    across: FloatArray,
    along: FloatArray,
    piece: IntArray,
    facet: IntArray,
    tolerance: float,
    first: int,
) -> _Claims:
    step = np.diff(across, axis=0)[piece]
    t = np.clip(own.crossings(facet, across[piece], step, 2.0 * tolerance), 0.0, 1.0)
    t = np.sort(np.column_stack([np.zeros(len(t)), t, np.ones(len(t))]), axis=1)  # nan last
    # Ends and crossings: the last one of a row is 1, or the nan behind it.
    sliver = (_SLIVER * own.radii()[facet] / np.linalg.norm(step, axis=1))[:, None]
    pair, cut = np.nonzero(np.diff(t, axis=1) > sliver)
    begin, end = t[pair, cut], t[pair, cut + 1]
    middle = 0.5 * (begin + end)
    where = across[piece[pair]] + middle[:, None] * step[pair]
    height = along[piece[pair]] + middle * np.diff(along)[piece[pair]]
    xi = own.natural(facet[pair], where)
    found = np.isfinite(xi).all(axis=1)
    pair, begin, end, where, height = pair[found], begin[found], end[found], where[found], height[found]
    xi = xi[found]
    beside, _ = own.positions(facet[pair], own.clamped(xi))
    _, level = own.positions(facet[pair], xi)
    sideways, upward = np.linalg.norm(beside - where, axis=1), np.abs(level - height)
    near = (sideways <= tolerance) & (upward <= tolerance)
    pair, begin, end = pair[near], begin[near], end[near]
    start, length = line.breaks[piece[pair]], line.lengths[piece[pair]]
    return _Claims(
        start + begin * length,
        start + end * length,
        piece[pair],
        facet[pair] + first,
        np.hypot(sideways, upward)[near],
    )


def _winners(
    claims: _Claims, line: Polyline, size: float, tolerance: float
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Stretches and the facet that gets each, -1 where there is none."""
    cuts = np.sort(np.concatenate([line.breaks, claims.begin, claims.end]))
    cuts = cuts[np.concatenate([[True], np.diff(cuts) > 2.0 * _SLIVER * size])]
    cuts[_nearest(cuts, line.breaks)] = line.breaks
    low, high = _nearest(cuts, claims.begin), _nearest(cuts, claims.end)
    count = np.maximum(high - low, 0)
    claim = np.repeat(np.arange(len(low)), count)
    stretch = low[claim] + np.arange(len(claim)) - np.repeat(np.cumsum(count) - count, count)
    rank = np.floor(claims.distance[claim] / (_SAME * tolerance) + 0.5)
    order = np.lexsort([claims.facet[claim], rank, stretch])
    winner = np.full(len(cuts) - 1, -1, dtype=np.int64)
    got, where = np.unique(stretch[order], return_index=True)
    winner[got] = claims.facet[claim[order[where]]]
    winner = _bridged(cuts, winner, tolerance)
    # Join what is in one facet and one piece.
    inner = cuts[1:-1]
    keep = (winner[1:] != winner[:-1]) | np.isin(inner, line.breaks)
    keep = np.concatenate([[True], keep])
    begin = cuts[:-1][keep]
    return begin, np.append(begin[1:], cuts[-1]), winner[keep]


def _bridged(cuts: FloatArray, winner: IntArray, tolerance: float) -> IntArray:
    """Gaps no longer than the tolerance go to the facet before them, at the begin of the line to that after."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], (winner < 0).astype(np.int64), [0]])))
    result = winner.copy()
    for first, last in edges.reshape(-1, 2).tolist():
        if cuts[last] - cuts[first] <= tolerance and last - first < len(winner):
            result[first:last] = winner[first - 1] if first else winner[last]
    return result


def _nearest(cuts: FloatArray, values: FloatArray) -> IntArray:
    """Positions of the nearest of sorted cuts."""
    right = np.clip(np.searchsorted(cuts, values), 1, len(cuts) - 1)
    return np.asarray(right - (values - cuts[right - 1] < cuts[right] - values))


def _off(figures: tuple[Figures, ...], line: Polyline, begin: float, end: float, view: View) -> InputError:
    """Say where the line is off its facets, and how far."""
    middle = np.array([0.5 * (begin + end)])
    piece = np.clip(np.searchsorted(line.breaks, middle, side="right") - 1, 0, len(line.lengths) - 1)
    point = line.at(middle, piece)
    best = (np.inf, np.inf, np.inf, "")
    for own in figures:
        _, which = cKDTree(own.facets.coordinates.mean(axis=1)).query(point[0], k=min(16, len(own.facets)))
        which = np.atleast_1d(which).astype(np.int64)
        target = np.repeat(point @ view.across, len(which), axis=0)
        xi = np.nan_to_num(own.natural(which, target))
        beside, level = own.positions(which, own.clamped(xi))
        sideways = np.linalg.norm(beside - target, axis=1)
        upward = np.abs(level - float((point @ view.along)[0]))
        i = int(np.argmin(np.hypot(sideways, upward)))
        own_best = (float(np.hypot(sideways, upward)[i]), float(sideways[i]), float(upward[i]))
        if own_best[0] < best[0]:
            best = (*own_best, own.facets.label(int(which[i])))
    _, sideways_by, upward_by, label = best
    ways = [f"{upward_by:.3g} m along the contact force"] if upward_by > 0.0 else []
    ways += [f"{sideways_by:.3g} m sideways"] if sideways_by > 0.0 else []
    return InputError(
        f"is not on the faces chosen from {begin:g} to {end:g} m; in the middle the nearest, {label}, is "
        f"{' and '.join(ways) or '0 m'} away",
        field="running line",
        value=_shown(point[0]),
        fix="Move its points onto the surface, choose other faces, or raise the tolerance",
    )


def _shown(point: FloatArray) -> tuple[float, ...]:
    return tuple(float(f"{x:.6g}") for x in point)
