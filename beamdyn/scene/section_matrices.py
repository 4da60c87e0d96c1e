"""Sections given by 6 x 6 matrices of stiffness and of mass, which may couple all strains.

Rows and columns belong to the forces and moments (F1, F2, F3, M1, M2, M3) about the axis of the beam: 1
along it, 2 in the direction of bending and 3 across, in the axes of the section, which the twist turns.  The
stiffness matrix times the stretch, the two shear strains, the twist rate and the curvatures about 2 and 3
gives these forces and moments; the mass matrix, per length, times the accelerations gives the inertial ones.

In shapes of arrays, n is the number of sections.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, as_floats, real_array, set_fields, several
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.scene.profile import Profile, Table, merge_breakpoints, to_profile

SIZE = 6
UPPER = tuple((i, j) for i in range(SIZE) for j in range(i, SIZE))  # indices of the upper triangle
_FORCES = 3  # number of rows of forces; the others are of moments
LEAST = 1e-10  # smallest accepted eigenvalue of a positive definite matrix scaled to a diagonal of 1
MOST_ASYMMETRY = 1e-4  # largest accepted asymmetry of a matrix scaled to a diagonal of 1
# Entries in the rows of a matrix are named as faulty if the components of these rows in the eigenvector of
# the smallest eigenvalue exceed this fraction of the largest component.
_PART = 0.1
# Largest accepted difference of an entry of a mass matrix from that of a rigid section, divided by the square
# root of the product of the two diagonal entries in its row and column.
MOST_STRANGENESS = 1e-4
# Largest accepted difference of M44 from M55 + M66, over M44: tables with three digits differ by 2e-3.
MOST_EXCESS = 5e-3
RIGID_MASS = "M11 = M22 = M33, M15 = -M24, M16 = -M34 alone in rows 1 to 3; M44 = M55 + M66, M45 = M46 = 0"
# Properties of the beam that are diagonal entries of the stiffness.
_DIAGONAL = {
    "axial_stiffness": 0,
    "shear_stiffness": 1,
    "second_shear_stiffness": 2,
    "torsion_stiffness": 3,
    "second_bending_stiffness": 4,
    "bending_stiffness": 5,
}


def entry_units() -> dict[str, str]:
    """List the units of the entries in files: K11 to K66 of the stiffness, M11 to M66 of the mass."""
    units = {}
    for letter, by_moments in (("K", ("N", "N m", "N m2")), ("M", ("kg/m", "kg", "kg m"))):
        units |= {entry_name(letter, i, j): by_moments[(i >= _FORCES) + (j >= _FORCES)] for i, j in UPPER}
    return units


def entry_name(letter: str, i: int, j: int) -> str:
    """Return the name of an entry, such as K16, by its row and column from 0."""
    return f"{letter}{i + 1}{j + 1}"


@dataclass(frozen=True)
class SectionMatrices(FieldsOnly):
    """Stiffness and mass matrices of the sections along a beam.

    Parameters
    ----------
    stiffness, mass : sequence of Profile
        The 21 entries of the upper triangle of each, row by row, over x/L [N, N m, N m2; kg/m, kg, kg m].

    Raises
    ------
    ValueError
        If a matrix is not positive definite, or the mass is not that of a rigid section.

    Examples
    --------
    >>> stiffness = np.diag([1e9, 1e8, 1e8, 1e6, 4e6, 1e6])  # N, N m2
    >>> mass = np.diag([100.0, 100.0, 100.0, 3.0, 1.0, 2.0])  # kg/m, kg m
    >>> of_sections = bd.SectionMatrices.at_stations([0.0, 1.0], [stiffness] * 2, [mass] * 2)
    >>> float(of_sections.properties["bending_stiffness"](0.5))  # N m2
    1000000.0
    """

    stiffness: Sequence[Profile]
    mass: Sequence[Profile]

    def __post_init__(self) -> None:
        for name in ("stiffness", "mass"):
            remedy = "SectionMatrices.at_stations makes them"
            entries = several(f"matrices.{name}", getattr(self, name), Profile, remedy)
            if len(entries) != len(UPPER):
                bound = f"give the {len(UPPER)} entries of the upper triangle, row by row"
                raise InvalidValue(f"matrices.{name}", len(entries), bound)
            set_fields(self, **{name: entries})
        for name in ("stiffness", "mass"):
            self._check(name)

    @classmethod
    def at_stations(cls, stations: Any, stiffness: Any, mass: Any) -> SectionMatrices:
        """Build matrices that are linear between stations.

        Parameters
        ----------
        stations : array_like, shape (n,)
            Positions x/L, from 0 to 1, ascending; if a station is given twice, the matrices jump there.
        stiffness, mass : array_like, shape (n, 6, 6)
            The matrices.

        Returns
        -------
        SectionMatrices

        Raises
        ------
        ValueError
            If a matrix is not symmetric and positive definite, or the mass is not that of a rigid section.
        """
        entries, stations = [], real_array("stations", stations)
        for name, given in (("stiffness", stiffness), ("mass", mass)):
            matrices = as_floats(given)
            if matrices is None or matrices.shape != (len(stations), SIZE, SIZE):
                bound = f"give {len(stations)} matrices of 6 x 6 numbers, one for each of the stations"
                raise InvalidValue(f"matrices.{name}", given, bound)
            _check_symmetry(name, stations, matrices)
            matrices = (matrices + matrices.swapaxes(1, 2)) / 2
            entries.append([_profile(name, stations, matrices[:, i, j]) for i, j in UPPER])
        return cls(*entries)

    def _at_breakpoints(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Evaluate one matrix at both ends of each segment: positions x/L and matrices (6, 6, ends)."""
        ends = merge_breakpoints(np.concatenate([each.breakpoints for each in (*self.stiffness, *self.mass)]))
        found = np.empty((SIZE, SIZE, 2 * (len(ends) - 1)))
        for (i, j), entry in zip(UPPER, getattr(self, name), strict=True):
            found[i, j] = found[j, i] = np.stack(entry.split(ends).end_values(), axis=1).ravel()
        return np.repeat(ends, 2)[1:-1], found

    def at(self, name: str, xi: np.ndarray) -> np.ndarray:
        """Evaluate the matrices "stiffness" or "mass" at x/L = xi: (6, 6, positions)."""
        found = np.empty((SIZE, SIZE, len(xi)))
        for (i, j), entry in zip(UPPER, getattr(self, name), strict=True):
            found[i, j] = found[j, i] = entry(xi)
        return found

    @cached_property
    def properties(self) -> dict[str, Profile]:
        """Properties of `Beam`: diagonal stiffnesses, mass per length, inertias about the mass centre."""
        found = {name: self.stiffness[UPPER.index((k, k))] for name, k in _DIAGONAL.items()}
        xi, mass = self._at_breakpoints("mass")
        _, _, inertia = split_mass(mass)
        for name, k in (("rotary_inertia", 2), ("second_rotary_inertia", 1)):
            found[name] = _profile(name, xi, inertia[k, k])
        return found | {"mass_per_length": self.mass[0]}

    def _check(self, name: str) -> None:
        """Refuse matrices not positive definite at segment ends, and masses that no rigid section has."""
        xi, matrices = self._at_breakpoints(name)
        least = least_eigenvalues(matrices)
        if (bad := np.flatnonzero(least <= LEAST)).size:
            k = bad[0]
            bound = "its smallest eigenvalue, when scaled to a diagonal of 1, must be above {limit}"
            said = "such a section deforms without a force" if name == "stiffness" else "it has negative mass"
            remedy = f"{said}; check {_entries_at_fault(name, matrices[:, :, k])}"
            where = f" at x/L = {xi[k]:.4g}"
            raise InvalidValue(f"matrices.{name}", float(least[k]), bound, remedy, "", LEAST, where=where)
        bound = "the difference from the mass matrix of a rigid section must be at most {limit} of its size"
        checks = ((strangeness, MOST_STRANGENESS), (polar_excess, MOST_EXCESS)) if name == "mass" else ()
        for measure, limit in checks:
            if (bad := np.flatnonzero(measure(matrices) > limit)).size:
                value, where = float(measure(matrices)[bad[0]]), f" at x/L = {xi[bad[0]]:.4g}"
                remedy = f"give {RIGID_MASS}"
                raise InvalidValue("matrices.mass", value, bound, remedy, "", limit, where=where)


def _profile(name: str, stations: Sequence[float] | np.ndarray, values: np.ndarray) -> Profile:
    return to_profile(f"matrices.{name}", Table([*map(float, stations)], values.tolist()))


def _entries_at_fault(name: str, matrix: np.ndarray) -> str:
    """Name the entries of a matrix (6, 6) that cause the smallest eigenvalue of the scaled matrix."""
    shape = np.abs(np.linalg.eigh(_scaled(matrix[None]))[1][0, :, 0])
    rows, letter = np.flatnonzero(shape > _PART * shape.max()), "K" if name == "stiffness" else "M"
    return ", ".join(entry_name(letter, i, j) for i, j in UPPER if i in rows and j in rows)


def _scaled(matrices: np.ndarray) -> np.ndarray:
    """Scale matrices (sections, 6, 6) to a diagonal of 1; do not scale by a diagonal entry of 0 or less."""
    diagonal = np.einsum("nii->ni", matrices)
    roots = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    return matrices / (roots[:, :, None] * roots[:, None, :])


def least_eigenvalues(matrices: np.ndarray) -> np.ndarray:
    """Compute the smallest eigenvalue of each matrix (6, 6, sections), scaled to a diagonal of 1."""
    return np.linalg.eigvalsh(_scaled(np.moveaxis(matrices, 2, 0)))[:, 0]


def _check_symmetry(name: str, stations: Any, matrices: np.ndarray) -> None:
    apart = asymmetry(matrices)
    if (bad := np.flatnonzero(apart > MOST_ASYMMETRY)).size:
        bound, where = "it must be symmetric, within {limit}", f" at x/L = {float(stations[bad[0]]):.4g}"
        value = float(apart[bad[0]])
        raise InvalidValue(
            f"matrices.{name}", value, bound, "check both entries", "", MOST_ASYMMETRY, where=where
        )


def asymmetry(matrices: np.ndarray) -> np.ndarray:
    """Compute the largest asymmetry of each matrix (sections, 6, 6), scaled to a diagonal of 1."""
    scaled = _scaled(matrices)
    return np.abs(scaled - scaled.swapaxes(1, 2)).max(axis=(1, 2))


def split_mass(matrices: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Split mass matrices (6, 6, sections) into mass per length, mass centre, and inertia about it."""
    m = matrices[0, 0]
    c2, c3 = -matrices[0, 5] / m, matrices[0, 4] / m
    none = np.zeros_like(m)
    lever = np.stack([np.stack([none, -c3, c2]), np.stack([c3, none, none]), np.stack([-c2, none, none])])
    about_axis = -m * np.einsum("abj,bcj->acj", lever, lever)
    return m, np.stack([none, c2, c3]), matrices[3:, 3:] - about_axis


def strangeness(matrices: np.ndarray) -> np.ndarray:
    """Compute the largest difference of each scaled mass matrix (6, 6, sections) from a rigid section's.

    The polar moment of inertia, M44, is not compared: see `polar_excess`.
    """
    m, (_, c2, c3), _ = split_mass(matrices)
    rigid = matrices.copy()
    rigid[:3, :3], rigid[:3, 3:] = m * np.eye(3)[..., None], 0.0
    rigid[0, 4], rigid[0, 5], rigid[1, 3], rigid[2, 3] = m * c3, -m * c2, -m * c3, m * c2
    rigid[3:, :3] = rigid[:3, 3:].swapaxes(0, 1)
    rigid[3, 4:], rigid[4:, 3] = 0.0, 0.0
    apart = np.moveaxis(matrices - rigid, 2, 0)
    roots = np.sqrt(np.abs(np.einsum("iin->ni", matrices)))
    return np.abs(apart / (roots[:, :, None] * roots[:, None, :])).max(axis=(1, 2))


def polar_excess(matrices: np.ndarray) -> np.ndarray:
    """Compute the relative difference of M44 of each mass matrix from M55 + M66.

    Both are equal if all mass of the section lies in one plane across the beam.
    """
    return np.abs(1 - (matrices[4, 4] + matrices[5, 5]) / matrices[3, 3])
