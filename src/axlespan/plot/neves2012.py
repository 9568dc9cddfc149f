"""Figures 3 to 10 of Neves, Azevedo and Calçada (2012), beside the semi-analytical solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from axlespan.errors import InputError
from axlespan.interaction.result import Result
from axlespan.plot.comparison import comparison
from axlespan.plot.style import new_figure
from axlespan.reference.neves2012 import BEAM, mass_train, single_mass
from axlespan.reference.responses import CrossingResponse

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Panel:
    """A figure of N12: what it shows, of which example, over which time."""

    number: int
    example: str
    quantity: str  # displacement or acceleration
    vehicle: int | None  # counted from 1; None: the midpoint of the beam
    caption: str
    window: tuple[float, float]  # [s]
    remark: str = ""


PANELS = (
    Panel(3, "3.1", "displacement", None, "Vertical displacement at the midpoint of the beam", (0.0, 0.9)),
    Panel(
        4,
        "3.1",
        "acceleration",
        None,
        "Vertical acceleration at the midpoint of the beam",
        (0.0, 0.9),
        " (20 modes, all)",
    ),
    Panel(5, "3.1", "displacement", 1, "Vertical displacement of the sprung mass", (0.0, 0.9)),
    Panel(6, "3.1", "acceleration", 1, "Vertical acceleration of the sprung mass", (0.0, 0.9)),
    Panel(7, "3.2", "displacement", 1, "Vertical displacement of the first sprung mass", (0.0, 3.0)),
    Panel(8, "3.2", "acceleration", 1, "Vertical acceleration of the first sprung mass", (0.0, 3.0)),
    Panel(9, "3.2", "displacement", 50, "Vertical displacement of the last sprung mass", (11.0, 14.0)),
    Panel(10, "3.2", "acceleration", 50, "Vertical acceleration of the last sprung mass", (11.0, 14.0)),
)

_SHOWN = {"displacement": (1e3, "Displacement [mm]"), "acceleration": (1.0, "Acceleration [m/s²]")}


def neves2012(
    single: Result | None = None, train: Result | None = None, *, sensor: str = "midspan"
) -> dict[str, Figure]:
    """Draw the figures of N12 that the results given can fill.

    Parameters
    ----------
    single, train : Result, optional
        Of examples 3.1 and 3.2, with upward displacements positive as everywhere.
    sensor : str, optional
        Sensor at the midpoint of the beam, of ``single``.

    Returns
    -------
    dict
        ``"neves2012-fig3"`` and on. Each figure states the largest difference between the curves, over the
        peak of the semi-analytical one. Accelerations at the midpoint depend on how many modes take part: 20
        in the semi-analytical solution, all that the elements have in a result.

    Raises
    ------
    InputError
        If a result lacks the sensor or the vehicles, or ends before the times of the figures.
    """
    figures: dict[str, Figure] = {}
    for example, result, solve in (("3.1", single, single_mass), ("3.2", train, mass_train)):
        if result is None:
            continue
        reference = solve()
        for panel in PANELS:
            if panel.example == example:
                figures[f"neves2012-fig{panel.number}"] = _figure(panel, result, reference, sensor)
    return figures


def _figure(panel: Panel, result: Result, reference: CrossingResponse, sensor: str) -> Figure:
    scale, ylabel = _SHOWN[panel.quantity]
    rows = (result.time >= panel.window[0] - 1e-9) & (result.time <= panel.window[1] + 1e-9)
    if result.time[-1] < panel.window[1] - 1e-6:
        rule = f"must reach {panel.window[1]:g} s for figure {panel.number} of N12"
        raise InputError(rule, field=f"result of example {panel.example}", value=float(result.time[-1]))
    time = result.time[rows]
    ours = scale * _computed(panel, result, sensor)[rows]
    theirs = scale * np.interp(time, reference.time, _semi_analytical(panel, reference))
    figure, ax = new_figure()
    curves = {"Direct method": ours, "Semi-analytical solution": theirs}
    comparison(time, curves, ylabel=ylabel, window=panel.window, ax=ax)
    difference = float(np.abs(ours - theirs).max() / np.abs(theirs).max())
    figure.suptitle(
        f"Neves et al. (2012), figure {panel.number}. {panel.caption}{panel.remark}",
        x=0.01,
        ha="left",
        fontsize=10.0,
    )
    note = f"largest difference {100.0 * difference:.2g} % of the peak"
    ax.annotate(
        note,
        (1.0, 1.0),
        (0.0, 6.0),
        xycoords="axes fraction",
        textcoords="offset points",
        ha="right",
        va="bottom",
        fontsize=9.0,
    )
    return figure


def _computed(panel: Panel, result: Result, sensor: str) -> FloatArray:
    if panel.vehicle is None:
        return result.at(f"sensor_{panel.quantity}", sensor)
    return result.at(f"vehicle_{panel.quantity}", f"{panel.vehicle}.body.z")


def _semi_analytical(panel: Panel, reference: CrossingResponse) -> FloatArray:
    if panel.vehicle is None:
        middle = 0.5 * BEAM.length
        beam = reference.beam
        motion = beam.displacement_at if panel.quantity == "displacement" else beam.acceleration_at
        return np.asarray(motion(middle), dtype=np.float64)
    table = reference.body_displacement if panel.quantity == "displacement" else reference.body_acceleration
    return np.asarray(table[:, panel.vehicle - 1], dtype=np.float64)
