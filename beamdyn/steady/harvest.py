"""Harvested power over speed, with voltage, layer strain and efficiency, in the steady response.

In shapes of arrays, S counts speeds, and L spectral lines.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.plots.harvests import HarvestPanel, panel_size, plot_harvest, plot_harvest_panels
from beamdyn.common.results.one_line import counted, error_at_most, number, states, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import LIMITS, Statement, announced, unannounced
from beamdyn.common.words import Named, Words
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.harvested import electric_rows, strain_rows
from beamdyn.linear.spectra import RoadRoughness
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import reduce_to_modes
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.harvester import Electrodes
from beamdyn.scene.motion.rolling import RollingWheel
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import list_speeds
from beamdyn.steady.largest_over_phases import largest_over_phases
from beamdyn.steady.periodic_system import (
    PeriodicSystem,
    check_steady_state,
    periodic_system,
    split_uncoupled,
)
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.steady.response import ResponseRequest, steady_response
from beamdyn.steady.road_harvest import SEVERAL, RoadHarvest, check_road, harvest_on_road
from beamdyn.steady.vibration import combine_pairs, solve_parts, vibration_of

# The estimated error is 2 times the largest difference from three responses with more modes.  With electrodes
# that end within the span, voltages converge irregularly: two responses could agree by chance.
_DISTANCE, _LARGER = 2.0, 3
_RESONANT = 3  # number of modes whose resonances are listed
_COMPARED = "responses with more modes; fewer harmonics, without the last product with the varying stiffness"
_POWER = "mean power [W]"


@dataclass(frozen=True)
class Harvest(SceneResult, JudgedByRepeating):
    """Harvested power of a piezoelectric beam over speed, in the steady response.

    Power and efficiency are means over time, and over the phase between road and rotation where their rates
    are commensurate; voltage, current and strain are the largest over both.

    `left_out` contains the estimated relative change of the largest power by each neglected physical effect,
    `model_error` the magnitude of the sum of these changes; both are computed at first use.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    power : ndarray, shape (S,)
        Mean power into the load [W]; nan where there is no steady response.
    input_power : ndarray, shape (S,)
        Mean power into the vibration [W]: the harvested power and that lost by damping.
    voltage, current : ndarray, shape (S,)
        Largest voltage across the load [V], and current through it [A].
    strain : ndarray, shape (S,)
        Largest bending strain of the layers (magnitude).
    amplitude : ndarray, shape (S,)
        Largest tip deflection [m].
    error : ndarray, shape (S,)
        Estimated relative error of the power; in open circuit of the voltage, in short circuit of the
        current.  It is due to the harmonics and the modes left out.
    strain_error : ndarray, shape (S,)
        Estimated absolute error of the strain, due to the modes left out.
    road : RoadHarvest, optional
        Harvest that a random road adds, where one is given.
    status : ndarray of str, shape (S,)
        Status as in `SteadyResponse`.
    resonances : ndarray, shape (r,)
        Speeds [rad/s], within the range of `speeds`, at which the excitation is in resonance with a mode of
        the beam with short-circuited layers or, for an open circuit, with open layers.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result, and of strains that exceed their limit.
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
    road: RoadHarvest | None = None

    judged_value = "the largest power"
    follows_stiffness = False

    def headline(self) -> Iterator[str]:
        """Yield the largest power, its speed and its error for a one-line summary; see `Result.headline`."""
        at, most = self.best
        yield f"{counted(len(self.speeds), 'speed')}, {self.say_speed(self.speeds)}"
        yield f"up to {number(most, 'W')} at {self.say_speed(at)}"
        yield from (error_at_most(self.total_error), states(self.status, ("stable",)), warned(self.warnings))

    @property
    def best(self) -> tuple[float, float]:
        """Speed [rad/s] of the largest mean power, and this power [W]; nan without a response."""
        power = self.total_power
        if not np.isfinite(power).any():
            return math.nan, math.nan
        k = int(np.nanargmax(power))
        return float(self.speeds[k]), float(power[k])

    @property
    def total_power(self) -> np.ndarray:
        """Mean power into the load [W] at each speed, including the power that a random road adds."""
        return self.power if self.road is None else self.power + self.road.power

    @property
    def total_error(self) -> np.ndarray:
        """Estimated relative error of `total_power`, from those of `power` and `road.power`.

        Where the total power is 0, it is the larger of the two errors.
        """
        if self.road is None:
            return self.error
        errors, powers = (self.error, self.road.error), (self.power, self.road.power)
        lost = sum(error * power for error, power in zip(errors, powers, strict=True))
        total = self.total_power
        return np.divide(lost, total, out=np.maximum(*errors), where=total > 0)

    @property
    def efficiency(self) -> np.ndarray:
        """Ratio of harvested power to power into the vibration; 0 where nothing vibrates."""
        into = np.where(self.input_power == 0, 1.0, self.input_power)
        return np.where(self.input_power == 0, 0.0, self.power / into)

    @property
    def strain_limit(self) -> float:
        """Largest strain that the layers can bear; inf if not given."""
        return electrodes_of(self.scene).harvester.strain_limit

    def judged(self, found: Harvest) -> np.ndarray:
        """Return the largest power of the result `found`, shape (): the value whose model error is stated."""
        return np.array(found.best[1])

    @property
    def as_far_as_judged(self) -> Mapping[str, Any]:
        """Arguments with which the model error repeats the analysis: numerical errors are not estimated."""
        return {"compared": False}

    @property
    def bending_speed(self) -> float:
        """Largest speed [rad/s], at which the change by large deflection is estimated."""
        return float(np.abs(self.speeds).max())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the power over speed, with the resonances, and the power that a random road (if any) adds."""
        curves = {"harvested": self.power}
        if self.road is not None:
            curves = {"by steady motion": self.power, "by a random road": self.road.power}
        panel = HarvestPanel(_POWER, curves)
        return plot_harvest(self.speeds, panel, self.resonances, self._radius, self.display_units, ax)

    def plot_panels(self, ax: Axes | None = None) -> Axes:
        """Plot power, voltage and strain over speed, each in a panel."""
        given = self.speeds, self._panels, self.resonances, self._radius, self.display_units
        return plot_harvest_panels(*given, ax)

    def picture_size(self, width: float | None = None) -> tuple[float, float]:
        """Return width and height of the plot of all panels [inch], for a given width if there is one."""
        return panel_size(len(self._panels), width)

    @property
    def _radius(self) -> float:
        """Radius of the rolling wheel [m]; 0 without a rolling wheel."""
        wheel = self.scene.motion
        return wheel.rolling_radius if isinstance(wheel, RollingWheel) else 0.0

    @property
    def _panels(self) -> list[HarvestPanel]:
        """Panels of the plot (power, voltage, strain), with curves of steady motion and of a random road."""

        def panel(label: str, steady: np.ndarray, name: str, limit: float = math.inf) -> HarvestPanel:
            curves = {"steady motion: mean power, else largest": steady}
            if self.road is not None:
                curves["random road: mean power, else rms"] = getattr(self.road, name)
            return HarvestPanel(label, curves, limit)

        return [
            panel(_POWER, self.power, "power"),
            panel("voltage [V]", self.voltage, "voltage"),
            panel("strain of the layers", self.strain, "strain", self.strain_limit),
        ]


@announced
def harvest(
    scene: Scene,
    speeds: np.ndarray | Sequence[float],
    modes: int | str = "auto",
    tolerance: float = 1e-5,
    discretization: DiscretizationChoice = "ritz",
    road: RoadRoughness | None = None,
) -> Harvest:
    """Compute the power that a piezoelectric beam harvests at given speeds, after the initial transient.

    Gravity, road and all other excitations by the scene's motion act together; see `steady_response`.

    Parameters
    ----------
    scene : Scene
        The scene, of a beam with the layers of a `Harvester`.
    speeds : sequence of float
        Speeds [rad/s], ascending.
    modes, tolerance, discretization
        As for `steady_response`.
    road : RoadRoughness, optional
        A random road that the wheel of a `RollingWheel` follows, in addition to the waves of its motion.

    Returns
    -------
    Harvest

    Raises
    ------
    ValueError
        If the beam carries no layers, an argument is out of its range, or the motion's steady state is not
        known; or with a random road, if the scene has no rolling wheel or no damping.

    References
    ----------
    Circuit: Erturk and Inman (2009), Smart Materials and Structures 18, 025009; docs/harvester.md.

    Examples
    --------
    >>> found = bd.harvest(bd.load_scene("examples/bimorph.toml"), [50.0], modes=3)
    >>> bool(found.power[0] > 0)
    True
    """
    return harvested(scene, speeds, modes, tolerance, discretization, road)


@one_blas_thread()  # the matrices are small: more threads only wait for each other
def harvested(
    scene: Scene,
    speeds: np.ndarray | Sequence[float],
    modes: int | str,
    tolerance: float,
    discretization: DiscretizationChoice,
    road: RoadRoughness | None,
    compared: bool = True,
) -> Harvest:
    """Compute the result of `harvest` from its arguments.

    Unless `compared` is true, there is no comparison with models of more modes, and the errors are nan.
    """
    start = perf_counter()
    powers = _powers(scene, speeds, modes, tolerance, discretization, road, compared)
    resonances = _resonances(powers.scene, powers.speeds)
    # The provenance is built again, so that the computing time includes the search for resonances.
    provenance = Provenance.since(start, powers.provenance.method, _COMPARED)
    found = replace(powers, resonances=resonances, provenance=provenance)
    vars(found)["again"] = powers.again  # the model error repeats the powers only, without resonances
    return found


@repeatable
def _powers(
    scene: Scene,
    speeds: np.ndarray | Sequence[float],
    modes: int | str,
    tolerance: float,
    discretization: DiscretizationChoice,
    road: RoadRoughness | None,
    compared: bool,
) -> Harvest:
    """Compute the result of `harvested` without the resonances.

    It is a function of its own because the model error repeats it, and needs no resonances.
    """
    start = perf_counter()
    check_scene(scene)
    electrodes = electrodes_of(scene)
    if road is not None:
        check_road(scene, road)
    response = steady_response(scene, speeds, modes, None, tolerance, discretization)
    own = HarvestedPowers.of(response.request)
    refined = _refinements(response.request) if compared else ()
    larger = [HarvestedPowers.of(request) for request in refined]
    relative, of_strain = np.full((2, len(response.speeds)), np.inf if compared else np.nan)
    if larger:
        relative = _DISTANCE * np.max([own.apart(each) for each in larger], axis=0)
        of_strain = _DISTANCE * np.max([np.abs(each.strain - own.strain) for each in larger], axis=0)
    values = {name: np.where(response.stable, each, np.nan) for name, each in vars(own).items()}
    warnings, on_road, most = [*response.warnings], None, values["strain"]
    if road is not None:
        on_road, said = harvest_on_road(response, road, discretization, compared)
        warnings, most = [*warnings, *said], most + SEVERAL * on_road.strain
    how = "" if road is None else f", with {SEVERAL:g} standard deviations of the response to the road,"
    warnings += _warn_of_strain(most, response.speeds, electrodes, how)
    return Harvest(
        speeds=response.speeds,
        amplitude=response.amplitude,
        error=relative + 2 * values.pop("truncation"),
        strain_error=of_strain,
        status=response.status,
        resonances=np.empty(0),
        warnings=tuple(warnings),
        road=on_road,
        provenance=Provenance.since(start, response.provenance.method, _COMPARED),
        scene=response.scene,
        **values,
    )


def _refinements(request: ResponseRequest) -> Iterator[ResponseRequest]:
    """Yield up to three requests, each with 1.5 times as many modes as the one before.

    There are fewer if the discretization has no model with so many modes.
    """
    for _ in range(_LARGER):
        if (finer := request.refined()) is None:
            return
        yield (request := finer)


def electrodes_of(scene: Scene) -> Electrodes:
    """Return the electrodes of the beam; raise `InvalidValue` if it has none."""
    if scene.beam.electrodes is None:
        remedy = Named("Harvester.on(beam) puts them on", "a table [harvester] puts them on")
        raise ValueError(Words("the beam carries no piezoelectric layers; ", remedy))
    return scene.beam.electrodes


def _warn_of_strain(
    strain: np.ndarray, speeds: np.ndarray, electrodes: Electrodes, how: str
) -> Iterator[Statement]:
    """Yield a warning if the layers' strain exceeds its limit; `how` states what the strain includes."""
    limit = electrodes.harvester.strain_limit
    with np.errstate(invalid="ignore"):
        beyond = strain > limit
    if beyond.any():
        most = float(strain[beyond].max())
        where = list_speeds(speeds, beyond)
        said = f"the layers are strained by {most:.3g}{how} at ", where, f": past their limit, {limit:.3g}"
        yield Statement(*said, kind=LIMITS, quantity="strain of the layers", value=most, limit=limit)


def _resonances(scene: Scene, speeds: np.ndarray) -> np.ndarray:
    """Find the speeds [rad/s], in the range of `speeds`, at which the excitation resonates with a mode."""
    top = float(np.abs(speeds).max())
    if not top:
        return np.empty(0)
    with unannounced():
        crossings = resonance_speeds(scene, top, _RESONANT)
    found = np.array([c.speed for c in crossings if c.kind == "forced"])
    return found[(found >= speeds.min()) & (found <= speeds.max())]


@dataclass(frozen=True)
class ElectricLines:
    """The spectral lines of steady motion at S speeds: complex amplitudes of coordinates, voltage, current.

    Parameters
    ----------
    equations : Equations
        Equations of the n coordinates.
    pairs : ndarray, shape (lines, 2)
        Harmonic (j, k) of each line: multiples of the speed and of the road's frequency, whose sum is its
        frequency.
    coordinates, velocity : ndarray, shape (S, n, lines)
        Coordinates, and their rates.
    voltage, current : ndarray, shape (S, lines)
        Voltage [V] and current [A].
    truncation : ndarray, shape (S,)
        Relative error by the harmonics left out.
    """

    equations: Equations
    pairs: np.ndarray
    coordinates: np.ndarray
    velocity: np.ndarray
    voltage: np.ndarray
    current: np.ndarray
    truncation: np.ndarray

    @classmethod
    def of(cls, request: ResponseRequest) -> ElectricLines:
        """Compute the lines of the steady response that a request asks for."""
        equations = request.model.modal_equations(request.basis)
        motion = check_steady_state(request.scene.motion)
        vibration = vibration_of(request.model, request.basis, motion, request.speeds)
        return cls.of_parts(request, request.speeds, equations, vibration.parts)

    @classmethod
    def of_resistances(cls, request: ResponseRequest, resistances: np.ndarray) -> ElectricLines:
        """Compute the lines for S load resistances [ohm] in place of S speeds, at a request's first speed."""
        mechanical = reduce_to_modes(request.model.equations, request.basis)
        assert mechanical.circuit is not None, "the beam has a load"
        circuits = (replace(mechanical.circuit, resistance=each) for each in resistances.tolist())
        equations = [replace(mechanical, circuit=each).with_flux() for each in circuits]
        speeds = np.full(len(equations), request.speeds[0])
        system = periodic_system(equations, request.scene.motion, speeds)
        lines = cls.of_parts(request, speeds, equations[0], split_uncoupled(system, equations[0]))
        return replace(lines, current=lines.voltage / resistances[:, None])

    @classmethod
    def of_parts(
        cls,
        request: ResponseRequest,
        speeds: np.ndarray,
        equations: Equations,
        parts: list[tuple[PeriodicSystem, np.ndarray]],
    ) -> ElectricLines:
        """Compute the lines at S speeds from the equations, given in uncoupled parts.

        Each of the `parts` has the indices of its coordinates.
        """
        motion = check_steady_state(request.scene.motion)
        every = np.broadcast_to(np.eye(equations.size), (len(speeds), equations.size, equations.size))
        used, c, truncation = solve_parts(parts, every, request.harmonics, request.tolerance)
        pairs, q = combine_pairs(c, used, motion)
        rates = speeds[:, None] * np.array([1.0, motion.road_multiple or 0.0])
        omega = rates @ pairs.T  # angular frequency of each line
        velocity = 1j * omega[:, None] * q
        voltage, current = (
            row.row @ (q if row.order == 0 else velocity)
            for row in electric_rows(equations, request.model.equations, request.scene.beam)
        )
        return cls(equations, pairs, q, velocity, voltage, current, truncation)

    @property
    def halves(self) -> np.ndarray:
        """Factors (lines,) that convert products of two amplitudes of a line to means over time.

        They are 1 for a static line, else 1/2.
        """
        return np.where(self.pairs.any(axis=1), 0.5, 1.0)

    @property
    def power(self) -> np.ndarray:
        """Mean power into the load [W], shape (S,)."""
        return np.real(self.voltage.conj() * self.current) @ self.halves


@dataclass(frozen=True)
class HarvestedPowers:
    """Mean powers, and largest voltage, current and strain, at S speeds.

    The fields are as in `Harvest`; `truncation` is the relative error by the harmonics left out.
    """

    power: np.ndarray
    input_power: np.ndarray
    voltage: np.ndarray
    current: np.ndarray
    strain: np.ndarray
    truncation: np.ndarray

    @classmethod
    def of(cls, request: ResponseRequest) -> HarvestedPowers:
        """Compute the steady response that a request asks for, and from it powers and largest values."""
        lines = ElectricLines.of(request)
        equations, pairs, q, velocity = lines.equations, lines.pairs, lines.coordinates, lines.velocity
        C = equations.matrices[1].get("unity", np.zeros((equations.size, equations.size)))
        spent = np.real(np.einsum("sil,ij,sjl->sl", velocity.conj(), C, velocity)) @ lines.halves
        strain = strain_rows(equations, request.scene.beam) @ q
        largest = largest_over_phases(np.concatenate(strain)[:, None], pairs)
        return cls(
            power=lines.power,
            input_power=spent,
            voltage=largest_over_phases(lines.voltage[:, None], pairs),
            current=largest_over_phases(lines.current[:, None], pairs),
            strain=largest.reshape(strain.shape[:2]).max(axis=1),
            truncation=lines.truncation,
        )

    def apart(self, other: HarvestedPowers) -> np.ndarray:
        """Compute the relative difference from another result at each speed.

        It is the difference in power; if the power is 0, that in voltage; if this is 0 too, that in current.
        """
        found = np.zeros(len(self.power))
        for name in ("current", "voltage", "power"):
            own, its = getattr(self, name), getattr(other, name)
            np.divide(np.abs(its - own), own, out=found, where=own != 0)
        return found
