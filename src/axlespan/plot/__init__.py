"""Figures: functions of results that return matplotlib axes or figures.

matplotlib is imported here and nowhere else, so that computing does not wait for it.
"""

from axlespan.plot.animation import animation
from axlespan.plot.comparison import comparison
from axlespan.plot.contact import contact_force
from axlespan.plot.histories import acceleration, displacement, velocity
from axlespan.plot.reactions import reactions
from axlespan.plot.standard import draw_figures, save, standard_figures

__all__ = [
    "acceleration",
    "animation",
    "comparison",
    "contact_force",
    "displacement",
    "draw_figures",
    "reactions",
    "save",
    "standard_figures",
    "velocity",
]
