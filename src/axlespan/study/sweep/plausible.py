"""What is implausible in a study: its base as in a run, and speeds without unit that were probably meant in km/h."""

from __future__ import annotations

from collections.abc import Iterator

from axlespan import units
from axlespan.errors import InputError
from axlespan.study.faults import InputErrors
from axlespan.study.plausibility import FASTEST_LINE, fast, review
from axlespan.study.source import Source
from axlespan.study.sweep.axes import Values
from axlespan.study.sweep.recipe import Recipe
from axlespan.study.sweep.scenarios import Scenarios
from axlespan.study.sweep.validation import case_of


def doubts(recipe: Recipe, scenarios: Scenarios, source: Source) -> tuple[str, ...]:
    """Return what is worth a warning, once for each place.

    Raises
    ------
    InputErrors
        If a run of the base would be refused for what does not vary.
    """
    parts = [part for axis in scenarios.axes for part in axis.parts]
    case = case_of(recipe, recipe.composed(scenarios.values([0])[0]))
    refusals, warnings = review(case, recipe.source)
    refused = [one for one in refusals if not _varies(one, parts)]
    if refused:
        raise InputErrors(refused)
    own = (str(one) for one in warnings if not _varies(one, parts))
    return (*own, *(str(one) for part in parts for one in _fast(part, source)))


def _varies(found: InputError, parts: list[Values]) -> bool:
    field = f"{found.field}."
    return any(field.startswith(f"{part.path}.") for part in parts)


def _fast(part: Values, source: Source) -> Iterator[InputError]:
    """The first speed of a path that has no unit and is faster than lines are."""
    if part.path.rpartition(".")[2] != "speed":
        return
    for number, value in enumerate(part.values):
        plain = not isinstance(value, str) or not units.read(value).unit
        if plain and float(value) > FASTEST_LINE:
            rule, fix = fast(float(value))
            yield source.blame(part.place(number), rule, fix)
            return
