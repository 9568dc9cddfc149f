"""The API: every public name of the package and its rooms, by their ``__all__``."""

from __future__ import annotations

import inspect
from importlib import import_module
from pathlib import Path

import axlespan

INTRODUCTION = """# Python

Everything public. `import axlespan as asp` gives the names of the first section; rooms are its attributes.

"""

ROOMS = {
    "bridges": "Bridges and track",
    "vehicles": "Vehicles and trains",
    "irregularity": "Irregularities",
    "plot": "Figures",
    "standards": "Rules",
    "study": "Case files and studies",
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
    lines = []
    for name in sorted(names, key=str.lower):
        thing = getattr(import_module(module), name)
        if inspect.isclass(thing):
            kind = "autoexception" if issubclass(thing, BaseException) else "autoclass"
            options = [":members:"]
        elif callable(thing):
            kind, options = "autofunction", []
        else:
            kind, options = "autodata", [":no-value:"]
        lines += [
            "```{eval-rst}",
            f".. {kind}:: {module}.{name}",
            *(f"   {option}" for option in options),
            "```",
            "",
        ]
    return lines
