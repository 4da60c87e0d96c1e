"""Mounting of the beam on its carrier, and damping of its vibration beyond one ratio for all modes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import cos, sin
from typing import Annotated, Any

from beamdyn.common.inputs.checks import (
    InvalidValue,
    amount,
    angle,
    not_negative,
    real_array,
    refuse,
    set_fields,
)
from beamdyn.common.inputs.described import Described, descriptions
from beamdyn.common.results.one_line import OneLine, number
from beamdyn.scene.input_checks import warn_of_degrees

_RATIO: Any = {"least": 0, "below": 1, "remedy": "1 % is 0.01"}


@dataclass(frozen=True)
class Damping:
    """Damping of the beam: ratios of modes, Rayleigh's factors and a damper at the tip, which add up.

    Parameters
    ----------
    ratios : sequence of float
        Damping ratio of each mode of the beam at rest, from the lowest, each from 0 to below 1; further modes
        have the last one.
    mass_factor : float
        Factor alpha of the mass [1/s] in C = alpha M + beta K, with K at rest (Rayleigh).
    stiffness_factor : float
        Factor beta of the stiffness [s]: a material whose stress is E (strain + beta strain rate).
    tip_damper : float
        Damper between the tip and the carrier [N s/m], against motion across the beam in any direction.

    Raises
    ------
    ValueError
        If a value is not finite or out of its range.

    References
    ----------
    Standard: modal ratios, Rayleigh damping, a viscous damper; section Damping of docs/conventions.md.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, damping=bd.Damping(ratios=(0.01, 0.02)))  # of the first two modes
    >>> scene.is_damped
    True
    """

    ratios: Sequence[
        Annotated[float, Described("", "zeta_k", "damping ratio of each mode at rest", **_RATIO)]
    ] = ()
    mass_factor: Annotated[
        float, Described("1/s", "alpha", "damping by the mass: C = alpha M + beta K", least=0)
    ] = 0.0
    stiffness_factor: Annotated[
        float, Described("s", "beta", "damping by the stiffness at rest: C = alpha M + beta K", least=0)
    ] = 0.0
    tip_damper: Annotated[
        float, Described("N s/m", "c_t", "damper between the tip and the carrier", least=0)
    ] = 0.0

    def __post_init__(self) -> None:
        ratios = real_array("damping.ratios", self.ratios)
        bound = "each is from 0 to below 1"
        refuse((ratios < 0) | (ratios >= 1), "damping.ratios", ratios, "", bound, _RATIO["remedy"])
        set_fields(self, ratios=tuple(ratios.tolist()))
        for name in ("mass_factor", "stiffness_factor", "tip_damper"):
            described, of = descriptions(Damping)[name], f"damping.{name}"
            set_fields(self, **{name: amount(of, described.check(of, getattr(self, name)), described.unit)})

    @property
    def damps(self) -> bool:
        """Whether there is any damping."""
        return any(self.ratios) or bool(self.mass_factor or self.stiffness_factor or self.tip_damper)

    def ratios_of(self, modes: int) -> list[float]:
        """List the damping ratios of a number of modes at rest, from the lowest; 0 where none is given."""
        last = self.ratios[-1] if self.ratios else 0.0
        return [*self.ratios[:modes], *[last] * (modes - len(self.ratios))]


NO_DAMPING = Damping()


def check_one_kind_of_ratios(ratio: float, damping: Damping) -> None:
    """Refuse a damping ratio of all modes together with damping ratios of each mode."""
    if ratio and damping.ratios:
        bound = "damping.ratios gives one for each mode, too"
        raise InvalidValue("damping_ratio", ratio, bound, "leave one of the two out")


_SPRING: Any = {"least": 0, "infinite": "clamped", "remedy": "0 is a hinge; left out, the root is clamped"}
_PRECONE: Any = {"above": -math.pi / 2, "below": math.pi / 2, "remedy": "0 is in the plane of rotation"}
ROUNDED_ANGLE = 2e-16  # largest magnitude of the cosine of a right angle due to rounding
RIGHT_ANGLE = 1e-8  # distance from a multiple of a right angle [rad] that is neglected
_ONE_TURN: Any = {"least": -2 * math.pi, "most": 2 * math.pi, "remedy": "that is one turn either way"}


@dataclass(frozen=True)
class Mount(OneLine):
    """Mounting of the beam's root on the carrier: radius, angles and springs.

    Parameters
    ----------
    radius : float
        Distance r of the root from the axis of rotation [m].
    setting_angle : float
        Direction phi of the beam [rad]: 0 towards the axis of rotation (inward), pi/2 tangential and
        trailing, pi outward, -pi/2 tangential and leading.
    bending_angle : float
        Angle psi between the direction in which the beam bends and the plane of rotation [rad]:
        0 in the plane (chordwise, lead-lag), pi/2 out of it (flapwise).
    root_stiffness : float
        Stiffness of the root against rotation by bending in the direction of the bending angle [N m/rad]:
        inf is clamped, 0 a hinge; a scene accepts finite values up to 1e16 times EI/L of the beam.
    second_root_stiffness : float
        Stiffness of the root against rotation by bending in the perpendicular direction [N m/rad], where a
        second plane is modelled.
    precone : float
        Angle eta by which the beam leaves the plane of rotation, positive towards b3 [rad]: less than pi/2
        either way, and only for a beam that points outward.

    Raises
    ------
    ValueError
        If the radius or a stiffness is negative, an angle exceeds one turn, or the precone is a quarter turn
        or more, or given for a beam that does not point outward.

    Warns
    -----
    UserWarning
        If an angle seems to be in degrees: beyond half a turn, with at most two decimals, such as 5.

    References
    ----------
    Lee and Yoo (2019), setting angle; others: section Axes and signs of docs/conventions.md.

    Examples
    --------
    >>> bd.Mount(radius=0.215, setting_angle=np.pi).setting_angle == np.pi  # outward
    True
    """

    radius: Annotated[
        float,
        Described(
            "m",
            "r",
            "distance of the root from the axis of rotation",
            least=0,
            required=True,
            remedy='for a beam that points outward give setting_angle = "180 deg"',
        ),
    ] = 0.0
    setting_angle: Annotated[
        float,
        Described(
            "rad", "phi", "direction of the beam: 0 inward, 90 deg tangential, 180 deg outward", **_ONE_TURN
        ),
    ] = 0.0
    bending_angle: Annotated[
        float,
        Described(
            "rad", "psi", "angle between the direction of bending and the plane of rotation", **_ONE_TURN
        ),
    ] = 0.0
    root_stiffness: Annotated[
        float,
        Described(
            "N m/rad", "k", "stiffness of the root against rotation by bending; 0 is a hinge", **_SPRING
        ),
    ] = math.inf
    second_root_stiffness: Annotated[
        float, Described("N m/rad", "k2", "root stiffness for bending in the second direction", **_SPRING)
    ] = math.inf
    precone: Annotated[
        float, Described("rad", "eta", "angle of an outward beam out of the plane of rotation", **_PRECONE)
    ] = 0.0

    def __post_init__(self) -> None:
        remedy = "for a beam that points outward give setting_angle = pi instead"
        angles = {
            name: angle(name, getattr(self, name)) for name in ("setting_angle", "bending_angle", "precone")
        }
        set_fields(self, radius=not_negative("radius", self.radius, "m", remedy), **angles)
        bound = "it must be less than 90 deg, at which the beam would stand along the axis of rotation"
        refuse(abs(self.precone) >= math.pi / 2, "precone", self.precone, "rad", bound, _PRECONE["remedy"])
        if self.precone and aligned_cos_sin(self.setting_angle) != (-1.0, 0.0):
            bound = "only a beam that points outward has a precone"
            remedy = "give {other} = 180 deg (pi), or leave the precone out"
            raise InvalidValue("precone", self.precone, bound, remedy, "rad", other="setting_angle")
        for name, value in angles.items():
            warn_of_degrees(name, value)
        for name in ("root_stiffness", "second_root_stiffness"):
            set_fields(self, **{name: _spring(name, getattr(self, name))})

    def headline(self) -> Iterator[str]:
        """Yield the radius, and the angles and springs that were given, as text."""
        yield f"radius {number(self.radius, 'm')}"
        for name in ("setting_angle", "bending_angle", "precone"):
            degrees = math.degrees(getattr(self, name))
            yield f"{name.replace('_', ' ')} {number(degrees, 'deg')}" if degrees else ""
        for name in ("root_stiffness", "second_root_stiffness"):
            spring = getattr(self, name)
            yield f"{name.replace('_', ' ')} {number(spring, 'N m/rad')}" if spring < math.inf else ""

    @property
    def root_stiffnesses(self) -> tuple[float, float]:
        """Stiffness of the root against rotation in each direction of bending [N m/rad]."""
        return self.root_stiffness, self.second_root_stiffness


def _spring(name: str, value: object) -> float:
    """Return a stiffness [N m/rad]; raise an error unless it is zero or more, or infinite."""
    if isinstance(value, float) and value == math.inf:
        return value
    try:
        return not_negative(name, value, "N m/rad", _SPRING["remedy"])
    except InvalidValue as refusal:
        raise replace(refusal, bound="give a number of 0 or more, or inf") from None


def exact_cos_sin(angle: float, least: float = ROUNDED_ANGLE) -> tuple[float, float]:
    """Compute cosine and sine of an angle [rad], exactly 0 at rounded multiples of a quarter turn.

    Values of a magnitude below `least` are set to 0.
    """
    c, s = cos(angle), sin(angle)
    return (0.0 if abs(c) < least else c), (0.0 if abs(s) < least else s)


def aligned_cos_sin(angle: float) -> tuple[float, float]:
    """Compute cosine and sine of an angle [rad], 0 within `RIGHT_ANGLE` of a multiple of a quarter turn.

    The tolerance `RIGHT_ANGLE` is smaller than the accuracy of any mounting.  The function is used for
    bending angles, whose small errors affect frequencies by their square, and for decisions whether two
    directions are coupled or a beam is loaded across, which must not depend on the last digit of an angle.
    """
    return exact_cos_sin(angle, RIGHT_ANGLE)
