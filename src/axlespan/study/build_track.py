"""Track of a case: on its bridge, or as its structure."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeVar

from axlespan.bridges import Track, Zone, ballasted_track, slab_track, track_on_ground, with_track
from axlespan.bridges.unilateral import with_unilateral_springs
from axlespan.errors import InputError
from axlespan.running.structure import DECK_LINE, Structure
from axlespan.study import case_track
from axlespan.study.built import BuiltStructure, line_fact
from axlespan.study.faults import InputErrors

T = TypeVar("T")


def track_of(case: case_track.BallastedTrack | case_track.SlabTrack) -> Track:
    """The layers of a track."""
    preset = None if case.preset == case_track.NO_PRESET else case.preset
    if isinstance(case, case_track.BallastedTrack):
        return ballasted_track(preset, rail=case.rail, **case.values())
    return slab_track(preset, rail=case.rail, **case.values())


def laid_on(
    built: BuiltStructure, case: case_track.BallastedTrack | case_track.SlabTrack | None
) -> BuiltStructure:
    """A bridge with the track that its case gives it; the bridge itself if that is none.

    Raises
    ------
    InputError
        Fields are paths under the structure.
    """
    if case is None:
        return built
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        track = _pointed(lambda: track_of(case))
        structure = _pointed(
            lambda: with_track(
                built.structure,
                track,
                approach=case.approach,
                exit=case.exit,
                run_in=case.run_in,
                zones=_zones(case),
                rail_elements=case.rail_elements,
            )
        )
        structure = _pointed(lambda: _resting(structure, case))
    words = tuple(f"track: {warning.message}" for warning in said)
    facts = (*built.facts, *_facts(structure, track))
    return replace(built, structure=structure, facts=facts, warnings=(*built.warnings, *words))


def structure_of_track(case: case_track.TrackStructure) -> BuiltStructure:
    """A track on the ground.

    Raises
    ------
    InputError
        Fields are paths under the structure.
    """
    own = case.track
    track = _pointed(lambda: track_of(own))
    structure = _pointed(
        lambda: track_on_ground(
            track,
            case.length,
            run_in=own.run_in,
            zones=_zones(own),
            rail_elements=own.rail_elements,
            space=case.space,
        ),
        apart=("length",),
    )
    structure = _pointed(lambda: _resting(structure, own))
    return BuiltStructure(structure, tuple(_facts(structure, track)))


def _resting(structure: Structure, case: case_track.BallastedTrack | case_track.SlabTrack) -> Structure:
    """The track with ballast that only pushes, where its case asks for that."""
    if not isinstance(case, case_track.BallastedTrack) or not case.is_unilateral:
        return structure
    assert structure.model is not None
    hanging = [(sleeper.at, sleeper.gap) for sleeper in case.hanging_sleepers]
    names = [part.name for part in structure.model.parts if part.name.partition("-")[0] == "ballast"]
    for name in dict.fromkeys(names):
        structure = with_unilateral_springs(structure, name, hanging=hanging)
    return structure


def _zones(case: case_track.BallastedTrack | case_track.SlabTrack) -> list[Zone]:
    return [Zone(zone.from_, zone.to, _pair(zone.factor), zone.layer) for zone in case.zones]


def _pair(factor: float | tuple[float, ...]) -> tuple[float, float]:
    """Factors at both ends."""
    first, last = factor if isinstance(factor, tuple) else (factor, factor)
    return first, last


def _facts(structure: Structure, track: Track) -> list[str]:
    main = structure.line()
    facts = [
        f"track       {track.name}, rail {track.rail.name}, supports every {track.spacing:g} m, 1/beta = "
        f"{track.characteristic_length:.3g} m",
        line_fact("rail", main, "wheels run here"),
    ]
    if DECK_LINE in structure.lines:
        facts.append(line_fact(DECK_LINE, structure.line(DECK_LINE), "sensors stand here"))
    if track.preset is not None:
        facts.append(f"values      {track.preset.source}")
        if track.preset.to_check:
            facts.append(f"            to be checked: {', '.join(sorted(track.preset.to_check))}")
    return facts


def _pointed(make: Callable[[], T], apart: tuple[str, ...] = ()) -> T:
    """Give errors of the builders their places under ``track``, but for some fields of the structure."""
    try:
        return make()
    except InputErrors:
        raise
    except InputError as error:
        if error.field in apart:
            raise
        more: dict[str, Any] = {"value": error.value} if error.has_value else {}
        field = f"track.{error.field}" if error.field else "track"
        raise InputError(error.rule, field=field, fix=error.fix, **more) from error
