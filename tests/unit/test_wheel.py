"""The built wheel holds both packages, their data, the licence and the commands; and nothing else."""

import configparser
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("beamdyn", "brakes")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """A copy of the tree: what the build writes, or others write meanwhile, does no harm."""
    copy = tmp_path_factory.mktemp("source")
    for name in ("pyproject.toml", "README.md", "LICENSE", ".gitignore"):
        shutil.copy(ROOT / name, copy)
    for name in (*PACKAGES, "examples", "tests"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__", "*.pyc"))
    return copy


@pytest.fixture(scope="module")
def wheel(source, tmp_path_factory):
    out = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", out, source]
    done = subprocess.run(command, cwd=out, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    (path,) = out.glob("*.whl")
    with zipfile.ZipFile(path) as archive:
        yield archive


def files(archive):
    return {name for name in archive.namelist() if not name.endswith("/")}


def dist_info(archive):
    (folder,) = {name.split("/")[0] for name in files(archive) if ".dist-info/" in name}
    return folder


def test_holds_the_packages_with_their_data_and_nothing_else(source, wheel):
    expected = {
        path.relative_to(source).as_posix()
        for package in PACKAGES
        for path in (source / package).rglob("*")
        if path.is_file()
    }
    examples = (path for path in (source / "examples").rglob("*") if path.is_file())
    shipped = "beamdyn/common/screens/shipped_examples"
    expected |= {f"{shipped}/{path.relative_to(source / 'examples').as_posix()}" for path in examples}
    for name in ("__init__.py", "py.typed"):  # the second says that the type hints hold
        assert {f"{package}/{name}" for package in PACKAGES} <= expected
    assert {name for name in files(wheel) if not name.startswith(dist_info(wheel))} == expected


def test_commands_point_to_modules_inside(wheel):
    entry_points = configparser.ConfigParser()
    entry_points.read_string(wheel.read(f"{dist_info(wheel)}/entry_points.txt").decode())
    commands = dict(entry_points["console_scripts"])
    assert commands == PROJECT["scripts"]
    assert "beamdyn" in commands
    modules = {target.partition(":")[0].replace(".", "/") for target in commands.values()}
    assert modules <= {name.removesuffix(".py").removesuffix("/__init__") for name in files(wheel)}


def test_carries_the_licence(wheel):
    assert wheel.read(f"{dist_info(wheel)}/licenses/LICENSE") == (ROOT / "LICENSE").read_bytes()
