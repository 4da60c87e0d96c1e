"""Natural modes at a steady speed: frequencies, shapes, growth rates, kinds and errors.

In shapes of arrays, m counts modes, n coordinates, and S speeds.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import count, real, within
from beamdyn.common.plots.export import write_shapes
from beamdyn.common.plots.plots_of_shapes import plot_shapes, plot_shapes_by_plane, plot_surfaces
from beamdyn.common.results.one_line import counted, error_at_most, listed, states, warned
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.results.statements import GROWING, TOLERANCE, Speeds, Statement, announced
from beamdyn.common.words import Words
from beamdyn.equations.effects import first_drawn, name_directions
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal import discretization_choice
from beamdyn.modes.modal.error_estimate import EstimatedModes
from beamdyn.modes.modal.model import (
    BENDING,
    Model,
    TellsKinds,
    kinds_of_modes,
    plane_share,
    static_load,
    warn_of_straight,
)
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import check_speeds, warn_of_left_out, warn_of_static_deflection, warn_of_strain

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# Coordinates and shapes, as returned by `Modes.mesh`.
Mesh: TypeAlias = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Modes(TellsKinds, SceneResult, StatesModelError):
    """Natural modes at one speed, the lowest first.

    `error` is the numerical error.  `left_out` contains the estimated relative change of each frequency by
    each neglected physical effect, `model_error` (m,) the magnitude of the sum of these changes; both are
    computed at first use.  `kind` (m,) names the kind of motion with most of a mode's
    kinetic energy: "bending", "torsion" or "camber".

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    frequency : ndarray, shape (m,)
        Frequency [Hz]; nan where a mode is unstable or does not oscillate.
    error : ndarray, shape (m,)
        Estimated relative error of the frequency, or of the growth rate if there is no frequency.
    growth_rate : ndarray, shape (m,)
        Growth rate [1/s]: positive for an unstable mode, negative for a damped one.
    status : ndarray of str, shape (m,)
        "stable", "divergence", "flutter", "overdamped", or "neutral" (a free rotation with the frequency 0).
    eigenvalue : ndarray of complex, shape (m,)
        Eigenvalue s of the motion exp(s t) [1/s].
    tip, tip_across : ndarray, shape (m,)
        Tip deflections of the mass-normalised modes [kg^-1/2] in the direction of bending at the root and
        across it, the larger one positive; 0 across where one plane is modelled.
    plane_share : ndarray, shape (m, 2)
        Fraction of the kinetic energy of the mode's deflection (without stretch) in each direction.
    load, load_across : ndarray, shape (m,)
        Modal loads under a unit root acceleration in either direction of bending [kg^1/2]: P of
        docs/conventions.md in modal coordinates.
    angular_load, angular_load_across : ndarray, shape (m,)
        Modal loads under a unit angular acceleration in either plane of bending [kg^1/2 m]: Q of
        docs/conventions.md in modal coordinates.
    static_deflection : float
        Static tip deflection under rotation [m], with its sign; its magnitude if two planes are modelled; nan
        above the critical speed.
    axial_strain : float
        Largest static axial strain, a measure of the error of a model without stretch; nan if it is unknown.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> modes = bd.natural_modes(bd.Scene(strip, bd.Mount(radius=0.215)), speed=50.0, modes=2)
    >>> modes.status.tolist()
    ['stable', 'stable']
    >>> modes.shape(np.linspace(0, 0.05, 5)).shape
    (2, 5)
    """

    speed: float
    frequency: np.ndarray
    error: np.ndarray
    growth_rate: np.ndarray
    status: np.ndarray
    eigenvalue: np.ndarray
    tip: np.ndarray
    tip_across: np.ndarray
    plane_share: np.ndarray
    load: np.ndarray
    load_across: np.ndarray
    angular_load: np.ndarray
    angular_load_across: np.ndarray
    static_deflection: float
    axial_strain: float
    vectors: np.ndarray = field(repr=False)
    model: Model = field(repr=False)
    kinds: np.ndarray | None = field(default=None, repr=False, metadata=ADDED_LATER)

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the modes; see `Result.headline`."""
        yield f"{len(self.frequency)} at {self.say_speed(self.speed)}: {listed(self.frequency, 'Hz')}"
        yield from (error_at_most(self.error), states(self.status, ("stable",)), warned(self.warnings))

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Changes of each frequency by each neglected effect."""
        # The import is inside the function because few calls need the module.
        from beamdyn.modes.model_error.left_out_changes import left_out_with_modes

        return left_out_with_modes(self.model, np.array([self.speed]), self.eigenvalue[None]).at(0)

    def shape(self, x: np.ndarray | Sequence[float], direction: int = 0) -> np.ndarray:
        """Compute the mass-normalised modes' deflection at x [m] along the beam: shape (m, len(x)).

        Direction 0 is the bending direction at the root, direction 1 is perpendicular to it.
        """
        equations = self.model.equations_at(self.speed)
        return self.vectors.T @ equations.deflection(self._over_length(x), direction=direction)

    def surface(self, x: np.ndarray | Sequence[float], eta: np.ndarray | Sequence[float]) -> np.ndarray:
        """Compute mass-normalised modes' deflection over a strip: shape (m, len(x), len(eta)).

        The deflection is in the direction of bending, at positions x [m] along the beam and eta = 2 y/b
        across its width b, from -1 to 1, where y points in the second direction of bending.  The mean over
        eta is `shape`; where neither torsion nor camber is modelled, the deflection does not depend on eta.
        """
        equations = self.model.equations_at(self.speed)
        return np.tensordot(self.vectors.T, equations.surface(self._over_length(x), np.asarray(eta)), 1)

    def mesh(self, along: int = 101, across: int = 21) -> Mesh | None:
        """Compute mode shapes on a mesh over the strip, in its axes: see `common.plots.export.write_shapes`.

        Parameters
        ----------
        along, across : int
            Number of positions along and across the strip.

        Returns
        -------
        x : ndarray, shape (n,)
            Positions along the strip [m].
        y : ndarray, shape (n, positions)
            Positions across the strip [m], ascending.
        shapes : ndarray, shape (modes, n, positions)
            Deflections in the direction of bending, real numbers.
        across : ndarray, shape (modes, n)
            Deflections in the second direction of bending, towards -y.

        None if the sections keep their shape, or if their width is not known.
        """
        places = self.model.over_strip(along, across)
        if places is None:
            return None
        x, eta, y = places
        return x, y, np.real(self.surface(x, eta)), np.real(self.shape(x, 1))

    def _over_length(self, x: np.ndarray | Sequence[float]) -> np.ndarray:
        """Divide positions x [m] by the length; raise a ValueError if one of them is not on the beam."""
        xi = np.asarray(x, dtype=float) / self.scene.beam.length
        if xi.size and not (xi.min() >= 0 and xi.max() <= 1 + 1e-12):
            raise ValueError(f"x: positions run from 0 to the length {self.scene.beam.length:g} m")
        return np.minimum(xi, 1.0)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the mode shapes; a strip that twists or cambers is drawn in top view."""
        if (mesh := self.mesh()) is not None:
            return plot_surfaces(*mesh, self.labels(), ax, self.display_units)
        x = np.linspace(0, self.scene.beam.length, 201)
        if self.scene.physics.planes == 2:
            order, words = drawn_order(self.scene)
            shapes = np.stack([np.real(self.shape(x, direction)) for direction in order], axis=1)
            return plot_shapes_by_plane(x, shapes, self.labels(), words, ax, self.display_units)
        return plot_shapes(x, np.real(self.shape(x)), self.labels(), ax, self.display_units)

    def export(
        self,
        path: str | Path,
        width: float | None = None,
        force: bool = False,
        labels: Sequence[str] | None = None,
    ) -> None:
        """Write the mode shapes as a mesh file for ParaView; see `common.plots.export.write_shapes`.

        A strip that twists or cambers is written as a surface, with its true width if `width` [m] is not
        given; any other beam as a ribbon, a tenth of its length wide if not given.  The labels are `labels()`
        if not given.  With `force`, a file that exists is overwritten.
        """
        mesh, drawn = self.mesh(), width
        if mesh is None:
            x = np.linspace(0, self.scene.beam.length, 101)
            shapes, across = (np.real(self.shape(x, direction)) for direction in (0, 1))
        else:
            x, y, shapes, across = mesh
            drawn = np.ptp(y, axis=1) if width is None else width
        write_shapes(path, x, shapes, self.labels() if labels is None else labels, drawn, force, across)

    def labels(self) -> list[str]:
        """Describe each mode in one line: number, frequency or growth rate, and kind."""
        kinds = [""] * len(self.frequency) if self.kinds is None else [f", {kind}" for kind in self.kinds]
        values = enumerate(zip(self.frequency, self.growth_rate, kinds, strict=True), 1)
        sizes = ((i, f"{g:.4g} 1/s" if np.isnan(f) else f"{f:.5g} Hz", kind) for i, (f, g, kind) in values)
        return [f"mode {i}: {size}{kind}" for i, size, kind in sizes]


def drawn_order(scene: Scene) -> tuple[tuple[int, int], tuple[str, str]]:
    """Return the directions that are drawn with solid and dashed lines, and their names."""
    solid, names = first_drawn(scene), name_directions(scene)
    return (solid, 1 - solid), (names[solid][0], names[1 - solid][0])


@announced
def natural_modes(
    scene: Scene,
    speed: float = 0.0,
    modes: int = 3,
    discretization: discretization_choice.DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Modes:
    """Compute the natural modes at a steady speed, about a fixed centre.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speed : float
        Speed [rad/s].
    modes : int
        Number of modes.
    discretization : {"ritz", "fem"} or Discretization
        Assumed modes or finite elements, as large as needed; or a `Ritz` or `Fem` of given size.
    tolerance : float, optional
        Allowed relative error, from 1e-14 to 0.1: the smallest model that meets it is chosen.  By default
        models are chosen for 1e-11, two digits beyond the promised 1e-9; for 1e-4 if a rectangular section
        cambers or twists, as convergence at the corners of the clamp is algebraic.

    Returns
    -------
    Modes

    Raises
    ------
    ValueError
        If an argument is out of its range.

    References
    ----------
    Lee and Yoo (2019), eq. (14), corrected as docs/conventions.md lists; errors by Richardson's
    extrapolation (standard).

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> modes = bd.natural_modes(bd.Scene(strip, bd.Mount(radius=0.215)), speed=50.0, modes=2)
    >>> modes.frequency.round(3)  # Hz; Lee and Yoo (2019): 61.963
    array([ 61.963, 406.329])
    >>> bool((modes.error < 1e-9).all())
    True
    """
    start = perf_counter()
    check_scene(scene)
    speeds, modes = np.array([real("speed", speed, "rad/s")]), count("modes", modes)
    check_speeds(speeds, "speed")
    tolerance = (
        None if tolerance is None else within("tolerance", tolerance, *discretization_choice.TOLERANCES)
    )
    if scene.chooses_physics:
        # The import is inside the function because few calls need the module.
        from beamdyn.modes.model_error.effect_choice import choose_physics

        scene = choose_physics(scene, speeds, modes, tolerance)
    solution = discretization_choice.solve_to_tolerance(scene, discretization, speeds, modes, tolerance)
    equations, s = solution.model.equations_at(speeds[0]), solution.eigen.eigenvalue[0]
    kinds = kinds_of_modes(equations, solution.eigen.vector)
    vectors = _with_signs(equations, solution.eigen.vector[0], None if kinds is None else kinds[0])
    tips, accelerated = equations.tips, (f(d) for f in (equations.P, equations.Q) for d in (0, 1))
    along, across, *loads = np.real(np.array([tips[0], tips[-1], *accelerated]) @ vectors)
    deflection, strain = static_load(solution.model, speeds)
    growth_rate = np.real(s) + 0.0
    warnings = warn_of_modes(
        solution.model, speeds, deflection, strain, solution.error, growth_rate[None], tolerance
    )
    return Modes(
        speed=float(speeds[0]),
        frequency=frequency_of(s),
        error=solution.error[0],
        growth_rate=growth_rate,
        status=status_of(s),
        eigenvalue=s,
        tip=along,
        tip_across=across if equations.planes == 2 else np.zeros_like(along),
        plane_share=plane_share(equations, vectors[None])[0],
        load=loads[0],
        load_across=loads[1],
        angular_load=loads[2],
        angular_load_across=loads[3],
        static_deflection=float(deflection[0]),
        axial_strain=float(strain[0]),
        warnings=tuple(warnings),
        provenance=provenance_of(solution, start),
        scene=scene,
        vectors=vectors,
        model=solution.model,
        kinds=None if kinds is None else kinds[0],
    )


def _with_signs(equations: Equations, vectors: np.ndarray, kinds: np.ndarray | None) -> np.ndarray:
    """Scale modes (columns) by a sign or phase that makes the tip deflection real and positive.

    For bending modes, it is the larger of the deflections in the two directions; for modes of torsion or
    camber, that of the tip's corner at eta = 2 y/width = 1.
    """
    tips = equations.tips @ vectors
    larger = tips[np.abs(tips).argmax(axis=0), np.arange(tips.shape[1])]
    if kinds is not None:
        larger = np.where(kinds == BENDING, larger, equations.corner @ vectors)
    direction = np.sign(larger)
    return vectors / np.where(direction == 0, 1.0, direction)


_STATUS = np.array(["overdamped", "stable", "divergence", "flutter", "neutral"])


def status_of(s: np.ndarray) -> np.ndarray:
    """Name the status of modes, such as "stable" or "flutter", from eigenvalues [1/s] of any shape."""
    return _STATUS[np.where(s == 0, 4, 2 * (np.real(s) > 0) + (np.imag(s) != 0))]


def frequency_of(s: np.ndarray) -> np.ndarray:
    """Compute frequencies [Hz] from eigenvalues [1/s] of any shape; nan unless a mode is stable."""
    vibrates = (np.real(s) <= 0) & ((np.imag(s) != 0) | (s == 0))
    return np.where(vibrates, np.imag(s) / (2 * np.pi), np.nan)


def warn_of_modes(
    model: Model,
    speeds: np.ndarray,
    deflection: np.ndarray,
    strain: np.ndarray,
    error: np.ndarray,
    growth_rate: np.ndarray,
    tolerance: float | None,
) -> Iterator[Statement]:
    """Yield warnings about modes: errors and growth rates (speeds, modes), and static loads."""
    scene = model.scene
    yield from warn_of_left_out(scene)
    unstable = growth_rate > 0
    if unstable.any():
        s = int(unstable.any(axis=1).argmax())
        end = f": {counted(unstable[s].sum(), 'growing mode')}; see growth_rate"
        rate = {"quantity": "growth rate [1/s]", "value": growth_rate[s].max(), "limit": 0.0}
        yield Statement("unstable at ", Speeds(speeds[s]), end, kind=GROWING, **rate)
    yield from warn_of_strain(strain.max(initial=0))
    if scene.physics.large_deflection:
        # The import is inside the function because importing takes long.
        from beamdyn.modes.model_error.sharp_bending import warn_of_sharp_bending

        bending = partial(model.bent.curvature, model.deflected.equilibria(speeds))
        yield from warn_of_sharp_bending(scene, bending, lambda k: Words("at ", Speeds(speeds[k])))
    else:
        yield from warn_of_static_deflection(deflection, scene.beam.length, speeds)
        yield from warn_of_straight(deflection, speeds, model)
    if tolerance is not None:
        yield from discretization_choice.warn_of_missed_tolerance(error.max(), tolerance)
    elif error.max() > (discretization_choice.PLATE_TARGET if scene.models_width else 1e-6):
        said = f"estimated relative error reaches {error.max():.1g}: the model did not resolve every mode"
        quantity = "estimated relative error"
        yield Statement(said, kind=TOLERANCE, quantity=quantity, value=error.max(), limit=1e-6)


def provenance_of(solution: EstimatedModes, start: float) -> Provenance:
    """Build the provenance record of modes; `start` is when the computation began, by `perf_counter` [s]."""
    names = str(solution.model.discretization), str(solution.model.compared.discretization)
    return Provenance.since(start, *names)
