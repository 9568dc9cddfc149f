"""Errors of validation in the words of the case file: place, dotted field, value as written, rule, fix."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Final, get_args, get_origin

from pydantic import BaseModel, Tag, ValidationError
from pydantic.fields import FieldInfo

from axlespan.errors import InputError
from axlespan.study.case import Case
from axlespan.study.check_lists import Several
from axlespan.study.checks import Measured, Part, Whole
from axlespan.study.faults import listed, nearest
from axlespan.study.kinds import is_tag
from axlespan.study.source import Source

Step = str | int

_SHORT: Final = {
    "e": "youngs_modulus",
    "modulus": "youngs_modulus",
    "i": "second_moment",
    "inertia": "second_moment",
    "l": "length",
    "span": "length",
    "m": "mass",
    "mu": "mass_per_length",
    "k": "stiffness",
    "c": "damping",
    "nu": "poisson_ratio",
    "rho": "density",
    "v": "speed",
    "velocity": "speed",
    "dt": "time_step",
    "step": "time_step",
    "n": "count",
    "number": "count",
    "distance": "spacing",
    "g": "gravity",
    "type": "kind",
    "n_steps": "steps",
    "wave_length": "wavelength",
    "x": "position",
}


def explain(error: ValidationError, source: Source) -> list[InputError]:
    """Return one located error for each that pydantic found; a misspelt key is not missing as well."""
    items = error.errors(include_url=False, include_input=False)
    meant = {
        (*_path(item["loc"])[:-1], right)
        for item in items
        if item["type"] == "extra_forbidden" and (right := _right_key(item["loc"]))
    }
    faults: list[InputError] = []
    for item in items:
        path = _path(item["loc"])
        if not (item["type"] == "missing" and path in meant):
            faults.extend(_explained(item, path, source))
    return [fault for fault in faults if not _is_missing(fault, meant)]


def _is_missing(fault: InputError, meant: set[tuple[Step, ...]]) -> bool:
    return fault.rule.startswith("is missing") and tuple((fault.field or "").split(".")) in {
        tuple(map(str, path)) for path in meant
    }


def _path(loc: Sequence[Step]) -> tuple[Step, ...]:
    return tuple(step for step in loc if not is_tag(step))


def _explained(item: Any, path: tuple[Step, ...], source: Source) -> Iterator[InputError]:
    kind, inner = item["type"], item.get("ctx", {}).get("error")
    if kind == "value_error" and isinstance(inner, InputError):
        for one in getattr(inner, "errors", (inner,)):
            full = (*path, *(one.field.split(".") if one.field else ()))
            yield source.blame(full, one.rule, _filled(one, full, item["loc"], source))
    elif kind == "missing":
        yield source.blame(path, "is missing", _to_add(item["loc"], path, source))
    elif kind == "extra_forbidden":
        yield source.blame_key(path, *_unknown_key(item["loc"], path))
    else:
        rule = _RULES.get(kind, item["msg"][:1].lower() + item["msg"][1:])
        word = source.word(path)
        alone = f"Write [{word}]" if word and rule == "must be a list" else None
        empty = _FILL if source.is_empty(path) else None
        yield source.blame(path, rule, alone or _to_write(item["loc"], path) or empty)


_FILL: Final = "Write a value, or delete the key"
_RULES: Final = {
    "model_type": "must be a mapping",
    "model_attributes_type": "must be a mapping",
    "dict_type": "must be a mapping",
    "mapping_type": "must be a mapping",
    "tuple_type": "must be a list",
    "list_type": "must be a list",
    "bool_type": "must be true or false",
    "string_type": "must be a text",
}


def _filled(error: InputError, path: tuple[Step, ...], loc: Sequence[Step], source: Source) -> str | None:
    """Return the fix of an error; for an empty value, what to put there."""
    if source.is_empty(path):
        return _to_write(loc, path) or _FILL
    return error.fix


def _to_add(loc: Sequence[Step], path: tuple[Step, ...], source: Source) -> str:
    example = _example(loc)
    word = source.written(path)
    if word is not None and example:  # a word stands for a mapping that needs more
        return f"Write {{kind: {word}, {path[-1]}: {example}}}"
    return f"Add {path[-1]}: {example}" if example else f"Add {path[-1]}"


def _to_write(loc: Sequence[Step], path: tuple[Step, ...]) -> str | None:
    example = _example(loc)
    if not example:
        return None
    name = next((step for step in reversed(path) if isinstance(step, str)), "")
    return f"Write {name}: {example}" if path and path[-1] == name else f"Write {example}"


def _unknown_key(loc: Sequence[Step], path: tuple[Step, ...]) -> tuple[str, str]:
    name, models = str(path[-1]), _models(loc[:-1])
    right = _right_key(loc)
    if right:
        return "unknown key", f"Did you mean {right}?"
    homes = [section for section, model in _sections() if name in _keys(model)]
    if homes and _stands_high(path):
        return "does not belong here", f"Move it to {homes[0]}"
    known = [key for model in models for key in _keys(model)]
    return "unknown key", f"Keys here are {listed(known)}" if known else "Delete it"


def _stands_high(path: tuple[Step, ...]) -> bool:
    """Whether a key is one of the file, of a section, or of an item of a list: deeper ones have other meanings."""
    return len(path) <= 2 or (len(path) == 3 and isinstance(path[1], int))


def _right_key(loc: Sequence[Step]) -> str | None:
    name = str(_path(loc)[-1])
    known = [key for model in _models(loc[:-1]) for key in _keys(model)]
    if _SHORT.get(name.lower()) in known:
        return _SHORT[name.lower()]
    return nearest(name, known)


def _sections() -> Iterator[tuple[str, type[BaseModel]]]:
    yield "the top of the file", Case
    for name in ("crossing", "analysis", "output"):
        for _, model in _models_of(Case.model_fields[name]):
            yield name, model


def _keys(model: type[BaseModel]) -> list[str]:
    return [info.alias or name for name, info in model.model_fields.items()]


def _example(loc: Sequence[Step]) -> str | None:
    """Return how one writes the value at a location."""
    names = [step for step in loc if not is_tag(step)]
    if not names:
        return None
    number = max(n for n, step in enumerate(loc) if step == names[-1])
    if isinstance(names[-1], int):
        return None
    for model in _models(loc[:number]):
        for name, info in model.model_fields.items():
            if (info.alias or name) == names[-1]:
                return str(info.examples[0]) if info.examples else _example_of(info)
    return None


def _example_of(info: FieldInfo) -> str | None:
    for check in (*info.metadata, *_metadata(info.annotation)):
        if isinstance(check, Measured):
            return check.dimension.example
        if isinstance(check, Several):
            return check.example
        if isinstance(check, Whole):
            return "1"
    return None


def _metadata(annotation: Any) -> Iterator[Any]:
    for part in get_args(annotation):
        if get_origin(annotation) is Annotated and part is not get_args(annotation)[0]:
            yield part
        else:
            yield from _metadata(part)


def _models(loc: Sequence[Step]) -> list[type[BaseModel]]:
    """Return the models that may describe the mapping at a location of an error."""
    found: list[tuple[str | None, type[BaseModel]]] = [(None, Case)]
    for step in loc:
        if isinstance(step, int):
            continue
        if is_tag(step):
            found = [(None, model) for mark, model in found if mark in (step, None)]
            continue
        inner = [
            pair
            for _, model in found
            for name, info in model.model_fields.items()
            if (info.alias or name) == step
            for pair in _models_of(info)
        ]
        found = inner or found  # a name of the user's own, as of a sensor or a material, changes nothing
    return [model for _, model in found]


def _models_of(info: FieldInfo) -> list[tuple[str | None, type[BaseModel]]]:
    return list(_models_in(info.annotation, None))


def _models_in(annotation: Any, mark: str | None) -> Iterator[tuple[str | None, type[BaseModel]]]:
    if isinstance(annotation, type) and issubclass(annotation, Part):
        yield mark, annotation
        return
    if get_origin(annotation) is Annotated:
        inner, *checks = get_args(annotation)
        mark = next((check.tag for check in checks if isinstance(check, Tag)), mark)
        yield from _models_in(inner, mark)
        return
    for part in get_args(annotation):
        yield from _models_in(part, mark)
