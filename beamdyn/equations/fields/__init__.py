"""The fields of the beam: what is unknown along it, with the terms of each in the equations of motion."""

from beamdyn.equations.fields.bending import Bending
from beamdyn.equations.fields.field import Field
from beamdyn.equations.fields.stretch import Stretch

FIELDS: tuple[Field, ...] = (Bending(), Stretch())
