"""What a named d.o.f. or support measures: a displacement or a rotation, a force or a moment."""

from __future__ import annotations

#: Last parts of names that stand for rotations: ``1.body.pitch``, ``left.ry``.
ROTATIONS = frozenset({"pitch", "roll", "yaw", "rx", "ry", "rz"})

#: Quantity -> unit of a displacement, and of a rotation.
_UNITS = {
    "displacement": ("m", "rad"),
    "velocity": ("m/s", "rad/s"),
    "acceleration": ("m/s^2", "rad/s^2"),
    "force": ("N", "N m"),
}


def is_rotation(name: str) -> bool:
    """Whether a d.o.f. turns.

    Examples
    --------
    >>> is_rotation("3.bogie1.pitch"), is_rotation("3.bogie1.z")
    (True, False)
    """
    return name.rpartition(".")[2] in ROTATIONS


def unit_of(quantity: str, name: str) -> str:
    """Unit of a quantity (displacement, velocity, acceleration, force) at a named d.o.f. or support.

    Examples
    --------
    >>> unit_of("acceleration", "1.body.pitch"), unit_of("force", "left.z")
    ('rad/s^2', 'N')
    """
    return _UNITS[quantity][is_rotation(name)]
