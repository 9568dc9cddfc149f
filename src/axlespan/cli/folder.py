"""The folder of a run: claimed before it computes, filled in one go at its end, or left as it was."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from axlespan.errors import InputError, Place

_SUMMARY = "summary.json"  # comes last, and lists the files of a run
_STAGE = ".axlespan-"  # beginning of the names of folders in which results wait until they are complete


def check_folder(folder: Path, force: bool) -> None:
    """Require a folder that is new or empty, unless old results may be replaced.

    Raises
    ------
    InputError
        If it exists and is not empty, or is no folder.
    """
    place = Place(str(folder))
    try:
        is_file = folder.exists() and not folder.is_dir()
        old = [] if is_file or not folder.exists() else [entry.name for entry in folder.iterdir()]
    except (OSError, ValueError) as error:
        raise _unusable(folder, error) from None
    if is_file:
        raise InputError("is a file, not a folder", place=place, fix="Name another folder with -o")
    if not force and not all(name.startswith(_STAGE) for name in old):
        raise InputError(
            "exists already and is not empty",
            place=place,
            fix="Use --force to replace the results in it, or name another folder with -o",
        )


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Make a folder, and another one inside it for results that are not complete yet.

    What is left in the inner folder at the end is removed, and with it the folders that were made for it, if
    they are empty: a run that fails or is interrupted leaves nothing.

    Raises
    ------
    InputError
        If they cannot be made.
    """
    made = [path for path in (folder, *folder.parents) if not os.path.lexists(path)]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        stage = Path(tempfile.mkdtemp(prefix=_STAGE, dir=folder))
    except (OSError, ValueError) as error:
        _remove_empty(made)
        raise _unusable(folder, error) from None
    try:
        yield stage
    finally:
        shutil.rmtree(stage, ignore_errors=True)
        _remove_empty(made)


def publish(stage: Path, folder: Path) -> None:
    """Move complete results into their folder; those of an earlier run that have no successor go.

    Raises
    ------
    OSError
        If they cannot be moved.
    """
    new = [entry.name for entry in stage.iterdir()]
    if _SUMMARY in new:
        stale = [folder / name for name in _earlier(folder) if name not in new]
        (folder / _SUMMARY).unlink(missing_ok=True)  # until all is there, no summary speaks for it
        _remove(stale)
    for name in sorted(new, key=_SUMMARY.__eq__):
        target = folder / name
        if target.is_dir() and not target.is_symlink():
            shutil.rmtree(target)
        os.replace(stage / name, target)


def _earlier(folder: Path) -> list[str]:
    """Files of an earlier run in a folder, by its own summary."""
    try:
        summary = json.loads((folder / _SUMMARY).read_text(encoding="utf-8"))
        names = summary["files"] if summary["format"] == "axlespan summary" else []
    except (OSError, ValueError, KeyError, TypeError):
        return []
    return [name for name in names if isinstance(name, str) and name == os.path.basename(name)]


def _remove(files: Iterable[Path]) -> None:
    """Remove files; with a collection for ParaView the folder of its parts."""
    for path in files:
        if path.is_file() or path.is_symlink():
            path.unlink()
        if path.suffix == ".pvd":
            for part in path.with_suffix("").glob("*.vtu"):
                part.unlink()
            _remove_empty([path.with_suffix("")])


def _remove_empty(folders: Iterable[Path]) -> None:
    """Remove folders that are empty, the innermost first."""
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return


def _unusable(folder: Path, error: OSError | ValueError) -> InputError:
    words = getattr(error, "strerror", None) or str(error)
    return InputError(
        f"cannot be written to: {words}",
        place=Place(str(folder)),
        fix="Name a folder that you may write to with -o",
    )
