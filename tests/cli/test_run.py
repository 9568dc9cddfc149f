"""``axlespan run``: what it writes, where, and how it ends."""

import json
import os
import re
import sys

import numpy as np
import pytest
import xarray as xr

from axlespan.cli.examples import shipped
from axlespan.errors import AnalysisError

SHORTER = {"solid-beam-coarse": ("steps: 1500", "steps: 200")}
LONG = {"neves2012-3.2-solid"}  # 14 000 steps of 36 597 d.o.f.
QUICK = sorted(set(shipped()) - LONG)
DRAWN = ("neves2012-3.1", "wheels-with-mass")  # with figures, which take longer than the rest

#: Names that other programs read; see the head of io/results.py.
VARIABLES = {
    "sensor_displacement": ("sensor", "m"),
    "sensor_velocity": ("sensor", "m/s"),
    "sensor_acceleration": ("sensor", "m/s^2"),
    "contact_force": ("contact", "N"),
    "contact_position": ("contact", "m"),
    "vehicle_displacement": ("vehicle_dof", "m or rad"),
    "vehicle_velocity": ("vehicle_dof", "m/s or rad/s"),
    "vehicle_acceleration": ("vehicle_dof", "m/s^2 or rad/s^2"),
    "support_reaction": ("support", "N or N m"),
}
FIGURES = {
    "displacement.png",
    "acceleration.png",
    "contact_force.png",
    "vehicle_acceleration.png",
    "reactions.png",
}

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs /proc")


@pytest.fixture(scope="module")
def examples(axlespan, tmp_path_factory):
    """The shipped examples, each run once: folder and answer by name."""
    home = tmp_path_factory.mktemp("examples")
    assert axlespan("examples", "all", "-o", home / "cases").code == 0
    ran = {}
    for name in QUICK:
        file = home / "cases" / f"{name}.yaml"
        old, new = SHORTER.get(name, ("", ""))
        text = file.read_text(encoding="utf-8")
        assert old in text
        file.write_text(text.replace(old, new, 1), encoding="utf-8")
        drawn = "--figures" if name in DRAWN else "--no-figures"
        ran[name] = (home / name, axlespan("run", file, "-o", home / name, drawn))
    return ran


def strict(path):
    """Read JSON that every reader reads: no NaN, no Infinity."""

    def refuse(word):
        raise AssertionError(f"{word} is no JSON")

    return json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse)


@pytest.mark.parametrize("name", QUICK)
class TestExamples:
    def test_files(self, examples, name):
        folder, answer = examples[name]
        assert (answer.code, answer.err) == (0, "")
        files = {path.name for path in folder.iterdir()}
        assert files >= {"result.nc", "summary.json"} | (FIGURES if name in DRAWN else set())
        assert files == set(strict(folder / "summary.json")["files"])
        assert all((folder / file).stat().st_size > 1000 for file in files)
        assert answer.out.splitlines()[-1] == f"Written to {folder}"

    def test_result_has_the_fixed_names(self, examples, name):
        folder, _ = examples[name]
        with xr.open_dataset(folder / "result.nc") as data:
            assert {"time", "sensor", "contact", "vehicle_dof", "support"} <= set(data.sizes)
            for variable, (dimension, unit) in VARIABLES.items():
                assert data[variable].dims == ("time", dimension)
                assert data[variable].attrs["units"] == unit
                assert len(data[variable].attrs["long_name"]) > 5
                assert np.isfinite(data[variable].values).all()
            assert data["time"].attrs["units"] == "s"
            wheel = {"cross-wind": "1l"}.get(name, "1")  # in space, wheels are left and right
            assert data["contact"].values[0] == f"1.{wheel}"
            moving = (
                set() if name == "portal-frame" else {f"1.wheel{wheel}.z", "1.body.z"}
            )  # forces have none
            assert moving <= set(data["vehicle_dof"].values)
            assert data.attrs["outcome"] == "completed"
            assert data.attrs["version"] == "0.1.0"
            title = data.attrs["case"].split("title: ")[1].splitlines()[0]
        assert strict(folder / "summary.json")["run"]["title"] == title

    def test_summary_has_the_self_checks(self, examples, name):
        folder, answer = examples[name]
        summary = strict(folder / "summary.json")
        assert (summary["format"], summary["verdict"]) == ("axlespan summary", "pass")
        checks = {check["name"]: check for check in summary["checks"]}
        assert list(checks) == ["finite", "compatibility", "equilibrium", "energy", "clean forces", "tension"]
        assert {check["verdict"] for check in checks.values()} == {"pass"}
        for check in ("compatibility", "equilibrium", "energy"):
            assert 0.0 <= checks[check]["value"] <= checks[check]["limit"] <= 1e-6
        assert summary["outcome"]["code"] == "completed"
        assert (
            summary["run"]["completed_steps"] == summary["run"]["steps"] == summary["run"]["kept_times"] - 1
        )
        assert "Checks: pass" in answer.out


def test_the_examples_of_the_paper(examples):
    """Peaks of an independent solution of N12 (41, 42)."""
    with xr.open_dataset(examples["neves2012-3.1"][0] / "result.nc") as data:
        midspan = 1e3 * data["sensor_displacement"].sel(sensor="midspan")
        assert float(midspan.min()) == pytest.approx(-2.4069, abs=2e-4)
        assert float(midspan.max()) == pytest.approx(0.1643, abs=2e-4)
        mass = data["vehicle_acceleration"].sel(vehicle_dof="1.body.z")
        assert (float(mass.min()), float(mass.max())) == pytest.approx((-0.1421, 0.1480), abs=1e-4)
    with xr.open_dataset(examples["neves2012-3.2"][0] / "result.nc") as data:
        assert data.sizes["time"] == 14_001 and data.sizes["contact"] == 50
        first, last = (1e3 * data["vehicle_displacement"].sel(vehicle_dof=f"{n}.body.z") for n in (1, 50))
        assert float(first.sel(time=slice(0, 3)).min()) == pytest.approx(-12.840, abs=1e-3)
        assert float(last.sel(time=slice(11, 14)).min()) == pytest.approx(-11.593, abs=1e-3)


class TestWhere:
    def test_the_default_folder_is_the_case_without_its_ending(self, axlespan, case):
        path = case()
        assert axlespan("run", path, "--no-figures").code == 0
        assert {p.name for p in path.with_suffix("").iterdir()} == {"result.nc", "summary.json"}
        bare = case(name="bare")
        assert axlespan("run", bare, "--no-figures").code == 0
        assert {p.name for p in path.parent.iterdir()} == {"case", "case.yaml", "bare", "bare-results"}

    def test_relative_paths_and_nested_new_folders(self, axlespan, case, tmp_path, monkeypatch):
        case(name="cases/bridge.yaml")
        monkeypatch.chdir(tmp_path)
        answer = axlespan("run", "cases/bridge.yaml", "-o", "a/b/c", "--no-figures")
        assert (answer.code, answer.out.splitlines()[-1]) == (0, "Written to a/b/c")
        assert {p.name for p in (tmp_path / "a/b/c").iterdir()} == {"result.nc", "summary.json"}

    def test_names_of_all_kinds(self, axlespan, case, tmp_path):
        path = case(name="Fälle 桥/Brücke über den Fluß.yaml")
        out = tmp_path / "Ergebnisse 😀" / "-o"
        assert axlespan("run", path, "-o", out, "--no-figures").code == 0
        assert strict(out / "summary.json")["files"] == ["result.nc", "summary.json"]

    def test_a_table_beside_the_case_file(self, axlespan, case, tmp_path, monkeypatch):
        """Names of files are relative to the case file, wherever the command runs."""
        table = "irregularity: {kind: table, file: profiles/measured.csv}"
        path = case(("speed: 80 km/h", f"speed: 80 km/h\n  {table}"), name="cases/bridge.yaml")
        (path.parent / "profiles").mkdir()
        (path.parent / "profiles/measured.csv").write_text("x,r\n0,0\n1,0.001\n20,0.001\n25,0\n")
        monkeypatch.chdir(tmp_path)
        assert axlespan("run", "cases/bridge.yaml", "-o", "out", "--no-figures").code == 0
        with xr.open_dataset("out/result.nc") as data:
            assert float(data["vehicle_displacement"].sel(vehicle_dof="1.wheel1.z").max()) == pytest.approx(
                1e-3, rel=0.2
            )
        monkeypatch.chdir("cases")
        assert axlespan("run", "bridge.yaml", "-o", "../out2", "--no-figures").code == 0
        a, b = (np.fromfile(tmp_path / name / "result.nc", dtype="u1").size for name in ("out", "out2"))
        assert abs(a - b) < 2000  # wall times and names differ

    def test_links(self, axlespan, case, tmp_path):
        path = case()
        (tmp_path / "linked.yaml").symlink_to(path)
        (tmp_path / "real").mkdir()
        (tmp_path / "out").symlink_to("real")
        assert axlespan("run", tmp_path / "linked.yaml", "-o", tmp_path / "out", "--no-figures").code == 0
        assert {p.name for p in (tmp_path / "real").iterdir()} == {"result.nc", "summary.json"}

    def test_an_existing_folder(self, axlespan, case, tmp_path):
        path, out = case(), tmp_path / "out"
        out.mkdir()
        assert axlespan("run", path, "-o", out, "--no-figures").code == 0  # empty folders are as good as new
        before = (out / "result.nc").read_bytes()
        answer = axlespan("run", path, "-o", out)
        assert answer == (
            2,
            "",
            f"axlespan: {out}: exists already and is not empty. Use --force to replace the results in it, or name "
            "another folder with -o\n",
        )
        assert (out / "result.nc").read_bytes() == before

    def test_force_replaces_results_and_nothing_else(self, axlespan, case, tmp_path):
        path, out = case(), tmp_path / "out"
        assert axlespan("run", path, "-o", out, "--paraview").code == 0
        assert FIGURES | {"fields.pvd", "fields"} < {p.name for p in out.iterdir()}
        (out / "notes.txt").write_text("mine")
        (out / "photo.png").write_bytes(b"mine")
        assert axlespan("run", path, "-o", out, "--force", "--no-figures").code == 0
        assert {p.name for p in out.iterdir()} == {"result.nc", "summary.json", "notes.txt", "photo.png"}

    def test_force_keeps_the_old_results_where_the_new_case_is_wrong(self, axlespan, case, tmp_path):
        out = tmp_path / "out"
        assert axlespan("run", case(), "-o", out, "--no-figures").code == 0
        before = {p.name: p.read_bytes() for p in out.iterdir()}
        assert axlespan("run", case(("25 m", "-25 m")), "-o", out, "--force").code == 2
        assert {p.name: p.read_bytes() for p in out.iterdir()} == before

    @pytest.mark.parametrize("inside", ["", "below/it"])
    def test_a_file_in_the_way(self, axlespan, case, inside):
        path = case()
        text = path.read_text()
        answer = axlespan("run", path, "-o", path / inside, "--force")
        assert (answer.code, answer.out) == (2, "")
        rule = "is a file, not a folder" if not inside else "cannot be written to: Not a directory"
        assert answer.err.startswith(f"axlespan: {path / inside}: {rule}. Name a")
        assert path.read_text() == text

    @pytest.mark.parametrize(
        ("out", "words"),
        [
            ("a" * 300, "File name too long"),
            ("dangling", "File exists"),
            pytest.param("/proc/axlespan/out", "No such file or directory", marks=linux),
        ],
    )
    def test_folders_that_cannot_be_made(self, axlespan, case, tmp_path, out, words):
        path = case()
        (tmp_path / "dangling").symlink_to("nowhere")
        answer = axlespan("run", path, "-o", tmp_path / out)
        assert (answer.code, answer.out) == (2, "")
        assert answer.err.endswith(
            f"cannot be written to: {words}. Name a folder that you may write to with -o\n"
        )
        assert {p.name for p in tmp_path.iterdir()} == {"case.yaml", "dangling"}

    @pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere")
    def test_a_folder_without_permission(self, axlespan, case, tmp_path):
        path, closed = case(), tmp_path / "closed"
        closed.mkdir(mode=0o500)
        answer = axlespan("run", path, "-o", closed / "out")
        assert answer.code == 2
        assert "cannot be written to: Permission denied" in answer.err

    def test_what_a_killed_run_left_is_no_obstacle(self, axlespan, case, tmp_path):
        path, out = case(), tmp_path / "out"
        (out / ".axlespan-killed").mkdir(parents=True)
        assert axlespan("run", path, "-o", out, "--no-figures").code == 0
        assert (out / "summary.json").exists()


class TestRunsThatFail:
    HEAVY = (
        ("  - vehicle: sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m\n",
         "  - {vehicle: rigid-mass, mass: 300 t}\n"),
        ("speed: 80 km/h", "speed: 70 m/s"),
    )  # fmt: skip

    def test_divergence_keeps_what_was_computed(self, axlespan, case, tmp_path):
        """Newmark's method, a mass as heavy as the bridge, no footprint: the force grows without bound."""
        path = case(
            *self.HEAVY,
            ("time_step: 1 ms\n  steps: 50", "time_step: 0.2 ms\n  steps: 1700\n  alpha: 0\n  footprint: 0"),
        )
        answer = axlespan("run", path, "-o", tmp_path / "out")
        assert answer.code == 3
        assert "warning: alpha = 0, but wheels have mass" in answer.err
        assert "leave alpha out, or use alpha: -0.1" in answer.err
        told = re.search(
            r"the analysis failed: the run diverged at step (\d+), t = ([\d.]+) s \((.*?)\)", answer.err
        )
        step, at, where = int(told[1]), float(told[2]), told[3]
        assert 200 < step < 1700 and at == pytest.approx(2e-4 * step)
        assert where == "contact 1.1, d.o.f. 1.wheel1.z"
        assert "Use alpha = -0.1, a smaller time step" in answer.err
        with xr.open_dataset(tmp_path / "out/result.nc") as data:
            assert data.attrs["outcome"] == "failed"
            assert f"at step {step}" in data.attrs["outcome_message"]
            assert data.sizes["time"] == step
            np.testing.assert_allclose(data["time"], 2e-4 * np.arange(step), rtol=1e-12)
            assert np.isfinite(data["contact_force"].values).all()
        summary = strict(tmp_path / "out/summary.json")
        assert summary["outcome"]["code"] == "failed"
        assert summary["verdict"] == "attention"
        assert summary["run"]["completed_steps"] == step - 1
        assert "displacement.png" in summary["files"]
        assert ": failed" in answer.out.splitlines()[0]

    def test_iteration_that_does_not_converge(self, axlespan, case, tmp_path):
        path = case(*self.HEAVY, ("steps: 50", "steps: 50\n  method: iterative\n  max_iterations: 20"))
        answer = axlespan("run", path, "-o", tmp_path / "out", "--no-figures")
        assert answer.code == 3
        told = re.search(
            r"failed: step (\d+), t = ([\d.]+) s: the iteration .* did not converge in 20 it", answer.err
        )
        assert float(told[2]) == pytest.approx(1e-3 * int(told[1]))
        assert "Use the direct method" in answer.err
        with xr.open_dataset(tmp_path / "out/result.nc") as data:
            assert data.sizes["time"] == int(told[1])

    def test_no_figures_are_no_reason_to_lose_results(self, axlespan, case, tmp_path):
        """Figures of a paper whose run took far longer."""
        path = case(("midspan: 12.5 m", "midspan: 12.5 m\n  compare: neves2012-3.2"))
        answer = axlespan("run", path, "-o", tmp_path / "out")
        assert answer.code == 0
        assert answer.err.startswith("axlespan: warning: the figures could not be drawn: ")
        assert {p.name for p in (tmp_path / "out").iterdir()} == {"result.nc", "summary.json"}
        assert strict(tmp_path / "out/summary.json")["files"] == ["result.nc", "summary.json"]

    def test_no_modes_of_a_vehicle(self, axlespan, case, tmp_path, monkeypatch):
        def none(*arguments):
            raise AnalysisError("Lanczos' method found 2 of 3 modes")

        monkeypatch.setattr("axlespan.vehicles.vehicle.lowest_modes", none)
        for words in (["check", case()], ["run", case(), "-o", tmp_path / "out"]):
            assert axlespan(*words) == (
                3,
                "",
                "axlespan: the analysis failed: Lanczos' method found 2 of 3 modes\n",
            )
        assert not (tmp_path / "out").exists()

    @pytest.mark.parametrize("message", ["", "cannot allocate 2 TB"])
    def test_no_memory_while_it_runs(self, axlespan, case, tmp_path, monkeypatch, message):
        def starved(plan, progress):
            raise MemoryError(message)

        monkeypatch.setattr("axlespan.cli.run.run_plan", starved)
        answer = axlespan("run", case(), "-o", tmp_path / "a/b")
        expected = message or "there is not enough memory; keep fewer times with every, under output"
        assert answer == (3, "", f"axlespan: the analysis failed: {expected}\n")
        assert not (tmp_path / "a").exists()


def test_same_input_same_numbers(axlespan, case, tmp_path):
    spectrum = "irregularity: {kind: spectrum, name: german-low, seed: 7}"
    path = case(("speed: 80 km/h", f"speed: 80 km/h\n  {spectrum}"))
    for name in ("a", "b"):
        assert axlespan("run", path, "-o", tmp_path / name, "--no-figures").code == 0
    with xr.open_dataset(tmp_path / "a/result.nc") as a, xr.open_dataset(tmp_path / "b/result.nc") as b:
        assert float(np.abs(a["vehicle_acceleration"]).max()) > 1e-3
        for name in VARIABLES:
            np.testing.assert_array_equal(a[name], b[name])
