"""The drum paper's own numbers: its Table 1 from its wrong expressions, and what each of its errors costs.

Vardanyan et al., The Braking Torque of the Cylinder Brake Mechanism (2019). Inputs and errata come from
``brakes/published/vardanyan_2019.toml``; the consequences are those at the paper's longest arc, 80 degrees,
unless stated otherwise. For the right mechanics use `brakes.drum.shoe_torque`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from brakes.drum import BrakeResult, Shoe, brake_torque, shoe_torque, simplex
from brakes.published import load
from brakes.published.errata import Erratum

_INPUT = {name: entry["value"] for name, entry in load("vardanyan_2019")["input"].items()}
_MU, _P, _START = _INPUT["friction"], _INPUT["force"], np.radians(_INPUT["lining_start"])  # -, N, rad
_R, _A, _C = (1e-3 * _INPUT[name] for name in ("drum_radius", "force_arm", "pivot_depth"))  # m
_B1, _B2 = (1e-3 * offset for offset in _INPUT["pivot_offset"])  # m
PressureZero = Literal["axis", "pivot"]
_AXIS: PressureZero = _INPUT["pressure_zero"]  # of the pressure in (2)
_WIDTH = 0.05  # [m] the paper gives none; only the pressure depends on it
_LONGEST = np.radians(80.0)


@dataclass(frozen=True)
class Table1:
    """Columns of the paper's Table 1, shape (8,): angles in [rad], rho in [m], torques in [N m]."""

    arc: np.ndarray
    effective_arm: np.ndarray
    first_torque: np.ndarray
    second_torque: np.ndarray

    @property
    def difference(self) -> float:
        """Largest difference of the torques, the paper's Delta M [N m]."""
        return float(np.max(self.second_torque - self.first_torque))


def table_1(arc: np.ndarray | None = None) -> Table1:
    """Compute Table 1 as printed.

    Parameters
    ----------
    arc : ndarray, optional
        Arcs alpha0 of the lining [rad]; those of the paper, 10 to 80 degrees, unless given.

    Returns
    -------
    Table1
        Columns in SI units.
    """
    arc = np.radians(np.arange(10.0, 90.0, 10.0)) if arc is None else np.asarray(arc, dtype=float)
    rho = table_arm(arc)
    return Table1(arc, rho, _torque(rho, _B1), _torque(rho, -_B2))


def table_arm(arc: np.ndarray | float) -> np.ndarray:
    """Effective arm [m] in Table 1, at arcs [rad]; 0.87 is cos 30 deg, rounded. (12) gives 11.9 % less."""
    return _R * 0.87 * (np.cos(0.5236) - np.cos(_START + np.asarray(arc))) / 1.1485


def printed_arm(arc: np.ndarray | float) -> np.ndarray:
    """Effective arm [m] by (12) as printed, at arcs [rad]."""
    span = (np.pi - 2 * _START + np.sin(_START)) / 2
    return _R * np.cos(_START) * (np.cos(_START) - np.cos(_START + np.asarray(arc))) / span


def _torque(rho: np.ndarray | float, b: float) -> np.ndarray:
    """Torque [N m] by (15) with the sign of b that gives the table, not the printed one; by (16) with -b."""
    return _MU * _P * (_C + _A) * np.asarray(rho) / (_C + _MU * b - _MU * np.asarray(rho))


def errata() -> tuple[Erratum, ...]:
    """The paper's errors, in its order, each with its consequence computed."""
    return tuple(
        Erratum(**known, **_CONSEQUENCES[known["name"]]()) for known in load("vardanyan_2019")["erratum"]
    )


def corrected(arc: np.ndarray | float, pressure_zero: PressureZero = _AXIS) -> BrakeResult:
    """Solve the paper's brake by the right mechanics, at arcs of the lining [rad].

    The pressure is the paper's (2), which vanishes on the axis, or with "pivot" that of a shoe that turns
    about its pin.
    """
    first, second = (_shoe(b, arc, pressure_zero) for b in (_B1, _B2))
    return brake_torque(simplex(first, second), friction=_MU, force=_P)


# Consequences ---------------------------------------------------------------------------------------


def _shoe(b: float, arc: np.ndarray | float = _LONGEST, pressure_zero: PressureZero = _AXIS) -> Shoe:
    return Shoe(_R, _WIDTH, (_START, _START + arc), (b, -_C), _A, pressure_zero)


def _integrals(arc: float = _LONGEST) -> tuple[float, float, float]:
    """K, S, C: integrals of sin, sin^2 and sin cos over an arc from alpha1."""
    a1, a2 = _START, _START + arc
    K = np.cos(a1) - np.cos(a2)
    S = (a2 - a1) / 2 - (np.sin(2 * a2) - np.sin(2 * a1)) / 4
    return K, S, (np.sin(a2) ** 2 - np.sin(a1) ** 2) / 2


def _entry(quantity: str, unit: str, printed: float, right: float) -> dict[str, str | float]:
    return {"quantity": quantity, "unit": unit, "printed_value": float(printed), "right_value": float(right)}


def _projections() -> dict:
    K, S, _ = _integrals()
    return _entry("x component of the normal force over A pmax", "", K, S)


def _mixed_shoes() -> dict:
    _, S, C = _integrals()
    return _entry("y component of the force on the leading shoe over A pmax", "", C + _MU * S, C - _MU * S)


def _missing_half() -> dict:
    _, _, C = _integrals()
    return _entry("part of N from friction over A pmax", "", 2 * _MU * C, _MU * C)


def _quarter() -> dict:
    _, S, C = _integrals()
    return _entry("T over A pmax, the other terms as printed", "", _MU * S + 2 * C, _MU * S + C)


def _double_angle() -> dict:
    half = np.pi / 2 - _START
    printed, right = half + np.sin(_START) / 2, half + np.sin(2 * _START) / 2
    return _entry("N over A pmax on the symmetric arc of 120 deg", "", printed, right)


def _ratio() -> dict:
    _, S, C = _integrals()
    return _entry("T / N of the components of a trailing shoe", "", _MU, (C + _MU * S) / (S - _MU * C))


def _effective_arm() -> dict:
    K, S, C = _integrals()
    right = _R * K / np.hypot(S, C)
    return _entry("effective arm", "mm", 1e3 * float(printed_arm(_LONGEST)), 1e3 * right)


def _bound() -> dict:
    K, S, C = _integrals(np.radians(10.0))
    printed = table_arm(np.radians(10.0)) / _R
    return _entry("effective arm over r at 10 deg", "", float(printed), K / np.hypot(S, C))


def _trend() -> dict:
    table = table_1()
    total = table.first_torque + table.second_torque
    right = corrected(np.radians([10.0, 80.0])).torque
    return _entry("total torque at 80 deg over that at 10 deg", "", total[-1] / total[0], right[1] / right[0])


def _sign() -> dict:
    rho = table_arm(_LONGEST)
    return _entry("MT1 with the arm of the table", "N m", float(_torque(rho, -_B1)), float(_torque(rho, _B1)))


def _second_shoe() -> dict:
    rho = table_arm(_LONGEST)
    return _entry(
        "torque of the second shoe", "N m", float(_torque(rho, -_B2)), corrected(_LONGEST).shoes[1].torque
    )


def _sum() -> dict:
    rho = float(table_arm(_LONGEST))
    near = _C + _MU * rho
    printed = 2 * _MU * _P * rho * (_C + _A) * near / (near**2 - (_MU * _B1) ** 2)
    brake = brake_torque(simplex(_shoe(_B1)), friction=_MU, force=_P)
    return _entry("total torque for b1 = b2 = 20 mm", "N m", printed, float(brake.torque))


def _self_locking() -> dict:
    rho = float(table_arm(_LONGEST))
    right = shoe_torque(_shoe(_B1), friction=_MU, force=_P).locking_friction
    return _entry("friction at self-locking, b = 20 mm", "", -_C / (rho - _B1), float(right))


_CONSEQUENCES: dict[str, Callable[[], dict]] = {
    "projections": _projections,
    "mixed_shoes": _mixed_shoes,
    "missing_half": _missing_half,
    "quarter": _quarter,
    "double_angle": _double_angle,
    "ratio": _ratio,
    "effective_arm": _effective_arm,
    "bound": _bound,
    "trend": _trend,
    "sign": _sign,
    "second_shoe": _second_shoe,
    "sum": _sum,
    "self_locking": _self_locking,
}
