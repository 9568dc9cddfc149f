"""From nonlinear elements of one's own to bodies that have them: the Python file is read, and asked what it can do."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any, TypeVar

from axlespan.errors import InputError
from axlespan.model.nonlinear_elements import with_nonlinear_element
from axlespan.running.structure import Structure
from axlespan.study.case_elements import OwnElement
from axlespan.study.faults import listed, nearest
from axlespan.vehicles import Vehicle

_METHODS = ("force", "tangent", "advanced")

_Body = TypeVar("_Body", Structure, Vehicle)


def with_elements(body: _Body, elements: Sequence[OwnElement]) -> _Body:
    """The same structure or vehicle with nonlinear elements on its d.o.f.

    Raises
    ------
    InputError
        If a file cannot be run, has no such class, or the class is no element; fields are paths under the body.
    """
    for number, item in enumerate(elements):
        try:
            body = _with(body, item)
        except InputError as error:
            own = error.field if error.field in OwnElement.model_fields else "element"
            more: Mapping[str, Any] = {"value": error.value} if error.has_value else {}
            field = f"own_elements.{number}.{own}"
            raise InputError(error.rule, field=field, fix=error.fix, **more) from error
    return body


def _with(body: _Body, item: OwnElement) -> _Body:
    element = _made(_class_of(item.file, item.element), item)
    for name in _METHODS:
        _require_method(element, name, item.element)
    try:
        return with_nonlinear_element(body, element, item.dofs, name=item.name or item.element)
    except InputError as error:
        if error.field in ("force", "tangent"):
            of = f"of the shape {error.value}" if isinstance(error.value, tuple) else f"of {error.value}"
            rule = f"has a {error.field} {of}; it {error.rule}"
            raise InputError(rule, field="element", value=item.element) from error
        more: Mapping[str, Any] = {"value": error.value} if isinstance(error.value, str) else {}
        raise InputError(error.rule, field="dofs", fix=error.fix, **more) from error
    except (Exception, SystemExit) as error:
        raise InputError(
            f"fails at rest: {_said(error, item.file)}", field="element", value=item.element
        ) from error


def _class_of(file: Path, name: str) -> Any:
    """A class in a Python file."""
    spec = spec_from_file_location(f"axlespan_own_{file.stem}", file)
    if spec is None or spec.loader is None:
        raise InputError("is no Python file", field="file", value=file.name, fix=f"Use {file.stem}.py")
    module = module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        raise InputError(f"cannot be run: {_said(error, file)}", field="file", value=file.name) from error
    known = [
        key
        for key, value in vars(module).items()
        if inspect.isclass(value) and value.__module__ == module.__name__
    ]
    found = getattr(module, name, None)
    if not inspect.isclass(found):
        near = nearest(name, known)
        fix = f"Did you mean {near}?" if near else f"Known: {listed(known)}" if known else None
        raise InputError(f"is no class in {file.name}", field="element", value=name, fix=fix)
    return found


def _made(kind: Any, item: OwnElement) -> Any:
    """The element, from the numbers that the case hands it."""
    try:
        inspect.signature(kind).bind(**item.arguments)
    except TypeError as error:
        takes = f"{item.element}{inspect.signature(kind)}"
        raise InputError(f"do not fit {takes}: {error}", field="arguments") from error
    try:
        return kind(**item.arguments)
    except (Exception, SystemExit) as error:
        rule = f"cannot be made: {_said(error, item.file)}"
        raise InputError(rule, field="element", value=item.element) from error


def _require_method(element: Any, name: str, kind: str) -> None:
    """An element has the method, and it takes displacements, velocities and the state."""
    method = getattr(element, name, None)
    if not callable(method):
        raise InputError(f"has no method {name}(u, v, state)", field="element", value=kind)
    try:
        inspect.signature(method).bind(0.0, 0.0, None)
    except TypeError as error:
        rule = f"has {name}{inspect.signature(method)}, which must take (u, v, state)"
        raise InputError(rule, field="element", value=kind) from error


def _said(error: BaseException, file: Path) -> str:
    """What an error says, and in which line of a file it arose."""
    line = error.lineno if isinstance(error, SyntaxError) else None
    trace = error.__traceback__ if line is None else None
    while trace is not None:
        if Path(trace.tb_frame.f_code.co_filename).resolve() == file.resolve():
            line = trace.tb_lineno
        trace = trace.tb_next
    words = error.msg if isinstance(error, SyntaxError) else str(error)
    where = f" in line {line}" if line is not None else ""
    return f"{type(error).__name__}{where}: {words}"
