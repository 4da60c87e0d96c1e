"""Pictures of drum and forklift brakes: what they show is what was computed."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from beamdyn.common.drawing.on_axes import figure_of, plot_chart
from beamdyn.common.drawing.shapes import Outline, Symbol
from beamdyn.common.plots.curves import curves, sweep_figure
from brakes import drum, forklift, machines
from brakes.drawings import mechanism_parts
from brakes.drawings.arrows import ForceArrows
from brakes.drawings.drum import brake_figure, drawing_of, factors, pressure_chart
from brakes.drawings.drum import factor_chart as factors_of_drum
from brakes.drawings.duo_servo import duo_servo, free_bodies, lining, moved
from brakes.drawings.forklift import answer_drawings, distances, forces_over, truck
from brakes.drawings.machine import factor_chart

ROOT = Path(__file__).parents[2]
SHOE = drum.Shoe(0.138, 0.05, (np.radians(30.0), np.radians(110.0)), (0.020, -0.110), 0.115)
TRUCK = {
    "empty_mass": 5950,
    "empty_cg": (1.049, 0.359),
    "load_mass": 3500,
    "load_cg": (-1.20, 0.450),
    "front_wheel_radius": 0.40,
    "wheelbase": 1.89,
}
STOP = {"slope": 0.3019, "speed": 20 / 3.6, "friction": 0.7, "reaction_time": 0.5, "rise_time": 0.3}
BRAKE = forklift.BENDIX_12_5


def axes():
    return Figure(figsize=(5, 4)).subplots()


def stopped(**changes) -> forklift.Stop:
    return forklift.stop(forklift.Truck(**(TRUCK | changes)), forklift.StopConditions(**STOP))


def test_forces_on_a_drum_shoe_balance_as_drawn() -> None:
    """Pressure, friction, pin and actuating force of each shoe sum to nothing."""
    found = drum.brake_torque(drum.simplex(SHOE), friction=0.35, force=1000.0)
    drawn = drawing_of(found).arrows
    for shoe in "12":
        four = [drawn[f"{name}_{shoe}"] for name in "PNTR"]
        assert np.hypot(*sum(four)) < 1e-12
        assert np.hypot(*four[0]) > 0.01
    assert drawn["P_1"][0] > 0 > drawn["P_2"][0]  # pushed apart


def test_both_shoes_of_a_duplex_brake_rub_the_same_way_round() -> None:
    found = drum.brake_torque(drum.duplex(SHOE), friction=0.35, force=1000.0)
    drawn = drawing_of(found).arrows
    np.testing.assert_allclose(drawn["T_1"], -drawn["T_2"], rtol=1e-12)


def test_pressure_is_drawn_over_the_lining_only() -> None:
    found = drum.brake_torque(drum.simplex(SHOE), friction=0.35, force=1000.0)
    for line, shoe in zip(plot_chart(axes(), pressure_chart(found)).lines, found.shoes, strict=True):
        x, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
        assert (x.min(), x.max()) == pytest.approx((30.0, 110.0), rel=1e-12)
        assert y.max() == pytest.approx(1e-6 * shoe.peak_pressure, rel=1e-3)


def test_factors_end_before_locking_and_say_where_it_is() -> None:
    brake = drum.simplex(SHOE)
    limit = drum.brake_torque(brake, friction=0.1, force=1.0).locking_friction
    ax = factors(axes(), brake, friction=0.35)
    assert np.max(ax.lines[0].get_xdata()) < limit
    (said,) = [text for text in ax.texts if f"locks at {limit:.3g}" in text.get_text()]
    (leading,) = [line for line in ax.lines if line.get_label() == "1: leading"]
    assert said.get_color() == leading.get_color()  # of the shoe that locks
    trailing = factors(axes(), brake=drum.duplex(SHOE), reverse=True)
    assert not any("locks" in text.get_text() for text in trailing.texts)


@pytest.mark.parametrize("friction", [0.05, 0.12, 0.3])
def test_charts_of_shoes_without_equilibrium_below_locking_have_a_finite_range(friction: float) -> None:
    """In reverse: no equilibrium up to a friction of 0.11, then it locks, and from 0.14 on it slides."""
    shoe = machines.Sliding(
        0.138, 0.05, 0.979541, 2.681742, 0.104316, 0.056825, 0.066554, -0.659346, "single"
    )
    chart = factor_chart(machines.solve_brake(shoe, friction=friction, force=1000.0, reverse=True))
    assert chart.y.high is None or np.isfinite(chart.y.high)
    assert (float(chart.curves[0].x[-1]) > 0.3) == (friction == 0.3)
    plot_chart(Figure().subplots(), chart)


def test_charts_of_brakes_far_past_a_high_locking_friction_have_a_finite_range() -> None:
    """A block that locks at 5, and a trailing shoe that locks at 2.6, as its pin is outside of the drum."""
    block = machines.Block(0.15, 0.05, 0.6, 0.6, block_arm=0.25, offset=0.05, pressure_law="short")
    shoe = drum.Shoe(0.138, 0.05, np.radians((12.0, 20.0)), (-0.05, -0.2), 0.115)
    charts = (
        factor_chart(machines.solve_brake(block, friction=10.0, force=500.0)),
        factors_of_drum(drum.DrumBrake((shoe,), (False,)), 9.0),
    )
    assert all(np.isfinite(chart.y.high) for chart in charts)


@pytest.mark.parametrize("friction, panels", [(0.35, 3), (1.2, 2)])
def test_figure_of_a_brake(friction: float, panels: int) -> None:
    found = drum.brake_torque(drum.simplex(SHOE), friction=friction, force=1000.0)
    assert len(brake_figure(found).axes) == panels


def test_a_locked_brake_is_drawn_with_a_mark_on_the_shoe_that_locks() -> None:
    found = drum.brake_torque(drum.simplex(SHOE), friction=1.2, force=1000.0)
    drawn = drawing_of(found)
    limit = float(found.locking_friction)
    assert [label.said for label in drawn.labels if "locks" in label.text] == [
        f"1: locks from\nfriction {limit:.3g} on"
    ]
    (mark,) = [shape for shape in drawn.shapes if isinstance(shape, Symbol) and shape.role == "inside"]
    assert np.hypot(*mark.at) == pytest.approx(0.138, rel=1e-12)  # on the lining
    slides = drum.brake_torque(drum.simplex(SHOE), friction=0.35, force=1000.0)
    outlines = [s.points for s in drawn.shapes if isinstance(s, Outline) and s.role in ("body", "support")]
    same = [
        s.points
        for s in drawing_of(slides).shapes
        if isinstance(s, Outline) and s.role in ("body", "support")
    ]
    assert all(map(np.array_equal, outlines, same)) and len(outlines) == len(same) == 4


@pytest.mark.parametrize(
    "levers, given, said",
    [
        ({}, {"friction": 2.0}, "locks itself"),
        ({"a1": 0.3, "b2": 0.3, "b1": 0.3}, {"torque": 1e6}, "no equilibrium"),
    ],
)
def test_shoes_without_equilibrium_are_drawn_with_a_mark(levers, given, said) -> None:
    known = dataclasses.replace(BRAKE.find_levers(0.0106), **levers)
    found = forklift.internal_forces(known, piston_force=11650.0 if "friction" in given else 10.0, **given)
    ((left, right),) = answer_drawings(None, None, found, forklift.follow_shoes(BRAKE, 0.0106))
    for shoe, name in ((left, "trailing shoe"), (right, "leading shoe")):
        assert shoe.title == name and [label.text for label in shoe.labels] == [said]
        assert not shoe.arrows and any(shape.role == "body" for shape in shoe.shapes)


def test_axle_loads_and_friction_as_drawn() -> None:
    """Across the slope they hold the weight; along it, what is left accelerates the truck."""
    found = stopped()
    drawn = truck(found).arrows
    along = np.array([np.cos(0.3019), -np.sin(0.3019)])
    total = sum(drawn[name] for name in ("Mg", "N_A", "N_B", "R_A"))
    across = np.array([along[1], -along[0]])
    assert abs(total @ across) < 1e-12
    scale = np.hypot(*drawn["Mg"]) / 9.806
    assert total @ along == pytest.approx(scale * found.acceleration, rel=1e-12)


def test_a_truck_without_load_is_drawn_and_named() -> None:
    assert "never stops" in truck(stopped(load_mass=0.0)).title


def test_slopes_on_which_it_never_stops_are_named() -> None:
    speeds, slopes = np.array([2.0, 4.0]), np.radians([0.0, 26.0])
    road = forklift.StopConditions(**(STOP | {"slope": slopes[:, None], "speed": speeds}))
    found = forklift.stop(forklift.Truck(**TRUCK), road)
    ax = distances(axes(), speeds, slopes, found.distance)
    legend = ax.get_legend()
    assert legend is not None
    assert [t.get_text() for t in legend.get_texts()] == ["0 deg", "26 deg: never stops"]


@pytest.mark.parametrize("side", ["right", "left"])
def test_the_tip_ends_where_the_kinematics_have_it(side: str) -> None:
    motion = BRAKE.move_shoes(0.0106)
    (tip,) = moved(np.array([BRAKE.tip]), BRAKE, motion, 2.0, side)
    np.testing.assert_allclose(tip, getattr(motion, f"{side}_tip"), rtol=1e-13)


def test_the_lining_drawn_enters_the_drum_as_deep_as_computed() -> None:
    motion = BRAKE.move_shoes(0.0106)
    rim = moved(lining(BRAKE, motion), BRAKE, motion, 1.0, "right")
    deepest = np.hypot(*rim.T).max() - BRAKE.drum_radius
    assert deepest == pytest.approx(motion.lining_penetration, rel=1e-3)  # 121 points along the lining


@pytest.mark.parametrize("progress", [0.0, 0.5, 1.0, 1.5, 2.0])
def test_the_brake_on_its_way(progress: float) -> None:
    assert len(duo_servo(BRAKE, BRAKE.move_shoes(0.0106), progress).shapes) > 8


@pytest.mark.parametrize("progress, drawn", [(0.0, False), (1.0, True), (2.0, True)])
def test_the_key_says_what_red_is_where_there_is_any(progress: float, drawn: bool) -> None:
    legend = duo_servo(BRAKE, BRAKE.move_shoes(0.0106), progress).legend
    assert ("inside the drum's wall" in legend.values()) == drawn


def test_duo_servo_shoes_balance_as_drawn() -> None:
    found = forklift.internal_forces(BRAKE, torque=11000.0, piston_force=11650.0, clearance=0.0106)
    shoes = free_bodies(found, forklift.follow_shoes(BRAKE, 0.0106))
    for shoe, names in zip(shoes, (("C", "D", "P_T", "Q"), ("A", "B", "P_L", "Q")), strict=True):
        drawn = shoe.arrows
        assert np.hypot(*sum(drawn[name] for name in names)) < 1e-12
        assert np.hypot(*drawn["Q"]) > 0.01


def test_free_bodies_of_levers_alone() -> None:
    found = forklift.internal_forces(BRAKE.find_levers(0.0106), torque=11000.0, piston_force=11650.0)
    figure = figure_of(answer_drawings(None, None, found, None))
    assert len(figure.axes) == 2


def test_forces_over_the_torque() -> None:
    torque = np.linspace(9e3, 12e3, 5)
    found = forklift.internal_forces(BRAKE, torque=torque, piston_force=11650.0, clearance=0.0106)
    ax = forces_over(axes(), torque, found, "torque")
    by_name = {str(line.get_label()): np.asarray(line.get_ydata()) for line in ax.lines}
    np.testing.assert_allclose(by_name["A"], 1e-3 * found.A, rtol=1e-15)
    assert ax.get_xlabel() == "torque"


def test_a_curve_without_values_says_so() -> None:
    ax = curves(axes(), np.array([0.0, 1.0]), np.array([[1.0, 2.0], [np.inf, np.nan]]), ["a", "b"])
    assert [line.get_label() for line in ax.lines] == ["a", "b: none"]


def test_a_sweep_has_a_panel_a_unit_or_a_panel_a_result() -> None:
    x, second = np.array([0.0, 1.0]), np.array([1.0, 2.0, 3.0])
    one = {
        "inputs": ("t.a",),
        "units": ("m",),
        "values": (x,),
        "results": ("A", "B", "mu"),
        "result_units": ("N", "N", ""),
        "found": (x, x, x),
        "combine": "product",
    }
    figure = sweep_figure(SimpleNamespace(**one))
    assert [len(ax.lines) for ax in figure.axes] == [2, 1] and figure.axes[0].get_ylabel() == "A, B [N]"
    two = one | {"inputs": ("t.a", "t.b"), "units": ("m", "s"), "values": (x, second)}
    two["found"] = tuple(np.add.outer(x, second) for _ in range(3))
    maps = sweep_figure(SimpleNamespace(**two)).axes[1:]
    assert [ax.get_title() for ax in maps] == ["A [N]", "B [N]", "mu"]
    assert (maps[0].get_xlabel(), maps[0].get_ylabel()) == ("a [m]", "b [s]")


def test_pyplot_is_not_used() -> None:
    modules = "brakes.drawings.drum, brakes.drawings.forklift"
    code = f"import {modules}, sys; print('matplotlib.pyplot' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.strip() == "False"


@pytest.mark.parametrize("count", [3, 4, 9, 40])
@pytest.mark.parametrize("seed", range(5))
def test_outline_of_a_body_is_the_convex_hull(count, seed):
    """Against that of Qhull, whose corners start elsewhere."""
    from scipy.spatial import ConvexHull

    points = np.random.default_rng(seed).normal(size=(count, 2)) * 0.01
    points = np.vstack([points, points[:2]])  # two of them twice
    ours, theirs = mechanism_parts._hull(points), points[ConvexHull(points).vertices]
    first = np.flatnonzero((theirs == ours[0]).all(axis=1))[0]
    np.testing.assert_array_equal(ours, np.roll(theirs, -first, axis=0))


def test_outline_of_a_body_whose_points_lie_on_a_line_has_them_all():
    points = np.outer([0.3, 0.0, 1.0, 0.7], [0.1, 0.2])
    np.testing.assert_array_equal(mechanism_parts._hull(points), points[[1, 0, 3, 2]])


def test_drawing_of_a_mechanism_loads_no_library_of_geometry():
    """It takes a second or more, for which the server of the page would answer nobody."""
    code = (
        "import sys; from brakes.config.mechanism import load_mechanism as load; "
        "from brakes.answers.caliper import MECHANISM; "
        f"MECHANISM.solve(load({str(ROOT / 'examples' / 'block_brake.toml')!r})).drawings(1.0); "
        "assert 'scipy.spatial' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


def test_factors_of_a_brake_that_never_locks_are_drawn_as_a_whole():
    """C* of plates is in proportion to the friction, which the example has at an eighth of the axis."""
    plates = machines.solve_brake(machines.Plates(0.05, 0.07, faces=4), friction=0.1, force=4000.0)
    assert factor_chart(plates).y.high is None
    band = machines.Band(0.2, 0.05, wrap=4.2, force_arm=0.5, first_arm=0.1, second_arm=0.025)
    assert factor_chart(machines.solve_brake(band, friction=0.2, force=200.0)).y.high < 50


def test_a_short_arrow_is_drawn_longer_and_says_so():
    arrows = ForceArrows(1e-3, least=0.05)
    arrows.add((0.0, 0.0), np.array([0.0, 2.0]), "P", "load")
    arrows.add((0.0, 0.0), np.array([0.0, 200.0]), "Q", "load")
    lengths = [np.hypot(*arrow.vector) for arrow in arrows.shapes]
    np.testing.assert_allclose(lengths, [0.2, 0.2], rtol=1e-14)
    assert [label.text for label in arrows.labels] == ["2 N (arrow x 100)", "200 N"]
