"""Mode shapes of a blade in one plane, without twist, and the polynomials that ElastoDyn takes for them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.modes.modes import natural_modes
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.profile import Profile
from beamdyn.scene.scene import Scene

NAMES: Mapping[str, str] = {"flap 1": "BldFl1Sh", "flap 2": "BldFl2Sh", "edge 1": "BldEdgSh"}
PLACES = np.linspace(0, 1, 401)  # x/L at which shapes are compared and fitted
_POWERS = np.arange(2, 7)
_TOLERANCE = 1e-6  # of the frequencies of the shapes


@dataclass(frozen=True)
class ModePolynomial:
    """The polynomial of x/L with the powers 2 to 6 that is closest to a mode shape.

    Parameters
    ----------
    mode : str
        Such as "flap 1".
    coefficients : tuple of float
        Those of the powers 2 to 6; they add up to 1, the deflection at the tip.
    difference : float
        Largest difference from the mode shape with the same deflection at the tip, relative to it.
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
        """The lines of a blade file of ElastoDyn."""
        name, said = NAMES[self.mode], f"{self.mode.split()[0].capitalize()} mode {self.mode.split()[1]}"
        return [
            f"{value:12.6f}   {name}({power}) - {said}, coeff of x^{power}"
            for power, value in zip(_POWERS, self.coefficients, strict=True)
        ]


def fit_mode_polynomials(scene: Scene, speed: float) -> tuple[ModePolynomial, ...]:
    """Fit a polynomial to each mode shape that ElastoDyn takes, by least squares over equal steps of x/L.

    Parameters
    ----------
    scene : Scene
        A blade; without a second bending stiffness its flap modes alone are fitted.
    speed : float
        Speed of rotation [rad/s].
    """
    planes = ("flap", "edge") if scene.beam.second_bending_stiffness is not None else ("flap",)
    return tuple(_fit(scene, mode, speed) for mode in NAMES if mode.split()[0] in planes)


def _fit(scene: Scene, mode: str, speed: float) -> ModePolynomial:
    shape, frequency = shape_of(scene, mode, speed)
    last = PLACES ** _POWERS[-1]
    others = PLACES[:, None] ** _POWERS[:-1] - last[:, None]  # of each 0 at the tip: the sum stays 1
    first = np.linalg.lstsq(others, shape - last, rcond=None)[0].round(6)  # as many digits as are written
    coefficients = (*map(float, first), round(1 - float(first.sum()), 6))
    difference = float(np.abs(polynomial(coefficients) - shape).max())
    return ModePolynomial(mode, coefficients, difference, frequency)


def polynomial(coefficients: tuple[float, ...] | np.ndarray) -> np.ndarray:
    """The polynomial with the powers 2 to 6 at `PLACES`."""
    return PLACES[:, None] ** _POWERS @ np.asarray(coefficients)


def shape_of(scene: Scene, mode: str, speed: float) -> tuple[np.ndarray, float]:
    """The mode at `PLACES`, 1 at the tip, of the plane alone and without twist; and its frequency [Hz]."""
    plane, number = mode.split()
    modes = natural_modes(_one_plane(scene, plane), speed, int(number), tolerance=_TOLERANCE)
    shape = np.real(modes.shape(PLACES * scene.beam.length))[-1]
    return shape / shape[-1], float(modes.frequency[-1])


def _one_plane(scene: Scene, plane: str) -> Scene:
    """The blade without twist, bending in one plane alone: the model of the deck's program."""
    second = scene.beam.second_bending_stiffness
    stiffness: Profile | None = scene.beam.bending_stiffness if plane == "flap" else second
    assert stiffness is not None
    blade = scene.beam
    beam = Beam(
        blade.length,
        blade.mass_per_length,
        stiffness,
        tip=_turned(blade.tip, plane),
        point_masses=blade.point_masses,
    )
    angle = math.pi / 2 if plane == "flap" else 0.0
    mount = Mount(scene.mount.radius, scene.mount.setting_angle, angle)
    return replace(scene.undamped, beam=beam, mount=mount, physics=Physics())


def _turned(tip: TipMass | None, plane: str) -> TipMass | None:
    """The tip body for bending in the plane."""
    if tip is None or plane == "flap":
        return tip
    return replace(tip, inertia=tip.inertia_about_bending_direction, transverse_inertia=tip.inertia)
