"""Springs of a structure that follow a law: pads, ballast, bearings, soil."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.model.assembly import element_dofs
from axlespan.model.compile import dof_table
from axlespan.model.dofs import nearest
from axlespan.model.nonlinear import NonlinearPart, ScaledLaw, SpringLaw, UnilateralSpring
from axlespan.model.parts import SpringPart
from axlespan.model.system import SpringRows
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]

#: A law of springs from their stiffness [N/m] and damping [N s/m], (n_spring,).
LawOf = Callable[[FloatArray, FloatArray], SpringLaw]


def require_no_laws(structure: Structure, field: str) -> None:
    """Refuse to build a structure anew that has laws beside its model, which would be lost.

    Raises
    ------
    InputError
    """
    model = structure.model
    own = {part.name for part in model.parts if isinstance(part, NonlinearPart)} if model else set()
    for springs in structure.system.nonlinear:
        if springs.name not in own:
            raise InputError(
                "follows a law already, which would be lost",
                field=field,
                value=springs.name,
                fix="Give laws last",
            )


def with_spring_law(
    structure: Structure, group: str, law: SpringLaw | LawOf, *, component: str = "z", gap: float = 0.0
) -> Structure:
    """The same structure, with the springs of a group on a law.

    The law takes the place of their stiffness, and dashpots stay; that of a dashpot takes the place of their damping,
    and springs stay; a one-sided spring takes the place of both, and of the Rayleigh damping of the spring, which
    would pull where it has parted. What it replaces stays in the matrices as a reference:
    modes and Rayleigh damping know that, and a spring that follows it is no unknown of a step. A run rests under its
    own weight first, and displacements count from there.

    Where the group is stiffer or softer than at most places, as in zones and run-ins of tracks, forces of
    the law are so, too.

    Parameters
    ----------
    structure : Structure
        Of a finite element model.
    group : str
        Name of a group of springs between a lower and an upper node: ``"pads"``, ``"ballast"``, ``"support left"``.
    law : SpringLaw, or callable
        See :mod:`axlespan.model.nonlinear`; or what makes one of stiffness and damping (n_spring,) of the springs,
        Rayleigh damping included.
    component : str
        Direction in which they act.
    gap : float
        Added to the elongation [m], which is zero in the unloaded structure.

    Raises
    ------
    InputError
        If there is no such group, it has no such component, or it follows a law already.

    Examples
    --------
    >>> from axlespan.bridges import ballasted_track, track_on_ground
    >>> from axlespan.model.nonlinear import PowerSpring
    >>> pads = PowerSpring(coefficient=4e9, exponent=1.5, reference=5e-4)
    >>> track = with_spring_law(track_on_ground(ballasted_track(), 48.0), "pads", pads)
    >>> track.system.nonlinear[0].name, len(track.system.nonlinear[0].gap)
    ('pads', 80)
    """
    if not np.isfinite(gap):
        raise InputError("must be finite", field="gap", value=gap)
    name = group if component == "z" else f"{group} along {component}"
    if any(springs.name == name for springs in structure.system.nonlinear):
        raise InputError("follow a law already", field="group", value=group, fix="Keep one of the two")
    rows = []
    for found in springs_of(structure, group, component):
        gaps = np.full(len(found.stiffness), float(gap))
        own = law(found.stiffness, found.drag) if callable(law) else law
        is_dashpot, is_both = not np.any(own.stiffness), isinstance(own, UnilateralSpring)
        usual = found.damping if is_dashpot else found.stiffness
        if not np.all(usual > 0.0):
            raise InputError(
                f"have no {'damping' if is_dashpot else 'stiffness'} that the law could take the place of",
                field="group",
                value=group,
            )
        if not callable(law):
            own = ScaledLaw(law, shares(usual))
        k = np.zeros_like(gaps) if is_dashpot else found.stiffness
        c = found.drag if is_both else found.damping if is_dashpot else np.zeros_like(gaps)
        rows.append(SpringRows(name, own, found.rows, gaps, k, c))
    system = replace(structure.system, nonlinear=(*structure.system.nonlinear, *rows))
    return replace(structure, system=system)


def shares(values: FloatArray) -> FloatArray:
    """Values (n,), all positive, over the one that most of them have.

    Examples
    --------
    >>> shares(np.array([130e6, 65e6, 130e6, 260e6])).tolist()
    [1.0, 0.5, 1.0, 2.0]
    """
    rounded = np.round(np.log(values), 6)
    _, first, count = np.unique(rounded, return_index=True, return_counts=True)
    return np.asarray(values / values[first[int(np.argmax(count))]])


@dataclass(frozen=True, eq=False)
class FoundSprings:
    """Springs of a group along one component."""

    rows: sp.csr_array  # (n_spring, n) elongations: the upper node less the lower one
    stiffness: FloatArray  # (n_spring,) [N/m]
    damping: FloatArray  # (n_spring,) [N s/m]
    drag: FloatArray  # (n_spring,) of the dashpot and of Rayleigh damping, which ends where a spring parts [N s/m]
    places: FloatArray  # (n_spring,) of the second nodes along x [m]


def springs_of(
    structure: Structure, group: str, component: str, *, dashpots: bool = True
) -> Iterator[FoundSprings]:
    """The springs of all groups of a name; without stiffness they count only where dashpots do.

    Raises
    ------
    InputError
        If there is no such group, or it has no such component.
    """
    model = structure.model
    if model is None:
        raise InputError("must be a finite element model", field="structure", value=structure.name)
    parts = [part for part in model.parts if part.name == group and isinstance(part, SpringPart)]
    if not parts:
        known = list(dict.fromkeys(p.name for p in model.parts if isinstance(p, SpringPart)))
        raise nearest(group, known, "group of springs")
    table, elimination = dof_table(model), structure.system.elimination
    for part in parts:
        if component not in part.components:
            raise InputError(f"has no springs along {component}", field="group", value=group)
        at, n_component = part.components.index(component), len(part.components)
        dofs = element_dofs(part, table)[:, [at, at + n_component]]
        turned = model.points[part.nodes[:, 0], 2] > model.points[part.nodes[:, 1], 2]
        dofs[turned] = dofs[turned, ::-1]
        k, c = part.stiffness[:, at], part.damping[:, at]
        drag = c + model.damping_of(part).beta * k
        own = np.flatnonzero((k > 0.0) | (c > 0.0) if dashpots else k > 0.0)
        n = len(own)
        unit = sp.coo_array(
            (np.tile([-1.0, 1.0], n), (np.repeat(np.arange(n), 2), dofs[own].ravel())), (n, table.size)
        )
        rows = sp.csr_array(sp.csr_array(unit) @ elimination)
        yield FoundSprings(rows, k[own], c[own], drag[own], model.points[part.nodes[own, 1], 0])
