"""Load model 71 on an influence line, and trains standing on one.

LM71 (EN 1991-2 6.3.2, from memory): four axles of 250 kN, 1.6 m apart, and 80 kN/m without limit from 0.8 m outside
of them; what relieves is left out. SW/0 (6.3.3): 133 kN/m over twice 15 m with a gap of 5.3 m.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.standards.verdict import FROM_MEMORY

FloatArray = npt.NDArray[np.float64]

SOURCE = f"EN 1991-2:2003 6.3.2 and 6.3.3; {FROM_MEMORY}"

AXLE, AXLES = 250e3, (-2.4, -0.8, 0.8, 2.4)  # [N], [m] from the middle of the group
UNIFORM, GAP = 80e3, 3.2  # [N/m], and where it begins, from the middle of the group [m]
SW0, SW0_LENGTH, SW0_GAP = 133e3, 15.0, 5.3


@dataclass(frozen=True, eq=False)
class InfluenceLine:
    """An effect of a downward unit force, by where it stands; linear between positions, zero outside."""

    positions: FloatArray  # (n,) increasing [m]
    ordinates: FloatArray  # (n,) effect per N

    def __post_init__(self) -> None:
        if len(self.positions) < 2 or np.any(np.diff(self.positions) <= 0.0):
            raise InputError("must have positions that increase", field="influence line")

    def at(self, position: FloatArray) -> FloatArray:
        """The effect of a unit force at positions [m]."""
        return np.asarray(np.interp(position, self.positions, self.ordinates, left=0.0, right=0.0))

    def adverse(self, sign: float) -> InfluenceLine:
        """Only what acts in a direction, ±1, counted positive."""
        return InfluenceLine(self.positions, np.maximum(sign * self.ordinates, 0.0))

    def integral(self, begin: FloatArray, end: FloatArray) -> FloatArray:
        """∫ of the ordinates from positions to others, between the line's ends."""
        steps = 0.5 * (self.ordinates[1:] + self.ordinates[:-1]) * np.diff(self.positions)
        total = np.concatenate([[0.0], np.cumsum(steps)])

        def primitive(x: FloatArray) -> FloatArray:
            inside = np.clip(x, self.positions[0], self.positions[-1])
            i = np.clip(np.searchsorted(self.positions, inside, side="right") - 1, 0, len(self.positions) - 2)
            way = inside - self.positions[i]
            return np.asarray(total[i] + 0.5 * way * (self.ordinates[i] + self.at(inside)))

        return primitive(np.asarray(end, float)) - primitive(np.asarray(begin, float))


def lm71_effect(line: InfluenceLine, *, sign: float = 1.0, alpha: float = 1.0, step: float = 0.05) -> float:
    """Largest effect of LM71 in a direction (±1), over all places of its axles; without dynamic factor.

    Parameters
    ----------
    line : InfluenceLine
    alpha : float
        Classification factor α of the line [-].
    step : float
        Of the places that are tried [m].

    Examples
    --------
    The moment at the middle of a span of 20 m: 4200 kNm from the axles, one of the inner two over it, and
    80 (7.6² + 6²) / 4 = 1875.2 kNm from the uniform load.

    >>> x = np.linspace(0.0, 20.0, 2001)
    >>> moment = lm71_effect(InfluenceLine(x, 0.5 * np.minimum(x, 20.0 - x)))
    >>> round(moment / 1e3, 1)
    6075.2
    """
    adverse = line.adverse(sign)
    low, high = line.positions[0], line.positions[-1]
    count = int(np.ceil((high - low + 2.0 * GAP) / step)) + 1
    middle = np.linspace(low - GAP, high + GAP, count)
    marked = np.array([low, line.positions[int(np.argmax(adverse.ordinates))], high])
    over = (marked[:, None] - np.array(AXLES)).ravel()  # an axle over an end or over the peak
    middle = np.unique(np.concatenate([middle, over]))
    effect = AXLE * sum(adverse.at(middle + offset) for offset in AXLES)
    far = np.full_like(middle, high + 1.0)
    near = np.full_like(middle, low - 1.0)
    effect = effect + UNIFORM * (adverse.integral(near, middle - GAP) + adverse.integral(middle + GAP, far))
    return alpha * float(np.max(effect))


def sw0_effect(line: InfluenceLine, *, sign: float = 1.0, alpha: float = 1.0, step: float = 0.05) -> float:
    """Largest effect of SW/0 in a direction, for continuous beams; arguments of :func:`lm71_effect`."""
    adverse = line.adverse(sign)
    reach = SW0_LENGTH + 0.5 * SW0_GAP
    low, high = line.positions[0] - reach, line.positions[-1] + reach
    middle = np.linspace(low, high, int(np.ceil((high - low) / step)) + 1)
    halves = adverse.integral(middle - reach, middle - 0.5 * SW0_GAP)
    halves = halves + adverse.integral(middle + 0.5 * SW0_GAP, middle + reach)
    return alpha * SW0 * float(np.max(halves))


def train_effect(
    line: InfluenceLine, loads: FloatArray, behind: FloatArray, *, sign: float = 1.0, step: float = 0.1
) -> float:
    """Largest effect of a standing train in a direction, over all its places.

    Parameters
    ----------
    loads : array (n_wheel,)
        Static wheel forces [N], downward positive.
    behind : array (n_wheel,)
        Distance of each wheel behind the first [m].
    """
    low, high = line.positions[0], line.positions[-1] + float(np.max(behind))
    heads = np.linspace(low, high, int(np.ceil((high - low) / step)) + 1)
    total = np.zeros_like(heads)
    for load, distance in zip(loads, behind, strict=True):
        total += load * line.at(heads - distance)
    return float(np.max(sign * total))
