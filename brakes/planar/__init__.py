"""Statics of planar mechanisms, with a diagnosis of loose bodies and statically undetermined forces.

`JOINTS` and `LOADS` list the classes of all joints and loads; files, forms and drawings are made from these
lists.  The docstrings of `Joint` and `Load` tell how to write a new one.
"""

from brakes.planar.friction import FrictionalEquilibrium, solve_with_friction
from brakes.planar.joints import Bar, Cable, Contact, Pin, RotationLock, Slot
from brakes.planar.kinematics import Stroke, Toggle, assemble, stroke, trace
from brakes.planar.loads import CablePair, Force, Moment, Spring, TorsionSpring
from brakes.planar.mechanism import Mechanism, Position
from brakes.planar.part import Joint, Load, Part, Shape
from brakes.planar.rows import GROUND
from brakes.planar.statics import Action, Equilibrium, free_body, solve
from brakes.planar.system import AssemblyError, OutOfReachError

JOINTS: tuple[type[Joint], ...] = (Pin, Bar, Slot, Contact, RotationLock, Cable)
LOADS: tuple[type[Load], ...] = (Force, Moment, CablePair, Spring, TorsionSpring)

__all__ = [
    "GROUND",
    "JOINTS",
    "LOADS",
    "Action",
    "AssemblyError",
    "Bar",
    "Cable",
    "CablePair",
    "Contact",
    "Equilibrium",
    "Force",
    "FrictionalEquilibrium",
    "Joint",
    "Load",
    "Mechanism",
    "Moment",
    "OutOfReachError",
    "Part",
    "Pin",
    "Position",
    "RotationLock",
    "Shape",
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
