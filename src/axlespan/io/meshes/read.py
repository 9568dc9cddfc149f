"""Meshes in, whatever the format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from axlespan.io.lines import load_bytes
from axlespan.io.meshes.abaqus import read_abaqus
from axlespan.io.meshes.foreign import read_with_meshlane
from axlespan.io.meshes.gmsh import read_gmsh
from axlespan.model.mesh import Mesh

_READERS: Mapping[str, Callable[[str | PathLike[str]], Mesh]] = MappingProxyType(
    {"gmsh": read_gmsh, "abaqus": read_abaqus}
)
_FORMAT_OF_EXTENSION = MappingProxyType({".msh": "gmsh", ".inp": "abaqus"})


def read_mesh(path: str | PathLike[str], *, format: str | None = None) -> Mesh:
    """Read a mesh with its named sets.

    Parameters
    ----------
    path : path
        The file.
    format : str, optional
        ``"gmsh"`` (MSH 4.1 and 2.2, ASCII and binary), ``"abaqus"`` (.inp), or one of meshlane's formats
        (``"vtk"``, ``"med"``, ``"nastran"``, …). When left out, the extension tells; a file that begins as a
        Gmsh file is read as one whatever it is called.

    Returns
    -------
    Mesh

    Raises
    ------
    InputError
        If the file is missing, damaged, of another format, or holds an element type that isn't supported;
        it names the line where there is one.
    """
    name = format or _FORMAT_OF_EXTENSION.get(Path(path).suffix.lower())
    if format is None and load_bytes(path).lstrip().startswith(b"$MeshFormat"):
        name = "gmsh"
    reader = _READERS.get(name or "")
    return reader(path) if reader else read_with_meshlane(path, name)
