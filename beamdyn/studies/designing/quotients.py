"""Results that are extrema or means of quotients, and the numbers that increase or decrease these.

By the minimum-maximum principle an undamped beam with the default physics has

    (2 pi f)^2 = V(w)/T(w) for a frequency f at rest,    Omega^2 = V(w)/G(w) for the critical speed Omega,

for certain deflections w, where V is twice the elastic energy, T the mass times the squared deflection, and G
twice the work of the centrifugal forces at unit speed.  A number that increases the quotient for every
deflection increases the result, for any mode; a number that decreases it decreases the result.

G is a sum over masses m.  With R = r cos(beta) of radius r and setting angle beta, and the cosine d of the
bending angle, a mass m at a distance x from the root contributes

    m (R - x) int_0^x w'^2 + m d^2 w(x)^2,

a body at the tip with its centre of mass at L + e

    m (R - L - e) (int_0^L w'^2 + e w'(L)^2) + m d^2 (w(L) + e w'(L))^2,

    and its moments of inertia contribute with either sign.  Derivation: docs/conventions.md, section
    Equations.
"""

from __future__ import annotations

import numpy as np

from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import NO_DAMPING, exact_cos_sin
from beamdyn.scene.numbers import SCALE
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

QUOTIENTS = {
    "frequencies": "the Rayleigh quotient of every deflection at rest",
    "critical_speed": "the elastic energy of every deflection over the work of the centrifugal forces on it",
}
_STIFFNESS: dict[str, int] = dict.fromkeys(
    ("beam.youngs_modulus", "beam.bending_stiffness", f"{SCALE}bending_stiffness", "mount.root_stiffness"), 1
)
_MASS = dict.fromkeys(("beam.density", "beam.mass_per_length", f"{SCALE}mass_per_length"), -1)
_THICKNESS: dict[str, int] = dict.fromkeys(("beam.thickness", f"{SCALE}thickness"), 1)
_WIDTH = "beam.width", f"{SCALE}width"
_TIP_MASS, _TIP_INERTIA, _LENGTH = {"beam.tip.mass": -1}, {"beam.tip.inertia": -1}, {"beam.length": -1}
_NO_EFFECT = dict.fromkeys(("mount.radius", "mount.setting_angle", "mount.bending_angle"), 0)
_FAR = 1.5  # ratio R / L above which a longer beam buckles at a lower speed: see `_of_buckling`
_ROUNDING = 4 * np.finfo(float).eps  # relative rounding error of the root's distance from the axis


def ways(scene: Scene, what: str) -> dict[str, int]:
    """Find which numbers increase (1), decrease (-1) or do not change (0) the quotient for all deflections.

    This holds for any values of the other numbers, as long as the scene meets the conditions checked here.
    The conditions are linear in each number, so that they hold within bounds if they hold at all corners.

    Parameters
    ----------
    scene : Scene
        The scene.
    what : str
        Result of a study; "frequencies" means those at rest.

    Returns
    -------
    dict of str to int
        1, -1 or 0 by the numbers' names in scene files; empty if the result is not such a quotient.
    """
    undamped = scene.damping == NO_DAMPING and scene.beam.electrodes is None
    if what not in QUOTIENTS or not undamped or scene.physics != Physics() or scene.mount.precone:
        return {}
    return _at_rest(scene) if what == "frequencies" else _of_buckling(scene)


def is_bare(beam: Beam) -> bool:
    """Return whether a beam has no mass except that of its sections."""
    tip = beam.tip or TipMass(0.0)
    return not (beam.point_masses or tip.mass or _has_inertia(tip))


def is_clamped(scene: Scene) -> bool:
    """Return whether the root is clamped without springs, so that sections have all elastic energy."""
    return bool(np.isinf(scene.mount.root_stiffness)) and not scene.beam.point_springs


def _sides(beam: Beam) -> dict[str, int]:
    """Find how section thickness h and width b change the quotient, if sections have all elastic energy.

    The energy is proportional to h^3 b.  In the divisor of the quotient, the contribution of the sections is
    proportional to h b; the contribution of bodies, which must not be negative, does not change.
    """
    return _THICKNESS | dict.fromkeys(_WIDTH, 0 if is_bare(beam) else 1)


def _at_rest(scene: Scene) -> dict[str, int]:
    """Find which numbers increase, decrease or do not change V/T, as in the module, for a frequency at rest.

    With a clamped root and no springs, for a given w(x/L), V is proportional to 1/L^3.  The contribution of
    the sections to T is proportional to L; that of a body without offset decreases at most as L^-2, by its
    rotation.
    """
    beam, tip = scene.beam, scene.beam.tip or TipMass(0.0)
    found = _STIFFNESS | _MASS | _TIP_MASS | _TIP_INERTIA | _NO_EFFECT
    if is_clamped(scene):
        found |= _sides(beam)
        if not (beam.point_masses or tip.offset):
            found |= _LENGTH
    return found


def _of_buckling(scene: Scene) -> dict[str, int]:
    """Find which numbers increase, decrease or do not change V/G, as in the module, for buckling.

    G increases with R.  If R is at least the distance of all masses from the root, no contribution to G is
    negative, and G increases with each mass.  If only sections have mass, G is proportional to it for any R.
    With a clamped root and no springs, the contributions of the sections and of a tip mass to G/V are, with
    integrals a, b, c that depend on w(x/L),

        L^3 R a - L^4 b + d^2 L^4 c  with b <= a,    L^2 R a - L^3 a + d^2 L^3 c,

    times constants; they increase with L if R is at least 4/3 L and 3/2 L, respectively.
    """
    beam, tip = scene.beam, scene.beam.tip or TipMass(0.0)
    inward = exact_cos_sin(scene.mount.setting_angle)[0]
    distance, turns = inward * scene.mount.radius * (1 + _ROUNDING), _has_inertia(tip)
    if tip.offset < 0:
        return _STIFFNESS
    found = _STIFFNESS | {"mount.radius": -int(np.sign(inward))}
    all_load, bare = distance >= beam.length + tip.offset, is_bare(beam)
    if all_load:
        found |= _TIP_MASS
    if all_load or bare:
        found |= _MASS
    if is_clamped(scene) and (bare or (all_load and not turns)):
        found |= _sides(beam)
        if distance >= _FAR * beam.length and not (beam.point_masses or tip.offset or turns):
            found |= _LENGTH
    return found


def _has_inertia(tip: TipMass) -> bool:
    return bool(tip.inertia or tip.inertia_about_bending_direction or tip.axial_inertia)
