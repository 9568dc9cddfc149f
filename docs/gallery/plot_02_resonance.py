r"""
Resonance under equal axle groups
=================================

Forces at a spacing d excite a bridge of first frequency :math:`f_1` most at the speeds :math:`v_i = f_1 d / i`. Sixty
speeds go side by side over one factorization with ``simulate_many``; the largest deflection is drawn over the speed.
"""

import numpy as np

import axlespan as asp

length, stiffness, mass = 20.0, 2.0e10, 15_000.0  # [m], EI [N m^2], [kg/m]
bridge = asp.bridges.simple_span(
    length=length,
    youngs_modulus=stiffness,
    second_moment=1.0,
    mass_per_length=mass,
    elements=20,
    damping=asp.Rayleigh.from_ratio(0.01, (9.0, 40.0)),
)
frequency = np.pi / 2.0 * np.sqrt(stiffness / mass) / length**2
train = asp.Train.of(asp.vehicles.axle_loads(loads=[170e3]), count=15, spacing=18.0)
speeds = np.linspace(20.0, 100.0, 60)
step = 2e-3
results = asp.simulate_many(
    [asp.Crossing(bridge, train, speed=speed) for speed in speeds],
    time_step=step,
    steps=[int((train.wheelbase + 2.0 * length) / speed / step) for speed in speeds],
    sensors={"midspan": length / 2},
)

# %%
# The peaks stand where the resonance speeds are.

import matplotlib.pyplot as plt

peaks = [1e3 * np.abs(result.at("sensor_displacement", "midspan")).max() for result in results]
figure, axes = plt.subplots(figsize=(7, 3.2), layout="constrained")
axes.plot(3.6 * speeds, peaks)
for i in (1, 2, 3, 4):
    axes.axvline(3.6 * frequency * 18.0 / i, color="0.7", linewidth=0.8, zorder=0)
axes.set(xlabel="speed [km/h]", ylabel="largest deflection [mm]", xlim=(3.6 * speeds[0], 3.6 * speeds[-1]))
