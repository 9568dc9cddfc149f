"""Checks of what a case describes that need it built: whether it stands, and what overlaps."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from axlespan.errors import InputError
from axlespan.interaction.line_points import deck_line
from axlespan.linalg.factor import NotPositiveDefinite, available
from axlespan.running.structure import Structure
from axlespan.study import case_structure
from axlespan.study.case import Case
from axlespan.study.source import Source
from axlespan.units import LENGTH, show
from axlespan.vehicles import Train

# Elements of a span from which on its stiffness matrix has no digit to spare: the smallest eigenvalue of the
# scaled matrix is 4/n^4 (linalg.definiteness).
_MANY = 5000

_SHOWN = 4

# Share of the deck's length that spans cover at least: the rest are overhangs.
_SPANNED = 0.8

_PACKAGES = {"pardiso": "pip install mkl", "cholmod": "pip install cvxopt"}


def require_stable(structure: Structure, case: case_structure.Structure) -> None:
    """Require supports that hold a structure; d.o.f. that move freely are named with their positions.

    Raises
    ------
    InputError
    """
    try:
        structure.require_stable()
    except InputError as error:
        cause = error.__cause__
        if not isinstance(cause, NotPositiveDefinite):
            raise
        most = _most_elements(case)
        if most > _MANY and cause.kind == "mechanism":
            raise InputError(
                "makes elements so short that their stiffness drowns in rounding",
                field="elements",
                value=most,
                fix=f"Use at most {_MANY} in a span; 20 to 100 are plenty for most",
            ) from error
        names = [structure.system.free_name(int(i)) for i in cause.suspects[:_SHOWN]]
        places = ", ".join(name + at for name, at in zip(names, _positions(structure, names), strict=True))
        raise InputError(
            f"{error.rule.partition(': ')[0]}: it can move freely at {places}", fix=error.fix
        ) from error


def _most_elements(case: case_structure.Structure) -> int:
    if isinstance(case, case_structure.SimpleSpan):
        return case.elements
    if isinstance(case, (case_structure.ContinuousBeam, case_structure.SimpleSpans, case_structure.Frame)):
        return max(span.elements or 0 for span in case.spans)
    return 0


def _positions(structure: Structure, names: list[str]) -> Iterator[str]:
    """Where the nodes of d.o.f. stand, in words; empty where that is not known."""
    model = structure.model
    for name in names:
        node = name.rpartition(".")[0]
        if model is None or not (node[:1] == "n" and node[1:].isdigit()) or node in model.node_names:
            yield ""
            continue
        yield f" (x = {show(float(model.points[int(node[1:]) - 1, 0]), LENGTH, 4)})"


def require_solver(kind: str) -> None:
    """Require that the chosen factorization is installed.

    Raises
    ------
    InputError
    """
    if kind != "auto" and kind not in available():
        raise InputError(
            "is not installed here",
            field="solver",
            value=kind,
            fix=f"Write {', '.join(('auto', *available()))}, or {_PACKAGES.get(kind, 'install it')}",
        )


def require_modes(structure: Structure, modes: int | None) -> None:
    """Require that a structure has as many modes as a reduced basis is to hold.

    Raises
    ------
    InputError
    """
    system = structure.system
    there = int(np.count_nonzero(system.mass.diagonal()[system.free]))
    if modes is not None and modes > there:
        rule = f"must be at most {there}, the number of d.o.f. with mass"
        raise InputError(rule, field="modes", value=modes, fix="Leave it out; Ritz vectors alone will do")


def other_spans(structure: Structure, case: Case, source: Source) -> Iterator[str]:
    """Warn of spans to assess that end far before the deck does, or behind it."""
    if case.assessment is None or case.assessment.spans is None:
        return
    path = deck_line(structure)
    length, total = path.stop - path.start, sum(case.assessment.spans)
    if _SPANNED * length <= total <= (1.0 + 1e-6) * length:
        return
    rule = f"add up to {show(total, LENGTH, 4)}, and the deck is {show(length, LENGTH, 4)} long"
    yield str(source.blame("assessment.spans", rule, "Leave them out where the structure knows its spans"))


def overlaps(train: Train, source: Source) -> Iterator[str]:
    """Warn of vehicles that stand within each other: one line for the first pair."""
    items = train.placements
    first = np.array([item.behind for item in items])
    last = first + np.array([max(point.behind for point in item.vehicle.contacts) for item in items])
    foremost = np.maximum.accumulate(last)
    inside = np.flatnonzero(first[1:] <= foremost[:-1])
    if not len(inside):
        return
    late = int(inside[0]) + 1
    early = int(np.argmax(last[:late] >= first[late]))
    rule = (
        f"vehicle {late + 1} begins {show(float(first[late] - first[early]), LENGTH, 4)} behind the first wheel of "
        f"vehicle {early + 1}, whose last wheel is {show(float(last[early] - first[early]), LENGTH, 4)} behind it"
    )
    yield str(source.blame("train", rule, "Look at spacing, gap and offset, if they should not overlap"))
