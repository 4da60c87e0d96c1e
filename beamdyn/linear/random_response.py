"""Random response at a steady speed: power spectral density and root mean square."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, ascending, refuse
from beamdyn.common.plots.plots import plot_frequency_response
from beamdyn.common.results.one_line import error_at_most, number, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import announced_of_plain_beam
from beamdyn.linear import inputs_outputs, mean_square, spectra
from beamdyn.linear.convergence import Refined, check_linear, evaluate_accurately, evaluate_also, with_forces
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear.transfer import check_stable, rounding_errors
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import warn_of_rotation
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.scene.validity import warn_of_deflection, warn_of_left_out

_TURN = 2 * np.pi
_POINTS = 500  # number of frequencies of a response to white noise, without those near resonances
_DECADES = 3  # number of decades from the lowest to the highest frequency of a response to white noise
# Number of trial functions up to which all are kept instead of modes: 0, that is never, because poles over so
# wide a range lose digits.
_DIRECT = 0
_SEVERAL = 3.0  # number of standard deviations that a deflection rarely exceeds


@dataclass(frozen=True)
class RandomResponse(SceneResult, JudgedByRepeating):
    """Response of a beam to a random input at a steady speed.

    Where the excitation has a fixed direction, the statistics vary within a turn, and the values are means
    over a turn: the density of the input appears shifted by the speed, upwards and downwards.

    `left_out` contains the estimated relative change of `rms` by each neglected physical effect,
    `model_error` the magnitude of the sum of these changes; both are computed at first use.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    rms : float
        Root mean square of the response over all frequencies [unit of the output].
    rms_error : float
        Estimated error of `rms`, due to the modes left out and the discretization [same unit].
    frequencies : ndarray, shape (F,)
        Frequencies of the response [Hz].
    psd : ndarray, shape (F,)
        One-sided power spectral density of the response at `frequencies` [unit of the output squared per Hz].
    psd_error : ndarray, shape (F,)
        Estimated error of `psd` [same unit].
    input_rms : float
        Root mean square of the input [unit of the input]; inf for white noise.
    parametric : ParametricTerm
        Size of the parametric term, which is left out: accelerations along the beam vary its stiffness.
    input, output : str
        The excitation and the observed quantity, with units.
    unit : str
        Unit of the output.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the response was computed.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> found = bd.random_response(scene, 50.0, bd.PowerSpectrum([5.0, 500.0], [1.0, 1.0]), input="bending")
    >>> found.unit, found.psd.shape == found.frequencies.shape
    ('m', True)
    """

    speed: float
    rms: float
    rms_error: float
    frequencies: np.ndarray
    psd: np.ndarray
    psd_error: np.ndarray
    input_rms: float
    parametric: mean_square.ParametricTerm
    input: str
    output: str
    unit: str

    def headline(self) -> Iterator[str]:
        """Yield the output's rms and its error for a one-line summary; see `Result.headline`."""
        yield f"{self.output.partition(' [')[0]} at {self.say_speed(self.speed)}"
        yield f"rms {number(self.rms, self.unit)}"
        yield from (error_at_most(self.rms_error, self.unit), warned(self.warnings))

    judged_value = "the root mean square"

    def judged(self, found: RandomResponse) -> np.ndarray:
        """Return the root mean square, for which the model error is stated: shape ()."""
        return np.array(found.rms)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the spectral density over frequency, on logarithmic axes."""
        unit = f"({self.unit})$^2$/Hz" if self.unit else "1/Hz"
        label = f"{self.output.partition(' [')[0]}, PSD [{unit}]"
        return plot_frequency_response([(self.frequencies, self.psd)], label, [""], ax)


@announced_of_plain_beam
@repeatable
def random_response(
    scene: Scene,
    speed: float,
    psd: spectra.PowerSpectrum | spectra.RoadRoughness | float,
    input: inputs_outputs.Excitation | str | None = None,
    output: inputs_outputs.Observation | str = "tip",
    frequencies: Sequence[float] | np.ndarray | None = None,
    modes: int | str = "auto",
    tolerance: float = 1e-9,
    discretization: DiscretizationChoice = "ritz",
) -> RandomResponse:
    """Compute the response to a stationary random input at a steady speed.

    The mean square is the integral of the density in closed form about each resonance: see
    `beamdyn.linear.mean_square`.  The parametric term is left out, and `parametric` states its size.

    Parameters
    ----------
    scene : Scene
        The scene, damped.  Of its motion only the rolling radius is used, for a road.
    speed : float
        Speed [rad/s].
    psd : PowerSpectrum, RoadRoughness or float
        One-sided density of the input; a road that the wheel of a `RollingWheel` follows; or the density of
        white noise, at all frequencies [unit of the input squared per Hz].
    input : BaseMotion, PointForce or str, optional
        As for `frequency_response`; that of a road is "n2".
    output : DeflectionAt, AccelerationAt, MomentAtRoot, StrainAtRoot or str
        As for `frequency_response`, including those of a harvester.
    frequencies : sequence of float, optional
        Frequencies at which the density of the response is computed [Hz], ascending from 0 or more.  By
        default those of the input, and others about resonances, so dense that straight lines between them
        have nearly the mean square as their area.
    modes : int or "auto"
        Number of modes at the speed of each set of coupled fields; "auto": the fewest with which the
        truncation error meets the tolerance.
    tolerance : float
        Target of the error for "auto", relative to the root mean square.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    RandomResponse

    Raises
    ------
    ValueError
        If an argument is out of its range, a density is negative, a mode is not damped, the speed is past
        the critical speed, or a road is given without a wheel.  With white noise, also if the output is
        neither a deflection nor the voltage of a harvester: its mean square is then not finite, or needs all
        modes.

    References
    ----------
    Spectral density |H|^2 G (standard), integrated by partial fractions (own: docs/responses.md); parametric
    term: Roberts and Spanos (1986), International Journal of Non-Linear Mechanics 21, 111-134.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> flat = bd.PowerSpectrum([5.0, 500.0], [1.0, 1.0])  # (m/s2)^2/Hz
    >>> found = bd.random_response(scene, 50.0, flat, input="bending", output="tip")
    >>> found.rms_error < 1e-6 * found.rms
    True
    """
    start = perf_counter()
    seen = inputs_outputs.as_observation("output", output)
    scene, speed = check_linear(scene, speed, modes if isinstance(modes, int) else None)
    drive, spectrum = spectra.random_input(scene, speed, psd, input)
    refined = root_mean_squares(scene, speed, drive, spectrum, [seen], modes, tolerance, discretization)
    model, rms = refined.model, float(refined.value[0])
    if frequencies is None:
        f = _frequencies(spectrum, model, drive)
    else:
        f = ascending("frequencies", frequencies)
        refuse(f < 0, "frequencies", f, "Hz", "give 0 or more")

    def density(model: ModelAtSpeed) -> np.ndarray:
        """Compute the one-sided density of the response at the frequencies f [Hz]."""
        shares = _shares(model, model.drives(drive), seen, spectrum, f)
        return sum((size**2 * S for _, size, S in shares), np.zeros(len(f)))

    of_psd, rounding = evaluate_also(refined, density), np.zeros(len(f))
    for k, (there, size, S) in enumerate(_shares(model, model.drives(drive), seen, spectrum, f)):
        moved = rounding_errors(model, drive, seen, there)[:, k]
        rounding += (2 * size + moved) * moved * S
    parametric = mean_square.parametric_term(model, drive, spectrum)
    return RandomResponse(
        speed=speed,
        rms=rms,
        rms_error=float(refined.error[0]),
        frequencies=f,
        psd=of_psd.value,
        psd_error=of_psd.error + rounding,
        input_rms=spectrum.rms if isinstance(spectrum, spectra.PowerSpectrum) else math.inf,
        parametric=parametric,
        input=f"{drive.label} [{drive.unit}]",
        output=f"{seen.label} [{seen.unit}]" if seen.unit else seen.label,
        unit=seen.unit,
        warnings=(
            *_warnings(scene, seen, rms, parametric),
            *warn_of_rotation(model.model, speed),
            *spectra.warn_of_band(spectrum, drive, model),
        ),
        provenance=Provenance.since(start, refined.method, refined.compared_with),
        scene=scene,
    )


# Computation of the response ----------------------------------------------------------------------


def root_mean_squares(
    scene: Scene,
    speed: float,
    drive: inputs_outputs.Excitation,
    spectrum: spectra.PowerSpectrum | float,
    outputs: Sequence[inputs_outputs.Observation],
    modes: int | str,
    tolerance: float,
    discretization: DiscretizationChoice,
) -> Refined:
    """Compute root mean squares (k,) of k outputs for one random input, with their errors.

    Parameters
    ----------
    scene, speed, modes, tolerance, discretization
        As for `random_response`, checked.
    drive, spectrum
        The input and its density, as `spectra.random_input` gives them.
    outputs : sequence of DeflectionAt, HarvestedVoltage or another output
        The quantities whose root mean squares are wanted.

    Raises
    ------
    InvalidValue
        If a mode is not damped, or with white noise an output is neither a deflection nor a voltage.
    """
    mean_square.check_damped(scene)
    finite = (inputs_outputs.DeflectionAt, inputs_outputs.HarvestedVoltage)
    for seen in outputs:
        if not isinstance(spectrum, spectra.PowerSpectrum) and type(seen) not in finite:
            bound = "with white noise its mean square is not finite, or needs all modes"
            raise InvalidValue("output", seen.label, bound, "give a PowerSpectrum, or a deflection")
    top = _TURN * spectra.highest_frequency(spectrum) + abs(speed)
    of_all = partial(rms_by, drive=drive, spectrum=spectrum, outputs=outputs)
    loaded = with_forces(scene, [drive])
    return evaluate_accurately(loaded, speed, top, modes, tolerance, discretization, of_all, _DIRECT)


def rms_by(
    model: ModelAtSpeed,
    drive: inputs_outputs.Excitation,
    spectrum: spectra.PowerSpectrum | float,
    outputs: Sequence[inputs_outputs.Observation],
) -> np.ndarray:
    """Compute the root mean squares (k,) of k outputs of a model; arguments as for `root_mean_squares`."""
    check_stable(model)
    drives = model.drives(drive)
    squares = (_mean_square(_expand(model, drives, seen), spectrum, model.speed) for seen in outputs)
    return np.sqrt([*squares])


def _frequencies(
    spectrum: spectra.PowerSpectrum | float, model: ModelAtSpeed, drive: inputs_outputs.Excitation
) -> np.ndarray:
    """Choose frequencies [Hz] so that straight lines between the densities enclose the mean square as area.

    For white noise they end at ten times the lowest resonance.
    """
    poles = mean_square.damped_motion(model).finite_poles
    if isinstance(spectrum, spectra.PowerSpectrum):
        shifts = [h * model.speed / _TURN for h in model.drives(drive)]
        return spectra.frequencies_of_response(spectrum, poles, shifts)
    resonances = np.abs(np.imag(poles[np.imag(poles) != 0])) / _TURN
    # If all modes are overdamped, the sizes of their poles replace the resonances.
    lowest = resonances if len(resonances) else np.abs(poles) / _TURN
    top = 10 * float(lowest.min())
    bottom, about = top / 10**_DECADES, spectra.about_resonances(poles)
    between = about[(about > bottom) & (about < top)]
    return spectra.one_of_each(np.concatenate([np.geomspace(bottom, top, _POINTS), between]))


def _expand(
    model: ModelAtSpeed, drives: Mapping[int, HarmonicDrive], seen: inputs_outputs.Observation
) -> dict[int, mean_square.PartialFractions]:
    return {h: mean_square.partial_fractions(model, each, seen) for h, each in drives.items()}


def _shares(
    model: ModelAtSpeed,
    drives: Mapping[int, HarmonicDrive],
    seen: inputs_outputs.Observation,
    spectrum: spectra.PowerSpectrum | float,
    f: np.ndarray,
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray | float]]:
    """Yield what each harmonic h of the rotation adds to the response at the frequencies f [Hz].

    That is the frequency f - h n of the input, with n turns per second, the magnitude of the transfer
    function from there, and the density of the input there.
    """
    for h, H in _expand(model, drives, seen).items():
        there = f - h * model.speed / _TURN
        S = spectrum.at(np.abs(there)) if isinstance(spectrum, spectra.PowerSpectrum) else spectrum
        yield there, np.abs(H(2j * np.pi * f)), S


def _mean_square(
    transfers: dict[int, mean_square.PartialFractions], spectrum: spectra.PowerSpectrum | float, speed: float
) -> float:
    """Compute the mean square, averaged over a turn: the sum over harmonics, which are uncorrelated."""
    if isinstance(spectrum, spectra.PowerSpectrum):
        return sum(H.mean_square(spectrum, h * speed / _TURN) for h, H in transfers.items())
    return sum(H.mean_square_of_white(spectrum) for H in transfers.values())


def _warnings(
    scene: Scene, seen: inputs_outputs.Observation, rms: float, parametric: mean_square.ParametricTerm
) -> Iterator[str]:
    yield from warn_of_left_out(scene)
    yield from parametric.warnings()
    if isinstance(seen, inputs_outputs.DeflectionAt) and not isinstance(seen, inputs_outputs.AccelerationAt):
        yield from warn_of_deflection(np.array([_SEVERAL * rms]), scene.beam.length)
