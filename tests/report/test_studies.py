# ruff: noqa: E501
"""Pages of studies: small ones as run, unfinished ones, and one of 50 000 scenarios."""

from __future__ import annotations

import json
import re
import shutil
import time

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from tests.report.test_pages import content_of, report, text_of

from axlespan.report import result_page, write_report
from axlespan.study.sweep import Answers, Study
from axlespan.study.sweep.answers import Envelope
from axlespan.study.sweep.store import Store

STUDY = """\
title: Coaches on a span
base:
  structure: {kind: simple-span, length: 20 m, youngs_modulus: 34 GPa, second_moment: 1.2 m^4, mass_per_length: 15 t/m, elements: 8}
  train: [{vehicle: axle-loads, loads: 170 kN}]
  crossing: {speed: 100 km/h}
  analysis: {time_step: 4 ms}
  output: {sensors: {midspan: 10 m}, line: 9}
  assessment: {deck: ballasted, line_speed: 300 km/h}
trains:
  coaches of 18 m: [{vehicle: axle-loads, loads: 170 kN, positions: [0 m, 2 m], count: 6, spacing: 18 m}]
  coaches of 26 m: [{vehicle: axle-loads, loads: 170 kN, positions: [0 m, 2 m], count: 5, spacing: 26 m}]
vary:
  train: [coaches of 18 m, coaches of 26 m]
  crossing.speed: {from: 120 km/h, to: 300 km/h, step: 20 km/h}
passage: {after: 0.5 s}
histories: {variables: [sensor_acceleration], every: 2}
"""


@pytest.fixture(scope="session")
def study(tmp_path_factory):
    """A study of two trains at ten speeds."""
    folder = tmp_path_factory.mktemp("study")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    made = Study.load(folder / "study.yaml")
    made.run(folder / "store")
    store = Store.open(folder / "store")
    store.write_summary(Answers.of_store(store, made).summary())
    return folder / "store"


def many(folder, n):
    """A store of n scenarios of ten trains, made up; 30 failed."""
    folder.mkdir()
    rng = np.random.default_rng(5)
    speed = np.tile(np.linspace(30.0, 100.0, 100), n // 100)
    value = np.abs(rng.normal(2.0, 1.0, n))
    value[12_345] = 99.0
    outcome = np.array(["completed"] * n, dtype=object)
    outcome[100:130] = "failed"
    value[100:130] = np.nan
    columns = {
        "id": ("int", np.arange(n)),
        "outcome": ("text", outcome),
        "reason": ("text", np.where(outcome == "failed", "diverged", None)),
        "train_name": ("text", np.array([f"train {i % 10}" for i in range(n)], dtype=object)),
        "speed_m_per_s": ("number", speed),
        "seconds": ("number", np.ones(n)),
        "steps": ("int", np.ones(n, dtype=int)),
        "passed": ("flag", np.ones(n, dtype=bool)),
        "line_acceleration_max_m_per_s2": ("number", value),
    }
    (folder / "table").mkdir()
    pq.write_table(
        pa.table({name: values for name, (_, values) in columns.items()}), folder / "table" / "a.parquet"
    )
    header = {"format": "axlespan study", "format_version": 1, "version": "0.1.0", "title": "Many", "digest": "x",
              "scenarios": n, "paths": ["crossing.speed"], "columns": {k: kind for k, (kind, _) in columns.items()}}  # fmt: skip
    (folder / "store.json").write_text(json.dumps(header), encoding="utf-8")
    return folder


def test_a_study_in_words_and_numbers(study):
    text, content = text_of(result_page(study)), content_of(result_page(study))
    table = Store.open(study).table()
    assert "20 of 20 scenarios around one case are completed; what varies: train, crossing › speed." in text
    assert "Trains (2): coaches of 18 m, coaches of 26 m; from 120 to 300 km/h." in text
    worst = table["line_acceleration_max_m_per_s2"].max()
    assert f"Largest acceleration along the line {worst:#.4g} m/s²" in text
    assert re.search(r"deck acceleration \d+ % coaches of", text)
    assert [series["name"] for series in content["envelopes"][0]["series"]] == [
        "coaches of 18 m",
        "coaches of 26 m",
    ]
    # v = f d / i: f1 of the simple span, coaches of 18 or 26 m
    f1 = np.pi / 2 / 20.0**2 * np.sqrt(34e9 * 1.2 / 15e3)
    expected = [3.6 * f1 * d / i for d in (18.0, 26.0) for i in range(1, 6)]
    for mark in content["envelopes"][0]["marks"]:
        if min(abs(mark / value - 1.0) for value in expected) > 2e-3:
            assert any(abs(mark / (4.0 * value) - 1.0) < 5e-3 for value in expected)  # of the second mode
    assert content["maps"]["rows"] == ["coaches of 18 m", "coaches of 26 m"]
    assert len(content["histories"]) == 20


def test_a_study_in_a_browser(study, read):
    """A click on the worst point opens its histories; the table sorts and filters."""
    table = Store.open(study).table()
    reader = read(study)
    page = reader.page
    plot = "document.querySelector('#envelope-list .plot').plot"
    got = reader.run(f"{plot}.series.map(s => [s.name, Array.from(s.y)])")
    for name, values in got:
        mine = table[table.train_name == name].sort_values("speed_m_per_s")["line_acceleration_max_m_per_s2"]
        np.testing.assert_allclose(values, mine, rtol=1e-6)
    worst = int(table["line_acceleration_max_m_per_s2"].idxmax())
    place = reader.run(
        f"""(p => {{ p.frame.scrollIntoView({{ block: 'center', behavior: 'instant' }}); const b = p.u.over.getBoundingClientRect();
        return [b.x + p.u.valToPos({3.6 * table.speed_m_per_s[worst]}, 'x'), b.y + p.u.valToPos({table.line_acceleration_max_m_per_s2[worst]}, 'y')]; }})({plot})"""
    )
    page.mouse.move(*place)
    page.mouse.click(*place)
    reader.wait("!document.getElementById('scenario').hidden")
    assert page.inner_text("#scenario-title") == f"Scenario {worst}"
    peak = reader.run(
        "Math.max(...Array.from(document.querySelector('#scenario-plots .plot').plot.series[0].y, Math.abs))"
    )
    assert peak <= table["line_acceleration_max_m_per_s2"][worst] * (1.0 + 1e-6)
    assert peak > 0.7 * table["sensor.midspan.acceleration_max_m_per_s2"][worst]
    heads = page.query_selector_all("#scenario-table th button")
    names = [head.inner_text() for head in heads]
    column = next(i for i, name in enumerate(names) if name.startswith("Largest acceleration"))
    heads[column].click()
    assert page.inner_text("#scenario-table tbody tr td button") == str(worst)
    assert page.query_selector_all("#scenario-table th")[column].get_attribute("aria-sort") == "descending"
    page.fill("#scenario-table input[aria-label='Filter: speed [km/h]']", "> 250")
    assert page.inner_text("#scenario-table p[role=status]") == "1 to 6 of 6 scenarios, of 20 in all"
    page.fill("#scenario-table input[aria-label='Filter: train']", "26")
    assert page.inner_text("#scenario-table p[role=status]") == "1 to 3 of 3 scenarios, of 20 in all"
    page.focus("#heat .canvas")
    page.keyboard.press("ArrowRight")
    assert re.match(r"coaches of 18 m, 140\.0 km/h: [\d.]+ m/s²", page.inner_text("#heat .tip"))
    page.keyboard.press("Enter")
    assert page.inner_text("#scenario-title") == "Scenario 1"
    assert reader.run("document.documentElement.scrollWidth") <= 1200


def test_a_study_that_is_not_complete(study, tmp_path):
    folder = tmp_path / "part"
    shutil.copytree(study, folder)
    (part,) = (folder / "table").glob("*.parquet")
    pq.write_table(pq.read_table(part).slice(0, 7), part)
    (folder / "summary.json").unlink()
    text = text_of(result_page(folder))
    assert "7 of 20 scenarios are done: the study is still running, or was stopped" in text
    assert "! not complete" in text and "7 of 20 scenarios around one case are completed" in text
    part.unlink()
    text = text_of(result_page(folder))
    assert "0 of 20 scenarios are done" in text
    (folder / "store.json").write_text("{")
    code, _, said = report(folder)
    assert code == 2 and "is damaged, or no study of axlespan" in said


def test_fifty_thousand_scenarios(tmp_path, read):
    folder = many(tmp_path / "many", 50_000)
    begin = time.perf_counter()
    page = write_report(folder)
    assert time.perf_counter() - begin < 30.0
    assert page.stat().st_size < 3e6
    assert "30 scenarios failed: diverged" in text_of(page.read_text(encoding="utf-8"))
    reader = read(folder)
    reader.page.click("#scenario-table th:nth-child(4) button")
    assert reader.page.inner_text("#scenario-table tbody tr td button") == "12345"
    assert reader.page.inner_text("#scenario-table tbody tr td:nth-child(4)") == "99.00"
    assert reader.page.inner_text("#scenario-table p[role=status]") == "1 to 100 of 50000 scenarios"
    reader.page.click("#scenario-table button:has-text('12345')")
    assert "The study keeps no histories" in reader.page.inner_text("#scenario-plots")


def test_the_worst_of_a_smallest_value_is_the_smallest():
    """Of contact forces of 40, 55 and 50 kN the first unloads most; of deflections the lowest counts."""
    speed, id = np.array([10.0, 20.0, 30.0]), np.arange(3)
    assert Envelope(speed, np.array([40e3, 55e3, 50e3]), id, lowest=True).worst == 0
    assert Envelope(speed, np.array([-1e-3, -3e-3, 0.0]), id, lowest=True).worst == 1
    assert Envelope(speed, np.array([1.0, -3.0, 2.0]), id).worst == 1
