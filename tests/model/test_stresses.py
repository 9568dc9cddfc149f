"""Stresses and forces in the middles of elements, and at points of a running line."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.errors import InputError
from axlespan.linalg.factor import factorize
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Planes, Shells, Solids, parts_from_mesh
from axlespan.model.materials import Material
from axlespan.model.mesh import Mesh
from axlespan.model.model import Model
from axlespan.model.nodal import rigid_motion
from axlespan.model.outline import outline
from axlespan.model.stresses import ElementForces
from axlespan.running.stress_points import StressPoints
from axlespan.running.structure import Structure
from axlespan.running.surface import line_over

STEEL = Material(2e11, 0.3, 7850.0)


def model_of(mesh, sections, *, plane=False):
    model = Model(plane=plane).with_nodes(mesh.points)
    for part in parts_from_mesh(mesh, sections, in_plane=plane):
        model = model.with_part(part)
    return model


def solved(model, supports, loads):
    """Displacements (n_full,) and the compiled model under nodal loads."""
    for node, fixed in supports:
        model = model.with_support(int(node), fixed)
    compiled = compile_model(model)
    system = compiled.system
    force = np.zeros(len(system.dof_names))
    for node, component, amount in loads:
        force[compiled.table.number[int(node), "xyz".index(component)]] += amount
    u = np.zeros(system.size)
    right = np.asarray(system.elimination.T @ force)[system.free]
    u[system.free] = factorize(system.partition.K_FF).solve(np.ascontiguousarray(right))
    return model, compiled, np.asarray(system.elimination @ u)


@pytest.mark.parametrize("kind", ["hex8", "tet4", "plane"])
def test_uniform_strain(kind):
    """u = ε x everywhere: Hooke's law in every element."""
    strain = np.array([1e-4, -3e-5, 5e-5])
    if kind == "plane":
        mesh = Mesh.rectangle((3.0, 1.0), (3, 2), plane="xz")
        model = model_of(mesh, {"surface": Planes(STEEL, 0.2)}, plane=True)
        strain[1] = -0.3 / 0.7 * (strain[0] + strain[2])  # free to contract across
    else:
        mesh = Mesh.box((3.0, 1.0, 2.0), (3, 2, 2), kind=kind)
        model = model_of(mesh, {"volume": Solids(STEEL)})
    table = compile_model(model).table.number
    u = np.zeros(table.max() + 1)
    for c in range(3):
        there = table[:, c] >= 0
        u[table[there, c]] = strain[c] * model.points[there, c]
    found = ElementForces.of(model).at(u)
    shear, volume = 2e11 / 2.6, 2e11 * 0.3 / (1.3 * 0.4) * strain.sum()
    expected = np.concatenate([2 * shear * strain + volume, np.zeros(3)])
    assert found["stress"] == pytest.approx(np.tile(expected, (len(found["stress"]), 1)), abs=1.0)
    xx, yy, zz = expected[:3]
    mises = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2))
    assert found["von_mises"] == pytest.approx(mises, rel=1e-6)


def test_mixed_parts_and_missing_quantities():
    """A shell cantilever with a beam on its end: each has its own, nan elsewhere."""
    mesh = Mesh.rectangle((4.0, 1.0), (8, 2), plane="xy")
    model = model_of(mesh, {"surface": Shells(STEEL, 0.1)})
    tip = int(np.flatnonzero((mesh.points[:, 0] == 4.0) & (mesh.points[:, 1] == 0.5))[0])
    beam = asp.BeamSection(second_moment=1e-4, area=0.02).properties(STEEL)
    from dataclasses import replace

    beam = replace(beam, bending_stiffness_z=2e7, torsional_stiffness=1e7)
    model = model.with_nodes([[6.0, 0.5, 0.0]])
    model = model.with_beams([[tip, len(mesh.points)]], beam).with_mass(tip, 10.0)
    held = np.flatnonzero(mesh.points[:, 0] == 0.0)
    every = ("x", "y", "z", "rx", "ry", "rz")
    model, _, u = solved(model, [(n, every) for n in held], [(len(mesh.points), "z", -1000.0)])
    found = ElementForces.of(model).at(u)
    assert set(found) == {"shell_force", "shell_moment", "shell_shear", "beam_force"}
    assert all(len(values) == 16 + 1 + 1 for values in found.values())
    assert np.all(np.isnan(found["beam_force"][:16])) and np.all(np.isnan(found["shell_moment"][16:]))
    # the beam's middle: M = -1000 · 1, V = dM/dx = 1000
    assert found["beam_force"][16] == pytest.approx([-1000.0, 1000.0, 0.0, 0.0], abs=1e-4)
    x = model.points[model.parts[0].nodes].mean(axis=1)[:, 0]
    for place in (0.75, 1.75):
        across = np.isclose(x, place)
        assert abs(found["shell_moment"][:16][across, 0].mean()) == pytest.approx(
            1000.0 * (6.0 - place), rel=0.01
        )
    assert np.all(np.isnan(found["beam_force"][17]))


def test_rigid_motions_stress_nothing():
    model = model_of(Mesh.rectangle((2.0, 1.0), (2, 2), plane="xy"), {"surface": Shells(STEEL, 0.05)})
    for component in ("x", "rx", "ry", "rz"):
        for values in ElementForces.of(model).at(rigid_motion(model, component)).values():
            assert np.abs(values).max() < 1.0  # of 2e11 · 0.05 · 1


@pytest.mark.parametrize("kind", ["solids", "shells", "plane"])
def test_points_on_a_running_line(kind):
    """A console with a moment from a force at its end: M / W on top, or the moment itself."""
    b, h, length = 0.5, 0.4, 4.0
    force = -2e4
    if kind == "shells":
        mesh = Mesh.rectangle((length, b), (16, 2), plane="xy")
        model, top = model_of(mesh, {"surface": Shells(Material(2e11, 0.0, 1.0), h)}), 0.0
    elif kind == "solids":
        mesh = Mesh.box((length, b, h), (16, 2, 4))
        model, top = model_of(mesh, {"volume": Solids(Material(2e11, 0.0, 1.0))}), h
    else:
        mesh = Mesh.rectangle((length, h), (16, 4), plane="xz")
        model, top = model_of(mesh, {"surface": Planes(Material(2e11, 0.0, 1.0), b)}, plane=True), h
    p = model.points
    held, tip = np.flatnonzero(p[:, 0] == 0.0), np.flatnonzero(p[:, 0] == length)
    fixed = {"shells": ("x", "y", "z", "rx", "ry", "rz"), "solids": ("x", "y", "z"), "plane": ("x", "z")}[
        kind
    ]
    loads = [(n, "z", force / len(tip)) for n in tip]
    model, compiled, u = solved(model, [(n, fixed) for n in held], loads)
    y = 0.0 if kind == "plane" else 0.2
    path = line_over(model, compiled.table, [[0.0, y, top], [length, y, top]])
    structure = Structure(
        compiled.system, {"main": path.transformed(compiled.system.elimination)}, model=model
    )
    found = StressPoints.at(structure, ["a", "b"], np.array([1.625, 2.5]))
    values = dict(zip(found.names, found.rows @ u[compiled.system.independent], strict=True))
    for name, x in (("a", 1.625), ("b", 2.5)):  # in the middle of an element and between two
        moment = force * (length - x)
        if kind == "shells":
            assert abs(values[f"{name}.m_x"]) == pytest.approx(abs(moment) / b, rel=0.02)
        else:
            assert values[f"{name}.xx"] == pytest.approx(-moment * 6 / (b * h**2), rel=0.03)
    count = {"shells": 8, "solids": 6, "plane": 3}[kind]
    assert len(found.names) == 2 * count


def test_no_surface():
    bridge = asp.bridges.simple_span(
        length=9.0, youngs_modulus=1e10, second_moment=0.1, mass_per_length=1.0, elements=3
    )
    with pytest.raises(InputError, match=r"stresses: .*section_forces where the line runs on beams"):
        StressPoints.at(bridge, ["a"], np.array([1.0]))
    with pytest.raises(InputError, match="given by matrices"):
        StressPoints.at(Structure(bridge.system, bridge.lines), ["a"], np.array([1.0]))


def test_outlines():
    box = model_of(Mesh.box((3.0, 2.0, 2.0), (3, 2, 2)), {"volume": Solids(STEEL)})
    # edges on the surface of 3 × 2 × 2 cells: twice the faces of the surface, which has 2(6 + 6 + 4) of them
    assert len(outline(box)) == 2 * 32
    tets = model_of(Mesh.box((1.0, 1.0, 1.0), (1, 1, 1), kind="tet4"), {"volume": Solids(STEEL)})
    assert len(outline(tets)) == 12 + 6
    flat = model_of(Mesh.rectangle((2.0, 1.0), (2, 1), plane="xy"), {"surface": Shells(STEEL, 0.1)})
    assert len(outline(flat.with_springs([[0, 5]], {"z": 1.0}))) == 7 + 1
