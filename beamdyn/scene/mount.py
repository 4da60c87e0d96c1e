"""How the beam is mounted on its carrier."""

from __future__ import annotations

from dataclasses import dataclass

from beamdyn.common.checks import angle, not_negative


@dataclass(frozen=True)
class Mount:
    """How the root of the beam is fixed to the carrier.

    Parameters
    ----------
    radius : float
        Distance r of the root from the axis of rotation [m].
    setting_angle : float
        Direction phi of the beam [rad]: 0 towards the axis (inward), pi/2 tangential (the beam
        trails), pi outward, -pi/2 leading.
    bending_angle : float
        Angle psi between the direction in which the beam bends and the plane of rotation [rad]:
        0 in the plane (chordwise, lead-lag), pi/2 out of it (flapwise).

    Raises
    ------
    ValueError
        If the radius is negative or an angle exceeds one turn.
    """

    radius: float = 0.0
    setting_angle: float = 0.0
    bending_angle: float = 0.0

    def __post_init__(self) -> None:
        not_negative(
            "radius", self.radius, "m", "for a beam that points outward give setting_angle = pi instead"
        )
        angle("setting_angle", self.setting_angle)
        angle("bending_angle", self.bending_angle)
