"""The drum paper's numbers, from its wrong equations, beside corrected ones, and its errors' consequences.

Vardanyan et al., The Braking Torque of the Cylinder Brake Mechanism (2019). Inputs and errata come from
``brakes/published/vardanyan_2019.toml``; the consequences are for the paper's longest arc, 80 degrees,
unless stated otherwise. The corrected mechanics is in `brakes.drum.shoe_torque`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from matplotlib.figure import Figure
from rich.console import Group

from beamdyn.common.edge.console import table
from beamdyn.common.plots.curves import grid
from beamdyn.common.results.pictures import COLOURS
from beamdyn.common.results.published import values_alone
from brakes.drawings.drum import brake_figure
from brakes.drum import BrakeResult, Shoe, brake_torque, shoe_torque, simplex
from brakes.published import load
from brakes.reproduce.common import Cell, Erratum, PrintedTable, errata_of, errata_table, step

PAPER = load("vardanyan_2019")
_INPUT = values_alone(PAPER["input"])
# Friction coefficient [-], actuating force [N], and angle at which the lining starts [rad].
_MU, _P, _START = _INPUT["friction"], _INPUT["force"], np.radians(_INPUT["lining_start"])
# Radius of the drum, arm of the force, and depth of the pivots [m].
_R, _A, _C = (1e-3 * _INPUT[name] for name in ("drum_radius", "force_arm", "pivot_depth"))
_B1, _B2 = (1e-3 * offset for offset in _INPUT["pivot_offset"])  # offsets of the two pivots [m]
PressureZero = Literal["axis", "pivot"]
_AXIS: PressureZero = _INPUT["pressure_zero"]  # line of zero pressure in the paper's equation (2)
_WIDTH = 0.05  # face width of the lining [m], which the paper does not give; only the pressure depends on it
_LONGEST = np.radians(80.0)


@dataclass(frozen=True)
class Table1:
    """Columns of the paper's Table 1, shape (8,): arcs [rad], effective arm rho [m], torques [N m]."""

    arc: np.ndarray
    effective_arm: np.ndarray
    first_torque: np.ndarray
    second_torque: np.ndarray

    @property
    def difference(self) -> float:
        """Largest difference of the shoes' torques [N m], Delta M in the paper."""
        return float(np.max(self.second_torque - self.first_torque))

    @property
    def total(self) -> np.ndarray:
        """Sum of the torques of both shoes [N m]."""
        return self.first_torque + self.second_torque


def table_1(arc: np.ndarray | None = None) -> Table1:
    """Compute Table 1 of the paper as printed.

    Parameters
    ----------
    arc : ndarray, optional
        Arcs alpha0 of the lining [rad]; by default those of the paper, 10 to 80 degrees.

    Returns
    -------
    Table1
        Columns of the table, in SI units.
    """
    arc = np.radians(np.arange(10.0, 90.0, 10.0)) if arc is None else np.asarray(arc, dtype=float)
    rho = table_arm(arc)
    return Table1(arc, rho, _torque(rho, _B1), _torque(rho, -_B2))


def table_arm(arc: np.ndarray | float) -> np.ndarray:
    """Compute the effective arm [m] of Table 1 at arcs [rad]; the paper's equation (12) gives 11.9 % less."""
    return _R * 0.87 * (np.cos(0.5236) - np.cos(_START + np.asarray(arc))) / 1.1485


def printed_arm(arc: np.ndarray | float) -> np.ndarray:
    """Compute the effective arm [m] by equation (12) as printed, at arcs [rad]."""
    span = (np.pi - 2 * _START + np.sin(_START)) / 2
    return _R * np.cos(_START) * (np.cos(_START) - np.cos(_START + np.asarray(arc))) / span


def _torque(rho: np.ndarray | float, b: float) -> np.ndarray:
    """Compute the torque [N m] by the paper's equation (15), with the sign of b that gives its Table 1.

    With -b the result is the torque of equation (16).
    """
    return _MU * _P * (_C + _A) * np.asarray(rho) / (_C + _MU * b - _MU * np.asarray(rho))


def corrected(arc: np.ndarray | float | None = None, pressure_zero: PressureZero = _AXIS) -> BrakeResult:
    """Solve the paper's brake by the corrected mechanics, at arcs of the lining [rad], by default Table 1's.

    The pressure is that of the paper's equation (2), which is zero on the axis; with "pivot" it is that of a
    shoe that turns about its pin.
    """
    arc = table_1().arc if arc is None else arc
    first, second = (_shoe(b, arc, pressure_zero) for b in (_B1, _B2))
    return brake_torque(simplex(first, second), friction=_MU, force=_P)


def _shoe(b: float, arc: np.ndarray | float = _LONGEST, pressure_zero: PressureZero = _AXIS) -> Shoe:
    return Shoe(_R, _WIDTH, (_START, _START + arc), (b, -_C), _A, pressure_zero)


# Errata -----------------------------------------------------------------------------------------------


def _integrals(arc: float) -> tuple[float, float, float]:
    """Compute the integrals K, S, C of sin, sin^2 and sin cos over an arc that begins at alpha1."""
    a1, a2 = _START, _START + arc
    K = np.cos(a1) - np.cos(a2)
    S = (a2 - a1) / 2 - (np.sin(2 * a2) - np.sin(2 * a1)) / 4
    return K, S, (np.sin(a2) ** 2 - np.sin(a1) ** 2) / 2


def errata() -> tuple[Erratum, ...]:
    """List the paper's errors, in its order, each with its computed consequence."""
    short = np.radians(10.0)
    (K, S, C), (short_K, short_S, short_C) = _integrals(_LONGEST), _integrals(short)
    table, right, rho = table_1(), corrected(np.array([short, _LONGEST])), float(table_arm(_LONGEST))
    half, near, trailing = np.pi / 2 - _START, _C + _MU * rho, right.shoes[1].torque[1]
    halves = half + np.sin(_START) / 2, half + np.sin(2 * _START) / 2
    sum_17 = 2 * _MU * _P * rho * (_C + _A) * near / (near**2 - (_MU * _B1) ** 2)
    equal = brake_torque(simplex(_shoe(_B1)), friction=_MU, force=_P).torque
    locking = shoe_torque(_shoe(_B1), friction=_MU, force=_P).locking_friction
    arms = 1e3 * float(printed_arm(_LONGEST)), 1e3 * (_R * K / np.hypot(S, C))
    bounds = float(table_arm(short) / _R), short_K / np.hypot(short_S, short_C)
    trends = table.total[-1] / table.total[0], right.torque[1] / right.torque[0]
    of_wrong_shoe = "y component of the force on the leading shoe over A pmax"
    costs = {
        "projections": ("x component of the normal force over A pmax", "", K, S),
        "mixed_shoes": (of_wrong_shoe, "", C + _MU * S, C - _MU * S),
        "missing_half": ("part of N from friction over A pmax", "", 2 * _MU * C, _MU * C),
        "quarter": ("T over A pmax, the other terms as printed", "", _MU * S + 2 * C, _MU * S + C),
        "double_angle": ("N over A pmax on the symmetric arc of 120 deg", "", *halves),
        "ratio": ("T / N of the components of a trailing shoe", "", _MU, (C + _MU * S) / (S - _MU * C)),
        "effective_arm": ("effective arm", "mm", *arms),
        "bound": ("effective arm over r at 10 deg", "", *bounds),
        "trend": ("total torque at 80 deg over that at 10 deg", "", *trends),
        "sign": ("MT1 with the arm of the table", "N m", _torque(rho, -_B1), _torque(rho, _B1)),
        "second_shoe": ("torque of the second shoe", "N m", _torque(rho, -_B2), trailing),
        "sum": ("total torque for b1 = b2 = 20 mm", "N m", sum_17, equal),
        "self_locking": ("friction at self-locking, b = 20 mm", "", -_C / (rho - _B1), locking),
    }
    return errata_of(PAPER, costs)


# Report -----------------------------------------------------------------------------------------------


def tables() -> dict[str, PrintedTable]:
    """Compare Table 1, and the largest difference of its torques, with numbers by the paper's own method."""
    printed, ours = PAPER["table_1"], table_1()
    columns = {"effective_arm": 1e3, "first_torque": 1.0, "second_torque": 1.0}
    rows: list[tuple[tuple[str, ...], list[Cell]]] = []
    for i, arc in enumerate(printed["arc"]["value"]):
        texts = {name: printed[name]["printed"][i] for name in columns}
        numbers = {name: unit * float(getattr(ours, name)[i]) for name, unit in columns.items()}
        rows.append(((f"{arc}",), [Cell(text, numbers[name], step(text)) for name, text in texts.items()]))
    heads = ("rho [mm]", "MT1 [N m]", "MT2 [N m]")
    text = printed["difference"]["printed"]
    largest = [Cell(text, ours.difference, step(text))]
    title = "Table 1: effective arm and torques, as printed"
    return {
        "table_1": PrintedTable(title, ("arc [deg]",), heads, rows),
        "difference": PrintedTable("", (), ("largest MT2 - MT1 [N m]",), [((), largest)]),
    }


def shown() -> Iterator[Group]:
    """Make Table 1, the corrected table, and the table of errata."""
    yield tables()["table_1"].shown()
    printed, right = table_1(), corrected()
    columns = (
        1e3 * right.shoes[0].effective_arm,
        right.shoes[0].torque,
        right.shoes[1].torque,
        right.torque,
        printed.total,
        printed.total / right.torque,
    )
    rows = zip(np.degrees(printed.arc), *columns, strict=True)
    lines = ([f"{arc:.0f}", *(f"{number:.3f}" for number in numbers)] for arc, *numbers in rows)
    heads = ("arc [deg]", "rho", "leading", "trailing", "total", "printed total", "printed / right")
    title = "The same brake by the corrected mechanics, with the paper's pressure: rho [mm], torques [N m]"
    yield table(title, heads, lines, ())
    heading = (
        "Errors of the paper, and their consequences for its longest lining (80 deg). Drum radius r, pin at\n"
        "(b, -c); A pmax: width times r times largest pressure; K, S, C: integrals of sin, sin^2, sin cos;\n"
        "n = c S - b C, d = r K - b S - c C: lever arms of the normal and the friction forces about the pin"
    )
    yield errata_table(heading, errata())


def summary() -> list[str]:
    """Return the conclusions for a brake engineer, one paragraph each."""
    printed, right, pivot = table_1(), corrected(), corrected(pressure_zero="pivot")
    short, long = (float(100 * printed.total[i] / right.torque[i]) for i in (0, -1))
    pairs = zip(right.shoes, pivot.shoes, strict=True)
    numbers = {
        "short": short,
        "long": long,
        "second": float(right.shoes[1].torque[-1]),
        "printed_second": float(printed.second_torque[-1]),
        "locking": float(right.shoes[0].locking_friction[-1]),
        "more": 100 * (max(float(np.max(axis.c_star / turning.c_star)) for axis, turning in pairs) - 1),
        "pivot": pivot.torque[-1],
        "total": right.torque[-1],
    }
    return [paragraph.format(**numbers) for paragraph in PAPER["summary"]]


def notes() -> Iterator[str]:
    """Yield the remarks below the tables."""
    (last,) = tables()["difference"].cells
    yield f"Largest MT2 - MT1: printed {last.printed}, ours {last.ours:.3f} N m; {last.verdict}."


def _over_arc() -> Figure:
    """Draw the torques over the arc, as printed and corrected."""
    printed, right = table_1(), corrected()
    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    ax = figure.subplots()
    lines = (
        ("corrected: total", right.torque, COLOURS[6], "-"),
        ("leading shoe", right.shoes[0].torque, COLOURS[0], "-"),
        ("trailing shoe", right.shoes[1].torque, COLOURS[2], "-"),
        ("as printed: total", printed.total, COLOURS[6], "--o"),
        ("MT2", printed.second_torque, COLOURS[2], "--o"),
        ("MT1", printed.first_torque, COLOURS[0], "--o"),
    )
    for label, values, colour, style in lines:
        ax.plot(np.degrees(printed.arc), values, style, color=colour, ms=4, lw=1.7, label=label)
    grid(ax)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("arc of the lining [deg]")
    ax.set_ylabel("torque at 1000 N on each shoe [N m]")
    ax.legend(fontsize=9, ncols=2, loc="upper right")
    ax.set_title("Torque over the arc: Table 1 as printed, and corrected", fontsize=11)
    return figure


PICTURES = {
    "drum_forces": lambda: brake_figure(corrected(float(table_1().arc[-1]))),
    "drum_torque_over_arc": _over_arc,
}
