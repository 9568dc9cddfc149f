"""Figures of studies: envelopes over speed with resonances, distributions, convergence."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from axlespan.plot.curves import FEW
from axlespan.plot.style import BAND, COLORS, DPI, GUIDE, axes_or_new, finish, new_figure
from axlespan.study.sweep.answers import Answers, label_of
from axlespan.study.sweep.statistics import convergence

FloatArray = npt.NDArray[np.float64]

_KMH = 3.6

# Resonances that are closer, as a share of the figure, are one line.
_NEAR = 0.02

# Quantities that get a figure of their own, the first ones that a study has.
_DRAWN = (
    "line_acceleration_max_m_per_s2",
    "line_displacement_min_m",
    "contact_force_max_N",
    "contact_force_min_N",
    "unloading_max",
    "body_acceleration_max_m_per_s2",
)


def over_speed(answers: Answers, quantity: str, ax: Axes | None = None) -> Axes:
    """The worst of a quantity over the speed, for each train; resonance speeds of the worst train as lines.

    Many trains are a band, with the worst of them on top.

    Parameters
    ----------
    answers : Answers
        From :meth:`axlespan.Study.answers`.
    quantity : str
        A column of the table of scenarios: one of ``answers.quantities``.
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If there is no such quantity.
    """
    ax = axes_or_new(ax)
    what, unit, scale = label_of(quantity)
    trains = sorted(answers.trains, key=lambda name: -_worst(answers, quantity, name))
    curves = {train: answers.envelope(quantity, train) for train in trains}
    if len(trains) > FEW:
        every = np.unique(np.concatenate([curve.speed for curve in curves.values()]))
        table = np.full((len(trains), len(every)), np.nan)
        for row, curve in zip(table, curves.values(), strict=True):
            row[np.searchsorted(every, curve.speed)] = curve.value
        low, high = np.nanmin(table, axis=0), np.nanmax(table, axis=0)
        ax.fill_between(
            _KMH * every,
            scale * low,
            scale * high,
            color=BAND,
            linewidth=0.0,
            label=f"all {len(trains)} trains",
        )
    for color, train in zip(COLORS, trains, strict=False):
        curve = curves[train]
        marker = "o" if len(curve.speed) < 60 else ""
        ax.plot(
            _KMH * curve.speed, scale * curve.value, color=color, label=train, marker=marker, markersize=2.5
        )
    _mark_resonances(ax, answers, trains[0] if trains else "")
    return finish(ax, "speed [km/h]", f"{what} [{unit}]")


def _worst(answers: Answers, quantity: str, train: str) -> float:
    envelope = answers.envelope(quantity, train)
    return float(np.abs(envelope.value).max()) if len(envelope.value) else 0.0


def _mark_resonances(ax: Axes, answers: Answers, train: str) -> None:
    """Lines at v = f d / i of the train drawn first."""
    if train not in answers.resonances or not len(ax.lines):
        return
    low, high = ax.dataLim.intervalx
    drawn: list[float] = []
    found = answers.resonances[train].between(low / _KMH, high / _KMH)
    for mode, order, speed in sorted(found):
        if any(abs(speed - other) < _NEAR * (high - low) / _KMH for other in drawn):
            continue
        drawn.append(speed)
        ax.axvline(_KMH * speed, color=GUIDE, linewidth=0.8, linestyle=":" if mode > 1 else "--")
        ax.annotate(
            f"$f_{mode}\\,d/{order}$",
            (_KMH * speed, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(2, -2),
            textcoords="offset points",
            va="top",
            fontsize=7.5,
            color=GUIDE,
        )


def exceedance(answers: Answers, quantity: str, ax: Axes | None = None) -> Axes:
    """Share of the population above each value, on a logarithmic scale, with its standard error.

    Parameters
    ----------
    answers : Answers
        From :meth:`axlespan.Study.answers`.
    quantity : str
        A column of the table of scenarios: one of ``answers.quantities``.
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If there is no such quantity.
    """
    ax = axes_or_new(ax)
    what, unit, scale = label_of(quantity)
    values = answers.distribution(quantity).values * scale
    n = len(values)
    share = 1.0 - (np.arange(n) + 0.5) / n
    error = np.sqrt(share * (1.0 - share) / n)
    floor = 0.3 / n
    low, high = np.maximum(share - error, floor), np.minimum(share + error, 1.0)
    ax.fill_between(values, low, high, color=BAND, linewidth=0.0, label="± standard error", step="mid")
    ax.step(values, share, color=COLORS[0], where="mid", label=f"{n} scenarios")
    finish(ax, f"{what} [{unit}]", "share of scenarios above")
    ax.set_yscale("log")
    ax.set_ylim(0.5 / n, 1.3)
    return ax


def converging(answers: Answers, quantity: str, ax: Axes | None = None) -> Axes:
    """Mean of the first scenarios with its standard error, over their number.

    Parameters
    ----------
    answers : Answers
        From :meth:`axlespan.Study.answers`.
    quantity : str
        A column of the table of scenarios: one of ``answers.quantities``.
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If there is no such quantity.
    """
    ax = axes_or_new(ax)
    what, unit, scale = label_of(quantity)
    values = np.asarray(answers.columns[quantity], dtype=np.float64)[answers.completed]
    counts, means, errors = convergence(values * scale)
    ax.fill_between(
        counts, means - errors, means + errors, color=BAND, linewidth=0.0, label="± standard error"
    )
    ax.plot(counts, means, color=COLORS[0], label="mean of the first scenarios")
    ax.set_xscale("log")
    return finish(ax, "scenarios", f"{what} [{unit}]")


def study_figures(answers: Answers) -> dict[str, Figure]:
    """The figures of a study: envelopes over speed where it varies; distributions of random studies.

    Parameters
    ----------
    answers : Answers
    """
    figures: dict[str, Figure] = {}
    speeds = answers.columns["speed_m_per_s"][answers.completed]
    drawn = [name for name in _DRAWN if name in answers.varying]
    if len(np.unique(speeds)) > 1 and not (answers.random and len(np.unique(speeds)) > 200):
        for quantity in drawn:
            figures[_file(quantity)], ax = new_figure()
            over_speed(answers, quantity, ax)
    if answers.random:
        for quantity in drawn:
            if len(answers.distribution(quantity).values) < 5:
                continue
            figures[f"{_file(quantity)}_exceedance"], ax = new_figure()
            exceedance(answers, quantity, ax)
            figures[f"{_file(quantity)}_convergence"], ax = new_figure()
            converging(answers, quantity, ax)
    return figures


def _file(quantity: str) -> str:
    for end in ("_m_per_s2", "_m", "_N"):
        quantity = quantity.removesuffix(end)
    return quantity


def draw_study(answers: Answers, folder: str | PathLike[str]) -> list[str]:
    """Save the figures of a study as PNG files; returns their names.

    Parameters
    ----------
    answers : Answers
    folder : path
        Where the files go.
    """
    names = []
    for name, figure in study_figures(answers).items():
        figure.savefig(Path(folder) / f"{name}.png", dpi=DPI)
        names.append(f"{name}.png")
    return names
