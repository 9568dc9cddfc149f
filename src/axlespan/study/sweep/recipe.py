"""What a worker needs to compute scenarios: the base, the paths that vary, and values for them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import axlespan
from axlespan import units
from axlespan.errors import InputError
from axlespan.study.source import Source
from axlespan.study.sweep.paths import placed
from axlespan.study.sweep.recording import Recording
from axlespan.study.sweep.spec import Kept, Spec
from axlespan.study.sweep.trains import HEADWAY


@dataclass(frozen=True, eq=False)
class Recipe:
    """How scenarios of a study are made from the values of its axes; small, and the same for all of them."""

    data: Mapping[str, Any]  # of the base case, as it is written
    source: Source  # of the base case, for messages
    folder: str  # that names of files are relative to
    paths: tuple[str, ...]
    passage: float | None
    kept: Kept | None
    recording: Recording | None
    files: Mapping[str, str]  # digests of the files that the base names
    version: str = axlespan.__version__

    @classmethod
    def of(cls, spec: Spec) -> Recipe:
        """The recipe of a study."""
        paths = tuple(path for axis in spec.axes for path in axis.paths)
        base = spec.base
        files = dict(_digests(base.data, base.folder))
        folder = str(base.folder.resolve())
        return cls(base.data, base.source, folder, paths, spec.passage, spec.kept, spec.recording, files)

    def composed(self, values: Sequence[Any]) -> Mapping[str, Any]:
        """The data of the case in which the paths have these values.

        Raises
        ------
        InputError
            If a path does not lead anywhere; its field is the path.
        """
        data: Any = self.data
        for path, value in zip(self.paths, values, strict=True):
            try:
                data = placed(data, path, value)
            except InputError as error:
                raise InputError(error.rule, field=path, fix=error.fix) from None
        return _with_gaps(data)

    def provenance(self, data: Mapping[str, Any], number: int) -> str:
        """Digest of all that the numbers of a scenario follow from; equal ones mean equal numbers."""
        records = None if self.recording is None else [repr(self.recording), number]
        content = [data, self.passage, records, dict(self.files), self.version]
        return digest(content)


def digest(content: Any) -> str:
    """SHA-256 of plain data, in hexadecimal digits."""
    text = json.dumps(content, sort_keys=True, default=str, ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()


def _with_gaps(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Headways [s] between the trains of a mix, as gaps [m]: time times speed."""
    train = data.get("train")
    if not isinstance(train, list | tuple) or not any(isinstance(e, Mapping) and HEADWAY in e for e in train):
        return data
    speed = data.get("crossing", {}).get("speed")
    try:
        value = units.parse(speed, units.SPEED)
    except InputError:
        raise InputError("needs a crossing.speed: a headway is a time", field="train") from None
    own = [
        {**{k: v for k, v in entry.items() if k != HEADWAY}, "gap": float(entry[HEADWAY]) * value}
        if HEADWAY in entry
        else entry
        for entry in train
    ]
    return {**data, "train": own}


def _digests(data: Any, folder: Path) -> list[tuple[str, str]]:
    """Digests of all files that data name, by their names."""
    if isinstance(data, Mapping):
        return [pair for value in data.values() for pair in _digests(value, folder)]
    if isinstance(data, list | tuple):
        return [pair for value in data for pair in _digests(value, folder)] if len(data) < 1000 else []
    if not isinstance(data, str) or "." not in data or len(data) > 200:
        return []
    try:
        path = folder / data.strip()
        return [(data, hashlib.sha256(path.read_bytes()).hexdigest())] if path.is_file() else []
    except (OSError, ValueError):
        return []
