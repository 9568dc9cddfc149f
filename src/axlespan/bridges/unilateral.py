"""Springs of a structure that only push: ballast under sleepers, bearings that may lift."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.model.assembly import element_dofs
from axlespan.model.compile import dof_table
from axlespan.model.dofs import nearest
from axlespan.model.nonlinear import UnilateralSpring
from axlespan.model.parts import SpringPart
from axlespan.model.system import SpringRows
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]


def with_unilateral_springs(
    structure: Structure,
    group: str,
    *,
    hanging: Sequence[tuple[float, float]] = (),
    component: str = "z",
) -> Structure:
    """The same structure, with the springs and dashpots of a group that can push only.

    They push with the stiffness and damping that they have, the matrices stay; where they part, a run takes that off.
    Under its own weight the structure rests on those that it presses, and displacements count from there.

    Parameters
    ----------
    structure : Structure
        Of a finite element model.
    group : str
        Name of a group of springs between a lower and an upper node: ``"ballast"``.
    hanging : sequence of (position, gap)
        Places along x [m] where a spring stands off by a gap [m] while nothing is loaded; each means the nearest
        spring.
    component : str
        Direction in which they push.

    Raises
    ------
    InputError
        If there is no such group, it has no such component, or a gap is not positive or named twice for a spring.
    """
    model = structure.model
    if model is None:
        raise InputError("must be a finite element model", field="structure", value=structure.name)
    parts = [part for part in model.parts if part.name == group and isinstance(part, SpringPart)]
    if not parts:
        known = list(dict.fromkeys(p.name for p in model.parts if isinstance(p, SpringPart)))
        raise nearest(group, known, "group of springs")
    table, elimination = dof_table(model), structure.system.elimination
    rows: list[SpringRows] = []
    for part in parts:
        if component not in part.components:
            raise InputError(f"has no springs along {component}", field="group", value=group)
        at, n_component = part.components.index(component), len(part.components)
        dofs = element_dofs(part, table)[:, [at, at + n_component]]
        turned = model.points[part.nodes[:, 0], 2] > model.points[part.nodes[:, 1], 2]
        dofs[turned] = dofs[turned, ::-1]
        places = model.points[part.nodes[:, 1], 0]
        gaps = _gaps(places, hanging)
        own = np.flatnonzero(part.stiffness[:, at] > 0.0)
        n = len(own)
        unit = sp.coo_array(
            (np.tile([-1.0, 1.0], n), (np.repeat(np.arange(n), 2), dofs[own].ravel())), (n, table.size)
        )
        elongation = sp.csr_array(sp.csr_array(unit) @ elimination)
        law = UnilateralSpring(part.stiffness[own, at], part.damping[own, at])
        rows.append(SpringRows(group, law, elongation, gaps[own], law.stiffness, law.damping))
    system = replace(structure.system, nonlinear=(*structure.system.nonlinear, *rows))
    return replace(structure, system=system)


def _gaps(places: FloatArray, hanging: Sequence[tuple[float, float]]) -> FloatArray:
    """Gaps (n_spring,) [m]."""
    gaps = np.zeros(len(places))
    for number, (position, gap) in enumerate(hanging):
        if not 0.0 < gap < 1.0:
            raise InputError(
                "must be positive and below 1 m", field=f"hanging_sleepers.{number}.gap", value=gap
            )
        if not places.min() - 1.0 <= position <= places.max() + 1.0:
            raise InputError(
                f"must lie on the track, between {places.min():g} and {places.max():g} m",
                field=f"hanging_sleepers.{number}.at",
                value=position,
            )
        place = places[int(np.argmin(np.abs(places - position)))]
        nearest_one = np.flatnonzero(np.abs(places - place) < 1e-9)
        if np.any(gaps[nearest_one] > 0.0):
            raise InputError("names a sleeper twice", field=f"hanging_sleepers.{number}.at", value=position)
        gaps[nearest_one] = gap
    return gaps
