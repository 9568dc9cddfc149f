r"""
A sprung mass crosses a beam
============================

N12's first example: one mass of 5750 kg on a spring crosses a simple span of 25 m at 100 km/h. The
deflection at mid-span is set beside the deflection under the weight alone, moving as a force: the difference is what
interaction makes.
"""

import axlespan as asp

bridge = asp.bridges.simple_span(
    length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=50
)
train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6))
settings = {"time_step": 1e-3, "steps": 1200, "method": asp.Alpha(0.0), "sensors": {"midspan": 12.5}}

with_interaction = asp.simulate(asp.Crossing(bridge, train, speed=100 / 3.6), **settings)
force_alone = asp.simulate(asp.Crossing(bridge, train.as_axle_loads(), speed=100 / 3.6), **settings)

# %%
# Histories are arrays with names; ``at`` picks one.

import matplotlib.pyplot as plt

figure, axes = plt.subplots(figsize=(7, 3.2), layout="constrained")
for result, label in ((with_interaction, "sprung mass"), (force_alone, "moving force")):
    axes.plot(result.time, 1e3 * result.at("sensor_displacement", "midspan"), label=label)
axes.set(xlabel="time [s]", ylabel="deflection at mid-span [mm]")
axes.legend()

# %%
# Every run checks itself: compatibility of wheel and rail, equilibrium of reactions, loads and inertia, energy.

for name, value in with_interaction.checks.items():
    print(f"{name:28s} {value}")
