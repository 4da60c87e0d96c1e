"""Loads along the span under a random input, such as a rough road: mean squares and expected extremes.

In shapes of arrays, S counts stations, k components of a quantity, and d modelled directions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, ascending, positive, refuse, within
from beamdyn.common.results.one_line import counted, error_at_most, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.statements import announced_of_plain_beam
from beamdyn.common.words import percent, supported
from beamdyn.linear.convergence import check_linear, with_forces
from beamdyn.linear.inputs_outputs import DeflectionAt, Excitation
from beamdyn.linear.mean_square import ParametricTerm, check_damped, parametric_term, partial_fractions
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.linear.spectra import PowerSpectrum, RoadRoughness, random_input, warn_of_band
from beamdyn.loads.load_rows import barred_of_loads
from beamdyn.loads.load_statistics import (
    InputAndOutputs,
    LoadFractions,
    RandomStatistics,
    error_of_largest,
    expected_factor,
    safe_factor,
)
from beamdyn.loads.span_loads import AskedLoads, LoadCase, SpanLoads, with_unit
from beamdyn.loads.stations import UNITS, Positions, SectionPoints, StationOutputs
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import warn_of_rotation
from beamdyn.modes.repeated import repeatable
from beamdyn.scene.points import ACROSS
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import warn_of_deflection, warn_of_left_out

_TURN = 2 * np.pi
_HOUR = 3600.0
_FEW = 10.0  # number of zero crossings below which the statistics of the largest value do not hold
_DIGITS = 3  # largest number of digits shown of an expected largest value, which is an estimate
_UNSURE = 0.05  # relative error of the largest bending moment above which a warning is given
_SEVERAL = 3.0  # number of standard deviations that a deflection rarely exceeds


@dataclass(frozen=True)
class RandomLoads(SpanLoads):
    """Loads along the span under a random input at one speed: largest magnitudes expected in a duration.

    The fields are those of `SpanLoads`, with the speed as the only case.  Largest magnitudes are sums of
    three terms: the constant part, the amplitude due to gravity, and a peak factor times the root mean square
    of the random part, at the angle of rotation at which that is largest.  They are estimates for a Gaussian
    input.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    duration : float
        Duration [s].
    statistics, statistics_error : RandomStatistics
        Statistics of all components, and their estimated errors; see `rms`, `mean` and others by quantity.
    parametric : ParametricTerm
        Size of the parametric term, which is left out: accelerations along the beam vary its stiffness.
    input : str
        The input, with its unit.

    Examples
    --------
    >>> scene = bd.load_scene("examples/harvester_on_road.toml")
    >>> found = bd.random_loads(scene, 83.3, bd.RoadRoughness("C", highest=10.0), at=[0.0])
    >>> bool((found.quantile("strain", 0.99) > found.rms("strain")).all())
    True
    """

    speed: float
    duration: float
    statistics: RandomStatistics
    statistics_error: RandomStatistics
    parametric: ParametricTerm
    input: str
    spectrum: PowerSpectrum = field(repr=False)
    fractions: tuple[LoadFractions, ...] = field(repr=False)
    outputs: StationOutputs = field(repr=False)

    case: ClassVar[LoadCase] = LoadCase("speed", "rad/s", "speed")

    def headline(self) -> Iterator[str]:
        """Yield largest expected moment and strain, with errors, for a one-line summary.

        See `Result.headline`.
        """
        yield f"{counted(len(self.x), 'station')} at {self.say_speed(self.speed)}"
        for name in ("moment", "strain"):
            if np.isfinite(self.values(name)).any():
                found = self.largest(name)
                yield f"{name} to {supported(found.value, found.error, _DIGITS)} {UNITS[name]}"
                yield error_at_most(self.error_of(name), UNITS[name])
        yield f"expected in {self.duration:g} s"
        yield warned(self.warnings)

    def rms(self, quantity: str = "strain") -> np.ndarray:
        """Return the root mean square over time of a quantity's random part: (stations, components)."""
        return self._of(quantity, self.statistics.rms)

    def rms_error(self, quantity: str = "strain") -> np.ndarray:
        """Return the estimated error of `rms`, (stations, components)."""
        return self._of(quantity, self.statistics_error.rms)

    def rms_in_turn(self, quantity: str = "strain") -> np.ndarray:
        """Return a quantity's largest root mean square over the angle of rotation: (stations, components)."""
        return self._of(quantity, self.statistics.rms_in_turn)

    def mean(self, quantity: str = "strain") -> np.ndarray:
        """Return the constant part of a quantity, by the steady rotation: (stations, components)."""
        return self._of(quantity, self.statistics.mean)

    def gravity(self, quantity: str = "strain") -> np.ndarray:
        """Return the amplitude of a quantity's variation by gravity within a turn: (stations, components)."""
        return self._of(quantity, self.statistics.gravity)

    def crossings(self, quantity: str = "strain") -> np.ndarray:
        """Return the frequency of upward zero crossings of a quantity's random part [1/s]."""
        return self._of(quantity, self.statistics.crossings)

    def quantile(self, quantity: str = "strain", probability: float = 0.99) -> np.ndarray:
        """Compute the magnitude that a quantity does not exceed in the duration with a given probability.

        This is a quantile of the largest magnitude.

        Parameters
        ----------
        quantity : {"strain", "stress", "curvature", "moment", "force"}
            The quantity.
        probability : float
            Probability from 0.5 to 1 - 1e-9.

        Returns
        -------
        ndarray, shape (stations, components)
        """
        p = within("probability", probability, 0.5, 1 - 1e-9)
        return self._of(quantity, self.statistics.largest(lambda count: safe_factor(count, p), self.duration))

    def psd(
        self,
        frequencies: Sequence[float] | np.ndarray,
        quantity: str = "strain",
        station: int = 0,
        component: int = 0,
    ) -> np.ndarray:
        """Compute the one-sided power spectral density of a quantity at a station.

        Parameters
        ----------
        frequencies : sequence of float
            Frequencies [Hz], ascending from 0 or more, shape (F,).
        quantity : {"strain", "stress", "curvature", "moment", "force"}
            The quantity.
        station, component : int
            Index of the station, and of the point of the section or of the direction.

        Returns
        -------
        ndarray, shape (F,)
            Density [unit of the quantity squared per Hz].
        """
        f = ascending("frequencies", frequencies)
        refuse(f < 0, "frequencies", f, "Hz", "give 0 or more")
        (chosen,) = self.check_component(quantity, component)
        k = self.outputs.places[quantity].start + chosen
        total = np.zeros(len(f))
        for each in self.fractions:
            size = np.abs(each.at(2j * np.pi * f)[station, k]) ** 2
            total += size * self.spectrum.at(np.abs(f - each.shift))
        return total

    def plot(self, ax: Axes | None = None, quantity: str | None = None) -> Axes:
        """Plot the largest expected magnitude of a quantity along the span, by default `judged_quantity`."""
        quantity = quantity or self.judged_quantity
        label = f"largest {with_unit(quantity)} expected in {self.duration:g} s"
        return self.draw(ax, quantity, self.values, label)

    def _of(self, quantity: str, values: np.ndarray) -> np.ndarray:
        """Select the components (columns) of one quantity from the values of all quantities."""
        self.check_component(quantity, None)
        return values[:, self.outputs.places[quantity]]


@announced_of_plain_beam
@repeatable
def random_loads(
    scene: Scene,
    speed: float,
    psd: PowerSpectrum | RoadRoughness,
    input: Excitation | str | None = None,
    duration: float = _HOUR,
    at: Positions | None = None,
    points: SectionPoints | None = None,
    youngs_modulus: float | None = None,
    modes: int | str = "auto",
    tolerance: float = 1e-4,
    discretization: DiscretizationChoice = "ritz",
) -> RandomLoads:
    """Compute loads along the span under a stationary random input, at a steady speed.

    Loads follow from forces and inertia outboard of each station, not from the curvature of modes.  The
    equations are those of `random_response`, about the straight beam, with the same parametric term left out.

    Parameters
    ----------
    scene : Scene
        The scene, with modal damping.  Of its motion only the rolling radius is used, for a road.
    speed : float
        Speed [rad/s].
    psd : PowerSpectrum or RoadRoughness
        One-sided density of the input, or a road that the wheel of a `RollingWheel` follows.
    input : BaseMotion, PointForce or str, optional
        As for `random_response`.
    duration : float
        Duration [s] whose expected largest values are computed; by default an hour.
    at, points, youngs_modulus
        As for `static_loads`.
    modes
        As for `random_response`.
    tolerance : float
        Allowed error if `modes` is "auto", relative to each component's largest value along the span.
    discretization
        As for `random_response`.

    Returns
    -------
    RandomLoads

    Raises
    ------
    ValueError
        If an argument is out of its range, a point lies outside the section, a mode is not damped, the speed
        is past the critical speed, or the scene has springs along the span or damping that is not modal.

    References
    ----------
    Rice (1944), Mathematical analysis of random noise; Davenport (1964), Proceedings of the Institution of
    Civil Engineers 28, 187-196.

    Examples
    --------
    >>> scene = bd.load_scene("examples/harvester_on_road.toml")
    >>> found = bd.random_loads(scene, 83.3, bd.RoadRoughness("C", highest=10.0), at=[0.0])
    >>> found.rms("strain").shape
    (1, 2)
    """
    check_scene(scene)
    duration = positive("duration", duration, "s")
    scene, speed = check_linear(
        scene, speed, modes if isinstance(modes, int) else None, barred_of_loads(scene)
    )
    drive, spectrum = random_input(scene, speed, psd, input)
    check_damped(scene)
    if not isinstance(spectrum, PowerSpectrum):  # white noise, for which mean squares of loads are infinite
        bound = "mean squares of loads by white noise are not finite"
        raise InvalidValue("psd", psd, bound, "give a PowerSpectrum, which ends at some frequency")
    asked = AskedLoads.of(scene, at, points, youngs_modulus)
    of_input = InputAndOutputs(drive, spectrum, asked.stations, asked.outputs)
    refined = of_input.refine(with_forces(scene, [drive]), speed, modes, tolerance, discretization)
    found, error = RandomStatistics(*refined.value), RandomStatistics(*refined.error)
    parametric = parametric_term(refined.model, drive, spectrum)
    largest, of_largest = found.largest(expected_factor, duration), error_of_largest(found, error, duration)
    moments = asked.outputs.places["moment"]
    warnings = (
        *warn_of_left_out(scene),
        *warn_of_rotation(refined.model.model, speed),
        *parametric.warnings(),
        *warn_of_band(spectrum, drive, refined.model),
        *_warn_of_few(found, duration),
        *_warn_of_few_modes(largest[:, moments], of_largest[:, moments], refined.model),
        *warn_of_deflection(_tip_deflection(refined.model, drive, spectrum), scene.beam.length),
    )
    return RandomLoads(
        **asked.result(largest[None], of_largest[None], warnings, refined.method, refined.compared_with),
        speed=speed,
        duration=duration,
        statistics=found,
        statistics_error=error,
        parametric=parametric,
        input=f"{drive.label} [{drive.unit}]",
        spectrum=spectrum,
        fractions=of_input.fractions(refined.model),
        outputs=asked.outputs,
    )


def _tip_deflection(model: ModelAtSpeed, drive: Excitation, spectrum: PowerSpectrum) -> np.ndarray:
    """Compute three standard deviations of the tip deflection [m], in each modelled direction."""
    squares = [
        sum(
            partial_fractions(model, each, tip).mean_square(spectrum, h * model.speed / _TURN)
            for h, each in model.drives(drive).items()
        )
        for tip in [DeflectionAt(), DeflectionAt(direction=ACROSS)][: model.equations.planes]
    ]
    return _SEVERAL * np.sqrt(squares)


def _warn_of_few(found: RandomStatistics, duration: float) -> Iterator[str]:
    """Yield a warning if the duration is too short for statistics of the largest value."""
    crossings = found.crossings[found.rms > 0]
    if len(crossings) and duration * crossings.min() < _FEW:
        yield f"duration = {duration:g} s has under {_FEW:g} vibrations: maxima are rough; give a longer one"


def _warn_of_few_modes(moment: np.ndarray, error: np.ndarray, model: ModelAtSpeed) -> Iterator[str]:
    """Yield a warning if modes left out may change the first digits of the largest bending moment."""
    if model.modes is not None and error.max() > _UNSURE * moment.max() > 0:
        share = percent(float(error.max() / moment.max()))
        yield (
            f"with {counted(model.modes, 'mode')} the estimated error of the bending moment is {share} of "
            'the largest moment; give more modes, or "auto"'
        )
