"""Questions backwards: random brakes and vehicles forwards again, and closed forms as a second route."""

import numpy as np
import pytest

import brakes
from benchmarks.cases.random_questions import TYPES, draw
from brakes import chain, vehicle

BACK = 1e-10  # relative, forwards again
TRUCK = vehicle.Truck(5950.0, (1.049, 0.359), 3500.0, (-1.2, 0.45), front_wheel_radius=0.4, wheelbase=1.89)
LINE = chain.HydraulicLine(0.02222, 0.03175, lost_travel=0.002)


def test_random_vehicles_and_brakes_backwards_and_forwards():
    quick = sorted({*TYPES} - {"sliding"})  # whose locking is a search of its own: the benchmark has it
    asked = [draw(number, 7, quick) for number in range(18)]
    assert {each.what.partition(":")[0] for each in asked} >= {"band", "drum", "vehicle", "forklift"}
    for each in asked:
        assert each.residual < BACK, each.what
        assert each.distance < BACK, each.what


def test_friction_that_stops_within_a_distance_is_that_of_its_closed_form():
    def distance(friction):
        return vehicle.stop(TRUCK, vehicle.StopConditions(0.3019, 5.5, friction, 0.5, 0.3)).distance

    conditions = vehicle.StopConditions(0.3019, 5.5, 0.7, reaction_time=0.5, rise_time=0.3)
    known = vehicle.friction_to_stop(TRUCK, conditions, distance=10.0).value
    assert brakes.find(distance, 10.0, np.linspace(0.2, 1.5, 21)).values == pytest.approx([known], rel=BACK)


@pytest.mark.parametrize("downhill", ["front", "rear"])
def test_friction_that_holds_is_that_of_its_closed_form(downhill):
    def slope(friction):
        return vehicle.hold(TRUCK.vehicle, vehicle.Road(0.1, friction), "rear", downhill).largest_slope

    known = vehicle.friction_to_hold(TRUCK.vehicle, 0.1, "rear", downhill).value
    assert brakes.find(slope, 0.1, np.linspace(0.1, 1.9, 21)).values == pytest.approx([known], rel=BACK)


def test_force_and_ratio_of_a_pedal_are_those_of_their_closed_forms():
    pedal = chain.Pedal(5.0, 300.0, booster=3.0, runout=2000.0)
    by_force = brakes.find(
        lambda f: chain.actuate(chain.Pedal(5.0, f, booster=3.0, runout=2000.0), LINE).actuator_force,
        12000.0,
        np.linspace(50, 2000, 21),
    )
    by_ratio = brakes.find(
        lambda i: chain.actuate(chain.Pedal(i, 300.0, booster=3.0, runout=2000.0), LINE).actuator_force,
        12000.0,
        np.linspace(1, 20, 21),
    )
    assert by_force.values == pytest.approx([chain.force_for(pedal, LINE, 12000.0).value], rel=BACK)
    assert by_ratio.values == pytest.approx([chain.ratio_for(pedal, LINE, 12000.0).value], rel=BACK)


def test_travel_that_runs_out_ends_the_ratio_where_the_closed_form_has_none():
    pedal = chain.Pedal(1.0, 300.0, travel=0.08)
    found = brakes.find(
        lambda i: chain.actuate(chain.Pedal(i, 300.0, travel=0.08), LINE).actuator_force,
        30000.0,
        np.linspace(1, 60, 21),
    )
    assert chain.ratio_for(pedal, LINE, 30000.0).reason
    assert not found.values.size
    (gap,) = found.gaps
    stroke = LINE.stroke(300.0 * gap.start)
    assert gap.start * stroke == pytest.approx(0.08, rel=2e-9)  # the travel may pass its limit by 1e-9
