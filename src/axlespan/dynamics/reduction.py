r"""A reduced basis for a structure that is loaded along a path.

The basis holds the static shapes under loads on the path, K⁻¹ Rᵀ, and what inertia makes of them,
K⁻¹ M K⁻¹ Rᵀ and so on (Ritz vectors, Wilson, Yuan and Dickens 1982), each block compressed to the shapes that
matter, and the lowest modes if asked for. In its span the eigenproblem is solved (Rayleigh-Ritz), so that
the reduced matrices are diagonal:

.. math:: V^T M V = 1, \qquad V^T K V = \mathrm{diag}(ω^2)

It depends on the structure and its path alone: one basis serves every train, speed and irregularity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
from scipy.linalg import eigh

from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import Factor, factorize

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Right-hand sides that are solved for together.
_BLOCK = 64


@dataclass(frozen=True, eq=False)
class ReducedBasis:
    """Shapes V and their circular frequencies, with the factor of K that estimates its error."""

    vectors: FloatArray  # V (n, m) [kg^-1/2]
    angular_frequencies: FloatArray  # ω (m,) [rad/s]
    path_dofs: IntArray  # (n_path,)
    static_factor: Factor  # of K, for the estimate of the error

    @property
    def size(self) -> int:
        """Number of shapes."""
        return len(self.angular_frequencies)

    @property
    def nbytes(self) -> int:
        """Memory [byte]."""
        return int(self.vectors.nbytes + self.static_factor.nbytes)


def reduced_basis(
    K: sp.csr_array,
    M: sp.csr_array,
    path_dofs: IntArray,
    *,
    blocks: int = 3,
    cutoff: float = 1e-5,
    modes: int = 0,
    extra: FloatArray | None = None,
    solver: str = "auto",
) -> ReducedBasis:
    """Build a basis.

    Parameters
    ----------
    K, M : sparse arrays (n, n)
        Stiffness and mass over the free d.o.f.
    path_dofs : array (n_path,)
        D.o.f. that running lines use.
    blocks : int
        Blocks of Ritz vectors: 1 is the static shapes alone.
    cutoff : float
        Shapes whose share of a block's strain energy is below the square of this are left out.
    modes : int
        Modes by shift-invert Lanczos that are added.
    extra : array (n, k), optional
        Further shapes to hold exactly. The rigid translations of all free d.o.f. make the sum of reactions,
        loads and inertia right.
    solver : str
        Kind of factor of K.

    Raises
    ------
    InputError
        If a parameter is out of range.
    """
    if blocks < 1:
        raise InputError("must be at least 1", field="blocks", value=blocks)
    if not 0.0 < cutoff < 1.0:
        raise InputError("must lie between 0 and 1", field="cutoff", value=cutoff)
    factor = factorize(K, kind=solver)
    loads = np.zeros((K.shape[0], len(path_dofs)))
    loads[path_dofs, np.arange(len(path_dofs))] = 1.0
    static = _solved(factor, loads)
    basis = _compressed(static, K, None, cutoff)
    latest = basis
    for _ in range(blocks - 1):
        latest = _compressed(_solved(factor, np.asarray(M @ latest)), K, basis, cutoff)
        if not latest.shape[1]:
            break
        basis = np.hstack([basis, latest])
    if modes:
        extra = _compressed(lowest_modes(K, M, modes, kind=solver).shapes, K, basis, 1e-8)
        basis = np.hstack([basis, extra])
    if extra is not None and extra.size:
        basis = np.hstack([basis, _compressed(extra, K, basis, 1e-8)])
    # Eigenproblem for 1 / ω², exact where ω is low. The basis is K-orthonormal but for rounding, which is not
    # small where a basis nearly holds all d.o.f. of a stiff structure.
    gram, unit = basis.T @ np.asarray(M @ basis), basis.T @ np.asarray(K @ basis)
    flexibility, turn = eigh(0.5 * (gram + gram.T), 0.5 * (unit + unit.T))
    order = np.flatnonzero(flexibility > 1e-14 * flexibility[-1])[::-1]
    roots = np.sqrt(flexibility[order])
    vectors = np.ascontiguousarray(basis @ (turn[:, order] / roots))
    return ReducedBasis(vectors, 1.0 / roots, np.asarray(path_dofs), factor)


def _solved(factor: Factor, loads: FloatArray) -> FloatArray:
    result = np.empty_like(loads)
    for begin in range(0, loads.shape[1], _BLOCK):
        some = np.ascontiguousarray(loads[:, begin : begin + _BLOCK])
        result[:, begin : begin + _BLOCK] = factor.solve(some)
    return result


def _compressed(block: FloatArray, K: sp.csr_array, basis: FloatArray | None, cutoff: float) -> FloatArray:
    """The part of a block (n, k) that is new to a K-orthonormal basis, K-orthonormal, small shapes left out.

    Columns are scaled to unit strain energy first, so that each load on the path counts the same.
    """
    energy = np.sqrt(np.maximum(np.einsum("ij,ij->j", block, np.asarray(K @ block)), 0.0))
    scaled = block[:, energy > 0.0] / energy[energy > 0.0]
    for _ in range(2):  # twice is enough
        if basis is not None and scaled.shape[1]:
            scaled = scaled - basis @ (basis.T @ np.asarray(K @ scaled))
    if not scaled.shape[1]:
        return np.asarray(scaled)
    shares, turn = np.linalg.eigh(scaled.T @ np.asarray(K @ scaled))
    # Rounding leaves shares of about 1e-15 of the block's energy.
    keep = shares > max(cutoff**2, 1e-13) * scaled.shape[1]
    shapes = scaled @ (turn[:, keep] / np.sqrt(shares[keep]))
    if basis is not None and shapes.shape[1]:
        shapes -= basis @ (basis.T @ np.asarray(K @ shapes))
    return np.asarray(shapes)
