"""Damage and temperature: stiffness that is lost, checked against closed forms."""

import numpy as np
import pytest

from axlespan.bridges import continuous_beam, simple_span
from axlespan.bridges.condition import Damage, in_condition
from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import factorize

L, E, I = 20.0, 34e9, 0.5  # noqa: E741
SPAN = {"length": L, "youngs_modulus": E, "second_moment": I, "mass_per_length": 12e3, "elements": 16}


def frequencies(structure, count=2):
    blocks = structure.system.partition
    return lowest_modes(blocks.K_FF, blocks.M_FF, count).frequencies


def deflection(structure, x):
    """Deflection at midspan under a unit force at x."""
    path, system = structure.line(), structure.system
    rows = path.rows(np.array([x, L / 2]), system.size).toarray()[:, system.free]
    return float(rows[1] @ factorize(system.partition.K_FF).solve(rows[0].copy()))


def test_temperature_scales_all_stiffness():
    whole = simple_span(**SPAN)
    warm = in_condition(whole, stiffness=0.81)
    assert frequencies(warm) == pytest.approx(0.9 * frequencies(whole), rel=1e-9)
    assert in_condition(whole) is whole


def test_a_damaged_zone_deflects_by_the_unit_load_method():
    # δ = ∫ M m / EI with M = m = x/2 for a unit force at midspan; in the zone 1/EI is larger
    whole, zone = simple_span(**SPAN), Damage(5.0, 7.5, 0.6)  # two elements
    more = (1.0 / 0.6 - 1.0) / (E * I) * (7.5**3 - 5.0**3) / 12.0
    found = deflection(in_condition(whole, [zone]), L / 2) - deflection(whole, L / 2)
    assert found == pytest.approx(more, rel=1e-6)


def test_a_zone_within_an_element_has_the_mean_flexibility():
    whole = simple_span(**SPAN)
    half = in_condition(whole, [Damage(5.0, 5.625, 0.5)])
    mean = in_condition(whole, [Damage(5.0, 6.25, 1.0 / 1.5)])
    assert frequencies(half) == pytest.approx(frequencies(mean), rel=1e-12)


def test_zones_that_overlap_multiply():
    whole = simple_span(**SPAN)
    two = in_condition(whole, [Damage(5.0, 10.0, 0.8), Damage(7.5, 12.5, 0.5)])
    one = in_condition(whole, [Damage(5.0, 7.5, 0.8), Damage(7.5, 10.0, 0.4), Damage(10.0, 12.5, 0.5)])
    assert frequencies(two, 4) == pytest.approx(frequencies(one, 4), rel=1e-10)


def test_mass_and_interpolation_stay_with_shear_too():
    whole = simple_span(**SPAN, area=2.0, shear_area=1.2)
    soft = in_condition(whole, [Damage(0.0, L, 0.5)])
    assert soft.system.total_mass() == whole.system.total_mass()
    assert deflection(soft, 8.0) == pytest.approx(2.0 * deflection(whole, 8.0), rel=1e-9)


def test_what_cannot_be():
    whole = continuous_beam(
        spans=[10.0, 12.0], youngs_modulus=E, second_moment=I, mass_per_length=12e3, elements=6
    )
    with pytest.raises(InputError, match=r"damage\.1\.from = 30\.0: lies beside the structure"):
        in_condition(whole, [Damage(2.0, 4.0, 0.5), Damage(30.0, 31.0, 0.5)])
    with pytest.raises(InputError, match=r"to = 1\.0: must be greater than from"):
        Damage(2.0, 1.0, 0.5)
    with pytest.raises(InputError, match=r"stiffness = 0\.0: must be positive"):
        Damage(1.0, 2.0, 0.0)
