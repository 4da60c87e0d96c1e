"""What is observed of a beam at steady speed: deflection or acceleration at a point, moment and strain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias, get_args

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, not_negative, one_of, set_fields
from beamdyn.linear.excitations import fraction_of, place_in_words
from beamdyn.scene.beam import Beam
from beamdyn.scene.direction import ACROSS, ALONG_BENDING, Direction, direction_of


@dataclass(frozen=True)
class DeflectionAt:
    """Deflection of a point of the beam [m], relative to axes that turn with the carrier.

    Parameters
    ----------
    position : float, optional
        Distance from the root along the beam [m]; the tip if not given.
    direction : {"bending", "across"}
        Direction of the bending angle, or across it.

    Raises
    ------
    ValueError
        If the position is negative, or the direction is unknown.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> where = bd.DeflectionAt(position=scene.beam.length / 2)
    >>> bd.frequency_response(scene, 50.0, [20.0], output=where).unit
    'm per m/s2'
    """

    position: float | None = None
    direction: Direction = ALONG_BENDING

    def __post_init__(self) -> None:
        one_of("direction", self.direction, get_args(Direction))
        if self.position is not None:
            set_fields(self, position=not_negative("position", self.position, "m"))

    @property
    def unit(self) -> str:
        """Unit of the output."""
        return "m"

    @property
    def label(self) -> str:
        """For tables and pictures."""
        return f"deflection {place_in_words(self.position, self.direction)}"

    def place(self, beam: Beam) -> tuple[float, int]:
        """Position x/L, and direction 0 or 1."""
        return fraction_of(self.position, beam), direction_of(self.direction)


@dataclass(frozen=True)
class AccelerationAt(DeflectionAt):
    """Acceleration of a point of the beam in space [m/s2], along a direction that turns with the carrier.

    It contains that of the root, and what rotation adds to a deflection; the constant acceleration towards
    the axis of rotation is left out, so that it is what an accelerometer without constant part measures.
    Over the acceleration of the base it is the transmissibility.

    Parameters
    ----------
    position, direction
        As for `DeflectionAt`.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], output=bd.AccelerationAt()).unit
    'm/s2 per m/s2'
    """

    @property
    def unit(self) -> str:
        """Unit of the output."""
        return "m/s2"

    @property
    def label(self) -> str:
        """For tables and pictures."""
        return f"acceleration {place_in_words(self.position, self.direction)}"


@dataclass(frozen=True)
class MomentAtRoot:
    """Bending moment at the root [N m], about the axis of bending of the section there.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], output=bd.MomentAtRoot()).unit
    'N m per m/s2'
    """

    @property
    def unit(self) -> str:
        """Unit of the output."""
        return "N m"

    @property
    def label(self) -> str:
        """For tables and pictures."""
        return "bending moment at the root"


@dataclass(frozen=True)
class StrainAtRoot:
    """Bending strain of the outer fibre at the root, in the section's first direction.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], output=bd.StrainAtRoot()).unit
    '1 per m/s2'
    """

    @property
    def unit(self) -> str:
        """Unit of the output."""
        return ""

    @property
    def label(self) -> str:
        """For tables and pictures."""
        return "strain at the root"

    @staticmethod
    def per_moment(beam: Beam) -> float:
        """Strain per bending moment [1/(N m)]; a ValueError where the beam has no outer fibre."""
        root = np.zeros(1)
        if beam.outer_fibre is None:
            bound, remedy = "the strain needs beam.outer_fibre", "give it to Beam.from_stiffness"
            raise InvalidValue("output", "root strain", bound, remedy)
        return float(beam.outer_fibre(root)[0] / beam.bending_stiffness(root)[0])


Observation: TypeAlias = DeflectionAt | AccelerationAt | MomentAtRoot | StrainAtRoot

_WORDS: dict[str, Observation] = {
    "tip": DeflectionAt(),
    "tip across": DeflectionAt(direction=ACROSS),
    "tip acceleration": AccelerationAt(),
    "root moment": MomentAtRoot(),
    "root strain": StrainAtRoot(),
}


def as_observation(name: str, given: Any) -> Observation:
    """An observation, which a word may stand for.

    Raises
    ------
    InvalidValue
        If it is neither, with the words.
    """
    if isinstance(given, str) and given in _WORDS:
        return _WORDS[given]
    if not isinstance(given, DeflectionAt | MomentAtRoot | StrainAtRoot):
        words = ", ".join(map(repr, _WORDS))
        objects = "a DeflectionAt(position) or an AccelerationAt(position)"
        raise InvalidValue(name, given, f"give {words}, {objects}")
    return given
