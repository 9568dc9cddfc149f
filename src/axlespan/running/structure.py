"""A structure: a System with the lines on which wheels run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from axlespan.card import Card, Shown, some
from axlespan.errors import InputError
from axlespan.linalg.factor import Factor, NotPositiveDefinite, factorize
from axlespan.model.dofs import nearest
from axlespan.model.model import Model
from axlespan.model.system import System
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]

# A factor of the stiffness takes no more memory than this when it is kept [byte].
_KEPT = 256e6

#: Name of the line that wheels use unless they name another.
MAIN_LINE = "main"
#: Names of the lines over the deck and over the rails of a bridge with track.
DECK_LINE = "deck"
RAIL_LINE = "rail"


@dataclass(frozen=True, eq=False, repr=False)
class Structure(Shown):
    """What vehicles cross: matrices with named d.o.f., and running lines over them.

    The paths of ``lines`` are in the system's independent d.o.f. (its ties eliminated).
    """

    system: System
    lines: Mapping[str, PolynomialPath]
    name: str = "structure"
    model: Model | None = None  # where it came from a finite element model of ours
    facts: Mapping[str, float] = field(default_factory=dict)  # e.g. length [m], for summaries and figures

    def __post_init__(self) -> None:
        if not self.lines:
            raise InputError("must have at least one running line", field="structure", value=self.name)

    def line(self, name: str = MAIN_LINE) -> PolynomialPath:
        """A running line by name; the first one stands in for the main line.

        Raises
        ------
        InputError
            If there is none of that name.
        """
        if name in self.lines:
            return self.lines[name]
        if name == MAIN_LINE:
            return next(iter(self.lines.values()))
        raise nearest(name, list(self.lines), "running line")

    @property
    def sensor_line(self) -> str:
        """The line on which sensors stand that name none: the deck under a track, else the main line."""
        return DECK_LINE if DECK_LINE in self.lines else MAIN_LINE

    @property
    def length(self) -> float:
        """Length of the first running line [m]."""
        path = self.line()
        return path.stop - path.start

    def require_stable(self) -> None:
        """Check, once for a structure, that its supports hold it.

        Raises
        ------
        InputError
            If it is a mechanism, moves freely as a whole or has parts without support; d.o.f. are named.
        """
        self._checked  # noqa: B018  # raises

    @property
    def stiffness_factor(self) -> Factor | None:
        """Factor of K over the free d.o.f., which the check of the supports left over; None if it was too large to keep."""
        return self._checked

    @cached_property
    def _checked(self) -> Factor | None:
        if not len(self.system.free):
            raise InputError("has no free degree of freedom", field="structure", value=self.name)
        try:
            factor = factorize(self.system.partition.K_FF)
        except NotPositiveDefinite as error:
            names = ", ".join(self.system.free_name(int(i)) for i in error.suspects[:6])
            what = {
                "disconnected": "has a part that no support holds",
                "mechanism": "is a mechanism",
                "indefinite": "has a stiffness matrix that is not positive definite",
            }.get(error.kind, "is not stable")
            raise InputError(
                f"{what}: it can move freely at {names}",
                field="structure",
                value=self.name,
                fix="Support these degrees of freedom, or connect the part that they belong to",
            ) from error
        return factor if factor.nbytes <= _KEPT else None

    def __getstate__(self) -> dict[str, object]:
        """All but the factor, which belongs to this process."""
        return {name: value for name, value in self.__dict__.items() if name != "_checked"}

    def card(self) -> Card:
        """Return what is shown of it."""
        lines = [f"{name} {path.start:g} to {path.stop:g} m" for name, path in self.lines.items()]
        masses = [
            f"{axis} {self.system.total_mass(axis) / 1e3:.6g} t"
            for axis in "xyz"
            if axis in self.system.components
        ]
        facts = [
            ("d.o.f.", f"{len(self.system.free)} free, {len(self.system.prescribed)} prescribed"),
            ("lines", some(lines)),
            ("mass", some(masses)),
        ]
        after = "asp.Crossing(structure, train, speed=250 / 3.6)"
        return Card(f"Structure: {self.name}", facts, after)
