r"""
Lift-off at a dip
=================

A wheel runs through a short dip of 5 mm. Held to the rail it would have to pull at both shoulders, where the force of
the rigid contact is negative. A unilateral contact parts there and lands without rebound; on Hertz' spring the wheel
rebounds, since nothing under this deck gives way. On a track it would land softly: see the hanging sleepers.
"""

import matplotlib.pyplot as plt

import axlespan as asp

bridge = asp.bridges.simple_span(
    length=20.0, youngs_modulus=34e9, second_moment=0.6, mass_per_length=9e3, elements=40
)
vehicle = asp.vehicles.sprung_mass(mass=8000.0, stiffness=1.6e6, damping=30e3, unsprung_mass=1500.0)
dip = asp.irregularity.SettlementDip(center=8.0, depth=5e-3, inflection=0.17)
crossing = asp.Crossing(bridge, asp.Train.of(vehicle), speed=30.0, start=5.0, irregularity=dip)

figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
for law, style in (("rigid", "--"), ("unilateral", "-"), ("hertz", "-")):
    result = asp.simulate(crossing, time_step=1e-4, steps=1600, contact=law)
    force = 1e-3 * result.contact_force[:, 0]
    axes.plot(result.contact_position[:, 0], force, style, label=law, linewidth=1.2)
    print(f"{law:12s} {force.min():7.1f} to {force.max():6.1f} kN")
axes.axhline(0.0, color="black", linewidth=0.8)
axes.set(xlabel="Position of the wheel [m]", ylabel="Contact force [kN]", xlim=(7.0, 9.5))
axes.legend()
