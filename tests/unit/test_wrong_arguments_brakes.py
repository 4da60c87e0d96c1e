"""Every argument of every design of brakes refuses values of a wrong kind, in one sentence that names it."""

from dataclasses import fields
from functools import partial

import numpy as np
import pytest

from brakes import calipers, chain, drum, find, forklift, planar, vehicle
from tests.unit.wrong_values import refusals_missing

SHOE = {"drum_radius": 0.138, "face_width": 0.05, "lining": (0.6, 1.9), "pivot": (0.02, -0.11)}
SHOE |= {"force_arm": 0.115, "pressure_zero": "axis"}
BRAKE = drum.simplex(drum.Shoe(**SHOE))
TRUCK = {"empty_mass": 4000.0, "empty_cg": (0.9, 0.5), "load_mass": 2500.0, "load_cg": (-0.5, 0.8)}
TRUCK |= {"front_wheel_radius": 0.33, "wheelbase": 1.6}
ROAD = {"slope": 0.05, "speed": 4.0, "friction": 0.6, "reaction_time": 0.7, "rise_time": 0.1, "gravity": 9.8}
DUO = {field.name: getattr(forklift.BENDIX_12_5, field.name) for field in fields(forklift.DuoServo)}
LEVERS = {"drum_radius": 0.15, "a1": 0.1, "a2": 0.1, "b1": 0.1, "b2": 0.1, "alpha1": 1.0, "alpha2": 1.0}
LEVERS |= {"gamma": 0.3}
JOINT = {"name": "j", "body": "arm", "other": "ground"}
ARM = planar.Mechanism(
    ("arm",), (planar.Pin("pin", "arm", "ground", (0.0, 0.0)),), (planar.Moment("turn", "arm"),)
)

BICYCLE, SLOPE = vehicle.Vehicle(80.0, 0.62, 1.1, 1.02), vehicle.Road(0.1, 0.8)
BRAKED = chain.brake_from_pedal(
    forklift.Truck(**TRUCK),
    forklift.StopConditions(**ROAD),
    chain.Pedal(5.0, 450.0),
    chain.HydraulicLine(0.022, 0.032),
    0.7,
)


def built(design):
    return lambda **given: design(**given).build()


BRAKES = {
    "Shoe": (drum.Shoe, SHOE),
    "DrumBrake": (drum.DrumBrake, {"shoes": (drum.Shoe(**SHOE),), "leading": (True,)}),
    "simplex": (drum.simplex, {"leading": drum.Shoe(**SHOE), "trailing": None}),
    "duplex": (drum.duplex, {"first": drum.Shoe(**SHOE), "second": None}),
    "brake_torque": (drum.brake_torque, {"brake": BRAKE, "friction": 0.3, "force": 1e3, "reverse": False}),
    "brake_torque peak": (drum.brake_torque, {"brake": BRAKE, "friction": 0.3, "peak_pressure": 1e5}),
    "brake_torque torque": (drum.brake_torque, {"brake": BRAKE, "friction": 0.3, "torque": 10.0}),
    "shoe_torque": (
        drum.shoe_torque,
        {"shoe": drum.Shoe(**SHOE), "friction": 0.3, "force": 1e3, "leading": True},
    ),
    "stop_energy": (
        drum.stop_energy,
        {"mass": 1e3, "speed": 20.0, "final_speed": 0.0, "descent": 0.0, "inertia": 1.0}
        | {"rolling_radius": 0.3, "g": 9.8},
    ),
    "temperature_rise": (
        drum.temperature_rise,
        {"energy": 1e5, "drum_mass": 5.0, "specific_heat": 500.0, "share": 0.9},
    ),
    "wheel_cylinder_force": (drum.wheel_cylinder_force, {"bore": 0.02, "line_pressure": 1e6}),
    "Truck": (forklift.Truck, TRUCK),
    "StopConditions": (forklift.StopConditions, ROAD),
    "forklift.stop": (
        forklift.stop,
        {"truck": forklift.Truck(**TRUCK), "conditions": forklift.StopConditions(**ROAD)},
    ),
    "DuoServo": (forklift.DuoServo, DUO),
    "Levers": (forklift.Levers, LEVERS),
    "follow_shoes": (
        forklift.follow_shoes,
        {"geometry": forklift.BENDIX_12_5, "clearance": 3e-4, "positions": 3},
    ),
    "hold": (
        vehicle.hold,
        {"vehicle": BICYCLE, "road": SLOPE, "braked": "both", "downhill": "front", "brake_force": 100.0},
    ),
    "braking_limits": (
        vehicle.braking_limits,
        {"vehicle": BICYCLE, "friction": 0.8, "front_share": 0.5, "leading": "front"},
    ),
    "slow_down": (
        vehicle.slow_down,
        {"vehicle": BICYCLE, "road": SLOPE, "approach": vehicle.Approach(8.0), "brake_force": 200.0}
        | {"front_share": 0.5, "leading": "front"},
    ),
    "friction_to_hold": (
        vehicle.friction_to_hold,
        {"vehicle": BICYCLE, "slope": 0.1, "braked": "both", "downhill": "front"},
    ),
    "repeat_stops": (
        partial(drum.repeat_stops, torque_at=np.positive),
        {"duty": drum.Duty(20.0, 50.0, 5.0), "friction": 0.4},
    ),
    "heat_of_stop": (chain.heat_of_stop, {"stop": BRAKED.stop, "drums": chain.Drums(18.0, 0.05)}),
    "fade_of_stops": (
        partial(chain.fade_of_stops, torque_per_force=np.positive),
        {"braked": BRAKED, "drums": chain.Drums(18.0, 0.05), "friction": 0.4},
    ),
    "find": (
        partial(find, np.positive),
        {"target": 1.0, "samples": [0.0, 1.0, 2.0], "rounding": 0.0},
    ),
    "internal_forces": (
        forklift.internal_forces,
        {"geometry": forklift.BENDIX_12_5, "piston_force": 1e3, "torque": 100.0, "clearance": 3e-4},
    ),
    "calipers.stop": (
        calipers.stop,
        {"mass": 90.0, "speed": 8.0, "pad_force": 300.0, "friction": 0.5, "wheel_inertia": 0.1}
        | {"tyre_radius": 0.34, "rim_radius": 0.31},
    ),
    "Pin": (planar.Pin, JOINT | {"at": (0.0, 0.0), "at_other": None, "radius": 0.01, "friction": 0.1}),
    "Bar": (planar.Bar, JOINT | {"at": (0.0, 0.0), "to": (0.1, 0.0), "length": 0.1}),
    "Slot": (planar.Slot, JOINT | {"at": (0.0, 0.0), "along": (1.0, 0.0), "on": None, "friction": 0.1}),
    "Contact": (
        planar.Contact,
        JOINT | {"at": (0.0, 0.0), "normal": (1.0, 0.0), "on": None, "friction": 0.1},
    ),
    "RotationLock": (planar.RotationLock, JOINT | {"ratio": 1.0}),
    "Cable": (
        planar.Cable,
        {"name": "c", "bodies": ("arm", "ground"), "points": ((0.0, 0.0), (0.1, 0.0)), "length": 0.1},
    ),
    "CablePair": (planar.CablePair, JOINT | {"at": (0.0, 0.0), "to": (0.1, 0.0), "magnitude": 1.0}),
    "Force": (
        planar.Force,
        {"name": "f", "body": "arm", "at": (0.0, 0.0), "direction": (1.0, 0.0), "magnitude": 1.0}
        | {"follows": False},
    ),
    "Moment": (planar.Moment, JOINT | {"magnitude": 1.0}),
    "Spring": (
        planar.Spring,
        JOINT | {"at": (0.0, 0.0), "to": (0.1, 0.0), "stiffness": 10.0, "free_length": 0.1},
    ),
    "TorsionSpring": (planar.TorsionSpring, JOINT | {"stiffness": 10.0, "free_angle": 0.1}),
    "Mechanism": (planar.Mechanism, {"bodies": ("arm",), "joints": (), "loads": ()}),
    "solve": (planar.solve, {"mechanism": ARM, "position": None}),
    "solve_with_friction": (
        planar.solve_with_friction,
        {"mechanism": ARM, "driver": "turn", "position": None},
    ),
    "assemble": (planar.assemble, {"mechanism": ARM}),
    "stroke": (planar.stroke, {"mechanism": ARM, "driver": "turn", "values": [0.0, 0.1]}),
    "trace": (planar.trace, {"mechanism": ARM, "driver": "turn", "length": 0.1, "points": 3}),
    "free_body": (planar.free_body, {"equilibrium": planar.solve(ARM), "body": "arm", "index": 0}),
    **{
        name: (built(design), {field.name: getattr(design(), field.name) for field in fields(design)})
        for name, design in calipers.NAMED.items()
    },
}


def right_after_all(call, name):
    """What of the wrong values an argument of brakes may be: numbers may be arrays, and names are free."""
    if name in ("name", "body", "other") and call != "free_body":
        return {"text"}
    if name in ("reverse", "follows") or (call, name) == ("shoe_torque", "leading"):
        return {"truth", "numpy's truth"}
    if call == "Mechanism":
        return {"empty", "empty array"}
    return {"nested", "matrix", "ragged"}


@pytest.mark.parametrize(
    ("call", "name"), [(call, name) for call, (_, good) in BRAKES.items() for name in good]
)
def test_a_wrong_kind_is_refused_by_name_in_brakes(call, name):
    make, good = BRAKES[call]
    assert refusals_missing(make, good, name, right_after_all(call, name)) == {}
