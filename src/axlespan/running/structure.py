"""A structure: a System with the lines on which wheels run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.dofs import nearest
from axlespan.model.model import Model
from axlespan.model.system import System
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]

#: Name of the line that wheels use unless they name another.
MAIN_LINE = "main"


@dataclass(frozen=True, eq=False)
class Structure:
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
        """A running line by name; a structure with a single line needs none.

        Raises
        ------
        InputError
            If there is none of that name.
        """
        if name in self.lines:
            return self.lines[name]
        if name == MAIN_LINE and len(self.lines) == 1:
            return next(iter(self.lines.values()))
        raise nearest(name, list(self.lines), "running line")

    @property
    def length(self) -> float:
        """Length of the first running line [m]."""
        path = next(iter(self.lines.values()))
        return path.stop - path.start
