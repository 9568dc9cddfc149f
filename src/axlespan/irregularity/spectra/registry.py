"""Spectra by name."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from axlespan.errors import InputError
from axlespan.irregularity.checks import nearest
from axlespan.irregularity.spectra.base import QUANTITIES, Quantity, Spectrum
from axlespan.irregularity.spectra.china import china_ballastless, china_short_wave, china_trunk
from axlespan.irregularity.spectra.fra import fra, fra_new
from axlespan.irregularity.spectra.german import german
from axlespan.irregularity.spectra.iso8608 import iso8608
from axlespan.irregularity.spectra.sncf import sncf

__all__ = ["spectrum", "spectrum_names"]


def _entries() -> Iterator[tuple[str, Quantity, Callable[[], Spectrum]]]:
    """Name, quantity and how the spectrum is made."""
    for quantity in QUANTITIES:
        for i in range(1, 7):
            yield f"fra-{i}", quantity, partial(fra, i, quantity)
            yield f"fra-new-{i}", quantity, partial(fra_new, i, quantity)
        yield "german-low", quantity, partial(german, "low", quantity)
        yield "german-high", quantity, partial(german, "high", quantity)
        yield "china-ballastless", quantity, partial(china_ballastless, quantity)
        if quantity != "gauge":
            yield "china-trunk-left", quantity, partial(china_trunk, "left", quantity)
            yield "china-trunk-right", quantity, partial(china_trunk, "right", quantity)
    yield "china-short-wave", "vertical", china_short_wave
    yield "sncf-good", "vertical", partial(sncf, "good")
    yield "sncf-poor", "vertical", partial(sncf, "poor")
    for letter in "abcdefgh":
        yield f"iso8608-{letter}", "vertical", partial(iso8608, letter)


_REGISTRY = {(name, quantity): make for name, quantity, make in _entries()}


def spectrum_names(quantity: Quantity | None = None) -> list[str]:
    """Return the names of the spectra in the library, of those for one quantity when it is given.

    Parameters
    ----------
    quantity : {"vertical", "alignment", "cross level", "gauge"}, optional
        What varies; all when left out.
    """
    return sorted({name for name, known in _REGISTRY if quantity in (None, known)})


def spectrum(name: str, quantity: Quantity = "vertical") -> Spectrum:
    """Return a spectrum of the library by its name.

    Parameters
    ----------
    name : str
        As in `spectrum_names`: "german-low", "fra-4", "fra-new-6", "sncf-good", "china-ballastless",
        "iso8608-a", …
    quantity : {"vertical", "alignment", "cross level", "gauge"}
        What varies; road spectra and some others are vertical only.

    Raises
    ------
    InputError
        When the name or the quantity isn't known.

    Examples
    --------
    >>> spectrum("fra-new-6").unit
    'm^2/(rad/m)'
    """
    names = spectrum_names()
    if name not in names:
        hint = nearest(name, names)
        known = f"Known are {', '.join(names)}"
        raise InputError(
            "is not a known spectrum", field="spectrum", value=name, fix=f"{hint} {known}" if hint else known
        )
    quantities = [q for known, q in _REGISTRY if known == name]
    if quantity not in quantities:
        raise InputError(
            f"is not given by the spectrum {name}; it has {', '.join(quantities)}",
            field="quantity",
            value=quantity,
            fix=nearest(quantity, quantities),
        )
    return _REGISTRY[name, quantity]()
