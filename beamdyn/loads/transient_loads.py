"""Loads along the span during a transient, with their extremes and errors.

In shapes of arrays, T counts times, S stations, and k components of a quantity.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, ascending, kind, real
from beamdyn.common.plots.curves import plot_load_over_time
from beamdyn.common.results.pictures import Axes
from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.loads import span_loads
from beamdyn.loads.load_path import LoadPath
from beamdyn.loads.stations import SHOWN, Positions, SectionPoints
from beamdyn.modes.modal.model import find_speed_range
from beamdyn.modes.model_error.left_out_changes import SolvedValues, nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.modes.repeated import BY_FREQUENCY, repeatable
from beamdyn.scene.scene import Scene
from beamdyn.transient.simulate import Transient

_BY_DEFLECTION = "as of the largest deflection"
_MOST_TIMES = 2000  # largest default number of times in the result


@dataclass(frozen=True)
class EquivalentRange:
    """Range of equal cycles with the same damage as the counted cycles at one station (Miner's rule).

    Parameters
    ----------
    quantity : str
        "force", "moment", "curvature", "strain" or "stress".
    component : int
        Index of the quantity's component.
    x : float
        Position along the beam [m].
    start, end : float
        The time window [s].
    exponent : float
        Exponent m of the Woehler curve.
    cycles : float
        Number of equal cycles.
    range : float
        Range of the equal cycles [unit of the quantity].
    error : float
        Estimated absolute error of the range [unit of the quantity].
    """

    quantity: str
    component: int
    x: float
    start: float
    end: float
    exponent: float
    cycles: float
    range: float
    error: float


@dataclass(frozen=True)
class TransientLoads(span_loads.SpanLoads):
    """Loads along the span at C times of a transient.

    The fields are those of `SpanLoads`, and the following.

    Parameters
    ----------
    t : ndarray, shape (C,)
        Times [s].
    equivalent_ranges : tuple of EquivalentRange
        Ranges of equal cycles, where they were requested, as by `beamdyn loads --woehler`.

    Notes
    -----
    The errors, by station and component, hold for the whole run.  They are infinite if there is no larger
    model to compare with or the distance from it is too large to judge by, and nan for the methods of
    `solve_ivp`, whose time-integration error is not known.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), bd.SpinUp(55.0, duration=0.5))
    >>> loads = bd.transient_loads(bd.simulate(scene, t_end=0.5, modes=2), at=[0.0, 0.025])
    >>> loads.largest("strain").x  # m, at the root
    0.0
    """

    t: np.ndarray
    path: LoadPath = field(repr=False)
    equivalent_ranges: tuple[EquivalentRange, ...] = ()

    case: ClassVar[span_loads.LoadCase] = span_loads.LoadCase("time", "s", "t")

    @property
    def run(self) -> Transient:
        """The transient that was analysed."""
        return self.path.run

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of the largest value by neglected effects.

        They are unknown if the run started from an initial state given as an array.
        """
        from_rest = isinstance(self.run.request.initial, str)
        return super().left_out_effects if from_rest else nothing_known(self.scene)

    def solve(self, scene: Scene, name: str) -> SolvedValues:
        """Find the largest value with an effect added to the model.

        It is estimated by `as_deflection`; if this returns None, it is computed by another simulation.
        """
        return self.as_deflection(self.judged(self), name) or super().solve(scene, name)

    def bent_values(self, straight: np.ndarray, reason: str) -> SolvedValues:
        """Estimate load values with large deflection from the change that it causes in the tip deflection."""
        return self.as_deflection(straight, LARGE_DEFLECTION.name) or SolvedValues(straight, reason)

    @property
    def bending_speed(self) -> float:
        """Largest speed of the transient [rad/s], at which large deflection is estimated."""
        return find_speed_range(self.run.request.motion, self.run.path.end)[-1]

    def as_deflection(self, value: np.ndarray, name: str) -> SolvedValues | None:
        """Estimate a load with an added effect from the change of the tip deflection; None if not applicable.

        The estimate applies to large deflection, and to effects estimated from the frequency alone.
        """
        of_run = self.run.left_out_effects
        if name != LARGE_DEFLECTION.name and of_run.assumed.get(name) != BY_FREQUENCY:
            return None
        reason = of_run.not_known.get(name, "")
        return SolvedValues(value * (1 + of_run.changes[name]), reason, _BY_DEFLECTION)

    def with_equivalent_ranges(self, found: tuple[EquivalentRange, ...]) -> TransientLoads:
        """Return a copy of the loads with equivalent ranges, so that their model error can be stated."""
        copy = replace(self, equivalent_ranges=found)
        vars(copy)["again"] = self.again
        return copy

    def at(self, quantity: str, t: np.ndarray | Sequence[float]) -> np.ndarray:
        """Evaluate a quantity at ascending times t [s] of the run: (times, stations, components)."""
        self.check_component(quantity, None)
        return self.path.at(_times_in(self.run, t))[..., self.path.outputs.places[quantity]]

    def peaks(
        self, quantity: str = "strain", start: float | None = None, end: float | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Find values of largest magnitude from `start` to `end` [s], also between times of the result.

        Returns
        -------
        values, times : ndarray, shape (stations, components)
            Values with their signs, and the times at which they are reached [s].
        """
        self.check_component(quantity, None)
        place = self.path.outputs.places[quantity]
        values, times = self.path.peaks(*window_in(self.run, start, end))
        return values[:, place], times[:, place]

    def largest(
        self,
        quantity: str = "strain",
        component: int | None = None,
        start: float | None = None,
        end: float | None = None,
    ) -> span_loads.LargestLoad:
        """Find the largest magnitude of a quantity from `start` to `end` [s], also between listed times.

        Parameters
        ----------
        quantity, component
            As for `SpanLoads.largest`.
        start, end : float, optional
            The window [s]; the whole run if not given.

        Returns
        -------
        LargestLoad
        """
        chosen = self.check_component(quantity, component)
        self.check_known(quantity)
        values, times = (each[:, chosen] for each in self.peaks(quantity, start, end))
        s, k = np.unravel_index(int(np.abs(values).argmax()), values.shape)
        error = float(self.error_of(quantity)[s, chosen[k]])
        return self.located(quantity, float(values[s, k]), error, int(s), chosen[k], float(times[s, k]))

    def plot(
        self,
        ax: Axes | None = None,
        quantity: str = "moment",
        start: float | None = None,
        end: float | None = None,
    ) -> Axes:
        """Plot the range of a quantity along the span from `start` to `end` [s], or over the whole run."""

        def within(name: str) -> np.ndarray:
            first, last = window_in(self.run, start, end)
            return self.values(name)[(self.t >= first) & (self.t <= last)]

        return self.draw(ax, quantity, within, span_loads.with_unit(quantity))

    def plot_over_time(self, station: int = 0, quantity: str = "moment", ax: Axes | None = None) -> Axes:
        """Plot a quantity over time at a station given by its index, such as the root's bending moment."""
        values, labels = self.values(quantity)[:, station], self.components(quantity)
        scale, unit = SHOWN[quantity]
        label = f"{quantity} at {self.say_length(self.x[station])} [{unit}]"
        return plot_load_over_time(self.t, scale * values, labels, label, ax)


@repeatable
def transient_loads(
    run: Transient,
    at: Positions | None = None,
    points: SectionPoints | None = None,
    t: np.ndarray | Sequence[float] | None = None,
    youngs_modulus: float | None = None,
) -> TransientLoads:
    """Compute the loads along the span during a transient, from external forces and inertia.

    Parameters
    ----------
    run : Transient
        The transient, of `simulate`.
    at, points
        As for `static_loads`.
    t : sequence of float, optional
        Times of the result [s], ascending; by default those of the run, or at most 2000 of them.  The
        largest values (`largest`, `peaks`) and the errors are those of the run, whatever these times are.
    youngs_modulus
        As for `static_loads`.

    Returns
    -------
    TransientLoads

    Raises
    ------
    ValueError
        If an argument is out of its range, a point lies outside the section, or the run is one of large
        deflection.

    References
    ----------
    As `static_loads`, with inertia (d'Alembert, standard); neglected modes respond statically: Craig and
    Kurdila (2006), Fundamentals of Structural Dynamics, section 11.4.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), bd.SpinUp(55.0, duration=0.5))
    >>> loads = bd.transient_loads(bd.simulate(scene, t_end=0.5, modes=2), at=[0.0, 0.025])
    >>> loads.x
    array([0.   , 0.025])
    """
    kind("run", run, Transient, "simulate makes one")
    asked = span_loads.AskedLoads.of(run.scene, at, points, youngs_modulus)
    path = LoadPath(run, asked.stations, asked.outputs)
    times = run.t[:: 1 + (len(run.t) - 1) // _MOST_TIMES] if t is None else _times_in(run, t)
    values, error = path.at(times), path.error
    compared_with = "" if run.refined is None else run.refined.provenance.method
    made = asked.result(values, error, run.warnings, run.provenance.method, compared_with)
    return TransientLoads(**made, t=times, path=path)


def _times_in(run: Transient, t: np.ndarray | Sequence[float] | float) -> np.ndarray:
    """Check that times [s] are within the simulated time, and return them as an array."""
    times = ascending("t", t)
    if not (times.min() >= run.path.start and times.max() <= run.path.end * (1 + 1e-12)):
        bound = f"times must lie in the run, from {run.path.start:g} to {run.path.end:g} s"
        raise InvalidValue("t", t, bound, unit="s")
    return times


def window_in(run: Transient, start: float | None, end: float | None) -> tuple[float, float]:
    """Check a time window [s] of a run; the default is the whole run."""
    path = run.path
    first = path.start if start is None else real("start", start, "s")
    last = path.end if end is None else real("end", end, "s")
    if not path.start <= first < last <= path.end * (1 + 1e-12):
        bound = f"the window must lie in the run, {path.start:g} ... {path.end:g} s, and end after its start"
        raise InvalidValue("start, end", (first, last), bound)
    return first, last
