r"""
Two cars over a ballasted bridge
================================

Rails, sleepers and ballast lie on the bridge and before and behind it; two cars of an ICE 3 run over rails that are
not quite even. The wheels feel the sleepers and the irregularity, the deck the cars.
"""

import axlespan as asp

deck = asp.bridges.simple_span(
    length=24.0,
    youngs_modulus=34e9,
    second_moment=2.0,
    mass_per_length=15e3,
    elements=24,
    damping=asp.Rayleigh.from_ratio(0.01, (6.0, 24.0)),
)
bridge = asp.bridges.with_track(deck, asp.bridges.ballasted_track("zhai-2004", rail="60E1"))
train = asp.vehicles.library.train("ice3-heavy", count=2)
rough = asp.irregularity.realize(
    asp.irregularity.spectrum("german-low"), 400.0, seed=3, wavelengths=(3.0, 80.0)
)
crossing = asp.Crossing(bridge, train, speed=250 / 3.6, start=-15.0, irregularity=rough)
asp.plot.elevation(crossing, head=20.0, window=(-40.0, 40.0))

# %%
# Eight wheels over the bridge. The line is recorded at 49 points of the deck.

result = asp.simulate(crossing, time_step=1e-3, steps=1250, sensors={"midspan": 12.0}, line_points=49)
asp.plot.contact_force(result, "position", span=(0.0, 24.0))

# %%
# The deck under them, at mid-span and all along.

asp.plot.acceleration(result, "midspan")

# %%

asp.plot.line_map(result, "acceleration")
