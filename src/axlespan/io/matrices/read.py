"""Matrices in, whatever the format: K, M and C with their d.o.f. and coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array

from axlespan.errors import InputError, Place
from axlespan.io.lines import load_bytes, table_of
from axlespan.io.matrices.abaqus import NodalEntries, held_rows, matrices_of, read_abaqus_entries
from axlespan.io.matrices.harwell_boeing import read_harwell_boeing
from axlespan.io.matrices.matrix_market import read_matrix_market
from axlespan.io.matrices.model import MatrixModel
from axlespan.io.matrices.names import DofMap, NodeTable
from axlespan.io.matrices.npz import read_npz
from axlespan.io.matrices.tables import read_coordinates, read_dof_map

FilePath = str | PathLike[str]

FORMATS = ("matrix-market", "npz", "abaqus", "harwell-boeing")


def format_of(path: FilePath) -> str:
    """Format of a matrix file, from how it begins.

    Raises
    ------
    InputError
        If it begins like none of them.
    """
    data = load_bytes(path)[:4096]
    if data.startswith(b"PK"):
        return "npz"
    if data.lower().startswith(b"%%matrixmarket"):
        return "matrix-market"
    lines = data.decode("latin-1").splitlines()
    if len(lines) > 3 and lines[2][:3].upper() in (
        "RSA",
        "RUA",
        "RRA",
        "CSA",
        "CUA",
        "PSA",
        "PUA",
        "RSE",
        "RUE",
    ):
        return "harwell-boeing"
    first = next((line for line in lines if line.strip() and line.lstrip()[0] != "*"), "")
    words = first.replace(",", " ").upper().replace("D", "E").split()
    if len(words) in (3, 5, 6) and table_of(words, 1) is not None:
        return "abaqus"
    known = "Matrix Market, SciPy .npz, Abaqus *MATRIX OUTPUT and Harwell-Boeing (Ansys HBMAT)"
    raise InputError(f"is not a matrix file that is known: {known}", place=Place(str(path), 1))


def read_matrices(
    stiffness: FilePath,
    mass: FilePath,
    damping: FilePath | None = None,
    *,
    dofs: FilePath | DofMap | None = None,
    coordinates: FilePath | None = None,
    format: str | None = None,
    unnamed: bool = False,
) -> MatrixModel:
    """Read the matrices of a model from another program.

    Parameters
    ----------
    stiffness, mass : path
        Matrix files. All formats take a symmetric matrix whole or by one of its triangles.
    damping : path, optional
        Damping matrix.
    dofs : path or DofMap, optional
        Map of rows to nodes and components (`read_dof_map`). Abaqus files name their d.o.f. themselves,
        unless the layout is COORDINATE; the ``.mapping`` file of Ansys is found beside the stiffness.
    coordinates : path, optional
        Node coordinates (`read_coordinates`).
    format : {"matrix-market", "npz", "abaqus", "harwell-boeing"}, optional
        Format of the matrices; each file's beginning tells it when left out.
    unnamed : bool
        Whether rows without a map are taken as they come: d.o.f. ``1.row``, ``2.row``, …

    Returns
    -------
    MatrixModel
        Checked: sizes, symmetry, finite entries, signs. D.o.f. that Abaqus holds by 1e36 are taken out.

    Raises
    ------
    InputError
        If a file is damaged, the d.o.f. are not known, or the matrices cannot be those of a structure.
    """
    if format is not None and format not in FORMATS:
        raise InputError(f"must be one of {', '.join(FORMATS)}", field="format", value=format)
    files = {"stiffness": stiffness, "mass": mass} | ({} if damping is None else {"damping": damping})
    formats = {name: format or format_of(path) for name, path in files.items()}
    if dofs is None and formats["stiffness"] == "harwell-boeing":
        dofs = _mapping_beside(stiffness)
    names = dofs if dofs is None or isinstance(dofs, DofMap) else read_dof_map(dofs)
    parts = {name: _read(path, formats[name], names) for name, path in files.items()}
    names, matrices = _named(files, parts, names, unnamed)
    held = (
        held_rows(matrices["stiffness"]) if formats["stiffness"] == "abaqus" else np.empty(0, dtype=np.int64)
    )
    table = None if coordinates is None else read_coordinates(coordinates)
    try:
        return _model(matrices, names, table, held)
    except InputError as error:
        sources = files if coordinates is None else {**files, "node": coordinates}
        place = Place(str(sources.get((error.field or "").split(" ")[0], stiffness)))
        raise error.located(place) from None


def _model(
    matrices: Mapping[str, csr_array],
    names: DofMap,
    table: NodeTable | None,
    held: np.typing.NDArray[np.int64],
) -> MatrixModel:
    """The model without the rows that are held."""
    keep = np.setdiff1d(np.arange(len(names)), held)
    for name, matrix in matrices.items():
        if matrix.shape[0] != len(names):
            rule = f"must have as many rows as there are d.o.f., {len(names)}"
            fix = "Export all matrices and the d.o.f. map together."
            raise InputError(rule, field=name, value=matrix.shape[0], fix=fix)
    free = {name: csr_array(matrix[keep][:, keep]) for name, matrix in matrices.items()}
    return MatrixModel(
        stiffness=free["stiffness"],
        mass=free["mass"],
        damping=free.get("damping"),
        dofs=names.taken(keep),
        coordinates=table,
        held=names.taken(held),
    )


def _mapping_beside(path: FilePath) -> Path | None:
    beside = (Path(path).with_suffix(suffix) for suffix in (".mapping", ".MAPPING"))
    return next((candidate for candidate in beside if candidate.is_file()), None)


def _read(path: FilePath, format: str, names: DofMap | None) -> NodalEntries | csr_array:
    if format == "abaqus":
        return read_abaqus_entries(path, None if names is None else len(names))
    if format == "harwell-boeing":
        return read_harwell_boeing(path).matrix
    return read_npz(path) if format == "npz" else read_matrix_market(path)


def _named(
    files: Mapping[str, FilePath],
    parts: Mapping[str, NodalEntries | csr_array],
    names: DofMap | None,
    unnamed: bool,
) -> tuple[DofMap, dict[str, csr_array]]:
    """The d.o.f. and the matrices in their order."""
    nodal = {name: part for name, part in parts.items() if isinstance(part, NodalEntries)}
    plain = {name: part for name, part in parts.items() if not isinstance(part, NodalEntries)}
    if nodal and plain:
        rule = "must name its d.o.f., as the other matrices do"
        raise InputError(rule, field=next(iter(plain)), place=Place(str(files[next(iter(plain))])))
    if nodal:
        if names is not None:
            fix = "Leave out the d.o.f. map."
            raise InputError("is not needed: the matrices name their d.o.f.", field="dofs", fix=fix)
        found, matrices = matrices_of(list(nodal.values()))
        return found, dict(zip(nodal, matrices, strict=True))
    if names is None and unnamed:
        size = plain["stiffness"].shape[0]
        names = DofMap(np.arange(1, size + 1), ("row",) * size)
    if names is None:
        fix = "Give a CSV file: row, node, component (1, 12, z); or the .mapping file of Ansys."
        raise InputError("need a d.o.f. map", field="matrices", place=Place(str(files["stiffness"])), fix=fix)
    return names, plain
