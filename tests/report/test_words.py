"""What a report says of the surface, for kinds of irregularities that hold others."""

import pytest

from axlespan.report.words import _irregularity

BUMP = {"kind": "bump", "at": "12 m", "height": "5 mm", "length": "2 m"}
IN_WORDS = "a bump (at 12 m, height 5 mm, length 2 m)"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (BUMP, IN_WORDS),
        (
            {"kind": "sum", "of": [{"kind": "spectrum", "name": "german-low", "seed": 1}, BUMP]},
            f"a random profile made from a spectrum (name german-low, seed 1), and {IN_WORDS}",
        ),
        (
            {"kind": "lines", "lines": {"left": {"kind": "sum", "of": [BUMP]}, "right": "none"}},
            f"on the line left {IN_WORDS}; on the line right none",
        ),
    ],
)
def test_surface(given, said):
    assert _irregularity({"crossing": {"irregularity": given}}) == f"The running surface is uneven: {said}."
