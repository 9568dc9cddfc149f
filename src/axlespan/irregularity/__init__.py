"""Irregularities: how far the path of the wheels lies above its ideal line, measured, assumed or random.

Every profile has `value`, `slope` and `curvature` at positions of any shape; r > 0 lifts the wheel. What
needs SciPy (measurements, splines, spectra of given profiles) is imported when it is first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from axlespan.irregularity.bands import EN13848_BANDS
from axlespan.irregularity.composition import Bounded, Scaled, Shifted, Sum
from axlespan.irregularity.contact_patch import FiniteContact
from axlespan.irregularity.defects import Bump, DippedJoint, Pothole, Ramp, SettlementDip, Squat
from axlespan.irregularity.profile import CosineSum, Harmonic, Integrable, Profile, Smooth
from axlespan.irregularity.rails import RailPair, realize_pair
from axlespan.irregularity.realization import Realization, realize
from axlespan.irregularity.spectra import (
    Spectrum,
    china_ballastless,
    china_short_wave,
    china_trunk,
    fra,
    fra_new,
    german,
    iso8608,
    iso8608_class,
    read_spectrum,
    sncf,
    spectrum,
    spectrum_names,
    tabulated,
)
from axlespan.irregularity.table import Table
from axlespan.irregularity.wheels import OutOfRound, WheelFlat

if TYPE_CHECKING:
    from axlespan.irregularity.estimate import PsdEstimate, estimate_psd
    from axlespan.irregularity.measured import Measurement
    from axlespan.irregularity.spline import Spline

__all__ = [
    "EN13848_BANDS",
    "Bounded",
    "Bump",
    "CosineSum",
    "DippedJoint",
    "FiniteContact",
    "Harmonic",
    "Integrable",
    "Measurement",
    "OutOfRound",
    "Pothole",
    "Profile",
    "PsdEstimate",
    "RailPair",
    "Ramp",
    "Realization",
    "Scaled",
    "SettlementDip",
    "Shifted",
    "Smooth",
    "Spectrum",
    "Spline",
    "Squat",
    "Sum",
    "Table",
    "WheelFlat",
    "china_ballastless",
    "china_short_wave",
    "china_trunk",
    "estimate_psd",
    "fra",
    "fra_new",
    "german",
    "iso8608",
    "iso8608_class",
    "read_spectrum",
    "realize",
    "realize_pair",
    "sncf",
    "spectrum",
    "spectrum_names",
    "tabulated",
]

_LATE = {
    "Measurement": "axlespan.irregularity.measured",
    "PsdEstimate": "axlespan.irregularity.estimate",
    "Spline": "axlespan.irregularity.spline",
    "estimate_psd": "axlespan.irregularity.estimate",
}


def __getattr__(name: str) -> Any:
    if name in _LATE:
        return getattr(import_module(_LATE[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
