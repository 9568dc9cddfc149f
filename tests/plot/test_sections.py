"""Figures of section forces and envelopes: the curves are the arrays."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.plot.sections import envelope, section_force
from axlespan.plot.style import new_figure


@pytest.fixture(scope="module")
def result():
    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=10
    )
    train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), count=2, spacing=3.0)
    return asp.simulate(
        asp.Crossing(bridge, train, speed=30.0),
        time_step=1e-3,
        steps=900,
        sensors={"mid": 12.5, "quarter": 6.25},
        section_forces=["mid", "quarter"],
        envelopes=["moment", "shear", "deflection"],
    )


def test_moment_over_time(result):
    _, ax = new_figure()
    section_force(result, "moment", ["mid"], ax=ax)
    (curve,) = ax.lines
    assert curve.get_ydata().max() == pytest.approx(1e-3 * result.at("section_moment", "mid").max())
    assert ax.get_ylabel() == "Bending moment [kN m]"
    section_force(result, "shear", ax=ax)
    assert [line.get_label() for line in ax.lines[1:]] == ["mid", "quarter"]


def test_envelope(result):
    figure, ax = new_figure()
    envelope(result, "moment", ax=ax)
    _, top, bottom = ax.lines
    assert np.array_equal(top.get_ydata(), 1e-3 * result.envelopes.of("moment").largest)
    assert np.array_equal(bottom.get_ydata(), 1e-3 * result.envelopes.of("moment").smallest)
    assert ax.yaxis_inverted()
    figure.draw_without_rendering()
    _, ax = new_figure()
    envelope(result, "deflection", ax=ax)
    assert ax.lines[2].get_ydata().min() == pytest.approx(
        1e3 * result.envelopes.of("deflection").smallest.min()
    )


def test_what_there_is_not(result):
    with pytest.raises(asp.InputError, match="quantity = 'stress': must be one of moment, shear"):
        section_force(result, "stress")
    with pytest.raises(asp.InputError, match="quantity = 'torsion': is not among the envelopes"):
        envelope(result, "torsion")
    crossing = asp.Crossing(
        asp.bridges.simple_span(
            length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=4
        ),
        asp.Train.of(asp.vehicles.axle_loads(loads=[1e5], positions=[0.0])),
        speed=30.0,
    )
    plain = asp.simulate(crossing, time_step=1e-2, steps=5)
    with pytest.raises(asp.InputError, match=r"has no section forces.*section_forces=\['midspan'\]"):
        section_force(plain)
    with pytest.raises(asp.InputError, match=r"has no envelopes.*envelopes=\['shear'\]"):
        envelope(plain, "shear")
