"""Fields of the beam: unknown functions along it, with their terms in the equations of motion."""

from beamdyn.equations.fields.bending import Bending, SecondBending
from beamdyn.equations.fields.field import Field
from beamdyn.equations.fields.shear import SecondShear, Shear
from beamdyn.equations.fields.stretch import Stretch

FIELDS: tuple[Field, ...] = (Bending(), SecondBending(), Shear(), SecondShear(), Stretch())
