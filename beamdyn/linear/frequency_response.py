"""Frequency response at a steady speed: deflection, acceleration, moment or strain due to one excitation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from beamdyn.common.inputs.checks import BeyondModel, ascending, refuse
from beamdyn.common.plots.plots import plot_frequency_response
from beamdyn.common.results.one_line import error_at_most, number, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import announced_of_plain_beam
from beamdyn.linear.convergence import Refined, check_linear, evaluate_accurately, with_forces
from beamdyn.linear.inputs_outputs import Excitation, Observation, as_excitation, as_observation
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.linear.resonance_peaks import ResonancePeaks, find_peaks
from beamdyn.linear.transfer import check_stable, rounding_errors, transfer
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import warn_of_rotation
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.scene.validity import warn_of_left_out

_TURN = 2 * np.pi
_HIGHEST = 1e12  # highest accepted frequency [Hz]: atoms vibrate at it, so that beam theory ends below
_DIRECT = 300  # number of trial functions up to which all are kept, at some milliseconds per frequency


@dataclass(frozen=True)
class FrequencyResponse(SceneResult, JudgedByRepeating):
    """Frequency response of a beam to a harmonic excitation at a steady speed.

    An input Re(u exp(i 2 pi f t)) gives the sum of Re(H_h u exp(i 2 pi (f + h n) t)) over the harmonics h of
    the rotation, with n turns per second; h = 0 is the only one unless the excitation has a fixed direction.

    `error` is numerical.  `left_out` contains the estimated relative change of the largest response (at the
    given frequencies or at a peak between them) by each neglected physical effect, `model_error` the
    magnitude of the sum of these changes; both are computed at first use.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    frequencies : ndarray, shape (F,)
        Frequencies f of the excitation [Hz].
    response : ndarray of complex, shape (F, k)
        Frequency response H at each frequency for each harmonic [unit of the output per unit of the input].
    harmonics : ndarray of int, shape (k,)
        The harmonics h: 0, or -1 and 1.
    error : ndarray, shape (F, k)
        Estimated error of the response [same unit]: its distance from that of more modes and of a coarser
        discretization, each with a margin, and rounding.
    peaks : beamdyn.linear.resonance_peaks.ResonancePeaks
        Peaks between the lowest and the highest frequency, also between grid points: `frequency`, `size`,
        half-power `bandwidth`, and their errors.
    input, output : str
        The excitation and the observed quantity, with units.
    unit : str
        Unit of the response.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the response was computed.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> found = bd.frequency_response(scene, 50.0, np.geomspace(10, 200, 20))
    >>> found.input, found.output, found.response.shape
    ('base acceleration, bending [m/s2]', 'deflection at the tip [m]', (20, 1))
    """

    speed: float
    frequencies: np.ndarray
    response: np.ndarray
    harmonics: np.ndarray
    error: np.ndarray
    peaks: ResonancePeaks
    input: str
    output: str
    unit: str

    def headline(self) -> Iterator[str]:
        """Yield the largest response, its frequency and its error for a one-line summary.

        See `Result.headline`.
        """
        at, size = self.peak
        names = [text.partition(" [")[0] for text in (self.output, self.input)]
        yield f"{number(size, self.unit)} at {number(at, 'Hz')} and {self.say_speed(self.speed)}"
        yield from (error_at_most(self.error), warned(self.warnings), " by ".join(names))

    @property
    def response_frequencies(self) -> np.ndarray:
        """Frequencies f + h n of the response [Hz], with n turns per second: a column for each h."""
        return self.frequencies[:, None] + self.harmonics * self.speed / _TURN

    @property
    def peak(self) -> tuple[float, float]:
        """Excitation frequency [Hz] and magnitude of the largest response, also between given frequencies."""
        found = [(size.max(), f[size.argmax()]) for f, size in map(self._curve, range(len(self.harmonics)))]
        size, at = max(found)
        return float(at), float(size)

    judged_value = "the largest response"

    def judged(self, found: FrequencyResponse) -> np.ndarray:
        """Return the largest response (see `peak`), for which the model error is stated: shape ()."""
        return np.array(found.peak[1])

    def _curve(self, column: int) -> tuple[np.ndarray, np.ndarray]:
        """Return given and peak frequencies [Hz], ascending, and the response's sizes at one harmonic."""
        own = (self.peaks.harmonic == self.harmonics[column]) & np.isfinite(self.peaks.size)
        f = np.concatenate([self.frequencies, self.peaks.frequency[own]])
        size = np.concatenate([np.abs(self.response[:, column]), self.peaks.size[own]])
        order = np.argsort(f, kind="stable")
        return f[order], size[order]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the magnitude over the excitation frequency, with its peaks, on logarithmic axes."""
        labels = [{0: "", -1: "answer at f - n", 1: "answer at f + n"}[h] for h in self.harmonics.tolist()]
        value = f"{self.output.partition(' [')[0]} [{self.unit}]"
        curves = [self._curve(k) for k in range(len(labels))]
        return plot_frequency_response(curves, value, labels, ax)


@announced_of_plain_beam
@repeatable
def frequency_response(
    scene: Scene,
    speed: float,
    frequencies: Sequence[float] | np.ndarray,
    input: Excitation | str = "bending",
    output: Observation | str = "tip",
    modes: int | str | None = "auto",
    tolerance: float = 1e-9,
    discretization: DiscretizationChoice = "ritz",
) -> FrequencyResponse:
    """Compute the response to a harmonic excitation at a steady speed, over frequency.

    Small motions about the straight beam are superposed from modes at the speed; all modes left out are
    represented by their static deflection.  The parametric term is not included: an acceleration along the
    beam varies the beam's stiffness, which causes responses at other frequencies, too; `random_response`
    states its size.

    Parameters
    ----------
    scene : Scene
        The scene; its motion and gravity are not used.
    speed : float
        Speed [rad/s].
    frequencies : sequence of float
        Frequencies of the excitation [Hz], ascending from 0 or more, to 1e12.
    input : BaseMotion, PointForce or str
        Excitation of the beam.  A word may stand for it: "bending", "across", "n1", "n2" and "n3" are
        accelerations of the base [m/s2], "tip force" and "tip force across" are forces [N].
    output : DeflectionAt, AccelerationAt, MomentAtRoot, StrainAtRoot or str
        Observed quantity.  A word may stand for it: "tip", "tip across", "tip acceleration", "root moment" or
        "root strain".  Of a harvester, HarvestedVoltage, HarvestedCurrent or LayerStrain: "voltage",
        "current" or "layer strain".
    modes : int, "auto" or None
        Number of modes at the speed of each set of coupled fields; "auto": all functions of the
        discretization up to 300 of them, else the fewest modes with which the truncation error meets the
        tolerance; None keeps all functions.
    tolerance : float
        Target of the error for "auto", relative to the largest response.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    FrequencyResponse

    Raises
    ------
    ValueError
        If an argument is out of its range, the speed is past the critical speed, or an undamped beam is
        excited at a natural frequency.

    References
    ----------
    Modes with the residual flexibility of all others: Craig and Kurdila (2006), Fundamentals of Structural
    Dynamics, section 11.4.

    Examples
    --------
    >>> scene = bd.load_scene("examples/rough_road.toml")
    >>> found = bd.frequency_response(scene, 50.0, [20.0, 200.0], input="n2", output="root strain")
    >>> found.response.shape, found.unit  # answers at f - n and f + n
    ((2, 2), '1 per m/s2')
    """
    start = perf_counter()
    given = ascending("frequencies", frequencies)
    refuse(given < 0, "frequencies", given, "Hz", "give 0 or more")
    refuse(given > _HIGHEST, "frequencies", given, "Hz", "give at most {limit}", limit=_HIGHEST)
    drive, seen = as_excitation("input", input), as_observation("output", output)
    scene, speed = check_linear(scene, speed, modes if isinstance(modes, int) else None)

    def evaluate(model: ModelAtSpeed) -> np.ndarray:
        check_stable(model)
        return transfer(model, drive, seen, given)[1]

    top = _TURN * float(given[-1]) + abs(speed)
    refined: Refined = evaluate_accurately(
        with_forces(scene, [drive]), speed, top, modes, tolerance, discretization, evaluate, _DIRECT
    )
    band = float(given[0]), float(given[-1])
    if not np.isfinite(refined.value).all():
        bad = given[~np.isfinite(refined.value).all(axis=1)][0]
        bound = "an undamped beam has no finite response at a natural frequency"
        raise BeyondModel("frequencies", float(bad), bound, "give damping, or another frequency", "Hz")
    return FrequencyResponse(
        speed=speed,
        frequencies=given,
        response=refined.value,
        harmonics=np.array([*refined.model.drives(drive)]),
        error=refined.error + rounding_errors(refined.model, drive, seen, given),
        peaks=find_peaks(refined.model, refined.larger, drive, seen, band, tolerance * (modes == "auto")),
        input=f"{drive.label} [{drive.unit}]",
        output=f"{seen.label} [{seen.unit}]" if seen.unit else seen.label,
        unit=f"{seen.unit or '1'} per {drive.unit}",
        warnings=(*_warnings(scene, tolerance, modes, refined),),
        provenance=Provenance.since(start, refined.method, refined.compared_with),
        scene=scene,
    )


def _warnings(scene: Scene, tolerance: float, modes: int | str | None, refined: Refined) -> Iterator[str]:
    yield from warn_of_left_out(scene)
    yield from warn_of_rotation(refined.model.model, refined.model.speed)
    if not scene.is_damped:
        yield "there is no damping: near natural frequencies no real beam has this response"
    largest = np.abs(refined.value).max()
    if isinstance(modes, str) and refined.truncation > tolerance * largest:
        yield (
            f"tolerance = {tolerance:g} is not reached: the estimated error due to modes left out is "
            f"{refined.truncation / largest:.1g} of the largest response"
        )
