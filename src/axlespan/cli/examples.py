"""``axlespan examples``: the cases that come with the package."""

from __future__ import annotations

import os
from importlib.resources import files
from pathlib import Path

from axlespan.cli.messages import DONE, refuse, say
from axlespan.errors import InputError, Place
from axlespan.model.dofs import nearest

_STUDY = "study-"  # beginning of the names of studies


def shipped() -> dict[str, str]:
    """Texts of the shipped cases by name."""
    return {name: text for name, text in everything().items() if not name.startswith(_STUDY)}


def studies() -> dict[str, str]:
    """Texts of the shipped studies by name."""
    return {name: text for name, text in everything().items() if name.startswith(_STUDY)}


def everything() -> dict[str, str]:
    """Texts of all shipped cases and studies by name."""
    folder = files("axlespan") / "examples"
    cases = (entry for entry in folder.iterdir() if entry.name.endswith(".yaml"))
    return {
        entry.name.removesuffix(".yaml"): entry.read_text(encoding="utf-8")
        for entry in sorted(cases, key=lambda entry: entry.name.removesuffix(".yaml"))
    }


def list_or_copy(names: list[str], output: Path, *, force: bool) -> int:
    """List the cases, or copy some of them; the exit code."""
    cases = everything()
    if not names:
        for name, text in cases.items():
            say(f"{name:22} {_title(text)}")
        say()
        say("Copy one with: axlespan examples NAME, then run it with: axlespan run NAME.yaml -o out")
        return DONE
    try:
        return _copy(names, cases, output, force)
    except InputError as error:
        return refuse(error)


def _copy(names: list[str], cases: dict[str, str], output: Path, force: bool) -> int:
    wanted = dict.fromkeys(name.removesuffix(".yaml") for name in names)
    if "all" in wanted:
        wanted = dict.fromkeys(cases)
    targets: list[tuple[Path, str]] = []
    for name in wanted:
        if name not in cases:
            raise nearest(name, list(cases), "example")
        targets += [(output / f"{name}.yaml", cases[name]), *_companions(name, output)]
    there = next((target for target, _ in targets if os.path.lexists(target)), None)
    if there is not None and not force:
        raise InputError("exists already", place=Place(str(there)), fix="Use --force to replace it")
    for target, text in targets:
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
        except OSError as error:
            rule = f"cannot be written: {error.strerror or error}"
            raise InputError(rule, place=Place(str(target)), fix="Name another folder with -o") from None
        say(str(target))
    return DONE


def _companions(name: str, output: Path) -> list[tuple[Path, str]]:
    """Files that a case reads: those in the folder of its name beside it."""
    folder = files("axlespan") / "examples" / name
    if not folder.is_dir():
        return []
    found = sorted(folder.iterdir(), key=lambda entry: entry.name)
    return [(output / name / entry.name, entry.read_text(encoding="utf-8")) for entry in found]


def _title(text: str) -> str:
    lines = (line for line in text.splitlines() if line.startswith("title:"))
    return next(lines, "title:").removeprefix("title:").strip()
