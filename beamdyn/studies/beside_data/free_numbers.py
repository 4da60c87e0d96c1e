"""Numbers of a scene that a fit may change, scaled to variables of size 1 with bounds.

The variable of a root spring is its relative compliance, the beam's bending stiffness EI/L over the spring
stiffness: frequencies are nearly linear in it, and it is 0 for a clamped root.  Other numbers are divided by
their values in the scene, or by a corresponding size of the beam if that is larger.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from beamdyn.common.inputs.checks import InvalidValue, positive
from beamdyn.scene.numbers import check_path, is_speed, number_at, with_numbers
from beamdyn.scene.profile import mean
from beamdyn.scene.scene import Scene
from beamdyn.studies.sensitivities.sensitivity_result import SceneNumber, numbers_of

Bounds = tuple[float, float]

SPRINGS = ("mount.root_stiffness", "mount.second_root_stiffness")
_STEP = 0.01  # difference step of a number (`SceneNumber.step`), as a fraction of its size
_RIGID = 1e-6  # smallest relative compliance in a fit
_CLAMPED = 1e-5  # relative compliance below which the root counts as clamped
_FIRST = 0.1  # start value of the variable of a spring or body that the scene does not have
_SOFTEST = 1e3
_TIMES = 10.0  # a number is searched between a tenth of its value and ten times its value
_TURN = math.pi / 2  # an angle is searched within 90 degrees on either side of its value


@dataclass(frozen=True)
class FreeNumber:
    """Number of a scene that a fit determines from data.

    Parameters
    ----------
    path : str
        Name of the number in scene files.
    unit : str
        SI unit of the number.
    given : float
        Value in the scene [unit]; inf if the root is clamped.
    scale : float
        Typical size of the number [unit], by which it is divided.
    bounds : tuple of float
        Smallest and largest value [unit].
    """

    path: str
    unit: str
    given: float
    scale: float
    bounds: Bounds

    @property
    def is_compliance(self) -> bool:
        """Whether the variable is the inverse of the number (springs)."""
        return self.path in SPRINGS

    def variable(self, value: float) -> float:
        """Convert a value of the number [unit] to the scaled variable of a fit."""
        return self.scale / value if self.is_compliance else value / self.scale

    def value(self, x: float) -> float:
        """Convert the scaled variable of a fit to a value of the number [unit].

        The value is inf for a compliance so small that the root counts as clamped.
        """
        if self.is_compliance:
            return math.inf if x <= _CLAMPED else self.scale / x
        return self.scale * x

    def number(self, x: float) -> float:
        """Convert the scaled variable to a value [unit] for scenes of a fit, in which springs stay finite."""
        return self.scale / x if self.is_compliance else self.scale * x

    @property
    def limits(self) -> Bounds:
        """Lower and upper limit of the variable."""
        low, high = sorted(self.variable(each) for each in self.bounds)
        return (max(low, _RIGID), high) if self.is_compliance else (low, high)

    @property
    def first(self) -> float:
        """Variable at which a fit starts: the scene's value, moved into the limits."""
        low, high = self.limits
        absent = math.isinf(self.given) if self.is_compliance else self.given == low == 0
        return min(max(_FIRST if absent else self.variable(self.given), low), high)

    def place(self, share: float) -> float:
        """Return the variable at a fraction, from 0 to 1, of the range of start values.

        A compliance ranges from 0.02 to 5, a positive number from half to twice its scale, a number that may
        be 0 over one scale about its value.
        """
        low, high = self.limits
        if self.is_compliance or low > 0:
            ends = (0.02, 5.0) if self.is_compliance else (0.5, 2.0)
            x = ends[0] * (ends[1] / ends[0]) ** share
        else:
            x = max(self.variable(self.given) - 0.5, low) + share
        return min(max(x, low), high)


def opened(scene: Scene, paths: Sequence[str]) -> Scene:
    """Add to a scene the root springs and the tip body that the paths name, if it has none.

    An added spring has the finite stiffness 10 EI/L; an added tip body is massless.
    """
    values: dict[str, float] = {}
    for path in paths:
        if path in SPRINGS and math.isinf(number_at(scene, path) or 0.0):
            values[path] = _stiffness(scene) / _FIRST
        if path.startswith("beam.tip.") and scene.beam.tip is None:
            values[path] = 0.0
    return with_numbers(scene, values) if values else scene


def free_numbers(scene: Scene, free: Mapping[str, Bounds | None]) -> tuple[FreeNumber, ...]:
    """Return the numbers with the given paths; a number whose bounds [unit] are None gets typical bounds.

    Raises
    ------
    ValueError
        If the scene has no number with a path, or bounds do not ascend or exceed what the number may be.
    """
    if not isinstance(free, Mapping) or not free:
        bound = "give the numbers that are unknown, by their names"
        raise InvalidValue("free", free, bound, 'such as {"beam.thickness": None}')
    if speed := next((path for path in free if isinstance(path, str) and is_speed(path)), ""):
        bound = "a speed is given by the data, and cannot be an unknown number"
        raise InvalidValue("free", speed, bound, "remove the speed from `free`, and give it with the data")
    paths = [check_path("free", path) for path in free]
    made = numbers_of(opened(scene, paths), paths, "free")
    return tuple(_free(scene, number, free[number.name]) for number in made)


def _free(scene: Scene, number: SceneNumber, bounds: Bounds | None) -> FreeNumber:
    given, path = number_at(scene, number.name), number.name
    given = number.value if given is None or math.isnan(given) else given
    scale = _stiffness(scene) if path in SPRINGS else number.step / _STEP
    if number.name == "beam.tip.offset" or number.unit == "rad":
        scale = max(scale, 1.0 if number.unit == "rad" else scene.beam.length)
    low, high = _usual_bounds(number, given, scale)
    usual = low, min(high, scene.beam.length if path.endswith("].position") else math.inf)
    return FreeNumber(path, number.unit, given, scale, usual if bounds is None else _checked(number, bounds))


def _usual_bounds(number: SceneNumber, given: float, scale: float) -> Bounds:
    """Return the range [unit] in which a number is searched, depending on its kind."""
    if number.name in SPRINGS:
        return scale / _SOFTEST, math.inf
    if number.unit == "rad":
        return given - _TURN, given + _TURN
    if number.name == "beam.poissons_ratio":
        return 0.0, 0.5
    if given > 0 and scale <= 1.5 * given:
        return given / _TIMES, given * _TIMES
    return max(number.least, -scale), given + _TIMES * scale


def _checked(number: SceneNumber, bounds: Bounds) -> Bounds:
    try:
        low, high = (float(each) for each in bounds)
    except (TypeError, ValueError):
        bound = "bounds are a least and a largest value"
        raise InvalidValue(number.name, bounds, bound, "give two numbers, or None") from None
    if number.name in SPRINGS:
        positive(number.name, low, number.unit)
    if not max(number.least, -math.inf) <= low < high:
        bound = f"bounds ascend, from {number.least:g} on"
        raise InvalidValue(number.name, bounds, bound, "give the smaller one first", number.unit)
    return low, high


def _stiffness(scene: Scene) -> float:
    """Compute the bending stiffness EI/L [N m/rad], with the mean of EI along the beam."""
    return mean(scene.beam.bending_stiffness) / scene.beam.length
