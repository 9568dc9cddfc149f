"""The documentation builds without a warning, and what it shows comes from the package."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import axlespan
from axlespan.verification.book import CASES

ROOT = Path(__file__).parents[2]
NEEDS = ("sphinx", "myst_parser", "sphinx_gallery", "sphinx_copybutton", "furo")
MISSING = [name for name in NEEDS if find_spec(name) is None]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        bool(MISSING),
        reason=f"{', '.join(MISSING)} not installed: pip install -e '.[dev]' builds the documentation",
    ),
]


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """The folder of the built pages; warnings are errors. Scripts of the gallery that have not changed are kept."""
    place = tmp_path_factory.mktemp("html")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", "docs", str(place)],
        cwd=ROOT,
        env=os.environ | {"AXLESPAN_DOCS_QUICK": "1", "MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-4000:]
    return place


def text_of(page: Path) -> str:
    return re.sub(r"<[^>]+>", "", page.read_text(encoding="utf-8"))


def test_every_page_is_there(pages):
    sources = [path for path in (ROOT / "docs").rglob("*.md") if not {"made", "_build"} & set(path.parts)]
    assert len(sources) > 40
    for source in sources:
        page = pages / source.relative_to(ROOT / "docs").with_suffix(".html")
        assert page.exists(), page


def test_the_gallery_shows_every_script_with_a_figure(pages):
    scripts = sorted((ROOT / "docs" / "gallery").glob("plot_*.py"))
    assert len(scripts) >= 10
    for script in scripts:
        page = (pages / "made" / "gallery" / script.name).with_suffix(".html")
        assert f"sphx_glr_{script.stem}_001.png" in page.read_text(encoding="utf-8"), script.name


def test_the_verification_book_is_the_package_s(pages):
    """Quick cases stand on the page with their numbers; slow ones are named."""
    text = text_of(pages / "made" / "verification.html")
    for case in CASES:
        assert case.title in text or case.name in text, case.name
    assert "FAIL" not in text


def test_every_public_name_is_on_the_page_of_names(pages):
    page = (pages / "made" / "api.html").read_text(encoding="utf-8")
    for name in axlespan.__all__:
        if not re.fullmatch(r"bridges|irregularity|plot|standards|vehicles", name):
            assert f'id="axlespan.{name}"' in page, name
    result = page[page.index('id="axlespan.Result"') :]
    assert "n_time, n_sensor" in re.sub(r"<[^>]+>", "", result[:40_000])  # told by comments behind fields


def test_no_page_asks_another_server(pages):
    """Scripts, styles, fonts and images come along; equations too."""
    for page in pages.rglob("*.html"):
        for target in re.findall(r'<(?:script|link|img)[^>]+(?:src|href)="([^"]+)"', page.read_text("utf-8")):
            assert not target.startswith(("http:", "https:", "//")), f"{page.name}: {target}"
    page = (pages / "theory" / "direct-method.html").read_text(encoding="utf-8")
    assert "mathjax-tex-svg.js" in page
    assert (pages / "_static" / "mathjax-tex-svg.js").stat().st_size > 1_000_000
