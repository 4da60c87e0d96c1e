"""What the steady rotation alone does to a beam: static deflection of the tip, and axial strain."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from beamdyn.common.results.statements import OUTSIDE, Statement
from beamdyn.equations.mass import axial_tension
from beamdyn.modes.modal.model import Model
from beamdyn.scene.mount import RIGHT_ANGLE, exact_cos_sin
from beamdyn.scene.validity import list_speeds, warn_of_static_deflection, warn_of_strain


def static_load(model: Model, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute the static tip deflection and axial strain by rotation.

    Parameters
    ----------
    model : Model
        A discretized scene.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].

    Returns
    -------
    deflection : ndarray, shape (S,)
        Static tip deflection [m], its magnitude in two planes; nan from the critical speed on.
    strain : ndarray, shape (S,)
        Largest static axial strain; nan if the axial stiffness is not given.
    """
    beam, mount = model.scene.beam, model.scene.mount
    tips = model.static_tips(speeds)
    deflection = tips[:, 0] if tips.shape[1] == 1 else np.linalg.norm(tips, axis=1)
    if beam.axial_stiffness is None:
        return deflection, np.full(len(speeds), np.nan)
    n_a, n_b = axial_tension(beam)
    xi = np.linspace(0, 1, 101)
    cosine, _ = exact_cos_sin(mount.precone)
    force = cosine**2 * n_b(xi) - cosine * np.cos(mount.setting_angle) * mount.radius * n_a(xi)
    return deflection, np.abs(force / beam.axial_stiffness(xi)).max() * speeds**2


def warn_of_rotation(model: Model, speed: float) -> Iterator[Statement]:
    """Yield a warning if the rotation stretches or bends a beam by more than linear theory allows.

    Parameters
    ----------
    model : Model
        A discretized scene.
    speed : float
        Speed [rad/s].
    """
    speeds = np.array([speed])
    deflection, strain = static_load(model, speeds)
    yield from warn_of_strain(float(strain[0]))
    yield from warn_of_static_deflection(deflection, model.scene.beam.length, speeds)
    yield from warn_of_straight(deflection, speeds, model)


def warn_of_straight(deflection: np.ndarray, speeds: np.ndarray, model: Model) -> Iterator[Statement]:
    """Yield a warning where the straight beam is unstable, which the rotation would have bent before."""
    lost = np.isnan(deflection)
    if lost.any() and bends(model):
        end = f" the straight beam is unstable; the rotation bends it before: the answer is {OUTSIDE}"
        yield Statement("at ", list_speeds(speeds, lost), end, kind=OUTSIDE)


def bends(model: Model) -> bool:
    """Whether a steady rotation loads the straight beam transversely, but for a misalignment of 1e-8 rad."""
    equations, scene = model.equations, model.scene
    load = np.abs(equations.steady().f2[equations.places(equations.deflections)]).max(initial=0.0)
    along = max(np.abs(equations.P(d)).max() for d in range(scene.physics.planes))
    return bool(load > RIGHT_ANGLE * along * (scene.mount.radius + scene.beam.length))
