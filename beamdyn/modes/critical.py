"""Critical speed: the lowest speed at which the stiffness matrix of the straight beam is singular."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from time import perf_counter

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, within
from beamdyn.common.results.one_line import error_at_most
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.results.statements import (
    INPUT,
    NO_ANSWER,
    OUTSIDE,
    TOLERANCE,
    Speeds,
    Statement,
    announce,
    kind_of,
)
from beamdyn.common.words import Named, Words
from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.equations.ritz import Ritz
from beamdyn.modes import critical_search
from beamdyn.modes.bounds import bound_critical_speed
from beamdyn.modes.buckling import Buckling, decide_buckling
from beamdyn.modes.modal.discretization_choice import (
    DEFAULT_TARGET,
    PLATE_TARGET,
    TOLERANCES,
    DiscretizationChoice,
    affordable_target,
    check_discretization,
    warn_of_missed_tolerance,
)
from beamdyn.modes.modal.error_estimate import UNRESOLVED
from beamdyn.modes.modal.model import Model, bends, static_load
from beamdyn.modes.model_error.added_effects import list_effects
from beamdyn.modes.model_error.effect_choice import PHYSICS_TOLERANCE, EffectSizes, choose_by
from beamdyn.modes.model_error.left_out_changes import left_out_of_critical_speed, nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.model_error.sharp_bending import warn_of_sharp_bending
from beamdyn.modes.planes import separate_planes
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import LARGE_STRAIN, warn_of_left_out

_BENT = Words(
    "rotation bends the beam from rest on, so that it does not buckle; ",
    Named("equilibrium_branches", "beamdyn branches"),
    " finds where its equilibrium turns back",
)
_LOST = "at this speed the beam that {} has no stiffness against further bending or twisting"
_KEPT = "the beam that {} was followed up to the largest speed tried, and stays stable"
_UNCONFIRMED = "no second model confirms that the beam stays stable: a finer one may lose stability"
_USUAL_OF_BENT = 1e-5  # relative error of a bent beam's critical speed above which a warning is given
# Number of functions of a model that only determines whether rotation loads the beam transversely.
_FUNCTIONS = 5


@dataclass(frozen=True)
class CriticalPoint(SceneResult, StatesModelError):
    """Critical speed, at which the stiffness of the rotating beam is singular, with its error.

    `error` is the numerical error.  `left_out` contains the estimated relative change of the critical speed
    by each neglected physical effect, `model_error` the magnitude of the sum of these changes; both are
    computed at first use.

    Parameters
    ----------
    speed : float
        Critical speed [rad/s]; inf if there is none, or if none was found (see `none_below`); 0 if the beam
        is unstable about a hinge at every speed.
    error : float
        Estimated relative error of the speed; 0 if a theoretical argument decides, or if two models in turn
        show that a bent beam stays stable; inf if it is unresolved.
    none_below : float
        No critical speed is below this value [rad/s]: `speed` itself if it was found, otherwise a guaranteed
        bound, or inf if there is none.  With an error of 0, only the inertia of tilting sections can buckle
        the beam above this bound, far outside linear theory.  If rotation bends the beam in space, its
        equilibria were computed up to this speed, which is no bound where the error is inf.
    reason : str
        Why there is a critical speed or none, or why this is not known.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.
    of_bent_beam : bool
        Whether rotation or a tip load bends the beam before it loses stability.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> point = bd.critical_point(bd.Scene(strip, bd.Mount(radius=0.215, setting_angle=np.pi)))
    >>> point.speed
    inf
    """

    speed: float
    error: float
    none_below: float
    reason: str
    model: Model | None = field(repr=False)
    of_bent_beam: bool = field(default=False, metadata=ADDED_LATER)

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the critical speed; see `Result.headline`."""
        if np.isfinite(self.speed):
            yield self.say_speed(self.speed)
            yield error_at_most(self.error)
        else:
            bounded = np.isfinite(self.none_below)
            below = "found up to" if self.of_bent_beam and self.error else "below"
            yield f"none {below} {self.say_speed(self.none_below)}" if bounded else "none"
        yield self.reason

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Changes of the critical speed by each neglected effect, of shape ()."""
        if self.of_bent_beam and np.isfinite(self.speed):
            return nothing_known(self.scene, "not computed for a beam that bends before it loses stability")
        if self.model is None or not (0 < self.speed < np.inf and np.isfinite(self.error)):
            return nothing_known(self.scene)
        return left_out_of_critical_speed(self.model, self.speed)


def critical_speed(
    scene: Scene, discretization: DiscretizationChoice = "ritz", tolerance: float | None = None
) -> float:
    """Compute the critical speed [rad/s], at which the first frequency vanishes; inf if there is none.

    A warning is issued if a critical speed may exist although none was found, if the error is large, or if
    rotation bends the beam at every speed, so that it does not buckle like a straight beam.  `critical_point`
    also returns the error and the model error.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`; a warning is issued if it is not met.

    Returns
    -------
    float

    References
    ----------
    As `critical_point`: Lee and Yoo (2019), section 4.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> round(bd.critical_speed(bd.Scene(strip, bd.Mount(radius=0.215))), 6)  # rad/s
    159.818333
    >>> outward = bd.Mount(radius=0.215, setting_angle=np.pi)
    >>> bd.critical_speed(bd.Scene(strip, outward))  # there is none
    inf
    """
    point = critical_point(scene, discretization, tolerance)
    announce(point.warnings)
    for text in point.warnings:
        if kind_of(text) != OUTSIDE:
            warnings.warn(text, stacklevel=2)
    return point.speed


def critical_point(
    scene: Scene, discretization: DiscretizationChoice = "ritz", tolerance: float | None = None
) -> CriticalPoint:
    """Compute the critical speed, the lowest speed omega with a singular stiffness K0 + omega^2 K2.

    A theoretical argument first decides whether a critical speed exists (`beamdyn.modes.buckling`).  If so,
    it is searched with finer and finer discretizations, because the buckling mode may be a short bend at the
    tip; if none is found, guaranteed bounds state up to which speed there is none.

    If rotation bends the beam in space at every speed, the critical speed is the one at which the
    equilibrium, continued from rest, loses stability: a deep section buckles sideways, or the equilibrium
    branch turns back (limit point).  The same holds with a tip load of fixed direction; a load that may cause
    flutter is refused.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`.

    Returns
    -------
    CriticalPoint

    References
    ----------
    Lee and Yoo (2019), section 4: the speed at which the stiffness K0 + omega^2 K2 is singular (standard,
    Euler's criterion).

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> point = bd.critical_point(bd.Scene(strip, bd.Mount(radius=0.215)))
    >>> round(point.speed, 6), point.error < 1e-9
    (159.818333, True)
    """
    start = perf_counter()
    check_scene(scene)
    if scene.chooses_physics:
        find = partial(critical_point, discretization=discretization, tolerance=tolerance)
        return _find_with_chosen_physics(scene, find, PHYSICS_TOLERANCE if tolerance is None else tolerance)
    target = DEFAULT_TARGET if tolerance is None else within("tolerance", tolerance, *TOLERANCES)
    check_discretization(discretization)
    if scene.tip_load.acts:
        _refuse_without_potential(scene)
        return _of_bent_beam(scene, discretization, target, tolerance, start)
    if scene.physics.large_deflection and _is_loaded_across(scene):
        if scene.bends_in_space:
            return _of_bent_beam(scene, discretization, target, tolerance, start)
        return _argued(scene, Buckling(False, _BENT), start)
    # Large deflection does not change the speed at which a straight beam buckles.
    return _of_straight_beam(scene.straightened, discretization, target, tolerance, start)


def _of_straight_beam(
    scene: Scene, discretization: DiscretizationChoice, target: float, tolerance: float | None, start: float
) -> CriticalPoint:
    """Find the critical speed of a straight beam, by theory or a search.

    `start` is the time at which the computation began, by `time.perf_counter` [s].
    """
    target = affordable_target(scene, discretization, target)
    models = partial(critical_search.models_of_critical_speed, target=target, cheapest=tolerance is not None)
    first, buckling = models(scene, discretization), decide_buckling(scene)
    if buckling.speed == np.inf and _is_within_theory(next(models(scene, "ritz"))):
        # The theoretical argument, which uses only the strain's order of magnitude, excluded buckling below
        # 1 % strain.  But a model shows such buckling, so that its speed is searched.
        buckling = replace(buckling, speed=None)
    # A speed of buckling by bending is searched unless theory has excluded it or already gives the speed.
    sought = buckling.exists is not False and buckling.speed is None
    if buckling.speed == 0 or (not sought and not scene.physics.stretch):
        return _argued(scene, buckling, start)
    found, reason = critical_search.search_critical_speed(first, target), buckling.why
    if np.isinf(found.error) and discretization == "fem":
        found = critical_search.search_critical_speed(models(scene, "ritz"), target)
    if scene.physics.stretch:
        without = replace(scene, physics=replace(scene.physics, stretch=False))
        bending = (
            critical_search.search_critical_speed(models(without, discretization), target) if sought else None
        )
        if bending is not None and _is_lower(bending, found):
            found = bending
        else:
            reason = "the rotation softens the stretch by more than the axial stiffness"
    none_below = found.speed  # replaced by a guaranteed bound if the error is unresolved
    if np.isinf(found.error):
        by_plane = () if scene.physics.stretch else map(bound_critical_speed, separate_planes(scene))
        none_below = min(by_plane, default=0.0 if scene.physics.stretch else buckling.none_below)
    return CriticalPoint(
        speed=found.speed,
        error=found.error,
        none_below=none_below,
        reason=reason,
        warnings=(*_warnings(scene, found, buckling, none_below, discretization, tolerance),),
        provenance=_made_by(found, start),
        scene=scene,
        model=found.model,
    )


def _is_lower(bending: critical_search.FoundSpeed, found: critical_search.FoundSpeed) -> bool:
    """Return whether bending alone is critical at a speed no higher than that found with stretch.

    `bending` was computed without stretch, `found` with it.  The basis that resolves stretch may miss the
    critical speed of bending.
    """
    same = min(bending.error + found.error, UNRESOLVED)
    return bool(np.isfinite(bending.speed)) and bending.speed <= found.speed * (1 + same)


def _made_by(found: critical_search.FoundSpeed, start: float) -> Provenance:
    """Build the provenance record of a search that began at the time `start`, by `perf_counter` [s]."""
    return Provenance.since(start, str(found.model.discretization), str(found.coarse.discretization))


def _of_bent_beam(
    scene: Scene, discretization: DiscretizationChoice, target: float, tolerance: float | None, start: float
) -> CriticalPoint:
    """Find the speed at which a beam that rotation bends at every speed loses stability."""
    target = affordable_target(scene, discretization, target)
    models = critical_search.models_of_critical_speed(scene, discretization, target, cheapest=True)
    found = critical_search.search_bent(models, target)
    loss, at = found.loss, Words("at ", Speeds(found.speed))
    curvature = partial(found.model.bent.curvature, loss.q[None])
    warnings = [*warn_of_left_out(scene), *warn_of_sharp_bending(scene, curvature, lambda _: at)]
    if loss.is_lost:
        warnings += _warn_of_error(found.error, tolerance, _USUAL_OF_BENT)
    elif found.error:
        warnings.append(Statement(_UNCONFIRMED, kind=NO_ANSWER))
    bending = "its load bends or compresses" if scene.tip_load.acts else "rotation bends"
    return CriticalPoint(
        speed=found.speed if loss.is_lost else np.inf,
        error=found.error,
        none_below=found.speed,
        reason=(_LOST if loss.is_lost else _KEPT).format(bending),
        warnings=tuple(warnings),
        provenance=_made_by(found, start),
        scene=scene,
        model=None,
        of_bent_beam=True,
    )


def _is_loaded_across(scene: Scene) -> bool:
    """Return whether rotation bends the beam at every speed, in a modelled direction."""
    if scene.beam.is_curved:
        return True
    in_plane = 1.0 if scene.physics.planes == 2 else aligned_cos_sin(scene.mount.bending_angle)[0]
    return bool(scene.mount.radius * aligned_cos_sin(scene.mount.setting_angle)[1] * in_plane)


def _refuse_without_potential(scene: Scene) -> None:
    """Raise an error for a tip load that may cause flutter, which a singular stiffness does not show."""
    if scene.may_flutter_by_load:
        name = "follows" if scene.tip_load.follows else "moment"
        bound = "a load without potential may cause flutter, although the stiffness is not singular"
        remedy = "look where a growth rate of natural_modes or frequency_locus becomes positive"
        raise InvalidValue(f"tip_load.{name}", getattr(scene.tip_load, name), bound, remedy)


def _is_within_theory(model: Model) -> bool:
    """Return whether a model resolves its critical speed, with an axial strain (if known) below 1 %."""
    found = critical_search.compare_critical_speeds(model)
    if np.isinf(found.error):
        return False
    _, strain = static_load(model, np.array([found.speed]))
    return not strain[0] > LARGE_STRAIN  # True if the strain is nan: the axial stiffness is not known


def _argued(scene: Scene, buckling: Buckling, start: float) -> CriticalPoint:
    """Build the critical point that follows from theory alone.

    `start` is the time at which the computation began, by `time.perf_counter` [s].
    """
    speed = np.inf if buckling.speed is None else buckling.speed
    return CriticalPoint(
        speed=speed,
        error=0.0,
        none_below=buckling.none_below or speed,
        reason=buckling.why,
        warnings=tuple(warn_of_left_out(scene)),
        provenance=Provenance.since(start, "an argument", "nothing"),
        scene=scene,
        model=None,
    )


def _warnings(
    scene: Scene,
    found: critical_search.FoundSpeed,
    buckling: Buckling,
    none_below: float,
    discretization: DiscretizationChoice,
    tolerance: float | None,
) -> Iterator[str]:
    """Yield warnings about a critical speed that was found, or about a search without result."""
    yield from warn_of_left_out(scene)
    if discretization == "fem" and found.model.discretization.order is None:
        said = f"finite elements do not resolve the critical speed; {found.model.discretization} is used"
        yield Statement(said, kind=INPUT, quantity="discretization")
    if np.isinf(found.speed):
        unknown = "whether there is a critical speed is unknown"
        exists = "a critical speed exists" if buckling.exists else unknown
        said = f"{exists} ({buckling.why}), but {found.model.discretization} finds none: "
        yield Statement(said, "there is certainly none below ", Speeds(none_below, digits=4), kind=NO_ANSWER)
        return
    yield from _warn_of_error(found.error, tolerance, PLATE_TARGET if scene.models_width else 1e-6)
    if _is_loaded_across(scene):  # the beam bends far before it reaches the critical speed
        said = "rotation bends the beam at every speed, so that it does not buckle as a straight one does: "
        yield Statement(said, Speeds(found.speed), f" is {OUTSIDE}", kind=OUTSIDE)


def _warn_of_error(error: float, tolerance: float | None, usual: float) -> Iterator[Statement]:
    """Yield a warning if the relative error exceeds the tolerance or, without one, the usual error."""
    if tolerance is not None:
        yield from warn_of_missed_tolerance(error, tolerance)
    elif error > usual:
        said = f"the estimated relative error of the critical speed is {error:.1g}"
        yield Statement(said, kind=TOLERANCE, quantity="estimated relative error", value=error, limit=usual)


# Choice of the physical effects ---------------------------------------------------------------------


def _find_with_chosen_physics(
    scene: Scene, find: Callable[[Scene], CriticalPoint], tolerance: float
) -> CriticalPoint:
    """Find a critical point with the effects that change it by more than the tolerance.

    Each effect is judged by the critical speed computed with it, as a second plane may buckle although the
    first does not.
    """

    def judge(candidate: Scene) -> EffectSizes:
        known = find(candidate)
        additions, not_known, _ = list_effects(candidate)
        sizes = {added.name: _change(known, find(added.scene)) for added in additions}
        assumed = {added.name: f"it is estimated {added.assumed}" for added in additions if added.assumed}
        # A beam that rotation bends at every speed does not buckle: the effect counts as infinite.
        sizes[LARGE_DEFLECTION.name] = math.inf if bends(Model(candidate, Ritz(_FUNCTIONS))) else 0.0
        lost = "its critical speed is not resolved"
        unresolved = {name: lost for name, size in sizes.items() if math.isnan(size)}
        return EffectSizes(sizes | dict.fromkeys(not_known, math.nan), unresolved | assumed | not_known)

    def count(candidate: Scene) -> int:
        found = find(candidate).model
        return 1 if found is None else found.solver.size

    chosen = choose_by(scene, judge, count, tolerance, np.array([]))
    return replace(find(chosen), scene=chosen)


def _change(without: CriticalPoint, within: CriticalPoint) -> float:
    """Compute the relative change of a critical speed by an effect, from the speeds without and with it.

    It is inf if a critical speed exists only with, or only without the effect, and nan if one is unresolved.
    """
    if math.isinf(without.error) or math.isinf(within.error):
        return math.nan
    if without.speed == within.speed:
        return 0.0
    return abs(within.speed / without.speed - 1) if without.speed and without.speed < math.inf else math.inf
