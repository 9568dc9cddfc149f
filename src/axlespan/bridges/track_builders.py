"""Tracks from a preset and a few numbers: ballasted, and on slabs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from axlespan.bridges.rails import Rail, rail_named
from axlespan.bridges.track import Layer, Track
from axlespan.bridges.track_presets import TrackPreset, preset_named
from axlespan.errors import InputError
from axlespan.model.materials import require_positive


def ballasted_track(
    preset: str | None = "zhai-2004",
    *,
    rail: str | Rail | None = None,
    sleeper_spacing: float | None = None,
    pad_stiffness: float | None = None,
    pad_damping: float | None = None,
    sleeper_mass: float | None = None,
    ballast_stiffness: float | None = None,
    ballast_damping: float | None = None,
    ballast_mass: float | None = None,
    shear_stiffness: float | None = None,
    shear_damping: float | None = None,
    subgrade_stiffness: float | None = None,
    subgrade_damping: float | None = None,
    deck_ballast_stiffness: float | None = None,
    deck_ballast_damping: float | None = None,
) -> Track:
    """A ballasted track: rails, pads, sleepers, ballast, ballast masses, subgrade.

    All values are those of **one whole sleeper: both rail seats together**; those that are left out are the
    preset's. On a bridge the ballast stands on the deck: its mass belongs to the deck's mass per length, and
    there is no subgrade.

    Parameters
    ----------
    preset : str or None
        ``zhai-2004``, ``ttb-2d`` or ``railfe``, see :data:`~axlespan.bridges.track_presets.PRESETS`; None to
        give all values.
    rail : str or Rail, optional
        Each of the two rails, see :data:`~axlespan.bridges.rails.RAILS`.
    sleeper_spacing : float, optional
        [m].
    pad_stiffness, ballast_stiffness, subgrade_stiffness : float, optional
        [N/m]; a subgrade of zero leaves out ballast masses and subgrade.
    pad_damping, ballast_damping, subgrade_damping : float, optional
        [N s/m].
    sleeper_mass, ballast_mass : float, optional
        [kg].
    shear_stiffness, shear_damping : float, optional
        Between neighboring ballast masses [N/m], [N s/m].
    deck_ballast_stiffness, deck_ballast_damping : float, optional
        Of the ballast on a deck, where it is thinner or lies on a mat [N/m], [N s/m]; as on the ground when left out.

    Raises
    ------
    InputError
        If a value is out of range or the preset is unknown.

    Examples
    --------
    >>> track = ballasted_track(pad_stiffness=120e6)
    >>> f"{track.foundation_modulus() / 1e6:.1f} MN/m2, 1/beta = {track.characteristic_length:.3f} m"
    '90.5 MN/m2, 1/beta = 0.875 m'
    """
    given = {
        "sleeper_spacing": sleeper_spacing,
        "pad_stiffness": pad_stiffness,
        "pad_damping": pad_damping,
        "sleeper_mass": sleeper_mass,
        "ballast_stiffness": ballast_stiffness,
        "ballast_damping": ballast_damping,
        "ballast_mass": ballast_mass,
        "shear_stiffness": shear_stiffness,
        "shear_damping": shear_damping,
        "subgrade_stiffness": subgrade_stiffness,
        "subgrade_damping": subgrade_damping,
        "deck_ballast_stiffness": deck_ballast_stiffness,
        "deck_ballast_damping": deck_ballast_damping,
    }
    known, chosen = _preset(preset, "ballasted")
    v = _values(known, given, ("sleeper_spacing", "pad_stiffness", "sleeper_mass", "ballast_stiffness"))
    pads = Layer("pads", v["pad_stiffness"], v["pad_damping"], "sleepers", v["sleeper_mass"])
    ballast = Layer("ballast", v["ballast_stiffness"], v["ballast_damping"])
    below = ballast
    if deck_ballast_stiffness is not None or deck_ballast_damping is not None:
        below = replace(
            ballast,
            stiffness=v["deck_ballast_stiffness"] or ballast.stiffness,
            damping=ballast.damping if deck_ballast_damping is None else deck_ballast_damping,
        )
    layers: tuple[Layer, ...] = (pads, ballast)
    if require_positive(v["subgrade_stiffness"], "subgrade_stiffness", zero=True) > 0.0:
        massive = replace(
            ballast,
            body="ballast masses",
            mass=v["ballast_mass"],
            shear_stiffness=v["shear_stiffness"],
            shear_damping=v["shear_damping"],
        )
        layers = (pads, massive, Layer("subgrade", v["subgrade_stiffness"], v["subgrade_damping"]))
    return Track(
        rail_named(rail or (chosen.rail if chosen else "60E1")),
        v["sleeper_spacing"],
        layers,
        (pads, below),
        name="ballasted track" + (f" {preset}" if preset else ""),
        preset=chosen,
    )


def slab_track(
    preset: str | None = "slab",
    *,
    rail: str | Rail | None = None,
    fastening_spacing: float | None = None,
    fastening_stiffness: float | None = None,
    fastening_damping: float | None = None,
    slab_bending_stiffness: float | None = None,
    slab_mass: float | None = None,
    foundation_modulus: float | None = None,
    foundation_damping: float | None = None,
    mortar_modulus: float | None = None,
    mortar_damping: float | None = None,
    panel_length: float | None = None,
) -> Track:
    """A slab track: rails, fastenings, a slab, and a layer under it on the ground or on the deck.

    All values are those of the whole track: **both rail seats together**, the whole width of the slab.

    Parameters
    ----------
    preset : str or None
        ``slab``; None to give all values.
    rail, fastening_spacing
        As in :func:`ballasted_track`.
    fastening_stiffness, fastening_damping : float, optional
        Of both rail seats [N/m], [N s/m].
    slab_bending_stiffness, slab_mass : float, optional
        EI [N m^2] and mass per length [kg/m] of the slab.
    foundation_modulus, foundation_damping : float, optional
        Of all that lies under the slab on the ground, per length [N/m^2], [N s/m^2].
    mortar_modulus, mortar_damping : float, optional
        Of the layer between slab and deck, per length [N/m^2], [N s/m^2].
    panel_length : float, optional
        Of slabs with joints [m]; a slab always ends at the ends of a deck.

    Raises
    ------
    InputError
        If a value is out of range or the preset is unknown.
    """
    given = {
        "fastening_spacing": fastening_spacing,
        "fastening_stiffness": fastening_stiffness,
        "fastening_damping": fastening_damping,
        "slab_bending_stiffness": slab_bending_stiffness,
        "slab_mass": slab_mass,
        "foundation_modulus": foundation_modulus,
        "foundation_damping": foundation_damping,
        "mortar_modulus": mortar_modulus,
        "mortar_damping": mortar_damping,
    }
    known, chosen = _preset(preset, "slab")
    needed = ("fastening_spacing", "fastening_stiffness", "slab_bending_stiffness", "slab_mass")
    v = _values(known, given, (*needed, "foundation_modulus", "mortar_modulus"))
    a = require_positive(v["fastening_spacing"], "fastening_spacing")
    for name in (*needed, "foundation_modulus", "mortar_modulus"):
        require_positive(v[name], name)
    if panel_length is not None and not panel_length >= 2.0 * a:
        raise InputError(
            f"must be at least two support spacings, {2.0 * a:g} m", field="panel_length", value=panel_length
        )
    fastenings = Layer(
        "fastenings",
        v["fastening_stiffness"],
        v["fastening_damping"],
        "slab",
        v["slab_mass"] * a,
        v["slab_bending_stiffness"],
    )
    return Track(
        rail_named(rail or (chosen.rail if chosen else "60E1")),
        a,
        (fastenings, Layer("foundation", v["foundation_modulus"] * a, v["foundation_damping"] * a)),
        (fastenings, Layer("mortar", v["mortar_modulus"] * a, v["mortar_damping"] * a)),
        panel_length=panel_length,
        name="slab track",
        preset=chosen,
    )


def _preset(name: str | None, kind: str) -> tuple[dict[str, float], TrackPreset | None]:
    if name is None:
        return {}, None
    found = preset_named(name, kind)
    return dict(found.values), found


def _values(
    known: dict[str, float], given: dict[str, float | None], needed: Sequence[str]
) -> dict[str, float]:
    """Values that are given, else those of the preset, else zero."""
    result = {name: known.get(name, 0.0) if value is None else float(value) for name, value in given.items()}
    for name in needed:
        if name not in known and given[name] is None:
            raise InputError("is missing", field=name, fix="Give it, or name a preset")
    for name, value in result.items():
        require_positive(value, name, zero=name not in needed)
    return result
