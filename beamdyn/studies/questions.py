"""Questions that a study answers: kinds of results, their units and options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.scene import Scene
from beamdyn.studies.batched import Refinement
from beamdyn.studies.resonance_speeds import PossibleCrossing

OF_RESPONSES = 1e-5  # default tolerance of `steady_response` and `sweep`
MODES = 3  # default number of modes for frequencies and crossings
WINDOW = (20.0, 30.0)  # default time window for peaks [s]


What: TypeAlias = Literal[
    "frequencies", "critical_speed", "crossings", "amplitude", "peak", "strain", "power"
]


@dataclass(frozen=True)
class Kind:
    """Kind of result that a study can compute, such as natural frequencies.

    Parameters
    ----------
    word : str
        Name of one number of the result, such as "frequency".
    unit : str
        Unit of the numbers.
    has_speed : bool
        Whether the result depends on a speed, which may be varied.
    options : tuple of str
        Options on which the result depends, out of "speed", "modes" and "window".
    needs_motion : bool
        Whether the result depends on the scene's motion.
    """

    word: str
    unit: str
    has_speed: bool
    options: tuple[str, ...] = ()
    needs_motion: bool = False


KINDS = {
    "frequencies": Kind("frequency", "Hz", True, ("speed", "modes")),
    "critical_speed": Kind("critical speed", "rad/s", False),
    "crossings": Kind("resonance speed", "rad/s", False, ("speed", "modes")),
    "amplitude": Kind("steady amplitude", "m", True, ("speed",), needs_motion=True),
    "peak": Kind("peak", "m", True, ("speed", "window"), needs_motion=True),
    "strain": Kind("largest strain", "", True, ("speed",), needs_motion=True),
    "power": Kind("mean power", "W", True, ("speed",), needs_motion=True),
}
OPTIONS = {what: kind.options for what, kind in KINDS.items()}


@dataclass(frozen=True)
class StudyQuestion:
    """Question that a study asks of every design.

    Parameters
    ----------
    scene : Scene
        The scene, whose inputs are varied.
    what : str
        Name of the result in `KINDS`.
    speed : float
        Speed of designs that do not vary it, and top speed of crossings [rad/s].
    modes : int
        Number of modes.
    discretization, tolerance
        As for `natural_modes`; the tolerance of responses and peaks as for `steady_response` and `sweep`.
    window : tuple of float
        Time window of a peak [s].
    resonances : sequence of PossibleCrossing
        Crossings whose speeds are the numbers of a result, in this order.
    """

    scene: Scene
    what: str
    speed: float
    modes: int
    discretization: DiscretizationChoice
    tolerance: float | None
    window: tuple[float, float] = WINDOW
    resonances: Sequence[PossibleCrossing] = ()

    @property
    def kind(self) -> Kind:
        """Kind of the result, from `KINDS`."""
        return KINDS[self.what]

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the numbers of one result, if it has several; otherwise empty."""
        if self.what == "crossings":
            return tuple(each.label for each in self.resonances)
        return tuple(f"mode {i + 1}" for i in range(self.modes)) if self.what == "frequencies" else ()

    def refinement(self, reference: Scene) -> Refinement:
        """Return the bases in which designs that are similar to a reference design are solved."""
        return Refinement(reference, self.modes, self.discretization, self.tolerance)

    @property
    def numbers(self) -> int:
        """How many numbers the result of a design has at each speed."""
        return len(self.labels) if self.what in ("frequencies", "crossings") else 1
