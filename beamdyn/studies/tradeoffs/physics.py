"""Error against time with the error of the model included: choices of physics, each over its size."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from beamdyn.common.assignment import assign
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.digits import percent
from beamdyn.equations.effects import LARGE_DEFLECTION, STRETCH
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.modal.error_estimate import EstimatedModes
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.static_load import bends
from beamdyn.modes.model_error.additions import list_effects
from beamdyn.scene.scene import Scene
from beamdyn.studies.tradeoffs.frequencies import sizes_of_eigenvalues, solve_reference
from beamdyn.studies.tradeoffs.measurements import Diagram, Measurement, number_of
from beamdyn.studies.tradeoffs.timing import Family, Setting, measure_families

AS_GIVEN, ALL = "as given", "all of these"
_FUNCTIONS = (1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20)
_NOTHING = 1e-10  # relative change of the frequencies below which an effect is left aside
_BETTER = 0.5  # of the error of the model as given: what is not below it has gained nothing by more physics
_COMPARED = (STRETCH.name,)  # effects that are modelled to compare with papers only


@dataclass(frozen=True)
class Choice:
    """A choice of physics, solved well beyond its own error.

    Parameters
    ----------
    name : str
        The effects that it adds.
    scene : Scene
        The scene with them.
    solution : EstimatedModes
        Its modes at the speed.
    """

    name: str
    scene: Scene
    solution: EstimatedModes

    @property
    def frequency(self) -> np.ndarray:
        """Magnitudes of the eigenvalues [1/s], ascending."""
        return sizes_of_eigenvalues(self.solution.eigen.eigenvalue)[0]


@one_blas_thread()
def physics_diagram(scene: Scene, speed: float, modes: int = 3, budget: float = 10.0) -> Diagram:
    """Measure error, including that of the model, against time of the natural frequencies.

    The reference has the largest set of effects that can be combined: those of straight beams, or large
    deflection and rotary inertia, whichever changes the frequencies more.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speed : float
        Speed [rad/s].
    modes : int
        Number of the lowest modes of the scene as it is given.
    budget : float
        Time for all measurements [s].

    Returns
    -------
    Diagram
    """
    given = _solve(AS_GIVEN, scene, speed, modes)
    choices, skipped = _list_choices(scene, speed, modes, given)
    title = f"physics: {number_of(modes, 'frequency', 'frequencies')} at {speed:.6g} rad/s"
    what = "the worst frequency, that of the model included, relative"
    if not choices:
        return Diagram.make(title, what, "", 0.0, (), skipped or ("no effect that can be added changes it",))
    full = choices[-1]
    true = pick(full.frequency, given.frequency[:modes])
    families = [
        Family(c.name, tuple(_settings(c.scene, speed, modes, _segments(scene)))) for c in (given, *choices)
    ]
    resolved = float(full.solution.error.max())
    measurements, left_out = measure_families(
        families, lambda found: float(np.abs(pick(found, true) / true - 1).max()), resolved, budget
    )
    of_model = float(np.abs(given.frequency[:modes] / true - 1).max())
    left_out = [*_say_cut(measurements, of_model, _names(choices)), *left_out]
    reference = f"{full.solution.model.discretization} with {_names(choices)}"
    return Diagram.make(title, what, reference, resolved, measurements, [*skipped, *left_out])


def _say_cut(measurements: Sequence[Measurement], of_model: float, names: str) -> Iterator[str]:
    """Say it where the budget does not last for what would make the error smaller than that of the model."""
    if min((m.error for m in measurements), default=inf) > _BETTER * of_model:
        yield (
            f"{names}: the budget does not last for enough functions; {AS_GIVEN} the model is "
            f"{percent(of_model)} off, with any setting"
        )


def pick(found: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """The frequencies that belong to those wanted (m,): the nearest, each used once."""
    order = assign(np.abs(np.log(wanted[:, None] / found[None, :])))
    return found[order]


def _names(choices: list[Choice]) -> str:
    return choices[0].name if len(choices) == 1 else " and ".join(c.name for c in choices[:-1])


# Choices ------------------------------------------------------------------------------------------


def _list_choices(
    scene: Scene, speed: float, modes: int, given: Choice
) -> tuple[list[Choice], tuple[str, ...]]:
    """The effects of the set that changes most, one by one and then together; why others are missing."""
    alone, not_known = _solve_additions(scene, speed, modes)
    alone = [c for c in alone if _change(c, given, modes) > _NOTHING]
    if not alone:
        return [], tuple(not_known)
    bent = [c for c in alone if c.name == LARGE_DEFLECTION.name]
    straight = [c for c in alone if c.name != LARGE_DEFLECTION.name]
    with_bent = [*bent, *(c for c in straight if _combined(scene, [*bent, c]) is not None)] if bent else []
    kept = max(with_bent, straight, key=lambda s: max((_change(c, given, modes) for c in s), default=0.0))
    apart = [f"{c.name}: it cannot be combined with the others" for c in alone if c not in kept]
    together = _combined(scene, kept)
    assert together is not None
    everything = [_solve(ALL, together, speed, modes)] if len(kept) > 1 else []
    return [*kept, *everything], (*not_known, *apart)


def _solve_additions(scene: Scene, speed: float, modes: int) -> tuple[list[Choice], list[str]]:
    """The scene with each effect that it leaves out, solved; and what keeps others away."""
    additions, missing, _ = list_effects(scene)
    scenes = {a.name: a.scene for a in additions if a.name not in _COMPARED}
    not_known = [f"{name}: {why}" for name, why in missing.items() if name not in _COMPARED]
    if not scene.physics.large_deflection and speed and bends(Model(scene, Ritz(12))):
        try:
            scenes[LARGE_DEFLECTION.name] = _with(scene, large_deflection=True)
        except InvalidValue as error:
            not_known.append(f"{LARGE_DEFLECTION.name}: {error}")
    return [_solve(name, added, speed, modes) for name, added in scenes.items()], not_known


def _combined(scene: Scene, choices: list[Choice]) -> Scene | None:
    """The scene with all that the choices add; None if that cannot be combined."""
    beam = next((c.scene.beam for c in choices if c.scene.beam is not scene.beam), scene.beam)
    added = {}
    for choice in choices:
        physics = choice.scene.physics
        added |= {k: v for k, v in vars(physics).items() if v != getattr(scene.physics, k)}
    try:
        return _with(replace(scene, beam=beam), **added)
    except InvalidValue:
        return None


def _with(scene: Scene, **physics: object) -> Scene:
    return replace(scene, physics=replace(scene.physics, **physics))  # pyright: ignore[reportArgumentType]


def _solve(name: str, scene: Scene, speed: float, modes: int) -> Choice:
    return Choice(name, scene, solve_reference(scene, np.array([speed]), _count(scene, modes)))


def _count(scene: Scene, modes: int) -> int:
    """Modes among which those wanted are: those of a second plane stand between them."""
    return 2 * modes + 2 if scene.physics.planes == 2 else modes


def _change(choice: Choice, given: Choice, modes: int) -> float:
    """Largest relative change of the frequencies by a choice."""
    wanted = given.frequency[:modes]
    return float(np.abs(pick(choice.frequency, wanted) / wanted - 1).max())


# Sizes --------------------------------------------------------------------------------------------


def _segments(scene: Scene) -> int:
    return len(scene.modelled_beam.breakpoints) - 1


def _settings(scene: Scene, speed: float, modes: int, segments: int) -> Iterator[Setting]:
    """Computations by Legendre functions, the fewest first."""
    count = _count(scene, modes)
    least = -(-count // segments)
    each = "functions a segment" if segments > 1 else "functions"
    for n in _FUNCTIONS:
        if n >= least:
            yield Setting(f"{n} {each}", n, _computation(scene, Ritz(n), speed, count))


def _computation(scene: Scene, basis: Ritz, speed: float, count: int) -> Callable[[float], np.ndarray]:
    speeds = np.array([speed])
    return lambda deadline: sizes_of_eigenvalues(Model(scene, basis).solver.eigenvalues(speeds, count))[0]
