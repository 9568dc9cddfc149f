"""Structures and vehicles from meshes: from files and made of cells, against models built by hand."""

import re
from pathlib import Path

import numpy as np
import pytest
from ruamel.yaml import YAML

import axlespan as asp
from axlespan.errors import InputError
from axlespan.interaction.runs import run_plan
from axlespan.io.meshes import write_gmsh
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import factorize
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Solids
from axlespan.model.mesh import CellBlock, Mesh
from axlespan.running.surface import line_over
from axlespan.study import read_case, schema
from axlespan.study.build import build

CONCRETE = "materials: {concrete: {youngs_modulus: 30 GPa, poisson_ratio: 0.2, density: 2500 kg/m^3}}"
BOX = "mesh: {box: {lengths: [12 m, 1 m, 1 m], divisions: [12, 2, 2]}}"
ENDS = "supports: [{at: {x: 0 m, z: 0.5 m}, fixed: [x, y, z], name: left}, {at: {x: 12 m, z: 0.5 m}, fixed: [y, z], name: right}]"
TOP = "running_line: {from: [0 m, 0.5 m, 1 m], to: [12 m, 0.5 m, 1 m]}"
REST = """\
train:
  - {vehicle: sprung-mass, mass: 5750 kg, stiffness: 1595 kN/m, count: 2, spacing: 3 m}
crossing: {speed: 90 km/h}
analysis: {time_step: 2 ms, steps: 300, alpha: -0.05}
output: {sensors: {midspan: 6 m}}
"""


def built_of(*keys, folder=".", rest=REST):
    lines = "".join(f"  {key}\n" for key in ("kind: mesh", *keys))
    return build(read_case(f"structure:\n{lines}{rest}", folder=folder))


def solid(*changes, folder="."):
    """The box beam with some of its lines replaced: those that begin alike."""
    keys = {
        line.partition(":")[0]: line
        for line in (BOX, CONCRETE, "sections: {volume: {material: concrete}}", ENDS, TOP)
    }
    return built_of(*({**keys, **{line.partition(":")[0]: line for line in changes}}.values()), folder=folder)


def deflection(built, position):
    """Displacement under a unit load [m/N]."""
    blocks, system = built.plan.structure, built.crossing.structure.system
    row = built.crossing.structure.line().rows([position], system.size)[:, system.free].toarray()[0]
    return float(row @ factorize(blocks.K).solve(row.copy()))


def assert_same(result, reference, tolerance=1e-8):
    for name in ("sensor_displacement", "vehicle_displacement", "contact_force", "support_reaction"):
        ours, theirs = getattr(result, name), getattr(reference, name)
        assert ours.shape == theirs.shape, name
        assert np.abs(ours - theirs).max() <= tolerance * np.abs(theirs).max(), name


# --- solids -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def box():
    built = solid()
    return built, run_plan(built.plan)


def test_a_box_of_cells_is_the_model_built_by_hand(box):
    built, result = box
    mesh = Mesh.box((12.0, 1.0, 1.0), (12, 2, 2))
    model = asp.Model(plane=False).with_mesh(mesh, {"volume": Solids(asp.Material(30e9, 0.2, 2500.0))})
    x = mesh.points
    for name, at, held in (("left", 0.0, ("x", "y", "z")), ("right", 12.0, ("y", "z"))):
        nodes = np.flatnonzero((x[:, 0] == at) & (x[:, 2] == 0.5))
        model = model.with_supports(nodes, held, name=name)
    compiled = compile_model(model)
    line = line_over(model, compiled.table, [[0.0, 0.5, 1.0], [12.0, 0.5, 1.0]])
    train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), 2, 3.0)
    reference = asp.simulate(
        asp.Crossing(asp.Structure(compiled.system, {"main": line}), train, speed=25.0),
        time_step=2e-3,
        steps=300,
        method=asp.Alpha(-0.05),
        sensors={"midspan": 6.0},
    )
    assert_same(result, reference, 1e-12)
    assert result.support[:3] == ("left.n40.x", "left.n40.y", "left.n40.z")
    assert built.facts == (
        "mesh        117 nodes, 48 hex8; volume (solid, concrete)",
        "d.o.f.      351, 15 of them at supports",
        "mass        x 30 t, y 30 t, z 30 t",
        "line        main: 0 to 12 m, 12 pieces, linear",
    )
    assert built.warnings == ()


@pytest.mark.parametrize("version", ["4.1", "2.2"])
def test_a_gmsh_file_gives_the_same_crossing(box, tmp_path, version):
    write_gmsh(Mesh.box((12.0, 1.0, 1.0), (12, 2, 2)), tmp_path / "beam.msh", version=version)
    keys = {
        line.partition(":")[0]: line
        for line in (CONCRETE, "sections: {volume: {material: concrete}}", ENDS, TOP)
    }
    built = built_of("file: beam.msh", *keys.values(), folder=tmp_path)
    assert_same(run_plan(built.plan), box[1])
    assert built.crossing.structure.name == "beam"


def test_units_axes_and_numbers_of_the_file(box, tmp_path):
    """The same mesh in mm, y up, its nodes numbered from 1001 in another order."""
    mesh = Mesh.box((12.0, 1.0, 1.0), (12, 2, 2))
    order = np.random.default_rng(2).permutation(mesh.n_node)  # of the new nodes, the old one
    place = np.argsort(order)
    points = 1e3 * mesh.points[order][:, [0, 2, 1]] * [1.0, 1.0, -1.0]
    moved = Mesh(
        points,
        (CellBlock("hex8", place[mesh.blocks[0].nodes], mesh.blocks[0].labels),),
        {name: place[nodes] for name, nodes in mesh.node_sets.items()},
        mesh.element_sets,
        np.arange(1001, 1001 + mesh.n_node),
    )
    write_gmsh(moved, tmp_path / "beam.msh")
    built = built_of(
        *("file: beam.msh", "unit: mm", "up: y", CONCRETE, "sections: {volume: {material: concrete}}"),
        ENDS,
        "running_line: {nodes: {y: 0.5 m, z: 1 m}}",
        folder=tmp_path,
    )
    result = run_plan(built.plan)
    for name in ("vehicle_displacement", "contact_force", "sensor_displacement"):
        ours, theirs = getattr(result, name), getattr(box[1], name)
        assert np.abs(ours - theirs).max() < 1e-8 * np.abs(theirs).max()
    numbers = {int(name.split(".")[1].removeprefix("n")) for name in result.support}
    ends = np.flatnonzero(np.isin(mesh.points[:, 0], [0.0, 12.0]) & (mesh.points[:, 2] == 0.5))
    assert numbers == set((1001 + place[ends]).tolist())


def test_quadratic_elements_and_full_integration():
    """Uniform load of a simple span: 5 q L^4 / (384 E I) plus shear, by work: sum of deflections over the line."""
    length, inertia, shear = 12.0, 1.0 / 12.0, 30e9 / 2.4 * 5.0 / 6.0
    exact = length**3 / (48.0 * 30e9 * inertia) + length / (4.0 * shear)
    fine = deflection(
        solid("mesh: {box: {lengths: [12 m, 1 m, 1 m], divisions: [12, 2, 2], elements: hex20}}"), 6.0
    )
    modes, full = (
        deflection(solid(), 6.0),
        deflection(solid("sections: {volume: {material: concrete, formulation: full}}"), 6.0),
    )
    # a point load dents the top: some percent on top of beam theory
    assert 1.0 < fine / exact < 1.12
    assert fine / 1.1 < modes < fine
    assert full < 0.92 * modes  # locked in shear


def test_the_coarse_example_bends_as_a_beam():
    case = Path(asp.__file__).parent / "examples" / "solid-beam-coarse.yaml"
    built = build(read_case(case.read_text(encoding="utf-8"), folder=case.parent))
    modes = lowest_modes(built.plan.structure.K, built.plan.structure.M, 1)
    assert 2.0 * np.pi * modes.frequencies[0] == pytest.approx(29.59, rel=2e-3)  # N12's fine mesh


def test_the_solid_example_is_n12s(monkeypatch):
    """36 663 d.o.f., 66 of them prescribed: the case is read and its supports are chosen, without matrices."""
    from axlespan.study import build_model

    case = Path(asp.__file__).parent / "examples" / "neves2012-3.2-solid.yaml"
    structure = read_case(case.read_text(encoding="utf-8"), folder=case.parent).case.structure
    mesh = build_model.mesh_of(structure)
    book = build_model.book_of(mesh, {})
    held = [book.chosen(support.at, "supports") for support in structure.supports]
    assert (3 * mesh.n_node, 3 * sum(map(len, held))) == (36663, 66)
    assert structure.materials["concrete"].density * 2.2272 * 2.5 == pytest.approx(2303.0, rel=1e-6)


# --- beams, shells, planes ----------------------------------------------------------------------------

BEAM = (
    "mesh: {line: {from: [0 m, 0 m, 0 m], to: [12 m, 0 m, 0 m], divisions: 8}}",
    CONCRETE,
    "supports: [{at: start, fixed: [x, z], name: left}, {at: end, fixed: [z], name: right}]",
)


@pytest.mark.parametrize("line", ["{nodes: line}", "{from: [0 m, 0 m, 0 m], to: [12 m, 0 m, 0 m]}"])
def test_beams_in_a_plane_are_the_simple_span(line):
    section = "sections: {line: {material: concrete, area: 0.8 m^2, second_moment_y: 0.09 m^4}}"
    built = built_of(*BEAM, "plane: true", section, f"running_line: {line}")
    span = (
        "structure: {kind: simple-span, length: 12 m, youngs_modulus: 30 GPa, second_moment: 0.09 m^4, "
        "mass_per_length: 2000 kg/m, area: 0.8 m^2, elements: 8}\n"
    )
    assert_same(run_plan(built.plan), run_plan(build(read_case(span + REST)).plan))
    assert built.facts[3] == "line        main: 0 to 12 m, 8 pieces, cubic"


def test_beams_in_space_with_offset_and_orientation():
    """On edge: the axis of the stronger moment turned sideways, 0.4 m above the nodes that the wheels run on."""
    section = (
        "sections: {line: {material: concrete, area: 0.8 m^2, second_moment_y: 0.03 m^4, second_moment_z: 0.09 m^4, "
        "torsion_constant: 0.05 m^4, orientation: [0, 1, 0], offset: [0 m, 0 m, 0.4 m]}}"
    )
    ends = "supports: [{at: start, fixed: [x, y, z, rx], name: left}, {at: end, fixed: [y, z], name: right}]"
    built = built_of(BEAM[0], CONCRETE, ends, section, "running_line: {nodes: line}")
    assert deflection(built, 6.0) == pytest.approx(12.0**3 / (48.0 * 30e9 * 0.09), rel=1e-9)
    assert built.crossing.structure.system.total_mass("y") == pytest.approx(24e3)


def test_plane_elements_and_two_lines():
    """A wall of 0.5 m seen from the side; the second line has an origin of its own."""
    keys = (
        "plane: true",
        "mesh: {rectangle: {lengths: [12 m, 1 m], divisions: [24, 4], plane: xz}}",
        CONCRETE,
        "sections: {surface: {material: concrete, thickness: 0.5 m}}",
        "supports: [{at: x_min/z_min, fixed: [x, z]}, {at: x_max/z_min, fixed: [z]}]",
        "running_lines: {up: {nodes: z_max}, low: {points: [[3 m, 0 m, 1 m], [9 m, 0 m, 1 m]], start: 100 m}}",
    )
    built = built_of(*keys, rest=REST.replace("midspan: 6 m", "middle: n113"))
    lines = built.crossing.structure.lines
    assert list(lines) == ["up", "low"]
    assert (lines["low"].start, lines["low"].stop) == (100.0, 106.0)
    exact = 12.0**3 / (48.0 * 30e9 * 0.5 / 12.0) + 12.0 / (4.0 * 30e9 / 2.4 * 0.5 * 5.0 / 6.0)
    assert deflection(built, 6.0) == pytest.approx(exact, rel=0.06)
    assert built.plan.settings.sensors["middle"] == pytest.approx(6.0)
    assert built.crossing.structure.system.total_mass() == pytest.approx(15e3)


SHELL_BRIDGE = (
    "mesh: {rectangle: {lengths: [12 m, 4 m], divisions: [24, 4]}}",
    CONCRETE,
    "sections: {surface: {material: concrete, thickness: 0.5 m}}",
    "supports: [{at: x_min, fixed: [x, y, z], name: left}, {at: x_max, fixed: [z], name: right}]",
    "running_lines: {left-wheels: {nodes: {y: 3 m}}, right-wheels: {from: [0 m, 1 m, 0 m], to: [12 m, 1 m, 0 m]}}",
)
SPRING = "stiffness: {x: 1 MN/m, y: 1 MN/m, z: 300 kN/m}, damping: {z: 5 kNs/m}"
SHELL_CAR = f"""\
train:
  - vehicle: mesh
    mesh: {{rectangle: {{lengths: [4 m, 2 m], divisions: [4, 2], origin: [0 m, 1 m, 1.5 m]}}}}
    materials: {{steel: {{youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7.85 t/m^3}}}}
    sections: {{surface: {{material: steel, thickness: 40 mm}}}}
    points:
      spare: [2 m, 2 m, 0.3 m]
      front-left: [4 m, 3 m, 0 m]
      front-right: [4 m, 1 m, 0 m]
      rear-left: [0 m, 3 m, 0 m]
      rear-right: [0 m, 1 m, 0 m]
    springs:
      - {{between: [x_max/y_max, front-left], {SPRING}}}
      - {{between: [x_max/y_min, front-right], {SPRING}}}
      - {{between: [x_min/y_max, rear-left], {SPRING}}}
      - {{between: [x_min/y_min, rear-right], {SPRING}}}
    masses: [{{at: {{z: 0 m}}, mass: 60 kg}}]
    supports: [{{at: {{z: 0 m}}, fixed: [x, y]}}]
    wheels: [{{at: {{y: 3 m, z: 0 m}}, line: left-wheels}}, {{at: {{y: 1 m, z: 0 m}}, line: right-wheels}}]
crossing: {{speed: 20 m/s, start: -1 m}}
analysis: {{time_step: 1 ms, steps: 900}}
output: {{sensors: {{midspan: 6 m}}}}
"""


def test_a_vehicle_of_shells_crosses_a_bridge_of_shells():
    """Both rails deflect alike; weights, wheels and the quasi-static deflection by hand."""
    built = built_of(*SHELL_BRIDGE, rest=SHELL_CAR)
    vehicle = built.crossing.train.placements[0].vehicle
    mass = 7850.0 * 4.0 * 2.0 * 0.04 + 4.0 * 60.0
    np.testing.assert_allclose(vehicle.static_forces(9.81), 9.81 * mass / 4.0, rtol=1e-9)
    assert [(p.dof, p.behind, p.line) for p in vehicle.contacts] == [
        ("front-left.z", 0.0, "left-wheels"),
        ("front-right.z", 0.0, "right-wheels"),
        ("rear-left.z", 4.0, "left-wheels"),
        ("rear-right.z", 4.0, "right-wheels"),
    ]
    assert not vehicle.is_multibody
    result = run_plan(built.plan)
    np.testing.assert_allclose(result.contact_force[:, 0], result.contact_force[:, 1], rtol=1e-9)
    assert result.checks["equilibrium_residual"] < 1e-8 and result.checks["tension_episodes"] == 0
    # two axles 4 m apart about the middle of a beam 4 m wide; a plate of this width bends nearly as beams do
    force, stiffness, a = 9.81 * mass / 2.0, 30e9 * 4.0 * 0.5**3 / 12.0, 4.0
    static = 2.0 * force * a * (3.0 * 12.0**2 - 4.0 * a**2) / (48.0 * stiffness)
    system = built.crossing.structure.system
    rows = [
        built.crossing.structure.line(name).rows([4.0, 8.0], system.size)[:, system.free]
        for name in ("left-wheels", "right-wheels")
    ]
    load = 0.5 * force * sum(row.sum(axis=0) for row in rows)
    u = factorize(built.plan.structure.K).solve(np.asarray(load).ravel().copy())
    middle = built.crossing.structure.line().rows([6.0], system.size)[:, system.free]
    assert float((middle @ u)[0]) == pytest.approx(static, rel=0.02)
    # the first frequency is 5.5 Hz: 20 m/s over 12 m shakes it a little
    assert 1.0 < -result.sensor_displacement.min() / static < 1.25


def test_wheels_without_names_get_their_usual_ones():
    """A beam on two of its own nodes; node sets without points."""
    car = """\
train:
  - vehicle: mesh
    plane: true
    mesh: {line: {from: [0 m, 0 m, 0 m], to: [4 m, 0 m, 0 m], divisions: 4}}
    materials: {steel: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7.85 t/m^3}}
    sections: {line: {material: steel, area: 0.02 m^2, second_moment_y: 4e-5 m^4}}
    damping: {kind: rayleigh, alpha: 0.5 1/s, beta: 0.1 ms}
    supports: [{at: n1, fixed: [x]}]
    wheels: [{at: start}, {at: end}]
crossing: {speed: 20 m/s}
analysis: {time_step: 1 ms, steps: 100}
"""
    section = "sections: {line: {material: concrete, area: 0.8 m^2, second_moment_y: 0.09 m^4}}"
    built = built_of(*BEAM, "plane: true", section, "running_line: {nodes: line}", rest=car)
    vehicle = built.crossing.train.placements[0].vehicle
    assert [(p.dof, p.behind) for p in vehicle.contacts] == [("wheel1.z", 0.0), ("wheel2.z", 4.0)]
    assert "n3.z" in vehicle.system.dof_names and "wheel2.ry" in vehicle.system.dof_names
    np.testing.assert_allclose(vehicle.static_forces(9.81), 9.81 * 7850.0 * 0.02 * 4.0 / 2.0)
    result = run_plan(built.plan)
    assert "1.n3.z" in result.vehicle_dof


def test_any_vehicle_may_run_on_another_line():
    train = "{vehicle: sprung-mass, mass: 5750 kg, stiffness: 1595 kN/m, count: 2, spacing: 3 m}"
    rest = REST.replace(train, train.replace("}", ", line: right-wheels}"))
    built = built_of(*SHELL_BRIDGE, rest=rest)
    assert {point.line for _, _, point, _ in built.crossing.train.contacts} == {"right-wheels"}
    left = run_plan(built_of(*SHELL_BRIDGE, rest=rest.replace("right-wheels", "left-wheels")).plan)
    right = run_plan(built.plan)
    # the bridge is symmetric about y = 2 m, and the sensor stands on the left line
    assert np.abs(right.contact_force / left.contact_force - 1.0).max() < 1e-9
    assert 0.7 < right.sensor_displacement.min() / left.sensor_displacement.min() < 0.99


@pytest.mark.parametrize("name", ["neves2012-3.2-solid", "solid-beam-coarse", "own-matrices"])
def test_the_schema_takes_the_shipped_examples(name):
    jsonschema = pytest.importorskip("jsonschema")
    text = (Path(asp.__file__).parent / "examples" / f"{name}.yaml").read_text(encoding="utf-8")
    errors = jsonschema.Draft202012Validator(schema()).iter_errors(YAML(typ="safe", pure=True).load(text))
    assert [error.message for error in errors] == []


# --- links, ties, springs, masses ---------------------------------------------------------------------


def two_boxes(gap=0.0):
    """Halves of the box beam, each with sets of its own, their nodes apart at x = 6 m."""
    left = Mesh.box((6.0, 1.0, 1.0), (6, 2, 2))
    right = Mesh.box((6.0, 1.0, 1.0), (6, 2, 2), origin=(6.0 + gap, 0.0, 0.0))
    halves = []
    for mesh, name in ((left, "a"), (right, "b")):
        sets = {f"{name}_{face}": nodes for face, nodes in mesh.node_sets.items()}
        halves.append(Mesh(mesh.points, mesh.blocks, sets, {f"half_{name}": mesh.element_sets["volume"]}))
    return halves[0].merged(halves[1])


HALVES = "sections: {half_a: {material: concrete}, half_b: {material: concrete}}"


@pytest.mark.parametrize(
    "join",
    [
        "merge: 1 mm",
        "ties: [{nodes: b_x_min, to: a_x_max}]",
        "ties: [{nodes: a_x_max, to: b_x_min, components: [x, y, z]}]",
    ],
)
def test_halves_that_are_merged_or_tied_are_one_beam(box, tmp_path, join):
    write_gmsh(two_boxes(), tmp_path / "halves.msh")
    built = built_of("file: halves.msh", CONCRETE, HALVES, ENDS, TOP, join, folder=tmp_path)
    result = run_plan(built.plan)
    for name in ("vehicle_displacement", "contact_force"):
        ours, theirs = getattr(result, name), getattr(box[1], name)
        assert np.abs(ours - theirs).max() < 1e-8 * np.abs(theirs).max(), name
    assert built.warnings == ()


def test_halves_that_nothing_joins(tmp_path):
    write_gmsh(two_boxes(), tmp_path / "halves.msh")
    with pytest.raises(InputError) as caught:
        one = "supports: [{at: a_x_min, fixed: [x, y, z]}]"
        built_of("file: halves.msh", CONCRETE, HALVES, one, TOP, folder=tmp_path)
    assert str(caught.value) == (
        "case.yaml:6:13: structure.supports = [{at: a_x_min, fixed: [x, y, z]}]: a part of 'half_b' is connected to no support: "
        "63 nodes (64, 65, 66, 67, 68, 69, …) are apart from the rest. Nodes 7, 64 are at the same place: merge: 1 mm joins "
        "such nodes"
    )


def test_a_rigid_link_and_a_spring_hold_a_beam_end():
    """Bearing of 50 MN/m below the end face, which follows a point as a rigid body: the beam's end sinks by F / k."""
    keys = (
        "points: {bearing: [12 m, 0.5 m, 0 m], ground: [12 m, 0.5 m, -0.5 m]}",
        "rigid_links: [{master: bearing, nodes: x_max}]",
        "springs: [{between: [bearing, ground], stiffness: {z: 50 MN/m}}]",
        "supports: [{at: {x: 0 m, z: 0.5 m}, fixed: [x, y, z]}, {at: ground, fixed: [z]}, {at: bearing, fixed: [y, rx, rz]}]",
    )
    built = solid(*keys)
    stiff = solid(*(key.replace("50 MN/m", "50e6 MN/m") for key in keys))
    assert deflection(built, 12.0) - deflection(stiff, 12.0) == pytest.approx(1.0 / 50e6, rel=1e-5)
    assert deflection(built, 6.0) - deflection(stiff, 6.0) == pytest.approx(0.25 / 50e6, rel=1e-5)
    assert "ground.z" in built.crossing.structure.system.support_names


def test_point_masses(box):
    built = solid("masses: [{at: {x: 6 m, z: 1 m}, mass: 2 t}, {at: n1, mass: 100 kg}]")
    system = built.crossing.structure.system
    for axis in "xyz":
        assert system.total_mass(axis) == pytest.approx(30e3 + 3 * 2e3 + 100.0)


def test_elastic_supports_stand_at_each_node():
    built = solid(
        "supports: [{at: {x: 0 m, z: 0.5 m}, fixed: [x, y], stiffness: {z: 20 MN/m}}, {at: {x: 12 m, z: 0.5 m}, fixed: [y, z]}]"
    )
    assert deflection(built, 0.0) - deflection(solid(), 0.0) == pytest.approx(1.0 / (3 * 20e6), rel=1e-3)


# --- what is wrong ------------------------------------------------------------------------------------


def test_shells_need_a_thickness_and_beams_their_moments():
    with pytest.raises(InputError) as caught:
        built_of(SHELL_BRIDGE[0], CONCRETE, "sections: {surface: {material: concrete}}", *SHELL_BRIDGE[3:])
    assert str(caught.value) == (
        "case.yaml:5:14: structure.sections.surface.thickness: is missing for shells. Add thickness: 300 mm"
    )
    with pytest.raises(InputError) as caught:
        built_of(
            BEAM[0],
            CONCRETE,
            BEAM[2],
            "sections: {line: {material: concrete, area: 0.5 m^2, second_moment_y: 0.1 m^4}}",
            "running_line: {nodes: line}",
        )
    assert str(caught.value) == (
        "case.yaml:6:14: structure.sections.line.second_moment_z: is missing for beams. Add second_moment_z: 0.9 m^4\n"
        "case.yaml:6:14: structure.sections.line.torsion_constant: is missing for beams. Add torsion_constant: 0.4 m^4"
    )


WHEELS = "wheels: [{at: {y: 3 m, z: 0 m}, line: left-wheels}, {at: {y: 1 m, z: 0 m}, line: right-wheels}]"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("fixed: [x, y]", "fixed: [y]", "must stand on its wheels, but can move freely at"),
        (
            WHEELS,
            "wheels: [{at: front-left}, {at: front-left}]",
            "train.0.wheels = [{at: front-left}, {at: front-left}]: names a node twice",
        ),
        (
            WHEELS,
            "wheels: spare",
            "train.0.wheels = spare: has nodes without a vertical d.o.f.: spare. Choose nodes of elements or springs",
        ),
        (
            WHEELS,
            WHEELS + "\n    damping: {kind: modal, ratio: 1 %}",
            "train.0.damping = {kind: modal, ratio: 1 %}: must be of the kind rayleigh for vehicles. "
            "Write {kind: rayleigh, alpha: 0 1/s, beta: 0.1 ms}",
        ),
        (
            "line: left-wheels",
            "line: left-wheel",
            "train.0: running line = 'left-wheel': is not a known running line. Did you mean 'left-wheels'?",
        ),
    ],
)
def test_wrong_vehicles(old, new, expected):
    assert old in SHELL_CAR
    with pytest.raises(InputError) as caught:
        built_of(*SHELL_BRIDGE, rest=SHELL_CAR.replace(old, new, 1))
    assert expected in re.sub(r"case.yaml:\d+:\d+: ", "", str(caught.value))
