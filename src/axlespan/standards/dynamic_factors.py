r"""Dynamic factors of EN 1991-2: φ' and φ'' of real trains (annex C), Φ2 and Φ3 of load model 71 (6.4.5.2).

.. math:: φ' = \frac{K}{1 - K + K^4}, \quad K = \frac{v}{2 L_Φ n_0}, \qquad
   φ'' = \frac{α}{100} \Big[56 e^{-(L_Φ/10)^2} + 50 \Big(\frac{L_Φ n_0}{80} - 1\Big) e^{-(L_Φ/20)^2}\Big] \ge 0

All numbers are from memory of EN 1991-2:2003; φ' agrees with a published example (0.016 at 10 km/h, 25 m, 3.554 Hz).
"""

from __future__ import annotations

import math

from axlespan.errors import InputError
from axlespan.standards.verdict import FROM_MEMORY

SOURCE = f"EN 1991-2:2003 6.4.5.2 and annex C; {FROM_MEMORY}"

# From this K on φ' is constant.
_LARGEST_K = 0.76
_LARGEST_PHI = 1.325
# Speed up to which track irregularities count in part only [m/s].
_SLOW = 22.0


def phi_dash(speed: float, determinant_length: float, first_frequency: float) -> float:
    """φ' [-]: added effect of a train on a perfect track.

    Parameters
    ----------
    speed : float
        [m/s].
    determinant_length : float
        L_Φ [m]; the span of a simple beam.
    first_frequency : float
        n0 [Hz], of bending under permanent load.

    Examples
    --------
    >>> round(phi_dash(10 / 3.6, 25.0, 3.554), 3)
    0.016
    """
    _require(speed=speed, determinant_length=determinant_length, first_frequency=first_frequency)
    k = speed / (2.0 * determinant_length * first_frequency)
    return _LARGEST_PHI if k >= _LARGEST_K else k / (1.0 - k + k**4)


def phi_double_dash(speed: float, determinant_length: float, first_frequency: float) -> float:
    """φ'' [-]: added effect of track irregularities and vehicle imperfections; arguments of :func:`phi_dash`."""
    _require(speed=speed, determinant_length=determinant_length, first_frequency=first_frequency)
    alpha = min(speed / _SLOW, 1.0)
    short = 56.0 * math.exp(-((determinant_length / 10.0) ** 2))
    high = determinant_length * first_frequency / 80.0 - 1.0
    return max(0.0, alpha / 100.0 * (short + 50.0 * high * math.exp(-((determinant_length / 20.0) ** 2))))


def phi2(determinant_length: float) -> float:
    """Φ2 [-] of load model 71, for carefully maintained track: 1.44/(√L_Φ - 0.2) + 0.82, from 1 to 1.67.

    Examples
    --------
    >>> round(phi2(20.0), 4), phi2(3.0), phi2(200.0)
    (1.1571, 1.67, 1.0)
    """
    return _factor(determinant_length, 1.44, 0.82, 1.67)


def phi3(determinant_length: float) -> float:
    """Φ3 [-] of load model 71, for track with standard maintenance: 2.16/(√L_Φ - 0.2) + 0.73, from 1 to 2."""
    return _factor(determinant_length, 2.16, 0.73, 2.0)


def continuous_determinant_length(spans: tuple[float, ...]) -> float:
    """L_Φ [m] of a beam over several spans: k times the mean span, but no less than the largest.

    k is 1.2, 1.3, 1.4 and 1.5 for 2, 3, 4 and from 5 spans on (EN 1991-2 table 6.2, case 5.2; from memory).
    """
    if not spans:
        raise InputError("must name at least one span", field="spans", value=spans)
    if len(spans) == 1:
        return spans[0]
    factor = min(1.0 + 0.1 * len(spans), 1.5)
    return max(factor * sum(spans) / len(spans), *spans)


def _factor(length: float, numerator: float, base: float, most: float) -> float:
    _require(determinant_length=length)
    root = math.sqrt(length) - 0.2
    return most if root <= 0.0 else min(max(numerator / root + base, 1.0), most)


def _require(**values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and (value > 0.0 or (name == "speed" and value == 0.0))):
            raise InputError("must be positive", field=name, value=value)
