"""The alpha method of Hilber, Hughes and Taylor: its parameters, N12 (1), (16), (17) and (24)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from axlespan.errors import InputError


@dataclass(frozen=True)
class Alpha:
    """Parameters of the alpha method; α = 0 is Newmark's method.

    Parameters
    ----------
    alpha : float
        -1/3 <= α <= 0 [-]; negative values damp what the time step cannot resolve.
    beta, gamma : float, optional
        Newmark's parameters [-]; β = (1 - α)²/4 and γ = ½ - α when left out, which is second order
        and unconditionally stable.

    Raises
    ------
    InputError
        If the parameters are out of range or the method would not be unconditionally stable.

    Examples
    --------
    >>> Alpha(-0.1)
    Alpha(alpha=-0.1, beta=0.30250000000000005, gamma=0.6)
    """

    alpha: float = 0.0
    beta: float | None = None
    gamma: float | None = None

    def __post_init__(self) -> None:
        for name in ("alpha", "beta", "gamma"):
            value = getattr(self, name)
            if value is not None and not math.isfinite(value):
                raise InputError("must be a finite number", field=name, value=value)
        if not -1.0 / 3.0 - 1e-12 <= self.alpha <= 0.0:
            raise InputError(
                "must lie between -1/3 and 0",
                field="alpha",
                value=self.alpha,
                fix="0 is Newmark's method; -0.1 damps numerical noise",
            )
        beta = (1.0 - self.alpha) ** 2 / 4.0 if self.beta is None else float(self.beta)
        gamma = 0.5 - self.alpha if self.gamma is None else float(self.gamma)
        object.__setattr__(self, "beta", beta)
        object.__setattr__(self, "gamma", gamma)
        self._check_stability(beta, gamma)

    def _check_stability(self, beta: float, gamma: float) -> None:
        # Hughes (1987), section 9.3: unconditional stability of the family for every mode.
        if gamma < 0.5 - self.alpha - 1e-9 and self.alpha < 0.0:
            raise InputError(
                f"must be at least 1/2 - alpha = {0.5 - self.alpha:g}, or the method is unstable",
                field="gamma",
                value=gamma,
                fix="Leave gamma out: it follows alpha",
            )
        if gamma < 0.5 - 1e-9:
            raise InputError(
                "must be at least 1/2, or the method is unstable",
                field="gamma",
                value=gamma,
                fix="Use 0.5, or leave it out",
            )
        least = gamma / 2.0
        if beta < least - 1e-9:
            raise InputError(
                f"must be at least {least:g} for this alpha and gamma, or the method is only conditionally stable",
                field="beta",
                value=beta,
                fix="Use 0.25 with gamma = 0.5, or leave both out",
            )

    @property
    def is_second_order(self) -> bool:
        """Whether the error falls with the square of the time step: γ = ½ - α."""
        return abs(self._gamma - (0.5 - self.alpha)) < 1e-9

    @property
    def _beta(self) -> float:
        assert self.beta is not None
        return self.beta

    @property
    def _gamma(self) -> float:
        assert self.gamma is not None
        return self.gamma

    def coefficients(self, time_step: float) -> tuple[float, float, float, float, float, float]:
        """A0 to A5 of N12 (24) for a time step [s]."""
        beta, gamma, dt = self._beta, self._gamma, time_step
        return (
            1.0 / (beta * dt**2),
            gamma / (beta * dt),
            1.0 / (beta * dt),
            1.0 / (2.0 * beta) - 1.0,
            gamma / beta - 1.0,
            dt * (gamma / (2.0 * beta) - 1.0),
        )
