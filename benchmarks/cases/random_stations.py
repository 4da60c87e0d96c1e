"""Random blades given by tables of many stations, with jumps and stiffnesses that fall by many decades."""

from __future__ import annotations

import math

import numpy as np

import beamdyn as bd
from beamdyn.modes.modal.model import Model

_FEWEST, _MOST = 10, 100  # least and largest number of stations
_DECADES = 8.0  # largest number of decades by which a stiffness falls from root to tip
_ROUGHNESS = 0.2  # scatter of the logarithm of a property from station to station
_JUMPS = 0.1  # fraction of stations at which the properties jump
_CLOSEST = 1e-3  # least distance of two stations
_FASTEST = 3.0  # largest speed, over the first angular frequency at rest


def random_station_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a blade and a speed: one plane or two, of which half are twisted; every fifth has a tip body."""
    stations = _random_stations(rng)
    fall = rng.uniform(0, _DECADES)
    beam = bd.Beam.from_stiffness(
        1.0,
        _random_table(rng, stations, rng.uniform(0, fall / 2)),
        _random_table(rng, stations, fall),
        second_bending_stiffness=_random_table(rng, stations, rng.uniform(0, fall), 10 ** rng.uniform(-1, 2)),
        twist=_random_twist(rng, stations) if rng.integers(2) else None,
        tip=bd.TipMass(10 ** rng.uniform(-3, 0)) if rng.random() < 0.2 else None,
    )
    angles = rng.choice([0.0, math.pi / 2, rng.uniform(-math.pi, math.pi)], p=[0.4, 0.4, 0.2])
    mount = bd.Mount(rng.uniform(0, 0.5), math.pi, float(angles))
    scene = bd.Scene(beam, mount, physics=bd.Physics(planes=2 if rng.integers(2) else 1))
    lowest = Model(scene, bd.Ritz(12, "moments")).solver.lowest_at_rest
    return scene, float(rng.uniform(0, _FASTEST) * math.sqrt(lowest))


def _random_stations(rng: np.random.Generator) -> np.ndarray:
    """Draw positions x/L; a repeated one is a jump."""
    count = int(rng.integers(_FEWEST, _MOST + 1))
    inner = np.sort(rng.uniform(0, 1, count - 2))
    inner = inner[np.diff(inner, prepend=0.0, append=1.0)[:-1] > _CLOSEST]
    inner = inner[inner < 1 - _CLOSEST]
    jumps = inner[rng.random(len(inner)) < _JUMPS]
    return np.sort(np.concatenate([[0.0, 1.0], inner, jumps]))


def _random_table(rng: np.random.Generator, stations: np.ndarray, fall: float, root: float = 1.0) -> bd.Table:
    """Draw values at stations that fall by some decades towards the tip, with random scatter."""
    rough = _ROUGHNESS * rng.standard_normal(len(stations))
    return bd.Table(stations.tolist(), (root * np.exp(rough) * 10 ** (-fall * stations)).tolist())


def _random_twist(rng: np.random.Generator, stations: np.ndarray) -> bd.Table:
    """Draw a twist [rad] from the root to the tip, with kinks but no jumps."""
    places = np.unique(stations)
    return bd.Table(places.tolist(), (rng.uniform(-0.5, 0.5) * (1 - places) ** 2).tolist())
