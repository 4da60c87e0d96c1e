"""Warnings of a tolerance that a motion in time does not meet: what was reached, and what to do."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from beamdyn.common.results.statements import TOLERANCE, Statement


def warn_of_missed_modes(error: float, tolerance: float, basis: str) -> Iterator[Statement]:
    """Warn of a modal truncation error that exceeds the tolerance.

    Parameters
    ----------
    error : float
        Estimated modal truncation error, over the largest deflection; inf if it is not known.
    tolerance : float
        The tolerance that was asked for.
    basis : str
        The modal basis, in words.

    Yields
    ------
    Statement
    """
    if error > tolerance:
        size = f"{error:.2g} of the largest deflection" if np.isfinite(error) else "not known"
        remedy = "give a larger tolerance, a smoother motion, or the number of modes yourself"
        yield Statement(
            f"tolerance = {tolerance:g} is not reached: the estimated modal truncation error is {size} with "
            f"{basis}, and more would take too long or too much memory; a sudden motion excites very many: ",
            remedy,
            kind=TOLERANCE,
            quantity="modal truncation error over the largest deflection",
            value=error,
            limit=tolerance,
            remedy=remedy,
        )


def warn_of_missed_steps(error: float, tolerance: float) -> Iterator[Statement]:
    """Warn of a time-integration error, over the largest deflection, that exceeds the tolerance."""
    if error > tolerance:
        remedy = "give a larger tolerance"
        yield Statement(
            f"tolerance = {tolerance:g} is not reached: the estimated time-integration error is {error:.2g} "
            "of the largest deflection, and smaller steps would only add rounding errors; ",
            remedy,
            kind=TOLERANCE,
            quantity="time-integration error over the largest deflection",
            value=error,
            limit=tolerance,
            remedy=remedy,
        )
