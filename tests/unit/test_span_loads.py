"""Loads along the span: closed forms, sides of jumps, points, largest values, cycles, bad input."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.loads import static_loads
from beamdyn.loads.load_path import largest_per_coordinate
from beamdyn.loads.load_rows import span_rows
from beamdyn.loads.stations import mode_error, sections_at, stations_at
from beamdyn.modes.modal.model import ModalBasis
from beamdyn.scene.numbers import with_numbers
from benchmarks import loads as loads_measured

LENGTH, WIDTH, THICK, E, RHO, G = 0.5, 0.02, 0.004, 200e9, 7800.0, 9.81
MASS = RHO * WIDTH * THICK
EI, EA = E * WIDTH * THICK**3 / 12, E * WIDTH * THICK
BEAM = bd.Beam.rectangular(LENGTH, WIDTH, THICK, E, RHO)
BODY = bd.TipMass(0.03, offset=0.02)
OUTWARD = bd.Mount(0.1, setting_angle=math.pi)
STEPPED = bd.Beam.rectangular(
    LENGTH, WIDTH, bd.Table([0, 0.4, 0.4, 1.0], [0.006, 0.006, 0.004, 0.004]), E, RHO, poissons_ratio=0.3,
    point_masses=[bd.PointMass(0.7 * LENGTH, 0.05)],
)  # fmt: skip


# Equilibrium --------------------------------------------------------------------------------------


def test_rounding_of_loads_is_computed_for_the_finer_model_alone(monkeypatch):
    speeds, computed, known = np.linspace(1, 9, 5), [], static_loads.rounding_of_entries
    monkeypatch.setattr(
        static_loads, "rounding_of_entries", lambda *given: computed.append(1) or known(*given)
    )
    bd.static_loads(bd.Scene(BEAM, OUTWARD), speeds)
    assert len(computed) == len(speeds)


@pytest.mark.parametrize("discretization", ["ritz", bd.Fem(8)])
def test_weight(discretization):
    """A horizontal cantilever: w (L - x)^2 / 2 and w (L - x), and the body's weight on its arm."""
    scene = bd.Scene(replace(BEAM, tip=BODY), OUTWARD, gravity=G)
    loads = bd.static_loads(scene, discretization=discretization)
    rest = LENGTH - loads.x
    shear = -G * (MASS * rest + BODY.mass)
    moment = -G * (MASS * rest**2 / 2 + BODY.mass * (rest + BODY.offset))
    sign = np.sign(loads.moment[0, 0, 0] * moment[0])  # b2 points down
    np.testing.assert_allclose(sign * loads.moment[0, :, 0], moment, rtol=1e-10)
    np.testing.assert_allclose(sign * loads.force[0, :, 1], shear, rtol=1e-10)
    np.testing.assert_allclose(sign * loads.curvature[0, :, 0], moment / EI, rtol=1e-10)
    np.testing.assert_allclose(sign * loads.strain[0, :, 0], moment / EI * THICK / 2, rtol=1e-10)
    np.testing.assert_allclose(loads.stress, E * loads.strain, rtol=1e-12)
    np.testing.assert_allclose(loads.force[0, :, 0], 0, atol=1e-12)


def test_gravity_at_an_angle_of_rotation():
    """Turned by a right angle, the beam hangs: its weight pulls along it."""
    scene = bd.Scene(BEAM, OUTWARD, gravity=G)
    for angle in (math.pi / 2, -math.pi / 2):
        loads = bd.static_loads(scene, angle=angle)
        assert abs(loads.force[0, 0, 0]) == pytest.approx(MASS * LENGTH * G, rel=1e-12)
        np.testing.assert_allclose(loads.moment, 0, atol=1e-14)


def test_centrifugal_force_of_a_uniform_beam_with_a_body():
    scene, speed = bd.Scene(replace(BEAM, tip=BODY), OUTWARD), 60.0
    loads = bd.static_loads(scene, [10.0, speed])
    r, x = scene.mount.radius, loads.x
    beam = MASS * (r * (LENGTH - x) + (LENGTH**2 - x**2) / 2)
    force = speed**2 * (beam + BODY.mass * (r + LENGTH + BODY.offset))
    np.testing.assert_allclose(loads.force[1, :, 0], force, rtol=1e-12)
    np.testing.assert_allclose(loads.force[0, :, 0], force / 36, rtol=1e-12)
    np.testing.assert_allclose(loads.strain[1, :, 0], force / EA, rtol=1e-12)


def test_a_bent_spinning_beam_against_its_curvature():
    """EI u'' of the full model, which converges to the same moment; the errors say so of all stations."""
    scene = bd.Scene(BEAM, bd.Mount(0.1, setting_angle=2.9))
    coarse = bd.static_loads(scene, 40.0, discretization=bd.Ritz(6))
    fine = bd.static_loads(scene, 40.0, discretization=bd.Ritz(24))
    for name in ("force", "moment", "strain"):
        true = np.abs(coarse.values(name) - fine.values(name))
        assert (true <= coarse.error_of(name) + fine.error_of(name)).all()
    assert np.abs(coarse.moment - fine.moment).max() > 1e-9 * np.abs(fine.moment).max()


def test_two_sides_of_a_jump_and_of_a_mass():
    """The moment is the same on both sides of a step, the strain is not; a mass steps the force."""
    loads = bd.static_loads(bd.Scene(STEPPED, OUTWARD, gravity=G), 30.0)
    step, mass = (np.flatnonzero(np.isclose(loads.x, part * LENGTH)) for part in (0.4, 0.7))
    assert loads.inboard[step].tolist() == loads.inboard[mass].tolist() == [True, False]
    assert loads.moment[0, step[0]] == pytest.approx(loads.moment[0, step[1]], rel=1e-12)
    thin, thick = loads.curvature[0, step[1]], loads.curvature[0, step[0]]
    assert thin == pytest.approx(1.5**3 * thick, rel=1e-9)
    jump = loads.force[0, mass[0]] - loads.force[0, mass[1]]
    assert jump[0] == pytest.approx(0.05 * 30.0**2 * (0.1 + 0.7 * LENGTH), rel=1e-9)
    one = bd.static_loads(bd.Scene(STEPPED, OUTWARD, gravity=G), 30.0, at=[0.4 * LENGTH])
    assert one.curvature[0, 0] == pytest.approx(thin, rel=1e-12)  # alone: the outboard side
    both = bd.static_loads(bd.Scene(STEPPED, OUTWARD, gravity=G), 30.0, at=[0.4 * LENGTH] * 2)
    assert both.curvature[0, :, 0] == pytest.approx([thick[0], thin[0]], rel=1e-12)


@pytest.mark.parametrize("discretization", ["ritz", "fem"])
def test_shear_forces_beside_a_jump_of_the_shear_stiffness(discretization):
    """The axis has a kink there, by which the axial force counts in that across: each side has its own."""
    twice = bd.Table([0.0, 0.4, 0.4, 1.0], [1.0, 1.0, 0.5, 0.5])
    stiffness = bd.Table(twice.stations, (4e4 * np.array(twice.values)).tolist())
    beam = bd.Beam.from_stiffness(1.0, 1.0, 500.0, shear_stiffness=stiffness)
    scene = bd.Scene(beam, bd.Mount(0.5, 2.5), physics=bd.Physics(shear=True))
    at = [0.4 - 1e-9, 0.4, 0.4, 0.4 + 1e-9]
    loads = bd.static_loads(scene, 20.0, at=at, discretization=discretization, tolerance=1e-4)
    _, before, jump, after = (*np.diff(loads.force[0, :, 1], prepend=0.0),)
    assert max(abs(before), abs(after)) < 1e-6 * abs(jump)


def test_points_of_the_section():
    """Bending in two planes: corners by default, and any point inside by superposition."""
    scene = bd.Scene(BEAM, bd.Mount(0.1, math.pi, bending_angle=0.5), gravity=G, physics=bd.Physics(planes=2))
    corners = bd.static_loads(scene, 20.0, at=[0.0, 0.1])
    assert corners.points.shape == (2, 4, 2)
    y, z = corners.points[0].T
    assert {*map(tuple, np.abs(corners.points[0]))} == {(THICK / 2, WIDTH / 2)}
    flat, edge = corners.curvature[0, 0]
    axial = corners.force[0, 0, 0] / EA
    assert corners.strain[0, 0] == pytest.approx(axial - y * flat - z * edge, rel=1e-12)
    inside = bd.static_loads(scene, 20.0, at=[0.0, 0.1], points=[(0.001, -0.004)])
    assert inside.strain[0, 0, 0] == pytest.approx(axial - 0.001 * flat + 0.004 * edge, rel=1e-12)


def test_largest_and_where():
    loads = bd.static_loads(bd.Scene(STEPPED, OUTWARD, gravity=G), [5.0, 30.0])
    found = loads.largest("force", 0)
    assert (found.x, found.case, found.component) == (0.0, 30.0, 0)
    assert found.value == loads.force[1, 0, 0]
    assert loads.x[loads.station_of(found)] == 0.0
    strain = loads.largest()
    assert abs(strain.value) == np.abs(loads.strain).max()


# Motion -------------------------------------------------------------------------------------------

SHAKEN = 40.0  # angular frequency of the root [rad/s]: between the first and the second of the beam


def shaken(t):
    zero = np.zeros_like(t)
    across = 3.0 * np.cos(SHAKEN * t)
    return bd.MotionSample(zero, zero, zero, np.stack([zero, zero, across], axis=-1))


def forced_cantilever(x):
    """Amplitudes of moment and shear of a uniform cantilever whose root accelerates by 3 cos(SHAKEN t)."""
    b = (MASS * SHAKEN**2 / EI) ** 0.25

    def derivatives(at, order):
        turn = order * math.pi / 2
        hyperbolic = [np.cosh, np.sinh] if order % 2 == 0 else [np.sinh, np.cosh]
        of_circle = [np.cos(b * at + turn), np.sin(b * at + turn)]
        return b**order * np.array([*(f(b * at) for f in hyperbolic), *of_circle])

    ends = np.array(
        [derivatives(0.0, 0), derivatives(0.0, 1), derivatives(LENGTH, 2), derivatives(LENGTH, 3)]
    )
    motion = np.linalg.solve(ends, [-3.0 / SHAKEN**2, 0, 0, 0])
    return EI * motion @ derivatives(x, 2), -EI * motion @ derivatives(x, 3)


def test_forced_vibration_of_a_uniform_cantilever():
    """Moment and shear of the differential equation, by 14 modes, to 1e-8: no curvature of modes enters."""
    mount = bd.Mount(0.0, bending_angle=math.pi / 2)
    scene = bd.Scene(BEAM, mount, bd.UserMotion(shaken, t_end=1.0))
    probe = bd.simulate(scene, 1e-3, modes=14)
    equations = probe.system.equations
    K, M = equations.matrices[0]["unity"], equations.matrices[2]["unity"]
    start = np.linalg.solve(K - SHAKEN**2 * M, 3.0 * equations.vectors["root_transverse"])
    run = bd.simulate(scene, 0.02, 14, 1e-10, initial=np.concatenate([start, 0 * start]))
    loads = bd.transient_loads(run, t=[0.0, 0.01, 0.02])
    moment, shear = forced_cantilever(loads.x)
    wave = np.cos(SHAKEN * loads.t)[:, None]
    tolerance = {"rtol": 0, "atol": 1e-8 * np.abs(moment).max()}
    np.testing.assert_allclose(loads.moment[..., 0], wave * moment, **tolerance)
    np.testing.assert_allclose(
        loads.force[..., 1], wave * shear, rtol=0, atol=1e-6 * np.abs(shear).max()
    )  # the shear forces of the modes left out fall as k^-6, the moments as k^-7
    np.testing.assert_allclose(loads.moment[..., 0], wave * moment, rtol=0, atol=loads.moment_error.max())


@pytest.mark.parametrize("part", loads_measured.PARTS)
def test_root_and_mid_span_against_closed_forms_and_the_unreduced_model(part):
    """Moment, strain, shear and axial force: under weight, spun, shaken, with a tip body; all to 1e-8."""
    for what, measured, bound in part():
        assert bound == "1e-08"
        assert max(map(float, measured.split(","))) < 1e-8, what


ROLLING = bd.RollingWheel(0.3, bd.SteadyRotation(20.0), bd.RoadWave(wavelength=0.4, velocity_amplitude=0.05))
MOVING = bd.Scene(BEAM, OUTWARD, ROLLING, damping_ratio=0.05, gravity=G)


@pytest.fixture(scope="module")
def run():
    return bd.simulate(MOVING, 2.0, modes=3, tolerance=1e-7)


def test_the_root_is_that_of_the_root_strain(run):
    loads = bd.transient_loads(run, points=[(-THICK / 2, 0.0)], t=np.linspace(0, 2, 50))
    bending = loads.curvature[:, 0, 0] * THICK / 2
    np.testing.assert_allclose(bending, run.root_strain(loads.t), rtol=1e-9, atol=1e-15)
    axial = loads.force[:, 0, 0] / EA
    np.testing.assert_allclose(loads.strain[:, 0, 0], bending + axial, rtol=1e-9, atol=1e-15)


def test_largest_of_a_run_lies_between_its_samples_and_in_its_window(run):
    loads = bd.transient_loads(run, at=[0.0, 0.2])
    fine = np.linspace(0.5, 1.5, 40001)
    there = loads.at("moment", fine)[..., 0]
    found = loads.largest("moment", start=0.5, end=1.5)
    k = int(np.abs(there[:, 0]).argmax())
    assert found.value == pytest.approx(there[k, 0], rel=1e-6)
    assert found.case == pytest.approx(fine[k], abs=1e-4)
    values, times = loads.peaks("moment", 0.5, 1.5)
    assert np.abs(values[:, 0]) == pytest.approx(np.abs(there).max(axis=0), rel=1e-6)
    assert ((times >= 0.5) & (times <= 1.5)).all()


def test_steady_response_is_what_remains_of_a_transient():
    """Loads after a long run, against the lines at the same phases."""
    response = bd.steady_response(MOVING, [20.0], modes=3)
    steady = bd.steady_loads(response, at=[0.0, 0.2])
    long = bd.transient_loads(bd.simulate(MOVING, 8.0, 3, 1e-9), at=[0.0, 0.2], t=np.linspace(7, 8, 60))
    angle = 20.0 * long.t
    for name in ("force", "moment", "strain"):
        over_phases = np.moveaxis(steady.at_phases(name, angle, ROLLING.road_multiple * angle)[0], -1, 0)
        size = np.abs(over_phases).max(axis=(0, 1))
        # 3 modes at rest against modes at two speeds; what is left of the start is exp(-0.05 * 2 pi 13 * 8)
        np.testing.assert_allclose(long.values(name) / size, over_phases / size, atol=3e-4)
        assert (np.abs(over_phases).max(axis=0) <= steady.values(name)[0] * (1 + 1e-9)).all()
    still = steady.mean("force")[0, :, 0]
    rest = LENGTH - steady.x
    expected = MASS * 400.0 * (0.1 * rest + (LENGTH**2 - steady.x**2) / 2)
    assert still == pytest.approx(expected, rel=2e-3)  # and the mean of Coriolis forces


@pytest.mark.slow
def test_errors_cover_a_sudden_start():
    """Gravity that acts at once, with few modes, against many."""
    scene = bd.Scene(BEAM, OUTWARD, bd.SteadyRotation(5.0), gravity=G)
    few, many = (
        bd.transient_loads(bd.simulate(scene, 0.4, m, 1e-8), t=np.linspace(0, 0.4, 300)) for m in (3, 24)
    )
    for name in ("force", "moment", "strain"):
        true = np.abs(few.values(name) - many.values(name)).max(axis=0)
        stated = few.error_of(name)
        assert (true <= stated).all(), name
        assert stated.max() < 20 * true.max(), name


def test_cycles_of_a_run(run):
    pytest.importorskip("rainflow", reason="cycle counts are the extra fatigue")
    loads = bd.transient_loads(run, at=[0.0])
    cycles = bd.count_cycles(loads, "moment", start=0.5, end=1.5)
    there = loads.at("moment", np.linspace(0.5, 1.5, 20001))[:, 0, 0]
    assert cycles.ranges.max() == pytest.approx(np.ptp(there), rel=2e-3)  # samples are within 1e-3 of maxima
    assert cycles.equivalent_range(5.0) >= cycles.ranges.max() * 0.5**0.2 * (1 - 1e-12)
    once = replace(cycles, ranges=np.array([2.0]), counts=np.array([8.0]), means=np.zeros(1))
    assert once.equivalent_range(3.0, cycles=1.0) == pytest.approx(4.0, rel=1e-12)
    assert once.plot().get_xscale() == "log"


def test_without_the_package_that_counts(run, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "rainflow", None)
    with pytest.raises(ImportError, match="fatigue"):
        bd.count_cycles(bd.transient_loads(run, at=[0.0], t=[0.0]), "moment")


def test_pictures(run):
    loads = bd.transient_loads(run)
    assert loads.plot(quantity="force").get_ylabel() == "force [N]"
    assert len(loads.plot_over_time(0).lines) == 1
    assert len(bd.static_loads(MOVING, [0.0, 5.0]).plot().lines) == 2


# Bad input ----------------------------------------------------------------------------------------

BENT = replace(MOVING, physics=bd.Physics(large_deflection=True), mount=replace(OUTWARD, bending_angle=0.0))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"at": [0.6]}, "at = 0.6 m: stations must lie from the root, 0, to the tip, 0.5 m"),
        ({"at": [-0.1]}, "at = -0.1 m: stations must lie"),
        ({"at": [0.2, 0.1]}, "must ascend"),
        ({"at": [0.1] * 3}, "twice for both sides"),
        ({"at": []}, "give 1 to"),
        ({"points": [(0.003, 0.0)]}, "points = 0.003 m: it lies outside the section"),
        ({"points": [(0.0, 0.02)]}, "the smallest section reaches 0.01 m in the second direction"),
        ({"points": [0.001]}, "pairs"),
        ({"points": [(math.nan, 0.0)]}, "finite"),
        ({"youngs_modulus": -1.0}, "youngs_modulus"),
    ],
)
def test_refusals(given, said):
    with pytest.raises(ValueError, match=re.escape(said)):
        bd.static_loads(MOVING, 5.0, **given)


def test_what_large_deflection_and_buckling_refuse(run):
    with pytest.raises(InvalidValue, match="large deflection are not computed"):
        bd.static_loads(BENT, 5.0)
    with pytest.raises(InvalidValue, match="large deflection are not computed"):
        bd.transient_loads(bd.simulate(BENT, 0.02, 2))
    with pytest.raises(InvalidValue, match="large deflection are not computed"):
        bd.steady_loads(bd.steady_response(BENT, [5.0], 2))
    inward = bd.Scene(BEAM, bd.Mount(2.0, 0.0))
    with pytest.raises(bd.NoEquilibrium, match="buckles it"):
        bd.static_loads(inward, 2 * bd.critical_speed(inward))
    with pytest.raises(InvalidValue, match="the window must lie in the run"):
        bd.transient_loads(run).largest(start=1.0, end=3.0)


def test_what_a_beam_of_stiffnesses_lacks():
    bare = bd.Beam.from_stiffness(LENGTH, MASS, EI)
    loads = bd.static_loads(bd.Scene(bare, OUTWARD, gravity=G), 5.0)
    assert loads.strain.shape == (1, 21, 0)
    with pytest.raises(InvalidValue, match="outer_fibre"):
        loads.largest()
    fibre = bd.Beam.from_stiffness(LENGTH, MASS, EI, outer_fibre=THICK / 2)
    bending = bd.static_loads(bd.Scene(fibre, OUTWARD, gravity=G), 5.0)
    assert any("bending alone" in said for said in bending.warnings)
    assert np.isnan(bending.stress).all()
    known = bd.static_loads(bd.Scene(fibre, OUTWARD, gravity=G), 5.0, youngs_modulus=E)
    assert known.stress == pytest.approx(E * known.strain, rel=1e-14)


@pytest.mark.parametrize(
    ("name", "known"),
    [
        ("mass_per_length", True),
        ("shear_stiffness", True),
        ("bending_stiffness", False),
        ("axial_stiffness", False),
    ],
)
def test_stresses_of_a_scaled_property(name, known):
    """Young's modulus is in doubt where a stiffness by which strain follows has a factor, and only there."""
    ratio = replace(BEAM.section, poissons_ratio=0.3)
    scene = bd.Scene(BEAM.with_section(ratio), OUTWARD, gravity=G)
    loads = bd.static_loads(with_numbers(scene, {f"beam.scale.{name}": 1.1}), 5.0)
    wanted = E * loads.strain if known else np.full_like(loads.strain, math.nan)
    np.testing.assert_allclose(loads.stress, wanted, rtol=1e-14)


def test_statics_do_not_ask_for_damping_and_say_what_auto_adds():
    plain, damped = bd.Scene(BEAM, OUTWARD), bd.Scene(BEAM, OUTWARD, damping=bd.Damping(mass_factor=1.0))
    both = [bd.static_loads(scene, [20.0]) for scene in (plain, damped)]
    np.testing.assert_array_equal(both[0].force, both[1].force)
    auto = bd.static_loads(replace(plain, physics="auto"), [20.0])
    assert auto.physics_choice is not None and not auto.physics_choice.included  # it lacks the data


def test_statics_warn_of_stretch():
    assert not any("strain" in said for said in bd.static_loads(bd.Scene(BEAM, OUTWARD), [20.0]).warnings)
    found = bd.static_loads(bd.Scene(BEAM, OUTWARD), [5e3])
    assert any("axial strain reaches" in said for said in found.warnings)


def test_pictures_show_the_largest_of_speeds_and_the_window_of_a_run():
    response = bd.steady_response(MOVING, np.linspace(5.0, 15.0, 7), modes=3)
    steady = bd.steady_loads(response)
    (line,) = steady.plot().lines
    np.testing.assert_array_equal(line.get_ydata(), steady.moment[..., 0].max(axis=0))
    run = bd.transient_loads(bd.simulate(MOVING, 0.5, modes=3))
    whole, late = (
        [line.get_ydata().max() for line in each.lines] for each in (run.plot(), run.plot(start=0.4))
    )
    assert max(late) < max(whole)
    unknown = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 10.0), bd.Mount(0.1, math.pi))
    with pytest.raises(ValueError, match="the result has no stress"):
        bd.static_loads(unknown, [1.0]).plot(quantity="stress")


# Errors -------------------------------------------------------------------------------------------


def test_a_load_that_is_rounding_has_a_finite_error():
    """A moment of 1e-20 beside a force of 1 N: how far two models differ there says nothing."""
    scene = bd.Scene(BEAM, OUTWARD)
    stations = stations_at(BEAM, [0.0, 0.25])
    outputs = sections_at(scene, stations).outputs
    distance = np.tile([1e-9, 1e-20, 1e-20], (23, 1))
    error = mode_error(
        distance, np.array([1.0, 1e-20, 1e-20]), stations, outputs, ModalBasis(3, (0.0,)), LENGTH
    )
    assert np.isfinite(error).all()
    assert (error[:, 1:3] < 1e-11).all() and (error[:, 1:3] > 0).all()
    far = mode_error(
        distance, np.array([1e-9, 1e-20, 1e-20]), stations, outputs, ModalBasis(3, (0.0,)), LENGTH
    )
    assert np.isinf(far[:, 0]).all()


def test_a_shock_between_evenly_spaced_times_counts_in_the_error_of_time():
    """Along the beam, for 1 ms of a run of 2 s: its arm on the deflection is in the loads per coordinate."""
    at, width = 0.7731, 2e-4

    def shock(t):
        zero = np.zeros_like(t)
        along = 5e3 * np.exp(-(((t - at) / width) ** 2))
        return bd.MotionSample(zero, zero, zero, np.stack([along, 0 * t, 0.1 * np.cos(30 * t)], axis=-1))

    mount = bd.Mount(0.1, math.pi, math.pi / 2)
    motion = bd.UserMotion(shock, t_end=2.0, breakpoints=(at - 5 * width, at + 5 * width))
    run = bd.simulate(bd.Scene(BEAM, mount, motion), 2.0, 2, 1e-4)
    system = run.system
    rows = span_rows(run.scene, run.request.model.discretization, system.equations, stations_at(BEAM, [0.0]))
    per_coordinate = largest_per_coordinate(rows.in_motion(system.equations), system, run.path, np.zeros(2))
    strongest = abs(system.root(np.array([at])).root_axial[0])
    arm = np.abs(rows.in_motion(system.equations).position["root_axial"]) * strongest
    assert (per_coordinate >= 0.9 * arm).all()
