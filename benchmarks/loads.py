"""Loads at the root and at mid-span against closed forms and the unreduced model: python -m benchmarks.loads

A uniform steel cantilever of 0.5 m, with and without a tip body, is loaded by its weight, rotates, or has its
root shaken across at 40 rad/s.  Closed forms are those of statics and of u'''' = b^4 u; for the rotating beam
that bends, the differential equation is solved by collocation.  The unreduced model keeps all functions of
its discretization, and its moment follows from its curvature, EI u''.  Deviations are relative to the largest
value along the span.

For the shaken beam, the moments of mode k, if left out, decrease as k^-7, and the shear forces as k^-6.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import solve_bvp

import beamdyn as bd
from beamdyn.equations.root_motion import root_motion
from beamdyn.loads.load_rows import span_rows
from beamdyn.loads.stations import stations_at
from beamdyn.modes.modal.model import ModalBasis, Model, reduce_to_modes
from benchmarks.rows import Row, show

LENGTH, WIDTH, THICK, E, RHO, G = 0.5, 0.02, 0.004, 200e9, 7800.0, 9.81
MASS, EI, EA = RHO * WIDTH * THICK, E * WIDTH * THICK**3 / 12, E * WIDTH * THICK
BEAM = bd.Beam.rectangular(LENGTH, WIDTH, THICK, E, RHO)
BODY = bd.TipMass(0.03, offset=0.02, inertia=2e-5)
RADIUS, SPEED, ANGLE = 0.1, 60.0, 2.9
SHAKEN, ACCELERATION = 40.0, 3.0  # angular frequency [rad/s] and acceleration [m/s2] of the root
AT = np.linspace(0, LENGTH, 21)
ROOT_AND_MIDDLE = [0, 10]
_BOUND = "1e-08"
_FUNCTIONS = 60  # number of functions of the unreduced model
_MODES = 14


@dataclass(frozen=True)
class Found:
    """Moments, bending strains and shear forces at the stations, up to a common sign."""

    moment: np.ndarray
    shear: np.ndarray

    @property
    def strain(self) -> np.ndarray:
        """Strain of the outer fibre."""
        return self.moment / EI * THICK / 2

    @classmethod
    def of(cls, loads: bd.SpanLoads, case: int = 0) -> Found:
        """Return moments, strains and shear forces of one case of a result."""
        axial = loads.force[case, :, 0] / EA
        moment = (loads.strain[case, :, 0] - axial) * EI / (THICK / 2)  # from the strain at the point -h/2
        return cls(moment, loads.force[case, :, 1])


def _rows(name: str, found: Found, exact: Found, against: str) -> Iterator[Row]:
    """Yield deviations of each quantity at the root and at mid-span."""
    for quantity in ("moment", "strain", "shear"):
        ours, truth = getattr(found, quantity), getattr(exact, quantity)
        sign = np.sign(ours[0] * truth[0])
        each = np.abs(sign * ours - truth)[ROOT_AND_MIDDLE] / np.abs(truth).max()
        yield f"{name}: {quantity} over {against}, root and mid-span", _say(each), _BOUND


def _say(deviations: np.ndarray) -> str:
    return ", ".join(f"{each:.0e}" for each in deviations)


# Equilibrium --------------------------------------------------------------------------------------


def weighed() -> Iterator[Row]:
    """Check a beam under its own weight, without and with a tip body."""
    for words, tip in (("weight", None), ("weight with a tip body", BODY)):
        scene = bd.Scene(replace(BEAM, tip=tip), bd.Mount(RADIUS, math.pi), gravity=G)
        rest, mass, arm = LENGTH - AT, tip.mass if tip else 0.0, tip.offset if tip else 0.0
        exact = Found(G * (MASS * rest**2 / 2 + mass * (rest + arm)), G * (MASS * rest + mass))
        yield from _rows(words, Found.of(bd.static_loads(scene, at=AT)), exact, "the closed form")


def spun() -> Iterator[Row]:
    """Check rotating beams: the axial force of an outward beam, the moment of a beam offset from the axis."""
    for words, tip in (("spun", None), ("spun with a tip body", BODY)):
        beam = replace(BEAM, tip=tip)
        straight = bd.static_loads(bd.Scene(beam, bd.Mount(RADIUS, math.pi)), SPEED, at=AT)
        body = tip.mass * (RADIUS + LENGTH + tip.offset) if tip else 0.0
        tension = SPEED**2 * (MASS * (RADIUS * (LENGTH - AT) + (LENGTH**2 - AT**2) / 2) + body)
        each = np.abs(straight.force[0, :, 0] - tension)[ROOT_AND_MIDDLE] / tension.max()
        yield f"{words}: axial force over the closed form, root and mid-span", _say(each), _BOUND
        each = np.abs(straight.strain[0, :, 0] - tension / EA)[ROOT_AND_MIDDLE] / tension.max() * EA
        yield f"{words}: axial strain over the closed form, root and mid-span", _say(each), _BOUND
        bent = bd.static_loads(bd.Scene(beam, bd.Mount(RADIUS, ANGLE)), SPEED, at=AT)
        exact = _bent_by_rotation(tip)
        yield from _rows(f"{words}, beside the axis", Found.of(bent), exact, "the differential equation")


def _bent_by_rotation(tip: bd.TipMass | None) -> Found:
    """Compute moment and shear force of a rotating beam with centrifugal forces across its axis.

    With the hub radius along and across the beam, d and h: EI u'''' = (N u')' + m omega^2 (u + h), and at
    the tip the same of the body.
    """
    along, across = -RADIUS * math.cos(ANGLE), -RADIUS * math.sin(ANGLE)
    m, eps = (tip.mass, tip.offset) if tip else (0.0, 0.0)
    w2 = SPEED**2
    body = m * w2 * (along + LENGTH + eps)

    def tension(x: np.ndarray) -> np.ndarray:
        return w2 * MASS * (along * (LENGTH - x) + (LENGTH**2 - x**2) / 2) + body

    def rates(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.stack([y[1], y[2] / EI, y[3] + tension(x) * y[1], MASS * w2 * (y[0] + across)])

    def ends(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """M' = Q + N u' with Q across the undeflected axis; of the body Q = -f, M = f eps - N eps u'."""
        push = m * w2 * (b[0] + eps * b[1] + across)
        return np.array([a[0], a[1], b[2] - eps * push + eps * body * b[1], b[3] + push])

    mesh = np.linspace(0, LENGTH, 401)
    solved = solve_bvp(rates, ends, mesh, np.zeros((4, mesh.size)), tol=1e-9, max_nodes=20_000)
    _, slope, moment, Q = solved.sol(AT)
    return Found(moment, Q + tension(AT) * slope)


# Motion -------------------------------------------------------------------------------------------


def shaken() -> Iterator[Row]:
    """Check a beam whose root is shaken across, without and with a tip body, against both references."""
    for words, tip in (("shaken", None), ("shaken with a tip body", BODY)):
        beam, exact = replace(BEAM, tip=tip), _forced(tip)
        by_modes, whole = (_vibration(beam, modes) for modes in (_MODES, None))
        yield from _rows(f"{words}, {_MODES} modes", by_modes, exact, "the closed form")
        yield from _rows(f"{words}, {_MODES} modes", by_modes, whole, "the unreduced model")


def _shake(t: np.ndarray) -> bd.MotionSample:
    zero = np.zeros_like(t)
    return bd.MotionSample(
        zero, zero, zero, np.stack([zero, zero, ACCELERATION * np.cos(SHAKEN * t)], axis=-1)
    )


def _vibration(beam: bd.Beam, modes: int | None) -> Found:
    """Compute amplitudes of loads in forced vibration, by modes; with all functions from EI u''."""
    scene = bd.Scene(beam, bd.Mount(0.0, bending_angle=math.pi / 2))
    model = Model(scene, bd.Ritz(_FUNCTIONS))
    equations = model.equations
    if modes is not None:
        equations = reduce_to_modes(equations, ModalBasis(modes, (0.0,)))
    K, M = equations.matrices[0]["unity"], equations.matrices[2]["unity"]
    state = np.linalg.solve(K - SHAKEN**2 * M, ACCELERATION * equations.vectors["root_transverse"])
    rows = span_rows(scene, model.discretization, equations, stations_at(beam, AT)).in_motion(equations)
    root = root_motion(scene.mount, _shake(np.zeros(1)))
    _, shear, moment = rows.at(root, state[None], np.zeros((1, len(state))))[0].T
    if modes is None:
        moment = EI * state @ equations.deflection(AT / LENGTH, 2) / LENGTH**2
    return Found(moment, shear)


def _forced(tip: bd.TipMass | None) -> Found:
    """Compute amplitudes of a uniform cantilever with a shaken root and a tip body, in closed form."""
    w2 = SHAKEN**2
    b = (MASS * w2 / EI) ** 0.25

    def each(x: np.ndarray | float, order: int) -> np.ndarray:
        turn = order * math.pi / 2
        hyperbolic = [np.cosh, np.sinh] if order % 2 == 0 else [np.sinh, np.cosh]
        return b**order * np.array(
            [*(f(b * x) for f in hyperbolic), np.cos(b * x + turn), np.sin(b * x + turn)]
        )

    m, eps, J = (tip.mass, tip.offset, tip.inertia) if tip else (0.0, 0.0, 0.0)
    u, slope, bend, third = (each(LENGTH, k) for k in range(4))
    push = m * w2 * (u + eps * slope)  # force of the body on the beam, from the absolute deflection
    ends = np.array([each(0.0, 0), each(0.0, 1), EI * bend - J * w2 * slope - eps * push, EI * third + push])
    found = np.linalg.solve(ends, [-ACCELERATION / w2, 0, 0, 0])
    return Found(EI * found @ each(AT, 2), -EI * found @ each(AT, 3))


PARTS = (weighed, spun, shaken)


if __name__ == "__main__":
    show("loads at the root and at mid-span", *PARTS)
