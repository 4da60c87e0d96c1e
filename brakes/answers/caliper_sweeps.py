"""Sweeps of calipers and mechanisms: one input against results, solved one by one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.program import NoAnswer
from brakes.answers.caliper import Answer, answer_to
from brakes.answers.mechanism import units_of
from brakes.calipers import Caliper
from brakes.config.mechanism import mechanism_from_dict
from brakes.planar import Mechanism

_MM = 1e-3
_SCALES = {"mm": _MM, "deg": np.pi / 180}

CALIPER = (
    Output("finger_travel", "travel of the finger", lambda a: a.run.finger[-1], "mm", _MM),
    Output("right_pad_travel", "travel of the right pad", lambda a: a.run.pad_travel[-1, 0], "mm", _MM),
    Output("left_pad_travel", "travel of the left pad", lambda a: a.run.pad_travel[-1, 1], "mm", _MM),
    Output("right_pad_force", "force of the right pad", lambda a: a.run.pad_force[-1, 0], "N"),
    Output("left_pad_force", "force of the left pad", lambda a: a.run.pad_force[-1, 1], "N"),
    Output("right_advantage", "right pad over finger", lambda a: a.run.advantage[-1, 0]),
    Output("left_advantage", "left pad over finger", lambda a: a.run.advantage[-1, 1]),
    Output("total_advantage", "both pads over finger", lambda a: a.run.total_advantage[-1]),
    Output("travel_symmetry", "velocity of the left pad over the right", lambda a: a.run.travel_symmetry[-1]),
    Output(
        "squeeze", "part of the force past friction", lambda a: a.friction.squeeze if a.friction else np.nan
    ),
    Output("release", "tension left when let go", lambda a: a.friction.release if a.friction else np.nan),
    Output("stopping_distance", "stopping distance", lambda a: a.stop.distance if a.stop else np.nan, "m"),
)


def outputs_of(tables: Mapping[str, Any], source: str = "mechanism") -> tuple[Output, ...]:
    """Results of a caliper or mechanism: at the end of its stroke, and the largest force of each joint.

    Raises
    ------
    ConfigError
        If the tables do not describe one.
    """
    core = mechanism_from_dict(tables, source).core
    if isinstance(core, Caliper):
        return (*CALIPER, *_joints(core.mechanism, lambda a: a.run.magnitudes))
    return (*_loads(core), *_joints(core, lambda a: a.last.magnitudes))


def solve(tables: Mapping[str, Any]) -> Answer:
    """The answer to tables, if statics determines it; raises `ConfigError` and `NoAnswer`."""
    answer = answer_to(mechanism_from_dict(tables))
    if answer.status != "determined":
        raise NoAnswer(answer.message)
    return answer


def _joints(mechanism: Mechanism, of: Any) -> list[Output]:
    return [
        Output(
            f"largest_{_name(joint.name)}",
            f"largest force of {joint.name}",
            lambda answer, name=joint.name: np.max(np.abs(of(answer)[name])),
            joint.unit,
        )
        for joint in mechanism.joints
    ]


def _loads(mechanism: Mechanism) -> list[Output]:
    found = []
    for load in mechanism.loads:
        _, travel, size = units_of(load)
        end = Output(
            _name(load.name),
            f"{load.name} at the end of the stroke",
            lambda answer, name=load.name: np.ravel(answer.last.amplitudes[name])[-1],
            size,
        )
        moved = Output(
            f"{_name(load.name)}_travel",
            f"travel of {load.name}",
            lambda answer, name=load.name: answer.motion.travel[name][-1] if answer.motion else np.nan,
            travel,
            _SCALES[travel],
        )
        found += [end, moved]
    return found


def _name(words: str) -> str:
    return words.replace(" ", "_").replace(",", "")
