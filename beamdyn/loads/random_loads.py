"""Loads along the span under a random input, such as a rough road: mean squares and largest expected.

A stationary Gaussian process with the mean squares s^2 of its values and r^2 of their rates passes its mean
upwards nu = r / (2 pi s) times a second (Rice).  Of N = 2 nu T passages in the duration T, of both signs and
taken as independent, the largest is

    s (sqrt(2 ln N) + 0.5772 / sqrt(2 ln N))

on the average (Davenport (1964), Proceedings of the Institution of Civil Engineers 28, 187-196), and with the
probability p none passes s sqrt(2 ln(N / -ln p)).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.inputs.checks import InvalidValue, ascending, positive, refuse, within
from beamdyn.common.results.announced import announced_of_plain_beam
from beamdyn.common.results.digits import percent, supported
from beamdyn.common.results.one_line import counted, error_at_most, warned
from beamdyn.common.results.result import Provenance
from beamdyn.linear.choice import check_linear, model_of_few_modes, with_forces
from beamdyn.linear.convergence import Refined, evaluate_accurately
from beamdyn.linear.excitations import Excitation
from beamdyn.linear.mean_square import partial_fractions
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.linear.observations import DeflectionAt
from beamdyn.linear.parametric import ParametricTerm, parametric_term
from beamdyn.linear.random_input import highest_frequency, random_input, warn_of_band
from beamdyn.linear.spectra import PowerSpectrum, RoadRoughness
from beamdyn.linear.transfer import check_stable
from beamdyn.loads.load_fractions import LinearLoads, LoadFractions, largest_in_turn
from beamdyn.loads.section_points import SectionPoints, StationOutputs, sections_at
from beamdyn.loads.span_loads import UNITS, SpanLoads, placed, with_unit
from beamdyn.loads.stations import Positions, SpanStations, stations_at
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.static_load import warn_of_rotation
from beamdyn.scene.direction import ACROSS
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import warn_of_deflection, warn_of_elastic_limit, warn_of_left_out

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_TURN = 2 * np.pi
_HOUR = 3600.0
_FIRST_MODES = 4  # of a model that tells the sizes of the outputs
_OF_RATES = 1e3  # tolerance of rates over that of the others: peak factors follow their logarithm
_FEW = 10.0  # crossings in the duration, below which the largest is no matter of statistics
_LEAST = math.e  # crossings that the formula is evaluated with, at least
_DIGITS = 3  # of the largest that are expected: statistics have no more
_UNSURE = 0.05  # error over the largest, above which no digit of it may be sure
_SEVERAL = 3.0  # standard deviations that a deflection rarely passes


@dataclass(frozen=True)
class RandomStatistics:
    """Statistics of K outputs at S stations; the components of all quantities stand one after the other.

    Parameters
    ----------
    mean : ndarray, shape (S, K)
        Constant part, by the steady rotation [unit of the output].
    gravity : ndarray, shape (S, K)
        Amplitude of what gravity makes of it within a turn [same unit].
    rms : ndarray, shape (S, K)
        Root mean square of the random part, over time and over a turn [same unit].
    rms_in_turn : ndarray, shape (S, K)
        That at the angle of rotation at which it is largest [same unit].
    rate_rms : ndarray, shape (S, K)
        Root mean square of its rate [same unit / s].

    References
    ----------
    Rice (1944), Mathematical analysis of random noise; Davenport (1964), Proceedings of the Institution of
    Civil Engineers 28, 187-196.

    Examples
    --------
    >>> scene = bd.load_scene("examples/harvester_on_road.toml")
    >>> found = bd.random_loads(scene, 83.3, bd.RoadRoughness("C", highest=10.0), at=[0.0])
    >>> type(found.statistics).__name__
    'RandomStatistics'
    """

    mean: np.ndarray
    gravity: np.ndarray
    rms: np.ndarray
    rms_in_turn: np.ndarray
    rate_rms: np.ndarray

    @property
    def crossings(self) -> np.ndarray:
        """How often a second the random part passes 0 upwards [1/s], shape (S, K); 0 where there is none."""
        moving = self.rms > 0
        return np.where(moving, self.rate_rms, 0.0) / (_TURN * np.where(moving, self.rms, 1.0))

    def largest(self, factor: Callable[[np.ndarray], np.ndarray], duration: float) -> np.ndarray:
        """Largest magnitude (S, K), with a peak factor by the number of crossings of both signs."""
        count = np.maximum(2 * self.crossings * duration, _LEAST)
        return np.abs(self.mean) + self.gravity + factor(count) * self.rms_in_turn


def expected_factor(count: np.ndarray) -> np.ndarray:
    """Mean of the largest of so many crossings, over the root mean square."""
    root = np.sqrt(2 * np.log(count))
    return root + np.euler_gamma / root


def safe_factor(count: np.ndarray, probability: float) -> np.ndarray:
    """Quantile of the largest of so many crossings, with a probability, over the root mean square."""
    return np.sqrt(2 * np.log(np.maximum(count / -math.log(probability), 1.0)))


@dataclass(frozen=True)
class RandomLoads(SpanLoads):
    """Loads along the span under a random input at one speed: the largest magnitudes expected in a duration.

    The fields are those of `SpanLoads`, with one case, the speed.  The largest magnitudes are sums: of the
    constant part, the amplitude by gravity, and the root mean square of the random part, at the angle of
    rotation at which that is largest, times a peak factor.  They are estimates for a Gaussian input.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    duration : float
        Duration [s].
    statistics, statistics_error : RandomStatistics
        Statistics of all components, and their estimated errors; see `rms`, `mean` and others by quantity.
    parametric : ParametricTerm
        Size of the term left out, by which accelerations along the beam vary its stiffness.
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

    case: ClassVar[tuple[str, str]] = ("speed", "rad/s")

    def headline(self) -> Iterator[str]:
        """What it says in one line; see `Result.headline`."""
        yield f"{counted(len(self.x), 'station')} at {self.say_speed(self.speed)}"
        for name in ("moment", "strain"):
            if np.isfinite(self.values(name)).any():
                found = self.largest(name)
                yield f"{name} to {supported(found.value, found.error, _DIGITS)} {UNITS[name]}"
                yield error_at_most(self.error_of(name), UNITS[name])
        yield f"expected in {self.duration:g} s"
        yield warned(self.warnings)

    @property
    def cases(self) -> np.ndarray:
        """The speed [rad/s], shape (1,)."""
        return np.array([self.speed])

    def rms(self, quantity: str = "strain") -> np.ndarray:
        """Root mean square of the random part of a quantity, over time and over a turn: shape (S, k)."""
        return self._of(quantity, self.statistics.rms)

    def rms_error(self, quantity: str = "strain") -> np.ndarray:
        """Estimated error of `rms`, shape (S, k)."""
        return self._of(quantity, self.statistics_error.rms)

    def rms_in_turn(self, quantity: str = "strain") -> np.ndarray:
        """The same at the angle of rotation at which it is largest, shape (S, k)."""
        return self._of(quantity, self.statistics.rms_in_turn)

    def mean(self, quantity: str = "strain") -> np.ndarray:
        """Constant part of a quantity, by the steady rotation: shape (S, k)."""
        return self._of(quantity, self.statistics.mean)

    def gravity(self, quantity: str = "strain") -> np.ndarray:
        """Amplitude of what gravity makes of a quantity within a turn: shape (S, k)."""
        return self._of(quantity, self.statistics.gravity)

    def crossings(self, quantity: str = "strain") -> np.ndarray:
        """How often the random part of a quantity passes 0 upwards [1/s], by Rice: shape (S, k)."""
        return self._of(quantity, self.statistics.crossings)

    def quantile(self, quantity: str = "strain", probability: float = 0.99) -> np.ndarray:
        """Compute the magnitude that a quantity does not pass in the duration with a probability.

        It is a quantile of the largest magnitude.

        Parameters
        ----------
        quantity : {"strain", "stress", "curvature", "moment", "force"}
            The quantity.
        probability : float
            The probability, from 0.5 to 1 - 1e-9.

        Returns
        -------
        ndarray, shape (S, k)
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
        """Compute the one-sided density of a quantity at a station.

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
            Its unit squared per Hz.
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

    def plot(self, ax: Axes | None = None, quantity: str = "strain") -> Axes:
        """Draw the largest magnitude expected of a quantity along the span."""
        from beamdyn.common.plots.plots_along_span import plot_along_span

        self.check_known(quantity)
        label = f"largest {with_unit(quantity)} expected in {self.duration:g} s"
        values, labels = self.values(quantity), self.components(quantity)
        return plot_along_span(self.x, values, labels, label, ax, self.display_units)

    def _of(self, quantity: str, values: np.ndarray) -> np.ndarray:
        self.check_component(quantity, None)
        return values[:, self.outputs.places[quantity]]


@announced_of_plain_beam
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

    They follow from the loads and the inertia outboard of each station, not from the curvature of modes.  The
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
        Duration within which the largest are expected [s]; by default an hour.
    at, points, youngs_modulus
        As for `static_loads`.
    modes
        As for `random_response`.
    tolerance : float
        Truncation error aimed at by "auto", relative to the largest of each component along the span.
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
    start = perf_counter()
    duration = positive("duration", duration, "s")
    scene, speed = check_linear(scene, speed, modes if isinstance(modes, int) else None)
    drive, spectrum = _coloured_input(scene, speed, psd, input)
    stations = stations_at(scene.modelled_beam, at)
    sections = sections_at(scene, stations, points, youngs_modulus)
    asked = _InputAndOutputs(drive, spectrum, stations, StationOutputs.of_sections(sections))
    refined = asked.refine(with_forces(scene, [drive]), speed, modes, tolerance, discretization)
    found, error = RandomStatistics(*refined.value), RandomStatistics(*refined.error)
    parametric = parametric_term(refined.model, drive, spectrum)
    largest = asked.outputs.split(found.largest(expected_factor, duration)[None])
    of_largest = asked.outputs.split(_error_of_largest(found, error, duration)[None], "_error")
    return RandomLoads(
        **placed(scene, stations, sections),
        **largest,
        **of_largest,
        warnings=(
            *sections.notes,
            *warn_of_left_out(scene),
            *warn_of_rotation(refined.model.model, speed),
            *parametric.warnings(),
            *warn_of_band(spectrum, drive, refined.model),
            *_warn_of_few(found, duration),
            *_warn_of_few_modes(largest["moment"][0], of_largest["moment_error"][0], refined.model),
            *warn_of_deflection(_tip_deflection(refined.model, drive, spectrum), scene.beam.length),
            *warn_of_elastic_limit(largest["strain"]),
        ),
        provenance=Provenance(__version__, refined.method, refined.compared_with, perf_counter() - start),
        speed=speed,
        duration=duration,
        statistics=found,
        statistics_error=error,
        parametric=parametric,
        input=f"{drive.label} [{drive.unit}]",
        spectrum=spectrum,
        fractions=asked.fractions(refined.model),
        outputs=asked.outputs,
    )


def _coloured_input(
    scene: Scene, speed: float, psd: PowerSpectrum | RoadRoughness, input: Excitation | str | None
) -> tuple[Excitation, PowerSpectrum]:
    """The excitation and its density, refused if it is white: a cut moves with the input at once."""
    drive, spectrum = random_input(scene, speed, psd, input)
    if not isinstance(spectrum, PowerSpectrum):
        bound = "mean squares of loads by white noise are not finite"
        raise InvalidValue("psd", psd, bound, "give a PowerSpectrum, which ends at some frequency")
    return drive, spectrum


@dataclass(frozen=True)
class _InputAndOutputs:
    """A random input, and the outputs along the span whose statistics are asked for."""

    drive: Excitation
    spectrum: PowerSpectrum
    stations: SpanStations
    outputs: StationOutputs

    def fractions(self, model: ModelAtSpeed) -> tuple[LoadFractions, ...]:
        """Transfer functions from the input to the outputs, one for each harmonic of the rotation."""
        return LinearLoads(model, self.stations, self.outputs).fractions(self.drive)

    def statistics(self, model: ModelAtSpeed) -> np.ndarray:
        """The fields of `RandomStatistics`, in their order: shape (5, S, K)."""
        check_stable(model)
        fractions, spectrum = self.fractions(model), self.spectrum
        mean, gravity = LinearLoads(model, self.stations, self.outputs).steady()
        squares = [sum(each.mean_square(spectrum, order) for each in fractions) for order in (0, 2)]
        most = largest_in_turn(fractions, spectrum)
        rms, rate, in_turn = (_root(np.asarray(square)) for square in (*squares, most))
        return np.stack([mean, gravity, rms, in_turn, rate])

    def refine(
        self,
        loaded: Scene,
        speed: float,
        modes: int | str,
        tolerance: float,
        discretization: DiscretizationChoice,
    ) -> Refined:
        """`statistics` and their errors, nan where there is none, with as many modes as they need."""
        few = self.statistics(model_of_few_modes(loaded, speed, _FIRST_MODES, discretization))
        size = _sizes(few)

        def relative(model: ModelAtSpeed) -> np.ndarray:
            return np.nan_to_num(self.statistics(model)) / size

        top = _TURN * highest_frequency(self.spectrum) + abs(speed)
        refined = evaluate_accurately(loaded, speed, top, modes, tolerance, discretization, relative, 0)
        size = size * np.where(np.isnan(few), np.nan, 1.0)
        value = refined.value * size
        rounding = _rounding(self.fractions(refined.model), RandomStatistics(*value), self.spectrum)
        return replace(refined, value=value, error=refined.error * size + rounding)


def _sizes(statistics: np.ndarray) -> np.ndarray:
    """What errors of the statistics (5, S, K) are relative to, the largest along the span: (5, 1, K)."""
    size = np.nan_to_num(np.abs(statistics)).max(axis=1, keepdims=True)
    return np.where(size > 0, size, 1.0) * np.array([1, 1, 1, 1, _OF_RATES])[:, None, None]


def _root(squares: np.ndarray) -> np.ndarray:
    """Square roots (S, K) of sums that may round to less than 0."""
    return np.sqrt(np.maximum(squares, 0.0))


def _rounding(
    fractions: Sequence[LoadFractions], found: RandomStatistics, spectrum: PowerSpectrum
) -> np.ndarray:
    """Rounding errors of the fields of `RandomStatistics`, in their order: shape (5, S, K)."""
    value, rate = (sum(each.rounding(spectrum, order) for each in fractions) for order in (0, 2))
    pairs = (found.rms, value), (found.rms_in_turn, 2 * value), (found.rate_rms, rate)
    none = np.zeros_like(found.mean)
    return np.stack([none, none, *(np.hypot(rms, np.sqrt(square)) - rms for rms, square in pairs)])


def _error_of_largest(found: RandomStatistics, error: RandomStatistics, duration: float) -> np.ndarray:
    """Errors (S, K) of the largest expected: how far it rises with the errors of all statistics."""
    total = found.rms + error.rms
    with np.errstate(invalid="ignore"):
        less = np.where(np.isfinite(total) & (total > 0), found.rms**2 / np.where(total > 0, total, 1.0), 0.0)
    raised = RandomStatistics(
        np.abs(found.mean) + error.mean,
        found.gravity + error.gravity,
        less,
        found.rms_in_turn + error.rms_in_turn,
        found.rate_rms + error.rate_rms,
    )
    return raised.largest(expected_factor, duration) - found.largest(expected_factor, duration)


def _tip_deflection(model: ModelAtSpeed, drive: Excitation, spectrum: PowerSpectrum) -> np.ndarray:
    """Deflection of the tip in each modelled direction that it rarely passes [m], shape (d,)."""
    seen = [DeflectionAt(), DeflectionAt(direction=ACROSS)][: model.equations.planes]
    squares = [
        sum(
            partial_fractions(model, each, tip).mean_square(spectrum, h * model.speed / _TURN)
            for h, each in model.drives(drive).items()
        )
        for tip in seen
    ]
    return _SEVERAL * np.sqrt(squares)


def _warn_of_few(found: RandomStatistics, duration: float) -> Iterator[str]:
    """Yield a warning if the duration is too short for statistics of the largest."""
    crossings = found.crossings[found.rms > 0]
    if len(crossings) and duration * crossings.min() < _FEW:
        yield f"in {duration:g} s there are few vibrations: the largest expected are a rough guess"


def _warn_of_few_modes(moment: np.ndarray, error: np.ndarray, model: ModelAtSpeed) -> Iterator[str]:
    """Yield a warning if the modes left out may change the largest bending moment in its first digits."""
    if model.modes is not None and error.max() > _UNSURE * moment.max() > 0:
        share = percent(float(error.max() / moment.max()))
        yield (
            f"{model.modes} modes are too few: the estimated error of the bending moment is {share} of the "
            'largest; give more modes, or "auto"'
        )
