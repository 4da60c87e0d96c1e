"""The load resistance with which piezoelectric layers harvest most at a speed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from time import perf_counter
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from beamdyn.common.inputs.checks import BeyondModel, InvalidValue, real
from beamdyn.common.plots.harvests import plot_resistances
from beamdyn.common.results.one_line import error_at_most, number, states, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import announced
from beamdyn.common.words import supported
from beamdyn.linear.spectra import RoadRoughness
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.steady.harvest import ElectricLines, Harvest, electrodes_of, harvested
from beamdyn.steady.response import SteadyResponse, steady_response
from beamdyn.steady.road_harvest import check_road, harvest_on_road

# Decades tried first below 1/(first angular frequency * capacitance), and above it; above 1/(speed *
# capacitance) if the speed is lower, as slow motion is matched by that.
_DECADES = 4.0
_WIDTH, _HEIGHT = 7.5, 4.8  # width and height of the picture [inch]
_DIGITS = 6  # largest number of digits of a resistance
_NEAR = 1.0  # largest logarithm of the ratio of a tried resistance to the best one, for the curvature
# Assumed ratio of the relative errors of resistance and power, where log power has the curvature -1 over log
# resistance; it was at most 1 in each of 16 cases.
_LIKE_POWER = 2.0


@dataclass(frozen=True)
class ResistanceSearch:
    """Settings of the search for the best resistance.

    Parameters
    ----------
    tried : int
        Number of resistances that are tried before the refinement.
    tolerance : float
        Relative accuracy to which the best one is refined.
    compared : bool
        Whether the error of the harvested power is estimated, by comparison with larger models.
    """

    tried: int = 33
    tolerance: float = 1e-6
    compared: bool = True


FULL, ROUGH = ResistanceSearch(), ResistanceSearch(9, 1e-2, False)  # for a full and a preliminary result


@dataclass(frozen=True, kw_only=True)
class BestResistance(Harvest):
    """Harvested power at one speed with the best load resistance; the result's scene has this resistance.

    Parameters
    ----------
    resistances : ndarray, shape (R,)
        Resistances that were tried [ohm], ascending.
    tried_power : ndarray, shape (R,)
        Mean power with each tried resistance, including that by a random road [W].

    Examples
    --------
    >>> best = bd.best_resistance(bd.load_scene("examples/bimorph.toml"), 50.0, modes=2)
    >>> bool((best.tried_power <= best.power[0] * (1 + 1e-9)).all())
    True
    """

    resistances: np.ndarray
    tried_power: np.ndarray

    def headline(self) -> Iterator[str]:
        """Yield the resistance, and the power with its error, parts of a one-line summary.

        See `Result.headline`.
        """
        at, most = self.best
        yield f"best resistance {self.say_resistance()} at {self.say_speed(at)}"
        yield number(most, "W")
        yield from (error_at_most(self.total_error), states(self.status, ("stable",)), warned(self.warnings))

    @property
    def resistance(self) -> float:
        """The load resistance of the largest power [ohm]."""
        return electrodes_of(self.scene).resistance

    @property
    def resistance_error(self) -> float:
        """Estimated error of the resistance [ohm].

        An error of the power moves its maximum the further, the flatter the power is there: the relative
        error is twice that of the power, over the curvature of log power over log resistance, plus the
        tolerance of the search.  It is inf where the power has no maximum among the resistances tried.
        """
        x = np.log(self.resistances / self.resistance)
        near = np.abs(x) < _NEAR
        curvature = -2 * float(np.polyfit(x[near], np.log(self.tried_power[near]), 2)[0])
        moved = _LIKE_POWER * float(self.total_error[0]) / curvature if curvature > 0 else math.inf
        return (moved + FULL.tolerance) * self.resistance

    def say_resistance(self) -> str:
        """Return the best resistance as text, with the digits that its error leaves, where that is known."""
        if math.isnan(self.resistance_error):
            return number(self.resistance, "ohm")
        return f"{supported(self.resistance, self.resistance_error, _DIGITS)} ohm"

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the power over the resistances that were tried."""
        label = f"best, {self.say_resistance()}"
        return plot_resistances(self.resistances, self.tried_power, self.resistance, label, ax)

    plot_panels = plot

    def picture_size(self, width: float | None = None) -> tuple[float, float]:
        """Return width and height of the plot [inch], with the given width if there is one."""
        return width or _WIDTH, _HEIGHT


@announced
def best_resistance(
    scene: Scene,
    speed: float,
    modes: int | str = "auto",
    tolerance: float = 1e-5,
    discretization: DiscretizationChoice = "ritz",
    road: RoadRoughness | None = None,
) -> BestResistance:
    """Find the load resistance of the largest mean power at a speed, by bounded search.

    Resistances are tried over four decades on either side of 1/(omega C), with the first natural frequency
    and the capacitance of the layers; further above it if the speed is below that frequency.  The best is
    refined by Brent's method, to a relative accuracy of 1e-6.

    Parameters
    ----------
    scene : Scene
        The scene, of a beam with the layers of a `Harvester`; its resistance does not matter.
    speed : float
        Speed [rad/s].
    modes, tolerance, discretization
        As for `steady_response`.
    road : RoadRoughness, optional
        A random road, whose power is added to that of steady motion, as for `harvest`.

    Returns
    -------
    BestResistance
        The harvest at that speed, of the scene with the best resistance.

    Raises
    ------
    ValueError
        As `harvest`; or if there is no steady response at that speed, or no power by any resistance.

    References
    ----------
    One mode in closed form: docs/harvester.md.

    Examples
    --------
    >>> best = bd.best_resistance(bd.load_scene("examples/bimorph.toml"), 50.0, modes=2)
    >>> 1e3 < best.resistance < 1e7  # ohm
    True
    """
    return sought(FULL, scene, speed, modes, tolerance, discretization, road)


def sought(
    search: ResistanceSearch,
    scene: Scene,
    speed: float,
    modes: int | str,
    tolerance: float,
    discretization: DiscretizationChoice,
    road: RoadRoughness | None,
) -> BestResistance:
    """Find the best load resistance as `best_resistance` does, by a search with given settings."""
    start = perf_counter()
    check_scene(scene)
    electrodes = electrodes_of(scene)
    speed = real("speed", speed, "rad/s")
    if road is not None:
        check_road(scene, road)
    loaded = with_resistance(scene, 1.0)
    response = steady_response(loaded, [speed], modes, None, tolerance, discretization)
    if not response.stable[0]:
        raise BeyondModel("speed", speed, f"{response.status[0]}: no steady response", "", "rad/s")
    request = replace(response.request, discretization=response.request.model.discretization)
    response = replace(response, request=request)
    first = math.sqrt(request.model.solver.lowest_at_rest)
    slowest, C = min(first, abs(speed) or first), electrodes.capacitance(scene.beam.length)

    tried: dict[float, float] = {}

    def powers(decades: np.ndarray) -> np.ndarray:
        found = _powers(response, road, resistances := 10.0**decades)
        tried.update(zip(resistances.tolist(), found.tolist(), strict=True))
        return found

    ends = -math.log10(first * C) - _DECADES, -math.log10(slowest * C) + _DECADES
    grid = np.linspace(*ends, search.tried)
    k = int(np.argmax(highest := powers(grid)))
    if not highest[k] > 0:
        bound, remedy = "nothing vibrates at this speed", "give gravity, or a wavy road"
        if electrodes.coupling == 0:
            bound, remedy = "the layers do not couple: no voltage follows", "give e31 or d31"
        raise InvalidValue("speed", speed, bound, remedy, "rad/s")
    bounds = grid[max(k - 1, 0)], grid[min(k + 1, len(grid) - 1)]
    near = {"bounds": bounds, "method": "bounded", "options": {"xatol": search.tolerance / 3}}
    best = minimize_scalar(lambda decade: -powers(np.array([decade]))[0], **near)
    chosen = with_resistance(scene, 10.0 ** float(best.x))
    found = harvested(chosen, [speed], modes, tolerance, discretization, road, compared=search.compared)
    resistances, power = np.array(sorted(tried.items())).T
    values: dict[str, Any] = {each.name: getattr(found, each.name) for each in fields(found)}
    values["provenance"] = Provenance.since(start, found.provenance.method, found.provenance.compared_with)
    made = BestResistance(**values, resistances=resistances, tried_power=power)
    vars(made)["again"] = vars(found)["again"]  # the model error is computed with this resistance
    return made


def _powers(response: SteadyResponse, road: RoadRoughness | None, resistances: np.ndarray) -> np.ndarray:
    """Compute the mean power [W] with each load resistance [ohm], including that by a random road."""
    request = response.request
    found = ElectricLines.of_resistances(request, resistances).power
    if road is None:
        return found
    for k, resistance in enumerate(resistances.tolist()):
        other = replace(request, scene=with_resistance(request.scene, resistance))
        with_load = replace(response, request=other)
        found[k] += harvest_on_road(with_load, road, request.discretization, compared=False)[0].power[0]
    return found


def with_resistance(scene: Scene, resistance: float) -> Scene:
    """Return the scene with another load resistance [ohm] of its harvester."""
    electrodes = electrodes_of(scene)
    loaded = replace(electrodes, harvester=replace(electrodes.harvester, resistance=resistance))
    return replace(scene, beam=replace(scene.beam, electrodes=loaded))
