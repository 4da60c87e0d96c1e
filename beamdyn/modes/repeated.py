"""Model errors of results, computed by repeating the analysis with each effect that the model neglects."""

from __future__ import annotations

import functools
import inspect
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any, ClassVar, ParamSpec, TypeVar

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer, reason_of
from beamdyn.common.results.statements import unannounced
from beamdyn.equations.effects import CAMBER, LARGE_DEFLECTION
from beamdyn.modes.model_error.added_effects import MOST_CAMBER, without_camber
from beamdyn.modes.model_error.left_out_changes import SolvedValues, left_out_by_solving, nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.scene import Scene

Arguments = ParamSpec("Arguments")
Answer = TypeVar("Answer")

BY_FREQUENCY = "by the first frequency"
_LOADED = "the result or its source was loaded from a file without model error: compute it before saving"
_NOTHING = "there is no value that the effect could change"
# Number of lowest modes, and relative change of their frequencies below which no analysis is repeated.
_LOWEST, _SMALL = 2, 1e-5


class JudgedByRepeating(StatesModelError):
    """Base class of results whose model error is computed by repeating the analysis with each effect.

    A subclass implements `judged`.  The analysis is decorated by `repeatable`, or sets `again`.

    Attributes
    ----------
    again : callable or None
        Function that repeats the analysis with the same arguments for another scene; None in a result that
        was loaded from a file without its model error.
    follows_stiffness : bool
        Whether the values are proportional to the first mode's compliance, so that their change by large
        deflection can be estimated if the analysis supports only straight beams.
    """

    judged_by_solving = True
    again: Callable[..., Any] | None = None
    follows_stiffness: ClassVar[bool] = True

    def judged(self, found: Any) -> np.ndarray:
        """Return the values of a result of this class for which the model error is stated."""
        raise NotImplementedError

    @property
    def as_far_as_judged(self) -> Mapping[str, Any]:
        """Arguments that restrict a repeated analysis to the values for which the model error is stated."""
        return {}

    @property
    def bending_speed(self) -> float:
        """Speed [rad/s] at which the change by large deflection is estimated."""
        return getattr(self, "speed", 0.0)

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Changes of the values returned by `judged` by each neglected effect."""
        if self.again is None or not np.isfinite(self.judged(self)).any():
            return nothing_known(self.scene, _LOADED if self.again is None else _NOTHING)
        found, name = left_out_by_solving(self.scene, self.solve), LARGE_DEFLECTION.name
        if reason := found.not_known.get(name):  # not computed by solving: estimate it
            found = _with_change(found, name, self.judged(self), self.bent_values(self.judged(self), reason))
        return replace(found, counted=self.counted or found.counted)

    def solve(self, scene: Scene, name: str) -> SolvedValues:
        """Solve a scene with the named effect; with large deflection only if the analysis supports it."""
        own = self.judged(self)
        if scene == self.scene or self.again is None:
            return SolvedValues(own)
        if (change := self._small_changes.get(name)) is not None:
            return SolvedValues(own / (1 + change) ** 2 if self.follows_stiffness else own, "", BY_FREQUENCY)
        try:
            with unannounced():
                return SolvedValues(self.judged(self.again(scene, **self.as_far_as_judged)))
        except (ArithmeticError, NoModelAnswer, np.linalg.LinAlgError) as error:
            return SolvedValues(np.full(own.shape, np.nan), reason_of(error))
        except InvalidValue as refusal:
            if name == LARGE_DEFLECTION.name:
                return self.bent_values(self.solve(scene.straightened, "").values, refusal.bound)
            # The analysis refuses camber: sections that are held flat give an upper bound of its effect.
            if scene.models_width and name == CAMBER.name:
                held_flat = without_camber(replace(scene, physics=self.scene.physics))
                return self.solve(held_flat, name)._replace(assumed=MOST_CAMBER)
            return SolvedValues(np.full(own.shape, np.nan), refusal.bound)

    @cached_property
    def _small_changes(self) -> dict[str, float]:
        """Relative change of the first frequency by each effect that hardly changes the lowest ones."""
        changes = left_out_of_frequencies(self.scene, self.bending_speed, _LOWEST).changes
        small = {name: each for name, each in changes.items() if np.abs(each).max() <= _SMALL}
        return {name: float(each[0]) for name, each in small.items() if name != LARGE_DEFLECTION.name}

    def bent_values(self, straight: np.ndarray, reason: str) -> SolvedValues:
        """Estimate values with large deflection from those of the straight beam and the first frequency.

        The estimate multiplies the `straight` values by the change of the first mode's compliance.  If they
        are not proportional to it (`follows_stiffness` is False), the result is nan, with the given reason.
        If rotation does not bend the beam, the result is the `straight` values.
        """
        effects = left_out_of_frequencies(self.scene, self.bending_speed, 1)
        name = LARGE_DEFLECTION.name
        change = float(effects.changes[name][0])
        if change and not self.follows_stiffness:
            return SolvedValues(np.full(straight.shape, np.nan), reason)
        note = BY_FREQUENCY if change else ""
        return SolvedValues(straight / (1 + change) ** 2, effects.not_known.get(name, ""), note)


def _with_change(found: LeftOutEffects, name: str, own: np.ndarray, bent: SolvedValues) -> LeftOutEffects:
    """Add an effect's change, from values without it (`own`) and with it (`bent`), if all are finite."""
    with np.errstate(divide="ignore", invalid="ignore"):
        change = bent.values / own - 1
    if not np.isfinite(change).all():
        return found
    others = {other: why for other, why in found.not_known.items() if other != name}
    assumed = found.assumed | ({name: bent.assumed} if bent.assumed else {})
    return replace(found, changes=found.changes | {name: change}, not_known=others, assumed=assumed)


def left_out_of_frequencies(scene: Scene, speed: float, modes: int) -> LeftOutEffects:
    """Compute changes of the lowest natural frequencies at a speed by neglected effects."""
    with unannounced():
        return natural_modes(scene, speed, modes).left_out_effects


def repeatable(analysis: Callable[Arguments, Answer]) -> Callable[Arguments, Answer]:
    """Decorate an analysis of a scene, or of a repeatable result: its result records how to repeat it."""
    signature = inspect.signature(analysis)

    @functools.wraps(analysis)
    def repeatable_analysis(*given: Arguments.args, **named: Arguments.kwargs) -> Answer:
        result = analysis(*given, **named)
        (_, source), *others = signature.bind(*given, **named).arguments.items()
        options = dict(others)
        options |= options.pop("options", {})  # options of `solve_ivp`
        # Function with all its decorators, which pickle finds by its name.
        public = vars(sys.modules[analysis.__module__])[analysis.__name__]
        # Results loaded from files cannot be repeated.
        if isinstance(source, Scene) or getattr(source, "again", None) is not None:
            vars(result)["again"] = functools.partial(_repeat, public, source, options)
        return result

    return repeatable_analysis


def _repeat(
    analysis: Callable[..., Any], source: Any, options: dict[str, Any], scene: Scene, **others: Any
) -> Any:
    """Repeat an analysis for another scene, with some arguments changed.

    If its argument is the result of another analysis, that analysis is repeated for the scene first.
    """
    return analysis(scene if isinstance(source, Scene) else source.again(scene), **options | others)
