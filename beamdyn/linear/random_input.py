"""Random inputs at a steady speed: what acts, and with which density."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, kind, positive, refuse
from beamdyn.linear.excitations import BaseMotion, Excitation, as_excitation
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.linear.spectra import PowerSpectrum, RoadRoughness
from beamdyn.scene.motion import RollingWheel
from beamdyn.scene.scene import Scene

_TURN = 2 * np.pi


def random_input(
    scene: Scene, speed: float, psd: PowerSpectrum | RoadRoughness | float, given: Excitation | str | None
) -> tuple[Excitation, PowerSpectrum | float]:
    """The excitation and its density; a road becomes the vertical acceleration of the wheel.

    Raises
    ------
    InvalidValue
        If a road is given another input, no wheel, or no speed; or the density is none.
    """
    if isinstance(psd, RoadRoughness):
        return BaseMotion("n2"), _of_road(scene, speed, psd, given)
    excitation = as_excitation("input", "bending" if given is None else given)
    if isinstance(psd, PowerSpectrum):
        return excitation, psd
    if not hasattr(psd, "__float__"):
        kind("psd", psd, PowerSpectrum, "PowerSpectrum(frequencies, values), a RoadRoughness, or a number")
    return excitation, positive("psd", psd, "", "give the density of white noise")


def _of_road(
    scene: Scene, speed: float, road: RoadRoughness, given: Excitation | str | None
) -> PowerSpectrum:
    if given not in (None, "n2", BaseMotion("n2")):
        raise InvalidValue("input", given, "a road moves the wheel along n2", "leave the input out")
    wheel = scene.motion
    if not isinstance(wheel, RollingWheel):
        bound, remedy = "a road needs the rolling radius of a wheel", "give a RollingWheel(radius, speed)"
        raise InvalidValue("scene.motion", wheel and type(wheel).__name__, bound, remedy)
    refuse(speed == 0, "speed", speed, "rad/s", "at rest a road does not shake", "give a speed")
    return road.acceleration(wheel.rolling_radius * speed)


def highest_frequency(spectrum: PowerSpectrum | float) -> float:
    """Highest frequency of the input [Hz]; 0 for white noise."""
    return spectrum.frequencies[-1] if isinstance(spectrum, PowerSpectrum) else 0.0


def warn_of_band(spectrum: PowerSpectrum | float, drive: Excitation, model: ModelAtSpeed) -> Iterator[str]:
    """Yield a warning if the input lacks a frequency that excites the first resonance.

    An input that does not turn with the beam excites it at its own frequency plus and minus that of rotation.
    """
    resonances = np.abs(np.imag(model.free_motion.finite_poles)) / _TURN
    if not isinstance(spectrum, PowerSpectrum) or not resonances.any():
        return
    first = resonances[resonances > 0].min()
    shifts = np.array([*model.drives(drive)]) * model.speed / _TURN
    exciting = np.unique(np.abs(first + shifts))
    lowest, highest = spectrum.frequencies[0], spectrum.frequencies[-1]
    missing = exciting[(exciting < lowest) | (exciting > highest)]
    if missing.size:
        by, lacks = (" and ".join(f"{f:.4g}" for f in each) for each in (exciting, missing))
        yield (
            f"the first resonance, at {first:.4g} Hz, is excited by inputs at {by} Hz, but the input has "
            f"{lowest:.4g} to {highest:.4g} Hz: what {lacks} Hz excites is not in the answer; give all of it"
        )
