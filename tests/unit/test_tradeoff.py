"""Error against time: diagrams, physics, the whole, and the command."""

import csv
import json
from dataclasses import replace
from math import isnan
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.cli import BAD_INPUT, DONE, NO_ANSWER, main
from beamdyn.studies.tradeoffs import frequencies, measurements, responses
from beamdyn.studies.tradeoffs.frequencies import ALL, AS_GIVEN, frequency_diagram, physics_diagram, pick
from beamdyn.studies.tradeoffs.responses import (
    AT_ENDS,
    AT_REST,
    harmonics_diagram,
    integrators_diagram,
    transient_modes_diagram,
)
from beamdyn.studies.tradeoffs.tradeoff import MOST_MODES
from benchmarks.cases.scenes import HARVESTER, ROLLING
from benchmarks.tradeoff_physics import make_scenes

ROOT = Path(__file__).parents[2]
FLAT = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.0)  # it does not camber
STILL = str(ROOT / "examples" / "tyre_harvester.toml")
MOVING = str(ROOT / "examples" / "rolling_harvester.toml")


@pytest.fixture(scope="module", autouse=True)
def once():
    """Each case runs once, and there are few, so that budgets do not decide what is measured."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(measurements, "RUNS", 1)
        patch.setattr(frequencies, "_LEGENDRE", (1, 2, 3, 4, 6, 8, 10, 12, 14))
        patch.setattr(frequencies, "_EIGENFUNCTIONS", (1, 2, 3, 4, 8, 16, 40))
        patch.setattr(frequencies, "_ELEMENTS", (2, 4, 10, 20))
        patch.setattr(frequencies, "_TOLERANCES", (1e-1, 1e-3, 1e-6, 1e-10))
        patch.setattr(frequencies, "_FUNCTIONS", (3, 4, 6, 8, 10, 14))
        patch.setattr(responses, "STOCK", ("Radau", "DOP853"))
        patch.setattr(responses, "_STOCK_TOLERANCES", (1e-3, 1e-6))
        patch.setattr(responses, "_MODES", (1, 2, 4))
        patch.setattr(responses, "_ALL_MODES", 8)
        yield


# Diagrams -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def diagram():
    return frequency_diagram(HARVESTER, np.array([100.0]), 3, budget=60.0)


def errors(diagram, family):
    return {m.size: m.error for m in diagram.measurements if m.family == family}


@pytest.mark.parametrize("basis", ["legendre", "eigenfunctions"])
def test_more_functions_are_never_worse(diagram, basis):
    found = errors(diagram, f"Ritz, {basis}")
    assert list(found) == sorted(found)
    # Poincare: the values of nested spaces fall; rounding is within twice what is resolved
    assert (np.diff(list(found.values())) <= 2 * diagram.resolved).all()
    assert min(found.values()) < 1e-10 < 1e-4 < max(found.values()) or basis == "eigenfunctions"
    assert min(found.values()) < 1e-8


@pytest.mark.parametrize("modes", [MOST_MODES, 2 * MOST_MODES + 2])  # of one plane, and of two
def test_a_reference_has_more_modes_than_are_compared(modes):
    exact = frequencies.solve_reference(HARVESTER, np.array([100.0]), modes)
    assert exact.error.shape == (1, modes)
    assert exact.error.max() < 1e-7


def test_elements_converge_with_the_fourth_power_and_extrapolated_faster(diagram):
    plain, better = (errors(diagram, f"elements, uniform{name}") for name in ("", ", extrapolated"))
    assert plain[10] / plain[20] == pytest.approx(16, rel=0.1)  # the asymptotic rate, nearly reached
    assert better[10] / better[20] > 40
    assert better[20] < 0.1 * plain[20]


def test_tolerances_are_kept(diagram):
    found = errors(diagram, "tolerance=")
    assert len(found) == 4
    assert all(error <= max(tolerance, 1e-11) for tolerance, error in found.items())


def test_the_reference_is_checked_by_the_guaranteed_bounds(monkeypatch):
    def wrong(scene, speed, modes):
        return bd.frequency_bounds(scene, speed + 1.0, modes)

    monkeypatch.setattr(frequencies, "frequency_bounds", wrong)
    with pytest.raises(ArithmeticError, match="not within the guaranteed bounds"):
        frequency_diagram(HARVESTER, np.array([100.0]), 1, budget=1.0)


def test_a_locus_has_the_error_of_its_worst_speed():
    speeds = np.array([0.0, 100.0])
    both, one = (frequency_diagram(HARVESTER, s, 2, budget=60.0) for s in (speeds, speeds[1:]))
    family = "Ritz, eigenfunctions"  # exact at rest, and so worst at the highest speed
    assert errors(both, family)[2] == pytest.approx(errors(one, family)[2], rel=1e-6)
    assert "at 2 speeds to 100 rad/s" in both.title


@pytest.fixture(scope="module")
def integrators():
    return integrators_diagram(ROLLING, 0.05, 2, budget=60.0)


def test_integrators_agree(integrators):
    for family in ("solve_ivp Radau", "solve_ivp DOP853"):
        found = errors(integrators, family)
        assert found[1e-6] < 1e-3  # some steps add up
        assert found[1e-6] < 0.1 * found[1e-3]
    assert errors(integrators, "Gauss collocation")[1e-10] < 1e-10
    assert "DOP853 with rtol 1e-11 differs by" in integrators.reference


def test_stock_integrators_are_given_up_in_time():
    found = integrators_diagram(ROLLING, 5.0, 2, budget=0.7)
    left_out = [sentence for sentence in found.skipped if sentence.startswith("solve_ivp")]
    assert any("given up after" in sentence for sentence in left_out)
    assert "not checked by DOP853, which took more than" in found.reference


def test_more_modes_are_better():
    diagram = transient_modes_diagram(ROLLING, 0.5, budget=60.0)
    rest, ends = (list(errors(diagram, name).values()) for name in (AT_REST, AT_ENDS))
    assert len(rest) == 3 and (np.diff(rest) < 0).all()
    assert ends[1] < rest[1]


def test_more_harmonics_are_better():
    diagram = harmonics_diagram(ROLLING, np.array([20.0, 40.0]), 2, budget=60.0)
    found = np.array(list(errors(diagram, "harmonics").values()))
    above = found > 10 * diagram.resolved
    assert above.sum() >= 3
    assert (np.diff(found[above]) < 0).all()


def test_one_speed_is_named():
    title = harmonics_diagram(ROLLING, np.array([40.0]), 2, budget=0.1).title
    assert title == "steady response at 40 rad/s, number of harmonics"


def test_a_motion_that_pulsates_is_measured_without_a_steady_response():
    moving = replace(HARVESTER, motion=bd.PulsatingRotation(50.0, 0.1, 124.0))
    found = bd.tradeoff(moving, modes=1, t_end=0.05, budget=0.5)
    assert any("the steady response is not measured" in said for said in found.warnings)
    assert not any("steady response" in each.title for each in found.diagrams)


def test_nothing_is_measured_where_nothing_moves():
    still = bd.Scene(HARVESTER.beam, bd.Mount(0.0), bd.SteadyRotation(0.0))
    assert integrators_diagram(still, 0.1, 1, budget=0.5).skipped == ("nothing moves the beam",)
    assert transient_modes_diagram(still, 0.1, budget=0.5).measurements == ()


# Physics ------------------------------------------------------------------------------------------

LEADING = {
    "harvester at 45 deg": {"large_deflection": True},
    "stocky blade": {"shear": True},
    "twisted blade": {"planes": 2},
}
FULL = {
    "harvester at 45 deg": bd.Physics(large_deflection=True, shear=True, rotary_inertia=True),
    "stocky blade": bd.Physics(shear=True, rotary_inertia=True),
    "twisted blade": bd.Physics(planes=2, shear=True, rotary_inertia=True),
}


@pytest.fixture(scope="module", params=list(FULL))
def chosen(request):
    scene, speed = make_scenes()[request.param]
    # A stocky blade without camber, which converges slowly at the corners of the clamp.
    ratio = {"stocky blade": 0.0, "harvester at 45 deg": 0.3}.get(request.param)
    if ratio is not None:
        section = replace(scene.beam.section, poissons_ratio=ratio)
        scene = replace(scene, beam=scene.beam.with_section(section))
    return request.param, scene, speed, physics_diagram(scene, speed, 3, budget=60.0)


def frequencies_of(scene, speed, physics):
    count = 8 if physics.planes == 2 else 3
    return bd.natural_modes(replace(scene, physics=physics), speed, count).frequency


def test_functions_do_not_help_beyond_the_error_of_the_model(chosen):
    """It is the difference of `natural_modes` with and without the effects."""
    name, scene, speed, diagram = chosen
    given, true = (frequencies_of(scene, speed, p) for p in (bd.Physics(), FULL[name]))
    expected = np.abs(given / nearest(true, given) - 1).max()
    found = errors(diagram, AS_GIVEN)
    assert expected > 0.05
    assert found[14] == pytest.approx(expected, rel=1e-6)
    assert found[14] == pytest.approx(found[10], rel=1e-3)
    assert errors(diagram, ALL)[14] < 1e-9


def test_one_effect_leads(chosen):
    """It is worth more than any other, and still leaves what the others are worth."""
    name, scene, speed, diagram = chosen
    led, true = (frequencies_of(scene, speed, p) for p in (bd.Physics(**LEADING[name]), FULL[name]))
    given = frequencies_of(scene, speed, bd.Physics())
    wanted = nearest(true, given)
    expected = np.abs(nearest(led, wanted) / wanted - 1).max()
    least = {m.family: min(errors(diagram, m.family).values()) for m in diagram.measurements}
    single = {family: error for family, error in least.items() if family not in (AS_GIVEN, ALL)}
    assert min(single.values()) == pytest.approx(expected, rel=1e-5)
    assert least[ALL] < min(single.values()) < 0.3 * least[AS_GIVEN]


def nearest(found, wanted):
    """For each wanted frequency the nearest: none is so far away that two would be mistaken."""
    order = np.abs(np.log(found[None, :] / wanted[:, None])).argmin(axis=1)
    assert len(set(order.tolist())) == len(wanted)
    return found[order]


def test_modes_of_a_second_plane_are_not_taken_for_those_wanted():
    found = np.array([1.01, 1.7, 2.02, 3.1, 3.9])
    assert pick(found, np.array([1.0, 2.0, 3.0])).tolist() == [1.01, 2.02, 3.1]


def test_what_cannot_be_combined_is_named():
    scene, speed = make_scenes()["harvester at 45 deg"]
    diagram = physics_diagram(scene, speed, 1, budget=60.0)
    assert "camber of sections: it cannot be combined with the others" in diagram.skipped
    assert "large deflection and shear deformation and rotary inertia" in diagram.reference


def test_what_the_beam_has_no_data_for_is_named():
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.5, np.pi))
    diagram = physics_diagram(scene, 1.0, 2, budget=1.0)
    assert not diagram.measurements
    assert any(sentence.startswith("rotary inertia of sections: give") for sentence in diagram.skipped)


# The whole ----------------------------------------------------------------------------------------


def test_a_strip_that_cambers_has_a_small_reference_that_is_near_that_of_a_plate():
    strip = bd.load_scene(STILL)
    strip = replace(strip, physics=replace(strip.physics, camber=True))
    reference = frequencies.solve_reference(strip, np.zeros(1), 3)
    assert reference.model.equations.size <= 1000  # 8 MB a matrix, where screens allow 800 MB
    assert reference.error.max() <= 1e-6
    # A plate's by another program, without the softer clamp of a section of finite width: 5e-4.
    plate = 66.0704, 413.571, 1160.446
    np.testing.assert_allclose(np.abs(reference.eigen.eigenvalue[0]) / (2 * np.pi), plate, rtol=5e-4)
    diagram = physics_diagram(strip, 100.0, budget=3.0)
    best = min(m.error for m in diagram.measurements if m.family == AS_GIVEN)
    assert 0 < diagram.resolved < best  # what is measured is not the error of the reference


@pytest.fixture(scope="module")
def still():
    return bd.tradeoff(replace(HARVESTER, beam=FLAT), 100.0, budget=20.0)


def test_a_scene_without_motion_has_frequencies_only(still):
    assert [d.title for d in still.diagrams] == [
        "3 frequencies at 100 rad/s",
        "3 frequencies at 101 speeds to 100 rad/s",
        "physics: 3 frequencies at 100 rad/s",
    ]
    assert "no motion" in still.warnings[0]
    assert isnan(still.t_end)
    assert bd.tradeoff is bd.tradeoff  # the function, also after its module is loaded
    assert callable(bd.tradeoff)


def test_diagrams_of_a_beam_that_does_not_move_are_missing_with_a_reason():
    spun = bd.Scene(FLAT, bd.Mount(0.2, bending_angle=np.pi / 2), bd.SteadyRotation(50.0))
    found = bd.tradeoff(spun, t_end=0.1, budget=5.0)  # the load lies in the plane, the deflection out of it
    assert [d.title.split()[1] for d in found.diagrams] == ["frequencies", "frequencies", "3"]
    assert len(found.warnings) == 4
    assert "nothing moves the beam" in found.warnings[0]


def test_functions_are_counted_on_each_segment():
    jump = bd.Table([0.0, 0.4, 0.4, 1.0], [4e-4, 4e-4, 2e-4, 2e-4])
    beam = bd.Beam.rectangular(0.05, 0.01, jump, youngs_modulus=200e9, density=7850.0)
    found = frequency_diagram(bd.Scene(beam, HARVESTER.mount), np.array([50.0]), 3, budget=20.0)
    assert found.measurements[0].setting == "2 functions a segment"
    assert errors(found, "Ritz, legendre")[10] < 1e-9  # the jump is at an edge: no loss of convergence
    assert errors(found, "Ritz, eigenfunctions")[16] > 1e-6


def test_to_dict_has_the_fronts_and_the_costs(still):
    diagram = still.to_dict()["diagrams"][0]
    assert diagram["front"][0]["family"].startswith("Ritz")
    assert [d["error"] for d in diagram["per_digit"][:2]] == [0.1, 0.01]


def test_summary_names_the_front(still):
    assert still.diagrams[0].summary.startswith("Ritz, ")
    assert " functions" in still.diagrams[0].summary


def test_plot_has_a_panel_a_diagram_and_a_line_a_family(still):
    ax = Figure().subplots()
    assert still.plot(ax) is ax
    _, first, second, _ = ax.figure.axes
    assert first.get_title() == "3 frequencies at 100 rad/s"
    families = {m.family for m in still.diagrams[1].measurements}
    drawn = {line.get_label() for line in second.lines}
    assert drawn == {"Pareto front", *families}
    assert (first.get_xscale(), first.get_yscale()) == ("log", "log")


def test_a_legend_below_the_axes_leaves_their_label_free(still):
    figure = still.plot().figure
    figure.draw_without_rendering()
    below = [
        ax for ax in figure.axes if ax.get_legend() and ax.get_legend().get_window_extent().y1 < ax.bbox.y0
    ]
    assert below
    for ax in below:
        assert not ax.get_legend().get_window_extent().overlaps(ax.xaxis.label.get_window_extent())


@pytest.mark.parametrize("budget", [0.0, -1.0, 1e-4, 1e9, float("nan"), "soon"])
def test_bad_budgets_are_refused(budget):
    with pytest.raises(ValueError, match="budget"):
        bd.tradeoff(HARVESTER, budget=budget)


def test_a_transient_needs_a_motion():
    with pytest.raises(ValueError, match=r"t_end = 2: the scene has no motion"):
        bd.tradeoff(HARVESTER, t_end=2.0)


def test_the_length_of_the_run_follows_from_the_scene():
    from beamdyn.studies.tradeoffs.tradeoff import _end

    assert 11 < _end(ROLLING) < 12.1  # settled after 10 s; a hundred periods of 1/65 s
    slow = bd.Scene(HARVESTER.beam, HARVESTER.mount, bd.SpinUp(55.0, duration=3600.0))
    assert 1 < _end(slow) < 2


# The command --------------------------------------------------------------------------------------


@pytest.fixture
def command(capsys):
    def command(*arguments):
        code = main(["tradeoff", *map(str, arguments)])
        return code, *capsys.readouterr()

    return command


def test_the_command_prints_and_writes(command, tmp_path):
    j, c, p = (tmp_path / name for name in ("j.json", "c.csv", "p.png"))
    files = ("--json", j, "--csv", c, "--plot", p)
    code, out, err = command(STILL, "--speed", "50 rad/s", "--modes", 2, "--budget", "5 s", *files)
    assert code == DONE
    for part in ("2 frequencies at 50 rad/s", "over the digit before", "Pareto front: Ritz", "guaranteed"):
        assert part in out
    assert "no motion" in err
    diagrams = json.loads(j.read_text())["diagrams"]
    rows = list(csv.DictReader(c.read_text().splitlines()))
    assert len(rows) == sum(len(d["measurements"]) for d in diagrams)
    assert sum(row["in_front"] == "True" for row in rows) == sum(len(d["front"]) for d in diagrams)
    assert p.stat().st_size > 10_000
    code, _, err = command(STILL, "--budget", "1 s", "--csv", c)
    assert (code, "--force" in err) == (BAD_INPUT, True)


@pytest.mark.slow
def test_the_command_measures_motion(command):
    code, out, _ = command(MOVING, "--t-end", "0.1 s", "--modes", 1, "--budget", "5 s")
    assert code == DONE
    for part in (
        "1 frequency at 55 rad/s",
        "Transient of 0.1 s, 1 mode\n",
        "Gauss collocation",
        "number of modes",
    ):
        assert part in out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--budget", "0 s"), "--budget"),
        (("--budget", "60"), "unit"),
        (("--budget", "1e9 s"), "budget = 1e+09 s: give 0.01 to 86400 s"),
        (("--t-end", "1 s"), "the scene has no motion"),
        (("--modes", "0"), "modes = 0"),
    ],
)
def test_bad_input_is_refused_with_a_sentence(command, arguments, sentence):
    code, _, err = command(STILL, *arguments)
    assert (code, sentence in err) == (BAD_INPUT, True)


def test_no_answer_if_the_reference_fails(command, monkeypatch):
    from beamdyn.studies.tradeoffs import tradeoff

    def fails(*arguments):
        raise ArithmeticError("not within the guaranteed bounds")

    monkeypatch.setattr(tradeoff, "frequency_diagram", fails)
    code, _, err = command(STILL, "--budget", "1 s")
    assert (code, "guaranteed" in err) == (NO_ANSWER, True)
