"""The one loop by which every size is chosen: of bases and meshes, numbers of modes, lengths of steps."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

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
