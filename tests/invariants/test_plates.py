"""A strip as a plate: values of another program, limits, and the energy by direct integration over the area.

The values of `STRIPS` and `CANTILEVER_PLATES` were computed by a Kirchhoff-plate program that shares nothing
with this one (products of polynomials along and across, without the correction of torsion by the free
edges), converged to about 1e-5.  Those of `SOLIDS` are by CalculiX, C3D20R.
"""

import math
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations
from beamdyn.equations.discretization import CLAMPED
from beamdyn.equations.fields.strip import Strip
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.profile import ONE
from beamdyn.scene.rectangle import Rectangle

PLATE = bd.Physics(camber=True, torsion=True)
STEEL = {"youngs_modulus": 200e9, "density": 7850.0}
IN, OUT = 0.0, math.pi  # setting angles

# Sides [m], Poisson's ratio, radius [m], setting angle, bending angle [deg], speed [rad/s], frequencies [Hz].
STRIPS = [
    ((0.05, 0.01, 0.0002), 0.3, 0.215, IN, 0, 0, (66.0704, 413.571, 659.547, 1160.446, 2017.41)),
    ((0.05, 0.01, 0.0002), 0.3, 0.215, IN, 0, 50, (62.8385, 411.139, 659.201, 1157.98)),
    ((0.05, 0.01, 0.0002), 0.3, 0.215, IN, 0, 100, (51.9397, 403.748, 658.161, 1150.55)),
    ((0.05, 0.01, 0.0002), 0.0, 0.215, IN, 0, 0, (65.2305, 408.79, 744.77, 1144.6)),
    ((0.05, 0.01, 0.0002), 0.0, 0.215, IN, 0, 100, (50.9071, 398.84, 743.54)),
    ((0.05, 0.01, 0.0002), 0.3, 0.215, IN, 30, 100, (52.5457, 403.826, 658.257, 1150.58, 2014.88)),
    ((0.05, 0.01, 0.0002), 0.3, 0.215, IN, 90, 100, (54.3234, 404.061, 658.546, 1150.66, 2014.98)),
    ((0.05, 0.01, 0.0002), 0.3, 0.05, OUT, 0, 300, (91.4491, 450.780, 662.629, 1200.63, 2027.30)),
    ((0.05, 0.01, 0.0002), 0.3, 0.05, OUT, 90, 300, (103.163, 453.302, 666.061, 1201.58, 2028.42)),
    ((0.1, 0.05, 0.001), 0.3, 0.1, OUT, 90, 0, (83.6085, 359.826, 521.045, 1171.17, 1462.21)),
    ((0.1, 0.05, 0.001), 0.3, 0.1, OUT, 90, 150, (92.5741, 362.772, 529.229, 1175.53, 1470.39)),
    ((0.2, 0.02, 0.002), 0.3, 0.1, OUT, 90, 0, (41.0508, 257.188, 720.676, 802.540, 1414.41)),
]
# Length over width, and omega L^2 (rho t/D)^(1/2) of the lowest modes, nu 0.3.
CANTILEVER_PLATES = [
    (1.0, (3.4710, 8.5063, 21.284, 27.199, 30.955, 54.184)),
    (2.0, (3.4392, 14.8014, 21.4332, 48.176, 60.148, 92.516)),
    (5.0, (3.3973, 21.2654, 33.9133, 59.669, 103.73)),
]
SOLIDS = [  # sides [m], and first torsional mode [Hz]
    *(((0.05, 0.01, 0.0002), 655.99), ((0.1, 0.02, 0.002), 1586.8), ((0.1, 0.02, 0.004), 3004.8)),
    *(((0.1, 0.02, 0.01), 5926.0), ((0.1, 0.02, 0.02), 7214.0)),
]


@pytest.fixture
def thin(monkeypatch):
    """Sections without what their thickness adds to warping and turning."""
    monkeypatch.setattr(Rectangle, "warping_factor", ONE)
    monkeypatch.setattr("beamdyn.scene.rectangle._THICK_CAMBER", (0.0, 0.0))
    monkeypatch.setattr(Strip, "rotary_inertia", ONE.scaled(0.0))


@pytest.fixture
def wide(monkeypatch, thin):
    """Torsion of an infinitely wide section as well, as the plate program has it."""
    monkeypatch.setattr(Rectangle, "torsion_factor", ONE)


def strip(sides, nu, **given):
    length, width, thickness = sides
    return bd.Beam.rectangular(length, width, thickness, poissons_ratio=nu, **STEEL, **given)


@pytest.mark.parametrize("case", STRIPS)
def test_frequencies_are_those_of_a_plate_program(wide, case):
    sides, nu, radius, setting, bending, speed, expected = case
    scene = bd.Scene(strip(sides, nu), bd.Mount(radius, setting, math.radians(bending)), physics=PLATE)
    found = bd.natural_modes(scene, speed, len(expected), discretization=bd.Ritz(13))
    np.testing.assert_allclose(found.frequency, expected, rtol=3e-5)  # printed digits, and its convergence


@pytest.mark.parametrize("case", [STRIPS[2], STRIPS[5], STRIPS[8]])
def test_elements_agree(wide, case):
    sides, nu, radius, setting, bending, speed, expected = case
    scene = bd.Scene(strip(sides, nu), bd.Mount(radius, setting, math.radians(bending)), physics=PLATE)
    found = bd.natural_modes(scene, speed, len(expected), discretization=bd.Fem(24))
    np.testing.assert_allclose(found.frequency, expected, rtol=1e-3)  # of coarse elements


@pytest.mark.parametrize(("ratio", "expected"), CANTILEVER_PLATES)
def test_cantilever_plates(wide, ratio, expected):
    beam = strip((0.05, 0.05 / ratio, 0.0002), 0.3)
    found = bd.natural_modes(bd.Scene(beam, physics=PLATE), modes=len(expected), discretization=bd.Ritz(14))
    D = 200e9 * 0.0002**3 / 12 / (1 - 0.3**2)
    scaled = 2 * np.pi * found.frequency * 0.05**2 * math.sqrt(7850.0 * 0.0002 / D)
    np.testing.assert_allclose(scaled, expected, rtol=1e-4)  # a Kirchhoff plate is one at any thickness


@pytest.mark.parametrize(("sides", "expected"), SOLIDS)
def test_first_torsional_mode_is_that_of_a_solid(sides, expected):
    scene = bd.Scene(strip(sides, 0.3), physics=PLATE)
    found = bd.natural_modes(scene, modes=5, discretization=bd.Ritz(8)).frequency
    nearest = found[np.abs(found - expected).argmin()]
    assert nearest == pytest.approx(expected, rel=4e-3)  # 0.25 % of random ones, and the meshes of these


def test_without_poissons_ratio_bending_is_that_of_the_beam():
    beam, mount = strip((0.05, 0.01, 0.0002), 0.0), bd.Mount(0.215)
    plain = bd.natural_modes(bd.Scene(beam, mount), 100.0, 3, discretization=bd.Ritz(14)).frequency
    found = bd.natural_modes(bd.Scene(beam, mount, physics=PLATE), 100.0, 4, discretization=bd.Ritz(14))
    np.testing.assert_allclose(found.frequency[[0, 1, 3]], plain, rtol=1e-12)  # rounding


def test_torsional_constant_of_rectangles():
    # Timoshenko and Goodier (1970), Theory of Elasticity, table of 3 k1 = 3 J/(b t^3)
    for ratio, printed in ((1, 0.1406), (1.5, 0.196), (2, 0.229), (3, 0.263), (5, 0.291), (10, 0.312)):
        beam = bd.Beam.rectangular(1.0, 0.01 * ratio, 0.01, 200e9, 7850.0)
        assert float(beam.section.torsion_factor(0.5)) / 3 == pytest.approx(
            printed, abs=1e-3
        )  # printed digits
    square = bd.Beam.rectangular(1.0, 0.01, 0.01, 200e9, 7850.0).section
    n = np.arange(1, 4001, 2)
    series = 1 - 192 / np.pi**5 * (np.tanh(n * np.pi / 2) / n**5).sum()
    assert float(square.torsion_factor(0.0)) == pytest.approx(series, rel=1e-12)  # terms beyond: 1e-15


# The energy by direct integration ------------------------------------------------------------------

TAPERED, DIVIDED = (  # the second serves for the functions of torsion of widths with kinks
    bd.Beam.rectangular(
        0.1,
        Polynomial([0.03, -0.02, 0.006]),
        Polynomial([0.001, -0.0004]),
        poissons_ratio=0.35,
        tip=bd.TipMass(2e-3, 0.002, 3e-7, axial_inertia=2e-7, transverse_inertia=4e-7),
        breakpoints=breakpoints,
        **STEEL,
    )
    for breakpoints in ((), (0.6,))
)


BASIS, STEP = bd.Ritz(3), 2e-6  # m: of differences, short against the parts of the strip
t, weights = leggauss(14)


def surface(scene, space, q):
    """The deflection of coordinates as a function of x [m] and of y [m], each of shape (n,)."""
    equations = assemble_equations(scene, space)
    beam = scene.beam

    def w(x, y):
        local, at_tip = (beam.section.width(at) for at in (x / beam.length, np.ones(1)))
        total = np.zeros(np.broadcast(x, y).shape)
        phi = space.spaces(scene.modelled_beam).functions(CLAMPED).evaluate(np.ravel(x / beam.length))
        for name, block in equations.blocks.items():
            parts = q[block].reshape(-1, len(phi))
            numbers = {"bending": [0], "torsion": range(1, 40, 2), "camber": range(2, 40, 2)}[name]
            eta = 2 * y / (at_tip if name == "torsion" and beam is DIVIDED else local)
            for k, part in zip(numbers, parts, strict=False):
                total += (part @ phi) * np.sqrt(2 * k + 1) * np.polynomial.Legendre.basis(k)(eta)
        return total

    return w


def sample(scene, w):
    """The strip at the points of a rule over its area, with derivatives of w by differences."""
    beam, L = scene.beam, scene.beam.length
    ends = np.array(scene.modelled_beam.breakpoints) * L
    x = np.concatenate([(a + b) / 2 + (b - a) / 2 * t for a, b in pairwise(ends)])
    dx = np.concatenate([(b - a) / 2 * weights for a, b in pairwise(ends)])
    X, E = (each.ravel() for each in np.meshgrid(x, t, indexing="ij"))
    b, h = beam.section.width(X / L), beam.section.thickness(X / L)
    Y, area = E * b / 2, np.outer(dx, weights).ravel() * b / 2
    e = STEP
    f = {(i, j): w(X + i * e, Y + j * e) for i in (-1, 0, 1) for j in (-1, 0, 1)}
    w_x, w_y = (f[1, 0] - f[-1, 0]) / (2 * e), (f[0, 1] - f[0, -1]) / (2 * e)
    w_xx, w_yy = (f[1, 0] - 2 * f[0, 0] + f[-1, 0]) / e**2, (f[0, 1] - 2 * f[0, 0] + f[0, -1]) / e**2
    w_xy = (f[1, 1] - f[1, -1] - f[-1, 1] + f[-1, -1]) / (4 * e**2)
    nu = beam.section.poissons_ratio
    D, c = 200e9 * h**3 / 12 / (1 - nu**2), beam.section.torsion_factor(X / L)
    strain = area @ (D * (w_xx**2 + w_yy**2 + 2 * nu * w_xx * w_yy + 2 * (1 - nu) * c * w_xy**2))
    return SimpleNamespace(
        x=X, y=Y, b=b, area=area, rho_h=7850.0 * h, w=f[0, 0], w_x=w_x, w_y=w_y, strain=strain
    )


@pytest.fixture(params=[(TAPERED, 0, 0.0), (DIVIDED, 1, 0.0), (TAPERED, 2, 0.4)])
def tapered(request, thin, monkeypatch):
    """A tapered strip with a tip body at an oblique bending angle, a random deflection, and its samples."""
    beam, seed, precone = request.param
    if beam is DIVIDED:  # any width counts as one with kinks
        monkeypatch.setattr("beamdyn.equations.fields.strip._SMOOTH", -1.0)
    scene = bd.Scene(beam, bd.Mount(0.2, OUT, 0.7, precone=precone), physics=PLATE)
    equations = assemble_equations(scene, BASIS)
    q = np.random.default_rng(seed).normal(size=equations.size) * 1e-3
    w = surface(scene, BASIS, q)
    return SimpleNamespace(scene=scene, q=q, pencil=equations.steady(), surface=w, strip=sample(scene, w))


def test_strain_energy_of_a_tapered_strip(tapered):
    found = tapered.q @ tapered.pencil.K0 @ tapered.q
    assert found == pytest.approx(tapered.strip.strain, rel=1e-5)  # differences


def test_kinetic_energy_with_a_body_that_moves_as_the_mean_over_the_width(tapered):
    strip, tip, L = tapered.strip, TAPERED.tip, np.full(14, TAPERED.length)
    y = t * float(TAPERED.section.width(1.0)) / 2
    mean = weights @ tapered.surface(L, y) / 2
    inboard = y * float(TAPERED.section.width(1 - STEP / TAPERED.length) / TAPERED.section.width(1.0))
    slope = weights @ (tapered.surface(L, y) - tapered.surface(L - STEP, inboard)) / 2 / STEP
    twist = weights @ (tapered.surface(L, y + STEP) - tapered.surface(L, y - STEP)) / (4 * STEP)
    body = tip.mass * (mean + tip.offset * slope) ** 2 + tip.inertia * slope**2 + tip.axial_inertia * twist**2
    found = tapered.q @ tapered.pencil.M @ tapered.q
    assert found == pytest.approx(strip.area @ (strip.rho_h * strip.w**2) + body, rel=1e-4)  # difference


def test_energy_and_load_of_rotation(tapered):
    """By forces on the area: r - (a.r) a of a point r, about the axis of rotation a."""
    alone = replace(tapered.scene, beam=replace(tapered.scene.beam, tip=None))
    strip, q, L, mount = tapered.strip, tapered.q, TAPERED.length, tapered.scene.mount
    cone = math.cos(mount.precone)
    a1, a2 = cone * math.sin(mount.bending_angle), cone * math.cos(mount.bending_angle)
    outboard = strip.x[:, None] + (L - strip.x)[:, None] / 2 * (1 + t)
    section = TAPERED.section.width(outboard / L) * TAPERED.section.thickness(outboard / L)
    pulled = cone * 0.2 + cone**2 * outboard  # the radius lies in the plane of rotation
    T = 7850.0 * (section * pulled) @ weights * (L - strip.x) / 2 / strip.b
    N = strip.rho_h * (1 - a2**2) * (strip.b**2 / 4 - strip.y**2) / 2
    expected = strip.area @ (T * strip.w_x**2 + N * strip.w_y**2 - (1 - a1**2) * strip.rho_h * strip.w**2)
    pencil = assemble_equations(alone, BASIS).steady()
    assert q @ pencil.K2 @ q == pytest.approx(expected, rel=1e-5)  # differences
    sine = math.sin(mount.precone)
    root = -0.2 * sine * math.sin(mount.bending_angle)  # of the radius in the direction of bending
    force = root - a1 * (sine * strip.x + a2 * strip.y)
    assert pencil.f2 @ q == pytest.approx(strip.area @ (strip.rho_h * force * strip.w), rel=1e-9)  # rounding


def test_strain_at_the_root_is_that_of_a_section_that_the_clamp_keeps_flat(thin):
    """Under a uniform slow acceleration: half the thickness times the curvature of the mean at the root."""
    scene = bd.Scene(strip((0.05, 0.01, 0.0002), 0.3), physics=PLATE, damping_ratio=0.01)
    slow = {"frequencies": [0.01], "discretization": bd.Ritz(8)}
    strain = bd.frequency_response(scene, 0.0, output="root strain", **slow).response
    equations = assemble_equations(scene, bd.Ritz(8))
    deflection = np.linalg.solve(equations.matrices[0]["unity"], equations.P(0))
    curvature = equations.deflection(np.zeros(1), 2)[:, 0] @ deflection / 0.05**2
    by_forces = 7850.0 * 0.01 * 0.0002 * 0.05**2 / 2 / (200e9 * 0.01 * 0.0002**3 / 12) * (1 - 0.3**2)
    assert np.abs(strain).ravel()[0] == pytest.approx(0.0001 * by_forces, rel=1e-4)
    assert curvature == pytest.approx(by_forces, rel=0.03)  # at the corners it converges slowly


LEANING = bd.Mount(0.215, OUT, math.pi / 2, precone=0.3)  # rotation presses on the strip


@pytest.mark.parametrize("planes", [1, 2])
def test_loads_along_the_span_without_poissons_ratio_are_those_of_the_beam(planes):
    beam = strip((0.05, 0.01, 0.0002), 0.0)
    asked = {"at": [0.0, 0.015, 0.035], "discretization": bd.Ritz(10)}
    plain, plate = (
        bd.static_loads(bd.Scene(beam, LEANING, physics=physics), [20.0], **asked)
        for physics in (bd.Physics(planes=planes), replace(PLATE, planes=planes))
    )
    for name in ("force", "moment", "curvature", "strain"):
        expected = getattr(plain, name)
        scale = np.abs(expected).max()
        np.testing.assert_allclose(getattr(plate, name), expected, rtol=0, atol=1e-9 * scale)  # rounding


def test_loads_along_the_span_of_a_strip():
    """The moment is that of the forces, the curvature that of the mean over the width."""
    scene = bd.Scene(strip((0.05, 0.01, 0.0002), 0.3), LEANING, physics=PLATE)
    stations = np.array([0.0, 0.02, 0.1, 0.3, 0.6])
    found = bd.static_loads(scene, [20.0], at=0.05 * stations, discretization=bd.Ritz(16))
    equations = assemble_equations(scene, bd.Ritz(16))
    pencil = equations.steady()
    q = np.linalg.solve(pencil.K0 + 400.0 * pencil.K2, 400.0 * pencil.f2)
    curvature = equations.deflection(stations, 2).T @ q / 0.05**2
    moment, EI = found.moment[0, :, 0], 200e9 * 0.01 * 0.0002**3 / 12
    assert found.curvature[0, 1:, 0] == pytest.approx(curvature[1:], rel=2e-3)  # of the displacements
    assert found.curvature[0, 0, 0] == pytest.approx(moment[0] / EI * (1 - 0.09), rel=6e-3)  # thick by 2 %
    assert found.curvature[0, 4, 0] == pytest.approx(moment[4] / EI, rel=1e-2)  # (b/(L - x))^2/30
    pull = found.force[0, :, 0] / (200e9 * 0.01 * 0.0002)
    assert found.strain[0, :, 1] == pytest.approx(pull - 0.0001 * found.curvature[0, :, 0], rel=1e-9)  # sum
    plain = bd.static_loads(replace(scene, physics=bd.Physics()), [20.0], at=0.05 * stations)
    assert moment == pytest.approx(plain.moment[0, :, 0], rel=2e-2)  # stiffer by 1.3 %, so that it bends less


def test_loads_along_the_span_refuse_a_tapered_width():
    scene = bd.Scene(strip((0.05, Polynomial([0.01, -0.002]), 0.0002), 0.3), bd.Mount(0.2), physics=PLATE)
    with pytest.raises(ValueError, match=r"physics\.camber.*only if the width is constant"):
        bd.static_loads(scene, [10.0])


def test_a_square_section_has_no_propeller_moment():
    """Its mass is spread alike in both directions: rotation does not turn it to its plane."""
    square, first = strip((0.1, 0.02, 0.02), 0.3), []
    for bending in (0.0, math.pi / 2):
        scene = bd.Scene(square, bd.Mount(0.2, OUT, bending), physics=PLATE)
        equations = assemble_equations(scene, BASIS)
        space = BASIS.spaces(scene.modelled_beam).functions(CLAMPED)
        twist = equations.blocks["torsion"].start + np.arange(space.size)  # of the first function across
        first.append(equations.steady().K2[np.ix_(twist, twist)])
    np.testing.assert_allclose(first[0], first[1], rtol=0, atol=1e-12 * np.abs(first[0]).max())  # rounding


def test_rotation_does_not_twist_a_square_section():
    """Both its moments of inertia are the same: on rigid twist the load has no moment about the axis."""
    mount, physics = bd.Mount(0.1, OUT, 0.7), bd.Physics(torsion=True)
    loads = []
    for width in (0.01, 0.02):
        scene = bd.Scene(strip((0.1, width, 0.01), 0.3), mount, physics=physics)
        equations = assemble_equations(scene, bd.Ritz(5))
        space = bd.Ritz(5).spaces(scene.modelled_beam).functions(CLAMPED)
        rigid = equations.blocks["torsion"].start + np.arange(space.size)  # of the first function across
        loads.append(np.abs(equations.steady().f2[rigid]).max())
    assert loads[0] < 1e-12 * loads[1]  # rounding


def test_stress_along_the_span_is_in_balance_with_the_moment():
    """Where the clamp hinders camber the strain is less, but not the stress: M c/I at every station."""
    scene = bd.Scene(strip((0.05, 0.01, 0.0002), 0.3), bd.Mount(0.0, OUT), gravity=9.81, physics=PLATE)
    found = bd.static_loads(scene, 0.0, at=[0.0, 0.005, 0.0475])
    by_moment = found.moment[0, :, 0] * 0.0001 / (0.01 * 0.0002**3 / 12)
    pull = found.force[0, :, 0] / (0.01 * 0.0002)
    assert found.stress[0, :, 1] == pytest.approx(pull - by_moment, rel=1e-9)  # a sum
    assert abs(found.strain[0, 0, 1] * 200e9 / found.stress[0, 0, 1]) == pytest.approx(0.91, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("elements", [40, 80])
def test_stated_errors_of_elements_count_the_functions_across(elements):
    scene = bd.Scene(strip((0.05, 0.01, 0.0002), 0.3), bd.Mount(0.215), physics=PLATE)
    true = bd.natural_modes(scene, 20.0, 4, discretization=bd.Ritz(18)).frequency
    found = bd.natural_modes(scene, 20.0, 4, discretization=bd.Fem(elements))
    assert (np.abs(found.frequency / true - 1) <= found.error).all() and (found.error < 1e-3).all()


def test_a_fast_outward_strip_keeps_its_section():
    """Layers at the root split its properties, which are still those of the rectangle."""
    tape = strip((0.5, 0.02, 0.0001), 0.3)
    scene = bd.Scene(tape, bd.Mount(0.1, OUT), physics=PLATE)
    assert bd.natural_modes(scene, 80.0).frequency[0] > bd.natural_modes(scene, 40.0).frequency[0]
    plain = bd.natural_modes(replace(scene, physics=bd.Physics()), 80.0)
    assert plain.left_out["camber of sections"][0] > 0


def test_many_modes_of_a_strip_are_resolved():
    """Bases grow along the strip until they suffice, as at most 16 functions stand across."""
    scene = bd.Scene(strip((0.5, 0.03, 0.012), 0.3), physics=bd.Physics(camber=True))
    many, few = (bd.natural_modes(scene, modes=modes) for modes in (15, 6))
    assert many.error.max() < 1e-3
    assert (np.abs(many.frequency[:6] / few.frequency - 1) <= many.error[:6] + few.error).all()


def test_modes_that_are_not_listed_are_said_of_loaded_results_too(tmp_path):
    modes = bd.natural_modes(bd.Scene(strip((0.05, 0.01, 0.0002), 0.3)))
    said = modes.left_out_effects.sentence()
    assert "modes not listed: torsion 656 Hz" in said
    modes.save(tmp_path / "modes.json")
    assert bd.load(tmp_path / "modes.json").left_out_effects.sentence() == said


def test_the_error_of_a_response_has_a_part_by_functions_across(monkeypatch):
    """Meshes differ along the strip alone, as do bases with the most functions across: here 6."""
    strip = bd.Beam.rectangular(0.5, 0.1, 0.01, poissons_ratio=0.3, **STEEL)
    scene = bd.Scene(strip, bd.Mount(0.1, OUT, 0.3), damping_ratio=0.01, physics=bd.Physics(camber=True))
    ask = {"speed": 60.0, "frequencies": [25.0, 60.0], "modes": 4}
    best = bd.frequency_response(scene, **ask, discretization=bd.Ritz(16))
    monkeypatch.setattr("beamdyn.equations.ritz._MOST_ACROSS", 6)
    found = bd.frequency_response(scene, **ask, discretization=bd.Ritz(14))
    assert (np.abs(found.response - best.response) <= found.error + best.error).all()
    assert found.error.max() < 1e-2 * np.abs(found.response).max()
    small = bd.frequency_response(scene, **ask, discretization=bd.Ritz(5))  # without a basis that is narrower
    assert (np.abs(small.response - best.response) <= small.error + best.error).all()


def test_a_factor_of_the_bending_stiffness_multiplies_that_of_the_plate():
    """At rest all frequencies, also those of torsion, are as the square root of the stiffness."""
    strip = bd.Beam.rectangular(0.05, Polynomial([0.012, -0.006]), 0.0002, **STEEL, poissons_ratio=0.3)
    scene = bd.Scene(strip, physics=PLATE)
    soft, stiff = (
        bd.natural_modes(with_numbers(scene, {"beam.scale.bending_stiffness": factor}), modes=5)
        for factor in (1.0, 4.0)
    )
    assert stiff.frequency == pytest.approx(2 * soft.frequency, rel=1e-10)  # rounding


@pytest.mark.slow
def test_frequencies_with_automatic_physics_do_not_jump_where_a_factor_is_one():
    strip = bd.Beam.rectangular(0.05, Polynomial([0.012, -0.006]), 0.0002, **STEEL, poissons_ratio=0.3)
    scene = bd.Scene(strip, bd.Mount(0.215), physics="auto")
    study = bd.study(scene, {"beam.scale.bending_stiffness": [1 - 1e-6, 1.0, 1 + 1e-6]}, modes=1)
    below, at, above = study.value.ravel()
    assert at == pytest.approx((below + above) / 2, rel=1e-9)  # a smooth function: a second difference
    assert above / below - 1 == pytest.approx(1e-6, rel=0.01)  # half of the stiffness' change


@pytest.mark.parametrize(
    "width", [lambda x: 0.03 * np.exp(-0.3 * x), bd.Table([0, 0.5, 1], [0.03, 0.018, 0.006])]
)
def test_smooth_widths_however_they_are_given(width):
    """An exponential one has a constant relative slope; stations of a straight taper are no kinks."""
    strip = bd.Beam.rectangular(0.5, width, 0.0025, **STEEL, poissons_ratio=0.3)
    found = bd.natural_modes(bd.Scene(strip, bd.Mount(0.1, OUT), physics=bd.Physics(torsion=True)), 10.0, 12)
    assert (found.error < 1e-4).all()


def test_a_straight_beam_with_camber_heeds_no_branch():
    strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, **STEEL, poissons_ratio=0.3)
    of_branch, plain = (
        bd.natural_modes(bd.Scene(strip, physics=bd.Physics(camber=True, branch=branch)), modes=1)
        for branch in ("bent", "straight")
    )
    assert of_branch.frequency == plain.frequency


def test_factors_that_cancel_leave_the_rectangle_as_it_is():
    strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, **STEEL, poissons_ratio=0.3)
    scene = bd.Scene(strip)
    for factor in (1.1, 1 / 1.1):
        scene = with_numbers(scene, {"beam.scale.bending_stiffness": factor})
    assert scene.beam.section == strip.section
