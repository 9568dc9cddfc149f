"""Matrices and modal models of other programs in and out: Matrix Market, SciPy, Abaqus, Ansys, CSV."""

from axlespan.io.matrices.abaqus import write_abaqus
from axlespan.io.matrices.harwell_boeing import HarwellBoeing, read_harwell_boeing, write_harwell_boeing
from axlespan.io.matrices.matrix_market import read_matrix_market, write_matrix_market
from axlespan.io.matrices.modal import ModalModel, read_modal, write_modal
from axlespan.io.matrices.model import MatrixModel
from axlespan.io.matrices.names import DofMap, NodeTable
from axlespan.io.matrices.npz import read_npz, write_npz
from axlespan.io.matrices.read import read_matrices
from axlespan.io.matrices.tables import read_coordinates, read_dof_map, write_coordinates, write_dof_map

__all__ = [
    "DofMap",
    "HarwellBoeing",
    "MatrixModel",
    "ModalModel",
    "NodeTable",
    "read_coordinates",
    "read_dof_map",
    "read_harwell_boeing",
    "read_matrices",
    "read_matrix_market",
    "read_modal",
    "read_npz",
    "write_abaqus",
    "write_coordinates",
    "write_dof_map",
    "write_harwell_boeing",
    "write_matrix_market",
    "write_modal",
    "write_npz",
]
