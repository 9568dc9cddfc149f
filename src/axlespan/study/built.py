"""A structure that was built from a case, with what ``axlespan check`` says of where it came from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from axlespan.errors import InputError
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import Structure
from axlespan.study.case_analysis import SensorOnLine


@dataclass(frozen=True, eq=False)
class BuiltStructure:
    """A structure, and words about where it came from."""

    structure: Structure
    facts: tuple[str, ...] = ()  # lines for people: counts, masses, how the running line goes
    warnings: tuple[str, ...] = ()
    dof_at: Callable[[str, str], str] | None = None  # vertical d.o.f. of a node that a case names at a place

    def sensor_place(self, at: float | str | SensorOnLine, place: str) -> float | tuple[str, float]:
        """Position of a sensor on the line for sensors [m], or a line and its position; see sensor_position."""
        if not isinstance(at, SensorOnLine):
            return self.sensor_position(at, place)
        try:
            self.structure.line(at.line)
        except InputError as error:
            raise InputError("no such running line", field=f"{place}.line", fix=error.fix) from None
        return at.line, self.sensor_position(at.at, f"{place}.at", at.line)

    def sensor_position(self, at: float | str, place: str, line: str | None = None) -> float:
        """Position of a sensor along a running line, that for sensors by default [m].

        Parameters
        ----------
        at : float or str
            A position [m], or the name of a node of the line.
        place : str
            Its path in the case, for errors.

        Raises
        ------
        InputError
            If there is no such node, or it is not one where the line's displacement is that of the node.
        """
        if not isinstance(at, str):
            return at
        if self.dof_at is None:
            fix = "Write a length, such as 12.5 m"
            raise InputError("must be a position; the structure has no named nodes", field=place, fix=fix)
        system, path = self.structure.system, self.structure.line(line or self.structure.sensor_line)
        own = system.elimination[[system.dof(self.dof_at(at, place))]].toarray()[0]
        rows = path.rows(path.breaks, system.size)
        miss = np.asarray(rows.multiply(rows).sum(axis=1)).ravel() - 2.0 * (rows @ own) + own @ own
        found = np.flatnonzero(np.abs(miss) < 1e-9)
        if not len(found):
            rule = "is not a node of the first running line, where sensors stand"
            raise InputError(rule, field=place, fix="Write a position along it, such as 12.5 m")
        return float(path.breaks[found[0]])


def mass_facts(structure: Structure) -> list[str]:
    """Mass that moves along each axis, as other programs print it."""
    system = structure.system
    there = [axis for axis in "xyz" if axis in system.components]
    masses = ", ".join(f"{axis} {system.total_mass(axis) / 1e3:.6g} t" for axis in there)
    return [f"mass        {masses}"]


def line_fact(name: str, path: PolynomialPath, words: str) -> str:
    """Where a running line goes, and how the displacement under a wheel follows from the d.o.f."""
    return f"line        {name}: {path.start:g} to {path.stop:g} m, {words}"
