"""Proofs that no design is there hold against random scenes and a search by brute force, or are not given."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.inputs.described import VariedInput
from beamdyn.common.results.statements import unannounced
from beamdyn.scene.numbers import number_at
from beamdyn.studies.designing.proofs import Proofs
from beamdyn.studies.designing.quotients import QUOTIENTS, ways
from beamdyn.studies.designing.search import Ranges, Search
from beamdyn.studies.similar import POWERS

STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
OWN = 7850.0 * 0.05 * 0.01 * 0.0002  # mass of the strip [kg]
NUMBERS = (
    *("beam.youngs_modulus", "beam.density", "beam.thickness", "beam.width", "beam.length", "mount.radius"),
    *("beam.tip.mass", "beam.tip.inertia", "beam.tip.offset", "mount.root_stiffness", "mount.setting_angle"),
    *("beam.scale.thickness", "beam.scale.mass_per_length", "beam.point_mass[0].mass"),
)
BOUNDS = {
    **{"beam.tip.mass": (0.0, 2 * OWN), "beam.tip.inertia": (0.0, 1e-9), "beam.tip.offset": (-0.01, 0.01)},
    **{"mount.radius": (0.02, 0.2), "mount.setting_angle": (0.1, 3.0)},
}
# An outward beam, which rotation stretches, and whose disc nevertheless topples out of the plane of rotation.
DISC = bd.TipMass(OWN, 0.0, 1e-6, 1e-6, 1.7e-6)
TOPPLING = bd.Scene(replace(STRIP, tip=DISC), bd.Mount(0.05, math.pi, math.pi / 2))
_ROUNDING = 1e-12  # of answers whose error is smaller


def random_scene(random: np.random.Generator) -> bd.Scene:
    """A strip whose tip body, springs, point masses and place are there or not, near or far."""

    def perhaps(share: float) -> bool:
        return bool(random.random() < share)

    mass, tip = OWN * random.uniform(0.1, 5.0), None
    if perhaps(0.5):
        inertia = mass * random.uniform(1e-3, 1e-2) ** 2 if perhaps(0.4) else 0.0
        flat = {"transverse_inertia": inertia, "axial_inertia": random.uniform(0.5, 1.7) * inertia}
        tip = bd.TipMass(mass, random.choice([0.0, 0.01, -0.01]), inertia, **flat if perhaps(0.5) else {})
    masses = [bd.PointMass(0.05 * random.uniform(0.2, 0.5), mass)] if perhaps(0.1) else []
    springs = [bd.PointSpring(0.05 * random.uniform(0.2, 0.5), 100 * mass / OWN)] if perhaps(0.1) else []
    mount = bd.Mount(
        random.uniform(0.0, 0.15),
        random.choice([0.0, 0.0, math.pi, random.uniform(0.0, math.pi)]),
        random.choice([0.0, math.pi / 2, random.uniform(0.0, math.pi / 2)]),
        root_stiffness=random.uniform(0.003, 0.3) if perhaps(0.25) else math.inf,
    )
    beam = replace(STRIP, tip=tip, point_masses=masses, point_springs=springs)
    return bd.Scene(beam, mount, gravity=random.choice([0.0, 9.81]), damping_ratio=random.choice([0.0, 0.02]))


def numbers_of(scene: bd.Scene) -> dict[str, tuple[float, float]]:
    """Numbers that a scene can have, with bounds about twice apart."""
    without = set() if scene.beam.point_masses else {"beam.point_mass[0].mass"}
    without |= set() if math.isfinite(scene.mount.root_stiffness) else {"mount.root_stiffness"}
    without |= {"beam.tip.inertia"} if scene.beam.tip and not scene.beam.tip.inertia else set()
    found = {}
    for name in NUMBERS:
        if name not in without:
            own = number_at(scene, name) or 0.0
            fixed = name in ("beam.tip.offset", "mount.setting_angle") or not own
            found[name] = BOUNDS[name] if fixed else (own / 1.4, own * 1.4)
    return found


@pytest.mark.parametrize(
    ("what", "count"),
    [
        ("frequencies", 16),
        ("critical_speed", 24),
        *(pytest.param(what, 40, marks=pytest.mark.slow) for what in QUOTIENTS),
    ],
)
def test_numbers_raise_or_lower_the_answers_of_random_scenes(what, count):
    """Of three modes, or of buckling: with all that scenes have beside."""
    random, told = np.random.default_rng(5), dict.fromkeys(NUMBERS, 0)
    for scene in [TOPPLING, *(random_scene(random) for _ in range(count))]:
        known, bounds = ways(scene, what), numbers_of(scene)
        for name in known.keys() & bounds.keys():
            modes = 3 if what == "frequencies" else None
            with unannounced():
                found = bd.study(scene, {name: np.linspace(*bounds[name], 4)}, what, modes=modes)
            if any(known[name] != ways(found.scene_at(i), what).get(name) for i in (0, 3)):
                continue
            softness = found.value.reshape(4, -1) ** -2.0  # 0 where nothing buckles
            allowed = softness * (2 * found.error.reshape(4, -1) + _ROUNDING)
            change = -np.diff(softness, axis=0) * (known[name] or 1)
            assert (change >= -(allowed[1:] + allowed[:-1])).all(), (name, scene)
            assert known[name] or (change <= allowed[1:] + allowed[:-1]).all(), (name, scene)
            told[name] += 1
    assert sum(count > 3 for count in told.values()) >= 9, told


# Questions ----------------------------------------------------------------------------------------------


def random_search(random: np.random.Generator) -> Search:
    """A search of one to three numbers of a random scene, with some designs at corners, edges and within."""
    bare = bd.Scene(STRIP, bd.Mount(random.uniform(0.04, 0.2)))
    scene = bare if random.random() < 0.3 else random_scene(random)
    bounds = numbers_of(scene)
    known = [name for name in bounds if name in ways(scene, "critical_speed")]
    similar = [name for name in bounds if name in POWERS]
    of = [[*bounds], known or [*bounds], similar][random.choice(3, p=[0.2, 0.4, 0.4])]
    names = random.choice(of, min(random.integers(1, 4), len(of)), replace=False).tolist()
    if {*names} >= {"beam.thickness", "beam.scale.thickness"}:
        names.remove("beam.scale.thickness")
    ranges = Ranges(tuple(VariedInput(name, "", np.array(bounds[name])) for name in names))
    modes = random.choice([1, 2, 3], 2, replace=False).tolist()
    kinds = [("frequencies", modes[0]), ("frequencies", modes[1]), ("critical_speed", 1)]
    picked = random.permutation(3)[: random.choice([1, 2, 3], p=[0.2, 0.6, 0.2])]
    targets = [bd.Target(kinds[k][0], equals=1.0, mode=kinds[k][1]) for k in picked]
    return Search(scene, ranges, tuple(targets), np.full(len(names), 0.5), "ritz", None, spare=-10_000)


def random_designs(random: np.random.Generator, count: int, p: int) -> np.ndarray:
    """Shares (count, p), of which many are ends."""
    return np.where(
        random.random((count, p)) < 0.5, random.integers(0, 2, (count, p)), random.random((count, p))
    )


def asked_for(random: np.random.Generator, search: Search, values: np.ndarray) -> Search:
    """The same search for values, or for limits that they just keep."""
    kinds = random.choice(["equals", "at_least", "at_most"], len(values), p=[0.5, 0.25, 0.25]).tolist()
    pairs = zip(search.targets, kinds, values.tolist(), strict=True)
    targets = (bd.Target(t.what, mode=t.mode, **{kind: value}) for t, kind, value in pairs)
    return replace(search, targets=tuple(targets), _computed={})


def proofs_of(random: np.random.Generator, search: Search, count: int) -> Proofs:
    """What designs computed at random prove, beside the best of them."""
    designs = random_designs(random, count, len(search.own))
    search.known(designs)
    return Proofs(search, search.ranked(designs)[0])


NEAR, FAR = bd.Mount(0.07, bending_angle=math.pi / 2), bd.Mount(0.1)
TWO_MODES = [bd.Target("frequencies", equals=1.0), bd.Target("frequencies", equals=1.0, mode=2)]
BUCKLING = bd.Target("critical_speed", equals=1.0)


@pytest.mark.parametrize(
    ("scene", "name", "bounds", "wanted"),
    [
        (bd.Scene(STRIP, FAR), "beam.length", (0.03, 0.06), [TWO_MODES[0], BUCKLING]),
        (bd.Scene(STRIP, NEAR), "beam.length", (0.03, 0.11), [BUCKLING]),
        (bd.Scene(replace(STRIP, tip=bd.TipMass(OWN))), "beam.density", (2e3, 2e4), TWO_MODES),
        (bd.Scene(STRIP, bd.Mount(root_stiffness=0.03)), "beam.youngs_modulus", (5e10, 4e11), TWO_MODES),
    ],
    ids=["radius over length", "long beams", "body", "spring"],
)
def test_nothing_is_proven_beyond_what_an_argument_covers(scene, name, bounds, wanted):
    """Not all designs are similar, or the answer both falls and rises; one design is there."""
    ranges = Ranges((VariedInput(name, "", np.array(bounds)),))
    search = Search(scene, ranges, tuple(wanted), np.array([0.5]), "ritz", None)
    value, _ = search.known(np.array([[0.6]]))
    targets = tuple(replace(t, equals=v) for t, v in zip(wanted, value[0].tolist(), strict=True))
    search = replace(search, targets=targets, _computed={})
    designs = np.linspace(0.0, 1.0, 12)[:, None]
    search.known(designs)
    proofs = Proofs(search, search.ranked(designs)[0])
    assert not proofs.none and not proofs.no_nearer


RANDOM = [(1, 24), *(pytest.param(seed, 60, marks=pytest.mark.slow) for seed in range(1, 12))]


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "count"), RANDOM)
def test_nothing_is_proven_against_a_design_that_is_there(seed, count):
    random = np.random.default_rng(seed)
    for _ in range(count):
        search = random_search(random)
        value, error = search.known(random_designs(random, 1, len(search.own)))
        if (np.isfinite(value) & np.isfinite(error) & (value > 0)).all():
            proofs = proofs_of(random, asked_for(random, search, value[0]), 6)
            said = proofs.none, proofs.no_nearer
            assert said == ("", ""), (*said, proofs.search)


@pytest.mark.parametrize(("seed", "count"), RANDOM)
def test_what_is_proven_not_to_be_there_is_not_found_by_brute_force(seed, count):
    random = np.random.default_rng(seed)
    kinds = dict.fromkeys(("for all designs", " up to ", "similar", "no nearer"), 0)
    for _ in range(count):
        search = random_search(random)
        values, _ = search.known(random_designs(random, 3, len(search.own)))
        values = values[random.integers(0, 3, values.shape[1]), np.arange(values.shape[1])]
        if not (np.isfinite(values) & (values > 0)).all():
            continue
        search = asked_for(random, search, values * random.choice([0.97, 1.0, 1.03], len(values)))
        proofs = proofs_of(random, search, 10)
        none, nearer = proofs.none, proofs.no_nearer
        if not none and not nearer:
            continue
        designs = np.vstack([proofs.x, random_designs(random, 30, len(search.own))])
        missed, met = search.missed(designs), search.met(designs)
        assert not none or not met.all(axis=1).any(), (none, search)
        allowed = 2 * search.known(designs)[1] + _ROUNDING
        no_better = missed >= missed[0] - allowed - allowed[0]
        assert not nearer or no_better[:, ~met[0]].all(), (nearer, search)
        for kind in kinds:
            kinds[kind] += kind in none or (kind == "no nearer" and bool(nearer))
    assert min(kinds.values()) >= 1, kinds


@pytest.mark.parametrize(
    "change",
    [
        {"physics": bd.Physics(planes=2)},
        {"physics": bd.Physics(shear=True, rotary_inertia=True)},
        {"physics": "auto"},
        {"damping": bd.Damping(tip_damper=0.1)},
        {"mount": bd.Mount(0.2, math.pi, precone=0.1)},
        {"beam": bd.Harvester(1e-4, 7750.0, "series", -10.4, 61e9, 13.3e-9).on(STRIP)},
    ],
    ids=["planes", "shear", "auto", "damper", "precone", "layers"],
)
@pytest.mark.parametrize("what", QUOTIENTS)
def test_nothing_is_said_of_what_the_principle_does_not_cover(what, change):
    scene = bd.Scene(STRIP, bd.Mount(0.2))
    assert ways(scene, what) and not ways(scene, "amplitude")
    if "shear" in str(change):
        stiff = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
        change = change | {"beam": stiff}
    assert not ways(replace(scene, **change), what)
