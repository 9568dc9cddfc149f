"""Irregularities: their height along the line, and their spectra."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.irregularity import Profile, Spectrum
from axlespan.plot.style import COLORS, axes_or_new, finish

_POINTS = 4001


def irregularity(
    profile: Profile, begin: float, end: float, *, label: str | None = None, ax: Axes | None = None
) -> Axes:
    """Draw the height of a profile along the line [mm]; up lifts the wheel.

    Parameters
    ----------
    profile : Profile
    begin, end : float
        Positions shown [m].
    label : str, optional
        For a legend.
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If the end does not come after the beginning.
    """
    if not end > begin:
        raise InputError("must come after the beginning", field="end", value=end)
    x = np.linspace(begin, end, _POINTS)
    axes = axes_or_new(ax)
    color = COLORS[len(axes.lines) % len(COLORS)]
    axes.plot(x, 1e3 * np.asarray(profile.value(x)), color=color, label=label)
    return finish(axes, "Position [m]", "Height [mm]", (begin, end))


def power_spectrum(
    spectrum: Spectrum, wavelengths: tuple[float, float], *, label: str | None = None, ax: Axes | None = None
) -> Axes:
    """Draw the one-sided power spectral density of an irregularity over the wavelength, both logarithmic.

    Parameters
    ----------
    spectrum : Spectrum
    wavelengths : (float, float)
        Shortest and longest shown [m].
    label : str, optional
        For a legend; the name of the spectrum when left out.
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If the wavelengths do not increase from above zero.
    """
    shortest, longest = wavelengths
    if not 0.0 < shortest < longest:
        raise InputError("must increase from above zero", field="wavelengths", value=wavelengths)
    length = np.geomspace(shortest, longest, 400)
    axes = axes_or_new(ax)
    color = COLORS[len(axes.lines) % len(COLORS)]
    axes.plot(length, spectrum.psd(1.0 / length), color=color, label=label or spectrum.name)
    finish(axes, "Wavelength [m]", "Power spectral density [m²/(1/m)]", wavelengths)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.autoscale(axis="y")
    return axes
