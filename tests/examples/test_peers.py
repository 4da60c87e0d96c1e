"""The comparison with other programs: all that works without them."""

import math
import re

import numpy as np
import pytest

from benchmarks.cases.scenes import ROLLING
from benchmarks.peers import calculix, exudyn, measure, pybmodes, stock, tables
from benchmarks.peers.measure import BLADE, HARVESTER, OURS, Point
from benchmarks.rows import time_text

DAT = """

     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1   0.1679699E+06   0.4098413E+03   0.6522827E+02   0.0000000E+00

     P A R T I C I P A T I O N   F A C T O R S

MODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION      Z-ROTATION

      1   0.3927251E-14  -0.2192837E-01   0.1447987E-12  -0.2450314E-11  -0.5352602E-14  -0.7966017E-03
"""


# CalculiX -----------------------------------------------------------------------------------------


def test_first_frequency_is_read():
    assert calculix.first_frequency(DAT) == 65.22827


def test_missing_frequency_is_refused():
    with pytest.raises(ValueError, match="did not converge"):
        calculix.first_frequency(DAT.split("1   0.16")[0])


@pytest.mark.parametrize("elements", [1, 5, 40])
def test_mesh(elements):
    mesh = calculix.nodes(elements)
    assert len(mesh) == 12 * elements + 8
    corner = np.array([0.05, 0.0002, 0.01])
    assert np.ptp(list(mesh.values()), axis=0) == pytest.approx(corner, rel=1e-14)
    number = {place: n for n, place in enumerate(mesh, 1)}
    lines = [calculix.element(e, number).replace("\n", " ") for e in range(elements)]
    used = [[int(n) for n in line.split(",")[1:]] for line in lines]
    assert all(len(set(own)) == 20 for own in used)
    assert set().union(*used) == set(number.values())


def test_middles_lie_between_the_corners_in_the_order_of_the_manual():
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    corners = np.array(calculix.CORNERS)
    assert [tuple((corners[a] + corners[b]) // 2) for a, b in edges] == list(calculix.MIDDLES)


def test_deck_has_load_and_root():
    text = calculix.deck(5, 50.0, True)
    assert "BEAM, CENTRIF, 2500, 0.215, 0, 0, 0, 0, 1\n" in text  # turns about z, through the axis
    assert "*STEP, NLGEOM\n" in text and "2e+11, 0\n" in text and "\n7850\n" in text
    root = re.search(r"NSET=ROOT\n(.*?)\*BOUNDARY", text, re.S)
    assert root is not None and len(root[1].split()) == 8
    assert "NLGEOM" not in calculix.deck(5, 50.0, False)


@pytest.mark.skipif(
    calculix.version() is None, reason="there is no ccx; on Debian: apt-get install calculix-ccx"
)
@pytest.mark.parametrize("speed", [0.0, 100.0])
def test_solid_elements_give_the_frequency_of_the_beam(speed):
    """The beam theory leaves out shear and rotary inertia, a part of about (thickness/length)^2."""
    left_out = (measure.given()["thickness"] / measure.given()["length"]) ** 2
    _, frequency = calculix.solve(calculix.deck(20, speed, False))
    assert frequency == pytest.approx(measure.harvester_frequencies()[speed], rel=2 * left_out)


# pyBModes -----------------------------------------------------------------------------------------


def test_blade_file():
    lines = pybmodes.deck(10, 12.0).splitlines()
    assert float(lines[6].split()[0]) == pytest.approx(12 * 60 / (2 * math.pi), rel=1e-15)
    assert len(lines[-1].split()) == 11 and lines[-3] == "10 nselt"
    columns = {len(line.split()) for line in pybmodes.SECTIONS.splitlines()[3:]}
    assert columns == {13}


# Exudyn -------------------------------------------------------------------------------------------


def test_motion_is_that_of_the_scene():
    t = np.linspace(0, 30, 301)
    motion = ROLLING.motion.at(t)
    assert exudyn.angle(exudyn.Numpy, t) == pytest.approx(motion.angle, abs=1e-10)
    assert exudyn.speed(exudyn.Numpy, t) == pytest.approx(motion.speed, abs=1e-12)
    assert exudyn.acceleration(exudyn.Numpy, t) == pytest.approx(motion.acceleration, abs=1e-12)
    load = np.stack(exudyn.load(exudyn.Numpy, t), axis=-1)
    assert load == pytest.approx(-motion.carrier_acceleration, abs=1e-9)


def test_a_rigid_beam_does_not_deflect():
    t = np.linspace(0, 30, 301)
    x, y, slope, other = exudyn.root(exudyn.Numpy, t)
    root_x, root_y = x - 0.215, y
    tip_x, tip_y = root_x + 0.05 * (1 + slope), root_y + 0.05 * other
    assert np.abs(exudyn.deflection(t, tip_x, tip_y)).max() < 1e-15


def test_softening_is_named():
    assert str(exudyn.Setting(2, 5e-4, 1e-3)) == "2 cables, step 0.5 ms, axial stiffness x 0.001"
    assert exudyn.TARGET[0] == "8 cables, step 0.5 ms"


# Tables -------------------------------------------------------------------------------------------

POINTS = [
    Point(HARVESTER, OURS, "coarse", 1e-5, 1e-4),
    Point(HARVESTER, OURS, "fine, default", 4e-5, 1e-9),
    Point(HARVESTER, OURS, "one speed by itself, default", 4e-2, 1e-9),
    Point(HARVESTER, "CalculiX", calculix.TARGET[0], 0.2, 2e-5),
    Point(HARVESTER, "CalculiX", "coarse", 0.01, 2e-4),
    Point(BLADE, "pyBModes", "20 elements", 0.01, 1e-6),
]


def test_references_are_found():
    assert measure.harvester_frequencies() == {0.0: 65.23045644, 50.0: 61.96301891, 100.0: 50.90709538}
    blade = measure.blade_frequencies()
    assert sorted(blade) == [0, 2, 4, 8, 12] and blade[12.0] == 13.1701504875


def test_ratio_is_at_equal_or_smaller_error():
    found = [tables.ratio(p, POINTS) for p in POINTS[3:]]
    assert found[:2] == pytest.approx([5000, 1000])
    assert math.isnan(found[2])
    assert tables.ratio(POINTS[3], POINTS, alone=True) == pytest.approx(5)
    assert tables.ratio(POINTS[4], POINTS, default=True) == pytest.approx(250)


def test_missing_program_is_named(monkeypatch):
    for peer in (calculix, pybmodes, exudyn):
        monkeypatch.setattr(peer, "version", lambda: None)
    peers = (calculix, pybmodes, exudyn, stock)
    last = list(tables.rows(POINTS[:2], peers))[-3:]
    assert [(row[1], row[2]) for row in last] == [
        (peer.NAME, "not installed") for peer in (calculix, pybmodes, exudyn)
    ]
    assert "CalculiX not installed, pyBModes not installed" in tables.versions(peers)


def test_missing_program_is_recognised(monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("importlib.metadata.distribution", _absent)
    assert calculix.version() is pybmodes.version() is exudyn.version() is None


def _absent(name):
    from importlib.metadata import PackageNotFoundError

    raise PackageNotFoundError(name)


def test_targets_are_compared():
    (row,) = tables.target_rows(POINTS[:5], (calculix, pybmodes, stock))
    assert row == ("CalculiX", "40 elements, nonlinear static step", "5000", "3000", "5000", "1000 to 5000")


def test_page_and_picture(tmp_path):
    page = tables.markdown(POINTS, stock, (calculix, stock))
    assert "| CalculiX | coarse | 10 ms | 2.0e-04 | 1000 | 0.2 |" in page and "solid elements" in page
    tables.picture(POINTS, tmp_path / "peers.png")
    assert (tmp_path / "peers.png").stat().st_size > 1000


def test_peak_between_samples():
    t = np.arange(20, 30, 5e-4)
    assert measure.peak(t, -2e-3 * np.cos(400 * t + 0.1)) == pytest.approx(2e-3, rel=1e-5)


@pytest.mark.parametrize(("time", "text"), [(12.34, "12.3 s"), (0.0123, "12.3 ms"), (7.6e-6, "7.6 µs")])
def test_seconds(time, text):
    assert time_text(time) == text
