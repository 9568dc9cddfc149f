"""What the rules need to know of a bridge: its spans, and its frequencies of vertical bending."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import AnalysisError, InputError
from axlespan.interaction.line_points import deck_line
from axlespan.linalg.factor import NotPositiveDefinite
from axlespan.model.modal import modes_of
from axlespan.model.parts import BarPart, BeamPart
from axlespan.running.structure import Structure
from axlespan.standards.assessment import Assessment
from axlespan.standards.dynamic_factors import continuous_determinant_length

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Modes that are looked through for three that move the deck up and down; more if there are fewer among them.
_MODES = (12, 40)
# A weight so close to one belongs to the d.o.f. alone; places beside a break, as a share of the line.
_CLOSE, _BESIDE = 1e-6, 1e-9
# Beams and bars with at least this share of their length upward are columns.
_STEEP = 0.8
# A mode counts if the deck's line moves by at least this share of what moves most.
_MOVES = 0.2


@dataclass(frozen=True)
class BridgeFacts:
    """Spans and frequencies of a bridge; empty where they are not known."""

    starts: tuple[float, ...] = ()  # begin of each span along the deck's line [m]
    spans: tuple[float, ...] = ()  # [m]
    continuous: bool = False
    simple: bool = True
    determinant_length: float | None = None  # [m]
    frequencies: tuple[float, ...] = ()  # of the deck's vertical bending, ascending [Hz]
    damping_ratio: float | None = None  # of the first of these modes in the model [-]
    missing: str = ""  # why spans are not known

    @property
    def first_frequency(self) -> float | None:
        """n0 [Hz]."""
        return self.frequencies[0] if self.frequencies else None

    @property
    def words(self) -> str:
        """One line for people."""
        parts = [self.missing]
        if self.spans:
            kind = "continuous" if self.continuous else "simple"
            lengths = ", ".join(f"{span:.4g}" for span in self.spans)
            parts = [f"{kind} span{'s' if len(self.spans) > 1 else ''} of {lengths} m"]
        if self.determinant_length is not None:
            parts.append(f"L_Φ {self.determinant_length:.4g} m")
        if self.frequencies:
            parts.append(f"n0 {self.frequencies[0]:.4g} Hz")
        return ", ".join(part for part in parts if part)


def bridge_facts(structure: Structure, assessment: Assessment) -> BridgeFacts:
    """Spans, frequencies and damping of a structure; what the assessment says of them goes before.

    Parameters
    ----------
    structure : Structure
    assessment : Assessment
    """
    path = deck_line(structure)
    found = _spans_of(structure) if assessment.spans is None else _laid_out(assessment.spans, path.start)
    missing = "" if found.spans else "the spans are not known: give spans"
    if found.spans and found.starts[-1] + found.spans[-1] > path.stop + 1e-6 * (path.stop - path.start):
        found, missing = _Spans(), f"the spans are longer than the line, {path.stop - path.start:g} m"
    starts, spans = found.starts, found.spans
    continuous = len(spans) > 1 and not found.hinged
    if assessment.continuous is not None:
        continuous = assessment.continuous
    frequencies, damping = _vertical_modes(structure)
    if assessment.first_frequency is not None:
        frequencies = (assessment.first_frequency, *(f for f in frequencies[1:]))
    length = assessment.determinant_length
    if length is None and spans:
        length = continuous_determinant_length(spans) if continuous else max(spans)
    return BridgeFacts(starts, spans, continuous, assessment.simple, length, frequencies, damping, missing)


@dataclass(frozen=True)
class _Spans:
    """Begin and length of each span [m], and whether all inner ends are hinged."""

    starts: tuple[float, ...] = ()
    spans: tuple[float, ...] = ()
    hinged: bool = False


def _laid_out(spans: tuple[float, ...], start: float) -> _Spans:
    ends = start + np.concatenate([[0.0], np.cumsum(spans)])
    return _Spans(tuple(ends[:-1].tolist()), tuple(spans))


def _spans_of(structure: Structure) -> _Spans:
    """Spans between the places of the deck's line that are held vertically; hinged where two decks meet."""
    system, path = structure.system, deck_line(structure)
    held = _held(structure)
    if not len(held):
        return _Spans()
    places = path.breaks
    nudge = _BESIDE * (path.stop - path.start)
    sides = [
        np.asarray(path.rows(np.clip(places + way, path.start, path.stop), system.size)[:, held].toarray())
        for way in (-nudge, nudge)
    ]
    on = [np.abs(side - 1.0) < _CLOSE for side in sides]
    at = np.flatnonzero(on[0].any(axis=1) | on[1].any(axis=1))
    if len(at) < 2:
        return _Spans()
    inner = at[1:-1]
    hinged = bool(len(inner)) and bool(np.all(~(on[0][inner] & on[1][inner]).any(axis=1)))
    return _Spans(tuple(places[at[:-1]].tolist()), tuple(np.diff(places[at]).tolist()), hinged)


def _held(structure: Structure) -> IntArray:
    """Independent vertical d.o.f. of the deck's line that supports, springs to the ground or columns hold."""
    system, path = structure.system, deck_line(structure)
    vertical = np.array([system.components[i] == "z" for i in system.independent], dtype=bool)
    grounds = system.prescribed[vertical[system.prescribed]]
    held = np.concatenate([grounds, _on_springs(structure, grounds), _on_columns(structure)])
    held = np.intersect1d(held, path.path_dofs)
    return np.asarray(held[vertical[held]], dtype=np.int64)


def _on_springs(structure: Structure, grounds: IntArray) -> IntArray:
    """Independent d.o.f. that a spring alone joins to a prescribed one off the line: k beside it, -k across."""
    system, path = structure.system, deck_line(structure)
    found = []
    for ground in np.setdiff1d(grounds, path.path_dofs):
        row = system.stiffness[[int(ground)]].tocoo()
        other = (row.col != ground) & (row.data != 0.0)
        own = float(row.data[row.col == ground].sum())
        if np.count_nonzero(other) == 1 and abs(float(row.data[other][0]) + own) <= _CLOSE * own:
            found.append(int(row.col[other][0]))
    return np.array(found, dtype=np.int64)


def _on_columns(structure: Structure) -> IntArray:
    """Independent d.o.f. that the upper ends of steep beams and bars move with."""
    system, model = structure.system, structure.model
    tops: set[int] = set()
    for part in () if model is None else model.parts:
        if model is None or not isinstance(part, (BeamPart, BarPart)):
            continue
        ends = model.points[part.nodes]
        drop = ends[:, 1, 2] - ends[:, 0, 2]
        steep = np.abs(drop) > _STEEP * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        upper = np.where(drop > 0.0, part.nodes[:, 1], part.nodes[:, 0])
        tops |= set(upper[steep].tolist())
    if model is None or not tops:
        return np.zeros(0, dtype=np.int64)
    rows = system.elimination[[system.dof(f"{model.node_label(node)}.z") for node in sorted(tops)]].tocoo()
    return np.asarray(rows.col[np.abs(rows.data - 1.0) < _CLOSE], dtype=np.int64)


def _vertical_modes(structure: Structure) -> tuple[tuple[float, ...], float | None]:
    """Three lowest frequencies [Hz] of modes that move the deck's line vertically, and the first's damping."""
    system, path = structure.system, deck_line(structure)
    places = np.linspace(path.start, path.stop, 201)
    rows = path.rows(places, system.size)[:, system.free]
    moves = np.array([system.components[int(system.independent[i])] in ("x", "y", "z") for i in system.free])
    for number in _MODES:
        try:
            modes = modes_of(system, min(number, len(system.free)))
        except (AnalysisError, InputError, NotPositiveDefinite):
            return (), None
        motion = np.abs(np.asarray(rows @ modes.modes.shapes)).max(axis=0)
        most = np.abs(modes.modes.shapes[moves]).max(axis=0, initial=0.0)
        chosen = np.flatnonzero((motion >= _MOVES * most) & (modes.modes.frequencies > 0.0))[:3]
        if len(chosen) == 3 or number >= len(system.free):
            break
    if not len(chosen):
        return (), None
    return tuple(modes.modes.frequencies[chosen].tolist()), float(modes.damping_ratio[chosen[0]])
