"""Verdicts on brakes and vehicles exactly at the edge that decides them: no thirteenth digit turns one."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from brakes import calipers, drum, forklift, machines, planar, vehicle
from brakes.planar.kinematics import driver_at_travel

PISTON = 11650.0  # N
G = 9.80665  # m/s2
TRUCK = forklift.Truck(5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89)
BRAKE = forklift.BENDIX_12_5
LEVERS = forklift.Levers(
    drum_radius=0.15, a1=0.2, a2=0.1, b1=0.19, b2=0.19, alpha1=0.3, alpha2=0.3, gamma=0.1
)
MASS, WHEELBASE, HEIGHT, BEHIND = 80.0, 1.1, 1.0, 0.5  # kg, m


def stop_of_truck(speed: float) -> Any:
    """Level ground, brakes that rise within 0.3 s."""
    return forklift.stop(TRUCK, forklift.StopConditions(0.0, speed, 0.7, 0.5, 0.3, G)).status


def speed_that_the_rise_takes_up() -> float:
    """Half the full deceleration over the 0.3 s in which it rises linearly."""
    load = TRUCK.wheelbase - TRUCK.cg[0]
    arm = TRUCK.wheelbase + 0.7 * (TRUCK.cg[1] + TRUCK.front_wheel_radius)
    return float(0.7 * G * load / arm * 0.3 / 2)


def torque_without_bounds() -> float:
    """T [N m] of friction without bounds: moments X b - P a = r |P + X| of the trailing and leading shoe."""
    r, x = LEVERS.drum_radius, PISTON
    torque = 0.0
    for a, b, phi in ((LEVERS.a2, LEVERS.b2, LEVERS.phi2), (LEVERS.b1, LEVERS.a1, LEVERS.phi1)):
        half = a * b + r**2 * math.cos(phi)
        root = math.sqrt(half**2 - (a**2 - r**2) * (b**2 - r**2))
        given, x = x, x * (half + root) / (b**2 - r**2)
        torque += r * math.hypot(given + x * math.cos(phi), x * math.sin(phi))
    return torque


def clearance_that_lets_the_tip_out() -> float:
    """Clearance [m] whose seating takes the tip's pin to the drum's radius, by bisection."""

    def radius(clearance: float) -> float:
        turn = BRAKE._seating_turn(clearance)
        return float(np.hypot(*BRAKE._after_seating(turn, *BRAKE.tip)))

    low, high = 0.03, 0.05
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if radius(middle) < BRAKE.drum_radius else (low, middle)
    return low


def clearance_out_of_reach() -> tuple[forklift.DuoServo, float]:
    """A brake whose lining reaches the drum with pin and contact point in line, |h| + |v| = r."""
    brake = replace(BRAKE, adjuster=(0.1, -0.02), contact_angle=0.05)

    def reach(clearance: float) -> float:
        contact = (brake.drum_radius - clearance) * complex(math.cos(0.05), math.sin(0.05))
        return abs(complex(*brake.adjuster)) + abs(contact - complex(*brake.adjuster))

    low, high = 1e-4, 0.05
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if reach(middle) > brake.drum_radius else (low, middle)
    return brake, low


def stop_of_bicycle(tyre_friction: float, rim: float = 0.3) -> tuple[str, str]:
    stance = calipers.Stance("front", tyre_friction, WHEELBASE, HEIGHT, BEHIND)
    found = calipers.stop(MASS, 8.0, 3000.0, 0.4, tyre_radius=0.33, rim_radius=rim, stance=stance)
    return found.status, found.limited_by


def crank_of(angle: float, driver: str) -> planar.Mechanism:
    """Slider-crank of 50 and 200 mm whose slider is driven."""
    x, y = 0.05 * math.cos(angle), 0.05 * math.sin(angle)
    joints = (
        planar.Pin("axle", "crank", "ground", at=(0, 0)),
        planar.Bar("rod", "crank", "slider", at=(x, y), to=(x + math.sqrt(0.04 - y**2), 0)),
        planar.Slot("guide", "slider", "ground", at=(0.3, 0), along=(1, 0)),
        planar.RotationLock("upright", "slider", "ground"),
    )
    loads = (planar.Force("piston", "slider", (0.3, 0), (-1, 0)), planar.Moment("torque", "crank", 5.0))
    return planar.Mechanism(("crank", "slider"), joints, loads)


RAISED = math.radians(150)
TO_DEAD_CENTRE = 0.05 * math.cos(RAISED) + math.sqrt(0.04 - (0.05 * math.sin(RAISED)) ** 2) - 0.15  # m


def stroke_of_piston(travel: float) -> int:
    return len(planar.stroke(crank_of(RAISED, "piston"), "piston", [travel]).values)


def driver_of_travel(travel: float) -> str:
    found = driver_at_travel(crank_of(RAISED, "piston"), "piston", {"piston": 1.0}, travel)
    return f"{found:.4g}"


def shoe_on_a_pin(depth: float) -> Any:
    shoe = drum.Shoe(0.138, 0.05, np.radians((30, 110)), pivot=(0.0, -depth), force_arm=0.115)
    return drum.shoe_torque(shoe, friction=0.3, force=1000.0).status


def interference_of(stroke: float) -> int:
    return len(replace(BRAKE, piston_stroke=stroke).move_shoes(0.0106).interference)


def stops_against_a_load(torque: float) -> Any:
    duty = drum.Duty(20.0, 50.0, 5.0, load_torque=torque)
    return drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu).status


VEHICLE = vehicle.Vehicle(100.0, cg_behind_front=0.75, cg_height=1.0, wheelbase=1.5)


def limits_of(friction: float, share: float = 0.5) -> list[bool]:
    found = vehicle.braking_limits(VEHICLE, friction, share)
    ratios = found.front_alone, found.rear_alone, found.front_locks, found.rear_locks
    return [bool(np.isinf(each)) for each in ratios]


def rolls_on_any_slope(force: float) -> bool:
    return not np.isinf(vehicle.hold(VEHICLE, vehicle.Road(0.1, 0.5), brake_force=force).rolling_slope)


def friction_on(slope: float) -> Any:
    return vehicle.friction_to_hold(VEHICLE, slope, braked="both", downhill="front").reason


def limit_of_stop(torque: float) -> Any:
    conditions = forklift.StopConditions(0.1, 5.0, 0.7, 0.5, 0.3, G)
    return forklift.stop(TRUCK, conditions, torque).limited_by


def stops_on_a_curve_to(last: float) -> Any:
    """A stop that warms the brake by 10 K, from 293.15 K."""
    duty = drum.Duty(20.0, 50.0, 5.0, friction_curve=[[293.15, 0.4], [last, 0.4]])
    return drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu).status


def warned_of_pv(most: float) -> int:
    duty = drum.Duty(20.0, 50.0, 5.0, most_pv=most)
    return len(drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu, pv=1e6).warnings)


def sticks(friction: float) -> bool:
    return bool(machines.Cone(0.153, 0.165, width=0.06).remarks(friction, False))


def band_of(second_arm: float) -> Any:
    band = machines.Band(0.2, 0.05, wrap=3.9, force_arm=0.5, first_arm=0.1, second_arm=second_arm)
    return machines.solve_brake(band, friction=0.0, force=1.0).status


def motion_at(brake: forklift.DuoServo) -> Callable[[float], Any]:
    return lambda clearance: len(brake.move_shoes(clearance).right_tip)


def edges() -> Iterator[tuple[str, Callable[[float], Any], float]]:
    """What is decided, by which number, and where."""
    yield "truck stops at the end of the rise", stop_of_truck, speed_that_the_rise_takes_up()
    torque = torque_without_bounds()
    yield (
        "torque of friction without bounds",
        lambda torque: forklift.internal_forces(LEVERS, torque=torque, piston_force=PISTON).status,
        torque,
    )
    yield "stroke of a piston", interference_of, float(BRAKE.move_shoes(0.0106).left_travel)
    yield "tip at the drum", motion_at(BRAKE), clearance_that_lets_the_tip_out()
    stiff, clearance = clearance_out_of_reach()
    yield "lining out of reach", motion_at(stiff), clearance
    pitch = BEHIND / HEIGHT  # in g, of wheels without inertia
    grip = pitch * WHEELBASE / (WHEELBASE - BEHIND + pitch * HEIGHT)
    yield "grip and pitching over at once", stop_of_bicycle, grip
    yield "rim as large as the tyre", lambda rim: stop_of_bicycle(0.4, rim), 0.33
    yield (
        "weight over the rear axle",
        lambda x: calipers.Stance("front", 0.5, WHEELBASE, HEIGHT, x).braked_wheel,
        WHEELBASE,
    )
    yield "pin at two radii", shoe_on_a_pin, 2 * 0.138
    yield "front axle never locks", limits_of, 0.75
    yield "brakes that hold the weight", rolls_on_any_slope, 100.0 * 9.806
    yield "slope on which it tips", friction_on, math.atan(0.75)
    locked = forklift.stop(TRUCK, forklift.StopConditions(0.1, 5.0, 0.7, 0.5, 0.3, G))
    yield "torque that locks the wheel", limit_of_stop, float(locked.torque_per_brake)
    yield "cone that sticks", sticks, 0.2
    yield "second arm of a band", band_of, 0.1
    yield "last temperature of a curve", stops_on_a_curve_to, 303.15
    yield "largest pressure times speed", warned_of_pv, 1e6
    yield "load torque as large as the brake's", stops_against_a_load, 400.0
    yield "stroke to a dead centre", stroke_of_piston, TO_DEAD_CENTRE
    yield "travel to a dead centre", driver_of_travel, TO_DEAD_CENTRE


EDGES = list(edges())


def verdict(function: Callable[[float], Any], value: float) -> str:
    """What comes out, or the refusal without its numbers."""
    try:
        return str(function(value))
    except ValueError as error:
        return re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", str(error))


@pytest.mark.parametrize("function, edge", [each[1:] for each in EDGES], ids=[name for name, *_ in EDGES])
def test_no_thirteenth_digit_decides(function: Callable[[float], Any], edge: float):
    """The same on either side of the edge; a millionth away from it the two sides differ."""
    assert len({verdict(function, edge * (1 + digit * 1e-13)) for digit in range(-3, 4)}) == 1
    assert verdict(function, edge * (1 - 1e-6)) != verdict(function, edge * (1 + 1e-6))
