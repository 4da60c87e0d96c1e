"""The loop that refines an answer to its tolerance, and the table of margins by which errors are stated.

Two answers of different sizes, such as by a basis and a smaller one, differ by about the larger error.
A stated error is a margin times such a distance.  Each margin is given here, with the reason for its size and
the benchmark that measures whether the errors that are stated with it cover the true ones.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np


class ErrorMargin(NamedTuple):
    """A factor between a distance of two answers, or a tolerance, and the error that is stated.

    Parameters
    ----------
    factor : float
        Ratio of the error to the distance.
    distance : str
        Names of the answers that are compared.
    reason : str
        Why the factor is as large as it is.
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
    "further functions together may change a mode more than the last ones did",
    "stated_frequency_errors",
)
BASES_OF_FIELDS = ErrorMargin(
    12.0,
    "the same with two planes, shear or springs at the root",
    "a mode may lack functions of one field only, which both bases lack",
    "stated_physics_errors",
)
ROUNDING_OF_TWO = ErrorMargin(
    1.5,
    "rounding errors of one of two models that are compared",
    "where both have the same matrices, they have the same errors, which do not show",
    "stated_frequency_errors",
)
BASES_OF_PLATES = ErrorMargin(
    1.5,
    "frequencies of a strip as a plate in two bases of up to 12 functions along and across",
    "stresses in the corners of the clamp make convergence algebraic: the error is up to 1.6 distances",
    "stated_plate_errors",
)
LINEAR_MESHES = ErrorMargin(
    2.0,
    "responses and poles of two discretizations",
    "they converge as fast as the frequencies, of which peaks magnify the errors",
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
    "loads in equilibrium converge regularly, at stations unlike at others",
    "stated_load_errors",
)
MODES_OF_MOMENTS = ErrorMargin(
    3.0,
    "moments and strains with half as many modes more",
    "after a sudden load modes fall as k^-3: those left out are up to 2.2 times those added",
    "stated_load_errors",
)
MODES_OF_FORCES = ErrorMargin(
    4.0,
    "shear forces with half as many modes more",
    "they fall as k^-2: those left out are up to 3 times those added",
    "stated_load_errors",
)
STEPS = ErrorMargin(
    1.5,
    "motion by steps with two more stages",
    "local errors of a sample of all steps are added up",
    "stated_transient_errors",
)
EFFECTS = ErrorMargin(
    0.5,
    "tolerance of a physics that is chosen, over the sizes of what it leaves out",
    "the size of an effect may be estimated too low by a factor of two",
    "automatic_physics",
)

THREE_DISCRETIZATIONS = ErrorMargin(
    4.0,
    "poles, limits of the setting angle and coefficients of amplitude, as far as they still change",
    "the rate of convergence, by which they do, varies from one discretization to the next",
    "stated_answer_errors",
)
# Least share of the distance before the last that counts, as the last may be small by chance.
_LEAST_SHARE = 0.0015


def error_of_finest(
    margin: ErrorMargin,
    distance: np.ndarray | float,
    before: np.ndarray | float,
    rounding: np.ndarray | float = 0.0,
) -> np.ndarray:
    """Estimate the error of the finest of three answers from the distances between them.

    Where every distance is the one before times a ratio r < 1, all those that remain add up to r / (1 - r) of
    the last.

    Parameters
    ----------
    margin : ErrorMargin
        The margin of the error.
    distance : ndarray or float
        Distance of the finest answer from the second.
    before : ndarray or float
        Distance of the second from the coarsest; not finite if it is not known.
    rounding : ndarray or float
        Distance up to which two answers may differ by rounding, to which no ratio applies.

    Returns
    -------
    ndarray
        Estimated error: the margin times the sum of the distances that remain, which is at most the last
        distance and at least 0.0015 of the distance before.

    Examples
    --------
    >>> error_of_finest(THREE_DISCRETIZATIONS, np.array([1e-4, 1e-4]), np.array([1.1e-3, 1e-5])).round(7)
    array([4.e-05, 4.e-04])
    """
    size, larger = np.abs(distance), np.where(np.isfinite(before), np.abs(before), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        remains = np.where(2 * size < larger, size / (larger - size), 1.0)
    return margin.factor * np.maximum(
        np.maximum(remains * size, _LEAST_SHARE * larger), np.minimum(size, rounding)
    )


Answer = TypeVar("Answer")


def refine(
    first: Answer, finer: Callable[[Answer], Answer | None], meets: Callable[[Answer], bool]
) -> Answer:
    """Refine an answer until it meets its tolerance, or until nothing finer is available or worth its time.

    Parameters
    ----------
    first : Answer
        The answer of the smallest size.
    finer : callable
        Function from an answer to the one of the next larger size; None to keep the given one.
    meets : callable
        Function that tells whether an answer is accurate enough.

    Returns
    -------
    Answer
        The first that is accurate enough, or the last.

    Examples
    --------
    >>> refine(1.0, lambda x: (x + 2 / x) / 2, lambda x: abs(x * x - 2) < 1e-12)
    1.414213562373095
    """
    answer = first
    while not meets(answer) and (better := finer(answer)) is not None:
        answer = better
    return answer
