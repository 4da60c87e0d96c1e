"""The one loop by which every size is chosen, and the one table of margins by which errors are stated.

Two answers of different sizes, such as by a basis and a smaller one, differ by about the error of the worse.
A stated error is a margin times such a distance.  Each margin stands here, with the reason for its size and
the benchmark that measures whether the errors that are stated with it cover the true ones.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeVar


class ErrorMargin(NamedTuple):
    """A factor between a distance, or a tolerance, and the error that is stated or aimed at.

    Parameters
    ----------
    factor : float
        Error over distance.
    distance : str
        Names of what is compared.
    reason : str
        Why the factor is as large as it is.
    evidence : str
        Name of the benchmark that measures it.
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


Answer = TypeVar("Answer")


def refine(
    first: Answer, finer: Callable[[Answer], Answer | None], meets: Callable[[Answer], bool]
) -> Answer:
    """Refine an answer until it meets its tolerance, or until nothing finer can be had or is worth its time.

    Parameters
    ----------
    first : Answer
        The answer of the smallest size.
    finer : callable
        The answer of the next larger size, by the one before; None to keep that one.
    meets : callable
        Whether an answer is accurate enough.

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
