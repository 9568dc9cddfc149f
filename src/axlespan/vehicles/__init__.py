"""Vehicles and trains: systems with contact points, and how they follow each other."""

from axlespan.vehicles import library, load_trains
from axlespan.vehicles.loads import BodyLoad
from axlespan.vehicles.multibody import multibody
from axlespan.vehicles.parts import Body, Hinge, Suspension, Wheel
from axlespan.vehicles.simple import axle_loads, rigid_body, rigid_mass, sprung_mass
from axlespan.vehicles.train import Placement, Train
from axlespan.vehicles.vehicle import ContactPoint, Vehicle

__all__ = [
    "Body",
    "BodyLoad",
    "ContactPoint",
    "Hinge",
    "Placement",
    "Suspension",
    "Train",
    "Vehicle",
    "Wheel",
    "axle_loads",
    "library",
    "load_trains",
    "multibody",
    "rigid_body",
    "rigid_mass",
    "sprung_mass",
]
