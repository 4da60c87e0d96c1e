"""Band, disc, cone and block brakes against worked examples and numbers recomputed by two routes.

The inputs are those of textbook problems: Shigley's band of 14 in and cone (16-19), Juvinall's differential
band (figure 18.17). Opened with their printed solutions: the bands of two public pages (mechdiploma.com,
transtutors.com), K. Kannan's lecture DTS 11.3, example 1 (block), a question of byjus.com (plates), and of
annular pads Bhandari's example 12.12 as the Scilab textbook companion of FOSSEE solves it (repository
FOSSEE/Scilab-TBC-Uploads, 764/CH12) and Ugural's example 13.6 (holooly.com). None was found that could be
opened of a sliding shoe: it is checked by a second derivation, the quadrature of tests/invariants.
"""

import numpy as np
import pytest

from brakes import drum, machines
from brakes.common.loads import wheel_cylinder_force

INCH, LBF = 0.0254, 4.4482216152605
PSI = LBF / INCH**2
DIGITS = 5e-9  # half a unit of the last digit that is stated, of the numbers with the fewest


def differential(second=0.5):
    return machines.Band(4 * INCH, INCH, np.radians(270), 9 * INCH, 2 * INCH, second * INCH)


def test_differential_band():
    found = machines.solve_brake(differential(), friction=0.2, peak_pressure=75 * PSI)
    assert found.torque / LBF / INCH == pytest.approx(732.406635, rel=DIGITS)
    assert found.force / LBF == pytest.approx(9.310742, rel=1e-7)
    assert found.c_star == pytest.approx(19.6656345, rel=DIGITS)
    assert found.locking_friction == pytest.approx(0.294180800, rel=DIGITS)
    back = machines.solve_brake(differential(), friction=0.2, torque=found.torque, reverse=True)
    assert back.force / LBF == pytest.approx(60.172314, rel=1e-8)


@pytest.mark.parametrize(("second", "status"), [(0.779321, "slides"), (0.779323, "locked")])
def test_arm_at_which_the_differential_band_locks(second, status):
    assert machines.solve_brake(differential(second), friction=0.2, force=1.0).status == status


def test_simple_band_by_its_pressure():
    band = machines.Band(7 * INCH, 4 * INCH, np.radians(270), 9 * INCH, 2 * INCH)
    found = machines.solve_brake(band, friction=0.25, peak_pressure=90 * PSI)
    tensions = found.linings[0].reactions
    assert tensions["second"] / LBF == pytest.approx(2520, rel=1e-12)
    assert tensions["first"] / LBF == pytest.approx(775.817208, rel=DIGITS)
    assert found.torque / LBF / INCH == pytest.approx(12209.27955, rel=DIGITS)


def test_simple_band_by_its_torque():
    band = machines.Band(0.2, 0.05, np.radians(225), 0.5, 0.1)
    tensions = machines.solve_brake(band, friction=0.25, torque=375.0).linings[0].reactions
    assert tensions["second"] == pytest.approx(2998.348456, rel=DIGITS)
    assert tensions["first"] == pytest.approx(1123.348456, rel=DIGITS)


@pytest.mark.parametrize(
    ("law", "pressure", "force", "radius", "line"),
    [
        ("wear", 315.750580, 3747.747748, 4.6875, 2120.791),
        ("pressure", 258.432327, 3710.586907, 4.734444, None),
    ],
)
def test_annular_pads(law, pressure, force, radius, line):
    disc = machines.Disc(3.875 * INCH, 5.5 * INCH, np.radians(108), pressure_law=law)
    found = machines.solve_brake(disc, friction=0.37, torque=13000 * LBF * INCH)
    assert found.peak_pressure / PSI == pytest.approx(pressure, rel=DIGITS)
    assert found.force / LBF == pytest.approx(force, rel=DIGITS)
    assert found.radius / INCH == pytest.approx(radius, rel=1e-7)
    if line:
        assert found.force / wheel_cylinder_force(1.5 * INCH, PSI) == pytest.approx(line, rel=3e-7)


def test_angle_of_annular_pads_for_a_mean_pressure():
    """Bhandari, Design of Machine Elements, example 12.12: 1500 N m at 2 MPa."""
    disc = machines.Disc(0.1, 0.15, np.radians(77.543160), pressure_law="pressure")
    found = machines.solve_brake(disc, friction=0.35, torque=1500.0)
    assert found.peak_pressure == pytest.approx(2e6, rel=7e-9)  # half of the last digit of the angle


def test_force_and_torque_of_annular_pads_at_their_largest_pressure():
    """Ugural, example 13.6: two pads of 60 deg; its torque of 982 lb in is that of one of them."""
    disc = machines.Disc(2.5 * INCH, 5 * INCH, np.radians(60))
    found = machines.solve_brake(disc, friction=0.2, peak_pressure=200 * PSI)
    assert found.force / LBF == pytest.approx(1309, abs=0.5)
    assert found.torque / 2 / LBF / INCH == pytest.approx(982, abs=0.5)


def test_temperature_of_a_drum_that_stops_a_flywheel():
    """Bhandari, example 12.14, as the companion solves it: it says that the book's print is wrong."""
    duty = drum.Duty(100 * 0.35**2, 500 * np.pi / 30, heated_mass=5.0, specific_heat=460.0)
    found = drum.repeat_stops(duty, 0.3, lambda friction: 1000.0 * friction)
    assert found.hottest == pytest.approx(7.300885, abs=5e-7)


@pytest.mark.parametrize(("width", "pressure", "force"), [(0.06, 82.247, 0.948796), (None, 83.876, 0.9676)])
def test_cone(width, pressure, force):
    """Along the axis as the book means, or a slant face of 60 mm."""
    width = width or np.sqrt(0.06**2 - 0.012**2)
    found = machines.solve_brake(machines.Cone(0.153, 0.165, width), friction=0.26, torque=200.0)
    assert found.peak_pressure / 1e3 == pytest.approx(pressure, abs=5e-4)
    assert found.force / 1e3 == pytest.approx(force, abs=5e-5)


@pytest.mark.parametrize(("reverse", "torque"), [(False, 78.2608696), (True, 66.6666667)])
def test_short_block(reverse, torque):
    """The mechanism of examples/block_brake.toml, solved there part by part."""
    block = machines.Block(0.15, 0.05, 0.5, 0.6, 0.25, 0.05, pressure_law="short")
    found = machines.solve_brake(block, friction=0.4, force=500.0, reverse=reverse)
    assert found.torque == pytest.approx(torque, rel=DIGITS)


def test_simple_band_of_a_lever_of_400_mm():
    """mechdiploma.com: 500 N at 40 cm, tight end at 8 cm; it rounds exp(mu phi) to 2.67, by 0.05 %."""
    band = machines.Band(0.2, 0.05, np.radians(225), force_arm=0.4, first_arm=0.08)
    found = machines.solve_brake(band, friction=0.25, force=500.0, reverse=True)  # the first end is tight
    assert found.linings[0].reactions["first"] == pytest.approx(2500.0, rel=1e-12)
    assert found.linings[0].reactions["second"] == pytest.approx(936.3, rel=5e-4)
    assert found.torque == pytest.approx(312.74, rel=5e-4)


def test_band_that_holds_300_newton_metres():
    """transtutors.com: 240 deg, tight end 50 mm and force 300 mm from the hinge.

    Its tensions are those of a drum of 250 mm radius; the 240 in its line of the torque is a misprint.
    """
    band = machines.Band(0.25, 0.05, np.radians(240), force_arm=0.3, first_arm=0.05)
    found = machines.solve_brake(band, friction=0.25, torque=300.0, reverse=True)
    assert found.force == pytest.approx(308.13, rel=3e-5)  # printed with a factor of five digits
    assert found.linings[0].reactions["first"] == pytest.approx(1848.80, rel=3e-5)
    assert found.linings[0].reactions["second"] == pytest.approx(648.77, rel=3e-5)


@pytest.mark.parametrize(("reverse", "torque"), [(False, 83.87), (True, 69.14)])
def test_block_of_a_lecture(reverse, torque):
    """Kannan, DTS 11.3, example 1: the long block has an equivalent friction of 0.385 at its middle."""
    block = machines.Block(0.125, 0.05, np.radians(90), 0.45, 0.2, offset=0.05, pressure_law="short")
    found = machines.solve_brake(block, friction=0.385, force=700.0, reverse=reverse)
    assert found.torque == pytest.approx(torque, abs=0.005)  # half a unit of its last digit


def test_forces_on_a_new_and_on_a_worn_clutch():
    """byjus.com: rings of 250 and 50 mm in diameter; force for the same torque, new over worn, 0.871."""
    force = {
        law: machines.solve_brake(
            machines.Plates(0.025, 0.125, faces=1, pressure_law=law), friction=0.3, torque=100.0
        ).force
        for law in ("pressure", "wear")
    }
    assert force["pressure"] / force["wear"] == pytest.approx(
        0.871, abs=5e-4
    )  # half a unit of its last digit
