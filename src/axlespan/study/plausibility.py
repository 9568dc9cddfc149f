"""Values that are possible and look wrong: a unit forgotten, a power of ten lost.

What a plain number makes absurd is refused, with the unit that was probably meant; what has a unit is
believed and only warned of.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Any, Final, get_args, get_origin

from pydantic.fields import FieldInfo

from axlespan import units
from axlespan.errors import InputError
from axlespan.study.case import Case
from axlespan.study.case_structure import SimpleSpan
from axlespan.study.case_train import SprungMass
from axlespan.study.check_lists import Several
from axlespan.study.checks import Measured, Part
from axlespan.study.source import Source

DEEPEST_SAG: Final = 1.0  # m; suspensions of rail and road vehicles sag by 5 to 300 mm
FASTEST_LINE: Final = 84.0  # m/s, 300 km/h

Findings = tuple[list[InputError], list[InputError]]


def review(case: Case, source: Source) -> Findings:
    """Return what must be refused and what is worth a warning."""
    refusals: list[InputError] = []
    warnings = [*_unusual(case, source, ()), *_fast(case, source)]
    for found, has_unit in (*_sagging(case, source), *_stiff_or_soft(case, source)):
        (warnings if has_unit else refusals).append(found)
    return refusals, warnings


def _unusual(value: Any, source: Source, path: tuple[str | int, ...]) -> Iterator[InputError]:
    """Find quantities of an unusual magnitude; those without unit have been refused before."""
    if isinstance(value, Part):
        for name, info in type(value).model_fields.items():
            inner, key = getattr(value, name), info.alias or name
            yield from _judged(inner, info, source, (*path, key))
            yield from _unusual(inner, source, (*path, key))
    elif isinstance(value, dict):
        for name, inner in value.items():
            yield from _unusual(inner, source, (*path, name))
    elif isinstance(value, tuple) and value and isinstance(value[0], Part):
        for number, inner in enumerate(value):
            yield from _unusual(inner, source, (*path, number))


def _judged(value: Any, info: FieldInfo, source: Source, path: tuple[str | int, ...]) -> Iterator[InputError]:
    for check in (*info.metadata, *_checks(info.annotation)):
        measure = check.item if isinstance(check, Several) else check
        if not isinstance(measure, Measured) or source.written(path) is None:
            continue
        values = value if isinstance(value, tuple) else (value,)
        for number, one in enumerate(values):
            if isinstance(one, float) and not measure.is_believable(one):
                spot = (*path, number) if isinstance(value, tuple) else path
                yield source.blame(spot, "is unusual; is its unit right?")


def _checks(annotation: Any) -> Iterator[Any]:
    if get_origin(annotation) is Annotated:
        inner, *checks = get_args(annotation)
        yield from checks
        yield from _checks(inner)
    else:
        for part in get_args(annotation):
            yield from _checks(part)


def _fast(case: Case, source: Source) -> Iterator[InputError]:
    others = ((f"other_trains.{n}.speed", other.speed) for n, other in enumerate(case.other_trains))
    for path, speed in (("crossing.speed", case.crossing.speed), *others):
        if speed is not None and speed > FASTEST_LINE and not _has_unit(source, path):
            yield source.blame(path, *fast(speed))


def fast(speed: float) -> tuple[str, str]:
    """Return what is said of a speed without unit [m/s] that no line allows, and what to do."""
    rule = f"is taken as {speed:g} m/s, which is {units.show(speed, units.SPEED)}"
    return rule, f"Write {speed:g} km/h if that is meant"


def _sagging(case: Case, source: Source) -> Iterator[tuple[InputError, bool]]:
    """Find springs that their mass would squeeze flat: N/m where kN/m were meant."""
    for number, vehicle in enumerate(case.train):
        if not isinstance(vehicle, SprungMass):
            continue
        sag = vehicle.mass * case.analysis.gravity / vehicle.stiffness
        if sag > DEEPEST_SAG:
            path = f"train.{number}.stiffness"
            rule = (
                f"is so soft that {units.show(vehicle.mass, units.MASS)} sag by "
                f"{units.show(sag, units.LENGTH)} under their weight"
            )
            has_unit = _has_unit(source, path)
            yield source.blame(path, rule, _intended(source, path, "kN/m", "N/m", has_unit)), has_unit


def _stiff_or_soft(case: Case, source: Source) -> Iterator[tuple[InputError, bool]]:
    """Find spans whose first frequency no bridge of that length has: t/m taken for kg/m.

    Ten times beyond the limits of EN 1991-2, figure 6.10, which hold for railway bridges from 4 to 100 m.
    """
    beam = case.structure
    if not isinstance(beam, SimpleSpan) or beam.supports is not None:
        return
    bending = beam.youngs_modulus * beam.second_moment
    frequency = math.pi / (2.0 * beam.length**2) * math.sqrt(bending / beam.mass_per_length)
    low, high = _usual_frequencies(beam.length)
    if low / 10.0 <= frequency <= 10.0 * high:
        return
    path = "structure.mass_per_length"
    tons = low / 10.0 <= frequency / math.sqrt(1000.0) <= 10.0 * high and not _has_unit(source, path)
    rule = (
        f"with it the first frequency of the span is {units.show(frequency, units.FREQUENCY)}; "
        f"bridges of {units.show(beam.length, units.LENGTH)} have {low:.2g} to {high:.2g} Hz"
    )
    if tons and beam.mass_per_length < 200.0:
        yield source.blame(path, rule, _intended(source, path, "t/m", "kg/m", False)), False
    else:
        yield source.blame("structure.second_moment", rule, "Look at the units of all properties"), True


def _usual_frequencies(length: float) -> tuple[float, float]:
    """Return the limits of the first frequency of railway bridges [Hz], EN 1991-2 (6.1) to (6.3)."""
    low = 80.0 / length if length <= 20.0 else 23.58 * length**-0.592
    return low, 94.76 * length**-0.748


def _has_unit(source: Source, path: str) -> bool:
    written = source.written(path)
    return written is not None and bool(units.read(written.strip("'\"")).unit)


def _intended(source: Source, path: str, unit: str, plain: str, has_unit: bool) -> str | None:
    written = source.written(path)
    return None if has_unit else f"Write {written} {unit}; or {written} {plain}, if that is meant"
