"""Contact that lets go, hanging sleepers and bearings that lift, from case files; runs against the same in Python."""

import json
from textwrap import dedent

import numpy as np
import pytest

import axlespan as asp
from axlespan.bridges import ballasted_track, track_on_ground
from axlespan.bridges.unilateral import with_unilateral_springs
from axlespan.contact.laws import Hertz, LinearSpring, Unilateral
from axlespan.errors import InputError
from axlespan.interaction.runs import run_plan
from axlespan.study.build import build
from axlespan.study.loader import load_case

SPAN = """
structure: {kind: simple-span, length: 25 m, youngs_modulus: 2.87 GPa, second_moment: 2.90 m^4,
            mass_per_length: 2303 kg/m, elements: 10}
"""
CAR = "{vehicle: sprung-mass, mass: 5750 kg, stiffness: 1595 kN/m, damping: 20 kNs/m, unsprung_mass: 800 kg"
WAVES = "irregularity: {kind: harmonic, amplitude: 8 mm, wavelength: 3 m}"


@pytest.fixture
def made(tmp_path):
    def make(text):
        path = tmp_path / "case.yaml"
        path.write_text(dedent(text), encoding="utf-8")
        return build(load_case(path))

    return make


def test_laws_of_the_analysis_and_of_entries(made):
    built = made(
        f"""{SPAN}
train:
  - {CAR}, contact: {{kind: hertz, radius: 430 mm, tread: cone}}}}
  - {CAR}, offset: 6 m}}
  - {CAR}, offset: 12 m, contact: {{kind: linear-spring, stiffness: 2 MN/m, damping: 3 kNs/m, tension: true}}}}
crossing: {{speed: 60 m/s, {WAVES}}}
analysis: {{time_step: 0.5 ms, steps: 300, contact: unilateral, lost_after: 0.25 s, cuts: 2}}
"""
    )
    assert built.plan.laws.kinds == ("hertz", "unilateral", "linear-spring")
    assert built.plan.settings.lost_after == 0.25
    assert built.plan.settings.cuts == 2
    result = run_plan(built.plan)
    car = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, damping=20e3, unsprung_mass=800.0)
    from dataclasses import replace

    from axlespan.vehicles import Placement, Train

    laws = (Hertz(radius=0.43, tread="cone"), Unilateral(), LinearSpring(2e6, 3e3, True))
    cars = [replace(car, contacts=(replace(car.contacts[0], law=law),)) for law in laws]
    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=10
    )
    train = Train(tuple(Placement(one, 6.0 * i) for i, one in enumerate(cars)))
    waves = asp.irregularity.Harmonic(amplitude=8e-3, wavelength=3.0)
    own = asp.simulate(
        asp.Crossing(bridge, train, speed=60.0, irregularity=waves),
        time_step=5e-4,
        steps=300,
        lost_after=0.25,
    )
    np.testing.assert_array_equal(result.contact_force, own.contact_force)
    assert result.contact_force[:, :2].min() == 0.0
    assert result.contact_force[:, 2].min() > 0.0 or result.checks["tension_episodes"] > 0


def test_hanging_sleepers_of_a_track(made):
    built = made(
        """
structure: {kind: track, length: 48 m, track: {kind: ballasted, hanging_sleepers: [{at: 24.3 m, gap: 1 mm}]}}
train: [{vehicle: axle-loads, loads: 100 kN}]
crossing: {speed: 60 m/s, start: 18 m}
analysis: {time_step: 0.5 ms, steps: 250}
output: {sensors: {hole: 24.3 m}}
"""
    )
    result = run_plan(built.plan)
    track = with_unilateral_springs(
        track_on_ground(ballasted_track(), 48.0), "ballast", hanging=[(24.3, 1e-3)]
    )
    crossing = asp.Crossing(track, asp.Train.of(asp.vehicles.axle_loads(loads=1e5)), speed=60.0, start=18.0)
    own = asp.simulate(crossing, time_step=5e-4, steps=250, sensors={"hole": 24.3})
    np.testing.assert_array_equal(result.sensor_displacement, own.sensor_displacement)
    plain = asp.simulate(
        asp.Crossing(
            track_on_ground(ballasted_track(), 48.0),
            asp.Train.of(asp.vehicles.axle_loads(loads=1e5)),
            speed=60.0,
            start=18.0,
        ),
        time_step=5e-4,
        steps=250,
        sensors={"hole": 24.3},
    )
    assert result.sensor_displacement.min() < 1.25 * plain.sensor_displacement.min()  # deeper over the hole


LIFTING = """
structure:
  kind: continuous-beam
  spans: [{length: 20 m}, {length: 11 m}]
  youngs_modulus: 34 GPa
  second_moment: 0.6 m^4
  mass_per_length: 3 t/m
  elements: 10
  supports:
    - {at: 0 m, fixed: [z]}
    - {at: 20 m, fixed: [z]}
    - {at: 31 m, stiffness: {z: 1 GN/m}}
  LIFT
train: [{vehicle: sprung-mass, mass: 40 t, stiffness: 4000 kN/m, damping: 60 kNs/m}]
crossing: {speed: 10 m/s}
analysis: {time_step: 2 ms, steps: 1000}
output: {sensors: {end: 31 m}}
"""


@pytest.mark.parametrize("damping", ["alpha: 0 1/s, beta: 0 ms", "alpha: 0.5 1/s, beta: 0.5 ms"])
def test_a_bearing_lifts(made, damping):
    """It lifts as soon as the train takes more from it than the weight of the beam gave, and then pulls no more.

    Nor does its share of Rayleigh damping.
    """
    damped = LIFTING.replace("LIFT", f"damping: {{kind: rayleigh, {damping}}}\n  LIFT")
    linear = run_plan(made(damped.replace("  LIFT\n", "")).plan)
    built = made(damped.replace("LIFT", "may_lift: [support3]"))
    lifting = run_plan(built.plan)
    reaction = lifting.at("support_reaction", "support3.z")
    own = linear.at("support_reaction", "support3.z")
    system = built.crossing.structure.system
    blocks = system.partition
    dead = np.linalg.solve(blocks.K_FF.toarray(), system.weight(9.81)[system.free])
    share = float((blocks.K_FP.T @ dead)[2])  # of its weight, on this support
    assert share > 0.0
    assert own.min() < -share
    assert reaction.min() == pytest.approx(-share, rel=1e-6)
    before = np.arange(len(own)) < np.argmax(own < -share) - 4  # within the last micrometer the dashpot fades
    np.testing.assert_allclose(reaction[before], own[before], atol=1e-6 * np.abs(own).max())
    assert (
        lifting.at("sensor_displacement", "end").max() > 1.5 * linear.at("sensor_displacement", "end").max()
    )


@pytest.mark.parametrize(
    ("structure", "analysis", "words"),
    [
        (
            SPAN,
            "method: iterative, contact: unilateral",
            "does not know contact: unilateral. Use method: direct",
        ),
        (SPAN, "basis: reduced, contact: unilateral", "does not know contact: unilateral. Use basis: full"),
        (
            "structure: {kind: track, length: 48 m, track: {kind: ballasted, hanging_sleepers: [{at: 90 m, gap: 1 mm}]}}",
            "",
            r"hanging_sleepers.0.at = 90 m: must lie on the track",
        ),
        (
            "structure: {kind: track, length: 48 m, track: {kind: ballasted, hanging_sleepers: "
            "[{at: 9 m, gap: 1 mm}, {at: 9 m, gap: 2 mm}]}}",
            "",
            "hanging_sleepers.1.at = 9 m: names a sleeper twice",
        ),
    ],
)
def test_what_only_shows_when_it_is_built(made, structure, analysis, words):
    more = f", {analysis}" if analysis else ""
    with pytest.raises(InputError, match=words):
        made(
            f"""{structure}
train: [{CAR}}}]
crossing: {{speed: 20 m/s}}
analysis: {{time_step: 0.5 ms, steps: 300{more}}}
"""
        )


def test_a_fixed_support_does_not_lift(made):
    with pytest.raises(
        InputError, match=r"may_lift.0 = support1: must be a support with a stiffness along z"
    ):
        made(LIFTING.replace("LIFT", "may_lift: [support1]"))


def test_a_lost_vehicle_exits_with_three_and_keeps_the_history(tmp_path):
    from typer.testing import CliRunner

    from axlespan.cli.app import app

    case = tmp_path / "lost.yaml"
    case.write_text(
        f"""{SPAN}
train: [{CAR}}}]
crossing: {{speed: 60 m/s, start: -30 m, irregularity: {{kind: table, points: [[-25 m, 0 m], [-15 m, 1 m], [-14 m, -2 m]]}}}}
analysis: {{time_step: 1 ms, steps: 900, contact: unilateral, lost_after: 0.1 s}}
""",
        encoding="utf-8",
    )
    done = CliRunner().invoke(app, ["run", str(case), "-o", str(tmp_path / "out"), "--no-figures"])
    assert done.exit_code == 3
    assert "vehicle 1 is lost" in done.output
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert summary["outcome"]["code"] == "failed"
    assert summary["flights"]["count"] >= 1
    assert (tmp_path / "out" / "result.nc").is_file()


# --- nonlinear springs and suspensions -----------------------------------------------------------------------

TRACK = """
structure:
  kind: track
  length: 48 m
  track: {{kind: ballasted{more}}}
  {springs}
train: [{{vehicle: axle-loads, loads: 100 kN}}]
crossing: {{speed: 60 m/s, start: 18 m}}
analysis: {{time_step: 0.5 ms, steps: 120}}
output: {{sensors: {{rail: 24 m}}}}
"""


@pytest.mark.parametrize(
    ("law", "more"),
    [
        ("{kind: power, force: 195 kN, at: 1 mm, exponent: 1}", ", pad_stiffness: 195 MN/m"),
        ("{kind: multilinear, points: [[0 mm, 0 kN], [1 mm, 195 kN]]}", ", pad_stiffness: 195 MN/m"),
        ("{kind: power-dashpot, force: 20 kN, at: 0.1 m/s, exponent: 1}", ", pad_damping: 200 kNs/m"),
        ("{kind: multilinear-dashpot, points: [[0, 0], [1 m/s, 200 kN]]}", ", pad_damping: 200 kNs/m"),
        (
            "{kind: hysteresis, stiffness: 195 MN/m, yield_force: 90 MN, hardening: 1 MN/m}",
            ", pad_stiffness: 195 MN/m",
        ),
    ],
)
def test_springs_on_a_linear_law_are_other_springs(made, law, more):
    """A law takes the place of the stiffness of a group and leaves its dashpots; that of a dashpot the other way round."""
    springs = f"nonlinear_springs: [{{springs: pads, law: {law}}}]"
    built = made(TRACK.format(more="", springs=springs))
    assert any(fact.endswith("80 springs of pads along z") for fact in built.facts)
    on_law = run_plan(built.plan)
    linear = run_plan(made(TRACK.format(more=more, springs="")).plan)
    plain = run_plan(made(TRACK.format(more="", springs="")).plan)
    size = np.abs(linear.sensor_displacement).max()
    np.testing.assert_allclose(
        on_law.sensor_displacement, linear.sensor_displacement, rtol=0.0, atol=1e-10 * size
    )
    assert np.abs(plain.sensor_displacement - linear.sensor_displacement).max() > 0.01 * size
    for check in ("energy_residual", "equilibrium_residual"):
        assert on_law.checks[check] < 1e-9


def test_ballast_on_a_one_sided_law_is_unilateral_ballast(made):
    springs = "nonlinear_springs: [{springs: ballast, law: {kind: unilateral}}]"
    own = run_plan(made(TRACK.format(more="", springs=springs)).plan)
    known = run_plan(made(TRACK.format(more=", ballast: unilateral", springs="")).plan)
    np.testing.assert_array_equal(own.sensor_displacement, known.sensor_displacement)


CAR_OF_BODIES = """{span}
train:
  - vehicle: multibody
    bodies: [{{name: body, mass: 10.5 t, inertia: 50 t m^2, position: 2 m}}]
    wheels: [{{position: 0 m, mass: 900 kg}}, {{position: 5 m, mass: 900 kg}}]
    suspensions:
      - {{between: [body, wheel1], stiffness: 600 kN/m, damping: 10 kNs/m{front}}}
      - {{between: [wheel2, body], stiffness: 600 kN/m, damping: 10 kNs/m{rear}}}
crossing: {{speed: 30 m/s, irregularity: {{kind: harmonic, amplitude: 4 mm, wavelength: 8 m}}}}
analysis: {{time_step: 0.5 ms, steps: 700}}
"""


def test_bump_stops_and_friction_of_suspensions(made):
    """The same as springs between d.o.f. in Python; a stop that is never reached changes nothing."""
    from dataclasses import replace

    from axlespan.model.nonlinear import BilinearHysteresis, UnilateralSpring
    from axlespan.vehicles.nonlinear import with_nonlinear_spring

    front = ", bump_stop: {gap: 4 mm, stiffness: 20 MN/m, damping: 5 kNs/m}"
    rear = ", law: {kind: hysteresis, stiffness: 20 MN/m, yield_force: 2 kN}"
    plan = made(CAR_OF_BODIES.format(span=SPAN, front=front, rear=rear)).plan
    result = run_plan(plan)
    plain = made(CAR_OF_BODIES.format(span=SPAN, front="", rear="")).plan
    linear = run_plan(plain)
    (item,) = plain.crossing.placements
    at_front = {"body.z": 1.0, "body.pitch": -2.0, "wheel1.z": -1.0}  # pitch lowers the front
    at_rear = {"body.z": 1.0, "body.pitch": 3.0, "wheel2.z": -1.0}
    car = with_nonlinear_spring(item.vehicle, UnilateralSpring(20e6, 5e3), at_front, gap=4e-3)
    car = with_nonlinear_spring(car, BilinearHysteresis(20e6, 2e3), at_rear)
    own = asp.simulate(
        replace(plain.crossing, train=asp.Train.of(car)),
        time_step=5e-4,
        steps=700,
        method=plain.settings.method,
        footprint=plain.settings.footprint,
    )
    np.testing.assert_allclose(result.contact_force, own.contact_force, rtol=1e-9)
    names, motion = result.vehicle_dof, result.vehicle_displacement
    e = sum(factor * motion[:, names.index(f"1.{dof}")] for dof, factor in at_front.items())
    reached = np.flatnonzero(e < -4e-3)
    assert len(reached) > 10
    before = slice(0, reached[0])
    assert np.abs(result.contact_force[before] - linear.contact_force[before]).max() > 100.0  # friction
    far = ", bump_stop: {gap: 90 mm, stiffness: 20 MN/m}"
    never = run_plan(made(CAR_OF_BODIES.format(span=SPAN, front=far, rear=far)).plan)
    np.testing.assert_allclose(never.contact_force, linear.contact_force, rtol=1e-9)
