"""Stability of motion with two rates that do not meet again, against periodic motion and Hill's method."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.scene.numbers import with_numbers
from beamdyn.studies.floquet.exponents import Cocycle, largest_exponent
from beamdyn.studies.floquet.monodromy import check_periodic
from beamdyn.transient.system import ModalSystem

UNIT = bd.Beam.from_stiffness(1.0, 1.0, 1.0)  # time in units of sqrt(rho A L^4 / EI)
GOLDEN = (math.sqrt(5) - 1) / 2
EXAMPLES = Path(__file__).parents[2] / "examples"


def pulsating(rate: float, fluctuation: float, gravity: float, damping: float) -> bd.Scene:
    """A blade in gravity at a speed of 2 on average, with a rate of its fluctuation."""
    motion = bd.PulsatingRotation(2.0, fluctuation, rate / (2 * math.pi))
    return bd.Scene(UNIT, bd.Mount(1.0, math.pi), motion, damping_ratio=damping, gravity=gravity)


RATES = 57 / 13, 55 / 12, 89 / 21, 47 / 16, 144 / 17


@pytest.mark.parametrize("modes", [1, 2])
@pytest.mark.parametrize("ratio", RATES)
@pytest.mark.parametrize("damping", [0.0, 0.002, 0.03])
def test_rates_that_meet_late_have_the_growth_rate_of_the_monodromy(ratio, damping, modes):
    """The phase with which they start acts by harmonics of the order of the turns, which are below 1e-12."""
    scene = pulsating(2 * ratio, 0.2, 3.0, damping)
    periodic, scenes = bd.floquet_multipliers(scene, modes), check_periodic(scene, modes, "ritz")
    found = largest_exponent(scenes.scene, scenes.equations(scenes.scene))
    assert periodic.method == "multipliers"
    apart = abs(found.rate - periodic.growth_rate)
    assert apart <= found.error + periodic.growth_rate_error + 1e-12
    assert found.status in (periodic.status, "undecided")
    if damping or periodic.status == "unstable":
        assert found.status == periodic.status and found.error <= 1e-4


def shaken(rate: float, push: float, damping: float) -> bd.Scene:
    """A beam that turns slowly, and whose centre is shaken in a fixed direction."""
    motion = bd.ShakenCarrier(rate / (2 * math.pi), along_n1=push, rotation=GOLDEN)
    return bd.Scene(UNIT, bd.Mount(0.0, 0.0), motion, damping_ratio=damping)


def hill(stiffness: float, push: float, damping: float, rates: tuple[float, float], order: int) -> float:
    """Largest growth rate of q'' + damping q' + (stiffness + push cos a cos b) q = 0, by the determinant.

    Harmonics of both phases up to an order; of the copies of an exponent that with least in the outermost.
    """
    each = [(j, k) for j in range(-order, order + 1) for k in range(-order, order + 1)]
    place, n = {h: i for i, h in enumerate(each)}, len(each)
    K = stiffness * np.eye(n)
    for (j, k), row in place.items():
        for other in ((j + a, k + b) for a in (-1, 1) for b in (-1, 1)):
            if other in place:
                K[row, place[other]] += push / 4
    omega = np.array(each) @ rates
    A = np.block([[-1j * np.diag(omega), np.eye(n)], [-K, -np.diag(1j * omega + damping)]])
    s, z = np.linalg.eig(A)
    outer = np.tile([max(map(abs, h)) >= order - 1 for h in each], 2)
    share = (np.abs(z[outer]) ** 2).sum(axis=0) / (np.abs(z) ** 2).sum(axis=0)
    return float(np.real(s[share < 1e-8]).max())


@pytest.mark.parametrize(("rate", "push"), [(2 * 3.516 + GOLDEN, 4.0), (2 * 3.516 - GOLDEN, 2.0), (3.6, 6.0)])
@pytest.mark.parametrize("damping", [0.0, 0.005])
def test_quasi_periodic_mathieu_equation(rate, push, damping):
    scene = shaken(rate, push, damping)
    scenes = check_periodic(scene, 1, "ritz")
    system = ModalSystem(scenes.equations(scene), scene.motion)
    t = np.linspace(0.0, 50.0, 101)
    C, K, _ = system.coefficients(t)
    both = np.cos(rate * t) * np.cos(GOLDEN * t)
    (mean, pushed), *_ = np.linalg.lstsq(np.stack([1 + 0 * t, both], axis=1), K[:, 0, 0])
    np.testing.assert_allclose(K[:, 0, 0], mean + pushed * both, rtol=1e-12)  # it is that equation
    wanted = hill(mean, pushed, 0.0 if C is None else float(C[0, 0, 0]), (rate, GOLDEN), 8)
    found = bd.floquet_multipliers(scene, modes=1)
    assert found.method == "exponent"
    assert abs(found.growth_rate - wanted) <= found.growth_rate_error + 1e-10  # rounding of the eigenvalues
    assert found.status == ("unstable" if wanted > 1e-6 else "stable" if damping else "undecided")


@pytest.mark.slow
def test_an_exponent_decides_where_phases_never_meet():
    unstable = bd.floquet_multipliers(pulsating(8.801033599927, 0.1, 3.0, 0.002), 2)
    assert (unstable.method, unstable.status) == ("exponent", "unstable")
    assert unstable.growth_rate_error < 1e-9
    decays = bd.floquet_multipliers(pulsating(9.3, 0.1, 3.0, 0.02), 2)
    assert decays.status == "stable"
    undamped = bd.floquet_multipliers(pulsating(9.3 * GOLDEN, 0.1, 3.0, 0.0), 2)
    assert undamped.status == "undecided" and any("exponent is 0" in said for said in undamped.warnings)
    assert "by its largest exponent" in repr(unstable)
    assert not len(unstable.multipliers)  # none is made up
    assert "multiplier" not in unstable.to_table() and "growth rate [1/s]" in unstable.to_table()
    assert unstable.spectral_radius == pytest.approx(
        np.exp(unstable.growth_rate * unstable.period), rel=1e-15
    )
    assert unstable.plot().get_xlabel() == "growth rate [1/s]"


class Thrice(bd.PulsatingRotation):
    """A fluctuation that says it had a third rate."""

    @property
    def rates(self) -> tuple[float, ...]:
        return *super().rates, 1.2345


def test_three_rates_are_refused():
    scene = pulsating(8.8, 0.1, 3.0, 0.0)
    with pytest.raises(ValueError, match="more than two rates"):
        bd.floquet_multipliers(replace(scene, motion=Thrice(2.0, 0.1, 8.8 * GOLDEN)), 1)


@pytest.mark.parametrize("size", [0.9, 1.1, 1.5, 2.0])
def test_bounds_hold_the_exponent_of_the_almost_mathieu_map(size):
    """It is max(0, ln size) on the spectrum, in which 0 lies (Bourgain and Jitomirskaya 2002)."""
    harmonics = np.zeros((17, 2, 2), dtype=complex)
    harmonics[8] = [[0.0, -1.0], [1.0, 0.0]]
    harmonics[[7, 9], 0, 0] = -size
    low, high = Cocycle(harmonics, 1.0, np.pi * (np.sqrt(5) - 1), 0.0).bounds()
    assert low <= max(0.0, np.log(size)) + 1e-9 <= high + 2e-9  # rounding of sums of logarithms
    assert low <= high


def test_no_stated_error_is_negative():
    for push in (12.0, 25.0, 40.0):
        scene = shaken(7.0, push, 0.0)
        found = bd.floquet_multipliers(scene, 1)
        assert found.growth_rate_error >= 0


@pytest.mark.parametrize("resistance", [1e3, 5e4])
def test_a_charge_that_leaks_within_a_period_leaves_the_exponent_known(resistance):
    """Rounding hides it from the map's determinant; a weak road leaves the multipliers of one without."""
    scene = with_numbers(bd.load_scene(EXAMPLES / "bimorph.toml"), {"harvester.resistance": resistance})
    wheel = bd.RollingWheel(0.3, 30.0, bd.RoadWave(0.3, velocity_amplitude=1e-6))
    found = bd.floquet_multipliers(replace(scene, motion=wheel), modes=2)
    smooth = bd.floquet_multipliers(replace(scene, motion=bd.SteadyRotation(30.0)), modes=2)
    assert (found.method, smooth.method, found.status) == ("exponent", "multipliers", "stable")
    assert found.growth_rate_error < 1e-4
    assert abs(found.growth_rate - smooth.growth_rate) <= found.growth_rate_error + 1e-9
