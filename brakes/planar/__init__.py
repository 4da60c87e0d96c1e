"""Statics of planar mechanisms that names what is loose and what is undetermined."""

from brakes.planar.diagnosis import AssemblyError, OutOfReachError
from brakes.planar.freebody import Action, free_body
from brakes.planar.friction import Friction, solve_with_friction
from brakes.planar.joints import Bar, Cable, Contact, Pin, RotationLock, Slot
from brakes.planar.kinematics import Stroke, Toggle, assemble, stroke, trace
from brakes.planar.loads import CablePair, Force, Moment, Spring, TorsionSpring
from brakes.planar.mechanism import Mechanism, Position
from brakes.planar.rows import GROUND
from brakes.planar.statics import Equilibrium, solve

__all__ = [
    "GROUND",
    "Action",
    "AssemblyError",
    "Bar",
    "Cable",
    "CablePair",
    "Contact",
    "Equilibrium",
    "Force",
    "Friction",
    "Mechanism",
    "Moment",
    "OutOfReachError",
    "Pin",
    "Position",
    "RotationLock",
    "Slot",
    "Spring",
    "Stroke",
    "Toggle",
    "TorsionSpring",
    "assemble",
    "free_body",
    "solve",
    "solve_with_friction",
    "stroke",
    "trace",
]
