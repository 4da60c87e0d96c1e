"""The scene: a beam, its mounting on the carrier, and the motion of the carrier."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, kind, moderate, not_negative, refuse, set_fields
from beamdyn.common.results.columns import SI_UNITS, DisplayUnits
from beamdyn.common.results.one_line import OneLine, given_fields, number
from beamdyn.common.results.result import Provenance, Result
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.words import Named, Setting, Words
from beamdyn.scene.beam import OFFSETS, Beam
from beamdyn.scene.motion.base import Motion
from beamdyn.scene.mount import NO_DAMPING, Damping, Mount, aligned_cos_sin, check_one_kind_of_ratios
from beamdyn.scene.names_elsewhere import GIVE_OR_COMPUTE, GIVE_OR_RATIO, RECTANGULAR
from beamdyn.scene.physics import (
    AUTO,
    AUTO_NAME,
    ROOT_SPRINGS,
    AutomaticPhysics,
    Physics,
    PhysicsChoice,
    check_point_springs,
    check_root_springs,
    check_tip_load,
    how_without_large_deflection,
)
from beamdyn.scene.points import NO_LOAD, TipLoad
from beamdyn.scene.profile import Profile, mean

_SLENDER = Physics(), Physics(stretch=True)  # physics of a slender beam in one plane


@dataclass(frozen=True)
class Scene(OneLine):
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
        Gravitational acceleration along -n2, a fixed direction in the plane of rotation [m/s2].
    physics : Physics or "auto"
        Effects beyond the slender beam that bends in one plane; "auto": each analysis adds those whose size
        exceeds its tolerance, and its result says which.
    physics_choice : PhysicsChoice, optional
        How the physics was chosen: analyses set it in the scene of their result.
    damping : Damping
        Further damping: ratios mode by mode, Rayleigh's factors, a damper at the tip.
    label : str
        Name of the scene in pictures that show several.
    units : DisplayUnits or dict
        Units in which results are shown, such as {"speed": "rpm", "length": "mm"}; all numbers are SI
        nevertheless.  A scene from a file has those of the file.
    tip_load : TipLoad
        Force and moment at the tip; they need `large_deflection` in the physics.

    Raises
    ------
    ValueError
        If the damping ratio is outside [0, 1), the beam lacks a property that the physics needs, or a spring
        at the root is so stiff that rounding hides the difference from a clamp.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), damping_ratio=0.01)
    >>> scene.is_damped
    True
    """

    field_units: ClassVar[dict[str, str]] = {"m/s2": "gravity"}

    beam: Beam
    mount: Mount = Mount()
    motion: Motion | None = None
    damping_ratio: float = 0.0
    gravity: float = 0.0
    physics: Physics = Physics()
    physics_choice: PhysicsChoice | None = field(default=None, repr=False, compare=False)
    damping: Damping = NO_DAMPING
    label: str = field(default="", repr=False, compare=False)
    units: DisplayUnits = field(default=SI_UNITS, repr=False, compare=False)
    tip_load: TipLoad = field(default=NO_LOAD, metadata=ADDED_LATER)

    if TYPE_CHECKING:  # "auto" is accepted as argument, but the attribute is always a Physics

        def __init__(
            self,
            beam: Beam,
            mount: Mount = Mount(),
            motion: Motion | None = None,
            damping_ratio: float = 0.0,
            gravity: float = 0.0,
            physics: Physics | Literal["auto"] = Physics(),
            physics_choice: PhysicsChoice | None = None,
            damping: Damping = NO_DAMPING,
            label: str = "",
            units: DisplayUnits | Mapping[str, str] = SI_UNITS,
            tip_load: TipLoad = NO_LOAD,
        ) -> None: ...

    def __post_init__(self) -> None:
        kind("beam", self.beam, Beam, "Beam.rectangular and Beam.from_stiffness make one")
        kind("mount", self.mount, Mount, "mount = Mount(radius=0.2) sets a radius of 0.2 m")
        if isinstance(self.motion, type) or not (self.motion is None or hasattr(self.motion, "at")):
            raise InvalidValue("motion", self.motion, "give a Motion, such as SteadyRotation(speed)")
        ratio = not_negative("damping_ratio", self.damping_ratio)
        remedy = "1 % is damping_ratio = 0.01"
        refuse(ratio >= 1, "damping_ratio", ratio, "", "it must be below 1", remedy)
        set_fields(self, damping_ratio=ratio, gravity=moderate("gravity", self.gravity, "m/s2"))
        kind("label", self.label, str, 'it is text, such as "0.2 mm"')
        set_fields(self, units=DisplayUnits.of(self.units))
        kind("damping", self.damping, Damping, "Damping(tip_damper=0.1) sets a damper at the tip")
        check_one_kind_of_ratios(ratio, self.damping)
        kind("tip_load", self.tip_load, TipLoad, "TipLoad(force=(0, 1, 0)) is 1 N across the beam")
        if isinstance(self.physics, str) and self.physics == AUTO_NAME:
            set_fields(self, physics=AUTO)
        elif isinstance(self.physics, AutomaticPhysics) and self.physics != AUTO:
            # An effect that is set explicitly ends the automatic choice.
            set_fields(self, physics=Physics(**vars(self.physics)))
        remedy = 'give "auto", or a Physics such as Physics(planes=2, shear=True), two planes with shear'
        kind("physics", self.physics, Physics, remedy)
        if self.physics_choice is not None and self.physics_choice.physics != self.physics:
            set_fields(self, physics_choice=None)  # the stored choice was made for other physics
        _check_layers(self.beam, self.physics)
        electrodes = self.beam.electrodes
        # The constants of the electrodes depend on whether camber is modelled.
        if electrodes is not None and electrodes.across != self.physics.camber:
            beam = replace(self.beam, electrodes=replace(electrodes, across=self.physics.camber))
            set_fields(self, beam=beam)
        _check_properties(self.beam, self.physics)
        _check_width(self.beam, self.physics)
        if not self.chooses_physics:
            _check_matrices(self.beam, self.physics)
            check_axis(self.beam, self.physics)
        if self.physics.large_deflection:
            _check_large_deflection(self, self.physics.planes, how_without_large_deflection(self.beam))
        check_tip_load(self.tip_load, self.mount, self.physics)
        check_root_springs(self.mount, self.modelled_beam)
        check_point_springs(self.beam, self.physics)
        # Refuse a damper so strong that rounding hides the tip's motion, as at a support.
        beam, damper = self.beam, self.damping.tip_damper
        mass = mean(beam.mass_per_length) * beam.length + float(beam.lumps[1].sum())
        mass += 0.0 if beam.tip is None else beam.tip.mass
        most = _MOST_DAMPING * math.sqrt(mean(beam.bending_stiffness) * mass / beam.length**3)
        bound = "it must be at most {limit}, 1e6 sqrt(EI m/L^3) with mass m: with more the tip does not move"
        refuse(damper > most, "damping.tip_damper", damper, "N s/m", bound, "reduce it", limit=most)

    def headline(self) -> Iterator[str]:
        """Yield label, beam, mount, motion, and all other inputs that were given, as text."""
        unit = self.units.length_unit("mm" if self.beam.length < 1 else "m")
        yield repr(self.label) if self.label else ""
        yield f"beam of {number(self.beam.length * unit.per_si, unit.name)}"
        yield f"radius {number(self.mount.radius * unit.per_si, unit.name)}" if self.mount.radius else ""
        yield self._say_motion()
        yield "damped" if self.is_damped else ""
        yield f"gravity {number(self.gravity, 'm/s2')}" if self.gravity else ""
        yield "load at the tip" if self.tip_load.acts else ""
        yield "physics 'auto'" if self.chooses_physics else ", ".join(given_fields(self.physics))

    def _say_motion(self) -> str:
        """Describe the kind of motion and its final speed."""
        if self.motion is None:
            return ""
        speed, unit = getattr(self.motion, "final_speed", math.nan), self.units.speed_unit()
        known = f" to {number(speed * unit.per_si, unit.name)}" if math.isfinite(speed) else ""
        return f"{type(self.motion).__name__}{known}"

    @property
    def final_speed(self) -> float:
        """Final speed of the motion [rad/s]; 0 without a motion, or if the motion does not settle."""
        final = 0.0 if self.motion is None else self.motion.final_speed
        return final if math.isfinite(final) else 0.0

    @property
    def is_damped(self) -> bool:
        """Whether the vibration is damped, also by the resistance of a harvester."""
        electrodes = self.beam.electrodes
        return bool(self.damping_ratio) or self.damping.damps or bool(electrodes and electrodes.is_loaded)

    @property
    def undamped(self) -> Scene:
        """Return the scene without damping."""
        return replace(self, damping_ratio=0.0, damping=NO_DAMPING)

    def with_large_deflection(self, **chosen: Any) -> Scene:
        """Return the scene with large deflection and `chosen` physics, for analyses that always model it.

        Raises
        ------
        ValueError
            If an included effect, or a part of the scene, cannot be combined with large deflection.
        """
        physics = self.physics.with_large_deflection(**chosen)
        if not self.physics.large_deflection:
            remedy = "leave it out, as this analysis always models large deflection"
            _check_large_deflection(self, physics.planes, remedy)
        return replace(self, physics=physics)

    @property
    def chooses_physics(self) -> bool:
        """Whether the physics was given as "auto"."""
        return isinstance(self.physics, AutomaticPhysics)

    @property
    def modelled_beam(self) -> Beam:
        """The beam without the properties that the physics does not use."""
        return _without_unmodelled(self.beam, self.physics)

    @property
    def bends_in_space(self) -> bool:
        """Whether large deflection needs a beam in space, not the elastica in one plane."""
        chosen, eta, psi = self.physics, self.mount.precone, self.mount.bending_angle
        others = self.beam.is_curved or chosen.planes == 2 or chosen.shear or chosen.stretch or chosen.torsion
        return chosen.large_deflection and bool(others or eta or min(map(abs, aligned_cos_sin(psi))))

    @property
    def twists_in_space(self) -> bool:
        """Whether sections rotate by any angle in space, so that all rotary inertias count."""
        return self.physics.torsion and self.bends_in_space

    @property
    def may_flutter_by_load(self) -> bool:
        """Whether the load at the tip has no potential: it follows the tip, or is a moment in two planes."""
        load = self.tip_load
        return load.acts and (load.follows or (self.physics.planes == 2 and any(load.moment)))

    @property
    def straightened(self) -> Scene:
        """The scene with small deflections of a straight axis: no large deflection, sweep, prebend, tip load.

        Coupling of strains by section matrices and torsion of a twisted strip, which only large deflection
        can model, are left out.
        """
        torsion = self.physics.torsion and not (self.beam.is_twisted and self.beam.section is not None)
        straight = replace(
            self.physics,
            large_deflection=False,
            branch="straight",
            torsion=torsion,
            rotary_inertia=self.physics.rotary_inertia or self.twists_in_space,
        )
        if self.beam.is_curved or self.beam.matrices is not None:
            beam = replace(self.beam, sweep=None, prebend=None, matrices=None)
            return replace(self, beam=beam, physics=straight, tip_load=NO_LOAD)
        return replace(self, physics=straight, tip_load=NO_LOAD)

    @property
    def models_width(self) -> bool:
        """Whether deflections vary across the width, as rectangular sections camber or twist."""
        chosen = self.physics
        return (chosen.camber or chosen.torsion) and _with_constants(self.beam, chosen).strip is not None

    @property
    def is_slender_beam_in_one_plane(self) -> bool:
        """Whether the model is a clamped Euler-Bernoulli beam in one plane, to which some theorems apply."""
        electrodes = self.beam.electrodes
        sprung = self.beam.point_springs or (electrodes is not None and math.isinf(electrodes.resistance))
        return self.physics in _SLENDER and self.mount.root_stiffness == math.inf and not sprung


def check_scene(scene: object) -> None:
    """Refuse an argument of an analysis that is not a scene."""
    remedy = "Scene(beam, mount) makes one of a beam, load_scene(path) reads one from a file"
    kind("scene", scene, Scene, remedy)


# Curved axes, and large deflection -----------------------------------------------------------------


def check_axis(beam: Beam, physics: Physics) -> None:
    """Refuse a curved axis in equations of straight beams."""
    if beam.is_curved and not physics.large_deflection:
        name = "prebend" if beam.sweep is None else "sweep"
        given = getattr(beam, name)
        bound = "without physics.large_deflection the axis of the beam is straight"
        remedy = Words(Setting("physics", large_deflection=True), " includes it")
        raise InvalidValue(name, float(given(np.ones(1))[0]), bound, remedy, "rad", where=" at the tip")


_OF_MATRICES = ("shear", "stretch", "torsion", "large_deflection")  # effects that 6 x 6 matrices couple


def _check_matrices(beam: Beam, physics: Physics) -> None:
    """Refuse section matrices that couple all strains, in equations that lack some of the strains."""
    if beam.matrices is None:
        return
    lacking = [name for name in _OF_MATRICES if not getattr(physics, name)]
    if physics.planes == 1 or lacking:
        name = "planes" if physics.planes == 1 else lacking[0]
        bound = "the 6 x 6 matrices of the sections couple all strains"
        wanted = Setting("physics", planes=2, **dict.fromkeys(_OF_MATRICES, True))
        raise InvalidValue(f"physics.{name}", getattr(physics, name), bound, Words("give ", wanted))


def _check_large_deflection(scene: Scene, planes: int, remedy: str) -> None:
    """Refuse large deflection without an equilibrium at rest, and options for small deflections only."""
    for name, spring in zip(ROOT_SPRINGS[:planes], scene.mount.root_stiffnesses, strict=False):
        if spring == 0:
            bound = "with physics.large_deflection the root needs a spring: a hinge is at rest at any angle"
            raise InvalidValue(f"mount.{name}", spring, bound, "give a soft one", "N m/rad")
        if spring < math.inf and scene.beam.matrices is not None:
            bound = "a beam given by matrices of its sections needs a clamped root"
            raise InvalidValue(f"mount.{name}", spring, bound, "leave it out", "N m/rad")
    if scene.beam.electrodes is not None and scene.beam.electrodes.resistance:
        bound = "with physics.large_deflection the layers of a harvester must be short-circuited, R = 0"
        raise InvalidValue("harvester.resistance", scene.beam.electrodes.resistance, bound, remedy, "ohm")
    if scene.beam.point_springs:
        bound = "with physics.large_deflection point springs are not modelled: they keep their direction"
        raise InvalidValue("point_springs", len(scene.beam.point_springs), bound, remedy)
    if scene.damping.tip_damper:
        bound = "with physics.large_deflection, the damper is not modelled: the tip also moves along the beam"
        remedy = f"give damping.ratios, or {remedy}"
        raise InvalidValue("damping.tip_damper", scene.damping.tip_damper, bound, remedy, "N s/m")


# Damper at the tip --------------------------------------------------------------------------------

# Largest damper divided by sqrt(EI m / L^3): above, rounding errors exceed the decay rate of the tip.
_MOST_DAMPING = 1e6


# Properties that the physics needs ----------------------------------------------------------------

_SECOND = "second_"  # prefix of properties of bending in the second direction of the section
_BENDING = "bending_stiffness"
# Property of the beam that each effect needs, for bending in the first direction.
_NEEDED = {"shear": "shear_stiffness", "rotary_inertia": "rotary_inertia"}
_REMEDIES = {
    "second_bending_stiffness": GIVE_OR_COMPUTE,
    "shear_stiffness": GIVE_OR_RATIO,
    "rotary_inertia": GIVE_OR_COMPUTE,
    "axial_stiffness": GIVE_OR_COMPUTE,
    "torsion_stiffness": GIVE_OR_RATIO,
}


# Properties that torsion needs unless a rectangular section determines them.
_OF_TORSION = ("torsion_stiffness", "rotary_inertia", "second_rotary_inertia")


def _needed_properties(beam: Beam, physics: Physics) -> dict[str, str]:
    """List the beam's optional properties that a model needs, each with the effect that needs it."""
    directions = ("", _SECOND) if physics.planes == 2 else ("",)
    needed = {direction + name: effect for effect, name in _NEEDED.items() for direction in directions}
    needed = {name: effect for name, effect in needed.items() if getattr(physics, effect)}
    if physics.planes == 2:
        needed[_SECOND + _BENDING] = "planes"
    if physics.torsion and not physics.camber and beam.section is None:
        needed |= dict.fromkeys(_OF_TORSION, "torsion")
    return needed | ({"axial_stiffness": "stretch"} if physics.stretch else {})


def _check_layers(beam: Beam, physics: Physics) -> None:
    """Refuse torsion of sections with piezoelectric layers, unless the beam has a torsional stiffness."""
    if beam.electrodes is not None and beam.torsion_stiffness is None and physics.torsion:
        bound = "it is not modelled for sections with piezoelectric layers"
        raise InvalidValue("physics.torsion", True, bound, "leave it out")


def _check_properties(beam: Beam, physics: Physics) -> None:
    """Refuse physics for which the beam lacks properties; the message names all that one effect needs."""
    beam = _with_constants(beam, physics)
    needed = _needed_properties(beam, physics)
    lacking = [name for name in needed if getattr(beam, name) is None]
    if not lacking:
        return
    first, effect = lacking[0], needed[lacking[0]]
    others = [name for name in lacking[1:] if needed[name] == effect]
    remedy = _REMEDIES[first if first in _REMEDIES else first.removeprefix(_SECOND)]
    bound = ", ".join(["it needs {other}", *others])
    raise InvalidValue(f"physics.{effect}", getattr(physics, effect), bound, remedy, other=first)


# Lengths, in local widths, of segments at a clamped root that resolve the stresses in a plate's corners.
_CORNERS = 0.2, 1.2
# Largest x/L at which a segment near the root that resolves stresses in corners may end.
_LAST_CORNER = 0.7
_SHARPEST = 1.0  # change of the width's slope above which camber is wrong by several percent
_JUMP = 1e-9  # jump of the width, relative to the width, up to which it counts as a rounding error


def _check_width(beam: Beam, physics: Physics) -> None:
    """Refuse camber of sections that are not rectangular, and camber and torsion of twisted strips."""
    if not (physics.camber or physics.torsion):
        return
    section, name = beam.strip, "physics.camber" if physics.camber else "physics.torsion"
    if (section is None and physics.camber) or (section is not None and section.poissons_ratio is None):
        lacking = "the sides of a rectangular section" if section is None else "poissons_ratio"
        given = Named("(..., poissons_ratio=0.3)", ", with poissons_ratio = 0.3,")
        remedy = Words(RECTANGULAR, given, " makes one of steel")
        if section is not None and beam.electrodes is not None:
            remedy = Words("give poissons_ratio of the beam, and harvester.poissons_ratio")
            lacking = "poissons_ratio of the beam and of its layers"
        raise InvalidValue(name, True, "it needs {other}", remedy, other=lacking)
    if beam.is_twisted and section is not None and not physics.large_deflection:
        bound, remedy = "camber and torsion of a twisted strip are not modelled", "leave one of the two out"
        raise InvalidValue("twist", beam.tip_twist, bound, remedy, "rad")
    if section is None or not physics.camber:
        return
    left, right = section.width.end_values()
    jumps = np.flatnonzero(np.abs(right[:-1] - left[1:]) > _JUMP * right[:-1])
    kinks = section.kinks_of_width(beam.length)
    if not jumps.size and kinks.max(initial=0.0) > _SHARPEST:
        at = section.width.breakpoints[int(kinks.argmax()) + 1]
        bound = "camber is modelled where the slope of the width changes by at most {limit}"
        remedy, where = "taper it over a longer part, or leave camber out", f" at x/L = {at:.3g}"
        raise InvalidValue("slope of width", float(kinks.max()), bound, remedy, "", _SHARPEST, where=where)
    if jumps.size:
        at = section.width.breakpoints[jumps[0] + 1]
        bound = "camber where the width jumps is not modelled"
        where = f" at x/L = {at:.3f}, {float(right[jumps[0]]):.6g} m before it"
        remedy = "leave one of the two out"
        raise InvalidValue("width", float(left[jumps[0] + 1]), bound, remedy, "m", where=where)


def _with_constants(beam: Beam, physics: Physics) -> Beam:
    """Replace a rectangular section by constants such as its torsional stiffness, for large deflection."""
    section = beam.section
    if (
        section is None
        or section.poissons_ratio is None
        or not (physics.large_deflection and physics.torsion)
    ):
        return beam
    return replace(beam, section=None, torsion_stiffness=section.torsion_stiffness)


def _with_corners(beam: Beam, planes: int) -> Profile:
    """Return the mass per length with breakpoints that resolve stresses in a plate's corners at the root."""
    assert beam.strip is not None
    part = float(beam.strip.width(np.zeros(1))[0]) / beam.length
    places = tuple(part * each for each in _CORNERS)
    if planes == 2:  # the clamp stiffens bending along the width up to x/L = reach
        reach = beam.strip.stiffening_across(beam.length).breakpoints[1]
        places = reach / 2, reach, places[1]
    places = [each for each in places if each <= _LAST_CORNER]
    return beam.mass_per_length.split((0.0, *places, 1.0))


@lru_cache(maxsize=256)
def _without_unmodelled(beam: Beam, physics: Physics) -> Beam:
    """Remove the properties of the beam that a model with this physics does not use."""
    beam = _with_constants(beam, physics)
    optional = {direction + name for direction in ("", _SECOND) for name in _NEEDED.values()}
    unread = (optional | {_SECOND + _BENDING, "torsion_stiffness"}) - _needed_properties(beam, physics).keys()
    unread |= {"twist"} if physics.planes == 1 or not beam.is_twisted else set()
    unread |= set() if physics.torsion else {"warping_stiffness", *OFFSETS}
    unread |= set() if physics.large_deflection else {"matrices"}
    given: dict[str, Any] = {name: None for name in unread if getattr(beam, name) is not None}
    if beam.tip is not None and beam.tip.offset_across and not physics.torsion:
        given["tip"] = replace(beam.tip, offset_across=0.0)
    if beam.strip is not None and (physics.camber or physics.torsion):  # deflections vary across the width
        given["mass_per_length"] = _with_corners(beam, physics.planes if physics.camber else 1)
    return replace(beam, **given) if given else beam


@dataclass(frozen=True, kw_only=True)
class SceneResult(Result):
    """Base class of results for one scene; fields of subclasses come before the fields listed here.

    Attributes
    ----------
    warnings : tuple of str
        Limitations of the result.
    provenance : Provenance
        How the result was computed.
    scene : Scene
        The scene, with its physics chosen.
    """

    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)
