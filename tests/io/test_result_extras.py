"""Section forces, stresses, envelopes and fields in result.nc and in xarray."""

import h5py
import numpy as np
import pytest

import axlespan as asp
from axlespan.io.results import read_result, write_result

BRIDGE = asp.bridges.simple_span(
    length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=10
)
TRAIN = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), count=2, spacing=3.0)


@pytest.fixture(scope="module")
def result():
    return asp.simulate(
        asp.Crossing(BRIDGE, TRAIN, speed=30.0),
        time_step=1e-3,
        steps=900,
        sensors={"mid": 12.5, "näher": 6.0},
        section_forces=["näher", "mid"],
        envelopes=["moment", "acceleration"],
        fields=300,
    )


def test_there_and_back(result, tmp_path):
    path = write_result(result, tmp_path / "result.nc")
    again = read_result(path)
    assert again.section == ("näher", "mid")
    assert np.array_equal(again.at("section_moment", "mid"), result.at("section_moment", "mid"))
    assert np.array_equal(again.section_shear, result.section_shear)
    assert list(again.envelopes.tables) == ["moment", "acceleration"]
    for quantity, table in result.envelopes.tables.items():
        for name in ("largest", "smallest", "time_of_largest", "time_of_smallest"):
            assert np.array_equal(getattr(again.envelopes.of(quantity), name), getattr(table, name))
    assert np.array_equal(again.envelopes.position, result.envelopes.position)
    assert again.fields.dof_names == result.fields.dof_names
    for name in ("times", "displacement", "velocity", "contact_position", "contact_force"):
        assert np.array_equal(getattr(again.fields, name), getattr(result.fields, name))
    assert np.array_equal(again.contact_force, result.contact_force)
    assert [file.name for file in tmp_path.iterdir()] == ["result.nc"]


def test_names_units_and_dimensions(result, tmp_path):
    path = write_result(result, tmp_path / "result.nc")
    with h5py.File(path) as file:
        for name, unit, dimensions in (
            ("section_moment", "N m", ["time", "section"]),
            ("section_shear", "N", ["time", "section"]),
            ("envelope_moment_largest", "N m", ["station"]),
            ("envelope_moment_smallest_time", "s", ["station"]),
            ("envelope_acceleration_smallest", "m/s^2", ["station"]),
            ("field_displacement", "m or rad", ["field_time", "dof"]),
            ("field_contact_force", "N", ["field_time", "contact"]),
        ):
            assert file[name].attrs["units"] == unit
            assert file[name].attrs["long_name"]
            assert [scale[0].name.lstrip("/") for scale in file[name].dims] == dimensions
        assert file["dof"].asstr()[:2].tolist() == ["n1.z", "n1.ry"]


def test_xarray_has_the_same(result, tmp_path):
    xarray = pytest.importorskip("xarray")
    path = write_result(result, tmp_path / "result.nc")
    made = result.to_xarray()
    with xarray.open_dataset(path, engine="h5netcdf") as stored:
        assert set(stored.variables) == set(made.variables)
        for name in made.data_vars:
            assert stored[name].dims == made[name].dims
            assert stored[name].attrs == made[name].attrs
            assert np.array_equal(stored[name].values, made[name].values)
    moment = made["section_moment"].sel(section="mid", time=0.5)
    assert float(moment) == result.at("section_moment", "mid")[500]


def test_a_plain_result_has_none(tmp_path):
    plain = asp.simulate(asp.Crossing(BRIDGE, TRAIN, speed=30.0), time_step=1e-3, steps=5)
    path = write_result(plain, tmp_path / "result.nc")
    with h5py.File(path) as file:
        assert not {"section", "station", "field_time", "dof"} & set(file)
    again = read_result(path)
    assert again.fields is None and again.envelopes is None and again.section == ()
