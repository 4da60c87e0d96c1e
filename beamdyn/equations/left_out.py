"""Physics that a model leaves out: what it is, whether the scene could model it, and how."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from beamdyn.equations.directions import name_directions
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

_SHEAR_DATA = "shear_stiffness or poissons_ratio"
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


_NEVER = (
    OmittedEffect("torsion", "the beam is rigid against torsion"),
    OmittedEffect(
        "offsets of sections", "their centres of gravity, tension and shear are on one straight line"
    ),
    OmittedEffect("warping and Poisson contraction", "sections keep their shape"),
    OmittedEffect("contact", "nothing touches the beam"),
)


def list_left_out(scene: Scene) -> Iterator[OmittedEffect]:
    """List the effects that the model of a scene leaves out, those that it could include first.

    Where the physics is "auto", the model is that of the plain beam, and analyses choose what they add.
    """
    if scene.chooses_physics:
        for effect in list_left_out(replace(scene, physics=Physics())):
            assumed = effect.reason.partition(";")[0]
            yield replace(effect, reason=f"{assumed}; {_CHOSEN}") if effect.physics else effect
        return
    yield from _second_plane(scene)
    physics, beam = scene.physics, scene.beam
    if not physics.shear:
        given = _how(physics, "shear=True", beam.shear_stiffness is not None, _SHEAR_DATA)
        yield OmittedEffect("shear deformation", f"sections stay normal to the axis; {given}", "shear")
    if not physics.rotary_inertia:
        given = _how(physics, "rotary_inertia=True", beam.rotary_inertia is not None, "rotary_inertia")
        reason = f"sections turn without inertia; {given}"
        yield OmittedEffect("rotary inertia of sections", reason, "rotary_inertia")
    if not physics.stretch:
        given = _how(physics, "stretch=True", beam.axial_stiffness is not None, "axial_stiffness")
        yield OmittedEffect("stretch", f"the beam is inextensible; {given}", "stretch")
    if not physics.large_deflection:
        given = f"Physics(large_deflection=True) includes it{_without_exclusive(physics)}"
        reason = f"the equations are linear about the straight beam; {given}"
        yield OmittedEffect("large deflection", reason, "large_deflection")
    yield from _NEVER


def _second_plane(scene: Scene) -> Iterator[OmittedEffect]:
    """The direction across, and what acts on it only."""
    if scene.physics.planes == 2:
        return
    beam = scene.beam
    has_data = beam.second_bending_stiffness is not None
    given = _how(scene.physics, "planes=2", has_data, "second_bending_stiffness")
    across = name_directions(scene)[1][0]
    yield OmittedEffect("second plane of bending", f"the beam is rigid {across}; {given}", "planes")
    if beam.twist is not None:
        yield OmittedEffect("twist", f"sections stand as at the root; {given}", "planes")


def _without_exclusive(physics: Physics) -> str:
    """What large deflection takes the place of, ", without shear"; empty if nothing."""
    given = {"a second plane": physics.planes == 2, "shear": physics.shear, "stretch": physics.stretch}
    names = [name for name, is_given in given.items() if is_given]
    return f", without {' and '.join(names)}" if names else ""


def _how(physics: Physics, switch: str, given: bool, needed: str) -> str:
    """How to include an effect, or that it is not combined with large deflection."""
    if physics.large_deflection and not switch.startswith("rotary_inertia"):
        return "it cannot be combined with large deflection"
    return f"Physics({switch}) includes it" + ("" if given else f", with {needed} of the beam")
