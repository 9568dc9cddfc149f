"""The API: every public name of the package and its rooms, by their ``__all__``."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

import axlespan

INTRODUCTION = """# Python

Everything public. `import axlespan as asp` gives the names of the first section; rooms are its attributes.

"""

ROOMS = {
    "bridges": "Bridges and track",
    "vehicles": "Vehicles and trains",
    "vehicles.library": "Library of vehicles",
    "vehicles.load_trains": "Load trains",
    "irregularity": "Irregularities",
    "plot": "Figures",
    "standards": "Rules",
    "study": "Case files",
    "study.sweep": "Studies",
    "report": "Reports",
}


def page(_path: Path) -> str:
    """Return the page."""
    lines = [INTRODUCTION, "## axlespan", ""]
    own = [name for name in axlespan.__all__ if not inspect.ismodule(getattr(axlespan, name))]
    lines += _entries("axlespan", own)
    for room, title in ROOMS.items():
        try:
            module = import_module(f"axlespan.{room}")
        except ModuleNotFoundError:
            continue
        # What the package itself gives is above already.
        names = [
            name
            for name in getattr(module, "__all__", ())
            if name not in own and not inspect.ismodule(getattr(module, name))
        ]
        if names:
            lines += [f"## {title}: axlespan.{room}", "", (module.__doc__ or "").strip().split("\n\n")[0], ""]
            lines += _entries(f"axlespan.{room}", names)
    return "\n".join(lines)


def _entries(module: str, names: list[str]) -> list[str]:
    names = sorted(names, key=str.lower)
    links = " · ".join(f"{{py:obj}}`{name} <{module}.{name}>`" for name in names)
    lines = ["{.names}", links, ""]
    for name in names:
        thing = getattr(import_module(module), name)
        if inspect.isclass(thing):
            kind = "autoexception" if issubclass(thing, BaseException) else "autoclass"
            options = [":members:"]
        elif callable(thing):
            kind, options = "autofunction", []
        else:
            lines += [
                "```{eval-rst}",
                f".. data:: {module}.{name}",
                f"   :type: {type(thing).__name__}",
                "",
                f"   {data_told(module, name)}",
                "```",
                "",
            ]
            continue
        lines += [
            "```{eval-rst}",
            f".. {kind}:: {module}.{name}",
            *(f"   {option}" for option in options),
            "```",
            "",
        ]
    return lines


def data_told(module: str, name: str) -> str:
    """Return what the comment before public data says, and what it holds."""
    thing = getattr(import_module(module), name)
    source = _home(module, name)
    lines = Path(str(import_module(source).__file__)).read_text(encoding="utf-8").splitlines()
    (at,) = [i for i, line in enumerate(lines) if line.startswith((f"{name}:", f"{name} ="))]
    said: list[str] = []
    while at and lines[at - 1].startswith("#"):
        at -= 1
        said.insert(0, lines[at].lstrip("#: "))
    if isinstance(thing, str):
        return f"{' '.join(said)} ``{thing}``"
    words = [word for word in thing if isinstance(word, str)] if isinstance(thing, Iterable) else []
    if not words:
        return " ".join(said)
    return f"{' '.join(said)} They are {', '.join(f'``{word}``' for word in words)}."


def _home(module: str, name: str) -> str:
    """Return the module that public data is written in, from the imports of its room."""
    tree = ast.parse(Path(str(import_module(module).__file__)).read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and any(alias.name == name for alias in node.names):
            return str(node.module)
    return module
