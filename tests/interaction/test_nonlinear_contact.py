"""Contact that lets go: against rigid contact, event-driven references, and the energy of both bodies."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from axlespan.bridges.spans import simple_span
from axlespan.contact.laws import Hertz, LinearSpring, Rigid, Unilateral
from axlespan.dynamics.alpha import Alpha
from axlespan.errors import AnalysisError, InputError, Outcome
from axlespan.interaction.convoy import Lane
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.drive import drive
from axlespan.interaction.groundwork import prepare
from axlespan.interaction.nonlinear.march import begin_nonlinear, watch
from axlespan.interaction.plan import plan_for
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.settings import settings_for
from axlespan.interaction.simulate import simulate, simulate_many
from axlespan.interaction.start import StartFactors
from axlespan.irregularity import Harmonic, Table
from axlespan.model.damping import Rayleigh
from axlespan.vehicles.simple import axle_loads, rigid_body, rigid_mass, sprung_mass
from axlespan.vehicles.train import Placement, Train

G = 9.81
SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
BRIDGE = simple_span(elements=10, damping=Rayleigh(0.5, 1e-4), **SPAN)
UNIT = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=20e3, unsprung_mass=500.0)
STATIC = 6250.0 * G
WAVES = Harmonic(amplitude=1e-3, wavelength=6.0)


@dataclass(frozen=True)
class Bump:
    """A bump of a smooth squared sine between two positions, as a profile."""

    start: float
    length: float
    height: float

    def _at(self, x):
        x = np.asarray(x, float)
        xi = (x - self.start) / self.length
        return np.pi * xi, (xi > 0.0) & (xi < 1.0)

    def value(self, x):
        phase, inside = self._at(x)
        return np.where(inside, self.height * np.sin(phase) ** 2, 0.0)

    def slope(self, x):
        phase, inside = self._at(x)
        return np.where(inside, self.height * np.pi / self.length * np.sin(2 * phase), 0.0)

    def curvature(self, x):
        phase, inside = self._at(x)
        return np.where(inside, 2 * self.height * (np.pi / self.length) ** 2 * np.cos(2 * phase), 0.0)


# --- laws agree where nothing parts -------------------------------------------------------------------


@pytest.fixture(scope="module")
def rigid():
    crossing = Crossing(BRIDGE, Train.of(UNIT, 2, 3.0), speed=25.0, irregularity=WAVES)
    return crossing, simulate(crossing, time_step=1e-3, steps=1250, sensors={"m": 12.5})


def test_unilateral_equals_rigid_without_separation(rigid):
    crossing, reference = rigid
    own = simulate(crossing, time_step=1e-3, steps=1250, sensors={"m": 12.5}, contact="unilateral")
    for name in ("contact_force", "vehicle_displacement", "sensor_displacement", "support_reaction"):
        a, b = getattr(own, name), getattr(reference, name)
        assert np.abs(a - b).max() < 1e-9 * np.abs(b).max(), name
    assert own.checks["flight_count"] == 0
    assert reference.contact_force.min() > 0.0


@pytest.mark.parametrize("law", [Hertz, LinearSpring])
def test_stiff_laws_approach_the_rigid_one(rigid, law):
    """The difference falls with the approach under the static force: (1/k)^(2/3) for Hertz, 1/k for a spring."""
    crossing, reference = rigid
    stiffnesses = [1e15, 1e16, 1e17] if law is Hertz else [1e12, 1e13, 1e14]
    order = 2.0 / 3.0 if law is Hertz else 1.0
    errors = []
    for k in stiffnesses:
        own = simulate(crossing, time_step=1e-3, steps=1250, contact=law(k))
        errors.append(np.abs(own.contact_force - reference.contact_force).max() / STATIC)
        assert own.facts["newton_iterations_largest"] <= 20
    slopes = np.diff(np.log(errors)) / np.diff(np.log(stiffnesses))
    assert errors[-1] < 2e-4
    assert np.all(np.abs(slopes + order) < 0.25 * order), (errors, slopes)


def test_nothing_moves_on_a_smooth_rigid_way():
    """The static approach is in the start: before the bridge every law keeps the static state to rounding."""
    placements = tuple(
        Placement(replace(UNIT, contacts=(replace(UNIT.contacts[0], law=law),)), 4.0 * i)
        for i, law in enumerate(
            (Hertz(), Unilateral(), LinearSpring(2e6, 4e3), Rigid(), LinearSpring(tension=True))
        )
    )
    crossing = Crossing(BRIDGE, Train(placements), speed=20.0, start=-8.0)
    result = simulate(crossing, time_step=1e-3, steps=450)
    before = result.time < 0.39
    assert np.abs(result.contact_force[before] / STATIC - 1.0).max() < 1e-9
    assert np.abs(result.vehicle_displacement[before]).max() < 1e-12


def test_a_train_may_mix_laws(rigid):
    """A rigid wheel stays with the line, the one on a tyre has a gap to it of its approach."""
    tyre = replace(UNIT, contacts=(replace(UNIT.contacts[0], law=LinearSpring(5e7, 1e4)),))
    train = Train((Placement(UNIT, 0.0), Placement(tyre, 3.0)))
    crossing = Crossing(BRIDGE, train, speed=25.0, start=-5.0, irregularity=WAVES)
    result = simulate(crossing, time_step=1e-3, steps=350)
    position = result.contact_position
    level = WAVES.value(position)
    gap = level - result.vehicle_displacement[:, [1, 3]]
    assert np.abs(gap[result.time < 0.19, 0]).max() < 1e-12
    rate = np.gradient(gap[:, 1], result.time)
    expected = STATIC + 5e7 * gap[:, 1] + 1e4 * rate
    inner = (result.time > 0.01) & (result.time < 0.19)
    assert np.abs(result.contact_force - expected[:, None])[inner, 1].max() < 5e-4 * STATIC
    assert result.facts["contact_laws"] == ("rigid", "linear-spring")


def test_a_linear_tyre_is_a_suspension_more():
    """A wheel on a linear spring that may pull equals rigid contact under a massless wheel on that spring."""
    body = rigid_body(
        mass=4e3, pitch_inertia=6e3, axles=[0.0, 2.5], stiffness=8e5, damping=1e4, unsprung_mass=300.0
    )
    law = LinearSpring(1.2e6, tension=True)
    bump = Bump(1.0, 6.0, 4e-3)
    crossing = Crossing(BRIDGE, Train.of(body), speed=20.0, irregularity=bump, start=-1.0)
    own = simulate(crossing, time_step=5e-4, steps=600, contact=law, method=Alpha(-0.1), footprint=0.0)
    # the same by hand: rigid wheels under springs, as a vehicle of its own
    from axlespan.model.compile import compile_model
    from axlespan.model.model import Model
    from axlespan.vehicles.vehicle import ContactPoint, Vehicle

    model = Model(plane=True).with_nodes([[-1.25, 1.0]], ["body"])
    model = model.with_mass("body", 4e3, {"ry": 6e3}, directions=("z",))
    for i, x in enumerate((0.0, 2.5)):
        names = [f"seat{i + 1}", f"axle{i + 1}", f"wheel{i + 1}"]
        model = model.with_nodes([[-x, 1.0], [-x, 0.5], [-x, 0.0]], names)
        model = model.with_rigid_link("body", [names[0]], ("z",))
        seat, axle, wheel = (model.node(name) for name in names)
        model = model.with_springs([[axle, seat]], {"z": 8e5}, {"z": 1e4})
        model = model.with_springs([[wheel, axle]], {"z": 1.2e6})
        model = model.with_mass(axle, 300.0, directions=("z",))
    points = tuple(ContactPoint(str(i + 1), x, f"wheel{i + 1}.z") for i, x in enumerate((0.0, 2.5)))
    other = Vehicle(points, compile_model(model).system, "on tyres")
    plain = simulate(
        Crossing(BRIDGE, Train.of(other), speed=20.0, irregularity=bump, start=-1.0),
        time_step=5e-4, steps=600, method=Alpha(-0.1), footprint=0.0,
    )  # fmt: skip
    scale = np.abs(plain.contact_force - plain.contact_force[0]).max()
    assert np.abs(own.contact_force - plain.contact_force).max() < 1e-8 * scale


# --- lifting off and landing ----------------------------------------------------------------------------


def event_driven(bump, speed, mass, wheel, stiffness, start, stop):
    """A body on a spring over a wheel on rigid ground, from rest: contact and flight by solve_ivp with events.

    Returns lift-off times, landing times and closing speeds of the first flight.
    """

    def contact_force(t, z, zd):
        s = start + speed * t
        accel = speed**2 * float(bump.curvature(s))
        return wheel * accel + (wheel + mass) * G + stiffness * (float(bump.value(s)) - z) - 0.0 * zd

    def riding(t, y):
        z, zd = y
        r = float(bump.value(start + speed * t))
        return [zd, stiffness / mass * (r - z)]

    def leaves(t, y):
        return contact_force(t, *y)

    leaves.terminal, leaves.direction = True, -1
    one = solve_ivp(riding, (0.0, stop), [0.0, 0.0], events=leaves, rtol=1e-10, atol=1e-13, max_step=1e-3)
    t0 = one.t_events[0][0]
    z, zd = one.y_events[0][0]
    s0 = start + speed * t0
    begin = [z, zd, float(bump.value(s0)), speed * float(bump.slope(s0))]

    def flying(t, y):
        z, zd, w, wd = y
        spring = stiffness * (w - z)
        return [zd, spring / mass, wd, -(wheel + mass) / wheel * G - spring / wheel]

    def lands(t, y):
        return y[2] - float(bump.value(start + speed * t)) if t > t0 + 1e-5 else 1.0

    lands.terminal, lands.direction = True, -1
    two = solve_ivp(flying, (t0, stop), begin, events=lands, rtol=1e-10, atol=1e-13, max_step=2e-4)
    t1, y = two.t_events[0][0], two.y_events[0][0]
    return t0, t1, speed * float(bump.slope(start + speed * t1)) - y[3]


@pytest.mark.parametrize("alpha", [0.0, -0.1])
@pytest.mark.parametrize("time_step", [1e-3, 5e-4, 2.5e-4])
def test_lift_off_over_a_bump(alpha, time_step):
    """Off the structure, where the ground is rigid: times within one step, closing speed within 1 %."""
    bump = Bump(-25.0, 4.0, 45e-3)
    speed, start = 20.0, -26.0
    t0, t1, closing = event_driven(bump, speed, 5750.0, 800.0, 1.595e6, start, 0.6)
    unit = sprung_mass(mass=5750.0, stiffness=1.595e6, unsprung_mass=800.0)
    crossing = Crossing(BRIDGE, Train.of(unit), speed=speed, start=start, irregularity=bump)
    result = simulate(
        crossing, time_step=time_step, steps=round(1.4 / time_step), contact="unilateral", method=Alpha(alpha)
    )
    flight = next(f for f in result.checks["flights"] if f["stop"] - f["start"] > 5e-3)
    assert abs(flight["start"] - t0) <= time_step * (1.0 + 1e-9)
    assert abs(flight["stop"] - t1) <= time_step * (1.0 + 1e-9)
    assert flight["closing_speed"] == pytest.approx(closing, rel=0.01)
    assert flight["start_position"] == pytest.approx(start + speed * flight["start"])
    assert result.contact_force.min() == 0.0
    assert result.checks["tension_episodes"] == 0


class Energies:
    """Energy of both bodies after every step, gravity included."""

    def __init__(self, plan):
        self.plan, self.steps = plan, range(plan.settings.steps + 1)
        self.total, self.approach = {}, {}

    def look(self, step, structure, vehicles, load, forces):
        m, fleet = self.plan.structure, self.plan.fleet
        u, v = structure.u, structure.v
        energy = 0.5 * (v @ (m.M @ v) + u @ (m.K @ u))
        u, v = vehicles.u, vehicles.v
        energy += 0.5 * (v @ (fleet.matrices.M @ v) + u @ (fleet.matrices.K @ u))
        self.total[step] = energy + fleet.weight @ u[fleet.dofs]
        path = self.plan.rows.rows(self.plan.rows.positions(np.zeros(1)), np.arange(1))
        line = structure.u[path.dofs[0, 0]] @ path.weights[0, 0]
        self.approach[step] = line - u[fleet.dofs[0]]


def dropped(contact, method, time_step, duration, *, height=5e-3, elements=6, mass=3000.0):
    """A mass that falls from a height upon an undamped beam that stands still."""
    bridge = simple_span(elements=elements, **SPAN)
    crossing = Crossing(bridge, Train.of(rigid_mass(mass=mass)), speed=0.0, start=12.0)
    settings = settings_for(
        crossing, time_step=time_step, steps=round(duration / time_step), method=method, contact=contact
    )
    plan = plan_for(crossing, settings)
    start, coupling = begin_nonlinear(plan, StartFactors(plan))
    start.structure.values[:] = 0.0
    start.fleet.values[:, 0] = height, 0.0, -G
    start = replace(start, forces=np.zeros(1), load=np.zeros_like(start.load))
    raised = -height - plan.laws.indentation
    if contact.kind != "unilateral":
        start.fleet.values[0, 0] = height + plan.laws.indentation[0]
    coupling.approach = coupling.before = raised
    coupling.touching = np.zeros(1, dtype=bool)
    energies = Energies(plan)
    recorder = Recorder(plan, None, [energies])
    watch(coupling, recorder)
    lane = Lane.at_start(plan, start, recorder)
    drive([lane], prepare([plan]), coupling)
    assert lane.error is None, lane.error
    result = recorder.result(Outcome("completed", ""), {})
    total = np.array(list(energies.total.values()))
    landings = np.array(sorted(recorder.restarted), dtype=int)
    return result, total, np.array(list(energies.approach.values())), landings, plan.laws


def test_a_dropped_mass_keeps_its_energy_in_flight_and_never_gains():
    """Rigid one-sided contact without numerical damping: kept to rounding in flight, lost in landings only."""
    scale = 3000.0 * G * 5e-3
    result, energy, _, landings, _ = dropped(Unilateral(), Alpha(0.0), 1e-4, 0.25)
    force, change = result.contact_force[:, 0], np.diff(energy)
    in_flight = (force[1:] == 0.0) & (force[:-1] == 0.0)
    in_flight[landings - 1] = False
    assert in_flight.sum() > 300
    assert np.abs(change[in_flight]).max() < 1e-10 * scale
    assert change.max() < 1e-10 * scale
    lost = -change[landings - 1].sum()
    assert energy[0] - energy[-1] == pytest.approx(lost, rel=1e-6)
    assert result.facts["landing_loss"] == pytest.approx(lost, rel=1e-6)
    first = result.checks["flights"][0]
    assert first["stop"] == pytest.approx(np.sqrt(2 * 5e-3 / G), abs=1e-4)
    assert first["closing_speed"] == pytest.approx(np.sqrt(2 * G * 5e-3), rel=1e-3)
    for check in ("energy_residual", "equilibrium_residual"):
        assert result.checks[check] < 1e-10


@pytest.mark.parametrize("elements", [8, 20, 40])
def test_landings_with_numerical_damping_do_not_depend_on_the_mesh(elements):
    """No chatter, no gain over the drop; the deflection after it is the same on every mesh."""
    result, energy, _, _, _ = dropped(Unilateral(), Alpha(-0.1), 1e-3, 0.6, elements=elements)
    scale = 3000.0 * G * 5e-3
    assert energy.max() < energy[0] + 1e-9 * scale
    assert np.diff(energy).max() < 1e-3 * scale
    assert result.checks["flight_count"] <= 16
    assert result.vehicle_displacement[:, 0].min() == pytest.approx(-2.757e-3, rel=5e-3)
    for check in ("energy_residual", "equilibrium_residual", "compatibility_residual"):
        assert result.checks[check] < 1e-9


def test_a_mass_bounces_on_hertz_without_loss():
    """Work of the force closes the balance to rounding; the energy that the law holds, to the order of the time step."""
    law = Hertz(stiffness=1e10)
    result, energy, approach, _, laws = dropped(law, Alpha(0.0), 1e-5, 0.06, elements=2)
    total = energy + np.array([laws.energy(np.array([d]))[0] for d in approach])
    scale = 3000.0 * G * 5e-3
    force = result.contact_force[:, 0]
    done = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(approach))])
    assert np.abs(energy + done - energy[0]).max() < 1e-9 * scale  # by the work that the force does
    in_flight = (force[1:] == 0.0) & (force[:-1] == 0.0)
    assert np.abs(np.diff(total)[in_flight]).max() < 1e-10 * scale
    assert np.abs(total - total[0]).max() < 1e-5 * scale
    assert force.max() > 10 * 3000.0 * G


def test_damping_of_a_tyre_takes_what_is_missing():
    """∫ c δ̇² dt of the recorded approach closes the balance of energy."""
    law = LinearSpring(2e6, 3e4)
    result, energy, approach, _, laws = dropped(law, Alpha(0.0), 2e-5, 0.12, elements=2)
    total = energy + np.array([laws.energy(np.array([d]))[0] for d in approach])
    scale = 3000.0 * G * 5e-3
    force = result.contact_force[:, 0]
    elastic = 2e6 * np.maximum(approach + laws.indentation, 0.0)
    dissipated = np.concatenate(
        [[0.0], np.cumsum(0.5 * ((force - elastic)[1:] + (force - elastic)[:-1]) * np.diff(approach))]
    )
    assert dissipated[-1] > 0.1 * scale
    assert np.abs(total + dissipated - total[0]).max() < 1e-5 * scale


# --- starts, losses, messages ------------------------------------------------------------------------------


def test_a_wheel_that_hangs_at_the_start_is_said():
    """A stiff car on three axles over a hole: the middle wheel carries nothing and starts in the air."""
    car = rigid_body(
        mass=2e4, pitch_inertia=4e5, axles=[0.0, 3.0, 6.0], stiffness=3e6, damping=1e4, unsprung_mass=300.0
    )
    hole = Bump(-5.0, 2.0, -60e-3)
    crossing = Crossing(BRIDGE, Train.of(car), speed=10.0, start=-1.0, irregularity=hole)
    result = simulate(crossing, time_step=1e-3, steps=500, contact="unilateral")
    assert result.contact_force[0, 1] == 0.0
    # the head's footprint is half on the span, which begins to give way
    assert result.contact_force[0].sum() == pytest.approx((2e4 + 900.0) * G, rel=2e-3)
    assert any("in the air at the start" in note and "1.2" in note for note in result.facts["notes"])
    wheel = result.at("vehicle_displacement", "1.wheel2.z")
    assert wheel[0] > -60e-3  # it hangs on its spring, 300 kg on 3 MN/m lower than the seat
    first = result.checks["flights"][0]
    assert (first["contact"], first["start"], first["landed"]) == ("1.2", 0.0, True)


@pytest.mark.parametrize("contact", ["hertz", "unilateral"])
def test_a_wheel_in_the_air_at_the_start_does_not_pull(contact):
    """Rounding of static equilibrium is no tension."""
    car = rigid_body(
        mass=3e4, pitch_inertia=1e5, axles=[0.0, 3.0, 6.0], stiffness=5e7, damping=1e5, unsprung_mass=500.0
    )
    hole = Table(np.array([-100.0, 6.5, 7.0, 8.0, 100.0]), np.array([0.0, 0.0, -0.02, 0.0, 0.0]))
    crossing = Crossing(BRIDGE, Train.of(car), speed=20.0, start=10.0, irregularity=hole)
    result = simulate(crossing, time_step=2e-4, steps=300, contact=contact)
    assert result.contact_force[0, 1] == 0.0
    assert result.contact_force.min() == 0.0
    assert result.checks["tension_episodes"] == 0


def test_landings_with_numerical_damping_lose_energy():
    """A wheelset of 500 kg falls off a ramp onto the ground: what landings take is its kinetic energy, about."""
    ramp = Table(np.array([-100.0, -3.0, -2.0, -1.9, 100.0]), np.array([0.0, 0.0, 0.03, 0.0, 0.0]))
    crossing = Crossing(BRIDGE, Train.of(UNIT), speed=30.0, start=-5.0, irregularity=ramp)
    result = simulate(crossing, time_step=5e-4, steps=400, contact="unilateral")
    wheel = sum(0.5 * 500.0 * flight["closing_speed"] ** 2 for flight in result.checks["flights"])
    assert result.facts["landing_loss"] == pytest.approx(wheel, rel=0.2)


@pytest.mark.parametrize("contact", ["hertz", "unilateral", "linear-spring"])
def test_laws_need_wheels_that_press(contact):
    crossing = Crossing(BRIDGE, Train.of(UNIT), speed=20.0, irregularity=WAVES, gravity=0.0)
    with pytest.raises(InputError, match=r"needs wheels that press on the line: .* contact 1\.1 is 0 N"):
        simulate(crossing, time_step=1e-3, steps=10, contact=contact)
    held = simulate(crossing, time_step=1e-3, steps=200)
    assert held.outcome.code == "completed"
    assert held.contact_force.min() < 0.0 < held.contact_force.max()
    assert held.checks["force_noise"] == 0.0  # no static force to relate it to


def test_a_lost_vehicle_stops_the_run():
    """A drop of 2 m behind a smooth ramp: all wheels are in the air for too long; the history is kept."""
    crossing = Crossing(BRIDGE, Train.of(UNIT), speed=30.0, start=-24.0, irregularity=Bump(-20.0, 10.0, 1.2))
    with pytest.raises(
        AnalysisError, match=r"vehicle 1 is lost: all its wheels have been in the air for 0\.2 s"
    ) as caught:
        simulate(crossing, time_step=1e-3, steps=2000, contact="unilateral", lost_after=0.2)
    kept = caught.value.result
    assert kept.outcome.code == "failed"
    assert 300 < kept.facts["completed_steps"] < 800
    assert kept.contact_force[-1, 0] == 0.0
    assert kept.checks["flights"][-1]["landed"] is False


def test_many_crossings_of_other_laws_run_one_by_one():
    crossings = [Crossing(BRIDGE, Train.of(UNIT), speed=v, irregularity=WAVES) for v in (20.0, 30.0)]
    many = simulate_many(crossings, time_step=1e-3, steps=200, contact="hertz")
    for crossing, result in zip(crossings, many, strict=True):
        own = simulate(crossing, time_step=1e-3, steps=200, contact="hertz")
        np.testing.assert_array_equal(own.contact_force, result.contact_force)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"contact": "hertz", "coupling": "iterative"}, "does not know contact: hertz.*Use method: direct"),
        ({"contact": "unilateral", "basis": "reduced"}, "basis = 'reduced'.*contact: unilateral"),
        ({"contact": "sticky"}, "contact = 'sticky': must be one of rigid"),
        ({"lost_after": 0.0}, "lost_after = 0.0: must be positive"),
    ],
)
def test_wrong_settings(change, words):
    with pytest.raises(InputError, match=words):
        simulate(Crossing(BRIDGE, Train.of(UNIT), speed=20.0), time_step=1e-3, steps=10, **change)


def test_moving_forces_have_no_law():
    loads = axle_loads(loads=1e5)
    own = replace(loads, contacts=(replace(loads.contacts[0], law=Unilateral()),))
    with pytest.raises(InputError, match="a moving force acts whatever the contact"):
        simulate(Crossing(BRIDGE, Train.of(own), speed=20.0), time_step=1e-3, steps=10)
    result = simulate(
        Crossing(BRIDGE, Train.of(loads), speed=20.0), time_step=1e-3, steps=10, contact="hertz"
    )
    np.testing.assert_array_equal(result.contact_force, 1e5)


def test_hertz_in_a_reduced_basis(rigid):
    crossing, _ = rigid
    full = simulate(crossing, time_step=1e-3, steps=600, contact="hertz")
    reduced = simulate(crossing, time_step=1e-3, steps=600, contact="hertz", basis="reduced")
    assert np.abs(full.contact_force - reduced.contact_force).max() < 2e-3 * STATIC
