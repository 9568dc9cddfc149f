"""Reduced bases: shapes, frequencies, and crossings in them beside crossings of all d.o.f."""

from __future__ import annotations

import numpy as np
import pytest

import axlespan as asp
from axlespan.dynamics.reduction import reduced_basis
from axlespan.errors import InputError
from axlespan.interaction.reduced.body import resolved_shapes
from axlespan.interaction.simulate import reduce_structure
from axlespan.model.damping import Modal, Rayleigh


def bridge(damping=None, elements=40):
    return asp.bridges.continuous_beam(
        spans=[18.0, 24.0],
        youngs_modulus=34e9,
        second_moment=0.42,
        mass_per_length=9.8e3,
        elements=elements,
        damping=damping,
    )


def train():
    return asp.Train.of(
        asp.vehicles.sprung_mass(mass=30e3, stiffness=2e6, damping=4e4, unsprung_mass=1.5e3), 3, 7.0
    )


def largest(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


def test_shapes_diagonalize_mass_and_stiffness():
    blocks = bridge().system.partition
    basis = reduced_basis(blocks.K_FF, blocks.M_FF, np.arange(0, 160, 9), blocks=2, cutoff=1e-4)
    V, omega = basis.vectors, basis.angular_frequencies
    assert np.abs(V.T @ (blocks.M_FF @ V) - np.eye(basis.size)).max() < 1e-8
    assert np.abs(V.T @ (blocks.K_FF @ V) - np.diag(omega**2)).max() < 1e-8 * omega.max() ** 2


def test_the_lowest_ritz_frequencies_are_those_of_the_model():
    structure = bridge()
    blocks = structure.system.partition
    basis = reduce_structure(structure, blocks=3, cutoff=1e-4)
    exact = np.sqrt(np.linalg.eigvals(np.linalg.solve(blocks.M_FF.toarray(), blocks.K_FF.toarray())).real)
    assert np.allclose(basis.angular_frequencies[:6], np.sort(exact)[:6], rtol=1e-7)


def test_static_deflection_under_a_load_on_the_path_is_exact():
    structure = bridge()
    blocks = structure.system.partition
    row = structure.line().rows(np.array([7.3]), structure.system.size).toarray()[0][structure.system.free]
    basis = reduce_structure(structure, blocks=1, cutoff=1e-7)
    exact = np.linalg.solve(blocks.K_FF.toarray(), row)
    V = basis.vectors
    reduced = V @ ((V.T @ row) / basis.angular_frequencies**2)
    assert np.abs(reduced - exact).max() < 1e-5 * np.abs(exact).max()


@pytest.mark.parametrize(
    "damping", [None, Rayleigh.from_ratio(0.01, (4.0, 20.0)), Modal(0.02)], ids=["none", "rayleigh", "modal"]
)
def test_a_crossing_in_the_basis(damping):
    structure = bridge(damping, elements=120)
    crossing = asp.Crossing(structure, train(), speed=50.0)
    options = {"time_step": 1e-3, "steps": 1200, "sensors": {"first": 9.0, "second": 30.0}}
    full = asp.simulate(crossing, **options)
    reduced = asp.simulate(crossing, **options, basis="reduced")
    assert reduced.facts["basis_size"] < 0.95 * full.facts["structure_dofs"]
    assert largest(reduced.sensor_displacement, full.sensor_displacement) < 1e-4
    assert largest(reduced.contact_force, full.contact_force) < 1e-3
    assert reduced.checks["equilibrium_residual"] < 1e-7
    assert reduced.checks["energy_residual"] < 1e-8
    assert reduced.checks["compatibility_residual"] < 1e-9


def test_the_estimate_tells_the_error_and_a_tolerance_lowers_it():
    structure = bridge(elements=120)
    crossing = asp.Crossing(structure, train(), speed=50.0)
    options = {"time_step": 1e-3, "steps": 1000, "fields": 50}
    full = asp.simulate(crossing, **options)
    poor = asp.simulate(crossing, **options, basis=reduce_structure(structure, blocks=1))
    true = largest(poor.fields.displacement, full.fields.displacement)
    assert true / 5.0 < poor.facts["reduction_error"] < 5.0 * true
    usual = asp.simulate(crossing, **options, basis="reduced")
    true = largest(usual.fields.displacement, full.fields.displacement)
    assert true / 5.0 < usual.facts["reduction_error"] < 5.0 * true
    rich = asp.simulate(crossing, **options, basis="reduced", basis_tolerance=1e-4)
    assert rich.facts["reduction_error"] <= 1e-4


def test_shapes_beyond_the_time_step_follow_at_once():
    """With a long time step only few shapes move; a standing load deflects the bridge as in statics all the same."""
    structure = bridge(elements=60)
    blocks = structure.system.partition
    basis = reduce_structure(structure, blocks=2, cutoff=1e-7)
    resolved = resolved_shapes(basis, 0.01)
    assert 0 < resolved.sum() < basis.size / 2
    assert np.all(basis.angular_frequencies[resolved] < 200.0)  # ω Δt < 2
    loads = asp.Train.of(asp.vehicles.axle_loads(loads=[100e3]))
    crossing = asp.Crossing(structure, loads, speed=0.0, start=7.3)
    result = asp.simulate(crossing, time_step=0.01, steps=50, sensors={"here": 7.3}, basis=basis)
    row = structure.line().rows(np.array([7.3]), structure.system.size).toarray()[0][structure.system.free]
    deflection = -100e3 * row @ np.linalg.solve(blocks.K_FF.toarray(), row)
    assert np.allclose(result.at("sensor_displacement", "here"), deflection, rtol=1e-6)


def test_one_basis_serves_many_crossings_side_by_side():
    structure = bridge()
    basis = reduce_structure(structure)
    crossings = [asp.Crossing(structure, train(), speed=speed) for speed in (30.0, 45.0, 60.0)]
    options = {"time_step": 1e-3, "sensors": {"first": 9.0}, "basis": basis}
    many = asp.simulate_many(crossings, steps=[900, 700, 500], **options)
    for crossing, steps, result in zip(crossings, (900, 700, 500), many, strict=True):
        alone = asp.simulate(crossing, steps=steps, **options)
        assert largest(result.sensor_displacement, alone.sensor_displacement) < 1e-10
        assert largest(result.contact_force, alone.contact_force) < 1e-10


class TestErrors:
    def test_a_basis_of_another_structure(self):
        crossing = asp.Crossing(bridge(), train(), speed=50.0)
        with pytest.raises(InputError, match=r"is of a structure with 99 d\.o\.f\., not 159"):
            asp.simulate(crossing, time_step=1e-3, steps=10, basis=reduce_structure(bridge(elements=25)))

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"basis": "modal"}, "must be full, reduced, or a ReducedBasis"),
            ({"basis": "reduced", "coupling": "iterative"}, "goes with the direct method only"),
            ({"basis": "reduced", "basis_tolerance": 2.0}, "must lie between 0 and 1"),
        ],
    )
    def test_settings(self, options, message):
        crossing = asp.Crossing(bridge(), train(), speed=50.0)
        with pytest.raises(InputError, match=message):
            asp.simulate(crossing, time_step=1e-3, steps=10, **options)

    def test_parameters(self):
        with pytest.raises(InputError, match="blocks = 0: must be at least 1"):
            reduce_structure(bridge(), blocks=0)
        with pytest.raises(InputError, match="must lie between 0 and 1"):
            reduce_structure(bridge(), cutoff=1.0)
