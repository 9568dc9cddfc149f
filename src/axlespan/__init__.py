"""Trains and trucks crossing bridges and track, by the direct method of Neves et al. (2012).

Contact forces between vehicles and structure are unknowns beside the displacements; the structure's effective
matrix is factored once, and what changes from step to step is a small contact system.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from axlespan import bridges, irregularity, plot, standards, vehicles
    from axlespan.dynamics.alpha import Alpha
    from axlespan.errors import AnalysisError, AxlespanError, InputError
    from axlespan.interaction.crossing import Crossing, OtherTrain
    from axlespan.interaction.result import Result
    from axlespan.interaction.settings import Iteration
    from axlespan.interaction.simulate import simulate, simulate_many
    from axlespan.io.results import read_result, write_result
    from axlespan.model.damping import Modal, Rayleigh
    from axlespan.model.materials import BeamSection, Material
    from axlespan.model.model import Model
    from axlespan.model.system import System
    from axlespan.running.structure import Structure
    from axlespan.study.sweep import Study
    from axlespan.vehicles.train import Train
    from axlespan.vehicles.vehicle import Vehicle

_HOMES = {
    "Alpha": "dynamics.alpha",
    "AnalysisError": "errors",
    "AxlespanError": "errors",
    "BeamSection": "model.materials",
    "Crossing": "interaction.crossing",
    "InputError": "errors",
    "Iteration": "interaction.settings",
    "Material": "model.materials",
    "Modal": "model.damping",
    "Model": "model.model",
    "OtherTrain": "interaction.crossing",
    "Rayleigh": "model.damping",
    "Result": "interaction.result",
    "Structure": "running.structure",
    "Study": "study.sweep",
    "System": "model.system",
    "Train": "vehicles.train",
    "Vehicle": "vehicles.vehicle",
    "read_result": "io.results",
    "simulate": "interaction.simulate",
    "simulate_many": "interaction.simulate",
    "write_result": "io.results",
}
_ROOMS = ("bridges", "irregularity", "plot", "standards", "vehicles")

__all__ = [
    "Alpha",
    "AnalysisError",
    "AxlespanError",
    "BeamSection",
    "Crossing",
    "InputError",
    "Iteration",
    "Material",
    "Modal",
    "Model",
    "OtherTrain",
    "Rayleigh",
    "Result",
    "Structure",
    "Study",
    "System",
    "Train",
    "Vehicle",
    "bridges",
    "irregularity",
    "plot",
    "read_result",
    "simulate",
    "simulate_many",
    "standards",
    "vehicles",
    "write_result",
]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used: importing the package stays quick."""
    if name in _HOMES:
        return getattr(import_module(f"axlespan.{_HOMES[name]}"), name)
    if name in _ROOMS:
        return import_module(f"axlespan.{name}")
    raise AttributeError(f"module 'axlespan' has no attribute '{name}'")


def __dir__() -> list[str]:
    """Public names."""
    return sorted([*__all__, "__version__"])
