"""Inputs and outputs of linear models: excitations of a beam, and observed quantities."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, TypeAlias, get_args

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, not_negative, one_of, positive, refuse, set_fields
from beamdyn.common.words import Named, Words
from beamdyn.equations.root_moment import strain_per_moment
from beamdyn.equations.root_motion import Quantity, root_motion
from beamdyn.scene.beam import Beam
from beamdyn.scene.harvester import Electrodes
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.mount import Mount
from beamdyn.scene.names_elsewhere import GIVE_IT
from beamdyn.scene.points import ACROSS, ALONG_BENDING, Direction, direction_of
from beamdyn.scene.scene import Scene

BaseDirection = Literal["bending", "across", "n1", "n2", "n3"]
_FIXED: tuple[str, ...] = ("n1", "n2", "n3")
_ROTATING: dict[str, Quantity] = {"bending": "root_transverse", "across": "root_across"}
_ACCELERATIONS: tuple[Quantity, ...] = ("root_axial", "root_transverse", "root_across")
_NEGLIGIBLE = 1e-15  # size up to which a component of a unit acceleration counts as 0

Accelerations: TypeAlias = "dict[Quantity, complex]"  # accelerations of the root, per unit of the input


@dataclass(frozen=True)
class BaseMotion:
    """Acceleration of the carrier's centre [m/s2], which the root follows.

    Parameters
    ----------
    direction : {"bending", "across", "n1", "n2", "n3"}
        Direction of the bending angle, or across it, both of which turn with the beam; or a fixed direction:
        n1 and n2 in the plane of rotation, n3 along its axis.  As the beam turns, an acceleration of the
        frequency f along n1 or n2 excites it at f + n and f - n, with n turns per second.

    Raises
    ------
    ValueError
        If the direction is unknown.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], input=bd.BaseMotion("n2")).input
    'base acceleration, n2 [m/s2]'
    """

    unit: ClassVar[str] = "m/s2"

    direction: BaseDirection = "bending"

    def __post_init__(self) -> None:
        one_of("direction", self.direction, get_args(BaseDirection))

    @property
    def label(self) -> str:
        """Name of the excitation in tables and pictures."""
        return f"base acceleration, {self.direction}"

    def accelerations(self, mount: Mount, speed: float) -> dict[int, Accelerations]:
        """Compute the root's accelerations in its axes, per unit of the input, for each harmonic of rotation.

        Harmonic h has the frequency of the input plus h times the speed; the angle of rotation is 0 at
        time 0.
        """
        if self.direction not in _FIXED:
            return {0: {_ROTATING[self.direction]: 1.0}}
        at_start, after_quarter = (_of_unit(mount, angle, self.direction) for angle in (0.0, np.pi / 2))
        if speed == 0 or self.direction == "n3":
            return {0: _without_zeros(at_start)}
        # Each acceleration x varies with the angle: x(theta) = x(0) cos(theta) + x(pi/2) sin(theta).
        return {
            h: _without_zeros({k: (at_start[k] - 1j * h * after_quarter[k]) / 2 for k in _ACCELERATIONS})
            for h in (-1, 1)
        }

    def force(self, beam: Beam) -> tuple[float, int] | None:
        """Return None, because base motion is not a force on the beam."""
        return None


def _of_unit(mount: Mount, angle: float, direction: str) -> Accelerations:
    """Compute the root's accelerations, at a rotation angle, for a unit acceleration in a fixed direction."""
    unit, zero = np.zeros(3), np.zeros(())
    unit[_FIXED.index(direction)] = 1.0
    root = root_motion(mount, MotionSample(np.array(angle), zero, zero, unit))
    return {name: float(getattr(root, name)) for name in _ACCELERATIONS}


def _without_zeros(values: Accelerations) -> Accelerations:
    return {name: value for name, value in values.items() if abs(value) > _NEGLIGIBLE}


@dataclass(frozen=True)
class PointForce:
    """Force on a point of the beam [N], in a direction that turns with the beam.

    Parameters
    ----------
    position : float, optional
        Distance from the root along the beam [m]; the tip if not given.
    direction : {"bending", "across"}
        Direction of the bending angle, or across it.

    Raises
    ------
    ValueError
        If the position is not positive, or the direction is unknown.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> found = bd.frequency_response(scene, 0.0, [1e-3], input=bd.PointForce(), output="tip")
    >>> by_hand = scene.beam.length**3 / (3 * scene.beam.bending_stiffness(0))
    >>> round(float(abs(found.response[0, 0]) / by_hand), 4)  # L^3/(3 EI)
    1.0
    """

    unit: ClassVar[str] = "N"

    position: float | None = None
    direction: Direction = ALONG_BENDING

    def __post_init__(self) -> None:
        one_of("direction", self.direction, get_args(Direction))
        if self.position is not None:
            remedy = "a force at the root, 0, moves nothing"
            set_fields(self, position=positive("position", self.position, "m", remedy))

    @property
    def label(self) -> str:
        """Name of the excitation in tables and pictures."""
        return f"force {place_in_words(self.position, self.direction)}"

    def accelerations(self, mount: Mount, speed: float) -> dict[int, Accelerations]:
        """Return no accelerations, because a force does not move the root."""
        return {0: {}}

    def force(self, beam: Beam) -> tuple[float, int]:
        """Return position x/L of the force and its direction: 0 that of the bending angle, 1 across it."""
        return fraction_of(self.position, beam), direction_of(self.direction)


Excitation: TypeAlias = BaseMotion | PointForce

_EXCITATIONS: dict[str, Excitation] = {
    **{name: BaseMotion(name) for name in get_args(BaseDirection)},
    "tip force": PointForce(),
    "tip force across": PointForce(direction=ACROSS),
}


def as_excitation(name: str, given: Any) -> Excitation:
    """Convert a word such as "tip force" to an excitation; an excitation is returned as it is.

    Raises
    ------
    InvalidValue
        If the argument is neither; the message lists the words.
    """
    if isinstance(given, str) and given in _EXCITATIONS:
        return _EXCITATIONS[given]
    if not isinstance(given, BaseMotion | PointForce):
        words = ", ".join(map(repr, _EXCITATIONS))
        objects = Named(", a BaseMotion(direction) or a PointForce(position)", ' or "force@20 mm"')
        raise InvalidValue(name, given, Words(f"give {words}", objects))
    return given


def place_in_words(position: float | None, direction: str) -> str:
    """Describe a point of the beam and a direction, such as "at 0.03 m, across"."""
    place = "at the tip" if position is None else f"at {position:.6g} m"
    return f"{place}, {direction}" if direction == ACROSS else place


def fraction_of(position: float | None, beam: Beam) -> float:
    """Convert a position [m] to the fraction x/L; raise InvalidValue beyond the tip."""
    if position is None:
        return 1.0
    bound = "it must be at most {limit}, the length"
    remedy = Named("the tip is where no position is given", "@tip is the tip")
    beyond = position > beam.length * (1 + 1e-12)
    refuse(beyond, "position", position, "m", bound, remedy, limit=beam.length)
    return min(position / beam.length, 1.0)


# Outputs of a beam at steady speed ----------------------------------------------------------------


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

    unit: ClassVar[str] = "m"
    _word: ClassVar[str] = "deflection"

    position: float | None = None
    direction: Direction = ALONG_BENDING

    def __post_init__(self) -> None:
        one_of("direction", self.direction, get_args(Direction))
        if self.position is not None:
            set_fields(self, position=not_negative("position", self.position, "m"))

    @property
    def label(self) -> str:
        """Name of the observation in tables and pictures."""
        return f"{self._word} {place_in_words(self.position, self.direction)}"

    def place(self, beam: Beam) -> tuple[float, int]:
        """Return position x/L and direction of the deflection: 0 that of the bending angle, 1 across it."""
        return fraction_of(self.position, beam), direction_of(self.direction)


@dataclass(frozen=True)
class AccelerationAt(DeflectionAt):
    """Acceleration of a point of the beam in space [m/s2], along a direction that turns with the carrier.

    The acceleration of the root is included, and what rotation adds: centripetal and Coriolis accelerations.
    The constant centripetal acceleration is left out, as many accelerometers do not measure constant values.
    Divided by the acceleration of the base, this is the transmissibility.

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

    unit: ClassVar[str] = "m/s2"
    _word: ClassVar[str] = "acceleration"


@dataclass(frozen=True)
class MomentAtRoot:
    """Bending moment at the root [N m], about the axis of bending of the section there.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], output=bd.MomentAtRoot()).unit
    'N m per m/s2'
    """

    unit: ClassVar[str] = "N m"
    label: ClassVar[str] = "bending moment at the root"


@dataclass(frozen=True)
class StrainAtRoot:
    """Bending strain at the root, of the outer fibre in the root section's direction of bending.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], output=bd.StrainAtRoot()).unit
    '1 per m/s2'
    """

    unit: ClassVar[str] = ""
    label: ClassVar[str] = "strain at the root"

    @staticmethod
    def per_moment(scene: Scene) -> float:
        """Compute the strain per bending moment [1/(N m)]; raise ValueError if no outer fibre is given."""
        if scene.beam.outer_fibre is None:
            raise InvalidValue("output", "root strain", "the strain needs beam.outer_fibre", GIVE_IT)
        return strain_per_moment(scene)


@dataclass(frozen=True)
class HarvestedVoltage:
    """Voltage across the load of a harvester [V].

    Examples
    --------
    >>> scene = bd.load_scene("examples/bimorph.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], output=bd.HarvestedVoltage()).unit
    'V per m/s2'
    """

    unit: ClassVar[str] = "V"
    label: ClassVar[str] = "voltage"

    def rows(self, electrodes: Electrodes, length: float) -> LayerRows:
        """Return the voltage in terms of the coordinates; raise ValueError for a short circuit."""
        if not electrodes.resistance:
            raise InvalidValue("output", "voltage", "a short circuit has none", "give harvester.resistance")
        return LayerRows(0, -1 / electrodes.capacitance(length))


@dataclass(frozen=True)
class HarvestedCurrent:
    """Current through the load of a harvester [A].

    Examples
    --------
    >>> scene = bd.load_scene("examples/bimorph.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], output=bd.HarvestedCurrent()).unit
    'A per m/s2'
    """

    unit: ClassVar[str] = "A"
    label: ClassVar[str] = "current"

    def rows(self, electrodes: Electrodes, length: float) -> LayerRows:
        """Return the current in terms of the coordinates; raise ValueError for an open circuit."""
        if math.isinf(electrodes.resistance):
            remedy = "give a finite harvester.resistance"
            raise InvalidValue("output", "current", "an open circuit has none", remedy)
        if not electrodes.resistance:
            return LayerRows(1, -1.0)
        return LayerRows(0, -1 / electrodes.capacitance(length) / electrodes.resistance)


@dataclass(frozen=True)
class LayerStrain:
    """Bending strain of the outer face of a piezoelectric layer.

    Parameters
    ----------
    position : float, optional
        Distance from the root along the beam [m]; where the layers begin if not given.

    Examples
    --------
    >>> scene = bd.load_scene("examples/bimorph.toml")
    >>> bd.frequency_response(scene, 50.0, [20.0], output=bd.LayerStrain()).unit
    '1 per m/s2'
    """

    unit: ClassVar[str] = ""
    label: ClassVar[str] = "strain of the layer"

    position: float | None = None

    def __post_init__(self) -> None:
        if self.position is not None:
            set_fields(self, position=not_negative("position", self.position, "m"))

    def place(self, electrodes: Electrodes, length: float) -> float:
        """Return the position of the strain as x/L; raise ValueError if no layer covers it."""
        (first, last), given = electrodes.span, self.position
        if given is None:
            return electrodes.inside(0.0)
        beside = not first * (1 - 1e-12) <= given / length <= last * (1 + 1e-12)
        bound, limit = ("begin", first) if given / length < first else ("end", last)
        bound = f"the layers {bound} at {{limit}}"
        refuse(beside, "position", given, "m", bound, "give a place on them", limit=limit * length)
        return electrodes.inside((given / length - first) / (last - first))


@dataclass(frozen=True)
class LayerRows:
    """Voltage or current of layers: `factor` times the `order`-th time derivative of the coupling theta^T q.

    Where a load closes the circuit, the charge that flows through it is added to theta^T q.
    """

    order: int
    factor: float


OfLayers: TypeAlias = HarvestedVoltage | HarvestedCurrent | LayerStrain
Observation: TypeAlias = DeflectionAt | AccelerationAt | MomentAtRoot | StrainAtRoot | OfLayers

_OBSERVATIONS: dict[str, Observation] = {
    "tip": DeflectionAt(),
    "tip across": DeflectionAt(direction=ACROSS),
    "tip acceleration": AccelerationAt(),
    "root moment": MomentAtRoot(),
    "root strain": StrainAtRoot(),
    "voltage": HarvestedVoltage(),
    "current": HarvestedCurrent(),
    "layer strain": LayerStrain(),
}


def as_observation(name: str, given: Any) -> Observation:
    """Convert a word such as "tip" to an output of the beam; an output is returned as it is.

    Raises
    ------
    InvalidValue
        If the argument is neither; the message lists the words.
    """
    if isinstance(given, str) and given in _OBSERVATIONS:
        return _OBSERVATIONS[given]
    if not isinstance(given, Observation):
        words = ", ".join(map(repr, _OBSERVATIONS))
        python = ", a DeflectionAt(position) or an AccelerationAt(position)"
        raise InvalidValue(name, given, Words(f"give {words}", Named(python, ' or "deflection@20 mm"')))
    return given
