"""Equations of the transient of Table 3 in Lee and Yoo (2019): by beamdyn, and written by hand."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin

import numpy as np

import beamdyn as bd
from beamdyn.modes.modal.model import Model
from beamdyn.transient.system import ModalSystem
from benchmarks.cases.scenes import ROLLING


def modal_system(modes: int) -> ModalSystem:
    """Return the equations of Table 3 in its lowest modes at rest."""
    assert ROLLING.motion is not None
    return ModalSystem(Model(ROLLING, bd.Ritz(20)).modal_equations(modes), ROLLING.motion)


def handwritten(system: ModalSystem) -> tuple[Callable, Callable]:
    """Return the published scene's right-hand side and Jacobian, written by hand with scalars."""
    stiffness, loads = system.equations.matrices[0], system.equations.vectors
    base, spin, axial = (stiffness[name] for name in ("unity", "speed_squared", "root_axial"))
    P, Q, n = loads["root_transverse"], loads["acceleration"], system.size
    top, T, R, C, k, r = 55.0, 10.0, 0.3, 0.01, 2 * pi, 0.215
    y_dot, J = np.empty(2 * n), np.zeros((2 * n, 2 * n))
    J[:n, n:] = np.eye(n)

    def motion(t: float) -> tuple[float, float, float, float]:
        if t < T:
            x = 2 * pi * t / T
            w, dw = top * (t / T - sin(x) / (2 * pi)), top / T * (1 - cos(x))
            angle = top * T * ((t / T) ** 2 / 2 + (cos(x) - 1) / (4 * pi**2))
        else:
            w, dw, angle = top, 0.0, top * T / 2 + top * (t - T)
        c, s = cos(angle), sin(angle)
        v1, v2 = R * dw, C * k * w * cos(k * angle)
        return w * w, dw, w * w * r + v1 * c - v2 * s, v1 * s + v2 * c + dw * r

    def rhs(t: float, y: np.ndarray) -> np.ndarray:
        w2, dw, a1, a2 = motion(t)
        q = y[:n]
        y_dot[:n] = y[n:]
        y_dot[n:] = dw * Q + a2 * P - base.dot(q) - w2 * spin.dot(q) - a1 * axial.dot(q)
        return y_dot.copy()

    def jacobian(t: float, y: np.ndarray) -> np.ndarray:
        w2, _, a1, _ = motion(t)
        J[n:, :n] = -(base + w2 * spin + a1 * axial)
        return J

    return rhs, jacobian
