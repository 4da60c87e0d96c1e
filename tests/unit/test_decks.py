"""Blades of other programs: what is read, in which sense, what is said of the rest, and what is refused."""

import math
import re

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.files.decks.audit import fit_mode_polynomials
from tests.unit import decks_written as written

FILES = {
    "blade.dat": written.elastodyn_blade,
    "sections.dat": written.bmodes_sections,
    "main.bmi": written.bmodes_main,
    "blade.csv": lambda: written.CSV,
}
GIVEN = {"length": written.LENGTH, "hub_radius": written.HUB}


@pytest.fixture
def folder(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).write_text(text())
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "blade.dat").write_text(written.elastodyn_blade())
    (tmp_path / "main.dat").write_text(written.elastodyn_main())
    (tmp_path / "all.fst").write_text('OpenFAST\n"main.dat"  EDFile - Name of the file\n')
    return tmp_path


def values(profile):
    """Values at the stations, from the left at the tip."""
    left, right = profile.end_values()
    return np.append(left, right[-1])


def check_blade(beam, edge=written.EDGE, mass=written.MASS):
    """The blade of the tests; converted in decimal, to 1e-12."""
    assert beam.length == pytest.approx(40.0, rel=1e-14)
    assert beam.breakpoints == pytest.approx(written.STATIONS, rel=1e-14)
    for profile, wanted in (
        (beam.mass_per_length, mass),
        (beam.bending_stiffness, written.FLAP),
        (beam.second_bending_stiffness, edge),
        (beam.twist, -np.radians(written.TWIST)),
    ):
        np.testing.assert_allclose(values(profile), wanted, rtol=1e-12, atol=1e-15)


ADJUSTED = {"edge": 0.5 * np.array(written.EDGE), "mass": 1.1 * np.array(written.MASS)}


def test_elastodyn_blade_file(folder):
    deck = bd.read_deck(folder / "blade.dat", **GIVEN)
    check_blade(deck.scene.beam, **ADJUSTED)
    assert deck.scene.mount == bd.Mount(1.25, math.pi, math.pi / 2)
    assert deck.scene.physics == bd.Physics(planes=2)
    assert (deck.kind, deck.title) == ("ElastoDyn blade file", "A blade of the tests")
    assert deck.scene.damping_ratio == 0


@pytest.mark.parametrize("name", ["main.dat", "all.fst"])
def test_main_file_brings_hub_tip_pitch_and_speed(folder, name):
    deck = bd.read_deck(folder / name)
    check_blade(deck.scene.beam, **ADJUSTED)
    assert deck.scene.beam.tip == bd.TipMass(30.0)
    assert deck.scene.mount.radius == 1.25
    assert math.degrees(deck.scene.mount.bending_angle) == pytest.approx(86.0, rel=1e-14)
    assert deck.scene.motion == bd.SteadyRotation(18 * math.pi / 30)
    assert math.degrees(deck.scene.mount.precone) == pytest.approx(2.5, rel=1e-14)  # upwind is towards b3
    assert [path.rpartition("/")[2] for path in deck.sources][-2:] == ["main.dat", "blade.dat"]


def test_blades_that_the_turbine_computes_otherwise_are_named(folder):
    (folder / "all.fst").write_text('2 CompElast - which\n"main.dat"  EDFile - Name of the file\n')
    assert "CompElast" in [entry.name for entry in bd.read_deck(folder / "all.fst").ignored]
    (folder / "all.fst").write_text('1 CompElast - which\n"main.dat"  EDFile - Name of the file\n')
    assert "CompElast" not in [entry.name for entry in bd.read_deck(folder / "all.fst").ignored]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"PreCone(1)": 90}, "line 6: expected PreCone(1) below 90 deg either way, found '90'"),
        ({"HubRad": 50}, "line 5: expected HubRad of 0 or more and below TipRad = 41.25, found '50'"),
        ({"TipMass(1)": -1}, "line 8: expected TipMass(1) of 0 or more, found '-1'"),
        ({"TipMass(1)": "1e400"}, "line 8: expected a number for TipMass(1), found '1e400'"),
    ],
)
def test_a_bad_main_file_is_refused_by_line(folder, changes, said):
    (folder / "main.dat").write_text(written.elastodyn_main(**changes))
    with pytest.raises(bd.ConfigError) as refused:
        bd.read_deck(folder / "main.dat")
    assert said in str(refused.value)


def test_bmodes_main_file(folder):
    deck = bd.read_deck(folder / "main.bmi")
    check_blade(deck.scene.beam)
    assert deck.scene.beam.tip == bd.TipMass(20.0, 0.3, 3.0, 4.0, 2.0, offset_across=-0.05)
    assert deck.scene.motion == bd.SteadyRotation(9 * math.pi / 30)
    inertia = values(deck.scene.beam.second_rotary_inertia)
    np.testing.assert_allclose(inertia, 0.4 * np.array(written.MASS), rtol=1e-12)
    assert not deck.ignored and deck.scene.physics == bd.Physics(planes=2, torsion=True)
    np.testing.assert_allclose(values(deck.scene.beam.torsion_stiffness), 0.1 * np.array(written.FLAP))
    np.testing.assert_allclose(values(deck.scene.beam.mass_offset), -0.1)  # towards the trailing edge
    assert deck.scene.beam.tension_offset is None  # 0 throughout


def with_offsets(rows):
    """Section properties with other offsets, from the reference axis, of cg, sc and tc at each station."""
    head, note = written.bmodes_sections().split("\n\n**")
    lines = head.split("\n")
    lines[5:] = [
        " ".join([*line.split()[:-3], *row.split()]) for line, row in zip(lines[5:], rows, strict=True)
    ]
    return "\n".join([*lines, "", f"**{note}"])


def test_offsets_of_bmodes_are_from_the_shear_centre(folder):
    (folder / "sections.dat").write_text(with_offsets(["0.1 0.03 -0.02"] * 5))
    beam = bd.read_deck(folder / "main.bmi").scene.beam
    np.testing.assert_allclose(values(beam.mass_offset), -0.07, rtol=1e-12)  # but for rounding
    np.testing.assert_allclose(values(beam.tension_offset), 0.05, rtol=1e-12)
    assert beam.tip.offset_across == pytest.approx(0.03 - 0.05, rel=1e-12)
    about = np.array(written.EDGE) - 1e7 * np.array(written.MASS) * 0.05**2
    np.testing.assert_allclose(values(beam.second_bending_stiffness), about, rtol=1e-12)


def test_a_centre_of_tension_too_far_off_is_refused_by_station(folder):
    """The stiffness of such a section is not positive definite."""
    (folder / "sections.dat").write_text(with_offsets(["0 0 0"] * 3 + ["0 0 0.5", "0 0 0"]))
    said = r"line 9: expected edge_stff above axial_stff \(tc_offst - sc_offst\)\^2 = 1\.5e\+08 Nm\^2"
    with pytest.raises(bd.ConfigError, match=said):
        bd.read_deck(folder / "main.bmi")


def test_offsets_without_torsion_are_named(folder):
    text = with_offsets(["0.1 0 0"] * 5).split("\n")
    cells = text[7].split()
    text[7] = " ".join([*cells[:8], "0.0", *cells[9:]])  # tor_stff
    (folder / "sections.dat").write_text("\n".join(text))
    deck = bd.read_deck(folder / "main.bmi")
    assert deck.scene.physics == bd.Physics(planes=2) and not deck.scene.beam.has_offsets
    assert {entry.name for entry in deck.ignored} == {"tor_stff", "cg_offst", "cm_loc"}


def test_multipliers_of_bmodes(folder):
    (folder / "main.bmi").write_text(written.bmodes_main(**{"edge_stff_mult:": 2.0, "sec_mass_mult:": 3.0}))
    beam = bd.read_deck(folder / "main.bmi").scene.beam
    check_blade(beam, 2 * np.array(written.EDGE), 3 * np.array(written.MASS))


def test_section_properties_alone_with_the_older_first_head(folder):
    (folder / "s.dat").write_text(written.bmodes_sections(first="span_loc"))
    check_blade(bd.read_deck(folder / "s.dat", **GIVEN).scene.beam)


def test_a_tip_body_that_cannot_be_is_named(folder):
    """As in the second test of BModes itself: 10, 1.75 and 2.5 kg m2."""
    (folder / "main.bmi").write_text(written.bmodes_main(ixx_tip=10.0, iyy_tip=1.75, izz_tip=2.5))
    deck = bd.read_deck(folder / "main.bmi")
    assert deck.scene.beam.tip == bd.TipMass(20.0, 0.3, offset_across=-0.05)
    assert "no rigid body has such moments" in " ".join(entry.sentence() for entry in deck.ignored)


def test_csv_in_mixed_units(folder):
    deck = bd.read_deck(folder / "blade.csv")
    check_blade(deck.scene.beam, **ADJUSTED)
    assert deck.scene.mount.radius == pytest.approx(1.25, rel=1e-13)
    assert [entry.sentence() for entry in deck.ignored] == ["chord (0.5 to 4 m): no property of a beam"]


@pytest.mark.parametrize("mark", "#!")
def test_comments_of_a_csv_stand_anywhere(folder, mark):
    lines = written.CSV.splitlines()[1:]
    (folder / "blade.csv").write_text("\n".join([f"{mark} head", lines[0], f" {mark} below", *lines[1:]]))
    check_blade(bd.read_deck(folder / "blade.csv").scene.beam, **ADJUSTED)


def test_structural_twist_of_a_csv_has_the_other_sense(folder):
    text = written.CSV.replace("twist [deg]", "StrcTwst [deg]").replace("-", "")
    (folder / "blade.csv").write_text(text)
    check_blade(bd.read_deck(folder / "blade.csv").scene.beam, **ADJUSTED)


def test_columns_of_fast_7_that_nobody_uses_are_named(folder):
    more = ("GJStff", "FlpIner", "PrecrvRef", "Whatever")
    text = written.elastodyn_blade(
        heads=(*written.HEADS, *more),
        units=(*written.UNITS, "(Nm^2)", "(kg m)", "(m)", "(-)"),
        rows=[f"{row} {1e6 * (k + 1)} 0.5 {0.1 * k} 0.0" for k, row in enumerate(written.rows())],
    )
    (folder / "blade.dat").write_text(text.replace("A blade", "False  CalcBMode - ignored\nA blade"))
    said = {e.name: e.values for e in bd.read_deck(folder / "blade.dat", **GIVEN).ignored}
    assert said == {
        "BldFlDmp(1), BldFlDmp(2), BldEdDmp(1)": "0.5 %",
        "PitchAxis": "0.25",
        "GJStff": "1e+06 to 5e+06 Nm^2",
        "FlpIner": "0.5 kg m",
        "PrecrvRef": "0 to 0.4 m",
    }


# Sense of the twist -------------------------------------------------------------------------------


def test_the_soft_direction_is_that_of_elastodyn(folder):
    """A blade as soft as a ruler in flap, twisted by 30 deg all along: it bends along Lj1 = cos x - sin y.

    x is downwind, y to the trailing edge: here -b3 and b2, and e1 = b3, e2 = -b2.
    """
    row = " 0.25 30.0 100.0 1.0E6 1.0E12"
    (folder / "b.dat").write_text(written.elastodyn_blade(count=2, rows=["0.0" + row, "1.0" + row]))
    modes = bd.natural_modes(
        bd.read_deck(folder / "b.dat", **GIVEN).scene, modes=1, discretization=bd.Ritz(8)
    )
    downwind, trailing = -modes.tip[0], -modes.tip_across[0]
    assert trailing / downwind == pytest.approx(-math.tan(math.radians(30)), rel=1e-4)  # EI ratio 2e-6


# The scene file -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["main.dat", "main.bmi", "blade.csv"])
def test_the_scene_file_is_the_scene(folder, name):
    deck = bd.read_deck(folder / name)
    deck.write_scene(folder / "scene.toml")
    assert bd.load_scene(folder / "scene.toml") == deck.scene
    with pytest.raises(FileExistsError):
        deck.write_scene(folder / "scene.toml")


def test_the_scene_file_is_readable(folder):
    text = bd.read_deck(folder / "main.dat").scene_text()
    lines = text.splitlines()
    assert 'precone = "2.5 deg"' in text
    start = lines.index("stations = [")
    table = lines[start + 1 : start + 7]
    assert table[0].split('"')[1::2][:3] == ["x/L", "twist [deg]", "mass_per_length [kg/m]"]
    assert len({line.index(",") for line in table}) <= 4  # the columns begin at the same places
    assert len({len(re.split(r",\s+", line)) for line in table}) == 1
    assert 'speed = "18 rpm"' in text and "planes = 2" in text
    assert not [line for line in lines if line != line.rstrip()]


def test_the_command_audits_writes_and_the_scene_runs(folder, run):
    scene = folder / "scene.toml"
    code, out, err = run("import", folder / "main.dat", "-o", scene)
    assert code == 0
    for part in ("mass", "Ignored", "damping", "flap 2", "sum of coefficients", "steep"):
        assert part in out
    assert "warning: the deck's shape of flap 1" in err
    code, out, _ = run("modes", scene, "--tolerance", "1e-4", "--modes", "2")
    assert code == 0 and "at 18 rpm" in out  # the speed of the deck, in its unit
    code, _, err = run("import", folder / "main.dat", "-o", folder / "sub" / "blade.dat", "--force")
    assert code == 2 and "the command itself needs" in err


def test_length_and_hub_are_asked_for_by_option(folder, run):
    code, _, err = run("import", folder / "blade.dat", "--length", "40 m")
    assert code == 2 and "hub_radius: missing" in err and "main file" in err and "--hub-radius" in err
    code, _, err = run("import", folder / "main.dat", "--length", "40 m")
    assert code == 2 and "--length" in err and "leave it out" in err


# The audit ----------------------------------------------------------------------------------------


def test_moments_of_mass_are_the_integrals(folder):
    """Second route: piecewise cubics integrated exactly by Simpson's rule on each segment."""
    audit = bd.read_deck(folder / "sections.dat", **GIVEN).audit
    x, m = 40 * np.array(written.STATIONS), np.array(written.MASS)

    def integral(power):
        middle, mean = (x[1:] + x[:-1]) / 2, (m[1:] + m[:-1]) / 2
        ends = m * x**power
        return (np.diff(x) / 6 * (ends[:-1] + 4 * mean * middle**power + ends[1:])).sum()

    wanted = [integral(power) for power in range(3)]
    found = [audit.mass, audit.first_moment, audit.second_moment]
    assert found == pytest.approx(wanted, rel=1e-12)
    assert audit.hub_second_moment == pytest.approx(
        wanted[2] + 2.5 * wanted[1] + 1.5625 * wanted[0], rel=1e-12
    )
    assert audit.centre == pytest.approx(wanted[1] / wanted[0], rel=1e-12)
    assert audit.shapes == ()


def test_steps_are_named(folder):
    audit = bd.read_deck(folder / "sections.dat", **GIVEN).audit
    assert {(s.name, s.start) for s in audit.steps} >= {("mass", 0.8), ("flap stiffness", 0.5)}
    assert audit.steps[-1].end == 1.0
    said = [step.sentence() for step in audit.steps]
    assert "mass falls by a factor of 5 from x/L = 0.8 to 1, 0.2 of the length" in said


def test_a_polynomial_that_is_the_mode_agrees_and_another_does_not(folder):
    """A uniform beam's first shape, fitted to powers 2 to 6; and coefficients whose sum is not 1."""
    x = np.linspace(0, 1, 201)
    k, s = 1.8751040687119611, 0.7340955137589128
    shape = np.cosh(k * x) - np.cos(k * x) - s * (np.sinh(k * x) - np.sin(k * x))
    powers = x[:, None] ** np.arange(2, 7)
    fit = np.linalg.lstsq(powers, shape / shape[-1], rcond=None)[0]
    row = " 0.25 0.0 100.0 1.0E8 1.0E8"
    text = written.elastodyn_blade(count=2, rows=["0.0" + row, "1.0" + row])
    for power, value in enumerate(fit / fit.sum(), 2):
        text = re.sub(rf"\S+(?=  BldFl1Sh\({power}\))", f"{value:.12E}", text)
    text = re.sub(r"\S+(?=  BldEdgSh\(2\))", "0.9", text)
    (folder / "b.dat").write_text(text)
    flap, _, edge = bd.read_deck(folder / "b.dat", length=40.0, hub_radius=0.0).audit.shapes
    assert flap.difference < 1e-5  # the fit is good to 3e-6
    assert flap.frequency == pytest.approx(k**2 * math.sqrt(1e8 / 110) / 1600 / (2 * math.pi), rel=1e-6)
    assert edge.coefficient_sum == pytest.approx(1.4, rel=1e-12)
    warnings = bd.read_deck(folder / "b.dat", length=40.0, hub_radius=0.0).audit.warnings
    assert any("edge 1 add up to 1.4" in each for each in warnings)


def test_fitted_polynomials_are_those_of_the_closed_form():
    """Of a uniform beam: the best fit of cosh - cos - s (sinh - sin), to the six digits that are written."""
    scene = bd.Scene(
        bd.Beam.from_stiffness(40.0, 100.0, 1e8, second_bending_stiffness=4e8), bd.Mount(1.0, math.pi)
    )
    x, powers = np.linspace(0, 1, 401), np.arange(2, 7)
    flap, second, edge = fit_mode_polynomials(scene, 0.0)
    for fitted, k in ((flap, 1.8751040687), (second, 4.6940911330), (edge, 1.8751040687)):
        s = (math.cosh(k) + math.cos(k)) / (math.sinh(k) + math.sin(k))
        shape = np.cosh(k * x) - np.cos(k * x) - s * (np.sinh(k * x) - np.sin(k * x))
        shape /= shape[-1]
        assert sum(fitted.coefficients) == pytest.approx(1.0, abs=1e-12)
        apart = x[:, None] ** powers @ fitted.coefficients - shape
        assert np.abs(apart).max() == pytest.approx(fitted.difference, abs=1e-9)
        for other in powers[:-1]:  # of least squares: no neighbour that is 1 at the tip is closer
            slope = apart @ (x**other - x**6) / 401
            assert abs(slope) < 1e-6  # coefficients are rounded to 1e-6
    assert edge.frequency == pytest.approx(2 * flap.frequency, rel=1e-9)


def test_written_polynomials_are_read_back_and_audited(folder, run):
    path = folder / "shapes.dat"
    code, out, _ = run("import", folder / "main.dat", "--polynomials", path, "--speed", "18 rpm")
    assert code == 0 and "largest difference" in out
    blade = (folder / "sub" / "blade.dat").read_text()
    kept = blade[: blade.index("--------- BLADE MODE SHAPES")]
    (folder / "sub" / "blade.dat").write_text(kept + "--- SHAPES ---\n" + path.read_text())
    deck = bd.read_deck(folder / "main.dat")
    fitted = deck.fit_mode_polynomials()
    assert [each.mode for each in deck.audit.shapes] == [each.mode for each in fitted]
    for stated, made in zip(deck.audit.shapes, fitted, strict=True):
        assert stated.coefficient_sum == pytest.approx(1.0, abs=1e-12)
        assert stated.difference == pytest.approx(made.difference, abs=1e-9)
    code, _, err = run("import", folder / "main.dat", "--speed", "18 rpm")
    assert code == 2 and "--polynomials" in err


# What is refused ----------------------------------------------------------------------------------

ROWS = written.rows()
FIRST = 17  # line of the first station of the blade file


def swapped(k, row):
    return [*ROWS[:k], row, *ROWS[k + 1 :]]


BAD_BLADES = {
    "missing column": ({"heads": written.HEADS[:-1], "units": written.UNITS[:-1]}, 15, "a column EdgStff"),
    "descending": ({"rows": [ROWS[0], ROWS[2], ROWS[1], *ROWS[3:]]}, 19, "0.2 follows 0.5 of line 18"),
    "repeated": ({"rows": [*ROWS[:2], ROWS[1], *ROWS[3:]]}, 19, "repeats the station of line 18"),
    "too few rows": ({"count": 6}, 22, "expected row 6 of the stations"),
    "too many rows": ({"count": 4}, 21, "after the last of 4 stations"),
    "count no whole number": ({"count": "4.5"}, 4, "a whole number of 2 or more for NBlInpSt"),
    "other unit": ({"units": (*written.UNITS[:-1], "(kNm^2)")}, 16, "(Nm^2) for EdgStff, found (kNm^2)"),
    "no units": ({"units": (ROWS[0],)}, 16, "units of the columns in brackets"),
    "a unit too few": ({"units": written.UNITS[1:]}, 16, "6 units for the headings above, found 5"),
    "minus sign of a word processor": (
        {"rows": swapped(1, ROWS[1].replace("1.100000E+01", "−1.1E+01"))}, 18, "U+2212 (minus sign)",
    ),
    "letter for a digit": ({"rows": swapped(2, "O.5 0.25 5 180 2e8 9e8")}, 19, "for BlFract, found 'O.5'"),
    "a cell too few": ({"rows": swapped(3, "0.8 0.25 1.5 60 1.5e7")}, 20, "6 numbers under the headings"),
    "decimal commas": ({"rows": swapped(3, "0,8 0,25 1,5 60 1,5e7 1e8")}, 20, "write decimal points"),
    "no stiffness": ({"rows": swapped(4, "1.0 0.25 0 12 0.0 6e6")}, 21, "FlpStff above 0, found 0 Nm^2"),
    "not to the tip": ({"rows": swapped(4, "0.99 0.25 0 12 2e5 6e6")}, 21, "BlFract = 1, the tip"),
    "not a number": ({"rows": swapped(4, "1.0 0.25 0 nan 2e5 6e6")}, 21, "give a finite one"),
    "twice a head": ({"heads": (*written.HEADS[:-1], "FlpStff")}, 15, "FlpStff stands twice"),
    "factor": ({"mass_factor": 0}, 11, "AdjBlMs above 0"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD_BLADES)
def test_a_bad_blade_file_is_refused_by_line(folder, case):
    changes, line, said = BAD_BLADES[case]
    (folder / "blade.dat").write_text(written.elastodyn_blade(**changes), encoding="utf-8")
    with pytest.raises(bd.ConfigError) as refused:
        bd.read_deck(folder / "blade.dat", **GIVEN)
    assert f"blade.dat: line {line}: " in str(refused.value)
    assert said in str(refused.value)


def test_a_file_cut_off_anywhere_is_refused(folder):
    lines = written.elastodyn_blade().splitlines()
    for count in range(4, len(lines)):
        (folder / "blade.dat").write_text("\n".join(lines[:count]))
        with pytest.raises(bd.ConfigError, match=rf"line {count}: .*(ends here|expected)"):
            bd.read_deck(folder / "blade.dat", **GIVEN)


def test_comments_tabs_and_other_encodings_are_read(folder):
    text = written.elastodyn_blade(rows=[row.replace(" ", "\t") + "  ! tapér" for row in ROWS])
    (folder / "blade.dat").write_bytes(text.replace("A blade", "A bläde °").encode("latin-1"))
    deck = bd.read_deck(folder / "blade.dat", **GIVEN)
    check_blade(deck.scene.beam, **ADJUSTED)
    assert deck.title == "A bläde ° of the tests"


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_an_ellipsis_of_windows_ends_no_line(folder, end):
    """Its byte 0x85 is a line's end in Latin-1, and what follows it would be a row of its own."""
    text = written.elastodyn_blade(rows=[f"{row} ! as measured\x85 5 6 7" for row in ROWS])
    (folder / "blade.dat").write_bytes(text.replace("\n", end).encode("latin-1"))
    check_blade(bd.read_deck(folder / "blade.dat", **GIVEN).scene.beam, **ADJUSTED)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"beam_type": 2}, "beam_type = 1, a blade"),
        ({"hub_conn:": 2}, "hub_conn = 1, a cantilever"),
        ({"radius:": 1.0}, "radius above hub_rad = 1.25"),
        ({"sec_props_file": "'none.dat'"}, "expected the file sec_props_file, but there is none"),
        ({"tip_mass": "heavy"}, "a number for tip_mass, found 'heavy'"),
        ({"precone:": ""}, "a value before precone"),
        ({"flp_stff_mult:": -1.0}, "flp_stff_mult above 0"),
        ({"precone:": -91}, "precone below 90 deg either way, found '-91'"),
        ({"tip_mass": "1e60"}, "a number up to 1e+50 for tip_mass"),
    ],
)
def test_a_bad_main_file_of_bmodes_is_refused_by_line(folder, changes, said):
    (folder / "main.bmi").write_text(written.bmodes_main(**changes))
    with pytest.raises(bd.ConfigError, match=r"main.bmi: line \d+: ") as refused:
        bd.read_deck(folder / "main.bmi")
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("old", "new", "line", "said"),
    [
        ("mass [kg/m]", "mass [stone/furlong/min]", 2, "a unit like [kg/m] for mass"),
        ("mass [kg/m]", "mass [bushels]", 2, "found [bushels]"),
        ("mass [kg/m]", "mass [kg]", 2, "a unit of mass where mass per length is wanted"),
        ("mass [kg/m]", "mass", 2, "a unit like [kg/m] for mass, found none"),
        ("mass [kg/m]", "weight [kg/m]", 2, "expected a column mass [kg/m]"),
        ("mass [kg/m]", "twist [rad]", 2, "is the same column"),
        ("mass [kg/m]", "masss [kg/m]", 2, "did you mean mass"),
        ("r [ft]", "chord2 [ft]", 2, "one column of positions, x/L, x [m] or r [m]"),
        ("330;", "330 kg/m;", 5, "a number for mass [kg/m], found '330 kg/m'"),
        ("330;", "-330;", 5, "must be greater than 0"),
        ("330;", "330,5;", 5, "write a decimal point"),
        ("330; 1500;", "330;", 5, "expected 6 cells under the headings, found 5"),
        ("330; 1500;", "330; 15; 00;", 5, "found 7; are there decimal commas?"),
        ("; mass [kg/m]", " | mass [kg/m]", 2, "separate columns by commas, semicolons or tabs"),
        ("69.7178477690289", "20", 6, "follows"),
        (written.CSV_ROWS[2], written.CSV_ROWS[1], 6, "it repeats line 5"),
        ("109.0879265091864", "135.3346456692913", 8, "expected it twice only between other positions"),
    ],
)  # fmt: skip
def test_a_bad_csv_table_is_refused_by_line(folder, old, new, line, said):
    assert old in written.CSV
    (folder / "blade.csv").write_text(written.CSV.replace(old, new))
    with pytest.raises(bd.ConfigError) as refused:
        bd.read_deck(folder / "blade.csv")
    assert f"blade.csv: line {line}: " in str(refused.value)
    assert said in str(refused.value)


@pytest.mark.parametrize("content", [b"", b"\n\n", b"PK\x03\x04\0\0", b"[beam]\nlength = 3\n"])
def test_what_is_no_deck_is_refused(folder, content):
    (folder / "thing").write_bytes(content)
    with pytest.raises(bd.ConfigError, match=r"thing: .*(empty|no text|none of the files)"):
        bd.read_deck(folder / "thing")
    with pytest.raises(bd.ConfigError, match="there is no such file"):
        bd.read_deck(folder / "parsnips")


# CSV files named by a scene -----------------------------------------------------------------------

SCENE = '[beam]\nlength = "40 m"\nstations = "s.csv"\n[mount]\nradius = "1 m"\nsetting_angle = "180 deg"\n'
ROWED = 'stations = [["x", 3]]'


def test_a_scene_names_a_csv_file_beside_it(folder, monkeypatch):
    (folder / "s.csv").write_text(
        "x [m],mass [kg/m],EI [kN m2]\n0,20,3000\n10,20,3000\n10,10,1500\n40,5,1000\n"
    )
    (folder / "scene.toml").write_text(SCENE)
    monkeypatch.chdir("/")
    beam = bd.load_scene(folder / "scene.toml").beam
    table = bd.Table([0, 0.25, 0.25, 1], [20, 20, 10, 5])
    assert beam == bd.Beam.from_stiffness(40.0, table, bd.Table(table.stations, [3e6, 3e6, 1.5e6, 1e6]))


def test_mistakes_in_a_named_csv_file_are_of_its_lines(folder):
    (folder / "scene.toml").write_text(SCENE)
    for text, said in (
        ("x [m],mass [kg/m],EI [N m2]\n0,20,3000\n20,20,x\n", "s.csv: line 3: expected a number for EI"),
        (
            "x [m],mass [kg/m],EI [N m2],chord [m]\n0,20,1,1\n40,1,1,1\n",
            "s.csv: line 1: unknown column 'chord'",
        ),
        ("r [m],mass [kg/m],EI [N m2]\n1,20,1\n41,1,1\n", "s.csv: line 1: expected one column of positions"),
    ):
        (folder / "s.csv").write_text(text)
        with pytest.raises(bd.ConfigError) as refused:
            bd.load_scene(folder / "scene.toml")
        assert said in str(refused.value)


def test_a_named_csv_file_is_an_input_that_no_output_replaces(folder, run):
    (folder / "s.csv").write_text("x [m],mass [kg/m],EI [N m2]\n0,20,3000\n40,20,3000\n")
    (folder / "scene.toml").write_text(SCENE)
    code, _, err = run("modes", folder / "scene.toml", "--csv", folder / "s.csv", "--force")
    assert code == 2 and "the command itself needs" in err
    assert (folder / "s.csv").read_text().startswith("x [m]")


def test_the_example_in_csv_is_a_scene():
    scene = bd.load_scene("examples/blade_of_stations.toml")
    deck = bd.read_deck("examples/blade_stations.csv", 40.0, 1.25)
    assert scene.beam == deck.scene.beam
    assert scene.mount == deck.scene.mount
