"""Power that a harvester gains from a random road, in addition to the power of steady motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from beamdyn.common.inputs.checks import kind
from beamdyn.common.results.statements import LIMITS, Statement
from beamdyn.linear.convergence import model_at_speed
from beamdyn.linear.inputs_outputs import DeflectionAt, HarvestedCurrent, HarvestedVoltage, LayerStrain
from beamdyn.linear.mean_square import check_damped, parametric_term
from beamdyn.linear.random_response import rms_by, root_mean_squares
from beamdyn.linear.spectra import RoadRoughness, random_input, warn_of_band
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import list_speeds, warn_of_deflection
from beamdyn.steady.response import SteadyResponse

SEVERAL = 3.0  # number of standard deviations that a random response rarely exceeds
_LARGE = 0.01  # relative change of the root mean square by the parametric term above which a warning is given
_TOLERANCE = 1e-5  # tolerance of the linear model that gives the root mean squares


@dataclass(frozen=True)
class RoadHarvest:
    """Harvest that a random road under the wheel adds to a `Harvest` at its S speeds.

    The mean power adds to the mean power of steady motion, as the road and the steady motion are not
    correlated.  Root mean squares are those of the vibration that the road causes about the steady motion.
    The parametric term is left out, as in `random_response`.

    Parameters
    ----------
    roughness : RoadRoughness
        The road.
    power : ndarray, shape (S,)
        Mean power into the load [W]; 0 at rest, nan where there is no steady response.
    voltage, current : ndarray, shape (S,)
        Root mean square of the voltage across the load [V], and of the current through it [A].
    strain : ndarray, shape (S,)
        Root mean square of the bending strain where the layers begin.
    deflection : ndarray, shape (S,)
        Root mean square of the tip deflection [m].
    error : ndarray, shape (S,)
        Estimated relative error of the power; in open circuit twice the error of the voltage, in short
        circuit twice the error of the current.
    strain_error, deflection_error : ndarray, shape (S,)
        Estimated absolute errors of the strain, and of the deflection [m].

    Examples
    --------
    >>> scene = bd.load_scene("examples/bimorph.toml")
    >>> found = bd.harvest(scene, [50.0], modes=2, road=bd.RoadRoughness("A", highest=10.0))
    >>> bool(found.road.power[0] > found.power[0])
    True
    """

    roughness: RoadRoughness
    power: np.ndarray
    voltage: np.ndarray
    current: np.ndarray
    strain: np.ndarray
    deflection: np.ndarray
    error: np.ndarray
    strain_error: np.ndarray
    deflection_error: np.ndarray


def check_road(scene: Scene, road: object) -> None:
    """Raise an error unless the road is a `RoadRoughness`, and the scene has a rolling wheel and damping."""
    kind("road", road, RoadRoughness, 'RoadRoughness("C")')
    random_input(scene, 1.0, cast("RoadRoughness", road), None)
    check_damped(scene)


def harvest_on_road(
    response: SteadyResponse, roughness: RoadRoughness, discretization: DiscretizationChoice, compared: bool
) -> tuple[RoadHarvest, list[str]]:
    """Compute the harvest on a random road at S speeds with a stable steady response, and warnings.

    Unless it is `compared` with other models, its errors are nan, and there are no warnings about the road.

    Raises
    ------
    InvalidValue
        If the scene has no rolling wheel, or a mode is not damped.
    """
    scene, speeds, modes = response.scene, response.speeds, response.request.basis.modes
    assert scene.beam.electrodes is not None
    R = scene.beam.electrodes.resistance
    outputs = (HarvestedVoltage() if R else HarvestedCurrent(), LayerStrain(), DeflectionAt())
    rms, error = np.full((2, len(outputs), len(speeds)), np.nan)
    rms[:, speeds == 0], error[:, speeds == 0] = 0.0, 0.0
    change, missed = np.zeros(len(speeds)), np.zeros(len(speeds), dtype=bool)
    quick = None  # one model for all speeds, if errors are not estimated
    if not compared and modes is not None:
        quick = model_at_speed(scene, float(np.abs(speeds).max()), modes, discretization)
    for k in np.flatnonzero(response.stable & (speeds != 0)).tolist():
        speed = float(speeds[k])
        drive, density = random_input(scene, speed, roughness, None)
        if quick is not None:
            rms[:, k], error[:, k] = rms_by(replace(quick, speed=speed), drive, density, outputs), np.nan
            continue
        found = root_mean_squares(
            scene, speed, drive, density, outputs, modes or "auto", _TOLERANCE, discretization
        )
        rms[:, k], error[:, k] = found.value, found.error
        change[k] = parametric_term(found.model, drive, density).rms_change
        missed[k] = any(warn_of_band(density, drive, found.model))
    flowing, strain, deflection = rms
    relative = np.divide(2 * error[0], flowing, out=np.zeros(len(speeds)), where=flowing != 0)
    voltage = flowing if R else 0 * flowing
    current = voltage / R if R else flowing
    road = RoadHarvest(
        roughness, voltage * current, voltage, current, strain, deflection, relative, *error[1:]
    )
    return road, [*_warnings(response, road, change, missed)]


def _warnings(
    response: SteadyResponse, road: RoadHarvest, change: np.ndarray, missed: np.ndarray
) -> Iterator[str]:
    """Yield warnings of large deflection, omitted parametric terms, and resonances without excitation."""
    speeds, reached = response.speeds, np.nan_to_num(response.amplitude + SEVERAL * road.deflection)
    yield from warn_of_deflection(reached, response.scene.beam.length, speeds)
    if change.max() > _LARGE:
        most = "without limit" if np.isinf(change.max()) else f"by up to {change.max():.0%}"
        said = "on the road the parametric term that is left out would raise the root mean square "
        said = f"{said}{most}, at ", list_speeds(speeds, change > _LARGE)
        yield Statement(*said, kind=LIMITS, quantity="rms by the parametric term", value=change.max())
    if missed.any():
        where = list_speeds(speeds, missed)
        lacking = "the road lacks a spatial frequency that excites the first resonance, at "
        said = lacking, where, "; give a wider range of spatial frequencies"
        yield Statement(*said, kind=LIMITS, quantity="range of spatial frequencies")
