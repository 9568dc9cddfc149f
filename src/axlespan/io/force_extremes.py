"""Extremes of the contact forces of a train: which wheel, where, when."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.interaction.result import Result
from axlespan.io.peaks import Peak, force_ratios, highest, lowest, time_of

FloatArray = npt.NDArray[np.float64]


def force_extremes(result: Result, structure: tuple[float, float] | None = None) -> dict[str, Any]:
    """Extremes in newtons and over the static force; empty if there is no contact.

    Parameters
    ----------
    result : Result
    structure : (float, float), optional
        Its ends [m]; with them, extremes on the structure are told too.

    Returns
    -------
    dict
        Steps that were not kept have their extremes in ``*_over_all_steps_N``, without time and place.
    """
    ratios = force_ratios(result)
    largest, smallest = highest(result.contact_force), lowest(result.contact_force)
    top, bottom = highest(ratios), lowest(ratios)
    if largest is None or smallest is None or top is None or bottom is None:
        return {}
    return {
        "largest": _wheel(result, ratios, largest),
        "smallest": _wheel(result, ratios, smallest),
        **_on_structure(result, ratios, structure),
        "largest_over_all_steps_N": max(_over_all_steps(result, "largest", largest)),
        "smallest_over_all_steps_N": min(_over_all_steps(result, "smallest", smallest)),
        "largest_ratio_to_static": _wheel(result, ratios, top),
        "smallest_ratio_to_static": _wheel(result, ratios, bottom),
        "largest_unloading": 1.0 - bottom.value,
    }


def _on_structure(
    result: Result, ratios: FloatArray, structure: tuple[float, float] | None
) -> dict[str, dict[str, Any] | None]:
    names = "largest_on_structure", "smallest_on_structure"
    if structure is None:
        return dict.fromkeys(names)
    on = (result.contact_position >= structure[0]) & (result.contact_position <= structure[1])
    if not on.any():
        return dict.fromkeys(names)
    top = highest(np.where(on, result.contact_force, -np.inf))
    bottom = lowest(np.where(on, result.contact_force, np.inf))
    assert top is not None and bottom is not None
    return dict(zip(names, (_wheel(result, ratios, peak) for peak in (top, bottom)), strict=True))


def _over_all_steps(result: Result, which: str, kept: Peak) -> list[float]:
    """Extremes of each wheel over all steps, kept or not, and that of the kept ones."""
    known = (result.checks.get(f"{which}_contact_force") or {}).values()
    return [kept.value, *(value for value in known if value is not None and np.isfinite(value))]


def _wheel(result: Result, ratios: FloatArray, peak: Peak) -> dict[str, Any]:
    at = peak.row, peak.column
    return {
        "contact": result.contact[peak.column],
        "force_N": result.contact_force[at],
        "ratio_to_static": ratios[at],
        "time_s": time_of(result, peak.row),
        "position_m": result.contact_position[at],
    }
