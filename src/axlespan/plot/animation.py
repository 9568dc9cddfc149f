"""A crossing as a film: the train rolls over the deflecting structure."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle

from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.result import Result
from axlespan.io.dof_units import is_rotation
from axlespan.io.drawing import drawing_of
from axlespan.io.peaks import static_forces
from axlespan.io.train_shapes import WHEEL_RADIUS, Box, Unit, units_of
from axlespan.plot.style import GUIDE, new_figure

FloatArray = npt.NDArray[np.float64]

#: Endings of files and what they need.
FORMATS = {".gif": "Pillow", ".mp4": "ffmpeg"}

_DECK, _BODY, _BOGIE = "#8E9AA6", "#3F6FA3", "#56636F"
_MARGIN = 0.2  # of the structure's length, before and after it
_SHARE, _HIGHEST = (
    0.04,
    1.3,
)  # what the largest deflection [of the length] and motion of a vehicle [m] are drawn as


def animation(
    result: Result,
    crossing: Crossing,
    path: str | PathLike[str],
    *,
    exaggeration: float | None = None,
    speed: float = 1.0,
    frames_per_second: int = 20,
    window: tuple[float, float] | None = None,
    dpi: int = 100,
) -> Path:
    """Write a crossing as a film, GIF or MP4 by the ending of the path.

    Bodies, bogies and wheels are to scale, displacements are enlarged; wheels are colored by their contact force
    over the static one.

    Parameters
    ----------
    result : Result
        With histories along the line (``line_points``); without them the structure is drawn at rest.
    crossing : Crossing
        What was run.
    path : path
        ``crossing.gif`` or ``crossing.mp4``; a file that is there is replaced.
    exaggeration : float, optional
        Factor of displacements; one that shows the largest deflection well when left out.
    speed : float
        Factor of the film's speed: 0.25 shows the crossing four times slower.
    frames_per_second : int
        1 to 100.
    window : (float, float), optional
        Positions shown [m]; the structure and a fifth of it on both sides when left out.
    dpi : int
        Dots per inch of a figure of 9 by 3 inches.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the ending is another one, ffmpeg is missing for MP4, a number is out of range, or nothing moves.
    OSError
        If the file cannot be written.
    """
    place = Path(path)
    writer = _writer(place, frames_per_second)
    if not speed > 0.0:
        raise InputError("must be positive", field="speed", value=speed)
    if exaggeration is not None and not exaggeration >= 0.0:
        raise InputError("must be zero or positive", field="exaggeration", value=exaggeration)
    if len(result.time) < 2 or not result.contact:
        raise InputError("has nothing that moves", field="result")
    film = _Film(result, crossing, exaggeration, window)
    duration = float(result.time[-1] - result.time[0]) / speed
    count = max(2, round(duration * frames_per_second) + 1)
    times = np.linspace(float(result.time[0]), float(result.time[-1]), count)
    with writer.saving(film.figure, str(place), dpi):
        for time in times:
            film.show(float(time))
            writer.grab_frame()
    return place


def _writer(place: Path, rate: int) -> AbstractMovieWriter:
    ending = place.suffix.lower()
    if ending not in FORMATS:
        known = " or ".join(FORMATS)
        raise InputError(f"must end in {known}", field="path", value=str(place))
    if not (isinstance(rate, int) and 1 <= rate <= 100):
        raise InputError("must be a whole number from 1 to 100", field="frames_per_second", value=rate)
    if ending == ".gif":
        return PillowWriter(fps=rate)
    if shutil.which(str(mpl.rcParams["animation.ffmpeg_path"])) is None:
        fix = "Install ffmpeg (apt-get install ffmpeg), or write a .gif"
        raise InputError("needs ffmpeg, which is not installed", field="path", value=str(place), fix=fix)
    return FFMpegWriter(fps=rate, bitrate=2400)


class _Film:
    """The figure, and how it looks at a time."""

    def __init__(
        self,
        result: Result,
        crossing: Crossing,
        exaggeration: float | None,
        window: tuple[float, float] | None,
    ) -> None:
        content = drawing_of(crossing).content
        rows = content["lines"].get(content["deck"] or "") or next(iter(content["lines"].values()))
        self._result, self._units = result, units_of(content)
        self._ways = [int(train["direction"]) for train in content["trains"]]
        self._ends = float(rows[0][0]), float(rows[-1][0])
        self._supports = sorted(
            {float(s["point"][0]) for s in content["supports"] if s["point"] and "z" in s["components"]}
        )
        length = self._ends[1] - self._ends[0]
        self._window = window or (self._ends[0] - _MARGIN * length, self._ends[1] + _MARGIN * length)
        self._factor = _factor(result, length) if exaggeration is None else exaggeration
        self._depth = float(np.clip(0.05 * length, 0.3, 2.2))
        self._static = static_forces(result)
        self._color = mpl.colormaps["RdBu"]
        self.figure, self._ax = self._axes()
        self._moving: list[Artist] = []

    def _axes(self) -> tuple[Figure, Axes]:
        figure, ax = new_figure((9.0, 3.0))
        begin, end = self._window
        height = (end - begin) / 3.4
        ax.set_xlim(begin, end)
        ax.set_ylim(-0.45 * height, 0.55 * height)
        ax.set_aspect("equal")
        ax.grid(visible=False)
        ax.set_yticks([])
        ax.spines["left"].set_visible(False)
        ax.set_xlabel("Position [m]")
        ax.plot([begin, end], [0.0, 0.0], color=GUIDE, linewidth=0.8, linestyle=(0, (4, 3)))
        shades = mpl.cm.ScalarMappable(Normalize(0.0, 2.0), self._color)
        figure.colorbar(shades, ax=ax, label="Q/Q$_0$ [-]", shrink=0.8, pad=0.01)
        return figure, ax

    def show(self, time: float) -> None:
        """Draw the scene at a time [s]."""
        for artist in self._moving:
            artist.remove()
        self._moving = [*self._structure(time)]
        for unit in self._units:
            self._moving += self._vehicle(unit, time)
        self._ax.set_title(f"t = {time:.3f} s, displacements × {self._factor:g}", fontsize=10.0, loc="left")

    def _at(self, table: FloatArray, column: int, time: float) -> float:
        return float(np.interp(time, self._result.time, table[:, column]))

    def _deflection(self, positions: FloatArray, time: float) -> FloatArray:
        """Of the line at positions [m]; zero beside it, or where it was not kept."""
        known = self._result.line_position
        if not len(known):
            return np.zeros(len(positions))
        row = int(np.clip(np.searchsorted(self._result.time, time), 1, len(self._result.time) - 1))
        begin, end = self._result.time[row - 1], self._result.time[row]
        share = (time - begin) / (end - begin)
        now = (1.0 - share) * self._result.line_displacement[
            row - 1
        ] + share * self._result.line_displacement[row]
        return np.asarray(np.interp(positions, known, now, left=0.0, right=0.0))

    def _structure(self, time: float) -> Iterator[Artist]:
        s = np.linspace(*self._ends, 200)
        top = self._factor * self._deflection(s, time)
        outline = np.concatenate([np.column_stack([s, top]), np.column_stack([s, top - self._depth])[::-1]])
        yield self._ax.add_patch(
            Polygon(outline, closed=True, facecolor=_DECK, edgecolor="black", linewidth=0.8)
        )
        places = np.array([x for x in self._supports if self._ends[0] - 1e-6 <= x <= self._ends[1] + 1e-6])
        if len(places):
            under = self._factor * self._deflection(places, time) - self._depth
            yield from self._ax.plot(places, under, linestyle="", marker=6, markersize=9, color="black")

    def _vehicle(self, unit: Unit, time: float) -> list[Artist]:
        way = self._ways[unit.train]
        first = unit.wheels[0]
        head = self._at(self._result.contact_position, first[0], time) + way * first[1]
        ends = sorted((head - way * unit.front, head - way * unit.rear))
        if ends[1] < self._window[0] or ends[0] > self._window[1]:
            return []
        found: list[Artist] = [
            self._body(box, head, way, time) for box in sorted(unit.boxes, key=lambda b: b.low)
        ]
        for contact, behind, dof, _ in unit.wheels:
            found += self._wheel(contact, head - way * behind, dof, bool(unit.boxes), time)
        return found

    def _motion(self, name: str, time: float) -> float:
        names = self._result.vehicle_dof
        return self._at(self._result.vehicle_displacement, names.index(name), time) if name in names else 0.0

    def _body(self, box: Box, head: float, way: int, time: float) -> Artist:
        """A box that has moved and turned; a positive pitch lowers its front."""
        turn = self._motion(f"{box.name}.pitch", time) + self._motion(f"{box.name}.ry", time)
        angle = -way * float(np.arctan(self._factor * turn))
        x, z = head - way * box.center, self._factor * self._motion(f"{box.name}.z", time)
        height = box.top - box.bottom
        corner = (x - 0.5 * box.length, z + box.bottom)
        patch = Rectangle(
            corner, box.length, height, angle=float(np.degrees(angle)), rotation_point="center",
            facecolor=_BOGIE if box.low else _BODY, edgecolor="black", linewidth=0.8,
        )  # fmt: skip
        return self._ax.add_patch(patch)

    def _wheel(self, contact: int, x: float, dof: str, carried: bool, time: float) -> Sequence[Artist]:
        moved = (
            self._motion(dof, time)
            if dof in self._result.vehicle_dof
            else float(self._deflection(np.array([x]), time)[0])
        )
        z = self._factor * moved
        if not carried:
            style: dict[str, Any] = {"arrowstyle": "-|>", "color": "#D55E00", "linewidth": 1.6}
            return [self._ax.annotate("", (x, z), (x, z + 2.4), arrowprops=style)]
        static = self._static[contact]
        ratio = self._at(self._result.contact_force, contact, time) / static if static else 1.0
        patch = Circle(
            (x, z + WHEEL_RADIUS),
            WHEEL_RADIUS,
            facecolor=self._color(0.5 * ratio),
            edgecolor="black",
            linewidth=0.8,
        )
        return [self._ax.add_patch(patch)]


def _factor(result: Result, length: float) -> float:
    """A round factor that shows deflections well, and lets no vehicle fly."""
    vertical = [
        i for i, name in enumerate(result.vehicle_dof) if name.endswith(".z") and not is_rotation(name)
    ]
    largest = float(np.abs(result.line_displacement).max(initial=0.0))
    moved = float(np.abs(result.vehicle_displacement[:, vertical]).max(initial=0.0))
    bounds = [share / size for share, size in ((_SHARE * length, largest), (_HIGHEST, moved)) if size > 0.0]
    if not bounds:
        return 1.0
    power = 10.0 ** np.floor(np.log10(min(bounds)))
    return float(max(1.0, *(step * power for step in (1.0, 2.0, 5.0) if step * power <= min(bounds))))
