"""Files that are there whole or not at all, and the lock of a folder."""

from __future__ import annotations

import os
import secrets
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Final

from axlespan.errors import InputError, Place

PARTIAL: Final = ".partial-"
"""Beginning of the names of files that are being written; readers of tables overlook them."""


def write_whole(path: Path, content: bytes) -> None:
    """Write a file under another name and move it to its place; what is there survives a power cut.

    Raises
    ------
    OSError
        If there is no room; nothing is left of the file then.
    """
    partial = path.with_name(f"{PARTIAL}{os.getpid()}-{secrets.token_hex(4)}{path.suffix}")
    try:
        with open(partial, "wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(partial, path)
    except BaseException:
        with suppress(OSError):
            partial.unlink()
        raise
    settle(path.parent)


def settle(folder: Path) -> None:
    """Bring the names in a folder to the disk, where the system can."""
    with suppress(OSError, AttributeError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other runs off a folder; the system lifts the lock of a process that is gone.

    Raises
    ------
    InputError
        If another run has it.
    """
    path = folder / ".lock"
    try:
        stream = open(path, "a+", encoding="utf-8")  # noqa: SIM115
    except OSError as error:
        words = error.strerror or str(error)
        raise InputError(f"cannot be written to: {words}", place=Place(str(folder))) from None
    try:
        if not _lock(stream):
            stream.seek(0)
            owner = stream.read().strip() or "another process"
            raise InputError(
                f"is in use by {owner}",
                place=Place(str(folder)),
                fix="Wait until it ends, or name another folder with -o",
            )
        with suppress(OSError):  # a full disk keeps nobody out
            stream.seek(0)
            stream.truncate()
            stream.write(f"process {os.getpid()} on {socket.gethostname()}")
            stream.flush()
        yield
    finally:
        with suppress(OSError):
            stream.close()


def _lock(stream: IO[str]) -> bool:
    try:
        import fcntl
    except ImportError:  # Windows
        return _lock_on_windows(stream)
    try:
        fcntl.flock(stream.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks: two runs are not kept apart there
        return True
    return True


def _lock_on_windows(stream: IO[str]) -> bool:
    import msvcrt

    try:
        stream.seek(1 << 20)  # beyond the text, which others may read
        msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined, unused-ignore]
    except OSError:
        return False
    return True
