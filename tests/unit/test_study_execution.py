"""Studies on executors and from stores: what is stored, resumed and computed at once."""

from concurrent.futures import BrokenExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.modes.modal.diagonal_stiffness import solve_diagonal

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 200e9, "density": 7850.0}
SCENE = bd.Scene(bd.Beam.rectangular(**BEAM, tip=bd.TipMass(1e-4, 1e-3, 1e-10)), bd.Mount(0.2))
ROUNDING = 1e-12  # a few ulp of the inputs, times what frequencies amplify them


def test_a_store_resumes_where_the_executor_broke(tmp_path):
    vary = {"mount.radius": np.linspace(0.0, 0.3, 3000)}
    store, whole = tmp_path / "store", bd.study(SCENE, vary)

    class Breaking(ThreadPoolExecutor):
        left = 2

        def submit(self, *task, **options):
            self.left -= 1
            if self.left < 0:
                raise BrokenExecutor("it broke")
            return super().submit(*task, **options)

    with Breaking(1) as pool, pytest.raises(bd.StudyInterrupted, match="stored; the same call"):
        bd.study(SCENE, vary, executor=pool, store=store)
    kept, calls = {file.name for file in store.iterdir()}, []
    resumed = bd.study(SCENE, vary, store=store, progress=lambda *done: calls.append(done))
    assert np.array_equal(resumed.value, whole.value) and np.array_equal(resumed.error, whole.error)
    assert len({file.name for file in store.iterdir()}) == 4  # three parts and the marker
    assert kept <= {file.name for file in store.iterdir()} and calls[-1] == (3000, 3000)
    again = bd.study(SCENE, vary, store=store)
    assert np.array_equal(again.value, whole.value) and again.warnings == whole.warnings


def test_a_damaged_part_is_computed_again(tmp_path):
    vary = {"mount.radius": [0.1, 0.2]}
    whole = bd.study(SCENE, vary, store=tmp_path / "store")
    (part,) = (file for file in (tmp_path / "store").iterdir() if file.name != "store.json")
    part.write_text(part.read_text()[:-20])
    again = bd.study(SCENE, vary, store=tmp_path / "store")
    assert np.array_equal(again.value, whole.value)
    assert any("its designs were computed again" in said for said in again.warnings)


def test_other_requests_find_no_answer_in_the_store(tmp_path):
    store = tmp_path / "store"
    bd.study(SCENE, {"mount.radius": [0.1, 0.2]}, store=store)
    bd.study(SCENE, {"mount.radius": [0.1, 0.2]}, modes=2, store=store)
    bd.study(SCENE, {"mount.radius": [0.1, 0.25]}, store=store)
    assert len([*store.iterdir()]) == 4


def test_executors_have_few_parts_at_a_time(monkeypatch):
    """So that a million designs do not stand in memory as tasks."""
    monkeypatch.setattr("beamdyn.common.parallel.tasks._IN_FLIGHT", 2)
    most, flying = [0], [0]

    class Counting(ThreadPoolExecutor):
        def submit(self, *task, **options):
            flying[0] += 1
            most[0] = max(most[0], flying[0])
            future = super().submit(*task, **options)
            future.add_done_callback(lambda _: flying.__setitem__(0, flying[0] - 1))
            return future

    with Counting(1) as pool:
        found = bd.study(SCENE, {"mount.radius": np.linspace(0, 0.3, 5000)}, executor=pool)
    assert most[0] <= 2 and np.isfinite(found.value).all()


@pytest.mark.parametrize("scene", [
    bd.Scene(SCENE.beam, SCENE.mount, physics=bd.Physics(stretch=True)),
    bd.Scene(SCENE.beam, bd.Mount(0.2, np.pi, precone=0.1)),
    bd.Scene(SCENE.beam, bd.Mount(0.2, np.pi, root_stiffness=0.0)),
    bd.Scene(SCENE.beam, bd.Mount(0.2, np.pi), physics=bd.Physics(planes=2, rotary_inertia=True)),
])  # fmt: skip
def test_what_is_not_batched_is_solved_one_by_one(scene):
    study = bd.study(scene, {"speed": [0.0, 30.0]}, modes=2)
    single = bd.natural_modes(scene, 30.0, 2)
    assert np.array_equal(study.value[1], single.frequency) and np.array_equal(study.error[1], single.error)
    assert study.provenance.method == "single calls"


def test_point_masses_stay_where_they_are():
    lumps = (bd.PointMass(0.02, 1e-4),)
    scene = bd.Scene(bd.Beam.rectangular(**BEAM, point_masses=lumps), SCENE.mount)
    study = bd.study(scene, {"beam.thickness": [1e-4, 3e-4]}, modes=2)
    single = bd.Scene(bd.Beam.rectangular(**BEAM | {"thickness": 3e-4}, point_masses=lumps), SCENE.mount)
    np.testing.assert_allclose(study.value[1], bd.natural_modes(single, 0.0, 2).frequency, rtol=ROUNDING)


def test_many_eigenproblems_at_once_are_those_of_each():
    """To the bit: stiff ones, and soft ones, which are shifted each by its own amount."""
    random = np.random.default_rng(3)
    factor = random.normal(size=(6, 5, 5))
    mass = np.eye(5) + factor @ np.swapaxes(factor, 1, 2) * 10.0 ** random.uniform(-3, 1, (6, 1, 1))
    stiffness = 1 + random.uniform(0, 3, (6, 5))
    stiffness[2:, 1] = [-3.0, -0.02, 0.0, -40.0]
    lowest = 1 / np.linalg.eigvalsh(mass)[:, -1]
    together = solve_diagonal(mass, stiffness, 3, lowest)
    for i in range(6):
        alone = solve_diagonal(mass[i], stiffness[i : i + 1], 3, float(lowest[i]))
        assert all(np.array_equal(one[0], all_[i]) for one, all_ in zip(alone, together, strict=True))
