"""Warnings about sharp bending: of strain past linear elasticity, and of the suppressed camber of a strip.

A strongly bent strip cannot camber freely and is nearly as stiff as a wide plate.  A strip of width b and
thickness t under the curvature kappa cambers freely if b^2 kappa/t (Searle's parameter) is small.  Above
about 1, camber is suppressed more and more (half of it at 10), because it would stretch the strip.  With
theta = (3 (1 - nu^2))^(1/4) b (kappa/t)^(1/2) its energy per length, of bending and of the stress that camber
causes along it, is

    U = E I kappa^2 (1 - nu^2 f)/(2 (1 - nu^2)),    f = 2 h/theta,
    h = (cosh theta - cos theta)/(sinh theta + sin theta),

and the stiffness of small vibrations d^2 U/dkappa^2.

References
----------
Searle (1908), Experimental Elasticity; Ashwell (1950), Journal of the Royal Aeronautical Society 54, 708.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from beamdyn.common.results.statements import MODEL_ERROR, Statement
from beamdyn.common.words import Words, percent, told_from
from beamdyn.modes.model_error.added_effects import ASSUMED_POISSONS_RATIO
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import warn_of_elastic_limit

_CAMBER_DECLINES = 1.0  # Searle's parameter above which camber is suppressed
_WIDEST = 50.0  # argument theta above which the functions of a curved strip have reached their limits
_STATIONS = 101


def tangent_stiffening(theta: np.ndarray, nu: float) -> np.ndarray:
    """Compute the ratio of the tangent bending stiffness of a curved strip to E I.

    The argument `theta`, above 0, is the measure of width and curvature in the module's docstring, `nu` is
    Poisson's ratio.
    """
    wide = np.minimum(theta, _WIDEST)
    total, rate = np.sinh(wide) + np.sin(wide), np.cosh(wide) + np.cos(wide)
    h, e = (np.cosh(wide) - np.cos(wide)) / total, rate / total
    first = 1 - h * e  # dh/dtheta; the next line is the second derivative
    second = -first * e - h * ((np.sinh(wide) - np.sin(wide)) / total - e**2)
    tangent = 5 / 4 * first + wide / 4 * second + 3 / 4 * h / theta
    return (1 - nu**2 * tangent) / (1 - nu**2)


def warn_of_sharp_bending(
    scene: Scene, bending: Callable[[np.ndarray], np.ndarray], say_when: Callable[[int], Words | str]
) -> Iterator[Statement]:
    """Yield warnings if large deflection strains a beam past linear elasticity, or suppresses its camber.

    `bending` returns curvatures (k, m) [1/m] in the direction of bending at k speeds or times and x/L (m,);
    `say_when` describes the time or speed of an index in words.
    """
    xi = np.linspace(0, 1, _STATIONS)
    curvature = np.abs(bending(xi))
    if scene.beam.outer_fibre is not None:
        yield from warn_of_elastic_limit(curvature * scene.beam.outer_fibre(xi), say_when)
    yield from _warn_of_suppressed_camber(scene, xi, curvature, say_when)


def _warn_of_suppressed_camber(
    scene: Scene, xi: np.ndarray, curvature: np.ndarray, say_when: Callable[[int], Words | str]
) -> Iterator[Statement]:
    """Yield a warning if a strip is bent so far that its camber is suppressed."""
    section = scene.beam.section
    if section is None or section.poissons_ratio == 0:
        return  # camber requires Poisson's ratio
    nu = section.poissons_ratio
    b, t = section.width(xi), section.thickness(xi)
    searle = b**2 * curvature / t
    if not searle.max(initial=0.0) > _CAMBER_DECLINES:
        return
    at, place = np.unravel_index(searle.argmax(), searle.shape)
    ratio = ASSUMED_POISSONS_RATIO if nu is None else nu
    theta = (3 * (1 - ratio**2)) ** 0.25 * b[place] * np.sqrt(curvature[at, place] / t[place])
    stiffer = float(tangent_stiffening(theta, ratio)) - 1
    assumed = "" if nu is not None else f", with Poisson's ratio {ratio:g} assumed"
    parameter = told_from(float(searle[at, place]), _CAMBER_DECLINES)
    bent = f"b^2 kappa/t = {parameter} (Searle's parameter) at x/L = {xi[place]:.2g}"
    where = f" the strip is bent to {bent}"
    worth = (
        f": above 1 camber is suppressed in part: the strip is up to {percent(stiffer)} stiffer, its "
        f"frequencies up to {percent(np.sqrt(1 + stiffer) - 1)} higher{assumed}; no model here includes it"
    )
    size = {"quantity": "Searle's parameter b^2 kappa/t", "value": searle[at, place]}
    yield Statement(say_when(int(at)), where, worth, kind=MODEL_ERROR, limit=_CAMBER_DECLINES, **size)
