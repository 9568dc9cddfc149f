"""The reference is complete: every public name says what it is, takes, raises, and in which units."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, is_dataclass
from importlib import import_module
from pathlib import Path

import pytest

EXTENSIONS = str(Path(__file__).parents[2] / "docs" / "_ext")
if EXTENSIONS not in sys.path:
    sys.path.append(EXTENSIONS)

import field_comments  # noqa: E402
import made_api  # noqa: E402

# A unit in brackets, words that say that a number has none, or where else it is told.
UNIT = re.compile(r"\[[^\]]+\]|\b(factor|share|exponent|numbers? of|as (in|for) :)", re.IGNORECASE)


@dataclass(frozen=True)
class Named:
    """A public thing, or a public member of one."""

    name: str
    thing: object
    member: bool

    @property
    def doc(self) -> str:
        return inspect.getdoc(self.thing) or ""


def public() -> Iterator[Named]:
    seen: set[int] = set()
    for room in ("axlespan", *(f"axlespan.{name}" for name in made_api.ROOMS)):
        module = import_module(room)
        yield Named(room, module, False)
        for name in module.__all__:
            thing = getattr(module, name)
            if inspect.ismodule(thing) or id(thing) in seen:
                continue
            seen.add(id(thing))
            if not callable(thing):
                continue  # data: its page is asked for below
            yield Named(f"{room}.{name}", thing, False)
            if inspect.isclass(thing):
                for key, value in vars(thing).items():
                    plain = value.__func__ if isinstance(value, classmethod | staticmethod) else value
                    if not key.startswith("_") and (inspect.isfunction(plain) or isinstance(plain, property)):
                        yield Named(f"{room}.{name}.{key}", plain, True)


EVERYTHING = list(public())
FUNCTIONS = [item for item in EVERYTHING if inspect.isfunction(item.thing)]
CLASSES = [item for item in EVERYTHING if inspect.isclass(item.thing)]


def entries(doc: str, section: str) -> dict[str, str]:
    """Names and texts of a numpydoc section; ``a, b : float`` gives two."""
    found = re.search(rf"^{section}\n-+\n(.*?)(?=^\w[^\n]*\n-+\n|\Z)", doc, flags=re.DOTALL | re.MULTILINE)
    told: dict[str, str] = {}
    names: list[str] = []
    for line in (found[1] if found else "").splitlines():
        if line and not line.startswith(" "):
            names = [name.strip().lstrip("*") for name in line.split(" : ")[0].split(",")]
            told |= dict.fromkeys(names, line)
        else:
            told |= {name: told[name] + " " + line.strip() for name in names}
    return told


def parameters(thing: object) -> dict[str, str]:
    """Parameters and their annotations as written."""
    return {
        name: str(parameter.annotation)
        for name, parameter in inspect.signature(thing).parameters.items()  # type: ignore[arg-type]
        if name not in ("self", "cls") and not name.startswith("_")
    }


def is_number(annotation: str) -> bool:
    return bool(re.fullmatch(r"(float|FloatArray|ArrayLike|npt\.ArrayLike)( \| None)?", annotation))


def test_there_is_much_to_look_at():
    assert len(FUNCTIONS) > 100
    assert len(CLASSES) > 50


@pytest.mark.parametrize("item", EVERYTHING, ids=lambda item: item.name)
def test_has_a_docstring(item):
    first = item.doc.split("\n\n")[0]
    assert len(first.split()) >= 1, "no docstring"
    assert not first.startswith(f"{getattr(item.thing, '__name__', '?')}("), "that is dataclass' own text"


@pytest.mark.parametrize("item", FUNCTIONS, ids=lambda item: item.name)
def test_functions_tell_their_parameters(item):
    """Functions list them; short methods may name them, with their units, in a sentence."""
    takes = parameters(item.thing)
    told = entries(item.doc, "Parameters")
    if item.member and not told and len(takes) <= 2:
        if any(is_number(kind) for kind in takes.values()):
            assert UNIT.search(item.doc), "no unit"
        return
    assert set(takes) <= set(told), sorted(set(takes) - set(told))
    for name, kind in takes.items():
        if is_number(kind):
            assert UNIT.search(told[name]), f"no unit: {told[name]}"


@pytest.mark.parametrize("item", CLASSES, ids=lambda item: item.name)
def test_classes_tell_their_fields(item):
    if not is_dataclass(item.thing):
        if getattr(item.thing, "_is_protocol", False):
            return
        if "__init__" in vars(item.thing) and not issubclass(item.thing, BaseException):
            assert set(parameters(item.thing)) <= set(entries(item.doc, "Parameters"))
        return
    told = entries(item.doc, "Parameters") or entries(item.doc, "Attributes")
    for field in field_comments.fields_of(item.thing):
        text = told.get(field.name, "") if told else field.comment
        if is_number(field.type):
            assert UNIT.search(text), f"{field.name}: no unit: {text!r}"
        if entries(item.doc, "Parameters"):
            assert text, f"{field.name} is not told"


@pytest.mark.parametrize("item", FUNCTIONS, ids=lambda item: item.name)
def test_what_is_raised_is_told(item):
    if re.search(r"\braise InputError|\braise nearest", inspect.getsource(item.thing)):
        assert "InputError" in item.doc.partition("Raises\n")[2], "no Raises"


WITH_DATA = ("bridges", "irregularity", "standards", "vehicles.load_trains")


@pytest.mark.parametrize("room", WITH_DATA)
def test_data_is_told(room):
    """Data has no docstring of its own: the comment before it is shown."""
    room = f"axlespan.{room}"
    module = import_module(room)
    names = [name for name in module.__all__ if not callable(getattr(module, name))]
    names = [name for name in names if not inspect.ismodule(getattr(module, name))]
    assert names
    for name in names:
        assert len(made_api.data_told(room, name)) > 20, name


def test_comments_of_fields_become_parameters():
    lines = field_comments.section(
        [
            field_comments.FieldTold("length", "float", "2.0", "of the span [m]"),
            field_comments.FieldTold("name", "str", "", ""),
        ]
    )
    assert lines[3:5] == ["length : float, default 2.0", "    of the span [m]"]
    doc = ["A span.", "", "Raises", "------", "InputError"]
    assert field_comments.insert(doc, ["X"])[2:5] == ["X", "", "Raises"]
