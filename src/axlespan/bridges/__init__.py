"""Bridges: builders of structures from a few numbers."""

from axlespan.bridges.spans import SupportAt, continuous_beam, simple_span

__all__ = ["SupportAt", "continuous_beam", "simple_span"]
