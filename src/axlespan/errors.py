"""What goes wrong, in words: the rule, the value received, the place it came from and the fix."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


class AxlespanError(Exception):
    """Base of all errors that axlespan raises on purpose."""


@dataclass(frozen=True)
class Place:
    """A place in a file: ``case.yaml:12:8``; line and column count from 1."""

    file: str
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        parts = [self.file, *(str(n) for n in (self.line, self.column) if n is not None)]
        return ":".join(parts)


_MISSING: Any = object()


class InputError(AxlespanError, ValueError):
    """An input breaks a rule; nothing has been computed or written.

    Parameters
    ----------
    rule : str
        The rule that the value breaks, as a sentence without a full stop: ``"must be positive"``.
    field : str, optional
        Name of the argument or the dotted path in the case file: ``"structure.second_moment"``.
    value : object, optional
        The value received.
    fix : str, optional
        What to write instead.
    place : Place, optional
        Where the value stands, when it came from a file.
    """

    def __init__(
        self,
        rule: str,
        *,
        field: str | None = None,
        value: Any = _MISSING,
        fix: str | None = None,
        place: Place | None = None,
    ) -> None:
        self.rule = rule
        self.field = field
        self.value = value
        self.fix = fix
        self.place = place
        super().__init__(str(self))

    @property
    def has_value(self) -> bool:
        """Whether the value received is known."""
        return self.value is not _MISSING

    def located(self, place: Place, field: str | None = None) -> InputError:
        """Return the same error with the place (and the full name of the field) filled in."""
        return InputError(
            self.rule, field=field or self.field, value=self.value, fix=self.fix, place=self.place or place
        )

    def __str__(self) -> str:
        head = f"{self.place}: " if self.place else ""
        name = self.field or ""
        if self.has_value:
            name += (" = " if name else "") + _shown(self.value)
        tail = f". {self.fix}" if self.fix else ""
        return f"{head}{name}{': ' if name else ''}{self.rule}{tail}"


class AnalysisError(AxlespanError, RuntimeError):
    """An analysis could not go on; what was computed until then is kept.

    Parameters
    ----------
    message : str
        What happened, where (step, time, d.o.f.) and what to do about it.
    result : object, optional
        The result up to the last good step.
    """

    def __init__(self, message: str, result: Any = None) -> None:
        self.result = result
        super().__init__(message)


@dataclass(frozen=True)
class Outcome:
    """How a run ended: a short code, a sentence, and the remedy where there is one."""

    code: str
    message: str
    remedy: str = ""


def _shown(value: Any, limit: int = 60) -> str:
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 1] + "…"
