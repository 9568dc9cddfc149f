"""The command line: ``axlespan run``, ``check``, ``examples``, ``schema``, ``verify``."""

from axlespan.cli.entry import main

__all__ = ["main"]
