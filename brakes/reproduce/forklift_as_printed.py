"""The forklift paper's numbers as printed: its stop, its Tables 2-7, and the consequences of its errors.

`stop_as_printed` reproduces Tables 2-4. For this it needs three things that Yoo et al. 1997 do not state:
y_cg - r1 as the height of the centre of gravity (the radius is subtracted from a height that the data already
count from the axle), g = 9.806 m/s2, and a factor 0.97 on the slope's pull, of unknown origin. One of the 45
numbers does not fit. The printed torque is about 30 % too high: safe for strength, unsafe for the stopping
distance.

Errata: (3) omits the moment of the brake torque on the body. (6) has theta' instead of theta''. (18) defines
g_c, not g. (19) and (22) ignore the speed lost while the brake force rises. (25) has m_B b instead of m_A b.
The text before (21) should read: from 0 to A. (26) is for the axle, Tables 4 and 5 for one brake. Table 7
gives the clearance in metres without saying so. Inputs and errata are read from
``brakes/published/yoo_1997.toml``.

`newton_raphson` is the paper's iteration on its ten equations (27)-(36).  The result depends on the start:
from most random starts the iteration diverges, or converges to one of the three mirror images of the
solution. They satisfy the equations as well, with A x B or C x D of the wrong sign, or both; B and D enter
the moments by their magnitudes, so that Q and P_L are positive in all four solutions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, positive
from beamdyn.common.results.one_line import counted, number
from beamdyn.common.results.published import values_alone
from beamdyn.common.results.result import Result
from brakes.answers.forklift import ForkliftAnswer, solve_stages
from brakes.config.forklift import ForkliftInput, StageName
from brakes.forklift import (
    BENDIX_12_5,
    InternalForces,
    Levers,
    Stop,
    StopConditions,
    Truck,
    equilibrium_equations,
    internal_forces,
    stop,
)
from brakes.published import load
from brakes.reproduce.common import Erratum, errata_of

VEHICLE, BRAKE = ("table_2", "table_3", "table_4"), ("table_5", "table_6", "table_7")
FORCES = ("A", "B", "Q", "P_L")
Tables = dict[tuple[str, str], np.ndarray]  # columns by table and quantity, e.g. ("table_4", "torque")


@dataclass(frozen=True)
class PrintedStop(Stop):
    """A stop by the paper's equations, in which an axle can lift; with the corrected ones it cannot.

    If an axle lifts, the status is ``"front wheel lifts"`` or ``"rear wheel lifts"``. It is never ``"stops in
    the rise time"``: the paper begins the last phase with the full speed.
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
    """Compute the stopping distance [m] by the paper's equations (19)-(24); acceleration [m/s2] below 0."""
    V, A, t2 = c.speed, acceleration, c.rise_time
    return V * c.reaction_time + (A * t2**2 / 6 + V * t2) - V**2 / (2 * A)


def answer_as_printed(design: ForkliftInput, stages: tuple[StageName, ...]) -> ForkliftAnswer | None:
    """Solve the stages of a file with the paper's stop instead of the corrected one.

    Parameters
    ----------
    design : ForkliftInput
        The design that the file describes.
    stages : tuple of str
        Some of "vehicle", "kinematics", "forces".

    Returns
    -------
    ForkliftAnswer or None
        The results; None if the stages do not depend on the stop.

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
    """Compute Tables 2-4 by the corrected mechanics, in SI units; the distance is inf if there is no stop."""
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
    """Return the values of a table's varied inputs by key in the published file, the rows' input first."""
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
    # Torque by the paper over the right torque: the paper's moments omit the brake torque (arm y_cg).
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


_TOLERANCE = 1e-12  # tolerance of the largest residual of the equations, in units of T/r and r
_DIVERGED = 1e30  # residual, in units of T/r and r, above which the iteration counts as diverged
SCALED_START = (-1.5, 0.1, 0.1, 0.7, 0.6, 0.1, 0.05, -0.3, 0.5, 1.4)


@dataclass(frozen=True)
class NewtonResult(Result):
    """Result of a Newton-Raphson iteration.

    Attributes
    ----------
    unknowns : ndarray, shape (10,)
        The unknown forces Ax, Ay, Bx, By, Cx, Cy, Dx, Dy, Q, P_L [N].
    converged : bool
        Whether the residual is below the tolerance.
    physical : bool
        Whether it converged to friction along the drum's motion, not to a mirror image.
    iterations : int
        Number of steps.
    residual : float
        Largest residual of the equations, in units of T/r and r.
    condition_number : float
        Condition number of the Jacobian at the last step, in the units of the iteration.
    """

    field_units: ClassVar[dict[str, str]] = {"N": "unknowns"}

    unknowns: np.ndarray
    converged: bool
    physical: bool
    iterations: int
    residual: float
    condition_number: float

    def headline(self) -> Iterator[str]:
        """Yield the number of steps with the residual, and the outcome; see `Result.headline`."""
        yield f"{counted(self.iterations, 'step')}, residual {number(self.residual)}"
        yield self.message

    @property
    def message(self) -> str:
        """One sentence that describes the outcome of the iteration."""
        if not self.converged:
            return f"no convergence within {self.iterations} steps: try another start, or internal_forces"
        mirrored = "" if self.physical else " to a mirror image: friction against the drum's motion"
        return f"converged{mirrored}"


def _jacobian(levers: Levers, x: np.ndarray) -> np.ndarray:
    """Compute the derivatives of `equilibrium_equations` with respect to the unknowns, shape (10, 10)."""
    r, a1, b1, b2 = levers.drum_radius, levers.a1, levers.b1, levers.b2
    vectors = x[:8].reshape(4, 2)
    A, B, C, D = sizes = np.hypot(*vectors.T)
    eA, eB, eC, eD = vectors / sizes[:, None]
    c, s = np.cos(levers.gamma), np.sin(levers.gamma)
    J = np.zeros((10, 10))
    J[0, [0, 2, 8, 9]] = 1, 1, c, np.cos(levers.alpha1)
    J[1, [1, 3, 8, 9]] = 1, 1, s, -np.sin(levers.alpha1)
    J[2, [2, 3, 8, 9]] = *(r * eB), b1, -a1
    J[3, [4, 6, 8]] = 1, 1, -c
    J[4, [5, 7, 8]] = 1, 1, -s
    J[5, [6, 7, 8]] = *(r * eD), -b2
    J[6, :4] = *vectors[1], *vectors[0]
    J[7, 4:8] = *vectors[3], *vectors[2]
    J[8, :8] = *(D * eA), *(-C * eB), *(-B * eC), *(A * eD)
    J[9, [2, 3, 6, 7]] = *(r * eB), *(r * eD)
    return J


def newton_raphson(
    levers: Levers,
    *,
    torque: float,
    piston_force: float,
    start: np.ndarray | None = None,
    damped: bool = False,
    scaled: bool = True,
    steps: int = 50,
) -> NewtonResult:
    """Solve the ten equilibrium equations of a single case by Newton-Raphson iteration.

    Parameters
    ----------
    levers : Levers
        Lever arms and directions of the forces.
    torque, piston_force : float
        Torque T [N m] and piston force P_T [N].
    start : ndarray, shape (10,), optional
        Initial unknowns in units of T/r; by default a start that works for the paper's brake.
    damped : bool
        Whether each step is halved until the residual decreases.
    scaled : bool
        Whether forces are divided by T/r and lengths by r; in SI units the Jacobian is ill-conditioned.
    steps : int
        Largest number of steps of the iteration.

    Returns
    -------
    NewtonResult
        Result of the iteration.

    Raises
    ------
    ValueError
        If torque or piston force is not positive.
    """
    T, P_T = positive("torque", torque, "N m"), positive("piston_force", piston_force, "N")
    unit = T / levers.drum_radius
    in_radii = levers.in_radii
    force, used = (unit, in_radii) if scaled else (1.0, levers)

    def equations(x: np.ndarray) -> np.ndarray:
        return equilibrium_equations(used, unit / force * used.drum_radius, P_T / force, x)

    def residual(x: np.ndarray) -> float:
        in_units = equilibrium_equations(in_radii, 1.0, P_T / unit, x * force / unit)
        return float(np.max(np.abs(in_units)))

    x = np.array(SCALED_START if start is None else start, dtype=float) * unit / force
    k, size = 0, residual(x)
    with np.errstate(all="ignore"):
        while k < steps and _TOLERANCE < size < _DIVERGED:
            try:
                step = np.linalg.solve(_jacobian(used, x), -equations(x))
            except np.linalg.LinAlgError:
                break
            if not np.isfinite(step).all():
                break
            cut = 1.0
            while damped and cut > 1e-6 and not residual(x + cut * step) < size:
                cut /= 2
            x, k = x + cut * step, k + 1
            size = residual(x)
        jacobian, forces = _jacobian(used, x), x * force
    Ax, Ay, Bx, By, Cx, Cy, Dx, Dy = forces[:8]
    converged = bool(size <= _TOLERANCE)
    return NewtonResult(
        unknowns=forces,
        converged=converged,
        physical=bool(converged and Ax * By - Ay * Bx < 0 and Cx * Dy - Cy * Dx < 0),
        iterations=k,
        residual=size,
        condition_number=float(np.linalg.cond(jacobian)) if np.isfinite(jacobian).all() else np.inf,
    )
