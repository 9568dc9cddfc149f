"""Bridges and track: builders of structures from a few numbers."""

from axlespan.bridges.frames import Column, frame
from axlespan.bridges.grid import GridBeam, beam_grid
from axlespan.bridges.multi_span import simple_spans
from axlespan.bridges.rails import RAILS, Rail
from axlespan.bridges.spans import SupportAt, continuous_beam, simple_span
from axlespan.bridges.stations import Station
from axlespan.bridges.track import Layer, Track, Zone
from axlespan.bridges.track_builders import ballasted_track, slab_track
from axlespan.bridges.track_layout import least_approach, usual_approach
from axlespan.bridges.track_presets import PRESETS, TrackPreset
from axlespan.bridges.unilateral import with_unilateral_springs
from axlespan.bridges.with_track import track_on_ground, with_track

__all__ = [
    "PRESETS",
    "RAILS",
    "Column",
    "GridBeam",
    "Layer",
    "Rail",
    "Station",
    "SupportAt",
    "Track",
    "TrackPreset",
    "Zone",
    "ballasted_track",
    "beam_grid",
    "continuous_beam",
    "frame",
    "least_approach",
    "simple_span",
    "simple_spans",
    "slab_track",
    "track_on_ground",
    "usual_approach",
    "with_track",
    "with_unilateral_springs",
]
