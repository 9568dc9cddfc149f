"""Trains and trucks crossing bridges and track, by the direct method of Neves et al. (2012)."""

__version__ = "0.1.0"
