"""Offsets of sections: terms against point masses on a beam that is turned exactly; closed forms."""

import math
from functools import cache

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations
from beamdyn.equations.discretization import CLAMPED, FIXED, ArcQuadrature, Cells
from beamdyn.equations.fields.transverse import axis_in_section

BASIS, LENGTH = bd.Ritz(2), 2.0
MASS, TWIST = Polynomial([3.0, -1.5]), Polynomial([0.4, -0.7])
OFFSET = Polynomial([0.05, 0.12])  # beside the shear centre, at a scale of 1 [m]
TIP = {"mass": 0.7, "offset": 0.3, "inertia": 1e-9, "axial_inertia": 2e-9}
ARC = ArcQuadrature(Cells(np.array([0.0, 1.0]), 16))
STEP = 2e-4  # of second differences, whose error is below 1e-7


def scene_of(scale: float, of: str = "mass") -> bd.Scene:
    """A blade with precone and tip body, whose offsets have a scale; its sections are slender."""
    beam = bd.Beam.from_stiffness(
        LENGTH,
        MASS,
        90.0,
        second_bending_stiffness=200.0,
        twist=TWIST,
        torsion_stiffness=40.0,
        rotary_inertia=1e-9,
        second_rotary_inertia=1e-9,
        tip=bd.TipMass(**TIP, offset_across=scale * 0.1 if of == "mass" else 0.0),
        **{f"{of}_offset": scale * OFFSET},
    )
    mount = bd.Mount(1.0, math.pi, bending_angle=0.6, precone=0.25)
    return bd.Scene(beam, mount, gravity=1.0, physics=bd.Physics(planes=2, torsion=True))


@cache
def assembled(scale: float, of: str = "mass"):
    return assemble_equations(scene_of(scale, of), BASIS)


# Point masses on a beam that is turned exactly --------------------------------------------------------


@cache
def samples():
    """Gauss points and tip, and the functions of bending and of torsion there with their derivatives."""
    xi, spaces = np.append(ARC.xi, 1.0), BASIS.spaces(scene_of(1.0).modelled_beam)
    bending, twisting = spaces.functions(CLAMPED), spaces.functions(FIXED)
    return xi, [bending.evaluate(xi, k) for k in range(3)], [twisting.evaluate(xi, k) for k in range(2)]


def places(q: np.ndarray, scale: float, of: str) -> np.ndarray:
    """Places (3, N + 1) along b1, e1, e2 of the masses at the Gauss points and of the body at the tip."""
    (xi, bending, twisting), fields = samples(), assembled(scale, of).blocks
    both = [q[fields[name]] for name in ("bending", "second bending")]
    slope, curve = (np.array([part @ bending[order] for part in both]) / LENGTH**order for order in (1, 2))
    theta, rate = (q[fields["torsion"]] @ twisting[order] / LENGTH**order for order in (0, 1))
    # The tilt that does not turn about the tangent, which turns nevertheless as it changes.
    cosine = np.sqrt(1 - (slope**2).sum(axis=0))
    turning = (slope[0] * curve[1] - slope[1] * curve[0]) / (1 + cosine)
    turn = -theta + LENGTH * ARC.integrate(turning[:-1])
    tilt = _tilt(slope, cosine)
    rotation = tilt @ _about_axis(turn)
    # Curvature along the axes of the section: of the tilt, then turned back.
    bent = _curvature_of_tilt(slope, curve, cosine)
    bent = np.einsum("nji,nj->ni", _about_axis(turn), bent)
    beta = TWIST(xi)
    across = np.stack([np.zeros_like(beta), -np.sin(beta), np.cos(beta)], axis=1)
    moved = scale * OFFSET(xi)[:, None] * across
    of_mass, of_tension = (moved, 0 * moved) if of == "mass" else (0 * moved, moved)
    along = 1 - np.cross(bent, of_tension)[:, 0] - rate**2 * (of_tension**2).sum(axis=1) / 2
    tangent = rotation[:, :, 0] * along[:, None]
    axis = LENGTH * ARC.integrate(tangent[:-1].T)
    of_mass[-1] = np.array([TIP["offset"], 0.0, 0.0]) + (scale * 0.1 if of == "mass" else 0.0) * across[-1]
    return axis + np.einsum("nij,nj->in", rotation, of_mass)


def _tilt(slope: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    """Rotations (N, 3, 3) that take b1 to the tangent by the shortest way (Rodrigues)."""
    w = np.stack([np.zeros_like(cosine), -slope[1], slope[0]])
    W = np.zeros((len(cosine), 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        W[:, j, i], W[:, i, j] = w[k], -w[k]
    return np.eye(3) + W + W @ W / (1 + cosine)[:, None, None]


def _about_axis(angle: np.ndarray) -> np.ndarray:
    """Rotations (N, 3, 3) about b1."""
    c, s, R = np.cos(angle), np.sin(angle), np.zeros((len(angle), 3, 3))
    R[:, 0, 0], R[:, 1, 1], R[:, 2, 2], R[:, 1, 2], R[:, 2, 1] = 1.0, c, c, -s, s
    return R


def _curvature_of_tilt(slope: np.ndarray, curve: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    """Curvature (N, 3) of the tilt in its own axes, without the turn about b1, by differences along x."""
    h, found = 1e-5, np.zeros((len(cosine), 3))
    after, before = (
        _tilt(near, np.sqrt(1 - (near**2).sum(axis=0))) for near in (slope + h * curve, slope - h * curve)
    )
    spin = np.swapaxes(_tilt(slope, cosine), 1, 2) @ (after - before) / (2 * h)
    found[:, 1], found[:, 2] = spin[:, 0, 2], spin[:, 1, 0]
    return found


@cache
def by_differences(scale: float, of: str):
    """Displacements to first (n, 3, N) and second order (n, n, 3, N), places and weights of the masses."""
    n, at_rest = assembled(scale).size, places(np.zeros(assembled(scale).size), scale, of)
    unit = STEP * np.eye(n)
    first = np.array([(places(e, scale, of) - places(-e, scale, of)) / (2 * STEP) for e in unit])
    second = np.zeros((n, n, *at_rest.shape))
    for a in range(n):
        for b in range(a + 1):
            signs = [(i, j) for i in (1, -1) for j in (1, -1)]
            values = [i * j * places(i * unit[a] + j * unit[b], scale, of) for i, j in signs]
            second[a, b] = second[b, a] = sum(values) / (4 * STEP**2)
    weights = np.append(MASS(ARC.xi) * ARC.weights * LENGTH, TIP["mass"])
    return first, second, at_rest, weights


@cache
def work(scale: float, of: str) -> dict[tuple[str, int], np.ndarray]:
    """Matrices of each quantity and order, from the work of the accelerations of all masses."""
    first, second, r, mass = by_differences(scale, of)
    a = np.array([math.sin(0.25), *axis_in_section(scene_of(scale))])
    B, P = -np.cross(a, np.eye(3)).T, np.eye(3) - np.outer(a, a)

    untilted = first.copy()  # without what a tilt moves along the beam
    untilted[: assembled(scale).blocks["torsion"].start, 0] = 0.0

    def moving(matrix):
        return np.einsum("ain,ij,bjn,n->ab", first, matrix, first, mass)

    def turning(matrix):
        return np.einsum("ain,ij,bjn,n->ab", untilted, matrix, untilted, mass)

    def carried(field):
        return np.einsum("abin,in,n->ab", second, field, mass)

    found = {("unity", 2): moving(np.eye(3)), ("speed", 1): 2 * turning(B)}
    found["acceleration", 0] = turning(B) + carried(B @ r)
    found["speed_squared", 0] = moving(-P) + carried(-P @ r)
    for name, unit in zip(("root_axial", "root_transverse", "root_across"), np.eye(3), strict=True):
        found[name, 0] = carried(np.repeat(unit[:, None], r.shape[1], axis=1))
    return found


OF_FORCES = [("root_axial", 0), ("root_transverse", 0), ("root_across", 0)]
QUANTITIES = [("unity", 2), ("speed", 1), ("acceleration", 0), ("speed_squared", 0), *OF_FORCES]


@pytest.mark.parametrize(
    ("of", "quantity", "order"),
    [*(("mass", *each) for each in QUANTITIES), *(("tension", *each) for each in OF_FORCES)],
)
def test_terms_are_the_work_of_point_masses(of, quantity, order):
    """To first order in the offsets: the odd part, as all are at most of second order.

    Forces alone act on centres of tension, as the inertia of tilting takes these to be on a straight line.
    Coriolis and Euler forces of tilting masses are left out.
    """

    def odd(matrices):
        return (matrices(1.0) - matrices(-1.0)) / 2

    def ours(scale):
        return assembled(scale, of).matrices[order][quantity]

    expected = odd(lambda scale: work(scale, of)[quantity, order])
    scale = np.abs(work(1.0, of)[quantity, order]).max()
    np.testing.assert_allclose(odd(ours), expected, rtol=0, atol=1e-6 * scale)  # of differences
    assert np.abs(expected).max() > 1e-3 * scale


@pytest.mark.parametrize(
    ("of", "quantity", "order"),
    [("mass", "unity", 2), ("mass", "speed_squared", 0), ("tension", "speed_squared", 0)],
)
def test_second_moments_are_about_the_axis(of, quantity, order):
    """In torsion: the even part, but for that without offsets."""

    def even(matrices):
        return (matrices(1.0) + matrices(-1.0)) / 2 - matrices(0.0)

    turn = assembled(1.0).blocks["torsion"]
    ours = even(lambda scale: assembled(scale, of).matrices[order][quantity])[turn, turn]
    expected = even(lambda scale: work(scale, of)[quantity, order])[turn, turn]
    np.testing.assert_allclose(ours, expected, rtol=0, atol=1e-6 * np.abs(expected).max())  # of differences


# Uniform beams ----------------------------------------------------------------------------------------


def uniform(radius_of_gyration=0.06, offset=0.02, **given):
    """A beam of 1 m that bends out of the plane of rotation and twists; its sections are flat."""
    torsion = {"torsion_stiffness": 4.0, "rotary_inertia": 1e-12, "mass_offset": offset}
    inertia = 2.0 * radius_of_gyration**2
    return bd.Beam.from_stiffness(1.0, 2.0, 30.0, second_rotary_inertia=inertia, **(torsion | given))


def outward(beam, radius=0.3, planes=1):
    mount = bd.Mount(radius, math.pi, math.pi / 2)
    return bd.Scene(beam, mount, physics=bd.Physics(planes=planes, torsion=True))


def by_collocation(speed, count, radius=0.3, points=22):  # with more, rounding takes over
    """Frequencies [Hz] by the differential equations of Houbolt and Brooks (1958), NACA Report 1346.

    Without twist, with the centre of mass at e = 0.02 m and that of tension on the elastic axis, at points of
    Chebyshev and the angular frequency f:
    (EI w'')'' - (T w')' - omega^2 (m x e theta)' = f^2 m (w + e theta) and
    -((GJ + T k^2) theta')' + omega^2 m ((k^2 + e^2) theta + x e w') = f^2 m (e w + (k^2 + e^2) theta).
    """
    EI, GJ, m, e, k2 = 30.0, 4.0, 2.0, 0.02, 0.06**2
    D, x = _chebyshev(points)
    n, r = points + 1, radius + x
    T, T1 = speed**2 * m * ((radius + 1) ** 2 - r**2) / 2, -(speed**2) * m * r
    one, D2 = np.eye(n), D @ D
    K, M = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    w, t = slice(0, n), slice(n, 2 * n)
    K[w, w] = EI * D2 @ D2 - T[:, None] * D2 - T1[:, None] * D
    K[w, t] = -(speed**2) * m * e * (one + r[:, None] * D)
    K[t, w] = speed**2 * m * e * r[:, None] * D
    K[t, t] = -(GJ + T * k2)[:, None] * D2 - (T1 * k2)[:, None] * D + speed**2 * m * (k2 + e**2) * one
    M[w, w], M[w, t], M[t, w], M[t, t] = m * one, m * e * one, m * e * one, m * (k2 + e**2) * one
    tip, root = 0, n - 1
    at_tip = EI * (D2 @ D)[tip]  # shear force: with the inertia load of the offset mass
    conditions = {root: (one[root], None), root - 1: (D[root], None), tip: (D2[tip], None)}
    conditions[1] = (at_tip, -(speed**2) * m * e * r[tip] * one[tip])
    for row, (of_w, of_t) in conditions.items():
        K[row], M[row] = 0.0, 0.0
        K[row, w] = of_w
        if of_t is not None:
            K[row, t] = of_t
    for row, of_t in ((n + root, one[root]), (n + tip, D[tip])):
        K[row], M[row] = 0.0, 0.0
        K[row, t] = of_t
    mu = np.linalg.eigvals(np.linalg.solve(K, M))
    squares = np.sort(1 / mu[np.abs(mu) > 1e-9 * np.abs(mu).max()].real)
    return np.sqrt(squares[squares > 0][:count]) / (2 * math.pi)


def _chebyshev(n):
    """Differentiation matrix and points on [0, 1], from the tip (Trefethen 2000)."""
    x = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.array([2.0, *np.ones(n - 1), 2.0]) * (-1.0) ** np.arange(n + 1)
    X = x[:, None] - x[None, :]
    D = np.outer(c, 1 / c) / (X + np.eye(n + 1))
    return 2 * (D - np.diag(D.sum(axis=1))), (x + 1) / 2


@pytest.mark.parametrize("speed", [0.0, 30.0])
def test_rotating_beam_by_the_equations_of_houbolt_and_brooks(speed):
    found = bd.natural_modes(outward(uniform()), speed, 5).frequency
    np.testing.assert_allclose(found, by_collocation(speed, 5), rtol=1e-8)  # of collocation
    assert abs(found[1] / bd.natural_modes(outward(uniform(offset=0.0)), speed, 2).frequency[1] - 1) > 1e-3


def test_offsets_of_zero_change_no_bit():
    plain, zero = (outward(uniform(offset=given), planes=1) for given in (None, 0.0))
    found, expected = (bd.natural_modes(scene, 30.0, 4) for scene in (zero, plain))
    assert found.frequency.tolist() == expected.frequency.tolist() and not zero.beam.has_offsets


def test_what_torsion_leaves_out_is_the_beam_without_offsets():
    """Without torsion the offsets are not in the model: bit by bit, and they are said to be left out."""
    torsion = {"second_bending_stiffness": 70.0, "twist": 0.3}
    beside, on_axis = (uniform(offset=given, tension_offset=given, **torsion) for given in (0.05, 0.0))
    scenes = [
        bd.Scene(beam, bd.Mount(0.3, math.pi), physics=bd.Physics(planes=2)) for beam in (beside, on_axis)
    ]
    found, expected = (bd.natural_modes(scene, 30.0, 3) for scene in scenes)
    assert found.frequency.tolist() == expected.frequency.tolist()
    change = found.left_out_effects.changes["offsets of sections"]
    coupled = bd.Scene(beside, bd.Mount(0.3, math.pi), physics=bd.Physics(planes=2, torsion=True))
    with_them = bd.natural_modes(coupled, 30.0, 4).frequency
    nearest = np.abs(with_them[:, None] / found.frequency - 1 - change).min(axis=0)
    np.testing.assert_allclose(nearest, 0.0, atol=1e-7)  # of one step of inverse iteration
    assert np.abs(change).max() > 1e-3
    assert "offsets of sections" not in bd.natural_modes(coupled, 30.0, 3).left_out_effects.not_modelled
    assert "offsets of sections" in expected.left_out_effects.not_modelled  # none are known


@pytest.mark.parametrize(
    ("physics", "precone", "elements", "error"),
    [({}, 0.0, 24, 1e-6), ({"shear": True}, 0.0, 24, 3e-6), ({"stretch": True}, 0.1, 6, 3e-4)],
)
def test_two_discretizations(physics, precone, elements, error):
    beam = bd.Beam.from_stiffness(
        1.0, 2.0, 30.0, 1e6, second_bending_stiffness=70.0, twist=Polynomial([0.3, -0.5]),
        shear_stiffness=1e4, torsion_stiffness=9.0, rotary_inertia=1e-4, second_rotary_inertia=4e-3,
        mass_offset=Polynomial([0.0, 0.05]), tension_offset=0.01,
        tip=bd.TipMass(0.3, 0.02, 1e-4, 1e-4, 1e-4, offset_across=0.04),
    )  # fmt: skip
    mount = bd.Mount(0.3, math.pi, 1.2, precone=precone)
    scene = bd.Scene(beam, mount, physics=bd.Physics(planes=2, torsion=True, **physics))
    choices = bd.Ritz(10), bd.Fem(elements)
    ritz, fem = (bd.natural_modes(scene, 20.0, 5, each).frequency for each in choices)
    np.testing.assert_allclose(fem, ritz, rtol=error)  # of elements, extrapolated


def test_moments_are_about_the_centre_of_tension():
    """Of a stiff beam: the moment in the plane of centrifugal forces beside the axis, and of the tension."""
    m, L, r, speed, c, t, body, ahead, across = 3.0, 2.0, 1.0, 5.0, 0.05, 0.02, 0.5, 0.1, 0.03
    beam = bd.Beam.from_stiffness(
        L, m, 1e8, second_bending_stiffness=1e8, torsion_stiffness=1e8, rotary_inertia=1e-9,
        second_rotary_inertia=1e-9, mass_offset=c, tension_offset=t,
        tip=bd.TipMass(body, ahead, offset_across=across),
    )  # fmt: skip
    loads = bd.static_loads(outward(beam, r, planes=2), [speed], at=[0.0, 1.0])
    expected = []
    for x in (0.0, 1.0):
        force = m * ((r + L) ** 2 - (r + x) ** 2) / 2 + body * (r + L + ahead)
        expected.append(speed**2 * (force * t - (r + x) * (m * c * (L - x) + body * across)))
    np.testing.assert_allclose(loads.moment[0, :, 1], expected, rtol=1e-5)  # it bends by as much
    np.testing.assert_allclose(loads.moment[0, :, 0], 0.0, atol=1e-6)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"mass_offset": 0.01}, r"mass_offset = 0.01 m at x/L = 0.000: .*needs torsion_stiffness"),
        (
            {"tension_offset": bd.Table((0.0, 0.4, 1.0), (0.0, 0.0, 0.02))},
            r"tension_offset = 0.01 m at x/L = 0.700",
        ),
        (
            {"tip": bd.TipMass(1.0, offset_across=-0.1)},
            r"tip.offset_across = -0.1 m: .*needs torsion_stiffness",
        ),
        ({"mass_offset": math.nan}, r"mass_offset"),
    ],
)
def test_offsets_without_stiffness_against_torsion_are_refused(given, said):
    with pytest.raises(ValueError, match=said):
        bd.Beam.from_stiffness(1.0, 2.0, 30.0, **given)


def test_offsets_in_a_scene_file(tmp_path):
    (tmp_path / "blade.toml").write_text(
        """
        physics = { torsion = true }
        mount = { radius = "0.3 m", setting_angle = "180 deg", bending_angle = "90 deg" }
        [beam]
        length = "1 m"
        bending_stiffness = "30 N m2"
        torsion_stiffness = "4 N m2"
        rotary_inertia = "1e-12 kg m"
        second_rotary_inertia = "0.0072 kg m"
        stations = [
          ["x/L", "mass_per_length [kg/m]", "mass_offset [mm]"],
          [0, 2, 20],
          [1, 2, 20],
        ]
        """
    )
    scene = bd.load_scene(tmp_path / "blade.toml")
    np.testing.assert_allclose(
        bd.natural_modes(scene, 30.0, 3).frequency, by_collocation(30.0, 3), rtol=1e-8
    )  # of collocation


def test_critical_speeds_with_offsets_are_sought():
    """Inward: the tension that buckles the beam acts beside the axis, and twists it as well."""
    beside, on_axis = (
        bd.Scene(
            uniform(offset=c, tension_offset=c),
            bd.Mount(3.0, 0.0, math.pi / 2),
            physics=bd.Physics(torsion=True),
        )
        for c in (0.05, 0.0)
    )
    point = bd.critical_point(beside)
    assert point.speed < 0.999 * bd.critical_speed(on_axis)
    assert abs(bd.natural_modes(beside, point.speed * (1 - 1e-6), 1).frequency[0]) < 2e-2


def test_a_mass_beside_the_axis_diverges_outward():
    """Where a tilt twists the beam, by centrifugal forces, more than it is held; on the axis it is not."""
    assert bd.critical_speed(outward(uniform(offset=0.0))) == math.inf
    far = outward(uniform(offset=0.1))
    found = bd.critical_speed(far)
    assert bd.critical_point(far, bd.Fem(40)).speed == pytest.approx(found, rel=1e-5)  # of elements
    below = bd.natural_modes(far, found * (1 - 1e-6), 1)
    assert below.frequency[0] < 2e-2 and bd.natural_modes(far, 0.5 * found, 1).frequency[0] > 1.0


def test_a_section_tilts_about_its_centre_of_tension():
    """Where the centre of mass is that of tension, the edge frequency is that of a beam without offsets."""
    given = {"second_bending_stiffness": 500.0, "torsion_stiffness": 8.0, "axial_stiffness": 1e8,
             "rotary_inertia": 5e-6, "second_rotary_inertia": 1e-4}  # fmt: skip
    edge = []
    for offsets in ({"mass_offset": 0.02}, {"tension_offset": 0.02}):
        beam = bd.Beam.from_stiffness(0.5, 0.5, 20.0, **given, **offsets)
        scene = bd.Scene(beam, physics=bd.Physics(planes=2, torsion=True))
        edge.append(bd.natural_modes(scene, modes=8).frequency)
    # By Rayleigh-Ritz with u and w of their own, tilting about (c - t)^2: 70.391 and 427.25 Hz in both.
    for frequencies in edge:
        assert np.abs(frequencies / 70.391 - 1).min() < 1e-5 and np.abs(frequencies / 427.25 - 1).min() < 2e-5
