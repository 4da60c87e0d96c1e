"""BModes' own blade: what it prints, by its own matrices and by ours, and how far its elements are off."""

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.published import load
from beamdyn.reproduce.blades import printed_by_bmodes, stations, whole_blade_scene
from benchmarks.cases.reference import bmodes

BLADE, SPEED = stations("bmodes_test01"), 2 * math.pi
(ROW,) = (row for row in load("blades")["blade"] if row["name"] == "bmodes_test01")
ENDS = BLADE["element_ends"]
PRINTED = np.array([float(f) for f in ROW["frequency_printed_by_bmodes"]])


def ours(by_elements: bool) -> np.ndarray:
    scene = whole_blade_scene("bmodes_test01", by_elements)
    return bd.natural_modes(scene, SPEED, 5, tolerance=1e-6).frequency


def rotary_inertia_of_bending(by_elements: bool) -> np.ndarray:
    """What rotary inertia makes of each frequency of the blade that does not twist, as a factor."""
    scene = whole_blade_scene("bmodes_test01", by_elements)
    physics = replace(scene.physics, torsion=False)
    with_it, without = (
        bd.natural_modes(
            replace(scene, physics=replace(physics, rotary_inertia=each)), SPEED, 5, tolerance=1e-6
        )
        for each in (True, False)
    )
    return with_it.frequency / without.frequency


def test_its_matrices_give_what_it_prints():
    """To its last digit: what is compared with is what it computes."""
    found = bmodes.frequencies(BLADE, BLADE["element_ends"], SPEED, 5)
    np.testing.assert_allclose(found, PRINTED, rtol=0, atol=5.1e-5)  # half a unit of the last digit


def test_its_blade_by_the_sections_of_its_elements():
    """Its matrices with centres and moments of inertia from the shear centre, and without tilting, are ours.

    It takes the centre of mass from another axis than that of tension, which is worth 0.33 % of the fifth
    frequency, and has no rotary inertia of bending, 0.27 % of the fourth.
    """
    found = ours(by_elements=True) / rotary_inertia_of_bending(by_elements=True)
    np.testing.assert_allclose(found, bmodes.about_shear_centres(BLADE, ENDS, SPEED, 5), rtol=2e-3)


def test_what_reproduce_compares_is_traced_here():
    """The five numbers beside the printed ones are those whose difference is explained above."""
    np.testing.assert_allclose([each.ours for each in printed_by_bmodes()], ours(by_elements=True), rtol=1e-6)


def test_its_elements_are_off_by_per_cents():
    """With an eighth of the length of its elements it prints what we find for the stations."""
    ends = np.interp(np.linspace(0, 12, 97), np.arange(13), BLADE["element_ends"])
    fine = bmodes.frequencies(BLADE, ends, SPEED, 5)
    np.testing.assert_allclose(fine / PRINTED - 1, [0.0158, 0.0291, 0.0340, 0.0392, 0.0441], atol=5e-4)
    found = ours(by_elements=False) / rotary_inertia_of_bending(by_elements=False)
    np.testing.assert_allclose(found, bmodes.about_shear_centres(BLADE, ends, SPEED, 5), rtol=3e-3)


@pytest.mark.parametrize("discretization", [bd.Ritz(8), bd.Fem(80)])
def test_the_whole_blade_by_other_functions(discretization):
    found = bd.natural_modes(whole_blade_scene("bmodes_test01"), SPEED, 5, discretization).frequency
    np.testing.assert_allclose(found, ours(by_elements=False), rtol=1e-5)  # of the coarser two
