"""Trade-off between error and computing time, for all computations of a scene."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from math import pi
from time import perf_counter

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, count, function, positive, real
from beamdyn.common.plots.axes_and_lines import panels
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import OUTSIDE, announced_of_plain_beam, of_kind
from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.modes.model_error.effect_choice import plain_physics, warn_of_plain
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import check_speeds
from beamdyn.steady.periodic_system import check_steady_state
from beamdyn.studies.tradeoffs import responses
from beamdyn.studies.tradeoffs.frequencies import frequency_diagram, physics_diagram
from beamdyn.studies.tradeoffs.measurements import Diagram

# Largest number of modes that the references resolve, even if a second plane of bending adds as many modes.
MOST_MODES = 20
LEAST_BUDGET, LARGEST_BUDGET = 0.01, 86400.0  # limits of the time budget [s]
_REMEDY = "give fewer modes: comparing their times shows how the time grows with the number of modes"
_DEFAULT_PERIODS = 100  # default length of a transient after the start-up, in periods of the first mode
_LONGEST_START = 900  # longest start-up, in periods of the first mode, that a default transient includes
_LOCUS, _STEADY = 101, 50  # number of speeds of the locus, and of the steady response
_SHARES = {
    "frequencies": 0.05,
    "locus": 0.07,
    "physics": 0.06,
    "integrators": 0.66,
    "transient modes": 0.06,
    "steady": 0.05,
}


@dataclass(frozen=True)
class Tradeoff(SceneResult):
    """Error against computing time of frequencies, transients and steady response of a scene.

    Parameters
    ----------
    speed : float
        Speed of the frequencies, and highest speed of the locus and of the steady response [rad/s].
    t_end : float
        End of the transients [s]; nan if the scene has no motion.
    diagrams : tuple of Diagram
        Diagrams of frequencies, of frequencies including the model error, of transients and of the steady
        response.
    warnings : tuple of str
        Model error of the scene at the speed, if it is above 1 %; missing diagrams, with the reason.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.tradeoff(bd.Scene(strip, bd.Mount(radius=0.215)), speed=50.0, modes=1, budget=0.5)
    >>> found.speed
    50.0
    """

    speed: float
    t_end: float
    diagrams: tuple[Diagram, ...]

    def headline(self) -> Iterator[str]:
        """Yield numbers of diagrams and measurements, and the speed, for the one-line summary.

        See `Result.headline`.
        """
        yield f"{counted(len(self.diagrams), 'diagram')} at {self.say_speed(self.speed)}"
        yield counted(sum(len(each.measurements) for each in self.diagrams), "measurement")
        yield warned(self.warnings)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw all diagrams in panels, which divide the area of given axes, or in a new figure."""
        ax, places = panels(len(self.diagrams), ax)
        for diagram, place in zip(self.diagrams, places, strict=True):
            diagram.plot(place)
        return ax


@announced_of_plain_beam
def tradeoff(
    scene: Scene,
    speed: float | None = None,
    modes: int = 3,
    t_end: float | None = None,
    budget: float = 60.0,
    progress: Callable[[int, int], None] | None = None,
) -> Tradeoff:
    """Measure error against computing time on a scene: bases, elements, physics, integrators, modes.

    Parameters
    ----------
    scene : Scene
        The scene; if it has a motion, transients and the steady response are timed, too.
    speed : float, optional
        Speed of the frequencies [rad/s]; by default the final speed of the motion, or 0.
    modes : int
        Number of modes, from 1 to 20.
    t_end : float, optional
        End of the transients [s]; by default a hundred periods of the first mode after the speed has become
        steady, or from the start if that takes more than 900 periods.
    budget : float
        Approximate time for all measurements [s]; the diagrams name the settings that did not fit.
    progress : callable, optional
        Called with the number of finished diagrams and of all diagrams.

    Returns
    -------
    Tradeoff

    Raises
    ------
    ValueError
        If an argument is out of its range, or `t_end` is given for a scene without motion.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.tradeoff(bd.Scene(strip, bd.Mount(radius=0.215)), speed=50.0, modes=1, budget=0.5)
    >>> len(found.diagrams) > 0
    True
    """
    start = perf_counter()
    check_scene(scene)
    unresolved, scene = scene, plain_physics(scene)
    modes, budget = count("modes", modes, 1, MOST_MODES, _REMEDY), _check_budget(budget)
    if progress is not None:
        function("progress", progress, "it takes the numbers of finished diagrams and of all diagrams")
    if t_end is not None and scene.motion is None:
        bound = "the scene has no motion, so there is no transient"
        raise InvalidValue("t_end", t_end, bound, "add one, or leave it out")
    speed = scene.final_speed if speed is None else real("speed", speed, "rad/s")
    check_speeds(speed, "speed")
    end = np.nan if scene.motion is None else _end(scene) if t_end is None else positive("t_end", t_end, "s")
    tasks = list(_list_diagrams(scene, speed, modes, end, budget))
    diagrams = []
    for done, task in enumerate(tasks):
        if progress is not None:
            progress(done, len(tasks))
        diagrams.append(task())
    judged = natural_modes(scene, speed, modes)
    of_model = (*of_kind(judged.warnings, OUTSIDE), *judged.model_warnings())
    return Tradeoff(
        speed=speed,
        t_end=end,
        diagrams=tuple(d for d in diagrams if d.measurements),
        warnings=(*warn_of_plain(unresolved), *of_model, *_warnings(scene, diagrams)),
        provenance=Provenance.since(start, f"{modes} modes, budget {budget:g} s"),
        scene=scene,
    )


def _check_budget(budget: float) -> float:
    budget = positive("budget", budget, "s", "give a time such as 60")
    if not LEAST_BUDGET <= budget <= LARGEST_BUDGET:
        raise ValueError(f"budget = {budget:g} s: give {LEAST_BUDGET:g} to {LARGEST_BUDGET:g} s, such as 60")
    return budget


def _end(scene: Scene) -> float:
    """Return the default end of transients [s]: a hundred periods of the first mode after the start-up.

    A start-up of more than 900 periods is not included.  The end is at most the end of the motion.
    """
    assert scene.motion is not None
    model = choose_model(scene, "ritz", np.zeros(1), 1, target=1e-3)
    period = 2 * pi / float(np.abs(model.solver.eigenvalues(np.zeros(1), 1)[0, 0]))
    start = scene.motion.steady_start if scene.motion.steady_start <= _LONGEST_START * period else 0.0
    return min(float(f"{start + _DEFAULT_PERIODS * period:.1e}"), scene.motion.end)


def _list_diagrams(
    scene: Scene, speed: float, modes: int, t_end: float, budget: float
) -> Iterator[Callable[[], Diagram]]:
    """Yield the diagrams that apply to the scene, each computed within its part of the budget."""
    time = {name: share * budget for name, share in _SHARES.items()}
    yield partial(frequency_diagram, scene, np.array([speed]), modes, time["frequencies"])
    if speed:
        locus = np.sort(np.linspace(0, speed, _LOCUS))
        yield partial(frequency_diagram, scene, locus, modes, time["locus"])
    yield partial(physics_diagram, scene, speed, modes, time["physics"])
    if scene.motion is None:
        return
    yield partial(responses.integrators_diagram, scene, t_end, modes, time["integrators"])
    yield partial(responses.transient_modes_diagram, scene, t_end, time["transient modes"])
    if _has_known_steady_state(scene) and speed > 0:
        speeds = np.linspace(0, speed, _STEADY + 1)[1:]
        yield partial(responses.harmonics_diagram, scene, speeds, modes, time["steady"])
        yield partial(responses.steady_modes_diagram, scene, speeds, time["steady"])


def _has_known_steady_state(scene: Scene) -> bool:
    try:
        check_steady_state(scene.motion)
    except ValueError:
        return False
    return True


def _warnings(scene: Scene, diagrams: list[Diagram]) -> Iterator[str]:
    if scene.motion is None:
        yield "the scene has no motion: transients and the steady response are not measured"
    elif not _has_known_steady_state(scene):
        yield "the motion has no known steady state: the steady response is not measured"
    for diagram in diagrams:
        if not diagram.measurements:
            yield f"{diagram.title}: not measured: {'; '.join(diagram.skipped)}"
