"""Load trains: moving axle forces of standards and of real trains, and static load models as numbers."""

from axlespan.vehicles.load_trains.fatigue_trains import fatigue
from axlespan.vehicles.load_trains.hslm import hslm_a, hslm_b
from axlespan.vehicles.load_trains.line_categories import en15528
from axlespan.vehicles.load_trains.load_train import LoadTrain
from axlespan.vehicles.load_trains.registry import entries, entry, names, vehicle
from axlespan.vehicles.load_trains.static import LM71, STATIC, SW0, SW2, UNLOADED, StaticLoadModel
from axlespan.vehicles.load_trains.table import read_axles

__all__ = [
    "LM71",
    "STATIC",
    "SW0",
    "SW2",
    "UNLOADED",
    "LoadTrain",
    "StaticLoadModel",
    "en15528",
    "entries",
    "entry",
    "fatigue",
    "hslm_a",
    "hslm_b",
    "names",
    "read_axles",
    "vehicle",
]
