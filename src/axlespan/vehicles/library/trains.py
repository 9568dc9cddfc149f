"""Trains of library entries: vehicles at their spacings, or several trains one behind another."""

from __future__ import annotations

from axlespan.errors import InputError
from axlespan.model.materials import require_positive
from axlespan.vehicles.library.entry import LibraryEntry
from axlespan.vehicles.train import Placement, Train


def train_of(entry: LibraryEntry, count: int = 1, spacing: float | None = None) -> Train:
    """Return ``count`` vehicles or trains of an entry, at a spacing from first wheel to first wheel [m].

    Raises
    ------
    InputError
        If a spacing is needed and neither given nor known.
    """
    if isinstance(count, bool) or int(count) != count or count < 1:
        raise InputError("must be a whole number of at least 1", field="count", value=count)
    one = [Placement(entry.model, 0.0)] if entry.model is not None else _consist(entry)
    step = spacing if spacing is not None else entry.pitch
    if count > 1:
        if step is None:
            raise InputError(
                f"is needed for several of '{entry.name}': the library does not know it", field="spacing"
            )
        require_positive(step, "spacing")
    placements = [
        Placement(item.vehicle, number * (step or 0.0) + item.behind)
        for number in range(int(count))
        for item in one
    ]
    return Train(tuple(placements), entry.title if count == 1 else f"{count} × {entry.title}")


def _consist(entry: LibraryEntry) -> list[Placement]:
    """Vehicles of a train, each behind the one before by that one's spacing."""
    placements: list[Placement] = []
    behind = 0.0
    for group in entry.groups:
        inner = train_of(group.entry)
        for number in range(group.count):
            begin = behind + number * (group.spacing or 0.0)
            placements += [Placement(item.vehicle, begin + item.behind) for item in inner.placements]
        behind += group.reach or 0.0
    return placements
