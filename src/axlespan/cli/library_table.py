"""The list of everything that comes with the package."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.bridges.track_presets import PRESETS
from axlespan.cli.columns import columns
from axlespan.irregularity import spectrum
from axlespan.irregularity.spectra.base import FOUND, QUANTITIES
from axlespan.irregularity.spectra.registry import spectrum_names
from axlespan.vehicles import Vehicle, library, load_trains
from axlespan.vehicles.library.trains import train_of
from axlespan.vehicles.load_trains.load_train import CHECK

MARK = "*"


def list_everything() -> list[str]:
    """Return the lines of the whole list."""
    sections = [
        *_vehicles("Rail vehicles", "rail"),
        *_vehicles("Road vehicles", "road"),
        *_trains(),
        *_load_trains(),
        *_spectra(),
        *_tracks(),
    ]
    return [
        *sections,
        f"{MARK} from memory, assumed or corrected in part: check against the source before relying on it.",
        "",
        "All about one of them: axlespan library NAME",
        "A vehicle to change: axlespan library NAME --copy my.yaml, then train: [{vehicle: my.yaml}] in the case",
    ]


def span(values: npt.ArrayLike, digits: int = 4) -> str:
    """One value, or the smallest and the largest."""
    low, high = float(np.min(values)), float(np.max(values))
    shown = [f"{low:.{digits}g}", f"{high:.{digits}g}"]
    return shown[0] if shown[0] == shown[1] else f"{shown[0]}-{shown[1]}"


def axle_forces(vehicle: Vehicle, gravity: float = 9.81) -> tuple[list[float], list[float]]:
    """Positions of the axles [m] and their static loads [N], left and right wheels together."""
    loads: dict[float, float] = {}
    for point, force in zip(vehicle.contacts, vehicle.static_forces(gravity), strict=True):
        loads[point.behind] = loads.get(point.behind, 0.0) + float(force)
    return list(loads), list(loads.values())


def _vehicles(title: str, group: str) -> list[str]:
    rows = [["name", "", "", "mass [t]", "axles [kN]", "f [Hz]", ""]]
    for name in library.names():
        entry = library.entry(name)
        if entry.model is None or entry.group != group:
            continue
        space = "3-D" if entry.is_spatial else "2-D"
        mark = MARK if entry.to_check else ""
        numbers = [f"{entry.model.total_mass / 1e3:.4g}", span(np.array(axle_forces(entry.model)[1]) / 1e3)]
        rows.append([name, mark, space, *numbers, span(entry.model.frequencies(), 3), entry.title])
    return [title, *columns(rows, right=(3,)), ""]


def _trains() -> list[str]:
    rows = []
    for name in library.names():
        entry = library.entry(name)
        if entry.kind == "train":
            train = train_of(entry)
            size = f"{len(train.placements)} vehicles, {train.wheelbase:.4g} m from first wheel to last"
            rows.append([name, MARK if entry.to_check else "", size, entry.title])
    return ["Trains of vehicles", *columns(rows), ""]


def _load_trains() -> list[str]:
    rows = []
    for entry in load_trains.entries():
        vehicle = entry.vehicle()
        forces = vehicle.static_forces()
        size = f"{len(forces)} axles"
        mark = MARK if entry.certainty == CHECK else ""
        rows.append(
            [entry.name, mark, size, f"{span(forces / 1e3)} kN", f"{vehicle.wheelbase:.6g} m", entry.title]
        )
    return ["Load trains: moving axle forces", *columns(rows, right=(2, 3, 4)), ""]


def _spectra() -> list[str]:
    rows = []
    for name in spectrum_names():
        quantities = [quantity for quantity in QUANTITIES if name in spectrum_names(quantity)]
        known = [spectrum(name, quantity) for quantity in quantities]
        mark = "" if all(one.status == FOUND for one in known) else MARK
        low, high = known[0].wavelengths
        rows.append([name, mark, f"{low:g} to {high:g} m", ", ".join(quantities)])
    return ["Spectra of irregularities", *columns(rows), ""]


def _tracks() -> list[str]:
    rows = [
        [name, MARK if preset.to_check else "", preset.kind, preset.rail, preset.source]
        for name, preset in sorted(PRESETS.items())
    ]
    return ["Track values", *columns(rows), ""]
