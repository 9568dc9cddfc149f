"""Mappings that come in several kinds, and the files that a case names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pydantic import Discriminator, GetCoreSchemaHandler, GetJsonSchemaHandler, Tag, ValidationInfo
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from axlespan.errors import InputError
from axlespan.study.checks import Part
from axlespan.study.faults import listed, nearest

_OPEN, _CLOSE = "<", ">"


def tag(name: str) -> Tag:
    """Return the mark of one kind in a union; it is told from a key of the file by its brackets."""
    return Tag(f"{_OPEN}{name}{_CLOSE}")


def is_tag(step: object) -> bool:
    """Whether a step of an error's location is the mark of a kind, and no key of the file."""
    return isinstance(step, str) and step.startswith(_OPEN) and step.endswith(_CLOSE)


@dataclass(frozen=True)
class Kinds:
    """Says which kind a mapping is, by the word that stands under one key.

    Parameters
    ----------
    what : str
        What comes in kinds, for messages: ``"structure"``.
    names : tuple of str
        The kinds.
    example : str
        Such a mapping.
    key : str
        Where the word stands.
    words_alone : tuple of str
        Kinds that may be written as a word without mapping: ``irregularity: none``.
    """

    what: str
    names: tuple[str, ...]
    example: str
    key: str = "kind"
    words_alone: tuple[str, ...] = ()

    def checked(self, raw: Any) -> Any:
        """Return the mapping if its kind is known."""
        if isinstance(raw, Part) and _kind_of(raw, self.key) in self.names:
            return raw
        if isinstance(raw, str) and raw in self.words_alone:
            return {self.key: raw}
        if not isinstance(raw, Mapping):
            alone = f"{listed(self.words_alone)}, or " if self.words_alone else ""
            near = nearest(raw, self.words_alone) if isinstance(raw, str) else None
            raise InputError(
                f"must be {alone}a mapping",
                value=raw,
                fix=f"Did you mean {near}?" if near else f"Write, for example, {self.example}",
            )
        if self.key not in raw:
            raise InputError(
                f"is missing; it says what kind of {self.what} this is",
                field=self.key,
                fix=f"Add {self.key}: {self.names[0]} (or {', '.join(self.names[1:])})",
            )
        word = raw[self.key]
        if word not in self.names:
            near = nearest(word, self.names) if isinstance(word, str) else None
            fix = f"Did you mean {near}?" if near else f"Known are {listed(self.names)}"
            raise InputError(f"no such kind of {self.what}", field=self.key, value=word, fix=fix)
        return raw

    def words_in_schema(self, schema: dict[str, Any]) -> None:
        """Add the kinds that may be written as a word alone to the JSON Schema of a field."""
        mappings = {key: schema.pop(key) for key in ("oneOf", "anyOf", "discriminator") if key in schema}
        schema["anyOf"] = [{"enum": list(self.words_alone)}, mappings]

    def discriminator(self) -> Discriminator:
        """Return what pydantic asks for the mark of a kind."""
        return Discriminator(lambda raw: f"{_OPEN}{_kind_of(raw, self.key)}{_CLOSE}")


def _kind_of(raw: Any, key: str) -> Any:
    return raw.get(key) if isinstance(raw, Mapping) else getattr(raw, key, None)


LIST: Final = tag("list")
"""Mark of a list, where a list or a mapping may stand."""
MAPPING: Final = tag("mapping")
"""Mark of a mapping, where a list or a mapping may stand."""


def list_or_mapping(raw: Any) -> str:
    """Return the mark of a mapping or, for all else, of a list."""
    return MAPPING.tag if isinstance(raw, (Mapping, Part)) else LIST.tag


class ExistingFile:
    """A file that the case names, relative to the folder of the case file (validation context ``folder``)."""

    def read(self, raw: Any, info: ValidationInfo, field: str | None = None) -> Path:
        """Return the path of the file, which exists; ``field`` is its key where it stands in a mapping."""
        if isinstance(raw, Path):
            raw = str(raw)
        if not isinstance(raw, str) or not raw.strip() or "\0" in raw:
            raise InputError("must be the name of a file", field=field, value=raw)
        folder = Path((info.context or {}).get("folder", "."))
        path = folder / raw.strip()
        try:
            found = path.is_file()
            others = [p.name for p in path.parent.iterdir()] if not found and path.parent.is_dir() else []
        except OSError as error:
            raise InputError(f"cannot be read: {error.strerror}", field=field, value=raw) from None
        if found:
            return path
        if path.is_dir():
            raise InputError("is a folder, not a file", field=field, value=raw)
        near = nearest(path.name, others, likeness=0.8)
        where = folder.resolve() if not path.is_absolute() else path.parent
        fix = f"Did you mean {near}?" if near else f"Names are relative to the case file's folder, {where}"
        raise InputError("no such file", field=field, value=raw, fix=fix)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return {"type": "string", "description": "File, relative to the folder of the case file."}
