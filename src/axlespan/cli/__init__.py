"""The command line: ``axlespan run``, ``check``, ``examples``, ``schema``, ``verify``."""

from axlespan.cli.app import main

__all__ = ["main"]
