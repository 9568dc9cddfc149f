"""The study file: a base case, and what varies around it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from axlespan.errors import InputError, Place
from axlespan.study import loader
from axlespan.study.checks import Measured, OneOf, Whole, Word
from axlespan.study.faults import InputErrors
from axlespan.study.source import Source
from axlespan.study.sweep.axes import Axis, Chance, Values, sampled, varied
from axlespan.study.sweep.chance import Sampling, sampling_of
from axlespan.study.sweep.node import Node
from axlespan.study.sweep.paths import found
from axlespan.study.sweep.recording import Recording, recording_of
from axlespan.study.sweep.trains import trains_of
from axlespan.study.yaml_tree import read_yaml
from axlespan.units import TIME

KEYS: Final = (
    "title",
    "base",
    "vary",
    "zip",
    "sampling",
    "trains",
    "passage",
    "histories",
    "records",
)
LASTING: Final = 100_000_000
"""Steps of a base whose runs last as long as their passage."""

HISTORIES: Final = (
    "sensor_displacement",
    "sensor_velocity",
    "sensor_acceleration",
    "contact_force",
    "vehicle_acceleration",
)
_VARY: Final = "vary: {crossing.speed: {from: 140 km/h, to: 420 km/h, step: 5 km/h}}"


@dataclass(frozen=True, eq=False)
class Base:
    """The case that everything varies around, as it is written."""

    data: Mapping[str, Any]
    source: Source
    folder: Path  # that names of files are relative to


@dataclass(frozen=True)
class Kept:
    """Histories that a study keeps."""

    variables: tuple[str, ...]
    every: int = 1


@dataclass(frozen=True, eq=False)
class Spec:
    """A study file, read: nothing of the case has been validated yet."""

    source: Source
    title: str
    base: Base
    axes: tuple[Axis, ...]
    passage: float | None = (
        None  # time after the last wheel has left [s]; None: each run as long as the base says
    )
    kept: Kept | None = None
    recording: Recording | None = None
    sampling: Sampling | None = None
    notes: tuple[str, ...] = ()
    definition: Mapping[str, Any] = field(
        default_factory=dict
    )  # the study as it is written, without its title


def load_spec(path: str | os.PathLike[str], library: Sequence[str] = ()) -> Spec:
    """Read a study file.

    Raises
    ------
    InputError
        With file, line and column.
    """
    name = os.fspath(path)
    text = loader._read_text(name)
    document = read_yaml(text, name)
    if document.faults:
        raise InputErrors(document.faults)
    return read_spec(Node(document.data, Source(name, text, document.root)), Path(name).parent, library)


def is_study(data: Any) -> bool:
    """Whether the data of a YAML file are those of a study."""
    return isinstance(data, Mapping) and ("vary" in data or "base" in data)


def is_study_file(path: str | os.PathLike[str]) -> bool:
    """Whether a file holds a study; one that cannot be read holds none."""
    name = os.fspath(path)
    try:
        return is_study(read_yaml(loader._read_text(name), name).data)
    except InputError:
        return False


def read_spec(root: Node, folder: Path, library: Sequence[str] = ()) -> Spec:
    """Read the data of a study file; ``folder`` is where it stands."""
    if isinstance(root.data, Mapping) and "structure" in root.data and not is_study(root.data):
        fix = f"axlespan run computes it; a study has base: {Path(root.source.file).name} and {_VARY}"
        raise InputError("is a case, not a study", place=Place(root.source.file), fix=fix)
    parts = root.keys(KEYS, f"base: case.yaml and {_VARY}")
    for key, fix in (("base", "Add base: case.yaml, or a whole case"), ("vary", f"Add {_VARY}")):
        if key not in parts:
            raise root.source.blame((key,), "is missing", fix)
    base = _base(parts["base"], folder)
    sampling = sampling_of(parts["sampling"]) if "sampling" in parts else None
    chosen = _varied(parts, base, library, sampling)
    axes = (*_zipped(parts.get("zip"), [one for one in chosen if isinstance(one, Values)]),)
    chances = [one for one in chosen if isinstance(one, Chance)]
    if chances:
        assert sampling is not None  # _varied asks for it
        axes = (*axes, sampled(chances, sampling))
    elif sampling is not None:
        fix = "Add {distribution: ...} to a path of vary, or delete sampling"
        raise parts["sampling"].fault("has no random variable to sample", fix)
    passage = _passage(parts["passage"]) if "passage" in parts else None
    return Spec(
        source=root.source,
        title=parts["title"].checked(Word(folded=True)) if "title" in parts else "",
        base=_lasting(base, passage),
        axes=axes,
        passage=passage,
        kept=_kept(parts["histories"]) if "histories" in parts else None,
        recording=recording_of(parts["records"]) if "records" in parts else None,
        sampling=sampling,
        notes=tuple(sampling.notes) if sampling else (),
        definition={key: root.data[key] for key in root.data if key not in ("title", "base")},
    )


def _base(node: Node, folder: Path) -> Base:
    if isinstance(node.data, Mapping):
        root: Any = node.source.root.children
        return Base(node.data, Source(node.source.file, node.source.text, root["base"]), folder)
    if not isinstance(node.data, str) or not node.data.strip():
        raise node.fault("must be the name of a case file, or a case", "Write base: case.yaml")
    path = folder / node.data.strip()
    try:
        text = loader._read_text(str(path))
    except InputError as error:
        raise node.fault(error.rule, error.fix) from None
    document = read_yaml(text, str(path))
    if document.faults:
        raise InputErrors(document.faults)
    source = Source(str(path), text, document.root)
    if is_study(document.data):
        raise node.fault("is a study itself, not a case")
    if not isinstance(document.data, Mapping):
        raise InputError("must be keys and values", place=Place(str(path)))
    return Base(document.data, source, path.parent)


def _lasting(base: Base, passage: float | None) -> Base:
    """The base with a number of steps that nothing reaches, where every run lasts as long as its passage."""
    analysis = base.data.get("analysis")
    if passage is None or not isinstance(analysis, Mapping):
        return base
    own = {key: value for key, value in analysis.items() if key != "duration"}
    return replace(base, data={**base.data, "analysis": {**own, "steps": LASTING}})


def _varied(
    parts: Mapping[str, Node], base: Base, library: Sequence[str], sampling: Sampling | None
) -> list[Values | Chance]:
    trains = trains_of(parts.get("trains"), library)
    chosen: list[Values | Chance] = []
    faults: list[InputError] = []
    for path, node in parts["vary"].entries("paths and their values", _VARY):
        try:
            if node.data is None:
                raise node.fault("is empty", "Write a list, or {from: 140 km/h, to: 420 km/h, step: 5 km/h}")
            one = varied(path, node, trains, lambda path: found(base.data, path))
            if isinstance(one, Chance) and sampling is None:
                fix = "Add sampling: {method: latin-hypercube, count: 100, seed: 1} to the study"
                raise node.fault("is random, and sampling is missing", fix)
            chosen.append(one)
        except InputError as error:
            faults.append(error)
    if not chosen and not faults:
        raise parts["vary"].fault("holds nothing that varies", f"Write {_VARY}")
    if faults:
        raise InputErrors(faults)
    _require_apart(chosen)
    _require_what_is_random(chosen, base)
    return chosen


def _require_apart(chosen: Sequence[Values | Chance]) -> None:
    """Require that no path holds another one."""
    for one in chosen:
        for other in chosen:
            if other is not one and one.path.startswith(f"{other.path}."):
                raise one.node.source.blame_key(
                    one.node.path, f"lies within {other.path}, which varies too", "Keep one of the two"
                )


def _require_what_is_random(chosen: Sequence[Values | Chance], base: Base) -> None:
    """Require that the base has, or other paths make, what seeds belong to."""
    for one in chosen:
        whole = one.path.rpartition(".")[0]
        if not whole or not isinstance(one, Values) or not isinstance(one.values, range):
            continue
        made = any(other is not one and other.path.startswith(f"{whole}.") for other in chosen)
        if not made and found(base.data, whole) is None:
            fix = "Add it to the base, such as {kind: spectrum, name: fra-6, seed: 1}"
            raise one.node.source.blame_key(
                one.node.path, f"needs {whole}, which the base does not have", fix
            )


def _zipped(node: Node | None, values: Sequence[Values]) -> list[Axis]:
    """One axis for each path, or for each group that is zipped; in the order of ``vary``."""
    by_path = {one.path: one for one in values}
    group_of: dict[str, tuple[str, ...]] = {}
    for group in node.items("groups of paths", "zip: [[structure.length, crossing.speed]]") if node else ():
        items = group.items("paths", "[structure.length, crossing.speed]")
        for item in items:
            if item.data not in by_path:
                raise item.fault(
                    "is not among the lists of vary", "Name paths that have lists, ranges or seeds under vary"
                )
            if item.data in group_of:
                raise item.fault("is zipped already")
            first = items[0].data
            if len(by_path[item.data]) != len(by_path[first]):
                raise item.fault(
                    f"has {len(by_path[item.data])} values, and {first} has {len(by_path[first])}",
                    "Zipped lists must be equally long",
                )
        names = tuple(item.data for item in items)
        if len(set(names)) < len(names):
            raise group.fault("names a path twice")
        if len(names) < 2:
            raise group.fault("must name at least two paths")
        group_of |= dict.fromkeys(names, names)
    axes: list[Axis] = []
    for one in values:
        names = group_of.get(one.path, (one.path,))
        if one.path == next(path for path in by_path if path in names):
            axes.append(Axis(tuple(by_path[path] for path in by_path if path in names)))
    return axes


def _passage(node: Node) -> float:
    parts = node.keys(("after",), "passage: {after: 2 s}")
    if "after" not in parts:
        raise node.source.blame((*node.path, "after"), "is missing", "Write passage: {after: 2 s}")
    return float(parts["after"].checked(Measured(TIME, at_least=0.0)))


def _kept(node: Node) -> Kept:
    parts = node.keys(("variables", "every"), "histories: {variables: [sensor_acceleration], every: 5}")
    if "variables" not in parts:
        fix = "Add variables: [sensor_acceleration]"
        raise node.source.blame((*node.path, "variables"), "is missing", fix)
    items = parts["variables"].items("names of histories", "[sensor_acceleration]")
    names = tuple(item.checked(OneOf(HISTORIES)) for item in items)
    every = int(parts["every"].checked(Whole())) if "every" in parts else 1
    return Kept(tuple(dict.fromkeys(names)), every)
