"""Random responses against integrals of their density, Lyapunov's equation, and long simulations."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov

import beamdyn as bd

STEEL = {"youngs_modulus": 200e9, "density": 7850.0}
BEAM = bd.Beam.rectangular(0.05, 0.01, 0.0005, **STEEL, tip=bd.TipMass(3e-3))
SCENE = bd.Scene(BEAM, bd.Mount(0.1, np.pi), bd.RollingWheel(0.3, 20.0), damping_ratio=0.03)
SPEED = 20.0
TURNS = SPEED / (2 * np.pi)
TABLE = bd.PowerSpectrum([5.0, 40.0, 150.0], [1.0, 3.0, 0.2])
LINEAR = bd.PowerSpectrum([0.0, 40.0, 150.0], [1.0, 3.0, 0.0], "linear")
ROAD = bd.RoadRoughness("C")


def quadrature(scene, psd, excitation, output):
    """Mean square by Gauss quadrature of the density of the result, on parts between its kinks."""
    shifts = (-TURNS, TURNS) if excitation == "n2" else (0.0,)
    kinks = {abs(f + shift) for f in psd.frequencies for shift in shifts} | {0.0}
    ends = np.union1d(sorted(kinks), 60.66 + np.linspace(-1, 1, 21) ** 3 * 50)  # fine about the resonance
    ends = np.array([end for end in ends if 0 <= end <= max(kinks)])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(ends)[:, None] / 2
    f = (ends[:-1, None] + half + half * nodes).ravel()
    found = bd.random_response(scene, SPEED, psd, excitation, output, f, modes=4)
    return float((half * weights).ravel() @ found.psd)


@pytest.mark.parametrize("output", ["tip", "root strain", "tip acceleration"])
@pytest.mark.parametrize(("psd", "excitation"), [(TABLE, "bending"), (LINEAR, "tip force"), (TABLE, "n2")])
def test_the_mean_square_is_the_integral_of_the_density(psd, excitation, output):
    found = bd.random_response(SCENE, SPEED, psd, excitation, output, modes=4)
    assert found.rms**2 == pytest.approx(quadrature(SCENE, psd, excitation, output), rel=1e-9)


def test_a_sharp_resonance_is_integrated_too():
    # 1e-6 of damping: the half-power band is 1e-4 Hz wide, and a density that is flat there gives Lyapunov's.
    sharp = replace(SCENE, damping_ratio=1e-6)
    wide = bd.PowerSpectrum([1e-3, 1e5], [2.0, 2.0])
    band = bd.random_response(sharp, SPEED, wide, "bending", modes=1).rms
    white = bd.random_response(sharp, SPEED, 2.0, "bending", modes=1).rms
    assert band == pytest.approx(white, rel=1e-5)  # what lies outside of the band, 1e-6 of the variance


STRIP = bd.Scene(bd.Beam.rectangular(0.15, 0.01, 0.0003, **STEEL), damping_ratio=0.01)
SHARP = replace(STRIP, damping_ratio=1e-7)
STEEP = bd.PowerSpectrum([0.5, 40.0, 41.0, 150.0], [1e-3, 3.0, 1e-6, 0.2])
WIDE = {
    "far above the first resonance": (STRIP, 0.0, bd.PowerSpectrum([5.0, 2e4], [1.0, 1.0]), "bending"),
    "little damping": (SHARP, 0.0, bd.PowerSpectrum([5.0, 2e4], [1.0, 1.0]), "bending"),
    "from 0 Hz": (STRIP, 0.0, bd.PowerSpectrum([0.0, 100.0, 2e4], [1.0, 0.0, 1.0], "linear"), "bending"),
    "steep, with side bands": (SCENE, SPEED, STEEP, "n2"),
    "narrow, with side bands": (SCENE, SPEED, bd.PowerSpectrum([60.0, 60.1], [1.0, 2.0]), "n2"),
    "overdamped": (replace(STRIP, damping=bd.Damping(mass_factor=1e3)), 0.0, TABLE, "bending"),
}


@pytest.mark.parametrize("case", WIDE)
@pytest.mark.parametrize("output", ["tip", "tip acceleration"])
def test_the_listed_density_has_the_mean_square_as_its_area(case, output):
    scene, speed, psd, excitation = WIDE[case]
    found = bd.random_response(scene, speed, psd, excitation, output)
    area = np.trapezoid(found.psd, found.frequencies)
    assert area == pytest.approx(found.rms**2, rel=0.01)
    assert (np.diff(found.frequencies) > 0).all() and len(found.frequencies) < 10_000
    if excitation != "n2":
        assert found.frequencies[0] == psd.frequencies[0]
        assert found.frequencies[-1] == psd.frequencies[-1]


def test_the_listed_density_by_white_noise_has_the_mean_square_as_its_area():
    found = bd.random_response(STRIP, 0.0, 1.0)
    assert np.trapezoid(found.psd, found.frequencies) == pytest.approx(found.rms**2, rel=0.01)


def test_white_noise_against_lyapunovs_equation():
    found = bd.random_response(SCENE, SPEED, 2.0, "bending", modes=3)
    ss = bd.state_space(SCENE, SPEED, ["bending"], ["tip"], modes=3)
    covariance = solve_continuous_lyapunov(ss.A, -ss.B @ ss.B.T)  # of white noise of two-sided density 1
    assert found.rms**2 == pytest.approx(2.0 / 2 * (ss.C @ covariance @ ss.C.T)[0, 0], rel=1e-10)


def test_one_resonance_against_the_variance_of_an_oscillator():
    # Crandall and Mark (1963): pi S / (2 zeta omega^3) by two-sided S per rad/s; one-sided per Hz is 4 pi S.
    scene = bd.Scene(BEAM, damping_ratio=0.02)
    M = bd.matrices(scene, 0.0, 1, inputs=["bending"])
    omega, load = np.sqrt(M.stiffness[0, 0]), M.input_matrix[0, 0] * M.deflection([0.05])[0, 0]
    expected = load**2 * 1.5 / (8 * 0.02 * omega**3)
    found = bd.random_response(scene, 0.0, 1.5, "bending", modes=1)
    assert found.rms**2 == pytest.approx(expected, rel=1e-10)


def test_rotation_shifts_the_spectrum_of_a_road_by_the_speed():
    # A road with all its roughness about one frequency is answered a turn above and a turn below it.
    velocity = 0.3 * SPEED
    narrow = bd.RoadRoughness(64e-6, 2.0, 20.0 / velocity, 20.01 / velocity)
    f = np.array([20.005 - TURNS, 20.005, 20.005 + TURNS])
    found = bd.random_response(SCENE, SPEED, narrow, frequencies=f)
    assert found.psd[1] == 0
    H = bd.frequency_response(SCENE, SPEED, [20.005], "n2").response[0]
    input_density = 64e-6 * (20.005 / velocity / 0.1) ** -2 / velocity * (2 * np.pi * 20.005) ** 4
    np.testing.assert_allclose(found.psd[[0, 2]], np.abs(H) ** 2 * input_density, rtol=1e-6)


def test_classes_of_roads_are_those_of_iso_8608():
    # Geometric means of the displacement density at 0.1 1/m, ISO 8608: 16e-6 m3 (A) to 262144e-6 m3 (H).
    means = [bd.RoadRoughness(name).density for name in "ABCDEFGH"]
    np.testing.assert_allclose(means, [16e-6 * 4**k for k in range(8)], rtol=1e-15)
    smooth, rough = (bd.random_response(SCENE, SPEED, bd.RoadRoughness(name)).rms for name in "AB")
    assert rough == pytest.approx(2 * smooth, rel=1e-12)


def record(psd, samples, step, seed):
    """A Gaussian record with a one-sided density."""
    rng, f, T = np.random.default_rng(seed), np.fft.rfftfreq(samples, step), samples * step
    noise = rng.normal(size=f.size) + 1j * rng.normal(size=f.size)
    return np.fft.irfft(samples * np.sqrt(psd.at(f) / (4 * T)) * noise, samples)


@pytest.mark.parametrize(("excitation", "axis"), [("n2", "along_n2"), ("n1", "along_n1")])
def test_against_a_long_simulation_with_the_parametric_term(excitation, axis):
    # 8 s at 60 Hz and 3 % of damping: 40 decay times; blocks of 0.4 s, of which each forgets the last.
    step, samples, psd = 1 / 2000, 2**14, bd.PowerSpectrum([5.0, 150.0], [1.0, 1.0])
    t = step * np.arange(samples)
    motion = bd.SampledTranslation(t, **{axis: record(psd, samples, step, 3)}, rotation=SPEED)
    run = bd.simulate(replace(SCENE, motion=motion), t[-1], 1, tolerance=1e-3, t_eval=t)
    blocks = (run.tip[384:].reshape(20, -1) ** 2).mean(axis=1)
    standard_error = blocks.std(ddof=1) / np.sqrt(len(blocks))
    expected = bd.random_response(SCENE, SPEED, psd, excitation, modes=1).rms ** 2
    assert abs(blocks.mean() - expected) < 3 * standard_error
    assert standard_error < 0.2 * expected  # a wrong factor of two would be seen


def test_parametric_noise_raises_the_variance_as_stated():
    # Moments of q'' + 2 zeta omega q' + omega^2 (1 + xi) q = w, both white: solved as three linear equations.
    zeta, omega, density = 0.02, 3.0, 0.01  # of xi, one-sided per Hz
    intensity = density / 2  # E[xi(t) xi(t + tau)] = intensity delta(tau)
    A = np.array(
        [
            [0.0, 2.0, 0.0],
            [-(omega**2), -2 * zeta * omega, 1.0],
            [intensity * omega**4, -2 * omega**2, -4 * zeta * omega],
        ]
    )
    with_noise = np.linalg.solve(A, [0.0, 0.0, -1.0])[0]
    A[2, 0] = 0.0
    without = np.linalg.solve(A, [0.0, 0.0, -1.0])[0]
    x = omega * density / (8 * zeta)
    assert with_noise / without == pytest.approx(1 / (1 - x), rel=1e-12)


def test_the_parametric_term_is_stated_and_warned_of():
    calm = bd.random_response(SCENE, SPEED, bd.PowerSpectrum([5.0, 300.0], [1.0, 1.0]), "n2")
    wild = bd.random_response(SCENE, SPEED, bd.PowerSpectrum([5.0, 300.0], [3e4, 3e4]), "n2")
    assert 0 < calm.parametric.rms_change < 1e-4
    assert not any("parametric" in said for said in calm.warnings)
    assert any("parametric" in said for said in wild.warnings)
    assert wild.parametric.stiffness_variation == pytest.approx(
        np.sqrt(3e4) * calm.parametric.stiffness_variation, rel=1e-12
    )


def test_the_stated_error_covers_that_of_few_modes():
    exact = bd.random_response(SCENE, SPEED, ROAD, output="root strain").rms
    for modes in (1, 2, 4):
        found = bd.random_response(SCENE, SPEED, ROAD, output="root strain", modes=modes)
        assert abs(found.rms - exact) <= found.rms_error
