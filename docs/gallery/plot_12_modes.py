r"""
Modes of a skew deck
====================

Three girders with cross beams, skewed by 30 degrees: its lowest modes along the left track line, and the second one
in space, where the deck twists.
"""

import math

import axlespan as asp
from axlespan.model.modal import modes_of

girder = asp.bridges.GridBeam(second_moment=0.35, torsion_constant=0.04, area=0.7, mass_per_length=2.8e3)
cross_beam = asp.bridges.GridBeam(second_moment=0.06, torsion_constant=0.01, area=0.3, mass_per_length=0.8e3)
bridge = asp.bridges.beam_grid(
    length=24.0,
    girders=[-2.5, 0.0, 2.5],
    girder=girder,
    cross_beam=cross_beam,
    youngs_modulus=34e9,
    elements=24,
    cross_beams=8,
    skew=math.radians(30.0),
    lines={"left": 0.75, "right": -0.75},
)
found = modes_of(bridge.system, 6)
asp.plot.line_shapes(bridge, found.modes, "left")

# %%

ax = asp.plot.space_shape(bridge, found.modes, 1)
ax.view_init(elev=50, azim=-80)
