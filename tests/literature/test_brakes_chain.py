"""The truck of Yoo et al. (1997) braked from its pedal, and a bicycle: numbers found by two other routes.

They were computed by programs that share nothing with this one: the brake by inverse and forward C* and the
solved shoes, slopes by moments and by roots, the energy by force times path and by m v^2 / 2 + m g h. The
published numbers of limits of force are those of ISO 6292:2020, 4.5.2, 4.5.4 and 4.5.5.
"""

import numpy as np
import pytest

from brakes import chain, forklift, vehicle
from brakes.common.limits import LIMITS

LINING = 0.390283458  # given to nine digits, which is what the pedal's force at locking hangs on: rel=3e-9
LINE = chain.HydraulicLine(master_bore=22.22e-3, cylinder_bore=31.75e-3)
CONDITIONS = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
UNIT = forklift.internal_forces(forklift.BENDIX_12_5, piston_force=1.0, friction=LINING, clearance=0.0106)
ROAD = vehicle.Road(0.1, 0.7)
BICYCLE = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)


def truck(load=3500.0):
    return vehicle.Truck(
        5950.0, (1.049, 0.359), load, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    )


def braked(booster=1.0):
    pedal = chain.Pedal(ratio=5.0, force=450.0, booster=booster)
    return chain.brake_from_pedal(truck(), CONDITIONS, pedal, LINE, UNIT.torque)


def test_the_pedal_locks_the_wheels_at_its_force():
    plain, boosted = braked(), braked(3.0)
    assert plain.locking_force == pytest.approx(1141.186357, rel=3e-9)
    assert boosted.locking_force == pytest.approx(380.395452, rel=3e-9)
    assert LINE.pressure(5 * plain.locking_force) == pytest.approx(14.7146042e6, rel=5e-9)
    assert plain.locking_torque == pytest.approx(8480.823954, rel=1e-10)


def test_without_a_booster_the_brake_limits_and_the_truck_never_stops():
    found = braked()
    assert found.available_torque == pytest.approx(3344.213463, rel=3e-9)
    assert found.stop.acceleration == pytest.approx(1.146240, abs=5e-7)
    assert (found.limited_by, found.stop.status) == ("brake", "brakes too weak")
    assert np.isnan(chain.heat_of_stop(found.stop).energy)


def test_with_a_booster_the_road_limits():
    found = braked(3.0)
    assert found.stop.distance == pytest.approx(13.424928, abs=5e-7)
    assert found.available_torque == pytest.approx(10032.640, abs=5e-4)
    assert found.limited_by == "road"


@pytest.mark.parametrize(
    "load, downhill, slips, tips",
    [
        (3500.0, "rear", 25.60720060, None),
        (0.0, "rear", 13.66538954, None),
        (3500.0, "front", 41.272, 15.24469849),
        (0.0, "front", 23.42620756, 54.1125),
    ],
)
def test_parking(load, downhill, slips, tips):
    found = vehicle.hold(truck(load).vehicle, ROAD, "front", downhill)
    digits = 5e-4 if slips == 41.272 else 1.1e-8  # the last digit given is rounded or cut
    assert np.degrees(found.slipping_slope) == pytest.approx(slips, abs=digits)
    if tips is not None:
        assert np.degrees(found.tipping_slope) == pytest.approx(tips, abs=5e-5 if tips == 54.1125 else 5e-9)
    assert found.limited_by == ("tips" if tips is not None and tips < slips else "slips")


def test_least_friction_of_the_tyres():
    needed = vehicle.friction_to_stop(truck(), CONDITIONS)
    assert needed.value == pytest.approx(0.412432594537, abs=1e-12)
    within = vehicle.friction_to_stop(truck(), CONDITIONS, distance=10.0)
    # The number beside it is a root by one route alone, whose last two digits are its tolerance.
    assert within.value == pytest.approx(0.879482850735, abs=5e-11)


def test_energy_of_the_stop_by_its_places():
    heat = chain.heat_of_stop(braked(3.0).stop)
    parts = [heat.energy, heat.drum_energy, heat.tyre_energy]
    assert parts == pytest.approx([439194.63, 57385.55, 381809.08], abs=5e-3)


def test_the_bicycle_pitches_over_before_its_front_tyre_slips():
    found = vehicle.braking_limits(BICYCLE, friction=0.8, front_share=1.0)
    assert found.pitching == pytest.approx(0.563636364, abs=5e-10)
    assert found.rear_alone == pytest.approx(0.261052632, abs=5e-10)
    assert found.front_alone == pytest.approx(2.2857, abs=5e-5)
    assert (found.first, found.largest) == ("pitching over", found.pitching)


def test_limits_of_force_are_those_of_the_standard():
    """ISO 6292:2020, 4.5, and TBIS 4210-2:2018, 4.6.9.2: excerpts of both texts were opened."""
    found = {limb: most for limb, (most, _) in LIMITS.items()}
    assert found == {"foot": 450.0, "hand": 300.0, "grip": 150.0, "bicycle": 180.0}
    said = chain.actuate(chain.Pedal(ratio=8.0, force=310.0, operated_by="hand"), LINE).warnings
    assert said == ("the force of 310 N: ISO 6292:2020, 4.5.4, allows 300 N for a hand: exceeded",)
    assert not chain.actuate(chain.Pedal(ratio=8.0, force=300.0, operated_by="hand"), LINE).warnings
