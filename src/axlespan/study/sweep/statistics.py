"""Distributions of results of random studies, with what is known of the error of each estimate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

QUANTILES: Final = (0.05, 0.5, 0.95, 0.99)


@dataclass(frozen=True, eq=False)
class Distribution:
    """A sample of a quantity."""

    values: FloatArray  # (n,) ascending

    @classmethod
    def of(cls, values: FloatArray) -> Distribution:
        """Of the finite values."""
        return cls(np.sort(values[np.isfinite(values)]))

    @property
    def mean(self) -> float:
        """Mean."""
        return float(self.values.mean())

    @property
    def std(self) -> float:
        """Standard deviation of the population."""
        return float(self.values.std(ddof=1)) if len(self.values) > 1 else 0.0

    @property
    def standard_error(self) -> float:
        """Standard error of the mean of independent samples; smaller ones belong to stratified samples."""
        return self.std / float(np.sqrt(max(len(self.values), 1)))

    def exceedance(self, level: float) -> tuple[float, float]:
        """Share of the population above a level, and the standard error of it."""
        n = len(self.values)
        share = float((self.values > level).sum()) / n
        return share, float(np.sqrt(share * (1.0 - share) / n))

    def quantile(self, share: float) -> float:
        """Value that a share of the population does not exceed."""
        return float(np.quantile(self.values, share))

    def interval(self, share: float, confidence: float = 0.95) -> tuple[float, float]:
        """Confidence interval of a quantile between two values of the sample, whatever the distribution.

        So many values lie below the quantile as a binomial variable says; where the sample is too small, the interval
        ends at its extremes and holds less than the confidence.
        """
        from scipy.stats import binom

        n, tail = len(self.values), 0.5 * (1.0 - confidence)
        low = int(binom.ppf(tail, n, share)) - 1
        high = int(binom.ppf(1.0 - tail, n, share))
        return float(self.values[max(low, 0)]), float(self.values[min(high, n - 1)])


def convergence(values: FloatArray, points: int = 50) -> tuple[npt.NDArray[np.int64], FloatArray, FloatArray]:
    """Mean of the first n values and its standard error, for growing n.

    Returns
    -------
    counts, means, errors : array (n_point,)
    """
    finite = values[np.isfinite(values)]
    counts = np.unique(np.geomspace(2, max(2, len(finite)), points).round().astype(np.int64))
    counts = counts[counts <= len(finite)]
    sums, squares = (
        np.cumsum(finite),
        np.cumsum((finite - finite.mean()) ** 2) if len(finite) else np.zeros(0),
    )
    means = sums[counts - 1] / counts
    shifted = means - (finite.mean() if len(finite) else 0.0)
    variance = np.maximum(squares[counts - 1] - counts * shifted**2, 0.0) / (counts - 1)
    return counts, means, np.sqrt(variance / counts)
