"""Nonlinear springs in the structure: against plain Newton iterations on all d.o.f., coded here from scratch."""

import numpy as np
import pytest

from axlespan.dynamics.alpha import Alpha
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.model.nonlinear import (
    BilinearHysteresis,
    MultilinearDashpot,
    MultilinearSpring,
    PowerDashpot,
    PowerSpring,
    UnilateralSpring,
)
from axlespan.running.line import path_on_beams
from axlespan.running.structure import MAIN_LINE, Structure
from axlespan.vehicles.simple import axle_loads, sprung_mass
from axlespan.vehicles.train import Train

N, H = 16, 0.6  # bays and sleeper spacing [m]
EI, M, PAD, PAD_C, SLEEPER, BALLAST, BALLAST_C = 6.4e6, 60.0, 1.2e8, 4e4, 160.0, 6e7, 3e4
HANGING, GAP = (7, 8), 1e-3
MASS, STIFF, DASH, G = 6000.0, 1.2e6, 1.5e4, 9.81
DT, STEPS, SPEED = 5e-4, 420, 40.0


def track(law=None, gaps=(), extra=None):
    """Rail on pads, sleepers and one ballast spring of a law under each."""
    model = Model(plane=True)
    x = np.arange(N + 1) * H
    model = model.with_nodes(np.column_stack([x, np.zeros(N + 1)]), [f"rail{i}" for i in range(N + 1)])
    model = model.with_nodes(np.column_stack([x, -0.2 + 0 * x]), [f"sleeper{i}" for i in range(N + 1)])
    model = model.with_nodes(np.column_stack([x, -0.5 + 0 * x]), [f"ground{i}" for i in range(N + 1)])
    rail, sleeper, ground = (np.arange(N + 1) + k * (N + 1) for k in range(3))
    properties = BeamProperties(bending_stiffness_y=EI, mass_per_length=M)
    model = model.with_beams(np.column_stack([rail[:-1], rail[1:]]), properties, name="rail")
    model = model.with_springs(np.column_stack([sleeper, rail]), {"z": PAD}, {"z": PAD_C}, name="pads")
    for node in sleeper:
        model = model.with_mass(int(node), SLEEPER, directions=("z",))
    gap = np.zeros(N + 1)
    gap[list(gaps)] = GAP
    model = model.with_springs(np.column_stack([ground, sleeper]), {}, {"z": BALLAST_C}, name="dashpots")
    law = law or UnilateralSpring(BALLAST)
    model = model.with_nonlinear_springs(np.column_stack([ground, sleeper]), law, gap=gap, name="ballast")
    if extra is not None:
        model = extra(model)
    model = model.with_supports(ground.tolist(), ["z"], name="ground")
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, range(N + 1))
    return Structure(compiled.system, {MAIN_LINE: path}, name="track", model=model)


class PlainTrack:
    """The same track and one sprung mass with a massless wheel, all dense; displacements from the unloaded state."""

    def __init__(self, ballast):
        """``ballast(e)`` gives force and slope (n,) of the ballast springs, tension positive."""
        n_rail, n = 2 * (N + 1), 3 * (N + 1) + 2
        self.n, self.n_rail, self.ballast = n, n_rail, ballast
        K, Mm, C = (np.zeros((n, n)) for _ in range(3))
        k = EI / H**3 * np.array(
            [[12, 6 * H, -12, 6 * H], [6 * H, 4 * H**2, -6 * H, 2 * H**2],
             [-12, -6 * H, 12, -6 * H], [6 * H, 2 * H**2, -6 * H, 4 * H**2]])  # fmt: skip
        m = M * H / 420 * np.array(
            [[156, 22 * H, 54, -13 * H], [22 * H, 4 * H**2, 13 * H, -3 * H**2],
             [54, 13 * H, 156, -22 * H], [-13 * H, -3 * H**2, -22 * H, 4 * H**2]])  # fmt: skip
        for e in range(N):
            at = np.ix_(range(2 * e, 2 * e + 4), range(2 * e, 2 * e + 4))
            K[at] += k
            Mm[at] += m
        self.sleepers = n_rail + np.arange(N + 1)
        for i, s in enumerate(self.sleepers):
            pair = np.ix_([2 * i, s], [2 * i, s])
            K[pair] += PAD * np.array([[1, -1], [-1, 1]])
            C[pair] += PAD_C * np.array([[1, -1], [-1, 1]])
            C[s, s] += BALLAST_C
            Mm[s, s] += SLEEPER
        body, wheel = n - 2, n - 1
        pair = np.ix_([body, wheel], [body, wheel])
        K[pair] += STIFF * np.array([[1, -1], [-1, 1]])
        C[pair] += DASH * np.array([[1, -1], [-1, 1]])
        Mm[body, body] += MASS
        self.K, self.C, self.M = K, C, Mm
        self.weight = -G * Mm @ self.vertical()
        self.wheel, self.body = wheel, body

    def vertical(self):
        t = np.zeros(self.n)
        t[: self.n_rail : 2] = 1.0
        t[self.n_rail :] = 1.0
        return t

    def row(self, s):
        """Displacement of the rail under a wheel at s, less that of the wheel."""
        row = np.zeros(self.n)
        if 0.0 <= s <= N * H:
            e = min(int(s / H), N - 1)
            x = s / H - e
            row[2 * e : 2 * e + 4] = [1 - 3 * x**2 + 2 * x**3, H * (x - 2 * x**2 + x**3),
                                      3 * x**2 - 2 * x**3, H * (x**3 - x**2)]  # fmt: skip
        row[self.wheel] -= 1.0
        return row

    def inner(self, u, v):
        force, slope = self.ballast(u[self.sleepers])
        result = self.K @ u + self.C @ v
        result[self.sleepers] += force
        tangent = self.K.copy()
        tangent[self.sleepers, self.sleepers] += slope
        return result, tangent

    def rest(self):
        """Track and vehicle at rest, each on its own: the vehicle stands on rigid ground before the track."""
        u = np.zeros(self.n)
        row = self.row(-1.0)
        X = MASS * G
        for _ in range(60):
            inner, tangent = self.inner(u, 0 * u)
            rest = np.concatenate([inner - self.weight + row * X, [row @ u]])
            J = np.block([[tangent, row[:, None]], [row[None], np.zeros((1, 1))]])
            step = np.linalg.solve(J, rest)
            u, X = u - step[:-1], X - step[-1]
            if np.abs(step).max() < 1e-14 * max(1.0, abs(X)):
                break
        return u, X

    def march(self, start, method):
        al, be, ga = method.alpha, method.beta, method.gamma
        u, X = self.rest()
        level = u.copy()  # the line is level under its own weight
        v = np.zeros(self.n)
        a = np.zeros(self.n)
        row = self.row(start)
        out = [(u, X)]
        f_old = self.weight - self.inner(u, v)[0] - row * X
        for step in range(1, STEPS + 1):
            row = self.row(start + SPEED * DT * step)
            pu, pv = u + DT * v + (0.5 - be) * DT**2 * a, v + (1 - ga) * DT * a
            new, force = a.copy(), X
            for _ in range(40):
                w, dw = pu + be * DT**2 * new, pv + ga * DT * new
                inner, tangent = self.inner(w, dw)
                f = self.weight - inner - row * force
                rest = np.concatenate(
                    [self.M @ new - (1 + al) * f + al * f_old, [row @ (w - level) / (be * DT**2)]]
                )
                A = self.M + (1 + al) * (ga * DT * self.C + be * DT**2 * tangent)
                J = np.block([[A, (1 + al) * row[:, None]], [row[None], np.zeros((1, 1))]])
                change = np.linalg.solve(J, rest)
                new, force = new - change[:-1], force - change[-1]
                if np.abs(change[:-1]).max() < 1e-11:
                    break
            a, X = new, force
            u, v, f_old = w - be * DT**2 * change[:-1], dw - ga * DT * change[:-1], f
            f_old = self.weight - self.inner(u, v)[0] - row * X
            out.append((u, X))
        return np.array([state for state, _ in out]), np.array([x for _, x in out])


def unilateral(gaps):
    gap = np.zeros(N + 1)
    gap[list(gaps)] = GAP

    def law(e):
        total = e + gap
        return BALLAST * np.minimum(total, 0.0), BALLAST * (total < 0.0)

    return law


TRAIN = Train.of(sprung_mass(mass=MASS, stiffness=STIFF, damping=DASH))


@pytest.fixture(scope="module")
def hanging():
    structure = track(gaps=HANGING)
    crossing = Crossing(structure, TRAIN, speed=SPEED, start=-0.5)
    sensors = {"over": HANGING[0] * H, "between": (HANGING[0] + 0.5) * H, "next": (HANGING[1] + 1) * H}
    method = Alpha(-0.1)
    result = simulate(crossing, time_step=DT, steps=STEPS, method=method, sensors=sensors)
    return result, PlainTrack(unilateral(HANGING)).march(-0.5, method), structure


def test_hanging_sleepers_equal_a_plain_newton_code(hanging):
    """Deflections and forces to 1e-6 of their peaks, with sleepers that hang, touch down and let go."""
    result, (u, force), _ = hanging
    plain = PlainTrack(unilateral(HANGING))
    rail = u - u[0]
    for name, s in (
        ("over", HANGING[0] * H),
        ("between", (HANGING[0] + 0.5) * H),
        ("next", (HANGING[1] + 1) * H),
    ):
        row = plain.row(s)
        row[plain.wheel] = 0.0
        own = result.at("sensor_displacement", name)
        assert np.abs(own - rail @ row).max() < 1e-6 * np.abs(own).max(), name
    assert np.abs(result.contact_force[:, 0] - force).max() < 1e-6 * force.max()
    body = result.at("vehicle_displacement", "1.body.z")
    assert np.abs(body - rail[:, plain.body]).max() < 1e-6 * np.abs(body).max()


def test_a_hanging_sleeper_hangs_and_then_touches(hanging):
    """Preload: the two sleepers do not reach the ballast by themselves, but do under the wheel."""
    result, (u, _), _ = hanging
    sleepers = u[:, 2 * (N + 1) : 3 * (N + 1)]
    assert np.all(sleepers[0, list(HANGING)] > -GAP)
    assert sleepers[:, HANGING[0]].min() < -GAP
    # Reactions of the ground: what the train adds to the weight; a hanging sleeper adds nothing until it touches.
    own = result.support_reaction[:, list(HANGING)]
    before = result.time * SPEED - 0.5 < 2.0
    assert np.abs(own[before]).max() < 0.03 * MASS * G
    assert result.checks["equilibrium_residual"] < 1e-9
    assert result.checks["energy_residual"] < 1e-9


def test_only_springs_that_deviate_are_unknowns(hanging):
    result, _, _ = hanging
    assert result.facts["nonlinear_springs"] == N + 1
    assert result.facts["nonlinear_springs_active"] < N + 1


def test_springs_that_stay_closed_change_nothing():
    """A unilateral ballast that never parts is a linear one."""
    heavy = Model.with_mass
    structure = track(extra=lambda m: heavy(m, "sleeper0", 1.0, directions=("z",)))
    crossing = Crossing(structure, Train.of(axle_loads(loads=3e3)), speed=SPEED)
    own = simulate(crossing, time_step=DT, steps=200, sensors={"x": 4.0})
    model = structure.model
    parts = tuple(part for part in model.parts if part.name != "ballast")
    from dataclasses import replace

    linear = replace(model, parts=parts).with_springs(
        np.column_stack([np.arange(N + 1) + 2 * (N + 1), np.arange(N + 1) + N + 1]), {"z": BALLAST}
    )
    compiled = compile_model(linear)
    other = Structure(
        compiled.system, {MAIN_LINE: path_on_beams(linear, compiled.table, range(N + 1))}, model=linear
    )
    plain = simulate(
        Crossing(other, Train.of(axle_loads(loads=3e3)), speed=SPEED),
        time_step=DT, steps=200, sensors={"x": 4.0},
    )  # fmt: skip
    scale = np.abs(plain.sensor_displacement).max()
    assert np.abs(own.sensor_displacement - plain.sensor_displacement).max() < 1e-9 * scale


LAWS = {
    "unilateral with dashpot": UnilateralSpring(3e6, 2e4),
    "power": PowerSpring(4e9, 2.0),
    "multilinear": MultilinearSpring([(-2e-3, -9e3), (-1e-3, -6e3), (0.0, 0.0), (1e-3, 2e3)]),
    "hysteresis": BilinearHysteresis(8e6, 2e3, 1e6),
    "power dashpot": PowerDashpot(3e4, 1.5),
    "multilinear dashpot": MultilinearDashpot([(-0.1, -2e3), (0.0, 0.0), (0.05, 2e3)]),
}


def two_masses(law):
    """A beam of one element is the path; below hangs a mass on the law's spring, and stands on a linear one."""
    model = Model(plane=True).with_nodes([[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [2.0, -1.0], [2.0, -2.0]])
    beam = BeamProperties(bending_stiffness_y=2e7, mass_per_length=400.0)
    model = model.with_beams([[0, 2], [2, 1]], beam, name="beam").with_mass(3, 300.0, directions=("z",))
    model = model.with_springs([[3, 4]], {"z": 2e6}, {"z": 1e3})
    model = model.with_nonlinear_springs([[3, 2]], law, name="law")
    model = model.with_support(0, ["z"], name="left").with_support(1, ["z"], name="right")
    model = model.with_support(4, ["z"], name="ground")
    compiled = compile_model(model)
    return Structure(
        compiled.system, {MAIN_LINE: path_on_beams(model, compiled.table, [0, 2, 1])}, model=model
    )


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_each_law_equals_a_plain_newton_march(name, alpha):
    """Full Newton on the free d.o.f. under a given moving force, with the law's formulas written here."""
    law, dt, steps, load, speed = LAWS[name], 1e-3, 250, 3e4, 12.0
    structure = two_masses(law)
    crossing = Crossing(structure, Train.of(axle_loads(loads=load)), speed=speed)
    method = Alpha(alpha)
    result = simulate(crossing, time_step=dt, steps=steps, method=method, sensors={"m": 2.0})
    s = structure.system
    blocks = s.partition
    k_ref = law.stiffness
    b = np.asarray(s.nonlinear[0].rows.toarray())[0][s.free]
    K = blocks.K_FF.toarray() - k_ref * np.outer(b, b)
    Mm, C = blocks.M_FF.toarray(), blocks.C_FF.toarray() - law.reference_damping * np.outer(b, b)
    weight = s.weight(9.81)[s.free]
    path = structure.line()

    def plain(e, r, memory):
        if name == "unilateral with dashpot":
            share = min(max(-e / 1e-6, 0.0), 1.0)  # the dashpot comes in over 1 µm
            f = 3e6 * e + 2e4 * share * r
            coming = -2e4 * r / 1e-6 if share < 1.0 else 0.0
            return (f, 3e6 + coming, 2e4 * share) if e < 0.0 and f < 0.0 else (0.0, 0.0, 0.0)
        if name == "power":
            return 4e9 * e * abs(e), 8e9 * abs(e), 0.0
        if name == "multilinear":
            for low, high, base, k in (
                (-9.0, -1e-3, -3e3, 3e6),
                (-1e-3, 0.0, 0.0, 6e6),
                (0.0, 9.0, 0.0, 2e6),
            ):
                if low <= e < high:
                    return base + k * e, k, 0.0
        if name == "hysteresis":  # hardening modulus of the back force: 1/k_t = 1/k + 1/h
            h = 8e6 * 1e6 / (8e6 - 1e6)
            trial = 8e6 * (e - memory) - h * memory
            over = abs(trial) - 2e3
            if over <= 0.0:
                return 8e6 * (e - memory), 8e6, 0.0
            return 8e6 * (e - memory - np.sign(trial) * over / (8e6 + h)), 1e6, 0.0
        if name == "power dashpot":
            return 3e4 * np.sign(r) * abs(r) ** 1.5, 0.0, 4.5e4 * abs(r) ** 0.5
        return (2e4 * r, 0.0, 2e4) if r < 0.0 else (4e4 * r, 0.0, 4e4)

    def inner(u, v, memory):
        f, kt, ct = plain(b @ u, b @ v, memory)
        return K @ u + C @ v + b * f, kt, ct

    def remembered(u, memory):
        if name != "hysteresis":
            return memory
        return b @ u - plain(b @ u, 0.0, memory)[0] / 8e6

    still, memory = np.zeros(len(K)), 0.0
    row0 = path_row(path, s, 0.0)
    own = np.zeros(len(K))
    for _ in range(200):
        f, kt, _ = inner(own, still, 0.0)
        own = own - np.linalg.solve(K + max(kt, 1e2) * np.outer(b, b), f - weight)
    memory = remembered(own, 0.0)
    base, u = own.copy(), own.copy()
    f, _, _ = inner(u, still, memory)
    v, a = still.copy(), np.linalg.solve(Mm, weight - f - load * row0)
    al, be, ga = method.alpha, method.beta, method.gamma
    old = weight - f - load * row0
    found = [0.0]
    sensor = path_row(path, s, 2.0)
    for step in range(1, steps + 1):
        row = path_row(path, s, speed * dt * step)
        pu, pv, new = u + dt * v + (0.5 - be) * dt**2 * a, v + (1 - ga) * dt * a, a
        for _ in range(60):
            f, kt, ct = inner(pu + be * dt**2 * new, pv + ga * dt * new, memory)
            rest = Mm @ new - (1 + al) * (weight - f - load * row) + al * old
            T = (1 + al) * (be * dt**2 * (K + kt * np.outer(b, b)) + ga * dt * (C + ct * np.outer(b, b)))
            change = np.linalg.solve(Mm + T, rest)
            new = new - change
            if np.abs(change).max() < 1e-10 * max(np.abs(new).max(), 1.0):
                break
        u, v, a = pu + be * dt**2 * new, pv + ga * dt * new, new
        f, _, _ = inner(u, v, memory)
        memory = remembered(u, memory)
        old = weight - f - load * row
        found.append(sensor @ (u - base))
    own = result.at("sensor_displacement", "m")
    assert np.abs(own - np.array(found)).max() < 1e-7 * np.abs(own).max()
    assert result.checks["equilibrium_residual"] < 1e-9
    assert result.checks["energy_residual"] < 1e-9


def path_row(path, system, position):
    row = np.zeros(system.size)
    dofs, weights = path.weights(np.array([position]))
    np.add.at(row, dofs[0], weights[0])
    return row[system.free]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: MultilinearSpring([(0.0, 0.0), (0.0, 1.0)]), "increasing elongations"),
        (lambda: MultilinearSpring([(0.0, 0.0), (1.0, 2.0), (2.0, 1.0)]), "do not fall"),
        (lambda: MultilinearSpring([(0.0, 0.0)]), "two or more pairs"),
        (lambda: MultilinearDashpot([(-1.0, -1.0), (1.0, 2.0)]), r"through \(0, 0\)"),
        (lambda: PowerSpring(1e6, 0.5), "at least 1"),
        (lambda: PowerDashpot(-1.0), "positive"),
        (lambda: UnilateralSpring(0.0), "positive"),
        (lambda: BilinearHysteresis(1e6, 1e3, 2e6), "below the stiffness"),
    ],
)
def test_wrong_laws_are_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()


@pytest.mark.parametrize("name", LAWS)
def test_tangents_are_derivatives(name):
    """By central differences, away from kinks; and a law's energy has its force as derivative where it is elastic."""
    law, rng = LAWS[name], np.random.default_rng(5)
    e, r = rng.uniform(-1.7e-3, 0.7e-3, 50), rng.uniform(-0.08, 0.08, 50)
    state = rng.uniform(-2e-4, 2e-4, (50, law.n_state))
    k, c = law.tangent(e, r, state)
    h = 1e-9
    own_k = (law.force(e + h, r, state) - law.force(e - h, r, state)) / (2 * h)
    own_c = (law.force(e, r + h, state) - law.force(e, r - h, state)) / (2 * h)
    np.testing.assert_allclose(own_k, k, atol=2.0 + 1e-5 * np.abs(k).max())
    np.testing.assert_allclose(own_c, c, atol=2.0 + 1e-5 * np.abs(c).max())
    if name in ("power", "multilinear"):
        slope = (law.energy(e + h, state) - law.energy(e - h, state)) / (2 * h)
        np.testing.assert_allclose(slope, law.force(e, r, state), rtol=1e-5, atol=1e-2)


# --- springs in vehicles ------------------------------------------------------------------------------------


def plain_car(law, method, dt, steps, profile, speed, start):
    """Body and wheel on rigid ground with a bump stop between them: Newton by hand; the wheel is led by the ground."""
    mass, wheel, k, c = 6000.0, 500.0, 1.2e6, 8e3
    al, be, ga = method.alpha, method.beta, method.gamma
    pos = start + speed * dt * np.arange(steps + 1)
    r = profile.value(pos)
    # The wheel's motion follows from the constraint and the Newmark relations, as for every wheel with mass.
    w = np.zeros((steps + 1, 3))
    w[0] = r[0], speed * profile.slope(pos[0]), speed**2 * profile.curvature(pos[0])
    for i in range(steps):
        u, v, a = w[i]
        new = (r[i + 1] - u - dt * v - (0.5 - be) * dt**2 * a) / (be * dt**2)
        w[i + 1] = r[i + 1], v + dt * ((1 - ga) * a + ga * new), new
    z = np.zeros((steps + 1, 3))
    z[0, 0] = r[0]  # at rest where it stands

    def force(u, v, wheel):
        inner, slope = law(u - wheel[0])
        return -k * (u - wheel[0]) - c * (v - wheel[1]) - inner, -k - slope

    f, _ = force(z[0, 0], z[0, 1], w[0])
    z[0, 2] = f / mass
    inner = [-f]
    for i in range(steps):
        u, v, a = z[i]
        old, _ = force(u, v, w[i])
        new = a
        for _ in range(50):
            nu = u + dt * v + (0.5 - be) * dt**2 * a + be * dt**2 * new
            nv = v + dt * ((1 - ga) * a + ga * new)
            f, slope = force(nu, nv, w[i + 1])
            rest = mass * new - (1 + al) * f + al * old
            change = rest / (mass - (1 + al) * (be * dt**2 * slope - ga * dt * c))
            new -= change
            if abs(change) < 1e-13 * max(abs(new), 1.0):
                break
        nu = u + dt * v + (0.5 - be) * dt**2 * a + be * dt**2 * new
        nv = v + dt * ((1 - ga) * a + ga * new)
        z[i + 1] = nu, nv, new
        inner.append(-force(nu, nv, w[i + 1])[0])
    # X: wheel m a = (1+al) (X + q) - al (X + q) of the step before, q = -(spring force) - weight
    net = np.zeros(steps + 1)
    net[0] = wheel * w[0, 2]
    for i in range(steps):
        net[i + 1] = (wheel * w[i + 1, 2] + al * net[i]) / (1 + al)
    return z, net + (mass + wheel) * G - np.array(inner)


@pytest.mark.parametrize("alpha", [0.0, -0.1])
@pytest.mark.parametrize("kind", ["bump stop", "friction"])
def test_springs_in_a_vehicle_equal_a_plain_newton_march(alpha, kind):
    """On rigid ground before the bridge; the suspension works against its bump stop."""
    from axlespan.bridges.spans import simple_span
    from axlespan.irregularity import Harmonic
    from axlespan.vehicles.nonlinear import with_nonlinear_spring

    bridge = simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.9, mass_per_length=2303.0, elements=6
    )
    car = sprung_mass(mass=6000.0, stiffness=1.2e6, damping=8e3, unsprung_mass=500.0)
    waves = Harmonic(amplitude=4e-3, wavelength=9.0)
    if kind == "bump stop":
        law, gap = UnilateralSpring(9e6), 2e-3

        def plain(e):
            return 9e6 * min(e + gap, 0.0), 9e6 * (e + gap < 0.0)
    else:
        law, gap = MultilinearSpring([(-1.0, -1e5 - 1e3), (-1e-4, -1e3), (1e-4, 1e3), (1.0, 1e5 + 1e3)]), 0.0

        def plain(e):
            slope = 1e7 if abs(e) < 1e-4 else 1e5 / (1.0 - 1e-4)
            return (
                (1e7 * e, slope) if abs(e) < 1e-4 else (np.sign(e) * (1e3 + slope * (abs(e) - 1e-4)), slope)
            )

    own = with_nonlinear_spring(car, law, {"body.z": 1.0, "wheel1.z": -1.0}, gap=gap, name=kind)
    method, dt, steps = Alpha(alpha), 1e-3, 300
    crossing = Crossing(bridge, Train.of(own), speed=30.0, start=-9.2, irregularity=waves)
    result = simulate(crossing, time_step=dt, steps=steps + 300, method=method)
    z, force = plain_car(plain, method, dt, steps, waves, 30.0, -9.2)
    body, now = result.at("vehicle_displacement", "1.body.z")[: steps + 1], slice(0, steps + 1)
    if kind == "bump stop":
        assert (result.at("vehicle_displacement", "1.wheel1.z")[now] - body).max() > gap
    assert np.abs(body - z[:, 0])[:290].max() < 1e-8 * np.abs(body).max()
    assert np.abs(result.contact_force[now, 0] - force)[:290].max() < 1e-8 * 6500.0 * G
    assert result.checks["energy_residual"] < 1e-9
    assert result.facts["nonlinear_springs_active"] == 1
