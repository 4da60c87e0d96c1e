"""Measured beams, each modelled as clamped: Epps and Chandra's straight beam, Carnegie's twisted blade."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import pi, radians

import beamdyn as bd
from beamdyn.common.results.comparison import Comparison
from beamdyn.published import load
from benchmarks.cases.textbooks import INCH, LBF
from benchmarks.cases.two_planes import carnegie_scene

RPM = 2 * pi / 60
APPROXIMATE = "his theory approximates the model that ours solves"
UNKNOWN_ROOT = "measured; of root and rig nothing is known, ours is clamped"


def straight_beam() -> bd.Scene:
    """Make the straight beam, pointing outward and bending out of the plane of rotation."""
    given = {name: entry["value"] for name, entry in load("epps_chandra_1996")["input"].items()}
    beam = bd.Beam.rectangular(
        given["length"] * INCH,
        given["width"] * INCH,
        given["thickness"] * INCH,
        given["youngs_modulus"] * LBF / INCH**2,
        given["density"] * LBF / INCH**4,
    )
    return bd.Scene(beam, bd.Mount(given["hub_radius"] * INCH, pi, pi / 2))


def swept_beam(sweep_deg: float) -> bd.Scene:
    """Make the beam with its tip swept back, bending in two directions, and with torsion."""
    straight, given = straight_beam(), load("epps_chandra_1996")["input"]
    beam = bd.Beam.rectangular(
        straight.beam.length,
        given["width"]["value"] * INCH,
        given["thickness"]["value"] * INCH,
        given["youngs_modulus"]["value"] * LBF / INCH**2,
        given["density"]["value"] * LBF / INCH**4,
        poissons_ratio=given["poissons_ratio"]["value"],
        sweep=_kink_at(given["straight_length"]["value"] / given["length"]["value"], radians(sweep_deg)),
    )
    physics = bd.Physics(planes=2, rotary_inertia=True, torsion=True, large_deflection=True)
    return replace(straight, beam=beam, physics=physics)


def _kink_at(place: float, angle: float) -> bd.Table:
    return bd.Table([0.0, place, place, 1.0], [0.0, 0.0, angle, angle])


def compare() -> Iterator[Comparison]:
    """Compare all measured frequencies [Hz] of both beams with computed frequencies."""
    scene = straight_beam()
    for row in load("epps_chandra_1996")["measured"]:
        printed = row["frequency"]
        modes = bd.natural_modes(scene, row["speed_rpm"] * RPM, len(printed))
        for i, text in enumerate(printed):
            ours = float(modes.frequency[i])
            what = f"{row['speed_rpm']:g} rpm, mode {i + 1}"
            error = float(modes.error[i]) * ours
            yield Comparison(what, "measured", float(text), ours, error, 1, UNKNOWN_ROOT)


def compare_carnegie() -> Iterator[Comparison]:
    """Compare frequencies [Hz] of Carnegie's theory (it approximates our model) and experiment with ours."""
    known = load("twisted_beams")["carnegie"]
    modes = bd.natural_modes(carnegie_scene(), 0.0, len(known["frequency"]))
    reasons = {"printed": APPROXIMATE, "measured": "measured: the blade was not ideally clamped"}
    for key, reason in reasons.items():
        for i, text in enumerate(known[key]):
            ours = float(modes.frequency[i])
            decimals, error = len(text.partition(".")[2]), float(modes.error[i]) * ours
            close = abs(ours - float(text)) <= error + 0.5 * 10.0**-decimals
            what = f"{'theory' if key == 'printed' else 'experiment'}, mode {i + 1}"
            yield Comparison(what, "1959", float(text), ours, error, decimals, "" if close else reason)
