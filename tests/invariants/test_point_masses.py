"""Point masses along the beam by second methods: shooting, tip bodies, masses smeared over a length."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial, legendre
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.modes.bounds import _nondimensional
from beamdyn.modes.buckling import decide_buckling
from beamdyn.modes.flexibility import bound_flexibility, bound_traces
from beamdyn.modes.residual_bound import PlaneEnclosure

RITZ, FEM = 1e-9, 1e-6  # promised relative errors
NODES = 14  # Gauss points on a third of a part between masses

# The beams are nondimensional, of no material.
pytestmark = pytest.mark.filterwarnings(
    "ignore:bending_stiffness:UserWarning", "ignore::beamdyn.common.results.statements.OutsideLinearTheory"
)


def uniform(*lumps: bd.PointMass, **more: Any) -> bd.Beam:
    """A uniform beam of unit length, mass and stiffness."""
    return bd.Beam.from_stiffness(1.0, 1.0, 1.0, point_masses=lumps, **more)


# A closed form --------------------------------------------------------------------------------------


def characteristic(b: float, place: float, mass: float) -> float:
    """Zero at a wave number b of the uniform cantilever at rest, by functions of A. N. Krylov."""

    def krylov(x: float) -> np.ndarray:
        ch, sh, c, s = math.cosh(b * x), math.sinh(b * x), math.cos(b * x), math.sin(b * x)
        K = np.array([ch + c, sh + s, ch - c, sh - s]) / 2
        return np.array([np.roll(K, k) for k in range(4)])  # derivatives over b^k

    inboard, beyond, outboard = krylov(1.0), krylov(1.0 - place), krylov(place)
    # w = A K_2 + B K_3, whose kinked continuation past the mass is b m w(place) K_3(x - place).
    columns = [
        inboard[2:, k] + b * mass * outboard[0, k] * beyond[2:, 3] for k in (2, 3)
    ]  # second and third derivative at the tip
    return float(np.linalg.det(np.array(columns)))


@pytest.mark.parametrize(("place", "mass"), [(0.5, 1.0), (0.5, 0.01), (0.3, 20.0), (1.0, 2.0)])
def test_uniform_beam_at_rest(place: float, mass: float) -> None:
    scene = bd.Scene(uniform(bd.PointMass(place, mass)))
    for discretization, rtol in (("ritz", RITZ), (bd.Fem(100), FEM)):
        for b in np.sqrt(2 * math.pi * bd.natural_modes(scene, 0.0, 4, discretization).frequency):
            root = brentq(characteristic, b * (1 - 1e-4), b * (1 + 1e-4), (place, mass), xtol=1e-14)
            assert b**2 == pytest.approx(root**2, rel=rtol)


# Shooting: two planes, twist, taper, rotation -------------------------------------------------------
# y = (w, theta, M, S) in two directions, with the shear force S = -M' + omega^2 N theta.  It falls by
# (lambda^2 + omega^2 d d^T) m w at a mass m; M and S vanish at the tip, w and theta at the root.


class Shooting:
    """Exact modes of a beam of unit length, with properties that are polynomials in x.

    Parameters
    ----------
    seed : int
        Of all that is drawn.
    """

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng([16, seed])
        self.mass = Polynomial([1.0, -rng.uniform(0, 0.7)])
        self.first = Polynomial([1.0, -rng.uniform(0, 0.7)])
        self.second = rng.uniform(0.5, 9.0) * Polynomial([1.0, -rng.uniform(0, 0.7)])
        self.twist = Polynomial([rng.uniform(-1, 1), rng.uniform(-1, 1)])
        self.inward = bool(seed % 2)
        self.radius, self.angle = rng.uniform(0.1, 2.0), rng.uniform(-2, 2)
        self.speed = rng.uniform(0.1, 0.3) if self.inward else rng.uniform(0.0, 8.0)
        count = 1 + seed % 4
        places, masses = np.sort(rng.uniform(0.02, 1.0, count)), 10 ** rng.uniform(-3, 0.5, count)
        self.lumps = [*zip(places.tolist(), masses.tolist(), strict=True)]

    @property
    def scene(self) -> bd.Scene:
        beam = bd.Beam.from_stiffness(
            1.0,
            self.mass,
            self.first,
            second_bending_stiffness=self.second,
            twist=self.twist,
            point_masses=[bd.PointMass(*lump) for lump in self.lumps[::-1]],
        )
        mount = bd.Mount(self.radius, 0.0 if self.inward else math.pi, self.angle)
        return bd.Scene(beam, mount, physics=bd.Physics(planes=2))

    def tension(self, x: float, beyond: float) -> float:
        """Tension per squared speed at x, with the masses beyond a place."""
        hub = -self.radius if self.inward else self.radius
        weight = (self.mass * Polynomial([hub, 1.0])).integ()
        return weight(1.0) - weight(x) + sum(m * (hub + place) for place, m in self.lumps if place > beyond)

    def ends(self, squares: np.ndarray) -> np.ndarray:
        """Determinants of (M, S) at the tip for squared angular frequencies (k,)."""
        d = np.array([math.cos(self.angle), -math.sin(self.angle)])
        inertia = squares[:, None, None] * np.eye(2) + self.speed**2 * np.outer(d, d)
        y = np.zeros((len(squares), 8, 4))
        y[:, 4:] = np.eye(4)
        start = 0.0
        for end, mass in [*self.lumps, (1.0, 0.0)]:
            for a, b in zip(*(np.linspace(start, end, 4)[k : k + 3] for k in (0, 1)), strict=True):
                y, R = np.linalg.qr(self.integrate(a, b, y, inertia))
                y *= np.sign(np.diagonal(R, axis1=1, axis2=2))[:, None, :]  # no sign of a determinant changes
            y[:, 6:] -= mass * inertia @ y[:, :2]
            start = end
        return np.linalg.det(y[:, 4:])

    def rates(self, x: float, beyond: float, inertia: np.ndarray) -> np.ndarray:
        """Matrices A of y' = A y at x for k inertias (k, 2, 2), with the masses beyond a place: (k, 8, 8)."""
        c, s = math.cos(self.twist(x)), math.sin(self.twist(x))
        R = np.array([[c, -s], [s, c]])
        A = np.zeros((len(inertia), 8, 8))
        A[:, 0:2, 2:4] = np.eye(2)
        A[:, 2:4, 4:6] = R @ np.diag([1 / self.first(x), 1 / self.second(x)]) @ R.T
        A[:, 4:6, 2:4] = self.speed**2 * self.tension(x, beyond) * np.eye(2)
        A[:, 4:6, 6:8] = -np.eye(2)
        A[:, 6:8, 0:2] = -self.mass(x) * inertia
        return A

    def integrate(self, a: float, b: float, y: np.ndarray, inertia: np.ndarray) -> np.ndarray:
        """Integrate y (k, 8, 4) from a to b by collocation at Gauss points."""
        t, weights = legendre.leggauss(NODES)
        half, k = (b - a) / 2, len(y)
        A = np.stack([self.rates(a + half * (1 + ti), (a + b) / 2, inertia) for ti in t], axis=1)
        to_nodes = legendre.legvander(t, NODES) @ legendre.legint(np.eye(NODES), lbnd=-1)
        to_nodes = half * to_nodes @ np.linalg.inv(legendre.legvander(t, NODES - 1))
        implicit = np.einsum("ij,kjab->kiajb", to_nodes, A).reshape(k, 8 * NODES, 8 * NODES)
        at_nodes = np.linalg.solve(np.eye(8 * NODES) - implicit, np.tile(y, (1, NODES, 1)))
        return y + half * np.einsum("j,kjab,kjbc->kac", weights, A, at_nodes.reshape(k, NODES, 8, 4))


@pytest.mark.parametrize("seed", [s if s < 8 else pytest.param(s, marks=pytest.mark.slow) for s in range(20)])
def test_random_scenes(seed: int) -> None:
    """The determinant changes its sign within the promise; stated errors of loose models cover theirs."""
    exact = Shooting(seed)
    found = bd.natural_modes(exact.scene, exact.speed, 4)
    sides = (2 * np.pi * found.frequency) ** 2 * (1 + 2 * RITZ * np.array([[-1.0], [1.0]]))
    below, above = exact.ends(sides.ravel()).reshape(sides.shape)
    assert (below * above < 0).all(), (below, above)
    assert (found.error < RITZ).all()
    for tolerance, discretization in ((1e-3, "ritz"), (1e-5, "ritz"), (None, bd.Fem(100))):
        loose = bd.natural_modes(exact.scene, exact.speed, 4, discretization, tolerance=tolerance)
        true = np.abs(loose.frequency / found.frequency - 1)
        assert (true <= loose.error + found.error).all(), (true, loose.error)
        # Between close masses elements are short, and rounding, which is stated, may be more than 1e-6.
        rounding = 0.0 if tolerance else loose.error / 10
        assert (true < np.maximum(tolerance or FEM, rounding)).all()


# Tip bodies and smeared masses, in every analysis ---------------------------------------------------

MASS = 0.4
OUTWARD = bd.Mount(0.5, math.pi, 0.0)
SLANTED = bd.Mount(0.5, 0.8, 0.0)
BENT = bd.Physics(large_deflection=True)
ALL = bd.Physics(planes=2, shear=True, rotary_inertia=True, stretch=True)
ROLLING = bd.RollingWheel(2.0, bd.SpinUp(1.0, duration=3.0), road=bd.RoadWave(3.0, 0.05))


def modes(mount: bd.Mount, physics: bd.Physics) -> Callable[[bd.Beam], np.ndarray]:
    def solve(beam: bd.Beam) -> np.ndarray:
        found = bd.natural_modes(bd.Scene(beam, mount, physics=physics), 0.8, 3)
        answers = found.eigenvalue.imag, found.load, found.angular_load, found.static_deflection
        return np.concatenate([np.ravel(answer) for answer in answers])

    return solve


def transient(physics: bd.Physics) -> Callable[[bd.Beam], np.ndarray]:
    def run(beam: bd.Beam) -> np.ndarray:
        scene = bd.Scene(beam, SLANTED, ROLLING, gravity=0.05, physics=physics)
        times = np.linspace(0.0, 4.0, 41)
        return bd.simulate(scene, t_end=4.0, modes=2, t_eval=times, tolerance=1e-8).tip

    return run


def steady(beam: bd.Beam) -> np.ndarray:
    scene = bd.Scene(beam, SLANTED, ROLLING, gravity=0.05, damping_ratio=0.02)
    return bd.steady_response(scene, speeds=np.array([0.3, 0.7]), modes=2).amplitude


def limits(beam: bd.Beam) -> np.ndarray:
    found = bd.setting_angle_limits(bd.Scene(beam, bd.Mount(2.0)), top_speed=0.5)
    return np.array([found.first, found.second])


ANALYSES: dict[str, Callable[[bd.Beam], np.ndarray]] = {
    "modes": modes(OUTWARD, bd.Physics()),
    "modes, all effects, precone": modes(bd.Mount(0.5, math.pi, 0.3, precone=0.2, root_stiffness=3.0), ALL),
    "modes about the equilibrium": modes(SLANTED, BENT),
    "modes, bent out of the plane": modes(bd.Mount(0.1, 0.0, math.pi / 2), BENT),
    "critical speed": lambda beam: np.array([bd.critical_speed(bd.Scene(beam, bd.Mount(1.5)))]),
    "critical speed of a string": lambda beam: np.array(
        [bd.critical_speed(bd.Scene(beam, bd.Mount(0.05, math.pi / 2 + 1.2)))]
    ),
    "setting-angle limits": limits,
    "transient": transient(bd.Physics()),
    "transient, large deflection": transient(BENT),
    "steady response": steady,
}
PROPERTIES = {
    "second_bending_stiffness": 4.0,
    "axial_stiffness": 800.0,
    "shear_stiffness": 300.0,
    "rotary_inertia": 1e-3,
    "second_rotary_inertia": 4e-3,
}
every_analysis = pytest.mark.parametrize("analysis", ANALYSES.values(), ids=ANALYSES.keys())


@every_analysis
def test_one_at_the_tip_is_a_tip_body(analysis: Callable[[bd.Beam], np.ndarray]) -> None:
    """But for rounding, which integration in time and roots of the stiffness raise to 1e-9."""
    lump = analysis(uniform(bd.PointMass(1.0, MASS), **PROPERTIES))
    body = analysis(uniform(tip=bd.TipMass(MASS), **PROPERTIES))
    assert np.abs(body).max() > 0
    np.testing.assert_allclose(lump, body, rtol=1e-9, atol=1e-10 * np.abs(body).max())


@every_analysis
def test_one_is_the_limit_of_a_smeared_mass(analysis: Callable[[bd.Beam], np.ndarray]) -> None:
    """A mass over the length h differs by h^2 (u'/u)^2 / 12, some 1e-7."""
    place, h = 0.6, 2e-4
    lump = analysis(uniform(bd.PointMass(place, MASS), **PROPERTIES))
    stations = [0.0, place - h / 2, place - h / 2, place + h / 2, place + h / 2, 1.0]
    heavy = bd.Table(stations, [1.0, 1.0, 1.0 + MASS / h, 1.0 + MASS / h, 1.0, 1.0])
    smeared = analysis(bd.Beam.from_stiffness(1.0, heavy, 1.0, **PROPERTIES))
    np.testing.assert_allclose(lump, smeared, rtol=3e-6, atol=1e-6 * np.abs(smeared).max())


def test_those_at_one_place_add_up() -> None:
    one = bd.natural_modes(bd.Scene(uniform(bd.PointMass(0.4, 0.3)), OUTWARD), 2.0)
    two = bd.natural_modes(bd.Scene(uniform(bd.PointMass(0.4, 0.1), bd.PointMass(0.4, 0.2)), OUTWARD), 2.0)
    np.testing.assert_allclose(two.frequency, one.frequency, rtol=1e-13)  # rounding
    assert uniform(bd.PointMass(0.4, 0.0)).breakpoints == (0.0, 1.0)  # none is there


# Guaranteed bounds ----------------------------------------------------------------------------------

STATIONS = np.linspace(0, 1, 9)
BLADE = bd.Table(STATIONS.tolist(), (1.2 - STATIONS).tolist())
MANY = {
    "few segments": uniform(bd.PointMass(0.3, 0.5), bd.PointMass(0.85, 0.1), tip=bd.TipMass(0.2, 0.1, 0.01)),
    "many segments": bd.Beam.from_stiffness(
        1.0, BLADE, BLADE, point_masses=(bd.PointMass(0.31, 0.5), bd.PointMass(1.0, 0.1))
    ),
}


@pytest.mark.parametrize("beam", MANY.values(), ids=MANY.keys())
@pytest.mark.parametrize("setting", [0.0, math.pi])
def test_bounds(beam: bd.Beam, setting: float) -> None:
    scene, speed = bd.Scene(beam, bd.Mount(0.7, setting, 0.4)), 0.9
    known = bd.natural_modes(scene, speed, 3, tolerance=1e-11)
    found = bd.frequency_bounds(scene, speed, 3)
    assert (found.lower * (1 - 1e-12) <= known.frequency).all()  # rounding of what is known
    assert (found.upper * (1 + 1e-12) >= known.frequency).all()
    assert (found.width < 1e-6).all()
    scaled, time = _nondimensional(scene)
    flexibility = bound_flexibility(scaled.beam.bending_stiffness)
    for functions in (2, 3, 5, 8):
        lower, upper = PlaneEnclosure(scaled, functions, speed * time, flexibility).bounds(1)
        exact = (2 * np.pi * known.frequency[:1] * time) ** 2
        assert (np.isnan(lower) | (lower <= exact * (1 + 1e-11))).all()
        assert (upper >= exact * (1 - 1e-11)).all()


def test_moments_between_masses() -> None:
    """Assumed modes by moments, of beams of many segments, against functions on each segment."""
    beam = bd.Beam.from_stiffness(
        1.0,
        BLADE,
        BLADE,
        second_bending_stiffness=bd.Table(STATIONS.tolist(), (3 - 2 * STATIONS).tolist()),
        twist=bd.Table([0.0, 1.0], [0.3, -0.2]),
        shear_stiffness=bd.Table(STATIONS.tolist(), (200 - 100 * STATIONS).tolist()),
        point_masses=[bd.PointMass(x, 0.2) for x in (0.07, 0.4, 0.9)],
    )
    scene = bd.Scene(beam, OUTWARD, physics=bd.Physics(planes=2, shear=True))
    known = bd.natural_modes(scene, 2.0, 4, bd.Ritz(10))
    for functions in (20, 28):
        found = bd.natural_modes(scene, 2.0, 4, bd.Ritz(functions, "moments"))
        true = np.abs(found.frequency / known.frequency - 1)
        assert (true <= found.error + known.error).all(), (functions, true, found.error)
        assert found.error.max() < RITZ  # polynomials over the whole beam have 1e-6


def test_traces_are_those_of_all_functions() -> None:
    scaled, _ = _nondimensional(bd.Scene(MANY["few segments"], OUTWARD))
    flexibility = bound_flexibility(scaled.beam.bending_stiffness)
    assert flexibility is not None
    head = PlaneEnclosure(scaled, 40, 1.0, flexibility)
    parts = np.array([np.trace(np.linalg.solve(head.stiffness, form)) for form in head.forms])
    bounds = bound_traces(scaled.beam, flexibility)
    assert (parts <= bounds * (1 + 1e-12)).all()  # rounding
    assert (parts > 0.97 * bounds).all()  # what 40 functions on each segment leave of a sum as 1/n


def test_one_at_the_tip_keeps_it_in_tension() -> None:
    """A body that hangs back beyond the axis of rotation compresses the end of the beam, or does not."""
    body, mount = bd.TipMass(1.0, -0.5, 0.5), bd.Mount(0.7, 0.0, math.pi / 2)
    for mass, buckles in ((0.1, True), (2.0, False)):
        beam = uniform(bd.PointMass(1.0, mass), tip=body)
        assert decide_buckling(bd.Scene(beam, mount)).exists is buckles


# Words ----------------------------------------------------------------------------------------------


def test_terms_name_them() -> None:
    scene = bd.Scene(uniform(bd.PointMass(0.7, 0.3), bd.PointMass(0.4, 0.1)), OUTWARD)
    said = "always; 0.4 kg of the mass is in point masses at x = 0.4 and 0.7 m"
    assert bd.terms(scene)["mass"].reason == said
    many = uniform(*(bd.PointMass(0.1 * k, 0.1) for k in range(1, 9)))
    assert bd.terms(bd.Scene(many))["mass"].reason.endswith("at 8 places from x = 0.1 m to 0.8 m")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: bd.PointMass(0.0, 1.0), "point_mass.position = 0 m: it must be greater than 0; it is the"),
        (lambda: bd.PointMass(math.nan, 1.0), "point_mass.position = nan m: give a finite number in m"),
        (lambda: bd.PointMass(1.0, -2.0), "point_mass.mass = -2 kg: it must be 0 or more"),
        (
            lambda: uniform(bd.PointMass(0.5, 1.0), bd.PointMass(1.2, 1.0)),
            "point_masses[1].position = 1.2 m: it must be at most 1 m, the length; a body beyond the tip is",
        ),
        (lambda: replace(uniform(), point_masses=[2]), "point_masses[0] = 2: give a PointMass; PointMass("),
        (lambda: replace(uniform(), point_masses=2), "point_masses = 2: give a sequence"),
    ],
)
def test_refusals(make: Callable[[], object], words: str) -> None:
    with pytest.raises(ValueError) as refusal:
        make()
    assert str(refusal.value).startswith(words)
