"""The eeBrake reconstructed: its table, and its stroke by loop closure and virtual work."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.cases import mechanisms as ee
from brakes.planar import GROUND, Mechanism, Pin, solve, stroke

RATES = 0.3894391536, 0.3720812942  # pad travel per cable travel, open position, ten printed digits
TABLE = [  # tension and left pad given; X, Y, Z, F_L of the reconstruction
    (0.7788783071540528, None, 0.875, -0.0227141043516, 0.3789155056945, 1.0466507177033),
    (None, 1.0, 0.836, -0.0315209961126, 0.3302514925313, 1.0),
]
EQUAL_PADS = 0.7615204477374768  # tension
CABLE = np.linspace(0.0, 3.5e-3, 15)


def in_bodies(tension: float | None, left: float | None) -> Mechanism:
    """The same with strut and link as bodies: five bodies and seven pins."""
    joints = (
        *ee.JOINTS[:3],
        Pin("A", "K", "V", ee.A),
        Pin("K-panel", "K", GROUND, ee.G),
        Pin("B", "S", "V", ee.B),
        Pin("S-R", "S", "R", ee.UPPER_R),
    )
    return Mechanism(("R", "L", "V", "S", "K"), joints, ee.eebrake(tension, 1.0, left).loads)


def lever_axes(lever: np.ndarray, pivot) -> tuple[np.ndarray, np.ndarray]:
    """Directions from the pivot to O and, normal to it, inboard."""
    radial = (lever - pivot) / np.linalg.norm(lever - pivot)
    return radial, np.array((radial[1], -radial[0]))


@pytest.mark.parametrize(("tension", "left", "x", "y", "z", "f_left"), TABLE)
def test_table(tension, left, x, y, z, f_left):
    answer = solve(ee.eebrake(tension, 1.0, left))
    assert answer.status == "determined"
    assert (answer.mobility, answer.indeterminacy, answer.uncontrolled) == (1, 0, 0)
    radial, tangential = lever_axes(np.array(ee.UPPER_L), ee.PIVOT_L)
    assert answer.reactions["O"] @ tangential == pytest.approx(x, abs=1e-12)  # the printed digits
    assert -(answer.reactions["O"] @ radial) == pytest.approx(y, abs=1e-12)
    assert -answer.magnitudes["K"] == pytest.approx(z, abs=1e-12)
    assert answer.amplitudes["pad L"] == pytest.approx(f_left, abs=1e-12)
    assert answer.amplitudes["cable"] == pytest.approx(tension or EQUAL_PADS, abs=1e-12)
    assert -answer.magnitudes["S"] == pytest.approx(0.8497353800, abs=1e-10)


def test_five_bodies_and_seven_pins_are_the_same():
    bars, bodies = solve(ee.eebrake()), solve(in_bodies(None, 1.0))
    assert bodies.mobility == 1
    assert bodies.amplitudes["cable"] == pytest.approx(EQUAL_PADS, abs=1e-12)
    assert bodies.reactions["A"] == pytest.approx(-bars.reactions["K"], abs=1e-12)  # on K, and on V
    assert bodies.reactions["S-R"] == pytest.approx(-bars.reactions["S"], abs=1e-12)


def test_rates_at_the_open_position():
    ratio = stroke(ee.eebrake(), "cable", [0.0]).ratio
    assert (-ratio["pad R"][0], -ratio["pad L"][0]) == pytest.approx(RATES, abs=5e-11)  # printed digits


def test_travel_at_3_5_mm_of_cable():
    travel = stroke(ee.eebrake(), "cable", [3.5e-3]).travel
    assert -travel["pad R"][0] == pytest.approx(1.26234e-3, abs=5e-9)  # printed digits
    assert -travel["pad L"][0] == pytest.approx(1.23766e-3, abs=5e-9)


# The second route: loops closed by complex numbers in the three angles of R, L and V.

POINTS = {
    name: complex(*getattr(ee, name)) for name in ("A", "B", "C", "G", "PIVOT_R", "PIVOT_L", "PAD_R", "PAD_L")
}
UPPER_R, UPPER_L = complex(*ee.UPPER_R), complex(*ee.UPPER_L)


def turned(point, pivot, angle):
    """A point turned about a pivot: its coordinates, which stay analytic in a complex angle."""
    z = point - pivot
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array(
        (pivot.real + cosine * z.real - sine * z.imag, pivot.imag + sine * z.real + cosine * z.imag)
    )


def places(angles):
    """Right upper pin, B, A, C and the two pads."""
    right, left, upper = angles
    p = POINTS
    o = turned(UPPER_L, p["PIVOT_L"], left)
    on_v = [o + turned(p[name] - UPPER_L, 0j, upper) for name in ("B", "A", "C")]
    pads = turned(p["PAD_R"], p["PIVOT_R"], right), turned(p["PAD_L"], p["PIVOT_L"], left)
    return turned(UPPER_R, p["PIVOT_R"], right), *on_v, *pads


def closure(angles, cable):
    """Squares of strut, link and anchor to C against their lengths [mm^2]."""
    upper, b, a, c, *_ = places(angles)
    p, q = POINTS["G"], POINTS["PIVOT_R"]
    anchor = abs(POINTS["C"] - q) - cable
    return 1e6 * np.array(
        [
            ((upper - b) ** 2).sum() - abs(UPPER_R - POINTS["B"]) ** 2,
            ((a - (p.real, p.imag)) ** 2).sum() - abs(POINTS["A"] - p) ** 2,
            ((c - (q.real, q.imag)) ** 2).sum() - anchor**2,
        ]
    )


def slopes(function, angles):
    """Derivatives by the angles, by complex steps."""
    return np.stack([np.imag(function(angles + 1e-30j * unit)) / 1e-30 for unit in np.eye(3)], axis=-1)


@pytest.fixture(scope="module")
def loops():
    """Angles (S, 3) of R, L and V over the stroke, and their rates by the cable."""
    found, rates, angles = [], [], np.zeros(3)
    for cable in CABLE:
        for _ in range(8):
            by_angles = slopes(lambda a, s=cable: closure(a, s), angles)
            angles = angles - np.linalg.solve(by_angles, closure(angles, cable))
        by_cable = np.imag(closure(angles.astype(complex), cable + 1e-30j)) / 1e-30
        found.append(angles)
        rates.append(-np.linalg.solve(by_angles, by_cable))
    return np.array(found), np.array(rates)


def test_stroke_against_loop_closure(loops):
    run = stroke(ee.eebrake(), "cable", CABLE)
    for k, body in enumerate(("R", "L", "V")):
        assert np.allclose(run.position.angle(body), loops[0][:, k], rtol=0, atol=1e-13)  # rounding
    pads = np.array([[p[0] for p in places(a)[4:]] for a in loops[0]])
    assert np.allclose(run.travel["pad R"], pads[:, 0] - ee.PAD_R[0], rtol=0, atol=1e-13)
    assert np.allclose(run.travel["pad L"], -pads[:, 1] + ee.PAD_L[0], rtol=0, atol=1e-13)


def test_rates_and_forces_of_the_stroke_against_virtual_work(loops):
    """T = delta_R + delta_L at equal pads; the strut by the moments on R, the link by those on V about O."""
    run = stroke(ee.eebrake(), "cable", CABLE)
    answer = solve(ee.eebrake(), run.position)
    for k, (angles, rates) in enumerate(zip(*loops, strict=True)):
        pads = slopes(lambda a: np.array([p[0] for p in places(a)[4:]]), angles) @ rates
        assert run.ratio["pad R"][k] == pytest.approx(pads[0], abs=1e-10)
        assert run.ratio["pad L"][k] == pytest.approx(-pads[1], abs=1e-10)
        tension = pads[1] - pads[0]
        assert answer.amplitudes["cable"][k] == pytest.approx(tension, abs=1e-10)
        check_levers(answer, k, angles, tension)
    assert answer.virtual_work.max() < 1e-14  # rounding


def check_levers(answer, k, angles, tension):
    """Strut, link and pivots by the moments and forces on R, V and L, one after the other."""
    upper, b, a, c, pad_r, _ = places(angles)
    pivot_r, g = np.array(ee.PIVOT_R), np.array(ee.G)
    o = turned(UPPER_L, POINTS["PIVOT_L"], angles[1])
    strut, link, cable = ((p - q) / np.linalg.norm(p - q) for p, q in ((b, upper), (a, g), (pivot_r, c)))
    f = cross(pad_r - pivot_r, (1, 0)) / cross(upper - pivot_r, strut)
    z = -(cross(b - o, strut) * f + cross(c - o, cable) * tension) / cross(a - o, link)
    on_v = -(f * strut + tension * cable + z * link)
    assert -answer.magnitudes["S"][k] == pytest.approx(f, abs=1e-10)
    assert -answer.magnitudes["K"][k] == pytest.approx(z, abs=1e-10)
    assert answer.reactions["O"][k] == pytest.approx(on_v, abs=1e-10)
    assert answer.reactions["pivot R"][k] == pytest.approx(np.subtract(f * strut, (1, 0)), abs=1e-10)
    assert answer.reactions["pivot L"][k] == pytest.approx(np.add(on_v, (1, 0)), abs=1e-10)


def cross(p, q):
    return p[0] * q[1] - p[1] * q[0]


def test_the_cable_pair_is_an_amplitude_like_any_other():
    """T = 2 delta_R given, F_L found: X / f_t is the ratio of the pad velocities."""
    tension = 2 * RATES[0]
    answer = solve(ee.eebrake(tension, 1.0, None))
    assert answer.amplitudes["pad L"] == pytest.approx(RATES[0] / RATES[1], abs=1e-9)  # ten digits given
