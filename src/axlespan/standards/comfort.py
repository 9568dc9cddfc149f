"""Ride comfort from accelerations of a car body: EN 12299, ISO 2631-1, Sperling.

Each takes a history sampled at equal steps, and gives None where the record is too short for the rule.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.standards.verdict import FROM_MEMORY
from axlespan.standards.weighting import WB, WK, Weighting

FloatArray = npt.NDArray[np.float64]

EN12299 = f"EN 12299:2009; {FROM_MEMORY}"
ISO2631 = f"ISO 2631-1:1997; {FROM_MEMORY}"
SPERLING = f"Sperling and Betzhold (1956), classes of GB/T 5599; {FROM_MEMORY}"

#: Length of a block [s], blocks of a mean comfort, and the shortest record for each.
BLOCK, BLOCKS = 5.0, 60

#: Upper ends of classes of the mean comfort N_MV, of the continuous comfort C_Cz [m/s^2], of the weighted rms of
#: ISO 2631-1 [m/s^2] (classes overlap there; the middle of the overlap is taken) and of Sperling's index.
MEAN_CLASSES = (
    (1.5, "very comfortable"),
    (2.5, "comfortable"),
    (3.5, "medium"),
    (4.5, "uncomfortable"),
    (np.inf, "very uncomfortable"),
)
CONTINUOUS_CLASSES = (
    (0.20, "very comfortable"),
    (0.30, "comfortable"),
    (0.40, "medium"),
    (np.inf, "less comfortable"),
)
ISO_CLASSES = (
    (0.315, "not uncomfortable"),
    (0.565, "a little uncomfortable"),
    (0.9, "fairly uncomfortable"),
    (1.425, "uncomfortable"),
    (2.25, "very uncomfortable"),
    (np.inf, "extremely uncomfortable"),
)
SPERLING_CLASSES = ((2.5, "excellent"), (2.75, "good"), (3.0, "acceptable"), (np.inf, "not acceptable"))


def in_class(value: float, classes: tuple[tuple[float, str], ...]) -> str:
    """The name of the class that a value falls into.

    Examples
    --------
    >>> in_class(2.6, SPERLING_CLASSES)
    'good'
    """
    return next((name for end, name in classes if value < end), classes[-1][1])


def block_rms(
    acceleration: FloatArray, time_step: float, weighting: Weighting = WB, *, length: float = BLOCK
) -> FloatArray:
    """Weighted rms (n_block,) [m/s^2] of consecutive whole blocks; none if the record is shorter than one."""
    n = round(length / time_step)
    count = len(acceleration) // n if n else 0
    if not count:
        return np.zeros(0)
    weighted = weighting.apply(np.asarray(acceleration, float), time_step)[: count * n]
    return np.asarray(np.sqrt((weighted.reshape(count, n) ** 2).mean(axis=1)))


def continuous_comfort(acceleration: FloatArray, time_step: float) -> float | None:
    """C_Cz [m/s^2]: the largest Wb-weighted rms of blocks of 5 s; None for shorter records."""
    blocks = block_rms(acceleration, time_step)
    return float(blocks.max()) if len(blocks) else None


def mean_comfort(vertical: FloatArray, time_step: float) -> float | None:
    """Vertical part of the mean comfort N_MV = 6 · a_ZP95^Wb [-]; None for records below 5 min.

    N_MV is six times the root of the sum of squares of the 95 % percentiles of 5 s rms of all three directions;
    a model without lateral and longitudinal motion has the vertical one.
    """
    blocks = block_rms(vertical, time_step)
    if len(blocks) < BLOCKS:
        return None
    return 6.0 * float(np.percentile(blocks, 95.0))


def weighted_rms(acceleration: FloatArray, time_step: float, weighting: Weighting = WK) -> float | None:
    """a_w [m/s^2] of ISO 2631-1 over the whole record; None below 5 s."""
    if len(acceleration) * time_step < BLOCK * (1.0 - 1e-9):
        return None
    weighted = weighting.apply(np.asarray(acceleration, float), time_step)
    return float(np.sqrt((weighted**2).mean()))


def sperling_factor(frequency: npt.ArrayLike) -> FloatArray:
    """F(f) of Sperling's ride index, vertical: 0.325 f² from 0.5 to 5.9 Hz, 400/f² to 20 Hz, then 1; zero below.

    Examples
    --------
    >>> sperling_factor([0.4, 1.0, 10.0, 25.0]).tolist()
    [0.0, 0.325, 4.0, 1.0]
    """
    f = np.asarray(frequency, dtype=float)
    safe = np.maximum(f, 0.1)
    return np.asarray(np.select([f < 0.5, f < 5.9, f <= 20.0], [0.0 * f, 0.325 * f**2, 400.0 / safe**2], 1.0))


def sperling_blocks(acceleration: FloatArray, time_step: float, *, length: float = BLOCK) -> FloatArray:
    """Sperling's ride index W (n_block,) [-] of consecutive whole blocks.

    W = (Σ W_i^10)^0.1 with W_i = 3.57 (A_i³ F(f_i) / f_i)^0.1 over the lines of the block's Fourier series,
    A_i their amplitudes [m/s^2]. As amplitudes are cubed, the index depends on the length of the blocks.
    """
    n = round(length / time_step)
    count = len(acceleration) // n if n else 0
    if not count:
        return np.zeros(0)
    blocks = np.asarray(acceleration, float)[: count * n].reshape(count, n)
    amplitude = 2.0 / n * np.abs(np.fft.rfft(blocks, axis=1))[:, 1:]
    frequency = np.fft.rfftfreq(n, time_step)[1:]
    return np.asarray((3.57**10 * (amplitude**3 * sperling_factor(frequency) / frequency).sum(axis=1)) ** 0.1)


def sperling(acceleration: FloatArray, time_step: float) -> float | None:
    """Sperling's ride index of the worst block of 5 s; None for shorter records."""
    blocks = sperling_blocks(acceleration, time_step)
    return float(blocks.max()) if len(blocks) else None
