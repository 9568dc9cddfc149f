"""Modal models: frequencies, modal masses and shapes from another program, as CSV or npz."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError, Place
from axlespan.io.lines import Lines, load_bytes, table_of
from axlespan.io.matrices.model import LARGEST_ENTRY
from axlespan.io.matrices.names import DofMap, NodeTable
from axlespan.io.matrices.npz import load_arrays
from axlespan.io.matrices.tables import component_of, read_coordinates, rows_of, whole_number

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ModalModel:
    """Modes of a model from another program.

    Parameters
    ----------
    frequencies : array (n_mode,)
        Natural frequencies [Hz].
    masses : array (n_mode,)
        Modal masses φᵀ M φ [kg] for the shapes as given; ones for mass-normalized shapes.
    shapes : array (n_dof, n_mode)
        Mode shapes φ.
    dofs : DofMap
        Node and component of each row of the shapes.
    damping_ratios : array (n_mode,), optional
        Shares of critical damping.
    coordinates : NodeTable, optional
        Places of the nodes.

    Raises
    ------
    InputError
        If sizes differ, a value is not finite, a frequency or ratio is negative or a mass not positive.
    """

    frequencies: FloatArray
    masses: FloatArray
    shapes: FloatArray
    dofs: DofMap
    damping_ratios: FloatArray | None = None
    coordinates: NodeTable | None = None

    def __post_init__(self) -> None:
        count = np.size(self.frequencies)
        shapes = {"frequencies": (count,), "masses": (count,), "shapes": (len(self.dofs), count)}
        if self.damping_ratios is not None:
            shapes["damping_ratios"] = (count,)
        for name, shape in shapes.items():
            value = np.array(getattr(self, name), dtype=np.float64)
            if value.shape != shape:
                raise InputError(f"must have the shape {shape}", field=name, value=value.shape)
            if not np.all(np.abs(value) <= LARGEST_ENTRY):
                raise InputError("must be finite and of a sound size", field=name)
            object.__setattr__(self, name, value)
        for name in ("frequencies", "damping_ratios"):
            value = getattr(self, name)
            if value is not None and np.any(value < 0.0):
                raise InputError("must not be negative", field=name, value=float(value.min()))
        if np.any(self.masses <= 0.0):
            raise InputError("must be positive", field="masses", value=float(self.masses.min()))
        if self.coordinates is not None:
            self.coordinates.positions(np.unique(self.dofs.nodes[self.dofs.nodes > 0]))

    @property
    def n_mode(self) -> int:
        """Number of modes."""
        return len(self.frequencies)

    @property
    def stiffnesses(self) -> FloatArray:
        """Modal stiffnesses (n_mode,) (2π f)² m [N/m]."""
        return np.asarray((2.0 * np.pi * self.frequencies) ** 2 * self.masses)

    @property
    def dampings(self) -> FloatArray:
        """Modal dampings (n_mode,) 2 ζ (2π f) m [N s/m]; zero without ratios."""
        ratios = np.zeros(self.n_mode) if self.damping_ratios is None else self.damping_ratios
        return np.asarray(2.0 * ratios * 2.0 * np.pi * self.frequencies * self.masses)


_FIX = "Write it with write_modal, or give CSV files."


def read_modal(
    frequencies: str | PathLike[str],
    shapes: str | PathLike[str] | None = None,
    *,
    coordinates: str | PathLike[str] | None = None,
) -> ModalModel:
    """Read a modal model.

    Parameters
    ----------
    frequencies : path
        CSV lines ``mode, frequency [Hz], modal mass [kg]`` and, optionally, the damping ratio; or an npz file
        with the arrays ``frequencies``, ``masses``, ``shapes``, ``nodes``, ``components`` and, optionally,
        ``damping_ratios``.
    shapes : path, optional
        CSV lines ``node, component, φ₁, φ₂, …``; not for npz.
    coordinates : path, optional
        Node coordinates (`read_coordinates`).

    Raises
    ------
    InputError
        If a file is damaged or the sizes differ.
    """
    table = None if coordinates is None else read_coordinates(coordinates)
    place = Place(str(frequencies))
    try:
        if load_bytes(frequencies).startswith(b"PK") or Path(frequencies).suffix == ".npz":
            return _of_archive(load_arrays(frequencies, _FIX), table)
        if shapes is None:
            raise InputError(
                "need mode shapes", field="modes", fix="Give a CSV file: node, component, φ1, φ2, …"
            )
        modes = _modes(frequencies)
        place = Place(str(shapes))
        dofs, values = _shapes(shapes, len(modes))
        ratios = modes[:, 3] if modes.shape[1] == 4 else None
        return ModalModel(modes[:, 1], modes[:, 2], values, dofs, ratios, table)
    except InputError as error:
        raise error.located(place) from None


def _modes(path: str | PathLike[str]) -> FloatArray:
    """Rows (n_mode, 3 or 4): mode, frequency, mass, damping ratio."""
    lines = Lines.of_file(path)
    rows: list[list[float]] = []
    for words in rows_of(lines):
        values = table_of(words, 1)
        if values is None or len(words) not in (3, 4) or (rows and len(words) != len(rows[0])):
            raise lines.error(
                "must be a mode, its frequency, its modal mass and, in all lines or none, its damping ratio"
            )
        rows.append(values[:, 0].tolist())
        if rows[-1][0] != len(rows):
            raise lines.error(f"must be mode {len(rows)}: modes count from 1")
    if not rows:
        raise lines.error("has no modes")
    return np.array(rows)


def _shapes(path: str | PathLike[str], count: int) -> tuple[DofMap, FloatArray]:
    lines, names, rows = Lines.of_file(path), [], []
    for words in rows_of(lines):
        values = table_of(words[2:], 1) if len(words) == count + 2 else None
        if values is None:
            raise lines.error(f"must be a node, a component and {count} numbers, one for each mode")
        names.append((whole_number(lines, words[0], "node"), component_of(words[1])))
        rows.append(values[:, 0])
    if not rows:
        raise lines.error("has no mode shapes")
    return DofMap(np.array([node for node, _ in names]), tuple(name for _, name in names)), np.array(rows)


def _of_archive(arrays: Mapping[str, npt.NDArray[Any]], table: NodeTable | None) -> ModalModel:
    missing = [
        name for name in ("frequencies", "masses", "shapes", "nodes", "components") if name not in arrays
    ]
    if missing:
        raise InputError("is missing", field="array", value=missing[0], fix=_FIX)
    for name in ("frequencies", "masses", "shapes", "damping_ratios"):
        if name in arrays and not np.issubdtype(arrays[name].dtype, np.number):
            raise InputError("must be numbers", field=name, value=str(arrays[name].dtype), fix=_FIX)
        if name in arrays and np.iscomplexobj(arrays[name]):
            raise InputError("must be real", field=name, fix="Export undamped (normal) modes.")
    nodes, components = arrays["nodes"], arrays["components"]
    if not np.issubdtype(nodes.dtype, np.integer) or nodes.ndim != 1 or components.ndim != 1:
        raise InputError("must be lists of whole numbers and of names", field="nodes, components", fix=_FIX)
    dofs = DofMap(nodes, tuple(component_of(str(name)) for name in components.tolist()))
    ratios = arrays.get("damping_ratios")
    return ModalModel(arrays["frequencies"], arrays["masses"], arrays["shapes"], dofs, ratios, table)


def write_modal(model: ModalModel, path: str | PathLike[str]) -> None:
    """Write a modal model as npz, under just this name; coordinates go into a file of their own."""
    arrays: dict[str, npt.NDArray[Any]] = {
        "frequencies": model.frequencies,
        "masses": model.masses,
        "shapes": model.shapes,
        "nodes": model.dofs.nodes,
        "components": np.array(model.dofs.components),
    }
    if model.damping_ratios is not None:
        arrays["damping_ratios"] = model.damping_ratios
    with Path(path).open("wb") as stream:
        np.savez(stream, **arrays)  # type: ignore[arg-type]
