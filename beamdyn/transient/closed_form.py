"""Closed form of the motion at steady speed, as a sum of exponentials, in place of many time steps.

The equations q'' + C q' + (K + sum_m e_m(t) G_m) q = sum_l g_l(t) P_l have constant C and K, and e and g are
sums of a few harmonics.  So the motion consists of a forced part and of free vibrations.  The forced part has
the frequencies of the loads, and their sums with frequencies of e.  A free vibration is exp(lambda t) times a
sum of harmonics at sums of the frequencies of e (Floquet; Hill's method).  Both parts follow by iteration,
because e is small.  The result is used only if it satisfies the equations to the required accuracy.

In shapes of arrays, n counts coordinates, N times or steps, s nodes in a step, and k exponents or
frequencies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamdyn.transient import time_error
from beamdyn.transient.gauss import interpolate, tableau
from beamdyn.transient.weakly_modulated import ModulatedSystem

_WORTH_IT = 200  # number of steps of a segment below which time steps cost no more than the closed form
_ORDERS = (3, 5)  # highest powers of the stiffness variation e that are tried in turn
_FIT_TIMES = 8  # number of times, for each harmonic, at which stiffness and load factors are fitted
# Reciprocal of the golden ratio: spacing the sample times by it avoids coincidence with a period.
_GOLDEN = 0.6180339887498949
_FIT_ERROR = 1e-3  # largest relative error of fitted stiffness and load factors, over the required accuracy
_SAME = 1e-9  # relative difference of frequencies that count as equal
_ABSENT = 1e-12  # factor of a harmonic, over the largest, below which it is a rounding error of the fit
_MOST_HARMONICS = 400
_ITERATIONS = 30
_CONVERGED = 1e-15
_CHECKED = 64  # number of times at which the equations are checked
_NEGLIGIBLE = 1e-2  # fraction of the accuracy allowed for the sum of all neglected terms
_RESOLVED = 12.0  # phase per step [rad] up to which the nodes of a step resolve an exponential
_MOST_GROWTH = 20.0  # largest exponent by which the motion may grow over a segment
# Exponentials are evaluated for batches of 32^2 steps: that at step 32 i + j is the product of those at the
# steps 32 i and j, so that few exponential functions are called.
_ROWS = 32


@dataclass(frozen=True)
class _Harmonics:
    """Varying stiffness and loads as sums of harmonics exp(i frequency (t - t0)).

    Parameters
    ----------
    frequency : ndarray, shape (f,)
        Angular frequencies [rad/s], ascending, with their negatives.
    stiffness : ndarray, shape (f, coordinates, coordinates)
        Complex amplitudes of the varying stiffness; its constant part is in `mean`.
    load : ndarray, shape (f, coordinates)
        Complex amplitudes of the loads.
    mean : ndarray, shape (coordinates, coordinates)
        Mean of the varying stiffness.
    """

    frequency: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    mean: np.ndarray

    @classmethod
    def fit(cls, system: ModulatedSystem, t0: float, t1: float, accuracy: float) -> _Harmonics | None:
        """Fit harmonics to the stiffness factors e and load factors g from t0 to t1 [s].

        None if e or g contain other frequencies than the known ones of the system.
        """
        lines = _distinct(np.concatenate([-system.lines, [0.0], system.lines]))
        count = _FIT_TIMES * len(lines)
        tau = (t1 - t0) * (_GOLDEN * np.arange(1, 2 * count + 1) % 1)
        e, g = system.scalars(t0 + tau)
        values, basis = np.concatenate([e, g], axis=1), np.exp(1j * np.outer(tau, lines))
        found = np.linalg.lstsq(basis[:count], values[:count].astype(complex), rcond=None)[0]
        missed = np.abs(np.real(basis @ found) - values).max(axis=0)
        if (missed > _FIT_ERROR * accuracy * np.abs(values).max(axis=0)).any():
            return None
        found[np.abs(found) <= _ABSENT * np.abs(found).max(axis=0)] = 0
        constant, m = lines == 0, len(system.G)
        mean = np.tensordot(np.real(found[constant, :m]).sum(axis=0), system.G, axes=1)
        load = found[:, m:] @ system.P
        found[constant, :m] = 0
        return cls(lines, np.tensordot(found[:, :m], system.G, axes=1), load, mean)

    def sums(self, order: int) -> np.ndarray:
        """List all sums of up to `order` frequencies of the varying stiffness, ascending."""
        varying = self.frequency[np.abs(self.stiffness).any(axis=(1, 2))]
        found = np.zeros(1)
        for _ in range(order):
            found = _distinct(np.concatenate([found, np.add.outer(found, varying).ravel()]))
        return found

    def coupling(self, sums: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        """Build the function from a motion q at the k frequencies `sums` to forces of the varying stiffness.

        Motion and forces have the shape (..., k, coordinates).
        """
        varying = np.abs(self.stiffness).any(axis=(1, 2))
        # Index in `sums` of each sum minus each frequency of the stiffness; k if the difference is not in
        # `sums`.
        source = _places(sums, sums - self.frequency[varying, None])
        factors = self.stiffness[varying].swapaxes(1, 2)

        def force(q: np.ndarray) -> np.ndarray:
            padded = np.concatenate([q, np.zeros_like(q[..., :1, :])], axis=-2)
            return (padded[..., source, :] @ factors).sum(axis=-3)

        return force


def _distinct(frequencies: np.ndarray) -> np.ndarray:
    """Sort frequencies and remove repeated ones."""
    sorted_ = np.sort(frequencies)
    apart = np.diff(sorted_) > _SAME * max(abs(sorted_[0]), abs(sorted_[-1]))
    return sorted_[np.concatenate([[True], apart])]


def _places(sums: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Find the indices of wanted frequencies among k ascending ones (`sums`); k for a missing one."""
    after = np.searchsorted(sums, wanted - 10 * _SAME * np.abs(sums).max())
    missing = np.abs(np.append(sums, np.inf)[after] - wanted) > 10 * _SAME * np.abs(sums).max()
    return np.where(missing, len(sums), after)


@dataclass(frozen=True)
class _Exponentials:
    """Motion as a sum of exponentials, q(t) = Re sum_k b_k exp(s_k (t - t0)).

    Parameters
    ----------
    s : ndarray of complex, shape (k,)
        Exponents s_k [1/s].
    b : ndarray of complex, shape (k, coordinates)
        Complex amplitudes b_k of the exponentials.
    """

    s: np.ndarray
    b: np.ndarray

    def at(self, tau: np.ndarray, derivatives: int = 0) -> np.ndarray:
        """Evaluate the motion and its derivatives at times tau [s] after t0: (order, times, coordinates)."""
        powers = self.s ** np.arange(derivatives + 1)[:, None]
        return np.real(np.exp(np.outer(tau, self.s)) @ (powers[:, :, None] * self.b))


def _forced(harmonics: _Harmonics, C: np.ndarray, K: np.ndarray, order: int) -> _Exponentials | None:
    """Compute the forced motion under the harmonic loads, for damping C and constant stiffness K.

    Terms up to the power `order` of the varying stiffness are included.  None if there are too many terms.
    """
    loaded = np.abs(harmonics.load).any(axis=1)
    if not loaded.any():
        return _Exponentials(np.zeros(0, complex), np.zeros((0, len(K)), complex))
    sums = _distinct(np.add.outer(harmonics.frequency[loaded], harmonics.sums(order)).ravel())
    if len(sums) > _MOST_HARMONICS:
        return None
    load = np.zeros((len(sums), len(K)), complex)
    load[_places(sums, harmonics.frequency[loaded])] = harmonics.load[loaded]
    flexible = np.linalg.inv(_stiffness(1j * sums, C, K))
    coupling, c, before = harmonics.coupling(sums), np.zeros_like(load), np.inf
    for _ in range(_ITERATIONS):
        new = (flexible @ (load - coupling(c))[:, :, None])[:, :, 0]
        change, size = np.abs(new - c).max(), np.abs(new).max()
        c = new
        if change <= _CONVERGED * size or change >= before:
            break
        before = change
    half = sums >= 0
    twice = np.where(sums[half] > 0, 2.0, 1.0)[:, None]
    return _Exponentials(1j * sums[half], twice * c[half])


def _stiffness(s: np.ndarray, C: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Compute the dynamic stiffness s^2 + s C + K at exponents s: one matrix each."""
    s = s[..., None, None]
    return s**2 * np.eye(len(K)) + s * C + K


def _free(
    harmonics: _Harmonics, C: np.ndarray, K: np.ndarray, order: int
) -> tuple[np.ndarray, np.ndarray] | None:
    """Compute exponents (n, k) and shapes (n, k, n) of n free vibrations, each a sum of k exponentials.

    None if one does not oscillate, or if there are too many terms.  Arguments are as for `_forced`.

    Newton's method corrects each vibration until it satisfies the equations at all sums of frequencies.  It
    keeps the inverse dynamic stiffness of the constant-coefficient equations; at the exponent of
    the unperturbed vibration, where it is singular, it is bordered by the mode shape: one more equation, for
    the change of the exponent.
    """
    n, sums = len(K), harmonics.sums(order)
    values, vectors = np.linalg.eig(np.block([[np.zeros((n, n)), np.eye(n)], [-K, -C]]))
    upper = np.imag(values) > 0
    # There is no result if a free vibration does not oscillate, or if there are too many terms.
    if upper.sum() != n or n * len(sums) > 4 * _MOST_HARMONICS:
        return None
    exponent, shape = values[upper], vectors[:n, upper].T
    shape = shape / np.linalg.norm(shape, axis=1)[:, None]
    own = int(np.abs(sums).argmin())
    beside = _stiffness(exponent[:, None] + 1j * sums, C, K)
    beside[:, own] = np.eye(n)
    border = np.empty((n, n + 1, n + 1), complex)
    border[:, :n, :n] = _stiffness(exponent, C, K)
    border[:, :n, n] = 2 * exponent[:, None] * shape + shape @ C.T
    border[:, n, :n], border[:, n, n] = shape.conj(), 0
    inverse, bordered = np.linalg.inv(beside), np.linalg.inv(border)
    P = np.zeros((n, len(sums), n), complex)
    P[:, own] = shape
    coupling, before = harmonics.coupling(sums), np.inf
    for _ in range(_ITERATIONS):
        s = (exponent[:, None] + 1j * sums)[:, :, None]
        residual = s**2 * P + s * (P @ C.T) + P @ K.T + coupling(P)
        step = (inverse @ residual[..., None])[..., 0]
        at_own = (bordered[:, :, :n] @ residual[:, own, :, None])[..., 0]
        step[:, own] = at_own[:, :n]
        P, exponent = P - step, exponent - at_own[:, n]
        change = np.abs(step).max()
        if change <= _CONVERGED or change >= before:
            break
        before = change
    return exponent[:, None] + 1j * sums, P


def propagate_in_closed_form(
    system: ModulatedSystem,
    t0: float,
    t1: float,
    steps: int,
    q0: np.ndarray,
    v0: np.ndarray,
    stages: int,
    accuracy: float,
) -> time_error.SegmentWithError | None:
    """Compute the motion at steady speed as a sum of exponentials, sampled in steps.

    Parameters
    ----------
    system : ModulatedSystem
        The equations.
    t0, t1, steps, q0, v0, stages
        As for `beamdyn.transient.gauss.propagate`, but the steps only sample the motion.
    accuracy : float
        Largest allowed error that the residual of the equations causes, relative to the largest coordinate.

    Returns
    -------
    SegmentWithError or None
        None if the speed changes, if there are fewer than 200 steps, if e or g contain frequencies other than
        the known ones of the system, or if the residual is too large.
    """
    if not system.steady or steps < _WORTH_IT:
        return None
    C, K = system.slow(np.array([t0]))
    C, K = np.zeros_like(K[0]) if C is None else C[0], K[0]
    harmonics = _Harmonics.fit(system, t0, t1, accuracy)
    if harmonics is None:
        return None
    for order in _ORDERS:
        try:
            motion = _solve(harmonics, C, K + harmonics.mean, order, q0, v0)
        except np.linalg.LinAlgError:  # the equations are singular at resonance without damping
            return None
        if motion is None or np.real(motion.s).max(initial=0.0) * (t1 - t0) > _MOST_GROWTH:
            return None
        tau = (t1 - t0) * (_GOLDEN * np.arange(1, _CHECKED + 1) % 1)
        e, g = system.scalars(t0 + tau)
        q, v, a = motion.at(tau, 2)
        varying = (e[:, :, None] * (q @ system.G.swapaxes(1, 2)).swapaxes(0, 1)).sum(axis=1)
        # The error is bounded as if the residual always excited a resonance.
        missed = a + v @ C.T + q @ K.T + varying - g @ system.P
        error = (t1 - t0) * np.abs(missed).mean(axis=0) / np.sqrt(np.abs(np.diag(K)))
        if error.sum() <= accuracy * float(np.abs(q).max()):
            return _sample(motion, t0, (t1 - t0) / steps, steps, stages, accuracy, error)
    return None


def _solve(
    harmonics: _Harmonics, C: np.ndarray, K: np.ndarray, order: int, q0: np.ndarray, v0: np.ndarray
) -> _Exponentials | None:
    """Compute the forced motion plus free vibrations that match the state q0, v0; None if none is found."""
    forced, free = _forced(harmonics, C, K, order), _free(harmonics, C, K, order)
    if forced is None or free is None:
        return None
    (exponents, shapes), n = free, len(q0)
    start = np.concatenate([q0, v0]) - forced.at(np.zeros(1), 1).ravel()
    columns = np.concatenate([shapes.sum(axis=1), (exponents[:, :, None] * shapes).sum(axis=1)], axis=1).T
    scale = np.abs(columns).max(axis=1)
    columns = np.concatenate([np.real(columns), -np.imag(columns)], axis=1) / scale[:, None]
    real = np.linalg.solve(columns, start / scale)
    factors = ((real[:n] + 1j * real[n:])[:, None, None] * shapes).reshape(-1, n)
    return _Exponentials(np.concatenate([forced.s, exponents.ravel()]), np.concatenate([forced.b, factors]))


def _sample(
    motion: _Exponentials, t0: float, h: float, steps: int, stages: int, accuracy: float, missed: np.ndarray
) -> time_error.SegmentWithError:
    """Sample the motion at ends and nodes of steps, without terms that are small or too fast for steps.

    The error of the result includes `missed`, the error of each coordinate that the residual causes.
    """
    growth = np.exp(np.maximum(np.real(motion.s), 0) * h * steps)
    size = np.abs(motion.b).max(axis=1) * growth
    rank = np.argsort(size)
    small = np.zeros(len(size), bool)
    small[rank] = np.cumsum(size[rank]) <= _NEGLIGIBLE * accuracy * size.max(initial=0.0)
    fast = np.abs(motion.s) * h > _RESOLVED
    left_out = np.abs(motion.b[small | fast] * growth[small | fast, None]).sum(axis=0)
    kept = _Exponentials(motion.s[~(small | fast)], motion.b[~(small | fast)])
    state, acceleration = _evaluate(kept, h, steps, stages)
    chosen = time_error.choose_checked_steps(steps)
    q = interpolate(h, state[chosen], acceleration[chosen], time_error.INTERPOLATION_POINTS)[0]
    tau = h * (chosen[:, None] + time_error.INTERPOLATION_POINTS)
    between = q.reshape(tau.size, -1) - kept.at(tau.ravel())[0]
    unresolved = np.abs(motion.b[fast]).sum(axis=0) > (missed + left_out) / 2
    error = time_error.SegmentError(missed + left_out, between, unresolved)
    return time_error.SegmentWithError(t0, h, state, acceleration, error)


def _evaluate(motion: _Exponentials, h: float, steps: int, stages: int) -> tuple[np.ndarray, np.ndarray]:
    """Evaluate augmented states (1, q, v) at step ends, and accelerations (steps, nodes, coordinates)."""
    s, n = motion.s, motion.b.shape[1]
    nodes = np.exp(np.multiply.outer(s, h * tableau(stages).c))[:, :, None] * (s**2)[:, None, None]
    at_nodes = (nodes * motion.b[:, None]).reshape(len(s), stages * n)
    b = np.concatenate([motion.b, s[:, None] * motion.b, at_nodes], axis=1)
    columns = np.concatenate([np.real(b), -np.imag(b)])
    values = np.empty((steps + 1, columns.shape[1]))
    within = np.exp(np.outer(np.arange(_ROWS), h * s))
    within = (np.exp(np.outer(_ROWS * np.arange(_ROWS), h * s))[:, None] * within).reshape(_ROWS**2, -1)
    for first in range(0, steps + 1, _ROWS**2):
        factor = np.exp(first * h * s) * within[: steps + 1 - first]
        values[first : first + _ROWS**2] = (
            np.concatenate([np.real(factor), np.imag(factor)], axis=1) @ columns
        )
    state = np.concatenate([np.ones((steps + 1, 1)), values[:, : 2 * n]], axis=1)
    return state, values[:-1, 2 * n :].reshape(steps, stages, n)
