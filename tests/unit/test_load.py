"""Results that come back: from a pickle, from other processes, from the files of `save` and ``--json``."""

import dataclasses
import json
import math
import multiprocessing
import pickle
import re
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn import cli as beams
from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.results.result import Result, seal
from beamdyn.common.results.snapshots import LeftOut, decode, encode
from beamdyn.equations.discretization import HINGED
from benchmarks.cases.scenes import AFTER_SHORT_SPIN_UP, HARVESTER, SHORT_SPIN_UP
from brakes import cli as brakes
from brakes.calipers import NAMED
from brakes.drum import BrakeResult

EXAMPLES = Path(__file__).parents[2] / "examples"
MAKERS = {
    "modes": lambda d: bd.natural_modes(SHORT_SPIN_UP, 50.0, 3, d),
    "damped modes": lambda d: bd.natural_modes(
        dataclasses.replace(HARVESTER, damping_ratio=0.02), 170.0, 3, d
    ),
    "locus": lambda d: bd.frequency_locus(HARVESTER, [0.0, 50.0, 170.0], 3, d),
    "critical": lambda d: bd.critical_point(HARVESTER, d),
    "limits": lambda d: bd.setting_angle_limits(HARVESTER, 400.0, d),
    "crossings": lambda d: bd.resonance_speeds(SHORT_SPIN_UP, 100.0, discretization=d),
    "steady": lambda d: bd.steady_response(SHORT_SPIN_UP, [50.0, 170.0], 3, discretization=d),
    "transient": lambda d: bd.simulate(SHORT_SPIN_UP, 0.3, 3, discretization=d),
    "all modes": lambda d: bd.simulate(
        SHORT_SPIN_UP, 0.05, None, discretization={"ritz": bd.Ritz(6), "fem": bd.Fem(6)}[d]
    ),
    "loads in equilibrium": lambda d: bd.static_loads(HARVESTER, [0.0, 50.0], discretization=d),
    "loads of a transient": lambda d: bd.transient_loads(bd.simulate(SHORT_SPIN_UP, 0.1, 2), at=[0.0]),
    "loads of a response": lambda d: bd.steady_loads(bd.steady_response(SHORT_SPIN_UP, [50.0], 2), at=[0.0]),
    "sweep": lambda d: bd.sweep(SHORT_SPIN_UP, [50.0, 53.0], AFTER_SHORT_SPIN_UP, modes=3, discretization=d),
    "bounds": lambda d: bd.frequency_bounds(HARVESTER, 50.0),
    "terms": lambda d: bd.terms(SHORT_SPIN_UP),
    "tradeoff": lambda d: bd.tradeoff(HARVESTER, 50.0, 1, budget=0.1),
    "stroke of a caliper": lambda d: NAMED["dual-pivot"]().build().stroke(finger=40.0),
}
CASES = [
    *((name, "ritz") for name in MAKERS),
    *((name, "fem") for name in ("modes", "transient", "all modes")),
]


def test_a_scene_with_all_physics_comes_back():
    beam = bd.Beam.rectangular(
        0.05, 0.01, 0.0002, 200e9, 7850.0, twist=bd.Table((0, 0.4, 1), (0.1, 0.1, -0.3)), poissons_ratio=0.3
    )
    physics = bd.Physics(planes=2, shear=True, rotary_inertia=True, stretch=True)
    scene = bd.Scene(beam, bd.Mount(0.2, root_stiffness=3.0), physics=physics)
    back = decode(json.loads(json.dumps(encode(scene), allow_nan=False)))
    assert back == scene
    assert back.mount.second_root_stiffness == math.inf


@pytest.fixture(scope="module")
def made():
    kept = {}

    def made(name, discretization="ritz"):
        if (name, discretization) not in kept:
            kept[name, discretization] = MAKERS[name](discretization)
        return kept[name, discretization]

    return made


def differences(one, other, path=""):
    """Places at which two objects differ in a bit; numbers of numpy and Python are one."""
    if isinstance(one, np.ndarray):
        same = one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()
        return [] if same else [path]
    if dataclasses.is_dataclass(one):
        pairs = [(getattr(one, f.name), getattr(other, f.name), f.name) for f in dataclasses.fields(one)]
        same = type(one) is type(other)
    elif isinstance(one, dict):
        pairs, same = [(one[key], other[key], key) for key in one], list(one) == list(other)
    elif isinstance(one, tuple | list):
        same = len(one) == len(other) and type(one) is type(other)
        pairs = list(zip(one, other, range(len(one)), strict=True))
    else:
        return [] if repr(np.asarray(one)[()]) == repr(np.asarray(other)[()]) else [path]
    return [path] if not same else [d for a, b, name in pairs for d in differences(a, b, f"{path}.{name}")]


def check_use(result):
    """Numbers that come from what a result keeps besides its fields."""
    match result:
        case bd.Modes():
            return result.shape(np.linspace(0, result.scene.beam.length, 5))
        case bd.Transient():
            times = np.linspace(0, result.path.end, 5)
            return np.array([result.peak(*times[[1, 3]]), *result.root_strain(times), *result.energy(times)])
        case bd.SteadyResponse():
            return result.tip(np.linspace(0, 6, 7))
    return np.zeros(0)


@pytest.mark.parametrize(("name", "discretization"), CASES)
def test_a_result_comes_back_from_a_pickle(made, name, discretization):
    result = made(name, discretization)
    check_use(result)  # so that it has computed and kept something
    again = pickle.loads(pickle.dumps(result))
    assert not differences(result, again)
    assert check_use(result).tobytes() == check_use(again).tobytes()


@pytest.mark.parametrize(("name", "discretization"), CASES)
def test_a_result_comes_back_from_its_file(made, name, discretization, tmp_path):
    result = made(name, discretization)
    result.save(tmp_path / "result.json")
    again = bd.load(tmp_path / "result.json")
    assert type(again) is type(result)
    assert not differences(result, again)
    assert check_use(result).tobytes() == check_use(again).tobytes()
    assert again.to_json() == result.to_json()
    assert "LeftOut" not in repr(again)


@pytest.mark.parametrize("name", ["transient", "steady"])
def test_the_model_of_a_request_is_chosen_once_and_left_out_of_pickles(made, name):
    request = made(name).request
    assert request.model is request.model
    again = pickle.loads(pickle.dumps(request))
    assert "model" in vars(request) and "model" not in vars(again)
    assert again.model == request.model


@pytest.mark.slow
def test_results_come_back_from_a_pool_of_new_processes(made):
    context = multiprocessing.get_context("spawn")
    calls = [
        partial(bd.natural_modes, SHORT_SPIN_UP, 50.0, 3, "fem"),
        partial(bd.simulate, SHORT_SPIN_UP, 0.3, 3),
        partial(bd.steady_response, SHORT_SPIN_UP, [50.0], 3),
    ]
    with ProcessPoolExecutor(1, mp_context=context) as pool:
        modes, run, steady = (pool.submit(call).result(timeout=120) for call in calls)
    assert modes.frequency.tobytes() == made("modes", "fem").frequency.tobytes()
    assert check_use(modes) == pytest.approx(check_use(made("modes", "fem")), rel=1e-12)
    assert run.peak(0.1, 0.3) == made("transient").peak(0.1, 0.3)
    assert steady.amplitude[0] == pytest.approx(made("steady").amplitude[0], rel=1e-12)


def test_a_computed_error_is_kept_in_the_file(made, tmp_path, monkeypatch):
    run = made("transient")
    run.save(tmp_path / "run.json")
    monkeypatch.setattr("beamdyn.transient.transient.TransientRequest.run_refined", None)  # not to be called
    assert bd.load(tmp_path / "run.json").mode_error == run.mode_error > 0


def test_the_error_by_modes_left_out_of_a_periodic_motion_is_in_the_file(tmp_path):
    """The loaded result, which cannot be solved again, called it inf."""
    motion = bd.PulsatingRotation(50.0, fluctuation=0.1, frequency=123.9)
    scene = bd.Scene(HARVESTER.beam, HARVESTER.mount, motion)
    found = bd.floquet_multipliers(scene, modes=1)
    found.save(tmp_path / "floquet.json")
    again = bd.load(tmp_path / "floquet.json")
    assert again.mode_error == found.mode_error < np.inf
    assert again.to_table() == found.to_table()


def test_a_loaded_transient_is_refined(made, tmp_path):
    run = made("transient")
    run.save(tmp_path / "run.json")
    again = bd.load(tmp_path / "run.json")
    # the mode error is found along the path of the run: tests/invariants/test_modes_along_path.py
    distance = run.distance_from(run.refined)
    assert distance > 0 and again.distance_from(again.refined) == pytest.approx(distance, rel=1e-6)


def test_numbers_that_are_not_finite_come_back(tmp_path):
    point = bd.critical_point(bd.Scene(HARVESTER.beam, bd.Mount(1.0, math.pi)))
    point.save(tmp_path / "p.json")
    assert math.isinf(point.speed) and bd.load(tmp_path / "p.json") == point
    assert json.loads((tmp_path / "p.json").read_text())["speed"] is None


@pytest.mark.parametrize("command", ["modes", "critical", "terms"])
def test_what_a_command_wrote_is_loaded(command, tmp_path, capsys):
    path = tmp_path / "result.json"
    assert beams.main([command, str(EXAMPLES / "tyre_harvester.toml"), "--json", str(path)]) == beams.DONE
    result = bd.load(path)
    assert result.provenance.version == bd.__version__
    assert json.loads(path.read_text())["provenance"]["method"] == result.provenance.method
    if command != "critical":
        assert result.scene == bd.load_scene(EXAMPLES / "tyre_harvester.toml")


def test_what_a_command_on_brakes_wrote_is_loaded(tmp_path, capsys):
    path, drum = tmp_path / "result.json", str(EXAMPLES / "drum.toml")
    assert brakes.main(["drum", drum, "--json", str(path)]) == beams.DONE
    result = bd.load(path)
    assert isinstance(result, BrakeResult)
    assert float(result.torque) == json.loads(path.read_text())["torque"]
    sweep = ("drum", drum, "--vary", "brake.friction=0.2:0.4:3", "--json", str(path), "--force")
    assert brakes.main([*sweep]) == beams.DONE
    assert isinstance(bd.load(path), InputSweep)
    assert brakes.main(["caliper", "dual-pivot", "--json", str(path), "--force"]) == beams.DONE
    with pytest.raises(ValueError, match=r"result\.json: no result can be loaded: it has numbers only"):
        bd.load(path)


# Files that are not what was written --------------------------------------------------------------


@pytest.fixture
def saved(made, tmp_path):
    path = tmp_path / "modes.json"
    made("modes").save(path)
    return path


EDITS = {
    "a number": (lambda text: text.replace('"speed": 50.0', '"speed": 51.0'), "was changed"),
    "cut off": (lambda text: text[:-40], "not whole"),
    "empty": (lambda text: "", "not whole"),
    "by another program": (lambda text: '{"speed": 50.0}', "another program"),
    "a list": (lambda text: "[1, 2]", "another program"),
    "deep": (lambda text: "[" * 100_000, "not whole"),
    "other fields": (lambda text: reseal(text, '"axial_strain"', '"strain"'), "Modes has other fields"),
    "another class": (lambda text: reseal(text, "modes:Modes", "modes:Nodes"), "no class Nodes"),
    "a foreign class": (
        lambda text: reseal(text, "beamdyn.modes.modes:Modes", "os:_wrap_close"),
        "no class",
    ),
    "a function": (lambda text: reseal(text, "modes:Modes", "modes:natural_modes"), "no class natural_modes"),
}


def reseal(text, old, new):
    content = json.loads(text)
    record = json.loads(json.dumps(content["record"]).replace(old, new))
    del content["schema"], content["checksum"]
    return json.dumps(seal(content | {"record": record}))


def test_a_file_that_is_not_there_is_refused_in_a_sentence(tmp_path):
    with pytest.raises(
        FileNotFoundError, match=r"none\.json: no result can be loaded: there is no such file; "
    ):
        bd.load(tmp_path / "none.json")
    with pytest.raises(
        OSError, match=r"no result can be loaded: .*; give one that save or --json has written"
    ):
        bd.load(tmp_path)


@pytest.mark.parametrize("edit", EDITS)
def test_a_file_that_is_not_as_written_is_refused_in_a_sentence(saved, edit):
    change, reason = EDITS[edit]
    saved.write_text(change(saved.read_text()))
    with pytest.raises(ValueError, match=reason) as caught:
        bd.load(saved)
    assert str(saved) in str(caught.value) and "compute the result again" in str(caught.value)


def test_the_numbers_stay_readable_for_other_programs(saved, made):
    written = json.loads(saved.read_text())
    assert written["frequency"] == made("modes").frequency.tolist()
    assert list(written)[-3:] == ["record", "schema", "checksum"]


@pytest.mark.parametrize("wrong", [5, None, b"modes.json", 1.5])
def test_what_is_no_path_is_refused_by_name(made, wrong):
    for call in (bd.load, made("modes").save):
        with pytest.raises(ValueError, match=r"^path = .*: give the name of a file, as text or path$"):
            call(wrong)


def test_save_keeps_a_file_that_exists_unless_forced(saved, made):
    with pytest.raises(FileExistsError):
        made("locus").save(saved)
    made("locus").save(saved, force=True)
    assert isinstance(bd.load(saved), bd.Locus)


@dataclasses.dataclass(frozen=True)
class OwnResult(Result):
    value: float


def test_a_result_of_the_users_own_has_numbers_only(tmp_path):
    OwnResult(1.5).save(tmp_path / "own.json")
    assert json.loads((tmp_path / "own.json").read_text())["value"] == 1.5
    with pytest.raises(ValueError, match=r"OwnResult of .* is none of beamdyn"):
        bd.load(tmp_path / "own.json")


# What is no data ----------------------------------------------------------------------------------


def angle(t):
    return 20 * t**2


def rate(t):
    return 40 * t


def acceleration(t):
    return np.full(np.shape(t), 40.0)


def test_a_function_is_left_out_and_says_so_where_it_is_used(tmp_path):
    scene = dataclasses.replace(HARVESTER, motion=bd.RotationFunction(angle, rate, acceleration, t_end=1.0))
    modes = bd.natural_modes(scene, 50.0)
    modes.save(tmp_path / "m.json")
    again = bd.load(tmp_path / "m.json")
    assert again.frequency.tobytes() == modes.frequency.tobytes()
    assert check_use(again).tobytes() == check_use(modes).tobytes()
    with pytest.raises(ValueError, match=r"does not hold angle of tests\.unit\.test_load"):
        again.scene.motion.at(np.zeros(1))
    assert pickle.loads(pickle.dumps(modes)).scene.motion.at(np.ones(1)).speed == 40.0


def test_the_interpolation_of_solve_ivp_is_left_out(tmp_path):
    run = bd.simulate(SHORT_SPIN_UP, 0.1, 2, method="RK45")
    run.save(tmp_path / "r.json")
    again = bd.load(tmp_path / "r.json")
    assert again.tip.tobytes() == run.tip.tobytes() and again.mode_error == run.mode_error
    with pytest.raises(ValueError, match="does not hold OdeSolution"):
        again.peak(0.0, 0.1)
    assert pickle.loads(pickle.dumps(run)).peak(0.0, 0.1) == run.peak(0.0, 0.1)


@pytest.mark.parametrize(
    "value",
    [
        *(None, True, 7, -0.0, 5e-324, math.inf, "ω", 1 - 2j, complex(math.nan, math.inf), slice(0, 3)),
        *((), (1, (2.0, "a")), [1, [2]], {"a": {"b": (1,)}}, np.zeros((0, 2)), np.array(["stable", ""])),
        *(np.array(3.0), np.array([[1 + 2j]]), np.array([True]), np.arange(4, dtype="u1")),
        HINGED,
    ],
    ids=repr,
)
def test_data_comes_back_to_the_bit(value):
    again = decode(json.loads(json.dumps(encode(value))))
    assert type(again) is type(value) and not differences(value, again)


def test_what_is_left_out_can_be_pickled_and_printed():
    part = pickle.loads(pickle.dumps(LeftOut("f of module")))
    assert "f of module" in repr(part)
    with pytest.raises(ValueError, match="f of module"):
        part.at(0.0)


def writable_arrays(holder, path=""):
    """Places of arrays in the public fields of a result that can be written."""
    if isinstance(holder, np.ndarray):
        return [path] if holder.flags.writeable else []
    if dataclasses.is_dataclass(holder):
        items = [(f.name, getattr(holder, f.name)) for f in dataclasses.fields(holder) if f.repr]
    elif isinstance(holder, dict):
        items = [*holder.items()]
    else:
        items = [*enumerate(holder)] if isinstance(holder, tuple) else []
    return [place for name, item in items for place in writable_arrays(item, f"{path}.{name}")]


@pytest.mark.parametrize(("name", "discretization"), CASES)
def test_no_array_of_a_result_can_be_written(made, tmp_path, name, discretization):
    result = made(name, discretization)
    result.save(tmp_path / "r.json")
    for each in (result, pickle.loads(pickle.dumps(result)), bd.load(tmp_path / "r.json")):
        assert writable_arrays(each) == []


def test_every_result_is_made_read_only_by_the_base_class():
    def below(kind):
        return [each for child in kind.__subclasses__() for each in (child, *below(child))]

    for kind in below(Result):
        assert kind.__post_init__ is Result.__post_init__, kind
        assert kind.__setstate__ is Result.__setstate__, kind


def test_arrays_of_the_caller_stay_writable():
    speeds = np.array([0.0, 50.0])
    locus = bd.frequency_locus(HARVESTER, speeds, 1)
    with pytest.raises(ValueError, match="read-only"):
        locus.speeds[0] = 1.0
    speeds[0] = 1.0
    assert locus.speeds[0] == 0.0


def test_a_record_of_an_earlier_version_makes_the_same_result() -> None:
    """Its modules stood in other rooms, and its physics had neither camber nor torsion."""
    modes = bd.natural_modes(bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0)), modes=2)
    text = json.dumps(encode(modes))
    for now, before in (("beamdyn.modes.modal.", "beamdyn.modal."), ("beamdyn.modes.", "beamdyn.spectrum.")):
        text = text.replace(now, before)
    without = re.sub(r', "(camber|torsion)": false', "", text)
    assert text != json.dumps(encode(modes)) and "camber" not in without
    again = decode(json.loads(without))
    assert type(again) is bd.Modes and again.scene == modes.scene
    np.testing.assert_array_equal(again.frequency, modes.frequency)


def test_a_class_of_another_package_is_not_imported(tmp_path, monkeypatch) -> None:
    (tmp_path / "of_a_stranger.py").write_text("raise AssertionError('it was imported')")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(ValueError, match="no class Trap"):
        decode({"object": ["of_a_stranger:Trap", {}]})
