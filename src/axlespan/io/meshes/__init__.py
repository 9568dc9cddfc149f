"""Meshes in and out: Gmsh, Abaqus, and what the optional package meshlane reads."""

from axlespan.io.meshes.abaqus import read_abaqus
from axlespan.io.meshes.gmsh import read_gmsh
from axlespan.io.meshes.gmsh_write import write_gmsh
from axlespan.io.meshes.read import read_mesh

__all__ = ["read_abaqus", "read_gmsh", "read_mesh", "write_gmsh"]
