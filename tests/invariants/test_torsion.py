"""Torsion of sections by their constants: closed forms, the strip as a plate, and work by another route."""

import math

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations

TORSION = bd.Physics(torsion=True)
E, G, RHO = 200e9, 200e9 / 2.6, 7850.0
OUT, FLAT = math.pi, math.pi / 2


def tube(length=0.5, radius=0.01, wall=0.001, **given):
    """A thin tube, whose polar moment of area is its torsional constant."""
    area = 2 * math.pi * radius * wall
    second = area * radius**2 / 2
    inertia = {"rotary_inertia": RHO * second, "second_rotary_inertia": RHO * second}
    stiffness = {"second_bending_stiffness": E * second, "torsion_stiffness": 2 * G * second}
    return bd.Beam.from_stiffness(length, RHO * area, E * second, **stiffness, **inertia, **given)


def flat(**given):
    """A strip of 100 x 20 x 4 mm by its constants."""
    b, t = 0.02, 0.004
    section = bd.Beam.rectangular(0.1, b, t, E, RHO, poissons_ratio=0.3).section
    J, warping = float(section.torsion_factor(0.0)) * b * t**3 / 3, float(section.warping_factor(0.0))
    constants = {"torsion_stiffness": G * J, "warping_stiffness": E * warping * b**3 * t**3 / 144}
    inertia = {"rotary_inertia": RHO * b * t**3 / 12, "second_rotary_inertia": RHO * t * b**3 / 12}
    second = {"second_bending_stiffness": E * t * b**3 / 12}
    return bd.Beam.from_stiffness(
        0.1, RHO * b * t, E * b * t**3 / 12, **second, **(constants | inertia | given)
    )


def torsional(scene, speed=0.0, modes=6, discretization="ritz"):
    """Frequencies of the modes of torsion."""
    found = bd.natural_modes(scene, speed, modes, discretization=discretization)
    return found.frequency[found.kind == "torsion"]


@pytest.mark.parametrize("discretization", ["ritz", "fem", bd.Ritz(14, "moments")])
def test_tube_at_rest(discretization):
    found = torsional(bd.Scene(tube(), physics=TORSION), discretization=discretization)[0]
    assert found == pytest.approx(math.sqrt(G / RHO) / (4 * 0.5), rel=1e-9)  # promised


def test_tube_with_a_body_at_the_tip():
    """beta tan(beta) is the inertia of the tube over that of the body."""
    body = bd.TipMass(0.1, inertia=2e-5, transverse_inertia=2e-5, axial_inertia=3e-5)
    ratio = 2 * float(tube().rotary_inertia(0.0)) * 0.5 / 3e-5
    beta = brentq(lambda x: x * math.tan(x) - ratio, 1e-6, math.pi / 2 - 1e-9, xtol=1e-15)
    found = torsional(bd.Scene(tube(tip=body), physics=TORSION))[0]
    assert found == pytest.approx(beta * math.sqrt(G / RHO) / (2 * math.pi * 0.5), rel=1e-9)  # promised


@pytest.mark.parametrize("bending_angle", [0.0, FLAT])
def test_tension_and_propeller_moment_by_numbers(bending_angle):
    """Without warping, of a mode shape sin(pi x/2L): its Rayleigh quotient bounds the first frequency."""
    beam, radius, speed = flat(warping_stiffness=None), 0.1, 2000.0
    scene = bd.Scene(beam, bd.Mount(radius, OUT, bending_angle), physics=TORSION)
    x, w = np.polynomial.legendre.leggauss(40)
    x, w = 0.05 * (x + 1), 0.05 * w
    theta, slope = np.sin(np.pi * x / 0.2), np.pi / 0.2 * np.cos(np.pi * x / 0.2)
    GJ, R1, R2, m = (
        float(getattr(beam, name)(0.0))
        for name in ("torsion_stiffness", "rotary_inertia", "second_rotary_inertia", "mass_per_length")
    )
    tension = m * ((radius + 0.1) ** 2 - (radius + x) ** 2) / 2
    stiffness = w @ (GJ * slope**2 + speed**2 * tension * (R1 + R2) / m * slope**2)
    propeller = speed**2 * (math.sin(bending_angle) ** 2 - math.cos(bending_angle) ** 2) * (R2 - R1)
    quotient = (stiffness + propeller * (w @ theta**2)) / ((R1 + R2) * (w @ theta**2))
    found = torsional(scene, speed)[0]
    assert 0 <= math.sqrt(quotient) / (2 * math.pi * found) - 1 < 1e-4  # the shapes differ by 1 %
    at_rest = torsional(scene)[0]
    assert abs(found / at_rest - 1) > 1e-3


def test_constants_of_a_rectangle_give_the_torsion_of_the_strip():
    strip = bd.Beam.rectangular(0.1, 0.02, 0.004, E, RHO, poissons_ratio=0.3)
    for speed in (0.0, 1000.0):
        mount = bd.Mount(0.1, OUT, FLAT)
        as_plate = torsional(bd.Scene(strip, mount, physics=TORSION), speed)[0]
        by_constants = torsional(bd.Scene(flat(), mount, physics=TORSION), speed)[0]
        assert by_constants == pytest.approx(
            as_plate, rel=2e-3
        )  # sections of strips also warp along the width


def test_static_twist_by_rotation():
    """At an oblique angle: G J theta'' is the load per length, without tension by a radius that undoes it."""
    beam, speed, angle = flat(warping_stiffness=None), 50.0, 0.6
    scene = bd.Scene(beam, bd.Mount(0.1, OUT, angle), physics=TORSION)
    equations = assemble_equations(scene, bd.Ritz(8))
    pencil, place = equations.steady(), equations.blocks["torsion"]
    theta = np.linalg.solve(pencil.K0[place, place], speed**2 * pencil.f2[place])
    GJ, R1, R2 = (
        float(getattr(beam, name)(0.0))
        for name in ("torsion_stiffness", "rotary_inertia", "second_rotary_inertia")
    )
    load = -(speed**2) * math.sin(angle) * math.cos(angle) * (R2 - R1)
    tip = (theta @ pencil.f2[place]) * speed**2  # work of the load: load^2 L^3/(3 G J)
    assert tip == pytest.approx(load**2 * 0.1**3 / (3 * GJ), rel=1e-10)  # rounding


@pytest.mark.parametrize(
    ("lacking", "said"),
    [
        ("torsion_stiffness", "torsion_stiffness"),
        ("rotary_inertia", "rotary_inertia"),
        ("second_rotary_inertia", "second_rotary_inertia"),
    ],
)
def test_what_torsion_lacks_is_said(lacking, said):
    with pytest.raises(ValueError, match=rf"physics\.torsion = True: it needs {said}; give it"):
        bd.Scene(flat(**{lacking: None, "warping_stiffness": None}), physics=TORSION)


def test_all_that_torsion_lacks_is_said_at_once():
    said = "it needs torsion_stiffness, rotary_inertia, second_rotary_inertia; give it to"
    with pytest.raises(ValueError, match=said):
        bd.Scene(bd.Beam.from_stiffness(0.5, 1.0, 10.0), physics=TORSION)
    with pytest.raises(ValueError, match=r"warping needs torsion_stiffness as well; give both, or neither"):
        flat(torsion_stiffness=None)


def test_a_twisted_strip_is_refused():
    strip = bd.Beam.rectangular(0.1, 0.02, 0.004, E, RHO, poissons_ratio=0.3, twist=0.3)
    with pytest.raises(ValueError, match="of a twisted strip are not modelled"):
        bd.Scene(strip, physics=TORSION)


def test_modes_that_a_beam_lacks_are_named_by_its_constants():
    unlisted = bd.natural_modes(bd.Scene(tube()), modes=5).left_out_effects.unlisted
    first = next(mode for mode in unlisted if mode.kind == "torsion")
    assert first.number == 1 and not first.assumed
    assert float(first.frequency) == pytest.approx(math.sqrt(G / RHO) / 2, rel=1e-3)  # of few functions


def test_modes_are_positive_at_the_corner_of_the_tip_and_have_no_surface():
    modes = bd.natural_modes(bd.Scene(tube(), physics=TORSION), modes=5)
    equations = modes.model.equations
    twist = np.real(equations.corner - equations.tip) @ modes.vectors.real
    assert twist[modes.kind == "torsion"] > 0
    with pytest.raises(ValueError, match="width of the sections is not known"):
        modes.surface([0.1], [0.0])


def kinked(tip_width: float, rounding: float = 0.0) -> bd.Beam:
    """A strip that tapers from the middle, where a parabola rounds the kink within x/L = 0.5 +- rounding."""
    slope = (0.01 - tip_width) / 0.5

    def width(xi: np.ndarray) -> np.ndarray:
        within = np.clip((xi - 0.5 + rounding) / (2 * rounding), 0.0, 1.0)
        return 0.01 - slope * np.where(xi > 0.5 + rounding, xi - 0.5, rounding * within**2)

    sides = width if rounding else bd.Table([0.0, 0.5, 1.0], [0.01, 0.01, tip_width])
    ends = (0.5 - rounding, 0.5 + rounding) if rounding else ()
    return bd.Beam.rectangular(
        0.05, sides, 0.0002, 200e9, 7850.0, breakpoints=ends, poissons_ratio=0.3
    )  # fmt: skip


@pytest.mark.parametrize("tip_width", [0.009, 0.006, 0.002])
def test_torsion_of_a_width_with_a_kink_is_the_limit_of_rounded_ones(tip_width: float) -> None:
    """What rounding changes falls with its square or faster; functions that are smooth at a kink miss 2 %."""
    physics = bd.Physics(torsion=True)
    beams = kinked(tip_width), kinked(tip_width, 0.1), kinked(tip_width, 0.02)
    sharp, *rounded = (bd.natural_modes(bd.Scene(beam, physics=physics), modes=5) for beam in beams)
    of_torsion = [modes.frequency[modes.kind == "torsion"][0] for modes in (sharp, *rounded)]
    coarse, fine = (abs(each / of_torsion[0] - 1) for each in of_torsion[1:])
    assert fine < 6e-4
    assert coarse < 30 * fine + 1e-9
    assert coarse > 5 * fine


@pytest.mark.parametrize("tip_width", [0.09, 0.006])
def test_many_functions_of_a_tapered_strip(tip_width: float) -> None:
    """Functions of y itself would grow like powers of the width: rounding would hide the narrow part."""
    width = bd.Polynomial([0.03, tip_width - 0.03])
    strip = bd.Beam.rectangular(0.5, width, 0.0025, 200e9, 7850.0, poissons_ratio=0.3)
    scene = bd.Scene(strip, physics=bd.Physics(torsion=True))
    pencils = (assemble_equations(scene, bd.Ritz(functions)).steady() for functions in (9, 18))
    few, many = (eigh(p.M, p.K0, eigvals_only=True)[-4:] for p in pencils)  # K0 is positive definite
    np.testing.assert_allclose(many, few, rtol=1e-3)  # of nine functions


@pytest.mark.slow
def test_torsion_of_a_stepped_strip_is_that_of_its_constants() -> None:
    """Saint-Venant's beam with the stiffnesses of its parts, to what warping at the clamp changes."""
    widths = bd.Table([0.0, 0.5, 0.5, 1.0], [0.01, 0.01, 0.006, 0.006])
    strip = bd.Beam.rectangular(0.2, widths, 0.0005, 200e9, 7850.0, poissons_ratio=0.3)
    properties = {
        name: getattr(strip, name)
        for name in ("second_bending_stiffness", "rotary_inertia", "second_rotary_inertia")
    }
    stiffness = bd.Table(
        [0.0, 0.5, 0.5, 1.0], [torsional_stiffness(b, 0.0005) for b in (0.01, 0.01, 0.006, 0.006)]
    )
    constants = bd.Beam.from_stiffness(
        0.2, strip.mass_per_length, strip.bending_stiffness, torsion_stiffness=stiffness, **properties
    )
    found = [
        bd.natural_modes(bd.Scene(beam, physics=bd.Physics(torsion=True)), modes=8)
        for beam in (strip, constants)
    ]
    first, second = (modes.frequency[modes.kind == "torsion"][0] for modes in found)
    assert first == pytest.approx(second, rel=0.03)
    assert first > second


def torsional_stiffness(width: float, thickness: float) -> float:
    """G J of a thin rectangle of steel [N m2]."""
    return 200e9 / 2.6 * width * thickness**3 / 3 * (1 - 0.63 * thickness / width)


def test_a_steep_width_is_refused_with_camber_and_a_kink_is_said() -> None:
    steep = bd.Table([0.0, 0.5, 0.501, 1.0], [0.01, 0.01, 0.006, 0.006])
    beam = bd.Beam.rectangular(0.05, steep, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    with pytest.raises(ValueError, match="slope of the width changes by at most 1"):
        bd.Scene(beam, physics=bd.Physics(camber=True))
    modes = bd.natural_modes(bd.Scene(kinked(0.006), physics=bd.Physics(camber=True)))
    assert any("up to 0.64 % too high" in text for text in modes.warnings)
    assert not bd.natural_modes(bd.Scene(kinked(0.0099), physics=bd.Physics(camber=True))).warnings
