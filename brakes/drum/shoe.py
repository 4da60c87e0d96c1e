"""Forces on a pivoted long shoe, from its actuating force, its peak pressure or its torque.

The pressure is proportional to the radial displacement of the lining, p = p0 sin(alpha - delta). On a
rigid shoe that turns about its pin the pressure is zero on the line from the centre to the pin: delta =
atan(b/c), as in textbooks (Shigley, whose theta is alpha - delta). Vardanyan et al. (2019) place the zero on
the -y axis instead (delta = 0), which is right for b = 0 only. In axes turned by delta the same formulas hold
for both. The pressure of a new or flexible lining is more uniform: see `Shoe.pressure_law`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked
from beamdyn.common.inputs.checks import one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import error_at_most, spanned
from brakes.common.locking import LEAST_MARGIN, SlidesOrLocks

_START = "start of the lining, from straight down, where the pin is"
_END = "end of the lining, from straight down"
_OFFSET = "distance of the pin from the brake's line of symmetry, positive towards its shoe"
_DEPTH = "depth of the pin below the drum's centre"
_FORCE_ARM = "height of the actuating force above the drum's centre; its arm about the pin is a + c"
_PRESSURE_ZERO = (
    "line where the pressure vanishes: through the pin (pivot), about which the shoe turns; straight down "
    "(axis) is an assumption of Vardanyan et al. (2019), for comparison with them"
)
_LAW = "wear: rigid shoe, pressure as the sine of the angle; pressure: the same pressure everywhere"
_ROUNDING = 1e-9  # rounding error of the start of an arc that lies exactly on the line to the pin [rad]
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Shoe:
    """A shoe on a fixed pin, inside a drum. Every length and angle may be an array, one entry per case.

    Parameters
    ----------
    drum_radius : float or ndarray
        Inner radius r of the drum [m].
    face_width : float or ndarray
        Width of the lining along the drum's axis [m].
    lining : tuple
        Angles alpha1 < alpha2 of the lining's ends, from -y towards +x [rad].
    pivot : tuple
        Pin (b, -c) [m], below the drum's centre; b may have either sign. With the pin outside the
        drum's radius the moment of the friction about it may change sign: then the trailing shoe can lock.
    force_arm : float or ndarray
        Height a of the actuating force above the drum's centre [m]; its arm about the pin is a + c.
    pressure_zero : {"pivot", "axis"}
        Line on which the pressure vanishes: from the centre to the pin, about which a rigid shoe turns, or
        the -y axis, the assumption of Vardanyan et al. (2019): for comparison with them.
    pressure_law : {"wear", "pressure"}
        Pressure as the sine of the angle from that line (wear), or uniform pressure.

    Raises
    ------
    ValueError
        If a length is not positive, the pin is not below the centre or is far from the drum, the force is not
        above the pin, or the lining's arc is empty, overlaps the pin, or passes the pressure's second zero.

    References
    ----------
    Budynas and Nisbett, Shigley's Mechanical Engineering Design, section 16-2; Vardanyan et al. (2019), eq.
    (2).

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> round(float(shoe.moment_arm), 3)  # m
    0.225
    """

    drum_radius: Annotated[Numbers, Described("m", "r", "inner radius of the drum", above=0)]
    face_width: Annotated[Numbers, Described("m", "w", "width of the lining along the drum's axis", above=0)]
    lining: tuple[
        Annotated[Numbers, Described("rad", "alpha1", _START, key="lining_start")],
        Annotated[Numbers, Described("rad", "alpha2", _END, key="lining_end")],
    ]
    pivot: tuple[  # files give b and c of the pin at (b, -c)
        Annotated[Numbers, Described("m", "b", _OFFSET, key="pivot_offset")],
        Annotated[Numbers, Described("m", "c", _DEPTH, above=0, key="pivot_depth")],
    ]
    force_arm: Annotated[Numbers, Described("m", "a", _FORCE_ARM)]
    pressure_zero: Annotated[Literal["pivot", "axis"], Described(meaning=_PRESSURE_ZERO)] = "pivot"
    pressure_law: Annotated[Literal["wear", "pressure"], Described(meaning=_LAW)] = "wear"

    def __post_init__(self) -> None:
        one_of("pressure_law", self.pressure_law, ("wear", "pressure"))
        one_of("pressure_zero", self.pressure_zero, ("pivot", "axis"))
        keep_checked(self)
        (a1, a2), (b, y) = self.lining, self.pivot
        y, least = np.asarray(y), LEAST_MARGIN * np.asarray(self.drum_radius)
        bound, remedy = "the pin lies below the centre", "give (b, -c), c > 0"
        refuse(y >= -least, "pivot[1]", self.pivot[1], "m", bound, remedy)
        far, most = np.hypot(b, y), 2 * np.asarray(self.drum_radius)
        name, bound = "distance of the pivot from the centre", "more than two drum radii, {limit}"
        remedy = "move the pin nearer, or check units"
        refuse(far > most + 2 * least, name, far, "m", bound, remedy, limit=most)
        above = "the force must act above the pin (at -c)"
        refuse(self.force_arm - y <= least, "force_arm", self.force_arm, "m", above)
        bound = "the arc is empty: it must exceed {other}"
        refuse(np.asarray(a2) - a1 <= _ROUNDING, "lining[1]", a2, "rad", bound, other="lining[0]")
        pin, start = self.pin_angle, np.asarray(a1)
        advice = "start the lining beyond this angle; angles are in {unit}, from -y"
        bound = "the lining overlaps the pin, at {limit}"
        refuse(start < pin - _ROUNDING, "lining[0]", a1, "rad", bound, advice, limit=pin)
        bad = start < self.phase - _ROUNDING
        refuse(bad, "lining[0]", a1, "rad", "the pressure would be negative below 0", advice)
        end = np.pi + np.minimum(self.phase, pin)
        bound = "past {limit} the lining leaves the drum"
        late = np.asarray(a2) > end + _ROUNDING
        refuse(late, "lining[1]", a2, "rad", bound, "end it before; angles are in {unit}", limit=end)

    @property
    def pin_angle(self) -> Numbers:
        """Angle of the pin from -y [rad], positive for b > 0."""
        b, y = self.pivot
        return np.arctan2(b, -np.asarray(y))

    @property
    def phase(self) -> Numbers:
        """Angle delta at which the pressure is zero [rad]."""
        return self.pin_angle if self.pressure_zero == "pivot" else 0.0 * np.asarray(self.pin_angle)

    def shape(self, alpha: np.ndarray) -> np.ndarray:
        """Compute the pressure's shape at angles alpha [rad]: sin(alpha - delta), or 1 if uniform."""
        return np.sin(alpha - self.phase) if self.pressure_law == "wear" else np.ones_like(alpha)

    @property
    def moment_arm(self) -> Numbers:
        """Lever arm a + c of the actuating force about the pin [m]."""
        return self.force_arm - np.asarray(self.pivot[1])


@dataclass(frozen=True)
class _Integrals:
    """Integrals of the pressure over a shoe's lining, in axes turned by the angle delta of zero pressure.

    The pressure is p0 q, with the scale p0 and the shape q: the sine of the angle, or 1 if it is uniform.
    K, S, C are the integrals of q, q sin, q cos. n and d are the arms [m] about the pin of the normal force
    and, for friction 1, of the friction force, as in the notes of `shoe_torque`. `K_error` bounds the
    relative rounding error of K, `SC_error` that of the vector (S, C); `n_error` and `d_error` bound the
    errors of the arms [m].
    """

    K: Numbers
    S: Numbers
    C: Numbers
    n: Numbers
    d: Numbers
    peak: Numbers  # largest value of the pressure shape q
    K_error: Numbers
    SC_error: Numbers
    n_error: Numbers
    d_error: Numbers


def integrals(shoe: Shoe) -> _Integrals:
    """Integrate the pressure over the lining of a shoe, with bounds of the rounding errors."""
    uniform = shoe.pressure_law == "pressure"
    a1, a2 = (np.asarray(end) - shoe.phase for end in shoe.lining)
    m, h = (a1 + a2) / 2, (a2 - a1) / 2
    sine, cosine = (2 * of(m) * np.sin(h) for of in (np.sin, np.cos))
    K = 2 * h if uniform else sine
    S = sine if uniform else h - np.cos(2 * m) * np.sin(2 * h) / 2
    C = cosine if uniform else np.sin(2 * m) * np.sin(2 * h) / 2
    (b, y), far = shoe.pivot, np.hypot(*shoe.pivot)
    # (b, -c) is the pin in axes turned by delta.
    b, c = (0.0 * far, far) if shoe.pressure_zero == "pivot" else (b, -np.asarray(y))
    inside = (a1 <= np.pi / 2) & (a2 >= np.pi / 2)
    peak = np.where(inside | uniform, 1.0, np.maximum(np.sin(a1), np.sin(a2)))
    # Errors of the integrals K, S, C over an arc of half width h, due to rounding of angles and of sums.
    ends = np.stack(np.broadcast_arrays(a1, a2))
    angle = _EPS * (np.abs(ends + shoe.phase).max(axis=0) + np.abs(shoe.phase))
    sines, cosines = np.abs(np.sin(ends)), np.abs(np.cos(ends))
    q = np.ones_like(sines) if uniform else sines
    dK = angle * q.sum(axis=0) + _EPS * (2 * h if uniform else np.sin(h) * sines.max(axis=0))
    dS = angle * (q * sines).sum(axis=0) + 2 * _EPS * h
    dC = angle * (q * cosines).sum(axis=0) + _EPS * np.abs(2 * np.sin(h) if uniform else np.sin(2 * h))
    n, d = c * S - b * C, shoe.drum_radius * K - b * S - c * C
    dn, dd = c * dS + np.abs(b) * dC, shoe.drum_radius * dK + np.abs(b) * dS + c * dC
    return _Integrals(K, S, C, n, d, peak, dK / K, (dS + dC) / np.hypot(S, C), dn, dd)


@dataclass(frozen=True)
class ShoeResult(SlidesOrLocks):
    """Forces on a shoe; vectors are in the shoe's own axes, with the components (x, y) as last axis.

    Past self-locking the formulas do not hold: forces, torque and factors are then nan, `locked` is
    true, and `message` says so.

    Attributes
    ----------
    force, torque, peak_pressure : ndarray
        Actuating force [N], torque on the drum [N m], largest pressure on the lining [Pa].
    friction : ndarray
        Coefficient of friction.
    normal, tangential, pin_reaction : ndarray, shape (..., 2)
        Resultants of pressure and of friction on the shoe, and the force of the pin on the shoe [N].
    effective_arm : ndarray
        Arm rho of the friction resultant: torque over its magnitude [m]; at least the drum's radius.
    closure : ndarray
        Residual moment about the drum's centre, relative to P (a + c), which should be rounding only.
    error : ndarray
        Bound of the relative error of torque, pressure, factors and the actuating force, and of the other
        forces relative to the largest: rounding of inputs and sums, which grows as 1 / margin.
    c_star, c_star_slope : ndarray
        Shoe factor C* = torque / (force * radius), and its derivative with respect to the friction.
    locking_friction : ndarray
        Friction at which the shoe locks; inf if it never does.
    margin : ndarray
        1 - friction / locking_friction: 0 at self-locking, negative past it.
    locked : ndarray of bool
        Whether the friction is at or past self-locking, up to a relative margin of 5e-13 or to rounding.

    Examples
    --------
    >>> lining = np.radians((30, 110))
    >>> shoe = drum.Shoe(0.138, 0.05, lining, pivot=(0.02, -0.11), force_arm=0.115)
    >>> found = drum.shoe_torque(shoe, force=1000.0, friction=0.35)
    >>> bool(found.locked), round(float(found.locking_friction), 3)
    (False, 0.999)
    """

    grips = "shoe"
    field_units: ClassVar[dict[str, str]] = {"N": "force normal tangential pin_reaction"}

    shoe: Shoe
    leading: bool
    friction: Numbers
    force: Numbers
    torque: Annotated[Numbers, Meaning("N m", "torque")]
    peak_pressure: Annotated[Numbers, Meaning("Pa", "largest pressure", "MPa")]
    normal: np.ndarray
    tangential: np.ndarray
    pin_reaction: np.ndarray
    effective_arm: Annotated[Numbers, Meaning("m", "effective arm of the friction", "mm")]
    closure: Annotated[Numbers, Meaning("", "residual moment / (P (a + c))")]
    error: Annotated[Numbers, Meaning("", "bound of the relative error")]
    c_star: Annotated[Numbers, Meaning("", "shoe factor C*")]
    c_star_slope: Annotated[Numbers, Meaning("", "dC*/dmu")]
    locking_friction: Annotated[Numbers, Meaning("", "friction at self-locking")]
    margin: Numbers
    locked: Numbers

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{'leading' if self.leading else 'trailing'}, torque {spanned(self.torque, 'N m')}"
        yield f"C* {spanned(self.c_star)}"
        yield error_at_most(self.error)
        yield "locked" if np.any(self.locked) else "slides"

    def pressure(self, alpha: Numbers) -> np.ndarray:
        """Compute the pressure [Pa] at angles alpha [rad], 0 off the lining; for a single case only."""
        alpha = np.asarray(alpha, dtype=float)
        a1, a2 = self.shoe.lining
        on = (alpha >= a1) & (alpha <= a2)
        p0 = self.peak_pressure / integrals(self.shoe).peak
        return np.where(on, p0 * self.shoe.shape(alpha), 0.0)


def solve_shoe(shoe: Shoe, mu: Numbers, leading: bool, force: Numbers) -> ShoeResult:
    """Compute the forces on a shoe as `shoe_torque` does, without checks; a force of nan gives nan."""
    i, s, r = integrals(shoe), -1.0 if leading else 1.0, shoe.drum_radius
    arm, area = shoe.moment_arm, shoe.face_width * np.asarray(r)
    mu, force, n, d = np.broadcast_arrays(mu, force, i.n, i.d)
    with np.errstate(divide="ignore"):
        limit = np.where(s * d < -i.d_error, n / np.abs(d), np.inf)
    bracket_error = i.n_error + mu * i.d_error + _EPS * (n + mu * np.abs(d))
    locked = (limit < np.inf) & (n + s * mu * d <= np.maximum(LEAST_MARGIN * n, bracket_error))
    bracket = np.where(locked, np.nan, n + s * mu * d)
    load = force * arm / bracket  # scale p0 of the pressure times the area width * radius [N]
    normal = _turn(load[..., None] * _vector(-i.S, i.C), shoe.phase)
    tangential = _turn((s * mu * load)[..., None] * _vector(i.C, i.S), shoe.phase)
    pin = -(normal + tangential)
    pin[..., 0] -= force
    torque = mu * load * r * i.K
    # The sum of the moments about the centre, relative to P (a + c), checks the solution.
    b, y = shoe.pivot
    left = s * torque - shoe.force_arm * force + b * pin[..., 1] - y * pin[..., 0]
    # Relative errors of dC*/dmu and of the vectors follow from that of n + s mu d; `error` is the largest.
    arms = (np.abs(shoe.force_arm) + np.abs(shoe.pivot[1])) / shoe.moment_arm
    from_bracket = bracket_error / bracket
    slope_error = i.K_error + i.n_error / np.abs(i.n) + from_bracket
    return ShoeResult(
        shoe=shoe,
        leading=leading,
        friction=mu[()],
        force=force[()],
        torque=torque[()],
        peak_pressure=(load * i.peak / area)[()],
        normal=normal,
        tangential=tangential,
        pin_reaction=pin,
        effective_arm=(r * i.K / np.hypot(i.S, i.C))[()],
        closure=(np.abs(left) / (np.abs(force) * arm))[()],
        error=(_EPS * (4 + arms) + from_bracket + np.maximum(slope_error, i.SC_error))[()],
        c_star=(mu * arm * i.K / bracket)[()],
        c_star_slope=(arm * i.K * n / bracket**2)[()],
        locking_friction=limit[()],
        margin=(1 - mu / limit)[()],
        locked=locked[()],
    )


def _vector(x: Numbers, y: Numbers) -> np.ndarray:
    """Stack two components as vectors of shape (..., 2)."""
    return np.stack(np.broadcast_arrays(x, y), axis=-1)


def _turn(v: np.ndarray, angle: Numbers) -> np.ndarray:
    """Rotate vectors (..., 2) anticlockwise by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return _vector(c * v[..., 0] - s * v[..., 1], s * v[..., 0] + c * v[..., 1])
