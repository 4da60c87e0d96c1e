"""A thin bimorph beside a three-dimensional piezoelectric solid."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.peers import page, piezo

MESH_ERROR = 1e-3  # of the medium mesh: it changes by 3e-4 to the finest


@pytest.mark.parametrize("ratio", [0.2, pytest.param(0.5, marks=pytest.mark.more)])
def test_a_beam_with_camber_is_within_two_percent_and_the_plain_one_says_how_far_it_is(ratio):
    width = ratio * piezo.LENGTH
    solid = np.array(piezo.Solid.of(width, piezo.MESHES[1]).found())
    camber, plain = (piezo.beam(width, physics) for physics in (piezo.CAMBER, piezo.PLAIN))
    assert (np.abs(np.array(camber[0]) / solid - 1) <= 0.02).all()  # the bound
    apart = np.abs(np.array(plain[0]) / solid - 1)
    assert (apart <= np.array(plain[1]) * 1.05 + MESH_ERROR).all()  # camber is judged to first order
    assert apart[2] > 0.1 and (apart > 0.01).all()  # there is something to say


def test_the_material_is_stable_and_isotropic_across():
    c, e, eps = piezo.constants()
    assert (np.linalg.eigvalsh(c) > 0).all() and (np.linalg.eigvalsh(eps) > 0).all()
    assert c[5, 5] == pytest.approx((c[0, 0] - c[0, 1]) / 2, rel=1e-12)
    assert e[2, 0] == pytest.approx(e[2, 1], rel=1e-12)
    steel = piezo.isotropic(200e9, 0.3)
    assert 1 / np.linalg.inv(steel)[0, 0] == pytest.approx(200e9, rel=1e-12)


def test_its_section_is_kept_on_the_page():
    assert page.PIEZO in page.HEADINGS and page.PIEZO in page.PAGE.read_text(encoding="utf-8")
