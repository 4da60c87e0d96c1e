"""Physical effects that a model includes beyond the slender beam that bends in one plane.

Loads at the tip, and springs at the root and along the beam, are refused if the model with these effects
cannot represent them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Literal

from beamdyn.common.inputs.checks import InvalidValue, count, flag, one_of, refuse, set_fields
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.result import Result, plain
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.results.statements import TOLERANCE, Statement, joined
from beamdyn.common.words import Setting, Words, percent
from beamdyn.scene.beam import Beam
from beamdyn.scene.mount import Mount, aligned_cos_sin
from beamdyn.scene.points import ACROSS, TipLoad
from beamdyn.scene.profile import mean


@dataclass(frozen=True)
class Physics:
    """Physical effects that a model includes; effects that are off cost nothing.

    Parameters
    ----------
    planes : int
        1: the beam bends in the direction of the bending angle only, the other being rigid.  2: it bends in
        both directions of its section, which the twist turns along the beam.
    shear : bool
        Shear deformation (Timoshenko): sections stay plane but need not be normal to the axis.
    rotary_inertia : bool
        Rotary inertia of the sections (Rayleigh).
    stretch : bool
        Axial stretch and its Coriolis coupling with bending (Yoo and Shin), for comparison with papers.
    large_deflection : bool
        Slopes and angles of any size: the beam vibrates about the equilibrium to which rotation bends it.
        In one plane, in or out of the plane of rotation, it is the inextensible elastica; with both planes,
        torsion, shear or stretch a geometrically exact beam in space.  It cannot be combined with camber, and
        torsion is then described by constants of the sections, with their full rotary inertia.
    branch : {"straight", "bent"}
        Branch of equilibria under large deflection: "straight" is reached from rest as the speed rises (the
        beam bends if rotation loads it across).  "bent" is the other stable equilibrium, which exists at high
        speed: bent to one side if the first is straight, to the opposite side if the first is bent.
    camber : bool
        Change of shape of a rectangular section (anticlastic curvature by Poisson's ratio), which a clamped
        root hinders.
    torsion : bool
        Torsion, whose warping a clamped root hinders.  With camber and torsion, a strip is a Kirchhoff plate.

    Raises
    ------
    ValueError
        If `planes` is neither 1 nor 2, another value is no truth value, or large deflection is combined with
        camber.

    References
    ----------
    Yoo and Shin (1998), stretch; Timoshenko (1921), shear, with tension after Engesser; others: own
    derivation: docs/conventions.md.

    Examples
    --------
    >>> wire = bd.Beam.rectangular(0.05, 0.0004, 0.0002, 200e9, 7850.0)
    >>> both = bd.Scene(wire, physics=bd.Physics(planes=2))
    >>> bd.natural_modes(both, modes=4).plane_share[:, 0].round(3)  # 1: along the thickness, 0: across
    array([1., 0., 1., 0.])
    """

    planes: Annotated[
        Literal[1, 2], Described(meaning="directions of bending: that of the bending angle, or both")
    ] = 1
    shear: Annotated[bool, Described(meaning="shear deformation")] = False
    rotary_inertia: Annotated[bool, Described(meaning="rotary inertia of the sections")] = False
    stretch: Annotated[bool, Described(meaning="stretch of the beam and its Coriolis coupling")] = False

    large_deflection: Annotated[bool, Described(meaning="slopes and angles of any size")] = False
    branch: Annotated[
        Literal["straight", "bent"],
        Described(meaning="equilibrium of large deflection: reached from rest, or another at high speed"),
    ] = "straight"
    camber: Annotated[
        bool, Described(meaning="camber of a rectangular section, which a clamped root hinders")
    ] = field(default=False, metadata=ADDED_LATER)
    torsion: Annotated[bool, Described(meaning="torsion")] = field(default=False, metadata=ADDED_LATER)

    def __post_init__(self) -> None:
        set_fields(self, planes=count("physics.planes", self.planes, most=2))
        for name in ("shear", "rotary_inertia", "camber", "torsion", "stretch", "large_deflection"):
            set_fields(self, **{name: flag(f"physics.{name}", getattr(self, name))})
        one_of("physics.branch", self.branch, ("straight", "bent"))
        if self.large_deflection and self.camber:  # large deflection assumes sections of constant shape
            bound = "it cannot be combined with large_deflection"
            raise InvalidValue("physics.camber", True, bound, "leave one of the two out")

    def with_large_deflection(self, **chosen: Any) -> Physics:
        """Return a copy with large deflection and the `chosen` fields, for analyses that always model it.

        Raises
        ------
        ValueError
            If an included effect cannot be combined with large deflection.
        """
        try:
            return replace(self, large_deflection=True, **chosen)
        except InvalidValue as refusal:
            bound = "this analysis models large deflection, with which it cannot be combined"
            raise replace(refusal, bound=bound, remedy="leave it out") from None


@dataclass(frozen=True, repr=False)
class AutomaticPhysics(Physics):
    """Physics "auto", which each analysis chooses; elsewhere it counts as the slender beam in one plane."""

    def __repr__(self) -> str:
        return repr(AUTO_NAME)


AUTO_NAME = "auto"
AUTO = AutomaticPhysics()


_WORTH_SAYING = 0.1  # errors smaller than this fraction of the tolerance are not named in the warning

# Physics that was chosen for a scene --------------------------------------------------------------


@dataclass(frozen=True)
class JudgedEffect:
    """A physical effect beyond a slender beam bending in one plane: its estimated size, and whether included.

    Parameters
    ----------
    name : str
        Name of the effect.
    size : float
        Largest relative change that the effect makes in the result; inf where it changes which modes there
        are, nan where it is not known.
    included : bool
        Whether the physics includes it.
    reason : str
        Why the effect is left out or its size is not known; empty if its size alone decided.
    time, coordinates : float
        Time of the eigenproblem and number of coordinates with this effect alone, relative to the slender
        beam in one plane; nan where it is left out, or was added later because a result deflected too far.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> modes = bd.natural_modes(bd.Scene(strip, bd.Mount(0.215), physics="auto"), speed=50.0, modes=1)
    >>> sorted(effect.name for effect in modes.physics_choice.effects)[:2]
    ['camber of sections', 'large deflection']
    """

    name: str
    size: float
    included: bool
    reason: str = ""
    time: float = math.nan
    coordinates: float = math.nan


@dataclass(frozen=True)
class PhysicsChoice:
    """Choice of a scene's physics that was given as "auto", with the sizes of all effects.

    Parameters
    ----------
    physics : Physics
        The physics that was chosen.
    tolerance : float
        Relative change of the result that may be left out.
    speeds : tuple of float
        Speeds at which the sizes of the effects were estimated [rad/s].
    effects : tuple of JudgedEffect
        All effects that can be modelled, those included first.
    model_error : float
        Largest sum of the sizes of the effects left out, as far as they are known: a relative change.
    time, coordinates : float
        Time of the eigenproblem and number of coordinates, relative to the slender beam in one plane.
    not_modelled : tuple of str
        Effects that this package does not model.
    beyond_models : float
        Estimated relative error that no model of this package avoids, as far as it is known: a fraction of
        the size of each included effect, found by comparisons with solid bodies, plus the change by the axial
        strain due to rotation.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    >>> modes = bd.natural_modes(bd.Scene(strip, bd.Mount(0.215), physics="auto"), speed=50.0, tolerance=0.01)
    >>> modes.physics_choice.included, modes.physics_choice.is_met
    (('camber of sections',), True)
    """

    physics: Physics
    tolerance: float
    speeds: tuple[float, ...]
    effects: tuple[JudgedEffect, ...]
    model_error: float
    time: float
    coordinates: float
    not_modelled: tuple[str, ...]
    beyond_models: float = field(default=0.0, metadata=ADDED_LATER)

    @property
    def included(self) -> tuple[str, ...]:
        """Names of the effects that the physics includes."""
        return tuple(effect.name for effect in self.effects if effect.included)

    @property
    def not_known(self) -> dict[str, str]:
        """Effects left out although their size is unknown, and the reasons why it is unknown."""
        left_out = (effect for effect in self.effects if not effect.included)
        return {effect.name: effect.reason for effect in left_out if math.isnan(effect.size)}

    @property
    def is_met(self) -> bool:
        """Whether the known effects that are left out or cannot be modelled are within the tolerance."""
        return self.model_error + self.beyond_models <= self.tolerance

    @property
    def _plain(self) -> str:
        """Name of the beam without the included effects, with which times are compared, for messages."""
        is_curved = self.physics.large_deflection and "large deflection" not in self.included
        return "the curved beam in space" if is_curved else "the plain beam"

    def sentence(self) -> str:
        """Summarize in one line which effects were included, with size and cost, and which were not."""
        included = [_say_included(effect) for effect in self.effects if effect.included]
        several = len(included) > 1 and not math.isnan(self.time)
        cost = f"; in all {self.time:.2g} times the time of {self._plain}" if several else ""
        return f'physics "auto", tolerance {self.tolerance:g}: {", ".join(included) or self._plain}{cost}'

    def warnings(self) -> Iterator[Statement]:
        """Yield a warning if the tolerance is not met, or if it is not known whether it is met."""
        large = [e for e in self.effects if not e.included and e.reason and e.size > self.tolerance / 2]
        each = (Words(f"the effect of {e.name}, left out, is {_say_size(e.size)}: ", e.reason) for e in large)
        if not self.is_met:
            left_out = f"the effects left out amount to {_say_size(self.model_error)}"
            beyond = (
                "errors of the theories included, largest for short thick beams, and strain by "
                f"rotation may change the answer by {_say_size(self.beyond_models)} more"
            )
            named = Words(left_out, ": ", joined("; ", each)) if large else left_out
            parts = (named, self.model_error), (beyond, self.beyond_models)
            yield Statement(
                f"physics = auto: the tolerance {self.tolerance:g} is not met: ",
                joined("; ", (text for text, share in parts if share > _WORTH_SAYING * self.tolerance)),
                kind=TOLERANCE,
                quantity="model error",
                value=self.model_error + self.beyond_models,
                limit=self.tolerance,
            )
        if self.not_known:
            each = (Words(f"{name} (", why, ")") for name, why in self.not_known.items())
            said = "physics = auto: left out, as not known: ", joined("; ", each)
            yield Statement(*said, kind=TOLERANCE, quantity="model error", limit=self.tolerance)


def _say_included(effect: JudgedEffect) -> str:
    more = f"{effect.coordinates:.2g}"
    coordinates = "as many coordinates" if more == "1" else f"{more} times the coordinates"
    cost = f"; {effect.time:.2g} times the time, {coordinates}"
    return f"{effect.name} ({_say_size(effect.size)}{'' if math.isnan(effect.time) else cost})"


def _say_size(size: float) -> str:
    if math.isnan(size):
        return "an unknown change"
    return "another answer" if math.isinf(size) else percent(size)


class OfChosenPhysics(Result):
    """Base class of results of a scene whose physics may have been chosen automatically; see `Result`."""

    scene: Any

    @property
    def physics_choice(self) -> PhysicsChoice | None:
        """How the physics was chosen, where it was "auto"; None where it was given."""
        return self.scene.physics_choice

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to numbers, lists and strings, with the choice of physics if there was one."""
        choice = self.physics_choice
        return super().to_dict() | ({} if choice is None else {"physics_choice": plain(choice)})


# Large deflection that the beam requires ---------------------------------------------------------------


def needing_large_deflection(beam: Beam) -> list[str]:
    """Return the names of the properties of a beam that need large deflection: a curved axis, matrices."""
    needing = [name for name in ("sweep", "prebend") if beam.is_curved and getattr(beam, name) is not None]
    return needing if beam.matrices is None else [*needing, "matrices"]


def how_without_large_deflection(beam: Beam, chosen: bool = False) -> str:
    """Say how to do without large deflection; `chosen`: physics "auto" has chosen it, or would."""
    needing = needing_large_deflection(beam)
    if not needing:
        return "leave large_deflection out where the deflection is small"
    without = f"describe the beam without {' and '.join(needing)}"
    return without if chosen else f"leave large_deflection out, and {without}"


# Physics that tip loads and springs require ------------------------------------------------------------

ROOT_SPRINGS = "root_stiffness", "second_root_stiffness"
_ALONG = 1e-12  # fraction of the load out of the plane of bending that counts as rounding error
# Largest spring stiffness at the root, divided by EI/L: rounding hides the rotation of a stiffer one.
_STIFFEST = 1e16
# Largest spring stiffness along the beam, divided by EI/L^3: above, rounding hides the spring's deflection.
_STIFFEST_POINT = 1e9


def check_tip_load(load: TipLoad, mount: Mount, physics: Physics | AutomaticPhysics) -> None:
    """Refuse a tip load without large deflection, and one in a direction in which the beam is rigid."""
    if not load.acts:
        return
    if not physics.large_deflection:
        bound = "a load at the tip changes the shape about which a beam vibrates"
        remedy = Words(Setting("physics", large_deflection=True), " models it")
        raise InvalidValue("physics.large_deflection", False, bound, remedy)
    if physics.planes == 2:
        return
    c, s = aligned_cos_sin(mount.bending_angle)
    (_, *force), (turning, *moment) = load.force, load.moment
    across = [c * force[1] - s * force[0], c * moment[0] + s * moment[1], 0.0 if physics.torsion else turning]
    if max(map(abs, across)) > _ALONG * max(map(abs, (*load.force, *load.moment))):
        bound = "the load at the tip acts out of the one plane in which the beam bends, where it is rigid"
        raise InvalidValue("physics.planes", 1, bound, Words("give ", Setting("physics", planes=2)))


def check_root_springs(mount: Mount, beam: Beam) -> None:
    """Refuse root springs so stiff that rounding hides the stiffness of the beam."""
    bending = [EI for EI in (beam.bending_stiffness, beam.second_bending_stiffness) if EI is not None]
    for name, spring in zip(ROOT_SPRINGS, mount.root_stiffnesses, strict=True):
        modelled = name == "root_stiffness" or beam.second_bending_stiffness is not None
        if modelled and spring < math.inf and spring > 0:
            stiffest = _STIFFEST * max(map(mean, bending)) / beam.length
            bound = "it must be at most {limit}, 1e16 EI/L of the beam: above, rounding hides the rotation"
            remedy = "leave it out: the root is clamped"
            refuse(spring > stiffest, f"mount.{name}", spring, "N m/rad", bound, remedy, limit=stiffest)


def check_point_springs(beam: Beam, physics: Physics | AutomaticPhysics) -> None:
    """Refuse point springs whose deflection is within rounding, and springs in a rigid direction."""
    for k, spring in enumerate(beam.point_springs):
        stiffest = _STIFFEST_POINT * mean(beam.bending_stiffness) / beam.length**3
        bound = "it must be at most {limit}, 1e9 EI/L^3 of the beam"
        name = f"point_springs[{k}].stiffness"
        refuse(spring.stiffness > stiffest, name, spring.stiffness, "N/m", bound, "soften it", limit=stiffest)
        if spring.direction == ACROSS and physics.planes == 1:
            bound = "a beam of one plane is rigid in this direction"
            remedy = Words("give ", Setting("physics", planes=2))
            raise InvalidValue(f"point_springs[{k}].direction", ACROSS, bound, remedy)
