"""From the irregularity of a case to profiles: one for all lines, or by the names of lines."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from axlespan import irregularity as profiles
from axlespan.errors import InputError
from axlespan.interaction.crossing import Irregularity
from axlespan.irregularity import Profile
from axlespan.running.structure import Structure
from axlespan.study.build_measured import table_of
from axlespan.study.case_defects import Defect
from axlespan.study.case_irregularity import (
    Bounded,
    HarmonicIrregularity,
    LinesIrregularity,
    NoIrregularity,
    SpectrumIrregularity,
    SumIrregularity,
    TableIrregularity,
)

# Distance of the rails of a track of standard gauge [m].
_BASE = 1.5

Case = (
    NoIrregularity
    | HarmonicIrregularity
    | TableIrregularity
    | SpectrumIrregularity
    | Defect
    | SumIrregularity
    | LinesIrregularity
    | None
)


def irregularity_of(case: Case, structure: Structure) -> Irregularity:
    """Return the profile of a case, or profiles by the names of the structure's lines.

    Raises
    ------
    InputError
        If a file or a spectrum is wrong, or a line is unknown; fields are paths under the irregularity.
    """
    if isinstance(case, LinesIrregularity):
        for name in case.lines:
            _require_line(structure, name, f"lines.{name}")
        return {name: _of_line(name, one) for name, one in case.lines.items()}
    if isinstance(case, SpectrumIrregularity) and case.rails is not None:
        for number, name in enumerate(case.rails):
            _require_line(structure, name, f"rails.{number}")
        return _rails(case, case.rails)
    return _profile(case)


def _require_line(structure: Structure, name: str, field: str) -> None:
    try:
        structure.line(name)
    except InputError as error:
        raise InputError(error.rule, field=field, value=name, fix=error.fix) from error


def _of_line(name: str, case: Case) -> Profile:
    with _under(f"lines.{name}"):
        return _profile(case)


@contextmanager
def _under(path: str) -> Iterator[None]:
    """Say of an error that it stands under a path of the irregularity."""
    try:
        yield
    except InputError as error:
        if error.place is not None:
            raise
        field = ".".join(part for part in (path, error.field) if part)
        more = {"value": error.value} if error.has_value else {}
        raise InputError(error.rule, field=field, fix=error.fix, **more) from error


def _profile(case: Case) -> Profile:
    if case is None or isinstance(case, NoIrregularity):
        return profiles.Smooth()
    if isinstance(case, HarmonicIrregularity):
        if case.taper:
            return _bounded(profiles.Harmonic(case.amplitude, case.wavelength, case.phase), case)
        return profiles.Harmonic(case.amplitude, case.wavelength, case.phase, case.from_, case.to)
    if isinstance(case, TableIrregularity):
        return _bounded(table_of(case), case)
    if isinstance(case, SumIrregularity):
        return profiles.Sum(tuple(_terms(case)))
    if isinstance(case, Defect):
        return case.profile
    assert isinstance(case, SpectrumIrregularity)
    shape = _spectrum(case)
    band = _band(case) or shape.wavelengths
    with _blaming_the_band(case):
        made = profiles.realize(shape, _length(case, band), seed=case.seed, wavelengths=band)
    return _finished(made, case)


def _terms(case: SumIrregularity) -> Iterator[Profile]:
    for number, one in enumerate(case.of):
        with _under(f"of.{number}"):
            yield _profile(one)


def _spectrum(case: SpectrumIrregularity) -> profiles.Spectrum:
    """The spectrum by its name, or from its file."""
    if case.file is not None:
        return profiles.read_spectrum(case.file)
    assert case.name is not None  # the schema asks for one of the two
    return profiles.spectrum(case.name)


def _rails(case: SpectrumIrregularity, rails: tuple[str, ...]) -> dict[str, Profile]:
    """Profiles of the two rails, correlated through level and cross level."""
    assert case.name is not None  # a file holds no cross level
    level, cross = profiles.spectrum(case.name), profiles.spectrum(case.name, "cross level")
    both = (level.wavelengths, cross.wavelengths)
    band = _band(case) or (max(low for low, _ in both), min(high for _, high in both))
    with _blaming_the_band(case):
        pair = profiles.realize_pair(
            case.name, _length(case, band), seed=case.seed, wavelengths=band, base=case.base or _BASE
        )
    return {line: _finished(made, case) for line, made in zip(rails, (pair.left, pair.right), strict=True)}


def _band(case: SpectrumIrregularity) -> tuple[float, float] | None:
    return None if case.wavelengths is None else (case.wavelengths[0], case.wavelengths[1])


def _length(case: SpectrumIrregularity, band: tuple[float, float]) -> float:
    """Length without repetition [m]."""
    low, high = band
    return 20.0 * high if case.components is None else case.components / (1.0 / low - 1.0 / high)


@contextmanager
def _blaming_the_band(case: SpectrumIrregularity) -> Iterator[None]:
    """Say of a realization that is too long what of the case makes it so."""
    try:
        yield
    except InputError as error:
        if error.field == "n" and case.wavelengths is not None:
            rule = error.rule.replace("lies", "lie", 1)
            fix = "Stay inside, or write a spectrum of your own: file: spectrum.csv"
            raise InputError(rule, field="wavelengths", fix=fix) from error
        if error.field != "length":
            raise
        field = "wavelengths" if case.components is None else "components"
        fix = "Use a narrower band of wavelengths, or fewer components"
        raise InputError(error.rule, field=field, fix=fix) from error


def _finished(profile: Profile, case: SpectrumIrregularity) -> Profile:
    return _bounded(profile if case.scale == 1.0 else profiles.Scaled(profile, case.scale), case)


def _bounded(profile: Profile, case: Bounded) -> Profile:
    if case.from_ is None and case.to is None:
        return profile
    return profiles.Bounded(profile, case.from_, case.to, case.taper)
