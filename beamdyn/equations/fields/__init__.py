"""Fields of the beam: unknown functions along it, with their terms in the equations of motion."""

from beamdyn.equations.fields.field import Field
from beamdyn.equations.fields.plate import Camber, Torsion
from beamdyn.equations.fields.stretch import Stretch

FIELDS: tuple[Field, ...] = (*Stretch.partners, Stretch(), Camber(), Torsion())
