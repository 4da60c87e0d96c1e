"""Ranges of equal cycles that do the damage of counted ones."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class EquivalentRange:
    """The range of equal cycles that do the damage of those counted at one station, by Miner's rule.

    Parameters
    ----------
    quantity : str
        "force", "moment", "curvature", "strain" or "stress".
    component : int
        Index of its component.
    x : float
        Position along the beam [m].
    start, end : float
        The time window [s].
    exponent : float
        Exponent m of the Woehler curve.
    cycles : float
        Number of equal cycles.
    range : float
        Their range [unit of the quantity].
    error : float
        Its estimated absolute error [unit of the quantity].
    """

    quantity: str
    component: int
    x: float
    start: float
    end: float
    exponent: float
    cycles: float
    range: float
    error: float
