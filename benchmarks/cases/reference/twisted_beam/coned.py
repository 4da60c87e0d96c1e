"""Frequencies with precone, by the same collocation: the equations also contain velocities.

The axis of rotation is s b1 + c b3, with s, c = sin, cos of the precone, in axes along the beam.  So the
rotation has a part about the beam, in whose axes a moving point has the Coriolis acceleration 2 gamma s T u',
T u = (u3, -u2); a tip body has, beside that of its centre of gravity, the same with its moment int x^2 dm.
Statically, a point at distance x along and (u2, u3) across the beam has the squared distance

    (hub + c x - s u3)^2 + u2^2

from the axis, whence the tension c (hub + c x) per mass, and P = diag(1, s^2).  A body with the moments
X = int x^2 dm along and E across the beam adds (s, p) . (X I - E) to the distances:

    c^2 p3 ((X I - E) p)_3 - s^2 p . (X I - E) p + 2 c^2 E23 tau.

With s = i lambda, A y + s D y + s^2 B y = 0.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, eigs, splu

from benchmarks.cases.reference.twisted_beam.blade import Blade
from benchmarks.cases.reference.twisted_beam.collocation import assemble
from benchmarks.cases.reference.twisted_beam.equations import coriolis, rates, sections_at, tip_conditions
from benchmarks.cases.reference.twisted_beam.mesh import Mesh

_NODES = 12
_FINEST = 64  # largest number of pieces of each interval between breakpoints


def coned_frequencies(
    blade: Blade, gamma: float, count: int = 4, rtol: float = 1e-10
) -> tuple[np.ndarray, float]:
    """Return the lowest lambda on the first mesh that changes all by less than `rtol`, and the change."""
    before, pieces, change = solve_coned(blade, gamma, count, 1), 2, np.inf
    while pieces <= _FINEST:
        found = solve_coned(blade, gamma, count, pieces)
        change = float(np.max(np.abs(found / before - 1)))
        if change <= rtol:
            return found, change
        before, pieces = found, 2 * pieces
    raise ArithmeticError(f"not converged: the finest mesh changes lambda by {change:.1e}")


def solve_coned(blade: Blade, gamma: float, count: int, pieces: int) -> np.ndarray:
    """Compute the lowest lambda on a mesh of equal pieces between breakpoints."""
    mesh = Mesh.make(blade.breakpoints, pieces, _NODES)
    section = sections_at(blade, mesh)
    still, moving = rates(section, gamma)
    by_rates, tip_by_rates = coriolis(blade, section, gamma)
    tip, tip_inertia = tip_conditions(blade, gamma)
    left, right = assemble(blade, mesh, still, moving, (tip, tip_inertia))
    _, turning = assemble(blade, mesh, still, -by_rates, (tip, tip_by_rates))
    return _lowest(left, sp.csc_array(turning), right, count)


def _lowest(left: sp.csc_array, turning: sp.csc_array, right: sp.csc_array, count: int) -> np.ndarray:
    """Compute the lowest lambda of left y + s turning y + s^2 right y = 0, by Arnoldi's method for 1/s."""
    n, factors = left.shape[0], splu(sp.csc_matrix(left))

    def inverse(state: np.ndarray) -> np.ndarray:
        y, rate = state[:n], state[n:]
        return np.concatenate([-factors.solve(turning @ y + right @ rate), y])

    operator = LinearOperator((2 * n, 2 * n), matvec=inverse, dtype=float)
    wanted = 2 * count + 6
    start = np.random.default_rng(1).normal(size=2 * n)
    values, vectors = eigs(operator, wanted, v0=start, ncv=6 * wanted, tol=0)
    found = sorted(((1 / value).imag, k) for k, value in enumerate(values) if (1 / value).imag > 0)[:count]
    return np.array([_refined(left, turning, right, at, vectors[:n, k]) for at, k in found])


def _refined(
    left: sp.csc_array, turning: sp.csc_array, right: sp.csc_array, at: float, y: np.ndarray
) -> float:
    """Refine lambda by Newton's method with inverse iteration for y."""
    s = 1j * at * (1 + 1e-6)
    for _ in range(4):
        y = y / np.linalg.norm(y)
        matrix = sp.csc_matrix(left + s * turning + s**2 * right)
        slope = (turning + 2 * s * right) @ y
        z = splu(matrix).solve(slope)
        step = 1 / complex(y.conj() @ z)
        s, y = s - step, z
        if abs(step) <= 1e-13 * abs(s):
            break
    if abs(s.real) > 1e-9 * abs(s):
        raise ArithmeticError(f"an eigenvalue that should be imaginary is {s}")
    return float(s.imag)
