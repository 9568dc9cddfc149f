"""Vehicles that come from files: finite element meshes and matrices."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_damping import StructuralDamping
from axlespan.study.case_imported import Mesh
from axlespan.study.case_matrices import Matrices
from axlespan.study.case_nodes import Nodes, NodeSupport, OneNode, list_or_one
from axlespan.study.case_placing import Placed
from axlespan.study.checks import Part
from axlespan.study.kinds import LIST, ExistingFile, tag
from axlespan.study.quantities import Distance, Name, Text


class Wheels(Part):
    """Nodes that touch one running line."""

    at: Nodes
    """The nodes."""
    line: Name = "main"
    """Running line of the structure that they run on."""


class MeshVehicle(Placed, Mesh):
    """A vehicle from a mesh; x runs along the track there too, the first wheel is the foremost one."""

    vehicle: Literal["mesh"]
    wheels: Annotated[
        Annotated[tuple[Wheels, ...], LIST] | Annotated[Nodes, tag("word")],
        Discriminator(list_or_one),
        Field(examples=["wheels"]),
    ]
    """Nodes that touch the track: a set or coordinates; or a list of {at: ..., line: ...}."""
    supports: tuple[NodeSupport, ...] = ()
    """What the track and the driver hold: the wheels along y, one node along x; they move with the vehicle."""
    damping: StructuralDamping | None = None
    """Rayleigh damping; none when left out."""


class MatrixWheel(Part):
    """A wheel of a vehicle that is given by matrices."""

    dof: Text | None = None
    """Name (12.z) or row (from 1) of the vertical d.o.f. that touches the track."""
    node: OneNode | None = None
    """Number of the node that touches the track, in place of its d.o.f."""
    position: Annotated[Distance | None, Field(examples=["0 m"])] = None
    """Distance behind the first wheel; from the coordinates when left out, where x runs along the track."""
    line: Name = "main"
    """Running line of the structure that it runs on."""

    @model_validator(mode="after")
    def _one(self) -> Self:
        if (self.dof is None) == (self.node is None):
            raise InputError("must have dof or node", fix="Write {dof: 12.z, position: 0 m}, or {node: 12}")
        return self


class MatricesVehicle(Placed, Matrices):
    """A vehicle given by its matrices."""

    vehicle: Literal["matrices"]
    damping: Annotated[Path, ExistingFile()] | None = None
    """Damping matrix; none when left out."""
    wheels: Annotated[tuple[MatrixWheel, ...], Field(examples=["[{dof: 12.z, position: 0 m}]"])]
    """Where the vehicle touches the track."""
    supports: tuple[NodeSupport, ...] = ()
    """What the track and the driver hold, at nodes; none when the matrices hold it already."""

    @model_validator(mode="after")
    def _roomy(self) -> Self:
        self.require_both()
        given = [wheel.position for wheel in self.wheels if wheel.position is not None]
        if len(given) < len(self.wheels) and (given or self.coordinates is None):
            missing = next(i for i, wheel in enumerate(self.wheels) if wheel.position is None)
            raise InputError(
                "is missing", field=f"wheels.{missing}.position", fix="Add it, or coordinates of the nodes"
            )
        if not self.wheels or (given and min(given) != 0.0):
            raise InputError("must begin with a wheel at position 0 m", field="wheels")
        self.require_room(max(given, default=0.0))
        return self
