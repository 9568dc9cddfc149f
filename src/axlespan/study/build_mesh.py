"""From ``structure: {kind: mesh, …}`` to a structure, with what ``axlespan check`` says of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

from axlespan.errors import InputError
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import Structure
from axlespan.study.build_lines import lines_of
from axlespan.study.build_model import MeshModel, model_of
from axlespan.study.build_supports import damping_of
from axlespan.study.built import BuiltStructure, line_fact, mass_facts
from axlespan.study.case_imported import MeshStructure
from axlespan.study.mesh_checks import require_held, warnings_of
from axlespan.study.mesh_sections import section_kind


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
    structure = Structure(built.compiled.system, lines, name, built.model, {"length": main.stop - main.start})
    facts = (*_mesh_facts(built), *mass_facts(structure), *_line_facts(lines))
    return BuiltStructure(structure, facts, warnings_of(built), lambda at, place: _dof_at(built, at, place))


def _dof_at(built: MeshModel, choice: str, place: str) -> str:
    """Vertical d.o.f. of a node."""
    name = f"{built.model.node_label(built.book.one(choice, place))}.z"
    if name not in built.compiled.system.dof_names:
        raise InputError("has no vertical d.o.f.", field=place)
    return name


def _line_facts(lines: Mapping[str, PolynomialPath]) -> list[str]:
    facts = []
    for name, path in lines.items():
        pieces, power = len(path.breaks) - 1, path.coefficients.shape[2] - 1
        degree = {1: "linear", 2: "quadratic", 3: "cubic"}.get(power, f"of degree {power}")
        facts.append(line_fact(name, path, f"{pieces} pieces, {degree}"))
    return facts


def _mesh_facts(built: MeshModel) -> list[str]:
    case, mesh = built.case, built.mesh
    counts = Counter[str]()
    for block in mesh.blocks:
        if block.kind != "point1":  # how Gmsh writes sets of nodes
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
