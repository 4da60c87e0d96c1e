"""Loads along the span in steady response, over the two phases of the excitation."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.inputs.checks import kind, one_of
from beamdyn.common.results.result import Provenance
from beamdyn.loads.load_lines import LoadLines, lines_of_response
from beamdyn.loads.mode_error import mode_error, with_neighbours
from beamdyn.loads.section_points import QUANTITIES, SectionPoints, StationOutputs, sections_at
from beamdyn.loads.span_loads import SpanLoads, placed, refuse_large_deflection, with_unit
from beamdyn.loads.stations import Positions, SpanStations, stations_at
from beamdyn.scene.motion import Line
from beamdyn.scene.validity import warn_of_elastic_limit
from beamdyn.steady.excitation_phases import check_steady_state, name_line
from beamdyn.steady.response import SteadyResponse

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class SteadyLoads(SpanLoads):
    """Loads along the span in steady response at C speeds: largest magnitudes over both phases.

    The fields are those of `SpanLoads` and, besides, the following; values are nan where there is no steady
    response.

    Parameters
    ----------
    speeds : ndarray, shape (C,)
        Speeds [rad/s].
    harmonics : ndarray of int, shape (l, 2)
        Multiples j of the rotation and k of the road of each line.
    lines : tuple of Line, length l
        The lines of the loads; the static one has the mean.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> response = bd.steady_response(bd.Scene(strip, bd.Mount(radius=0.215), wheel), [55.0], modes=3)
    >>> loads = bd.steady_loads(response, at=[0.0, 0.025])
    >>> bool(loads.moment[0, 0, 0] > loads.moment[0, 1, 0])  # largest at the root
    True
    """

    speeds: np.ndarray
    harmonics: np.ndarray
    lines: tuple[Line, ...]
    response: SteadyResponse = field(repr=False)
    outputs: StationOutputs = field(repr=False)

    case: ClassVar[tuple[str, str]] = ("speed", "rad/s")

    @property
    def cases(self) -> np.ndarray:
        """The speeds [rad/s]."""
        return self.speeds

    def line_amplitude(self, quantity: str) -> np.ndarray:
        """Complex amplitude a of each line of a quantity: shape (C, S, k, l).

        The quantity is the sum of Re(a exp(i (j theta + k chi))), as in `SteadyResponse`.
        """
        one_of("quantity", quantity, QUANTITIES)
        return self._amplitudes[:, :, self.outputs.places[quantity]]

    def mean(self, quantity: str) -> np.ndarray:
        """Mean of a quantity over the phases: shape (C, S, k)."""
        static = ~self.harmonics.any(axis=1)
        return np.real(self.line_amplitude(quantity)[..., static]).sum(axis=-1)

    def at_phases(
        self, quantity: str, rotation: np.ndarray | float, road: np.ndarray | float = 0.0
    ) -> np.ndarray:
        """A quantity at phases theta and chi [rad] of shape (...): shape (C, S, k, ...)."""
        angle, wave = np.broadcast_arrays(rotation, road)
        phase = np.tensordot(self.harmonics, np.stack([angle, wave]), axes=1)
        return np.real(np.tensordot(self.line_amplitude(quantity), np.exp(1j * phase), axes=1))

    def plot(self, ax: Axes | None = None, quantity: str = "moment") -> Axes:
        """Draw the largest magnitude of a quantity over all speeds along the span."""
        from beamdyn.common.plots.curves import plot_along_span

        self.check_known(quantity)
        largest = np.nanmax(self.values(quantity), axis=0, keepdims=True)
        label = f"largest {with_unit(quantity)}, of all speeds"
        return plot_along_span(self.x, largest, self.components(quantity), label, ax, self.display_units)

    @cached_property
    def _amplitudes(self) -> np.ndarray:
        stations = SpanStations(self.x / self.scene.beam.length, self.inboard)
        return lines_of_response(self.response, stations, self.outputs).amplitude


def steady_loads(
    response: SteadyResponse,
    at: Positions | None = None,
    points: SectionPoints | None = None,
    youngs_modulus: float | None = None,
) -> SteadyLoads:
    """Compute the loads along the span in steady response, from its loads and inertia.

    Parameters
    ----------
    response : SteadyResponse
        The response over speed, of `steady_response`.
    at, points, youngs_modulus
        As for `static_loads`.

    Returns
    -------
    SteadyLoads

    Raises
    ------
    ValueError
        If an argument is out of its range, a point lies outside the section, or the response is one of large
        deflection.

    References
    ----------
    As `static_loads`, with inertia (d'Alembert, standard); modes left out are static: Craig and Kurdila
    (2006), Fundamentals of Structural Dynamics, section 11.4.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> response = bd.steady_response(bd.Scene(strip, bd.Mount(radius=0.215), wheel), [55.0], modes=3)
    >>> bd.steady_loads(response, at=[0.0]).x
    array([0.])
    """
    start = perf_counter()
    kind("response", response, SteadyResponse, "steady_response makes one")
    scene = response.scene
    refuse_large_deflection(scene)
    stations = stations_at(scene.modelled_beam, at)
    sections = sections_at(scene, stations, points, youngs_modulus)
    outputs = StationOutputs.of_sections(sections)
    lines = lines_of_response(response, stations, outputs)
    motion = check_steady_state(scene.motion)
    return SteadyLoads(
        **placed(scene, stations, sections),
        **outputs.split(lines.largest),
        **outputs.split(_error(response, lines, stations, outputs), "_error"),
        warnings=(
            *sections.notes,
            *response.warnings,
            *warn_of_elastic_limit(outputs.split(lines.largest)["strain"]),
        ),
        provenance=Provenance(
            __version__,
            response.provenance.method,
            "" if response.refined is None else response.refined.provenance.method,
            perf_counter() - start,
        ),
        speeds=response.speeds,
        harmonics=lines.harmonics,
        lines=tuple(name_line(motion, (int(j), int(k))) for j, k in lines.harmonics),
        response=response,
        outputs=outputs,
    )


def _error(
    response: SteadyResponse, lines: LoadLines, stations: SpanStations, outputs: StationOutputs
) -> np.ndarray:
    """Estimated errors (C, S, K): of the modes left out, and of the harmonics left out."""
    if response.refined is None:
        return np.full(lines.largest.shape, np.inf)
    everywhere = with_neighbours(stations)
    rough, fine = (lines_of_response(each, everywhere) for each in (response, response.refined))
    along_span = np.abs(rough.amplitude).sum(axis=-1).max(axis=1)
    basis = response.request.basis
    distance, length = rough.distance_from(fine), response.scene.beam.length
    return mode_error(distance, along_span, stations, outputs, basis, length) + lines.of_harmonics
