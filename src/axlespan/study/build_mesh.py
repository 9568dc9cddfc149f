"""From ``structure: {kind: mesh, …}`` to a structure, with what ``axlespan check`` says of it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from axlespan.running.path import PolynomialPath
from axlespan.running.structure import Structure
from axlespan.study.build_lines import lines_of
from axlespan.study.build_model import MeshModel, model_of
from axlespan.study.build_supports import damping_of
from axlespan.study.case_imported import MeshStructure
from axlespan.study.mesh_checks import require_held, warnings_of
from axlespan.study.mesh_sections import section_kind


@dataclass(frozen=True, eq=False)
class BuiltStructure:
    """A structure, and words about where it came from."""

    structure: Structure
    facts: tuple[str, ...] = ()  # lines for people: counts, masses, how the running line goes
    warnings: tuple[str, ...] = ()


def structure_of_mesh(case: MeshStructure) -> BuiltStructure:
    """Build the structure of a mesh.

    Raises
    ------
    InputError
        If the mesh, its sections, supports or running lines are wrong; fields are paths under the structure.
    """
    built = model_of(case, case.supports, damping_of(case.damping))
    held = np.array([support.node for support in built.model.supports], dtype=np.int64)
    require_held(built, held, "support", "supports")
    lines = lines_of(case, built)
    main = next(iter(lines.values()))
    name = case.file.stem if case.file is not None else "mesh"
    structure = Structure(
        built.compiled.system, lines, name, built.model, {"length": main.stop - main.start}
    )
    facts = (*_mesh_facts(built), *mass_facts(structure), *(line_fact(*item) for item in lines.items()))
    return BuiltStructure(structure, facts, warnings_of(built))


def _mesh_facts(built: MeshModel) -> list[str]:
    case, mesh = built.case, built.mesh
    counts = Counter[str]()
    for block in mesh.blocks:
        counts[block.kind] += len(block)
    blocks = ", ".join(f"{count} {kind}" for kind, count in counts.items())
    sections = []
    for name, section in case.sections.items():
        kind = section_kind(case, mesh, name, section)
        words = [kind, section.material, *([section.formulation] if section.formulation else [])]
        sections.append(f"{name} ({', '.join(words)})")
    supports = len(built.compiled.system.prescribed)
    return [
        f"mesh        {mesh.n_node} nodes, {blocks}; {', '.join(sections)}",
        f"d.o.f.      {built.compiled.system.size}, {supports} of them at supports",
    ]


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
