"""What more modes change, found along the path of a run, is what a motion with these modes shows."""

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.modes.modal.model import ModalBasis, find_speed_range
from benchmarks.cases.scenes import HARVESTER, SHORT_SPIN_UP
from benchmarks.stated_transient_errors import find_time_error, random_wave_run

TILTED = replace(HARVESTER, mount=bd.Mount(0.215, 0.3), motion=bd.SpinUp(90.0, duration=0.2))
OUTWARD = replace(HARVESTER, mount=bd.Mount(0.0, math.pi), gravity=9.81)
TIMES = np.linspace(0, 0.5, 501)
RECORD = bd.SampledRotation(TIMES, 40 * np.sin(np.pi * TIMES) ** 2, interpolation="pchip")
RUNS = {
    "on the road": (SHORT_SPIN_UP, 1),
    "tilted": (TILTED, 1),
    "damped": (replace(TILTED, damping_ratio=0.02), 2),
    "gravity": (replace(OUTWARD, motion=bd.SpinUp(60.0, duration=0.3)), 2),
    "in two planes": (replace(TILTED, mount=bd.Mount(0.215, 0.3, 0.4), physics=bd.Physics(planes=2)), 2),
    "a record": (replace(TILTED, motion=RECORD), 1),
}


def run_of(name, at_speeds):
    """A run in modes at rest, or at the slowest and the fastest speed."""
    scene, modes = RUNS[name]
    run = bd.simulate(scene, 0.5, modes, tolerance=1e-7)
    basis = ModalBasis(modes, find_speed_range(scene.motion, 0.5) if at_speeds else (0.0,))
    return replace(run.request, basis=basis).run()


@pytest.mark.parametrize("at_speeds", [False, True])
@pytest.mark.parametrize("name", RUNS)
def test_distance_is_that_from_a_run_with_more_modes(name, at_speeds):
    """Within 15 %, by maxima between samples and by what the passes leave of the coupling; never much below.

    No motion with more modes is integrated for it.
    """
    run = run_of(name, at_speeds)
    distance = run.distance_from(run.request.run_refined())
    assert run.mode_error * run.largest / 2 == pytest.approx(distance, rel=0.15)
    assert "with_more_modes" not in vars(run)
    assert "refined" not in vars(run)


def test_after_an_abrupt_start_more_modes_are_integrated():
    """It makes fast modes ring, of which the path tells no more than the sum of their amplitudes."""
    run = bd.simulate(replace(TILTED, motion=bd.SpinUp(90.0, 0.2, law="linear")), 0.5, 4, tolerance=1e-3)
    distance = run.distance_from(run.request.run_refined())
    assert run.mode_error * run.largest / 2 == pytest.approx(distance, rel=0.15)
    assert "with_more_modes" in vars(run)


@pytest.mark.parametrize(("height", "grows"), [(1e-4, False), (2e-4, True)])
def test_a_motion_that_grows_is_integrated_again(height, grows):
    """Parametric resonance, by a road at twice the first frequency, makes the difference grow as well."""
    radius, speed = 0.3, 60.0
    first = 2 * np.pi * bd.natural_modes(HARVESTER, speed, 1).frequency[0]
    road = bd.RoadWave(wavelength=2 * np.pi * radius / (2 * first / speed - 1), height=height)
    run = bd.simulate(replace(HARVESTER, motion=bd.RollingWheel(radius, speed, road)), 3.0, 1, tolerance=1e-5)
    assert (run.peak(2.25, 3.0) > 2 * run.peak(0.0, 1.5)) == grows
    assert run.mode_error * run.largest / 2 == pytest.approx(
        run.distance_from(run.request.run_refined()), rel=0.15
    )
    assert ("with_more_modes" in vars(run)) == grows


def test_a_mode_that_the_steps_do_not_resolve_is_followed():
    """The third mode of a beam with a tip body has three samples a period; the wave ends near the second."""
    tip = bd.TipMass(4.2547, -0.0021, 0.0431, 0.0208, 0.0482)
    beam = bd.Beam.rectangular(1.0, lambda x: 0.1 * (1 - 0.584 * x), 0.01, 3e9, 7850.0, tip=tip)
    wheel = bd.RollingWheel(2.704, bd.SpinUp(4.154, 7.599), bd.RoadWave(2.992, height=0.003))
    scene = bd.Scene(beam, bd.Mount(0.0, 0.0, -1.37), wheel)
    run = bd.simulate(scene, 13.17)
    assert run.mode_error < 1e-5  # with 3 modes; two miss it by seven times
    few = replace(run.request, basis=ModalBasis(2, (0.0, 4.154))).run()
    assert few.mode_error * few.largest / 2 == pytest.approx(few.distance_from(run), rel=0.15)


@pytest.mark.parametrize(("number", "modes"), [(1058, 5), (1058, 7)])
def test_coupling_of_modes_that_the_mean_of_a_stretch_lacks_is_found(number, modes):
    """A wavy road changes the stiffness: without this coupling the distance is six times too small."""
    given = random_wave_run(np.random.default_rng([7, number]))
    run = bd.simulate(**given | {"modes": modes, "tolerance": 1e-5})
    assert run.mode_error * run.largest / 2 == pytest.approx(
        run.distance_from(run.request.run_refined()), rel=0.15
    )


def test_time_error_counts_what_a_road_turns_from_one_mode_into_another():
    """The road's wave is near the fifth mode, whose error it turns into 30 times the first mode's own."""
    given = random_wave_run(np.random.default_rng([7, 108])) | {"modes": 5, "tolerance": 1e-4}
    run = bd.simulate(**given)
    t = np.linspace(0, given["t_end"], 2000)
    assert find_time_error(run, t) < run.time_error < 100 * find_time_error(run, t)
