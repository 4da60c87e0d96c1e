"""The forklift paper's own numbers: its stop, its Tables 2-7, and what each of its errors costs.

`stop_as_printed` reproduces Tables 2-4. It needs three things that Yoo et al. 1997 do not say: the height
y_cg - r1 of the centre of gravity (the radius is subtracted from a height that the data count from the axle
already), g = 9.806 m/s2, and a factor 0.97 on the slope's pull, whose origin is not known. One of the 45
numbers does not fit. The printed torque comes out about 30 % high: safe for strength, unsafe for the stopping
distance.

Errata: (3) omits the moment of the brake torque on the body. (6) has theta' for theta''. (18) is g_c. (19)
and (22) ignore the speed lost while the brake force rises. (25) has m_B b for m_A b. The text before (21):
from 0 to A. (26) is for the axle, Tables 4 and 5 for one brake. Table 7 gives the clearance in metres,
without saying so. Inputs and errata come from ``brakes/published/yoo_1997.toml``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from brakes.answers.forklift import ForkliftAnswer, solve_stages
from brakes.config.forklift import ForkliftInput, StageName
from brakes.forklift import BENDIX_12_5, InternalForces, Stop, StopConditions, Truck, internal_forces, stop
from brakes.published import load
from brakes.published.errata import Erratum

_TRUCK = ("empty_mass", "empty_cg", "load_mass", "load_cg", "front_wheel_radius", "wheelbase")
_ROAD = ("slope", "friction", "reaction_time", "rise_time")
_BRAKE = ("torque", "piston_force", "clearance")

Tables = dict[tuple[str, str], np.ndarray]  # by table and quantity, e.g. ("table_4", "torque")


@dataclass(frozen=True)
class PrintedStop(Stop):
    """A stop by the paper's equations; they can lift an axle, which the right ones cannot.

    The status is then ``"front wheel lifts"`` or ``"rear wheel lifts"``. It is never ``"stops in the rise
    time"``: the paper takes the full speed into the last phase.
    """

    @property
    def message(self) -> str:
        """What the status means, in one sentence; of many cases, how many do not stop."""
        return _LIFTED.get(str(self.status)) or super().message


_LIFTED = {
    "front wheel lifts": "the front wheels lift: nothing brakes, and the truck turns over the rear axle",
    "rear wheel lifts": "the rear wheels lift: the truck turns over the front axle",
}


def stop_as_printed(truck: Truck, conditions: StopConditions) -> PrintedStop:
    """Compute a stop by the way that reproduces the paper's Tables 2-4.

    It has the parameters of `brakes.forklift.stop`, raises its errors, and takes from its result the axle
    loads at rest and the speed gained when coasting.
    """
    right, c = stop(truck, conditions), conditions
    (x, y), r1, weight = truck.cg, truck.front_wheel_radius, truck.mass * c.gravity * np.cos(c.slope)
    N_A = weight * (truck.wheelbase - x) / (truck.wheelbase + c.friction * (y - r1))
    pull = load("yoo_1997")["reproduction"]["factor"]["value"] * c.gravity * np.sin(c.slope)
    N_A, N_B, A = np.broadcast_arrays(
        N_A, weight - N_A, pull - c.friction * N_A / truck.mass, right.acceleration
    )[:3]
    kinds = ["front wheel lifts", "rear wheel lifts", "never stops"]
    status = np.select([N_A <= 0, N_B <= 0, A >= 0], kinds, default="stops")
    stops, slowing = status == "stops", np.where(A < 0, A, -1.0)
    changed: dict[str, Any] = {
        "stops": stops,
        "status": status,
        "acceleration": A,
        "distance": np.where(stops, printed_distance(slowing, c), np.inf),
        "time": np.where(stops, c.reaction_time + c.rise_time - c.speed / slowing, np.inf),
        "rise_distance": A * c.rise_time**2 / 6 + c.speed * c.rise_time,
        "braking_distance": np.where(stops, -(c.speed**2) / (2 * slowing), np.inf),
        "speed_lost_in_rise": np.zeros(A.shape),
        "torque_per_brake": r1 * c.friction * N_A / 2,
        "front_load": N_A,
        "rear_load": N_B,
    }
    return PrintedStop(**{**vars(right), **{name: np.asarray(x)[()] for name, x in changed.items()}})


def printed_distance(acceleration: Numbers, c: StopConditions) -> Numbers:
    """Compute the stopping distance [m] by (19)-(24); the acceleration at full brake force [m/s2] is < 0."""
    V, A, t2 = c.speed, acceleration, c.rise_time
    return V * c.reaction_time + (A * t2**2 / 6 + V * t2) - V**2 / (2 * A)


def answer_as_printed(design: ForkliftInput, stages: tuple[StageName, ...]) -> ForkliftAnswer | None:
    """Solve the stages of a file with the paper's stop in place of the right one.

    Parameters
    ----------
    design : ForkliftInput
        The file.
    stages : tuple of str
        Of "vehicle", "kinematics", "forces".

    Returns
    -------
    ForkliftAnswer or None
        None where the stop has no part in the stages.

    Raises
    ------
    ValueError
        As for `brakes.answers.forklift.solve_stages`.
    """
    answer = solve_stages(design, stages)
    if answer.stop is None and answer.torque_from != "the stop":
        return None
    assert design.truck is not None and design.stop is not None
    printed = stop_as_printed(design.truck.core, design.stop.core)
    if answer.torque_from == "the stop":
        assert design.forces is not None
        forces = design.forces.model_copy(update={"torque": float(printed.torque_per_brake)})
        with_torque = design.model_copy(update={"forces": forces})
        answer = replace(answer, forces=solve_stages(with_torque, ("forces",)).forces)
    return replace(answer, stop=answer.stop and printed)


# Tables ---------------------------------------------------------------------------------------------


def tables() -> Tables:
    """Compute Tables 2-7 by the paper's way, in SI units.

    Returns
    -------
    dict of ndarray
        By table and quantity, e.g. ``("table_4", "torque")``; shapes (3, 3) for Tables 2-4, (3,) for
        Tables 5-7, rows and columns as printed.
    """
    computed = _vehicle_tables(stop_as_printed)
    for name, varied in (("table_5", "torque"), ("table_6", "piston_force"), ("table_7", "clearance")):
        forces = _forces(varied, _column(name, varied))
        computed |= {(name, quantity): getattr(forces, quantity) for quantity in ("A", "B", "Q", "P_L")}
    return computed


def corrected_tables() -> Tables:
    """Compute Tables 2-4 by the right mechanics, in SI units; the distance is inf without a stop."""
    return _vehicle_tables(stop)


def base_case(**varied: Numbers) -> tuple[Truck, StopConditions]:
    """Truck and conditions of the paper's base case.

    Parameters
    ----------
    **varied : float or ndarray
        Inputs that differ from the paper's Table 1, in its units: the speed in km/h.
    """
    paper = load("yoo_1997")
    case = {name: entry["value"] for name, entry in paper["input"].items()} | varied
    return Truck(**{name: case[name] for name in _TRUCK}), StopConditions(
        **{name: case[name] for name in _ROAD},
        speed=case["speed"] / 3.6,  # printed in km/h
        gravity=paper["reproduction"]["gravity"]["value"],
    )


def errata() -> tuple[Erratum, ...]:
    """The paper's errors, each with its consequence at the base case computed."""
    entries = load("yoo_1997")["erratum"]
    return tuple(Erratum(**known, **_CONSEQUENCES.get(known["name"], dict)()) for known in entries)


def _vehicle_tables(solve: Callable[[Truck, StopConditions], Stop]) -> Tables:
    """Compute Tables 2-4 by a way to compute a stop."""
    speeds, loads, trucks = (
        solve(*base_case(**{down: _column(name, down)[:, None], across: _column(name, across)}))
        for name, down, across in (
            ("table_2", "friction", "speed"),
            ("table_3", "slope", "load_mass"),
            ("table_4", "empty_mass", "front_wheel_radius"),
        )
    )
    return {
        ("table_2", "distance"): speeds.distance,
        ("table_3", "distance"): loads.distance,
        ("table_3", "acceleration"): loads.acceleration,
        ("table_4", "distance"): trucks.distance,
        ("table_4", "torque"): trucks.torque_per_brake,
    }


def _forces(varied: str, values: np.ndarray) -> InternalForces:
    base = {name: load("yoo_1997")["input"][name]["value"] for name in _BRAKE}
    return internal_forces(BENDIX_12_5, **(base | {varied: values}))


def _column(name: str, key: str) -> np.ndarray:
    return np.array(load("yoo_1997")[name][key]["value"])


# Consequences ---------------------------------------------------------------------------------------


def _entry(quantity: str, unit: str, printed: Numbers, right: Numbers) -> dict[str, Any]:
    return {"quantity": quantity, "unit": unit, "printed_value": float(printed), "right_value": float(right)}


def _torque_without_reaction() -> dict[str, Any]:
    """With moments about the axle that leave out the brake torque: the arm is then y_cg."""
    right = stop(*base_case())
    t, mu = right.truck, right.conditions.friction
    y, r1 = t.cg[1], t.front_wheel_radius
    ratio = (t.wheelbase + mu * (y + r1)) / (t.wheelbase + mu * y)
    return _entry("torque of one brake", "N m", right.torque_per_brake * ratio, right.torque_per_brake)


def _twice() -> dict[str, Any]:
    printed, right = stop_as_printed(*base_case()), stop(*base_case())
    return _entry("torque of one brake", "N m", printed.torque_per_brake, right.torque_per_brake)


def _factor() -> dict[str, Any]:
    right = stop(*base_case())
    missing = 1 - load("yoo_1997")["reproduction"]["factor"]["value"]
    pull = right.conditions.gravity * np.sin(right.conditions.slope)
    return _entry("acceleration", "m/s2", right.acceleration - missing * pull, right.acceleration)


def _unladen() -> dict[str, Any]:
    printed, right = (solve(*base_case(load_mass=0.0)) for solve in (stop_as_printed, stop))
    return _entry("acceleration unladen", "m/s2", printed.acceleration, right.acceleration)


def _speed_lost() -> dict[str, Any]:
    right = stop(*base_case())
    longer = printed_distance(right.acceleration, right.conditions)
    return _entry("distance by the corrected acceleration", "m", longer, right.distance)


def _axle() -> dict[str, Any]:
    torque = stop(*base_case()).torque_per_brake
    return _entry("torque of one brake", "N m", 2 * torque, torque)


_CONSEQUENCES: dict[str, Callable[[], dict[str, Any]]] = {
    "body_moment": _torque_without_reaction,
    "twice": _twice,
    "factor": _factor,
    "unladen": _unladen,
    "speed_lost": _speed_lost,
    "axle": _axle,
}
