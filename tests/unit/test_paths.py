"""Parts of nested objects by their paths."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import part_at, with_parts
from beamdyn.scene.numbers import SPEED, number_at, paths_of, unit_of, with_numbers

TABLES = {"pad": {"at": ["1 mm", "2 mm"]}, "left arm": {"springs": [{"k": 1.0}, {"k": 2.0}]}}
BEAM = bd.Beam.rectangular(
    0.05, 0.01, 2e-4, 200e9, 7850.0, tip=bd.TipMass(1e-3, 1e-3, 2e-8, 2e-8, 1e-8), twist=0.1,
    poissons_ratio=0.3, point_masses=[bd.PointMass(0.02, 1e-3)], point_springs=[bd.PointSpring(0.03, 10.0)],
)  # fmt: skip
WHEEL = bd.RollingWheel(0.3, bd.SpinUp(50.0, duration=1.0), bd.RoadWave(0.3, height=1e-3))
SCENE = bd.Scene(
    BEAM, bd.Mount(0.2, 0.1, 0.2, 5.0, 6.0), WHEEL, gravity=9.81, damping=bd.Damping((0.01, 0.02), 0.1, 1e-6)
)


@dataclass(frozen=True)
class Both:
    """Two numbers, the first of which is the smaller."""

    low: float
    high: float

    def __post_init__(self) -> None:
        assert self.low < self.high


def test_tables_lists_and_points():
    assert part_at(TABLES, "pad.at.y") == "2 mm" and part_at(TABLES, "left arm.springs[1].k") == 2.0
    assert part_at(TABLES, "pad.nothing.there") is None and part_at(TABLES, "left arm.springs[2].k") is None
    changed = with_parts(TABLES, {"pad.at.x": "3 mm", "left arm.springs[0].k": 5.0, "new.table": 1})
    assert changed["pad"]["at"] == ["3 mm", "2 mm"] and changed["new"] == {"table": 1}
    assert (
        changed["left arm"]["springs"] == [{"k": 5.0}, {"k": 2.0}] and part_at(TABLES, "pad.at.x") == "1 mm"
    )


def test_parts_that_depend_on_each_other_are_replaced_at_once():
    assert with_parts(Both(1.0, 2.0), {"low": 3.0, "high": 4.0}) == Both(3.0, 4.0)


@pytest.mark.parametrize("path", [path for path in paths_of(SCENE) if path != SPEED])
def test_each_number_of_a_scene_is_got_as_it_was_set(path):
    assert unit_of(path) is not None
    value = number_at(SCENE, path)
    if value is None or path == "model.damping_ratio":  # with ratios of modes none of all, too
        return
    if "scale" in path or path == "mount.precone":  # a factor; that of an outward beam alone
        return
    other = value * 1.01
    changed = with_numbers(SCENE, {path: other})
    assert number_at(changed, path) == pytest.approx(other, rel=1e-15)
    assert with_numbers(changed, {path: value}) == SCENE


def test_moments_of_inertia_are_set_together():
    both = {"beam.tip.inertia": 2e-6, "beam.tip.transverse_inertia": 2e-6}  # each alone is of no rigid body
    tip = with_numbers(SCENE, both).beam.tip
    assert (tip.inertia, tip.transverse_inertia) == (2e-6, 2e-6)
    with pytest.raises(InvalidValue):
        with_numbers(SCENE, {"beam.tip.inertia": 2e-6})


def test_what_varies_along_the_beam_is_no_number():
    tapered = bd.Beam.rectangular(0.05, 0.01, bd.Table([0, 1], [3e-4, 1e-4]), 200e9, 7850.0)
    scene = replace(SCENE, beam=tapered)
    assert np.isnan(number_at(scene, "beam.thickness")) and number_at(scene, "beam.width") == 0.01
    assert number_at(scene, "beam.tip.mass") == 0.0 and number_at(scene, "beam.twist") is None


LAYERS = bd.Harvester(1.5e-4, 7750.0, d31=-171e-12, s11e=1 / 61e9, eps33t=15.33e-9, end=0.03)
STRIP = bd.Beam.rectangular(0.05, 0.01, bd.Table([0, 0.8, 1], [2e-4, 2e-4, 1e-4]), 200e9, 7850.0)
WITH_LAYERS = bd.Scene(LAYERS.on(STRIP), bd.Mount(0.2))


@pytest.mark.parametrize(
    ("scene", "name", "why"),
    [
        (WITH_LAYERS, "mass_per_length", "layers need .*; vary beam.density"),
        (SCENE, "torsion_stiffness", "the beam has no such property"),
        (bd.load_scene("examples/iea_15_blade.toml"), "bending_stiffness", "6 x 6 section matrices"),
        (bd.load_scene("examples/iea_15_blade.toml"), "thickness", "6 x 6 section matrices"),
    ],
)
def test_what_takes_no_factor(scene, name, why):
    path = f"beam.scale.{name}"
    assert number_at(scene, path) is None
    with pytest.raises(InvalidValue, match=f"{path} = 1.1: .*{why}"):
        with_numbers(scene, {path: 1.1})


def test_sections_under_layers_take_factors():
    assert number_at(WITH_LAYERS, "beam.scale.thickness") == 1.0
    thicker = with_numbers(WITH_LAYERS, {"beam.scale.thickness": 1.1}).beam.electrodes.bare.section.thickness
    assert thicker(0.5) == pytest.approx(2.2e-4, rel=1e-14)
