"""Motions of all kinds, and a check of refusals."""

from itertools import pairwise

import numpy as np

from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.motion.rolling import RoadWave, RollingWheel, UserMotion
from beamdyn.scene.motion.rotations import RotationFunction, SampledRotation, SpinUp, SteadyRotation

PUBLISHED = RollingWheel(0.3, SpinUp(55.0, 10.0), RoadWave(0.3, velocity_amplitude=0.01))
TABLE = SampledRotation([0, 1, 2.5, 3, 5], [0, 4, 9, 9.5, 11])
CORNERS = SampledRotation([0, 1, 2, 3, 4], [0, 5, 5, 5, 5], "pchip")


def angle_of(t):
    return 50 * t - np.cos(3 * t) / 3


def speed_of(t):
    return 50 + np.sin(3 * t)


def acceleration_of(t):
    return 3 * np.cos(3 * t)


def shaken(t):
    carrier = np.zeros((*t.shape, 3))
    carrier[..., 2] = np.sin(40 * t)
    return MotionSample(angle_of(t), speed_of(t), acceleration_of(t), carrier)


FUNCTION = RotationFunction(angle_of, speed_of, acceleration_of, 8.0)
USER = UserMotion(shaken, t_end=8.0)
ROTATIONS = [
    SteadyRotation(-3.0),
    SpinUp(55.0, 4.0),
    SpinUp(-55.0, 4.0, "linear"),
    TABLE,
    CORNERS,
    FUNCTION,
]
HEIGHT = RoadWave(0.3, height=0.001)
MOTIONS = [*ROTATIONS, USER, PUBLISHED, *(RollingWheel(0.25, r, HEIGHT) for r in ROTATIONS)]


def name(motion):
    return type(motion).__name__


def gauss(function, a, b, pieces=40):
    """Integrate a function of an array by Gauss quadrature on pieces."""
    x, w = np.polynomial.legendre.leggauss(8)
    h = (b - a) / pieces
    t = a + h * (np.arange(pieces)[:, None] + (x + 1) / 2)
    return float((function(t) * w).sum() * h / 2)


def pieces_of(motion, end=6.0):
    inner = [t for t in motion.breakpoints if t < min(end, motion.end)]
    edges = [0.0, *inner, min(end, motion.end)]
    return list(pairwise(edges))
