"""A base-excited bimorph beside its differential equation, solved in closed form.

The dimensions are those of Erturk and Inman (2009), Smart Materials and Structures 18, 025009:
50.8 x 31.8 mm, 0.14 mm of brass between layers of 0.26 mm of PZT-5A, a tip mass of 12 g.  No source that
prints its results was open, so that their digits are not compared: the check is a second derivation that
shares nothing with the package.  With layers over the whole length, the voltage bends the beam at its tip
alone; of the absolute deflection u, with the bending moment EI u'' - theta v,

    EI u'''' = m omega^2 u,  EI u''(L) = theta v,  EI u'''(L) = -m_t omega^2 u(L),
    (i omega C + 1/R) v + i omega theta u'(L) = 0.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import beamdyn as bd

L, WIDTH, CORE, LAYER = 0.0508, 0.0318, 0.14e-3, 0.26e-3
BRASS, PZT, HEAVY_BRASS, HEAVY_PZT, TIP = 105e9, 66e9, 9000.0, 7800.0, 0.012
D31, EPS_T = -190e-12, 1500 * 8.854187817e-12
BEAM = bd.Beam.rectangular(L, WIDTH, CORE, BRASS, HEAVY_BRASS, tip=bd.TipMass(TIP))
FREQUENCIES = np.array([5.0, 30.0, 44.0, 47.0, 60.0, 250.0, 480.0])


def layers(connection: Any, resistance: float) -> bd.Harvester:
    constants = {"d31": D31, "s11e": 1 / PZT, "eps33t": EPS_T}
    return bd.Harvester(LAYER, HEAVY_PZT, connection, **constants, resistance=resistance)


def by_differential_equation(connection: str, resistance: float, frequency: float) -> tuple[complex, complex]:
    """Voltage, and deflection of the tip, by a base acceleration of 1 m/s2."""
    outer = CORE / 2 + LAYER
    bending = 2 * WIDTH / 3 * (BRASS * (CORE / 2) ** 3 + PZT * (outer**3 - (CORE / 2) ** 3))
    mass = WIDTH * (HEAVY_BRASS * CORE + 2 * HEAVY_PZT * LAYER)
    eps = EPS_T - D31**2 * PZT
    theta = D31 * PZT * WIDTH * (CORE + LAYER) / 2 * (1 if connection == "series" else 2)
    capacitance = eps * WIDTH * L / LAYER * (0.5 if connection == "series" else 2)
    omega = 2 * math.pi * frequency
    beta, base = (mass * omega**2 / bending) ** 0.25, -1 / omega**2
    c, s, cc, ss = math.cos(beta * L), math.sin(beta * L), math.cosh(beta * L), math.sinh(beta * L)
    A, right = np.zeros((5, 5), dtype=complex), np.zeros(5, dtype=complex)  # of cosh, sinh, cos, sin, and v
    A[0, [0, 2]], right[0] = 1, base
    A[1, [1, 3]] = 1
    A[2] = [cc, ss, -c, -s, -theta / (bending * beta**2)]
    pull = TIP * omega**2 / (bending * beta**3)
    A[3] = [ss + pull * cc, cc + pull * ss, s + pull * c, -c + pull * s, 0]
    turned = beta * np.array([ss, cc, -s, c])
    A[4] = [*(1j * omega * theta * turned), 1j * omega * capacitance + 1 / resistance]
    found = np.linalg.solve(A, right)
    return complex(found[4]), complex(found[:4] @ [cc, ss, c, s] - base)


@pytest.mark.parametrize("connection", ["series", "parallel"])
@pytest.mark.parametrize("resistance", [1e3, 35e3, 470e3])
def test_voltage_and_deflection_of_a_bimorph(connection, resistance):
    scene = bd.Scene(layers(connection, resistance).on(BEAM))
    wanted = np.array([by_differential_equation(connection, resistance, f) for f in FREQUENCIES])
    for k, output in enumerate(("voltage", "tip")):
        found = bd.frequency_response(scene, 0.0, FREQUENCIES, output=output, modes=None).response[:, 0]
        apart = np.abs(np.abs(found) / np.abs(wanted[:, k]) - 1)
        assert apart.max() <= 1e-8, output  # the bound; near resonance rounding is magnified


@pytest.mark.parametrize(("resistance", "extreme"), [(0.0, 1e-6), (math.inf, 1e15)])
def test_its_resonance_short_circuited_and_open(resistance, extreme):
    """The natural frequency is where the response by the differential equation changes its sign."""
    first = bd.natural_modes(bd.Scene(layers("series", resistance).on(BEAM)), modes=1).frequency[0]
    sides = (by_differential_equation("series", extreme, first * (1 + d))[1].real for d in (-1e-9, 1e-9))
    below, above = sides
    assert below * above < 0
