"""Mode shapes of strips over their area."""

from dataclasses import replace

import meshio
import numpy as np
import pytest
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss

import beamdyn as bd
from beamdyn.common.results.pictures import figure_of
from beamdyn.equations.assembly import assemble_equations

PLATE = bd.Physics(camber=True, torsion=True)
BASIS = bd.Ritz(8)
MOUNT = bd.Mount(0.215)
TAPER = Polynomial([0.012, -0.006])  # width [m] over x/L
X = np.linspace(0, 0.05, 7)
ETA = np.linspace(-1, 1, 5)


def strip(nu=0.3, width: float | Polynomial = 0.01):
    beam = bd.Beam.rectangular(0.05, width, 0.0002, 200e9, 7850.0, poissons_ratio=nu)
    return bd.Scene(beam, MOUNT, physics=PLATE)


@pytest.fixture(scope="module")
def modes():
    return bd.natural_modes(strip(), speed=50.0, modes=4, discretization=BASIS)


def test_the_mean_over_the_width_is_the_shape(modes):
    eta, weights = leggauss(12)
    mean = modes.surface(X, eta) @ weights / 2
    np.testing.assert_allclose(mean, modes.shape(X), rtol=0, atol=1e-12 * np.abs(modes.tip).max())  # rounding


def test_edges_and_axis_are_sums_of_the_functions(modes):
    """Legendre polynomials are 1 or -1 at the edges; those of odd order vanish on the axis."""
    equations, xi = modes.model.equations, X / 0.05
    along = equations.deflections["bending"].space.evaluate(xi)
    edge, axis = 0.0, 0.0
    for name, numbers in {"bending": [0], "torsion": range(1, 40, 2), "camber": range(2, 40, 2)}.items():
        of_each = modes.vectors[equations.blocks[name]].T.reshape(4, -1, len(along))
        for k, q in zip(numbers, of_each.transpose(1, 0, 2), strict=False):
            at_edges, on_axis = np.array([(-1) ** k, 1]), np.polynomial.Legendre.basis(k)(0.0)
            u = np.sqrt(2 * k + 1) * q @ along
            edge, axis = edge + u[:, :, None] * at_edges, axis + u * on_axis
    found = modes.surface(X, [-1.0, 0.0, 1.0])
    size = 1e-12 * np.abs(found).max()  # rounding
    np.testing.assert_allclose(found[:, :, [0, 2]], edge, rtol=0, atol=size)
    np.testing.assert_allclose(found[:, :, 1], axis, rtol=0, atol=size)


def test_without_poissons_ratio_bending_is_that_of_the_beam():
    scene = strip(nu=0.0)
    plain = bd.natural_modes(replace(scene, physics=bd.Physics()), 100.0, 3, discretization=bd.Ritz(14))
    found = bd.natural_modes(scene, 100.0, 4, discretization=bd.Ritz(14))
    beam = np.repeat(plain.shape(X)[:, :, None], len(ETA), axis=2)
    np.testing.assert_allclose(found.surface(X, ETA)[found.kind == "bending"], beam, rtol=0, atol=1e-7)
    np.testing.assert_allclose(plain.surface(X, ETA), beam, rtol=1e-12)  # rounding


@pytest.mark.parametrize("width", [0.01, TAPER])
def test_the_modal_mass_is_one(width):
    """By quadrature of rho t w^2 over the area; torsion has the rotary inertia of the thickness beside it."""
    modes = bd.natural_modes(strip(width=width), modes=4, discretization=BASIS)
    (s, of_x), (eta, of_eta) = leggauss(60), leggauss(20)
    x = 0.025 * (1 + s)
    b = TAPER(x / 0.05) if width is TAPER else np.full(60, width)
    area = np.outer(0.025 * of_x * b / 2, of_eta)
    mass = 7850.0 * 0.0002 * (area * modes.surface(x, eta) ** 2).sum(axis=(1, 2))
    np.testing.assert_allclose(mass, 1.0, rtol=1e-3)  # rho t^3/12 times the squared twist


OBLIQUE = replace(strip(), mount=bd.Mount(0.215, np.pi, bending_angle=0.5))


def static_tip(speed):
    """Static deflection of the tip at eta -1, 0, 1, of the strip that stands obliquely."""
    equations = assemble_equations(OBLIQUE, BASIS)
    pencil = equations.steady()
    q = np.linalg.solve(pencil.K0 + speed**2 * pencil.K2, speed**2 * pencil.f2)
    return np.tensordot(q, equations.surface(np.ones(1), np.array([-1.0, 0.0, 1.0])), 1)[0]


def test_rotation_turns_an_oblique_strip_into_its_plane():
    """The point at eta = 1, -sin(psi) b2 + cos(psi) b3 from the axis, thus moves against the bending."""
    left, axis, right = static_tip(50.0)
    assert right < axis < left


# Pictures and files -------------------------------------------------------------------------------------


def test_torsion_and_camber_are_positive_at_the_corner_across():
    square = replace(strip(), beam=bd.Beam.rectangular(0.05, 0.05, 0.0002, 200e9, 7850.0, poissons_ratio=0.3))
    modes = bd.natural_modes(square, modes=6, discretization=BASIS)
    corner = modes.surface([0.05], [1.0])[:, 0, 0]
    assert (corner[modes.kind != "bending"] > 0).all() and (modes.tip[modes.kind == "bending"] > 0).all()


def test_the_mesh_has_the_outline_of_the_strip():
    modes = bd.natural_modes(strip(width=TAPER), modes=3, discretization=BASIS)
    x, y, shapes, across = modes.mesh(6, 3)
    np.testing.assert_allclose(y, np.outer(TAPER(x / 0.05), [-0.5, 0.0, 0.5]), rtol=1e-15, atol=1e-18)
    np.testing.assert_array_equal(
        shapes, modes.surface(x, [1.0, 0.0, -1.0])
    )  # y is against the direction across
    assert not across.any()


def test_beams_have_no_mesh():
    assert bd.natural_modes(replace(strip(), physics=bd.Physics())).mesh() is None


@pytest.mark.parametrize(("count", "rows"), [(1, 1), (3, 3), (8, 4)])
def test_each_mode_is_drawn_to_scale_in_a_panel_of_its_own(count, rows):
    modes = bd.natural_modes(strip(), modes=count, discretization=BASIS)
    figure = figure_of(modes.plot)
    panels = [ax for ax in figure.axes if ax.get_title()]
    assert [ax.get_title() for ax in panels] == modes.labels()
    assert {ax.get_subplotspec().get_gridspec().nrows for ax in panels} == {rows}
    assert {ax.get_aspect() for ax in panels} == {1.0}


def test_a_mode_in_the_direction_across_displaces_the_outline():
    scene = replace(strip(), physics=replace(PLATE, planes=2))
    modes = bd.natural_modes(scene, modes=7, discretization=BASIS)
    panels = [ax for ax in figure_of(modes.plot).axes if ax.get_title()]
    outlines = [np.asarray(ax.lines[0].get_ydata()) for ax in panels]
    sideways = modes.plane_share[:, 1] > 0.5
    moved = [abs(y.max() + y.min()) > 1e-6 for y in outlines]
    assert moved == sideways.tolist() and any(moved)


def test_files_for_paraview_have_the_surface(tmp_path, modes):
    modes.export(tmp_path / "strip.vtu")
    mesh = meshio.read(tmp_path / "strip.vtu")
    assert list(mesh.point_data) == modes.labels()
    assert np.ptp(mesh.points, axis=0) == pytest.approx([0.05, 0.01, 0.0])
    twist, points = mesh.point_data[modes.labels()[2]], mesh.points
    x, eta = np.unique(points[:, 0].round(9)), np.unique((-points[:, 1] / 0.005).round(9))
    surface = modes.surface(x, eta)[2]
    expected = 0.005 * surface / np.abs(surface).max()
    at = np.searchsorted(x, points[:, 0].round(9)), np.searchsorted(eta, (-points[:, 1] / 0.005).round(9))
    np.testing.assert_allclose(twist[:, 2], expected[at], rtol=0, atol=1e-9)  # rounded places


def test_files_for_paraview_have_both_directions(tmp_path):
    """Each mode is a tenth of the length along z or along y, as it bends."""
    modes = bd.natural_modes(replace(strip(), physics=bd.Physics(planes=2)), modes=6)
    modes.export(tmp_path / "beam.vtu")
    fields, sideways = meshio.read(tmp_path / "beam.vtu").point_data.values(), modes.plane_share[:, 1] > 0.5
    for field, across in zip(fields, sideways, strict=True):
        assert np.abs(field).max(axis=0) == pytest.approx([0, 0.005 * across, 0.005 * (not across)])
    assert 0 < sideways.sum() < 6


# Motions ------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def run():
    """A strip on a wheel that spins up so slowly that it does not ring."""
    motion = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=2.0))
    return bd.simulate(replace(OBLIQUE, motion=motion), 2.5, 3, discretization=BASIS)


def test_a_strip_that_moves_twists_about_its_mean(run):
    t, (eta, weights) = np.linspace(0.1, 2.5, 5), leggauss(12)
    mean = run.shape(X, t)
    size = 1e-12 * np.abs(mean).max()  # rounding
    np.testing.assert_allclose(run.surface(X, eta, t) @ weights / 2, mean, rtol=0, atol=size)
    left, _, right = run.surface([0.05], [-1.0, 0.0, 1.0], [2.5])[0, 0]
    expected = static_tip(55.0)
    assert right - left == pytest.approx(expected[2] - expected[0], rel=0.05)  # of one mode of torsion


def test_a_strip_that_moves_is_written_as_a_surface(run, tmp_path):
    run.export(tmp_path / "run.xdmf", 0.1, 2.3, frames=3)
    reader = meshio.xdmf.TimeSeriesReader(tmp_path / "run.xdmf")
    points, _ = reader.read_points_cells()
    time, fields, _ = reader.read_data(1)
    assert np.ptp(points, axis=0) == pytest.approx([0.05, 0.01, 0.0])
    rows = points[:, 1].reshape(11, -1)[:, 0] / -0.005
    expected = run.surface(points[:41, 0], rows.clip(-1, 1), [time])[0].T
    np.testing.assert_allclose(fields["displacement"][:, 2].reshape(11, 41), expected, rtol=1e-9, atol=1e-15)


def test_a_beam_that_moves_has_its_deflection_at_every_place_across():
    for physics in (bd.Physics(), bd.Physics(large_deflection=True)):
        motion = bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=0.2))
        run = bd.simulate(bd.Scene(strip().beam, MOUNT, motion, physics=physics), 0.3, 2)
        surface = run.surface(X, [-1.0, 0.0], [0.3])
        np.testing.assert_allclose(surface[0].T, [run.shape(X, [0.3])[0]] * 2, rtol=1e-12)
