"""A pedal or lever with a booster: its output force, and the limits of the force on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked
from beamdyn.common.inputs.checks import one_of
from beamdyn.common.inputs.described import Described
from brakes.common.limits import LIMITS

Limb = Literal["foot", "hand", "grip", "bicycle"]
_LIMB = "what presses: a foot, a hand, a squeezed grip of a truck, or a hand on a bicycle's lever"


@dataclass(frozen=True)
class Pedal:
    """A pedal or lever and its booster; every number may be an array, one entry per design.

    The rod behind the pedal has `ratio` times the pedal's force; a booster multiplies this up to its run-out,
    past which only the driver's force adds: output = rod + (booster - 1) min(rod, runout).

    Parameters
    ----------
    ratio : float or ndarray
        Travel of the pedal over the travel of its rod.
    force : float or ndarray
        Force on the pedal [N].
    operated_by : {"foot", "hand", "grip", "bicycle"}
        Control: a foot pedal, a lever pulled by hand, a truck's grip squeezed by hand, or a bicycle's brake
        lever.
    booster : float or ndarray
        Force behind the booster over the force of the rod, up to the run-out.
    runout : float or ndarray, optional
        Force of the rod at which the booster reaches its largest assistance [N]; never reached if not given.
    travel : float or ndarray, optional
        Largest travel of the pedal [m]; not checked if not given.

    Raises
    ------
    ValueError
        If a value is out of bounds.

    Examples
    --------
    >>> float(chain.Pedal(ratio=5.0, force=450.0, booster=3.0, runout=2000.0).output_force)  # N
    6250.0
    """

    ratio: Annotated[Numbers, Described("", "i", "travel of pedal or lever over that of its rod", above=0)]
    force: Annotated[Numbers, Described("N", "F", "force on the pedal or lever", above=0)]
    operated_by: Annotated[Limb, Described(meaning=_LIMB)] = "foot"
    booster: Annotated[Numbers, Described("", "k", "booster: its output over the rod's force", least=1)] = 1.0
    runout: Annotated[
        Numbers | None,
        Described(
            "N", "", "force of the rod where the booster's help stops growing; none if not given", above=0
        ),
    ] = None
    travel: Annotated[
        Numbers | None, Described("m", "", "largest travel; not checked if not given", above=0)
    ] = None

    def __post_init__(self) -> None:
        one_of("operated_by", self.operated_by, tuple(LIMITS))
        keep_checked(self)

    @property
    def allowed_force(self) -> float:
        """Largest force on the pedal that the standards allow [N]; see `brakes.common.limits`."""
        return LIMITS[self.operated_by][0]

    @property
    def output_force(self) -> Numbers:
        """Output force behind the booster [N]."""
        rod = self.ratio * self.force
        most = np.inf if self.runout is None else self.runout
        return (rod + (self.booster - 1) * np.minimum(rod, most))[()]

    def rod_force_for(self, output: Numbers) -> Numbers:
        """Compute the rod's force [N] at which the booster gives an output force [N]."""
        assisted = output / self.booster
        if self.runout is None:
            return assisted
        return np.maximum(assisted, output - (self.booster - 1) * self.runout)[()]
