"""Nonlinear elements of any kind on some d.o.f. of a structure or a vehicle, as interface of the direct method.

An element tells forces on its d.o.f. from their displacements and velocities, and the exact tangent. Its d.o.f. are
unknowns of every step, as the springs that deviate are: the structure's matrix is factored once, and Newton's
method works on the element's d.o.f. alone. That is right for tens to a few hundred of them.
"""

from __future__ import annotations

import traceback
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.errors import AnalysisError, InputError
from axlespan.model.system import SpringRows, System

FloatArray = npt.NDArray[np.float64]


class DofElement(Protocol):
    """A nonlinear element on m d.o.f.; ``state`` is what it remembers, None before the first step."""

    def force(self, u: FloatArray, v: FloatArray, state: Any) -> FloatArray:
        """Inner forces (m,) [N], as K u would be, from displacements [m] and velocities [m/s] of its d.o.f."""
        ...

    def tangent(self, u: FloatArray, v: FloatArray, state: Any) -> tuple[FloatArray, FloatArray]:
        """Derivatives (m, m) of the forces to u [N/m] and to v [N s/m]."""
        ...

    def advanced(self, u: FloatArray, v: FloatArray, state: Any) -> Any:
        """What it remembers once a step is done."""
        ...


@dataclass(frozen=True, eq=False)
class ElementLaw:
    """An element in the form of a law of springs: its elongations are displacements of its d.o.f."""

    element: DofElement

    stiffness = 0.0
    reference_damping = 0.0
    n_state = 1

    def force(self, e: FloatArray, rate: FloatArray, state: Any) -> FloatArray:
        """Those of the element."""
        return self._shaped("force", self._asked("force", e, rate, state), (len(e),))

    def blocks(self, e: FloatArray, rate: FloatArray, state: Any) -> tuple[FloatArray, FloatArray]:
        """Its tangents (m, m)."""
        both, shape = self._asked("tangent", e, rate, state), (len(e), len(e))
        try:
            k, c = both
        except (TypeError, ValueError) as error:
            raise AnalysisError(
                f"{self._named} says no pair of derivatives, to u and to v, in tangent"
            ) from error
        return self._shaped("tangent", k, shape), self._shaped("tangent", c, shape)

    def tangent(self, e: FloatArray, rate: FloatArray, state: Any) -> tuple[FloatArray, FloatArray]:
        """The diagonals of its tangents (m,)."""
        k, c = self.blocks(e, rate, state)
        return k.diagonal().copy(), c.diagonal().copy()

    def advanced(self, e: FloatArray, rate: FloatArray, state: Any) -> Any:
        """What the element remembers."""
        return self._asked("advanced", e, rate, state)

    def energy(self, e: FloatArray, state: Any) -> FloatArray:
        """Not known: work is counted from the forces."""
        return np.zeros_like(e)

    def _asked(self, what: str, e: FloatArray, rate: FloatArray, state: Any) -> Any:
        """What a method of the element says.

        Raises
        ------
        AnalysisError
            If it raises anything itself, or leaves the program.
        """
        u, v = e.copy(), rate.copy()  # it may keep them, or change them
        try:
            return getattr(self.element, what)(u, v, state)
        except (Exception, SystemExit) as error:
            raise AnalysisError(
                f"{self._named} fails in {what}: {type(error).__name__}: {error} ({_place_of(error)})"
            ) from error

    @property
    def _named(self) -> str:
        return f"element {type(self.element).__name__}"

    def _shaped(self, what: str, said: Any, shape: tuple[int, ...]) -> FloatArray:
        """Numbers that a method of the element says.

        Raises
        ------
        AnalysisError
            If they are no numbers, or too many or too few.
        """
        try:
            found = np.asarray(said, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise AnalysisError(f"{self._named} says what are no numbers in {what}: {error}") from error
        if found.shape != shape:
            raise AnalysisError(
                f"{self._named} says an array of the shape {found.shape} in {what}; it must have the shape {shape}"
            )
        return found


def _place_of(error: BaseException) -> str:
    """File and line of the element, not of what it calls, where an exception passed last."""
    frames = traceback.extract_tb(error.__traceback__)
    own = frames[min(1, len(frames) - 1)].filename  # the first frame is that of the call
    place = next(frame for frame in reversed(frames) if frame.filename == own)
    return f"{Path(place.filename).name}, line {place.lineno}"


class _WithSystem(Protocol):
    @property
    def system(self) -> System | None: ...


_Body = TypeVar("_Body", bound=_WithSystem)


def with_nonlinear_element(
    body: _Body, element: DofElement, dofs: Sequence[str], *, name: str = "element"
) -> _Body:
    """The same structure or vehicle with a nonlinear element on some of its d.o.f.

    Parameters
    ----------
    body : Structure or Vehicle
    element : DofElement
        Forces that do not balance each other stand on the ground beside the structure; reactions know of them where the
        support's d.o.f. is named too. Displacements count from the unloaded structure, in vehicles from rest.
    dofs : sequence of str
        Names of its m d.o.f.
    name : str
        For messages.

    Raises
    ------
    InputError
        If a d.o.f. is unknown or named twice, or forces or tangents at rest have another shape or are not finite.

    Examples
    --------
    >>> from axlespan.bridges import simple_span
    >>> class Cubic:
    ...     def force(self, u, v, state):
    ...         return 1e12 * u**3
    ...     def tangent(self, u, v, state):
    ...         return np.diag(3e12 * u**2), np.zeros((1, 1))
    ...     def advanced(self, u, v, state):
    ...         return state
    >>> bridge = simple_span(length=20.0, youngs_modulus=3e10, second_moment=0.3, mass_per_length=1e4, elements=4)
    >>> held = with_nonlinear_element(bridge, Cubic(), ["n3.z"], name="cable")
    >>> held.system.nonlinear[0].name
    'cable'
    """
    system = body.system
    if system is None:
        raise InputError("is a group of moving forces, which have no d.o.f.", field="body")
    if not dofs or len(set(dofs)) != len(dofs):
        raise InputError("must name d.o.f., each once", field="dofs", value=list(dofs))
    at, m = np.array([system.dof(dof) for dof in dofs], dtype=np.int64), len(dofs)
    still = np.zeros(m)
    force, (k, c) = element.force(still, still, None), element.tangent(still, still, None)
    for what, found, shape in (("force", force, (m,)), ("tangent", k, (m, m)), ("tangent", c, (m, m))):
        if np.shape(found) != shape:
            raise InputError(f"must have the shape {shape}", field=what, value=np.shape(found))
        if not np.isfinite(np.asarray(found, dtype=np.float64)).all():
            raise InputError("must be finite numbers at rest", field=what, value=np.asarray(found).tolist())
    unit = sp.coo_array((np.ones(m), (np.arange(m), at)), shape=(m, len(system.dof_names)))
    rows = sp.csr_array(sp.csr_array(unit) @ system.elimination)
    group = SpringRows(name, ElementLaw(element), rows, np.zeros(m))
    changed = replace(system, nonlinear=(*system.nonlinear, group))
    return replace(body, system=changed)  # type: ignore[type-var]
