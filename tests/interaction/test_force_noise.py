"""The indicator of forces that alternate from step to step, and what the defaults do about mesh and method."""

import numpy as np
import pytest

from axlespan.bridges.spans import simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.records.force_noise import NoiseMonitor
from axlespan.interaction.simulate import simulate
from axlespan.model.compile import compile_model
from axlespan.model.damping import Rayleigh
from axlespan.model.from_mesh import Solids
from axlespan.model.materials import Material
from axlespan.model.mesh import Mesh
from axlespan.model.model import Model
from axlespan.running.structure import MAIN_LINE, Structure
from axlespan.running.surface import line_over
from axlespan.vehicles.simple import sprung_mass
from axlespan.vehicles.train import Train

SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
WHEELSET = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=20e3, unsprung_mass=1800.0)
STATIC, SPEED = 7550.0 * 9.81, 300.0 / 3.6


@pytest.mark.parametrize("chunk", [7, 64, 500])
def test_the_indicator_by_hand(chunk):
    """An alternation counts in full, an oscillation by sin⁴(ω Δt / 2), a smooth force not at all; however it is cut."""
    k = np.arange(500)
    theta = 0.9
    series = {
        0: 1.0 + 0.01 * (-1.0) ** k,
        1: 2.0 * (1.0 + 0.3 * np.sin(theta * k)),
        2: 3.0 + 1e-4 * (k / 500) ** 3,
    }
    forces = np.column_stack([*series.values(), np.full(500, 9.0)])
    monitor = NoiseMonitor(np.array([1.0, 2.0, 3.0, 9.0]), np.array([0, 1, 2]))
    for begin in range(0, 500, chunk):
        monitor.look(forces[begin : begin + chunk])
    assert monitor.worst[0] == pytest.approx(0.01, rel=1e-9)
    assert monitor.worst[1] == pytest.approx(0.3 / np.sqrt(2.0) * np.sin(theta / 2) ** 4, rel=0.05)
    assert monitor.worst[2] < 1e-12
    # the worst window, taken at once
    n = np.convolve(forces[:, 1], np.array([1.0, -4.0, 6.0, -4.0, 1.0]) / 16.0, "valid")
    windows = np.lib.stride_tricks.sliding_window_view(n, 32)
    assert monitor.worst[1] == pytest.approx(np.sqrt((windows**2).mean(axis=1).max()) / 2.0, rel=1e-9)


def test_runs_that_ring_are_told_from_clean_ones():
    """Defaults are clean; without numerical damping or footprint the indicator says so."""
    crossing = Crossing(simple_span(elements=50, **SPAN), Train.of(WHEELSET), speed=SPEED, start=-1.0)
    noise = {
        name: simulate(crossing, time_step=1e-3, steps=400, **options).checks["force_noise"]
        for name, options in {
            "default": {},
            "bare": {"footprint": 0.0},
            "undamped": {"method": Alpha(0.0)},
        }.items()
    }
    assert noise["default"] < 0.02
    assert noise["bare"] > 0.2
    assert noise["undamped"] > 1.0


@pytest.mark.parametrize("elements", [20, 50])
def test_a_wheel_does_not_feel_the_mesh_of_a_beam(elements):
    """Defaults, 300 km/h: within 1 % of static of a mesh of 200 elements, from entry to shortly before the exit."""
    runs = [
        simulate(
            Crossing(simple_span(elements=n, **SPAN), Train.of(WHEELSET), speed=SPEED, start=-1.0),
            time_step=1e-3,
            steps=300,
        )
        for n in (elements, 200)
    ]
    apart = np.abs(runs[0].contact_force - runs[1].contact_force).max() / STATIC
    assert apart < 0.01
    assert apart < 1e-3  # in fact


def solid_beam(n):
    """N12's beam of solids, n along it, two across, four high; 1 % of damping."""
    mesh = Mesh.box((25.0, 2.2272, 2.5), (n, 2, 4), origin=(0.0, -1.1136, 0.0))
    concrete = Material(2.87e9, 0.2, 2303.0 / (2.2272 * 2.5))
    model = Model(plane=False).with_mesh(mesh, {"volume": Solids(concrete)})
    x, _, z = model.points.T
    for at, name in ((0.0, "left"), (25.0, "right")):
        nodes = np.flatnonzero((np.abs(x - at) < 1e-9) & (np.abs(z - 1.25) < 1e-9))
        model = model.with_supports(nodes, ("x", "y", "z"), name=name)
    model = model.with_damping(Rayleigh(0.5, 7e-5))
    compiled = compile_model(model)
    path = line_over(model, compiled.table, [(0.0, 0.0, 2.5), (25.0, 0.0, 2.5)])
    return Structure(compiled.system, {MAIN_LINE: path.transformed(compiled.system.elimination)}, model=model)


def test_a_wheel_does_not_feel_the_mesh_of_solids():
    """Elements of 0.25 m at 300 km/h pass with 333 Hz: by default that is below 1 % of the static force."""
    crossing = Crossing(solid_beam(100), Train.of(WHEELSET), speed=SPEED, start=4.0)
    result = simulate(crossing, time_step=5e-4, steps=360)
    assert result.facts["footprint"] == pytest.approx(0.75)
    force = result.contact_force[:, 0] / STATIC
    window = np.hanning(len(force))
    spectrum = 2.0 * np.abs(np.fft.rfft((force - force.mean()) * window)) / window.sum()
    near = np.abs(np.fft.rfftfreq(len(force), 5e-4) - SPEED / 0.25) < 15.0
    assert spectrum[near].max() < 0.01
    short = simulate(crossing, time_step=5e-4, steps=360, footprint=0.25).contact_force[:, 0] / STATIC
    coarse = 2.0 * np.abs(np.fft.rfft((short - short.mean()) * window)) / window.sum()
    assert coarse[near].max() > 3.0 * spectrum[near].max()
