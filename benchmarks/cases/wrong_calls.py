"""Public functions with valid arguments, and wrong values to replace arguments by."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from brakes import calipers, drum, forklift, planar


@dataclass(frozen=True)
class Call:
    """A public function with valid arguments.

    Parameters
    ----------
    name : str
        Name of the function.
    function : callable
        The function.
    arguments : mapping
        Accepted values of the arguments, by name.
    """

    name: str
    function: Callable[..., Any]
    arguments: Mapping[str, Any] = field(repr=False)

    def __str__(self) -> str:
        given = ", ".join(f"{name}={_short(value)}" for name, value in self.arguments.items())
        return f"{self.name}({given})"


def _short(value: Any) -> str:
    """Shorten a value for a message."""
    try:
        text = repr(value)
    except Exception as error:  # the repr of some objects fails; the message still needs a text
        text = f"<{type(value).__name__}: {error}>"
    return text if len(text) < 60 else f"{text[:40]}...{text[-12:]}"


# Wrong values -------------------------------------------------------------------------------------------

MAGNITUDES = (0, -1, 0.0, -0.0, 1e-300, -1e-9, 1e-12, 3e-4, 5, 200, 1e6, 1e12, 1e300, -1e300, 10**9, 10**400)
NOT_FINITE = (math.nan, math.inf, -math.inf, np.nan, np.float64("inf"))
TYPES = (
    *(
        None,
        True,
        False,
        "",
        "x",
        "5 mm",
        "ritz",
        "auto",
        b"5",
        1j,
        Decimal("0.1"),
        Fraction(1, 3),
        object(),
        type,
    ),
    *((), [], {}, set(), (1,), [1, 2], (0.1, 0.2), ("a", "b"), [[1.0]], {"a": 1}, range(3), iter([1.0]), len),
    *(np.array([]), np.array([0.1, 0.2]), np.ones((2, 2)), np.array(0.1), np.array(["a"]), np.array([None])),
    *(
        np.array([1j]),
        np.array([math.nan, 1.0]),
        np.float32(0.1),
        np.int64(2),
        np.bool_(True),
        [math.nan],
        [[], []],
    ),
    *(Polynomial([0.1]), Path("x"), lambda x: x, math, NotImplemented, Ellipsis, slice(1)),
)


def wrong_values() -> list[Any]:
    """List wrong values: magnitudes, numbers that are not finite, other types, and the package's objects."""
    beam, mount, scene = _beam(), bd.Mount(0.2), _scene()
    own = (
        beam,
        mount,
        scene,
        bd.Table([0, 1], [1, 2]),
        bd.SpinUp(50.0, 1.0),
        bd.Ritz(8),
        bd.Physics(planes=2),
        make_shoe(),
        make_clamp(),
    )
    return [*MAGNITUDES, *NOT_FINITE, *TYPES, *own, bd.Beam, planar.solve]


# Right calls --------------------------------------------------------------------------------------------


def _beam() -> bd.Beam:
    return bd.Beam.rectangular(**STRIP)


def _scene(motion: Any = None) -> bd.Scene:
    return bd.Scene(_beam(), bd.Mount(0.215), motion)


def _twisted() -> bd.Scene:
    """Make a twisted strip that bends in both directions, on a root spring."""
    beam = bd.Beam.rectangular(**STRIP, twist=0.5, poissons_ratio=0.3)
    physics = bd.Physics(planes=2, shear=True, rotary_inertia=True)
    return bd.Scene(beam, bd.Mount(0.2, root_stiffness=10.0), physics=physics)


def _rolling() -> bd.Scene:
    return _scene(bd.RollingWheel(0.3, bd.SpinUp(55.0, 0.2), bd.RoadWave(0.3, velocity_amplitude=0.01)))


def make_shoe() -> drum.Shoe:
    return drum.Shoe(**SHOE)


def make_clamp() -> planar.Mechanism:
    """Make a mechanism: a lever on a pin, pressed on a spring."""
    lever = planar.Pin("pin", "lever", "ground", (0.0, 0.0))
    hand = planar.Force("hand", "lever", (0.2, 0.0), (0.0, -1.0))
    spring = planar.Spring("spring", "lever", "ground", (0.1, 0.0), (0.1, -0.1), 1000.0, 0.12)
    return planar.Mechanism(("lever",), (lever,), (hand, spring))


STRIP = {"length": 0.05, "width": 0.01, "thickness": 0.0002, "youngs_modulus": 200e9, "density": 7850.0}
SHOE: dict[str, Any] = {
    "drum_radius": 0.138,
    "face_width": 0.05,
    "lining": (0.52, 1.92),
    "pivot": (0.02, -0.11),
    "force_arm": 0.115,
}
TRUCK: dict[str, Any] = {
    "empty_mass": 5950.0,
    "empty_cg": (1.049, 0.359),
    "load_mass": 3500.0,
    "load_cg": (-1.20, 0.450),
    "front_wheel_radius": 0.40,
    "wheelbase": 1.89,
}
ROAD = {"slope": 0.3019, "speed": 5.5, "friction": 0.7, "reaction_time": 0.5, "rise_time": 0.3}


def right_calls() -> list[Call]:
    """List all public functions that compute or describe something, with valid arguments."""
    scene, rolling, clamp, caliper = _scene(), _rolling(), make_clamp(), calipers.SinglePivot().build()
    truck, road = forklift.Truck(**TRUCK), forklift.StopConditions(**ROAD)
    slow = {"modes": 2, "tolerance": 1e-3}
    return [
        Call(
            "Beam.rectangular",
            bd.Beam.rectangular,
            {**STRIP, "tip": None, "breakpoints": (), "twist": 0.1, "poissons_ratio": 0.3},
        ),
        Call(
            "Beam.from_stiffness",
            bd.Beam.from_stiffness,
            {"length": 1.0, "mass_per_length": 1.0, "bending_stiffness": 1.0, "axial_stiffness": 1e6}
            | {"second_bending_stiffness": 9.0, "twist": 0.1, "shear_stiffness": 1e5, "rotary_inertia": 1e-3}
            | {"second_shear_stiffness": 1e5, "second_rotary_inertia": 1e-3},
        ),
        Call("PointMass", bd.PointMass, {"position": 0.02, "mass": 1e-3}),
        Call("TipMass", bd.TipMass, {"mass": 1e-3, "offset": 1e-3, "inertia": 1e-9}),
        Call(
            "Mount",
            bd.Mount,
            {"radius": 0.2, "setting_angle": 0.1, "bending_angle": 0.0}
            | {"root_stiffness": 5.0, "second_root_stiffness": math.inf},
        ),
        Call("Physics", bd.Physics, {"planes": 2, "shear": True, "rotary_inertia": True, "stretch": False}),
        Call(
            "Scene",
            bd.Scene,
            {"beam": _beam(), "mount": bd.Mount(0.2), "damping_ratio": 0.01, "gravity": 9.8}
            | {"physics": bd.Physics(planes=2, rotary_inertia=True)},
        ),
        Call("Table", bd.Table, {"stations": (0, 0.5, 1), "values": (0.01, 0.01, 0.005)}),
        Call("Ritz", bd.Ritz, {"functions": 8}),
        Call("Fem", bd.Fem, {"elements": 8}),
        Call("SteadyRotation", bd.SteadyRotation, {"speed": 50.0}),
        Call("SpinUp", bd.SpinUp, {"speed": 50.0, "duration": 1.0, "law": "smooth"}),
        Call("SampledRotation", bd.SampledRotation, {"times": (0.0, 1.0, 2.0), "speeds": (0.0, 10.0, 20.0)}),
        Call("RoadWave", bd.RoadWave, {"wavelength": 0.3, "velocity_amplitude": 0.01}),
        Call(
            "RollingWheel",
            bd.RollingWheel,
            {"rolling_radius": 0.3, "speed": bd.SpinUp(55.0, 1.0), "road": None},
        ),
        Call("load_scene", bd.load_scene, {"path": "examples/tyre_harvester.toml"}),
        Call("terms", bd.terms, {"scene": scene}),
        Call(
            "natural_modes",
            bd.natural_modes,
            {"scene": scene, "speed": 50.0, "discretization": "ritz", **slow},
        ),
        Call("natural_modes", bd.natural_modes, {"scene": _twisted(), "speed": 50.0, **slow}),
        Call("frequency_locus", bd.frequency_locus, {"scene": scene, "speeds": (0.0, 50.0), **slow}),
        Call("frequency_bounds", bd.frequency_bounds, {"scene": scene, "speed": 50.0, "modes": 2}),
        Call(
            "critical_speed", bd.critical_speed, {"scene": scene, "discretization": "ritz", "tolerance": 1e-3}
        ),
        Call("critical_point", bd.critical_point, {"scene": scene, "discretization": bd.Ritz(8)}),
        Call(
            "equilibrium",
            bd.equilibrium,
            {
                "scene": scene,
                "speed": 20.0,
                "branch": "straight",
                "discretization": "ritz",
                "tolerance": 1e-3,
            },
        ),
        Call(
            "equilibrium_branches",
            bd.equilibrium_branches,
            {"scene": scene, "top_speed": 20.0, "discretization": bd.Ritz(8)},
        ),
        Call(
            "backbone", bd.backbone, {"scene": scene, "speed": 20.0, "mode": 1, "discretization": bd.Ritz(8)}
        ),
        Call("setting_angle_limits", bd.setting_angle_limits, {"scene": scene, "top_speed": 300.0}),
        Call(
            "resonance_speeds",
            bd.resonance_speeds,
            {"scene": rolling, "top_speed": 90.0, "modes": 1, "order": 1},
        ),
        Call("steady_response", bd.steady_response, {"scene": rolling, "speeds": (40.0, 50.0), **slow}),
        Call(
            "simulate",
            bd.simulate,
            {"scene": rolling, "t_end": 0.1, "initial": "rest", "t_eval": (0.05,), **slow},
        ),
        Call(
            "sweep",
            bd.sweep,
            {"scene": rolling, "speeds": (40.0, 50.0), "window": (0.0, 0.1), "chunk": 4, **slow},
        ),
        Call("drum.Shoe", drum.Shoe, SHOE),
        Call("drum.simplex", drum.simplex, {"leading": make_shoe(), "trailing": make_shoe()}),
        Call(
            "drum.shoe_torque",
            drum.shoe_torque,
            {"shoe": make_shoe(), "friction": 0.3, "force": 1e3, "leading": True},
        ),
        Call(
            "drum.brake_torque",
            drum.brake_torque,
            {"brake": drum.simplex(make_shoe()), "friction": 0.3, "force": 1e3},
        ),
        Call("drum.wheel_cylinder_force", drum.wheel_cylinder_force, {"bore": 0.02, "line_pressure": 5e6}),
        Call("drum.stop_energy", drum.stop_energy, {"mass": 1000.0, "speed": 20.0, "descent": 1.0}),
        Call("drum.temperature_rise", drum.temperature_rise, {"energy": 1e5, "drum_mass": 8.0, "share": 0.9}),
        Call("forklift.Truck", forklift.Truck, TRUCK),
        Call("forklift.StopConditions", forklift.StopConditions, ROAD),
        Call("forklift.stop", forklift.stop, {"truck": truck, "conditions": road}),
        Call(
            "forklift.internal_forces",
            forklift.internal_forces,
            {"geometry": forklift.BENDIX_12_5, "torque": 11e3, "piston_force": 11650.0, "clearance": 0.0106},
        ),
        Call(
            "forklift.follow_shoes",
            forklift.follow_shoes,
            {"geometry": forklift.BENDIX_12_5, "clearance": 0.0106, "positions": 5},
        ),
        Call(
            "forklift.brake_procedure",
            forklift.brake_procedure,
            {
                "truck": truck,
                "conditions": road,
                "motion": forklift.BENDIX_12_5.move_shoes(0.0106),
                "piston_force": 11650.0,
            },
        ),
        Call("calipers.SinglePivot", calipers.SinglePivot, {"lever_ratio": 4.0, "clearance": 0.002}),
        Call("calipers.EeBrake", calipers.EeBrake, {"lever_ratio": 4.0, "split": "equal force"}),
        Call("Caliper.stroke", caliper.stroke, {"travel": 0.001, "points": 5, "finger": 40.0}),
        Call("Caliper.friction", caliper.friction, {"coefficient": 0.1, "travel": None}),
        Call("Caliper.wear", caliper.wear, {"lost": (0.0, 0.001)}),
        Call("Caliper.equilibrium", caliper.equilibrium, {"travel": 0.001, "finger": 40.0}),
        Call(
            "calipers.stop",
            calipers.stop,
            {"mass": 80.0, "speed": 8.0, "pad_force": 200.0, "friction": 0.4},
        ),
        Call(
            "planar.Pin",
            planar.Pin,
            {"name": "A", "body": "b", "at": (0.0, 0.0), "other": "ground", "radius": 0.01},
        ),
        Call(
            "planar.Bar",
            planar.Bar,
            {"name": "A", "body": "b", "other": "c", "at": (0.0, 0.0), "to": (1.0, 0.0)},
        ),
        Call(
            "planar.Contact",
            planar.Contact,
            {"name": "A", "body": "b", "other": "c", "at": (0.0, 0.0), "normal": (0.0, 1.0)},
        ),
        Call(
            "planar.Slot",
            planar.Slot,
            {"name": "A", "body": "b", "other": "c", "at": (0.0, 0.0), "along": (1.0, 0.0)},
        ),
        Call(
            "planar.Force",
            planar.Force,
            {"name": "F", "body": "b", "at": (0.0, 0.0), "direction": (1.0, 0.0), "magnitude": 5.0},
        ),
        Call("planar.Moment", planar.Moment, {"name": "M", "body": "b", "magnitude": 5.0}),
        Call(
            "planar.Mechanism",
            planar.Mechanism,
            {"bodies": ("lever",), "joints": clamp.joints, "loads": clamp.loads},
        ),
        Call("planar.solve", planar.solve, {"mechanism": clamp, "position": None}),
        Call("planar.assemble", planar.assemble, {"mechanism": clamp}),
        Call("planar.stroke", planar.stroke, {"mechanism": clamp, "driver": "hand", "values": (0.0, 0.01)}),
        Call(
            "planar.trace", planar.trace, {"mechanism": clamp, "driver": "hand", "length": 0.01, "points": 5}
        ),
        Call(
            "planar.solve_with_friction", planar.solve_with_friction, {"mechanism": clamp, "driver": "hand"}
        ),
        Call(
            "planar.free_body",
            planar.free_body,
            {"equilibrium": planar.solve(clamp), "body": "lever", "index": 0},
        ),
    ]


def draw_wrong_call(calls: list[Call], values: list[Any], random: Random) -> Call:
    """Choose a random call, with one or two arguments replaced by wrong values."""
    call = random.choice(calls)
    names = random.sample([*call.arguments], k=min(len(call.arguments), random.choice((1, 1, 1, 2))))
    return Call(
        call.name, call.function, {**call.arguments, **{name: random.choice(values) for name in names}}
    )


__all__ = ["Call", "draw_wrong_call", "right_calls", "wrong_values"]
