"""A harvester on a random road: one mode in closed form, integrals of densities, and a long simulation."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.modes.modal.model import ModalBasis, Model, reduce_to_modes
from beamdyn.scene.numbers import with_numbers

SCENE = bd.load_scene(Path(__file__).parents[2] / "examples" / "bimorph.toml")
SPEED = 50.0
TURNS = SPEED / (2 * np.pi)
ROAD = bd.RoadRoughness(1e-9, highest=10.0)  # so smooth that its pull along the beam does not count


@pytest.mark.parametrize("resistance", [2e3, 2e5, 2e7])
def test_one_mode_in_white_noise_in_closed_form(resistance):
    """The integral of |H|^2 of third order: James, Nichols and Phillips (1947), I_3."""
    scene, density = with_numbers(SCENE, {"harvester.resistance": resistance}), 0.7
    full = Model(scene, bd.Ritz(16)).equations
    one = reduce_to_modes(full, ModalBasis(1, (SPEED,)))
    pencil, circuit = one.steady(), one.circuit
    assert circuit is not None
    m, c, k = (float(A[0, 0]) for A in (pencil.M, pencil.C, pencil.K0 + SPEED**2 * pencil.K2))
    load, theta = float(one.vectors["root_transverse"][0]), float(circuit.coupling[0])
    C, R = circuit.capacitance, resistance
    a3, a2, a1, a0 = m * C, m / R + c * C, k * C + c / R + theta**2, k / R
    # What modes left out give the electrodes without delay, beyond what tends to a constant.
    extra = sum(float(bent @ full.vectors["root_transverse"]) for bent in circuit.bent.values())
    top = np.array([extra * m, extra * c, extra * k + theta * load, 0.0])
    c2, c1, c0 = (top - top[0] / a3 * np.array([a3, a2, a1, a0]))[1:]
    above = c2**2 * a0 * a1 + (c1**2 - 2 * c0 * c2) * a0 * a3 + c0**2 * a2 * a3
    square = density / 2 * above / (2 * a0 * a3 * (a1 * a2 - a0 * a3))
    found = bd.random_response(
        scene, SPEED, density, "bending", "voltage", frequencies=[1.0], modes=1, discretization=bd.Ritz(16)
    )
    assert found.rms**2 / R == pytest.approx(square / R, rel=1e-10)  # the bound


@pytest.mark.parametrize("resistance", [0.0, 2e5, math.inf])
def test_on_a_road_it_is_the_integral_of_the_density(resistance):
    """By Gauss quadrature of the density of the response, fine about the resonance."""
    scene = with_numbers(SCENE, {"harvester.resistance": resistance})
    steady = bd.harvest(scene, [SPEED], modes=4)
    found = bd.harvest(scene, [SPEED], modes=4, road=ROAD)
    road = found.road
    assert road is not None and found.power[0] == steady.power[0]
    name, output = ("voltage", "voltage") if resistance else ("current", "current")
    ends = np.array([each * SPEED * 0.3 for each in (ROAD.lowest, ROAD.highest)])
    kinks = np.abs([each + shift for each in ends for shift in (-TURNS, TURNS)])
    ends = np.union1d([0.0, *kinks], 62.0 + np.linspace(-1, 1, 41) ** 3 * 60)
    ends = ends[ends <= kinks.max()]
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(ends)[:, None] / 2
    f, w = (ends[:-1, None] + half + half * nodes).ravel(), (half * weights).ravel()
    psd = bd.random_response(scene, SPEED, ROAD, output=output, frequencies=f, modes=4).psd
    assert getattr(road, name)[0] ** 2 == pytest.approx(w @ psd, rel=1e-6)  # of the quadrature
    carries = 0 < resistance < math.inf
    power = road.voltage[0] ** 2 / resistance if carries else 0.0
    assert road.power[0] == pytest.approx(power, rel=1e-12)
    assert found.total_power[0] == steady.power[0] + road.power[0]
    few = bd.harvest(scene, [SPEED], modes=2, road=ROAD).road
    assert few is not None and abs(getattr(few, name) / getattr(road, name) - 1)[0] < few.error[0] < 1e-2


def test_against_a_long_simulation():
    """Mean power over 8 s of a seeded record, within three standard errors of blocks of 0.4 s."""
    step, samples = 1 / 2000, 2**14
    rng, f, t = np.random.default_rng(5), np.fft.rfftfreq(samples, step), step * np.arange(samples)
    noise = rng.normal(size=f.size) + 1j * rng.normal(size=f.size)
    density = ROAD.acceleration(0.3 * SPEED).at(f)
    shaken = np.fft.irfft(samples * np.sqrt(density / (4 * samples * step)) * noise, samples)
    damped = replace(SCENE, damping_ratio=0.03, gravity=0.0)
    moved = replace(damped, motion=bd.SampledTranslation(t, along_n2=shaken, rotation=SPEED))
    run = bd.transient_harvest(bd.simulate(moved, t[-1], 1, tolerance=1e-3, t_eval=t))
    energy = np.interp(np.linspace(t[-1] - 8.0, t[-1], 21), run.t, run.energy)
    blocks = np.diff(energy) / 0.4
    deviation = blocks.std(ddof=1) / math.sqrt(len(blocks))
    road = bd.harvest(damped, [SPEED], modes=1, road=ROAD).road
    assert road is not None
    assert abs(blocks.mean() - road.power[0]) < 3 * deviation
    assert deviation < 0.2 * road.power[0]  # a wrong factor of two would be seen
