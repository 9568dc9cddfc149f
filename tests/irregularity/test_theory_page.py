"""The code in the theory page runs, and its numbers are those of the program."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from axlespan import irregularity as ir

PAGE = (Path(__file__).parents[2] / "docs" / "theory" / "irregularities.md").read_text(encoding="utf-8")


def test_code_blocks_run():
    blocks = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    assert len(blocks) == 3
    exec(compile("\n".join(blocks), "irregularities.md", "exec"), {})


def test_table_of_standard_deviations():
    # Rows of one or two names with as many numbers in each of the three columns.
    rows = re.findall(r"^\| (`[^|]*) \| ([\d. /]+) \| ([\d. /]+) \| ([\d. /]+) \|$", PAGE, flags=re.MULTILINE)
    assert len(rows) == 6
    for head, *cells in rows:
        for i, name in enumerate(re.findall(r"`([a-z0-9-]+)`", head)):
            spectrum = ir.spectrum(name)
            if name.startswith("sncf"):
                spectrum = spectrum.extended(2.0, 150.0)
            for cell, band in zip(cells, ir.EN13848_BANDS.values(), strict=True):
                stated = float(cell.split("/")[i])
                assert 1e3 * spectrum.standard_deviation(*band) == pytest.approx(stated, abs=0.5001e-3)


def test_every_spectrum_is_in_the_page():
    listed = set(re.findall(r"`((?:fra|german|sncf|china|iso8608)[a-z0-9-]*)`", PAGE))
    for name in ir.spectrum_names():
        family = re.sub(r"-([1-6]|[a-h])$", "", name)
        assert (
            name in listed
            or {f"{family}-1", f"{family}-6"} <= listed
            or {f"{family}-a", f"{family}-h"} <= listed
        )
