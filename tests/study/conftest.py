"""A case file to break, and what the loader says then."""

from collections.abc import Callable

import pytest

from axlespan.errors import InputError
from axlespan.study import LoadedCase, read_case

FOOTBRIDGE = """\
title: Footbridge
structure:
  kind: simple-span
  length: 25 m
  youngs_modulus: 34 GPa
  second_moment: 0.9 m^4
  mass_per_length: 12 t/m
  elements: 20
  damping: {kind: rayleigh, ratio: 1 %, frequencies: [3 Hz, 12 Hz]}
train:
  - vehicle: sprung-mass
    mass: 5750 kg
    stiffness: 1595 kN/m
    count: 3
    spacing: 10 m
crossing:
  speed: 80 km/h
analysis:
  time_step: 1 ms
  steps: 2000
output:
  sensors:
    midspan: 12.5 m
"""


def replaced(text: str, edits: tuple[tuple[str, str], ...]) -> str:
    """Replace each old piece, which stands there, by the new one."""
    for old, new in edits:
        assert old in text, f"{old!r} is not in the case"
        text = text.replace(old, new, 1)
    return text


@pytest.fixture
def footbridge() -> str:
    """The text of a right case file."""
    return FOOTBRIDGE


@pytest.fixture
def loaded() -> Callable[..., LoadedCase]:
    """Load the case with pieces of its text replaced."""

    def load(*edits: tuple[str, str], **options: object) -> LoadedCase:
        return read_case(replaced(FOOTBRIDGE, edits), **options)  # type: ignore[arg-type]

    return load


@pytest.fixture
def complaint(loaded: Callable[..., LoadedCase]) -> Callable[..., str]:
    """Return all that the loader says against the case with pieces of its text replaced."""

    def complain(*edits: tuple[str, str], **options: object) -> str:
        with pytest.raises(InputError) as caught:
            loaded(*edits, **options)
        return str(caught.value)

    return complain


BLOCKS = {
    "<train>": FOOTBRIDGE[FOOTBRIDGE.index("  - vehicle") : FOOTBRIDGE.index("crossing:")],
    "<structure>": FOOTBRIDGE[FOOTBRIDGE.index("structure:") : FOOTBRIDGE.index("train:")],
    "<all>": FOOTBRIDGE,
}


@pytest.fixture
def blocks() -> dict[str, str]:
    """Large pieces of the case, by their names."""
    return {name: text.removesuffix("\n") for name, text in BLOCKS.items()}


@pytest.fixture
def with_train(loaded: Callable[..., LoadedCase]) -> Callable[..., LoadedCase]:
    """Load the case with another train."""
    return lambda block, **options: loaded((BLOCKS["<train>"], block), **options)


@pytest.fixture
def with_structure(loaded: Callable[..., LoadedCase]) -> Callable[..., LoadedCase]:
    """Load the case with another structure."""
    return lambda block, **options: loaded((BLOCKS["<structure>"], block), **options)
