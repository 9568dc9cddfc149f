"""Machine code by numba, where it is installed: compiled when first needed, kept on disk, and said so."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
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
        made = numba.njit(**options)(loop)
    return made


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
