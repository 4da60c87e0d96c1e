"""The forklift paper's numbers as printed: its stop, its Tables 2-7, and the consequences of its errors.

`stop_as_printed` reproduces Tables 2-4. For this it needs three things that Yoo et al. 1997 do not state:
y_cg - r1 as the height of the centre of gravity (the radius is subtracted from a height that the data already
count from the axle), g = 9.806 m/s2, and a factor 0.97 on the slope's pull, of unknown origin. One of the 45
numbers does not fit. The printed torque is about 30 % too high: safe for strength, unsafe for the stopping
distance.

Errata: (3) omits the moment of the brake torque on the body. (6) has theta' instead of theta''. (18) is g_c.
(19) and (22) ignore the speed lost while the brake force rises. (25) has m_B b instead of m_A b. The text
before (21) should read: from 0 to A. (26) is for the axle, Tables 4 and 5 for one brake. Table 7 gives the
clearance in metres without saying so. Inputs and errata are read from ``brakes/published/yoo_1997.toml``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.results.published import values_alone
from brakes.answers.forklift import ForkliftAnswer, solve_stages
from brakes.config.forklift import ForkliftInput, StageName
from brakes.forklift import BENDIX_12_5, InternalForces, Stop, StopConditions, Truck, internal_forces, stop
from brakes.published import load
from brakes.reproduce.common import Erratum, errata_of

VEHICLE, BRAKE = ("table_2", "table_3", "table_4"), ("table_5", "table_6", "table_7")
FORCES = ("A", "B", "Q", "P_L")
Tables = dict[tuple[str, str], np.ndarray]  # columns by table and quantity, e.g. ("table_4", "torque")


@dataclass(frozen=True)
class PrintedStop(Stop):
    """A stop by the paper's equations, in which an axle can lift; with the right equations it cannot.

    If one does, the status is ``"front wheel lifts"`` or ``"rear wheel lifts"``. It is never ``"stops in the
    rise time"``: the paper begins the last phase with the full speed.
    """

    @property
    def message(self) -> str:
        """One sentence that explains the status; of many cases, how many do not stop."""
        return _LIFTED.get(str(self.status)) or super().message


_LIFTED = {
    "front wheel lifts": "the front wheels lift: nothing brakes, and the truck turns over the rear axle",
    "rear wheel lifts": "the rear wheels lift: the truck turns over the front axle",
}


def stop_as_printed(truck: Truck, conditions: StopConditions) -> PrintedStop:
    """Compute a truck's stop by the method that reproduces the paper's Tables 2-4.

    Parameters and errors are those of `brakes.forklift.stop`. Axle loads at rest and the speed gained while
    coasting are taken from its result.
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
    """Compute the stopping distance [m] by the paper's (19)-(24); the acceleration [m/s2] is below 0."""
    V, A, t2 = c.speed, acceleration, c.rise_time
    return V * c.reaction_time + (A * t2**2 / 6 + V * t2) - V**2 / (2 * A)


def answer_as_printed(design: ForkliftInput, stages: tuple[StageName, ...]) -> ForkliftAnswer | None:
    """Solve the stages of a file with the paper's stop instead of the right one.

    Parameters
    ----------
    design : ForkliftInput
        The design that the file describes.
    stages : tuple of str
        Some of "vehicle", "kinematics", "forces".

    Returns
    -------
    ForkliftAnswer or None
        The answer; None if the stages do not depend on the stop.

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
    """Compute Tables 2-7 by the paper's method, in SI units.

    Returns
    -------
    dict of ndarray
        Numbers by table and quantity, e.g. ``("table_4", "torque")``; shapes (3, 3) for Tables 2-4, (3,) for
        Tables 5-7, rows and columns as printed.
    """
    computed = _vehicle_tables(stop_as_printed)
    for name in BRAKE:
        forces = base_forces(**inputs_of(name))
        computed |= {(name, force): getattr(forces, force) for force in FORCES}
    return computed


def corrected_tables() -> Tables:
    """Compute Tables 2-4 by the right mechanics, in SI units; the distance is inf if there is no stop."""
    return _vehicle_tables(stop)


def _vehicle_tables(solve: Callable[[Truck, StopConditions], Stop]) -> Tables:
    """Compute Tables 2-4 with a function that computes a stop."""
    computed: Tables = {}
    for name in VEHICLE:
        (down, rows), (across, columns) = inputs_of(name).items()
        found = solve(*base_case(**{down: rows[:, None], across: columns}))
        numbers = {
            "distance": found.distance,
            "acceleration": found.acceleration,
            "torque": found.torque_per_brake,
        }
        computed |= {(name, quantity): numbers[quantity] for quantity in quantities_of(name)}
    return computed


def inputs_of(name: str) -> dict[str, np.ndarray]:
    """Return the values of the inputs that vary in a table, rows first, by their published keys."""
    entries = load("yoo_1997")[name].items()
    varied = {key: entry for key, entry in entries if key != "padded" and "value" in entry}
    return {key: np.array(entry["value"]) for key, entry in varied.items()}


def quantities_of(name: str) -> tuple[str, ...]:
    """Return the keys of the printed quantities of a table in the published file."""
    return tuple(key for key, entry in load("yoo_1997")[name].items() if "printed" in entry)


def base_case(**varied: Numbers) -> tuple[Truck, StopConditions]:
    """Make truck and conditions of the paper's base case.

    Parameters
    ----------
    **varied : float or ndarray
        Inputs that differ from the paper's Table 1, in its units; the speed is in km/h.
    """
    paper = values_alone(load("yoo_1997"))
    case = paper["input"] | varied
    truck = ("empty_mass", "empty_cg", "load_mass", "load_cg", "front_wheel_radius", "wheelbase")
    return Truck(**{name: case[name] for name in truck}), StopConditions(
        **{name: case[name] for name in ("slope", "friction", "reaction_time", "rise_time")},
        speed=case["speed"] / 3.6,  # the paper's speed is in km/h
        gravity=paper["reproduction"]["gravity"],
    )


def base_forces(**varied: Numbers) -> InternalForces:
    """Compute the forces in the base case of Tables 5-7, with some of its inputs varied."""
    case = values_alone(load("yoo_1997")["input"]) | varied
    return internal_forces(
        BENDIX_12_5, **{name: case[name] for name in ("torque", "piston_force", "clearance")}
    )


def errata() -> tuple[Erratum, ...]:
    """List the paper's errors, each with its computed consequence in the base case."""
    paper = load("yoo_1997")
    printed, right = stop_as_printed(*base_case()), stop(*base_case())
    unladen = [solve(*base_case(load_mass=0.0)).acceleration for solve in (stop_as_printed, stop)]
    truck, conditions, torque = right.truck, right.conditions, right.torque_per_brake
    mu, y, r1 = conditions.friction, truck.cg[1], truck.front_wheel_radius
    # If the moments about the axle omit the brake torque, the arm is y_cg.
    ratio = (truck.wheelbase + mu * (y + r1)) / (truck.wheelbase + mu * y)
    missing = 1 - paper["reproduction"]["factor"]["value"]
    slower = right.acceleration - missing * (conditions.gravity * np.sin(conditions.slope))
    longer = printed_distance(right.acceleration, conditions)
    one = "torque of one brake", "N m"
    costs = {
        "body_moment": (*one, torque * ratio, torque),
        "twice": (*one, printed.torque_per_brake, torque),
        "factor": ("acceleration", "m/s2", slower, right.acceleration),
        "unladen": ("acceleration unladen", "m/s2", *unladen),
        "speed_lost": ("distance by the corrected acceleration", "m", longer, right.distance),
        "axle": (*one, 2 * torque, torque),
    }
    return errata_of(paper, costs)
