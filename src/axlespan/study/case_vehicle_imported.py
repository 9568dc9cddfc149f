"""Vehicles that come from files: finite element meshes and matrices."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_imported import File, Mesh
from axlespan.study.case_placing import Placed
from axlespan.study.checks import Part
from axlespan.study.kinds import ExistingFile
from axlespan.study.quantities import Distance, Text


class MeshVehicle(Placed, Mesh):
    """A vehicle from a mesh file; x runs along the track there too, the first wheel is the foremost one."""

    vehicle: Literal["mesh"]
    wheels: Annotated[Text, Field(examples=["wheels"])]
    """Name of the set of nodes that touch the track."""


class MatrixWheel(Part):
    """A wheel of a vehicle that is given by matrices."""

    dof: Text
    """Number (from 0) or name of the vertical d.o.f. that touches the track."""
    position: Annotated[Distance, Field(examples=["0 m"])]
    """Distance behind the first wheel."""


class MatricesVehicle(Placed):
    """A vehicle given by its matrices."""

    vehicle: Literal["matrices"]
    stiffness: File
    """Stiffness matrix."""
    mass: File
    """Mass matrix."""
    damping: Annotated[Path, ExistingFile()] | None = None
    """Damping matrix; none when left out."""
    weights: Annotated[Path, ExistingFile()] | None = None
    """Weight on each d.o.f.; mass times gravity on all of them when left out."""
    wheels: Annotated[tuple[MatrixWheel, ...], Field(examples=["[{dof: 4, position: 0 m}]"])]
    """Where the vehicle touches the track."""

    @model_validator(mode="after")
    def _roomy(self) -> Self:
        if not self.wheels or self.wheels[0].position != 0.0:
            raise InputError("must begin with a wheel at position 0 m", field="wheels")
        self.require_room(max(wheel.position for wheel in self.wheels))
        return self
