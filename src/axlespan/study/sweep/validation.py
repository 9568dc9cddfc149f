"""Every value that varies is validated before anything runs; errors point to where it stands in the study."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from axlespan.errors import InputError
from axlespan.irregularity import spectrum_names
from axlespan.study.case import Case
from axlespan.study.faults import InputErrors
from axlespan.study.messages import explain
from axlespan.study.source import Source
from axlespan.study.sweep.axes import Values
from axlespan.study.sweep.recipe import Recipe
from axlespan.study.sweep.scenarios import Scenarios
from axlespan.study.yaml_tree import Written

MOST: Final = 2000
"""Values of one axis that are validated; of a longer one its ends and others in between."""


def case_of(recipe: Recipe, data: Mapping[str, Any]) -> Case:
    """Validate the data of a scenario.

    Raises
    ------
    InputErrors
        Located in the base.
    """
    context: dict[str, Any] = {"folder": Path(recipe.folder), "spectra": spectrum_names()}
    try:
        return Case.model_validate(data, context=context)
    except ValidationError as error:
        raise InputErrors(explain(error, recipe.source)) from None


def validate(recipe: Recipe, scenarios: Scenarios, source: Source) -> None:
    """Validate each value of each axis, all others as in the first scenario.

    Raises
    ------
    InputErrors
        One line for each slip, at its place in the study or in its base.
    """
    faults: list[InputError] = []
    told: set[tuple[Any, str]] = set()  # of values that are drawn or computed one is enough
    for number, _, _ in scenarios.one_by_one(MOST):
        for fault in check_one(recipe, scenarios, source, number):
            if (fault.place, fault.rule) not in told:
                faults.append(fault)
            told.add((fault.place, fault.rule))
        if number == 0 and faults:
            break  # what is wrong with the base is wrong everywhere
        if len(faults) > 20:
            break
    if faults:
        raise InputErrors(faults)


def check_one(recipe: Recipe, scenarios: Scenarios, source: Source, number: int) -> list[InputError]:
    """What is wrong with a scenario, each fault at its place."""
    values = scenarios.values([number])[0]
    try:
        case_of(recipe, recipe.composed(values))
    except InputError as error:
        return list(blamed(error, scenarios, source, number))
    return []


def blamed(error: InputError, scenarios: Scenarios, source: Source, number: int) -> Iterator[InputError]:
    """The faults of a scenario, at the values that are varied where they are to blame."""
    chosen = scenarios.numbers([number])[0]
    parts: dict[str, tuple[Values, int]] = {
        part.path: (part, int(chosen[k])) for k, axis in enumerate(scenarios.axes) for part in axis.parts
    }
    for one in getattr(error, "errors", (error,)):
        field = one.field or ""
        within = [path for path in parts if field == path or field.startswith(f"{path}.")]
        above = [path for path in parts if path.startswith(f"{field}.")] if field else []
        if not within and not above:
            yield one
            continue
        named = [path for path in above if one.rule.startswith(f"{path.rpartition('.')[2]} = ")]
        part, value = parts[(within or named or above)[0]]
        rest = field[len(part.path) :].strip(".") if within else ""
        yield _at_value(one, part, value, rest, source)


def _at_value(error: InputError, part: Values, number: int, rest: str, source: Source) -> InputError:
    path, words = part.place(number), f"{part.path.rpartition('.')[2]} = "
    if error.rule.startswith(words):  # an error of a layer below, which had no place in the base
        error = InputError(error.rule.partition(": ")[2], fix=error.fix)
    rule = (
        f"{rest} {error.rule}"
        if rest.replace(".", "").isidentifier() and error.rule.startswith("is missing")
        else error.rule
    )
    unknown = error.rule in ("unknown key", "does not belong here")
    if unknown:
        fix = error.fix
        if fix and fix.startswith("Did you mean ") and "." in part.path and not rest:
            fix = f"Did you mean {part.path.rpartition('.')[0]}.{fix.removeprefix('Did you mean ')}"
        return InputError(
            "is no path of a case" if not rest else error.rule,
            field=".".join(map(str, part.node.path)),
            fix=fix,
            place=source.blame_key(part.node.path, "").place,
        )
    value: Any = part.values[number]
    if rest or isinstance(value, list | dict):
        label = part.labels[number] if part.labels else None
        more: dict[str, Any] = {"value": Written(label)} if label else {}
        field = f"vary.{part.path}" + (f".{rest}" if rest else "")
    else:
        more, field = {"value": Written(value) if isinstance(value, str) else value}, f"vary.{part.path}"
    fix = error.fix if part.written or not more else _remedy(part, error.fix)
    return InputError(rule, field=field, fix=fix, place=source.place(path), **more)


def _remedy(part: Values, fix: str | None) -> str | None:
    """What to do about a value that does not stand in the study: it is drawn, scaled, or within a range."""
    kind = part.node.data if isinstance(part.node.data, Mapping) else {}
    if "distribution" in kind:
        return (
            "Cut it off with from and to" if kind["distribution"] == "normal" else "Take another distribution"
        )
    if "factor" in kind or part.node.name == "factor":
        return "Take other factors"
    return None if fix and fix.startswith("Write ") else fix
