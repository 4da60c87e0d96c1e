"""Scenes as TOML gives them, and the mistakes that are found in them."""

import copy
from pathlib import Path

import pytest

from beamdyn.common.edge.config import ConfigError
from beamdyn.files.scenes import scene_from_dict

HARVESTER = {
    "beam": {
        "length": "50 mm",
        "width": "10 mm",
        "thickness": "0.2 mm",
        "youngs_modulus": "200 GPa",
        "density": "7850 kg/m3",
    },
    "mount": {"radius": "215 mm"},
}
STRIP_TOML = """
[beam]
length = "50 mm"
width = "10 mm"
thickness = "0.2 mm"
youngs_modulus = "200 GPa"
density = "7850 kg/m3"
"""  # its beam
BY_STIFFNESS = {
    "beam": {"length": "50 mm", "mass_per_length": "15.7 g/m", "bending_stiffness": "1.3e-3 N m2"},
    "mount": {"radius": "215 mm"},
}

SPIN_UP = {"kind": "spin_up", "speed": "55 rad/s", "duration": "10 s"}
SAMPLED = {"kind": "sampled", "times": ["0 s", "1 s"], "speeds": ["0 rpm", "525 rpm"]}
ROLLING = {"kind": "rolling", "rolling_radius": "300 mm", "rotation": SPIN_UP}


def changed(path, value, scene=HARVESTER):
    """Copy a scene with one key set, or deleted where the value is None."""
    scene = copy.deepcopy(scene)
    *tables, key = path.split(".")
    inner = scene
    for table in tables:
        inner = inner.setdefault(table, {})
    inner.pop(key, None)
    if value is not None:
        inner[key] = value
    return scene


def mistakes(data):
    with pytest.raises(ConfigError) as refusal:
        scene_from_dict(data)
    return refusal.value.mistakes


def only_mistake(data):
    (mistake,) = mistakes(data)
    return mistake


def without_camber(example: str | Path, folder: Path) -> str:
    """Copy an example with Poisson's ratio 0, so that camber of sections plays no part in a test."""
    text = Path(example).read_text(encoding="utf-8")
    assert "poissons_ratio = 0.3" in text
    copied = folder / Path(example).name
    copied.write_text(text.replace("poissons_ratio = 0.3", "poissons_ratio = 0"), encoding="utf-8")
    return str(copied)
