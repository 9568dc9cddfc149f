"""Flats, waves and patches of the wheels of a case: only those wheels feel them, once in every turn."""

import numpy as np
import pytest

import axlespan as asp
from axlespan import irregularity as ir
from axlespan.errors import InputError
from axlespan.study import read_case
from axlespan.study.build import build

CASE = """\
structure: {kind: simple-span, length: 10 m, youngs_modulus: 34 GPa, second_moment: 0.9 m^4, mass_per_length: 12 t/m, elements: 8}
train:
  - {vehicle: rigid-mass, mass: 5 t, count: 2, spacing: 3 m}
  - {vehicle: sprung-mass, mass: 5 t, stiffness: 1 MN/m, damping: 20 kNs/m, unsprung_mass: 1 t, gap: 3 mOWN}
crossing: {speed: 20, start: -60 m, irregularity: IRREGULARITY}
analysis: {time_step: 1 ms, duration: 3.5 s}
"""
RADIUS, SPEED = 0.46, 20.0


def built(own="", irregularity="none", **others):
    text = CASE.replace("OWN", f", {own}" if own else "").replace("IRREGULARITY", irregularity)
    for old, new in others.items():
        text = text.replace(old.replace("_", " "), new)
    return build(read_case(text))


def test_out_of_round_on_level_ground():
    """Before the bridge, F = m (g + v² r'') of a mass on rigid ground; the others stand as if nothing were."""
    text = CASE.replace("OWN", "").replace("IRREGULARITY", "none")
    own = "out_of_round: {amplitude: 0.1 mm, order: 3, radius: 460 mm, wheels: [2.1], phase: 30 deg}"
    text = text.replace("spacing: 3 m}", f"spacing: 3 m, {own}}}")
    result = asp.simulate(build(read_case(text)).crossing, time_step=1e-3, steps=3000)
    before = result.time < 2.5
    force, x = result.contact_force[before], result.contact_position[before]
    force, x = 0.5 * (force[1:] + force[:-1]), 0.5 * (x[1:] + x[:-1])  # the start rings from step to step
    k = 3.0 / RADIUS
    curvature = -1e-4 * k**2 * np.sin(k * x[:, 1] + np.pi / 6)
    assert force[:, 0] == pytest.approx(5e3 * 9.81, rel=1e-9)
    assert force[:, 2] == pytest.approx(6e3 * 9.81, rel=1e-9)
    dynamic = 5e3 * SPEED**2 * curvature
    assert np.abs(dynamic).max() > 8e3
    assert force[:, 1] == pytest.approx(5e3 * 9.81 + dynamic, abs=0.01 * np.abs(dynamic).max())


def test_a_flat_strikes_at_the_frequency_of_revolution():
    """The force of that wheel alone has lines at multiples of v / (2πR), and the first blow is where it is said."""
    own = "wheel_flat: {depth: 0.5 mm, length: 200 mm, shape: rounded, wheels: [3.1], radius: 460 mm, at: -40 m}"
    options = {"time_step": 1e-3, "steps": 3000, "method": asp.Alpha(-0.2)}
    result = asp.simulate(built(own).crossing, **options)
    even = asp.simulate(built().crossing, **options)
    before = result.time < 2.8
    force, x = result.contact_force[before, 2], result.contact_position[before, 2]
    assert np.array_equal(result.contact_force[before, :2], even.contact_force[before, :2])
    revolution = SPEED / (2.0 * np.pi * RADIUS)
    count = int(19.0 / revolution / 1e-3)  # 19 turns
    power = np.abs(np.fft.rfft(force[-count:] - force[-count:].mean())) ** 2
    n = np.fft.rfftfreq(count, 1e-3)
    low = n < 200.0  # above, jumps of the curvature ring
    n, power = n[low], power[low]
    multiples = np.abs(n / revolution - np.round(n / revolution)) * revolution < 1.5 / (count * 1e-3)
    assert power[multiples].sum() > 0.97 * power.sum()
    near = (n > 0.7 * revolution) & (n < 1.5 * revolution)  # the car on its spring is at 2.3 Hz
    assert n[near][np.argmax(power[near])] == pytest.approx(revolution, abs=0.5 / (count * 1e-3))
    # the peaks come from the flat, 0.2 m long and at -40 m plus whole turns
    at = np.flatnonzero(np.abs(force - force.mean()) > 0.5 * np.ptp(force) * 0.6)
    turn = 2.0 * np.pi * RADIUS
    away = np.abs((x[at] + 40.0 + 0.5 * turn) % turn - 0.5 * turn)
    assert len(at) > 10
    assert away.max() < 0.2  # half of the flat, and the ringing of five steps; half a turn is 1.4 m


def test_profiles_of_wheels():
    """A flat by its length, one by its depth, several at once, all wheels of an entry; beside the surface."""
    own = "wheel_flat: [{length: 50 mm, radius: 0.46}, {length: 60 mm, radius: 0.46, depth: 0.4 mm, at: 1 m}]"
    run = built(own, "{kind: bump, at: 3 m, height: 5 mm, length: 2 m}").crossing.runs[0]
    x = np.linspace(-10.0, 10.0, 4001)
    bump = ir.Bump(3.0, 5e-3, 2.0)
    flats = ir.WheelFlat(0.05, RADIUS), ir.WheelFlat(0.06, RADIUS, 4e-4, position=1.0)
    assert np.array_equal(run.profiles[0].value(x), bump.value(x))
    assert run.profiles[0] is run.profiles[1]
    assert run.profiles[2].value(x) == pytest.approx(ir.Sum((bump, *flats)).value(x), abs=1e-15)
    assert np.array_equal(run.surfaces[2].value(x), bump.value(x))


def test_a_patch_feels_the_mean():
    case = built(
        "contact_patch: 0.24 m", "{kind: pothole, at: -20 m, depth: 30 mm, length: 1 m, edge: 100 mm}"
    )
    hole = ir.Pothole(-20.0, 0.03, 1.0, 0.1)
    x = np.linspace(-22.0, -18.0, 801)
    point, mean = (case.crossing.runs[0].profiles[i].value(x) for i in (0, 2))
    fine = np.mean([hole.value(x + s) for s in 0.24 * ((np.arange(1000) + 0.5) / 1000 - 0.5)], axis=0)
    assert np.array_equal(point, hole.value(x))
    assert mean == pytest.approx(fine, abs=1e-6)
    force = asp.simulate(case.crossing, time_step=1e-3, steps=3400).contact_force[:, 2]
    rough = built("", "{kind: pothole, at: -20 m, depth: 30 mm, length: 1 m, edge: 100 mm}").crossing
    assert np.ptp(force) < 0.8 * np.ptp(asp.simulate(rough, time_step=1e-3, steps=3400).contact_force[:, 2])


def test_python_is_the_same():
    own = "wheel_flat: {length: 50 mm, radius: 0.46, at: 2 m}"
    crossing = built(own).crossing
    even = built().crossing
    train = even.train.with_wheels(["3.1"], profile=ir.WheelFlat(0.05, RADIUS, position=2.0))
    wanted = asp.Crossing(even.structure, train, speed=20.0, start=-60.0)
    runs = (asp.simulate(one, time_step=1e-3, steps=3200) for one in (crossing, wanted))
    first, second = (run.contact_force for run in runs)
    assert np.array_equal(first, second)
    with pytest.raises(InputError, match="is not a known wheel"):
        train.with_wheels(["9.1"], profile=ir.WheelFlat(0.05, RADIUS))


def test_wheels_of_another_train_count_on():
    other = """\
other_trains:
  - {train: [{vehicle: rigid-mass, mass: 5 t, wheel_flat: {length: 50 mm, radius: 0.46, wheels: [4.1]}}],
     speed: 20, start: -69.5 m}
"""
    text = CASE.replace("OWN", "").replace("IRREGULARITY", "none") + other
    runs = build(read_case(text)).crossing.runs
    assert isinstance(runs[1].profiles[0], ir.WheelFlat)
    with pytest.raises(InputError) as caught:
        build(read_case(text.replace("4.1", "1.1")))
    assert str(caught.value) == (
        "case.yaml:8:98: other_trains.0.train.0.wheel_flat.wheels.0 = 1.1: no such wheel. "
        "Those of this entry are 4.1"
    )


def test_the_switch_to_axle_loads_is_believed():
    own = "wheel_flat: {length: 50 mm, radius: 0.46}"
    made = built(own, **{"duration:_3.5_s": "duration: 3.5 s, vehicles: axle-loads"})
    assert all(item.vehicle.is_force for item in made.crossing.train.placements)


@pytest.mark.parametrize(
    ("own", "said"),
    [
        (
            "wheel_flat: {length: 50 mm}",
            "train.1.wheel_flat.radius: is missing: the vehicle does not know it. Add radius: 460 mm",
        ),
        (
            "wheel_flat: {radius: 460 mm}",
            "train.1.wheel_flat.length: is missing. Add length: 50 mm, or depth: 0.5 mm",
        ),
        (
            "wheel_flat: {length: 0.45 m, radius: 0.12}",
            "train.1.wheel_flat.length = 0.45 m: must be less than half the circumference, 0.376991 m",
        ),
        (
            "out_of_round: {amplitude: 1 mm, order: 3, radius: 0.46, wheels: 3.1}",
            "train.1.out_of_round.wheels = 3.1: must be all, or a list of wheels. "
            "Write [1.1, 1.3], as contacts are named",
        ),
        (
            "out_of_round: {amplitude: 1 mm, order: 3, radius: 0.46, wheels: [3.10]}",
            "train.1.out_of_round.wheels.0 = 3.10: no such wheel. Did you mean 3.1? Those of this entry are 3.1",
        ),
        ("contact_patch: 0", "train.1.contact_patch = 0: must be positive. Write, for example, 25 m"),
    ],
)
def test_wrong_wheels(own, said):
    with pytest.raises(InputError) as caught:
        built(own)
    place, _, rest = str(caught.value).partition(": ")
    assert place.startswith("case.yaml:4:")
    assert rest == said


def test_forces_feel_no_surface():
    with pytest.raises(
        InputError, match=r"train\.0\.contact_patch = 24 cm: has no effect: these are moving forces"
    ):
        built(**{"rigid-mass,_mass:_5_t": "axle-loads, loads: 50 kN, contact_patch: 24 cm"})


def test_steps_that_pass_over_a_flat():
    """20 m/s and 1 ms are 20 mm a step: five of them on a flat of 100 mm are enough, two of 40 mm are not."""
    flat = "wheel_flat: {length: 100 mm, radius: 0.46, wheels: [3.1]}"
    assert built(flat).cautions == ()
    squat = "{kind: squat, at: 3 m, depth: 0.3 mm, length: 60 mm}"
    assert built(flat.replace("100", "40"), squat).cautions == (
        "a wheel moves 20 mm in a time step, too much to see a wheel flat of 40 mm; 0.0002 s would show it",
        "a wheel moves 20 mm in a time step, too much to see a squat of 60 mm; 0.0003 s would show it",
    )
    patch = built("contact_patch: 0.2 m", squat, **{"rigid-mass,_mass:_5_t": "axle-loads, loads: 50 kN"})
    assert patch.cautions == ()


WAGON = """\
title: Wagon
sources: {sheet: Data sheet}
source: sheet
bodies: [{name: body, mass: 28 t, inertia: 300 t m^2, position: 3.25 m}]
wheels: [{mass: 1.3 t, radius: 0.46 m, positions: [0 m, 6.5 m]}]
suspensions: [{between: [[body, wheel1], [body, wheel2]], stiffness: 2.4 MN/m, damping: 30 kNs/m}]
stated: {total_mass: 30.6 t, axle_loads: 150.1 kN, frequencies: [2.1 Hz], tolerance: 1 %}
"""


def test_a_vehicle_file_that_contradicts_itself(tmp_path):
    """Its mass is 28 + 2 · 1.3 t, f = √(2 · 2.4e6 / 28e3) / 2π; what it states otherwise is told in the run."""
    case = CASE.replace("IRREGULARITY", "none").replace("OWN", "")
    case = case.replace(
        "vehicle: rigid-mass, mass: 5 t, count: 2, spacing: 3 m",
        "vehicle: wagon.yaml, wheel_flat: {length: 90 mm}",
    )
    (tmp_path / "wagon.yaml").write_text(WAGON, encoding="utf-8")
    made = build(read_case(case, folder=tmp_path))
    assert made.cautions == ()
    assert made.crossing.runs[0].profiles[0].wheel_radius == 0.46
    wrong = WAGON.replace("30.6 t", "33 t").replace("150.1", "160").replace("2.1 Hz", "3.3 Hz")
    (tmp_path / "wagon.yaml").write_text(wrong, encoding="utf-8")
    place = "case.yaml:3:15: train.0.vehicle = wagon.yaml: "
    fix = ". Correct the one or the other"
    assert build(read_case(case, folder=tmp_path)).cautions == (
        f"{place}states a total mass of 33 t, but its parts have 30.6 t{fix}",
        f"{place}states 160 kN on axle 1, but its parts put 150.1 kN there{fix}",
        f"{place}states a frequency of 3.3 Hz, but the nearest that it has is 2.084 Hz{fix}",
    )
