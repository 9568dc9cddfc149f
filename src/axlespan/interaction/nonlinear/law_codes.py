"""Laws of wheels and springs as numbers, for loops that are compiled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from axlespan.contact.laws import Hertz, LinearSpring
from axlespan.contact.laws_of_wheels import WheelLaws
from axlespan.model.nonlinear import (
    MultilinearDashpot,
    MultilinearSpring,
    PowerDashpot,
    PowerSpring,
    ScaledLaw,
    SpringLaw,
    UnilateralSpring,
)

if TYPE_CHECKING:
    from axlespan.interaction.nonlinear.springs import Springs

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Laws of springs.
UNILATERAL, POWER, TABLE, POWER_DASHPOT, TABLE_DASHPOT = range(5)
#: Laws of wheels; a linear spring that pushes only, and one that may pull.
RIGID, ONE_SIDED, HERTZ, PUSHING, PULLING = range(5)

#: Why a compiled loop returned: all steps are made; a step is not for it; the column of a spring is needed.
DONE, UNUSUAL, COLUMN = range(3)
#: Springs that may deviate at a time in the compiled loop: its elimination is quicker than calls of LAPACK up to there.
LARGEST = 256
#: Rows of the arrays that the loop works in: of wheels, of springs, and of the unknowns of an interface.
WHEEL_ROWS, SPRING_ROWS, VECTORS = 3, 8, 15


@dataclass(frozen=True, eq=False)
class CodedSprings:
    """Laws of n springs, with what they deviate from."""

    #: Law (n, 3), and of a table where its points begin and end.
    kinds: IntArray
    #: Three parameters, a factor of the force, e_0, reference stiffness and damping, f(e_0, 0) (n, 8).
    numbers: FloatArray
    points: FloatArray  # (n_point, 2)

    @classmethod
    def of(cls, springs: Springs) -> CodedSprings | None:
        """The laws of springs, or None if one has memory, is a user's own or an element."""
        points: list[FloatArray] = [np.zeros((0, 2))]
        kinds, numbers = np.zeros((springs.n, 3), dtype=np.int64), np.zeros((springs.n, 8))
        numbers[:, 3], filled = 1.0, 0
        for group, at in zip(springs.groups, springs.slices, strict=True):
            law: SpringLaw = group.law
            if isinstance(law, ScaledLaw):
                numbers[at, 3], law = law.factor, law.law
            if type(law) is UnilateralSpring:
                numbers[at, 0], numbers[at, 1], numbers[at, 2] = law.stiffness, law.damping, law.touch
            elif type(law) is PowerSpring or type(law) is PowerDashpot:
                kinds[at, 0] = POWER if type(law) is PowerSpring else POWER_DASHPOT
                numbers[at, 0], numbers[at, 1] = law.coefficient, law.exponent
            elif type(law) is MultilinearSpring or type(law) is MultilinearDashpot:
                points.append(np.asarray(law.points, dtype=np.float64))
                kind = TABLE if type(law) is MultilinearSpring else TABLE_DASHPOT
                kinds[at] = kind, filled, filled + len(law.points)
                filled += len(law.points)
            else:
                return None
        for column, values in enumerate((springs.base, springs.stiffness, springs.damping, springs.held), 4):
            numbers[:, column] = values
        return cls(kinds, numbers, np.concatenate(points))


@dataclass(frozen=True, eq=False)
class CodedWheels:
    """Laws of n wheels."""

    kinds: IntArray  # (n,)
    numbers: FloatArray  # (n, 3) stiffness, damping, approach under the static force

    @classmethod
    def of(cls, laws: WheelLaws) -> CodedWheels | None:
        """The laws of wheels, or None if one is a user's own."""
        kinds = np.where(laws.unilateral, ONE_SIDED, RIGID).astype(np.int64)
        numbers = np.zeros((len(kinds), 3))
        numbers[:, 2] = laws.indentation
        for law, wheels in laws.groups:
            if type(law) is Hertz:
                kinds[wheels], numbers[wheels, 0] = HERTZ, law.k
            elif type(law) is LinearSpring:
                kinds[wheels] = PULLING if law.tension else PUSHING
                numbers[wheels, 0], numbers[wheels, 1] = law.k, law.damping
            else:
                return None
        return cls(kinds, numbers)
