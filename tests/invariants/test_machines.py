"""Brakes pressed by one force: work of friction by quadrature, balance of forces, and limits between them."""

from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.integrate import solve_ivp

from brakes import drum, machines

BAND = machines.Band(0.2, 0.05, 4.0, 0.5, 0.1, 0.02)
DISC = machines.Disc(0.08, 0.12, 1.0, "floating", 0.1)
PLATES = machines.Plates(0.05, 0.07, faces=6)
CONE = machines.Cone(0.15, 0.165, 0.06)
BLOCK = machines.Block(0.15, 0.05, 1.2, 0.6, 0.25, 0.05, "double")
BRAKES = [
    pytest.param(brake.with_law(law) if law else brake, id=f"{type(brake).__name__} {law}")
    for brake in (BAND, DISC, PLATES, CONE, BLOCK)
    for law in brake.laws or ("",)
]
MU, TURN = 0.2, 0.01  # friction, and the angle by which the brake turns [rad]
EXACT = 1e-10


def area(brake, at):
    """Area of a lining for each unit of the place [m2/rad or m], and its distance from the axis [m]."""
    match brake:
        case machines.Disc():
            return brake.pad_angle * at, at
        case machines.Plates():
            return brake.faces * 2 * np.pi * at, at
        case machines.Cone():
            slant = np.hypot(brake.width, brake.outer_radius - brake.inner_radius)
            return 2 * np.pi * at * slant / (brake.outer_radius - brake.inner_radius), at
    return brake.face_width * brake.drum_radius, brake.drum_radius


def integral(brake, values):
    """Quadrature over a lining."""
    x, w = np.polynomial.legendre.leggauss(60)
    low, high = brake.reach()
    at = (low + high) / 2 + (high - low) / 2 * x
    return (high - low) / 2 * np.sum(w * values(at))


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("brake", BRAKES)
def test_work_of_the_torque_is_that_of_the_friction_along_the_lining(brake, reverse):
    if brake.law == "short":
        pytest.skip("all forces of a short block act at one point")
    found = machines.solve_brake(brake, friction=MU, force=300.0, reverse=reverse)

    def work(lining):
        def density(at):
            per_place, r = area(brake, at)
            return MU * lining.peak_pressure * brake.pressure(at, MU) * per_place * r * TURN

        return integral(brake, density)

    assert sum(map(work, found.linings)) == pytest.approx(found.torque * TURN, rel=EXACT)
    assert sum(each.torque for each in found.linings) == pytest.approx(found.torque, rel=EXACT)


@pytest.mark.parametrize("brake", BRAKES)
def test_slope_of_the_brake_factor_is_its_derivative(brake):
    h = 1e-4
    at = MU + h * np.array([-2, -1, 1, 2])
    c = machines.solve_brake(brake, friction=at, force=1.0).c_star
    slope = (c[0] - 8 * c[1] + 8 * c[2] - c[3]) / (12 * h)
    assert machines.solve_brake(brake, friction=MU, force=1.0).c_star_slope == pytest.approx(slope, rel=1e-9)


@pytest.mark.parametrize("reverse", [False, True])
def test_tensions_of_a_band_follow_its_differential_equation(reverse):
    found = machines.solve_brake(BAND, friction=MU, force=100.0, reverse=reverse)
    first, second = (float(found.linings[0].reactions[name]) for name in ("first", "second"))
    slack, tight = sorted((first, second))
    run = solve_ivp(lambda _, t: MU * t, (0, BAND.wrap), [slack], rtol=1e-12, atol=1e-9, method="DOP853")
    assert run.y[0, -1] == pytest.approx(tight, rel=EXACT)
    assert first * BAND.first_arm - second * BAND.second_arm == pytest.approx(
        100.0 * BAND.force_arm, rel=EXACT
    )
    assert found.peak_pressure == pytest.approx(tight / (BAND.face_width * BAND.drum_radius), rel=EXACT)


@pytest.mark.parametrize("wrap", [2.5, 4.0, 6.0])
def test_forces_of_a_band_on_bearing_and_fulcrum_are_those_of_pressure_and_friction(wrap):
    band = replace(BAND, wrap=wrap)
    found = machines.solve_brake(band, friction=MU, force=100.0)

    def force(way):
        def density(at):
            p = found.peak_pressure * band.pressure(at, MU) * band.face_width * band.drum_radius
            return p * way(at) - MU * p * way(at + np.pi / 2)

        return integral(band, density)

    x, y = force(np.cos), force(np.sin)
    bearing, along = np.hypot(x, y), x * np.cos(wrap / 2) + y * np.sin(wrap / 2)
    fulcrum = np.sqrt((along - 100.0) ** 2 + bearing**2 - along**2)
    assert found.linings[0].reactions["fulcrum"] == pytest.approx(fulcrum, rel=EXACT)
    assert found.linings[0].reactions["bearing"] == pytest.approx(bearing, rel=EXACT)


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("law", ["wear", "pressure"])
def test_levers_of_a_block_brake_balance(law, reverse):
    """Moments about the fulcrum and forces, by quadrature of pressure and friction, in vectors."""
    block = replace(BLOCK, pressure_law=law)
    found = machines.solve_brake(block, friction=MU, force=500.0, reverse=reverse)
    for i, lining in enumerate(found.linings):
        towards = -1.0 if (i == 0) is not reverse else 1.0  # direction of the surface; the fulcrum is at -x

        def forces(at, towards=towards, lining=lining):
            p = lining.peak_pressure * block.pressure(at, MU) * block.face_width * block.drum_radius
            out, along = np.stack([np.sin(at), np.cos(at)]), np.stack([np.cos(at), -np.sin(at)])
            return p * (out + MU * towards * along)

        def moment(at, forces=forces):
            x = block.drum_radius * np.sin(at) + block.block_arm
            y = block.drum_radius * np.cos(at) - block.height
            return x * forces(at)[1] - y * forces(at)[0]

        across, up = (integral(block, lambda at, k=k, forces=forces: forces(at)[k]) for k in (0, 1))
        assert lining.reactions["pin_x"] == pytest.approx(-across, rel=EXACT)
        assert lining.reactions["pin_y"] == pytest.approx(500.0 - up, rel=EXACT)
        assert integral(block, moment) == pytest.approx(500.0 * block.force_arm, rel=EXACT)


@pytest.mark.parametrize("towards", [True, False])
def test_a_worn_block_is_a_pivoted_shoe_outside_the_drum(towards):
    """The integrals are those of a shoe inside, in the room of drum brakes; the sense is the other."""
    b, h, r, arc = 0.2, 0.18, 0.15, 1.2
    block = machines.Block(r, 0.05, arc, 0.6, b, h - r)
    far, middle = np.hypot(b, h), np.arctan2(b, h)  # angle between fulcrum and block's middle
    shoe = drum.Shoe(r, 0.05, (middle - arc / 2, middle + arc / 2), (0.0, -far), force_arm=0.6 - far)
    own = machines.solve_brake(block, friction=MU, force=500.0, reverse=not towards)
    inside = drum.shoe_torque(shoe, friction=MU, force=500.0, leading=not towards)
    assert own.torque == pytest.approx(inside.torque, rel=EXACT)
    assert own.peak_pressure == pytest.approx(inside.peak_pressure, rel=EXACT)


@pytest.mark.parametrize("law", ["wear", "pressure"])
def test_a_narrow_block_is_a_short_one(law):
    narrow = [replace(BLOCK, block_angle=1e-4, pressure_law=each) for each in (law, "short")]
    long, short = (machines.solve_brake(each, friction=MU, force=500.0).torque for each in narrow)
    assert long == pytest.approx(short, rel=1e-8)  # they differ by the square of the angle


@pytest.mark.parametrize("brake", BRAKES)
def test_force_pressure_and_torque_lead_to_the_same(brake):
    first = machines.solve_brake(brake, friction=MU, force=700.0)
    for name in ("peak_pressure", "torque"):
        found = machines.solve_brake(brake, friction=MU, **{name: getattr(first, name)})
        assert found.force == pytest.approx(700.0, rel=1e-13)


def test_a_cone_of_a_right_angle_is_a_plate():
    cone = machines.Cone(0.15, 0.165, width=1e-9)
    plate = machines.Plates(0.15, 0.165, faces=1)
    torques = [machines.solve_brake(each, friction=MU, force=1e3).torque for each in (cone, plate)]
    assert torques[0] == pytest.approx(torques[1], rel=1e-12)


@pytest.mark.parametrize("brake", BRAKES)
def test_arrays_are_the_cases_one_by_one(brake):
    mu = np.array([0.1, 0.2, 0.3])
    many = machines.solve_brake(brake, friction=mu, force=500.0)
    one = [machines.solve_brake(brake, friction=float(each), force=500.0) for each in mu]
    for name in ("torque", "c_star_slope", "peak_pressure", "locking_friction", "error"):
        assert np.array_equal(getattr(many, name), [getattr(each, name) for each in one])


@pytest.mark.parametrize(
    ("r", "b", "offset", "half"),
    [
        (0.04096512127180139, 0.004465673504787392, 0.05757936414019231, 0.03360478116),
        (0.7965638122569788, 0.003011015927032267, 50.222361483916224, 9.058383582651331e-07),
    ],
)
def test_the_stated_error_covers_that_of_a_narrow_block_with_a_far_fulcrum(r, b, offset, half):
    """Against 30 digits: the block's width is a fiftieth of what the fulcrum's height multiplies, or less."""
    block = machines.Block(r, 0.05, 2 * half, 0.5, b, offset)
    found = machines.solve_brake(block, friction=0.0, force=100.0)
    with mp.workdps(30):
        h, x = mpf(r) + mpf(offset), mpf(half)
        moment = mpf(b) ** 2 * (x + mp.sin(2 * x) / 2) + h**2 * (x - mp.sin(2 * x) / 2)
        end = mpf(b) * mp.cos(x) + h * mp.sin(x)
        pressure = 100 * mpf(0.5) / (mpf(r) * mpf(0.05) * moment / end)
        assert abs(found.peak_pressure / pressure - 1) < found.error < 1e-14
