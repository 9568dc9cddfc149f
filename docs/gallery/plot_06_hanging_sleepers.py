r"""
Hanging sleepers
================

Three sleepers stand off the ballast by 1 mm while nothing is loaded, as behind many bridges. Ballast only pushes, so
the run is nonlinear: the rails carry the wheels over the gaps until these close.
"""

import matplotlib.pyplot as plt
import numpy as np

import axlespan as asp

track = asp.bridges.ballasted_track("zhai-2004", rail="60E1")
spacing = track.spacing
sound = asp.bridges.track_on_ground(track, 90 * spacing)
hanging = [((i + 0.5) * spacing, 1e-3) for i in (44, 45, 46)]
worn = asp.bridges.with_unilateral_springs(sound, "ballast", hanging=hanging)

train = asp.Train.of(asp.vehicles.library.vehicle("ice3-heavy"))
middle = 45.5 * spacing
figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
for ground, label in ((sound, "sound ballast"), (worn, "three hanging sleepers")):
    crossing = asp.Crossing(ground, train, speed=160 / 3.6, start=33 * spacing)
    result = asp.simulate(crossing, time_step=1e-3, steps=350, sensors={"middle": middle})
    axes.plot(result.contact_position[:, 0], 1e-3 * result.contact_force[:, 0], label=label, linewidth=1.2)
    print(f"{label:24s} rail deflects by {-1e3 * result.at('sensor_displacement', 'middle').min():.2f} mm")
for position, _ in hanging:
    axes.axvline(position, color="0.7", linewidth=0.8, zorder=0)
window = np.array([36, 58]) * spacing
axes.set(xlabel="Position of the first wheel [m]", ylabel="Contact force [kN]", xlim=window)
axes.legend()
