"""Results of drum and forklift brakes as people read them: their numbers with units, and tables of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import inf, pi
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import Group

from beamdyn.common.edge.input_sweep import InputSweep, Output, columns, sweep_rows
from beamdyn.common.edge.tables import table

if TYPE_CHECKING:
    from brakes.config.forklift import ForkliftAnswer
    from brakes.drum import BrakeResult
    from brakes.forklift import Kinematics, ShoeMotion, Stop

_MM, _KN, _MPA, _DEG = 1e-3, 1e3, 1e6, pi / 180
_SHOWN = 24  # rows of a sweep


def _size(vector: np.ndarray) -> np.ndarray:
    return np.hypot(vector[..., 0], vector[..., 1])


# Drum brake ---------------------------------------------------------------------------------------------

BRAKE = (
    Output("torque", "torque of the brake", lambda r: r.torque, "N m"),
    Output("c_star", "brake factor C* = torque / (force radius)", lambda r: r.c_star),
    Output("c_star_slope", "dC*/dmu", lambda r: r.c_star_slope),
    Output("force", "force on each shoe", lambda r: r.force, "N"),
    Output("peak_pressure", "largest pressure on a lining", lambda r: r.peak_pressure, "MPa", _MPA),
    Output("locking_friction", "friction at self-locking", lambda r: r.locking_friction),
    Output("margin", "margin to self-locking, 1 - mu / locking mu", lambda r: r.margin),
)

SHOE = (
    Output("torque", "torque", lambda s: s.torque, "N m"),
    Output("c_star", "shoe factor C*", lambda s: s.c_star),
    Output("c_star_slope", "dC*/dmu", lambda s: s.c_star_slope),
    Output("peak_pressure", "largest pressure", lambda s: s.peak_pressure, "MPa", _MPA),
    Output("normal", "resultant of the pressure N", lambda s: _size(s.normal), "N"),
    Output("tangential", "resultant of the friction T", lambda s: _size(s.tangential), "N"),
    Output("pin", "pin reaction R", lambda s: _size(s.pin_reaction), "N"),
    Output("pin_x", "pin reaction, towards the shoe's side", lambda s: s.pin_reaction[..., 0], "N"),
    Output("pin_y", "pin reaction, upward", lambda s: s.pin_reaction[..., 1], "N"),
    Output("effective_arm", "effective arm of the friction", lambda s: s.effective_arm, "mm", _MM),
    Output("locking_friction", "friction at self-locking", lambda s: s.locking_friction),
    Output("closure", "moment left over / (P (a + c))", lambda s: s.closure),
)


def drum_outputs(shoes: int = 2) -> tuple[Output, ...]:
    """All results of a drum brake; those of a shoe end in its number."""
    return (*BRAKE, *(_of_shoe(i, output) for i in range(shoes) for output in SHOE))


def _of_shoe(i: int, o: Output) -> Output:
    words = f"{o.words}, shoe {i + 1}"
    return Output(f"{o.name}_{i + 1}", words, lambda r: o.of(r.shoes[i]), o.unit, o.scale)


def drum_tables(found: BrakeResult) -> Group:
    """The tables of a drum brake: as a whole, and shoe by shoe."""
    direction = "reverse" if found.reverse else "forward"
    title = f"Drum brake, {direction}, friction {found.friction:g}"
    names = [f"shoe {i}, {'leading' if s.leading else 'trailing'}" for i, s in enumerate(found.shoes, 1)]
    shoes = table(
        "Shoes (components: x to the shoe's side, y upward)",
        ("", *names, "unit"),
        ([o.words, *(number(o.shown(s)) for s in found.shoes), o.unit] for o in SHOE),
        (0, len(names) + 1),
    )
    return Group(_column(title, BRAKE, found), shoes)


# Forklift -----------------------------------------------------------------------------------------------

VEHICLE = (
    Output("distance", "stopping distance, from the driver's reaction", lambda s: s.distance, "m"),
    Output("time", "time to rest", lambda s: s.time, "s"),
    Output("acceleration", "acceleration, wheels locked", lambda s: s.acceleration, "m/s2"),
    Output("torque_per_brake", "torque of one brake", lambda s: s.torque_per_brake, "N m"),
    Output("reaction_distance", "distance in the reaction time", lambda s: s.reaction_distance, "m"),
    Output("rise_distance", "distance while the force rises", lambda s: s.rise_distance, "m"),
    Output("braking_distance", "distance with the full force", lambda s: s.braking_distance, "m"),
    Output("speed_lost_in_rise", "speed lost while the force rises", lambda s: s.speed_lost_in_rise, "m/s"),
    Output(
        "speed_gained_coasting",
        "speed a coasting truck would gain in reaction, not counted",
        lambda s: s.speed_gained_coasting,
        "m/s",
    ),
    Output("front_load", "front axle's load, sliding", lambda s: s.front_load, "kN", _KN),
    Output("rear_load", "rear axle's load, sliding", lambda s: s.rear_load, "kN", _KN),
    Output("standing_front_load", "front axle's load, at rest", lambda s: s.standing_front_load, "kN", _KN),
    Output("standing_rear_load", "rear axle's load, at rest", lambda s: s.standing_rear_load, "kN", _KN),
)

MOTION = (
    Output("seating_turn", "stage 1: turn of each shoe", lambda m: m.seating_turn, "deg", _DEG),
    Output("seating_travel", "stage 1: travel of each piston", lambda m: m.seating_travel, "mm", _MM),
    Output("drum_turn", "stage 2: turn of drum and shoes", lambda m: m.drum_turn, "deg", _DEG),
    Output("right_travel", "right piston at the end, outward", lambda m: m.right_travel, "mm", _MM),
    Output("left_travel", "left piston at the end, outward", lambda m: m.left_travel, "mm", _MM),
    Output("tip_gap", "least gap of the shoe's tip to the drum", lambda m: m.tip_gap, "mm", _MM),
    Output(
        "lining_penetration",
        "a concentric lining enters the drum by",
        lambda m: m.lining_penetration,
        "mm",
        _MM,
    ),
    Output("penetration_angle", "... at, up from the horizontal", lambda m: m.penetration_angle, "deg", _DEG),
)

ARMS = (
    Output("a1", "arm of P_L", lambda v: v.a1, "mm", _MM),
    Output("a2", "arm of P_T", lambda v: v.a2, "mm", _MM),
    Output("b", "arm of Q", lambda v: v.b1, "mm", _MM),
    Output("alpha1", "angle of P_L", lambda v: v.alpha1, "deg", _DEG),
    Output("alpha2", "angle of P_T", lambda v: v.alpha2, "deg", _DEG),
    Output("gamma", "angle of Q", lambda v: v.gamma, "deg", _DEG),
)

FORCES = (
    Output("torque", "torque of the brake T", lambda f: f.torque, "N m"),
    Output("piston_force", "piston on the trailing shoe P_T", lambda f: f.piston_force, "N"),
    Output("A", "leading shoe: drum's normal force A", lambda f: f.A, "N"),
    Output("B", "leading shoe: friction force B", lambda f: f.B, "N"),
    Output("C", "trailing shoe: drum's normal force C", lambda f: f.C, "N"),
    Output("D", "trailing shoe: friction force D", lambda f: f.D, "N"),
    Output("Q", "adjuster Q", lambda f: f.Q, "N"),
    Output("P_L", "leading shoe on its piston P_L", lambda f: f.P_L, "N"),
    Output("lining_friction", "friction of the lining, B/A = D/C", lambda f: f.lining_friction),
    Output("locking_friction", "friction at self-locking", lambda f: f.locking_friction),
    Output("margin", "margin to self-locking", lambda f: f.margin),
    Output("c_star", "brake factor C* = T / (P_T r)", lambda f: f.c_star),
    Output("c_star_slope", "dC*/dmu", lambda f: f.c_star_slope),
    Output("leading_share", "share of the leading shoe in the torque", lambda f: f.leading_share),
    Output("trailing_share", "share of the trailing shoe", lambda f: f.trailing_share),
    Output(
        "bolt_x", "cylinder bolts, horizontal, + to the leading shoe", lambda f: f.bolt_force[..., 0], "N"
    ),
    Output("bolt_y", "cylinder bolts, vertical, + up", lambda f: f.bolt_force[..., 1], "N"),
    Output("bolts", "cylinder bolts, resultant", lambda f: _size(f.bolt_force), "N"),
    Output("residual", "left over in the equations, over T/r", lambda f: f.residual),
)


def forklift_outputs(stages: Sequence[str]) -> tuple[Output, ...]:
    """All results of the stages."""
    groups = {
        "vehicle": [_within("stop", o) for o in VEHICLE],
        "kinematics": [_within("motion", o) for o in MOTION],
        "forces": [_within("forces", o) for o in FORCES],
    }
    return tuple(output for stage in stages for output in groups[stage])


def _within(part: str, o: Output) -> Output:
    return Output(o.name, o.words, lambda answer: o.of(getattr(answer, part)), o.unit, o.scale)


def vehicle_table(stops: Sequence[Stop]) -> Group:
    """The table of a stop, or of the same by several models, side by side."""
    heads = [s.model.replace("_", " ") for s in stops]
    rows = [["", *(str(s.status) for s in stops), ""]]
    rows += [[o.words, *(number(o.shown(s)) for s in stops), o.unit] for o in VEHICLE]
    return table("Vehicle", ("", *heads, "unit"), rows, (0, len(heads) + 1))


def kinematics_tables(motion: ShoeMotion, followed: Kinematics) -> Group:
    """The table of the shoes' motion, and its events."""
    events = table(
        "Events (rank and smallest singular value: of the mechanism's constraints, least on the way)",
        ("stage", "event", "rank", "smallest singular value"),
        [
            [
                str(e.stage),
                e.message,
                f"{s.rank.min()} of {s.constraints}",
                f"{s.least_singular_value.min():.2g}",
            ]
            for e, s in zip(followed.events, (followed.right, followed.left, followed.drum), strict=True)
        ],
        (0, 1),
    )
    return Group(_column("Kinematics of one brake", MOTION, motion), events)


def forces_table(answers: Sequence[ForkliftAnswer], heads: Sequence[str]) -> Group:
    """The table of the forces in one brake, by several models side by side."""
    found = [a.forces for a in answers if a.forces is not None]
    rows = [[o.words, *(number(o.shown(f)) for f in found), o.unit] for o in FORCES]
    rows += [[]]
    rows += [[o.words, *(number(o.shown(f.levers)) for f in found), o.unit] for o in ARMS]
    title = f"Forces in one brake; the torque is from {answers[0].torque_from}"
    return table(title, ("", *(heads if len(found) > 1 else ["value"]), "unit"), rows, (0, len(found) + 1))


# Sweeps -------------------------------------------------------------------------------------------------


def sweep_table(found: InputSweep) -> Group:
    """The table of a sweep: some of its rows, if there are many."""
    rows = [*sweep_rows(found)]
    shown = np.unique(np.linspace(0, len(rows) - 1, min(len(rows), _SHOWN)).round().astype(int))
    part = "" if len(shown) == len(rows) else f" ({len(shown)} of {len(rows)} rows; CSV and JSON have all)"
    heads = [f"{n} [{u}]" if u else n for n, u in columns(found)]
    cells = ([number(value) for value in rows[i]] for i in shown)
    return table(f"{', '.join(found.results)} over {' and '.join(found.inputs)}{part}", heads, cells, ())


# Numbers ------------------------------------------------------------------------------------------------


def outputs_csv(outputs: Iterable[Output], **results: Any) -> Iterator[Sequence[object]]:
    """Rows of the CSV file of one case, or of a few under their names: name, values, unit."""
    yield "result", *results, "unit"
    for output in outputs:
        yield output.name, *(float(output.shown(result)) for result in results.values()), output.unit


def number(value: Any, digits: int = 5) -> str:
    """A number as people read it: so many significant digits, no more than four decimals of large ones."""
    value = float(value)
    if value != value:
        return "-"
    if value == 0:
        return "0"
    if abs(value) == inf:
        return "never" if value > 0 else str(value)
    if not 1e-3 <= abs(value) < 1e7:
        return f"{value:.2g}" if abs(value) < 1e-3 else f"{value:.4g}"
    whole = len(str(int(abs(value)))) if abs(value) >= 1 else 0
    return f"{value:.{max(0, digits - max(whole, 1))}f}"


def _column(title: str, outputs: Sequence[Output], result: Any) -> Group:
    rows = ([o.words, number(o.shown(result)), o.unit] for o in outputs)
    return table(title, ("", "value", "unit"), rows, (0, 2))
