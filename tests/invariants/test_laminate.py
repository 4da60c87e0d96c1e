"""A strip with piezoelectric layers as a plate: by energy through the thickness, and as one thicker strip."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import beamdyn as bd

L, B, H, T = 0.05, 0.01, 2e-4, 1.5e-4
E, NU, RHO = 105e9, 0.34, 8500.0
S11, D31, EPS, NU_P, RHO_P = 16.4e-12, -171e-12, 1.5e-8, 0.41, 7750.0
STRIP = bd.Beam.rectangular(L, B, H, E, RHO, poissons_ratio=NU)
CAMBER = bd.Physics(camber=True)


def layers(connection: Any, **given: Any) -> bd.Harvester:
    material = {"d31": D31, "s11e": S11, "eps33t": EPS, "poissons_ratio": NU_P}
    return bd.Harvester(T, RHO_P, connection, **(material | given))


def by_energy(connection: str) -> tuple[float, float, float, float]:
    """D11, D12, theta and C per width, from the energy of strains and of a quadratic potential in each layer.

    The variables are strains of the middle and curvatures in both directions, the voltage, and of each layer
    a bubble of the potential; what is not a curvature or the voltage finds its own equilibrium.
    """
    nodes, weights = np.polynomial.legendre.leggauss(6)
    places = [(-H / 2, H / 2, 0), (H / 2, H / 2 + T, 1)]
    if connection != "unimorph":
        places.append((-H / 2 - T, -H / 2, -1))
    share = 0.5 if connection == "series" else 1.0  # of the voltage on each layer
    energy = np.zeros((7, 7))  # e1, e2, k1, k2, v, two bubbles
    stress_free = EPS - 2 * D31**2 / (S11 * (1 - NU_P))
    for low, high, side in places:
        z = (low + high) / 2 + (high - low) / 2 * nodes
        modulus, nu = (E, NU) if side == 0 else (1 / S11, NU_P)
        c = modulus / (1 - nu**2) * np.array([[1, nu], [nu, 1]])
        for place, weight in zip(z, weights * (high - low) / 2, strict=True):
            strain = np.zeros((2, 7))
            strain[0, [0, 2]] = strain[1, [1, 3]] = 1, -place
            energy += weight * strain.T @ c @ strain
            if side:
                # Layers on both sides are polarised so that bending adds up in the voltage.
                x, poled = (place - (low + high) / 2) / (T / 2), -side
                field = np.zeros(7)
                field[4], field[5 + (side < 0)] = share / T, 2 * x / T
                e = poled * D31 / (S11 * (1 - NU_P)) * np.ones(2)
                coupled = strain.T @ e
                energy -= weight * (np.outer(coupled, field) + np.outer(field, coupled))
                energy -= weight * stress_free * np.outer(field, field)
    free = [0, 1, 5, 6] if connection != "unimorph" else [0, 1, 5]
    kept = [2, 3, 4]
    own = energy[np.ix_(free, free)]
    left = energy[np.ix_(kept, kept)] - energy[np.ix_(kept, free)] @ np.linalg.solve(
        own, energy[np.ix_(free, kept)]
    )
    return left[0, 0], left[0, 1], -left[0, 2], -left[2, 2]


@pytest.mark.parametrize("connection", ["series", "parallel", "unimorph"])
def test_plate_by_energy_through_the_thickness(connection):
    beam = layers(connection).on(STRIP)
    electrodes, xi = beam.electrodes, np.array([0.5])
    strip, EI = electrodes.laminate, float(beam.bending_stiffness(xi)[0])
    D11, D12, theta, C = by_energy(connection)
    assert EI * float(strip.free(xi)[0] / (1 - strip.ratio(xi)[0] ** 2)) == pytest.approx(B * D11, rel=1e-12)
    assert float(strip.ratio(xi)[0]) == pytest.approx(D12 / D11, rel=1e-12)  # sums of some dozen products
    assert abs(electrodes.flat.moment) == pytest.approx(abs(B * theta), rel=1e-12)
    assert electrodes.flat.capacitance == pytest.approx(B * C, rel=1e-12)


@pytest.mark.parametrize("connection", ["series", "unimorph"])
def test_layers_of_the_strips_material_make_a_thicker_strip(connection):
    """With camber, at rest and turning: no laminate, but one thicker rectangle."""
    same = bd.Harvester(T, RHO, connection, e31=0.0, c11e=E, eps33s=EPS, poissons_ratio=NU)
    thick = bd.Beam.rectangular(
        L, B, H + (T if connection == "unimorph" else 2 * T), E, RHO, poissons_ratio=NU
    )
    for speed in (0.0, 50.0):
        found, wanted = (
            bd.natural_modes(bd.Scene(beam, bd.Mount(0.215), physics=CAMBER), speed, 3).frequency
            for beam in (same.on(STRIP), thick)
        )
        np.testing.assert_allclose(found, wanted, rtol=1e-9)  # the stated errors of both


@pytest.mark.slow
def test_short_and_open_circuit_by_two_discretizations():
    for resistance in (0.0, math.inf):
        scene = bd.Scene(layers("series", resistance=resistance, end=0.03).on(STRIP), physics=CAMBER)
        legendre, elements = (bd.natural_modes(scene, 0.0, 2, each) for each in ("ritz", "fem"))
        apart = np.abs(legendre.frequency / elements.frequency - 1)
        assert (apart <= legendre.error + elements.error + 2e-4).all()  # corners of the clamp


def test_camber_judges_the_beam_and_is_bounded_without_ratios():
    scene = bd.Scene(layers("series", resistance=math.inf).on(STRIP))
    plain = bd.natural_modes(scene, modes=1)
    within = bd.natural_modes(replace(scene, physics=CAMBER), modes=1)
    change = float(within.frequency[0] / plain.frequency[0] - 1)
    assert plain.left_out["camber of sections"][0] == pytest.approx(change, rel=0.02)  # to first order
    bare = bd.Beam.rectangular(L, B, H, E, RHO)
    unknown = layers("series", poissons_ratio=None, resistance=math.inf).on(bare)
    judged = bd.natural_modes(bd.Scene(unknown), modes=1).left_out_effects
    assert judged.changes["camber of sections"][0] > change
    assert "0.5" in judged.assumed["camber of sections"]
    given = bd.Scene(unknown).beam
    assert given.electrodes is not None and not given.electrodes.across
