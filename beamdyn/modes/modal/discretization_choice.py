"""Choice of the smallest discretization that meets a given accuracy."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import TypeAlias

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.common.inputs.checks import InvalidValue, within
from beamdyn.common.results.statements import TOLERANCE, Statement
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.mass import steady_tension
from beamdyn.equations.ritz import MOST_FUNCTIONS, Ritz
from beamdyn.modes.modal.error_estimate import EstimatedModes, solve_with_error
from beamdyn.modes.modal.model import Model
from beamdyn.scene.beam import Beam
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import section_tensor

DEFAULT_TARGET = 1e-11  # default relative error of eigenvalues: two digits below the promised 1e-9
TOLERANCES = 1e-14, 0.1  # smallest and largest accepted tolerance
# Smallest target for moment bases, because the errors stated for them are some 30 times the true errors.
MOMENTS_TARGET = 1e-10
FEM_TARGET = 1e-7  # smallest target for finite elements, whose rounding error grows with their number
# Smallest targets for large deflection in space, with few segments and with many: functions are costly.
SPACE_TARGET, SEGMENTED_SPACE_TARGET = 1e-7, 1e-4
PLATE_TARGET = 1e-4  # smallest target for a strip as a plate, whose convergence is algebraic
_MOST_SEGMENTS = 200  # largest number of segments of a beam between its stations and breakpoints
# Largest number of Ritz functions on all segments together: their eigenproblem takes about a second.
_MOST_IN_ALL = 1000
# Largest number of segments of a beam for which trial functions that are polynomials on each segment are
# chosen.  With more segments, fewer functions suffice if their bending moments are polynomials along the
# whole beam.
_FEW_SEGMENTS = 6
# Number of modes per segment above which polynomials on each segment are chosen for more segments, too.
_MANY_ON_EACH = 2
# Number of functions of the basis "moments" in each direction, minus the number of modes: a constant, the
# number added per digit of accuracy (both found on published blades), and the smallest sum of the two.  With
# fewer functions, the stated error of a mode may be too small.  Twisted sections need fewer, because a moment
# in either direction bends them in both.
_IN_STRAIGHT, _IN_TWISTED = (6, 3.0, 13), (-1, 3.0, 10)
# Smallest number of elements on a segment: enough for a mesh with a quarter of them, the coarsest of three;
# and on a segment with a boundary layer: enough for a mesh with half of them to resolve the layer.
_ON_EACH, _ON_LAYERS = 4, 8
_SHORT = 0.02  # segment length x/L below which its quarters, as elements, would have large rounding errors
_OF_ELEMENTS = 0.1  # relative eigenvalue error for which finite elements choose the length of boundary layers
# Largest ratio of all further changes of a critical speed to its change by the next finer model.
_ALL_FURTHER = 2.0
_MANY = 10_000  # a number of modes that exceeds any discretization
_NAMES = "ritz", "fem"
# Smallest number of functions: with fewer, the coarser basis lacks only one, which may not affect a mode; and
# of plates: with fewer, it has as many of camber across the width, or one of torsion, where the second
# changes less than the third.
_FEWEST_FUNCTIONS, _FEWEST_OF_PLATES = 9, 7

DiscretizationChoice: TypeAlias = "str | Discretization"  # "ritz", "fem", or an instance


def solve_to_tolerance(
    scene: Scene,
    discretization: DiscretizationChoice,
    speeds: np.ndarray,
    modes: int,
    tolerance: float | None = None,
    extra: int = 0,
) -> EstimatedModes:
    """Solve the smallest model whose modes meet the tolerance at every speed.

    Without a tolerance, `choose_model` is called with `DEFAULT_TARGET`.  The other parameters are as for
    `choose_model` and `solve_with_error`.
    """
    target = DEFAULT_TARGET if tolerance is None else within("tolerance", tolerance, *TOLERANCES)
    model, at_ends = _choose(scene, discretization, speeds, modes, target, tolerance is not None)
    if at_ends is not None and len(speeds) == 1 and not extra:
        result = at_ends
    else:
        result = solve_with_error(model, speeds, modes, extra)
    if tolerance is None or not isinstance(discretization, str):
        return result
    finer = partial(_solve_finer, speeds=speeds, modes=modes, extra=extra)
    return refine(result, finer, lambda found: found.meet(target))


def _solve_finer(
    found: EstimatedModes, speeds: np.ndarray, modes: int, extra: int = 0
) -> EstimatedModes | None:
    """Compute the modes of the next finer model; None if there is none, or if it fails by rounding."""
    if (finer := refine_model(found.model)) is None:
        return None
    try:
        return solve_with_error(finer, speeds, modes, extra)
    except np.linalg.LinAlgError:
        return None


def warn_of_missed_tolerance(error: float, tolerance: float) -> Iterator[Statement]:
    """Yield a warning if the estimated error exceeds the tolerance."""
    if error > tolerance:
        yield Statement(
            f"tolerance = {tolerance:g} is not reached: the estimated relative error is {error:.1g}, "
            "and no larger model helps",
            kind=TOLERANCE,
            quantity="estimated relative error",
            value=error,
            limit=tolerance,
        )


def choose_model(
    scene: Scene,
    discretization: DiscretizationChoice,
    speeds: np.ndarray,
    modes: int,
    target: float = DEFAULT_TARGET,
) -> Model:
    """Find the smallest model whose estimated error meets a target at the slowest and fastest speed.

    Parameters
    ----------
    scene : Scene
        The scene.
    discretization : {"ritz", "fem"} or Discretization
        Kind of discretization, or an instance, which is used as it is.
    speeds : ndarray
        Speeds at which the model will be used [rad/s].
    modes : int
        Number of modes.
    target : float
        Required relative error of the eigenvalues; at least 1e-7 for finite elements.

    Returns
    -------
    Model

    Raises
    ------
    ValueError
        If the discretization is unknown or has too few functions for the modes, or the beam has too many
        segments.
    """
    return _choose(scene, discretization, speeds, modes, target, cheapest=False)[0]


def model_to_tolerance(
    scene: Scene,
    discretization: DiscretizationChoice,
    speeds: np.ndarray,
    modes: int,
    tolerance: float | None,
) -> Model:
    """Choose the model as `solve_to_tolerance` does or, without a tolerance, as `choose_model` does."""
    if tolerance is None:
        return choose_model(scene, discretization, speeds, modes)
    return solve_to_tolerance(scene, discretization, speeds, modes, tolerance).model


def _choose(
    scene: Scene,
    discretization: DiscretizationChoice,
    speeds: np.ndarray,
    modes: int,
    target: float,
    cheapest: bool,
) -> tuple[Model, EstimatedModes | None]:
    """Choose the model of `choose_model`; also return its modes at the slowest and fastest speed, if solved.

    `cheapest` starts with the smallest sensible model, instead of one that usually meets the default target.
    """
    check_discretization(discretization)
    ends = np.unique(np.abs(speeds))[[0, -1]] if len(speeds) > 1 else speeds
    target = affordable_target(scene, discretization, target)
    split = scene
    if isinstance(discretization, str):
        speed = float(np.abs(speeds).max(initial=0.0))
        split = split_layers(scene, speed, target if discretization == "ritz" else _OF_ELEMENTS)
    models = list_models(split, discretization, modes, target, cheapest, split is not scene)
    if not isinstance(discretization, str):
        return next(models), None
    # A model has fewer modes than functions if some functions are linear combinations of others.
    first = next(m for m in models if m.solver.size >= modes or refine_model(m) is None)
    if scene.physics.large_deflection and scene.physics.branch == "bent":
        first = _refine_until_buckled(first, float(ends[0]))
    reached = within_reach(first.discretization, target)
    at_ends = refine(
        solve_with_error(first, ends, modes),
        partial(_solve_finer, speeds=ends, modes=modes),
        lambda found: found.meet(reached),
    )
    return at_ends.model, at_ends


def _refine_until_buckled(model: Model, speed: float) -> Model:
    """Refine a model until its critical speed is at most `speed` [rad/s], or can no longer fall to it.

    The critical speed is that of the straight beam; it falls as the model is refined.
    """

    def finer(model: Model) -> Model | None:
        refined = refine_model(model)
        if refined is None:
            return None
        critical, lower = model.deflected.critical_speed, refined.deflected.critical_speed
        return refined if critical - speed < _ALL_FURTHER * (critical - lower) else None

    return refine(model, finer, lambda found: found.deflected.critical_speed <= speed)


def affordable_target(scene: Scene, discretization: DiscretizationChoice, target: float) -> float:
    """Raise the error target, if need be, to what elements, plates and beams in space reach at low cost."""
    if not isinstance(discretization, str):
        return target
    if scene.bends_in_space:
        target = max(
            target, SEGMENTED_SPACE_TARGET if count_segments(scene) > _FEW_SEGMENTS else SPACE_TARGET
        )
    return max(target, FEM_TARGET * (discretization == "fem"), PLATE_TARGET * scene.models_width)


def within_reach(discretization: Discretization, target: float) -> float:
    """Raise the error target, if need be, for moment bases, whose estimated errors are too large."""
    return target if discretization.converges_regularly else max(target, MOMENTS_TARGET)


def list_models(
    scene: Scene,
    discretization: DiscretizationChoice,
    modes: int,
    target: float,
    cheapest: bool,
    has_layers: bool = False,
) -> Iterator[Model]:
    """List the models to try, from the smallest sensible to the finest; a given instance is the only model.

    `cheapest` starts with the smallest sensible model, instead of one that usually meets the default target;
    `has_layers` states whether segments were added for boundary layers, which need several elements.  Other
    parameters and errors raised are as for `choose_model`.
    """
    segments = len(scene.modelled_beam.breakpoints) - 1
    if segments > _MOST_SEGMENTS:
        raise ValueError(
            f"the beam has {segments} segments between its stations and breakpoints: at most "
            f"{_MOST_SEGMENTS}; give fewer stations, or its properties as polynomials or functions of x/L"
        )
    if named := isinstance(discretization, str):
        first = _first_ritz if discretization == "ritz" else _first_fem
        smallest = first(scene, segments, modes, target, cheapest, has_layers)
        discretization = refine(smallest, lambda d: d.finer(), lambda d: _fits(d, modes, segments))
    if not _fits(discretization, modes, segments):
        most = _most_that_fit(discretization, modes, segments)
        bound = f"{discretization} gives at most {most} modes with an estimate of their error"
        raise InvalidValue("modes", modes, bound, "ask for fewer")
    model: Model | None = Model(scene, discretization)
    while model is not None:
        yield model
        model = refine_model(model) if named else None


def refine_model(model: Model) -> Model | None:
    """Build the next finer model; None if no affordable one is left."""
    finer = model.discretization.finer()
    if isinstance(finer, Ritz):  # finite elements have a separate limit
        segments = count_segments(model.scene) if finer.on_each_segment else 1
        across = 1 + finer.spaces(model.scene.modelled_beam).across if model.scene.models_width else 1
        finer = finer if finer.functions * segments * across <= _MOST_IN_ALL * min(across, 2) else None
    if finer is None:
        return None
    refined = Model(model.scene, finer)
    if refined.coarser.discretization == model.discretization:  # the coarser model has been built already
        refined.__dict__["coarser"] = model
    return refined


def count_segments(scene: Scene) -> int:
    """Count the segments of the beam between its stations and breakpoints."""
    return len(scene.modelled_beam.breakpoints) - 1


def _first_ritz(
    scene: Scene, segments: int, modes: int, target: float, cheapest: bool, has_layers: bool
) -> Discretization:
    """Choose a basis that usually meets the target, by a formula fitted to random scenes (`benchmarks`)."""
    if scene.models_width:
        fewest = int(np.ceil(2 + modes - np.log10(target)))
        return Ritz(min(max(_FEWEST_OF_PLATES, fewest), MOST_FUNCTIONS))
    if segments > _FEW_SEGMENTS and modes <= _MANY_ON_EACH * segments:
        coupled = (0, 1) in section_tensor(scene.modelled_beam, "bending_stiffness")
        least, per_digit, fewest = _IN_TWISTED if coupled else _IN_STRAIGHT
        digits = -np.log10(max(target, MOMENTS_TARGET))
        return Ritz(modes + max(fewest, int(least + per_digit * digits)), "moments")
    fewest = _FEWEST_FUNCTIONS if segments == 1 and cheapest else 5
    total = int(np.ceil(4 + 1.3 * modes - np.log10(target))) if cheapest else 10 + 2 * modes
    return Ritz(min(max(fewest, -(-total // segments)), MOST_FUNCTIONS))


def _first_fem(
    scene: Scene, segments: int, modes: int, target: float, cheapest: bool, has_layers: bool
) -> Discretization:
    """Choose a mesh with enough elements per segment; segments added for boundary layers need several."""
    # The import is inside the function because scikit-fem is slow to import.
    from beamdyn.equations.fem import MOST_ELEMENTS, MOST_REFINED, Fem

    least = min(16 * segments, MOST_REFINED) if cheapest else 80
    has_short = np.diff(scene.modelled_beam.breakpoints).min() < _SHORT
    on_each = _ON_LAYERS if has_layers else _ON_EACH // 2 if has_short else _ON_EACH
    return Fem(min(max(least, on_each * segments, 4 * modes), MOST_ELEMENTS), on_each=on_each)


def ensure_size(scene: Scene, discretization: DiscretizationChoice, modes: int) -> DiscretizationChoice:
    """Replace a discretization that has too few functions for the modes of a scene by "ritz"."""
    segments = count_segments(scene)
    fits = isinstance(discretization, str) or _fits(discretization, modes, segments)
    return discretization if fits else "ritz"


def most_modes(scene: Scene, discretization: DiscretizationChoice, modes: int) -> int:
    """Limit a number of modes to those that a given discretization can compute, at least 1."""
    if isinstance(discretization, str):
        return modes
    check_discretization(discretization)
    return max(1, _most_that_fit(discretization, modes, count_segments(scene)))


def _most_that_fit(discretization: Discretization, modes: int, segments: int) -> int:
    """Find the largest number up to `modes` for which a discretization has enough functions."""
    if _fits(discretization, modes, segments):
        return modes
    fewer = range(1, min(modes, _MANY))
    return bisect_left(fewer, True, key=lambda n: not _fits(discretization, n, segments))


def _fits(discretization: Discretization, modes: int, segments: int) -> bool:
    """Return whether a discretization has enough functions for `modes` modes on a number of segments."""
    on_each = segments > 1 and isinstance(discretization, Ritz) and discretization.on_each_segment
    return discretization.fits(-(-modes // segments) if on_each else modes)


def check_discretization(discretization: object) -> None:
    """Raise an error for an argument that is neither a discretization nor the name of one."""
    named = isinstance(discretization, str) and discretization in _NAMES
    if not named and (isinstance(discretization, str | type) or not hasattr(discretization, "spaces")):
        bound = f"give {', '.join(map(repr, _NAMES))}, a beamdyn.Ritz or a beamdyn.Fem"
        raise InvalidValue("discretization", discretization, bound)


# Length of a boundary layer in decay lengths: this number, minus half the logarithm of the allowed relative
# error of an eigenvalue.
_LENGTHS = 5.0
# Longest boundary layers at the root and at the tip, divided by the length, that get separate functions.
_SHORT_AT_ROOT, _SHORT_AT_TIP = 0.1, 0.4
_SHORTEST = 1e-4  # length of the shortest boundary layer, over the length of the beam
# Breakpoints x/L added near the tip to resolve a boundary layer when the speed, on which its length depends,
# is not known.
_TOWARD_TIP = (0.7, 0.95, 0.992)


def split_layers(scene: Scene, speed: float, target: float) -> Scene:
    """Add breakpoints at the ends of the boundary layers at a speed [rad/s], if the layers are short.

    The part of a layer beyond its breakpoint changes an eigenvalue by less than the target.
    """
    if not speed:
        return scene
    beam, decay_lengths = scene.modelled_beam, (_LENGTHS - math.log(target) / 2) / speed
    tension = steady_tension(beam, scene.mount)[[0, -1]].tolist()
    # Decay lengths are (EI/N)^(1/2) with the tension N; inf without tension.
    root, tip = (
        decay_lengths * (math.sqrt(EI / N) / beam.length) if N > 0 else math.inf
        for EI, N in zip(_stiffness_of_ends(beam), tension, strict=True)
    )
    places = [max(root, _SHORTEST)] if root < _SHORT_AT_ROOT else []
    if scene.beam.tip is not None and tip < _SHORT_AT_TIP:
        places.append(1 - max(tip, _SHORTEST))
    return _split(scene, places) if places else scene


@lru_cache(maxsize=64)
def _stiffness_of_ends(beam: Beam) -> list[float]:
    """Compute the smaller of the two bending stiffnesses [N m2], at the root and at the tip."""
    profiles = (beam.bending_stiffness, beam.second_bending_stiffness)
    return np.min([each(np.array([0.0, 1.0])) for each in profiles if each is not None], axis=0).tolist()


def split_tip(scene: Scene) -> Scene:
    """Add breakpoints that resolve a boundary layer at the tip at any speed, if tension causes one."""
    beam = scene.beam
    has_layer = beam.tip is not None and steady_tension(beam, scene.mount)[-1] > 0
    return _split(scene, _TOWARD_TIP) if has_layer else scene


def _split(scene: Scene, places: Sequence[float]) -> Scene:
    """Return the scene with additional breakpoints x/L in its beam."""
    mass = scene.beam.mass_per_length.split((0.0, *places, 1.0))
    return replace(scene, beam=replace(scene.beam, mass_per_length=mass))
