"""Voltage, current and layer strain of a harvester, as linear functions of generalized coordinates."""

from __future__ import annotations

import numpy as np

from beamdyn.equations.circuit import BENDS, Voltage, coupling_of, strain_of
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.scene.beam import Beam

_FACES = 9  # number of positions along the layers at which strains are compared


def electric_rows(equations: Equations, full: Equations, beam: Beam) -> tuple[Voltage, Voltage]:
    """Compute coefficients of the voltage across the load [V] and current through it [A], per coordinate.

    Parameters
    ----------
    equations : Equations
        Equations of motion, with the circuit's coordinate if there is one.
    full : Equations
        Equations in all functions of the discretization, from which `equations` were reduced.
    beam : Beam
        The beam.
    """
    electrodes, nothing = beam.electrodes, Voltage(0, np.zeros(equations.size))
    assert electrodes is not None, "a harvester has electrodes"
    if (voltage := equations.voltage) is not None:
        return voltage, Voltage(voltage.order, voltage.row / electrodes.resistance)
    row = np.zeros(equations.size)
    for name, theta in coupling_of(beam, full.deflections, full.sections).items():
        shape = equations.shapes[name]
        row[equations.blocks[shape.block]] += theta @ shape.matrix
    if electrodes.resistance:
        return Voltage(0, -row / electrodes.capacitance(beam.length)), nothing
    return nothing, Voltage(1, -row)


def strain_rows(equations: Equations, beam: Beam) -> np.ndarray:
    """Compute the strain of the piezoelectric layer's outer face per unit of each of n coordinates: (k, n).

    The k positions are spread evenly along the layer.
    """
    assert beam.electrodes is not None, "electrodes stand on a layer"
    xi, shape = beam.electrodes.inside(np.linspace(0, 1, _FACES)), equations.shapes[BENDS]
    rows = np.zeros((_FACES, equations.size))
    strain = strain_of(beam, equations.deflections[BENDS], xi)
    rows[:, equations.blocks[shape.block]] = strain.T @ shape.matrix
    return rows
