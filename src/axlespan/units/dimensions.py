"""Kinds of quantities: what each is called, made of, written in and shown in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from axlespan.units.symbols import Exponents


@dataclass(frozen=True)
class Dimension:
    """A kind of quantity.

    Parameters
    ----------
    name : str
        With its article: ``"a length"``.
    exponents : Exponents
        Powers of m, kg, s and rad.
    unit : str
        The SI unit, which a plain number has.
    example : str
        How one writes such a quantity.
    shown : tuple of str
        Units for people to read, largest first.
    also : Exponents, optional
        A second spelling: a rotational stiffness may be given in Nm/rad or Nm.
    gravity : bool
        Whether ``g`` is the standard gravity here, and no gram.
    """

    name: str
    exponents: Exponents
    unit: str
    example: str
    shown: tuple[str, ...]
    also: Exponents | None = None
    gravity: bool = False

    @property
    def everyday(self) -> str:
        """The unit of the example."""
        return self.example.partition(" ")[2]

    def accepts(self, exponents: Exponents) -> bool:
        """Whether a unit with these powers measures this kind of quantity."""
        return exponents == self.exponents or (self.also is not None and exponents == self.also)


NUMBER: Final = Dimension("a number", (0, 0, 0, 0), "", "0.5", ("",))
RATIO: Final = Dimension("a pure number", (0, 0, 0, 0), "", "1 %", ("%",))
ANGLE: Final = Dimension("an angle", (0, 0, 0, 1), "rad", "2 mrad", ("rad", "mrad"))
LENGTH: Final = Dimension("a length", (1, 0, 0, 0), "m", "25 m", ("km", "m", "mm"))
AREA: Final = Dimension("an area", (2, 0, 0, 0), "m^2", "5.57 m^2", ("m^2", "cm^2", "mm^2"))
SECOND_MOMENT: Final = Dimension(
    "a second moment of area", (4, 0, 0, 0), "m^4", "2.90 m^4", ("m^4", "cm^4", "mm^4")
)
MASS: Final = Dimension("a mass", (0, 1, 0, 0), "kg", "5750 kg", ("t", "kg"))
INERTIA: Final = Dimension("a moment of inertia", (2, 1, 0, 0), "kg m^2", "1960 t m^2", ("t m^2", "kg m^2"))
MASS_PER_LENGTH: Final = Dimension("a mass per length", (-1, 1, 0, 0), "kg/m", "2303 kg/m", ("t/m", "kg/m"))
DENSITY: Final = Dimension("a density", (-3, 1, 0, 0), "kg/m^3", "2500 kg/m^3", ("t/m^3", "kg/m^3"))
TIME: Final = Dimension("a time", (0, 0, 1, 0), "s", "1 ms", ("s", "ms", "us"))
FREQUENCY: Final = Dimension("a frequency", (0, 0, -1, 0), "Hz", "4.8 Hz", ("kHz", "Hz"))
PER_TIME: Final = Dimension("a rate", (0, 0, -1, 0), "1/s", "0.2 1/s", ("1/s",))
SPEED: Final = Dimension("a speed", (1, 0, -1, 0), "m/s", "80 km/h", ("km/h",))
ACCELERATION: Final = Dimension(
    "an acceleration", (1, 0, -2, 0), "m/s^2", "9.81 m/s^2", ("m/s^2", "mm/s^2"), gravity=True
)
FORCE: Final = Dimension("a force", (1, 1, -2, 0), "N", "170 kN", ("MN", "kN", "N"))
MOMENT: Final = Dimension("a moment", (2, 1, -2, 0), "Nm", "12 kNm", ("MNm", "kNm", "Nm"))
PRESSURE: Final = Dimension("a pressure", (-1, 1, -2, 0), "Pa", "210 GPa", ("GPa", "MPa", "kPa", "Pa"))
STIFFNESS: Final = Dimension("a stiffness", (0, 1, -2, 0), "N/m", "1595 kN/m", ("MN/m", "kN/m", "N/m"))
ROTATIONAL_STIFFNESS: Final = Dimension(
    "a rotational stiffness",
    (2, 1, -2, -1),
    "Nm/rad",
    "50 MNm/rad",
    ("MNm/rad", "kNm/rad", "Nm/rad"),
    also=(2, 1, -2, 0),
)
HERTZ_STIFFNESS: Final = Dimension(
    "a Hertz stiffness", (-0.5, 1, -2, 0), "N/m^1.5", "1.15e11 N/m^1.5", ("N/m^1.5",)
)
DAMPING: Final = Dimension(
    "a damping constant", (0, 1, -1, 0), "Ns/m", "20 kNs/m", ("MNs/m", "kNs/m", "Ns/m")
)
ROTATIONAL_DAMPING: Final = Dimension(
    "a rotational damping constant",
    (2, 1, -1, -1),
    "Nms/rad",
    "20 kNms/rad",
    ("kNms/rad", "Nms/rad"),
    also=(2, 1, -1, 0),
)
DAMPING_PER_LENGTH: Final = Dimension(
    "a damping constant per length", (-1, 1, -1, 0), "Ns/m^2", "80 kNs/m^2", ("MNs/m^2", "kNs/m^2", "Ns/m^2")
)
BENDING_STIFFNESS: Final = Dimension(
    "a bending stiffness", (3, 1, -2, 0), "Nm^2", "100 MNm^2", ("GNm^2", "MNm^2", "kNm^2", "Nm^2")
)

_NAMED: Final = (
    *(RATIO, ANGLE, LENGTH, AREA, SECOND_MOMENT, MASS, INERTIA, MASS_PER_LENGTH, DENSITY, TIME, FREQUENCY),
    *(SPEED, ACCELERATION, FORCE, MOMENT, PRESSURE, STIFFNESS, ROTATIONAL_STIFFNESS, HERTZ_STIFFNESS),
    *(DAMPING, ROTATIONAL_DAMPING, DAMPING_PER_LENGTH, BENDING_STIFFNESS),
)


def kind(exponents: Exponents) -> str:
    """Return what a unit with these powers measures, in words.

    Examples
    --------
    >>> kind((0, 1, 0, 0)), kind((0, 1, 5, 0))
    ('a mass', 'something else')
    """
    if exponents == (0, 0, -1, 1):
        return "an angular frequency"
    return next((d.name for d in _NAMED if d.exponents == exponents), "something else")
