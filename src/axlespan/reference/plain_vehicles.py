"""Vehicles written out as dense matrices, term by term; nothing of the vehicle builder is used."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from axlespan.errors import InputError

from ._inputs import FloatArray, require_not_negative, require_positive


@dataclass(frozen=True)
class PlainVehicle:
    """Bodies and wheels of a vehicle in its plane; the last d.o.f. are the heights of the wheels.

    All motions are from the static position, upward positive; pitch turns the front down (right-handed
    about y, to the left), so that a point ahead of the center by a moves by -a pitch.
    """

    names: tuple[str, ...]  # of the d.o.f.
    mass: FloatArray  # (n, n) [kg, kg m2]
    damping: FloatArray  # (n, n) [Ns/m, ...]
    stiffness: FloatArray  # (n, n) [N/m, ...]
    weight: FloatArray  # (n,) mass that hangs on each d.o.f. [kg, kg m]
    behind: tuple[float, ...]  # wheels behind the first one [m]

    @property
    def free(self) -> int:
        """Number of d.o.f. that are no wheels."""
        return len(self.names) - len(self.behind)

    def static_loads(self, gravity: float) -> FloatArray:
        """Contact forces of the vehicle at rest on level ground, (wheel,) [N]."""
        n = self.free
        sag = np.linalg.solve(self.stiffness[:n, :n], -gravity * self.weight[:n])
        loads: FloatArray = self.stiffness[n:, :n] @ sag + gravity * self.weight[n:]
        return loads


class _Sheet:
    """Matrices that grow by masses and by springs between combinations of d.o.f."""

    def __init__(self, names: Sequence[str]) -> None:
        self.names = tuple(names)
        n = len(self.names)
        self.m, self.c, self.k, self.w = (np.zeros((n, n)) for _ in range(4))

    def row(self, **parts: float) -> FloatArray:
        """The combination that takes so much of each d.o.f."""
        row = np.zeros(len(self.names))
        for name, part in parts.items():
            row[self.names.index(name)] = part
        return row

    def inertia(self, row: FloatArray, value: float, *, heavy: bool = True) -> None:
        self.m += value * np.outer(row, row)
        if heavy:
            self.w[0] += value * row

    def spring(self, row: FloatArray, stiffness: float, damping: float) -> None:
        """A spring and a dashpot that feel the displacement of the combination."""
        self.k += stiffness * np.outer(row, row)
        self.c += damping * np.outer(row, row)

    def vehicle(self, behind: Sequence[float]) -> PlainVehicle:
        return PlainVehicle(self.names, self.m, self.c, self.k, self.w[0], tuple(behind))


def quarter_car(
    body: float, axle: float, suspension: tuple[float, float], tire: tuple[float, float]
) -> PlainVehicle:
    """Return a body over an axle over the contact point of a tire; springs [N/m] with dashpots [Ns/m]."""
    for field, mass in (("body", body), ("axle", axle)):
        require_positive(field, mass)
    sheet = _Sheet(["body", "axle", "wheel"])
    sheet.inertia(sheet.row(body=1.0), body)
    sheet.inertia(sheet.row(axle=1.0), axle)
    sheet.spring(sheet.row(body=1.0, axle=-1.0), *suspension)
    sheet.spring(sheet.row(axle=1.0, wheel=-1.0), *tire)
    return sheet.vehicle([0.0])


def half_car(
    body: tuple[float, float],
    axles: Sequence[tuple[float, float, float, float, float, float]],
) -> PlainVehicle:
    """Return a body on axles with tires.

    Parameters
    ----------
    body : (mass [kg], pitch inertia [kg m2])
    axles : sequence of (distance behind the body's center [m], mass [kg], k, c of the suspension, k, c of the tire)
        From the front.
    """
    count = len(axles)
    sheet = _Sheet(["z", "pitch", *(f"axle{i}" for i in range(count)), *(f"wheel{i}" for i in range(count))])
    sheet.inertia(sheet.row(z=1.0), body[0])
    sheet.inertia(sheet.row(pitch=1.0), body[1], heavy=False)
    for i, (at, mass, k, c, tire_k, tire_c) in enumerate(axles):
        sheet.inertia(sheet.row(**{f"axle{i}": 1.0}), mass)
        sheet.spring(sheet.row(z=1.0, pitch=at, **{f"axle{i}": -1.0}), k, c)
        sheet.spring(sheet.row(**{f"axle{i}": 1.0, f"wheel{i}": -1.0}), tire_k, tire_c)
    return sheet.vehicle([axle[0] - axles[0][0] for axle in axles])


def coach(
    *,
    body: tuple[float, float],
    bogie: tuple[float, float],
    wheelset: float,
    primary: tuple[float, float],
    secondary: tuple[float, float],
    bogie_centers: float,
    wheelbase: float,
) -> PlainVehicle:
    """Return a coach of ten d.o.f.: (mass, inertia) of body and bogies, k and c by wheelset and by bogie."""
    require_not_negative("wheelset", wheelset)
    wheels = [f"wheel{i}" for i in range(1, 5)]
    sheet = _Sheet(["body", "pitch", "bogie1", "pitch1", "bogie2", "pitch2", *wheels])
    sheet.inertia(sheet.row(body=1.0), body[0])
    sheet.inertia(sheet.row(pitch=1.0), body[1], heavy=False)
    for side, (name, turn) in enumerate((("bogie1", "pitch1"), ("bogie2", "pitch2"))):
        behind = (side - 0.5) * bogie_centers
        sheet.inertia(sheet.row(**{name: 1.0}), bogie[0])
        sheet.inertia(sheet.row(**{turn: 1.0}), bogie[1], heavy=False)
        sheet.spring(sheet.row(body=1.0, pitch=behind, **{name: -1.0}), *secondary)
        for k in range(2):
            wheel, arm = wheels[2 * side + k], (k - 0.5) * wheelbase
            sheet.inertia(sheet.row(**{wheel: 1.0}), wheelset)
            sheet.spring(sheet.row(**{name: 1.0, turn: arm, wheel: -1.0}), *primary)
    return sheet.vehicle([0.0, wheelbase, bogie_centers, bogie_centers + wheelbase])


@dataclass(frozen=True)
class Axle:
    """An axle of an articulated truck with its suspension and tires."""

    behind: float  # the center of gravity of the body that it carries [m]
    mass: float  # [kg]
    suspension: tuple[float, float]  # [N/m], [Ns/m]
    tire: tuple[float, float]  # [N/m], [Ns/m]


def articulated_truck(
    *,
    tractor: tuple[float, float],
    trailer: tuple[float, float],
    hinge: tuple[float, float],
    tractor_axles: Sequence[Axle],
    trailer_axles: Sequence[Axle],
) -> PlainVehicle:
    """Return a tractor and a semi-trailer on one hinge.

    The trailer's center moves by ``z2 = z1 + b pitch1 + a pitch2``, with b from the tractor's center back
    to the hinge and a from there to the trailer's center: ``hinge = (b, a)`` [m].
    """
    b, a = hinge
    axles = (*tractor_axles, *trailer_axles)
    if not axles:
        raise InputError("must have axles", field="tractor_axles", value=tractor_axles)
    count = len(axles)
    sheet = _Sheet(
        ["z", "pitch1", "pitch2", *(f"axle{i}" for i in range(count)), *(f"wheel{i}" for i in range(count))]
    )
    sheet.inertia(sheet.row(z=1.0), tractor[0])
    sheet.inertia(sheet.row(pitch1=1.0), tractor[1], heavy=False)
    sheet.inertia(sheet.row(z=1.0, pitch1=b, pitch2=a), trailer[0])
    sheet.inertia(sheet.row(pitch2=1.0), trailer[1], heavy=False)
    behind = []
    for i, axle in enumerate(axles):
        own = f"axle{i}"
        if i < len(tractor_axles):
            seat = {"z": 1.0, "pitch1": axle.behind}
            behind.append(axle.behind)
        else:
            seat = {"z": 1.0, "pitch1": b, "pitch2": a + axle.behind}
            behind.append(b + a + axle.behind)
        sheet.inertia(sheet.row(**{own: 1.0}), axle.mass)
        sheet.spring(sheet.row(**seat, **{own: -1.0}), *axle.suspension)
        sheet.spring(sheet.row(**{own: 1.0, f"wheel{i}": -1.0}), *axle.tire)
    return sheet.vehicle([x - behind[0] for x in behind])
