"""A stored result, read column by column: what is missing or damaged is told, and the rest is shown."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.io.drawing import Drawing, read_drawing
from axlespan.io.results import FORMAT_VERSION
from axlespan.io.summary import FORMAT_VERSION as SUMMARY_VERSION

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

RESULT, SUMMARY = "result.nc", "summary.json"
_STORE = "store.json"  # of a study
_STAGES = ".axlespan-*"  # folders of runs that are not complete
_RUN_IT = "Give a folder that axlespan run wrote"
_BROKEN = (OSError, ArithmeticError, AttributeError, LookupError, RuntimeError, TypeError, ValueError)


@dataclass
class Stored:
    """What a folder holds of a result; ``notices`` tell what it lacks."""

    folder: Path
    file: h5py.File | None = None  # None where only the summary can be read
    summary: Mapping[str, Any] = field(default_factory=dict)
    notices: list[str] = field(default_factory=list)
    time: FloatArray = field(default_factory=lambda: np.zeros(0))

    def text(self, attribute: str) -> str:
        """An attribute of the file as text; empty if it is not there."""
        if self.file is None:
            return ""
        value = np.asarray(self.file.attrs.get(attribute, "")).item()
        return value.decode("utf-8") if isinstance(value, bytes) else str(value)

    def content(self, attribute: str) -> dict[str, Any]:
        """An attribute that holds JSON; empty if it is not there."""
        try:
            found = json.loads(self.text(attribute) or "{}")
        except ValueError:
            return {}
        return found if isinstance(found, dict) else {}

    def names(self, dimension: str) -> tuple[str, ...]:
        """Names along a dimension; none if it is not there."""
        if self.file is None or dimension not in self.file:
            return ()
        try:
            return tuple(self.file[dimension].asstr()[...].tolist())
        except _BROKEN:
            return ()

    def numbers(self, name: str) -> FloatArray:
        """A variable as a whole; empty if it is not there."""
        if self.file is None or name not in self.file:
            return np.zeros(0)
        try:
            return np.asarray(self.file[name][...], dtype=np.float64)
        except _BROKEN as error:
            self.miss(name, error)
            return np.zeros(0)

    def has(self, name: str) -> bool:
        """Whether there is a table of histories (n_time, n) of that name, with something in it."""
        if self.file is None or name not in self.file:
            return False
        shape = self.file[name].shape
        return len(shape) == 2 and shape[1] > 0 and shape[0] == len(self.time) > 0

    def unit(self, name: str) -> str:
        """Unit of a variable."""
        return "" if self.file is None else str(self.file[name].attrs.get("units", ""))

    def column(self, name: str, index: int) -> FloatArray:
        """One history (n_time,)."""
        assert self.file is not None
        return np.asarray(self.file[name][:, index], dtype=np.float64)

    def rows(self, name: str, rows: IntArray) -> FloatArray:
        """A table at increasing rows; everything is read once where rows are many."""
        assert self.file is not None
        data = self.file[name]
        if data.size <= 40_000_000:
            return np.asarray(np.asarray(data[...], dtype=np.float64)[rows])
        columns = [self.column(name, i)[rows] for i in range(data.shape[1])]
        return np.column_stack(columns)

    def drawing(self) -> Drawing | None:
        """Geometry that came along."""
        if self.file is None:
            return None
        try:
            return read_drawing(self.file)
        except _BROKEN as error:
            self.miss("drawing", error)
            return None

    def miss(self, what: str, error: Exception) -> None:
        """Note that something cannot be read."""
        words = " ".join(str(error).split())[:160] or type(error).__name__
        text = f"{what} cannot be read and is left out ({words})."
        if text not in self.notices:
            self.notices.append(text)


def is_study(folder: Path) -> bool:
    """Whether a folder holds the store of a study."""
    return (folder / _STORE).is_file()


@contextmanager
def opened(folder: Path) -> Iterator[Stored]:
    """A folder with a result, open; or the path of a result.nc.

    Raises
    ------
    InputError
        If there is nothing to report.
    """
    place, path, notices = _found(folder)
    summary = _summary(place, notices)
    if path is None:
        yield Stored(place, None, summary, notices)
        return
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        reason = " ".join(str(error).split())[:200]
        if not summary:
            rule = f"cannot be opened: it is no netCDF-4 file, or was cut short ({reason})"
            raise InputError(
                rule, field="file", value=str(path), fix="Copy it again, or run the case again"
            ) from error
        notices.append(
            f"{path.name} is cut short or damaged, so histories, maps and the animation are missing; the tables are "
            f"from summary.json. Copy the file again, or run the case again. ({reason})"
        )
        yield Stored(place, None, summary, notices)
        return
    with file:
        _require_known(file, path)
        stored = Stored(place, file, summary, notices)
        stored.time = stored.numbers("time")
        _note_what_is_missing(stored)
        yield stored


def _found(folder: Path) -> tuple[Path, Path | None, list[str]]:
    """The folder, its result file if it has one, and what is to be said about that."""
    if not folder.exists():
        raise InputError("does not exist", field="folder", value=str(folder), fix="Check the path")
    if folder.is_file():
        return folder.parent, folder, []
    if (folder / RESULT).is_file():
        return folder, folder / RESULT, []
    stages = sorted(folder.glob(_STAGES))
    for stage in stages:
        if (stage / RESULT).is_file():
            said = "The run was stopped while its results were written; this is what was there."
            return folder, stage / RESULT, [said]
    if (folder / SUMMARY).is_file() and _summary(folder, []):
        said = f"{RESULT} is missing, so there are no histories, maps and animation; the tables are from {SUMMARY}."
        return folder, None, [said]
    if stages:
        rule = "holds a run that is not finished, or was stopped before it had a result"
        raise InputError(
            rule, field="folder", value=str(folder), fix="Wait for it, or run the case again with --force"
        )
    raise InputError(
        f"is not a result of axlespan: it has no {RESULT}", field="folder", value=str(folder), fix=_RUN_IT
    )


def _summary(folder: Path, notices: list[str]) -> dict[str, Any]:
    """The summary of a run; empty if it is not there."""
    path = folder / SUMMARY
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        notices.append(f"{SUMMARY} cannot be read ({error}); its tables are made anew.")
        return {}
    if not isinstance(found, dict) or found.get("format") != "axlespan summary":
        return {}
    number = found.get("format_version")
    if isinstance(number, int) and number > SUMMARY_VERSION:
        notices.append(
            f"{SUMMARY} was written by axlespan {found.get('version')}, later than this one; its tables are made anew."
        )
        return {}
    return found


def _require_known(file: h5py.File, path: Path) -> None:
    number = int(np.asarray(file.attrs.get("format_version", 1)).item())
    if number > FORMAT_VERSION:
        writer = np.asarray(file.attrs.get("version", "of a later version")).item()
        words = writer.decode() if isinstance(writer, bytes) else str(writer)
        raise InputError(
            f"was written by axlespan {words} in format {number}; this version reads up to {FORMAT_VERSION}",
            field="file",
            value=str(path),
            fix="pip install --upgrade axlespan",
        )
    if "time" not in file or "outcome" not in file.attrs:
        raise InputError("is not a result of axlespan", field="file", value=str(path), fix=_RUN_IT)


def _note_what_is_missing(stored: Stored) -> None:
    """Say what a reader of the page will not find."""
    assert stored.file is not None
    if len(stored.time) < 2:
        stored.notices.append("The result holds fewer than two times: there is nothing to plot.")
    wanted = {
        "sensor_displacement": "histories at sensors",
        "contact_force": "contact forces",
        "contact_position": "positions of the wheels",
        "vehicle_displacement": "motions of the vehicles",
        "support_reaction": "support reactions",
    }
    missing = [words for name, words in wanted.items() if name not in stored.file]
    if missing:
        stored.notices.append(f"The file has no {', no '.join(missing)}.")
