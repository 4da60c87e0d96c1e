"""What beam, mount and scene refuse: each message names the key, the value and the remedy."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from beamdyn.modes.modes import natural_modes
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.motion.rotations import SteadyRotation
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.profile import Profile, Table, as_profile
from beamdyn.scene.scene import Scene
from beamdyn.scene.section_matrices import SectionMatrices
from beamdyn.scene.sections import section_tensor
from tests.unit.refusals import refused

STRIP = {"length": 0.05, "width": 0.01, "thickness": 0.0002, "youngs_modulus": 200e9, "density": 7850.0}
STIFFNESS = {"length": 0.05, "mass_per_length": 0.0157, "bending_stiffness": 1.3e-3}
STIFFNESS |= {"axial_stiffness": 4e5, "outer_fibre": 1e-4, "second_bending_stiffness": 3.3}
STIFFNESS |= {"shear_stiffness": 1e5, "second_shear_stiffness": 1e5}
STIFFNESS |= {"rotary_inertia": 5e-11, "second_rotary_inertia": 1.3e-7}
OPTIONAL = [*STIFFNESS][3:]

NOT_FINITE = [math.inf, -math.inf, math.nan]
NOT_POSITIVE = [0, 0.0, -0.0, -1, -1e-300, *NOT_FINITE]
NO_NUMBER = [None, "0.2 mm", "big", [], {}, 1j, object()]


def strip(**changes):
    return Beam.rectangular(**(STRIP | changes))


# Dimensions -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [*NOT_POSITIVE, *NO_NUMBER])
@pytest.mark.parametrize("name", STRIP)
def test_rectangular_needs_positive_numbers(name, value):
    refused(lambda: strip(**{name: value}), name)


@pytest.mark.parametrize("value", NOT_POSITIVE)
@pytest.mark.parametrize("name", STIFFNESS)
def test_stiffness_needs_positive_numbers(name, value):
    refused(lambda: Beam.from_stiffness(**(STIFFNESS | {name: value})), name)


@pytest.mark.parametrize("name", OPTIONAL)
def test_stiffness_may_leave_out(name):
    left = getattr(Beam.from_stiffness(**(STIFFNESS | {name: None})), name)
    assert left == (Profile((0.0, 1.0), ((1e5,),)) if name == "second_shear_stiffness" else None)


@pytest.mark.parametrize("value", [*NOT_FINITE, *NO_NUMBER[1:]])
def test_twist_needs_a_finite_number(value):
    refused(lambda: strip(twist=value), "twist")
    refused(lambda: Beam.from_stiffness(**STIFFNESS, twist=value), "twist")


@pytest.mark.filterwarnings("ignore:twist reaches")
def test_twist_in_degrees_is_named():
    """Hundreds of turns within a segment are not resolved; fewer are only doubted."""
    beam = Beam.from_stiffness(**STIFFNESS, twist=Polynomial([0, 3000.0]))
    words = "twist = 3000 rad at the tip", "varies too quickly", "in degrees? give math.radians"
    refused(lambda: section_tensor(beam, "bending_stiffness"), *words)


def test_twist_needs_a_second_stiffness():
    one = {name: STIFFNESS[name] for name in [*STIFFNESS][:3]}
    for twist in (0.3, Polynomial([0, 0.3]), Table([0, 1], [0.1, 0.3])):
        refused(lambda twist=twist: Beam.from_stiffness(**one, twist=twist), "twist = 0.3 rad", "second_b")


@pytest.mark.parametrize("value", [-1, 0.51, *NOT_FINITE, *NO_NUMBER[1:]])
def test_poissons_ratio(value):
    refused(lambda: strip(poissons_ratio=value), "poissons_ratio")


@given(st.floats(max_value=0) | st.sampled_from(NOT_FINITE), st.sampled_from(sorted(STRIP)))
def test_whatever_is_not_positive_is_refused(value, name):
    refused(lambda: strip(**{name: value}), name)


def test_swapped_width_and_thickness():
    refused(lambda: strip(width=0.0002, thickness=0.01), "thickness = 0.01", "width = 0.0002", "swap")


def test_swapped_thickness_and_length():
    refused(
        lambda: strip(length=0.0002, thickness=0.05, width=0.1),
        "thickness = 0.05",
        "length = 0.0002",
        "swapped",
    )


def test_thicker_than_wide_only_near_the_tip():
    refused(lambda: strip(width=Polynomial([0.01, -0.0099])), "thickness = 0.0002", "width", "swap")


@given(st.floats(1e-6, 1e3), st.floats(1e-6, 1e3))
def test_section_is_accepted_if_and_only_if_flat_and_slender(width, thickness):
    if thickness <= width and thickness <= STRIP["length"]:
        assert strip(width=width, thickness=thickness).outer_fibre is not None
    else:
        refused(lambda: strip(width=width, thickness=thickness), f"thickness = {thickness:g} m: it exceeds")


# Properties along the beam --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("width", "parts"),
    [
        (lambda x: 0.01 - 0.02 * x, ["-0.01", "x/L = 1.000", "positive"]),
        (lambda x: 0.01 * (x - 0.5) ** 2 - 1e-6, ["x/L = 0.5", "positive"]),
        (lambda x: np.where(x > 0.7, np.nan, 0.01), ["nan", "x/L = 0.7", "finite"]),
        (lambda x: np.where(x > 0.7, np.inf, 0.01), ["inf", "x/L = 0.7", "finite"]),
        (lambda x: 0.01, ["shape ()", "vectorised"]),
        (lambda x: [0.01, 0.02], ["shape (2,)", "vectorised"]),
        (lambda x: 0.01 if x < 0.5 else 0.02, ["failed on an array", "take and return arrays"]),
        (lambda x: 0.01 * math.exp(x), ["failed on an array", "take and return arrays"]),
        (lambda x: None, ["width"]),
        (lambda x: "wide", ["failed on an array"]),
        (lambda: 0.01, ["failed on an array"]),
        (lambda x: np.where(x < 0.4, 0.01, 0.02), ["not smooth near x/L = 0.4", "breakpoints"]),
        (lambda x: 0.01 + np.abs(x - 0.3), ["not smooth near x/L = 0.3;", "breakpoints"]),
        (Polynomial([0.01, -0.02]), ["-0.01", "x/L = 1.000", "positive"]),
        (Polynomial([0.01, math.nan]), ["polynomial", "not finite"]),
        (Table([0, 1], [0.01, -0.01]), ["-0.01", "x/L = 1.000", "positive"]),
        (Table([0, 1], [0.01, math.nan]), ["width.values", "nan", "finite"]),
        (Table([0, math.nan, 1], [0.01] * 3), ["width.stations", "nan", "finite"]),
        (Table([0, 1], [0.01]), ["2 stations and 1 values"]),
        (Table([], []), ["0 stations", "at least two"]),
        (Table([0, 0.05], [0.01, 0.01]), ["width.stations[1] = 0.05", "fractions x/L"]),
        (Table([0, 0.6, 0.4, 1], [0.01] * 4), ["ascend"]),
        (Table([[0, 1]], [[0.01, 0.01]]), ["width.stations", "one-dimensional"]),
    ],
)
def test_property_is_refused(width, parts):
    refused(lambda: strip(width=width), "width", *parts)


def test_jump_at_a_breakpoint_is_accepted():
    beam = strip(width=lambda x: np.where(x < 0.4, 0.01, 0.02), breakpoints=(0.4,))
    assert beam.breakpoints == (0, 0.4, 1)


@given(st.floats(0.02, 0.98), st.floats(0.05, 20))
def test_jump_without_a_breakpoint_is_refused(place, ratio):
    def width(x):
        return np.where(x < place, 1.0, 1 + ratio)

    refused(lambda: as_profile("width", width), "width", "not smooth near", "breakpoints")
    assert as_profile("width", width, (place,)).breakpoints == (0, place, 1)


@pytest.mark.parametrize("width", [2.6e-5, 3e-5, 2e-4])
@settings(max_examples=20)
@given(st.floats(1e-3, 1 - 1e-3))
def test_narrow_notch_without_breakpoints_is_refused(width, place):
    """What is wider than the 2.5e-5 of the docstring is seen wherever it stands."""

    def depth(x):
        return np.where(np.abs(x - place) < width / 2, 0.1, 1.0)

    with pytest.raises(ValueError, match="breakpoints") as refusal:
        as_profile("depth", depth)
    found = re.search("not smooth near x/L = ([^;]*)", str(refusal.value))
    assert found and abs(float(found[1]) - place) <= width / 2 + 8e-5  # four digits, a spacing
    ends = place - width / 2, place + width / 2
    assert as_profile("depth", depth, ends).breakpoints == pytest.approx((0, *ends, 1), abs=1e-15)


def test_narrow_bump_is_refused():
    def bump(x):
        return 1 + 1e-3 * np.exp(-(((x - 0.41803) / 1e-4) ** 2))

    refused(lambda: as_profile("height", bump), "height", "not smooth near x/L = 0.418")


@pytest.mark.parametrize("breakpoints", [(0,), (1.0,), (-0.1,), (0.5, 20), (math.nan,), 0.4, "0.4", [[0.4]]])
def test_breakpoints_are_inner_fractions(breakpoints):
    refused(lambda: strip(breakpoints=breakpoints), "breakpoints")


# Tip body -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [-1e-9, *NOT_FINITE, "1 g", [1.0]])
@pytest.mark.parametrize("name", ["mass", "inertia", "transverse_inertia", "axial_inertia"])
def test_tip_refuses(name, value):
    refused(lambda: TipMass(**({"mass": 1.0} | {name: value})), f"tip.{name}")


@pytest.mark.parametrize("value", NOT_FINITE)
def test_tip_offset_is_finite(value):
    refused(lambda: TipMass(1.0, offset=value), "tip.offset", "finite")


def test_tip_inertias_of_no_body():
    refused(
        lambda: TipMass(1.0, inertia=1.0, transverse_inertia=1.0, axial_inertia=2.5),
        "2.5",
        "sum of the other two",
    )


def test_tip_behind_the_root():
    refused(lambda: strip(tip=TipMass(1e-3, offset=-0.06)), "tip.offset = -0.06", "above -0.05")


# Mount and scene ------------------------------------------------------------------------------------


def test_negative_radius_mentions_setting_angle():
    refused(lambda: Mount(radius=-0.215), "radius = -0.215 m", "setting_angle = pi")


@pytest.mark.parametrize("value", [*NOT_FINITE, "215 mm", None])
@pytest.mark.parametrize("name", ["radius", "setting_angle", "bending_angle"])
def test_mount_needs_finite_numbers(name, value):
    refused(lambda: Mount(**{name: value}), name, "finite")


@pytest.mark.filterwarnings("ignore:.*angles are in radians")
@given(st.floats(-1e6, 1e6), st.sampled_from(["setting_angle", "bending_angle"]))
def test_angle_beyond_one_turn_was_in_degrees(value, name):
    if abs(value) <= 2 * math.pi:
        assert getattr(Mount(**{name: value}), name) == value
    else:
        refused(lambda: Mount(**{name: value}), f"{name} = {value:g} rad", f"math.radians({value:g})")


@pytest.mark.parametrize(
    ("value", "part"), [(-0.1, "0 or more"), (1.0, "below 1"), (5, "1 % is"), (math.nan, "finite")]
)
def test_damping_ratio(value, part):
    refused(lambda: Scene(strip(), damping_ratio=value), "damping_ratio", part)


@pytest.mark.parametrize("value", [*NOT_FINITE, "9.81 m/s2"])
def test_gravity_and_speed_are_finite(value):
    refused(lambda: Scene(strip(), gravity=value), "gravity", "m/s2")
    refused(lambda: SteadyRotation(value), "speed", "rad/s")


@pytest.mark.parametrize(
    ("physics", "lacks"),
    [
        ({"stretch": True}, "axial_stiffness"),
        ({"planes": 2}, "second_bending_stiffness"),
        ({"shear": True}, "shear_stiffness"),
        ({"rotary_inertia": True}, "rotary_inertia"),
        ({"planes": 2, "rotary_inertia": True}, "second_rotary_inertia"),
    ],
)
def test_physics_needs_a_property(physics, lacks):
    beam = Beam.from_stiffness(**(STIFFNESS | {lacks: None}))
    refused(lambda: Scene(beam, physics=Physics(**physics)), "physics.", f"it needs {lacks}; give it to Beam")
    assert Scene(beam).physics == Physics()


@pytest.mark.parametrize("value", [0, 3, 1.5, True, "2", None])
def test_planes_are_one_or_two(value):
    refused(lambda: Physics(planes=value), "physics.planes", "from 1 to 2")


@pytest.mark.parametrize("value", [-1e-9, -math.inf, math.nan, "inf", None, True])
@pytest.mark.parametrize("name", ["root_stiffness", "second_root_stiffness"])
def test_a_root_spring_pushes_back(name, value):
    allowed = "give a number of 0 or more, or inf; 0 is a hinge; left out, the root is clamped"
    refused(lambda: Mount(**{name: value}), f"{name} = ", allowed)


# Twist ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("build", [strip, lambda **twist: Beam.from_stiffness(**STIFFNESS, **twist)])
@pytest.mark.parametrize(
    ("twist", "largest"),
    [(30, 30), (-4.5, -4.5), (Table([0, 1], [0, -8]), -8), (Polynomial([13.0, -13.0]), 13)],
)
def test_twist_in_degrees_is_doubted(build, twist, largest):
    said = rf"twist reaches {largest} rad: .* if {largest} degrees were meant, give math.radians\({largest}\)"
    with pytest.warns(UserWarning, match=said) as caught:
        build(twist=twist)
    assert [warned.filename for warned in caught] == [__file__]  # at the call


@pytest.mark.parametrize("twist", [3.0, 1.5 * math.pi, -2 * math.pi, Polynomial([0.1, 2.0])])
def test_twist_in_radians_is_not_doubted(twist):
    strip(twist=twist)  # a warning fails the test


@pytest.mark.parametrize("stiffness", [1e17, 1e50, 1e200])
@pytest.mark.parametrize(("name", "planes"), [("root_stiffness", 1), ("second_root_stiffness", 2)])
def test_a_spring_that_rounding_does_not_tell_from_a_clamp(name, planes, stiffness):
    mount, physics = Mount(**{name: stiffness}), Physics(planes)
    beam = Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=2.0)
    says = f"mount.{name} = ", "at most 2e+16" if planes == 2 else "at most 1e+16", "leave it out"
    refused(lambda: Scene(beam, mount, physics=physics), *says)


def test_springs_of_a_plane_that_is_not_modelled_may_be_of_any_stiffness():
    Scene(Beam.from_stiffness(1.0, 1.0, 1.0), Mount(second_root_stiffness=1e50))
    Scene(Beam.from_stiffness(1.0, 1.0, 1.0), Mount(root_stiffness=0.9e16, second_root_stiffness=0.0))


# Known gaps: the mark goes when the core refuses these ----------------------------------------------


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"length": 10**400}, "length"),
        ({"breakpoints": [10**400]}, "breakpoints"),
        ({"width": 10**400}, "width"),
        ({"width": "0.01"}, "width"),
        ({"width": lambda x: 1 / 0}, "width"),
        ({"width": lambda x: x.breadth}, "width"),
        ({"width": lambda x: 0.01 + 1j * x}, "width"),
        ({"width": lambda x: np.where(x < 0.002, 0.02, 0.01)}, "width"),
        ({"width": Polynomial([0.01 + 1j])}, "width"),
        ({"width": Table([0, 0, 1], [0.02, 0.01, 0.01])}, "width"),
        ({"width": Table([0, 0.5, 0.5, 0.5, 1], [0.01, 0.01, 7, 0.01, 0.01])}, "width"),
        ({"width": 1e200}, "width"),
        ({"thickness": 1e-120}, "thickness"),
        ({"tip": 0.001}, "tip"),
    ],
)
def test_gap_in_beam(changes, name):
    refused(lambda: strip(**changes), name)


@pytest.mark.parametrize("changes", [{"beam": None}, {"mount": 0.215}, {"motion": 55.0}, {"physics": "no"}])
def test_gap_in_scene(changes):
    refused(lambda: Scene(**({"beam": strip()} | changes)), *changes)


@pytest.mark.parametrize("width", [0.2, 0.1, 0.05])
def test_a_smooth_bump_is_resolved_to_rounding(width):
    xi = np.linspace(0, 1, 1001)
    exact = 1 + 0.5 * np.exp(-(((xi - 0.3123) / width) ** 2))
    profile = as_profile("width", lambda x: 1 + 0.5 * np.exp(-(((x - 0.3123) / width) ** 2)))
    np.testing.assert_allclose(profile(xi), exact, rtol=1e-14)


@pytest.mark.parametrize("polynomial", [(1, -1), (1, -0.3, -0.7), (1, -2, 1), (1, -3, 3, -1)])
def test_a_taper_to_a_point_is_refused_whatever_rounding_makes_of_its_end(polynomial: tuple[float, ...]):
    """Its stiffness is zero there; where that came out as 1e-19 it was taken before."""
    said = set()
    for change in (0.0, 1e-13, -1e-13, 1e-16):
        thickness = Polynomial(np.array(polynomial) + change * (np.arange(len(polynomial)) == 1))
        with pytest.raises(ValueError, match="less than 8e-05 of the largest") as refused:
            Beam.rectangular(1.0, 0.1, 0.01 * thickness, 200e9, 7850.0)
        said.add(str(refused.value))
        with pytest.raises(ValueError, match="less than 5e-13 of the largest"):
            Beam.from_stiffness(1.0, 1.0, thickness)
    assert len(said) == 1 and said.pop().startswith("thickness = 0 at x/L = 1.000")
    Beam.rectangular(1.0, 0.1, 0.01 * Polynomial(polynomial) + 1e-6, 200e9, 7850.0)


def test_elements_refuse_a_segment_too_short_for_their_digits():
    def frequencies(length, discretization="fem"):
        width = Table([0.0, 0.5, 0.5 + length, 1.0], [0.04, 0.04, 0.02, 0.02])
        beam = Beam.rectangular(1.0, width, 0.005, 210e9, 7850.0)
        return natural_modes(Scene(beam), discretization=discretization).frequency

    with pytest.raises(ValueError, match=r"at least 1e-5 of the length.*discretization='ritz'"):
        frequencies(1e-6)
    assert frequencies(1e-3) == pytest.approx(frequencies(1e-3, "ritz"), rel=4e-6)  # stated


@pytest.mark.parametrize(
    "place, factor", [((3, 3), 1 + 1e-2), ((3, 3), 1 - 1e-2), ((4, 4), 1.1), ((3, 4), 0.01), ((3, 5), 0.01)]
)
def test_a_mass_matrix_of_no_flat_section_is_refused(place, factor):
    """About its axis a flat section has the sum of the other moments of inertia, whatever its centre."""
    centre, stiffness = np.array([0.0, 0.02, -0.03]), np.diag([1e9, 1e8, 1e8, 1e6, 4e6, 1e6])
    lever = np.cross(np.eye(3), centre)  # rows: acceleration of the centre by turning about each axis
    mass = 100.0 * np.block([[np.eye(3), lever.T], [lever, lever @ lever.T]])
    mass[3:, 3:] += np.diag([3.0, 1.0, 2.0])
    SectionMatrices.at_stations([0.0, 1.0], [stiffness] * 2, [mass] * 2)
    mass[place] = mass[place[::-1]] = mass[place] * factor if place[0] == place[1] else factor
    with pytest.raises(
        ValueError, match=r"matrices\.mass = .* at x/L = 0: .*(0\.0001|0\.005) of its size.*M44 = M55 \+ M66"
    ):
        SectionMatrices.at_stations([0.0, 1.0], [stiffness] * 2, [mass] * 2)
