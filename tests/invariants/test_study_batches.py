"""Batches give what single calls give, within the stated errors of both, and workers change no bit."""

import os
import signal
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from tests.child_processes import by_proc, children

BEAM = bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0)
TAPERED = bd.Beam.from_stiffness(
    0.05,
    bd.Table([0, 0.3, 0.6, 1], [0.02, 0.016, 0.014, 0.01]),
    bd.Table([0, 0.3, 0.6, 1], [3e-3, 2e-3, 1e-3, 6e-4]),
    bd.Table([0, 1], [5e5, 2e5]),
    second_bending_stiffness=bd.Table([0, 1], [0.4, 0.1]),
)
STATIONS = np.linspace(0, 1, 8)  # with more than six segments functions are of another kind
BLADE = bd.Beam.from_stiffness(
    0.05, bd.Table(STATIONS, 0.02 - 0.01 * STATIONS**2), bd.Table(STATIONS, 3e-3 * (1.1 - STATIONS) ** 2), 4e5
)
EXAMPLE = bd.load_scene(Path(__file__).parents[2] / "examples" / "blade_of_stations.toml")
ROAD = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
ROLLING = bd.RollingWheel(0.3, bd.SteadyRotation(50.0), ROAD)
TIP = {
    "beam.tip.mass": (0.0, 2e-3),
    "beam.tip.offset": (-0.005, 0.005),
    "beam.tip.inertia": (1e-8, 2e-8),
    "beam.tip.axial_inertia": (0.0, 2e-8),
}
POINT = {"beam.tip.mass": (0.0, 2e-3), "beam.tip.offset": (-0.005, 0.005)}
MOUNT = {
    "mount.radius": (0.0, 0.4),
    "mount.setting_angle": (0.0, np.pi),
    "mount.bending_angle": (0.0, np.pi / 2),
}
SPEED = {"speed": (0.0, 150.0)}
SIZES = {"beam.thickness": (1e-4, 4e-4), "beam.length": (0.03, 0.08)}
SCALES = {"beam.scale.thickness": (0.5, 2.0), "beam.scale.mass_per_length": (0.7, 1.4)}
DESIGNS = 12  # each of which is also solved alone
FEW = 5  # the same of scenes that take longer


def draw(ranges, count=DESIGNS, **more):
    random = np.random.default_rng(17)
    return {name: random.uniform(*ends, count) for name, ends in ranges.items()} | more


def springs(count=DESIGNS):
    """Soft and stiff beside the beam's own 0.03 N m/rad."""
    return 10 ** np.random.default_rng(3).uniform(-5, 2, count)


def bodies(count=DESIGNS):
    """Moments of inertia of plates, bars and cubes: those of one with those of another are of no body."""
    along, bending, across = 10 ** np.random.default_rng(5).uniform(-8, -6, (3, count))
    moments = {"inertia": along + bending, "transverse_inertia": along + across}
    return {f"beam.tip.{name}": v for name, v in (moments | {"axial_inertia": bending + across}).items()}


def needles(count=DESIGNS):
    """Moments of inertia whose difference, of rounding, is more than that of a body."""
    inertia, axial = np.random.default_rng(0).uniform(1e-10, 1e-9, count), np.full(count, 1e-4)
    moments = {"inertia": inertia, "transverse_inertia": inertia + axial, "axial_inertia": axial}
    return {f"beam.tip.{name}": v for name, v in moments.items()}


FREQUENCIES = {
    "damped": (bd.Scene(BEAM, bd.Mount(0.1)), draw(MOUNT | SPEED | {"model.damping_ratio": (0.0, 0.3)})),
    "strongly damped": (bd.Scene(BEAM, bd.Mount(0.1)), draw(SPEED | {"model.damping_ratio": (0.5, 0.95)})),
    "on springs": (
        bd.Scene(BEAM, bd.Mount(0.1, root_stiffness=1.0)),
        draw(MOUNT | SPEED | SIZES) | {"mount.root_stiffness": springs()},
    ),
    "two planes": (
        bd.Scene(BEAM, bd.Mount(0.1), physics=bd.Physics(planes=2)),
        draw(MOUNT | SPEED | {"beam.thickness": (1e-4, 4e-4), "beam.tip.mass": (0.0, 1e-3)}),
    ),
    "two planes, bodies": (
        bd.Scene(BEAM, bd.Mount(0.1), physics=bd.Physics(planes=2)),
        draw({"speed": (0.0, 60.0), "mount.bending_angle": (-1.0, 1.0)}) | bodies(),
    ),
    "two planes, one body of several lengths": (
        bd.Scene(replace(BEAM, tip=bd.TipMass(1e-3, 0.0, 3e-7, 2e-7, 4e-7)), physics=bd.Physics(planes=2)),
        draw({"beam.length": (0.1, 0.2)}) | {"speed": np.zeros(DESIGNS)},
    ),
    "needles along the axis of bending": (bd.Scene(BEAM, bd.Mount(0.1)), draw(SPEED) | needles()),
    "two planes, twisted": (
        bd.Scene(
            bd.Beam.rectangular(0.05, 0.01, 2e-3, 200e9, 7850.0, twist=np.polynomial.Polynomial([0.0, 0.6])),
            bd.Mount(0.1, np.pi),
            physics=bd.Physics(planes=2),
        ),
        draw({"mount.radius": (0.0, 0.4), "mount.bending_angle": (-1.0, 1.0), "speed": (0.0, 900.0)}),
    ),
    "two planes, a table scaled": (
        bd.Scene(TAPERED, bd.Mount(0.1), physics=bd.Physics(planes=2)),
        draw(SCALES | SPEED | {"beam.scale.second_bending_stiffness": (0.5, 2.0)}, FEW),
    ),
    "a table of many stations scaled": (bd.Scene(BLADE, bd.Mount(0.1)), draw(SCALES | SPEED, FEW)),
    "a twisted blade of many stations": (
        replace(EXAMPLE, beam=replace(EXAMPLE.beam, tip=bd.TipMass(100.0))),
        draw({"mount.radius": (1.0, 3.0), "beam.tip.mass": (0.0, 300.0), "speed": (0.0, 3.0)}, FEW),
    ),
    "gravity": (bd.Scene(BEAM, bd.Mount(0.1)), draw(SPEED | {"model.gravity": (0.0, 20.0)})),
    "point masses": (
        bd.Scene(
            bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0, point_masses=(bd.PointMass(0.02, 1e-4),)),
            bd.Mount(0.1),
        ),
        draw(MOUNT | SPEED),
    ),
}


@pytest.mark.parametrize("name", FREQUENCIES)
def test_frequencies(name):
    """The exact value lies within the error of either: they differ by no more than the sum."""
    scene, vary = FREQUENCIES[name]
    study = bd.study(scene, vary, combine="zip")
    assert "batched" in study.provenance.method
    compared = 0
    for i in range(study.shape[0]):
        single = bd.natural_modes(study.scene_at(i), study.design(i)["speed"])
        known = np.isfinite(single.error) & np.isfinite(study.error[i])
        assert np.array_equal(study.status[i][known], single.status[known])
        vibrates = known & np.isfinite(single.frequency)
        deviation = np.abs(study.value[i] - single.frequency)[vibrates]
        # Errors are of eigenvalues, of which a frequency is the imaginary part.
        size = np.abs(single.eigenvalue)[vibrates] / (2 * np.pi)
        assert (deviation <= (study.error[i] + single.error)[vibrates] * size).all()
        compared += vibrates.sum()
    assert compared > (0 if name == "strongly damped" else study.shape[0])


CRITICAL = {
    "slender": (bd.Scene(BEAM, bd.Mount(0.1)), draw(MOUNT | TIP)),
    "on springs": (
        bd.Scene(BEAM, bd.Mount(0.1, root_stiffness=1.0)),
        draw(MOUNT) | {"mount.root_stiffness": springs()},
    ),
    "two planes": (bd.Scene(BEAM, bd.Mount(0.1), physics=bd.Physics(planes=2)), draw(MOUNT | POINT)),
    "a table of many stations scaled": (bd.Scene(BLADE, bd.Mount(0.3)), draw(SCALES, FEW)),
    "damped": (bd.Scene(BEAM, bd.Mount(0.1)), draw(MOUNT | {"model.damping_ratio": (0.0, 0.3)})),
}


@pytest.mark.parametrize("name", CRITICAL)
def test_critical_speeds(name):
    scene, vary = CRITICAL[name]
    study = bd.study(scene, vary, "critical_speed", combine="zip")
    assert "batched" in study.provenance.method and (study.status == "buckles").any()
    for i in range(study.shape[0]):
        single = bd.critical_point(study.scene_at(i))
        buckles = np.isfinite(single.speed)
        assert (study.status[i] == "buckles") == buckles
        if buckles:
            assert abs(study.value[i] / single.speed - 1) <= study.error[i] + single.error


@pytest.mark.parametrize("inertia", [[0.0], [0.0, 1e-7, 2e-7]], ids=["point", "body"])
def test_rotation_stiffens_only_what_single_calls_say_does_not_buckle(inertia):
    """The argument in arrays is that of a single scene, also at its edges."""
    ends = {"mount.radius": [0.0, 0.02], "mount.bending_angle": [0.0, 0.7, np.pi / 2]}
    tip = {"beam.tip.mass": [0.0, 1e-3], "beam.tip.offset": [-0.04, 0.0], "beam.tip.axial_inertia": inertia}
    body = bd.TipMass(0.0, 0.0, 1e-7 if inertia[-1] else 0.0)
    scene = bd.Scene(bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0, body), bd.Mount(0.1, np.pi))
    study = bd.study(scene, ends | tip, "critical_speed")
    for place in np.ndindex(study.shape):
        single = bd.critical_point(study.scene_at(*place))
        assert np.isfinite(single.speed) == np.isfinite(study.value[place]), study.design(*place)


def test_crossings():
    scene = bd.Scene(BEAM, bd.Mount(0.1), ROLLING, damping_ratio=0.02, gravity=9.81)
    ranges = {"mount.radius": (0.0, 0.3), "mount.setting_angle": (0.0, np.pi), "beam.tip.mass": (0.0, 1e-3)}
    study = bd.study(scene, draw(ranges, 8), "crossings", speed=150.0, combine="zip")
    assert "batched" in study.provenance.method
    for i in range(study.shape[0]):
        found = {
            (c.kind, round(c.line.multiple, 9), c.mode): c
            for c in bd.resonance_speeds(study.scene_at(i), 150.0)
        }
        for resonance, value, error in zip(
            study.question.resonances, study.value[i], study.error[i], strict=True
        ):
            single = found.pop(resonance.key, None)
            assert (single is None) == np.isnan(value)
            if single is not None:
                assert abs(value / single.speed - 1) <= error + single.error
        assert not found


@pytest.mark.slow
@by_proc
def test_workers_and_a_killed_one_change_no_bit():
    vary = draw({"mount.radius": (0.0, 0.3), "beam.thickness": (1e-4, 4e-4)} | SPEED, 2500)
    scene = bd.Scene(BEAM, bd.Mount(0.1))
    alone = bd.study(scene, vary, combine="zip")
    killed, others = [], children(os.getpid())

    def kill_one(done, total):
        """Kill a worker, once the first part is done."""
        if done and not killed:
            killed.append(max(set(children(os.getpid())) - set(others)))
            os.kill(killed[0], signal.SIGKILL)

    together = bd.study(scene, vary, combine="zip", workers=2, progress=kill_one)
    assert killed and np.array_equal(alone.value, together.value, equal_nan=True)
    assert np.array_equal(alone.error, together.error) and alone.warnings == together.warnings


def test_one_speed_axis_among_others_is_the_same_as_designs_one_by_one():
    """Parts of a product, split over designs and over speeds, stand where they belong."""
    thickness, speeds = np.linspace(1e-4, 4e-4, 3), np.linspace(0.0, 60.0, 1500)
    scene = bd.Scene(BEAM, bd.Mount(0.1))
    product = bd.study(scene, {"speed": speeds, "beam.thickness": thickness}, modes=2)
    rows = {"speed": np.repeat(speeds, 3), "beam.thickness": np.tile(thickness, 1500)}
    together = bd.study(scene, rows, modes=2, combine="zip")
    distance = np.abs(product.value.reshape(-1, 2) / together.value - 1)
    assert (distance <= product.error.reshape(-1, 2) + together.error).all()


def test_designs_none_of_which_buckles():
    scene = bd.Scene(bd.Beam.rectangular(0.12, 0.015, 0.001, 210e9, 7850.0), bd.Mount(0.08, np.pi))
    found = bd.study(scene, {"mount.radius": [0.0, 0.05, 0.1]}, "critical_speed")
    assert np.isinf(found.value).all() and (found.status == "does not buckle").all()
    assert (found.error == 0).all()


@pytest.mark.filterwarnings("ignore::beamdyn.OutsideLinearTheory")
def test_a_setting_angle_beside_a_right_angle_counts_as_it_stands() -> None:
    """The tension is linear in it: taken for a right angle it would move a frequency by 2e-7."""
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(50.0, np.pi / 2))
    angles = np.pi / 2 - np.linspace(1e-9, 9e-9, 8)
    study = bd.study(scene, {"mount.setting_angle": angles}, speed=3.0, modes=1)
    alone = [bd.natural_modes(bd.Scene(scene.beam, bd.Mount(50.0, a)), 3.0, 1).frequency[0] for a in angles]
    np.testing.assert_allclose(study.value[:, 0], alone, rtol=1e-12)
