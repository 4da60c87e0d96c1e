"""Forklift: free bodies of vehicle and shoes, motion integrated, and the mechanism against closed form."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from brakes import forklift
from brakes.forklift import BENDIX_12_5, DuoServo, Levers, StopConditions, Truck, internal_forces
from brakes.planar import Mechanism, RotationLock
from brakes.reproduce.forklift_as_printed import newton_raphson

G = 9.806
CLEARANCES = [0.0052, 0.0106, 0.0211]


# Vehicle ----------------------------------------------------------------------------------------------


@st.composite
def stops(draw):
    """Any truck that stands on its wheels, on any slope on which it does."""
    number = lambda least, most: draw(st.floats(least, most))  # noqa: E731
    L, r1 = number(0.5, 5.0), number(0.1, 1.0)
    m, mL = number(100.0, 5e4), number(0.0, 5e4)
    x, y = L * number(0.05, 0.95), number(0.0, 2.0)
    spare = m * x / max(mL, 1.0)  # a load further ahead would tip it
    xL = max(-0.9 * spare, -3.0) * number(0.0, 1.0) if mL > 0 else 0.0
    truck = Truck(m, (x, y), mL, (xL, number(0.0, 3.0)), r1, L)
    direction = draw(st.sampled_from(("reverse", "forward")))
    front, rear = truck.overturning_slopes
    slope = 0.95 * (front + (rear - front) * number(0.0, 1.0))
    pitching = truck.cg[0] / (truck.cg[1] + r1) if direction == "forward" else np.inf
    conditions = StopConditions(
        slope=slope if direction == "reverse" else -slope,
        direction=direction,
        speed=number(0.1, 15.0),
        friction=min(number(0.05, 1.5), 0.95 * pitching),
        reaction_time=number(0.0, 2.0),
        rise_time=number(0.01, 1.0),
    )
    return forklift.stop(truck, conditions)


@given(stops())
def test_momentum_and_moment_of_every_truck(found):
    """From free bodies: the locked wheel, and the body with the truck's parts as point weights."""
    truck, mu, sense = found.truck, found.conditions.friction, found.conditions.sense
    beta = sense * found.conditions.slope  # a truck that drives forwards travels to -x
    parts = [(truck.empty_mass, *truck.empty_cg), (truck.load_mass, *truck.load_cg)]
    r1, L, A = truck.front_wheel_radius, truck.wheelbase, sense * found.acceleration
    weight = G * np.array([np.sin(beta), -np.cos(beta)])
    axle = np.array(
        [-sense * mu * found.front_load, found.front_load]
    )  # on the massless wheel, and so on the body
    brakes = 2 * found.torque_per_brake
    assert brakes - r1 * mu * found.front_load == pytest.approx(0, abs=1e-10 * brakes)  # wheel, at its centre
    rear = np.array([0.0, found.rear_load])
    force = axle + rear + sum(m * (weight - [A, 0.0]) for m, *_ in parts)
    size = sum(m for m, *_ in parts) * G
    assert np.abs(force).max() <= 1e-10 * size
    moment = (
        -sense * brakes + L * found.rear_load
    )  # about the front wheels' centre: reaction of the brakes, rear axle
    for m, x, y in parts:
        fx, fy = m * (weight - [A, 0.0])
        moment += x * fy - y * fx
    assert abs(moment) <= 1e-10 * size * L


@given(stops())
def test_standing_loads_balance_too(found):
    truck, beta = found.truck, found.conditions.sense * found.conditions.slope
    parts = [(truck.empty_mass, *truck.empty_cg), (truck.load_mass, *truck.load_cg)]
    weight = sum(m for m, *_ in parts) * G
    carried = found.standing_front_load + found.standing_rear_load
    assert carried == pytest.approx(weight * np.cos(beta), rel=1e-12)
    ground = truck.front_wheel_radius
    moment = truck.wheelbase * found.standing_rear_load
    for m, x, y in parts:  # about the front wheels' contact
        moment += m * G * (-x * np.cos(beta) - (y + ground) * np.sin(beta))
    assert abs(moment) <= 1e-10 * weight * truck.wheelbase


@given(stops())
def test_a_sliding_truck_stops_if_and_only_if_it_can_stand(found):
    """Standing, the locked wheels hold mu times their load; the slope pulls with the weight's part."""
    weight = found.truck.mass * G
    road = found.conditions
    spare = road.friction * found.standing_front_load - weight * np.sin(road.slope)
    if abs(spare) > 1e-9 * weight:
        assert found.stops == (spare > 0)


@pytest.mark.parametrize("speed", [0.2, 0.5, 2.0, 6.0])
def test_distance_and_time_by_integration(speed):
    truck = Truck(5950.0, (1.049, 0.359), 3500.0, (-1.20, 0.450), 0.40, 1.89)
    case = {"slope": 0.1, "friction": 0.7, "reaction_time": 0.5, "rise_time": 0.3}
    found = forklift.stop(truck, StopConditions(speed=speed, **case))

    def at_rest(t, y):
        return y[1]

    at_rest.terminal = True
    A = found.acceleration
    rise = solve_ivp(lambda t, y: [y[1], A * t / 0.3], (0, 0.3), [0, speed], events=at_rest, rtol=1e-12)
    s, v, t = rise.y[0, -1], rise.y[1, -1], rise.t[-1]
    if not rise.t_events[0].size:
        rest = solve_ivp(lambda t, y: [y[1], A], (0, 100), [s, v], events=at_rest, rtol=1e-12)
        s, t = rest.y[0, -1], t + rest.t[-1]
    assert (found.status == "stops in the rise time") == bool(rise.t_events[0].size)
    assert found.distance == pytest.approx(s + speed * 0.5, rel=1e-9)
    assert found.time == pytest.approx(t + 0.5, rel=1e-7)  # the event is located to 1e-8 or so


# Forces -----------------------------------------------------------------------------------------------


@st.composite
def cases(draw):
    number = lambda least, most: draw(st.floats(least, most))  # noqa: E731
    r = number(0.05, 0.4)
    alpha1, alpha2, gamma = number(-0.7, 0.7), number(-0.7, 0.7), number(-0.7, 0.7)
    b = r * number(0.1, 0.99)
    levers = Levers(r, r * number(0.1, 0.99), r * number(0.1, 0.99), b, b, alpha1, alpha2, gamma)
    piston = 10 ** number(2.0, 5.0)
    return levers, piston, piston * r * 10 ** number(-2.0, 2.0)


@given(cases())
def test_free_bodies_of_the_shoes(case):
    """Forces and moments of each shoe and of the drum, written out anew; all sizes positive."""
    levers, P_T, T = case
    f = internal_forces(levers, torque=T, piston_force=P_T)
    assert f.status == "equilibrium"
    assert min(f.A, f.B, f.C, f.D, f.Q, f.P_L) > 0
    push = f.P_L * np.array([np.cos(levers.alpha1), -np.sin(levers.alpha1)])
    pull = -P_T * np.array([np.cos(levers.alpha2), np.sin(levers.alpha2)])
    link = f.Q * np.array([np.cos(levers.gamma), np.sin(levers.gamma)])
    scale = f.P_L + f.Q + P_T
    assert np.abs(f.A_vector + f.B_vector + push + link).max() <= 1e-12 * scale
    assert np.abs(f.C_vector + f.D_vector + pull - link).max() <= 1e-12 * scale
    r = levers.drum_radius
    assert abs(f.B * r + f.Q * levers.b1 - f.P_L * levers.a1) <= 1e-12 * scale * r
    assert abs(f.D * r + P_T * levers.a2 - f.Q * levers.b2) <= 1e-12 * scale * r
    assert (f.B + f.D) * r == pytest.approx(T, rel=1e-12)
    for normal, friction, sizes in (
        (f.A_vector, f.B_vector, (f.A, f.B)),
        (f.C_vector, f.D_vector, (f.C, f.D)),
    ):
        np.testing.assert_allclose([np.hypot(*normal), np.hypot(*friction)], sizes, rtol=1e-11)
        assert abs(normal @ friction) <= 1e-12 * scale**2
        assert normal[0] * friction[1] - normal[1] * friction[0] < 0  # along a counter-clockwise drum
    assert pytest.approx(f.D / f.C, rel=1e-9) == f.B / f.A
    assert f.residual <= 1e-12


@given(cases())
def test_torque_and_friction_lead_back(case):
    levers, P_T, T = case
    by_torque = internal_forces(levers, torque=T, piston_force=P_T)
    by_friction = internal_forces(levers, friction=by_torque.lining_friction, piston_force=P_T)
    slope = 1 / max(by_torque.margin, 1e-12)  # near locking the torque is steep in the friction
    assert by_friction.torque == pytest.approx(T, rel=1e-12 * slope)
    assert by_friction.residual <= 1e-12 * slope


@given(cases(), st.floats(1.01, 3.0))
def test_torque_grows_with_friction_up_to_locking(case, factor):
    levers, P_T, _ = case
    mu = levers.locking_friction * np.linspace(0.01, 0.99, 40)
    torque = internal_forces(levers, friction=mu, piston_force=P_T).torque
    assert (np.diff(torque) > 0).all()
    assert (
        internal_forces(levers, friction=factor * levers.locking_friction, piston_force=P_T).status
        == "locked"
    )


@given(cases(), st.floats(0.02, 0.9))
def test_slope_of_the_brake_factor(case, part):
    """Against a difference quotient of fourth order; also where b1 and b2 differ."""
    levers, P_T, _ = case
    levers = Levers(**(vars(levers) | {"b1": 0.9 * levers.b2}))
    mu = part * min(levers.locking_friction, 2.0)
    h = 1e-3 * mu * (1 - part)
    at = internal_forces(levers, friction=mu + h * np.array([-2, -1, 1, 2]), piston_force=P_T).c_star
    slope = (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * h)
    found = internal_forces(levers, friction=mu, piston_force=P_T)
    assert found.c_star_slope == pytest.approx(slope, rel=1e-7)


@given(cases())
def test_only_one_share_of_the_trailing_shoe(case):
    """B / R_L = D / R_T, scanned over every share: one change of sign, at the share that was found."""
    levers, P_T, T = case
    u = np.linspace(0, 1, 4001)[1:-1]
    Q = (P_T * levers.a2 + T * u) / levers.b2
    P_L = (T * (1 - u) + Q * levers.b1) / levers.a1
    R_L = np.sqrt(P_L**2 + Q**2 + 2 * P_L * Q * np.cos(levers.phi1))
    R_T = np.sqrt(P_T**2 + Q**2 + 2 * P_T * Q * np.cos(levers.phi2))
    more = u / R_T > (1 - u) / R_L
    share = internal_forces(levers, torque=T, piston_force=P_T).trailing_share
    changes = np.flatnonzero(np.diff(more))
    assert len(changes) <= 1
    assert all(u[k] <= share <= u[k + 1] for k in changes)


@given(cases())
def test_closed_form_for_parallel_forces(case):
    """Q/P_T = (a2 + s)/(b2 - s), P_L/Q = (b1 + s)/(a1 - s) with s = r sin(friction angle)."""
    levers, P_T, _ = case
    parallel = Levers(**(vars(levers) | {"alpha1": 0.0, "alpha2": 0.0, "gamma": 0.0}))
    mu = 0.8 * min(parallel.locking_friction, 2.0)
    s = parallel.drum_radius * mu / np.sqrt(1 + mu**2)
    Q = P_T * (parallel.a2 + s) / (parallel.b2 - s)
    P_L = Q * (parallel.b1 + s) / (parallel.a1 - s)
    found = internal_forces(parallel, friction=mu, piston_force=P_T)
    np.testing.assert_allclose([found.Q, found.P_L], [Q, P_L], rtol=1e-10)
    back = internal_forces(parallel, torque=found.torque, piston_force=P_T)
    np.testing.assert_allclose([back.Q, back.P_L], [Q, P_L], rtol=1e-10)


@pytest.mark.slow
@given(cases(), st.integers(0, 2**32 - 1), st.booleans())
def test_newton_only_ever_agrees(case, seed, damped):
    """From random starts: where it ends all-positive and along the drum, it is the reduction's solution."""
    levers, P_T, T = case
    exact = internal_forces(levers, torque=T, piston_force=P_T)
    start = np.random.default_rng(seed).normal(size=10)
    found = newton_raphson(levers, torque=T, piston_force=P_T, start=start, damped=damped)
    if not found.physical:
        return
    x = np.concatenate([exact.A_vector, exact.B_vector, exact.C_vector, exact.D_vector, [exact.Q, exact.P_L]])
    # A residual of 1e-12 moves the forces by that times the condition of the scaled equations.
    bound = 1e-11 * found.condition_number * max(np.abs(x).max(), T / levers.drum_radius)
    np.testing.assert_allclose(found.unknowns, x, rtol=0, atol=bound)


def test_newton_agrees_from_most_published_starts():
    """The test above is not empty: for the paper's brake many random starts end at the solution."""
    levers = BENDIX_12_5.find_levers(0.0106)
    starts = np.random.default_rng(1997).normal(size=(40, 10))
    runs = [newton_raphson(levers, torque=11e3, piston_force=11650.0, start=x, damped=True) for x in starts]
    physical = [run for run in runs if run.physical]
    assert 2 < len(physical) < 25 and sum(run.converged for run in runs) > len(physical)
    Q = internal_forces(levers, torque=11e3, piston_force=11650.0).Q
    np.testing.assert_allclose([run.unknowns[8] for run in physical], Q, rtol=1e-9)


def test_jacobian_of_newton():
    """Quadratic convergence from nearby: each step squares the error."""
    levers = BENDIX_12_5.find_levers(0.0106)
    x = newton_raphson(levers, torque=11e3, piston_force=11650.0).unknowns / (11e3 / 0.15875)
    start = x + 1e-3 * np.cos(np.arange(10))
    case = {"torque": 11e3, "piston_force": 11650.0, "start": start}
    sizes = [newton_raphson(levers, steps=k, **case).residual for k in range(3)]
    assert sizes[1] < 10 * sizes[0] ** 2 and sizes[2] < 1e-11


# Kinematics -------------------------------------------------------------------------------------------


@st.composite
def brakes(draw):
    number = lambda least, most: draw(st.floats(least, most))  # noqa: E731
    r = number(0.1, 0.3)
    return DuoServo(
        drum_radius=r,
        tip=(r * number(0.3, 0.5), r * number(0.5, 0.7)),
        adjuster=(r * number(0.2, 0.45), -r * number(0.6, 0.8)),
        face_tilt=number(0.05, 0.5),
        contact_angle=number(0.6, 1.1),
        piston_bottom=r * number(0.005, 0.03),
    ), r * number(0.01, 0.06)


@settings(max_examples=25)
@given(brakes())
def test_mechanism_against_closed_form(case):
    """Two routes: the mechanism's constraints followed, and the turns in closed form."""
    brake, c = case
    closed, path = brake.move_shoes(c), forklift.follow_shoes(brake, c, positions=4)
    for stage in (path.right, path.left):
        assert stage.turn[-1] == pytest.approx(closed.seating_turn, rel=1e-10)
    assert path.right.travel["right"][-1] == pytest.approx(closed.seating_travel, rel=1e-10)
    assert path.drum.turn[-1] == pytest.approx(closed.drum_turn, rel=1e-10)
    out = path.left.travel["left"][-1] + path.drum.travel["left"][-1]
    assert out == pytest.approx(closed.left_travel, rel=1e-10)
    assert closed.right_travel == pytest.approx(-brake.piston_bottom, rel=1e-10)


@pytest.mark.parametrize("clearance", CLEARANCES)
def test_lever_arms_from_the_mechanism(clearance):
    """Moments of unit forces at the pins of the last position."""
    path, levers = forklift.follow_shoes(BENDIX_12_5, clearance), BENDIX_12_5.find_levers(clearance)
    place, drawn = path.drum.position, path.drum.mechanism

    def pin(name, body):
        at = next(joint.at for joint in drawn.joints if joint.name == name)
        return place.point(body, at)[-1]

    def moment(at, angle, sign):
        return at[0] * sign * np.sin(angle) - at[1] * np.cos(angle)

    right, left = pin("right tip", "right shoe"), pin("left tip", "left shoe")
    low_right, low_left = pin("right adjuster pin", "right shoe"), pin("left adjuster pin", "left shoe")
    chord = low_right - low_left
    gamma = np.arctan2(chord[1], chord[0])
    found = [-moment(right, levers.alpha1, -1), -moment(left, levers.alpha2, 1)]
    found += [moment(low_right, gamma, 1), moment(low_left, gamma, 1), gamma]
    expected = [levers.a1, levers.a2, levers.b1, levers.b2, levers.gamma]
    np.testing.assert_allclose(found, expected, rtol=1e-10)


@pytest.mark.parametrize("clearance", CLEARANCES)
def test_rank_at_every_position(clearance):
    """8 of 9 and 23 of 24 everywhere, far from losing a rank."""
    path = forklift.follow_shoes(BENDIX_12_5, clearance)
    for stage, rank in ((path.right, 8), (path.left, 8), (path.drum, 23)):
        assert (stage.rank == rank).all() and len(stage.rank) == 21
        assert stage.mechanism.system.constraints == rank and stage.mechanism.system.size == rank + 1
        assert (stage.least_singular_value > 0.01).all()


def seated_mechanism():
    motion = BENDIX_12_5.move_shoes(0.0106)
    turn = -motion.drum_turn
    back = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    tips = back @ motion.right_tip, back @ motion.left_tip
    return forklift.build_turning_mechanism(BENDIX_12_5, *(tuple(map(float, tip)) for tip in tips))


def test_welding_both_shoes_makes_a_row_redundant():
    drawn = seated_mechanism()
    welded = Mechanism(drawn.bodies, (*drawn.joints, RotationLock("second weld", "left shoe", "drum")))
    rank, least = forklift.constraint_rank(welded.drawing)
    assert welded.system.constraints == 24 and rank.tolist() == [23] and least[0] < 1e-14


def test_pinning_contact_points_leaves_mobility_two():
    """The right shoe pinned to the drum at its contact point only, the left one seated."""
    drawn = seated_mechanism()
    pinned = Mechanism(drawn.bodies, tuple(j for j in drawn.joints if j.name != "weld angle"))
    assert 24 - forklift.constraint_rank(pinned.drawing)[0][0] == 2


def test_gap_at_the_tips():
    motion = BENDIX_12_5.move_shoes(np.array(CLEARANCES))
    for tip in (motion.right_tip, motion.left_tip):
        np.testing.assert_allclose(motion.tip_gap, 0.15875 - np.linalg.norm(tip, axis=-1), rtol=1e-12)
    path = forklift.follow_shoes(BENDIX_12_5, 0.0106)
    radius = np.linalg.norm(path.right.position.point("right shoe", BENDIX_12_5.tip), axis=-1)
    assert motion.tip_gap[1] == pytest.approx(0.15875 - radius.max(), rel=1e-10)


def test_events():
    path = forklift.follow_shoes(BENDIX_12_5, 0.0106)
    assert [event.name for event in path.events] == ["lining reaches the drum"] * 2 + ["piston bottoms"]
    assert "21.039 mm" in path.events[0].message and "42.291 mm" in path.events[2].message
    assert path.interference == BENDIX_12_5.move_shoes(0.0106).interference


def test_contact_point_reaches_the_drum_in_the_mechanism():
    path = forklift.follow_shoes(BENDIX_12_5, 0.0106)
    for side, stage in (("right", path.right), ("left", path.left)):
        sign = 1 if side == "right" else -1
        at = (0.15875 - 0.0106) * np.array([sign * np.cos(np.radians(56.5)), np.sin(np.radians(56.5))])
        radius = np.linalg.norm(stage.position.point(f"{side} shoe", tuple(at)), axis=-1)
        assert radius[0] == pytest.approx(0.15875 - 0.0106, rel=1e-12)
        assert radius[-1] == pytest.approx(0.15875, rel=1e-12)
        assert (np.diff(radius) > 0).all()


def test_virtual_work_of_the_drum():
    """Without friction the shoes' torque would be the pistons' work: T dpsi = sum of P dx, in stage 2."""
    path = forklift.follow_shoes(BENDIX_12_5, 0.0106, positions=401)
    turn, right, left = path.drum.turn, path.drum.travel["right"], path.drum.travel["left"]
    levers = BENDIX_12_5.find_levers(0.0106)
    tilt = np.radians(19.7)
    rates = [np.gradient(x, turn, edge_order=2)[-1] for x in (right, left)]
    # a face force F has the horizontal part F cos(tilt) on its piston, and the arm a about the drum
    np.testing.assert_allclose(-rates[0] * np.cos(tilt), levers.a1, rtol=1e-5)  # differences: h^2
    np.testing.assert_allclose(rates[1] * np.cos(tilt), levers.a2, rtol=1e-5)
