"""Results of Lee and Yoo beside a beam that bends by any angle: setting angles, Fig. 8 and 9."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache

import numpy as np
from matplotlib.axes import Axes
from scipy.optimize import brentq

from beamdyn.common.plots.plots import plot_loci_by_angle
from beamdyn.common.results.comparison import Comparison
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.locus import frequency_locus
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modes import natural_modes
from beamdyn.published import load
from beamdyn.reproduce.common import BENDS, OWN, PAPER, TOP, decimals, published_scene
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

_LINEAR = "paper's model"
_SPEEDS = (100.0, 400.0)  # at which the figures are judged [rad/s]: that of Table 2, and one beyond
_BASIS = Ritz(16)  # of the limits: their frequencies are good to 1e-13
_STEP = 0.5  # of speed, by which slopes at rest and at the top speed are found [rad/s]
_FIRST_BETWEEN, _SECOND_BETWEEN = (80.0, 89.9), (2.0, 6.0)  # angles at which the slopes have two signs [deg]
_DRAWN, _DRAWN_TOLERANCE = 41, 1e-4  # speeds of a curve, and its relative error


def bending_scene(setting_angle: float) -> Scene:
    """Published scene at a setting angle [deg], with large deflection."""
    scene = published_scene()
    mount = replace(scene.mount, setting_angle=float(np.radians(setting_angle)))
    return replace(scene, mount=mount, physics=Physics(large_deflection=True))


def first_frequencies() -> Iterator[Comparison]:
    """Compare the first frequency [Hz] with that of linear equations at the angles of Fig. 8 and 9."""
    figures = load("lee_yoo_2019")["figures"]
    angles = [*figures["fig_8"]["setting_angle"], *figures["fig_9"]["setting_angle"]]
    for angle in angles[1::2]:
        for speed in _SPEEDS:
            ours, error = _first_frequency(bending_scene(angle), speed)
            linear, _ = _first_frequency(replace(bending_scene(angle), physics=Physics()), speed)
            yield Comparison(f"{angle:g} deg, {speed:g} rad/s", _LINEAR, linear, ours, error, 2, BENDS)
    for row in load("elastica")["harvester"]:
        angle, speed, known = row["setting_angle_deg"], row["speed"], row["frequency"]
        ours, error = _first_frequency(bending_scene(angle), speed)
        yield Comparison(
            f"{angle:g} deg, {speed:g} rad/s", OWN, float(known), ours, error, decimals(float(known))
        )


def _first_frequency(scene: Scene, speed: float) -> tuple[float, float]:
    """First frequency and its estimated error [Hz]."""
    modes = natural_modes(scene, speed, 1)
    return float(modes.frequency[0]), float(modes.frequency[0] * modes.error[0])


def limits_of_setting_angle() -> Iterator[Comparison]:
    """Compare with Section 3.3: the setting-angle limits [deg] of a beam that bends."""
    printed = load("lee_yoo_2019")["setting_angle_limits"]
    first, error = _first_limit()
    yield Comparison("first limit, at rest", PAPER, tuple(printed["first"]["value"]), first, error, 2)
    second, error = _second_limit()
    what = f"second limit, to {TOP:g} rad/s"
    yield Comparison(what, PAPER, tuple(printed["second"]["value"]), second, error, 2, BENDS)


def _first_limit() -> tuple[float, float]:
    """Angle at which the slope of the first frequency at rest changes sign, and its error [deg]."""
    return _zero(_change_from_rest, _FIRST_BETWEEN)


@cache
def _second_limit() -> tuple[float, float]:
    """Angle at which the slope of the first frequency at the top speed changes sign, and its error [deg]."""
    return _zero(_change_at_top, _SECOND_BETWEEN)


def _zero(change: Callable[[float, float], float], between: tuple[float, float]) -> tuple[float, float]:
    """Angle [deg] at which the change over a small step is 0, extrapolated to none, and its error."""
    near, far = (float(brentq(change, *between, (step,), 1e-11)) for step in (_STEP, 2 * _STEP))  # pyright: ignore
    return near + (near - far) / 3, abs(near - far) / 30


def _change_from_rest(angle: float, speed: float) -> float:
    still, turning = _squared(angle, np.array([0.0, speed]))
    return turning - still


def _change_at_top(angle: float, step: float) -> float:
    before, after = _squared(angle, np.array([TOP - step, TOP + step]))
    return after - before


def _squared(angle: float, speeds: np.ndarray) -> np.ndarray:
    """Squared first angular frequency [rad2/s2] at some speeds [rad/s]."""
    solver = Model(bending_scene(angle), _BASIS).solver
    return np.abs(solver.eigenvalues(speeds, 1)[:, 0]) ** 2


def notes() -> Iterator[str]:
    """Note on the tables."""
    angle = load("lee_yoo_2019")["setting_angle_limits"]["first"]["value"][1]
    rest, turning = (_first_frequency(bending_scene(angle), speed)[0] for speed in (0.0, _SPEEDS[0]))
    yield (
        "(9) Rotation bends this beam, unless it points at the axis, and the paper's equations are linear "
        "about the straight beam: ours are those of an inextensible beam of any slope. It has the first "
        f"limit of the paper at rest only: at {angle:g} deg its frequency does not stay, but is "
        f"{turning - rest:.2f} Hz higher at {_SPEEDS[0]:g} rad/s. From {_second_limit()[0]:.2f} deg on it "
        f"rises again before {TOP:g} rad/s, and at no angle does it rise first and then fall."
    )


def draw_first_frequencies(angles: list[float], top: float, ax: Axes) -> None:
    """Draw the first frequency of a bending beam over speed at setting angles [deg], one line each."""
    speeds = np.linspace(0, top, _DRAWN)
    loci = [frequency_locus(bending_scene(a), speeds, 1, tolerance=_DRAWN_TOLERANCE) for a in angles]
    plot_loci_by_angle(speeds, np.array([locus.frequency[:, 0] for locus in loci]), angles, ax)
