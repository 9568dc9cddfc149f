"""Steps that are cut where they do not converge: against runs with the smaller time step from the start."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.bridges import SupportAt, ballasted_track, track_on_ground
from axlespan.bridges.spring_laws import with_spring_law
from axlespan.contact.laws import Hertz, LinearSpring
from axlespan.dynamics import integrator
from axlespan.errors import AnalysisError, InputError, Outcome
from axlespan.interaction.convoy import Lane
from axlespan.interaction.drive import drive
from axlespan.interaction.groundwork import prepare
from axlespan.interaction.nonlinear.contact import NonlinearCoupling, StepNotConverged
from axlespan.interaction.nonlinear.march import begin_nonlinear, watch, with_cutting
from axlespan.interaction.plan import plan_for
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.settings import settings_for
from axlespan.interaction.start import StartFactors
from axlespan.io.summary import summary, summary_lines
from axlespan.model.motions import HarmonicMotion
from axlespan.model.nonlinear import BilinearHysteresis
from axlespan.model.nonlinear_elements import with_nonlinear_element
from axlespan.vehicles.nonlinear import with_nonlinear_spring

DT = 1e-3
CAR = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, damping=20e3, unsprung_mass=800.0)
RESPONSES = (
    "contact_force",
    "vehicle_displacement",
    "vehicle_velocity",
    "vehicle_acceleration",
    "sensor_displacement",
    "sensor_velocity",
    "sensor_acceleration",
    "support_reaction",
    "section_moment",
    "section_shear",
)


def waves(amplitude, wavelength=6.0):
    return asp.irregularity.Harmonic(amplitude=amplitude, wavelength=wavelength)


def bridge(*, moved=False):
    supports = [SupportAt(0.0, ("z",), name="left"), SupportAt(25.0, ("z",), name="right")]
    if moved:
        supports[0] = SupportAt(0.0, (), motion={"z": HarmonicMotion(2e-3, 3.0)}, name="left")
    return asp.bridges.simple_span(
        length=25.0,
        youngs_modulus=2.87e9,
        second_moment=2.90,
        mass_per_length=2303.0,
        elements=8,
        damping=asp.Rayleigh(0.5, 1e-4),
        supports=supports,
    )


def run(crossing, *, time_step, steps, cuts=4, **options):
    """A run in which every step is made by the coupling itself, none in a compiled loop."""
    settings = settings_for(crossing, time_step=time_step, steps=steps, cuts=cuts, **options)
    plan = plan_for(crossing, settings)
    start, coupling = begin_nonlinear(plan, StartFactors(plan))
    recorder = Recorder(plan)
    watch(coupling, recorder)
    lane = Lane.at_start(plan, start, recorder)
    drive([lane], prepare([plan]), with_cutting(coupling, recorder))
    if lane.error is not None:
        raise lane.error
    return recorder.result(Outcome("completed", ""), {})


@pytest.fixture
def stubborn(monkeypatch):
    """Have steps fail: ``fails(parts, step, part)`` says which, of how many parts and which of them (0, 1, ...)."""
    plain = NonlinearCoupling.__call__

    def begin(time_step, fails):
        def call(self, convoy, stretch, k, external):
            index = stretch.first + k - 1
            parts = round(time_step / self.time_step)
            if fails(parts, index // parts + 1, index % parts):
                raise StepNotConverged("", "spring pads.7", 1.0, 5)
            return plain(self, convoy, stretch, k, external)

        monkeypatch.setattr(NonlinearCoupling, "__call__", call)

    yield begin


def close(a, b, tolerance, names=RESPONSES):
    for name in names:
        own, other = getattr(a, name), getattr(b, name)
        if own.size:
            assert np.abs(own - other).max() <= tolerance * np.abs(other).max(), name


# --- every step cut is a run with the smaller step ---------------------------------------------------------

SECTIONS = {"sensors": {"a": 0.0, "m": 12.5}, "section_forces": ["a", "m"]}
BUMPY = asp.Crossing(
    bridge(moved=True), asp.Train.of(CAR, 2, 4.0), speed=40.0, start=-1.0, irregularity=waves(3e-3)
)
PLAY = with_spring_law(track_on_ground(ballasted_track(), 36.0), "pads", BilinearHysteresis(1.2e8, 2e3, 2e7))
CASES = {
    "hertz": (BUMPY, {"contact": Hertz(radius=0.46), **SECTIONS}),
    "tyre with a dashpot": (BUMPY, {"contact": LinearSpring(2e7, 1e4), **SECTIONS}),
    "unilateral": (BUMPY, {"contact": "unilateral", **SECTIONS}),
    "friction": (
        asp.Crossing(
            bridge(),
            asp.Train.of(
                with_nonlinear_spring(
                    CAR, BilinearHysteresis(5e6, 3e3), {"body.z": 1.0, "wheel1.z": -1.0}, name="friction"
                )
            ),
            speed=40.0,
            irregularity=waves(3e-3),
        ),
        SECTIONS,
    ),
    "pads that slide": (
        asp.Crossing(PLAY, asp.Train.of(CAR), speed=40.0, start=16.0),
        {"sensors": {"m": 18.0}},
    ),
    "moving forces": (
        asp.Crossing(PLAY, asp.Train.of(asp.vehicles.axle_loads(loads=9e4)), speed=40.0, start=16.0),
        {"sensors": {"m": 18.0}},
    ),
}


@pytest.mark.parametrize("cuts", [1, 2])
@pytest.mark.parametrize("case", CASES)
def test_every_step_cut_is_a_run_with_the_smaller_step(stubborn, case, cuts):
    """To rounding, accelerations too; and the checks hold inside the parts."""
    crossing, options = CASES[case]
    options = {"method": asp.Alpha(-0.1), **options}
    parts, steps = 2**cuts, 60
    fine = run(crossing, time_step=DT / parts, steps=steps * parts, every=parts, **options)
    stubborn(DT, lambda n, step, part: n < parts)
    own = run(crossing, time_step=DT, steps=steps, **options)
    assert own.facts["cut_steps"] == steps
    assert own.facts["smallest_time_step"] == DT / parts
    np.testing.assert_array_equal(own.facts["parts_of_steps"], parts)
    close(own, fine, 1e-9)
    for check in ("equilibrium_residual", "energy_residual", "compatibility_residual"):
        assert own.checks[check] < 1e-11, check
    assert own.checks["energy_residual"] > 0.0  # parts are balanced
    assert own.checks["flight_count"] == fine.checks["flight_count"]


def test_without_numerical_damping(stubborn):
    crossing, options = CASES["hertz"]
    options = {"method": asp.Alpha(0.0), **options}
    fine = run(crossing, time_step=DT / 2, steps=120, every=2, **options)
    stubborn(DT, lambda n, step, part: n < 2)
    close(run(crossing, time_step=DT, steps=60, **options), fine, 1e-9)


# --- some steps cut ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("contact", ["unilateral", LinearSpring(2e7, 1e4), Hertz(radius=0.46)])
def test_checks_hold_where_some_steps_are_cut_and_wheels_fly(stubborn, contact):
    """Steps of 1, 2, 4 and 8 parts by chance, that fail in any part; landings and lift-offs inside."""
    rng = np.random.default_rng(11)
    levels, part_of_failure = rng.choice([0, 0, 1, 2, 3], size=601), rng.random(601)
    crossing = asp.Crossing(
        bridge(moved=True), asp.Train.of(CAR, 2, 4.0), speed=60.0, irregularity=waves(8e-3, 3.0)
    )
    stubborn(5e-4, lambda n, step, part: n < 2 ** levels[step] and part == int(part_of_failure[step] * n))
    result = run(
        crossing,
        time_step=5e-4,
        steps=600,
        contact=contact,
        method=asp.Alpha(-0.1),
        sensors={"a": 0.0, "b": 25.0},
        section_forces=["a", "b"],
        envelopes=["shear"],
    )
    assert result.facts["cut_steps"] == np.count_nonzero(levels[1:])
    np.testing.assert_array_equal(
        result.facts["parts_of_steps"], 2 ** levels[1 : levels.nonzero()[0][-1] + 1]
    )
    assert result.checks["flight_count"] >= 10
    starts = np.array([flight["start"] for flight in result.checks["flights"]])
    assert np.any(np.abs(starts / 5e-4 - np.round(starts / 5e-4)) > 0.1)  # inside steps, too
    assert result.contact_force.min() == 0.0
    for check in ("equilibrium_residual", "energy_residual", "compatibility_residual"):
        assert result.checks[check] < 1e-11, check
    # The shear at the supports is their reaction, through cuts, landings and lift-offs.
    left, right = result.at("support_reaction", "left.z"), result.at("support_reaction", "right.z")
    off = 1e-9 * np.abs(left).max()
    np.testing.assert_allclose(result.at("section_shear", "a"), left, rtol=0.0, atol=off)
    np.testing.assert_allclose(result.at("section_shear", "b"), -right, rtol=0.0, atol=off)


def test_cut_steps_lie_between_the_two_runs(stubborn):
    """Half of the steps cut in two: nearer to the fine run than the whole steps are."""
    crossing, options = CASES["tyre with a dashpot"]
    options = {"method": asp.Alpha(-0.1), **options}
    whole = run(crossing, time_step=DT, steps=240, **options)
    fine = run(crossing, time_step=DT / 8, steps=1920, every=8, **options)
    stubborn(DT, lambda n, step, part: n == 1 and step % 2)
    own = run(crossing, time_step=DT, steps=240, **options)
    for name in ("contact_force", "vehicle_displacement", "sensor_displacement"):
        exact = getattr(fine, name)
        errors = [np.abs(getattr(one, name) - exact).max() for one in (own, whole)]
        assert errors[0] < errors[1] < 0.02 * np.abs(exact).max(), name


def test_factors_are_made_once(stubborn, monkeypatch):
    made = []
    plain = integrator.factorize

    def counted(*args, **options):
        made.append(args[0].shape)
        return plain(*args, **options)

    monkeypatch.setattr(integrator, "factorize", counted)
    crossing, options = CASES["hertz"]
    counts = []
    for cut in ((), (20,), (20, 21, 40), range(1, 61)):
        made.clear()
        stubborn(DT, lambda n, step, part, cut=cut: n < 4 and step in cut)
        run(crossing, time_step=DT, steps=60, method=asp.Alpha(-0.1), **options)
        counts.append(len(made))
    assert counts[1] == counts[2] == counts[3] == 3 * counts[0]  # one of Δt, Δt/2 and Δt/4 each


# --- what does not converge by itself --------------------------------------------------------------------------


class Careful:
    """A spring k e³ + c ė between two d.o.f. that knows its force only near its last elongation, as a user may write it."""

    def __init__(self, reach):
        self.reach = reach

    def force(self, u, v, state):
        e, last = u[0] - u[1], 0.0 if state is None else state[0]
        value = 4e9 * e**3 + 5e3 * (v[0] - v[1]) if abs(e - last) <= self.reach else np.nan
        return value * np.array([1.0, -1.0])

    def tangent(self, u, v, state):
        pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
        return 1.2e10 * (u[0] - u[1]) ** 2 * pair, 5e3 * pair

    def advanced(self, u, v, state):
        return u[0] - u[1], 1 if state is None else state[1] + 1  # and how many parts it went through


REACH = 4e-5


def careful(reach=REACH):
    car = with_nonlinear_element(CAR, Careful(reach), ["body.z", "wheel1.z"], name="damper")
    return asp.Crossing(bridge(), asp.Train.of(car), speed=40.0, start=-1.5, irregularity=waves(3e-3))


def test_an_element_of_a_user_makes_the_steps_shorter():
    """Steps in which it moves too far are cut, as often as it takes, and no others."""
    steps, options = 300, {"sensors": {"m": 12.5}, "method": asp.Alpha(-0.1)}
    with pytest.raises(AnalysisError, match=r"did not converge \(1 iteration, .* spring 1\.damper\.1"):
        asp.simulate(careful(), time_step=DT, steps=steps, cuts=0)
    result = run(careful(), time_step=DT, steps=steps, **options)
    free = run(careful(1.0), time_step=DT, steps=steps, **options)
    fine = run(careful(1.0), time_step=DT / 8, steps=8 * steps, every=8, **options)
    elongation = -np.diff(result.vehicle_displacement, axis=1)[:, 0]
    moved = np.abs(np.diff(elongation))
    parts = np.ones(steps)
    parts[: len(result.facts["parts_of_steps"])] = result.facts["parts_of_steps"]
    assert result.facts["cut_steps"] == np.count_nonzero(parts > 1) > 100
    assert moved[parts == 1].max() <= REACH < moved.max()
    assert result.facts["smallest_time_step"] == DT / parts.max() < DT / 2
    # A step is cut no more often than it takes, but for speeds that change inside.
    needed = 2.0 ** np.ceil(np.log2(np.maximum(moved / REACH, 1.0)))
    assert np.all((parts >= needed) | (moved < 1.05 * REACH * parts))
    assert np.mean(parts == needed) > 0.9
    for check in ("equilibrium_residual", "energy_residual"):
        assert result.checks[check] < 1e-11, check
    for name in ("vehicle_displacement", "sensor_displacement"):
        exact = getattr(fine, name)
        errors = [np.abs(getattr(one, name) - exact).max() for one in (result, free)]
        assert errors[0] < 0.7 * errors[1] < 0.05 * np.abs(exact).max(), name
    # A rigid wheel with mass feels the change of the time step itself.
    close(result, fine, 2e-3, ("contact_force",))


def test_the_memory_of_elements_is_that_of_completed_parts():
    settings = settings_for(careful(), time_step=DT, steps=300)
    plan = plan_for(careful(), settings)
    start, coupling = begin_nonlinear(plan, StartFactors(plan))
    recorder = Recorder(plan)
    watch(coupling, recorder)
    drive([Lane.at_start(plan, start, recorder)], prepare([plan]), with_cutting(coupling, recorder))
    facts = recorder.result(Outcome("completed", ""), {}).facts
    ((_, count),) = coupling.field.springs.state
    parts = facts["parts_of_steps"]
    assert count == parts.sum() + 300 - len(parts) > 400


def test_what_is_said_of_cuts():
    result = asp.simulate(careful(), time_step=DT, steps=120)
    (note,) = (note for note in result.facts["notes"] if "converge" in note)
    count, shortest = result.facts["cut_steps"], result.facts["smallest_time_step"]
    first = np.flatnonzero(result.facts["parts_of_steps"] > 1)[:4] + 1
    assert note.startswith(f"{count} steps ({', '.join(map(str, first))}, ...) did not converge as a whole")
    assert f"in parts of {shortest:.3g} s at least" in note
    assert note.endswith("the last one because of spring 1.damper.1")
    content = summary(result)
    assert content["computation"]["cut_steps"] == count
    assert content["computation"]["smallest_time_step_s"] == shortest
    assert any(f"{count} steps cut" in line for line in summary_lines(content))
    plain = asp.simulate(careful(1.0), time_step=DT, steps=120)
    assert plain.facts["cut_steps"] == 0 and "smallest_time_step" not in plain.facts
    assert not any("converge" in note for note in plain.facts["notes"])
    assert not any("cut" in line for line in summary_lines(summary(plain)))


def test_not_even_the_smallest_part_converges():
    """The history until then is kept, and the message says how far the step was cut."""
    tight = careful(6e-6)
    with pytest.raises(AnalysisError) as caught:
        asp.simulate(tight, time_step=DT, steps=600, sensors={"m": 12.5})
    said = str(caught.value)
    assert "did not converge as a whole, nor in 16 parts of 6.25e-05 s" in said
    assert "the force at spring 1.damper.1 is not a number" in said and "Use a smaller time step" in said
    step = int(said.split(",")[0].removeprefix("step "))
    result = caught.value.result
    assert result.outcome.code == "failed"
    assert len(result.time) == step > 1 and np.abs(result.vehicle_displacement[-1]).max() > 0.0
    assert result.facts["cut_steps"] > 0
    with pytest.raises(AnalysisError, match=r"in 2 parts of 0\.0005 s"):
        asp.simulate(tight, time_step=DT, steps=600, cuts=1)
    more = asp.simulate(tight, time_step=DT, steps=60, cuts=8)
    assert more.facts["smallest_time_step"] < DT / 16


def test_a_compiled_loop_goes_on_after_a_cut(stubborn):
    """Wheels that lift off: ordinary steps are made in the compiled loop where there is one, the others are all cut."""
    stubborn(5e-4, lambda n, step, part: n < 2)
    crossing = asp.Crossing(bridge(), asp.Train.of(CAR, 2, 4.0), speed=60.0, irregularity=waves(8e-3, 3.0))
    options = {"contact": "unilateral", "method": asp.Alpha(-0.1), "sensors": {"m": 12.5}}
    result = asp.simulate(crossing, time_step=5e-4, steps=600, **options)
    assert result.facts["cut_steps"] > 10
    assert result.checks["flight_count"] > 5
    for check in ("equilibrium_residual", "energy_residual", "compatibility_residual"):
        assert result.checks[check] < 1e-11, check


# --- input -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cuts", [-1, 11, 1.5, True, "two", None, float("nan")])
def test_wrong_numbers_of_cuts(cuts):
    with pytest.raises(InputError, match=r"cuts = .*: must be a whole number from 0 to 10"):
        asp.simulate(careful(), time_step=DT, steps=10, cuts=cuts)
