"""Elements of the program BModes 3: its matrices for a straight blade, without gyroscopic terms.

Of src/bmodes/Struct.f90 and BldVib.f90 of github.com/old-NWTC/BModes @c8a0b48.  Displacements u along the
blade (cubic), v to the leading edge and w flapwise (cubic Hermite), and the twist phi (quadratic).  Each
element has the section in its middle.  It is a copy of what that program computes, for tracing its numbers.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy.linalg
from numpy.polynomial import Polynomial

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(6)
_ON_ELEMENT = 9  # coordinates of an element: u, v, v', w, w', phi at a node; inside two of u, one of phi
_PLACES = {"u": [0, 6, 7, 9], "v": [1, 2, 10, 11], "w": [3, 4, 12, 13], "phi": [5, 8, 14]}
_CUBIC = [
    Polynomial(c) for c in ([1, -5.5, 9, -4.5], [0, 9, -22.5, 13.5], [0, -4.5, 18, -13.5], [0, 1, -4.5, 4.5])
]
_QUADRATIC = [Polynomial(c) for c in ([1, -3, 2], [0, 4, -4], [0, -1, 2])]
_HERMITE = [Polynomial(c) for c in ([1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1])]


def frequencies(blade: Mapping[str, Any], ends: np.ndarray, speed: float, count: int) -> np.ndarray:
    """Compute frequencies [Hz] of a published blade at a speed [rad/s], by elements with given ends x/L."""
    size = _ON_ELEMENT * (len(ends) - 1) + 6
    M, K = np.zeros((size, size)), np.zeros((size, size))
    middle, length = (ends[:-1] + ends[1:]) / 2, blade["length"]
    sections = {
        name: np.interp(middle, blade["stations"], values)
        for name, values in blade.items()
        if isinstance(values, np.ndarray) and values.shape == blade["stations"].shape
    }
    for name in ("flap_inertia", "edge_inertia"):  # BModes interpolates the squared radii of gyration
        squared = blade[name] / blade["mass_per_length"]
        sections[name] = np.interp(middle, blade["stations"], squared) * sections["mass_per_length"]
    r, m = blade["hub_radius"] + ends * length, sections["mass_per_length"]
    beyond = np.append(np.cumsum((m * (r[1:] ** 2 - r[:-1] ** 2) / 2)[::-1])[::-1][1:], 0.0)
    for i in range(len(middle)):
        own = {name: float(values[i]) for name, values in sections.items()}
        place = slice(_ON_ELEMENT * i, _ON_ELEMENT * i + 15)
        for point, weight in zip((1 + _POINTS) / 2, _WEIGHTS / 2 * (r[i + 1] - r[i]), strict=True):
            x = r[i] + point * (r[i + 1] - r[i])
            own["tension"] = beyond[i] + own["mass_per_length"] * (r[i + 1] ** 2 - x**2) / 2
            turn = -np.interp((x - r[0]) / length, blade["stations"], np.radians(blade["twist_deg"]))
            of_mass, of_stiffness = _at_point(own, turn, x, _functions(point, r[i + 1] - r[i]), speed)
            M[place, place] += weight * of_mass
            K[place, place] += weight * of_stiffness
    squares = scipy.linalg.eigh(K[6:, 6:], M[6:, 6:], eigvals_only=True, subset_by_index=[0, count - 1])
    return np.sqrt(squares) / (2 * np.pi)


def about_shear_centres(blade: Mapping[str, Any], ends: np.ndarray, speed: float, count: int) -> np.ndarray:
    """Compute `frequencies` with centre of mass and edgewise inertia relative to the shear centre."""
    from_shear_centre = blade["mass_offset"] - blade["shear_offset"]
    inertia = blade["edge_inertia"] + blade["mass_per_length"] * from_shear_centre**2
    read = {**blade, "mass_offset": from_shear_centre, "edge_inertia": inertia}
    return frequencies(read, ends, speed, count)


def _functions(point: float, length: float) -> dict[tuple[str, int], np.ndarray]:
    """Evaluate shape functions of each displacement and derivatives at a point of an element: (15,) each."""
    found = {}
    for name, functions in (("u", _CUBIC), ("v", _HERMITE), ("w", _HERMITE), ("phi", _QUADRATIC)):
        slopes = [length if name in "vw" and k % 2 else 1.0 for k in range(4)]
        for order in range(3):
            row = np.zeros(15)
            derivatives = [f.deriv(order)(point) if order else f(point) for f in functions]
            row[_PLACES[name]] = np.array(derivatives) * slopes[: len(functions)] / length**order
            found[name, order] = row
    return found


def _at_point(
    own: Mapping[str, float], turn: float, x: float, f: Mapping[tuple[str, int], np.ndarray], speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Compute mass and stiffness per length at a radius x, as in the linear part of BModes' source."""
    u, v, w, phi = (f[name, 0] for name in ("u", "v", "w", "phi"))
    c, s, m, spin = np.cos(turn), np.sin(turn), own["mass_per_length"], speed**2
    cg = -own["mass_offset"]  # positive towards the leading edge
    tc = own["shear_offset"] - own["tension_offset"]
    polar = own["flap_inertia"] + own["edge_inertia"]
    M = m * _product(u, u) + m * _product(v, v) + m * _product(w, w) + polar * _product(phi, phi)
    M += _both(phi, m * cg * (c * w - s * v))
    flap, edge = c * f["w", 2] - s * f["v", 2], c * f["v", 2] + s * f["w", 2]
    K = own["flap_stiffness"] * _product(flap, flap) + own["edge_stiffness"] * _product(edge, edge)
    K += own["torsion_stiffness"] * _product(f["phi", 1], f["phi", 1])
    K += own["axial_stiffness"] * (_product(f["u", 1], f["u", 1]) - _both(f["u", 1], tc * edge))
    K += spin * own["tension"] * (_product(f["v", 1], f["v", 1]) + _product(f["w", 1], f["w", 1]))
    K -= spin * m * _product(v, v)
    K += spin * m * cg * _both(phi, s * v + x * (c * f["w", 1] - s * f["v", 1]))
    K += spin * (own["edge_inertia"] - own["flap_inertia"]) * np.cos(2 * turn) * _product(phi, phi)
    return M, K


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.outer(a, b)


def _both(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.outer(a, b) + np.outer(b, a)
