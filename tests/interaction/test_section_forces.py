"""Section forces over time: against reactions, influence lines, the semi-analytical moment; envelopes."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.bridges import SupportAt
from axlespan.interaction.simulate import simulate_many
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Shells, parts_from_mesh
from axlespan.model.materials import Material
from axlespan.model.mesh import Mesh
from axlespan.model.model import Model
from axlespan.model.motions import HarmonicMotion
from axlespan.reference import Motion, SimplySupportedBeam, cross_forces
from axlespan.running.stress_points import StressPoints
from axlespan.running.structure import Structure
from axlespan.running.surface import line_over

BRIDGE = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.90, "mass_per_length": 2303.0}
HEAVY = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, damping=2e4, unsprung_mass=500.0)
P = 1e5
FORCE = asp.vehicles.axle_loads(loads=[P], positions=[0.0])


def crossing_of(vehicle=HEAVY, *, elements=9, speed=100 / 3.6, start=0.0, **bridge):
    structure = asp.bridges.simple_span(**BRIDGE, elements=elements, **bridge)
    return asp.Crossing(structure, asp.Train.of(vehicle), speed=speed, start=start)


@pytest.mark.parametrize("alpha", [0.0, -0.1])
@pytest.mark.parametrize("coupling", ["direct", "refactored"])
@pytest.mark.parametrize("moved", [False, True], ids=["still", "moving support"])
def test_shear_at_the_supports_is_the_reaction(alpha, coupling, moved):
    supports = [SupportAt(0.0, ("z",), name="left"), SupportAt(25.0, ("z",), name="right")]
    if moved:
        supports[0] = SupportAt(0.0, (), motion={"z": HarmonicMotion(2e-3, 3.0)}, name="left")
    crossing = crossing_of(damping=asp.Rayleigh(0.5, 1e-4), supports=supports)
    result = asp.simulate(
        crossing,
        time_step=1e-3,
        steps=600,
        method=asp.Alpha(alpha),
        coupling=coupling,
        footprint=0.75,
        sensors={"a": 0.0, "b": 25.0},
        section_forces=["a", "b"],
    )
    left, right = result.at("support_reaction", "left.z"), result.at("support_reaction", "right.z")
    scale = np.abs(left).max()
    # All of the wheel stands on the beam once its footprint has come over the support.
    inside = result.at("contact_position", "1.1") > 0.4
    assert np.abs(result.at("section_shear", "a") - left)[inside].max() < 1e-9 * scale
    assert np.abs(result.at("section_shear", "b") + right).max() < 1e-9 * scale
    assert np.abs(result.section_moment).max() < 1e-9 * 25.0 * scale
    assert not np.any(result.section_normal) and not np.any(result.section_torsion)


def test_slow_crossing_draws_influence_lines():
    """M and V at sections inside elements, at a node and under the wheel; the shear is that right of the axle."""
    result = asp.simulate(
        crossing_of(FORCE, elements=5, speed=0.05),
        time_step=1.0,
        steps=500,
        sensors={"in": 6.5, "node": 10.0, "mid": 12.5},
        section_forces=["mid", "in", "node"],
    )
    x = result.contact_position
    s = np.array([12.5, 6.5, 10.0])
    before = x <= s + 1e-9
    moment = P * np.where(before, x * (25.0 - s), (25.0 - x) * s) / 25.0
    shear = P * np.where(before, -x, 25.0 - x) / 25.0
    # what is left is the vibration that the wheel brings in at 0.05 m/s
    assert np.abs(result.section_moment - moment).max() < 2e-4 * P * 25.0 / 4.0
    assert np.abs(result.section_shear - shear).max() < 5e-3 * P
    k = np.argmin(np.abs(x[:, 0] - 12.5))
    assert result.at("section_moment", "mid")[k] == pytest.approx(P * 25.0 / 4.0, rel=2e-4)
    assert result.at("section_shear", "mid")[k] == pytest.approx(-0.5 * P, rel=5e-3)
    assert result.at("section_shear", "mid")[k + 1] == pytest.approx(0.5 * P, rel=5e-3)


@pytest.mark.parametrize("start", [3.0, 12.5, 21.4])
def test_standing_wheel_is_exact(start):
    """Static equilibrium: nothing but rounding, whatever the elements."""
    result = asp.simulate(
        crossing_of(FORCE, elements=3, speed=0.0, start=start),
        time_step=1e-3,
        steps=5,
        sensors={"s": 12.5},
        section_forces=["s"],
    )
    exact = P * (12.5 * (25.0 - start) if start > 12.5 else start * 12.5) / 25.0
    assert result.section_moment == pytest.approx(exact, rel=1e-9)


def test_moment_of_a_fast_force_against_the_modal_series():
    """Second order in the length of elements; closer than EI times the curvature in an element."""
    beam = SimplySupportedBeam(25.0, 2.87e9 * 2.9, 2303.0)
    speed, every, steps = 100 / 3.6, 16, 400
    time = np.arange(steps + 1) * 1e-3
    exact = cross_forces(beam, [P], Motion(speed), time, modes=3000).moment_at([7.1, 12.5])
    scale, late = np.abs(exact).max(), slice(20, None)
    errors, curvature = [], []
    for elements in (4, 8, 16):
        crossing = crossing_of(FORCE, elements=elements, speed=speed)
        result = asp.simulate(
            crossing,
            time_step=1e-3 / every,
            steps=steps * every,
            sensors={"in": 7.1, "mid": 12.5},
            section_forces=["in", "mid"],
            every=every,
            fields=every,
        )
        rows = crossing.structure.line().rows(np.array([7.1, 12.5]), crossing.structure.system.size, 2)
        bent = 2.87e9 * 2.9 * (rows @ result.fields.displacement.T).T
        for values, into in ((result.section_moment, errors), (bent, curvature)):
            into.append(np.sqrt(((values - exact)[late] ** 2).mean(axis=0)) / scale)
    errors, curvature = np.array(errors), np.array(curvature)
    assert np.all(errors[-1] < 3e-4)
    assert np.all(np.log2(errors[-2] / errors[-1]) > 1.8)
    assert np.all(curvature[:, 0] > 8.0 * errors[:, 0])


def test_histories_follow_the_alpha_method_whatever_is_kept():
    """Every third step of a run that keeps all, one crossing of several side by side, another solver."""
    kwargs = {"time_step": 1e-3, "sensors": {"s": 11.1}, "section_forces": ["s"], "envelopes": ["moment"]}
    crossing = crossing_of()
    every = asp.simulate(crossing, steps=600, **kwargs)
    third = asp.simulate(crossing, steps=600, every=3, **kwargs)
    assert np.array_equal(third.section_moment, every.section_moment[::3])
    assert np.array_equal(third.envelopes.of("moment").largest, every.envelopes.of("moment").largest)
    other = asp.Crossing(crossing.structure, asp.Train.of(HEAVY, count=2, spacing=4.0), speed=35.0)
    first, second = simulate_many([crossing, other], steps=[600, 300], **kwargs)
    scale = np.abs(every.section_moment).max()
    assert np.abs(first.section_moment - every.section_moment).max() < 1e-9 * scale
    alone = asp.simulate(other, steps=300, **kwargs)
    assert np.abs(second.section_shear - alone.section_shear).max() < 1e-8 * scale


def test_envelopes_are_extremes_of_histories():
    stations = np.linspace(0.0, 25.0, 10)
    quantities = ["moment", "shear", "normal", "torsion", "deflection", "acceleration"]
    result = asp.simulate(
        crossing_of(),
        time_step=1e-3,
        steps=700,
        sensors={f"{i}": s for i, s in enumerate(stations)},
        section_forces=[f"{i}" for i in range(10)],
        envelopes=quantities,
    )
    envelopes = result.envelopes
    assert envelopes.position == pytest.approx(stations)
    assert list(envelopes.tables) == quantities
    for name, history in (
        ("moment", result.section_moment),
        ("deflection", result.sensor_displacement),
        ("acceleration", result.sensor_acceleration),
    ):
        found, scale = envelopes.of(name), np.abs(history).max()
        assert np.abs(found.largest - history.max(axis=0)).max() < 1e-9 * scale
        assert np.abs(found.smallest - history.min(axis=0)).max() < 1e-9 * scale
        times = result.time[history[:, 4].argmax()], result.time[history[:, 4].argmin()]
        assert (found.time_of_largest[4], found.time_of_smallest[4]) == pytest.approx(times)
    # Shear is looked at on both sides of a node; sensors have that on the right.
    shear, right = envelopes.of("shear"), result.section_shear
    assert np.all(shear.largest >= right.max(axis=0) - 1e-6)
    assert np.all(shear.smallest <= right.min(axis=0) + 1e-6)
    assert shear.smallest[-1] == pytest.approx(-result.at("support_reaction", "right.z").max(), rel=1e-9)
    with pytest.raises(asp.InputError, match=r"quantity = 'moments'.*Known: moment, shear"):
        envelopes.of("moments")


def test_moment_and_shear_agree_on_both_sides_of_nodes():
    """Elements share their end forces: nodal equilibrium holds to rounding at every step."""
    nodes = np.linspace(0.0, 25.0, 10)[1:-1]
    eps = 1e-9
    result = asp.simulate(
        crossing_of(damping=asp.Rayleigh(0.5, 1e-4)),
        time_step=1e-3,
        steps=500,
        method=asp.Alpha(-0.05),
        sensors={f"{side}{i}": s + e for i, s in enumerate(nodes) for side, e in (("l", -eps), ("r", 0.0))},
        section_forces=[f"{side}{i}" for i in range(8) for side in "lr"],
    )
    moment, shear = result.section_moment, result.section_shear
    assert np.abs(moment[:, ::2] - moment[:, 1::2]).max() < 1e-8 * np.abs(moment).max()
    # the footprint's load between the two sides is all that may differ
    assert np.abs(shear[:, ::2] - shear[:, 1::2]).max() < 1e-7 * np.abs(shear).max()


def test_wrong_names():
    crossing = crossing_of()
    for wanted, match in (
        ({"section_forces": ["mid"]}, r"section_forces.0 = 'mid': is not a known sensor"),
        ({"sensors": {"m": 1.0}, "section_forces": ["m", "m"]}, r"section_forces.1 = 'm': is named twice"),
        ({"envelopes": ["stress"]}, r"envelopes.0 = 'stress': is not a known quantity"),
        ({"envelopes": ["shear", "shear"]}, r"envelopes.1 = 'shear': is named twice"),
        ({"sensors": {"m": 1.0}, "stresses": ["m"]}, r"stresses: .*section_forces"),
    ):
        with pytest.raises(asp.InputError, match=match):
            asp.simulate(crossing, time_step=1e-3, steps=10, **wanted)


def test_stresses_of_shells_over_time():
    """The history is the rows of the point times the displacements, with a support that moves as well."""
    mesh = Mesh.rectangle((8.0, 2.0), (16, 4), plane="xy")
    model = Model(plane=False).with_nodes(mesh.points)
    for part in parts_from_mesh(mesh, {"surface": Shells(Material(3e10, 0.2, 2500.0), 0.3)}):
        model = model.with_part(part)
    for x, fixed in ((0.0, ("x", "y", "z")), (8.0, ("y",))):
        for node in np.flatnonzero(mesh.points[:, 0] == x).tolist():
            moved = {"z": HarmonicMotion(1e-3, 2.0)} if x else None
            model = model.with_support(node, fixed, motion=moved)
    compiled = compile_model(model)
    path = line_over(model, compiled.table, [[0.0, 0.5, 0.0], [8.0, 0.5, 0.0]])
    structure = Structure(
        compiled.system, {"main": path.transformed(compiled.system.elimination)}, model=model
    )
    result = asp.simulate(
        asp.Crossing(structure, asp.Train.of(FORCE), speed=20.0),
        time_step=2e-3,
        steps=150,
        sensors={"mid": 4.1, "end": 7.6},
        stresses=["end", "mid"],
        fields=1,
    )
    assert result.stress[:2] == ("end.n_x", "end.n_y") and len(result.stress) == 16
    rows = StressPoints.at(structure, ["end", "mid"], np.array([7.6, 4.1])).rows
    expected = (rows @ result.fields.displacement[:, structure.system.independent].T).T
    assert np.abs(result.stress_history - expected).max() < 1e-9 * np.abs(expected).max()
    # a strip of 2 m takes half of the force's moment when it is in the middle, more or less
    moment = np.abs(result.at("stress_history", "mid.m_x")).max()
    assert 0.8 < moment / (P * 8.0 / 4.0 / 2.0) < 2.0
