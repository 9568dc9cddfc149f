"""Gmsh files in binary: MSH 4.1 and 2.2, of either byte order.

Source: Gmsh reference manual, "MSH file format" (4.1) and "MSH file format version 2 (Legacy)".
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError, Place
from axlespan.io.lines import LARGEST_INTEGER, Lines
from axlespan.io.meshes.assemble import NodeRows, refuse
from axlespan.io.meshes.gmsh_parts import (
    GmshParts,
    TypeRows,
    dimension_of,
    node_count,
    once_per_element,
    unknown_type,
)
from axlespan.io.meshes.gmsh_text import physical_names

IntArray = npt.NDArray[np.int64]
Groups = Mapping[tuple[int, int], tuple[int, ...]]


class _Bytes:
    """Binary content, read forward and never past its end."""

    def __init__(self, file: str, data: bytes) -> None:
        self.file, self.data, self.position, self.order, self.section = file, data, 0, "<", "MeshFormat"

    def error(self, rule: str, fix: str = "Save it from Gmsh again, or as ASCII.") -> InputError:
        return InputError(
            f"{rule} (byte {self.position})", field=f"${self.section}", place=Place(self.file), fix=fix
        )

    def line(self) -> str:
        end = self.data.find(b"\n", self.position, self.position + 1000)
        if end < 0:
            raise self.error("ends early")
        text = self.data[self.position : end]
        self.position = end + 1
        return text.decode("latin-1").strip()

    def array(self, dtype: str | list[tuple[str, str, int]], count: int) -> npt.NDArray[np.void]:
        if isinstance(dtype, str):
            kind = np.dtype(self.order + dtype)
        else:
            kind = np.dtype([(name, self.order + base, (width,)) for name, base, width in dtype])
        if count < 0 or count * kind.itemsize > len(self.data) - self.position:
            raise self.error(f"ends early: {count} records of {kind.itemsize} bytes should stand here")
        values = np.frombuffer(self.data, kind, count, self.position)
        self.position += count * kind.itemsize
        return values

    def integers(self, dtype: str, count: int) -> list[int]:
        return [int(value) for value in self.array(dtype, count).tolist()]

    def sections(self) -> dict[str, int]:
        """Positions behind the opening marks; sections are passed over by their closing marks."""
        found: dict[str, int] = {}
        while (start := self.data.find(b"$", self.position)) >= 0:
            self.position = start + 1
            name = self.line()
            end = self.data.find(b"$End" + name.encode("latin-1"), self.position)
            if not name.isalnum() or end < 0:
                self.section = name[:30]
                raise self.error(f"has no closing mark $End{name[:30]}")
            found.setdefault(name, self.position)
            self.position = end + 4 + len(name)
        return found

    def open(self, sections: Mapping[str, int], name: str) -> None:
        self.section = name
        if name not in sections:
            raise self.error("is missing")
        self.position = sections[name]

    def close(self) -> None:
        rest = self.data[self.position :][: len(self.section) + 10].lstrip()
        if not rest.startswith(b"$End" + self.section.encode()):
            raise self.error("does not end where its counts say")


def parse_binary(file: str, data: bytes, version: int) -> GmshParts:
    """Parts of a binary file in MSH 4.1 (version 4) or 2.2 (version 2)."""
    source = _Bytes(file, data)
    sections = source.sections()
    source.open(sections, "MeshFormat")
    source.line()
    mark = source.array("i4", 1)
    if int(mark[0]) != 1:
        source.order = ">"
        if int(mark.view(">i4")[0]) != 1:
            raise source.error("must hold the number 1 to tell the byte order")
    names = {}
    if "PhysicalNames" in sections:
        start = sections["PhysicalNames"]
        text = data[start : data.index(b"$EndPhysicalNames", start)].decode("utf-8", errors="replace")
        names = physical_names(Lines(file, text.split("\n"), data[:start].count(b"\n") + 1))
    if "PartitionedEntities" in sections:
        source.open(sections, "PartitionedEntities")
        raise source.error(
            "makes it a partitioned mesh, which is not supported", "Save it without partitions."
        )
    if version == 2:
        return GmshParts(names, _nodes_2(source, sections), _elements_2(source, sections))
    groups = _entities(source, sections) if "Entities" in sections else {}
    return GmshParts(names, _nodes_4(source, sections), _elements_4(source, sections, groups))


def _entities(source: _Bytes, sections: Mapping[str, int]) -> Groups:
    source.open(sections, "Entities")
    groups: dict[tuple[int, int], tuple[int, ...]] = {}
    for dimension, count in enumerate(source.integers("u8", 4)):
        for _ in range(min(count, len(source.data))):
            (entity,) = source.integers("i4", 1)
            source.array("f8", 3 if dimension == 0 else 6)
            tags = source.integers("i4", source.integers("u8", 1)[0])
            if dimension:
                source.array("i4", source.integers("u8", 1)[0])  # entities on its boundary
            groups[dimension, entity] = tuple(abs(tag) for tag in tags)
    source.close()
    return groups


def _labels(source: _Bytes, values: npt.NDArray[np.void]) -> IntArray:
    if values.size and int(values.max()) > LARGEST_INTEGER:
        raise source.error("must number nodes and elements by at most 2^53")
    return values.astype(np.int64)


def _nodes_4(source: _Bytes, sections: Mapping[str, int]) -> NodeRows:
    source.open(sections, "Nodes")
    blocks, total, *_ = source.integers("u8", 4)
    parts = []
    for _ in range(min(blocks, len(source.data))):
        dimension, _, parametric = source.integers("i4", 3)
        (count,) = source.integers("u8", 1)
        labels = _labels(source, source.array("u8", count))
        width = 3 + (dimension if parametric else 0)
        if not 3 <= width <= 6:
            raise source.error("must have a dimension between 0 and 3")
        points = source.array("f8", count * width).reshape(count, width)[:, :3].astype(np.float64)
        none = np.zeros(count, dtype=np.int64)
        parts.append(NodeRows(labels, points, none, none))
    source.close()
    nodes = NodeRows.joined(parts)
    if len(nodes.labels) != total:
        raise source.error(f"announces {total} nodes, its blocks hold {len(nodes.labels)}")
    return nodes


def _elements_4(source: _Bytes, sections: Mapping[str, int], groups: Groups) -> tuple[TypeRows, ...]:
    source.open(sections, "Elements")
    blocks, total, *_ = source.integers("u8", 4)
    parts, found = [], 0
    for _ in range(min(blocks, len(source.data))):
        dimension, entity, kind = source.integers("i4", 3)
        (count,) = source.integers("u8", 1)
        width, found = node_count(kind), found + count
        if width is None:
            refuse(source.file, [unknown_type(kind, count, 0)])
        if not 0 <= dimension <= 3:
            raise source.error("must have a dimension between 0 and 3")
        size = 1 + (width or 0)
        rows = _labels(source, source.array("u8", count * size)).reshape(count, size)
        physical = groups.get((dimension, entity), ())
        parts.append(
            TypeRows(kind, dimension, physical, rows[:, 0], rows[:, 1:], np.zeros(count, dtype=np.int64))
        )
    source.close()
    if found != total:
        raise source.error(f"announces {total} elements, its blocks hold {found}")
    return tuple(parts)


def _count_line(source: _Bytes) -> int:
    text = source.line()
    if not (text.isascii() and text.isdigit() and len(text) < 16):
        raise source.error("must begin with a count")
    return int(text)


def _nodes_2(source: _Bytes, sections: Mapping[str, int]) -> NodeRows:
    source.open(sections, "Nodes")
    count = _count_line(source)
    rows = source.array([("label", "i4", 1), ("point", "f8", 3)], count)
    source.close()
    labels = rows["label"][:, 0].astype(np.int64)
    none = np.zeros(count, dtype=np.int64)
    return NodeRows(labels, rows["point"].astype(np.float64), none, none)


def _elements_2(source: _Bytes, sections: Mapping[str, int]) -> tuple[TypeRows, ...]:
    source.open(sections, "Elements")
    total, found = _count_line(source), 0
    tables: dict[tuple[int, int], list[IntArray]] = {}
    while found < total:
        kind, count, tags = source.integers("i4", 3)
        width = node_count(kind)
        if width is None:
            refuse(source.file, [unknown_type(kind, count, 0)])
        if count < 1 or not 0 <= tags <= 1000:
            raise source.error("must have a positive number of elements and at most 1000 tags in a block")
        size = 1 + tags + (width or 0)
        rows = source.array("i4", count * size).reshape(count, size).astype(np.int64)
        tables.setdefault((kind, tags), []).append(rows)
        found += count
    source.close()
    if found != total:
        raise source.error(f"announces {total} elements, its blocks hold {found}")
    parts, entities = [], []
    for (kind, tags), tables_of in tables.items():
        rows = np.concatenate(tables_of)
        physical = np.abs(rows[:, 1]) if tags >= 1 else np.zeros(len(rows), dtype=np.int64)
        entity = rows[:, 2] if tags >= 2 else np.zeros(len(rows), dtype=np.int64)
        for group in np.unique(physical).tolist():
            own = rows[physical == group]
            tagged = (group,) if group else ()
            lines = np.zeros(len(own), dtype=np.int64)
            parts.append(TypeRows(kind, dimension_of(kind), tagged, own[:, 0], own[:, 1 + tags :], lines))
            entities.append(entity[physical == group])
    return once_per_element(parts, entities)
