"""From the train of a case to a train: vehicles of each kind, and where they stand."""

from __future__ import annotations

from dataclasses import replace

from axlespan import vehicles
from axlespan.errors import InputError
from axlespan.running.structure import MAIN_LINE
from axlespan.study import case_train
from axlespan.study.case_multibody import Multibody
from axlespan.study.case_vehicle_imported import MatricesVehicle, MeshVehicle
from axlespan.study.faults import listed
from axlespan.study.imported_vehicles import vehicle_of_matrices, vehicle_of_mesh
from axlespan.vehicles import Vehicle


def vehicle_of(case: case_train.Entry, gravity: float) -> Vehicle:
    """Build the vehicle of an entry of a train.

    Raises
    ------
    InputError
        If something is wrong that only shows now; fields are paths under the entry.
    """
    vehicle = _vehicle(case, gravity)
    if case.line is None:
        return vehicle
    contacts = [
        replace(point, line=case.line) if point.line == MAIN_LINE else point for point in vehicle.contacts
    ]
    return replace(vehicle, contacts=tuple(contacts))


def _vehicle(case: case_train.Entry, gravity: float) -> Vehicle:
    if isinstance(case, case_train.SprungMass):
        return vehicles.sprung_mass(
            mass=case.mass, stiffness=case.stiffness, damping=case.damping, unsprung_mass=case.unsprung_mass
        )
    if isinstance(case, case_train.RigidMass):
        return vehicles.rigid_mass(mass=case.mass)
    if isinstance(case, case_train.AxleLoads):
        return vehicles.axle_loads(loads=list(case.axle_loads), positions=list(case.wheel_positions))
    if isinstance(case, Multibody):
        return vehicles.multibody(
            bodies=[vehicles.Body(b.name, b.mass, b.position, b.inertia) for b in case.bodies],
            wheels=[vehicles.Wheel(w.position, w.mass, w.name) for w in case.wheels],
            suspensions=[
                vehicles.Suspension((s.between[0], s.between[1]), s.stiffness, s.damping, s.at)
                for s in case.suspensions
            ],
        )
    if isinstance(case, MeshVehicle):
        return vehicle_of_mesh(case, gravity)
    if isinstance(case, MatricesVehicle):
        return vehicle_of_matrices(case, gravity)
    raise InputError(
        "is not available in this version",
        field="vehicle",
        value=case.vehicle,
        fix=f"Kinds are {listed(case_train.KINDS.names)}",
    )
