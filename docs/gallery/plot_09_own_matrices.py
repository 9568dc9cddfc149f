r"""
Matrices of your own
====================

Any K and M will do as a structure. Here a beam in finite differences, w'' by three points, stands in for what another
program writes; between the points the line of the wheels is linear. Beside it the same beam of finite elements.
"""

import numpy as np
import scipy.sparse as sp

import axlespan as asp
from axlespan.running.path import PolynomialPath

length, stiffness, mass, n = 25.0, 2.87e9 * 2.90, 2303.0, 99  # [m], EI [N m^2], [kg/m], inner points
h = length / (n + 1)
curvature = sp.diags_array([1.0, -2.0, 1.0], offsets=[-1, 0, 1], shape=(n, n)) / h**2
identity = sp.eye_array(n, format="csr")
system = asp.System(
    stiffness=sp.csr_array(stiffness * h * curvature.T @ curvature),
    mass=sp.csr_array(mass * h * identity),
    damping=sp.csr_array((n, n)),
    dof_names=tuple(f"p{i + 1}.z" for i in range(n)),
    elimination=identity,
    prescribed=np.empty(0, dtype=np.int64),
    independent=np.arange(n),
)

# %%
# The line: in segment e between two points the weights are 1 - ξ and ξ; the ends stand still, so that they have none.

left, right = np.arange(-1, n), np.arange(0, n + 1)
dofs = np.column_stack([np.clip(left, 0, n - 1), np.clip(right, 0, n - 1)])
weights = np.zeros((n + 1, 2, 2))
weights[left >= 0, 0] = (1.0, -1.0)
weights[right < n, 1] = (0.0, 1.0)
line = PolynomialPath(np.linspace(0.0, length, n + 2), dofs, weights)
own = asp.Structure(system, {"main": line}, "finite differences")

# %%

import matplotlib.pyplot as plt

elements = asp.bridges.simple_span(
    length=length, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=mass, elements=50
)
train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6))
figure, axes = plt.subplots(figsize=(7.2, 3.2), layout="constrained")
for bridge, style in ((elements, "-"), (own, "--")):
    crossing = asp.Crossing(bridge, train, speed=100 / 3.6)
    result = asp.simulate(crossing, time_step=1e-3, steps=1200, sensors={"midspan": 12.5})
    deflection = 1e3 * result.at("sensor_displacement", "midspan")
    axes.plot(result.time, deflection, style, label=bridge.name)
    print(f"{bridge.name:20s} {deflection.min():.4f} mm")
axes.set(xlabel="Time [s]", ylabel="Displacement at mid-span [mm]")
axes.legend()
