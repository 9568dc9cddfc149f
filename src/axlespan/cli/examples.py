"""``axlespan examples``: the cases that come with the package."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from axlespan.cli.messages import DONE, refuse, say
from axlespan.errors import InputError
from axlespan.model.dofs import nearest


def shipped() -> dict[str, str]:
    """Texts of the shipped cases by name."""
    folder = files("axlespan") / "examples"
    cases = (entry for entry in folder.iterdir() if entry.name.endswith(".yaml"))
    return {
        entry.name.removesuffix(".yaml"): entry.read_text(encoding="utf-8")
        for entry in sorted(cases, key=str)
    }


def list_or_copy(names: list[str], output: Path, *, force: bool) -> int:
    """List the cases, or copy some of them; the exit code."""
    cases = shipped()
    if not names:
        for name, text in cases.items():
            say(f"{name:22} {_title(text)}")
        say()
        say("Copy one with: axlespan examples NAME, then run it with: axlespan run NAME.yaml -o out")
        return DONE
    try:
        return _copy(list(cases) if names == ["all"] else names, cases, output, force)
    except InputError as error:
        return refuse(error)


def _copy(names: list[str], cases: dict[str, str], output: Path, force: bool) -> int:
    targets = []
    for name in (entry.removesuffix(".yaml") for entry in names):
        if name not in cases:
            raise nearest(name, list(cases), "example")
        target = output / f"{name}.yaml"
        if target.exists() and not force:
            raise InputError(
                "exists already", field="file", value=str(target), fix="Use --force to replace it"
            )
        targets += [(target, cases[name]), *_companions(name, output)]
    try:
        output.mkdir(parents=True, exist_ok=True)
        for target, text in targets:
            target.parent.mkdir(exist_ok=True)
            target.write_text(text, encoding="utf-8")
            say(str(target))
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror}", field="folder", value=str(output)) from None
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
