"""Block brakes: one or two levers, each of which presses a block on the outside of a drum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.inputs.checks import one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from brakes.machines.machine import Lining, Machine

_ARM = "distance of the fulcrum from the line through the block's middle and the drum's centre"
_OFFSET = (
    "distance of the fulcrum from the tangent to the drum at the block's middle, away from the drum; "
    "below 0 on the drum's side"
)
_LAW = (
    "wear: long block that turns with its lever, pressure as the sine of the angle from the fulcrum; "
    "pressure: long block under uniform pressure; short: all forces at the block's middle"
)
_BLOCKS = "single: one lever; double: two, each with the force, mirrored so that one leads and one trails"
_NODES, _WEIGHT = np.polynomial.legendre.leggauss(16)  # of a quadrature over half a block
_AT = (1 + _NODES) / 2


@dataclass(frozen=True)
class Block(Machine):
    """A block brake; every number may be an array, one entry per case.

    Forward means that the drum's surface moves under the first block towards its fulcrum. If the fulcrum is
    farther from the drum than the friction force (offset above 0), friction then helps to press: the block
    leads. Under the second block of a double brake the surface moves away from the fulcrum.

    Parameters
    ----------
    drum_radius, face_width : float or ndarray
        Outer radius of the drum r, width of the block along the drum's axis w [m].
    block_angle : float or ndarray
        Angle of the block about the drum's axis [rad].
    force_arm : float or ndarray
        Lever arm of the actuating force about the fulcrum [m].
    block_arm, offset : float or ndarray
        Distances b and e of the fulcrum from the line through the block's middle and the drum's centre, and
        from the tangent to the drum at the block's middle, positive away from the drum [m].
    blocks : {"single", "double"}
        One lever, or two whose blocks lie on opposite sides of the drum.
    pressure_law : {"wear", "pressure", "short"}
        Pressure as the sine of the angle from the fulcrum ("wear"), uniform pressure along the block
        ("pressure"), or all forces at the block's middle ("short").

    Raises
    ------
    ValueError
        If a value is out of bounds, or the block reaches so far around the drum that it would lift.

    Notes
    -----
    Angles x are from the block's middle, towards the force; h = r + e; q is the pressure over its largest
    value p. With C, S, Q the integrals of q cos x, q sin x, q over the block and A = w r,
    force * arm = A p (b C + h S - mu (h C - b S - r Q)) if the surface moves towards the fulcrum; mu's sign
    changes where it moves away. torque = mu A p r Q. Under wear q is proportional to
    b cos x + h sin x, as the lever turns about its fulcrum.

    References
    ----------
    Standard: moments about the fulcrum; Budynas and Nisbett, Shigley's Mechanical Engineering Design, section
    16-3, has the pressure as the sine of the angle from the pin.

    Examples
    --------
    >>> block = machines.Block(0.15, 0.05, 0.6, 0.6, block_arm=0.25, offset=0.05, pressure_law="short")
    >>> round(float(machines.solve_brake(block, friction=0.4, force=500.0).torque), 6)  # N m
    78.26087
    """

    drum_radius: Annotated[Numbers, Described("m", "r", "outer radius of the drum", above=0)]
    face_width: Annotated[Numbers, Described("m", "w", "width of the block along the drum's axis", above=0)]
    block_angle: Annotated[
        Numbers, Described("rad", "theta", "angle of the block about the drum's axis", above=0, below=np.pi)
    ]
    force_arm: Annotated[Numbers, Described("m", "c", "arm of the force about the fulcrum", above=0)]
    block_arm: Annotated[Numbers, Described("m", "b", _ARM, above=0)]
    offset: Annotated[Numbers, Described("m", "e", _OFFSET)] = 0.0
    blocks: Annotated[Literal["single", "double"], Described(meaning=_BLOCKS)] = "single"
    pressure_law: Annotated[Literal["wear", "pressure", "short"], Described(meaning=_LAW)] = "wear"

    grips: ClassVar[str] = "block"
    laws: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"wear": "sinusoidal pressure (wear)", "pressure": "uniform pressure", "short": "short block"}
    )
    reactions: ClassVar[Mapping[str, Meaning]] = MappingProxyType(
        {
            "normal": Meaning("N", "resultant of the pressure N"),
            "tangential": Meaning("N", "resultant of the friction T"),
            "pin_x": Meaning("N", "force of the fulcrum on the lever, towards the lever's end"),
            "pin_y": Meaning("N", "force of the fulcrum on the lever, away from the drum"),
        }
    )
    place: ClassVar[Meaning] = Meaning("rad", "angle from the block's middle, away from the fulcrum", "deg")

    @property
    def height(self) -> Numbers:
        """Distance h = r + e [m] of the fulcrum from the drum's centre, towards the block's middle."""
        return self.drum_radius + np.asarray(self.offset)

    def check(self) -> None:
        """Check that all of the block presses on the drum, under the pressure law of wear."""
        one_of("blocks", self.blocks, ("single", "double"))
        most = np.pi - 2 * np.abs(np.arctan2(self.height, self.block_arm))
        bad = (np.asarray(self.block_angle) >= most) & (self.law == "wear")
        bound = "the block would lift at its end as the lever turns: it must be below {limit}"
        remedy = 'shorten it, lengthen block_arm, or give pressure_law = "pressure"'
        refuse(bad, "block_angle", self.block_angle, "rad", bound, remedy, limit=most)

    @property
    def reference_radius(self) -> Numbers:
        """Radius of the drum [m]."""
        return self.drum_radius

    def linings(self, friction: Numbers, reverse: bool) -> Mapping[str, Lining]:
        """Return the linings of the one or two blocks; see `Machine.linings`."""
        names = ("block",) if self.blocks == "single" else ("first block", "second block")
        senses = (-1.0, 1.0) if reverse else (1.0, -1.0)
        return {name: self._block(friction, sense) for name, sense in zip(names, senses, strict=False)}

    def _block(self, mu: Numbers, sense: float) -> Lining:
        """Make the lining of a block; the drum moves towards the fulcrum (sense 1) or away from it (-1)."""
        r, b, h, area = (
            self.drum_radius,
            self.block_arm,
            self.height,
            self.face_width * np.asarray(self.drum_radius),
        )
        C, S, Q = self.integrals()
        n, d = b * C + h * S, sense * (h * C - b * S - r * Q)
        of_normal, of_friction = (area * each / self.force_arm for each in (n, mu * d))
        force = of_normal - of_friction
        size = area / self.force_arm * (n + np.abs(mu) * (np.abs(h * C) + np.abs(b * S) + r * Q))
        with np.errstate(divide="ignore"):
            limit = np.where(d > 0, n / np.where(d > 0, d, 1.0), np.inf)
        forces = {
            "normal": area * np.hypot(C, S),
            "tangential": mu * area * np.hypot(C, S),
            "pin_x": area * (sense * mu * C - S),
            "pin_y": force - area * (C + sense * mu * S),
        }
        return Lining(mu * area * r * Q, force, size, limit, forces)

    def integrals(self) -> tuple[Numbers, Numbers, Numbers]:
        """Compute the integrals C, S, Q of q cos x, q sin x and q over the block, as in the class's notes."""
        half, b, h = np.asarray(self.block_angle) / 2, self.block_arm, self.height
        chord = 2 * np.sin(half)
        if self.law != "wear":
            return chord, 0.0 * half, chord if self.law == "short" else 2 * half
        even = half + np.sin(2 * half) / 2
        odd = half * (np.sin(np.multiply.outer(half, _AT)) ** 2 @ _WEIGHT)  # half - sin(2 half) / 2 cancels
        peak = self._peak()
        return b * even / peak, h * odd / peak, b * chord / peak

    def _peak(self) -> Numbers:
        """Compute the largest b cos x + h sin x over the block [m], with the angle x from its middle.

        Here b is `block_arm` and h the `height`. Under wear the pressure is in proportion to this.
        """
        towards = np.abs(np.arctan2(self.height, self.block_arm))  # angle of the maximum of b cos x + h sin x
        at = np.minimum(towards, np.asarray(self.block_angle) / 2)
        return self.block_arm * np.cos(at) + np.abs(self.height) * np.sin(at)

    def reach(self) -> tuple[Numbers, Numbers]:
        """Return the angles of the block's ends from its middle [rad], first the end at the fulcrum."""
        half = np.asarray(self.block_angle) / 2
        return -half, half

    def pressure(self, at: Numbers, friction: Numbers) -> Numbers:
        """Compute the pressure at angles from the block's middle [rad], divided by its largest value."""
        if self.law != "wear":
            return np.ones_like(at)
        return (self.block_arm * np.cos(at) + self.height * np.sin(at)) / self._peak()
