"""Vehicles and trains: systems with contact points, and how they follow each other."""

from axlespan.vehicles.multibody import Body, Suspension, Wheel, multibody
from axlespan.vehicles.simple import axle_loads, rigid_body, rigid_mass, sprung_mass
from axlespan.vehicles.train import Placement, Train
from axlespan.vehicles.vehicle import ContactPoint, Vehicle

__all__ = [
    "Body",
    "ContactPoint",
    "Placement",
    "Suspension",
    "Train",
    "Vehicle",
    "Wheel",
    "axle_loads",
    "multibody",
    "rigid_body",
    "rigid_mass",
    "sprung_mass",
]
