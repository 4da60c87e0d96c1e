"""Setting angles at which the trend of the first frequency over speed changes between falling and rising."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from time import perf_counter
from typing import ClassVar

import numpy as np
from scipy.linalg import eigh
from scipy.optimize import brentq

from beamdyn.accuracy.refinement import BASES_OF_PLATES, THREE_DISCRETIZATIONS, error_of_finest
from beamdyn.common.inputs.checks import InvalidValue, positive
from beamdyn.common.results.one_line import error_at_most, listed, warned
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import NO_ANSWER, OUTSIDE, Statement, announced_of_plain_beam
from beamdyn.common.words import Named
from beamdyn.equations import effects
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice, model_to_tolerance
from beamdyn.modes.modal.distance_across import distance_across
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.modes.modal.model import Model, static_load
from beamdyn.modes.model_error.effect_choice import choose_physics
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import LARGE_DEFLECTION, check_speeds, refuse_large_deflection

_LINEAR = "the limits are those of linear theory: the loci of a bent beam have another shape at every angle"
# Rounding error of an angle [rad]: the cosine of a limit is a quotient of small differences.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class SettingAngleLimits(SceneResult, JudgedByRepeating):
    """Setting angles between which the first frequency rises and then falls with speed.

    Below `first` the frequency falls from speed 0 on; between both angles it rises and then falls before the
    top speed; above `second` it rises up to the top speed.  ``first, second = limits`` unpacks both.

    `left_out` contains the estimated relative change of the two angles by each neglected physical effect,
    `model_error` (2,) the magnitude of the sum of these changes; both are computed at first use.

    Parameters
    ----------
    first, second : float
        The two setting angles [rad]; nan if there is no such angle.
    error : float
        Estimated absolute error of both angles [rad].
    top_speed : float
        The top speed [rad/s].
    static_deflection : float
        Static tip deflection at the second limit and the top speed, as a fraction of the length.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> limits = bd.setting_angle_limits(bd.Scene(strip, bd.Mount(radius=0.215)), top_speed=50.0)
    >>> limits.first < limits.second
    True
    """

    first: float
    second: float
    error: float
    top_speed: float
    static_deflection: float

    follows_stiffness: ClassVar[bool] = False
    judged_value = "the setting angles"
    counted = "limit"

    def judged(self, found: SettingAngleLimits) -> np.ndarray:
        """Return the two angles for which the model error is stated: shape (2,)."""
        return np.array([*found])

    @property
    def bending_speed(self) -> float:
        """Speed [rad/s] at which the change by large deflection is estimated."""
        return self.top_speed

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the limits; see `Result.headline`."""
        yield f"{listed(np.degrees([*self]), 'deg')} up to {self.say_speed(self.top_speed)}"
        yield from (error_at_most(np.degrees(self.error), "deg"), warned(self.warnings))

    def __iter__(self) -> Iterator[float]:
        return iter((self.first, self.second))


@announced_of_plain_beam
@repeatable
def setting_angle_limits(
    scene: Scene,
    top_speed: float,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> SettingAngleLimits:
    """Compute setting angles above which the first frequency stops falling, and above which it only rises.

    Parameters
    ----------
    scene : Scene
        The scene; its setting angle, motion, damping and stretch are not used.  With two planes, the first
        frequency is the lower one.
    top_speed : float
        Top speed [rad/s]; inf only with a basis of given size, because the limits then depend on the basis.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`, for the first frequency at the top speed.

    Returns
    -------
    SettingAngleLimits

    Raises
    ------
    ValueError
        If the top speed is not positive, or infinite without a basis of given size, or if the root is hinged.

    References
    ----------
    Lee and Yoo (2019), section 3.3; with slopes by Southwell (1921), see docs/conventions.md.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> limits = bd.setting_angle_limits(bd.Scene(strip, bd.Mount(radius=0.215)), top_speed=50.0)
    >>> round(float(np.degrees(limits.first)), 4)  # Lee and Yoo (2019): 88.35 to 88.36
    88.3598
    """
    start = perf_counter()
    check_scene(scene)
    locus = Named("frequency_locus", "beamdyn locus")
    refuse_large_deflection(scene, _LINEAR, ", or ask ", locus, " for the locus at a setting angle")
    for name in ("root_stiffness", "second_root_stiffness")[: scene.physics.planes]:
        if getattr(scene.mount, name) == 0:
            bound = "the first frequency of a beam on a hinge is 0 at rest, and neither rises nor falls"
            raise InvalidValue(name, 0.0, bound, "give a spring", "N m/rad")
    if scene.mount.precone:
        bound = "only an outward beam has a precone, but the limits are setting angles of other beams"
        raise InvalidValue("precone", scene.mount.precone, bound, "leave it out", "rad")
    bounded = isinstance(discretization, str) or not isinstance(top_speed, float) or top_speed != np.inf
    if bounded:
        remedy = (
            "a converged limit needs a finite top speed; discretization=Ritz(5, 'eigenfunctions') allows inf"
        )
        top_speed = positive("top_speed", top_speed, "rad/s", remedy)
        check_speeds(top_speed, "top_speed")
    speeds = np.array([top_speed if bounded else 0.0])
    chosen = choose_physics(scene, speeds, 1, tolerance, {effects.LARGE_DEFLECTION.name: _LINEAR})
    scene = replace(chosen.undamped, physics=replace(chosen.physics, stretch=False))
    tangential = replace(scene, mount=replace(scene.mount, setting_angle=np.pi / 2))
    model = model_to_tolerance(tangential, discretization, speeds, 1, tolerance)
    first, second = _limits(model, top_speed)
    # At an infinite top speed the limits depend on the basis, which has to be given.  They are limits of that
    # model, exact within rounding.
    error, coarse = _ROUNDING, model.coarser
    if bounded:
        of_coarse, of_coarsest = (np.array(_limits(each, top_speed)) for each in (coarse, coarse.coarser))
        errors = error_of_finest(THREE_DISCRETIZATIONS, (first, second) - of_coarse, of_coarse - of_coarsest)
        limits = np.array([first, second])
        across = distance_across(model, lambda fewer: np.array(_limits(fewer, top_speed)), limits)
        error += float(np.nanmax([*(errors + BASES_OF_PLATES.factor * across), 0.0]))
    deflection = np.nan  # ratio of deflection to length, at the second limit
    if bounded and not np.isnan(second):
        mounted = replace(scene, mount=replace(scene.mount, setting_angle=second))
        tip, _ = static_load(Model(mounted, model.discretization), speeds)
        deflection = float(abs(tip[0]) / scene.beam.length)
    return SettingAngleLimits(
        first=first,
        second=second,
        error=error if model.exceeds_coarser else np.inf,
        top_speed=top_speed,
        static_deflection=deflection,
        warnings=tuple(_limit_warnings(first, second, deflection)),
        provenance=Provenance.since(start, str(model.discretization), str(coarse.discretization)),
        scene=chosen,
    )


def _limits(tangential: Model, top_speed: float) -> tuple[float, float]:
    """Compute the setting angles [rad] at which the first squared frequency has slope 0 over squared speed.

    Return two angles: the first for the slope at rest, the second for the slope at the top speed; nan if
    there is no such angle.

    The stiffness matrix is K0 + speed^2 (A - cos(setting angle) B).  A belongs to a setting angle of 90 deg,
    at which `tangential` is modelled, and B is the radius of the root times the stiffness due to the tension
    by a unit acceleration of the root.
    """
    pencil, stiffness = tangential.solver.pencil, tangential.equations.matrices[0]
    # The matrix "root_axial" is minus K_GA, the stiffness by tension.
    by_tension = stiffness.get("root_axial", np.zeros_like(pencil.K2))
    A, B = pencil.K2, -tangential.scene.mount.radius * by_tension
    v = tangential.solver.solve(np.zeros(1), 1).vector[0, :, 0]
    first = _arccos(float(v @ A @ v), float(v @ B @ v))
    if np.isinf(top_speed):
        return first, _arccos(float(eigh(A, B, eigvals_only=True)[0]), 1.0) if B.any() else np.nan

    def slope(phi: float) -> float:
        """Differentiate the first squared frequency with respect to squared speed, at the top speed."""
        K2 = A - np.cos(phi) * B
        v = Solver(replace(pencil, K2=K2)).solve(np.array([top_speed]), 1).vector[0, :, 0]
        return float(v @ K2 @ v)

    low = 0.0 if np.isnan(first) else first
    if slope(low) * slope(np.pi) >= 0:
        return first, np.nan
    root = brentq(slope, low, np.pi, xtol=1e-15, rtol=1e-15)  # pyright: ignore[reportArgumentType]
    return first, float(root)


def _arccos(a: float, b: float) -> float:
    return float(np.arccos(a / b)) if abs(a) <= abs(b) and b else np.nan


def _limit_warnings(first: float, second: float, deflection: float) -> Iterator[Statement]:
    for limit, said in (
        (first, "no first limit: at rest the first frequency"),
        (second, "no second limit: at the top speed the first frequency"),
    ):
        if np.isnan(limit):
            yield Statement(f"{said} rises, or falls, at every setting angle alike", kind=NO_ANSWER)
    if not deflection <= LARGE_DEFLECTION:
        text = f" (static tip deflection {deflection:.3g} of the length at the top speed)"
        known = "" if np.isnan(deflection) else text
        said = f"rotation bends the beam statically at the limits, which are {OUTSIDE}{known}"
        about = {"quantity": "static tip deflection over the length", "value": deflection}
        yield Statement(said, kind=OUTSIDE, limit=LARGE_DEFLECTION, **about)
