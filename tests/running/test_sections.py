"""Section forces under a running line: found beams, closed forms of statics, all ways in which beams may lie."""

import numpy as np
import pytest

from axlespan.bridges import continuous_beam, simple_span
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.linalg.factor import factorize
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.model.parts import BeamPart
from axlespan.running.beams import BeamTable, carriers
from axlespan.running.line import path_on_beams
from axlespan.running.sections import BeamSections
from axlespan.running.structure import Structure

P = 1.7e5
BEAM = BeamProperties(axial_stiffness=3e9, bending_stiffness_y=2e9, mass_per_length=4e3)


def under_load(structure, at, sections, line="main"):
    """Static section forces (n, 4) at positions, under a wheel of force P at a position of the line."""
    system, path = structure.system, structure.line(line)
    u = np.zeros(system.size)
    load = -P * path.rows(np.array([at]), system.size).toarray()[0]
    u[system.free] = factorize(system.partition.K_FF).solve(np.ascontiguousarray(load[system.free]))
    found = BeamSections.at(structure, *path.locate(np.asarray(sections, float)), line)
    dofs, weights = found.influence(line).weights(np.array([at]))
    total = found.rows()[0] @ u
    np.add.at(total, dofs[0], weights[0] * P)
    return total.reshape(-1, 4)


def chain(points, *, backward=(), properties=BEAM, components=("x", "z", "ry"), offset=None):
    """A simply supported chain of beams through points (n, 2) of x and z; some run backward."""
    model = Model(plane=True).with_nodes(points)
    pairs = [[i + 1, i] if i in backward else [i, i + 1] for i in range(len(points) - 1)]
    off = None if offset is None else np.asarray(offset, float)
    model = model.with_part(BeamPart("beam", np.array(pairs), properties, components, None, off))
    return model.with_support(0, ("x", "z")).with_support(len(points) - 1, ("z",))


def structure_of(model, nodes):
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, nodes)
    return Structure(compiled.system, {"main": path.transformed(compiled.system.elimination)}, model=model)


@pytest.mark.parametrize("backward", [(), (0, 2, 3), (0, 1, 2, 3, 4)])
@pytest.mark.parametrize("at", [1.3, 5.0, 8.9])
def test_simple_span(backward, at):
    x = np.array([0.0, 2.0, 3.0, 6.5, 9.0, 10.0])
    model = chain(np.column_stack([x, 0 * x]), backward=backward)
    s = np.array([0.0, 0.7, 1.3, 4.9, 6.5, 8.0, 10.0])
    found = under_load(structure_of(model, range(6)), at, s)
    over = s >= at  # right of an axle over a section, but the wheel's path counts it as before
    over[np.isclose(s, at)] = False
    assert found[:, 0] == pytest.approx(P * np.where(over, at * (10 - s), (10 - at) * s) / 10, abs=1e-7 * P)
    assert found[:, 1] == pytest.approx(P * np.where(over, -at, 10 - at) / 10, abs=1e-9 * P)
    assert found[:, 2:] == pytest.approx(0.0, abs=1e-9 * P)


def test_two_spans():
    """M over the middle support = -3 P L / 32 for a force in the middle of one span; 13 P L / 64 under it."""
    L = 20.0
    bridge = continuous_beam(
        spans=[L, L], youngs_modulus=3e10, second_moment=0.4, mass_per_length=5e3, elements=3
    )
    found = under_load(bridge, L / 2, [L / 2, L, 1.5 * L])
    assert found[:, 0] == pytest.approx(P * L * np.array([13 / 64, -3 / 32, -3 / 64]), rel=1e-9)
    assert found[:, 1] == pytest.approx(P * np.array([13 / 32, 3 / 32, 3 / 32]), rel=1e-9)


def test_shear_deformation_changes_nothing_where_statics_decide():
    bridge = simple_span(
        length=12.0,
        youngs_modulus=3e10,
        second_moment=0.4,
        mass_per_length=5e3,
        elements=5,
        area=1.5,
        shear_area=0.6,
    )
    found = under_load(bridge, 4.0, [3.0, 6.0])
    assert found[:, 0] == pytest.approx(P * np.array([2.0, 2.0]), rel=1e-9)


def test_inclined():
    """A vertical force in the middle of a beam at an angle: N changes from -R sin to +R sin, V = R cos."""
    slope = 0.4
    x = np.linspace(0.0, 10.0, 5)
    structure = structure_of(chain(np.column_stack([x, slope * x])), range(5))
    length = 10.0 * np.hypot(1.0, slope)
    cos, sin = 1.0 / np.hypot(1.0, slope), slope / np.hypot(1.0, slope)
    found = under_load(structure, 0.5 * length, [0.3 * length, 0.7 * length])
    assert found[:, 0] == pytest.approx(P / 2 * 3.0, rel=1e-9)
    assert found[:, 1] == pytest.approx([P / 2 * cos, -P / 2 * cos], rel=1e-9)
    assert found[:, 2] == pytest.approx([-P / 2 * sin, P / 2 * sin], rel=1e-9)


def test_frame_of_eccentric_beams_and_rigid_links():
    """A beam 0.8 m under its nodes, which are slaves of others by rigid links: statics as ever."""
    x = np.linspace(0.0, 10.0, 6)
    model = Model(plane=True).with_nodes(np.column_stack([x, 0 * x]))
    pairs = np.column_stack([np.arange(5), np.arange(1, 6)])
    part = BeamPart("beam", pairs, BEAM, ("x", "z", "ry"), None, np.array([0.0, 0.0, -0.8]))
    model = model.with_part(part).with_nodes([[x[0], -0.8], [x[-1], -0.8]])
    model = model.with_rigid_link(6, [0]).with_rigid_link(7, [5])
    model = model.with_support(6, ("x", "z")).with_support(7, ("z",))
    found = under_load(structure_of(model, range(6)), 3.0, [2.2, 5.0])
    assert found[:, 0] == pytest.approx(P * np.array([0.7 * 2.2, 0.3 * 5.0]), rel=1e-8)
    assert found[:, 2] == pytest.approx(0.0, abs=1e-8 * P)


def test_beams_side_by_side_count_together():
    x = np.linspace(0.0, 10.0, 5)
    single = chain(np.column_stack([x, 0 * x]))
    half = BeamProperties(axial_stiffness=1e9, bending_stiffness_y=0.5e9)
    double = single.with_beams(np.column_stack([np.arange(1, 5), np.arange(4)]), half, name="second")
    structure = structure_of(double, range(5))
    beams = BeamTable.of(double)
    found = carriers(structure, structure.line(), beams)
    assert found.segment.tolist() == [0, 0, 1, 1, 2, 2, 3, 3]
    assert found.backward.tolist() == [False, True] * 4
    forces = under_load(structure, 4.0, [2.0, 4.1, 9.0])
    assert forces[:, 0] == pytest.approx(P * np.array([1.2, 0.4 * 5.9, 0.4]), rel=1e-9)


def test_torsion_in_space():
    """A beam along y, clamped at both ends, loaded by a cantilever: torque and shear halve to both sides."""
    properties = BeamProperties(1e9, 2e7, 2e7, 1e7, mass_per_length=100.0)
    model = Model(plane=False).with_nodes([[0, 0, 0], [0, 2, 0], [0, 4, 0], [1.5, 2, 0]])
    model = model.with_beams([[0, 1], [1, 2]], properties).with_beams([[1, 3]], properties, name="arm")
    model = model.with_support(0, ("x", "y", "z", "rx", "ry", "rz"))
    model = model.with_support(2, ("x", "y", "z", "rx", "ry", "rz"))
    compiled = compile_model(model)
    lines = {
        "arm": path_on_beams(model, compiled.table, [1, 3]),
        "main": path_on_beams(model, compiled.table, [0, 1, 2]),
    }
    structure = Structure(compiled.system, lines, model=model)
    u = np.zeros(structure.system.size)
    load = -P * lines["arm"].rows(np.array([1.5]), structure.system.size).toarray()[0]
    free = structure.system.free
    u[free] = factorize(structure.system.partition.K_FF).solve(np.ascontiguousarray(load[free]))
    found = BeamSections.at(structure, np.array([0, 1]), np.array([0.5, 0.5]), "main")
    forces = (found.rows()[0] @ u).reshape(-1, 4)
    # The joint takes the moment (1.5, 0, 0) × (0, 0, -P) = (0, 1.5 P, 0); it turns the far face of the first half.
    assert forces[:, 3] == pytest.approx([0.75 * P, -0.75 * P], rel=1e-9)
    assert forces[:, 1] == pytest.approx([0.5 * P, -0.5 * P], rel=1e-9)
    assert found.influence("arm") is None


def test_where_there_are_no_beams():
    bridge = simple_span(length=10.0, youngs_modulus=3e10, second_moment=0.1, mass_per_length=1e3, elements=4)
    bare = Structure(bridge.system, bridge.lines, "imported")
    with pytest.raises(InputError, match=r"section_forces.*imported is given by matrices"):
        BeamSections.at(bare, np.array([0]), np.array([0.5]))
    other = Model(plane=True).with_nodes([[0, 0], [1, 0]]).with_springs([[0, 1]], {"z": 1.0})
    with pytest.raises(InputError, match=r"envelopes: must lie on beams"):
        BeamSections.at(
            Structure(bridge.system, bridge.lines, model=_with_numbers(bridge, other)),
            np.array([0]),
            np.array([0.5]),
            wanted="envelopes",
        )


def _with_numbers(bridge, other):
    """A model without beams."""
    assert bridge.model is not None
    return Model(plane=True, points=bridge.model.points, parts=other.parts)
