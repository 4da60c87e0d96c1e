"""Displacement fields along the beam, such as bending, with their terms in the equations of motion."""

from beamdyn.equations.fields.bending_shear_stretch import Stretch
from beamdyn.equations.fields.field import Field
from beamdyn.equations.fields.torsion_and_camber import Camber, Torsion

FIELDS: tuple[Field, ...] = (*Stretch.partners, Stretch(), Camber(), Torsion())
