"""Electric circuit of a piezoelectric harvester in the equations of motion: capacitance and resistance.

Let v be the voltage, q the coordinates, and theta the bending moment due to a unit voltage times the change
of slope between the electrodes' ends per unit coordinate:

    M q'' + C q' + K q = f + theta v,    Cp v' + v/R + theta^T q' = 0.

For an open circuit, R = inf, the charge is constant: v = -theta^T q / Cp, which adds the stiffness theta
theta^T / Cp.  For a short circuit, v = 0.  Otherwise the circuit has a coordinate, in one of two forms:

- the **flux** mu, v = mu'/sqrt(Cp): mass 1, damping 1/(R Cp), gyroscopic coupling theta/sqrt(Cp), no
  stiffness; all matrices keep their mechanical properties, for transients and harmonic balance;
- the **charge** Q that has flown, v = -(Q + theta^T q)/Cp: resistance R, stiffness 1/Cp, no mass; the
  stiffness stays positive definite, for linear models.

Modes that a reduced model neglects respond quasi-statically to a voltage.  Their deflection under a unit
voltage, the residual flexibility g, is K^-1 theta minus the contribution of the retained modes (Craig and
Kurdila, Fundamentals of Structural Dynamics (2006), section 11.4).  The capacitance of the reduced model is
Cp + theta^T g.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise, product

import numpy as np

from beamdyn.common.numerics import gauss_rule
from beamdyn.equations.fields.field import Deflection, SectionFunctions, Term
from beamdyn.scene.beam import Beam

BENDS = "bending"  # the displacement field whose slope couples to the electrodes
BLOCK = "circuit"  # name of the block of the circuit's coordinate
_POINTS = 40  # number of points between breakpoints at which the curvature across the width is integrated


@dataclass(frozen=True, eq=False)
class Circuit:
    """Electrodes with a load resistance, coupled to equations of motion with n coordinates.

    Parameters
    ----------
    coupling : ndarray, shape (n,)
        Generalised force theta on each coordinate by a unit voltage [N/V].
    capacitance : float
        Capacitance Cp [F].
    resistance : float
        Load resistance R [ohm].
    bent : dict of str to ndarray
        Residual flexibility g of each field: the static deflection under a unit voltage in those modes that
        are not among the coordinates.
    """

    coupling: np.ndarray
    capacitance: float
    resistance: float
    bent: Mapping[str, np.ndarray] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Voltage:
    """Voltage [V] or other output: `row` (n,) times the coordinates (order 0) or their rates (order 1)."""

    order: int
    row: np.ndarray


def strain_of(beam: Beam, deflection: Deflection, xi: np.ndarray) -> np.ndarray:
    """Compute the strain of the piezoelectric layer's outer face per unit of each of n bending functions.

    The result (n, k) is for k positions xi = x/L.
    """
    assert beam.electrodes is not None, "electrodes stand on a layer"
    return beam.electrodes.fibre / beam.length**2 * deflection.space.evaluate(xi, 2)


def coupling_of(
    beam: Beam, deflections: Mapping[str, Deflection], sections: Iterable[tuple[str, SectionFunctions]]
) -> dict[str, np.ndarray]:
    """Compute each field's coupling: the work, per function, of the bending moment due to a unit voltage.

    In bending, the moment does work on the slopes at the ends of the electrodes.  If sections can camber, it
    also does work on the mean curvature across the width.
    """
    electrodes, L = beam.electrodes, beam.length
    assert electrodes is not None, "electrodes couple"
    slopes = deflections[BENDS].space.evaluate(np.array(electrodes.span), 1) / L
    coupling = {BENDS: electrodes.moment * (slopes[:, 1] - slopes[:, 0])}
    for name, functions in sections:
        assert beam.strip is not None, "sections that camber have a width"
        ends = beam.mass_per_length.split(electrodes.span).breakpoints
        inside = [each for each in ends if electrodes.span[0] <= each <= electrodes.span[1]]
        nodes, weights = gauss_rule(_POINTS)
        for first, last in pairwise(inside):
            xi = first + (last - first) * (nodes + 1) / 2
            per_width = (2 / beam.strip.width(xi)) ** 2 * weights * (last - first) * L / 2
            of_part = electrodes.moment * functions.curvature_across(xi) @ per_width
            coupling[name] = coupling.get(name, 0.0) + of_part
    return coupling


def flux_terms(circuit: Circuit, coupled: Mapping[str, np.ndarray]) -> tuple[list[Term], Voltage]:
    """Build the terms of a circuit with its flux as coordinate, and the voltage in these coordinates.

    `coupled` has the coupling vector theta of each block of coordinates [N/V].
    """
    root = np.sqrt(circuit.capacitance)
    terms = [
        Term("capacitance", BLOCK, BLOCK, 2, np.eye(1)),
        Term("load resistance", BLOCK, BLOCK, 1, np.eye(1), factor=1 / (circuit.resistance * root**2)),
    ]
    for name, theta in coupled.items():
        column = theta[:, None] / root
        terms.append(Term("piezoelectric coupling", name, BLOCK, 1, -column))
        terms.append(Term("piezoelectric coupling", BLOCK, name, 1, column.T))
    return terms, Voltage(1, np.append(0 * circuit.coupling, 1 / root))


def charge_terms(circuit: Circuit, coupled: Mapping[str, np.ndarray]) -> tuple[list[Term], Voltage]:
    """Build the terms of a circuit with its charge as coordinate, and the voltage in these coordinates.

    `coupled` has the coupling vector theta of each block of coordinates [N/V].
    """
    C = circuit.capacitance
    terms = [
        Term("capacitance", BLOCK, BLOCK, 0, np.eye(1) / C),
        Term("load resistance", BLOCK, BLOCK, 1, np.eye(1), factor=circuit.resistance),
        Term("capacitance", BLOCK, BLOCK, 2, np.zeros((1, 1))),
    ]
    for name, theta in coupled.items():
        column = theta[:, None] / C
        terms.append(Term("piezoelectric coupling", name, BLOCK, 0, column))
        terms.append(Term("piezoelectric coupling", BLOCK, name, 0, column.T))
    return [*terms, *open_terms(circuit, coupled)], Voltage(0, -np.append(circuit.coupling, 1.0) / C)


def open_terms(circuit: Circuit, coupled: Mapping[str, np.ndarray]) -> list[Term]:
    """Build the stiffness terms of open electrodes, whose charge stays constant.

    The terms are theta theta^T / Cp, with a coupling vector theta of each block and the capacitance Cp.
    """
    pairs, C = product(coupled.items(), repeat=2), circuit.capacitance
    return [Term("piezoelectric stiffness", a, b, 0, np.outer(u, v) / C) for (a, u), (b, v) in pairs]
