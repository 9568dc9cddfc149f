"""Assembly: against dense sums, on one pattern, symmetric to the last bit, quick."""

import subprocess
import sys
import time
from dataclasses import dataclass, replace

import numpy as np
import pytest

from axlespan.elements.beam import BeamProperties
from axlespan.model import assembly
from axlespan.model.assembly import assemble, element_dofs
from axlespan.model.compile import compile_model, dof_table
from axlespan.model.dofs import DofTable
from axlespan.model.from_mesh import Beams, Planes, Shells, Solids
from axlespan.model.materials import BeamSection, Material
from axlespan.model.mesh import Mesh
from axlespan.model.model import Model
from axlespan.model.parts import ElementMatrices

CONCRETE = Material(30e9, 0.2, 2500.0)
BEAM = BeamProperties(
    axial_stiffness=4e9,
    bending_stiffness_y=8e8,
    bending_stiffness_z=3e8,
    torsional_stiffness=1e8,
    mass_per_length=900.0,
)


def mixed_model():
    """Solids, shells, beams, springs, a point mass and bars on nodes of three, six and few d.o.f."""
    box = Mesh.box((3.0, 1.0, 1.0), (3, 2, 1))
    noise = 0.05 * np.random.default_rng(0).uniform(-1.0, 1.0, box.points.shape)
    plate = Mesh.rectangle((3.0, 1.0), (3, 2), origin=(0.0, 0.0, 1.5), kind="tri3")
    model = Model(plane=False).with_mesh(box.with_points(box.points + noise), {"volume": Solids(CONCRETE)})
    model = model.with_mesh(plate, {"surface": Shells(CONCRETE, 0.2, offset=0.1)})
    first = len(box.points)
    model = model.with_beams([[first + 3, first], [first, first + 7]], BEAM, offset=(0.0, 0.1, -0.3))
    model = model.with_bars([[0, first + 1], [5, first]], 1e8, 20.0)
    model = model.with_springs([[3, first + 3], [first + 2, 1]], {"z": 3e6, "y": 2e5}, {"z": 4e4})
    return model.with_mass(first + 1, 300.0, {"ry": 12.0})


def dense(model, table):
    """Matrices summed entry by entry."""
    result = {}
    for name in ("stiffness", "mass", "damping"):
        matrix = np.zeros((table.size, table.size))
        for part in model.parts:
            values = getattr(part.matrices(model.points), name)
            if values is not None:
                for dofs, own in zip(element_dofs(part, table), values, strict=True):
                    for a, i in enumerate(dofs):
                        for b, j in enumerate(dofs):
                            matrix[i, j] += own[a, b]
        result[name] = matrix
    return result


@pytest.fixture(scope="module")
def mixed():
    model = mixed_model()
    table = dof_table(model)
    return model, table, assemble(model.parts, model.points, table)


@pytest.mark.parametrize(("which", "name"), [(0, "stiffness"), (1, "mass"), (2, "damping")])
def test_sums_are_those_of_a_dense_loop(mixed, which, name):
    model, table, matrices = mixed
    wanted = dense(model, table)[name]
    assert np.abs(wanted).max() > 0.0
    np.testing.assert_allclose(matrices[which].toarray(), wanted, rtol=0, atol=1e-14 * np.abs(wanted).max())


def test_all_matrices_are_symmetric_to_the_last_bit(mixed):
    for matrix in mixed[2]:
        assert np.array_equal(matrix.toarray(), matrix.toarray().T)


def test_one_pattern_with_explicit_zeros(mixed):
    stiffness, mass, damping = mixed[2]
    for other in (mass, damping):
        assert np.array_equal(stiffness.indices, other.indices)
        assert np.array_equal(stiffness.indptr, other.indptr)
    assert stiffness.has_canonical_format
    # Inertia does not couple x with y inside a solid: the zeros are there all the same.
    assert np.count_nonzero(mass.data) < 0.7 * mass.nnz
    assert np.count_nonzero(damping.data) == 2 * 4
    total = stiffness.copy()
    total.data = stiffness.data + 2.0 * mass.data
    difference = np.abs(total.toarray() - (stiffness.toarray() + 2.0 * mass.toarray())).max()
    assert difference == 0.0


def test_the_pattern_follows_the_topology_not_the_numbers():
    plane = Mesh.rectangle((2.0, 1.0), (2, 1), plane="xz")
    patterns = []
    for ratio in (0.0, 0.3):
        model = Model().with_mesh(plane, {"surface": Planes(Material(1e9, ratio, 1.0))})
        table = dof_table(model)
        matrix = assemble(model.parts, model.points, table)[0]
        patterns.append((matrix.indices.tolist(), matrix.indptr.tolist()))
    assert patterns[0] == patterns[1]
    # Six nodes of two d.o.f.; the middle two see all six, the corners four.
    assert len(patterns[0][0]) == 2 * 2 * (2 * 6 + 4 * 4)


def test_nodes_may_be_numbered_in_any_order(mixed):
    model, table, (stiffness, _, _) = mixed
    order = np.random.default_rng(6).permutation(len(model.points))
    other = DofTable.of_active(table.number >= 0, order)
    again = assemble(model.parts, model.points, other)[0]
    assert again.has_canonical_format
    place = np.empty(table.size, dtype=np.int64)
    place[table.number[table.number >= 0]] = other.number[other.number >= 0]
    moved = again.toarray()[np.ix_(place, place)]
    scale = np.abs(stiffness.data).max()
    np.testing.assert_allclose(moved, stiffness.toarray(), rtol=0, atol=1e-15 * scale)


def test_a_shared_pattern_cannot_be_spoiled(mixed):
    with pytest.raises(ValueError, match="read-only"):
        mixed[2][0].eliminate_zeros()


def test_in_pieces_the_sums_are_the_same(mixed, monkeypatch):
    model, table, whole = mixed
    monkeypatch.setattr(assembly, "_CHUNK_BYTES", 1.0)
    for one, other in zip(whole, assemble(model.parts, model.points, table), strict=True):
        assert np.array_equal(one.indices, other.indices)
        scale = np.abs(one.data).max()
        np.testing.assert_allclose(one.data, other.data, rtol=0, atol=1e-15 * scale)


def test_pieces_keep_properties_of_their_elements(monkeypatch):
    mesh = Mesh.rectangle((3.0, 1.0), (3, 1))
    model = Model(plane=False).with_mesh(mesh, {"surface": Shells(CONCRETE, 0.2)})
    part = replace(model.parts[0], thickness=np.array([0.1, 0.2, 0.4]), offset=np.array([0.0, 0.1, 0.0]))
    model = replace(model, parts=(part,))
    whole = assemble(model.parts, model.points, dof_table(model))
    monkeypatch.setattr(assembly, "_CHUNK_BYTES", 1.0)
    pieces = assemble(model.parts, model.points, dof_table(model))
    assert np.array_equal(whole[0].data, pieces[0].data)
    assert whole[1].diagonal()[::6].sum() == pytest.approx(2500.0 * 0.7 * 4.0 / 9.0, rel=0.2)


@dataclass(frozen=True, eq=False)
class Collapsed:
    """An element that names a node twice, with a matrix without structure."""

    name: str = "collapsed"
    components: tuple[str, ...] = ("x", "z")

    @property
    def nodes(self):
        return np.array([[2, 0, 2, 1], [1, 2, 0, 1]])

    def matrices(self, points):
        k = np.random.default_rng(3).standard_normal((2, 8, 8))
        return ElementMatrices(stiffness=k + k.transpose(0, 2, 1))


def test_an_element_may_name_a_node_twice():
    model = Model().with_nodes(np.eye(3)[:, ::2] * 3.0).with_part(Collapsed())
    table = dof_table(model)
    stiffness, mass, damping = assemble(model.parts, model.points, table)
    wanted = dense(model, table)["stiffness"]
    np.testing.assert_allclose(stiffness.toarray(), wanted, rtol=0, atol=1e-13)
    assert np.array_equal(stiffness.toarray(), stiffness.toarray().T)
    assert mass.nnz == damping.nnz == 0


def test_beams_with_offset_move_as_a_rigid_body():
    """The reference: two nodes at the beam's axis, tied to the model's nodes by rigid links."""
    offset = np.array([0.2, -0.1, -0.7])
    points = np.array([[0.0, 0.0, 0.0], [4.0, 1.0, 0.5]])
    model = Model(plane=False).with_nodes(points).with_beams([[0, 1]], BEAM, offset=offset)
    near = compile_model(model).system
    linked = Model(plane=False).with_nodes(np.vstack([points, points + offset]))
    linked = linked.with_beams([[2, 3]], BEAM).with_rigid_link(0, [2]).with_rigid_link(1, [3])
    # A d.o.f. of the master exists because the ties ask for it.
    far = compile_model(linked).system
    for name in ("stiffness", "mass"):
        one, other = getattr(near, name).toarray(), getattr(far, name).toarray()
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * np.abs(other).max())
    part = model.parts[0]
    motion = np.array([0.1, 0.2, 0.3, 0.01, -0.02, 0.03])  # rigid, about the origin
    nodal = np.concatenate([np.append(motion[:3] + np.cross(motion[3:], x), motion[3:]) for x in points])
    assert np.abs(part.matrices(points).stiffness[0] @ nodal).max() < 1e-4
    up = np.array([0.0, 0.0, 1.0])
    weights = part.polynomials(points, up)[0] @ 0.5 ** np.arange(4)
    middle = points.mean(axis=0) + offset
    assert weights @ nodal == pytest.approx((motion[:3] + np.cross(motion[3:], middle))[2], rel=1e-12)


def test_beams_from_a_mesh_with_offset():
    mesh = Mesh.line((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), 2)
    section = BeamSection(second_moment=0.1, area=0.5, lateral_second_moment=0.1, torsion_constant=0.1)
    model = Model(plane=False).with_mesh(mesh, {"line": Beams(CONCRETE, section, offset=(0.0, 0.0, -1.0))})
    system = compile_model(model).system
    assert system.total_mass() == pytest.approx(2500.0 * 0.5 * 4.0)
    spin = np.zeros(system.size)
    spin[[system.dof(f"n{i}.x") for i in (1, 2, 3)]] = 0.0
    spin[[system.dof(f"n{i}.rx") for i in (1, 2, 3)]] = 1.0  # about the nodes: m a² of the axis below
    assert spin @ (system.mass @ spin) == pytest.approx(5000.0, rel=1e-12)


def test_the_solid_model_of_example_3_2():
    """N12's mesh of 10 x 10 x 100 elements has 36 663 d.o.f.; its matrices take a second, not minutes."""
    begun = time.perf_counter()
    mesh = Mesh.box((25.0, 2.2272, 2.5), (100, 10, 10))
    material = Material(2.87e9, 0.2, 2303.0 / (2.2272 * 2.5))
    middle = np.isin(mesh.points[:, 0], (0.0, 25.0)) & (np.abs(mesh.points[:, 2] - 1.25) < 1e-9)
    mesh = mesh.with_node_set("pins", np.flatnonzero(middle))
    model = Model(plane=False).with_mesh(mesh, {"volume": Solids(material, formulation="full")})
    system = compile_model(model.with_supports("pins", ("x", "y", "z"))).system
    # 0.7 s on one core; five times as much on a busy machine is no failure.
    assert time.perf_counter() - begun < 10.0
    assert (system.size, len(system.prescribed), len(system.free)) == (36_663, 66, 36_597)
    assert system.total_mass() == pytest.approx(2303.0 * 25.0, rel=1e-12)
    # A node inside sees 27 nodes of three d.o.f.
    assert np.diff(system.stiffness.indptr).max() == 81
    uniform = np.abs(system.stiffness @ system.translation("z")).max()
    assert uniform < 1e-9 * system.stiffness.diagonal().max()


HUNDRED_THOUSAND = """
import resource, time
import numpy as np
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Solids
from axlespan.model.materials import Material
from axlespan.model.mesh import Mesh
from axlespan.model.model import Model
mesh = Mesh.box((100.0, 10.0, 5.0), (100, 50, 20))
noise = 0.02 * np.random.default_rng(0).uniform(-1.0, 1.0, mesh.points.shape)
sections = {"volume": Solids(Material(30e9, 0.2, 2500.0))}
begun = time.perf_counter()
model = Model(plane=False).with_mesh(mesh.with_points(mesh.points + noise), sections)
system = compile_model(model).system
seconds = time.perf_counter() - begun
print(system.size, seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.mark.slow
def test_a_hundred_thousand_hexahedra():
    """All elements differ; in a process of its own, whose peak of memory is that of this model."""
    output = subprocess.run([sys.executable, "-c", HUNDRED_THOUSAND], capture_output=True, check=True).stdout
    size, seconds, kibibytes = (float(word) for word in output.split())
    assert size == 3 * 101 * 51 * 21
    assert seconds < 60.0  # 11 s on one core
    assert kibibytes < 3 * 2**20  # 1 GiB measured
