"""A track over a bridge and before and behind it, or on the ground alone, as a structure.

Wheels run on the rails. The last spring under each support stands on the ground, or on the running line of the
bridge: on a node where that line runs on beams, which get nodes there, else by the weights of the line. Deck and
rails move apart from each other along the line; only vertical forces pass.
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from axlespan.bridges.refine import cut_at
from axlespan.bridges.spring_laws import require_no_laws
from axlespan.bridges.track import Track, Zone
from axlespan.bridges.track_base import bases_under, on_ground
from axlespan.bridges.track_layout import (
    RUN_IN,
    Layout,
    layout_on_ground,
    layout_over,
    least_approach,
    usual_approach,
)
from axlespan.bridges.track_model import Side, TrackBuilder
from axlespan.errors import InputError
from axlespan.linalg.low_rank import LowRank
from axlespan.model.compile import Compiled, compile_model, dof_table
from axlespan.model.damping import Modal, Rayleigh
from axlespan.model.model import Model, Tie
from axlespan.model.system import System
from axlespan.running.geometry import LineGeometry
from axlespan.running.line import path_on_beams
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import DECK_LINE, MAIN_LINE, RAIL_LINE, Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Half the distance of the rails' axes, for a track in space without lines of its own [m].
HALF_GAUGE = 0.75
_SIDES = ("left", "right")
_MOST_RAIL_ELEMENTS = 20
# A deck is not cut into shorter beams, in spacings of the supports; a support so near to a node that cannot move hangs on
# the beam, whose shear beside that node then lacks its force. Pieces of 1 cm leave equilibrium open by 2e-6 at most.
_SHORTEST = 0.02
# Modes of the deck that modal damping acts on unless it says how many, as for large models without track.
_DECK_MODES = 40


def with_track(
    bridge: Structure,
    track: Track,
    *,
    approach: float | None = None,
    exit: float | None = None,
    run_in: float = RUN_IN,
    zones: Sequence[Zone] = (),
    rail_elements: int = 2,
    line: str | Sequence[str] | None = None,
) -> Structure:
    """A bridge with a track on it that goes on before and behind it.

    Positions along the line count from the beginning of the bridge as before: the approach has negative ones.
    Lines of the result: ``main`` and ``rail``, the rails, on which wheels run; ``deck``, the bridge's line,
    where sensors stand that name no line. In space there are ``left`` and ``right`` for the wheels of each rail,
    ``main`` is their mean.

    Parameters
    ----------
    bridge : Structure
        Given by a finite element model, in the plane or in space.
    track : Track
        See :func:`~axlespan.bridges.ballasted_track` and :func:`~axlespan.bridges.slab_track`.
    approach, exit : float, optional
        Lengths of track before and behind the bridge [m], made longer up to whole spacings;
        :func:`~axlespan.bridges.usual_approach` of the track when left out.
    run_in : float
        Length at both far ends over which the track grows soft [m].
    zones : sequence of Zone
        Stretches of another stiffness: transition zones, hanging sleepers.
    rail_elements : int
        Beam elements of the rail between two supports.
    line : str or two of them, optional
        Lines of the bridge on which the track lies: its main line in a plane model; in space the lines under
        the left and the right rail, ``("left", "right")`` when left out.

    Raises
    ------
    InputError
        If the bridge is given by matrices, springs of it follow laws already, a value is out of range, or a zone lies
        off the track.

    Examples
    --------
    >>> from axlespan.bridges import ballasted_track, simple_span
    >>> bridge = simple_span(length=12.0, youngs_modulus=34e9, second_moment=0.5, mass_per_length=9e3, elements=10)
    >>> track = with_track(bridge, ballasted_track(), approach=30.0, exit=30.0)
    >>> track.line().start, round(track.line().stop, 9), track.line("deck").stop
    (-30.0, 42.0, 12.0)
    """
    if bridge.model is None:
        raise InputError(
            f"must be a finite element model: {bridge.name} is given by matrices, which name no places",
            field="bridge",
        )
    require_no_laws(bridge, "bridge")
    names = _lines_of(bridge, line)
    under = [bridge.line(name) for name in names]  # skew decks begin at another place under each rail
    begin, end = min(path.start for path in under), max(path.stop for path in under)
    usual = usual_approach(track, run_in)
    before, behind = (usual if given is None else given for given in (approach, exit))
    _warn_of_short(track, run_in, approach, exit)
    layout = layout_over(track, begin, end, before, behind, run_in, zones)
    on_deck = layout.position[layout.on_deck]
    cut = bridge
    for name in names:
        cut = cut_at(cut, on_deck, name, shortest=_SHORTEST * track.spacing)
    assert cut.model is not None
    damping = cut.model.damping
    model = cut.model.with_damping(None)
    if isinstance(damping, Rayleigh):
        model = model.with_part_damping({part.name: damping for part in model.parts})
    geometry = [LineGeometry.of(cut, name) for name in names]
    model, bases = bases_under(model, cut, layout, names, geometry, dof_table(cut.model))
    model, rails = _laid(model, track, layout, geometry, bases, _count(rail_elements))
    compiled = compile_model(model)
    system = _with_deck_damping(
        compiled.system, cut.system, limited=isinstance(damping, Modal) and damping.modes is None
    )
    lines = _rail_lines(model, compiled, layout, rails)
    decks = {name: _moved(path, cut.system, system) for name, path in cut.lines.items()}
    lines |= {
        DECK_LINE if name == MAIN_LINE else name: path for name, path in decks.items() if name not in lines
    }
    if DECK_LINE not in lines:
        lines[DECK_LINE] = next(iter(decks.values()))
    facts = {**bridge.facts, "approach": begin - layout.start, "exit": layout.stop - end}
    return Structure(system, lines, f"{bridge.name} with {track.name}", model, facts)


def track_on_ground(
    track: Track,
    length: float,
    *,
    run_in: float = RUN_IN,
    zones: Sequence[Zone] = (),
    rail_elements: int = 2,
    space: bool = False,
) -> Structure:
    """A track on the ground, from 0 to a length [m], a whole number of spacings.

    Parameters
    ----------
    track, run_in, zones, rail_elements
        As in :func:`with_track`.
    length : float
        [m], with the run-ins at both ends.
    space : bool
        Whether there are two rails, ``left`` and ``right``, on sleepers that roll.

    Raises
    ------
    InputError
        If a value is out of range.
    """
    layout = layout_on_ground(track, length, run_in, zones)
    sides = (HALF_GAUGE, -HALF_GAUGE) if space else (0.0,)
    ends = np.array([0.0, length])
    geometry = [LineGeometry(ends, np.array([[0.0, y, 0.0], [length, y, 0.0]])) for y in sides]
    model = Model(plane=not space)
    model, ground = on_ground(model, geometry[0].at(0.0), "track")
    bases = [np.full(len(layout.position), ground) for _ in sides]
    model, rails = _laid(model, track, layout, geometry, bases, _count(rail_elements))
    compiled = compile_model(model)
    lines = _rail_lines(model, compiled, layout, rails)
    return Structure(compiled.system, lines, track.name, model, {"length": length})


def _warn_of_short(track: Track, run_in: float, approach: float | None, exit: float | None) -> None:
    """Warn of track that ends so near to the bridge that the bridge feels it."""
    least = least_approach(track, run_in)
    for name, length in (("approach", approach), ("exit", exit)):
        if length is not None and run_in <= length < least:
            warnings.warn(
                f"{name} = {length:g} m is shorter than the run-in of {run_in:g} m and 10 characteristic lengths of "
                f"{track.characteristic_length:.3g} m: the bridge may feel where the track ends; use at least "
                f"{least:.3g} m",
                stacklevel=3,
            )


def _count(rail_elements: int) -> int:
    if isinstance(rail_elements, bool) or rail_elements != int(rail_elements):
        raise InputError("must be a whole number", field="rail_elements", value=rail_elements)
    if not 1 <= rail_elements <= _MOST_RAIL_ELEMENTS:
        raise InputError(
            f"must be from 1 to {_MOST_RAIL_ELEMENTS}",
            field="rail_elements",
            value=rail_elements,
            fix="Use 2",
        )
    return int(rail_elements)


def _lines_of(bridge: Structure, line: str | Sequence[str] | None) -> tuple[str, ...]:
    """Lines of the bridge under the track: one in a plane model, two in space."""
    assert bridge.model is not None
    if bridge.model.plane:
        name = MAIN_LINE if line is None else line
        if not isinstance(name, str):
            raise InputError("must be one line in a plane model", field="line", value=list(name))
        bridge.line(name)
        return (name,)
    names = _SIDES if line is None else line
    if isinstance(names, str) or len(names) != 2:
        raise InputError("must be two lines, under the left and the right rail", field="line", value=names)
    missing = [name for name in names if name not in bridge.lines]
    if missing:
        raise InputError(
            f"is no running line of {bridge.name}; a track in space needs one under each rail",
            field="line",
            value=missing[0],
            fix=f"Known: {', '.join(bridge.lines)}",
        )
    return tuple(names)


def _laid(
    model: Model,
    track: Track,
    layout: Layout,
    geometry: Sequence[LineGeometry],
    bases: Sequence[IntArray],
    per_bay: int,
) -> tuple[Model, list[IntArray]]:
    """The model with rails and all under them; the rails' ends are held by the ground."""
    halves = np.concatenate([[layout.start], layout.position, [layout.stop]])
    pieces = [np.linspace(a, b, per_bay + 1)[:-1] for a, b in itertools.pairwise(halves)]
    stations = np.append(np.concatenate(pieces), layout.stop)
    stiffer = 1.0 / layout.compliance(0.5 * (stations[1:] + stations[:-1]))
    at_support = per_bay * (1 + np.arange(len(layout.position)))
    sides = [
        Side(f"-{name}" if name else "", where.at(stations), at_support, base, 1.0 / len(bases), stiffer)
        for name, where, base in zip(_SIDES if len(bases) == 2 else ("",), geometry, bases, strict=True)
    ]
    model, rails = TrackBuilder(model, track, layout).lay(sides)
    ties = []
    for nodes, base in zip(rails, bases, strict=True):
        for end, ground in ((nodes[0], base[0]), (nodes[-1], base[-1])):
            ties += [Tie((int(end), "z"), ((int(ground), "z", 1.0),)), Tie((int(end), "ry"), ())]
    return replace(model, ties=(*model.ties, *ties)), rails


def _rail_lines(
    model: Model, compiled: Compiled, layout: Layout, rails: Sequence[IntArray]
) -> dict[str, PolynomialPath]:
    paths = [
        path_on_beams(model, compiled.table, nodes.tolist(), start=layout.start).transformed(
            compiled.system.elimination
        )
        for nodes in rails
    ]
    if len(paths) == 1:
        return {MAIN_LINE: paths[0], RAIL_LINE: paths[0]}
    left, right = paths
    mean = PolynomialPath(
        left.breaks,
        np.concatenate([left.dofs, right.dofs], axis=1),
        0.5 * np.concatenate([left.coefficients, right.coefficients], axis=1),
    )
    return {MAIN_LINE: mean, RAIL_LINE: mean, "left": left, "right": right}


def _numbers(old: System, new: System) -> IntArray:
    """Independent d.o.f. of the one system in the other, by their names."""
    place = {name: i for i, name in enumerate(new.dof_names)}
    position = np.full(len(new.dof_names), -1, dtype=np.int64)
    position[new.independent] = np.arange(len(new.independent))
    names = [old.dof_names[i] for i in old.independent]
    return position[[place[name] for name in names]]


def _moved(path: PolynomialPath, old: System, new: System) -> PolynomialPath:
    """A line of the bridge in the d.o.f. of bridge and track."""
    return path.renumbered(_numbers(old, new))


def _with_deck_damping(system: System, bridge: System, *, limited: bool) -> System:
    """Modal damping of the bridge, by the modes of the bridge alone, or a limited number of them."""
    if bridge.modal_damping is None:
        return system
    damping = bridge.modal_damping
    own = damping.vectors[:, : _DECK_MODES if limited else None]
    whole = np.full(system.size, -1, dtype=np.int64)
    whole[system.free] = np.arange(len(system.free))
    rows = whole[_numbers(bridge, system)[bridge.free]]
    vectors = np.zeros((len(system.free), own.shape[1]))
    vectors[rows] = own
    return replace(system, modal_damping=LowRank(vectors, damping.coefficients[: own.shape[1]]))
