"""The published numbers again: each beside ours, with its deviation and a verdict."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.polynomial import Polynomial
from rich.console import Console, Group

from beamdyn.beam import Beam, TipMass
from beamdyn.plots import mark_points, plot_loci_by_angle, plot_locus, save_figure
from beamdyn.published import load
from beamdyn.report import Comparison, comparison_table, table
from beamdyn.ritz import Ritz
from beamdyn.scene import Mount, Scene
from beamdyn.spectrum import frequency_locus, natural_modes
from beamdyn.stability import critical_point, setting_angle_limits

_PAPER, _ANSYS, _OWN = "paper", "ANSYS (4)", "independent (5)"
_ROUNDING = 1e-12  # relative, of a value that is defined by a basis of given size
_INTRODUCTION = """
A cantilever on the rim of a wheel points at the axis (input: Table 1 of the paper). Below, each number that
the paper prints stands beside ours, found by assumed modes (Ritz) and by finite elements (FE). They agree if
they differ by no more than the rounding of the printed value and our estimated error together. Of our numbers
only those digits are printed that the estimated error supports.
"""
_OUTSIDE = "(linear equations, outside their range)"
_TOP = 150.0  # rad/s: Fig. 6 ends here; Fig. 8 and 9 do not say where they end


def published_scene() -> Scene:
    """The scene of Lee and Yoo (2019), Table 1."""
    given = {name: entry["value"] for name, entry in load("lee_yoo_2019")["input"].items()}
    names = ("length", "width", "thickness", "youngs_modulus", "density")
    return Scene(Beam.rectangular(**{name: given[name] for name in names}), Mount(given["radius"]))


def report(screen: Console, folder: Path, tables: bool = False) -> list[Comparison | Summary]:
    """Print the comparisons and draw the figures.

    Parameters
    ----------
    screen : Console
        Where to print.
    folder : Path
        Where to draw.
    tables : bool
        Compare with the tables of other sources too.

    Returns
    -------
    list of Comparison and Summary
        All that was compared.
    """
    paper = load("lee_yoo_2019")
    screen.print(
        f"{paper['title']}\n{' and '.join(paper['authors'])}, {paper['journal']}, {paper['year']}",
        style="bold",
    )
    screen.print(_INTRODUCTION)
    first, limits, buckling = [*first_frequencies()], [*limits_of_setting_angle()], [*buckling_speed()]
    screen.print(comparison_table("Table 2: first natural frequency, beam pointing inward [Hz]", first))
    screen.print(comparison_table("Section 3.3: limits of the setting angle [deg]", limits))
    screen.print(comparison_table("Section 4: speed of buckling, beam pointing inward [rad/s]", buckling))
    for note in notes():
        screen.print(note)
    others = [*summaries()] if tables else []
    if others:
        screen.print(_summary_table(others))
    for path in draw(folder):
        screen.print(f"drawn: {path}", soft_wrap=True)
    return [*first, *limits, *buckling, *others]


# Lee and Yoo ---------------------------------------------------------------------------------------


def first_frequencies() -> Iterator[Comparison]:
    """Table 2: the first frequency at three speeds, by the paper and ANSYS, against three models of ours."""
    paper, scene = load("lee_yoo_2019"), published_scene()
    models = (
        ("Ritz", scene, "ritz"),
        ("FE", scene, "fem"),
        ("with stretch", replace(scene, stretch=True), "ritz"),
    )
    for row, exact in zip(paper["first_frequency"], paper["reference"]["first_frequency"], strict=True):
        speed = row["speed"]["value"]
        for name, model, method in models:
            found = natural_modes(model, speed, 1, method)
            ours = float(found.frequency[0])
            error = float(found.error[0]) * ours
            what = f"{speed:g} rad/s, {name}"
            for source, entry in ((_PAPER, row["proposed"]), (_ANSYS, row["ansys"])):
                reason = "unexplained (1)" if source == _PAPER and speed == 0 else ""
                yield Comparison(what, source, entry["value"], ours, error, entry["decimals"], reason)
            value = exact["stretch" if model.stretch else "bending"]["value"]
            yield Comparison(what, _OWN, value, ours, error, 8)


def limits_of_setting_angle() -> Iterator[Comparison]:
    """Section 3.3: the two setting-angle limits."""
    paper, scene = load("lee_yoo_2019"), published_scene()
    yield from _first_limit(paper, scene)
    yield from _second_limit_of_modes(paper, scene)
    yield from _second_limit(paper, scene)


def buckling_speed() -> Iterator[Comparison]:
    """The speed at which the inward beam buckles, of which the paper has no number."""
    entry = load("lee_yoo_2019")["reference"]["critical_speed"]
    for name, method in (("Ritz", "ritz"), ("FE", "fem")):
        found = critical_point(published_scene(), method)
        yield Comparison(
            f"critical speed, {name}", _OWN, entry["value"], found.speed, found.error * found.speed, 4
        )


def _first_limit(paper: dict[str, Any], scene: Scene) -> Iterator[Comparison]:
    printed, exact = paper["setting_angle_limits"]["first"], paper["reference"]["first_setting_angle_limit"]
    for name, method in (("Ritz", "ritz"), ("FE", "fem")):
        found = setting_angle_limits(scene, _TOP, method)
        what, ours, error = (
            f"first limit, {name}",
            float(np.degrees(found.first)),
            float(np.degrees(found.error)),
        )
        yield Comparison(what, _PAPER, tuple(printed["value"]), ours, error, 2)
        yield Comparison(what, _OWN, exact["value"], ours, error, 5)


def _second_limit_of_modes(paper: dict[str, Any], scene: Scene) -> Iterator[Comparison]:
    """Of a basis of N eigenfunctions, whose limit at any speed is a number of that basis."""
    printed, exact = (
        paper["setting_angle_limits"]["second"],
        paper["reference"]["second_setting_angle_limit_of_modes"],
    )
    for modes, value in zip(exact["modes"], exact["value"], strict=True):
        found = setting_angle_limits(scene, np.inf, Ritz(modes, "eigenfunctions"))
        what, ours = f"second limit of {modes} modes", float(np.degrees(found.second))
        if modes == 5:
            yield Comparison(what, _PAPER, tuple(printed["value"]), ours, ours * _ROUNDING, 2)
        yield Comparison(what, _OWN, value, ours, ours * _ROUNDING, _decimals(value))


def _second_limit(paper: dict[str, Any], scene: Scene) -> Iterator[Comparison]:
    """Converged, for several top speeds."""
    printed = tuple(paper["setting_angle_limits"]["second"]["value"])
    exact = [(e["top_speed"]["value"], e["value"]) for e in paper["reference"]["second_setting_angle_limit"]]
    for top, value in [(_TOP, None), *exact]:
        found = setting_angle_limits(scene, top)
        what, ours = f"second limit, to {top:g} rad/s", float(np.degrees(found.second))
        error = float(np.degrees(found.error))
        if value is None:
            yield Comparison(what, _PAPER, printed, ours, error, 2, "top speed (2)")
        else:
            yield Comparison(what, _OWN, value, ours, error, _decimals(value))


def notes() -> Iterator[str]:
    """What the tables do not say."""
    scene = published_scene()
    rest = natural_modes(scene, 0.0, 1)
    second = setting_angle_limits(scene, 400.0)
    yield (
        "(1) The paper prints 65.231 Hz at rest; its own input gives "
        f"{rest.frequency[0]:.6f} Hz, as ANSYS does. The cause of the difference is unknown."
    )
    yield (
        "(2) Above the second limit the first frequency rises up to the top speed, so the limit depends on "
        "where one stops. The paper does not say where; 150 rad/s is the end of its Fig. 6. Its 89.62 to "
        "89.63 deg is what exactly five clamped-free modes give; with more modes the limit tends to 90 deg."
    )
    yield (
        "(3) The limits are results of the linear equations outside their range: at the second limit for "
        f"400 rad/s the rotation would bend the tip by {second.static_deflection:.2g} lengths of the beam."
    )
    yield (
        "(4) As printed in the paper. (5) 40-digit Rayleigh-Ritz and power series, made apart from this "
        "program; not in the paper. A deviation '0 ± e' is lost in our estimated error.\n"
    )


def draw(folder: Path) -> list[Path]:
    """Draw Fig. 4, 8 and 9 into a folder, which is made if needed; files of the same names are replaced."""
    folder.mkdir(parents=True, exist_ok=True)
    pictures = {"fig_4.png": _fig_4, "fig_8.png": _fig_8, "fig_9.png": _fig_9}
    return [save_figure(picture(), folder / name, force=True) for name, picture in pictures.items()]


def _fig_4() -> Figure:
    rows = load("lee_yoo_2019")["first_frequency"]
    scene, figure = published_scene(), Figure(figsize=(7.5, 4.8), layout="constrained")
    critical = critical_point(scene).speed
    speeds = critical * np.sin(np.linspace(0, np.pi / 2 - 1e-3, 301))  # dense where the frequency falls to 0
    ax = figure.subplots()
    ax.set_xlim(-4, 204)
    plot_locus(speeds, frequency_locus(scene, speeds, 1).frequency, ax, ["ours (Ritz)"], critical)
    mark_points(
        ax, [r["speed"]["value"] for r in rows], [r["ansys"]["value"] for r in rows], "ANSYS, in the paper"
    )
    ax.set_title("Fig. 4: first natural frequency, setting angle 0")
    return figure


def _fig_8() -> Figure:
    angles = load("lee_yoo_2019")["figures"]["fig_8"]["setting_angle"]
    figure = Figure(figsize=(12, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    speeds = np.linspace(0, _TOP, 301)
    plot_loci_by_angle(speeds, _first_by_angle(angles, speeds), angles, left)
    speeds = np.linspace(0, 17, 171)
    first = _first_by_angle(angles, speeds)
    plot_loci_by_angle(speeds, (first - first[:, :1]) * 1e6, angles, right)
    right.set(ylim=(-0.5, 0.5), ylabel="change from rest [µHz]")
    left.set_title("over speed")
    right.set_title("near rest: one falls, the other first rises")
    figure.suptitle(
        f"Fig. 8: first natural frequency on either side of the first setting-angle limit {_OUTSIDE}"
    )
    return figure


def _fig_9() -> Figure:
    angles = load("lee_yoo_2019")["figures"]["fig_9"]["setting_angle"]
    figure = Figure(figsize=(12, 4.8), layout="constrained")
    cases = (
        (12000.0, Ritz(5, "eigenfunctions"), "five clamped-free modes: one turns, the other rises on"),
        (5000.0, "ritz", "converged: both turn"),
    )
    for ax, (top, method, title) in zip(figure.subplots(1, 2), cases, strict=True):
        speeds = np.linspace(0, top, 501)
        plot_loci_by_angle(speeds, _first_by_angle(angles, speeds, method), angles, ax)
        ax.set_title(title)
    figure.suptitle(f"Fig. 9: first natural frequency on either side of the paper's second limit {_OUTSIDE}")
    return figure


def _first_by_angle(angles: Sequence[float], speeds: np.ndarray, method: str | Ritz = "ritz") -> np.ndarray:
    """First frequency at setting angles [deg] over speeds: shape (angles, speeds)."""
    scene = published_scene()
    mounts = [replace(scene.mount, setting_angle=float(np.radians(angle))) for angle in angles]
    loci = [frequency_locus(replace(scene, mount=mount), speeds, 1, method) for mount in mounts]
    return np.array([locus.frequency[:, 0] for locus in loci])


# Rotating beams of many sources ---------------------------------------------------------------------


@dataclass(frozen=True)
class Summary:
    """Many values of one source against one method.

    Parameters
    ----------
    source, method : str
        Of which values, by which method.
    values : int
        How many.
    printed : float
        Largest relative half unit of the last digit printed.
    deviation, error : float
        Largest relative deviation and largest estimated relative error.
    outside : int
        How many deviate by more than both together.
    """

    source: str
    method: str
    values: int
    printed: float
    deviation: float
    error: float
    outside: int

    @property
    def as_expected(self) -> bool:
        """Whether all values agree."""
        return not self.outside

    def cells(self) -> list[str]:
        """Its row of the table."""
        numbers = (f"{x:.1e}" for x in (self.printed, self.deviation, self.error))
        verdict = f"differs: {self.outside} value(s)" if self.outside else "agrees"
        return [self.source, self.method, str(self.values), *numbers, verdict]


def summaries() -> Iterator[Summary]:
    """All cases of the published tables, and the critical speeds, by source and method."""
    data = load("rotating_beams")
    groups: dict[str, list[dict[str, Any]]] = {}
    for case in data["case"]:
        groups.setdefault(case["source"], []).append(case)
    groups["critical speeds, computed"] = [c for c in data["critical"] if np.isfinite(c["gamma"])]
    for source, cases in groups.items():
        for name, method in (("Ritz", "ritz"), ("FE", "fem")):
            yield _summary(source, name, [_solved(case, method) for case in cases])


def _summary_table(rows: Sequence[Summary]) -> Group:
    heads = (
        "source",
        "method",
        "values",
        "printed to",
        "worst deviation",
        "worst estimated error",
        "verdict",
    )
    title = "Rotating beams of other sources; all relative"
    return table(title, heads, (row.cells() for row in rows), (0, 1, 6))


def _summary(source: str, method: str, parts: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> Summary:
    printed, ours, error = (np.concatenate(column) for column in zip(*parts, strict=True))
    rounding = np.array([0.5 * 10.0 ** -_decimals(value) for value in printed]) / printed
    deviation = np.abs(ours / printed - 1)
    outside = int((deviation > rounding + error).sum())
    return Summary(source, method, len(ours), rounding.max(), deviation.max(), error.max(), outside)


def _solved(case: dict[str, Any], method: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Published values, ours, and our relative errors."""
    scene = nondimensional(case)
    if "frequency" in case:
        found = natural_modes(scene, case["gamma"], len(case["frequency"]), method)
        return np.array(case["frequency"]), np.abs(found.eigenvalue), found.error
    point = critical_point(scene, method)
    return np.array([case["gamma"]]), np.array([point.speed]), np.array([point.error])


def nondimensional(case: dict[str, Any]) -> Scene:
    """The scene of a nondimensional case: root stiffness, root mass per length and length are 1.

    Parameters
    ----------
    case : dict
        A ``case`` or ``critical`` of ``rotating_beams.toml``.

    Returns
    -------
    Scene
        Its eigenvalues at gamma rad/s are lambda in size.
    """
    delta, alpha = case["delta"], case.get("alpha")
    beam = Beam.from_stiffness(
        1.0,
        mass_per_length=Polynomial(case["mass"]),
        bending_stiffness=Polynomial(case["stiffness"]),
        axial_stiffness=alpha and alpha**2,
        tip=TipMass(**case["tip"]) if "tip" in case else None,
    )
    mount = Mount(abs(delta), 0.0 if delta < 0 else np.pi, float(np.radians(case["bending_angle_deg"])))
    return Scene(beam, mount, stretch=alpha is not None)


def _decimals(value: float) -> int:
    """Decimals with which a value is written."""
    return len(np.format_float_positional(value).partition(".")[2])
