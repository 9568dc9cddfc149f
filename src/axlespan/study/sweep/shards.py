"""Histories of many scenarios in one netCDF-4 file: a shard, which xarray opens as it is.

Scenarios of one shard share their time step. Shorter ones are filled with NaN, and so are wheels that a train does
not have.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import h5netcdf
import h5py
import numpy as np
import numpy.typing as npt

from axlespan.interaction.plan import Plan
from axlespan.interaction.result import VARIABLES, Result
from axlespan.study.sweep.spec import Kept

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Histories:
    """Histories of some scenarios.

    ``tables`` has for each variable its dimension beside time, the names along it, and for each scenario an array
    (n_time, n_name) of its own length; a scenario that has fewer of the names has its own ones, ``names_of``.
    """

    ids: tuple[int, ...]
    interval: float  # [s] from one value to the next
    tables: Mapping[str, tuple[str, tuple[str, ...], list[FloatArray]]]

    @property
    def nbytes(self) -> int:
        """Bytes of all values."""
        return sum(values.nbytes for _, _, many in self.tables.values() for values in many)


def histories_of(kept: Kept | None, results: Mapping[int, tuple[Result, Plan]]) -> Histories | None:
    """The histories that a study keeps of completed scenarios; None if it keeps none."""
    if kept is None or not results:
        return None
    some, plan = next(iter(results.values()))
    tables: dict[str, tuple[str, tuple[str, ...], list[FloatArray]]] = {}
    for name in kept.variables:
        dimension = VARIABLES[name][0]
        names = tuple(dict.fromkeys(n for result, _ in results.values() for n in getattr(result, dimension)))
        position = {n: i for i, n in enumerate(names)}
        arrays = []
        for result, _ in results.values():
            values = np.asarray(getattr(result, name))[:: kept.every]
            own = [position[n] for n in getattr(result, dimension)]
            if len(own) < len(names):
                full = np.full((len(values), len(names)), np.nan)
                full[:, own] = values
                values = full
            arrays.append(np.ascontiguousarray(values))
        tables[name] = (dimension, names, arrays)
    del some
    return Histories(tuple(results), plan.settings.time_step * plan.settings.every * kept.every, tables)


def shard_bytes(histories: Histories, attributes: Mapping[str, Any]) -> bytes:
    """A shard as the bytes of a netCDF-4 file.

    Made in memory: a disk that is full while HDF5 closes a file takes the whole process down.
    """
    content = BytesIO()
    with h5netcdf.File(content, "w") as file:
        file.attrs.update(attributes)
        longest = max((len(a) for _, _, arrays in histories.tables.values() for a in arrays), default=0)
        file.dimensions["scenario"] = len(histories.ids)
        file.dimensions["time"] = longest
        file.create_variable(
            "scenario", ("scenario",), np.int64, data=np.array(histories.ids, dtype=np.int64)
        )
        times = np.arange(longest) * histories.interval
        clock = file.create_variable("time", ("time",), np.float64, data=times)
        clock.attrs["units"] = "s"
        for name, (dimension, names, arrays) in histories.tables.items():
            _names(file, dimension, names)
            _variable(file, name, dimension, _stacked(arrays, longest, len(names)))
    return content.getvalue()


def _stacked(arrays: Sequence[FloatArray], longest: int, width: int) -> FloatArray:
    values = np.full((len(arrays), longest, width), np.nan)
    for row, array in zip(values, arrays, strict=True):
        row[: len(array)] = array
    return values


def _names(file: h5netcdf.File, dimension: str, names: Sequence[str]) -> None:
    if dimension in file.dimensions:
        return
    file.dimensions[dimension] = len(names)
    texts = np.array(names, dtype=h5py.string_dtype())
    variable = file.create_variable(dimension, (dimension,), texts.dtype)
    if len(names):
        variable[:] = texts


def _variable(file: h5netcdf.File, name: str, dimension: str, values: FloatArray) -> None:
    storage: dict[str, Any] = {}
    if values.size >= 1024:  # a chunk is one scenario
        chunk = (1, *values.shape[1:])
        storage = {"chunks": chunk, "compression": "gzip", "compression_opts": 1, "shuffle": True}
    variable = file.create_variable(name, ("scenario", "time", dimension), np.float64, **storage)
    if values.size:
        variable[...] = values
    _, unit, meaning = VARIABLES[name]
    variable.attrs["units"] = unit
    variable.attrs["long_name"] = meaning
