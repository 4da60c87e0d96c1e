"""Modal truncation error of loads, from their distance from a solution with more modes.

At the nodes of the modes that a larger model adds, the distance is small by chance, while other modes left
out are not.  So at each station the largest distance counts within half a wave of the first mode left out,
to either side.
"""

from __future__ import annotations

import numpy as np

from beamdyn.accuracy.margins import MODES_OF_FORCES, MODES_OF_MOMENTS
from beamdyn.loads.stations import SpanStations, StationOutputs
from beamdyn.modes.modal.modal_basis import ModalBasis

_LIMIT = 0.3  # distance over the largest along the span, up to which it bounds the error
_ROUNDING = 1e-12  # relative to the largest along the span
_BETWEEN = 21  # stations besides those asked for


def with_neighbours(stations: SpanStations) -> SpanStations:
    """The stations, then others evenly along the beam at which distances are found as well."""
    more = np.linspace(0, 1, _BETWEEN)
    return SpanStations(np.append(stations.xi, more), np.append(stations.inboard, more == 1))


def mode_error(
    distance: np.ndarray,
    along_span: np.ndarray,
    stations: SpanStations,
    outputs: StationOutputs,
    basis: ModalBasis,
    length: float,
) -> np.ndarray:
    """Estimate errors of outputs from distances of loads, with rounding errors.

    Parameters
    ----------
    distance : ndarray, shape (..., N, 1 + 2 d)
        Distance of the loads from those of more modes, at the N stations of `with_neighbours`.
    along_span : ndarray, shape (..., 1 + 2 d)
        Largest magnitude of the loads along the span.
    stations : SpanStations
        The S stations asked for.
    outputs : StationOutputs
        Outputs there.
    basis : ModalBasis
        The modes kept.
    length : float
        Length of the beam [m].

    Returns
    -------
    ndarray, shape (..., S, K)
        Infinite where the distance exceeds 0.3 of the largest value along the span, and rounding: then it
        does not bound the error.
    """
    modes = np.inf if basis.modes is None else basis.modes  # number of modes of each field
    near = np.abs(stations.xi[:, None] - with_neighbours(stations).xi) <= 1 / (modes + 0.5)
    nearby = np.where(near[..., None], distance[..., None, :, :], 0.0).max(axis=-2)
    planes = (distance.shape[-1] - 1) // 2
    factors = MODES_OF_MOMENTS.factor, MODES_OF_FORCES.factor, MODES_OF_MOMENTS.factor
    margins = np.repeat(factors, [1, planes, planes])
    force = along_span[..., : 1 + planes].max(axis=-1, keepdims=True)  # the largest, also on the whole length
    moment = np.maximum(along_span[..., 1 + planes :].max(axis=-1, keepdims=True), length * force)
    both = [np.repeat(force, 1 + planes, axis=-1), np.repeat(moment, planes, axis=-1)]
    rounding = through(outputs, (_ROUNDING * np.concatenate(both, axis=-1))[..., None, :])
    too_large = through(outputs, nearby) > _LIMIT * through(outputs, along_span[..., None, :]) + rounding
    return np.where(too_large, np.inf, through(outputs, margins * nearby) + rounding)


def through(outputs: StationOutputs, errors: np.ndarray) -> np.ndarray:
    """Errors of outputs (..., S, K) from those of the loads (..., S, 1 + 2 d), which add up."""
    weights = np.abs(outputs.matrix)
    with np.errstate(invalid="ignore"):  # what is infinite does not matter where it has no weight
        return np.where(weights != 0, weights * errors[..., None, :], 0.0).sum(axis=-1)
