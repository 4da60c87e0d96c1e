"""Every file that a command writes: whole or not at all, never over an input, tried before any long work."""

import os
import resource
from contextlib import contextmanager
from pathlib import Path

import pytest

from beamdyn import cli as beams
from beamdyn.common.results.files import check_writable, replacing, same_file, write_text
from beamdyn.common.results.pictures import save_animation
from brakes import cli as brakes

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
SCENE = EXAMPLES / "tyre_harvester.toml"
MODES = (beams, "modes", SCENE, "--modes", "1")
SIMULATE = (beams, "simulate", EXAMPLES / "rolling_harvester.toml", "--t-end", "0.2 s", "--modes", "2")
CALIPER = (brakes, "caliper", "dual-pivot")
WRITERS = {
    **{
        f"modes {o}{s}": (*MODES, o, s)
        for o, s in (("--json", ".json"), ("--csv", ".csv"), ("--report", ".html"))
    },
    **{f"modes --plot{s}": (*MODES, "--plot", s) for s in (".png", ".svg", ".pdf")},
    **{f"modes --shapes{s}": (*MODES, "--shapes", s) for s in (".vtu", ".vtk")},
    **{f"simulate {o}{s}": (*SIMULATE, o, s) for o, s in (("--series", ".xdmf"), ("--animation", ".gif"))},
    "caliper --free-bodies.svg": (*CALIPER, "--free-bodies", ".svg"),
}


@contextmanager
def full_disk():
    """No file can grow past 100 bytes."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.fixture(autouse=True)
def few_frames(monkeypatch):
    monkeypatch.setattr("beamdyn.analyses.about_motion._FRAMES", 3)


@pytest.fixture
def run(capsys):
    def run(program, *arguments):
        code = program.main([str(a) for a in arguments])
        return code, *capsys.readouterr()

    return run


def call(run, writer, path):
    program, *arguments, _ = WRITERS[writer]
    return run(program, *arguments, path, "--force")


@pytest.mark.parametrize("writer", WRITERS)
def test_a_full_disk_leaves_the_old_file_and_is_said(run, writer, tmp_path):
    path = tmp_path / f"result{WRITERS[writer][-1]}"
    path.write_text("old")
    with full_disk():
        code, _, err = call(run, writer, path)
    assert code == beams.BAD_INPUT
    assert f"{path}: it could not be written (File too large); the file that was there is unchanged" in err
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    assert path.read_text() == "old"
    assert call(run, writer, path)[0] == beams.DONE
    assert path.stat().st_size > 100 and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("writer", WRITERS)
def test_an_interrupt_leaves_the_old_file_and_is_said(run, writer, tmp_path, monkeypatch):
    def interrupt(_):
        raise KeyboardInterrupt

    path = tmp_path / f"result{WRITERS[writer][-1]}"
    path.write_text("old")
    monkeypatch.setattr("os.fsync", interrupt)
    code, _, err = call(run, writer, path)
    assert code == beams.INTERRUPTED
    assert f"interrupted: {path} is not written; the file that was there is unchanged" in err
    assert path.read_text() == "old" and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("frames", [0, 2])
def test_an_interrupt_between_frames_leaves_no_animation(frames, tmp_path):
    from matplotlib.figure import Figure

    def draw():
        yield from range(frames)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match=r"a\.gif is not written"):
        save_animation(Figure(), tmp_path / "a.gif", draw(), 50, 20)
    assert not list(tmp_path.iterdir())


# Inputs and other outputs -------------------------------------------------------------------------


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE.read_text())
    return path


@pytest.mark.parametrize(
    "spelling", ["itself", "another spelling", "a link", "a hard link", "a linked folder"]
)
def test_an_output_that_would_destroy_the_input_is_refused(run, scene, spelling):
    folder = scene.parent
    (folder / "link.csv").symlink_to(scene)
    os.link(scene, folder / "hard.csv")
    (folder / "below").symlink_to(folder)
    path = {
        "itself": scene,
        "another spelling": folder / ".." / folder.name / "scene.toml",
        "a link": folder / "link.csv",
        "a hard link": folder / "hard.csv",
        "a linked folder": folder / "below" / "scene.toml",
    }[spelling]
    code, out, err = run(beams, "modes", scene, "--csv", path, "--force")
    assert (code, out) == (beams.BAD_INPUT, "")
    assert "--csv" in err and str(path) in err and "the command itself needs" in err
    assert scene.read_text() == SCENE.read_text()


def test_an_output_of_brakes_that_would_destroy_the_input_is_refused(run, tmp_path):
    path = tmp_path / "drum.toml"
    path.write_text((EXAMPLES / "drum.toml").read_text())
    code, _, err = run(brakes, "drum", path, "--json", path, "--force")
    assert code == beams.BAD_INPUT and "--json" in err
    assert path.read_text() == (EXAMPLES / "drum.toml").read_text()


def test_two_outputs_that_are_one_file_are_refused(run, scene):
    (scene.parent / "x.svg").write_text("old")
    (scene.parent / "y.csv").symlink_to("x.svg")
    code, _, err = run(
        beams, "modes", scene, "--plot", scene.parent / "x.svg", "--csv", scene.parent / "y.csv", "--force"
    )
    assert code == beams.BAD_INPUT and "--plot and --csv" in err and "its own file" in err
    one, other = scene.parent / "new.json", scene.parent / ".." / scene.parent.name / "new.json"
    assert "its own file" in run(beams, "modes", scene, "--json", one, "--csv", other)[2]


def test_an_output_in_the_store_is_refused(run, tmp_path):
    (tmp_path / "store").mkdir()
    sweep = ("sweep", EXAMPLES / "rolling_harvester.toml", "--speeds", "1 rad/s", "--window", "0:0.1 s")
    for path in (tmp_path / "store" / "x.json", tmp_path / "new"):
        store = tmp_path / "store" if path.suffix else path
        code, _, err = run(beams, *sweep, "--store", store, "--json", path)
        assert code == beams.BAD_INPUT and "--json" in err


# Paths are tried first ----------------------------------------------------------------------------

EARLY = {
    "modes": (*MODES, "--json"),
    "critical": (beams, "critical", SCENE, "--json"),
    "terms": (beams, "terms", SCENE, "--json"),
    "simulate": (*SIMULATE, "--csv"),
    "drum": (brakes, "drum", EXAMPLES / "drum.toml", "--json"),
    "reproduce": (beams, "reproduce", "--output"),
    "brakes reproduce": (brakes, "reproduce", "--output"),
}


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="nobody can write in /proc")
@pytest.mark.parametrize("command", EARLY)
def test_a_path_that_cannot_be_written_is_refused_before_the_table(run, command):
    *arguments, option = EARLY[command]
    code, out, err = run(*arguments, option, "/proc/x")
    assert (code, out) == (beams.BAD_INPUT, "")
    assert f"{option} = /proc/x" in err and "cannot be written" in err and err.count("\n") == 1


def test_a_name_that_is_too_long_is_refused(run, tmp_path):
    code, out, err = run(*MODES, "--json", tmp_path / ("x" * 300))
    assert (code, out) == (beams.BAD_INPUT, "") and "--json" in err and "too long" in err


def test_an_unknown_suffix_of_free_bodies_is_refused_before_the_table(run, tmp_path):
    code, out, err = run(*CALIPER, "--free-bodies", tmp_path / "x.jpg")
    assert (code, out) == (beams.BAD_INPUT, "") and "--free-bodies" in err


# Links, devices, permissions ----------------------------------------------------------------------


def test_a_link_stays_and_its_file_is_replaced(tmp_path):
    (tmp_path / "data").mkdir()
    file, link = tmp_path / "data" / "file.json", tmp_path / "link.json"
    file.write_text("old")
    link.symlink_to(file)
    write_text(link, "new")
    assert link.is_symlink() and file.read_text() == "new"
    assert len(list(tmp_path.rglob("*"))) == 3


def test_a_link_to_nothing_makes_its_file(tmp_path):
    (tmp_path / "link").symlink_to("file")
    write_text(check_writable(tmp_path / "link"), "new")
    assert (tmp_path / "file").read_text() == "new"


def test_permissions_stay_and_new_files_have_the_usual_ones(tmp_path):
    (tmp_path / "old").write_text("old")
    (tmp_path / "old").chmod(0o640)
    (tmp_path / "usual").touch()
    for name in ("old", "new"):
        write_text(tmp_path / name, "new")
    assert (tmp_path / "old").stat().st_mode & 0o777 == 0o640
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "usual").stat().st_mode


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such devices")
def test_devices_are_written_as_they_are(run):
    before = os.stat("/dev/null")
    assert run(*MODES, "--json", "/dev/null")[0] == beams.DONE
    assert os.stat("/dev/null").st_rdev == before.st_rdev
    code, _, err = run(*MODES, "--json", "/dev/full")
    assert code == beams.BAD_INPUT and "/dev/full" in err and "No space left" in err


def test_a_name_that_is_no_unicode_can_be_in_a_report(run, tmp_path):
    scene, report = tmp_path / os.fsdecode(b"sc\xff.toml"), tmp_path / "r.html"
    scene.write_text(SCENE.read_text())
    assert run(beams, "modes", scene, "--report", report)[0] == beams.DONE
    assert "sc?.toml" in report.read_text(encoding="utf-8")


def test_the_same_file_is_recognised(tmp_path):
    (tmp_path / "a").touch()
    (tmp_path / "b").symlink_to("a")
    assert same_file(tmp_path / "a", tmp_path / "b")
    assert same_file(tmp_path / "none", tmp_path / "." / "none")
    assert not same_file(tmp_path / "a", tmp_path / "none")


def test_an_error_while_writing_passes_and_leaves_nothing(tmp_path):
    with pytest.raises(ZeroDivisionError), replacing(tmp_path / "x.txt") as aside:
        aside.write_text("half")
        raise ZeroDivisionError
    assert not list(tmp_path.iterdir())
