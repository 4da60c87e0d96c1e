"""Band brakes: a band around a drum, whose two ends a lever pulls."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, ClassVar

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.inputs.checks import refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from brakes.common.locking import LEAST_MARGIN
from brakes.machines.machine import Lining, Machine

_FIRST = "arm about the fulcrum of the band's first end, which the force on the lever pulls"
_SECOND = (
    "arm of the second end, on the other side of the fulcrum, where the band helps to pull: 0 if it is fixed "
    "(a simple band), above 0 in a differential band, below 0 if the lever pulls both ends"
)
_MOST = 2 * np.pi


@dataclass(frozen=True)
class Band(Machine):
    """A band brake; every number may be an array, one entry per case.

    Forward, the drum's surface moves from the second end of the band to the first: the second end is
    tight, and the tension, like the pressure, falls by exp(-mu wrap) from the tight end to the slack one.

    Parameters
    ----------
    drum_radius, face_width : float or ndarray
        Radius of the drum r, width of the band w [m].
    wrap : float or ndarray
        Angle phi over which the band touches the drum [rad].
    force_arm, first_arm, second_arm : float or ndarray
        Lever arms about the fulcrum [m]: of the actuating force, of the first end a, and of the second end s,
        which lies on the other side of the fulcrum.

    Raises
    ------
    ValueError
        If a value is out of bounds, or the second arm is not below the first: the lever would then loosen
        the band.

    Notes
    -----
    With tensions T1 of the first and T2 of the second end, force * arm = T1 a - T2 s, torque = (T2 - T1) r
    forward; the largest pressure is that at the tight end, tension / (w r).

    References
    ----------
    Standard: belt friction of Euler and Eytelwein; Budynas and Nisbett, Shigley's Mechanical Engineering
    Design, section 16-4.

    Examples
    --------
    >>> band = machines.Band(0.2, 0.05, wrap=3.9, force_arm=0.5, first_arm=0.1, second_arm=0.02)
    >>> found = machines.solve_brake(band, friction=0.25, force=100.0)
    >>> round(float(found.locking_friction), 4)
    0.4127
    """

    drum_radius: Annotated[Numbers, Described("m", "r", "radius of the drum", above=0)]
    face_width: Annotated[Numbers, Described("m", "w", "width of the band", above=0)]
    wrap: Annotated[Numbers, Described("rad", "phi", "angle over which it touches", above=0, most=_MOST)]
    force_arm: Annotated[Numbers, Described("m", "c", "arm of the force about the fulcrum", above=0)]
    first_arm: Annotated[Numbers, Described("m", "a", _FIRST, above=0)]
    second_arm: Annotated[Numbers, Described("m", "s", _SECOND)] = 0.0

    grips: ClassVar[str] = "band"
    reactions: ClassVar[Mapping[str, Meaning]] = MappingProxyType(
        {
            "first": Meaning("N", "tension of the first end"),
            "second": Meaning("N", "tension of the second end"),
            "fulcrum": Meaning("N", "force on the fulcrum, for a lever force along the line of symmetry"),
            "bearing": Meaning("N", "force of the band on the drum's bearing"),
        }
    )
    place: ClassVar[Meaning] = Meaning("rad", "angle from the slack end", "deg")

    def check(self) -> None:
        """Check that the lever tightens the band."""
        bound = "it must be below {other}, {limit}: otherwise the lever loosens the band"
        bad = np.asarray(self.second_arm) >= self.first_arm * (1 - LEAST_MARGIN)
        remedy = "exchange the two ends, or shorten it"
        refuse(
            bad, "second_arm", self.second_arm, "m", bound, remedy, limit=self.first_arm, other="first_arm"
        )

    @property
    def reference_radius(self) -> Numbers:
        """Radius of the drum [m]."""
        return self.drum_radius

    def linings(self, friction: Numbers, reverse: bool) -> Mapping[str, Lining]:
        """Return the lining of the band; see `Machine.linings`."""
        a, s, angle = self.first_arm, np.asarray(self.second_arm), friction * self.wrap
        tight = self.face_width * np.asarray(self.drum_radius) + 0 * friction
        slack = tight * np.exp(-angle)
        first, second = (tight, slack) if reverse else (slack, tight)
        force = (first * a - second * s) / self.force_arm
        with np.errstate(divide="ignore", invalid="ignore"):
            limit = np.where(s > 0, np.log(a / s) / self.wrap, np.inf)
        return {
            "band": Lining(
                torque=-np.expm1(-angle) * tight * self.drum_radius,
                force=force,
                size=(first * a + second * np.abs(s)) / self.force_arm * (1 + angle),
                locks_at=np.inf if reverse else limit,
                reactions={"first": first, "second": second} | self._held(first, second, force),
            )
        }

    def _held(self, first: Numbers, second: Numbers, force: Numbers) -> dict[str, Numbers]:
        """Compute the forces on fulcrum and drum bearing, for a lever force along the symmetry axis.

        The band's ends leave the drum at an angle of (phi - 180 deg) / 2 to that axis.
        """
        tilt = (self.wrap - np.pi) / 2
        along, across = (first + second) * np.cos(tilt), (first - second) * np.sin(tilt)
        return {
            "fulcrum": np.sqrt((along - force) ** 2 + across**2),
            "bearing": np.sqrt(along**2 + across**2),
        }

    def reach(self) -> tuple[Numbers, Numbers]:
        """Return the angles of the slack and of the tight end [rad]."""
        return 0.0, self.wrap

    def pressure(self, at: Numbers, friction: Numbers) -> Numbers:
        """Compute the pressure at angles from the slack end [rad], divided by that at the tight end."""
        return np.exp(-friction * (self.wrap - at))
