"""Uniform beams in space under loads at the tip, and their closed forms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import eigh, eigvals
from scipy.optimize import brentq

from beamdyn.equations.beam_in_space.bent_beam import STRAINS, BeamInSpace, BentBeam, elastic_stiffness
from beamdyn.equations.beam_in_space.finite_rotations import UNIT
from beamdyn.equations.beam_in_space.station_forces import BeamStations, Masses
from beamdyn.equations.beam_in_space.tip_forces import TipForces
from beamdyn.equations.discretization import FIXED, ArcQuadrature, Cells
from beamdyn.equations.ritz import Ritz, RitzSpaces

BENDING = ("twist rate", "second curvature", "curvature")
E1, E2, E3 = np.eye(3)
_ITERATIONS = 10  # number of Newton iterations for each load step, enough to converge to rounding
_ROUNDING = 1e-10  # relative change in the last iteration below which it is rounding


def uniform(
    length: float,
    law: np.ndarray,
    strains: Sequence[str] = STRAINS,
    *,
    functions: int = 12,
    ends: Sequence[float] = (0.0, 1.0),
    initial: Sequence[float] = (0.0,) * 6,
    mass: float = 0.0,
    centre: np.ndarray | None = None,
    inertia: np.ndarray | None = None,
    fibres: float = 0.0,
    pretwist: float = 0.0,
    kinks: np.ndarray | None = None,
    hinges: np.ndarray | None = None,
) -> BeamInSpace:
    """Make a beam of constant section: stiffness (6, 6); mass, centre and inertia (3, 3) per length."""
    points = functions + 16
    quadrature = ArcQuadrature(Cells(np.array(ends), points))
    stations, xi = BeamStations(quadrature, length, np.empty(0)), quadrature.xi
    of_each = RitzSpaces(Ritz(functions), tuple(ends), points, 2).functions(FIXED).evaluate(xi, 1)
    unknown = np.concatenate([_of_strain(name, of_each) for name in strains])
    stiffness = elastic_stiffness(stations, unknown, np.repeat(law[..., None], len(xi), axis=2))
    weights = np.append(quadrature.weights * length, 0.0)
    offset, tensor = (
        np.zeros(3) if centre is None else centre,
        np.zeros((3, 3)) if inertia is None else inertia,
    )
    masses = Masses(mass * weights, np.outer(offset, np.ones_like(weights)), tensor[..., None] * weights)
    given = np.outer(initial, np.ones_like(xi))
    straight = np.tile(UNIT, (len(ends) - 1, 1))
    return BeamInSpace(
        stations,
        masses,
        given,
        unknown,
        stiffness,
        np.zeros_like(stiffness),
        np.full_like(xi, fibres),
        np.full_like(xi, pretwist),
        straight if kinks is None else kinks,
        hinges,
    )


def _of_strain(name: str, functions: np.ndarray) -> np.ndarray:
    strains = np.zeros((len(functions), 6, functions.shape[1]))
    strains[:, STRAINS.index(name)] = functions
    return strains


def bend(beam: BeamInSpace, load: TipForces, steps: int = 4) -> BentBeam:
    """Solve for the equilibrium of a beam under a load that grows in steps, by Newton's method."""
    q, change = np.zeros(beam.size), np.full(beam.size, np.inf)
    for share in np.arange(1, steps + 1) / steps:
        for _ in range(_ITERATIONS):
            force, stiffness = beam.at(q).under(load.on(beam.at(q), share))
            change = np.linalg.solve(beam.stiffness - stiffness, force - beam.stiffness @ q)
            q = q + change
    assert np.abs(change).max() < _ROUNDING * np.abs(q).max()
    return beam.at(q)


# Cases ---------------------------------------------------------------------------------------------


def bend_of_45_deg(torsion: float, strains: Sequence[str] = STRAINS) -> np.ndarray:
    """Compute the tip displacement [in] of Bathe and Bolourchi's 45 deg arc: along, to centre, across."""
    modulus, radius, second = 1e7, 100.0, 1 / 12
    law = modulus * np.diag([1.0, 0.5, 0.5, torsion / 2, second, second])
    arc = uniform(radius * np.pi / 4, law, strains, functions=8, initial=(0, 0, 0, 0, 0, 1 / radius))
    return bend(arc, TipForces(force=600.0 * E3)).tip - arc.at(np.zeros(arc.size)).tip


def helix(length: float, stiffness: float, couple: np.ndarray) -> np.ndarray:
    """Compute the tip position of a beam with equal bending stiffnesses that a couple bends to a helix."""
    size = float(np.linalg.norm(couple))
    axis, turn = couple / size, size * length / stiffness
    along = axis * (axis @ E1)
    turned = np.sin(turn) * (E1 - along) + (1 - np.cos(turn)) * np.cross(axis, E1)
    return length * (along + turned / turn)


def lateral_buckling_load() -> float:
    """Compute P L^2/(EI GJ)^(1/2) at lateral buckling of a cantilever rigid in the direction of its load."""
    weak, torsion = 2.0, 0.7
    beam = uniform(1.3, np.diag([1, 1, 1, torsion, weak, 1]), ("twist rate", "second curvature"))
    straight = beam.at(np.zeros(beam.size))
    by_load = straight.under(TipForces(force=E2).on(straight)).change
    return 1.3**2 / np.sqrt(weak * torsion) / eigh(by_load, beam.stiffness, eigvals_only=True)[-1]


def flutter_load() -> float:
    """Compute P L^2/EI at flutter of a cantilever under a follower load at its tip (Beck)."""
    beam = uniform(1.0, np.eye(6), ("curvature",), mass=1.0)
    straight = beam.at(np.zeros(beam.size))
    by_load = straight.under(TipForces(force=-E1, follows=True).on(straight)).change

    def squared_distance(load: float) -> float:
        squares = eigvals(np.linalg.solve(straight.mass, beam.stiffness - load * by_load))
        first, second = squares[np.argsort(np.abs(squares))[:2]]
        return float(((first - second) ** 2).real)

    return float(brentq(squared_distance, 15.0, 25.0, xtol=1e-12))
