"""Sensors: positions on lines of the structure, and their weights of the d.o.f."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: A position [m] on the structure's line for sensors (the deck under a track), or a line and a position on it.
SensorPlace = float | tuple[str, float]


def split_places(
    structure: Structure, sensors: Mapping[str, SensorPlace] | None
) -> tuple[dict[str, float], dict[str, str]]:
    """Positions [m] and lines of sensors by their names.

    Raises
    ------
    InputError
        If a line is unknown.
    """
    positions, lines = {}, {}
    for name, place in (sensors or {}).items():
        line, position = place if isinstance(place, tuple) else (structure.sensor_line, place)
        try:
            structure.line(line)
        except InputError as error:
            field = f"sensors.{name}.line"
            raise InputError(error.rule, field=field, value=line, fix=error.fix) from None
        positions[name], lines[name] = position, line
    return positions, lines


def check_sensors(structure: Structure, positions: Mapping[str, float], lines: Mapping[str, str]) -> None:
    """Require sensors on their lines.

    Raises
    ------
    InputError
    """
    for name, position in positions.items():
        line = lines.get(name, structure.sensor_line)
        path = structure.line(line)
        if not path.start <= position <= path.stop:
            fix = None
            if line == structure.sensor_line and structure.line().carries(np.array(position)):
                fix = f"Sensors on the rails name their line: {{at: {position:g} m, line: rail}}"
            raise InputError(
                f"must lie on the {'deck' if line == 'deck' else 'structure'}, between {path.start:g} and "
                f"{path.stop:g} m",
                field=f"sensors.{name}",
                value=position,
                fix=fix,
            )


def by_line(
    structure: Structure, names: Sequence[str], positions: Mapping[str, float], lines: Mapping[str, str]
) -> dict[str, tuple[IntArray, FloatArray]]:
    """Numbers among ``names`` and positions [m] of the sensors of each line."""
    own = [lines.get(name, structure.sensor_line) for name in names]
    where = np.array([positions[name] for name in names], dtype=float)
    result = {}
    for line in dict.fromkeys(own):
        numbers = np.array([i for i, other in enumerate(own) if other == line], dtype=np.int64)
        result[line] = (numbers, where[numbers])
    return result


def sensor_rows(
    structure: Structure, positions: Mapping[str, float], lines: Mapping[str, str]
) -> sp.csr_array:
    """Rows (n_sensor, n) of all sensors over the independent d.o.f."""
    n = structure.system.size
    blocks, order = [sp.csr_array((0, n))], [np.empty(0, dtype=np.int64)]
    for line, (numbers, where) in by_line(structure, list(positions), positions, lines).items():
        blocks.append(structure.line(line).rows(where, n))
        order.append(numbers)
    return sp.csr_array(sp.csr_array(sp.vstack(blocks))[np.argsort(np.concatenate(order))])
