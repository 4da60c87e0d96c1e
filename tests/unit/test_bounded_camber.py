"""Camber where it is not modelled, and what large deflection changes beside modes of torsion and camber."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd

STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
PLATE = bd.Physics(camber=True, torsion=True)
CAMBER, BENT = "camber of sections", "large deflection"
STEPPED = bd.Beam.rectangular(
    0.05, bd.Table([0, 0.5, 0.5, 1], [0.01, 0.01, 0.006, 0.006]), 0.0002, 200e9, 7850.0, poissons_ratio=0.3
)
INWARD = bd.Mount(0.215)


def twisted(angle: float) -> bd.Beam:
    """The strip with a twist, by an angle at the tip [rad]."""
    return replace(STRIP, twist=bd.Beam.rectangular(
        0.05, 0.01, 0.0002, 200e9, 7850.0, twist=bd.Polynomial([0.0, angle])
    ).twist)  # fmt: skip


@pytest.mark.parametrize("beam", [STEPPED, twisted(0.3)])
def test_camber_that_is_not_modelled_is_bounded_by_sections_that_keep_their_shape(beam: bd.Beam) -> None:
    """At rest no more than (1 - nu^2)^(-1/2) - 1, with the effective ratio of the section."""
    modes = bd.natural_modes(bd.Scene(beam), modes=4)
    nu = STRIP.section.camber_ratio(np.array(0.5)).item()
    largest = 1 / math.sqrt(1 - nu**2) - 1
    assert modes.left_out[CAMBER].max() <= largest * (1 + 1e-3)
    assert modes.left_out[CAMBER].min() > 0.8 * largest
    assert "which is the most" in modes.left_out_effects.assumed[CAMBER]


def test_the_bound_exceeds_what_camber_changes() -> None:
    """Of the strip that is modelled, the smallest twist that counts gives the bound."""
    exact, bound = (bd.natural_modes(bd.Scene(b), modes=4).left_out[CAMBER] for b in (STRIP, twisted(1e-6)))
    assert (bound > 1.5 * exact).all()
    assert (exact > 0).all()


@pytest.mark.parametrize("angle", [0.0, 1e-15, 1e-10])
def test_a_twist_of_rounding_is_none(angle: float) -> None:
    straight, turned = (bd.natural_modes(bd.Scene(b, INWARD, physics=PLATE)) for b in (STRIP, twisted(angle)))
    np.testing.assert_array_equal(straight.frequency, turned.frequency)
    plain = bd.natural_modes(bd.Scene(twisted(angle), INWARD))
    assert "twist" not in plain.left_out
    assert not plain.warnings


def test_large_deflection_changes_modes_of_bending_beside_those_of_torsion() -> None:
    """As without torsion and camber; what it changes in modes of torsion is not known."""
    mount = bd.Mount(0.215, setting_angle=math.radians(45))
    with pytest.warns(bd.OutsideLinearTheory):
        plain = bd.natural_modes(bd.Scene(STRIP, mount), speed=100.0, modes=4)
    with pytest.warns(bd.OutsideLinearTheory):
        plate = bd.natural_modes(bd.Scene(STRIP, mount, physics=PLATE), speed=100.0, modes=6)
    of_bending = plate.kind == "bending"
    assert of_bending.sum() == 4
    np.testing.assert_allclose(
        plate.left_out[BENT][of_bending], plain.left_out[BENT], rtol=1e-5
    )  # fewer functions
    assert np.isnan(plate.left_out[BENT][~of_bending]).all()
    assert plate.left_out_effects.not_known[BENT] == "its effect is computed only for bending modes"


def test_modes_of_camber_are_named_where_the_model_lacks_them() -> None:
    """By the plate that has them, to 1.5 %: of the square plate two lie below the plain third mode."""
    square = bd.Beam.rectangular(0.05, 0.05, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    plain = bd.natural_modes(bd.Scene(square), modes=3).left_out_effects.unlisted
    named = [mode.frequency.item() for mode in plain if mode.kind == "camber"]
    plate = bd.natural_modes(bd.Scene(square, physics=PLATE), modes=8)
    np.testing.assert_allclose(named, plate.frequency[plate.kind == "camber"][:2], rtol=0.015)


def test_a_verdict_that_camber_reverses_is_said() -> None:
    """Between the critical speed without camber and that with it the plain beam diverges."""
    critical = [bd.critical_speed(bd.Scene(STRIP, INWARD, physics=p)) for p in (bd.Physics(), PLATE)]
    modes = bd.natural_modes(bd.Scene(STRIP, INWARD), speed=sum(critical) / 2, modes=2)
    assert modes.left_out_effects.reversals == {CAMBER: "with it a mode vibrates that diverges here"}
    assert any("decides on stability" in text for text in modes.model_warnings())
    past = bd.natural_modes(bd.Scene(STRIP, INWARD), speed=critical[1] * 1.01, modes=2)
    assert not past.left_out_effects.reversals


def test_a_transient_between_two_critical_speeds_says_what_is_not_known() -> None:
    """Without camber the beam would buckle, so that large deflection is not judged."""
    motion = bd.SpinUp(161.0, duration=1.0)
    run = bd.simulate(bd.Scene(STRIP, INWARD, motion, physics=PLATE), 1.0, modes=2)
    assert np.isnan(run.left_out[BENT])
    assert "past the critical speed" in run.left_out_effects.not_known[BENT]


def test_loads_of_layers_without_poissons_ratio_have_the_bound() -> None:
    scene = bd.load_scene("examples/bimorph.toml")
    found = bd.static_loads(scene, speeds=[20.0], at=[0.001]).left_out_effects
    assert scene.beam.strip is not None and scene.beam.strip.poissons_ratio is None
    assert "as if no section cambered" in found.assumed[CAMBER]
    # The strain follows the stiffness, which a Poisson's ratio of 0.5 raises by at most 1/(1 - 0.5^2).
    assert 0.2 < np.abs(found.changes[CAMBER]).max() < 1 / 3
