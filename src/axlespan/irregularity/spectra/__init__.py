"""Spectra of irregularities: one file for each family, and all of them by name."""

from axlespan.irregularity.spectra.base import QUANTITIES, Quantity, Spectrum, tabulated
from axlespan.irregularity.spectra.china import china_ballastless, china_short_wave, china_trunk
from axlespan.irregularity.spectra.file import read_spectrum
from axlespan.irregularity.spectra.fra import fra, fra_new
from axlespan.irregularity.spectra.german import german
from axlespan.irregularity.spectra.iso8608 import iso8608, iso8608_class
from axlespan.irregularity.spectra.registry import spectrum, spectrum_names
from axlespan.irregularity.spectra.sncf import sncf

__all__ = [
    "QUANTITIES",
    "Quantity",
    "Spectrum",
    "china_ballastless",
    "china_short_wave",
    "china_trunk",
    "fra",
    "fra_new",
    "german",
    "iso8608",
    "iso8608_class",
    "read_spectrum",
    "sncf",
    "spectrum",
    "spectrum_names",
    "tabulated",
]
