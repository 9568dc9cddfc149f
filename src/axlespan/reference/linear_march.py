"""Linear equations of motion whose matrices depend on time, by Gauss collocation with dense matrices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ._inputs import FloatArray
from .collocation import GaussRule

#: Times (stage,) to M, C, K, each (stage, n, n), and the load (stage, n).
Equations = Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray, FloatArray]]


@dataclass(frozen=True)
class LinearMarch:
    """``M(t) a + C(t) v + K(t) x = f(t)``, step by step: theory, (R35)."""

    equations: Equations
    rule: GaussRule

    def advance(self, x: FloatArray, v: FloatArray, start: FloatArray, step: float) -> list[FloatArray]:
        """Take equal steps [s] that begin at ``start`` (step,) one after another.

        Returns
        -------
        list of numpy.ndarray
            Displacement and velocity, (2, n), after each step.
        """
        stages, n = self.rule.nodes.size, x.size
        once = step * self.rule.matrix
        twice = once @ once
        times = (start[:, np.newaxis] + step * self.rule.nodes).ravel()
        mass, damping, stiffness, load = self.equations(times)
        shape = (start.size, stages, n)
        c = damping.reshape(*shape, n)
        k = stiffness.reshape(*shape, n)
        # unknown: the accelerations of all stages of a step
        system = np.einsum("ij,tiab->tiajb", once, c) + np.einsum("ij,tiab->tiajb", twice, k)
        own = np.arange(stages)
        system[:, own, :, own] += mass.reshape(*shape, n).transpose(1, 0, 2, 3)
        inverse = np.linalg.inv(system.reshape(start.size, stages * n, stages * n))
        f, reach = load.reshape(shape), step * self.rule.nodes
        weights, double = step * self.rule.weights, step**2 * self.rule.double_weights
        states = []
        for i in range(start.size):
            carried = x + reach[:, np.newaxis] * v
            rest = f[i] - np.matmul(k[i], carried[..., np.newaxis])[..., 0] - c[i] @ v
            a = (inverse[i] @ rest.ravel()).reshape(stages, n)
            x, v = x + step * v + double @ a, v + weights @ a
            states.append(np.stack((x, v)))
        return states
