"""Largest value, over the phases of rotation and road, of a sum of spectral lines (harmonics of both).

The sum is sampled at as many phases as its strong lines need; the largest maxima of the samples are refined
by Newton's method with all lines.

In shapes of arrays, S counts sums, H lines, d components, N samples, and R maxima.
"""

from __future__ import annotations

import numpy as np

_MAXIMA = 16  # number of largest local maxima of the samples that are refined
_LEAST_SAMPLE = 0.5  # samples below this fraction of the largest are not near the maximum (Riesz' inequality)
_MOST_STEPS = 20  # largest number of Newton's steps; more than a few are needed only near a saddle
_CONVERGED = 1e-15  # relative increase by one step below which the maximum has converged
# Lines count as weak if their sum is at most this fraction of the sum of all lines: weak lines shift maxima,
# but hardly add any.
_WEAK = 0.02
# Offset of the samples, in spacings of samples: symmetric sums have saddles at multiples of the spacing.
_OFFSET = np.array([0.21, 0.37])
_MOST_SAMPLES = 2**20  # number of samples evaluated at once: 8 MB


def largest_over_phases(amplitude: np.ndarray, harmonics: np.ndarray) -> np.ndarray:
    """Find the largest |u| of the vector u = sum_h Re(a_h exp(i h.phi)) over both phases phi.

    Parameters
    ----------
    amplitude : ndarray of complex, shape (S, d, lines)
        Complex amplitudes a_h of the lines, of d components.
    harmonics : ndarray of int, shape (lines, 2)
        Harmonics h of the lines.

    Returns
    -------
    ndarray, shape (S,)
    """
    largest = np.zeros(len(amplitude))
    if not len(harmonics):
        return largest
    size = np.abs(amplitude).sum(axis=1) * harmonics.any(axis=1)
    # Over the plane of both phases each line is a wave.  Waves with proportional harmonics are parallel;
    # others cross.  The strongest wave is constant along its crests, so that the waves that cross it decide
    # where on a crest the maximum is, however weak they are.  So a line counts as strong if it is large in
    # comparison with all lines, or only with the lines that cross the strongest one.
    j, k = harmonics.T
    crossing = (np.multiply.outer(j, k) != np.multiply.outer(k, j)).astype(float)
    others, share = size * crossing[size.argmax(axis=1)], _WEAK / len(harmonics)
    strong = np.any([each > share * each.sum(axis=1, keepdims=True) for each in (size, others)], axis=0)
    degrees = np.stack([(strong * np.abs(h)).max(axis=1) for h in harmonics.T], axis=1)
    for degree in np.unique(degrees, axis=0):  # highest |h| of strong lines: sets the number of samples
        rows = np.flatnonzero((degrees == degree).all(axis=1))
        for part in np.array_split(rows, 1 + len(rows) * int(np.prod(_grid(degree))) // _MOST_SAMPLES):
            largest[part] = _find_largest(amplitude[part], harmonics, degree)
    return largest


def _grid(degree: np.ndarray) -> np.ndarray:
    """Return the numbers of samples of the two phases, shape (2,), for harmonics up to a degree (2,)."""
    return np.where(degree > 0, 6 * (degree.max() + 1), 1)


def _find_largest(amplitude: np.ndarray, harmonics: np.ndarray, degree: np.ndarray) -> np.ndarray:
    """Find the largest magnitude of S sums of lines, shape (S,).

    The sums are first sampled with the harmonics up to `degree` (2,) only.
    """
    grid = _grid(degree)
    owner, place = _find_maxima(_sample(amplitude, harmonics, degree))
    phases = (place + _OFFSET) * (2 * np.pi / grid)
    best = np.zeros(len(amplitude))
    for _ in range(_MOST_STEPS):
        size, slope, curvature = _evaluate_size(amplitude[owner], harmonics, phases)
        np.maximum.at(best, owner, np.abs(size))
        step = _ascent_step(size, slope, curvature, 2 * np.pi / grid.max())
        left = np.abs((slope * step).sum(axis=1)) > _CONVERGED * np.abs(size)
        if not left.any():
            break
        owner, phases = owner[left], (phases + step)[left]
    return best


def _sample(amplitude: np.ndarray, harmonics: np.ndarray, degree: np.ndarray) -> np.ndarray:
    """Sample the magnitude of S sums of lines on a grid of the two phases: (S, samples, samples).

    Only harmonics up to a degree (2,) are included.
    """
    S, d, _ = amplitude.shape
    kept, grid = np.flatnonzero((np.abs(harmonics) <= degree).all(axis=1)), _grid(degree)
    theta, chi = (2 * np.pi / N * (np.arange(N) + offset) for N, offset in zip(grid, _OFFSET, strict=True))
    j, k = harmonics[kept].T[..., None, None]
    angle = (j * theta[:, None] + k * chi).reshape(len(kept), grid.prod())
    a = amplitude[..., kept].reshape(S * d, -1)
    u = (np.real(a) @ np.cos(angle) - np.imag(a) @ np.sin(angle)).reshape(S, d, *grid)
    return np.abs(u[:, 0]) if d == 1 else np.hypot.reduce(u, axis=1)


def _find_maxima(sampled: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the R largest local maxima of sampled sums (sums, N, N).

    Return for each the index of its sum, shape (R,), and the two indices of its sample, shape (R, 2).
    """
    highest = sampled
    for axis in (1, 2):  # np.roll compares neighbours across the ends, too: the phases are periodic
        beside = np.roll(highest, 1, axis), np.roll(highest, -1, axis)
        highest = np.maximum(np.maximum(highest, beside[0]), beside[1])
    flat = np.where(sampled >= highest, sampled, -1.0).reshape(len(sampled), -1)
    chosen = np.argpartition(-flat, min(_MAXIMA, flat.shape[1] - 1), axis=1)[:, :_MAXIMA]
    value = np.take_along_axis(flat, chosen, axis=1)
    owner, column = np.nonzero(value >= _LEAST_SAMPLE * value.max(axis=1, initial=0, keepdims=True))
    return owner, np.stack(np.unravel_index(chosen[owner, column], sampled.shape[1:]), axis=-1)


def _ascent_step(value: np.ndarray, slope: np.ndarray, curvature: np.ndarray, longest: float) -> np.ndarray:
    """Compute Newton's step of the two phases towards a larger magnitude, shape (R, 2).

    The absolute values of the principal curvatures are used, so that the iteration does not end at saddles;
    along each principal direction the step is at most `longest` [rad].
    """
    k, axes = np.linalg.eigh(curvature)
    size = np.abs(k)
    inverse = np.where(size > 1e-8 * size.max(axis=-1, keepdims=True), 1 / np.where(size > 0, size, 1), 0)
    along = np.einsum("rab,ra->rb", axes, slope) * inverse * np.sign(value)[..., None]
    return np.einsum("rab,rb->ra", axes, np.clip(along, -longest, longest))


def _evaluate_size(
    a: np.ndarray, h: np.ndarray, phases: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Evaluate the signed magnitude of vectors that are sums of lines, and its derivatives.

    The magnitude has the sign of the vector's first component.  Return it with its gradient and second
    derivatives with respect to the two phases: shapes (sums,), (sums, 2) and (sums, 2, 2).  The arguments are
    those of `_evaluate`.
    """
    u, slope, curvature = _evaluate(a, h, phases)
    if u.shape[1] == 1:
        return u[:, 0], slope[:, 0], curvature[:, 0]
    size = np.copysign(np.hypot.reduce(u, axis=1), u[:, 0])
    divisor = np.where(size == 0, 1.0, size)
    direction = u / divisor[:, None]
    along = np.einsum("rd,rda->ra", direction, slope)
    # Part of the derivative of the vector u that changes its direction only, not its magnitude.
    turning = slope - direction[..., None] * along[:, None]
    bending = np.einsum("rd,rdab->rab", direction, curvature)
    sideways = turning / divisor[:, None, None]
    return size, along, bending + np.einsum("rda,rdb->rab", turning, sideways)


def _evaluate(a: np.ndarray, h: np.ndarray, phases: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Evaluate sums of lines and their derivatives, each at its own pair of phases.

    The amplitudes a have the shape (sums, components, lines), the harmonics h (lines, 2), and the phases
    (sums, 2).  The derivatives are the gradient and the second derivatives with respect to the two phases.
    """
    first = h.astype(float)
    second = np.concatenate(
        [np.ones((len(h), 1)), -(first[:, :, None] * first[:, None]).reshape(-1, 4)], axis=1
    )
    angle = (phases @ first.T)[:, None]
    cos, sin = np.cos(angle), np.sin(angle)
    value = (np.real(a) * cos - np.imag(a) * sin) @ second
    slope = -(np.real(a) * sin + np.imag(a) * cos) @ first
    return value[..., 0], slope, value[..., 1:].reshape(*a.shape[:2], 2, 2)
