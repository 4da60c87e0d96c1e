"""Comparison with the published tables of rotating beams of other sources."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from rich.console import Group

from beamdyn.common.edge.tables import table
from beamdyn.modes.critical import critical_point
from beamdyn.modes.modes import natural_modes
from beamdyn.published import load
from beamdyn.reproduce.common import decimals
from beamdyn.reproduce.entries import Summary
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene


def summarize_sources() -> Iterator[Summary]:
    """Compare all cases of the published tables, and critical speeds, by source and discretization."""
    data = load("rotating_beams")
    groups: dict[str, list[dict[str, Any]]] = {}
    for case in data["case"]:
        groups.setdefault(case["source"], []).append(case)
    groups["critical speeds, computed"] = [c for c in data["critical"] if np.isfinite(c["gamma"])]
    for source, cases in groups.items():
        for name, discretization in (("Ritz", "ritz"), ("FE", "fem")):
            yield summarize(source, name, [solve_case(case, discretization) for case in cases])


def summarize_twisted() -> Iterator[Summary]:
    """Compare all cases of the tables of twisted and stocky beams, by what they are of and discretization."""
    groups: dict[str, list[dict[str, Any]]] = {}
    for case in load("twisted_beams")["case"]:
        groups.setdefault(case["source"], []).append(case)
    for source, cases in groups.items():
        for name, discretization in (("Ritz", "ritz"), ("FE", "fem")):
            yield summarize(source, name, [_solve_twisted(case, discretization) for case in cases])


def _solve_twisted(case: dict[str, Any], discretization: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve a case of twisted beams: the values of the table, ours, and our relative errors."""
    printed = np.array(case["frequency"], dtype=float)
    modes = natural_modes(twisted_scene(case), case["gamma"], len(printed), discretization)
    return printed, np.abs(modes.eigenvalue), modes.error


def twisted_scene(case: dict[str, Any]) -> Scene:
    """Build the scene of a case of ``twisted_beams.toml``; its speed is gamma rad/s."""
    names = ("second_bending_stiffness", "twist", "shear_stiffness", "rotary_inertia")
    given: dict[str, Any] = {name: Polynomial(case[name]) for name in names if name in case}
    beam = Beam.from_stiffness(
        1.0, Polynomial(case["mass_per_length"]), Polynomial(case["bending_stiffness"]), **given
    )
    angles = (float(np.radians(case[name])) for name in ("setting_angle_deg", "bending_angle_deg"))
    shear, rotary = "shear_stiffness" in case, "rotary_inertia" in case
    physics = Physics(planes=case["planes"], shear=shear, rotary_inertia=rotary)
    return Scene(beam, Mount(case["radius"], *angles), physics=physics)


def summary_table(rows: Sequence[Summary]) -> Group:
    """Table of summaries."""
    heads = ("source", "by", "values", "printed to", "deviation", "error", "verdict")
    title = (
        "Beams and blades of other sources: the worst deviation, errata apart, and estimated error, relative"
    )
    return table(title, heads, (row.cells() for row in rows), (0, 1, 6))


def summarize(
    source: str, discretization: str, parts: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]]
) -> Summary:
    """Summarize the comparison of several cases; `parts` are the results of `solve_case`."""
    printed, ours, error = (np.concatenate(column) for column in zip(*parts, strict=True))
    rounding = np.array([0.5 * 10.0 ** -decimals(value) for value in printed]) / printed
    deviation = np.abs(ours / printed - 1)
    outside, in_print = int((deviation > rounding + error).sum()), bool((deviation <= rounding).all())
    allowed, worst, stated = (float(column.max()) for column in (rounding, deviation, error))
    return Summary(source, discretization, len(ours), allowed, worst, stated, outside, in_print=in_print)


def solve_case(case: dict[str, Any], discretization: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve a case: the published values, ours, and our relative errors."""
    scene = nondimensional_scene(case)
    if "frequency" in case:
        modes = natural_modes(scene, case["gamma"], len(case["frequency"]), discretization)
        return np.array(case["frequency"]), np.abs(modes.eigenvalue), modes.error
    point = critical_point(scene, discretization)
    return np.array([case["gamma"]]), np.array([point.speed]), np.array([point.error])


def nondimensional_scene(case: dict[str, Any]) -> Scene:
    """Build the scene of a nondimensional case: root stiffness, root mass per length and length are 1.

    Parameters
    ----------
    case : dict
        A ``case`` or ``critical`` of ``rotating_beams.toml``.

    Returns
    -------
    Scene
        Scene whose eigenvalues at gamma rad/s have the magnitude lambda.
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
    return Scene(beam, mount, physics=Physics(stretch=alpha is not None))
