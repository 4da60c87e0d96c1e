"""Blades of the program BeamDyn: its primary file with the blade file named there, or only the blade file.

BeamDyn's blade axes are x downwind, y to the trailing edge, z from root to tip.  The reference line through
the key points is a cubic spline in each member, with natural end conditions.  The axes of a cross-section are
z along this line, and x without a component along y of the root; x and y are then turned about -z by the
twist.  This package has the axes 1 = z, 2 = -x and 3 = -y, so that forces and moments (Fx, Fy, Fz, Mx, My,
Mz) are (-F2, -F3, F1, -M2, -M3, M1).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline

from beamdyn.common.edge.data_text import (
    DataText,
    NamedValue,
    check_all_there,
    named_count,
    named_values,
    number_at,
    plain_name,
    read_data,
)
from beamdyn.common.numerics import gauss_rule
from beamdyn.files.decks.blade import Blade, BladeMatrices, IgnoredProperty, check_order, ignore
from beamdyn.files.decks.elastodyn import named_file
from beamdyn.scene.section_matrices import (
    LEAST,
    MOST_ASYMMETRY,
    MOST_EXCESS,
    MOST_STRANGENESS,
    asymmetry,
    least_eigenvalues,
    polar_excess,
    strangeness,
)

_ROWS, _SIGNS = [2, 0, 1, 5, 3, 4], np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
_ANGLE = 0.05  # allowed difference [deg] of linearly interpolated angles from the splines
_SAMPLES = 8  # number of samples of a spline between two key points
_MOST_STATIONS = 100
_MAIN_NAMES = {plain_name(name): name for name in ("member_total", "kp_total", "BldFile")}
_BLADE_NAMES = {plain_name(name): name for name in ("station_total", "damp_type")}
_DAMPED = "natural frequencies are undamped; stiffness_factor in [damping] damps all strains alike"


def read_main_file(text: DataText, hub_radius: float) -> Blade:
    """Read the primary file with the key points, and the blade file named there.

    Raises
    ------
    ConfigError
        If data are missing or invalid, or the reference line turns back on itself.
    """
    found = named_values(text, _MAIN_NAMES.keys())
    check_all_there(text, found, _MAIN_NAMES)
    points, lines = _read_key_points(text, found)
    members = _read_members(text, found, len(points))
    blade = read_blade_file(read_data(named_file(text, found["bldfile"])), 1.0, hub_radius)
    assert blade.matrices is not None
    _check_line(text, points, lines)
    x, angles = _angles_of_line(points, members)
    kept = _places(x / x[-1], angles, blade.matrices.stations)
    at_kept = (_interpolated(kept, x / x[-1], a) for a in angles)
    return replace(
        blade,
        kind=f"BeamDyn primary file and {blade.kind}",
        title=text.lines[1].strip() if len(text.lines) > 1 else "",
        sources=(text.path, *blade.sources),
        length=float(x[-1]),
        stations=kept,
        columns=dict(zip(("twist", "sweep", "prebend"), at_kept, strict=True)),
    )


# Key points ---------------------------------------------------------------------------------------


def _read_key_points(text: DataText, found: dict[str, NamedValue]) -> tuple[np.ndarray, Sequence[int]]:
    """Read coordinates [m] and twist [deg] of k key points, shape (k, 4), and their line numbers."""
    count = named_count(text, found["kptotal"], least=3)
    heads = ("kpxr", "kpyr", "kpzr", "initialtwist")
    at = [n for n in range(1, len(text.lines) + 1) if [*map(plain_name, text.words(n)[:4])] == [*heads]]
    if not at:
        raise text.lacking("expected the headings kp_xr kp_yr kp_zr initial_twist above the key points")
    first = at[0] + 2
    lines = range(first, first + count)
    return np.array([_numbers(text, line, 4, "the coordinates of a key point") for line in lines]), lines


def _read_members(text: DataText, found: dict[str, NamedValue], points: int) -> list[slice]:
    """Read the key points of each member; its first point is the last point of the previous member."""
    count, line = named_count(text, found["membertotal"], least=1), found["kptotal"].line
    members, start = [], 0
    for k in range(1, count + 1):
        number = _numbers(text, line + k, 2, "the number of a member and of its key points")[1]
        if number not in range(3, points - start + 1):
            said = f"expected at least 3 key points in this member, and at most the {points - start} left"
            raise text.refusal(line + k, f"{said}, found {number:g}")
        members.append(slice(start, start + int(number)))
        start += int(number) - 1
    if start + 1 != points:
        said = f"the members have {start + 1} key points, but kp_total in line {line} is {points}"
        raise text.refusal(line + count, f"{said}; neighbouring members share one")
    return members


def _numbers(text: DataText, line: int, count: int, name: str) -> list[float]:
    """Read the first `count` numbers of a line; raise an error if there are fewer."""
    words = text.words(line)[:count] if line <= len(text.lines) else []
    if len(words) < count:
        raise text.refusal(min(line, len(text.lines)), f"expected {count} numbers, {name}")
    return [number_at(text, line, word, name) for word in words]


def _check_line(text: DataText, points: np.ndarray, lines: Sequence[int]) -> None:
    """Raise an error if the reference line does not start at the root, or turns back on itself."""
    if points[0, :3].any():
        raise text.refusal(lines[0], "expected the first key point at 0 0 0, the root")
    along = np.concatenate([[[0.0, 0.0, 1.0]], np.diff(points[:, :3], axis=0)])
    ahead = (along[1:] * along[:-1]).sum(axis=1)
    if (bad := np.flatnonzero(ahead <= 0)).size:
        k = bad[0] + 1
        said = f"the reference line turns back on itself at key point {k}" if k > 1 else "it starts backwards"
        raise text.refusal(
            lines[k], f"{said}; expected points in order from root to tip, at most 90 deg apart"
        )


def _angles_of_line(points: np.ndarray, members: Sequence[slice]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Compute arc length [m], twist, sweep and prebend [deg] at n points of the reference line."""
    lengths, found = [np.zeros(1)], []
    for member in members:
        own = points[member]
        chord = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(own[:, :3], axis=0), axis=1))])
        spline = CubicSpline(chord, own, bc_type="natural")
        at = np.concatenate([np.linspace(a, b, _SAMPLES + 1)[:-1] for a, b in pairwise(chord)])
        at = np.append(at, chord[-1])
        lengths.append(lengths[-1][-1] + np.append(0.0, np.cumsum(_arcs(spline, at))))
        tx, ty, tz = (spline(at, 1)[:, :3] / np.linalg.norm(spline(at, 1)[:, :3], axis=1)[:, None]).T
        angles = [-spline(at)[:, 3], np.degrees(np.arcsin(-ty)), np.degrees(np.arctan2(-tx, tz))]
        found.append(np.array(angles))
    return np.concatenate(lengths[1:]), [*np.concatenate(found, axis=1)]


def _arcs(spline: CubicSpline, at: np.ndarray) -> np.ndarray:
    """Compute the arc lengths of a curve between neighbouring points."""
    t, w = gauss_rule(4)
    middle, half = (at[1:] + at[:-1]) / 2, np.diff(at) / 2
    speed = np.linalg.norm(spline(middle[:, None] + half[:, None] * t, 1)[..., :3], axis=2)
    return half * (speed @ w)


def _places(x: np.ndarray, angles: Sequence[np.ndarray], stations: np.ndarray) -> np.ndarray:
    """Choose stations x/L between which angles [deg] are nearly linear.

    At a kink between two members there are two stations at one position.
    """
    jumps = [np.abs(a[1:] - a[:-1]) > _ANGLE for a in angles]
    kinks = x[1:][(x[1:] == x[:-1]) & np.any(jumps, axis=0)]
    kept = np.sort(np.concatenate([np.union1d(stations, kinks), kinks]))
    while len(kept) < _MOST_STATIONS:
        along = [_interpolated(x, kept, _interpolated(kept, x, a)) for a in angles]
        apart = np.abs(np.subtract(angles, along)).max(axis=0)
        apart[np.isin(x, kept)] = 0.0  # stations that were chosen already are not added again
        if apart.max() <= _ANGLE:
            break
        kept = np.sort(np.append(kept, x[apart.argmax()]))
    return kept


def _interpolated(at: np.ndarray, x: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Interpolate at ascending positions; a repeated position gets the values on both sides of a jump."""
    left, right = np.interp(-at, -x[::-1], values[::-1]), np.interp(at, x, values)
    return np.where(np.append(at[1:] == at[:-1], False), left, right)


# Matrices -----------------------------------------------------------------------------------------


def read_blade_file(text: DataText, length: float, hub_radius: float) -> Blade:
    """Read a blade file without primary file: cross-section matrices of a straight, untwisted blade.

    Parameters
    ----------
    text : DataText
        Text of the file.
    length, hub_radius : float
        Length of the blade and radius of the hub [m].

    Raises
    ------
    ConfigError
        If data are missing or invalid, or a matrix is not positive definite.
    """
    found = named_values(text, _BLADE_NAMES.keys())
    check_all_there(text, found, _BLADE_NAMES)
    stations, lines, both = _read_matrices(text, named_count(text, found["stationtotal"]))
    for name, matrices in zip(("stiffness", "mass"), both, strict=True):
        _check_matrices(text, name, stations, lines, matrices)
    stiffness, mass = ((each + each.swapaxes(1, 2)) / 2 for each in both)
    return Blade(
        kind="BeamDyn blade file",
        title=text.lines[1].strip() if len(text.lines) > 1 else "",
        sources=(text.path,),
        length=length,
        hub_radius=hub_radius,
        stations=stations,
        columns={},
        ignored=_damping(text, found["damptype"]),
        matrices=BladeMatrices(stations, _to_ours(stiffness), _to_ours(mass)),
    )


def _to_ours(matrices: np.ndarray) -> np.ndarray:
    """Convert n matrices (n, 6, 6) from the order and axes of BeamDyn to those of this package."""
    return _SIGNS[:, None] * matrices[:, _ROWS][:, :, _ROWS] * _SIGNS


def _read_matrices(text: DataText, count: int) -> tuple[np.ndarray, list[int], list[np.ndarray]]:
    """Read `count` stations, their line numbers, and two matrices (count, 6, 6), in the order of the file."""
    heads = [n for n, line in enumerate(text.lines, 1) if "distributedproperties" in plain_name(line)]
    if not heads:
        raise text.lacking("expected a line DISTRIBUTED PROPERTIES above the stations")
    rows = [n for n in range(heads[0] + 1, len(text.lines) + 1) if text.lines[n - 1].strip()]
    if len(rows) < 13 * count:
        raise text.lacking(f"expected {count} stations of 13 lines, two matrices of 6 x 6 each")
    places, matrices = rows[: 13 * count : 13], np.empty((2, count, 6, 6))
    for k in range(count):
        for r, at in enumerate(rows[13 * k + 1 : 13 * k + 13]):
            matrices[r // 6, k, r % 6] = _numbers(text, at, 6, "a row of a matrix")
    stations = np.array([_numbers(text, line, 1, "a station")[0] for line in places])
    check_order(text, places, "station", stations)
    return stations, places, [*matrices]


def _check_matrices(
    text: DataText, name: str, stations: np.ndarray, lines: Sequence[int], matrices: np.ndarray
) -> None:
    """Raise an error for a matrix that is not symmetric and positive definite.

    Also raise an error for a mass matrix that no rigid section has.
    """
    for bad, wanted in _faults(name, matrices):
        if bad.any():
            k = int(bad.argmax())
            said = f"the {name} of the section at eta = {stations[k]:g}"
            raise text.refusal(lines[k], f"{said}: expected {wanted}")


def _faults(name: str, matrices: np.ndarray) -> Iterator[tuple[np.ndarray, str]]:
    """Yield for each check which matrices fail it, and what is wanted; each needs those before it to pass."""
    yield asymmetry(matrices) > MOST_ASYMMETRY, "a symmetric matrix"
    ours = np.moveaxis(_to_ours((matrices + matrices.swapaxes(1, 2)) / 2), 0, 2)
    yield least_eigenvalues(ours) <= LEAST, "a positive definite matrix"
    if name == "mass":
        wanted = "mass m on the diagonal, m times the centre's offset off it, inertia about z = Ixx + Iyy"
        yield (strangeness(ours) > MOST_STRANGENESS) | (polar_excess(ours) > MOST_EXCESS), wanted


def _damping(text: DataText, kind: NamedValue) -> tuple[IgnoredProperty, ...]:
    """Record the damping in the file, if there is any, as a property that the scene cannot hold."""
    if kind.word == "0":
        return ()
    heads = [n for n in range(kind.line, len(text.lines) + 1) if text.words(n)[:1] == ["mu1"]]
    if not heads:
        raise text.lacking("expected the headings mu1 to mu6 above the damping coefficients")
    values = _numbers(text, heads[0] + 2, 6, "the damping coefficients")
    return ignore("mu1 to mu6", values, "s", _DAMPED)
