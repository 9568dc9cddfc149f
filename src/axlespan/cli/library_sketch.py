"""Side views of vehicles and trains in letters: wheels on a line, names over it, positions under it."""

from __future__ import annotations

from collections.abc import Sequence

from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import Vehicle

_VEHICLE, _TRAIN = 76, 100  # columns

Mark = tuple[int, str]


def vehicle_sketch(vehicle: Vehicle) -> list[str]:
    """Return a side view: bodies at their centers over the wheels; the front is left."""
    positions = sorted({point.behind for point in vehicle.contacts})
    return _drawn(positions, [(x, name) for name, x in vehicle.bodies.items()], positions, _VEHICLE)


def train_sketch(train: Train) -> list[str]:
    """Return a side view: numbers of the vehicles over their wheels; the front is left."""
    middles = [item.behind + 0.5 * item.vehicle.wheelbase for item in train.placements]
    names = [(x, str(number)) for number, x in enumerate(middles, 1)]
    heads = [item.behind for item in train.placements]
    return _drawn(train.offsets.tolist(), names, [*heads, train.wheelbase], _TRAIN)


def _drawn(
    wheels: Sequence[float], names: Sequence[tuple[float, str]], told: Sequence[float], width: int
) -> list[str]:
    everything = [*wheels, *(x for x, _ in names)]
    low, high = min(everything), max(everything)
    scale = (width - 1) / (high - low) if high > low else 0.0

    def column(x: float) -> int:
        return round((x - low) * scale)

    rail = ["-"] * (width if scale else 1)
    for x in wheels:
        rail[column(x)] = "O"
    over = _stacked([(column(x), name) for x, name in names])
    under = _labels([(column(x), f"{x:.6g}") for x in told])
    return [f"  {line}" for line in (*over, "".join(rail), f"{under} m")]


def _labels(marks: Sequence[Mark]) -> str:
    """Words that start at their columns, as far as they don't run into each other; the last one is there."""
    *some, (last, word) = marks
    text = ""
    for column, label in some:
        begins = column > len(text) or not text
        if begins and column + len(label) < last:
            text = text.ljust(column) + label
    return text.ljust(last) + word if last or not text else text


def _stacked(marks: Sequence[Mark]) -> list[str]:
    """Words around their columns, in as many lines as they need."""
    lines: list[str] = []
    for column, word in marks:
        begin = max(0, column - len(word) // 2)
        end = begin + len(word)
        for i, line in enumerate(lines):
            if not line[max(begin - 2, 0) : end + 2].strip():
                lines[i] = line.ljust(begin)[:begin] + word + line[end:]
                break
        else:
            lines.append(" " * begin + word)
    return lines
