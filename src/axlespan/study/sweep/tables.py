"""The table of scenarios on the disk: parts in Parquet, one row for each scenario that is done."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

#: Kinds of columns, by their words: what a header calls them, and what pyarrow does.
KINDS: Mapping[str, str] = {"int": "int64", "number": "float64", "text": "string", "flag": "bool_"}


def parts_of(table: Path) -> list[Path]:
    """Parts of a table; names that begin with a point are of files that are not complete."""
    return sorted(part for part in table.glob("*.parquet") if not part.name.startswith("."))


def column_of(table: Path, name: str) -> list[Any]:
    """A column of all parts, in their order."""
    import pyarrow.parquet as pq

    values: list[Any] = []
    for part in parts_of(table):
        values += pq.read_table(part, columns=[name], partitioning=None).column(name).to_pylist()
    return values


def table_of(rows: Sequence[Mapping[str, Any]], columns: Mapping[str, str]) -> Any:
    """Rows as a table of pyarrow with columns of these kinds; what is not there is null."""
    import pyarrow as pa

    types = {kind: getattr(pa, name)() for kind, name in KINDS.items()}
    schema = pa.schema([(name, types[kind]) for name, kind in columns.items()])
    arrays = [
        pa.array([_fitting(row.get(name), kind) for row in rows], type=types[kind])
        for name, kind in columns.items()
    ]
    return pa.Table.from_arrays(arrays, schema=schema)


def as_parquet(table: Any) -> bytes:
    """A table as the bytes of a file, with checksums."""
    import pyarrow.parquet as pq

    content = BytesIO()
    pq.write_table(table, content, compression="zstd", write_page_checksum=True)
    return content.getvalue()


def _fitting(value: Any, kind: str) -> Any:
    """A value as its column takes it."""
    if value is None:
        return None
    if kind == "number":
        try:
            return float(value)
        except (TypeError, ValueError):
            return None
    if kind == "int":
        return int(value)
    return bool(value) if kind == "flag" else str(value)
