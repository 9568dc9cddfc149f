"""VTK's XML files: unstructured grids (.vtu) and collections over time (.pvd).

Arrays stand in the file as base64 of zlib-compressed blocks, so the files are well-formed XML. The layout is
that of the VTK file formats guide (Kitware, "VTK XML formats", version 1.0 with 64-bit headers).
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Array = npt.NDArray[np.generic]

# VTK's numbers of cell types.
VERTEX, LINE = 1, 3

# Bytes of a block that is compressed as one.
_BLOCK = 1 << 22
_TYPES = {"f8": "Float64", "f4": "Float32", "i8": "Int64", "i4": "Int32", "u1": "UInt8"}


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of one type with their nodes."""

    vtk_type: int
    nodes: IntArray  # (n_cell, n_node)


@dataclass(frozen=True, eq=False)
class Grid:
    """Points and cells; what is in ``head`` is encoded once for all files of a series."""

    points: FloatArray  # (n_point, 3) [m]
    cells: Sequence[Cells]
    cell_data: Mapping[str, Array] = field(default_factory=dict)  # the same at all times, (n_cell, …)

    @property
    def n_cell(self) -> int:
        """Number of cells."""
        return sum(len(block.nodes) for block in self.cells)

    def head(self) -> tuple[str, str]:
        """XML of the points and cells, and of the constant cell data."""
        connectivity = np.concatenate([block.nodes.ravel() for block in self.cells])
        sizes = np.concatenate([np.full(len(b.nodes), b.nodes.shape[1]) for b in self.cells])
        types = np.concatenate([np.full(len(b.nodes), b.vtk_type, np.uint8) for b in self.cells])
        cells = [
            data_array("connectivity", connectivity.astype(np.int64)),
            data_array("offsets", np.cumsum(sizes).astype(np.int64)),
            data_array("types", types),
        ]
        constant = "\n".join(data_array(name, values) for name, values in self.cell_data.items())
        points = data_array("Points", np.ascontiguousarray(self.points, np.float64))
        return f"<Points>\n{points}\n</Points>\n<Cells>\n" + "\n".join(cells) + "\n</Cells>", constant


def data_array(name: str, values: Array) -> str:
    """A DataArray element: values (n,) or (n, n_component)."""
    little = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    kind = _TYPES[little.dtype.str[1:]]
    components = "" if values.ndim == 1 else f' NumberOfComponents="{values.shape[1]}"'
    head = f'<DataArray type="{kind}" Name={quoteattr(name)}{components} format="binary">'
    return f"{head}{_encoded(little.tobytes())}</DataArray>"


def _encoded(raw: bytes) -> str:
    """Base64 of the header (number of blocks, size, size of the last, compressed sizes) and of the blocks."""
    blocks = [zlib.compress(raw[i : i + _BLOCK], 1) for i in range(0, len(raw), _BLOCK)]
    header = np.array([len(blocks), _BLOCK, len(raw) % _BLOCK, *map(len, blocks)], "<u8")
    return (base64.b64encode(header.tobytes()) + base64.b64encode(b"".join(blocks))).decode("ascii")


def write_grid(
    path: Path,
    grid: Grid,
    point_data: Mapping[str, Array],
    cell_data: Mapping[str, Array] | None = None,
    *,
    head: tuple[str, str] | None = None,
    time: float | None = None,
) -> None:
    """Write an unstructured grid.

    Parameters
    ----------
    path : Path
        Ends with ``.vtu``.
    grid : Grid
    point_data, cell_data : mapping of name to array (n, …)
        Beside the constant cell data of the grid.
    head : (str, str), optional
        ``grid.head()``, where many files share it.
    time : float, optional
        Kept as the field data ``TimeValue`` [s].
    """
    mesh, constant = head or grid.head()
    at_points = "\n".join(data_array(name, values) for name, values in point_data.items())
    at_cells = "\n".join(data_array(name, values) for name, values in (cell_data or {}).items())
    stamp = ""
    if time is not None:
        value = data_array("TimeValue", np.array([time])).replace(
            " format=", ' NumberOfTuples="1" format=', 1
        )
        stamp = f"<FieldData>\n{value}\n</FieldData>\n"
    piece = f'<Piece NumberOfPoints="{len(grid.points)}" NumberOfCells="{grid.n_cell}">'
    data = f"<PointData>\n{at_points}\n</PointData>\n<CellData>\n{constant}\n{at_cells}\n</CellData>"
    body = f"<UnstructuredGrid>\n{stamp}{piece}\n{data}\n{mesh}\n</Piece>\n</UnstructuredGrid>"
    path.write_text(_file("UnstructuredGrid", body), encoding="utf-8")


def write_collection(path: Path, entries: Sequence[tuple[float, str, str]]) -> None:
    """Write a collection from entries: time [s], name of the part, file relative to the collection's folder."""
    parts = list(dict.fromkeys(name for _, name, _ in entries))
    lines = [
        f'<DataSet timestep="{time:.12g}" group="" part="{parts.index(name)}" name={quoteattr(name)} '
        f"file={quoteattr(file)}/>"
        for time, name, file in entries
    ]
    body = "<Collection>\n" + "\n".join(lines) + "\n</Collection>"
    path.write_text(_file("Collection", body), encoding="utf-8")


def _file(kind: str, body: str) -> str:
    compressor = ' header_type="UInt64" compressor="vtkZLibDataCompressor"'
    return (
        '<?xml version="1.0"?>\n'
        f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian"{compressor}>\n{body}\n</VTKFile>\n'
    )
