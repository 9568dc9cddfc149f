"""The ``axlespan`` command as a process: its streams, its signals, its exit codes."""

from __future__ import annotations

import io
import os
import signal
import sys
from typing import NoReturn

from axlespan.cli.app import app
from axlespan.cli.messages import FAILED, INTERRUPTED, warn


def main() -> NoReturn:
    """Entry point of the ``axlespan`` command."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # where a character cannot be shown, a question mark is
            stream.reconfigure(errors="replace")
    signal.signal(signal.SIGTERM, _stop)
    try:
        app()
    except SystemExit as end:
        sys.exit(_flushed(end.code))
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    except MemoryError:
        sys.exit(_last_words("there is not enough memory"))
    except OSError as error:  # of the standard output; the commands report those of files
        sys.exit(_last_words(f"the answer cannot be written: {error.strerror or error}"))
    sys.exit(0)


def _stop(number: int, frame: object) -> NoReturn:
    """End in order, as a batch system asks for before it kills: nothing half stays behind."""
    sys.exit(128 + number)


def _flushed(code: str | int | None) -> str | int | None:
    """The exit code, once the answer has left: a full disk shows here, or a reader that stopped reading."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except BrokenPipeError:
        _silence()
    except OSError as error:
        return _last_words(f"the answer cannot be written: {error.strerror or error}")
    return code


def _last_words(text: str) -> int:
    _silence()
    warn(text)
    return FAILED


def _silence() -> None:
    """Let the interpreter flush into nothing at its end."""
    try:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (AttributeError, OSError, ValueError):  # no real stream
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
