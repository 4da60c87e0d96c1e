"""Objects of another class than public functions of `brakes` take: refused in a sentence with the name."""

import numpy as np
import pytest

from benchmarks.cases.wrong_calls import ROAD, TRUCK, make_clamp, make_shoe
from brakes import calipers, drum, forklift, planar

CLAMP, SHOE = make_clamp(), make_shoe()
TRUCK, ROAD = forklift.Truck(**TRUCK), forklift.StopConditions(**ROAD)
EQUILIBRIUM = planar.solve(CLAMP)
CALIPER = calipers.SinglePivot().build()
WRONG = [None, "x", 1.0, [], {}, np.array([1.0, 2.0]), object(), SHOE, planar.Mechanism]


@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("mechanism", planar.assemble),
        ("mechanism", planar.solve),
        ("position", lambda x: planar.solve(CLAMP, 0 if x is None else x)),
        ("mechanism", lambda x: planar.solve_with_friction(x, "hand")),
        ("load", lambda x: planar.solve_with_friction(CLAMP, x)),
        ("mechanism", lambda x: planar.stroke(x, "hand", [0.0])),
        ("load", lambda x: planar.stroke(CLAMP, x, [0.0])),
        ("mechanism", lambda x: planar.trace(x, "hand", 0.01)),
        ("load", lambda x: planar.trace(CLAMP, x, 0.01)),
        ("equilibrium", lambda x: planar.free_body(x, "lever")),
        ("body", lambda x: planar.free_body(EQUILIBRIUM, x)),
        ("index", lambda x: planar.free_body(EQUILIBRIUM, "lever", 1 if x == 1.0 else x)),
        ("joints", lambda x: planar.Mechanism(("lever",), x or [1], CLAMP.loads)),
        ("loads", lambda x: planar.Mechanism(("lever",), CLAMP.joints, [x])),
        ("brake", lambda x: drum.brake_torque(x, friction=0.3, force=1e3)),
        ("shoes", lambda x: drum.simplex(0 if x is SHOE else x)),
        ("shoes", lambda x: drum.duplex(SHOE, 0 if x is SHOE or x is None else x)),
        ("shoe", lambda x: drum.shoe_torque(CLAMP if x is SHOE else x, friction=0.3, force=1e3)),
        ("leading", lambda x: drum.shoe_torque(SHOE, friction=0.3, force=1e3, leading=x)),
        ("truck", lambda x: forklift.stop(x, ROAD)),
        ("conditions", lambda x: forklift.stop(TRUCK, x)),
        ("motion", lambda x: forklift.brake_procedure(TRUCK, ROAD, x, piston_force=1e4)),
        ("geometry", lambda x: forklift.internal_forces(x, torque=1e3, piston_force=1e3)),
        ("geometry", lambda x: forklift.follow_shoes(x, 0.01)),
    ],
)
@pytest.mark.parametrize("wrong", WRONG, ids=lambda wrong: type(wrong).__name__)
def test_wrong_type_is_named(name, call, wrong):
    if isinstance(wrong, np.ndarray) and name in ("index", "joints"):
        wrong = wrong.tolist()
    with pytest.raises(ValueError, match=rf"^{name}\b"):
        call(wrong)


@pytest.mark.parametrize("wrong", ["x", object(), {}, SHOE])
def test_travel_and_friction_of_a_caliper(wrong):
    with pytest.raises(ValueError, match=r"^travel = "):
        CALIPER.stroke(wrong)
    with pytest.raises(ValueError, match=r"^friction = "):
        CALIPER.friction(wrong)
