"""Refinement of a result until it meets its tolerance, and the table of safety factors of error estimates.

Two results from models of different size, such as a basis and a smaller basis, differ by about the larger
error.  A stated error is a margin times this difference.  Each margin is defined here, with the reason for
its size and the benchmark that measures whether the stated errors exceed the true errors.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np


class ErrorMargin(NamedTuple):
    """Safety factor by which the difference of two results is multiplied to state an error.

    The margin `EFFECTS` is used in another way: effects are added to the model until the estimated sizes of
    the neglected ones add up to at most this factor times the tolerance.

    Parameters
    ----------
    factor : float
        Ratio of the stated error to the difference.
    distance : str
        Description of the two results that are compared.
    reason : str
        Reason for the size of the factor.
    evidence : str
        Name of the benchmark that measures whether the factor suffices.
    """

    factor: float
    distance: str
    reason: str
    evidence: str


SLOW_BASES = ErrorMargin(
    3.0,
    "frequencies of two Ritz bases, where convergence is slow",
    "all basis functions left out may together change a mode more than those that were added last",
    "stated_frequency_errors",
)
BASES_OF_FIELDS = ErrorMargin(
    12.0,
    "frequencies of two Ritz bases, with two planes of bending, shear or springs at the root",
    "a mode may need more functions of one field, such as shear, and neither basis has them",
    "stated_physics_errors",
)
ROUNDING_OF_TWO = ErrorMargin(
    1.5,
    "rounding errors in the frequencies of two models that are compared",
    "rounding errors that both models share, as with equal matrices, do not show in their difference",
    "stated_frequency_errors",
)
BASES_OF_PLATES = ErrorMargin(
    1.5,
    "frequencies of a strip, modelled as a plate, in two bases of up to 12 functions along and across",
    "corner stresses at the clamp make convergence algebraic: functions left out may change a "
    "frequency more than the last ones added did",
    "stated_plate_errors",
)
LINEAR_MESHES = ErrorMargin(
    2.0,
    "responses and poles of two discretizations",
    "responses converge as fast as the frequencies, but resonance peaks magnify errors of frequencies",
    "responses",
)
LINEAR_MODES = ErrorMargin(
    4.0,
    "responses with all modes and with half as many",
    "the two may agree by chance at a frequency",
    "responses",
)
BASES_OF_STATIC_LOADS = ErrorMargin(
    1.5,
    "loads along the span of two discretizations",
    "loads in equilibrium converge regularly, but at a different rate at each station",
    "stated_load_errors",
)
MODES_OF_MOMENTS = ErrorMargin(
    3.0,
    "moments and strains with n modes and with 1.5 n modes",
    "after a sudden load, mode k contributes ~ k^-3: all modes above n contribute up to 2.2 times as much "
    "as modes n + 1 to 1.5 n",
    "stated_load_errors",
)
MODES_OF_FORCES = ErrorMargin(
    4.0,
    "shear forces with n modes and with 1.5 n modes",
    "mode k contributes ~ k^-2: modes above n contribute up to 3.6 times as much as n + 1 to 1.5 n",
    "stated_load_errors",
)
STEPS = ErrorMargin(
    1.5,
    "motion by time steps of Gauss collocation, and with two more stages in each step",
    "errors of single steps are computed for a sample of all steps, and added up",
    "stated_transient_errors",
)
EFFECTS = ErrorMargin(
    0.5,
    "tolerance of an automatic choice of physics, and the largest estimated size of neglected effects",
    "the size of an effect may be estimated too low by a factor of two",
    "automatic_physics",
)

THREE_DISCRETIZATIONS = ErrorMargin(
    4.0,
    "poles, limits of the setting angle, and coefficients of backbone curves, of three discretizations",
    "the rate of convergence varies from one discretization to the next",
    "stated_answer_errors",
)
# Lower limit of an error estimated from three results, before the safety factor: a fraction of the difference
# between the two coarser results, since the difference between the two finer ones may be small by chance.
_LEAST_SHARE = 0.0015


def error_of_finest(
    margin: ErrorMargin,
    distance: np.ndarray | float,
    before: np.ndarray | float,
    rounding: np.ndarray | float = 0.0,
) -> np.ndarray:
    """Estimate the error of the finest of three results from the differences between them.

    If each difference is r < 1 times the previous one, the sum of all further differences is r / (1 - r)
    times the last.

    Parameters
    ----------
    margin : ErrorMargin
        Safety factor of the error.
    distance : ndarray or float
        Difference of the finest result from the second.
    before : ndarray or float
        Difference of the second result from the coarsest; not finite if it is not known.
    rounding : ndarray or float
        Difference of two results that rounding may cause; the ratio r does not apply to it.

    Returns
    -------
    ndarray
        Estimated error: the margin times the sum of all further differences, which is limited to at most the
        last difference and at least 0.0015 of the previous one.

    Examples
    --------
    >>> error_of_finest(THREE_DISCRETIZATIONS, np.array([1e-4, 1e-4]), np.array([1.1e-3, 1e-5])).round(7)
    array([4.e-05, 4.e-04])
    """
    size, larger = np.abs(distance), np.where(np.isfinite(before), np.abs(before), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        remains = np.where(2 * size < larger, size / (larger - size), 1.0)
    least = np.minimum(size, rounding)
    return margin.factor * np.maximum(np.maximum(remains * size, _LEAST_SHARE * larger), least)


Answer = TypeVar("Answer")


def refine(
    first: Answer, finer: Callable[[Answer], Answer | None], meets: Callable[[Answer], bool]
) -> Answer:
    """Refine a result until it meets its tolerance, or until no finer one is available or worth the time.

    Parameters
    ----------
    first : Answer
        Result of the smallest model.
    finer : callable
        Function that takes a result and returns the result of the next larger model, or None if there is no
        larger model or it is not worth the time: the result that it was given is then the last one.
    meets : callable
        Function that returns whether a result is accurate enough.

    Returns
    -------
    Answer
        The first result that is accurate enough, or the last one.

    Examples
    --------
    >>> refine(1.0, lambda x: (x + 2 / x) / 2, lambda x: abs(x * x - 2) < 1e-12)
    1.414213562373095
    """
    answer = first
    while not meets(answer) and (better := finer(answer)) is not None:
        answer = better
    return answer
