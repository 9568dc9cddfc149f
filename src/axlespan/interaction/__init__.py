"""Crossings and how they are simulated: the direct method and its rivals."""
