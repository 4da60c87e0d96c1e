"""The equations of motion, derived again from a Lagrangian, agree with beamdyn's term by term.

The derivation here knows nothing of beamdyn's formulas.  It writes down where every point of the
beam, of a point mass on it and of the tip body is in fixed axes, forms kinetic and potential energy
to second order in the coordinates, and applies Lagrange's equations.  All is polynomial arithmetic with
exact rational coefficients: cosines and sines are symbols, whose rates are given and whose squares are
reduced.

The trial functions are powers of x: with them as a discretization, beamdyn's operators are
checked as well, for a tapered beam.
"""

from dataclasses import dataclass
from functools import cache, reduce
from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from sympy import QQ
from sympy.polys.rings import ring

from beamdyn.equations.assembly import assemble_equations
from beamdyn.scene.beam import Beam, PointMass, TipMass
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene
from tests.invariants.power_spaces import BENDING, STRETCH, PowerSeries

FIELDS = ("bending",) * len(BENDING) + ("stretch",) * len(STRETCH)
RTOL = 1e-12

# The numbers of the cases are random and those of no material.
pytestmark = pytest.mark.filterwarnings("ignore:bending_stiffness:UserWarning")

# Symbols ------------------------------------------------------------------------------------------

COUNT = len(FIELDS)
DERIVATIVES = [[f"q{'d' * order}{i}" for i in range(COUNT)] for order in range(3)]
COORDINATES = [name for names in DERIVATIVES for name in names]
SHAPE = ["L", "r", "cphi", "sphi", "cpsi", "spsi", "m", "eps", "Jn", "Je", "J1", "g", "mk", "xk"]
SECTION = ["rho0", "rho1", "EI0", "EI1", "EA0", "EA1"]  # rho A, EI and EA are linear in x
MOTION = ["ctheta", "stheta", "omega", "domega", "X", "Y", "Z", "VX", "VY", "VZ", "AX", "AY", "AZ"]
NAMES = ["x", *SHAPE, *SECTION, *MOTION, *COORDINATES]
RING, *GENERATORS = ring(NAMES, QQ)
S = dict(zip(NAMES, GENERATORS, strict=True))
PLACE = {name: k for k, name in enumerate(NAMES)}
HALF = QQ(1, 2)

RATES = {
    "ctheta": -S["omega"] * S["stheta"],
    "stheta": S["omega"] * S["ctheta"],
    "omega": S["domega"],
    **{axis: S["V" + axis] for axis in "XYZ"},
    **{"V" + axis: S["A" + axis] for axis in "XYZ"},
    **{a: S[b] for low, high in pairwise(DERIVATIVES) for a, b in zip(low, high, strict=True)},
}
SQUARES = [(PLACE["s" + a], S["s" + a], 1 - S["c" + a] ** 2) for a in ("phi", "psi", "theta")]


def keep(p, wanted):
    """The part of a polynomial whose monomials are wanted."""
    return RING.from_dict({k: v for k, v in p.items() if wanted(k)})


def upto(p, degree):
    """Without what is of higher degree in the coordinates and their rates."""
    return keep(p, lambda k: sum(k[PLACE[name]] for name in COORDINATES) <= degree)


def trig(p):
    """With the squares of sines replaced."""
    for place, sine, square in SQUARES:
        while any(k[place] > 1 for k in p):
            high = keep(p, lambda k, place=place: k[place] > 1)
            p = p - high + high.exquo(sine**2) * square
    return p


def rate(p):
    """Total derivative with respect to time."""
    return sum((p.diff(S[name]) * d for name, d in RATES.items()), RING.zero)


def at(p, value):
    """With a value in place of x."""
    return p.compose(S["x"], value)


def integral(p, upper):
    """Integral over x from 0."""
    whole = RING.from_dict({(k[0] + 1, *k[1:]): v / (k[0] + 1) for k, v in p.items()})
    return at(whole, upper)


def dot(a, b):
    return sum((p * q for p, q in zip(a, b, strict=True)), RING.zero)


def combine(*pairs):
    """Sum of scalars times vectors."""
    return [sum((f * v[k] for f, v in pairs), RING.zero) for k in range(3)]


# Derivation ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Derived:
    """Linear equations sum_k matrix[k][i][j] q_j^(k) = load[i]; entries are polynomials."""

    matrix: tuple
    load: tuple


def axes():
    """Axes b1, b2, b3 of the root, along fixed axes."""
    a1 = [S["ctheta"], -S["stheta"], RING.zero]  # turned by theta about -n3
    a2 = [S["stheta"], S["ctheta"], RING.zero]
    b1 = combine((S["cphi"], a1), (-S["sphi"], a2))
    b2 = combine((S["sphi"], a1), (S["cphi"], a2))
    return b1, b2, [RING.zero, RING.zero, RING.one]


def root():
    """Position of the root: from the centre outward, which is against b1 at setting angle 0."""
    b1, b2, _ = axes()
    inward = combine((S["cphi"], b1), (S["sphi"], b2))
    return [S[axis] - S["r"] * trig(p) for axis, p in zip("XYZ", inward, strict=True)]


def deformation(stretched_slope):
    """Displacements u1 and u, stretch s, and the tip's slope, to second order."""
    q = [S[name] for name in DERIVATIVES[0]]
    u = sum((S["x"] ** k * c for k, c in zip(BENDING, q, strict=False)), RING.zero)
    s = sum((S["x"] ** k * c for k, c in zip(STRETCH, q[len(BENDING) :], strict=True)), RING.zero)
    slope = u.diff(S["x"])
    u1 = s - HALF * integral(slope**2, S["x"])
    tip = slope * (1 - s.diff(S["x"])) if stretched_slope else slope  # u'/(1 + s')
    return u1, u, s, upto(at(tip, S["L"]), 2)


def spin(body):
    """Angular velocity of a body along its own three axes, to second order."""
    turning = [[rate(p) for p in axis] for axis in body]
    return [upto(trig(dot(turning[i], body[j])), 2) for i, j in ((1, 2), (2, 0), (0, 1))]


@cache
def derive(stretched_slope=False):
    """Lagrange's equations, linearised about the undeformed beam."""
    b1, b2, b3 = axes()
    e = combine((S["cpsi"], b2), (S["spsi"], b3))
    normal = combine((S["cpsi"], b3), (-S["spsi"], b2))  # b1 x e: the axis of bending
    u1, u, s, slope = deformation(stretched_slope)
    rho, EI, EA = (S[k + "0"] + S[k + "1"] * S["x"] for k in ("rho", "EI", "EA"))

    point = combine((RING.one, root()), (S["x"] + u1, b1), (u, e))
    cosine = 1 - HALF * upto(slope**2, 2)
    tangent = combine((cosine, b1), (slope, e))
    across = combine((-slope, b1), (cosine, e))
    centre = combine((RING.one, [at(p, S["L"]) for p in point]), (S["eps"], tangent))

    def kinetic(position):
        v = [trig(rate(p)) for p in position]
        return HALF * upto(trig(dot(v, v)), 2)

    w = spin([tangent, across, normal])
    inertia = (S["J1"], S["Je"], S["Jn"])
    lump = [at(p, S["xk"]) for p in point]
    T = integral(rho * kinetic(point), S["L"]) + S["mk"] * kinetic(lump) + S["m"] * kinetic(centre)
    T += HALF * upto(trig(sum((J * p**2 for J, p in zip(inertia, w, strict=True)), RING.zero)), 2)
    strain, curvature = s.diff(S["x"]), u.diff(S["x"]).diff(S["x"])
    V = HALF * integral(EA * strain**2 + EI * curvature**2, S["L"])
    V += S["g"] * (integral(rho * point[1], S["L"]) + S["mk"] * lump[1] + S["m"] * centre[1])

    lagrange = []
    for q, qd in zip(*DERIVATIVES[:2], strict=True):
        lagrange.append(upto(trig(rate(T.diff(S[qd])) - T.diff(S[q]) + V.diff(S[q])), 1))
    matrix = tuple([[row.diff(S[name]) for name in names] for row in lagrange] for names in DERIVATIVES)
    load = tuple(-upto(row, 0) for row in lagrange)
    return Derived(matrix, load)


# Which part of the derived equations is which of beamdyn's terms ---------------------------------

TERMS = {  # name: rows, columns, order of the time derivative
    "mass": ("bending", "bending", 2),
    "bending stiffness": ("bending", "bending", 0),
    "centrifugal stiffening": ("bending", "bending", 0),
    "spin softening": ("bending", "bending", 0),
    "spin of the tip body": ("bending", "bending", 0),
    "tension by root acceleration": ("bending", "bending", 0),
    "stretch mass": ("stretch", "stretch", 2),
    "axial stiffness": ("stretch", "stretch", 0),
    "axial spin softening": ("stretch", "stretch", 0),
    "Coriolis coupling of stretch": ("stretch", "bending", 1),
    "Coriolis coupling of bending": ("bending", "stretch", 1),
    "Euler coupling of stretch": ("stretch", "bending", 0),
    "Euler coupling of bending": ("bending", "stretch", 0),
}
LOADS = {
    "angular acceleration": "bending",
    "root acceleration": "bending",
    "centrifugal stretching": "stretch",
    "axial root acceleration": "stretch",
}
OTHER = "a term that beamdyn does not have"
ROOT = ("r", "AX", "AY", "AZ", "g")  # what stands in the acceleration of the root and nowhere else


def name_of_term(rows, columns, order, k):
    """Name of the term to which a monomial of a matrix belongs."""
    has = {name for name in NAMES if k[PLACE[name]]}
    squared = k[PLACE["omega"]] == 2
    moving = has & {"omega", "domega", *ROOT}
    if (rows, columns) == ("bending", "bending"):
        if order == 2:
            return OTHER if moving else "mass"
        if order == 1:
            return OTHER
        if not moving:
            return "bending stiffness"
        if has.intersection(ROOT):
            return "tension by root acceleration"
        if not squared:
            return OTHER
        if has & {"Je", "J1"}:
            return "spin of the tip body"
        return "spin softening" if k[PLACE["cpsi"]] == 2 else "centrifugal stiffening"
    if rows == columns:
        if order == 2:
            return OTHER if moving else "stretch mass"
        if order == 0 and not moving:
            return "axial stiffness"
        return "axial spin softening" if order == 0 and squared and moving == {"omega"} else OTHER
    if order == 1 and moving == {"omega"}:
        return f"Coriolis coupling of {rows}"
    if order == 0 and moving == {"domega"}:
        return f"Euler coupling of {rows}"
    return OTHER


def name_of_load(rows, k):
    """Name of the load to which a monomial belongs."""
    has = {name for name in NAMES if k[PLACE[name]]}
    if has.intersection(ROOT):
        return "root acceleration" if rows == "bending" else "axial root acceleration"
    if rows == "bending" and "domega" in has:
        return "angular acceleration"
    return "centrifugal stretching" if rows == "stretch" and "omega" in has else OTHER


def block(rows, columns):
    return [[(i, j) for j in range(COUNT) if FIELDS[j] == columns] for i in range(COUNT) if FIELDS[i] == rows]


def split(entries, name):
    """An array of polynomials as a dict of arrays, one for each name."""
    flat = [p for row in entries for p in row]
    names = {name(k) for p in flat for k in p}
    return {n: [[keep(p, lambda k, n=n: name(k) == n) for p in row] for row in entries] for n in names}


@cache
def derived_terms():
    """{(name, rows, columns, order): matrix of polynomials}."""
    found = {}
    for order, matrix in enumerate(derive().matrix):
        for rows in ("bending", "stretch"):
            for columns in ("bending", "stretch"):
                entries = [[matrix[i][j] for i, j in row] for row in block(rows, columns)]
                parts = split(entries, lambda k, a=rows, b=columns, o=order: name_of_term(a, b, o, k))
                found |= {(name, rows, columns, order): part for name, part in parts.items()}
    return found


@cache
def derived_loads():
    """{(name, rows): vector of polynomials}."""
    found = {}
    for rows in ("bending", "stretch"):
        entries = [[p] for p, field in zip(derive().load, FIELDS, strict=True) if field == rows]
        for name, part in split(entries, lambda k, a=rows: name_of_load(a, k)).items():
            found[name, rows] = [row[0] for row in part]
    return found


# The same beam in beamdyn -------------------------------------------------------------------------


@dataclass(frozen=True)
class Case:
    """Values of all parameters and of the motion, at random but for the angles that are asked for."""

    value: dict
    angles: tuple  # setting, bending, angle of the carrier

    @classmethod
    def random(cls, seed, setting=None, bending=None):
        rng = np.random.default_rng(seed)
        value = {name: rng.uniform(0.4, 1.6) for name in NAMES}
        for name in ("omega", "domega", "VX", "VY", "VZ", "AX", "AY", "AZ", "g", "eps", "rho1", "EI1", "EA1"):
            value[name] *= rng.choice([-1, 1])
        for name in ("eps", "rho1", "EI1", "EA1"):
            value[name] *= 0.1
        value["xk"] *= value["L"] / 2
        value["Je"] = value["Jn"] * rng.uniform(0.8, 1.2)
        value["J1"] = value["Jn"] * rng.uniform(0.3, 0.7)
        angles = tuple(rng.uniform(-3, 3) if a is None else a for a in (setting, bending, None))
        for name, a in zip(("phi", "psi", "theta"), angles, strict=True):
            value |= {k + name: 0.0 if abs(f) < 1e-15 else f for k, f in (("c", np.cos(a)), ("s", np.sin(a)))}
        return cls(value, angles)

    def __call__(self, p):
        """A polynomial's value, and the sum of its monomials' magnitudes, which bounds the rounding."""
        terms = [float(v) * self.monomial(k) for k, v in p.items()]
        return sum(terms), sum(map(abs, terms))

    def monomial(self, k):
        return reduce(lambda p, i: p * self.value[NAMES[i]] ** k[i], np.flatnonzero(k), 1.0)

    def array(self, entries):
        """Values and magnitudes of an array of polynomials."""
        both = np.array([[self(p) for p in row] for row in entries])
        return both[..., 0], both[..., 1]

    def scene(self):
        v = self.value
        taper = {k: Polynomial([v[k + "0"], v[k + "1"] * v["L"]]) for k in ("rho", "EI", "EA")}
        tip = TipMass(v["m"], v["eps"], v["Jn"], transverse_inertia=v["Je"], axial_inertia=v["J1"])
        lumps = (PointMass(v["xk"], v["mk"]),)
        given = taper["rho"], taper["EI"], taper["EA"]
        beam = Beam.from_stiffness(v["L"], *given, tip=tip, point_masses=lumps)
        return Scene(beam, Mount(v["r"], *self.angles[:2]), gravity=v["g"], physics=Physics(stretch=True))

    def equations(self):
        return assemble_equations(self.scene(), PowerSeries())

    def sample(self):
        v = self.value
        scalars = (np.array(x) for x in (self.angles[2], v["omega"], v["domega"]))
        return MotionSample(*scalars, np.array([v["AX"], v["AY"], v["AZ"]]))


def assert_equal(ours, derived, what):
    """Equal to rounding, relative to the terms of each entry."""
    value, size = derived
    off = np.abs(ours - value) > RTOL * size
    assert not off.any(), f"{what}: derived {value[off]}, beamdyn {ours[off]}"


CASES = [Case.random(seed) for seed in range(6)]
RIGHT_ANGLES = [
    Case.random(10 * i + j, setting, bending)
    for i, setting in enumerate((0.0, np.pi / 2, np.pi, -np.pi / 2))
    for j, bending in enumerate((0.0, np.pi / 2, np.pi))
]

# Tests --------------------------------------------------------------------------------------------


def test_terms_are_those_of_the_derivation():
    system = CASES[0].equations()
    expected = {(name, *place) for name, place in TERMS.items()}
    assert {(t.name, t.rows, t.columns, t.order) for t in system.terms} == expected == set(derived_terms())
    assert {(f.name, f.rows) for f in system.loads} == set(LOADS.items()) == set(derived_loads())


@pytest.mark.parametrize("name", TERMS)
def test_term(name):
    key = (name, *TERMS[name])
    for case in CASES:
        system = case.equations()
        (term,) = (t for t in system.terms if (t.name, t.rows, t.columns, t.order) == key)
        ours = term.coefficient(system.root(case.sample())) * term.matrix
        assert_equal(ours, case.array(derived_terms()[key]), key)


@pytest.mark.parametrize("name", LOADS)
def test_load(name):
    key = (name, LOADS[name])
    for case in CASES:
        system = case.equations()
        (load,) = (f for f in system.loads if (f.name, f.rows) == key)
        ours = load.coefficient(system.root(case.sample())) * load.vector
        assert_equal(ours[None], case.array([derived_loads()[key]]), key)


@pytest.mark.parametrize("case", CASES + RIGHT_ANGLES, ids=range(len(CASES + RIGHT_ANGLES)))
def test_sum(case):
    system, derived = case.equations(), derive()
    root = system.root(case.sample())
    for order in range(3):
        assert_equal(system.matrix(order, root), case.array(derived.matrix[order]), order)
    assert_equal(system.load(root)[None], case.array([derived.load]), "load")


# Lee and Yoo (2019) -------------------------------------------------------------------------------


TANGENTIAL = S["AX"] * S["stheta"] + (S["AY"] + S["g"]) * S["ctheta"] + S["domega"] * S["r"]


def sine_part(p):
    """What is multiplied by sin(phi), without it."""
    return keep(p, lambda k: k[PLACE["sphi"]] == 1).exquo(S["sphi"])


def test_sign_of_tension_printed_in_eq_14():
    """The sin(phi) term before K_GA is +, as a_O1 in (13) demands; (14) prints -."""
    for row in derived_terms()["tension by root acceleration", "bending", "bending", 0]:
        for p in row:
            KGA = -keep(p, lambda k: k[PLACE["omega"]] == 2).exquo(S["omega"] ** 2 * S["r"] * S["cphi"])
            assert KGA != 0
            assert sine_part(p) == KGA * TANGENTIAL
            assert sine_part(p) != -KGA * TANGENTIAL  # printed
    for p in derived_loads()["axial root acceleration", "stretch"]:  # (13): -(- sin(phi) ...) P1 on the right
        P1 = -keep(p, lambda k: k[PLACE["omega"]] == 2).exquo(S["omega"] ** 2 * S["r"] * S["cphi"])
        assert sine_part(p) == P1 * TANGENTIAL


def test_equations_as_printed_in_eq_14_are_not_the_derived_ones():
    case = CASES[0]
    system = case.equations()
    slip, _ = case(2 * S["sphi"] * TANGENTIAL)
    printed = system.matrix(0, system.root(case.sample()))
    printed += slip * system.matrices[0]["root_axial"]  # which is -KGA
    value, size = case.array(derive().matrix[0])
    assert abs(printed - value).max() > 1e-3 * size.max()


def test_velocity_printed_in_eq_6():
    """The root's velocity contains omega r; (6) prints omega' r."""
    radial = S["VX"] * S["ctheta"] - S["VY"] * S["stheta"]
    tangential = S["VX"] * S["stheta"] + S["VY"] * S["ctheta"] + S["omega"] * S["r"]
    b1, b2, _ = axes()
    along, across = (trig(dot([rate(p) for p in root()], b)) for b in (b1, b2))
    assert along == S["cphi"] * radial - S["sphi"] * tangential
    assert across == S["sphi"] * radial + S["cphi"] * tangential


def test_what_the_model_of_stretch_leaves_out():
    """The tip's slope is u', not u'/(1 + s').

    This drops couplings by the offset and the rotary inertia of the tip body: before q1 in bending
    -[m eps (c a_O2 + s a_O3) - omega' c (m eps (L + eps) + J_n)] phi2'(L) phi1'(L)^T,
    and its transpose before q2 in stretch.
    """
    exact, model = derive(stretched_slope=True), derive()
    _, b2, b3 = axes()
    acceleration = [rate(rate(p)) for p in root()]
    acceleration[1] += S["g"]
    transverse = trig(S["cpsi"] * dot(acceleration, b2) + S["spsi"] * dot(acceleration, b3))
    arm = S["m"] * S["eps"]
    factor = S["domega"] * S["cpsi"] * (arm * (S["L"] + S["eps"]) + S["Jn"]) - arm * transverse
    slope = [k * S["L"] ** (k - 1) for k in (*BENDING, *STRETCH)]
    for order in range(3):
        for i, row in enumerate(exact.matrix[order]):
            for j, p in enumerate(row):
                lost = factor * slope[i] * slope[j] if order == 0 and FIELDS[i] != FIELDS[j] else 0
                assert p - model.matrix[order][i][j] == lost
    assert exact.load == model.load
