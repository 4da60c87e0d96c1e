"""Power of a harvester over speed: voltage, strain of the layers and efficiency in the steady response."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import minimize_scalar

from beamdyn._version import __version__
from beamdyn.common.inputs.checks import BeyondModel, InvalidValue, real
from beamdyn.common.plots.plots import plot_harvest
from beamdyn.common.results.one_line import error_at_most, number, states, warned
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import LIMITS, Statement, announced, unannounced
from beamdyn.common.words import Named, Words
from beamdyn.equations.harvested import electric_rows, strain_rows
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.harvester import Electrodes
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import list_speeds
from beamdyn.steady.largest_over_phases import largest_over_phases
from beamdyn.steady.periodic_system import check_steady_state
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.steady.response import ResponseRequest, SteadyResponse, steady_response
from beamdyn.steady.vibration import combine_pairs, solve_parts, vibration_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DISTANCE = 2.0  # error over the distance from the response with more modes, as that of the tip
_RESONANT = 3  # modes whose resonances are listed
_DECADES, _GRID = 4.0, 33  # of the resistances that are tried first, either side of 1/(omega C)
_COMPARED = "with more modes, and without the harmonics of the last interaction"
_TOLERANCE = 1e-6  # of the best resistance, relative


@dataclass(frozen=True)
class Harvest(JudgedByRepeating):
    """Harvested power over speed, in the steady response.

    Power and efficiency are means over time, and over the phase between road and rotation where their rates
    are commensurate; voltage, current and strain are the largest over both.

    `model_error` and `left_out`, computed when asked for, are what the physics left out would change in the
    largest power.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    power : ndarray, shape (S,)
        Mean power into the load [W]; nan where there is no steady response.
    input_power : ndarray, shape (S,)
        Mean power into the vibration [W]: what is harvested, and what damps the beam.
    voltage, current : ndarray, shape (S,)
        Largest voltage across the load [V], and current through it [A].
    strain : ndarray, shape (S,)
        Largest bending strain of the layers.
    amplitude : ndarray, shape (S,)
        Largest tip deflection [m].
    error : ndarray, shape (S,)
        Estimated relative error of the power, or without a load of the voltage or current: by the harmonics
        and the modes left out.
    strain_error : ndarray, shape (S,)
        Estimated error of the strain by the modes left out.
    status : ndarray of str, shape (S,)
        As of `SteadyResponse`.
    resonances : ndarray, shape (r,)
        Speeds in the range at which the load is in resonance with a mode, short-circuited, or with an
        open circuit open [rad/s].
    warnings : tuple of str
        Limitations of the result, among them where the strain passes its limit.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> found = bd.harvest(bd.load_scene("examples/bimorph.toml"), [30.0, 60.0])
    >>> bool((found.efficiency < 1).all())
    True
    """

    speeds: np.ndarray
    power: np.ndarray
    input_power: np.ndarray
    voltage: np.ndarray
    current: np.ndarray
    strain: np.ndarray
    amplitude: np.ndarray
    error: np.ndarray
    strain_error: np.ndarray
    status: np.ndarray
    resonances: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    judged_value = "the largest power"
    follows_stiffness = False

    def headline(self) -> Iterator[str]:
        """The largest power, its speed and its error in one line; see `Result.headline`."""
        at, most = self.best
        yield f"{len(self.speeds)} speeds, {self.say_speed(self.speeds)}"
        yield f"up to {number(most, 'W')} at {self.say_speed(at)}"
        yield from (error_at_most(self.error), states(self.status, ("stable",)), warned(self.warnings))

    @property
    def best(self) -> tuple[float, float]:
        """The speed [rad/s] of the largest power, and that power [W]; nan where there is no response."""
        if not np.isfinite(self.power).any():
            return math.nan, math.nan
        k = int(np.nanargmax(self.power))
        return float(self.speeds[k]), float(self.power[k])

    @property
    def efficiency(self) -> np.ndarray:
        """Harvested power over that into the vibration, (S,); 0 where nothing vibrates."""
        into = np.where(self.input_power == 0, 1.0, self.input_power)
        return np.where(self.input_power == 0, 0.0, self.power / into)

    @property
    def strain_limit(self) -> float:
        """Largest strain that the layers bear; inf where none is given."""
        return _electrodes_of(self.scene).harvester.strain_limit

    def judged(self, found: Harvest) -> np.ndarray:
        """The largest power, of which the model error is stated: shape ()."""
        return np.array(found.best[1])

    @property
    def bending_speed(self) -> float:
        """Largest speed [rad/s], at which large deflection is judged."""
        return float(np.abs(self.speeds).max())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the power over speed, with the resonances."""
        return plot_harvest(self.speeds, self.power, self.resonances, ax, self.display_units)


@announced
@repeatable
def harvest(
    scene: Scene,
    speeds: np.ndarray | Sequence[float],
    modes: int | str = "auto",
    tolerance: float = 1e-5,
    discretization: DiscretizationChoice = "ritz",
) -> Harvest:
    """Compute the power that a piezoelectric beam harvests at given speeds, once the start has decayed.

    Gravity, road and what else the scene's motion excites act together; see `steady_response`.

    Parameters
    ----------
    scene : Scene
        The scene, of a beam with the layers of a `Harvester`.
    speeds : sequence of float
        Speeds [rad/s], ascending.
    modes, tolerance, discretization
        As for `steady_response`.

    Returns
    -------
    Harvest

    Raises
    ------
    ValueError
        If the beam carries no layers, an argument is out of its range, or the motion's steady state is not
        known.

    References
    ----------
    Circuit: Erturk and Inman (2009), Smart Materials and Structures 18, 025009; docs/harvester.md.

    Examples
    --------
    >>> found = bd.harvest(bd.load_scene("examples/bimorph.toml"), [50.0], modes=3)
    >>> bool(found.power[0] > 0)
    True
    """
    start = perf_counter()
    check_scene(scene)
    electrodes = _electrodes_of(scene)
    response = steady_response(scene, speeds, modes, None, tolerance, discretization)
    own, finer = _Powers.of(response.request), response.request.run_refined()
    relative, of_strain = np.full((2, len(response.speeds)), np.inf)
    if finer is not None:
        better = _Powers.of(finer.request)
        relative = _DISTANCE * own.apart(better)
        of_strain = _DISTANCE * np.abs(better.strain - own.strain)
    values = {name: np.where(response.stable, each, np.nan) for name, each in vars(own).items()}
    warnings = (*response.warnings, *_warn_of_strain(values["strain"], response.speeds, electrodes))
    return Harvest(
        speeds=response.speeds,
        amplitude=response.amplitude,
        error=relative + 2 * values.pop("truncation"),
        strain_error=of_strain,
        status=response.status,
        resonances=_resonances(response),
        warnings=warnings,
        provenance=Provenance(__version__, response.provenance.method, _COMPARED, perf_counter() - start),
        scene=response.scene,
        **values,
    )


def _electrodes_of(scene: Scene) -> Electrodes:
    """Electrodes of the beam; refused without."""
    if scene.beam.electrodes is None:
        remedy = Words(Named("Harvester.on(beam) puts them on", "a table [harvester] puts them on"))
        raise InvalidValue("harvester", None, "the beam carries no piezoelectric layers", remedy)
    return scene.beam.electrodes


def _warn_of_strain(strain: np.ndarray, speeds: np.ndarray, electrodes: Electrodes) -> Iterator[Statement]:
    """Yield a warning where the layers pass their limit."""
    limit = electrodes.harvester.strain_limit
    with np.errstate(invalid="ignore"):
        beyond = strain > limit
    if beyond.any():
        most = float(strain[beyond].max())
        where = list_speeds(speeds, beyond)
        said = f"the layers are strained by {most:.3g} at ", where, f": past their limit, {limit:.3g}"
        yield Statement(*said, kind=LIMITS, quantity="strain of the layers", value=most, limit=limit)


def _resonances(response: SteadyResponse) -> np.ndarray:
    """Speeds in the range at which the load is in resonance with a mode."""
    speeds, top = response.speeds, float(np.abs(response.speeds).max())
    if not top:
        return np.empty(0)
    with unannounced():
        crossings = resonance_speeds(response.scene, top, _RESONANT)
    found = np.array([c.speed for c in crossings if c.kind == "forced"])
    return found[(found >= speeds.min()) & (found <= speeds.max())]


@dataclass(frozen=True)
class _Powers:
    """Means and largest values at S speeds, with a common error of the harmonics."""

    power: np.ndarray
    input_power: np.ndarray
    voltage: np.ndarray
    current: np.ndarray
    strain: np.ndarray
    truncation: np.ndarray

    @classmethod
    def of(cls, request: ResponseRequest) -> _Powers:
        """Solve for all coordinates with the modal basis of a response."""
        motion, speeds = check_steady_state(request.scene.motion), request.speeds
        equations = request.model.modal_equations(request.basis)
        vibration = vibration_of(request.model, request.basis, motion, speeds)
        every = np.broadcast_to(np.eye(equations.size), (len(speeds), equations.size, equations.size))
        used, c, truncation = solve_parts(vibration.parts, every, request.harmonics, request.tolerance)
        pairs, q = combine_pairs(c, used, motion)
        rates = speeds[:, None] * np.array([1.0, motion.road_multiple or 0.0])
        omega = rates @ pairs.T  # of each line
        velocity = 1j * omega[:, None] * q
        voltage, current = (
            row.row @ (q if row.order == 0 else velocity)
            for row in electric_rows(equations, request.model.equations, request.scene.beam)
        )
        static = ~pairs.any(axis=1)
        halves = np.where(static, 1.0, 0.5)
        C = equations.matrices[1].get("unity", np.zeros((equations.size, equations.size)))
        spent = np.real(np.einsum("sil,ij,sjl->sl", velocity.conj(), C, velocity)) @ halves
        rows = strain_rows(equations, request.scene.beam)
        strain = [largest_over_phases(row[None] @ q, pairs) for row in rows]
        return cls(
            power=np.real(voltage.conj() * current) @ halves,
            input_power=spent,
            voltage=largest_over_phases(voltage[:, None], pairs),
            current=largest_over_phases(current[:, None], pairs),
            strain=np.max(strain, axis=0),
            truncation=truncation,
        )

    def apart(self, other: _Powers) -> np.ndarray:
        """Relative distance (S,) in power, or without a load in voltage or current; 0 where nothing flows."""
        found = np.zeros(len(self.power))
        for name in ("current", "voltage", "power"):
            own, its = getattr(self, name), getattr(other, name)
            np.divide(np.abs(its - own), own, out=found, where=own != 0)
        return found


# The best resistance ------------------------------------------------------------------------------


@announced
def best_resistance(
    scene: Scene,
    speed: float,
    modes: int | str = "auto",
    tolerance: float = 1e-5,
    discretization: DiscretizationChoice = "ritz",
) -> Harvest:
    """Find the load resistance of the largest mean power at a speed, by bounded search.

    Resistances are tried over four decades either side of 1/(omega C), with the first natural frequency, and
    the best is refined by Brent's method, to 1e-6 for the modes that are kept.

    Parameters
    ----------
    scene : Scene
        The scene, of a beam with the layers of a `Harvester`; its resistance does not matter.
    speed : float
        Speed [rad/s].
    modes, tolerance, discretization
        As for `steady_response`.

    Returns
    -------
    Harvest
        At that speed, of the scene with the best resistance: `scene.beam.electrodes.resistance` [ohm].

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
    >>> 1e3 < best.scene.beam.electrodes.resistance < 1e7  # ohm
    True
    """
    check_scene(scene)
    electrodes = _electrodes_of(scene)
    speed = real("speed", speed, "rad/s")
    loaded = with_resistance(scene, 1.0)
    response = steady_response(loaded, [speed], modes, None, tolerance, discretization)
    if not response.stable[0]:
        raise BeyondModel("speed", speed, f"{response.status[0]}: no steady response", "", "rad/s")
    request = response.request
    request = replace(request, discretization=request.model.discretization)
    first = math.sqrt(request.model.solver.lowest_at_rest)
    middle = math.log10(1 / (first * electrodes.capacitance(scene.beam.length)))

    def lost(decade: float) -> float:
        other = replace(request, scene=with_resistance(request.scene, 10.0**decade))
        return -float(_Powers.of(other).power[0])

    grid = np.linspace(middle - _DECADES, middle + _DECADES, _GRID)
    lowest = [lost(each) for each in grid]
    k = int(np.argmin(lowest))
    if not lowest[k] < 0:
        bound, remedy = "nothing vibrates at this speed", "give gravity, or a wavy road"
        if electrodes.coupling == 0:
            bound, remedy = "the layers do not couple: no voltage follows", "give e31 or d31"
        raise InvalidValue("speed", speed, bound, remedy, "rad/s")
    bounds = grid[max(k - 1, 0)], grid[min(k + 1, _GRID - 1)]
    best = minimize_scalar(lost, bounds=bounds, method="bounded", options={"xatol": _TOLERANCE / 3})
    chosen = with_resistance(scene, 10.0 ** float(best.x))
    return harvest(chosen, [speed], modes, tolerance, discretization)


def with_resistance(scene: Scene, resistance: float) -> Scene:
    """The scene with another load resistance [ohm] of its harvester."""
    electrodes = _electrodes_of(scene)
    loaded = replace(electrodes, harvester=replace(electrodes.harvester, resistance=resistance))
    return replace(scene, beam=replace(scene.beam, electrodes=loaded))
