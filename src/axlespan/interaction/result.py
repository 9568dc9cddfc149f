"""The result of a crossing: named arrays over time, the outcome and the self-checks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from axlespan.card import Card, Shown
from axlespan.errors import InputError, Outcome
from axlespan.interaction.extras import SECTION_VARIABLES, extra_coordinates, extra_variables
from axlespan.interaction.records.envelopes import Envelopes
from axlespan.interaction.records.fields import Fields

if TYPE_CHECKING:
    import pandas
    import xarray

FloatArray = npt.NDArray[np.float64]

# name -> (dimension, unit, meaning)
VARIABLES: dict[str, tuple[str, str, str]] = {
    "sensor_displacement": ("sensor", "m", "vertical displacement at the sensors, positive upward"),
    "sensor_velocity": ("sensor", "m/s", "vertical velocity at the sensors"),
    "sensor_acceleration": ("sensor", "m/s^2", "vertical acceleration at the sensors"),
    "contact_force": ("contact", "N", "contact force on the vehicle, compression positive"),
    "contact_position": ("contact", "m", "position of the wheel along the running line"),
    "vehicle_displacement": (
        "vehicle_dof",
        "m or rad",
        "displacement from the static position on level ground",
    ),
    "vehicle_velocity": ("vehicle_dof", "m/s or rad/s", "velocity of the vehicle's degrees of freedom"),
    "vehicle_acceleration": (
        "vehicle_dof",
        "m/s^2 or rad/s^2",
        "acceleration of the vehicle's degrees of freedom",
    ),
    "support_reaction": ("support", "N or N m", "force of the support on the structure"),
}


def _none() -> FloatArray:
    return np.zeros((0, 0))


def _empty() -> FloatArray:
    return np.zeros(0)


@dataclass(frozen=True, eq=False, repr=False)
class Result(Shown):
    """What a crossing gave, at the times kept."""

    time: FloatArray  # (n_time,) [s]
    sensor: tuple[str, ...]  # names, as given
    contact: tuple[str, ...]  # names, vehicle.wheel: 1.1
    vehicle_dof: tuple[str, ...]  # names, vehicle.part.component: 1.body.z
    support: tuple[str, ...]  # names, support.component: left.z
    sensor_displacement: FloatArray  # (n_time, n_sensor) [m]
    sensor_velocity: FloatArray  # (n_time, n_sensor) [m/s]
    sensor_acceleration: FloatArray  # (n_time, n_sensor) [m/s^2]
    contact_force: FloatArray  # (n_time, n_contact) [N]
    contact_position: FloatArray  # (n_time, n_contact) [m]
    vehicle_displacement: FloatArray  # (n_time, n_vehicle_dof) [m or rad]
    vehicle_velocity: FloatArray  # (n_time, n_vehicle_dof) [m/s or rad/s]
    vehicle_acceleration: FloatArray  # (n_time, n_vehicle_dof) [m/s^2 or rad/s^2]
    support_reaction: FloatArray  # (n_time, n_support) [N or N m]
    outcome: Outcome  # code and message
    checks: Mapping[str, Any] = field(default_factory=dict)  # self-checks, as in summary.json
    facts: Mapping[str, Any] = field(default_factory=dict)  # about the run: sizes, solver, timing, notes
    section: tuple[str, ...] = ()  # sensors at which section forces of beams are kept
    section_moment: FloatArray = field(default_factory=_none)  # (n_time, n_section) [N m]
    section_shear: FloatArray = field(default_factory=_none)  # (n_time, n_section) [N]
    section_normal: FloatArray = field(default_factory=_none)  # (n_time, n_section) [N]
    section_torsion: FloatArray = field(default_factory=_none)  # (n_time, n_section) [N m]
    stress: tuple[str, ...] = ()  # sensor.component
    stress_history: FloatArray = field(default_factory=_none)  # (n_time, n_stress) [N/m^2, N/m, N m/m]
    line_position: FloatArray = field(default_factory=_empty)  # (n_line_point,) along the deck [m]
    line_end: FloatArray = field(default_factory=_empty)  # (2,) ends of the deck's line [m]
    line_displacement: FloatArray = field(default_factory=_none)  # (n_time, n_line_point) [m]
    line_acceleration: FloatArray = field(default_factory=_none)  # (n_time, n_line_point) [m/s^2]
    line_twist: FloatArray = field(default_factory=_none)  # (n_time, n_line_point or 0) over 3 m [m]
    line_slope: FloatArray = field(default_factory=_none)  # (n_time, 2) dw/ds at the ends [rad]
    envelopes: Envelopes | None = None  # extremes along the line
    fields: Fields | None = None  # the whole structure at chosen times

    def at(self, quantity: str, name: str) -> FloatArray:
        """The history (n_time,) of one named sensor, contact, vehicle d.o.f. or support.

        Raises
        ------
        InputError
            If the quantity or the name is unknown.

        Examples
        --------
        ``result.at("contact_force", "1.1")``, ``result.at("vehicle_acceleration", "1.body.z")``
        """
        known = VARIABLES | SECTION_VARIABLES
        if quantity not in known:
            raise InputError(f"must be one of {', '.join(known)}", field="quantity", value=quantity)
        names: tuple[str, ...] = getattr(self, known[quantity][0])
        if name not in names:
            shown = ", ".join(names[:12]) or "none"
            raise InputError(
                f"is not a {known[quantity][0]} of this result",
                field="name",
                value=name,
                fix=f"Known: {shown}",
            )
        values: FloatArray = getattr(self, quantity)[:, names.index(name)]
        return values

    def to_xarray(self) -> xarray.Dataset:
        """The result as an xarray Dataset with the names and units of result.nc.

        Raises
        ------
        InputError
            If xarray is not installed.
        """
        try:
            import xarray as xr
        except ImportError as error:
            raise InputError(
                "is not installed", field="xarray", fix="pip install 'axlespan[xarray]'"
            ) from error
        variables: dict[str, Any] = {
            name: (("time", dimension), getattr(self, name), {"units": unit, "long_name": meaning})
            for name, (dimension, unit, meaning) in VARIABLES.items()
        }
        dimensions = dict.fromkeys(dimension for dimension, _, _ in VARIABLES.values())
        coordinates: dict[str, Any] = {
            name: (name, np.array(getattr(self, name), dtype=object)) for name in dimensions
        }
        for extra, into in ((extra_variables(self), variables), (extra_coordinates(self), coordinates)):
            for name, v in extra.items():
                units = {"units": v.unit} if v.unit else {}
                into[name] = (v.dimensions, v.values, {**units, "long_name": v.meaning})
        coordinates["time"] = ("time", self.time, {"units": "s", "long_name": "time"})
        return xr.Dataset(
            variables, coordinates, {"outcome": self.outcome.code, "outcome_message": self.outcome.message}
        )

    def to_pandas(self) -> pandas.DataFrame:
        """The histories as a pandas DataFrame: a row for each time, a column for each history.

        Returns
        -------
        DataFrame (n_time, n_history)
            The index is ``time`` [s]. Columns have two levels, quantity and name: ``table["contact_force"]``
            is a table of all wheels, ``table["contact_force", "1.1"]`` one history. ``table.attrs["units"]``
            has the unit of each quantity.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise InputError(
                "is not installed", field="pandas", fix="pip install 'axlespan[xarray]'"
            ) from error
        known = {name: row for name, row in (VARIABLES | SECTION_VARIABLES).items() if getattr(self, row[0])}
        columns = [
            (name, each) for name, (dimension, *_) in known.items() for each in getattr(self, dimension)
        ]
        values = [getattr(self, name) for name in known]
        table = pd.DataFrame(
            np.hstack(values) if values else np.empty((len(self.time), 0)),
            index=pd.Index(self.time, name="time"),
            columns=pd.MultiIndex.from_tuples(columns, names=["quantity", "name"]),
        )
        table.attrs["units"] = {"time": "s"} | {name: unit for name, (_, unit, _) in known.items()}
        return table

    def card(self) -> Card:
        """Return what is shown of it."""
        facts = [
            ("outcome", f"{self.outcome.code}: {self.outcome.message}"),
            ("times", f"{len(self.time)} to {self.time[-1]:.6g} s"),
        ]
        for i, name in enumerate(self.sensor):
            u = 1e3 * self.sensor_displacement[:, i]
            facts.append((name, f"displacement {u.min():.4f} to {u.max():.4f} mm"))
        if self.contact_force.size:
            low, high = self.contact_force.min() / 1e3, self.contact_force.max() / 1e3
            facts.append(("contact forces", f"{low:.6g} to {high:.6g} kN, {len(self.contact)} wheels"))
        return Card("Result", facts, 'result.at("contact_force", "1.1"), result.to_xarray()')
