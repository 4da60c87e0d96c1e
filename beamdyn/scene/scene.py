"""The scene: a beam, how it is mounted on its carrier, and how the carrier moves."""

from __future__ import annotations

from dataclasses import dataclass

from beamdyn.common.checks import InvalidValue, flag, kind, not_negative, real, refuse, set_fields
from beamdyn.scene.beam import Beam
from beamdyn.scene.motion import Motion
from beamdyn.scene.mount import Mount


@dataclass(frozen=True)
class Scene:
    """Input of a model: beam, mount, motion, damping and gravity.

    Parameters
    ----------
    beam : Beam
        The cantilever.
    mount : Mount
        How the beam is fixed to the carrier.
    motion : Motion, optional
        Motion of the carrier; analyses at steady speeds do not use it, or replace its speed.
    damping_ratio : float
        Modal damping ratio of every mode of the beam at rest, from 0 to below 1.
    gravity : float
        Gravitational acceleration along -n2 [m/s2].
    stretch : bool
        Model the axial stretch and its Coriolis coupling with bending (Yoo and Shin), for comparison.

    Raises
    ------
    ValueError
        If the damping ratio is outside [0, 1), or the beam has no axial stiffness for the stretch.
    """

    beam: Beam
    mount: Mount = Mount()
    motion: Motion | None = None
    damping_ratio: float = 0.0
    gravity: float = 0.0
    stretch: bool = False

    def __post_init__(self) -> None:
        kind("beam", self.beam, Beam, "Beam.rectangular and Beam.from_stiffness make one")
        kind("mount", self.mount, Mount, "mount = Mount(radius=0.2) sets a radius of 0.2 m")
        if isinstance(self.motion, type) or not (self.motion is None or hasattr(self.motion, "at")):
            raise InvalidValue("motion", self.motion, "give a Motion, such as SteadyRotation(speed)")
        ratio = not_negative("damping_ratio", self.damping_ratio)
        remedy = "1 % is damping_ratio = 0.01"
        refuse(ratio >= 1, "damping_ratio", ratio, "", "it must be below 1", remedy)
        gravity, stretch = real("gravity", self.gravity, "m/s2"), flag("stretch", self.stretch)
        set_fields(self, damping_ratio=ratio, gravity=gravity, stretch=stretch)
        if self.stretch and self.beam.axial_stiffness is None:
            raise InvalidValue("stretch", True, "it needs axial_stiffness", "give it to Beam.from_stiffness")


def check_scene(scene: object) -> None:
    """Refuse what is no scene, such as a beam, as an argument of an analysis."""
    remedy = "Scene(beam, mount) makes one of a beam, load_scene(path) reads one from a file"
    kind("scene", scene, Scene, remedy)
