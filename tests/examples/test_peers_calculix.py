"""The comparison with solid elements of CalculiX: decks, what is read, and answers where it is installed."""

import math
import re

import numpy as np
import pytest

from benchmarks.peers import (
    bent,
    calculix,
    hexahedra,
    measure,
    tapered,
)
from benchmarks.peers.tapered import CLAMPED, HELD_AXIALLY, Blade

DAT = """

     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1   0.1679699E+06   0.4098413E+03   0.6522827E+02   0.0000000E+00

     P A R T I C I P A T I O N   F A C T O R S

MODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION      Z-ROTATION

      1   0.3927251E-14  -0.2192837E-01   0.1447987E-12  -0.2450314E-11  -0.5352602E-14  -0.7966017E-03
"""


# CalculiX -----------------------------------------------------------------------------------------


def test_first_frequency_is_read():
    assert calculix.first_frequency(DAT) == 65.22827


def test_missing_frequency_is_refused():
    with pytest.raises(ValueError, match="did not converge"):
        calculix.first_frequency(DAT.split("1   0.16")[0])


@pytest.mark.parametrize("counts", [(1, 1, 1), (40, 1, 1), (5, 2, 3)])
def test_every_node_belongs_to_an_element(counts):
    number = hexahedra.numbers(counts)
    lines = [line.replace("\n", " ") for line in hexahedra.elements(counts, number)]
    used = [[int(n) for n in line.split(",")[1:]] for line in lines]
    assert len(used) == math.prod(counts) and all(len(set(own)) == 20 for own in used)
    assert set().union(*used) == set(number.values()) == set(range(1, len(number) + 1))


@pytest.mark.parametrize("count", [1, 5, 40])
def test_mesh_of_the_harvester(count):
    mesh = calculix.nodes(count)
    assert len(mesh) == 12 * count + 8
    corner = np.array([0.05, 0.0002, 0.01])
    assert np.ptp(list(mesh.values()), axis=0) == pytest.approx(corner, rel=1e-14)


def test_middles_lie_between_the_corners_in_the_order_of_the_manual():
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    corners = np.array(hexahedra.CORNERS)
    assert [tuple((corners[a] + corners[b]) // 2) for a, b in edges] == list(hexahedra.MIDDLES)


def test_deck_has_load_and_root():
    text = calculix.deck(5, 50.0, True)
    assert "BEAM, CENTRIF, 2500, 0.215, 0, 0, 0, 0, 1\n" in text  # turns about z, through the axis
    assert "*STEP, NLGEOM\n" in text and "2e+11, 0\n" in text and "\n7850\n" in text
    root = re.search(r"NSET=ROOT\n(.*?)\*BOUNDARY", text, re.S)
    assert root is not None and len(root[1].split()) == 8
    assert "NLGEOM" not in calculix.deck(5, 50.0, False)


needs_calculix = pytest.mark.skipif(
    calculix.version() is None, reason="there is no ccx; on Debian: apt-get install calculix-ccx"
)


@needs_calculix
@pytest.mark.parametrize("speed", [0.0, 100.0])
def test_solid_elements_give_the_frequency_of_the_beam(speed):
    """The beam theory leaves out shear and rotary inertia, a part of about (thickness/length)^2."""
    left_out = (measure.given()["thickness"] / measure.given()["length"]) ** 2
    _, frequency = calculix.solve(calculix.deck(20, speed, False))
    assert frequency == pytest.approx(measure.harvester_frequencies()[speed], rel=2 * left_out)


# CalculiX, a tapered blade ------------------------------------------------------------------------

DIRECTIONS = """
     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1   0.1730400E+05   0.1315446E+03   0.2093600E+02   0.0000000E+00
      2   0.4537000E+06   0.6736000E+03   0.1072000E+03   0.0000000E+00
      3   0.9337000E+07   0.3055700E+04   0.4863000E+03   0.0000000E+00

     P A R T I C I P A T I O N   F A C T O R S

MODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION      Z-ROTATION

      1   0.3927251E-14  -0.2192837E+01   0.1447987E-12  -0.2450314E-11  -0.5352602E-14  -0.7966017E+00
      2   0.3927251E-14   0.2192837E-11  -0.2147987E+01  -0.2450314E-11  -0.5352602E+00  -0.7966017E-12
      3   0.3927251E-14   0.1632837E-02   0.9847987E-03  -0.7450314E-01  -0.5352602E-14  -0.7966017E-03

     E F F E C T I V E   M O D A L   M A S S

      1   0.3927251E-14   0.4808534E+01   0.1447987E-24   0.2450314E-21   0.5352602E-24   0.7966017E+00
"""


def test_modes_are_sorted_by_direction():
    assert tapered.sorted_by_direction(DIRECTIONS).tolist() == [20.936, 107.2]  # torsion is left out
    with pytest.raises(ValueError, match="did not converge"):
        tapered.sorted_by_direction("")


def test_blade_is_ten_times_longer_than_wide():
    counts = (4, 1, 2)
    lines = tapered.node_lines(Blade(), counts, hexahedra.numbers(counts))
    nodes = np.array([[float(value) for value in line.split(",")] for line in lines])[:, 1:]
    for x, thickness, width in ((0.0, 0.02, 0.1), (0.5, 0.015, 0.08), (1.0, 0.01, 0.06)):
        own = nodes[nodes[:, 0] == x]
        assert np.ptp(own, axis=0) == pytest.approx([0, thickness, width], abs=1e-14)
    assert nodes.mean(axis=0)[1:] == pytest.approx([0, 0], abs=1e-14)


def test_blade_turns_about_its_thickness_on_the_hub():
    text = tapered.deck(Blade(0.3), (4, 1, 2), 200.0)
    assert "BLADE, CENTRIF, 40000, -0.1, 0, 0, 0, 1, 0\n" in text and "*STEP, PERTURBATION\n" in text
    assert "2.1e+11, 0.3\n" in text and "CENTRIF" not in tapered.deck(Blade(), (4, 1, 2), 0.0)


def test_root_held_axially():
    """Means over the face and either half of it, exact for quadratic displacements; in half elements."""
    counts = (1, 2, 4)
    number = hexahedra.numbers(counts)
    place = {n: p for p, n in number.items()}
    lines = list(tapered.root_lines(HELD_AXIALLY, counts, number))
    assert lines[:2] == ["*BOUNDARY", "ROOT, 1, 1"]
    equations = [text.splitlines() for text in "\n".join(lines[2:]).split("*EQUATION\n")[1:]]
    terms = [np.array([line.split(",") for line in equation[1:]], dtype=float) for equation in equations]
    assert [int(equation[0]) for equation in equations] == list(map(len, terms))
    assert [set(own[:, 1]) for own in terms] == [{3}, {2}, {2}]
    for own, (start, end) in zip(terms, ((0, 8), (0, 4), (4, 8)), strict=True):
        _, y, z = np.array([place[int(n)] for n in own[:, 0]]).T
        weight = own[:, 2] / own[:, 2].sum()
        mean_square = (end**3 - start**3) / (3 * (end - start))
        assert weight @ np.column_stack([y, z, z * z]) == pytest.approx([2, (start + end) / 2, mean_square])
    # The first term is eliminated: no other equation of its direction may contain it.
    assert terms[1][0, 0] not in terms[2][:, 0] and terms[2][0, 0] not in terms[1][:, 0]


def test_shear_coefficient_of_a_rectangle():
    """Without contraction 5/6; of a thin one 5 (1 + nu) / (6 + 5 nu), that of plane stress."""
    assert [tapered.hutchinson(ratio, 0.0) for ratio in (0.1, 1, 5)] == pytest.approx([5 / 6] * 3, rel=1e-12)
    assert tapered.hutchinson(0.01, 0.3) == pytest.approx(6.5 / 7.5, rel=1e-6)


@needs_calculix
@pytest.mark.parametrize("speed", tapered.SPEEDS)
def test_solid_elements_give_the_frequencies_of_a_thick_beam(speed):
    """What a beam leaves out: the slope of the sides, and in E the strain by rotation, 5e-4 at the root."""
    solid = tapered.solid_frequencies(Blade(), (40, 2, 4), speed)
    own = tapered.beam(Blade())
    strain = 5e-4 * (speed / 200) ** 2
    assert solid == pytest.approx(tapered.beam_frequencies(own, speed), rel=1e-3 + strain / 2)
    slender = tapered.beam_frequencies(own, speed, tapered.SLENDER)
    assert np.all(np.abs(solid / slender - 1)[3:] > 5e-3)


@needs_calculix
def test_clamped_face_hinders_contraction():
    """With Poisson's ratio the solid is stiffer where its root cannot contract, and only there."""
    clamped, free = (
        tapered.solid_frequencies(Blade(0.3, root), (20, 2, 4), 0.0) for root in (CLAMPED, HELD_AXIALLY)
    )
    own = tapered.beam_frequencies(tapered.with_hutchinsons_shear(Blade(0.3)), 0.0)
    assert np.all(clamped / own - 1 > 2e-3)
    assert free == pytest.approx(own, rel=1.1e-3)


# CalculiX, a beam bent far by rotation ------------------------------------------------------------

BENT = """
 displacements (vx,vy,vz) for set TIP and time  0.1000000E+01

       761 -3.500000E-03 -1.700000E-02  1.496924E-17
       762 -3.600000E-03 -1.800000E-02  1.426275E-17

     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1   0.1452916E+06   0.3811714E+03   0.6066531E+02   0.0000000E+00
      2   0.8808992E+07   0.2967995E+04   0.4723711E+03   0.0000000E+00
      3   0.6225333E+07   0.2495062E+04   0.3970014E+03   0.0000000E+00

     P A R T I C I P A T I O N   F A C T O R S

MODE NO.   X-COMPONENT     Y-COMPONENT     Z-COMPONENT     X-ROTATION      Y-ROTATION      Z-ROTATION

      1   0.7696551E-12   0.2052691E-01  -0.5558303E-10   0.2204859E-12   0.2074390E-11   0.7413975E-03
      2  -0.3355654E-10  -0.5942384E-10  -0.1710604E-01   0.4101891E-04   0.6391515E-03  -0.2699026E-11
      3   0.1334688E-01  -0.1319361E-12  -0.2860893E-10   0.1057555E-12   0.1073922E-11  -0.1866502E-03

     E F F E C T I V E   M O D A L   M A S S

      1   0.5923690E-04   0.4213542E-03   0.3089473E-20   0.4861402E-25   0.4303093E-23   0.5496703E-06

 displacements (vx,vy,vz) for set TIP and time  0.0000000E+00

       761  1.000000E+00  1.000000E+00  1.000000E+00

     E I G E N V A L U E   O U T P U T

 MODE NO                     FREQUENCY
                      REAL PART         IMAGINARY PART
             (RAD/TIME)   (CYCLES/TIME)   (RAD/TIME)

      1   0.3811112E+03   0.6065573E+02  -0.5565566E-04
      2   0.2967956E+04   0.4723648E+03   0.1840618E-06
      3   0.2495370E+04   0.3971505E+03  -0.2161974E-05

P A R T I C I P A T I O N   F A C T O R S   F O R   M O D E       1

      1   0.6066557E+02   0.1000000E+01   0.0000000E+00
"""


def test_bent_state_is_read():
    solution = bent.read(BENT, 1.0)
    assert solution.tip == pytest.approx([1 - 3.55e-3 / 0.05, -1.75e-2 / 0.05], rel=1e-14)
    assert solution.static.tolist() == [60.66531, 397.0014]  # the second vibrates out of the plane
    assert solution.full.tolist() == [60.65573, 397.1505]
    with pytest.raises(ValueError, match="did not converge"):
        bent.read(BENT.partition("E I G")[0].replace("displacements", ""), 1.0)


def test_bent_beam_turns_about_the_axis_at_its_setting_angle():
    text = bent.deck(bent.Case(60.0, 100.0), 5)
    load = re.search(r"BEAM, CENTRIF, 10000, (\S+), (\S+), 0, 0, 0, 1\n", text)
    assert load is not None
    axis = [0.215 * math.cos(math.radians(60)), 0.215 * math.sin(math.radians(60))]
    assert [float(value) for value in load.groups()] == pytest.approx(axis, rel=1e-11)
    tip = re.search(r"NSET=TIP\n(.*?)\*BOUNDARY", text, re.S)
    assert tip is not None and len(tip[1].split()) == 13  # corners and middles of two faces
    assert "2e+11, 0\n" in text and "\n7850\n" in text


@needs_calculix
@pytest.mark.parametrize("case", bent.CASES, ids=str)
def test_solid_elements_bend_as_the_elastica(case):
    """20 elements are right to 5e-4 of the tip and of the first frequency; Coriolis is worth up to 6e-3."""
    solid, own = bent.solid(case, 20), bent.beam(case)
    assert solid.tip == pytest.approx(own.tip, abs=1e-3)
    assert solid.static[0] == pytest.approx(own.static[0], rel=1e-3)
    assert solid.full[0] == pytest.approx(own.full[0], rel=1e-3)
