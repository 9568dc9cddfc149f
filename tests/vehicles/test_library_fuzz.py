"""Mutilated files of vehicles: read, or refused with a message; never a crash."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.vehicles import library
from axlespan.vehicles.library.reading import read_entry

PIECES = [
    *("-1", "0", "nan", "1e400", "inf", "999999999999", "10 m", "[1 m, 2 m]", "true", "null", "é", "body", "wheel1"),
    *("[", "]", "{", "}", ":", "- ", "&a", "*a", "<<: *a", "'", '"', "\t", "|", "---", "!!x", "names", "positions"),
]  # fmt: skip


def mutilated(text, random):
    for _ in range(random.integers(1, 4)):
        at, size = random.integers(len(text)), random.integers(1, 13)
        if random.random() < 0.4:
            text = text[:at] + text[at + size :]
        else:
            text = text[:at] + PIECES[random.integers(len(PIECES))] + text[at + (size if at % 2 else 0) :]
    return text


@pytest.mark.parametrize("name", ["hs20-3d", "truck-2a3", "ice3-heavy", "car-7dof", "ice3"])
def test_it_reads_or_refuses(name):
    random, text, refused = np.random.default_rng(7), library.entry(name).text, 0
    for _ in range(60):
        try:
            entry = read_entry(mutilated(text, random), "file.yaml", name, library.entry)
            assert entry.model is not None or entry.groups
        except InputError as error:
            refused += 1
            assert str(error).startswith("file.yaml")
            assert error.rule
    assert refused > 20
