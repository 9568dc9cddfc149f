"""Several trains on one structure: against one train of all vehicles, superposition, mirror images and theory."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.contact.motion import SpeedHistory
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing, OtherTrain
from axlespan.interaction.simulate import simulate, simulate_many
from axlespan.irregularity import Harmonic, Scaled, Table
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.running.line import path_on_beams
from axlespan.running.structure import Structure
from axlespan.vehicles import ContactPoint, Train, Vehicle, axle_loads, rigid_body, rigid_mass, sprung_mass

L, N = 25.0, 12
BRIDGE = asp.bridges.simple_span(
    length=L, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=N
)
F1 = np.pi / (2.0 * L**2) * np.sqrt(2.87e9 * 2.90 / 2303.0)
WAVE = Harmonic(amplitude=0.5e-3, wavelength=5.0)
MASS = sprung_mass(mass=5750.0, stiffness=1.595e6)
CAR = rigid_body(mass=2e4, pitch_inertia=1e5, axles=[0.0, 6.0], stiffness=1e6, damping=1e4, center=2.5)
FORCES = Train.of(axle_loads(loads=[60e3, 80e3, 50e3], positions=[0.0, 3.0, 5.0]))


def twin():
    """Two beams side by side that springs couple: lines ``north`` and ``south``."""
    section = BeamProperties(
        axial_stiffness=1e9, bending_stiffness_y=4e9, bending_stiffness_z=4e9, torsional_stiffness=1e9,
        mass_per_length=2303.0,
    )  # fmt: skip
    x = np.linspace(0.0, L, N + 1)
    points = [[s, 0.0] for s in x] * 2
    model = Model(plane=True).with_nodes(points)
    for first in (0, N + 1):
        model = model.with_beams([[first + i, first + i + 1] for i in range(N)], section)
        model = model.with_support(first, ["x", "z"]).with_support(first + N, ["z"])
    model = model.with_springs([[i, N + 1 + i] for i in range(1, N)], {"z": 2e6})
    compiled = compile_model(model)
    lines = {
        name: path_on_beams(model, compiled.table, range(first, first + N + 1)).transformed(
            compiled.system.elimination
        )
        for name, first in (("north", 0), ("south", N + 1))
    }
    return Structure(compiled.system, lines, model=model)


TWIN = twin()


def run(crossing, steps=1200, time_step=1e-3, **settings):
    return simulate(
        crossing, time_step=time_step, steps=steps, sensors={"quarter": 7.0, "mid": 12.5}, **settings
    )


# --- one train or two --------------------------------------------------------------------------------


def test_two_trains_that_follow_are_one_train():
    together = Train.joined([Train.of(MASS, 2, 3.0), Train.of(CAR), Train.of(MASS)], [4.0, 3.0])
    one = run(Crossing(BRIDGE, together, speed=30.0, irregularity=WAVE))
    other = OtherTrain(train=Train.joined([Train.of(CAR), Train.of(MASS)], [3.0]), speed=30.0, start=-7.0)
    two = run(Crossing(BRIDGE, Train.of(MASS, 2, 3.0), speed=30.0, irregularity=WAVE, others=[other]))
    assert two.contact == one.contact == ("1.1", "2.1", "3.1", "3.2", "4.1")
    assert two.vehicle_dof == one.vehicle_dof
    np.testing.assert_allclose(two.contact_position, one.contact_position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(two.contact_force, one.contact_force, rtol=1e-11)
    np.testing.assert_allclose(two.sensor_displacement, one.sensor_displacement, rtol=0, atol=1e-14)
    np.testing.assert_allclose(two.vehicle_displacement, one.vehicle_displacement, rtol=0, atol=1e-13)


def test_a_delay_is_a_start_further_back():
    delayed = run(Crossing(BRIDGE, Train.of(CAR), speed=30.0, irregularity=WAVE, delay=0.2))
    back = run(Crossing(BRIDGE, Train.of(CAR), speed=30.0, irregularity=WAVE, start=-6.0))
    np.testing.assert_allclose(delayed.contact_force, back.contact_force, rtol=1e-11)


def test_forces_superpose():
    first = {"speed": 30.0, "start": -2.0}
    second = {"speed": 22.0, "acceleration": 3.0, "direction": "backward", "delay": 0.1}
    slow = OtherTrain(train=FORCES, **second)
    both = run(Crossing(BRIDGE, FORCES, others=[slow], **first))
    parts = [run(Crossing(BRIDGE, FORCES, **kind)) for kind in (first, second)]
    total = sum(part.sensor_displacement for part in parts)
    scale = np.abs(total).max()
    np.testing.assert_allclose(both.sensor_displacement, total, rtol=0, atol=1e-10 * scale)
    np.testing.assert_allclose(
        both.support_reaction, sum(part.support_reaction for part in parts), rtol=0, atol=1e-10 * 190e3
    )
    assert "meet on the line 'main'" in "".join(both.facts["notes"])


def mixed_crossing(coupling_structure=BRIDGE):
    """A wavy line, a car that brakes, and sprung masses that come the other way."""
    return Crossing(
        coupling_structure,
        Train.joined([Train.of(CAR), Train.of(axle_loads(loads=5e4))], [3.0]),
        speed=30.0,
        acceleration=-6.0,
        irregularity=WAVE,
        others=[
            OtherTrain(
                train=Train.of(MASS, 3, 4.0),
                speed_history=[[0.0, 15.0], [0.5, 25.0]],
                direction="backward",
                start=22.0,
                irregularity=Scaled(WAVE, 2.0),
            )
        ],
    )


@pytest.mark.parametrize(
    ("coupling", "tolerance"), [("literal", 1e-9), ("refactored", 1e-9), ("iterative", 1e-6)]
)
def test_all_couplings_agree(coupling, tolerance):
    """The literal (A.5) knows nothing of stretches and path columns."""
    crossing = mixed_crossing()
    direct = run(crossing, steps=700, method=asp.Alpha(0.0))
    other = run(crossing, steps=700, method=asp.Alpha(0.0), coupling=coupling)
    assert direct.contact == ("1.1", "1.2", "2.1", "3.1", "4.1", "5.1")
    scale = np.abs(direct.contact_force).max()
    np.testing.assert_allclose(other.contact_force, direct.contact_force, rtol=0, atol=tolerance * scale)


def test_side_by_side_with_other_crossings():
    single = Crossing(BRIDGE, Train.of(MASS), speed=40.0)
    crossings = [single, mixed_crossing(), Crossing(BRIDGE, FORCES, speed=20.0, direction="backward")]
    settings = {"time_step": 1e-3, "steps": 500, "method": asp.Alpha(-0.1)}
    together = simulate_many(crossings, sensors={"quarter": 7.0, "mid": 12.5}, **settings)
    for crossing, result in zip(crossings, together, strict=True):
        alone = run(crossing, **settings)
        assert result.contact == alone.contact
        np.testing.assert_allclose(result.contact_force, alone.contact_force, rtol=1e-7)
        np.testing.assert_allclose(result.sensor_displacement, alone.sensor_displacement, rtol=0, atol=1e-13)


# --- backward ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("train", [FORCES, Train.joined([Train.of(CAR), Train.of(MASS, 2, 3.0)], [3.0])])
def test_a_backward_train_is_the_mirror_image(train):
    x = np.linspace(0.0, L, 11)
    heights = 1e-3 * np.sin(x) * np.sin(np.pi * x / L)
    history = [[0.0, 25.0], [0.4, 35.0]]
    forward = run(Crossing(BRIDGE, train, speed_history=history, irregularity=Table(x, heights), start=-1.0))
    mirrored = Crossing(
        BRIDGE,
        train,
        speed_history=history,
        irregularity=Table(x, heights[::-1]),
        start=L + 1.0,  # at the end of the line, in the kink of the table, slopes have a direction
        direction="backward",
    )
    backward = simulate(mirrored, time_step=1e-3, steps=1200, sensors={"quarter": L - 7.0, "mid": 12.5})
    np.testing.assert_allclose(backward.contact_position, L - forward.contact_position, rtol=0, atol=1e-11)
    np.testing.assert_allclose(backward.contact_force, forward.contact_force, rtol=1e-9)
    np.testing.assert_allclose(backward.sensor_displacement, forward.sensor_displacement, rtol=0, atol=1e-12)
    np.testing.assert_allclose(
        backward.support_reaction, forward.support_reaction[:, [1, 0]], rtol=0, atol=1e-6 * 1e5
    )


def test_trains_that_meet_in_the_middle_deflect_it_symmetrically():
    meeting = Crossing(
        TWIN,
        Train.of(CAR),
        speed=30.0,
        line="north",
        others=[OtherTrain(train=Train.of(CAR), speed=30.0, line="south", direction="backward")],
    )
    result = simulate(meeting, time_step=1e-3, steps=1000, sensors={"a": 6.0, "b": L - 6.0})
    assert result.contact == ("1.1", "1.2", "2.1", "2.2")
    meet = round(12.5 / 30.0 / 1e-3)
    np.testing.assert_allclose(result.contact_position[meet, [0, 2]], 12.5, atol=0.03)
    np.testing.assert_allclose(result.contact_force[:, :2], result.contact_force[:, 2:], rtol=1e-9)


def test_trains_on_two_lines_of_a_symmetric_bridge_feel_the_same_each_alone():
    forces = []
    for line in ("north", "south"):
        crossing = Crossing(TWIN, Train.of(CAR), speed=30.0, line=line, irregularity={line: WAVE})
        forces.append(run(crossing).contact_force)
    np.testing.assert_allclose(forces[0], forces[1], rtol=1e-9)
    assert np.ptp(forces[0]) > 1e4


# --- speeds ------------------------------------------------------------------------------------------


def modal_midspan(places, speeds_end, loads, modes, time_step, steps):
    """Deflection at mid-span by ∫ sin ω(t - τ) f(τ) dτ, each mode advanced exactly for forces linear in a step."""
    t = time_step * np.arange(steps + 1)
    w = np.zeros(steps + 1)
    for n in range(1, modes + 1):
        omega = (n * np.pi / L) ** 2 * np.sqrt(2.87e9 * 2.90 / 2303.0)
        force = np.zeros(steps + 1)
        for place, load in zip(places(t), loads, strict=True):
            on = (place >= 0.0) & (place <= L)
            force -= np.where(on, 2.0 * load / (2303.0 * L) * np.sin(n * np.pi * place / L), 0.0)
        c, s, h = np.cos(omega * time_step), np.sin(omega * time_step), time_step
        q, v = 0.0, 0.0
        for k in range(steps):
            slope = (force[k + 1] - force[k]) / h
            a = q - force[k] / omega**2
            b = (v - slope / omega**2) / omega
            q = a * c + b * s + (force[k] + slope * h) / omega**2
            v = omega * (b * c - a * s) + slope / omega**2
            w[k + 1] += q * np.sin(0.5 * n * np.pi)
    return w


@pytest.mark.parametrize(
    ("speed", "acceleration", "stop"), [(10.0, 8.0, None), (30.0, -9.0, None), (15.0, 10.0, 20.0)]
)
def test_forces_that_change_their_speed(speed, acceleration, stop):
    history = SpeedHistory.accelerating(speed, acceleration, stop)
    steps, dt = 6000, 2.5e-4
    offsets, loads = np.array([0.0, 3.0, 5.0]), [60e3, 80e3, 50e3]
    expected = modal_midspan(lambda t: history.distance(t) - offsets[:, None], None, loads, 5, dt, steps)
    fine = asp.bridges.simple_span(
        length=L, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=32
    )
    crossing = Crossing(fine, FORCES, speed=speed, acceleration=acceleration, to_speed=stop)
    result = simulate(crossing, time_step=dt, steps=steps, sensors={"mid": 12.5})
    # 5 modes and steps of 0.25 ms: within 0.1 % of the largest deflection
    np.testing.assert_allclose(
        result.sensor_displacement[:, 0], expected, rtol=0, atol=1e-3 * np.abs(expected).max()
    )


def test_a_train_brakes_stops_and_stands_in_equilibrium():
    """It comes to rest at v² / 2b; damping brings force and deflection to their static values."""
    bridge = asp.bridges.simple_span(
        length=L, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=N,
        damping=asp.Rayleigh(3.0, 1e-3),
    )  # fmt: skip
    car = rigid_body(mass=2e4, pitch_inertia=1e5, axles=[0.0, 6.0], stiffness=1e6, damping=8e4, center=2.5)
    crossing = Crossing(bridge, Train.of(car), speed=20.0, acceleration=-10.0, start=-2.0)
    result = simulate(crossing, time_step=2e-3, steps=4000, sensors={"mid": 12.5}, method=asp.Alpha(-0.05))
    assert result.contact_position[-1, 0] == pytest.approx(-2.0 + 20.0, rel=1e-13)
    np.testing.assert_allclose(result.contact_force[-1], car.static_forces(), rtol=2e-3)
    ei, weight = 2.87e9 * 2.90, car.static_forces()
    near = np.minimum([18.0, 12.0], L - np.array([18.0, 12.0]))
    sag = np.sum(weight * near * (3.0 * L**2 - 4.0 * near**2)) / (48.0 * ei)
    assert -result.sensor_displacement[-1, 0] == pytest.approx(sag, rel=2e-3)


def free_amplitude(train, speed):
    """Amplitude of the first mode after all forces have left, at mid-span."""
    duration = (L + train.wheelbase) / speed
    steps = int(np.ceil((duration + 1.0 / F1) / 1e-3))
    result = simulate(
        Crossing(BRIDGE, train, speed=speed), time_step=1e-3, steps=steps, sensors={"mid": 12.5}
    )
    after = result.time >= duration
    return np.abs(result.sensor_displacement[after, 0]).max()


@pytest.mark.parametrize("i", [1, 2])
def test_a_force_cancels_itself_where_theory_says(i):
    """Free vibration vanishes at v = 2 f₁ L / (2i + 1) (in the first mode)."""
    force = Train.of(axle_loads(loads=1e5))
    cancel = 2.0 * F1 * L / (2 * i + 1)
    beside = max(free_amplitude(force, factor * cancel) for factor in (0.85, 1.2))
    assert free_amplitude(force, cancel) < 0.06 * beside


@pytest.mark.parametrize("i", [1, 2])
def test_a_train_of_forces_resonates_where_theory_says(i):
    """Free vibration is largest at v = f₁ d / i, and there grows with the number of forces."""
    d = 24.0  # 18 m would be near L = 1.5 d, where a force cancels what resonance adds
    critical = F1 * d / i
    trains = {n: Train.of(axle_loads(loads=1e5), n, d) for n in (1, 8)}
    speeds = critical * np.linspace(0.9, 1.1, 21)
    amplitudes = [free_amplitude(trains[8], speed) for speed in speeds]
    assert speeds[int(np.argmax(amplitudes))] == pytest.approx(critical, rel=0.011)
    assert max(amplitudes) == pytest.approx(8.0 * free_amplitude(trains[1], critical), rel=0.03)


# --- irregularity of lines ---------------------------------------------------------------------------


def test_each_line_has_its_irregularity():
    crossing = Crossing(
        TWIN,
        Train.of(rigid_mass(mass=1e3)),
        speed=20.0,
        line="north",
        irregularity={"north": WAVE, "south": Scaled(WAVE, -2.0)},
        others=[OtherTrain(train=Train.of(rigid_mass(mass=1e3)), speed=20.0, line="south")],
    )
    result = run(crossing, steps=200)
    crossing_even = Crossing(
        TWIN, Train.of(rigid_mass(mass=1e3)), speed=20.0, line="south", irregularity={"north": WAVE}
    )
    assert crossing_even.runs[0].profiles[0].value(1.0) == 0.0
    profiles = [run.profiles[0] for run in crossing.runs]
    assert profiles[1].value(1.0) == pytest.approx(-2.0 * profiles[0].value(1.0))
    assert np.ptp(result.contact_force[:, 1]) > 1.5 * np.ptp(result.contact_force[:, 0])


def test_wheels_of_named_lines_may_run_on_others():
    crossing = Crossing(TWIN, Train.of(MASS), speed=20.0, line={"main": "south"})
    assert crossing.contact_lines == ("south",)
    assert Crossing(TWIN, Train.of(MASS), speed=20.0, irregularity={"main": WAVE}).runs[0].profiles == (WAVE,)


def test_left_wheels_of_a_backward_train_run_on_the_right():
    rails = Structure(
        TWIN.system, {"left": TWIN.lines["north"], "right": TWIN.lines["south"]}, model=TWIN.model
    )
    points = tuple(ContactPoint(side[0], 0.0, None, side, 1e4) for side in ("left", "right"))
    both, single = Train.of(Vehicle(points)), Train.of(Vehicle(points[:1]))
    backward = {"speed": 20.0, "direction": "backward"}
    assert Crossing(rails, both, **backward).contact_lines == ("right", "left")
    assert Crossing(rails, both, speed=20.0).contact_lines == ("left", "right")
    assert Crossing(rails, single, **backward).contact_lines == ("left",)
    assert Crossing(rails, both, line={"left": "left", "right": "right"}, **backward).contact_lines == (
        "left",
        "right",
    )


# --- what cannot be ----------------------------------------------------------------------------------

FAST = {"train": Train.of(MASS), "speed": 40.0}


@pytest.mark.parametrize(
    ("other", "message"),
    [
        ({**FAST, "start": 0.0}, r"others\.0\.start: stands on train 1 at t = 0, on the line 'main'"),
        # 40 t - 10 = 30 t - 3: the last of two masses is 3 m behind the first
        ({**FAST, "start": -10.0}, r"others\.0\.speed: is at the same place as train 1 from t = 0\.7 s on"),
        # 10 t² = 10: from rest behind a train that leaves
        (
            {"train": Train.of(MASS), "speed": 30.0, "acceleration": 20.0, "start": -13.0},
            r"train 1 from t = 1 s on",
        ),
        ({**FAST, "start": -3.0 - 1e-9, "delay": 0.001}, r"from t = 0\.00\d+ s on"),
    ],
)
def test_trains_that_run_into_each_other(other, message):
    crossing = Crossing(BRIDGE, Train.of(MASS, 2, 3.0), speed=30.0, others=[OtherTrain(**other)])
    with pytest.raises(InputError, match=message):
        run(crossing)


@pytest.mark.parametrize(
    ("other", "message"),
    [
        ({**FAST, "line": "nroth"}, "Did you mean 'north'"),
        ({**FAST, "direction": "backwards"}, "Did you mean 'backward'"),
        (
            {**FAST, "line": "south", "start": 200.0},
            r"others\.0 = 'the first wheel runs from 200 .*never brings a wheel",
        ),
        ({**FAST, "to_speed": 50.0}, r"to_speed = 50\.0: needs an acceleration"),
        ({"train": Train.of(MASS), "speed_history": [[0, 20.0]], "acceleration": 1.0}, "goes with speed"),
        ({**FAST, "delay": -1.0}, r"delay = -1\.0: must be zero or positive"),
        ({**FAST, "irregularity": {"east": WAVE}}, "running line"),
    ],
)
def test_trains_that_are_wrong(other, message):
    with pytest.raises(InputError, match=message):
        run(Crossing(TWIN, Train.of(MASS), speed=30.0, others=[OtherTrain(**other)]))


def test_trains_on_two_lines_pass_each_other():
    other = OtherTrain(train=Train.of(MASS), speed=40.0, line="south")
    result = run(Crossing(TWIN, Train.of(MASS), speed=30.0, others=[other]), steps=300)
    assert result.facts["train"] == "sprung mass; sprung mass"


def test_vehicles_within_each_other():
    train = Train((*Train.of(CAR).placements, *(type(p)(CAR, 5.0) for p in Train.of(CAR).placements)))
    with pytest.raises(InputError, match="vehicle 2 begins 5 m behind the first wheel of vehicle 1"):
        run(Crossing(BRIDGE, train, speed=30.0))
