"""Audit of a blade from another program: mass and its moments, steep steps, comparison of mode shapes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.results.one_line import counted, number, warned
from beamdyn.common.results.result import Result
from beamdyn.equations.mass import moments_about_root
from beamdyn.files.decks.blade import Blade
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.profile import Profile
from beamdyn.scene.scene import Scene

SHAPE_NAMES: Mapping[str, str] = {"flap 1": "BldFl1Sh", "flap 2": "BldFl2Sh", "edge 1": "BldEdgSh"}
PLACES = np.linspace(0, 1, 401)  # positions x/L at which shapes are compared and fitted
_POWERS = np.arange(2, 7)
_TOLERANCE = 1e-6  # tolerance for the frequencies of computed shapes


@dataclass(frozen=True)
class ModePolynomial:
    """The polynomial of x/L with the powers 2 to 6 that is closest to a mode shape.

    Parameters
    ----------
    mode : str
        Name of the mode, such as "flap 1".
    coefficients : tuple of float
        Coefficients of the powers 2 to 6; they add up to 1, the deflection at the tip.
    difference : float
        Largest difference from the mode shape, relative to the common deflection at the tip.
    frequency : float
        Frequency of the mode [Hz].

    Examples
    --------
    >>> shape = bd.ModePolynomial("flap 1", (0.06, 1.7, -3.2, 3.8, -1.36), 1e-3, 0.68)
    >>> round(sum(shape.coefficients), 2)  # 1 at the tip
    1.0
    """

    mode: str
    coefficients: tuple[float, ...]
    difference: float
    frequency: float

    def lines(self) -> list[str]:
        """Return lines with the coefficients, as in blade files of the wind turbine program ElastoDyn.

        A line has a coefficient, ElastoDyn's name of the shape with the power of x in brackets, and, after a
        hyphen, a remark such as "Flap mode 1, coeff of x^2".
        """
        name, said = (
            SHAPE_NAMES[self.mode],
            f"{self.mode.split()[0].capitalize()} mode {self.mode.split()[1]}",
        )
        return [
            f"{value:12.6f}   {name}({power}) - {said}, coeff of x^{power}"
            for power, value in zip(_POWERS, self.coefficients, strict=True)
        ]


def fit_mode_polynomials(scene: Scene, speed: float) -> tuple[ModePolynomial, ...]:
    """Fit a polynomial to each mode shape that ElastoDyn uses, by least squares over equal steps of x/L.

    Parameters
    ----------
    scene : Scene
        A blade; if it has no second bending stiffness, only its flap modes are fitted.
    speed : float
        Speed of rotation [rad/s].
    """
    planes = ("flap", "edge") if scene.beam.second_bending_stiffness is not None else ("flap",)
    return tuple(_fit(scene, mode, speed) for mode in SHAPE_NAMES if mode.split()[0] in planes)


def _fit(scene: Scene, mode: str, speed: float) -> ModePolynomial:
    shape, frequency = shape_of(scene, mode, speed)
    last = PLACES ** _POWERS[-1]
    # Each of these functions is 0 at the tip, so that the deflection at the tip stays 1.
    others = PLACES[:, None] ** _POWERS[:-1] - last[:, None]
    # Rounded to as many digits as are written to the file.
    first = np.linalg.lstsq(others, shape - last, rcond=None)[0].round(6)
    coefficients = (*map(float, first), round(1 - float(first.sum()), 6))
    difference = float(np.abs(polynomial(coefficients) - shape).max())
    return ModePolynomial(mode, coefficients, difference, frequency)


def polynomial(coefficients: tuple[float, ...] | np.ndarray) -> np.ndarray:
    """Evaluate the polynomial with the powers 2 to 6 of x/L at `PLACES`."""
    return PLACES[:, None] ** _POWERS @ np.asarray(coefficients)


def shape_of(scene: Scene, mode: str, speed: float) -> tuple[np.ndarray, float]:
    """Compute a mode in one plane without twist: shape at `PLACES`, 1 at the tip, and frequency [Hz]."""
    plane, number = mode.split()
    modes = natural_modes(_one_plane(scene, plane), speed, int(number), tolerance=_TOLERANCE)
    shape = np.real(modes.shape(PLACES * scene.beam.length))[-1]
    return shape / shape[-1], float(modes.frequency[-1])


def _one_plane(scene: Scene, plane: str) -> Scene:
    """Return the blade without twist, bending in one plane only, as ElastoDyn models it."""
    second = scene.beam.second_bending_stiffness
    stiffness: Profile | None = scene.beam.bending_stiffness if plane == "flap" else second
    assert stiffness is not None
    blade = scene.beam
    bodies: dict[str, Any] = {"tip": _turned(blade.tip, plane), "point_masses": blade.point_masses}
    beam = Beam(blade.length, blade.mass_per_length, stiffness, **bodies)
    angle = math.pi / 2 if plane == "flap" else 0.0
    mount = Mount(scene.mount.radius, scene.mount.setting_angle, angle)
    return replace(scene.undamped, beam=beam, mount=mount, physics=Physics())


def _turned(tip: TipMass | None, plane: str) -> TipMass | None:
    """Return the tip body for bending in one plane.

    It has no offset across, and its `inertia` is that about the axis of this bending.
    """
    tip = tip and replace(tip, offset_across=0.0)
    if tip is None or plane == "flap":
        return tip
    return replace(tip, inertia=tip.inertia_about_bending_direction, transverse_inertia=tip.inertia)


# Checks of the data in a deck ---------------------------------------------------------------------


STEEP = 3.0  # smallest factor between neighbouring stations that is reported as a steep step
_SUM_ERROR = 1e-3  # largest error of the sum of a mode shape's coefficients that ElastoDyn accepts
_SHAPE_ERROR = 0.05  # difference from the computed shape, at tip deflection 1, that causes a warning
_STEPPED = ("mass_per_length", "bending_stiffness", "second_bending_stiffness")
_STEPPED_NAMES = {"mass_per_length": "mass", "bending_stiffness": "flap stiffness"}
_STEPPED_NAMES |= {"second_bending_stiffness": "edge stiffness"}


@dataclass(frozen=True)
class PropertyStep:
    """A property that changes by a large factor between neighbouring stations.

    Parameters
    ----------
    name : str
        Name of the property.
    start, end : float
        Positions x/L of the two stations; they are equal at a jump.
    factor : float
        Value at the end divided by the value at the start.

    Examples
    --------
    >>> step = bd.PropertyStep("bending_stiffness", 0.2, 0.25, 3.0)
    >>> step.sentence()
    'bending_stiffness rises by a factor of 3 from x/L = 0.2 to 0.25, 0.05 of the length'
    """

    name: str
    start: float
    end: float
    factor: float

    def sentence(self) -> str:
        """Describe the step as a sentence."""
        place = (
            f"at x/L = {self.start:g}"
            if self.start == self.end
            else (f"from x/L = {self.start:g} to {self.end:g}, {self.end - self.start:.2g} of the length")
        )
        ratio = self.factor if self.factor >= 1 else 1 / self.factor
        return f"{self.name} {'rises' if self.factor > 1 else 'falls'} by a factor of {ratio:.3g} {place}"


@dataclass(frozen=True)
class ShapeCheck:
    """A mode shape stated in a deck, compared with the mode shape computed from the blade's properties.

    Parameters
    ----------
    mode : str
        Name of the mode, such as "flap 1".
    coefficient_sum : float
        Sum of the nondimensional coefficients: the deflection at the tip, which should be 1.
    difference : float
        Largest difference of the two shapes, relative to the tip deflection, which both have.
    place : float
        Position x/L of the largest difference.
    frequency : float
        Frequency of the computed mode [Hz].

    Examples
    --------
    >>> check = bd.ShapeCheck("flap 1", coefficient_sum=1.0, difference=0.003, place=0.4, frequency=0.68)
    >>> check.difference < 0.01
    True
    """

    field_units: ClassVar[dict[str, str]] = {"Hz": "frequency"}

    mode: str
    coefficient_sum: float
    difference: float
    place: float
    frequency: float


@dataclass(frozen=True)
class DeckAudit(Result):
    """Audit of a blade from another program: mass, moments, steep steps, and mode shapes.

    Properties vary linearly between stations.  Mass and moments include point masses along the blade, but not
    the body at the tip.

    Parameters
    ----------
    stations : int
        Number of stations.
    mass : float
        Mass of the blade [kg].
    first_moment, second_moment : float
        First and second moment of the mass about the root [kg m, kg m2].
    hub_second_moment : float
        Second moment of the mass about the axis of rotation [kg m2], without cone.
    centre : float
        Distance of the centre of mass from the root [m].
    stiffness_ratios : tuple of float
        Smallest divided by largest stiffness, for flapwise bending and, if given, edgewise bending.
    steps : tuple of PropertyStep
        Steep steps, from root to tip.
    shapes : tuple of ShapeCheck
        Mode shapes stated in the deck, compared with computed ones; empty if there are none.
    shape_speed : float
        Rotational speed at which shapes are compared [rad/s].
    warnings : tuple of str
        Signs of mistakes in the deck.

    Examples
    --------
    >>> deck = bd.read_deck("examples/blade_stations.csv", length=40.0, hub_radius=1.25)
    >>> deck.audit.stations, round(deck.audit.centre / 40.0, 2)  # centre of mass over the length
    (9, 0.3)
    """

    field_units: ClassVar[dict[str, str]] = {
        "kg": "mass",
        "kg m": "first_moment",
        "kg m2": "second_moment hub_second_moment",
        "m": "centre",
        "rad/s": "shape_speed",
    }

    stations: int
    mass: float
    first_moment: float
    second_moment: float
    hub_second_moment: float
    centre: float
    stiffness_ratios: tuple[float, ...]
    steps: tuple[PropertyStep, ...]
    shapes: tuple[ShapeCheck, ...]
    shape_speed: float
    warnings: tuple[str, ...]

    def headline(self) -> Iterator[str]:
        """Yield stations, mass, centre of mass and steep steps of the blade, for the one-line summary.

        See `Result.headline`.
        """
        yield f"{counted(self.stations, 'station')}, {number(self.mass, 'kg')}"
        yield f"centre at {number(self.centre, 'm')}"
        yield counted(len(self.steps), "steep step") if self.steps else ""
        yield warned(self.warnings)


def audit(blade: Blade, scene: Scene) -> DeckAudit:
    """Audit a blade, using the beam of its scene."""
    beam, hub = scene.beam, scene.mount.radius
    mass, first, second = moments_about_root(beam)
    speed = blade.speed * math.pi / 30
    shapes = tuple(_check_shape(scene, mode, row, speed) for mode, row in blade.polynomials.items())
    return DeckAudit(
        stations=len(blade.stations),
        mass=mass,
        first_moment=first,
        second_moment=second,
        hub_second_moment=second + 2 * hub * first + hub**2 * mass,
        centre=first / mass,
        stiffness_ratios=tuple(
            float(values.min() / values.max())
            for name in _STEPPED[1:]
            if (values := blade.columns.get(name)) is not None
        ),
        steps=find_steps(blade),
        shapes=shapes,
        shape_speed=speed,
        warnings=(*blade.doubts, *_warnings(shapes)),
    )


def find_steps(blade: Blade) -> tuple[PropertyStep, ...]:
    """Find properties that change by a factor of `STEEP` or more between neighbouring stations."""
    x = blade.stations
    found: list[PropertyStep] = []
    for name in _STEPPED:
        if (values := blade.columns.get(name)) is not None:
            factors = values[1:] / values[:-1]
            found += [
                PropertyStep(_STEPPED_NAMES[name], float(x[k]), float(x[k + 1]), float(factors[k]))
                for k in np.flatnonzero(np.maximum(factors, 1 / factors) >= STEEP)
            ]
    return tuple(sorted(found, key=lambda step: step.start))


# Mode shapes --------------------------------------------------------------------------------------


def _check_shape(scene: Scene, mode: str, coefficients: np.ndarray, speed: float) -> ShapeCheck:
    """Compare a polynomial with the computed mode in one plane without twist, at the speed of the deck."""
    total = float(coefficients.sum())
    shape, frequency = shape_of(scene, mode, speed)
    apart = np.abs(polynomial(coefficients) / total - shape) if total else np.full(len(shape), math.inf)
    k = int(apart.argmax())
    return ShapeCheck(mode, total, float(apart[k]), float(PLACES[k]), frequency)


def _warnings(shapes: tuple[ShapeCheck, ...]) -> list[str]:
    wrong_sums = [
        f"the coefficients of {shape.mode} add up to {shape.coefficient_sum:.6g}; they must add up to 1"
        for shape in shapes
        if abs(shape.coefficient_sum - 1) > _SUM_ERROR
    ]
    return wrong_sums + [
        f"the deck's shape of {shape.mode} differs from the shape computed from its stations by "
        f"{shape.difference:.2g} of the tip deflection, at x/L = {shape.place:.3g}"
        for shape in shapes
        if shape.difference > _SHAPE_ERROR
    ]
