"""Critical speed: the lowest at which the stiffness of the straight beam is singular."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from time import perf_counter

import numpy as np

from beamdyn._version import __version__
from beamdyn.accuracy.refinement import refine
from beamdyn.common.inputs.checks import within
from beamdyn.common.results.announced import announce
from beamdyn.common.results.one_line import error_at_most
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import INPUT, NO_ANSWER, OUTSIDE, TOLERANCE, Speeds, Statement, kind_of
from beamdyn.modes.bounds import bound_critical_speed
from beamdyn.modes.buckling import Buckling, decide_buckling
from beamdyn.modes.critical_physics import find_with_chosen_physics
from beamdyn.modes.modal.discretization_choice import (
    DEFAULT_TARGET,
    FEM_TARGET,
    TOLERANCES,
    DiscretizationChoice,
    check_discretization,
    list_models,
    split_tip,
    warn_of_missed_tolerance,
)
from beamdyn.modes.modal.error_estimate import (
    UNRESOLVED,
    extrapolation_error,
    is_halved,
)
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.static_load import static_load
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.model_error.of_modes import left_out_of_critical_speed, nothing_known
from beamdyn.modes.planes import separate_planes
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import LARGE_STRAIN

_BENT = (
    "rotation bends the beam from rest on, so that it does not buckle; equilibrium_branches finds where its "
    "equilibrium turns back"
)
_SIZED_FOR = 5  # modes that suit the first basis, so that a basis of half its size usually suits, too
_NEAR_TIP = 0.5  # x/L beyond which the deflection is so large that rounding of short elements shows
_OF_SHORTEST = 4 * float(np.finfo(float).eps)  # rounding error times the cube of an element's length over L
_TO_HALF = 4  # steps from a basis to one of about half its size


@dataclass(frozen=True)
class CriticalPoint(StatesModelError):
    """Critical speed, at which the stiffness of the rotating beam is singular, with its error.

    `error` is that of the number; `model_error` and `left_out`, computed when asked for, are what the physics
    left out would change in a speed that was found.

    Parameters
    ----------
    speed : float
        Critical speed [rad/s]; inf if there is none, or if none was found: `none_below` says which; 0 if the
        rotation turns the beam about a hinge at every speed.
    error : float
        Its estimated relative error; 0 where an argument decides, inf if it is unresolved.
    none_below : float
        No critical speed lies below this [rad/s]: `speed` itself where it was found, a guaranteed bound
        where not, inf if there is none.  With an error of 0, only the inertia of tilting sections can
        buckle the beam past this bound, where linear theory has long ended.
    reason : str
        Why there is a critical speed, or none, or why that is not known.
    warnings : tuple of str
        What limits the answer.
    provenance : Provenance
        How it was found.

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
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)
    model: Model | None = field(repr=False)

    def headline(self) -> Iterator[str]:
        """The critical speed and its error, or that there is none, in one line; see `Result.headline`."""
        found = np.isfinite(self.speed)
        yield self.say_speed(self.speed) if found else f"none below {self.say_speed(self.none_below)}"
        yield error_at_most(self.error) if found else ""
        yield self.reason

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Changes of the critical speed by effects that the model leaves out, of shape ()."""
        if self.model is None or not (0 < self.speed < np.inf and np.isfinite(self.error)):
            return nothing_known(self.scene)
        return left_out_of_critical_speed(self.model, self.speed)


def critical_speed(
    scene: Scene, discretization: DiscretizationChoice = "ritz", tolerance: float | None = None
) -> float:
    """Compute the critical speed [rad/s], at which the first frequency vanishes; inf if there is none.

    A warning is issued if there may be one where none was found, if its error is large, or if rotation bends
    the beam at every speed, so that it does not buckle as a straight one does.  `critical_point` gives the
    same with its error and its model error.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`; a warning is issued if it cannot be kept.

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
    """Compute the critical speed and its error: the lowest with a singular stiffness K0 + omega^2 K2.

    Whether there is one is decided first, by an argument (`beamdyn.modes.buckling`).  If there is, it is
    sought with finer and finer discretizations, because it may belong to a short bend at the tip; if these
    end without one, guaranteed bounds say up to which speed there is none.

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
        return find_with_chosen_physics(scene, find, tolerance)
    target = DEFAULT_TARGET if tolerance is None else within("tolerance", tolerance, *TOLERANCES)
    check_discretization(discretization)
    if _bends_from_rest(scene):
        return _argued(scene, Buckling(False, _BENT), start)
    scene = _about_straight_beam(scene)
    target = max(target, FEM_TARGET) if discretization == "fem" else target
    models = partial(_list_models, target=target, cheapest=tolerance is not None)
    first, buckling = models(scene, discretization), decide_buckling(scene)
    if buckling.speed == np.inf and _is_within_theory(next(models(scene, "ritz"))):
        buckling = replace(buckling, speed=None)  # sections so heavy that a long bend topples
    if buckling.speed == 0 or (not _can_be_sought(buckling) and not scene.physics.stretch):
        return _argued(scene, buckling, start)
    found, reason = _search(first, target), buckling.why
    if np.isinf(found.error) and discretization == "fem":
        found = _search(models(scene, "ritz"), target)
    if scene.physics.stretch:
        without_stretch = models(_without_stretch(scene), discretization)
        found, reason = _compare_with_bending(found, without_stretch, buckling, target)
    none_below = _none_below(scene, found, buckling)
    names = str(found.model.discretization), str(found.coarse.discretization)
    return CriticalPoint(
        speed=found.speed,
        error=found.error,
        none_below=none_below,
        reason=reason,
        warnings=(
            *_critical_warnings(found, buckling, none_below, discretization, tolerance),
            *_warn_of_bending(scene, found.speed),
        ),
        provenance=Provenance(__version__, *names, perf_counter() - start),
        scene=scene,
        model=found.model,
    )


def _bends_from_rest(scene: Scene) -> bool:
    """Whether large deflection is modelled, and rotation bends the beam at every speed."""
    return scene.physics.large_deflection and _is_loaded_across(scene)


def _is_loaded_across(scene: Scene) -> bool:
    """Whether rotation bends the beam at every speed, in a direction that is modelled."""
    in_plane = 1.0 if scene.physics.planes == 2 else aligned_cos_sin(scene.mount.bending_angle)[0]
    return bool(scene.mount.radius * aligned_cos_sin(scene.mount.setting_angle)[1] * in_plane)


def _about_straight_beam(scene: Scene) -> Scene:
    """The scene without large deflection, which does not change when a straight beam buckles."""
    return replace(scene, physics=replace(scene.physics, large_deflection=False, branch="straight"))


def _is_within_theory(model: Model) -> bool:
    """Whether a model resolves a critical speed, and nothing says that it stretches the beam by over 1 %."""
    found = _compare(model)
    if np.isinf(found.error):
        return False
    _, strain = static_load(model, np.array([found.speed]))
    return not strain[0] > LARGE_STRAIN  # nan: the axial stiffness is not known


def _can_be_sought(buckling: Buckling) -> bool:
    """Whether bending may have a critical speed within the reach of the theory."""
    return buckling.exists is not False and buckling.speed is None


def _argued(scene: Scene, buckling: Buckling, start: float) -> CriticalPoint:
    """The answer that follows from an argument alone."""
    provenance = Provenance(__version__, "an argument", "nothing", perf_counter() - start)
    speed = np.inf if buckling.speed is None else buckling.speed
    none_below = speed if not buckling.none_below else buckling.none_below
    return CriticalPoint(speed, 0.0, none_below, buckling.why, (), provenance, scene, None)


def _compare_with_bending(
    both: _Found, without_stretch: Iterator[Model], buckling: Buckling, target: float
) -> tuple[_Found, str]:
    """Choose the lower of the critical speeds of bending and stretch, and of bending alone; say why it is.

    A basis that resolves the stretch may not see that of bending.
    """
    if _can_be_sought(buckling):
        bending = _search(without_stretch, target)
        same = min(bending.error + both.error, UNRESOLVED)
        if np.isfinite(bending.speed) and bending.speed <= both.speed * (1 + same):
            return bending, buckling.why
    return both, "the rotation softens the stretch by more than the axial stiffness"


def _none_below(scene: Scene, found: _Found, buckling: Buckling) -> float:
    """Speed below which there is no critical one [rad/s]; it is bounded for a slender beam by planes."""
    if np.isfinite(found.error):
        return found.speed
    if scene.physics.stretch:
        return 0.0
    by_plane = (bound_critical_speed(plane) for plane in separate_planes(scene))
    return min(by_plane, default=buckling.none_below)


def _without_stretch(scene: Scene) -> Scene:
    return replace(scene, physics=replace(scene.physics, stretch=False))


def _list_models(
    scene: Scene, discretization: DiscretizationChoice, target: float, cheapest: bool
) -> Iterator[Model]:
    """List the models in which a critical speed is sought; see `list_models`."""
    named = isinstance(discretization, str)
    modes, split = (_SIZED_FOR, split_tip(scene)) if named else (1, scene)
    return list_models(split, discretization, modes, target, cheapest, split is not scene)


@dataclass(frozen=True)
class _Found:
    """Critical speed of a model [rad/s], its relative error by a coarser model, and rounding's part in it."""

    model: Model
    coarse: Model
    speed: float
    error: float
    rounding: float


def _search(models: Iterator[Model], target: float) -> _Found:
    """Refine until the error meets the target or rounding, or the models end."""

    def meets(found: _Found) -> bool:
        return bool(np.isfinite(found.speed)) and found.error <= max(target, 3 * found.rounding)

    compared = _compare_each(models)
    return refine(next(compared), lambda _: next(compared, None), meets)


def _compare_each(models: Iterator[Model]) -> Iterator[_Found]:
    """Compare each model with a coarser one, until rounding of so many functions leaves the last the best."""
    yield _compare(next(models))
    with suppress(np.linalg.LinAlgError):
        yield from map(_compare, models)


def _compare(model: Model) -> _Found:
    """Compare a model with one of about half its size.

    A basis that lacks a few functions only would differ too little where convergence is slow: where the error
    falls as a power p >= 1 of the size, it is at most the distance from the basis of half the size.
    """
    order, solver = model.discretization.order, model.solver
    coarse = model.coarser if order is not None else _halve(model)
    fine_softening, coarse_softening = solver.softening, coarse.solver.softening
    distance = fine_softening - coarse_softening
    softening = fine_softening if order is None else fine_softening + distance / (2**order - 1)
    if not 0 < softening < np.inf:  # False for nan, too
        return _Found(model, coarse, np.inf, np.inf, np.inf)
    rounding = solver.critical_rounding
    noise = rounding + _rounding_of_integrals(model)
    left = abs(distance)
    if order is not None:
        before = coarse_softening - _softening_of_half(coarse)
        left = float(extrapolation_error(*np.array([[distance], [before], [noise * softening]]))[0])
    error = left / (2 * softening) + noise
    resolved = error < UNRESOLVED and coarse.solver.size < solver.size  # the same functions say nothing
    error = float(error) if resolved else np.inf
    return _Found(model, coarse, float(softening**-0.5), error, rounding)


def _rounding_of_integrals(model: Model) -> float:
    """Relative rounding error of the integrals: of elements as the cube of the shortest near the tip."""
    if model.discretization.order is None:
        return model.discretization.rounding
    ends = model.discretization.cells(model.scene.modelled_beam).ends
    shortest = float(np.diff(ends)[ends[1:] > _NEAR_TIP].min())
    return max(model.discretization.rounding, _OF_SHORTEST * shortest**-3)


def _softening_of_half(model: Model) -> float:
    """Softening of a mesh of half the elements; nan where short segments keep it from being that."""
    half = model.coarser.solver
    return half.softening if is_halved(half, model.solver) else np.nan


def _halve(model: Model) -> Model:
    """The model with a basis of about half the size."""
    discretization = model.discretization
    for _ in range(_TO_HALF):
        discretization = discretization.coarser()
    return Model(model.scene, discretization)


def _critical_warnings(
    found: _Found,
    buckling: Buckling,
    none_below: float,
    discretization: DiscretizationChoice,
    tolerance: float | None,
) -> Iterator[str]:
    if discretization == "fem" and found.model.discretization.order is None:
        said = f"finite elements do not resolve the critical speed: sought with {found.model.discretization}"
        yield Statement(said, kind=INPUT, quantity="discretization")
    if np.isinf(found.speed):
        exists = (
            "a critical speed exists" if buckling.exists else "whether there is a critical speed is unknown"
        )
        said = f"{exists} ({buckling.why}), but {found.model.discretization} finds none: "
        yield Statement(said, "there is certainly none below ", Speeds(none_below, digits=4), kind=NO_ANSWER)
    elif tolerance is not None:
        yield from warn_of_missed_tolerance(found.error, tolerance)
    elif found.error > 1e-6:
        said = f"the estimated relative error of the critical speed is {found.error:.1g}"
        yield Statement(
            said, kind=TOLERANCE, quantity="estimated relative error", value=found.error, limit=1e-6
        )


def _warn_of_bending(scene: Scene, critical: float) -> Iterator[Statement]:
    """Yield a warning for a critical speed of a beam that has bent long before."""
    if np.isfinite(critical) and _is_loaded_across(scene):
        said = "rotation bends the beam at every speed, so that it does not buckle as a straight one does: "
        yield Statement(said, Speeds(critical), f" is {OUTSIDE}", kind=OUTSIDE)
