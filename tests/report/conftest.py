"""Results to report, and a real browser to read the pages with."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from axlespan.cli.run import Wanted, run_case
from axlespan.report import write_report

EXAMPLES = Path(__file__).parents[2] / "src" / "axlespan" / "examples"
SWITCHES = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]

SOLID = """\
title: A small beam of solids
structure:
  kind: mesh
  mesh: {box: {lengths: [12 m, 2 m, 1 m], divisions: [24, 2, 2]}}
  materials:
    concrete: {youngs_modulus: 30 GPa, poisson_ratio: 0.2, density: 2500 kg/m^3}
  sections:
    volume: {material: concrete}
  supports:
    - {name: left, at: {x: 0 m, z: 0 m}, fixed: [x, y, z]}
    - {name: right, at: {x: 12 m, z: 0 m}, fixed: [y, z]}
  running_line: {nodes: {y: 1 m, z: 1 m}}
train:
  - {vehicle: sprung-mass, mass: 20 t, stiffness: 1595 kN/m, count: 2, spacing: 3 m}
crossing: {speed: 100 km/h}
analysis: {time_step: 2 ms, steps: 300, alpha: -0.1, footprint: 0.5 m}
output: {fields: {every: 10}, sensors: {midspan: 6 m}}
"""


def run(text: str, folder: Path) -> Path:
    """Run a case; its folder with a page."""
    case = folder.with_suffix(".yaml")
    case.write_text(text, encoding="utf-8")
    assert run_case(case, folder, force=True, wanted=Wanted(figures=False, report=True)) == 0
    return folder


@pytest.fixture(scope="session")
def beam(tmp_path_factory):
    """The demo: a sprung mass on a beam."""
    text = (EXAMPLES / "neves2012-3.1.yaml").read_text(encoding="utf-8")
    return run(text, tmp_path_factory.mktemp("pages") / "beam")


@pytest.fixture(scope="session")
def train(tmp_path_factory):
    """Many wheels on a wavy surface, more times than a plot shows."""
    text = (EXAMPLES / "neves2012-3.2.yaml").read_text(encoding="utf-8")
    text = text.replace("count: 50", "count: 30").replace("14000", "7000")
    return run(text, tmp_path_factory.mktemp("pages") / "train")


@pytest.fixture(scope="session")
def solid(tmp_path_factory):
    """Solids with fields."""
    return run(SOLID, tmp_path_factory.mktemp("pages") / "solid")


@pytest.fixture
def copy(beam, tmp_path):
    """A copy of the demo's results without its page, to spoil."""
    folder = tmp_path / "copy"
    shutil.copytree(beam, folder)
    (folder / "report.html").unlink()
    return folder


def chromium() -> str:
    """Path of a Chromium, or the test is skipped with what is missing."""
    named = os.environ.get("AXLESPAN_CHROMIUM")
    found = named or next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
    )
    if not found:
        pytest.skip("no Chromium: apt-get install chromium, or set AXLESPAN_CHROMIUM to its path")
    return found


@pytest.fixture(scope="session")
def browser():
    """A Chromium that draws in space in software."""
    sync_api = pytest.importorskip(
        "playwright.sync_api", reason="playwright is not installed: pip install 'axlespan[dev]'"
    )
    path = chromium()
    with sync_api.sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=path, args=SWITCHES)
        yield opened
        opened.close()


class Reader:
    """A page that is open, and what it complained about."""

    def __init__(self, browser, file, **options):
        self.context = browser.new_context(**{"viewport": {"width": 1200, "height": 900}, **options})
        self.page = self.context.new_page()
        self.complaints: list[str] = []
        self.page.on("console", lambda m: m.type in ("error", "warning") and self.complaints.append(m.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", self._asked)
        self.page.goto(file.as_uri())
        self.page.wait_for_selector("html[data-ready=yes]", timeout=15_000)

    def _asked(self, request):
        if not request.url.startswith(("file:", "data:", "blob:")):
            self.complaints.append(f"asked for {request.url}")

    def wait(self, script):
        """Until an expression is true; not by playwright's own means, which the page's policy forbids."""
        for _ in range(100):
            if self.run(script):
                return
            self.page.wait_for_timeout(50)
        raise AssertionError(f"not within 5 s: {script}")

    def run(self, script, argument=None):
        return self.page.evaluate(script, argument)


@pytest.fixture
def read(browser):
    """Open pages; at the end none may have complained."""
    readers: list[Reader] = []

    def opened(folder, **options):
        file = folder if folder.suffix == ".html" else write_or_there(folder)
        readers.append(Reader(browser, file, **options))
        return readers[-1]

    yield opened
    for reader in readers:
        reader.context.close()
    # what software rendering says of itself is no fault of the page
    said = [text for reader in readers for text in reader.complaints if "GPU stall" not in text]
    assert said == []


def write_or_there(folder):
    page = folder / "report.html"
    return page if page.exists() else write_report(folder)
