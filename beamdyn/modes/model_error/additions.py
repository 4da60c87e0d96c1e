"""Scenes with one more effect than a given scene, where the beam has the data for it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations import effects
from beamdyn.scene.beam import Beam
from beamdyn.scene.rectangle import shear_stiffness_of_rectangle
from beamdyn.scene.scene import Scene

ASSUMED_POISSONS_RATIO = 0.3
# Assumed Poisson's ratio of a section without one: the largest of uniform materials, as the change rises with
# the ratio; or a usual one, by which a frequency of torsion is known to 13 %.
_ASSUMED_OF_SECTIONS = {
    effects.CAMBER: (0.5, "with Poisson's ratio 0.5, not given; 0 % with 0"),
    effects.TORSION: (ASSUMED_POISSONS_RATIO, f"with Poisson's ratio {ASSUMED_POISSONS_RATIO:g} assumed"),
}
MOST_CAMBER = "as if no section cambered, which is the most"
_RECTANGLE = 1e-9  # relative tolerance of a radius of gyration that equals that of a rectangle


@dataclass(frozen=True)
class Addition:
    """A scene to which one effect was added.

    Parameters
    ----------
    effect : Effect
        The effect.
    scene : Scene
        The scene that includes the effect, or one that bounds its change.
    assumed : str
        What was assumed about the beam to include the effect; empty if nothing.
    """

    effect: effects.Effect
    scene: Scene
    assumed: str = ""

    @property
    def name(self) -> str:
        """Name of the added effect."""
        return self.effect.name


def _assume_shear(beam: Beam) -> Beam | None:
    """Return the beam with a usual material's shear stiffness; None unless its sections look rectangular.

    For Poisson's ratios from 0 to 0.5, a rectangle's shear stiffness lies within 28 % of the assumed one.
    """
    if beam.shear_stiffness is not None or beam.axial_stiffness is None or beam.outer_fibre is None:
        return None
    xi = np.linspace(0, 1, 33)  # rectangles with outer fibre h/2 have EI = EA h^2 / 12
    gyration = np.sqrt(beam.bending_stiffness(xi) / beam.axial_stiffness(xi))
    if not np.allclose(np.sqrt(3) * gyration, beam.outer_fibre(xi), rtol=_RECTANGLE, atol=0.0):
        return None
    stiffness = shear_stiffness_of_rectangle(beam.axial_stiffness, ASSUMED_POISSONS_RATIO)
    return replace(beam, shear_stiffness=stiffness, second_shear_stiffness=stiffness)


def _assume(scene: Scene, effect: effects.Effect) -> Iterator[tuple[Scene, str]]:
    """Yield the scene and, where an effect lacks data, scenes with assumptions, each with its wording."""
    yield scene, ""
    section, electrodes = scene.beam.strip, scene.beam.electrodes
    if effect in _ASSUMED_OF_SECTIONS and section is not None and section.poissons_ratio is None:
        ratio, said = _ASSUMED_OF_SECTIONS[effect]
        if electrodes is None:
            yield replace(scene, beam=scene.beam.with_section(replace(section, poissons_ratio=ratio))), said
        else:
            yield replace(scene, beam=replace(scene.beam, electrodes=electrodes.with_ratio(ratio))), said
    if scene.physics.shear or effect is effects.SHEAR:
        beam = _assume_shear(scene.beam)
        if beam is not None:
            yield replace(scene, beam=beam), f"with Poisson's ratio {ASSUMED_POISSONS_RATIO:g} assumed"


def list_effects(scene: Scene) -> tuple[list[Addition], dict[str, str], tuple[str, ...]]:
    """List the effects that a scene leaves out, except large deflection, by whether they can be added.

    Returns
    -------
    additions : list of Addition
        Effects that can be added.
    not_known : dict of str to str
        Effects that cannot be added, and what input they need.
    not_modelled : tuple of str
        Effects that no model has.
    """
    left_out = [
        effect for effect in effects.effects_left_out(scene) if effect is not effects.LARGE_DEFLECTION
    ]
    if effects.TWIST in left_out:  # twist needs the second plane: the two are one effect
        left_out.remove(effects.SECOND_PLANE)
    additions, not_known = [], {}
    for effect in (effect for effect in left_out if effect.switch and effect is not effects.TORSION):
        try:
            additions.append(add_effect(scene, effect))
        except InvalidValue as refusal:
            excluded = scene.physics.large_deflection and not effect.bends_in_space
            why = effects.EXCLUSIVE if excluded else str(refusal)
            not_known[effect.name] = f"give {refusal.other}" if refusal.other else why
    not_modelled = [effect.name for effect in left_out if not effect.switch]
    if effects.TORSION in left_out and not can_add(scene, effects.TORSION):
        not_modelled.insert(0, effects.TORSION.name)
    return additions, not_known, tuple(not_modelled)


def add_effect(scene: Scene, effect: effects.Effect) -> Addition:
    """Add an effect that a scene leaves out, with an assumption about the beam if data are missing.

    Camber, where no model has it (twisted beams, widths that jump), is replaced by a bound.

    Raises
    ------
    InvalidValue
        If the beam lacks data that cannot be assumed, or the effect cannot be combined with others.
    """
    *assumptions, last = _assume(scene, effect)
    for given, assumed in assumptions:
        with suppress(InvalidValue):
            return Addition(effect, effects.add_effects(given, [effect]), assumed)
    try:
        return Addition(effect, effects.add_effects(last[0], [effect]), last[1])
    except InvalidValue:
        if effect is not effects.CAMBER or scene.beam.strip is None or scene.physics.large_deflection:
            raise
    return Addition(effects.CAMBER, without_camber(last[0]), ", ".join(filter(None, [last[1], MOST_CAMBER])))


def without_camber(scene: Scene) -> Scene:
    """Return the scene with rectangular sections that cannot camber: an upper bound of the stiffness."""
    beam = scene.beam
    section, second, electrodes = beam.strip, beam.second_bending_stiffness, beam.electrodes
    assert section is not None and second is not None, "a rectangular section has both stiffnesses"
    flat = beam.bending_stiffness * section.camber_stiffening
    across = second * section.stiffening_across(beam.length)
    held: dict[str, Any] = {"bending_stiffness": flat, "second_bending_stiffness": across}
    if electrodes is not None:
        held["electrodes"] = electrodes.held_flat
    return replace(scene, beam=replace(beam, **held))


def can_add(scene: Scene, effect: effects.Effect) -> bool:
    """Whether an effect that a scene leaves out can be added with the data of its beam."""
    with suppress(InvalidValue):
        return bool(add_effect(scene, effect))
    return False
