"""Gmsh meshes in: MSH 4.1 and 2.2, ASCII and binary."""

from __future__ import annotations

import re
from os import PathLike

from axlespan.errors import InputError, Place
from axlespan.io.lines import load_bytes, text_of
from axlespan.io.meshes.gmsh_binary import parse_binary
from axlespan.io.meshes.gmsh_parts import GmshParts, mesh_of
from axlespan.io.meshes.gmsh_text import parse_version_2, parse_version_4
from axlespan.model.mesh import Mesh

_HEADER = re.compile(rb"\s*\$MeshFormat[ \t]*\r?\n[ \t]*(\d+(?:\.\d*)?)[ \t]+([01])[ \t]+(\d+)[ \t]*\r?\n")
_FIX = "In Gmsh, save it as MSH 4.1 (Mesh.MshFileVersion = 4.1)."


def read_gmsh(path: str | PathLike[str]) -> Mesh:
    """Read a Gmsh mesh, MSH 4.1 or 2.2, ASCII or binary.

    Physical groups of all dimensions become named sets, of elements and of the elements' nodes. A group
    without a name is called after its dimension and number (``surface-3``); groups of the same name in
    several dimensions are united. An element that version 2 lists once for each of its groups is taken once.

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    Mesh

    Raises
    ------
    InputError
        If the file is damaged or holds an element type that isn't supported.

    References
    ----------
    Gmsh reference manual, "MSH file format", "Legacy formats", "Node ordering".
    """
    file, data = str(path), load_bytes(path)
    return mesh_of(file, _parts(file, data))


def _parts(file: str, data: bytes) -> GmshParts:
    if not data.lstrip().startswith(b"$MeshFormat"):
        fix = "Name its format if it isn't a Gmsh file; otherwise export it again."
        raise InputError("must begin with $MeshFormat to be a Gmsh file", place=Place(file, 1), fix=fix)
    match = _HEADER.match(data)
    if match is None:
        rule = "must give version, file type (0 or 1) and data size after $MeshFormat: 4.1 0 8"
        raise InputError(rule, place=Place(file, 2), fix=_FIX)
    version = float(match[1])
    if version != 4.1 and not 2.0 <= version < 3.0:
        rule = "is not a supported version; 4.1 and 2.2 are"
        raise InputError(rule, field="MSH version", value=match[1].decode(), place=Place(file, 2), fix=_FIX)
    if match[2] == b"1":
        if match[3] != b"8":
            raise InputError(
                "must be 8", field="data size", value=match[3].decode(), place=Place(file, 2), fix=_FIX
            )
        return parse_binary(file, data, int(version))
    text = text_of(data, file)
    return parse_version_4(file, text) if version > 4.0 else parse_version_2(file, text)
