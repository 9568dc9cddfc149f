"""Sets of track values with their sources; values of the whole track: both rail seats, a whole sleeper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from axlespan.errors import InputError
from axlespan.model.dofs import nearest


@dataclass(frozen=True)
class TrackPreset:
    """Values of a track by their names in ``ballasted_track`` or ``slab_track``."""

    name: str
    kind: str  # ballasted or slab
    values: Mapping[str, float]
    source: str
    rail: str = "60E1"
    to_check: frozenset[str] = field(default_factory=frozenset)  # values from memory or typical ones


_ZHAI = "Zhai, Wang and Lin (2004), J. Sound Vib. 270, 673-683"

#: Presets by name.
PRESETS: Mapping[str, TrackPreset] = {
    preset.name: preset
    for preset in (
        TrackPreset(
            "zhai-2004",
            "ballasted",
            {
                "sleeper_spacing": 0.6,
                "pad_stiffness": 2 * 65.0e6,
                "pad_damping": 2 * 75.0e3,
                "sleeper_mass": 251.0,
                "ballast_stiffness": 2 * 137.75e6,
                "ballast_damping": 2 * 58.8e3,
                "ballast_mass": 2 * 531.4,
                "shear_stiffness": 2 * 78.4e6,
                "shear_damping": 2 * 80.0e3,
                "subgrade_stiffness": 2 * 77.5e6,
                "subgrade_damping": 2 * 31.15e3,
            },
            f"{_ZHAI}, its values of one rail seat doubled for two rails; shear coupling from memory",
            rail="CHN60",
            to_check=frozenset({"shear_stiffness", "shear_damping"}),
        ),
        TrackPreset(
            "ttb-2d",
            "ballasted",
            {
                "sleeper_spacing": 0.6,
                "pad_stiffness": 65.0e6,
                "pad_damping": 75.0e3,
                "sleeper_mass": 251.0,
                "ballast_stiffness": 137.75e6,
                "ballast_damping": 58.8e3,
                "ballast_mass": 531.4,
                "subgrade_stiffness": 77.5e6,
                "subgrade_damping": 31.15e3,
            },
            f"as in the program TTB-2D: two rails and a whole sleeper on pads, ballast and subgrade that {_ZHAI}, "
            "gives for one rail seat; for comparison with that program",
            rail="CHN60",
        ),
        TrackPreset(
            "railfe",
            "ballasted",
            {
                "sleeper_spacing": 0.6,
                "pad_stiffness": 2 * 200.0e6,
                "pad_damping": 2 * 28.0e3,
                "sleeper_mass": 280.0,
                "ballast_stiffness": 2 * 40.0e6,
                "ballast_damping": 2 * 47.0e3,
            },
            "as in the program railFE, its values of one rail seat doubled; sleeper B70; ballast and ground in one",
            rail="UIC60",
        ),
        TrackPreset(
            "slab",
            "slab",
            {
                "fastening_spacing": 0.65,
                "fastening_stiffness": 2 * 40.0e6,
                "fastening_damping": 2 * 30.0e3,
                "slab_bending_stiffness": 34.0e9 * 2.6 * 0.24**3 / 12.0,
                "slab_mass": 2500.0 * 2.6 * 0.24,
                "foundation_modulus": 300.0e6,
                "foundation_damping": 100.0e3,
                "mortar_modulus": 1.0e9,
                "mortar_damping": 80.0e3,
            },
            "typical values: rail seat 22.5 kN/mm static, 40 kN/mm dynamic; slab 2.6 m by 0.24 m of 34 GPa; "
            "mortar layer 1 GN/m2",
            to_check=frozenset(
                {
                    "fastening_stiffness",
                    "fastening_damping",
                    "slab_bending_stiffness",
                    "slab_mass",
                    "foundation_modulus",
                    "foundation_damping",
                    "mortar_modulus",
                    "mortar_damping",
                }
            ),
        ),
    )
}


def preset_named(name: str, kind: str) -> TrackPreset:
    """A preset of a kind of track.

    Raises
    ------
    InputError
        If there is none of that name, or it is one of another kind of track.
    """
    fitting = [preset.name for preset in PRESETS.values() if preset.kind == kind]
    if name not in PRESETS:
        error = nearest(name, fitting, f"preset of {kind} track")
        raise InputError(error.rule, field="preset", value=name, fix=error.fix)
    if PRESETS[name].kind != kind:
        raise InputError(
            f"is one of {PRESETS[name].kind} track",
            field="preset",
            value=name,
            fix=f"Known: {', '.join(fitting)}",
        )
    return PRESETS[name]
