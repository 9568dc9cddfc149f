"""Dynamic factors, damping, frequency limits, flow chart and speeds of EN 1991-2, by their formulas and examples."""

import math

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.standards.bridge_values import (
    ADDED_SOURCE,
    DAMPING_SOURCE,
    FREQUENCY_SOURCE,
    added_damping,
    frequency_limits,
    structural_damping,
)
from axlespan.standards.dynamic_analysis import (
    FLOW_CHART,
    SPEEDS,
    TRAINS,
    load_model,
    need_of_dynamic_analysis,
    regular_distance,
    resonance_speeds,
    speeds_to_analyze,
)
from axlespan.standards.dynamic_factors import (
    SOURCE,
    continuous_determinant_length,
    phi2,
    phi3,
    phi_dash,
    phi_double_dash,
)
from axlespan.standards.verdict import FROM_MEMORY


def test_numbers_from_memory_say_so():
    for source in (SOURCE, ADDED_SOURCE, DAMPING_SOURCE, FREQUENCY_SOURCE, FLOW_CHART, SPEEDS, TRAINS):
        assert FROM_MEMORY in source


def test_phi_dash_of_the_published_example():
    """10 km/h, 25 m, 3.554 Hz: K = 0.0156, φ' = 0.016."""
    k = 10.0 / 3.6 / (2.0 * 25.0 * 3.554)
    assert k == pytest.approx(0.0156, abs=5e-5)
    assert phi_dash(10.0 / 3.6, 25.0, 3.554) == pytest.approx(0.016, abs=2e-4)


def test_phi_dash_is_constant_from_k_076_on():
    length, n0 = 20.0, 4.0
    at = 0.76 * 2.0 * length * n0
    assert phi_dash(at, length, n0) == 1.325
    assert phi_dash(2.0 * at, length, n0) == 1.325
    assert phi_dash(at * 0.9999, length, n0) == pytest.approx(1.325, abs=5e-3)  # the curve ends there
    assert phi_dash(0.0, length, n0) == 0.0


def test_phi_double_dash_by_hand():
    """L = 10 m, n0 = 8 Hz: L n0 / 80 = 1, so 0.56 e^-1; half of it at 11 m/s; never negative."""
    assert phi_double_dash(22.0, 10.0, 8.0) == pytest.approx(0.56 * math.exp(-1.0))
    assert phi_double_dash(11.0, 10.0, 8.0) == pytest.approx(0.28 * math.exp(-1.0))
    assert phi_double_dash(80.0, 10.0, 8.0) == phi_double_dash(22.0, 10.0, 8.0)
    assert phi_double_dash(80.0, 30.0, 1.0) == 0.0
    second = 0.5 * (20.0 * 6.0 / 80.0 - 1.0) * math.exp(-1.0)
    assert phi_double_dash(30.0, 20.0, 6.0) == pytest.approx(0.56 * math.exp(-4.0) + second)


@pytest.mark.parametrize(
    ("length", "two", "three"),
    [(4.0, 1.62, 1.93), (9.0, 1.44 / 2.8 + 0.82, 2.16 / 2.8 + 0.73), (100.0, 1.0, 1.0), (3.61, 1.667, 2.0)],
)
def test_factors_of_load_model_71(length, two, three):
    assert phi2(length) == pytest.approx(two, abs=5e-4)
    assert phi3(length) == pytest.approx(three, abs=5e-4)


def test_factors_of_load_model_71_stay_within_their_bounds():
    lengths = np.geomspace(0.01, 1000.0, 200)
    assert all(1.0 <= phi2(length) <= 1.67 and 1.0 <= phi3(length) <= 2.0 for length in lengths)
    assert phi2(0.03) == 1.67 and phi3(0.03) == 2.0  # where the root is below 0.2


def test_determinant_length_of_continuous_beams():
    assert continuous_determinant_length((20.0,)) == 20.0
    assert continuous_determinant_length((20.0, 20.0)) == pytest.approx(24.0)
    assert continuous_determinant_length((18.0, 24.0, 18.0)) == pytest.approx(26.0)
    assert continuous_determinant_length((10.0, 40.0)) == 40.0  # the largest span
    assert continuous_determinant_length((20.0,) * 9) == pytest.approx(30.0)


@pytest.mark.parametrize(
    ("kind", "span", "percent"),
    [
        ("steel", 40.0, 0.5),
        ("composite", 20.0, 0.5),
        ("steel", 12.0, 1.5),
        ("prestressed-concrete", 30.0, 1.0),
        ("prestressed-concrete", 10.0, 1.7),
        ("reinforced-concrete", 20.0, 1.5),
        ("filler-beam", 5.0, 2.55),
    ],
)
def test_damping_by_type_and_span(kind, span, percent):
    assert 100.0 * structural_damping(kind, span) == pytest.approx(percent)


def test_added_damping():
    spans = [5.0, 10.0, 15.0, 20.0, 25.0, 29.0]
    expected = [0.110, 0.329, 0.653, 0.296, 0.060, 0.002]
    assert [100.0 * added_damping(span) for span in spans] == pytest.approx(expected, abs=6e-4)
    assert added_damping(30.0) == added_damping(80.0) == 0.0


def test_limits_of_the_first_frequency():
    assert frequency_limits(10.0) == pytest.approx((8.0, 94.76 * 10.0**-0.748))
    assert frequency_limits(40.0) == pytest.approx((23.58 * 40.0**-0.592, 94.76 * 40.0**-0.748))
    assert frequency_limits(3.9) is None and frequency_limits(101.0) is None
    below, above = frequency_limits(20.0), frequency_limits(20.0 + 1e-9)
    assert below[0] == pytest.approx(above[0], rel=2e-3)  # the two branches meet


CHART = {
    "line_speed": 180 / 3.6,
    "span": 25.0,
    "continuous": False,
    "simple": True,
    "first_frequency": 4.5,
}


@pytest.mark.parametrize(
    ("change", "required", "said"),
    [
        ({}, False, "n0 = 4.5 Hz within"),
        ({"line_speed": 200 / 3.6}, False, "line speed up to 200 km/h"),
        ({"continuous": True, "first_frequency": 1.0}, False, "continuous bridge"),
        ({"first_frequency": 1.0}, None, "outside 3.51 to 8.53 Hz; torsional frequency not known"),
        ({"first_frequency": 1.0, "torsional_frequency": 1.1}, True, "n_T is not above 1.2 n0"),
        ({"line_speed": 300 / 3.6, "span": 50.0, "first_frequency": 9.0}, None, "outside"),
        ({"span": 120.0}, None, "no limits of n0"),
        ({"line_speed": 300 / 3.6, "simple": False}, True, "no simple structure"),
        ({"line_speed": 300 / 3.6, "span": 40.0, "first_frequency": 3.0}, False, "within"),
        ({"line_speed": 300 / 3.6}, None, "torsional frequency not known"),
        ({"line_speed": 300 / 3.6, "torsional_frequency": 5.0}, True, "n_T is not above"),
        ({"line_speed": 300 / 3.6, "torsional_frequency": 9.0}, None, "tables F.1 and F.2"),
    ],
)
def test_flow_chart(change, required, said):
    need = need_of_dynamic_analysis(**(CHART | change))
    assert need.required is required
    assert said in "; ".join(need.path)


def test_trains_and_speeds():
    assert load_model([6.9], simple=True) == "HSLM-B"
    assert load_model([7.0], simple=True) == "HSLM-A"
    assert load_model([6.0, 6.0], simple=False) == "HSLM-A"
    found = resonance_speeds([4.0, 16.0], 18.0, orders=4, lowest=40.0, highest=100.0)
    assert found == [(72.0, 1, 1), (72.0, 2, 4), (96.0, 2, 3)]
    speeds = speeds_to_analyze(250 / 3.6, step=5.0, critical=[72.0])
    assert speeds[0] == 40.0 and speeds[-1] == pytest.approx(1.2 * 250 / 3.6)
    assert np.all(np.diff(speeds) > 0.0) and np.diff(speeds).max() <= 5.0 + 1e-9
    assert {69.5, 70.75, 72.0, 73.25, 74.5} <= set(speeds.tolist())
    assert speeds_to_analyze(30.0)[-1] == pytest.approx(36.0)  # a line slower than 40 m/s


# EN 1991-2 table 6.3: number of intermediate coaches, coach length D and bogie axle spacing d of HSLM-A1 to A10.
HSLM_A = [
    *((18, 18, 2.0), (17, 19, 3.5), (16, 20, 2.0), (15, 21, 3.0), (14, 22, 2.0)),
    *((13, 23, 2.0), (13, 24, 2.0), (12, 25, 2.5), (11, 26, 2.0), (11, 27, 2.0)),
]


@pytest.mark.parametrize(("coaches", "length", "spacing"), HSLM_A)
def test_regular_distance_of_load_trains(coaches, length, spacing):
    begin = 17.0 + 0.5 * 3.525
    end = begin + (coaches + 2) * length + 0.5 * 3.525 + 17.0
    ends = [0.0, 3.0, 14.0, 17.0, 20.525, 20.525 + spacing]
    shared = [
        begin + i * length + side for i in range(1, coaches + 2) for side in (-spacing / 2, spacing / 2)
    ]
    axles = np.array(sorted([*ends, *shared, *(end - x for x in ends)]))
    assert len(axles) == 2 * coaches + 14
    assert regular_distance(np.full(len(axles), 2e5), axles) == pytest.approx(length, rel=0.01)


def test_an_irregular_train_has_no_distance():
    rng = np.random.default_rng(5)
    behind = np.sort(rng.uniform(0.0, 400.0, 60))
    assert regular_distance(np.full(60, 1e5), behind - behind[0]) is None
    assert regular_distance(np.full(4, 1e5), np.array([0.0, 18.0, 36.0, 54.0])) is None


@pytest.mark.parametrize(
    "call",
    [
        lambda: phi_dash(10.0, 0.0, 4.0),
        lambda: phi_dash(-1.0, 10.0, 4.0),
        lambda: phi2(-1.0),
        lambda: structural_damping("steel", 0.0),
        lambda: added_damping(math.nan),
        lambda: resonance_speeds([4.0], 0.0),
        lambda: speeds_to_analyze(0.0),
    ],
)
def test_what_must_be_positive(call):
    with pytest.raises(InputError, match="must be positive"):
        call()


def test_types_of_bridges_are_named():
    with pytest.raises(InputError, match="must be one of steel, composite, prestressed-concrete"):
        structural_damping("timber", 20.0)
