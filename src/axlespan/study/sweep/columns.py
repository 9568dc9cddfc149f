"""The columns of the table of scenarios, which are known before anything runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from axlespan import units
from axlespan.errors import InputError
from axlespan.study.case import Case
from axlespan.study.sweep.axes import Values
from axlespan.study.sweep.peaks import COLUMNS, OF_SENSORS
from axlespan.study.sweep.scenarios import Scenarios
from axlespan.study.sweep.spec import Spec
from axlespan.study.sweep.verdicts import verdict_columns

# Values of a path that are looked at.
_LOOKED_AT = 2000


def columns_of(spec: Spec, scenarios: Scenarios, case: Case) -> dict[str, str]:
    """Names and kinds of the columns: id, what varies, how it ended, extremes, files of histories."""
    result = {"id": "int"}
    result |= {part.path: _kind(part) for part in scenarios.parts}
    result |= {name: kind for name, kind in COLUMNS.items() if name != "id"}
    result |= verdict_columns(case)
    for name in case.output.sensors:
        result |= {f"sensor.{name}.{quantity}": "number" for quantity in OF_SENSORS}
    if spec.kept is not None:
        result["histories"] = "text"
    if spec.recording is not None:
        result["records"] = "text"
    return result


def _kind(part: Values) -> str:
    """Whether the values of a path are numbers in the table, or texts."""
    if part.labels is not None or isinstance(part.values, range):
        return "text" if part.labels is not None else "number"
    step = max(1, len(part.values) // _LOOKED_AT)
    return "number" if _all_numbers(part.values[::step]) else "text"


def _all_numbers(values: Sequence[Any]) -> bool:
    for value in values:
        if isinstance(value, bool) or not isinstance(value, int | float | str):
            return False
        if isinstance(value, str):
            try:
                units.read(value)
            except InputError:
                return False
    return True
