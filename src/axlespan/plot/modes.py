"""Mode shapes: along the running line, and of a model in space."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]
from mpl_toolkits.mplot3d.art3d import Line3DCollection  # type: ignore[import-untyped]

from axlespan.errors import InputError
from axlespan.linalg.eigen import Modes
from axlespan.model.modal import full_shapes
from axlespan.model.nodal import nodal_values
from axlespan.model.outline import outline
from axlespan.plot.style import COLORS, GUIDE, SIZE, axes_or_new
from axlespan.running.structure import MAIN_LINE, Structure

FloatArray = npt.NDArray[np.float64]

# Distance of the base lines of two shapes, whose amplitude is 1; points along the line; edges drawn at most.
_APART, _POINTS, _EDGES = 2.4, 1001, 40_000
# Shapes in one figure.
_MOST = 20
# Largest displacement in a picture in space, as a share of the size of the model.
_EXAGGERATION = 0.08


def line_shapes(structure: Structure, modes: Modes, line: str = MAIN_LINE, *, ax: Axes | None = None) -> Axes:
    """Draw the vertical displacements of a running line in up to 20 modes, one above the other.

    The largest displacement anywhere in the structure is 1: modes that hardly move the line look flat.

    Parameters
    ----------
    structure : Structure
    modes : Modes
        From :func:`axlespan.model.modal.modes_of`, its ``modes``.
    line : str
        Name of the running line.
    ax : Axes, optional
        Drawn into; a new pyplot figure, as high as it needs, when left out.

    Raises
    ------
    InputError
        If there is no line of that name.
    """
    path, system = structure.line(line), structure.system
    position = np.linspace(path.start, path.stop, _POINTS)
    modes = Modes(modes.angular_frequencies[:_MOST], modes.shapes[:, :_MOST])
    shapes = np.zeros((system.size, len(modes)))
    shapes[system.free] = modes.shapes
    vertical = path.rows(position, system.size) @ shapes / _sizes(structure, modes)
    axes = axes_or_new(ax, (SIZE[0], 0.9 + 0.62 * len(modes)))
    bases = -_APART * np.arange(len(modes))
    for i, base in enumerate(bases):
        axes.axhline(base, color=GUIDE, linewidth=0.6)
        axes.plot(position, base + vertical[:, i], color=COLORS[0])
    axes.set_yticks(bases, [f"{i + 1}:  {f:.4g} Hz" for i, f in enumerate(modes.frequencies)])
    axes.set_ylim(bases[-1] - 1.3, 1.3)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("Position along the line [m]")
    return axes


def space_shape(structure: Structure, modes: Modes, i: int, *, ax: Axes3D | None = None) -> Axes3D:
    """Draw the outline of a structure's model in its i-th mode, over that at rest.

    Parameters
    ----------
    structure : Structure
    modes : Modes
        From :func:`axlespan.model.modal.modes_of`, its ``modes``.
    i : int
        Number of the mode, from 0.
    ax : Axes3D, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If the structure was given by matrices, or its outline has too many edges.
    """
    model = structure.model
    if model is None:
        raise InputError("has no model to draw: it is given by matrices", field="structure")
    edges = outline(model)
    if len(edges) > _EDGES:
        rule = f"has too many edges for a figure, {len(edges)}"
        raise InputError(rule, field="structure", fix="Open modes.vtu in ParaView")
    shape = nodal_values(model, full_shapes(structure.system, modes)[:, i])[:, :3]
    lowest, highest = model.points.min(axis=0), model.points.max(axis=0)
    reach = float(np.linalg.norm(highest - lowest))
    moved = model.points + _EXAGGERATION * reach / max(np.abs(shape).max(), 1e-300) * shape
    if ax is None:
        figure = plt.figure(figsize=(SIZE[0], 0.7 * SIZE[0]), layout="constrained")
        ax = figure.add_subplot(projection="3d")
    size = np.linalg.norm(shape, axis=1)
    amount = size[edges].mean(axis=1) / max(size.max(), 1e-300)
    ax.add_collection3d(Line3DCollection(model.points[edges], colors=GUIDE, linewidths=0.3, alpha=0.4))
    bent = Line3DCollection(moved[edges], cmap="viridis", linewidths=0.9)
    bent.set_array(amount)
    ax.add_collection3d(bent)
    for lines in ax.collections:
        lines.set_clip_on(False)
    middle, half = 0.5 * (lowest + highest), 0.5 * (highest - lowest) + _EXAGGERATION * reach
    ax.set(**{f"{axis}lim": (m - h, m + h) for axis, m, h in zip("xyz", middle, half, strict=True)})
    ax.set_box_aspect(half, zoom=1.1)
    for axis, extent in zip("xyz", half / half.max(), strict=True):
        ax.locator_params(axis=axis, nbins=max(2, round(6 * extent)))
    ax.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    ax.set_title(f"Mode {i + 1}: {modes.frequencies[i]:.4g} Hz", fontsize=10.0)
    return ax


def _sizes(structure: Structure, modes: Modes) -> FloatArray:
    """Largest displacement (n_mode,) of each shape, in any direction."""
    shapes = np.abs(full_shapes(structure.system, modes))
    moves = np.array([component in ("x", "y", "z") for component in structure.system.components])
    sizes = shapes[moves].max(axis=0, initial=0.0)
    return np.asarray(np.where(sizes > 0.0, sizes, 1.0))
