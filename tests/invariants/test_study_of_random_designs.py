"""Studies give what single calls give: on random grids, within the stated errors, to the bit on workers."""

import numpy as np
import pytest

import beamdyn as bd

DESIGNS = 200
BEAMS = {
    "uniform": bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0),
    "tapered": bd.Beam.from_stiffness(
        0.05, np.polynomial.Polynomial([0.016, -0.006]), np.polynomial.Polynomial([1.5e-3, -1e-3]), 4e5
    ),
    "of two parts": bd.Beam.from_stiffness(
        0.05, bd.Table([0, 0.4, 0.4, 1], [0.02, 0.02, 0.01, 0.01]), bd.Table([0, 1], [2e-3, 1e-3])
    ),
}  # of one shape each, whatever its sides, masses and stiffness are
RANGES = {
    "beam.length": (0.03, 0.08),
    "beam.tip.mass": (0.0, 2e-3),
    "beam.tip.offset": (-0.005, 0.005),
    "beam.tip.inertia": (1e-8, 2e-8),
    "beam.tip.transverse_inertia": (1e-8, 2e-8),
    "beam.tip.axial_inertia": (1e-8, 2e-8),
    "mount.radius": (0.0, 0.4),
    "mount.setting_angle": (0.0, np.pi),
    "mount.bending_angle": (0.0, np.pi / 2),
    "speed": (0.0, 300.0),
}
OF_BEAM = {
    "uniform": {"beam.thickness": (1e-4, 4e-4), "beam.width": (5e-3, 2e-2), "beam.density": (2000.0, 9000.0)},
    "tapered": {"mount.radius": RANGES["mount.radius"]},
    "of two parts": {"mount.radius": RANGES["mount.radius"]},
}


def random_designs(name, count):
    random = np.random.default_rng(17)
    ranges = RANGES | OF_BEAM[name]
    return {key: random.uniform(*ends, count) for key, ends in ranges.items()}


@pytest.mark.parametrize("name", BEAMS)
def test_of_random_designs_within_the_stated_errors(name):
    """The exact frequency lies within the error of either: they differ by no more than the sum."""
    scene = bd.Scene(BEAMS[name], bd.Mount(0.1))
    count = DESIGNS if name == "uniform" else 20
    study = bd.study(scene, random_designs(name, count), combine="zip")
    assert "batched" in study.provenance.method
    found, diverging = 0, 0
    for i in range(count):
        single = bd.natural_modes(study.scene_at(i), study.design(i)["speed"])
        known = np.isfinite(single.error) & np.isfinite(study.error[i])
        assert np.array_equal(single.status[known], study.status[i][known])
        vibrates = known & (single.status == "stable")
        difference = np.abs(study.value[i] / single.frequency - 1)[vibrates]
        assert (difference <= (single.error + study.error[i])[vibrates]).all()
        np.testing.assert_array_equal(np.isfinite(single.error), np.isfinite(study.error[i]))
        found, diverging = found + int(vibrates.sum()), diverging + int((single.status != "stable").sum())
    assert found > 2 * count and (diverging or name != "uniform")


def test_the_errors_are_those_of_single_calls():
    """Where truncation shows, the estimate is the same number; there rounding is 1e-9 of it at most."""
    scene = bd.Scene(BEAMS["uniform"], bd.Mount(0.1))
    basis, vary = bd.Ritz(7), {"beam.tip.mass": [0.0, 1e-3], "speed": [0.0, 80.0]}
    study = bd.study(scene, vary, modes=3, discretization=basis)
    for place in np.ndindex(study.shape):
        single = bd.natural_modes(study.scene_at(*place), study.design(*place)["speed"], 3, basis)
        large = single.error > 1e-8
        assert large.any()
        np.testing.assert_allclose(study.error[place][large], single.error[large], rtol=1e-5)


def test_fast_designs_take_finer_bases():
    scene = bd.Scene(BEAMS["uniform"], bd.Mount(0.1, np.pi))
    study = bd.study(scene, {"beam.thickness": [1e-4, 4e-4], "speed": [0.0, 5000.0]})
    single = bd.natural_modes(study.scene_at(0, 1), 5000.0)
    assert "16" not in single.provenance.method and study.error.max() < 1e-9
    np.testing.assert_allclose(
        study.value[0, 1], single.frequency, rtol=(study.error[0, 1] + single.error).max()
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "options",
    [{}, {"damping_ratio": 0.01}, {"physics": bd.Physics(stretch=True)}],
    ids=["", "damped", "alone"],
)
def test_to_the_bit_on_any_number_of_workers(options, monkeypatch):
    """The tasks follow from the request; small ones here, so that there are several."""
    from beamdyn.studies import study as module

    monkeypatch.setattr(module, "_BATCHED", 3)
    monkeypatch.setattr(module, "_SINGLE", 3)
    scene = bd.Scene(BEAMS["uniform"], bd.Mount(0.1), **options)
    vary = {"beam.tip.mass": np.linspace(0, 1e-3, 4), "mount.radius": [0.0, 0.1], "speed": [0.0, 50.0]}
    one, two = (bd.study(scene, vary, workers=workers) for workers in (1, 2))
    for name in ("value", "error", "status"):
        assert np.array_equal(getattr(one, name), getattr(two, name), equal_nan=name != "status")
