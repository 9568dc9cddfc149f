"""A rail on sleepers at rest, element by element."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from axlespan.errors import InputError

from ._inputs import FloatArray, require_positive


@dataclass(frozen=True)
class SleeperTrack:
    """A rail on pads, sleepers, ballast blocks with shear springs between them, and ground.

    Every support is ``spacing`` from the next, the first one half of it from the free end of the rail: theory, (R37).
    """

    bending_stiffness: float  # of the rails [N m2]
    spacing: float  # [m]
    pad: float  # [N/m] a support
    ballast: float  # [N/m]
    subgrade: float  # [N/m]
    shear: float = 0.0  # between neighboring ballast blocks [N/m]
    supports: int = 100

    def __post_init__(self) -> None:
        for field in ("bending_stiffness", "spacing", "pad", "ballast", "subgrade"):
            require_positive(field, getattr(self, field))
        if self.supports < 3:
            raise InputError("must be three at least", field="supports", value=self.supports)

    def deflection(self, force: float, at: int) -> float:
        """Displacement of the rail under a downward force at the node ``at``, half a spacing apart from 0 [m].

        Odd nodes stand over supports, even ones between them.
        """
        load = np.zeros(len(self._stiffness))
        load[2 * at] = -force
        return float(np.linalg.solve(self._stiffness, load)[2 * at])

    @property
    def _stiffness(self) -> FloatArray:
        nodes, n = 2 * self.supports + 1, self.supports
        rail, size = 2 * nodes, 0.5 * self.spacing
        k = np.zeros((rail + 2 * n, rail + 2 * n))
        element = np.array(
            [
                [12.0, 6.0 * size, -12.0, 6.0 * size],
                [6.0 * size, 4.0 * size**2, -6.0 * size, 2.0 * size**2],
                [-12.0, -6.0 * size, 12.0, -6.0 * size],
                [6.0 * size, 2.0 * size**2, -6.0 * size, 4.0 * size**2],
            ]
        )
        for first in range(0, rail - 2, 2):
            k[first : first + 4, first : first + 4] += self.bending_stiffness / size**3 * element

        def spring(stiffness: float, i: int, j: int | None = None) -> None:
            k[i, i] += stiffness
            if j is not None:
                k[j, j] += stiffness
                k[i, j] -= stiffness
                k[j, i] -= stiffness

        for s in range(n):
            head, sleeper, block = 2 * (2 * s + 1), rail + s, rail + n + s
            spring(self.pad, head, sleeper)
            spring(self.ballast, sleeper, block)
            spring(self.subgrade, block)
            if s + 1 < n:
                spring(self.shear, block, block + 1)
        return k
