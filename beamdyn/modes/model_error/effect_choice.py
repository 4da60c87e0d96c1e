"""Automatic choice of the physics: the effects that a result needs in order to meet a tolerance.

The size of an effect is the relative change that it causes.  Sizes are estimated for the plain beam, an
Euler-Bernoulli beam that bends in one plane.  The largest effect is added, and the others are estimated again
for the beam with it, until the sizes of the neglected effects, summed for each value of the result, are at
most half the tolerance, as an estimate may be too low by a factor of two.  Effects below a tenth of the
tolerance are not added.  Large deflection excludes camber, and in transients, where it is in one plane only,
shear, stretch and a second plane; if large deflection and an effect that it excludes are both needed, that
set of effects is used whose neglected effects are smaller.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from time import perf_counter
from types import MappingProxyType

import numpy as np

from beamdyn.accuracy.refinement import EFFECTS, refine
from beamdyn.common.inputs.checks import InvalidValue, reason_of
from beamdyn.common.results.statements import INPUT, TOLERANCE, Statement
from beamdyn.equations.effects import EXCLUSIVE, LARGE_DEFLECTION, NAMED, add_effects
from beamdyn.modes.modal.discretization_choice import TOLERANCES, solve_to_tolerance
from beamdyn.modes.modal.error_estimate import EstimatedModes
from beamdyn.modes.modal.model import bends, static_load
from beamdyn.modes.model_error.added_effects import list_effects
from beamdyn.modes.model_error.left_out_changes import (
    EXCLUDED,
    left_out_of_modes,
    vibrate,
    without_large_deflection,
)
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.scene.beam import Beam
from beamdyn.scene.physics import JudgedEffect, Physics, PhysicsChoice
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import refuse_bending_in_space

NOTHING_BARRED: Mapping[str, str] = MappingProxyType({})
PHYSICS_TOLERANCE = 1e-3  # allowed relative change by neglected effects, unless a tolerance is given
_SMALL = 0.1  # fraction of the tolerance below which an effect is not added
_SOLVED = 0.1  # numerical error allowed in the modes with an added effect, as a fraction of the tolerance
_MODES = 3  # number of modes by which the physics of a motion is chosen
_SHORT = 0.2  # computing time [s] below which a result is computed twice, and the shorter time counts
_ROUGH = 2.0  # largest relative change of a frequency by large deflection, divided by (deflection/length)^2
_BENDING = LARGE_DEFLECTION.name
_NOTHING = "no mode vibrates and is stable"


@dataclass(frozen=True)
class EffectSizes:
    """Sizes (relative changes) of the effects that a scene neglects, for one result.

    Parameters
    ----------
    sizes : dict of str to float
        Largest relative change by each effect; inf if the effect changes which modes exist, nan if the change
        is not known.
    reasons : dict of str to str
        Reason why an effect cannot be added, or why its size is not known.
    strained : float
        Order of magnitude of the relative change by the axial strain due to rotation, which no model
        includes.
    """

    sizes: dict[str, float]
    reasons: dict[str, str]
    strained: float = 0.0


Judge = Callable[[Scene], EffectSizes]
Solve = Callable[[Scene], int]  # computes the result for a scene, and returns its number of coordinates


# Choices for different kinds of results --------------------------------------------------------------


def choose_physics(
    scene: Scene,
    speeds: np.ndarray | Sequence[float],
    modes: int,
    tolerance: float | None = None,
    barred: Mapping[str, str] = NOTHING_BARRED,
    in_space: bool = True,
) -> Scene:
    """Choose the physics of a scene with physics "auto", by the frequencies at some speeds.

    Parameters
    ----------
    scene : Scene
        The scene; if its physics is not "auto", it is returned unchanged.
    speeds : sequence of float
        Speeds [rad/s]; effects are estimated at the slowest, the fastest and the middle one.
    modes : int
        Number of modes.
    tolerance : float, optional
        Relative change of a frequency that may be neglected; 1e-3 if not given.
    barred : mapping of str to str
        Names of effects that the analysis cannot include, with the reason.
    in_space : bool
        Whether the analysis can include large deflection in space.

    Returns
    -------
    Scene
        The scene with the chosen physics and a record of the choice.
    """
    if not scene.chooses_physics:
        return scene
    tolerance = PHYSICS_TOLERANCE if tolerance is None else tolerance
    some = np.unique(np.quantile(np.abs(speeds), [0.0, 0.5, 1.0]))

    def solve(candidate: Scene) -> EstimatedModes:
        target = min(max(_SOLVED * tolerance, TOLERANCES[0]), TOLERANCES[1])
        return solve_to_tolerance(candidate, "ritz", some, modes, target)

    def judge(candidate: Scene) -> EffectSizes:
        if not in_space:
            refuse_bending_in_space(candidate)
        found, bent, rough = solve(candidate), candidate.physics.large_deflection, math.nan
        s = found.eigen.eigenvalue[:, :modes]
        effects, counts = left_out_of_modes(found.model, some, s), vibrate(s)
        if bent:  # other effects are then estimated for the straight beam, if the straight beam is stable
            counts &= vibrate(without_large_deflection(found.model).solver.eigenvalues(some, modes))
        elif bends(found.model):  # the static deflection gives a conservative estimate of large deflection
            # If the straight beam is unstable but rotation bends it at lower speeds, results for the straight
            # beam are wrong.
            ratio = np.linalg.norm(found.model.static_tips(some), axis=1) / candidate.beam.length
            rough = math.inf if np.isnan(ratio).any() else float(_ROUGH * np.max(ratio) ** 2)
        sizes = _sizes_in_modes(candidate, effects, counts, rough)
        return replace(sizes, strained=_change_by_strain(found, some))

    def count(candidate: Scene) -> int:
        return solve(candidate).model.solver.size

    # Damped modes take long to compute, and effects change them like undamped modes.
    undamped = scene.undamped
    chosen = choose_by(undamped, judge, count, tolerance, some, barred)
    return replace(chosen, damping_ratio=scene.damping_ratio, damping=scene.damping)


def choose_for_motion(scene: Scene, speeds: np.ndarray, modes: int | None, tolerance: float) -> Scene:
    """Choose the physics of a scene with physics "auto", for its motion over a range of speeds.

    The choice is made by the frequencies of the requested modes, or of the lowest three.  The tolerance is
    that of the analysis, but at least 1e-3: default tolerances of transients refer to numerical errors.
    Other parameters and the result are as for `choose_physics`.
    """
    tolerance = max(tolerance, PHYSICS_TOLERANCE)
    needs_space = plain_physics(scene).bends_in_space  # of a curved axis or matrices of sections
    return choose_physics(scene, speeds, modes or _MODES, tolerance, in_space=needs_space)


def plain_physics(scene: Scene) -> Scene:
    """Replace physics "auto" by that of an Euler-Bernoulli beam in one plane, where no effect may be added.

    A beam with a curved axis bends in both directions and twists under any load, as far as it has the data:
    it is always modelled in space.
    """
    return replace(scene, physics=_plain_of(scene.beam)) if scene.chooses_physics else scene


def _plain_of(beam: Beam) -> Physics:
    """Choose the simplest physics for a beam: Euler-Bernoulli in one plane if its axis is straight."""
    if beam.matrices is not None:
        return Physics(2, shear=True, rotary_inertia=True, stretch=True, torsion=True, large_deflection=True)
    if not beam.is_curved:
        return Physics()
    twists = beam.torsion_stiffness is not None and beam.second_rotary_inertia is not None
    twists |= beam.section is not None and beam.section.poissons_ratio is not None
    planes = 1 if beam.second_bending_stiffness is None else 2
    return Physics(planes, torsion=twists, large_deflection=True)


def _change_by_strain(found: EstimatedModes, speeds: np.ndarray) -> float:
    """Estimate the first frequency's relative change by axial strain, as a stiffness change of that size.

    If rotation softens the beam, the change is relative to the remaining stiffness.
    """
    _, strain = static_load(found.model, speeds)
    first = np.abs(found.eigen.eigenvalue[:, 0])
    known = (first > 0) & np.isfinite(strain)
    softened = np.maximum(found.model.solver.lowest_at_rest / first[known] ** 2, 1.0)
    return float(np.max(strain[known] * softened, initial=0.0))


def _sizes_in_modes(scene: Scene, effects: LeftOutEffects, counts: np.ndarray, rough: float) -> EffectSizes:
    """Compute the sizes of effects: their largest relative changes of the values marked in `counts`.

    If the size of large deflection is unknown, it is `rough`.  An effect that changes which modes exist can
    be added although its size is not known.
    """
    sizes = {}  # inf if a marked value is unknown, nan if no value is marked
    for name, change in effects.changes.items():
        counted = np.abs(change[np.broadcast_to(counts, change.shape)])
        sizes[name] = float(np.nan_to_num(counted, nan=np.inf).max()) if counted.size else math.nan
    sizes |= {name: math.nan for name in effects.not_known if name not in sizes}
    if _BENDING in sizes and (rough == math.inf or not math.isfinite(sizes[_BENDING])):
        sizes[_BENDING] = rough
    additions, _, _ = list_effects(scene)
    assumed = {a.name: f"it is estimated {a.assumed}" for a in additions if a.assumed}
    addable = {a.name for a in additions} - assumed.keys()
    if effects.not_known.get(_BENDING) not in EXCLUDED:
        addable.add(_BENDING)
    refused = {name: why for name, why in effects.not_known.items() if name not in addable}
    nothing = {name: _NOTHING for name, size in sizes.items() if math.isnan(size)}
    return EffectSizes(sizes, nothing | assumed | refused)


def warn_of_peak(scene: Scene, deflection: float) -> Iterator[Statement]:
    """Yield a warning if large deflection, which the chosen physics lacks, matters at a deflection [m]."""
    choice, size = scene.physics_choice, _ROUGH * (deflection / scene.beam.length) ** 2
    if choice is not None and not choice.physics.large_deflection and size > choice.tolerance:
        yield Statement(
            f"physics = auto: the tolerance {choice.tolerance:g} is not met at the largest deflection: large "
            f"deflection, left out, changes frequencies by up to {100 * size:.2g} %, "
            f"estimated as {_ROUGH:g} (deflection/length)^2",
            kind=TOLERANCE,
            quantity="relative change by large deflection",
            value=size,
            limit=choice.tolerance,
        )


def bend_for_peak(scene: Scene, deflection: float) -> Scene | None:
    """Add large deflection to chosen physics if it matters at a computed deflection [m].

    Large deflection replaces the effects that it excludes, if those are smaller.  None if large deflection is
    not added.
    """
    choice, size = scene.physics_choice, _ROUGH * (deflection / scene.beam.length) ** 2
    if choice is None or choice.physics.large_deflection or size <= choice.tolerance:
        return None
    sizes = {effect.name: effect.size for effect in choice.effects} | {_BENDING: size}
    kept = (_BENDING, *(name for name in choice.included if NAMED[name].bends))
    lost = sum(sizes[name] for name in choice.included if name not in kept)
    try:
        bent = add_effects(replace(scene, physics=Physics()), [NAMED[name] for name in kept])
        refuse_bending_in_space(bent)
    except InvalidValue:  # large deflection is refused in an oblique direction
        return None
    if lost >= size:
        return None
    effects = [replace(e, size=sizes[e.name], included=e.name in kept) for e in choice.effects]
    excluded = {*choice.included} - {*kept}
    effects = [replace(e, reason=EXCLUSIVE) if e.name in excluded else e for e in effects]
    left_out = sum(e.size for e in effects if not e.included and not math.isnan(e.size))
    chosen = replace(
        choice, physics=bent.physics, effects=tuple(sorted(effects, key=lambda e: not e.included)),
        model_error=left_out, time=math.nan, coordinates=math.nan,
    )  # fmt: skip
    return replace(bent, physics_choice=chosen)


def warn_of_plain(scene: Scene) -> Iterator[Statement]:
    """Yield a warning if physics "auto" is given to an analysis that cannot add effects to the model."""
    if scene.chooses_physics:
        plain = "curved beam in space" if plain_physics(scene).physics.large_deflection else "plain beam"
        said = f"physics = auto: this analysis adds no effects, its result is that of the {plain}"
        yield Statement(said, kind=INPUT, quantity="physics")


# The choice for any kind of result --------------------------------------------------------------------


@dataclass(frozen=True)
class _Candidate:
    """Scene with some effects included, and the sizes of the other effects.

    Parameters
    ----------
    scene : Scene
        The scene with the effects.
    included : dict of str to float
        The included effects and their sizes when they were added.
    left_out : dict of str to float
        Sizes of the other effects.
    reasons : dict of str to str
        Reason why an effect cannot be added, or why its size is not known.
    strained : float
        Order of magnitude of the relative change by the axial strain due to rotation.
    """

    scene: Scene
    included: dict[str, float]
    left_out: dict[str, float]
    reasons: dict[str, str]
    strained: float

    @property
    def beyond_models(self) -> float:
        """Relative error that no model of this package avoids.

        It is the sum of the uncertainties of the included effects and the change by the axial strain.
        """
        missed = (NAMED[name].uncertainty * min(size, 1.0) for name, size in self.included.items())
        return sum(missed, self.strained)

    @property
    def model_error(self) -> float:
        """Sum of the known sizes of the neglected effects, a relative change."""
        return sum(size for size in self.left_out.values() if not math.isnan(size))

    def addable(self) -> dict[str, float]:
        """Return the sizes of the effects that can be added, by name."""
        known = {name: size for name, size in self.left_out.items() if not math.isnan(size)}
        return {name: size for name, size in known.items() if name not in self.reasons}

    def without(self, name: str, reason: str) -> _Candidate:
        """Return the candidate with an effect marked as one that cannot be added, for a given reason."""
        return replace(self, reasons={name: reason} | self.reasons)

    def add(self, name: str, judge: Judge) -> _Candidate:
        """Return the candidate with one more effect, and with new sizes of the other effects.

        Raises
        ------
        InvalidValue
            If the beam lacks data for the combined effects.
        ArithmeticError
            If there is no result with the effect.
        """
        scene = add_effects(self.scene, [NAMED[name]])
        judged, included = judge(scene), self.included | {name: self.left_out[name]}
        left_out = {}
        for other in (name for name in self.left_out if name not in included):
            size = judged.sizes.get(other, math.nan)  # an effect of unknown size keeps its previous size
            rough = other == _BENDING and other in judged.reasons
            left_out[other] = self.left_out[other] if rough or math.isnan(size) else size
        return _Candidate(scene, included, left_out, judged.reasons | self.reasons, judged.strained)


def choose_by(
    scene: Scene,
    judge: Judge,
    solve: Solve,
    tolerance: float,
    speeds: np.ndarray,
    barred: Mapping[str, str] = NOTHING_BARRED,
) -> Scene:
    """Choose the physics by the result of any analysis.

    Parameters
    ----------
    scene : Scene
        The scene.
    judge : callable
        Function that returns the sizes of the effects that a scene neglects.
    solve : callable
        Function that computes the result for a scene and returns its number of coordinates; it is timed.
    tolerance : float
        Relative change that may be neglected.
    speeds : ndarray
        Speeds [rad/s] at which the effects are estimated.
    barred : mapping of str to str
        Names of effects that the analysis cannot include, with the reason.

    Returns
    -------
    Scene
        The scene with the chosen physics and a record of the choice.
    """
    plain = plain_physics(scene)
    judged = judge(plain)
    start = _Candidate(plain, {}, judged.sizes, judged.reasons, judged.strained)
    for name, why in barred.items():
        start = start.without(name, why)
    best = _grow(start, judge, tolerance, {_BENDING})
    needed = start.addable().get(_BENDING, 0.0) > _SMALL * tolerance
    if needed and best.model_error > EFFECTS.factor * tolerance:
        try:
            # Large deflection, with the effects that can be combined with it.
            bent = start.add(_BENDING, judge)
            bent = _grow(bent, judge, tolerance, {n for n in bent.left_out if not NAMED[n].bends_in_space})
            refused = [bent.reasons[name] for name in best.included if name in bent.reasons]
            if bent.model_error < best.model_error:
                best = bent
            elif refused:  # an effect already chosen excludes large deflection
                best = best.without(_BENDING, refused[0])
        except (InvalidValue, ArithmeticError) as error:
            best = best.without(_BENDING, reason_of(error))
    return replace(best.scene, physics_choice=_describe(best, plain, solve, tolerance, speeds))


def _grow(candidate: _Candidate, judge: Judge, tolerance: float, barred: Set[str]) -> _Candidate:
    """Add effects, except those in `barred`, until those that could still be added are small.

    Their sizes then sum to at most half the tolerance, or each is below a tenth of the tolerance.
    """

    def sizes(found: _Candidate) -> dict[str, float]:
        return {name: size for name, size in found.addable().items() if name not in barred}

    def larger(found: _Candidate) -> _Candidate:
        largest = max(known := sizes(found), key=known.__getitem__)
        try:
            return found.add(largest, judge)
        except (InvalidValue, ArithmeticError) as error:
            excluded = found.scene.physics.large_deflection and not NAMED[largest].bends_in_space
            return found.without(largest, EXCLUSIVE if excluded else reason_of(error))

    def meets(found: _Candidate) -> bool:
        left = sizes(found).values()
        return sum(left) <= EFFECTS.factor * tolerance or max(left) <= _SMALL * tolerance

    return refine(candidate, larger, meets)


def _describe(
    best: _Candidate, plain: Scene, solve: Solve, tolerance: float, speeds: np.ndarray
) -> PhysicsChoice:
    """Describe the choice in numbers: size and computing cost of each effect."""
    without, costs = _cost(plain, solve) if best.included else np.ones(2), {}
    for name in best.included:
        costs[name] = _cost(add_effects(plain, [NAMED[name]]), solve) / without
    together = _cost(best.scene, solve) / without if len(costs) > 1 else [*costs.values(), np.ones(2)][0]

    def by_size(effect: JudgedEffect) -> tuple[bool, float]:
        """Sort the largest effects first, and effects of unknown size last."""
        return math.isnan(effect.size), -effect.size

    included = [JudgedEffect(n, size, True, "", *costs[n].tolist()) for n, size in best.included.items()]
    left_out = [JudgedEffect(n, s, False, _why(n, best, tolerance)) for n, s in best.left_out.items()]
    return PhysicsChoice(
        physics=best.scene.physics,
        tolerance=tolerance,
        speeds=tuple(speeds.tolist()),
        effects=(*sorted(included, key=by_size), *sorted(left_out, key=by_size)),
        model_error=best.model_error,
        time=float(together[0]),
        coordinates=float(together[1]),
        not_modelled=list_effects(plain)[2],
        beyond_models=best.beyond_models,
    )


def _why(name: str, best: _Candidate, tolerance: float) -> str:
    """Explain why an effect is neglected; empty if that follows from its size, or if it can be added."""
    if best.left_out[name] <= _SMALL * tolerance:
        return ""
    if name in best.reasons:
        return best.reasons[name]
    if _BENDING in best.included and not NAMED[name].bends_in_space:
        return EXCLUSIVE
    others = ", ".join(n for n in best.included if not NAMED[n].bends_in_space)
    return f"it cannot be combined with {others}" if name == _BENDING and others else ""


def _cost(scene: Scene, solve: Solve) -> np.ndarray:
    """Measure the computing time [s] and the number of coordinates of the result for a scene."""
    start = perf_counter()
    size = solve(scene)
    time = perf_counter() - start
    if time < _SHORT:  # other processes may prolong a short time: measure again, and take the shorter one
        solve(scene)
        time = min(time, perf_counter() - start - time)
    return np.array([time, size])
