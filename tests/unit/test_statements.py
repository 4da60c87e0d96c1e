"""Statements: sentences for people whose kind, numbers and speeds programs ask for."""

import pickle

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.analyses.results.cautions import notes_of, warnings_of
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.results.columns import DisplayUnits
from beamdyn.common.results.statements import (
    GROWING,
    LIMITS,
    OUTSIDE,
    InputValue,
    Speeds,
    Statement,
    Words,
    after,
    kind_of,
    of_kind,
    said_in,
)
from beamdyn.common.words import amount
from beamdyn.scene.validity import LARGE_DEFLECTION
from benchmarks.cases.scenes import HARVESTER

SAID = Statement(
    "from ", Speeds(1.0, 2.0), " on it ", "grows", kind=GROWING, quantity="rate", value=3.0, limit=0
)
TILTED = bd.Scene(HARVESTER.beam, bd.Mount(0.215, setting_angle=0.785))


def test_a_statement_is_its_sentence_and_knows_what_it_says():
    assert SAID == "from 1 to 2 rad/s on it grows" and {SAID: 1}["from 1 to 2 rad/s on it grows"] == 1
    assert (SAID.kind, SAID.quantity, SAID.value, SAID.limit, SAID.remedy) == (GROWING, "rate", 3.0, 0.0, "")
    assert kind_of("from 1 to 2 rad/s on it grows") == "" and of_kind([SAID, "other"], GROWING) == [SAID]


@pytest.mark.parametrize(
    "said", [SAID, Words("at ", Speeds(0.1, digits=2)), InputValue("speed", 3.0, "rad/s")]
)
def test_what_is_said_comes_back_from_a_pickle(said):
    back = pickle.loads(pickle.dumps(said))
    assert type(back) is type(said) and back == said and back.arguments() == said.arguments()


def test_each_medium_words_the_speeds_in_its_unit():
    rpm = DisplayUnits(speed="rpm")
    assert said_in(rpm, SAID) == "from 9.5493 to 19.0986 rpm on it grows"
    assert said_in(rpm, after("blade: ", SAID)) == "blade: from 9.5493 to 19.0986 rpm on it grows"
    assert after("blade: ", SAID).kind == GROWING
    assert said_in(rpm, Words("at ", InputValue("speed", np.pi / 30, "rad/s"))) == "at speed = 1 rpm"
    assert said_in(rpm, InputValue("mount.radius", 0.2, "m")) == "mount.radius = 0.2 m"
    assert said_in(rpm, "at 5 rad/s") == "at 5 rad/s"


def test_kinds_survive_files(tmp_path):
    with pytest.warns(bd.OutsideLinearTheory):
        modes = bd.natural_modes(TILTED, 100.0, 1)
    modes.save(tmp_path / "modes.json")
    back = bd.load(tmp_path / "modes.json")
    (bent,) = of_kind(back.warnings, OUTSIDE)
    assert back.warnings == modes.warnings and notes_of(back) == notes_of(modes) != []
    assert bent.value > bent.limit == LARGE_DEFLECTION
    in_rpm = warnings_of(back.in_units(speed="rpm"))
    assert any("954.93 rpm" in said for said in in_rpm) and not any("rad/s" in said for said in in_rpm)


def test_lengths_and_angles_are_said_in_small_units_wherever_they_stand():
    said = Words("arm turns about ", amount(0.0143, -0.2), ", at ", amount(np.pi, unit="rad"))
    whole = Statement("loose: ", said, "; 5 m away", kind=LIMITS)
    assert whole == "loose: arm turns about (0.0143, -0.2) m, at 3.14159 rad; 5 m away"
    small = "loose: arm turns about (14.3, -200) mm, at 180 deg; 5 m away"  # what is no amount stays
    assert in_files(whole) == in_files(pickle.loads(pickle.dumps(whole))) == small
