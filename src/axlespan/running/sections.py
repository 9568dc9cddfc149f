r"""Sections of the beams under a running line: their forces as sparse rows over the d.o.f., and as wheels pass.

At a section, with the rows S and I of :mod:`axlespan.elements.beam_sections` and the share G of wheels that
stand in the same element,

.. math:: (M, V, N, T) = S u + (a_R I + b_R S) \dot u + I \ddot u + \sum_w G(s_w) X_w

for Rayleigh damping C = a_R M + b_R K. G is a piecewise polynomial of the wheel's position s_w, so it is a
:class:`~axlespan.running.path.PolynomialPath` whose d.o.f. are the section forces: footprints spread it as
they spread the line.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.elements import beam_sections
from axlespan.elements.beam_sections import QUANTITIES
from axlespan.errors import InputError
from axlespan.model.assembly import element_dofs
from axlespan.running.beams import REVERSED, BeamTable, carriers, taken
from axlespan.running.line import VERTICAL
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import MAIN_LINE, Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_SHEAR = QUANTITIES.index("shear")
# Sections closer to an end of an element than this share of its length are at the end.
_AT_END = 1e-9


@dataclass(frozen=True, eq=False)
class BeamSections:
    """Sections on the beams under a line; several beams side by side in a segment count together."""

    structure: Structure
    beams: BeamTable
    section: IntArray  # (n_pair,) section that the pair belongs to
    beam: IntArray  # (n_pair,)
    xi: FloatArray  # (n_pair,) from the first end of the beam
    backward: npt.NDArray[np.bool_]  # (n_pair,) whether the beam runs against the line
    n_section: int

    @classmethod
    def at(
        cls,
        structure: Structure,
        segments: IntArray,
        xi: FloatArray,
        line: str = MAIN_LINE,
        *,
        wanted: str = "section_forces",
    ) -> BeamSections:
        """Sections in segments (n_section,) of a line, at ξ (n_section,) from the begin of each.

        ``wanted`` is the input that asks for them, for errors.

        Raises
        ------
        InputError
            If a segment does not run on beams of the structure's model.
        """
        if structure.model is None:
            raise InputError(
                f"must be left out: {structure.name} is given by matrices, and section forces are those of beams",
                field=wanted,
            )
        beams = BeamTable.of(structure.model)
        found = carriers(structure, structure.line(line), beams)
        without = np.setdiff1d(segments, found.segment)
        if len(without):
            at = float(structure.line(line).breaks[without[0]])
            raise InputError(
                f"must lie on beams: no beam carries the running line of {structure.name} from {at:g} m on",
                field=wanted,
                fix="Section forces are those of beams under the line; leave them out elsewhere",
            )
        section, pair = _joined(np.asarray(segments), found.segment)
        backward = found.backward[pair]
        inside = np.where(backward, 1.0 - xi[section], xi[section])
        return cls(structure, beams, section, found.beam[pair], inside, backward, len(segments))

    @property
    def n_row(self) -> int:
        """Number of rows: those of :data:`QUANTITIES` for each section."""
        return self.n_section * len(QUANTITIES)

    def rows(self) -> tuple[sp.csr_array, sp.csr_array, sp.csr_array]:
        """Rows (n_row, n) over the independent d.o.f. for displacements, velocities and accelerations."""
        model, table, n_full = self.beams.model, self.beams.table, self.structure.system.elimination.shape[0]
        static, damping, inertial = (sp.csr_array((self.n_row, n_full)) for _ in range(3))
        for part, at, elements in self.beams.by_part(self.beam):
            own = taken(part, elements)
            ends = own.coordinates(model.points)
            pair = beam_sections.section_rows(ends, own.properties, own.frame(model.points), self.xi[at])
            if own.offset is not None:
                arms = own.arms()
                pair = (pair[0] @ arms, pair[1] @ arms)
            dofs = element_dofs(own, table)
            signs = self._signs(at)[:, :, None]
            a, b = (self._matrix(signs * rows[:, :, own.kept()], at, dofs, n_full) for rows in pair)
            rayleigh = model.damping_of(part)
            static, inertial = static + a, inertial + b
            damping = damping + rayleigh.alpha * b + rayleigh.beta * a
        elimination = self.structure.system.elimination
        static, damping, inertial = (sp.csr_array(rows @ elimination) for rows in (static, damping, inertial))
        return static, damping, inertial

    def _signs(self, at: IntArray) -> FloatArray:
        """Of the section forces (n, 4) in the sense of the line: along it, V = dM/ds."""
        signs = np.ones((len(at), len(QUANTITIES)))
        signs[self.backward[at], _SHEAR] = -1.0
        return signs

    def _matrix(self, rows: FloatArray, at: IntArray, dofs: IntArray, n: int) -> sp.csr_array:
        numbers = self.section[at, None] * len(QUANTITIES) + np.arange(len(QUANTITIES))
        row = np.broadcast_to(numbers[:, :, None], rows.shape)
        column = np.broadcast_to(dofs[:, None, :], rows.shape)
        shape = (self.n_row, n)
        return sp.csr_array(sp.coo_array((rows.ravel(), (row.ravel(), column.ravel())), shape=shape))

    def influence(self, line: str = MAIN_LINE) -> PolynomialPath | None:
        """Share G of a wheel on a line in the section forces; None if the line never runs on these beams.

        The path's d.o.f. are the rows. A wheel right over a section counts as after it, as at any break.
        """
        path = self.structure.line(line)
        found = carriers(self.structure, path, self.beams)
        mine, theirs = _joined(self.beam, found.beam)
        if not len(mine):
            return None
        segment, against = found.segment[theirs], found.backward[theirs]
        place = np.where(against, 1.0 - self.xi[mine], self.xi[mine])
        pieces, breaks = _pieces(path.breaks, segment, place)
        piece, pair = _joined(pieces.segment, segment)
        chosen = mine[pair]
        polynomials = self._wheel_polynomials(chosen)  # of η from the first end of the beam
        after = (pieces.middle[piece] > place[pair]) ^ against[pair]
        own = np.where(after[:, None, None], polynomials[:, 1], polynomials[:, 0])
        own = np.where(against[pair][:, None, None], own @ REVERSED, own)
        own = _substituted(own, pieces.begin[piece], pieces.size[piece]) * self._signs(chosen)[:, :, None]
        rows = self.section[chosen, None] * len(QUANTITIES) + np.arange(len(QUANTITIES))
        return _path(breaks, piece, rows, own)

    def _wheel_polynomials(self, pairs: IntArray) -> FloatArray:
        """Of wheels before and after the section (n, 2, 4, 4), of η in the beam; beams side by side share them."""
        points = self.beams.model.points
        result = np.zeros((len(pairs), 2, len(QUANTITIES), 4))
        for part, at, elements in self.beams.by_part(self.beam[pairs]):
            own = taken(part, elements)
            ends, frame = own.coordinates(points), own.frame(points)
            result[at] = beam_sections.wheel_polynomials(
                ends, own.properties, frame, self.xi[pairs[at]], VERTICAL
            )
        side_by_side = np.bincount(self.section, minlength=self.n_section)[self.section[pairs]]
        return result / side_by_side[:, None, None, None]


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Pieces of segments between sections."""

    segment: IntArray  # (n_piece,)
    begin: FloatArray  # (n_piece,) ξ
    size: FloatArray  # (n_piece,)

    @property
    def middle(self) -> FloatArray:
        """ξ of the middles (n_piece,)."""
        return self.begin + 0.5 * self.size


def _pieces(breaks: FloatArray, segment: IntArray, place: FloatArray) -> tuple[_Pieces, FloatArray]:
    """Segments of a line, cut at places ξ inside them; the pieces' ends along the line [m]."""
    inner = (place > _AT_END) & (place < 1.0 - _AT_END)
    keys = np.unique(np.concatenate([np.arange(len(breaks)), segment[inner] + place[inner]]))
    keys = keys[np.concatenate([[True], np.diff(keys) > _AT_END])]
    begin, end = keys[:-1], keys[1:]
    number = np.floor(begin).astype(np.int64)
    ends = np.interp(keys, np.arange(len(breaks)), breaks)
    return _Pieces(number, begin - number, end - begin), ends


def _joined(left: IntArray, right: IntArray) -> tuple[IntArray, IntArray]:
    """All pairs of positions with left[i] == right[j], ordered by i."""
    order = np.argsort(right, kind="stable")
    first = np.searchsorted(right[order], left, side="left")
    count = np.searchsorted(right[order], left, side="right") - first
    i = np.repeat(np.arange(len(left)), count)
    rank = np.arange(len(i)) - np.repeat(np.cumsum(count) - count, count)
    return i, order[first[i] + rank]


def _substituted(polynomials: FloatArray, begin: FloatArray, size: FloatArray) -> FloatArray:
    """Polynomials (n, 4, 4) of ξ = begin + size τ in powers of τ."""
    turn = np.zeros((len(begin), 4, 4))
    for p in range(4):
        for q in range(p + 1):
            turn[:, p, q] = comb(p, q) * begin ** (p - q) * size**q
    return np.asarray(polynomials @ turn)


def _path(breaks: FloatArray, piece: IntArray, rows: IntArray, polynomials: FloatArray) -> PolynomialPath:
    """A path of pieces from entries: piece (n,), rows (n, 4), polynomials (n, 4, 4), ordered by piece."""
    n_piece = len(breaks) - 1
    rank = np.arange(len(piece)) - np.searchsorted(piece, piece)
    most = int(rank.max()) + 1
    dofs = np.zeros((n_piece, most, rows.shape[1]), dtype=np.int64)
    coefficients = np.zeros((n_piece, most, rows.shape[1], 4))
    dofs[piece, rank], coefficients[piece, rank] = rows, polynomials
    return PolynomialPath(breaks, dofs.reshape(n_piece, -1), coefficients.reshape(n_piece, -1, 4))
