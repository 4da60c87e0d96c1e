"""Results of a bicycle caliper: over its stroke, with friction in the pivots, and with worn pads.

In shapes of arrays, S counts positions of the stroke.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.results.one_line import counted, error_at_most, number, spanned, warned
from beamdyn.common.results.result import Result, plain
from brakes.planar import Position, Stroke
from brakes.planar.statics import is_answer


@dataclass(frozen=True)
class CaliperStroke(Result):
    """Travel and forces of a caliper over its stroke, at S positions; pads in the order right, left.

    At every position the pads are loaded as if they touched the rim there.  Undetermined values are nan.

    Parameters
    ----------
    caliper : str
        Name of the caliper.
    status, message : str
        Worst status of all positions, as in `planar.Equilibrium`; "contact opens" also if a pad would have to
        pull.
    warnings : tuple of str
        One sentence for each toggle position.
    finger_force, tension : float
        Force of the finger on the hand lever and tension of the cable [N].
    lever_ratio : float
        Travel of the finger over the travel of the cable.
    cable, finger : ndarray, shape (S,)
        Travels of cable and finger from the open position [m].
    pad_travel : ndarray, shape (S, 2)
        Travel of each pad towards the rim [m].
    pad_ratio : ndarray, shape (S, 2)
        Velocity of each pad over the velocity of the cable.
    pad_force : ndarray, shape (S, 2)
        Force of each pad on the rim [N].
    advantage : ndarray, shape (S, 2)
        Force of each pad over the force of the finger.
    reactions : dict of ndarray, shape (S, 2)
        Force (x, y) of each joint on the body that it names first [N].
    magnitudes : dict of ndarray, shape (S,)
        Magnitude of each joint's reaction, as in `planar.Equilibrium` [N, or N m of a rotation lock].
    virtual_work : ndarray, shape (S,)
        Largest virtual work of the loads in a free motion, over the largest force: zero up to rounding.
    residual : ndarray, shape (S,)
        Largest residual force or moment on a body, over the largest force.
    error : ndarray, shape (S,)
        Error of the forces relative to the largest, as in `planar.Equilibrium`.
    motion : Stroke
        Positions of the bodies over the stroke.

    Examples
    --------
    >>> run = calipers.VBrake().build().stroke(finger=40.0)
    >>> float(abs(run.virtual_work).max()) < 1e-9  # the pads do the work of the finger
    True
    """

    field_units: ClassVar[dict[str, str]] = {
        "N": "finger_force tension pad_force reactions",
        "m": "cable finger pad_travel",
    }

    caliper: str
    status: str
    message: str
    warnings: tuple[str, ...]
    finger_force: float
    tension: float
    lever_ratio: float
    cable: np.ndarray
    finger: np.ndarray
    pad_travel: np.ndarray
    pad_ratio: np.ndarray
    pad_force: np.ndarray
    advantage: np.ndarray
    reactions: dict[str, np.ndarray]
    magnitudes: dict[str, np.ndarray]
    virtual_work: np.ndarray
    residual: np.ndarray
    error: np.ndarray
    motion: Stroke = field(repr=False)

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{self.caliper}, {counted(len(self.cable), 'position')}"
        yield f"cable to {number(1e3 * self.cable[-1], 'mm')}"
        yield f"advantage {number(self.total_advantage[-1])}"
        yield error_at_most(self.error)
        yield from (self.status, warned(self.warnings))

    @property
    def position(self) -> Position:
        """Positions of the bodies over the stroke."""
        return self.motion.position

    @property
    def total_advantage(self) -> np.ndarray:
        """Sum of both pads' forces over the force of the finger."""
        return self.advantage.sum(axis=1)

    @property
    def travel_symmetry(self) -> np.ndarray:
        """Velocity of the left pad over the velocity of the right pad."""
        return self.pad_ratio[:, 1] / self.pad_ratio[:, 0]

    @property
    def force_symmetry(self) -> np.ndarray:
        """Force of the left pad over the force of the right pad."""
        return self.pad_force[:, 1] / self.pad_force[:, 0]

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to plain numbers, lists and strings."""
        sets = {
            key: {name: plain(values) for name, values in getattr(self, key).items()}
            for key in ("reactions", "magnitudes")
        }
        more = {key: plain(getattr(self, key)) for key in ("travel_symmetry", "force_symmetry")}
        return super().to_dict() | sets | more


@dataclass(frozen=True)
class PivotFriction(Result):
    """Efficiency of a caliper with friction in the pivots, at one position.

    Parameters
    ----------
    coefficient : float
        Coefficient of friction of every pivot for which none is given.
    cable : float
        Travel of the cable [m].
    tension, squeezing_tension, releasing_tension : float
        Tension of the cable for the same pad forces in three cases: without friction, with friction while the
        lever is squeezed, and with friction while it is released [N].  Negative if the cable would have to
        push the brake open, nan if the brake jams.
    squeeze : float
        Efficiency while the lever is squeezed: tension without friction over tension with it.
    release : float
        Ratio while the lever is released: tension with friction over tension without; 0 if friction holds the
        brake.
    error : float
        Error of the forces with friction relative to the largest, as in `planar.Equilibrium`; nan if the
        brake jams.
    status, message : str
        "determined", or "self-locking", "contact opens" or "cable slackens" with the direction of motion.

    Examples
    --------
    >>> found = calipers.VBrake().build().friction(0.15)
    >>> 0 < found.squeeze < 1  # fraction of the force that reaches the pads
    True
    """

    field_units: ClassVar[dict[str, str]] = {"m": "cable", "N": "tension squeezing_tension releasing_tension"}

    coefficient: float
    cable: float
    tension: float
    squeezing_tension: float
    releasing_tension: float
    squeeze: float
    release: float
    error: float
    status: str
    message: str

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"coefficient {number(self.coefficient)}"
        yield f"efficiency {number(self.squeeze)} squeezing, {number(self.release)} releasing"
        yield self.status

    @property
    def has_answer(self) -> bool:
        """Whether the brake moves both ways with the cable tight and all contacts closed."""
        return is_answer(self.status, (self.squeezing_tension, self.releasing_tension))


@dataclass(frozen=True)
class PadWear(Result):
    """Travel to contact, and advantage there, with pads worn by W thicknesses and the cable not readjusted.

    Parameters
    ----------
    lost : ndarray, shape (W,)
        Thickness lost by each pad [m].
    cable, finger : ndarray, shape (W,)
        Travel of cable and finger at which the pads touch [m].
    advantage : ndarray, shape (W, 2)
        Force of the right and of the left pad over the force of the finger, where the pads touch.

    Examples
    --------
    >>> worn = calipers.VBrake().build().wear([0.0, 0.001])  # thickness in m
    >>> worn.lost.shape
    (2,)
    """

    field_units: ClassVar[dict[str, str]] = {"m": "lost cable finger"}

    lost: np.ndarray
    cable: np.ndarray
    finger: np.ndarray
    advantage: np.ndarray

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{spanned(1e3 * self.lost, 'mm')} lost"
        yield f"finger to {spanned(1e3 * self.finger, 'mm')}, advantage {spanned(self.advantage.sum(axis=1))}"
