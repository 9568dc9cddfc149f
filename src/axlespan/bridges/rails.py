"""Rails: what a track's beams are made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from axlespan.model.dofs import nearest
from axlespan.model.materials import require_positive


@dataclass(frozen=True)
class Rail:
    """One rail."""

    name: str
    second_moment: float  # I_y, vertical bending [m^4]
    mass_per_length: float  # [kg/m]
    youngs_modulus: float = 210e9  # [Pa]
    source: str = ""
    to_check: bool = False  # not yet checked against the standard

    def __post_init__(self) -> None:
        for field in ("second_moment", "mass_per_length", "youngs_modulus"):
            require_positive(getattr(self, field), f"rail.{field}")

    @property
    def bending_stiffness(self) -> float:
        """EI [N m^2]."""
        return self.youngs_modulus * self.second_moment


#: Rails by name; I and m from public sources, see each.
RAILS: Mapping[str, Rail] = {
    rail.name: rail
    for rail in (
        Rail("60E1", 3.0383e-5, 60.21, source="EN 13674-1 60E1: I as in STEM, m as in GoTrain"),
        Rail("UIC60", 3.055e-5, 60.34, source="old UIC60: I as in railFE; m from memory", to_check=True),
        Rail("54E1", 2.3372e-5, 54.77, source="EN 13674-1 54E1: I as in STEM; m from memory", to_check=True),
        Rail("46E3", 1.606e-5, 46.66, source="EN 13674-1 46E3: I as in STEM; m from memory", to_check=True),
        Rail("CHN60", 3.217e-5, 60.64, 2.059e11, source="Zhai, Wang and Lin (2004), as in TTB-2D"),
    )
}


def rail_named(rail: str | Rail) -> Rail:
    """A rail, itself or by its name.

    Raises
    ------
    InputError
        If there is none of that name.

    Examples
    --------
    >>> f"{rail_named('60E1').bending_stiffness:.4g} N m2"
    '6.38e+06 N m2'
    """
    if isinstance(rail, Rail):
        return rail
    if rail not in RAILS:
        raise nearest(rail, list(RAILS), "rail")
    return RAILS[rail]
