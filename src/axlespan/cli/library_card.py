"""All about one vehicle or train of the library: numbers with sources, axle loads, frequencies, a sketch."""

from __future__ import annotations

import textwrap

import numpy as np
import numpy.typing as npt

from axlespan.cli.columns import columns
from axlespan.cli.library_sketch import train_sketch, vehicle_sketch
from axlespan.cli.library_table import MARK, axle_forces
from axlespan.vehicles.library import LibraryEntry
from axlespan.vehicles.library.trains import train_of
from axlespan.vehicles.mode_words import vehicle_modes
from axlespan.vehicles.vehicle import Vehicle

FloatArray = npt.NDArray[np.float64]

_WIDTH = 100


def card(entry: LibraryEntry) -> list[str]:
    """Return the lines about an entry."""
    lines = [f"{entry.name}: {entry.title}", ""]
    if entry.model is not None:
        lines += [*_of_vehicle(entry, entry.model), *_values(entry), *_sources(entry), *_notes(entry)]
        return lines
    lines += [*_of_train(entry), *_values(entry), *_sources(entry), *_notes(entry)]
    for inner in {group.entry.name: group.entry for group in entry.groups}.values():
        lines += ["-" * _WIDTH, "", *card(inner), ""]
    return lines[:-1]


def _of_vehicle(entry: LibraryEntry, vehicle: Vehicle) -> list[str]:
    positions, loads = axle_forces(vehicle)
    kinds = "left and right wheels (3-D)" if entry.is_spatial else "in the vertical plane (2-D)"
    lines = [
        f"  {kinds}, mass {vehicle.total_mass / 1e3:.6g} t"
        + (f", length {vehicle.length:g} m" if vehicle.length else "")
        + (f", {entry.pitch:g} m from first wheel to first wheel of the next" if entry.pitch else ""),
        "",
        *vehicle_sketch(vehicle),
        "",
        "Static axle loads (g = 9.81 m/s^2)",
    ]
    rows = [["axle", "behind the first [m]", "load [kN]", ""]]
    stated = _stated_loads(entry, len(loads))
    for i, (x, load) in enumerate(zip(positions, loads, strict=True)):
        rows.append([str(i + 1), f"{x:.6g}", f"{load / 1e3:.6g}", stated[i]])
    lines += [*columns(rows, right=(0, 1, 2)), *_stated_mass(entry, vehicle), ""]
    modes = vehicle_modes(vehicle)
    if modes:
        rows = [["f [Hz]", "damping", ""]]
        rows += [[f"{m.frequency:.4g}", f"{100 * m.damping_ratio:.3g} %", m.description] for m in modes]
        lines += ["Natural frequencies, contact points held", *columns(rows, right=(0, 1))]
        lines += [*_stated_frequencies(entry, np.array([mode.frequency for mode in modes])), ""]
    return lines


def _stated_loads(entry: LibraryEntry, count: int) -> list[str]:
    """Words that compare each axle load with what the source says."""
    told = entry.stated.axle_loads
    if not told or entry.model is None:
        return [""] * count
    each = told if len(told) == count else told * count
    loads = axle_forces(entry.model)[1]
    return [
        _compared(f"{one / 1e3:.5g} kN", load / one - 1.0) for one, load in zip(each, loads, strict=False)
    ]


def _stated_mass(entry: LibraryEntry, vehicle: Vehicle) -> list[str]:
    told = entry.stated.total_mass
    if told is None:
        return []
    return [
        f"  mass {vehicle.total_mass / 1e3:.6g} t, {_compared(f'{told / 1e3:.6g} t', vehicle.total_mass / told - 1.0)}"
    ]


def _stated_frequencies(entry: LibraryEntry, found: FloatArray) -> list[str]:
    """Words that compare each frequency that the source says with the nearest one."""
    lines = []
    for told in entry.stated.frequencies:
        nearest = float(found[np.argmin(np.abs(found - told))])
        lines.append(f"  {nearest:.4g} Hz, {_compared(f'{told:.4g} Hz', nearest / told - 1.0)}")
    return lines


def _compared(told: str, error: float) -> str:
    percent = round(100.0 * error, 2) + 0.0  # no minus before zero
    return f"stated: {told} ({f'{percent:+.2f} %' if percent else 'the same'})"


def _of_train(entry: LibraryEntry) -> list[str]:
    train = train_of(entry)
    mass = sum(item.vehicle.total_mass for item in train.placements)
    rows = [["vehicle", "count", "first wheel to first wheel [m]", "axles [kN]", ""]]
    for group in entry.groups:
        inner = train_of(group.entry)
        loads = axle_forces(inner.placements[0].vehicle)[1]
        spread = (
            f"{min(loads) / 1e3:.6g}"
            if np.ptp(loads) < 1.0
            else f"{min(loads) / 1e3:.6g}-{max(loads) / 1e3:.6g}"
        )
        spacing = "-" if group.spacing is None else f"{group.spacing:g}"
        rows.append([group.entry.name, str(group.count), spacing, spread, group.entry.title])
    return [
        f"  {len(train.placements)} vehicles, {len(train.contacts)} wheels, mass {mass / 1e3:.6g} t, "
        f"{train.wheelbase:.6g} m from first wheel to last",
        "",
        *train_sketch(train),
        "",
        *columns(rows, right=(1, 2, 3)),
        "",
    ]


# --- numbers and sources -----------------------------------------------------------------------------


def _values(entry: LibraryEntry) -> list[str]:
    if not entry.values:
        return []
    rows = [["", "", "", "source", ""]]
    for value in entry.values:
        key = value.origin.key if value.origin is not None else "-"
        rows.append([MARK if value.check else "", value.path, value.written, key, value.note])
    return ["Numbers", *columns(rows), ""]


def _sources(entry: LibraryEntry) -> list[str]:
    if not entry.origins:
        return []
    lines = ["Sources"]
    for origin in entry.origins.values():
        mark = f" {MARK}" if origin.check else ""
        lines += textwrap.wrap(
            f"{origin.key}: {origin.text}{mark}", _WIDTH, initial_indent="  ", subsequent_indent="    "
        )
    if entry.to_check:
        lines += [f"  {MARK} check against the source before relying on it"]
    return [*lines, ""]


def _notes(entry: LibraryEntry) -> list[str]:
    lines = []
    for note in entry.notes:
        lines += textwrap.wrap(note, _WIDTH, initial_indent="  - ", subsequent_indent="    ")
    return ["Notes", *lines] if lines else []
