"""The comparison with other programs: all that works without them."""

import math
from itertools import pairwise

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases import blades
from benchmarks.cases.scenes import ROLLING
from benchmarks.peers import (
    bent,
    calculix,
    exudyn,
    hexahedra,
    in_space,
    large_deflection,
    measure,
    page,
    physics,
    pybmodes,
    spin_up,
    stock,
    tables,
    twisted,
)
from benchmarks.peers.measure import BLADE, HARVESTER, OURS, Point
from benchmarks.rows import time_text

# pyBModes -----------------------------------------------------------------------------------------


def test_blade_file():
    lines = pybmodes.deck(10, 12.0).splitlines()
    assert float(lines[6].split()[0]) == pytest.approx(12 * 60 / (2 * math.pi), rel=1e-15)
    assert len(lines[-1].split()) == 11 and lines[-3] == "10 nselt"
    columns = {len(line.split()) for line in pybmodes.SECTIONS.splitlines()[3:]}
    assert columns == {13}


def test_files_of_a_twisted_blade():
    ends = twisted.boundaries("nrel_5", 200)
    assert len(ends) == 4 * 48 + 1 and set(blades.stations("nrel_5")["stations"]) <= set(ends)
    lines = twisted.main_file("nrel_5", 12.1, 200).splitlines()
    assert [lines[k].split()[0] for k in (6, 8, 9)] == [f"{12.1:.17g}", "63", "1.5"]
    first, last = (
        np.array([float(value) for value in twisted.sections("nrel_5").splitlines()[k].split()])
        for k in (5, -1)
    )
    assert first[[0, 1, 2, 3, 6, 7]] == pytest.approx(
        [0, 13.308, 13.308, 678.935 * 1.04536, 1.811e10, 1.81136e10]
    )
    assert last[[0, 1, 6, 7]] == pytest.approx([1, 0, 1.7e5, 5.01e6])
    assert np.all(first[10:] == 0)  # no offsets


@pytest.mark.skipif(pybmodes.version() is None, reason="there is no pyBModes: pip install pyBModes")
@pytest.mark.parametrize("name", ["nrel_5", "bmodes_test01"])
def test_twisted_blade(name):
    """One mesh is right to the second order of the elements' length; the limit is off by at most 8e-6."""
    coarse, fine = (twisted.their_frequencies(name, 12.0, count) for count in (100, 200))
    own = twisted.our_frequencies(name, 12.0)
    assert fine == pytest.approx(own, rel=1e-4)
    assert twisted.extrapolated(coarse, fine) == pytest.approx(own, rel=1e-5)


def test_mesh_is_refined_until_it_hardly_changes(monkeypatch):
    """An error that falls to a quarter from mesh to mesh, 1e-4 on the first."""

    def theirs(name, rpm, elements):
        return np.array([1.0, 2.0 * (1 - 1e-4 * (200 / elements) ** 2)])

    monkeypatch.setattr(twisted, "MODES", 2)
    monkeypatch.setattr(twisted, "their_frequencies", theirs)
    counts, _, changes = zip(*twisted.refined("bmodes_test01", 60.0), strict=True)
    assert counts == (200, 400, 800)
    assert changes[1:] == pytest.approx([7.5e-5, 1.875e-5], rel=1e-3)


def test_limit_of_an_error_of_second_order():
    f, error = np.array([1.0, 2.0]), np.array([4e-3, -8e-3])
    assert twisted.extrapolated(f + error, f + error / 4) == pytest.approx(f, rel=1e-14)


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


# Exudyn, a spin-up --------------------------------------------------------------------------------


@pytest.mark.parametrize("duration", spin_up.DURATIONS)
def test_spin_up_is_that_of_the_scene(duration):
    t = spin_up.times()
    motion = bd.SpinUp(6.0, duration).at(t)
    assert spin_up.angle(exudyn.Numpy, t, duration) == pytest.approx(motion.angle, abs=1e-10)
    rigid = spin_up.deflection(t, np.cos(motion.angle), -np.sin(motion.angle), duration)
    assert np.abs(rigid).max() < 1e-10


def test_differences_are_over_the_largest_deflection():
    one, other = (spin_up.Run(np.array(tip), 0.0) for tip in ([0.0, 1.0, -1.9], [0.1, 1.0, -2.0]))
    assert one.differs_from(other) == pytest.approx(0.05) and other.largest == 2.0


@pytest.mark.skipif(exudyn.version() is None, reason="there is no Exudyn: pip install exudyn")
@pytest.mark.parametrize(("duration", "linear"), [(15.0, 1e-3), (5.0, 5e-3)])
def test_cables_spin_up_as_the_elastica(duration, linear):
    """The cables are right to 3e-4; linear theory is off by 1.1e-3, and by 1.2e-2 in the fast spin-up."""
    cables, own = spin_up.cables(duration, spin_up.Setting(12, 2e-3, 4.0)), spin_up.elastica(duration)
    assert cables.differs_from(own) < 1e-3
    assert spin_up.linear(duration).differs_from(own) > linear


# Exudyn and CalculiX, beams in space ----------------------------------------------------------------


STRIP = in_space.Case(0.027, 0.023, bd.TipLoad((0.0, 4500.0, 5800.0)))


@pytest.mark.skipif(exudyn.version() is None, reason="there is no Exudyn: pip install exudyn")
@pytest.mark.parametrize("number", [0, 6])
def test_a_beam_in_space_bends_as_exudyns(number):
    """Two meshes; without the shortening by twist, which Exudyn has not, only their own error is left."""
    case = in_space.random_case(number)
    coarse, fine = (in_space.exudyn_tip(case, count) for count in (20, 40))
    own, limit = bd.equilibrium(case.scene, 0.0, discretization=bd.Ritz(12)).tip, in_space.limit(coarse, fine)
    assert np.linalg.norm(limit - own) < 1e-3
    left = [np.linalg.norm(tip - in_space.without_shortening(case)) for tip in (coarse, fine, limit)]
    assert left[2] < 1e-5 and left[0] / left[1] == pytest.approx(4, rel=0.05)


def test_solids_are_loaded_by_the_whole_force_at_the_middle_of_their_tip():
    case, counts = STRIP, (3, 2, 4)
    weights = in_space.face_weights(counts)
    places = [place for place in hexahedra.numbers(counts) if place[0] == 6]
    assert weights.sum() == pytest.approx(1.0, rel=1e-14)
    assert weights @ np.array(places) == pytest.approx([6, 2, 4], rel=1e-14)
    loads = in_space.deck(case, counts).split("*CLOAD\n")[1].split("*NODE PRINT")[0].splitlines()
    total = [sum(float(row.split(",")[2]) for row in loads if int(row.split(",")[1]) == k) for k in (1, 2, 3)]
    assert total == pytest.approx(case.load.force, rel=1e-9)


@pytest.mark.skipif(calculix.version() is None, reason="there is no CalculiX: apt-get install calculix-ccx")
def test_a_beam_in_space_bends_as_a_solid():
    case = STRIP
    own = bd.equilibrium(case.scene, 0.0, discretization=bd.Ritz(12)).tip
    assert np.linalg.norm(in_space.solid_tip(case, (8, 2, 2)) - own) < 0.01
    assert np.linalg.norm(own - [1.0, 0.0, 0.0]) > 0.3


def test_the_section_on_beams_in_space_has_its_table(monkeypatch):
    for module in (calculix, exudyn):
        monkeypatch.setattr(module, "version", lambda: None)
    monkeypatch.setattr(in_space, "CASES", 1)
    monkeypatch.setattr(in_space, "random_case", lambda number: STRIP)
    (row,) = in_space.rows(1)
    assert len(row) == len(in_space.HEAD) and tables.MISSING in row
    assert in_space.section([row]).startswith(page.IN_SPACE)


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


def test_titles_of_the_picture_stand_apart_and_within_it():
    figure = tables.drawn(POINTS)
    figure.canvas.draw()
    boxes = [ax.title.get_window_extent() for ax in figure.axes]
    assert len(boxes) == 3
    assert boxes[0].x0 >= 0 and boxes[-1].x1 <= figure.bbox.x1
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))


def test_peak_between_samples():
    t = np.arange(20, 30, 5e-4)
    assert measure.peak(t, -2e-3 * np.cos(400 * t + 0.1)) == pytest.approx(2e-3, rel=1e-5)


@pytest.mark.parametrize(("time", "text"), [(12.34, "12.3 s"), (0.0123, "12.3 ms"), (7.6e-6, "7.6 µs")])
def test_seconds(time, text):
    assert time_text(time) == text


# The section on physics ---------------------------------------------------------------------------


def test_either_part_of_the_page_is_written_alone(tmp_path):
    path = tmp_path / "peers.md"
    path.write_text("# Beside\n\nold\n")
    page.write_section(f"{page.HEADING}\nfirst\n", path)
    page.write_measurements("# Beside\n\nnew\n", path)
    page.write_section(f"{page.HEADING}\nsecond\n", path)
    assert path.read_text() == f"# Beside\n\nnew\n\n{page.HEADING}\nsecond\n"
    page.write_measurements("# Beside\n\nnewer\n", path)
    assert path.read_text() == f"# Beside\n\nnewer\n\n{page.HEADING}\nsecond\n"
    page.write_section(f"{page.LARGE_DEFLECTION}\nlarge\n", path)
    page.write_section(f"{page.HEADING}\nthird\n", path)
    page.write_measurements("# Beside\n\nlast\n", path)
    sections = f"{page.HEADING}\nthird\n\n{page.LARGE_DEFLECTION}\nlarge\n"
    assert path.read_text() == f"# Beside\n\nlast\n\n{sections}"


def test_section_has_both_tables():
    text = physics.section([("IEA 15 MW", *"123456789")], [("0, clamped", *"12345678")])
    assert text.startswith(page.HEADING)
    assert "| IEA 15 MW | 1 |" in text and "| 0, clamped | 1 |" in text
    assert "{" not in text and "0.1 to 0.06 m wide" in text and "3.8 in the flap" in text


def test_order_of_convergence():
    limit, error = np.array([2.0, 3.0]), np.array([8e-3, 1e-9])
    assert list(physics.orders([limit + error, limit + error / 8, limit + error / 64])) == [
        "3.0",
        "converged",
    ]


def test_peers_without_programs_are_named(monkeypatch):
    monkeypatch.setattr(calculix, "version", lambda: None)
    ((_, _, text, *_),) = physics.tapered_rows()
    assert text == "CalculiX not installed"


def test_section_on_large_deflection_has_both_tables():
    text = large_deflection.section([("45 deg", *"123456")], [("15 s", *"123456")])
    assert text.startswith(page.LARGE_DEFLECTION)
    assert "| 45 deg | 1 |" in text and "| 15 s | 1 |" in text and "{" not in text


def test_every_row_of_large_deflection_fills_its_table(monkeypatch):
    solution = bent.Solution(np.array([0.9, -0.3]), np.ones(3), np.ones(3), 0.1)
    run = spin_up.Run(np.array([0.0, 1.0]), 0.1)
    for module, names, result in (
        (bent, ("beam", "solid"), solution),
        (spin_up, ("elastica", "linear", "cables"), run),
    ):
        for name in names:
            monkeypatch.setattr(module, name, lambda *_, result=result: result)
    for version in (None, "1"):
        for module in (calculix, exudyn):
            monkeypatch.setattr(module, "version", lambda version=version: version)
        assert {len(row) for row in large_deflection.bent_rows()} == {len(large_deflection.BENT_HEAD)}
        assert {len(row) for row in large_deflection.spin_up_rows()} == {len(large_deflection.SPIN_UP_HEAD)}
