"""Report on the forklift of Yoo et al. (1997): Tables 2-7, the right numbers, and what the errors cost."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import Group

from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.drawing.sheet import Paper
from brakes.drawings.duo_servo import free_bodies, positions
from brakes.drawings.forklift import distances, forces_over, truck
from brakes.forklift import BENDIX_12_5, InternalForces, Stop, follow_shoes, internal_forces, stop
from brakes.published import load
from brakes.reproduce import forklift_as_printed as as_printed
from brakes.reproduce.common import Cell, Heads, Row, errata_table, rows_table, step
from brakes.reproduce.newton import newton_raphson

# Table: inputs of its rows and of its columns as (key, heading, scale), and its quantities.
_VEHICLE: dict[str, tuple[tuple[str, str], tuple[str, str], tuple[str, ...]]] = {
    "table_2": (("friction", "friction"), ("speed", "V [km/h]"), ("distance",)),
    "table_3": (("slope", "slope [rad]"), ("load_mass", "load [kg]"), ("distance", "acceleration")),
    "table_4": (("empty_mass", "m [kg]"), ("front_wheel_radius", "r1 [m]"), ("distance", "torque")),
}
_BRAKE = {
    "table_5": ("torque", "T [N m]"),
    "table_6": ("piston_force", "P_T [N]"),
    "table_7": ("clearance", "c_L [m]"),
}
_AXES = {
    "table_5": ("torque $T$ [N m]", 1.0),
    "table_6": ("piston force $P_T$ [N]", 1.0),
    "table_7": ("clearance $c_L$ [mm]", 1e-3),
}
_HEADS = {"distance": "s [m]", "acceleration": "A [m/s2]", "torque": "T [N m]"}
_WORDS = {
    "distance": "stopping distance s",
    "acceleration": "acceleration A",
    "torque": "torque of one brake T",
}
_FORCES = ("A", "B", "Q", "P_L")
_WAYS = ("as printed", "corrected")


def title() -> str:
    """Title and authors of the paper."""
    paper = load("yoo_1997")
    return f"{paper['title']}\n{', '.join(paper['authors'])}, {paper['journal']}, {paper['year']}"


def introduction() -> str:
    """What is computed, in one paragraph."""
    return (
        "A loaded truck reverses down a slope and stops with locked front wheels; one of its two front "
        'brakes is a duo-servo brake of 12.5 in. "ours" follows the paper (Tables 2-4 with an arm y_cg - r1 '
        'and a factor 0.97 on the slope\'s pull, which it does not mention), "corrected" is the right '
        "mechanics. Tables 5-7 rest on pin positions fitted to them: the paper prints none. Base case: "
        "5950 kg with a load of 3500 kg, 0.3019 rad (17.3 deg), 20 km/h, friction 0.7 on the ground, "
        "front wheels of 0.40 m radius."
    )


def rows() -> dict[str, list[Row]]:
    """Compare Tables 2-7 cell by cell."""
    ours, right, paper = as_printed.tables(), as_printed.corrected_tables(), load("yoo_1997")
    compared = {name: _vehicle_rows(paper, name, ours, right) for name in _VEHICLE}
    return compared | {name: _force_rows(paper, name, ours) for name in _BRAKE}


def heads() -> dict[str, Heads]:
    """Names with units of the inputs and of the quantities of each table's rows."""
    vehicle = {
        name: ((down, across), tuple(_HEADS[q] for q in quantities))
        for name, ((_, down), (_, across), quantities) in _VEHICLE.items()
    }
    return vehicle | {
        name: ((head,), tuple(f"{f} [N]" for f in _FORCES)) for name, (_, head) in _BRAKE.items()
    }


def _vehicle_rows(paper: dict[str, Any], name: str, ours: dict, right: dict) -> list[Row]:
    (down, _), (across, _), quantities = _VEHICLE[name]
    data = paper[name]
    padded = data.get("padded", {"value": [], "digits": None})
    compared = []
    for i, row in enumerate(data[down]["value"]):
        for j, column in enumerate(data[across]["value"]):
            cells = []
            for quantity in quantities:
                printed, key = data[quantity]["printed"][i][j], (name, quantity)
                digits = padded["digits"] if printed in padded["value"] else None
                reason = _reason(paper, name, quantity, printed)
                cells.append(
                    Cell(
                        printed,
                        float(ours[key][i, j]),
                        step(printed, digits),
                        reason,
                        float(right[key][i, j]),
                    )
                )
            compared.append(Row((f"{row:g}", f"{column:g}"), tuple(cells)))
    return compared


def _reason(paper: dict[str, Any], name: str, quantity: str, printed: str) -> str:
    """Why a cell is known to differ, if it is the misfit that the published data name."""
    known = paper["misfit"][0]
    there = known["where"].startswith(f"Table {name[-1]}, {quantity}") and known["printed"] == printed
    return "the one misfit (1)" if there else ""


def _force_rows(paper: dict[str, Any], name: str, ours: dict) -> list[Row]:
    data, (varied, _) = paper[name], _BRAKE[name]
    compared = []
    for i, value in enumerate(data[varied]["value"]):
        cells = []
        for force in _FORCES:
            steps = data[force]["step"]
            size = steps[i] if isinstance(steps, list) else steps
            cells.append(Cell(data[force]["printed"][i], float(ours[name, force][i]), size))
        compared.append(Row((f"{value:g}",), tuple(cells)))
    return compared


def tables() -> Iterator[Group]:
    """Make Tables 2-7 and the table of errata."""
    paper, compared = load("yoo_1997"), rows()
    for name, (_, _, quantities) in _VEHICLE.items():
        yield rows_table(_title(paper, name, quantities), *heads()[name], compared[name])
    for name, (_, head) in _BRAKE.items():
        yield rows_table(_title(paper, name, ("forces [N]",)), (head,), _FORCES, compared[name])
    yield errata_table("What is wrong in the paper, and what follows at its base case", as_printed.errata())


def _title(paper: dict[str, Any], name: str, what: tuple[str, ...]) -> str:
    fixed = paper[name]["fixed"].replace("clearance 0.0106", "clearance 0.0106 m")
    return f"Table {name[-1]}: {', '.join(_WORDS.get(w, w) for w in what)}; {fixed}"


def summary() -> Iterator[str]:
    """What follows for a brake engineer, a paragraph each."""
    printed, right = _base_stops()
    high, low = float(printed.torque_per_brake), float(right.torque_per_brake)
    short, long = float(printed.distance), float(right.distance)
    yield (
        f"The paper's errors make the torque {100 * (high / low - 1):.0f} % too high ({high:.0f} in place of "
        f"{low:.0f} N m), which is safe for strength. They make the stopping distance too short: "
        f"{short:.2f} m where the truck needs {long:.2f} m, {100 * (long / short - 1):.0f} % more, "
        "which is not safe. Unladen on this slope, where Table 3 has 120.5 m, the truck does not stop at all."
    )


def notes() -> Iterator[str]:
    """Remarks below the tables."""
    every = [cell for name in _VEHICLE for row in rows()[name] for cell in row.cells]
    misfit, agree = load("yoo_1997")["misfit"][0], sum(cell.agrees for cell in every)
    yield (
        f"(1) {agree} of {len(every)} numbers of Tables 2-4 agree to their digits. {misfit['where']}: "
        f"printed {misfit['printed']}, ours {misfit['ours']}, which rounds to 10.0; why is not known."
    )
    forces = base_forces()
    yield _on_friction(forces)
    yield _on_motion()
    yield _on_newton(forces)


def _on_friction(forces: InternalForces) -> str:
    needed = stop(*as_printed.base_case()).torque_per_brake
    right = internal_forces(forces.levers, torque=needed, piston_force=_base("piston_force"))
    return (
        "The friction of the lining is a result of the paper's equations, which it does not show: "
        f"{float(forces.lining_friction):.3g} at 11000 N m ({float(right.lining_friction):.3g} at the "
        "corrected torque). With less, this piston force does not lock the wheels; the brake locks by "
        f"itself at {float(forces.locking_friction):.3g}. The leading shoe does "
        f"{100 * float(forces.leading_share):.0f} % of the work, C* = {float(forces.c_star):.3g}, and the "
        f"cylinder's bolts carry {float(np.hypot(*forces.bolt_force)) / 1e3:.0f} kN."
    )


def _on_motion() -> str:
    clearance = _base("clearance")
    followed, motion = follow_shoes(BENDIX_12_5, clearance), BENDIX_12_5.move_shoes(clearance)
    stages = followed.right, followed.left, followed.drum
    full = all(int(stage.rank.min()) == stage.constraints for stage in stages)
    turn, psi = np.degrees(float(motion.seating_turn)), np.degrees(float(motion.drum_turn))
    return (
        f"On the way the shoes turn {turn:.2f} deg until the linings touch, then with the drum by "
        f"{psi:.2f} deg; the constraints have {'no redundant row' if full else 'redundant rows'} on the "
        "way. With these pins a lining concentric at rest would enter the drum by "
        f"{1e3 * float(motion.lining_penetration):.2f} mm near "
        f"{np.degrees(float(motion.penetration_angle)):.0f} deg: unless it is ground to fit, it touches "
        "there first."
    )


def _on_newton(forces: InternalForces) -> str:
    case = {"torque": _base("torque"), "piston_force": _base("piston_force")}
    scaled = newton_raphson(forces.levers, **case)
    plain = newton_raphson(forces.levers, **case, scaled=False)
    same = abs(scaled.unknowns[8] / float(forces.Q) - 1) < 1e-9
    return (
        f"The paper's Newton-Raphson on ten equations ends at {'the same' if same else 'other'} forces in "
        f"{scaled.iterations} steps from a good start; from most starts it does not. In SI units the "
        f"condition number is {plain.condition_number:.1e}, in units of T/r and r "
        f"{scaled.condition_number:.0f}. Our reduction to one equation needs no start."
    )


def _base_stops(**varied: Any) -> tuple[Stop, Stop]:
    """Solve the stop at the base case, as printed and corrected, with some inputs varied."""
    case = as_printed.base_case(**varied)
    return as_printed.stop_as_printed(*case), stop(*case)


def base_forces() -> InternalForces:
    """Solve the forces at the base case of Tables 5-7."""
    return internal_forces(
        BENDIX_12_5, **{name: _base(name) for name in ("torque", "piston_force", "clearance")}
    )


def _base(name: str) -> Any:
    return load("yoo_1997")["input"][name]["value"]


# Pictures -----------------------------------------------------------------------------------------------


def pictures() -> dict[str, Figure]:
    """Draw the pictures, by the names of their files."""
    return {
        "forklift_truck": _truck(),
        "forklift_distance": _distance(),
        "forklift_stages": _stages(),
        "forklift_shoes": _shoes(),
        "forklift_forces": _over(),
    }


def _truck() -> Figure:
    drawn = [(name, truck(shown)) for name, shown in zip(_WAYS, _base_stops(), strict=True)]
    both = [replace(drawing, title=f"{name}\n{drawing.title}") for name, drawing in drawn]
    return figure_of([both], Paper.of([both], 860.0))


def _distance() -> Figure:
    figure = Figure(figsize=(10.0, 4.8), layout="constrained")
    speeds, slopes = np.linspace(5, 25, 81) / 3.6, np.radians([0.0, 5.0, 10.0, 15.0, 17.3, 20.0, 26.0])
    panels, top = figure.subplots(1, 2, sharey=True), 0.0
    stops = _base_stops(slope=slopes[:, None], speed=3.6 * speeds)
    for ax, name, distance in zip(panels, _WAYS, (s.distance for s in stops), strict=True):
        distances(ax, speeds, slopes, distance)
        top = max(top, float(distance[np.isfinite(distance)].max()))
        ax.set_title(name, fontsize=11)
    panels[1].set_ylabel("")
    panels[0].set_ylim(0, 1.05 * top)
    return figure


def _stages() -> Figure:
    return figure_of([positions(follow_shoes(BENDIX_12_5, _base("clearance")))], Paper(790.0, (330.0,)))


def _shoes() -> Figure:
    return figure_of([free_bodies(base_forces(), follow_shoes(BENDIX_12_5, _base("clearance")))])


def _over() -> Figure:
    """Draw the forces over torque, piston force and clearance, with the printed values as circles."""
    figure = Figure(figsize=(12.0, 4.6), layout="constrained")
    paper = load("yoo_1997")
    case = {name: _base(name) for name in ("torque", "piston_force", "clearance")}
    for ax, (name, (varied, _)) in zip(figure.subplots(1, 3, sharey=True), _BRAKE.items(), strict=True):
        data = paper[name]
        given, (label, unit) = np.array(data[varied]["value"]), _AXES[name]
        x = np.linspace(given.min(), given.max(), 101)
        marks = [(f, given / unit, np.array(data[f]["printed"], dtype=float)) for f in _FORCES]
        forces_over(ax, x / unit, internal_forces(BENDIX_12_5, **(case | {varied: x})), label, marks)
        ax.set_title(f"Table {name[-1]} (circles: printed)", fontsize=11)
    for ax in figure.axes[1:]:
        ax.set_ylabel("")
    return figure
