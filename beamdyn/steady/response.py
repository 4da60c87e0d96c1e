"""Steady response over speed, by harmonic balance in the phases of rotation and road.

In shapes of arrays, S counts speeds, k speeds at which the model error is computed, and l spectral lines.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.common.inputs.checks import ascending, count, positive
from beamdyn.common.plots.plots import plot_response
from beamdyn.common.results.columns import evenly_spread
from beamdyn.common.results.one_line import counted, error_at_most, states, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance, plain
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.common.results.statements import EXCITATION, GROWING, LIMITS, TOLERANCE, Statement, announced
from beamdyn.equations.effects import check_direction, modelled_directions
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, ensure_size
from beamdyn.modes.modal.model import FEWEST_MODES, ModalBasis, Model, given_basis
from beamdyn.modes.model_error.effect_choice import choose_for_motion, warn_of_peak
from beamdyn.modes.model_error.left_out_changes import SolvedValues, left_out_by_solving, nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.repeated import repeatable
from beamdyn.scene import validity
from beamdyn.scene.motion.base import Line
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.steady.largest_over_phases import largest_over_phases
from beamdyn.steady.periodic_system import check_steady_state, name_line
from beamdyn.steady.vibration import (
    UNSTABLE,
    WITHOUT_STABLE_MEAN,
    Vibration,
    add_static,
    choose_vibrating,
    combine_pairs,
    sizes_of,
    solve_parts,
    vibration_of,
)

_MOST_HARMONICS = 20  # largest accepted number of interactions, whose solution takes half a minute
_HIGHEST_SPEED = 0.99  # largest speed at which modes of a basis are computed, relative to the critical speed
_MOST_MODES = 13  # largest number of modes that "auto" takes at the slowest speed, and at the fastest
# First number of modes tried about equilibria; not small, because equilibria are solved again for each basis.
_FIRST_ABOUT_EQUILIBRIA = 6
# Number of speeds at which the model error is computed, in addition to the speed of the largest amplitude.
_MOST_JUDGED = 4
_LINEAR = "vibration about the equilibrium being linear"


@dataclass(frozen=True)
class SteadyResponse(StatesModelError):
    """Steady response over speed, after the free vibration from the start has decayed.

    `left_out` contains the estimated relative change of the amplitude by each neglected physical effect at
    the `left_out_speeds` (k,), `model_error` (k,) the magnitude of the sum of these changes; both are
    computed at first use.  `left_out_at` computes the changes at other speeds.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    amplitude : ndarray, shape (S,)
        Largest magnitude of the tip deflection over both phases [m], of the vector where the beam bends
        in two directions; nan where there is no steady response.
    bound : ndarray, shape (S,)
        Sum of the amplitudes of all lines, including the static one [m]; a line's is the longer semi-axis of
        the ellipse that the tip describes.
    stable : ndarray of bool, shape (S,)
        Whether free vibration decays, or without damping stays bounded.
    status : ndarray of str, shape (S,)
        "stable", "parametric instability", "past the critical speed" or "turns freely about the root"; with
        large deflection also "no equilibrium" or "unstable equilibrium".
    growth_rate : ndarray, shape (S,)
        Largest growth rate of free vibration [1/s]; nan where the beam turns freely about its root, or has
        no equilibrium.
    growth_rate_error : ndarray, shape (S,)
        Error of the growth rate [1/s]: for resonant modes by harmonics left out and phases not tried; for
        others the second-order shift by the periodic coefficients.
    error : ndarray, shape (S,)
        Estimated truncation error of the harmonics, relative to `bound`.
    lines : tuple of Line, length l
        Spectral lines (frequencies) of the response, named by their excitation.
    line_frequency : ndarray, shape (S, l)
        Frequencies of the lines [Hz].
    line_amplitude, line_amplitude_across : ndarray of complex, shape (S, l)
        Complex amplitude a of each line [m] in the direction of bending at the root and across it (0 where
        one plane is modelled): the tip deflection is the sum of Re(a exp(i (j theta + k chi))).
    harmonics : ndarray of int, shape (l, 2)
        Harmonic (j, k) of each line.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.

    Notes
    -----
    The modal truncation error is `mode_error`, which takes a second solution at its first use.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> found = bd.steady_response(bd.Scene(strip, bd.Mount(radius=0.215), wheel), [45.0, 55.0], modes=3)
    >>> bool((found.amplitude <= found.bound * (1 + 1e-12)).all())  # at most the sum of the lines
    True
    """

    speeds: np.ndarray
    amplitude: np.ndarray
    bound: np.ndarray
    stable: np.ndarray
    status: np.ndarray
    growth_rate: np.ndarray
    growth_rate_error: np.ndarray
    error: np.ndarray
    lines: tuple[Line, ...]
    line_frequency: np.ndarray
    line_amplitude: np.ndarray
    line_amplitude_across: np.ndarray
    harmonics: np.ndarray
    warnings: tuple[str, ...]
    provenance: Provenance
    # Largest magnitude (S,) of the vibration [m], without the static part.
    vibration: np.ndarray = field(repr=False)
    request: ResponseRequest = field(repr=False)

    judged_by_solving: ClassVar[bool] = True

    def headline(self) -> Iterator[str]:
        """Yield speeds, largest amplitude and error for a one-line summary; see `Result.headline`."""
        largest = self.say_length(np.nanmax(self.amplitude, initial=0.0))
        yield f"{counted(len(self.speeds), 'speed')}, {self.say_speed(self.speeds)}: up to {largest}"
        yield f"harmonics' {error_at_most(self.error)}"
        yield from (states(self.status, ("stable",)), warned(self.warnings))

    @property
    def scene(self) -> Scene:
        """Scene of the response."""
        return self.request.scene

    @property
    def is_warned(self) -> np.ndarray:
        """Whether a warning applies, for each speed."""
        undecided = (np.abs(self.growth_rate) < self.growth_rate_error) & np.isin(
            self.status, ("stable", UNSTABLE)
        )
        judged = self.status, self.vibration, self.error, undecided
        each = ([values[[i]] for values in (self.speeds, *judged)] for i in range(len(self.speeds)))
        alone = (_warnings(replace(self.request, speeds=at), *values) for at, *values in each)
        return np.array([next(said, None) is not None for said in alone])

    @cached_property
    def refined(self) -> SteadyResponse | None:
        """Response with 1.5 times as many modes, at least two more, and static responses to the loads.

        None if there is no larger model.
        """
        finer = self.request.refined()
        return None if finer is None else finer.run()

    @cached_property
    def mode_error(self) -> np.ndarray:
        """Estimated modal truncation error per speed, relative to `bound`: twice the distance from `refined`.

        The error is inf where only one of the two has a steady response, or if there is no larger model.
        """
        if self.refined is None:
            return np.full(len(self.speeds), np.inf)
        with np.errstate(invalid="ignore", divide="ignore"):
            difference = 2 * np.abs(self.refined.amplitude - self.amplitude) / self.bound
        neither = np.isnan(self.amplitude) & np.isnan(self.refined.amplitude)
        return np.where(
            neither | (self.refined.amplitude == self.amplitude), 0.0, np.nan_to_num(difference, nan=np.inf)
        )

    def has_enough_modes(self) -> bool:
        """Return whether `mode_error` meets the tolerance, and `refined` has all modes that may resonate."""
        finer = self.refined
        if finer is None or (self.mode_error > self.request.tolerance).any():
            return False
        return finer.request.free.contains_resonances(finer.stable, finer.request.basis.modes or 1)

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to numbers, lists and strings, including its errors."""
        more = {"mode_error": plain(self.mode_error), "left_out_speeds": self.left_out_speeds.tolist()}
        return {**super().to_dict(), **more}

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of the amplitude at the `left_out_speeds` by effects left out of the model."""
        return self.left_out_at(self.left_out_speeds)

    @property
    def left_out_speeds(self) -> np.ndarray:
        """Speeds [rad/s] at which the model error is computed: of the largest amplitude, and some others."""
        known = np.flatnonzero(np.isfinite(self.amplitude))
        if not len(known):
            return np.empty(0)
        spread = evenly_spread(len(known), _MOST_JUDGED)
        return self.speeds[np.union1d(known[spread], known[np.argmax(self.amplitude[known])])]

    def left_out_at(self, speeds: Sequence[float] | np.ndarray) -> LeftOutEffects:
        """Compute relative changes of the amplitude at speeds [rad/s] by effects left out of the model."""
        if not len(speeds):
            return nothing_known(self.scene)
        request = replace(self.request, speeds=np.asarray(speeds, dtype=float))
        return left_out_by_solving(self.scene, request.solve_with)

    def tip(self, rotation: np.ndarray, road: np.ndarray | float = 0.0, direction: int = 0) -> np.ndarray:
        """Compute the tip deflection [m] at phases of rotation and road [rad]: (speeds, phases).

        Direction 0 is the direction of bending at the root; 1 is perpendicular to it and to the axis.
        """
        rotation, road = np.broadcast_arrays(rotation, road)
        phase = np.tensordot(self.harmonics, np.stack([rotation, road]), axes=1)
        return np.real(np.tensordot(self._lines(direction), np.exp(1j * phase), axes=1))

    def largest_tip(self, direction: int = 0) -> np.ndarray:
        """Compute the largest |tip deflection| in a direction (see `tip`) over both phases [m]."""
        size, lines = np.full(len(self.speeds), np.nan), self._lines(direction)
        size[self.stable] = largest_over_phases(lines[self.stable, None], self.harmonics)
        return size

    def _lines(self, direction: int) -> np.ndarray:
        """Return the complex amplitudes of the spectral lines (speeds, lines) in a direction."""
        return self.line_amplitude_across if check_direction(direction) else self.line_amplitude

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the resonance curve and, if the beam bends in two directions, the curve of each direction."""
        names = modelled_directions(self.scene) if self.scene.physics.planes == 2 else ()
        by_direction = {name: self.largest_tip(direction) for direction, name in enumerate(names)}
        return plot_response(self.speeds, self.amplitude, self.bound, ax, by_direction, self.display_units)


@announced
@repeatable
def steady_response(
    scene: Scene,
    speeds: np.ndarray | Sequence[float],
    modes: int | str = "auto",
    harmonics: int | None = None,
    tolerance: float = 1e-5,
    discretization: DiscretizationChoice = "ritz",
) -> SteadyResponse:
    """Compute the steady response at given speeds by harmonic balance in the phases of rotation and road.

    The speeds are solved as one batch in the coordinates of a few modes of the beam.  The two phases are
    treated as independent, whether or not their rates are commensurate: the amplitude is the largest in
    time if they are not, and the largest over time and over the phase between road and rotation if they
    are.  Stability is decided by the exponents of free motion over the same phases: see
    `beamdyn.steady.stability`.

    Parameters
    ----------
    scene : Scene
        The scene.
    speeds : sequence of float
        Speeds [rad/s], ascending.
    modes : int or "auto"
        Number of modes at rest of each uncoupled displacement (such as bending in each plane).  "auto" takes
        modes at the slowest and at the fastest speed, with the static responses to the loads there: the
        smallest modal basis, of up to 13 modes, whose truncation error meets the tolerance and which more
        modes that the periodic coefficients may excite do not make unstable.  Stability is that of the modes.
    harmonics : int, optional
        Number of interactions with the periodic stiffness whose spectral lines are kept: 0 keeps the lines of
        the load, 1 also the lines that their product with the stiffness adds, and so on.  If not given, as
        many as the tolerance needs, up to 5.
    tolerance : float
        Target of the truncation error of the harmonics, and with ``modes="auto"`` also the modal
        truncation error, each relative to `SteadyResponse.bound`.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    SteadyResponse

    Raises
    ------
    ValueError
        If an argument is out of its range, or the motion's steady state is not known.

    References
    ----------
    Harmonic balance in two phases, stability by Hill's method (standard: Nayfeh and Mook, 1979); static
    responses: Craig and Kurdila (2006), Fundamentals of Structural Dynamics, section 11.4; own derivation:
    docs/conventions.md.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> wheel = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
    >>> found = bd.steady_response(bd.Scene(strip, bd.Mount(radius=0.215), wheel), [55.0], modes=5)
    >>> round(1e3 * float(found.amplitude[0]), 5)  # mm
    0.26188
    """
    check_scene(scene)
    validity.refuse_tip_load(scene)
    speeds = ascending("speeds", speeds)
    validity.check_speeds(speeds)
    basis = given_basis(modes)
    interactions = None if harmonics is None else count("harmonics", harmonics, least=0, most=_MOST_HARMONICS)
    tolerance = positive("tolerance", tolerance)
    smallest = basis or ModalBasis(FEWEST_MODES)
    scene = choose_for_motion(scene, speeds, basis and basis.modes, tolerance)
    request = ResponseRequest(scene, speeds, smallest, interactions, tolerance, discretization)
    return request.run() if basis else request.run_smallest_basis()


@dataclass(frozen=True)
class ResponseRequest(FieldsOnly):
    """Checked arguments of `steady_response`, with a modal basis instead of the number of modes."""

    scene: Scene
    speeds: np.ndarray
    basis: ModalBasis
    harmonics: int | None
    tolerance: float
    discretization: DiscretizationChoice

    def run(self) -> SteadyResponse:
        """Solve for the steady response with the modal basis of the request."""
        start = perf_counter()
        scene, speeds, motion = self.scene, self.speeds, check_steady_state(self.scene.motion)
        vibration = vibration_of(self.model, self.basis, motion, speeds)
        rate, rate_error, status, undecided = (self.free if self.basis.static else vibration).stability()
        used, c, error = solve_parts(vibration.parts, vibration.tips, self.harmonics, self.tolerance)
        stable = (status == "stable") & np.isfinite(c).all(axis=(1, 2))
        c[~stable], error[~stable] = np.nan, np.nan
        harmonic, vibrating = combine_pairs(c, used, motion)
        line, share = add_static(vibrating, harmonic, vibration.static, scene.physics.planes)
        vibrated = _largest(vibrating, harmonic, stable)
        about = " about the equilibrium at each speed" if scene.physics.large_deflection else ""
        method = f"{self.model.discretization}, {self.basis}{about}, {counted(len(used), 'harmonic')}"
        estimated = "fewer harmonics: without those that the last product with the varying stiffness adds"
        without_static = np.array_equal(line, vibrating, equal_nan=True)
        return SteadyResponse(
            speeds=speeds,
            amplitude=vibrated if without_static else _largest(line, harmonic, stable),
            bound=sizes_of(line).sum(axis=1),
            stable=stable,
            status=status,
            growth_rate=rate,
            growth_rate_error=rate_error,
            error=error * share,
            lines=tuple(name_line(motion, h) for h in map(tuple, harmonic.tolist())),
            line_frequency=np.abs(vibration.parts[0][0].rates @ harmonic.T) / (2 * np.pi),
            line_amplitude=line[:, 0],
            line_amplitude_across=line[:, 1:].sum(axis=1),
            harmonics=harmonic,
            warnings=tuple(_warnings(self, status, vibrated, error * share, undecided)),
            provenance=Provenance.since(start, method, estimated),
            vibration=vibrated,
            request=self,
        )

    def solve_with(self, scene: Scene, _: str = "") -> SolvedValues:
        """Compute the amplitudes of another scene at the same speeds, with as many modes as this request has.

        If only one of the two scenes has large deflection, more modes may be used.
        """
        modes = self.basis.modes or 1
        other = replace(self, scene=scene, discretization=ensure_size(scene, self.discretization, modes))
        if scene.physics.large_deflection != self.scene.physics.large_deflection:
            basis = other.smallest_basis()
            other = replace(other, basis=replace(basis, modes=max(modes, basis.modes or 1)))
        response = other.run()
        lost = [status for status in response.status.tolist() if status != "stable"]
        note = _LINEAR if scene.physics.large_deflection else ""
        return SolvedValues(response.amplitude, lost[0] if lost else "", note)

    def refined(self) -> ResponseRequest | None:
        """Return the request of `SteadyResponse.refined`; None if there is no larger model."""
        basis = self.basis.refined()
        if basis is None or basis.modes is None:
            return None
        discretization = ensure_size(self.scene, self.discretization, basis.modes)
        return replace(self, basis=replace(basis, static=self.end_speeds), discretization=discretization)

    def run_smallest_basis(self) -> SteadyResponse:
        """Solve with the smallest modal basis that meets the tolerance, or with the largest one tried."""

        def finer(response: SteadyResponse) -> SteadyResponse | None:
            return None if (response.request.basis.modes or 0) >= _MOST_MODES else response.refined

        first = replace(self, basis=self.smallest_basis()).run()
        return refine(first, finer, SteadyResponse.has_enough_modes)

    def smallest_basis(self) -> ModalBasis:
        """Return the smallest modal basis, with which the search for a sufficient basis starts.

        It consists of modes and static responses to the loads of the moving root, at the slowest and at the
        fastest speed or, with large deflection, of modes at each speed.
        """
        ends = self.end_speeds
        return ModalBasis(FEWEST_MODES, ends, ends) if ends else ModalBasis(_FIRST_ABOUT_EQUILIBRIA)

    @property
    def end_speeds(self) -> tuple[float, ...]:
        """Slowest and fastest speed below the critical one [rad/s]; one speed if they are equal.

        There are none with large deflection: each equilibrium has modes of its own.
        """
        if self.scene.physics.large_deflection:
            return ()
        speed = np.minimum(np.abs(self.speeds), _HIGHEST_SPEED * self.model.solver.critical_speed)
        return tuple(np.unique([speed.min(), speed.max()]).tolist())

    @property
    def free(self) -> Vibration:
        """Equations of free vibration, in modes alone: nothing resonates with shapes of static responses."""
        motion = check_steady_state(self.scene.motion)
        return vibration_of(self.model, replace(self.basis, static=()), motion, self.speeds)

    @cached_property
    def model(self) -> Model:
        """Discretized scene, chosen for the number of modes and the speeds."""
        return choose_vibrating(self.scene, self.discretization, self.speeds, self.basis.modes or 1)


def _largest(line: np.ndarray, harmonics: np.ndarray, stable: np.ndarray) -> np.ndarray:
    """Compute the largest magnitude over the phases of a sum of l spectral lines; nan without a response.

    The lines (S, d, l) are vectors of d components at S speeds.
    """
    size = np.full(len(line), np.nan)
    size[stable] = largest_over_phases(line[stable], harmonics)
    return size


def _warnings(
    request: ResponseRequest,
    status: np.ndarray,
    vibration: np.ndarray,
    error: np.ndarray,
    undecided: np.ndarray,
) -> Iterator[Statement]:
    """Yield warnings about the response; `undecided` marks speeds at which the stability is uncertain."""
    scene, speeds, tolerance = request.scene, request.speeds, request.tolerance
    yield from validity.warn_of_left_out(scene)
    yield from warn_of_peak(scene, float(np.nanmax(vibration, initial=0.0)))
    for name in (UNSTABLE, *WITHOUT_STABLE_MEAN):
        if (at := status == name).any():
            where = validity.list_speeds(speeds, at)
            yield Statement(
                f"{name} at {counted(int(at.sum()), 'speed')}, ", where, ": no steady response", kind=GROWING
            )
    if (at := vibration == 0).any():
        remedy = "add gravity, or a wavy road and a speed other than 0"
        said = (
            "nothing excites the beam at ",
            validity.list_speeds(speeds, at),
            f", so that it does not move; {remedy}",
        )
        yield Statement(*said, kind=EXCITATION, remedy=remedy)
    if not scene.physics.large_deflection:
        yield from validity.warn_of_deflection(vibration, scene.beam.length, speeds)
    elif (large := vibration > validity.LARGE_DEFLECTION * scene.beam.length).any():
        ratio = vibration[large].max() / scene.beam.length
        yield Statement(
            f"the tip vibrates by {ratio:.2g} of the length about the equilibrium at ",
            validity.list_speeds(speeds, large),
            f": above {validity.LARGE_DEFLECTION:g} linear theory of vibration does not hold",
            kind=LIMITS,
            quantity="tip deflection over the length",
            value=ratio,
            limit=validity.LARGE_DEFLECTION,
        )
    motion = check_steady_state(scene.motion)
    yield from validity.warn_of_road(np.array([motion.road_acceleration(v) for v in speeds]), speeds)
    if (at := error > tolerance).any():
        said = (
            f"the truncation error of the harmonics exceeds the tolerance {tolerance:g} at ",
            validity.list_speeds(speeds, at),
            "; see error",
        )
        yield Statement(*said, kind=TOLERANCE, quantity="error", value=error[at].max(), limit=tolerance)
    if undecided.any():
        where = validity.list_speeds(speeds, undecided)
        end = ": growth_rate is within growth_rate_error"
        yield Statement("stability is not decided at ", where, end, kind=TOLERANCE, quantity="growth rate")
