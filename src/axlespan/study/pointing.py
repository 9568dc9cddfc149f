"""Errors of the layers below, turned into errors at the place of the value in the case file."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from axlespan.errors import InputError
from axlespan.study.faults import InputErrors
from axlespan.study.loader import LoadedCase
from axlespan.study.yaml_tree import Written

# Names that supports along a beam get, in the order of the file.
_SUPPORT = re.compile(r"(?:(left)|(right)|support(\d+))\.")


@contextmanager
def pointing(loaded: LoadedCase, section: str) -> Iterator[None]:
    """Turn errors of the layers below into errors at the place of the value, as far as it can be told."""
    try:
        yield
    except InputErrors as errors:
        raise InputErrors(_pointed(loaded, section, error) for error in errors.errors) from errors
    except InputError as error:
        if error.place is not None:
            raise
        raise _pointed(loaded, section, error) from error


def _pointed(loaded: LoadedCase, section: str, error: InputError) -> InputError:
    if error.place is not None:
        return error
    source, paths = loaded.source, _candidates(section, error)
    if error.rule.startswith("is missing"):  # then what it is missing in stands there
        return source.blame(paths[0], error.rule, error.fix)
    for path in paths:
        if source.knows(path):
            here = source.blame(path, error.rule, error.fix)
            if source.word(path) is not None or not error.has_value:
                return here
            # a mapping stands there: the value that was made of it says more
            value = Written(error.value) if isinstance(error.value, str) else error.value
            return InputError(error.rule, field=here.field, value=value, fix=error.fix, place=here.place)
    words = InputError(error.rule, field=error.field, **_value_of(error))
    return source.blame(section, str(words), error.fix)


def _value_of(error: InputError) -> dict[str, Any]:
    return {"value": error.value} if error.has_value else {}


def _candidates(section: str, error: InputError) -> list[str]:
    field = error.field
    if not field:
        return [section]
    if field.startswith("others."):  # further trains of a crossing
        place = f"other_trains.{field.removeprefix('others.')}"
        return [place, ".".join(place.split(".")[:2])]
    if field == "support":
        found = _SUPPORT.match(str(error.value))
        number = 0 if not found or found[1] else 1 if found[2] else int(found[3]) - 1
        return [f"{section}.supports.{number}"]
    places = [f"{section}.{field}", field]
    if section == "analysis":
        places += [f"{other}.{field}" for other in ("output", "crossing", "structure")]
    return places
