"""The store of a study: one folder that grows part by part, and is right at any moment.

    store.json            what the study is, and the columns of the table
    study.yaml, base.yaml the files as they were
    table/*.parquet       one row for each scenario that is done
    histories/*.nc        histories, several scenarios in a file
    records/*.nc          records of sensors, likewise
    summary.json          answers, when the study is complete

Files appear whole, histories before the rows that name them. Only the process that runs the study writes.
"""

from __future__ import annotations

import importlib
import json
import shutil
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

import axlespan
from axlespan.errors import InputError, Place
from axlespan.io.strict_json import to_json
from axlespan.study.sweep.files import locked, settle, write_whole
from axlespan.study.sweep.mending import SHARDS, TABLE, mend
from axlespan.study.sweep.recipe import digest
from axlespan.study.sweep.shards import Histories, shard_bytes
from axlespan.study.sweep.tables import as_parquet, column_of, parts_of, table_of
from axlespan.study.sweep.workshop import Done

if TYPE_CHECKING:
    import pandas

IntArray = npt.NDArray[np.int64]

FORMAT_VERSION: Final = 1
HEADER: Final = "store.json"

# A part of the table is written when so many rows, bytes of histories or seconds have come together.
_ROWS, _BYTES, _SECONDS = 5000, 64e6, 5.0


@dataclass(frozen=True)
class Header:
    """What a store is of."""

    digest: str  # of the study
    scenarios: int
    columns: Mapping[str, str]  # name -> int, number, text, flag
    title: str = ""
    paths: tuple[str, ...] = ()
    version: str = axlespan.__version__

    def text(self) -> str:
        """As JSON."""
        content = {
            "format": "axlespan study",
            "format_version": FORMAT_VERSION,
            "version": self.version,
            "title": self.title,
            "digest": self.digest,
            "scenarios": self.scenarios,
            "paths": list(self.paths),
            "columns": dict(self.columns),
        }
        return to_json(content, indent=2) + "\n"


@dataclass(eq=False)
class Store:
    """A store that is open for writing, or for reading."""

    folder: Path
    header: Header
    mended: tuple[str, ...] = ()  # what was damaged when it was opened, and is done again
    _waiting: list[Done] = field(default_factory=list)
    _since: float = field(default_factory=time.monotonic)

    # --- opening -------------------------------------------------------------------------------

    @classmethod
    def open(cls, folder: Path) -> Store:
        """A store for reading.

        Raises
        ------
        InputError
            If there is none, or it is of a later version.
        """
        return cls(folder, _read_header(folder))

    @classmethod
    @contextmanager
    def for_writing(
        cls, folder: Path, header: Header, texts: Mapping[str, str], *, resume: bool
    ) -> Iterator[Store]:
        """A store for writing, which nobody else has; made where there is none.

        Raises
        ------
        InputError
            If the folder holds something else, another study, or is in use.
        """
        _require_pyarrow()
        made = _require_room(folder, resume)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            words = error.strerror or str(error)
            raise InputError(f"cannot be made: {words}", place=Place(str(folder))) from None
        try:
            with locked(folder):
                if (folder / HEADER).exists():
                    _require_same(folder, header, resume)
                    header = _read_header(folder)
                    for name in [name for name in texts if not (folder / name).exists()]:
                        write_whole(folder / name, texts[name].encode())
                else:
                    _begin(folder, header, texts)
                store = cls(folder, header)
                store.mended = tuple(mend(folder, header.columns, header.scenarios))
                yield store
        finally:
            if made and not (folder / HEADER).exists():
                shutil.rmtree(folder, ignore_errors=True)

    # --- reading -------------------------------------------------------------------------------

    def done(self) -> IntArray:
        """Ids of the scenarios that have a row (n,), ascending."""
        return np.sort(np.array(column_of(self._table, "id"), dtype=np.int64))

    @property
    def _table(self) -> Path:
        return self.folder / TABLE

    def arrays(self, names: Sequence[str]) -> dict[str, npt.NDArray[Any]]:
        """Columns of the table by name (n_row,), ordered by id; numbers that are not there are NaN."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        wanted = [name for name in names if name in self.header.columns]
        parts = parts_of(self._table)
        if not parts:
            return {name: np.empty(0) for name in wanted}
        read = [
            pq.read_table(part, columns=list(dict.fromkeys(["id", *wanted])), partitioning=None)
            for part in parts
        ]
        whole = pa.concat_tables(read).sort_by("id")
        return {name: whole.column(name).to_numpy(zero_copy_only=False) for name in wanted}

    def table(self) -> pandas.DataFrame:
        """The table of scenarios, by id.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError:
            raise InputError(
                "is not installed", field="pandas", fix="pip install 'axlespan[study]'"
            ) from None
        parts = parts_of(self._table)
        if not parts:
            return pd.DataFrame(columns=list(self.header.columns)).set_index("id")
        frame = pd.read_parquet(self.folder / TABLE)
        return frame.sort_values("id").set_index("id")

    # --- writing -------------------------------------------------------------------------------

    def add(self, done: Done) -> bool:
        """Take what came of a task; whether it has been written.

        Raises
        ------
        OSError
            If it cannot be written; nothing of it is in the store then.
        """
        self._waiting.append(done)
        rows = sum(len(one.rows) for one in self._waiting)
        size = sum(one.histories.nbytes for one in self._waiting if one.histories is not None)
        size += sum(one.records.nbytes for one in self._waiting if one.records is not None)
        if rows >= _ROWS or size >= _BYTES or time.monotonic() - self._since >= _SECONDS:
            self.flush()
            return True
        return False

    def flush(self) -> None:
        """Write what is waiting.

        Raises
        ------
        OSError
        """
        waiting, self._waiting = self._waiting, []
        rows: list[dict[str, Any]] = []
        for done in waiting:
            names = {kind: self._write_shard(kind, getattr(done, kind)) for kind in SHARDS}
            rows += [
                {**row, **{kind: name for kind, name in names.items() if row["outcome"] == "completed"}}
                for row in done.rows
            ]
        if rows:
            rows.sort(key=lambda row: int(row["id"]))
            token = digest([row["id"] for row in rows])[:12]
            path = self.folder / TABLE / f"part-{rows[0]['id']:09d}-{token}.parquet"
            write_whole(path, as_parquet(table_of(rows, self.header.columns)))
        self._since = time.monotonic()

    def _write_shard(self, kind: str, histories: Histories | None) -> str | None:
        if histories is None or not histories.ids:
            return None
        folder = self.folder / kind
        folder.mkdir(exist_ok=True)
        token = digest(list(histories.ids))[:12]
        path = folder / f"{kind}-{histories.ids[0]:09d}-{token}.nc"
        about = {
            "format": f"axlespan study {kind}",
            "version": self.header.version,
            "study": self.header.digest,
        }
        write_whole(path, shard_bytes(histories, about))
        return path.name

    def compact(self) -> None:
        """Make one file of all parts, ordered by id; a kill in between loses nothing and doubles nothing."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        table, new, old = (self.folder / name for name in (TABLE, f"{TABLE}.new", f"{TABLE}.old"))
        parts = parts_of(self._table)
        if len(parts) < 2:
            return
        whole = pa.concat_tables([pq.read_table(part, partitioning=None) for part in parts]).sort_by("id")
        new.mkdir()
        write_whole(new / "scenarios.parquet", as_parquet(whole))
        table.rename(old)
        new.rename(table)
        settle(self.folder)
        shutil.rmtree(old, ignore_errors=True)

    def write_summary(self, content: Mapping[str, Any]) -> None:
        """Write the answers of the study.

        Raises
        ------
        OSError
        """
        write_whole(self.folder / "summary.json", (to_json(content, indent=2) + "\n").encode())


def _begin(folder: Path, header: Header, texts: Mapping[str, str]) -> None:
    try:
        (folder / TABLE).mkdir(exist_ok=True)
        for name, text in texts.items():
            write_whole(folder / name, text.encode())
        write_whole(folder / HEADER, header.text().encode())  # last: with it the store exists
    except OSError as error:
        for name in texts:
            with suppress(OSError):
                (folder / name).unlink(missing_ok=True)
        words = error.strerror or str(error)
        raise InputError(f"cannot be written to: {words}", place=Place(str(folder))) from None


def _require_pyarrow() -> None:
    try:
        importlib.import_module("pyarrow")
    except ImportError:
        raise InputError("is not installed", field="pyarrow", fix="pip install 'axlespan[study]'") from None


def _require_room(folder: Path, resume: bool) -> bool:
    """Require a folder that is new, empty or a store; whether it is new."""
    place = Place(str(folder))
    if not folder.exists():
        return True
    if not folder.is_dir():
        raise InputError("is a file, not a folder", place=place, fix="Name another folder with -o")
    try:
        entries = [entry.name for entry in folder.iterdir()]
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror or error}", place=place) from None
    if HEADER in entries:
        if not resume:
            fix = "Use --resume to compute what is missing, or name another folder with -o"
            raise InputError("holds a study already", place=place, fix=fix)
        return False
    if [
        name
        for name in entries
        if not name.startswith(".") and name not in (TABLE, "study.yaml", "base.yaml")
    ]:
        raise InputError("is not empty, and holds no study", place=place, fix="Name another folder with -o")
    return False


def _require_same(folder: Path, header: Header, resume: bool) -> None:
    known = _read_header(folder)
    place = Place(str(folder))
    if not resume:
        fix = "Use --resume to compute what is missing, or name another folder with -o"
        raise InputError("holds a study already", place=place, fix=fix)
    if known.digest != header.digest:
        raise InputError(
            "holds another study: its study.yaml or base.yaml, or a file that the base names, differs from these",
            place=place,
            fix="Name another folder with -o, or bring the study back to what it was",
        )
    if known.version != header.version:
        raise InputError(
            f"was begun by axlespan {known.version}; this is {header.version}, and numbers may differ",
            place=place,
            fix="Name another folder with -o",
        )


def _read_header(folder: Path) -> Header:
    place = Place(str(folder / HEADER))
    try:
        content = json.loads((folder / HEADER).read_text(encoding="utf-8"))
        if content["format"] != "axlespan study":
            raise KeyError
        version = int(content["format_version"])
    except FileNotFoundError:
        raise InputError(
            "holds no study", place=Place(str(folder)), fix="Run axlespan sweep study.yaml -o FOLDER"
        ) from None
    except (OSError, ValueError, LookupError, TypeError):
        raise InputError("is damaged, or no study of axlespan", place=place) from None
    if version > FORMAT_VERSION:
        raise InputError(
            f"was written in format {version}; this version reads up to {FORMAT_VERSION}", place=place
        )
    return Header(
        content["digest"],
        int(content["scenarios"]),
        content["columns"],
        content.get("title", ""),
        tuple(content.get("paths", ())),
        content["version"],
    )
