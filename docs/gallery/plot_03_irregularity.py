r"""
Track irregularity from a spectrum
==================================

A seeded realization of the German spectrum for low disturbance, and how much of it lies in each band of wavelengths.
"""

import matplotlib.pyplot as plt
import numpy as np

import axlespan as asp

shape = asp.irregularity.spectrum("german-low")
profile = asp.irregularity.realize(shape, 2000.0, seed=1, wavelengths=(3.0, 150.0))
x = np.linspace(0.0, 400.0, 4001)

figure, axes = plt.subplots(figsize=(7, 2.8), layout="constrained")
axes.plot(x, 1e3 * profile.value(x))
axes.set(xlabel="position [m]", ylabel="height [mm]")

# %%
# The same seed gives the same profile, here and everywhere.

again = asp.irregularity.realize(shape, 2000.0, seed=1, wavelengths=(3.0, 150.0))
print(np.array_equal(profile.value(x), again.value(x)))
