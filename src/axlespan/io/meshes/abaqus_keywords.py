"""The keyword blocks of an Abaqus input file: names, parameters and data lines with their places.

Source: Abaqus Keywords Guide, "Input syntax rules".
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError, Place
from axlespan.io.lines import numbers_of, whole

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_COMMA = re.compile(r',(?=(?:[^"]*"[^"]*")*[^"]*$)')  # not inside quotes
_FORTRAN = str.maketrans("dD", "ee")


@dataclass(frozen=True, eq=False)
class Keyword:
    """A keyword line with its data lines."""

    file: str
    name: str  # upper case, single blanks
    parameters: Mapping[str, str]  # keys in upper case
    line: int
    data: list[str]
    numbers: IntArray  # (n_data,) line numbers

    @property
    def place(self) -> Place:
        """Place of the keyword line."""
        return Place(self.file, self.line)

    def place_of(self, row: int) -> Place:
        """Place of a data line."""
        return Place(self.file, int(self.numbers[row]))

    def refused(self, rule: str) -> InputError:
        """An error at the keyword line."""
        return InputError(rule, field=f"*{self.name}", place=self.place)

    def required(self, parameter: str) -> str:
        """A parameter that must be there."""
        if not self.parameters.get(parameter):
            rule = f"must have the parameter {parameter}"
            raise InputError(rule, field=f"*{self.name}", place=self.place)
        return self.parameters[parameter]

    def words(self) -> list[list[str]]:
        """Words of each data line; empty ones at its end are left out."""
        rows = []
        for line in self.data:
            row = [word.strip() for word in line.split(",")]
            while row and not row[-1]:
                row.pop()
            rows.append(row)
        return rows

    def error(self, rule: str, row: int, fix: str | None = None) -> InputError:
        """An error at a data line that shows it."""
        value = self.data[row].strip()
        return InputError(rule, field=f"*{self.name}", value=value, place=self.place_of(row), fix=fix)

    def node_table(self) -> tuple[IntArray, FloatArray]:
        """Labels (n,) and coordinates (n, 3) of nodes; coordinates that are left out are zero."""
        words = self.words()
        for i, row in enumerate(words):
            if not 2 <= len(row) <= 7:
                raise self.error("must be a node number and one to three coordinates", i)
        padded = [[word or "0" for word in (row + ["0", "0"])[:4]] for row in words]
        table = numbers_of(padded, 4)
        if table is None:
            padded = [[word.translate(_FORTRAN) for word in row] for row in padded]
            table = numbers_of(padded, 4)
        if table is None:
            bad = next(i for i, row in enumerate(padded) if numbers_of([row], 4) is None)
            raise self.error("must be numbers", bad)
        return whole(table[:, 0], self.numbers, self.file, "node number"), table[:, 1:]

    def records(self, width: int, what: str) -> tuple[IntArray, IntArray]:
        """Whole numbers (n, width) that may run over several lines, and the line (n,) where each begins."""
        words = self.words()
        counts = np.array([len(row) for row in words], dtype=np.int64)
        flat = numbers_of([[word] for row in words for word in row], 1)
        if flat is None:
            bad = next(i for i, row in enumerate(words) if numbers_of([row], len(row)) is None)
            raise self.error(f"must be whole numbers ({what})", bad)
        values = whole(flat[:, 0], np.repeat(self.numbers, counts), self.file, what)
        starts = np.cumsum(counts) - counts
        over = starts % width + counts > width
        if np.any(over) or len(values) % width or np.any(counts == 0):
            # a line that runs over its record follows one that is short, unless the record begins there
            row = int(np.argmax(over)) if np.any(over) else len(words) - 1
            row -= int(starts[row] % width > 0 and bool(over[row]))
            raise self.error(f"must be {width} numbers ({what})", row)
        first = np.flatnonzero(starts % width == 0)
        return values.reshape(-1, width), self.numbers[first]


def keywords_of(file: str, text: str) -> list[Keyword]:
    """Split a file into keyword blocks; comments and blank lines are left out.

    Raises
    ------
    InputError
        If data stand before the first keyword, or a parameter is malformed.
    """
    lines = [line.strip() for line in text.split("\n")]
    kept = np.array([i for i, line in enumerate(lines) if line and line[:2] != "**"], dtype=np.int64)
    marks = [k for k, i in enumerate(kept.tolist()) if lines[i][0] == "*"]
    if not marks or marks[0] > 0:
        rule = "must begin with a keyword such as *HEADING or *NODE to be an Abaqus input file"
        raise InputError(rule, place=Place(file, int(kept[0]) + 1 if len(kept) else 1))
    blocks = []
    for mark, end in zip(marks, [*marks[1:], len(kept)], strict=True):
        head, start = lines[kept[mark]], mark + 1
        while head.endswith(",") and start < end:  # the keyword line goes on
            head, start = head + lines[kept[start]], start + 1
        name, parameters = _head(file, head, int(kept[mark]) + 1)
        own = kept[start:end]
        data = [lines[i] for i in own.tolist()]
        blocks.append(Keyword(file, name, parameters, int(kept[mark]) + 1, data, own + 1))
    return blocks


def _head(file: str, text: str, line: int) -> tuple[str, dict[str, str]]:
    first, *rest = _COMMA.split(text) if '"' in text else text.split(",")
    parameters = {}
    for part in rest:
        key, _, value = part.partition("=")
        if key.strip():
            parameters[" ".join(key.upper().split())] = value.strip().strip('"').strip()
        elif value:
            raise InputError("must have a name before '='", value=part, place=Place(file, line))
    return " ".join(first[1:].upper().split()), parameters
