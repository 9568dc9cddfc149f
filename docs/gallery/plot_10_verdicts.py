r"""
Verdicts by the rules
=====================

HSLM-A5 over a concrete bridge of 20 m at 210 km/h, where its coaches pass at half the bridge's first frequency. The
rules of EN 1990 A2 and EN 1991-2 say how much of each limit is used; which numbers are from memory of the standards,
each verdict's source says.
"""

import axlespan as asp
from axlespan.standards import Assessment, assess, overall

bridge = asp.bridges.simple_span(
    length=20.0,
    youngs_modulus=34e9,
    second_moment=0.75,
    mass_per_length=14e3,
    elements=20,
    damping=asp.Rayleigh.from_ratio(0.01, (6.0, 24.0)),
)
train = asp.vehicles.load_trains.hslm_a(5)
crossing = asp.Crossing(bridge, train, speed=210 / 3.6)
result = asp.simulate(
    crossing, time_step=2e-3, steps=3600, sensors={"midspan": 10.0}, line_points=41, envelopes=["moment"]
)
rules = Assessment(line_speed=250 / 3.6, bridge_type="prestressed-concrete", overhang=0.4)
verdicts = assess(result, crossing, rules)
asp.plot.verdict_bars(verdicts)

# %%

print(overall(verdicts))
for verdict in verdicts:
    if verdict.outcome == "fail":
        print(f"{verdict.clause}: {verdict.quantity} {verdict.value:.3g} {verdict.unit}, {verdict.where}")

# %%
# What is in the acceleration: coaches of 22 m pass 2.65 times a second, and the second multiple of that is the bridge's
# first frequency.

asp.plot.spectrum(result, "midspan", highest=30.0)
