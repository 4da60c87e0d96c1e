"""Guaranteed lower and upper bounds of natural frequencies of bending, and of critical speeds.

The bounds follow from a Ritz basis by the theorem proved in the docstring of `beamdyn.modes.residual_bound`.
This module enlarges the basis until the bounds hardly get narrower.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from time import perf_counter
from typing import TypeAlias

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.common.inputs.checks import count, real
from beamdyn.common.results.one_line import listed, spanned, warned
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import GROWING, NO_ANSWER, Statement, announced_of_plain_beam
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.flexibility import bound_flexibility
from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.modes.model_error.effect_choice import plain_physics, warn_of_plain
from beamdyn.modes.planes import refuse_uncovered, separate_planes
from beamdyn.modes.residual_bound import CoupledEnclosure, Enclosure, PlaneEnclosure
from beamdyn.modes.ritz_part import MOST_MOMENTS, basis, most_functions, segments_with_functions
from beamdyn.scene.beam import Beam, PointMass, TipMass
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import check_speeds, warn_of_static_deflection

_EPS = float(np.finfo(float).eps)
_NARROW = 1e-11  # relative width of bounds of squared frequencies below which the basis is not enlarged
# Relative width of bounds of squared frequencies below which the basis of two coupled planes is not enlarged:
# their bases are twice as large, and this width is a few times the allowances for rounding.
_RESOLVED = 1e-8
# Numbers of functions, on all segments together, tried for a bound of the critical speed.
_PROOF_SIZES = (24, 48, 96)
# Ratio of a lower bound to Ritz's value of the squared critical speed, from which the bound is close enough.
_CLOSE = 1 - 1e-6
# Fractions of the squared critical speed by Ritz's method that are tried as lower bounds.
_SHARES = np.concatenate([1 - 10.0 ** np.arange(-13, 0), 4.0 ** -np.arange(0.5, 45)])
_HOW = "upper: Rayleigh-Ritz; lower: Rayleigh-Ritz minus a bound of the coupling to all other functions"
_OF_DEFLECTION = 1e-3  # relative error of the model that computes the static deflection


@dataclass(frozen=True)
class FrequencyBounds(SceneResult):
    """Guaranteed bounds of the exact natural frequencies of bending, the lowest first.

    Parameters
    ----------
    speed : float
        Speed [rad/s].
    lower, upper : ndarray, shape (m,)
        Bounds of the frequency [Hz]; nan if the mode is (for `lower`: may be) unstable.
    lower_squared, upper_squared : ndarray, shape (m,)
        Bounds of the squared angular frequency [rad2/s2], negative for an unstable mode; nan where
        none is guaranteed.
    width : ndarray, shape (m,)
        Relative width upper / lower - 1; nan where a bound is nan.
    how : str
        How the bounds are guaranteed, in words.
    warnings : tuple of str
        Missing bounds and their reasons; also a deflection by rotation that is too large for the model.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215))
    >>> bounds, modes = bd.frequency_bounds(scene, 50.0), bd.natural_modes(scene, 50.0)
    >>> bool(((bounds.lower <= modes.frequency) & (modes.frequency <= bounds.upper)).all())
    True
    """

    speed: float
    lower: np.ndarray
    upper: np.ndarray
    lower_squared: np.ndarray
    upper_squared: np.ndarray
    width: np.ndarray
    how: str

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the bounds; see `Result.headline`."""
        yield f"{len(self.lower)} at {self.say_speed(self.speed)}: {listed(self.upper, 'Hz')}"
        yield from (f"relative width {spanned(self.width)}", warned(self.warnings))


@announced_of_plain_beam
def frequency_bounds(scene: Scene, speed: float = 0.0, modes: int = 3) -> FrequencyBounds:
    """Compute guaranteed lower and upper bounds of the natural frequencies of bending at a steady speed.

    The bounds hold for the undamped Euler-Bernoulli model, in one plane or in two, which the twist or the
    bending angle may couple; see docs/bounds.md.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.  Physics "auto" means the plain Euler-Bernoulli beam.
    speed : float
        Speed [rad/s].
    modes : int
        Number of modes.

    Returns
    -------
    FrequencyBounds

    Raises
    ------
    ValueError
        If an argument is out of its range, or the scene has a property that the theorem does not cover:
        stretch, shear, rotary inertia, damping, springs at the root, or two planes that the precone couples.

    References
    ----------
    Own theorem, stated and proved in docs/bounds.md.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> bounds = bd.frequency_bounds(bd.Scene(strip, bd.Mount(radius=0.215)), speed=50.0, modes=2)
    >>> bool((bounds.upper / bounds.lower - 1 < 1e-9).all())
    True
    """
    start = perf_counter()
    check_scene(scene)
    speed, modes = real("speed", speed, "rad/s"), count("modes", modes)
    refuse_uncovered(scene, speed)
    unresolved, scene = scene, plain_physics(scene)
    check_speeds(speed, "speed")
    planes = separate_planes(scene, speed != 0)
    parts = (most_functions(plane.beam) * segments_with_functions(plane.beam) for plane in planes)
    most = min(parts, default=MOST_MOMENTS)
    if modes > most:
        raise ValueError(
            f"modes = {modes}: give at most {max(0, most)}, the number of functions for this beam; the "
            "higher the degree of its properties, the fewer there are"
        )
    enclosed = [_enclose(plane, speed, modes) for plane in planes or (scene,)]
    # The k-th lowest frequency of both planes together lies between the k-th lowest of all lower bounds and
    # of all upper bounds.
    lower = _lowest([low for low, _, _ in enclosed], modes, -np.inf)
    upper = _lowest([high for _, high, _ in enclosed], modes, np.inf)
    method = max((ritz for _, _, ritz in enclosed), key=lambda ritz: ritz.functions)
    speeds = np.array([speed])  # for a warning if rotation bends the beam too far for the model
    tips = choose_model(scene, "ritz", speeds, 1, _OF_DEFLECTION).static_tips(speeds)
    deflection = np.linalg.norm(tips, axis=1)
    bent = warn_of_static_deflection(deflection, scene.beam.length, speeds)
    low, high = _frequency(lower, -8), _frequency(upper, 8)
    return FrequencyBounds(
        speed=speed,
        lower=low,
        upper=high,
        lower_squared=lower,
        upper_squared=upper,
        width=high / low - 1,
        how=_HOW,
        warnings=(*warn_of_plain(unresolved), *_warnings(lower, upper), *bent),
        provenance=Provenance.since(start, str(method), "its complement"),
        scene=scene,
    )


def _lowest(of_planes: Sequence[np.ndarray], modes: int, missing: float) -> np.ndarray:
    """Merge the bounds of all planes, and return the lowest, ascending; nan where none is known.

    With several planes, an unknown bound (nan) counts as `missing`, which is -inf for lower bounds and inf
    for upper ones.  A bound lower than that of the plane's previous mode is replaced by the latter.
    """
    if len(of_planes) == 1:
        return of_planes[0][:modes]
    filled = [np.where(np.isnan(bounds), missing, bounds) for bounds in of_planes]
    lowest = np.sort(np.concatenate([np.maximum.accumulate(bounds) for bounds in filled]))[:modes]
    return np.where(np.isinf(lowest), np.nan, lowest)


def _widen(values: np.ndarray, units: int) -> np.ndarray:
    """Increase (units > 0) or decrease (units < 0) values by a number of rounding units."""
    return values + units * _EPS * np.abs(values)


def _frequency(squared: np.ndarray, units: int) -> np.ndarray:
    """Convert squared angular frequencies to frequencies [Hz]; nan if negative.

    The frequencies are then increased (units > 0) or decreased (units < 0) by a number of rounding units.
    """
    return _widen(np.sqrt(np.where(squared > 0, squared, np.nan)) / (2 * np.pi), units)


def _warnings(lower: np.ndarray, upper: np.ndarray) -> Iterator[Statement]:
    why = ": the error by functions outside the basis could not be bounded, even with the largest basis"
    missing = "no lower bound of ", why
    unstable = "", ": unstable, see the bounds of the squares"
    undecided = "", ": maybe unstable, because the bounds of the squared frequency enclose zero"
    for mask, kind, (begin, end) in (
        (np.isnan(lower), NO_ANSWER, missing),
        (upper <= 0, GROWING, unstable),
        ((lower <= 0) & (upper > 0), GROWING, undecided),
    ):
        numbers = np.flatnonzero(mask) + 1
        if len(numbers):
            few = ", ".join(map(str, numbers)) if len(numbers) < 6 else f"{numbers[0]} ... {numbers[-1]}"
            noun = "mode" if len(numbers) == 1 else "modes"
            yield Statement(f"{begin}{noun} {few}{end}", kind=kind)


def _nondimensional(scene: Scene) -> tuple[Scene, float]:
    """Scale a scene to unit length, mass and stiffness; also return the unit of time [s]."""
    beam, length = scene.beam, scene.beam.length
    m, e = (p.coefficients[0][0] for p in (beam.mass_per_length, beam.bending_stiffness))
    mass, stiffness = beam.mass_per_length.scaled(1 / m), beam.bending_stiffness.scaled(1 / e)
    # The unit of mass is the mass of a uniform beam with the root's section.
    tip, unit = beam.tip or TipMass(0.0), m * length
    moments = (tip.inertia, tip.inertia_about_bending_direction, tip.axial_inertia)
    tip = TipMass(tip.mass / unit, tip.offset / length, *(j / (unit * length**2) for j in moments))
    xi, lumped = (values.tolist() for values in beam.lumps)
    lumps = tuple(PointMass(x, lump / unit) for x, lump in zip(xi, lumped, strict=True))
    scaled = Beam(1.0, mass, stiffness, tip=tip, point_masses=lumps)
    if scene.physics.planes == 2 and beam.second_bending_stiffness is not None:
        second = beam.second_bending_stiffness.scaled(1 / e)
        scaled = replace(scaled, second_bending_stiffness=second, twist=beam.twist)
    mount = replace(scene.mount, radius=scene.mount.radius / length)
    return Scene(scaled, mount, physics=scene.physics), length**2 * float(np.sqrt(m / e))


def bound_critical_speed(scene: Scene) -> float:
    """Compute a guaranteed lower bound of the critical speed of bending [rad/s]; 0 if none is proved.

    The theorem in `beamdyn.modes.residual_bound`, for the lowest squared angular frequency (k = 1) and the
    bound z = 0, proves that the stiffness is positive semidefinite at this speed and thus at every lower one.
    """
    scaled, time = _nondimensional(scene)
    if (flexibility := bound_flexibility(scaled.beam.bending_stiffness)) is None:
        return 0.0
    most, segments = most_functions(scaled.beam), segments_with_functions(scaled.beam)
    sizes = iter(_PROOF_SIZES)

    def finer(found: tuple[float, float]) -> tuple[float, float] | None:
        """Enlarge the basis, and prove stability up to a speed with it.

        Returns the squared speed below which stability is proved, and the squared critical speed by Ritz's
        method; None if there is no larger basis to try.
        """
        if (total := next(sizes, None)) is None:
            return None
        part = PlaneEnclosure(scaled, min(most, max(6, total // segments)), 1.0, flexibility)
        softening = float(np.maximum(-part.spin, 0) @ part.tails)
        largest = min(1 / max(softening, _EPS), part.ritz_critical_speed**2)
        for squared in largest * _SHARES:
            form = part.stiffness_form(squared)
            if form is not None and np.isfinite(form).all() and np.linalg.eigvalsh(form)[0] >= 0:
                return max(found[0], float(squared)), part.ritz_critical_speed**2
        return found[0], part.ritz_critical_speed**2

    proved, _ = refine((0.0, np.inf), finer, lambda found: found[0] >= _CLOSE * found[1])
    return float(_widen(np.sqrt(np.array(proved)), -8) / time)


# Search for narrow bounds ---------------------------------------------------------------------------


def _enclose(scene: Scene, speed: float, modes: int) -> tuple[np.ndarray, np.ndarray, Ritz]:
    """Bound squared angular frequencies in one plane or two coupled planes; also return the last basis."""
    scaled, time = _nondimensional(scene)
    beam, speed = scaled.beam, speed * time
    first = bound_flexibility(beam.bending_stiffness)
    if scene.physics.planes == 1:
        sizes = _growing(max(6, (16 + 2 * modes) // segments_with_functions(beam)), most_functions(beam))
        lower, upper, functions = _narrow(
            lambda size: PlaneEnclosure(scaled, size, speed, first), sizes, modes, _NARROW
        )
        ritz = basis(beam, functions)
    else:
        assert beam.second_bending_stiffness is not None
        second = bound_flexibility(beam.second_bending_stiffness)
        if first is None or second is None:
            return np.full(modes, np.nan), np.full(modes, np.nan), Ritz(1, "moments")
        both, sizes = (first, second), _growing(min(MOST_MOMENTS, 12 + 2 * modes), MOST_MOMENTS)
        lower, upper, moments = _narrow(
            lambda size: CoupledEnclosure(scaled, size, speed, both), sizes, modes, _RESOLVED
        )
        ritz = Ritz(moments, "moments")
    return _widen(lower, -8) / time**2, _widen(upper, 8) / time**2, ritz


# Lower and upper bounds, size of the basis, and width of the bounds for the previous basis.
_Found: TypeAlias = tuple[np.ndarray, np.ndarray, int, np.ndarray]


def _narrow(
    enclosure: Callable[[int], Enclosure], sizes: Iterator[int], modes: int, narrow: float
) -> tuple[np.ndarray, np.ndarray, int]:
    """Compute bounds with growing bases until they hardly get narrower, and the size of the final basis."""

    def finer(found: _Found) -> _Found | None:
        lower, upper, _, _ = found
        # Rounding may make the eigensolution of a large basis fail.
        with suppress(StopIteration, np.linalg.LinAlgError):
            size = next(sizes)
            low, high = enclosure(size).bounds(modes)
            return np.fmax(lower, low), np.fmin(upper, high), size, upper - lower
        return None

    def meets(found: _Found) -> bool:
        lower, upper, _, before = found
        width = upper - lower
        return bool((width <= narrow * np.abs(upper)).all() or (width > before / 2).all())

    unknown = np.full(modes, np.nan)
    return refine((unknown, unknown, 0, unknown), finer, meets)[:3]


def _growing(size: int, most: int) -> Iterator[int]:
    """Yield increasing numbers of functions, from `size` up to `most`."""
    while size < most:
        yield size
        size = 4 * size // 3
    yield most
