"""Physics that a model leaves out: what it is, whether the scene could model it, and how."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from beamdyn.equations.effects import EFFECTS, NEVER_MODELLED, Effect
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

_CHOSEN = 'physics is "auto": an analysis adds it where it matters'


@dataclass(frozen=True)
class OmittedEffect:
    """An effect that a model leaves out.

    Parameters
    ----------
    name : str
        Name of the effect.
    reason : str
        What the model assumes in its place, and how to include the effect if that can be done.
    physics : str
        Name of the field of `Physics` that includes it; empty if no model has it.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> [effect.name for effect in bd.terms(bd.Scene(strip)).left_out][:2]
    ['second plane of bending', 'shear deformation']
    """

    name: str
    reason: str
    physics: str = ""


def effects_left_out(scene: Scene) -> Iterator[Effect]:
    """The effects that the model of a scene leaves out, those that it could include first."""
    yield from (effect for effect in (*EFFECTS, *NEVER_MODELLED) if effect.is_left_out(scene))


def list_left_out(scene: Scene) -> Iterator[OmittedEffect]:
    """List the effects that the model of a scene leaves out, with what it assumes and how to include them.

    Where the physics is "auto", the model is that of the plain beam, and analyses choose what they add.
    """
    modelled = replace(scene, physics=Physics()) if scene.chooses_physics else scene
    for effect in effects_left_out(modelled):
        reason = effect.reason(modelled)
        if scene.chooses_physics and effect.switch:
            reason = f"{reason.partition(';')[0]}; {_CHOSEN}"
        yield OmittedEffect(effect.name, reason, effect.switch)
