"""Loads along the span in equilibrium at steady speeds, by centrifugal forces and gravity.

In shapes of arrays, C counts speeds, n coordinates, and d directions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np

from beamdyn.accuracy.refinement import BASES_OF_STATIC_LOADS, refine
from beamdyn.common.inputs.checks import ascending, real, within
from beamdyn.common.results.statements import announced
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.root_motion import RootMotion
from beamdyn.loads import span_loads
from beamdyn.loads.load_rows import STRAIGHT, LoadRows, barred_of_loads, span_rows
from beamdyn.loads.stations import Positions, SectionPoints, StationOutputs
from beamdyn.modes.modal.discretization_choice import (
    TOLERANCES,
    DiscretizationChoice,
    model_to_tolerance,
    refine_model,
    warn_of_missed_tolerance,
)
from beamdyn.modes.modal.distance_across import distance_across
from beamdyn.modes.modal.equilibrium import NoEquilibrium
from beamdyn.modes.modal.error_estimate import rounding_of_entries
from beamdyn.modes.modal.model import Model, static_load
from beamdyn.modes.model_error.effect_choice import choose_physics
from beamdyn.modes.model_error.left_out_changes import SolvedValues
from beamdyn.modes.repeated import repeatable
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import (
    check_speeds,
    refuse_large_deflection,
    warn_of_left_out,
    warn_of_static_deflection,
    warn_of_strain,
)

_MODES = 3  # number of modes that the model resolves: loads in equilibrium need no more
_SINGULAR = 1e-13  # eigenvalue of the scaled stiffness below which it counts as 0
# Large deflection reduces the moment at the root by a fraction of 0.26 to 0.42 times the squared ratio of
# deflection to length, for ratios up to 0.5: found with `equilibrium` at four setting angles.
_BENT, _BY_DEFLECTION = 0.4, "estimated roughly from the squared ratio of deflection to length"
# The difference of two models at a station may be small by chance: it counts as at least this fraction of the
# largest difference along the span.
_ALONG = 0.25
_ROUNDING = 1e-12  # rounding error relative to the largest value along the span


@dataclass(frozen=True)
class StaticLoads(span_loads.SpanLoads):
    """Loads along the span in equilibrium at C steady speeds.

    The fields are those of `SpanLoads`, and the following.

    Parameters
    ----------
    speeds : ndarray, shape (C,)
        Speeds [rad/s].
    angle : float
        Angle of rotation at which gravity acts [rad].
    tip : ndarray, shape (C, directions)
        Deflection of the tip in each modelled direction [m].

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> loads = bd.static_loads(bd.Scene(strip, bd.Mount(radius=0.215)), speeds=50.0)
    >>> bool(loads.force[0, 0, 0] < 0)  # inward: compressed
    True
    """

    speeds: np.ndarray
    angle: float
    tip: np.ndarray

    case: ClassVar[span_loads.LoadCase] = span_loads.SPEEDS

    def bent_values(self, straight: np.ndarray, reason: str) -> SolvedValues:
        """Estimate load values with large deflection from those of the straight beam and its deflection."""
        ratio = float(np.linalg.norm(self.tip, axis=1).max()) / self.scene.beam.length
        return SolvedValues(straight / (1 + _BENT * ratio**2), "", _BY_DEFLECTION if ratio else "")


@announced
@repeatable
def static_loads(
    scene: Scene,
    speeds: float | Sequence[float] | np.ndarray = 0.0,
    at: Positions | None = None,
    points: SectionPoints | None = None,
    angle: float = 0.0,
    youngs_modulus: float | None = None,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> StaticLoads:
    """Compute the loads along the span in equilibrium at steady speeds, about a fixed centre.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.  Gravity acts as it does at the `angle` of rotation: at a speed
        other than 0 it varies, as `transient_loads` and `steady_loads` model.
    speeds : float or sequence of float
        Speeds [rad/s], ascending.
    at : sequence of float, optional
        Stations [m]; by default 21 evenly along the beam, and both sides of each jump.  A position that is
        given twice stands for both of its sides, a single position for the outboard side.
    points : sequence of (float, float), optional
        Points of the section at which strain and stress are wanted [m], along its first direction and along
        the second; by default the outer fibres, or the corners of a rectangle that bends in two planes.
    angle : float
        Angle of rotation [rad].
    youngs_modulus : float, optional
        Young's modulus [Pa] for the stress; known of beams made by `Beam.rectangular`.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        Allowed error, relative to the largest of each quantity along the span, from 1e-14 to 0.1: the
        smallest model that meets it is chosen.  By default models are chosen as for `natural_modes`.

    Returns
    -------
    StaticLoads

    Raises
    ------
    ValueError
        If an argument is out of its range, a point lies outside the section, or large deflection is modelled.
    NoEquilibrium
        An ArithmeticError: if rotation or its own weight buckles the straight beam, or the beam turns freely
        about its root.

    References
    ----------
    Equilibrium of the part beyond the cut (standard); neglected modes respond statically: Craig and Kurdila
    (2006), Fundamentals of Structural Dynamics, section 11.4.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215, setting_angle=np.pi))
    >>> pull = bd.static_loads(scene, speeds=50.0).force[0, 0, 0]  # N, at the root
    >>> round(float(pull), 4), round(7850 * 0.01 * 0.0002 * 0.05 * (0.215 + 0.025) * 50**2, 4)  # m r w^2
    (0.471, 0.471)
    """
    check_scene(scene)
    refuse_large_deflection(scene, STRAIGHT)
    speeds = ascending("speeds", speeds)
    check_speeds(speeds)
    theta = real("angle", angle, "rad")
    tolerance = None if tolerance is None else within("tolerance", tolerance, *TOLERANCES)
    scene = choose_physics(scene, speeds, _MODES, tolerance, barred_of_loads(scene))
    asked = span_loads.AskedLoads.of(scene, at, points, youngs_modulus)

    def solved(model: Model) -> _Solved:
        fine, coarse = (_solve(each, asked, speeds, theta) for each in (model, model.coarser))
        found, coarse = fine.outputs, coarse.outputs
        rounding = fine.rounding() + _ROUNDING * np.abs(found).max(axis=1, keepdims=True)
        across = distance_across(model, lambda fewer: _solve(fewer, asked, speeds, theta).outputs, found)
        distance = np.abs(found - coarse) + across  # at some stations either may be small by chance
        distance = np.maximum(distance, _ALONG * distance.max(axis=1, keepdims=True))
        return _Solved(model, found, BASES_OF_STATIC_LOADS.factor * distance + rounding, fine.tip)

    def finer(found: _Solved) -> _Solved | None:
        model = refine_model(found.model) if isinstance(discretization, str) else None
        return None if model is None else solved(model)

    model = model_to_tolerance(scene.undamped, discretization, speeds, _MODES, tolerance)
    best = refine(
        solved(model),
        finer,
        lambda found: tolerance is None or found.relative_error(asked.outputs) <= tolerance,
    )
    names = str(best.model.discretization), str(best.model.coarser.discretization)
    warnings = [*_warnings(scene, best.model, speeds, best.tip)]
    if tolerance is not None:
        warnings += warn_of_missed_tolerance(best.relative_error(asked.outputs), tolerance)
    made = asked.result(best.value, best.error, warnings, *names)
    return StaticLoads(**made, speeds=speeds, angle=theta, tip=best.tip)


class _Solved(NamedTuple):
    """Loads computed with one model: K outputs and their errors, (C, S, K), and tip deflections (C, d).

    C counts speeds, S stations, and d the directions in which the beam bends.
    """

    model: Model
    value: np.ndarray
    error: np.ndarray
    tip: np.ndarray

    def relative_error(self, outputs: StationOutputs) -> float:
        """Compute each quantity's ratio of error to largest value along the span, and return the largest."""
        values, errors = (outputs.split(np.nan_to_num(np.abs(each))) for each in (self.value, self.error))
        sizes = {name: each.max(initial=0.0) for name, each in values.items()}
        return max((errors[name].max() / size for name, size in sizes.items() if size), default=0.0)


def _warnings(scene: Scene, model: Model, speeds: np.ndarray, tip: np.ndarray) -> Iterator[str]:
    """Yield warnings: effects left out, and large deflection or strain at the speeds."""
    yield from warn_of_left_out(scene)
    _, stretch = static_load(model, speeds)
    yield from warn_of_strain(float(stretch.max()))
    size = np.hypot.reduce(np.abs(tip), axis=1)
    yield from warn_of_static_deflection(size, scene.beam.length, speeds)


@dataclass(frozen=True)
class _Equilibria:
    """Equilibria of one model at C speeds: coordinates (C, n), and what gives K outputs at S stations.

    The stiffness matrices K are divided by the outer products of the scales `size` (C, n) of the coordinates.
    """

    equations: Equations
    rows: LoadRows
    root: RootMotion
    scaled: np.ndarray
    size: np.ndarray
    q: np.ndarray

    @property
    def outputs(self) -> np.ndarray:
        """Outputs, (C, S, K)."""
        return self.rows.at(self.root, self.q, np.zeros_like(self.q))

    @property
    def tip(self) -> np.ndarray:
        """Tip deflections [m] in d directions, (C, d)."""
        return self.q @ self.equations.tips.T

    def rounding(self) -> np.ndarray:
        """Compute the errors of the outputs by rounding of the entries of the stiffness matrices."""
        found = []
        for by_coordinate, scaled, size, q in zip(
            self.rows.per_coordinate(self.root), self.scaled, self.size, self.q, strict=True
        ):
            load = (by_coordinate / size).reshape(-1, len(q)).T
            answer = np.linalg.solve(scaled, load).T.reshape(by_coordinate.shape)
            found.append(rounding_of_entries(scaled, answer, q * size))
        return np.array(found)


def _solve(model: Model, asked: span_loads.AskedLoads, speeds: np.ndarray, theta: float) -> _Equilibria:
    """Compute the equilibria of a model at C speeds, at the angle of rotation theta [rad]."""
    equations = model.equations
    rows = span_rows(model.scene, model.discretization, equations, asked.stations)
    rows = rows.through(asked.outputs.matrix)
    root = equations.root(replace(MotionSample.steady(speeds), angle=np.full(len(speeds), theta)))
    K = equations.matrix(0, root)
    size = np.sqrt(np.einsum("cii->ci", np.abs(K)))
    size[size == 0] = 1.0  # trial functions without stiffness are not scaled
    scaled = K / (size[:, :, None] * size[:, None, :])
    least = np.linalg.eigvalsh((scaled + scaled.swapaxes(1, 2)) / 2)[:, 0]
    if (lost := least <= _SINGULAR).any():
        raise NoEquilibrium(
            f"the straight beam has no stable equilibrium at {speeds[lost][0]:.6g} rad/s: rotation or its "
            "own weight buckles it at this or a lower speed, or it turns freely about its root"
        )
    q = np.linalg.solve(scaled, (equations.load(root) / size)[..., None])[..., 0] / size
    return _Equilibria(equations, rows, root, scaled, size, q)
