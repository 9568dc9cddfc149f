"""The high-speed load models HSLM-A and HSLM-B of EN 1991-2, 6.4.6.1.1."""

from __future__ import annotations

from functools import partial

import numpy as np

from axlespan.errors import InputError
from axlespan.model.materials import require_positive
from axlespan.vehicles.load_trains.load_train import VERIFIED, LoadTrain
from axlespan.vehicles.simple import axle_loads
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import Vehicle

#: HSLM-A1 to A10: intermediate coaches N, their length D [m], distance of bogie axles d [m], force P [kN].
#: EN 1991-2:2003, table 6.3; unchanged in EN 1991-2:2024, table 8.4.
TABLE = (
    (18, 18.0, 2.0, 170.0),
    (17, 19.0, 3.5, 200.0),
    (16, 20.0, 2.0, 180.0),
    (15, 21.0, 3.0, 190.0),
    (14, 22.0, 2.0, 170.0),
    (13, 23.0, 2.0, 180.0),
    (13, 24.0, 2.0, 190.0),
    (12, 25.0, 2.5, 190.0),
    (11, 26.0, 2.0, 210.0),
    (11, 27.0, 2.0, 210.0),
)

# Figure 6.12: axles of a power car, its distance to the end coach, the end coach's outer bogie [m].
_POWER_CAR, _GAP = (0.0, 3.0, 14.0, 17.0), 3.525
_OUTER = _POWER_CAR[-1] + _GAP
_COACHES = _POWER_CAR[-1] + 0.5 * _GAP  # where the coach module begins

#: Force of HSLM-B [N].
FORCE_B = 170e3


def hslm_a(number: int) -> Train:
    """Load train HSLM-A1 to A10, as moving forces.

    Parameters
    ----------
    number : int
        1 to 10.

    Raises
    ------
    InputError
        If there is no such train.

    Notes
    -----
    Power car, end coach, N intermediate coaches on shared bogies, end coach, power car; valid for the interoperable
    high-speed lines of EN 1991-2, annex E.

    Examples
    --------
    >>> train = hslm_a(1)
    >>> len(train.offsets), train.wheelbase
    (50, 397.525)
    """
    return Train.of(_hslm_a(number))


def hslm_b(forces: int, spacing: float, load: float = FORCE_B) -> Train:
    """Load train HSLM-B: equal forces at equal distances, for short simple spans.

    Parameters
    ----------
    forces : int
        Number N of forces, from EN 1991-2, figure 6.14, for the span.
    spacing : float
        Distance d [m], from the same figure.
    load : float
        Each force [N].

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    The figure is not part of axlespan: N and d must be read from the standard.
    """
    if isinstance(forces, bool) or int(forces) != forces or forces < 1:
        raise InputError("must be a whole number of at least 1", field="forces", value=forces)
    require_positive(spacing, "spacing")
    positions = [round(i * spacing, 9) for i in range(int(forces))]
    return Train.of(axle_loads(loads=load, positions=positions, name="hslm-b"))


def _hslm_a(number: int) -> Vehicle:
    if isinstance(number, bool) or number not in range(1, len(TABLE) + 1):
        raise InputError(f"must be 1 to {len(TABLE)}", field="number", value=number)
    coaches, length, bogie, load = TABLE[number - 1]
    total = _COACHES + (coaches + 2) * length + _COACHES
    front = np.array([*_POWER_CAR, _OUTER, _OUTER + bogie])
    shared = _COACHES + length * np.arange(1, coaches + 2)
    inner = (shared[:, None] + 0.5 * bogie * np.array([-1.0, 1.0])).ravel()
    positions = np.round(np.concatenate([front, inner, total - front[::-1]]), 6)
    return axle_loads(loads=1e3 * load, positions=positions.tolist(), name=f"hslm-a{number}")


def load_trains() -> list[LoadTrain]:
    """HSLM-A1 to A10."""
    source = "EN 1991-2:2003, table 6.3 and figure 6.12; EN 1991-2:2024, table 8.4"
    return [
        LoadTrain(
            f"hslm-a{i + 1}",
            f"HSLM-A{i + 1}: {n} coaches of {length:g} m, {load:g} kN",
            partial(_hslm_a, i + 1),
            source,
            VERIFIED,
            "three public listings agree",
        )
        for i, (n, length, _, load) in enumerate(TABLE)
    ]
