"""Report on the forklift of Yoo et al. (1997): Tables 2-7, right numbers, and consequences of the errors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import Group

from beamdyn.common.drawing.layout import Paper
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.results.published import values_alone
from brakes.drawings.duo_servo import free_bodies, positions
from brakes.drawings.forklift import distances, forces_over, truck
from brakes.forklift import BENDIX_12_5, Stop, follow_shoes, internal_forces, stop
from brakes.published import load
from brakes.reproduce import forklift_as_printed as as_printed
from brakes.reproduce.common import Cell, PrintedTable, errata_table, step
from brakes.reproduce.forklift_as_printed import BRAKE, FORCES, VEHICLE
from brakes.reproduce.newton import newton_raphson

PAPER = load("yoo_1997")
INTRODUCTION = (
    "A loaded truck reverses down a slope and stops with locked front wheels; one of its two front brakes is "
    'a duo-servo brake of 12.5 in. "ours" follows the paper (Tables 2-4 with an arm y_cg - r1 and a factor '
    '0.97 on the slope\'s pull, which it does not mention), "corrected" is the right mechanics. Tables 5-7 '
    "rest on pin positions fitted to them: the paper prints none. Base case: 5950 kg with a load of 3500 kg, "
    "0.3019 rad (17.3 deg), 20 km/h, friction 0.7 on the ground, front wheels of 0.40 m radius."
)
_INPUT = values_alone(PAPER["input"])
_HEADS = {  # headings of the tables, by input or quantity
    "friction": "friction",
    "speed": "V [km/h]",
    "slope": "slope [rad]",
    "load_mass": "load [kg]",
    "empty_mass": "m [kg]",
    "front_wheel_radius": "r1 [m]",
    "torque": "T [N m]",
    "piston_force": "P_T [N]",
    "clearance": "c_L [m]",
    "distance": "s [m]",
    "acceleration": "A [m/s2]",
}
_WORDS = {
    "distance": "stopping distance s",
    "acceleration": "acceleration A",
    "torque": "torque of one brake T",
}


def tables() -> dict[str, PrintedTable]:
    """Compare Tables 2-7 with our numbers, and Tables 2-4 also with the right numbers."""
    ours, right = as_printed.tables(), as_printed.corrected_tables()
    return {name: _table(name, ours, right) for name in (*VEHICLE, *BRAKE)}


def _table(name: str, ours: as_printed.Tables, right: as_printed.Tables) -> PrintedTable:
    """Compare one table of the paper with the numbers of its own method, and with the right ones, if any."""
    data, misfit, number = PAPER[name], PAPER["misfit"][0], name[-1]
    inputs, quantities = as_printed.inputs_of(name), as_printed.quantities_of(name)
    padded = data.get("padded", {"value": [], "digits": None})
    rows: list[tuple[tuple[str, ...], list[Cell]]] = []
    for place in np.ndindex(*(len(values) for values in inputs.values())):
        cells = []
        for quantity in quantities:
            printed, computed = str(np.array(data[quantity]["printed"])[place]), ours[name, quantity]
            digits = padded["digits"] if printed in padded["value"] else None
            unit = np.broadcast_to(data[quantity].get("step", step(printed, digits)), computed.shape)[place]
            there = misfit["where"].startswith(f"Table {number}, {quantity}") and misfit["printed"] == printed
            reason, corrected = "the one misfit (1)" if there else "", right.get((name, quantity))
            true = None if corrected is None else float(corrected[place])
            cells.append(Cell(printed, float(computed[place]), float(unit), reason, true))
        given = zip(inputs.values(), place, strict=True)
        rows.append((tuple(f"{values[i]:g}" for values, i in given), cells))
    fixed = data["fixed"].replace("clearance 0.0106", "clearance 0.0106 m")
    what = ", ".join(_WORDS[quantity] for quantity in quantities) if name in VEHICLE else "forces [N]"
    return PrintedTable(
        f"Table {number}: {what}; {fixed}",
        tuple(_HEADS[key] for key in inputs),
        tuple(_HEADS.get(key, key) for key in quantities),
        rows,
        "" if name in VEHICLE else "N",
    )


def shown() -> Iterator[Group]:
    """Make Tables 2-7 and the table of errata."""
    for table in tables().values():
        yield table.shown()
    yield errata_table("What is wrong in the paper, and what follows at its base case", as_printed.errata())


def summary() -> Iterator[str]:
    """Yield the conclusions for a brake engineer, one paragraph each."""
    printed, right = _stops()
    high, low = float(printed.torque_per_brake), float(right.torque_per_brake)
    short, long = float(printed.distance), float(right.distance)
    yield (
        f"The paper's errors make the torque {100 * (high / low - 1):.0f} % too high ({high:.0f} in place of "
        f"{low:.0f} N m), which is safe for strength. They make the stopping distance too short: "
        f"{short:.2f} m where the truck needs {long:.2f} m, {100 * (long / short - 1):.0f} % more, "
        "which is not safe. Unladen on this slope, where Table 3 has 120.5 m, the truck does not stop at all."
    )


def notes() -> Iterator[str]:
    """Yield the remarks below the tables: misfit, lining friction, motion of the shoes, Newton-Raphson."""
    compared, misfit, forces = tables(), PAPER["misfit"][0], as_printed.base_forces()
    every = [cell for name in VEHICLE for cell in compared[name].cells]
    yield (
        f"(1) {sum(cell.agrees for cell in every)} of {len(every)} numbers of Tables 2-4 agree to their "
        f"digits. {misfit['where']}: printed {misfit['printed']}, ours {misfit['ours']}, which rounds to "
        "10.0; why is not known."
    )
    needed = _stops()[1].torque_per_brake
    right = internal_forces(forces.levers, torque=needed, piston_force=_INPUT["piston_force"])
    yield (
        "The friction of the lining is a result of the paper's equations, which it does not show: "
        f"{float(forces.lining_friction):.3g} at 11000 N m ({float(right.lining_friction):.3g} at the "
        "corrected torque). With less, this piston force does not lock the wheels; the brake locks by "
        f"itself at {float(forces.locking_friction):.3g}. The leading shoe does "
        f"{100 * float(forces.leading_share):.0f} % of the work, C* = {float(forces.c_star):.3g}, and the "
        f"cylinder's bolts carry {float(np.hypot(*forces.bolt_force)) / 1e3:.0f} kN."
    )
    followed, motion = _follow(), BENDIX_12_5.move_shoes(_INPUT["clearance"])
    stages = followed.right, followed.left, followed.drum
    full = all(int(stage.rank.min()) == stage.constraints for stage in stages)
    turn, psi = np.degrees(float(motion.seating_turn)), np.degrees(float(motion.drum_turn))
    yield (
        f"On the way the shoes turn {turn:.2f} deg until the linings touch, then with the drum by "
        f"{psi:.2f} deg; the constraints have {'no redundant row' if full else 'redundant rows'} on the "
        "way. With these pins a lining concentric at rest would enter the drum by "
        f"{1e3 * float(motion.lining_penetration):.2f} mm near "
        f"{np.degrees(float(motion.penetration_angle)):.0f} deg: unless it is ground to fit, it touches "
        "there first."
    )
    case = {"torque": _INPUT["torque"], "piston_force": _INPUT["piston_force"]}
    scaled, plain = (newton_raphson(forces.levers, **case, scaled=scaled) for scaled in (True, False))
    same = abs(scaled.unknowns[8] / float(forces.Q) - 1) < 1e-9
    yield (
        f"The paper's Newton-Raphson on ten equations ends at {'the same' if same else 'other'} forces in "
        f"{scaled.iterations} steps from a good start; from most starts it does not. In SI units the "
        f"condition number is {plain.condition_number:.1e}, in units of T/r and r "
        f"{scaled.condition_number:.0f}. Our reduction to one equation needs no start."
    )


def _stops(**varied: Any) -> tuple[Stop, Stop]:
    """Solve the stop of the base case, as printed and corrected, with some inputs varied."""
    case = as_printed.base_case(**varied)
    return as_printed.stop_as_printed(*case), stop(*case)


def _follow() -> Any:
    """Follow the motion of the shoes at the clearance of the base case."""
    return follow_shoes(BENDIX_12_5, _INPUT["clearance"])


# Pictures -----------------------------------------------------------------------------------------------

_WAYS = ("as printed", "corrected")


def _truck() -> Figure:
    drawn = [(name, truck(found)) for name, found in zip(_WAYS, _stops(), strict=True)]
    both = [replace(drawing, title=f"{name}\n{drawing.title}") for name, drawing in drawn]
    return figure_of([both], Paper.of([both], 860.0))


def _distance() -> Figure:
    """Draw the stopping distance over speed on several slopes, as printed and corrected."""
    figure = Figure(figsize=(10.0, 4.8), layout="constrained")
    speeds, slopes = np.linspace(5, 25, 81) / 3.6, np.radians([0.0, 5.0, 10.0, 15.0, 17.3, 20.0, 26.0])
    panels, top = figure.subplots(1, 2, sharey=True), 0.0
    stops = _stops(slope=slopes[:, None], speed=3.6 * speeds)
    for ax, name, distance in zip(panels, _WAYS, (s.distance for s in stops), strict=True):
        distances(ax, speeds, slopes, distance)
        top = max(top, float(distance[np.isfinite(distance)].max()))
        ax.set_title(name, fontsize=11)
    panels[1].set_ylabel("")
    panels[0].set_ylim(0, 1.05 * top)
    return figure


def _forces() -> Figure:
    """Draw the forces over torque, piston force and clearance, with the printed values as circles."""
    figure = Figure(figsize=(12.0, 4.6), layout="constrained")
    labels = ("torque $T$ [N m]", 1.0), ("piston force $P_T$ [N]", 1.0), ("clearance $c_L$ [mm]", 1e-3)
    panels = figure.subplots(1, 3, sharey=True)
    for ax, name, (label, unit) in zip(panels, BRAKE, labels, strict=True):
        ((varied, given),) = as_printed.inputs_of(name).items()
        x = np.linspace(given.min(), given.max(), 101)
        marks = [(f, given / unit, np.array(PAPER[name][f]["printed"], dtype=float)) for f in FORCES]
        forces_over(ax, x / unit, as_printed.base_forces(**{varied: x}), label, marks)
        ax.set_title(f"Table {name[-1]} (circles: printed)", fontsize=11)
    for ax in panels[1:]:
        ax.set_ylabel("")
    return figure


PICTURES = {
    "forklift_truck": _truck,
    "forklift_distance": _distance,
    "forklift_stages": lambda: figure_of([positions(_follow())], Paper(790.0, (330.0,))),
    "forklift_shoes": lambda: figure_of([free_bodies(as_printed.base_forces(), _follow())]),
    "forklift_forces": _forces,
}
