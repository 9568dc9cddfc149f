"""Vehicles led along a given line: the second of the two separate systems of the iterative coupling."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.bodies import FleetBody
from axlespan.linalg.factor import Factor, factorize

FloatArray = npt.NDArray[np.float64]


class LedFleet:
    """The fleet with the motion of its contact points prescribed; it answers with the contact forces.

    With x the contact points and i all other d.o.f.: A_ii ü_i = b_i - A_ix ü_x, and the contact forces are what
    the rows of the contact points lack for balance.
    """

    def __init__(self, fleet: FleetBody) -> None:
        self._fleet = fleet
        effective = sp.csr_array(fleet.integrator.effective)
        x = fleet.fleet.dofs
        self._inner = np.setdiff1d(np.arange(effective.shape[0]), x)
        self._link = sp.csr_array(effective[self._inner][:, x])
        self._own = sp.csr_array(effective[x][:, x])
        self._back = sp.csr_array(effective[x][:, self._inner])
        self._factor: Factor | None = None
        if len(self._inner):
            self._factor = factorize(sp.csr_array(effective[self._inner][:, self._inner]))

    def begin(self) -> None:
        """Take the free response of the step: A times it is the right-hand side b."""
        free = self._fleet.stepper.acceleration
        self._right = np.asarray(self._fleet.integrator.effective @ free)
        self._free_wheels = self._fleet.at_wheels()
        self._free_x = free[self._fleet.fleet.dofs]

    def forces(self, line: FloatArray) -> FloatArray:
        """Contact forces (n_coupled,) [N] of wheels at heights (n_coupled,) [m]."""
        integrator, x = self._fleet.integrator, self._fleet.fleet.dofs
        a_x = self._free_x + (line - self._free_wheels) / integrator.u_from_a
        missing = self._own @ a_x - self._right[x]
        if self._factor is not None:
            a_i = self._factor.solve(np.ascontiguousarray(self._right[self._inner] - self._link @ a_x))
            missing += self._back @ a_i
        return np.asarray(missing / integrator.weight_c)
