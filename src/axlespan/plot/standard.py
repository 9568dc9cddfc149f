"""The figures of every run, and files of figures."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from axlespan.interaction.crossing import Crossing
from axlespan.interaction.result import Result
from axlespan.io.dof_units import is_rotation
from axlespan.plot.contact import contact_force
from axlespan.plot.histories import acceleration, displacement
from axlespan.plot.neves2012 import neves2012
from axlespan.plot.reactions import reactions
from axlespan.plot.style import DPI, new_figure


def standard_figures(result: Result, *, span: tuple[float, float] | None = None) -> dict[str, Figure]:
    """The figures of every run: what there is of displacement, acceleration, contact_force,
    vehicle_acceleration and reactions.

    They belong to no window and need not be closed; long histories are thinned, their peaks kept.

    Parameters
    ----------
    result : Result
    span : (float, float), optional
        Ends of the structure [m], for the contact forces over positions.
    """  # noqa: D205
    figures: dict[str, Figure] = {}
    if len(result.time) < 2:
        return figures
    if result.sensor:
        figures["displacement"], ax = new_figure()
        displacement(result, ax=ax)
        figures["acceleration"], ax = new_figure()
        acceleration(result, ax=ax)
    if _moves(result):
        figures["contact_force"], ax = new_figure()
        contact_force(result, "position" if _runs(result) else "time", span=span, ax=ax)
    bodies = _bodies(result)
    if bodies:
        figures["vehicle_acceleration"], ax = new_figure()
        acceleration(result, bodies, ax=ax)
    if any(not is_rotation(name) for name in result.support):
        figures["reactions"], ax = new_figure()
        reactions(result, ax=ax)
    return figures


def _moves(result: Result) -> bool:
    """Whether contact forces change: moving forces do not."""
    return bool(result.contact) and bool(np.any(np.ptp(result.contact_force, axis=0) > 0.0))


def _runs(result: Result) -> bool:
    """Whether the train moves."""
    return bool(np.any(result.contact_position[-1] != result.contact_position[0]))


def _bodies(result: Result) -> list[str]:
    """The vertical d.o.f. of the vehicles' bodies; of another part than wheels where none is called body."""
    parts = [name.partition(".")[2] for name in result.vehicle_dof]
    vertical = [part for part in parts if part.endswith("z") and not part.startswith("wheel")]
    vertical = [part for part in vertical if not is_rotation(part)]
    chosen = "body.z" if "body.z" in vertical else vertical[0] if vertical else None
    return [name for name, part in zip(result.vehicle_dof, parts, strict=True) if part == chosen]


def save(figures: Mapping[str, Figure], folder: str | PathLike[str]) -> list[Path]:
    """Write figures as ``folder/name.png`` and close them; the folder is made if it is not there.

    Parameters
    ----------
    figures : mapping of name to Figure
    folder : path

    Raises
    ------
    OSError
        If the folder cannot be written to.
    """
    place, written = Path(folder), []
    place.mkdir(parents=True, exist_ok=True)
    for name, figure in figures.items():
        file = place / f"{name}.png"
        figure.savefig(file, dpi=DPI, format="png", backend="agg")
        plt.close(figure)
        written.append(file)
    return written


def draw_figures(
    result: Result, crossing: Crossing, folder: str | PathLike[str], *, compare: str | None = None
) -> list[str]:
    """Write the standard figures of a run into a folder; their file names.

    Parameters
    ----------
    result, crossing
        What was computed, and of what.
    folder : path
        Where the files go.
    compare : {"neves2012-3.1", "neves2012-3.2"}, optional
        Also draw the figures of that published example, beside its semi-analytical solution.

    Raises
    ------
    OSError
        If the folder cannot be written to.
    InputError
        If the result lacks what the published figures show.
    """
    path = next(iter(crossing.structure.lines.values()))
    figures = standard_figures(result, span=(path.start, path.stop))
    if compare == "neves2012-3.1":
        figures |= neves2012(single=result)
    elif compare == "neves2012-3.2":
        figures |= neves2012(train=result)
    return [file.name for file in save(figures, folder)]
