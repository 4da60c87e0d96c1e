"""Change of an eigenvalue by an effect that a model leaves out, from the mode without it.

The equations with the effect, at the eigenvalue s and mode v of those without it, give a step of inverse
iteration, z = D(s)^-1 D'(s) v with D(s) = s^2 M + s (C + omega G) + K, whence the new eigenvalue is the root
of y^T D(s) z = 0 next to s, with y from the transposed equations.  The error of the vectors enters squared:
no new eigenproblem is solved, and no modes are matched.  Further steps serve large effects and close modes.
"""

from __future__ import annotations

import cmath

import numpy as np
import scipy.linalg
from scipy.linalg.lapack import zgetrf, zgetrs

from beamdyn.equations.equations_of_motion import SteadyPencil

_APART = 1e-8  # relative distance from the eigenvalue: the equations are singular there without the effect
_STEPS = 8  # of inverse iteration at most: one will do unless the effect is large, or modes are close
_CONVERGED, _ROUNDING = 0.01, 1e-9  # step relative to the change, and to the eigenvalue, that ends it
KEPT = 0.5  # of a mode's squared product by mass with that found: below it, it is another mode


def shift_eigenvalues(pencil: SteadyPencil, speed: float, s: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Estimate the eigenvalues of a pencil next to some of simpler equations.

    Parameters
    ----------
    pencil : SteadyPencil
        The equations with the effect.
    speed : float
        Speed [rad/s].
    s : ndarray of complex, shape (m,)
        Eigenvalues without the effect [1/s], not 0.
    v : ndarray, shape (n, m)
        Their modes, 0 in the coordinates that the effect adds.

    Returns
    -------
    ndarray of complex, shape (m,)
        The eigenvalues [1/s]; nan where the equations give none.
    """
    M, C, K = pencil.M, pencil.C + speed * pencil.G, pencil.K0 + speed**2 * pencil.K2
    scale = _scale(M, K)  # functions of high order have large entries
    M, C, K = (scale[:, None] * A * scale for A in (M, C, K))
    modes = (v / scale[:, None]).T
    with np.errstate(divide="ignore", invalid="ignore"):  # of singular equations, which give none
        each = [_shift(M, C, K, at, x) for at, x in zip(s.tolist(), modes, strict=True)]
    return np.array(each, dtype=complex)


def _shift(M: np.ndarray, C: np.ndarray, K: np.ndarray, s: complex, x: np.ndarray) -> complex:
    """The eigenvalue next to s, of mode x without the effect."""
    y, z, at = x.conj(), x, s
    for _ in range(_STEPS):
        y, z = _improve(M, C, K, at * (1 + _APART), y, z)
        before, at = at, _root_near(s, *(complex(y @ A @ z) for A in (M, C, K)))
        if abs(at - before) <= _CONVERGED * abs(at - s) + _ROUNDING * abs(s):
            break
        if not cmath.isfinite(at):
            return complex(np.nan)
    kept = abs(x.conj() @ M @ z) ** 2 / abs((x.conj() @ M @ x) * (z.conj() @ M @ z))
    return at if kept > KEPT else complex(np.nan)


def _improve(
    M: np.ndarray, C: np.ndarray, K: np.ndarray, s: complex, y: np.ndarray, z: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """One step of inverse iteration of the left and the right vector at s; not finite where D is singular."""
    derivative = 2 * s * M + C
    factors, pivots, _ = zgetrf(s * s * M + s * C + K, overwrite_a=True)
    z, _ = zgetrs(factors, pivots, derivative @ z)
    y, _ = zgetrs(factors, pivots, derivative.T @ y, trans=1)
    return y / np.linalg.norm(y), z / np.linalg.norm(z)


def _scale(M: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Factors (n,) that make the diagonal of the stiffness 1, or of the mass where there is no stiffness."""
    size = np.where(np.diag(K) > 0, np.abs(np.diag(K)), np.abs(np.diag(M)))
    return 1 / np.sqrt(np.where(size > 0, size, 1.0))


def _root_near(s: complex, a: complex, b: complex, c: complex) -> complex:
    """The root of a r^2 + b r + c nearest to s; nan if there is none."""
    if not (cmath.isfinite(a) and cmath.isfinite(b) and cmath.isfinite(c)) or a == 0:
        return complex(np.nan)
    root = cmath.sqrt(b * b - 4 * a * c)
    return min((-b + root) / (2 * a), (-b - root) / (2 * a), key=lambda r: abs(r - s))


def shift_critical_speed(pencil: SteadyPencil, critical: float, v: np.ndarray) -> float:
    """Estimate the speed at which the stiffness is singular, next to that of simpler equations.

    Parameters
    ----------
    pencil : SteadyPencil
        The equations with the effect.
    critical : float
        Critical speed without the effect [rad/s].
    v : ndarray, shape (n,)
        Its buckling mode, 0 in the coordinates that the effect adds.

    Returns
    -------
    float
        The critical speed [rad/s]; nan if the equations give none.
    """
    scale = _scale(pencil.M, pencil.K0)
    K0, K2 = (scale[:, None] * A * scale for A in (pencil.K0, pencil.K2))
    try:
        z = scipy.linalg.solve(K0 + (critical * (1 + _APART)) ** 2 * K2, K2 @ (v / scale), assume_a="sym")
    except (ValueError, np.linalg.LinAlgError):
        return np.nan
    z = z / np.linalg.norm(z)
    stiffness, softening = float(z @ K0 @ z), -float(z @ K2 @ z)
    return float(np.sqrt(stiffness / softening)) if stiffness > 0 and softening > 0 else np.nan


def buckling_mode(pencil: SteadyPencil, critical: float) -> np.ndarray:
    """Mode (n,) on which the stiffness vanishes at the critical speed [rad/s]."""
    scale = _scale(pencil.M, pencil.K0)
    K = scale[:, None] * (pencil.K0 + critical**2 * pencil.K2) * scale
    values, vectors = np.linalg.eigh(K)
    return scale * vectors[:, np.abs(values).argmin()]
