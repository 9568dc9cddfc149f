"""Meshes in any format that meshlane (optional) reads: VTK, MED, Nastran, Ansys cdb and others.

meshlane ends the interpreter when a file is damaged, and some of its readers never end on one. So it runs in
a process of its own, for a limited time, and hands over plain arrays.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError, Place
from axlespan.io.lines import load_bytes
from axlespan.io.meshes.assemble import ElementRows, NodeRows, Unsupported, assemble, refuse
from axlespan.model.mesh import Mesh

IntArray = npt.NDArray[np.int64]

_KINDS = {
    **{"vertex": "point1", "line": "line2", "line3": "line3", "triangle": "tri3", "triangle6": "tri6"},
    **{"quad": "quad4", "quad8": "quad8", "tetra": "tet4", "tetra10": "tet10", "wedge": "wedge6"},
    **{"hexahedron": "hex8", "hexahedron20": "hex20"},
}

# Runs in the other process, without this package: mesh to arrays. Sets of cells count through all blocks.
_SCRIPT = """
import contextlib, json, os, sys
path, file_format, target = sys.argv[1:]
with open(os.devnull, "w") as sink, contextlib.redirect_stdout(sink):
    import numpy as np
    import meshlane
    mesh = meshlane.read(path, file_format=file_format or None)
points = np.asarray(mesh.points, dtype=float)
arrays = {"points": points}
kinds, start, starts = [], 0, []
for i, block in enumerate(mesh.cells):
    kinds.append([block.type, len(block.data)])
    starts.append(start)
    start += len(block.data)
    if isinstance(block.data, np.ndarray) and block.data.ndim == 2:
        arrays[f"cells{i}"] = np.asarray(block.data, dtype=np.int64)
def plain(values):
    values = np.asarray([] if values is None else values)
    return np.flatnonzero(values) if values.dtype == bool else values.astype(np.int64).ravel()
names = {"point": sorted(map(str, mesh.point_sets)), "cell": sorted(map(str, mesh.cell_sets))}
for i, name in enumerate(names["point"]):
    arrays[f"point_set{i}"] = plain(mesh.point_sets[name])
for i, name in enumerate(names["cell"]):
    parts = [plain(part) + first for part, first in zip(mesh.cell_sets[name], starts)]
    arrays[f"cell_set{i}"] = np.concatenate([np.empty(0, np.int64), *parts])
for key, blocks in ({} if mesh.cell_sets else mesh.cell_data).items():
    parts = [np.asarray(part) for part in blocks]
    if not parts or any(part.ndim != 1 or part.dtype.kind not in "iu" for part in parts):
        continue
    values = np.concatenate(parts).astype(np.int64)
    distinct = np.unique(values)
    for value in distinct.tolist() if len(distinct) <= 1000 and len(values) == start else ():
        arrays[f"cell_set{len(names['cell'])}"] = np.flatnonzero(values == value)
        names["cell"].append(f"{key}-{value}")
arrays["about"] = np.array(json.dumps({"kinds": kinds, "names": names}))
np.savez(target, **arrays)
"""


def read_with_meshlane(
    path: str | PathLike[str], file_format: str | None = None, *, timeout: float = 600.0
) -> Mesh:
    """Read a mesh through meshlane (``pip install axlespan[mesh]``).

    Named sets come along where the format has them. Where it has whole numbers for elements instead (regions,
    references, properties), they become sets: ``medit:ref-3``.

    Parameters
    ----------
    path : path
        The file; its extension tells the format.
    file_format : str, optional
        meshlane's name of the format.
    timeout : float
        Seconds after which reading is given up.

    Returns
    -------
    Mesh

    Raises
    ------
    InputError
        If meshlane isn't installed, cannot read the file, or an element type isn't supported.
    """
    file = str(path)
    load_bytes(path)
    if find_spec("meshlane") is None:
        fix = (
            "Install it with: pip install axlespan[mesh]; or export the mesh as Gmsh MSH 4.1 or Abaqus .inp."
        )
        raise InputError("needs the optional package meshlane", field="mesh file", value=file, fix=fix)
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "mesh.npz"
        command = [
            sys.executable,
            "-P",
            "-c",
            _SCRIPT,
            str(Path(path).absolute()),
            file_format or "",
            str(target),
        ]
        try:
            done = subprocess.run(
                command, capture_output=True, timeout=timeout, check=False, stdin=subprocess.DEVNULL
            )
        except subprocess.TimeoutExpired:
            rule = f"could not be read within {timeout:g} s: the file is damaged or very large"
            raise InputError(
                rule, place=Place(file), fix="Export it as Gmsh MSH 4.1 or Abaqus .inp."
            ) from None
        if done.returncode != 0 or not target.exists():
            raise _failure(file, done.stderr.decode("utf-8", errors="replace"))
        try:
            with np.load(target, allow_pickle=False) as arrays:
                return _mesh(file, {name: arrays[name] for name in arrays.files})
        except (BadZipFile, OSError, KeyError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            raise _failure(file, str(error)) from None


def _failure(file: str, output: str) -> InputError:
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    reason = f" ({lines[-1][:200]})" if lines else ""
    rule = f"cannot be read as a mesh{reason}"
    return InputError(
        rule, place=Place(file), fix="Check its format and extension, or export it as Gmsh MSH 4.1."
    )


def _mesh(file: str, arrays: dict[str, npt.NDArray[np.generic]]) -> Mesh:
    about = json.loads(str(arrays["about"]))
    kinds = [(str(name), int(count)) for name, count in about["kinds"]]
    refuse(file, (Unsupported(f"'{name}'", count, 0) for name, count in kinds if name not in _KINDS))
    points = np.asarray(arrays["points"], dtype=np.float64)
    if points.ndim != 2 or not 1 <= points.shape[1] <= 3:
        raise InputError(
            "must have one to three coordinates", field="points", value=points.shape, place=Place(file)
        )
    points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
    labels = np.arange(1, len(points) + 1)
    none = np.zeros_like(labels)
    nodes = NodeRows(labels, points, none, none)
    elements, start = [], 1
    for i, (name, count) in enumerate(kinds):
        table = np.asarray(arrays.get(f"cells{i}", np.empty((0, 0))), dtype=np.int64)
        if count:
            numbers = np.arange(start, start + count)
            elements.append(ElementRows(_KINDS[name], numbers, table + 1, np.zeros_like(numbers)))
        start += count
    point_sets = {name: _set(arrays, f"point_set{i}") for i, name in enumerate(about["names"]["point"])}
    cell_sets = {name: _set(arrays, f"cell_set{i}") for i, name in enumerate(about["names"]["cell"])}
    return assemble(file, nodes, elements, point_sets, cell_sets)


def _set(arrays: dict[str, npt.NDArray[np.generic]], key: str) -> IntArray:
    return np.asarray(arrays[key], dtype=np.int64) + 1
