"""Static load models of EN 1991-2, 6.3, as numbers: forces, and loads per length."""

from __future__ import annotations

import math
from dataclasses import dataclass

from axlespan.vehicles.load_trains.load_train import CHECK


@dataclass(frozen=True)
class StaticLoadModel:
    """A load model that stands: positions count from its middle."""

    name: str
    title: str
    forces: tuple[tuple[float, float], ...]  # (position [m], force [N])
    distributed: tuple[tuple[float, float, float], ...]  # (from [m], to [m], load [N/m]); may be infinite
    source: str
    certainty: str = CHECK

    def scaled(self, factor: float) -> StaticLoadModel:
        """The same with all loads multiplied, as by the classification factor alpha."""
        return StaticLoadModel(
            self.name,
            f"{factor:g} × {self.title}",
            tuple((x, factor * force) for x, force in self.forces),
            tuple((begin, end, factor * load) for begin, end, load in self.distributed),
            self.source,
            self.certainty,
        )


#: Load model 71: four forces of 250 kN, 1.6 m apart; 80 kN/m from 0.8 m beyond them on.
LM71 = StaticLoadModel(
    "lm71",
    "Load model 71",
    ((-2.4, 250e3), (-0.8, 250e3), (0.8, 250e3), (2.4, 250e3)),
    ((-math.inf, -3.2, 80e3), (3.2, math.inf, 80e3)),
    "EN 1991-2:2003, figure 6.1",
)

#: Load model SW/0: 133 kN/m on 15 m, a gap of 5.3 m, and again.
SW0 = StaticLoadModel(
    "sw0", "Load model SW/0", (), ((-17.65, -2.65, 133e3), (2.65, 17.65, 133e3)), "EN 1991-2:2003, table 6.1"
)

#: Load model SW/2: 150 kN/m on 25 m, a gap of 7 m, and again.
SW2 = StaticLoadModel(
    "sw2", "Load model SW/2", (), ((-28.5, -3.5, 150e3), (3.5, 28.5, 150e3)), "EN 1991-2:2003, table 6.1"
)

#: The unloaded train: 10 kN/m.
UNLOADED = StaticLoadModel(
    "unloaded-train", "Unloaded train", (), ((-math.inf, math.inf, 10e3),), "EN 1991-2:2003, 6.3.4"
)

#: All of them by name.
STATIC = {model.name: model for model in (LM71, SW0, SW2, UNLOADED)}
