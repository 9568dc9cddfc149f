r"""
Section forces of a continuous bridge
=====================================

Five wagons of line category D4 over three spans: the envelope of the moments over all steps, and the moment over the
first inner support beside that of the first span.
"""

import axlespan as asp

bridge = asp.bridges.continuous_beam(
    spans=[18.0, 24.0, 18.0],
    youngs_modulus=34e9,
    second_moment=0.42,
    mass_per_length=9.8e3,
    elements=24,
    damping=asp.Rayleigh.from_ratio(0.01, (4.0, 16.0)),
)
train = asp.vehicles.load_trains.en15528("d4", count=5)
crossing = asp.Crossing(bridge, train, speed=100 / 3.6)
asp.plot.elevation(crossing)

# %%

result = asp.simulate(
    crossing,
    time_step=2e-3,
    steps=2100,
    sensors={"first span": 7.0, "support": 18.0},
    section_forces=["first span", "support"],
    envelopes=["moment", "shear"],
)
asp.plot.envelope(result, "moment")

# %%

asp.plot.section_force(result, "moment")
