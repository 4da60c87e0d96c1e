"""Period of the coefficients in a scene's equations of motion, from the frequencies of its motion."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.words import Words
from beamdyn.scene.motion import Rotation
from beamdyn.scene.names_elsewhere import REPEATING
from beamdyn.scene.scene import Scene

MOST_TURNS = 64  # largest number of cycles of the first phase in a common period of all phases
_MOST_OTHERS = MOST_TURNS**2  # largest number of cycles of any other phase in a common period
_COMMENSURATE = 1e-12  # relative distance from a fraction at which a frequency ratio counts as this fraction


class Period(NamedTuple):
    """Period after which the coefficients of the equations of motion repeat.

    Parameters
    ----------
    time : float
        Length of the period [s].
    turns : int
        Number of cycles of the first phase in this time.
    """

    time: float
    turns: int


def rates_of(scene: Scene) -> tuple[float, ...]:
    """Return the angular frequencies [rad/s] of the phases that the coefficients of the equations depend on.

    The angle of rotation is one of them if gravity, or an acceleration of the carrier, has a fixed direction.

    Raises
    ------
    InvalidValue
        If there is no motion, or if it is not periodic.
    """
    motion = scene.motion
    if motion is None:
        remedy = Words("such as ", REPEATING)
        raise InvalidValue("scene.motion", None, "stability needs a periodic motion", remedy)
    rates = tuple(map(abs, motion.rates))
    if isinstance(motion, Rotation) and not scene.gravity and len(rates) > 1:
        rates = rates[1:]
    rates = tuple(rate for rate in rates if rate)
    if not rates:
        bound = "the carrier stands still, and nothing pulsates"
        raise InvalidValue("scene.motion", motion, bound, "use natural_modes, or let it rotate or pulsate")
    return rates


def meet_again(scene: Scene) -> bool:
    """Return whether the phases of the motion have a common period within the limits of `period_of`."""
    rates = rates_of(scene)
    return all(_is_fraction(rate / rates[0]) for rate in rates)


def period_of(scene: Scene) -> Period:
    """Find the smallest period of the coefficients of the equations of motion.

    Raises
    ------
    InvalidValue
        As for `rates_of`, or if the phases have no common period within 64 cycles of the first phase, or 4096
        of another one.
    """
    rates = rates_of(scene)
    turns = math.lcm(*(_fraction(rate, rates[0]).denominator for rate in rates))
    return Period(2 * math.pi / rates[0] * turns, turns)


def _is_fraction(ratio: float) -> bool:
    """Return whether a ratio is a fraction of two small whole numbers, within rounding."""
    found = Fraction(ratio).limit_denominator(MOST_TURNS)
    return abs(found - Fraction(ratio)) <= _COMMENSURATE * ratio and found.numerator <= _MOST_OTHERS


def _fraction(rate: float, first: float) -> Fraction:
    """Return the ratio of two frequencies as a fraction; raise an error unless it has small whole numbers."""
    ratio = rate / first
    found = Fraction(ratio).limit_denominator(MOST_TURNS)
    nearest = min(max(found, Fraction(1, MOST_TURNS)), Fraction(_MOST_OTHERS))
    if not _is_fraction(ratio):
        within = f"{MOST_TURNS} periods of the first and {_MOST_OTHERS} of the other"
        bound = f"its rates {first:.9g} and {rate:.9g} rad/s do not meet again within {within}"
        remedy = (
            f"take the ratio {nearest.numerator}/{nearest.denominator}; floquet_multipliers says of one "
            "scene with two such rates whether it is stable"
        )
        raise InvalidValue("scene.motion", ratio, bound, remedy)
    return found
