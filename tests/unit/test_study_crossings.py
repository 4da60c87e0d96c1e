"""Studies of resonance speeds: lines of single designs, and what rounding leaves unsolved."""

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.modes.modal.many_designs import speeds_of_meeting

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 200e9, "density": 7850.0}
SCENE = bd.Scene(bd.Beam.rectangular(**BEAM, tip=bd.TipMass(1e-4, 1e-3, 1e-10)), bd.Mount(0.2))
ROAD = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)


def rolling(duration=0.5, **options):
    wheel = bd.RollingWheel(0.3, bd.SpinUp(40.0, duration), ROAD)
    return bd.Scene(SCENE.beam, SCENE.mount, wheel, **options)


def test_where_there_is_no_gravity_there_is_no_line_of_it():
    scene = bd.Scene(SCENE.beam, SCENE.mount, bd.SteadyRotation(50.0))
    study = bd.study(scene, {"model.gravity": [0.0, 9.81]}, "crossings", speed=135.0, modes=2)
    forced = [i for i, label in enumerate(study.labels) if "forced" in label]
    assert study.labels[forced[0]] == "mode 1, rotation (forced)"
    assert (study.status[0] == "not excited").all() and np.isnan(study.value[0]).all()
    found = bd.resonance_speeds(study.scene_at(1), 135.0, 2)
    assert len(found) == np.isfinite(study.value[1]).sum() > 0


def test_where_nothing_excites_any_design_there_is_no_study_of_crossings():
    """As `resonance_speeds` says of one; whether designs are batched or solved one by one."""
    for motion, discretization in ((bd.SteadyRotation(50.0), "ritz"), (None, "fem")):
        scene = bd.Scene(SCENE.beam, SCENE.mount, motion)
        (said,) = bd.resonance_speeds(scene, 50.0).warnings
        assert said.startswith("nothing varies in time") and said.endswith("or gravity, excites the beam")
        with pytest.raises(InvalidValue, match=r"nothing varies in time .* or gravity, excites the beam"):
            bd.study(
                scene, {"mount.radius": [0.1, 0.2]}, "crossings", speed=50.0, discretization=discretization
            )


def test_the_line_of_one_design_among_many_is_found():
    """Of designs one by one, of which not all are looked at."""
    gravity = np.where(np.arange(60) == 30, 9.81, 0.0)
    scene = bd.Scene(SCENE.beam, SCENE.mount, bd.SteadyRotation(50.0))
    study = bd.study(scene, {"model.gravity": gravity}, "crossings", speed=135.0, modes=2, combine="zip")
    assert np.array_equal((study.status != "not excited").any(axis=1), gravity > 0)


@pytest.fixture
def unsolvable_thin(monkeypatch):
    """Designs of half the thickness, and top speeds of 70 rad/s, are left unsolved, as by rounding."""

    def limited(stack, coarse, multiples, count, top, *rest):
        if top.max() > 60.0:
            raise np.linalg.LinAlgError("not positive definite")
        return speeds_of_meeting(stack, coarse, multiples, count, top, *rest)

    monkeypatch.setattr("beamdyn.studies.resonance_speeds.speeds_of_meeting", limited)


def test_crossings_that_rounding_leaves_unsolved_are_refused(unsolvable_thin):
    study = bd.study(rolling(), {"beam.thickness": [2e-4, 1e-4, 3e-4]}, "crossings", speed=50.0, modes=2)
    assert (study.status[1] == "refused").all() and np.isnan(study.value[1]).all()
    assert np.isinf(study.error[1]).all() and np.isfinite(study.error[[0, 2]]).all()
    assert not (study.status[[0, 2]] == "refused").any()
    assert any(said.startswith("at 1 of 3 designs there is no answer") for said in study.warnings)


def test_crossings_of_which_rounding_leaves_all_unsolved(unsolvable_thin):
    with pytest.raises(ValueError, match=r"none of 2 designs has an answer; at 2 of 2 .* rounding"):
        bd.study(rolling(), {"mount.radius": [0.1, 0.2]}, "crossings", speed=70.0)
