"""Is a dynamic analysis needed, with which trains and at which speeds (EN 1991-2 6.4.4 and 6.4.6)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.standards.bridge_values import frequency_limits
from axlespan.standards.verdict import FROM_MEMORY

FloatArray = npt.NDArray[np.float64]

# A train of fewer axles has no regular distance to speak of.
_FEWEST_AXLES = 12

FLOW_CHART = f"EN 1991-2:2003 figure 6.9; {FROM_MEMORY}"
SPEEDS = f"EN 1991-2:2003 6.4.6.2; {FROM_MEMORY}"
TRAINS = f"EN 1991-2:2003 table 6.4; {FROM_MEMORY}"

#: Lowest speed that is analyzed [m/s], and the highest over the line speed [-].
LOWEST_SPEED, OVERSPEED = 40.0, 1.2


@dataclass(frozen=True)
class Need:
    """Whether a dynamic analysis is needed; None where the chart asks for what is not known."""

    required: bool | None
    path: tuple[str, ...]  # the questions and answers that lead there

    @property
    def words(self) -> str:
        """The answer in words."""
        known = {True: "required", False: "not required", None: "not decided"}
        return known[self.required]


def need_of_dynamic_analysis(
    *,
    line_speed: float,
    span: float,
    continuous: bool,
    simple: bool,
    first_frequency: float,
    torsional_frequency: float | None = None,
) -> Need:
    """Follow the flow chart of EN 1991-2 figure 6.9.

    Parameters
    ----------
    line_speed : float
        Maximum line speed at the site [m/s].
    span : float
        L [m].
    continuous : bool
        Whether it is a continuous bridge.
    simple : bool
        Whether it behaves like a simple beam or plate: line supports, little skew, one bending mode rules.
    first_frequency, torsional_frequency : float
        n0 and n_T [Hz]; n_T None where it is not known.
    """
    slow = line_speed <= 200.0 / 3.6 * (1.0 + 1e-12)
    path = [f"line speed {'up to' if slow else 'above'} 200 km/h"]
    if slow and continuous:
        return Need(False, (*path, "continuous bridge"))
    if not slow and not simple:
        return Need(True, (*path, "no simple structure"))
    path += (
        ["not continuous"]
        if slow
        else ["simple structure", f"span {'from' if span >= 40.0 else 'below'} 40 m"]
    )
    if slow or span >= 40.0:
        words, inside = _by_frequency(span, first_frequency)
        path.append(words)
        if inside:
            return Need(False, tuple(path))
    if torsional_frequency is None:
        return Need(None, (*path, "torsional frequency not known"))
    if torsional_frequency <= 1.2 * first_frequency:
        return Need(True, (*path, "n_T is not above 1.2 n0"))
    return Need(None, (*path, "n_T above 1.2 n0", "tables F.1 and F.2 of v/n0 are not available here"))


def _by_frequency(span: float, first_frequency: float) -> tuple[str, bool]:
    """What is to be said of n0 and its limits, and whether it is within them."""
    limits = frequency_limits(span)
    if limits is None:
        return f"no limits of n0 for a span of {span:g} m", False
    inside = limits[0] <= first_frequency <= limits[1]
    place = "within" if inside else "outside"
    return f"n0 = {first_frequency:.3g} Hz {place} {limits[0]:.3g} to {limits[1]:.3g} Hz", inside


def load_model(spans: Sequence[float], *, simple: bool) -> str:
    """The high-speed load model to use: HSLM-A, or HSLM-B for simple spans below 7 m.

    Examples
    --------
    >>> load_model([6.0], simple=True), load_model([6.0, 6.0], simple=False)
    ('HSLM-B', 'HSLM-A')
    """
    return "HSLM-B" if simple and max(spans) < 7.0 else "HSLM-A"


def resonance_speeds(
    frequencies: Sequence[float],
    distance: float,
    *,
    orders: int = 4,
    lowest: float = 0.0,
    highest: float = float("inf"),
) -> list[tuple[float, int, int]]:
    """Critical speeds v = f_j d / i within bounds, as (speed [m/s], mode j, order i), ascending.

    Parameters
    ----------
    frequencies : sequence of float
        f_j [Hz].
    distance : float
        d [m], regular distance of axle groups: the length of a coach.

    Examples
    --------
    >>> resonance_speeds([4.0], 18.0, orders=2)
    [(36.0, 1, 2), (72.0, 1, 1)]
    """
    if not distance > 0.0:
        raise InputError("must be positive", field="distance", value=distance)
    found = [
        (frequency * distance / order, mode, order)
        for mode, frequency in enumerate(frequencies, 1)
        for order in range(1, orders + 1)
    ]
    return sorted(item for item in found if lowest <= item[0] <= highest)


def regular_distance(loads: FloatArray, behind: FloatArray) -> float | None:
    r"""The distance d [m] at which a train's axles add up most, from 10 to 40 m; None if no distance stands out.

    It is where :math:`|\sum_k P_k e^{2πi x_k / d}| / \sum_k P_k` is largest, if that is at least one half.

    Parameters
    ----------
    loads, behind : array (n_wheel,)
        Static forces [N] and distances behind the first wheel [m].
    """
    if len(loads) < _FEWEST_AXLES:
        return None
    distances = np.arange(10.0, 40.0, 0.01)
    turns = np.exp(2j * np.pi * np.asarray(behind) / distances[:, None])
    together = np.abs(turns @ loads) / float(np.sum(loads))
    best = int(np.argmax(together))
    return float(distances[best]) if together[best] >= 0.5 else None


def speeds_to_analyze(
    line_speed: float, *, step: float = 10.0 / 3.6, critical: Sequence[float] = ()
) -> FloatArray:
    """Speeds [m/s] from 40 m/s to 1.2 times the line speed, closer by a quarter of a step around critical ones.

    Parameters
    ----------
    line_speed : float
        [m/s].
    step : float
        [m/s].
    critical : sequence of float
        Such as those of :func:`resonance_speeds` [m/s]; each is among the speeds, with two to each side.
    """
    if not line_speed > 0.0 or not step > 0.0:
        raise InputError("must be positive", field="line_speed", value=line_speed)
    highest = OVERSPEED * line_speed
    lowest = min(LOWEST_SPEED, highest)
    count = max(1, int(np.ceil((highest - lowest) / step - 1e-9)))
    speeds = [np.linspace(lowest, highest, count + 1)]
    speeds += [np.asarray(speed) + 0.25 * step * np.arange(-2, 3) for speed in critical]
    every = np.unique(np.concatenate(speeds).round(9))
    return np.asarray(every[(every >= lowest) & (every <= highest * (1.0 + 1e-12))])
