"""All rows of one kind as arrays, evaluated at many positions at once.

Vectors are complex numbers; lengths are over the length L of the mechanism (see `system`).  Each class adds
the values, forces and couples of its rows to the totals of the mechanism.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

_TINY = 1e-200  # keeps a direction finite where two points of a path meet


class Pose(NamedTuple):
    """Where all bodies and the ground are, arrays of shape (n + 1, S).

    centre : complex, the centres of their points.
    angle, spin : the angles by which they have turned [rad], and exp(i angle).
    """

    centre: np.ndarray
    angle: np.ndarray
    spin: np.ndarray


class Totals(NamedTuple):
    """Value (R, S) of each row, and its force (complex) and couple on each body, (R, n + 1, S)."""

    value: np.ndarray
    force: np.ndarray
    couple: np.ndarray


class Lines(NamedTuple):
    """Arrays of `Line`: rows, bodies and frames (indices), arms in the bodies and normals (complex)."""

    row: np.ndarray
    body: np.ndarray
    other: np.ndarray
    frame: np.ndarray
    arm: np.ndarray
    arm_other: np.ndarray
    normal: np.ndarray

    def add(self, pose: Pose, totals: Totals) -> None:
        """n.(p - o), with the couple n' x (p - o) on the body with which n turns."""
        value, force, couple = totals
        row, a, b, frame = self[:4]
        arm, arm_other, normal = (
            pose.spin[k] * vector[:, None] for k, vector in zip((a, b, frame), self[4:], strict=True)
        )
        gap = pose.centre[a] + arm - pose.centre[b] - arm_other
        value[row] += np.real(normal.conj() * gap)
        force[row, a] += normal
        couple[row, a] += np.imag(arm.conj() * normal)
        force[row, b] -= normal
        couple[row, b] -= np.imag(arm_other.conj() * normal)
        # A force that follows its body (frame = body) is not a gradient: it has no such couple.
        couple[row, frame] += np.where((frame == a)[:, None], 0.0, np.imag(normal.conj() * gap))


class Segments(NamedTuple):
    """Arrays of the segments of `Path`: rows, bodies (indices) and arms (complex) of their two ends."""

    row: np.ndarray
    body: np.ndarray
    other: np.ndarray
    arm: np.ndarray
    arm_other: np.ndarray

    def add(self, pose: Pose, totals: Totals) -> None:
        """Minus the length of the path, whose segments pull their ends together."""
        value, force, couple = totals
        row, a, b, arm, arm_other = self
        arm, arm_other = pose.spin[a] * arm[:, None], pose.spin[b] * arm_other[:, None]
        span = pose.centre[b] + arm_other - pose.centre[a] - arm
        length = np.maximum(np.abs(span), _TINY)
        pull = span / length
        np.add.at(value, row, -length)  # a path may have several segments on one body: not +=
        np.add.at(force, (row, a), pull)
        np.add.at(force, (row, b), -pull)
        np.add.at(couple, (row, a), np.imag(arm.conj() * pull))
        np.add.at(couple, (row, b), -np.imag(arm_other.conj() * pull))


class Turns(NamedTuple):
    """Arrays of `Turn`: rows, bodies (indices) and ratios of their angles."""

    row: np.ndarray
    body: np.ndarray
    other: np.ndarray
    ratio: np.ndarray

    def add(self, pose: Pose, totals: Totals) -> None:
        """Angle - ratio * other angle; what a gear does not pass on, its housing on the ground takes."""
        value, _, couple = totals
        row, a, b, ratio = self
        ratio = ratio[:, None]
        value[row] += pose.angle[a] - ratio * pose.angle[b]
        couple[row, a] += 1.0
        couple[row, b] -= ratio
        couple[row, -1] += ratio - 1.0


class Rounds(NamedTuple):
    """Arrays of `Round`: rows, bodies (indices), arms in the bodies, directions to the normal (complex)."""

    row: np.ndarray
    body: np.ndarray
    other: np.ndarray
    arm: np.ndarray
    arm_other: np.ndarray
    direction: np.ndarray

    def add(self, pose: Pose, totals: Totals) -> None:
        """|p - c| where the row is normal to the face, 0 where it is tangential; forces act at p on both."""
        value, force, couple = totals
        row, a, b, arm, arm_other, direction = self
        arm = pose.spin[a] * arm[:, None]
        span = pose.centre[a] + arm - pose.centre[b] - pose.spin[b] * arm_other[:, None]
        length = np.maximum(np.abs(span), _TINY)
        push = direction[:, None] * span / length
        value[row] += np.real(direction)[:, None] * length
        force[row, a] += push
        force[row, b] -= push
        couple[row, a] += np.imag(arm.conj() * push)
        couple[row, b] -= np.imag((pose.centre[a] + arm - pose.centre[b]).conj() * push)


Arrays = Lines | Segments | Turns | Rounds
