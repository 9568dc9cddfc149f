"""What the commands say on the error stream, and their exit codes."""

from __future__ import annotations

import sys

from axlespan.errors import InputError

DONE, WRONG_INPUT, FAILED = 0, 2, 3


def refuse(error: InputError) -> int:
    """Print what is wrong with the input; the exit code for it."""
    print(f"axlespan: {error}" if "\n" not in str(error) else f"axlespan:\n{error}", file=sys.stderr)  # noqa: T201
    return WRONG_INPUT


def say(text: str = "") -> None:
    """Print a line of a command's answer."""
    print(text)  # noqa: T201


def warn(text: str) -> None:
    """Print a line on the error stream."""
    print(f"axlespan: {text}", file=sys.stderr)  # noqa: T201
