"""The sweep: its answers, and what it refuses before it begins."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.edge.views import rows_of
from beamdyn.scene.motion.base import MotionSample
from beamdyn.transient.step_size import TooManySteps
from benchmarks.cases.scenes import AFTER_SHORT_SPIN_UP, HARVESTER, SHORT_SPIN_UP

SCENE, WINDOW = SHORT_SPIN_UP, AFTER_SHORT_SPIN_UP
MOTION = SCENE.motion
SPEEDS = [0.0, 30.0, 53.0, 140.0]


@pytest.fixture(scope="module")
def found():
    return bd.sweep(SCENE, SPEEDS, WINDOW, modes=5)


def test_peaks_are_those_of_single_transients(found):
    for speed, peak, largest, error in zip(SPEEDS, found.peaks, found.largest, found.time_error, strict=True):
        run = bd.simulate(replace(SCENE, motion=MOTION.with_speed(speed)), WINDOW[1], 5, 1e-8)
        assert abs(peak - run.peak(*WINDOW)) <= error + 1e-6 * peak
        assert error <= 1e-5 * largest
        assert abs(largest - run.largest) <= error + 1e-6 * largest
    assert found.peaks[0] == 0
    assert found.status == ("done",) * 4


@pytest.mark.parametrize(
    "speeds", [(1.0, 90.0), pytest.param((1.0, 20.0, 60.0, 90.0), marks=pytest.mark.slow)]
)
@pytest.mark.parametrize(
    ("law", "tolerance", "two_speeds"),
    [("smooth", 1e-3, True), ("linear", 2e-4, False), ("linear", 1e-4, False)],
)
def test_chosen_modes_leave_out_no_more_than_is_stated(law, tolerance, two_speeds, speeds):
    """Modes at two speeds or, of an abrupt start at tight tolerances, at rest."""
    spun = replace(SCENE, motion=bd.SpinUp(55.0, 0.2, law=law), mount=bd.Mount(0.215, 1.0))
    found = bd.sweep(spun, speeds, WINDOW, tolerance=tolerance)
    assert ("rad/s" in found.provenance.method) == two_speeds
    for speed, peak, largest, error in zip(
        found.speeds, found.peaks, found.largest, found.time_error, strict=True
    ):
        run = bd.simulate(replace(spun, motion=spun.motion.with_speed(speed)), WINDOW[1], 12, 1e-5)
        assert abs(peak - run.peak(*WINDOW)) <= error + found.mode_error * largest


@pytest.mark.parametrize(("angle", "fastest", "tolerance"), [(1.0, 90.0, 3e-4), (2.0, 200.0, 5e-4)])
def test_modes_at_rest_are_taken_where_they_suffice_for_all_cases(angle, fastest, tolerance):
    """Alone the slow case takes modes at rest, the fast one at two speeds, which are more coordinates."""
    abrupt = replace(SCENE, motion=bd.SpinUp(55.0, 0.2, law="linear"), mount=bd.Mount(0.215, angle))
    scenes = [replace(abrupt, motion=abrupt.motion.with_speed(speed)) for speed in (1.0, fastest)]
    slow, fast = (bd.simulate(scene, WINDOW[1], tolerance=tolerance) for scene in scenes)
    assert slow.request.basis.is_at_rest and not fast.request.basis.is_at_rest
    at_rest = bd.simulate(scenes[1], WINDOW[1], slow.request.basis.modes, tolerance)
    suffices = at_rest.mode_error <= tolerance
    found = bd.sweep(abrupt, (1.0, fastest), WINDOW, tolerance=tolerance)
    assert found.mode_error <= tolerance
    assert ("rad/s" in found.provenance.method) != suffices
    assert suffices == (angle == 1.0)  # both outcomes are seen


def test_model_error_is_that_of_the_worst_case_with_the_modes_of_the_sweep():
    rough = bd.sweep(SCENE, SPEEDS[1:3], (0.0, WINDOW[1]), modes=1, tolerance=1e-3)
    worst = replace(SCENE, motion=MOTION.with_speed(float(rough.left_out_speeds[0])))
    alone = bd.simulate(worst, WINDOW[1], 1, 1e-3)
    changes = rough.left_out_effects.changes
    assert any(changes.values()) and changes == alone.left_out_effects.changes


def test_tables_and_columns_have_the_error_of_the_modes(found):
    """Half a unit of the last digit that is printed is not below both errors; 0 deflects by none."""
    rough = replace(found, mode_error=2e-3)
    np.testing.assert_array_equal(rough.peak_error, found.time_error + 2e-3 * found.largest)
    shown = {line.split()[0]: line.split()[1] for line in rough.to_table().splitlines() if "done" in line}
    for speed, error in zip(SPEEDS[1:], rough.peak_error[1:], strict=True):
        assert 10.0 ** -len(shown[f"{speed:g}"].partition(".")[2]) / 2 >= 1e3 * error
    heads, *rows = rows_of(rough)
    of_modes = [row[heads.index("mode_error_m")] for row in rows]
    np.testing.assert_allclose(of_modes, 2e-3 * found.largest, rtol=0, atol=1e-15)
    unknown = replace(found, mode_error=np.inf)
    assert unknown.peak_error[0] == 0 and np.isinf(unknown.peak_error[1:]).all()
    assert "unresolved" in repr(unknown) and "unresolved" in unknown.to_table()


def test_finite_elements_agree(found):
    fem = bd.sweep(SCENE, SPEEDS, WINDOW, modes=5, discretization="fem")
    assert fem.peaks == pytest.approx(found.peaks, rel=1e-4)


def test_a_later_end_adds_to_the_run_only(found):
    longer = bd.sweep(SCENE, SPEEDS, WINDOW, modes=5, t_end=0.6)
    assert longer.peaks == pytest.approx(found.peaks, rel=3e-5)
    assert (longer.largest >= 0.99 * found.largest).all()


@pytest.mark.parametrize("given", [{"chunk": 2}, {"speeds": [30.0, 53.0]}, {"speeds": [30.0, 53.0, 155.0]}])
@pytest.mark.parametrize("options", [{"modes": 5}, {"tolerance": 1e-3}])
def test_other_speeds_and_chunks_change_a_case_within_its_errors_only(given, options):
    one = bd.sweep(SCENE, SPEEDS, WINDOW, **options)
    other = bd.sweep(**{"scene": SCENE, "speeds": SPEEDS, "window": WINDOW} | options | given)
    _, i, j = np.intersect1d(one.speeds, other.speeds, return_indices=True)
    truncation = 0.0 if "modes" in options else (one.mode_error + other.mode_error) * one.largest[i]
    bound = one.time_error[i] + other.time_error[j] + truncation
    assert (np.abs(one.peaks[i] - other.peaks[j]) <= bound).all()
    assert (np.abs(one.largest[i] - other.largest[j]) <= bound).all()


def test_a_case_too_large_for_memory_is_refused(monkeypatch):
    def check(steps, size, t_end):
        raise TooManySteps("t_end", t_end, "too many")

    monkeypatch.setattr("beamdyn.transient.integration.check_number_of_steps", check)
    with pytest.raises(ValueError, match="too many"):
        bd.sweep(SCENE, SPEEDS, WINDOW, modes=5)


@pytest.mark.parametrize("given", [{"chunk": 1}, {"chunk": 3}, {"speeds": [30.0, 53.0]}])
def test_other_speeds_and_chunks_do_not_change_a_bit_of_a_case(found, given):
    """Each case takes its own steps; with a given number of modes nothing is shared."""
    other = bd.sweep(**{"scene": SCENE, "speeds": SPEEDS, "window": WINDOW, "modes": 5} | given)
    _, i, j = np.intersect1d(found.speeds, other.speeds, return_indices=True)
    for name in ("peaks", "largest", "time_error"):
        np.testing.assert_array_equal(getattr(found, name)[i], getattr(other, name)[j])


@pytest.mark.slow
def test_modes_that_miss_the_tolerance_are_named():
    sudden = replace(SCENE, motion=bd.SpinUp(55.0, 1e-9), mount=bd.Mount(0.215, 0.3))
    found = bd.sweep(sudden, [30.0], (0.005, 0.01))
    assert found.mode_error > 1e-5
    assert any("1e-05 is not reached" in w and "modal truncation error" in w for w in found.warnings)


def test_progress_begins_and_ends(found):
    calls = []
    bd.sweep(SCENE, SPEEDS, WINDOW, chunk=2, progress=lambda *call: calls.append(call))
    assert calls == [(0, 4), (2, 4), (4, 4)]


def test_what_is_stored_counts_as_progress(tmp_path):
    calls = []
    for _ in range(2):
        calls.clear()
        bd.sweep(SCENE, SPEEDS, WINDOW, chunk=2, store=tmp_path, progress=lambda *call: calls.append(call))
        assert calls == [(0, 4), (2, 4), (4, 4)]


def test_result_is_saved_and_drawn(found, tmp_path):
    found.save(tmp_path / "sweep.json")
    saved = json.loads((tmp_path / "sweep.json").read_text())
    assert saved["peaks"] == found.peaks.tolist()
    assert saved["window"] == list(WINDOW)
    assert found.plot().lines[0].get_ydata() == pytest.approx(1e3 * found.peaks)


def test_limits_of_the_model_are_named():
    rough = replace(SCENE, motion=replace(MOTION, road=bd.RoadWave(0.3, velocity_amplitude=3.0)))
    warnings = " ".join(bd.sweep(rough, SPEEDS, WINDOW, modes=2).warnings)
    assert "outside linear theory" in warnings
    assert "leaves the road" in warnings


def user_motion(t):
    return MotionSample(t, t, t, np.zeros((*t.shape, 3)))


BAD = {
    "empty": ({"speeds": []}, r"speeds = \[\]: it is empty"),
    "descending": ({"speeds": [2.0, 1.0]}, "must ascend"),
    "critical": ({"speeds": [10.0, 159.0, 160.0, 170.0]}, r"2 of 4 \(160 to 170 rad/s\).*159\.818"),
    "window past the end": ({"t_end": 0.4}, "lie in the run"),
    "window before 0": ({"window": (-0.1, 0.3)}, "lie in the run"),
    "window turned": ({"window": (0.5, 0.3)}, "must begin before it ends"),
    "window of one": ({"window": 0.5}, "its beginning and its end"),
    "window of text": ({"window": ("a", 0.5)}, "finite number"),
    "window without end": ({"window": (0, np.inf)}, r"window\[1\] = inf s: give a finite number"),
    "window without beginning": ({"window": (np.nan, 1.0)}, r"window\[0\] = nan s: give a finite number"),
    "t_end": ({"t_end": -1.0}, "greater than 0"),
    "modes": ({"modes": 0}, "whole number of 1"),
    "tolerance": ({"tolerance": 0.0}, "from 1e-12"),
    "workers": ({"workers": 0}, "whole number of 1"),
    "chunk": ({"chunk": 1.5}, "whole number of 1"),
    "method": ({"discretization": "finite"}, "give 'ritz', 'fem'"),
    "no motion": ({"scene": HARVESTER}, "needs a motion"),
    "other speeds unknown": ({"scene": replace(SCENE, motion=bd.UserMotion(user_motion))}, "one speed only"),
    "motion ends": (
        {"scene": replace(SCENE, motion=bd.SampledRotation([0.0, 0.1, 0.2, 0.3], [0.0, 1.0, 3.0, 3.0]))},
        "the motion ends at 0.3",
    ),
}


@pytest.mark.parametrize(("given", "message"), BAD.values(), ids=BAD)
def test_bad_input_is_refused_before_any_work(given, message, tmp_path, monkeypatch):
    monkeypatch.setattr("beamdyn.transient.sweep.solve_chunk", None)  # not to be called
    store = tmp_path / "store"
    with pytest.raises(ValueError, match=message):
        bd.sweep(**{"scene": SCENE, "speeds": SPEEDS, "window": WINDOW, "store": store} | given)
    assert not store.exists()


def test_workers_and_an_executor_are_one_too_many():
    with pytest.raises(ValueError, match="give one of them"):
        bd.sweep(SCENE, SPEEDS, WINDOW, workers=2, executor=SimpleNamespace(submit=None))


@pytest.mark.parametrize("content", ["directory", "file", "below a file"])
def test_foreign_and_unwritable_stores_are_refused_before_any_work(content, tmp_path, monkeypatch):
    monkeypatch.setattr("beamdyn.transient.sweep.solve_chunk", None)
    (tmp_path / "notes.txt").write_text("mine")
    store = {
        "directory": tmp_path,
        "file": tmp_path / "notes.txt",
        "below a file": tmp_path / "notes.txt" / "s",
    }
    with pytest.raises(ValueError, match="an earlier store"):
        bd.sweep(SCENE, SPEEDS, WINDOW, store=store[content])
    assert (tmp_path / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize("damage", ["edited", "of an earlier version"])
def test_a_damaged_record_is_computed_again_and_named(damage, tmp_path):
    whole = bd.sweep(SCENE, [10.0, 20.0], WINDOW, chunk=1, store=tmp_path)
    file = min(path for path in tmp_path.iterdir() if path.name != "store.json")
    record = json.loads(file.read_text())
    record["result"]["list"][0]["object"][1]["peak"] *= 2
    if damage == "of an earlier version":
        record = {"result": record["result"]}
    file.write_text(json.dumps(record))
    again = bd.sweep(SCENE, [10.0, 20.0], WINDOW, chunk=1, store=tmp_path)
    assert again.peaks.tolist() == whole.peaks.tolist()
    (warning,) = (w for w in again.warnings if w not in whole.warnings)
    assert str(file) in warning and "checksum" in warning and "computed again" in warning
    mended = bd.sweep(SCENE, [10.0, 20.0], WINDOW, chunk=1, store=tmp_path)
    assert mended.warnings == whole.warnings


def of_lambdas():
    speed = bd.RotationFunction(lambda t: 20 * t**2, lambda t: 40 * t, lambda t: 40.0, t_end=0.5)
    return replace(SCENE, motion=replace(MOTION, speed=speed))


def test_lambdas_work_in_memory():
    assert bd.sweep(of_lambdas(), [10.0, 20.0], WINDOW, modes=2).status == ("done", "done")


@pytest.mark.parametrize("where", ["store", "workers", "executor"])
def test_lambdas_are_refused_by_stores_and_pools(where, tmp_path):
    given = {"store": tmp_path / "store", "workers": 2, "executor": SimpleNamespace(submit=None)}
    with pytest.raises(ValueError, match="def at the top of a module"):
        bd.sweep(of_lambdas(), [10.0, 20.0], WINDOW, **{where: given[where]})
    assert not (tmp_path / "store").exists()


@pytest.mark.slow
def test_peaks_in_two_planes_are_those_of_single_transients(tmp_path):
    """The magnitude of a vector and its components; a store keeps them; a plane without loads stays."""
    beam = bd.Beam.from_stiffness(1.2, 2.0, 60.0, second_bending_stiffness=900.0, twist=0.5)
    mount = bd.Mount(0.3, 2.6, np.pi / 2)
    motion = bd.SpinUp(9.0, 0.3)
    scene = bd.Scene(beam, mount, motion, damping_ratio=0.01, physics=bd.Physics(planes=2))
    for given in (scene, replace(scene, beam=replace(beam, twist=None))):
        found = bd.sweep(given, [3.0, 7.0, 9.0], (0.2, 0.5), modes=4, store=tmp_path)
        again = bd.sweep(given, [3.0, 7.0, 9.0], (0.2, 0.5), modes=4, store=tmp_path)
        assert again.peaks_by_direction.tobytes() == found.peaks_by_direction.tobytes()
        assert found.peaks_by_direction.shape == (3, 2)
        for k, speed in enumerate(found.speeds):
            run = bd.simulate(replace(given, motion=motion.with_speed(speed)), 0.5, 4, 1e-8)
            allowed = found.time_error[k] + 1e-8 * run.largest
            assert abs(found.peaks[k] - run.peak(0.2, 0.5)) <= allowed
            for direction in (0, 1):
                peak = run.peak(0.2, 0.5, direction)
                assert abs(found.peaks_by_direction[k, direction] - peak) <= allowed
            assert found.peaks[k] >= found.peaks_by_direction[k].max() > 0
    assert not found.peaks_by_direction[:, 0].any()  # straight, and out of the plane
    labels = [text.get_text() for text in found.plot().get_legend().get_texts()]
    assert labels == ["magnitude", "out of the plane of rotation (flap)", "in the plane of rotation (edge)"]


def test_a_beam_loaded_at_its_tip_is_not_run_again_for_a_model_error_that_is_not_known(monkeypatch):
    scene = bd.Scene(
        HARVESTER.beam,
        bd.Mount(0.215, np.pi),
        bd.SpinUp(20.0, 0.005),
        physics=bd.Physics(large_deflection=True),
        tip_load=bd.TipLoad(force=(0.0, 0.01, 0.0)),
    )
    found = bd.sweep(scene, [10.0], window=(0.0, 0.01), modes=1)
    monkeypatch.setattr("beamdyn.transient.sweep.simulate", None)  # with all its modes it takes minutes
    assert "no load at its tip" in found.left_out_effects.not_known["stretch"]
    assert found.model_error.shape == (1,)
