"""Figures: one function per figure, a function of results that draws into matplotlib axes and returns them.

matplotlib is imported here and nowhere else, so that computing does not wait for it. Figures of studies are loaded
when one is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from axlespan.plot.animation import animation
from axlespan.plot.comparison import comparison
from axlespan.plot.contact import contact_force
from axlespan.plot.elevation import elevation
from axlespan.plot.histories import acceleration, displacement, velocity
from axlespan.plot.line_maps import line_map
from axlespan.plot.modes import line_shapes, space_shape
from axlespan.plot.profiles import irregularity, power_spectrum
from axlespan.plot.reactions import reactions
from axlespan.plot.sections import envelope, section_force
from axlespan.plot.spectra import spectrum
from axlespan.plot.standard import draw_figures, save, standard_figures
from axlespan.plot.verdict_bars import verdict_bars

if TYPE_CHECKING:
    from axlespan.plot.study import converging, draw_study, exceedance, over_speed, study_figures

__all__ = [
    "acceleration",
    "animation",
    "comparison",
    "contact_force",
    "converging",
    "displacement",
    "draw_figures",
    "draw_study",
    "elevation",
    "envelope",
    "exceedance",
    "irregularity",
    "line_map",
    "line_shapes",
    "over_speed",
    "power_spectrum",
    "reactions",
    "save",
    "section_force",
    "space_shape",
    "spectrum",
    "standard_figures",
    "study_figures",
    "velocity",
    "verdict_bars",
]

_OF_STUDIES = ("converging", "draw_study", "exceedance", "over_speed", "study_figures")


def __getattr__(name: str) -> Any:
    """Load figures of studies when they are first used."""
    if name in _OF_STUDIES:
        return getattr(import_module("axlespan.plot.study"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
