"""The scene: a beam, how it is mounted on its carrier, and how the carrier moves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from beamdyn.common.checks import InvalidValue, angle, kind, not_negative, real, refuse
from beamdyn.common.described import Described
from beamdyn.scene.beam import Beam
from beamdyn.scene.motion import Motion

_ONE_TURN: Any = {"least": -2 * math.pi, "most": 2 * math.pi, "remedy": "that is one turn either way"}


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

    def __post_init__(self) -> None:
        not_negative(
            "radius", self.radius, "m", "for a beam that points outward give setting_angle = pi instead"
        )
        angle("setting_angle", self.setting_angle)
        angle("bending_angle", self.bending_angle)


@dataclass(frozen=True)
class Scene:
    """All that a model needs.

    Parameters
    ----------
    beam : Beam
        The cantilever.
    mount : Mount
        How it is fixed to the carrier.
    motion : Motion, optional
        How the carrier moves; analyses over speeds set the speed themselves.
    damping_ratio : float
        Modal damping ratio of every mode of the beam at rest, from 0 to below 1.
    gravity : float
        Gravity along -n2 [m/s2].
    stretch : bool
        Keep the stretch of the beam and its Coriolis coupling (Yoo-Shin's model), for comparison.

    Raises
    ------
    ValueError
        If the damping ratio is outside [0, 1), or the stretch has no axial stiffness.
    """

    beam: Beam
    mount: Mount = Mount()
    motion: Motion | None = None
    damping_ratio: float = 0.0
    gravity: float = 0.0
    stretch: bool = False

    def __post_init__(self) -> None:
        kind("beam", self.beam, Beam)
        kind("mount", self.mount, Mount, "mount = Mount(radius=0.2) sets a radius of 0.2 m")
        kind("stretch", self.stretch, bool)
        if self.motion is not None and not hasattr(self.motion, "at"):
            raise InvalidValue("motion", self.motion, "give a motion, such as SteadyRotation(speed)")
        real("gravity", self.gravity, "m/s2")
        ratio = not_negative("damping_ratio", self.damping_ratio)
        remedy = "1 % is damping_ratio = 0.01"
        refuse(ratio >= 1, "damping_ratio", ratio, "", "it must be below 1", remedy)
        if self.stretch and self.beam.axial_stiffness is None:
            raise InvalidValue("stretch", True, "it needs axial_stiffness", "give it to Beam.from_stiffness")
