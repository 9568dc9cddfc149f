"""Read a case file: a validated case, or all that is wrong with it, each with file, line and column."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from axlespan.errors import InputError, Place
from axlespan.study.case import Case
from axlespan.study.faults import InputErrors, nearest
from axlespan.study.messages import explain
from axlespan.study.plausibility import review
from axlespan.study.source import Source
from axlespan.study.yaml_tree import read_yaml

LARGEST: Final = 5_000_000
"""Most bytes of a case file; long tables belong in files of their own."""


@dataclass(frozen=True)
class LoadedCase:
    """A validated case and the file that it came from.

    Parameters
    ----------
    case : Case
        The case, in SI units.
    source : Source
        Its text, with the places of its values.
    folder : Path
        Folder that the names of files in the case are relative to.
    warnings : tuple of str
        What looks wrong but may be right, one line each with its place.
    """

    case: Case
    source: Source
    folder: Path
    warnings: tuple[str, ...] = ()

    def place(self, path: str) -> Place:
        """Return where the value of a dotted path stands: ``place("train.0.mass")``."""
        return self.source.place(path)

    def located(self, error: InputError, path: str) -> InputError:
        """Return an error of a later check that points to the value of a dotted path, as it is written."""
        return self.source.blame(path, error.rule, error.fix)


def load_case(
    path: str | os.PathLike[str], *, vehicles: Collection[str] = (), spectra: Collection[str] = ()
) -> LoadedCase:
    """Read and validate a case file.

    Parameters
    ----------
    path : path-like
        YAML file.
    vehicles, spectra : collection of str, optional
        Names in the libraries of vehicles and of spectra; when given, others are refused.

    Raises
    ------
    InputError
        If the file cannot be read.
    InputErrors
        If it is wrong: one error for each slip, with file, line and column.
    """
    name = os.fspath(path)
    return read_case(_read_text(name), name, folder=Path(name).parent, vehicles=vehicles, spectra=spectra)


def read_case(
    text: str,
    file: str = "case.yaml",
    *,
    folder: str | os.PathLike[str] = ".",
    vehicles: Collection[str] = (),
    spectra: Collection[str] = (),
) -> LoadedCase:
    """Validate the text of a case file; ``file`` is its name in messages.

    The result is that of :func:`load_case`.

    Parameters
    ----------
    text : str
        YAML.
    file : str
        Its name in messages.
    folder : path
        Where the files that it names are.
    vehicles, spectra : collection of str
        Names that it may use beside those that come along.

    Raises
    ------
    InputErrors
        All that is wrong, with line and column.
    """
    document = read_yaml(text, file)
    source = Source(file, text, document.root)
    if not isinstance(document.data, Mapping):
        what = "a list" if isinstance(document.data, list) else "a single value"
        glued = isinstance(document.data, str) and re.match(r"\w+:\S", document.data)
        fix = (
            "Write a space after each colon" if glued else "Begin with title: ..., structure: ..., train: ..."
        )
        raise InputError(f"must be keys and values; this is {what}", place=source.place(()), fix=fix)
    context: dict[str, Any] = {"folder": Path(folder), "vehicles": tuple(vehicles), "spectra": tuple(spectra)}
    try:
        case = Case.model_validate(document.data, context=context)
    except ValidationError as error:
        raise InputErrors([*document.faults, *explain(error, source)]) from None
    refusals, warnings = review(case, source)
    if document.faults or refusals:
        raise InputErrors([*document.faults, *refusals])
    return LoadedCase(case, source, Path(folder), tuple(map(str, warnings)))


def _read_text(name: str) -> str:
    """Return the text of a file of moderate size."""
    here = Place(name)
    try:
        about = os.stat(name)
        if not stat.S_ISDIR(about.st_mode) and about.st_size <= LARGEST:
            with open(name, "rb") as stream:
                raw = stream.read(LARGEST + 1)  # a pipe does not say how long it is
        else:
            raw = b""
    except FileNotFoundError:
        raise InputError("no such file", place=here, fix=_other_file(name)) from None
    except PermissionError:
        raise InputError("cannot be read: permission denied", place=here) from None
    except (OSError, ValueError) as error:
        words = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot be read: {words}", place=here) from None
    if stat.S_ISDIR(about.st_mode):
        cases = sorted(p.name for p in Path(name).glob("*.y*ml"))
        fix = f"Name a file in it, such as {os.path.join(name, cases[0])}" if cases else "Name a case file"
        raise InputError("is a folder, not a case file", place=here, fix=fix)
    if max(len(raw), about.st_size) > LARGEST:
        raise _too_large(here)
    return _decoded(raw, here)


def _too_large(here: Place) -> InputError:
    return InputError(
        f"is larger than {LARGEST / 1e6:g} MB, the most that a case file may have",
        place=here,
        fix="Put long tables into files of their own, as in irregularity: {kind: table, file: profile.csv}",
    )


def _decoded(raw: bytes, here: Place) -> str:
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise InputError("is written in UTF-16", place=here, fix="Save it as UTF-8")
    if b"\0" in raw:
        raise InputError(
            "is not a text file", place=here, fix="A case file is YAML, written with a text editor"
        )
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        column = len(raw[raw.rfind(b"\n", 0, error.start) + 1 : error.start].decode("utf-8", "replace")) + 1
        byte = raw[error.start : error.start + 1]
        raise InputError(
            f"is not UTF-8: byte 0x{byte.hex()}, in Windows-1252 '{byte.decode('cp1252', 'replace')}'",
            place=Place(here.file, line, column),
            fix="Save it as UTF-8",
        ) from None


def _other_file(name: str) -> str | None:
    folder = Path(name).parent
    try:
        if not folder.is_dir():
            return f"There is no folder {folder}"
        near = nearest(Path(name).name, [p.name for p in folder.iterdir()])
    except OSError:
        return None
    return f"Did you mean {folder / near}?" if near else None
