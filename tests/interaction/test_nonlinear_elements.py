"""A user's nonlinear element in a crossing, against a march on all d.o.f. and against a spring of the same law."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.optimize import fsolve

import axlespan as asp
from axlespan.dynamics.integrator import Matrices, State
from axlespan.dynamics.newton import NewtonIntegrator
from axlespan.errors import AnalysisError, InputError
from axlespan.model.nonlinear import PowerSpring
from axlespan.model.nonlinear_elements import with_nonlinear_element
from axlespan.vehicles.nonlinear import with_nonlinear_spring

LENGTH, SPEED, DT, STEPS, LOAD = 25.0, 50.0, 1e-3, 500, 3e5
PAIR = np.array([[1.0, -1.0], [-1.0, 1.0]])


def bridge():
    return asp.bridges.simple_span(
        length=LENGTH, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=8
    )


class Link:
    """Between two d.o.f.: k e³ + c ė + a spring that slides at a force, e = u_1 - u_2."""

    k, c, elastic, slide = 4e11, 3e5, 5e7, 2e4

    def _parts(self, u, v, state):
        plastic = 0.0 if state is None else state
        e, rate = u[0] - u[1], v[0] - v[1]
        trial = self.elastic * (e - plastic)
        return e, rate, plastic, float(np.clip(trial, -self.slide, self.slide)), abs(trial) < self.slide

    def force(self, u, v, state):
        e, rate, _, friction, _ = self._parts(u, v, state)
        return (self.k * e**3 + self.c * rate + friction) * np.array([1.0, -1.0])

    def tangent(self, u, v, state):
        e, _, _, _, sticks = self._parts(u, v, state)
        return (3.0 * self.k * e**2 + self.elastic * sticks) * PAIR, self.c * PAIR

    def advanced(self, u, v, state):
        e, _, _, friction, _ = self._parts(u, v, state)
        return e - friction / self.elastic


class Whole:
    """The link on all d.o.f. of the body, from its state under own weight on."""

    def __init__(self, link, rows, u_0, memory):
        self.link, self.rows, self.u_0, self.memory = link, rows, u_0, memory
        self.held = link.force(rows @ u_0, np.zeros(2), memory)

    def force(self, u, v, state):
        own = self.memory if state is None else state
        return self.rows.T @ (self.link.force(self.rows @ (self.u_0 + u), self.rows @ v, own) - self.held)

    def tangent(self, u, v, state):
        own = self.memory if state is None else state
        k, c = self.link.tangent(self.rows @ (self.u_0 + u), self.rows @ v, own)
        return tuple(sp.csr_array(self.rows.T @ part @ self.rows) for part in (k, c))

    def advanced(self, u, v, state):
        own = self.memory if state is None else state
        return self.link.advanced(self.rows @ (self.u_0 + u), self.rows @ v, own)


@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_an_element_equals_a_newton_march_on_all_dofs(alpha):
    """A force crosses; deflections over time to 1e-9 of the largest one."""
    link, method, plain = Link(), asp.Alpha(alpha), bridge()
    system = plain.system
    held = with_nonlinear_element(plain, link, ["n3.z", "n6.z"])
    train = asp.Train.of(asp.vehicles.axle_loads(loads=LOAD))
    result = asp.simulate(
        asp.Crossing(held, train, speed=SPEED),
        time_step=DT,
        steps=STEPS,
        method=method,
        sensors={"near": LENGTH * 0.25, "middle": 0.5 * LENGTH},
    )
    for check in ("energy_residual", "equilibrium_residual"):
        assert result.checks[check] < 1e-9
    assert result.facts["newton_iterations_per_step"].max() <= 6

    free, blocks = system.free, system.partition
    position = {int(dof): i for i, dof in enumerate(free)}
    rows = np.zeros((2, len(free)))
    for i, name in enumerate(("n3.z", "n6.z")):
        dof = np.flatnonzero(np.asarray(system.elimination[[system.dof(name)]].todense()).ravel())
        rows[i, position[int(dof[0])]] = 1.0
    stiffness, weight = blocks.K_FF.toarray(), system.weight(9.81)[free]

    def rest(u):
        return stiffness @ u + rows.T @ link.force(rows @ u, np.zeros(2), None) - weight

    u_0 = fsolve(rest, np.linalg.solve(stiffness, weight), xtol=1e-14)
    memory = link.advanced(rows @ u_0, np.zeros(2), None)
    size = LENGTH / 8

    def force(t):  # cubic shape functions of one element
        x = SPEED * t
        total = np.zeros(len(system.dof_names))
        if 0.0 < x < LENGTH:
            node = min(int(x / size), 7)
            s = x / size - node
            shapes = [1 - 3 * s**2 + 2 * s**3, 3 * s**2 - 2 * s**3]
            turns = [-size * (s - 2 * s**2 + s**3), -size * (s**3 - s**2)]  # dw/dx = -ry
            for k in range(2):
                total[system.dof(f"n{node + k + 1}.z")] -= LOAD * shapes[k]
                total[system.dof(f"n{node + k + 1}.ry")] -= LOAD * turns[k]
        return np.asarray(system.elimination.T @ total)[free]

    march = NewtonIntegrator(
        Matrices(blocks.K_FF, blocks.M_FF), [Whole(link, rows, u_0, memory)], method, DT, tolerance=1e-12
    ).march(State.at_rest((len(free),)), force, STEPS)
    own = march.displacement @ rows[0]
    size_of = np.abs(own).max()
    np.testing.assert_allclose(result.sensor_displacement[:, 0], own, rtol=0.0, atol=1e-9 * size_of)
    linear = asp.simulate(
        asp.Crossing(plain, train, speed=SPEED), time_step=DT, steps=STEPS, method=method, sensors={"a": 6.25}
    )
    assert np.abs(linear.sensor_displacement[:, 0] - own).max() > 0.02 * size_of


class Cubic:
    """Between two d.o.f.: k |e| e."""

    def force(self, u, v, state):
        e = u[0] - u[1]
        return 2e8 * abs(e) * e * np.array([1.0, -1.0])

    def tangent(self, u, v, state):
        return 4e8 * abs(u[0] - u[1]) * PAIR, np.zeros((2, 2))

    def advanced(self, u, v, state):
        return None


def test_an_element_in_a_vehicle_is_a_spring_of_its_law():
    car = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, damping=20e3, unsprung_mass=800.0)
    dofs = ["body.z", "wheel1.z"]
    by_element = with_nonlinear_element(car, Cubic(), dofs)
    by_spring = with_nonlinear_spring(car, PowerSpring(2e8, 2.0), {dofs[0]: 1.0, dofs[1]: -1.0})
    waves = asp.irregularity.Harmonic(amplitude=3e-3, wavelength=6.0)
    force = [
        asp.simulate(
            asp.Crossing(bridge(), asp.Train.of(one), speed=40.0, irregularity=waves),
            time_step=DT,
            steps=300,
            contact="unilateral",
        ).contact_force
        for one in (by_element, by_spring, car)
    ]
    np.testing.assert_allclose(force[0], force[1], rtol=1e-9, atol=1e-3)
    assert np.abs(force[0] - force[2]).max() > 1e3


class Wild(Cubic):
    """A force that no tangent tells of."""

    def force(self, u, v, state):
        return np.array([1.0, -1.0]) * (1e7 if np.sin(1e12 * (u[0] - u[1])) > 0.0 else -1e7)


def test_no_convergence_is_an_outcome_with_step_dof_and_remedy():
    car = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, unsprung_mass=800.0)
    wild = with_nonlinear_element(car, Wild(), ["body.z", "wheel1.z"], name="damper")
    crossing = asp.Crossing(bridge(), asp.Train.of(wild), speed=40.0)
    with pytest.raises(AnalysisError, match=r"^step \d+, .* did not converge .* spring 1\.damper\.[12]"):
        asp.simulate(crossing, time_step=DT, steps=30)


@pytest.mark.parametrize(
    ("dofs", "words"),
    [
        (["n3.z", "n3.z"], "each once"),
        ([], "must name"),
        (["n3.z", "n4.z", "n5.z"], r"shape \(3,\)"),
        (["n3.q", "n4.z"], "n3.q"),
    ],
)
def test_wrong_elements(dofs, words):
    with pytest.raises(InputError, match=words):
        with_nonlinear_element(bridge(), Cubic(), dofs)


class Ends(Cubic):
    """An element with a mistake that shows after some steps."""

    steps = 0

    def advanced(self, u, v, state):
        self.steps += 1
        return [0.0, 1.0][self.steps // 40]


def test_an_error_in_an_element_ends_the_run_and_keeps_its_history():
    car = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, unsprung_mass=800.0)
    wrong = with_nonlinear_element(car, Ends(), ["body.z", "wheel1.z"])
    crossing = asp.Crossing(bridge(), asp.Train.of(wrong), speed=40.0)
    words = r"^element Ends fails in advanced: IndexError: list index out of range \(test_nonlinear_elements\.py, line \d+\)$"
    with pytest.raises(AnalysisError, match=words) as caught:
        asp.simulate(crossing, time_step=DT, steps=300)
    assert len(caught.value.result.time) == 80


class Late(Cubic):
    """An element that says something else from a displacement on."""

    def __init__(self, force=None, tangent=None):
        self.own, self.slope = force, tangent

    def force(self, u, v, state):
        return self.own(u) if self.own and abs(u[0]) > 1e-4 else super().force(u, v, state)

    def tangent(self, u, v, state):
        return self.slope(u) if self.slope and abs(u[0]) > 1e-4 else super().tangent(u, v, state)


@pytest.mark.parametrize(
    ("late", "words"),
    [
        (Late(lambda u: np.zeros(3)), r"says an array of the shape \(3,\) in force; it must have the shape \(2,\)"),
        (Late(lambda u: ["a", "b"]), r"says what are no numbers in force: could not convert string to float"),
        (Late(lambda u: None), r"(says an array of the shape \(\) in force|says what are no numbers in force)"),
        (Late(None, lambda u: 3.0), r"says no pair of derivatives, to u and to v, in tangent"),
        (Late(None, lambda u: (np.eye(2), np.zeros(2))), r"of the shape \(2,\) in tangent; .* shape \(2, 2\)"),
        (Late(lambda u: exit_with(5)), r"fails in force: SystemExit: 5 \(test_nonlinear_elements\.py, line \d+\)"),
        (Late(lambda u: np.linalg.inv(np.zeros((2, 2))) @ u),
         r"fails in force: LinAlgError: Singular matrix \(test_nonlinear_elements\.py, line \d+\)"),
        (Late(lambda u: np.nan * u), r"did not converge as a whole, nor in 16 parts of \S+ s "
         r"\(the last one tried: 1 iteration, the force at spring 1\.element\.1 is not a number\)"),
    ],
)  # fmt: skip
def test_what_is_said_of_an_element_that_fails_late(late, words):
    car = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, unsprung_mass=800.0)
    wrong = with_nonlinear_element(car, late, ["body.z", "wheel1.z"])
    waves = asp.irregularity.Harmonic(amplitude=3e-3, wavelength=6.0)
    crossing = asp.Crossing(bridge(), asp.Train.of(wrong), speed=40.0, irregularity=waves)
    with pytest.raises(AnalysisError, match=words) as caught:
        asp.simulate(crossing, time_step=DT, steps=300)
    assert 1 < len(caught.value.result.time) < 300


def exit_with(code):
    raise SystemExit(code)


class Careless(Cubic):
    """It changes what it is handed, and keeps it."""

    def force(self, u, v, state):
        result = super().force(u, v, state)
        u *= 3.0
        v += 1.0
        return result

    def advanced(self, u, v, state):
        return u, v


def test_what_an_element_does_to_its_arguments_stays_with_it():
    def moved(element):
        car = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, unsprung_mass=800.0)
        held = with_nonlinear_element(car, element, ["body.z", "wheel1.z"])
        waves = asp.irregularity.Harmonic(amplitude=3e-3, wavelength=6.0)
        crossing = asp.Crossing(bridge(), asp.Train.of(held), speed=40.0, irregularity=waves)
        return asp.simulate(crossing, time_step=DT, steps=100).contact_force

    np.testing.assert_array_equal(moved(Careless()), moved(Cubic()))


class Stay:
    """A cable to the ground beside the bridge, which pulls up only."""

    def force(self, u, v, state):
        return np.minimum(2e7 * u, 0.0)

    def tangent(self, u, v, state):
        return np.diag(np.where(u < 0.0, 2e7, 0.0)), np.zeros((1, 1))

    def advanced(self, u, v, state):
        return None


@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_an_element_may_stand_on_the_ground_beside_the_structure(alpha):
    """Supports and the cable carry the load together: a slow force is shared as statics has it."""
    train = asp.Train.of(asp.vehicles.axle_loads(loads=1e5))
    crossing = asp.Crossing(with_nonlinear_element(bridge(), Stay(), ["n5.z"]), train, speed=0.5)
    result = asp.simulate(crossing, time_step=0.05, steps=1000, method=asp.Alpha(alpha), sensors={"m": 12.5})
    assert result.checks["equilibrium_residual"] < 1e-11
    pulls = -2e7 * result.sensor_displacement[:, 0]
    total = result.support_reaction.sum(axis=1) + pulls
    on = (result.contact_position[:, 0] > 0.5) & (result.contact_position[:, 0] < 24.5)
    np.testing.assert_allclose(total[on], 1e5, rtol=0.01)
    k = int(np.argmin(np.abs(result.contact_position[:, 0] - 12.5)))
    beam = 48.0 * 2.87e9 * 2.90 / LENGTH**3
    assert pulls[k] == pytest.approx(1e5 * 2e7 / (2e7 + beam), rel=0.01)
