"""Fields at chosen times: the whole structure, supports and ties included, and where the wheels are."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.bridges import SupportAt
from axlespan.elements.beam import BeamProperties
from axlespan.interaction.simulate import simulate_many
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.model.motions import HarmonicMotion
from axlespan.running.line import path_on_beams
from axlespan.running.structure import Structure

BRIDGE = {
    "length": 25.0,
    "youngs_modulus": 2.87e9,
    "second_moment": 2.90,
    "mass_per_length": 2303.0,
    "elements": 10,
}
MASS = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6)
WAVE = asp.irregularity.Harmonic(amplitude=1e-3, wavelength=4.0)


def crossing_of(*vehicles, supports=None, **kwargs):
    structure = asp.bridges.simple_span(**BRIDGE, supports=supports)
    train = asp.Train.of(*(vehicles or (MASS,)), count=2, spacing=3.0)
    return asp.Crossing(structure, train, speed=30.0, **kwargs)


def test_fields_are_what_sensors_see():
    names = {f"n{i + 1}.z": 2.5 * i for i in range(11)}
    result = asp.simulate(
        crossing_of(irregularity=WAVE),
        time_step=1e-3,
        steps=900,
        sensors=names,
        fields=[0.0, 0.1234, 0.5, 0.9],
    )
    fields, rows = result.fields, [0, 123, 500, 900]
    assert fields.times == pytest.approx([0.0, 0.123, 0.5, 0.9])
    vertical = [fields.dof_names.index(name) for name in names]
    assert np.array_equal(fields.displacement[:, vertical], result.sensor_displacement[rows])
    assert np.array_equal(fields.velocity[:, vertical], result.sensor_velocity[rows])
    assert np.array_equal(fields.at("n6.z"), result.sensor_displacement[rows, 5])
    assert np.array_equal(fields.contact_position, result.contact_position[rows])
    assert np.array_equal(fields.contact_force, result.contact_force[rows])
    # massless wheels: the contact point is where the line and the irregularity are
    line = crossing_of().structure.line()
    for i, position in enumerate(fields.contact_position):
        under = line.rows(position, 22) @ fields.displacement[i] + WAVE.value(position)
        assert fields.contact_displacement[i] == pytest.approx(under, abs=1e-12)
    with pytest.raises(asp.InputError, match=r"dof = 'n12.z': is not a d\.o\.f\."):
        fields.at("n12.z")


def test_at_every_so_many_steps_and_side_by_side():
    first, second = crossing_of(), crossing_of(irregularity=WAVE)
    second = asp.Crossing(first.structure, second.train, speed=40.0, irregularity=WAVE)
    kwargs = {"time_step": 1e-3, "fields": 150}
    both = simulate_many([first, second], steps=[600, 450], **kwargs)
    assert both[0].fields.times == pytest.approx([0.0, 0.15, 0.3, 0.45, 0.6])
    assert both[1].fields.times == pytest.approx([0.0, 0.15, 0.3, 0.45])
    alone = asp.simulate(second, steps=450, **kwargs)
    scale = np.abs(alone.fields.velocity).max()
    assert np.abs(both[1].fields.velocity - alone.fields.velocity).max() < 1e-9 * scale


def test_supports_that_move_and_moving_forces():
    motion = HarmonicMotion(2e-3, 3.0)
    supports = [SupportAt(0.0, (), motion={"z": motion}), SupportAt(25.0)]
    result = asp.simulate(
        crossing_of(asp.vehicles.axle_loads(loads=[1e5], positions=[0.0]), supports=supports),
        time_step=1e-3,
        steps=700,
        fields=100,
        sensors={"start": 0.0},
    )
    fields = result.fields
    assert fields.at("n1.z") == pytest.approx(2e-3 * np.sin(2 * np.pi * 3.0 * fields.times), abs=1e-15)
    velocity = fields.velocity[:, fields.dof_names.index("n1.z")]
    assert velocity == pytest.approx(2e-3 * 6 * np.pi * np.cos(6 * np.pi * fields.times), rel=1e-12)
    # a moving force goes with the line, on it and off it
    line = crossing_of().structure.line()
    for i, position in enumerate(fields.contact_position):
        under = line.rows(position, 22) @ fields.displacement[i]
        assert fields.contact_displacement[i] == pytest.approx(under, abs=1e-15)


def test_tied_nodes_follow():
    x = np.linspace(0.0, 10.0, 5)
    beam = BeamProperties(axial_stiffness=1e9, bending_stiffness_y=2e8, mass_per_length=1e3)
    model = Model(plane=True).with_nodes(np.column_stack([x, 0 * x])).with_nodes([[0.0, -0.5], [10.0, -0.5]])
    model = model.with_beams(np.column_stack([np.arange(4), np.arange(1, 5)]), beam)
    model = model.with_rigid_link(5, [0]).with_rigid_link(6, [4])
    model = model.with_support(5, ("x", "z")).with_support(6, ("z",))
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, range(5)).transformed(compiled.system.elimination)
    structure = Structure(compiled.system, {"main": path}, model=model)
    crossing = asp.Crossing(structure, asp.Train.of(MASS), speed=20.0)
    fields = asp.simulate(crossing, time_step=1e-3, steps=300, fields=[0.2, 0.3]).fields
    turn = fields.at("n7.ry")
    assert np.all(np.abs(turn) > 1e-6)
    assert fields.at("n5.ry") == pytest.approx(turn)
    assert fields.at("n5.x") == pytest.approx(fields.at("n7.x") + 0.5 * turn)


def test_a_run_that_fails_keeps_the_fields_before():
    heavy = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, unsprung_mass=500.0)
    crossing = asp.Crossing(asp.bridges.simple_span(**BRIDGE), asp.Train.of(heavy), speed=20.0)
    with pytest.raises(asp.AnalysisError) as caught:
        asp.simulate(
            crossing,
            time_step=1e-3,
            steps=5000,
            coupling="iterative",
            iteration=asp.Iteration(limit=3),
            fields=1,
        )
    result = caught.value.result
    completed = result.facts["completed_steps"]
    assert len(result.fields.times) == completed + 1 < 5000
    assert np.all(np.isfinite(result.fields.displacement))


@pytest.mark.parametrize(
    ("fields", "match"),
    [
        ([0.1, 2.0], r"fields.1 = 2.0: must be within the time that is simulated, 0.9 s"),
        ([float("nan")], r"fields.0 = nan: must be within"),
        (0, r"fields = 0: must be a whole number of at least 1"),
        (2.5, r"fields = 2.5: must be a whole number"),
        (True, r"fields = True: must be a whole number"),
    ],
)
def test_wrong_times(fields, match):
    with pytest.raises(asp.InputError, match=match):
        asp.simulate(crossing_of(), time_step=1e-3, steps=900, fields=fields)


def test_none_asked_for():
    result = asp.simulate(crossing_of(), time_step=1e-3, steps=10)
    assert result.fields is None and result.envelopes is None
    assert result.section == () and result.section_moment.shape == (11, 0)
