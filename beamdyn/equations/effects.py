"""Physical effects beyond the Euler-Bernoulli beam: how to include each, and what is assumed without it.

The two directions in which a beam bends at the root are named here too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.statements import joined
from beamdyn.common.words import InputName, Setting, Words
from beamdyn.scene.beam import Beam
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.scene.scene import Scene

EXCLUSIVE = "it cannot be combined with large deflection"


@dataclass(frozen=True)
class Effect:
    """Physical effect that a beam model may include or neglect.

    Parameters
    ----------
    name : str
        Name, as it is displayed and saved.
    assumed : str
        Assumption of a model without the effect; "{across}" is replaced by the name of the second direction.
    switch : str
        Field of `Physics` that includes the effect; empty if no model can include it.
    value : int
        Value of the field `switch` of `Physics` with which the effect is included.
    needs : tuple of str
        Inputs of the beam of which the effect needs at least one: a property, or `poissons_ratio` (as the
        last), from which the property is computed.
    bends : bool
        Whether the effect can be combined with large deflection in one plane.
    taken_out : str
        Description of the effect in messages, if it must be neglected in order to include large deflection.
    uncertainty : float
        Relative error of the computed frequency change in short thick beams, compared with 3D solid models.
    """

    name: str
    assumed: str
    switch: str = ""
    value: int = True
    needs: tuple[str, ...] = ()
    bends: bool = False
    taken_out: str = ""
    uncertainty: float = 0.0

    def is_in(self, scene: Scene) -> bool:
        """Return whether the model of a scene includes the effect."""
        if self is ROTARY_INERTIA and scene.twists_in_space:
            return True
        return bool(self.switch) and getattr(scene.physics, self.switch) == self.value

    def is_left_out(self, scene: Scene) -> bool:
        """Return whether a scene's model neglects the effect.

        Twist and given offsets count as neglected only if the beam has them.
        """
        has = {
            TWIST: scene.beam.is_twisted,
            OFFSETS: scene.beam.has_offsets,
            _IN_LINE: not (scene.beam.has_offsets or scene.beam.matrices is not None),
        }
        return not self.is_in(scene) and has.get(self, True)

    @property
    def bends_in_space(self) -> bool:
        """Whether the effect can be combined with large deflection of rigid sections in space."""
        return self is not CAMBER

    def reason(self, scene: Scene) -> str:
        """Explain what the model of a scene assumes without the effect, and how to include the effect."""
        assumed = self.assumption(scene)
        return Words(assumed, "; ", self._how_to_include(scene)) if self.switch else assumed

    def assumption(self, scene: Scene) -> str:
        """Explain what the model of a scene assumes without the effect."""
        return self.assumed.format(across=name_directions(scene)[1][0])

    def _how_to_include(self, scene: Scene) -> str:
        if scene.physics.large_deflection and not self.bends_in_space:
            return EXCLUSIVE
        if (refused := self._why_refused(scene)) is not None:
            return refused
        lacking = [name for name in self.needs[:1] if _lacks(scene.beam, name)]
        needed = joined(" or ", map(InputName, self.needs))
        data = Words(", with ", needed, " of the beam") if lacking else ""
        others = [e.taken_out for e in EFFECTS if not e.bends_in_space and e.is_in(scene)]
        without = f", without {' and '.join(others)}" if others and self is LARGE_DEFLECTION else ""
        return Words(Setting("physics", **{self.switch: self.value}), " includes it", data, without)

    def _why_refused(self, scene: Scene) -> str | None:
        """Explain why the scene's model cannot include the effect, whatever data are given.

        Return None if the effect can be included, or if only data are missing.  Also return None, without a
        check, if the effect is large deflection or the scene has large deflection.
        """
        if scene.physics.large_deflection or self is LARGE_DEFLECTION:
            return None
        try:
            add_effects(scene, [self])
        except InvalidValue as refusal:
            return None if refusal.other else refusal.bound
        return None


def _lacks(beam: Beam, name: str) -> bool:
    """Return whether a property of a beam is neither given nor computed from its cross-section."""
    has_ratio = beam.section is not None and beam.section.poissons_ratio is not None
    if name == "poissons_ratio":
        return beam.strip is None or beam.strip.poissons_ratio is None
    return getattr(beam, name) is None and not (name == "torsion_stiffness" and has_ratio)


_SECOND = ("second_bending_stiffness",)
SECOND_PLANE = Effect(
    "second plane of bending", "the beam is rigid {across}", "planes", 2, _SECOND, taken_out="a second plane"
)
TWIST = Effect("twist", "sections stand as at the root", "planes", 2, _SECOND)
SHEAR = Effect(
    "shear deformation",
    "sections stay normal to the axis",
    "shear",
    needs=("shear_stiffness", "poissons_ratio"),
    taken_out="shear",
    uncertainty=0.02,
)
ROTARY_INERTIA = Effect(
    "rotary inertia of sections",
    "sections turn without inertia",
    "rotary_inertia",
    needs=("rotary_inertia",),
    bends=True,
    uncertainty=0.02,
)
STRETCH = Effect(
    "stretch", "the beam is inextensible", "stretch", needs=("axial_stiffness",), taken_out="stretch"
)
CAMBER = Effect(
    "camber of sections",
    "sections camber freely, at the clamped root too",
    "camber",
    needs=("poissons_ratio",),
    taken_out="camber",
    uncertainty=0.05,
)
TORSION = Effect(
    "torsion",
    "the beam is rigid against torsion",
    "torsion",
    needs=("torsion_stiffness", "poissons_ratio"),
    taken_out="torsion",
)
LARGE_DEFLECTION = Effect(
    "large deflection", "the equations are linear about the straight beam", "large_deflection", bends=True
)
_OFFSETS = "offsets of sections"
_LINE = "the centres of gravity, tension and shear of the sections are on one straight line"
# The effect for a beam with given offsets, which are neglected if torsion is not modelled.
OFFSETS = Effect(_OFFSETS, _LINE, "torsion", needs=("torsion_stiffness",))
_IN_LINE = Effect(_OFFSETS, _LINE)  # the effect for a beam without given offsets
EFFECTS = SECOND_PLANE, TWIST, SHEAR, ROTARY_INERTIA, CAMBER, STRETCH, LARGE_DEFLECTION, TORSION, OFFSETS
NEVER_MODELLED = _IN_LINE, Effect("contact", "nothing touches the beam")
NAMED = {effect.name: effect for effect in EFFECTS}


def add_effects(scene: Scene, effects: Iterable[Effect]) -> Scene:
    """Return the scene with further effects switched on in its `Physics`.

    Raises
    ------
    InvalidValue
        If the beam lacks a property that an effect needs, or the effects cannot be combined.
    """
    return replace(scene, physics=replace(scene.physics, **{each.switch: each.value for each in effects}))


_CHOSEN = 'physics is "auto": an analysis adds the effect where it matters'


@dataclass(frozen=True)
class OmittedEffect:
    """Physical effect that a model neglects.

    Parameters
    ----------
    name : str
        Name of the effect.
    reason : str
        Assumption of the model without the effect, and how to include the effect if possible.
    physics : str
        Name of the field of `Physics` that includes the effect; empty if no model can include it.

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
    """Yield the effects that the model of a scene neglects; those that it could include come first."""
    yield from (effect for effect in (*EFFECTS, *NEVER_MODELLED) if effect.is_left_out(scene))


def list_left_out(scene: Scene) -> Iterator[OmittedEffect]:
    """List the effects that the model of a scene neglects, with its assumptions and how to include them.

    With physics "auto", the model is the Euler-Bernoulli beam, to which an analysis may add any effect except
    torsion, which only adds modes.
    """
    for effect in effects_left_out(scene):
        reason = effect.reason(scene)
        if scene.chooses_physics and effect.switch and effect is not TORSION:
            reason = f"{effect.assumption(scene)}; {_CHOSEN}"
        yield OmittedEffect(effect.name, reason, effect.switch)


_OUTWARD = -1.0, 0.0  # cosine and sine of the setting angle of a radially outward beam
# Names of the directions of bending, each as a phrase and as one word.
_EDGE = "in the plane of rotation (edge)", "edge"
_FLAP = "out of the plane of rotation (flap)", "flap"
_OWN_EDGE = "edgewise, in the section's direction (edge)", "edge"
_OWN_FLAP = "flapwise, in the section's direction (flap)", "flap"
_BENDING = "in the direction of bending", "bending"
_ACROSS = "across the direction of bending", "across"


def check_direction(direction: int) -> int:
    """Check that a direction of deflection is 0 (bending direction at the root) or 1 (across)."""
    if direction not in (0, 1):
        bound = "give 0 for the direction of bending at the root, or 1 for the direction across it"
        raise InvalidValue("direction", direction, bound)
    return direction


def name_directions(scene: Scene) -> tuple[tuple[str, str], tuple[str, str]]:
    """Name the bending direction at the root and the one across, each as a phrase and as one word.

    The words are "edge" and "flap" if the bending angle is a multiple of 90 degrees, or at any angle (blade
    pitch) if the beam points outward; "flap" is the direction nearer to the axis of rotation.
    """
    c, s = aligned_cos_sin(scene.mount.bending_angle)
    if s == 0:
        return _EDGE, _FLAP
    if c == 0:
        return _FLAP, _EDGE
    if aligned_cos_sin(scene.mount.setting_angle) != _OUTWARD:
        return _BENDING, _ACROSS
    return (_OWN_FLAP, _OWN_EDGE) if abs(s) >= abs(c) else (_OWN_EDGE, _OWN_FLAP)


def first_drawn(scene: Scene) -> int:
    """Choose the direction drawn with a solid line: flap if there is one, else the bending direction."""
    return 1 if name_directions(scene)[1][1] == "flap" else 0


def modelled_directions(scene: Scene) -> tuple[str, ...]:
    """Name the directions in which a scene's beam bends; the bending direction at the root comes first."""
    return tuple(words for words, _ in name_directions(scene))[: scene.physics.planes]


def words_of_directions(scene: Scene) -> tuple[str, ...]:
    """Name the directions of bending in one word each; empty if only one plane is modelled."""
    return tuple(word for _, word in name_directions(scene) if scene.physics.planes == 2)
