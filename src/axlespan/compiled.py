"""Machine code by numba, where it is installed: compiled when first needed, kept on disk, and said so."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

Loop = Callable[..., Any]


@cache
def numba_is_there() -> bool:
    """Whether loops can be compiled here."""
    try:
        import numba  # noqa: F401
    except ImportError:
        return False
    return True


def compiled(loop: Loop) -> Loop | None:
    """Return a loop as machine code, or None without numba; it is compiled, or read from disk, at its first call.

    Products and sums may be fused (FMA) but are not reordered: the same input gives the same numbers at every
    run. The loop does not hold Python's lock.
    """
    if not numba_is_there():
        return None
    import numba

    options: dict[str, Any] = {"nogil": True, "fastmath": {"contract"}}
    try:
        made: Loop = numba.njit(cache=True, **options)(loop)
    except RuntimeError:  # no folder to keep the machine code in
        return numba.njit(**options)(loop)  # type: ignore[no-any-return, unused-ignore]
    _watch_sources(made, loop)
    return made


def _watch_sources(made: Any, loop: Loop) -> None:
    """Have machine code on disk made anew when the source of anything that a loop calls, or a constant, has changed.

    Numba looks at the time and size of the loop's own file alone: what it calls is part of the machine code, and
    files of a package may all bear the same time.
    """
    index: Any = getattr(getattr(made, "_cache", None), "_cache_file", None)
    if index is not None and hasattr(index, "_source_stamp"):
        index._source_stamp = (index._source_stamp, tuple(sorted(_ingredients(loop, set()))))


def _ingredients(loop: Loop, seen: set[Loop]) -> set[str]:
    """Fingerprints of the files of a loop and all loops that it calls, and the constants that they use."""
    if loop in seen:
        return set()
    seen.add(loop)
    found = {_fingerprint(loop.__code__.co_filename)}
    for name in loop.__code__.co_names:
        value = loop.__globals__.get(name)
        called = getattr(value, "py_func", None) or getattr(
            value, "_defn", None
        )  # loops, and numba's intrinsics
        if called is not None:
            found |= _ingredients(called, seen)
        elif isinstance(value, int | float):
            found.add(f"{name} = {value!r}")
    return found


@cache
def _fingerprint(file: str) -> str:
    try:
        return hashlib.sha256(Path(file).read_bytes()).hexdigest()
    except OSError:
        return file


def as_compiled(loop: Loop) -> Loop:
    """Return a loop as machine code, or as it is without numba: for loops that call one another.

    It takes numba's import; so modules of such loops are imported late.
    """
    return compiled(loop) or loop


@contextmanager
def when_compiling(say: Callable[[bool], None]) -> Iterator[None]:
    """Call ``say(True)`` when numba begins to compile and ``say(False)`` when it is done; not when it reads from disk.

    Examples
    --------
    >>> with when_compiling(lambda begins: None):
    ...     pass
    """
    if not numba_is_there():
        yield
        return
    from numba.core.event import Listener, install_listener

    class Announcer(Listener):
        def on_start(self, event: object) -> None:
            say(True)

        def on_end(self, event: object) -> None:
            say(False)

    with install_listener("numba:compile", Announcer()):
        yield
