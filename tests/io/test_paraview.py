"""Files for ParaView, read by a parser of the test's own: XML, base64 and zlib as VTK's guide has them."""

import base64
import zlib
from xml.etree import ElementTree

import numpy as np
import pytest

import axlespan as asp
from axlespan.errors import InputError
from axlespan.io.paraview import write_modes, write_paraview
from axlespan.io.vtk_xml import Cells, Grid, data_array, write_grid
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Shells, Solids, parts_from_mesh
from axlespan.model.materials import Material
from axlespan.model.mesh import Mesh
from axlespan.model.modal import modes_of
from axlespan.model.model import Model
from axlespan.running.structure import Structure
from axlespan.running.surface import line_over

TYPES = {"Float64": "<f8", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1"}


def decoded(array):
    """Values of a DataArray element."""
    text = array.text.strip()
    count = int(np.frombuffer(base64.b64decode(text[:12])[:8], "<u8")[0])
    head = 4 * -(-8 * (3 + count) // 3)
    sizes = np.frombuffer(base64.b64decode(text[:head]), "<u8")
    assert sizes[0] == count
    raw, begin = base64.b64decode(text[head:]), 0
    blocks = []
    for i, size in enumerate(sizes[3:].tolist()):
        blocks.append(zlib.decompress(raw[begin : begin + size]))
        begin += size
        last = i == count - 1 and sizes[2] > 0
        assert len(blocks[-1]) == (sizes[2] if last else sizes[1])
    assert begin == len(raw)
    values = np.frombuffer(b"".join(blocks), TYPES[array.get("type")])
    width = int(array.get("NumberOfComponents", 1))
    return values.reshape(-1, width) if width > 1 else values


def read(path):
    """Arrays of a .vtu file, by section and name."""
    root = ElementTree.parse(path).getroot()
    assert root.attrib["type"] == "UnstructuredGrid"
    assert root.attrib["byte_order"] == "LittleEndian"
    assert root.attrib["header_type"] == "UInt64"
    assert root.attrib["compressor"] == "vtkZLibDataCompressor"
    piece = root.find("UnstructuredGrid/Piece")
    found = {
        section.tag: {array.get("Name"): decoded(array) for array in section.iter("DataArray")}
        for section in piece
    }
    found["time"] = [decoded(a) for a in root.findall("UnstructuredGrid/FieldData/DataArray")]
    assert len(found["Points"]["Points"]) == int(piece.get("NumberOfPoints"))
    assert len(found["Cells"]["types"]) == int(piece.get("NumberOfCells"))
    for section, count in (("PointData", "NumberOfPoints"), ("CellData", "NumberOfCells")):
        assert all(len(values) == int(piece.get(count)) for values in found[section].values())
    return found


def beam_crossing():
    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=10
    )
    train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), count=2, spacing=3.0)
    return asp.Crossing(bridge, train, speed=30.0, start=-1.0)


def test_a_beam_and_its_wheels(tmp_path):
    crossing = beam_crossing()
    result = asp.simulate(crossing, time_step=1e-3, steps=900, fields=[0.0, 0.3, 0.9])
    files = write_paraview(result, crossing, tmp_path / "new")
    assert files[0] == "fields.pvd" and len(files) == 7
    entries = ElementTree.parse(tmp_path / "new" / "fields.pvd").getroot().findall("Collection/DataSet")
    assert [(float(e.get("timestep")), e.get("part"), e.get("file")) for e in entries] == [
        (time, str(part), f"fields/{name}-{i:04d}.vtu")
        for i, time in enumerate([0.0, 0.3, 0.9])
        for part, name in enumerate(("structure", "wheels"))
    ]
    assert [e.get("file") for e in entries] == files[1:]
    fields = result.fields
    for i in range(3):
        bridge = read(tmp_path / "new" / entries[2 * i].get("file"))
        assert bridge["time"][0] == pytest.approx(fields.times[i])
        assert bridge["Points"]["Points"][:, 0] == pytest.approx(np.linspace(0.0, 25.0, 11))
        assert bridge["Cells"]["types"].tolist() == [3] * 10
        assert bridge["Cells"]["offsets"].tolist() == list(range(2, 21, 2))
        assert bridge["Cells"]["connectivity"].reshape(-1, 2)[3].tolist() == [3, 4]
        vertical, turning = fields.displacement[i, ::2], fields.displacement[i, 1::2]
        displacement = bridge["PointData"]["displacement"]
        assert np.array_equal(displacement[:, 2], vertical) and not np.any(displacement[:, :2])
        if i:
            assert np.array_equal(bridge["PointData"]["rotation"][:, 1], turning)
        assert np.array_equal(bridge["PointData"]["velocity"][:, 2], fields.velocity[i, ::2])
        # moments in the middles: EI times the difference of the slopes
        moment = bridge["CellData"]["beam_force"][:, 0]
        assert moment == pytest.approx(-2.87e9 * 2.9 * np.diff(turning) / 2.5, rel=1e-9, abs=1e-6)
        wheels = read(tmp_path / "new" / entries[2 * i + 1].get("file"))
        assert wheels["Cells"]["types"].tolist() == [1, 1]
        expected = np.column_stack([fields.contact_position[i], np.zeros((2, 2))])
        assert wheels["Points"]["Points"] == pytest.approx(expected, abs=1e-9)
        assert np.array_equal(wheels["PointData"]["contact_force"], fields.contact_force[i])
        assert np.array_equal(wheels["PointData"]["force_on_structure"][:, 2], -fields.contact_force[i])
        assert np.array_equal(wheels["PointData"]["displacement"][:, 2], fields.contact_displacement[i])
        assert wheels["CellData"]["vehicle"].tolist() == [1, 2]


def test_an_earlier_series_is_replaced(tmp_path):
    crossing = beam_crossing()
    for fields, count in ((100, 10), ([0.2], 1)):
        result = asp.simulate(crossing, time_step=1e-3, steps=900, fields=fields)
        write_paraview(result, crossing, tmp_path)
        assert len(list((tmp_path / "fields").iterdir())) == 2 * count


def slab(kind):
    """A slab 6 m × 2 m × 0.4 m of solids or shells on two edges, with a line a quarter from the side."""
    mat = Material(3e10, 0.2, 2500.0)
    if kind == "shells":
        mesh = Mesh.rectangle((6.0, 2.0), (12, 4), plane="xy")
        sections = {"surface": Shells(mat, 0.4)}
    else:
        mesh = Mesh.box((6.0, 2.0, 0.4), (12, 4, 2))
        sections = {"volume": Solids(mat)}
    model = Model(plane=False).with_nodes(mesh.points)
    for part in parts_from_mesh(mesh, sections):
        model = model.with_part(part)
    low = mesh.points[:, 2] == 0.0
    for x, fixed in ((0.0, ("x", "z")), (6.0, ("z",))):
        for j, node in enumerate(np.flatnonzero(low & (mesh.points[:, 0] == x)).tolist()):
            model = model.with_support(node, (*fixed, "y") if j == 0 else fixed)
    compiled = compile_model(model)
    height = 0.0 if kind == "shells" else 0.4
    path = line_over(model, compiled.table, [[0.0, 0.5, height], [6.0, 0.5, height]])
    return Structure(compiled.system, {"main": path.transformed(compiled.system.elimination)}, model=model)


@pytest.mark.parametrize(("kind", "vtk", "force"), [("solids", 12, "stress"), ("shells", 9, "shell_moment")])
def test_slabs(tmp_path, kind, vtk, force):
    structure = slab(kind)
    train = asp.Train.of(asp.vehicles.axle_loads(loads=[1e5], positions=[0.0]))
    crossing = asp.Crossing(structure, train, speed=0.0, start=3.0)
    result = asp.simulate(crossing, time_step=1e-3, steps=2, fields=[0.0])
    files = write_paraview(result, crossing, tmp_path)
    found, wheels = (read(tmp_path / name) for name in files[1:])
    assert set(found["Cells"]["types"]) == {vtk}
    nodes = np.asarray(structure.model.parts[0].nodes)
    assert np.array_equal(found["Cells"]["connectivity"], nodes.ravel())
    height = 0.4 if kind == "solids" else 0.0
    assert wheels["Points"]["Points"][0] == pytest.approx([3.0, 0.5, height], abs=1e-9)
    number = structure.system.dof_names.index("n7.z")
    assert found["PointData"]["displacement"][6, 2] == result.fields.displacement[0, number]
    # Equilibrium of one half: the elements on a cross-section carry M = P x / 2, whatever their shares are.
    x = structure.model.points[nodes].mean(axis=1)
    cut = np.isclose(x[:, 0], 1.25)
    values = found["CellData"][force][cut]
    width = 0.5
    if kind == "shells":
        moment = -(values[:, 0] * width).sum()
    else:
        moment = (values[:, 0] * width * 0.2 * (0.2 - x[cut, 2])).sum()
        moment *= 4.0 / 3.0  # linear stress over two layers: means at the middles give 3/4 of the moment
        assert found["CellData"]["von_mises"].min() > 0.0
    assert abs(moment) == pytest.approx(0.5e5 * 1.25, rel=0.02)


def test_modes(tmp_path):
    structure = slab("shells")
    modes = modes_of(structure.system, 3).modes
    write_modes(structure, modes, tmp_path / "modes.vtu")
    found = read(tmp_path / "modes.vtu")["PointData"]
    assert list(found) == ["mode_1", "mode_2", "mode_3"]
    for shape in found.values():
        assert np.linalg.norm(shape, axis=1).max() == pytest.approx(1.0)
    # the first bends: largest in the middle of the span
    across = np.abs(found["mode_1"][:, 2])
    assert structure.model.points[across.argmax(), 0] == pytest.approx(3.0)


def test_arrays_of_several_blocks():
    values = np.random.default_rng(1).standard_normal((400_000, 3))
    text = data_array("v", values)
    assert np.array_equal(decoded(ElementTree.fromstring(text)), values)
    whole = np.zeros(2**19)  # exactly one block
    assert np.array_equal(decoded(ElementTree.fromstring(data_array("w", whole))), whole)


def test_points_and_names(tmp_path):
    grid = Grid(np.zeros((1, 3)), [Cells(1, np.zeros((1, 1), dtype=np.int64))])
    write_grid(tmp_path / "p.vtu", grid, {'a "b" <c>': np.ones(1)})
    assert read(tmp_path / "p.vtu")["PointData"]['a "b" <c>'].tolist() == [1.0]


def test_what_cannot_be_shown(tmp_path):
    crossing = beam_crossing()
    result = asp.simulate(crossing, time_step=1e-3, steps=100)
    with pytest.raises(InputError, match=r"result: has no fields.*every: 100"):
        write_paraview(result, crossing, tmp_path)
    bare = Structure(crossing.structure.system, crossing.structure.lines, "imported")
    bare_crossing = asp.Crossing(bare, crossing.train, speed=30.0)
    result = asp.simulate(bare_crossing, time_step=1e-3, steps=100, fields=5)
    with pytest.raises(InputError, match=r"'imported': has no mesh to show"):
        write_paraview(result, bare_crossing, tmp_path)
    assert not (tmp_path / "fields.pvd").exists()
