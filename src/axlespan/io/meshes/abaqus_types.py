"""Element types of Abaqus: the kinds that they are, and their order of nodes.

Source: Abaqus Elements Guide (node ordering of each element). Solids and surfaces number their nodes as VTK
does; lines of three nodes have the middle one in the middle.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

_TYPES = {
    "point1": "MASS ROTARYI",
    "line2": "T2D2 T3D2 B21 B21H B23 B23H B31 B31H B31OS B31OSH B33 B33H PIPE21 PIPE21H PIPE31 PIPE31H",
    "line3": "T2D3 T3D3 B22 B22H B32 B32H B32OS B32OSH PIPE22 PIPE22H PIPE32 PIPE32H",
    "tri3": "S3 S3R S3RS STRI3 CPS3 CPE3 CPE3H M3D3 R3D3 SFM3D3",
    "tri6": "STRI65 CPS6 CPS6M CPE6 CPE6H CPE6M CPE6MH M3D6 SFM3D6",
    "quad4": "S4 S4R S4R5 S4RS S4RSW CPS4 CPS4R CPS4I CPE4 CPE4R CPE4I CPE4H CPE4RH CPE4IH "
    "M3D4 M3D4R R3D4 SFM3D4 SFM3D4R",
    "quad8": "S8R S8R5 CPS8 CPS8R CPE8 CPE8R CPE8H CPE8RH M3D8 M3D8R SFM3D8 SFM3D8R",
    "tet4": "C3D4 C3D4H",
    "tet10": "C3D10 C3D10H C3D10M C3D10MH C3D10I C3D10HS",
    "wedge6": "C3D6 C3D6H",
    "hex8": "C3D8 C3D8R C3D8I C3D8H C3D8RH C3D8IH C3D8S C3D8HS",
    "hex20": "C3D20 C3D20R C3D20H C3D20RH",
}

#: Kind of each supported type.
KIND_OF_TYPE: Mapping[str, str] = MappingProxyType(
    {name: kind for kind, names in _TYPES.items() for name in names.split()}
)

#: Positions of Abaqus's nodes in VTK's order, for the kinds where the two differ.
VTK_FROM_ABAQUS: Mapping[str, tuple[int, ...]] = MappingProxyType({"line3": (0, 2, 1)})
