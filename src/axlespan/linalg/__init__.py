"""Factors, eigenpairs and saddle systems: the linear algebra under the time integration.

A factorization is a value that the caller holds and passes on; nothing is cached behind the scenes.
"""

from axlespan.linalg.arrays import CsrMatrix, FloatArray, IntArray, MatrixLike, symmetric_csr
from axlespan.linalg.bordered import BlockFactors, block_factorization, complete_matrix, symmetry_error
from axlespan.linalg.definiteness import NotPositiveDefinite
from axlespan.linalg.eigen import Modes, lowest_modes
from axlespan.linalg.factor import Choice, available, choose, factorize
from axlespan.linalg.protocol import Factor, SplitFactor

__all__ = [
    "BlockFactors",
    "Choice",
    "CsrMatrix",
    "Factor",
    "FloatArray",
    "IntArray",
    "MatrixLike",
    "Modes",
    "NotPositiveDefinite",
    "SplitFactor",
    "available",
    "block_factorization",
    "choose",
    "complete_matrix",
    "factorize",
    "lowest_modes",
    "symmetric_csr",
    "symmetry_error",
]
