"""Solids, plane elements and shells in models: patch tests, frequencies, meshes with sections, bad meshes."""

import numpy as np
import pytest

from axlespan.elements.elasticity import orthotropic
from axlespan.elements.shells import ShellMaterial
from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import factorize
from axlespan.model.compile import compile_model
from axlespan.model.continuum_parts import PlanePart, SolidPart
from axlespan.model.from_mesh import Bars, Beams, Planes, Shells, Solids
from axlespan.model.materials import BeamSection, Material
from axlespan.model.mesh import CellBlock, Mesh
from axlespan.model.model import Model
from axlespan.model.motions import Constant
from axlespan.model.shell_parts import ShellPart
from axlespan.reference import timoshenko_frequencies

CONCRETE = Material(30e9, 0.2, 2500.0)
LENGTHS = (3.0, 2.0, 1.5)


def distorted_box(kind, quadratic=False):
    mesh = Mesh.box(LENGTHS, (3, 2, 2), kind=kind)
    inside = np.all((mesh.points > 1e-9) & (mesh.points < np.array(LENGTHS) - 1e-9), axis=1)
    noise = 0.15 * np.random.default_rng(4).uniform(-1.0, 1.0, mesh.points.shape)
    mesh = mesh.with_points(mesh.points + inside[:, None] * noise)
    return mesh.quadratic() if quadratic else mesh


def distorted_rectangle(kind, quadratic=False, plane="xz"):
    mesh = Mesh.rectangle((3.0, 2.0), (3, 3), kind=kind, plane=plane)
    axes = [0, 2] if plane == "xz" else [0, 1]
    flat = mesh.points[:, axes]
    inside = np.all((flat > 1e-9) & (flat < np.array([3.0, 2.0]) - 1e-9), axis=1)
    points = mesh.points.copy()
    points[np.ix_(inside, axes)] += 0.15 * np.random.default_rng(4).uniform(-1.0, 1.0, (inside.sum(), 2))
    mesh = mesh.with_points(points)
    return mesh.quadratic() if quadratic else mesh


def displacements(system):
    """Static displacements (n,) under the loads and the motions of the supports."""
    blocks = system.partition
    u = np.zeros(system.size)
    moved = np.array([motion.value(np.zeros(1))[0] for motion in system.motions])
    u[system.prescribed] = moved
    force = sum(load.vector[system.free] for load in system.loads) - blocks.K_FP @ moved
    u[system.free] = factorize(blocks.K_FF).solve(np.ascontiguousarray(force))
    return u


def component(system, u, name):
    """Displacement of every node along a component."""
    return np.array([value for own, value in zip(system.components, u, strict=True) if own == name])


SOLID_MESHES = [
    ("hex8", "hex8", False),
    ("hex20", "hex8", True),
    ("tet4", "tet4", False),
    ("tet10", "tet4", True),
    ("wedge6", "wedge6", False),
]


class TestSolids:
    @pytest.mark.parametrize(("kind", "base", "quadratic"), SOLID_MESHES)
    def test_a_linear_field_passes_through_a_distorted_mesh(self, kind, base, quadratic):
        """Patch test: the boundary moves linearly, the inside follows."""
        mesh = distorted_box(base, quadratic)
        assert mesh.blocks[0].kind == kind
        model = Model(plane=False).with_mesh(mesh, {"volume": Solids(CONCRETE)})
        gradient = 1e-4 * np.array([[1.0, 0.3, -0.2], [0.5, -0.7, 0.1], [0.2, 0.4, 0.6]])
        wanted = mesh.points @ gradient.T
        boundary = np.any((mesh.points < 1e-9) | (mesh.points > np.array(LENGTHS) - 1e-9), axis=1)
        assert 0 < np.count_nonzero(~boundary) < len(boundary)
        for node in np.flatnonzero(boundary):
            motion = {name: Constant(wanted[node, c]) for c, name in enumerate("xyz")}
            model = model.with_support(int(node), motion=motion)
        system = compile_model(model).system
        u = displacements(system)
        for c, name in enumerate("xyz"):
            np.testing.assert_allclose(component(system, u, name), wanted[:, c], rtol=0, atol=1e-14)

    @pytest.mark.parametrize(("kind", "base", "quadratic"), SOLID_MESHES)
    @pytest.mark.parametrize("lumped", [False, True])
    def test_mass(self, kind, base, quadratic, lumped):
        mesh = distorted_box(base, quadratic)
        model = Model(plane=False).with_mesh(mesh, {"volume": Solids(CONCRETE, lumped_mass=lumped)})
        system = compile_model(model).system
        for name in "xyz":
            assert system.total_mass(name) == pytest.approx(2500.0 * 9.0, rel=1e-12)
        off = system.mass - np.diag(system.mass.diagonal())
        assert (np.abs(off).max() == 0.0) == lumped
        assert system.mass.diagonal().min() > 0.0

    def test_formulations_of_the_hexahedron(self):
        """Tip of a cantilever of 8 elements: with modes as the beam, without them far too stiff."""
        deflection = {}
        for formulation in ("incompatible", "full"):
            mesh = Mesh.box((8.0, 0.5, 0.5), (8, 1, 1))
            section = Solids(Material(1e9, 0.0, 1.0), formulation=formulation)
            model = Model(plane=False).with_mesh(mesh, {"volume": section})
            model = model.with_supports("x_min", ("x", "y", "z"))
            for node in mesh.node_sets["x_max"]:
                model = model.with_load(int(node), "z", -250.0)
            system = compile_model(model).system
            deflection[formulation] = -component(system, displacements(system), "z").min()
        inertia = 0.5**4 / 12.0
        # Euler-Bernoulli and the shear of 6/5.
        beam = 1000.0 * 8.0**3 / (3.0 * 1e9 * inertia) + 1.2 * 1000.0 * 8.0 / (0.5e9 * 0.25)
        assert deflection["incompatible"] == pytest.approx(beam, rel=0.005)
        # Without modes the element's curvature costs 1 + (1 - ν)/2 (l/h)² = 3 times as much.
        assert deflection["full"] == pytest.approx(beam / 3.0, rel=0.01)

    def test_orthotropic_solid_in_tension(self):
        law = orthotropic((10e9, 2e9, 1e9), (0.2, 0.3, 0.1), (1e9, 2e9, 3e9))
        mesh = distorted_box("hex8")
        section = Solids(CONCRETE, elasticity=law)
        model = Model(plane=False).with_mesh(mesh, {"volume": section})
        for face, name in (("x_min", "x"), ("y_min", "y"), ("z_min", "z")):
            model = model.with_supports(face, (name,), name=f"{face} face")
        model = model.with_supports("y_max", motion={"y": Constant(2e-4)})
        system = compile_model(model).system
        u = displacements(system)
        # ε_y = 1e-4; ε_x = -ν_xy E_y/E_x ε_y, ε_z = -ν_yz ε_y.
        assert component(system, u, "x").max() == pytest.approx(0.2 * 2.0 / 10.0 * 0.0, abs=1e-15)
        assert component(system, u, "x").min() == pytest.approx(-3.0 * 0.2 * 0.2 * 1e-4, rel=1e-9)
        assert component(system, u, "z").min() == pytest.approx(-1.5 * 0.3 * 1e-4, rel=1e-9)


PLANE_MESHES = [("quad4", False), ("quad4", True), ("tri3", False), ("tri3", True)]


class TestPlane:
    @pytest.mark.parametrize(("base", "quadratic"), PLANE_MESHES)
    @pytest.mark.parametrize("state", ["stress", "strain"])
    def test_uniform_tension(self, base, quadratic, state):
        mesh = distorted_rectangle(base, quadratic)
        section = Planes(CONCRETE, thickness=0.4, state=state)
        model = Model().with_mesh(mesh, {"surface": section})
        model = model.with_supports("x_min", ("x",)).with_supports("z_min", ("z",))
        model = model.with_supports("x_max", motion={"x": Constant(3e-4)})
        system = compile_model(model).system
        u = displacements(system)
        nu = 0.2
        ratio = nu if state == "stress" else nu / (1.0 - nu)
        modulus = 30e9 if state == "stress" else 30e9 / (1.0 - nu**2)
        x, z = mesh.points[:, 0], mesh.points[:, 2]
        np.testing.assert_allclose(component(system, u, "x"), 1e-4 * x, rtol=0, atol=1e-15)
        np.testing.assert_allclose(component(system, u, "z"), -ratio * 1e-4 * z, rtol=0, atol=1e-15)
        reactions = (system.stiffness @ u)[system.prescribed]
        pulled = [name.startswith("x_max") for name in system.support_names]
        assert reactions[pulled].sum() == pytest.approx(modulus * 1e-4 * 2.0 * 0.4, rel=1e-10)
        assert system.total_mass() == pytest.approx(2500.0 * 6.0 * 0.4, rel=1e-12)

    def test_z_is_up_also_for_orthotropic_materials(self):
        law = orthotropic((10e9, 5e9, 2e9), (0.2, 0.3, 0.1), (1e9, 2e9, 3e9))
        mesh = Mesh.rectangle((3.0, 2.0), (2, 2), plane="xz")
        section = Planes(CONCRETE, elasticity=law)
        model = Model().with_mesh(mesh, {"surface": section})
        model = model.with_supports("x_min", ("x",)).with_supports("z_min", ("z",))
        model = model.with_supports("z_max", motion={"z": Constant(2e-4)})
        system = compile_model(model).system
        u = displacements(system)
        reactions = (system.stiffness @ u)[system.prescribed]
        pulled = [name.startswith("z_max") for name in system.support_names]
        assert reactions[pulled].sum() == pytest.approx(2e9 * 1e-4 * 3.0, rel=1e-10)
        assert component(system, u, "x").min() == pytest.approx(-3.0 * 0.1 * 2.0 / 10.0 * 1e-4, rel=1e-9)
        shear = PlanePart.of("s", "quad4", [[0, 1, 2, 3]], CONCRETE, elasticity=law).elasticity
        assert shear[2, 2] == pytest.approx(3e9)  # G_zx

    def test_a_wall_bends_as_a_beam(self):
        """Frequencies of a simply supported wall, 20 m x 2 m, against Timoshenko's beam."""
        mesh = Mesh.rectangle((20.0, 2.0), (40, 4), plane="xz")
        middle = np.abs(mesh.points[:, 2] - 1.0) < 1e-9
        mesh = mesh.with_node_set("left", np.flatnonzero(middle & (mesh.points[:, 0] == 0.0)))
        mesh = mesh.with_node_set("right", np.flatnonzero(middle & (mesh.points[:, 0] == 20.0)))
        model = Model().with_mesh(mesh, {"surface": Planes(CONCRETE, thickness=0.3)})
        model = model.with_supports("left", ("x", "z")).with_supports("right", ("z",))
        system = compile_model(model).system
        assert system.support_names == ("left.x", "left.z", "right.z")
        blocks = system.partition
        own = lowest_modes(blocks.K_FF, blocks.M_FF, 1).angular_frequencies[0]
        beam = timoshenko_frequencies(
            length=20.0,
            bending_stiffness=30e9 * 0.3 * 8.0 / 12.0,
            shear_stiffness=CONCRETE.shear_modulus * 0.6 * 5.0 / 6.0,
            mass_per_length=1500.0,
            rotary_inertia=2500.0 * 0.3 * 8.0 / 12.0,
            count=1,
        )[0]
        assert own == pytest.approx(beam, rel=0.005)

    @pytest.mark.parametrize(("base", "quadratic"), PLANE_MESHES)
    def test_a_mesh_drawn_from_behind_is_the_same(self, base, quadratic):
        mesh = distorted_rectangle(base, quadratic)
        front = Model().with_mesh(mesh, {"surface": Planes(CONCRETE)})
        block = mesh.blocks[0]
        turned = {3: [0, 2, 1], 4: [0, 3, 2, 1], 6: [0, 2, 1, 5, 4, 3], 8: [0, 3, 2, 1, 7, 6, 5, 4]}
        behind = CellBlock(block.kind, block.nodes[:, turned[block.nodes.shape[1]]], block.labels)
        other = Mesh(mesh.points, (behind,), mesh.node_sets, mesh.element_sets)
        back = Model().with_mesh(other, {"surface": Planes(CONCRETE)})
        one, two = (compile_model(model).system.stiffness for model in (front, back))
        np.testing.assert_allclose(one.toarray(), two.toarray(), rtol=0, atol=1e-9 * np.abs(one.data).max())


class TestShells:
    @pytest.mark.parametrize("kind", ["quad4", "tri3"])
    def test_membrane_patch_and_mass(self, kind):
        mesh = distorted_rectangle(kind, plane="xy")
        model = Model(plane=False).with_mesh(mesh, {"surface": Shells(CONCRETE, 0.25)})
        model = model.with_supports("x_min", ("x", "z", "rx", "ry", "rz"))
        model = model.with_supports("y_min", ("y",))
        # Uniform tension needs moments about the normal at the ends, where the sides bulge: they are held.
        model = model.with_supports("x_max", ("z", "rz"), motion={"x": Constant(3e-4)})
        system = compile_model(model).system
        u = displacements(system)
        np.testing.assert_allclose(component(system, u, "x"), 1e-4 * mesh.points[:, 0], rtol=0, atol=1e-14)
        np.testing.assert_allclose(component(system, u, "y"), -2e-5 * mesh.points[:, 1], rtol=0, atol=1e-14)
        assert system.total_mass() == pytest.approx(2500.0 * 6.0 * 0.25, rel=1e-12)

    def test_an_offset_is_a_beam_below_its_nodes(self):
        """A strip with its nodes at the top: fixed at both ends against x, it works as an arch; free, as a strip."""
        mesh = Mesh.rectangle((10.0, 1.0), (10, 2))
        deflection = {}
        for along in ("x", ""):
            for offset in (0.0, -0.5):
                section = Shells(Material(1e9, 0.0, 1.0), 0.1, offset=offset)
                model = Model(plane=False).with_mesh(mesh, {"surface": section})
                model = model.with_supports("x_min", ("x", "y", "z")).with_supports("x_max", (*along, "z"))
                for node in np.flatnonzero(np.abs(mesh.points[:, 0] - 5.0) < 1e-9):
                    model = model.with_load(int(node), "z", -1.0)
                system = compile_model(model).system
                deflection[along, offset] = -component(system, displacements(system), "z").min()
        strip = 3.0 * 10.0**3 / (48.0 * 1e9 * 0.1**3 / 12.0)
        assert deflection["", 0.0] == pytest.approx(strip, rel=0.005)
        assert deflection["", -0.5] == pytest.approx(strip, rel=0.005)
        # Held at the nodes, e above the axis, it is pulled by N: half the extension N L/2EA of the axis and its
        # end rotation under P and N e, times e, are zero together.
        bending, axial, e, load = 1e9 * 0.1**3 / 12.0, 1e9 * 0.1, 0.5, 3.0
        rotation = load * 10.0**2 / (16.0 * bending)
        pull = rotation * e / (10.0 / (2.0 * axial) + e**2 * 10.0 / (2.0 * bending))
        held = strip - pull * e * 10.0**2 / (8.0 * bending)
        assert deflection["x", -0.5] == pytest.approx(held, rel=0.01)

    def test_orthotropic_material_and_density(self):
        material = ShellMaterial(10e9, 5e9, 0.1, 1e9, 1e9, 1e9, direction=(0.0, 1.0, 0.0))
        with pytest.raises(InputError, match="density = None: must be given with a shell material"):
            ShellPart.of("s", "quad4", [[0, 1, 2, 3]], material, thickness=0.1)
        mesh = Mesh.rectangle((3.0, 2.0), (2, 2))
        model = Model(plane=False).with_mesh(mesh, {"surface": Shells(material, 0.1, density=800.0)})
        model = model.with_supports("x_min", ("x", "z", "rx", "ry", "rz")).with_supports("y_min", ("y",))
        model = model.with_supports("x_max", ("z", "rz"), motion={"x": Constant(3e-4)})
        system = compile_model(model).system
        reactions = (system.stiffness @ displacements(system))[system.prescribed]
        pulled = [name.startswith("x_max") and name.endswith(".x") for name in system.support_names]
        assert reactions[pulled].sum() == pytest.approx(5e9 * 1e-4 * 2.0 * 0.1, rel=1e-9)
        assert system.total_mass() == pytest.approx(800.0 * 0.6)

    def test_a_curved_surface_is_told_to_its_elements(self):
        angle = np.linspace(0.0, 0.5, 6)
        mesh = Mesh.rectangle((5.0, 2.0), (5, 2))
        bent = np.column_stack([10.0 * np.sin(angle), 10.0 * np.cos(angle)])
        points = mesh.points.copy()
        points[:, [0, 2]] = bent[np.rint(points[:, 0]).astype(int)]
        part = (
            Model(plane=False)
            .with_mesh(mesh.with_points(points), {"surface": Shells(CONCRETE, 0.2)})
            .parts[0]
        )
        np.testing.assert_allclose(part.turning, 0.05, rtol=1e-9)


def two_kinds():
    """A box of hexahedra and wedges with its lower face as shells, and a line of beams."""
    hexes = Mesh.box((1.0, 1.0, 1.0), (1, 1, 1))
    wedges = Mesh.box((1.0, 1.0, 1.0), (1, 1, 1), origin=(1.0, 0.0, 0.0), kind="wedge6")
    mesh = hexes.merged(wedges)
    line = CellBlock("line2", np.array([[0, 1], [8, 9]]), np.array([101, 102]))
    bottom = CellBlock("quad4", np.array([[0, 1, 3, 2]]), np.array([201]))
    sets = {**mesh.element_sets, "ribs": ((2, np.array([0, 1])),), "skin": ((3, np.array([0])),)}
    return Mesh(mesh.points, (*mesh.blocks, line, bottom), mesh.node_sets, sets)


class TestMeshes:
    def test_parts_by_set_and_kind(self):
        section = BeamSection(second_moment=1e-3, area=0.1, torsion_constant=1e-3, lateral_second_moment=1e-3)
        sections = {
            "volume": Solids(CONCRETE),
            "skin": Shells(CONCRETE, 0.1),
            "ribs": Beams(CONCRETE, section),
        }
        model = Model(plane=False).with_nodes([[0.0, 0.0, 9.0]], ["a"]).with_mesh(two_kinds(), sections)
        assert [part.name for part in model.parts] == ["volume/hex8", "volume/wedge6", "skin", "ribs"]
        assert (
            model.parts[1].nodes.min() == 9
        )  # one node of the model before the mesh's, eight of the hexahedron
        assert model.parts[1].labels.tolist() == [2, 3]
        assert model.nodes_of("ribs").tolist() == [1, 2, 9, 10]
        assert model.nodes_of("x_max").tolist() == [2, 4, 6, 8, 10, 12, 14, 16]
        system = compile_model(model).system
        ribs, skin = 2 * 2500.0 * 0.1, 2500.0 * 0.1
        assert system.total_mass() == pytest.approx(2 * 2500.0 + ribs + skin)

    def test_bars_and_beams_in_a_plane_model(self):
        mesh = Mesh.line((0.0, 0.0, 0.0), (6.0, 0.0, 0.0), 3)
        bar = Model().with_mesh(mesh, {"line": Bars(CONCRETE, 0.01)})
        assert bar.parts[0].components == ("x", "z")
        assert compile_model(bar).system.total_mass("x") == pytest.approx(2500.0 * 0.06)
        beam = Model().with_mesh(mesh, {"line": Beams(CONCRETE, BeamSection(second_moment=1e-3))})
        assert beam.parts[0].components == ("z", "ry")

    def test_sections_for_everything_and_once(self):
        solids = Solids(CONCRETE)
        mesh = two_kinds().with_element_set("half", ((0, np.array([0])),))
        with pytest.raises(
            InputError, match=r"element = 2: must have a section, as 2 more wedge6 must.*'volume'"
        ):
            Model(plane=False).with_mesh(mesh, {"half": solids})
        with pytest.raises(InputError, match=r"element of 'half' = 1: has two sections"):
            Model(plane=False).with_mesh(mesh, {"volume": solids, "half": solids})
        with pytest.raises(InputError, match=r"Did you mean 'volume'"):
            Model(plane=False).with_mesh(mesh, {"volumes": solids})
        with pytest.raises(
            InputError, match=r"elements of 'volume' = 'hex8': can't be shells. Those are quad4, tri3"
        ):
            Model(plane=False).with_mesh(mesh, {"volume": Shells(CONCRETE, 0.1)})
        with pytest.raises(InputError, match=r"section of 'volume': does not fit the model"):
            Model(plane=True).with_mesh(mesh, {"volume": solids})
        with pytest.raises(InputError, match=r"area of 'ribs' = None: is needed for beams in space"):
            section = BeamSection(second_moment=1.0)
            Model(plane=False).with_mesh(mesh, {"volume": solids, "ribs": Beams(CONCRETE, section)})

    def test_offsets_ask_for_normals_on_one_side(self):
        mesh = Mesh.rectangle((2.0, 1.0), (2, 1))
        nodes = mesh.blocks[0].nodes.copy()
        nodes[1] = nodes[1, ::-1]
        turned = Mesh(mesh.points, (CellBlock("quad4", nodes, [7, 8]),), {}, mesh.element_sets)
        Model(plane=False).with_mesh(turned, {"surface": Shells(CONCRETE, 0.1)})
        with pytest.raises(
            InputError, match=r"elements of 'surface' = '7, 8': must have their normals on the same"
        ):
            Model(plane=False).with_mesh(turned, {"surface": Shells(CONCRETE, 0.1, offset=0.05)})

    def test_a_web_below_a_deck_has_no_common_side_of_two(self):
        """Three shells meet at a side: no orientation suits all pairs, so an offset is allowed."""
        points = np.array(
            [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, -1, 0], [1, -1, 0], [0, 0, -1], [1, 0, -1.0]]
        )
        nodes = np.array([[0, 1, 3, 2], [4, 5, 1, 0], [6, 7, 1, 0]])
        mesh = Mesh(points, (CellBlock("quad4", nodes, [1, 2, 3]),), {}, {"all": ((0, np.arange(3)),)})
        model = Model(plane=False).with_mesh(mesh, {"all": Shells(CONCRETE, 0.1, offset=0.05)})
        assert compile_model(model).system.size == 48


class TestBadElements:
    @pytest.mark.parametrize("kind", ["hex8", "tet4", "wedge6"])
    def test_inverted_solids_are_named(self, kind):
        mesh = Mesh.box((2.0, 1.0, 1.0), (4, 2, 2), kind=kind)
        nodes, labels = mesh.blocks[0].nodes.copy(), 1000 + np.arange(len(mesh.blocks[0]))
        half = len(nodes[0]) // 2 if kind != "tet4" else 0
        nodes[[2, 5]] = np.roll(nodes[[2, 5]], half, axis=1) if half else nodes[[2, 5]][:, [1, 0, 2, 3]]
        bad = Mesh(mesh.points, (CellBlock(kind, nodes, labels),), {}, mesh.element_sets)
        model = Model(plane=False).with_mesh(bad, {"volume": Solids(CONCRETE)})
        with pytest.raises(
            InputError, match=r"elements of 'volume' = '1002, 1005': must not be inverted or degen"
        ):
            compile_model(model)

    def test_many_are_counted_and_few_are_shown(self):
        mesh = Mesh.box((10.0, 1.0, 1.0), (20, 1, 1))
        flat = mesh.points * np.array([1.0, 1.0, 0.0])
        model = Model(plane=False).with_mesh(mesh.with_points(flat), {"volume": Solids(CONCRETE)})
        with pytest.raises(InputError, match=r"'1, 2, 3, 4, 5, 6, 7, 8, …'"):
            compile_model(model)

    def test_labels_survive_the_division_into_pieces(self, monkeypatch):
        monkeypatch.setattr("axlespan.model.assembly._CHUNK_BYTES", 30_000.0)  # three elements at a time
        mesh = Mesh.box((10.0, 1.0, 1.0), (20, 1, 1))
        points = mesh.points.copy()
        points[mesh.blocks[0].nodes[13, 6]] = points[mesh.blocks[0].nodes[13, 0]]
        model = Model(plane=False).with_mesh(mesh.with_points(points), {"volume": Solids(CONCRETE)})
        with pytest.raises(InputError, match=r"elements of 'volume' = '1[34]"):
            compile_model(model)

    def test_one_clockwise_plane_element(self):
        mesh = Mesh.rectangle((2.0, 1.0), (2, 1), plane="xz")
        nodes = mesh.blocks[0].nodes.copy()
        nodes[1] = nodes[1, ::-1]
        bad = Mesh(mesh.points, (CellBlock("quad4", nodes, [1, 2]),), {}, mesh.element_sets)
        model = Model().with_mesh(bad, {"surface": Planes(CONCRETE)})
        with pytest.raises(InputError, match=r"elements of 'surface' = '2': must not be inverted"):
            compile_model(model)

    def test_folded_shells(self):
        mesh = Mesh.rectangle((2.0, 1.0), (2, 1))
        points = mesh.points.copy()
        points[5] = [1.2, 0.2, 0.0]
        with pytest.raises(
            InputError, match=r"elements of 'surface' = '2': must not be inverted or degenerate"
        ):
            Model(plane=False).with_mesh(mesh.with_points(points), {"surface": Shells(CONCRETE, 0.1)})

    def test_arguments(self):
        with pytest.raises(
            InputError, match=r"'hex9': is not a known kind of solid element. Did you mean 'hex8'"
        ):
            SolidPart.of("s", "hex9", [[0] * 9], CONCRETE)
        with pytest.raises(
            InputError, match=r"nodes of 's' = \(1, 7\): must have the shape \(1, 8\) for hex8"
        ):
            SolidPart.of("s", "hex8", [[0] * 7], CONCRETE)
        with pytest.raises(InputError, match=r"formulation = 'reduced': is not a formulation"):
            SolidPart.of("s", "hex8", [[0] * 8], CONCRETE, formulation="reduced")
        with pytest.raises(InputError, match=r"state = 'both': must be 'stress' or 'strain'"):
            PlanePart.of("s", "quad4", [[0] * 4], CONCRETE, state="both")
        with pytest.raises(InputError, match=r"thickness = 0.0: must be positive"):
            PlanePart.of("s", "quad4", [[0] * 4], CONCRETE, thickness=[0.0])
        with pytest.raises(InputError, match=r"'quad8': is not a known kind of shell element"):
            ShellPart.of("s", "quad8", [[0] * 8], CONCRETE, thickness=0.1)
        with pytest.raises(
            InputError, match=r"thickness of 's' = \(3,\): must have the shape \(\) or \(1,\)"
        ):
            ShellPart.of("s", "quad4", [[0] * 4], CONCRETE, thickness=[0.1, 0.1, 0.2])
        with pytest.raises(
            InputError, match=r"offset of beams = \(2,\): must have the shape \(3,\) or \(1, 2, 3\)"
        ):
            Model().with_nodes([[0, 0], [1, 0]]).with_beams([[0, 1]], _beam(), offset=(0.0, 1.0))


def _beam():
    return BeamSection(second_moment=1.0).properties(CONCRETE)


class TestSupports:
    MODEL = Model(plane=False).with_mesh(Mesh.box((2.0, 1.0, 1.0), (2, 1, 1)), {"volume": Solids(CONCRETE)})

    def test_names(self):
        model = self.MODEL.with_supports("x_min/y_min", ("x", "z")).with_supports([5], ("y",))
        names = [support.name for support in model.supports]
        assert names == [
            "x_min/y_min.n1.x",
            "x_min/y_min.n1.z",
            "x_min/y_min.n7.x",
            "x_min/y_min.n7.z",
            "n6.y",
        ]
        with pytest.raises(InputError, match=r"'x_min/z_min.n1.x': is supported twice"):
            model.with_supports("x_min/z_min", ("x",))
        with pytest.raises(
            InputError, match=r"'x_mn': is not a known node or set of nodes. Did you mean 'x_m"
        ):
            model.with_supports("x_mn", ("x",))
        with pytest.raises(InputError, match="must have at least one node"):
            model.with_supports([], ("x",))

    def test_springs_below_a_face(self):
        model = self.MODEL.with_supports("z_min", ("x", "y"), stiffness={"z": 1e7}, name="soil")
        assert len(model.points) == 12 + 6
        assert [part.name for part in model.parts] == ["volume", "support soil"]
        for node in self.MODEL.nodes_of("z_max"):
            model = model.with_load(int(node), "z", -1000.0)
        system = compile_model(model).system
        u = displacements(system)
        reactions = (system.stiffness @ u)[system.prescribed]
        down = np.array([name.endswith(".z") for name in system.support_names])
        assert down.sum() == 6
        assert reactions[down].sum() == pytest.approx(6000.0)
        assert u.min() == pytest.approx(-1e-4, rel=0.05)

    def test_ten_thousand_at_once(self):
        model = Model(plane=False).with_nodes(np.random.default_rng(0).random((10_000, 3)))
        model = model.with_supports(np.arange(10_000), ("x", "y", "z"))
        assert len(model.supports) == 30_000
        assert model.supports[-1].name == "n10000.z"


def test_triangles_and_quadrilaterals_of_shells_share_a_constant_membrane_state():
    """One mesh of both kinds, pulled: the stress is the same everywhere (mixed sides are told to the triangles)."""
    points = np.array([[0, 0, 0], [1, 0, 0], [2.2, 0, 0], [0, 1, 0], [1.1, 1, 0], [2.2, 1, 0]], float)
    quads = CellBlock("quad4", np.array([[0, 1, 4, 3]]), np.array([1]))
    triangles = CellBlock("tri3", np.array([[1, 2, 5], [1, 5, 4]]), np.array([2, 3]))
    everything = {"plate": ((0, np.array([0])), (1, np.array([0, 1])))}
    mesh = Mesh(points, (quads, triangles), {}, everything, np.arange(1, 7))
    shells = Shells(Material(2e11, 0.3, 7850.0), thickness=0.01)
    model = Model(plane=False).with_mesh(mesh, {"plate": shells})
    stiffness = compile_model(model).system.stiffness.toarray()
    table = compile_model(model).table.number
    strain = 1e-3
    u = np.zeros(stiffness.shape[0])
    u[table[:, 0]] = strain * points[:, 0]
    u[table[:, 1]] = -0.3 * strain * points[:, 1]
    forces = stiffness @ u
    pull = 2e11 * strain * 0.01
    assert np.allclose([forces[table[n, 0]] for n in (2, 5)], 0.5 * pull, rtol=1e-9)
    assert abs(forces[table[1, 0]]) < 1e-9 * pull
    assert abs(forces[table[4, 0]]) < 1e-9 * pull
