r"""Laws of contact: what force belongs to which approach of wheel and line.

The approach δ = r + E u_s - u_X is positive where a wheel left alone would sink into the line (N12 (27) is
δ = 0). A *constrained* law has no force of its own: :class:`Rigid` holds δ = 0 whatever the sign of the force,
:class:`Unilateral` asks for 0 <= X, δ <= 0, X δ = 0. A *compliant* law gives the force from the approach:
:class:`Hertz` and :class:`LinearSpring`. A law of a user's own is a class with the members of
:class:`CompliantLaw`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.materials import require_positive

FloatArray = npt.NDArray[np.float64]

# G = factor · R^exponent · 1e-8 [m/N^(2/3)] with the radius R [m]; F = (δ/G)^1.5. Zhai's fits for a cone tread
# and a worn tread on a rail, quoted from memory: to be checked against the original.
_TREADS: Final = {"cone": (4.57, -0.149), "worn": (3.86, -0.115)}

#: Radius [m] of a wheel that does not say its own.
RADIUS: Final = 0.46


def hertz_stiffness(radius: float, tread: str = "worn") -> float:
    """Stiffness k_h [N/m^1.5] of a wheel of a radius [m] on a rail: F = k_h δ^1.5.

    Raises
    ------
    InputError
        If the radius is not positive, or the tread is none of "worn" and "cone".

    Examples
    --------
    >>> f"{hertz_stiffness(0.46):.4g}, {hertz_stiffness(0.46, 'cone'):.4g}"
    '1.153e+11, 8.605e+10'
    """
    require_positive(radius, "radius")
    if tread not in _TREADS:
        raise InputError("must be worn or cone", field="tread", value=tread)
    factor, exponent = _TREADS[tread]
    return float((factor * 1e-8 * radius**exponent) ** -1.5)


@runtime_checkable
class CompliantLaw(Protocol):
    """A law that gives the force from the approach; all arrays (n,), one entry a wheel."""

    @property
    def kind(self) -> str:
        """Word of the law."""
        ...

    @property
    def tension(self) -> bool:
        """Whether the force may pull."""
        ...

    def force(self, approach: FloatArray, rate: FloatArray) -> FloatArray:
        """Force [N], compression positive, from the approach [m] and its rate [m/s]."""
        ...

    def tangent(self, approach: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the force to the approach [N/m] and to its rate [N s/m], none negative."""
        ...

    def approach(self, force: FloatArray) -> FloatArray:
        """The approach [m] under a force [N] at rest."""
        ...

    def energy(self, approach: FloatArray) -> FloatArray:
        """Work [J] that the law holds at an approach, above that at zero approach."""
        ...


@dataclass(frozen=True)
class Rigid:
    """No separation and no approach (N12 (27)): the wheel is held to the line, and the force may pull."""

    kind = "rigid"


@dataclass(frozen=True)
class Unilateral:
    """A rigid contact that lifts off where the force would pull, and lands without rebound."""

    kind = "unilateral"


@dataclass(frozen=True)
class Hertz:
    """F = k_h δ^1.5, and none without approach.

    Parameters
    ----------
    stiffness : float, optional
        k_h [N/m^1.5]; from radius and tread when left out.
    radius : float, optional
        Of the wheel [m]; that of its contact point, else 0.46 m, when left out.
    tread : str
        "worn" or "cone".

    Raises
    ------
    InputError
        If a value is not positive, or stiffness and radius are both given.

    Examples
    --------
    >>> law = Hertz(stiffness=1e11)
    >>> approach = law.approach(np.array([70e3]))
    >>> f"{1e6 * approach[0]:.2f} µm, {law.force(approach, approach)[0]:.0f} N"
    '78.84 µm, 70000 N'
    """

    stiffness: float | None = None
    radius: float | None = None
    tread: str = "worn"

    kind = "hertz"
    tension = False

    def __post_init__(self) -> None:
        if self.stiffness is not None:
            require_positive(self.stiffness, "stiffness")
            if self.radius is not None:
                raise InputError("says again what stiffness says", field="radius", fix="Keep one of the two")
        hertz_stiffness(RADIUS if self.radius is None else self.radius, self.tread)

    @property
    def k(self) -> float:
        """Stiffness k_h [N/m^1.5]."""
        if self.stiffness is not None:
            return self.stiffness
        return hertz_stiffness(RADIUS if self.radius is None else self.radius, self.tread)

    def fitted(self, radius: float | None, static: float) -> Hertz:
        """The law of a wheel of a radius [m] under a static force [N]."""
        if self.stiffness is not None or self.radius is not None or radius is None:
            return self
        return Hertz(radius=radius, tread=self.tread)

    def force(self, approach: FloatArray, rate: FloatArray) -> FloatArray:
        """Force [N], compression positive, from the approach [m]."""
        return np.asarray(self.k * np.maximum(approach, 0.0) ** 1.5)

    def tangent(self, approach: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the force to the approach [N/m] and to its rate [N s/m]."""
        return 1.5 * self.k * np.sqrt(np.maximum(approach, 0.0)), np.zeros_like(approach)

    def approach(self, force: FloatArray) -> FloatArray:
        """The approach [m] under a force [N]."""
        return np.asarray((np.maximum(force, 0.0) / self.k) ** (2.0 / 3.0))

    def energy(self, approach: FloatArray) -> FloatArray:
        """∫ F dδ [J]."""
        return np.asarray(0.4 * self.k * np.maximum(approach, 0.0) ** 2.5)


@dataclass(frozen=True)
class LinearSpring:
    """F = k δ + c δ̇: a tyre, or Hertz linearized at the static force.

    Parameters
    ----------
    stiffness : float, optional
        k [N/m]; 1.5 F_st / δ_st of Hertz' law at the static force of the wheel when left out.
    damping : float
        c [N s/m].
    tension : bool
        Whether the spring may pull; otherwise the wheel lifts off.

    Raises
    ------
    InputError
        If the stiffness is not positive or the damping negative.
    """

    stiffness: float | None = None
    damping: float = 0.0
    tension: bool = False

    kind = "linear-spring"

    def __post_init__(self) -> None:
        if self.stiffness is not None:
            require_positive(self.stiffness, "stiffness")
        require_positive(self.damping, "damping", zero=True)

    @property
    def k(self) -> float:
        """Stiffness [N/m]."""
        if self.stiffness is None:
            raise InputError("is known only once the law is fitted to a wheel", field="stiffness")
        return self.stiffness

    def fitted(self, radius: float | None, static: float) -> LinearSpring:
        """The law of a wheel of a radius [m] under a static force [N]."""
        if self.stiffness is not None:
            return self
        hertz = Hertz().fitted(radius, static)
        approach = float(hertz.approach(np.array([static]))[0])
        return LinearSpring(1.5 * static / approach, self.damping, self.tension)

    def force(self, approach: FloatArray, rate: FloatArray) -> FloatArray:
        """Force [N], compression positive, from the approach [m] and its rate [m/s]."""
        both = self.k * approach + self.damping * rate
        return both if self.tension else np.maximum(both, 0.0) * (approach > 0.0)

    def tangent(self, approach: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives of the force to the approach [N/m] and to its rate [N s/m]."""
        pressed = np.ones_like(approach)
        if not self.tension:
            pressed = ((approach > 0.0) & (self.k * approach + self.damping * rate > 0.0)).astype(float)
        return self.k * pressed, self.damping * pressed

    def approach(self, force: FloatArray) -> FloatArray:
        """The approach [m] under a force [N] at rest."""
        return np.asarray(force / self.k)

    def energy(self, approach: FloatArray) -> FloatArray:
        """½ k δ² [J]."""
        pressed = approach if self.tension else np.maximum(approach, 0.0)
        return np.asarray(0.5 * self.k * pressed**2)


Law = Rigid | Unilateral | CompliantLaw

#: Laws by their words, with what they are when nothing else is said.
LAWS: Final[dict[str, Law]] = {
    "rigid": Rigid(),
    "unilateral": Unilateral(),
    "hertz": Hertz(),
    "linear-spring": LinearSpring(),
}


def law_of(word: object) -> Law:
    """The law of a word, or the law itself.

    Raises
    ------
    InputError
        If it is neither.

    Examples
    --------
    >>> law_of("unilateral")
    Unilateral()
    """
    if isinstance(word, str) and word in LAWS:
        return LAWS[word]
    if isinstance(word, (Rigid, Unilateral)):
        return word
    if isinstance(word, CompliantLaw):
        return word
    raise InputError(
        f"must be one of {', '.join(LAWS)}, or a law of axlespan.contact.laws", field="contact", value=word
    )
