"""The wavelength bands in which track geometry is judged."""

from __future__ import annotations

from types import MappingProxyType

from axlespan.errors import InputError
from axlespan.irregularity.checks import nearest, require_band

__all__ = ["EN13848_BANDS", "band_of"]

# EN 13848-1, from memory: check against the standard. D3 ends at 150 m for the longitudinal level, at 200 m
# for the alignment; give (70.0, 200.0) for that.
EN13848_BANDS = MappingProxyType({"D1": (3.0, 25.0), "D2": (25.0, 70.0), "D3": (70.0, 150.0)})


def band_of(band: str | tuple[float, float]) -> tuple[float, float]:
    """Return (shortest, longest) wavelength [m] of a band given by name ("D1", …) or by its bounds."""
    if isinstance(band, str):
        if band not in EN13848_BANDS:
            raise InputError(
                f"is not a band of EN 13848-1: {', '.join(EN13848_BANDS)}",
                field="band",
                value=band,
                fix=nearest(band.upper(), list(EN13848_BANDS))
                or "Or give (shortest, longest) wavelength in meters",
            )
        return EN13848_BANDS[band]
    require_band(band, "band")
    return band
