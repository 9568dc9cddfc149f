"""A structure that was built from a case, with what ``axlespan check`` says of where it came from."""

from __future__ import annotations

from dataclasses import dataclass

from axlespan.running.path import PolynomialPath
from axlespan.running.structure import Structure


@dataclass(frozen=True, eq=False)
class BuiltStructure:
    """A structure, and words about where it came from."""

    structure: Structure
    facts: tuple[str, ...] = ()  # lines for people: counts, masses, how the running line goes
    warnings: tuple[str, ...] = ()


def mass_facts(structure: Structure) -> list[str]:
    """Mass that moves along each axis, as other programs print it."""
    system = structure.system
    there = [axis for axis in "xyz" if axis in system.components]
    masses = ", ".join(f"{axis} {system.total_mass(axis) / 1e3:.6g} t" for axis in there)
    return [f"mass        {masses}"]


def line_fact(name: str, path: PolynomialPath) -> str:
    """Where a running line goes."""
    pieces, power = len(path.breaks) - 1, path.coefficients.shape[2] - 1
    degree = {1: "linear", 2: "quadratic", 3: "cubic"}.get(power, f"of degree {power}")
    return f"line        {name}: {path.start:g} to {path.stop:g} m, {pieces} pieces, {degree}"
