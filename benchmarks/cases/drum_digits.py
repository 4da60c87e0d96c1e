"""Drum brakes with pivoted and with duo-servo shoes, and a truck's stops, to many digits.

The inputs count as exact; no code of the package is used except its classes of inputs.
"""

from __future__ import annotations

from typing import Any

import mpmath
from mpmath import mpf

from brakes.drum import Shoe
from brakes.forklift import DuoServo, Levers, StopConditions, Truck

DIGITS = 40


def _arms(shoe: Shoe) -> tuple[mpf, mpf, mpf, mpf, mpf, mpf]:
    """Compute integrals K, S, C and arms n, d [m] as in `shoe_torque`, and the angle of no pressure [rad]."""
    b, y = map(mpf, shoe.pivot)
    zero = mpmath.atan2(b, -y) if shoe.pressure_zero == "pivot" else mpf(0)
    a1, a2 = (mpf(end) - zero for end in shoe.lining)
    sin, cos = mpmath.sin, mpmath.cos
    K, C = cos(a1) - cos(a2), (sin(a2) ** 2 - sin(a1) ** 2) / 2
    S = (a2 - a1) / 2 - (sin(2 * a2) - sin(2 * a1)) / 4
    b, c = b * cos(zero) + y * sin(zero), b * sin(zero) - y * cos(zero)
    return K, S, C, c * S - b * C, mpf(shoe.drum_radius) * K - b * S - c * C, zero


def locking_friction_of_shoe(shoe: Shoe, leading: bool) -> mpf | None:
    """Compute the friction coefficient at which a shoe locks; None if it never locks."""
    *_, n, d, _ = _arms(shoe)
    limit = n / d if leading else -n / d
    return limit if limit > 0 else None


def forces_on_shoe(shoe: Shoe, friction: float, force: float, leading: bool) -> dict[str, Any]:
    """Compute the fields of `ShoeResult`, by name, for a shoe that does not lock; vectors are complex."""
    s, mu, P = (-1 if leading else 1), mpf(friction), mpf(force)
    K, S, C, n, d, zero = _arms(shoe)
    arm, bracket = mpf(shoe.force_arm) - mpf(shoe.pivot[1]), n + s * mu * d
    load = P * arm / bracket
    normal = load * mpmath.mpc(-S, C) * mpmath.expj(zero)
    tangential = s * mu * load * mpmath.mpc(C, S) * mpmath.expj(zero)
    return {
        "torque": mu * load * mpf(shoe.drum_radius) * K,
        "c_star": mu * arm * K / bracket,
        "c_star_slope": arm * K * n / bracket**2,
        "normal": normal,
        "tangential": tangential,
        "pin_reaction": -(normal + tangential) - P,
    }


def exact_levers(brake: DuoServo, clearance: float) -> dict[str, mpf]:
    """Compute lever arms and angles of a duo-servo brake by name, by intersecting circles and lines."""
    r, tilt = mpf(brake.drum_radius), mpf(brake.face_tilt)
    pin, tip = (mpmath.mpc(*point) for point in (brake.adjuster, brake.tip))
    point = (r - mpf(clearance)) * mpmath.expj(mpf(brake.contact_angle))
    far, near = abs(point - pin), abs(pin)
    # Angle from the pin's radius to the point.
    opening = mpmath.acos((r**2 - near**2 - far**2) / (2 * near * far))
    seated = pin + (tip - pin) * mpmath.expj(mpmath.arg(pin) + opening - mpmath.arg(point - pin))
    bottom = (tip.real - tip.imag * mpmath.tan(tilt) - mpf(brake.piston_bottom)) * mpmath.cos(tilt)
    psi = mpmath.acos(bottom / abs(seated)) - tilt - mpmath.arg(seated)
    face = mpmath.expj(tilt)
    right, left = seated * mpmath.expj(psi), -mpmath.conj(seated) * mpmath.expj(psi)
    arms = {"a1": (right * face).imag, "a2": (-mpmath.conj(left) * face).imag}
    return arms | {"b": -pin.imag, "phi1": tilt + psi, "phi2": tilt - psi, "r": r}


def given_levers(levers: Levers) -> dict[str, mpf]:
    """Return given lever arms and angles as exact numbers."""
    phi = {
        "phi1": mpf(levers.alpha1) + mpf(levers.gamma),
        "phi2": mpf(levers.alpha2) - mpf(levers.gamma),
    }
    arms = {"a1": levers.a1, "a2": levers.a2, "b": levers.b1, "r": levers.drum_radius}
    return phi | {name: mpf(arm) for name, arm in arms.items()}


def locking_friction(levers: dict[str, mpf]) -> mpf | None:
    """Compute the lining friction at which a duo-servo brake locks; None if it never locks."""
    sigma = min(levers["a1"], levers["b"]) / levers["r"]
    return sigma / mpmath.sqrt(1 - sigma**2) if sigma < 1 else None


def forces_from_friction(levers: dict[str, mpf], piston: float, friction: Any) -> dict[str, mpf]:
    """Compute the fields of `InternalForces` at a friction below self-locking, by name."""
    r, b, mu, P_T = levers["r"], levers["b"], mpf(friction), mpf(piston)
    s = r * mu / mpmath.sqrt(1 + mu**2)
    Q = _across(P_T, levers["a2"], b, levers["phi2"], s)
    P_L = _across(Q, b, levers["a1"], levers["phi1"], s)
    R_L, R_T = (_sum(P, Q, levers[phi]) for P, phi in ((P_L, "phi1"), (P_T, "phi2")))
    normal = 1 / mpmath.sqrt(1 + mu**2)
    torque = s * (R_L + R_T)
    return {
        "torque": torque,
        "c_star": torque / (P_T * r),
        "A": normal * R_L,
        "B": mu * normal * R_L,
        "C": normal * R_T,
        "D": mu * normal * R_T,
        "Q": Q,
        "P_L": P_L,
        "lining_friction": mu,
        "leading_share": R_L / (R_L + R_T),
        "trailing_share": R_T / (R_L + R_T),
    }


def slope_at_friction(levers: dict[str, mpf], piston: float, friction: float) -> dict[str, mpf]:
    """Compute the derivative of C* by the friction, by central differences."""
    step = locking_friction(levers)
    step = (step - mpf(friction) if step else mpf(friction)) * mpf(10) ** -8
    ends = (forces_from_friction(levers, piston, friction + sense * step)["c_star"] for sense in (1, -1))
    return {"c_star_slope": (next(ends) - next(ends)) / (2 * step)}


def _across(P: mpf, a: mpf, b: mpf, phi: mpf, s: mpf) -> mpf:
    """Compute the positive root X of X b - P a = s |P + X|, by squaring."""
    square, linear = b**2 - s**2, -2 * P * (a * b + s**2 * mpmath.cos(phi))
    constant = P**2 * (a**2 - s**2)
    return (-linear + mpmath.sqrt(linear**2 - 4 * square * constant)) / (2 * square)


def _sum(P: mpf, Q: mpf, phi: mpf) -> mpf:
    return mpmath.sqrt(P**2 + Q**2 + 2 * P * Q * mpmath.cos(phi))


def friction_of_torque(levers: dict[str, mpf], piston: float, torque: float, near: float) -> mpf:
    """Find the lining friction that gives a torque, near an estimate."""
    wanted, limit = mpf(torque), locking_friction(levers)

    def missing(mu: mpf) -> mpf:
        return mpmath.log(forces_from_friction(levers, piston, mu)["torque"] / wanted)

    low, high = mpf(near), mpf(near)
    while missing(low) > 0:
        low *= 1 - mpf(10) ** -9
    while missing(high) < 0:
        high = min(high * (1 + mpf(10) ** -9), (high + limit) / 2 if limit else mpmath.inf)
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if missing(middle) < 0 else (low, middle)
        if high - low < low * mpf(10) ** -36:
            break
    return (low + high) / 2


def exact_stop(truck: Truck, conditions: StopConditions) -> dict[str, mpf]:
    """Compute the fields of `Stop`, by name, for a truck that stops; axle loads are over the weight."""
    m, ml = mpf(truck.empty_mass), mpf(truck.load_mass)
    a, y = ((m * mpf(e) + ml * mpf(w)) / (m + ml) for e, w in zip(truck.empty_cg, truck.load_cg, strict=True))
    V, mu, t1, t2, g = (
        mpf(getattr(conditions, name))
        for name in ("speed", "friction", "reaction_time", "rise_time", "gravity")
    )
    L, h = mpf(truck.wheelbase), (y + mpf(truck.front_wheel_radius)) * conditions.sense
    pull, weight = g * mpmath.sin(mpf(conditions.slope)), (m + ml) * g
    front = weight * (L - a) * mpmath.cos(mpf(conditions.slope)) / (L + mu * h)
    A = pull - mu * front / (m + ml)
    after = V + A * t2 / 2
    if after <= 0:
        tau = mpmath.sqrt(-2 * V * t2 / A)
        distance, time = V * t1 + 2 * V * tau / 3, t1 + tau
    else:
        distance, time = V * t1 + V * t2 + A * t2**2 / 6 - after**2 / (2 * A), t1 + t2 / 2 - V / A
    torque = mpf(truck.front_wheel_radius) * mu * front / 2
    return {"acceleration": A, "distance": distance, "time": time, "torque_per_brake": torque}
