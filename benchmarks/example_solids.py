"""Test whether solid bodies (FE) contradict the model errors stated for the scenes of examples/.

Run: python -m benchmarks.example_solids.  Each scene with a rectangular section is solved with the scene's
physics, but without a tip body, at rest; a beam that points towards the axis or away from it also at a speed.
CalculiX solves the beam as a solid on three meshes.  A model error is contradicted if the true difference of
a bending frequency, less the error of the solid's frequency, is more than twice the model error.
"""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # set before numpy is imported

import numpy as np

import beamdyn as bd
from benchmarks.peers.solids import BENDING, Strip, reference
from benchmarks.rows import Row, show

EXAMPLES = Path(__file__).parents[1] / "examples"
# Number of modes, allowed ratio of errors, and speed over the critical speed or first frequency.
_MODES, _ALLOWED, _SHARE = 3, 2.0, 0.6


def scenes() -> Iterator[tuple[str, bd.Scene]]:
    """Yield scenes of beams with a rectangular section, each section once."""
    seen = set()
    for path in sorted(EXAMPLES.glob("*.toml")):
        try:
            scene = bd.load_scene(path)
        except ValueError:  # the file describes a brake
            continue
        if scene.beam.section is not None and scene.beam.twist is None:
            beam = replace(scene.beam, tip=None, point_masses=(), point_springs=())
            bare = replace(scene.undamped, beam=beam, motion=None, gravity=0.0)
            if (beam, bare.mount) not in seen:
                seen.add((beam, bare.mount))
                yield path.name, bare


def strip_of(scene: bd.Scene, speed: float) -> Strip:
    """Return the beam of a scene as a solid body."""
    section, mount, end = scene.beam.section, scene.mount, np.zeros(1)
    assert section is not None
    t, b = float(section.thickness(end)[0]), float(section.width(end)[0])
    varies = bool(section.thickness.degree or section.width.degree or len(section.thickness.breakpoints) > 2)

    def taper(xi: float) -> tuple[float, float]:
        at = np.array([xi])
        return float(section.thickness(at)[0]) / t, float(section.width(at)[0]) / b

    angles = math.degrees(mount.setting_angle), math.degrees(mount.bending_angle)
    material = section.youngs_modulus, section.density, section.poissons_ratio or 0.3
    return Strip(scene.beam.length, b, t, *material, mount.radius, *angles, speed, taper if varies else None)


def speeds_of(scene: bd.Scene) -> list[float]:
    """Return the speed 0, and a second speed [rad/s] if the beam points at the axis or away from it."""
    if math.sin(scene.mount.setting_angle) > 1e-9:
        return [0.0]
    critical = bd.critical_speed(scene)
    turning = critical if math.isfinite(critical) else 2 * math.pi * bd.natural_modes(scene).frequency[0]
    return [0.0, float(f"{_SHARE * turning:.2g}")]


def compare() -> Iterator[Row]:
    """Yield for each scene the largest true difference of its modes, its model error, and the bound."""
    for name, scene in scenes():
        for speed in speeds_of(scene):
            solid = [mode for mode in reference(strip_of(scene, speed)) if mode.kind == BENDING][:_MODES]
            with warnings.catch_warnings(action="ignore"):  # warnings about the model errors compared here
                found = bd.natural_modes(scene, speed, _MODES)
                stated = found.model_error
            true = np.abs([m.frequency / f - 1 for m, f in zip(solid, found.frequency, strict=False)])
            own = np.array([mode.error for mode in solid])
            holds = true <= _ALLOWED * stated[: len(true)] + own
            worst = int((true - _ALLOWED * stated[: len(true)]).argmax())
            said = f"{true[worst]:.1e}, {stated[worst]:.1e}, {own[worst]:.0e}"
            verdict = "holds" if holds.all() else "contradicted"
            yield f"{name} at {speed:g} rad/s: true, stated, solids' own", said, verdict


if __name__ == "__main__":
    show("model errors of the examples beside solids", compare)
