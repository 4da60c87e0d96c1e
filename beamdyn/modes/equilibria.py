"""Equilibria of a beam with arbitrarily large deflection by rotation, and their branches over speed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from time import perf_counter
from typing import cast

import numpy as np

from beamdyn.accuracy.refinement import SLOW_BASES
from beamdyn.common.inputs.checks import InvalidValue, one_of, positive, real
from beamdyn.common.plots.plots import plot_branches
from beamdyn.common.plots.plots_of_shapes import plot_bent_beam
from beamdyn.common.results.one_line import error_at_most, listed, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import GROWING, Speeds, Statement
from beamdyn.common.words import Words
from beamdyn.equations.effects import modelled_directions
from beamdyn.modes.modal import continuation
from beamdyn.modes.modal.continuation import Loading, NoEquilibrium
from beamdyn.modes.modal.discretization_choice import (
    DiscretizationChoice,
    choose_model,
    solve_to_tolerance,
)
from beamdyn.modes.modal.equilibrium import DeflectedSolver, find_bent
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.effect_choice import plain_physics
from beamdyn.modes.model_error.left_out_changes import SolvedValues, left_out_by_solving
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.model_error.sharp_bending import warn_of_sharp_bending
from beamdyn.modes.modes import provenance_of
from beamdyn.scene.mount import Mount, aligned_cos_sin
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import check_speeds

_FINE = 0.05  # nondimensional arc length of a continuation step, small enough for smooth curves in a plot
_MOST_POINTS = 2000  # largest number of points of a branch
_STEEPEST = 2 * np.pi  # largest slope angle [rad] up to which a branch is continued
_UNSTABLE = "the effects are estimated on the straight beam, which is unstable"
_JUST_BELOW = 1 - 1e-9  # ratio of the last listed speed of the stable straight beam to its critical speed
_ROUNDING = 1e-13  # rounding error of a position, relative to the length
# Relative rounding error of loads and stiffness, which deflects the beam much more near buckling.
_OF_LOADS = 16 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Equilibrium(SceneResult, StatesModelError):
    """Equilibrium of a beam at a steady speed, with any deflection.

    `error` is the numerical error.  `left_out` contains the estimated relative change of the tip deflection
    by each neglected physical effect, for small deflections, `model_error` the magnitude of the sum of these
    changes; both are computed at first use.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    branch : str
        "straight": continued from rest as the speed rises, also if rotation bends the beam; "bent": another
        equilibrium at this speed, bent to the opposite side.
    tip : ndarray, shape (3,)
        Position of the tip from the root along b1, b2, b3 [m]: b1 along the beam at its root, b2 across it in
        the plane of rotation, b3 perpendicular to both.
    tip_angle : float
        Slope angle of the tip, from b1 towards the direction of bending [rad]; in space the angle between
        the beam at the tip and b1.
    error : float
        Estimated error of the position of the tip [m].
    stable : bool
        Whether all small motions about the equilibrium stay small.
    growth_rate : float
        Largest growth rate of a small motion [1/s]; 0 if it is stable.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> mount = bd.Mount(radius=0.215, setting_angle=np.pi / 4)
    >>> scene = bd.Scene(strip, mount, physics=bd.Physics(large_deflection=True))
    >>> found = bd.equilibrium(scene, speed=100.0)
    >>> found.stable, round(float(np.degrees(found.tip_angle)), 2)
    (True, -27.24)
    """

    speed: float
    branch: str
    tip: np.ndarray
    tip_angle: float
    error: float
    stable: bool
    growth_rate: float
    model: Model = field(repr=False)

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the equilibrium; see `Result.headline`."""
        unit = self.display_units.length_unit()
        yield f"at {self.say_speed(self.speed)}: tip at {listed(self.tip * unit.per_si, unit.name)}"
        yield error_at_most(self.error * unit.per_si, unit.name)
        yield from ("stable" if self.stable else "unstable", warned(self.warnings))

    judged_value = "the deflection of the tip"

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Changes of the straight beam's tip deflection by each neglected effect: shape ()."""
        return left_out_by_solving(self.scene, self._solve_static)

    def _solve_static(self, scene: Scene, _: str) -> SolvedValues:
        """Compute the static tip deflection of a straight beam that includes an effect."""
        speeds = np.array([self.speed])
        tip = np.linalg.norm(choose_model(scene.undamped, "ritz", speeds, 1).static_tips(speeds))
        return SolvedValues(np.asarray(tip), _UNSTABLE if np.isnan(tip) else "")

    def shape(self, x: np.ndarray | Sequence[float]) -> np.ndarray:
        """Compute positions (len(x), 3) along b1, b2, b3 [m] of the points at x [m] along the beam.

        b1 is along the beam at its root, b2 perpendicular to it in the plane of rotation, b3 to both.
        """
        xi = np.asarray(x, dtype=float) / self.scene.beam.length
        if xi.size and not (xi.min() >= 0 and xi.max() <= 1 + 1e-12):
            raise InvalidValue("x", x, f"positions run from 0 to the length {self.scene.beam.length:g} m")
        solver = self.model.deflected
        bent = solver.elastica.beam.at(solver.equilibria(np.array([self.speed]))[0])
        return _in_space(bent.beam.stations.to_places(np.minimum(xi, 1.0), bent.tangents).T, self.scene.mount)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the bent beam in equilibrium."""
        points = self.shape(np.linspace(0, self.scene.beam.length, 201)) / self.scene.beam.length
        stability = "stable" if self.stable else "unstable"
        title = f"{stability} equilibrium at {self.say_speed(self.speed)}, {self.branch} branch"
        across, names = _directions(self.scene.mount) @ points[:, 1:].T, modelled_directions(self.scene)
        return plot_bent_beam(points[:, 0], across, names, ax, title)


def equilibrium(
    scene: Scene,
    speed: float,
    branch: str | None = None,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Equilibrium:
    """Compute the equilibrium of the beam at a steady speed, about a fixed centre and without gravity.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.  Large deflection is modelled in any case.
    speed : float
        Speed [rad/s].
    branch : {"straight", "bent"}, optional
        "straight": the equilibrium continued from rest as the speed rises; "bent": the stable one that exists
        above a critical speed or a turning point, bent to the opposite side.  The default is the branch of
        `scene.physics`.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`, for the first natural frequency about the equilibrium.

    Returns
    -------
    Equilibrium

    Raises
    ------
    NoEquilibrium
        If the branch has no equilibrium at this speed (an ArithmeticError).

    References
    ----------
    Inextensible elastica (Euler); own derivation: docs/conventions.md, section Large deflection.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> mount = bd.Mount(radius=0.215, setting_angle=np.pi / 4)
    >>> scene = bd.Scene(strip, mount, physics=bd.Physics(large_deflection=True))
    >>> bd.equilibrium(scene, speed=100.0).tip[:2].round(5)  # m, along the beam and across
    array([ 0.04645, -0.01724])
    """
    start = perf_counter()
    scene = _with_large_deflection(scene, branch)
    speeds = np.array([real("speed", speed, "rad/s")])
    check_speeds(speeds, "speed")
    solution = solve_to_tolerance(scene, discretization, speeds, 1, tolerance)
    solver, coarse = solution.model.deflected, cast("DeflectedSolver", solution.model.coarse_solver)
    q = solver.equilibria(speeds)[0]
    tip, of_coarse = solver.elastica.beam.at(q).tip, np.full(3, np.inf)
    with suppress(NoEquilibrium):  # the coarser model buckles later, and may have no such equilibrium yet
        of_coarse = coarse.elastica.beam.at(coarse.equilibria(speeds)[0]).tip
    growth = solver.growth_rate(q, float(speeds[0]))
    error = np.abs(tip - of_coarse).max() * (SLOW_BASES.factor if solution.model.lacks_two else 1.0)
    at = Words("at ", Speeds(float(speeds[0])))
    sharp = warn_of_sharp_bending(scene, partial(solver.elastica.curvature, q[None]), lambda _: at)
    loaded = "a small transverse force at the tip leads to a stable equilibrium, if there is one"
    remedy = loaded if scene.tip_load.acts else 'branch="bent" gives the stable one, on the opposite side'
    said = "the equilibrium is unstable ", at, f": a small motion grows at {growth:.3g} 1/s; {remedy}"
    rate = {"quantity": "growth rate [1/s]", "value": growth, "limit": 0.0}
    unstable = Statement(*said, kind=GROWING, remedy=remedy, **rate)
    return Equilibrium(
        speed=float(speeds[0]),
        branch=scene.physics.branch,
        tip=_in_space(tip, scene.mount),
        tip_angle=solver.elastica.tip_angle(q),
        error=float(error) + _rounding(solver.load, q, speeds[0] ** 2) * scene.beam.length,
        stable=growth <= 0,
        growth_rate=max(growth, 0.0),
        warnings=(*(() if growth <= 0 else (unstable,)), *sharp),
        provenance=provenance_of(solution, start),
        scene=scene,
        model=solution.model,
    )


def _rounding(load: Loading, q: np.ndarray, p: float) -> float:
    """Estimate the rounding error of positions, divided by the length, at coordinates q and squared speed p.

    It includes the deflection by a change of all loads within rounding, which is large near buckling.  The
    magnitude of the loads is taken from the elastic forces, which balance them.
    """
    turned = np.linalg.solve(load.at(q, p).change, load.elastica.beam.stiffness @ q) @ load.angles
    return _ROUNDING + _OF_LOADS * float(np.abs(turned).max())


def _with_large_deflection(scene: object, branch: str | None) -> Scene:
    """Return the scene with large deflection, on a given branch of equilibria."""
    check_scene(scene)
    assert isinstance(scene, Scene)
    branch = scene.physics.branch if branch is None else branch
    one_of("branch", branch, ("straight", "bent"))
    return plain_physics(scene).with_large_deflection(branch=branch)


def _directions(mount: Mount) -> np.ndarray:
    """Compute components along b2, b3 of the direction of bending and of the perpendicular one (rows).

    b2 is in the plane of rotation, b3 perpendicular to it.
    """
    c, s = aligned_cos_sin(mount.bending_angle)
    return np.array([[c, s], [-s, c]])


def _in_space(positions: np.ndarray, mount: Mount) -> np.ndarray:
    """Transform positions (..., 3) along b1 and both directions of bending to positions along b1, b2, b3."""
    return np.concatenate([positions[..., :1], positions[..., 1:] @ _directions(mount)], axis=-1)


# Branches over speed ------------------------------------------------------------------------------


@dataclass(frozen=True)
class EquilibriumBranch:
    """Points of one branch of equilibria, in the order of continuation.

    Parameters
    ----------
    name : str
        "straight" or "bent", as the branches of `equilibrium`.
    speeds : ndarray, shape (k,)
        Speeds [rad/s].
    tip : ndarray, shape (k, 3)
        Positions of the tip from the root along b1, b2, b3 [m]: b1 along the beam at its root, b2 across it
        in the plane of rotation, b3 perpendicular to both.
    stable : ndarray of bool, shape (k,)
        Whether the potential energy, including that of centrifugal forces, has a minimum there; with a load
        at the tip, whether no small motion grows.
    turning_speeds : ndarray, shape (t,)
        Speeds [rad/s] at which the branch turns back, at a fold or where it meets the straight beam.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), physics=bd.Physics(large_deflection=True))
    >>> straight = bd.equilibrium_branches(scene, top_speed=180.0).branches[0]
    >>> bool(straight.stable[0]), bool(straight.stable[-1])  # it buckles at 159.8 rad/s
    (True, False)
    """

    name: str
    speeds: np.ndarray
    tip: np.ndarray
    stable: np.ndarray
    turning_speeds: np.ndarray


@dataclass(frozen=True)
class EquilibriumBranches(SceneResult):
    """Branches of equilibria from rest to a top speed.

    Parameters
    ----------
    top_speed : float
        Top speed [rad/s].
    branches : tuple of EquilibriumBranch
        The branch from rest, then another branch that exists at the top speed, if any.
    critical_speed : float
        Speed at which the straight beam buckles [rad/s]; inf if rotation bends it at every speed, nan if a
        load at the tip may make it flutter.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), physics=bd.Physics(large_deflection=True))
    >>> len(bd.equilibrium_branches(scene, top_speed=180.0).branches)
    2
    """

    top_speed: float
    branches: tuple[EquilibriumBranch, ...]
    critical_speed: float

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the branches; see `Result.headline`."""
        yield f"{' and '.join(each.name for each in self.branches)} up to {self.say_speed(self.top_speed)}"
        if np.isfinite(self.critical_speed):
            yield f"straight beam buckles at {self.say_speed(self.critical_speed)}"
        yield warned(self.warnings)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the deflection of the tip over speed: solid where the equilibrium is stable, else dashed."""
        across, length = _directions(self.scene.mount)[0], self.scene.beam.length
        lines = [(b.name, b.speeds, b.tip[:, 1:] @ across / length, b.stable) for b in self.branches]
        return plot_branches(lines, ax, self.display_units)


def equilibrium_branches(
    scene: Scene, top_speed: float, discretization: DiscretizationChoice = "ritz"
) -> EquilibriumBranches:
    """Follow the branches of equilibria over speed, through their turning points.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.  Large deflection is modelled in any case.
    top_speed : float
        Top speed [rad/s].
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    EquilibriumBranches

    References
    ----------
    As `equilibrium`; followed by Keller's (1977) pseudo-arclength continuation.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), physics=bd.Physics(large_deflection=True))
    >>> found = bd.equilibrium_branches(scene, top_speed=180.0)
    >>> round(found.critical_speed, 3), [branch.name for branch in found.branches]
    (159.818, ['straight', 'bent'])
    """
    start = perf_counter()
    scene, top = _with_large_deflection(scene, "straight"), positive("top_speed", top_speed, "rad/s")
    check_speeds(top, "top_speed")
    model = choose_model(scene, discretization, np.array([0.0, top]), 1)
    solver = model.deflected
    load, rest, warnings = solver.load, solver.load.at_rest, ()
    if load.bends or scene.may_flutter_by_load:
        branches = [_collect("straight", solver, continuation.start_curve(load, rest, 0.0, 1.0), top)]
    else:
        speeds = np.union1d(np.linspace(0, top, 101), min(top, _JUST_BELOW * solver.critical_speed))
        tips = np.tile(_in_space(load.elastica.beam.at(rest).tip, scene.mount), (len(speeds), 1))
        # The straight beam is stable below its critical speed and at no speed above it, because its stiffness
        # is linear in the squared speed.
        branches = [EquilibriumBranch("straight", speeds, tips, speeds < solver.critical_speed, np.empty(0))]
    try:  # follows another branch, if there is one, from the top speed through its turning points
        start_of_bent = continuation.start_curve(load, find_bent(load, top), top**2, -1.0)
        branches.append(_collect("bent", solver, start_of_bent, top))
    except NoEquilibrium as error:
        warnings = (str(error),)
    return EquilibriumBranches(
        top_speed=top,
        branches=tuple(branches),
        critical_speed=np.nan if scene.may_flutter_by_load else solver.critical_speed,
        warnings=warnings,
        provenance=Provenance.since(start, str(model.discretization)),
        scene=scene,
    )


def _collect(name: str, solver: DeflectedSolver, start: continuation.Point, top: float) -> EquilibriumBranch:
    """Collect the points of a branch until it passes the top speed, or until the beam has turned by 2 pi."""
    points, load = [start], solver.load
    with suppress(continuation.NotConverged):  # the points end where the branch cannot be continued
        for point in continuation.follow(load, start, _FINE):
            if point.p >= top**2 and point.p_rate:
                at_top = continuation.find_at(load, points[-1], point, top**2)
                points.append(replace(point, q=at_top, p=top**2))
                break
            points.append(point)
            if np.abs(point.q @ load.angles).max() > _STEEPEST or len(points) > _MOST_POINTS:
                break
    # At a turning point the stiffness is singular; the point counts as stable if the branch before it is.
    judged = [b if b.p_rate else a for a, b in zip([start, *points], points, strict=False)]
    tips = load.elastica.beam.at(np.array([point.q for point in points])).tip
    stable = np.array([*map(solver.is_stable, judged)])
    speeds = np.sqrt([max(point.p, 0.0) for point in points])
    turning = np.sqrt([point.p for point in points if not point.p_rate])
    return EquilibriumBranch(name, speeds, _in_space(tips, load.elastica.linear.mount), stable, turning)
