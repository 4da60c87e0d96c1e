"""Short layers at the ends of a fast beam, in which tension lets it bend: they get functions of their own.

A beam of bending stiffness EI under a tension N bends within a few lengths (EI/N)^(1/2) from an end.  A body
at the tip may vibrate, or tip over, within such a layer alone.  Two bases that do not resolve it agree with
each other, and both lack that mode.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from beamdyn.equations.centrifugal_tension import axial_tension
from beamdyn.equations.root_motion import root_motion
from beamdyn.scene.beam import Beam
from beamdyn.scene.motion import MotionSample
from beamdyn.scene.mount import Mount
from beamdyn.scene.scene import Scene

_LENGTHS = 5.0  # of a layer at least; a half more for each factor e of accuracy, as energy falls by e^2
_SHORT_AT_ROOT, _SHORT_AT_TIP = 0.1, 0.4  # longest parts of the beam that get functions of their own
_SHORTEST = 1e-4  # and the shortest
_TOWARD_TIP = (0.7, 0.95, 0.992)  # x/L between which the length of a layer at an unknown speed lies


def split_layers(scene: Scene, speed: float, target: float) -> Scene:
    """Add breakpoints where the layers at a speed [rad/s] end; the scene itself where they are not short.

    Beyond them a layer's share of an eigenvalue is below the target.
    """
    if not speed:
        return scene
    lengths = (_LENGTHS - math.log(target) / 2) / speed
    root, tip = (lengths * unit for unit in _lengths_at_unit_speed(scene.modelled_beam, scene.mount))
    places = [max(root, _SHORTEST)] if root < _SHORT_AT_ROOT else []
    if scene.beam.tip is not None and tip < _SHORT_AT_TIP:
        places.append(1 - max(tip, _SHORTEST))
    return _split(scene, places) if places else scene


@lru_cache(maxsize=64)
def _lengths_at_unit_speed(beam: Beam, mount: Mount) -> tuple[float, float]:
    """Lengths (EI/N)^(1/2) over L at the root and at the tip, at 1 rad/s; inf where nothing pulls."""
    ends = np.array([0.0, 1.0])
    profiles = (beam.bending_stiffness, beam.second_bending_stiffness)
    stiffness = np.min([each(ends) for each in profiles if each is not None], axis=0)
    with np.errstate(divide="ignore"):
        root, tip = np.sqrt(stiffness / np.maximum(_tension(beam, mount, ends), 0.0)) / beam.length
    return float(root), float(tip)


def split_tip(scene: Scene) -> Scene:
    """Add breakpoints that resolve a layer at the tip at any speed, where tension makes one."""
    beam = scene.beam
    has_layer = beam.tip is not None and _tension(beam, scene.mount, np.ones(1))[0] > 0
    return _split(scene, _TOWARD_TIP) if has_layer else scene


def _tension(beam: Beam, mount: Mount, xi: np.ndarray) -> np.ndarray:
    """Axial force at x/L over the squared speed [kg m]; negative where the beam is pressed."""
    n_a, n_b = axial_tension(beam)
    return n_b(xi) - root_motion(mount, MotionSample.steady(1.0)).root_axial * n_a(xi)


def _split(scene: Scene, places: Sequence[float]) -> Scene:
    """The scene with breakpoints of its beam at x/L, too."""
    mass = scene.beam.mass_per_length.split((0.0, *places, 1.0))
    return replace(scene, beam=replace(scene.beam, mass_per_length=mass))
