"""All about one load train, spectrum or set of track values of the library."""

from __future__ import annotations

from axlespan.bridges.track_presets import PRESETS
from axlespan.cli.columns import columns
from axlespan.cli.library_table import MARK
from axlespan.irregularity import spectrum
from axlespan.irregularity.spectra.base import FOUND, QUANTITIES
from axlespan.irregularity.spectra.registry import spectrum_names
from axlespan.vehicles import load_trains


def other_names() -> list[str]:
    """Names of load trains, spectra and track values."""
    return [*load_trains.names(), *spectrum_names(), *PRESETS]


def other_card(name: str) -> list[str]:
    """Return the lines about one of them."""
    if name in load_trains.names():
        return _load_train(name)
    return _track(name) if name in PRESETS else _spectrum(name)


def _load_train(name: str) -> list[str]:
    entry = load_trains.entry(name)
    vehicle = entry.vehicle()
    forces = vehicle.static_forces()
    rows = [["axle", "behind the first [m]", "load [kN]"]]
    for i, (point, force) in enumerate(zip(vehicle.contacts, forces, strict=True)):
        rows.append([str(i + 1), f"{point.behind:.8g}", f"{force / 1e3:.6g}"])
    length = f", {vehicle.length:.6g} m long" if vehicle.length else ""
    speed = f", {3.6 * entry.speed:g} km/h" if entry.speed else ""
    return [
        f"{name}: {entry.title}",
        "",
        f"  {len(forces)} axles, {forces.sum() / 1e3:.6g} kN, {vehicle.wheelbase:.6g} m from first axle to last{length}{speed}",
        f"  source: {entry.source} ({entry.certainty})",
        *([f"  {entry.note}"] if entry.note else []),
        "",
        *columns(rows, right=(0, 1, 2)),
    ]


def _spectrum(name: str) -> list[str]:
    rows = [["", "quantity", "wavelengths", "unit", "std. deviation", "source"]]
    for quantity in QUANTITIES:
        if name in spectrum_names(quantity):
            one = spectrum(name, quantity)
            low, high = one.wavelengths
            size = 1e3 * one.standard_deviation(low, high)
            unit = "mm" if one.amplitude_unit == "m" else "mrad"
            mark = "" if one.status == FOUND else MARK
            rows.append(
                [mark, quantity, f"{low:g} to {high:g} m", one.unit, f"{size:.4g} {unit}", one.source]
            )
    marked = any(row[0] for row in rows)
    legend = [f"  {MARK} from memory: check against the standard"] if marked else []
    return [f"{name}: spectrum of irregularities", "", *columns(rows), *legend]


def _track(name: str) -> list[str]:
    preset = PRESETS[name]
    rows = [
        [MARK if key in preset.to_check else "", key, f"{value:.6g}"] for key, value in preset.values.items()
    ]
    legend = [f"  {MARK} check against the source before relying on it"] if preset.to_check else []
    return [
        f"{name}: {preset.kind} track, rail {preset.rail}; values of both rail seats, in SI units",
        f"  source: {preset.source}",
        "",
        *columns(rows, right=(2,)),
        *legend,
    ]
