r"""
Modes of a skew grid
====================

Natural modes of a structure along its line, and one of them in space.
"""

import axlespan as asp
from axlespan.model.modal import modes_of

bridge = asp.bridges.continuous_beam(
    spans=[18.0, 24.0, 18.0], youngs_modulus=34e9, second_moment=0.42, mass_per_length=9.8e3, elements=12
)
found = modes_of(bridge.system, 6)
asp.plot.line_shapes(bridge, found.modes)
