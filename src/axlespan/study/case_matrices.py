"""Structures given by matrices or modes from another program."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_damping import StructuralDamping
from axlespan.study.case_imported import LENGTH_UNITS, File, require_a_line
from axlespan.study.case_nodes import Nodes, NodeSupport, NodeWord, Start, list_or_one
from axlespan.study.check_lists import Several
from axlespan.study.checks import Measured, OneOf, Part
from axlespan.study.kinds import LIST, ExistingFile, tag
from axlespan.study.quantities import Name, Text
from axlespan.units import LENGTH

Positions = Annotated[tuple[float, ...], Several(Measured(LENGTH), increasing=True, example="[0 m, 5 m]")]
FORMATS = ("matrix-market", "npz", "abaqus", "harwell-boeing")
FORCE_UNITS = ("N", "kN", "MN", "lbf", "kip")


NodesInOrder = Annotated[
    Annotated[tuple[Annotated[str, NodeWord()], ...], LIST] | Annotated[Nodes, tag("word")],
    Discriminator(list_or_one),
]
#: Which d.o.f. the rows of matrices are: a file, or their names.
Rows = Annotated[
    Annotated[tuple[Text, ...], LIST] | Annotated[Path, ExistingFile(), tag("word")],
    Discriminator(list_or_one),
]


class MatrixUnits(Part):
    """Units that the other program worked in, with seconds; masses follow from them."""

    length: Annotated[str, OneOf(LENGTH_UNITS)] = "m"
    """Unit of lengths."""
    force: Annotated[str, OneOf(FORCE_UNITS)] = "N"
    """Unit of forces; N and mm go with masses in t, kN and m too."""


class MatricesLine(Part):
    """Where wheels run on matrices: along nodes, or along d.o.f. with their positions."""

    nodes: NodesInOrder | None = None
    """Set of nodes or their coordinates, ordered along the line that they form; or nodes in their order."""
    dofs: tuple[Text, ...] | None = None
    """Names (12.z) or rows (from 1) of the vertical d.o.f., in the direction of travel."""
    positions: Positions | None = None
    """Position of each."""
    file: Annotated[Path, ExistingFile()] | None = None
    """Table of two columns, d.o.f. and position, in place of the two lists."""
    interpolation: Annotated[str, OneOf(("auto", "linear", "cubic"))] = "auto"
    """Between nodes: linear, or cubic by their rotations; auto is cubic where there are rotations."""
    start: Start = 0.0
    """Position of the first of the nodes along the line."""

    @model_validator(mode="after")
    def _as_many(self) -> Self:
        listed = self.dofs is not None or self.positions is not None
        if (self.nodes is not None) + (self.file is not None) + listed != 1:
            raise InputError(
                "must be given by nodes, by file, or by dofs and positions",
                fix="Write {nodes: rail}, or {dofs: [1, 3], positions: [0 m, 5 m]}",
            )
        if listed and len(self.dofs or ()) != len(self.positions or ()):
            raise InputError(
                "must have as many positions as dofs: "
                f"there are {len(self.positions or ())} and {len(self.dofs or ())}"
            )
        if listed and len(self.dofs or ()) < 2:
            raise InputError("must be at least two d.o.f.", field="dofs")
        return self


class Matrices(Part):
    """Matrices of a body from any finite element program, and what is known of their rows."""

    stiffness: File | None = None
    """Stiffness matrix."""
    mass: File | None = None
    """Mass matrix."""
    dofs: Rows | None = None
    """Which d.o.f. the rows are: a file of lines row, node, component; or their names, as 12.z."""
    coordinates: Annotated[Path, ExistingFile()] | None = None
    """Coordinates of the nodes: a file of lines node, x, y, z, and the names of its sets."""
    format: Annotated[str, OneOf(FORMATS)] | None = None
    """Format of the matrices; their files tell it when left out."""
    units: MatrixUnits = MatrixUnits()
    """Units of the matrices and coordinates; N and m when left out."""

    def require_both(self) -> None:
        """Require stiffness and mass.

        Raises
        ------
        InputError
            With the field that is missing.
        """
        for name in ("stiffness", "mass"):
            if getattr(self, name) is None:
                raise InputError("is missing", field=name, fix=f"Add {name}: {name}.mtx")


class MatricesStructure(Matrices):
    """A structure given by its matrices or modes, from any finite element program."""

    kind: Literal["matrices"]
    modes: File | None = None
    """Frequencies and modal masses, in place of matrices: lines mode, Hz, kg and damping ratio; or .npz."""
    shapes: File | None = None
    """Mode shapes: lines node, component and one number for each mode; an .npz file of modes holds them."""
    damping: (
        Annotated[
            Annotated[Path, ExistingFile(), tag("file")] | Annotated[StructuralDamping, tag("law")],
            Discriminator(lambda raw: "<file>" if isinstance(raw, (str, Path)) else "<law>"),
        ]
        | None
    ) = None
    """Damping matrix, or damping as for other structures; none when left out."""
    running_line: Annotated[MatricesLine | None, Field(examples=["{nodes: rail}"])] = None
    """Where wheels run."""
    running_lines: Mapping[Name, MatricesLine] | None = None
    """Several running lines by their names, in place of one; the first is the main one."""
    supports: tuple[NodeSupport, ...] = ()
    """Supports, at nodes; none when the matrices hold them already."""

    @model_validator(mode="after")
    def _matrices_or_modes(self) -> Self:
        if self.modes is None:
            self.require_both()
        given = [name for name in ("stiffness", "mass", "dofs", "format") if getattr(self, name) is not None]
        if self.modes is not None and given:
            rule = "goes with matrices, not with modes"
            raise InputError(rule, field=given[0], fix="Keep the matrices, or the modes")
        if self.modes is None and self.shapes is not None:
            raise InputError("goes with modes", field="shapes", fix="Add modes: frequencies.csv")
        if self.modes is not None and self.supports:
            rule = "must not be given: modes are those of the structure on its supports"
            raise InputError(rule, field="supports", fix="Delete it")
        if self.modes is not None and isinstance(self.damping, Path):
            rule = "must not be a matrix: a modal model has damping ratios"
            raise InputError(rule, field="damping", fix="Write {kind: modal, ratio: 1 %}")
        require_a_line(self.running_line, self.running_lines, "{nodes: rail}")
        return self
