"""Files read with care: what is wrong in one is an InputError with its place, never another exception."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError, Place

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Above this, floats don't hold every whole number; no label or count comes near it.
LARGEST_INTEGER = 2.0**53


def load_bytes(path: str | PathLike[str]) -> bytes:
    """Content of a file.

    Raises
    ------
    InputError
        If it cannot be read or is empty.
    """
    file = str(path)
    try:
        data = Path(path).read_bytes()
    except FileNotFoundError:
        raise InputError("does not exist", field="file", value=file, fix="Check the path.") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot be read: {reason}", field="file", value=file) from None
    if not data.strip():
        raise InputError("is empty", place=Place(file), fix="Export it again.")
    return data


def text_of(data: bytes, file: str) -> str:
    """Text of a file's content: UTF-8, or Latin-1 where it isn't that.

    Raises
    ------
    InputError
        If the content is binary.
    """
    if b"\0" in data:
        line = data[: data.index(b"\0")].count(b"\n") + 1
        raise InputError(
            "is not a text file", place=Place(file, line), fix="Export it as text, or name its format."
        )
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


class Lines:
    """Lines of a text, read forward; blank ones are left out.

    Parameters
    ----------
    file : str
        Name of the file, for errors.
    lines : sequence of str
        The lines.
    first : int
        Line number of the first, counted from 1.
    """

    def __init__(self, file: str, lines: Sequence[str], first: int = 1) -> None:
        self.file = file
        kept = [i for i, line in enumerate(lines) if line and not line.isspace()]
        self.lines = list(lines) if len(kept) == len(lines) else [lines[i] for i in kept]
        self.numbers: IntArray = np.asarray(kept, dtype=np.int64) + first
        self._first = first
        self.position = 0

    @classmethod
    def of_file(cls, path: str | PathLike[str]) -> Lines:
        """All lines of a text file."""
        return cls(str(path), text_of(load_bytes(path), str(path)).split("\n"))

    @property
    def remaining(self) -> int:
        """Number of lines not read yet."""
        return len(self.lines) - self.position

    def place(self, position: int | None = None) -> Place:
        """Place of a line by its position; of the line read last when left out."""
        where = self.position - 1 if position is None else position
        if not self.lines:
            return Place(self.file, self._first)
        return Place(self.file, int(self.numbers[min(max(0, where), len(self.lines) - 1)]))

    def error(self, rule: str, *, fix: str | None = None, position: int | None = None) -> InputError:
        """An error at a line (the one read last when left out) that shows it."""
        where = self.position - 1 if position is None else position
        place = self.place(position)
        if 0 <= where < len(self.lines):
            return InputError(rule, value=self.lines[where].strip(), fix=fix, place=place)
        return InputError(rule, fix=fix, place=place)

    def require(self, count: int, what: str) -> None:
        """Raise an error unless so many lines remain."""
        if count < 0:
            raise self.error(f"must count {what} by a number that is not negative")
        if count > self.remaining:
            rule = f"ends early: {self.remaining} of {count} lines of {what} are there"
            raise self.error(rule, fix="Export the file again.", position=len(self.lines))

    def next(self, what: str) -> str:
        """The next line."""
        self.require(1, what)
        self.position += 1
        return self.lines[self.position - 1]

    def integers(self, what: str, count: int | None = None) -> list[int]:
        """Whole numbers of the next line: at least one, or exactly so many."""
        words = self.next(what).split()
        try:
            values = [int(word) for word in words]
        except ValueError:
            raise self.error(f"must be whole numbers ({what})") from None
        if count is not None and len(values) != count:
            raise self.error(f"must be {count} whole numbers ({what}), not {len(values)}")
        if any(abs(value) > LARGEST_INTEGER for value in values):
            raise self.error(f"must be {what} of at most 2^53")
        return values

    def take(self, count: int, what: str) -> tuple[list[str], IntArray]:
        """The next lines and their line numbers."""
        self.require(count, what)
        chosen = slice(self.position, self.position + count)
        self.position += count
        return self.lines[chosen], self.numbers[chosen]

    def table(
        self, rows: int, columns: int, what: str, separator: str | None = None
    ) -> tuple[FloatArray, IntArray]:
        """Numbers of the next lines (rows, columns), and the line numbers (rows,)."""
        start = self.position
        chunk, numbers = self.take(rows, what)
        values = table_of(chunk, columns, separator)
        if values is None:
            for i, line in enumerate(chunk):
                words = line.split(separator)
                if len(words) != columns:
                    rule = f"must have {columns} number{'s' * (columns > 1)} ({what}), not {len(words)}"
                    raise self.error(rule, position=start + i)
                if table_of([line], columns, separator) is None:
                    raise self.error(f"must be numbers ({what})", position=start + i)
            raise self.error(f"must be numbers ({what})", position=start)
        return values, numbers

    def finish(self, what: str) -> None:
        """Raise an error if lines remain."""
        if self.remaining:
            rule = f"stands after the last of the {what} that the counts announce"
            raise self.error(rule, fix="Make the counts agree with the lines.", position=self.position)


def table_of(lines: Sequence[str], columns: int, separator: str | None = None) -> FloatArray | None:
    """Numbers (rows, columns) of lines; None if a line is short, long or not of numbers.

    The text is parsed as one, after a count of the words of each line: much faster and leaner than words as
    Python objects for the millions of lines of a matrix.
    """
    text = "\n".join(lines)
    if not lines:
        return np.empty((0, columns))
    if not text or not text.isascii() or text[-1] == "\n":
        return None
    if separator:
        text = text.replace(separator, " ")
    codes = np.frombuffer(text.encode("ascii"), dtype=np.uint8)
    blank = codes <= 32
    begins = ~blank
    begins[1:] &= blank[:-1]
    first = np.concatenate([[0], np.flatnonzero(codes == 10) + 1])  # character of each line
    if not np.all(np.add.reduceat(begins, first, dtype=np.int64) == columns):
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # how numpy says that a word is no number
        try:
            values = np.fromstring(text, dtype=np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            return None
    return values.reshape(-1, columns) if values.size == len(lines) * columns else None


def numbers_of(words: list[list[str]], columns: int) -> FloatArray | None:
    """Numbers (rows, columns) of rows of words; None if a row is short, long or not of numbers."""
    if not words:
        return np.empty((0, columns))
    try:
        values = np.array(words, dtype=np.float64)
    except (ValueError, TypeError, OverflowError):
        return None
    return values if values.shape == (len(words), columns) else None


def whole(values: FloatArray, lines: IntArray, file: str, what: str) -> IntArray:
    """Whole numbers from floats (n, …) that stand on lines (n,).

    Raises
    ------
    InputError
        If one has a fraction, is not finite or is beyond 2^53.
    """
    rounded = np.where(np.abs(values) <= LARGEST_INTEGER, values, np.nan)  # NaN fails the comparison below
    good = rounded == np.floor(rounded)
    if not good.all():
        row = int(np.flatnonzero(~good.reshape(len(good), -1).all(axis=1))[0])
        bad = np.atleast_1d(values[row])[~np.atleast_1d(good[row])][0]
        raise InputError(f"must be a whole number ({what})", value=float(bad), place=at(file, lines[row]))
    return rounded.astype(np.int64)


def at(file: str, line: int | np.integer) -> Place:
    """Place of a line; line 0 stands for none, as in a binary file."""
    return Place(file, int(line) or None)
