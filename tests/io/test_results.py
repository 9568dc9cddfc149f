"""Results in and out of netCDF-4: what is written is read back, by axlespan and by others."""

import json
import os
import subprocess
import sys
import textwrap
from dataclasses import replace

import h5py
import numpy as np
import pytest
import xarray

from axlespan.errors import InputError, Outcome
from axlespan.interaction.extras import LINE_VARIABLES, SECTION_VARIABLES
from axlespan.interaction.result import VARIABLES, Result
from axlespan.io.results import FORMAT_VERSION, read_header, read_result, write_result

DIMENSIONS = ("sensor", "contact", "vehicle_dof", "support")


def made(
    n_time=40,
    sensor=("midspan", "Widerlager süd"),
    contact=("1.1", "1.2", "2.1"),
    vehicle_dof=("1.body.z", "1.body.pitch", "2.body.z", "1.wheel1.z"),
    support=("left.z", "right.z"),
    seed=7,
    **changes,
):
    """A result of random numbers."""
    rng = np.random.default_rng(seed)
    names = {"sensor": sensor, "contact": contact, "vehicle_dof": vehicle_dof, "support": support}
    histories = {
        name: rng.standard_normal((n_time, len(names[dimension])))
        for name, (dimension, _, _) in VARIABLES.items()
    }
    result = Result(
        time=0.001 * np.arange(n_time),
        **names,
        **histories,
        outcome=Outcome("completed", "39 steps computed"),
        checks={
            "finite_values": True,
            "energy_residual": 1.5e-13,
            "tension": [{"contact": "1.1", "size": 2.0}],
        },
        facts={"steps": 39, "solver": "banded", "wall_time": 0.25, "notes": ["footprint of 0.3 m"]},
    )
    return replace(result, **changes)


def assert_same(read, written):
    for name in ("time", *VARIABLES):
        np.testing.assert_array_equal(getattr(read, name), getattr(written, name))
        assert getattr(read, name).dtype == np.float64
    for name in DIMENSIONS:
        assert getattr(read, name) == getattr(written, name)
    assert read.outcome == written.outcome


def test_every_number_and_name_comes_back_to_the_last_bit(tmp_path):
    written = made()
    assert write_result(written, tmp_path / "result.nc", version="1.2.3") == tmp_path / "result.nc"
    read = read_result(tmp_path / "result.nc")
    assert_same(read, written)
    assert read.checks == written.checks
    assert read.facts == written.facts


def test_xarray_sees_the_fixed_layout(tmp_path):
    written = made()
    write_result(written, str(tmp_path / "result.nc"), case_text="title: x", version="1.2.3")
    with xarray.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as dataset:
        assert dict(dataset.sizes) == {"time": 40, "sensor": 2, "contact": 3, "vehicle_dof": 4, "support": 2}
        assert set(dataset.data_vars) == set(VARIABLES)
        for name, (dimension, unit, meaning) in VARIABLES.items():
            assert dataset[name].dims == ("time", dimension)
            assert dataset[name].attrs == {"units": unit, "long_name": meaning}
        for name in DIMENSIONS:
            assert dataset[name].values.tolist() == list(getattr(written, name))
            assert dataset[name].attrs["long_name"]
        assert dataset.time.dtype == np.float64
        assert dataset.time.attrs["units"] == "s"
        value = dataset.contact_force.sel(contact="1.2", time=0.007, method=None).item()
        assert value == written.contact_force[7, 1]
        np.testing.assert_array_equal(
            dataset.sensor_displacement.sel(sensor="Widerlager süd"), written.sensor_displacement[:, 1]
        )
        assert not any(np.isnan(dataset[name].values).any() for name in VARIABLES)


def test_the_file_agrees_with_to_xarray(tmp_path):
    written = made()
    write_result(written, tmp_path / "result.nc")
    with xarray.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as dataset:
        own = written.to_xarray()
        assert set(own.variables) == set(dataset.variables)
        for name in own.variables:
            np.testing.assert_array_equal(own[name].values, dataset[name].values)
            assert own[name].dims == dataset[name].dims


def test_netcdf4_python_reads_it(tmp_path):
    netcdf4 = pytest.importorskip("netCDF4")
    written = made(sensor=())
    write_result(written, tmp_path / "result.nc", case_text="title: x")
    with netcdf4.Dataset(tmp_path / "result.nc") as dataset:
        assert dataset.variables["contact"][:].tolist() == ["1.1", "1.2", "2.1"]
        np.testing.assert_array_equal(dataset.variables["contact_force"][:], written.contact_force)
        assert dataset.variables["sensor_velocity"].shape == (40, 0)
        assert dataset.case == "title: x"


@pytest.mark.parametrize("missing", [("sensor",), ("vehicle_dof",), ("contact", "vehicle_dof"), DIMENSIONS])
def test_empty_dimensions_come_back_empty(tmp_path, missing):
    written = made(**dict.fromkeys(missing, ()))
    write_result(written, tmp_path / "result.nc")
    assert_same(read_result(tmp_path / "result.nc"), written)
    with xarray.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as dataset:
        for name in missing:
            assert dataset.sizes[name] == 0
        assert dataset.contact_force.shape == written.contact_force.shape


def test_attributes_hold_case_outcome_checks_and_facts(tmp_path):
    text = "title: Brücke über die Ahr\n" * 5000  # 64 kB and more, which a plain HDF5 attribute does not hold
    checks = {
        "energy_residual": float("nan"),
        "largest_contact_force": {"1.1": -np.inf, "1.2": np.float64(2)},
    }
    facts = {"steps": np.int64(39), "notes": ("one", "two"), "sizes": np.arange(3)}
    outcome = Outcome("failed", "diverged at step 39", "Use alpha = -0.1")
    written = made(checks=checks, facts=facts, outcome=outcome)
    write_result(written, tmp_path / "result.nc", case_text=text, version="1.2.3")
    with h5py.File(tmp_path / "result.nc") as file:
        attributes = dict(file.attrs)
    assert attributes["case"] == text
    assert attributes["version"] == "1.2.3"
    assert (attributes["outcome"], attributes["outcome_message"]) == ("failed", "diverged at step 39")

    def strict(word):
        raise AssertionError(word)

    assert json.loads(attributes["checks"], parse_constant=strict) == {
        "energy_residual": None,
        "largest_contact_force": {"1.1": None, "1.2": 2.0},
    }
    assert json.loads(attributes["facts"]) == {"steps": 39, "notes": ["one", "two"], "sizes": [0, 1, 2]}
    header = read_header(tmp_path / "result.nc")
    assert (header.case_text, header.version, header.outcome) == (text, "1.2.3", outcome)
    assert read_result(tmp_path / "result.nc").facts["notes"] == ["one", "two"]


def test_the_version_is_ours_when_none_is_given(tmp_path):
    import axlespan

    write_result(made(), tmp_path / "result.nc")
    header = read_header(tmp_path / "result.nc")
    assert header.version == axlespan.__version__
    assert header.case_text is None


def test_a_history_is_stored_by_itself_and_compressed(tmp_path):
    time = 0.001 * np.arange(20_000)
    smooth = np.sin(time[:, None] * np.arange(1, 21))
    written = made(n_time=20_000, contact=tuple(f"{i}.1" for i in range(20)), contact_force=smooth)
    written = replace(written, contact_position=np.add.outer(25.0 * time, -3.0 * np.arange(20)))
    write_result(written, tmp_path / "result.nc")
    with h5py.File(tmp_path / "result.nc") as file:
        for name in ("contact_force", "contact_position"):
            stored = file[name]
            assert stored.chunks[1] == 1 and stored.chunks[0] >= 10_000
            assert (stored.compression, stored.shuffle) == ("gzip", True)
            assert stored.id.get_storage_size() < 0.9 * smooth.nbytes
    assert_same(read_result(tmp_path / "result.nc"), written)


@pytest.mark.parametrize("n_time", [0, 1])
def test_a_result_with_hardly_any_time(tmp_path, n_time):
    written = made(n_time=n_time)
    write_result(written, tmp_path / "result.nc")
    assert_same(read_result(tmp_path / "result.nc"), written)


# --- whole or not at all -------------------------------------------------------------------------


@pytest.mark.parametrize("stop", [OSError("disk full"), KeyboardInterrupt()])
def test_an_interrupted_write_leaves_the_old_file_alone(tmp_path, monkeypatch, stop):
    first = made(seed=1)
    write_result(first, tmp_path / "result.nc")

    def interrupted(part, place):
        assert part.stat().st_size > 1000
        raise stop

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(type(stop)):
        write_result(made(seed=2), tmp_path / "result.nc")
    assert [file.name for file in tmp_path.iterdir()] == ["result.nc"]
    assert_same(read_result(tmp_path / "result.nc"), first)


@pytest.mark.skipif(sys.platform == "win32", reason="limits of a process")
def test_a_full_disk_is_an_error_of_the_system(tmp_path):
    script = f"""
        import gc, resource, signal
        from axlespan.io.results import read_result, write_result

        result = read_result({str(tmp_path / "old.nc")!r})
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))
        try:
            write_result(result, {str(tmp_path / "new.nc")!r})
        except OSError as error:
            print(error.strerror)
        gc.collect()
    """
    write_result(made(n_time=2000), tmp_path / "old.nc")
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], capture_output=True, check=False)
    assert (done.returncode, done.stdout.decode().strip()) == (0, "File too large"), done.stderr.decode()
    assert [file.name for file in tmp_path.iterdir()] == ["old.nc"]


def test_a_killed_process_leaves_no_half_file(tmp_path):
    script = f"""
        import os
        import numpy as np
        from axlespan.errors import Outcome
        from axlespan.interaction.result import VARIABLES, Result
        from axlespan.io import results

        os.replace = lambda *names: os._exit(9)
        names = dict.fromkeys(("sensor", "contact", "vehicle_dof", "support"), ("a",))
        histories = {{name: np.zeros((3, 1)) for name in VARIABLES}}
        result = Result(time=np.arange(3.0), outcome=Outcome("completed", ""), **names, **histories)
        results.write_result(result, {str(tmp_path / "result.nc")!r})
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], capture_output=True, check=False)
    assert done.returncode == 9, done.stderr.decode()
    assert not (tmp_path / "result.nc").exists()


def test_a_missing_folder_is_an_error_of_the_system(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"nowhere"):
        write_result(made(), tmp_path / "nowhere" / "result.nc")


# --- what is no result ---------------------------------------------------------------------------


def test_reading_says_what_is_wrong_with_the_path(tmp_path):
    with pytest.raises(InputError, match=r"does not exist\. Check the path"):
        read_result(tmp_path / "result.nc")
    with pytest.raises(InputError, match=r"is not a file\. Give the path of a result\.nc"):
        read_result(tmp_path)


@pytest.mark.parametrize("content", [b"", b"time,force\n0,1\n" * 100, b"CDF\x01" + bytes(500)])
def test_other_files_are_no_netcdf4(tmp_path, content):
    (tmp_path / "result.nc").write_bytes(content)
    with pytest.raises(InputError, match=r"is not a netCDF-4 file|is cut short or damaged"):
        read_result(tmp_path / "result.nc")


def test_other_netcdf_files_are_no_results(tmp_path):
    xarray.Dataset({"temperature": ("time", np.arange(3.0))}).to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    with pytest.raises(InputError, match=r"is not a result of axlespan: it has no variable sensor"):
        read_header(tmp_path / "a.nc")
    write_result(made(), tmp_path / "b.nc")
    with h5py.File(tmp_path / "b.nc", "a") as file:
        del file.attrs["outcome"]
    with pytest.raises(InputError, match=r"it has no attribute outcome"):
        read_result(tmp_path / "b.nc")


def test_a_file_of_the_future_names_the_remedy(tmp_path):
    write_result(made(), tmp_path / "result.nc", version="9.0.0")
    with h5py.File(tmp_path / "result.nc", "a") as file:
        file.attrs["format_version"] = FORMAT_VERSION + 1
    with pytest.raises(InputError) as caught:
        read_result(tmp_path / "result.nc")
    assert f"axlespan 9.0.0 in format {FORMAT_VERSION + 1}" in caught.value.rule
    assert caught.value.fix == "pip install --upgrade axlespan"


def test_a_file_cut_short_is_an_input_error_wherever_it_is_cut(tmp_path):
    write_result(made(n_time=500), tmp_path / "whole.nc")
    whole = (tmp_path / "whole.nc").read_bytes()
    for share in (0.001, 0.1, 0.5, 0.9, 0.999):
        (tmp_path / "cut.nc").write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(
            InputError, match=r"is cut short or damaged: .*Copy it again|is not a netCDF-4 file"
        ):
            read_result(tmp_path / "cut.nc")


def test_damaged_bytes_are_an_input_error_or_harmless(tmp_path):
    write_result(made(n_time=300), tmp_path / "whole.nc")
    whole = np.frombuffer((tmp_path / "whole.nc").read_bytes(), dtype=np.uint8)
    rng = np.random.default_rng(3)
    refused = 0
    for _ in range(150):
        bytes_ = whole.copy()
        at = rng.integers(0, len(whole), 40)
        bytes_[at] = rng.integers(0, 256, 40)
        (tmp_path / "damaged.nc").write_bytes(bytes_.tobytes())
        try:
            read_result(tmp_path / "damaged.nc")
        except InputError as error:
            assert error.field == "file"
            refused += 1
    assert refused > 75


def test_a_history_of_the_wrong_shape_is_damage(tmp_path):
    write_result(made(), tmp_path / "result.nc")
    with h5py.File(tmp_path / "result.nc", "a") as file:
        del file["contact_force"]
        file["contact_force"] = np.zeros((40, 2))
    with pytest.raises(InputError, match=r"contact_force has the shape \(40, 2\), not \(40, 3\)"):
        read_result(tmp_path / "result.nc")


def test_what_xarray_wrote_again_is_still_a_result(tmp_path):
    written = made()
    write_result(written, tmp_path / "a.nc", case_text="title: x", version="1.2.3")
    with xarray.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as dataset:
        dataset.isel(time=slice(0, 10)).to_netcdf(tmp_path / "b.nc", engine="h5netcdf")
    read = read_result(tmp_path / "b.nc")
    np.testing.assert_array_equal(read.contact_force, written.contact_force[:10])
    assert read.sensor == written.sensor
    assert read.checks == written.checks
    assert read_header(tmp_path / "b.nc").case_text == "title: x"


LINE = (*LINE_VARIABLES, "line_position", "line_end")


def test_the_file_layout_knows_every_history_of_a_result():
    fields = {name for name, kind in Result.__annotations__.items() if kind == "FloatArray"}
    assert fields == {"time", *VARIABLES, *SECTION_VARIABLES, *LINE}  # these are in axlespan.io.result_extras
