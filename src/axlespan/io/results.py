"""Results in and out of netCDF-4 files: ``result.nc``, which xarray, netCDF4, MATLAB and Julia open too."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np
import numpy.typing as npt

import axlespan
from axlespan.errors import InputError, Outcome
from axlespan.interaction.result import VARIABLES, Result
from axlespan.io.drawing import Drawing, write_drawing
from axlespan.io.result_extras import read_extras, write_extras
from axlespan.io.strict_json import to_json

FloatArray = npt.NDArray[np.float64]

#: Version of the layout of result.nc; a reader knows this one and those before it.
FORMAT_VERSION = 1

# Values in a chunk: 128 kB. Chunks follow time, so that one history is read without its neighbors, and
# compresses better too (measured: 16 % smaller and a fifth faster than square chunks).
_CHUNK = 16384

# gzip beyond 1 gains 3 % in size for a quarter more time on histories.
_LEVEL = 1

_GIVE_ONE = "Give a result.nc that axlespan wrote"

_COORDINATES = {
    "time": "time",
    "sensor": "name of the sensor",
    "contact": "vehicle.wheel, counted from the head of the train",
    "vehicle_dof": "vehicle.part.component, vehicles counted from the head of the train",
    "support": "support.component",
}


@dataclass(frozen=True, eq=False)
class Header:
    """What a result file says about itself, without its histories."""

    case_text: str | None  # the case file, None where there was none
    version: str  # of axlespan
    outcome: Outcome
    checks: Mapping[str, Any]
    facts: Mapping[str, Any]


# --- out -----------------------------------------------------------------------------------------


def write_result(
    result: Result,
    path: str | PathLike[str],
    *,
    case_text: str | None = None,
    version: str | None = None,
    drawing: Drawing | None = None,
) -> Path:
    """Write a result as netCDF-4.

    The file appears whole or not at all: it is written beside its place under another name, and then moved.

    Parameters
    ----------
    result : Result
        A failed run's partial result too.
    path : path
        Of the file; its folder must exist. A file that is there is replaced.
    case_text : str, optional
        Text of the case file, kept as the attribute ``case``.
    version : str, optional
        Of axlespan; this one when left out.
    drawing : Drawing, optional
        Geometry, so that the result can be drawn (:func:`axlespan.io.drawing.drawing_of`).

    Returns
    -------
    Path

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    place = Path(path)
    part = place.with_name(f".{place.name}.{os.getpid()}-{secrets.token_hex(4)}.part")
    # Made in memory: a disk that is full while HDF5 closes a file takes the whole process down.
    content = BytesIO()
    with h5netcdf.File(content, "w") as file:
        file.attrs.update(_attributes(result, case_text, version or axlespan.__version__))
        _write_coordinates(file, result)
        _write_histories(file, result)
        write_extras(file, result)
        if drawing is not None:
            write_drawing(file, drawing)
    try:
        part.write_bytes(content.getbuffer())
        os.replace(part, place)
    finally:
        part.unlink(missing_ok=True)
    return place


def _attributes(result: Result, case_text: str | None, version: str) -> dict[str, Any]:
    return {
        "format": "axlespan result",
        "format_version": FORMAT_VERSION,
        "case": case_text or "",
        "version": version,
        "outcome": result.outcome.code,
        "outcome_message": result.outcome.message,
        "outcome_remedy": result.outcome.remedy,
        "checks": to_json(result.checks),
        "facts": to_json(result.facts),
    }


def _write_coordinates(file: h5netcdf.File, result: Result) -> None:
    for name, meaning in _COORDINATES.items():
        values = getattr(result, name)
        file.dimensions[name] = len(values)
        if name == "time":
            variable = file.create_variable(name, (name,), np.float64, data=values)
            variable.attrs["units"] = "s"
        else:
            names = np.array(values, dtype=h5py.string_dtype())
            variable = file.create_variable(name, (name,), names.dtype)
            if len(values):
                variable[:] = names
        variable.attrs["long_name"] = meaning


def _write_histories(file: h5netcdf.File, result: Result) -> None:
    for name, (dimension, unit, meaning) in VARIABLES.items():
        values: FloatArray = getattr(result, name)
        variable = file.create_variable(name, ("time", dimension), np.float64, **_storage(values.shape))
        if values.size:
            variable[...] = values
        variable.attrs["units"] = unit
        variable.attrs["long_name"] = meaning


def _storage(shape: tuple[int, ...]) -> dict[str, Any]:
    """Chunks and compression; small or empty arrays are better off without."""
    n_time, n = shape
    if n_time * n < 1024:
        return {}
    rows = min(n_time, _CHUNK)
    columns = min(n, max(1, _CHUNK // rows))
    return {
        "chunks": (rows, columns),
        "compression": "gzip",
        "compression_opts": _LEVEL,
        "shuffle": True,
    }


# --- in ------------------------------------------------------------------------------------------


def read_result(path: str | PathLike[str]) -> Result:
    """Read a result that :func:`write_result` wrote; that of a failed run too.

    Parameters
    ----------
    path : path
        ``result.nc``.

    Raises
    ------
    InputError
        If the file does not exist, is no result, is cut short or damaged, or comes from a later version.
    """
    with _opened(path) as file:
        header = _header(file)
        coordinates: dict[str, Any] = {name: _names(file, name) for name in _COORDINATES if name != "time"}
        time = np.asarray(file["time"][...], dtype=np.float64)
        histories: dict[str, Any] = {
            name: _history(file, name, (len(time), len(coordinates[dimension])))
            for name, (dimension, _, _) in VARIABLES.items()
        }
        return Result(
            time=time,
            **coordinates,
            **histories,
            **read_extras(file),
            outcome=header.outcome,
            checks=header.checks,
            facts=header.facts,
        )


def read_header(path: str | PathLike[str]) -> Header:
    """Read what a result file says about itself, without its histories.

    Raises
    ------
    InputError
        As :func:`read_result`.
    """
    with _opened(path) as file:
        return _header(file)


@contextmanager
def _opened(path: str | PathLike[str]) -> Iterator[h5py.File]:
    """A result file, open; what is wrong with it is an InputError."""
    file = str(path)
    if not Path(path).exists():
        raise InputError("does not exist", field="file", value=file, fix="Check the path")
    if not Path(path).is_file():
        raise InputError("is not a file", field="file", value=file, fix="Give the path of a result.nc")
    try:
        with h5py.File(path, "r") as opened:
            _require_result(opened, file)
            yield opened
    except InputError:
        raise
    except PermissionError as error:
        raise InputError(f"cannot be read: {_reason(error)}", field="file", value=file) from error
    except OSError as error:
        if "signature not found" in str(error):
            raise InputError("is not a netCDF-4 file", field="file", value=file, fix=_GIVE_ONE) from error
        raise _damaged(file, error) from error
    except (ArithmeticError, AttributeError, LookupError, RuntimeError, TypeError, ValueError) as error:
        # what h5py and json say about bytes that do not fit together
        raise _damaged(file, error) from error


def _damaged(file: str, error: Exception) -> InputError:
    rule = f"is cut short or damaged: {_reason(error)}"
    return InputError(rule, field="file", value=file, fix="Copy it again, or run the case again")


def _reason(error: Exception) -> str:
    """One line of an exception; h5py wraps the words of interest in parentheses."""
    text = " ".join(str(getattr(error, "strerror", None) or error).split()).strip("'\"")
    if text.startswith(("Unable to", "Can't")) and "(" in text and text.endswith(")"):
        text = text[text.index("(") + 1 : -1]
    return text.partition(", sblock")[0][:200] or type(error).__name__


def _require_result(file: h5py.File, path: str) -> None:
    number = int(np.asarray(file.attrs.get("format_version", 1)).item())
    if number > FORMAT_VERSION:
        writer = _text(file, "version") or "of a later version"
        raise InputError(
            f"was written by axlespan {writer} in format {number}; this version reads up to {FORMAT_VERSION}",
            field="file",
            value=path,
            fix="pip install --upgrade axlespan",
        )
    missing = [f"variable {name}" for name in (*_COORDINATES, *VARIABLES) if name not in file]
    if "outcome" not in file.attrs:
        missing.append("attribute outcome")
    if missing:
        rule = f"is not a result of axlespan: it has no {missing[0]}"
        raise InputError(rule, field="file", value=path, fix=_GIVE_ONE)


def _header(file: h5py.File) -> Header:
    outcome = Outcome(_text(file, "outcome"), _text(file, "outcome_message"), _text(file, "outcome_remedy"))
    checks, facts = (json.loads(_text(file, name) or "{}") for name in ("checks", "facts"))
    return Header(_text(file, "case") or None, _text(file, "version"), outcome, checks, facts)


def _text(file: h5py.File, attribute: str) -> str:
    value = np.asarray(file.attrs.get(attribute, "")).item()
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def _names(file: h5py.File, name: str) -> tuple[str, ...]:
    return tuple(file[name].asstr()[...].tolist())


def _history(file: h5py.File, name: str, shape: tuple[int, int]) -> FloatArray:
    values = np.asarray(file[name][...], dtype=np.float64)
    if values.shape != shape:
        raise ValueError(f"{name} has the shape {values.shape}, not {shape}")
    return values
