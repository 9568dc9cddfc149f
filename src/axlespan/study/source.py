"""The case file as text: where each value stands, and errors that point there."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from axlespan.errors import InputError, Place
from axlespan.study.yaml_tree import Spot

Path = str | Sequence[str | int]


@dataclass(frozen=True)
class Source:
    """A case file: its name, its text, and where its values stand.

    Paths are dotted, ``"train.0.mass"``, or sequences of keys and indices.
    """

    file: str
    text: str
    root: Spot

    def place(self, path: Path) -> Place:
        """Return where a value stands; for one that is missing, where the key of its mapping stands."""
        spot, rest = self._walk(path)
        if spot is self.root:
            return Place(self.file, 1, 1) if rest else Place(self.file, spot.line, spot.column)
        missing = rest and spot.children is not None
        line, column = (spot.key_line, spot.key_column) if missing else (spot.line, spot.column)
        return Place(self.file, line, column)

    def written(self, path: Path) -> str | None:
        """Return a value as it is written, ``None`` if it is not there or takes several lines."""
        spot, rest = self._walk(path)
        return None if rest and spot.children is not None else spot.written

    def knows(self, path: Path) -> bool:
        """Whether a value stands there."""
        return not self._walk(path)[1]

    def word(self, path: Path) -> str | None:
        """Return a value as it is written, ``None`` unless it is a single one."""
        spot, rest = self._walk(path)
        return None if rest or spot.children is not None else spot.written

    def is_empty(self, path: Path) -> bool:
        """Whether a key stands there without value."""
        spot, rest = self._walk(path)
        return not rest and spot.written in ("", "~", "null") and spot.children is None

    def blame(self, path: Path, rule: str, fix: str | None = None) -> InputError:
        """Return an error that points to a value, with the value as written.

        Parameters
        ----------
        path : tuple of str and int
            Keys and places that lead to it.
        rule : str
            What it breaks, in a sentence without full stop.
        fix : str, optional
            What to write instead.
        """
        spot, rest = self._walk(path)
        steps = _steps(path)
        inside = bool(rest) and spot.children is None  # a word where a mapping or a list is expected
        if inside:
            steps = steps[: len(steps) - len(rest)]
            rule = f"{rest[-1]} {rule}" if rule.startswith("is missing") else rule
        more: dict[str, Any] = {}
        if self.is_empty(path):
            rule = "is empty"
        elif (not rest or inside) and spot.written is not None and spot is not self.root:
            more = {"value": spot.written}
        return InputError(rule, field=_dotted(steps), fix=fix, place=self.place(path), **more)

    def blame_key(self, path: Path, rule: str, fix: str | None = None) -> InputError:
        """Return an error that points to a key.

        Parameters
        ----------
        path : tuple of str and int
            Keys and places that lead to it.
        rule : str
            What it breaks, in a sentence without full stop.
        fix : str, optional
            What to write instead.
        """
        spot, _ = self._walk(path)
        place = Place(self.file, spot.key_line, spot.key_column)
        return InputError(rule, field=_dotted(_steps(path)), fix=fix, place=place)

    def _walk(self, path: Path) -> tuple[Spot, list[str]]:
        """Follow a path as far as it goes; return the last spot and the steps that are left."""
        spot, steps = self.root, _steps(path)
        while steps:
            taken, inner = _step(spot, steps)
            if inner is None:
                break
            spot, steps = inner, steps[taken:]
        return spot, steps


def _step(spot: Spot, steps: list[str]) -> tuple[int, Spot | None]:
    if isinstance(spot.children, list):
        number = int(steps[0]) if steps[0].isdigit() else -1
        return 1, spot.children[number] if 0 <= number < len(spot.children) else None
    if isinstance(spot.children, dict):
        for taken in range(1, len(steps) + 1):  # a name of the user's own may have dots
            inner = spot.children.get(".".join(steps[:taken]))
            if inner is not None:
                return taken, inner
    return 0, None


def _steps(path: Path) -> list[str]:
    if isinstance(path, str):
        return [step for step in re.sub(r"\[(\d+)\]", r".\1", path).split(".") if step]
    return [str(step) for step in path]


def _dotted(steps: Sequence[str]) -> str | None:
    """A path in words; what cannot be printed is escaped."""
    text = ".".join(steps)
    return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in text) or None
