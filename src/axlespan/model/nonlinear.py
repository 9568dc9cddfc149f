r"""Nonlinear springs and dashpots between two nodes: laws f(e, ė) of the elongation e = u_2 - u_1 along a component.

A law tells the force on its ends, positive in tension, and the exact tangent. Beside that it names a reference
``stiffness``: what stands in the matrices of the system, so that only the deviation from it is an unknown of a
step. Arrays have one entry for each spring, (n,); a law with memory keeps ``n_state`` numbers of each, (n, n_state).
A law of a user's own is a class with the members of :class:`SpringLaw`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.materials import require_positive
from axlespan.model.parts import ElementMatrices

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class SpringLaw(Protocol):
    """Force and tangent of a spring or dashpot."""

    @property
    def stiffness(self) -> float | FloatArray:
        """Reference stiffness [N/m], not negative."""
        ...

    @property
    def reference_damping(self) -> float | FloatArray:
        """Dashpot [N s/m] that stands in the damping matrix, not negative."""
        ...

    @property
    def n_state(self) -> int:
        """Numbers that each spring remembers."""
        ...

    def force(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """Force [N], tension positive, at elongations [m] and rates [m/s], from the state of the step before."""
        ...

    def tangent(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the force to elongation [N/m] and rate [N s/m]."""
        ...

    def advanced(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """The state (n, n_state) once the step is done."""
        ...

    def energy(self, e: FloatArray, state: FloatArray) -> FloatArray:
        """Energy [J] that can be had back."""
        ...


class Stateless:
    """What laws without memory share."""

    n_state = 0
    reference_damping = 0.0

    def advanced(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """Nothing is remembered."""
        return state


@dataclass(frozen=True, eq=False)
class UnilateralSpring(Stateless):
    """A spring that only pushes: ballast under a sleeper, a bearing that may lift, a bump stop with its gap.

    Parameters
    ----------
    stiffness : float or array (n_spring,)
        In compression [N/m]; one for all springs of a group or one each.
    damping : float or array (n_spring,)
        Of a dashpot beside it, while it touches [N s/m]; the two together never pull.
    touch : float
        Compression [m] over which the dashpot comes in: without that its force would jump at a touch.
    """

    stiffness: float | FloatArray
    damping: float | FloatArray = 0.0
    touch: float = 1e-6

    def __post_init__(self) -> None:
        require_positive(float(np.min(self.stiffness)), "stiffness")
        require_positive(float(np.min(self.damping)), "damping", zero=True)
        require_positive(self.touch, "touch")

    @property
    def reference_damping(self) -> float | FloatArray:  # type: ignore[override]
        """That of the spring in compression [N s/m]."""
        return self.damping

    def force(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """min(k e + c w ė, 0), with w from 0 to 1 over the touch."""
        share = np.clip(-e / self.touch, 0.0, 1.0)
        return np.asarray(np.minimum(self.stiffness * np.minimum(e, 0.0) + self.damping * share * rate, 0.0))

    def tangent(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """K and c while it pushes."""
        share = np.clip(-e / self.touch, 0.0, 1.0)
        pushes = (e < 0.0) & (self.stiffness * e + self.damping * share * rate < 0.0)
        coming = np.where(share < 1.0, -self.damping * rate / self.touch, 0.0)
        return (self.stiffness + coming) * pushes, self.damping * share * pushes

    def energy(self, e: FloatArray, state: FloatArray) -> FloatArray:
        """½ k e² in compression."""
        return np.asarray(0.5 * self.stiffness * np.minimum(e, 0.0) ** 2)


@dataclass(frozen=True)
class PowerSpring(Stateless):
    """f = k |e|^n sign(e), n >= 1: rubber pads, load-dependent ballast.

    Parameters
    ----------
    coefficient : float
        k [N/m^n].
    exponent : float
        n, at least 1.
    reference : float
        Elongation [m] whose tangent is the reference stiffness.
    """

    coefficient: float
    exponent: float
    reference: float = 1e-3

    def __post_init__(self) -> None:
        require_positive(self.coefficient, "coefficient")
        require_positive(self.reference, "reference")
        if not 1.0 <= self.exponent < 10.0:
            raise InputError("must be at least 1 and below 10", field="exponent", value=self.exponent)

    @property
    def stiffness(self) -> float:
        """Tangent at the reference elongation [N/m]."""
        return float(self.coefficient * self.exponent * self.reference ** (self.exponent - 1.0))

    def force(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """K |e|^n sign(e)."""
        return np.asarray(self.coefficient * np.sign(e) * np.abs(e) ** self.exponent)

    def tangent(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """K n |e|^(n-1)."""
        slope = self.coefficient * self.exponent * np.abs(e) ** (self.exponent - 1.0)
        return slope, np.zeros_like(e)

    def energy(self, e: FloatArray, state: FloatArray) -> FloatArray:
        """∫ f de."""
        n = self.exponent + 1.0
        return np.asarray(self.coefficient / n * np.abs(e) ** n)


@dataclass(frozen=True, eq=False)
class MultilinearSpring(Stateless):
    """Force linear between points (elongation, force), and on beyond them.

    Parameters
    ----------
    points : sequence of (float, float)
        [m, N], with increasing elongations and forces that do not fall.
    """

    points: Sequence[Sequence[float]]

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _table(self.points, "elongation", "force"))

    @property
    def stiffness(self) -> float:
        """The steepest slope [N/m]."""
        table = np.asarray(self.points)
        return float((np.diff(table[:, 1]) / np.diff(table[:, 0])).max())

    def force(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """Read from the table."""
        return _read(self.points, e)[0]

    def tangent(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Slope of the piece."""
        return _read(self.points, e)[1], np.zeros_like(e)

    def energy(self, e: FloatArray, state: FloatArray) -> FloatArray:
        """∫ f de from zero elongation."""
        return np.asarray(_work(self.points, e) - _work(self.points, np.zeros(1)))


@dataclass(frozen=True)
class PowerDashpot(Stateless):
    """f = c |ė|^n sign(ė), n >= 1.

    Parameters
    ----------
    coefficient : float
        c [N (s/m)^n].
    exponent : float
        n, at least 1.
    """

    coefficient: float
    exponent: float = 1.0

    stiffness = 0.0

    def __post_init__(self) -> None:
        require_positive(self.coefficient, "coefficient")
        if not 1.0 <= self.exponent < 10.0:
            raise InputError("must be at least 1 and below 10", field="exponent", value=self.exponent)

    def force(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """C |ė|^n sign(ė)."""
        return np.asarray(self.coefficient * np.sign(rate) * np.abs(rate) ** self.exponent)

    def tangent(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """C n |ė|^(n-1)."""
        slope = self.coefficient * self.exponent * np.abs(rate) ** (self.exponent - 1.0)
        return np.zeros_like(e), slope

    def energy(self, e: FloatArray, state: FloatArray) -> FloatArray:
        """Nothing comes back."""
        return np.zeros_like(e)


@dataclass(frozen=True, eq=False)
class MultilinearDashpot(Stateless):
    """Force linear between points (rate, force), and on beyond them.

    Parameters
    ----------
    points : sequence of (float, float)
        [m/s, N], with increasing rates and forces that do not fall; through (0, 0).
    """

    points: Sequence[Sequence[float]]

    stiffness = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _table(self.points, "rate", "force"))
        if float(_read(self.points, np.zeros(1))[0][0]) != 0.0:
            raise InputError("must pass through (0, 0): a dashpot at rest has no force", field="points")

    def force(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """Read from the table."""
        return _read(self.points, rate)[0]

    def tangent(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Slope of the piece."""
        return np.zeros_like(e), _read(self.points, rate)[1]

    def energy(self, e: FloatArray, state: FloatArray) -> FloatArray:
        """Nothing comes back."""
        return np.zeros_like(e)


@dataclass(frozen=True)
class BilinearHysteresis:
    """Friction-like: elastic up to a yield force, then with the hardening stiffness (kinematic hardening).

    Parameters
    ----------
    stiffness : float
        Elastic [N/m].
    yield_force : float
        [N].
    hardening : float
        Stiffness after that [N/m], below the elastic one; zero is Coulomb friction behind a spring.
    """

    stiffness: float
    yield_force: float
    hardening: float = 0.0

    n_state = 1  # plastic elongation [m]
    reference_damping = 0.0

    def __post_init__(self) -> None:
        require_positive(self.stiffness, "stiffness")
        require_positive(self.yield_force, "yield_force")
        if not 0.0 <= self.hardening < self.stiffness:
            raise InputError(
                "must be zero or positive, and below the stiffness", field="hardening", value=self.hardening
            )

    def _flow(self, e: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Trial force from the back force, and the change of the plastic elongation."""
        k, h = self.stiffness, self._h
        plastic = state[:, 0]
        trial = k * (e - plastic) - h * plastic
        over = np.maximum(np.abs(trial) - self.yield_force, 0.0)
        return trial, np.asarray(np.sign(trial) * over / (k + h))

    @property
    def _h(self) -> float:
        """Slope of the back force over the plastic elongation: 1/k_t = 1/k + 1/h."""
        return self.stiffness * self.hardening / (self.stiffness - self.hardening)

    def force(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """K (e - plastic elongation)."""
        return np.asarray(self.stiffness * (e - state[:, 0] - self._flow(e, state)[1]))

    def tangent(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Elastic or hardening."""
        flows = self._flow(e, state)[1] != 0.0
        return np.where(flows, self.hardening, self.stiffness), np.zeros_like(e)

    def advanced(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """The plastic elongation goes on."""
        return np.asarray(state + self._flow(e, state)[1][:, None])

    def energy(self, e: FloatArray, state: FloatArray) -> FloatArray:
        """Elastic energy and that of the hardening."""
        plastic = state[:, 0]
        return np.asarray(0.5 * self.stiffness * (e - plastic) ** 2 + 0.5 * self._h * plastic**2)


@dataclass(frozen=True, eq=False)
class ScaledLaw:
    """A law times a factor of each spring: where a group of springs is not everywhere as stiff.

    Parameters
    ----------
    law : SpringLaw
    factor : array (n_spring,)
        Positive [-].
    """

    law: SpringLaw
    factor: FloatArray

    def __post_init__(self) -> None:
        require_positive(float(np.min(self.factor)), "factor")

    @property
    def stiffness(self) -> float | FloatArray:
        """Reference stiffness [N/m]."""
        return self.factor * self.law.stiffness

    @property
    def reference_damping(self) -> float | FloatArray:
        """Reference damping [N s/m]."""
        return self.factor * self.law.reference_damping

    @property
    def n_state(self) -> int:
        """What the law remembers."""
        return self.law.n_state

    def force(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """That of the law, times the factor."""
        return self.factor * self.law.force(e, rate, state)

    def tangent(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Those of the law, times the factor."""
        k, c = self.law.tangent(e, rate, state)
        return self.factor * k, self.factor * c

    def advanced(self, e: FloatArray, rate: FloatArray, state: FloatArray) -> FloatArray:
        """As the law does."""
        return self.law.advanced(e, rate, state)

    def energy(self, e: FloatArray, state: FloatArray) -> FloatArray:
        """That of the law, times the factor."""
        return self.factor * self.law.energy(e, state)


def _table(points: Any, first: str, second: str) -> tuple[tuple[float, float], ...]:
    table = np.asarray(points, float)
    if table.ndim != 2 or table.shape[1] != 2 or len(table) < 2:
        raise InputError(f"must be two or more pairs of {first} and {second}", field="points")
    if not np.all(np.isfinite(table)):
        raise InputError("must be finite", field="points")
    for row in range(1, len(table)):
        if table[row, 0] <= table[row - 1, 0]:
            raise InputError(
                f"must have increasing {first}s", field=f"points.{row}", value=table[row].tolist()
            )
        if table[row, 1] < table[row - 1, 1]:
            raise InputError(
                f"must have {second}s that do not fall",
                field=f"points.{row}",
                value=table[row].tolist(),
                fix="A law that softens below its own force has no unique answer; use a monotone table",
            )
    return tuple((float(x), float(y)) for x, y in table)


def _read(points: Sequence[Sequence[float]], x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and slopes of a table, continued beyond its ends."""
    table = np.asarray(points)
    slopes = np.diff(table[:, 1]) / np.diff(table[:, 0])
    piece = np.clip(np.searchsorted(table[:, 0], x, side="right") - 1, 0, len(slopes) - 1)
    return np.asarray(table[piece, 1] + slopes[piece] * (x - table[piece, 0])), np.asarray(slopes[piece])


def _work(points: Sequence[Sequence[float]], x: FloatArray) -> FloatArray:
    """∫ of a table from its first point."""
    table = np.asarray(points)
    areas = 0.5 * (table[1:, 1] + table[:-1, 1]) * np.diff(table[:, 0])
    before = np.concatenate([[0.0], np.cumsum(areas)])
    piece = np.clip(np.searchsorted(table[:, 0], x, side="right") - 1, 0, len(areas) - 1)
    value, _ = _read(points, x)
    return np.asarray(before[piece] + 0.5 * (table[piece, 1] + value) * (x - table[piece, 0]))


@dataclass(frozen=True, eq=False)
class NonlinearPart:
    """Nonlinear springs between equal components of two nodes, or dashpots; the matrices hold the reference stiffness."""

    name: str
    nodes: IntArray  # (n_element, 2)
    law: SpringLaw
    gap: FloatArray  # (n_element,) added to the elongation: a spring with a gap touches at e = -gap [m]
    components: tuple[str, ...]  # one

    def matrices(self, points: FloatArray) -> ElementMatrices:
        """The reference stiffness and damping."""
        pair, n = np.array([[1.0, -1.0], [-1.0, 1.0]]), (len(self.nodes),)
        k, c = (np.broadcast_to(v, n) for v in (self.law.stiffness, self.law.reference_damping))
        damping = c[:, None, None] * pair if np.any(c) else None
        return ElementMatrices(stiffness=k[:, None, None] * pair, damping=damping)
