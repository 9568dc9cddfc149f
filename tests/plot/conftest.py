"""Results to draw."""

import numpy as np
import pytest

from axlespan.bridges.spans import simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.errors import Outcome
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.result import VARIABLES, Result
from axlespan.interaction.simulate import simulate
from axlespan.irregularity import Harmonic
from axlespan.vehicles.simple import sprung_mass
from axlespan.vehicles.train import Train


def make_result(n_time=200, time_step=0.01, seed=11, checks=None, **names):
    """A result of random numbers with the names given."""
    rng = np.random.default_rng(seed)
    names = {
        dimension: tuple(names.get(dimension, ()))
        for dimension in ("sensor", "contact", "vehicle_dof", "support")
    }
    histories = {
        name: rng.standard_normal((n_time, len(names[dimension])))
        for name, (dimension, _, _) in VARIABLES.items()
    }
    time = time_step * np.arange(n_time)
    histories["contact_position"] = np.subtract.outer(20.0 * time, 3.0 * np.arange(len(names["contact"])))
    static = dict.fromkeys(names["contact"], 50e3)
    return Result(
        time=time,
        **names,
        **histories,
        outcome=Outcome("completed", ""),
        checks={"static_contact_force": static} if checks is None else checks,
    )


@pytest.fixture
def make():
    """The maker of random results."""
    return make_result


@pytest.fixture(scope="session")
def crossings():
    """N12's examples 3.1 and 3.2: crossings by number."""
    bridge = simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=50
    )
    mass = sprung_mass(mass=5750.0, stiffness=1.595e6)
    rough = Harmonic(amplitude=0.5e-3, wavelength=5.0, start=0.0, stop=25.0)
    return {
        "3.1": Crossing(bridge, Train.of(mass), speed=100.0 / 3.6),
        "3.2": Crossing(bridge, Train.of(mass, 50, 3.0), speed=47.7 / 3.6, irregularity=rough),
    }


@pytest.fixture(scope="session")
def single(crossings):
    """Example 3.1, computed."""
    return simulate(crossings["3.1"], time_step=1e-3, steps=900, method=Alpha(0.0), sensors={"midspan": 12.5})


@pytest.fixture(scope="session")
def train(crossings):
    """Example 3.2, computed."""
    return simulate(
        crossings["3.2"], time_step=1e-3, steps=14_000, method=Alpha(0.0), sensors={"midspan": 12.5}
    )
