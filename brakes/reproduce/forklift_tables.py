"""Report on the forklift of Yoo et al. (1997): Tables 2-7, corrected numbers, consequences of errors."""

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
from brakes.reproduce.forklift_as_printed import BRAKE, FORCES, VEHICLE, newton_raphson

PAPER = load("yoo_1997")
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
    """Compare Tables 2-7 with numbers by the paper's own method, and Tables 2-4 also with corrected ones."""
    ours, right = as_printed.tables(), as_printed.corrected_tables()
    return {name: _table(name, ours, right) for name in (*VEHICLE, *BRAKE)}


def _table(name: str, ours: as_printed.Tables, right: as_printed.Tables) -> PrintedTable:
    """Compare one table with the numbers of the paper's method, and with the corrected ones, if any."""
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


def summary() -> list[str]:
    """Return the conclusions for a brake engineer, one paragraph each."""
    printed, right = _stops()
    high, low = float(printed.torque_per_brake), float(right.torque_per_brake)
    short, long = float(printed.distance), float(right.distance)
    percents = {"torque_high": 100 * (high / low - 1), "longer": 100 * (long / short - 1)}
    return [PAPER["summary"].format(high=high, low=low, short=short, long=long, **percents)]


def notes() -> list[str]:
    """Return the notes on the tables, ordered by note number."""
    compared, misfit, forces = tables(), PAPER["misfit"][0], as_printed.base_forces()
    every = [cell for name in VEHICLE for cell in compared[name].cells]
    right = internal_forces(
        forces.levers, torque=_stops()[1].torque_per_brake, piston_force=_INPUT["piston_force"]
    )
    followed, motion = _follow(), BENDIX_12_5.move_shoes(_INPUT["clearance"])
    stages = followed.right, followed.left, followed.drum
    full = all(int(stage.rank.min()) == stage.constraints for stage in stages)
    case = {"torque": _INPUT["torque"], "piston_force": _INPUT["piston_force"]}
    scaled, plain = (newton_raphson(forces.levers, **case, scaled=scaled) for scaled in (True, False))
    numbers = {
        **{name: misfit[name] for name in ("where", "printed", "ours")},
        "agreeing": sum(cell.agrees for cell in every),
        "compared": len(every),
        "friction": float(forces.lining_friction),
        "right_friction": float(right.lining_friction),
        "locking": float(forces.locking_friction),
        "share": 100 * float(forces.leading_share),
        "c_star": float(forces.c_star),
        "bolts": float(np.hypot(*forces.bolt_force)) / 1e3,
        "turn": np.degrees(float(motion.seating_turn)),
        "psi": np.degrees(float(motion.drum_turn)),
        "rows": "no redundant row" if full else "redundant rows",
        "penetration": 1e3 * float(motion.lining_penetration),
        "angle": np.degrees(float(motion.penetration_angle)),
        "same": "the same" if abs(scaled.unknowns[8] / float(forces.Q) - 1) < 1e-9 else "other",
        "steps": scaled.iterations,
        "plain": plain.condition_number,
        "scaled": scaled.condition_number,
    }
    return [note.format(**numbers) for note in PAPER["notes"]]


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
