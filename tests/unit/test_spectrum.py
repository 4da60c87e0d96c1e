"""Natural modes and loci: what they report, how modes are followed, and bad input."""

from __future__ import annotations

import math
import re
import warnings
from dataclasses import replace
from io import StringIO

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from rich.console import Console

import beamdyn as bd
from beamdyn.common.edge.views import rows_of, tables_of
from beamdyn.common.inputs.checks import InvalidValue
from benchmarks.cases.scenes import HARVESTER

COUPLED = bd.Scene(
    bd.Beam.from_stiffness(1.0, 1.0, 1.0, axial_stiffness=20.0**2),
    bd.Mount(0.5, np.pi, np.pi / 2 - 0.02),
    physics=bd.Physics(stretch=True),
)


def test_unstable_mode_has_a_growth_rate_and_no_frequency() -> None:
    modes = bd.natural_modes(HARVESTER, 170.0)
    assert math.isnan(modes.frequency[0]) and modes.growth_rate[0] > 0
    assert modes.status.tolist() == ["divergence", "stable", "stable"]
    assert "unstable" in modes.warnings[0] and math.isnan(modes.static_deflection)


@pytest.mark.parametrize("thinning", [0.0, 0.3, 0.6])
@pytest.mark.parametrize("rotary_inertia", [False, True])
def test_a_beam_hinged_on_the_axis_of_rotation_has_no_static_deflection(
    thinning: float, rotary_inertia: bool
) -> None:
    # Rotation tensions the beam and tilts the tension with it: every angle is in equilibrium.
    beam = bd.Beam.rectangular(0.05, 0.01, lambda x: 4e-4 * (1 - thinning * x), 200e9, 7850.0)
    mount, physics = bd.Mount(0.0, np.pi, root_stiffness=0.0), bd.Physics(rotary_inertia=rotary_inertia)
    for speed in (40.0, 150.0):
        modes = bd.natural_modes(bd.Scene(beam, mount, physics=physics), speed, 2)
        assert modes.status[0] == "neutral" and math.isnan(modes.static_deflection)


def test_exactly_at_the_critical_speed() -> None:
    """The first mode is stable or not within rounding of zero, and its relative error says so."""
    modes = bd.natural_modes(HARVESTER, bd.critical_speed(HARVESTER))
    assert np.abs(modes.eigenvalue[0]) < 1e-4 and modes.error[0] > 1e-4
    assert (modes.error[1:] < 1e-9).all()


def test_growth_is_continuous_through_the_critical_speed() -> None:
    """lambda^2 is smooth in the squared speed, so its second differences are small on both sides."""
    speeds = np.sqrt(np.linspace(0.9, 1.1, 21)) * bd.critical_speed(HARVESTER)
    squared = (bd.frequency_locus(HARVESTER, speeds, 1).eigenvalue[:, 0] ** 2).real
    assert np.abs(np.diff(squared, 2)).max() < 1e-3 * np.abs(np.diff(squared)).max()


def test_locus_equals_modes_one_by_one() -> None:
    speeds = np.array([-40.0, 0.0, 55.0, 165.0])
    locus = bd.frequency_locus(HARVESTER, speeds)
    for s, speed in enumerate(speeds):
        one = bd.natural_modes(HARVESTER, speed)
        np.testing.assert_allclose(locus.eigenvalue[s], one.eigenvalue, rtol=1e-10)


def test_modes_are_followed_through_a_crossing() -> None:
    """Stretch and bending cross and veer: followed branches are smooth, sorted ones have kinks."""
    speeds = np.linspace(0, 12, 121)
    locus = bd.frequency_locus(COUPLED, speeds, 4)
    kink = np.abs(np.diff(locus.frequency, 2, axis=0)).max(axis=0)
    ordered = np.abs(np.diff(np.sort(locus.frequency, axis=1), 2, axis=0)).max(axis=0)
    assert (np.diff(locus.frequency, axis=1) < 0).any()  # branches have exchanged their places
    assert kink.max() < ordered.max() / 3
    assert locus.confidence.min() > 0


def test_confidence_is_least_where_modes_veer() -> None:
    speeds = np.linspace(0, 12, 121)
    locus = bd.frequency_locus(COUPLED, speeds, 4)
    nearest = np.abs(np.diff(np.sort(locus.frequency, axis=1), axis=1))[:, 1].argmin()
    assert abs(int(locus.confidence[:, 1].argmin()) - nearest) <= 1
    assert locus.confidence[:, 1].min() < 0.8 and locus.confidence[:, 0].min() > 0.99


def test_flutter_and_divergence_are_told_apart() -> None:
    modes = bd.natural_modes(replace(HARVESTER, damping_ratio=0.5), 159.5)
    assert modes.status[0] == "overdamped" and math.isnan(modes.frequency[0]) and modes.growth_rate[0] < 0


def test_axial_strain_and_its_warning() -> None:
    """A spinning rod: strain rho omega^2 L^2 / (2 E) at the root without hub."""
    beam = bd.Beam.rectangular(1.0, 0.1, 0.01, 70e9, 2700.0)
    modes = bd.natural_modes(bd.Scene(beam, bd.Mount(0.0, np.pi)), 800.0)
    assert modes.axial_strain == pytest.approx(2700 * 800**2 / (2 * 70e9), rel=1e-12)
    assert any("strain" in text for text in modes.warnings)


def test_shapes_are_mass_normalised() -> None:
    modes = bd.natural_modes(HARVESTER, 50.0)
    x, w = np.polynomial.legendre.leggauss(40)
    phi = modes.shape(0.025 * (x + 1))
    mass = 7850 * 0.01 * 0.0002 * (phi * w * 0.025) @ phi.T
    np.testing.assert_allclose(mass, np.eye(3), atol=1e-10)
    np.testing.assert_allclose(modes.shape([0.05])[:, 0], modes.tip, rtol=1e-12)


EXACT = bd.natural_modes(HARVESTER, 100.0, discretization=bd.Ritz(40)).frequency


@pytest.mark.parametrize("discretization", ["ritz", "fem"])
@pytest.mark.parametrize("tolerance", [0.1, 1e-2, 1e-4, 1e-6])
def test_tolerance_is_kept(tolerance: float, discretization: str) -> None:
    modes = bd.natural_modes(HARVESTER, 100.0, discretization=discretization, tolerance=tolerance)
    assert (np.abs(modes.frequency / EXACT - 1) <= modes.error).all()
    assert modes.error.max() <= tolerance and not modes.warnings


def test_a_looser_tolerance_is_cheaper() -> None:
    sizes = [
        bd.natural_modes(HARVESTER, 100.0, tolerance=tolerance).model.solver.size
        for tolerance in (0.1, 1e-3, 1e-6, 1e-11)
    ]
    assert sizes == sorted(sizes) and sizes[0] < 0.7 * sizes[-1]


def test_provenance_says_what_was_chosen_and_compared() -> None:
    found = bd.natural_modes(HARVESTER, 100.0, tolerance=1e-3).provenance
    assert "with 11 Legendre" in found.method and "with 9 Legendre" in found.compared_with


@pytest.mark.parametrize(
    "discretization, tolerance", [("ritz", 1e-14), ("fem", 1e-9), (bd.Ritz(6), 1e-6), (bd.Fem(8), 1e-6)]
)
def test_a_tolerance_that_is_not_met_is_warned_of(discretization, tolerance: float) -> None:
    modes = bd.natural_modes(
        HARVESTER, 100.0, 5 if discretization == "ritz" else 3, discretization, tolerance
    )
    assert modes.error.max() > tolerance and "is not reached" in modes.warnings[0]


def test_many_modes_of_a_beam_of_many_segments() -> None:
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, breakpoints=np.linspace(0, 1, 11)[1:-1])
    found = bd.natural_modes(bd.Scene(beam), 0.0, 12)
    assert found.error.max() < 1e-9 and found.frequency[0] * 2 * np.pi == pytest.approx(3.5160152685)


STATIONS = np.linspace(0.1, 0.9, 9)
UNIFORM = bd.Scene(
    bd.Beam.from_stiffness(20.0, 100.0, 1e8, second_bending_stiffness=4e8, breakpoints=STATIONS),
    bd.Mount(1.0, np.pi, np.pi / 2),
    physics=bd.Physics(planes=2),
)


@pytest.mark.parametrize("modes", [50, 64])
def test_many_modes_of_a_uniform_beam_between_stations(modes: int) -> None:
    """Of the moments that inertia causes there many are polynomials, which the basis has already."""
    found = bd.natural_modes(UNIFORM, 0.0, modes)
    one = bd.natural_modes(replace(UNIFORM, physics=bd.Physics()), 0.0, 8)
    assert found.frequency[0] == pytest.approx(one.frequency[0], rel=1e-9)
    assert (found.error < 1e-6).all()
    assert np.isfinite(bd.frequency_locus(UNIFORM, [0.0, 1.0], modes).frequency).all()


def test_many_modes_of_few_moments_that_depend_on_each_other() -> None:
    """With less than two modes for each segment the basis has moments, of which few are independent here."""
    many = bd.Beam.from_stiffness(1.0, 1.0, 1.0, breakpoints=np.arange(1, 30) / 30)
    found = bd.natural_modes(bd.Scene(many), 0.0, 54)
    assert found.frequency[0] * 2 * np.pi == pytest.approx(3.5160152685)
    assert not np.isnan(found.error).any()


def test_modes_that_the_coarser_basis_lacks_have_no_error() -> None:
    found = bd.natural_modes(UNIFORM, 0.0, 50, discretization=bd.Ritz(86, "moments"))
    assert np.isfinite(found.frequency).all()
    assert np.isinf(found.error[-1])
    in_one_plane = replace(UNIFORM, physics=bd.Physics())
    with pytest.raises(ValueError, match=r"modes = 40: .* has 32 functions for this beam; ask for fewer"):
        bd.natural_modes(in_one_plane, 0.0, 40, discretization=bd.Ritz(86, "moments"))


def test_a_given_basis_counts_its_functions_on_every_segment() -> None:
    table = bd.Table((0.0, 0.5, 1.0), (8.0, 8.0, 4.0))
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, table))
    assert len(scene.beam.breakpoints) == 3
    modes = bd.natural_modes(scene, 0.0, 12, bd.Ritz(10))
    fine = bd.natural_modes(scene, 0.0, 12, bd.Ritz(24)).frequency
    assert np.isfinite(modes.error[:10]).all()
    assert (np.abs(modes.frequency / fine - 1) <= modes.error).all()
    with pytest.raises(ValueError, match="at most 16 modes"):
        bd.natural_modes(scene, 0.0, 25, bd.Ritz(10))


def test_tolerance_holds_at_every_speed_of_a_locus() -> None:
    speeds = np.linspace(-150, 150, 31)
    locus = bd.frequency_locus(HARVESTER, speeds, tolerance=1e-4)
    exact = bd.frequency_locus(HARVESTER, speeds, discretization=bd.Ritz(40))
    assert (np.abs(locus.frequency / exact.frequency - 1) <= locus.error).all()
    assert locus.error.max() <= 1e-4 and not locus.warnings


def test_tolerance_of_the_critical_speed() -> None:
    rough, exact = (bd.critical_point(HARVESTER, tolerance=tol) for tol in (1e-3, None))
    assert abs(rough.speed / exact.speed - 1) <= rough.error <= 1e-3 and not rough.warnings
    assert bd.critical_speed(HARVESTER, tolerance=1e-3) == rough.speed
    with pytest.warns(UserWarning, match="is not reached"):
        bd.critical_speed(HARVESTER, bd.Ritz(4), tolerance=1e-9)


@pytest.mark.parametrize("tolerance", [0.0, -1e-3, 0.5, 1e-15, math.nan, "small"])
def test_tolerance_out_of_range(tolerance) -> None:
    for analysis in (bd.natural_modes, bd.critical_point):
        with pytest.raises(ValueError, match="tolerance"):
            analysis(HARVESTER, tolerance=tolerance)
    with pytest.raises(ValueError, match="tolerance"):
        bd.frequency_locus(HARVESTER, [0.0, 1.0], tolerance=tolerance)


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: bd.natural_modes(HARVESTER, math.nan), ["speed", "nan"]),
        (lambda: bd.natural_modes(HARVESTER, 1.0, modes=0), ["modes", "0"]),
        (lambda: bd.natural_modes(HARVESTER, 1.0, modes=2.5), ["modes", "2.5"]),  # pyright: ignore[reportArgumentType]
        (
            lambda: bd.natural_modes(HARVESTER, 1.0, modes=20, discretization=bd.Ritz(10)),
            ["modes", "20", "Ritz"],
        ),
        (lambda: bd.natural_modes(HARVESTER, 1.0, modes=500), ["modes", "500", "fewer"]),
        (lambda: bd.natural_modes(HARVESTER, 1.0, discretization="bem"), ["discretization", "bem", "ritz"]),
        (lambda: bd.frequency_locus(HARVESTER, []), ["speeds", "empty"]),
        (lambda: bd.frequency_locus(HARVESTER, [1.0, 1.0]), ["speeds", "unique"]),
        (lambda: bd.frequency_locus(HARVESTER, [2.0, 1.0]), ["speeds", "ascend"]),
        (lambda: bd.frequency_locus(HARVESTER, np.eye(2)), ["speeds", "(2, 2)"]),
        (lambda: bd.frequency_locus(HARVESTER, [0.0, math.inf]), ["speeds", "inf"]),
        (lambda: bd.setting_angle_limits(HARVESTER, -3.0), ["top_speed", "-3"]),
        (lambda: bd.setting_angle_limits(HARVESTER, math.inf), ["top_speed", "finite"]),
        (lambda: bd.Ritz(201), ["functions", "201", "200"]),
        (lambda: bd.Ritz(10, "fourier"), ["basis", "fourier"]),  # pyright: ignore[reportArgumentType]
        (lambda: bd.Fem(1), ["elements", "1"]),
        (lambda: bd.Fem(10, "random"), ["mesh", "random"]),  # pyright: ignore[reportArgumentType]
    ],
)
def test_bad_input(call, words) -> None:
    with pytest.raises(ValueError) as caught:
        call()
    assert all(word in str(caught.value) for word in words)


@given(st.lists(st.floats(), max_size=5))
def test_any_speeds_give_an_answer_or_a_sentence(speeds: list[float]) -> None:
    usable = len(speeds) > 0 and all(map(math.isfinite, speeds)) and speeds == sorted(set(speeds))
    if usable and max(map(abs, speeds)) < 1e3:
        assert bd.frequency_locus(HARVESTER, speeds).frequency.shape == (len(speeds), 3)
    elif not usable:
        with pytest.raises(ValueError, match="speeds"):
            bd.frequency_locus(HARVESTER, speeds)


# Two planes, springs at the root --------------------------------------------------------------------

ANGLE = np.polynomial.Polynomial([0.0, 0.3])
BLADE = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=3.0, twist=ANGLE)
VEERING = bd.Scene(BLADE, bd.Mount(0.2, np.pi, np.pi / 2), physics=bd.Physics(planes=2))


@pytest.mark.parametrize("speed", [0.0, 3.0])
@pytest.mark.parametrize("discretization", ["ritz", bd.Fem(40)])
@pytest.mark.parametrize("twist", [None, BLADE.twist])
def test_a_turn_about_a_hinge_is_neutral(twist, discretization, speed: float) -> None:
    """In the plane about the axis itself; out of it, the hinge has the frequency of the rotation."""
    mount = bd.Mount(0.0, np.pi, 0.0, 0.0, 0.0)
    scene = bd.Scene(replace(BLADE, twist=twist), mount, physics=bd.Physics(planes=2))
    modes = bd.natural_modes(scene, speed, 3, discretization)
    assert modes.status.tolist() == ["neutral", "stable" if speed else "neutral", "stable"]
    assert modes.frequency[0] == modes.error[0] == modes.growth_rate[0] == 0
    assert abs(2 * np.pi * modes.frequency[1] - speed) <= modes.error[1] * speed
    assert np.isfinite(modes.error).all() and not any("unstable" in text for text in modes.warnings)


@pytest.mark.parametrize("twist", [None, BLADE.twist])
@pytest.mark.parametrize("springs", [(0.0, np.inf), (0.0, 0.0)])
@pytest.mark.parametrize("speeds", [[0.0], [50.0], [0.0, 3.0]])
def test_a_damped_turn_about_a_hinge_is_neutral(twist, springs: tuple[float, float], speeds) -> None:
    """Modal damping does not act on such a turn, whose eigenvalue is 0 twice.

    At rest damping multiplies each frequency by sqrt(1 - ratio^2).
    """
    beam = replace(BLADE, twist=twist)
    undamped = bd.Scene(beam, bd.Mount(0.0, np.pi, 0.0, *springs), physics=bd.Physics(planes=2))
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # of rounding, too
        found = bd.frequency_locus(replace(undamped, damping_ratio=0.02), speeds, 3)
    expected = bd.frequency_locus(undamped, speeds, 3)
    np.testing.assert_array_equal(found.status, expected.status)
    neutral = found.status == "neutral"
    assert neutral[:, 0].all() and not np.abs(found.eigenvalue[neutral]).any()
    assert (found.error[neutral] == 0).all() and (found.error < 1e-9).all()
    if speeds == [0.0]:
        exact = expected.frequency * np.sqrt(1 - 0.02**2)
        np.testing.assert_allclose(found.frequency, exact, rtol=1e-12)


def test_a_damped_flapping_hinge_at_rest_needs_no_large_basis() -> None:
    beam = bd.Beam.rectangular(1.0, 0.06, 0.03, 70e9, 2700.0)
    mount = bd.Mount(0.3, np.pi, np.pi / 2, root_stiffness=0.0)
    modes = bd.natural_modes(bd.Scene(beam, mount, damping_ratio=0.02), 0.0, 2)
    assert modes.status.tolist() == ["neutral", "stable"] and modes.eigenvalue[0] == modes.error[0] == 0
    assert modes.model.equations.size < 40


@pytest.mark.parametrize("stiffness", [1e-6, 1e-3, 1.0, 100.0])
@pytest.mark.parametrize("speed", [0.0, 0.3])
def test_errors_of_finite_elements_on_soft_springs_cover_the_true_ones(
    stiffness: float, speed: float
) -> None:
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.0, np.pi, root_stiffness=stiffness))
    exact = bd.natural_modes(scene, speed, 2, bd.Ritz(20))
    for elements in (20, 100):
        rough = bd.natural_modes(scene, speed, 2, bd.Fem(elements))
        assert (np.abs(rough.eigenvalue / exact.eigenvalue - 1) <= rough.error + exact.error).all()
    assert (exact.error < 1e-9).all()


def test_errors_of_unstable_modes_on_springs_are_not_negative() -> None:
    mount = bd.Mount(1.65, -0.97, 0.45, 11.0, 0.036)
    scene = bd.Scene(replace(BLADE, twist=None), mount, physics=bd.Physics(planes=2))
    modes = bd.natural_modes(scene, 11.2, 4)
    assert modes.status[0] == "divergence" and (modes.error > 0).all()


def planes_at_random(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """A tapered blade with twist, often so little that its planes hardly veer; with springs, and a speed."""
    ratio, taper = 10 ** rng.uniform(-0.3, 1.2), np.polynomial.Polynomial([1.0, -rng.uniform(0, 0.9)])
    beam = bd.Beam.from_stiffness(
        1.0,
        1.0,
        taper,
        second_bending_stiffness=ratio * taper,
        twist=np.polynomial.Polynomial(
            [rng.uniform(-0.3, 0.3), rng.uniform(-1.5, 1.5) * rng.choice([0.01, 1])]
        ),
        rotary_inertia=1e-3,
        second_rotary_inertia=1e-3 * ratio,
        shear_stiffness=300.0,
    )
    springs = (rng.choice([np.inf, 10 ** rng.uniform(-4, 2)]) for _ in range(2))
    angles = rng.choice([np.pi, rng.uniform(-3, 3)]), rng.choice([0, np.pi / 2, rng.uniform(-3, 3)])
    thick = bool(rng.random() < 0.4)
    scene = bd.Scene(
        beam, bd.Mount(rng.uniform(0, 2), *angles, *springs), physics=bd.Physics(2, thick, thick)
    )
    return scene, rng.uniform(0, 12)


@pytest.mark.parametrize("seed", range(12))
def test_errors_in_two_planes_cover_the_true_ones(seed: int) -> None:
    scene, speed = planes_at_random(np.random.default_rng(seed))
    exact = bd.natural_modes(scene, speed, 4, bd.Ritz(40))
    for tolerance in (1e-2, 1e-5, None):
        modes = bd.natural_modes(scene, speed, 4, tolerance=tolerance)
        assert (np.abs(modes.eigenvalue / exact.eigenvalue - 1) <= modes.error + exact.error).all()


def test_flap_and_edge_are_followed_where_they_veer() -> None:
    """Followed modes exchange their planes where the twist couples them; without twist they cross."""
    speeds = np.linspace(0, 12, 121)
    veering = bd.frequency_locus(VEERING, speeds, 2)
    shares = veering.plane_share[:, :, 0]
    np.testing.assert_allclose(veering.plane_share.sum(axis=2), 1, rtol=1e-12)
    assert shares[0, 0] > 0.9 > 0.1 > shares[-1, 0] and shares[0, 1] < 0.1 < 0.9 < shares[-1, 1]
    nearest = int(np.abs(np.diff(veering.frequency, axis=1))[:, 0].argmin())
    assert abs(int(veering.confidence[:, 0].argmin()) - nearest) <= 2
    crossing = bd.frequency_locus(replace(VEERING, beam=replace(BLADE, twist=None)), speeds, 2)
    assert set(crossing.plane_share[:, 0, 0]) == {1.0} and set(crossing.plane_share[:, 1, 0]) == {0.0}
    assert (np.diff(crossing.frequency, axis=1)[[0, -1], 0] * [1, -1] > 0).all()
    assert crossing.confidence.min() > 0.99


def test_the_picture_tells_flap_from_edge() -> None:
    """Solid is out of the plane: mode 1 until it veers, mode 2 from there; the pieces meet."""
    locus = bd.frequency_locus(VEERING, np.linspace(0, 12, 121), 2)
    ax = locus.plot(Figure().subplots())
    first, then, *_ = [line for line in ax.lines if line.get_color() == ax.lines[0].get_color()]
    assert (first.get_linestyle(), then.get_linestyle()) == ("-", "--")
    np.testing.assert_array_equal(np.asarray(first.get_xydata())[-1], np.asarray(then.get_xydata())[0])
    legend = ax.get_legend()
    assert legend is not None
    words = [text.get_text() for text in legend.get_texts()]
    assert words[:2] == ["mode 1", "mode 2"] and "flap" in words[2] and "edge" in words[3]
    dashes = {line.get_label(): line.get_linestyle() for line in ax.lines}
    assert (dashes[words[2]], dashes[words[3]]) == ("-", "--")


def test_a_frequency_of_one_sure_digit_stands_with_its_error() -> None:
    found = bd.natural_modes(HARVESTER, 50.0, 1)
    f = float(found.frequency[0])
    shown = Console(width=200)
    with shown.capture() as captured:
        shown.print(tables_of(replace(found, error=np.array([0.04]))))
    number, error = re.search(r"([\d.e+]+) ± ([\d.e+]+)", captured.get()).groups()
    assert abs(float(number) - f) < float(error) == float(f"{0.04 * f:.1g}")


def test_shapes_show_both_directions() -> None:
    modes = bd.natural_modes(VEERING, 6.0, 2)
    ax = modes.plot(Figure().subplots())
    x = ax.lines[1].get_xdata()
    for line, direction in ((ax.lines[1], 0), (ax.lines[2], 1)):
        shape = np.real(modes.shape(np.asarray(x), direction)[0])
        largest = np.abs([modes.shape(np.asarray(x), d)[0] for d in (0, 1)]).max()
        np.testing.assert_allclose(np.asarray(line.get_ydata()), shape / largest, atol=1e-15)


def test_tables_and_rows_have_the_planes() -> None:
    modes, locus = bd.natural_modes(VEERING, 0.0, 2), bd.frequency_locus(VEERING, [0.0, 1.0], 2)
    head, first, _ = rows_of(modes)
    row = dict(zip(head, first, strict=True))
    assert row["share_bending"] == modes.plane_share[0, 0]
    assert row["share_across"] == pytest.approx(1 - modes.plane_share[0, 0], rel=1e-12)
    head, first, _ = rows_of(locus)
    assert dict(zip(head, first, strict=True))["share_across_2"] == locus.plane_share[0, 1, 1]
    assert "share" not in str(next(iter(rows_of(bd.natural_modes(HARVESTER)))))
    console = Console(width=200, record=True, file=StringIO())
    console.print(tables_of(modes), tables_of(locus))
    text = console.export_text()
    assert "share of flap" in text and "f: mostly flap" in text and "e: mostly edge" in text


@pytest.mark.parametrize("modes", [5, 12])
def test_no_column_of_a_locus_is_cut(modes: int) -> None:
    """At the width of a pipe every frequency stands with its letter, in as many tables as it takes."""
    console = Console(width=120, record=True, file=StringIO(), markup=False)
    found = bd.frequency_locus(VEERING, [0.0, 1000.0 / 3], modes)
    console.print(tables_of(found))
    text = console.export_text()
    rules = [line for line in text.splitlines() if line.strip(" ─") == "" != line.strip()]
    assert "…" not in text and len(rules) == (1 if modes == 5 else 2)
    for mode, (frequency, share) in enumerate(zip(found.frequency[0], found.plane_share[0], strict=True), 1):
        cell = f"{frequency:.{6 - math.floor(math.log10(frequency))}f} {'fe'[int(share.argmax())]}"
        assert f"mode {mode} " in text and cell in text


@pytest.mark.parametrize("springs", [(np.inf, np.inf), (3.0, 2.0)])
@pytest.mark.parametrize("physics", [bd.Physics(2), bd.Physics(2, True, True), bd.Physics(1, True, True)])
def test_setting_angle_limits_are_where_the_slope_vanishes(physics: bd.Physics, springs) -> None:
    """By differences of the squared frequency, to which a change of phi by 0.01 adds 0.03."""
    section = bd.Beam.from_stiffness(
        1.0,
        1.0,
        1.0,
        tip=bd.TipMass(0.1, 0.05, 1e-3, 9e-4, 2e-4),
        second_bending_stiffness=3.0,
        twist=ANGLE,
        shear_stiffness=300.0,
        rotary_inertia=1e-3,
        second_rotary_inertia=3e-3,
    )
    scene = bd.Scene(section, bd.Mount(1.2, 0.0, 0.3, *springs), physics=physics)
    limits = bd.setting_angle_limits(scene, 4.0)

    def slope(angle: float, speed: float) -> float:
        mounted = replace(scene, mount=replace(scene.mount, setting_angle=angle))
        low, high = (
            bd.natural_modes(mounted, v, 1).eigenvalue[0] ** 2 for v in (0.999 * speed, 1.001 * speed)
        )
        return float((low - high).real / (0.004 * speed**2))

    assert abs(slope(limits.first, 0.01)) < 1e-3 < abs(slope(limits.first + 0.1, 0.01))
    assert abs(slope(limits.second, 4.0)) < 1e-6 < abs(slope(limits.second + 0.01, 4.0))


def test_limits_of_a_hinge_are_refused_by_name() -> None:
    with pytest.raises(InvalidValue) as caught:
        bd.setting_angle_limits(replace(VEERING, mount=bd.Mount(second_root_stiffness=0.0)), 4.0)
    assert caught.value.field == "second_root_stiffness"
    bd.setting_angle_limits(bd.Scene(BLADE, bd.Mount(1.0, second_root_stiffness=0.0)), 4.0)
