"""``axlespan library``: vehicles, trains, spectra and tracks that come with the package."""

from __future__ import annotations

import os
from pathlib import Path

from axlespan.cli.library_card import card
from axlespan.cli.library_others import other_card, other_names
from axlespan.cli.library_table import list_everything
from axlespan.cli.messages import DONE, refuse, say
from axlespan.errors import InputError, Place
from axlespan.model.dofs import nearest
from axlespan.vehicles import library


def show_library(name: str | None, copy: Path | None, *, force: bool) -> int:
    """List the library, show one entry of it or of a user's file, or copy one; the exit code."""
    try:
        if name is None:
            if copy is not None:
                raise InputError(
                    "needs the name of a vehicle", field="--copy", fix="axlespan library ice3 --copy my.yaml"
                )
            lines = list_everything()
        elif copy is not None:
            lines = _copy(name, copy, force=force)
        else:
            lines = _shown(name)
    except InputError as error:
        return refuse(error)
    for line in lines:
        say(line)
    return DONE


def _shown(name: str) -> list[str]:
    return other_card(name) if name in other_names() else card(_entry(name))


def _entry(name: str) -> library.LibraryEntry:
    if name.endswith((".yaml", ".yml")):
        return library.load(name)
    if name not in library.names():
        raise nearest(name, [*library.names(), *other_names()], "name in the library")
    return library.entry(name)


def _copy(name: str, target: Path, *, force: bool) -> list[str]:
    """Write the YAML of an entry, and for a train those of its vehicles beside it."""
    if name in other_names():
        raise InputError("is no vehicle; only vehicles and trains have files", field="--copy", value=name)
    entry = _entry(name)
    if os.path.lexists(target) and not force:
        raise InputError("exists already", place=Place(str(target)), fix="Use --force to replace it")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(entry.text, encoding="utf-8")
    except OSError as error:
        rule = f"cannot be written: {error.strerror or error}"
        raise InputError(rule, place=Place(str(target))) from None
    lines = [str(target)]
    if entry.groups:
        parts = ", ".join(dict.fromkeys(group.entry.name for group in entry.groups))
        lines.append(f"Its vehicles are still those of the library: {parts}. Copy them too to change them")
    use = f"Use it in a case beside it: train: [{{vehicle: {target.name}}}]"
    return [*lines, use, f"See what it is with: axlespan library {target}"]
