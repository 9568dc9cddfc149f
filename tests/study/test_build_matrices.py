"""Structures and vehicles from matrices and modes: as exported, read back and crossed."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp
from ruamel.yaml import YAML
from scipy.linalg import eigh

import axlespan as asp
from axlespan.cli.examples import list_or_copy
from axlespan.errors import InputError
from axlespan.interaction.runs import run_plan
from axlespan.io.matrices import (
    DofMap,
    ModalModel,
    NodeTable,
    write_abaqus,
    write_coordinates,
    write_dof_map,
    write_harwell_boeing,
    write_matrix_market,
    write_modal,
    write_npz,
)
from axlespan.linalg.eigen import lowest_modes
from axlespan.model.compile import Compiled, compile_model
from axlespan.model.from_mesh import Solids
from axlespan.model.mesh import Mesh
from axlespan.running.line import path_on_beams
from axlespan.running.surface import line_over
from axlespan.study import load_case, read_case, schema
from axlespan.study.build import build

STEPS = 250
REST = """\
train:
  - {vehicle: sprung-mass, mass: 5750 kg, stiffness: 1595 kN/m, count: 2, spacing: 3 m}
crossing: {speed: 100 km/h}
analysis: {time_step: 2 ms, steps: 250, alpha: -0.05}
output: {sensors: {midspan: 12.5 m, quarter: 6.25 m}}
"""
MATRICES = "kind: matrices, stiffness: K, mass: M"


@dataclass(frozen=True)
class Body:
    """A free body, what holds it in the case and the nodes of its running line."""

    compiled: Compiled
    model: asp.Model
    supports: tuple[tuple[int, tuple[str, ...]], ...]  # node (from 1), components
    line: tuple[int, ...]  # nodes from 1
    dofs: DofMap
    nodes: NodeTable

    @property
    def written_supports(self) -> str:
        return ", ".join(f"{{at: {node}, fixed: [{', '.join(held)}]}}" for node, held in self.supports)

    def reference(self):
        """The same crossing of the structure as it stands in the program that exported it."""
        model = self.model
        for node, held in self.supports:
            model = model.with_support(f"n{node}", held)
        compiled = compile_model(model)
        chain = [node - 1 for node in self.line]
        if "ry" in self.dofs.components:
            line = path_on_beams(model, compiled.table, chain)
        else:
            line = line_over(model, compiled.table, model.points[chain])
        structure = asp.Structure(compiled.system, {"main": line}, model=model)
        train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), 2, 3.0)
        return asp.simulate(
            asp.Crossing(structure, train, speed=100.0 / 3.6),
            time_step=2e-3,
            steps=STEPS,
            method=asp.Alpha(-0.05),
            sensors={"midspan": 12.5, "quarter": 6.25},
        )


def body_of(model, supports, line, sets):
    compiled = compile_model(model)
    names = [name.rpartition(".") for name in compiled.system.dof_names]
    dofs = DofMap(np.array([int(node[1:]) for node, _, _ in names]), tuple(c for *_, c in names))
    nodes = NodeTable(np.arange(1, len(model.points) + 1), model.points, sets)
    return Body(compiled, model, supports, line, dofs, nodes)


@pytest.fixture(scope="module")
def beam():
    n = 8
    section = asp.BeamSection(second_moment=2.90, area=5.568, mass_per_length=2303.0)
    x = np.linspace(0.0, 25.0, n + 1)
    pairs = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    model = asp.Model(plane=True).with_nodes(np.column_stack([x, 0.0 * x]))
    model = model.with_beams(pairs, section.properties(asp.Material(2.87e9)))
    return body_of(
        model, ((1, ("x", "z")), (n + 1, ("z",))), tuple(range(1, n + 2)), {"deck": np.arange(1, n + 2)}
    )


@pytest.fixture(scope="module")
def solid():
    mesh = Mesh.box((25.0, 2.0, 2.5), (8, 2, 2))
    model = asp.Model(plane=False).with_mesh(mesh, {"volume": Solids(asp.Material(2.87e9, 0.2, 460.0))})
    x = mesh.points
    ends = [
        (int(i) + 1, ("x", "y", "z") if x[i, 0] == 0.0 else ("y", "z"))
        for i in np.flatnonzero(np.isin(x[:, 0], [0.0, 25.0]) & (x[:, 2] == 1.25))
    ]
    top = np.flatnonzero((x[:, 1] == 1.0) & (x[:, 2] == 2.5))
    return body_of(model, tuple(ends), tuple((top + 1).tolist()), {"deck": top + 1})


@pytest.fixture(scope="module")
def references(beam, solid):
    return {"beam": (beam, beam.reference()), "solid": (solid, solid.reference())}


def export(body, folder, form):
    """Write K and M as a program does; what the case then says beside ``kind: matrices``."""
    system = body.compiled.system
    keys, ending = "", {"harwell-boeing": ".hb"}.get(form, "")
    for name, matrix in (("K", system.stiffness), ("M", system.mass)):
        path = folder / f"{name}{ending}"
        if form == "matrix-market":
            write_matrix_market(matrix, path)
        elif form == "npz":
            write_npz(matrix, path)
        elif form == "abaqus":
            write_abaqus(matrix, path, body.dofs)
        elif form == "abaqus-coordinates":
            write_abaqus(matrix, path, layout="coordinate")
        else:
            write_harwell_boeing(matrix, path, dofs=body.dofs)
    if form not in ("abaqus", "harwell-boeing"):
        write_dof_map(body.dofs, folder / "dofs.csv")
        keys = ", dofs: dofs.csv"
    write_coordinates(body.nodes, folder / "nodes.csv")
    return f"kind: matrices, stiffness: K{ending}, mass: M{ending}, coordinates: nodes.csv{keys}"


def crossed(structure, folder, rest=REST):
    built = build(read_case(f"structure: {{{structure}}}\n{rest}", folder=folder))
    return built, run_plan(built.plan)


def assert_same(result, reference, tolerance=1e-8):
    for name in (
        "sensor_displacement",
        "vehicle_displacement",
        "vehicle_velocity",
        "contact_force",
        "support_reaction",
    ):
        ours, theirs = getattr(result, name), getattr(reference, name)
        assert ours.shape == theirs.shape, name
        assert np.abs(ours - theirs).max() <= tolerance * np.abs(theirs).max(), name


@pytest.mark.parametrize("kind", ["beam", "solid"])
@pytest.mark.parametrize("form", ["matrix-market", "npz", "abaqus", "abaqus-coordinates", "harwell-boeing"])
def test_exported_matrices_give_the_same_crossing(references, tmp_path, kind, form):
    body, reference = references[kind]
    keys = export(body, tmp_path, form)
    built, result = crossed(
        f"{keys}, supports: [{body.written_supports}], running_line: {{nodes: deck}}", tmp_path
    )
    assert_same(result, reference)
    assert built.facts[0] == (
        f"matrices    {len(body.dofs)} d.o.f., {len(body.supports) + (1 if kind == 'beam' else 9)} at supports of the case"
        if kind == "beam"
        else f"matrices    {len(body.dofs)} d.o.f., 15 at supports of the case"
    )
    ways = {"beam": "9 nodes, cubic by their rotations", "solid": "9 nodes, linear"}
    assert built.facts[-1] == f"line        main: 0 to 25 m, {ways[kind]}"


@pytest.mark.parametrize("kind", ["beam", "solid"])
def test_all_modes_give_the_same_crossing(references, tmp_path, kind):
    """φᵀ M φ = 1 times 3 kg: modal masses are those of the shapes as they come."""
    body, reference = references[kind]
    system = body.compiled.system
    held = [body.dofs.row(node, c) for node, components in body.supports for c in components]
    free = np.setdiff1d(np.arange(system.size), held)
    squares, shapes = eigh(
        system.stiffness.toarray()[np.ix_(free, free)], system.mass.toarray()[np.ix_(free, free)]
    )
    modal = ModalModel(
        np.sqrt(squares) / (2.0 * np.pi),
        np.full(len(free), 3.0),
        np.sqrt(3.0) * shapes,
        body.dofs.taken(free),
    )
    write_modal(modal, tmp_path / "modes.npz")
    write_coordinates(body.nodes, tmp_path / "nodes.csv")
    built, result = crossed(
        "kind: matrices, modes: modes.npz, coordinates: nodes.csv, running_line: {nodes: deck}", tmp_path
    )
    for name in ("sensor_displacement", "vehicle_displacement", "contact_force"):
        ours, theirs = getattr(result, name), getattr(reference, name)
        assert np.abs(ours - theirs).max() <= 1e-8 * np.abs(theirs).max(), name
    assert built.facts[1] == "mass        not known from modes"
    assert result.facts["structure_dofs"] == len(free)


def test_few_modes_as_tables(references, tmp_path):
    """Three modes of the beam, by CSV; the beam's own modes carry nearly all of it."""
    body, reference = references["beam"]
    n = np.arange(1, 4)
    x = body.nodes.points[:, 0]
    frequency = n**2 * np.pi / 2.0 / 25.0**2 * np.sqrt(2.87e9 * 2.90 / 2303.0)
    (tmp_path / "modes.csv").write_text(
        "mode,frequency,mass,ratio\n"
        + "".join(f"{i},{f:.12g},{2303.0 * 12.5},0\n" for i, f in zip(n, frequency, strict=True))
    )
    rows = []
    for node, at in zip(range(1, 10), x, strict=True):
        rows.append(f"{node},UZ,{','.join(f'{v:.12g}' for v in np.sin(n * np.pi * at / 25.0))}")
        rows.append(
            f"{node},ROTY,{','.join(f'{v:.12g}' for v in -n * np.pi / 25.0 * np.cos(n * np.pi * at / 25.0))}"
        )
    (tmp_path / "shapes.csv").write_text("\n".join(rows) + "\n")
    write_coordinates(body.nodes, tmp_path / "nodes.csv")
    built, result = crossed(
        "kind: matrices, modes: modes.csv, shapes: shapes.csv, coordinates: nodes.csv, "
        "running_line: {nodes: [1, 2, 3, 4, 5, 6, 7, 8, 9]}",
        tmp_path,
    )
    ours, theirs = result.vehicle_displacement, reference.vehicle_displacement
    assert np.abs(ours - theirs).max() < 5e-3 * np.abs(theirs).max()  # what the modes above carry
    assert built.facts[0] == "modes       3, from 4.778 to 43 Hz; shapes at 18 d.o.f."


@pytest.mark.parametrize("force, length, scale", [("kN", "m", 1.0), ("N", "mm", 1e-3), ("kip", "ft", 0.3048)])
def test_units_of_the_other_program(references, tmp_path, force, length, scale):
    body, reference = references["beam"]
    newton = {"kN": 1e3, "N": 1.0, "kip": 4448.2216152605}[force]
    system = body.compiled.system
    d = sp.diags_array([scale if c in "xyz" else 1.0 for c in body.dofs.components])
    for name, matrix in (("K", system.stiffness), ("M", system.mass)):
        write_matrix_market(sp.csr_array(d @ matrix @ d / (newton * scale)), tmp_path / name)
    write_dof_map(body.dofs, tmp_path / "dofs.csv")
    write_coordinates(
        NodeTable(body.nodes.labels, body.nodes.points / scale, body.nodes.sets), tmp_path / "nodes.csv"
    )
    _, result = crossed(
        f"{MATRICES}, dofs: dofs.csv, coordinates: nodes.csv, units: {{force: {force}, length: {length}}}, "
        f"supports: [{body.written_supports}], running_line: {{nodes: deck}}",
        tmp_path,
    )
    assert_same(result, reference)


def test_rows_without_names_and_a_table_of_the_line(references, tmp_path):
    """Supports are eliminated already; only the rows of the vertical d.o.f. are known."""
    body, _ = references["beam"]
    held = [body.dofs.row(1, "x"), body.dofs.row(1, "z"), body.dofs.row(9, "z")]
    keep = np.setdiff1d(np.arange(27), held)
    system = body.compiled.system
    for name, matrix in (("K", system.stiffness), ("M", system.mass)):
        write_npz(sp.csr_array(matrix[keep][:, keep]), tmp_path / name)
    rows = [int(np.flatnonzero(keep == body.dofs.row(node, "z"))[0]) + 1 for node in range(2, 9)]
    positions = [3.125 * i for i in range(1, 8)]
    listed = f"{{dofs: {rows}, positions: {positions}}}"
    built, one = crossed(f"{MATRICES}, running_line: {listed}", tmp_path)
    assert built.facts == (
        "matrices    24 d.o.f., 0 at supports of the case",
        "line        main: 3.125 to 21.875 m, 7 nodes, linear",
    )
    (tmp_path / "line.csv").write_text(
        "dof, position\n" + "".join(f"{row}, {at}\n" for row, at in zip(rows, positions, strict=True))
    )
    _, other = crossed(f"{MATRICES}, running_line: {{file: line.csv}}", tmp_path)
    np.testing.assert_array_equal(one.contact_force, other.contact_force)
    # with names the rotations are known too, and the line is the beam's own between its ends
    names = [f"{node}.{c}" for node, c in body.dofs.taken(keep).names]
    nodes = [f"{node}.z" for node in range(2, 9)]
    cubic, _ = crossed(
        f"{MATRICES}, dofs: {names}, running_line: {{dofs: {nodes}, positions: {positions}}}", tmp_path
    )
    assert cubic.facts[-1] == "line        main: 3.125 to 21.875 m, 7 nodes, cubic by their rotations"
    path = cubic.crossing.structure.line()
    u = np.random.default_rng(1).normal(size=24)
    full = np.zeros(27)
    full[keep] = u
    theirs = path_on_beams(body.model, body.compiled.table, range(9))
    s = np.linspace(3.125, 21.875, 40)
    np.testing.assert_allclose(path.rows(s, 24) @ u, theirs.rows(s, 27) @ full, atol=1e-12)


def test_springs_dashpots_and_motions_at_nodes(references, tmp_path):
    """Against the same supports of a model of ours."""
    body, _ = references["beam"]
    keys = export(body, tmp_path, "matrix-market")
    held = (
        "{at: 1, fixed: [x], stiffness: {z: 80 MN/m}, damping: {z: 200 kNs/m}, name: left}, "
        "{at: 5, motion: {z: {kind: constant, value: -3 mm}}, name: pier}, {at: n9, fixed: [z], name: right}"
    )
    built, result = crossed(
        f"{keys}, supports: [{held}], running_line: {{nodes: {{z: 0 m}}}}, "
        "damping: {kind: rayleigh, alpha: 0.3 1/s, beta: 0.1 ms}",
        tmp_path,
    )
    assert result.support == ("left.x", "pier.z", "right.z", "left.z")
    model = body.model.with_support("n1", ("x",), stiffness={"z": 80e6}, damping={"z": 200e3}, name="left")
    model = model.with_support("n5", motion={"z": asp.model.motions.Constant(-3e-3)}, name="pier")
    model = model.with_support("n9", ("z",), name="right").with_damping(asp.Rayleigh(0.3, 1e-4))
    compiled = compile_model(model)
    structure = asp.Structure(compiled.system, {"main": path_on_beams(model, compiled.table, range(9))})
    train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), 2, 3.0)
    reference = asp.simulate(
        asp.Crossing(structure, train, speed=100.0 / 3.6),
        time_step=2e-3,
        steps=STEPS,
        method=asp.Alpha(-0.05),
        sensors={"midspan": 12.5, "quarter": 6.25},
    )
    for name in result.support:
        np.testing.assert_allclose(
            result.at("support_reaction", name), reference.at("support_reaction", name), rtol=0, atol=1e-3
        )
    peak = np.abs(reference.sensor_displacement).max()
    assert np.abs(result.sensor_displacement - reference.sensor_displacement).max() < 1e-9 * peak
    assert built.crossing.structure.system.total_mass("z") == pytest.approx(57575.0)


def test_modal_damping_and_a_damping_matrix(references, tmp_path):
    """C from a file is the Rayleigh damping that it was made with."""
    body, _ = references["beam"]
    keys = export(body, tmp_path, "npz")
    system = body.compiled.system
    write_npz(sp.csr_array(0.5 * system.mass + 2e-4 * system.stiffness), tmp_path / "C")
    line = f"supports: [{body.written_supports}], running_line: {{nodes: deck}}"
    _, law = crossed(f"{keys}, damping: {{kind: rayleigh, alpha: 0.5 1/s, beta: 0.2 ms}}, {line}", tmp_path)
    _, matrix = crossed(f"{keys}, damping: C, {line}", tmp_path)
    assert_same(matrix, law, 1e-10)
    modal, _ = crossed(f"{keys}, damping: {{kind: modal, ratio: 1 %}}, {line}", tmp_path)
    low_rank = modal.crossing.structure.system.modal_damping
    assert low_rank.coefficients[0] == pytest.approx(0.02 * 30.02, rel=1e-3)  # 2 ζ ω of the first mode


def test_an_inclined_line_is_that_of_inclined_beams(tmp_path):
    """x and ry take part too; displacement of the line against the beam's own interpolation."""
    rng = np.random.default_rng(4)
    points = np.column_stack(
        [np.linspace(0.0, 12.0, 5), 0.4 * np.linspace(0.0, 12.0, 5), 0.1 * np.arange(5) ** 2]
    )
    section = asp.BeamSection(second_moment=0.02, area=0.1, lateral_second_moment=0.03, torsion_constant=0.01)
    pairs = np.column_stack([np.arange(4), np.arange(1, 5)])
    model = asp.Model(plane=False).with_nodes(points)
    model = model.with_beams(pairs, section.properties(asp.Material(30e9, 0.2, 2500.0)))
    body = body_of(
        model, ((1, ("x", "y", "z", "rx", "ry", "rz")),), tuple(range(1, 6)), {"deck": np.arange(1, 6)}
    )
    keys = export(body, tmp_path, "npz")
    text = f"{keys}, supports: [{body.written_supports}], running_line: {{nodes: deck}}"
    rest = REST.replace("{midspan: 12.5 m, quarter: 6.25 m}", "{tip: n4}")
    built = build(read_case(f"structure: {{{text}}}\n{rest}", folder=tmp_path))
    path, theirs = built.crossing.structure.line(), path_on_beams(model, body.compiled.table, range(5))
    u = rng.normal(size=30)
    s = np.linspace(0.0, theirs.stop, 50)
    np.testing.assert_allclose(path.rows(s, 30) @ u, theirs.rows(s, 30) @ u, atol=1e-12)
    assert built.plan.settings.sensors["tip"] == pytest.approx(theirs.breaks[3])


# --- vehicles ------------------------------------------------------------------------------------------

CAR = """\
structure:
  {{kind: simple-span, length: 25 m, youngs_modulus: 2.87 GPa, second_moment: 2.9 m^4, mass_per_length: 2303 kg/m, elements: 10}}
train:
  - {{{vehicle}}}
crossing: {{speed: 25 m/s}}
analysis: {{time_step: 1 ms, steps: 400}}
"""


def test_a_vehicle_of_matrices_is_the_multibody_vehicle(tmp_path):
    """Body, pitch and two wheels, written out; matrices as a paper would print them."""
    m, inertia, k, c, a = 32e3, 1.1e6, 1.4e6, 60e3, 7.0
    wheel = 1200.0
    shape = np.array(
        [[1.0, -a, -1.0, 0.0], [1.0, a, 0.0, -1.0]]
    )  # extension of each spring; ry > 0 lowers the front
    stiffness, damping = k * shape.T @ shape, c * shape.T @ shape
    for name, matrix in (("K", stiffness), ("M", np.diag([m, inertia, wheel, wheel])), ("C", damping)):
        write_matrix_market(sp.csr_array(matrix), tmp_path / name)
    names = "[body.z, body.pitch, front.z, rear.z]"
    wheels = "[{dof: rear.z, position: 14 m}, {dof: front.z, position: 0 m}]"
    own = f"vehicle: matrices, stiffness: K, mass: M, damping: C, dofs: {names}, wheels: {wheels}"
    multibody = (
        "vehicle: multibody, bodies: [{name: body, mass: 32 t, inertia: 1.1e6 kg m^2, position: 7 m}], "
        "wheels: [{position: 0 m, mass: 1.2 t}, {position: 14 m, mass: 1.2 t}], suspensions: ["
        "{between: [body, wheel1], stiffness: 1.4 MN/m, damping: 60 kNs/m}, "
        "{between: [body, wheel2], stiffness: 1.4 MN/m, damping: 60 kNs/m}]"
    )
    ours, theirs = (
        run_plan(build(read_case(CAR.format(vehicle=text), folder=tmp_path)).plan)
        for text in (own, multibody)
    )
    assert ours.vehicle_dof == ("1.body.z", "1.body.pitch", "1.front.z", "1.rear.z")
    for name in ("1.body.z", "1.body.pitch"):
        theirs_, ours_ = theirs.at("vehicle_displacement", name), ours.at("vehicle_displacement", name)
        assert np.abs(theirs_ - ours_).max() < 1e-9 * np.abs(theirs_).max(), name
    np.testing.assert_allclose(ours.contact_force, theirs.contact_force, rtol=1e-9)


def test_positions_of_wheels_come_from_coordinates(tmp_path):
    """Numbered nodes; the first wheel is the foremost, and wheels get their usual names."""
    shape = np.array([[1.0, -7.0, -1.0, 0.0], [1.0, 7.0, 0.0, -1.0]])
    write_npz(sp.csr_array(1.4e6 * shape.T @ shape), tmp_path / "K")
    write_npz(sp.csr_array(np.diag([32e3, 1.1e6, 900.0, 900.0])), tmp_path / "M")
    (tmp_path / "dofs.csv").write_text("1,10,UZ\n2,10,ROTY\n3,1,UZ\n4,2,UZ\n")
    (tmp_path / "nodes.csv").write_text("1,100,0,0\n2,86,0,0\n10,93,0,2\n")
    text = "vehicle: matrices, stiffness: K, mass: M, dofs: dofs.csv, coordinates: nodes.csv, wheels: [{node: 2}, {node: 1}]"
    built = build(read_case(CAR.format(vehicle=text), folder=tmp_path))
    vehicle = built.crossing.train.placements[0].vehicle
    assert [(point.behind, point.dof) for point in vehicle.contacts] == [
        (0.0, "wheel1.z"),
        (14.0, "wheel2.z"),
    ]
    assert vehicle.system.dof_names == ("10.z", "10.ry", "wheel1.z", "wheel2.z")
    assert not vehicle.is_multibody
    np.testing.assert_allclose(vehicle.static_forces(9.81), 9.81 * (16e3 + 900.0))


# --- what is wrong -------------------------------------------------------------------------------------


def test_wrong_vehicles(tmp_path):
    write_npz(sp.csr_array(np.array([[1e6, -1e6], [-1e6, 1e6]])), tmp_path / "K")
    write_npz(sp.csr_array(np.diag([1e4, 100.0])), tmp_path / "M")

    def said(text):
        with pytest.raises(InputError) as caught:
            build(
                read_case(
                    CAR.format(vehicle=f"vehicle: matrices, stiffness: K, mass: M, {text}"), folder=tmp_path
                )
            )
        return str(caught.value)

    assert said("wheels: [{dof: 2, position: 0 m}]") == (
        "case.yaml:4:5: train.0.dofs: is missing; the weight acts on the vertical d.o.f.. Add dofs: rows.csv, or dofs: "
        "[body.z, body.pitch, ...]"
    )
    assert said("dofs: [body.z, body.ry], wheels: [{dof: body.ry, position: 0 m}]") == (
        "case.yaml:4:88: train.0.wheels.0.dof = body.ry: must be vertical: body.ry is not. Name a d.o.f. in z"
    )
    assert said("dofs: [body.z, wheel.z], wheels: [{dof: wheel.z}]") == (
        "case.yaml:4:82: train.0.wheels.0.position: is missing. Add it, or coordinates of the nodes"
    )


def test_the_shipped_example_is_copied_with_its_files(tmp_path, capsys):
    assert list_or_copy(["own-matrices"], tmp_path, force=False) == 0
    copied = sorted(str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*.*"))
    assert copied == [
        "own-matrices.yaml",
        *(f"own-matrices/{name}" for name in ("dofs.csv", "mass.mtx", "nodes.csv", "stiffness.mtx")),
    ]
    assert (
        load_case(tmp_path / "own-matrices.yaml").case.structure.mass
        == tmp_path / "own-matrices" / "mass.mtx"
    )


def test_the_shipped_example_is_the_continuous_beam():
    """own-matrices.yaml: two spans of 30 m; the first frequencies of the same beam in closed form."""
    case = Path(asp.__file__).parent / "examples" / "own-matrices.yaml"
    built = build(read_case(case.read_text(encoding="utf-8"), folder=case.parent))
    first = np.pi / 2.0 / 30.0**2 * np.sqrt(210e9 * 0.35 / 14e3)
    modes = lowest_modes(built.plan.structure.K, built.plan.structure.M, 2)
    np.testing.assert_allclose(modes.frequencies, first * np.array([1.0, (3.9266 / np.pi) ** 2]), rtol=2e-4)
    assert built.plan.settings.sensors == {"first-span": 15.0, "second-span": 45.0, "quarter": 15.0}


def test_what_the_page_on_imported_models_shows():
    """Every block of the page fits the schema; the files that they name need not be there."""
    jsonschema = pytest.importorskip("jsonschema")
    page = Path(__file__).parents[2] / "docs" / "imported-models.md"
    shown = re.findall(
        r"^```yaml\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE
    )
    rest = YAML(typ="safe", pure=True).load(CAR.format(vehicle="vehicle: ice3"))
    validator = jsonschema.Draft202012Validator(schema())
    for block in shown:
        case = {**rest, **YAML(typ="safe", pure=True).load(block)}
        assert [error.message for error in validator.iter_errors(case)] == [], block
    assert len(shown) == 5
