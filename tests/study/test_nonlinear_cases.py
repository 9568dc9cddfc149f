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
from axlespan.interaction.simulate import run_plan
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
analysis: {{time_step: 0.5 ms, steps: 300, contact: unilateral, lost_after: 0.25 s}}
"""
    )
    assert built.plan.laws.kinds == ("hertz", "unilateral", "linear-spring")
    assert built.plan.settings.lost_after == 0.25
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


def test_a_bearing_lifts(made):
    """It lifts as soon as the train takes more from it than the weight of the beam gave, and then pulls no more."""
    linear = run_plan(made(LIFTING.replace("  LIFT\n", "")).plan)
    built = made(LIFTING.replace("LIFT", "may_lift: [support3]"))
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
    before = np.arange(len(own)) < np.argmax(own < -share) - 1
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
