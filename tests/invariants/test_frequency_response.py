"""Frequency responses and state spaces against direct solves, elements, and motion in time."""

import numpy as np
import pytest
from mpmath import mp
from scipy.signal import freqresp, lsim

import beamdyn as bd

STEEL = {"youngs_modulus": 200e9, "density": 7850.0}
BEAM = bd.Beam.rectangular(0.05, 0.01, 0.0002, **STEEL, tip=bd.TipMass(1e-4, offset=1e-3, inertia=1e-10))
DAMPING = bd.Damping(tip_damper=1e-3, stiffness_factor=1e-6)
OUTWARD = bd.Mount(0.215, np.pi, 0.7)
SCENE = bd.Scene(BEAM, OUTWARD, damping_ratio=0.01, damping=DAMPING)
TWO_PLANES = bd.Scene(
    bd.Beam.rectangular(0.05, 0.01, 0.0006, **STEEL, twist=bd.Polynomial([0.0, 0.4])),
    bd.Mount(0.2, np.pi, 0.3, precone=0.2),
    damping_ratio=0.01,
    physics=bd.Physics(planes=2),
)
SPEED = 50.0
FREQUENCIES = np.geomspace(1.0, 2000.0, 120)
ELEMENTS = bd.Fem(60)


def solve_directly(matrices, load, output):
    """Response of an output row by complex solves of the matrices, one frequency after the other."""
    C = matrices.damping + matrices.gyroscopic
    found = []
    for w in 2 * np.pi * FREQUENCIES:
        A = matrices.stiffness + 1j * w * C - w**2 * matrices.mass
        found.append(output @ np.linalg.solve(A, load))
    return np.array(found)


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "modes"), [(SCENE, "auto"), (SCENE, 20), (TWO_PLANES, "auto")])
def test_sixty_elements_against_a_direct_complex_solve_of_the_same_matrices(scene, modes):
    M = bd.matrices(scene, SPEED, discretization=ELEMENTS)
    tip = M.deflection([scene.beam.length])[0]
    for column, excitation in enumerate(("bending", "tip force")):
        direct = solve_directly(M, M.input_matrix[:, column], tip)
        found = bd.frequency_response(
            scene, SPEED, FREQUENCIES, excitation, modes=modes, discretization=ELEMENTS
        )
        np.testing.assert_allclose(found.response[:, 0], direct, rtol=0, atol=1e-8 * np.abs(direct).max())


@pytest.mark.parametrize("output", ["tip", "root strain", "tip acceleration"])
@pytest.mark.parametrize("excitation", ["bending", "n2", bd.PointForce(0.03)])
def test_assumed_modes_against_elements(excitation, output):
    modes, elements = (
        bd.frequency_response(SCENE, SPEED, FREQUENCIES, excitation, output, discretization=d)
        for d in ("ritz", ELEMENTS)
    )
    peak = np.abs(elements.response).max()
    # Accelerations weigh the last mode by its frequency squared, where cubic elements are 1e-5 off (h^4).
    bound = 2e-5 if output == "tip acceleration" else 1e-5
    np.testing.assert_allclose(modes.response, elements.response, rtol=0, atol=bound * peak)
    # Each states an error, and together they cover the distance at every frequency.
    assert (np.abs(modes.response - elements.response) <= modes.error + elements.error).all()


@pytest.mark.parametrize("output", ["tip", "root strain"])
def test_the_stated_error_covers_that_of_few_modes(output):
    exact = bd.frequency_response(SCENE, SPEED, FREQUENCIES, "tip force", output).response
    for modes in (2, 3, 5):
        found = bd.frequency_response(SCENE, SPEED, FREQUENCIES, "tip force", output, modes)
        assert (np.abs(found.response - exact) <= found.error).all()


def test_static_response_of_two_modes_is_that_of_the_whole_beam():
    # A force at mid-span: the deflection is a cubic from there, and EI phi'' the moment of the force.
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, outer_fibre=0.01)
    outputs = ["tip", "root moment", "root strain", bd.DeflectionAt(0.3)]
    ss = bd.state_space(bd.Scene(beam), 0.0, [bd.PointForce(0.5)], outputs, modes=2)
    static = ss.D - ss.C @ np.linalg.solve(ss.A, ss.B)
    exact = [0.5**2 * 2.5 / 6, 0.5, 0.005, 0.3**2 * (1.5 - 0.3) / 6]
    np.testing.assert_allclose(static[:, 0], exact, rtol=1e-9)


def test_state_space_has_the_frequency_response():
    ss = bd.state_space(SCENE, SPEED, ["bending"], ["tip"], modes=8)
    _, found = freqresp(ss, 2 * np.pi * FREQUENCIES)
    exact = bd.frequency_response(SCENE, SPEED, FREQUENCIES).response[:, 0]
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-6 * np.abs(exact).max())


def shaken(scene_of, direction, count=41, dt=2.5e-3, speed=SPEED):
    """A scene with a record of accelerations, which `simulate` and `lsim` join by straight lines."""
    steps = np.random.default_rng(1).normal(size=count)
    a = np.cumsum(steps) * 0.1
    a -= np.linspace(0, a[-1], count)
    t = dt * np.arange(count)
    return scene_of(bd.SampledTranslation(t, **{direction: a}, rotation=speed)), t, a


def test_state_space_through_lsim_against_simulate():
    flap = bd.Mount(0.215, np.pi, np.pi / 2)
    scene, t, a = shaken(lambda motion: bd.Scene(BEAM, flap, motion, damping_ratio=0.01), "along_n3")
    few = bd.Ritz(5)
    run = bd.simulate(scene, t[-1], None, tolerance=1e-8, discretization=few, t_eval=t)
    ss = bd.state_space(scene, SPEED, ["n3"], ["tip", "root strain"], modes=None, discretization=few)
    _, y, _ = lsim(ss, a, t)
    for found, exact in ((y[:, 0], run.tip), (y[:, 1], run.root_strain(t))):
        np.testing.assert_allclose(found, exact, rtol=0, atol=1e-6 * np.abs(exact).max())


def test_static_correction_brings_two_modes_closer_to_all():
    slow = np.array([0.0, 1.0, 2.0])  # Hz, far below the first mode: what is left out follows at once
    exact = bd.frequency_response(SCENE, SPEED, slow, "tip force").response[:, 0]
    ss = bd.state_space(SCENE, SPEED, ["tip force"], modes=2)
    _, corrected = freqresp(ss, 2 * np.pi * slow)
    bare = corrected - ss.D[0, 0]
    assert np.abs(corrected - exact).max() < 1e-3 * np.abs(bare - exact).max()


def test_an_acceleration_of_fixed_direction_is_answered_at_two_frequencies():
    # A tone along n2, in the plane of rotation, against the steady end of a run in time.
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0005, **STEEL, tip=bd.TipMass(3e-3))
    f, n = 20.0, 30.0 / (2 * np.pi)

    def moved(t):
        zero = np.zeros_like(t)
        tone = np.stack([zero, 1e-3 * np.cos(2 * np.pi * f * t), zero], axis=-1)
        return bd.MotionSample(30.0 * t, 30.0 + zero, zero, tone)

    scene = bd.Scene(beam, bd.Mount(0.1, np.pi, 0.4), bd.UserMotion(moved), damping_ratio=0.2)
    t = np.linspace(0.6, 0.8, 50)
    run = bd.simulate(scene, 0.8, 3, tolerance=1e-9, t_eval=t)
    found = bd.frequency_response(scene, 30.0, [f], "n2", modes=3)
    assert found.harmonics.tolist() == [-1, 1]
    waves = np.exp(2j * np.pi * np.outer(t, f + n * found.harmonics))
    # 1e-5: the modes of the run are those at rest, and a of 1e-3 m/s2 leaves the parametric term 1e-7.
    expected = 1e-3 * np.real(waves @ found.response[0])
    np.testing.assert_allclose(run.tip, expected, rtol=0, atol=1e-5 * np.abs(expected).max())


def test_reciprocity():
    # Without gyroscopic terms the deflection at a by a force at b is that at b by a force at a.
    a, b = 0.02, 0.04
    there = bd.frequency_response(SCENE, SPEED, FREQUENCIES, bd.PointForce(a), bd.DeflectionAt(b))
    back = bd.frequency_response(SCENE, SPEED, FREQUENCIES, bd.PointForce(b), bd.DeflectionAt(a))
    np.testing.assert_allclose(there.response, back.response, rtol=0, atol=1e-9 * np.abs(back.response).max())


def test_a_rigid_body_transmits_its_base():
    # Far below the first mode at rest, the tip accelerates as its base.
    rest = bd.Scene(BEAM, OUTWARD, damping_ratio=0.01)
    found = bd.frequency_response(rest, 0.0, [1e-3], "bending", "tip acceleration")
    assert found.response[0, 0] == pytest.approx(1.0, abs=1e-8)  # (1e-3 Hz over 60 Hz)^2


def test_uniform_cantilever_against_its_characteristic_functions():
    # Receptance at the tip of a unit beam, (sin ch - cos sh) / (beta^3 (1 + cos ch)): Bishop, Johnson (1960).
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0)
    f = np.array([0.1, 1.0, 2.0, 5.0, 9.0])
    beta = np.sqrt(2 * np.pi * f)
    c, s, ch, sh = np.cos(beta), np.sin(beta), np.cosh(beta), np.sinh(beta)
    exact = (s * ch - c * sh) / (beta**3 * (1 + c * ch))
    found = bd.frequency_response(bd.Scene(beam), 0.0, f, "tip force")
    np.testing.assert_allclose(found.response[:, 0], exact, rtol=1e-7)
    assert (np.abs(found.response[:, 0] - exact) <= found.error[:, 0]).all()


@pytest.mark.parametrize("discretization", ["ritz", bd.Ritz(16), bd.Fem(100), bd.Fem(160), bd.Fem(200)])
@pytest.mark.parametrize("mode", range(4))
def test_stated_errors_cover_rounding_that_resonance_magnifies(mode, discretization):
    """The beam of the last test, damped by its mass: beta^4 = omega^2 - 2e-4 i omega."""
    with mp.workdps(30):
        start = (mode + 0.5) * mp.pi + (0.3 if mode == 0 else 0)
        resonant = mp.findroot(lambda b: mp.cos(b) + 1 / mp.cosh(b), start)
        f = float(resonant**2 / (2 * mp.pi))
        beta = mp.root((2 * mp.pi * f) ** 2 - 2e-4j * 2 * mp.pi * f, 4)
        c, s, ch, sh = mp.cos(beta), mp.sin(beta), mp.cosh(beta), mp.sinh(beta)
        exact = complex((s * ch - c * sh) / (beta**3 * (1 + c * ch)))
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), damping=bd.Damping(mass_factor=2e-4))
    found = bd.frequency_response(scene, 0.0, [f], "tip force", discretization=discretization)
    assert abs(found.response[0, 0] - exact) <= found.error[0, 0]
    band = bd.PowerSpectrum([0.5 * f, 2 * f], [1.0, 1.0])
    random = bd.random_response(scene, 0.0, band, "tip force", frequencies=[f], discretization=discretization)
    assert abs(random.psd[0] - abs(exact) ** 2) <= random.psd_error[0]


@pytest.mark.parametrize("beside", [-1, 0, 1])
@pytest.mark.parametrize("speed", [0.0, 20.0, 50.0])
def test_an_undamped_response_at_a_natural_frequency_has_an_immense_error_or_is_refused(speed, beside):
    scene = bd.Scene(bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0), bd.Mount(0.215, 0.3))
    first = bd.natural_modes(scene, speed, 1).frequency[0]
    f = np.nextafter(first, first + beside)
    try:
        found = bd.frequency_response(scene, speed, [f])
        assert np.isfinite(found.error).all() and (found.error > 0.01 * np.abs(found.response)).all()
    except ValueError as error:
        assert "no finite response at a natural frequency" in str(error)


def test_the_moment_at_a_root_that_material_damping_holds():
    """A nearly rigid beam turns about its spring, which takes part in C = alpha M + beta K."""
    spring, beta = 1e-8, 0.3
    mount = bd.Mount(root_stiffness=spring)
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), mount, damping=bd.Damping(stiffness_factor=beta))
    f = np.sqrt(3 * spring) / (2 * np.pi) * np.array([0.1, 0.9, 1.0, 2.0])
    turn, moment = (bd.frequency_response(scene, 0.0, f, output=seen) for seen in ("tip", "root moment"))
    exact = spring * (1 + 2j * np.pi * f * beta) * turn.response[:, 0]
    np.testing.assert_allclose(moment.response[:, 0], exact, rtol=3e-8)
