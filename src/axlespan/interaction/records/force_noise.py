r"""How clean contact forces are: what of them alternates from step to step.

A constraint in discrete time can make multipliers oscillate with the time step while displacements look smooth
(Fedorova and Sivaselvan, arXiv 2402.08049). The fourth difference

.. math:: n_k = \tfrac{1}{16} (X_{k-2} - 4 X_{k-1} + 6 X_k - 4 X_{k+1} + X_{k+2})

passes such an alternation in full and lets through sin⁴(ω Δt / 2) of an oscillation of the circular frequency ω: 0.06 %
with 20 steps per period. The indicator is the largest root mean square of n over a window of 32 steps, over the
static force of the wheel.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.compiled import Loop, compiled

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_WEIGHTS = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) / 16.0
_WINDOW = 32


@cache
def _compiled() -> Loop | None:
    return compiled(_follow)


def _follow(series: Any, squares: Any, before: int, weights: Any, worst: Any) -> None:
    """Fill in the squares of the noise behind those of before, and the largest root of their mean over the window."""
    for j in range(series.shape[1]):
        largest, total = worst[j] ** 2 * _WINDOW, 0.0
        for i in range(squares.shape[0]):
            if i >= before:
                k = i - before
                noise = 0.0
                for w in range(5):
                    noise += weights[w] * series[k + w, j]
                squares[i, j] = noise * noise
            total += squares[i, j]
            if i >= _WINDOW:
                total -= squares[i - _WINDOW, j]
            if i >= _WINDOW - 1 and total > largest:
                largest = total
        worst[j] = (max(largest, 0.0) / _WINDOW) ** 0.5


class NoiseMonitor:
    """Follows the contact forces of all wheels with d.o.f. over all steps.

    Parameters
    ----------
    static : array (n_contact,)
        Static forces [N].
    coupled : array (n_coupled,)
        Contacts that are no moving forces.
    """

    def __init__(self, static: FloatArray, coupled: IntArray) -> None:
        self._coupled = coupled
        size = np.abs(static[coupled])
        self._scale = np.where(size > 0.0, size, np.inf)  # without gravity there is nothing to relate to
        self._last = np.zeros((0, len(coupled)))
        self._squares = np.zeros((0, len(coupled)))
        self._largest = np.zeros(len(coupled))  # root mean squares [N]

    def look(self, forces: FloatArray) -> None:
        """Look at consecutive steps: forces (n_step, n_contact) [N]."""
        if not len(self._coupled):
            return
        series = np.concatenate([self._last, forces[:, self._coupled]])
        self._last = series[-4:]
        if len(series) < 5:
            return
        if (loop := _compiled()) is not None:
            before = len(self._squares)
            squares = np.concatenate([self._squares, np.empty((len(series) - 4, series.shape[1]))])
            loop(series, squares, before, _WEIGHTS, self._largest)
            self._squares = squares[-(_WINDOW - 1) :]
            return
        noise = sum(w * series[i : len(series) - 4 + i] for i, w in enumerate(_WEIGHTS))
        squares = np.concatenate([self._squares, noise**2])
        self._squares = squares[-(_WINDOW - 1) :]
        if len(squares) < _WINDOW:
            return
        sums = np.cumsum(np.concatenate([np.zeros((1, squares.shape[1])), squares]), axis=0)
        mean = (sums[_WINDOW:] - sums[:-_WINDOW]).max(axis=0) / _WINDOW
        self._largest = np.maximum(self._largest, np.sqrt(np.maximum(mean, 0.0)))

    @property
    def worst(self) -> FloatArray:
        """Largest share (n_coupled,) of the static force [-]."""
        return self._largest / self._scale

    @property
    def largest(self) -> float:
        """Of all wheels."""
        return float(self.worst.max(initial=0.0))
