"""Damping of a structure: Rayleigh, or by modes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from axlespan.errors import InputError
from axlespan.model.materials import require_positive


@dataclass(frozen=True)
class Rayleigh:
    """C = α M + β K."""

    alpha: float = 0.0  # [1/s]
    beta: float = 0.0  # [s]

    def __post_init__(self) -> None:
        require_positive(self.alpha, "damping.alpha", zero=True)
        require_positive(self.beta, "damping.beta", zero=True)

    @classmethod
    def from_ratio(cls, ratio: float, frequencies: tuple[float, float]) -> Rayleigh:
        """Give the same damping ratio [-] at two frequencies [Hz].

        Raises
        ------
        InputError
            If the frequencies are not two different positive ones, or the ratio is negative.
        """
        require_positive(ratio, "damping.ratio", zero=True)
        if len(frequencies) != 2:
            raise InputError("must be two frequencies", field="damping.frequencies", value=tuple(frequencies))
        low, high = (2.0 * math.pi * require_positive(f, "damping.frequencies") for f in frequencies)
        if low == high:
            raise InputError(
                "must be two different frequencies", field="damping.frequencies", value=tuple(frequencies)
            )
        return cls(alpha=2.0 * ratio * low * high / (low + high), beta=2.0 * ratio / (low + high))


@dataclass(frozen=True)
class Modal:
    """The same damping ratio for the lowest modes; the modes above them are undamped.

    By default every mode of a small model (up to 300 d.o.f.), the lowest 40 of a larger one.
    """

    ratio: float  # [-]
    modes: int | None = None

    def __post_init__(self) -> None:
        require_positive(self.ratio, "damping.ratio", zero=True)
        if self.ratio >= 1.0:
            raise InputError("must be below 1", field="damping.ratio", value=self.ratio, fix="1 % is 0.01")
        if self.modes is not None and self.modes < 1:
            raise InputError("must be at least 1", field="damping.modes", value=self.modes)


Damping = Rayleigh | Modal
