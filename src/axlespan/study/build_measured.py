"""From a table of a case to a profile: filtered, smooth, scaled and shifted as it says."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from axlespan import irregularity as profiles
from axlespan.errors import InputError
from axlespan.irregularity import Profile
from axlespan.irregularity.bands import band_of
from axlespan.study.case_irregularity import TableIrregularity
from axlespan.units import LENGTH, show

_ENTRY = re.compile(r"([xr])\[(\d+)\]")


def table_of(case: TableIrregularity) -> Profile:
    """Return the profile of a table, without its bounds.

    Raises
    ------
    InputError
        If a file is wrong, with its line; if points that are filtered are not at equal distances; if a band does
        not fit the record.
    """
    profile = _filtered(case) if case.is_filtered else _as_it_is(case)
    if case.scale != 1.0:
        profile = profiles.Scaled(profile, case.scale)
    return profiles.Shifted(profile, case.shift) if case.shift else profile


def _as_it_is(case: TableIrregularity) -> Profile:
    if case.points is None:
        assert case.file is not None  # the schema asks for one of the two
        table = profiles.Table.from_csv(case.file)
    else:
        points = np.array(case.points)
        table = profiles.Table(points[:, 0], points[:, 1])
    return profiles.Spline(table.x, table.r) if case.smooth else table


def _filtered(case: TableIrregularity) -> Profile:
    with _in_words_of_the_case():
        if case.points is None:
            assert case.file is not None  # the schema asks for one of the two
            record = profiles.Measurement.from_csv(case.file)
        else:
            points = np.array(case.points)
            record = profiles.Measurement.from_points(points[:, 0], points[:, 1])
    if case.detrend is not None:
        record = record.detrended(case.detrend)
    if case.band is not None:
        _require_fit(record, case.band)
        record = record.filtered(case.band)
    return record.spline() if case.smooth else record.table()


@contextmanager
def _in_words_of_the_case() -> Iterator[None]:
    """Say of unequal distances what a case file can do about them, and where they are."""
    try:
        yield
    except InputError as error:
        fix = error.fix
        if "grid" in error.rule:
            fix = "Points that are filtered must be at equal distances: interpolate them, or leave detrend and band out"
        found = _ENTRY.fullmatch(error.field or "")
        if error.place is None and found is not None:
            field = f"points.{found[2]}.{'xr'.index(found[1])}"
            raise InputError(error.rule, field=field, value=error.value, fix=fix) from error
        more = {"value": error.value} if error.has_value else {}
        raise InputError(error.rule, field=error.field, fix=fix, place=error.place, **more) from error


def _require_fit(record: profiles.Measurement, band: str | tuple[float, float]) -> None:
    """Require a record that is fine and long enough for a band."""
    shortest, longest = band_of(band)
    if record.spacing > shortest / 2.5:
        raise InputError(
            f"has waves of {show(shortest, LENGTH)}, which need points every {show(shortest / 2.5, LENGTH, 3)}; "
            f"those of the record are {show(record.spacing, LENGTH, 3)} apart",
            field="band",
            fix="Take a band of longer waves",
        )
    if record.length < 2.0 * longest:
        raise InputError(
            f"has waves of {show(longest, LENGTH)}, which need a record of {show(2.0 * longest, LENGTH)}; "
            f"this one has {show(record.length, LENGTH, 4)}",
            field="band",
            fix="Take a band of shorter waves, or a longer record",
        )
