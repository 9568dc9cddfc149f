"""One value of a study file, with its place: reads what should stand there, or says what is wrong and where."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from axlespan.errors import InputError
from axlespan.study.checks import Checked
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.source import Source

Step = str | int


@dataclass(frozen=True)
class Node:
    """A value of a study file."""

    data: Any
    source: Source
    path: tuple[Step, ...] = ()

    def fault(self, rule: str, fix: str | None = None) -> InputError:
        """An error that points here."""
        return self.source.blame(self.path, rule, fix)

    @property
    def name(self) -> str:
        """The last step of the path."""
        return str(self.path[-1]) if self.path else ""

    def child(self, step: Step) -> Node:
        """The value of a key, or an item of a list."""
        return Node(self.data[step], self.source, (*self.path, step))

    def items(self, what: str, example: str) -> list[Node]:
        """The items of a list that is not empty."""
        if not isinstance(self.data, list | tuple):
            raise self.fault(f"must be a list of {what}", f"Write {example}")
        if not self.data:
            raise self.fault(f"holds no {what}", f"Write {example}")
        return [self.child(number) for number in range(len(self.data))]

    def entries(self, what: str, example: str) -> Iterator[tuple[str, Node]]:
        """Key and value of a mapping whose keys are names that the user chose."""
        if not isinstance(self.data, Mapping):
            raise self.fault(f"must be a mapping of {what}", f"Write {example}")
        return ((str(key), self.child(key)) for key in self.data)

    def keys(self, known: Sequence[str], example: str) -> dict[str, Node]:
        """The values of a mapping by their keys, which must be known ones; empty ones are errors."""
        if not isinstance(self.data, Mapping):
            raise self.fault("must be a mapping", f"Write {example}")
        faults = []
        for key in self.data:
            if key not in known:
                near = nearest(str(key), known)
                fix = f"Did you mean {near}?" if near else f"Keys here are {listed(known)}"
                faults.append(self.source.blame_key((*self.path, key), "unknown key", fix))
            elif self.data[key] is None:
                fix = "Write a value, or delete the key"
                faults.append(self.source.blame((*self.path, key), "is empty", fix))
        if faults:
            raise InputErrors(faults)
        return {key: self.child(key) for key in self.data}

    def checked(self, check: Checked) -> Any:
        """The value after a check."""
        try:
            return check.read(self.data)
        except InputErrors as errors:
            raise InputErrors(
                self.source.blame((*self.path, *(e.field or "").split(".")), e.rule, e.fix)
                for e in errors.errors
            ) from None
        except InputError as error:
            raise self.fault(error.rule, error.fix) from None
