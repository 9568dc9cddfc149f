"""Pages of results that are whole, spoiled, cut short, old, failed or huge; no browser."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import shutil
import time
import zlib
from dataclasses import replace
from importlib.resources import files

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from axlespan.cli.app import app
from axlespan.errors import InputError, Outcome
from axlespan.io.drawing import read_drawing
from axlespan.io.results import FORMAT_VERSION, read_result, write_result
from axlespan.io.summary import summary, write_summary
from axlespan.report import result_page, write_report
from axlespan.report.pack import Pack
from axlespan.report.tables import verdict_table
from axlespan.report.thinning import POINTS, rows_for


def text_of(page: str) -> str:
    """What a reader sees, without markup."""
    body = re.sub(r"<(script|style).*?</\1>", "", page, flags=re.DOTALL)
    return " ".join(re.sub(r"<[^>]+>", " ", body).split())


def content_of(page: str) -> dict:
    (found,) = re.findall(
        r'<script type="application/json" id="content">(.*?)</script>', page, flags=re.DOTALL
    )
    return json.loads(found)


def report(*words):
    done = CliRunner().invoke(app, ["report", *map(str, words)])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done.exit_code, done.stdout, done.stderr


# --- what a page says ------------------------------------------------------------------------------


def test_the_case_in_plain_words(beam):
    text = text_of((beam / "report.html").read_text(encoding="utf-8"))
    assert (
        "A train (sprung mass; 1 wheel) crosses a structure (simple span, 25 m long) at 100 km/h (27.78 m/s)."
        in text
    )
    assert "The running surface is even." in text
    assert "computed over 0.9 s in 900 steps of 1 ms" in text
    assert "Largest displacement of a sensor −2.407 mm at midspan" in text  # the paper's figure 3: -2.41 mm
    assert re.search(r"Largest acceleration of a body −?[\d.]+ m/s² vehicle 1, at its center", text)
    assert "young" not in text.lower() or "2.87 GPa" in text


def test_the_train_is_told_with_its_surface(train):
    text = text_of((train / "report.html").read_text(encoding="utf-8"))
    assert "A train (30 × sprung mass; 30 wheels, 87 m from the first to the last)" in text
    assert "regular waves (amplitude 0.5 mm, wavelength 5 m, from 0 m, to 25 m)" in text
    assert "15 more vehicles follow; the train is 88.2 m long" in text


def test_pages_ask_nobody(beam, solid):
    for folder in (beam, solid):
        page = (folder / "report.html").read_text(encoding="utf-8")
        links = set(re.findall(r"""(?:src|href)=["']([^"'#][^"']*)""", page.split("<script>")[0]))
        assert links == {"data:,"}
        assert "default-src 'none'" in page and "connect-src 'none'" in page
    assert "var THREE=" not in (beam / "report.html").read_text(encoding="utf-8")
    assert "var THREE=" in (solid / "report.html").read_text(encoding="utf-8")


def test_geometry_goes_along_with_the_result(train, solid):
    with h5py.File(train / "result.nc") as file:
        drawing = read_drawing(file)
    assert drawing.content["lines"]["main"] == [[0.0, 0.0, 0.0, 0.0], [25.0, 25.0, 0.0, 0.0]]
    assert [len(t["placements"]) for t in drawing.content["trains"]] == [30]
    assert drawing.content["vehicles"][0]["static_N"] == [pytest.approx(5750 * 9.81)]
    assert [s["point"][0] for s in drawing.content["supports"]] == [0.0, 25.0]
    profile = drawing.content["profile"]
    s = profile["from"] + profile["step"] * np.arange(len(profile["r"]))
    inside = (s >= 0.0) & (s <= 25.0)
    np.testing.assert_allclose(
        profile["r"], np.where(inside, 0.5e-3 * np.sin(2 * np.pi * s / 5.0), 0.0), rtol=0.0, atol=1e-8
    )
    with h5py.File(solid / "result.nc") as file:
        drawing = read_drawing(file)
    points, faces = drawing.arrays["points"], drawing.arrays["faces"]
    normals = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    assert 0.5 * np.linalg.norm(normals, axis=1).sum() == pytest.approx(2 * (12 * 2 + 12 * 1 + 2 * 1))
    # bending by a mid-load: the largest stress is at the bottom or the top, near midspan
    stress = drawing.arrays["face_stress"]
    at = np.unravel_index(int(np.nanargmax(stress)), stress.shape)[1]
    assert abs(points[faces[at], 0].mean() - 6.0) < 2.5


def test_results_without_geometry_are_drawn_by_their_names(train, tmp_path):
    result = read_result(train / "result.nc")
    write_result(result, tmp_path / "result.nc")
    write_summary(
        summary(result, title="No geometry") | {"run": {"structure_from_m": 0.0, "structure_to_m": 25.0}},
        tmp_path / "summary.json",
    )
    content = content_of(result_page(tmp_path))
    assert len(content["scene"]["units"]) == 30
    assert [unit["wheels"][0][1] for unit in content["scene"]["units"]] == pytest.approx(3.0 * np.arange(30))


def test_verdicts_show_how_much_is_used():
    rows = [
        {"clause": "EN 1990 A2.4.4.2.1", "quantity": "deck acceleration", "value": 2.8, "limit": 3.5, "unit": "m/s^2",
         "utilization": 0.8, "where": "midspan", "when": 1.25, "outcome": "pass", "source": "from memory"},
        {"clause": "EN 1990 A2.4.4.2.2", "quantity": "twist", "value": None, "limit": None, "unit": "m",
         "utilization": None, "where": "", "when": None, "outcome": "not assessed", "reason": "one rail only"},
        {"clause": "EN 14363", "quantity": "unloading <Q/Q0>", "value": 0.9, "limit": 0.6, "unit": "",
         "utilization": 1.5, "outcome": "fail"},
    ]  # fmt: skip
    table = verdict_table({"verdicts": rows})
    text = text_of(table)
    assert (
        "deck acceleration* EN 1990 A2.4.4.2.1 2.800 m/s² 3.500 m/s² 80 % midspan, 1.250 s ✓ passed" in text
    )
    assert "twist one rail only EN 1990 A2.4.4.2.2 – – –" in text and "– not assessed" in text
    assert "&lt;Q/Q0&gt;" in table and "150 %" in text and "✗ failed" in text
    assert 'class="bar over"' in table and "width:80.0%" in table
    # what fails comes first, what was not assessed last; numbers that nobody has checked are marked
    assert text.index("unloading") < text.index("deck acceleration*") < text.index("twist one rail only")
    assert "* Numbers of the standard from memory: check against the standard" in text
    assert "from memory" not in verdict_table({"verdicts": rows[1:]})
    assert verdict_table({}) == ""


def test_speeds_of_trains_are_in_km_h():
    row = {
        "quantity": "resonance speed",
        "value": 80.785,
        "limit": None,
        "unit": "m/s",
        "outcome": "reported",
    }
    assert "resonance speed 290.8 km/h – – i reported" in text_of(verdict_table({"verdicts": [row]}))


# --- folders that are spoiled ----------------------------------------------------------------------


def test_refusals_end_with_2_and_say_why(copy, tmp_path):
    empty = tmp_path / "empty"
    empty.mkdir()
    for target, words in (
        (tmp_path / "nowhere", "does not exist"),
        (empty, "is not a result of axlespan: it has no result.nc"),
    ):
        code, _, said = report(target)
        assert code == 2 and words in said, said
    other = tmp_path / "case.yaml"
    other.write_text("title: x")
    code, _, said = report(other)
    assert code == 2 and "it is no netCDF-4 file, or was cut short" in said
    with h5py.File(tmp_path / "other.nc", "w") as file:
        file["time"] = np.arange(3.0)
    code, _, said = report(tmp_path / "other.nc")
    assert code == 2 and "is not a result of axlespan" in said
    with h5py.File(copy / "result.nc", "r+") as file:
        file.attrs["format_version"] = FORMAT_VERSION + 1
        file.attrs["version"] = "9.1"
    code, _, said = report(copy)
    assert code == 2 and f"written by axlespan 9.1 in format {FORMAT_VERSION + 1}" in said
    assert "pip install --upgrade axlespan" in said
    assert not (copy / "report.html").exists()


def test_a_result_cut_short_still_gives_its_tables(copy):
    data = (copy / "result.nc").read_bytes()
    (copy / "result.nc").write_bytes(data[: len(data) // 2])
    code, said, _ = report(copy)
    assert code == 0 and "report.html" in said
    text = text_of((copy / "report.html").read_text(encoding="utf-8"))
    assert "result.nc is cut short or damaged" in text and "the tables are from summary.json" in text
    assert "−2.407" in text
    (copy / "summary.json").unlink()
    code, _, said = report(copy)
    assert code == 2 and "cut short" in said


def test_a_result_without_summary_makes_its_tables_anew(copy):
    (copy / "summary.json").unlink()
    text = text_of(result_page(copy))
    assert "There is no summary.json: the run may have been stopped." in text
    assert "−2.407" in text and "compatibility" in text


def test_a_run_killed_while_it_wrote(copy, tmp_path):
    folder = tmp_path / "killed"
    stage = folder / ".axlespan-abc"
    stage.mkdir(parents=True)
    code, _, said = report(folder)
    assert code == 2 and "is not finished, or was stopped before it had a result" in said
    (stage / "result.nc").write_bytes((copy / "result.nc").read_bytes())
    text = text_of(result_page(folder))
    assert "The run was stopped while its results were written; this is what was there." in text
    assert "−2.407" in text


def test_only_a_summary(copy):
    (copy / "result.nc").unlink()
    text = text_of(result_page(copy))
    assert "result.nc is missing" in text and "−2.407" in text


@pytest.mark.parametrize(
    ("gone", "words"),
    [
        ("sensor_displacement", "no histories at sensors"),
        ("contact_position", "no positions of the wheels"),
        ("vehicle_displacement", "no motions of the vehicles"),
        ("line_displacement", None),
        ("drawing", None),
    ],
)
def test_missing_histories_are_told_and_the_rest_is_there(copy, gone, words):
    with h5py.File(copy / "result.nc", "r+") as file:
        del file[gone]
    page = result_page(copy)
    content, text = content_of(page), text_of(page)
    assert words is None or f"The file has {words}." in text
    keys = {panel["key"] for panel in content["panels"]}
    assert {"acceleration", "contact", "reaction"} <= keys and ("displacement" in keys) == (
        gone != "sensor_displacement"
    )
    assert (content["scene"] is None) == (gone == "contact_position")
    assert len(content["maps"]) == (1 if gone == "line_displacement" else 2)


def test_a_failed_run_shows_what_was_computed(copy):
    result = read_result(copy / "result.nc")
    n = 400
    cut = {
        name: getattr(result, name)[:n].copy()
        for name in ("time", "sensor_displacement", "sensor_velocity", "sensor_acceleration", "contact_force",
                     "contact_position", "vehicle_displacement", "vehicle_velocity", "vehicle_acceleration",
                     "support_reaction", "line_displacement", "line_acceleration", "line_slope")
    }  # fmt: skip
    cut["sensor_acceleration"][-3:] = np.nan
    failed = Outcome("failed", "the run diverged at step 400", "Use alpha = -0.1.")
    broken = replace(result, outcome=failed, **cut)
    write_result(broken, copy / "result.nc")
    write_summary(summary(broken, title="Broken"), copy / "summary.json")
    page = result_page(copy)
    text = text_of(page)
    assert "✗ failed" in text
    assert "did not reach its end" in text and "The run diverged at step 400. Use alpha = -0.1." in text
    content = content_of(page)
    assert {panel["key"] for panel in content["panels"]} >= {"displacement", "acceleration"}
    assert "NaN" not in json.dumps(content)


def test_a_result_with_one_time(copy):
    result = read_result(copy / "result.nc")
    names = [name for name in vars(result) if isinstance(getattr(result, name), np.ndarray)]
    few = {
        name: getattr(result, name)[:1] for name in names if len(getattr(result, name)) == len(result.time)
    }
    write_result(replace(result, **few), copy / "result.nc")
    page = result_page(copy)
    assert "fewer than two times: there is nothing to plot" in text_of(page)
    assert "panels" not in content_of(page)


def test_pages_that_cannot_be_written(copy, tmp_path):
    code, _, said = report(copy, "-o", tmp_path / "no" / "page.html")
    assert code == 3 and "the page cannot be written: No such file or directory" in said
    assert write_report(copy / "result.nc", tmp_path / "page.html") == tmp_path / "page.html"
    with pytest.raises(InputError, match="does not exist"):
        write_report(tmp_path / "nowhere")


# --- sizes -----------------------------------------------------------------------------------------


def test_ten_million_samples_keep_their_peaks():
    n = 10_000_000
    values = np.sin(np.arange(n) * 1e-3).astype(float)
    values[1_234_567], values[7_654_321] = 5.0, -6.0
    values[42] = np.nan
    begin = time.perf_counter()
    kept = rows_for(n, [0], lambda column: values)
    assert time.perf_counter() - begin < 15.0
    assert len(kept) <= POINTS and {1_234_567, 7_654_321, 0, n - 1} <= set(kept.tolist())
    many = rows_for(100_000, range(24), lambda column: np.roll(values[:100_000], 4001 * column))
    assert len(many) <= 3000


def test_packed_arrays_unpack():
    rng = np.random.default_rng(3)
    pack = Pack()
    values = [rng.normal(size=1000), np.arange(7), rng.normal(size=(5, 4))]
    pack.add(values[0], "f8")
    pack.add(values[1], "i4")
    quantized = pack.quantized(values[2])
    raw = zlib.decompress(base64.b64decode(pack.text()))
    assert pack.directory() == [["f8", 1000], ["i4", 7], ["i2", 20]]
    first = np.frombuffer(raw[:8000], np.uint8).reshape(8, 1000).T.copy().view("<f8").ravel()
    np.testing.assert_array_equal(first, values[0])
    last = np.frombuffer(raw[8028:], np.uint8).reshape(2, 20).T.copy().view("<i2").ravel()
    back = quantized["offset"] + quantized["scale"] * last.reshape(5, 4)
    np.testing.assert_allclose(back, values[2], rtol=0.0, atol=0.51 * np.ptp(values[2]) / 64_000)


def test_libraries_are_the_published_ones():
    """Checksums of what is bundled, as vendor/README.md gives them."""
    vendor = files("axlespan.report") / "vendor"
    listed = re.findall(
        r"^\| `(\S+)` \|.*\| `([0-9a-f]{64})` \|$", (vendor / "README.md").read_text(), flags=re.MULTILINE
    )
    assert {name for name, _ in listed} == {
        "uplot/uPlot.iife.min.js",
        "uplot/uPlot.min.css",
        "three/three-parts.min.js",
    }
    for name, digest in listed:
        assert hashlib.sha256(vendor.joinpath(*name.split("/")).read_bytes()).hexdigest() == digest, name
    for name in ("uplot", "three"):
        assert "MIT" in (vendor / name / "LICENSE").read_text(encoding="utf-8")


def test_values_that_are_no_numbers(copy):
    """Without a summary the tables are made from what is there."""
    with h5py.File(copy / "result.nc", "r+") as file:
        for name in ("sensor_displacement", "contact_force", "vehicle_acceleration"):
            file[name][300:400] = np.nan
            file[name][700] = np.inf
    assert report(copy)[0] == 0
    (copy / "summary.json").unlink()
    code, _, said = report(copy)
    assert code == 0 and "There is no summary.json" in said  # told at the terminal too
    text = text_of((copy / "report.html").read_text(encoding="utf-8"))
    assert "Extremes of the contact forces" in text and not re.search(r"\bnan\b", text)


def test_a_summary_of_a_later_version_is_left_out(copy):
    content = json.loads((copy / "summary.json").read_text(encoding="utf-8"))
    content |= {"format_version": 2, "version": "9.1", "verdict": "of another kind"}
    (copy / "summary.json").write_text(json.dumps(content), encoding="utf-8")
    code, _, said = report(copy)
    assert code == 0 and "summary.json was written by axlespan 9.1, later than this one" in said
    assert "There is no summary.json" not in said
    assert "−2.407" in text_of((copy / "report.html").read_text(encoding="utf-8"))


def test_what_only_the_file_knows_is_not_guessed(train, tmp_path):
    """The running line may be longer than the bridge: without the file no length and no drawing."""
    shutil.copy(train / "summary.json", tmp_path)
    page = result_page(tmp_path)
    text = text_of(page)
    assert "crosses a structure (simple span)" in text and '<svg class="sketch"' not in page


def test_titles_are_cut_where_nobody_reads_on(copy):
    content = json.loads((copy / "summary.json").read_text(encoding="utf-8"))
    content["run"]["title"] = "<b>long</b> " * 100
    (copy / "summary.json").write_text(json.dumps(content), encoding="utf-8")
    (title,) = re.findall(r"<h1>(.*?)</h1>", result_page(copy), flags=re.DOTALL)
    assert title.startswith("&lt;b&gt;long&lt;/b&gt; ") and title.endswith("…") and title.count("long") == 13
