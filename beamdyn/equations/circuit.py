"""The electric circuit of a harvester beside the equations of motion: electrodes, capacitance and resistance.

With the voltage v, the coordinates q and theta per coordinate, the moment of the electrodes times the change
of slope between their ends,

    M q'' + C q' + K q = f + theta v,    Cp v' + v/R + theta^T q' = 0.

Open, R = inf, the charge stays: v = -theta^T q / Cp, a stiffness theta theta^T / Cp.  Short-circuited,
v = 0.  Else the circuit has a coordinate of its own, in one of two forms:

- the **flux** mu, v = mu'/sqrt(Cp): mass 1, damping 1/(R Cp), gyroscopic coupling theta/sqrt(Cp), no
  stiffness; all matrices as in mechanics, for motion in time and harmonic balance;
- the **charge** Q that has flown, v = -(Q + theta^T q)/Cp: resistance R, stiffness 1/Cp, no mass; the
  stiffness stays positive definite, for linear models.

Modes that are left out follow a voltage without delay, by their residual flexibility g = K^-1 theta beyond
the modes (Craig and Kurdila, Fundamentals of Structural Dynamics (2006), section 11.4): the capacitance of
the reduced model is Cp + theta^T g.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from beamdyn.equations.fields.field import Deflection, Term
from beamdyn.scene.beam import Beam

BENDS = "bending"  # the field whose slope the electrodes feel
BLOCK = "circuit"  # name of the block of the circuit's coordinate


@dataclass(frozen=True)
class Circuit:
    """Electrodes with a load, beside equations of n coordinates.

    Parameters
    ----------
    coupling : ndarray, shape (n,)
        theta [N/V per coordinate].
    capacitance : float
        Cp [F].
    resistance : float
        R [ohm].
    bent : dict of str to ndarray
        g, the deflection by a unit voltage beyond that of the coordinates, over the functions of each field.
    """

    coupling: np.ndarray
    capacitance: float
    resistance: float
    bent: Mapping[str, np.ndarray] = field(default_factory=dict)


@dataclass(frozen=True)
class Voltage:
    """The voltage [V], or what else, by the coordinates (order 0) or their rates (order 1): row (n,)."""

    order: int
    row: np.ndarray


def strain_of(beam: Beam, deflection: Deflection, xi: np.ndarray) -> np.ndarray:
    """Strain of the layer's outer face at xi (k,) per function of the bending field: shape (n, k)."""
    assert beam.electrodes is not None, "electrodes stand on a layer"
    return beam.electrodes.fibre / beam.length**2 * deflection.space.evaluate(xi, 2)


def coupling_of(beam: Beam, deflection: Deflection) -> np.ndarray:
    """Theta over the functions of the bending field: the moment by a unit voltage on the slopes there."""
    assert beam.electrodes is not None, "electrodes couple"
    slopes = deflection.space.evaluate(np.array(beam.electrodes.span), 1) / beam.length
    return beam.electrodes.coupling * (slopes[:, 1] - slopes[:, 0])


def flux_terms(circuit: Circuit, coupled: Mapping[str, np.ndarray]) -> tuple[list[Term], Voltage]:
    """Terms of the flux mu, and the voltage by its rate; theta is given by block."""
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
    """Terms of the charge Q, and the voltage by it and the coordinates; theta is given by block."""
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
    """The stiffness theta theta^T / Cp of electrodes whose charge stays."""
    return [
        Term("piezoelectric stiffness", a, b, 0, np.outer(of_a, of_b) / circuit.capacitance)
        for a, of_a in coupled.items()
        for b, of_b in coupled.items()
    ]
