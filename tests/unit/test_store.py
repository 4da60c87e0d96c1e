"""The store: whole files only, its own directory only, keys by content."""

import hashlib
import json
import math
import os
import subprocess
import sys
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.parallel.tasks import Store
from beamdyn.common.results.result import DamagedRecord
from beamdyn.common.results.snapshots import fingerprint


@dataclass(frozen=True)
class Point:
    x: float
    y: float

    @cached_property
    def radius(self):
        return math.hypot(self.x, self.y)


def double(x):
    return 2 * x


def test_floats_come_back_to_the_bit(tmp_path):
    values = [0.1 + 0.2, math.pi * 1e-300, 5e-324, -0.0, math.inf, 1 / 3]
    Store(tmp_path / "s", "test").write("key", {"values": values})
    found = Store(tmp_path / "s", "test").read("key")
    assert [v.hex() for v in found["values"]] == [v.hex() for v in values]


def test_nan_comes_back(tmp_path):
    store = Store(tmp_path, "test")
    store.write("key", {"value": math.nan})
    assert math.isnan(store.read("key")["value"])


def test_what_was_not_written_is_missing(tmp_path):
    assert Store(tmp_path, "test").read("key") is None


RECORD = {"cases": [[0.1 + 0.2, 1e-5, "done"], [1 / 3, 2.5e-300, "failed: grows"]], "speeds": [50.0, 60.0]}


@pytest.mark.slow
def test_no_flipped_bit_gives_another_record(tmp_path):
    store = Store(tmp_path, "test")
    store.write("key", RECORD)
    whole = store.file("key").read_bytes()
    refused = 0
    for bit in range(8 * len(whole)):
        damaged = bytearray(whole)
        damaged[bit // 8] ^= 1 << bit % 8
        store.file("key").write_bytes(damaged)
        try:
            assert store.read("key") == RECORD  # 1e-05 as 1E-05
        except DamagedRecord:
            refused += 1
    assert refused > 0.99 * 8 * len(whole)


def edit(record):
    record["cases"][0][1] = 2e-5


DAMAGE = {
    "a value edited": (edit, "does not match its checksum"),
    "a key removed": (lambda record: record.pop("speeds"), "does not match its checksum"),
    "no checksum": (lambda record: record.pop("checksum"), "an earlier version wrote it"),
    "another schema": (
        lambda record: record.update(reseal(record, schema=0)),
        "has schema 0.* reads schema 1",
    ),
    "another key": (lambda record: record.update(reseal(record, key="other")), "was renamed"),
}


def reseal(record, **changed):
    content = {name: value for name, value in (record | changed).items() if name != "checksum"}
    text = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return {**content, "checksum": hashlib.sha256(text.encode()).hexdigest()}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_record_that_is_not_as_written_is_refused_with_the_reason(tmp_path, damage):
    change, reason = DAMAGE[damage]
    store = Store(tmp_path, "test")
    store.write("key", RECORD)
    record = json.loads(store.file("key").read_text())
    change(record)
    store.file("key").write_text(json.dumps(record))
    with pytest.raises(DamagedRecord, match=reason):
        store.read("key")


@pytest.mark.parametrize("text", ['{"value": 1.', "", "[" * 100_000, "7"])
def test_a_file_that_is_no_record_is_refused(tmp_path, text):
    store = Store(tmp_path, "test")
    store.file("key").write_text(text)
    with pytest.raises(DamagedRecord):
        store.read("key")


def test_a_write_that_fails_leaves_nothing(tmp_path):
    store = Store(tmp_path, "test")
    with pytest.raises(TypeError):
        store.write("key", {"value": object()})
    assert [p.name for p in tmp_path.iterdir()] == ["store.json"]


def test_an_unfinished_file_of_a_killed_program_does_no_harm(tmp_path):
    (tmp_path / ".unfinished-left.json").write_text("{")
    assert Store(tmp_path, "test").read("left") is None


def test_a_directory_with_other_content_is_refused(tmp_path):
    (tmp_path / "thesis.tex").write_text("x")
    with pytest.raises(ValueError, match=r"thesis\.tex.*does not exist yet"):
        Store(tmp_path, "test")
    assert [p.name for p in tmp_path.iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize("marker", [None, "", "{", '{"kind": null', "7"])
def test_a_damaged_or_missing_marker_is_written_again(tmp_path, marker):
    key = fingerprint("a request")
    Store(tmp_path, "test").write(key, {"value": 1.0})
    if marker is None:
        (tmp_path / "store.json").unlink()
    else:
        (tmp_path / "store.json").write_text(marker)
    assert Store(tmp_path, "test").read(key) == {"value": 1.0}
    with pytest.raises(ValueError, match="something other than a sweep"):
        Store(tmp_path, "sweep")


def test_a_store_of_another_kind_is_refused(tmp_path):
    Store(tmp_path, "brakes")
    with pytest.raises(ValueError, match="something other than a test"):
        Store(tmp_path, "test")


def test_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(ValueError, match="is a file"):
        Store(tmp_path / "file", "test")


@pytest.mark.parametrize("path", ["file/store", "missing/store"])
def test_what_cannot_be_made_is_refused(tmp_path, path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(ValueError, match="cannot be written"):
        Store(tmp_path / path, "test")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_directory_without_permission_is_refused(tmp_path):
    tmp_path.chmod(0o555)
    with pytest.raises(ValueError, match="cannot be written"):
        Store(tmp_path, "test")


def test_files_are_json(tmp_path):
    Store(tmp_path, "test").write("key", {"cases": [(1.0, "done")]})
    assert json.loads((tmp_path / "key.json").read_text())["cases"] == [[1.0, "done"]]


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (1.0, math.nextafter(1.0, 2)),
        (0.0, -0.0),
        (1, 1.0),
        (("a", "b"), ("ab",)),
        ([[1.0], [2.0]], [[1.0, 2.0]]),
        (np.zeros(4), np.zeros((2, 2))),
        (Point(1.0, 2.0), Point(2.0, 1.0)),
        (Point(1.0, 2.0), (1.0, 2.0)),
        ({"a": 1.0}, {"b": 1.0}),
        (double, math.sin),
        (lambda x: x + 1, lambda x: x + 2),
    ],
)
def test_other_values_have_other_keys(one, other):
    assert fingerprint(one) != fingerprint(other)


@dataclass(frozen=True)
class Drive:
    """A motion of a user's, whose size matters although equality leaves it out."""

    name: str
    size: np.ndarray = field(compare=False)


def test_only_our_own_classes_have_fields_that_do_not_count():
    assert fingerprint(Drive("a", np.ones(2))) != fingerprint(Drive("a", np.zeros(2)))
    scene = bd.Scene(bd.Beam.from_stiffness(10.0, 1.2, 1.4e4), bd.Mount(0.5))
    assert fingerprint(replace(scene, label="named")) == fingerprint(scene)


def test_the_key_of_a_value_stays_when_the_value_is_used():
    point = Point(3.0, 4.0)
    before = fingerprint(point)
    assert point.radius == 5.0
    assert fingerprint(point) == before == fingerprint(Point(np.float64(3.0), 4.0))


def test_keys_are_the_same_in_another_process():
    code = (
        "from tests.unit.test_store import Point, double; "
        "from beamdyn.common.results.snapshots import fingerprint; "
        "print(fingerprint(Point(0.1, 2.0), double, {'a': [None, 'é']}))"
    )
    env = {**os.environ, "PYTHONHASHSEED": "7"}
    root = Path(__file__).parents[2]
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=root, env=env, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == fingerprint(Point(0.1, 2.0), double, {"a": [None, "é"]})


def test_what_cannot_be_pickled_has_no_key():
    with pytest.raises(ValueError, match="cannot be stored"):
        fingerprint(x for x in ())
