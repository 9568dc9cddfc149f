"""Nodes of a mesh or of matrices, and what is done at them: supports, links, springs, masses."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Self

from pydantic import Discriminator, Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_support import Dashpots, Direction, Held, Springs
from axlespan.study.check_lists import Several
from axlespan.study.checks import Checked, Measured, Part
from axlespan.study.kinds import LIST, tag
from axlespan.study.quantities import Inertia, Length, Name, PartMass, Text
from axlespan.units import LENGTH

Coordinate = Annotated[tuple[float, ...], Several(Measured(LENGTH), example="[0 m, 5 m]", alone=True)]
Point = Annotated[tuple[float, ...], Several(Measured(LENGTH), exactly=3, example="[0 m, 0 m, 0 m]")]

#: How one chooses nodes, for messages.
WAYS = "a set of nodes, the number of a node, or coordinates: {x: 0 m, z: 1.25 m}"


@dataclass(frozen=True)
class NodeWord(Checked):
    """The name of a set or of a point, or the number of a node."""

    def read(self, raw: Any) -> str:
        """Return it as a text."""
        if isinstance(raw, bool) or not isinstance(raw, (str, int)) or not str(raw).strip():
            raise InputError("must name nodes", value=raw, fix=f"Write {WAYS}")
        text = str(raw).strip()
        if re.fullmatch(r"[-+]?[\d.]+([eE][-+]?\d+)?\s*(m|mm|cm|km|ft|in)", text):
            raise InputError("must name nodes, and is a length", value=raw, fix=f"Write {WAYS}")
        return text

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"type": ["string", "integer"], "description": "Name of a set of nodes, or number of a node."}


class NodesAt(Part):
    """All nodes with the coordinates given; a pair is a range, what is left out may be anything."""

    x: Coordinate | None = None
    """Along the line: a position, or a range [from, to]."""
    y: Coordinate | None = None
    """To the left."""
    z: Coordinate | None = None
    """Up."""
    within: Text | None = None
    """Name of a set that they must belong to."""

    @model_validator(mode="after")
    def _ranges(self) -> Self:
        given = {name: getattr(self, name) for name in "xyz" if getattr(self, name) is not None}
        if not given:
            raise InputError("chooses no nodes", fix="Write, for example, {x: 0 m, z: 1.25 m}")
        for name, values in given.items():
            if len(values) > 2 or (len(values) == 2 and values[1] <= values[0]):
                raise InputError("must be one position or a range [from, to]", field=name)
        return self


def _nodes_tag(raw: Any) -> str:
    return "<place>" if isinstance(raw, (Mapping, Part)) else "<word>"


Nodes = Annotated[
    Annotated[str, NodeWord(), tag("word")] | Annotated[NodesAt, tag("place")],
    Discriminator(_nodes_tag),
    Field(examples=["bearings"]),
]


def list_or_one(raw: Any) -> str:
    """Return the mark of a list or, for all else, of a single thing."""
    return LIST.tag if isinstance(raw, (list, tuple)) else "<word>"


OneNode = Annotated[str, NodeWord(), Field(examples=["pier"])]


class NodeSupport(Held):
    """What holds nodes: each of them rigidly, elastically, or as its motion prescribes.

    A direction may stand under one of ``fixed``, ``stiffness`` (and ``damping``) and ``motion``; one that
    stands nowhere is free. Springs and dashpots stand at each of the nodes.
    """

    at: Nodes
    """Set of nodes, number of a node, or coordinates: {x: 0 m, z: 1.25 m}."""
    name: Annotated[Name | None, Field(examples=["left"])] = None
    """What results call it; the name of the set when left out."""


class RigidLink(Part):
    """Nodes that move with another one as a rigid body."""

    master: OneNode
    """The node that they follow: a point, the number of a node, or a set of one node."""
    nodes: Nodes
    """The nodes that follow."""
    components: tuple[Direction, ...] | None = None
    """Directions in which they follow; all when left out."""


class Tie(Part):
    """Nodes that move as other nodes at the same place do, each as the nearest of them."""

    nodes: Nodes
    """The nodes that follow."""
    to: Nodes
    """The nodes that they follow."""
    components: tuple[Direction, ...] | None = None
    """Directions in which they follow; all that both have when left out."""
    tolerance: Annotated[float, Measured(LENGTH, above=0.0)] = 1e-3
    """Largest distance of two nodes that are tied."""


class Spring(Part):
    """Springs and dashpots from each node of a set to the nearest of another, whatever the distance."""

    between: Annotated[tuple[Nodes, Nodes], Field(examples=["[girder, pier]"])]
    """The two sets of nodes."""
    stiffness: Springs | None = None
    """Stiffness of each spring, by direction."""
    damping: Dashpots | None = None
    """Damping of each dashpot, by direction."""

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not ((self.stiffness and self.stiffness.given()) or (self.damping and self.damping.given())):
            raise InputError("joins nothing", fix="Add stiffness: {z: 500 MN/m}")
        return self


class Inertias(Part):
    """Moments of inertia about the axes."""

    rx: Inertia | None = None
    ry: Inertia | None = None
    rz: Inertia | None = None


class PointMass(Part):
    """A mass at each node of a set."""

    at: Nodes
    """Where."""
    mass: Annotated[PartMass, Field(examples=["500 kg"])]
    """Mass at each of the nodes."""
    inertia: Inertias | None = None
    """Moments of inertia at each of the nodes."""


Offset = Annotated[tuple[float, ...], Several(Measured(LENGTH), example="0.3 m", alone=True)]
Start = Annotated[Length, Field(examples=["0 m"])]
