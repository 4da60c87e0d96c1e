"""A thin bimorph as a three-dimensional piezoelectric solid: scikit-fem, quadratic hexahedra.

Displacement and potential are solved with the full matrices of PZT-5A, polarised through the thickness, and
the electrodes as surfaces of one potential.  x runs along the strip, y across it, z through its thickness; by
symmetry of bending a quarter of the section is meshed: half the width, and half the core with one layer.
The two layers are in series, so that the voltage between the outer electrodes is twice that of one.

    c grad u . grad u' + e^T grad phi . grad u' = omega^2 rho u . u'
    e grad u . grad phi' - eps grad phi . grad phi' = 0

Own derivation.  The material is a usual set of constants of PZT-5A; as beam and solid have the same, nothing
hangs on its source.  Only numpy, scipy and scikit-fem are needed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from rich.console import Console
from rich.table import Table
from scipy.sparse.linalg import eigsh, splu
from skfem import Basis, BilinearForm, ElementHexS2, ElementVector, MeshHex
from skfem.helpers import dot, grad

import beamdyn as bd
from benchmarks.peers import ours, page
from benchmarks.peers.solids import extrapolate
from benchmarks.rows import markdown_table

# PZT-5A: compliances at constant field [1/Pa], strain constants [m/V], permittivity at constant stress [F/m].
S11, S12, S13, S33, S55 = 16.4e-12, -5.74e-12, -7.22e-12, 18.8e-12, 47.5e-12
D31, D33, D15 = -171e-12, 374e-12, 584e-12
EPS_11, EPS_33 = (ratio * 8.854187817e-12 for ratio in (1730, 1700))
LENGTH, CORE, LAYER = 0.05, 0.1e-3, 0.05e-3  # dimensions [m]
# Modulus [Pa], Poisson's ratio, densities [kg/m3].
BRASS, BRASS_RATIO, HEAVY_BRASS, HEAVY_PZT = 105e9, 0.34, 8500.0, 7750.0
WIDTHS = 0.05, 0.2, 0.5  # widths, over the length
# Numbers of elements along, across half the width, and through core and layer.
MESHES = (6, 2, 1), (12, 4, 1), (24, 8, 1)
FREQUENCY = 18.0  # frequency of the base [Hz], half the first natural one
PLAIN, CAMBER = bd.Physics(), bd.Physics(camber=True)
_TOWARDS_ROOT, _TOWARDS_EDGE = 2.0, 1.5  # exponents of the decrease of element sizes towards clamp and edge
_REDUCED = 3  # order of quadrature with 2 x 2 x 2 points, which avoids locking of thin elements
_PAIRS = (0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)  # pairs of directions, in Voigt's order
HEAD = (
    "width/length",
    "",
    "short circuit [Hz]",
    "open circuit [Hz]",
    f"voltage at {FREQUENCY:g} Hz [V per m/s2]",
)
HEADING = page.PIEZO
TEXT = """{heading}
Written by `python -m benchmarks.peers.piezo` on {day}.  Versions: beamdyn {version}, scikit-fem {fem}.

A strip of brass, {length:g} mm long and {core:g} mm thick, between two layers of PZT-5A of {layer:g} mm in
series, clamped at the root, beside a three-dimensional piezoelectric solid: displacement and potential in
quadratic hexahedra, full matrices of the material, electrodes of one potential.  Three meshes are
extrapolated ([solids](solids.md)); the error of the solid is behind its numbers.  Behind those of the beam:
deviation from the solid; model error that the result states (of the voltage: what camber changes in it).

"""


class Found(NamedTuple):
    """First frequencies [Hz] in short and in open circuit, and voltage per base acceleration [V s2/m]."""

    short: float
    open: float
    voltage: float


# The solid ----------------------------------------------------------------------------------------


def constants() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compute stiffness (6, 6) at constant field, coupling (3, 6), permittivity (3, 3) at constant strain."""
    s, d = np.zeros((6, 6)), np.zeros((3, 6))
    s[:3, :3] = [[S11, S12, S13], [S12, S11, S13], [S13, S13, S33]]
    s[3, 3] = s[4, 4] = S55
    s[5, 5] = 2 * (S11 - S12)
    d[2, :3], d[0, 4], d[1, 3] = (D31, D31, D33), D15, D15
    c = np.linalg.inv(s)
    return c, d @ c, np.diag([EPS_11, EPS_11, EPS_33]) - d @ c @ d.T


def isotropic(modulus: float, ratio: float) -> np.ndarray:
    """Compute the stiffness (6, 6) of an isotropic material."""
    s = np.diag([1.0, 1, 1, *[2 * (1 + ratio)] * 3])
    s[:3, :3] -= ratio * (1 - np.eye(3))
    return np.linalg.inv(s / modulus)


def _strains(u: Any) -> np.ndarray:
    """Compute strains in Voigt's order from a displacement."""
    g: Any = grad(u)
    return np.array([g[i, i] if i == j else g[i, j] + g[j, i] for i, j in _PAIRS])


def elastic(C: np.ndarray) -> Any:
    """Return the bilinear form of the strain energy with the stiffness C."""
    return BilinearForm(lambda u, v, _: np.einsum("iek,ij,jek->ek", _strains(v), C, _strains(u)))


def inertia(rho: float) -> Any:
    """Return the bilinear form of the kinetic energy with the density rho."""
    return BilinearForm(lambda u, v, _: rho * dot(u, v))


def piezoelectric(e: np.ndarray) -> Any:
    """Return the bilinear form of the piezoelectric energy, which couples potential and strains by e."""
    return BilinearForm(lambda p, v, _: np.einsum("iek,ji,jek->ek", _strains(v), e, _slopes(p)))


def dielectric(eps: np.ndarray) -> Any:
    """Return the bilinear form of the electric field's energy with the permittivity eps."""
    return BilinearForm(lambda p, q, _: np.einsum("iek,ij,jek->ek", _slopes(q), eps, _slopes(p)))


def _slopes(p: Any) -> Any:
    return grad(p)


def mesh_of(width: float, counts: tuple[int, int, int]) -> Any:
    """Make the mesh of half the width [m] and half the thickness."""
    along, across, through = counts
    z = np.r_[np.linspace(0, CORE / 2, through + 1), CORE / 2 + np.linspace(0, LAYER, through + 1)[1:]]
    y = width / 2 * (1 - (1 - np.linspace(0, 1, across + 1)) ** _TOWARDS_EDGE)
    return MeshHex.init_tensor(LENGTH * np.linspace(0, 1, along + 1) ** _TOWARDS_ROOT, y, z)


@dataclass(frozen=True)
class Solid:
    """Matrices of a quarter of a bimorph, whose last coordinate is the potential of the outer electrode.

    Parameters
    ----------
    stiffness, mass : sparse matrix, shape (n, n)
        Matrices of displacements and potentials.
    push : ndarray, shape (n,)
        Load by a unit acceleration of the base.
    unit : float
        Potential of a unit coordinate [V].
    """

    stiffness: Any
    mass: Any
    push: np.ndarray
    unit: float

    @classmethod
    def of(cls, width: float, counts: tuple[int, int, int]) -> Solid:
        """Assemble the bimorph of a width [m] on a mesh."""
        mesh = mesh_of(width, counts)
        layers = np.flatnonzero(mesh.p[2, mesh.t].mean(axis=0) > CORE / 2)
        core = np.setdiff1d(np.arange(mesh.nelements), layers)
        vector = ElementVector(ElementHexS2())
        whole, inner, u = (Basis(mesh, vector, elements=e, intorder=_REDUCED) for e in (None, core, layers))
        phi, (c, e, eps) = Basis(mesh, ElementHexS2(), elements=layers, intorder=_REDUCED), constants()
        unit = math.sqrt(c[0, 0] / eps[2, 2])  # potential that makes both blocks similar in size
        K = elastic(isotropic(BRASS, BRASS_RATIO)).assemble(inner) + elastic(c).assemble(u)
        M = inertia(HEAVY_BRASS).assemble(inner) + inertia(HEAVY_PZT).assemble(u)
        free, potential, raised = _free(whole), _potentials(phi), np.zeros(whole.N)
        for dofs in (whole.nodal_dofs, whole.edge_dofs):
            raised[np.asarray(dofs)[2::3]] = 1  # the displacement along z is the third component of each
        coupled = (piezoelectric(unit * e).assemble(phi, u) @ potential)[free]
        held = potential.T @ dielectric(unit**2 * eps).assemble(phi) @ potential
        stiffness = sp.bmat([[K[free][:, free], coupled], [coupled.T, -held]], format="csc")
        push = np.r_[-(M @ raised)[free], np.zeros(held.shape[0])]
        mass = sp.block_diag([M[free][:, free], sp.csr_matrix(held.shape)], format="csc")
        return cls(stiffness, mass, push, unit)

    def found(self) -> Found:
        """Compute frequencies in both circuits, and the voltage of both layers by the base."""
        short = slice(0, -1)
        first = _lowest(self.stiffness[short, short], self.mass[short, short])
        dynamic = self.stiffness - (2 * math.pi * FREQUENCY) ** 2 * self.mass
        potential = splu(dynamic.tocsc()).solve(self.push)[-1]
        return Found(first, _lowest(self.stiffness, self.mass), 2 * float(abs(potential)) * self.unit)


def _lowest(K: Any, M: Any) -> float:
    """Compute the first frequency [Hz]."""
    (squared,) = eigsh(K, 1, M, sigma=0, return_eigenvectors=False)
    return math.sqrt(squared) / (2 * math.pi)


def _potentials(phi: Any) -> Any:
    """Return the matrix of potentials: 0 at the inner electrode, free inside, equal at the outer one."""
    height, small = phi.doflocs[2], 1e-9 * LENGTH
    top = height > CORE / 2 + LAYER - small
    inside = (height > CORE / 2 + small) & ~top
    outer = sp.csr_matrix(top.astype(float)[:, None])
    return sp.hstack([sp.identity(phi.N, format="csr")[:, inside], outer]).tocsr()


def _free(basis: Any) -> np.ndarray:
    """Return the indices of displacements that are not fixed by clamp or symmetry."""
    x, y, z = basis.doflocs
    small, component = 1e-9 * LENGTH, np.empty(basis.N, dtype=int)
    for dofs in (basis.nodal_dofs, basis.edge_dofs):
        component[dofs] = np.arange(len(dofs))[:, None] % 3
    held = (x < small) | ((z < small) & (component < 2)) | ((y < small) & (component == 1))
    return np.flatnonzero(~held)


def solid(width: float) -> tuple[Found, Found]:
    """Extrapolate the results of three meshes; return them and their relative errors."""
    by_mesh = [Solid.of(width, counts).found() for counts in MESHES]
    values, errors = np.transpose([extrapolate(each) for each in zip(*by_mesh, strict=True)]).tolist()
    return Found(*values), Found(*errors)


# The beam -----------------------------------------------------------------------------------------


def scene(width: float, resistance: float, physics: bd.Physics) -> bd.Scene:
    """Build the scene of the bimorph modelled as a beam."""
    strip = bd.Beam.rectangular(LENGTH, width, CORE, BRASS, HEAVY_BRASS, poissons_ratio=BRASS_RATIO)
    material = {"d31": D31, "s11e": S11, "eps33t": EPS_33, "poissons_ratio": -S12 / S11}
    layers = bd.Harvester(LAYER, HEAVY_PZT, "series", **material, resistance=resistance)
    return bd.Scene(layers.on(strip), physics=physics)


def beam(width: float, physics: bd.Physics) -> tuple[Found, Found]:
    """Compute the results of the beam model, and its stated model errors."""
    short, opened = (bd.natural_modes(scene(width, r, physics), modes=1) for r in (0.0, math.inf))
    voltage = _voltage(width, physics)
    camber = np.nan if physics is CAMBER else abs(_voltage(width, CAMBER) / voltage - 1)
    stated = Found(float(short.model_error[0]), float(opened.model_error[0]), camber)
    return Found(float(short.frequency[0]), float(opened.frequency[0]), voltage), stated


def _voltage(width: float, physics: bd.Physics) -> float:
    given = scene(width, math.inf, physics)
    found = bd.frequency_response(given, 0.0, [FREQUENCY], output="voltage", modes=None)
    return float(np.abs(found.response[0, 0]))


def _percent(error: float) -> str:
    """Format a model error in percent, or state that it is unknown."""
    return "not stated" if np.isnan(error) else f"{error:.2%}"


def rows() -> Iterator[tuple[str, ...]]:
    """Yield rows of the table: solid, plain beam and beam with camber of each width."""
    for ratio in WIDTHS:
        body, errors = solid(ratio * LENGTH)
        yield f"{ratio:g}", "solid", *(f"{v:.5g} ({e:.1e})" for v, e in zip(body, errors, strict=True))
        for name, physics in (("beam", PLAIN), ("beam with camber", CAMBER)):
            found, stated = beam(ratio * LENGTH, physics)
            each = zip(found, body, stated, strict=True)
            yield "", name, *(f"{v:.5g} ({v / b - 1:+.2%}; {_percent(e)})" for v, b, e in each)


def main() -> None:
    import skfem

    body, table = [*rows()], Table(*HEAD)
    for row in body:
        table.add_row(*row)
    Console(width=150).print(table)
    sizes = {"length": 1e3 * LENGTH, "core": 1e3 * CORE, "layer": 1e3 * LAYER}
    versions = {"version": ours.version(), "fem": skfem.__version__}
    page.write_section(
        TEXT.format(heading=HEADING.strip(), day=date.today(), **versions, **sizes)
        + markdown_table(HEAD, body)
    )


if __name__ == "__main__":
    main()
