"""Loads along the span against Newton's law for the part outboard, full models' own curvatures and nodes."""

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations
from beamdyn.equations.discretization import FIXED
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.root_motion import RootMotion
from beamdyn.loads.load_rows import span_rows
from beamdyn.loads.stations import SpanStations, stations_at
from beamdyn.scene.motion.base import MotionSample

LENGTH = 1.7
TAPER = np.polynomial.Polynomial([3.0, -1.2, 0.4])
BODY = bd.TipMass(1.3, offset=0.15)
LUMPS = [bd.PointMass(0.6 * LENGTH, 0.8), bd.PointMass(LENGTH, 0.3)]
BLADE = bd.Beam.from_stiffness(
    LENGTH, TAPER, 400.0 * TAPER, second_bending_stiffness=900.0, twist=np.polynomial.Polynomial([0.2, 0.7]),
    tip=BODY, point_masses=LUMPS, breakpoints=(),
)  # fmt: skip
PLAIN = replace(BLADE, twist=None)
MOUNTS = {
    "oblique": (PLAIN, bd.Mount(0.8, setting_angle=0.7, bending_angle=0.4), 1),
    "two planes": (BLADE, bd.Mount(0.8, setting_angle=2.1, bending_angle=0.4), 2),
    "precone": (BLADE, bd.Mount(0.8, setting_angle=math.pi, bending_angle=0.3, precone=0.35), 2),
    "precone, one plane": (PLAIN, bd.Mount(0.8, setting_angle=math.pi, bending_angle=0.3, precone=0.35), 1),
    "hinged": (PLAIN, bd.Mount(0.8, setting_angle=2.1, bending_angle=0.4, root_stiffness=30.0), 1),
}
BASIS = bd.Ritz(6)
SAMPLE = MotionSample(
    np.array([0.9]), np.array([3.1]), np.array([1.7]), np.array([[0.6, -1.4, 2.3]])
)  # angle, speed, angular acceleration, acceleration of the carrier


def scene_of(name: str, **physics: bool) -> bd.Scene:
    beam, mount, planes = MOUNTS[name]
    return bd.Scene(beam, mount, gravity=4.0, physics=bd.Physics(planes=planes, **physics))


# Newton's law -------------------------------------------------------------------------------------


def newton(
    scene: bd.Scene, equations: Equations, stations: SpanStations, state: np.ndarray, root: RootMotion
) -> np.ndarray:
    """Loads (S, 1 + 2 d) of the part outboard on the part inboard, by its acceleration in space.

    The state holds coordinates, velocities and accelerations; forces and moments about the deflected axis, to
    first order in them.
    """
    points, mass = masses(scene.beam, stations)
    c, s = math.cos(scene.mount.bending_angle), math.sin(scene.mount.bending_angle)
    e = np.array([[0.0, c, s], [0.0, -s, c]])[: equations.planes]

    def deflections(xi: np.ndarray, order: int) -> np.ndarray:  # (3 derivatives in time, k, d)
        each = [state @ equations.deflection(xi, order, i) for i in range(equations.planes)]
        return np.stack(each, axis=-1) / LENGTH**order

    place = deflections(points, 0) @ e
    place[0, :, 0] += LENGTH * points
    body, slope = (deflections(np.ones(1), order)[:, 0] for order in (0, 1))
    centre = (body + BODY.offset * slope) @ e
    centre[0, 0] += LENGTH + BODY.offset
    place, mass = np.concatenate([place, centre[:, None]], axis=1), np.append(mass, BODY.mass)
    points = np.append(points, 2.0)

    axis = -np.array([math.sin(scene.mount.precone), 0.0, math.cos(scene.mount.precone)])
    spin, spin_up = root.speed[0] * axis, root.acceleration[0] * axis
    a_t, a_a = root.root_transverse[0], root.root_across[0]
    acceleration = np.array([root.root_axial[0], c * a_t - s * a_a, s * a_t + c * a_a]) + (
        np.cross(spin_up, place[0])
        + np.cross(spin, np.cross(spin, place[0]))
        + 2 * np.cross(spin, place[1])
        + place[2]
    )
    loads = []
    at, tilt = deflections(stations.xi, 0)[0], deflections(stations.xi, 1)[0]
    for k, xi in enumerate(stations.xi):
        out = mass * ((points > xi) | ((points == xi) & stations.inboard[k]))
        force = -(out[:, None] * acceleration).sum(axis=0)
        cut = at[k] @ e + np.array([LENGTH * xi, 0.0, 0.0])
        moment = -(out[:, None] * np.cross(place[0] - cut, acceleration)).sum(axis=0)
        shears = [force @ e[i] - tilt[k, i] * force[0] for i in range(equations.planes)]
        moments = [moment @ np.cross([1.0, 0.0, 0.0], e[i]) for i in range(equations.planes)]
        loads.append([force[0], *shears, *moments])
    return np.array(loads)


def masses(beam: bd.Beam, stations: SpanStations) -> tuple[np.ndarray, np.ndarray]:
    """Point masses [kg] at x/L that stand for the beam: Gauss points between stations, and its own."""
    ends = np.unique(np.concatenate([stations.xi, beam.breakpoints]))
    t, w = np.polynomial.legendre.leggauss(16)
    half = np.diff(ends)[:, None] / 2
    xi = (ends[:-1, None] + half * (1 + t)).ravel()
    mass = (half * w).ravel() * LENGTH * beam.mass_per_length(xi)
    return np.concatenate([xi, beam.lumps[0]]), np.concatenate([mass, beam.lumps[1]])


@pytest.mark.parametrize("name", MOUNTS)
def test_by_newtons_law_for_the_part_outboard(name: str) -> None:
    """Any state, which need not obey the equations of motion: what a load is does not depend on them."""
    scene = scene_of(name)
    equations = assemble_equations(scene, BASIS)
    stations = stations_at(scene.modelled_beam, [0.0, 0.3 * LENGTH, 0.6 * LENGTH, 0.6 * LENGTH, LENGTH])
    rows, root = span_rows(scene, BASIS, equations, stations), equations.root(SAMPLE)
    state = np.random.default_rng(3).normal(size=(3, equations.size))
    ours = rows.at(root, state[:1], state[1:2])[0] + rows.acceleration["unity"] @ state[2]
    still = newton(scene, equations, stations, np.zeros_like(state), root)
    small = 1e-3  # what is of second order cancels, what is of third is 1e-6 of it: none is there
    difference = [newton(scene, equations, stations, sign * small * state, root) for sign in (1, -1)]
    linear = still + (difference[0] - difference[1]) / (2 * small)
    # rtol: rounding over the difference of a thousandth
    np.testing.assert_allclose(ours, linear, rtol=1e-10, atol=1e-10 * np.abs(linear).max())


# The model's own curvature ------------------------------------------------------------------------

FULL = bd.Ritz(24)
MADE = {
    "rotary_inertia": 0.4,
    "second_rotary_inertia": 0.9,
    "shear_stiffness": 9e3,
    "second_shear_stiffness": 6e3,
}
ROUND = bd.Beam.from_stiffness(
    LENGTH, TAPER, 400.0 * TAPER, axial_stiffness=4e5, second_bending_stiffness=900.0,
    twist=np.polynomial.Polynomial([0.2, 0.7]), tip=bd.TipMass(1.3, 0.15, 0.3, 0.2, 0.15), **MADE,
)  # fmt: skip


@pytest.mark.parametrize("stretch", [False, True])
@pytest.mark.parametrize("planes", [1, 2])
@pytest.mark.parametrize("precone", [0.0, 0.3])
def test_moment_shear_and_axial_force_are_those_of_the_elastic_law(
    planes: int, precone: float, stretch: bool
) -> None:
    """With functions enough, the moment in equilibrium is EI times the curvature, and so on: all physics."""
    physics = bd.Physics(planes=planes, shear=True, rotary_inertia=True, stretch=stretch)
    mount = bd.Mount(0.8, math.pi, bending_angle=0.4, precone=precone)
    scene = bd.Scene(ROUND, mount, gravity=4.0, physics=physics)
    equations = assemble_equations(scene, FULL)
    stations = stations_at(scene.modelled_beam, np.linspace(0, LENGTH, 9))
    root = equations.root(MotionSample(np.array([0.9]), np.array([3.1]), np.zeros(1), np.zeros((1, 3))))
    q = np.linalg.solve(equations.matrix(0, root)[0], equations.load(root)[0])
    loads = span_rows(scene, FULL, equations, stations).at(root, q[None], np.zeros((1, len(q))))[0]
    _check_elastic_law(scene, equations, stations, q, loads, axial=stretch)


@pytest.mark.parametrize("precone", [0.0, 0.3])
def test_the_same_in_motion(precone: float) -> None:
    """A free vibration of the full model: its inertia is in balance with the elastic law in every section."""
    physics = bd.Physics(planes=2, shear=True, rotary_inertia=True)
    scene = bd.Scene(ROUND, bd.Mount(0.8, math.pi, bending_angle=0.4, precone=precone), physics=physics)
    equations = assemble_equations(scene, FULL)
    stations = stations_at(scene.modelled_beam, np.linspace(0, LENGTH, 9))
    rows = span_rows(scene, FULL, equations, stations)
    root = equations.root(MotionSample.steady(np.array([3.1])))
    K, G, M = (equations.matrix(order, root)[0] for order in range(3))
    n = len(K)
    first = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, G)]])
    values, vectors = np.linalg.eig(first)
    k = np.flatnonzero(values.imag > 0)[np.abs(values[values.imag > 0]).argmin()]
    q, v = vectors[:n, k], vectors[n:, k]
    moving = replace(rows.in_motion(equations), load={})
    loads = sum(
        np.asarray(row @ each) * getattr(root, name)[0]
        for by, each in ((moving.position, q), (moving.velocity, v))
        for name, row in by.items()
    )
    _check_elastic_law(scene, equations, stations, q, loads, axial=False)


def _check_elastic_law(
    scene: bd.Scene,
    equations: Equations,
    stations: SpanStations,
    q: np.ndarray,
    loads: np.ndarray,
    axial: bool,
) -> None:
    beam, planes, xi = scene.modelled_beam, equations.planes, stations.xi
    beta = np.zeros(len(xi)) if beam.twist is None else beam.twist(xi)
    c, s = np.cos(beta), np.sin(beta)
    turn = np.array([[c, s], [-s, c]])[:planes, :planes] if planes == 2 else np.ones((1, 1, len(xi)))

    def law(field: tuple[str, str], order: int, stiff: tuple[str, str]) -> np.ndarray:
        strain = np.stack([_of_field(equations, name, xi, order, q) for name in field[:planes]])
        local = np.einsum("ijk,jk->ik", turn, strain)
        resisting = np.stack([getattr(beam, name)(xi) for name in stiff[:planes]])
        return np.einsum("jik,jk->ki", turn, resisting * local)

    moments = law(("bending", "second bending"), 2, ("bending_stiffness", "second_bending_stiffness"))
    shears = law(("shear", "second shear"), 1, ("shear_stiffness", "second_shear_stiffness"))
    pairs = [(loads[:, 1 + planes :], moments), (loads[:, 1 : 1 + planes], shears)]
    if axial:
        force = beam.axial_stiffness(xi) * _of_field(equations, "stretch", xi, 1, q)
        pairs.append((loads[:, :1], force[:, None]))
    for ours, elastic in pairs:
        # rtol: the elastic law needs derivatives of 24 functions, which lose some digits at the ends
        np.testing.assert_allclose(ours, elastic, rtol=0, atol=1e-8 * np.abs(elastic).max())


def _of_field(equations: Equations, name: str, xi: np.ndarray, order: int, q: np.ndarray) -> np.ndarray:
    if name == "stretch":
        space = FULL.spaces(ROUND).functions(FIXED)
        return q[equations.blocks[name]] @ space.evaluate(xi, order) / LENGTH**order
    return q[equations.blocks[name]] @ equations.deflections[name].space.evaluate(xi, order) / LENGTH**order


# Nodes of finite elements -------------------------------------------------------------------------


@pytest.mark.parametrize("node", [1, 4])
def test_reactions_at_nodes_of_an_unreduced_model(node: int) -> None:
    """What the elements outboard of a node take from it, for any position of the full model: 1e-8."""
    fem, beam = bd.Fem(7, "uniform"), PLAIN
    scene = bd.Scene(beam, bd.Mount(0.8, setting_angle=0.7, bending_angle=0.4), gravity=4.0)
    equations = assemble_equations(scene, fem)
    root = equations.root(SAMPLE)
    q = np.random.default_rng(5).normal(size=equations.size)
    xi, functions = fem.nodes(scene.modelled_beam)[node], equations.deflections["bending"].space
    stations = stations_at(scene.modelled_beam, [xi * LENGTH])
    rows = span_rows(scene, fem, equations, stations).in_motion(equations)
    ours = rows.at(root, q[None], np.zeros((1, len(q))))[0, 0]

    K, f = equations.matrix(0, root)[0], equations.load(root)[0]
    a = np.linalg.solve(equations.matrix(2, root)[0], f - K @ q)
    nodes = fem.nodes(scene.modelled_beam)
    taken = -forces_of_elements(scene, functions, nodes, xi, stations, root, q, a)
    tension = float(axial_force(beam, root, np.array([xi]))[0])
    slope = float(q @ functions.evaluate(np.array([xi]), 1)[:, 0]) / LENGTH
    force, moment = (taken @ each for each in nodal_functions(functions, nodes, xi))
    assert ours[1] == pytest.approx(force - tension * slope, rel=1e-8)
    assert ours[2] == pytest.approx(moment, rel=1e-8)


def forces_of_elements(scene, functions, nodes, xi, stations, root, q, a):
    """Nodal forces of the elements beyond xi: elastic, geometric, and of inertia, less the loads."""
    beam, c = scene.beam, math.cos(scene.mount.bending_angle)
    points, mass = masses(beam, SpanStations(nodes, np.zeros(len(nodes), dtype=bool)))
    keep = (points > xi) | ((points == xi) & stations.inboard[0])
    points, mass = points[keep], mass[keep]
    tip = functions.end(0) + BODY.offset * functions.end(1) / LENGTH
    # deflections, then slopes, of all masses, the body among them
    phi = np.column_stack([functions.evaluate(points), tip])
    reach, mass = np.append(points * LENGTH, LENGTH + BODY.offset), np.append(mass, BODY.mass)
    softened = a @ phi - (root.speed[0] * c) ** 2 * (q @ phi)
    total = phi @ (mass * (softened + root.root_transverse[0] - c * root.acceleration[0] * reach))
    t, w = np.polynomial.legendre.leggauss(12)
    ends = nodes[nodes >= xi - 1e-12]
    half = np.diff(ends)[:, None] / 2
    x, dx = (ends[:-1, None] + half * (1 + t)).ravel(), (half * w).ravel() * LENGTH
    first, second = (functions.evaluate(x, order) / LENGTH**order for order in (1, 2))
    tension = axial_force(beam, root, x)
    offset = BODY.mass * BODY.offset * (root.speed[0] ** 2 * (LENGTH + BODY.offset) - root.root_axial[0])
    tip_slope = functions.end(1) / LENGTH
    total += first @ (dx * tension * (q @ first)) + offset * tip_slope * (q @ tip_slope)
    total += second @ (dx * beam.bending_stiffness(x) * (q @ second))
    return total


def axial_force(beam, root, x):
    n_a, n_b = axial_tension(beam)
    return root.speed[0] ** 2 * n_b(x) - root.root_axial[0] * n_a(x)


def nodal_functions(functions, nodes, xi):
    """Coefficients of the elements' functions with the deflection 1, or the slope 1, at a node alone."""
    sampled = np.concatenate(
        [functions.evaluate(nodes[1:]), functions.evaluate(nodes[1:], 1) / LENGTH], axis=1
    )
    here = int(np.abs(nodes[1:] - xi).argmin())
    for k in (here, here + len(nodes) - 1):
        yield np.linalg.solve(sampled.T, np.eye(2 * len(nodes) - 2)[k])


def test_errors_of_equilibria_contain_the_rounding_of_many_elements() -> None:
    """Two meshes may lose the same digits, so that their distance is no error; Ritz functions lose none."""
    beam = bd.Beam.from_stiffness(
        1.0,
        1.0,
        1.0,
        second_bending_stiffness=9.0,
        twist=bd.Polynomial([0.0, 0.5]),
        tip=bd.TipMass(4.0, 0.2, 0.02),
    )
    scene = bd.Scene(beam, bd.Mount(1.7, 0.0, 0.9), gravity=0.01, physics=bd.Physics(planes=2))
    right = bd.static_loads(scene, 0.15, [0.0, 0.2, 0.5, 0.8])
    for elements in range(104, 124, 4):
        found = bd.static_loads(scene, 0.15, right.x, discretization=bd.Fem(elements))
        for name in ("moment", "force"):
            distance = np.abs(getattr(found, name) - getattr(right, name))
            stated = getattr(found, f"{name}_error") + getattr(right, f"{name}_error")
            assert (distance <= stated).all(), (elements, name)
