"""The trade of a scene between error and time, in all that the scene asks for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from math import isfinite, pi
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.checks import count, positive, real
from beamdyn.common.results import Provenance, Result
from beamdyn.modal.choice import choose_model
from beamdyn.scene.scene import Scene
from beamdyn.steady.excitation_phases import check_steady_state
from beamdyn.tradeoffs.frequencies import frequency_diagram
from beamdyn.tradeoffs.measurements import Diagram
from beamdyn.tradeoffs.steady import harmonics_diagram, steady_modes_diagram
from beamdyn.tradeoffs.transients import integrators_diagram, transient_modes_diagram

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEAST_BUDGET, LARGEST_BUDGET = 0.01, 86400.0
_PERIODS = 100  # of the first mode, after the start, in a run whose length is not given
_LONG_START = 900  # periods of a start that is too long for that
_LOCUS, _STEADY = 101, 50  # speeds
_SHARES = {"frequencies": 0.05, "locus": 0.07, "integrators": 0.72, "transient modes": 0.06, "steady": 0.05}


@dataclass(frozen=True)
class Tradeoff(Result):
    """Error against time in everything that a scene asks for.

    Parameters
    ----------
    speed : float
        Speed of the frequencies, and the highest of the loci [rad/s].
    t_end : float
        End of the transients [s]; nan if the scene has no motion.
    diagrams : tuple of Diagram
        Frequencies, transients, steady response: each with its Pareto front, the cost of its digits, and
        what the budget left out.
    warnings : tuple of str
        Diagrams that there are not, and why.
    provenance : Provenance
        How it was found.
    """

    speed: float
    t_end: float
    diagrams: tuple[Diagram, ...]
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw all diagrams side by side in the place of the axes."""
        from beamdyn.output.plots import panels

        ax, places = panels(len(self.diagrams), ax)
        for diagram, place in zip(self.diagrams, places, strict=True):
            diagram.plot(place)
        return ax


def tradeoff(
    scene: Scene,
    speed: float | None = None,
    modes: int = 3,
    t_end: float | None = None,
    budget: float = 60.0,
    progress: Callable[[int, int], None] | None = None,
) -> Tradeoff:
    """Measure what accuracy costs on a scene: bases, elements, integrators, modes, harmonics.

    Parameters
    ----------
    scene : Scene
        The scene; transients and the steady response are measured if it has a motion.
    speed : float, optional
        Speed of the frequencies [rad/s]; if not given, that at which the motion ends, or rest.
    modes : int
        Modes that are wanted.
    t_end : float, optional
        End of the transients [s]; a hundred periods of the first mode
        after the start, if that is not too long, or from the start, if not given.
    budget : float
        Time that all of it may take, about [s]; what does not fit is left out, and named.
    progress : callable, optional
        Called with the number of diagrams that are done, and of all.

    Returns
    -------
    Tradeoff

    Raises
    ------
    ValueError
        If an argument is out of its range, or `t_end` is given for a scene without motion.
    """
    start = perf_counter()
    modes, budget = count("modes", modes), _checked_budget(budget)
    if t_end is not None and scene.motion is None:
        raise ValueError(
            f"t_end = {t_end!r}: the scene has no motion, so there is no transient; add one, or leave it out"
        )
    speed = _final_speed(scene) if speed is None else real("speed", speed, "rad/s")
    end = np.nan if scene.motion is None else _end(scene) if t_end is None else positive("t_end", t_end, "s")
    parts = list(_parts(scene, speed, modes, end, budget))
    diagrams = []
    for done, part in enumerate(parts):
        if progress is not None:
            progress(done, len(parts))
        diagrams.append(part())
    return Tradeoff(
        speed=speed,
        t_end=end,
        diagrams=tuple(d for d in diagrams if d.measurements),
        warnings=tuple(_warnings(scene, diagrams)),
        provenance=Provenance(__version__, f"{modes} modes, budget {budget:g} s", "", perf_counter() - start),
        scene=scene,
    )


def _checked_budget(budget: float) -> float:
    budget = positive("budget", budget, "s", "give a time such as 60")
    if not LEAST_BUDGET <= budget <= LARGEST_BUDGET:
        raise ValueError(f"budget = {budget:g} s: give {LEAST_BUDGET:g} to {LARGEST_BUDGET:g} s, such as 60")
    return budget


def _final_speed(scene: Scene) -> float:
    final = 0.0 if scene.motion is None else scene.motion.final_speed
    return final if isfinite(final) else 0.0


def _end(scene: Scene) -> float:
    """A hundred periods of the first mode after the start, if that is not too long [s]."""
    assert scene.motion is not None
    model = choose_model(scene, "ritz", np.zeros(1), 1, target=1e-3)
    period = 2 * pi / float(np.abs(model.solver.eigenvalues(np.zeros(1), 1)[0, 0]))
    start = scene.motion.steady_start if scene.motion.steady_start <= _LONG_START * period else 0.0
    return min(_rounded(start + _PERIODS * period), scene.motion.end)


def _rounded(value: float) -> float:
    """A value with two digits."""
    return float(f"{value:.1e}")


def _parts(
    scene: Scene, speed: float, modes: int, t_end: float, budget: float
) -> Iterator[Callable[[], Diagram]]:
    """The diagrams that the scene asks for, each with its share of the budget."""
    time = {name: share * budget for name, share in _SHARES.items()}
    yield partial(frequency_diagram, scene, np.array([speed]), modes, time["frequencies"])
    if speed:
        locus = np.sort(np.linspace(0, speed, _LOCUS))
        yield partial(frequency_diagram, scene, locus, modes, time["locus"])
    if scene.motion is None:
        return
    yield partial(integrators_diagram, scene, t_end, modes, time["integrators"])
    yield partial(transient_modes_diagram, scene, t_end, time["transient modes"])
    if _has_steady(scene) and speed > 0:
        speeds = np.linspace(0, speed, _STEADY + 1)[1:]
        yield partial(harmonics_diagram, scene, speeds, modes, time["steady"])
        yield partial(steady_modes_diagram, scene, speeds, time["steady"])


def _has_steady(scene: Scene) -> bool:
    try:
        check_steady_state(scene.motion)
    except ValueError:
        return False
    return True


def _warnings(scene: Scene, diagrams: list[Diagram]) -> Iterator[str]:
    if scene.motion is None:
        yield "the scene has no motion: transients and the steady response are not measured"
    elif not _has_steady(scene):
        yield "the motion has no known steady state: the steady response is not measured"
    for diagram in diagrams:
        if not diagram.measurements:
            yield f"{diagram.title}: not measured: {'; '.join(diagram.skipped)}"
