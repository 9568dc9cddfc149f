"""Gmsh files in ASCII: MSH 4.1 and 2.2.

Source: Gmsh reference manual, "MSH file format" (4.1) and "MSH file format version 2 (Legacy)".
"""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError, Place
from axlespan.io.lines import Lines, numbers_of, whole
from axlespan.io.meshes.assemble import NodeRows, Unsupported, refuse
from axlespan.io.meshes.gmsh_parts import (
    KIND_OF_TYPE,
    GmshParts,
    TypeRows,
    dimension_of,
    node_count,
    once_per_element,
    unknown_type,
)

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_NAME = re.compile(r'\s*([0-3])\s+(-?\d{1,15})\s+"(.*)"\s*')
_NONE = np.empty(0, dtype=np.int64)


def sections_of(file: str, text: str) -> dict[str, Lines]:
    """The sections ``$Name … $EndName`` of a file by name.

    Raises
    ------
    InputError
        If a section isn't closed or stands there twice.
    """
    lines = text.split("\n")
    sections: dict[str, Lines] = {}
    name, start = "", 0
    for i in [i for i, line in enumerate(lines) if line[:1] == "$"]:
        mark = lines[i].strip()[1:]
        if not name:
            name, start = mark, i
            if mark in sections or mark.startswith("End"):
                rule = (
                    "opens a section that the file already has"
                    if mark in sections
                    else "closes no open section"
                )
                raise InputError(rule, value=f"${mark}", place=Place(file, i + 1))
        elif mark == f"End{name}":
            sections[name] = Lines(file, lines[start + 1 : i], start + 2)
            name = ""
    if name:
        rule = f"ends early: the section ${name} of line {start + 1} has no $End{name}"
        raise InputError(rule, place=Place(file, len(lines)), fix="Export the file again.")
    return sections


def _section(file: str, sections: Mapping[str, Lines], name: str) -> Lines:
    if name not in sections:
        listed = ", ".join(f"${other}" for other in sections)
        raise InputError(f"has no section ${name}", field=f"sections {listed}", place=Place(file))
    return sections[name]


def physical_names(lines: Lines) -> dict[tuple[int, int], str]:
    """Names of the physical groups by dimension and tag, from the section ``$PhysicalNames``."""
    (count,) = lines.integers("physical names", 1)
    lines.require(count, "physical names")
    names: dict[tuple[int, int], str] = {}
    for _ in range(count):
        match = _NAME.fullmatch(lines.next("physical names"))
        if match is None:
            raise lines.error('must be a dimension (0 to 3), a number and a name in quotes: 2 7 "deck"')
        key = (int(match[1]), abs(int(match[2])))
        if key in names:
            raise lines.error("names a physical group a second time")
        names[key] = match[3].strip()
    lines.finish("physical names")
    return names


def _names(sections: Mapping[str, Lines]) -> dict[tuple[int, int], str]:
    return physical_names(sections["PhysicalNames"]) if "PhysicalNames" in sections else {}


# --- 4.1 --------------------------------------------------------------------------------------


def parse_version_4(file: str, text: str) -> GmshParts:
    """Parts of a file in MSH 4.1."""
    sections = sections_of(file, text)
    if "PartitionedEntities" in sections:
        fix = "Save it from Gmsh without partitions."
        place = sections["PartitionedEntities"].place(0)
        raise InputError("is a partitioned mesh, which is not supported", place=place, fix=fix)
    groups = _entities(sections["Entities"]) if "Entities" in sections else {}
    nodes = _nodes_4(_section(file, sections, "Nodes"))
    elements = _elements_4(_section(file, sections, "Elements"), groups)
    return GmshParts(_names(sections), nodes, elements)


def _entities(lines: Lines) -> dict[tuple[int, int], tuple[int, ...]]:
    """Physical tags by dimension and entity."""
    counts = lines.integers("numbers of entities", 4)
    groups: dict[tuple[int, int], tuple[int, ...]] = {}
    for dimension, count in enumerate(counts):
        lines.require(count, "entities")
        for _ in range(count):
            words = lines.next("entities").split()
            box = 3 if dimension == 0 else 6
            values = numbers_of([words], len(words))
            if values is None or len(words) < box + 2 or not np.all(np.abs(values) < 1e15):
                raise lines.error("must be a number, a point or a box, and physical groups (entity)")
            row = whole(
                values[:, [0, *range(box + 1, len(words))]],
                lines.numbers[lines.position - 1 :][:1],
                lines.file,
                "entity",
            )[0]
            tags = row[2 : 2 + int(row[1])] if row[1] >= 0 else _NONE
            if len(tags) != row[1]:
                raise lines.error(f"must list {row[1]} physical groups (entity)")
            groups[dimension, int(row[0])] = tuple(abs(int(tag)) for tag in tags)
    lines.finish("entities")
    return groups


def _nodes_4(lines: Lines) -> NodeRows:
    blocks, total, *_ = lines.integers("nodes: blocks, nodes, lowest and highest number", 4)
    lines.require(blocks, "blocks of nodes")
    parts = []
    for _ in range(blocks):
        dimension, _, parametric, count = lines.integers(
            "a block of nodes: dimension, entity, parametric, nodes", 4
        )
        extra = dimension if parametric else 0
        if not 0 <= extra <= 3:
            raise lines.error("must have a dimension between 0 and 3 (block of nodes)")
        labels, numbers = lines.table(count, 1, "node number")
        points, at_lines = lines.table(count, 3 + extra, "coordinates")
        whole_labels = whole(labels[:, 0], numbers, lines.file, "node number")
        parts.append(NodeRows(whole_labels, points[:, :3], numbers, at_lines))
    lines.finish("nodes")
    nodes = NodeRows.joined(parts)
    if len(nodes.labels) != total:
        raise lines.error(f"must announce {len(nodes.labels)} nodes, the sum of its blocks", position=0)
    return nodes


def _elements_4(lines: Lines, groups: Mapping[tuple[int, int], tuple[int, ...]]) -> tuple[TypeRows, ...]:
    blocks, total, *_ = lines.integers("elements: blocks, elements, lowest and highest number", 4)
    lines.require(blocks, "blocks of elements")
    parts, strange, found = [], [], 0
    for _ in range(blocks):
        dimension, entity, kind, count = lines.integers(
            "a block of elements: dimension, entity, type, elements", 4
        )
        if not 0 <= dimension <= 3:
            raise lines.error("must have a dimension between 0 and 3 (block of elements)")
        width, found = node_count(kind), found + count
        if width is None or kind not in KIND_OF_TYPE:
            strange.append(unknown_type(kind, count, lines.place().line or 0))
            lines.take(count, "elements")
            continue
        table, numbers = lines.table(count, 1 + width, "element and its nodes")
        rows = whole(table, numbers, lines.file, "element and its nodes")
        physical = groups.get((dimension, entity), ())
        parts.append(TypeRows(kind, dimension, physical, rows[:, 0], rows[:, 1:], numbers))
    refuse(lines.file, strange)
    lines.finish("elements")
    if found != total:
        raise lines.error(f"must announce {found} elements, the sum of its blocks", position=0)
    return tuple(parts)


# --- 2.2 --------------------------------------------------------------------------------------


def parse_version_2(file: str, text: str) -> GmshParts:
    """Parts of a file in MSH 2.2."""
    sections = sections_of(file, text)
    lines = _section(file, sections, "Nodes")
    (count,) = lines.integers("nodes", 1)
    table, numbers = lines.table(count, 4, "node and its coordinates")
    lines.finish("nodes")
    nodes = NodeRows(whole(table[:, 0], numbers, file, "node number"), table[:, 1:], numbers, numbers)
    return GmshParts(_names(sections), nodes, _elements_2(_section(file, sections, "Elements")))


def _elements_2(lines: Lines) -> tuple[TypeRows, ...]:
    """Elements ``number type tags… nodes…``; the first tag is the physical group, the second the entity."""
    (count,) = lines.integers("elements", 1)
    chunk, numbers = lines.take(count, "elements")
    lines.finish("elements")
    words = [line.split() for line in chunk]
    widths = np.array([len(row) for row in words], dtype=np.int64)
    if np.any(widths < 4):
        raise lines.error("must be a number, a type, tags and nodes", position=1 + int(np.argmax(widths < 4)))
    flat = numbers_of([[word] for row in words for word in row], 1)
    if flat is None:
        bad = next(i for i, row in enumerate(words) if numbers_of([row], len(row)) is None)
        raise lines.error("must be whole numbers (element)", position=1 + bad)
    values = whole(flat[:, 0], np.repeat(numbers, widths), lines.file, "element and its nodes")
    starts = np.cumsum(widths) - widths
    types, tags = values[starts + 1], values[starts + 2]
    strange: list[Unsupported] = []
    for kind in np.unique(types).tolist():
        rows, width = types == kind, node_count(kind)
        if width is None or kind not in KIND_OF_TYPE:
            strange.append(unknown_type(kind, int(rows.sum()), int(numbers[rows].min())))
        elif np.any(bad_rows := rows & (widths != 3 + tags + width)):
            position = 1 + int(np.argmax(bad_rows))
            raise lines.error(f"must have as many tags as it says and {width} nodes", position=position)
    refuse(lines.file, strange)
    physical = np.where(tags >= 1, values[np.minimum(starts + 3, len(values) - 1)], 0)
    entity = np.where(tags >= 2, values[np.minimum(starts + 4, len(values) - 1)], 0)
    groups = np.column_stack([types, tags, np.abs(physical)]) if count else np.empty((0, 3), dtype=np.int64)
    distinct, first_row, member = np.unique(groups, axis=0, return_index=True, return_inverse=True)
    parts, entities = [], []
    for i in np.argsort(first_row).tolist():
        kind, tag_count, group = distinct[i].tolist()
        rows = np.flatnonzero(member.reshape(-1) == i)
        first = starts[rows, None] + 3 + tag_count
        nodes = values[first + np.arange(node_count(kind) or 0)]
        tagged = (group,) if group else ()
        parts.append(TypeRows(kind, dimension_of(kind), tagged, values[starts[rows]], nodes, numbers[rows]))
        entities.append(entity[rows])
    return once_per_element(parts, entities)
