"""Axle forces of trains that run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from axlespan.vehicles.load_trains.load_train import ONE_SOURCE, LoadTrain
from axlespan.vehicles.simple import axle_loads
from axlespan.vehicles.vehicle import Vehicle

# Axle loads [kN] of the bogies of one set, and where their first axles are [m]; all have axles 3 m apart.
_AVE_LOADS = (172.1, 170.7, 131.6, 161.9, 169.2, 167.9, 160.5, 167.9, 169.2, 161.9, 131.6, 170.7, 172.1)
_AVE_BOGIES = (
    0.0, 14.0, 20.28, 38.98, 57.68, 76.38, 95.08, 113.78, 132.48, 151.18, 169.88, 176.16, 190.16,
)  # fmt: skip
_AVE_SET = 200.15  # from set to set [m]

# ICE 3: length of a car, axles of a car behind its first one [m]; axle loads of cars 1-3 and 6-8, and of 4 and 5 [kN].
_ICE3_CAR, _ICE3_AXLES, _ICE3_LENGTH = 24.775, (0.0, 2.5, 17.375, 19.875), 200.32
_ICE3_LOADS = (152.06, 135.87)

_SHINKANSEN_CAR, _SHINKANSEN_AXLES, _SHINKANSEN_LOAD = 25.0, (0.0, 2.5, 17.5, 20.0), 134.8


def _ave_s100() -> Vehicle:
    positions = np.add.outer(_AVE_BOGIES, [0.0, 3.0]).ravel()
    loads = 1e3 * np.repeat(_AVE_LOADS, 2)
    made = axle_loads(loads=loads.tolist(), positions=np.round(positions, 6).tolist())
    return replace(made, length=_AVE_SET)


def _ice3() -> Vehicle:
    positions = np.add.outer(_ICE3_CAR * np.arange(8), _ICE3_AXLES).ravel()
    cars = np.array([_ICE3_LOADS[car in (4, 5)] for car in range(1, 9)])
    loads = 1e3 * np.repeat(cars, 4)
    made = axle_loads(loads=loads.tolist(), positions=np.round(positions, 6).tolist())
    return replace(made, length=_ICE3_LENGTH)


def _shinkansen() -> Vehicle:
    made = axle_loads(loads=1e3 * _SHINKANSEN_LOAD, positions=list(_SHINKANSEN_AXLES))
    return replace(made, length=_SHINKANSEN_CAR)


def load_trains() -> list[LoadTrain]:
    """Real trains as axle forces."""
    return [
        LoadTrain(
            "ave-s100",
            "AVE S-100 (TGV type), one set of 26 axles; count: 2 is a double set",
            _ave_s100,
            "axle file ave.def of caldintav (Universidad Politécnica de Madrid)",
            ONE_SOURCE,
        ),
        LoadTrain(
            "ice3-axles",
            "ICE 3 Velaro E (AVE S-103), 8 cars, 32 axles",
            _ice3,
            "masses of Goicolea (2014), oa.upm.es/43946, by gravity 9.81 m/s^2",
            ONE_SOURCE,
            "axle loads computed from the masses; the total length equals that of the train",
        ),
        LoadTrain(
            "shinkansen-s300-axles",
            "Shinkansen series 300, one car; count: 16 is a train",
            _shinkansen,
            "masses of Wu and Yang (2003), by gravity 9.81 m/s^2",
            ONE_SOURCE,
            "axle loads computed from the masses",
            wagon=True,
        ),
    ]
