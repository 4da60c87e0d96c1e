"""Scenes with an effect that a scene leaves out, as far as the beam has the data for it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.effects import (
    LARGE_DEFLECTION,
    SECOND_PLANE,
    SHEAR,
    TWIST,
    Effect,
    add_effects,
    effects_left_out,
)
from beamdyn.scene.beam import Beam
from beamdyn.scene.rectangle import shear_stiffness_of_rectangle
from beamdyn.scene.scene import Scene

ASSUMED_POISSONS_RATIO = 0.3
_RECTANGLE = 1e-9  # relative; of a radius of gyration that is that of a rectangle


@dataclass(frozen=True)
class Addition:
    """A scene with one effect more.

    Parameters
    ----------
    effect : Effect
        The effect.
    scene : Scene
        The scene that includes it.
    assumed : str
        What was assumed about the beam to include it; empty if nothing.
    """

    effect: Effect
    scene: Scene
    assumed: str = ""

    @property
    def name(self) -> str:
        """Name of the effect."""
        return self.effect.name


def _assume_shear(beam: Beam) -> Beam | None:
    """The beam with the shear stiffness of usual materials; None unless its sections are seen as rectangles.

    The shear stiffness of a rectangle lies within 28 % of that assumed, for Poisson's ratios from 0 to 0.5.
    """
    if beam.shear_stiffness is not None or beam.axial_stiffness is None or beam.outer_fibre is None:
        return None
    xi = np.linspace(0, 1, 33)  # rectangles with outer fibre h/2 have EI = EA h^2 / 12
    gyration = np.sqrt(beam.bending_stiffness(xi) / beam.axial_stiffness(xi))
    if not np.allclose(np.sqrt(3) * gyration, beam.outer_fibre(xi), rtol=_RECTANGLE, atol=0.0):
        return None
    stiffness = shear_stiffness_of_rectangle(beam.axial_stiffness, ASSUMED_POISSONS_RATIO)
    return replace(beam, shear_stiffness=stiffness, second_shear_stiffness=stiffness)


def list_effects(scene: Scene) -> tuple[list[Addition], dict[str, str], tuple[str, ...]]:
    """List the effects that a scene leaves out, but for large deflection, by what can be said of them.

    Returns
    -------
    additions : list of Addition
        Those that can be added.
    not_known : dict of str to str
        Those that cannot, and what to give.
    not_modelled : tuple of str
        Those that no model has.
    """
    left_out = [effect for effect in effects_left_out(scene) if effect is not LARGE_DEFLECTION]
    if TWIST in left_out:  # it needs the second plane: the two are one effect
        left_out.remove(SECOND_PLANE)
    additions, not_known = [], {}
    for effect in (effect for effect in left_out if effect.switch):
        scenes, refusal = [(scene, "")], None
        if scene.physics.shear or effect is SHEAR:
            beam, assumed = _assume_shear(scene.beam), f"Poisson's ratio {ASSUMED_POISSONS_RATIO:g} assumed"
            scenes += [] if beam is None else [(replace(scene, beam=beam), f"with {assumed}")]
        for given, assumed in scenes:
            try:
                additions.append(Addition(effect, add_effects(given, [effect]), assumed))
                break
            except InvalidValue as error:
                refusal = error
        else:
            assert refusal is not None
            not_known[effect.name] = f"give {refusal.other}" if refusal.other else str(refusal)
    return additions, not_known, tuple(e.name for e in left_out if not e.switch)
