"""Geometry of a duo-servo brake and the motion of its shoes in closed form (Yoo et al. 1997, section 3).

Axes: x to the right, y up, the drum's centre at the origin. The drum turns counter-clockwise, the right
shoe leads, and the left side is the mirror image of the right one at rest. In stage 1 each shoe turns about
its adjuster pin until the contact point of its lining reaches the drum. In stage 2 shoes and adjuster turn
with the drum by psi, until the right piston reaches its bottom. A piston's position is where its face cuts
the x axis.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, positive, together
from beamdyn.common.inputs.checks import refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import error_at_most, spanned, warned
from beamdyn.common.results.result import Result
from brakes.common.locking import LEAST_MARGIN
from brakes.vehicle.axles import ACUTE, ROUNDING


class HasLevers:
    """Base of the brake descriptions that `internal_forces` accepts: they give lever arms."""

    def find_levers(self, clearance: Numbers | None = None) -> Levers:
        """Find the lever arms at the end of the shoes' motion.

        Parameters
        ----------
        clearance : float or ndarray, optional
            Clearance c_L between lining and drum at rest [m]; needed by a `DuoServo`.

        Returns
        -------
        Levers
            Lever arms and directions of the forces.

        Raises
        ------
        ValueError
            If the clearance is missing where it is needed, is given for `Levers`, which do not
            depend on it, or as for `DuoServo.move_shoes`.
        """
        return self.levers_and_error(clearance)[0]

    def levers_and_error(self, clearance: Numbers | None = None) -> tuple[Levers, Numbers]:
        """Find the levers, and one bound for the arms' relative errors and the angles' errors [rad]."""
        raise NotImplementedError


@dataclass(frozen=True)
class Levers(HasLevers):
    """Lever arms about the drum's centre and directions of the forces, as in Fig. 6 of Yoo et al. (1997).

    Every value may be an array, one entry per case.

    The drum turns counter-clockwise; the right shoe is the leading one, the left shoe the trailing one. P_L
    and P_T are the forces of the pistons on the leading and the trailing shoe, Q is the force of the adjuster
    between both shoes. With x to the right and y upward, P_L (cos alpha1, -sin alpha1) and Q (cos gamma, sin
    gamma) act on the leading shoe, P_T (-cos alpha2, -sin alpha2) and -Q (cos gamma, sin gamma) on the
    trailing shoe. The drum exerts the normal force A and the friction force B on the leading shoe, C and D on
    the trailing shoe.

    Parameters
    ----------
    drum_radius : float or ndarray
        Inner radius r of the drum [m].
    a1, a2 : float or ndarray
        Lever arms of P_L and P_T [m].
    b1, b2 : float or ndarray
        Lever arms of Q on the leading and on the trailing shoe [m]; equal, as Q has one line of action.
    alpha1, alpha2, gamma : float or ndarray
        Angles of P_L and P_T below the horizontal, and of Q above it [rad].

    Raises
    ------
    ValueError
        If a length is not positive, or if P_L and Q, or P_T and Q, are more than 90 degrees apart.

    References
    ----------
    Yoo et al. (1997), section 4.

    Examples
    --------
    >>> levers = forklift.BENDIX_12_5.move_shoes(0.0106).levers
    >>> float(levers.drum_radius)  # m
    0.15875
    """

    drum_radius: Annotated[Numbers, Described("m", "r", "inner radius of the drum", above=0)]
    a1: Annotated[Numbers, Described("m", "a1", "arm of P_L, on the leading shoe", above=0)]
    a2: Annotated[Numbers, Described("m", "a2", "arm of P_T, on the trailing shoe", above=0)]
    b1: Annotated[Numbers, Described("m", "b1", "arm of Q on the leading shoe", above=0)]
    b2: Annotated[Numbers, Described("m", "b2", "arm of Q on the trailing shoe", above=0)]
    alpha1: Annotated[Numbers, Described("rad", "alpha1", "angle of P_L, below the horizontal")]
    alpha2: Annotated[Numbers, Described("rad", "alpha2", "angle of P_T, below the horizontal")]
    gamma: Annotated[Numbers, Described("rad", "gamma", "angle of Q, above the horizontal")]

    def __post_init__(self) -> None:
        keep_checked(self)
        for name, value in (("alpha1 + gamma", self.phi1), ("alpha2 - gamma", self.phi2)):
            bound = "the piston's force and the adjuster's are more than a right angle apart"
            past = np.abs(value) > np.pi / 2 + LEAST_MARGIN
            refuse(past, name, value, "rad", bound, "angles are in {unit}")

    @property
    def in_radii(self) -> Levers:
        """Return a copy with all lengths divided by the drum's radius."""
        arms = {name: getattr(self, name) / self.drum_radius for name in ("a1", "a2", "b1", "b2")}
        return replace(self, drum_radius=1.0, **arms)

    @property
    def phi1(self) -> Numbers:
        """Angle between P_L and Q [rad]."""
        return self.alpha1 + self.gamma

    @property
    def phi2(self) -> Numbers:
        """Angle between P_T and Q [rad]."""
        return self.alpha2 - self.gamma

    @property
    def locking_friction(self) -> Numbers:
        """Friction of the lining at which the brake is self-locking; inf if it never is."""
        sigma = np.minimum(self.a1, self.b2) / self.drum_radius
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(sigma < 1, sigma / np.sqrt((1 - sigma) * (1 + sigma)), np.inf)[()]

    def levers_and_error(self, clearance: Numbers | None = None) -> tuple[Levers, Numbers]:
        """Return these levers, and zero as the error of their arms and angles, which are given."""
        if clearance is not None:
            raise ValueError("clearance: the lever arms are given; leave it out, or give a DuoServo")
        return self, 0.0


# Geometry and motion -----------------------------------------------------------------------------------


_CONTACT = Described("rad", "", "where the lining touches first, up from the horizontal", **ACUTE)
_BOTTOM = Described("m", "", "travel of a piston from rest to its bottom, inward", above=0)
_FARTHEST = "largest travel of a piston from rest, outward; not checked if not given"
_STROKE = Described("m", "", _FARTHEST, above=0)


@dataclass(frozen=True)
class DuoServo(HasLevers):
    """Geometry of the right side of a duo-servo brake at rest; values may be arrays, one entry per design.

    Parameters
    ----------
    drum_radius : float or ndarray
        Inner radius r of the drum [m].
    tip : tuple
        Pin between shoe and piston, (x, y) [m], right of the drum's centre and above it.
    adjuster : tuple
        Pin between shoe and adjuster, (x, y) [m], right of the drum's centre and below it.
    face_tilt : float or ndarray
        Tilt alpha1 = alpha2 of the piston's face [rad]: its normal is (cos, -sin) of the tilt.
    contact_angle : float or ndarray
        Angle of the lining's contact point, from +x upward [rad]; at rest its distance from the centre is r
        minus the clearance, an argument of `move_shoes`.
    piston_bottom : float or ndarray
        Travel of the piston from rest to its bottom, inward [m].
    piston_stroke : float or ndarray, optional
        Largest travel of the piston from rest, outward [m]; not checked unless given.

    Raises
    ------
    ValueError
        If a length is not positive, or a pin is not inside the drum on its side.

    References
    ----------
    Yoo et al. (1997), section 3.

    Examples
    --------
    >>> forklift.BENDIX_12_5.drum_radius  # m
    0.15875
    """

    drum_radius: Annotated[Numbers, Described("m", "r", "inner radius of the drum", above=0)]
    tip: tuple[
        Annotated[Numbers, Described("m", "x_t", "pin of the shoe's tip, from the centre", above=0)],
        Annotated[Numbers, Described("m", "y_t", "pin of the shoe's tip, above the centre", above=0)],
    ]
    adjuster: tuple[
        Annotated[Numbers, Described("m", "x_a", "pin of the adjuster, from the centre", above=0)],
        Annotated[Numbers, Described("m", "y_a", "height of the adjuster's pin: negative", below=0)],
    ]
    face_tilt: Annotated[Numbers, Described("rad", "alpha", "tilt of the pistons' faces", **ACUTE)]
    contact_angle: Annotated[Numbers, _CONTACT]
    piston_bottom: Annotated[Numbers, _BOTTOM]
    piston_stroke: Annotated[Numbers | None, _STROKE] = None

    def __post_init__(self) -> None:
        keep_checked(self)
        (x, y), (ax, ay) = self.tip, self.adjuster
        for name, u, v, sense in (("tip", x, y, 1), ("adjuster", ax, ay, -1)):
            side = "above" if sense > 0 else "below"
            refuse(np.asarray(u) <= 0, f"{name}[0]", u, "m", "the right side is described: give x > 0")
            refuse(sense * np.asarray(v) <= 0, f"{name}[1]", v, "m", f"it lies {side} the drum's centre")
            what, far = f"distance of {name} from the centre", np.hypot(u, v)
            outside = far >= self.drum_radius * (1 - LEAST_MARGIN)
            refuse(outside, what, far, "m", "it must lie inside the drum (drum_radius)")

    def move_shoes(
        self, clearance: Annotated[Numbers, Described("m", "c_L", "between lining and drum at rest", above=0)]
    ) -> ShoeMotion:
        """Compute the motion of the shoes through both stages.

        Parameters
        ----------
        clearance : float or ndarray
            Clearance c_L between lining and drum at rest [m].

        Returns
        -------
        ShoeMotion
            Turns, travels and interference, and the lever arms at the end of stage 2.

        Raises
        ------
        ValueError
            If the clearance is not positive, or larger than the drum allows.
        """
        c = positive("clearance", clearance, "m")
        together(clearance=c, geometry=self.drum_radius * np.asarray(self.tip[0]) * self.adjuster[0])
        advice = "take less clearance"
        bound = "larger than the drum allows, its radius is {limit}"
        refuse(c >= np.asarray(self.drum_radius), "clearance", c, "m", bound, advice, limit=self.drum_radius)
        turn = self._seating_turn(c)
        bound = "larger than the drum allows: the lining cannot reach it"
        refuse(np.isnan(turn), "clearance", c, "m", bound, advice)
        tip = self._after_seating(turn, *self.tip)
        outside = np.hypot(*tip) >= self.drum_radius * (1 - LEAST_MARGIN)
        bound = "larger than the drum allows: the shoe's tip would leave it before the lining touches"
        refuse(outside, "clearance", c, "m", bound, advice)
        # Stage 2: shoes and adjuster turn by psi with the drum, until the right piston reaches its bottom.
        lowest = (self.piston_position(*self.tip) - self.piston_bottom) * np.cos(self.face_tilt)
        psi = _arccos(lowest / np.hypot(*tip)) - self.face_tilt - np.arctan2(tip[1], tip[0])
        bound = "larger than the drum allows: the piston does not reach its bottom"
        refuse(np.isnan(psi), "clearance", c, "m", bound, advice)
        return self._assemble_motion(c, turn, psi, tip)

    def levers_and_error(self, clearance: Numbers | None = None) -> tuple[Levers, Numbers]:
        """Compute the levers, and one bound for the arms' relative errors and the angles' errors [rad]."""
        if clearance is None:
            raise ValueError("clearance is missing: the lever arms depend on it; give it in m")
        return self.move_shoes(clearance).levers_and_error()

    def piston_position(self, x: Numbers, y: Numbers) -> Numbers:
        """Compute the position on the x axis [m] of a right piston whose face contains a point (x, y) [m]."""
        return x - y * np.tan(self.face_tilt)

    def _seating_turn(self, c: Numbers) -> np.ndarray:
        """Find the clockwise rotation [rad] of a shoe about its adjuster pin until contact; nan if none."""
        r, (hx, hy) = self.drum_radius, self.adjuster
        vx, vy = (r - c) * np.cos(self.contact_angle) - hx, (r - c) * np.sin(self.contact_angle) - hy
        along, across = hx * vx + hy * vy, hx * vy - hy * vx
        target = (r**2 - hx**2 - hy**2 - vx**2 - vy**2) / 2  # equals along cos(turn) + across sin(turn)
        return np.arctan2(across, along) - _arccos(target / np.hypot(along, across))

    def _after_seating(self, turn: np.ndarray, x: Numbers, y: Numbers) -> tuple[np.ndarray, np.ndarray]:
        """Compute where a point of the right shoe, at (x, y) at rest, is after stage 1 [m]."""
        hx, hy = self.adjuster
        dx, dy = _turned(x - hx, y - hy, -turn)
        return hx + dx, hy + dy

    def _assemble_motion(
        self, c: Numbers, turn: np.ndarray, psi: np.ndarray, tip: tuple[np.ndarray, np.ndarray]
    ) -> ShoeMotion:
        """Make the result from the turns of both stages and the position of the right tip after stage 1."""
        (x, y), rest = tip, self.piston_position(*self.tip)
        right, left = _turned(x, y, psi), _turned(-x, y, psi)
        # A lining that is concentric at rest may penetrate the drum: find the largest depth and its angle.
        ox, oy = self._after_seating(turn, 0.0, 0.0)  # centre of the lining's circle
        ends = np.arctan2(self.adjuster[1], self.adjuster[0]), np.arctan2(self.tip[1], self.tip[0])
        where = np.clip(np.arctan2(oy, ox) + turn, *ends)
        dx, dy = _turned(self.drum_radius - c, 0.0, where - turn)
        sine, cosine = np.sin(self.face_tilt), np.cos(self.face_tilt)
        levers = Levers(
            drum_radius=self.drum_radius,
            a1=right[0] * sine + right[1] * cosine,
            a2=-left[0] * sine + left[1] * cosine,
            b1=-np.asarray(self.adjuster[1]),  # the adjuster turns with the drum: same arm, gamma = psi
            b2=-np.asarray(self.adjuster[1]),
            alpha1=self.face_tilt,
            alpha2=self.face_tilt,
            gamma=psi,
        )
        return ShoeMotion(
            geometry=self,
            clearance=c,
            seating_turn=turn[()],
            drum_turn=psi[()],
            seating_travel=(self.piston_position(x, y) - rest)[()],
            right_travel=(self.piston_position(*right) - rest)[()],
            left_travel=(self.piston_position(-left[0], left[1]) - rest)[()],
            right_tip=np.stack(right, axis=-1),
            left_tip=np.stack(left, axis=-1),
            tip_gap=(self.drum_radius - np.hypot(x, y))[()],
            lining_penetration=(np.hypot(ox + dx, oy + dy) - self.drum_radius)[()],
            penetration_angle=where[()],
            levers=levers,
        )


@dataclass(frozen=True)
class ShoeMotion(HasLevers, Result):
    """Motion of a duo-servo brake's shoes from rest to the end of stage 2; arrays by case.

    Attributes
    ----------
    geometry : DuoServo
        The brake.
    clearance : ndarray
        Clearance between lining and drum at rest [m].
    seating_turn : ndarray
        Turn of each shoe about its adjuster pin in stage 1 [rad].
    drum_turn : ndarray
        Turn psi of the drum and the shoes in stage 2 [rad].
    seating_travel : ndarray
        Outward travel of each piston in stage 1 [m].
    right_travel, left_travel : ndarray
        Outward travel of each piston from rest to the end of stage 2 [m].
    right_tip, left_tip : ndarray, shape (..., 2)
        Pins of the tips at the end of stage 2 [m].
    tip_gap : ndarray
        Smallest gap between the tips and the drum during the motion [m].
    lining_penetration, penetration_angle : ndarray
        Largest depth by which a lining that is concentric at rest and reaches from pin to pin enters the
        drum [m] (negative: a gap), and its angle on the lining at rest, from +x [rad].
    levers : Levers
        Lever arms and directions of the forces at the end of stage 2.

    Examples
    --------
    >>> motion = forklift.BENDIX_12_5.move_shoes(0.0106)
    >>> round(float(np.degrees(motion.seating_turn)), 2)  # until the linings touch
    5.23
    """

    field_units: ClassVar[dict[str, str]] = {"m": "clearance right_tip left_tip"}

    geometry: DuoServo
    clearance: Numbers
    seating_turn: Annotated[Numbers, Meaning("rad", "stage 1: turn of each shoe", "deg")]
    drum_turn: Annotated[Numbers, Meaning("rad", "stage 2: turn of drum and shoes", "deg")]
    seating_travel: Annotated[Numbers, Meaning("m", "stage 1: travel of each piston", "mm")]
    right_travel: Annotated[Numbers, Meaning("m", "right piston at the end, outward", "mm")]
    left_travel: Annotated[Numbers, Meaning("m", "left piston at the end, outward", "mm")]
    right_tip: np.ndarray
    left_tip: np.ndarray
    tip_gap: Annotated[Numbers, Meaning("m", "least gap of the shoe's tip to the drum", "mm")]
    lining_penetration: Annotated[Numbers, Meaning("m", "a concentric lining enters the drum by", "mm")]
    penetration_angle: Annotated[Numbers, Meaning("rad", "... at, up from the horizontal", "deg")]
    levers: Levers

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"drum turns {spanned(np.degrees(self.drum_turn), 'deg')}"
        travels = (spanned(np.multiply(1e3, each), "mm") for each in (self.right_travel, self.left_travel))
        yield f"pistons travel {' and '.join(travels)}"
        yield error_at_most(self.error)
        yield warned(self.interference)

    @property
    def error(self) -> Numbers:
        """Bound of the rounding error of the turns [rad], and of positions relative to r.

        Each turn is an arc cosine, which amplifies rounding near the end of the shoe's reach:
        when contact point, pin and centre are in line in stage 1, or the tip's path is along the face in
        stage 2.
        """
        brake, r = self.geometry, self.geometry.drum_radius
        pin, tip = np.hypot(*brake.adjuster), np.hypot(self.right_tip[..., 0], self.right_tip[..., 1])
        x, y = _turned(r - self.clearance, 0.0, brake.contact_angle)
        far = np.hypot(x - brake.adjuster[0], y - brake.adjuster[1])
        sides, scale = r**2 - pin**2 - far**2, 2 * pin * far
        rounded = ROUNDING * ((r**2 + pin**2 + far**2) / scale + (r + pin) / far)
        seating = _error_of_arccos(rounded, np.sqrt(np.clip(1 - (sides / scale) ** 2, 0, 1)))
        arm = np.hypot(brake.tip[0] - brake.adjuster[0], brake.tip[1] - brake.adjuster[1])
        moved = (ROUNDING * r + seating * arm) / tip
        face = ROUNDING * (brake.tip[0] + brake.tip[1] + brake.piston_bottom) / tip
        height = brake.face_tilt + np.arctan2(self.right_tip[..., 1], self.right_tip[..., 0])
        return (seating + moved + _error_of_arccos(face + moved, np.sin(height)))[()]

    def levers_and_error(self, clearance: Numbers | None = None) -> tuple[Levers, Numbers]:
        """Return the levers, and one bound for the arms' relative errors and the angles' errors [rad]."""
        least = np.minimum(self.levers.a1, self.levers.a2)
        return self.levers, self.error * self.geometry.drum_radius / least

    @property
    def residual(self) -> Numbers:
        """Larger of two residuals over r: gap at the contact, and distance of the piston from its bottom."""
        brake, r = self.geometry, self.geometry.drum_radius
        x, y = _turned(r - self.clearance, 0.0, brake.contact_angle)
        seated = np.hypot(*brake._after_seating(np.asarray(self.seating_turn), x, y)) - r
        bottom = brake.piston_position(*brake.tip) - brake.piston_bottom
        pushed = brake.piston_position(self.right_tip[..., 0], self.right_tip[..., 1]) - bottom
        return np.fmax(np.abs(seated), np.abs(pushed)) / r

    @property
    def interference(self) -> tuple[str, ...]:
        """One sentence for each pair of parts that collide; of many cases, for the worst."""
        sentences = []
        depth, angle = np.asarray(self.lining_penetration), np.asarray(self.penetration_angle)
        if (depth > 1e-9).any():
            k = np.unravel_index(depth.argmax(), depth.shape)
            sentences.append(
                f"the lining enters the drum by {1e3 * depth[k]:.3g} mm near {np.degrees(angle[k]):.0f} deg: "
                "it touches there before it does at the contact point"
            )
        stroke, least = self.geometry.piston_stroke, LEAST_MARGIN * np.asarray(self.geometry.drum_radius)
        if stroke is not None and np.any(self.left_travel > stroke + least):
            sentences.append(
                f"the left piston comes out {1e3 * np.max(self.left_travel):.4g} mm, "
                f"past its stroke of {1e3 * np.min(stroke):.4g} mm"
            )
        return tuple(sentences)


BENDIX_12_5 = DuoServo(
    drum_radius=0.15875,
    tip=(0.06155, 0.10229),
    adjuster=(0.05304, -0.12211),
    face_tilt=float(np.radians(19.7)),
    contact_angle=float(np.radians(56.5)),
    piston_bottom=0.00153,
)
"""Bendix duo-servo brake, 12.5 in. The paper prints no coordinates; these are fitted to its Tables 5-7."""


def _turned(x: Numbers, y: Numbers, angle: Numbers) -> tuple[np.ndarray, np.ndarray]:
    """Rotate vectors with components x and y anticlockwise by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return c * x - s * y, s * x + c * y


def _error_of_arccos(error: np.ndarray, sine: np.ndarray) -> np.ndarray:
    """Compute the error of an arc cosine [rad] from the error of its argument and the sine of the angle."""
    return error / np.sqrt(sine**2 + error)


def _arccos(value: Numbers) -> np.ndarray:
    """Compute the arc cosine [rad]; nan for arguments outside [-1, 1] by more than rounding."""
    value = np.asarray(value)
    return np.arccos(np.where(np.abs(value) <= 1 - LEAST_MARGIN, value, np.nan))
