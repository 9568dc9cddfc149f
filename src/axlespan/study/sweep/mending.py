"""What an interrupted run or a fault of the disk left in a store is put right before a run goes on.

Every part of the table is read as a whole, against its checksums. Files of histories that rows name must be there,
open, and hold these scenarios; their values are not read. What is damaged goes into the folder ``damaged``, and its
scenarios have no rows any more: they are done again.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import h5py
import numpy as np

from axlespan.study.sweep.files import PARTIAL, write_whole
from axlespan.study.sweep.tables import as_parquet, column_of, parts_of

TABLE: Final = "table"
SHARDS: Final = ("histories", "records")
DAMAGED: Final = "damaged"
"""Folder for files that could not be read."""


def mend(folder: Path, columns: Mapping[str, str], scenarios: int) -> list[str]:
    """Leave in a store only what is right; what was found damaged, a line each.

    Parameters
    ----------
    folder : Path
        Of the store, which nobody else writes to.
    columns : mapping
        Columns of its table.
    scenarios : int
        Of the study.

    Raises
    ------
    OSError
        If something cannot be renamed or written.
    """
    table, new, old = (folder / name for name in (TABLE, f"{TABLE}.new", f"{TABLE}.old"))
    if not table.exists() and new.exists():
        new.rename(table)  # it was complete when the old one was moved away
    for stale in (new, old):
        shutil.rmtree(stale, ignore_errors=True)
    table.mkdir(exist_ok=True)
    for name in (".", TABLE, *SHARDS):
        for partial in (folder / name).glob(f"{PARTIAL}*"):
            partial.unlink(missing_ok=True)
    said = _mended_parts(folder, [kind for kind in SHARDS if kind in columns], scenarios)
    for kind in SHARDS:
        named = set(column_of(table, kind)) if (folder / kind).exists() and kind in columns else set()
        for shard in (folder / kind).glob("*.nc"):
            if shard.name not in named:
                shard.unlink()
    return said


def _mended_parts(folder: Path, kinds: Sequence[str], scenarios: int) -> list[str]:
    """Keep the rows that can be trusted: those of parts that read, with histories that open, once each."""
    said: list[str] = []
    shards = {kind: _Shards(folder / kind) for kind in kinds}
    seen = np.zeros(scenarios, dtype=bool)
    for part in parts_of(folder / TABLE):
        try:
            rows = _read(part, ("id", "outcome", *kinds))
        except _unreadable() as error:
            _set_aside(part)
            said.append(
                f"{TABLE}/{part.name} cannot be read ({_words(error)}): it is in {DAMAGED}/ now, and its scenarios are "
                "done again"
            )
            continue
        ids = rows.column("id").to_numpy()
        completed = np.array(rows.column("outcome").to_pylist()) == "completed"
        good = np.ones(len(ids), dtype=bool)
        for kind, known in shards.items():
            good &= ~completed | known.hold(rows.column(kind).to_pylist(), ids, completed)
        new = _first(ids) & (ids >= 0) & (ids < scenarios)
        new[new] = ~seen[ids[new]]
        if not new.all():
            lost = _scenarios(int(np.count_nonzero(~new)))
            said.append(
                f"{TABLE}/{part.name} has {lost} that other rows have too, or that are none of the study"
            )
        _keep(part, good & new)
        seen[ids[good & new]] = True
    for kind, known in shards.items():
        said += [f"{kind}/{name} {words}" for name, words in known.faults.items()]
    return said


class _Shards:
    """Files of histories, opened once each when a row names them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.faults: dict[str, str] = {}  # what is wrong with files, by their names
        self._ids: dict[str, Any] = {}

    def hold(self, names: Sequence[str | None], ids: Any, wanted: Any) -> Any:
        """Whether the files that rows (n,) name hold their scenarios; rows that need none count as held."""
        held = np.ones(len(ids), dtype=bool)
        rows = np.flatnonzero(wanted)
        words = np.array([names[row] or "" for row in rows.tolist()], dtype=np.str_)
        files, which = np.unique(words, return_inverse=True)
        rows = rows[np.argsort(which, kind="stable")]
        for name, own in zip(files.tolist(), np.split(rows, np.cumsum(np.bincount(which))[:-1]), strict=True):
            held[own] = np.isin(ids[own], self._scenarios(name)) if name else False
            if name and not held[own].all() and name not in self.faults:
                lost = _scenarios(int(np.count_nonzero(~held[own])))
                self.faults[name] = f"lacks {lost} that rows look for in it: done again"
        return held

    def _scenarios(self, name: str) -> Any:
        if name not in self._ids:
            self._ids[name] = self._opened(name)
        return self._ids[name]

    def _opened(self, name: str) -> Any:
        """Ids in a file; none where it is missing, or cannot be read and is set aside."""
        path, none = self.folder / name, np.empty(0, dtype=np.int64)
        again = "the scenarios that it held are done again"
        if not path.is_file():
            self.faults[name] = f"is missing: {again}"
            return none
        try:
            with h5py.File(path, "r") as file:
                ids = np.asarray(file["scenario"], dtype=np.int64)
                lengths = {file[key].shape[0] for key in file if len(file[key].shape) == 3}
        except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError) as error:
            _set_aside(path)
            self.faults[name] = f"cannot be read ({_words(error)}): it is in {DAMAGED}/ now, and {again}"
            return none
        return ids if lengths == {len(ids)} else none


def _read(part: Path, names: Sequence[str]) -> Any:
    """Some columns of a part, all of which has been read."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    with pq.ParquetFile(part, page_checksum_verification=True) as file:
        schema = pa.schema([file.schema_arrow.field(name) for name in names])
        batches = [batch.select(list(names)) for batch in file.iter_batches()]
    return pa.Table.from_batches(batches, schema)


def _unreadable() -> tuple[type[Exception], ...]:
    import pyarrow as pa

    return (pa.ArrowException, OSError, KeyError, ValueError, TypeError)


def _keep(part: Path, rows: Any) -> None:
    """Keep some rows of a part; the file is there whole before and after."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    if rows.all():
        return
    if not rows.any():
        part.unlink()
        return
    table = pq.read_table(part, partitioning=None)
    write_whole(part, as_parquet(table.filter(pa.array(rows))))


def _first(ids: Any) -> Any:
    """Which ids (n,) are not among those before them."""
    first = np.zeros(len(ids), dtype=bool)
    first[np.unique(ids, return_index=True)[1]] = True
    return first


def _set_aside(path: Path) -> None:
    """Move a damaged file to where nobody reads it; one of this name that was there is overwritten."""
    aside = path.parent.parent / DAMAGED
    aside.mkdir(exist_ok=True)
    path.replace(aside / path.name)


def _words(error: BaseException) -> str:
    return " ".join(str(error).split())[:100].rstrip(". ") or type(error).__name__


def _scenarios(number: int) -> str:
    return f"{number} scenario" if number == 1 else f"{number} scenarios"
