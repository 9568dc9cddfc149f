"""The cases of the book in which something crosses a simple span."""

import pytest

from axlespan.reference import midspan_amplification
from axlespan.verification import crossings, forces, resonance, rides, trains, vehicles, wheels, yang_yau
from axlespan.verification.forces import _AMPLIFICATION

CASES = [
    *crossings.CASES,
    *yang_yau.CASES,
    *forces.CASES,
    *trains.CASES,
    *resonance.CASES,
    *wheels.CASES,
    *vehicles.CASES,
    *rides.CASES,
]


@pytest.mark.parametrize("case", [c for c in CASES if not c.long], ids=lambda c: c.name)
def test_every_row_is_within_its_tolerance(case, check_case):
    rows = check_case(case)
    assert len(rows) >= 2


@pytest.mark.parametrize("alpha", [0.1, 0.4, 0.617, 0.8, 1.0])
def test_printed_amplifications_are_those_of_the_closed_form(alpha):
    # half a unit of the last digit printed
    exact = midspan_amplification(alpha, modes=51, after_exit=False)
    assert _AMPLIFICATION[alpha] == pytest.approx(exact, abs=6e-6)
