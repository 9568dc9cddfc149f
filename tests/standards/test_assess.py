"""From results to verdicts: quantities computed again in the test, and what is not there is not assessed."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import axlespan as asp
from axlespan.bridges import SupportAt
from axlespan.model.motions import Constant
from axlespan.reference import point_load_deflection
from axlespan.standards import CHECKS, FROM_MEMORY, Assessment, BridgeFacts, assess, bridge_facts, overall
from axlespan.standards.bridge_values import added_damping
from axlespan.standards.dynamic_factors import phi2, phi_double_dash
from axlespan.standards.filters import low_pass, up_to
from axlespan.standards.lm71 import InfluenceLine, lm71_effect
from axlespan.study.build import build
from axlespan.study.loader import load_case

SPAN, EI, MASS = 30.0, 34e9 * 1.5, 12e3
BRIDGE = {
    "length": SPAN,
    "youngs_modulus": 34e9,
    "second_moment": 1.5,
    "mass_per_length": MASS,
    "elements": 30,
    "damping": asp.Modal(0.01),
}
CAR = asp.vehicles.sprung_mass(mass=15e3, stiffness=1.2e6, damping=2e4, unsprung_mass=1e3)
LINE = Assessment(line_speed=250 / 3.6, bridge_type="prestressed-concrete", overhang=0.5)


@pytest.fixture(scope="module")
def crossing():
    train = asp.Train.of(CAR, count=4, spacing=12.0)
    waves = asp.irregularity.Harmonic(amplitude=2e-3, wavelength=9.0)
    return asp.Crossing(asp.bridges.simple_span(**BRIDGE), train, speed=60.0, start=-20.0, irregularity=waves)


@pytest.fixture(scope="module")
def result(crossing):
    return asp.simulate(crossing, time_step=2e-3, steps=2600, line_points=31)


@pytest.fixture(scope="module")
def found(result, crossing):
    return {verdict.check: verdict for verdict in assess(result, crossing, LINE)}


def test_all_checks_in_their_order(found):
    assert tuple(found) == CHECKS
    assert overall(found.values()) == "pass"


def test_facts_of_the_bridge(crossing):
    facts = bridge_facts(crossing.structure, Assessment())
    n = np.arange(1, 4)
    exact = (n * np.pi / SPAN) ** 2 * np.sqrt(EI / MASS) / (2.0 * np.pi)
    assert facts.spans == (SPAN,) and facts.starts == (0.0,) and not facts.continuous
    assert facts.frequencies == pytest.approx(exact, rel=1e-4)
    assert facts.damping_ratio == pytest.approx(0.01)
    assert facts.determinant_length == SPAN


def test_deck_acceleration(found, result, crossing):
    verdict = found["deck_acceleration"]
    f = bridge_facts(crossing.structure, LINE).frequencies
    filtered = np.abs(up_to(result.line_acceleration, 2e-3, max(30.0, 1.5 * f[0], f[2])))
    row, column = np.unravel_index(filtered.argmax(), filtered.shape)
    assert verdict.value == pytest.approx(filtered.max())
    assert verdict.when == pytest.approx(result.time[row])
    assert verdict.where == f"{result.line_position[column]:.4g} m"
    assert (verdict.limit, verdict.unit, verdict.outcome) == (3.5, "m/s^2", "pass")
    assert FROM_MEMORY in verdict.source


@pytest.mark.parametrize(("share", "outcome"), [(1.0 + 1e-9, "pass"), (1.0, "pass"), (1.0 - 1e-9, "fail")])
def test_outcomes_around_the_limit(found, result, crossing, share, outcome):
    value = found["deck_acceleration"].value
    own = dataclasses.replace(
        LINE, limits={"deck_acceleration": share * value}, checks=("deck_acceleration",)
    )
    (verdict,) = assess(result, crossing, own)
    assert verdict.outcome == outcome
    assert verdict.utilization == pytest.approx(1.0, abs=1e-8)
    assert verdict.source == "given in the assessment"


def test_deflection(found, result):
    verdict = found["deflection"]
    assert verdict.value == pytest.approx(-result.line_displacement.min())
    assert verdict.limit == pytest.approx(SPAN / 600.0)


def test_static_settlement_is_no_traffic(crossing):
    result = asp.simulate(crossing, time_step=2e-3, steps=1500, line_points=31)
    plain = {v.check: v for v in assess(result, crossing, LINE)}["deflection"]
    shifted = dataclasses.replace(
        result,
        line_displacement=result.line_displacement - 5e-3,
        line_slope=result.line_slope + 1e-3,
    )
    again = {v.check: v for v in assess(shifted, crossing, LINE)}
    assert again["deflection"].value == pytest.approx(plain.value)
    assert again["end_rotation"].value == pytest.approx(np.abs(result.line_slope).max())


def test_end_rotation_and_offset(found, result):
    rotation = np.abs(result.line_slope).max()
    assert found["end_rotation"].value == pytest.approx(rotation)
    assert found["end_rotation"].outcome == "reported"
    assert found["end_offset"].value == pytest.approx(0.5 * rotation)
    assert found["end_offset"].limit == 2e-3


def test_wheel_forces(found, result, crossing):
    static = 16e3 * 9.81
    on = (result.contact_position >= 0.0) & (result.contact_position <= SPAN)
    smooth = np.where(on, low_pass(result.contact_force, 2e-3, 20.0), static)
    assert found["wheel_unloading"].value == pytest.approx((1.0 - smooth / static).max())
    assert found["contact_force"].value == pytest.approx(0.5 * smooth.max())  # of an axle's two wheels
    assert found["contact_force"].limit == pytest.approx(90e3 + 0.5 * static)
    assert found["loss_of_contact"].value == 0.0


def test_body_acceleration(found, result):
    bodies = [i for i, name in enumerate(result.vehicle_dof) if name.endswith("body.z")]
    assert len(bodies) == 4
    verdict = found["body_acceleration"]
    assert verdict.value == pytest.approx(np.abs(result.vehicle_acceleration[:, bodies]).max())
    assert verdict.limit == 1.0 and verdict.where.endswith("body, center")


def test_dynamic_effect_by_hand(found, result, crossing):
    """Static deflection of the four axles by the closed form, load model 71 as a sum of point loads."""
    at = {"length": SPAN, "bending_stiffness": EI}
    middle, load = 0.5 * SPAN, 16e3 * 9.81

    def deflection(places, force):
        inside = places[(places >= 0.0) & (places <= SPAN)]
        return -float(np.sum(point_load_deflection(middle, force=force, at=inside, **at)))

    heads = np.arange(0.0, SPAN + 36.0, 0.05)
    train = max(deflection(head - 12.0 * np.arange(4), load) for head in heads)
    s = np.linspace(0.0, middle - 3.2, 4001)
    uniform = -2.0 * np.trapezoid(point_load_deflection(middle, force=80e3, at=s, **at), s)
    model = deflection(middle + np.array([-2.4, -0.8, 0.8, 2.4]), 250e3) + uniform
    n0 = bridge_facts(crossing.structure, LINE).first_frequency
    second = 0.5 * phi_double_dash(60.0, SPAN, n0)
    dynamic = -result.line_displacement[:, 15].min() / train - 1.0
    expected = (1.0 + dynamic + second) * train / (phi2(SPAN) * model)
    assert found["dynamic_effect"].value == pytest.approx(expected, rel=2e-3)
    assert found["lm71_deflection"].value == pytest.approx(phi2(SPAN) * model, rel=2e-3)


@pytest.mark.parametrize(("points", "error"), [(12, 2e-3), (30, 1e-4)])
def test_dynamic_effect_where_nothing_is_recorded_in_the_middle(found, crossing, points, error):
    coarse = asp.simulate(crossing, time_step=2e-3, steps=2600, line_points=points)
    verdict = next(v for v in assess(coarse, crossing, LINE) if v.check == "dynamic_effect")
    assert verdict.value == pytest.approx(found["dynamic_effect"].value, rel=error)


def test_damping_above_the_lower_bound_fails(result, crossing):
    steel = dataclasses.replace(LINE, bridge_type="steel", checks=("damping",))
    (verdict,) = assess(result, crossing, steel)
    assert (verdict.outcome, verdict.limit) == ("fail", 0.005)
    assert verdict.value == pytest.approx(0.01)


def test_of_several_spans_the_one_counts_that_allows_least_damping():
    """1.0 % above 20 m, 1.14 % of 18 m; moving forces add 0.48 % to 18 m and 0.086 % to 24 m."""
    beam = asp.bridges.continuous_beam(
        spans=[18.0, 24.0, 18.0],
        elements=12,
        youngs_modulus=34e9,
        second_moment=1.0,
        mass_per_length=1e4,
        damping=asp.Modal(0.012),
    )
    limits = {}
    for name, vehicle in (("car", CAR), ("forces", asp.vehicles.axle_loads(loads=[1e5], positions=[0.0]))):
        crossing = asp.Crossing(beam, asp.Train.of(vehicle), speed=50.0)
        result = asp.simulate(crossing, time_step=2e-3, steps=200)
        (verdict,) = assess(result, crossing, dataclasses.replace(LINE, checks=("damping",)))
        limits[name] = verdict.limit
        assert "span 24 m" in verdict.note and verdict.value == pytest.approx(0.012)
    assert limits["car"] == 0.01
    assert limits["forces"] == pytest.approx(0.01 + added_damping(24.0))


def test_what_the_run_does_not_have_is_not_assessed(crossing):
    short = asp.simulate(crossing, time_step=2e-3, steps=300)
    found = {verdict.check: verdict for verdict in assess(short, crossing, Assessment())}
    expected = {
        "dynamic_analysis": "give line_speed",
        "damping": "give bridge_type",
        "deck_acceleration": "the deck was not recorded",
        "deflection": "the deck was not recorded",
        "dynamic_effect": "the deck was not recorded",
        "dynamic_moment": "the envelope of moments was not recorded",
        "end_rotation": "the deck was not recorded",
        "end_offset": "the deck was not recorded",
        "twist": "lines called left and right",
        "derailment": "the model has no lateral forces",
        "continuous_comfort": "the record is 0.602 s long, the rule needs 5 s",
        "mean_comfort": "the rule needs 300 s",
        "weighted_rms": "the rule needs 5 s",
        "sperling": "the rule needs 5 s",
    }
    missing = {name: v.reason for name, v in found.items() if v.outcome == "not assessed"}
    assert set(missing) == set(expected)
    for name, text in expected.items():
        assert text in missing[name]
        assert found[name].value is None


def test_coarse_records_are_not_assessed(crossing):
    coarse = asp.simulate(crossing, time_step=2e-3, steps=1500, every=20, line_points=11)
    found = {verdict.check: verdict for verdict in assess(coarse, crossing, LINE)}
    assert "records are 0.04 s apart" in found["deck_acceleration"].reason
    assert "a filter at 20 Hz asks for 0.0125 s" in found["wheel_unloading"].reason
    assert found["deflection"].outcome == "pass"


def test_thinned_records_are_not_assessed(crossing):
    """They have no filter before them: 80 Hz would count as 20 Hz in records 10 ms apart."""
    thin = asp.simulate(crossing, time_step=1e-3, steps=1500, every=2, line_points=11)
    found = {verdict.check: verdict for verdict in assess(thin, crossing, LINE)}
    for check in ("deck_acceleration", "wheel_unloading", "contact_force"):
        assert "one record of 2 steps was kept" in found[check].reason
    assert found["deflection"].outcome == "pass"


def test_wheels_of_vehicles_in_space_are_no_halves_of_axles():
    """Both wheels of an axle on the one line of a plane beam: each has its own force, not half of it."""
    train = asp.Train.of(asp.vehicles.library.vehicle("ice-3d-trailer"))
    plane = asp.bridges.simple_span(**BRIDGE)
    crossing = asp.Crossing(plane, train, speed=50.0, line={"left": "main", "right": "main"})
    result = asp.simulate(crossing, time_step=2e-3, steps=500, line_points=11)
    verdict = next(v for v in assess(result, crossing, LINE) if v.check == "contact_force")
    static = train.static_forces()[0]
    assert static == pytest.approx(58.4e3 * 9.81 / 8.0, rel=1e-3)
    assert verdict.value == pytest.approx(static, rel=0.1)
    assert verdict.limit == pytest.approx(min(90e3 + static, 190e3))
    assert "half" not in verdict.note


def test_moving_forces_have_no_unloading_and_no_coaches():
    forces = asp.Train.of(asp.vehicles.axle_loads(loads=[17e4] * 4, positions=[0.0, 3.0, 11.0, 14.0]))
    crossing = asp.Crossing(asp.bridges.simple_span(**(BRIDGE | {"length": 20.0})), forces, speed=50.0)
    result = asp.simulate(crossing, time_step=2e-3, steps=700, line_points=21)
    found = {verdict.check: verdict for verdict in assess(result, crossing, LINE)}
    for check in ("wheel_unloading", "contact_force", "loss_of_contact"):
        assert "given forces" in found[check].reason
    assert "no vehicle of the run has a car body" in found["body_acceleration"].reason
    # 20 m: 1 % and 0.296 % for the moving forces
    assert found["damping"].limit == pytest.approx(0.01296, abs=1e-5)
    assert found["dynamic_effect"].outcome == "pass"


def test_critical_speeds(found, crossing):
    f1, f2, _ = bridge_facts(crossing.structure, LINE).frequencies
    verdict = found["critical_speed"]
    near = [f * 12.0 / i for f in (f1, f2) for i in (1, 2, 3, 4)]
    assert verdict.value == pytest.approx(min(near, key=lambda speed: abs(speed - 60.0)))
    assert "with d = 12 m from vehicle to vehicle; the run has 216 km/h" in verdict.note
    assert f"{3.6 * f2 * 12.0 / 3.0:.0f} (f2 d/3)" in verdict.note  # 207 km/h


def test_solids_have_no_supports_on_their_line():
    example = load_case(Path(asp.__file__).parent / "examples" / "solid-beam-coarse.yaml")
    structure = build(example).crossing.structure
    facts = bridge_facts(structure, Assessment())
    assert facts.spans == () and facts.missing == "the spans are not known: give spans"
    assert len(facts.frequencies) == 3
    assert (
        bridge_facts(structure, Assessment(spans=(structure.length,))).determinant_length == structure.length
    )


def test_wheels_that_leave_the_rail(result, crossing):
    for more, count in (({"tension_episodes": 2}, 2.0), ({"flight_count": 3}, 3.0)):
        flying = dataclasses.replace(result, checks={**result.checks, **more})
        (verdict,) = assess(flying, crossing, dataclasses.replace(LINE, checks=("loss_of_contact",)))
        assert (verdict.outcome, verdict.value) == ("fail", count)
    unwatched = dataclasses.replace(result, checks={})
    (verdict,) = assess(unwatched, crossing, dataclasses.replace(LINE, checks=("loss_of_contact",)))
    assert verdict.reason == "tension was not watched in this run"


def test_without_the_crossing_only_the_result_speaks(result):
    found = {verdict.check: verdict for verdict in assess(result, None, LINE)}
    assert "the structure is not known" in found["deflection"].reason
    assert "the frequencies of vertical bending are not known" in found["deck_acceleration"].reason
    assert found["body_acceleration"].outcome == "pass"
    facts = BridgeFacts((0.0,), (SPAN,), determinant_length=SPAN, frequencies=(3.6, 14.4, 32.4))
    again = {verdict.check: verdict for verdict in assess(result, None, LINE, facts=facts)}
    assert again["deck_acceleration"].outcome == again["deflection"].outcome == "pass"


def test_spans_of_continuous_beams_and_elastic_supports():
    supports = [
        SupportAt(0.0, stiffness={"z": 2e9}),
        SupportAt(18.0, ("z",)),
        SupportAt(42.0, ("z",)),
        SupportAt(60.0, stiffness={"z": 2e9}),
    ]
    beam = asp.bridges.continuous_beam(
        spans=[18.0, 24.0, 18.0],
        youngs_modulus=34e9,
        second_moment=0.42,
        mass_per_length=9.8e3,
        elements=12,
        supports=supports,
    )
    facts = bridge_facts(beam, Assessment())
    assert facts.spans == pytest.approx((18.0, 24.0, 18.0)) and facts.continuous
    assert facts.determinant_length == pytest.approx(26.0)
    own = bridge_facts(beam, Assessment(spans=(60.0,), first_frequency=3.3))
    assert (own.spans, own.continuous, own.first_frequency) == ((60.0,), False, 3.3)
    assert "longer than the line" in bridge_facts(beam, Assessment(spans=(61.0,))).missing


def test_a_beam_without_supports_to_be_found_asks_for_spans(result, crossing):
    unknown = dataclasses.replace(
        bridge_facts(crossing.structure, LINE), spans=(), starts=(), missing="give spans"
    )
    found = {verdict.check: verdict for verdict in assess(result, crossing, LINE, facts=unknown)}
    for check in ("dynamic_analysis", "deflection", "lm71_deflection", "dynamic_effect"):
        assert found[check].reason == "give spans"


def test_decks_in_a_row_are_simple_spans():
    decks = asp.bridges.simple_spans(
        spans=[20.0, 30.0], youngs_modulus=34e9, second_moment=1.0, mass_per_length=1e4, elements=10
    )
    facts = bridge_facts(decks, Assessment())
    assert facts.spans == pytest.approx((20.0, 30.0)) and not facts.continuous
    assert facts.determinant_length == pytest.approx(30.0)
    soft = asp.bridges.simple_spans(
        spans=[20.0, 30.0],
        youngs_modulus=34e9,
        second_moment=1.0,
        mass_per_length=1e4,
        elements=10,
        bearing_stiffness=1e9,
    )
    assert bridge_facts(soft, Assessment()).spans == pytest.approx((20.0, 30.0))


@pytest.mark.parametrize("top", ["rigid", "hinged"])
def test_columns_end_spans(top):
    column = {
        "height": 8.0,
        "youngs_modulus": 34e9,
        "second_moment": 0.05,
        "area": 1.0,
        "mass_per_length": 2.5e3,
    }
    portal = asp.bridges.frame(
        spans=[12.0, 16.0, 12.0],
        youngs_modulus=34e9,
        second_moment=0.3,
        mass_per_length=1e4,
        area=4.0,
        elements=8,
        columns=[asp.bridges.Column(position=x, top=top, **column) for x in (12.0, 28.0)],
        supports=[SupportAt(0.0, ("z",)), SupportAt(40.0, ("z",))],
    )
    facts = bridge_facts(portal, Assessment())
    assert facts.spans == pytest.approx((12.0, 16.0, 12.0)) and facts.continuous


def test_the_deck_below_a_track():
    bridge = asp.bridges.simple_span(**(BRIDGE | {"damping": None}))
    track = asp.bridges.with_track(bridge, asp.bridges.ballasted_track(), approach=30.0, exit=30.0)
    facts = bridge_facts(track, Assessment())
    alone = bridge_facts(bridge, Assessment())
    assert facts.spans == pytest.approx((SPAN,)) and facts.starts == (0.0,)
    # rails and sleepers add mass: a little below the bare beam's first frequency
    assert 0.9 * alone.first_frequency < facts.first_frequency < alone.first_frequency


def test_twist_of_two_lines():
    """The left line carries the beam's deflection, the right one stands still: twist is its change over 3 m."""
    bridge = asp.bridges.simple_span(**BRIDGE)
    line = bridge.line()
    still = line.renumbered(np.full(bridge.system.size, -1))
    two = dataclasses.replace(bridge, lines={"main": line, "left": line, "right": still})
    train = asp.Train.of(CAR, count=2, spacing=12.0)
    crossing = asp.Crossing(two, train, speed=60.0, start=-5.0)
    places = np.arange(0.0, SPAN + 0.1, 1.5)
    result = asp.simulate(crossing, time_step=2e-3, steps=500, line_points=places)
    w = result.line_displacement
    assert result.line_twist[:, 1:-1] == pytest.approx(w[:, 2:] - w[:, :-2], abs=1e-12)
    assert result.line_twist[:, 0] == pytest.approx(w[:, 2] - w[:, 0], abs=1e-12)  # the first 3 m
    (verdict,) = assess(result, crossing, dataclasses.replace(LINE, checks=("twist",)))
    assert verdict.value == pytest.approx(np.abs(result.line_twist).max())
    assert (verdict.limit, verdict.outcome) == (1.5e-3, "pass")


def test_a_pitching_body_counts_over_its_axles():
    from axlespan.vehicles import Body, Suspension, Wheel

    car = asp.vehicles.multibody(
        bodies=[Body("body", mass=32e3, inertia=1.1e6, position=7.0)],
        wheels=[Wheel(position=0.0, mass=1e3), Wheel(position=14.0, mass=1e3)],
        suspensions=[Suspension(("body", f"wheel{i}"), stiffness=1.4e6, damping=6e4) for i in (1, 2)],
    )
    crossing = asp.Crossing(
        asp.bridges.simple_span(**BRIDGE),
        asp.Train.of(car),
        speed=60.0,
        irregularity=asp.irregularity.Harmonic(amplitude=5e-3, wavelength=28.0),
    )
    result = asp.simulate(crossing, time_step=2e-3, steps=1200, line_points=11)
    (verdict,) = assess(result, crossing, dataclasses.replace(LINE, checks=("body_acceleration",)))
    z, pitch = (result.at("vehicle_acceleration", f"1.body.{part}") for part in ("z", "pitch"))
    over = {"center": z, "over the front bogie": z - 7.0 * pitch, "over the rear bogie": z + 7.0 * pitch}
    largest = max(over, key=lambda name: np.abs(over[name]).max())
    assert verdict.value == pytest.approx(np.abs(over[largest]).max())
    assert verdict.where == f"1.body, {largest}" and largest != "center"


def test_moments_against_load_model_71():
    """A slow axle: the moments of the run are static ones, P x (L - x) / L; with LM71 by hand at the worst section."""
    force = asp.Train.of(asp.vehicles.axle_loads(loads=[4e5], positions=[0.0]))
    bridge = asp.bridges.simple_span(**BRIDGE)
    crossing = asp.Crossing(bridge, force, speed=2.0)
    result = asp.simulate(crossing, time_step=0.02, steps=760, envelopes=["moment"], line_points=3)
    asked = Assessment(line_speed=250 / 3.6, checks=("dynamic_moment",))
    (verdict,) = assess(result, crossing, asked)
    x = np.linspace(0.0, SPAN, 31)
    run = 4e5 * x * (SPAN - x) / SPAN
    assert result.envelopes.of("moment").largest == pytest.approx(run, rel=0.03, abs=1e5)
    line = np.linspace(0.0, SPAN, 6001)
    model = [
        lm71_effect(InfluenceLine(line, np.minimum(line, at) * (SPAN - np.maximum(line, at)) / SPAN))
        for at in x
    ]
    inside = np.array(model) > 0.2 * max(model)
    second = 0.5 * phi_double_dash(2.0, SPAN, bridge_facts(bridge, LINE).first_frequency)
    ratio = (result.envelopes.of("moment").largest + second * run)[inside] / (
        phi2(SPAN) * np.array(model)[inside]
    )
    assert verdict.value == pytest.approx(ratio.max(), rel=1e-3)
    assert verdict.where == f"{x[inside][ratio.argmax()]:.4g} m"
    settled = [SupportAt(0.0, ("z",), motion={"z": Constant(-1e-3)}), SupportAt(SPAN, ("z",))]
    moved = dataclasses.replace(
        crossing, structure=asp.bridges.simple_span(**(BRIDGE | {"supports": settled}))
    )
    (verdict,) = assess(result, moved, asked)
    assert "moved supports" in verdict.reason
