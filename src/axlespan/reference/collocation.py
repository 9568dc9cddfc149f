"""Gauss collocation of many oscillators at once: stage values from the state and from stage loads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ._inputs import FloatArray, require_count


@dataclass(frozen=True)
class GaussRule:
    """Nodes, weights and integration matrix of the Gauss method with s stages, of order 2 s.

    Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.3: A-stable, and it neither feeds nor
    damps an oscillator, however large frequency times step.
    """

    nodes: FloatArray  # c (stage,)
    weights: FloatArray  # b (stage,)
    matrix: FloatArray  # A (stage, stage)

    @classmethod
    def with_stages(cls, stages: int) -> GaussRule:
        """Return the rule with that number of stages."""
        require_count("stages", stages)
        roots, weights = np.polynomial.legendre.leggauss(stages)
        nodes = 0.5 * (roots + 1.0)
        powers = np.vander(nodes, stages, increasing=True)
        integrals = nodes[:, np.newaxis] * powers / np.arange(1, stages + 1)
        return cls(nodes, 0.5 * weights, integrals @ np.linalg.inv(powers))

    @property
    def double_weights(self) -> FloatArray:
        """Weights of the stage accelerations in the new displacement, ``b A`` (stage,)."""
        return self.weights @ self.matrix


@dataclass(frozen=True)
class OscillatorStages:
    """Stage values of ``a + damping v + stiffness u = f`` over one step, for n oscillators.

    The axis of three holds displacement, velocity and acceleration.
    """

    from_displacement: FloatArray  # (stage, 3, n)
    from_velocity: FloatArray  # (stage, 3, n)
    from_load: FloatArray  # (stage, stage, 3, n): stage of the value, stage of the load

    @classmethod
    def over(
        cls, step: float, rule: GaussRule, damping: FloatArray, stiffness: FloatArray
    ) -> OscillatorStages:
        """Return the stage operators for the step length ``step``: theory, (R15)."""
        once = step * rule.matrix
        twice = once @ once
        reach = step * rule.nodes
        d, k = damping[:, np.newaxis], stiffness[:, np.newaxis]
        inverse = np.linalg.inv(
            np.eye(reach.size) + d[..., np.newaxis] * once + k[..., np.newaxis] * twice
        )  # (n, s, s): stage accelerations from stage loads
        ones = np.ones_like(reach)

        def stages(accelerations: FloatArray, u: FloatArray, v: FloatArray) -> FloatArray:
            rows = (u + accelerations @ twice.T, v + accelerations @ once.T, accelerations)
            return np.stack(rows, axis=0).transpose(2, 0, 1)

        def unloaded(u: FloatArray, v: FloatArray) -> FloatArray:
            accelerations = np.einsum("nij,nj->ni", inverse, -(k * u + d * v))
            return stages(accelerations, u, v)

        columns = [stages(inverse[:, :, j], 0.0 * ones, 0.0 * ones) for j in range(reach.size)]
        return cls(unloaded(ones, 0.0 * ones), unloaded(reach, ones), np.stack(columns, axis=1))

    def free(self, u: FloatArray, v: FloatArray) -> FloatArray:
        """Stage values without load, (stage, 3, n)."""
        return self.from_displacement * u + self.from_velocity * v

    def forced(self, load: FloatArray) -> FloatArray:
        """Stage values that the stage loads (stage, n) add, (stage, 3, n)."""
        total: FloatArray = (self.from_load * load[:, np.newaxis, :]).sum(axis=1)
        return total
