"""What the commands say, and their exit codes."""

from __future__ import annotations

import sys

from axlespan.errors import InputError

DONE, WRONG_INPUT, FAILED, INTERRUPTED = 0, 2, 3, 130


def refuse(error: InputError) -> int:
    """Print what is wrong with the input; the exit code for it."""
    warn(str(error) if "\n" not in str(error) else f"\n{error}")
    return WRONG_INPUT


def say(text: str = "") -> None:
    """Print a line of a command's answer."""
    print(text)  # noqa: T201


def warn(text: str) -> None:
    """Print a line on the error stream, if there is one."""
    if sys.stderr is not None:  # a closed one is None
        print(f"axlespan: {text}".replace(": \n", ":\n", 1), file=sys.stderr)  # noqa: T201
