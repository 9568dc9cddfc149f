"""Section forces, stresses, envelopes and fields in and out of result.nc."""

from __future__ import annotations

from typing import Any

import h5netcdf
import h5py
import numpy as np
import numpy.typing as npt

from axlespan.interaction.extras import extra_coordinates, extra_variables, extras_from
from axlespan.interaction.result import Result

_TEXTS, _NUMBERS = ("section", "stress", "dof"), ("station", "field_time", "stress_history")


def write_extras(file: h5netcdf.File, result: Result) -> None:
    """Add what a result has beside its histories to an open file that holds these already."""
    for name, coordinate in extra_coordinates(result).items():
        file.dimensions[coordinate.dimensions[0]] = len(coordinate.values)
        text = coordinate.values.dtype == object
        dtype = h5py.string_dtype() if text else np.float64
        values = np.array(coordinate.values.tolist(), dtype=dtype)  # keeps the dtype's mark of a text
        variable = file.create_variable(name, coordinate.dimensions, values.dtype)
        variable[...] = values
        variable.attrs.update(_attributes(coordinate.unit, coordinate.meaning))
    for name, extra in extra_variables(result).items():
        storage = {"compression": "gzip", "compression_opts": 1} if extra.values.size > 1024 else {}
        variable = file.create_variable(name, extra.dimensions, np.float64, **storage)
        if extra.values.size:
            variable[...] = extra.values
        variable.attrs.update(_attributes(extra.unit, extra.meaning))


def _attributes(unit: str, meaning: str) -> dict[str, str]:
    return {"units": unit, "long_name": meaning} if unit else {"long_name": meaning}


def read_extras(file: h5py.File) -> dict[str, Any]:
    """What :func:`write_extras` wrote, as arguments of a Result; empty if there is nothing."""
    arrays: dict[str, npt.NDArray[Any]] = {}
    for name, data in file.items():
        if name in _TEXTS:
            arrays[name] = np.array(data.asstr()[...], dtype=object)
        elif name in _NUMBERS or name.startswith(("section_", "envelope_", "field_", "line_")):
            arrays[name] = np.asarray(data[...], dtype=np.float64)
    return extras_from(arrays)
