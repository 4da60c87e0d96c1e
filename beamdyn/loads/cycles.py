"""Load cycles of a transient, by rainflow counting (ASTM E1049)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from time import perf_counter
from typing import ClassVar

import numpy as np

from beamdyn.common.inputs.checks import count, kind, positive
from beamdyn.common.plots.curves import plot_exceedance
from beamdyn.common.results.one_line import error_at_most, number, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.loads.stations import UNITS
from beamdyn.loads.transient_loads import EquivalentRange, TransientLoads, window_in
from beamdyn.modes.model_error.left_out_changes import SolvedValues
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.scene import Scene, SceneResult

TURNING_POINTS = 1e-6  # error of values at turning points, relative to the largest range


@dataclass(frozen=True)
class LoadCycles(SceneResult, JudgedByRepeating):
    """Load cycles of a quantity at one station, by rainflow counting.

    `left_out` contains the estimated relative change of the largest range by each neglected physical effect,
    `model_error` the magnitude of the sum of these changes; both are computed at first use.

    Parameters
    ----------
    quantity : str
        "force", "moment", "curvature", "strain" or "stress".
    component : int
        Index of the quantity's component.
    x : float
        Position along the beam [m].
    ranges : ndarray, shape (n,)
        Ranges of the cycles, from valley to peak [unit of the quantity].
    means : ndarray, shape (n,)
        Means of the cycles [unit of the quantity].
    counts : ndarray, shape (n,)
        Numbers of cycles: 1 for a full cycle, 0.5 for a half cycle.
    start, end : float
        The time window [s].
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        Program version and computing time.
    error : float
        Estimated error of each range: twice that of the values at turning points [unit of the quantity].

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), bd.SpinUp(55.0, duration=0.5))
    >>> cycles = bd.count_cycles(bd.transient_loads(bd.simulate(scene, t_end=0.5, modes=2), at=[0.0]))
    >>> cycles.ranges.shape == cycles.counts.shape
    True
    """

    quantity: str
    component: int
    x: float
    ranges: np.ndarray
    means: np.ndarray
    counts: np.ndarray
    start: float
    end: float
    error: float = field(default=math.nan, metadata=ADDED_LATER)

    # The loads whose cycles are counted; None in a result read from a file.
    loads: ClassVar[TransientLoads | None] = None

    def headline(self) -> Iterator[str]:
        """Yield number of cycles, position and largest range for a one-line summary.

        See `Result.headline`.
        """
        yield f"{number(self.counts.sum())} of {self.quantity} at {self.say_length(self.x)}"
        yield f"largest range {number(self.ranges.max(initial=0.0), UNITS[self.quantity])}"
        yield error_at_most(self.error, UNITS[self.quantity])
        yield warned(self.warnings)

    judged_value = "the largest range"

    def judged(self, found: LoadCycles) -> np.ndarray:
        """Return the largest range, for which the model error is stated: shape ()."""
        return np.array(found.ranges.max(initial=0.0))

    def solve(self, scene: Scene, name: str) -> SolvedValues:
        """Find the largest range with the effect `name` added to the scene.

        For large deflection, and for effects estimated from the natural frequency alone, the range is taken
        to change in proportion to the tip deflection; for other effects a simulation with the effect is run.
        """
        known = None if self.loads is None else self.loads.as_deflection(self.judged(self), name)
        return known or super().solve(scene, name)

    def bent_values(self, straight: np.ndarray, reason: str) -> SolvedValues:
        """Estimate the largest range with large deflection, scaled by the same factor as the tip deflection.

        `straight` is the largest range of the straight beam; it is returned, with the given `reason`, if no
        estimate is possible.
        """
        assert self.loads is not None, "the result was made by count_cycles"
        return self.loads.bent_values(straight, reason)

    @property
    def bending_speed(self) -> float:
        """Largest speed of the transient [rad/s], at which large deflection is estimated."""
        return 0.0 if self.loads is None else self.loads.bending_speed

    def equivalent_range(self, exponent: float, cycles: float = 1.0) -> float:
        """Compute the range of a number of equal cycles with the same damage, by Miner's rule.

        Parameters
        ----------
        exponent : float
            Exponent m of the Woehler curve: life is as range^-m; some 3 to 5 for steel, 10 for composites.
        cycles : float
            Number of equal cycles.

        Returns
        -------
        float
            Range (sum of counts range^m / cycles)^(1/m) [unit of the quantity].
        """
        m, number = positive("exponent", exponent), positive("cycles", cycles)
        largest = float(self.ranges.max(initial=0.0))
        if not largest:
            return 0.0
        return largest * float((self.counts * (self.ranges / largest) ** m).sum() / number) ** (1 / m)

    def equivalents(self, exponents: Sequence[float], cycles: float) -> tuple[EquivalentRange, ...]:
        """Compute equivalent ranges for several exponents, with their errors.

        Each counted range has an error of at most `error`; Minkowski's inequality combines them.
        """
        found = []
        for m in exponents:
            value = self.equivalent_range(m, cycles)
            of_range = self.error * (float(self.counts.sum()) / cycles) ** (1 / m)
            place = self.quantity, self.component, self.x, self.start, self.end
            found.append(EquivalentRange(*place, m, cycles, value, of_range))
        return tuple(found)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the number of cycles that exceed each range."""
        unit = UNITS[self.quantity] or "-"
        return plot_exceedance(self.ranges, self.counts, f"range of {self.quantity} [{unit}]", ax)


@repeatable
def count_cycles(
    loads: TransientLoads,
    quantity: str = "strain",
    station: int = 0,
    component: int = 0,
    start: float | None = None,
    end: float | None = None,
) -> LoadCycles:
    """Count the cycles of a quantity at one station from `start` to `end` [s], by rainflow counting.

    Turning points are sought at 32 times in each time step.  They are then refined by the interpolation of
    the transient, so that the error of their values is 1e-6 of the largest range.

    Parameters
    ----------
    loads : TransientLoads
        Loads along the span during a transient.
    quantity : {"strain", "stress", "curvature", "moment", "force"}
        The quantity.
    station : int
        Index of the station; 0 is the first.
    component : int
        Index of the component, such as the point of the section.
    start, end : float, optional
        The time window [s]; the whole run if not given.

    Returns
    -------
    LoadCycles

    Raises
    ------
    ValueError
        If an argument is out of its range.
    ImportError
        If the package `rainflow` is missing: the extra `fatigue` installs it.

    References
    ----------
    Rainflow counting: ASTM E1049; damage by Miner (1945).

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), bd.SpinUp(55.0, duration=0.5))
    >>> loads = bd.transient_loads(bd.simulate(scene, t_end=0.5, modes=2), at=[0.0])
    >>> bool(bd.count_cycles(loads, "strain").counts.sum() > 1)
    True
    """
    begin = perf_counter()
    kind("loads", loads, TransientLoads, "transient_loads makes one")
    loads.check_known(quantity)
    (chosen,) = loads.check_component(quantity, component)
    place = count("station", station, 0, len(loads.x) - 1)
    first, last = window_in(loads.run, start, end)
    try:
        from rainflow import extract_cycles  # imported here, because it is an optional dependency
    except ImportError:
        raise ImportError("count_cycles needs rainflow: pip install 'beamdyn[fatigue]'") from None
    index = loads.path.outputs.places[quantity].start + chosen
    values = loads.path.turning_values(place, index, first, last)
    counted = np.array([cycle[:3] for cycle in extract_cycles(values)]).reshape(-1, 3)
    of_values = float(loads.error_of(quantity)[place, chosen])
    of_turning_points = TURNING_POINTS * float(counted[:, 0].max(initial=0.0))
    made = LoadCycles(
        quantity=quantity,
        component=chosen,
        x=float(loads.x[place]),
        ranges=counted[:, 0],
        means=counted[:, 1],
        counts=counted[:, 2],
        start=first,
        end=last,
        warnings=loads.warnings,
        provenance=Provenance.since(begin, "rainflow counting (ASTM E1049)"),
        scene=loads.scene,
        error=2 * (of_values + of_turning_points),
    )
    vars(made)["loads"] = loads
    return made
