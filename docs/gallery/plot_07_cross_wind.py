r"""
Cross-wind on left and right wheels
===================================

A car with left and right wheels on two rails, in wind from the left: the moment of the wind goes from the left wheels
to the right ones, and the unevenness of the track comes on top. How much a wheel is unloaded is what safety asks for.
"""

import matplotlib.pyplot as plt

import axlespan as asp

track = asp.bridges.ballasted_track("zhai-2004", rail="60E1")
ground = asp.bridges.track_on_ground(track, 160 * track.spacing, space=True)
car = asp.vehicles.library.vehicle("ice-3d-motor")
wind = asp.vehicles.BodyLoad("body", y=-60e3, height=2.4)
rough = asp.irregularity.realize(
    asp.irregularity.spectrum("german-low"), 300.0, seed=4, wavelengths=(3.0, 70.0)
)

figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
for vehicle, style, label in ((car, "--", "still air"), (car.loaded([wind]), "-", "wind of 60 kN")):
    crossing = asp.Crossing(ground, asp.Train.of(vehicle), speed=200 / 3.6, start=40.0, irregularity=rough)
    result = asp.simulate(crossing, time_step=1e-3, steps=700)
    for wheel, color in (("1.1l", "#0072B2"), ("1.1r", "#D55E00")):
        force = result.at("contact_force", wheel)
        axes.plot(result.time, 1e-3 * force, style, color=color, label=f"{wheel}, {label}", linewidth=1.1)
        print(f"{wheel}, {label:14s} unloading {1.0 - force.min() / car.static_forces()[0]:5.2f}")
axes.axhline(0.0, color="black", linewidth=0.8)
axes.set(xlabel="Time [s]", ylabel="Contact force [kN]", xlim=(0.0, result.time[-1]))
axes.legend(ncols=2)
