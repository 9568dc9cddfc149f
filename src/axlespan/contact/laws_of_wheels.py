"""The laws of all wheels of a crossing: who is constrained, who is on a spring, and what its force is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.contact.laws import CompliantLaw, Hertz, Law, LinearSpring, Rigid, Unilateral

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class WheelLaws:
    """Laws of n wheels; approaches count from the static state on level ground, forces are total ones."""

    rigid: Mask  # (n,)
    unilateral: Mask  # (n,)
    groups: tuple[tuple[CompliantLaw, IntArray], ...]  # wheels of each compliant law
    static: FloatArray  # (n,) static contact forces [N]
    indentation: FloatArray  # (n,) approach under them; zero where constrained [m]
    kinds: tuple[str, ...]  # (n,) words

    @classmethod
    def of(
        cls, laws: Sequence[Law], static: FloatArray, radii: Sequence[float | None] | None = None
    ) -> WheelLaws:
        """From one law for each wheel, its static force [N] and perhaps its radius [m]."""
        radii = radii or [None] * len(laws)
        fitted = [_fitted(law, radius, force) for law, radius, force in zip(laws, radii, static, strict=True)]
        indentation = np.zeros(len(laws))
        groups: list[tuple[CompliantLaw, IntArray]] = []
        for law in dict.fromkeys(item for item in fitted if not isinstance(item, (Rigid, Unilateral))):
            wheels = np.array([i for i, item in enumerate(fitted) if item == law], dtype=np.int64)
            indentation[wheels] = law.approach(static[wheels])
            groups.append((law, wheels))
        return cls(
            np.array([isinstance(law, Rigid) for law in fitted], dtype=bool),
            np.array([isinstance(law, Unilateral) for law in fitted], dtype=bool),
            tuple(groups),
            np.asarray(static, dtype=np.float64),
            indentation,
            tuple(law.kind for law in fitted),
        )

    @property
    def constrained(self) -> Mask:
        """Wheels (n,) that touch without approach."""
        return self.rigid | self.unilateral

    @property
    def may_part(self) -> Mask:
        """Wheels (n,) whose force cannot pull."""
        result = self.unilateral.copy()
        for law, wheels in self.groups:
            result[wheels] = not law.tension
        return result

    @property
    def all_rigid(self) -> bool:
        """Whether N12's contact is all there is."""
        return bool(self.rigid.all())

    def force(self, approach: FloatArray, rate: FloatArray) -> FloatArray:
        """Forces (n,) of the compliant wheels, zero for the others, from approaches (n,) and rates."""
        result, total = np.zeros(len(approach)), approach + self.indentation
        for law, wheels in self.groups:
            result[wheels] = law.force(total[wheels], rate[wheels])
        return result

    def tangent(self, approach: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives (n,) to approach and rate."""
        k, c, total = np.zeros(len(approach)), np.zeros(len(approach)), approach + self.indentation
        for law, wheels in self.groups:
            k[wheels], c[wheels] = law.tangent(total[wheels], rate[wheels])
        return k, c

    def approach(self, force: FloatArray) -> FloatArray:
        """Approaches (n,), from the static ones on, of the compliant wheels under forces (n,) at rest."""
        result = np.zeros(len(force))
        for law, wheels in self.groups:
            result[wheels] = law.approach(force[wheels]) - self.indentation[wheels]
        return result

    def energy(self, approach: FloatArray) -> FloatArray:
        """Work (n,) [J] held, above that of no approach."""
        result, total = np.zeros(len(approach)), approach + self.indentation
        for law, wheels in self.groups:
            result[wheels] = law.energy(total[wheels])
        return result


def _fitted(law: Law, radius: float | None, static: float) -> Law:
    return law.fitted(radius, static) if isinstance(law, (Hertz, LinearSpring)) else law
